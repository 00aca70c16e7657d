//! Normal equations of a log for each short stretch of time.
//!
//! Sums over stretches answer every question of the kind "what if a parameter had changed from here to there" without
//! another pass over the log. The memory does not grow with the log: neighbours merge.

use nalgebra::DMatrix;
use rne_logs::Motion;

use crate::fit::fitted_model::FittedModel;
use crate::fit::information::{CORRELATED, MotionError, WINDOW, Walk, Weighting, checked, instants, rows};
use crate::fit::structure::Structure;

/// Largest number of stretches; beyond it, neighbours are merged.
const MOST: usize = 256;

/// Largest sum of squared efforts, over the variance of the noise, that counts as a channel that measures nothing.
const SILENT: f64 = 1e-12;

/// The normal equations of a stretch of time.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// The number of the run in which it begins, from 0.
    pub run: u64,
    /// The number of the run in which it ends: stretches of several runs are joined where a log has many runs.
    pub last_run: u64,
    /// The first instant, s.
    pub start: f64,
    /// The last instant, s.
    pub end: f64,
    /// Number of rows of each joint.
    pub rows: u64,
    /// For each joint the products of its used columns and of its torque, over the variance of its noise.
    products: Vec<DMatrix<f64>>,
}

/// The normal equations of logs by stretches of time.
#[derive(Clone, Debug)]
pub struct Stretches {
    list: Vec<Stretch>,
    weighting: Weighting,
    used: Vec<Vec<usize>>,
    /// Number of rows of each joint in a stretch.
    length: u64,
    /// Sum of the times from the first to the last instant of each motion, s.
    duration: f64,
}

impl Stretches {
    /// Makes empty stretches for logs that are compared with a model: large residuals do not reduce the weight of a
    /// row, but rows near rest have less weight.
    #[must_use]
    pub fn new(structure: &Structure, model: &FittedModel) -> Self {
        Self::with_weighting(structure, model, model.weighting(structure))
    }

    pub(crate) fn with_weighting(structure: &Structure, model: &FittedModel, weighting: Weighting) -> Self {
        let transitions = model.transitions.iter().enumerate();
        let used = transitions.map(|(joint, transition)| structure.used(joint, *transition)).collect();
        Self { list: Vec::new(), weighting, used, length: 1, duration: 0.0 }
    }

    /// The stretches in the order of time.
    #[must_use]
    pub fn list(&self) -> &[Stretch] {
        &self.list
    }

    /// Duration of the motions, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the number of rows of each joint.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.list.iter().map(|stretch| stretch.rows).sum()
    }

    /// Adds a motion of a run.
    ///
    /// # Errors
    /// When the motion is of another robot, or has numbers that are not finite.
    pub fn absorb(&mut self, structure: &Structure, run: u64, motion: &Motion) -> Result<(), MotionError> {
        checked(structure.dof(), motion)?;
        if let (Some(first), Some(last)) = (motion.time.first(), motion.time.last()) {
            self.duration += last - first;
        }
        let delay = self.weighting.delay;
        let instants = instants(structure, &motion.time, delay);
        let mut walk = Walk::new(structure);
        for instants in instants.chunks(WINDOW) {
            let rows = rows(structure, motion, instants, Some(&self.weighting), delay, &mut walk)?;
            let selected: Vec<DMatrix<f64>> =
                rows.of_joints.iter().zip(&self.used).map(|(rows, used)| rows.select_columns(used)).collect();
            for (at, instant) in instants.iter().enumerate() {
                let products = selected.iter().zip(&self.weighting.noise).map(|(rows, noise)| {
                    let row = rows.row(at) / (noise * CORRELATED.sqrt());
                    row.tr_mul(&row)
                });
                let products = products.collect();
                self.take(Stretch { run, last_run: run, start: *instant, end: *instant, rows: 1, products });
            }
        }
        Ok(())
    }

    fn take(&mut self, stretch: Stretch) {
        let length = self.length;
        match self.list.last_mut() {
            Some(last) if last.last_run == stretch.run && last.rows < length => last.join(stretch),
            _ => self.list.push(stretch),
        }
        while self.list.len() > MOST {
            self.length *= 2;
            let length = self.length;
            let mut joined: Vec<Stretch> = Vec::with_capacity(self.list.len().div_ceil(2));
            for stretch in self.list.drain(..) {
                match joined.last_mut() {
                    Some(last) if last.rows + stretch.rows <= length => last.join(stretch),
                    _ => joined.push(stretch),
                }
            }
            self.list = joined;
        }
    }

    /// Returns the sum of the normal equations of all stretches; [`Stretch::add_to`] describes them.
    #[must_use]
    pub fn total(&self, structure: &Structure) -> DMatrix<f64> {
        let mut total = DMatrix::zeros(structure.count() + 1, structure.count() + 1);
        self.list.iter().for_each(|stretch| stretch.add_to(structure, &mut total));
        total
    }
}

impl Stretch {
    fn join(&mut self, other: Self) {
        (self.last_run, self.end) = (other.last_run, other.end);
        self.rows += other.rows;
        for (sum, products) in self.products.iter_mut().zip(other.products) {
            *sum += products;
        }
    }

    /// Whether the effort of a joint is always zero, as from a channel that measures nothing.
    #[must_use]
    pub fn is_silent(&self, joint: usize) -> bool {
        let products = &self.products[joint];
        // the products are over the variance of the noise, so those of a real sensor are far larger
        products[(products.nrows() - 1, products.ncols() - 1)] <= SILENT
    }

    /// Leaves out the rows of a joint.
    pub fn leave_out(&mut self, joint: usize) {
        self.products[joint].fill(0.0);
    }

    /// Adds the normal equations of this stretch to `total`: the products of all unknowns and of the torque, which is
    /// last.
    pub fn add_to(&self, structure: &Structure, total: &mut DMatrix<f64>) {
        (0..self.products.len()).for_each(|joint| self.add_joint(structure, joint, total));
    }

    /// Adds the normal equations of the rows of one joint to `total`.
    pub fn add_joint(&self, structure: &Structure, joint: usize, total: &mut DMatrix<f64>) {
        let mut places = structure.unknowns(joint);
        places.push(structure.count());
        let products = &self.products[joint];
        for (column, &to) in places.iter().enumerate() {
            for (row, &from) in places.iter().enumerate() {
                total[(from, to)] += products[(row, column)];
            }
        }
    }
}
