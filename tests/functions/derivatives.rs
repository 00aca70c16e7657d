//! Every derivative that code computes against dual numbers through the runtime's function that it is a derivative of.
//!
//! A plain `cargo test` tries some robots; `cargo xtask derivatives` sets `RNE_DERIVATIVES` to a number of them, and
//! `RNE_DERIVATIVES_FIRST` to the first one.

use std::collections::BTreeSet;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rne::Payload;
use rne_codegen::{Argument, CompileError, Function, Reason, Refusal};
use rne_model::Robot;

use crate::arm::{Arm, Maker};
use crate::arms;
use crate::case::largest;
use crate::check::{Conditioning, ROOT, Worst, conditioning, error_on_scale, product};
use crate::dual_numbers::By::{Omega, Q, Qd, Qdd, Tau};
use crate::dual_numbers::{Derivative, Kind};
use crate::equality;
use crate::integrator;
use crate::random_arms::of_each;
use crate::tree_functions::State;
use crate::trees;

/// First derivatives, of the largest number that rounding is relative to.
const FIRST_ORDER: f64 = 1e-11;
const SECOND_ORDER: f64 = 1e-9;
const SOME: usize = 6;
/// Beyond this condition number of the mass matrix, derivatives of accelerations are not compared.
const CONDITION: f64 = 1e8;
/// Where friction changes its sign, rad/s or m/s.
const WIDTH: f64 = 0.3;

use Function as F;
use Kind::{HalvesOfRows, Hessian, Momentum, OnManifold, Rates, RatesTimesVelocities, Rows, TimesTorques, Weighted};

#[rustfmt::skip]
const DERIVATIVES: [Derivative; 19] = [
    Derivative { function: F::InverseDynamicsDerivatives, of: F::InverseDynamics, by: &[Q, Qd], kind: Rows },
    Derivative { function: F::InverseDynamicsDerivativesWithPayload, of: F::InverseDynamicsWithPayload, by: &[Q, Qd], kind: Rows },
    Derivative { function: F::InverseDynamicsDerivativesWithWrenches, of: F::InverseDynamicsWithWrenches, by: &[Q, Qd], kind: Rows },
    Derivative { function: F::ForwardDynamicsDerivatives, of: F::ForwardDynamics, by: &[Q, Qd, Tau], kind: Rows },
    Derivative { function: F::ForwardDynamicsDerivativesWithPayload, of: F::ForwardDynamicsWithPayload, by: &[Q, Qd, Tau], kind: Rows },
    Derivative { function: F::ForwardDynamicsDerivativesWithWrenches, of: F::ForwardDynamicsWithWrenches, by: &[Q, Qd, Tau], kind: Rows },
    Derivative { function: F::EulerStepDerivatives, of: F::EulerStep, by: &[Q, Qd, Tau], kind: HalvesOfRows },
    Derivative { function: F::FloatingInverseDynamicsDerivatives, of: F::InverseDynamicsOfFloatingBase, by: &[Q, Qd, Omega], kind: Rows },
    Derivative { function: F::FloatingEulerStepDerivatives, of: F::FloatingEulerStep, by: &[], kind: OnManifold },
    Derivative { function: F::InverseMassMatrix, of: F::ForwardDynamics, by: &[Tau], kind: Rows },
    Derivative { function: F::InverseMassMatrixTimesTorques, of: F::ForwardDynamics, by: &[Tau], kind: TimesTorques },
    Derivative { function: F::TorqueGradient, of: F::InverseDynamics, by: &[Q, Qd, Qdd], kind: Weighted },
    Derivative { function: F::TorqueHessian, of: F::InverseDynamics, by: &[], kind: Hessian },
    Derivative { function: F::JacobianDerivatives, of: F::Jacobian, by: &[Q], kind: Rows },
    Derivative { function: F::JacobianRate, of: F::Jacobian, by: &[], kind: Rates },
    Derivative { function: F::JacobianRateTimesVelocity, of: F::Jacobian, by: &[], kind: RatesTimesVelocities },
    Derivative { function: F::CentreOfMassJacobian, of: F::CentreOfMass, by: &[Q], kind: Rows },
    Derivative { function: F::MomentumAndRate, of: F::MassMatrix, by: &[], kind: Momentum(F::GravityTorques) },
    Derivative { function: F::MomentumAndRateWithPayload, of: F::MassMatrixWithPayload, by: &[], kind: Momentum(F::GravityTorquesWithPayload) },
];

/// Derivatives of the runtime alone that are compared here, too.
const OF_RUNTIME: [&str; 2] = ["actuator_torques_smooth_derivatives", "runge_kutta_step_derivatives"];

/// Derivatives that other tests compare, and the file of these tests.
const ELSEWHERE: [(&str, &str); 2] = [
    ("floating_runge_kutta_step_derivatives", "rne-runtime/tests/floating_integrator.rs"),
    ("loop_map_rate_times_velocity", "tests/functions/closed_loops.rs"),
];

/// What rounding of the numbers of a function is relative to, if they are smaller: they are sums of larger terms.
fn scale(arm: &Arm, function: Function, state: &State) -> f64 {
    let of = |function| equality::scale(arm, function, &state.given());
    match function {
        F::JacobianRateTimesVelocity => of(F::JacobianRate) * largest(&state.qd),
        F::MomentumAndRate | F::ForwardDynamicsDerivatives => of(F::InverseDynamicsDerivatives),
        F::MomentumAndRateWithPayload | F::ForwardDynamicsDerivativesWithPayload => {
            of(F::InverseDynamicsDerivativesWithPayload)
        }
        F::ForwardDynamicsDerivativesWithWrenches => of(F::InverseDynamicsDerivativesWithWrenches),
        _ => of(function),
    }
}

/// The error of accelerations X = M⁻¹ T: rounding of M changes X by the condition number times as much as X, rounding
/// of T changes it by 1/λ times as much as T, with the smallest eigenvalue λ.
fn error_of_accelerations(found: &[f64], expected: &[f64], of_torques: f64, of: &Conditioning) -> f64 {
    error_on_scale(found, expected, of_torques / of.largest) / of.number
}

/// The largest of the torques that give accelerations of a robot by its mass matrix.
fn largest_torques(mass: &[Vec<f64>], accelerations: &[f64]) -> f64 {
    let columns = accelerations.len() / mass.len();
    let column = |at: usize| -> Vec<f64> { accelerations.iter().skip(at).step_by(columns).copied().collect() };
    (0..columns).map(|at| largest(&product(mass, &column(at)))).fold(0.0, f64::max)
}

/// Every derivative of a robot in both forms.
fn compare(robot: &Robot, seed: u64, worst: &mut Worst) {
    let state = State::random(seed, robot.dof());
    let runtime = Arm::by_no_choice(robot, Maker::Runtime);
    let code = Maker::CODE.map(|maker| Arm::by_no_choice(robot, maker));
    for derivative in &DERIVATIVES {
        let function = derivative.function;
        let payload = if function.takes(Argument::Payload) { state.payload } else { Payload::none() };
        let mass = match function {
            F::FloatingEulerStepDerivatives => runtime.runtime.floating_mass_matrix(&state.q),
            _ => runtime.runtime.mass_matrix_with_payload(&state.q, &payload),
        };
        let mass = mass.expect("one per joint");
        let condition = match conditioning(&mass) {
            _ if !function.inverts_mass() => None,
            Some(it) if it.number < CONDITION => Some(it),
            _ => continue,
        };
        let parts = derivative.expected(&runtime, &state);
        if parts.concat().iter().any(|x| !x.is_finite()) {
            assert_eq!(function, F::CentreOfMassJacobian, "of an arm without mass");
            continue;
        }
        for (arm, maker) in code.iter().zip(Maker::CODE) {
            let found = arm.numbers(function, &state.given());
            // then the numbers would be those of the seven steps
            let is_refused = |it: &Refusal| matches!(it.reason, Reason::Error(CompileError::NotIdentical { .. }));
            let refused = arm.program(function).refusals.iter().find(|it| is_refused(it));
            assert!(refused.is_none(), "{}, {function}: {refused:?}", robot.name);
            assert_eq!(found.len(), parts.iter().map(Vec::len).sum::<usize>(), "{function}");
            let mut place = 0;
            for (index, part) in parts.iter().enumerate() {
                let found = &found[place..place + part.len()];
                let error = match &condition {
                    None => error_on_scale(found, part, scale(&runtime, function, &state)),
                    // 1 + h times derivatives of accelerations
                    Some(of) if matches!(derivative.kind, HalvesOfRows | OnManifold) => {
                        error_on_scale(found, part, largest(&parts.concat())) / of.number
                    }
                    // columns of M⁻¹
                    Some(of)
                        if derivative.by.get(index) == Some(&Tau) && function != F::InverseMassMatrixTimesTorques =>
                    {
                        error_of_accelerations(found, part, 1.0, of)
                    }
                    Some(of) => {
                        let terms = if derivative.by == [Tau] { 0.0 } else { scale(&runtime, function, &state) };
                        error_of_accelerations(found, part, largest_torques(&mass, part).max(terms), of)
                    }
                };
                let tolerance = if let Hessian = derivative.kind { SECOND_ORDER } else { FIRST_ORDER };
                assert!(error <= tolerance, "{}, {function}, {maker}, part {index}: {error:e}", robot.name);
                worst.see(function.name(), error);
                place += part.len();
            }
        }
    }
    friction(&runtime, &state, worst);
    integrator::compare(&runtime, &code, seed, worst);
}

/// The derivatives of smooth friction beside their closed form.
fn friction(arm: &Arm, state: &State, worst: &mut Worst) {
    let found = arm.runtime.actuator_torques_smooth_derivatives(&state.qd, WIDTH).expect("one per joint");
    let mut expected = vec![vec![0.0; state.qd.len()]; state.qd.len()];
    for (joint, motor) in arm.runtime.motors().iter().enumerate() {
        let Some(motor) = motor else { continue };
        let (qd, ratio, [positive, negative]) = (state.qd[joint], motor.gear_ratio, motor.coulomb);
        let root = qd.hypot(WIDTH);
        let (sign, rate) = (qd / root, WIDTH * WIDTH / (root * root * root));
        let coulomb = 0.5 * (positive - negative) + (positive + negative) * sign;
        expected[joint][joint] = ratio * ratio * motor.viscous + ratio.abs() * coulomb * rate;
    }
    worst.see(OF_RUNTIME[0], error_on_scale(&found.concat(), &expected.concat(), 0.0));
}

/// Arms, then trees of up to ten joints, some of them with rotors.
fn robot(seed: u64) -> Robot {
    let mut robot = if seed.is_multiple_of(2) {
        let yaml = arms::yaml(seed / 2);
        Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"))
    } else {
        let dof = trees::dof(seed / 2);
        trees::random(seed / 2, if seed % 24 == 23 { dof + 5 } else { dof })
    };
    robot.rotors = seed.is_multiple_of(3);
    robot
}

fn number(variable: &str, otherwise: usize) -> usize {
    std::env::var(variable).ok().and_then(|count| count.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    let (count, first) = (
        number("RNE_DERIVATIVES", if shipped::is_exhaustive() { 20 * SOME } else { SOME }),
        number("RNE_DERIVATIVES_FIRST", 0),
    );
    let (done, shows) = (AtomicUsize::new(0), count > 20 * SOME);
    // a line per step where nobody looks, which also says where to go on
    let every = if std::io::stderr().is_terminal() { 1 } else { 50 };
    let seeds: Vec<_> = (first as u64..(first + count) as u64).collect();
    let worst = of_each(&seeds, |seed, worst| {
        let mut own = Worst::default();
        compare(&robot(seed), seed, &mut own);
        worst.join(own);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if shows && done.is_multiple_of(every) {
            let (bar, width, start) = (40 * done / count, 40, if every == 1 { "\r" } else { "\n" });
            let _ = write!(std::io::stderr(), "{start}[{:<width$}] {done} of {count} robots", "#".repeat(bar));
        }
    });
    if shows {
        eprintln!();
        println!("| derivative | robots | largest error |\n|---|---|---|");
        for (name, error, robots) in worst.rows() {
            println!("| `{name}` | {robots} | {error:.1e} |");
        }
        println!("seeds {first} to {}: arms and trees in turn, both forms", first + count - 1);
    }
    let second = [F::TorqueHessian.name()];
    for (name, error, _) in worst.rows() {
        let tolerance = if second.contains(name) { SECOND_ORDER } else { FIRST_ORDER };
        assert!(*error <= tolerance, "{name}: {error:e}");
    }
    for name in DERIVATIVES.iter().map(|it| it.function.name()).chain(OF_RUNTIME) {
        assert!(worst.rows().iter().any(|row| row.0 == name), "no robot compares {name}");
    }
}

/// The methods that the sources of the runtime declare for users.
fn of_runtime(folder: &Path, names: &mut BTreeSet<String>) {
    for entry in folder.read_dir().expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            if !path.ends_with("testing") {
                of_runtime(&path, names);
            }
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a text");
        let mut is_trait = false;
        let declared = text.lines().filter_map(|line| {
            is_trait = line.starts_with("pub trait") || is_trait && line != "}";
            let line = line.strip_prefix("    ")?;
            let method = line.strip_prefix("pub fn ").or_else(|| line.strip_prefix("fn ").filter(|_| is_trait))?;
            method.split(['<', '(']).next()
        });
        names.extend(declared.map(str::to_owned));
    }
}

#[test]
fn every_derivative_is_compared() {
    let mut names: BTreeSet<String> = Function::ALL.iter().map(|function| function.name().to_owned()).collect();
    of_runtime(&Path::new(ROOT).join("rne-runtime/src"), &mut names);
    let is_derivative = |name: &String| {
        let mut words = name.split('_');
        words.any(|word| ["derivatives", "gradient", "hessian", "rate"].contains(&word))
            // the same at a frame and of many states
            && !["_at_frame", "_of", "_batch", "_batch_on"].iter().any(|end| name.ends_with(end))
    };
    let of_tables: Vec<&str> = DERIVATIVES.iter().map(|it| it.function.name()).collect();
    let elsewhere = ELSEWHERE.map(|(name, _)| name);
    let mut found = 0;
    for name in names.iter().filter(|name| is_derivative(name)) {
        let lists = [&of_tables[..], &OF_RUNTIME, &elsewhere];
        assert!(lists.iter().any(|list| list.contains(&name.as_str())), "{name} is in no list of this file");
        found += 1;
    }
    assert!(found >= 17, "{found}: {names:?}");
    for (name, file) in ELSEWHERE {
        let text = std::fs::read_to_string(Path::new(ROOT).join(file)).expect("the file of the tests");
        let variant = Function::named(name).map_or(name.to_owned(), |function| format!("Function::{function:?}"));
        assert!(text.contains(name) || text.contains(&variant), "{file} does not have {name}");
    }
}
