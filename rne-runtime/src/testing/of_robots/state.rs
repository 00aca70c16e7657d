//! States at which tests compare: the same ones in each run.

use core::{array, fmt};

use rne_model::Robot;

use super::random::{JOINTS, Random};
use crate::{BaseMotion, BaseTwist, DynArm, Inputs, Payload, Pose, Quaternion, Wrench};

/// Number of states to try.
const STATES: u64 = 48;
/// The duration of a step, s.
const STEP: f64 = 0.5;

/// A state of a robot, and what acts on it.
pub(super) struct State {
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    pub(super) qdd: Vec<f64>,
    pub(super) tau: Vec<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    passive: Vec<f64>,
    wrenches: Vec<Wrench<f64>>,
    payload: Payload<f64>,
    base: BaseMotion<f64>,
    twist: BaseTwist<f64>,
    pose: Pose<f64>,
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { q, qd, qdd, tau, .. } = self;
        write!(f, "  q   = {q:?}\n  qd  = {qd:?}\n  qdd = {qdd:?}\n  tau = {tau:?}")
    }
}

/// The states of a robot. Those whose positions do not let the loops close are left out.
pub(super) fn states(robot: &Robot, arm: &DynArm) -> impl Iterator<Item = State> {
    (0..STATES).filter_map(|index| State::of(robot, arm, index, |number| number))
}

/// Each state, and the same one where each number is another by about this part of it.
pub(super) fn moved_states<const PART: u64>(robot: &Robot, arm: &DynArm) -> impl Iterator<Item = [State; 2]> {
    (0..STATES).filter_map(|index| {
        let changes = Random::new(index, |number| number);
        let moved = move |number: f64| number * (1.0 + changes.number(1.0) / (PART as f64));
        Some([State::of(robot, arm, index, |number| number)?, State::of(robot, arm, index, moved)?])
    })
}

impl State {
    fn of(robot: &Robot, arm: &DynArm, index: u64, moved: impl Fn(f64) -> f64) -> Option<Self> {
        let random = Random::new(0x5EED + index, |number| number);
        let number = |limit: f64| moved(random.number(limit));
        let list = |limit: f64| (0..arm.dof() - arm.passive_joints()).map(|_| number(limit)).collect::<Vec<_>>();
        let three = |limit: f64| array::from_fn(|_| number(limit));
        let [mut q, qd, qdd, tau] = JOINTS.map(list);
        let passive = closed(robot, arm, &mut q)?;
        let (sin, cos) = q.iter().map(|q| q.sin_cos()).unzip();
        let wrenches = arm.tips().iter().map(|_| Wrench { force: three(10.0), moment: three(10.0) }).collect();
        let turn = [0.5, -0.1, 0.7, 0.4].map(&moved);
        let length = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turned = Quaternion::from_wxyz(turn.map(|x| x / length)).rotation();
        Some(Self {
            sin,
            cos,
            passive,
            wrenches,
            payload: Payload { mass: moved(1.5 + random.number(1.0)), com: three(0.1), ..Payload::default() },
            base: BaseMotion {
                omega: three(1.0),
                omega_dot: three(2.0),
                velocity: three(1.0),
                acceleration: three(5.0),
                gravity: three(10.0),
            },
            twist: BaseTwist { linear: three(1.0), angular: three(1.0) },
            pose: Pose { rotation: turned, translation: three(1.0) },
            q,
            qd,
            qdd,
            tau,
        })
    }

    /// Positions, velocities, accelerations and torques.
    pub(super) fn motion<const DOF: usize>(&self) -> [[f64; DOF]; 4] {
        [&self.q, &self.qd, &self.qdd, &self.tau].map(|numbers| array::from_fn(|joint| numbers[joint]))
    }

    /// The arguments of every function.
    pub(super) fn inputs(&self) -> Inputs<'_, f64> {
        let Self { q, qd, qdd, tau, sin, cos, passive, wrenches, payload, base, twist, pose } = self;
        Inputs {
            q,
            qd,
            qdd,
            tau,
            sin,
            cos,
            passive,
            multipliers: tau,
            wrench: &wrenches[0],
            wrenches,
            payload,
            base,
            omega: &twist.angular,
            twist,
            pose,
            base_rotation: &pose.rotation,
            step: STEP,
        }
    }
}

/// The positions of the dependent joints that close the loops at positions near those of the robot file; the other
/// joints are moved there. `None` where they stay open.
fn closed(robot: &Robot, arm: &DynArm, q: &mut [f64]) -> Option<Vec<f64>> {
    /// How far the other joints are from the configuration of the file, of the largest positions.
    const PART: f64 = 0.05;
    const STEPS: usize = 20;
    /// The largest residual, m or a product of axes.
    const CLOSED: f64 = 1e-13;
    let Some(closure) = robot.closed.closures.first() else { return Some(Vec::new()) };
    for (q, at) in q.iter_mut().zip(robot.coordinates()) {
        *q = closure[at] + *q * PART;
    }
    let mut passive: Vec<f64> = robot.closed.passive.iter().map(|&at| closure[at]).collect();
    for _ in 0..STEPS {
        passive = arm.closure_step(q, &passive).ok()?.passive;
    }
    let step = arm.closure_step(q, &passive).ok()?;
    step.residual.iter().all(|left| left.abs() < CLOSED).then_some(passive)
}
