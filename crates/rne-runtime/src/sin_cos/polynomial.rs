//! Sine and cosine of a reduced angle `y - e`, abs(y) ≤ π/4 and e small.
//!
//! With z = y² and the polynomials P and Q, to first order in e:
//!
//! - sin(y - e) = y - (e (1 - z/2) - y z P(z)),
//! - cos(y - e) = 1 - z/2 + (z² Q(z) + y e), where w = 1 - z/2 is rounded and (1 - w) - z/2 is what that leaves.
//!
//! The last addition alone costs half a unit in the last place; all that is added there is so small that its own errors are
//! a fraction of that.

use crate::fused::Fused;

macro_rules! sine_and_cosine {
    ($(#[$source:meta])* $type:ident, $P:expr, $Q:expr) => {
        $(#[$source])*
        #[inline(always)]
        pub(super) fn $type<const FMA: bool>(y: $type, e: $type) -> ($type, $type) {
            let horner = |coefficients: &[$type]| {
                let z = y * y;
                coefficients.iter().rev().copied().reduce(|sum, c| sum.mul_add_if::<FMA>(z, c)).unwrap_or_default()
            };
            let z = y * y;
            let half = 0.5 * z;
            let w = 1.0 - half;

            let cube = z * y;
            // In this order and with these signs a negative zero stays one.
            let sine = y - (-cube).mul_add_if::<FMA>(horner(&$P), e * w);

            let correction = (z * z).mul_add_if::<FMA>(horner(&$Q), y * e);
            let cosine = w + (((1.0 - w) - half) + correction);
            (sine, cosine)
        }
    };
}

sine_and_cosine!(
    /// P and Q are those of fdlibm (`k_sin.c`, `k_cos.c`), errors 2⁻⁵⁸: (sine, cosine).
    f64,
    [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ],
    [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ]
);

sine_and_cosine!(
    /// P and Q are those of S. L. Moshier's Cephes (`sinf.c`), errors 2⁻²⁸: (sine, cosine).
    f32,
    [-1.666_665_5e-1, 8.332_161e-3, -1.951_529_6e-4],
    [4.166_664_6e-2, -1.388_731_6e-3, 2.443_315_7e-5]
);
