//! Random states of a robot with a floating base, in the vectors of each program.

use dynibo::{BaseState, Frame, Twist};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use rne::{BaseMotion, Pose};

/// Gravity of dynibo, which cannot be set, m/s².
pub const GRAVITY: f64 = 9.80665;

/// A state of `DOF` joints and of the base. Torques are of joints; nothing acts on the base.
pub struct State<const DOF: usize> {
    pub q: [f64; DOF],
    pub qd: [f64; DOF],
    pub qdd: [f64; DOF],
    pub tau: [f64; DOF],
    /// Axes of the base in the world, and its motion.
    pub pose: Pose<f64>,
    pub base: BaseMotion<f64>,
    /// That of the base in Pinocchio's vectors: q (7), v (6), a (6).
    pub pinocchio: ([f64; 7], [f64; 6], [f64; 6]),
    pub dynibo: BaseState,
}

impl<const DOF: usize> State<DOF> {
    pub fn random(random: &mut fastrand::Rng) -> Self {
        let mut within = |most: f64| most * (2.0 * random.f64() - 1.0);
        let mut joints = |most: f64| [(); DOF].map(|()| within(most));
        let (q, qd, qdd, tau) = (joints(1.0), joints(2.0), joints(5.0), joints(20.0));
        let mut vector = || [(); 3].map(|()| within(1.0));
        let (position, velocity, omega, omega_dot, acceleration, [x, y, z]) =
            (vector(), vector(), vector(), vector(), vector(), vector());
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(within(1.0), x, y, z));
        let [x, y, z, w]: [f64; 4] = turn.coords.into();
        let [a, b, c] = position;
        let pose = Pose::from_pinocchio(&[a, b, c, x, y, z, w]);
        let gravity = turn.inverse() * Vector3::new(0.0, 0.0, -GRAVITY);
        let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity: gravity.into() };
        let [u, v, p] = velocity;
        let [r, s, t] = omega;
        let pinocchio = (pose.to_pinocchio(), [u, v, p, r, s, t], base.to_pinocchio());
        let world = |vector: [f64; 3]| turn * Vector3::from(vector);
        let twist = |angular, linear| Twist::new(world(angular), world(linear));
        let frame: Frame = Isometry3::from_parts(Translation3::from(position), turn);
        let dynibo = BaseState::new(frame, twist(omega, velocity), twist(omega_dot, acceleration));
        let dynibo = dynibo.unwrap_or_else(|error| panic!("{error}"));
        Self { q, qd, qdd, tau, pose, base, pinocchio, dynibo }
    }

    /// A vector in world axes, in those of the base.
    pub fn in_base(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.pose.rotation;
        [0, 1, 2].map(|i| a[i] * x + b[i] * y + c[i] * z)
    }
}
