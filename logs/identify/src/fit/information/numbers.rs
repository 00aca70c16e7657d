//! Converts information to plain numbers and back, so that processes can exchange it.

use std::fmt;

use super::{Information, SEGMENTS, Segment};
use crate::fit::r_factor::RFactor;
use crate::fit::structure::Structure;

/// Number of head values: rows of a segment, states, duration, shift, number of segments.
const HEAD: usize = 5;

/// Counts above this number are not exact as floating-point numbers.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// The error that numbers do not fit a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongNumbers {
    /// How many numbers were given.
    pub found: usize,
}

impl fmt::Display for WrongNumbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the {} numbers do not fit the rows of this robot: they come from another robot, other options or another \
             version of rne",
            self.found
        )
    }
}

impl std::error::Error for WrongNumbers {}

impl Information {
    /// Returns all data as numbers: a head, the largest effort of each joint, then for each segment and joint the
    /// number of rows, their weight and the triangular factor.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // counts below 2^53; one that has no end is infinite
    pub fn to_numbers(&self) -> Vec<f64> {
        let length = if self.is_unordered() { f64::INFINITY } else { self.length as f64 };
        let mut numbers = vec![length, self.states as f64, self.duration, self.shift, self.segments.len() as f64];
        numbers.extend(&self.largest);
        for factor in self.segments.iter().flatten() {
            numbers.extend([factor.rows() as f64, factor.weight()]);
            numbers.extend(factor.upper());
        }
        numbers
    }

    /// Restores the information from [`to_numbers`](Self::to_numbers), bit for bit.
    ///
    /// # Errors
    /// When the numbers do not fit this structure.
    pub fn from_numbers(structure: &Structure, numbers: &[f64]) -> Result<Self, WrongNumbers> {
        Self::read(structure, numbers).ok_or(WrongNumbers { found: numbers.len() })
    }

    fn read(structure: &Structure, numbers: &[f64]) -> Option<Self> {
        let (&[length, states, duration, shift, segments], mut rest) = numbers.split_first_chunk::<HEAD>()?;
        let empty = Self::new(structure);
        let empty = if length == f64::INFINITY {
            Self::unordered(structure)
        } else {
            Self { length: count(length).filter(|length| *length >= empty.length)?, ..empty }
        };
        let (largest, after) = rest.split_at_checked(structure.dof())?;
        rest = after;
        let is_effort = |most: &f64| most.is_finite() && *most >= 0.0;
        let largest = largest.iter().all(is_effort).then(|| largest.to_vec())?;
        let segments = count(segments).filter(|segments| *segments <= SEGMENTS as u64)?;
        let mut read = Self { states: count(states)?, duration, shift, largest, ..empty };
        for _ in 0..segments {
            let mut segment: Segment = Vec::with_capacity(structure.dof());
            for joint in 0..structure.dof() {
                let columns = structure.columns(joint);
                let (&[rows, weight], after) = rest.split_first_chunk()?;
                let (upper, after) = after.split_at_checked(columns * (columns + 1) / 2)?;
                segment.push(RFactor::from_upper(columns, count(rows)?, weight, upper)?);
                rest = after;
            }
            read.segments.push(segment);
        }
        rest.is_empty().then_some(read)
    }
}

/// Converts a number to a count; `None` if it is not a whole number that is exact.
fn count(number: f64) -> Option<u64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number in that range
    (number.fract() == 0.0 && (0.0..EXACT).contains(&number)).then_some(number as u64)
}
