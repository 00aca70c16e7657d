//! What a function returns, number by number.

use rne::{
    AccelerationDerivatives, MomentumAndRate, NextState, NextStateDerivatives, Pose, TorqueDerivatives, TorqueGradient,
    TorqueHessian, Wrench,
};

/// Numbers in a shape.
pub trait Numbers {
    /// Each of them, in order.
    fn each(&self, act: &mut impl FnMut(f32));
}

impl Numbers for f32 {
    fn each(&self, act: &mut impl FnMut(f32)) {
        act(*self);
    }
}

impl<N: Numbers, const LENGTH: usize> Numbers for [N; LENGTH] {
    fn each(&self, act: &mut impl FnMut(f32)) {
        for numbers in self {
            numbers.each(act);
        }
    }
}

impl Numbers for Pose<f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.rotation.each(act);
        self.translation.each(act);
    }
}

impl Numbers for Wrench<f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.force.each(act);
        self.moment.each(act);
    }
}

impl<const DOF: usize> Numbers for TorqueDerivatives<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.dq.each(act);
        self.dqd.each(act);
    }
}

impl<const DOF: usize> Numbers for TorqueGradient<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.dq.each(act);
        self.dqd.each(act);
        self.dqdd.each(act);
    }
}

impl<const DOF: usize> Numbers for AccelerationDerivatives<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.dq.each(act);
        self.dqd.each(act);
        self.dtau.each(act);
    }
}

impl<const DOF: usize> Numbers for MomentumAndRate<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.momentum.each(act);
        self.rate.each(act);
    }
}

impl<const DOF: usize> Numbers for TorqueHessian<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.dq_dq.each(act);
        self.dq_dqd.each(act);
        self.dqd_dqd.each(act);
        self.dq_dqdd.each(act);
    }
}

impl<const DOF: usize> Numbers for NextState<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        self.q.each(act);
        self.qd.each(act);
    }
}

impl<const DOF: usize> Numbers for NextStateDerivatives<DOF, f32> {
    fn each(&self, act: &mut impl FnMut(f32)) {
        for by in [&self.q, &self.qd] {
            by.dq.each(act);
            by.dqd.each(act);
            by.dtau.each(act);
        }
    }
}
