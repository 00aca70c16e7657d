//! The joints of a log that are those of a robot.

use std::path::PathBuf;

use rne_logs::{Dimension, JointUnits, Layout, Log, Options, Quantity};
use rne_model::{JointKind, Robot};

use crate::arm_log::error::{ArmLogError, Mismatch};
use crate::arm_log::remark::ArmLogRemark;

/// Completes the options of a log by what the robot says: the names of its joints in the log, and which of them slide.
///
/// Names that the options have are kept. Else the joints of the log are taken by the robot's names, where the log has
/// all of them; a log with other names and as many joints is taken in its order, with a remark.
///
/// # Errors
/// When the log cannot be opened, or its joints cannot be told to be those of the robot.
pub fn joint_options(
    paths: &[PathBuf],
    robot: &Robot,
    mut options: Options,
) -> Result<(Options, Option<ArmLogRemark>), ArmLogError> {
    options.slides = slides(robot);
    let joints: Vec<String> = robot.joints.iter().map(|joint| joint.name.clone()).collect();
    let unnamed = || Log::open(paths, Options { joints: None, torque_constants: Vec::new(), ..options.clone() });
    let Some(names) = &options.joints else {
        let log = unnamed().map_err(|error| ArmLogError::Log { error, joints: joints.clone() })?;
        let (names, remark) = matched(joints, &log.layout().joints)?;
        options.joints = Some(names);
        return Ok((options, remark));
    };
    // an empty name is refused with those that there are
    if names.len() != joints.len() && names.iter().all(|name| !name.trim().is_empty()) {
        let logged = unnamed().map(|log| log.layout().joints.clone()).unwrap_or_default();
        return Err(ArmLogError::NamedJoints { named: names.len(), logged, joints });
    }
    Ok((options, None))
}

/// Whether each joint is prismatic: no option converts its lengths into angles.
fn slides(robot: &Robot) -> Vec<bool> {
    robot.joints.iter().map(|joint| joint.row.kind == JointKind::Prismatic).collect()
}

/// The joints of the log that are those of the robot, base to tip.
fn matched(joints: Vec<String>, logged: &[String]) -> Result<(Vec<String>, Option<ArmLogRemark>), ArmLogError> {
    if joints.iter().all(|name| logged.contains(name)) {
        return Ok((joints, None));
    }
    // some names are those of the robot, and say another order
    let is_elsewhere = |(at, name): &(usize, &String)| logged.contains(name) && logged[*at] != **name;
    let mismatch = if logged.len() < joints.len() {
        Mismatch::Fewer
    } else if logged.len() > joints.len() {
        Mismatch::More
    } else if let Some((_, joint)) = joints.iter().enumerate().find(is_elsewhere) {
        Mismatch::Order { joint: joint.clone() }
    } else {
        return Ok((logged.to_vec(), Some(ArmLogRemark::MatchedByOrder { logged: logged.to_vec(), joints })));
    };
    Err(ArmLogError::Unmatched { logged: logged.to_vec(), joints, mismatch })
}

/// Checks that the units that names of columns say are those of the robot's joints: a joint that turns has no position
/// in mm.
///
/// # Errors
/// When they are those of another kind of joint.
pub fn check_units(robot: &Robot, layout: &Layout) -> Result<(), ArmLogError> {
    for ((joint, logged), units) in robot.joints.iter().zip(&layout.joints).zip(&layout.units) {
        let JointUnits { position, velocity, effort, .. } = *units;
        let kind = joint.row.kind;
        let (motion, force) = match kind {
            JointKind::Revolute => (Dimension::Angle, Dimension::Torque),
            JointKind::Prismatic => (Dimension::Length, Dimension::Force),
        };
        let is_other =
            |said: Option<Dimension>, own| said.is_some_and(|said| said != own && said != Dimension::Current);
        let quantity = if is_other(position, motion) {
            Quantity::Position
        } else if is_other(velocity, motion) {
            Quantity::Velocity
        } else if is_other(effort, force) {
            Quantity::Effort
        } else {
            continue;
        };
        return Err(ArmLogError::Kind { joint: joint.name.clone(), logged: logged.clone(), kind, quantity });
    }
    Ok(())
}
