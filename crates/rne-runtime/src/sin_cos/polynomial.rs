//! Sine and cosine of a reduced angle `y - e`, abs(y) ≤ π/4 and e small.
//!
//! With z = y² - 2 y e, which is (y - e)² to first order, and the polynomials P and Q:
//!
//! - sin(y - e) = y - (e - y z P(z)), but for e z/6, a twentieth of a unit in the last place;
//! - cos(y - e) = 1 + z (z Q(z) - 1/2).
//!
//! The last addition costs half a unit in the last place; what is added there is so small that its own errors are a fraction of
//! that. Without fused multiply-add the cosine's product would be rounded too coarsely: there it is
//! w + (((1 - w) - z/2) + z² Q(z)), where w = 1 - z/2 is rounded and (1 - w) - z/2 is what that leaves.

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
    let (half, one) = (V::splat(V::Element::HALF), V::splat(V::Element::ONE));
    let z = (e * V::splat(V::Element::MINUS_TWO) * y).plus_product(y, y);
    let square = z * z;

    // In this order and with these signs the sine of a negative zero is one.
    let sine = y - e.minus_product(z * y, polynomial(V::Element::P, z, square));

    let q = polynomial(V::Element::Q, z, square);
    let cosine = if V::FUSED {
        one.plus_product(z, (-half).plus_product(z, q))
    } else {
        let half = half * z;
        let w = one - half;
        w + (((one - w) - half) + square * q)
    };
    (sine, cosine)
}

/// c_0 + c_1 z + c_2 z² + ..., `square` being z².
///
/// One coefficient at a time is the fewest operations; two at a time are a shorter chain. Without fused multiply-add c_0, by
/// far the largest term, comes last, for its rounding is felt.
#[inline(always)]
fn polynomial<V: Lanes>(coefficients: &'static [V::Element], z: V, square: V) -> V {
    let pair = |even, odd| V::splat(even).plus_product(z, V::splat(odd));
    if V::MANY {
        let mut sum = None;
        for coefficient in coefficients.iter().rev() {
            let term = V::splat(*coefficient);
            sum = Some(if let Some(sum) = sum { term.plus_product(z, sum) } else { term });
        }
        return sum.unwrap_or(z);
    }
    match *coefficients {
        [c0, c1, c2] if V::FUSED => pair(c0, c1).plus_product(square, V::splat(c2)),
        [c0, c1, c2] => V::splat(c0) + (V::splat(c1) * z + square * V::splat(c2)),
        [c0, c1, c2, c3, c4, c5] if V::FUSED => {
            pair(c0, c1).plus_product(square, pair(c2, c3).plus_product(square, pair(c4, c5)))
        }
        [c0, c1, c2, c3, c4, c5] => V::splat(c0) + (V::splat(c1) * z + square * (pair(c2, c3) + square * pair(c4, c5))),
        _ => z,
    }
}
