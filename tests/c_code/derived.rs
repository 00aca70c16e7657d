//! Shipped robots with everything derived, and their functions by their names.

use rne::{
    Actuation, BaseMotion, BaseTwist, CentreOfMass, CentroidalMomentum, ContactDynamics, CoriolisMatrix, Energy,
    EulerStep, EulerStepDerivatives, FloatingBase, FloatingEnergy, FloatingEulerStep, FloatingEulerStepDerivatives,
    FloatingInverseDynamicsDerivatives, FloatingKinematics, FloatingRegressor, ForwardDynamics,
    ForwardDynamicsDerivatives, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsGradient,
    InverseDynamicsHessian, JacobianDerivatives, JointWrenches, Kinematics, MassMatrix, MomentumObserver, MovingBase,
    PayloadDynamics, Pose, Regressor, Scalar, TipWrenches, Wrench,
};
use rne_codegen::Form;
pub(crate) use rne_codegen::Function;

pub(crate) use crate::states::{self, Numbers};

/// A robot's name, and what is derived for it in each form.
pub(crate) type Forms = (&'static str, Vec<(Form, Box<dyn Derived>)>);

/// A derived robot.
pub(crate) trait Derived: Send + Sync {
    /// All numbers that a function returns, in their order.
    fn single(&self, function: Function, given: &Numbers<f32>) -> Vec<f32>;
    fn double(&self, function: Function, given: &Numbers<f64>) -> Vec<f64>;
}

pub(crate) trait Everything<const DOF: usize, const NV: usize, const BODIES: usize>:
    InverseDynamics<DOF>
    + MassMatrix<DOF>
    + CoriolisMatrix<DOF>
    + ForwardDynamics<DOF>
    + Kinematics<DOF>
    + Energy<DOF>
    + CentreOfMass<DOF>
    + Regressor<DOF>
    + InverseDynamicsDerivatives<DOF>
    + JointWrenches<DOF>
    + MomentumObserver<DOF>
    + MovingBase<DOF>
    + Actuation<DOF>
    + PayloadDynamics<DOF>
    + TipWrenches<DOF, 1>
    + FloatingBase<DOF, NV, 1>
    + CentroidalMomentum<DOF, NV>
    + FloatingRegressor<DOF, NV, BODIES>
    + FloatingEnergy<DOF>
    + FloatingKinematics<DOF, NV, 1>
    + ContactDynamics<DOF, NV, 1>
    + FloatingInverseDynamicsDerivatives<DOF, NV, 1>
    + InverseDynamicsGradient<DOF>
    + ForwardDynamicsDerivatives<DOF>
    + JacobianDerivatives<DOF>
    + InverseDynamicsHessian<DOF>
    + EulerStep<DOF>
    + EulerStepDerivatives<DOF>
    + FloatingEulerStep<DOF, 1>
    + FloatingEulerStepDerivatives<DOF, NV, 1>
{
}

fn flat<const ROWS: usize, const COLUMNS: usize, T: Copy>(rows: [[T; COLUMNS]; ROWS]) -> Vec<T> {
    rows.as_flattened().to_vec()
}

fn pose<T: Scalar>(pose: &Pose<T>) -> Vec<T> {
    [flat(pose.rotation), pose.translation.to_vec()].concat()
}

#[allow(clippy::too_many_lines)] // an arm for each function
pub(crate) fn numbers<const DOF: usize, const NV: usize, const BODIES: usize, T: Scalar>(
    robot: &impl Everything<DOF, NV, BODIES>,
    function: Function,
    given: &Numbers<T>,
) -> Vec<T> {
    let array = |numbers: &Vec<T>| -> [T; DOF] { numbers.as_slice().try_into().expect("one per joint") };
    let [q, qd, qdd, tau] = given.joints.each_ref().map(array);
    let [ref q, ref qd, ref qdd, ref tau] = [q, qd, qdd, tau];
    let [force, moment, omega, omega_dot, acceleration, gravity, ref payload @ ..] = given.vectors;
    let base = BaseMotion { omega, omega_dot, velocity: [T::zero(); 3], acceleration, gravity };
    // numbers that stand one after the other, as C reads them
    let twist = BaseTwist { linear: moment, angular: omega };
    let pose_of_base = Pose { rotation: given.rotation, translation: gravity };
    match function {
        Function::InverseDynamics => robot.inverse_dynamics(q, qd, qdd).to_vec(),
        Function::InverseDynamicsWithWrench => {
            robot.inverse_dynamics_with_wrench(q, qd, qdd, &Wrench { force, moment }).to_vec()
        }
        Function::InverseDynamicsWithWrenches => {
            robot.inverse_dynamics_with_wrenches(q, qd, qdd, &[Wrench { force, moment }]).to_vec()
        }
        Function::ForwardDynamicsWithWrenches => {
            robot.forward_dynamics_with_wrenches(q, qd, tau, &[Wrench { force, moment }]).to_vec()
        }
        Function::InverseDynamicsWithPayload => {
            robot.inverse_dynamics_with_payload(q, qd, qdd, &states::payload(payload)).to_vec()
        }
        Function::InverseDynamicsFromSinCos => {
            robot.inverse_dynamics_from_sin_cos(&array(&given.sine), &array(&given.cosine), q, qd, qdd).to_vec()
        }
        Function::GravityTorques => robot.gravity_torques(q).to_vec(),
        Function::BiasTorques => robot.bias_torques(q, qd).to_vec(),
        Function::MassMatrix => flat(robot.mass_matrix(q)),
        Function::InverseMassMatrix => flat(robot.inverse_mass_matrix(q)),
        Function::CoriolisMatrix => flat(robot.coriolis_matrix(q, qd)),
        Function::CoriolisTorques => robot.coriolis_torques(q, qd).to_vec(),
        Function::ForwardDynamics => robot.forward_dynamics(q, qd, tau).to_vec(),
        Function::ForwardKinematics => pose(&robot.forward_kinematics(q)),
        Function::LinkPoses => robot.link_poses(q).iter().flat_map(pose).collect(),
        Function::Jacobian => flat(robot.jacobian(q)),
        Function::JacobianRateTimesVelocity => robot.jacobian_rate_times_velocity(q, qd).to_vec(),
        Function::WrenchTorques => robot.wrench_torques(q, &Wrench { force, moment }).to_vec(),
        Function::KineticEnergy => vec![robot.kinetic_energy(q, qd)],
        Function::PotentialEnergy => vec![robot.potential_energy(q)],
        Function::CentreOfMass => robot.centre_of_mass(q).to_vec(),
        Function::CentreOfMassJacobian => flat(robot.centre_of_mass_jacobian(q)),
        Function::Regressor => robot.regressor(q, qd, qdd).into_iter().flat_map(flat).collect(),
        Function::InverseDynamicsDerivatives => {
            let derivatives = robot.inverse_dynamics_derivatives(q, qd, qdd);
            [flat(derivatives.dq), flat(derivatives.dqd)].concat()
        }
        Function::TorqueGradient => {
            let gradient = robot.torque_gradient(q, qd, qdd, tau);
            [gradient.dq, gradient.dqd, gradient.dqdd].concat()
        }
        Function::ForwardDynamicsDerivatives => {
            let derivatives = robot.forward_dynamics_derivatives(q, qd, tau);
            [flat(derivatives.dq), flat(derivatives.dqd), flat(derivatives.dtau)].concat()
        }
        Function::JacobianRate => flat(robot.jacobian_rate(q, qd)),
        Function::JacobianDerivatives => robot.jacobian_derivatives(q).into_iter().flat_map(flat).collect(),
        Function::InverseMassMatrixTimesTorques => robot.inverse_mass_matrix_times_torques(q, tau).to_vec(),
        Function::InverseDynamicsDerivativesWithWrenches => {
            let by = robot.inverse_dynamics_derivatives_with_wrenches(q, qd, qdd, &[Wrench { force, moment }]);
            [flat(by.dq), flat(by.dqd)].concat()
        }
        Function::ForwardDynamicsDerivativesWithWrenches => {
            let by = robot.forward_dynamics_derivatives_with_wrenches(q, qd, tau, &[Wrench { force, moment }]);
            [flat(by.dq), flat(by.dqd), flat(by.dtau)].concat()
        }
        Function::ForwardDynamicsDerivativesWithPayload => {
            let by = robot.forward_dynamics_derivatives_with_payload(q, qd, tau, &states::payload(payload));
            [flat(by.dq), flat(by.dqd), flat(by.dtau)].concat()
        }
        Function::TorqueHessian => {
            let hessian = robot.torque_hessian(q, qd, qdd, tau);
            [hessian.dq_dq, hessian.dq_dqd, hessian.dqd_dqd, hessian.dq_dqdd].map(flat).concat()
        }
        Function::EulerStep => {
            let next = robot.euler_step(q, qd, tau, T::from_f64(0.03125));
            [next.q, next.qd].concat()
        }
        Function::EulerStepDerivatives => {
            let by = robot.euler_step_derivatives(q, qd, tau, T::from_f64(0.03125));
            [by.q, by.qd].into_iter().flat_map(|by| [by.dq, by.dqd, by.dtau].map(flat).concat()).collect()
        }
        Function::FloatingEulerStep => {
            let step = T::from_f64(0.03125);
            let next = robot.floating_euler_step(q, qd, tau, &pose_of_base, &twist, step, &[Wrench { force, moment }]);
            let twist = [next.twist.linear, next.twist.angular].concat();
            [pose(&next.pose), twist, next.q.to_vec(), next.qd.to_vec()].concat()
        }
        Function::FloatingEulerStepDerivatives => {
            let (step, wrenches) = (T::from_f64(0.03125), [Wrench { force, moment }]);
            let by = robot.floating_euler_step_derivatives(q, qd, tau, &pose_of_base, &twist, step, &wrenches);
            let [of_positions, of_velocities] =
                [[by.q_dq, by.q_dv], [by.v_dq, by.v_dv]].map(|by| by.map(flat).concat());
            [of_positions, flat(by.q_dtau), of_velocities, flat(by.v_dtau)].concat()
        }
        Function::JointWrenches => {
            let wrenches = robot.joint_wrenches(q, qd, qdd);
            wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment].concat()).collect()
        }
        Function::MomentumAndRate => {
            let found = robot.momentum_and_rate(q, qd, tau);
            [found.momentum, found.rate].concat()
        }
        Function::InverseDynamicsOfFloatingBase => {
            let found = robot.inverse_dynamics_of_floating_base(q, qd, qdd, &base, &[Wrench { force, moment }]);
            [found.wrench.force.to_vec(), found.wrench.moment.to_vec(), found.tau.to_vec()].concat()
        }
        Function::FloatingMassMatrix => flat(robot.floating_mass_matrix(q)),
        Function::CentroidalMomentumMatrix => flat(robot.centroidal_momentum_matrix(q)),
        Function::CentroidalBias => robot.centroidal_bias(q, qd, &omega).to_vec(),
        Function::ForwardDynamicsInContact => {
            let found = robot.forward_dynamics_in_contact(q, qd, tau, &omega, &given.rotation);
            let ([wrench], accelerations) = (found.wrenches_on_robot, found.accelerations);
            let base = [accelerations.base.linear, accelerations.base.angular].concat();
            [base, accelerations.qdd.to_vec(), [wrench.force, wrench.moment].concat()].concat()
        }
        Function::TipJacobians => flat(robot.tip_jacobians(q, &given.rotation)[0]),
        Function::TipAccelerations => flat(robot.tip_accelerations(q, qd, &omega, &given.rotation)),
        Function::FloatingBias => robot.floating_bias(q, qd, &omega, &[Wrench { force, moment }]).to_vec(),
        Function::FloatingForwardDynamics => {
            let found = robot.floating_forward_dynamics(q, qd, tau, &omega, &[Wrench { force, moment }]);
            [found.base.linear.to_vec(), found.base.angular.to_vec(), found.qdd.to_vec()].concat()
        }
        Function::FloatingInverseDynamicsDerivatives => {
            let by = robot.floating_inverse_dynamics_derivatives(q, qd, qdd, &base, &[Wrench { force, moment }]);
            [flat(by.dq), flat(by.dqd), flat(by.domega)].concat()
        }
        Function::FloatingRegressor => robot.floating_regressor(q, qd, qdd, &base).into_iter().flat_map(flat).collect(),
        Function::FloatingKineticEnergy => vec![robot.floating_kinetic_energy(q, qd, &twist)],
        Function::FloatingPotentialEnergy => vec![robot.floating_potential_energy(q, &pose_of_base)],
        Function::CentroidalMomentum => robot.centroidal_momentum(q, qd, &twist).to_vec(),
        Function::InverseDynamicsOnMovingBase => robot.inverse_dynamics_on_moving_base(q, qd, qdd, &base).to_vec(),
        Function::ActuatorTorques => robot.actuator_torques(qd, qdd).to_vec(),
        Function::GravityTorquesWithPayload => {
            robot.gravity_torques_with_payload(q, &states::payload(payload)).to_vec()
        }
        Function::BiasTorquesWithPayload => robot.bias_torques_with_payload(q, qd, &states::payload(payload)).to_vec(),
        Function::MassMatrixWithPayload => flat(robot.mass_matrix_with_payload(q, &states::payload(payload))),
        Function::ForwardDynamicsWithPayload => {
            robot.forward_dynamics_with_payload(q, qd, tau, &states::payload(payload)).to_vec()
        }
        Function::InverseDynamicsDerivativesWithPayload => {
            let payload = states::payload(payload);
            let derivatives = robot.inverse_dynamics_derivatives_with_payload(q, qd, qdd, &payload);
            [flat(derivatives.dq), flat(derivatives.dqd)].concat()
        }
        Function::MomentumAndRateWithPayload => {
            let found = robot.momentum_and_rate_with_payload(q, qd, tau, &states::payload(payload));
            [found.momentum, found.rate].concat()
        }
        other => unreachable!("{other} is of closed loops, which have tests of their own"),
    }
}

macro_rules! robot {
    ($robot:ident $path:literal $form:literal) => {
        pub(super) mod $robot {
            use crate::derived::{Derived, Everything, Function, Numbers, numbers};

            #[derive(
                rne::InverseDynamics,
                rne::MassMatrix,
                rne::CoriolisMatrix,
                rne::ForwardDynamics,
                rne::Kinematics,
                rne::Energy,
                rne::CentreOfMass,
                rne::Regressor,
                rne::InverseDynamicsDerivatives,
                rne::JointWrenches,
                rne::MomentumObserver,
                rne::MovingBase,
                rne::Actuation,
                rne::PayloadDynamics,
                rne::TipWrenches,
                rne::FloatingBase,
                rne::CentroidalMomentum,
                rne::FloatingRegressor,
                rne::FloatingEnergy,
                rne::FloatingKinematics,
                rne::ContactDynamics,
                rne::FloatingInverseDynamicsDerivatives,
                rne::InverseDynamicsGradient,
                rne::ForwardDynamicsDerivatives,
                rne::JacobianDerivatives,
                rne::InverseDynamicsHessian,
                rne::EulerStep,
                rne::EulerStepDerivatives,
                rne::FloatingEulerStep,
                rne::FloatingEulerStepDerivatives,
            )]
            #[robot(path = $path, form = $form, inline, allow_lints)]
            pub(crate) struct Robot;

            impl Everything<{ Robot::DOF }, { Robot::DOF + 6 }, { Robot::DOF + 1 }> for Robot {}

            impl Derived for Robot {
                fn single(&self, function: Function, given: &Numbers<f32>) -> Vec<f32> {
                    numbers(self, function, given)
                }

                fn double(&self, function: Function, given: &Numbers<f64>) -> Vec<f64> {
                    numbers(self, function, given)
                }
            }
        }
    };
}
pub(crate) use robot;

/// Modules of robots by forms, and all of them.
macro_rules! robots {
    ($([$robot:ident, $path:literal])*) => {
        mod seven_steps {
            $(crate::derived::robot!($robot $path "seven_steps");)*
        }

        mod reduced {
            $(crate::derived::robot!($robot $path "reduced");)*
        }

        /// The robots with their forms.
        fn robots() -> Vec<crate::derived::Forms> {
            vec![$((
                seven_steps::$robot::Robot::NAME,
                vec![
                    (rne_codegen::Form::SevenSteps, Box::new(seven_steps::$robot::Robot)),
                    (rne_codegen::Form::Reduced, Box::new(reduced::$robot::Robot)),
                ],
            )),*]
        }
    };
}
pub(crate) use robots;
