//! The kernel of sine and cosine for an array of angles, with one test of the range for eight angles at a time.

#[cfg(feature = "std")]
use super::kernel_of_one_call;
#[cfg(feature = "std")]
use super::registers::Register;
use super::{Float, kernel};

/// Writes the sines and cosines of `angles`.
#[inline(always)]
pub(crate) fn sin_cos<T: Float, const N: usize>(angles: &[T; N], sines: &mut [T; N], cosines: &mut [T; N]) {
    #[cfg(feature = "std")]
    if N > 1 {
        return in_registers::<T::Register, N>(angles, sines, cosines);
    }
    sin_cos_lanes(angles, sines, cosines);
}

/// Evaluates up to sixteen angles, written out one by one: compilers for small processors would turn a loop into a
/// branch.
macro_rules! one_by_one {
    ($angles:ident, $sines:ident, $cosines:ident, $start:ident: $($index:literal)*) => {$(
        if $start + $index < N {
            ($sines[$start + $index], $cosines[$start + $index]) = kernel($angles[$start + $index]);
        }
    )*};
}

/// Evaluates angles one by one, for a single angle and for targets without registers.
#[inline(always)]
pub(crate) fn sin_cos_lanes<T: Float, const N: usize>(angles: &[T; N], sines: &mut [T; N], cosines: &mut [T; N]) {
    let mut start = 0;
    while start < N {
        one_by_one!(angles, sines, cosines, start: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
        start += 16;
    }
    #[cfg(feature = "std")]
    if !angles.iter().fold(true, |all, angle| all & angle.is_within_limit()) {
        (*sines, *cosines) = beyond_limit(*angles, *sines, *cosines);
    }
}

/// Evaluates angles in registers `V`. If the last register is not full, zeros are added.
#[cfg(feature = "std")]
#[inline(always)]
pub(crate) fn in_registers<V: Register, const N: usize>(
    angles: &[V::Element; N],
    sines: &mut [V::Element; N],
    cosines: &mut [V::Element; N],
) {
    /// Largest number of angles in a block, and of registers in a block: small enough to be unrolled and to stay in
    /// registers.
    const BLOCK: usize = 8;
    const REGISTERS: usize = 4;

    let block_length = const { if REGISTERS * V::LANES < BLOCK { REGISTERS * V::LANES } else { BLOCK } };

    let mut start = 0;
    while start < N {
        let count = (N - start).min(block_length).div_ceil(V::LANES);
        let mut block = [V::splat(V::Element::ZERO); REGISTERS];
        for (index, register) in block[..count].iter_mut().enumerate() {
            *register = V::padded(angles, start + index * V::LANES);
        }
        let are_within_limit = V::are_within_limit(&block[..count]);
        for (index, register) in block[..count].iter().enumerate() {
            let (sine, cosine) = kernel_of_one_call(*register);
            sine.write(sines, start + index * V::LANES);
            cosine.write(cosines, start + index * V::LANES);
        }
        if !are_within_limit {
            // Copied from the registers and not from `angles`: an array whose address is passed to a call would have to
            // be in memory, in the branch-free code too, and loading a register from numbers that were just written one
            // by one stalls the processor.
            let mut copies = [[V::Element::ZERO; BLOCK]; 3];
            for (index, register) in block[..count].iter().enumerate() {
                register.write(&mut copies[0], index * V::LANES);
            }
            for (index, at) in (start..N.min(start + block_length)).enumerate() {
                (copies[1][index], copies[2][index]) = (sines[at], cosines[at]);
            }
            let (exact_sines, exact_cosines) = beyond_limit(copies[0], copies[1], copies[2]);
            for (index, at) in (start..N.min(start + block_length)).enumerate() {
                (sines[at], cosines[at]) = (exact_sines[index], exact_cosines[index]);
            }
        }
        start += block_length;
    }
}

/// Evaluates with `std` the angles that are beyond the limit, infinite or NaN. The other angles keep the results of the
/// kernel, which may have been compiled with more instructions than this function.
#[cfg(feature = "std")]
#[cold]
#[inline(never)]
fn beyond_limit<T: Float, const N: usize>(angles: [T; N], mut sines: [T; N], mut cosines: [T; N]) -> ([T; N], [T; N]) {
    for (angle, (sine, cosine)) in angles.iter().zip(sines.iter_mut().zip(&mut cosines)) {
        if !angle.is_within_limit() {
            (*sine, *cosine) = angle.std_sin_cos();
        }
    }
    (sines, cosines)
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::sin_cos_lanes;

    #[test]
    fn an_angle_has_the_same_bits_in_an_array_and_in_registers() {
        for start in (-100..100).map(f64::from) {
            // more angles than the code evaluates in one unrolled part
            let angles: [f64; 20] =
                core::array::from_fn(|lane| start * 0.37 + start * start * f64::from(u8::try_from(lane).expect("few")));
            let (mut sines, mut cosines) = ([0.0; 20], [0.0; 20]);
            sin_cos_lanes(&angles, &mut sines, &mut cosines);
            let (mut in_registers, mut cosines_in_registers) = ([0.0; 20], [0.0; 20]);
            super::sin_cos(&angles, &mut in_registers, &mut cosines_in_registers);
            assert_eq!((sines, cosines), (in_registers, cosines_in_registers));
            super::in_registers::<f64, 20>(&angles, &mut in_registers, &mut cosines_in_registers);
            assert_eq!((sines, cosines), (in_registers, cosines_in_registers), "registers of one number");
        }
    }
}
