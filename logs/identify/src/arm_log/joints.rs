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
    let joints: Vec<String> = robot.independent_joints().map(|joint| joint.name.clone()).collect();
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
    robot.independent_joints().map(|joint| joint.row.kind == JointKind::Prismatic).collect()
}

/// The joints of the log that are those of the robot, base to tip.
fn matched(joints: Vec<String>, logged: &[String]) -> Result<(Vec<String>, Option<ArmLogRemark>), ArmLogError> {
    match match_joints(&joints, logged) {
        Ok(JointMatch::ByName) => Ok((joints, None)),
        Ok(JointMatch::ByOrder) => {
            Ok((logged.to_vec(), Some(ArmLogRemark::MatchedByOrder { logged: logged.to_vec(), joints })))
        }
        Err(mismatch) => Err(ArmLogError::Unmatched { logged: logged.to_vec(), joints, mismatch }),
    }
}

/// How the joints of measurements are matched with those of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointMatch {
    /// The measurements have all names of the robot's joints, in any order and among others.
    ByName,
    /// The measurements have other names and as many joints: the joints are taken in the order of the measurements.
    ByOrder,
}

/// Matches the joints of measurements, by their names, with the joints of a robot, base to tip: the one rule for logs
/// and for messages.
///
/// # Errors
/// When the joints cannot be matched.
pub fn match_joints(joints: &[String], measured: &[String]) -> Result<JointMatch, Mismatch> {
    if joints.iter().all(|name| measured.contains(name)) {
        return Ok(JointMatch::ByName);
    }
    // some names are those of the robot, and say another order
    let is_elsewhere = |(at, name): &(usize, &String)| measured.contains(name) && measured[*at] != **name;
    if measured.len() < joints.len() {
        Err(Mismatch::Fewer)
    } else if measured.len() > joints.len() {
        Err(Mismatch::More)
    } else if let Some((_, joint)) = joints.iter().enumerate().find(is_elsewhere) {
        Err(Mismatch::Order { joint: joint.clone() })
    } else {
        Ok(JointMatch::ByOrder)
    }
}

/// Checks that the units that names of columns say are those of the robot's joints: a joint that turns has no position
/// in mm.
///
/// # Errors
/// When they are those of another kind of joint.
pub fn check_units(robot: &Robot, layout: &Layout) -> Result<(), ArmLogError> {
    for ((joint, logged), units) in robot.independent_joints().zip(&layout.joints).zip(&layout.units) {
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
