//! Looking for a cheap plan: greedy, by descent, by annealing. None depends on a clock; who calls decides how long.

use std::collections::HashMap;

use rne_model::Robot;

use crate::function::Function;
use crate::ir::Cost;
use crate::plan::cost::Evaluator;
use crate::plan::neighbourhood::Neighbourhood;
use crate::plan::trick::Trick;
use crate::plan::{JointPlan, Moment, OriginShift, Plan, RegroupingTarget, Scale, Side, Switches};

/// Plans counted by a build that finds no plan file.
const DEFAULT_EVALUATIONS: usize = 240;

/// How far a search has come.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Progress {
    /// Plans counted so far.
    pub plans: usize,
    /// What the best of them costs.
    pub best: Cost,
    /// What the search is doing.
    pub phase: &'static str,
}

/// Asked now and then how much of the time is over, 0 to 1; `None` ends the search with what it has.
pub type Clock<'a> = &'a mut dyn FnMut(&Progress) -> Option<f64>;

/// Something that is wrong with a plan, whatever it costs.
type Veto<'v> = Box<dyn Fn(&Plan) -> bool + 'v>;

/// A search over the plans of one robot.
pub(crate) struct Exploration<'v> {
    pub(crate) evaluator: Evaluator,
    neighbourhood: Neighbourhood,
    without: Vec<Trick>,
    /// Refuses plans that would be the best but for something else that is wrong with them.
    veto: Option<Veto<'v>>,
    known: HashMap<Plan, Option<Cost>>,
    pub(crate) plans: usize,
    pub(crate) best: (Cost, Plan),
    /// Cheap plans that differ in cost or structure, for rewriting.
    pub(crate) pool: Vec<(usize, Plan)>,
}

/// The end of a search: out of plans to count, or of time.
pub(crate) struct Over;

impl<'v> Exploration<'v> {
    pub(crate) fn new(robot: &Robot, without: &[Trick]) -> Self {
        let evaluator = Evaluator::new(robot, Function::InverseDynamics);
        let neighbourhood = Neighbourhood::new(evaluator.frames());
        let plan = without.iter().fold(Plan::new(robot.dof()), |plan, trick| trick.left_out_of(&plan));
        let mut search = Self {
            evaluator,
            neighbourhood,
            without: without.to_vec(),
            veto: None,
            known: HashMap::new(),
            plans: 0,
            best: (Cost::default(), plan.clone()),
            pool: Vec::new(),
        };
        // the plain plan applies to every robot
        let cost = search.evaluator.cost(&plan).unwrap_or_default();
        search.best = (cost, plan);
        search
    }

    /// From now on no plan becomes the best that `veto` is true of.
    pub(crate) fn refuse(&mut self, veto: impl Fn(&Plan) -> bool + 'v) {
        self.veto = Some(Box::new(veto));
    }

    /// What a plan costs, all tricks in it being allowed.
    pub(crate) fn cost(&mut self, plan: &Plan) -> Option<Cost> {
        if self.without.iter().any(|trick| trick.is_in(plan)) {
            return None;
        }
        if let Some(known) = self.known.get(plan) {
            return *known;
        }
        self.plans += 1;
        let would_be_best = |cost: &Cost| cost.weight() < self.best.0.weight();
        let cost = self.evaluator.cost(plan);
        let cost = cost.filter(|cost| !would_be_best(cost) || !self.veto.as_ref().is_some_and(|veto| veto(plan)));
        if self.known.len() > 400_000 {
            self.known.clear();
        }
        self.known.insert(plan.clone(), cost);
        if let Some(cost) = cost
            && cost.weight() < self.best.0.weight()
        {
            self.best = (cost, plan.clone());
        }
        cost
    }

    /// The best plan so far is tried in a different place.
    pub(crate) fn start_from(&mut self, plan: &Plan) {
        let _ = self.cost(plan);
    }

    pub(crate) fn progress(&self, phase: &'static str) -> Progress {
        Progress { plans: self.plans, best: self.best.0, phase }
    }

    /// Takes the choices in the order in which they pay, each for all joints at once and then joint by joint.
    pub(crate) fn greedy(&mut self, most: usize) {
        let limit = self.plans + most;
        for round in 0..2 {
            for candidate in 0.. {
                if self.plans >= limit {
                    return;
                }
                let plan = self.best.1.clone();
                let Some(other) = greedy_candidate(&self.neighbourhood, &plan, candidate, round) else { break };
                if other != plan {
                    let _ = self.cost(&other);
                }
            }
        }
    }

    /// Coordinate descent: the best of all neighbours, again and again; when none is better, neighbours of those that
    /// cost little more. No random numbers.
    pub(crate) fn descend(&mut self, clock: Clock<'_>) -> Result<(), Over> {
        let mut plan = self.best.1.clone();
        let Some(mut weight) = self.cost(&plan).map(|cost| cost.weight()) else { return Ok(()) };
        loop {
            let mut weighed = self.weigh(&plan, clock)?;
            weighed.sort_by_key(|(weight, _)| *weight);
            let Some((least, best)) = weighed.first() else { return Ok(()) };
            if *least < weight {
                (weight, plan) = (*least, best.clone());
                continue;
            }
            // A first step that costs something, and a second one that gains more.
            let limit = weight + 6;
            let mut found = None;
            'first: for (_, first) in weighed.iter().take_while(|(cost, _)| *cost <= limit) {
                self.tick(clock, "descent")?;
                for second in self.neighbourhood.neighbours(first) {
                    if let Some(cost) = self.cost(&second)
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

    /// All neighbours of a plan with what they weigh.
    fn weigh(&mut self, plan: &Plan, clock: Clock<'_>) -> Result<Vec<(usize, Plan)>, Over> {
        let mut weighed = Vec::new();
        for (index, other) in self.neighbourhood.neighbours(plan).into_iter().enumerate() {
            if index % 64 == 0 {
                self.tick(clock, "descent")?;
            }
            if let Some(cost) = self.cost(&other) {
                weighed.push((cost.weight(), other));
            }
        }
        Ok(weighed)
    }

    fn tick(&self, clock: Clock<'_>, phase: &'static str) -> Result<f64, Over> {
        clock(&self.progress(phase)).ok_or(Over)
    }

    /// Annealing: random changes, dearer ones accepted ever more rarely. The clock says how hot it is.
    pub(crate) fn anneal(&mut self, seed: u64, hottest: f64, clock: Clock<'_>) -> Result<(), Over> {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut plan = self.best.1.clone();
        let Some(mut weight) = self.cost(&plan).map(|cost| cost.weight()) else { return Ok(()) };
        let mut over = 0.0;
        for step in 0_u64.. {
            if step % 64 == 0 {
                over = self.tick(clock, "annealing")?;
                if over >= 1.0 {
                    return Ok(());
                }
            }
            let other = self.neighbourhood.random(&plan, &mut rng);
            let Some(cost) = self.cost(&other) else { continue };
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

    /// The plan without the choices that gain nothing, so that the others can be read.
    pub(crate) fn tidied(&mut self, plan: &Plan) -> Plan {
        let Some(weight) = self.cost(plan).map(|cost| cost.weight()) else { return plan.clone() };
        let mut tidy = plan.clone();
        let keep = |search: &mut Self, tidy: &mut Plan, other: Plan| {
            if other != *tidy && search.cost(&other).is_some_and(|cost| cost.weight() <= weight) {
                *tidy = other;
            }
        };
        // regrouping is no choice of a plan file
        for trick in Trick::ALL.into_iter().filter(|trick| *trick != Trick::Regrouping) {
            let other = trick.left_out_of(&tidy);
            keep(self, &mut tidy, other);
        }
        let plain = JointPlan::default();
        for index in 0..tidy.joints.len() {
            let changes: [fn(&mut JointPlan, &JointPlan); 5] = [
                |joint, plain| joint.targets = plain.targets,
                |joint, plain| joint.origin_shift = plain.origin_shift,
                |joint, plain| joint.outward_offset = plain.outward_offset,
                |joint, plain| joint.inward_offset = plain.inward_offset,
                |joint, plain| joint.moment = plain.moment,
            ];
            for change in changes {
                let mut other = tidy.clone();
                change(&mut other.joints[index], &plain);
                keep(self, &mut tidy, other);
            }
            for target in 0..plain.targets.len() {
                let mut other = tidy.clone();
                other.joints[index].targets[target] = plain.targets[target];
                keep(self, &mut tidy, other);
            }
            for switch in 0..Switches::NAMES.len() {
                let mut other = tidy.clone();
                if let Some(on) = other.joints[index].switches.at(switch) {
                    *on = false;
                }
                keep(self, &mut tidy, other);
            }
        }
        tidy
    }

    fn keep_in_pool(&mut self, weight: usize, plan: &Plan) {
        const MOST: usize = 28;
        if weight > self.best.0.weight() + 9 || self.pool.iter().any(|(_, other)| other == plan) {
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

/// Candidates of a greedy search that concern all joints.
const OF_THE_ARM: usize = 12;

/// The candidates of a greedy search, in their order; `None` behind the last.
fn greedy_candidate(neighbourhood: &Neighbourhood, plan: &Plan, candidate: usize, round: usize) -> Option<Plan> {
    let dof = plan.joints.len();
    let mut other = plan.clone();
    let all = |other: &mut Plan, change: &dyn Fn(&mut JointPlan)| {
        other.joints.iter_mut().for_each(change);
    };
    match candidate {
        0 => other.gyrostat = !other.gyrostat,
        1 => other.carried_prismatics = !other.carried_prismatics,
        2 => other.turned_last_frame = !other.turned_last_frame,
        3 => all(&mut other, &|joint| joint.switches.axis_column = true),
        4 => all(&mut other, &|joint| {
            joint.switches.group_omega = true;
            joint.switches.group_omega_dot = true;
            joint.switches.group_acceleration = true;
            joint.switches.group_wrench = true;
        }),
        5 | 6 => {
            let rule = if candidate == 5 { OriginShift::GroupInward } else { OriginShift::GroupOutward };
            for (index, joint) in
                other.joints.iter_mut().enumerate().filter(|(index, _)| neighbourhood.offers(*index, rule))
            {
                joint.origin_shift = rule;
                if index > 0 {
                    (joint.outward_offset, joint.inward_offset) = (Side::Parent, Side::Parent);
                }
            }
        }
        7 => all(&mut other, &|joint| (joint.outward_offset, joint.inward_offset) = (Side::Parent, Side::Parent)),
        8 => all(&mut other, &|joint| joint.outward_offset = Side::Joint),
        9 => all(&mut other, &|joint| {
            joint.switches.scaled_twist_outward = true;
            joint.switches.scaled_twist_inward = true;
        }),
        10 => {
            for (index, joint) in other.joints.iter_mut().enumerate() {
                if neighbourhood.offers(index, OriginShift::MinusD) {
                    joint.origin_shift = OriginShift::MinusD;
                }
            }
        }
        11 => all(&mut other, &|joint| joint.switches.origin_unturned = true),
        _ => {
            let (index, choice) = ((candidate - OF_THE_ARM) % dof, (candidate - OF_THE_ARM) / dof);
            let joint = &mut other.joints[index];
            match choice {
                0 => joint.switches.axis_column = !joint.switches.axis_column,
                1 => joint.outward_offset = Side::Parent,
                2 => joint.outward_offset = Side::Joint,
                3 => joint.outward_offset = Side::Link,
                4 => joint.inward_offset = if joint.inward_offset == Side::Link { Side::Parent } else { Side::Link },
                5 => joint.origin_shift = OriginShift::MinusD,
                6 => joint.origin_shift = OriginShift::AnnulS13,
                7 => joint.origin_shift = OriginShift::AnnulS23,
                8 => joint.origin_shift = OriginShift::GroupInward,
                9 => joint.origin_shift = OriginShift::None,
                10 => other.length_scale = Scale::A(index + 1),
                11 => other.length_scale = Scale::D(index + 1),
                12 => other.force_scale = Scale::FirstMoment(index + 1, 0),
                13 => other.force_scale = Scale::FirstMoment(index + 1, 1),
                14 => joint.moment = Moment::Diagonal,
                15 => joint.moment = Moment::Inertia,
                16 => joint.switches.wrench_unturned = !joint.switches.wrench_unturned,
                17 => joint.switches.origin_unturned = !joint.switches.origin_unturned,
                18 => joint.switches.first_moment_unturned = !joint.switches.first_moment_unturned,
                19 => joint.switches.omega_dot_unturned = !joint.switches.omega_dot_unturned,
                20 => joint.switches.group_omega = !joint.switches.group_omega,
                21 => joint.switches.group_wrench = !joint.switches.group_wrench,
                22 if round > 0 => joint.origin_shift = OriginShift::NextOffset,
                23 if round > 0 => joint.targets[2] = RegroupingTarget::Sxx,
                24 if round > 0 => joint.targets[2] = RegroupingTarget::Syy,
                25 if round > 0 => joint.targets[1] = RegroupingTarget::Hy,
                26 if round > 0 => joint.targets[1] = RegroupingTarget::Syz,
                27 if round > 0 => joint.origin_shift = OriginShift::AnnulParentH,
                _ => return None,
            }
        }
    }
    Some(other)
}

/// The plan of a build that finds no plan file: a fixed number of plans is counted, on every machine the same.
pub(crate) fn default_plan(robot: &Robot, without: &[Trick]) -> Plan {
    let mut search = Exploration::new(robot, without);
    search.greedy(DEFAULT_EVALUATIONS);
    let plan = search.best.1.clone();
    search.tidied(&plan)
}
