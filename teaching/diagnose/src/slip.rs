//! The usual slips, and how each changes a computation.

use std::f64::consts::PI;

use nalgebra::{Rotation3, Vector3};
use rne_model::{Convention, JointKind, Robot, Transform};

use crate::computation::{Computation, WrenchAxes, is_of_lecture};
use crate::lecture::Misprint;
use crate::links::LinkSlip;
use crate::order;
use crate::typo::Typo;

/// A row for each slip: its documentation, its name for programs, the subject that it changes, and the words for the
/// slip and for the correct way. The words are empty if they depend on the robot.
macro_rules! slips {
    ($($(#[$doc:meta])* $variant:ident $(($($of:ty),+))?: $name:literal, $subject:literal,
       $says:literal, $right:literal;)*) => {
        /// A slip that makes two tools disagree. They are tried in this order, the commonest first.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Slip { $($(#[$doc])* $variant $(($($of),+))?,)* }

        impl Slip {
            /// Returns the name for programs, such as `gravity_reversed` or `joint_reversed`.
            #[must_use]
            pub fn name(self) -> &'static str {
                if let Self::Typo(typo) = self {
                    return typo.name();
                }
                match self { $(Self::$variant { .. } => $name,)* }
            }

            /// Returns the subject that the slip changes: two slips with the same subject exclude each other.
            fn subject(self) -> &'static str {
                match self { $(Self::$variant { .. } => $subject,)* }
            }

            /// Returns the words for the slip and for the correct way; empty if they depend on the robot.
            pub(crate) const fn words(self) -> [&'static str; 2] {
                match self { $(Self::$variant { .. } => [$says, $right],)* }
            }
        }
    };
}

slips! {
    /// The rows are read in the other Denavit-Hartenberg convention.
    OtherConvention: "other_convention", "convention", "", "";
    /// Gravity points up.
    GravityReversed: "gravity_reversed", "gravity", "gravity points the other way", "";
    /// There is no gravity.
    NoGravity: "no_gravity", "gravity", "there is no gravity", "";
    /// Gravity points along another axis, 0 to 2; `true` for the negative direction.
    GravityAlong(usize, bool): "gravity_along_another_axis", "gravity", "", "";
    /// Gravity is taken in world axes, and rotated by the placement of the base.
    GravityInWorld: "gravity_in_world", "gravity", "gravity is taken in world axes, and is rotated by `base`", "";
    /// The inertia in the file is taken to be about the origin of the link frame.
    InertiaAboutOrigin: "inertia_about_origin", "inertia", "", "";
    /// The term m (c² 1 - c cᵀ) is added to the inertia once more.
    InertiaShifted: "inertia_shifted", "inertia", "", "";
    /// The products of inertia xy, xz and yz have the other sign.
    ProductsOfInertia: "products_of_inertia", "products",
        "xy, xz and yz of the inertias have the other sign", "`xy` is the element of the tensor, -∫ x y dm";
    /// The inertias of a standard table are not rotated by alpha into axes with z along the joint.
    InertiaNotTwisted: "inertia_not_twisted", "inertia",
        "the inertias are not turned by alpha: they are used in axes with z along the joint as the file has \
         them, whose z is along the next joint",
        "[I] = Rx(α) I Rx(α)ᵀ in axes with z along the joint";
    /// The centres of mass have the other sign.
    ComReversed: "com_reversed", "com", "the centres of mass have the other sign", "";
    /// The centres of mass are taken from the frame at the other end of the link.
    ComFromOtherEnd: "com_from_other_end", "com", "", "";
    /// The vectors from the other end of the link to the centre of mass are used as if they began at the link frame.
    ComOfOtherEnd: "com_of_other_end", "com", "", "";
    /// The angles are in radians, but are read as degrees.
    PositionsAsDegrees: "positions_as_degrees", "units",
        "the angles are in radians, but are read as degrees",
        "q in rad: deg(30) is pi/6. If your torques are right, the q that you gave here is in degrees";
    /// The angles are converted to degrees, but then read as radians.
    PositionsInDegrees: "positions_in_degrees", "units",
        "the angles are multiplied by 180/π, and then read as radians", "q in rad: deg(30) is pi/6";
    /// Angles, speeds and accelerations of revolute joints are in radians, but are read as degrees.
    StateAsDegrees: "state_as_degrees", "units",
        "angles, speeds and accelerations are in rad, rad/s and rad/s², but are read as degrees",
        "q, q̇ and q̈ in rad, rad/s and rad/s². If your torques are right, the state that you gave here is in degrees";
    /// Angles, speeds and accelerations of revolute joints are converted to degrees, but then read as radians.
    StateInDegrees: "state_in_degrees", "units",
        "angles, speeds and accelerations are multiplied by 180/π", "q, q̇ and q̈ in rad, rad/s and rad/s²";
    /// The constant parts of the joint variables are left out.
    NoOffsets: "no_offsets", "offsets", "the constant `theta` (or `d`) of the joints' rows is left out", "";
    /// The constant parts of the joint variables are subtracted.
    OffsetsReversed: "offsets_reversed", "offsets",
        "the constant `theta` (or `d`) of the joints' rows has the other sign", "";
    /// A joint, counted from 0, has the opposite positive direction.
    JointReversed(usize): "joint_reversed", "joint",
        "", "q, q̇, q̈ and τ are positive about (prismatic joints: along) +z of the joint";
    /// The velocities are taken as zero.
    NoVelocities: "no_velocities", "velocities",
        "the velocities are zero: no Coriolis and centrifugal terms", "n = I ω̇ + ω × I ω, and c̈ with its ω × (ω × …)";
    /// The accelerations are taken as zero.
    NoAccelerations: "no_accelerations", "accelerations",
        "the accelerations are zero: no inertia terms", "τ includes M(q) q̈";
    /// The acceleration of a prismatic first joint is ignored in modified tables, as in the C code of the Robotics
    /// Toolbox for MATLAB.
    NoFirstSlide: "no_first_slide", "accelerations",
        "the acceleration of a prismatic first joint is ignored",
        "the C code of the Robotics Toolbox for MATLAB has this mistake; its MATLAB code is right";
    /// The rotors' inertia G² Jm is included in the arm.
    RotorInertia: "rotor_inertia", "motors",
        "the rotors' inertia G² Jm is part of the arm",
        "the arm consists of the links of the file; rotors are added only on request";
    /// The motors' inertia and friction are added to the torques.
    MotorTorques: "motor_torques", "motors",
        "the motors' inertia and friction are in the torques",
        "τ is without motors; `actuator_torques` adds their inertia and friction";
    /// The wrench is taken as that of the environment on the arm.
    WrenchReversed: "wrench_reversed", "wrench",
        "the wrench is what the environment exerts on the arm",
        "the wrench is what the last link exerts on its environment: τ = τ_free + Jᵀ w";
    /// The wrench is left out.
    NoWrench: "no_wrench", "wrench", "the wrench is left out", "τ = τ_free + Jᵀ w";
    /// The wrench acts at the last frame instead of the tip.
    NoTool: "no_tool", "wrench", "", "the wrench acts at the tip frame, in its axes: frame n, then `tool`";
    /// The wrench at the tip is taken in world axes.
    WrenchInWorld: "wrench_in_world", "axes of the wrench", "the wrench at the tip is in world axes", "";
    /// The wrench at the tip is taken in the axes of frame 0.
    WrenchInBase: "wrench_in_base", "axes of the wrench", "the wrench at the tip is in the axes of frame 0", "";
    /// The wrench is taken in world axes, with its moment about the origin of the world.
    WrenchAboutWorld: "wrench_about_world", "axes of the wrench",
        "the wrench is in world axes, and its moment is about the origin of the world", "";
    /// The tip of a tree is taken to be on the link of the last row.
    TipOnLastRow: "tip_on_last_row", "wrench", "the wrench acts at the link of the last row", "";
    /// The torques are those that the arm exerts on its motors.
    TorquesReversed: "torques_reversed", "torques",
        "the torques are what the arm exerts on its motors", "τ is what the motor exerts on the arm: positive lifts";
    /// The torques are listed from tip to base.
    TorquesFromTheTip: "torques_from_the_tip", "order", "", "";
    /// The torques are listed in the alphabetical order of the joints.
    TorquesByName: "torques_by_name", "order", "the torques are listed in the alphabetical order of the joints", "";
    /// Positions, velocities, accelerations and torques are listed in the alphabetical order of the joints.
    JointsByName: "joints_by_name", "order",
        "positions, velocities, accelerations and torques are listed in the alphabetical order of the joints", "";
    /// Positions, velocities, accelerations and torques are listed from tip to base.
    JointsFromTheTip: "joints_from_the_tip", "order",
        "positions, velocities, accelerations and torques are listed from the last joint to the first", "";
    /// Positions, velocities, accelerations and torques are listed breadth first: by the number of joints from the
    /// base.
    JointsByLevel: "joints_by_level", "order",
        "positions, velocities, accelerations and torques are listed breadth first: by the number of joints \
         from the base", "";
    /// Two branches of a tree with equal numbers of joints are exchanged in all lists; each is given by its first
    /// joint.
    BranchesExchanged(usize, usize): "branches_exchanged", "order", "", "";
    /// Two coordinates are exchanged in all lists. This slip is tried alone only, not in pairs.
    JointsExchanged(usize, usize): "joints_exchanged", "order", "", "";
    /// A dependent joint, counted from 0, has ratios with the other sign.
    FollowerReversed(usize): "follower_reversed", "follower", "", "";
    /// The torques of revolute joints are in N mm.
    TorquesInNmm: "torques_in_nmm", "unit of torque",
        "the torques of revolute joints are in N mm", "N m for a revolute joint, N for a prismatic joint";
    /// Velocities and accelerations are exchanged.
    RatesExchanged: "rates_exchanged", "rates",
        "velocities and accelerations are exchanged", "q̇ before q̈: τ(q, q̇, q̈)";
    /// A misprinted formula of the lecture, or a common mistake in one.
    Misprint(Misprint): "misprint", "formula", "", "";
    /// A slip in one row, joint or link. It is tried alone, and in pairs with the slips of the whole arm.
    Typo(Typo): "typo", "number", "", "";
}

impl Slip {
    /// Returns all slips of a robot that are tried alone and in pairs: those that concern all links, one joint or a
    /// formula.
    #[must_use]
    pub fn candidates(robot: &Robot) -> Vec<Self> {
        let mut all = vec![Self::OtherConvention, Self::GravityReversed, Self::NoGravity];
        let turned = (0..3).flat_map(|axis| [Self::GravityAlong(axis, false), Self::GravityAlong(axis, true)]);
        let mut known = vec![robot.gravity, robot.gravity.map(|g| -g)];
        for slip in turned.chain([Self::GravityInWorld]) {
            let mut computation = Computation::right(robot);
            slip.make(&mut computation);
            // skips slips that give the same gravity as an earlier one
            if !known.iter().any(|known| close(known, &computation.robot.gravity)) {
                known.push(computation.robot.gravity);
                all.push(slip);
            }
        }
        all.extend([Self::InertiaAboutOrigin, Self::InertiaShifted, Self::ProductsOfInertia, Self::ComReversed]);
        all.extend((robot.convention == Convention::Standard).then_some(Self::InertiaNotTwisted));
        if robot.is_serial() {
            // only for serial arms: a link of a tree may have several other ends
            all.extend([Self::ComFromOtherEnd, Self::ComOfOtherEnd]);
        }
        all.extend([
            Self::PositionsAsDegrees,
            Self::PositionsInDegrees,
            Self::StateAsDegrees,
            Self::StateInDegrees,
            Self::NoOffsets,
            Self::OffsetsReversed,
        ]);
        all.extend((0..robot.dof()).map(Self::JointReversed));
        all.extend([
            Self::NoVelocities,
            Self::NoAccelerations,
            Self::NoFirstSlide,
            Self::RotorInertia,
            Self::MotorTorques,
            Self::WrenchReversed,
            Self::NoWrench,
            Self::NoTool,
            Self::TorquesReversed,
            Self::TorquesFromTheTip,
            Self::TorquesInNmm,
            Self::RatesExchanged,
            Self::WrenchInWorld,
            Self::WrenchAboutWorld,
        ]);
        all.extend((!is_unturned(&robot.base)).then_some(Self::WrenchInBase));
        if is_of_lecture(robot) {
            all.extend(Misprint::IN_TORQUES.map(Self::Misprint));
        } else {
            // other slips of a tree; the lecture's formulas only apply to serial arms
            all.retain(|slip| *slip != Self::NoFirstSlide);
            all.extend(robot.tip_on.map(|_| Self::TipOnLastRow));
        }
        all.extend(
            (0..robot.joints.len()).filter(|&at| robot.joints[at].coupling.is_some()).map(Self::FollowerReversed),
        );
        all.extend((!order::by_name(robot).is_sorted()).then_some(Self::TorquesByName));
        all.extend(Self::orders(robot));
        all
    }

    /// Returns the slips that change the order of all lists, each order once.
    fn orders(robot: &Robot) -> Vec<Self> {
        let branches = order::equal_branches(robot).into_iter().map(|[one, other]| Self::BranchesExchanged(one, other));
        let named = [Self::JointsByName, Self::JointsFromTheTip, Self::JointsByLevel];
        let mut known = vec![(0..robot.dof()).collect::<Vec<_>>()];
        let is_new = |slip: &Self| {
            let order = slip.order(robot);
            let is_new = !known.contains(&order);
            known.push(order);
            is_new
        };
        named.into_iter().chain(branches).filter(is_new).collect()
    }

    /// Returns the exchanges of two joints in all lists. There are so many that each is tried alone, like a [`Typo`],
    /// and not in pairs.
    pub(crate) fn alone(robot: &Robot) -> impl Iterator<Item = Self> {
        let known: Vec<Vec<usize>> = Self::orders(robot).into_iter().map(|slip| slip.order(robot)).collect();
        let dof = robot.dof();
        let pairs = (0..dof).flat_map(move |one| (one + 1..dof).map(move |other| Self::JointsExchanged(one, other)));
        pairs.filter(move |slip| !known.contains(&slip.order(robot)))
    }

    /// Returns the coordinate at each index of all lists; the order of the file if the slip does not change it.
    fn order(self, robot: &Robot) -> Vec<usize> {
        match self {
            Self::JointsByName => order::by_name(robot),
            Self::JointsFromTheTip => (0..robot.dof()).rev().collect(),
            Self::JointsByLevel => order::by_level(robot),
            Self::BranchesExchanged(one, other) => order::with_branches_exchanged(robot, [one, other]),
            Self::JointsExchanged(one, other) => {
                let mut order: Vec<usize> = (0..robot.dof()).collect();
                order.swap(one, other);
                order
            }
            _ => (0..robot.dof()).collect(),
        }
    }

    /// Whether both slips can be made at once. Two slips of the same kind can, if they concern different joints,
    /// formulas or numbers.
    #[must_use]
    pub fn goes_with(self, other: Self) -> bool {
        let is_one_of_several =
            matches!(self, Self::JointReversed(_) | Self::FollowerReversed(_) | Self::Misprint(_) | Self::Typo(_));
        self.subject() != other.subject() || is_one_of_several && self != other
    }

    /// Changes a computation as the slip does.
    pub(crate) fn make(self, of: &mut Computation) {
        let robot = &mut of.robot;
        match self {
            Self::OtherConvention => robot.convention = other(robot.convention),
            Self::GravityReversed => robot.gravity = robot.gravity.map(|g| -g),
            Self::NoGravity => robot.gravity = [0.0; 3],
            Self::GravityAlong(axis, reversed) => turn_gravity(robot, axis, reversed),
            Self::GravityInWorld => {
                robot.gravity = rotation(&robot.base).inverse_transform_vector(&robot.gravity.into()).into();
            }
            Self::InertiaAboutOrigin => LinkSlip::InertiaAboutOrigin.everywhere(robot),
            Self::InertiaShifted => LinkSlip::InertiaShifted.everywhere(robot),
            Self::ProductsOfInertia => LinkSlip::ProductsOfInertia.everywhere(robot),
            Self::InertiaNotTwisted => LinkSlip::InertiaNotTwisted.everywhere(robot),
            Self::ComReversed => LinkSlip::ComReversed.everywhere(robot),
            Self::ComFromOtherEnd => LinkSlip::ComFromOtherEnd.everywhere(robot),
            Self::ComOfOtherEnd => LinkSlip::ComOfOtherEnd.everywhere(robot),
            Self::PositionsAsDegrees => of.scale(PI / 180.0, false),
            Self::PositionsInDegrees => of.scale(180.0 / PI, false),
            Self::StateAsDegrees => of.scale(PI / 180.0, true),
            Self::StateInDegrees => of.scale(180.0 / PI, true),
            Self::NoOffsets => of.offset(-1.0),
            Self::OffsetsReversed => of.offset(-2.0),
            Self::JointReversed(joint) => of.reversed.push(joint),
            Self::NoVelocities => of.velocity_factor = 0.0,
            Self::NoAccelerations => of.acceleration_factor = 0.0,
            Self::NoFirstSlide if slides_first(robot) => of.first_factor = 0.0,
            Self::NoFirstSlide => {}
            Self::RotorInertia => robot.rotors = true,
            Self::MotorTorques => of.motor_torques = true,
            Self::WrenchReversed => of.wrench_factor = -1.0,
            Self::NoWrench => of.wrench_factor = 0.0,
            Self::NoTool => robot.tool = Transform::IDENTITY,
            Self::TipOnLastRow => robot.tip_on = None,
            Self::TorquesReversed => of.torque_factor = -1.0,
            Self::TorquesFromTheTip => of.order_of_torques = (0..robot.dof()).rev().collect(),
            Self::TorquesByName => of.order_of_torques = order::by_name(robot),
            Self::JointsByName
            | Self::JointsFromTheTip
            | Self::JointsByLevel
            | Self::BranchesExchanged(..)
            | Self::JointsExchanged(..) => {
                of.order_of_state = self.order(robot);
                of.order_of_torques.clone_from(&of.order_of_state);
            }
            Self::FollowerReversed(joint) => reverse_follower(robot, joint),
            Self::WrenchInWorld => of.wrench_axes = WrenchAxes::World,
            Self::WrenchInBase => of.wrench_axes = WrenchAxes::Base,
            Self::WrenchAboutWorld => of.wrench_axes = WrenchAxes::AboutWorld,
            Self::TorquesInNmm => of.moment_factor = 1e3,
            Self::RatesExchanged => of.rates_exchanged = true,
            Self::Misprint(misprint) => of.misprints.push(misprint),
            Self::Typo(typo) => typo.make(of),
        }
    }
}

fn other(convention: Convention) -> Convention {
    match convention {
        Convention::Standard => Convention::Modified,
        Convention::Modified => Convention::Standard,
    }
}

/// Whether the first joint of a modified table is prismatic.
fn slides_first(robot: &Robot) -> bool {
    let is_first_prismatic = robot.rows().next().is_some_and(|row| row.kind == JointKind::Prismatic);
    is_first_prismatic && robot.convention == Convention::Modified
}

fn turn_gravity(robot: &mut Robot, axis: usize, reversed: bool) {
    let size = Vector3::from(std::mem::take(&mut robot.gravity)).norm();
    robot.gravity[axis] = if reversed { -size } else { size };
}

fn reverse_follower(robot: &mut Robot, joint: usize) {
    let coupling = robot.joints.get_mut(joint).and_then(|joint| joint.coupling.as_mut());
    coupling.into_iter().flat_map(|it| &mut it.follows).for_each(|(_, ratio)| *ratio = -*ratio);
}

/// Whether a placement has no rotation.
fn is_unturned(placement: &Transform) -> bool {
    placement.rpy.iter().all(|angle| angle.radians == 0.0)
}

fn close(a: &[f64; 3], b: &[f64; 3]) -> bool {
    (Vector3::from(*a) - Vector3::from(*b)).norm() <= 1e-9 * Vector3::from(*a).norm()
}

pub(crate) fn rotation(transform: &Transform) -> Rotation3<f64> {
    let [roll, pitch, yaw] = transform.rpy.map(|angle| angle.radians);
    Rotation3::from_euler_angles(roll, pitch, yaw)
}
