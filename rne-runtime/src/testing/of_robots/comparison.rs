//! How numbers are compared.

use super::state::State;

/// Tolerance relative to the largest number of the result.
const TOLERANCE: f64 = 1e-12;

/// How far two results may be from each other.
#[derive(Clone, Copy)]
pub(super) enum Allowed {
    /// The bits are equal except for the sign of zero.
    Nothing,
    /// Rounding, relative to the largest number of the result or, if that is smaller, to `scale`: numbers that vanish
    /// but for rounding are measured by those that they are parts of.
    Rounding { scale: f64 },
}

/// The largest number, without its sign.
pub(super) fn largest<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> f64 {
    numbers.into_iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

/// Whether numbers can be compared: the accelerations of a singular mass matrix are not finite, and nothing is required
/// of them.
pub(super) fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

/// The rows of a matrix times a vector.
pub(super) fn product(rows: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

/// Panics where `found` is not `expected`. What is not a number is never expected.
#[track_caller]
pub(super) fn compare(what: &str, state: &State, allowed: Allowed, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (index, (found, wanted)) in found.iter().zip(expected).enumerate() {
        let is_met = match allowed {
            Allowed::Nothing => found == wanted,
            // false for what is not a number
            Allowed::Rounding { scale } => (found - wanted).abs() <= TOLERANCE * largest(expected).max(scale),
        };
        let limit = match allowed {
            Allowed::Nothing => "the same bits".to_owned(),
            Allowed::Rounding { .. } => format!("{TOLERANCE:e} of the largest"),
        };
        assert!(is_met, "{what}: number {index} is {found:e}, not {wanted:e} (allowed: {limit})\n{state}");
    }
}
