//! The records that functions take and return, as a table: names, parts, sizes and sentences.

use crate::layout::returned as shapes;
use crate::{Length, Shape};

macro_rules! records {
    ($(
        $record:ident = $c_name:literal [$($size:ident),*] { $($field:ident: $shape:ident),* $(,)? }: $about:literal;
    )*) => {
        /// The records that functions take and return.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Record { $(#[doc = $about] $record),* }

        impl Record {
            /// The name of its type.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$record => stringify!($record)),* }
            }

            /// The name of its type in C, without the prefix of the file.
            #[must_use]
            pub const fn c_name(self) -> &'static str {
                match self { $(Self::$record => $c_name),* }
            }

            /// The names of its parts.
            #[must_use]
            pub const fn fields(self) -> &'static [&'static str] {
                match self { $(Self::$record => &[$(stringify!($field)),*]),* }
            }

            /// The lengths that its type has as parameters, in their order.
            #[must_use]
            pub const fn sizes(self) -> &'static [Length] {
                match self { $(Self::$record => &[$(Length::$size),*]),* }
            }

            /// The sentence that says what it is, with units and frames.
            #[must_use]
            pub const fn about(self) -> &'static str {
                match self { $(Self::$record => $about),* }
            }
        }

        /// The shapes of the records, by their names.
        #[allow(non_upper_case_globals)] // named as in the list of functions
        pub(crate) mod returned {
            use super::{Record, Shape, shapes};

            $(#[doc = $about]
            pub(crate) const $record: Shape = Shape::Record(Record::$record, &[$(shapes::$shape),*]);)*
        }
    };
}

records! {
    Pose = "pose" [] { rotation: Rotation, translation: Point }:
        "Rows of the rotation from the axes of a frame to those of the world, and the frame's origin there, m.";
    Wrench = "wrench" [] { force: Point, moment: Point }: "Force, N, and moment, N m.";
    TorqueDerivatives = "torque_derivatives" [Joints] { dq: Matrix, dqd: Matrix }:
        "Torques by positions and by velocities; row i is torque i, column j is joint j.";
    MomentumAndRate = "momentum" [Joints] { momentum: Vector, rate: Vector }:
        "Momenta of the joints, M q̇, and their rates without external torques.";
    FloatingTorques = "floating_torques" [Joints] { wrench: Wrench, tau: Vector }:
        "Force and moment that must act on the base beside gravity, about the origin of frame 0, and the torques.";
    BaseAcceleration = "base_acceleration" [] { linear: Point, angular: Point }:
        "Acceleration of the origin of frame 0 less gravity, m/s², and angular acceleration, rad/s², in its axes.";
    FloatingAccelerations = "floating_accelerations" [Joints] { base: BaseAcceleration, qdd: Vector }:
        "Acceleration of the base, and accelerations of the joints.";
    AccelerationsAndWrenches = "accelerations_and_wrenches" [Joints, Tips] {
        accelerations: FloatingAccelerations, wrenches_on_robot: TipWrenches
    }:
        "Accelerations, and what contacts exert on the robot at each tip.";
    FloatingTorqueDerivatives = "floating_torque_derivatives" [Joints, Velocities] {
        dq: RowsByJoint, dqd: RowsByJoint, domega: RowsByAxis
    }:
        "Force and moment on the base and torques, by positions, velocities and angular velocity of the base; axes of \
         frame 0.";
    ClosureStep = "closure" [Passive, Equations] { passive: PassiveVector, residual: Residual }:
        "Positions of the dependent joints after a Newton step, and what is left of the equations before it.";
    TorqueGradient = "gradient" [Joints] { dq: Vector, dqd: Vector, dqdd: Vector }:
        "Derivatives of the torques, each times its multiplier and added up: by positions, by velocities and by \
         accelerations.";
    AccelerationDerivatives = "acceleration_derivatives" [Joints] { dq: Matrix, dqd: Matrix, dtau: Matrix }:
        "Accelerations by positions, by velocities and by torques; row i is acceleration i, column j is joint j.";
    TorqueHessian = "hessian" [Joints] { dq_dq: Matrix, dq_dqd: Matrix, dqd_dqd: Matrix, dq_dqdd: Matrix }:
        "Second derivatives of the torques, each times its multiplier and added up: element (i, j) is by joint i and \
         by joint j.";
    NextState = "next_state" [Joints] { q: Vector, qd: Vector }:
        "Positions, rad or m, and velocities, rad/s or m/s, after a step.";
    StepDerivatives = "step_derivatives" [Joints] { dq: Matrix, dqd: Matrix, dtau: Matrix }:
        "Positions or velocities after a step by positions, by velocities and by torques; row i is position or \
         velocity i, column j is joint j.";
    NextStateDerivatives = "next_state_derivatives" [Joints] { q: StepDerivatives, qd: StepDerivatives }:
        "Derivatives of the positions and of the velocities after a step.";
    BaseTwist = "base_twist" [] { linear: Point, angular: Point }:
        "Velocity of the origin of frame 0, m/s, and angular velocity of the base, rad/s, in its axes.";
    FloatingNextState = "floating_next_state" [Joints] { pose: Pose, twist: BaseTwist, q: Vector, qd: Vector }:
        "Pose and velocity of the base, positions, rad or m, and velocities, rad/s or m/s, of the joints after a step.";
    FloatingStepDerivatives = "floating_step_derivatives" [Joints, Velocities] {
        q_dq: FloatingMatrix, q_dv: FloatingMatrix, q_dtau: RowsByJoint,
        v_dq: FloatingMatrix, v_dv: FloatingMatrix, v_dtau: RowsByJoint,
    }:
        "Positions and velocities after a step by positions, by velocities and by torques; six rows and columns of the \
         base, in axes of frame 0, stand before those of the joints.";
    BaseMotion = "base_motion" [] { omega: Point, omega_dot: Point, acceleration: Point, gravity: Point }:
        "Angular velocity of the base, rad/s, its rate, rad/s², acceleration, m/s², and gravity, m/s², in its axes.";
    Payload = "payload" [] { mass: Number, com: Point, inertia: Spatial }:
        "Mass, kg, centre of mass, m, and inertia about it xx, yy, zz, xy, xz, yz, kg m², in axes of the tip.";
}
