//! Several joints on one link: subexpressions that their formulas share (the reduced form, section 15).
//!
//! Joints to the left and right of a plane of symmetry have lengths that differ only in sign. Then one length can
//! multiply the sum or the difference of two forces, and the part of U p that both joints share is added to a once.

use crate::ir::{Builder, Number, Vector};
use crate::reduced::{Arm, Motion, Triple, Wrench};

/// Whether two lengths are equal but for the sign, and not zero.
fn is_common(a: Number, b: Number) -> bool {
    !a.is_zero() && (a == b || a == -b)
}

/// Returns how many components two vectors to joints share, up to the sign.
fn common(a: Triple, b: Triple) -> usize {
    (0..3).filter(|&axis| is_common(a[axis], b[axis])).count()
}

/// Returns the component of p along one axis, as a vector.
fn along(builder: &Builder, p: Triple, axis: usize) -> Vector<'_> {
    let mut alone = Triple::default();
    alone[axis] = p[axis];
    builder.vector(alone)
}

/// Returns the sum of the wrenches of several joints about the origin of the link's frame; each of them is given about
/// a point p of the link.
pub(crate) fn gathered<'s>(builder: &'s Builder, mut carried: Vec<(Wrench<'s>, Triple)>) -> Wrench<'s> {
    // joints that share more lengths come first
    let lengths: Vec<Triple> = carried.iter().map(|(_, p)| *p).collect();
    carried.sort_by_key(|(_, p)| std::cmp::Reverse(lengths.iter().map(|other| common(*p, *other)).sum::<usize>()));
    let mut sum = carried.iter().map(|(wrench, _)| *wrench).fold(Wrench::zero(builder), Wrench::plus);
    for axis in 0..3 {
        let mut left: Vec<&(Wrench<'s>, Triple)> = carried.iter().filter(|(_, p)| !p[axis].is_zero()).collect();
        while let Some((_, first)) = left.first() {
            let of_length = |(_, p): &&&(Wrench<'s>, Triple)| is_common(first[axis], p[axis]);
            let force = left.iter().filter(of_length).fold(builder.no_vector(), |force, (wrench, p)| {
                if p[axis] == first[axis] { force + wrench.force } else { force - wrench.force }
            });
            sum.moment = sum.moment + along(builder, *first, axis).cross(force);
            let first = first[axis];
            left.retain(|(_, p)| !is_common(first, p[axis]));
        }
    }
    sum
}

/// Returns a + U p of a joint; the terms that another joint on the link shares come first, so that they are computed
/// once.
pub(crate) fn point_acceleration<'s>(arm: &Arm<'_, 's>, index: usize, link: &Motion<'s>, p: Triple) -> Vector<'s> {
    let rows = arm.rows();
    let others = (0..rows.len()).filter(|&other| other != index && rows[other].parent == rows[index].parent);
    let shared = others.map(|other| arm.outward_point(other)).max_by_key(|other| common(p, *other));
    let Some(other) = shared.filter(|other| common(p, *other) > 0) else {
        return link.acceleration + link.gradient.of(arm.builder.vector(p));
    };
    let part = |axis: usize| link.gradient.of(along(arm.builder, p, axis));
    let of = |test: &dyn Fn(usize) -> bool| (0..3).filter(|&axis| test(axis)).map(part).reduce(|sum, part| sum + part);
    let parts = [
        of(&|axis| p[axis] == other[axis]),
        of(&|axis| p[axis] != other[axis] && is_common(p[axis], other[axis])),
        of(&|axis| !p[axis].is_zero() && p[axis] != other[axis] && !is_common(p[axis], other[axis])),
    ];
    parts.into_iter().flatten().fold(link.acceleration, |sum, part| sum + part)
}
