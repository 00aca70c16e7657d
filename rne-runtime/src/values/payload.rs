//! The body fixed to the tip: a gripper and its load.

use core::error::Error;
use core::fmt;

use rne_model::Inertia;

use crate::{Dual, Scalar};

/// A body that is rigidly fixed to the tip frame (`tool` included), in the axes of that frame, as a robot file would
/// describe it if `tool` were its link frame.
///
/// The torques with a payload are those of the arm whose last link has the payload's mass, first moment and inertia
/// too. The default is no payload.
///
/// The mass is not below zero. Compiled arms, the Python package, the C library and the command line refuse a payload
/// whose mass is. Derived and emitted code, `Arm` and `DynArm` compute with the numbers that they are given, without a
/// branch that looks at them: call [`check`](Self::check) where a payload comes from outside of the program.
///
/// ```
/// # #[cfg(all(feature = "arm", feature = "std"))] {
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

    /// The payload in dual numbers, as a constant: all its derivatives are zero.
    pub(crate) fn still(&self) -> Payload<Dual<T>> {
        Payload::from_array(self.to_array().map(Dual::constant))
    }

    /// The ten numbers in the order in which generated code and C take them: mass; centre of mass x, y, z; inertia xx,
    /// yy, zz, xy, xz, yz.
    #[must_use]
    pub const fn to_array(&self) -> [T; 10] {
        let ([x, y, z], Inertia { xx, yy, zz, xy, xz, yz }) = (self.com, self.inertia);
        [self.mass, x, y, z, xx, yy, zz, xy, xz, yz]
    }

    /// Creates a payload from the ten numbers of [`to_array`](Self::to_array).
    #[must_use]
    pub const fn from_array([mass, x, y, z, xx, yy, zz, xy, xz, yz]: [T; 10]) -> Self {
        Self { mass, com: [x, y, z], inertia: Inertia { xx, yy, zz, xy, xz, yz } }
    }
}

impl<T: Scalar + Into<f64>> Payload<T> {
    /// Refuses a mass below zero. A mass that is NaN is accepted, because the results are NaN then.
    ///
    /// ```
    /// use rne_runtime::Payload;
    ///
    /// let wrong = Payload { mass: -1.0, ..Payload::none() }.check().unwrap_err();
    /// assert_eq!(wrong.to_string(), "the payload's mass is -1 kg: no body has less than 0");
    /// ```
    ///
    /// # Errors
    /// When the mass is below zero.
    pub fn check(&self) -> Result<(), NegativeMass> {
        NegativeMass::check(self.mass)
    }
}

/// A payload whose mass is below zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NegativeMass {
    /// The mass, kg.
    pub mass: f64,
}

impl NegativeMass {
    /// Refuses a payload's mass that is below zero.
    ///
    /// # Errors
    /// When it is below zero.
    pub fn check(mass: impl Into<f64>) -> Result<(), Self> {
        let mass = mass.into();
        if mass < 0.0 { Err(Self { mass }) } else { Ok(()) }
    }
}

impl fmt::Display for NegativeMass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the payload's mass is {} kg: no body has less than 0", self.mass)
    }
}

impl Error for NegativeMass {}

/// The default is [`Payload::none`].
impl<T: Scalar> Default for Payload<T> {
    fn default() -> Self {
        Self::none()
    }
}
