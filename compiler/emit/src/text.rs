//! Writes programs as a readable Rust file that compiles by itself: it begins with the robot, its table, the operation
//! counts and the meaning of each name.

mod function;
mod piece;

use std::collections::BTreeSet;
use std::fmt::Write;

use rne_codegen::{Name, Program, Quantity};
use rne_model::{JointIdentifier, Robot};

use self::function::function;
use self::piece::Piece;
use super::annotated::Annotated;
use super::evidence::{evidence, losses, refusals};
use super::heading::Heading;
use super::inert::{markdown, verbatim};
use super::parameters::{self, Parameter};
use super::table::operations_table;
use super::wrap::{WIDTH, fill};

pub(super) use self::function::returned;

/// Returns a Rust file with the programs of one robot as functions, and the one trait that they need.
#[must_use]
pub fn rust_file(robot: &Robot, programs: &[Program]) -> String {
    file(robot, programs, SinCos::OfCaller)
}

/// Returns the file of [`rust_file`] with an implementation of the trait for `f64` and `f32`: sine and cosine have the
/// bits of rne's runtime without fused multiply-add, for angles up to 1e5 rad. The file then needs nothing else, also
/// in `no_std`.
#[must_use]
pub fn rust_file_with_sin_cos(robot: &Robot, programs: &[Program]) -> String {
    file(robot, programs, SinCos::InFile)
}

/// Returns code for the names of the joints in such a file: an enum with their indices in arrays, and an array of the
/// names. If two joints have one identifier, the code does not compile;
/// [`Checked::identifiers`](rne_model::Checked::identifiers) returns the error in this case.
#[must_use]
pub fn rust_joints(robot: &Robot) -> String {
    let mut text = "\n/// The joints; `joint as usize` is the index of a joint in arrays.\n\
                    #[allow(clippy::enum_variant_names)]\n\
                    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]\npub enum Joint {\n"
        .to_owned();
    for (index, joint) in robot.independent_joints().enumerate() {
        let JointIdentifier { camel_case, .. } = JointIdentifier::of(&joint.name, index);
        let _ = writeln!(text, "    /// {}\n    {camel_case},", markdown(&joint.name));
    }
    let names = robot.independent_joints().map(|joint| Piece::Number(Annotated::from(format!("{:?}", joint.name))));
    let names = Piece::List('[', ']', names.collect()).broken(0);
    let _ = writeln!(
        text,
        "}}\n\n/// The names of the joints, in the order of arrays.\npub const JOINTS: [&str; {}] = {names};",
        robot.dof()
    );
    text
}

/// Who provides the sine and cosine of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum SinCos {
    OfCaller,
    InFile,
}

/// The implementation of the trait for `f64` and `f32`, without the method that chooses by a sign.
const WITH_SIN_COS: [&str; 2] = [include_str!("sin_cos_f64.rs"), include_str!("sin_cos_f32.rs")];

fn file(robot: &Robot, programs: &[Program], sin_cos: SinCos) -> String {
    let mut text = header(robot, programs, sin_cos);
    text.push_str(&scalar(programs, sin_cos));
    if sin_cos == SinCos::InFile {
        let chooses = programs.iter().any(Program::chooses_by_sign);
        let by_sign = if chooses { format!("\n{BY_SIGN_OF_FLOAT}") } else { String::new() };
        for implementation in WITH_SIN_COS {
            let methods = implementation.trim_end().trim_end_matches('}');
            let _ = write!(text, "\n{methods}{by_sign}}}\n");
        }
    }
    if programs.iter().any(parameters::are_used) {
        text.push_str(&record_of_parameters(robot));
    }
    for program in programs {
        text.push('\n');
        text.push_str(&function(robot, program, sin_cos));
    }
    text
}

/// Returns the struct that is the last argument of a function with run-time parameters.
fn record_of_parameters(robot: &Robot) -> String {
    let parameters = Parameter::of(robot, parameters::OF_RUST);
    let (mut fields, mut values) = (String::new(), String::new());
    for parameter in &parameters {
        let documentation = fill(&markdown(&parameter.about()), WIDTH, "    /// ", "    /// ");
        let _ = writeln!(fields, "{documentation}\n    pub {}: T,", parameter.member);
        let _ = writeln!(values, "            {}: Scalar::from_f64({:?}),", parameter.member, parameter.value);
    }
    format!(
        "\n/// Parameters of the robot file that are given at run time.\n\
         #[derive(Clone, Copy, Debug, PartialEq)]\n#[allow(non_snake_case)] // names of the file\n\
         pub struct Parameters<T> {{\n{fields}}}\n\n\
         #[allow(clippy::all, clippy::pedantic)]\nimpl<T: Scalar> Parameters<T> {{\n    /// Their \
         values in the file.\n    \
         #[must_use]\n    pub fn of_file() -> Self {{\n        Self {{\n{values}        }}\n    }}\n}}\n"
    )
}

/// Returns the trait that the generated functions need of a number type; the body of a function uses nothing else.
fn scalar(programs: &[Program], sin_cos: SinCos) -> String {
    let divides = programs.iter().any(|program| program.operations().div > 0);
    let chooses = programs.iter().any(Program::chooses_by_sign);
    let (imported, bounds) = if divides {
        (
            "Add, Div, Mul, Neg, Sub",
            "    Copy\n    + Neg<Output = Self>\n    + Add<Output = Self>\n    + Sub<Output = Self>\n    \
             + Mul<Output = Self>\n    + Div<Output = Self>",
        )
    } else {
        (
            "Add, Mul, Neg, Sub",
            "    Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>",
        )
    };
    let array = if sin_cos == SinCos::OfCaller { SIN_COS_ARRAY } else { "" };
    let by_sign = if chooses { BY_SIGN } else { "" };
    format!(
        "\nuse core::ops::{{{imported}}};\n\n/// A number: `f64`, `f32`, or any type with these operations.\n\
         pub trait Scalar:\n{bounds}\n{{\n{METHODS}{array}{by_sign}}}\n"
    )
}

const BY_SIGN: &str = "    /// `positive` where it is above 0, `negative` where it is below, else 0.
    fn by_sign(self, positive: Self, negative: Self) -> Self;
";

const METHODS: &str = "    /// A constant of the robot, rounded once.
    fn from_f64(value: f64) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);
";

const SIN_COS_ARRAY: &str = "    /// The sines and the cosines of several angles in rad.
    fn sin_cos_array<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let pairs = angles.map(Self::sin_cos);
        (pairs.map(|pair| pair.0), pairs.map(|pair| pair.1))
    }
";

fn header(robot: &Robot, programs: &[Program], sin_cos: SinCos) -> String {
    let heading = Heading::of(robot);
    let mut text = format!("{}\n\n{}\n\n", Heading::opening(&markdown(&heading.title)), Heading::mark(robot));
    let _ = writeln!(text, "{}\n", verbatim(&format!("{}\n\n{}", heading.frames, heading.table)));
    for line in parameters::heading(robot) {
        let _ = writeln!(text, "{}\n", fill(&markdown(&line), WIDTH - 4, "", ""));
    }
    if let Some((program, proof)) = programs.iter().find_map(|program| Some((program, program.proof.as_ref()?))) {
        let _ = writeln!(text, "{}\n", verbatim(&evidence(program, proof).join("\n")));
    }
    for lines in programs.iter().map(refusals).chain([losses(programs)]).filter(|lines| !lines.is_empty()) {
        let _ = writeln!(text, "{}\n", verbatim(&lines.join("\n")));
    }
    text.push_str("Operations of one call, of the recursion -> of the code below:\n\n");
    text.push_str(&operations_table(programs));
    text.push_str(
        "\nNames, for link or joint `i` and axis `x`, in frame `i` at joint `i`, fixed to link `i`:\n\n\
         | name | meaning |\n|---|---|\n",
    );
    for (pattern, meaning) in legend(robot, programs) {
        // a bar would end the cell of the table, and brackets would be a link
        let meaning = meaning.replace('|', "\\|").replace('[', "\\[");
        let _ = writeln!(text, "| `{pattern}` | {meaning} |");
    }
    text.push('\n');
    text.push_str(&match sin_cos {
        SinCos::OfCaller => scalar_of_caller(programs),
        SinCos::InFile => IN_FILE.to_owned(),
    });
    text.lines().map(|line| format!("//! {line}").trim_end().to_owned() + "\n").collect()
}

/// Returns the text that shows how a caller implements the trait.
fn scalar_of_caller(programs: &[Program]) -> String {
    let by_sign = if programs.iter().any(Program::chooses_by_sign) { BY_SIGN_OF_STD } else { "" };
    format!(
        "The scalar, in `std`:\n\n```ignore\n{SCALAR_OF_STD}{by_sign}}}\n```\n\n\
         `core` has no sine: in `no_std`, `sin_cos` is the one you have (the crate `libm`, a CORDIC unit); or take\n\
         `inverse_dynamics_from_sin_cos`, whose sines and cosines are arguments, and which never calls it.\n"
    )
}

const IN_FILE: &str =
    "The file needs nothing but `core`: sine and cosine of `f64` and `f32` are in it, for angles up to 1e5 rad.
";

const SCALAR_OF_STD: &str = "impl Scalar for f64 {
    fn from_f64(value: f64) -> Self { value }
    fn sin_cos(self) -> (Self, Self) { f64::sin_cos(self) }
";

const BY_SIGN_OF_STD: &str = "    fn by_sign(self, positive: Self, negative: Self) -> Self {
        if self > 0.0 { positive } else if self < 0.0 { negative } else { 0.0 }
    }
";

const BY_SIGN_OF_FLOAT: &str = "    fn by_sign(self, positive: Self, negative: Self) -> Self {
        if self > 0.0 {
            positive
        } else if self < 0.0 {
            negative
        } else {
            0.0
        }
    }
";

/// Returns every kind of name that occurs, with its meaning.
pub(super) fn legend(robot: &Robot, programs: &[Program]) -> Vec<(String, &'static str)> {
    let mut names = BTreeSet::new();
    for program in programs {
        let constants = program.constants().map(|constant| constant.name);
        let statements = program.angles.iter().chain(&program.statements).map(|statement| statement.name);
        let turns = program.sines_and_cosines.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten();
        // if a name has different meanings in different functions, each meaning has its own line
        names.extend(constants.chain(statements).chain(turns).map(|Name { quantity, .. }| {
            let own = rne_codegen::own(program.function, quantity).and_then(|own| own.meaning);
            (quantity, own.unwrap_or_else(|| meaning(robot, quantity)))
        }));
    }
    names.into_iter().map(|(quantity, meaning)| (quantity.pattern(), meaning)).collect()
}

/// Returns the meaning of a quantity in the code of a robot. On a serial arm the link before link i is link i - 1.
#[must_use]
pub fn meaning(robot: &Robot, quantity: Quantity) -> &'static str {
    let of_tree = if robot.is_serial() { None } else { meaning_in_tree(quantity) };
    of_tree.unwrap_or_else(|| quantity.meaning())
}

/// Returns the meaning of a quantity whose usual description mentions the next joint or the link before; in a tree
/// there may be several or none.
const fn meaning_in_tree(quantity: Quantity) -> Option<&'static str> {
    Some(match quantity {
        Quantity::R => {
            "r: centre of mass → first joint that the link carries; to another joint j that it carries: ri_x_j"
        }
        Quantity::Rotation => "R: frame i → frame of the link that carries joint i",
        Quantity::ChildForce | Quantity::TurnedForce => "f of a joint that the link carries, in axes of this link",
        Quantity::ChildMoment | Quantity::TurnedMoment => "n of a joint that the link carries, in axes of this link",
        Quantity::JointForce => "force exerted on link i by link h, which carries joint i",
        Quantity::JointMoment => "moment exerted on link i by link h, which carries joint i, about joint i",
        _ => return None,
    })
}

/// Returns a sentence about the frame that replaces the tip; `None` for a program of the tip.
pub(super) fn about_frame(program: &Program) -> Option<String> {
    let frame = program.frame.as_ref()?;
    Some(format!("The frame {frame} stands in the place of the tip, and its link in the place of the last link."))
}
