//! The information of logs about the unknowns: triangles of weighted rows, in memory that does not grow with the logs.

mod instants;
mod numbers;
mod weighting;

use std::fmt;

use nalgebra::{DMatrix, DVector};
use rne_logs::Motion;
use rne_machine::EvaluationError;
use rne_model::TransitionSign;

use crate::fit::least_squares::effort;
use crate::fit::prior::Scales;
use crate::fit::r_factor::RFactor;
use crate::fit::smoothing::{Kernel, Weights};
use crate::fit::structure::Structure;

pub(crate) use instants::instants;
use instants::{between, slope};

pub use numbers::WrongNumbers;
pub(crate) use weighting::CORRELATED;
pub use weighting::{Rejected, Weighting};

/// States that are computed at once.
pub(crate) const WINDOW: usize = 2048;

/// Segments of time that are kept apart, at most; beyond that neighbours merge.
const SEGMENTS: usize = 64;

/// Shortest segment, in widths of the filter; without a filter, in states.
const LENGTH: f64 = 20.0;
const STATES_UNFILTERED: u64 = 64;

/// The length of the one segment of rows that have no order.
const UNORDERED: u64 = u64::MAX;

/// The triangles of every joint's rows over a segment of time.
pub(crate) type Segment = Vec<RFactor>;

/// The information of logs about the unknowns: for each joint the triangle of its rows, in up to 64 segments of time,
/// from which deviations are computed that know of dependent errors. Parts of logs may be taken in by several of these,
/// that merge into one.
#[derive(Clone, Debug)]
pub struct Information {
    pub(crate) segments: Vec<Segment>,
    /// Rows of a joint in each.
    length: u64,
    /// States read, and those that became rows.
    pub(crate) states: u64,
    pub(crate) duration: f64,
    /// s: how much later torques were taken.
    pub(crate) shift: f64,
    /// The largest magnitude of the effort of each joint, N m or N.
    pub(crate) largest: Vec<f64>,
    /// The rows of each joint that do not count.
    pub(crate) rejected: Vec<Option<Rejected>>,
}

/// The reason why a motion gives no information on a robot.
#[derive(Debug)]
#[non_exhaustive]
pub enum MotionError {
    /// It is of another number of joints.
    Joints {
        /// Joints of the robot.
        expected: usize,
        /// Joints of the motion.
        found: usize,
    },
    /// A list has another length than the times.
    Lengths,
    /// A number is not finite: the index of the state.
    NotFinite(usize),
    /// The regressor cannot be computed.
    Evaluation(EvaluationError),
    /// All motions together make fewer rows than deviations need.
    TooFew {
        /// Rows of each joint.
        rows: u64,
        /// The number of states that are needed.
        needed: u64,
        /// s, of the motions together.
        duration: f64,
    },
    /// The efforts of all joints are zero throughout.
    NoEfforts,
    /// An identified number of a joint is not finite: the index of the joint, from 0.
    NotANumber(usize),
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joints { expected, found } => {
                write!(
                    f,
                    "the log has {found} joints, but the robot has {expected}; name the joints of the log that belong \
                     to the robot"
                )
            }
            Self::Lengths => f.write_str("there must be as many positions, rates, accelerations and torques as times"),
            Self::NotFinite(state) => write!(f, "state {state} has a number that is not finite"),
            Self::Evaluation(error) => error.fmt(f),
            Self::TooFew { rows, needed, duration } => write!(
                f,
                "{duration:.2} s of logs after the filter give {rows} rows for each joint, but {needed} are needed to \
                 estimate the deviations: use more of the log, a longer log, or a higher cut-off"
            ),
            Self::NoEfforts => f.write_str(
                "the efforts of all joints are zero throughout, or less than any sensor measures: they are not torques",
            ),
            Self::NotANumber(joint) => write!(
                f,
                "no finite values of the link, friction and rotor of joint {} explain the log: check that its efforts \
                 are torques in N m and its positions radians, and that the links of the robot file are as large as \
                 those of an arm",
                joint + 1
            ),
        }
    }
}

impl std::error::Error for MotionError {}

impl From<EvaluationError> for MotionError {
    fn from(error: EvaluationError) -> Self {
        Self::Evaluation(error)
    }
}

pub(crate) fn checked(dof: usize, motion: &Motion) -> Result<(), MotionError> {
    let lists = [&motion.q, &motion.qd, &motion.qdd, &motion.tau];
    if let Some(list) = lists.iter().find(|list| list.len() != dof) {
        return Err(MotionError::Joints { expected: dof, found: list.len() });
    }
    if !motion.recorded.is_empty() && motion.recorded.len() != dof {
        return Err(MotionError::Joints { expected: dof, found: motion.recorded.len() });
    }
    let lists = [&lists[..], &[&motion.recorded]].concat();
    let mut columns = lists.iter().flat_map(|list| list.iter());
    if columns.any(|column| column.len() != motion.len()) {
        return Err(MotionError::Lengths);
    }
    let columns = lists.iter().flat_map(|list| list.iter()).chain([&motion.time]);
    match columns.filter_map(|column| column.iter().position(|x| !x.is_finite())).min() {
        Some(state) => Err(MotionError::NotFinite(state)),
        None => Ok(()),
    }
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

    /// Empty information for rows without an order in time, such as those of a table: no segments are kept apart, so
    /// that memory is one triangle a joint, and what is found depends on the order of rows and of merging by rounding
    /// alone.
    #[must_use]
    pub fn unordered(structure: &Structure) -> Self {
        Self { length: UNORDERED, ..Self::new(structure) }
    }

    /// Rows of each joint that are needed for deviations by leaving out segments: two of these.
    pub(crate) fn needed(&self) -> u64 {
        self.length + 1
    }

    /// Whether its rows have no order: deviations suppose then that errors of rows are independent.
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

    /// Number of numbers that are kept, whatever the length of the logs: memory is proportional to it.
    #[must_use]
    pub fn size(&self) -> usize {
        self.segments.iter().flatten().map(|factor| factor.columns() * factor.columns()).sum()
    }

    /// Takes in a motion; its rows are weighted by what a fit before says of them.
    ///
    /// # Errors
    /// When the motion is of another robot, or has numbers that are not finite; nothing has been taken in then.
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

    /// Takes in everything that another has, of the same structure.
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

    /// Magnitudes of the unknowns for efforts as large as in the logs.
    #[must_use]
    pub fn scales(&self, structure: &Structure) -> Scales {
        let efforts: Vec<f64> = self.total(structure).iter().map(effort).collect();
        Scales::of(&structure.robot, &structure.parameters, &efforts)
    }

    /// This information with the rows of each joint and segment weighted.
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

    /// The triangle of all rows of each joint.
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
                // of as many columns as the factor was made with
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
        // of the same structure
        let _ = total.merge(factor);
    }
}

/// The signs of friction of every joint by every transition, on their way through a motion: some remember.
pub(crate) struct Walk {
    /// The state that comes next.
    at: usize,
    signs: Vec<Vec<TransitionSign>>,
}

impl Walk {
    pub(crate) fn new(structure: &Structure) -> Self {
        let signs: Vec<TransitionSign> =
            structure.transitions.iter().map(|transition| TransitionSign::new(*transition)).collect();
        Self { at: 0, signs: vec![signs; structure.dof()] }
    }

    /// To a state that has not been passed.
    pub(crate) fn advance(&mut self, motion: &Motion, to: usize) {
        for (signs, (q, qd)) in self.signs.iter_mut().zip(motion.q.iter().zip(&motion.qd)) {
            for sign in signs {
                for (q, qd) in q.iter().zip(qd).take(to).skip(self.at) {
                    sign.next(*q, *qd);
                }
            }
        }
        self.at = self.at.max(to);
    }
}

/// The rows of every joint at some instants, multiplied with the roots of their weights, and the weights.
pub(crate) struct Rows {
    pub(crate) of_joints: Vec<DMatrix<f64>>,
    pub(crate) weights: Vec<Vec<f64>>,
}

impl Rows {
    /// The rows in pieces of a segment's length, each with the sums of its weights.
    fn pieces(&self, structure: &Structure) -> impl Iterator<Item = (Vec<DMatrix<f64>>, Vec<f64>)> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let piece = if structure.options.cutoff.is_some() { LENGTH as usize } else { 64 };
        let instants = self.weights.first().map_or(0, Vec::len);
        (0..instants).step_by(piece).map(move |start| {
            let count = piece.min(instants - start);
            let rows = self.of_joints.iter().map(|rows| rows.rows(start, count).clone_owned()).collect();
            let weights = self.weights.iter().map(|weights| weights[start..start + count].iter().sum()).collect();
            (rows, weights)
        })
    }

    /// The rows of each joint that do not count.
    fn rejected(&self, instants: &[f64]) -> Vec<Option<Rejected>> {
        let of_joint = |weights: &Vec<f64>| {
            let mut none = weights.iter().zip(instants).filter(|(weight, _)| **weight == 0.0);
            none.next().map(|(_, time)| Rejected { rows: 1 + none.count() as u64, time: *time })
        };
        self.weights.iter().map(of_joint).collect()
    }
}

/// The rows of every joint at some instants, weighted.
pub(crate) fn rows(
    structure: &Structure,
    motion: &Motion,
    instants: &[f64],
    weighting: Option<&Weighting>,
    delay: f64,
    walk: &mut Walk,
) -> Result<Rows, MotionError> {
    let (Some(start), Some(end)) = (instants.first(), instants.last()) else {
        return Ok(Rows { of_joints: Vec::new(), weights: Vec::new() });
    };
    let kernel = structure.options.cutoff.map(Kernel::of_cutoff);
    let reach = kernel.map_or(0.0, Kernel::reach) + delay.abs();
    let from = motion.time.partition_point(|time| *time < start - reach);
    let to = motion.time.partition_point(|time| *time <= end + reach);
    let time = &motion.time[from..to];
    walk.advance(motion, from);
    let plain = plain_columns(structure, motion, from..to, walk)?;
    let of_rotors = structure.regressor.of_rotors(motion, from..to)?;
    // without filter instants are states, which follow each other
    let place = time.partition_point(|time| time < start);
    let weights: Vec<Weights> = match kernel {
        Some(kernel) => instants.iter().map(|instant| kernel.about(time, *instant)).collect(),
        None => Vec::new(),
    };
    // the torques answer later by the delay
    let late: Vec<Weights> = match kernel {
        Some(kernel) if delay != 0.0 => instants.iter().map(|at| kernel.about(time, at + delay)).collect(),
        _ => Vec::new(),
    };
    let late = if late.is_empty() { &weights } else { &late };
    let has_delay = structure.options.delay;
    let of_joint = |joint: usize| -> DMatrix<f64> {
        let columns = structure.columns(joint);
        let inner = columns - 1 - usize::from(has_delay);
        let tau = &motion.tau[joint][from..to];
        let (rotor, qdd) = (structure.known_rotor(joint), &motion.qdd[joint][from..to]);
        let at_row = |row: usize, list: &[f64]| match kernel {
            Some(_) => weights[row].of(list),
            None => list[place + row],
        };
        let known = |row: usize| {
            let own = if rotor == 0.0 { 0.0 } else { rotor * at_row(row, qdd) };
            of_rotors.as_ref().map_or(own, |of_rotors| own + at_row(row, &of_rotors[joint]))
        };
        DMatrix::from_fn(instants.len(), columns, |row, column| match (kernel.is_some(), column) {
            (true, column) if column < inner => weights[row].of(plain[joint].column(column).as_slice()),
            (true, column) if column + 1 < columns => -late[row].slope_of(tau),
            (true, _) => late[row].of(tau) - known(row),
            (false, column) if column < inner => plain[joint][(place + row, column)],
            (false, column) if column + 1 < columns => -between(time, place + row, delay, |at| slope(time, tau, at)),
            (false, _) => between(time, place + row, delay, |at| tau[at]) - known(row),
        })
    };
    let mut all: Vec<DMatrix<f64>> = (0..structure.dof()).map(of_joint).collect();
    let mut row_weights: Vec<Vec<f64>> = Vec::with_capacity(all.len());
    for (joint, rows) in all.iter_mut().enumerate() {
        let weights = weighting.map_or_else(|| vec![1.0; rows.nrows()], |weighting| weighting.of(joint, rows));
        for (mut row, weight) in rows.row_iter_mut().zip(&weights) {
            row *= weight.sqrt();
        }
        row_weights.push(weights);
    }
    Ok(Rows { of_joints: all, weights: row_weights })
}

/// The columns of every joint's rows at every state, but for those of the torque.
pub(crate) fn plain_columns(
    structure: &Structure,
    motion: &Motion,
    range: std::ops::Range<usize>,
    walk: &Walk,
) -> Result<Vec<DMatrix<f64>>, EvaluationError> {
    let dof = structure.dof();
    let states = range.len();
    let regressor = structure.regressor.columns(motion, range.clone())?;
    let friction = structure.options.friction;
    let of_joint = |joint: usize| {
        let [q, qd, qdd] = [&motion.q, &motion.qd, &motion.qdd].map(|lists| &lists[joint][range.clone()]);
        let mut columns: Vec<DVector<f64>> = Vec::with_capacity(structure.columns(joint));
        for &base in &structure.felt[joint] {
            columns.push(match structure.parameters.bases[base].kept {
                crate::Parameter::Link(link, index) => DVector::from_column_slice(regressor.of(joint, link, index)),
                crate::Parameter::Rotor(_) => DVector::from_column_slice(qdd),
            });
        }
        if friction {
            columns.push(DVector::from_column_slice(qd));
            for mut sign in walk.signs[joint].iter().copied() {
                let states_of = q.iter().zip(qd);
                let odd = DVector::from_iterator(states, states_of.map(|(q, qd)| sign.next(*q, *qd)));
                columns.extend([odd, DVector::from_element(states, 1.0)]);
            }
        }
        DMatrix::from_columns(&columns)
    };
    Ok((0..dof).map(of_joint).collect())
}
