//! What motors add: rotor inertia and friction behind a gear.
#![cfg(feature = "std")]

use crate::common::{relative_error, six_joints};
use num_dual::Dual64;
use rne_model::Convention::Standard;
use rne_model::Motor;
use rne_runtime::{Actuation, Arm, Constant, Dual, DynArm, Scalar};
use simba::simd::{AutoF64x4, SimdValue, WideF64x4};

/// The first joint of a PUMA 560: its gear turns the motor backwards.
const MOTOR: Motor = Motor { inertia: 2e-4, gear_ratio: -62.6111, viscous: 1.48e-3, coulomb: [0.395, -0.435] };

const NO_FRICTION: Motor = Motor { viscous: 0.0, coulomb: [0.0; 2], ..MOTOR };

const MOTORS: [Option<Motor>; 6] = [Some(MOTOR), None, Some(NO_FRICTION), Some(MOTOR), None, Some(MOTOR)];

const QD: [f64; 6] = [0.7, -0.3, 1.1, -0.2, 0.0, 0.0];
const QDD: [f64; 6] = [1.0, 2.0, -3.0, 0.5, -0.1, 4.0];

fn arm() -> Arm<6> {
    Arm::new(six_joints(Standard)).with_motors(MOTORS)
}

#[test]
fn inertia_viscous_and_coulomb_friction() {
    let g = 62.6111_f64;
    let expected = [
        g * g * 2e-4 * 1.0 + g * g * 1.48e-3 * 0.7 + g * 0.395,
        0.0,
        g * g * 2e-4 * -3.0,
        g * g * 2e-4 * 0.5 - g * g * 1.48e-3 * 0.2 - g * 0.435,
        0.0,
        g * g * 2e-4 * 4.0, // no friction at rest
    ];
    let found = arm().actuator_torques(&QD, &QDD);
    assert!(relative_error(&found, &expected) < 1e-15);
    let dyn_arm = DynArm::new(&six_joints(Standard)).with_motors(MOTORS.to_vec()).expect("six");
    assert_eq!(dyn_arm.actuator_torques(&QD, &QDD), Ok(found.to_vec()));
    assert_eq!(Arm::new(six_joints(Standard)).actuator_torques(&QD, &QDD), [0.0; 6], "no motors");
    let without = DynArm::new(&six_joints(Standard));
    assert_eq!(without.actuator_torques(&QD, &QDD), Ok(vec![0.0; 6]), "no motors");
}

#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn single_precision_keeps_the_motors() {
    let expected = arm().actuator_torques(&QD, &QDD);
    let (qd, qdd) = (QD.map(|x| x as f32), QDD.map(|x| x as f32));
    let single = Arm::new(six_joints(Standard).to_f32()).with_motors(MOTORS.map(|motor| motor.map(Motor::to_f32)));
    let found = single.actuator_torques(&qd, &qdd);
    assert!(relative_error(&found.map(f64::from), &expected) < 1e-6);
    let dyn_arm = DynArm::new(&six_joints(Standard)).with_motors(MOTORS.to_vec()).expect("six").to_f32();
    assert_eq!(dyn_arm.motors(), single.motors());
    assert_eq!(dyn_arm.actuator_torques(&qd, &qdd), Ok(found.to_vec()));
    assert_eq!(
        dyn_arm.actuator_torques_smooth(&qd, &qdd, 0.1),
        Ok(single.actuator_torques_smooth(&qd, &qdd, 0.1).to_vec())
    );
}

/// A motor with friction alone, at joint 1.
fn friction<T: Scalar>(qd: T, width: Option<T>) -> T {
    let motor = Motor { inertia: 0.0, viscous: 0.0, ..MOTOR };
    let arm = Arm::new(six_joints(Standard)).with_motors([Some(motor), None, None, None, None, None]);
    let zero = [T::zero(); 6];
    let mut rates = zero;
    rates[0] = qd;
    match width {
        Some(width) => arm.actuator_torques_smooth(&rates, &zero, width)[0],
        None => arm.actuator_torques(&rates, &zero)[0],
    }
}

#[test]
fn friction_follows_the_sign_in_every_scalar() {
    let (forward, backward) = (62.6111 * 0.395, 62.6111 * -0.435);
    for (rate, expected) in [(1e-300, forward), (7.0, forward), (-1e-300, backward), (0.0, 0.0), (-0.0, 0.0)] {
        assert_eq!(friction(rate, None), expected);
        assert_eq!(friction(Dual::constant(rate), None), Dual::constant(expected));
        assert_eq!(friction(Dual64::from_re(rate), None), Dual64::from_re(expected));
    }
    let mixed = [2.0, -0.5, 0.0, -1e-300];
    assert_eq!(lanes::<AutoF64x4>(mixed), [forward, backward, 0.0, backward]);
    assert_eq!(lanes::<WideF64x4>(mixed), [forward, backward, 0.0, backward]);
}

#[test]
fn what_is_no_number_has_no_sign() {
    assert_eq!(f64::NAN.by_sign(1.0, -1.0), 0.0);
    assert_eq!(f32::INFINITY.by_sign(1.0, -1.0), 1.0);
    assert_eq!(Dual::constant(f64::NAN).by_sign(Dual::constant(1.0), Dual::constant(-1.0)), Dual::constant(0.0));
    assert!(friction(f64::NAN, None).is_nan(), "viscous friction does not hide it");
}

fn lanes<V: Scalar + SimdValue<Element = f64>>(rates: [f64; 4]) -> [f64; 4] {
    let mut bundle = V::splat(0.0);
    for (lane, rate) in rates.into_iter().enumerate() {
        bundle.replace(lane, rate);
    }
    let found = friction(bundle, None);
    std::array::from_fn(|lane| found.extract(lane))
}

#[test]
fn smooth_friction_tends_to_the_other() {
    let (forward, backward) = (62.6111 * 0.395, 62.6111 * -0.435);
    assert_eq!(friction(0.0, Some(0.01)), 0.0);
    for rate in [0.3_f64, 2.0, -0.3, -2.0] {
        let expected = friction(rate, None);
        assert!((friction(rate, Some(1e-9)) - expected).abs() < 1e-12);
        let s = rate / (rate * rate + 0.04_f64).sqrt();
        let expected = 0.5 * (forward - backward) * s + 0.5 * (forward + backward) * s * s;
        assert!((friction(rate, Some(0.2)) - expected).abs() < 1e-13);
        let step = 1e-6;
        let slope = (friction(rate + step, Some(0.2)) - friction(rate - step, Some(0.2))) / (2.0 * step);
        let dual = friction(Dual { value: rate, derivative: 1.0 }, Some(Dual::constant(0.2)));
        assert!((dual.derivative - slope).abs() < 1e-6, "{} {slope}", dual.derivative);
    }
    // The matrix has the closed form of the slope on its diagonal, and nothing beside it.
    let width = 0.2_f64;
    let found = arm().actuator_torques_smooth_derivatives(&QD, width);
    let slope = |qd: f64, motor: &Motor| {
        let (g, [plus, minus], r) = (motor.gear_ratio.abs(), motor.coulomb, qd.hypot(width));
        let friction = 0.5 * (plus - minus) + (plus + minus) * qd / r;
        g * g * motor.viscous + g * friction * width * width / (r * r * r)
    };
    let element = |i: usize, j: usize| MOTORS[i].as_ref().filter(|_| i == j).map_or(0.0, |motor| slope(QD[i], motor));
    let expected: [[f64; 6]; 6] = std::array::from_fn(|i| std::array::from_fn(|j| element(i, j)));
    assert!(relative_error(found.as_flattened(), expected.as_flattened()) < 1e-14, "{found:?} {expected:?}");
    let dyn_arm = DynArm::new(&six_joints(Standard)).with_motors(MOTORS.to_vec()).expect("six");
    let rows = dyn_arm.actuator_torques_smooth_derivatives(&QD, width).expect("six");
    assert_eq!(rows.concat(), found.as_flattened());
    assert!(dyn_arm.actuator_torques_smooth_derivatives(&QD[..5], width).is_err());
    assert!(!friction(Dual { value: 0.0_f64, derivative: 1.0 }, Some(Dual::constant(0.0))).derivative.is_finite());
    // Rising everywhere between, and the rest of the motor as it is.
    let rates: Vec<f64> = (-50..50).map(|k| friction(f64::from(k) * 0.01, Some(0.1))).collect();
    assert!(rates.windows(2).all(|pair| pair[0] < pair[1]));
    let (exact, smooth) = (arm().actuator_torques(&QD, &QDD), arm().actuator_torques_smooth(&QD, &QDD, 1e-9));
    assert!(relative_error(&smooth, &exact) < 1e-14);
}

#[test]
fn motors_change_no_other_function() {
    use rne_runtime::InverseDynamics;
    let bare = Arm::new(six_joints(Standard));
    assert_eq!(arm().bias_torques(&QDD, &QD), bare.bias_torques(&QDD, &QD));
    assert_eq!(arm().motors(), &MOTORS);
    assert_eq!(bare.motors(), &[None; 6]);
}

#[test]
fn a_constant_arm_s_motors() {
    fn torque<S: Constant>(motor: Motor<S>) -> f64 {
        let ratio: f64 = motor.gear_ratio.to();
        ratio
    }
    const SINGLE: Motor<f32> = MOTOR.to_f32();
    assert_eq!(torque(SINGLE), f64::from(-62.6111_f32));
}
