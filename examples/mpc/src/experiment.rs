//! The closed loop: two goals, one after the other, with a load that the controller does not know.

use fastrand::Rng;
use rne::{InverseDynamics, ObserverState, Payload};

use crate::controller::{Controller, Spent, Task, Weights};
use crate::model::{DOF, Interval, Joints, Method, Panda, State, tip};
use crate::plant::Plant;

/// Length of an interval and of a sample, s.
pub const INTERVAL: f64 = 0.02;
/// Speed at which the goal of the plan moves to the next goal, m/s: one iteration a sample cannot follow a jump.
const SPEED: f64 = 1.0;
/// Samples for each goal.
pub const SAMPLES: usize = 100;
/// Points to reach in the world, m.
pub const GOALS: [[f64; 3]; 2] = [[0.35, 0.45, 0.3], [0.45, -0.4, 0.7]];
/// The load, kg.
pub const LOAD: f64 = 0.5;

const WEIGHTS: Weights = Weights { tip: 300.0, last: 10.0, posture: 0.05, velocity: 0.2, torque: 1e-3 };

/// One sample of the closed loop.
pub struct Sample {
    /// Time at its end, s.
    pub time: f64,
    /// True state at its end.
    pub state: State,
    /// Torques during it, N m.
    pub tau: Joints,
    /// The tip, m, and its distance from the goal.
    pub tip: [f64; 3],
    /// Distance of the tip from the goal, m.
    pub off: f64,
    /// What the controller took.
    pub spent: Spent,
    /// The state that was measured at its begin.
    pub measured: State,
    /// The external torques at its begin, N m.
    pub external: Joints,
    /// The goal of the plan, m.
    pub reference: [f64; 3],
}

/// How far positions (rad), velocities (rad/s) and torques (N m) were beyond their limits at most.
#[must_use]
pub fn beyond(samples: &[Sample]) -> [f64; 3] {
    let mut most = [0.0_f64; 3];
    for Sample { state: State { q, qd }, tau, .. } in samples {
        for joint in 0..DOF {
            let (lower, upper) = Panda::POSITION_LIMITS[joint];
            most[0] = most[0].max(q[joint] - upper).max(lower - q[joint]);
            most[1] = most[1].max(qd[joint].abs() - Panda::VELOCITY_LIMITS[joint]);
            most[2] = most[2].max(tau[joint].abs() - Panda::EFFORT_LIMITS[joint]);
        }
    }
    most
}

/// Runs the closed loop with a controller that plans by a method.
#[must_use]
pub fn run(method: Method) -> Vec<Sample> {
    let start = State { q: [0.0, -0.4, 0.0, -2.0, 0.0, 1.7, 0.8], qd: [0.0; DOF] };
    let payload = Payload { mass: LOAD, com: [0.0, 0.0, 0.05], ..Payload::default() };
    let mut plant = Plant { state: start, payload, noise: [1e-4, 5e-3], random: Rng::with_seed(1) };
    let mut controller = Controller::new(method, &start);
    // a slow one: the load's inertia is an external torque, too, and it answers to the accelerations of the plan
    let mut observer = ObserverState::new(1.0, INTERVAL);
    let mut tau = Panda.gravity_torques(&start.q);
    let mut reference = tip(&start.q).0;
    let mut samples = Vec::new();
    for goal in GOALS {
        for _ in 0..SAMPLES {
            let now = plant.measured();
            let external = observer.update(&Panda, &now.q, &now.qd, &tau);
            reference = towards(&reference, &goal, SPEED * INTERVAL);
            let task = Task { now, goal: reference, posture: start.q, interval: INTERVAL, external, weights: WEIGHTS };
            let (torques, spent) = controller.step(&task);
            tau = torques;
            plant.advance(&tau, INTERVAL);
            let (place, _) = tip(&plant.state.q);
            let off = place.iter().zip(goal).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
            let time = samples.last().map_or(0.0, |last: &Sample| last.time) + INTERVAL;
            let state = plant.state;
            samples.push(Sample { time, state, tau, tip: place, off, spent, measured: now, external, reference });
        }
    }
    samples
}

/// How far the end of an interval is from that of 20 short ones at most, at the states of a motion: rad.
#[must_use]
pub fn model_error(method: Method, samples: &[Sample]) -> f64 {
    let end = |method, state: &State, tau: &Joints, length| {
        Interval::new(method, state, tau, &[0.0; DOF], length).end(state, length)
    };
    let mut most = 0.0_f64;
    for Sample { state, tau, .. } in samples {
        let exact = (0..20).fold(*state, |state, _| end(Method::RungeKutta, &state, tau, INTERVAL / 20.0));
        let found = end(method, state, tau, INTERVAL);
        most = found.q.iter().zip(exact.q).fold(most, |most, (a, b)| most.max((a - b).abs()));
    }
    most
}

/// The point on the way to a goal that is a stride away.
fn towards(from: &[f64; 3], goal: &[f64; 3], stride: f64) -> [f64; 3] {
    let way: [f64; 3] = std::array::from_fn(|axis| goal[axis] - from[axis]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    let part = if length > stride { stride / length } else { 1.0 };
    std::array::from_fn(|axis| from[axis] + part * way[axis])
}
