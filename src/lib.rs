//! rne
pub use rne_runtime::*;
pub use rne_macro::InverseDynamics;
