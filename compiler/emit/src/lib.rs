//! Writes programs as text: tokens for the macro, readable Rust and C, listings.
//!
//! The input is a [`Program`](rne_codegen::Program) of `rne-codegen`, the output text or tokens. Nothing here changes
//! what is computed.
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]

mod annotated;
mod ascii;
mod c;
mod cuda;
mod emitted_sine;
mod evidence;
mod expression;
mod fmi;
mod formula;
mod heading;
mod inert;
mod line_breaks;
mod listing;
mod own_tests;
mod parameters;
mod ptx;
mod steps;
mod syntax;
mod table;
mod text;
mod tokens;
mod wrap;

pub use annotated::{Annotated, Part};
pub use ascii::ascii;
pub use c::{
    Additions, BadPrefix, CCode, ConstantTooLarge, JointFriction, NoFriction, Origin, Prefix, c_code, c_code_with,
    casadi_collision, casadi_derivatives, is_for_casadi, record_name, result_elements,
};
pub use cuda::cuda;
pub use emitted_sine::sin_cos_f32;
pub use evidence::{evidence, losses, refusals};
pub use fmi::{FmiVersion, Fmu, FmuCausality, with_inertial_parameters};
pub use formula::Formula;
pub use heading::{GENERATED, Heading};
pub use inert::{markdown, title, verbatim};
pub use listing::{Folds, Line, Listing, Section, Selection, listing, reason};
pub use own_tests::{Golden, c_tests, rust_tests, without_c_tests};
pub use ptx::{is_for_rollouts, ptx};
pub use steps::steps;
pub use syntax::Precision;
pub use table::{angle, operations_table};
pub use text::{meaning, rust_file, rust_file_with_sin_cos, rust_joints};
pub use tokens::Body;

#[cfg(test)]
mod tests {
    use rne_codegen::{Compiler, Form, Function};

    /// Tests that no number has the name of a variable that renderers add.
    #[test]
    fn variables_of_the_renderers_are_reserved() {
        let robot = rne_model::Robot::from_yaml(rne_robots::find("planar2").unwrap().yaml).unwrap();
        let compiler = Compiler::new(&robot);
        for function in Function::OF_TREES {
            let program = compiler.compile(function, Form::SevenSteps).unwrap();
            let reserved: Vec<_> = program.reserved_names().collect();
            let arrays = program.argument_arrays().into_iter().chain(crate::c::inputs(&program));
            let own = arrays.map(|array| array.name).chain(["parameters", "zero", crate::c::UNUSED]);
            for name in own.chain([function.entry().output]) {
                assert!(reserved.contains(&name), "{function}: {name} is not among {reserved:?}");
            }
        }
    }
}
