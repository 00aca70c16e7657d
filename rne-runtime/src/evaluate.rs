//! Any function of an arm by its id, as the flat numbers of its result.

use rne_functions::Function;

use crate::numbers::Numbers;
use crate::{BaseMotion, BaseTwist, Constant, DynArm, Payload, Pose, Scalar, Wrench, WrongLength};

/// The arguments of every function, by the names of the table. A function reads its own.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a, T> {
    /// Joint positions, rad or m.
    pub q: &'a [T],
    /// Joint velocities, rad/s or m/s.
    pub qd: &'a [T],
    /// Joint accelerations, rad/s² or m/s².
    pub qdd: &'a [T],
    /// Joint torques, N m or N.
    pub tau: &'a [T],
    /// Sines of the joint positions.
    pub sin: &'a [T],
    /// Cosines of the joint positions.
    pub cos: &'a [T],
    /// Positions of the dependent joints of closed loops, rad or m.
    pub passive: &'a [T],
    /// Multipliers of the joint torques.
    pub multipliers: &'a [T],
    /// Exerted by the last link at the tip.
    pub wrench: &'a Wrench<T>,
    /// Exerted by the robot at each tip.
    pub wrenches: &'a [Wrench<T>],
    /// Fixed to the tip.
    pub payload: &'a Payload<T>,
    /// Motion of the base, and gravity.
    pub base: &'a BaseMotion<T>,
    /// Angular velocity of a floating base, rad/s, in axes of frame 0.
    pub omega: &'a [T; 3],
    /// Velocity of a floating base.
    pub twist: &'a BaseTwist<T>,
    /// Pose of a floating base in the world.
    pub pose: &'a Pose<T>,
    /// Rows of the rotation from axes of frame 0 to those of the world.
    pub base_rotation: &'a [[T; 3]; 3],
    /// Duration of a step, s.
    pub step: T,
}

impl<S: Constant> DynArm<S> {
    /// The numbers of a function, in the order of its layout.
    ///
    /// # Errors
    /// When an argument of the function does not have one element per joint or tip.
    #[doc(hidden)] // the ids of functions are internal
    pub fn evaluate<T: Scalar + Numbers<T>>(
        &self,
        function: Function,
        inputs: &Inputs<'_, T>,
    ) -> Result<Vec<T>, WrongLength> {
        let mut numbers = Vec::new();
        macro_rules! calls {
            ($(
                $variant:ident $axes:tt = $name:ident($($argument:ident: $kind:ident),*)
                    -> $returned:ident $(at $of_frame:ident)?:
                    $summary:literal $(, $details:literal)?;
            )*) => {
                match function {
                    $(Function::$variant => {
                        self.$name($(inputs.$argument),*)?.each(&mut |number| numbers.push(*number));
                    })*
                }
            };
        }
        rne_functions::functions!(calls);
        Ok(numbers)
    }
}
