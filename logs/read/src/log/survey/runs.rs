//! Lists the runs of a log.

use crate::log::pass::Interruption;
use crate::signal::grid::Grid;

/// Largest number of runs that are listed; further runs are only counted.
const LISTED: usize = 1000;

/// A run: successive states without an interruption.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Run {
    /// The reason for which the run begins.
    pub begins: Interruption,
    /// Time of the first state, s.
    pub start: f64,
    /// Duration, s.
    pub duration: f64,
    /// Number of states.
    pub states: u64,
    /// The root mean square deviation of intervals from the log's median interval, s.
    pub jitter: f64,
    /// The longest interval, s.
    pub longest: f64,
}

/// The runs so far.
#[derive(Default)]
pub(super) struct Runs {
    ended: Vec<Run>,
    count: u64,
    /// Duration of the longest run, s.
    longest: f64,
    last: Option<Run>,
    time: f64,
    squares: f64,
}

impl Runs {
    pub(super) fn begin(&mut self, start: f64, begins: Interruption) {
        self.end_run();
        self.count += 1;
        self.last = Some(Run { begins, start, duration: 0.0, states: 1, jitter: 0.0, longest: 0.0 });
        (self.time, self.squares) = (start, 0.0);
    }

    pub(super) fn push(&mut self, time: f64, step: f64) {
        let Some(run) = &mut self.last else { return };
        let interval = time - self.time;
        run.duration = time - run.start;
        run.states += 1;
        run.longest = run.longest.max(interval);
        self.squares += (interval - step).powi(2);
        self.time = time;
    }

    #[expect(clippy::cast_precision_loss, reason = "intervals are fewer than 2^53")]
    fn end_run(&mut self) {
        let Some(mut run) = self.last.take() else { return };
        run.jitter = (self.squares / (run.states - 1).max(1) as f64).sqrt();
        self.longest = self.longest.max(run.duration);
        if self.ended.len() < LISTED {
            self.ended.push(run);
        }
    }

    /// Returns the number of rows of the longest run on a grid with this step, s.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows of a run")]
    pub(super) fn longest(&mut self, step: f64) -> u64 {
        self.end_run();
        if self.count == 0 { 0 } else { (self.longest / step + Grid::CLOSE).floor() as u64 + 1 }
    }

    pub(super) fn end(mut self) -> (u64, Vec<Run>) {
        self.end_run();
        (self.count, self.ended)
    }
}
