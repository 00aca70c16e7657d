//! Placements with numbers, and the frames within a row of the table.

use crate::robot::parent;
use crate::{Convention, FixedFrame, Joint, JointKind, Transform};

/// A rotation matrix, by rows, and a translation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) rotation: [[f64; 3]; 3],
    pub(crate) translation: [f64; 3],
}

impl Pose {
    pub(crate) const IDENTITY: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// Makes a rotation about an axis of the frame, 0 to 2 for x to z.
    fn turn(axis: usize, sin: f64, cos: f64) -> Self {
        let mut pose = Self::IDENTITY;
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        (pose.rotation[i][i], pose.rotation[i][j]) = (cos, -sin);
        (pose.rotation[j][i], pose.rotation[j][j]) = (sin, cos);
        pose
    }

    fn shift(translation: [f64; 3]) -> Self {
        Self { translation, ..Self::IDENTITY }
    }

    pub(crate) fn of(transform: &Transform) -> Self {
        let turn = |axis: usize| Self::turn(axis, transform.rpy[axis].sin, transform.rpy[axis].cos);
        Self::shift(transform.xyz).then(&turn(2)).then(&turn(1)).then(&turn(0))
    }

    pub(crate) fn then(&self, next: &Self) -> Self {
        let product = |row: [f64; 3], column: usize| (0..3).map(|k| row[k] * next.rotation[k][column]).sum();
        Self {
            rotation: self.rotation.map(|row| [0, 1, 2].map(|column| product(row, column))),
            translation: [0, 1, 2].map(|i| self.translation[i] + dot(self.rotation[i], next.translation)),
        }
    }

    /// Returns the inverse of the rotation, with no translation.
    pub(crate) fn turned_back(&self) -> Self {
        let rotation = [0, 1, 2].map(|row| [0, 1, 2].map(|column: usize| self.rotation[column][row]));
        Self { rotation, translation: [0.0; 3] }
    }

    /// Returns an axis of the frame, 0 to 2 for x to z.
    pub(crate) fn axis(&self, axis: usize) -> [f64; 3] {
        self.rotation.map(|row| row[axis])
    }
}

/// Returns the frame at a joint in the link frame of the link that carries the joint. Its z is the axis about which the
/// joint turns, or along which it slides.
pub(crate) fn axis_on_link(joints: &[Joint], convention: Convention, joint: usize) -> Pose {
    let start = joints[joint].branch.map_or(Pose::IDENTITY, |branch| Pose::of(&branch.placement));
    let dh = &joints[joint].row.dh;
    match convention {
        Convention::Standard => start,
        Convention::Modified => {
            start.then(&Pose::turn(0, dh.alpha.sin, dh.alpha.cos)).then(&Pose::shift([dh.a, 0.0, 0.0]))
        }
    }
}

/// Returns the link frame that a joint moves, relative to the frame at the joint, for a position of the joint, rad or
/// m.
pub(crate) fn link_behind_axis(joints: &[Joint], convention: Convention, joint: usize, position: f64) -> Pose {
    let row = &joints[joint].row;
    let dh = &row.dh;
    let turned = Pose::turn(2, dh.theta.sin, dh.theta.cos);
    let screw = match row.kind {
        JointKind::Revolute if position == 0.0 => turned.then(&Pose::shift([0.0, 0.0, dh.d])),
        JointKind::Revolute => {
            let (sin, cos) = libm::sincos(position);
            turned.then(&Pose::turn(2, sin, cos)).then(&Pose::shift([0.0, 0.0, dh.d]))
        }
        JointKind::Prismatic => turned.then(&Pose::shift([0.0, 0.0, dh.d + position])),
    };
    match convention {
        Convention::Standard => {
            screw.then(&Pose::shift([dh.a, 0.0, 0.0])).then(&Pose::turn(0, dh.alpha.sin, dh.alpha.cos))
        }
        Convention::Modified => screw,
    }
}

/// Returns the frame at a joint in frame 0, where all positions are 0.
pub(crate) fn axis_at_zero(joints: &[Joint], convention: Convention, joint: usize) -> Pose {
    let of_parent = link_at_zero(joints, convention, parent(joints, joint));
    of_parent.then(&axis_on_link(joints, convention, joint))
}

/// Returns the frame of a link in frame 0, where all positions are 0.
pub(crate) fn link_at_zero(joints: &[Joint], convention: Convention, link: Option<usize>) -> Pose {
    let Some(link) = link else { return Pose::IDENTITY };
    axis_at_zero(joints, convention, link).then(&link_behind_axis(joints, convention, link, 0.0))
}

/// Returns the joints that move a link, base first.
pub(crate) fn way(joints: &[Joint], on: Option<usize>) -> Vec<usize> {
    let mut way: Vec<usize> = std::iter::successors(on, |&joint| parent(joints, joint)).collect();
    way.reverse();
    way
}

/// Returns the joints that move one of two places on links of a tree and not the other, base first.
pub(crate) fn own_joints(joints: &[Joint], between: &[FixedFrame; 2]) -> [Vec<usize>; 2] {
    let ways = between.map(|place| way(joints, place.on));
    let shared = ways[0].iter().zip(&ways[1]).take_while(|(a, b)| a == b).count();
    ways.map(|way| way[shared..].to_vec())
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}
