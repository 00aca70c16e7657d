//! Links that always have the same angular velocity: opposite sides of a parallelogram, joints that follow another one
//! with ratio 1.
//!
//! The moment of a link depends on its second moments only through antisym(U S), and such links have the same U. So the
//! second moments of all of them can be given to one of them (the reduced form, section 4.6).

use std::collections::BTreeMap;

use rne_model::JointKind::Prismatic;

use crate::ir::Number;
use crate::reduced::link_parameters::{apply, compose, transpose};
use crate::reduced::{IDENTITY, JointFrames, Square, Triple};

/// A rotation angle Σ ratio · coordinate, without the terms whose ratio is zero.
type Turning = BTreeMap<usize, Number>;

/// The orientation that links with the same angular velocity share: it turns about a fixed axis of another orientation.
struct Attitude {
    /// The attitude in which the axis is fixed; `None` for the base.
    on: Option<usize>,
    /// The axis, in the axes of the attitude `on`.
    axis: Triple,
    turning: Turning,
    /// Rotation of this attitude at angle 0, in the axes of the attitude `on`.
    at_rest: Square,
    /// The first revolute link with this attitude.
    first: usize,
}

/// The axes of a link: an attitude (`None`: the base), and a constant rotation from it.
type Axes = (Option<usize>, Square);

/// Returns, for each link, the link to which its second moments are given, and the rotation from its axes to the axes
/// of that holder; `None` for a link that never turns. On a floating base, such a link turns with the base, so the base
/// is the holder. A prismatic link gives its second moments to its parent elsewhere, so it is its own holder here.
pub(crate) fn holders(joint_frames: &JointFrames) -> Vec<Option<(usize, Square)>> {
    let rows = &joint_frames.rows;
    // the holder of a floating base, which comes after those of the links
    let of_base = joint_frames.base.as_ref().map(|_| Some((rows.len(), IDENTITY)));
    if joint_frames.coordinates.is_every_joint() {
        return (0..rows.len()).map(|index| Some((index, IDENTITY))).chain(of_base).collect();
    }
    let mut attitudes: Vec<Attitude> = Vec::new();
    let mut axes: Vec<Axes> = Vec::with_capacity(rows.len());
    let mut holders = Vec::with_capacity(rows.len());
    for (index, row) in rows.iter().enumerate() {
        let of_parent = row.parent.map_or((None, IDENTITY), |parent| axes[parent]);
        if row.kind == Prismatic {
            axes.push((of_parent.0, compose(&of_parent.1, &row.rotation())));
            holders.push(Some((index, IDENTITY)));
            continue;
        }
        let (at, rotation) = attitude(joint_frames, &mut attitudes, index, of_parent);
        axes.push((at, rotation));
        let holder = at.map(|at| attitudes[at].first).or_else(|| joint_frames.base.as_ref().map(|_| rows.len()));
        holders.push(holder.map(|holder| (holder, rotation)));
    }
    holders.extend(of_base);
    holders
}

/// Returns the axes of a revolute link whose parent has the axes `of_parent`.
fn attitude(joint_frames: &JointFrames, attitudes: &mut Vec<Attitude>, index: usize, of_parent: Axes) -> Axes {
    let row = &joint_frames.rows[index];
    let (mut on, mut at_rest) = (of_parent.0, compose(&of_parent.1, &row.rotation()));
    let mut axis = apply(&of_parent.1, row.along_axis(Number::ONE));
    let mut turning = Turning::new();
    for (coordinate, ratio) in joint_frames.coordinates.followed(index) {
        turning.insert(coordinate, joint_frames.embedding.decimal(if row.reversed { -ratio } else { ratio }));
    }
    while let Some(parent) = on.map(|on| &attitudes[on]) {
        // if the axes are parallel, both rotations are one rotation by the summed angle
        let Some(sign) = ratio_of_axes(axis, apply(&transpose(&parent.at_rest), parent.axis)) else { break };
        for (&coordinate, &ratio) in &parent.turning {
            let sum = turning.entry(coordinate).or_insert(Number::ZERO);
            *sum = *sum + sign * ratio;
        }
        turning.retain(|_, ratio| !ratio.is_zero());
        (at_rest, axis) = (compose(&parent.at_rest, &at_rest), apply(&parent.at_rest, axis));
        on = parent.on;
    }
    if turning.is_empty() {
        return (on, at_rest);
    }
    let root = |link: usize| std::iter::successors(Some(link), |&link| joint_frames.rows[link].parent).last();
    let is_same = |other: &Attitude| {
        // the axes of a fixed base differ from joint to joint on it, so both links must be after the same joint on the
        // base
        let is_on_same = other.on == on && (on.is_some() || root(other.first) == root(index));
        is_on_same
            && ratio_of_axes(axis, other.axis).is_some_and(|sign| {
                let is_equal = |coordinate, ratio: &Number| {
                    turning.get(coordinate).is_some_and(|own| (*own - sign * *ratio).is_zero())
                };
                other.turning.len() == turning.len()
                    && other.turning.iter().all(|(coordinate, ratio)| is_equal(coordinate, ratio))
            })
    };
    if let Some(found) = attitudes.iter().position(is_same) {
        return (Some(found), compose(&transpose(&attitudes[found].at_rest), &at_rest));
    }
    attitudes.push(Attitude { on, axis, turning, at_rest, first: index });
    (Some(attitudes.len() - 1), IDENTITY)
}

/// Returns 1 or -1 if one unit vector is this multiple of the other, otherwise `None`.
fn ratio_of_axes(a: Triple, b: Triple) -> Option<Number> {
    let signs = [Number::ONE, -Number::ONE];
    signs.into_iter().find(|&sign| (0..3).all(|i| (a[i] - sign * b[i]).is_zero()))
}
