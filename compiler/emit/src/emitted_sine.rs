//! The sine and cosine of emitted code in single precision, compiled into this crate: on every host they return the
//! same bits as emitted code on its target.

/// The methods of the trait `Scalar` that emitted Rust code needs.
trait Scalar {
    fn from_f64(value: f64) -> Self;
    fn sin_cos(self) -> (Self, Self)
    where
        Self: Sized;
}

include!("sin_cos_f32.rs");

/// Returns the sine and cosine of an angle up to 1e5 rad, with the bits that emitted code computes without fused
/// multiply-add.
///
/// ```
/// let (sine, cosine) = rne_emit::sin_cos_f32(0.5);
/// assert!((sine - 0.479_425_54).abs() < 6e-8 && (cosine - 0.877_582_56).abs() < 6e-8);
/// ```
#[must_use]
pub fn sin_cos_f32(angle: f32) -> (f32, f32) {
    // the conversion to `f64` and back is exact
    Scalar::sin_cos(<f32 as Scalar>::from_f64(f64::from(angle)))
}
