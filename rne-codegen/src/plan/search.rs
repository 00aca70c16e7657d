//! The search for better choices: plans first, then the algebra of the graphs that they give.

use std::collections::BTreeMap;

use rne_model::Robot;

use crate::CompileError;
use crate::function::Function;
use crate::ir::{Cost, Graph};
use crate::pipeline::{Formulation, Target, reference};
use crate::plan::Plan;
use crate::plan::exploration::{Clock, Exploration, Over, Progress};
use crate::plan::file::{Accuracy, PlanFile, Reduced, Rewritten};
use crate::plan::graph_text;
use crate::plan::plan_set::{PlanSet, formulation, is_planned};
use crate::plan::rewriting::Rewriting;
use crate::prove::{self, Reference};
use crate::reduced::algorithm::Algorithm;

/// What a search is asked to do.
#[derive(Clone, Debug, Default)]
pub struct SearchOptions {
    /// The functions whose graphs are rewritten.
    pub rewrite: Vec<Function>,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Looks for a cheaper plan, from the one at hand onwards, and rewrites the graphs that the best plans give. What it
/// finds is not much less precise in single precision than the seven steps, and never worse than a plan at hand of
/// which that is true. A rewritten graph is kept where it takes fewer operations than the one that the plan gives.
///
/// `clock` is asked now and then how much of the time is over.
///
/// # Errors
/// When the result cannot be proved, which would be a mistake of this program.
pub fn search(
    robot: &Robot,
    known: Option<&PlanFile>,
    options: &SearchOptions,
    clock: Clock<'_>,
) -> Result<PlanFile, CompileError> {
    let torques = Function::InverseDynamics;
    let torques_by = |plan: &Plan| formulation(robot, plan, torques, Algorithm::Rnea);
    let of_torques = reference(robot, torques)?;
    // whether what is at hand can be taken is better known before a search than after it
    let mut at_hand = BTreeMap::new();
    for (&function, rewritten) in known.iter().flat_map(|known| &known.rewritten) {
        let graph = rewritten.formulation(robot, function)?;
        let operations = graph.cost();
        self::accuracy(&reference(robot, function)?, function, graph).map_err(|error| error.suspecting(robot, true))?;
        at_hand.insert(function, Rewritten { operations, ..rewritten.clone() });
    }
    let mut plans = Exploration::new(robot, &[]);
    plans.refuse(|plan| !torques_by(plan).and_then(|graph| is_sound(&of_torques, torques, graph)).unwrap_or(false));
    plans.greedy(usize::MAX);
    if let Some(known) = known {
        let rewritten = known.rewritten.values().filter_map(|rewritten| rewritten.plan.as_ref());
        [&known.reduced.plan].into_iter().chain(rewritten).for_each(|plan| plans.start_from(plan));
    }
    // the first part of the time goes to plans, the rest to rewriting
    let share = if options.rewrite.is_empty() { 1.0 } else { 0.45 };
    let _ = explore(&mut plans, options.seed, share, clock);
    let plan = plans.best.1.clone();
    let plan = plans.tidied(&plan);
    let operations = plans.cost(&plan).unwrap_or_default();
    // the plan was made here
    let accuracy =
        accuracy(&of_torques, torques, torques_by(&plan)?).map_err(|error| error.suspecting(robot, false))?;
    let reduced = Reduced { operations, accuracy, plan };

    let mut rewritten = BTreeMap::new();
    for function in Function::ALL {
        let place = options.rewrite.iter().position(|&other| other == function);
        let known = at_hand.get(&function);
        if function.divides().is_some() && prove::divides_by_zero(robot, function) {
            continue;
        }
        let reference = if place.is_some() || known.is_some() { reference(robot, function)? } else { continue };
        // one that has lost too much precision may be replaced by a dearer one
        let mut best = match known {
            Some(known) if place.is_none() || is_sound(&reference, function, known.formulation(robot, function)?)? => {
                Some(known.clone())
            }
            _ => None,
        };
        if let Some(place) = place {
            #[allow(clippy::cast_precision_loss)] // a handful
            let end = |place: usize| share + (1.0 - share) * place as f64 / options.rewrite.len() as f64;
            let time = (end(place), end(place + 1));
            rewrite(&reference, function, &mut plans, &mut best, time, options.seed, clock)?;
        }
        if let Some(best) = best
            && best.operations.weight() < without_rewriting(robot, &reduced, function)?.weight()
        {
            let accuracy = self::accuracy(&reference, function, best.formulation(robot, function)?)
                .map_err(|error| error.suspecting(robot, false))?;
            rewritten.insert(function, Rewritten { accuracy, ..best });
        }
    }
    let file = PlanFile::new(robot, reduced, rewritten);
    // what is read again is what was proved
    match PlanFile::read("the plan", &file.to_yaml(), robot) {
        Ok(read) if read == file => Ok(file),
        Ok(_) => {
            Err(CompileError::Plan("the plan that was found cannot be written. Please report this robot".to_owned()))
        }
        Err(report) => Err(CompileError::Plan(report.to_string())),
    }
}

/// What a function costs by the plan alone.
fn without_rewriting(robot: &Robot, reduced: &Reduced, function: Function) -> Result<Cost, CompileError> {
    if !is_planned(function) {
        return Ok(Formulation::numbered(robot, function).cost());
    }
    let (plan, algorithm) = PlanSet::from(reduced.plan.clone()).cheapest(robot, function);
    Ok(formulation(robot, &plan, function, algorithm)?.cost())
}

fn accuracy(reference: &Reference<'_>, function: Function, graph: Formulation) -> Result<Accuracy, CompileError> {
    let program = graph.proved(function, Target::Latency, reference)?;
    let proof = program.proof.ok_or_else(|| CompileError::Plan("a program without proof".to_owned()))?;
    Ok(Accuracy::from(&proof))
}

/// How much less precise than the seven steps a form may be in single precision, on the average.
const PRECISION: f64 = 3.0;

/// States over which the average is taken.
const STATES: usize = 200;

/// Whether a graph can be proved, and is not much less precise than the seven steps.
fn is_sound(reference: &Reference<'_>, function: Function, graph: Formulation) -> Result<bool, CompileError> {
    let (robot, embedding) = (reference.robot(), graph.embedding());
    let (program, exactly) = graph.lowered(robot, function)?;
    let is_identical = prove::identical(robot, &program, &exactly, embedding).is_ok();
    Ok(is_identical && prove::loss_of_precision(reference, &program, STATES) <= PRECISION)
}

/// Descent, then annealing in rounds until `share` of the time is over.
fn explore(plans: &mut Exploration<'_>, seed: u64, share: f64, clock: Clock<'_>) -> Result<(), Over> {
    const ROUNDS: u32 = 4;
    let until = |end: f64, clock: &mut dyn FnMut(&Progress) -> Option<f64>, progress: &Progress| {
        clock(progress).filter(|over| *over < end)
    };
    let half = share * 0.5;
    // it ends when it is done, or out of its own time, or out of all
    let _ = plans.descend(&mut |progress| until(half, clock, progress));
    let start = clock(&plans.progress("descent")).ok_or(Over)?;
    for round in 0..ROUNDS {
        let length = (share - start) / f64::from(ROUNDS);
        let begin = start + length * f64::from(round);
        let hottest = if round + 1 == ROUNDS { 2.0 } else { 4.0 };
        let mut local = |progress: &Progress| clock(progress).map(|over| ((over - begin) / length).clamp(0.0, 1.0));
        plans.anneal(seed.wrapping_add(u64::from(round)), hottest, &mut local)?;
    }
    // what annealing found may have better neighbours
    let _ = plans.descend(&mut |progress| until(share + 0.02, clock, progress));
    Ok(())
}

/// A graph that is being rewritten.
struct Candidate {
    /// What will stand in the plan file, but for the graph as text.
    of: Rewritten,
    graph: Graph,
    /// Places of the numbers of the graph as the plan gives it.
    given: Vec<u32>,
}

impl Candidate {
    fn new(robot: &Robot, function: Function, of: Rewritten) -> Result<Self, CompileError> {
        let before = of.before(robot, function)?.traced.graph;
        let given = before.factors();
        // the graph's own constants follow those of the plan, as in a graph that has just been rewritten
        let read = graph_text::read(&of.graph, &before, function).ok();
        let graph = read.map(|read| graph_text::on_numbers_of(&read.graph, &before)).unwrap_or(before);
        Ok(Self { of: Rewritten { operations: graph.cost(&mut Vec::new()), ..of }, graph, given })
    }

    fn weight(&self) -> usize {
        self.of.operations.weight()
    }
}

/// The best plans for a function, of those that the search met.
fn candidates(robot: &Robot, function: Function, plans: &mut Exploration<'_>) -> Vec<Rewritten> {
    if !is_planned(function) {
        return vec![Rewritten::default()];
    }
    // those of the torques differ little; what the plan means to another function, its algorithm hides
    let most = if function == Function::InverseDynamics { 16 } else { 4 };
    let best = plans.best.1.clone();
    let mut found: Vec<_> = plans.pool.iter().map(|(_, plan)| plan.clone()).filter(|plan| *plan != best).collect();
    found.insert(0, best);
    found.truncate(most);
    let mut found: Vec<_> = found.iter().map(|plan| plans.tidied(plan)).collect();
    found.dedup();
    let candidate = |plan| {
        let (plan, algorithm) = PlanSet::from(plan).cheapest(robot, function);
        Rewritten { plan: Some(plan), algorithm, ..Rewritten::default() }
    };
    found.into_iter().map(candidate).collect()
}

/// Rewrites the graphs of the best plans in the time from `begin` to `end`: half of it all of them, half the four that
/// came out best.
fn rewrite(
    reference: &Reference<'_>,
    function: Function,
    plans: &mut Exploration<'_>,
    best: &mut Option<Rewritten>,
    (begin, end): (f64, f64),
    seed: u64,
    clock: Clock<'_>,
) -> Result<(), CompileError> {
    let robot = reference.robot();
    let known = best.iter().cloned().map(|known| Candidate::new(robot, function, known));
    let mut graphs: Vec<Candidate> = known.collect::<Result<_, _>>()?;
    let fresh = candidates(robot, function, plans).into_iter();
    graphs.extend(fresh.filter_map(|of| Candidate::new(robot, function, of).ok()));
    let middle = f64::midpoint(begin, end);
    'stages: for (stage, begin, end, hottest, most) in [(0, begin, middle, 0.2, usize::MAX), (1, middle, end, 0.22, 4)]
    {
        graphs.sort_by_key(Candidate::weight);
        graphs.truncate(most);
        #[allow(clippy::cast_precision_loss)] // a handful
        let length = (end - begin) / graphs.len() as f64;
        for (index, candidate) in graphs.iter_mut().enumerate() {
            #[allow(clippy::cast_precision_loss)]
            let start = begin + length * index as f64;
            let seed = seed.wrapping_add(stage * 100 + index as u64);
            let mut rewriting = Rewriting::new(candidate.graph.clone(), seed, Graph::cost);
            let mut local = |progress: &Progress| clock(progress).map(|over| ((over - start) / length).clamp(0.0, 1.0));
            let count = plans.plans;
            let least = best.as_ref().map(|best| best.operations);
            let report = |cost: Cost| Progress {
                plans: count,
                best: least.filter(|least| least.weight() < cost.weight()).unwrap_or(cost),
                phase: "rewriting",
            };
            let ended = rewriting.anneal(hottest, report, &mut local);
            (candidate.of.operations, candidate.graph) = rewriting.best();
            if ended.is_err() {
                break 'stages;
            }
        }
    }
    graphs.sort_by_key(Candidate::weight);
    for Candidate { of, graph, given } in graphs {
        if best.as_ref().is_some_and(|best| of.operations.weight() >= best.operations.weight()) {
            break;
        }
        let rewritten = Rewritten { graph: graph_text::written(&graph, &given), ..of };
        // what cannot be read again, or is worth something else, is not kept
        let Ok(formulation) = rewritten.formulation(robot, function) else { continue };
        if is_sound(reference, function, formulation)? {
            *best = Some(rewritten);
            break;
        }
    }
    Ok(())
}
