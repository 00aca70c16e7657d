//! Compares the numbers of two results.

use super::state::State;

/// Tolerance relative to the largest number of the result.
const TOLERANCE: f64 = 1e-12;

/// The difference that two results may have.
#[derive(Clone, Copy)]
pub(super) enum Allowed {
    /// The bits are equal except for the sign of zero.
    Nothing,
    /// Rounding relative to the largest number of the result, or to `scale` if that is larger. `scale` is the size of
    /// the terms, for numbers that vanish up to rounding.
    Rounding { scale: f64 },
}

/// Returns the largest absolute value.
pub(super) fn largest<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> f64 {
    numbers.into_iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

/// Whether all numbers are finite. The accelerations of a singular mass matrix are not, so they are not compared.
pub(super) fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

/// Returns the product of a matrix and a vector.
pub(super) fn product(rows: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

/// Panics if `found` differs from `expected` by more than is allowed. NaN always differs.
#[track_caller]
pub(super) fn compare(what: &str, state: &State, allowed: Allowed, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (index, (found, wanted)) in found.iter().zip(expected).enumerate() {
        let is_met = match allowed {
            Allowed::Nothing => found == wanted,
            // false for NaN
            Allowed::Rounding { scale } => (found - wanted).abs() <= TOLERANCE * largest(expected).max(scale),
        };
        let limit = match allowed {
            Allowed::Nothing => "the same bits".to_owned(),
            Allowed::Rounding { .. } => format!("{TOLERANCE:e} of the largest"),
        };
        assert!(is_met, "{what}: number {index} is {found:e}, not {wanted:e} (allowed: {limit})\n{state}");
    }
}
