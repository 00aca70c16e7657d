//! Registers that are filled from an array and written to one.
//!
//! Written out as registers rather than left to LLVM's vectorisers: those succeed or fail with the code around the
//! kernel.

use super::Lanes;

/// Lanes that are filled from an array and written to one.
pub trait Register: Lanes {
    const LANES: usize;

    /// The numbers from `start` on; zeros beyond the last.
    fn padded<const N: usize>(numbers: &[Self::Element; N], start: usize) -> Self;

    /// Writes the lanes to `numbers` from `start` on, as far as there are some.
    fn write<const N: usize>(self, numbers: &mut [Self::Element; N], start: usize);

    /// Whether the kernel is correct for all of these angles.
    fn are_within_limit(angles: &[Self]) -> bool;
}
