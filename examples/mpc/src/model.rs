//! The robot, and the linear model of one interval.

use rne::{
    AccelerationDerivatives, ForwardDynamics, ForwardDynamicsDerivatives, InverseDynamics, Kinematics,
    MomentumObserver, PayloadDynamics,
};

/// Number of joints.
pub const DOF: usize = 7;

/// One number for each joint.
pub type Joints = [f64; DOF];

/// The Panda arm, one of the robots that rne ships.
#[derive(
    InverseDynamics, ForwardDynamics, ForwardDynamicsDerivatives, Kinematics, MomentumObserver, PayloadDynamics,
)]
#[robot(path = "../../../robots/panda.yaml", form = "reduced")]
pub struct Panda;

/// Positions, rad, and velocities, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Positions.
    pub q: Joints,
    /// Velocities.
    pub qd: Joints,
}

impl State {
    /// The state after an interval with these accelerations, by Euler's semi-implicit method: the new velocities move
    /// the joints.
    #[must_use]
    pub fn after(&self, qdd: &Joints, interval: f64) -> Self {
        let qd = std::array::from_fn(|joint| self.qd[joint] + interval * qdd[joint]);
        Self { q: std::array::from_fn(|joint| self.q[joint] + interval * qd[joint]), qd }
    }
}

/// The method of integration by which a plan goes from one node to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Euler's semi-implicit method: one call of the dynamics for an interval.
    Euler,
    /// The method of Runge and Kutta of the fourth order: four calls of the dynamics for an interval.
    RungeKutta,
}

/// Rows of a matrix with a column for each position, velocity and torque at the beginning of an interval.
pub type Rows = [[f64; 3 * DOF]; DOF];

/// The linear model of an interval: derivatives with respect to positions, velocities and torques at its beginning.
pub enum Interval {
    /// The accelerations and their derivatives.
    Euler(Joints, Box<AccelerationDerivatives<DOF, f64>>),
    /// The state at the end of the interval, and the derivatives of its positions and velocities.
    RungeKutta(State, Box<[Rows; 2]>),
}

impl Interval {
    /// Linearises an interval at a state. The external torques are added to the torques of the actuators.
    #[must_use]
    pub fn new(method: Method, state: &State, tau: &Joints, external: &Joints, interval: f64) -> Self {
        match method {
            Method::Euler => {
                let (qdd, by) = accelerations(state, tau, external);
                Self::Euler(qdd, Box::new(by))
            }
            Method::RungeKutta => runge_kutta(state, tau, external, interval),
        }
    }

    /// Returns the state at the end of the interval.
    #[must_use]
    pub fn end(&self, state: &State, interval: f64) -> State {
        match self {
            Self::Euler(qdd, _) => state.after(qdd, interval),
            Self::RungeKutta(end, _) => *end,
        }
    }
}

/// Integrates an interval by the method of Runge and Kutta and differentiates it by the chain rule. Its four slopes are
/// taken at states x that have the derivatives S. The derivatives of a slope's velocities are the lower rows of S, and
/// those of its accelerations are ∂q̈/∂x S + ∂q̈/∂τ.
fn runge_kutta(start: &State, tau: &Joints, external: &Joints, interval: f64) -> Interval {
    let unit: [Rows; 2] = std::array::from_fn(|part| {
        std::array::from_fn(|row| std::array::from_fn(|column| if column == part * DOF + row { 1.0 } else { 0.0 }))
    });
    let (mut state, mut moved) = (*start, unit);
    let (mut end, mut by) = (*start, Box::new(unit));
    // the fraction of the interval at which the next slope is taken, and the weight of this slope
    for (ahead, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
        let (qdd, of) = accelerations(&state, tau, external);
        let mut slope: Box<[Rows; 2]> = Box::new([moved[1], [[0.0; 3 * DOF]; DOF]]);
        for (row, sum) in slope[1].iter_mut().enumerate() {
            sum[2 * DOF..].copy_from_slice(&of.dtau[row]);
            let [positions, velocities] = &moved;
            for ((by_q, by_qd), (q, qd)) in of.dq[row].iter().zip(&of.dqd[row]).zip(positions.iter().zip(velocities)) {
                for ((sum, q), qd) in sum.iter_mut().zip(q).zip(qd) {
                    *sum += by_q * q + by_qd * qd;
                }
            }
        }
        let plus = |x: &Joints, rate: &Joints, by: f64| -> Joints { std::array::from_fn(|i| x[i] + by * rate[i]) };
        let share = interval * weight / 6.0;
        end = State { q: plus(&end.q, &state.qd, share), qd: plus(&end.qd, &qdd, share) };
        state = State { q: plus(&start.q, &state.qd, interval * ahead), qd: plus(&start.qd, &qdd, interval * ahead) };
        for part in 0..2 {
            for (row, slope) in slope[part].iter().enumerate() {
                for (column, slope) in slope.iter().enumerate() {
                    by[part][row][column] += share * slope;
                    moved[part][row][column] = unit[part][row][column] + interval * ahead * slope;
                }
            }
        }
    }
    Interval::RungeKutta(end, by)
}

/// Returns the accelerations of the arm and their derivatives. The external torques are added to the torques of the
/// actuators.
#[must_use]
pub fn accelerations(state: &State, tau: &Joints, external: &Joints) -> (Joints, AccelerationDerivatives<DOF, f64>) {
    let tau = std::array::from_fn(|joint| tau[joint] + external[joint]);
    let qdd = Panda.forward_dynamics(&state.q, &state.qd, &tau);
    (qdd, Panda.forward_dynamics_derivatives(&state.q, &state.qd, &tau))
}

/// Returns the position of the tip in the world, m, and the linear rows of its Jacobian.
#[must_use]
pub fn tip(q: &Joints) -> ([f64; 3], [[f64; DOF]; 3]) {
    let [x, y, z, ..] = Panda.jacobian(q);
    (Panda.forward_kinematics(q).translation, [x, y, z])
}
