//! Resamples samples with jittering times to even times.

use std::collections::VecDeque;

/// Resamples one run to an even grid that begins at its first sample.
///
/// Between the middle two of four samples, it interpolates by the cubic through the four. At the ends of a run, it
/// interpolates linearly, and also where samples are closer than half a step, because the cubic would amplify their
/// noise.
pub(crate) struct Grid {
    /// Step of the grid, ns.
    step: f64,
    /// Time of the run's first sample, ns.
    begin: i64,
    /// The samples around the next rows, with their times since the run's first sample, ns.
    near: VecDeque<(f64, Vec<f64>)>,
    /// Index of the next row of the grid.
    row: u64,
    /// Number of samples of the run.
    count: u64,
}

impl Grid {
    /// Largest time, in steps, by which the last sample of a run may be before the grid's last row, because stamps are
    /// rounded.
    pub(crate) const CLOSE: f64 = 1e-3;

    /// Makes a grid with this step, ns, for a run that begins at this time, ns.
    pub(crate) fn new(step: f64, begin: i64) -> Self {
        Self { step, begin, near: VecDeque::with_capacity(4), row: 0, count: 0 }
    }

    /// Adds the next sample; `emit` is called with each row that can now be computed.
    #[expect(clippy::cast_precision_loss, reason = "ns since the run's beginning")]
    pub(crate) fn push(&mut self, time: i64, numbers: &[f64], emit: &mut impl FnMut(&[f64])) {
        let recycled = if self.near.len() == 4 { self.near.pop_front() } else { None };
        let mut sample = recycled.map_or_else(Vec::new, |(_, numbers)| numbers);
        sample.clear();
        sample.extend_from_slice(numbers);
        self.near.push_back((time.saturating_sub(self.begin) as f64, sample));
        self.count += 1;
        match self.near.len() {
            2 => self.emit(0, false, emit),
            4 => self.emit(1, false, emit),
            _ => {}
        }
    }

    /// Ends the run; `emit` is called with the rows of its last interval.
    pub(crate) fn finish(mut self, emit: &mut impl FnMut(&[f64])) {
        match self.near.len() {
            0 => {}
            1 => emit(&self.near[0].1),
            count => self.emit(count - 2, true, emit),
        }
    }

    /// Computes the rows between a sample and the next one; with `last` also the row at its end.
    #[expect(clippy::cast_precision_loss, reason = "rows are fewer than 2^53")]
    fn emit(&mut self, first: usize, last: bool, emit: &mut impl FnMut(&[f64])) {
        let (begin, end) = (self.near[first].0, self.near[first + 1].0);
        // the grid also has a row at the last sample
        let end = if last { end + Self::CLOSE * self.step } else { end };
        let is_cubic = first == 1
            && self.near.len() == 4
            && (0..3).all(|i| self.near[i + 1].0 - self.near[i].0 >= 0.5 * self.step);
        let mut numbers = vec![0.0; self.near[first].1.len()];
        loop {
            let time = self.row as f64 * self.step;
            if time >= end {
                return;
            }
            let used = if is_cubic { 0..4 } else { first..first + 2 };
            numbers.fill(0.0);
            for i in used.clone() {
                let others = used.clone().filter(|j| *j != i);
                let at = if is_cubic { time } else { time.clamp(begin, self.near[first + 1].0) };
                let weight: f64 = others.map(|j| (at - self.near[j].0) / (self.near[i].0 - self.near[j].0)).product();
                for (number, sample) in numbers.iter_mut().zip(&self.near[i].1) {
                    *number += weight * sample;
                }
            }
            emit(&numbers);
            self.row += 1;
        }
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small")]
mod tests {
    use super::*;

    fn resample(step: f64, samples: &[(i64, f64)]) -> Vec<f64> {
        let mut rows = Vec::new();
        let mut emit = |row: &[f64]| rows.push(row[0]);
        let mut grid = Grid::new(step, samples[0].0);
        for (time, number) in samples {
            grid.push(*time, &[*number], &mut emit);
        }
        grid.finish(&mut emit);
        rows
    }

    #[test]
    fn even_samples_stay_as_they_are() {
        for count in 1..9 {
            let samples: Vec<_> = (0..count).map(|i| (7 + i * 8, f64::from(i as i32).sin())).collect();
            let rows = resample(8.0, &samples);
            assert_eq!(rows, samples.iter().map(|(_, x)| *x).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_cubic_is_kept_where_stamps_jitter() {
        let cubic = |t: f64| 1.0 + t * (0.5 + t * (0.3 - t * 0.2));
        let times: Vec<i64> =
            (0..50).map(|i| i * 1_000_000 + [0, 200_000, -300_000, 100_000][i as usize % 4]).collect();
        let samples: Vec<_> = times.iter().map(|t| (*t, cubic(*t as f64 * 1e-7))).collect();
        let rows = resample(1e6, &samples);
        assert_eq!(rows.len(), 50);
        for (i, row) in rows.iter().enumerate().take(48).skip(2) {
            assert!((row - cubic(i as f64 * 0.1)).abs() < 1e-9, "{i}: {row}");
        }
    }

    #[test]
    fn bursts_do_not_blow_up_noise() {
        let samples: Vec<_> = (0..40).map(|i| (i * 100 - (i % 2) * 99, if i % 3 == 0 { 1.0 } else { -1.0 })).collect();
        assert!(resample(100.0, &samples).iter().all(|x| x.abs() < 2.0));
    }
}
