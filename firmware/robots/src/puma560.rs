//! All functions of the PUMA 560 other than `inverse_dynamics`.

use rne::{BaseMotion, Numbers, ObserverState, Payload, Scalar, Wrench};

use crate::states::State;

/// An operation that [`each`] applies to every function.
pub trait Visitor {
    /// Receives a function of [`each`] as `call`, with its form and name.
    fn visit<N: Numbers<f32>>(&mut self, form: &'static str, function: &'static str, call: impl Fn(&Arguments) -> N);
}

/// All arguments that functions of an arm may take, by their names.
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
    /// Makes the arguments at a state. The torques have the numbers of the accelerations; those of tip and base are
    /// arbitrary.
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

/// A function that updates the momentum observer by one tick.
type Update = fn(&mut ObserverState<6, f32>, &[f32; 6], &[f32; 6], &[f32; 6]) -> [f32; 6];

impl Arguments {
    /// Returns the external torques of an observer with a gain of 20 Hz in its third tick, at 1 kHz.
    fn observed(&self, update: Update) -> [f32; 6] {
        let Self { q, qd, tau, sin, cos, .. } = self;
        let mut observer = ObserverState::new(20.0, 1e-3);
        let _ = (update(&mut observer, q, qd, tau), update(&mut observer, sin, cos, tau));
        update(&mut observer, cos, sin, qd)
    }
}

/// Expands to the type of an argument.
macro_rules! taken {
    (Step) => { f32 };
    (Wrench) => { Wrench<f32> };
    (Payload) => { Payload<f32> };
    (Base) => { BaseMotion<f32> };
    ($of_joints:ident) => { [f32; 6] };
}

/// Expands to an argument as a method takes it: numbers are passed by value, all others by reference.
macro_rules! passed {
    (Step of $argument:ident) => {
        *$argument
    };
    ($kind:ident of $argument:ident) => {
        $argument
    };
}

/// Selects, from the list of all capabilities, those of an arm with one tip.
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

/// Makes a module for each form, with a function for each method of a list, and [`each`].
macro_rules! modules {
    ($($function:ident($($argument:ident: $kind:ident),*))*) => {
        modules!(seven_steps, "seven_steps": $($function($($argument: $kind),*))*);
        modules!(reduced, "reduced": $($function($($argument: $kind),*))*);

        /// Passes every function to a visitor.
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
                /// Calls the method with this name.
                #[inline(never)]
                #[must_use]
                pub fn $function($($argument: &taken!($kind)),*) -> impl Numbers<f32> + use<> {
                    Robot.$function($(passed!($kind of $argument)),*)
                }
            )*

            /// A separate arm for the observer, so that its code is only in the update function, where it can be read.
            #[derive(MomentumObserver)]
            #[robot(path = "../../../robots/puma560.yaml", form = $name)]
            struct Observed;

            /// Updates the momentum observer by one tick.
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

/// Selects the functions of an arm with one tip, on a fixed or a moving base, except its torques.
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
