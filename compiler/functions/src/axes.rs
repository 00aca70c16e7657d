//! The parts of a function's name: its result, the base, the load, and whether there are closed loops.

use crate::{Argument, named};

named! {
    /// The result of a function, whatever the base, the load and the loops of the robot.
    What {
        /// Torques from motion.
        InverseDynamics = "inverse_dynamics",
        /// Torques from motion, with the sines and cosines of the positions as arguments.
        InverseDynamicsFromSinCos = "inverse_dynamics_from_sin_cos",
        /// Torques that hold the robot still.
        GravityTorques = "gravity_torques",
        /// Torques where nothing accelerates.
        BiasTorques = "bias_torques",
        /// C(q, q̇) q̇: torques where nothing accelerates or weighs.
        CoriolisTorques = "coriolis_torques",
        /// M(q).
        MassMatrix = "mass_matrix",
        /// M(q)⁻¹.
        InverseMassMatrix = "inverse_mass_matrix",
        /// M(q)⁻¹ τ.
        InverseMassMatrixTimesTorques = "inverse_mass_matrix_times_torques",
        /// C(q, q̇).
        CoriolisMatrix = "coriolis_matrix",
        /// Accelerations from torques.
        ForwardDynamics = "forward_dynamics",
        /// Accelerations from torques while contacts hold some of the tips.
        ForwardDynamicsInContact = "forward_dynamics_in_contact",
        /// The pose of the tip.
        ForwardKinematics = "forward_kinematics",
        /// The poses of all links.
        LinkPoses = "link_poses",
        /// The Jacobian J of the tip.
        Jacobian = "jacobian",
        /// J̇.
        JacobianRate = "jacobian_rate",
        /// J̇ q̇.
        JacobianRateTimesVelocity = "jacobian_rate_times_velocity",
        /// ∂J/∂q.
        JacobianDerivatives = "jacobian_derivatives",
        /// The Jacobian of each tip.
        TipJacobians = "tip_jacobians",
        /// The acceleration of each tip where nothing accelerates.
        TipAccelerations = "tip_accelerations",
        /// Kinetic energy.
        KineticEnergy = "kinetic_energy",
        /// Potential energy.
        PotentialEnergy = "potential_energy",
        /// The centre of mass.
        CentreOfMass = "centre_of_mass",
        /// The Jacobian of the centre of mass.
        CentreOfMassJacobian = "centre_of_mass_jacobian",
        /// Torques per inertial parameter.
        Regressor = "regressor",
        /// Derivatives of the torques.
        InverseDynamicsDerivatives = "inverse_dynamics_derivatives",
        /// Derivatives of the accelerations.
        ForwardDynamicsDerivatives = "forward_dynamics_derivatives",
        /// The gradient of a weighted sum of the torques.
        TorqueGradient = "torque_gradient",
        /// The second derivatives of this sum.
        TorqueHessian = "torque_hessian",
        /// The wrench at each joint.
        JointWrenches = "joint_wrenches",
        /// The momentum of the joints and its rate.
        MomentumAndRate = "momentum_and_rate",
        /// Torques of a wrench at the tip.
        WrenchTorques = "wrench_torques",
        /// Torques of motors.
        ActuatorTorques = "actuator_torques",
        /// A step of the semi-implicit Euler method.
        EulerStep = "euler_step",
        /// The derivatives of this step.
        EulerStepDerivatives = "euler_step_derivatives",
        /// The momentum about the centre of mass.
        CentroidalMomentum = "centroidal_momentum",
        /// The matrix from velocities to this momentum.
        CentroidalMomentumMatrix = "centroidal_momentum_matrix",
        /// The rate of this momentum where nothing accelerates.
        CentroidalBias = "centroidal_bias",
        /// A Newton step towards closed loops.
        ClosureStep = "closure_step",
        /// The matrix G from velocities to those of the dependent joints.
        LoopMap = "loop_map",
        /// Ġ q̇.
        LoopMapRateTimesVelocity = "loop_map_rate_times_velocity",
    }
}

/// The base of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// It stands still.
    Held,
    /// Something else moves it.
    Moving,
    /// It moves freely.
    Floating,
}

/// The load of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// Nothing.
    Free,
    /// The last link exerts a wrench at the tip.
    Wrench,
    /// The robot exerts a wrench at each tip.
    Wrenches,
    /// A payload is fixed to the tip.
    Payload,
}

/// The parts of a function's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    /// Its result.
    pub what: What,
    /// The base.
    pub base: Base,
    /// The load.
    pub load: Load,
    /// Whether the robot has closed loops.
    pub loops: bool,
}

impl Axes {
    /// The parts for a robot whose base stands still, without a load and without closed loops.
    #[must_use]
    pub const fn of(what: What) -> Self {
        Self { what, base: Base::Held, load: Load::Free, loops: false }
    }

    /// With a floating base.
    #[must_use]
    pub const fn floating(self) -> Self {
        Self { base: Base::Floating, ..self }
    }

    /// On a base that something else moves.
    #[must_use]
    pub const fn moving(self) -> Self {
        Self { base: Base::Moving, ..self }
    }

    /// With a wrench at the tip.
    #[must_use]
    pub const fn with_wrench(self) -> Self {
        Self { load: Load::Wrench, ..self }
    }

    /// With a wrench at each tip.
    #[must_use]
    pub const fn with_wrenches(self) -> Self {
        Self { load: Load::Wrenches, ..self }
    }

    /// With a payload at the tip.
    #[must_use]
    pub const fn with_payload(self) -> Self {
        Self { load: Load::Payload, ..self }
    }

    /// For a robot with closed loops.
    #[must_use]
    pub const fn of_loops(self) -> Self {
        Self { loops: true, ..self }
    }
}

impl Load {
    /// Its argument.
    #[must_use]
    pub const fn argument(self) -> Option<Argument> {
        match self {
            Self::Free => None,
            Self::Wrench => Some(Argument::Wrench),
            Self::Wrenches => Some(Argument::Wrenches),
            Self::Payload => Some(Argument::Payload),
        }
    }
}
