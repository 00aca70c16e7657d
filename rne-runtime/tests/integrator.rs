//! Steps of integrators: closed forms, orders of convergence, and derivatives beside dual numbers through the step.

use std::array::from_fn;
use std::f64::consts::PI;

use crate::common::{Numbers, assert_close, link, model, one_link, row, six_joints, two_links};
use rne_model::Convention::{Modified, Standard};
use rne_model::JointKind;
use rne_runtime::{
    Arm, Dual, DynArm, Energy, EulerStep, EulerStepDerivatives, ForwardDynamics, NextState, NextStateDerivatives,
    RungeKuttaStep, RungeKuttaStepDerivatives, Scalar,
};

/// The classical method as textbooks write it: slopes of the whole state.
fn textbook<const DOF: usize, T: Scalar>(arm: &Arm<DOF>, state: [[T; DOF]; 3], step: T) -> [[T; DOF]; 2] {
    let [q, qd, tau] = state;
    let number = |x: f64| T::from_f64(x);
    let slope = |[q, qd]: [[T; DOF]; 2]| [qd, arm.forward_dynamics(&q, &qd, &tau)];
    let moved =
        |part: T, slope: [[T; DOF]; 2]| from_fn(|which| from_fn(|i| [q, qd][which][i] + part * slope[which][i]));
    let first = slope([q, qd]);
    let second = slope(moved(step * number(0.5), first));
    let third = slope(moved(step * number(0.5), second));
    let fourth = slope(moved(step, third));
    from_fn(|which| {
        from_fn(|i| {
            let [first, second, third, fourth] = [first, second, third, fourth].map(|slope| slope[which][i]);
            [q, qd][which][i] + step / number(6.0) * (first + number(2.0) * second + number(2.0) * third + fourth)
        })
    })
}

/// Semi-implicit Euler, written anew.
fn euler<const DOF: usize, T: Scalar>(arm: &Arm<DOF>, [q, qd, tau]: [[T; DOF]; 3], step: T) -> [[T; DOF]; 2] {
    let accelerations = arm.forward_dynamics(&q, &qd, &tau);
    let rates: [T; DOF] = from_fn(|i| qd[i] + step * accelerations[i]);
    [from_fn(|i| q[i] + step * rates[i]), rates]
}

/// The derivatives of a step by dual numbers through it: in the order of the blocks of [`NextStateDerivatives`].
fn by_dual_numbers<const DOF: usize>(
    state: [[f64; DOF]; 3],
    step: impl Fn([[Dual<f64>; DOF]; 3]) -> [[Dual<f64>; DOF]; 2],
) -> [[[f64; DOF]; DOF]; 6] {
    let mut found = [[[0.0; DOF]; DOF]; 6];
    for (kind, column) in (0..3).flat_map(|kind| (0..DOF).map(move |column| (kind, column))) {
        let mut moving = state.map(|x| x.map(Dual::constant));
        moving[kind][column].derivative = 1.0;
        for (half, numbers) in step(moving).into_iter().enumerate() {
            for (row, number) in numbers.into_iter().enumerate() {
                found[3 * half + kind][row][column] = number.derivative;
            }
        }
    }
    found
}

fn blocks<const DOF: usize>(of: &NextStateDerivatives<DOF, f64>) -> [[[f64; DOF]; DOF]; 6] {
    [of.q.dq, of.q.dqd, of.q.dtau, of.qd.dq, of.qd.dqd, of.qd.dtau]
}

#[test]
fn steps_and_their_derivatives_are_those_of_the_textbook() {
    let mut numbers = Numbers::new(71);
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        for _ in 0..6 {
            let state: [[f64; 6]; 3] = [numbers.array(3.0), numbers.array(2.0), numbers.array(3.0)];
            let [q, qd, tau] = &state;
            let step = 0.02;
            for (name, next, expected, derivatives, of_derivatives) in [
                (
                    "euler_step",
                    arm.euler_step(q, qd, tau, step),
                    euler(&arm, state, step),
                    arm.euler_step_derivatives(q, qd, tau, step),
                    by_dual_numbers(state, |state| euler(&arm, state, Dual::constant(step))),
                ),
                (
                    "runge_kutta_step",
                    arm.runge_kutta_step(q, qd, tau, step),
                    textbook(&arm, state, step),
                    arm.runge_kutta_step_derivatives(q, qd, tau, step),
                    by_dual_numbers(state, |state| textbook(&arm, state, Dual::constant(step))),
                ),
            ] {
                assert_close(name, &[next.q, next.qd].concat(), &expected.concat());
                for (found, expected) in blocks(&derivatives).iter().zip(&of_derivatives) {
                    assert_close(name, found.as_flattened(), expected.as_flattened());
                }
            }
        }
    }
}

/// An arm whose number of joints is known at run time only computes the same bits.
#[test]
fn steps_of_lists_are_those_of_arrays() {
    let (arm, lists) = (Arm::new(six_joints(Standard)), DynArm::new(&six_joints(Standard)));
    let mut numbers = Numbers::new(72);
    for _ in 0..4 {
        let [q, qd, tau]: [[f64; 6]; 3] = [numbers.array(3.0), numbers.array(2.0), numbers.array(3.0)];
        let euler = lists.euler_step(&q, &qd, &tau, 0.02).expect("six");
        let expected = arm.euler_step(&q, &qd, &tau, 0.02);
        assert_eq!((&euler.q[..], &euler.qd[..]), (&expected.q[..], &expected.qd[..]));
        let next = lists.runge_kutta_step(&q, &qd, &tau, 0.02).expect("six");
        let expected = arm.runge_kutta_step(&q, &qd, &tau, 0.02);
        assert_eq!((&next.q[..], &next.qd[..]), (&expected.q[..], &expected.qd[..]));
        for (found, expected) in [
            (lists.euler_step_derivatives(&q, &qd, &tau, 0.02), arm.euler_step_derivatives(&q, &qd, &tau, 0.02)),
            (
                lists.runge_kutta_step_derivatives(&q, &qd, &tau, 0.02),
                arm.runge_kutta_step_derivatives(&q, &qd, &tau, 0.02),
            ),
        ] {
            let by = found.expect("six");
            let found = [by.q.dq, by.q.dqd, by.q.dtau, by.qd.dq, by.qd.dqd, by.qd.dtau];
            let expected = blocks(&expected).map(|block| block.map(Vec::from).to_vec());
            assert_eq!(found, expected);
        }
    }
    assert!(lists.runge_kutta_step(&[0.0; 5], &[0.0; 6], &[0.0; 6], 0.02).is_err());
}

/// The state after a time, in so many steps.
fn after<const DOF: usize>(
    arm: &Arm<DOF>,
    [q, qd, tau]: [[f64; DOF]; 3],
    (time, steps): (f64, u32),
    step: impl Fn(&Arm<DOF>, [[f64; DOF]; 3], f64) -> NextState<DOF, f64>,
) -> [[f64; DOF]; 2] {
    (0..steps).fold([q, qd], |[q, qd], _| {
        let next = step(arm, [q, qd, tau], time / f64::from(steps));
        [next.q, next.qd]
    })
}

#[test]
fn errors_fall_with_the_order_of_the_method() {
    let arm = Arm::new(two_links(Standard, [0.0, -9.81, 0.0]));
    let start = [[0.4, -0.9], [0.6, -1.1], [2.0, -0.5]];
    let runge_kutta = |arm: &Arm<2>, [q, qd, tau]: [[f64; 2]; 3], h| arm.runge_kutta_step(&q, &qd, &tau, h);
    let euler = |arm: &Arm<2>, [q, qd, tau]: [[f64; 2]; 3], h| arm.euler_step(&q, &qd, &tau, h);
    let exact = after(&arm, start, (0.5, 1000), runge_kutta).concat();
    let error = |found: [[f64; 2]; 2]| {
        found.concat().iter().zip(&exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max)
    };
    let order = |errors: [f64; 2]| (errors[0] / errors[1]).log2();
    let of_runge_kutta = order([100, 200].map(|steps| error(after(&arm, start, (0.5, steps), runge_kutta))));
    let of_euler = order([400, 800].map(|steps| error(after(&arm, start, (0.5, steps), euler))));
    println!("order of runge_kutta_step {of_runge_kutta:.3}, of euler_step {of_euler:.3}");
    assert!((of_runge_kutta - 4.0).abs() < 0.1, "{of_runge_kutta}");
    assert!((of_euler - 1.0).abs() < 0.05, "{of_euler}");
}

/// A rod of length a on a hinge swings as a pendulum of length 2 a / 3: its period is 2π √(2 a / 3 g) over the
/// arithmetic-geometric mean of 1 and cos(q₀ / 2), with the amplitude q₀.
#[test]
fn a_pendulum_has_its_period_and_keeps_its_energy() {
    let arm = Arm::new(one_link());
    let amplitude = 2.0_f64;
    let (mut a, mut b) = (1.0_f64, (amplitude / 2.0).cos());
    for _ in 0..8 {
        (a, b) = (a.midpoint(b), (a * b).sqrt());
    }
    let period = 2.0 * PI * (0.8 / (1.5 * 9.81_f64)).sqrt() / a;
    let start = [[amplitude], [0.0], [0.0]];
    let [[q], [qd]] = after(&arm, start, (period, 1000), |arm, [q, qd, tau], h| arm.runge_kutta_step(&q, &qd, &tau, h));
    assert!((q - amplitude).abs() < 1e-9 && qd.abs() < 1e-8, "{q} {qd}");

    // the energy of a symplectic step swings, and comes back with every period
    let energy = |q: f64, qd: f64| arm.kinetic_energy(&[q], &[qd]) + arm.potential_energy(&[q]);
    let (mut q, mut qd, mut largest) = ([amplitude], [0.0], [0.0_f64; 2]);
    for step in 0..4_000 {
        NextState { q, qd } = arm.euler_step(&q, &qd, &[0.0], period / 200.0);
        let error = (energy(q[0], qd[0]) - energy(amplitude, 0.0)).abs();
        if step < 200 {
            largest[0] = largest[0].max(error);
        } else if step >= 3_800 {
            largest[1] = largest[1].max(error);
        }
    }
    println!(
        "energy errors of euler_step, J: {:.4} in the first period, {:.4} in the twentieth",
        largest[0], largest[1]
    );
    assert!(largest[0] < 1.0 && largest[1] < 1.05 * largest[0], "{largest:?}");
}

#[test]
fn a_slide_under_a_constant_force_moves_as_in_closed_form() {
    let mass = link(2.0, [0.0; 3], [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]);
    let arm = Arm::new(model(Standard, [0.0, 0.0, -9.81], [row(JointKind::Prismatic, [0.0; 4], mass)]));
    let ([q], [qd], force, h) = ([0.3_f64], [0.7], 30.0, 0.25);
    let acceleration = force / 2.0 - 9.81;
    let next = arm.runge_kutta_step(&[q], &[qd], &[force], h);
    assert_close("q", &next.q, &[q + h * qd + h * h * acceleration / 2.0]);
    assert_close("q̇", &next.qd, &[qd + h * acceleration]);
    let found = arm.runge_kutta_step_derivatives(&[q], &[qd], &[force], h);
    assert_close(
        "derivatives",
        blocks(&found).as_flattened().as_flattened(),
        &[1.0, h, h * h / 4.0, 0.0, 1.0, h / 2.0],
    );
    let found = arm.euler_step_derivatives(&[q], &[qd], &[force], h);
    assert_close(
        "derivatives",
        blocks(&found).as_flattened().as_flattened(),
        &[1.0, h, h * h / 2.0, 0.0, 1.0, h / 2.0],
    );
}

#[test]
fn a_step_of_no_time_changes_nothing() {
    let arm = Arm::new(six_joints(Standard));
    let mut numbers = Numbers::new(72);
    let [q, qd, tau]: [[f64; 6]; 3] = [numbers.array(3.0), numbers.array(2.0), numbers.array(3.0)];
    for next in [arm.euler_step(&q, &qd, &tau, 0.0), arm.runge_kutta_step(&q, &qd, &tau, 0.0)] {
        assert_eq!(next, NextState { q, qd });
    }
    let unit: [[f64; 6]; 6] = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
    for found in [arm.euler_step_derivatives(&q, &qd, &tau, 0.0), arm.runge_kutta_step_derivatives(&q, &qd, &tau, 0.0)]
    {
        let nothing = [[0.0; 6]; 6];
        assert_eq!(blocks(&found), [unit, nothing, nothing, nothing, unit, nothing]);
    }
}
