//! Every derivative that code computes against dual numbers through the runtime's function that it is a derivative of.
//!
//! A plain `cargo test` tries some robots; `cargo xtask derivatives` sets `RNE_DERIVATIVES` to a number of them.

use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};

use rne::{BaseMotion, Dual, Payload, Wrench};
use rne_codegen::{Argument, Function};
use rne_model::Robot;

use crate::arm::{Arm, Given, Maker, of_runtime};
use crate::arms;
use crate::case::largest;
use crate::check::{Worst, conditioning, error_on_scale};
use crate::random_arms::of_each;
use crate::trees::{self, State};

/// Of the largest number of a matrix, and of the condition of M where that is inverted.
const TOLERANCE: f64 = 1e-11;
const SOME: usize = 6;

/// What is varied.
#[derive(Clone, Copy, PartialEq)]
enum By {
    Q,
    Qd,
    Qdd,
    Tau,
    /// The angular velocity of the base.
    Omega,
}
use By::{Omega, Q, Qd, Qdd, Tau};

/// What is made of the derivatives.
#[derive(Clone, Copy)]
enum Kind {
    /// A matrix for each that is varied, by rows: a row for each number of the function.
    Rows,
    /// These matrices for the first half of the numbers of the function, then those for the others.
    HalvesOfRows,
    /// The torques of the state times each of these matrices.
    Weighted,
    /// The matrix times these numbers.
    Times(By),
}
use Kind::{HalvesOfRows, Rows, Times, Weighted};

/// Each function, the function that it is a derivative of, what that is varied by, and what is made of it.
const DERIVATIVES: [(Function, Function, &[By], Kind); 11] = [
    (Function::InverseDynamicsDerivatives, Function::InverseDynamics, &[Q, Qd], Rows),
    (Function::InverseDynamicsDerivativesWithPayload, Function::InverseDynamicsWithPayload, &[Q, Qd], Rows),
    (Function::InverseDynamicsDerivativesWithWrenches, Function::InverseDynamicsWithWrenches, &[Q, Qd], Rows),
    (Function::ForwardDynamicsDerivatives, Function::ForwardDynamics, &[Q, Qd, Tau], Rows),
    (Function::ForwardDynamicsDerivativesWithPayload, Function::ForwardDynamicsWithPayload, &[Q, Qd, Tau], Rows),
    (Function::ForwardDynamicsDerivativesWithWrenches, Function::ForwardDynamicsWithWrenches, &[Q, Qd, Tau], Rows),
    (Function::EulerStepDerivatives, Function::EulerStep, &[Q, Qd, Tau], HalvesOfRows),
    (Function::InverseMassMatrixTimesTorques, Function::ForwardDynamics, &[Tau], Times(Tau)),
    (Function::TorqueGradient, Function::InverseDynamics, &[Q, Qd, Qdd], Weighted),
    (Function::JacobianRate, Function::Jacobian, &[Q], Times(Qd)),
    (Function::JacobianDerivatives, Function::Jacobian, &[Q], Rows),
];
/// With a base that nothing holds.
const FLOATING: (Function, Function, &[By], Kind) =
    (Function::FloatingInverseDynamicsDerivatives, Function::InverseDynamicsOfFloatingBase, &[Q, Qd, Omega], Rows);

/// The derivative of each number of a function by element `at` of what is varied.
fn column(arm: &Arm, function: Function, state: &State, by: By, at: usize) -> Vec<f64> {
    let dual = |kind: By, x: &[f64]| -> Vec<Dual<f64>> {
        let one = |i: usize| if kind == by && i == at { 1.0 } else { 0.0 };
        x.iter().enumerate().map(|(i, &value)| Dual { value, derivative: one(i) }).collect()
    };
    let (q, qd, qdd, tau) = (dual(Q, &state.q), dual(Qd, &state.qd), dual(Qdd, &state.qdd), dual(Tau, &state.tau));
    let still = |x: [f64; 3]| x.map(Dual::constant);
    let base = &state.base;
    let given = Given {
        q: &q,
        qd: &qd,
        qdd: &qdd,
        tau: &tau,
        wrench: Wrench { force: still(state.wrench.force), moment: still(state.wrench.moment) },
        payload: Payload::from_array(state.payload.to_array().map(Dual::constant)),
        base: BaseMotion {
            omega: dual(Omega, &base.omega).try_into().expect("three"),
            omega_dot: still(base.omega_dot),
            velocity: still(base.velocity),
            acceleration: still(base.acceleration),
            gravity: still(base.gravity),
        },
        base_rotation: crate::arm::base_rotation(),
    };
    of_runtime(&arm.runtime, function, &given).iter().map(|number| number.derivative).collect()
}

/// The matrices of a derivative, one after the other.
fn expected(arm: &Arm, of: Function, by: &[By], kind: Kind, state: &State) -> Vec<Vec<f64>> {
    let dof = state.q.len();
    let matrix = |by: &By| {
        let columns: Vec<_> =
            (0..if *by == Omega { 3 } else { dof }).map(|at| column(arm, of, state, *by, at)).collect();
        let rows = (0..columns.first().map_or(0, Vec::len)).map(|row| columns.iter().map(move |column| column[row]));
        match kind {
            Rows | HalvesOfRows => rows.flatten().collect::<Vec<_>>(),
            Times(by) => {
                let x = if by == Tau { &state.tau } else { &state.qd };
                rows.map(|row| row.zip(x).map(|(a, b)| a * b).sum()).collect()
            }
            Weighted => columns.iter().map(|column| column.iter().zip(&state.tau).map(|(a, b)| a * b).sum()).collect(),
        }
    };
    let matrices: Vec<Vec<f64>> = by.iter().map(matrix).collect();
    match kind {
        HalvesOfRows => {
            let half = |half: usize| {
                matrices.iter().map(move |matrix| matrix[half * matrix.len() / 2..][..matrix.len() / 2].to_vec())
            };
            half(0).chain(half(1)).collect()
        }
        _ => matrices,
    }
}

/// Every derivative of a robot in both forms.
fn compare(robot: &Robot, seed: u64, worst: &mut Worst) {
    let state = State::random(seed, robot.dof());
    let arms = Maker::CODE.map(|maker| (maker, Arm::by_no_choice(robot, maker)));
    let runtime = &arms[0].1.runtime;
    for (function, of, by, kind) in DERIVATIVES.into_iter().chain([FLOATING]) {
        let payload = if function.takes(Argument::Payload) { state.payload } else { Payload::none() };
        let mass = runtime.mass_matrix_with_payload(&state.q, &payload).expect("one per joint");
        let magnification = match conditioning(&mass) {
            _ if !function.inverts_mass() => 1.0,
            Some(it) if it.number < 1e8 => it.number,
            _ => continue,
        };
        // what vanishes but for rounding is a sum of larger terms
        let scale = match function {
            Function::JacobianRate => largest(&state.qd),
            Function::JacobianDerivatives => 1.0,
            _ if function.inverts_mass() => 0.0,
            _ => trees::scale(robot, Function::InverseDynamics, &state),
        };
        let scale = if let Weighted = kind { scale * largest(&state.tau) } else { scale };
        let parts = expected(&arms[0].1, of, by, kind, &state);
        let scale = if function.inverts_mass() { largest(&parts.concat()) } else { scale };
        for (maker, arm) in &arms {
            let found = arm.numbers(function, &state.given());
            assert_eq!(found.len(), parts.iter().map(Vec::len).sum::<usize>(), "{function}");
            let mut place = 0;
            for part in &parts {
                let error = error_on_scale(&found[place..place + part.len()], part, scale) / magnification;
                assert!(error <= TOLERANCE, "{}, {function}, {maker}: {error:e}", robot.name);
                worst.see(function.name(), error);
                place += part.len();
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    let count = std::env::var("RNE_DERIVATIVES").ok().and_then(|count| count.parse().ok()).unwrap_or(SOME);
    let (done, shows) = (AtomicUsize::new(0), std::io::stderr().is_terminal() && count > SOME);
    // arms, then trees, some of them with rotors
    let worst = of_each(&(0..count as u64).collect::<Vec<_>>(), |seed, worst| {
        let mut robot = if seed.is_multiple_of(2) {
            let yaml = arms::yaml(seed / 2);
            Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"))
        } else {
            trees::random(seed / 2, trees::dof(seed / 2))
        };
        robot.rotors = seed.is_multiple_of(3);
        compare(&robot, seed, worst);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if shows {
            let (bar, width) = (40 * done / count, 40);
            let _ = write!(std::io::stderr(), "\r[{:<width$}] {done} of {count} robots", "#".repeat(bar));
        }
    });
    if shows {
        eprintln!();
    }
    worst.at_most(TOLERANCE, &format!("derivatives of {count} robots, both forms"));
    assert_eq!(worst.len(), DERIVATIVES.len() + 1);
}
