//! Motion of the base that carries the arm, and the direction of gravity in its axes.

use crate::Scalar;

/// Motion of the base, the "link 0" from which the forward recursion starts. Every vector is in the axes of frame 0.
///
/// For an arm bolted to the floor everything but gravity is zero: [`BaseMotion::fixed`]. On a ship, a vehicle or
/// another robot, frame 0 moves; when it tilts, gravity turns in its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseMotion<T> {
    /// Angular velocity ω₀, rad/s.
    pub omega: [T; 3],
    /// Angular acceleration ω̇₀, rad/s².
    pub omega_dot: [T; 3],
    /// Velocity ċ₀ of the origin of frame 0, m/s. No torque depends on it; the velocities of a trace do.
    pub velocity: [T; 3],
    /// Acceleration c̈₀ of the origin of frame 0, m/s², gravity not included.
    pub acceleration: [T; 3],
    /// Acceleration of gravity g₀, m/s². It points down: (0, 0, -9.81) where z points up.
    pub gravity: [T; 3],
}

/// A base at rest without gravity: all numbers are zero.
impl<T: Scalar> Default for BaseMotion<T> {
    fn default() -> Self {
        Self::fixed([T::zero(); 3])
    }
}

impl<T: Scalar> BaseMotion<T> {
    /// A base at rest under `gravity` (m/s², pointing down, in the axes of frame 0).
    #[must_use]
    pub fn fixed(gravity: [T; 3]) -> Self {
        let zero = [T::zero(); 3];
        Self { omega: zero, omega_dot: zero, velocity: zero, acceleration: zero, gravity }
    }
}
