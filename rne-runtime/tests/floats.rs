//! `f32` and `f64` are the same scalars with and without the feature `simba`: this test passes in both builds.

use rne_runtime::Scalar;

/// FNV-1a over bytes: one number for many bits.
fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3))
}

#[test]
fn sines_and_cosines_have_these_bits() {
    if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
        // fused sums have other bits
        return;
    }
    let angles = || (-20_000..=20_000).map(|k| f64::from(k) * 0.012_345);
    let double = hash(angles().flat_map(|angle| {
        let (sin, cos) = Scalar::sin_cos(angle);
        [sin.to_le_bytes(), cos.to_le_bytes()].into_iter().flatten()
    }));
    #[allow(clippy::cast_possible_truncation)]
    let single = hash(angles().flat_map(|angle| {
        let (sin, cos) = Scalar::sin_cos(angle as f32);
        [sin.to_le_bytes(), cos.to_le_bytes()].into_iter().flatten()
    }));
    assert_eq!((double, single), (5_203_891_521_474_036_532, 8_187_199_062_803_763_036));
}

#[test]
fn constants_signs_roots_and_sums() {
    let third = 1.0 / 3.0;
    #[allow(clippy::cast_possible_truncation)]
    let single = third as f32;
    assert_eq!(<f32 as Scalar>::from_f64(third), single);
    assert_eq!(<f64 as Scalar>::from_f32(single), f64::from(single));
    assert_eq!(<f32 as Scalar>::from_f32(single), single);
    for (x, chosen) in [(2.0, 5.0), (-1e-300, -7.0), (0.0, 0.0), (-0.0, 0.0), (f64::NAN, 0.0)] {
        assert_eq!(x.by_sign(5.0, -7.0), chosen, "{x}");
    }
    for x in [0.0, 2.0, 1e-310, 1e300, f64::INFINITY] {
        assert_eq!(Scalar::sqrt(x), x.sqrt(), "{x}");
    }
    assert!(Scalar::sqrt(-1.0_f64).is_nan() && Scalar::sqrt(-1.0_f32).is_nan());
    assert_eq!(Scalar::mul_add(3.0_f32, 4.0, 5.0), 17.0);
    assert_eq!(Scalar::mul_add(3.0_f64, 4.0, 5.0), 17.0);
}
