//! The runtime robot with a number of joints known at compile time.

use core::array;

use rne_model::Model;

use crate::link_frame::{Chain, Ends, LinkFrame};
use crate::link_state::{JointMotions, LinkLoad, LinkMotion};
use crate::seven_steps;
use crate::trace::{self, LinkTrace, Trace};
use crate::{BaseMotion, Constant, InverseDynamics, Scalar, Wrench};

/// A robot at run time: the seven steps as loops over links. It answers every question that generated code answers, with
/// the same bits, and is what generated code is tested against.
///
/// `S` is the scalar in which the constants are stored and prepared; the computations run in any [`Scalar`].
#[derive(Clone, Debug, PartialEq)]
pub struct Arm<const DOF: usize, S = f64> {
    model: Model<DOF, S>,
    links: [LinkFrame<S>; DOF],
    ends: Ends<S>,
}

impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// The robot of a plain table. Needs neither `std` nor an allocator.
    #[must_use]
    pub fn new(model: Model<DOF, S>) -> Self {
        let Model { convention, tool, rows, .. } = &model;
        let links = array::from_fn(|index| LinkFrame::new(*convention, rows, tool, index));
        let ends = Ends::new(*convention, rows, tool);
        Self { model, links, ends }
    }

    /// The table this robot was made from.
    #[must_use]
    pub fn model(&self) -> &Model<DOF, S> {
        &self.model
    }

    /// The base at rest under the model's gravity.
    #[must_use]
    pub fn fixed_base<T: Scalar>(&self) -> BaseMotion<T> {
        BaseMotion::fixed(self.model.gravity.map(S::to))
    }

    /// Torques on a moving base: `base` replaces the model's gravity and the base at rest. `wrench` is what the last link
    /// exerts on its environment; `None` is a free tip.
    ///
    /// Joint arrays as in [`InverseDynamics::inverse_dynamics`].
    #[must_use]
    pub fn inverse_dynamics_on_moving_base<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        wrench: Option<&Wrench<T>>,
    ) -> [T; DOF] {
        let mut motions = [LinkMotion::empty(); DOF];
        let mut loads = [LinkLoad::empty(); DOF];
        seven_steps::forward(self.chain(), base, JointMotions { q, qd, qdd }, &mut motions);
        seven_steps::backward(self.chain(), &motions, wrench, &mut loads);
        loads.map(|load| load.tau)
    }

    /// Every vector of the seven steps, in the axes of form P. Arguments as in
    /// [`inverse_dynamics_on_moving_base`](Self::inverse_dynamics_on_moving_base); [`fixed_base`](Self::fixed_base) for
    /// an arm that stands still.
    #[must_use]
    pub fn trace<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        wrench: Option<&Wrench<T>>,
    ) -> Trace<DOF, T> {
        let mut motions = [LinkMotion::empty(); DOF];
        let mut loads = [LinkLoad::empty(); DOF];
        let mut links = [LinkTrace::empty(); DOF];
        let joints = JointMotions { q, qd, qdd };
        seven_steps::forward(self.chain(), base, joints, &mut motions);
        seven_steps::backward(self.chain(), &motions, wrench, &mut loads);
        trace::record(self.chain(), base, joints, &motions, &loads, &mut links);
        Trace { links }
    }

    fn chain(&self) -> Chain<'_, S> {
        Chain { links: &self.links, ends: &self.ends }
    }
}

impl<const DOF: usize, S: Constant> InverseDynamics<DOF> for Arm<DOF, S> {
    fn inverse_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [T; DOF] {
        self.inverse_dynamics_on_moving_base(q, qd, qdd, &self.fixed_base(), None)
    }

    fn inverse_dynamics_with_wrench<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrench: &Wrench<T>,
    ) -> [T; DOF] {
        self.inverse_dynamics_on_moving_base(q, qd, qdd, &self.fixed_base(), Some(wrench))
    }

    fn gravity_torques<T: Scalar>(&self, q: &[T; DOF]) -> [T; DOF] {
        let zero = [T::zero(); DOF];
        self.inverse_dynamics(q, &zero, &zero)
    }

    fn bias_torques<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; DOF] {
        self.inverse_dynamics(q, qd, &[T::zero(); DOF])
    }
}
