//! Any function of an arm by its id, as the flat numbers of its result.

use rne_functions::Function;

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

/// A result as numbers, in the order of its layout.
macro_rules! numbers {
    (Number $x:expr) => {
        vec![$x]
    };
    (Point $x:expr) => {
        $x.to_vec()
    };
    (Spatial $x:expr) => {
        $x.to_vec()
    };
    (Vector $x:expr) => {
        $x
    };
    (FloatingVector $x:expr) => {
        $x
    };
    (PassiveVector $x:expr) => {
        $x
    };
    (SpatialMatrices $x:expr) => {
        $x.concat().concat()
    };
    (TipRows $x:expr) => {
        $x.concat().concat()
    };
    (Regressor $x:expr) => {
        $x.concat().concat()
    };
    (FloatingRegressor $x:expr) => {
        $x.concat().concat()
    };
    (Pose $x:expr) => {
        of_pose(&$x)
    };
    (Poses $x:expr) => {
        $x.iter().flat_map(of_pose).collect()
    };
    (Wrenches $x:expr) => {
        of_wrenches(&$x)
    };
    (TorqueGradient $x:expr) => {
        [$x.dq, $x.dqd, $x.dqdd].concat()
    };
    (TorqueDerivatives $x:expr) => {
        [$x.dq, $x.dqd].concat().concat()
    };
    (AccelerationDerivatives $x:expr) => {
        [$x.dq, $x.dqd, $x.dtau].concat().concat()
    };
    (TorqueHessian $x:expr) => {
        [$x.dq_dq, $x.dq_dqd, $x.dqd_dqd, $x.dq_dqdd].concat().concat()
    };
    (NextState $x:expr) => {
        [$x.q, $x.qd].concat()
    };
    (NextStateDerivatives $x:expr) => {
        [$x.q, $x.qd].map(|by| [by.dq, by.dqd, by.dtau].concat().concat()).concat()
    };
    (ClosureStep $x:expr) => {
        [$x.0, $x.1].concat()
    };
    (FloatingTorques $x:expr) => {
        [of_wrenches(&[$x.0]), $x.1].concat()
    };
    (FloatingAccelerations $x:expr) => {
        [$x.0.linear.as_slice(), &$x.0.angular, &$x.1].concat()
    };
    (AccelerationsAndWrenches $x:expr) => {
        [$x.0.linear.as_slice(), &$x.0.angular, &$x.1, &of_wrenches(&$x.2)].concat()
    };
    (FloatingTorqueDerivatives $x:expr) => {
        [$x.dq.concat(), $x.dqd.concat(), $x.domega.concat()].concat()
    };
    (FloatingNextState $x:expr) => {
        [&*of_pose(&$x.pose), &$x.twist.linear, &$x.twist.angular, &$x.q, &$x.qd].concat()
    };
    (FloatingStepDerivatives $x:expr) => {
        [$x.q_dq, $x.q_dv, $x.q_dtau, $x.v_dq, $x.v_dv, $x.v_dtau].concat().concat()
    };
    ($rows:ident $x:expr) => {
        $x.concat()
    };
}

impl<S: Constant> DynArm<S> {
    /// The numbers of a function, in the order of its layout.
    ///
    /// # Errors
    /// When an argument of the function does not have one element per joint or tip.
    pub fn evaluate<T: Scalar>(&self, function: Function, inputs: &Inputs<'_, T>) -> Result<Vec<T>, WrongLength> {
        macro_rules! calls {
            ($(
                $variant:ident $axes:tt = $name:ident($($argument:ident: $kind:ident),*)
                    -> $returned:ident $(at $of_frame:ident)?:
                    $summary:literal $(, $details:literal)?;
            )*) => {
                match function {
                    $(Function::$variant => {
                        let found = self.$name($(inputs.$argument),*)?;
                        numbers!($returned found)
                    })*
                }
            };
        }
        Ok(rne_functions::functions!(calls))
    }
}

fn of_pose<T: Scalar>(pose: &Pose<T>) -> Vec<T> {
    [pose.rotation.as_flattened(), &pose.translation].concat()
}

fn of_wrenches<T: Scalar>(wrenches: &[Wrench<T>]) -> Vec<T> {
    wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment]).flatten().collect()
}
