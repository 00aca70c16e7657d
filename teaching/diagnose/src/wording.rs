//! The words for slips: the mistake of the other computation, and the correct way.

use rne_model::{Convention, InertiaReference, Robot, six_digits};

use crate::slip::Slip;

impl Slip {
    /// Describes the mistake of the other computation in a clause: "gravity points the other way".
    #[must_use]
    pub fn says(self, robot: &Robot) -> String {
        let [this, other, near, far] = match robot.convention {
            Convention::Standard => ["standard", "modified", "far", "near"],
            Convention::Modified => ["modified", "standard", "near", "far"],
        };
        let is_about_com = reference(robot) == InertiaReference::Com;
        match self {
            Self::OtherConvention => {
                format!("the rows are read in the {other} convention; the file has the {this} convention")
            }
            Self::GravityAlong(axis, reversed) => {
                let sign = if reversed { "-" } else { "" };
                format!("gravity points along {sign}{} of frame 0", ["x", "y", "z"][axis.min(2)])
            }
            Self::InertiaAboutOrigin if is_about_com => {
                "inertias about the centre of mass are read as inertias about the frame's origin".to_owned()
            }
            Self::InertiaAboutOrigin => "the parallel axis term is subtracted from the inertias twice".to_owned(),
            Self::InertiaShifted if is_about_com => {
                "inertias about the frame's origin are used in place of inertias about the centre of mass".to_owned()
            }
            Self::InertiaShifted => {
                "inertias about the frame's origin are read as inertias about the centre of mass".to_owned()
            }
            Self::ComFromOtherEnd => {
                format!(
                    "the file's centres of mass are measured from the {far} end of the link, not from its {near} end"
                )
            }
            Self::ComOfOtherEnd => {
                format!(
                    "centres of mass measured from the {far} end of the link are used in place of those measured from \
                     its {near} end"
                )
            }
            Self::JointReversed(joint) => {
                format!("joint {} ({}) has the opposite positive direction", joint + 1, name(robot, joint))
            }
            Self::NoTool if robot.is_serial() => "the wrench acts at the last frame: the tool is left out".to_owned(),
            Self::NoTool => "the wrench acts at the frame of the link with the tip: the tool is left out".to_owned(),
            Self::TorquesFromTheTip if robot.is_serial() => "the torques are listed from tip to base".to_owned(),
            Self::TorquesFromTheTip => "the torques are listed from the last row to the first".to_owned(),
            Self::BranchesExchanged(one, other) => {
                let [one, other] = [one, other].map(|joint| joint_name(robot, joint));
                format!("the branches that begin with {one} and {other} are exchanged in all lists")
            }
            Self::JointsExchanged(one, other) => {
                let [one, other] = [one, other].map(|joint| name(robot, joint));
                format!("the joints {one} and {other} are exchanged in all lists")
            }
            Self::FollowerReversed(joint) => {
                let names: Vec<&str> = follows(robot, joint).iter().map(|(at, _)| joint_name(robot, *at)).collect();
                let follower = joint_name(robot, joint);
                format!("the joint {follower} follows {} with the other sign", names.join(" and "))
            }
            Self::Misprint(misprint) => misprint.says().to_owned(),
            Self::Typo(typo) => typo.says(robot),
            _ => self.words()[0].to_owned(),
        }
    }

    /// Describes the correct way, or what to write in the file: "`gravity: [0, 0, -9.81]` is its acceleration,
    /// downwards".
    #[must_use]
    pub fn right(self, robot: &Robot) -> String {
        let [x, y, z] = robot.gravity;
        let com = match robot.convention {
            Convention::Standard => "`com` is measured from frame i, at the far end of link i",
            Convention::Modified => "`com` is measured from frame i, on the axis of joint i",
        };
        match self {
            Self::OtherConvention => match robot.convention {
                Convention::Standard => {
                    "`convention: standard`: Rz(theta) Tz(d) Tx(a) Rx(alpha), frame i at the far end"
                }
                Convention::Modified => {
                    "`convention: modified`: Rx(alpha) Tx(a) Rz(theta) Tz(d), a and alpha of link i-1"
                }
            }
            .to_owned(),
            Self::GravityReversed | Self::NoGravity | Self::GravityAlong(..) => format!(
                "`gravity: [{x}, {y}, {z}]`: the acceleration of a falling body in frame 0 (Pinocchio's sign; the \
                 Robotics Toolbox has the other)"
            ),
            Self::GravityInWorld => format!("`gravity: [{x}, {y}, {z}]` is in frame 0; `base` never turns it"),
            Self::InertiaAboutOrigin | Self::InertiaShifted => {
                let about = if reference(robot) == InertiaReference::Com { "com" } else { "origin" };
                format!("the file's inertias are about `{about}`; I_origin = I_com + m (c² 1 - c cᵀ)")
            }
            Self::ComReversed | Self::ComFromOtherEnd | Self::ComOfOtherEnd => com.to_owned(),
            Self::NoOffsets | Self::OffsetsReversed => {
                "the joint angle is theta + q; the offset of a prismatic joint is d + q".to_owned()
            }
            Self::TipOnLastRow => {
                let on = robot.tip().on.map_or("", |on| joint_name(robot, on));
                format!("the wrench acts at the tip, which is on the link of {on}: `tool: {{on: {on}}}`")
            }
            Self::TorquesFromTheTip if robot.is_serial() => "lists run from base to tip".to_owned(),
            Self::WrenchInWorld | Self::WrenchInBase | Self::WrenchAboutWorld => {
                "the wrench is in the axes of the tip frame, and its moment is about the origin of that frame"
                    .to_owned()
            }
            Self::FollowerReversed(joint) => {
                let ratios = follows(robot, joint)
                    .iter()
                    .map(|(joint, ratio)| format!("{}: {}", robot.joints[*joint].name, six_digits(*ratio)));
                format!("`follows: {{{}}}`", ratios.collect::<Vec<_>>().join(", "))
            }
            Self::TorquesFromTheTip
            | Self::TorquesByName
            | Self::JointsByName
            | Self::JointsFromTheTip
            | Self::JointsByLevel
            | Self::BranchesExchanged(..)
            | Self::JointsExchanged(..) => {
                let names: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
                format!("lists are in the order of the rows of the file: {}", names.join(", "))
            }
            Self::Misprint(misprint) => misprint.right().to_owned(),
            Self::Typo(typo) => typo.right(robot),
            _ => self.words()[1].to_owned(),
        }
    }
}

/// Returns the name of the joint of a coordinate, counted from 0.
fn name(robot: &Robot, coordinate: usize) -> &str {
    robot.independent_joint(coordinate).map_or("", |joint| &joint.name)
}

/// Returns the name of a joint, counted from 0.
fn joint_name(robot: &Robot, joint: usize) -> &str {
    robot.joints.get(joint).map_or("", |joint| &joint.name)
}

/// Returns the joints on which a joint depends, and the ratios.
fn follows(robot: &Robot, joint: usize) -> &[(usize, f64)] {
    let coupling = robot.joints.get(joint).and_then(|joint| joint.coupling.as_ref());
    coupling.map_or(&[], |coupling| &coupling.follows)
}

fn reference(robot: &Robot) -> InertiaReference {
    robot.joints.first().map_or(InertiaReference::Com, |joint| joint.written_inertia.1)
}
