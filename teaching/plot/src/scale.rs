//! Axes of a chart: conversion of numbers to pixels, and ticks.

/// Smallest span of an axis, below which steps would lose floating-point precision.
const SMALLEST: f64 = 1e-300;

/// A linear axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    low: f64,
    high: f64,
    /// Positions of both ends, pixels.
    from: f64,
    to: f64,
}

impl Scale {
    pub(crate) const fn new(low: f64, high: f64, from: f64, to: f64) -> Self {
        Self { low, high, from, to }
    }

    /// Returns the numbers at both ends.
    pub(crate) const fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Returns the position of a number, pixels; the middle of the axis if its ends are too close to distinguish
    /// numbers.
    pub(crate) fn at(&self, value: f64) -> f64 {
        let half = self.high / 2.0 - self.low / 2.0;
        let part = if half < SMALLEST { 0.5 } else { (value / 2.0 - self.low / 2.0) / half };
        self.from + part * (self.to - self.from)
    }

    /// Returns round numbers on the axis; `about` is the approximate number of ticks.
    pub(crate) fn ticks(&self, about: f64) -> Vec<f64> {
        let span = self.high - self.low;
        if !span.is_finite() || span < SMALLEST {
            return Vec::new();
        }
        let step = step(span, about);
        let first = (self.low / step - 1e-9).ceil();
        let last = (self.high / step + 1e-9).floor();
        let mut ticks = Vec::new();
        let mut count = first;
        while count <= last && ticks.len() < 32 {
            // changes -0 to 0
            ticks.push(count * step + 0.0);
            count += 1.0;
        }
        ticks
    }
}

/// Returns round numbers for both ends of an axis that includes all values and 0.
pub(crate) fn range(values: impl Iterator<Item = f64>, about: f64) -> (f64, f64) {
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if high - low < SMALLEST || !(high - low).is_finite() {
        return (-1.0, 1.0);
    }
    let step = step(high - low, about);
    ((low / step - 0.05).floor() * step, (high / step + 0.05).ceil() * step)
}

/// Returns the step between ticks: 1, 2 or 5 times a power of ten.
fn step(span: f64, about: f64) -> f64 {
    let rough = span / about;
    let power = 10_f64.powf(rough.log10().floor());
    let factor = rough / power;
    let round = if factor < 1.5 {
        1.0
    } else if factor < 3.5 {
        2.0
    } else if factor < 7.5 {
        5.0
    } else {
        10.0
    };
    round * power
}

/// Formats a number next to a tick, with a minus sign that is as long as a plus sign.
pub(crate) fn label(value: f64) -> String {
    // removes rounding errors of steps, such as 0.30000000000000004
    significant(value, 10)
}

/// Formats a number with `digits` significant digits, without trailing zeros.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.0$e}", digits - 1).parse().unwrap_or(value);
    let text = if rounded != 0.0 && (rounded.abs() < 1e-4 || rounded.abs() >= 1e6) {
        format!("{rounded:e}")
    } else {
        format!("{}", rounded + 0.0)
    };
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        for (low, high) in [(0.0, 2.0), (-37.6, 81.2), (-1e-7, 3e-7), (-1e12, 0.0), (0.03, 0.0305)] {
            let ticks = Scale::new(low, high, 0.0, 100.0).ticks(5.0);
            assert!((3..=12).contains(&ticks.len()), "{low} {high}: {ticks:?}");
            let slack = 1e-6 * (high - low);
            assert!(ticks.iter().all(|tick| (low - slack..=high + slack).contains(tick)), "{ticks:?}");
        }
        assert_eq!(Scale::new(0.0, 2.0, 0.0, 100.0).ticks(4.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(range([3.0, -7.2].into_iter(), 5.0), (-8.0, 4.0));
        assert_eq!(range([0.0].into_iter(), 5.0), (-1.0, 1.0));
        assert_eq!((label(0.1 + 0.2), label(-20.0), label(0.0)), ("0.3".into(), "\u{2212}20".into(), "0".into()));
        assert_eq!((significant(-37.682, 3), significant(1234.5, 3)), ("\u{2212}37.7".into(), "1230".into()));
    }

    #[test]
    fn the_ends_of_an_axis_are_its_pixels() {
        let scale = Scale::new(-2.0, 6.0, 300.0, 100.0);
        assert_eq!([-2.0, 0.0, 6.0].map(|value| scale.at(value)), [300.0, 250.0, 100.0]);
    }

    #[test]
    fn an_axis_of_any_length_has_places() {
        for (low, high) in [(-1e308, 1e308), (0.0, 5e-324), (-5e-324, 1e-310), (1e17, 1e17 + 16.0)] {
            let scale = Scale::new(low, high, 0.0, 100.0);
            let values = [low, high].into_iter().chain(scale.ticks(5.0));
            let places: Vec<f64> = values.map(|value| scale.at(value)).collect();
            assert!(places.iter().all(|place| (-1e-6..=100.0 + 1e-6).contains(place)), "{low} {high}: {places:?}");
            let (low, high) = range([low, high].into_iter(), 5.0);
            assert!(low < high && low.is_finite() && high.is_finite(), "{low} {high}");
        }
    }
}
