//! Torque that a geared motor adds to its joint.
//!
//! ```text
//! G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇)      (G G) Jm, (G G) B and |G| Tc are formed in the scalar of the constants;
//!                                          the sum runs from left to right
//! ```

use rne_model::Motor;

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::per_joint::PerJoint;
use crate::number::smooth_sign::SmoothSign;
use crate::seven_steps::mechanism::Mechanism;
use crate::{Constant, Scalar};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn actuator_torques<T: Scalar>(self, qd: &[T], qdd: &[T]) -> J::Of<T> {
        // a rotor that belongs to the arm is already part of the arm's torques
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

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn actuator_torques<T: Scalar>(self, qd: &[T], qdd: &[T]) -> J::Of<T> {
        let [qd, qdd] = [qd, qdd].map(|values| self.of_joints(values));
        self.coordinates.torques(self.mechanism.actuator_torques(qd.as_ref(), qdd.as_ref()))
    }

    pub(crate) fn smooth_torques<T: Scalar>(self, qd: &[T], qdd: &[T], width: T) -> J::Of<T> {
        let each = self.coordinates.each();
        let [qd, qdd] = [qd, qdd].map(|x| each.of(|i| SmoothSign { value: x[i], width }));
        let torques = self.actuator_torques(qd.as_ref(), qdd.as_ref());
        each.of(|i| torques.as_ref()[i].value)
    }
}
