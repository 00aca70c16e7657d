//! The capabilities of a robot: each is a trait that a struct derives.

use crate::named;
use crate::{Function, Length};

named! {
    /// A capability of a robot, named as the trait that a struct derives.
    Capability {
        /// Torques from motion.
        InverseDynamics = "InverseDynamics",
        /// M(q).
        MassMatrix = "MassMatrix",
        /// C(q, q̇).
        CoriolisMatrix = "CoriolisMatrix",
        /// Motion from torques.
        ForwardDynamics = "ForwardDynamics",
        /// Poses and Jacobian.
        Kinematics = "Kinematics",
        /// Kinetic and potential.
        Energy = "Energy",
        /// The centre of mass of the arm.
        CentreOfMass = "CentreOfMass",
        /// Torques per inertial parameter.
        Regressor = "Regressor",
        /// ∂τ/∂q and ∂τ/∂q̇.
        InverseDynamicsDerivatives = "InverseDynamicsDerivatives",
        /// Bearing loads.
        JointWrenches = "JointWrenches",
        /// External torques without accelerations.
        MomentumObserver = "MomentumObserver",
        /// Torques on a base that moves.
        MovingBase = "MovingBase",
        /// Rotors, gears, friction.
        Actuation = "Actuation",
        /// The arm with a payload that is known when the program runs.
        PayloadDynamics = "PayloadDynamics",
        /// The arm with a wrench at each named tip.
        TipWrenches = "TipWrenches",
        /// The robot whose base nothing holds.
        FloatingBase = "FloatingBase",
        /// Its momentum about its centre of mass.
        CentroidalMomentum = "CentroidalMomentum",
        /// Wrench on the base and torques per inertial parameter, where nothing holds the base.
        FloatingRegressor = "FloatingRegressor",
        /// Kinetic and potential, where nothing holds the base.
        FloatingEnergy = "FloatingEnergy",
        /// Jacobians and accelerations of its tips.
        FloatingKinematics = "FloatingKinematics",
        /// The robot while contacts hold some of its tips.
        ContactDynamics = "ContactDynamics",
        /// Derivatives of the torques and of the wrench on a floating base.
        FloatingInverseDynamicsDerivatives = "FloatingInverseDynamicsDerivatives",
        /// The robot with closed loops.
        ClosedLoops = "ClosedLoops",
        /// The robot with closed loops whose base nothing holds.
        FloatingClosedLoops = "FloatingClosedLoops",
        /// Gradient of a weighted sum of the torques.
        InverseDynamicsGradient = "InverseDynamicsGradient",
        /// Derivatives of the motion from torques.
        ForwardDynamicsDerivatives = "ForwardDynamicsDerivatives",
        /// How the Jacobian changes.
        JacobianDerivatives = "JacobianDerivatives",
        /// Second derivatives of a weighted sum of the torques.
        InverseDynamicsHessian = "InverseDynamicsHessian",
        /// A step of the semi-implicit Euler method.
        EulerStep = "EulerStep",
        /// Its derivatives.
        EulerStepDerivatives = "EulerStepDerivatives",
        /// A step of this method where nothing holds the base.
        FloatingEulerStep = "FloatingEulerStep",
        /// The derivatives of this step.
        FloatingEulerStepDerivatives = "FloatingEulerStepDerivatives",
        /// The robot with a floating base and a payload that is known when the program runs.
        FloatingPayloadDynamics = "FloatingPayloadDynamics",
    }
}

impl Capability {
    /// The methods of its trait.
    pub fn functions(self) -> impl Iterator<Item = Function> {
        Function::ALL.into_iter().filter(move |function| function.capability() == self)
    }

    /// The lengths of arrays that its trait has as parameters, in their order.
    pub fn lengths(self) -> impl Iterator<Item = Length> {
        use Length::{Bodies, Equations, Joints, Passive, Tips, Velocities};
        let has = move |length| self.functions().any(|function| function.has(length));
        // a controller of the whole body uses these functions together
        let is_whole = move |length| length == Velocities && self == Self::ContactDynamics;
        let order = [Joints, Passive, Equations, Velocities, Bodies, Tips];
        order.into_iter().filter(move |&length| length == Joints || has(length) || is_whole(length))
    }
}
