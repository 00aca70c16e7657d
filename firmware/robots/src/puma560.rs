//! All that the PUMA 560 can compute besides `inverse_dynamics`.

use rne::{BaseMotion, Numbers, ObserverState, Payload, Scalar, Wrench};

use crate::states::State;

/// What is done with each function.
pub trait Visitor {
    /// `form` and `function` name the function of [`each`] that is called.
    fn visit<N: Numbers<f32>>(&mut self, form: &'static str, function: &'static str, call: impl Fn(&Arguments) -> N);
}

/// An argument of every name.
pub struct Arguments {
    q: [f32; 6],
    qd: [f32; 6],
    qdd: [f32; 6],
    /// Sines and cosines of `q`.
    pub sin: [f32; 6],
    pub cos: [f32; 6],
    tau: [f32; 6],
    multipliers: [f32; 6],
    wrench: Wrench<f32>,
    payload: Payload<f32>,
    base: BaseMotion<f32>,
    step: f32,
}

impl Arguments {
    /// At a state; the torques are as large as the accelerations, tip and base as they happen to be.
    #[must_use]
    pub fn at(State { q, qd, qdd }: State<6>) -> Self {
        let (sin, cos) = f32::sin_cos_array(q);
        let wrench = Wrench { force: [1.0, -2.0, 3.0], moment: [0.5, 0.25, -0.125] };
        let payload = Payload::from_array([0.5, 0.01, -0.02, 0.1, 0.002, 0.003, 0.001, 0.0001, -0.0002, 0.0003]);
        let mut base = BaseMotion::fixed([0.0, 0.0, -9.81]);
        base.omega = [0.1, -0.2, 0.3];
        Self { q, qd, qdd, sin, cos, tau: qdd, multipliers: qdd, wrench, payload, base, step: 0.01 }
    }
}

/// A tick of the momentum observer.
type Update = fn(&mut ObserverState<6, f32>, &[f32; 6], &[f32; 6], &[f32; 6]) -> [f32; 6];

impl Arguments {
    /// What an observer of 20 Hz at 1 kHz sees in its third tick.
    fn observed(&self, update: Update) -> [f32; 6] {
        let Self { q, qd, tau, sin, cos, .. } = self;
        let mut observer = ObserverState::new(20.0, 1e-3);
        let _ = (update(&mut observer, q, qd, tau), update(&mut observer, sin, cos, tau));
        update(&mut observer, cos, sin, qd)
    }
}

/// The type of an argument.
macro_rules! taken {
    (Step) => { f32 };
    (Wrench) => { Wrench<f32> };
    (Payload) => { Payload<f32> };
    (Base) => { BaseMotion<f32> };
    ($of_joints:ident) => { [f32; 6] };
}

/// An argument as a method takes it: a number by its value.
macro_rules! passed {
    (Step of $argument:ident) => {
        *$argument
    };
    ($kind:ident of $argument:ident) => {
        $argument
    };
}

/// The macro of a struct with all capabilities of an arm with one tip.
macro_rules! of_arms {
    ([$($found:ident)*] $capability:ident of $robots:ident: $summary:literal $(, $details:literal)?; $($rest:tt)*) => {
        of_arms! { [$($found)*] $($rest)* }
    };
    ([$($found:ident)*] $capability:ident: $summary:literal $(, $details:literal)?; $($rest:tt)*) => {
        of_arms! { [$($found)* $capability] $($rest)* }
    };
    ([$($found:ident)*]) => {
        macro_rules! robot {
            ($form:literal) => {
                #[derive($($found),*)]
                #[robot(path = "../../../robots/puma560.yaml", form = $form)]
                struct Robot;
            };
        }
    };
    ($($all:tt)*) => { of_arms! { [] $($all)* } };
}
rne_functions::capabilities!(of_arms);

/// A module per form with a function per method of a list, and [`each`].
macro_rules! modules {
    ($($function:ident($($argument:ident: $kind:ident),*))*) => {
        modules!(seven_steps, "seven_steps": $($function($($argument: $kind),*))*);
        modules!(reduced, "reduced": $($function($($argument: $kind),*))*);

        /// Shows every function to a visitor.
        pub fn each(visitor: &mut impl Visitor) {
            $(
                visitor.visit("seven_steps", stringify!($function), |a| seven_steps::$function($(&a.$argument),*));
                visitor.visit("reduced", stringify!($function), |a| reduced::$function($(&a.$argument),*));
            )*
            visitor.visit("seven_steps", "observer_update", |a| a.observed(seven_steps::observer_update));
            visitor.visit("reduced", "observer_update", |a| a.observed(reduced::observer_update));
        }
    };
    ($form:ident, $name:literal: $($function:ident($($argument:ident: $kind:ident),*))*) => {
        #[doc = concat!("The form `", $name, "`.")]
        pub mod $form {
            use rne::*;

            robot!($name);

            $(
                /// The method of this name.
                #[inline(never)]
                #[must_use]
                pub fn $function($($argument: &taken!($kind)),*) -> impl Numbers<f32> + use<> {
                    Robot.$function($(passed!($kind of $argument)),*)
                }
            )*

            /// Its code is in the update alone, which can be read there.
            #[derive(MomentumObserver)]
            #[robot(path = "../../../robots/puma560.yaml", form = $name)]
            struct Observed;

            /// A tick of the momentum observer.
            #[inline(never)]
            #[must_use]
            pub fn observer_update(
                observer: &mut ObserverState<6, f32>,
                q: &[f32; 6],
                qd: &[f32; 6],
                tau: &[f32; 6],
            ) -> [f32; 6] {
                observer.update(&Observed, q, qd, tau)
            }
        }
    };
}

/// The functions of an arm with one tip, on a base that stands still or that something moves, but its torques.
macro_rules! of_arm {
    ([$($found:tt)*]) => { modules! { $($found)* } };
    ($found:tt InverseDynamics $axes:tt = $name:ident $arguments:tt -> $returned:ident:
        $summary:literal $(, $details:literal)?; $($rest:tt)*) => {
        of_arm! { $found $($rest)* }
    };
    ([$($found:tt)*] $variant:ident [$what:ident $(. $load:tt)?] = $name:ident $arguments:tt
        -> $returned:ident $(at $of_frame:ident)?: $summary:literal $(, $details:literal)?; $($rest:tt)*) => {
        of_arm! { @ $($load)? [$($found)*] $name $arguments $($rest)* }
    };
    ($found:tt $variant:ident $axes:tt = $name:ident $arguments:tt
        -> $returned:ident: $summary:literal $(, $details:literal)?; $($rest:tt)*) => {
        of_arm! { $found $($rest)* }
    };
    (@ with_wrenches $found:tt $name:ident $arguments:tt $($rest:tt)*) => { of_arm! { $found $($rest)* } };
    (@ floating $found:tt $name:ident $arguments:tt $($rest:tt)*) => { of_arm! { $found $($rest)* } };
    (@ of_loops $found:tt $name:ident $arguments:tt $($rest:tt)*) => { of_arm! { $found $($rest)* } };
    (@ $($load:ident)? [$($found:tt)*] $name:ident $arguments:tt $($rest:tt)*) => {
        of_arm! { [$($found)* $name $arguments] $($rest)* }
    };
    ($($all:tt)*) => { of_arm! { [] $($all)* } };
}

rne_functions::functions!(of_arm);
