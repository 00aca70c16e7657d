//! Which plan a function is compiled by, and the search for a better one.

use rne_model::Robot;

use super::evaluator::{self, Frame};
use super::graph_text;
use super::merged;
use super::plan::Plan;
use super::plan_file::{Accuracy, PlanFile, Reduced, Rewritten};
use super::rewrite::Rewriting;
use super::search::{Clock, Over, Progress, Search, default_plan};
use super::sheet::{Cost, Dag};
use super::transcript::Drawing;
use super::trick::Trick;
use super::way::Way;
use crate::CompileError;
use crate::function::{Form, Function};
use crate::fusion;
use crate::program::Program;
use crate::proof;

/// The choices by which a robot's functions are compiled in the reduced form.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The plan of the reduced form.
    pub plan: Plan,
    /// The rewritten graph of `inverse_dynamics`, if there is one.
    pub rewritten: Option<Rewritten>,
}

impl Choice {
    /// No choice made.
    #[must_use]
    pub fn none(robot: &Robot) -> Self {
        Self { plan: Plan::new(robot.dof()), rewritten: None }
    }

    /// The choice of a build that has no plan file, without some tricks: the same on every machine.
    #[must_use]
    pub fn default_without(robot: &Robot, without: &[Trick]) -> Self {
        Self { plan: default_plan(robot, without), rewritten: None }
    }

    /// The choice of a build that has no plan file.
    #[must_use]
    pub fn default_of(robot: &Robot) -> Self {
        Self::default_without(robot, &[])
    }

    /// Compiles a function for the shortest wait ([`fusion::soonest`]), and proves that it is that of the seven steps.
    ///
    /// # Errors
    /// When the plan does not fit the robot, or there is no rewritten graph for the rewritten form.
    pub fn compile(&self, robot: &Robot, function: Function, form: Form) -> Result<Program, CompileError> {
        self.compile_arranged(robot, function, form, |program| {
            if program.is_long() { fusion::fused(&program) } else { fusion::soonest(&program) }
        })
    }

    /// The same for the fewest instructions, as [`fusion::fused`] arranges it, and proved so. The seven steps are left as they
    /// are, for they have the bits of the runtime.
    ///
    /// # Errors
    /// As [`Choice::compile`].
    pub fn compile_fused(&self, robot: &Robot, function: Function, form: Form) -> Result<Program, CompileError> {
        self.compile_arranged(robot, function, form, |program| fusion::fused(&program))
    }

    fn compile_arranged(
        &self,
        robot: &Robot,
        function: Function,
        form: Form,
        arranged: fn(Program) -> Program,
    ) -> Result<Program, CompileError> {
        if form == Form::SevenSteps {
            return crate::compile(robot, function, form);
        }
        if form == Form::Rewritten && function == Function::InverseDynamics && robot.run_time.is_empty() {
            return self.compile_rewritten(robot, arranged);
        }
        let is_fixed = robot.run_time.is_empty();
        match function {
            // bearings feel what regrouping moves from link to link, and motors have nothing to reduce
            Function::JointWrenches | Function::ActuatorTorques => crate::compile(robot, function, Form::SevenSteps),
            // then there is nothing to be the same as
            Function::ForwardDynamics if proof::divides_by_zero(robot, function) => {
                crate::compile(robot, function, Form::SevenSteps)
            }
            // numbers that are not known cannot be regrouped
            _ if is_fixed && !Way::of(function).is_empty() => {
                let (plan, way) = self.cheapest(robot, function);
                let (frame, drawing) = drawn_in(robot, &plan, function, way)?;
                let program = drawing.program(robot, &frame, function, form, arranged)?;
                let choices = way.words().map(str::to_owned).into_iter().chain(plan.choices()).collect();
                Ok(Program { choices, ..program })
            }
            _ => {
                let merged = merged::program(robot, function, arranged)?;
                let plain = crate::compile(robot, function, Form::SevenSteps)?;
                // a value that is found where it is not used otherwise costs what it takes there
                Ok(if plain.operations().total() < merged.operations().total() { plain } else { merged })
            }
        }
    }

    /// The way to write a function that takes the fewest operations, and the plan for it: that at hand, or that without the
    /// choices that it makes joint by joint for the recursion.
    fn cheapest(&self, robot: &Robot, function: Function) -> (Plan, Way) {
        let ways = Way::of(function);
        let first = (self.plan.clone(), ways.first().copied().unwrap_or(Way::Recursion));
        if ways.len() < 2 {
            return first;
        }
        let plain = Plan { joints: Plan::new(robot.dof()).joints, ..self.plan.clone() };
        let mut evaluator = evaluator::Evaluator::new(robot, function);
        let candidates = ways.iter().flat_map(|way| [(self.plan.clone(), *way), (plain.clone(), *way)]);
        let costs = candidates.filter_map(|(plan, way)| Some((evaluator.cost_of(&plan, way)?.weight(), plan, way)));
        costs.min_by_key(|(weight, ..)| *weight).map_or(first, |(_, plan, way)| (plan, way))
    }

    fn compile_rewritten(&self, robot: &Robot, arranged: fn(Program) -> Program) -> Result<Program, CompileError> {
        let Some(Rewritten { plan, graph, .. }) = &self.rewritten else {
            return Err(CompileError::Plan(format!(
                "`{}` has no rewritten graph: `rne search --rewrite` writes one into the plan file beside a robot file, which \
                 `path = \"…\"` finds",
                robot.name
            )));
        };
        let function = Function::InverseDynamics;
        let (frame, drawing) = drawn(robot, plan, function)?;
        let dag = graph_text::read(graph, &frame, &drawing.dag.sheet.numbers)
            .map_err(|(line, message)| misread(robot, line, &message))?;
        drawing.with(dag).program(robot, &frame, function, Form::Rewritten, arranged)
    }
}

impl From<PlanFile> for Choice {
    fn from(file: PlanFile) -> Self {
        Self { plan: file.reduced.plan, rewritten: file.rewritten }
    }
}

/// A graph that cannot be read stands in a plan file; a fresh search replaces it.
fn misread(robot: &Robot, line: usize, message: &str) -> CompileError {
    CompileError::Graph { robot: robot.name.clone(), line, message: message.to_owned() }
}

/// The recursion of a function.
fn drawn(robot: &Robot, plan: &Plan, function: Function) -> Result<(Frame, Drawing), CompileError> {
    drawn_in(robot, plan, function, Way::Recursion)
}

fn drawn_in(robot: &Robot, plan: &Plan, function: Function, way: Way) -> Result<(Frame, Drawing), CompileError> {
    let misfit = || {
        CompileError::Plan(format!(
            "the plan does not fit `{}`: one of its choices is not offered by this robot; `rne search --fresh` writes it anew",
            robot.name
        ))
    };
    let frame = evaluator::frame(robot, plan).ok_or_else(misfit)?;
    let drawing = Drawing::new(&frame, plan, function, way).ok_or_else(misfit)?;
    Ok((frame, drawing))
}

/// Whether the choices of a plan matter to a function.
#[must_use]
pub fn is_planned(function: Function) -> bool {
    !Way::of(function).is_empty()
}

/// What a plan costs for a function; `None` when it does not fit the robot.
#[must_use]
pub fn cost(robot: &Robot, plan: &Plan) -> Option<Cost> {
    evaluator::Evaluator::new(robot, Function::InverseDynamics).cost(plan)
}

/// What each trick of a plan saves: by how many operations the code is longer when it is left out.
#[must_use]
pub fn savings(robot: &Robot, plan: &Plan) -> Vec<(Trick, isize)> {
    let mut evaluator = evaluator::Evaluator::new(robot, Function::InverseDynamics);
    let Some(with) = evaluator.cost(plan) else { return Vec::new() };
    let used = Trick::ALL.into_iter().filter(|trick| trick.is_in(plan));
    let saving = |trick: Trick| {
        let without = trick.left_out_of(plan);
        // a unit that is a regrouped moment goes with the regrouping
        let without = evaluator.cost(&without).or_else(|| evaluator.cost(&Trick::Scales.left_out_of(&without)))?;
        Some((trick, without.total().cast_signed() - with.total().cast_signed()))
    };
    used.filter_map(saving).collect()
}

/// What a search is asked to do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// Rewrite the graphs of the best plans as well.
    pub rewrite: bool,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The plan file.
    pub file: PlanFile,
}

impl Found {
    /// The text of the plan file.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        self.file.to_yaml()
    }
}

/// Looks for a cheaper plan, from the one at hand onwards. What it finds is not much less precise in single precision than
/// the seven steps, and never worse than a plan at hand of which that is true.
///
/// `clock` is asked now and then how much of the time is over.
///
/// # Errors
/// When the result cannot be proved, which would be a mistake of this program.
pub fn search(
    robot: &Robot,
    known: Option<&PlanFile>,
    wanted: Wanted,
    clock: Clock<'_>,
) -> Result<Found, CompileError> {
    let mut search = Search::new(robot, &[]);
    let model = robot.clone();
    search.refuse(move |plan| {
        let choice = Choice { plan: plan.clone(), rewritten: None };
        !is_precise(&model, &choice, Form::Reduced).unwrap_or(false)
    });
    search.greedy(usize::MAX);
    if let Some(known) = known {
        search.start_from(&known.reduced.plan);
        if let Some(rewritten) = &known.rewritten {
            search.start_from(&rewritten.plan);
        }
    }
    // the first part of the time goes to plans, the rest to rewriting
    let share = if wanted.rewrite { 0.45 } else { 1.0 };
    let _ = plans(&mut search, wanted.seed, share, clock);
    let plan = search.best.1.clone();
    let plan = search.tidied(&plan);
    let reduced_cost = search.cost(&plan).unwrap_or_default();
    let mut best: Option<(Cost, Rewritten)> = None;
    if let Some(rewritten) = known.and_then(|known| known.rewritten.as_ref()) {
        let (frame, drawing) = drawn(robot, &rewritten.plan, Function::InverseDynamics)?;
        let read = graph_text::read(&rewritten.graph, &frame, &drawing.dag.sheet.numbers);
        let dag = read.map_err(|(line, message)| misread(robot, line, &message))?;
        {
            // one that has lost too much precision may be replaced by a dearer one
            let choice = Choice { plan: rewritten.plan.clone(), rewritten: Some(rewritten.clone()) };
            if !wanted.rewrite || is_precise(robot, &choice, Form::Rewritten)? {
                best = Some((evaluator::cost(&dag, &frame, &mut Vec::new()), rewritten.clone()));
            }
        }
    }
    if wanted.rewrite {
        rewritten(robot, &mut search, &mut best, share, wanted.seed, clock)?;
    }
    let choice = Choice { plan: plan.clone(), rewritten: best.as_ref().map(|(_, rewritten)| rewritten.clone()) };
    let accuracy = |form| {
        let program = choice.compile(robot, Function::InverseDynamics, form)?;
        let proof = program.proof.ok_or_else(|| CompileError::Plan("a program without proof".to_owned()))?;
        Ok(Accuracy::from(&proof))
    };
    let reduced = Reduced { operations: reduced_cost, accuracy: accuracy(Form::Reduced)?, plan };
    let rewritten = best
        .map(|(operations, rewritten)| Ok(Rewritten { operations, accuracy: accuracy(Form::Rewritten)?, ..rewritten }))
        .transpose()?;
    Ok(Found { file: PlanFile::new(robot, reduced, rewritten) })
}

/// How much less precise than the seven steps a form may be in single precision, on the average.
const PRECISION: f64 = 3.0;

/// States over which the average is taken.
const STATES: usize = 200;

fn is_precise(robot: &Robot, choice: &Choice, form: Form) -> Result<bool, CompileError> {
    let function = Function::InverseDynamics;
    let plan =
        if let (Form::Rewritten, Some(rewritten)) = (form, &choice.rewritten) { &rewritten.plan } else { &choice.plan };
    let (frame, drawing) = drawn(robot, plan, function)?;
    let drawing = match (form, &choice.rewritten) {
        (Form::Rewritten, Some(rewritten)) => {
            match graph_text::read(&rewritten.graph, &frame, &drawing.dag.sheet.numbers) {
                Ok(dag) => drawing.with(dag),
                Err(_) => return Ok(false),
            }
        }
        _ => drawing,
    };
    let (program, _) = drawing.unproved(robot, &frame, function, form)?;
    Ok(proof::loss_of_precision(robot, &program, STATES)? <= PRECISION)
}

/// Descent, then annealing in rounds until `share` of the time is over.
fn plans(search: &mut Search, seed: u64, share: f64, clock: Clock<'_>) -> Result<(), Over> {
    const ROUNDS: u32 = 4;
    let until = |end: f64, clock: &mut dyn FnMut(&Progress) -> Option<f64>, progress: &Progress| {
        clock(progress).filter(|over| *over < end)
    };
    let half = share * 0.5;
    // it ends when it is done, or out of its own time, or out of all
    let _ = search.descend(&mut |progress| until(half, clock, progress));
    let start = clock(&search.progress("descent")).ok_or(Over)?;
    for round in 0..ROUNDS {
        let length = (share - start) / f64::from(ROUNDS);
        let begin = start + length * f64::from(round);
        let hottest = if round + 1 == ROUNDS { 2.0 } else { 4.0 };
        let mut local = |progress: &Progress| clock(progress).map(|over| ((over - begin) / length).clamp(0.0, 1.0));
        search.anneal(seed.wrapping_add(u64::from(round)), hottest, &mut local)?;
    }
    // what annealing found may have better neighbours
    let _ = search.descend(&mut |progress| until(share + 0.02, clock, progress));
    Ok(())
}

/// Rewrites the graphs of the best plans: half of the time all of them, half the four that came out best.
fn rewritten(
    robot: &Robot,
    search: &mut Search,
    best: &mut Option<(Cost, Rewritten)>,
    from: f64,
    seed: u64,
    clock: Clock<'_>,
) -> Result<(), CompileError> {
    let mut candidates: Vec<Plan> = vec![search.best.1.clone()];
    candidates.extend(search.pool.iter().map(|(_, plan)| plan.clone()).filter(|plan| *plan != search.best.1));
    candidates.truncate(16);
    let mut candidates: Vec<Plan> = candidates.iter().map(|plan| search.tidied(plan)).collect();
    candidates.dedup();
    // (cost, plan, graph, numbers given, frame)
    let mut graphs: Vec<(Cost, Plan, Dag, usize, Frame)> = Vec::new();
    if let Some((cost, known)) = best {
        let (frame, drawing) = drawn(robot, &known.plan, Function::InverseDynamics)?;
        let given = drawing.dag.sheet.numbers.len();
        // the graph's own constants follow those of the plan, as in a graph that has just been rewritten
        let mut dag = drawing.dag.clone();
        if let Ok(read) = graph_text::read(&known.graph, &frame, &drawing.dag.sheet.numbers) {
            dag = graph_text::on_numbers_of(&read, &dag);
        }
        graphs.push((*cost, known.plan.clone(), dag, given, frame));
    }
    for plan in candidates {
        let Ok((frame, drawing)) = drawn(robot, &plan, Function::InverseDynamics) else { continue };
        let cost = evaluator::cost(&drawing.dag, &frame, &mut Vec::new());
        let given = drawing.dag.sheet.numbers.len();
        graphs.push((cost, plan, drawing.dag, given, frame));
    }
    let middle = from + (1.0 - from) * 0.5;
    'stages: for (stage, begin, end, hottest, most) in [(0, from, middle, 0.2, usize::MAX), (1, middle, 1.0, 0.22, 4)] {
        graphs.sort_by_key(|(cost, ..)| cost.weight());
        graphs.truncate(most);
        #[allow(clippy::cast_precision_loss)] // a handful
        let length = (end - begin) / graphs.len() as f64;
        for (index, (cost, _, dag, _, frame)) in graphs.iter_mut().enumerate() {
            #[allow(clippy::cast_precision_loss)]
            let start = begin + length * index as f64;
            let seed = seed.wrapping_add(stage * 100 + index as u64);
            let mut rewriting = Rewriting::new(dag.clone(), seed, |dag, live| evaluator::cost(dag, frame, live));
            let mut local = |progress: &Progress| clock(progress).map(|over| ((over - start) / length).clamp(0.0, 1.0));
            let plans = search.plans;
            let least = best.as_ref().map(|(cost, _)| *cost);
            let report = |cost: Cost| Progress {
                plans,
                best: least.filter(|least| least.weight() < cost.weight()).unwrap_or(cost),
                phase: "rewriting",
            };
            let ended = rewriting.anneal(hottest, report, &mut local);
            (*cost, *dag) = rewriting.best();
            if ended.is_err() {
                break 'stages;
            }
        }
    }
    graphs.sort_by_key(|(cost, ..)| cost.weight());
    let mut cheapest = None;
    for (cost, plan, dag, given, _) in graphs {
        if best.as_ref().is_some_and(|(least, _)| cost.weight() >= least.weight()) {
            break;
        }
        let graph = graph_text::written(&dag, given);
        let rewritten = Rewritten { operations: cost, accuracy: Accuracy::default(), plan, graph };
        let choice = Choice { plan: rewritten.plan.clone(), rewritten: Some(rewritten.clone()) };
        if is_precise(robot, &choice, Form::Rewritten)? {
            *best = Some((cost, rewritten));
            break;
        }
        cheapest.get_or_insert((cost, rewritten));
    }
    if best.is_none() {
        *best = cheapest;
    }
    Ok(())
}
