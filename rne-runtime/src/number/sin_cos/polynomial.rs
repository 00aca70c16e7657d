//! Sine and cosine of a reduced angle `y - e`, abs(y) ≤ π/4 and e small.
//!
//! With the polynomials P and Q, to first order in e, there are two ways:
//!
//! | | z | sin(y - e) | cos(y - e) |
//! |---|---|---|---|
//! | [`soon`], for a shorter chain of operations | y² | y - (e (1 - z/2) - y z P(z)) | 1 - z/2 + (z² Q(z) + y e) |
//! | [`short`], for fewer operations | y² - 2 y e | y - (e - y z P(z)) | 1 + z (z Q(z) - 1/2) |
//!
//! The first does not wait for e, which comes late. The second needs fused multiply-add, or the cosine's product is
//! rounded too coarsely; it leaves out e z/6, for `f64` a twentieth of a unit in the last place of the sine.
//!
//! The last addition costs half a unit in the last place; what is added there is so small that its own errors are a
//! fraction of that.

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
pub(super) fn sine_and_cosine<V: Lanes>(y: V, e: V) -> (V, V) {
    if V::MANY { short(y, e) } else { soon(y, e) }
}

// With this order and these signs, both ways give -0 as the sine of -0.

#[inline(always)]
pub(super) fn soon<V: Lanes>(y: V, e: V) -> (V, V) {
    let one = V::splat(V::Element::ONE);
    let z = y * y;
    let square = z * z;
    let half = V::splat(V::Element::HALF) * z;
    // the rounded sum; (1 - w) - z/2 is its rounding error
    let w = one - half;
    let sine = y - (e * w).minus_product(z * y, two_by_two(V::Element::P, z, square));
    let correction = (y * e).plus_product(square, two_by_two(V::Element::Q, z, square));
    let cosine = w + (((one - w) - half) + correction);
    (sine, cosine)
}

#[inline(always)]
fn short<V: Lanes>(y: V, e: V) -> (V, V) {
    let z = (e * V::splat(V::Element::MINUS_TWO) * y).plus_product(y, y);
    let sine = y - e.minus_product(z * y, one_by_one(V::Element::P, z));
    let less = V::splat(-V::Element::HALF).plus_product(z, one_by_one(V::Element::Q, z));
    let cosine = V::splat(V::Element::ONE).plus_product(z, less);
    (sine, cosine)
}

/// Returns c_0 + c_1 z + c_2 z² + ..., where `square` is z². It takes two coefficients at a time, for a shorter chain
/// of operations. c_0, by far the largest term, is added last, because its rounding error matters most.
#[inline(always)]
fn two_by_two<V: Lanes>(coefficients: &'static [V::Element], z: V, square: V) -> V {
    let pair = |even, odd| V::splat(even).plus_product(z, V::splat(odd));
    let first = |first, second, others: V| V::splat(first) + (V::splat(second) * z).plus_product(square, others);
    match *coefficients {
        [c0, c1, c2, c3, c4, c5] if V::FUSED => {
            pair(c0, c1).plus_product(square, pair(c2, c3).plus_product(square, pair(c4, c5)))
        }
        [c0, c1, c2] => first(c0, c1, V::splat(c2)),
        [c0, c1, c2, c3, c4, c5] => first(c0, c1, pair(c2, c3).plus_product(square, pair(c4, c5))),
        _ => z,
    }
}

/// Evaluates the polynomial one coefficient at a time, with fewer operations.
#[inline(always)]
fn one_by_one<V: Lanes>(coefficients: &'static [V::Element], z: V) -> V {
    let mut sum = None;
    // No closure: it would be compiled without the vector unit of its caller.
    for coefficient in coefficients.iter().rev() {
        let term = V::splat(*coefficient);
        sum = Some(if let Some(sum) = sum { term.plus_product(z, sum) } else { term });
    }
    sum.unwrap_or(z)
}
