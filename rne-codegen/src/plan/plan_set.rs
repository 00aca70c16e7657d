//! The choices by which the functions of a robot are compiled in the reduced form.

use std::collections::BTreeMap;

use rne_model::Robot;

use crate::CompileError;
use crate::function::{Argument, Function};
use crate::ir::Cost;
use crate::pipeline::Formulation;
use crate::plan::cost::{self, Evaluator};
use crate::plan::exploration::default_plan;
use crate::plan::file::{PlanFile, Rewritten};
use crate::plan::graph_text;
use crate::plan::trick::Trick;
use crate::plan::{JointPlan, OriginShift, Plan, RegroupingTarget, Scale};
use crate::reduced::algorithm::Algorithm;
use crate::refusal::LeftOut;

/// The choices by which a robot's functions are compiled in the reduced form.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanSet {
    /// The plan of every function that has a recursion of its own.
    pub plan: Plan,
    /// The functions whose graphs have been rewritten.
    pub rewritten: BTreeMap<Function, Rewritten>,
    maker: Maker,
}

/// Who made the choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Maker {
    /// The build, which takes what it proves: what cannot be proved is left out.
    Build,
    /// Somebody, in a plan file: it is compiled as it stands or not at all.
    PlanFile,
}

impl PlanSet {
    /// No choice made.
    #[must_use]
    pub fn none(robot: &Robot) -> Self {
        Self { maker: Maker::Build, ..Self::from(Plan::new(robot.dof())) }
    }

    /// The choices of a build that has no plan file: the same on every machine.
    #[must_use]
    pub fn default_of(robot: &Robot) -> Self {
        Self { maker: Maker::Build, ..Self::from(default_plan(robot, &[])) }
    }

    /// The same without some tricks. A rewritten graph is that of a plan with all of its tricks, so it goes with any of
    /// them.
    #[must_use]
    pub fn without(&self, robot: &Robot, tricks: &[Trick]) -> Self {
        let mut evaluator = Evaluator::new(robot, Function::InverseDynamics);
        let plan = without(&mut evaluator, &self.plan, tricks).unwrap_or_else(|| Plan::new(robot.dof()));
        let uses = |rewritten: &Rewritten, trick: &Trick| {
            *trick == Trick::Rewriting || rewritten.plan.as_ref().is_some_and(|plan| trick.is_in(plan))
        };
        let mut rewritten = self.rewritten.clone();
        rewritten.retain(|_, rewritten| !tricks.iter().any(|trick| uses(rewritten, trick)));
        Self { plan, rewritten, maker: self.maker }
    }

    pub(crate) fn is_of_build(&self) -> bool {
        self.maker == Maker::Build
    }

    /// Ever fewer choices, for a build that cannot prove all of them: without those of frames, without any, without
    /// regrouping.
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

    /// The algorithm by which a function takes the fewest operations, and the plan for it: that at hand, or that
    /// without the choices that it makes joint by joint for the recursion.
    pub(crate) fn cheapest(&self, robot: &Robot, function: Function) -> (Plan, Algorithm) {
        let mut algorithms = Algorithm::of_so_many(function, robot.dof());
        // articulated bodies are those of links alone
        algorithms.retain(|algorithm| !(robot.has_rotors() && matches!(algorithm, Algorithm::Aba(_))));
        let first = (self.plan.clone(), algorithms.first().copied().unwrap_or(Algorithm::Rnea));
        if algorithms.len() < 2 {
            return first;
        }
        let plain = Plan { joints: Plan::new(robot.dof()).joints, ..self.plan.clone() };
        let mut evaluator = Evaluator::new(robot, function);
        let plans = if plain == self.plan { vec![plain] } else { vec![self.plan.clone(), plain] };
        if function.takes(Argument::Payload) {
            let unscaled = Trick::Scales.left_out_of(&self.plan);
            let plans = [&plans[..], &[unscaled]].concat();
            return with_payload(&mut evaluator, &plans, &algorithms).unwrap_or(first);
        }
        let candidates = algorithms.iter().flat_map(|algorithm| plans.iter().map(|plan| (plan.clone(), *algorithm)));
        let costs = candidates
            .filter_map(|(plan, algorithm)| Some((evaluator.cost_of(&plan, algorithm)?.weight(), plan, algorithm)));
        costs.min_by_key(|(weight, ..)| *weight).map_or(first, |(_, plan, algorithm)| (plan, algorithm))
    }
}

/// What may be better for an arm with a payload: what is best for the last link alone need not be for both.
const FOR_A_PAYLOAD: [fn(&mut Plan); 6] = [
    // the payload would be turned with it
    |plan| plan.turned_last_frame = false,
    |plan| (plan.length_scale, plan.force_scale) = (Scale::Default, Scale::Default),
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

/// The best plan and algorithm for an arm with a payload that some changes of the last link lead to, one by one.
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
    // with a payload no last link is a sphere
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

/// A plan to be compiled as it stands.
impl From<Plan> for PlanSet {
    fn from(plan: Plan) -> Self {
        Self { plan, rewritten: BTreeMap::new(), maker: Maker::PlanFile }
    }
}

impl From<PlanFile> for PlanSet {
    fn from(file: PlanFile) -> Self {
        Self { rewritten: file.rewritten, ..Self::from(file.reduced.plan) }
    }
}

impl From<&PlanSet> for PlanSet {
    fn from(plans: &PlanSet) -> Self {
        plans.clone()
    }
}

/// A function written by one algorithm under a plan, every value once.
pub(crate) fn formulation(
    robot: &Robot,
    plan: &Plan,
    function: Function,
    algorithm: Algorithm,
) -> Result<Formulation, CompileError> {
    let sphere = plan.gyrostat && !function.takes(Argument::Payload);
    let plan = &Plan { gyrostat: sphere, ..plan.clone() };
    let written = cost::frame(robot, plan).and_then(|frame| frame.written(plan, function, algorithm));
    written.ok_or_else(|| {
        CompileError::Plan(format!(
            "the plan does not fit `{}`: one of its choices is not offered by this robot; `rne search ROBOT.yaml \
             --fresh` finds another",
            robot.name
        ))
    })
}

impl Rewritten {
    /// The graph that was rewritten.
    pub(crate) fn before(&self, robot: &Robot, function: Function) -> Result<Formulation, CompileError> {
        match &self.plan {
            Some(plan) => formulation(robot, plan, function, self.algorithm),
            None => Ok(Formulation::numbered(robot, function)),
        }
    }

    /// The rewritten graph: values keep the names that they have in the graph before.
    pub(crate) fn formulation(&self, robot: &Robot, function: Function) -> Result<Formulation, CompileError> {
        let before = self.before(robot, function)?;
        let read = graph_text::read(&self.graph, &before.traced.graph, function)
            .map_err(|(line, message)| CompileError::Graph { robot: robot.name.clone(), function, line, message })?;
        Ok(Formulation { traced: read.told_by(&before.traced), ..before })
    }

    /// The choices behind it, in words.
    pub(crate) fn choices(&self) -> Vec<String> {
        let rewriting = "rewriting: the graph that the choices below give, made smaller by exact algebra";
        let algorithm = self.algorithm.words().filter(|_| self.plan.is_some());
        let choices = self.plan.iter().flat_map(Plan::choices);
        [rewriting].into_iter().chain(algorithm).map(str::to_owned).chain(choices).collect()
    }
}

/// A plan without some tricks, and without those that are not there without them: a unit that is a regrouped moment
/// goes with the regrouping, an origin that sits where a prismatic link is carried goes with that.
fn without(evaluator: &mut Evaluator, plan: &Plan, tricks: &[Trick]) -> Option<Plan> {
    let rests = [Trick::Scales, Trick::OriginShifts, Trick::RegroupingTargets, Trick::LastFrame, Trick::Gyrostat];
    let mut plan = tricks.iter().fold(plan.clone(), |plan, trick| trick.left_out_of(&plan));
    for rest in rests {
        if evaluator.cost(&plan).is_some() {
            return Some(plan);
        }
        plan = rest.left_out_of(&plan);
    }
    evaluator.cost(&plan).is_some().then_some(plan)
}

/// Whether the choices of a plan matter to a function.
#[must_use]
pub fn is_planned(function: Function) -> bool {
    !Algorithm::of(function).is_empty()
}

/// What a plan costs for `inverse_dynamics`; `None` when it does not fit the robot.
#[must_use]
pub fn cost(robot: &Robot, plan: &Plan) -> Option<Cost> {
    Evaluator::new(robot, Function::InverseDynamics).cost(plan)
}

/// What each trick saves in `inverse_dynamics`: by how many operations the code is longer when it is left out. The
/// tricks of a plan are counted before rewriting.
#[must_use]
pub fn savings(robot: &Robot, plans: &PlanSet) -> Vec<(Trick, isize)> {
    let plan = &plans.plan;
    let mut evaluator = Evaluator::new(robot, Function::InverseDynamics);
    let Some(with) = evaluator.cost(plan) else { return Vec::new() };
    let more = |cost: &Cost| cost.total().cast_signed() - with.total().cast_signed();
    let used: Vec<Trick> = Trick::ALL.into_iter().filter(|trick| trick.is_in(plan)).collect();
    let saving = |trick: Trick| {
        let without = without(&mut evaluator, plan, &[trick])?;
        Some((trick, more(&evaluator.cost(&without)?)))
    };
    let mut savings: Vec<_> = used.into_iter().filter_map(saving).collect();
    let rewritten = plans.rewritten.get(&Function::InverseDynamics);
    savings.extend(rewritten.map(|rewritten| (Trick::Rewriting, -more(&rewritten.operations))));
    savings
}
