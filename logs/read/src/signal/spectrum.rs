//! Finds from the spectrum of positions the frequency at which the motion of a log ends and its noise begins.
//!
//! The method of P. D. Welch (1967): segments whose number of rows is a power of two, at least `seconds` long, with
//! half overlap; their least-squares line is subtracted, and they are multiplied by a Blackman-Harris window (F. J.
//! Harris, 1978, four terms, side lobes at −92 dB). Segments of very high rates, and of more than 64 columns, are
//! shorter, so that memory is bounded.

use std::f64::consts::PI;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use crate::limits::MOST_NUMBERS;

/// Power above this multiple of the noise floor counts as motion.
const ABOVE_FLOOR: f64 = 10.0;

/// Smallest noise floor as a part of the largest power: the window cannot resolve less.
const LEAST_FLOOR: f64 = 1e-10;

/// Number of neighbouring frequencies on each side over which power is averaged before it is compared.
const SMOOTHED: usize = 2;

/// The power spectra of some columns, summed over the segments so far.
pub(crate) struct Spectrum {
    fft: Arc<dyn Fft<f64>>,
    window: Vec<f64>,
    /// For each column, the rows of the current segment.
    rows: Vec<Vec<f64>>,
    /// The power by column and frequency; empty before the first segment.
    power: Vec<Vec<f64>>,
    segments: u64,
    rate: f64,
}

impl Spectrum {
    /// Sets up spectra of columns with this sampling rate, Hz, in segments of at least `seconds`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "bounded")]
    pub(crate) fn new(columns: usize, rate: f64, seconds: f64) -> Self {
        let room = (MOST_NUMBERS / columns.max(1)).clamp(64, 65_536);
        // the largest power of two that is not larger
        let longest = 1 << room.ilog2();
        let length = ((seconds * rate).clamp(64.0, 65_536.0).ceil() as usize).next_power_of_two().min(longest);
        let window = |i: usize| {
            let angle = 2.0 * PI * i as f64 / length as f64;
            0.358_75 - 0.488_29 * angle.cos() + 0.141_28 * (2.0 * angle).cos() - 0.011_68 * (3.0 * angle).cos()
        };
        Self {
            fft: FftPlanner::new().plan_fft_forward(length),
            window: (0..length).map(window).collect(),
            rows: vec![Vec::new(); columns],
            power: vec![Vec::new(); columns],
            segments: 0,
            rate,
        }
    }

    /// Adds a row of a run.
    pub(crate) fn push(&mut self, row: &[f64]) {
        for (rows, number) in self.rows.iter_mut().zip(row) {
            rows.push(*number);
        }
        let length = self.window.len();
        if self.rows.first().is_none_or(|rows| rows.len() < length) {
            return;
        }
        self.segments += 1;
        let mut values = vec![Complex::default(); length];
        for (rows, power) in self.rows.iter_mut().zip(&mut self.power) {
            let (level, slope) = line(rows);
            #[expect(clippy::cast_precision_loss, reason = "a power of two below 2^17")]
            for (i, ((value, row), weight)) in values.iter_mut().zip(&*rows).zip(&self.window).enumerate() {
                *value = Complex::new((row - level - slope * i as f64) * weight, 0.0);
            }
            self.fft.process(&mut values);
            power.resize(length / 2 + 1, 0.0);
            for (power, value) in power.iter_mut().zip(&values) {
                *power += value.norm_sqr();
            }
            rows.drain(..length / 2);
        }
    }

    /// Ends a run; the rest that is shorter than a segment is dropped.
    pub(crate) fn end_run(&mut self) {
        self.rows.iter_mut().for_each(Vec::clear);
    }

    /// Returns for each column the frequency, Hz, above which there is no motion. There, the power, averaged over five
    /// neighbours, is at most ten times the noise floor, which is the median of the upper half of the spectrum. `None`
    /// if no run had a segment.
    #[expect(clippy::cast_precision_loss, reason = "frequencies are few")]
    pub(crate) fn ends(&self) -> Option<Vec<f64>> {
        if self.segments == 0 {
            return None;
        }
        let highest = |power: &Vec<f64>| {
            let mut upper = power[power.len() / 2..].to_vec();
            let middle = upper.len() / 2;
            let median = *upper.select_nth_unstable_by(middle, f64::total_cmp).1;
            let greatest = power.iter().copied().fold(0.0, f64::max);
            let floor = median.max(LEAST_FLOOR * greatest);
            let averaged = |i: usize| {
                let near = &power[i.saturating_sub(SMOOTHED)..(i + SMOOTHED + 1).min(power.len())];
                near.iter().sum::<f64>() / near.len() as f64
            };
            let end = (1..power.len()).rev().find(|i| averaged(*i) > ABOVE_FLOOR * floor).unwrap_or(0);
            end as f64 * self.rate / self.window.len() as f64
        };
        Some(self.power.iter().map(highest).collect())
    }
}

/// Returns the least-squares line through rows: its first value, and its increase from row to row.
#[expect(clippy::cast_precision_loss, reason = "rows of a segment")]
fn line(rows: &[f64]) -> (f64, f64) {
    let count = rows.len() as f64;
    let middle = (count - 1.0) / 2.0;
    let mean = rows.iter().sum::<f64>() / count;
    let product: f64 = rows.iter().enumerate().map(|(i, row)| (i as f64 - middle) * (row - mean)).sum();
    let slope = 12.0 * product / (count * (count * count - 1.0));
    (mean - slope * middle, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motion_ends_where_its_fastest_sine_is() {
        // a sine of 3 Hz with noise of a thousandth of its amplitude
        let mut random = fastrand::Rng::with_seed(5);
        let mut spectrum = Spectrum::new(2, 200.0, 4.0);
        for i in 0..8000 {
            let time = f64::from(i) / 200.0;
            let noise = (random.f64() - 0.5) * 2e-3;
            spectrum.push(&[(2.0 * PI * 3.0 * time).sin() + noise, noise]);
        }
        let ends = spectrum.ends().unwrap();
        assert!(ends[0] > 3.0 && ends[0] < 5.0, "{ends:?}");
        assert_eq!(ends[1], 0.0, "noise alone is no motion");
    }

    /// The count of stored numbers is bounded, also for a long log with a sampling rate of 1 MHz.
    #[test]
    fn many_columns_hold_no_more_numbers_than_few() {
        for columns in [1, 64, 65, 1024] {
            let mut spectrum = Spectrum::new(columns, 1e6, 4.0);
            let held =
                |spectrum: &Spectrum| -> usize { spectrum.rows.iter().chain(&spectrum.power).map(Vec::capacity).sum() };
            assert_eq!(held(&spectrum), 0, "nothing is held before there is a row");
            let length = spectrum.window.len();
            assert_eq!(length, if columns <= 64 { 65_536 } else { 4_194_304 / columns.next_power_of_two() });
            let row = vec![1.0; columns];
            (0..length + length / 2).for_each(|_| spectrum.push(&row));
            assert!(held(&spectrum) <= 3 * MOST_NUMBERS / 2 + 2 * columns, "{columns}: {}", held(&spectrum));
            assert_eq!(spectrum.segments, 2);
        }
    }

    #[test]
    fn runs_that_are_too_short_have_no_spectrum() {
        let mut spectrum = Spectrum::new(1, 100.0, 4.0);
        for i in 0..1000 {
            spectrum.push(&[f64::from(i)]);
            if i % 100 == 0 {
                spectrum.end_run();
            }
        }
        assert_eq!(spectrum.ends(), None);
    }
}
