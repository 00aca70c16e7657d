//! The tip and the torques of gravity where all joints are at zero, for comparison with a drawing or another tool.

use std::fmt::Write as _;

use rne::DynArm;
use rne_model::{JointKind, Robot};

use crate::palette::QUIET;
use crate::values::numbers::rounded;

/// Returns the lines for a robot with a fixed base and without closed loops; other robots need more than joints at
/// zero.
pub(super) fn lines(robot: &Robot) -> String {
    let (arm, q) = (DynArm::from_robot(robot), vec![0.0; robot.dof()]);
    let mut text = String::new();
    if robot.floating_base.is_some() || !robot.closed.is_empty() {
        return text;
    }
    // what rounding leaves of a zero is shown as zero
    let list = |values: &[f64], digits: usize| {
        let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let shown = values.iter().map(|&value| if value.abs() < 1e-9 * largest { 0.0 } else { value });
        shown.map(|value| rounded(value, digits)).collect::<Vec<_>>().join(", ")
    };
    if let (Ok(pose), true) = (arm.forward_kinematics(&q), robot.is_serial()) {
        let [x, z] = [0, 2].map(|axis| pose.rotation.map(|row| row[axis]));
        let _ = writeln!(
            text,
            "  {QUIET}at q = 0{QUIET:#}  tip at [{}] m, its x axis along [{}], its z axis along [{}]",
            list(&pose.translation, 4),
            list(&x, 3),
            list(&z, 3)
        );
    }
    if let Ok(torques) = arm.gravity_torques(&q) {
        let are_all = |kind| (0..torques.len()).all(|joint| robot.coordinate_kind(joint) == kind);
        let unit = match [JointKind::Revolute, JointKind::Prismatic].into_iter().find(|kind| are_all(*kind)) {
            Some(kind) => format!(" {}", kind.effort_unit()),
            None => ", N m for revolute joints, N for prismatic joints".to_owned(),
        };
        let _ = writeln!(text, "  {QUIET}at q = 0{QUIET:#}  gravity torques [{}]{unit}", list(&torques, 4));
    }
    text
}
