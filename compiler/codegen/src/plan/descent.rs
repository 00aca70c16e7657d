//! The short search of a build that finds no plan file. It counts the operations of a fixed number of plans, in a fixed
//! order, so that every machine chooses the same plan.

use rustc_hash::FxHashMap;

use rne_model::Robot;

use crate::ir::Cost;
use crate::plan::cost::{Evaluator, OpenChoices};
use crate::plan::trick::Trick;
use crate::plan::{JointPlan, Moment, OriginShift, Plan, RegroupingTarget, Scale, Side, Switches};

/// The number of plans whose operations are counted by a build that finds no plan file.
const DEFAULT_EVALUATIONS: usize = 240;

/// A test for plans that must not be chosen, whatever their cost.
type Veto<'v> = Box<dyn Fn(&Plan) -> bool + 'v>;

/// Counts the operations of plans of one robot, and remembers the costs and the best plan.
#[allow(missing_debug_implementations)] // a closure
pub struct Descent<'v> {
    evaluator: Evaluator,
    open: OpenChoices,
    without: Vec<Trick>,
    /// Refuses plans that would be the best by their cost, but must not be chosen for another reason.
    veto: Option<Veto<'v>>,
    known: FxHashMap<Plan, Option<Cost>>,
    counted: usize,
    best: (Cost, Plan),
}

impl<'v> Descent<'v> {
    /// Starts from the plain plan of a robot; no plan that uses a trick of `without` is counted.
    #[must_use]
    pub fn new(robot: &Robot, without: &[Trick]) -> Self {
        let mut evaluator = Evaluator::new(robot, crate::function_of_plan(robot));
        let plan = without.iter().fold(Plan::new(robot.joints.len()), |plan, trick| trick.left_out_of(&plan));
        // the plain plan applies to every robot
        let best = (evaluator.cost(&plan).unwrap_or_default(), plan);
        let (open, without) = (evaluator.open_choices(), without.to_vec());
        Self { evaluator, open, without, veto: None, known: FxHashMap::default(), counted: 0, best }
    }

    /// The choices that the robot leaves open.
    #[must_use]
    pub const fn open_choices(&self) -> &OpenChoices {
        &self.open
    }

    /// The cost of the cheapest plan so far, and this plan.
    #[must_use]
    pub const fn best(&self) -> &(Cost, Plan) {
        &self.best
    }

    /// The number of plans whose operations have been counted.
    #[must_use]
    pub const fn counted(&self) -> usize {
        self.counted
    }

    /// From now on, no plan for which `veto` is true becomes the best plan.
    pub fn refuse(&mut self, veto: impl Fn(&Plan) -> bool + 'v) {
        self.veto = Some(Box::new(veto));
    }

    /// Returns the cost of computing the torques by a plan; `None` if the plan does not fit the robot, or uses a trick
    /// that is left out.
    pub fn cost(&mut self, plan: &Plan) -> Option<Cost> {
        if self.without.iter().any(|trick| trick.is_in(plan)) {
            return None;
        }
        if let Some(known) = self.known.get(plan) {
            return *known;
        }
        self.counted += 1;
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

    /// Tries the choices in the order of their usual savings, each for all joints at once and then for each joint,
    /// until `most` plans have been counted.
    pub fn greedy(&mut self, most: usize) {
        let limit = self.counted + most;
        for round in 0..2 {
            for candidate in 0.. {
                if self.counted >= limit {
                    return;
                }
                let plan = self.best.1.clone();
                let Some(other) = greedy_candidate(&self.open, &plan, candidate, round) else { break };
                if other != plan {
                    let _ = self.cost(&other);
                }
            }
        }
    }

    /// Returns the plan without the choices that save nothing, so that it is easier to read.
    pub fn tidied(&mut self, plan: &Plan) -> Plan {
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
}

/// The number of candidates of a greedy search that concern all joints.
const OF_THE_ARM: usize = 14;

/// Returns one candidate of a greedy search, in their order; `None` after the last.
fn greedy_candidate(open: &OpenChoices, plan: &Plan, candidate: usize, round: usize) -> Option<Plan> {
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
            for (index, joint) in other.joints.iter_mut().enumerate().filter(|(index, _)| open.offers(*index, rule)) {
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
                if open.offers(index, OriginShift::MinusD) {
                    joint.origin_shift = OriginShift::MinusD;
                }
            }
        }
        11 => all(&mut other, &|joint| joint.switches.origin_unturned = true),
        12 | 13 if !open.floating_base => {}
        12 => other.base_moment = Moment::Diagonal,
        13 => other.base_moment = Moment::Inertia,
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

/// Returns the plan of a build that finds no plan file, the best of a fixed number of plans; it is the same on every
/// machine.
pub(crate) fn default_plan(robot: &Robot, without: &[Trick]) -> Plan {
    let mut descent = Descent::new(robot, without);
    descent.greedy(DEFAULT_EVALUATIONS);
    let plan = descent.best.1.clone();
    descent.tidied(&plan)
}
