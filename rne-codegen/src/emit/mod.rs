//! Renderers of programs: tokens for the macro, text for people.

mod c;
mod evidence;
mod expression;
mod formula;
mod inert;
mod listing;
mod signature;
mod syntax;
mod table;
mod text;
mod tokens;

pub use c::{BadPrefix, CCode, ConstantTooLarge, Prefix, c_code};
pub use evidence::evidence;
pub use inert::{markdown, title, verbatim};
pub use listing::{Listing, listing};
pub use syntax::Precision;
pub use table::{angle, convention, dh_table};
pub use text::rust_file;
pub use tokens::Body;
