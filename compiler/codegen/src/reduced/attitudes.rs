//! Links that always turn alike: opposite sides of a parallelogram, joints that follow another one equally.
//!
//! The moment of a link depends on its second moments through antisym(U S) alone, and links that turn alike have one U.
//! So one of them can have the second moments of all (the reduced form, section 4.6).

use std::collections::BTreeMap;

use rne_model::JointKind::Prismatic;

use crate::ir::Number;
use crate::reduced::link_parameters::{apply, compose, transpose};
use crate::reduced::{IDENTITY, JointFrames, Square, Triple};

/// Σ ratio · coordinate, without those of ratio zero.
type Turning = BTreeMap<usize, Number>;

/// The attitude of links that turn alike: it turns about a fixed axis of another attitude.
struct Attitude {
    /// The attitude about whose axis it turns; `None` for that of the base.
    on: Option<usize>,
    /// The axis, in the axes of the attitude `on`.
    axis: Triple,
    turning: Turning,
    /// Its axes where nothing turns, in those of the attitude `on`.
    at_rest: Square,
    /// The first revolute link that has it.
    first: usize,
}

/// The axes of a link: those of an attitude (`None`: the base), turned.
type Axes = (Option<usize>, Square);

/// For each link, the link that has its second moments, and the rotation from its axes to the axes of this holder;
/// `None` for a link that never turns. On a floating base, such a link turns as the base. A prismatic link
/// gives its second moments to its parent, so it is its own holder here.
pub(crate) fn holders(joint_frames: &JointFrames) -> Vec<Option<(usize, Square)>> {
    let rows = &joint_frames.rows;
    // that of a floating base, which stands behind the links
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

/// The axes of a revolute link on a link with the axes `of_parent`.
fn attitude(joint_frames: &JointFrames, attitudes: &mut Vec<Attitude>, index: usize, of_parent: Axes) -> Axes {
    let row = &joint_frames.rows[index];
    let (mut on, mut at_rest) = (of_parent.0, compose(&of_parent.1, &row.rotation()));
    let mut axis = apply(&of_parent.1, row.along_axis(Number::ONE));
    let mut turning = Turning::new();
    for (coordinate, ratio) in joint_frames.coordinates.followed(index) {
        turning.insert(coordinate, joint_frames.embedding.decimal(if row.reversed { -ratio } else { ratio }));
    }
    while let Some(parent) = on.map(|on| &attitudes[on]) {
        // the turns of both are one if the axes are parallel
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
        // the base is turned into the frame of each joint on it
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

/// 1 or -1, where one unit vector is this multiple of the other.
fn ratio_of_axes(a: Triple, b: Triple) -> Option<Number> {
    let signs = [Number::ONE, -Number::ONE];
    signs.into_iter().find(|&sign| (0..3).all(|i| (a[i] - sign * b[i]).is_zero()))
}
