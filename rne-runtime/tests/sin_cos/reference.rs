//! Sine and cosine to about 30 digits, for angles up to 10⁵ rad, and errors in units in the last place.

/// A sum of two numbers, the second below half a unit in the last place of the first: T. J. Dekker's double-length
/// numbers (1971).
#[derive(Clone, Copy)]
pub(crate) struct Double {
    high: f64,
    low: f64,
}

/// a + b exactly, for any a and b.
fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let b_part = high - a;
    Double { high, low: (a - (high - b_part)) + (b - b_part) }
}

/// a + b exactly, for b no larger than a.
fn fast_two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

/// a b exactly: by fused multiply-add where that is an instruction, else by Veltkamp's splitting.
fn two_product(a: f64, b: f64) -> Double {
    let high = a * b;
    if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
        return Double { high, low: a.mul_add(b, -high) };
    }
    let split = |x: f64| {
        let scaled = 134_217_729.0 * x; // 2²⁷ + 1
        let upper = scaled - (scaled - x);
        (upper, x - upper)
    };
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    Double { high, low: a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2) }
}

impl Double {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    fn plus(self, other: Self) -> Self {
        let sum = two_sum(self.high, other.high);
        fast_two_sum(sum.high, sum.low + (self.low + other.low))
    }

    fn times(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        fast_two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }

    fn negated_if(self, condition: bool) -> Self {
        if condition { Self { high: -self.high, low: -self.low } } else { self }
    }

    /// How far `value` is off, in units in the last place of this number's binade (of the subnormal numbers at least).
    pub(crate) fn error_in_ulp(self, value: f64) -> f64 {
        let magnitude = self.high.abs().max(f64::MIN_POSITIVE);
        // A power of two, less its rest, lies in the binade below.
        let is_power = magnitude.to_bits().trailing_zeros() >= 52;
        let below = is_power && self.low * self.high < 0.0;
        let binade = f64::from_bits(magnitude.to_bits() & !((1 << 52) - 1));
        let ulp = binade * f64::EPSILON * if below { 0.5 } else { 1.0 };
        (((value - self.high) - self.low) / ulp).abs()
    }
}

/// π/2 in parts of 33 bits, exact when multiplied with n < 2²⁰, and the rest: fdlibm, `e_rem_pio2.c`.
const HALF_PI: [f64; 4] =
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_711_166_5e-21, 8.478_427_660_368_9e-32];

/// (-1)^(k+1) / (2k + 3)! and (-1)^k / (2k + 4)! for the terms whose rounding matters.
const INVERSE_FACTORIALS: [[Double; 3]; 2] = [
    [
        Double { high: -1.666_666_666_666_666_6e-1, low: -9.251_858_538_542_97e-18 },
        Double { high: 8.333_333_333_333_333e-3, low: 1.156_482_317_317_871_4e-19 },
        Double { high: -1.984_126_984_126_984e-4, low: -1.720_955_829_342_070_5e-22 },
    ],
    [
        Double { high: 4.166_666_666_666_666_4e-2, low: 2.312_964_634_635_743e-18 },
        Double { high: -1.388_888_888_888_889e-3, low: 5.300_543_954_373_577e-20 },
        Double { high: 2.480_158_730_158_73e-5, low: 2.151_194_786_677_588e-23 },
    ],
];

/// The sum over k of c_k z^k with c_k as above, the terms beyond the third in plain numbers: for z ≤ 0.63.
fn series(first: [Double; 3], z: Double, mut factorial_of: f64) -> Double {
    let mut rest = 0.0;
    let mut coefficient = first[2].high;
    let mut power = 1.0;
    for _ in 0..9 {
        coefficient /= -(factorial_of + 1.0) * (factorial_of + 2.0);
        factorial_of += 2.0;
        power *= z.high;
        rest += coefficient * power;
    }
    let sum = fast_two_sum(first[2].high, first[2].low + rest);
    first[0].plus(z.times(first[1].plus(z.times(sum))))
}

/// Sine and cosine of `angle`, finite and at most 10⁵ or so: relative errors below 10⁻²³.
pub(crate) fn sin_cos(angle: f64) -> (Double, Double) {
    let n = (angle * std::f64::consts::FRAC_2_PI).round();
    let second = two_sum(angle - n * HALF_PI[0], -n * HALF_PI[1]);
    let third = two_sum(second.low, -n * HALF_PI[2]);
    let y = two_sum(second.high, third.high);
    let y = fast_two_sum(y.high, y.low + (third.low - n * HALF_PI[3]));

    let z = y.times(y);
    let sine = y.plus(y.times(z.times(series(INVERSE_FACTORIALS[0], z, 7.0))));
    let half = Double { high: -0.5 * z.high, low: -0.5 * z.low };
    let cosine = Double::from(1.0).plus(half.plus(z.times(z.times(series(INVERSE_FACTORIALS[1], z, 8.0)))));

    let quadrant = n.rem_euclid(4.0);
    let (sine, cosine) = if quadrant % 2.0 == 0.0 { (sine, cosine) } else { (cosine, sine) };
    (sine.negated_if(quadrant >= 2.0), cosine.negated_if(quadrant == 1.0 || quadrant == 2.0))
}

/// How far `value` is off `exact`, in units in the last place of a single-precision number.
pub(crate) fn error_in_ulp_f32(value: f32, exact: f64) -> f64 {
    let binade = f64::from_bits(exact.abs().max(f64::from(f32::MIN_POSITIVE)).to_bits() & !((1 << 52) - 1));
    ((f64::from(value) - exact) / (binade * f64::from(f32::EPSILON))).abs()
}
