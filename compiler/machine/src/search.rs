//! The search for plans with fewer operations, as a method of an arm in a running program.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use rne_search::{SearchError, SearchOptions, search};

use crate::CompiledArm;

/// The progress of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SearchProgress {
    /// The elapsed part of the time, 0 to 1.
    pub share: f64,
    /// The number of operations of the best torques so far.
    pub operations: usize,
}

impl CompiledArm {
    /// Searches for a plan with fewer operations during `time`, starting from the present plan. Returns the arm with
    /// the plan that was found, which [`plan`](Self::plan) returns for a file next to the robot file. The search proves
    /// that it is the same arm.
    ///
    /// `progress` is called some hundred times a second. If it returns [`ControlFlow::Break`], the search ends with the
    /// best plan so far. `options` name the functions whose graphs are also rewritten, and the seed of random numbers.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use std::time::{Duration, Instant};
    ///
    /// use rne_machine::{CompiledArm, SearchOptions};
    ///
    /// # let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
    /// #     {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}";
    /// let arm = CompiledArm::from_yaml(yaml)?;
    /// let found = arm.search(Duration::from_millis(10), &SearchOptions::default(), |so_far| {
    ///     println!("{:.0} %: {} operations", 100.0 * so_far.share, so_far.operations);
    ///     ControlFlow::Continue(())
    /// })?;
    /// let plan = found.plan().expect("a search gives one").to_yaml(); // NAME.plan.yaml
    /// # assert!(plan.contains("format: 3"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// For an arm with run-time parameters, which has no plan; or when the result cannot be proved, which would be a
    /// bug of this library.
    pub fn search(
        &self,
        time: Duration,
        options: &SearchOptions,
        mut progress: impl FnMut(SearchProgress) -> ControlFlow<()>,
    ) -> Result<Self, SearchError> {
        let start = Instant::now();
        let mut is_over = false;
        let plan = search(self.robot(), self.plan(), options, &mut |so_far| {
            let share = if time.is_zero() { 1.0 } else { start.elapsed().as_secs_f64() / time.as_secs_f64() }.min(1.0);
            // after a break, the next part of the search calls this again, so the break is remembered
            is_over |= progress(SearchProgress { share, operations: so_far.best.total() }).is_break() || share >= 1.0;
            (!is_over).then_some(share)
        })?;
        Ok(self.by_plan(plan))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Form, Function};

    fn puma() -> CompiledArm {
        let file = rne_robots::find("puma560").expect("it is shipped");
        CompiledArm::from_yaml(file.yaml).expect("a shipped robot")
    }

    fn operations(arm: &CompiledArm) -> usize {
        arm.function(Function::InverseDynamics).expect("a function that compiles").program().operations().total()
    }

    #[test]
    fn what_was_found_is_the_same_arm_by_a_plan_that_can_be_kept() {
        let arm = puma();
        let options = SearchOptions { seed: 3, ..SearchOptions::default() };
        let found = arm.search(Duration::ZERO, &options, |_| ControlFlow::Continue(())).expect("a plan");
        assert!(arm.plan().is_none() && operations(&found) <= operations(&arm.in_form(Form::SevenSteps)));
        let (q, qd, qdd) = ([0.3, -0.8, 0.4, 1.0, 0.5, -0.2], [0.1; 6], [0.7; 6]);
        let torques = |arm: &CompiledArm| arm.inverse_dynamics(&q, &qd, &qdd).expect("numbers");
        for (found, expected) in std::iter::zip(torques(&found), torques(&arm)) {
            let found: f64 = found;
            assert!((found - expected).abs() < 1e-12 * 50.0, "{found} {expected}");
        }
        let yaml = rne_robots::find("puma560").expect("it is shipped").yaml;
        let read = CompiledArm::with_plan(yaml, &found.plan().expect("a plan").to_yaml()).expect("both texts");
        assert_eq!(operations(&read), operations(&found));
        assert_eq!(torques(&read), torques(&found));
    }

    #[test]
    fn who_is_told_of_the_progress_may_end_it() {
        let arm = puma();
        let mut told = Vec::new();
        let stop = |so_far: SearchProgress| {
            told.push(so_far);
            if told.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let day = Duration::from_secs(86_400);
        let found = arm.search(day, &SearchOptions::default(), stop).expect("a plan");
        assert!((3..10).contains(&told.len()), "{told:?}");
        assert!(told.is_sorted_by(|a, b| a.operations >= b.operations && a.share <= b.share && b.share < 1.0));
        assert!(found.plan().is_some(), "it has what there was");
    }

    #[test]
    fn run_time_parameters_have_no_plan() {
        let text =
            "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], parameters: {m: 2},
            joints: [{type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: m, com: [-0.4, 0, 0]}}]}";
        let robot = rne_model::Reader::new("rod").run_time(&["m"]).read(text).expect("an arm").robot;
        let arm = CompiledArm::from_robot(&robot);
        let error = arm.search(Duration::ZERO, &SearchOptions::default(), |_| ControlFlow::Continue(()));
        assert!(error.expect_err("no plan").to_string().contains("run-time parameters"));
    }

    #[test]
    fn a_function_without_a_reduced_form_is_refused() {
        let options = SearchOptions { rewrite: vec![Function::MassMatrix, Function::JointWrenches], seed: 0 };
        let error = puma().search(Duration::ZERO, &options, |_| ControlFlow::Continue(()));
        assert!(error.expect_err("nothing to rewrite").to_string().starts_with("`joint_wrenches` has no reduced form"));
    }
}
