//! Replaces rounded angles by the exact ones that they stand for: 1.5708 becomes pi/2.

use std::f64::consts::PI;

use crate::geometry::{Vector, twelfths_of_pi};

/// Largest distance of an angle from the multiple of pi/12 that replaces it, rad.
pub const TOLERANCE: f64 = 2e-4;

/// An angle or an axis that was replaced by the exact one.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Snapped {
    /// The place in the file, such as `joint shoulder, roll`.
    pub place: String,
    /// The number or the axis as the file has it.
    pub from: String,
    /// The number or the axis that replaces it.
    pub to: String,
    /// The angle between both, rad.
    pub by: f64,
}

/// Records the numbers that were snapped, in the order in which they are read. If `is_on` is false, nothing is snapped.
#[derive(Debug, Default)]
pub(crate) struct Snapping {
    pub(crate) is_on: bool,
    pub(crate) found: Vec<Snapped>,
}

impl Snapping {
    /// Snaps roll, pitch and yaw of a frame.
    pub(crate) fn rpy(&mut self, of: &str, rpy: [f64; 3]) -> [f64; 3] {
        let mut result = rpy;
        if !self.is_on {
            return result;
        }
        for (angle, name) in result.iter_mut().zip(["roll", "pitch", "yaw"]) {
            let twelfths = (*angle * 12.0 / PI).round();
            let meant = of_twelfths(twelfths);
            if twelfths_of_pi(*angle).is_none() && (*angle - meant).abs() <= TOLERANCE {
                self.found.push(Snapped {
                    place: format!("{of}, {name}"),
                    from: rne_model::exact_digits(*angle),
                    to: angle_text(meant).unwrap_or_else(|| format!("{meant}")),
                    by: (*angle - meant).abs(),
                });
                *angle = meant;
            }
        }
        result
    }

    /// Snaps the axis of a joint: a direction that is nearly an axis of its frame becomes this axis.
    pub(crate) fn axis(&mut self, of: &str, written: [f64; 3], axis: Vector) -> Vector {
        let Some(along) = (0..3).find(|&i| axis.0[i].high.abs() > 0.9).filter(|_| self.is_on) else { return axis };
        let meant = if axis.0[along].high > 0.0 { Vector::unit(along) } else { -Vector::unit(along) };
        let by = (axis - meant).norm().to_f64();
        if by == 0.0 || by > TOLERANCE {
            return axis;
        }
        let text = |axis: [f64; 3]| axis.map(|x| format!("{}", x + 0.0)).join(" ");
        self.found.push(Snapped { place: format!("{of}, axis"), from: text(written), to: text(meant.to_f64()), by });
        meant
    }
}

/// Returns a multiple of pi/12 with exactly the bits of the expression that a person would write for it.
pub(crate) fn of_twelfths(twelfths: f64) -> f64 {
    let (factor, divisor) = fraction(twelfths);
    factor * PI / divisor
}

/// Returns an angle as a robot file would have it: `0`, `-pi/2`, `5*pi/12`; `None` where it is no multiple of pi/12.
pub(crate) fn angle_text(angle: f64) -> Option<String> {
    let twelfths = twelfths_of_pi(angle)?;
    let (factor, divisor) = fraction(twelfths);
    let sign = if factor < 0.0 { "-" } else { "" };
    let text = match (factor.abs(), divisor) {
        (0.0, _) => "0".to_owned(),
        (1.0, 1.0) => format!("{sign}pi"),
        (1.0, divisor) => format!("{sign}pi/{divisor}"),
        (factor, 1.0) => format!("{sign}{factor}*pi"),
        (factor, divisor) => format!("{sign}{factor}*pi/{divisor}"),
    };
    (rne_model::number(&text).ok()? == angle).then_some(text)
}

/// Returns n/12 in lowest terms.
fn fraction(twelfths: f64) -> (f64, f64) {
    let common = [12.0, 6.0, 4.0, 3.0, 2.0].into_iter().find(|common| twelfths % common == 0.0).unwrap_or(1.0);
    (twelfths / common, 12.0 / common)
}

#[cfg(test)]
#[allow(clippy::approx_constant)] // as files have them
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn multiples_of_15_degrees_have_their_words() {
        for (twelfths, text) in [
            (0.0, "0"),
            (6.0, "pi/2"),
            (-6.0, "-pi/2"),
            (12.0, "pi"),
            (8.0, "2*pi/3"),
            (-5.0, "-5*pi/12"),
            (24.0, "2*pi"),
        ] {
            assert_eq!(angle_text(of_twelfths(twelfths)).as_deref(), Some(text));
        }
        assert_eq!(angle_text(1.5708), None);
        assert_eq!(angle_text(0.3), None);
    }

    #[test]
    fn what_is_near_is_snapped_and_told() {
        let mut snapping = Snapping { is_on: true, ..Snapping::default() };
        assert_eq!(snapping.rpy("joint a", [1.5708, 0.0, -FRAC_PI_2]), [FRAC_PI_2, 0.0, -FRAC_PI_2]);
        assert_eq!(snapping.rpy("joint a", [1.5705, 2.1e-4, 0.3]), [1.5705, 2.1e-4, 0.3], "too far");
        let [found] = &snapping.found[..] else { panic!("{:?}", snapping.found) };
        assert_eq!((found.place.as_str(), found.from.as_str(), found.to.as_str()), ("joint a, roll", "1.5708", "pi/2"));
        assert!((found.by - 3.673e-6).abs() < 1e-9);
        let mut off = Snapping::default();
        assert_eq!(off.rpy("joint a", [1.5708, 0.0, 0.0]), [1.5708, 0.0, 0.0]);
        assert!(off.found.is_empty());
    }
}
