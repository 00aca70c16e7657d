//! Inertia tensors: moving them to the centre of mass, their principal moments, and their rounding.

use std::fmt;
use std::ops::{Add, Mul, Sub};

use crate::parts::double::decimal_digits;
use crate::text::source::{exact_digits, half_of_last_digit};
use crate::{Inertia, Link};

/// Rounding error that is tolerated, relative to the largest number involved.
const TOLERANCE: f64 = 1e-12;
/// Rounding error that is tolerated in a tensor that another program may have rotated: numbers of six digits cause it.
const OF_SIX_DIGITS: f64 = 1e-6;
/// Largest rounding error of an element, relative to the largest element: that of the number 1.00. Numbers of fewer
/// digits may be exact.
const OF_THREE_DIGITS: f64 = 0.005;
/// Largest rounding error of an element of two digits, such as 1.0.
const OF_TWO_DIGITS: f64 = 0.05;

/// Moves a tensor from the origin of the link frame to the centre of mass: I - m(|c|² 1 - c cᵀ).
///
/// A zero mass or a zero coordinate subtracts nothing, so exact zeros stay exact zeros.
///
/// The function is generic, so that numbers and formulas go through the same steps.
pub(crate) fn about_com<S>(origin: Inertia<S>, m: &S, [x, y, z]: [S; 3]) -> Inertia<S>
where
    S: Clone + PartialEq<f64> + Add<Output = S> + Sub<Output = S> + Mul<Output = S>,
{
    if *m == 0.0 || (x == 0.0 && y == 0.0 && z == 0.0) {
        return origin;
    }
    let square = |a: &S| a.clone() * a.clone();
    let moment = |a, b| m.clone() * (square(a) + square(b));
    let product = |a: &S, b: &S| m.clone() * a.clone() * b.clone();
    Inertia {
        xx: origin.xx - moment(&y, &z),
        yy: origin.yy - moment(&x, &z),
        zz: origin.zz - moment(&x, &y),
        xy: origin.xy + product(&x, &y),
        xz: origin.xz + product(&x, &z),
        yz: origin.yz + product(&y, &z),
    }
}

/// Returns the largest number in the computation of a tensor about the centre of mass, which rounding errors are
/// relative to.
fn largest_magnitude(written: &Inertia, m: f64, [x, y, z]: [f64; 3]) -> f64 {
    largest(written).max(m * (x * x + y * y + z * z))
}

fn largest(inertia: &Inertia) -> f64 {
    inertia.rows().iter().flatten().fold(0.0, |largest: f64, element| largest.max(element.abs()))
}

/// A principal moment of inertia of a payload, kg m², that is below zero by more than rounding. No body has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NegativeMoment(pub f64);

impl fmt::Display for NegativeMoment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the payload's inertia has a principal moment of {:.3e} kg m²: no body has less than 0; write the inertia \
             about the centre of mass, not about the tip",
            self.0
        )
    }
}

impl Inertia {
    /// Refuses the inertia of a payload that has a principal moment below zero. Numbers that are not finite are not
    /// refused.
    ///
    /// # Errors
    /// The smallest principal moment.
    pub fn check_of_payload(&self) -> Result<(), NegativeMoment> {
        let slack = OF_SIX_DIGITS * largest(self);
        let Self { xx, yy, zz, xy, xz, yz } = *self;
        let [a, b, c] = [xx + slack, yy + slack, zz + slack];
        // Sylvester's criterion needs no iteration, and a table of payloads has one in each row
        let minor = b * c - yz * yz;
        let determinant = a * minor - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
        if a > 0.0 && a * b > xy * xy && determinant > 0.0 {
            return Ok(());
        }
        let negative = self.principal_moments().filter(|[least, ..]| *least < -slack);
        negative.map_or(Ok(()), |[least, ..]| Err(NegativeMoment(least)))
    }

    /// Returns the principal moments, ascending, kg m²; `None` when an element is not finite. A physical body has none
    /// below zero.
    #[must_use]
    pub fn principal_moments(&self) -> Option<[f64; 3]> {
        principal_moments(self)
    }

    /// Returns the principal moments, ascending, kg m², if the largest exceeds the sum of the two others by more than
    /// the rounding of the decimal digits explains: no distribution of mass has such moments. A tensor with only one
    /// moment is accepted: it describes a link whose other moments have no effect.
    #[must_use]
    pub fn impossible_moments(&self) -> Option<[f64; 3]> {
        self.impossible_beyond(self.slack())
    }

    fn impossible_beyond(&self, slack: f64) -> Option<[f64; 3]> {
        self.principal_moments().filter(|[a, b, c]| [*a, *b] != [0.0; 2] && c - (a + b) > slack)
    }

    /// Returns the error of the tensor, as a norm, kg m², if each element is rounded to its last digit: no principal
    /// moment is wrong by more than this.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        let rows = self.half_digits(OF_THREE_DIGITS).map(|row| row.into_iter().sum::<f64>());
        rows.into_iter().fold(OF_SIX_DIGITS * largest(self), f64::max)
    }

    /// Returns the largest error of c - (a + b) by this rounding, with the principal moments a ≤ b ≤ c: an error E of
    /// the tensor changes it by at most |tr E| + 2 ‖E‖.
    fn slack(&self) -> f64 {
        let half = self.half_digits(OF_TWO_DIGITS);
        half[0][0] + half[1][1] + half[2][2] + 2.0 * self.rounding()
    }

    /// Returns half of the last digit of each element. Files print all elements with the same number of decimals, or of
    /// significant digits; trailing zeros are lost, so the element with the most digits tells the number. It is at most
    /// the part `coarsest` of the largest element; of a tensor with one digit, that of three digits.
    fn half_digits(&self, coarsest: f64) -> [[f64; 3]; 3] {
        // the number of digits after the first one, and the decimal exponent of the last digit
        let digits = |x: f64| {
            let (digits, last) = decimal_digits(x.abs());
            (i32::try_from(digits.checked_ilog10().unwrap_or(0)).unwrap_or(0), last)
        };
        let elements = self.rows().into_iter().flatten().filter(|x| *x != 0.0);
        let (most, finest) =
            elements.map(digits).fold((0, i32::MAX), |(most, finest), (more, last)| (most.max(more), finest.min(last)));
        let coarsest = if most == 0 { OF_THREE_DIGITS } else { coarsest } * largest(self);
        self.rows().map(|row| {
            row.map(|x| {
                let (more, last) = digits(x);
                let own = if x == 0.0 { finest } else { finest.max(last + more - most) };
                (0.5 * 10_f64.powi(own)).min(coarsest)
            })
        })
    }
}

impl Link {
    /// Returns whether a physical body can have this inertia: it is positive semidefinite about the centre of mass, up
    /// to rounding, and there is no first moment without mass. `written` is the inertia as the file has it, about any
    /// point.
    #[must_use]
    pub fn is_physical(&self, written: &Inertia) -> bool {
        let moments = self.inertia.principal_moments();
        !self.has_first_moment()
            && moments.is_some_and(|moments| moments[0] >= -(written.rounding() + self.moved(written)))
    }

    /// Returns [`Inertia::impossible_moments`] of the link; `written` is the inertia as the file has it, about any
    /// point.
    pub(crate) fn impossible_moments(&self, written: &Inertia) -> Option<[f64; 3]> {
        self.inertia.impossible_beyond(written.slack() + 5.0 * self.moved(written))
    }

    /// Returns the error of the inertia about the centre of mass that the rounding of mass and centre causes; 0 if
    /// `written` is already about the centre of mass.
    fn moved(&self, written: &Inertia) -> f64 {
        if *written == self.inertia {
            return 0.0;
        }
        let relative = |x: f64| if x == 0.0 { 0.0 } else { half_of_last_digit(&exact_digits(x)) / x.abs() };
        let coarsest = self.com.into_iter().fold(relative(self.mass), |most, x| most.max(2.0 * relative(x)));
        largest_magnitude(written, self.mass, self.com) * coarsest.clamp(TOLERANCE, OF_THREE_DIGITS)
    }
}

/// Computes the principal moments, ascending, by Jacobi rotations; `None` when an element is not finite.
pub(crate) fn principal_moments(inertia: &Inertia) -> Option<[f64; 3]> {
    if !inertia.rows().iter().flatten().all(|element| element.is_finite()) {
        return None;
    }
    let scale = largest(inertia);
    if scale == 0.0 {
        return Some([0.0; 3]);
    }
    // Scaled to 1, so that no square overflows or vanishes.
    let mut a = inertia.rows().map(|row| row.map(|element| element / scale));
    // Convergence is quadratic, so a few sweeps are enough.
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, p, q);
        }
    }
    let mut moments = [a[0][0], a[1][1], a[2][2]].map(|moment| moment * scale);
    moments.sort_by(f64::total_cmp);
    Some(moments)
}

/// Applies one Jacobi rotation, Jᵀ A J, which makes `a[p][q]` zero.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = 1.0_f64.copysign(theta) / (theta.abs() + libm::sqrt(theta * theta + 1.0));
    let c = 1.0 / libm::sqrt(t * t + 1.0);
    let s = t * c;
    let r = 3 - p - q;
    let (app, aqq, apq, arp, arq) = (a[p][p], a[q][q], a[p][q], a[r][p], a[r][q]);
    a[p][p] = app - t * apq;
    a[q][q] = aqq + t * apq;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    a[r][p] = c * arp - s * arq;
    a[r][q] = s * arp + c * arq;
    a[p][r] = a[r][p];
    a[q][r] = a[r][q];
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tensor(xx: f64, yy: f64, zz: f64, xy: f64, xz: f64, yz: f64) -> Inertia {
        Inertia { xx, yy, zz, xy, xz, yz }
    }

    fn close(found: [f64; 3], expected: [f64; 3], tolerance: f64) -> bool {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= tolerance)
    }

    #[test]
    fn moments_of_known_tensors() {
        let moments = |i: Inertia| principal_moments(&i).unwrap();
        assert_eq!(moments(tensor(3.0, 1.0, 2.0, 0.0, 0.0, 0.0)), [1.0, 2.0, 3.0]);
        assert_eq!(moments(Inertia::default()), [0.0; 3]);
        // The matrix [[2, 1], [1, 2]] has the eigenvalues 1 and 3.
        assert!(close(moments(tensor(2.0, 2.0, 5.0, 1.0, 0.0, 0.0)), [1.0, 3.0, 5.0], 1e-15));
        // The matrix c cᵀ with c = (1, 2, 3) has the eigenvalues 0, 0 and 14.
        assert!(close(moments(tensor(1.0, 4.0, 9.0, 2.0, 3.0, 6.0)), [0.0, 0.0, 14.0], 1e-14));
    }

    #[test]
    fn moments_keep_trace_and_determinant_at_every_scale() {
        for scale in [1e-300, 1e-12, 1.0, 1e12, 1e300] {
            let i = tensor(scale, 0.7 * scale, 0.4 * scale, -0.2 * scale, 0.1 * scale, 0.05 * scale);
            let [a, b, c] = principal_moments(&i).unwrap().map(|moment| moment / scale);
            assert!((a + b + c - 2.1).abs() < 1e-15, "{scale}");
            let determinant = 0.28 + 2.0 * -0.2 * 0.1 * 0.05 - 0.0025 - 0.7 * 0.01 - 0.4 * 0.04;
            assert!((a * b * c - determinant).abs() < 1e-15, "{scale}");
        }
        assert_eq!(principal_moments(&tensor(f64::INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0)), None);
    }

    #[test]
    fn a_point_mass_has_no_inertia_about_itself() {
        let origin = tensor(13.0 * 2.0, 10.0 * 2.0, 5.0 * 2.0, -4.0, -6.0, -12.0);
        assert_eq!(about_com(origin, &2.0, [1.0, 2.0, 3.0]), Inertia::default());
        assert_eq!(about_com(origin, &0.0, [1.0, 2.0, 3.0]), origin);
        assert_eq!(about_com(origin, &2.0, [0.0; 3]), origin);
    }

    #[test]
    fn zeros_stay_zeros() {
        let com = about_com(tensor(0.3, 0.0, 0.3, 0.0, 0.0, 0.0), &1.5, [0.0, -0.1, 0.0]);
        assert_eq!((com.yy, com.xy, com.xz, com.yz), (0.0, 0.0, 0.0, 0.0));
    }
}
