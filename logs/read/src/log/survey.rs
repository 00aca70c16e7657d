//! Surveys a log by reading it once.

mod agreement;
mod runs;

use std::ops::Range;

use self::agreement::Agreement;
pub use self::runs::Run;
use self::runs::Runs;
use crate::columns::quantity::Quantity;
use crate::limits::{FEW_ROWS, MOST_FILLED};
use crate::log::frozen_position::{FrozenPosition, FrozenPositions};
use crate::log::layout::Layout;
use crate::log::pass::{Counts, Interruption, InvalidSample, State};
use crate::number::short;
use crate::options::Angles;
use crate::remedy::Setting;
use crate::signal::grid::Grid;
use crate::signal::kernel::{HIGHEST, Kernel, PASSED};
use crate::signal::spectrum::Spectrum;
use crate::signal::spikes::{Spike, Spikes};
use crate::{Log, LogError};

impl Log {
    /// Reads the log once and reports runs, ranges, messages that are left out, and a cut-off from the spectrum of the
    /// motion. `progress` is called with the fraction that was read, 0 to 1.
    ///
    /// # Errors
    ///
    /// If a file cannot be read to its end.
    pub fn survey(&self, progress: impl FnMut(f64)) -> Result<Survey, LogError> {
        Survey::of(self, progress)
    }

    /// Returns the duration that a filter with this cut-off, Hz, leaves of the longest run, s; zero if it drops the
    /// whole run. The survey is of this log, with any filter.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "states of a run")]
    pub fn left(&self, survey: &Survey, cutoff: f64) -> f64 {
        let dropped = self.dropped(Kernel::half_of(cutoff, self.layout.step)).saturating_mul(2);
        survey.longest.saturating_sub((dropped as u64).saturating_add(1)) as f64 * self.layout.step
    }
}

/// Length of a segment of the spectrum, s, and the shorter lengths that are tried if no run is long enough.
const SEGMENTS: [f64; 3] = [4.0, 2.0, 1.0];

/// The lowest cut-off that is chosen from a spectrum, Hz: a lower one would drop seconds at both ends of a run.
const LOWEST: f64 = 2.0;

/// The highest cut-off that is chosen from a spectrum, as a part of the sampling rate: above it, differences do not
/// approximate derivatives.
const HIGHEST_CHOSEN: f64 = 0.2;

/// Range of positions, rad, above which they may be in degrees.
const WIDEST: f64 = 4.0 * std::f64::consts::PI;

/// Survey of a log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Survey {
    /// Counts of messages that were read, and of those that were left out.
    pub counts: Counts,
    /// The first thousand runs.
    pub runs: Vec<Run>,
    /// Number of runs.
    pub run_count: u64,
    /// Number of states of the longest run after interpolation to an even grid.
    pub longest: u64,
    /// Efforts of one or two samples that differ strongly from the samples before and after. At most the ten thousand
    /// largest spikes of each joint are kept, and fewer with more than a hundred joints. The motions contain them,
    /// unless [`Options::leave_out_spikes`](crate::Options::leave_out_spikes) is set.
    pub spikes: Vec<Spike>,
    /// The first number that made a message invalid; [`Counts::not_finite`] counts such messages.
    pub invalid_sample: Option<InvalidSample>,
    /// For each joint the smallest and largest position, rad or m.
    pub positions: Vec<(f64, f64)>,
    /// For each joint the smallest and largest velocity, rad/s or m/s; empty if the log has no velocities.
    pub velocities: Vec<(f64, f64)>,
    /// For each joint the smallest and largest torque, N m, or force, N; empty if the log has no efforts.
    pub efforts: Vec<(f64, f64)>,
    /// For each joint the difference between measured velocities and differences of positions, root mean square,
    /// relative to the latter; empty if the log has no velocities.
    pub disagreement: Vec<f64>,
    /// Positions that keep one value although the measured velocity shows that the joint moves.
    pub frozen_positions: Vec<FrozenPosition>,
    /// The cut-off of the filter.
    pub cutoff: Cutoff,
    /// Number of states at each end of a run that the filter drops. A run with at most twice this number gives no
    /// states.
    pub dropped: usize,
}

/// The cut-off of the filter, and its source.
#[derive(Clone, Debug, PartialEq)]
pub enum Cutoff {
    /// The options give the cut-off.
    Given {
        /// The cut-off, Hz.
        hertz: f64,
    },
    /// The cut-off follows from the spectrum of positions: the motion is in the pass band, which ends at two thirds of
    /// the cut-off.
    Spectrum {
        /// The cut-off, Hz.
        hertz: f64,
        /// For each joint the frequency, Hz, above which its motion cannot be distinguished from noise.
        ends: Vec<f64>,
        /// Whether the cut-off is limited to the lowest or highest one that is chosen: 2 Hz, or a fifth of the sampling
        /// rate.
        bounded: bool,
    },
    /// No cut-off: all runs are shorter than a segment of the spectrum, one second or 64 states.
    Unknown,
}

impl Cutoff {
    /// Returns the cut-off, Hz; `None` without a cut-off.
    #[must_use]
    pub fn hertz(&self) -> Option<f64> {
        match self {
            Self::Given { hertz } | Self::Spectrum { hertz, .. } => Some(*hertz),
            Self::Unknown => None,
        }
    }
}

impl Survey {
    pub(crate) fn of(log: &Log, mut progress: impl FnMut(f64)) -> Result<Self, LogError> {
        let layout = &log.layout;
        let mut gathered = Gathered::new(layout);
        let mut pass = log.pass()?;
        let mut count = 0_u64;
        loop {
            count += 1;
            if count.is_multiple_of(4096) {
                progress(pass.progress());
            }
            let Some((state, begins)) = pass.next()? else { break };
            gathered.push(log, state, begins);
            if gathered.rows > FEW_ROWS && gathered.rows / MOST_FILLED > count {
                let what = format!(
                    "the first {count} states of the log, up to {} s, have such long intervals that rne would \
                     interpolate more than {MOST_FILLED} states for each of them: choose a lower limit of gaps, so \
                     that rne does not fill long intervals",
                    short(log.seconds(state.time))
                );
                return Err(log.request(what).give(Setting::Gap));
            }
        }
        gathered.end_grid();
        let Gathered { spectra, ranges, spikes, agreement, frozen_positions, mut runs, .. } = gathered;
        let counts = pass.counts;
        let cutoff = log.cutoff(&spectra)?;
        let dropped = cutoff.hertz().map_or(0, |hertz| log.dropped(Kernel::half_of(hertz, layout.step)));
        let invalid_sample = pass.invalid_sample.take();
        let spikes = spikes.end(counts.states);
        let longest = runs.longest(layout.step);
        let (run_count, runs) = runs.end();
        let [positions, velocities, efforts, _] =
            Quantity::ALL.map(|quantity| ranges[layout.places(quantity)].to_vec());
        let disagreement = agreement.end();
        Ok(Self {
            counts,
            runs,
            run_count,
            longest,
            spikes,
            invalid_sample,
            positions,
            velocities,
            efforts,
            disagreement,
            frozen_positions: frozen_positions.end(),
            cutoff,
            dropped,
        })
    }

    /// Returns the joint whose positions may be in degrees, and their range: no unit is given, and the range is more
    /// than 4π.
    #[must_use]
    pub fn may_be_degrees(&self, log: &Log) -> Option<(usize, f64)> {
        if log.options.angles != Angles::Unsaid {
            return None;
        }
        let ranges = self.positions.iter().map(|(least, most)| most - least).enumerate();
        let is_unsaid = |joint: usize| log.layout.units[joint].position.is_none();
        ranges.filter(|(joint, range)| *range > WIDEST && is_unsaid(*joint)).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

impl Log {
    /// Returns the cut-off of the options or, without one, that from the spectra of positions.
    fn cutoff(&self, spectra: &[Spectrum]) -> Result<Cutoff, LogError> {
        let rate = 1.0 / self.layout.step;
        match self.options.cutoff {
            Some(hertz) if hertz <= HIGHEST * rate => Ok(Cutoff::Given { hertz }),
            Some(hertz) => {
                let what = format!(
                    "a cut-off of {} Hz is too high for samples at {rate:.4} Hz: it can be at most {:.4} Hz",
                    short(hertz),
                    HIGHEST * rate
                );
                Err(self.request(what))
            }
            None => Ok(spectra.iter().find_map(Spectrum::ends).map_or(Cutoff::Unknown, |ends| chosen(ends, rate))),
        }
    }

    /// Converts a stamp, ns, to seconds since the origin.
    #[expect(clippy::cast_precision_loss, reason = "a quarter of a ns after a month")]
    pub(crate) fn seconds(&self, time: i64) -> f64 {
        time.saturating_sub(self.layout.origin) as f64 * 1e-9
    }

    /// Returns the number of states at each end of a run that are dropped, if the filter needs `half` numbers on each
    /// side.
    pub(crate) fn dropped(&self, half: usize) -> usize {
        half.saturating_add(self.of_differences())
    }

    /// Returns the number of states at each end of a run that are dropped because of differences.
    pub(crate) fn of_differences(&self) -> usize {
        if self.layout.has_velocities { Kernel::of_difference() } else { 2 * Kernel::of_difference() }
    }
}

/// The results that a survey gathers state by state.
struct Gathered {
    spectra: [Spectrum; 3],
    ranges: Vec<(f64, f64)>,
    spikes: Spikes,
    /// The indices of efforts among the numbers of a state.
    efforts: Range<usize>,
    agreement: Agreement,
    frozen_positions: FrozenPositions,
    runs: Runs,
    /// The even grid of this run, and the number of rows so far, including previous runs.
    grid: Option<Grid>,
    rows: u64,
}

impl Gathered {
    fn new(layout: &Layout) -> Self {
        let joints = layout.joints.len();
        let with_velocities = if layout.has_velocities { joints } else { 0 };
        Self {
            spectra: SEGMENTS.map(|seconds| Spectrum::new(joints, 1.0 / layout.step, seconds)),
            ranges: vec![(f64::INFINITY, f64::NEG_INFINITY); layout.width()],
            spikes: Spikes::new(if layout.has_efforts { joints } else { 0 }),
            efforts: layout.places(Quantity::Effort),
            agreement: Agreement::new(with_velocities),
            frozen_positions: FrozenPositions::new(with_velocities),
            runs: Runs::default(),
            grid: None,
            rows: 0,
        }
    }

    fn push(&mut self, log: &Log, state: &State, begins: Option<Interruption>) {
        let (layout, seconds) = (&log.layout, log.seconds(state.time));
        for (range, number) in self.ranges.iter_mut().zip(&state.numbers) {
            *range = (range.0.min(*number), range.1.max(*number));
        }
        if let Some(begins) = begins {
            self.end_grid();
            self.spectra.iter_mut().for_each(Spectrum::end_run);
            self.spikes.end_run();
            self.runs.begin(seconds, begins);
            self.agreement.previous = None;
            self.frozen_positions.begin_run(begins == Interruption::Beginning);
        } else {
            self.runs.push(seconds, layout.step);
        }
        self.agreement.push(state.time, &state.numbers);
        self.frozen_positions.push(seconds, &state.numbers);
        self.spikes.push(state.message, seconds, &state.numbers[self.efforts.clone()]);
        let grid = self.grid.get_or_insert_with(|| Grid::new(layout.step * 1e9, state.time));
        grid.push(state.time, &state.numbers, &mut |row| {
            self.rows += 1;
            push(&mut self.spectra, row);
        });
    }

    fn end_grid(&mut self) {
        if let Some(grid) = self.grid.take() {
            grid.finish(&mut |row| push(&mut self.spectra, row));
        }
    }
}

fn push(spectra: &mut [Spectrum], row: &[f64]) {
    for spectrum in spectra {
        spectrum.push(row);
    }
}

fn chosen(ends: Vec<f64>, rate: f64) -> Cutoff {
    let highest = ends.iter().copied().fold(0.0, f64::max);
    let wanted = highest / PASSED;
    let hertz = wanted.max(LOWEST).min(HIGHEST_CHOSEN * rate);
    Cutoff::Spectrum { hertz, ends, bounded: hertz != wanted }
}
