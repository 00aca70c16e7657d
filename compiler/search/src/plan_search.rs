//! The search for a cheap plan: by descent, then by annealing. The caller's clock decides how long.

use rne_codegen::plan::{Cost, Descent, Plan};
use rne_model::Robot;

use crate::neighbourhood::Neighbourhood;

/// How far a search has come.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Progress {
    /// Number of plans whose operations have been counted so far.
    pub plans: usize,
    /// Operations of the best plan so far.
    pub best: Cost,
    /// The name of the part of the search that is running.
    pub phase: &'static str,
}

/// Returns which part of the time is over, 0 to 1. The search calls it now and then; `None` ends the search with its
/// result so far.
pub type Clock<'a> = &'a mut dyn FnMut(&Progress) -> Option<f64>;

/// A search over the plans of one robot.
pub(crate) struct Exploration<'v> {
    pub(crate) plans: Descent<'v>,
    neighbourhood: Neighbourhood,
    /// Cheap plans that differ in cost or structure, for rewriting.
    pub(crate) pool: Vec<(usize, Plan)>,
}

/// The error that ends a search when its time is over.
pub(crate) struct Over;

impl<'v> Exploration<'v> {
    /// Starts a search with the choices that a build makes by itself; no plan for which `veto` is true becomes the
    /// best.
    pub(crate) fn new(robot: &Robot, veto: impl Fn(&Plan) -> bool + 'v) -> Self {
        let mut plans = Descent::new(robot, &[]);
        plans.refuse(veto);
        plans.greedy(usize::MAX);
        Self { plans, neighbourhood: Neighbourhood::of(robot), pool: Vec::new() }
    }

    pub(crate) fn progress(&self, phase: &'static str) -> Progress {
        Progress { plans: self.plans.counted(), best: self.plans.best().0, phase }
    }

    /// Improves the best plan by coordinate descent, without random numbers. One choice of the plan after the other
    /// takes its best value, until no single change makes the plan cheaper; joints that are alike change together
    /// first, then each joint alone. Then the search looks for two changes in a row of which the first costs little
    /// and both together save operations, and begins again from there. It ends when there are no such changes.
    pub(crate) fn descend(&mut self, clock: Clock<'_>) -> Result<(), Over> {
        let mut plan = self.plans.best().1.clone();
        let Some(mut weight) = self.plans.cost(&plan).map(|cost| cost.weight()) else { return Ok(()) };
        loop {
            if self.neighbourhood.has_alike() {
                self.settle((&mut weight, &mut plan), true, clock)?;
            }
            self.settle((&mut weight, &mut plan), false, clock)?;
            let mut weighed = self.weigh(self.neighbourhood.neighbours(&plan), clock)?;
            weighed.sort_by_key(|(weight, _)| *weight);
            // a first change that costs a few operations, and a second change that saves more
            let limit = weight + 6;
            let mut found = None;
            'first: for (_, first) in weighed.iter().take_while(|(cost, _)| *cost <= limit) {
                for second in self.neighbourhood.neighbours(first) {
                    if let Some(cost) = self.tried(&second, clock)?
                        && cost.weight() < weight
                    {
                        found = Some((cost.weight(), second));
                        break 'first;
                    }
                }
            }
            match found {
                Some((least, best)) => (weight, plan) = (least, best),
                None => return Ok(()),
            }
        }
    }

    /// Gives each part in turn the best of its choices, until none changes.
    fn settle(
        &mut self,
        (weight, plan): (&mut usize, &mut Plan),
        together: bool,
        clock: Clock<'_>,
    ) -> Result<(), Over> {
        loop {
            let before = *weight;
            for part in self.neighbourhood.parts(together) {
                let weighed = self.weigh(self.neighbourhood.beside(plan, part, together), clock)?;
                if let Some((least, best)) = weighed.into_iter().min_by_key(|(weight, _)| *weight)
                    && least < *weight
                {
                    (*weight, *plan) = (least, best);
                }
            }
            if *weight == before {
                return Ok(());
            }
        }
    }

    /// Returns the cost of a plan; asks the clock now and then.
    fn tried(&mut self, plan: &Plan, clock: Clock<'_>) -> Result<Option<Cost>, Over> {
        let before = self.plans.counted();
        let cost = self.plans.cost(plan);
        if self.plans.counted() % 64 == 0 && self.plans.counted() > before {
            self.tick(clock, "descent")?;
        }
        Ok(cost)
    }

    /// Returns the plans that fit the robot, with their weights.
    fn weigh(&mut self, plans: Vec<Plan>, clock: Clock<'_>) -> Result<Vec<(usize, Plan)>, Over> {
        let mut weighed = Vec::new();
        self.tick(clock, "descent")?;
        for plan in plans {
            if let Some(cost) = self.tried(&plan, clock)? {
                weighed.push((cost.weight(), plan));
            }
        }
        Ok(weighed)
    }

    fn tick(&self, clock: Clock<'_>, phase: &'static str) -> Result<f64, Over> {
        clock(&self.progress(phase)).ok_or(Over)
    }

    /// Simulated annealing: makes random changes, and accepts plans with more operations more and more rarely. The
    /// clock determines the temperature.
    pub(crate) fn anneal(&mut self, seed: u64, hottest: f64, clock: Clock<'_>) -> Result<(), Over> {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut plan = self.plans.best().1.clone();
        let Some(mut weight) = self.plans.cost(&plan).map(|cost| cost.weight()) else { return Ok(()) };
        let mut over = 0.0;
        for step in 0_u64.. {
            if step % 64 == 0 {
                over = self.tick(clock, "annealing")?;
                if over >= 1.0 {
                    return Ok(());
                }
            }
            let other = self.neighbourhood.random(&plan, &mut rng);
            let Some(cost) = self.plans.cost(&other) else { continue };
            let temperature = hottest * (1.0 - over).powf(1.5) + 0.05;
            #[allow(clippy::cast_precision_loss)] // small integers
            let worse = cost.weight() as f64 - weight as f64;
            if worse <= 0.0 || rng.f64() < (-worse / temperature).exp() {
                (weight, plan) = (cost.weight(), other);
                self.keep_in_pool(weight, &plan);
            }
        }
        Ok(())
    }

    fn keep_in_pool(&mut self, weight: usize, plan: &Plan) {
        const MOST: usize = 28;
        if weight > self.plans.best().0.weight() + 9 || self.pool.iter().any(|(_, other)| other == plan) {
            return;
        }
        let alike = self.pool.iter().filter(|(other, _)| *other == weight).count();
        if alike < 8 {
            self.pool.push((weight, plan.clone()));
            self.pool.sort_by_key(|(weight, _)| *weight);
            self.pool.truncate(MOST);
        }
    }
}
