//! States at which the tests compare functions. They are the same in each run.

use core::{array, fmt};

use rne_model::Robot;

use super::random::{JOINTS, Random};
use crate::{BaseMotion, BaseTwist, DynArm, Inputs, Payload, Pose, Quaternion, Scalar, Wrench};

/// Number of states.
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

/// Returns the states of a robot. States in which the loops cannot be closed are left out.
pub(super) fn states(robot: &Robot, arm: &DynArm) -> impl Iterator<Item = State> {
    (0..STATES).filter_map(|index| State::of(robot, arm, index))
}

impl State {
    fn of(robot: &Robot, arm: &DynArm, index: u64) -> Option<Self> {
        let random = Random::new(0x5EED + index, |number| number);
        let list = |limit: f64| (0..arm.dof() - arm.passive_joints()).map(|_| random.number(limit)).collect::<Vec<_>>();
        let [mut q, qd, qdd, tau] = JOINTS.map(list);
        let passive = closed(robot, arm, &mut q)?;
        let (sin, cos) = q.iter().map(|&q| Scalar::sin_cos(q)).unzip();
        let wrenches = arm.tips().iter().map(|_| random.wrench()).collect();
        let turned = Quaternion::from_wxyz([0.5, -0.1, 0.7, 0.5]).rotation();
        Some(Self {
            q,
            qd,
            qdd,
            tau,
            sin,
            cos,
            passive,
            wrenches,
            payload: random.payload(),
            base: BaseMotion { velocity: random.array(1.0), ..random.base() },
            twist: BaseTwist { linear: random.array(1.0), angular: random.array(1.0) },
            pose: Pose { rotation: turned, translation: random.array(1.0) },
        })
    }

    /// Returns the state with each number changed by `by`.
    pub(super) fn changed(&self, by: impl Fn(f64) -> f64) -> Self {
        let list = |numbers: &[f64]| numbers.iter().map(|&number| by(number)).collect::<Vec<_>>();
        let three = |numbers: [f64; 3]| numbers.map(&by);
        let BaseMotion { omega, omega_dot, velocity, acceleration, gravity } = self.base;
        let Pose { rotation, translation } = self.pose;
        Self {
            q: list(&self.q),
            qd: list(&self.qd),
            qdd: list(&self.qdd),
            tau: list(&self.tau),
            sin: list(&self.sin),
            cos: list(&self.cos),
            passive: list(&self.passive),
            wrenches: (self.wrenches.iter())
                .map(|wrench| Wrench { force: three(wrench.force), moment: three(wrench.moment) })
                .collect(),
            payload: Payload::from_array(self.payload.to_array().map(&by)),
            base: BaseMotion {
                omega: three(omega),
                omega_dot: three(omega_dot),
                velocity: three(velocity),
                acceleration: three(acceleration),
                gravity: three(gravity),
            },
            twist: BaseTwist { linear: three(self.twist.linear), angular: three(self.twist.angular) },
            pose: Pose { rotation: rotation.map(three), translation: three(translation) },
        }
    }

    /// Returns positions, velocities, accelerations and torques as arrays.
    pub(super) fn motion<const DOF: usize>(&self) -> [[f64; DOF]; 4] {
        [&self.q, &self.qd, &self.qdd, &self.tau].map(|numbers| array::from_fn(|joint| numbers[joint]))
    }

    /// Returns the arguments of every function in this state.
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

/// Returns the positions of the dependent joints that close the loops. The other joints `q` are moved to positions near
/// those of the robot file. `None` if the loops stay open.
fn closed(robot: &Robot, arm: &DynArm, q: &mut [f64]) -> Option<Vec<f64>> {
    /// The distance of the other joints from their positions in the file, as a fraction of the random positions.
    const PART: f64 = 0.05;
    const STEPS: usize = 20;
    /// The largest residual of closed loops: a distance in m, or a product of axes.
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
