//! The ten inertial parameters of a link as its pseudo-inertia: mass, first and second moments about its frame's
//! origin.

use std::ops::Add;

use crate::ir::{ExactAngle, Number, square};

/// Three numbers along x, y, z.
pub(crate) type Triple = [Number; 3];

/// A 3 × 3 matrix of numbers, by rows.
pub(crate) type Square = [[Number; 3]; 3];

/// The matrix 1.
pub(crate) const IDENTITY: Square = [
    [Number::ONE, Number::ZERO, Number::ZERO],
    [Number::ZERO, Number::ONE, Number::ZERO],
    [Number::ZERO, Number::ZERO, Number::ONE],
];

/// Moments of the mass of a link: P = [S h; hᵀ m], with h = ∫ r dm and S = ∫ r rᵀ dm about the origin of its frame.
///
/// S = ½ tr(J) 1 - J for the inertia J about the origin. A change of frame is a congruence of P.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct PseudoInertia {
    pub(crate) mass: Number,
    pub(crate) h: Triple,
    pub(crate) s: Square,
}

/// An element of a pseudo-inertia, or the difference S11 - S22, which regrouping can set to zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Entry {
    Mass,
    H(usize),
    S(usize, usize),
    /// The difference S11 - S22.
    Difference,
}

impl Entry {
    pub(crate) const fn is_of_second_moments(self) -> bool {
        matches!(self, Self::S(..) | Self::Difference)
    }
}

impl PseudoInertia {
    /// Returns the moments of a body, given its mass, its centre of mass and the inertia about that.
    pub(crate) fn of_body(mass: Number, com: Triple, inertia: Square, half: Number) -> Self {
        let trace = (inertia[0][0] + inertia[1][1] + inertia[2][2]) * half;
        let s = square(|i, j| {
            let about_com = if i == j { trace - inertia[i][j] } else { -inertia[i][j] };
            about_com + mass * com[i] * com[j]
        });
        Self { mass, h: com.map(|c| mass * c), s }
    }

    /// Adds a first moment that is given about a point in addition to that of the mass.
    pub(crate) fn with_first_moment(self, moment: Triple, about: Triple) -> Self {
        let s = square(|i, j| self.s[i][j] + moment[i] * about[j] + about[i] * moment[j]);
        Self { h: [0, 1, 2].map(|i| self.h[i] + moment[i]), s, ..self }
    }

    /// Returns moments without mass that are an inertia about an axis through the origin: J = inertia · a aᵀ.
    pub(crate) fn about(axis: Triple, inertia: Number, half: Number) -> Self {
        let trace = sum(axis.into_iter().map(|x| x * x)) * inertia * half;
        let s = square(|i, j| {
            let own = -(axis[i] * axis[j] * inertia);
            if i == j { own + trace } else { own }
        });
        Self { s, ..Self::default() }
    }

    pub(crate) fn get(&self, entry: Entry) -> Number {
        match entry {
            Entry::Mass => self.mass,
            Entry::H(i) => self.h[i],
            Entry::S(i, j) => self.s[i][j],
            Entry::Difference => self.s[0][0] - self.s[1][1],
        }
    }

    /// Returns S11, S22, S33, S12, S13, S23.
    pub(crate) fn second_moments(&self) -> [Number; 6] {
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = self.s;
        [xx, yy, zz, xy, xz, yz]
    }

    /// Returns the moments after a rotation: every point r becomes R r.
    pub(crate) fn turned(&self, rotation: &Square) -> Self {
        let half = square(|i, j| sum((0..3).map(|k| rotation[i][k] * self.s[k][j])));
        Self {
            mass: self.mass,
            h: apply(rotation, self.h),
            s: square(|i, j| sum((0..3).map(|k| half[i][k] * rotation[j][k]))),
        }
    }

    /// Returns the moments about another origin: every point r becomes r + t.
    pub(crate) fn moved(&self, t: Triple) -> Self {
        Self {
            mass: self.mass,
            h: [0, 1, 2].map(|i| self.h[i] + self.mass * t[i]),
            s: square(|i, j| self.s[i][j] + self.h[i] * t[j] + t[i] * self.h[j] + self.mass * t[i] * t[j]),
        }
    }

    /// Returns the moments of a rod along the line through `p` with direction `u`, given its mass, and its first and
    /// second moment along the line.
    pub(crate) fn rod([mass, first, second]: Triple, p: Triple, u: Triple) -> Self {
        Self {
            mass,
            h: [0, 1, 2].map(|i| mass * p[i] + first * u[i]),
            s: square(|i, j| mass * p[i] * p[j] + first * (p[i] * u[j] + u[i] * p[j]) + second * u[i] * u[j]),
        }
    }
}

impl Add for PseudoInertia {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            h: [0, 1, 2].map(|i| self.h[i] + other.h[i]),
            s: square(|i, j| self.s[i][j] + other.s[i][j]),
        }
    }
}

pub(crate) fn sum(terms: impl Iterator<Item = Number>) -> Number {
    terms.fold(Number::ZERO, |sum, term| sum + term)
}

/// Returns R v.
pub(crate) fn apply(rotation: &Square, v: Triple) -> Triple {
    [0, 1, 2].map(|i| sum((0..3).map(|k| rotation[i][k] * v[k])))
}

pub(crate) fn compose(a: &Square, b: &Square) -> Square {
    square(|i, j| sum((0..3).map(|k| a[i][k] * b[k][j])))
}

pub(crate) fn transpose(a: &Square) -> Square {
    square(|i, j| a[j][i])
}

/// Returns Rx(α).
pub(crate) fn about_x(turn: ExactAngle) -> Square {
    let (zero, one, ExactAngle { sin, cos }) = (Number::ZERO, Number::ONE, turn);
    [[one, zero, zero], [zero, cos, -sin], [zero, sin, cos]]
}

/// Returns Rz(θ).
pub(crate) fn about_z(turn: ExactAngle) -> Square {
    let (zero, one, ExactAngle { sin, cos }) = (Number::ZERO, Number::ONE, turn);
    [[cos, -sin, zero], [sin, cos, zero], [zero, zero, one]]
}

#[cfg(test)]
mod tests {
    use rne_model::Angle;

    use super::*;
    use crate::ir::Embedding;

    fn numbers<const N: usize>(values: [f64; N]) -> [Number; N] {
        values.map(|value| Embedding::default().decimal(value))
    }

    fn body() -> PseudoInertia {
        let [m, x, y, z, xx, yy, zz, xy, xz, yz, half] =
            numbers([2.5, 0.1, -0.2, 0.3, 0.04, 0.05, 0.06, 0.001, -0.002, 0.003, 0.5]);
        PseudoInertia::of_body(m, [x, y, z], [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], half)
    }

    #[test]
    fn frames_change_there_and_back() {
        let turn = Embedding::default().turn(&Angle::new(0.7));
        let rotation = compose(&about_x(turn), &about_z(turn));
        let there = body().turned(&rotation);
        assert_eq!(residues(&there.turned(&transpose(&rotation))), residues(&body()));
        let [x, y, z] = numbers([0.3, -0.7, 0.2]);
        assert_eq!(residues(&body().moved([x, y, z]).moved([-x, -y, -z])), residues(&body()));
    }

    #[test]
    fn a_rod_is_matter_on_a_line() {
        // a point of mass 2 at (1, 2, 3), as a rod through that point along z
        let [zero, one, two, three] = numbers([0.0, 1.0, 2.0, 3.0]);
        let rod = PseudoInertia::rod([two, zero, zero], [one, two, three], [zero, zero, one]);
        let point = PseudoInertia { mass: two, ..PseudoInertia::default() }.moved([one, two, three]);
        assert_eq!(residues(&rod), residues(&point));
    }

    fn residues(p: &PseudoInertia) -> Vec<crate::ir::Residue> {
        std::iter::once(p.mass).chain(p.h).chain(p.s.into_iter().flatten()).map(|x| x.residue).collect()
    }
}
