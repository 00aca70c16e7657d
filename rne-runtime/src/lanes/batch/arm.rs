//! Batches of an [`Arm`].

use super::blocks::States;
use super::{Argument, BatchInverseDynamics, BatchScalar, LengthMismatch, VectorUnit, for_each_part};
use crate::{Arm, Constant, InverseDynamics};

/// Computes one state after the other: a robot that is known at run time is computed by loops, for which vector units
/// have no use.
impl<const DOF: usize, S: Constant + Sync> BatchInverseDynamics<DOF> for Arm<DOF, S> {
    fn inverse_dynamics_batch_on<T: BatchScalar>(
        &self,
        _: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        let motion = ["q", "qd", "qdd"].map(|name| Argument::vector(name, DOF));
        for_each_part(self, [&motion, &[Argument::vector("tau", DOF)]], [q, qd, qdd], tau, one_by_one)
    }
}

/// Writes the torques of all states, each of which is computed separately.
fn one_by_one<R, T: BatchScalar, const DOF: usize>(all: States<'_, R, T, 3, DOF, DOF>)
where
    R: InverseDynamics<DOF>,
{
    let States { robot, count, inputs, mut elements } = all;
    for state in 0..count {
        let [q, qd, qdd] = inputs.map(|arrays| arrays.map(|numbers| numbers[state]));
        for (numbers, torque) in elements.iter_mut().zip(robot.inverse_dynamics(&q, &qd, &qdd)) {
            numbers[state] = torque;
        }
    }
}
