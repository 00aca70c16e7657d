//! The kernel for many angles at once.
//!
//! LLVM turns a loop over a fixed number of angles into SIMD instructions if that number fills its registers: six angles
//! are computed as eight (AVX-512), as 4 + 4 (AVX) or as 2 + 2 + 2 (SSE2, NEON), the surplus being sines of zero.

use super::Float;

/// Angles are computed in blocks of up to this many.
const BLOCK: usize = 8;

/// Bytes of the widest register of floating-point numbers of the compiled target.
pub(super) const REGISTER_BYTES: usize = if cfg!(target_feature = "avx512f") {
    64
} else if cfg!(target_feature = "avx") {
    32
} else if cfg!(any(target_feature = "sse2", target_feature = "neon", target_feature = "simd128")) {
    16
} else {
    1
};

/// Sines and cosines of `angles`. `FMA` asks for fused multiply-add: for callers that have enabled it.
#[inline(always)]
pub(crate) fn sin_cos_lanes<T: Float, const FMA: bool, const N: usize>(angles: &[T; N]) -> ([T; N], [T; N]) {
    #[cfg(feature = "std")]
    if !angles.iter().fold(true, |all, angle| all & angle.is_within_limit()) {
        return beyond_limit::<T, FMA, N>(angles);
    }
    let (mut sines, mut cosines) = ([T::ZERO; N], [T::ZERO; N]);
    let mut start = 0;
    while start < N {
        let count = (N - start).min(BLOCK);
        let mut padded = [T::ZERO; BLOCK];
        padded[..count].copy_from_slice(&angles[start..start + count]);
        let (block_sines, block_cosines) = block::<T, FMA>(&padded, width::<T>(count));
        sines[start..start + count].copy_from_slice(&block_sines[..count]);
        cosines[start..start + count].copy_from_slice(&block_cosines[..count]);
        start += BLOCK;
    }
    (sines, cosines)
}

/// Sines and cosines of the first `width` angles.
#[inline(always)]
fn block<T: Float, const FMA: bool>(angles: &[T; BLOCK], width: usize) -> ([T; BLOCK], [T; BLOCK]) {
    let (mut sines, mut cosines) = ([T::ZERO; BLOCK], [T::ZERO; BLOCK]);
    for lane in 0..width {
        (sines[lane], cosines[lane]) = angles[lane].reduced_sin_cos::<FMA>();
    }
    (sines, cosines)
}

/// `count`, at most a block, filled up to whole registers; one angle stays alone.
#[inline(always)]
fn width<T: Float>(count: usize) -> usize {
    if count == 1 { 1 } else { count.next_multiple_of(T::REGISTER).min(BLOCK) }
}

/// The same when some angle is beyond the limit, infinite or NaN: `std` for those, the kernel for the others.
#[cfg(feature = "std")]
#[cold]
#[inline(never)]
fn beyond_limit<T: Float, const FMA: bool, const N: usize>(angles: &[T; N]) -> ([T; N], [T; N]) {
    let (mut sines, mut cosines) = ([T::ZERO; N], [T::ZERO; N]);
    for ((angle, sine), cosine) in angles.iter().zip(&mut sines).zip(&mut cosines) {
        (*sine, *cosine) = if angle.is_within_limit() { angle.reduced_sin_cos::<FMA>() } else { angle.std_sin_cos() };
    }
    (sines, cosines)
}
