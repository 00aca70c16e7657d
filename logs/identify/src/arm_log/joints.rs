//! Finds the joints of a robot in a log.

use std::path::PathBuf;

use rne_logs::{Dimension, JointUnits, Layout, Log, Options, Quantity};
use rne_model::{JointKind, Robot};

use crate::arm_log::error::{ArmLogError, Mismatch};
use crate::arm_log::remark::ArmLogRemark;

/// Completes the options of a log from the robot: the names of its joints in the log, and which joints are prismatic.
///
/// Names in the options are kept. Otherwise, joints are matched by name if the log has all names of the robot's joints.
/// If a log has other names but as many joints, its joints are matched by their order, with a remark.
///
/// # Errors
/// When the log cannot be opened, or its joints cannot be matched with those of the robot.
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
    // empty names are refused later, when the log is opened: that message lists the names in the log
    if names.len() != joints.len() && names.iter().all(|name| !name.trim().is_empty()) {
        let logged = unnamed().map(|log| log.layout().joints.clone()).unwrap_or_default();
        return Err(ArmLogError::NamedJoints { named: names.len(), logged, joints });
    }
    Ok((options, None))
}

/// Whether each joint is prismatic, so that no option for angles converts its lengths.
fn slides(robot: &Robot) -> Vec<bool> {
    robot.independent_joints().map(|joint| joint.row.kind == JointKind::Prismatic).collect()
}

/// Returns the names that the joints of the robot have in the log, base to tip.
fn matched(joints: Vec<String>, logged: &[String]) -> Result<(Vec<String>, Option<ArmLogRemark>), ArmLogError> {
    match match_joints(&joints, logged) {
        Ok(JointMatch::ByName) => Ok((joints, None)),
        Ok(JointMatch::ByOrder) => {
            Ok((logged.to_vec(), Some(ArmLogRemark::MatchedByOrder { logged: logged.to_vec(), joints })))
        }
        Err(mismatch) => Err(ArmLogError::Unmatched { logged: logged.to_vec(), joints, mismatch }),
    }
}

/// The way in which the joints of measurements are matched with those of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointMatch {
    /// The measurements have all names of the robot's joints, in any order. They may have other joints, too.
    ByName,
    /// The measurements have other names but as many joints: these are taken in the order of the measurements.
    ByOrder,
}

/// Matches the joints of measurements, by their names, with the joints of a robot, base to tip: logs and messages both
/// follow this rule.
///
/// # Errors
/// When the joints cannot be matched.
pub fn match_joints(joints: &[String], measured: &[String]) -> Result<JointMatch, Mismatch> {
    if joints.iter().all(|name| measured.contains(name)) {
        return Ok(JointMatch::ByName);
    }
    // a name of the robot's joints that occurs elsewhere in the measurements shows that their order differs
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

/// Checks that the units in the names of columns suit the robot's joints: a revolute joint has no position in mm.
///
/// # Errors
/// When a unit belongs to the other kind of joint.
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
