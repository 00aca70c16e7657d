//! Writes the trace for the independent checker: the table of the arm, and the exact expressions of the constants.

use std::collections::BTreeMap;
use std::path::Path;

use rne_certify::sha256;
use rne_codegen::{Derivation, ExactConstant, ExactStep, Function, Program};
use rne_emit::{Precision, Prefix};
use rne_model::{Angle, InertiaReference, QuarterTurns, Robot, Transform};
use serde_json::{Value, json};

use crate::commands::certify::code::stem;
use crate::commands::certify::{Arguments, Language};
use crate::commands::emit::Real;
use crate::files::output_file::{self, Existing};
use crate::files::output_folder;
use crate::files::plan_file::Compiler;
use crate::outcome::Failure;
use crate::palette::{TITLE, TYPED};

/// The functions that the checker computes.
const CHECKED: [Function; 3] = [Function::InverseDynamics, Function::BiasTorques, Function::GravityTorques];

/// Refuses options for code that the checker cannot read.
pub(super) fn check_options(arguments: &Arguments, functions: &[Function]) -> Result<(), Failure> {
    if arguments.lang == Language::C && functions.iter().any(|function| CHECKED.contains(function)) {
        return Ok(());
    }
    Err(usage_error!(
        "{TYPED}--evidence{TYPED:#} is for code in C with one of {}, which the checker computes; give one of them in \
         {TYPED}--function{TYPED:#}",
        CHECKED.map(Function::name).join(", ")
    ))
}

/// Returns the keys of the robot file that the checker does not support.
fn not_supported(robot: &Robot) -> Vec<&'static str> {
    let keys = [
        ("couplings", robot.has_couplings()),
        ("motors", !robot.drives.is_empty()),
        ("bodies", !robot.bodies.list.is_empty()),
        ("floating_base", robot.floating_base.is_some()),
    ];
    keys.into_iter().filter(|(_, is_there)| *is_there).map(|(key, _)| key).collect()
}

/// Writes the C code, its header and the trace of its constants. Returns a note if the checker does not support the
/// robot.
pub(super) fn write(
    arguments: &Arguments,
    evidence: &Path,
    robot: &Robot,
    programs: &[Program],
    bytes: &[u8],
) -> Result<String, Failure> {
    let checked = programs.iter().filter(|program| CHECKED.contains(&program.function));
    let compiler = Compiler::new(&arguments.file, robot);
    let precision = arguments.real.map_or(Precision::Single, Real::precision);
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    let mut functions = Vec::new();
    for program in checked.clone() {
        let Some(derivation) = compiler.derivation(program)? else {
            return Err(usage_error!(
                "{TYPED}--evidence{TYPED:#} is for {TYPED}--form reduced{TYPED:#}: the constants of this code are \
                 rounded one operation after another, so they have no exact expressions"
            ));
        };
        functions.push(function(program, &derivation, &prefix));
    }
    let (code, stem) = (arguments.c_code(robot, programs, bytes, precision)?, stem(arguments, robot));
    let header = format!("{stem}.h");
    let source = code.source(&header);
    let names = checked.map(|program| format!("{prefix}_{}", program.function)).collect::<Vec<_>>();
    let mut trace = json!({
        "prefix": prefix.to_string(),
        "real": precision.c_type(),
        "functions": functions,
        "texts": texts(&source, prefix.as_str(), precision.c_type(), &names),
        "table": table(robot),
    });
    let unsupported = not_supported(robot);
    if !unsupported.is_empty() {
        trace["not_supported"] = json!(unsupported);
    }
    let trace = serde_json::to_string_pretty(&trace).map_err(Failure::input)? + "\n";
    output_folder::make(evidence)?;
    let files = [
        (evidence.join(format!("{stem}.c")), source),
        (evidence.join(&header), code.header().to_owned()),
        (evidence.join(format!("{stem}.trace.json")), trace),
    ];
    for (path, text) in &files {
        if !may_be_replaced(path, text, arguments.force) {
            return Err(usage_error!("{} is not changed: rne did not write it", path.display()));
        }
    }
    output_file::replace_all(&files)?;
    if unsupported.is_empty() {
        return Ok(String::new());
    }
    Ok(format!(
        "{TITLE}note{TITLE:#}: check_c.py does not support robots with {}, so it does not check this code\n",
        unsupported.join(", ")
    ))
}

/// Returns whether a file may be written at a path: nothing is there, the same text is there, rne wrote the text, or
/// `force` allows to overwrite it.
fn may_be_replaced(path: &Path, text: &str, force: bool) -> bool {
    match output_file::existing(path) {
        Existing::Nothing => true,
        Existing::Text(found) => {
            found == text || force || found.contains(rne_emit::GENERATED) || found.contains("\"steps\"")
        }
        _ => false,
    }
}

/// Returns the constants of a function with their exact expressions.
fn function(program: &Program, derivation: &Derivation, prefix: &Prefix) -> Value {
    let steps: Vec<Value> = derivation.steps.iter().map(step).collect();
    let constants: serde_json::Map<String, Value> = derivation
        .constants
        .iter()
        .map(|(name, exact)| {
            let exact = match exact {
                ExactConstant::Number(place) => json!(place),
                ExactConstant::Angle { sine, cosine } => json!({"sin": sine, "cos": cosine}),
            };
            (name.to_string(), exact)
        })
        .collect();
    json!({"function": format!("{prefix}_{}", program.function), "steps": steps, "constants": constants})
}

/// Returns the SHA-256 of each function of a source that the checker does not compute: of its text from the parameters
/// on, without comments and with one blank between words.
fn texts(source: &str, prefix: &str, real: &str, checked: &[String]) -> BTreeMap<String, String> {
    let heads = ["void", real, &format!("static {real}")].map(|kind| format!("\n{kind} {prefix}_"));
    let functions = rne_emit::without_c_tests(source).split("\n}\n").filter_map(|part| {
        let start = heads.iter().filter_map(|head| part.rfind(head.as_str())).max()?;
        let (head, text) = part.get(start..)?.split_once('(')?;
        let words = text.lines().flat_map(|line| line.split("//").next().unwrap_or(line).split_whitespace());
        let text = words.collect::<Vec<_>>().join(" ");
        Some((head.split_whitespace().last()?.to_owned(), sha256(text.as_bytes())))
    });
    functions.filter(|(name, _)| !checked.contains(name)).collect()
}

/// Returns a step as JSON: its operator, and the indices of its operands. Numbers are texts, which keep all digits.
fn step(step: &ExactStep) -> Value {
    match step {
        ExactStep::Decimal(value) => json!(["number", format!("{value:?}")]),
        ExactStep::Sine(angle) => json!(["sin", format!("{angle:?}")]),
        ExactStep::Cosine(angle) => json!(["cos", format!("{angle:?}")]),
        ExactStep::Negative(a) => json!(["-", a]),
        ExactStep::Sum(a, b) => json!(["+", a, b]),
        ExactStep::Product(a, b) => json!(["*", a, b]),
        ExactStep::Inverse(a) => json!(["/", a]),
        ExactStep::Root(a) => json!(["sqrt", a]),
    }
}

/// Returns the Denavit-Hartenberg table with the links as JSON, with the numbers that the compiler uses.
fn table(robot: &Robot) -> Value {
    let text = |x: f64| format!("{x:?}");
    // an angle within some units in the last place of a right angle is taken for this right angle
    let angle = |angle: &Angle| match angle.right {
        Some(QuarterTurns::Zero) => text(0.0),
        Some(QuarterTurns::One) => text(std::f64::consts::FRAC_PI_2),
        Some(QuarterTurns::Two) => text(std::f64::consts::PI),
        Some(QuarterTurns::Three) => text(-std::f64::consts::FRAC_PI_2),
        None => text(angle.radians),
    };
    let is_tree = robot.joints.iter().any(|joint| joint.branch.is_some());
    let joints: Vec<Value> = robot
        .joints
        .iter()
        .enumerate()
        .map(|(index, joint)| {
            let (dh, link) = (&joint.row.dh, &joint.row.link);
            let (inertia, reference) = &joint.written_inertia;
            let inertia = [inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.xz, inertia.yz];
            let mut row = json!({
                "name": joint.name,
                "type": joint.row.kind.name(),
                "theta": angle(&dh.theta),
                "d": text(dh.d),
                "a": text(dh.a),
                "alpha": angle(&dh.alpha),
                "mass": text(link.mass),
                "com": link.com.map(text),
                "inertia": inertia.map(text),
                "inertia_about": if *reference == InertiaReference::Com { "com" } else { "origin" },
            });
            if robot.has_rotors() {
                let rotor = joint.motor.map_or([1.0, 0.0], |motor| [motor.gear_ratio, motor.inertia]);
                row["rotor"] = json!(rotor.map(text));
            }
            if is_tree {
                let placement = joint.branch.map_or(Transform::IDENTITY, |branch| branch.placement);
                // joints are counted from 1 here, so that 0 is the base
                row["parent"] = json!(robot.parent(index).map_or(0, |parent| parent + 1).to_string());
                row["xyz"] = json!(placement.xyz.map(text));
                row["rpy"] = json!(placement.rpy.each_ref().map(angle));
            }
            row
        })
        .collect();
    json!({"convention": robot.convention.name(), "gravity": robot.gravity.map(text), "joints": joints})
}
