//! The momentum observer in simulations of its own: the sign of what it sees, its time constant, and how soon it sees a
//! payload.
#![cfg(feature = "std")]
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)] // numbers of joints, single precision

use std::f64::consts::TAU;

use crate::common;
use crate::common::{Numbers, one_link, six_joints, tool};
use rne_model::Convention::{Modified, Standard};
use rne_model::{Model, Robot};
use rne_runtime::{
    Arm, ComputedTorque, Desired, ForwardDynamics, InverseDynamics, Kinematics, MomentumObserver, ObserverState, Pose,
};

/// One step of Runge and Kutta's, of the state (q, q̇).
fn step<const DOF: usize>(
    [q, qd]: [[f64; DOF]; 2],
    h: f64,
    acceleration: impl Fn(&[f64; DOF], &[f64; DOF]) -> [f64; DOF],
) -> [[f64; DOF]; 2] {
    let ahead = |x: &[f64; DOF], rate: &[f64; DOF], h: f64| std::array::from_fn(|i| x[i] + h * rate[i]);
    let k1 = acceleration(&q, &qd);
    let v2 = ahead(&qd, &k1, h / 2.0);
    let k2 = acceleration(&ahead(&q, &qd, h / 2.0), &v2);
    let v3 = ahead(&qd, &k2, h / 2.0);
    let k3 = acceleration(&ahead(&q, &v2, h / 2.0), &v3);
    let v4 = ahead(&qd, &k3, h);
    let k4 = acceleration(&ahead(&q, &v3, h), &v4);
    let of = |a: f64, b: f64, c: f64, d: f64| h / 6.0 * (a + 2.0 * (b + c) + d);
    [
        std::array::from_fn(|i| q[i] + of(qd[i], v2[i], v3[i], v4[i])),
        std::array::from_fn(|i| qd[i] + of(k1[i], k2[i], k3[i], k4[i])),
    ]
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

/// Jᵀ w of a wrench in world axes at the tip.
fn of_wrench<const DOF: usize>(arm: &Arm<DOF>, q: &[f64; DOF], wrench: &[f64; 6]) -> [f64; DOF] {
    let jacobian = arm.jacobian(q);
    std::array::from_fn(|j| (0..6).map(|row| jacobian[row][j] * wrench[row]).sum())
}

/// A joint that does not move sees an external torque through the low-pass alone: r = τ (1 - e^(-2π gain t)), to
/// rounding, whatever the gain; and never more than τ.
#[test]
fn the_response_is_that_of_a_low_pass() {
    let arm = Arm::new(Model { gravity: [0.0; 3], ..one_link() });
    let external = 3.0;
    for (gain, period) in [(0.1, 1e-3), (10.0, 1e-3), (50.0, 1e-3), (500.0, 1e-3), (1e6, 1e-2), (20.0, 0.25)] {
        let mut observer = ObserverState::new(gain, period);
        // held by the actuator: what it delivers is the negative of what acts from outside
        assert_eq!(observer.update(&arm, &[0.4], &[0.0], &[-external]), [0.0]);
        for tick in 1..=200 {
            let [seen] = observer.update(&arm, &[0.4], &[0.0], &[-external]);
            let expected = -external * (-TAU * gain * period * f64::from(tick)).exp_m1();
            assert!((seen - expected).abs() < 1e-13 * external, "{gain} Hz, tick {tick}: {seen} is not {expected}");
        }
    }
}

/// Ticks of unequal length: the response depends on the time alone, and equal ticks give the bits of `update`.
#[test]
#[cfg(feature = "arm")]
fn a_tick_may_have_any_length() {
    use rne_runtime::{DynArm, DynObserverState};

    let arm = DynArm::new(&Model { gravity: [0.0; 3], ..one_link() });
    let (gain, external) = (20.0, 3.0);
    let tick = || arm.momentum_and_rate(&[0.4], &[0.0], &[-external]).expect("one joint");
    let mut observer = DynObserverState::new(1, gain, f64::NAN);
    let mut time = 0.0;
    for (k, period) in [0.0, 1e-3, 0.02, 3e-4, 0.1, 0.0, 1e-6].into_iter().enumerate() {
        let now = tick();
        let seen = observer.advance(period, now.momentum, now.rate).expect("one joint")[0];
        time += if k == 0 { 0.0 } else { period };
        let expected = -external * (-TAU * gain * time).exp_m1();
        assert!((seen - expected).abs() < 1e-13 * external, "{time} s: {seen} is not {expected}");
    }
    let [mut equal, mut fixed] = [0.0, 1e-3].map(|period| DynObserverState::new(1, gain, period));
    for k in 0..50 {
        let [q, qd] = [[0.1 * f64::from(k)], [f64::from(k).sin()]];
        let now = arm.momentum_and_rate(&q, &qd, &[1.0]).expect("one joint");
        let seen = equal.advance(1e-3, now.momentum, now.rate);
        assert_eq!(seen, fixed.update(&arm, &q, &qd, &[1.0]));
    }
    let wrong = observer.advance(1e-3, vec![0.0; 2], vec![0.0; 2]).expect_err("two joints");
    assert_eq!((wrong.argument, wrong.expected, wrong.found), ("momentum", 1, 2));
    assert_eq!(observer.advance(1e-3, vec![0.0], vec![0.0; 3]).expect_err("three rates").argument, "rate");
}

/// A gain or a period that is no positive number, and a period whose frequency is not finite, give zeros in either
/// precision; the shortest period that is allowed gives numbers.
#[test]
fn an_observer_without_gain_or_period_observes_nothing() {
    let arm = &Arm::new(one_link());
    let of = |gain, period| {
        let mut double = ObserverState::new(gain, period);
        let mut single = ObserverState::new(gain, period);
        (0..5).map(move |tick| {
            let (q, qd) = (0.1 * f64::from(tick), 1.0 + f64::from(tick));
            let [single] = single.update(arm, &[q as f32], &[qd as f32], &[3.0_f32]);
            [double.update(arm, &[q], &[qd], &[3.0])[0], f64::from(single)]
        })
    };
    let wrong = [0.0, -0.0, -1e-3, f64::NAN, f64::NEG_INFINITY];
    let short = [5e-324, 1e-310, 1e-45, 2.9e-39, 9e-31].map(|period| (20.0, period));
    let pairs = wrong.into_iter().flat_map(|wrong| [(wrong, 1e-3), (20.0, wrong), (wrong, wrong)]);
    for (gain, period) in pairs.chain(short) {
        for (tick, seen) in of(gain, period).enumerate() {
            assert_eq!(seen, [0.0; 2], "{gain} Hz, {period} s, tick {tick}");
        }
    }
    for (gain, period) in [(20.0, 1e-30), (20.0, 1e-3), (f64::INFINITY, 1e-3), (20.0, f64::INFINITY)] {
        assert!(of(gain, period).flatten().all(f64::is_finite), "{gain} Hz, {period} s");
        assert!(of(gain, period).skip(1).flatten().all(|seen| seen != 0.0), "{gain} Hz, {period} s");
    }
}

/// A free arm that a wrench pushes at the tip: once the low-pass has settled the observer shows Jᵀ w, with its sign;
/// before, it lags as the low-pass does.
#[test]
fn a_push_is_seen_with_its_sign() {
    let (gain, period) = (30.0, 1e-3);
    let wrench = [6.0, -4.0, 3.0, 0.5, 0.2, -0.4];
    for convention in [Standard, Modified] {
        let arm = Arm::new(Model { tool: tool(), base: tool(), ..six_joints(convention) });
        let mut observer = ObserverState::new(gain, period);
        let mut state = [common::SIX_Q, [0.0; 6]];
        // the low-pass of what acts, by its own differential equation
        let mut filtered = [0.0; 6];
        let mut worst: f64 = 0.0;
        let mut size: f64 = 0.0;
        for tick in 0..300 {
            let time = period * f64::from(tick);
            let pushes = if time >= 0.05 { 1.0 } else { 0.0 };
            // torques that hold against the weight, and damp a little: the wrist is light
            let tau = |q: &[f64; 6], qd: &[f64; 6]| -> [f64; 6] {
                let weight = arm.gravity_torques(q);
                std::array::from_fn(|i| weight[i] - 0.02 * qd[i])
            };
            let [q, qd] = state;
            let seen = observer.update(&arm, &q, &qd, &tau(&q, &qd));
            if tick > 0 {
                worst = worst.max((0..6).map(|i| (seen[i] - filtered[i]).abs()).fold(0.0, f64::max));
            }
            let acting = |q: &[f64; 6]| of_wrench(&arm, q, &wrench.map(|x| x * pushes));
            let before = acting(&q);
            state = step(state, period, |q, qd| {
                let (tau, external) = (tau(q, qd), acting(q));
                arm.forward_dynamics(q, qd, &std::array::from_fn(|i| tau[i] + external[i]))
            });
            let after = acting(&state[0]);
            size = size.max(largest(&after));
            let decay = (-TAU * gain * period).exp();
            filtered = std::array::from_fn(|i| {
                let mean = 0.5 * (before[i] + after[i]);
                mean + (filtered[i] - mean) * decay
            });
        }
        assert!(size > 1.0);
        assert!(worst < 1e-3 * size, "{convention:?}: {worst:e} of {size}");
        let settled = of_wrench(&arm, &state[0], &wrench);
        let seen = observer.external_torques();
        for i in 0..6 {
            assert!((seen[i] - settled[i]).abs() < 0.05 * size, "joint {i}: {} is not {}", seen[i], settled[i]);
        }
    }
}

/// Nothing acts: nothing is seen, while the arm moves fast. What is left is the trapezoidal rule's.
#[test]
fn free_motion_shows_nothing() {
    let period = 1e-3;
    let mut numbers = Numbers::new(71);
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        let mut observer = ObserverState::new(30.0, period);
        let mut state = [numbers.array(1.0), numbers.array(1.0)];
        let (mut worst, mut size): (f64, f64) = (0.0, 0.0);
        for tick in 0..300 {
            let time = period * f64::from(tick);
            let tau = |q: &[f64; 6]| -> [f64; 6] {
                let weight = arm.gravity_torques(q);
                std::array::from_fn(|i| weight[i] + 0.5 * (5.0 * time + i as f64).sin())
            };
            let [q, qd] = state;
            let held = tau(&q);
            let seen = observer.update(&arm, &q, &qd, &held);
            worst = worst.max(largest(&seen));
            size = size.max(largest(&held));
            state = step(state, period, |q, qd| arm.forward_dynamics(q, qd, &tau(q)));
        }
        assert!(worst < 1e-3 * size, "{convention:?}: {worst:e} of {size}");
    }
}

/// What was observed before a reset is forgotten, what is not finite too.
#[test]
fn a_reset_begins_anew() {
    let arm = Arm::new(one_link());
    let mut observer = ObserverState::new(20.0, 1e-3);
    let fresh = observer;
    let _ = observer.update(&arm, &[0.1], &[0.4], &[1.0]);
    let _ = observer.update(&arm, &[f64::NAN], &[0.4], &[1.0]);
    assert!(observer.external_torques()[0].is_nan());
    observer.reset();
    assert_eq!(observer, fresh);
    assert_eq!(observer.update(&arm, &[0.1], &[0.4], &[1.0]), [0.0]);
}

/// A gain that is none sees nothing, and makes no number that is none.
#[test]
fn a_gain_of_nothing_sees_nothing() {
    let arm = Arm::new(one_link());
    for gain in [0.0, -5.0, f64::NAN] {
        let mut observer = ObserverState::new(gain, 1e-3);
        for _ in 0..3 {
            assert_eq!(observer.update(&arm, &[0.1], &[0.4], &[1.0]), [0.0]);
        }
    }
}

/// Joint torques of a robot's payload are by far the largest at the shoulder. The PUMA 560 carries 2.5 kg; a tenth of
/// that is taken up, in the hand, at once. It shows within 20 ms of ticks at 1 kHz: where the observer's answer to the
/// noise of free motion stays below 0.4 N m, it has passed that. Whether the arm stands still or moves.
#[test]
fn a_tenth_of_the_payload_is_seen_within_20_milliseconds() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/puma560.yaml");
    let robot = Robot::from_yaml(&std::fs::read_to_string(path).expect("the shipped file")).expect("a robot");
    let arm = Arm::<6>::from_robot(&robot).expect("six joints");
    let (payload, threshold, period) = (0.25, 0.4, 1e-3);
    // the same arm, whose last link has the payload at the tip too
    let loaded = {
        let mut robot = robot.clone();
        let link = &mut robot.joints[5].row.link;
        let (mass, com) = (link.mass + payload, link.com);
        link.com = com.map(|x| x * link.mass / mass);
        // of the two points about their common centre
        let reduced = link.mass * payload / mass;
        let square: f64 = com.iter().map(|x| x * x).sum();
        link.inertia.xx += reduced * (square - com[0] * com[0]);
        link.inertia.yy += reduced * (square - com[1] * com[1]);
        link.inertia.zz += reduced * (square - com[2] * com[2]);
        link.inertia.xy -= reduced * com[0] * com[1];
        link.inertia.xz -= reduced * com[0] * com[2];
        link.inertia.yz -= reduced * com[1] * com[2];
        link.mass = mass;
        Arm::<6>::from_robot(&robot).expect("six joints")
    };
    let tip: Pose<f64> = arm.forward_kinematics(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(tip.translation.iter().all(|x| x.is_finite()));
    let mut noise = Numbers::new(72);
    let mut slowest = 0;
    for speed in [0.0, 1.0] {
        let mut observer = ObserverState::new(20.0, period);
        let rate = |i: usize| 1.0 + 0.3 * i as f64;
        // what a stiff controller makes the arm follow, and the torques that it needs, measured
        let motion = |time: f64| -> [[f64; 6]; 3] {
            [
                std::array::from_fn(|i| [0.3, -0.4, 0.2, 0.5, -0.6, 0.1][i] + 0.5 * speed * (rate(i) * time).sin()),
                std::array::from_fn(|i| 0.5 * speed * rate(i) * (rate(i) * time).cos()),
                std::array::from_fn(|i| -0.5 * speed * rate(i).powi(2) * (rate(i) * time).sin()),
            ]
        };
        let (grasp, mut seen_at, mut quiet) = (1000, None, 0.0_f64);
        for tick in 0..grasp + 100 {
            let [q, qd, qdd] = motion(period * f64::from(tick));
            let of = if tick < grasp { &arm } else { &loaded };
            let mut tau = of.inverse_dynamics(&q, &qd, &qdd);
            // of encoders that are differentiated, and of currents: uniform
            let qd: [f64; 6] = std::array::from_fn(|i| qd[i] + 1e-4 * noise.next());
            for tau in &mut tau {
                *tau += 0.1 * noise.next();
            }
            let seen = observer.update(&arm, &q, &qd, &tau);
            if tick < grasp {
                quiet = quiet.max(largest(&seen));
            } else if seen_at.is_none() && largest(&seen) > threshold {
                seen_at = Some(tick - grasp);
                // the payload pulls down: against what held it up
                assert!(seen[1] * arm.gravity_torques(&q)[1] < 0.0);
            }
        }
        assert!(quiet < threshold, "free motion shows {quiet} N m");
        let seen_at = seen_at.expect("it is seen");
        println!("speed {speed}: noise {quiet:.3} N m, seen after {seen_at} ms");
        slowest = slowest.max(seen_at);
    }
    assert!(slowest <= 20, "{slowest} ms");
}

/// In single precision, at 1 kHz and 20 Hz: rounding of the momenta stays far below what matters.
#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn single_precision_is_enough() {
    let arm = Arm::new(six_joints(Standard));
    let (mut single, mut double) = (ObserverState::<6, f32>::new(20.0, 1e-3), ObserverState::<6, f64>::new(20.0, 1e-3));
    let (mut worst, mut size): (f64, f64) = (0.0, 0.0);
    let ticks = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 20_000 } else { 6_000 };
    for tick in 0..ticks {
        let time = 1e-3 * f64::from(tick);
        let q: [f64; 6] = std::array::from_fn(|i| (time + i as f64).sin());
        let qd: [f64; 6] = std::array::from_fn(|i| (time + i as f64).cos());
        let tau = [5.0; 6];
        let exact = double.update(&arm, &q, &qd, &tau);
        let found = single.update(&arm, &q.map(|x| x as f32), &qd.map(|x| x as f32), &tau.map(|x| x as f32));
        worst = worst.max((0..6).map(|i| (exact[i] - f64::from(found[i])).abs()).fold(0.0, f64::max));
        size = size.max(largest(&exact));
    }
    println!("{worst:e} of {size}");
    assert!(worst < 1e-3 * size, "{worst:e} of {size}");
}

/// Any robot that has the trait has the observer.
#[test]
fn arms_of_both_kinds_of_joint_are_observed() {
    fn moves<const DOF: usize>(robot: &impl MomentumObserver<DOF>) -> bool {
        let mut observer = ObserverState::new(20.0, 1e-3);
        let _ = observer.update(robot, &[0.1; DOF], &[0.0; DOF], &[0.0; DOF]);
        let seen = observer.update(robot, &[0.1; DOF], &[0.1; DOF], &[0.0; DOF]);
        seen.iter().any(|x: &f64| *x != 0.0)
    }
    assert!(moves(&Arm::new(common::revolute_prismatic())) && moves(&Arm::new(common::prismatic_revolute())));
}

/// With the torques of a tick of computed torque, forward dynamics accelerates the joints as the law of the error says;
/// the observer of the controller sees what an observer alone sees, to the bit.
#[test]
fn a_tick_of_computed_torque_obeys_its_law() {
    let arm = Arm::new(six_joints(Standard));
    let mut numbers = Numbers::new(11);
    let alone = ObserverState::new(20.0, 1e-3);
    let (stiffness, damping) = ([256.0, 100.0, 50.0, 20.0, 10.0, 5.0], [32.0, 20.0, 14.0, 9.0, 6.0, 4.0]);
    let (mut controller, mut observer) = (ComputedTorque { stiffness, damping, observer: alone }, alone);
    let mut tau = [0.0; 6];
    for _ in 0..20 {
        let [q, qd, wanted, rates, accelerations] = std::array::from_fn(|_| numbers.array(1.0));
        let desired = Desired { q: wanted, qd: rates, qdd: accelerations };
        let external = observer.update(&arm, &q, &qd, &tau);
        tau = controller.tick(&arm, &q, &qd, &desired, &tau);
        assert_eq!(controller.observer.external_torques(), &external);
        let qdd = arm.forward_dynamics(&q, &qd, &tau);
        for i in 0..6 {
            let error = [wanted[i] - q[i], rates[i] - qd[i], accelerations[i] - qdd[i]];
            let rest = error[2] + damping[i] * error[1] + stiffness[i] * error[0];
            assert!(rest.abs() < 1e-9 * stiffness[0], "joint {}: {rest:e}", i + 1);
        }
    }
}
