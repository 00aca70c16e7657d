//! Computes the rows of a motion: the linear equations for the unknowns that the torque of each joint gives at some
//! instants.

use nalgebra::{DMatrix, DVector};
use rne_logs::Motion;
use rne_machine::EvaluationError;
use rne_model::TransitionSign;

use super::instants::{between, slope};
use super::{LENGTH, MotionError, Rejected, Weighting};
use crate::fit::smoothing::{Kernel, Weights};
use crate::fit::structure::Structure;

/// The sign of friction of every joint for every transition, updated state by state, because some transitions depend on
/// earlier states.
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

    /// Updates the signs up to state `to`.
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

/// The rows of every joint at some instants, multiplied by the square roots of their weights, and the weights.
pub(crate) struct Rows {
    pub(crate) of_joints: Vec<DMatrix<f64>>,
    pub(crate) weights: Vec<Vec<f64>>,
}

impl Rows {
    /// Multiplies rows by the square roots of their weights.
    fn weighted(mut of_joints: Vec<DMatrix<f64>>, weighting: Option<&Weighting>) -> Self {
        let mut row_weights: Vec<Vec<f64>> = Vec::with_capacity(of_joints.len());
        for (joint, rows) in of_joints.iter_mut().enumerate() {
            let weights = weighting.map_or_else(|| vec![1.0; rows.nrows()], |weighting| weighting.of(joint, rows));
            for (mut row, weight) in rows.row_iter_mut().zip(&weights) {
                row *= weight.sqrt();
            }
            row_weights.push(weights);
        }
        Self { of_joints, weights: row_weights }
    }

    /// Splits the rows into pieces as long as a segment, each with the sum of its weights for each joint.
    pub(super) fn pieces(&self, structure: &Structure) -> impl Iterator<Item = (Vec<DMatrix<f64>>, Vec<f64>)> {
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

    /// Returns, for each joint, the rows that do not count because their weight is 0.
    pub(super) fn rejected(&self, instants: &[f64]) -> Vec<Option<Rejected>> {
        let of_joint = |weights: &Vec<f64>| {
            let mut none = weights.iter().zip(instants).filter(|(weight, _)| **weight == 0.0);
            none.next().map(|(_, time)| Rejected { rows: 1 + none.count() as u64, time: *time })
        };
        self.weights.iter().map(of_joint).collect()
    }
}

/// Returns the weighted rows of every joint at some instants.
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
    // without a filter, the instants are consecutive states
    let place = time.partition_point(|time| time < start);
    let weights: Vec<Weights> = match kernel {
        Some(kernel) => instants.iter().map(|instant| kernel.about(time, *instant)).collect(),
        None => Vec::new(),
    };
    // the torques lag by the delay, so they are taken later
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
    Ok(Rows::weighted((0..structure.dof()).map(of_joint).collect(), weighting))
}

/// Returns the columns of every joint's rows at every state, without those of the torque and its slope.
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
