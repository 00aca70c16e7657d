//! Parallelograms: closed loops with four parallel axes whose opposite sides have equal lengths. Opposite sides stay
//! parallel, so the dependent joints are linear functions of the others, and the loop becomes couplings.
//!
//! The loop is a quadrangle of axes. From one link, two ways of joints lead to the cut joint. V0 is at this link, V1 at
//! the second joint of the first way, V2 at the cut joint, V3 at the last joint of the other way. If the other way has
//! one joint, V3 is the axis of this joint, and the side V3 V0 belongs to the link that carries it. If both ways have
//! two joints, their first axes must be one line, as in palletisers: the loop then has two degrees of freedom. The
//! angle of a side in the plane is the sum of the positions of the joints that turn it, counted about one direction,
//! plus its angle where all positions are 0.

use crate::parts::pose::{Pose, axis_at_zero, cross, difference, dot, link_at_zero, own_joints};
use crate::text::source::{quoted, six_digits};
use crate::{Convention, Coupling, FixedFrame, Joint, JointKind};

/// Relative difference below which lengths are equal, and difference below which directions are equal: tables have six
/// digits.
const TOLERANCE: f64 = 1e-6;

/// Returns the couplings of the two dependent joints, or the reason why the loop is no parallelogram.
pub(crate) fn couplings(
    between: &[FixedFrame; 2],
    dependent: [usize; 2],
    convention: Convention,
    joints: &[Joint],
) -> Result<[(usize, Coupling); 2], String> {
    let quadrangle = Quadrangle::of(between, convention, joints)?;
    let signs = quadrangle.signs()?;
    let sides = quadrangle.sides()?;
    let ([a, b], (c, d)) = (quadrangle.first, quadrangle.other);
    let sign = |joint: usize| signs.iter().find(|(other, _)| *other == joint).map_or(0.0, |(_, sign)| *sign);
    // two differences of angles that stay constant, as factors of the joints and a constant: V1 V2 against V0 V3, and
    // V3 V2 against V0 V1
    let angle = |side: usize, than: usize| turn(sides[than], sides[side], quadrangle.z);
    let mut terms = [vec![(a, sign(a)), (b, sign(b))], vec![(d, sign(d)), (a, -sign(a))]];
    if let Some(c) = c {
        terms[0].push((c, -sign(c)));
        terms[1].push((c, sign(c)));
    }
    solved(dependent, &terms, [angle(1, 3), angle(2, 0)])
        .map(|solutions| solutions.map(|(joint, coupling)| (joint, without_followers(coupling, joints))))
        .ok_or_else(|| {
            let listed = quadrangle.all().map(|joint| quadrangle.name(joint)).collect::<Vec<_>>().join(", ");
            format!("the joints of the loop are {listed}; `dependent` must name two of them that the others determine")
        })
}

/// The quadrangle of a loop: its four axes, and the joints that turn about them.
struct Quadrangle<'a> {
    joints: &'a [Joint],
    convention: Convention,
    /// The two joints of the first way, at V0 and V1.
    first: [usize; 2],
    /// The joints of the other way: the one at V0, if that way has two joints, and the one at V3.
    other: (Option<usize>, usize),
    /// The places of the cut joint at the ends of the two ways.
    ends: [FixedFrame; 2],
    /// The direction of the axis at V0.
    z: [f64; 3],
}

impl<'a> Quadrangle<'a> {
    /// Makes the quadrangle of a loop whose joints are all revolute: two on one way, one or two on the other.
    fn of(between: &[FixedFrame; 2], convention: Convention, joints: &'a [Joint]) -> Result<Self, String> {
        let ways = own_joints(joints, between);
        let (mut ways, mut ends) = ([&ways[0][..], &ways[1][..]], *between);
        if ways[1].len() > ways[0].len() {
            ways.reverse();
            ends.reverse();
        }
        let (first, other) = match ways {
            [&[a, b], &[d]] => ([a, b], (None, d)),
            [&[a, b], &[c, d]] => ([a, b], (Some(c), d)),
            [first, other] => {
                return Err(format!(
                    "the ways to the cut joint have {} and {} joints of their own; a parallelogram has 2 and 1, or 2 \
                     and 2",
                    first.len(),
                    other.len()
                ));
            }
        };
        let z = axis_at_zero(joints, convention, first[0]).axis(2);
        let quadrangle = Self { joints, convention, first, other, ends, z };
        let slides = quadrangle.all().find(|&joint| joints[joint].row.kind == JointKind::Prismatic);
        slides.map_or(Ok(quadrangle), |slides| {
            let name = quoted(&joints[slides].name);
            Err(format!("the joint {name} of the loop is prismatic; a parallelogram has revolute joints"))
        })
    }

    /// Returns the joints of the first way, followed by those of the other way.
    fn all(&self) -> impl Iterator<Item = usize> + use<> {
        self.first.into_iter().chain(self.other.0).chain([self.other.1])
    }

    fn name(&self, joint: usize) -> String {
        quoted(&self.joints[joint].name)
    }

    fn axis(&self, joint: usize) -> Pose {
        axis_at_zero(self.joints, self.convention, joint)
    }

    /// Returns the sign of each joint: 1 if its axis has the direction of the first axis, -1 if it has the opposite
    /// one.
    fn signs(&self) -> Result<Vec<(usize, f64)>, String> {
        let sign = |joint: usize| {
            let cosine = dot(self.axis(joint).axis(2), self.z);
            if 1.0 - cosine.abs() > TOLERANCE * TOLERANCE {
                let [first, joint] = [self.first[0], joint].map(|joint| self.name(joint));
                return Err(format!("the axes of the joints {first} and {joint} are not parallel"));
            }
            Ok((joint, cosine.signum()))
        };
        self.all().map(sign).collect()
    }

    /// Returns the sides as vectors from axis to axis, where all positions are 0: V0 V1, V1 V2, V3 V2, V0 V3. Refuses a
    /// loop whose opposite sides have different lengths.
    fn sides(&self) -> Result<[[f64; 3]; 4], String> {
        let (z, [a, b], (c, d)) = (self.z, self.first, self.other);
        let cut =
            self.ends.map(|end| link_at_zero(self.joints, self.convention, end.on).then(&Pose::of(&end.placement)));
        if cut.iter().any(|cut| 1.0 - dot(cut.axis(2), z).abs() > TOLERANCE * TOLERANCE) {
            return Err(format!(
                "the axis of the cut joint, z of `between`, is not parallel to that of the joint {}",
                self.name(a)
            ));
        }
        let [first_end, other_end] = cut.map(|cut| cut.translation);
        let [at_a, at_b, at_d] = [a, b, d].map(|joint| self.axis(joint).translation);
        let side = |from: [f64; 3], to: [f64; 3]| difference(to, from);
        let sides = [side(at_a, at_b), side(at_b, first_end), side(at_d, other_end), side(at_a, at_d)];
        if let Some(c) = c {
            let apart = in_plane(side(at_a, self.axis(c).translation), z);
            if length(apart) > TOLERANCE * length(sides[0]) {
                return Err(format!(
                    "the axes of the joints {} and {} must be one line, because both ways to the cut joint have two \
                     joints",
                    self.name(a),
                    self.name(c)
                ));
            }
        }
        let lengths = sides.map(|side| length(in_plane(side, z)));
        for (one, opposite) in [(0, 2), (1, 3)] {
            let [one, opposite] = [lengths[one], lengths[opposite]];
            if (one - opposite).abs() > TOLERANCE * one.max(opposite) || one == 0.0 {
                return Err(format!(
                    "opposite sides of the loop are {} m and {} m long; they must be equal and not 0",
                    six_digits(one),
                    six_digits(opposite)
                ));
            }
        }
        // both ways must end at the same height along the axes
        let heights = [[sides[0], sides[1]], [sides[3], sides[2]]].map(|way| dot(way[0], z) + dot(way[1], z));
        let apart = (heights[0] - heights[1]).abs();
        if apart > TOLERANCE * lengths[0].max(lengths[1]) {
            return Err(format!(
                "the two places of `between` are {} m apart along the axis of the cut joint",
                six_digits(apart)
            ));
        }
        Ok(sides)
    }
}

/// Solves two equations Σ coefficient · q + constant = 0 for the two dependent joints.
fn solved(
    dependent: [usize; 2],
    terms: &[Vec<(usize, f64)>; 2],
    constants: [f64; 2],
) -> Option<[(usize, Coupling); 2]> {
    let coefficient = |row: usize, joint: usize| -> f64 {
        terms[row].iter().filter(|(other, _)| *other == joint).map(|(_, factor)| factor).sum()
    };
    let [[p, q], [r, s]] = [0, 1].map(|row| dependent.map(|joint| coefficient(row, joint)));
    let determinant = p * s - q * r;
    if determinant == 0.0 {
        return None;
    }
    let inverse = [[s / determinant, -q / determinant], [-r / determinant, p / determinant]];
    let mut others: Vec<usize> = terms.iter().flatten().map(|(joint, _)| *joint).collect();
    others.sort_unstable();
    others.dedup();
    others.retain(|joint| !dependent.contains(joint));
    Some([0, 1].map(|row| {
        let [one, other] = inverse[row];
        let ratio = |&joint: &usize| (joint, -(one * coefficient(0, joint) + other * coefficient(1, joint)));
        let follows = others.iter().map(ratio).filter(|(_, ratio)| *ratio != 0.0).collect();
        let offset = -(one * constants[0] + other * constants[1]);
        (dependent[row], Coupling { follows, offset: offset + 0.0 })
    }))
}

/// Rewrites a coupling in terms of joints that follow no other joint.
fn without_followers(coupling: Coupling, joints: &[Joint]) -> Coupling {
    let mut found = Coupling { follows: Vec::new(), offset: coupling.offset };
    let mut add = |joint: usize, ratio: f64| match found.follows.iter_mut().find(|(known, _)| *known == joint) {
        Some((_, sum)) => *sum += ratio,
        None => found.follows.push((joint, ratio)),
    };
    let mut offset = coupling.offset;
    for (joint, ratio) in coupling.follows {
        match &joints[joint].coupling {
            None => add(joint, ratio),
            Some(of) => {
                offset += ratio * of.offset;
                of.follows.iter().for_each(|(joint, inner)| add(*joint, ratio * inner));
            }
        }
    }
    found.offset = offset;
    found.follows.retain(|(_, ratio)| *ratio != 0.0);
    found.follows.sort_by_key(|(joint, _)| *joint);
    found
}

fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

/// Returns the part of a vector that is perpendicular to z.
fn in_plane(v: [f64; 3], z: [f64; 3]) -> [f64; 3] {
    let along = dot(v, z);
    [0, 1, 2].map(|i| v[i] - along * z[i])
}

/// Returns the angle about z from one vector to another, rad; a multiple of π/2 is exact.
fn turn(from: [f64; 3], to: [f64; 3], z: [f64; 3]) -> f64 {
    let [from, to] = [from, to].map(|v| in_plane(v, z));
    let angle = dot(cross(from, to), z).atan2(dot(from, to));
    let right = crate::angle::nearest_right_angle(angle);
    if (angle - right).abs() < 1e-12 { right + 0.0 } else { angle }
}
