//! Shipped robots with everything derived, and their functions by their names.

use rne::Numbers as Flat;
use rne::*;
use rne_codegen::Form;
pub(crate) use rne_codegen::Function;

pub(crate) use crate::states::{self, Numbers};

/// A robot's name, and what is derived for it in each form.
pub(crate) type Forms = (&'static str, Vec<(Form, Box<dyn Derived>)>);

/// A derived robot.
pub(crate) trait Derived: Send + Sync {
    /// All numbers that a function returns, in their order.
    fn single(&self, function: Function, given: &Numbers<f32>) -> Vec<f32>;
    fn double(&self, function: Function, given: &Numbers<f64>) -> Vec<f64>;
}

pub(crate) trait Everything<const DOF: usize, const NV: usize, const BODIES: usize>:
    InverseDynamics<DOF>
    + MassMatrix<DOF>
    + CoriolisMatrix<DOF>
    + ForwardDynamics<DOF>
    + Kinematics<DOF>
    + Energy<DOF>
    + CentreOfMass<DOF>
    + Regressor<DOF>
    + InverseDynamicsDerivatives<DOF>
    + JointWrenches<DOF>
    + MomentumObserver<DOF>
    + MovingBase<DOF>
    + Actuation<DOF>
    + PayloadDynamics<DOF>
    + TipWrenches<DOF, 1>
    + FloatingBase<DOF, NV, 1>
    + CentroidalMomentum<DOF, NV>
    + FloatingRegressor<DOF, NV, BODIES>
    + FloatingEnergy<DOF>
    + FloatingKinematics<DOF, NV, 1>
    + ContactDynamics<DOF, NV, 1>
    + FloatingInverseDynamicsDerivatives<DOF, NV, 1>
    + InverseDynamicsGradient<DOF>
    + ForwardDynamicsDerivatives<DOF>
    + JacobianDerivatives<DOF>
    + InverseDynamicsHessian<DOF>
    + EulerStep<DOF>
    + EulerStepDerivatives<DOF>
    + FloatingEulerStep<DOF, 1>
    + FloatingEulerStepDerivatives<DOF, NV, 1>
    + FloatingPayloadDynamics<DOF, NV>
{
}

/// The arguments of every function, by the names of the table.
struct Inputs<'a, const DOF: usize, T> {
    q: &'a [T; DOF],
    qd: &'a [T; DOF],
    qdd: &'a [T; DOF],
    tau: &'a [T; DOF],
    multipliers: &'a [T; DOF],
    sin: &'a [T; DOF],
    cos: &'a [T; DOF],
    wrench: &'a Wrench<T>,
    wrenches: &'a [Wrench<T>; 1],
    payload: &'a Payload<T>,
    base: &'a BaseMotion<T>,
    omega: &'a [T; 3],
    twist: &'a BaseTwist<T>,
    pose: &'a Pose<T>,
    base_rotation: &'a [[T; 3]; 3],
    step: T,
}

/// The call of a function; functions of closed loops have tests of their own.
macro_rules! call {
    ([$what:ident.of_loops] $($call:tt)*) => { unreachable!("of closed loops") };
    ([$what:ident.floating.of_loops] $($call:tt)*) => { unreachable!("of closed loops") };
    ([$what:ident.with_payload.of_loops] $($call:tt)*) => { unreachable!("of closed loops") };
    ([$what:ident.with_wrenches.of_loops] $($call:tt)*) => { unreachable!("of closed loops") };
    ([$what:ident.floating.with_wrenches.of_loops] $($call:tt)*) => { unreachable!("of closed loops") };
    ([$what:ident $(. $axis:ident)*] $robot:ident.$name:ident($($argument:expr),*) to $numbers:ident) => {
        $robot.$name($($argument),*).each(&mut |number| $numbers.push(*number))
    };
}

pub(crate) fn numbers<const DOF: usize, const NV: usize, const BODIES: usize, T: Scalar + Flat<T>>(
    robot: &impl Everything<DOF, NV, BODIES>,
    function: Function,
    given: &Numbers<T>,
) -> Vec<T> {
    let array = |numbers: &Vec<T>| -> [T; DOF] { numbers.as_slice().try_into().expect("one per joint") };
    let [q, qd, qdd, tau] = &given.joints.each_ref().map(array);
    let [force, moment, omega, omega_dot, acceleration, gravity, ref payload @ ..] = given.vectors;
    // numbers that stand one after the other, as C reads them
    let inputs = Inputs {
        q,
        qd,
        qdd,
        tau,
        multipliers: tau,
        sin: &array(&given.sine),
        cos: &array(&given.cosine),
        wrench: &Wrench { force, moment },
        wrenches: &[Wrench { force, moment }],
        payload: &states::payload(payload),
        base: &BaseMotion { omega, omega_dot, velocity: [T::zero(); 3], acceleration, gravity },
        omega: &omega,
        twist: &BaseTwist { linear: moment, angular: omega },
        pose: &Pose { rotation: given.rotation, translation: gravity },
        base_rotation: &given.rotation,
        step: T::from_f64(0.03125),
    };
    let mut numbers = Vec::new();
    macro_rules! calls {
        ($(
            $variant:ident $axes:tt = $name:ident($($argument:ident: $kind:ident),*) -> $returned:ident
                $(at $of_frame:ident)?: $summary:literal $(, $details:literal)?;
        )*) => {
            match function { $(Function::$variant => call!($axes robot.$name($(inputs.$argument),*) to numbers),)* }
        };
    }
    rne_codegen::functions!(calls);
    numbers
}

macro_rules! robot {
    ($robot:ident $path:literal $form:literal) => {
        pub(super) mod $robot {
            use crate::derived::{Derived, Everything, Function, Numbers, numbers};

            #[derive(
                rne::InverseDynamics,
                rne::MassMatrix,
                rne::CoriolisMatrix,
                rne::ForwardDynamics,
                rne::Kinematics,
                rne::Energy,
                rne::CentreOfMass,
                rne::Regressor,
                rne::InverseDynamicsDerivatives,
                rne::JointWrenches,
                rne::MomentumObserver,
                rne::MovingBase,
                rne::Actuation,
                rne::PayloadDynamics,
                rne::TipWrenches,
                rne::FloatingBase,
                rne::CentroidalMomentum,
                rne::FloatingRegressor,
                rne::FloatingEnergy,
                rne::FloatingKinematics,
                rne::ContactDynamics,
                rne::FloatingInverseDynamicsDerivatives,
                rne::InverseDynamicsGradient,
                rne::ForwardDynamicsDerivatives,
                rne::JacobianDerivatives,
                rne::InverseDynamicsHessian,
                rne::EulerStep,
                rne::EulerStepDerivatives,
                rne::FloatingEulerStep,
                rne::FloatingEulerStepDerivatives,
                rne::FloatingPayloadDynamics,
            )]
            #[robot(path = $path, form = $form, inline, allow_lints)]
            pub(crate) struct Robot;

            impl Everything<{ Robot::DOF }, { Robot::DOF + 6 }, { Robot::DOF + 1 }> for Robot {}

            impl Derived for Robot {
                fn single(&self, function: Function, given: &Numbers<f32>) -> Vec<f32> {
                    numbers(self, function, given)
                }

                fn double(&self, function: Function, given: &Numbers<f64>) -> Vec<f64> {
                    numbers(self, function, given)
                }
            }
        }
    };
}
pub(crate) use robot;

/// Modules of robots by forms, and all of them.
macro_rules! robots {
    ($([$robot:ident, $path:literal])*) => {
        mod seven_steps {
            $(crate::derived::robot!($robot $path "seven_steps");)*
        }

        mod reduced {
            $(crate::derived::robot!($robot $path "reduced");)*
        }

        /// The robots with their forms.
        fn robots() -> Vec<crate::derived::Forms> {
            vec![$((
                seven_steps::$robot::Robot::NAME,
                vec![
                    (rne_codegen::Form::SevenSteps, Box::new(seven_steps::$robot::Robot)),
                    (rne_codegen::Form::Reduced, Box::new(reduced::$robot::Robot)),
                ],
            )),*]
        }
    };
}
pub(crate) use robots;
