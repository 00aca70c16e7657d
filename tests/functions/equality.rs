//! Generated code against the runtime: the same bits where the operations are the same, else the same numbers but for
//! rounding.
//!
//! Shipped and dense robots by their plan files, random ones by the choices of a build without one.

use fastrand::Rng;
use rne::{BaseMotion, Payload, Pose, Quaternion, Wrench};
use rne_codegen::{Argument, Form, Function};
use rne_model::{Dh, Robot};

use crate::arm::{Arm, Given, Maker, STEP, base_rotation, of_runtime};
use crate::case::{cases, largest, payload};
use crate::check::{Conditioning, Worst, conditioning, error_on_scale};
use crate::golden::ROBOTS;
use crate::tree_functions::contact_condition;

/// Of the largest number of the result.
const TOLERANCE: f64 = 1e-13;

/// Numbers that vanish but for rounding are measured by those that they are parts of: this part of the forces and
/// moments at the joints, of the energy at the farthest reach.
const LEAST: f64 = 1e-2;

/// At the farthest.
fn reach(arm: &Arm, given: &Given<'_, f64>) -> f64 {
    let of_row = |dh: &Dh| dh.a.abs() + dh.d.abs();
    arm.robot.rows().map(|row| of_row(&row.dh)).sum::<f64>() + largest(given.q)
}

/// What the numbers of a function are small against, if they are.
pub(crate) fn scale(arm: &Arm, function: Function, given: &Given<'_, f64>) -> f64 {
    let of = |function| largest(&of_runtime(&arm.runtime, function, given));
    match function {
        Function::InverseDynamics
        | Function::InverseDynamicsWithWrench
        | Function::InverseDynamicsWithWrenches
        | Function::InverseDynamicsWithPayload
        | Function::InverseDynamicsFromSinCos
        | Function::InverseDynamicsOnMovingBase
        | Function::InverseDynamicsOfFloatingBase
        | Function::FloatingBias
        | Function::FloatingGravityTorques
        | Function::CentroidalBias
        | Function::GravityTorques
        | Function::BiasTorques
        | Function::CoriolisTorques
        | Function::FloatingInverseDynamicsDerivatives
        | Function::InverseDynamicsDerivatives
        | Function::InverseDynamicsDerivativesWithWrenches => {
            // of a robot whose links have no mass, rotors alone need torques
            LEAST * of(Function::JointWrenches).max(of(Function::InverseDynamics))
        }
        Function::TorqueGradient | Function::TorqueHessian => LEAST * of(Function::JointWrenches) * largest(given.tau),
        // the joints carry the payload, too
        Function::GravityTorquesWithPayload
        | Function::BiasTorquesWithPayload
        | Function::FloatingInverseDynamicsWithPayload
        | Function::FloatingBiasTorquesWithPayload
        | Function::InverseDynamicsDerivativesWithPayload => {
            LEAST * of(Function::JointWrenches).max(of(Function::InverseDynamicsWithPayload))
        }
        // differences of torques at unit rates, and torques of unit accelerations
        Function::CoriolisMatrix | Function::FloatingMassMatrix => of(Function::MassMatrix),
        Function::FloatingMassMatrixWithPayload => of(Function::MassMatrixWithPayload),
        // a sum of products of masses and heights
        Function::PotentialEnergy | Function::FloatingPotentialEnergy => {
            let mass = arm.robot.rows().map(|row| row.link.mass).sum::<f64>();
            LEAST * mass * largest(&arm.robot.gravity) * reach(arm, given)
        }
        Function::CentreOfMass | Function::CentreOfMassJacobian => LEAST * reach(arm, given),
        // axes have the length one
        Function::JacobianRate => (1.0 + reach(arm, given)) * largest(given.qd),
        Function::JacobianDerivatives => 1.0 + reach(arm, given),
        Function::WrenchTorques => {
            let Wrench { force, moment } = given.wrench;
            LEAST * (largest(&moment) + largest(&force) * (1.0 + reach(arm, given)))
        }
        _ => 0.0,
    }
}

/// Whether code and runtime have the same meaning of a function.
pub(crate) fn is_compared(robot: &Robot, function: Function) -> bool {
    !(robot.has_couplings() && function.is_of_every_link())
}

/// Compares all functions of an arm at a state.
pub(crate) fn compare(arm: &Arm, maker: Maker, given: &Given<'_, f64>, tolerance: f64, worst: &mut Worst) {
    for function in Function::OF_TREES.into_iter().filter(|&function| is_compared(&arm.robot, function)) {
        let found = arm.numbers(function, given);
        worst.see(function.name(), error(arm, maker, function, given, &found, tolerance));
    }
}

/// How far derivatives of the accelerations are from those expected, beside derivatives of the torques: each of the
/// three matrices is a product with M⁻¹.
pub(crate) fn error_of_accelerations(found: &[f64], expected: &[f64], of_torques: f64, of_mass: &Conditioning) -> f64 {
    let &Conditioning { number, largest } = of_mass;
    let by_state = of_torques * number / largest;
    let (found, expected) = (found.chunks(found.len() / 3), expected.chunks(expected.len() / 3));
    let parts = found.zip(expected).zip([by_state, by_state, number / largest]);
    parts.fold(0.0, |worst, ((found, expected), scale)| worst.max(error_on_scale(found, expected, scale) / number))
}

/// The function of the accelerations of a step, its numbers by those of the step, and the positions beside those that
/// the step must have, with the scale of their rounding.
type WithoutStep<'a> = (Function, Vec<f64>, &'a [f64], Vec<f64>, f64);

/// q̈ = (q̇' - q̇) / h
fn without_step<'a>(given: &Given<'_, f64>, found: &'a [f64]) -> WithoutStep<'a> {
    let (positions, rates) = found.split_at(given.q.len());
    let accelerations = rates.iter().zip(given.qd).map(|(next, qd)| (next - qd) / STEP).collect();
    let moved = given.q.iter().zip(rates).map(|(q, rate)| q + STEP * rate).collect();
    (Function::ForwardDynamics, accelerations, positions, moved, largest(given.q))
}

/// The same of the derivatives.
fn without_step_of_derivatives<'a>(given: &Given<'_, f64>, found: &'a [f64]) -> WithoutStep<'a> {
    let dof = given.q.len();
    let (positions, rates) = found.split_at(3 * dof * dof);
    let one = |kind: usize, at: usize| {
        let is_diagonal = at / (dof * dof) == kind && (at % (dof * dof)).is_multiple_of(dof + 1);
        f64::from(u8::from(is_diagonal))
    };
    let accelerations = rates.iter().enumerate().map(|(at, x)| (x - one(1, at)) / STEP).collect();
    let moved = rates.iter().enumerate().map(|(at, x)| one(0, at) + STEP * x).collect();
    (Function::ForwardDynamicsDerivatives, accelerations, positions, moved, 1.0)
}

/// The accelerations of a step with a floating base, and how far the step is from that of these accelerations.
fn without_step_of_floating_base(arm: &Arm, given: &Given<'_, f64>, found: &[f64]) -> (Vec<f64>, f64) {
    let (base, joints) = found.split_at(18);
    let (positions, rates) = joints.split_at(given.q.len());
    let triple = |from: usize| [base[from], base[from + 1], base[from + 2]];
    let (Pose { rotation, translation }, twist) = (given.pose(), given.twist());
    let moved = |x: &[f64], by: &[f64]| x.iter().zip(by).map(|(x, by)| x + STEP * by).collect::<Vec<_>>();
    let rate = |next: &[f64], x: &[f64]| next.iter().zip(x).map(|(next, x)| (next - x) / STEP).collect::<Vec<_>>();
    let (next, omega) = (nalgebra::Matrix3::from_row_slice(&base[..9]), triple(15));
    // R' v' is the velocity in world axes
    let in_world = next * nalgebra::Vector3::from(triple(12));
    let driven = in_world - nalgebra::Vector3::from(arm.robot.gravity) * STEP;
    // the transpose, as it takes columns
    let driven = nalgebra::Matrix3::from(rotation) * driven;
    let accelerations = [rate(driven.as_slice(), &twist.linear), rate(&omega, &twist.angular), rate(rates, given.qd)];
    let [x, y, z] = omega.map(|x| x * STEP / 4.0);
    let half = Quaternion { w: 1.0, x, y, z };
    let turned = Quaternion::of_rotation(&rotation).then(&half).then(&half).to_wxyz();
    let length = turned.iter().map(|x| x * x).sum::<f64>().sqrt();
    let turned = Quaternion::from_wxyz(turned.map(|x| x / length)).rotation();
    let error = [
        error_on_scale(&base[..9], turned.as_flattened(), 0.0),
        error_on_scale(&base[9..12], &moved(&translation, in_world.as_slice()), largest(&translation)),
        error_on_scale(positions, &moved(given.q, rates), largest(given.q)),
    ];
    (accelerations.concat(), error.into_iter().fold(0.0, f64::max))
}

/// How far the derivatives of a step with a floating base are from those expected, of the condition of M.
fn error_of_floating_step(arm: &Arm, given: &Given<'_, f64>, found: &[f64], expected: &[f64]) -> f64 {
    let matrix = arm.runtime.floating_mass_matrix(given.q).expect("one per joint");
    let Some(Conditioning { number, largest: of_matrix }) = conditioning(&matrix) else { return 0.0 };
    if number >= 1e12 {
        return 0.0;
    }
    // 1 + h times derivatives of accelerations
    let solved = of_runtime(&arm.runtime, Function::FloatingForwardDynamics, given);
    let base = BaseMotion {
        acceleration: [solved[0], solved[1], solved[2]],
        omega_dot: [solved[3], solved[4], solved[5]],
        gravity: [0.0; 3],
        ..given.base
    };
    let given = &Given { qdd: &solved[6..], base, ..*given };
    let of_forces = largest(&of_runtime(&arm.runtime, Function::FloatingInverseDynamicsDerivatives, given));
    error_on_scale(found, expected, STEP * of_forces / of_matrix) / number
}

/// How far accelerations in contact are from those expected, of the condition of the system.
fn error_in_contact(arm: &Arm, given: &Given<'_, f64>, found: &[f64], expected: &[f64]) -> f64 {
    let runtime = |function| of_runtime(&arm.runtime, function, given);
    let [mass, jacobians] = [Function::FloatingMassMatrix, Function::TipJacobians].map(runtime);
    let rows: Vec<Vec<f64>> = mass.chunks(6 + arm.robot.dof()).map(<[f64]>::to_vec).collect();
    if conditioning(&rows).is_none() {
        return 0.0;
    }
    let number = contact_condition(&arm.robot, &mass, &jacobians);
    if number >= 1e12 {
        return 0.0;
    }
    error_on_scale(found, expected, 0.0) / number
}

/// The condition of the mass matrix that a function solves by, unless it is nearly singular.
fn conditioning_of(arm: &Arm, function: Function, q: &[f64], payload: &Payload<f64>) -> Option<Conditioning> {
    let matrix = if function.is_of_floating_base() {
        arm.runtime.floating_mass_matrix_with_payload(q, payload)
    } else {
        arm.runtime.mass_matrix_with_payload(q, payload)
    };
    conditioning(&matrix.expect("one per joint")).filter(|condition| condition.number < 1e12)
}

/// How far what is found is from the runtime, of its scale and, for accelerations, of the condition of M.
pub(crate) fn error(
    arm: &Arm,
    maker: Maker,
    function: Function,
    given: &Given<'_, f64>,
    found: &[f64],
    tolerance: f64,
) -> f64 {
    let expected = of_runtime(&arm.runtime, function, given);
    let is_finite = expected.iter().all(|x| x.is_finite());
    // code differentiates through couplings, where the runtime projects derivatives by all joints; code adds a constant
    // angle to the position of a follower, where the runtime has the addition theorem
    let is_other = arm.robot.has_couplings()
        && [
            Function::InverseDynamicsDerivatives,
            Function::InverseDynamicsDerivativesWithPayload,
            Function::InverseDynamicsDerivativesWithWrenches,
            Function::FloatingInverseDynamicsDerivatives,
            Function::InverseDynamicsFromSinCos,
        ]
        .contains(&function);
    let has_bits = maker == Maker::Code(Form::SevenSteps) && function.entry().has_bits_of_runtime
        && !is_other
        // code eliminates the joints of a tree in the order that fills less
        && (arm.robot.is_serial() || !function.inverts_mass() || function.is_of_floating_base());
    let error = match function {
        // of a matrix that is singular, where the runtime divided by zero
        _ if function.inverts_mass() && !is_finite => return 0.0,
        // of an arm without mass
        Function::CentreOfMass | Function::CentreOfMassJacobian if !is_finite => {
            assert!(found.iter().all(|x| !x.is_finite()), "{}, {function}: {found:?}", arm.robot.name);
            return 0.0;
        }
        // moments about its centre of mass
        Function::CentroidalMomentumMatrix | Function::CentroidalBias | Function::CentroidalMomentum if !is_finite => {
            let same = found.iter().zip(&expected).all(|(found, expected)| found.is_finite() == expected.is_finite());
            assert!(same, "{}, {function}: {found:?}", arm.robot.name);
            return 0.0;
        }
        _ if has_bits => {
            assert_eq!(found, expected, "{}, {function}", arm.robot.name);
            return 0.0;
        }
        Function::ForwardDynamicsInContact => error_in_contact(arm, given, found, &expected),
        Function::ForwardDynamicsDerivatives
        | Function::ForwardDynamicsDerivativesWithWrenches
        | Function::ForwardDynamicsDerivativesWithPayload => {
            let payload = if function.takes(Argument::Payload) { given.payload } else { Payload::none() };
            let matrix = arm.runtime.mass_matrix_with_payload(given.q, &payload).expect("one per joint");
            let Some(Conditioning { number, largest: of_matrix }) = conditioning(&matrix) else { return 0.0 };
            if number >= 1e12 {
                return 0.0;
            }
            let (solved, torques) = match function {
                Function::ForwardDynamicsDerivatives => {
                    (Function::ForwardDynamics, Function::InverseDynamicsDerivatives)
                }
                Function::ForwardDynamicsDerivativesWithPayload => {
                    (Function::ForwardDynamicsWithPayload, Function::InverseDynamicsDerivativesWithPayload)
                }
                _ => (Function::ForwardDynamicsWithWrenches, Function::InverseDynamicsDerivativesWithWrenches),
            };
            let qdd = of_runtime(&arm.runtime, solved, given);
            let given = &Given { qdd: &qdd, ..*given };
            let of_torques = largest(&of_runtime(&arm.runtime, torques, given)).max(scale(arm, torques, given));
            error_of_accelerations(found, &expected, of_torques, &Conditioning { number, largest: of_matrix })
        }
        Function::EulerStep | Function::EulerStepDerivatives => {
            let (of, accelerations, positions, moved, scale) = if function == Function::EulerStep {
                without_step(given, found)
            } else {
                without_step_of_derivatives(given, found)
            };
            let of_accelerations = error(arm, maker, of, given, &accelerations, tolerance);
            // of a singular mass matrix the numbers may not be finite
            let is_finite = found.iter().all(|x| x.is_finite());
            let of_positions = || error_on_scale(positions, &moved, scale);
            if is_finite { of_accelerations.max(of_positions()) } else { of_accelerations }
        }
        Function::FloatingEulerStep if !found.iter().all(|x| x.is_finite()) => 0.0,
        Function::FloatingEulerStep => {
            let (accelerations, of_step) = without_step_of_floating_base(arm, given, found);
            of_step.max(error(arm, maker, Function::FloatingForwardDynamics, given, &accelerations, tolerance))
        }
        Function::FloatingEulerStepDerivatives => error_of_floating_step(arm, given, found, &expected),
        Function::ForwardDynamics
        | Function::InverseMassMatrix
        | Function::InverseMassMatrixTimesTorques
        | Function::ForwardDynamicsWithPayload
        | Function::ForwardDynamicsWithWrenches
        | Function::FloatingForwardDynamics
        | Function::FloatingForwardDynamicsWithPayload => {
            let payload = if function.takes(Argument::Payload) { given.payload } else { Payload::none() };
            let Some(Conditioning { number, largest: of_matrix }) = conditioning_of(arm, function, given.q, &payload)
            else {
                return 0.0;
            };
            // Rounding of a matrix changes the solution by the condition number times as much, relative to the
            // solution; rounding of the torques and of the bias that they are compared with by M⁻¹, of 1/λ at most.
            if function == Function::InverseMassMatrix {
                return error_on_scale(found, &expected, number / of_matrix) / number;
            }
            let bias = match function {
                Function::FloatingForwardDynamics => of_runtime(&arm.runtime, Function::FloatingBias, given),
                _ => arm.runtime.bias_torques_with_payload(given.q, given.qd, &payload).expect("one per joint"),
            };
            let scale = largest(given.tau).max(largest(&bias)) / of_matrix;
            error_on_scale(found, &expected, scale) / number
        }
        _ => error_on_scale(found, &expected, scale(arm, function, given)),
    };
    assert!(error <= tolerance, "{}, {function}: {error:e}", arm.robot.name);
    error
}

/// Compares all functions of an arm at random states.
pub(crate) fn compare_at_states(arm: &Arm, maker: Maker, worst: &mut Worst) {
    compare_within(TOLERANCE, arm, maker, worst);
}

/// As [`compare_at_states`], with a tolerance of the caller.
pub(crate) fn compare_within(tolerance: f64, arm: &Arm, maker: Maker, worst: &mut Worst) {
    let mut rng = Rng::with_seed(19);
    // the code is a straight line: what is wrong at some state is wrong at almost all
    let states = if shipped::is_exhaustive() { 8 } else { 2 };
    for _ in 0..states {
        let mut array =
            |scale: f64| -> Vec<f64> { (0..arm.robot.dof()).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect() };
        let (q, qd, qdd, tau) = (array(3.0), array(2.0), array(5.0), array(20.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        let [omega, omega_dot, velocity, acceleration, gravity] = [(); 5].map(|()| triple());
        let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity };
        let payload = payload(&mut rng);
        let given = Given {
            q: &q,
            qd: &qd,
            qdd: &qdd,
            tau: &tau,
            wrench,
            payload,
            base,
            base_rotation: base_rotation(),
            step: STEP,
        };
        compare(arm, maker, &given, tolerance, worst);
    }
}

#[test]
fn shipped_and_dense_robots_are_the_runtime() {
    let dense = ["dense6_2p", "dense7"].map(|name| format!("tests/dense/{name}.yaml"));
    let files: Vec<String> = ROBOTS.iter().map(|name| format!("robots/{name}.yaml")).chain(dense).collect();
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for file in &files {
            compare_at_states(Arm::from_file(file, maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("shipped and dense, {maker}"));
    }
}

#[test]
fn random_robots_are_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for case in cases(maker) {
            compare(&case.arm, maker, &case.given(), TOLERANCE, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("random, {maker}"));
    }
}

/// Some of the robots of tests/random, which are compiled there.
#[test]
fn random_robots_of_files_are_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for seed in [3, 14, 25, 36] {
            compare_at_states(Arm::from_file(&format!("tests/random/files/{seed}.yaml"), maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("files of random robots, {maker}"));
    }
}

/// Angles that are right but for rounding: their cosine is 1 in double precision and not exactly.
#[test]
fn angles_that_are_almost_zero_are_no_zeros() {
    let yaml = "{format: 1, name: almost, source: own, convention: standard, gravity: [0, 0, -9.81],
        tool: {xyz: [0, 0.1, 0], rpy: [1.0e-9, 0.3, 1.0e-17]}, joints: [
        {type: revolute, dh: {theta: 1.0e-9, d: 0.1, a: 0.8, alpha: 0.3}, link: {mass: 2.5, com: [-0.4, 0, 1]}},
        {type: revolute, dh: {theta: 0.3, d: 0.3, a: 1, alpha: 1.0e-17}, link: {mass: 2.5, com: [-0.4, 0.3, 0.2]}},
        {type: revolute, dh: {theta: 1.0e-17, d: 0, a: 0.5, alpha: 1.0e-9}, link: {mass: 1, com: [1, 0.3, 0.2]}}]}";
    let robot = Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}"));
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        compare_at_states(&Arm::new(&robot, maker), maker, &mut worst);
        worst.at_most(TOLERANCE, &format!("almost right, {maker}"));
    }
}

/// The mass matrix of an arm with a joint that moves nothing: code like any other, whose result is not finite.
#[test]
fn a_singular_mass_matrix_has_no_accelerations() {
    let yaml = "{format: 1, name: massless, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}},
        {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}}]}";
    let robot = Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}"));
    for maker in Maker::ALL {
        let accelerations = Arm::new(&robot, maker).forward_dynamics(&[0.3_f64, 0.4], &[0.5, 0.6], &[0.7, 0.8]);
        assert!(!accelerations[1].is_finite(), "{maker}: {accelerations:?}");
    }
}
