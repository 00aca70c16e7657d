//! What a robot can compute: one derive and one trait each.

use crate::function::Function;

/// What a robot can compute, named as the trait that a struct derives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Capability {
    /// Torques from motion.
    InverseDynamics,
    /// M(q).
    MassMatrix,
    /// C(q, q̇).
    CoriolisMatrix,
    /// Motion from torques.
    ForwardDynamics,
    /// Poses and Jacobian.
    Kinematics,
    /// Kinetic and potential.
    Energy,
    /// Torques per inertial parameter.
    Regressor,
    /// ∂τ/∂q and ∂τ/∂q̇.
    InverseDynamicsDerivatives,
    /// Bearing loads.
    JointWrenches,
    /// Torques on a base that moves.
    MovingBase,
    /// Rotors, gears, friction.
    Actuation,
}

impl Capability {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::InverseDynamics,
        Self::MassMatrix,
        Self::CoriolisMatrix,
        Self::ForwardDynamics,
        Self::Kinematics,
        Self::Energy,
        Self::Regressor,
        Self::InverseDynamicsDerivatives,
        Self::JointWrenches,
        Self::MovingBase,
        Self::Actuation,
    ];

    /// The name of its trait.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::InverseDynamics => "InverseDynamics",
            Self::MassMatrix => "MassMatrix",
            Self::CoriolisMatrix => "CoriolisMatrix",
            Self::ForwardDynamics => "ForwardDynamics",
            Self::Kinematics => "Kinematics",
            Self::Energy => "Energy",
            Self::Regressor => "Regressor",
            Self::InverseDynamicsDerivatives => "InverseDynamicsDerivatives",
            Self::JointWrenches => "JointWrenches",
            Self::MovingBase => "MovingBase",
            Self::Actuation => "Actuation",
        }
    }

    /// The methods of its trait.
    #[must_use]
    pub const fn functions(self) -> &'static [Function] {
        match self {
            Self::InverseDynamics => &Function::TORQUES,
            Self::MassMatrix => &[Function::MassMatrix],
            Self::CoriolisMatrix => &[Function::CoriolisMatrix],
            Self::ForwardDynamics => &[Function::ForwardDynamics],
            Self::Kinematics => &[
                Function::ForwardKinematics,
                Function::LinkPoses,
                Function::Jacobian,
                Function::JacobianRateTimesVelocity,
            ],
            Self::Energy => &[Function::KineticEnergy, Function::PotentialEnergy],
            Self::Regressor => &[Function::Regressor],
            Self::InverseDynamicsDerivatives => &[Function::InverseDynamicsDerivatives],
            Self::JointWrenches => &[Function::JointWrenches],
            Self::MovingBase => &[Function::InverseDynamicsOnMovingBase],
            Self::Actuation => &[Function::ActuatorTorques],
        }
    }
}
