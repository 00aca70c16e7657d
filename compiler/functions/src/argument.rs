//! The arguments of functions, and the arrays that they are passed in.

use crate::layout::returned;
use crate::{Length, Shape, Sizes};

/// The arguments: variant, name, type where the number of joints is known at run time, with the lifetime `'a`, and
/// shape.
macro_rules! arguments {
    ($($(#[$doc:meta])* $argument:ident = $name:ident, ($($type:tt)*): $shape:ident;)*) => {
        /// An argument of a function.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Argument { $($(#[$doc])* $argument),* }

        impl Argument {
            /// Its name in Rust, in Python and on the command line.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$argument => stringify!($name)),* }
            }

            /// The shape of its numbers.
            #[must_use]
            pub const fn shape(self) -> &'static Shape {
                match self { $(Self::$argument => &returned::$shape),* }
            }
        }

        /// The type of an argument where the number of joints is known at run time; `T` is the number.
        #[doc(hidden)]
        #[macro_export]
        macro_rules! argument_type { $(($argument) => { $($type)* };)* }

        /// The names of all arguments, with their types. `$callback!` is given the list.
        #[doc(hidden)]
        #[macro_export]
        macro_rules! every_argument {
            ($callback:ident) => { $callback! { $($(#[$doc])* $name: ($($type)*);)* } };
        }
    };
}

arguments! {
    /// Sines of the joint positions.
    Sines = sin, (&'a [T]): Vector;
    /// Cosines of the joint positions.
    Cosines = cos, (&'a [T]): Vector;
    /// Joint positions, rad or m.
    Positions = q, (&'a [T]): Vector;
    /// Joint velocities, rad/s or m/s.
    Rates = qd, (&'a [T]): Vector;
    /// Joint accelerations, rad/s² or m/s².
    Accelerations = qdd, (&'a [T]): Vector;
    /// Joint torques, N m or N.
    Torques = tau, (&'a [T]): Vector;
    /// Force and moment that the last link exerts at the tip.
    Wrench = wrench, (&'a Wrench<T>): Wrench;
    /// Mass, centre of mass and inertia of what is fixed to the tip.
    Payload = payload, (&'a Payload<T>): Payload;
    /// Motion of the base, and gravity.
    Base = base, (&'a BaseMotion<T>): BaseMotion;
    /// Force and moment that the robot exerts at each tip.
    Wrenches = wrenches, (&'a [Wrench<T>]): TipWrenches;
    /// Angular velocity of a floating base, rad/s, in axes of frame 0.
    BaseVelocity = omega, (&'a [T; 3]): Point;
    /// Linear and angular velocity of a floating base.
    BaseTwist = twist, (&'a BaseTwist<T>): BaseTwist;
    /// Pose of a floating base in the world.
    BasePose = pose, (&'a Pose<T>): Pose;
    /// Rows of the rotation from axes of frame 0 to those of the world.
    BaseRotation = base_rotation, (&'a [[T; 3]; 3]): Rotation;
    /// Positions of the dependent joints of closed loops, rad or m.
    Passive = passive, (&'a [T]): PassiveVector;
    /// Multipliers of the joint torques.
    Multipliers = multipliers, (&'a [T]): Vector;
    /// Duration of a step, s: one number, which is passed by value.
    Step = step, (T): Number;
}

/// The part of a robot that the numbers of an array belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// Each joint.
    Joints,
    /// Each dependent joint of the closed loops.
    Passive,
    /// The base, or the robot as a whole.
    Base,
    /// The tip.
    Tip,
    /// Each tip.
    EachTip,
}

/// An array that an argument, or a part of it, is passed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArgumentPart {
    /// The argument.
    pub argument: Argument,
    /// The name of the array in emitted code and at run time: `q`, `qd`, `force`, ….
    pub name: &'static str,
    /// Its place among all arrays.
    pub place: usize,
    /// The part of the robot that its numbers belong to.
    pub owner: Owner,
    /// How many numbers it has for a state, or for a tip.
    pub length: Length,
}

impl ArgumentPart {
    /// How many numbers it has for a state of a robot.
    #[must_use]
    pub const fn elements(&self, sizes: Sizes) -> usize {
        let tips = if matches!(self.owner, Owner::EachTip) { sizes.tips } else { 1 };
        self.length.of(sizes) * tips
    }
}

/// Every array: its name, its argument, the part of the robot that its numbers belong to, their quantities with how
/// many numbers each has, and what it is with its unit. `$callback!` is given the list.
#[macro_export]
macro_rules! argument_parts {
    ($callback:ident) => { $callback! {
        q: Positions, Joints [Position * 1], "Joint positions, rad or m.";
        qd: Rates, Joints [Rate * 1], "Joint velocities, rad/s or m/s.";
        qdd: Accelerations, Joints [RateDot * 1], "Joint accelerations, rad/s² or m/s².";
        passive: Passive, Passive [Position * 1],
            "Positions of the dependent joints of the closed loops, rad or m, in the order of the joints.";
        tau: Torques, Joints [AppliedTorque * 1], "Joint torques, N m or N.";
        multipliers: Multipliers, Joints [Multiplier * 1], "Multipliers of the joint torques, in any unit.";
        step: Step, Base [Duration * 1], "Duration of the step, s: one number.";
        sin: Sines, Joints [Sine * 1], "Sines of the joint positions.";
        cos: Cosines, Joints [Cosine * 1], "Cosines of the joint positions.";
        force: Wrench, Tip [JointForce * 3],
            "Force that the last link exerts at the tip, in tip axes, N: three elements.";
        moment: Wrench, Tip [JointMoment * 3],
            "Moment that it exerts about the origin of the tip frame, N m: three elements.";
        payload: Payload, Tip [Mass * 1, Com * 3, Inertia * 6],
            "What is fixed to the tip: mass, kg; centre of mass x, y, z, m; inertia about it xx, yy, zz, xy, xz, yz, \
             kg m²: ten elements, in tip axes.";
        base_omega: Base, Base [Omega * 3],
            "Angular velocity of the base, rad/s, in the axes of frame 0: three elements.";
        base_omega_dot: Base, Base [OmegaDot * 3], "Angular acceleration of the base, rad/s²: three elements.";
        base_acceleration: Base, Base [Acceleration * 3],
            "Acceleration of the base, gravity not included, m/s²: three elements.";
        base_gravity: Base, Base [Gravity * 3],
            "Acceleration of gravity, m/s², pointing down: three elements.";
        wrenches: Wrenches, EachTip [TipForce * 3, TipMoment * 3],
            "Force, N, and moment, N m, that the robot exerts at each tip, in axes of the tip: six elements for each \
             tip.";
        omega: BaseVelocity, Base [Omega * 3],
            "Angular velocity of a floating base, rad/s, in the axes of frame 0: three elements.";
        twist: BaseTwist, Base [OriginVelocity * 3, Omega * 3],
            "Velocity of the origin of frame 0, m/s, and angular velocity of a floating base, rad/s, in the \
             axes of frame 0: six elements.";
        pose: BasePose, Base [FrameRotation * 9, FrameOrigin * 3],
            "Pose of frame 0 in the world: rows of the rotation, then the origin, m: twelve elements.";
        base_rotation: BaseRotation, Base [BaseRotation * 9],
            "Rotation of the base: its columns are the axes of frame 0 in the world; three rows of three elements.";
    } };
}

macro_rules! parts {
    ($($name:ident: $argument:ident, $owner:ident [$($quantity:ident * $count:literal),*], $about:literal;)*) => {
        /// Their places.
        #[allow(non_camel_case_types)] // named as the arrays
        enum Place { $($name),* }

        /// All of them, those of an argument beside each other.
        const PARTS: &[ArgumentPart] = &[$(ArgumentPart {
            argument: Argument::$argument,
            name: stringify!($name),
            place: Place::$name as usize,
            owner: Owner::$owner,
            length: match Owner::$owner {
                Owner::Joints => Length::Joints,
                Owner::Passive => Length::Passive,
                Owner::Base | Owner::Tip | Owner::EachTip => Length::Fixed(0 $(+ $count)*),
            },
        }),*];
    };
}

argument_parts!(parts);

impl Argument {
    /// The array of this name, of any argument.
    #[must_use]
    pub fn part_named(name: &str) -> Option<&'static ArgumentPart> {
        PARTS.iter().find(|part| part.name == name)
    }

    /// The arrays that it is passed in, in order.
    pub fn parts(self) -> impl Iterator<Item = &'static ArgumentPart> {
        PARTS.iter().filter(move |part| part.argument == self)
    }

    /// Whether it has a row of numbers for each tip.
    #[must_use]
    pub const fn is_of_each_tip(self) -> bool {
        matches!(self.shape(), Shape::Array(Length::Tips, _))
    }

    /// Whether it is one number, which is passed by itself and not in an array.
    #[must_use]
    pub const fn is_number(self) -> bool {
        matches!(self.shape(), Shape::Number)
    }

    /// How many elements each row of its array has, if that is an array of rows.
    #[must_use]
    pub const fn row(self) -> Option<usize> {
        match self.shape() {
            Shape::Array(_, Shape::Array(Length::Fixed(row), _)) => Some(*row),
            Shape::Array(_, Shape::Record(..)) => Some(6),
            _ => None,
        }
    }

    /// Numbers that it has for a state of a robot.
    #[must_use]
    pub fn elements(self, sizes: Sizes) -> usize {
        self.shape().len(sizes)
    }
}
