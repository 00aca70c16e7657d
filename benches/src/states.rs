//! States of motion.

use rne::Scalar;

/// Positions, velocities and accelerations of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const DOF: usize, T = f64> {
    /// Positions, rad.
    pub q: [T; DOF],
    /// Velocities, rad/s.
    pub qd: [T; DOF],
    /// Accelerations, rad/s².
    pub qdd: [T; DOF],
}

/// 64 random states, always the same: they fit into the first cache with room for the code's constants.
pub fn states<const DOF: usize, T: Scalar>() -> [State<DOF, T>; 64] {
    let mut numbers = fastrand::Rng::with_seed(560);
    let mut array = |range: f64| std::array::from_fn(|_| T::from_f64((2.0 * numbers.f64() - 1.0) * range));
    std::array::from_fn(|_| State { q: array(3.0), qd: array(2.0), qdd: array(5.0) })
}
