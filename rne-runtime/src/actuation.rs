//! Torque that a geared motor adds to its joint.
//!
//! ```text
//! G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇)      (G G) Jm, (G G) B and |G| Tc are formed in the scalar of the constants;
//!                                          the sum runs from left to right
//! ```

use rne_model::Motor;

use crate::mechanism::Mechanism;
#[cfg(feature = "std")]
use crate::optimisation::dyn_rows_by;
use crate::per_joint::PerJoint;
#[cfg(feature = "std")]
use crate::smooth_sign::SmoothSign;
use crate::{Actuation, Arm, Constant, Scalar};
#[cfg(feature = "std")]
use crate::{Dual, DynArm, WrongLength};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn actuator_torques<T: Scalar>(self, qd: &[T], qdd: &[T]) -> J::Of<T> {
        // a rotor that belongs to the arm is in its torques
        let of_rotor = |qdd| if self.rotors { T::zero() } else { qdd };
        self.per_joint.of(|i| self.motors[i].map_or_else(T::zero, |motor| torque(&motor, qd[i], of_rotor(qdd[i]))))
    }
}

fn torque<S: Constant, T: Scalar>(motor: &Motor<S>, qd: T, qdd: T) -> T {
    let Motor { inertia, gear_ratio, viscous, coulomb } = *motor;
    let square = gear_ratio * gear_ratio;
    let magnitude = gear_ratio.by_sign(gear_ratio, -gear_ratio);
    let [positive, negative] = coulomb.map(|friction| (magnitude * friction).to::<T>());
    ((square * inertia).to::<T>() * qdd + (square * viscous).to::<T>() * qd) + qd.by_sign(positive, negative)
}

impl<const DOF: usize, S: Constant> Actuation<DOF> for Arm<DOF, S> {
    fn actuator_torques<T: Scalar>(&self, qd: &[T; DOF], qdd: &[T; DOF]) -> [T; DOF] {
        self.mechanism().actuator_torques(qd, qdd)
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`Actuation::actuator_torques`]: the motor terms alone.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn actuator_torques<T: Scalar>(&self, qd: &[T], qdd: &[T]) -> Result<Vec<T>, WrongLength> {
        let qd = &*self.of_joints("qd", qd)?;
        let qdd = &*self.of_joints("qdd", qdd)?;
        Ok(self.couplings.torques(self.mechanism().actuator_torques(qd, qdd)))
    }

    /// As [`Actuation::actuator_torques_smooth`]: friction that changes its sign within about `width`.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn actuator_torques_smooth<T: Scalar>(&self, qd: &[T], qdd: &[T], width: T) -> Result<Vec<T>, WrongLength> {
        let smooth = |values: &[T]| -> Vec<_> { values.iter().map(|&value| SmoothSign { value, width }).collect() };
        let torques = self.actuator_torques(&smooth(qd), &smooth(qdd))?;
        Ok(torques.into_iter().map(|torque| torque.value).collect())
    }

    /// As [`Actuation::actuator_torques_smooth_derivatives`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn actuator_torques_smooth_derivatives<T: Scalar>(
        &self,
        qd: &[T],
        width: T,
    ) -> Result<Vec<Vec<T>>, WrongLength> {
        self.has_length("qd", qd)?;
        let (still, width) = (vec![Dual::constant(T::zero()); qd.len()], Dual::constant(width));
        dyn_rows_by(qd, |qd| self.actuator_torques_smooth(qd, &still, width))
    }
}
