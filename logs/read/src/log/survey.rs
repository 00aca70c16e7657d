//! Survey of a log, by one reading of it.

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
    /// Reads the log once: runs, ranges, what is missing, and the cut-off that its spectrum chooses. `progress` is told
    /// the share that was read, 0 to 1.
    ///
    /// # Errors
    ///
    /// If a file cannot be read to its end.
    pub fn survey(&self, progress: impl FnMut(f64)) -> Result<Survey, LogError> {
        Survey::of(self, progress)
    }

    /// How much of the longest run a filter of a cut-off, Hz, leaves, s: zero, where it drops all of it. The survey is
    /// of this log, by whatever filter.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "states of a run")]
    pub fn left(&self, survey: &Survey, cutoff: f64) -> f64 {
        let dropped = self.dropped(Kernel::half_of(cutoff, self.layout.step)).saturating_mul(2);
        survey.longest.saturating_sub((dropped as u64).saturating_add(1)) as f64 * self.layout.step
    }
}

/// Seconds of a segment of the spectrum, and those that are tried where no run is as long.
const SEGMENTS: [f64; 3] = [4.0, 2.0, 1.0];

/// The lowest cut-off that a spectrum chooses, Hz: a lower one costs seconds at both ends of a run.
const LOWEST: f64 = 2.0;

/// The highest cut-off that a spectrum chooses, of the rate: beyond it differences are no derivatives.
const HIGHEST_CHOSEN: f64 = 0.2;

/// Positions over more than this, rad, may be degrees.
const WIDEST: f64 = 4.0 * std::f64::consts::PI;

/// Survey of a log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Survey {
    /// Counts of messages that were read, and of those that were left out.
    pub counts: Counts,
    /// The runs, the first thousand of them.
    pub runs: Vec<Run>,
    /// How many runs there are.
    pub run_count: u64,
    /// States of the longest run on an even grid, as the filter takes them.
    pub longest: u64,
    /// Efforts that stand far out of those about them for a sample or two, the farthest ten thousand of each joint, and
    /// fewer of more than a hundred joints; in the motions, unless
    /// [`Options::leave_out_spikes`](crate::Options::leave_out_spikes) says otherwise.
    pub spikes: Vec<Spike>,
    /// The first number that made a message invalid, of those that [`Counts::not_finite`] counts.
    pub invalid_sample: Option<InvalidSample>,
    /// By joint: the least and the greatest position, rad or m.
    pub positions: Vec<(f64, f64)>,
    /// By joint: the least and the greatest velocity, rad/s or m/s; empty where the log has none.
    pub velocities: Vec<(f64, f64)>,
    /// By joint: the least and the greatest torque, N m, or force, N; empty where the log has none.
    pub efforts: Vec<(f64, f64)>,
    /// By joint: how far velocities are from the differences of positions, root mean square, of those differences;
    /// empty where the log has no velocities.
    pub disagreement: Vec<f64>,
    /// Positions that keep one value while the measured velocity says that the joint moves.
    pub frozen_positions: Vec<FrozenPosition>,
    /// The cut-off of the filter.
    pub cutoff: Cutoff,
    /// States at each end of a run that the filter drops; a run with no more than twice as many gives none.
    pub dropped: usize,
}

/// The cut-off of the filter, and where it is from.
#[derive(Clone, Debug, PartialEq)]
pub enum Cutoff {
    /// The options say it.
    Given {
        /// Hz
        hertz: f64,
    },
    /// The spectrum of positions chose it: what moves is in the pass band, which ends at two thirds of the cut-off.
    Spectrum {
        /// Hz
        hertz: f64,
        /// By joint the frequency at which its motion goes under in noise, Hz.
        ends: Vec<f64>,
        /// Whether it is the lowest or the highest that is chosen, 2 Hz or a fifth of the rate.
        bounded: bool,
    },
    /// No run is as long as a segment of the spectrum, a second or 64 states.
    Unknown,
}

impl Cutoff {
    /// Hz; none if it is not known.
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

    /// The joint whose positions may be degrees, and their range: nobody said that they are radians, and they range
    /// over more than 4π.
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
    /// The cut-off of the options, or else the one that the spectra of positions choose.
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

    /// Seconds of a stamp, ns, since the origin.
    #[expect(clippy::cast_precision_loss, reason = "a quarter of a ns after a month")]
    pub(crate) fn seconds(&self, time: i64) -> f64 {
        time.saturating_sub(self.layout.origin) as f64 * 1e-9
    }

    /// States at each end of a run that a filter drops, if it needs `half` numbers on each side.
    pub(crate) fn dropped(&self, half: usize) -> usize {
        half.saturating_add(self.of_differences())
    }

    /// States at each end of a run that differences drop.
    pub(crate) fn of_differences(&self) -> usize {
        if self.layout.has_velocities { Kernel::of_difference() } else { 2 * Kernel::of_difference() }
    }
}

/// The findings that a survey gathers from state to state.
struct Gathered {
    spectra: [Spectrum; 3],
    ranges: Vec<(f64, f64)>,
    spikes: Spikes,
    /// The places of efforts among the numbers of a state.
    efforts: Range<usize>,
    agreement: Agreement,
    frozen_positions: FrozenPositions,
    runs: Runs,
    /// The even grid of this run, and its rows so far with those of the runs before.
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
