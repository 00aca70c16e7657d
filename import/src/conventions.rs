//! Converts a table to the other convention: the same arm, and the same frame 0 if its z axis is the axis of joint 1.

use rne_model::{Convention, Double, Frame, JointKind, Reader, Report, Robot, Row};

use crate::body::Body;
use crate::chain::{Chain, ChainFrame, ChainJoint};
use crate::comparison::Difference;
use crate::dynamics::Dynamics;
use crate::frames::named_frames;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::import::remarks::remarks;
use crate::import::robot::robot as robot_of;
use crate::robot_file;
use crate::table::table;

/// A robot whose table was converted to another convention.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Converted {
    /// The robot.
    pub robot: Robot,
    /// The robot as a robot file.
    pub text: String,
    /// The differences between the two tables, which only rounding causes.
    pub rounding: Difference,
    /// Remarks on the conversion, in sentences.
    pub remarks: Vec<String>,
}

/// Converts an arm to rows of `convention`. Name, title, source, limits and motors do not change. Expressions of the
/// file become values, and the notes of the new file say that it was converted.
///
/// # Errors
///
/// When the table cannot be written as a valid robot file.
pub fn convert(robot: &Robot, convention: Convention) -> Result<Converted, Report> {
    let chain = of_robot(robot);
    let table = table(&chain, convention);
    let mut result = robot_of(&chain, &table, convention);
    result.frames = named_frames(&chain, &table);
    result.name.clone_from(&robot.name);
    result.title.clone_from(&robot.title);
    result.source.clone_from(&robot.source);
    let note = format!("- converted from {} to {} rows by rne", robot.convention.name(), convention.name());
    result.notes = Some(robot.notes.as_ref().map_or_else(|| note.clone(), |notes| format!("{notes}\n{note}")));
    let text = robot_file::write(&result);
    let checked = Reader::new(&format!("{}, converted", robot.name)).read(&text)?;
    let rounding = Difference::of_table(&Dynamics::of(&chain), &checked.robot);
    Ok(Converted { remarks: remarks(&checked.robot, &table), robot: checked.robot, text, rounding })
}

/// Returns the chain or the tree of a table. The frame of each link is at its joint, with z along the axis.
pub(crate) fn of_robot(robot: &Robot) -> Chain {
    let rows: Vec<&Row> = robot.rows().collect();
    let mut joints = Vec::with_capacity(rows.len());
    // For each row, the placement of the end of its link, where the next row begins.
    let mut ends: Vec<Pose> = Vec::with_capacity(rows.len());
    for (index, (joint, row)) in robot.joints.iter().zip(&rows).enumerate() {
        let screw = screw_x(row);
        let parent = robot.parent(index);
        let branch = joint.branch.map_or_else(Pose::identity, |branch| placement(&branch.placement));
        let end = parent.map_or_else(Pose::identity, |parent| ends[parent]) * branch;
        let (before, after) = match robot.convention {
            Convention::Standard => (end, screw),
            Convention::Modified => (end * screw, Pose::identity()),
        };
        joints.push(ChainJoint {
            name: joint.name.clone(),
            is_prismatic: row.kind == JointKind::Prismatic,
            parent,
            place: before * screw_z(row),
            axis: Vector::unit(2),
            body: Body::of_link(&row.link).seen_from(after),
            limits: joint.limits,
            motor: joint.motor,
            coupling: joint.coupling.clone(),
            coulomb_width: joint.coulomb_width,
            coulomb_displacement: joint.coulomb_displacement,
        });
        ends.push(after);
    }
    let frames = robot.frames.iter().map(|Frame { name, fixed }| ChainFrame {
        name: name.clone(),
        on: fixed.on,
        place: fixed.on.map_or_else(Pose::identity, |link| ends[link]) * placement(&fixed.placement),
    });
    let frames = frames.collect();
    let base = placement(&robot.base);
    let tip = robot.tip();
    let tip_on = tip.on.unwrap_or(0);
    let tip = ends.get(tip_on).copied().unwrap_or_else(Pose::identity) * placement(&tip.placement);
    let gravity = Vector::decimal(robot.gravity);
    let floating_base = robot.floating_base.as_ref().map(|base| Body::of_link(&base.link));
    Chain { base, gravity, floating_base, joints, tip_on, tip, frames, loops: Vec::new() }
}

pub(crate) fn placement(transform: &rne_model::Transform) -> Pose {
    Pose::new(transform.xyz, transform.rpy.map(|angle| angle.radians))
}

/// Returns Tx(a) Rx(alpha); the order of the two does not matter.
fn screw_x(row: &Row) -> Pose {
    Pose { rotation: Rotation::x(row.dh.alpha.radians), translation: Vector::unit(0) * decimal(row.dh.a) }
}

/// Returns Rz(theta) Tz(d); the order of the two does not matter.
fn screw_z(row: &Row) -> Pose {
    let zero = Double::new(0.0);
    Pose { rotation: Rotation::z(row.dh.theta.radians), translation: Vector([zero, zero, decimal(row.dh.d)]) }
}
