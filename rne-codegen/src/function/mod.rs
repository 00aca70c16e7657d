//! The functions of a robot that can be compiled, and the forms they can take.

mod capability;
mod layout;

use std::fmt;
use std::str::FromStr;

pub use capability::Capability;
pub use layout::{Layout, Record};

/// A function of a robot, named as its trait method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Function {
    /// τ(q, q̇, q̈).
    InverseDynamics,
    /// τ(q, q̇, q̈) when the last link exerts a wrench on its environment.
    InverseDynamicsWithWrench,
    /// τ(q, q̇, q̈) from the sines and cosines of the positions.
    InverseDynamicsSc,
    /// τ(q, 0, 0).
    GravityTorques,
    /// τ(q, q̇, 0).
    BiasTorques,
    /// M(q).
    MassMatrix,
    /// C(q, q̇).
    CoriolisMatrix,
    /// q̈(q, q̇, τ).
    ForwardDynamics,
    /// The tip in the world.
    ForwardKinematics,
    /// The frame of every link in the world.
    LinkPoses,
    /// J(q) of the tip.
    Jacobian,
    /// J̇ q̇ of the tip.
    JacobianRateTimesVelocity,
    /// T(q, q̇).
    KineticEnergy,
    /// V(q).
    PotentialEnergy,
    /// Y(q, q̇, q̈), torques per inertial parameter.
    Regressor,
    /// ∂τ/∂q and ∂τ/∂q̇.
    InverseDynamicsDerivatives,
    /// f_{i-1,i} and n_{i-1,i} of every joint.
    JointWrenches,
    /// τ(q, q̇, q̈) on a base that moves.
    InverseDynamicsOnMovingBase,
    /// What the motors add.
    ActuatorTorques,
}

/// An argument of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Sines of the joint positions.
    Sines,
    /// Cosines of the joint positions.
    Cosines,
    /// Joint positions.
    Positions,
    /// Joint rates.
    Rates,
    /// Joint accelerations.
    Accelerations,
    /// Joint torques.
    Torques,
    /// Force and moment at the tip.
    Wrench,
    /// Motion of the base, and gravity.
    Base,
}

impl Function {
    /// All functions, in the order of the traits.
    pub const ALL: [Self; 19] = [
        Self::InverseDynamics,
        Self::InverseDynamicsWithWrench,
        Self::InverseDynamicsSc,
        Self::GravityTorques,
        Self::BiasTorques,
        Self::MassMatrix,
        Self::CoriolisMatrix,
        Self::ForwardDynamics,
        Self::ForwardKinematics,
        Self::LinkPoses,
        Self::Jacobian,
        Self::JacobianRateTimesVelocity,
        Self::KineticEnergy,
        Self::PotentialEnergy,
        Self::Regressor,
        Self::InverseDynamicsDerivatives,
        Self::JointWrenches,
        Self::InverseDynamicsOnMovingBase,
        Self::ActuatorTorques,
    ];

    /// Those of the trait `InverseDynamics`: torques of an arm whose base stands still.
    pub const TORQUES: [Self; 5] = [
        Self::InverseDynamics,
        Self::InverseDynamicsWithWrench,
        Self::InverseDynamicsSc,
        Self::GravityTorques,
        Self::BiasTorques,
    ];

    /// The name of its trait method.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::InverseDynamics => "inverse_dynamics",
            Self::InverseDynamicsWithWrench => "inverse_dynamics_with_wrench",
            Self::InverseDynamicsSc => "inverse_dynamics_sc",
            Self::GravityTorques => "gravity_torques",
            Self::BiasTorques => "bias_torques",
            Self::MassMatrix => "mass_matrix",
            Self::CoriolisMatrix => "coriolis_matrix",
            Self::ForwardDynamics => "forward_dynamics",
            Self::ForwardKinematics => "forward_kinematics",
            Self::LinkPoses => "link_poses",
            Self::Jacobian => "jacobian",
            Self::JacobianRateTimesVelocity => "jacobian_rate_times_velocity",
            Self::KineticEnergy => "kinetic_energy",
            Self::PotentialEnergy => "potential_energy",
            Self::Regressor => "regressor",
            Self::InverseDynamicsDerivatives => "inverse_dynamics_derivatives",
            Self::JointWrenches => "joint_wrenches",
            Self::InverseDynamicsOnMovingBase => "inverse_dynamics_on_moving_base",
            Self::ActuatorTorques => "actuator_torques",
        }
    }

    /// What it computes, for the first line of its documentation.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        match self {
            Self::InverseDynamics => {
                "Torques for positions `q`, velocities `qd` and accelerations `qdd`, with a free tip."
            }
            Self::InverseDynamicsWithWrench => {
                "Torques when the last link exerts a force and a moment on its environment, at the tip, in tip axes."
            }
            Self::InverseDynamicsSc => {
                "Torques from the sines and cosines of the joint positions; `q` is used for prismatic joints alone."
            }
            Self::GravityTorques => "Torques that hold the arm still against gravity, τ(q, 0, 0).",
            Self::BiasTorques => "Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).",
            Self::MassMatrix => {
                "The mass matrix M(q), symmetric: column j holds the torques for q̈ = e_j of an arm at rest."
            }
            Self::CoriolisMatrix => {
                "The Coriolis matrix C(q, q̇) of Christoffel: Ṁ - 2C is skew, and C = ½ ∂(bias torques)/∂q̇."
            }
            Self::ForwardDynamics => {
                "Accelerations for positions `q`, velocities `qd` and torques `tau`, with a free tip."
            }
            Self::ForwardKinematics => "The tip in the world, base and tool included.",
            Self::LinkPoses => "The frame of every row of the table in the world.",
            Self::Jacobian => {
                "The geometric Jacobian of the tip in world axes: three linear rows, then three angular ones."
            }
            Self::JacobianRateTimesVelocity => {
                "J̇ q̇: the acceleration of the tip in world axes when q̈ = 0, linear, then angular."
            }
            Self::KineticEnergy => "Kinetic energy, J.",
            Self::PotentialEnergy => "Potential energy in gravity, J; zero where a mass is at the origin of frame 0.",
            Self::Regressor => {
                "Torques per inertial parameter: joint, link, (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz)."
            }
            Self::InverseDynamicsDerivatives => "∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics`; row i is torque i.",
            Self::JointWrenches => {
                "Force and moment that link i-1 exerts on link i, at joint i, in axes fixed to link i."
            }
            Self::InverseDynamicsOnMovingBase => {
                "Torques on a base that moves as told, under gravity as told, with a free tip."
            }
            Self::ActuatorTorques => "What rotors behind gears and friction add to the torques.",
        }
    }

    /// Its arguments, in order.
    #[must_use]
    pub const fn arguments(self) -> &'static [Argument] {
        use Argument::{Accelerations, Base, Cosines, Positions, Rates, Sines, Torques, Wrench};
        match self {
            Self::InverseDynamics | Self::Regressor | Self::InverseDynamicsDerivatives | Self::JointWrenches => {
                &[Positions, Rates, Accelerations]
            }
            Self::InverseDynamicsWithWrench => &[Positions, Rates, Accelerations, Wrench],
            Self::InverseDynamicsSc => &[Sines, Cosines, Positions, Rates, Accelerations],
            Self::GravityTorques
            | Self::MassMatrix
            | Self::ForwardKinematics
            | Self::LinkPoses
            | Self::Jacobian
            | Self::PotentialEnergy => &[Positions],
            Self::BiasTorques | Self::CoriolisMatrix | Self::JacobianRateTimesVelocity | Self::KineticEnergy => {
                &[Positions, Rates]
            }
            Self::ForwardDynamics => &[Positions, Rates, Torques],
            Self::InverseDynamicsOnMovingBase => &[Positions, Rates, Accelerations, Base],
            Self::ActuatorTorques => &[Rates, Accelerations],
        }
    }

    /// Whether it has an argument.
    #[must_use]
    pub fn takes(self, argument: Argument) -> bool {
        self.arguments().contains(&argument)
    }

    /// Whether what it returns are the torques of the joints.
    #[must_use]
    pub const fn returns_torques(self) -> bool {
        matches!(
            self,
            Self::InverseDynamics
                | Self::InverseDynamicsWithWrench
                | Self::InverseDynamicsSc
                | Self::GravityTorques
                | Self::BiasTorques
                | Self::InverseDynamicsOnMovingBase
        )
    }

    /// The shape of what it returns for so many joints.
    #[must_use]
    pub fn layout(self, dof: usize) -> Layout {
        let array = |length, of: &Layout| Layout::Array(length, Box::new(of.clone()));
        let vector = array(dof, &Layout::Number);
        let matrix = array(dof, &vector);
        let triple = array(3, &Layout::Number);
        let pose = Layout::Record(Record::Pose, vec![array(3, &triple), triple.clone()]);
        match self {
            Self::InverseDynamics
            | Self::InverseDynamicsWithWrench
            | Self::InverseDynamicsSc
            | Self::GravityTorques
            | Self::BiasTorques
            | Self::ForwardDynamics
            | Self::InverseDynamicsOnMovingBase
            | Self::ActuatorTorques => vector,
            Self::MassMatrix | Self::CoriolisMatrix => matrix,
            Self::ForwardKinematics => pose,
            Self::LinkPoses => array(dof, &pose),
            Self::Jacobian => array(6, &vector),
            Self::JacobianRateTimesVelocity => array(6, &Layout::Number),
            Self::KineticEnergy | Self::PotentialEnergy => Layout::Number,
            Self::Regressor => array(dof, &array(dof, &array(10, &Layout::Number))),
            Self::InverseDynamicsDerivatives => Layout::Record(Record::TorqueDerivatives, vec![matrix.clone(), matrix]),
            Self::JointWrenches => array(dof, &Layout::Record(Record::Wrench, vec![triple.clone(), triple])),
        }
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Function {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        Self::ALL.into_iter().find(|function| function.name() == text).ok_or_else(|| UnknownName {
            found: text.to_owned(),
            what: "function",
            allowed: Self::ALL.iter().map(|function| function.name()).collect(),
        })
    }
}

/// How a function is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Form {
    /// The seven steps: every intermediate is the lecture's.
    #[default]
    SevenSteps,
    /// Fewest operations: only the torques keep a physical meaning.
    Reduced,
    /// The reduced form after algebraic rewriting, which no longer resembles a recursion. `inverse_dynamics` alone is
    /// rewritten, and only where a plan file holds the result.
    Rewritten,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 3] = [Self::SevenSteps, Self::Reduced, Self::Rewritten];

    /// Its name in the attribute and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SevenSteps => "seven_steps",
            Self::Reduced => "reduced",
            Self::Rewritten => "rewritten",
        }
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Form {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        Self::ALL.into_iter().find(|form| form.name() == text).ok_or_else(|| UnknownName {
            found: text.to_owned(),
            what: "form",
            allowed: Self::ALL.iter().map(|form| form.name()).collect(),
        })
    }
}

/// A name that is none of those allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    found: String,
    what: &'static str,
    allowed: Vec<&'static str>,
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let allowed: Vec<String> = self.allowed.iter().map(|name| format!("`{name}`")).collect();
        write!(f, "`{}` is no {}; there are {}", self.found, self.what, allowed.join(", "))
    }
}

impl std::error::Error for UnknownName {}
