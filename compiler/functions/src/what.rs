//! The results of functions, as a table: for a base that is fixed or moved, and for a floating base, the trait and the
//! entry.

use crate::axes::Base;
use crate::entry::Entry;
use crate::{Capability, fixed_base as fixed, floating_base as floating, named};

macro_rules! whats {
    ($(
        $(#[$doc:meta])*
        $what:ident = $name:literal $(| $alias:literal)*:
            [$($fixed_trait:ident $($fixed:ident)::+)?] [$($floating_trait:ident $($floating:ident)::+)?];
    )*) => {
        named! {
            /// The result of a function, whatever the base, the load and the loops of the robot.
            What { $($(#[$doc])* $what = $name),* }
        }

        impl What {
            /// The result that other programs, or a function at a frame, have under a name.
            #[must_use]
            pub fn of_alias(name: &str) -> Option<Self> {
                match name {
                    $($($alias => Some(Self::$what),)*)*
                    _ => None,
                }
            }

            /// The entry for a base.
            pub(crate) const fn entry(self, base: Base) -> Entry {
                let [fixed, floating] = match self {
                    $(Self::$what => [
                        [$(Some((Capability::$fixed_trait, $($fixed)::+)),)? None][0],
                        [$(Some((Capability::$floating_trait, $($floating)::+)),)? None][0],
                    ],)*
                };
                let found = if matches!(base, Base::Floating) { floating } else { fixed };
                let (capability, entry) = found.expect("an entry for each kind of base");
                Entry { what: self, capability, ..entry }
            }
        }
    };
}

whats! {
    /// Torques from motion.
    InverseDynamics = "inverse_dynamics" | "torques" | "rnea":
        [InverseDynamics Entry::TORQUES] [FloatingBase floating::TORQUES];
    /// Torques from motion, with the sines and cosines of the positions as arguments.
    InverseDynamicsFromSinCos = "inverse_dynamics_from_sin_cos": [InverseDynamics Entry::TORQUES] [];
    /// Torques that hold the robot still.
    GravityTorques = "gravity_torques": [InverseDynamics fixed::GRAVITY_TORQUES] [];
    /// Torques where nothing accelerates.
    BiasTorques = "bias_torques": [InverseDynamics fixed::BIAS_TORQUES] [FloatingBase floating::BIAS_TORQUES];
    /// C(q, q̇) q̇: torques where nothing accelerates or weighs.
    CoriolisTorques = "coriolis_torques": [CoriolisMatrix fixed::CORIOLIS_TORQUES] [];
    /// M(q).
    MassMatrix = "mass_matrix" | "crba": [MassMatrix fixed::MASS_MATRIX] [FloatingBase floating::MASS_MATRIX];
    /// M(q)⁻¹.
    InverseMassMatrix = "inverse_mass_matrix": [MassMatrix fixed::INVERSE_MASS_MATRIX] [];
    /// M(q)⁻¹ τ.
    InverseMassMatrixTimesTorques = "inverse_mass_matrix_times_torques":
        [MassMatrix fixed::INVERSE_MASS_MATRIX_TIMES_TORQUES] [];
    /// C(q, q̇).
    CoriolisMatrix = "coriolis_matrix": [CoriolisMatrix fixed::CORIOLIS_MATRIX] [];
    /// Accelerations from torques.
    ForwardDynamics = "forward_dynamics" | "aba":
        [ForwardDynamics fixed::FORWARD_DYNAMICS] [FloatingBase floating::ACCELERATIONS];
    /// Accelerations from torques while contacts hold some of the tips.
    ForwardDynamicsInContact = "forward_dynamics_in_contact":
        [] [ContactDynamics floating::FORWARD_DYNAMICS_IN_CONTACT];
    /// The pose of the tip.
    ForwardKinematics = "forward_kinematics" | "pose" | "fk": [Kinematics fixed::FORWARD_KINEMATICS] [];
    /// The poses of all links.
    LinkPoses = "link_poses": [Kinematics fixed::LINK_POSES] [];
    /// The Jacobian J of the tip.
    Jacobian = "jacobian": [Kinematics fixed::JACOBIAN] [];
    /// J̇.
    JacobianRate = "jacobian_rate": [JacobianDerivatives fixed::JACOBIAN_RATE] [];
    /// J̇ q̇.
    JacobianRateTimesVelocity = "jacobian_rate_times_velocity": [Kinematics fixed::JACOBIAN_RATE_TIMES_VELOCITY] [];
    /// ∂J/∂q.
    JacobianDerivatives = "jacobian_derivatives": [JacobianDerivatives fixed::JACOBIAN_DERIVATIVES] [];
    /// The Jacobian of each tip.
    TipJacobians = "tip_jacobians": [] [FloatingKinematics floating::TIP_JACOBIANS];
    /// The acceleration of each tip where nothing accelerates.
    TipAccelerations = "tip_accelerations": [] [FloatingKinematics floating::TIP_ACCELERATIONS];
    /// Kinetic energy.
    KineticEnergy = "kinetic_energy": [Energy fixed::KINETIC_ENERGY] [FloatingEnergy floating::KINETIC_ENERGY];
    /// Potential energy.
    PotentialEnergy = "potential_energy":
        [Energy fixed::POTENTIAL_ENERGY] [FloatingEnergy floating::POTENTIAL_ENERGY];
    /// The centre of mass.
    CentreOfMass = "centre_of_mass": [CentreOfMass fixed::CENTRE_OF_MASS] [];
    /// The Jacobian of the centre of mass.
    CentreOfMassJacobian = "centre_of_mass_jacobian": [CentreOfMass fixed::CENTRE_OF_MASS_JACOBIAN] [];
    /// Torques per inertial parameter.
    Regressor = "regressor": [Regressor fixed::REGRESSOR] [FloatingRegressor floating::REGRESSOR];
    /// Derivatives of the torques.
    InverseDynamicsDerivatives = "inverse_dynamics_derivatives":
        [InverseDynamicsDerivatives fixed::DERIVATIVES]
        [FloatingInverseDynamicsDerivatives floating::INVERSE_DYNAMICS_DERIVATIVES];
    /// Derivatives of the accelerations.
    ForwardDynamicsDerivatives = "forward_dynamics_derivatives":
        [ForwardDynamicsDerivatives fixed::ACCELERATION_DERIVATIVES] [];
    /// The gradient of a weighted sum of the torques.
    TorqueGradient = "torque_gradient": [InverseDynamicsGradient fixed::TORQUE_GRADIENT] [];
    /// The second derivatives of this sum.
    TorqueHessian = "torque_hessian": [InverseDynamicsHessian fixed::TORQUE_HESSIAN] [];
    /// The wrench at each joint.
    JointWrenches = "joint_wrenches": [JointWrenches fixed::JOINT_WRENCHES] [];
    /// The momentum of the joints and its rate.
    MomentumAndRate = "momentum_and_rate": [MomentumObserver fixed::MOMENTUM_AND_RATE] [];
    /// Torques of a wrench at the tip.
    WrenchTorques = "wrench_torques": [Kinematics fixed::WRENCH_TORQUES] [];
    /// Torques of motors.
    ActuatorTorques = "actuator_torques": [Actuation fixed::ACTUATOR_TORQUES] [];
    /// A step of the semi-implicit Euler method.
    EulerStep = "euler_step": [EulerStep fixed::EULER_STEP] [FloatingEulerStep floating::EULER_STEP];
    /// The derivatives of this step.
    EulerStepDerivatives = "euler_step_derivatives":
        [EulerStepDerivatives fixed::EULER_STEP_DERIVATIVES]
        [FloatingEulerStepDerivatives floating::EULER_STEP_DERIVATIVES];
    /// The momentum about the centre of mass.
    CentroidalMomentum = "centroidal_momentum": [] [CentroidalMomentum floating::CENTROIDAL_MOMENTUM];
    /// The matrix from velocities to this momentum.
    CentroidalMomentumMatrix = "centroidal_momentum_matrix":
        [] [CentroidalMomentum floating::CENTROIDAL_MOMENTUM_MATRIX];
    /// The rate of this momentum where nothing accelerates.
    CentroidalBias = "centroidal_bias": [] [CentroidalMomentum floating::CENTROIDAL_BIAS];
    /// A Newton step towards closed loops.
    ClosureStep = "closure_step": [ClosedLoops fixed::CLOSURE_STEP] [];
    /// The matrix G from velocities to those of the dependent joints.
    LoopMap = "loop_map": [ClosedLoops fixed::LOOP_MAP] [];
    /// Ġ q̇.
    LoopMapRateTimesVelocity = "loop_map_rate_times_velocity": [ClosedLoops fixed::LOOP_MAP_RATE_TIMES_VELOCITY] [];
}
