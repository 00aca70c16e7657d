//! The closed loop: two goals, one after the other, with a load that the controller does not know.

use fastrand::Rng;
use rne::{InverseDynamics, ObserverState, Payload};

use crate::controller::{Controller, Spent, Task, Weights};
use crate::model::{DOF, Interval, Joints, Method, Panda, State, tip};
use crate::plant::Plant;

/// Length of an interval and of a sample, s.
pub const INTERVAL: f64 = 0.02;
/// Speed at which the goal of the plan moves to the next goal, m/s. With one iteration per sample, the plan cannot
/// follow a jump.
const SPEED: f64 = 1.0;
/// Number of samples for each goal.
pub const SAMPLES: usize = 100;
/// The points that the tip must reach, in the world, m.
pub const GOALS: [[f64; 3]; 2] = [[0.35, 0.45, 0.3], [0.45, -0.4, 0.7]];
/// Mass of the load, kg.
pub const LOAD: f64 = 0.5;

const WEIGHTS: Weights = Weights { tip: 300.0, last: 10.0, posture: 0.05, velocity: 0.2, torque: 1e-3 };

/// One sample of the closed loop.
pub struct Sample {
    /// Time at the end of the sample, s.
    pub time: f64,
    /// True state at the end of the sample.
    pub state: State,
    /// Torques of the actuators during the sample, N m.
    pub tau: Joints,
    /// Position of the tip in the world, m.
    pub tip: [f64; 3],
    /// Distance of the tip from the goal, m.
    pub off: f64,
    /// Time and iterations that the controller needed.
    pub spent: Spent,
    /// The state that was measured at the beginning of the sample.
    pub measured: State,
    /// The external torques at the beginning of the sample, N m.
    pub external: Joints,
    /// The goal of the plan, m.
    pub reference: [f64; 3],
}

/// Returns the largest violations of the limits of positions (rad), velocities (rad/s) and torques (N m).
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
    // a low gain, because the accelerations of the plan act on the load, and its inertia appears as an external torque
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

/// Returns the largest error of the position after an interval, rad, at the states of a motion. The reference is the
/// end of 20 short intervals.
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

/// Returns the point at distance `stride` from `from` on the straight line to a goal, or the goal if it is nearer.
fn towards(from: &[f64; 3], goal: &[f64; 3], stride: f64) -> [f64; 3] {
    let way: [f64; 3] = std::array::from_fn(|axis| goal[axis] - from[axis]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    let part = if length > stride { stride / length } else { 1.0 };
    std::array::from_fn(|axis| from[axis] + part * way[axis])
}
