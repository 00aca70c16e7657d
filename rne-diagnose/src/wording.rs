//! The words for slips: what the other computation does, and what is right.

use rne_model::{Convention, InertiaReference, Robot, six_digits};

use crate::slip::Slip;

impl Slip {
    /// The mistake of the other computation, in a clause: "gravity points the other way".
    #[must_use]
    #[allow(clippy::too_many_lines)] // an arm for each slip
    pub fn says(self, robot: &Robot) -> String {
        let (this, other) = match robot.convention {
            Convention::Standard => ("standard", "modified"),
            Convention::Modified => ("modified", "standard"),
        };
        let [near, far] = match robot.convention {
            Convention::Standard => ["far", "near"],
            Convention::Modified => ["near", "far"],
        };
        match self {
            Self::OtherConvention => {
                format!("the rows are read in the {other} convention; the file has the {this} convention")
            }
            Self::GravityReversed => "gravity points the other way".to_owned(),
            Self::NoGravity => "there is no gravity".to_owned(),
            Self::GravityAlong(axis, reversed) => {
                let sign = if reversed { "-" } else { "" };
                format!("gravity points along {sign}{} of frame 0", ["x", "y", "z"][axis.min(2)])
            }
            Self::GravityInWorld => "gravity is taken in world axes, and is rotated by `base`".to_owned(),
            Self::InertiaAboutOrigin => match reference(robot) {
                InertiaReference::Com => {
                    "inertias about the centre of mass are read as inertias about the frame's origin"
                }
                InertiaReference::Origin => "the parallel axis term is subtracted from the inertias twice",
            }
            .to_owned(),
            Self::InertiaShifted => match reference(robot) {
                InertiaReference::Com => {
                    "inertias about the frame's origin are used in place of inertias about the centre of mass"
                }
                InertiaReference::Origin => {
                    "inertias about the frame's origin are read as inertias about the centre of mass"
                }
            }
            .to_owned(),
            Self::ProductsOfInertia => "xy, xz and yz of the inertias have the other sign".to_owned(),
            Self::InertiaNotTwisted => "the inertias are not turned by alpha: they are used in axes with z along the \
                                        joint as the file has them, whose z is along the next joint"
                .to_owned(),
            Self::ComReversed => "the centres of mass have the other sign".to_owned(),
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
            Self::PositionsAsDegrees => "the angles are in radians, but are read as degrees".to_owned(),
            Self::PositionsInDegrees => "the angles are multiplied by 180/π, and then read as radians".to_owned(),
            Self::StateAsDegrees => {
                "angles, speeds and accelerations are in rad, rad/s and rad/s², but are read as degrees".to_owned()
            }
            Self::StateInDegrees => "angles, speeds and accelerations are multiplied by 180/π".to_owned(),
            Self::NoOffsets => "the constant `theta` (or `d`) of the joints' rows is left out".to_owned(),
            Self::OffsetsReversed => "the constant `theta` (or `d`) of the joints' rows has the other sign".to_owned(),
            Self::JointReversed(joint) => {
                format!("joint {} ({}) has the opposite positive direction", joint + 1, name(robot, joint))
            }
            Self::NoVelocities => "the velocities are zero: no Coriolis and centrifugal terms".to_owned(),
            Self::NoAccelerations => "the accelerations are zero: no inertia terms".to_owned(),
            Self::NoFirstSlide => "the acceleration of a prismatic first joint is ignored".to_owned(),
            Self::RotorInertia => "the rotors' inertia G² Jm is part of the arm".to_owned(),
            Self::MotorTorques => "the motors' inertia and friction are in the torques".to_owned(),
            Self::WrenchReversed => "the wrench is what the environment exerts on the arm".to_owned(),
            Self::NoWrench => "the wrench is left out".to_owned(),
            Self::NoTool if robot.is_serial() => "the wrench acts at the last frame: the tool is left out".to_owned(),
            Self::NoTool => "the wrench acts at the frame of the link with the tip: the tool is left out".to_owned(),
            Self::TipOnLastRow => "the wrench acts at the link of the last row".to_owned(),
            Self::TorquesReversed => "the torques are what the arm exerts on its motors".to_owned(),
            Self::TorquesFromTheTip if robot.is_serial() => "the torques are listed from tip to base".to_owned(),
            Self::TorquesFromTheTip => "the torques are listed from the last row to the first".to_owned(),
            Self::TorquesByName => "the torques are listed in the alphabetical order of the joints".to_owned(),
            Self::JointsByName => {
                "positions, velocities, accelerations and torques are listed in the alphabetical order of the joints"
                    .to_owned()
            }
            Self::JointsFromTheTip => {
                "positions, velocities, accelerations and torques are listed from the last joint to the first"
                    .to_owned()
            }
            Self::JointsByLevel => {
                "positions, velocities, accelerations and torques are listed breadth first: by the number of joints \
                 from the base"
                    .to_owned()
            }
            Self::BranchesExchanged(one, other) => {
                let [one, other] = [one, other].map(|joint| robot.joints.get(joint).map_or("", |joint| &joint.name));
                format!("the branches that begin with {one} and {other} are exchanged in all lists")
            }
            Self::JointsExchanged(one, other) => {
                let [one, other] = [one, other].map(|joint| name(robot, joint));
                format!("the joints {one} and {other} are exchanged in all lists")
            }
            Self::FollowerReversed(joint) => {
                let follower = robot.joints.get(joint).map_or("", |joint| &joint.name);
                format!("the joint {follower} follows {} with the other sign", followed(robot, joint))
            }
            Self::WrenchInWorld => "the wrench at the tip is in world axes".to_owned(),
            Self::WrenchInBase => "the wrench at the tip is in the axes of frame 0".to_owned(),
            Self::WrenchAboutWorld => {
                "the wrench is in world axes, and its moment is about the origin of the world".to_owned()
            }
            Self::TorquesInNmm => "the torques of revolute joints are in N mm".to_owned(),
            Self::RatesExchanged => "velocities and accelerations are exchanged".to_owned(),
            Self::Misprint(misprint) => misprint.says().to_owned(),
            Self::Typo(typo) => typo.says(robot),
        }
    }

    /// The line that is right, or what to write where: "`gravity: [0, 0, -9.81]` is its acceleration, downwards".
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
            Self::InertiaNotTwisted => "[I] = Rx(α) I Rx(α)ᵀ in axes with z along the joint".to_owned(),
            Self::ProductsOfInertia => "`xy` is the element of the tensor, -∫ x y dm".to_owned(),
            Self::ComReversed | Self::ComFromOtherEnd | Self::ComOfOtherEnd => com.to_owned(),
            Self::PositionsAsDegrees => {
                "q in rad: deg(30) is pi/6. If your torques are right, the q that you gave here is in degrees"
                    .to_owned()
            }
            Self::PositionsInDegrees => "q in rad: deg(30) is pi/6".to_owned(),
            Self::StateAsDegrees => {
                "q, q̇ and q̈ in rad, rad/s and rad/s². If your torques are right, the state that you gave here is in \
                 degrees"
                    .to_owned()
            }
            Self::StateInDegrees => "q, q̇ and q̈ in rad, rad/s and rad/s²".to_owned(),
            Self::NoOffsets | Self::OffsetsReversed => {
                "the joint angle is theta + q; the offset of a prismatic joint is d + q".to_owned()
            }
            Self::JointReversed(_) => {
                "q, q̇, q̈ and τ are positive about (prismatic joints: along) +z of the joint".to_owned()
            }
            Self::NoVelocities => "n = I ω̇ + ω × I ω, and c̈ with its ω × (ω × …)".to_owned(),
            Self::NoAccelerations => "τ includes M(q) q̈".to_owned(),
            Self::NoFirstSlide => {
                "the C code of the Robotics Toolbox for MATLAB has this mistake; its MATLAB code is right".to_owned()
            }
            Self::RotorInertia => {
                "the arm consists of the links of the file; rotors are added only on request".to_owned()
            }
            Self::MotorTorques => "τ is without motors; `actuator_torques` adds their inertia and friction".to_owned(),
            Self::WrenchReversed => {
                "the wrench is what the last link exerts on its environment: τ = τ_free + Jᵀ w".to_owned()
            }
            Self::NoWrench => "τ = τ_free + Jᵀ w".to_owned(),
            Self::NoTool => "the wrench acts at the tip frame, in its axes: frame n, then `tool`".to_owned(),
            Self::TipOnLastRow => {
                let on = robot.tip().on.and_then(|on| robot.joints.get(on)).map_or("", |joint| &joint.name);
                format!("the wrench acts at the tip, which is on the link of {on}: `tool: {{on: {on}}}`")
            }
            Self::TorquesReversed => "τ is what the motor exerts on the arm: positive lifts".to_owned(),
            Self::TorquesFromTheTip if robot.is_serial() => "lists run from base to tip".to_owned(),
            Self::WrenchInWorld | Self::WrenchInBase | Self::WrenchAboutWorld => {
                "the wrench is in the axes of the tip frame, and its moment is about the origin of that frame"
                    .to_owned()
            }
            Self::FollowerReversed(joint) => {
                let coupling = robot.joints.get(joint).and_then(|joint| joint.coupling.as_ref());
                let ratios = coupling
                    .into_iter()
                    .flat_map(|it| &it.follows)
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
            Self::TorquesInNmm => "N m for a revolute joint, N for a prismatic joint".to_owned(),
            Self::RatesExchanged => "q̇ before q̈: τ(q, q̇, q̈)".to_owned(),
            Self::Misprint(misprint) => misprint.right().to_owned(),
            Self::Typo(typo) => typo.right(robot),
        }
    }
}

/// The name of the joint of a coordinate, counted from 0.
fn name(robot: &Robot, coordinate: usize) -> &str {
    robot.independent_joint(coordinate).map_or("", |joint| &joint.name)
}

/// The joints that a joint follows, in words.
fn followed(robot: &Robot, joint: usize) -> String {
    let coupling = robot.joints.get(joint).and_then(|joint| joint.coupling.as_ref());
    let names = coupling.into_iter().flat_map(|it| &it.follows).map(|(joint, _)| robot.joints[*joint].name.as_str());
    names.collect::<Vec<_>>().join(" and ")
}

fn reference(robot: &Robot) -> InertiaReference {
    robot.joints.first().map_or(InertiaReference::Com, |joint| joint.written_inertia.1)
}
