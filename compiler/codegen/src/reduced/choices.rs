//! The choices of the reduced form for one robot, as data that plan files store.

use std::fmt;
use std::str::FromStr;

use crate::named::named;
use crate::reduced::{Entry, FrameChoice};

/// All choices for one robot. By default none is made: the parameters are regrouped, and nothing else.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[allow(clippy::struct_excessive_bools)] // independent choices
pub struct Plan {
    /// Whether inertial parameters on joint axes are moved to the link before (section 4). Every plan file has this on.
    pub regrouped: bool,
    /// Whether the last link is taken as a spinning sphere without mass (section 5.6).
    pub gyrostat: bool,
    /// Whether the last frame is turned so that h_y vanishes (section 5.8).
    pub turned_last_frame: bool,
    /// Whether prismatic links keep the axes of the revolute link before (section 5.9).
    pub carried_prismatics: bool,
    /// The number of the arm that gives λ, the factor of lengths in the outward pass (section 3.5).
    pub length_scale: Scale,
    /// The number of the arm that gives μ, the factor of forces in the inward pass (section 3.5).
    pub force_scale: Scale,
    /// The form of the moment of a floating base (section 3.3).
    pub base_moment: Moment,
    /// The choices of each joint, base to tip.
    pub joints: Vec<JointPlan>,
}

/// The choices of one joint.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
pub struct JointPlan {
    /// The three parameters that the rods of mass on this joint's axis set to zero (section 4.5).
    pub targets: [RegroupingTarget; 3],
    /// The position of the frame's origin on the joint axis (section 5.4).
    pub origin_shift: OriginShift,
    /// The frame in which the offset along the axis is added in the outward pass (section 5.2).
    pub outward_offset: Side,
    /// The frame in which this offset is added in the inward pass.
    pub inward_offset: Side,
    /// The form of the link's moment (section 3.3).
    pub moment: Moment,
    /// The number that gives λ, for a joint on the base and all joints after it. If this and `force_scale` are both the
    /// default, λ and μ are those of the arm (section 3.5). Other joints have no scales.
    pub length_scale: Scale,
    /// The number that gives μ, for a joint on the base and all joints after it.
    pub force_scale: Scale,
    /// The choices that are on or off.
    pub switches: Switches,
}

impl JointPlan {
    /// Takes over each choice that differs between `from` and `to`, two versions of another joint's choices.
    pub fn follow(&mut self, from: &Self, to: &Self) {
        fn put<T: Copy + PartialEq>(choice: &mut T, from: T, to: T) {
            if from != to {
                *choice = to;
            }
        }
        put(&mut self.targets, from.targets, to.targets);
        put(&mut self.origin_shift, from.origin_shift, to.origin_shift);
        put(&mut self.outward_offset, from.outward_offset, to.outward_offset);
        put(&mut self.inward_offset, from.inward_offset, to.inward_offset);
        put(&mut self.moment, from.moment, to.moment);
        put(&mut self.length_scale, from.length_scale, to.length_scale);
        put(&mut self.force_scale, from.force_scale, to.force_scale);
        for (place, (old, new)) in from.switches.list().iter().zip(to.switches.list()).enumerate() {
            if let Some(on) = self.switches.at(place) {
                put(on, old.1, new.1);
            }
        }
    }
}

impl Plan {
    /// Returns this plan after each joint's changes since the plan `from` are made at other joints, too: `alike`
    /// returns, for each joint, the joints that follow it.
    #[must_use]
    pub fn followed<'a>(mut self, from: &Self, alike: impl Fn(usize) -> &'a [usize]) -> Self {
        let to = self.joints.clone();
        for (index, (before, after)) in from.joints.iter().zip(&to).enumerate().filter(|(_, (a, b))| a != b) {
            for &other in alike(index) {
                self.joints[other].follow(before, after);
            }
        }
        self
    }
}

macro_rules! switches {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {
        /// The choices of a joint that are on or off.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
        #[allow(clippy::struct_excessive_bools)] // independent choices
        pub struct Switches { $($(#[$doc])* pub $name: bool),* }

        impl Switches {
            /// The names of these choices in a plan file.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($name)),*];

            /// Returns each choice with its name.
            #[must_use]
            pub fn list(&self) -> [(&'static str, bool); Self::NAMES.len()] {
                [$((stringify!($name), self.$name)),*]
            }

            /// Returns one choice by its place in `NAMES`.
            pub fn at(&mut self, index: usize) -> Option<&mut bool> {
                [$(&mut self.$name),*].into_iter().nth(index)
            }
        }
    };
}

switches! {
    /// U z is the same for both links of this axis, and is computed once (section 5.3).
    axis_column,
    /// Vectors are rotated with seven products in the outward pass (section 5.1).
    scaled_twist_outward,
    /// Vectors are rotated with seven products in the inward pass (section 5.1).
    scaled_twist_inward,
    /// The acceleration of the next joint's origin is computed in frame N, which does not turn with this joint (section
    /// 5.7).
    origin_unturned,
    /// ω̇ is computed in frame N, which does not turn with this joint.
    omega_dot_unturned,
    /// The force and the moment of the first moment are computed in frame N, which does not turn with this joint.
    first_moment_unturned,
    /// The moment of the second moments is computed in frame N, which does not turn with this joint.
    second_moment_unturned,
    /// The wrench of the next joint is added in frame N, which does not turn with this joint.
    wrench_unturned,
    /// ω is rotated from frame N of the group of parallel axes by the summed angle (section 5.5).
    group_omega,
    /// ω̇ is rotated from frame N of the group of parallel axes by the summed angle.
    group_omega_dot,
    /// The acceleration is rotated from frame N of the group of parallel axes by the summed angle.
    group_acceleration,
    /// The wrench is passed to the parent in frame N of the group, without rotation.
    group_wrench,
}

named! {
    /// A parameter that a rod of mass sets to zero: one of the link's own, or one of the link before.
    #[derive(Default)]
    RegroupingTarget, "target" {
        /// The link's own: mass, h_z and S33 in this order.
        #[default] Own = "own",
        /// h_x of the link before.
        Hx = "parent_hx",
        /// h_y of the link before.
        Hy = "parent_hy",
        /// S11 of the link before.
        Sxx = "parent_s11",
        /// S22 of the link before.
        Syy = "parent_s22",
        /// S12 of the link before.
        Sxy = "parent_s12",
        /// S13 of the link before.
        Sxz = "parent_s13",
        /// S23 of the link before.
        Syz = "parent_s23",
        /// S11 - S22 of the link before.
        Difference = "parent_s11_s22",
    }
}

impl RegroupingTarget {
    /// The parameters that each of the three rods of an axis may set to zero.
    pub const CHOICES: [&'static [Self]; 3] = [
        &[Self::Own, Self::Hx, Self::Hy],
        &[Self::Own, Self::Hy, Self::Hx, Self::Syz, Self::Sxz],
        &[Self::Own, Self::Syy, Self::Sxx, Self::Syz, Self::Sxz, Self::Sxy, Self::Difference],
    ];

    /// Returns the parameter of the link before; `None` for the link's own.
    pub(crate) const fn entry(self) -> Option<Entry> {
        Some(match self {
            Self::Own => return None,
            Self::Hx => Entry::H(0),
            Self::Hy => Entry::H(1),
            Self::Sxx => Entry::S(0, 0),
            Self::Syy => Entry::S(1, 1),
            Self::Sxy => Entry::S(0, 1),
            Self::Sxz => Entry::S(0, 2),
            Self::Syz => Entry::S(1, 2),
            Self::Difference => Entry::Difference,
        })
    }
}

named! {
    /// A rule for where a frame's origin is on its joint axis; each rule gives a shift along the axis.
    #[derive(Default)]
    OriginShift, "origin shift" {
        /// No shift: the origin is where the table has it.
        #[default] None = "none",
        /// Shift by -d: the offset is moved to the next joint.
        MinusD = "minus_d",
        /// The shift that makes S13 zero.
        AnnulS13 = "annul_s13",
        /// The shift that makes S23 zero.
        AnnulS23 = "annul_s23",
        /// Shift by the sum of the offsets of all parallel axes after this one in its group.
        GroupInward = "group_inward",
        /// Shift by the offset of the next axis.
        NextOffset = "next_offset",
        /// Shift by the offset of the next axis minus the own one.
        NextLessOwn = "next_less_own",
        /// Shift by minus the sum of the offsets of the group's parallel axes up to this one.
        GroupOutward = "group_outward",
        /// The shift with which one point mass makes both h_x and h_y of the link before zero.
        AnnulParentH = "annul_parent_h",
    }
}

named! {
    /// The frame in which an offset along an axis is added.
    #[derive(Default)]
    Side, "side" {
        /// In the link's frame.
        #[default] Link = "link",
        /// In the axes of the link before.
        Parent = "parent",
        /// In frame N on the joint axis, which does not turn with the joint.
        Joint = "joint",
    }
}

named! {
    /// Three equal forms of the formula for a link's moment.
    #[derive(Default)]
    Moment, "moment" {
        /// antisym(U S), with the second moments S.
        #[default] Second = "second",
        /// antisym(U S), but with the diagonal of S multiplied by angular accelerations and products of rates.
        Diagonal = "diagonal",
        /// J ω̇ + ω × J ω, with the inertia J.
        Inertia = "inertia",
    }
}

/// The number of the robot by which lengths or forces are scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub enum Scale {
    /// For lengths: λ = 1. For forces: μ = 1/λ.
    #[default]
    Default,
    /// No scale.
    One,
    /// The length a of a row of the table, counted from 1.
    A(usize),
    /// The offset d of a row of the table, counted from 1.
    D(usize),
    /// A component of a link's first moment: link from 1, axis 0 to 2.
    FirstMoment(usize, usize),
    /// The mass of a link, counted from 1.
    Mass(usize),
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Default => f.write_str("default"),
            Self::One => f.write_str("one"),
            Self::A(row) => write!(f, "a{row}"),
            Self::D(row) => write!(f, "d{row}"),
            Self::FirstMoment(link, axis) => write!(f, "h{link}_{}", ["x", "y", "z"][axis % 3]),
            Self::Mass(link) => write!(f, "m{link}"),
        }
    }
}

/// Parses a number that has digits only: no sign, which the standard library would accept.
pub(crate) fn count(digits: &str) -> Option<usize> {
    let is_plain = digits.chars().all(|c| c.is_ascii_digit()) && (digits == "0" || !digits.starts_with('0'));
    if is_plain { digits.parse().ok() } else { None }
}

impl FromStr for Scale {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |digits: &str| count(digits).filter(|&joint| joint > 0);
        let scale = match text {
            "default" => Some(Self::Default),
            "one" => Some(Self::One),
            _ => match (text.get(..1), text.get(1..)) {
                (Some("a"), Some(digits)) => number(digits).map(Self::A),
                (Some("d"), Some(digits)) => number(digits).map(Self::D),
                (Some("m"), Some(digits)) => number(digits).map(Self::Mass),
                (Some("h"), Some(rest)) => rest.split_once('_').and_then(|(digits, axis)| {
                    Some(Self::FirstMoment(number(digits)?, ["x", "y", "z"].iter().position(|one| *one == axis)?))
                }),
                _ => None,
            },
        };
        scale.ok_or_else(|| {
            format!(
                "`{text}` is not a valid scale; the valid words are `default`, `one`, `a2`, `d2`, `h2_x` and `m2` for \
                 any joint number"
            )
        })
    }
}

impl Plan {
    /// Returns the plan in which no choice is made.
    #[must_use]
    pub fn new(dof: usize) -> Self {
        Self {
            regrouped: true,
            gyrostat: false,
            turned_last_frame: false,
            carried_prismatics: false,
            length_scale: Scale::Default,
            force_scale: Scale::Default,
            base_moment: Moment::Second,
            joints: vec![JointPlan::default(); dof],
        }
    }

    /// Returns the choices in words: those of the arm, then those of each joint; choices that are not made are left
    /// out.
    #[must_use]
    pub fn choices(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let of_the_arm = [
            (self.regrouped, "matter on joint axes belongs to the link before".to_owned()),
            (self.gyrostat, "the last link is a spinning sphere without mass".to_owned()),
            (self.turned_last_frame, "the last frame is turned so that h_y vanishes".to_owned()),
            (self.carried_prismatics, "prismatic links keep the axes of the revolute link before".to_owned()),
            (self.length_scale != Scale::Default, format!("lengths are measured in {}", self.length_scale)),
            (self.force_scale != Scale::Default, format!("forces are measured by {}", self.force_scale)),
            (self.base_moment != Moment::default(), format!("moment of the base: {}", self.base_moment)),
        ];
        lines.extend(of_the_arm.into_iter().filter(|(made, _)| *made).map(|(_, words)| words));
        for (index, joint) in self.joints.iter().enumerate() {
            let plain = JointPlan::default();
            let [first, second, third] = joint.targets;
            let mut words: Vec<String> = [
                (joint.targets != plain.targets, format!("targets ({first}, {second}, {third})")),
                (joint.origin_shift != plain.origin_shift, format!("slide {}", joint.origin_shift)),
                (joint.outward_offset != plain.outward_offset, format!("outward offset at {}", joint.outward_offset)),
                (joint.inward_offset != plain.inward_offset, format!("inward offset at {}", joint.inward_offset)),
                (joint.moment != plain.moment, format!("moment {}", joint.moment)),
                (joint.length_scale != plain.length_scale, format!("lengths behind it in {}", joint.length_scale)),
                (joint.force_scale != plain.force_scale, format!("forces behind it by {}", joint.force_scale)),
            ]
            .into_iter()
            .filter(|(made, _)| *made)
            .map(|(_, words)| words)
            .collect();
            words.extend(joint.switches.list().iter().filter(|(_, on)| *on).map(|(name, _)| name.replace('_', " ")));
            if !words.is_empty() {
                lines.push(format!("joint {}: {}", index + 1, words.join(", ")));
            }
        }
        lines
    }

    /// Returns the plan without scales.
    pub(crate) fn unscaled(mut self) -> Self {
        (self.length_scale, self.force_scale) = (Scale::Default, Scale::Default);
        for joint in &mut self.joints {
            (joint.length_scale, joint.force_scale) = (Scale::Default, Scale::Default);
        }
        self
    }

    pub(crate) fn frames(&self) -> FrameChoice {
        FrameChoice { turned_last: self.turned_last_frame, carried: self.carried_prismatics, floating: false }
    }
}
