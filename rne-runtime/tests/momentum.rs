//! The momentum of the joints and its rate: closed forms, and what they are of mass matrix, Christoffel's matrix and
//! kinetic energy.
#![cfg(feature = "arm")]

use crate::common::{Numbers, assert_close, one_link, prismatic_revolute, revolute_prismatic, six_joints, tool};
use num_dual::Dual64;
use rne_model::Convention::{Modified, Standard};
use rne_model::{Model, Motor};
use rne_runtime::{Arm, CoriolisMatrix, Energy, InverseDynamics, MassMatrix, MomentumAndRate, MomentumObserver};

fn product<const DOF: usize>(rows: &[[f64; DOF]; DOF], x: &[f64; DOF]) -> [f64; DOF] {
    rows.map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum())
}

/// A rod of length a and mass m on a revolute joint has p = m a²/3 q̇ and nothing but weight and torque for its rate.
#[test]
fn a_rod() {
    let arm = Arm::new(one_link());
    let (a, m, g) = (0.8, 2.5, 9.81);
    let (q, qd, tau) = (0.7_f64, -1.3, 4.0);
    let MomentumAndRate { momentum, rate } = arm.momentum_and_rate(&[q], &[qd], &[tau]);
    assert_close("p", &momentum, &[m * a * a / 3.0 * qd]);
    // gravity along x: V = -m g a/2 cos q
    assert_close("rate", &rate, &[tau - m * g * a / 2.0 * q.sin()]);
}

/// A slide on a turning joint: T = ½ (I + m s²) q̇₁² + ½ m ṡ², so that ∂T/∂s = m s q̇₁², the centrifugal force.
#[test]
fn a_slide_that_turns() {
    let model = revolute_prismatic();
    let arm = Arm::new(Model { gravity: [0.0; 3], ..model });
    let (q, qd, tau) = ([0.4, 0.9], [1.7, -0.6], [0.3, -0.2]);
    let (mass, inertia) = (1.5, 0.05);
    let (first, centre) = (2.5, 0.3);
    let around = 0.12 + first * centre * centre + inertia + mass * q[1] * q[1];
    let MomentumAndRate { momentum, rate } = arm.momentum_and_rate(&q, &qd, &tau);
    assert_close("p", &momentum, &[around * qd[0], mass * qd[1]]);
    assert_close("rate", &rate, &[tau[0], tau[1] + mass * q[1] * qd[0] * qd[0]]);
}

/// p = M q̇ and rate = τ + Cᵀ q̇ - g of an arm.
fn of_matrices<const DOF: usize>(arm: &Arm<DOF>, numbers: &mut Numbers) {
    let (q, qd, tau) = (numbers.array(3.0), numbers.array(2.0), numbers.array(10.0));
    let found = arm.momentum_and_rate(&q, &qd, &tau);
    assert_close("p", &found.momentum, &product(&arm.mass_matrix(&q), &qd));
    let coriolis = arm.coriolis_matrix(&q, &qd);
    let gravity = arm.gravity_torques(&q);
    let expected: [f64; DOF] =
        std::array::from_fn(|i| tau[i] + (0..DOF).map(|j| coriolis[j][i] * qd[j]).sum::<f64>() - gravity[i]);
    assert_close("rate", &found.rate, &expected);
}

/// rate - τ = ∂(T - V)/∂q, by dual numbers.
fn of_energies<const DOF: usize>(arm: &Arm<DOF>, numbers: &mut Numbers) {
    let (q, qd, tau): ([f64; DOF], [f64; DOF], [f64; DOF]) =
        (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
    let found = arm.momentum_and_rate(&q, &qd, &tau).rate;
    let expected: [f64; DOF] = std::array::from_fn(|i| {
        let along = std::array::from_fn(|j| Dual64::new(q[j], if i == j { 1.0 } else { 0.0 }));
        let kinetic = arm.kinetic_energy(&along, &qd.map(Dual64::from_re));
        tau[i] + (kinetic - arm.potential_energy(&along)).eps
    });
    assert_close("rate", &found, &expected);
}

#[test]
fn momentum_and_rate_are_those_of_the_matrices_and_the_energies() {
    let mut numbers = Numbers::new(61);
    for _ in 0..20 {
        for convention in [Standard, Modified] {
            let model = Model { tool: tool(), base: tool(), ..six_joints(convention) };
            of_matrices(&Arm::new(model), &mut numbers);
            of_energies(&Arm::new(model), &mut numbers);
        }
        for model in [revolute_prismatic(), prismatic_revolute()] {
            of_matrices(&Arm::new(model), &mut numbers);
            of_energies(&Arm::new(model), &mut numbers);
        }
    }
}

/// Rotors that belong to the arm are in its momentum, and in nothing else.
#[test]
fn rotors_carry_momentum() {
    let motor = Motor { inertia: 2e-4, gear_ratio: -80.0, viscous: 1e-3, coulomb: [0.4, -0.3] };
    let motors = [Some(motor), None, Some(motor), None, None, Some(motor)];
    let bare = Arm::new(six_joints(Standard)).with_motors(motors);
    let whole = bare.clone().with_rotors();
    let mut numbers = Numbers::new(62);
    for _ in 0..20 {
        of_matrices(&whole, &mut numbers);
        let (q, qd, tau) = (numbers.array(3.0), numbers.array(2.0), numbers.array(10.0));
        let [bare, whole] = [&bare, &whole].map(|arm| arm.momentum_and_rate(&q, &qd, &tau));
        assert_eq!(bare.rate, whole.rate);
        let rotors = motors.map(|motor| motor.map_or(0.0, |motor| motor.gear_ratio.powi(2) * motor.inertia));
        let expected: [f64; 6] = std::array::from_fn(|i| bare.momentum[i] + rotors[i] * qd[i]);
        assert_close("p", &whole.momentum, &expected);
    }
}
