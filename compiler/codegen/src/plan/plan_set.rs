//! The choices by which the functions of a robot are compiled in the reduced form.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use rne_model::Robot;

use crate::function::OfRobot as _;
use crate::function::{Argument, Function};
use crate::plan::cost::Evaluator;
use crate::plan::descent::default_plan;
use crate::plan::{JointPlan, OriginShift, Plan, RegroupingTarget, Rewritten};
use crate::reduced::Algorithm;
use crate::refusal::LeftOut;

/// The choices by which a robot's functions are compiled in the reduced form.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanSet {
    /// The plan of every function that has a recursion of its own.
    pub plan: Plan,
    /// The functions whose graphs have been rewritten.
    pub rewritten: BTreeMap<Function, Rewritten>,
    maker: Maker,
    /// The plan of functions that keep a floating base at rest, made when one of them is first compiled.
    held: Arc<OnceLock<Plan>>,
}

/// The origin of the choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Maker {
    /// The build chose them. It leaves out choices that it cannot prove.
    Build,
    /// A plan file contains them. They are compiled without a change, or refused.
    PlanFile,
}

impl PlanSet {
    /// The plan set without any choice.
    #[must_use]
    pub fn none(robot: &Robot) -> Self {
        Self { maker: Maker::Build, ..Self::from(Plan::new(robot.joints.len())) }
    }

    /// The choices of a build that has no plan file: the same on every machine.
    #[must_use]
    pub fn default_of(robot: &Robot) -> Self {
        Self { maker: Maker::Build, ..Self::from(default_plan(robot, &[])) }
    }

    /// Returns the choices for a function. A function that keeps a floating base at rest has those of a build for the
    /// same robot on a fixed base, because the other choices are for a base that is a link. A plan without choices fits
    /// every function.
    #[must_use]
    pub fn of_function(&self, robot: &Robot, function: Function) -> Cow<'_, Self> {
        if !function.holds_floating_base(robot) || self.plan == Plan::new(robot.joints.len()) {
            return Cow::Borrowed(self);
        }
        let held = || default_plan(&Robot { floating_base: None, ..robot.clone() }, &[]);
        let plan = self.held.get_or_init(held).clone();
        Cow::Owned(Self { plan, maker: Maker::Build, ..self.clone() })
    }

    pub(crate) fn is_of_build(&self) -> bool {
        self.maker == Maker::Build
    }

    /// Returns plan sets with fewer and fewer choices, for a build that cannot prove all of them: without those of
    /// frames, without any, without regrouping.
    pub(crate) fn with_ever_fewer_choices(&self) -> Vec<(LeftOut, Self)> {
        let unframed = Plan { turned_last_frame: false, carried_prismatics: false, ..self.plan.clone() };
        let none = Plan::new(self.plan.joints.len());
        let unregrouped = Plan { regrouped: false, ..none.clone() };
        let fewer = [(LeftOut::Frames, unframed), (LeftOut::Choices, none), (LeftOut::Regrouping, unregrouped)];
        let mut plans = vec![(LeftOut::Nothing, self.plan.clone())];
        for (left_out, plan) in fewer {
            if plans.iter().all(|(_, other)| *other != plan) {
                plans.push((left_out, plan));
            }
        }
        plans.into_iter().skip(1).map(|(left_out, plan)| (left_out, Self { plan, ..self.clone() })).collect()
    }

    /// Returns the algorithm by which a function takes the fewest operations, and the plan for it: this plan, or this
    /// plan without the choices of each joint, which are made for the recursion.
    #[must_use]
    pub fn cheapest(&self, robot: &Robot, function: Function) -> (Plan, Algorithm) {
        let algorithms = Algorithm::of_robot(function, robot);
        let first = (self.plan.clone(), algorithms.first().copied().unwrap_or(Algorithm::Rnea));
        if algorithms.len() < 2 {
            return first;
        }
        let plain = Plan { joints: Plan::new(robot.joints.len()).joints, ..self.plan.clone() };
        let mut evaluator = Evaluator::new(robot, function);
        let plans = if plain == self.plan { vec![plain] } else { vec![self.plan.clone(), plain] };
        if function.takes(Argument::Payload) {
            let plans = [&plans[..], &[self.plan.clone().unscaled()]].concat();
            return with_payload(&mut evaluator, &plans, &algorithms).unwrap_or(first);
        }
        let candidates = algorithms.iter().flat_map(|algorithm| plans.iter().map(|plan| (plan.clone(), *algorithm)));
        let costs = candidates
            .filter_map(|(plan, algorithm)| Some((evaluator.cost_of(&plan, algorithm)?.weight(), plan, algorithm)));
        costs.min_by_key(|(weight, ..)| *weight).map_or(first, |(_, plan, algorithm)| (plan, algorithm))
    }
}

/// Changes that may be better for an arm with a payload: choices that are best for the last link alone may not be best
/// for link and payload together.
const FOR_A_PAYLOAD: [fn(&mut Plan); 6] = [
    // with a rotated last frame, the payload would be rotated, too
    |plan| plan.turned_last_frame = false,
    |plan| *plan = plan.clone().unscaled(),
    |plan| of_last(plan, |last| last.switches.axis_column = !last.switches.axis_column),
    |plan| of_last(plan, |last| last.origin_shift = OriginShift::MinusD),
    |plan| of_last(plan, |last| last.switches.first_moment_unturned = !last.switches.first_moment_unturned),
    |plan| of_last(plan, |last| last.targets = [RegroupingTarget::Own; 3]),
];

fn of_last(plan: &mut Plan, change: impl Fn(&mut JointPlan)) {
    if let Some(last) = plan.joints.last_mut() {
        change(last);
    }
}

/// Finds the best plan and algorithm for an arm with a payload, by trying changes of the last link one after another.
fn with_payload(evaluator: &mut Evaluator, plans: &[Plan], algorithms: &[Algorithm]) -> Option<(Plan, Algorithm)> {
    let mut best: Option<(usize, Plan, Algorithm)> = None;
    let mut look = |plan: &Plan, best: &mut Option<(usize, Plan, Algorithm)>| {
        for &algorithm in algorithms {
            let Some(cost) = evaluator.cost_of(plan, algorithm) else { continue };
            if best.as_ref().is_none_or(|(weight, ..)| cost.weight() < *weight) {
                *best = Some((cost.weight(), plan.clone(), algorithm));
            }
        }
    };
    // with a payload, the last link is not a sphere
    for plan in plans {
        look(&Plan { gyrostat: false, ..plan.clone() }, &mut best);
    }
    for change in FOR_A_PAYLOAD {
        let (_, mut plan, _) = best.clone()?;
        change(&mut plan);
        look(&plan, &mut best);
    }
    best.map(|(_, plan, algorithm)| (plan, algorithm))
}

/// Makes a plan set of a plan that is compiled without a change, or refused.
impl From<Plan> for PlanSet {
    fn from(plan: Plan) -> Self {
        Self { plan, rewritten: BTreeMap::new(), maker: Maker::PlanFile, held: Arc::default() }
    }
}

impl From<&PlanSet> for PlanSet {
    fn from(plans: &PlanSet) -> Self {
        plans.clone()
    }
}
