//! Vectors, rotations and poses of twice the precision.
//!
//! A conversion rotates numbers many times and rounds once, at the end. Numbers that are equal on paper, such as a sum
//! of decimals or a product of rotations that is the identity, then agree to 1e-30, and rounding gives the number that
//! a person would write.

use std::ops::{Add, Mul, Neg, Sub};

use rne_model::{Angle, Double, QuarterTurns};

/// When numbers cancel, a rest below this part of them counts as zero: far below the last place of an `f64`, far above
/// that of a [`Double`].
const CANCELLED: f64 = 1e-26;

/// Returns the number that the decimal text of `value` means: 0.1 is exactly a tenth.
pub(crate) fn decimal(value: f64) -> Double {
    Double::decimal(value)
}

/// Rounds to the nearest `f64`; returns zero for a rest that is left when numbers of size `scale` cancel.
pub(crate) fn rounded(value: Double, scale: f64) -> f64 {
    let value = value.to_f64();
    if value.abs() <= CANCELLED * scale { 0.0 } else { value }
}

/// A vector with components of twice the precision.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Vector(pub(crate) [Double; 3]);

impl Vector {
    pub(crate) const ZERO: Self = Self([Double::new(0.0); 3]);

    /// Makes a vector of the numbers that the decimal texts of `numbers` mean.
    pub(crate) fn decimal(numbers: [f64; 3]) -> Self {
        Self(numbers.map(decimal))
    }

    /// Returns the unit vector along an axis of the frame.
    pub(crate) fn unit(axis: usize) -> Self {
        let mut vector = Self::ZERO;
        vector.0[axis] = Double::new(1.0);
        vector
    }

    pub(crate) fn dot(self, other: Self) -> Double {
        let [x, y, z] = self.0;
        let [a, b, c] = other.0;
        x * a + y * b + z * c
    }

    pub(crate) fn cross(self, other: Self) -> Self {
        let [x, y, z] = self.0;
        let [a, b, c] = other.0;
        Self([y * c - z * b, z * a - x * c, x * b - y * a])
    }

    pub(crate) fn norm(self) -> Double {
        self.dot(self).sqrt()
    }

    /// Returns the vector scaled to length 1; `None` if it is zero.
    pub(crate) fn direction(self) -> Option<Self> {
        // Scaled first, so that no square underflows.
        let largest = self.to_f64().into_iter().map(f64::abs).fold(0.0, f64::max);
        if largest == 0.0 {
            return None;
        }
        let scaled = self * (Double::new(1.0) / Double::new(largest));
        Some(scaled * (Double::new(1.0) / scaled.norm()))
    }

    /// Returns the part of the vector that is perpendicular to the unit vector `axis`.
    pub(crate) fn across(self, axis: Self) -> Self {
        self - axis * self.dot(axis)
    }

    pub(crate) fn to_f64(self) -> [f64; 3] {
        self.0.map(Double::to_f64)
    }

    /// Rounds each component to the nearest `f64`; a rest that is left when numbers of size `scale` cancel becomes
    /// zero.
    pub(crate) fn rounded(self, scale: f64) -> [f64; 3] {
        self.0.map(|x| rounded(x, scale))
    }
}

impl Add for Vector {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self([0, 1, 2].map(|i| self.0[i] + other.0[i]))
    }
}

impl Neg for Vector {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl Sub for Vector {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<Double> for Vector {
    type Output = Self;

    fn mul(self, factor: Double) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

/// Returns the sine and the cosine of an angle. Right angles are exact, as everywhere in rne; other multiples of pi/12
/// are exact to the precision of a [`Double`], although a decimal text can only round them.
pub(crate) fn sin_cos(radians: f64) -> (Double, Double) {
    if let Some(right) = Angle::new(radians).right {
        return exact(right);
    }
    if let Some(twelfths) = twelfths_of_pi(radians) {
        let twelfth = Double { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 } / Double::new(12.0);
        return (twelfth * Double::new(twelfths)).sin_cos();
    }
    decimal(radians).sin_cos()
}

fn exact(right: QuarterTurns) -> (Double, Double) {
    let (sin, cos) = right.sin_cos();
    (Double::new(sin), Double::new(cos))
}

/// Returns which multiple of pi/12 an angle is, within 4 units in the last place; a text cannot express it more
/// accurately.
pub(crate) fn twelfths_of_pi(radians: f64) -> Option<f64> {
    let twelfths = (radians * 12.0 / std::f64::consts::PI).round();
    let nearest = twelfths * std::f64::consts::PI / 12.0;
    ((radians - nearest).abs() <= 4.0 * f64::EPSILON * nearest.abs()).then_some(twelfths)
}

/// Returns the angle of the point (cos, sin), in (-pi, pi]; -pi becomes pi. Right angles are rounded to the nearest
/// `f64`.
pub(crate) fn atan2(sin: Double, cos: Double) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    let size = (sin * sin + cos * cos).sqrt();
    let small = |x: Double| x.to_f64().abs() <= CANCELLED * size.to_f64();
    match (small(sin), small(cos)) {
        (true, _) if cos.to_f64() >= 0.0 => return 0.0,
        (true, _) => return PI,
        (_, true) => return FRAC_PI_2.copysign(sin.to_f64()),
        _ => {}
    }
    let first = sin.to_f64().atan2(cos.to_f64());
    // One step of Newton's method from the rounded angle: the small remaining angle equals its own sine.
    let (s, c) = Double::new(first).sin_cos();
    let angle = (Double::new(first) + (sin * c - cos * s) / size).to_f64();
    if angle == -PI { PI } else { angle }
}

/// A rotation matrix: it converts components in the rotated frame to components in the frame around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotation {
    /// The axes of the rotated frame.
    pub(crate) columns: [Vector; 3],
}

impl Rotation {
    pub(crate) fn identity() -> Self {
        Self { columns: [0, 1, 2].map(Vector::unit) }
    }

    /// Makes a rotation about x.
    pub(crate) fn x(radians: f64) -> Self {
        let (s, c) = sin_cos(radians);
        let zero = Double::new(0.0);
        Self { columns: [Vector::unit(0), Vector([zero, c, s]), Vector([zero, -s, c])] }
    }

    /// Makes a rotation about y.
    pub(crate) fn y(radians: f64) -> Self {
        let (s, c) = sin_cos(radians);
        let zero = Double::new(0.0);
        Self { columns: [Vector([c, zero, -s]), Vector::unit(1), Vector([s, zero, c])] }
    }

    /// Makes a rotation about z.
    pub(crate) fn z(radians: f64) -> Self {
        let (s, c) = sin_cos(radians);
        let zero = Double::new(0.0);
        Self { columns: [Vector([c, s, zero]), Vector([-s, c, zero]), Vector::unit(2)] }
    }

    /// Makes a rotation of fixed-axis roll, pitch, yaw as in URDF: Rz(yaw) Ry(pitch) Rx(roll).
    pub(crate) fn rpy([roll, pitch, yaw]: [f64; 3]) -> Self {
        Self::z(yaw) * Self::y(pitch) * Self::x(roll)
    }

    /// Makes a rotation about a unit vector, by Rodrigues' formula.
    pub(crate) fn about(axis: Vector, radians: f64) -> Self {
        let (s, c) = sin_cos(radians);
        let rest = Double::new(1.0) - c;
        let turned = |v: Vector| v * c + axis.cross(v) * s + axis * (axis.dot(v) * rest);
        Self { columns: [0, 1, 2].map(|i| turned(Vector::unit(i))) }
    }

    /// Makes a rotation about an axis of any length; `None` if the axis is zero.
    pub(crate) fn about_axis(axis: [f64; 3], radians: f64) -> Option<Self> {
        Some(Self::about(Vector::decimal(axis).direction()?, radians))
    }

    /// Makes the rotation of a quaternion (w, x, y, z) of any length; `None` if the quaternion is zero.
    pub(crate) fn quaternion(quaternion: [f64; 4]) -> Option<Self> {
        let [w, x, y, z] = quaternion.map(decimal);
        let square = w * w + x * x + y * y + z * z;
        if square.to_f64() < f64::MIN_POSITIVE {
            return None;
        }
        let s = Double::new(2.0) / square;
        let one = Double::new(1.0);
        Some(Self {
            columns: [
                Vector([one - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)]),
                Vector([s * (x * y - w * z), one - s * (x * x + z * z), s * (y * z + w * x)]),
                Vector([s * (x * z + w * y), s * (y * z - w * x), one - s * (x * x + y * y)]),
            ],
        })
    }

    /// Makes the rotation of the frame whose x axis is `x` and whose y axis is the part of `y` perpendicular to it.
    pub(crate) fn of_xy(x: [f64; 3], y: [f64; 3]) -> Option<Self> {
        let x = Vector::decimal(x).direction()?;
        let y = Vector::decimal(y).direction()?.across(x).direction()?;
        Some(Self { columns: [x, y, x.cross(y)] })
    }

    /// Makes the smallest rotation that turns z to a direction; a half turn is about x.
    pub(crate) fn to_z(direction: [f64; 3]) -> Option<Self> {
        let (z, direction) = (Vector::unit(2), Vector::decimal(direction).direction()?);
        let cross = z.cross(direction);
        let axis = cross.direction().unwrap_or(Vector::unit(0));
        Some(Self::about(axis, atan2(cross.norm(), z.dot(direction))))
    }

    /// Makes the rotation of the frame with the z axis `z` and the x axis `x`, both of length 1 and perpendicular.
    pub(crate) fn of_axes(x: Vector, z: Vector) -> Self {
        Self { columns: [x, z.cross(x), z] }
    }

    pub(crate) fn transpose(self) -> Self {
        let [x, y, z] = self.columns;
        Self { columns: [0, 1, 2].map(|i| Vector([x.0[i], y.0[i], z.0[i]])) }
    }

    /// Returns roll, pitch and yaw. Near a pitch of ±90° only the difference, or the sum, of roll and yaw is well
    /// defined. So roll is computed first and rounded, and yaw is computed from the rest of the rotation; rounding then
    /// does not change the rotation.
    pub(crate) fn to_rpy(self) -> [f64; 3] {
        let [x, y, z] = self.columns;
        let level = (x.0[0] * x.0[0] + x.0[1] * x.0[1]).sqrt();
        let pitch = atan2(-x.0[2], level);
        let roll = if level.to_f64() <= CANCELLED { 0.0 } else { atan2(y.0[2], z.0[2]) };
        // R Rx(-roll) = Rz(yaw) Ry(pitch), whose second column is (-sin yaw, cos yaw, 0).
        let second = self * Self::x(-roll) * Vector::unit(1);
        [roll, pitch, atan2(-second.0[0], second.0[1])]
    }
}

impl Mul for Rotation {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { columns: other.columns.map(|column| self * column) }
    }
}

impl Mul<Vector> for Rotation {
    type Output = Vector;

    fn mul(self, v: Vector) -> Vector {
        self.columns[0] * v.0[0] + self.columns[1] * v.0[1] + self.columns[2] * v.0[2]
    }
}

/// The placement of a frame in another frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) rotation: Rotation,
    pub(crate) translation: Vector,
}

impl Pose {
    pub(crate) fn identity() -> Self {
        Self { rotation: Rotation::identity(), translation: Vector::ZERO }
    }

    /// Makes a pose from a translation and fixed-axis roll, pitch, yaw.
    pub(crate) fn new(xyz: [f64; 3], rpy: [f64; 3]) -> Self {
        Self { rotation: Rotation::rpy(rpy), translation: Vector::decimal(xyz) }
    }

    pub(crate) fn inverse(self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// Converts a point from this frame to the frame around it.
    pub(crate) fn point(self, point: Vector) -> Vector {
        self.rotation * point + self.translation
    }
}

impl Mul for Pose {
    type Output = Self;

    fn mul(self, next: Self) -> Self {
        Self { rotation: self.rotation * next.rotation, translation: self.point(next.translation) }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, PI};

    use super::*;

    fn difference(a: Rotation, b: Rotation) -> f64 {
        let parts = a.columns.into_iter().zip(b.columns);
        parts.map(|(a, b)| (a - b).norm().to_f64()).fold(0.0, f64::max)
    }

    #[test]
    #[allow(clippy::approx_constant)] // as files have them
    fn angles_come_back_to_the_last_bit() {
        for angle in [0.0, 1.570_796_327, 1.5708, 3.1415, -0.3, 2.9, 1e-9, -1e-17, FRAC_PI_3, -FRAC_PI_4, PI, 0.1] {
            let (s, c) = sin_cos(angle);
            assert_eq!(atan2(s, c), angle, "{angle}");
        }
        assert_eq!(atan2(Double::new(-1.0), Double::new(0.0)), -FRAC_PI_2);
        assert_eq!(atan2(Double::new(-0.0), Double::new(-1.0)), PI);
    }

    #[test]
    fn decimals_stay_decimals() {
        let a = Pose::new([0.1, 0.333, 0.0], [FRAC_PI_4, 0.0, 0.0]);
        let b = Pose::new([0.2, 0.0, 0.0], [-FRAC_PI_4, 0.0, 0.0]);
        let sum = a * b;
        assert_eq!(sum.translation.rounded(1.0), [0.3, 0.333, 0.0]);
        assert_eq!(sum.rotation.to_rpy(), [0.0; 3]);
        assert_eq!((a.inverse() * a).translation.rounded(1.0), [0.0; 3]);
    }

    /// Computing each angle separately by asin or atan2, as is usual, has an error of 1.5e-11 here.
    #[test]
    fn roll_pitch_yaw_near_the_pole() {
        for off in [0.0, 1e-16, 1e-13, 1e-12, -1e-10, 1e-9, -1e-8, 1e-6, 1e-3] {
            for (roll, yaw) in [(0.3, -1.1), (0.0, 2.0), (-2.9, 0.4), (3.0, 3.0)] {
                for pitch in [FRAC_PI_2 + off, -FRAC_PI_2 + off] {
                    let rotation = Rotation::rpy([roll, pitch, yaw]);
                    let back = Rotation::rpy(rotation.to_rpy());
                    assert!(difference(rotation, back) < 6e-16, "{off} {roll} {yaw}: {:?}", rotation.to_rpy());
                }
            }
        }
    }
}
