//! The sine and cosine of emitted code in single precision, compiled here: every host gives the bits of the target.

/// The methods of the trait that emitted Rust code asks for.
trait Scalar {
    fn from_f64(value: f64) -> Self;
    fn sin_cos(self) -> (Self, Self)
    where
        Self: Sized;
}

include!("sin_cos_f32.rs");

/// Sine and cosine of an angle up to 1e5 rad, with the bits that emitted code computes without fused multiply-add.
///
/// ```
/// let (sine, cosine) = rne_emit::sin_cos_f32(0.5);
/// assert!((sine - 0.479_425_54).abs() < 6e-8 && (cosine - 0.877_582_56).abs() < 6e-8);
/// ```
#[must_use]
pub fn sin_cos_f32(angle: f32) -> (f32, f32) {
    // a number of `f32` has an exact value in `f64`
    Scalar::sin_cos(<f32 as Scalar>::from_f64(f64::from(angle)))
}
