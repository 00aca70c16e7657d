//! The capabilities of a robot: each is a trait that a struct derives.

use crate::named;
use crate::{Function, Length};

/// Every capability: the trait, after `of` the robots that alone have it, what a derive of it says, and more about it.
/// `$callback!` is given the list.
#[macro_export]
#[rustfmt::skip]
macro_rules! capabilities {
    ($callback:ident) => {
        $callback! {
            InverseDynamics: "torques from motion.";
            MassMatrix: "the mass matrix M(q).",
                "Symmetric by construction: each element off the diagonal is computed once.";
            CoriolisMatrix: "the Coriolis matrix C(q, q̇) of Christoffel.",
                "Ṁ - 2C is skew.";
            ForwardDynamics: "accelerations from torques.",
                "A singular mass matrix gives numbers that are not finite, never a panic.";
            Kinematics: "tip pose, link poses, Jacobian, J̇ q̇ and torques of a wrench.",
                "`base` and `tool` of the robot file included.";
            Energy: "kinetic and potential energy.",
                "Links alone, without rotors.";
            CentreOfMass: "the centre of mass of the whole arm, and its Jacobian.",
                "In the world, `base` of the robot file included. Links alone, without rotors.";
            Regressor: "torques per inertial parameter, τ = Y π.",
                "Ten parameters per link; the masses of the file have no part in it.";
            InverseDynamicsDerivatives: "∂τ/∂q and ∂τ/∂q̇.",
                "In the seven steps by the product rule on the graph of the torques, which they share; in the reduced \
                 form that or composite bodies, whatever takes fewer operations.";
            JointWrenches: "the force and moment that each link exerts on the next.",
                "Bearing loads; always in the seven steps, whose forces have a meaning.";
            MomentumObserver:
                "the momentum of the joints and its rate, from which `ObserverState` makes external torques without \
                 accelerations.",
                "In the reduced form by the recursion of the torques, with velocities in the place of accelerations.";
            MovingBase: "torques on a base that moves.",
                "Its motion (ω₀, ω̇₀, c̈₀) and gravity are arguments.";
            Actuation: "what rotors behind gears and friction add to the torques.",
                "The robot file needs a `motor` at one joint at least.";
            PayloadDynamics:
                "gravity, bias, mass matrix, accelerations, momenta, and derivatives of torques and accelerations, of \
                 the arm with a payload at its tip.",
                "The payload (mass, centre of mass, inertia) is an argument.";
            TipWrenches of tips: "torques and accelerations of a robot with a wrench at each tip.",
                "The tips are the frames of the list `tips` of the robot file; without the list, the tip frame is the \
                 only tip. The struct gets the names of the tips, `TIPS`, and an enum of the tips: for `struct \
                 Torso;` it is `TorsoTip`.";
            FloatingBase of floating_bases: "the torques of a robot with a floating base, and the wrench that must act on the base.",
                "The base is the link `floating_base` of the robot file; a file without that key is an error, unless \
                 the attribute has `allow_lints`: then the base has no mass. The tips are those of \
                 [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the tips.";
            CentroidalMomentum of floating_bases:
                "the momentum of a robot with a floating base, about its centre of mass, and its rate.",
                "The base is the link `floating_base` of the robot file; a file without that key is an error, unless \
                 the attribute has `allow_lints`: then the base has no mass.";
            FloatingRegressor of floating_bases:
                "the wrench on a floating base and the torques per inertial parameter of the base and of each link.",
                "The base is frame 0, whether or not the robot file has a `floating_base`: no inertial parameter \
                 enters.";
            FloatingEnergy of floating_bases: "kinetic and potential energy with a floating base.",
                "The base is the link `floating_base` of the robot file; a file without that key is an error, unless \
                 the attribute has `allow_lints`: then the base has no mass.";
            FloatingKinematics of floating_bases: "Jacobians and accelerations of the tips of a robot with a floating base.",
                "The tips are those of [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the \
                 tips.";
            ContactDynamics of floating_bases: "the motion of a robot with a floating base while contacts hold some of its tips.",
                "The contacts are those of the list `contacts` of the robot file. The tips are those of \
                 [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the tips.";
            FloatingInverseDynamicsDerivatives of floating_bases: "the derivatives of the wrench on a floating base and of the torques.",
                "The tips are those of [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the \
                 tips.";
            ClosedLoops of loops: "a robot whose file has `loops` with a cut joint.",
                "The tips are the frames of the list `tips` of the robot file in its order, or the tip frame alone. \
                 Other derives refuse such a robot; so the constants `DOF`, `NAME`, `JOINT_NAMES` and the limits come \
                 with this one, beside `PASSIVE`, `EQUATIONS` and `PASSIVE_NAMES`.";
            FloatingClosedLoops of loops: "a robot with closed loops with a floating base.",
                "It belongs beside [`ClosedLoops`](macro@ClosedLoops), whose functions close the loops, and with \
                 which `DOF`, `PASSIVE`, names and limits come. The tips are the same.";
            InverseDynamicsGradient: "the derivatives of a weighted sum of the torques.";
            ForwardDynamicsDerivatives: "the derivatives of the accelerations by positions, velocities and torques.";
            JacobianDerivatives: "the rate of the Jacobian, and its derivatives by the positions.";
            InverseDynamicsHessian: "the second derivatives of a weighted sum of the torques.";
            EulerStep:
                "a step of the semi-implicit Euler method, in the operations of the accelerations and four more for \
                 each joint.";
            EulerStepDerivatives:
                "the derivatives of a step of the semi-implicit Euler method by positions, velocities and torques.";
            FloatingEulerStep of floating_bases: "a step of the semi-implicit Euler method with a floating base.",
                "The base is the link `floating_base` of the robot file; a file without that key is an error, unless \
                 the attribute has `allow_lints`: then the base has no mass. The tips are those of `FloatingBase`.";
            FloatingEulerStepDerivatives of floating_bases:
                "the derivatives of a step of the semi-implicit Euler method with a floating base.",
                "The base and the tips are those of `FloatingEulerStep`.";
            FloatingPayloadDynamics of floating_bases:
                "torques, mass matrix, bias and accelerations of a robot with a floating base and a payload that is \
                 known when the program runs.",
                "The base is the link `floating_base` of the robot file; a file without that key is an error, unless \
                 the attribute has `allow_lints`: then the base has no mass.";
            ClosedLoopsPayloadDynamics of loops:
                "torques, gravity, bias, mass matrix and accelerations of a robot with closed loops and a payload that \
                 is known when the program runs.",
                "It belongs beside [`ClosedLoops`](macro@ClosedLoops), whose functions close the loops. The payload \
                 (mass, centre of mass, inertia) is at the tip.";
        }
    };
}

macro_rules! capability {
    ($($capability:ident $(of $robots:ident)?: $summary:literal $(, $details:literal)?;)*) => {
        named! {
            /// A capability of a robot, named as the trait that a struct derives.
            Capability { $(#[doc = $summary] $capability = stringify!($capability)),* }
        }
    };
}
capabilities!(capability);

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
