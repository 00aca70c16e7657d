//! Renderers of programs: tokens for the macro, text for people.

mod annotated;
mod ascii;
mod c;
mod evidence;
mod expression;
mod formula;
mod heading;
mod inert;
mod line_breaks;
mod listing;
mod own_tests;
mod parameters;
mod signature;
mod steps;
mod syntax;
mod table;
mod text;
mod tokens;
mod wrap;

pub use annotated::{Annotated, Part};
pub use ascii::ascii;
pub use c::{BadPrefix, CCode, ConstantTooLarge, Origin, Prefix, c_code, c_code_of_file};
pub use evidence::{evidence, refusals};
pub use formula::Formula;
pub use heading::{GENERATED, Heading};
pub use inert::{markdown, title, verbatim};
pub use listing::{Folds, Line, Listing, Section, Selection, listing, reason};
pub use own_tests::{Golden, c_tests, rust_tests};
pub use signature::ArgumentArray;
pub use steps::steps;
pub use syntax::Precision;
pub use table::{angle, operations_table};
pub use text::{rust_file, rust_file_with_sin_cos};
pub use tokens::Body;

use crate::program::Program;

/// The variables that stand in the code of a program beside its own, in Rust or in C.
pub(crate) fn locals(program: &Program) -> impl Iterator<Item = &'static str> {
    let arrays = signature::arguments(program).into_iter().map(|array| array.name);
    arrays.chain(["parameters", "zero"]).chain(c::locals(program))
}

#[cfg(test)]
mod tests {
    use crate::{Compiler, Form, Function};

    #[test]
    fn variables_of_the_emitters_are_taken() {
        let robot = rne_model::Reader::new("planar2").read(include_str!("../../../robots/planar2.yaml")).unwrap().robot;
        let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::SevenSteps).unwrap();
        let locals: Vec<_> = super::locals(&program).collect();
        for local in ["q", "qd", "qdd", "zero", "unused", "tau"] {
            assert!(locals.contains(&local), "{locals:?}");
        }
    }
}
