//! All that the PUMA 560 can compute besides `inverse_dynamics`.

use rne::{
    AccelerationDerivatives, BaseMotion, MomentumAndRate, NextState, NextStateDerivatives, ObserverState, Payload,
    Pose, Scalar, TorqueDerivatives, TorqueGradient, TorqueHessian, Wrench,
};

use crate::numbers::Numbers;
use crate::states::State;

/// What is done with each function.
pub trait Visitor {
    /// `form` and `function` name the function of [`each`] that is called.
    fn visit<N: Numbers>(&mut self, form: &'static str, function: &'static str, call: impl Fn(&Arguments) -> N);
}

/// An argument of every name.
pub struct Arguments {
    q: [f32; 6],
    qd: [f32; 6],
    qdd: [f32; 6],
    /// Sines and cosines of `q`.
    pub sin: [f32; 6],
    pub cos: [f32; 6],
    tau: [f32; 6],
    multipliers: [f32; 6],
    wrench: Wrench<f32>,
    payload: Payload<f32>,
    base: BaseMotion<f32>,
    step: f32,
}

impl Arguments {
    /// At a state; the torques are as large as the accelerations, tip and base as they happen to be.
    #[must_use]
    pub fn at(State { q, qd, qdd }: State<6>) -> Self {
        let (sin, cos) = f32::sin_cos_array(q);
        let wrench = Wrench { force: [1.0, -2.0, 3.0], moment: [0.5, 0.25, -0.125] };
        let payload = Payload::from_array([0.5, 0.01, -0.02, 0.1, 0.002, 0.003, 0.001, 0.0001, -0.0002, 0.0003]);
        let mut base = BaseMotion::fixed([0.0, 0.0, -9.81]);
        base.omega = [0.1, -0.2, 0.3];
        Self { q, qd, qdd, sin, cos, tau: qdd, multipliers: qdd, wrench, payload, base, step: 0.01 }
    }
}

/// A tick of the momentum observer.
type Update = fn(&mut ObserverState<6, f32>, &[f32; 6], &[f32; 6], &[f32; 6]) -> [f32; 6];

impl Arguments {
    /// What an observer of 20 Hz at 1 kHz sees in its third tick.
    fn observed(&self, update: Update) -> [f32; 6] {
        let Self { q, qd, tau, sin, cos, .. } = self;
        let mut observer = ObserverState::new(20.0, 1e-3);
        let _ = (update(&mut observer, q, qd, tau), update(&mut observer, sin, cos, tau));
        update(&mut observer, cos, sin, qd)
    }
}

/// An argument as a method takes it: a number by its value.
macro_rules! passed {
    (step of $argument:ident) => {
        *$argument
    };
    ($name:ident of $argument:ident) => {
        $argument
    };
}

/// A module per form with a function per method, and [`each`].
macro_rules! methods {
    ($($capability:ident: $function:ident($($argument:ident: $type:ty),*) -> $returned:ty;)*) => {
        methods!(seven_steps, "seven_steps": $($capability $function($($argument: $type),*) $returned)*);
        methods!(reduced, "reduced": $($capability $function($($argument: $type),*) $returned)*);

        /// Shows every function to a visitor.
        pub fn each(visitor: &mut impl Visitor) {
            $(
                visitor.visit("seven_steps", stringify!($function), |a| seven_steps::$function($(&a.$argument),*));
                visitor.visit("reduced", stringify!($function), |a| reduced::$function($(&a.$argument),*));
            )*
            visitor.visit("seven_steps", "observer_update", |a| a.observed(seven_steps::observer_update));
            visitor.visit("reduced", "observer_update", |a| a.observed(reduced::observer_update));
        }
    };
    (
        $form:ident, $name:literal:
        $($capability:ident $function:ident($($argument:ident: $type:ty),*) $returned:ty)*
    ) => {
        #[doc = concat!("The form `", $name, "`.")]
        pub mod $form {
            use super::{
                AccelerationDerivatives, BaseMotion, MomentumAndRate, NextState, NextStateDerivatives, ObserverState,
                Payload, Pose, TorqueDerivatives,
                TorqueGradient, TorqueHessian, Wrench,
            };

            #[derive(
                rne::InverseDynamics, rne::MassMatrix, rne::CoriolisMatrix, rne::ForwardDynamics, rne::Kinematics,
                rne::Energy, rne::CentreOfMass, rne::Regressor, rne::InverseDynamicsDerivatives, rne::JointWrenches,
                rne::MomentumObserver, rne::MovingBase, rne::Actuation, rne::PayloadDynamics,
                rne::InverseDynamicsGradient, rne::ForwardDynamicsDerivatives, rne::JacobianDerivatives,
                rne::InverseDynamicsHessian, rne::EulerStep,
                rne::EulerStepDerivatives,
            )]
            #[robot(path = "../../../robots/puma560.yaml", form = $name)]
            struct Robot;

            $(
                /// The method of this name.
                #[inline(never)]
                #[must_use]
                pub fn $function($($argument: &$type),*) -> $returned {
                    rne::$capability::$function(&Robot, $(passed!($argument of $argument)),*)
                }
            )*

            /// Its code is in the update alone, which can be read there.
            #[derive(rne::MomentumObserver)]
            #[robot(path = "../../../robots/puma560.yaml", form = $name)]
            struct Observed;

            /// A tick of the momentum observer.
            #[inline(never)]
            #[must_use]
            pub fn observer_update(
                observer: &mut ObserverState<6, f32>,
                q: &[f32; 6],
                qd: &[f32; 6],
                tau: &[f32; 6],
            ) -> [f32; 6] {
                observer.update(&Observed, q, qd, tau)
            }
        }
    };
}

methods! {
    InverseDynamics: inverse_dynamics_with_wrench(q: [f32; 6], qd: [f32; 6], qdd: [f32; 6], wrench: Wrench<f32>)
        -> [f32; 6];
    InverseDynamics: inverse_dynamics_with_payload(q: [f32; 6], qd: [f32; 6], qdd: [f32; 6], payload: Payload<f32>)
        -> [f32; 6];
    InverseDynamics: inverse_dynamics_from_sin_cos(
        sin: [f32; 6], cos: [f32; 6], q: [f32; 6], qd: [f32; 6], qdd: [f32; 6]
    ) -> [f32; 6];
    InverseDynamics: gravity_torques(q: [f32; 6]) -> [f32; 6];
    InverseDynamics: bias_torques(q: [f32; 6], qd: [f32; 6]) -> [f32; 6];
    MassMatrix: mass_matrix(q: [f32; 6]) -> [[f32; 6]; 6];
    MassMatrix: inverse_mass_matrix(q: [f32; 6]) -> [[f32; 6]; 6];
    CoriolisMatrix: coriolis_matrix(q: [f32; 6], qd: [f32; 6]) -> [[f32; 6]; 6];
    CoriolisMatrix: coriolis_torques(q: [f32; 6], qd: [f32; 6]) -> [f32; 6];
    ForwardDynamics: forward_dynamics(q: [f32; 6], qd: [f32; 6], tau: [f32; 6]) -> [f32; 6];
    Kinematics: forward_kinematics(q: [f32; 6]) -> Pose<f32>;
    Kinematics: link_poses(q: [f32; 6]) -> [Pose<f32>; 6];
    Kinematics: jacobian(q: [f32; 6]) -> [[f32; 6]; 6];
    Kinematics: jacobian_rate_times_velocity(q: [f32; 6], qd: [f32; 6]) -> [f32; 6];
    Kinematics: wrench_torques(q: [f32; 6], wrench: Wrench<f32>) -> [f32; 6];
    Energy: kinetic_energy(q: [f32; 6], qd: [f32; 6]) -> f32;
    Energy: potential_energy(q: [f32; 6]) -> f32;
    CentreOfMass: centre_of_mass(q: [f32; 6]) -> [f32; 3];
    CentreOfMass: centre_of_mass_jacobian(q: [f32; 6]) -> [[f32; 6]; 3];
    Regressor: regressor(q: [f32; 6], qd: [f32; 6], qdd: [f32; 6]) -> [[[f32; 10]; 6]; 6];
    InverseDynamicsDerivatives: inverse_dynamics_derivatives(q: [f32; 6], qd: [f32; 6], qdd: [f32; 6])
        -> TorqueDerivatives<6, f32>;
    JointWrenches: joint_wrenches(q: [f32; 6], qd: [f32; 6], qdd: [f32; 6]) -> [Wrench<f32>; 6];
    MomentumObserver: momentum_and_rate(q: [f32; 6], qd: [f32; 6], tau: [f32; 6]) -> MomentumAndRate<6, f32>;
    MovingBase: inverse_dynamics_on_moving_base(q: [f32; 6], qd: [f32; 6], qdd: [f32; 6], base: BaseMotion<f32>)
        -> [f32; 6];
    Actuation: actuator_torques(qd: [f32; 6], qdd: [f32; 6]) -> [f32; 6];
    PayloadDynamics: gravity_torques_with_payload(q: [f32; 6], payload: Payload<f32>) -> [f32; 6];
    PayloadDynamics: bias_torques_with_payload(q: [f32; 6], qd: [f32; 6], payload: Payload<f32>) -> [f32; 6];
    PayloadDynamics: mass_matrix_with_payload(q: [f32; 6], payload: Payload<f32>) -> [[f32; 6]; 6];
    PayloadDynamics: forward_dynamics_with_payload(
        q: [f32; 6], qd: [f32; 6], tau: [f32; 6], payload: Payload<f32>
    ) -> [f32; 6];
    PayloadDynamics: inverse_dynamics_derivatives_with_payload(
        q: [f32; 6], qd: [f32; 6], qdd: [f32; 6], payload: Payload<f32>
    ) -> TorqueDerivatives<6, f32>;
    PayloadDynamics: momentum_and_rate_with_payload(
        q: [f32; 6], qd: [f32; 6], tau: [f32; 6], payload: Payload<f32>
    ) -> MomentumAndRate<6, f32>;
    MassMatrix: inverse_mass_matrix_times_torques(q: [f32; 6], tau: [f32; 6]) -> [f32; 6];
    PayloadDynamics: forward_dynamics_derivatives_with_payload(
        q: [f32; 6], qd: [f32; 6], tau: [f32; 6], payload: Payload<f32>
    ) -> AccelerationDerivatives<6, f32>;
    JacobianDerivatives: jacobian_rate(q: [f32; 6], qd: [f32; 6]) -> [[f32; 6]; 6];
    JacobianDerivatives: jacobian_derivatives(q: [f32; 6]) -> [[[f32; 6]; 6]; 6];
    InverseDynamicsGradient: torque_gradient(
        q: [f32; 6], qd: [f32; 6], qdd: [f32; 6], multipliers: [f32; 6]
    ) -> TorqueGradient<6, f32>;
    ForwardDynamicsDerivatives: forward_dynamics_derivatives(q: [f32; 6], qd: [f32; 6], tau: [f32; 6])
        -> AccelerationDerivatives<6, f32>;
    InverseDynamicsHessian: torque_hessian(
        q: [f32; 6], qd: [f32; 6], qdd: [f32; 6], multipliers: [f32; 6]
    ) -> TorqueHessian<6, f32>;
    EulerStep: euler_step(q: [f32; 6], qd: [f32; 6], tau: [f32; 6], step: f32) -> NextState<6, f32>;
    EulerStepDerivatives: euler_step_derivatives(q: [f32; 6], qd: [f32; 6], tau: [f32; 6], step: f32)
        -> NextStateDerivatives<6, f32>;
}
