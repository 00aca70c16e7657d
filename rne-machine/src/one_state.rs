//! The functions by their own names, for one state: arguments and results as those of `DynArm`.

use rne_codegen::Function;
use rne_runtime::{BaseMotion, BaseTwist, Payload, Pose, VectorUnit, Wrench};

use crate::results::{self, Shaped};
use crate::{Arguments, Array, CompiledArm, EvaluationError, Number};

/// One state. Arrays have one element per joint: rad, rad/s, rad/s², N m for revolute joints; m, m/s, m/s², N for
/// prismatic ones.
impl CompiledArm {
    /// Any function for one state: its numbers, in the order of the function's [layout](Function::layout), into
    /// `results`. Nothing is allocated for more than the arguments.
    ///
    /// # Errors
    /// When an argument is missing or has another size, or `results`, when an argument is
    /// [out of range](crate::OutOfRange), or when the function cannot be compiled.
    pub fn run_one<T: Number>(
        &self,
        function: Function,
        arguments: &Arguments<'_, T>,
        results: &mut [T],
    ) -> Result<(), EvaluationError> {
        self.function(function)?.run_one(VectorUnit::widest(), arguments, results)
    }

    /// The numbers of a function in their shape.
    fn result<T: Number, R: Shaped<T>>(
        &self,
        function: Function,
        arguments: &Arguments<'_, T>,
    ) -> Result<R, EvaluationError> {
        let compiled = self.function(function)?;
        let mut numbers = vec![T::zero(); compiled.outputs()];
        compiled.run_one(VectorUnit::widest(), arguments, &mut numbers)?;
        Ok(R::take(&self.layout(function), &mut numbers.into_iter()))
    }
}

/// The type of an argument.
macro_rules! taken {
    (Wrench) => { &Wrench<T> };
    (Wrenches) => { &[Wrench<T>] };
    (Payload) => { &Payload<T> };
    (Base) => { &BaseMotion<T> };
    (BaseVelocity) => { &[T; 3] };
    (BaseTwist) => { &BaseTwist<T> };
    (BasePose) => { &Pose<T> };
    (BaseRotation) => { &[[T; 3]; 3] };
    (Step) => { T };
    ($of_joints:ident) => { &[T] };
}

/// A source that an argument is read from.
macro_rules! read {
    (Payload $payload:ident) => {
        $payload.to_array()
    };
    (Wrenches $wrenches:ident) => {
        $wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment]).flatten().collect::<Vec<_>>()
    };
    (Step $step:ident) => {
        [$step]
    };
    (BaseTwist $twist:ident) => {
        [$twist.linear, $twist.angular].concat()
    };
    (BasePose $pose:ident) => {
        $pose.rotation.iter().chain([&$pose.translation]).flatten().copied().collect::<Vec<_>>()
    };
    ($kind:ident $argument:ident) => {
        $argument
    };
}

/// An argument among others.
macro_rules! with {
    ($others:ident, Wrench $wrench:ident) => {
        $others.force(Array::Same(&$wrench.force)).moment(Array::Same(&$wrench.moment))
    };
    ($others:ident, Payload $payload:ident) => {
        $others.payload(Array::Same(&$payload))
    };
    ($others:ident, Wrenches $wrenches:ident) => {
        $others.wrenches(Array::Same(&$wrenches))
    };
    ($others:ident, Base $base:ident) => {
        $others
            .base_omega(Array::Same(&$base.omega))
            .base_omega_dot(Array::Same(&$base.omega_dot))
            .base_acceleration(Array::Same(&$base.acceleration))
            .base_gravity(Array::Same(&$base.gravity))
    };
    ($others:ident, BaseVelocity $omega:ident) => {
        $others.omega(Array::Same($omega))
    };
    ($others:ident, BaseTwist $twist:ident) => {
        $others.twist(Array::Same(&$twist))
    };
    ($others:ident, Step $step:ident) => {
        $others.step(Array::Same(&$step))
    };
    ($others:ident, BasePose $pose:ident) => {
        $others.pose(Array::Same(&$pose))
    };
    ($others:ident, BaseRotation $rotation:ident) => {
        $others.base_rotation(Array::Same($rotation.as_flattened()))
    };
    ($others:ident, $of_joints:ident $argument:ident) => {
        $others.$argument(Array::Rows($argument))
    };
}

macro_rules! methods {
    ($(
        $variant:ident $axes:tt =
            $name:ident($($argument:ident: $kind:ident),*) -> $returned:ident $(at $of_frame:ident)?:
            $summary:literal $(, $details:literal)?;
    )*) => {
        impl CompiledArm {$(
            #[doc = $summary]
            ///
            /// # Errors
            /// When an argument does not have one element per joint or tip, when it is
            /// [out of range](crate::OutOfRange), or when the function cannot be compiled for this robot.
            #[allow(clippy::too_many_arguments)] // those of the table
            pub fn $name<T: Number>(
                &self,
                $($argument: taken!($kind),)*
            ) -> Result<results::$returned<T>, EvaluationError> {
                let arguments = Arguments::new();
                $(let $argument = read!($kind $argument);)*
                $(let arguments = with!(arguments, $kind $argument);)*
                self.result(Function::$variant, &arguments)
            }
        )*}
    };
}

rne_codegen::functions!(methods);
