//! Wrong signs in one row of the table, or in one link.

use rne_model::{Angle, JointKind, Robot};

/// A number of the table with the other sign. Joints count from 0, axes are 0 to 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Typo {
    /// `alpha` of a row.
    Alpha(usize),
    /// `theta` of a row: the constant part of the angle.
    Theta(usize),
    /// A component of the centre of mass of a link.
    Com(usize, usize),
}

impl Typo {
    /// Returns all wrong signs that change the arm: those of zero and of half a turn do not.
    #[must_use]
    pub fn candidates(robot: &Robot) -> Vec<Self> {
        let mut all = Vec::new();
        for (joint, row) in robot.rows().enumerate() {
            all.extend((row.dh.alpha.sin != 0.0).then_some(Self::Alpha(joint)));
            all.extend((row.dh.theta.sin != 0.0).then_some(Self::Theta(joint)));
            all.extend((0..3).filter(|&axis| row.link.com[axis] != 0.0).map(|axis| Self::Com(joint, axis)));
        }
        all
    }

    /// Changes the sign in a robot.
    pub(crate) fn make(self, robot: &mut Robot) {
        let Some(row) = robot.joints.get_mut(self.joint()).map(|joint| &mut joint.row) else { return };
        let reversed = |angle: &mut Angle| *angle = Angle::new(-angle.radians);
        match self {
            Self::Alpha(_) => reversed(&mut row.dh.alpha),
            Self::Theta(_) => reversed(&mut row.dh.theta),
            Self::Com(_, axis) => row.link.com.iter_mut().skip(axis).take(1).for_each(|c| *c = -*c),
        }
    }

    /// Returns the joint in whose row the number is.
    pub(crate) const fn joint(self) -> usize {
        match self {
            Self::Alpha(joint) | Self::Theta(joint) | Self::Com(joint, _) => joint,
        }
    }

    /// Returns the name for programs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Alpha(_) => "alpha_of_one_row_reversed",
            Self::Theta(_) => "theta_of_one_row_reversed",
            Self::Com(..) => "com_of_one_link_reversed",
        }
    }

    /// Returns the name of the number, its value in the file and its unit.
    fn number(self, robot: &Robot) -> (String, f64, &'static str) {
        let of_row = |key: &str| {
            let kind = robot.rows().nth(self.joint()).map_or(JointKind::Revolute, |row| row.kind);
            let constant = if key == "theta" && kind == JointKind::Revolute { "the constant " } else { "" };
            let name = robot.joints.get(self.joint()).map_or("", |joint| &joint.name);
            format!("{constant}`{key}` of row {} ({name})", self.joint() + 1)
        };
        let Some(row) = robot.rows().nth(self.joint()) else { return (String::new(), 0.0, "") };
        match self {
            Self::Alpha(_) => (of_row("alpha"), row.dh.alpha.radians, "rad"),
            Self::Theta(_) => (of_row("theta"), row.dh.theta.radians, "rad"),
            Self::Com(joint, axis) => {
                let what = format!("{} of the centre of mass of link {}", ["x", "y", "z"][axis.min(2)], joint + 1);
                (what, row.link.com[axis.min(2)], "m")
            }
        }
    }

    /// Describes the mistake of the other computation in a clause.
    #[must_use]
    pub fn says(self, robot: &Robot) -> String {
        format!("{} has the other sign", self.number(robot).0)
    }

    /// Describes the correct number, that in the file.
    #[must_use]
    pub fn right(self, robot: &Robot) -> String {
        let (what, value, unit) = self.number(robot);
        let value: f64 = format!("{value:.5e}").parse().unwrap_or(value);
        format!("in the file {what} is {value} {unit}; check in the source of the numbers which sign is right")
    }
}
