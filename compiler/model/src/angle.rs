//! Constant angles: sine and cosine are computed only here, when an angle is made, and right angles are exact.

use core::f64::consts::FRAC_PI_2;

/// How many units in the last place an angle may differ from a multiple of π/2 and still be taken for that right angle.
const RIGHT_ANGLE_ULPS: f64 = 4.0;

/// Every angle of a table, placement or lock is below this limit of 2^23 rad. Above it, neighbouring floating-point
/// numbers are more than 1e-9 rad apart; beyond 1e13 rad even the tolerance of a right angle would be whole angles.
pub const LARGEST_ANGLE: f64 = 8_388_608.0;

/// A rotation by a whole number of right angles, modulo a full turn: 0, 1, 2 or 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuarterTurns {
    /// 0°
    Zero,
    /// 90°
    One,
    /// 180°
    Two,
    /// 270°, which is -90°
    Three,
}

impl QuarterTurns {
    /// Returns the exact sine and cosine.
    #[must_use]
    pub const fn sin_cos(self) -> (f64, f64) {
        match self {
            Self::Zero => (0.0, 1.0),
            Self::One => (1.0, 0.0),
            Self::Two => (0.0, -1.0),
            Self::Three => (-1.0, 0.0),
        }
    }
}

/// A constant angle with its sine and cosine, all in the scalar `S` (`f64` or `f32`).
///
/// All readers of a table use this sine and cosine, so generated code and the runtime have the same bits on every host
/// and target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle<S = f64> {
    /// The angle, rad.
    pub radians: S,
    /// The sine of the angle; exactly 0 or ±1 for a right angle.
    pub sin: S,
    /// The cosine of the angle; exactly 0 or ±1 for a right angle.
    pub cos: S,
    /// The multiple of a right angle that the angle is; `None` for any other angle.
    pub right: Option<QuarterTurns>,
}

impl Angle<f64> {
    /// The angle 0.
    pub const ZERO: Self = Self { radians: 0.0, sin: 0.0, cos: 1.0, right: Some(QuarterTurns::Zero) };

    /// Makes an angle from a number in rad.
    ///
    /// An angle within 4 units in the last place of a multiple of π/2 is taken for that right angle: its sine and
    /// cosine are exactly 0 or ±1. Any other angle gets the sine and cosine of the `libm` crate.
    #[must_use]
    pub fn new(radians: f64) -> Self {
        if let Some(right) = right_angle(radians) {
            let (sin, cos) = right.sin_cos();
            return Self { radians, sin, cos, right: Some(right) };
        }
        let (sin, cos) = libm::sincos(radians);
        Self { radians, sin, cos, right: None }
    }

    /// Converts the angle to single precision; sine and cosine are rounded, not computed again.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    pub const fn to_f32(self) -> Angle<f32> {
        Angle { radians: self.radians as f32, sin: self.sin as f32, cos: self.cos as f32, right: self.right }
    }
}

/// Returns the multiple of π/2 nearest to `radians`, in rad.
#[must_use]
pub(crate) fn nearest_right_angle(radians: f64) -> f64 {
    libm::round(radians / FRAC_PI_2) * FRAC_PI_2
}

fn right_angle(radians: f64) -> Option<QuarterTurns> {
    if !radians.is_finite() {
        return None;
    }
    let nearest = nearest_right_angle(radians);
    let ulp = nearest.abs().next_up() - nearest.abs();
    if (radians - nearest).abs() > RIGHT_ANGLE_ULPS * ulp {
        return None;
    }
    let turns = libm::round(radians / FRAC_PI_2);
    let remainder = turns - 4.0 * libm::floor(turns / 4.0);
    Some(if remainder == 0.0 {
        QuarterTurns::Zero
    } else if remainder == 1.0 {
        QuarterTurns::One
    } else if remainder == 2.0 {
        QuarterTurns::Two
    } else {
        QuarterTurns::Three
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    #[test]
    fn right_angles_are_exact() {
        for (radians, sin, cos) in [
            (0.0, 0.0, 1.0),
            (PI / 2.0, 1.0, 0.0),
            (-PI / 2.0, -1.0, 0.0),
            (PI, 0.0, -1.0),
            (-PI, 0.0, -1.0),
            (3.0 * PI / 2.0, -1.0, 0.0),
            (2.0 * PI, 0.0, 1.0),
            (-7.0 * PI / 2.0, 1.0, 0.0),
        ] {
            let angle = Angle::new(radians);
            assert_eq!((angle.sin, angle.cos), (sin, cos), "{radians}");
            assert!(angle.right.is_some(), "{radians}");
        }
    }

    #[test]
    fn four_units_in_the_last_place_are_still_a_right_angle_and_five_are_not() {
        let step = |mut x: f64, n: i32| {
            for _ in 0..n.abs() {
                x = if n > 0 { x.next_up() } else { x.next_down() };
            }
            x
        };
        for n in [-4, -1, 1, 4] {
            assert_eq!(Angle::new(step(FRAC_PI_2, n)).right, Some(QuarterTurns::One), "{n}");
        }
        for n in [-5, 5] {
            assert_eq!(Angle::new(step(FRAC_PI_2, n)).right, None, "{n}");
        }
    }

    #[test]
    #[allow(clippy::approx_constant)] // the point of it
    fn a_rounded_right_angle_is_kept_as_it_stands() {
        let angle = Angle::new(1.5708);
        assert_eq!(angle.right, None);
        assert_eq!((angle.sin, angle.cos), libm::sincos(1.5708));
    }

    #[test]
    fn what_is_not_finite_is_no_right_angle() {
        assert_eq!(Angle::new(f64::NAN).right, None);
        assert_eq!(Angle::new(f64::INFINITY).right, None);
    }
}
