//! What is fixed to the tip: a gripper with what it holds.

use nalgebra::{Matrix3, Vector3};
use rne_model::Inertia;

use crate::link_state::{ForceMoment, LinkMotion};
use crate::mount::Mount;
use crate::{Scalar, Wrench};

/// A body that is rigidly fixed to the tip frame (`tool` included), in the axes of that frame: what a robot file would
/// say of it if `tool` were its link frame.
///
/// The torques with a payload are those of the arm whose last link has the payload's mass, first moment and inertia
/// too. The default is no payload.
///
/// ```
/// # #[cfg(feature = "std")] {
/// use rne_runtime::{Arm, InverseDynamics, Payload};
///
/// // a rod of 1 m that hangs down, without mass of its own
/// let rod = "
/// format: 1
/// name: rod
/// source: own
/// convention: standard
/// gravity: [9.81, 0, 0]
/// joints: [{type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}}]
/// ";
/// let arm = Arm::<1>::from_yaml(rod)?;
/// let bob = Payload { mass: 2.0, ..Payload::default() };
/// let [tau] = arm.inverse_dynamics_with_payload(&[0.6], &[0.0], &[3.0], &bob);
/// let expected: f64 = 2.0 * 3.0 + 2.0 * 9.81 * 0.6_f64.sin(); // m l² q̈ + m g l sin q
/// assert!((tau - expected).abs() < 1e-14);
/// # }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload<T> {
    /// Mass, kg.
    pub mass: T,
    /// Centre of mass from the origin of the tip frame, in tip-frame axes, m.
    pub com: [T; 3],
    /// Inertia about the centre of mass, in tip-frame axes, kg m²: tensor elements, `xy` is -∫ x y dm.
    pub inertia: Inertia<T>,
}

impl<T: Scalar> Payload<T> {
    /// Nothing at the tip.
    #[must_use]
    pub fn none() -> Self {
        let zero = T::zero();
        let inertia = Inertia { xx: zero, yy: zero, zz: zero, xy: zero, xz: zero, yz: zero };
        Self { mass: zero, com: [zero; 3], inertia }
    }

    /// The ten numbers in the order in which generated code and C take them: mass; centre of mass x, y, z; inertia xx,
    /// yy, zz, xy, xz, yz.
    #[must_use]
    pub const fn to_array(&self) -> [T; 10] {
        let ([x, y, z], Inertia { xx, yy, zz, xy, xz, yz }) = (self.com, self.inertia);
        [self.mass, x, y, z, xx, yy, zz, xy, xz, yz]
    }

    /// From the ten numbers of [`to_array`](Self::to_array).
    #[must_use]
    pub const fn from_array([mass, x, y, z, xx, yy, zz, xy, xz, yz]: [T; 10]) -> Self {
        Self { mass, com: [x, y, z], inertia: Inertia { xx, yy, zz, xy, xz, yz } }
    }

    /// What the last link exerts on it, at the tip, in tip axes: steps 1, 2, 4, 5 and 6 of one link more, whose joint
    /// does not move. `last` is the motion of the last link, `tip` where the tip frame stands on it.
    ///
    /// - ω = Rᵀ ω_n, ω̇ = Rᵀ ω̇_n, g = Rᵀ g_n
    /// - c̈ = Rᵀ (c̈_n + ω̇_n × r + ω_n × (ω_n × r)) + ω̇ × c + ω × (ω × c)
    /// - f = m (c̈ - g), n = I ω̇ + ω × (I ω) + c × f
    pub(crate) fn wrench(&self, last: &LinkMotion<T>, tip: &Mount<T>) -> ForceMoment<T> {
        let (com, inertia) = (Vector3::from(self.com), Matrix3::from(self.inertia.rows()).transpose());
        let (r, rotation) = (&tip.r, &tip.rotation);
        let omega = rotation.tr_mul(&last.omega);
        let omega_dot = rotation.tr_mul(&last.omega_dot);
        let origin = (last.acceleration + last.omega_dot.cross(r)) + last.omega.cross(&last.omega.cross(r));
        let acceleration = (rotation.tr_mul(&origin) + omega_dot.cross(&com)) + omega.cross(&omega.cross(&com));
        let gravity = rotation.tr_mul(&last.gravity);
        let force = (acceleration - gravity) * self.mass;
        let moment = (inertia * omega_dot + omega.cross(&(inertia * omega))) + com.cross(&force);
        ForceMoment { force, moment }
    }
}

/// [`Payload::none`].
impl<T: Scalar> Default for Payload<T> {
    fn default() -> Self {
        Self::none()
    }
}

/// What the last link exerts at the tip.
#[derive(Clone, Copy, Debug)]
pub(crate) enum AtTip<'a, T> {
    /// Nothing.
    Nothing,
    /// A force and a moment.
    Wrench(&'a Wrench<T>),
    /// What moves a body.
    Payload(&'a Payload<T>),
}

impl<'a, T> From<Option<&'a Wrench<T>>> for AtTip<'a, T> {
    fn from(wrench: Option<&'a Wrench<T>>) -> Self {
        wrench.map_or(Self::Nothing, Self::Wrench)
    }
}

impl<T: Scalar> AtTip<'_, T> {
    /// In tip axes, for the last link's motion.
    pub(crate) fn wrench(self, last: Option<&LinkMotion<T>>, tip: &Mount<T>) -> ForceMoment<T> {
        match (self, last) {
            (Self::Wrench(wrench), _) => wrench.into(),
            (Self::Payload(payload), Some(last)) => payload.wrench(last, tip),
            _ => ForceMoment::zero(),
        }
    }
}
