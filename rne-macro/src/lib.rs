//! The derive macros of `rne`; use them through that crate.
//!
//! A shell: the attribute, the file and the messages are handled here, everything else is `rne-codegen`. The examples
//! in the documentation use `rne`, which runs them.
#![forbid(unsafe_code)]

mod attribute;
mod batch;
mod constants;
mod description;
mod error;
mod expand;
mod frames;
mod implementation;
mod inspection;
mod joints;
mod location;
mod motors;
mod own_tests;
mod parameters;
mod signature;
#[cfg(test)]
mod tests;
mod tips;
mod warning;

use proc_macro::TokenStream;
use rne_codegen::{Capability, Function};

/// The derives, one for each capability of the table.
macro_rules! derives {
    (@derive InverseDynamics $summary:literal) => {
        #[cfg_attr(not(doctest), doc = include_str!("inverse_dynamics.md"))] // `rne` runs the examples
        #[proc_macro_derive(InverseDynamics, attributes(robot))]
        pub fn derive_inverse_dynamics(input: TokenStream) -> TokenStream {
            expand::capability(Capability::InverseDynamics, input.into()).into()
        }
    };
    (@derive $capability:ident $summary:literal $($details:literal)?) => {
        #[doc = concat!("Implements the trait `", stringify!($capability), "` for a struct: ", $summary)]
        ///
        $(#[doc = concat!($details, "\n\n")])?
        /// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone.
        /// The type gets a constant with the operations of each function, such as `MASS_MATRIX_OPERATIONS` for
        /// `mass_matrix`; `DOF`, names and limits come with `InverseDynamics`, or with `ClosedLoops`.
        ///
        #[cfg_attr(not(doctest), doc = rne_codegen::example!("" $capability))]
        #[proc_macro_derive($capability, attributes(robot))]
        #[allow(non_snake_case)] // a function for each name of a derive
        pub fn $capability(input: TokenStream) -> TokenStream {
            expand::capability(Capability::$capability, input.into()).into()
        }
    };
    ($($capability:ident $(of $robots:ident)?: $summary:literal $(, $details:literal)?;)*) => {
        $(derives! { @derive $capability $summary $($details)? })*
    };
}
rne_codegen::capabilities!(derives);

#[cfg_attr(not(doctest), doc = include_str!("batch_inverse_dynamics.md"))]
#[proc_macro_derive(BatchInverseDynamics, attributes(robot))]
pub fn derive_batch_inverse_dynamics(input: TokenStream) -> TokenStream {
    batch::batch(Function::InverseDynamics, input.into()).into()
}

/// Implements the trait `BatchMassMatrix` for a struct that derives `MassMatrix` too: M(q) of many states at once.
///
/// As [`BatchInverseDynamics`](macro@BatchInverseDynamics), with an array for each element of the matrix; elements with
/// an empty array are not written.
#[proc_macro_derive(BatchMassMatrix, attributes(robot))]
pub fn derive_batch_mass_matrix(input: TokenStream) -> TokenStream {
    batch::batch(Function::MassMatrix, input.into()).into()
}

/// Implements the trait `BatchForwardDynamics` for a struct that derives `ForwardDynamics` too: accelerations of many
/// states at once.
///
/// As [`BatchInverseDynamics`](macro@BatchInverseDynamics).
#[proc_macro_derive(BatchForwardDynamics, attributes(robot))]
pub fn derive_batch_forward_dynamics(input: TokenStream) -> TokenStream {
    batch::batch(Function::ForwardDynamics, input.into()).into()
}

/// Implements the trait `BatchInverseDynamicsDerivatives` for a struct that derives `InverseDynamicsDerivatives` too:
/// ∂τ/∂q and ∂τ/∂q̇ of many states at once.
///
/// As [`BatchMassMatrix`](macro@BatchMassMatrix).
#[proc_macro_derive(BatchInverseDynamicsDerivatives, attributes(robot))]
pub fn derive_batch_inverse_dynamics_derivatives(input: TokenStream) -> TokenStream {
    batch::batch(Function::InverseDynamicsDerivatives, input.into()).into()
}

/// Implements the trait `BatchFloatingInverseDynamics` for a struct that derives `FloatingBase` too: torques, and the
/// wrench on the base, of many states of a robot with a floating base.
///
/// As [`BatchInverseDynamics`](macro@BatchInverseDynamics).
#[proc_macro_derive(BatchFloatingInverseDynamics, attributes(robot))]
pub fn derive_batch_floating_inverse_dynamics(input: TokenStream) -> TokenStream {
    batch::batch(Function::InverseDynamicsOfFloatingBase, input.into()).into()
}

/// Implements the traits `AtFrame` and `FrameKinematics` for a struct: pose, Jacobian, its rate and derivatives, J̇ q̇
/// and torques of a wrench of every frame in the list `frames` of the robot file, and of every link frame.
///
/// The type gets the function `frame`, which turns a name into the constant that the methods take, and the constant
/// `FRAME_NAMES`. A name is that of a frame, or that of a joint for its link frame:
///
/// ```ignore
/// let jacobian = MyArm.jacobian_of::<{ MyArm::frame("camera") }, _>(&q);
/// ```
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops`, `tests` and `inspect` concern other
/// derives.
#[proc_macro_derive(FrameKinematics, attributes(robot))]
pub fn derive_frame_kinematics(input: TokenStream) -> TokenStream {
    expand::frame_kinematics(input.into()).into()
}
