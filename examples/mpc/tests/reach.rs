//! The closed loop reaches its goals within the limits, and its model is that of the arm.

use mpc::experiment::{INTERVAL, SAMPLES, Sample, beyond, model_error, run};
use mpc::model::{DOF, Interval, Joints, Method, State, accelerations};

#[test]
fn goals_are_reached_within_the_limits() {
    for method in [Method::Euler, Method::RungeKutta] {
        is_reached(&run(method));
    }
}

fn is_reached(samples: &[Sample]) {
    for samples in samples.chunks(SAMPLES) {
        // a load of 0.5 kg without the observer's torques leaves centimetres
        assert!(samples[SAMPLES - 1].off < 2e-3, "{} m", samples[SAMPLES - 1].off);
        assert!(samples[SAMPLES / 2].off < 0.1, "{} m", samples[SAMPLES / 2].off);
    }
    let [position, velocity, torque] = beyond(samples);
    assert!(position == 0.0 && velocity < 0.1 && torque == 0.0, "{position} rad, {velocity} rad/s, {torque} N m");
}

/// The linear model of an interval beside differences of the interval itself.
#[test]
fn the_linear_model_is_that_of_an_interval() {
    let state = State { q: [0.3, -0.5, 0.2, -1.9, 0.4, 1.5, 0.7], qd: [0.5, -0.4, 0.3, 0.6, -0.2, 0.8, -0.7] };
    let (tau, external): (Joints, Joints) = ([10.0, -20.0, 5.0, 12.0, 1.0, 2.0, -0.5], [1.0; DOF]);
    let (_, by) = accelerations(&state, &tau, &external);
    let step = 1e-6;
    for at in 0..DOF {
        // differences by position, velocity and torque
        let differences: [Joints; 3] = std::array::from_fn(|part| {
            let [ahead, behind] = [step, -step].map(|by| {
                let (mut moved, mut pushed) = (state, tau);
                [&mut moved.q, &mut moved.qd, &mut pushed][part][at] += by;
                accelerations(&moved, &pushed, &external).0
            });
            std::array::from_fn(|joint| (ahead[joint] - behind[joint]) / (2.0 * step))
        });
        let found = [&by.dq, &by.dqd, &by.dtau].into_iter().zip(differences);
        for (matrix, column) in found {
            let largest = matrix.as_flattened().iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for joint in 0..DOF {
                assert!((matrix[joint][at] - column[joint]).abs() < 1e-6 * largest, "{joint}, {at}");
            }
        }
    }
}

/// The chain rule over four slopes beside differences of the interval, and the order of the method: the error of half
/// an interval is a 32nd.
#[test]
fn an_interval_of_runge_and_kutta_has_its_derivatives() {
    let state = State { q: [0.3, -0.5, 0.2, -1.9, 0.4, 1.5, 0.7], qd: [0.5, -0.4, 0.3, 0.6, -0.2, 0.8, -0.7] };
    let (tau, external): (Joints, Joints) = ([10.0, -20.0, 5.0, 12.0, 1.0, 2.0, -0.5], [1.0; DOF]);
    let model =
        |state: &State, tau: &Joints, interval| Interval::new(Method::RungeKutta, state, tau, &external, interval);
    let Interval::RungeKutta(_, by) = model(&state, &tau, INTERVAL) else { panic!("another method") };
    let step = 1e-6;
    for column in 0..3 * DOF {
        let [ahead, behind] = [step, -step].map(|by| {
            let (mut moved, mut pushed) = (state, tau);
            [&mut moved.q, &mut moved.qd, &mut pushed][column / DOF][column % DOF] += by;
            model(&moved, &pushed, INTERVAL).end(&moved, INTERVAL)
        });
        for joint in 0..DOF {
            let differences = [ahead.q[joint] - behind.q[joint], ahead.qd[joint] - behind.qd[joint]];
            for (rows, difference) in by.iter().zip(differences) {
                let (found, expected) = (rows[joint][column], difference / (2.0 * step));
                assert!((found - expected).abs() < 1e-7, "{joint}, {column}: {found} is not {expected}");
            }
        }
    }
    let exact = |length: f64| {
        let short = length / 64.0;
        (0..64).fold(state, |state, _| model(&state, &tau, short).end(&state, short))
    };
    let error = |length: f64| (model(&state, &tau, length).end(&state, length).qd[3] - exact(length).qd[3]).abs();
    let ratio = error(0.04) / error(0.02);
    assert!((24.0..40.0).contains(&ratio), "{ratio}");
}

#[test]
fn the_error_of_runge_and_kutta_is_far_smaller() {
    let samples = run(Method::Euler);
    let [euler, runge_kutta] = [Method::Euler, Method::RungeKutta].map(|method| model_error(method, &samples));
    assert!(runge_kutta < 1e-2 * euler, "{runge_kutta} rad, {euler} rad");
}
