//! Remarks on an import, and the notes of the robot file that repeat them.

use std::collections::BTreeSet;

use rne_model::{Inertia, Joint, Remedy, Robot, Transform, exact_digits, one_line};

use crate::chain::Extracted;
use crate::comparison::Difference;
use crate::remark::Remark;
use crate::snap::Snapped;
use crate::source::{names, quoted, some};
use crate::table::{FAR, NEARLY_PARALLEL, Table};
use crate::urdf::{Link, Urdf};

/// The words before the number of snapped angles in the notes of a robot file.
pub(super) const SNAPPED: &str = "angles snapped to multiples of pi/12: ";

pub(super) fn snapping(snapped: &[Snapped], Difference { position, torque, .. }: &Difference) -> String {
    let count = snapped.len();
    format!("{SNAPPED}{count}; torques move by up to {torque:.1e} of the largest, the tip by {position:.1e} m")
}

/// Returns the notes that are written into the robot file.
pub(super) fn notes(told: &Extracted, change: Option<&Difference>) -> Option<String> {
    let mut notes = Vec::new();
    for (joint, value) in &told.held {
        notes.push(format!("- the joint {} is locked at {}", one_line(joint), exact_digits(*value)));
    }
    notes.extend(told.remarks.0.iter().map(|remark| format!("- {remark}")));
    notes.extend(change.map(|change| format!("- {}", snapping(&told.snapped, change))));
    (!notes.is_empty()).then(|| notes.join("\n"))
}

impl Urdf {
    /// Returns all remarks: on the file, on its conversion to a chain, and on the robot.
    pub(super) fn remarks_on(&self, told: &mut Extracted, robot: &Robot, table: &Table) -> Vec<Remark> {
        let mut all: Vec<Remark> = self.ignored(told).into_iter().map(Remark::from).collect();
        all.append(&mut told.remarks.0);
        all.extend(self.suspicious_numbers().into_iter().map(Remark::warning));
        let impossible = self.impossible_parts(told).into_iter().map(Remark::warning);
        all.extend(impossible.map(|remark| remark.remedy(Remedy::Repair)));
        all.extend(remarks(robot, table).into_iter().map(Remark::from).chain(rotors(robot)));
        all
    }

    /// Remarks on unknown elements and attributes in links and joints of the chain, and outside of links and joints.
    fn ignored(&self, told: &Extracted) -> Vec<String> {
        let links = told.links.iter().map(|&link| &self.links[link].unknown);
        let joints = told.joints.iter().map(|&joint| &self.joints[joint].unknown);
        let kinds: BTreeSet<usize> = links.chain(joints).chain([&self.beside]).flatten().copied().collect();
        if kinds.is_empty() {
            return Vec::new();
        }
        let kinds = some(kinds.into_iter().map(|kind| self.unknown[kind].clone()));
        vec![format!("the import ignores these parts, which it does not know: {kinds}")]
    }

    /// Remarks on origins whose numbers are probably in other units.
    fn suspicious_numbers(&self) -> Vec<String> {
        let joints = self.joints.iter().map(|joint| ("joint", &joint.name, joint.xyz, joint.rpy));
        let links = self.links.iter().map(|link| ("the inertia of", &link.name, link.xyz, link.rpy));
        let mut remarks = Vec::new();
        for (what, name, xyz, rpy) in joints.chain(links) {
            let name = one_line(name);
            if let Some(angle) = rpy.into_iter().find(|angle| angle.abs() > 2.0 * std::f64::consts::PI + 1e-6) {
                let radians = angle.to_radians();
                remarks.push(format!(
                    "{what} {name} has the angle {angle} rad in its rpy, more than a turn: {angle}° is {radians:.4} rad"
                ));
            }
            if let Some(length) = xyz.into_iter().find(|length| length.abs() > FAR) {
                remarks.push(format!("{what} {name} has an origin that is {length} m away: lengths are in metres"));
            }
        }
        remarks
    }

    /// Remarks on links whose inertia no physical body has, with the place of each. The robot file may hide them,
    /// because it merges links that are fixed to each other.
    fn impossible_parts(&self, told: &Extracted) -> Vec<String> {
        let links = told.lumped.iter().flatten().chain([&told.base]);
        let links = links.filter_map(|name| self.links.iter().find(|link| link.name == *name));
        let remark = |link: &Link, [a, b, c]: [f64; 3]| {
            let report = self.source.error(&link.span_of_inertia, "", None);
            let place = report.diagnostics.first().map(|found| format!("line {}, column {}", found.line, found.column));
            format!(
                "no body can have the inertia of {} ({}): its largest principal moment is {c:.3e} kg m², the sum of \
                 the two others is {:.3e} kg m²; is one number wrong by a power of ten?",
                quoted(&link.name),
                place.unwrap_or_default(),
                a + b
            )
        };
        links.filter_map(|link| Some(remark(link, link.inertia.impossible_moments()?))).collect()
    }
}

/// Returns a remark on which frame of the robot file is the base link `link`, if that is not frame 0 in name and place.
/// `start` is frame 0 in the axes of this link; `frames` has the links with their names as frames.
pub(super) fn base_remark(link: &str, frames: &[(String, String)], start: Transform) -> Option<String> {
    let (_, name) = frames.iter().find(|(known, _)| known == link)?;
    let is_frame_0 = start == Transform::IDENTITY;
    if is_frame_0 && name == link {
        return None;
    }
    let place = if is_frame_0 {
        "which is at the same place".to_owned()
    } else {
        let [x, y, z] = start.xyz.map(|x| format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned());
        let turned = if start.rpy == Transform::IDENTITY.rpy { "" } else { " and is turned against it" };
        format!("which is at [{x}, {y}, {z}] m in the axes of this link{turned}")
    };
    Some(format!(
        "the base link {} of the file is the frame {}; `base` in a robot file is frame 0 of the table, {place}",
        quoted(link),
        quoted(name)
    ))
}

/// Returns a remark on the rotors of motors, whose inertia belongs to the arm only if the caller asks for it.
pub(super) fn rotors(robot: &Robot) -> Option<Remark> {
    let has_rotor = |joint: &&Joint| joint.motor.is_some_and(|motor| motor.inertia != 0.0);
    let joints: Vec<&str> = robot.joints.iter().filter(has_rotor).map(|joint| joint.name.as_str()).collect();
    let (count, s) = (joints.len(), if joints.len() == 1 { " has" } else { "s have" });
    let text = || format!("{count} joint{s} the inertia of a rotor (`armature` of MJCF): {}", names(&joints));
    (count > 0).then(|| Remark::from(text()).remedy(Remedy::Rotors))
}

/// Returns remarks on a table.
pub(crate) fn remarks(robot: &Robot, table: &Table) -> Vec<String> {
    let mut remarks = Vec::new();
    for ([first, second], tilt) in &table.levelled {
        let pair = if *first > robot.dof() {
            format!("z of the base and the axis of joint {second}")
        } else {
            format!("the axes of joints {first} and {second}")
        };
        remarks.push(format!(
            "{pair} are {tilt:.1e} rad off parallel, and rne takes them as parallel: their common normal is too far \
             away for a table"
        ));
    }
    for (index, row) in robot.rows().enumerate() {
        if row.dh.d.abs() > FAR || row.dh.a.abs() > FAR {
            let (row, d, a, tilt) = (index + 1, row.dh.d, row.dh.a, row.dh.alpha.sin.abs());
            let is_nearly_parallel = tilt != 0.0 && tilt < NEARLY_PARALLEL;
            let why = if is_nearly_parallel {
                ", because two axes are nearly parallel; so large numbers lose digits"
            } else {
                ""
            };
            remarks.push(format!("row {row} has d = {d:.3} m and a = {a:.3} m{why}"));
        }
    }
    for (row, joint) in robot.joints.iter().enumerate() {
        let distance = joint.row.link.com.iter().map(|x| x * x).sum::<f64>().sqrt();
        if distance > FAR {
            remarks.push(format!(
                "the centre of mass of link {} is {distance:.0} m from the origin of its link frame: single precision \
                 loses digits there, most of all in code of the form `seven_steps`; a joint with the key `at` (format \
                 2) needs no such frame",
                row + 1
            ));
        }
    }
    let has_mass = |joint: &Joint| {
        let link = joint.row.link;
        link.mass != 0.0 || link.inertia != Inertia::default() || link.has_first_moment()
    };
    if !robot.joints.iter().any(has_mass) {
        remarks.push("no link has mass: the file has no inertial data".to_owned());
    }
    remarks
}
