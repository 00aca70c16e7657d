//! Derivatives of the torques, and of the wrench on a floating base, by dual numbers through the seven steps:
//! exact up to rounding, one direction at a time.

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::floating_base::BASE;
use crate::definition::per_joint::{PerJoint, Square};
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::{BaseMotion, Constant, Dual, Scalar, Wrench};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns ∂τ/∂q and ∂τ/∂q̇ under a constant load.
    pub(crate) fn torque_derivatives<T: Scalar>(
        self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        load: AtTip<'_, Dual<T>>,
    ) -> [Square<J, T>; 2] {
        let constant = |x: &[T]| self.per_joint.of(|i| Dual::constant(x[i]));
        // x with the derivative 1 for joint j
        let along = |x: &[T], j: usize| {
            let unit = self.unit::<T>(j);
            self.per_joint.of(|i| Dual { value: x[i], derivative: unit.as_ref()[i] })
        };
        let base = self.fixed_base();
        let torques = |q: &J::Of<Dual<T>>, qd: &J::Of<Dual<T>>| {
            let qdd = constant(qdd);
            self.torques(JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref()), &base, load)
        };
        let (still_q, still_qd) = (constant(q), constant(qd));
        // Computed as columns first, then transposed.
        let dq = self.per_joint.of(|j| torques(&along(q, j), &still_qd));
        let dqd = self.per_joint.of(|j| torques(&still_q, &along(qd, j)));
        let rows = |columns: Square<J, Dual<T>>| {
            self.per_joint.of(|i| self.per_joint.of(|j| columns.as_ref()[j].as_ref()[i].derivative))
        };
        [dq, dqd].map(rows)
    }
}

/// A column: six rows of the base, then those of the joints.
type Column<J, T> = ([T; BASE], <J as PerJoint>::Of<T>);

/// Columns of derivatives with respect to the position and the rate of each joint, and to the angular velocity of the
/// base.
struct OfFloatingBase<J: PerJoint, T: Clone> {
    joints: [J::Of<Column<J, T>>; 2],
    omega: [Column<J, T>; 3],
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns the derivatives of a robot with a floating base, with constant wrenches at its tips.
    fn floating_derivatives<T: Scalar>(
        self,
        JointMotions { q, qd, qdd, .. }: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        wrenches: &[Wrench<Dual<T>>],
    ) -> OfFloatingBase<J, T> {
        let along = |x: &[T], direction: Option<usize>| {
            let derivative = |i| if direction == Some(i) { T::one() } else { T::zero() };
            self.per_joint.of(|i| Dual { value: x[i], derivative: derivative(i) })
        };
        let constant = |x: [T; 3]| x.map(Dual::constant);
        let still = BaseMotion {
            omega: constant(base.omega),
            omega_dot: constant(base.omega_dot),
            velocity: constant(base.velocity),
            acceleration: constant(base.acceleration),
            gravity: constant(base.gravity),
        };
        let column = |by_q, by_qd, base: &BaseMotion<Dual<T>>| {
            let (q, qd, qdd) = (along(q, by_q), along(qd, by_qd), along(qdd, None));
            let joints = JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref());
            let (wrench, tau) = self.of_floating_base(joints, base, AtTip::Wrenches(wrenches));
            let of_base = core::array::from_fn(|row| {
                (if row < 3 { wrench.force[row] } else { wrench.moment[row - 3] }).derivative
            });
            (of_base, self.per_joint.of(|joint| tau.as_ref()[joint].derivative))
        };
        let omega = [0, 1, 2].map(|axis| {
            let mut turning = still;
            turning.omega[axis].derivative = T::one();
            column(None, None, &turning)
        });
        let by_q = self.per_joint.of(|joint| column(Some(joint), None, &still));
        let by_qd = self.per_joint.of(|joint| column(None, Some(joint), &still));
        OfFloatingBase { joints: [by_q, by_qd], omega }
    }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    /// Returns ∂τ/∂q and ∂τ/∂q̇.
    pub(crate) fn torque_derivatives<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        load: AtTip<'_, Dual<T>>,
    ) -> (Square<J, T>, Square<J, T>) {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.of_joints(values));
        let found = self.mechanism.torque_derivatives(q.as_ref(), qd.as_ref(), qdd.as_ref(), load);
        let [dq, dqd] = found.map(|matrix| self.coordinates.matrix(matrix));
        (dq, dqd)
    }

    /// Returns the derivatives with respect to positions, rates, and the angular velocity of the base. Rows are those
    /// of the base and of the coordinates.
    #[allow(clippy::type_complexity)] // three matrices
    pub(crate) fn floating_derivatives<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        base: &BaseMotion<T>,
        wrenches: &[Wrench<Dual<T>>],
    ) -> (V::Of<J::Of<T>>, V::Of<J::Of<T>>, V::Of<[T; 3]>) {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.of_joints(values));
        let joints = JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref());
        let OfFloatingBase { joints, omega } = self.mechanism.floating_derivatives(joints, base, wrenches);
        let [dq, dqd] = joints.map(|columns| {
            let all = self.mechanism.per_joint;
            let of_base: [J::Of<T>; BASE] = core::array::from_fn(|row| all.of(|j| columns.as_ref()[j].0[row]));
            let of_joints = all.of(|row| all.of(|j| columns.as_ref()[j].1.as_ref()[row]));
            let (of_base, of_joints) = (self.coordinates.rows(of_base), self.coordinates.matrix(of_joints));
            self.velocities.of(|row| match row.checked_sub(BASE) {
                Some(joint) => of_joints.as_ref()[joint].clone(),
                None => of_base[row].clone(),
            })
        });
        let omega = omega.map(|(of_base, of_joints)| (of_base, self.coordinates.torques(of_joints)));
        let domega = self.velocities.of(|row| {
            omega.each_ref().map(|(of_base, of_joints)| match row.checked_sub(BASE) {
                Some(joint) => of_joints.as_ref()[joint],
                None => of_base[row],
            })
        });
        (dq, dqd, domega)
    }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    /// Returns the derivatives of λᵀτ with respect to q, q̇ and q̈.
    pub(crate) fn gradient<T: Scalar>(self, motion: [&[T]; 3], multipliers: &[T]) -> (J::Of<T>, J::Of<T>, J::Of<T>) {
        let still = motion.map(|x| self.still(x));
        let by = |place: usize| {
            self.coordinates.each().of(|j| {
                let mut moving = still.clone();
                moving[place] = self.along(motion[place], j);
                let [q, qd, qdd] = &moving;
                weighted(self.torques([q.as_ref(), qd.as_ref(), qdd.as_ref()], AtTip::Nothing).as_ref(), multipliers)
            })
        };
        (by(0), by(1), by(2))
    }

    /// Returns the derivatives of the accelerations with respect to q, q̇ and τ, under a load, which is given in
    /// numbers and in dual numbers.
    #[allow(clippy::type_complexity)] // three matrices
    pub(crate) fn acceleration_derivatives<T: Scalar>(
        self,
        [q, qd, tau]: [&[T]; 3],
        load: AtTip<'_, T>,
        still_load: AtTip<'_, Dual<T>>,
    ) -> (Square<J, T>, Square<J, T>, Square<J, T>) {
        let [still_q, still_qd, tau] = [q, qd, tau].map(|x| self.still(x));
        let accelerations = |q: &[_], qd: &[_]| self.forward_dynamics([q, qd, tau.as_ref()], still_load);
        let dq = self.rows_by(q, |q| accelerations(q, still_qd.as_ref()));
        (dq, self.rows_by(qd, |qd| accelerations(still_q.as_ref(), qd)), self.inverse_mass_matrix(q, load))
    }

    /// Returns the second derivatives of λᵀτ: with respect to q twice, to q and q̇, to q̇ twice, and to q and q̈.
    #[allow(clippy::type_complexity)] // four matrices
    pub(crate) fn hessian<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        multipliers: &[T],
    ) -> (Square<J, T>, Square<J, T>, Square<J, T>, Square<J, T>) {
        let each = self.coordinates.each();
        let [still_q, still_qd, qdd, multipliers] = [q, qd, qdd, multipliers].map(|x| self.still(x));
        let gradient = |q: &J::Of<Dual<T>>, qd: &J::Of<Dual<T>>| {
            let (by_q, by_qd, by_qdd) = self.gradient([q.as_ref(), qd.as_ref(), qdd.as_ref()], multipliers.as_ref());
            [by_q, by_qd, by_qdd].map(|row| each.of(|j| row.as_ref()[j].derivative))
        };
        let by_q = each.of(|i| gradient(&self.along(q, i), &still_qd));
        let by_qd = each.of(|i| gradient(&still_q, &self.along(qd, i)));
        let rows = |by: &J::Of<[J::Of<T>; 3]>, place: usize| each.of(|i| by.as_ref()[i][place].clone());
        (rows(&by_q, 0), rows(&by_q, 1), rows(&by_qd, 1), rows(&by_q, 2))
    }
}

/// Returns the derivative of λᵀτ.
fn weighted<T: Scalar>(torques: &[Dual<T>], multipliers: &[T]) -> T {
    torques.iter().zip(multipliers).fold(T::zero(), |sum, (torque, &weight)| sum + torque.derivative * weight)
}
