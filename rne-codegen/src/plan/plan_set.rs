//! Which plan a function is compiled by, and the search for a better one.

use rne_model::Robot;

use crate::CompileError;
use crate::fma;
use crate::formulate;
use crate::function::{Form, Function};
use crate::ir::name::Name;
use crate::ir::{Builder, Cost, Graph, Policy, Reading, Traced};
use crate::lower::{Heading, lower};
use crate::plan::Plan;
use crate::plan::cost::{self, Frame};
use crate::plan::file::{Accuracy, PlanFile, Reduced, Rewritten};
use crate::plan::graph_text;
use crate::plan::rewriting::Rewriting;
use crate::plan::search::{Clock, Over, Progress, Search, default_plan};
use crate::plan::trick::Trick;
use crate::program::Program;
use crate::prove::{self, Reference};
use crate::reduced::algorithm::Way;

/// The choices by which a robot's functions are compiled in the reduced form.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The plan of the reduced form.
    pub plan: Plan,
    /// The rewritten graph of `inverse_dynamics`, if there is one.
    pub rewritten: Option<Rewritten>,
    /// Who made it.
    pub maker: Maker,
}

/// Who made the choices by which a robot is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maker {
    /// The build, which takes what it proves: what cannot be proved is left out.
    Build,
    /// Somebody, in a plan file: it is compiled as it stands or not at all.
    PlanFile,
}

impl Choice {
    /// A plan to be compiled as it stands.
    #[must_use]
    pub const fn of(plan: Plan) -> Self {
        Self { plan, rewritten: None, maker: Maker::PlanFile }
    }

    /// No choice made.
    #[must_use]
    pub fn none(robot: &Robot) -> Self {
        Self { maker: Maker::Build, ..Self::of(Plan::new(robot.dof())) }
    }

    /// The choice of a build that has no plan file, without some tricks: the same on every machine.
    #[must_use]
    pub fn default_without(robot: &Robot, without: &[Trick]) -> Self {
        Self { maker: Maker::Build, ..Self::of(default_plan(robot, without)) }
    }

    /// The choice of a build that has no plan file.
    #[must_use]
    pub fn default_of(robot: &Robot) -> Self {
        Self::default_without(robot, &[])
    }

    /// Compiles a function for the shortest wait ([`fma::soonest`]), and proves that it is that of the seven steps.
    ///
    /// # Errors
    /// When the plan does not fit the robot, or there is no rewritten graph for the rewritten form.
    pub fn compile(&self, robot: &Robot, function: Function, form: Form) -> Result<Program, CompileError> {
        self.compile_arranged(robot, function, form, |program| {
            if program.is_long() { fma::fused(&program) } else { fma::soonest(&program) }
        })
    }

    /// The same for the fewest instructions, as [`fma::fused`] arranges it, and proved so. The seven steps are left as
    /// they are, for they have the bits of the runtime.
    ///
    /// # Errors
    /// As [`Choice::compile`].
    pub fn compile_fused(&self, robot: &Robot, function: Function, form: Form) -> Result<Program, CompileError> {
        self.compile_arranged(robot, function, form, |program| fma::fused(&program))
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
        let is_fixed = robot.run_time.is_empty();
        if form == Form::Rewritten && function == Function::InverseDynamics && is_fixed {
            return self.compile_rewritten(robot, arranged).map_err(|error| error.suspecting(robot, true));
        }
        let is_irreducible = function.entry().is_irreducible;
        // then there is nothing to be the same as
        if is_irreducible || function.divides().is_some() && prove::divides_by_zero(robot, function) {
            return crate::compile(robot, function, Form::SevenSteps);
        }
        // numbers that are not known cannot be regrouped
        if !is_fixed || Way::of(function).is_empty() {
            return compile_merged(robot, function, arranged);
        }
        match self.compile_planned(robot, function, form, arranged) {
            // fewer choices make no program shorter
            Err(error @ CompileError::TooLarge { .. }) => Err(error),
            Err(_) if self.maker == Maker::Build => self.compile_with_less(robot, function, form, arranged),
            done => done.map_err(|error| error.suspecting(robot, self.maker == Maker::PlanFile)),
        }
    }

    /// By the plan, in the way that takes the fewest operations.
    fn compile_planned(
        &self,
        robot: &Robot,
        function: Function,
        form: Form,
        arranged: fn(Program) -> Program,
    ) -> Result<Program, CompileError> {
        let (plan, way) = self.cheapest(robot, function);
        let (frame, names, written) = written_in(robot, &plan, function, way)?;
        let heading = Heading { robot, function, form };
        let program = proved(&heading, written, &names, frame.table.reading, arranged, &reference(robot, function)?)?;
        let choices = way.words().map(str::to_owned).into_iter().chain(plan.choices()).collect();
        Ok(Program { algorithm: way, choices, ..program })
    }

    /// By ever fewer choices until the program can be proved: without those of frames, without any, without regrouping,
    /// the plain formulas with equal values merged, the plain formulas.
    fn compile_with_less(
        &self,
        robot: &Robot,
        function: Function,
        form: Form,
        arranged: fn(Program) -> Program,
    ) -> Result<Program, CompileError> {
        let unframed = Plan { turned_last_frame: false, carried_prismatics: false, ..self.plan.clone() };
        let none = Plan::new(robot.dof());
        let unregrouped = Plan { regrouped: false, ..none.clone() };
        let mut tried = vec![self.plan.clone()];
        for plan in [unframed, none, unregrouped] {
            if tried.contains(&plan) {
                continue;
            }
            let choice = Self { plan: plan.clone(), ..self.clone() };
            if let Ok(program) = choice.compile_planned(robot, function, form, arranged) {
                return Ok(program);
            }
            tried.push(plan);
        }
        compile_merged(robot, function, arranged)
    }

    /// The way to write a function that takes the fewest operations, and the plan for it: that at hand, or that without
    /// the choices that it makes joint by joint for the recursion.
    fn cheapest(&self, robot: &Robot, function: Function) -> (Plan, Way) {
        let ways = Way::of_so_many(function, robot.dof());
        let first = (self.plan.clone(), ways.first().copied().unwrap_or(Way::Recursion));
        if ways.len() < 2 {
            return first;
        }
        let plain = Plan { joints: Plan::new(robot.dof()).joints, ..self.plan.clone() };
        let mut evaluator = cost::Evaluator::new(robot, function);
        let plans = if plain == self.plan { vec![plain] } else { vec![self.plan.clone(), plain] };
        let candidates = ways.iter().flat_map(|way| plans.iter().map(|plan| (plan.clone(), *way)));
        let costs = candidates.filter_map(|(plan, way)| Some((evaluator.cost_of(&plan, way)?.weight(), plan, way)));
        costs.min_by_key(|(weight, ..)| *weight).map_or(first, |(_, plan, way)| (plan, way))
    }

    fn compile_rewritten(&self, robot: &Robot, arranged: fn(Program) -> Program) -> Result<Program, CompileError> {
        let Some(Rewritten { plan, graph, .. }) = &self.rewritten else {
            return Err(CompileError::Plan(format!(
                "`{}` has no rewritten graph: `rne search --rewrite` writes one into the plan file beside a robot \
                file, which \
                 `path = \"…\"` finds",
                robot.name
            )));
        };
        let function = Function::InverseDynamics;
        let (frame, names, written) = rewritten_graph(robot, plan, graph)?;
        let heading = Heading { robot, function, form: Form::Rewritten };
        proved(&heading, written, &names, frame.table.reading, arranged, &reference(robot, function)?)
    }
}

/// The seven steps of a function, to be held against.
fn reference(robot: &Robot, function: Function) -> Result<Reference<'_>, CompileError> {
    Reference::new(robot, function, |function| crate::compile(robot, function, Form::SevenSteps))
}

/// Lowers a graph; the program is `arranged` and proved to be that of the seven steps.
fn proved(
    heading: &Heading<'_>,
    written: Traced,
    names: &[Name],
    reading: Reading,
    arranged: fn(Program) -> Program,
    reference: &Reference<'_>,
) -> Result<Program, CompileError> {
    let (program, exactly) = lower(heading, written, names)?;
    let mut program = arranged(program);
    program.proof = Some(prove::prove(reference, &program, &exactly, reading)?);
    Ok(program)
}

/// The plain formulas of a function with every value computed once, however often and in whatever way the formulas
/// compute it: the reduced form of what has no recursion of its own. As they are where that is cheaper, or cannot be
/// proved.
fn compile_merged(
    robot: &Robot,
    function: Function,
    arranged: fn(Program) -> Program,
) -> Result<Program, CompileError> {
    let plain = reference(robot, function)?;
    let reading = Reading::default();
    let builder = Builder::traced(Policy::Value, reading, function);
    let (names, outputs): (Vec<Name>, Vec<_>) = formulate::outputs(&builder, robot, function).into_iter().unzip();
    let written = builder.finish(outputs).numbered();
    match proved(&Heading { robot, function, form: Form::Reduced }, written, &names, reading, arranged, &plain) {
        // a value that is found where it is not used otherwise costs what it takes there
        Ok(merged) if merged.operations().total() <= plain.operations() => Ok(merged),
        _ => Ok(plain.into_program()),
    }
}

impl From<PlanFile> for Choice {
    fn from(file: PlanFile) -> Self {
        Self { plan: file.reduced.plan, rewritten: file.rewritten, maker: Maker::PlanFile }
    }
}

/// A graph that cannot be read stands in a plan file; a fresh search replaces it.
fn misread(robot: &Robot, line: usize, message: &str) -> CompileError {
    CompileError::Graph { robot: robot.name.clone(), line, message: message.to_owned() }
}

/// A function written in one of its ways under a plan.
fn written_in(
    robot: &Robot,
    plan: &Plan,
    function: Function,
    way: Way,
) -> Result<(Frame, Vec<Name>, Traced), CompileError> {
    let misfit = || {
        CompileError::Plan(format!(
            "the plan does not fit `{}`: one of its choices is not offered by this robot; `rne search --fresh` \
            writes it anew",
            robot.name
        ))
    };
    let frame = cost::frame(robot, plan).ok_or_else(misfit)?;
    let (names, written) = frame.written(plan, function, way).ok_or_else(misfit)?;
    Ok((frame, names, written))
}

/// The torques by a plan.
fn torques_by(robot: &Robot, plan: &Plan) -> Result<(Frame, Vec<Name>, Traced), CompileError> {
    written_in(robot, plan, Function::InverseDynamics, Way::Recursion)
}

/// A rewritten graph of the torques: values keep the names that they have under its plan.
fn rewritten_graph(robot: &Robot, plan: &Plan, text: &str) -> Result<(Frame, Vec<Name>, Traced), CompileError> {
    let (frame, names, plain) = torques_by(robot, plan)?;
    let read = graph_text::read(text, &frame, &plain.graph, Function::InverseDynamics)
        .map_err(|(line, message)| misread(robot, line, &message))?;
    Ok((frame, names, read.told_by(&plain)))
}

/// Whether the choices of a plan matter to a function.
#[must_use]
pub fn is_planned(function: Function) -> bool {
    !Way::of(function).is_empty()
}

/// What a plan costs for a function; `None` when it does not fit the robot.
#[must_use]
pub fn cost(robot: &Robot, plan: &Plan) -> Option<Cost> {
    cost::Evaluator::new(robot, Function::InverseDynamics).cost(plan)
}

/// What each trick of a plan saves: by how many operations the code is longer when it is left out.
#[must_use]
pub fn savings(robot: &Robot, plan: &Plan) -> Vec<(Trick, isize)> {
    let mut evaluator = cost::Evaluator::new(robot, Function::InverseDynamics);
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

/// Looks for a cheaper plan, from the one at hand onwards. What it finds is not much less precise in single precision
/// than the seven steps, and never worse than a plan at hand of which that is true.
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
    let reference = reference(robot, Function::InverseDynamics)?;
    let mut search = Search::new(robot, &[]);
    search.refuse(|plan| !is_sound(&reference, &Choice::of(plan.clone()), Form::Reduced).unwrap_or(false));
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
        let (_, _, read) = rewritten_graph(robot, &rewritten.plan, &rewritten.graph)?;
        // one that has lost too much precision may be replaced by a dearer one
        let choice = Choice { rewritten: Some(rewritten.clone()), ..Choice::of(rewritten.plan.clone()) };
        if !wanted.rewrite || is_sound(&reference, &choice, Form::Rewritten)? {
            best = Some((read.graph.cost(&mut Vec::new()), rewritten.clone()));
        }
    }
    if wanted.rewrite {
        rewritten(&reference, &mut search, &mut best, share, wanted.seed, clock)?;
    }
    let rewritten = best.as_ref().map(|(_, rewritten)| rewritten.clone());
    let choice = Choice { plan: plan.clone(), rewritten, maker: Maker::PlanFile };
    let accuracy = |form| {
        let program = choice.compile(robot, Function::InverseDynamics, form);
        // the plan was made here
        let program = program.map_err(|error| error.suspecting(robot, false))?;
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

/// Whether a form can be proved, and is not much less precise than the seven steps.
fn is_sound(reference: &Reference<'_>, choice: &Choice, form: Form) -> Result<bool, CompileError> {
    let robot = reference.robot();
    let (frame, names, written) = match (form, &choice.rewritten) {
        (Form::Rewritten, Some(rewritten)) => match rewritten_graph(robot, &rewritten.plan, &rewritten.graph) {
            Ok(read) => read,
            Err(_) => return Ok(false),
        },
        _ => torques_by(robot, &choice.plan)?,
    };
    let (program, exactly) = lower(&Heading { robot, function: Function::InverseDynamics, form }, written, &names)?;
    if prove::identical(robot, &program, &exactly, frame.table.reading).is_err() {
        return Ok(false);
    }
    Ok(prove::loss_of_precision(reference, &program, STATES) <= PRECISION)
}

/// Descent, then annealing in rounds until `share` of the time is over.
fn plans(search: &mut Search<'_>, seed: u64, share: f64, clock: Clock<'_>) -> Result<(), Over> {
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
    reference: &Reference<'_>,
    search: &mut Search<'_>,
    best: &mut Option<(Cost, Rewritten)>,
    from: f64,
    seed: u64,
    clock: Clock<'_>,
) -> Result<(), CompileError> {
    let robot = reference.robot();
    let mut candidates: Vec<Plan> = vec![search.best.1.clone()];
    candidates.extend(search.pool.iter().map(|(_, plan)| plan.clone()).filter(|plan| *plan != search.best.1));
    candidates.truncate(16);
    let mut candidates: Vec<Plan> = candidates.iter().map(|plan| search.tidied(plan)).collect();
    candidates.dedup();
    // (cost, plan, graph, numbers given)
    let mut graphs: Vec<(Cost, Plan, Graph, Vec<u32>)> = Vec::new();
    if let Some((cost, known)) = best {
        let (frame, _, plain) = torques_by(robot, &known.plan)?;
        let given = plain.graph.factors();
        // the graph's own constants follow those of the plan, as in a graph that has just been rewritten
        let read = graph_text::read(&known.graph, &frame, &plain.graph, Function::InverseDynamics);
        let graph =
            read.map_or_else(|_| plain.graph.clone(), |read| graph_text::on_numbers_of(&read.graph, &plain.graph));
        graphs.push((*cost, known.plan.clone(), graph, given));
    }
    for plan in candidates {
        let Ok((_, _, written)) = torques_by(robot, &plan) else { continue };
        let cost = written.graph.cost(&mut Vec::new());
        let given = written.graph.factors();
        graphs.push((cost, plan, written.graph, given));
    }
    let middle = from + (1.0 - from) * 0.5;
    'stages: for (stage, begin, end, hottest, most) in [(0, from, middle, 0.2, usize::MAX), (1, middle, 1.0, 0.22, 4)] {
        graphs.sort_by_key(|(cost, ..)| cost.weight());
        graphs.truncate(most);
        #[allow(clippy::cast_precision_loss)] // a handful
        let length = (end - begin) / graphs.len() as f64;
        for (index, (cost, _, graph, _)) in graphs.iter_mut().enumerate() {
            #[allow(clippy::cast_precision_loss)]
            let start = begin + length * index as f64;
            let seed = seed.wrapping_add(stage * 100 + index as u64);
            let mut rewriting = Rewriting::new(graph.clone(), seed, Graph::cost);
            let mut local = |progress: &Progress| clock(progress).map(|over| ((over - start) / length).clamp(0.0, 1.0));
            let plans = search.plans;
            let least = best.as_ref().map(|(cost, _)| *cost);
            let report = |cost: Cost| Progress {
                plans,
                best: least.filter(|least| least.weight() < cost.weight()).unwrap_or(cost),
                phase: "rewriting",
            };
            let ended = rewriting.anneal(hottest, report, &mut local);
            (*cost, *graph) = rewriting.best();
            if ended.is_err() {
                break 'stages;
            }
        }
    }
    graphs.sort_by_key(|(cost, ..)| cost.weight());
    let mut cheapest = None;
    for (cost, plan, graph, given) in graphs {
        if best.as_ref().is_some_and(|(least, _)| cost.weight() >= least.weight()) {
            break;
        }
        let graph = graph_text::written(&graph, &given);
        let rewritten = Rewritten { operations: cost, accuracy: Accuracy::default(), plan, graph };
        let choice = Choice { rewritten: Some(rewritten.clone()), ..Choice::of(rewritten.plan.clone()) };
        if is_sound(reference, &choice, Form::Rewritten)? {
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
