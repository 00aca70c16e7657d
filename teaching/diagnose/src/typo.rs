//! Slips in one row of the table, in one joint or in one link.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use rne_model::{Angle, Convention, JointKind, Robot, Row, six_digits};

use crate::computation::Computation;
use crate::links::LinkSlip;

/// A number of one row, joint or link that is wrong. Joints count from 0, axes are 0 to 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Typo {
    /// `alpha` of a row has the other sign.
    Alpha(usize),
    /// `theta` of a row, the constant part of the angle, has the other sign.
    Theta(usize),
    /// A component of the centre of mass of a link has the other sign.
    Com(usize, usize),
    /// A slip in the inertial numbers of a link that concerns no other link.
    Link(usize, LinkSlip),
    /// The mass of a link is multiplied by a power of ten.
    Mass(usize, i8),
    /// `a` and `d` of a row are exchanged.
    Lengths(usize),
    /// `alpha` and `theta` of a row are exchanged.
    Angles(usize),
    /// A link has the inertia of another link.
    Inertia(usize, usize),
    /// The zero of a joint is turned by a number of right angles.
    Zero(usize, i8),
    /// The axis of a joint has the length √2, as [1, 1, 0] has.
    Axis(usize),
}

impl Typo {
    /// Returns all of them that change the arm and are not the same as a slip in all links.
    #[must_use]
    pub fn candidates(robot: &Robot) -> Vec<Self> {
        let right = Computation::right(robot);
        let made = |slip: Self| {
            let mut computation = right.clone();
            slip.make(&mut computation);
            computation
        };
        let changes = |slip: &Self| {
            let made = made(*slip);
            let in_all = |link: LinkSlip| {
                let mut robot = robot.clone();
                link.everywhere(&mut robot);
                made.robot == robot
            };
            made != right && !matches!(slip, Self::Link(_, link) if in_all(*link))
        };
        (0..robot.joints.len()).flat_map(|joint| Self::of_joint(robot, joint)).filter(changes).collect()
    }

    /// Returns the slips of a joint, its row and its link, the likeliest first.
    fn of_joint(robot: &Robot, joint: usize) -> Vec<Self> {
        let Some(row) = robot.rows().nth(joint) else { return Vec::new() };
        // half a turn has no sign
        let mut all: Vec<Self> = (row.dh.alpha.sin != 0.0).then_some(Self::Alpha(joint)).into_iter().collect();
        all.extend((row.dh.theta.sin != 0.0).then_some(Self::Theta(joint)));
        all.extend((0..3).map(|axis| Self::Com(joint, axis)));
        // a link of a tree may have several other ends
        let has_ends =
            |link: &LinkSlip| robot.is_serial() || !matches!(link, LinkSlip::ComFromOtherEnd | LinkSlip::ComOfOtherEnd);
        let is_twisted =
            |link: &LinkSlip| *link != LinkSlip::InertiaNotTwisted || robot.convention == Convention::Standard;
        all.extend(LinkSlip::ALL.into_iter().filter(has_ends).filter(is_twisted).map(|link| Self::Link(joint, link)));
        all.extend([-3, 3, -1, 1, -2, 2].map(|power| Self::Mass(joint, power)));
        all.extend([Self::Lengths(joint), Self::Angles(joint)]);
        all.extend(joint.checked_sub(1).map(|before| Self::Inertia(joint, before)));
        all.extend((joint + 1 < robot.joints.len()).then_some(Self::Inertia(joint, joint + 1)));
        if row.kind == JointKind::Revolute {
            all.extend([1, 2, -1].map(|quarters| Self::Zero(joint, quarters)));
        }
        all.extend((!robot.has_couplings()).then_some(Self::Axis(joint)));
        all
    }

    /// Changes a computation as the slip does.
    pub(crate) fn make(self, of: &mut Computation) {
        let robot = &mut of.robot;
        let inertia_of = |joint: usize| robot.joints.get(joint).map(|joint| joint.row.link.inertia);
        if let Self::Inertia(_, other) = self {
            let other = inertia_of(other);
            let link = robot.joints.get_mut(self.joint()).map(|joint| &mut joint.row.link);
            link.into_iter().zip(other).for_each(|(link, other)| link.inertia = other);
            return;
        }
        if let Self::Link(joint, link) = self {
            return link.make(robot, joint);
        }
        let Some(Row { dh, link, .. }) = robot.joints.get_mut(self.joint()).map(|joint| &mut joint.row) else { return };
        let reversed = |angle: &mut Angle| *angle = Angle::new(-angle.radians);
        match self {
            Self::Alpha(_) => reversed(&mut dh.alpha),
            Self::Theta(_) => reversed(&mut dh.theta),
            Self::Com(_, axis) => link.com.iter_mut().skip(axis).take(1).for_each(|c| *c = -*c),
            Self::Mass(_, power) => link.mass *= 10_f64.powi(power.into()),
            Self::Lengths(_) => std::mem::swap(&mut dh.a, &mut dh.d),
            Self::Angles(_) => std::mem::swap(&mut dh.alpha, &mut dh.theta),
            Self::Zero(_, quarters) => dh.theta = Angle::new(dh.theta.radians + f64::from(quarters) * FRAC_PI_2),
            Self::Axis(joint) => of.factors.push((joint, SQRT_2)),
            Self::Inertia(..) | Self::Link(..) => {}
        }
    }

    /// Returns the joint that is concerned.
    pub(crate) const fn joint(self) -> usize {
        match self {
            Self::Alpha(joint)
            | Self::Theta(joint)
            | Self::Com(joint, _)
            | Self::Link(joint, _)
            | Self::Mass(joint, _)
            | Self::Lengths(joint)
            | Self::Angles(joint)
            | Self::Inertia(joint, _)
            | Self::Zero(joint, _)
            | Self::Axis(joint) => joint,
        }
    }

    /// Returns the name for programs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Alpha(_) => "alpha_of_one_row_reversed",
            Self::Theta(_) => "theta_of_one_row_reversed",
            Self::Com(..) => "com_of_one_link_reversed",
            Self::Link(_, LinkSlip::InertiaAboutOrigin) => "inertia_of_one_link_about_origin",
            Self::Link(_, LinkSlip::InertiaShifted) => "inertia_of_one_link_shifted",
            Self::Link(_, LinkSlip::ProductsOfInertia) => "products_of_one_link",
            Self::Link(_, LinkSlip::InertiaNotTwisted) => "inertia_of_one_link_not_twisted",
            Self::Link(_, LinkSlip::ComReversed) => "com_vector_of_one_link_reversed",
            Self::Link(_, LinkSlip::ComFromOtherEnd) => "com_of_one_link_from_other_end",
            Self::Link(_, LinkSlip::ComOfOtherEnd) => "com_of_one_link_of_other_end",
            Self::Mass(..) => "mass_of_one_link",
            Self::Lengths(_) => "a_and_d_of_one_row_exchanged",
            Self::Angles(_) => "alpha_and_theta_of_one_row_exchanged",
            Self::Inertia(..) => "inertia_of_another_link",
            Self::Zero(..) => "zero_of_one_joint",
            Self::Axis(_) => "axis_of_one_joint",
        }
    }

    /// Describes the mistake of the other computation in a clause.
    #[must_use]
    pub fn says(self, robot: &Robot) -> String {
        let [row, joint, link] = self.places(robot);
        match self {
            Self::Alpha(_) => format!("`alpha` of {row} has the other sign"),
            Self::Theta(_) => format!("{} of {row} has the other sign", self.theta(robot)),
            Self::Com(_, axis) => {
                format!("{} of the centre of mass of {link} has the other sign", ["x", "y", "z"][axis.min(2)])
            }
            Self::Link(_, slip) => format!("in {link} alone, {}", slip.in_all().says(robot)),
            Self::Mass(_, power @ 0..) => {
                format!("the mass of {link} is multiplied by {}", 10_i32.pow(power.unsigned_abs().into()))
            }
            Self::Mass(_, power) => {
                format!("the mass of {link} is divided by {}", 10_i32.pow(power.unsigned_abs().into()))
            }
            Self::Lengths(_) => format!("`a` and `d` of {row} are exchanged"),
            Self::Angles(_) => format!("`alpha` and `theta` of {row} are exchanged"),
            Self::Inertia(_, other) => format!("{link} has the inertia of link {}", other + 1),
            Self::Zero(_, quarters) => {
                format!("the zero position of {joint} is turned by {}°", i32::from(quarters) * 90)
            }
            Self::Axis(_) => {
                format!(
                    "the axis of {joint} has the length √2: its speed, acceleration and torque are √2 times as large"
                )
            }
        }
    }

    /// Describes the correct number, that in the file.
    #[must_use]
    pub fn right(self, robot: &Robot) -> String {
        let Some(Row { dh, link, .. }) = robot.rows().nth(self.joint()) else { return String::new() };
        let source = "check in the source of the numbers which is right";
        let [alpha, theta] = [dh.alpha, dh.theta].map(|angle| six_digits(angle.radians));
        match self {
            Self::Alpha(_) => format!("in the file it is {alpha} rad; {source}"),
            Self::Theta(_) => format!("in the file it is {theta} rad; {source}"),
            Self::Com(_, axis) => format!("in the file it is {} m; {source}", six_digits(link.com[axis.min(2)])),
            Self::Link(_, slip) => slip.in_all().right(robot),
            Self::Mass(..) => format!("in the file the mass is {} kg; {source}", six_digits(link.mass)),
            Self::Lengths(_) => format!(
                "in the file `a`, along x, is {} m, and `d`, along z, is {} m; {source}",
                six_digits(dh.a),
                six_digits(dh.d)
            ),
            Self::Angles(_) => {
                format!("in the file `alpha`, about x, is {alpha} rad, and `theta`, about z, is {theta} rad; {source}")
            }
            Self::Inertia(..) => "each link has its own inertia; compare the order of the links".to_owned(),
            Self::Zero(..) => format!("the joint angle is theta + q; in the file `theta` is {theta} rad"),
            Self::Axis(_) => "the axis of a joint is a unit vector: [1, 1, 0] is [0.7071, 0.7071, 0]".to_owned(),
        }
    }

    /// The words for its row, its joint and its link.
    fn places(self, robot: &Robot) -> [String; 3] {
        let (number, name) = (self.joint() + 1, robot.joints.get(self.joint()).map_or("", |joint| &joint.name));
        ["row", "joint", "link"].map(|place| format!("{place} {number} ({name})"))
    }

    fn theta(self, robot: &Robot) -> &'static str {
        let kind = robot.rows().nth(self.joint()).map_or(JointKind::Revolute, |row| row.kind);
        if kind == JointKind::Revolute { "the constant `theta`" } else { "`theta`" }
    }
}
