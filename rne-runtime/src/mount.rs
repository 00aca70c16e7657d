//! Where joints and the tip frame are mounted: the constants between a link and what is fastened to it.
//!
//! A mount belongs to the joint, not to the link that carries it: a link has as many as joints stand on it.
//!
//! ```text
//!             rotation          lever l_i           r_i             of the tip: rotation     lever
//! standard    Rx(α_p)           0                   l_i - Rx(α_p) c̄_p           Rx(α_n) R_t      Rx(α_n) p_t
//! modified    Rx(α_i)           (a_i, 0, 0)         l_i - c̄_p                   R_t              p_t
//! ```
//!
//! p is the parent link, n the last one; row i of a modified table carries the twist and the length before joint i. On
//! the base the rotation of a standard table is 1, and c̄_p = 0. R_t and p_t are the tool's.

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, FixedFrame, Row, Transform, parent};

use crate::link_frame::{rotation_of, rotation_x, turned_com};
use crate::{Constant, Scalar};

/// Where a joint, or the tip frame, is mounted on its parent link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mount<S> {
    /// Turns components in the axes of the joint at θ = 0, or of the tip frame, into components in those of the parent.
    pub(crate) rotation: Matrix3<S>,
    /// From the parent's centre of mass to the joint's reference point J, or to the tip; of the base, from the origin
    /// of frame 0.
    pub(crate) r: Vector3<S>,
    /// To the same point from the end of the parent's offset.
    pub(crate) lever: Vector3<S>,
}

impl<S: Constant> Mount<S> {
    /// Returns the mount of the joint of `rows[joint]`.
    pub(crate) fn of_joint(convention: Convention, rows: &[Row<S>], joint: usize) -> Self {
        let (row, carrier) = (&rows[joint], parent(joint).map(|parent| &rows[parent]));
        let (rotation, lever) = match convention {
            Convention::Standard => {
                let rotation = carrier.map_or_else(Matrix3::identity, |carrier| rotation_x(&carrier.dh.alpha));
                (rotation, Vector3::zeros())
            }
            Convention::Modified => (rotation_x(&row.dh.alpha), Vector3::new(row.dh.a, S::zero(), S::zero())),
        };
        Self { rotation, lever, r: from_com(convention, carrier, lever) }
    }

    /// Returns the mount of the tip frame, on the last link.
    pub(crate) fn of_tip(convention: Convention, rows: &[Row<S>], tool: &Transform<S>) -> Self {
        Self::of_frame(convention, rows, &FixedFrame { on: rows.len().checked_sub(1), placement: *tool })
    }

    /// Returns the mount of a frame that is fixed to a link.
    pub(crate) fn of_frame(convention: Convention, rows: &[Row<S>], frame: &FixedFrame<S>) -> Self {
        let FixedFrame { on, placement } = frame;
        let (carrier, rotation, lever) = (on.map(|on| &rows[on]), rotation_of(placement), Vector3::from(placement.xyz));
        let (rotation, lever) = match (convention, carrier) {
            (Convention::Standard, Some(carrier)) => {
                let twist = rotation_x(&carrier.dh.alpha);
                (twist * rotation, twist * lever)
            }
            _ => (rotation, lever),
        };
        Self { rotation, lever, r: from_com(convention, carrier, lever) }
    }

    /// Converts the constants to the scalar of a computation.
    #[inline]
    pub(crate) fn to<T: Scalar>(self) -> Mount<T> {
        Mount { rotation: self.rotation.map(S::to), r: self.r.map(S::to), lever: self.lever.map(S::to) }
    }
}

/// The lever, from the centre of mass of the link of `carrier`; the base has its own at the origin.
fn from_com<S: Constant>(convention: Convention, carrier: Option<&Row<S>>, lever: Vector3<S>) -> Vector3<S> {
    carrier.map_or(lever, |carrier| lever - turned_com(convention, carrier))
}
