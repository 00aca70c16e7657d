//! Sine and cosine of x from those of the reduced angle x - n π/2.
//!
//! | n mod 4 | sine of x | cosine of x |
//! |---|---|---|
//! | 0 | sine | cosine |
//! | 1 | cosine | -sine |
//! | 2 | -sine | -cosine |
//! | 3 | -cosine | sine |
//!
//! The lowest bit of n exchanges the two, the second one negates the sine of x, their exclusive or its cosine. Bit
//! operations, not branches, so that neighbouring angles may lie in different quadrants.

macro_rules! quadrant {
    ($type:ident, $bits:ident) => {
        /// `n` modulo 4 stands in the two lowest bits of `n`.
        #[inline(always)]
        pub(super) fn $type(n: $bits, sine: $type, cosine: $type) -> ($type, $type) {
            const TO_SIGN: u32 = $bits::BITS - 2;
            let all_ones_if_odd = (n & 1).wrapping_neg();
            let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
            let exchange = (sine ^ cosine) & all_ones_if_odd;
            let negate_sine = (n & 2) << TO_SIGN;
            let negate_cosine = (n.wrapping_add(1) & 2) << TO_SIGN;
            ($type::from_bits(sine ^ exchange ^ negate_sine), $type::from_bits(cosine ^ exchange ^ negate_cosine))
        }
    };
}

quadrant!(f64, u64);
quadrant!(f32, u32);
