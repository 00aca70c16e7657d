//! Exact constants: each has a value with 106 bits, and its images in two prime fields.

use rne_model::{Angle, Double, InertiaReference, Joint, QuarterTurns, decimal_digits};

use super::derivation::{Way, note};
use super::{operators, residue::Residue};

/// A constant. The residues decide whether two constants are equal; the value is only rounded once, at the end.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Number {
    pub(crate) value: Double,
    pub(crate) residue: Residue,
}

impl Number {
    pub(crate) const ZERO: Self = Self { value: Double::new(0.0), residue: Residue::ZERO };
    pub(crate) const ONE: Self = Self { value: Double::new(1.0), residue: Residue::ONE };

    /// A rounded number, with the residue of the exact number.
    pub(crate) fn rounded(value: f64, residue: Residue) -> Self {
        // adding 0 turns -0 into 0
        Self { value: Double::new(value + 0.0), residue }
    }

    /// A small integer.
    pub(crate) fn integer(value: u32) -> Self {
        let residue = Residue::integer(u64::from(value));
        note(residue, || Way::Decimal(f64::from(value)));
        Self { value: Double::new(f64::from(value)), residue }
    }

    pub(crate) fn is_zero(self) -> bool {
        self.residue.is_zero()
    }

    /// 1 or -1.
    pub(crate) fn is_unit(self) -> bool {
        self.residue == Residue::ONE || self.residue == -Residue::ONE
    }

    /// 1/x; `None` for zero.
    pub(crate) fn inverse(self) -> Option<Self> {
        if self.is_unit() {
            return Some(self);
        }
        let inverse = Self { value: Double::new(1.0) / self.value, residue: self.residue.inverse()? };
        note(inverse.residue, || Way::Inverse(self.residue));
        Some(inverse)
    }

    /// √x; `None` when the value is negative or an image is no square.
    pub(crate) fn sqrt(self) -> Option<Self> {
        if self.is_zero() {
            return Some(self);
        }
        let root = Self { value: self.value.sqrt(), residue: self.residue.sqrt()? };
        note(root.residue, || Way::Root(self.residue));
        (self.value.high > 0.0).then_some(root)
    }

    /// The nearest `f64`.
    pub(crate) fn to_f64(self) -> f64 {
        self.value.to_f64()
    }

    /// Whether the number is negative. If its value does not tell, because of cancellation or overflow, the image picks
    /// which of x and -x counts as negative.
    pub(crate) fn is_negative(self) -> bool {
        let value = self.value.high;
        if value == 0.0 || value.is_nan() { self.residue.is_negative() } else { value < 0.0 }
    }

    /// Whether the image is not zero although the value is only the rounding error of sums as large as `scale`, below
    /// `PART` of it. This happens when equal numbers are read as different ones.
    pub(crate) fn is_dust(self, scale: f64) -> bool {
        const PART: f64 = 1e-25;
        // a comparison with NaN is false, so NaN counts as no value
        let has_value = self.value.high.abs() > PART * scale;
        !self.is_zero() && !has_value
    }

    pub(crate) fn abs(self) -> Self {
        if self.is_negative() { -self } else { self }
    }

    /// Returns exact zero if the residue is zero, else the number.
    fn settled(self) -> Self {
        if self.residue.is_zero() { Self::ZERO } else { self }
    }
}

operators! { Number:
    a + b => match (a.is_zero(), b.is_zero()) {
        (true, _) => b,
        (_, true) => a,
        _ => {
            let residue = a.residue + b.residue;
            note(residue, || Way::Sum(a.residue, b.residue));
            Self { value: a.value + b.value, residue }.settled()
        }
    };
    -a => Self { value: -a.value, residue: -a.residue };
    a - b => a + -b;
    a * b => match (a.residue, b.residue) {
        (Residue::ZERO, _) | (_, Residue::ZERO) => Self::ZERO,
        (Residue::ONE, _) => b,
        (_, Residue::ONE) => a,
        (x, y) => {
            note(x * y, || Way::Product(x, y));
            Self { value: a.value * b.value, residue: x * y }
        }
    };
}

/// A constant angle, stored as its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ExactAngle {
    pub(crate) sin: Number,
    pub(crate) cos: Number,
}

impl ExactAngle {
    pub(crate) const NONE: Self = Self { sin: Number::ZERO, cos: Number::ONE };

    /// Returns sine and cosine of the sum of both angles.
    pub(crate) fn then(self, other: Self) -> Self {
        Self { sin: self.sin * other.cos + self.cos * other.sin, cos: self.cos * other.cos - self.sin * other.sin }
    }

    pub(crate) fn back(self) -> Self {
        Self { sin: -self.sin, cos: self.cos }
    }

    /// The number of quarter turns, if the angle is a multiple of a right angle.
    pub(crate) fn quarters(self) -> Option<QuarterTurns> {
        let (sin, cos) = (self.sin.residue, self.cos.residue);
        if sin.is_zero() {
            return Some(if cos == Residue::ONE { QuarterTurns::Zero } else { QuarterTurns::Two });
        }
        cos.is_zero().then(|| if sin == Residue::ONE { QuarterTurns::One } else { QuarterTurns::Three })
    }

    /// The angle, rad, between -π and π. Two turns may round to one angle, but their images tell them apart.
    pub(crate) fn angle(self) -> Number {
        let radians = self.sin.to_f64().atan2(self.cos.to_f64());
        let (sin, cos) = Double::new(radians).sin_cos();
        // one step of Newton's method: the sine of the difference to the exact angle
        let rest = self.sin.value * cos - self.cos.value * sin;
        // an angle in rad has no image in a field; this one is arbitrary, but changes its sign with the angle
        let two = Residue::integer(2);
        let residue = if self.sin.is_zero() { two } else { self.sin.residue * (self.cos.residue + two) };
        Number { value: Double::new((Double::new(radians) + rest).to_f64()), residue }
    }
}

/// How the numbers of a robot file are mapped into the two prime fields.
///
/// A number of the file is the decimal that its author wrote, a rational number, so it has an image. The sine and
/// cosine of an angle become a random point of the circle over the field. Angles that differ by right angles or in sign
/// share this point: they count as such if their sines and cosines, rounded to `f64`, are the same two numbers up to
/// order and sign. So 0.9 and π - 0.9 are different angles if one bit of a sine differs.
///
/// In a prime field only every second number has a square root. So one decimal may get a random image, wherever it
/// occurs, for which the needed roots exist: an identity that holds for an unknown also holds for the number.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Embedding {
    pub(crate) seed: u64,
    /// The magnitude of the decimal that is read as an unknown.
    pub(crate) unknown: Option<f64>,
}

impl Embedding {
    /// Returns the exact number of a decimal of the file.
    pub(crate) fn decimal(&self, value: f64) -> Number {
        let magnitude = value.abs();
        if magnitude == 0.0 {
            return Number::ZERO;
        }
        let (digits, exponent) = decimal_digits(magnitude);
        let residue = if self.unknown == Some(magnitude) {
            let seed = self.seed ^ magnitude.to_bits();
            Residue::residues(mixed(seed), mixed(!seed))
        } else {
            let factor = if exponent < 0 { Residue::TENTH } else { Residue::integer(10) };
            (0..exponent.abs()).fold(Residue::integer(digits), |residue, _| residue * factor)
        };
        note(residue, || Way::Decimal(magnitude));
        let number = Number { value: Double::of_digits(digits, exponent), residue };
        if value < 0.0 { -number } else { number }
    }

    /// Returns the inertia of a link about its centre of mass, by rows. The file gives it about that point or about the
    /// link's origin.
    pub(crate) fn inertia(&self, joint: &Joint) -> [[Number; 3]; 3] {
        let (tensor, reference) = &joint.written_inertia;
        let written = tensor.rows().map(|row| row.map(|x| self.decimal(x)));
        if self.unknown.is_some() {
            return self.inertia_of_unknown(joint, &written);
        }
        match reference {
            InertiaReference::Com => written,
            InertiaReference::Origin => {
                let moved = self.moments_of_mass(joint);
                let trace = moved[0][0] + moved[1][1] + moved[2][2];
                // Steiner: I = J - m (c·c 1 - c cᵀ)
                square(|i, j| written[i][j] - if i == j { trace - moved[i][j] } else { -moved[i][j] })
            }
        }
    }

    /// Returns the inertia about the centre of mass if a coordinate of this centre may be an unknown. Then the second
    /// moments about the origin and about the centre of mass cannot both keep their numbers. One that is zero about
    /// either point stays zero there for any unknown, so that no value is zero without a zero image. The others keep
    /// the numbers of the file.
    fn inertia_of_unknown(&self, joint: &Joint, written: &[[Number; 3]; 3]) -> [[Number; 3]; 3] {
        let known = Self { unknown: None, ..*self };
        let half = self.decimal(0.5);
        // the second moments S = ∫ r rᵀ dm; the inertia is tr(S) 1 - S
        let second = |inertia: &[[Number; 3]; 3]| {
            let trace = (inertia[0][0] + inertia[1][1] + inertia[2][2]) * half;
            square(|i, j| if i == j { trace - inertia[i][j] } else { -inertia[i][j] })
        };
        let (moved, moved_if_known) = (self.moments_of_mass(joint), known.moments_of_mass(joint));
        let (about_com, written) = (second(&known.inertia(joint)), second(written));
        let is_about_com = joint.written_inertia.1 == InertiaReference::Com;
        let s = square(|i, j| {
            let is_zero_about_origin = (about_com[i][j] + moved_if_known[i][j]).is_zero();
            match (is_about_com, about_com[i][j].is_zero()) {
                (_, true) => Number::ZERO,
                (true, _) if is_zero_about_origin => -moved[i][j],
                (true, _) => written[i][j],
                (false, _) => written[i][j] - moved[i][j],
            }
        });
        square(|i, j| if i == j { s[0][0] + s[1][1] + s[2][2] - s[i][j] } else { -s[i][j] })
    }

    /// The second moments m c cᵀ about the origin of a point mass m at the link's centre of mass c.
    fn moments_of_mass(&self, joint: &Joint) -> [[Number; 3]; 3] {
        let mass = self.decimal(joint.row.link.mass);
        let com = joint.row.link.com.map(|x| self.decimal(x));
        square(|i, j| mass * com[i] * com[j])
    }

    /// Returns sine and cosine of a constant angle of the file.
    pub(crate) fn turn(&self, angle: &Angle) -> ExactAngle {
        if let Some(right) = angle.right {
            let (sin, cos) = right.sin_cos();
            return ExactAngle { sin: self.decimal(sin), cos: self.decimal(cos) };
        }
        let (sin, cos) = Double::new(angle.radians).sin_cos();
        let quarters = (angle.radians / std::f64::consts::FRAC_PI_2).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 3
        let quarters = quarters.rem_euclid(4.0) as u8;
        let (rest_sin, rest_cos) = (0..quarters).fold((sin, cos), |(s, c), _| (-c, s));
        // angles for which the magnitudes of these two numbers agree differ by right angles or in sign, so they share a
        // point
        let bits = |x: Double| x.to_f64().abs().to_bits();
        let point = self.point(0xA11E, mixed(bits(rest_sin)) ^ bits(rest_cos));
        let rest = if rest_sin.high < 0.0 { (-point.0, point.1) } else { point };
        let (s, c) = (0..quarters).fold(rest, |(s, c), _| (c, -s));
        note(s, || Way::Sine(angle.radians));
        note(c, || Way::Cosine(angle.radians));
        ExactAngle { sin: Number { value: sin, residue: s }, cos: Number { value: cos, residue: c } }
    }

    /// A random point (sine, cosine) of the circle.
    pub(crate) fn point(&self, kind: u64, index: u64) -> (Residue, Residue) {
        let t = self.random(kind, index);
        let square = t * t;
        // 1 + t² is zero for two t in 2⁶¹
        let scale = (Residue::ONE + square).inverse().unwrap_or(Residue::ONE);
        ((t + t) * scale, (Residue::ONE - square) * scale)
    }

    /// A pseudorandom image, the same for the same kind and index.
    pub(crate) fn random(&self, kind: u64, index: u64) -> Residue {
        let seed = mixed(self.seed ^ mixed(kind ^ mixed(index)));
        Residue::residues(mixed(seed ^ 1), mixed(seed ^ 2))
    }
}

/// Makes a 3 × 3 matrix; `f` gives the element of a row and a column.
pub(crate) fn square<T>(f: impl Fn(usize, usize) -> T) -> [[T; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| f(i, j)))
}

/// The finalizer of splitmix64 (Steele, Lea, Flood 2014).
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;

    #[test]
    fn decimals_add_up_exactly() {
        let embedding = Embedding::default();
        let [a, b, c] = [0.1, 0.2, 0.3].map(|x| embedding.decimal(x));
        assert!((a + b - c).is_zero(), "in f64 it is 5.6e-17");
        assert_eq!((a + b - c).to_f64(), 0.0);
        assert_eq!((a * b).to_f64(), 0.02);
    }

    #[test]
    fn turns_are_points_of_the_circle() {
        let embedding = Embedding::default();
        for radians in [0.0, 0.9, PI, 2.0, -1.0] {
            let turn = embedding.turn(&Angle::new(radians));
            assert!((turn.sin * turn.sin + turn.cos * turn.cos - Number::ONE).is_zero(), "{radians}");
            assert!((turn.sin.to_f64() - radians.sin()).abs() < 1e-15, "{radians}");
            assert_eq!(turn.then(turn.back()).quarters(), Some(QuarterTurns::Zero));
        }
    }

    #[test]
    fn angles_are_one_where_their_sines_and_cosines_are() {
        let embedding = Embedding::default();
        let is_one = |a: f64, b: f64| {
            let [a, b] = [a, b].map(|radians| embedding.turn(&Angle::new(radians)));
            let magnitude = |x: Number| x.residue.max(-x.residue);
            let mut residues = [a, b].map(|turn| [turn.sin, turn.cos].map(magnitude));
            for pair in &mut residues {
                pair.sort_unstable();
            }
            let mut values = [a, b].map(|turn| [turn.sin, turn.cos].map(|x| x.to_f64().abs().to_bits()));
            for pair in &mut values {
                pair.sort_unstable();
            }
            assert_eq!(residues[0] == residues[1], values[0] == values[1], "{a:?} and {b:?}");
            residues[0] == residues[1]
        };
        assert!(is_one(0.9, -0.9) && is_one(1.57, -1.57) && is_one(FRAC_PI_4, 3.0 * FRAC_PI_4));
        assert!(is_one(0.3, PI - 0.3) && is_one(0.3, FRAC_PI_2 + 0.3), "their last bits agree");
        assert!(!is_one(0.9, FRAC_PI_2 + 0.9), "their last bits do not");
        assert!(!is_one(0.9, 0.900_000_000_000_4) && !is_one(4e-13, 1e-13) && !is_one(1e-13, -1.000_000_1e-13));
        assert!(!is_one(0.9, 0.9_f64.next_up()));
        // whatever their last bits are, images agree with them
        for step in 1..200 {
            let radians = f64::from(step) * 0.0157;
            for other in [PI - radians, PI + radians, FRAC_PI_2 - radians, radians - FRAC_PI_2, radians + 2.0 * PI] {
                let _ = is_one(radians, other);
            }
        }
    }

    #[test]
    fn an_angle_and_its_complement_keep_their_signs() {
        let embedding = Embedding::default();
        let turn = |radians: f64| embedding.turn(&Angle::new(radians));
        let (a, back, supplement) = (turn(0.3), turn(-0.3), turn(PI - 0.3));
        assert_eq!((back.sin.residue, back.cos.residue), (-a.sin.residue, a.cos.residue));
        assert_eq!((supplement.sin.residue, supplement.cos.residue), (a.sin.residue, -a.cos.residue));
    }
}
