//! Sine and cosine of a reduced angle `y - e`, abs(y) ≤ π/4 and e small.
//!
//! With z = y² and the polynomials P and Q, to first order in e:
//!
//! - sin(y - e) = y - (e (1 - z/2) - y z P(z)),
//! - cos(y - e) = 1 - z/2 + (z² Q(z) + y e), where w = 1 - z/2 is rounded and (1 - w) - z/2 is what that leaves.
//!
//! The last addition alone costs half a unit in the last place; all that is added there is so small that its own errors are
//! a fraction of that.

use super::{Float, Lanes};

/// P and Q of fdlibm (`k_sin.c`, `k_cos.c`).
pub(super) const P_F64: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
pub(super) const Q_F64: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// P and Q of S. L. Moshier's Cephes library (`sinf.c`).
pub(super) const P_F32: [f32; 3] = [-1.666_665_5e-1, 8.332_161e-3, -1.951_529_6e-4];
pub(super) const Q_F32: [f32; 3] = [4.166_664_6e-2, -1.388_731_6e-3, 2.443_315_7e-5];

/// Sine and cosine of `y - e`.
#[inline(always)]
pub(super) fn sine_and_cosine<V: Lanes, const FMA: bool>(y: V, e: V) -> (V, V) {
    let one = V::splat(V::Element::ONE);
    let z = y * y;
    let square = z * z;
    let half = V::splat(V::Element::HALF) * z;
    let w = one - half;

    // In this order and with these signs the sine of a negative zero is one.
    let sine = y - (e * w).minus_product::<FMA>(z * y, polynomial::<V, FMA>(V::Element::P, z, square));

    let correction = (y * e).plus_product::<FMA>(square, polynomial::<V, FMA>(V::Element::Q, z, square));
    let cosine = w + (((one - w) - half) + correction);
    (sine, cosine)
}

/// c_0 + c_1 z + c_2 z² + ..., `square` being z²: two coefficients at a time for a shorter chain of operations, and c_0, by
/// far the largest term, last, for its rounding is felt.
#[inline(always)]
fn polynomial<V: Lanes, const FMA: bool>(coefficients: &'static [V::Element], z: V, square: V) -> V {
    let [first, second, others @ ..] = coefficients else { return z };
    let pair = |pair: &[V::Element]| match *pair {
        [even, odd] => V::splat(even).plus_product::<FMA>(z, V::splat(odd)),
        [even, ..] => V::splat(even),
        [] => z,
    };
    let rest = others.chunks(2).rev().map(pair).reduce(|sum, pair| pair.plus_product::<FMA>(square, sum));
    let linear = V::splat(*second) * z;
    V::splat(*first) + rest.map_or(linear, |rest| linear.plus_product::<FMA>(square, rest))
}
