//! The parameters of an arm, with their uncertainty, from logs in which nothing happened.

use nalgebra::{DMatrix, DVector};
use rne_identify::{FittedModel, FrictionParameter, MotionError, Options, Stretch, Stretches, Structure};
use rne_logs::{Motion, UtcTime};
use rne_model::Robot;

use crate::WatchError;
use crate::candidate::{Candidate, Scale};
use crate::contact::ContactNoise;
use crate::score::{Estimate, Score};

/// Number of rows of a part of the logs that is left out at a time.
const ROWS: u64 = 20;

/// Smallest and largest number of parts that are left out one after the other.
const PARTS: [usize; 2] = [4, 64];

/// The weight of the mean over all joints when the inflation of one candidate is estimated, in parts.
const SHARED: f64 = 4.0;

/// The error of a robot file on another motion than that of its identification, in multiples of the error between two
/// logs. With a value of 1, files from the first half of a public log, compared with the second half, show changes of
/// up to 0.8 thresholds.
const DOUBT_OF_FILE: f64 = 2.5;

/// Smallest number of rows of a joint for each unknown that they may depend on.
const ENOUGH: f64 = 2.75;

/// Upper limit of a squared statistic in the mean.
const LARGEST_SQUARE: f64 = 36.0;

/// The parameters of an arm from quiet logs, and the errors of its model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Baseline {
    /// Cut-off of the low-pass filter of both sides of the equations of motion, Hz.
    pub cutoff: f64,
    /// The parameters with the information of the quiet logs.
    pub model: FittedModel,
    /// Magnitudes of the arm's friction, speeds and efforts.
    pub scale: Scale,
    /// For each candidate, in the order of [`Candidate::all`](crate::Candidate::all), the factor, at least 1, by which
    /// its standard deviation is larger than with white errors.
    pub inflation: Vec<f64>,
    /// Degrees of freedom of the standard deviations, for Student's t.
    pub freedom: f64,
    /// Root mean square of the model's residual torque of each joint, N m or N.
    pub residual: Vec<f64>,
    /// Number of rows of each joint.
    pub rows: u64,
    /// Duration of the motions, s.
    pub duration: f64,
    /// The beginning and the end of the quiet logs. `None` if their times do not count from 1970.
    pub span: Option<[UtcTime; 2]>,
    /// The factor by which the error of the model is larger than between two logs of one arm: 1 for quiet logs, more
    /// for the parameters of a robot file, which come from another motion.
    pub doubt: f64,
    /// The noise of the momentum observer, if it was measured.
    pub contact: Option<ContactNoise>,
}

impl Baseline {
    /// Returns the equations of a robot for a low-pass filter with this cut-off, Hz.
    #[must_use]
    pub fn structure(robot: &Robot, cutoff: f64) -> Structure {
        let mut options = Options::default();
        options.cutoff = Some(cutoff);
        Structure::new(robot, options)
    }

    /// Makes the baseline from quiet logs. `pass` is called several times and passes every motion with the number of
    /// its run to its argument each time.
    ///
    /// # Errors
    /// When a motion is of another robot; when the motions give too few rows, or have no efforts; or when `pass` fails.
    pub fn of<E: From<MotionError>>(
        structure: &Structure,
        pass: impl FnMut(&mut dyn FnMut(u64, &Motion) -> Result<(), MotionError>) -> Result<(), E>,
    ) -> Result<Self, E> {
        let (model, stretches) = FittedModel::of(structure, pass)?;
        let totals = products_of_joints(structure, stretches.list());
        let scale = Scale::of(structure, &model, &totals);
        let parts = (usize::try_from(stretches.rows() / ROWS).unwrap_or(usize::MAX)).clamp(PARTS[0], PARTS[1]);
        let short = inflation(structure, &model, &stretches, parts);
        let long = inflation(structure, &model, &stretches, PARTS[0]);
        let inflation = short.iter().zip(&long).map(|(short, long)| short.max(*long).max(1.0).sqrt()).collect();
        let residual = residual(structure, &model, &stretches);
        #[allow(clippy::cast_precision_loss)] // at most 64
        let freedom = SHARED + parts as f64;
        Ok(Self {
            cutoff: structure.options().cutoff.unwrap_or_default(),
            scale,
            inflation,
            freedom,
            residual,
            rows: stretches.rows(),
            duration: stretches.duration(),
            span: None,
            model,
            doubt: 1.0,
            contact: None,
        })
    }

    /// Refuses a baseline with too few rows for its unknowns.
    pub(crate) fn check(&self, structure: &Structure) -> Result<(), WatchError> {
        #[allow(clippy::cast_precision_loss)] // some hundred
        let [rows, unknowns, others] = [self.rows as f64, structure.count() as f64, (structure.dof() - 1) as f64];
        // a joint's torque depends on its own friction only, not on that of the other joints
        let needed = ENOUGH * (unknowns - 3.0 * others);
        if rows >= needed {
            return Ok(());
        }
        let more = (needed - rows) * self.row();
        Err(WatchError::ShortBaseline { duration: self.duration, needed: self.duration + more, cutoff: self.cutoff })
    }

    /// Returns the time between two rows, s.
    pub(crate) fn row(&self) -> f64 {
        Options::row(self.cutoff)
    }

    /// Returns this baseline with the parameters of the robot file instead of those of the quiet logs, for a log that
    /// is its own baseline.
    #[must_use]
    pub fn against_file(mut self, structure: &Structure) -> Self {
        self.doubt = DOUBT_OF_FILE;
        self.span = None;
        self.model.solution = FittedModel::of_file(structure, &self.model.transitions).solution;
        self
    }
}

/// Compares each of `parts` parts of the quiet logs with all others. Returns for each candidate the mean square of its
/// statistic, which is 1 if errors are white, shrunk towards the mean of all joints.
fn inflation(structure: &Structure, model: &FittedModel, stretches: &Stretches, parts: usize) -> Vec<f64> {
    let dof = structure.dof();
    let list = stretches.list();
    let mut sums = vec![0.0; Candidate::all(dof).len()];
    let mut tried = 0.0;
    for part in 0..parts {
        let range = part * list.len() / parts..(part + 1) * list.len() / parts;
        if range.is_empty() {
            continue;
        }
        let Some(squares) = left_out(structure, model, &list[range]) else { continue };
        tried += 1.0;
        sums.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square.min(LARGEST_SQUARE));
    }
    #[allow(clippy::cast_precision_loss)] // joints
    let joints = dof as f64;
    let shared = |kind: usize| sums[kind * dof..(kind + 1) * dof].iter().sum::<f64>() / joints / f64::max(tried, 1.0);
    let all = sums[..3 * dof].iter().sum::<f64>() / (3.0 * joints) / f64::max(tried, 1.0);
    let root_mean_square = |(at, sum): (usize, &f64)| {
        let mean = if at < 3 * dof { shared(at / dof) } else { all };
        (SHARED * mean + sum) / (SHARED + tried)
    };
    sums.iter().enumerate().map(root_mean_square).collect()
}

/// Returns the root mean square of each joint's residual torque, N m or N, where each quarter of the quiet logs is
/// compared with the model of the other quarters.
fn residual(structure: &Structure, model: &FittedModel, stretches: &Stretches) -> Vec<f64> {
    let list = stretches.list();
    let quarters = (0..PARTS[0]).map(|part| part * list.len() / PARTS[0]..(part + 1) * list.len() / PARTS[0]);
    let mut sums = vec![Residual::default(); structure.dof()];
    for quarter in quarters.map(|range| &list[range]) {
        let Some(others) = model.without(structure, quarter) else { continue };
        for (joint, sum) in sums.iter_mut().enumerate() {
            let residuals = quarter.iter().map(|stretch| Residual::of(structure, joint, stretch, &others.solution));
            *sum = residuals.fold(*sum, Residual::plus);
        }
    }
    sums.iter().zip(&model.noise).map(|(sum, noise)| sum.root_mean_square().unwrap_or(*noise).max(*noise)).collect()
}

/// Returns the normal equations of a joint over some stretches: the products of all unknowns, then of its torque.
pub(crate) fn products<'a>(
    structure: &Structure,
    joint: usize,
    stretches: impl IntoIterator<Item = &'a Stretch>,
) -> DMatrix<f64> {
    let size = structure.count() + 1;
    let mut sum = DMatrix::zeros(size, size);
    stretches.into_iter().for_each(|stretch| stretch.add_joint(structure, joint, &mut sum));
    sum
}

/// Returns the normal equations of each joint over some stretches.
pub(crate) fn products_of_joints<'a>(
    structure: &Structure,
    stretches: impl IntoIterator<Item = &'a Stretch>,
) -> Vec<DMatrix<f64>> {
    let stretches: Vec<_> = stretches.into_iter().collect();
    (0..structure.dof()).map(|joint| products(structure, joint, stretches.iter().copied())).collect()
}

/// The weighted sum of squared residuals of a joint's torques, and the sum of the weights.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Residual {
    squares: f64,
    weight: f64,
}

impl Residual {
    pub(crate) fn of(structure: &Structure, joint: usize, stretch: &Stretch, unknowns: &DVector<f64>) -> Self {
        let count = structure.count();
        let products = products(structure, joint, [stretch]);
        let mut row = DVector::from_element(count + 1, 1.0);
        row.rows_mut(0, count).copy_from(&-unknowns);
        let ones = FittedModel::place(structure, joint, FrictionParameter::Offset);
        let weight = ones.map_or(0.0, |one| products[(one, one)]);
        Self { squares: row.dot(&(&products * &row)), weight }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { squares: self.squares + other.squares, weight: self.weight + other.weight }
    }

    pub(crate) fn mean_square(self) -> f64 {
        // a weight is the reciprocal of the variance
        if self.weight > 0.0 { (self.squares / self.weight).max(0.0) } else { 0.0 }
    }

    /// Returns the root mean square of the residual, N m or N; `None` without rows.
    pub(crate) fn root_mean_square(self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.mean_square().sqrt())
    }
}

/// Returns the squared statistic of each candidate for some stretches, compared with the model of all other stretches.
fn left_out(structure: &Structure, model: &FittedModel, stretches: &[Stretch]) -> Option<Vec<f64>> {
    let others = model.without(structure, stretches)?;
    let stretches: Vec<&Stretch> = stretches.iter().collect();
    let score = Score::new(structure, &others, &stretches, &vec![false; structure.dof()])?;
    let estimates = score.estimates(&(0..score.len()), &[]);
    let square =
        |estimate: Option<Estimate>| estimate.map_or(0.0, |estimate| (estimate.value() / estimate.deviation).powi(2));
    Some(estimates.into_iter().map(square).collect())
}
