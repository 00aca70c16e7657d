//! Registers that are loaded from an array and stored to one.
//!
//! They are written out as registers and not left to LLVM's vectorisers, whose success depends on the code around the
//! kernel.

use super::Lanes;

/// Lanes that are loaded from an array and stored to one.
pub trait Register: Lanes {
    const LANES: usize;

    /// Loads the numbers from `start` on; lanes beyond the last number are zero.
    fn padded<const N: usize>(numbers: &[Self::Element; N], start: usize) -> Self;

    /// Stores the lanes to `numbers` from `start` on, except those beyond its end.
    fn write<const N: usize>(self, numbers: &mut [Self::Element; N], start: usize);

    /// Whether the kernel is correct for all of these angles.
    fn are_within_limit(angles: &[Self]) -> bool;
}
