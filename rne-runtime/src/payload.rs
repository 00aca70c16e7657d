//! The body fixed to the tip: a gripper and its load.

use core::error::Error;
use core::fmt;

use rne_model::Inertia;

use crate::{Dual, Scalar};

/// A body that is rigidly fixed to the tip frame (`tool` included), in the axes of that frame: what a robot file would
/// say of it if `tool` were its link frame.
///
/// The torques with a payload are those of the arm whose last link has the payload's mass, first moment and inertia
/// too. The default is no payload.
///
/// Neither the mass nor a principal moment of inertia is below zero. Compiled arms, the Python package, the C library and
/// the command line refuse a payload where one is. Derived and emitted code, `Arm` and `DynArm` compute with the numbers that they are given, without a
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

    /// From the ten numbers of [`to_array`](Self::to_array).
    #[must_use]
    pub const fn from_array([mass, x, y, z, xx, yy, zz, xy, xz, yz]: [T; 10]) -> Self {
        Self { mass, com: [x, y, z], inertia: Inertia { xx, yy, zz, xy, xz, yz } }
    }
}

impl<T: Scalar + Into<f64>> Payload<T> {
    /// Refuses a mass or a principal moment of inertia below zero. What is not a number passes: results show it.
    ///
    /// ```
    /// use rne_runtime::Payload;
    ///
    /// let wrong = Payload { mass: -1.0, ..Payload::none() }.check().unwrap_err();
    /// assert_eq!(wrong.to_string(), "the payload's mass is -1 kg: no body has less than 0");
    /// ```
    ///
    /// # Errors
    /// What is below zero.
    pub fn check(&self) -> Result<(), ImpossiblePayload> {
        ImpossiblePayload::check(self.to_array().map(Into::into))
    }
}

/// A payload that no body is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ImpossiblePayload {
    /// The mass is below zero, kg.
    Mass(f64),
    /// The smallest principal moment of inertia is below zero, kg m².
    Moment(f64),
}

/// A principal moment below zero by this part of the largest one is rounding.
const ROUNDED: f64 = 1e-6;

impl ImpossiblePayload {
    /// Checks the ten numbers of [`Payload::to_array`].
    ///
    /// # Errors
    /// What is below zero.
    pub fn check(numbers: [f64; 10]) -> Result<(), Self> {
        let Payload { mass, inertia, .. } = Payload::from_array(numbers);
        if mass < 0.0 {
            return Err(Self::Mass(mass));
        }
        let Inertia { xx, yy, zz, xy, xz, yz } = inertia;
        let two = [xx * yy - xy * xy, yy * zz - yz * yz, zz * xx - xz * xz];
        let three = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
        // a tensor without a negative minor about its diagonal has no negative moment (Sylvester)
        if [xx, yy, zz, three].into_iter().chain(two).all(|minor| minor >= 0.0) {
            return Ok(());
        }
        let negative = |&[least, _, most]: &[f64; 3]| least < -ROUNDED * most.abs();
        inertia.principal_moments().filter(negative).map_or(Ok(()), |[least, ..]| Err(Self::Moment(least)))
    }
}

impl fmt::Display for ImpossiblePayload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mass(mass) => write!(f, "the payload's mass is {mass} kg: no body has less than 0"),
            Self::Moment(moment) => write!(
                f,
                "the payload's inertia has a principal moment of {moment:.3e} kg m²: no body has less than 0; write \
                 the inertia about the centre of mass, not about the tip"
            ),
        }
    }
}

impl Error for ImpossiblePayload {}

/// [`Payload::none`].
impl<T: Scalar> Default for Payload<T> {
    fn default() -> Self {
        Self::none()
    }
}
