//! Friction of the joints at their velocities.

use numpy::Element;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use rne::compiled::Number;
use rne_emit::{JointFriction, NoFriction};

use crate::arm::{Arm, methods};
use crate::arrays::{Given, Held, are_single, array_of};

impl Arm {
    /// Returns the coefficients of each joint's friction: viscous, odd, even and width. `width` replaces that of the
    /// robot file.
    fn friction(&self, width: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<[f64; 4]>> {
        let number = |width: &Bound<'_, PyAny>| {
            let number = if width.is_instance_of::<PyBool>() { None } else { width.extract::<f64>().ok() };
            number.ok_or_else(|| {
                PyTypeError::new_err(format!("`width` is {width:?}, but it must be one number, in rad/s or m/s"))
            })
        };
        let width = width.map(number).transpose()?;
        if let Some(width) = width.filter(|width| !(width.is_finite() && *width >= JointFriction::NARROWEST)) {
            let least = JointFriction::NARROWEST;
            return Err(PyValueError::new_err(format!(
                "`width` is {width:?}, but it must be a finite number of at least {least:e}, in rad/s or m/s"
            )));
        }
        let frictions = JointFriction::about(self.robot(), width).map_err(|why| {
            let remedy = match why {
                NoFriction::RunTime(_) => ": give this parameter a value when you read the robot file",
                NoFriction::Nowhere => "",
                _ => ". Or give one `width` for all joints",
            };
            PyValueError::new_err(format!("{why}{remedy}"))
        })?;
        Ok(frictions.iter().map(JointFriction::numbers).collect())
    }

    /// Evaluates a law of friction at the velocity of each joint.
    fn at_velocities<'py>(
        &self,
        qd: &Bound<'py, PyAny>,
        width: Option<&Bound<'py, PyAny>>,
        law: impl Fn(f64, [f64; 4]) -> f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (numbers, given) = (self.friction(width)?, [self.of_joints("qd", qd)?]);
        let law = |(at, qd): (usize, f64)| law(qd, numbers[at % numbers.len()]);
        if are_single(&given) {
            of_each::<f32>(qd.py(), &given[0], law)
        } else {
            of_each::<f64>(qd.py(), &given[0], law)
        }
    }
}

/// Applies a function to each number of an argument, with the index of the number.
fn of_each<'py, T: Element + Number>(
    py: Python<'py>,
    given: &Given<'py>,
    law: impl Fn((usize, f64)) -> f64,
) -> PyResult<Bound<'py, PyAny>> {
    let held = Held::<T>::of(given, &(0..0))?;
    let rows = held.rows(held.states.unwrap_or(1))?;
    let results: Vec<T> = rows.into_iter().map(Into::into).enumerate().map(|each| T::from_f64(law(each))).collect();
    array_of(py, held.states.as_slice(), &[held.elements()], results)
}

methods! {
    (qd, *, width=None)
    (
        &self,
        qd: &Bound<'py, PyAny>,
        width: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>>;

    /// Friction of the joints at velocities: viscous, and Coulomb's with a smooth change of sign.
    ///
    /// G² B qd + |G| (½ (Tc⁺ - Tc⁻) s + ½ (Tc⁺ + Tc⁻) s²) with s = qd / √(qd² + w²), by the key `motor` of each joint
    /// of the robot file. Positive for a positive velocity, zero at rest, and zero for a joint without friction in the
    /// file: add it to the torques of `inverse_dynamics`, or subtract it from those of `forward_dynamics`. It is the
    /// friction of `rollout`, and the function `friction_torques` of `rne emit --lang c --friction`. Unlike
    /// `actuator_torques`, it has no jump at rest and no torque of rotors.
    ///
    /// qd: rad/s, or m/s for a sliding joint; shape (n,) or (N, n). width: the speed w about which Coulomb friction
    /// changes its sign, rad/s or m/s, the same for all joints; None takes the key `coulomb_width` of each joint.
    ///
    /// Returns N m, or N for a sliding joint: shape (n,) or (N, n).
    friction_torques {
        self.at_velocities(qd, width, |qd, [viscous, odd, even, width]| {
            let s = qd / qd.hypot(width); // `hypot`, because the squares may overflow
            viscous * qd + odd * s + even * s * s
        })
    }

    /// Derivatives of `friction_torques`: of the friction of each joint by its velocity.
    ///
    /// G² B + |G| (½ (Tc⁺ - Tc⁻) + (Tc⁺ + Tc⁻) s) w² / (qd² + w²)^(3/2). These are the elements of a diagonal matrix:
    /// the friction of a joint depends on the velocity of this joint only. Arguments as for `friction_torques`.
    ///
    /// Returns N m s/rad, or N s/m for a sliding joint: shape (n,) or (N, n).
    friction_derivatives {
        self.at_velocities(qd, width, |qd, [viscous, odd, even, width]| {
            let inverse = 1.0 / qd.hypot(width);
            viscous + (odd + 2.0 * even * qd * inverse) * (width * inverse).powi(2) * inverse
        })
    }
}
