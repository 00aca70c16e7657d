//! The information of logs about the unknowns: triangular QR factors of weighted rows, in memory that does not grow
//! with the logs.

mod instants;
mod motion_error;
mod numbers;
mod rows;
mod weighting;

use nalgebra::DMatrix;
use rne_logs::Motion;

pub(crate) use self::instants::instants;
pub use self::motion_error::MotionError;
pub(crate) use self::motion_error::checked;
pub use self::numbers::WrongNumbers;
pub(crate) use self::rows::{Walk, plain_columns, rows};
pub(crate) use self::weighting::CORRELATED;
pub use self::weighting::{Rejected, Weighting};
use crate::fit::prior::Scales;
use crate::fit::r_factor::{RFactor, effort};
use crate::fit::structure::Structure;

/// Number of instants whose rows are computed at once.
pub(crate) const WINDOW: usize = 2048;

/// Largest number of segments of time that are kept apart; beyond it, neighbours are merged.
const SEGMENTS: usize = 64;

/// Length of the shortest segment, in widths of the filter or, without a filter, in states.
const LENGTH: f64 = 20.0;
const STATES_UNFILTERED: u64 = 64;

/// Length that marks rows without an order in time, which form one segment.
const UNORDERED: u64 = u64::MAX;

/// For each joint, the triangular factor of its rows in a segment of time.
pub(crate) type Segment = Vec<RFactor>;

/// The information of logs about the unknowns: for each joint the triangular factor of its rows, in up to 64 segments
/// of time. The segments give standard deviations that allow for correlated errors. Parts of logs can be read into
/// several of these, which are merged afterwards.
#[derive(Clone, Debug)]
pub struct Information {
    pub(crate) segments: Vec<Segment>,
    /// Number of rows of a joint in each segment.
    length: u64,
    /// Number of states that were read.
    pub(crate) states: u64,
    pub(crate) duration: f64,
    /// Time by which torques were taken later than positions, s.
    pub(crate) shift: f64,
    /// The largest magnitude of the effort of each joint, N m or N.
    pub(crate) largest: Vec<f64>,
    /// For each joint, the rows that do not count because their residuals are too large.
    pub(crate) rejected: Vec<Option<Rejected>>,
}

impl Information {
    /// Empty information, before any log.
    #[must_use]
    pub fn new(structure: &Structure) -> Self {
        let length = match structure.options.cutoff {
            // one row per width of the filter
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            Some(_) => LENGTH as u64,
            None => STATES_UNFILTERED,
        };
        let rejected = vec![None; structure.dof()];
        let largest = vec![0.0; structure.dof()];
        Self { segments: Vec::new(), length, states: 0, duration: 0.0, shift: 0.0, largest, rejected }
    }

    /// Empty information for rows without an order in time, such as those of a table. No segments are kept apart: the
    /// memory is one triangular factor for each joint, and the order of rows and of merging changes results by rounding
    /// only.
    #[must_use]
    pub fn unordered(structure: &Structure) -> Self {
        Self { length: UNORDERED, ..Self::new(structure) }
    }

    /// Number of rows of each joint that standard deviations need: more than one segment has.
    pub(crate) fn needed(&self) -> u64 {
        self.length + 1
    }

    /// Whether this information is of rows without an order in time, such as those of a table. The standard deviations
    /// of the identified parameters are then computed as if the errors of the rows were independent of each other.
    #[must_use]
    pub fn is_unordered(&self) -> bool {
        self.length == UNORDERED
    }

    /// Number of states that were read.
    #[must_use]
    pub fn states(&self) -> u64 {
        self.states
    }

    /// Number of rows of each joint.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.segments.iter().filter_map(|segment| Some(segment.first()?.rows())).sum()
    }

    /// Duration of the motions, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Number of stored numbers, to which the memory is proportional. It does not grow with the logs.
    #[must_use]
    pub fn size(&self) -> usize {
        self.segments.iter().flatten().map(|factor| factor.columns() * factor.columns()).sum()
    }

    /// Adds the rows of a motion. `weighting` weights them by their residuals in the previous fit.
    ///
    /// # Errors
    /// When the motion is of another robot, or has numbers that are not finite; nothing has been added then.
    pub fn absorb(
        &mut self,
        structure: &Structure,
        motion: &Motion,
        weighting: Option<&Weighting>,
    ) -> Result<(), MotionError> {
        checked(structure.dof(), motion)?;
        let (Some(first), Some(last)) = (motion.time.first(), motion.time.last()) else { return Ok(()) };
        self.states += motion.len() as u64;
        self.duration += last - first;
        for (most, efforts) in self.largest.iter_mut().zip(&motion.tau) {
            *most = efforts.iter().fold(*most, |most, effort| most.max(effort.abs()));
        }
        let delay = weighting.map_or(0.0, |weighting| weighting.delay);
        self.shift = delay;
        let instants = instants(structure, &motion.time, delay);
        let mut walk = Walk::new(structure);
        for instants in instants.chunks(WINDOW) {
            let rows = rows(structure, motion, instants, weighting, delay, &mut walk)?;
            for (rows, weights) in rows.pieces(structure) {
                self.take(rows, weights);
            }
            self.reject(&rows.rejected(instants));
        }
        Ok(())
    }

    /// Adds all rows of other information with the same structure.
    pub fn merge(&mut self, other: Self) {
        self.length = self.length.max(other.length);
        self.states += other.states;
        self.shift = other.shift;
        self.duration += other.duration;
        for (most, of_other) in self.largest.iter_mut().zip(other.largest) {
            *most = most.max(of_other);
        }
        self.segments.extend(other.segments);
        self.reject(&other.rejected);
        self.compress();
    }

    /// Returns magnitudes of the unknowns for efforts as large as in the logs.
    #[must_use]
    pub fn scales(&self, structure: &Structure) -> Scales {
        let efforts: Vec<f64> = self.total(structure).iter().map(effort).collect();
        Scales::of(&structure.robot, &structure.parameters, &efforts)
    }

    /// Returns this information with the rows of each joint and segment weighted.
    pub(crate) fn weighted(&self, weights: &[Vec<f64>]) -> Self {
        let mut weighted = self.clone();
        for (at, segment) in weighted.segments.iter_mut().enumerate() {
            for (factor, weights) in segment.iter_mut().zip(weights) {
                *factor = factor.weighted(weights[at]);
            }
        }
        weighted
    }

    fn reject(&mut self, rejected: &[Option<Rejected>]) {
        for (all, more) in self.rejected.iter_mut().zip(rejected) {
            *all = match (*all, *more) {
                (Some(all), Some(more)) => Some(Rejected { rows: all.rows + more.rows, time: all.time }),
                (all, more) => all.or(more),
            };
        }
    }

    /// Returns the triangular factor of all rows of each joint.
    pub(crate) fn total(&self, structure: &Structure) -> Segment {
        let mut total: Segment = (0..structure.dof()).map(|joint| RFactor::new(structure.columns(joint))).collect();
        for segment in &self.segments {
            add(&mut total, segment);
        }
        total
    }

    fn take(&mut self, rows: Vec<DMatrix<f64>>, weights: Vec<f64>) {
        let is_full = |segment: &Segment| segment.first().is_none_or(|factor| factor.rows() >= self.length);
        if self.segments.last().is_none_or(is_full) {
            self.segments.push(rows.iter().map(|rows| RFactor::new(rows.ncols())).collect());
        }
        if let Some(segment) = self.segments.last_mut() {
            for ((factor, rows), weight) in segment.iter_mut().zip(rows).zip(weights) {
                // no error: the factor was made with this number of columns
                let _ = factor.absorb_weighted(rows, weight);
            }
        }
        self.compress();
    }

    fn compress(&mut self) {
        if self.is_unordered() {
            let rest = self.segments.drain(self.segments.len().min(1)..).collect::<Vec<_>>();
            if let Some(total) = self.segments.first_mut() {
                for segment in &rest {
                    add(total, segment);
                }
            }
        }
        while self.segments.len() > SEGMENTS {
            self.length *= 2;
            let mut merged: Vec<Segment> = Vec::with_capacity(self.segments.len().div_ceil(2));
            for segment in self.segments.drain(..) {
                match merged.last_mut().filter(|last| rows_of(last) + rows_of(&segment) <= self.length + 2) {
                    Some(last) => add(last, &segment),
                    None => merged.push(segment),
                }
            }
            self.segments = merged;
        }
    }
}

fn rows_of(segment: &Segment) -> u64 {
    segment.first().map_or(0, RFactor::rows)
}

fn add(total: &mut Segment, segment: &Segment) {
    for (total, factor) in total.iter_mut().zip(segment) {
        // no error: both have the same number of columns
        let _ = total.merge(factor);
    }
}
