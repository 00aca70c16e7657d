//! The derive macros of `rne`.

mod attribute;
mod description;
mod error;
mod expand;
mod implementation;
mod location;

use proc_macro::TokenStream;

/// Derives.
#[proc_macro_derive(InverseDynamics, attributes(robot))]
pub fn derive_inverse_dynamics(input: TokenStream) -> TokenStream {
    expand::inverse_dynamics(input.into()).into()
}
