//! Friction of the joints: the numbers of the robot file for the module of the package that computes it.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use rne_emit::{JointFriction, NoFriction};

use crate::arm::Arm;

impl Arm {
    /// The numbers viscous, odd, even and width of each joint.
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
}

#[pymethods]
impl Arm {
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
    #[pyo3(signature = (qd, *, width=None))]
    fn friction_torques<'py>(
        slf: &Bound<'py, Self>,
        qd: &Bound<'py, PyAny>,
        width: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let numbers = slf.borrow().friction(width)?;
        slf.py().import("rne.friction")?.call_method1("torques", (slf, qd, numbers))
    }

    /// Derivatives of `friction_torques`: of the friction of each joint by its velocity.
    ///
    /// G² B + |G| (½ (Tc⁺ - Tc⁻) + (Tc⁺ + Tc⁻) s) w² / (qd² + w²)^(3/2). These are the elements of a diagonal matrix:
    /// the friction of a joint depends on the velocity of this joint only. Arguments as for `friction_torques`.
    ///
    /// Returns N m s/rad, or N s/m for a sliding joint: shape (n,) or (N, n).
    #[pyo3(signature = (qd, *, width=None))]
    fn friction_derivatives<'py>(
        slf: &Bound<'py, Self>,
        qd: &Bound<'py, PyAny>,
        width: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let numbers = slf.borrow().friction(width)?;
        slf.py().import("rne.friction")?.call_method1("derivatives", (slf, qd, numbers))
    }
}
