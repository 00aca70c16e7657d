//! Which rewritten graphs a plan file keeps: a graph is most of its file, so it has to be worth its bytes.

use rne_codegen::plan::{Cost, Formulation, Plan, PlanSet};
use rne_codegen::{Algorithm, CompileError, Function};
use rne_model::Robot;

/// The functions whose rewritten graphs a plan file keeps: those that people call in a loop.
pub const REWRITTEN: [Function; 9] = [
    Function::InverseDynamics,
    Function::InverseDynamicsWithWrench,
    Function::InverseDynamicsFromSinCos,
    Function::GravityTorques,
    Function::BiasTorques,
    Function::MassMatrix,
    Function::ForwardDynamics,
    Function::Jacobian,
    Function::InverseDynamicsDerivatives,
];

/// A plan file keeps a rewritten graph that saves this many of a thousand operations at least.
const LEAST_SAVING: usize = 21;

/// Whether a plan file keeps the rewritten graph of a function: it must take at least 2.1 % fewer operations than
/// the code of the plan alone.
pub(crate) fn is_kept(function: Function, by_plan: Cost, rewritten: Cost) -> bool {
    REWRITTEN.contains(&function)
        && 1000 * rewritten.total() <= (1000 - LEAST_SAVING) * by_plan.total()
        && rewritten.sincos <= by_plan.sincos
}

/// What a function costs by the plan alone.
pub(crate) fn by_plan_alone(robot: &Robot, plan: &Plan, function: Function) -> Result<Cost, CompileError> {
    if !Algorithm::is_planned(function) {
        return Ok(Formulation::numbered(robot, function).cost());
    }
    let (plan, algorithm) = PlanSet::from(plan.clone()).cheapest(robot, function);
    Ok(Formulation::by_plan(robot, &plan, function, algorithm)?.cost())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_graph_is_kept_that_saves_enough_of_a_function_in_loops() {
        let cost = |add| Cost { mul: 0, add, sincos: 3 };
        assert!(is_kept(Function::InverseDynamics, cost(1000), cost(979)));
        assert!(!is_kept(Function::InverseDynamics, cost(1000), cost(980)));
        assert!(!is_kept(Function::KineticEnergy, cost(100), cost(50)));
        assert!(!is_kept(Function::InverseDynamics, cost(100), Cost { sincos: 4, ..cost(90) }));
    }
}
