//! The derive macros of `rne`.
use proc_macro::TokenStream;
/// Derives.
#[proc_macro_derive(InverseDynamics, attributes(robot))]
pub fn derive_inverse_dynamics(_input: TokenStream) -> TokenStream {
    TokenStream::new()
}
