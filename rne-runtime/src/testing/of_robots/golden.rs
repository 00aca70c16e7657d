//! Compares torques with a golden file, whose torques somebody else has computed or measured.

use core::fmt::Write as _;

use super::comparison::largest;
use crate::InverseDynamics;

/// A line of a golden file.
#[derive(Clone, Copy, Debug)]
pub struct GoldenState<const DOF: usize> {
    /// The number of the line, from 1.
    pub line: usize,
    /// Positions, rad or m.
    pub q: [f64; DOF],
    /// Velocities, rad/s or m/s.
    pub qd: [f64; DOF],
    /// Accelerations, rad/s² or m/s².
    pub qdd: [f64; DOF],
    /// Torques, N m or N.
    pub tau: [f64; DOF],
}

/// Compares the torques of every line, with an error relative to the largest torque of the file. The panic names all
/// wrong torques, with line and joint.
pub fn torques_are_those_of_the_golden_file<const DOF: usize, R: InverseDynamics<DOF>>(
    robot: &R,
    file: &str,
    joints: &[&str; DOF],
    tolerance: f64,
    states: &[GoldenState<DOF>],
) {
    let scale = largest(states.iter().flat_map(|state| &state.tau));
    let mut wrong = String::new();
    for GoldenState { line, q, qd, qdd, tau } in states {
        let found = robot.inverse_dynamics(q, qd, qdd);
        for ((joint, found), expected) in joints.iter().zip(found).zip(tau) {
            // false for NaN
            let is_met = (found - expected).abs() <= tolerance * scale;
            if !is_met {
                let _ = writeln!(wrong, "{file}:{line}: the torque of {joint} is {found:e}, not {expected:e}");
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}(allowed: {tolerance:e} of the largest torque of the file, {scale:e})");
}
