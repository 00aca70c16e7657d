//! One page of HTML in which a robot arm's dynamics can be inspected: the arm in 3-D, the seven steps joint by joint,
//! equations, code and numbers side by side, and torques over a motion. The page needs no network and no installation.
//!
//! [`page`] makes the page. It contains the inspection ([`rne_inspection`]) as JSON and evaluates it, without other
//! code for dynamics. This crate does not read files and does not print.
//!
//! ```
//! let file = rne_robots::find("planar2").expect("it is shipped");
//! let robot = rne_model::Robot::from_yaml(file.yaml)?;
//! let page = rne_report::page(&robot, None)?;
//! assert!(page.starts_with("<!doctype html>"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod data;
mod template;

use std::fmt::Write as _;

use rne_codegen::{CompileError, Compiler, Form, Function, Program};
use rne_model::Robot;

pub use crate::data::data;

/// The parts of every page other than its data.
const HTML: &str = include_str!("../web/index.html");
const STYLE: &str = include_str!("../web/style.css");

/// The scripts of the page in order: each uses only earlier ones.
pub const SCRIPTS: [(&str, &str); 24] = [
    ("pose.js", include_str!("../web/pose.js")),
    ("inspection.js", include_str!("../web/inspection.js")),
    ("program.js", include_str!("../web/program.js")),
    ("number.js", include_str!("../web/number.js")),
    ("field.js", include_str!("../web/field.js")),
    ("equation.js", include_str!("../web/equation.js")),
    ("axes.js", include_str!("../web/axes.js")),
    ("shape.js", include_str!("../web/shape.js")),
    ("label.js", include_str!("../web/label.js")),
    ("gesture.js", include_str!("../web/gesture.js")),
    ("drawing.js", include_str!("../web/drawing.js")),
    ("arm.js", include_str!("../web/arm.js")),
    ("torque.js", include_str!("../web/torque.js")),
    ("motion.js", include_str!("../web/motion.js")),
    ("wrench.js", include_str!("../web/wrench.js")),
    ("base.js", include_str!("../web/base.js")),
    ("exercise.js", include_str!("../web/exercise.js")),
    ("cell.js", include_str!("../web/cell.js")),
    ("reading.js", include_str!("../web/reading.js")),
    ("view.js", include_str!("../web/view.js")),
    ("address.js", include_str!("../web/address.js")),
    ("handin.js", include_str!("../web/handin.js")),
    ("table.js", include_str!("../web/table.js")),
    ("page.js", include_str!("../web/page.js")),
];

/// Makes the page of an arm. Units are SI: m, rad, N, N m.
///
/// `reduced` is the program of [`rne_codegen::function_of_plan`] in the reduced form, by any plan for the arm. If it is
/// `None`, the program is compiled without a plan. This function is the inverse dynamics; for a robot with a floating
/// base, it has the motion of the base and wrenches at the tips as arguments.
///
/// # Errors
/// When the inverse dynamics do not compile: [`Compiler::compile`].
pub fn page(robot: &Robot, reduced: Option<&Program>) -> Result<String, CompileError> {
    let compiler = Compiler::new(robot);
    let function = rne_codegen::function_of_plan(robot);
    let own = match reduced {
        Some(_) => None,
        None => Some(compiler.compile(function, Form::Reduced)?),
    };
    let with_wrench = match robot.floating_base {
        Some(_) => None,
        None => Some(compiler.compile(Function::InverseDynamicsWithWrench, Form::SevenSteps)?),
    };
    let torques = Compiler::new(robot).with_equations().compile(function, Form::SevenSteps)?;
    let data = data(robot, &torques, with_wrench.as_ref(), reduced.or(own.as_ref()));
    let mut script = String::new();
    for (name, text) in SCRIPTS {
        let _ = write!(script, "\n// ---- {name}\n\n{}", template::code(text));
    }
    let parts = [
        ("title", template::text(&rne_emit::title(robot))),
        ("style", template::code(STYLE)),
        ("data", template::json(data)),
        ("script", script),
    ];
    Ok(template::filled(&template::code(HTML), &parts))
}
