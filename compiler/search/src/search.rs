//! The search for better choices: plans first, then the algebra of the graphs that they give.

use std::collections::BTreeMap;

use rne_codegen::OfRobot as _;
use rne_codegen::plan::{Accuracy, Cost, Formulation, Plan, PlanSet, Reference, Rewriting, Rewritten, divides_by_zero};
use rne_codegen::{Algorithm, CompileError, Function};
use rne_model::Robot;

use crate::error::SearchError;
use crate::plan_file::{PlanFile, Reduced};
use crate::plan_search::{Clock, Exploration, Over, Progress};

/// Options of a search.
#[derive(Clone, Debug, Default)]
pub struct SearchOptions {
    /// The functions whose graphs are rewritten.
    pub rewrite: Vec<Function>,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Searches for a plan with fewer operations, starting from `known`, and rewrites the graphs of the best plans. The
/// result is not much less precise in single precision than the seven steps. It has no more operations than the known
/// plan, if that is as precise. A rewritten graph is kept if it takes fewer operations than the graph of the plan.
///
/// `clock` returns which part of the time is over, 0 to 1; the search calls it regularly.
///
/// # Errors
/// When the robot has run-time parameters, when a function of `options` has no reduced form, or when the result cannot
/// be proved, which would be a mistake of this program.
pub fn search(
    robot: &Robot,
    known: Option<&PlanFile>,
    options: &SearchOptions,
    clock: Clock<'_>,
) -> Result<PlanFile, SearchError> {
    check(robot, options)?;
    let torques = rne_codegen::function_of_plan(robot);
    let torques_by = |plan: &Plan| Formulation::by_plan(robot, plan, torques, Algorithm::Rnea);
    let of_torques = Reference::of(robot, torques)?;
    // the known graphs are proved before the search, so that an error does not come only after it
    let at_hand = known.map(|known| proven(robot, known)).transpose()?.unwrap_or_default();
    let is_refused =
        |plan: &Plan| !torques_by(plan).and_then(|graph| is_sound(&of_torques, torques, graph)).unwrap_or(false);
    let mut search = Exploration::new(robot, is_refused);
    if let Some(known) = known {
        let rewritten = known.rewritten.values().filter_map(|rewritten| rewritten.plan.as_ref());
        [&known.reduced.plan].into_iter().chain(rewritten).for_each(|plan| _ = search.plans.cost(plan));
    }
    // the first part of the time goes to plans, the rest to rewriting
    let share = if options.rewrite.is_empty() { 1.0 } else { 0.45 };
    let _ = explore(&mut search, options.seed, share, clock);
    let plan = search.plans.best().1.clone();
    let plan = search.plans.tidied(&plan);
    let operations = search.plans.cost(&plan).unwrap_or_default();
    // an error is not due to a plan file, because the plan was made here
    let made_here = |error: CompileError| error.suspecting(robot, false);
    let accuracy = Accuracy::from(&of_torques.proof(torques, torques_by(&plan)?).map_err(made_here)?);
    let reduced = Reduced { operations, accuracy, plan };

    let mut rewritten = BTreeMap::new();
    for function in rne_codegen::functions_of(robot) {
        let place = options.rewrite.iter().position(|&other| other == function);
        let known = at_hand.get(&function);
        if place.is_none() && known.is_none() || divides_by_zero(robot, function) {
            continue;
        }
        let reference = Reference::of(robot, function)?;
        // a known graph that is too imprecise may be replaced by one with more operations
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
            rewrite((robot, function, &reference), &mut search, &mut best, time, options.seed, clock)?;
        }
        if let Some(best) = best
            && best.operations.weight() < without_rewriting(robot, &reduced, function)?.weight()
        {
            let proof = reference.proof(function, best.formulation(robot, function)?).map_err(made_here)?;
            rewritten.insert(function, Rewritten { accuracy: Accuracy::from(&proof), ..best });
        }
    }
    readable(PlanFile::new(robot, reduced, rewritten), robot)
}

/// Refuses run-time parameters, and functions without a reduced form.
fn check(robot: &Robot, options: &SearchOptions) -> Result<(), SearchError> {
    if !robot.run_time.is_empty() {
        return Err(SearchError::RunTimeParameters);
    }
    let irreducible = options.rewrite.iter().find(|function| !function.can_be_rewritten());
    irreducible.map_or(Ok(()), |&function| Err(SearchError::Irreducible(function)))
}

/// Returns the rewritten graphs of a plan file, each proved, with the number of its operations.
fn proven(robot: &Robot, known: &PlanFile) -> Result<BTreeMap<Function, Rewritten>, SearchError> {
    let mut proven = BTreeMap::new();
    for (&function, rewritten) in &known.rewritten {
        let graph = rewritten.formulation(robot, function)?;
        let operations = graph.cost();
        let proof = Reference::of(robot, function)?.proof(function, graph);
        proof.map_err(|error| error.suspecting(robot, true))?;
        proven.insert(function, Rewritten { operations, ..rewritten.clone() });
    }
    Ok(proven)
}

/// Returns a plan file if its text gives the same file: the graph that is read again is the graph that was proved.
fn readable(file: PlanFile, robot: &Robot) -> Result<PlanFile, SearchError> {
    match PlanFile::read("the plan", &file.to_yaml(), robot) {
        Ok(read) if read == file => Ok(file),
        Ok(_) => Err(SearchError::NotWritten),
        Err(report) => Err(SearchError::NotRead(report)),
    }
}

/// Operations of a function by the plan alone, without rewriting.
fn without_rewriting(robot: &Robot, reduced: &Reduced, function: Function) -> Result<Cost, CompileError> {
    if !Algorithm::is_planned(function) {
        return Ok(Formulation::numbered(robot, function).cost());
    }
    let plans = PlanSet::from(reduced.plan.clone());
    let (plan, algorithm) = plans.of_function(robot, function).cheapest(robot, function);
    Ok(Formulation::by_plan(robot, &plan, function, algorithm)?.cost())
}

/// Largest factor by which a form may be less precise than the seven steps in single precision, on the average.
const PRECISION: f64 = 3.0;

/// States over which the average is taken.
const STATES: usize = 200;

/// Whether a graph can be proved, and is not much less precise than the seven steps.
fn is_sound(reference: &Reference<'_>, function: Function, graph: Formulation) -> Result<bool, CompileError> {
    Ok(reference.loss_of_precision(function, graph, STATES)?.is_some_and(|loss| loss <= PRECISION))
}

/// Runs the descent, then annealing in rounds, until `share` of the time is over.
fn explore(search: &mut Exploration<'_>, seed: u64, share: f64, clock: Clock<'_>) -> Result<(), Over> {
    const ROUNDS: u32 = 4;
    let until = |end: f64, clock: &mut dyn FnMut(&Progress) -> Option<f64>, progress: &Progress| {
        clock(progress).filter(|over| *over < end)
    };
    let half = share * 0.5;
    // the descent ends when it is done, when half of `share` is over, or when all time is over
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

/// The best plans for a function, of those that the search met.
fn candidates(robot: &Robot, function: Function, search: &mut Exploration<'_>) -> Vec<Rewritten> {
    if !Algorithm::is_planned(function) {
        return vec![Rewritten::default()];
    }
    // many plans are tried for the torques; other functions use fewer of the choices, so a few plans are enough
    let most = match function {
        // a function that keeps a floating base at rest has only one plan, of its own
        _ if function.holds_floating_base(robot) => 1,
        Function::InverseDynamics => 16,
        _ => 4,
    };
    let best = search.plans.best().1.clone();
    let mut found: Vec<_> = search.pool.iter().map(|(_, plan)| plan.clone()).filter(|plan| *plan != best).collect();
    found.insert(0, best);
    found.truncate(most);
    let mut found: Vec<_> = found.iter().map(|plan| search.plans.tidied(plan)).collect();
    found.dedup();
    let candidate = |plan| {
        let (plan, algorithm) = PlanSet::from(plan).of_function(robot, function).cheapest(robot, function);
        Rewritten { plan: Some(plan), algorithm, ..Rewritten::default() }
    };
    found.into_iter().map(candidate).collect()
}

/// Rewrites the graphs of the best plans in the time from `begin` to `end`: all of them in the first half, the best
/// four in the second half.
fn rewrite(
    (robot, function, reference): (&Robot, Function, &Reference<'_>),
    search: &mut Exploration<'_>,
    best: &mut Option<Rewritten>,
    (begin, end): (f64, f64),
    seed: u64,
    clock: Clock<'_>,
) -> Result<(), CompileError> {
    let known = best.iter().cloned().map(|known| Rewriting::of(robot, function, known));
    let mut graphs: Vec<Rewriting> = known.collect::<Result<_, _>>()?;
    let fresh = candidates(robot, function, search).into_iter();
    graphs.extend(fresh.filter_map(|of| Rewriting::of(robot, function, of).ok()));
    let least = best.as_ref().map(|best| best.operations);
    let progress = |cost: Cost| Progress {
        plans: search.plans.counted(),
        best: least.filter(|least| least.weight() < cost.weight()).unwrap_or(cost),
        phase: "rewriting",
    };
    let weight = |graph: &Rewriting| graph.cost().weight();
    let middle = f64::midpoint(begin, end);
    'stages: for (stage, begin, end, hottest, most) in [(0, begin, middle, 0.2, usize::MAX), (1, middle, end, 0.22, 4)]
    {
        graphs.sort_by_key(weight);
        graphs.truncate(most);
        #[allow(clippy::cast_precision_loss)] // a handful
        let length = (end - begin) / graphs.len() as f64;
        for (index, graph) in graphs.iter_mut().enumerate() {
            #[allow(clippy::cast_precision_loss)]
            let start = begin + length * index as f64;
            let seed = seed.wrapping_add(stage * 100 + index as u64);
            let mut local = |cost| clock(&progress(cost)).map(|over| ((over - start) / length).clamp(0.0, 1.0));
            if graph.anneal(seed, hottest, &mut local).is_break() {
                break 'stages;
            }
        }
    }
    graphs.sort_by_key(weight);
    for graph in graphs {
        if least.is_some_and(|least| weight(&graph) >= least.weight()) {
            break;
        }
        let rewritten = graph.written();
        // a graph that cannot be read again, or is not the same function, is not kept
        let Ok(formulation) = rewritten.formulation(robot, function) else { continue };
        if is_sound(reference, function, formulation)? {
            *best = Some(rewritten);
            break;
        }
    }
    Ok(())
}
