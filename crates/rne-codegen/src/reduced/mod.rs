//! The reduced form: the same torques with far fewer operations.
//!
//! Regrouped parameters, one matrix U for all accelerations of a link, turns in two steps, gravity in the acceleration of
//! the base, and choices per joint that a search makes. Only the torques keep a physical meaning.

mod evaluator;
mod inward;
mod moves;
mod outward;
mod plan;
mod pseudo_inertia;
mod regroup;
mod rewrite;
mod rows;
mod search;
mod sheet;
mod transcript;
mod trick;
mod writer;

pub use plan::{JointPlan, Moment, Plan, Scale, Side, Slide, Switches, Target};
pub use search::Progress;
pub use sheet::Cost;
pub use trick::Trick;

pub(crate) use writer::Point;

use rne_model::Robot;

use crate::CompileError;
use crate::function::{Form, Function};
use crate::program::Program;
use transcript::Drawing;

/// Compiles a function in the reduced form, by a plan or by the default one.
pub(crate) fn compile(robot: &Robot, function: Function, form: Form, plan: Option<&Plan>) -> Result<Program, CompileError> {
    let default;
    let plan = match plan {
        Some(plan) => plan,
        None => {
            default = search::default_plan(robot, &[]);
            &default
        }
    };
    let misfit = || CompileError::Plan(format!("the plan does not fit `{}`", robot.name));
    let frame = evaluator::frame(robot, plan).ok_or_else(misfit)?;
    let drawing = Drawing::new(&frame, plan, function).ok_or_else(misfit)?;
    drawing.program(robot, &frame, function, form)
}

#[cfg(test)]
mod tests {
    use super::evaluator::Evaluator;
    use super::*;
    use crate::Function;

    #[test]
    fn counts() {
        for name in ["planar2", "puma560", "stanford", "panda", "ur5", "wam7", "scara_cobra600", "puma560_mdh", "iiwa14"] {
            let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/");
            let text = std::fs::read(format!("{root}{name}.yaml")).unwrap();
            let robot = rne_model::check_bytes(name, &text).unwrap().robot;
            let mut evaluator = Evaluator::new(&robot, Function::InverseDynamics);
            let mut plan = Plan::new(robot.dof());
            println!("{name}: {:?}", evaluator.cost(&plan));
            for function in Function::ALL {
                let start = std::time::Instant::now();
                match compile(&robot, function, Form::Reduced, Some(&plan)) {
                    Ok(program) => println!("   {function} {:?} {:?} {:?}", program.operations(), program.proof, start.elapsed()),
                    Err(error) => println!("   {function} {error}"),
                }
                let start = std::time::Instant::now();
                match compile(&robot, function, Form::Reduced, None) {
                    Ok(program) => println!("   {function} {:?} {:?} {:?}", program.operations(), program.proof, start.elapsed()),
                    Err(error) => println!("   {function} {error}"),
                }
            }
            continue;
            let start = std::time::Instant::now();
            let mut search = super::search::Search::new(&robot, &[]);
            search.greedy(420);
            println!("   greedy {:?} {} plans {:?}", search.best.0, search.plans, start.elapsed());
            if !cfg!(debug_assertions) {
                let start = std::time::Instant::now();
                let _ = search.descend(&mut |_| (start.elapsed().as_secs() < 8).then_some(0.0));
                println!("   descent {} {:?} {} plans {:?}", search.best.0.total(), search.best.0, search.plans, start.elapsed());
                search.pool.push((search.best.0.weight(), search.best.1.clone()));
                let start = std::time::Instant::now();
                let plan = search.best.1.clone();
                let frame = super::evaluator::frame(&robot, &plan).unwrap();
                let writer = super::writer::Writer::new(Function::InverseDynamics, frame.table.reading, false);
                let outs = super::evaluator::write(&writer, &frame, &plan, &frame.parameters(&plan).unwrap());
                let dag = super::sheet::Dag::of(&writer.sheet.borrow(), &outs);
                let mut rewriting = super::rewrite::Rewriting::new(dag, 1, |dag, live| super::evaluator::cost(dag, &frame, live));
                let mut n = 0;
                let _ = rewriting.anneal(0.2, |best| Progress { plans: 0, best, phase: "" }, &mut |_| { n += 1; Some(start.elapsed().as_secs_f64() / 10.0) });
                let (best, _) = rewriting.best();
                println!("   rewritten {} {:?} {} moves", best.total(), best, n * 512);
                continue;
            }
            plan.gyrostat = true;
            println!("   gyrostat {:?}", evaluator.cost(&plan));
            plan.gyrostat = false;
            plan.turned_last_frame = true;
            println!("   phi {:?}", evaluator.cost(&plan));
            plan.turned_last_frame = false;
            for joint in &mut plan.joints { joint.switches.axis_column = true; }
            println!("   ucol {:?}", evaluator.cost(&plan));
            let start = std::time::Instant::now();
            let n = if cfg!(debug_assertions) { 20 } else { 2000 };
            for _ in 0..n { evaluator.cost(&plan); }
            println!("   {:?} each", start.elapsed() / n);
        }
    }
}
