//! The generic recursion over a table in the image, with which the generated code is compared.

use rne::{Arm, InverseDynamics};

use table::PUMA560;

/// The table, which the build script writes.
#[allow(clippy::enum_glob_use, clippy::unreadable_literal)]
mod table {
    use rne::model::Convention::*;
    use rne::model::JointKind::*;
    use rne::model::QuarterTurns::*;
    use rne::model::{Angle, Dh, Inertia, Link, Model, Row, Transform};

    include!(concat!(env!("OUT_DIR"), "/puma560.rs"));
}

/// Returns the PUMA 560 as an arm whose functions loop over its links.
#[must_use]
pub fn arm() -> Arm<6, f32> {
    Arm::new(PUMA560)
}

/// Computes the torques for positions, velocities and accelerations.
#[inline(never)]
#[must_use]
pub fn inverse_dynamics(arm: &Arm<6, f32>, q: &[f32; 6], qd: &[f32; 6], qdd: &[f32; 6]) -> [f32; 6] {
    arm.inverse_dynamics(q, qd, qdd)
}
