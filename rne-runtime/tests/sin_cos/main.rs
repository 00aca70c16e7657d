//! The kernels of sine and cosine: special values, accuracy, and the same bits for one angle as for many.
//!
//! `cargo test -p rne-runtime --test sin_cos`, and with `--no-default-features` for the kernels as they are without
//! `std`.

mod reference;
mod turn;

use std::f64::consts::FRAC_PI_2;
use std::fmt::Debug;

use rne_runtime::{BatchScalar, Scalar, VectorUnit, batch};
use simba::simd::{AutoF64x4, SimdComplexField, SimdValue};
use turn::Turn;

/// The promises, in units in the last place.
const PROMISE_F64: f64 = 1.0;
const PROMISE_F32: f64 = 1.0;
/// Promised up to here, in rad.
const LIMIT: f64 = 1e5;

fn errors(angle: f64) -> [f64; 2] {
    let (sine, cosine) = Scalar::sin_cos(angle);
    let exact = reference::sin_cos(angle);
    [exact.0.error_in_ulp(sine), exact.1.error_in_ulp(cosine)]
}

fn errors_f32(angle: f32) -> [f64; 2] {
    let (sine, cosine) = Scalar::sin_cos(angle);
    let exact = f64::from(angle).sin_cos();
    [reference::error_in_ulp_f32(sine, exact.0), reference::error_in_ulp_f32(cosine, exact.1)]
}

/// Panics where an error is above `promise`.
fn check<T: Copy + Debug>(angles: impl IntoIterator<Item = T>, errors: impl Fn(T) -> [f64; 2], promise: f64) {
    for angle in angles {
        let found = errors(angle);
        assert!(found.iter().all(|&error| error < promise), "{angle:?}: {found:?} ulp");
    }
}

/// The next number away from zero `steps` times; towards zero if negative.
fn neighbour(x: f64, steps: i64) -> f64 {
    f64::from_bits(x.to_bits().wrapping_add_signed(steps))
}

fn neighbour_f32(x: f32, steps: i32) -> f32 {
    f32::from_bits(x.to_bits().wrapping_add_signed(steps))
}

#[test]
fn the_reference_is_right_about_known_values() {
    // The first angle after zero whose sine rounds badly in single-length reductions: the number nearest to π.
    let (sine, cosine) = reference::sin_cos(std::f64::consts::PI);
    assert!(sine.error_in_ulp(1.224_646_799_147_353_2e-16) <= 0.5);
    assert!(cosine.error_in_ulp(-1.0) <= 0.5);
    let mut numbers = fastrand::Rng::with_seed(1);
    for _ in 0..100_000 {
        let angle = (2.0 * numbers.f64() - 1.0) * LIMIT;
        let (sine, cosine) = reference::sin_cos(angle);
        // `std` is nearly correctly rounded.
        assert!(sine.error_in_ulp(angle.sin()) < 0.6, "{angle}");
        assert!(cosine.error_in_ulp(angle.cos()) < 0.6, "{angle}");
    }
}

#[test]
fn double_precision_is_as_accurate_as_promised() {
    let mut numbers = fastrand::Rng::with_seed(2);
    for range in [1e-8, 0.8, 3.2, 100.0, LIMIT] {
        let random = std::iter::repeat_with(|| (2.0 * numbers.f64() - 1.0) * range).take(100_000);
        check(random, errors, PROMISE_F64);
    }
    check([LIMIT, -LIMIT, 0.0, -0.0, 1.0], errors, PROMISE_F64);
}

#[test]
fn single_precision_is_as_accurate_as_promised() {
    let mut numbers = fastrand::Rng::with_seed(3);
    for range in [1e-4, 0.8, 3.2, 100.0, 1e5] {
        let random = std::iter::repeat_with(|| (2.0 * numbers.f32() - 1.0) * range).take(100_000);
        check(random, errors_f32, PROMISE_F32);
    }
    check([1e5, -1e5, 0.0, -0.0, 1.0], errors_f32, PROMISE_F32);
}

#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn multiples_of_a_right_angle_and_of_half_of_one() {
    // Where the reduction cancels most, and where the quadrant changes.
    for n in 0..127_323 {
        let angle = f64::from(n) * (FRAC_PI_2 / 2.0);
        check((-2..=2).map(|steps| neighbour(angle.max(1e-300), steps)), errors, PROMISE_F64);
        let angle = (angle as f32).max(1e-30);
        check((-2..=2).map(|steps| neighbour_f32(angle, steps)), errors_f32, PROMISE_F32);
    }
}

/// The same bits; any NaN is one.
fn assert_same(found: (f64, f64), expected: (f64, f64)) {
    let bits = |(sine, cosine): (f64, f64)| [sine, cosine].map(|x| if x.is_nan() { 0 } else { x.to_bits() });
    assert_eq!(bits(found), bits(expected), "{found:?} {expected:?}");
}

#[test]
fn special_values() {
    assert_same(Scalar::sin_cos(0.0), (0.0, 1.0));
    assert_same(Scalar::sin_cos(-0.0), (-0.0, 1.0));
    for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_same(Scalar::sin_cos(angle), (f64::NAN, f64::NAN));
    }
    for angle in [f64::from_bits(1), 1e-310, f64::MIN_POSITIVE, 1e-200, 1e-20] {
        assert_same(Scalar::sin_cos(angle), (angle, 1.0));
        assert_same(Scalar::sin_cos(-angle), (-angle, 1.0));
    }
    #[cfg(feature = "std")]
    for angle in [neighbour(LIMIT, 1), 1e6, 1e15, 1e300, f64::MAX] {
        assert_same(Scalar::sin_cos(angle), angle.sin_cos());
        assert_same(Scalar::sin_cos(-angle), (-angle).sin_cos());
    }
}

#[test]
fn special_values_in_single_precision() {
    let check = |angle: f32, expected: (f32, f32)| {
        let found = Scalar::sin_cos(angle);
        assert_same((found.0.into(), found.1.into()), (expected.0.into(), expected.1.into()));
    };
    check(0.0, (0.0, 1.0));
    check(-0.0, (-0.0, 1.0));
    for angle in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        check(angle, (f32::NAN, f32::NAN));
    }
    for angle in [f32::from_bits(1), 1e-40, f32::MIN_POSITIVE, 1e-20, 1e-10] {
        check(angle, (angle, 1.0));
        check(-angle, (-angle, 1.0));
    }
    #[cfg(feature = "std")]
    for angle in [neighbour_f32(1e5, 1), 1e6, 1e30, f32::MAX] {
        check(angle, angle.sin_cos());
        check(-angle, (-angle).sin_cos());
    }
}

#[test]
fn odd_and_even_to_the_last_bit() {
    let mut numbers = fastrand::Rng::with_seed(4);
    for _ in 0..100_000 {
        let angle = numbers.f64() * LIMIT;
        let (sine, cosine) = Scalar::sin_cos(angle);
        assert_same(Scalar::sin_cos(-angle), (-sine, cosine));
    }
}

/// Random angles with special ones among them.
fn angles<const N: usize>(numbers: &mut fastrand::Rng) -> [f64; N] {
    std::array::from_fn(|_| match numbers.u8(0..60) {
        0 => -0.0,
        1 => f64::NAN,
        2 => 1e300,
        3 => 2e5,
        4..20 => (2.0 * numbers.f64() - 1.0) * LIMIT,
        _ => (2.0 * numbers.f64() - 1.0) * 3.2,
    })
}

#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn array_and_single_are_equal<const N: usize>() {
    let mut numbers = fastrand::Rng::with_seed(5);
    for _ in 0..500 {
        let angles = angles::<N>(&mut numbers);
        let (sines, cosines) = Scalar::sin_cos_array(angles);
        for i in 0..N {
            assert_same((sines[i], cosines[i]), Scalar::sin_cos(angles[i]));
        }
        let angles = angles.map(|angle| angle as f32);
        let (sines, cosines) = Scalar::sin_cos_array(angles);
        for i in 0..N {
            let single = Scalar::sin_cos(angles[i]);
            assert_same((sines[i].into(), cosines[i].into()), (single.0.into(), single.1.into()));
        }
    }
}

#[test]
fn an_array_has_the_bits_of_its_angles_alone() {
    macro_rules! lengths {
        ($($n:literal)*) => { $( array_and_single_are_equal::<$n>(); )* };
    }
    lengths!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 33);
}

#[test]
fn other_scalars_keep_their_own() {
    let angle = AutoF64x4::from([0.5, -2.0, 1e5, 1e6]);
    assert_eq!(Scalar::sin_cos_array([angle; 3]).0, [angle.simd_sin(); 3]);
    let angle = num_dual::Dual64::new(0.5, 1.0);
    assert_eq!(Scalar::sin_cos(angle), num_dual::DualNum::sin_cos(&angle));
    #[cfg(feature = "std")]
    {
        let angle = simba::simd::WideF64x4::from([0.5, -2.0, 1e5, 1e6]);
        assert_eq!(Scalar::sin_cos(angle), angle.simd_sin_cos());
    }
}

#[test]
fn a_product_and_a_sum() {
    let fused = cfg!(all(feature = "std", any(target_feature = "fma", target_arch = "aarch64")));
    let tiny = 2.0_f64.powi(-30);
    let (a, b, c) = (1.0 + tiny, 1.0 - tiny, -1.0);
    assert_eq!(Scalar::mul_add(a, b, c), if fused { -tiny * tiny } else { 0.0 });
    assert_eq!(Scalar::mul_add(3.0_f32, 4.0, 5.0), 17.0);
    // Other scalars: a product and a sum.
    let [a, b, c] = [a, b, c].map(AutoF64x4::splat);
    assert_eq!(Scalar::mul_add(a, b, c), AutoF64x4::splat(0.0));
}

fn on_unit<T: BatchScalar>(unit: VectorUnit, angle: T) -> (T, T) {
    let (mut sine, mut cosine) = ([angle], [angle]);
    let angles = [angle];
    batch::run(&Turn, unit, [&angles], [&mut sine, &mut cosine]).expect("arrays of one length");
    (sine[0], cosine[0])
}

/// Theirs is another kernel.
#[test]
fn every_vector_unit_keeps_the_promise() {
    for unit in VectorUnit::all() {
        let errors = |angle: f64| {
            let (sine, cosine) = on_unit(unit, angle);
            let exact = reference::sin_cos(angle);
            [exact.0.error_in_ulp(sine), exact.1.error_in_ulp(cosine)]
        };
        let errors_f32 = |angle: f32| {
            let (sine, cosine) = on_unit(unit, angle);
            let exact = f64::from(angle).sin_cos();
            [reference::error_in_ulp_f32(sine, exact.0), reference::error_in_ulp_f32(cosine, exact.1)]
        };
        let mut numbers = fastrand::Rng::with_seed(7);
        let random: Vec<f64> = (0..20_000).map(|_| (2.0 * numbers.f64() - 1.0) * LIMIT).collect();
        let near = (1..2000).flat_map(|n| [-1, 0, 1].map(|steps| neighbour(f64::from(31 * n) * FRAC_PI_2, steps)));
        check(random.iter().copied().chain(near), errors, PROMISE_F64);
        #[allow(clippy::cast_possible_truncation)]
        check(random.iter().map(|&angle| angle as f32), errors_f32, PROMISE_F32);
        let (sine, cosine) = on_unit(unit, -0.0_f64);
        assert!(sine == 0.0 && sine.is_sign_negative() && cosine == 1.0, "{unit}");
    }
}
