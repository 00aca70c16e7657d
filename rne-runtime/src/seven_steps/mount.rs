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
//! p is the parent link, n the link of the tip; row i of a modified table carries the twist and the length before joint
//! i. On the base the rotation of a standard table is 1, and c̄_p = 0 where the world holds it. R_t and p_t are the
//! tool's.
//!
//! In a tree a row may begin at a placement R_b, p_b in the link frame of its parent. It then stands before the row:
//!
//! ```text
//! standard    Rx(α_p) R_b       Rx(α_p) p_b
//! modified    R_b Rx(α_i)       R_b (a_i, 0, 0) + p_b
//! ```

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, FixedFrame, Row};

use crate::seven_steps::link_frame::{Table, rotation_of, rotation_x, turned_com};
use crate::{Constant, Scalar};

/// Where a joint, or the tip frame, is mounted on its parent link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mount<S> {
    /// Turns components in the axes of the joint at θ = 0, or of the tip frame, into components in those of the parent.
    pub(crate) rotation: Matrix3<S>,
    /// From the parent's centre of mass to the joint's reference point J, or to the tip; from the origin of frame 0 on
    /// a base that the world holds.
    pub(crate) r: Vector3<S>,
    /// To the same point from the end of the parent's offset.
    pub(crate) lever: Vector3<S>,
}

impl<S: Constant> Mount<S> {
    /// Returns the mount of the joint of `table.rows[joint]`.
    pub(crate) fn of_joint(table: Table<'_, S>, joint: usize) -> Self {
        let Table { convention, rows, floating_base, .. } = table;
        let (dh, carrier) = (&rows[joint].dh, table.parent(joint).map(|parent| &rows[parent]));
        let length = Vector3::new(dh.a, S::zero(), S::zero());
        let (rotation, lever) = match (table.placement(joint).map(|it| (rotation_of(it), it.xyz)), convention, carrier)
        {
            (None, Convention::Standard, None) => (Matrix3::identity(), Vector3::zeros()),
            (None, Convention::Standard, Some(carrier)) => (rotation_x(&carrier.dh.alpha), Vector3::zeros()),
            (None, Convention::Modified, _) => (rotation_x(&dh.alpha), length),
            (Some((turn, xyz)), Convention::Standard, None) => (turn, xyz.into()),
            (Some((turn, xyz)), Convention::Standard, Some(carrier)) => {
                let twist = rotation_x(&carrier.dh.alpha);
                (twist * turn, twist * Vector3::from(xyz))
            }
            (Some((turn, xyz)), Convention::Modified, _) => {
                (turn * rotation_x(&dh.alpha), turn * length + Vector3::from(xyz))
            }
        };
        let of_base = floating_base.map(|base| base.com);
        Self { rotation, lever, r: from_com(convention, carrier, of_base, lever) }
    }

    /// Returns the mount of the tip frame.
    pub(crate) fn of_tip(table: Table<'_, S>) -> Self {
        Self::of_frame(table.convention, table.rows, &table.tip())
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
        Self { rotation, lever, r: from_com(convention, carrier, None, lever) }
    }

    /// Converts the constants to the scalar of a computation.
    #[inline]
    pub(crate) fn to<T: Scalar>(self) -> Mount<T> {
        Mount { rotation: self.rotation.map(S::to), r: self.r.map(S::to), lever: self.lever.map(S::to) }
    }
}

/// The lever, from the centre of mass of the link of `carrier`, or from that of the base; a base that the world holds
/// has its own at the origin.
fn from_com<S: Constant>(
    convention: Convention,
    carrier: Option<&Row<S>>,
    of_base: Option<[S; 3]>,
    lever: Vector3<S>,
) -> Vector3<S> {
    match (carrier, of_base) {
        (Some(carrier), _) => lever - turned_com(convention, carrier),
        (None, Some(com)) => lever - Vector3::from(com),
        (None, None) => lever,
    }
}
