//! Makes a robot from a chain and its table, and names that a robot file accepts.

use rne_model::{
    Angle, Bodies, ClosedLoops, Convention, FixedFrame, FloatingBase, InertiaReference, Joint, JointKind, Robot, Row,
    RunTime, Transform, one_line,
};

use crate::chain::Chain;
use crate::frames::transform;
use crate::geometry::Pose;
use crate::table::Table;

/// Makes a robot from a chain and its table, without title, source and notes.
pub(crate) fn robot(chain: &Chain, table: &Table, convention: Convention) -> Robot {
    let start = chain.base * table.start;
    let gravity = start.rotation.transpose() * (chain.base.rotation * chain.gravity);
    let parts = chain.joints.iter().zip(&table.rows).zip(table.frames.iter().zip(&table.branches)).enumerate();
    let joints = parts.map(|(index, ((joint, dh), (frame, &[gamma, b])))| {
        let branch = (joint.parent != index.checked_sub(1) || [gamma, b] != [0.0; 2]).then(|| {
            let rpy = [0.0, 0.0, gamma].map(Angle::new);
            FixedFrame { on: joint.parent, placement: Transform { xyz: [0.0, 0.0, b], rpy } }
        });
        let link = joint.body.to_link_at(frame.inverse());
        let kind = if joint.is_prismatic { JointKind::Prismatic } else { JointKind::Revolute };
        Joint {
            name: one_line(&joint.name),
            row: Row { kind, dh: *dh, link },
            branch,
            written_inertia: (
                link.inertia,
                if link.has_first_moment() { InertiaReference::Origin } else { InertiaReference::Com },
            ),
            limits: joint.limits,
            motor: joint.motor,
            coupling: joint.coupling.clone(),
            coulomb_width: joint.coulomb_width,
            coulomb_displacement: joint.coulomb_displacement,
        }
    });
    Robot {
        name: String::new(),
        title: None,
        source: String::new(),
        notes: None,
        convention,
        gravity: gravity.rounded(10.0),
        base: transform(start),
        tool: transform(table.tool),
        // the import sets the name later
        floating_base: chain
            .floating_base
            .map(|body| FloatingBase { name: String::new(), link: body.to_link_at(Pose::identity()) }),
        tip_on: Some(chain.tip_on).filter(|on| on + 1 != chain.joints.len()),
        parameters: Vec::new(),
        joints: joints.collect(),
        drives: Vec::new(),
        frames: Vec::new(),
        tips: Vec::new(),
        contacts: Vec::new(),
        bodies: Bodies::default(),
        at: None,
        run_time: RunTime::default(),
        closed: ClosedLoops::default(),
        rotors: false,
    }
}

/// Converts a name to an identifier that a robot file accepts.
pub(crate) fn identifier(name: &str) -> String {
    let mut identifier = String::new();
    for c in name.chars().take(60) {
        let c = c.to_ascii_lowercase();
        if c.is_ascii_lowercase() || (c.is_ascii_digit() && !identifier.is_empty()) {
            identifier.push(c);
        } else if !identifier.is_empty() && !identifier.ends_with('_') {
            identifier.push('_');
        }
    }
    let identifier = identifier.trim_end_matches('_');
    if identifier.is_empty() { "arm".to_owned() } else { identifier.to_owned() }
}

pub(super) fn title(name: &str) -> Option<String> {
    let title = one_line(name).trim().to_owned();
    (!title.is_empty()).then_some(title)
}
