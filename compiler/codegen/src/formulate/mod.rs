//! Formulas of each function of a robot, written with a builder: the seven steps and the other functions.

pub(crate) mod actuation;
pub(crate) mod adjoint;
mod arguments;
pub(crate) mod arm;
pub(crate) mod base;
pub(crate) mod carried;
pub(crate) mod centre_of_mass;
pub(crate) mod closure;
mod derivation;
pub(crate) mod energy;
mod equations;
pub(crate) mod first_moment;
pub(crate) mod floating;
pub(crate) mod integrator;
pub(crate) mod joint;
pub(crate) mod kinematics;
mod layout;
pub(crate) mod ldlt;
pub(crate) mod mass_matrix;
pub(crate) mod momentum;
pub(crate) mod payload;
pub(crate) mod regressor;
pub(crate) mod seven_steps;
pub(crate) mod spin;

pub(crate) use arm::{Arm, Body, Link, Mount};
pub(crate) use closure::Closure;
pub(crate) use equations::{
    accelerations, coriolis_matrix, derivatives, forward_dynamics, inverse_mass_matrix, mass_matrix, torque_by,
};
pub(crate) use floating::contact::Contacts;
pub(crate) use floating::step::FloatingStep;
pub(crate) use floating::{
    base_rotation, floating_derivatives, floating_forward_dynamics, floating_mass_matrix, on_base, pose_of_base,
    sensitivity_of_floating_base,
};
pub(crate) use joint::{Joint, JointState, Wrench};
pub(crate) use kinematics::{Frame, Frames};
pub(crate) use layout::{by_joint, square};
pub(crate) use payload::{AtTip, Payload};
pub(crate) use seven_steps::{JointLoad, Motion, Turning};
pub(crate) use spin::Spin;

use rne_model::Robot;

use crate::formulate::derivation::Derivation;
use crate::function::What;
use crate::ir::{Builder, Name, Ref, Symbol};

/// The results of a function, by name, in the order of its layout.
pub(crate) type Outputs<'s> = Vec<(Name, Symbol<'s>)>;

/// Returns the results of the builder's function for a robot. Arguments that are zero for this function are replaced by
/// zero first, so that the builder leaves out the terms that vanish.
pub(crate) fn outputs(builder: &Builder, robot: &Robot) -> Vec<(Name, Ref)> {
    let derivation = Derivation::new(builder, robot);
    let coordinates = derivation.coordinates();
    let outputs = match builder.function.what() {
        What::InverseDynamics
        | What::InverseDynamicsFromSinCos
        | What::GravityTorques
        | What::BiasTorques
        | What::CoriolisTorques => derivation.forces(),
        What::MassMatrix => derivation.mass_matrix(),
        What::InverseMassMatrix => inverse_mass_matrix(builder, &derivation.system(), &derivation.upper_half()),
        What::InverseMassMatrixTimesTorques => {
            accelerations(builder, &derivation.system(), &derivation.upper_half(), |applied, _| applied)
        }
        What::CoriolisMatrix => derivation.coriolis_matrix(),
        What::ForwardDynamics => derivation.accelerations(),
        What::ForwardDynamicsInContact => derivation.accelerations_in_contact(),
        What::EulerStep => derivation.step(),
        What::InverseDynamicsDerivatives => derivation.derivatives(),
        What::ForwardDynamicsDerivatives => derivation.derivatives_of_accelerations(),
        What::EulerStepDerivatives => derivation.derivatives_of_step(),
        What::TorqueGradient => adjoint::gradient(builder, coordinates, &derivation.tau()),
        What::TorqueHessian => adjoint::hessian(builder, coordinates, &derivation.tau()),
        What::ForwardKinematics => derivation.tip_pose(),
        What::LinkPoses => derivation.link_poses(),
        What::Jacobian => derivation.jacobian(),
        What::JacobianRate => derivation.jacobian_rate(),
        What::JacobianRateTimesVelocity => derivation.tip_acceleration(),
        What::JacobianDerivatives => derivation.jacobian_derivatives(),
        What::TipJacobians => derivation.tip_jacobians(),
        What::TipAccelerations => derivation.tip_accelerations(),
        What::WrenchTorques => derivation.wrench_torques(),
        What::KineticEnergy => derivation.kinetic_energy(),
        What::PotentialEnergy => derivation.potential_energy(),
        What::CentreOfMass => derivation.centre_of_mass(),
        What::CentreOfMassJacobian => derivation.centre_of_mass_jacobian(),
        What::CentroidalMomentumMatrix => derivation.centroidal_momentum_matrix(),
        What::CentroidalMomentum => derivation.centroidal_momentum(),
        What::CentroidalBias => derivation.centroidal_bias(),
        What::MomentumAndRate => derivation.momentum_and_rate(),
        What::Regressor => derivation.regressor(),
        What::JointWrenches => derivation.joint_wrenches(),
        What::ActuatorTorques => derivation.actuator_torques(),
        What::ClosureStep => closure::step(builder, robot),
        What::LoopMap => closure::map(builder, coordinates),
        What::LoopMapRateTimesVelocity => closure::bias(builder, coordinates),
    };
    outputs.into_iter().map(|(name, symbol)| (name, symbol.at)).collect()
}
