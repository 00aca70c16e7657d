//! The arguments of functions, and the arrays that they are passed in.

use crate::{Length, Sizes};

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
    /// Mass, centre of mass and inertia of what is fixed to the tip.
    Payload,
    /// Motion of the base, and gravity.
    Base,
    /// Force and moment at each tip.
    Wrenches,
    /// Angular velocity of a base whose accelerations are no argument.
    BaseVelocity,
    /// Linear and angular velocity of a floating base.
    BaseTwist,
    /// Where such a base stands in the world.
    BasePose,
    /// Axes of the base in the world.
    BaseRotation,
    /// Positions of the dependent joints of closed loops.
    Passive,
    /// Multipliers of the joint torques.
    Multipliers,
    /// Duration of a step: one number, which is passed by value.
    Step,
}

/// An array that an argument, or a part of it, is passed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArgumentPart {
    /// The argument.
    pub argument: Argument,
    /// The name of the array in emitted code and at run time: `q`, `qd`, `force`, ….
    pub name: &'static str,
    /// How many numbers it has for a state, or for a tip.
    pub length: Length,
}

/// Every array: its name, its argument, its length, its quantity, and what it is with its unit. `$callback!` is given
/// the list.
#[macro_export]
macro_rules! argument_parts {
    ($callback:ident) => { $callback! {
        q: Positions, Joints, Position, "Joint positions, rad or m.";
        qd: Rates, Joints, Rate, "Joint velocities, rad/s or m/s.";
        qdd: Accelerations, Joints, RateDot, "Joint accelerations, rad/s² or m/s².";
        passive: Passive, Passive, Position,
            "Positions of the dependent joints of the closed loops, rad or m, in the order of the joints.";
        tau: Torques, Joints, AppliedTorque, "Joint torques, N m or N.";
        multipliers: Multipliers, Joints, Multiplier, "Multipliers of the joint torques, in any unit.";
        step: Step, Fixed(1), Duration, "Duration of the step, s: one number.";
        sin: Sines, Joints, Sine, "Sines of the joint positions.";
        cos: Cosines, Joints, Cosine, "Cosines of the joint positions.";
        force: Wrench, Fixed(3), JointForce,
            "Force that the last link exerts at the tip, in tip axes, N: three elements.";
        moment: Wrench, Fixed(3), JointMoment,
            "Moment that it exerts about the origin of the tip frame, N m: three elements.";
        payload: Payload, Fixed(10), Mass,
            "What is fixed to the tip: mass, kg; centre of mass x, y, z, m; inertia about it xx, yy, zz, xy, xz, yz, \
             kg m²: ten elements, in tip axes.";
        base_omega: Base, Fixed(3), Omega,
            "Angular velocity of the base, rad/s, in the axes of frame 0: three elements.";
        base_omega_dot: Base, Fixed(3), OmegaDot, "Angular acceleration of the base, rad/s²: three elements.";
        base_acceleration: Base, Fixed(3), Acceleration,
            "Acceleration of the base, gravity not included, m/s²: three elements.";
        base_gravity: Base, Fixed(3), Gravity,
            "Acceleration of gravity, m/s², pointing down: three elements.";
        wrenches: Wrenches, Fixed(6), TipForce,
            "Force, N, and moment, N m, that the robot exerts at each tip, in axes of the tip: six elements for each \
             tip.";
        omega: BaseVelocity, Fixed(3), Omega,
            "Angular velocity of a base that nothing holds, rad/s, in the axes of frame 0: three elements.";
        twist: BaseTwist, Fixed(6), OriginVelocity,
            "Velocity of the origin of frame 0, m/s, and angular velocity of a base that nothing holds, rad/s, in the \
             axes of frame 0: six elements.";
        pose: BasePose, Fixed(12), FrameOrigin,
            "Pose of frame 0 in the world: rows of the rotation, then the origin, m: twelve elements.";
        base_rotation: BaseRotation, Fixed(9), BaseRotation,
            "Rotation of the base: its columns are the axes of frame 0 in the world; three rows of three elements.";
    } };
}

macro_rules! parts {
    ($(
        $name:ident: $argument:ident, $length:ident $(($elements:literal))?, $quantity:ident, $about:literal;
    )*) => {
        /// All of them, those of an argument beside each other.
        const PARTS: &[ArgumentPart] = &[$(ArgumentPart {
            argument: Argument::$argument,
            name: stringify!($name),
            length: Length::$length $(($elements))?,
        }),*];
    };
}

argument_parts!(parts);

impl Argument {
    /// The arrays that it is passed in, in order.
    pub fn parts(self) -> impl Iterator<Item = &'static ArgumentPart> {
        PARTS.iter().filter(move |part| part.argument == self)
    }

    /// Whether it has a row of numbers for each tip.
    #[must_use]
    pub const fn is_of_each_tip(self) -> bool {
        matches!(self, Self::Wrenches)
    }

    /// Whether it is one number, which is passed by itself and not in an array.
    #[must_use]
    pub const fn is_number(self) -> bool {
        matches!(self, Self::Step)
    }

    /// How many elements each row of its array has, if that is an array of rows.
    #[must_use]
    pub const fn row(self) -> Option<usize> {
        match self {
            Self::Wrenches => Some(6),
            Self::BaseRotation => Some(3),
            _ => None,
        }
    }

    /// Numbers that it has for a state of a robot.
    #[must_use]
    pub fn elements(self, sizes: Sizes) -> usize {
        let of_one: usize = self.parts().map(|part| part.length.of(sizes)).sum();
        if self.is_of_each_tip() { sizes.tips * of_one } else { of_one }
    }
}
