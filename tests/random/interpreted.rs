//! Random robots through the interpreter: what the compiler writes is what the runtime computes, bit for bit, torques
//! and every intermediate vector of every step.

use fastrand::Rng;
use proptest::prelude::*;
use rne::{DynArm, Payload, Scalar, Wrench};
use rne_codegen::{Arguments, Compiler, Component, Form, Function, Interpreter, Program, Quantity};
use rne_model::Robot;

use super::robots;

/// A state at which to compare: joint arrays, a wrench and a payload.
pub(crate) struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    wrench: Wrench<f64>,
    payload: Payload<f64>,
}

impl State {
    pub(crate) fn random(rng: &mut Rng, dof: usize) -> Self {
        let mut array = |scale: f64| (0..dof).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect();
        let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        let payload = Payload::from_array([(); 10].map(|()| 2.0 * rng.f64() - 1.0));
        Self { q, qd, qdd, wrench, payload }
    }

    fn arguments(&self) -> Arguments<'_, f64> {
        let Wrench { force, moment } = self.wrench;
        let payload = self.payload.to_array();
        Arguments { force, moment, payload, ..Arguments::of_joints(&self.q, &self.qd, &self.qdd, 0.0) }
    }
}

pub(crate) fn interpreted(program: &Program, state: &State) -> Vec<f64> {
    let values = Interpreter::new(program).run(&state.arguments(), f64::from_f64, Scalar::sin_cos);
    values.expect("arrays of the right length")
}

pub(crate) fn runtime(arm: &DynArm, function: Function, state: &State) -> Vec<f64> {
    let State { q, qd, qdd, wrench, payload } = state;
    match function {
        Function::InverseDynamics => arm.inverse_dynamics(q, qd, qdd),
        Function::InverseDynamicsWithWrench => arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench),
        Function::InverseDynamicsWithPayload => arm.inverse_dynamics_with_payload(q, qd, qdd, payload),
        Function::InverseDynamicsFromSinCos => {
            let (sin, cos): (Vec<f64>, Vec<f64>) = q.iter().map(|&q| Scalar::sin_cos(q)).unzip();
            arm.inverse_dynamics_from_sin_cos(&sin, &cos, q, qd, qdd)
        }
        Function::GravityTorques => arm.gravity_torques(q),
        Function::BiasTorques => arm.bias_torques(q, qd),
        _ => unreachable!("no torques of a fixed base"),
    }
    .expect("arrays of the right length")
}

/// Compares every function at a few states.
fn torques_agree(yaml: &str, seed: u64) -> Result<(), TestCaseError> {
    let robot = Robot::from_yaml(yaml).map_err(|report| TestCaseError::fail(format!("{report}\n{yaml}")))?;
    let arm = DynArm::from_robot(&robot);
    let mut rng = Rng::with_seed(seed);
    for function in Function::TORQUES {
        let program = Compiler::new(&robot).compile(function, Form::SevenSteps).expect("finite constants");
        for _ in 0..3 {
            let state = State::random(&mut rng, robot.dof());
            prop_assert_eq!(
                interpreted(&program, &state),
                runtime(&arm, function, &state),
                "{} of\n{}",
                function,
                yaml
            );
        }
    }
    Ok(())
}

/// Compares every vector of every step at one state.
fn intermediates_agree(yaml: &str, seed: u64) -> Result<(), TestCaseError> {
    let robot = Robot::from_yaml(yaml).map_err(|report| TestCaseError::fail(format!("{report}\n{yaml}")))?;
    let arm = DynArm::from_robot(&robot);
    let kept = [
        Quantity::Omega,
        Quantity::OmegaDot,
        Quantity::Velocity,
        Quantity::Acceleration,
        Quantity::Gravity,
        Quantity::InertiaForce,
        Quantity::InertiaMoment,
        Quantity::JointForce,
        Quantity::JointMoment,
    ];
    let program = Compiler::new(&robot)
        .with_intermediates(&kept)
        .compile(Function::InverseDynamicsWithWrench, Form::SevenSteps)
        .expect("finite constants");
    let state = State::random(&mut Rng::with_seed(seed), robot.dof());
    let values = interpreted(&program, &state);
    let base = arm.fixed_base();
    let trace = arm.trace(&state.q, &state.qd, &state.qdd, &base, Some(&state.wrench)).expect("the right length");
    let mut compared = 0;
    for (output, value) in program.outputs.iter().zip(values) {
        let link = &trace.links[output.name.joint - 1];
        let vector = match output.name.quantity {
            Quantity::Omega => link.omega,
            Quantity::OmegaDot => link.omega_dot,
            Quantity::Velocity => link.velocity,
            Quantity::Acceleration => link.acceleration,
            Quantity::Gravity => link.gravity,
            Quantity::InertiaForce => link.inertia_force,
            Quantity::InertiaMoment => link.inertia_moment,
            Quantity::JointForce => link.joint_force,
            Quantity::JointMoment => link.joint_moment,
            _ => [link.tau; 3],
        };
        let expected = match output.name.component {
            Component::Vector(axis) => vector[axis as usize],
            _ => vector[0],
        };
        prop_assert_eq!(value, expected, "{} of\n{}", output.name, yaml);
        compared += 1;
    }
    prop_assert!(compared >= robot.dof() * (9 * 3 + 1), "{compared} numbers compared");
    Ok(())
}

/// How many robots: with `RNE_EXHAUSTIVE` set, more.
fn cases() -> u32 {
    if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 1000 } else { 40 }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn torques_of_random_robots_equal_the_runtime(dof in 1_usize..=12, seed in any::<u64>()) {
        torques_agree(&robots::yaml(seed, dof), seed)?;
    }

    #[test]
    fn every_vector_of_every_step_equals_the_runtime(dof in 1_usize..=12, seed in any::<u64>()) {
        intermediates_agree(&robots::yaml(seed, dof), seed)?;
    }
}
