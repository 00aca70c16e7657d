//! Slips in the inertial numbers of a link, which people make in one link or in all of them.

use nalgebra::{Matrix3, Rotation3, Vector3};
use rne_model::{Convention, Inertia, Joint, JointKind, Link, Robot, Row};

use crate::slip::Slip;

/// A slip in the inertial numbers of one link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum LinkSlip {
    /// The inertia in the file is taken to be about the origin of the link frame.
    InertiaAboutOrigin,
    /// The term m (c² 1 - c cᵀ) is added to the inertia once more.
    InertiaShifted,
    /// The products of inertia xy, xz and yz have the other sign.
    ProductsOfInertia,
    /// The inertia of a standard table is not rotated by alpha into axes with z along the joint.
    InertiaNotTwisted,
    /// The centre of mass has the other sign.
    ComReversed,
    /// The centre of mass is taken from the frame at the other end of the link.
    ComFromOtherEnd,
    /// The vector from the other end of the link to the centre of mass is used as if it began at the link frame.
    ComOfOtherEnd,
}

impl LinkSlip {
    pub(crate) const ALL: [Self; 7] = [
        Self::ComFromOtherEnd,
        Self::ComReversed,
        Self::InertiaAboutOrigin,
        Self::InertiaShifted,
        Self::ProductsOfInertia,
        Self::InertiaNotTwisted,
        Self::ComOfOtherEnd,
    ];

    /// Returns the slip that makes this mistake in all links.
    pub(crate) const fn in_all(self) -> Slip {
        match self {
            Self::InertiaAboutOrigin => Slip::InertiaAboutOrigin,
            Self::InertiaShifted => Slip::InertiaShifted,
            Self::ProductsOfInertia => Slip::ProductsOfInertia,
            Self::InertiaNotTwisted => Slip::InertiaNotTwisted,
            Self::ComReversed => Slip::ComReversed,
            Self::ComFromOtherEnd => Slip::ComFromOtherEnd,
            Self::ComOfOtherEnd => Slip::ComOfOtherEnd,
        }
    }

    /// Makes the slip in all links.
    pub(crate) fn everywhere(self, robot: &mut Robot) {
        (0..robot.joints.len()).for_each(|index| self.make(robot, index));
    }

    /// Makes the slip in a link, counted from 0.
    pub(crate) fn make(self, robot: &mut Robot, index: usize) {
        let other_end = to_other_end(robot, index);
        let Some(Joint { row: Row { dh, link, .. }, .. }) = robot.joints.get_mut(index) else { return };
        let moved = |com: [f64; 3], times: f64| [0, 1, 2].map(|axis| com[axis] + times * other_end[axis]);
        match self {
            Self::InertiaAboutOrigin => link.inertia = shifted(link, -1.0),
            Self::InertiaShifted => link.inertia = shifted(link, 1.0),
            Self::ProductsOfInertia => {
                let Inertia { xy, xz, yz, .. } = link.inertia;
                link.inertia = Inertia { xy: -xy, xz: -xz, yz: -yz, ..link.inertia };
            }
            // rotated by -alpha, so that the rotation by alpha that follows gives the inertia of the file
            Self::InertiaNotTwisted => {
                let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), -dh.alpha.radians);
                link.inertia = tensor(turn * Matrix3::from(link.inertia.rows()) * turn.inverse());
            }
            Self::ComReversed => link.com = link.com.map(|c| -c),
            Self::ComFromOtherEnd => link.com = moved(link.com, 1.0),
            Self::ComOfOtherEnd => link.com = moved(link.com, -1.0),
        }
    }
}

/// Returns the inertia plus `times` m (c² 1 - c cᵀ).
fn shifted(link: &Link, times: f64) -> Inertia {
    let (c, own) = (Vector3::from(link.com), Matrix3::from(link.inertia.rows()));
    tensor(own + (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * (link.mass * times))
}

fn tensor(j: Matrix3<f64>) -> Inertia {
    Inertia { xx: j[(0, 0)], yy: j[(1, 1)], zz: j[(2, 2)], xy: j[(0, 1)], xz: j[(0, 2)], yz: j[(1, 2)] }
}

/// Returns the vector from the link frame to the other end of a link. A link has no other end if the joint there is
/// prismatic, or if there is no joint.
fn to_other_end(robot: &Robot, index: usize) -> [f64; 3] {
    let far = robot.convention == Convention::Modified;
    let Some(Joint { row, .. }) = robot.joints.get(index + usize::from(far)) else { return [0.0; 3] };
    if row.kind != JointKind::Revolute {
        return [0.0; 3];
    }
    // the vector between frames i-1 and i, in frame i for a standard table, in frame i-1 for a modified one
    let (dh, s, c) = (row.dh, row.dh.alpha.sin, row.dh.alpha.cos);
    if far { [dh.a, -dh.d * s, dh.d * c] } else { [-dh.a, -dh.d * s, -dh.d * c] }
}
