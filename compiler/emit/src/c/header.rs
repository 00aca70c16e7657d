//! The C header: the robot, the properties that all functions share, and what each function does.

use std::fmt::Write;

use rne_codegen::{Argument, Function, Name, Program, Quantity};
use rne_model::{Joint, JointIdentifier};

use super::signature::{fields, head, parameters_type, record_type, records};
use super::{ConstantTooLarge, File, comment, joint_functions, motors, observer, runge_kutta};
use crate::evidence::{evidence, losses, refusals};
use crate::heading::Heading;
use crate::parameters::{self, Parameter};
use crate::syntax::Precision;
use crate::text::about_frame;
use crate::wrap::{TIED, WIDTH, fill};
use crate::{inert, table};

/// Returns the beginning of the header and of the source.
pub(crate) fn title(file: &File) -> String {
    let title = comment("//", &Heading::opening(&inert::title(file.robot)));
    let by = concat!("rne ", env!("CARGO_PKG_VERSION"));
    let by = file.additions.origin.map_or(by.to_owned(), |origin| format!("{by}, of the robot file {origin}"));
    format!("{title}//\n// {}\n{}", Heading::mark(file.robot), comment("//", &by))
}

pub(super) fn header(file: &File) -> Result<String, ConstantTooLarge> {
    let upper = file.prefix.to_ascii_uppercase();
    let mut text = title(file);
    text.push_str(&robot(file));
    text.push_str(&contract(file));
    text.push_str(&counts(file.programs));
    let _ = writeln!(text, "\n#ifndef {upper}_H\n#define {upper}_H\n");
    text.push_str("#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n");
    let _ = writeln!(text, "/// Number of joints.\n#define {upper}_DOF {}u", file.robot.dof());
    if file.additions.names {
        text.push_str(&joints(file, &upper));
    }
    text.push_str(&tips(file, &upper));
    text.push_str(&limits(file, &upper));
    text.push_str(&parameters(file, &upper)?);
    for (record, parts) in records(file) {
        let (about, name) = (comment("///", record.about()), record_type(file, record));
        let _ = writeln!(text, "\n{about}typedef struct {{");
        for field in fields(file, record, &parts) {
            let _ = writeln!(text, "    {field};");
        }
        let _ = writeln!(text, "}} {name};");
    }
    for program in file.programs {
        text.push('\n');
        text.push_str(&comment("///", program.function.summary()));
        let details = program.function.details();
        if !details.is_empty() {
            text.push_str(&comment("///", details));
        }
        for function in referred(file, program.function) {
            text.push_str(&comment("///", &format!("{function}, not in this header: {}", function.details())));
        }
        if let Some(frame) = about_frame(program) {
            text.push_str(&comment("///", &frame));
        }
        let _ = writeln!(text, "{};", head(file, program));
    }
    text.push_str(&runge_kutta::declarations(file));
    text.push_str(&observer::declarations(file));
    text.push_str(&joint_functions::declarations(file));
    text.push_str(&motors::declarations(file));
    text.push_str("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n");
    Ok(text)
}

/// Returns the functions that the description of a function mentions but the header does not have. For chains none is
/// returned, so that their headers keep the same bytes.
fn referred(file: &File, function: Function) -> Vec<Function> {
    if file.robot.is_serial() && file.robot.floating_base.is_none() {
        return Vec::new();
    }
    let mut referred = Vec::new();
    let mut open = vec![function];
    while let Some(function) = open.pop() {
        let names = function.details().split("as in ").skip(1);
        let names = names.filter_map(|words| words.split(|c: char| !c.is_ascii_lowercase() && c != '_').next());
        for other in names.filter_map(Function::named) {
            let is_there = file.programs.iter().any(|program| program.function == other);
            if !is_there && !referred.contains(&other) {
                referred.push(other);
                open.push(other);
            }
        }
    }
    referred
}

/// Writes the struct of the run-time parameters, and an initialiser with the values of the robot file.
fn parameters(file: &File, upper: &str) -> Result<String, ConstantTooLarge> {
    let Some(program) = file.programs.iter().find(|program| parameters::are_used(program)) else {
        return Ok(String::new());
    };
    let (real, name) = (file.precision.c_type(), parameters_type(file));
    let parameters = Parameter::of(file.robot, parameters::OF_C);
    let mut text = "\n/// Parameters of the robot file that are given at run time.\ntypedef struct {\n".to_owned();
    let mut values = Vec::new();
    for (index, parameter) in parameters.iter().enumerate() {
        for line in comment("///", &parameter.about()).lines() {
            let _ = writeln!(text, "    {line}");
        }
        let _ = writeln!(text, "    {real} {};", parameter.member);
        let value = file.precision.literal(parameter.value);
        values.push(value.ok_or(ConstantTooLarge {
            name: Name::scalar(Quantity::Parameter, index + 1),
            value: parameter.value,
            function: program.function,
        })?);
    }
    let _ = writeln!(text, "}} {name};\n");
    text.push_str(&comment("///", &format!("Their values in the file: `const {name} x = {upper}_PARAMETERS;`")));
    text.push_str(&initialiser(&format!("{upper}_PARAMETERS"), &values));
    Ok(text)
}

/// Returns a macro with the numbers that initialise an array or a struct.
fn initialiser(name: &str, numbers: &[String]) -> String {
    let start = format!("#define {name} {{");
    let numbers = numbers.join(", ");
    if start.len() + numbers.len() < WIDTH {
        return format!("{start}{numbers}}}\n");
    }
    // a backslash continues the definition on the next line
    let lines = fill(&numbers, WIDTH - 2, "    ", "    ").replace('\n', " \\\n");
    format!("{start} \\\n{lines}}}\n")
}

/// Writes an enum with the index of each joint, and one for the dependent joints of closed loops.
fn joints(file: &File, upper: &str) -> String {
    let robot = file.robot;
    let indices = |about: &str, kind: &str, joints: &mut dyn Iterator<Item = &Joint>| {
        let mut text = format!("\n/// {about}\nenum {{\n");
        for (index, joint) in joints.enumerate() {
            let JointIdentifier { upper_case, .. } = JointIdentifier::of(&joint.name, index);
            let name = inert::c_comment(&joint.name);
            let _ = writeln!(text, "    /// {name}\n    {upper}_{kind}_{upper_case} = {index},");
        }
        text + "};\n"
    };
    let text = indices("Indices of the joints in arrays, by their names.", "JOINT", &mut robot.independent_joints());
    let passive = (!robot.closed.is_empty()).then(|| {
        let about = "Indices of the dependent joints in `passive`, and of their rows in the map, by their names.";
        let count = robot.closed.passive.len();
        let count =
            format!("\n/// Number of dependent joints, the length of `passive`.\n#define {upper}_PASSIVE {count}u\n");
        count + &indices(about, "PASSIVE", &mut robot.closed.passive.iter().map(|&joint| &robot.joints[joint]))
    });
    text + &passive.unwrap_or_default() + "\n"
}

/// Writes an enum with the index of each tip, if a function takes or returns something for each tip.
fn tips(file: &File, upper: &str) -> String {
    if !file.programs.iter().any(|program| program.function.has_tips()) {
        return String::new();
    }
    let takes_wrenches = file.programs.iter().any(|program| program.function.takes(Argument::Wrenches));
    let arrays = if takes_wrenches { "arrays of wrenches" } else { "arrays" };
    let mut text = format!("/// Indices of the tips in {arrays}, by their names.\nenum {{\n");
    let tips = file.robot.tip_names().into_iter().zip(file.robot.wrench_frames());
    for (index, (name, frame)) in tips.enumerate() {
        let JointIdentifier { upper_case, .. } = JointIdentifier::of(name, index);
        let link = frame.on.and_then(|on| file.robot.joints.get(on));
        let link = link.map_or("the base".to_owned(), |joint| format!("the link of {}", inert::c_comment(&joint.name)));
        // without the list `tips`, the bytes of the header stay as they were before it existed
        let on = if file.robot.tips.is_empty() { String::new() } else { format!(", on {link}") };
        let _ = writeln!(text, "    /// {name}{on}\n    {upper}_TIP_{upper_case} = {index},");
    }
    text + "};\n\n"
}

/// Writes the limits of the joints as initialisers of arrays; a kind of limit that no joint has is left out.
fn limits(file: &File, upper: &str) -> String {
    let precision = file.precision;
    let largest = match precision {
        Precision::Single => f64::from(f32::MAX),
        Precision::Double => f64::MAX,
    };
    let of_joints = file.robot.coordinate_limits();
    let limits = || of_joints.iter();
    let kinds: [(&str, &str, f64, Vec<Option<f64>>); 4] = [
        (
            "POSITION_LOWER",
            "Lowest positions, rad or m",
            -largest,
            limits().map(|limits| Some(limits.position?.0)).collect(),
        ),
        (
            "POSITION_UPPER",
            "Highest positions, rad or m",
            largest,
            limits().map(|limits| Some(limits.position?.1)).collect(),
        ),
        ("VELOCITY_LIMIT", "Largest speeds, rad/s or m/s", largest, limits().map(|limits| limits.velocity).collect()),
        (
            "EFFORT_LIMIT",
            "Largest torques or forces, N m or N",
            largest,
            limits().map(|limits| limits.effort).collect(),
        ),
    ];
    let mut text = String::new();
    for (name, about, none, values) in kinds {
        if values.iter().all(Option::is_none) {
            continue;
        }
        let number = |value: &Option<f64>| {
            let value = value.unwrap_or(none).clamp(-largest, largest);
            precision.literal(value).unwrap_or_default()
        };
        let unlimited =
            if values.iter().any(Option::is_none) { "; the largest number where there is no limit" } else { "" };
        text.push_str(&comment(
            "///",
            &format!("{about}{unlimited}: `const {0} x[] = {upper}_{name};`", precision.c_type()),
        ));
        let numbers: Vec<String> = values.iter().map(number).collect();
        text.push_str(&initialiser(&format!("{upper}_{name}"), &numbers));
    }
    text
}

/// Writes the conventions and the table of the robot, and why the code can be trusted.
pub(crate) fn robot(file: &File) -> String {
    let Heading { frames, table, .. } = Heading::of(file.robot);
    let mut text = "//\n".to_owned();
    for line in frames.lines().chain([""]).chain(table.lines()) {
        let _ = writeln!(text, "{}", format!("//   {}", inert::c_comment(line)).trim_end());
    }
    let parameters = parameters::heading(file.robot);
    if !parameters.is_empty() {
        text.push_str("//\n");
        for line in &parameters {
            text.push_str(&comment("//", line));
        }
    }
    let proved = file.programs.iter().find_map(|program| Some((program, program.proof.as_ref()?)));
    let evidence = proved.map(|(program, proof)| evidence(program, proof));
    let others = file.programs.iter().map(refusals).chain([losses(file.programs)]).filter(|lines| !lines.is_empty());
    for lines in evidence.into_iter().chain(others) {
        text.push_str("//\n");
        for line in lines {
            // a number and its minus sign stay on one line
            text.push_str(&comment("//", &line.replace(" - ", &format!("{TIED}-{TIED}"))));
        }
    }
    text
}

/// Writes the properties that all functions share: units, order of arrays, and what they do not do.
fn contract(file: &File) -> String {
    let real = file.precision.c_type();
    let mut text = "//\n".to_owned();
    let mut paragraph = |words: &str| text.push_str(&comment("//", words));
    paragraph(
        "Joint arrays run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, \
        m/s², N.",
    );
    paragraph("");
    paragraph(
        "A result may be written over an argument: all arguments are read before the first number is written. No \
         loop, no branch, no memory but the stack, no library.",
    );
    if file.additions.runge_kutta {
        paragraph("The steps of Runge-Kutta have loops over the joints.");
    }
    if file.chooses_by_sign() {
        paragraph("Friction chooses between numbers by a sign, which a compiler may make a branch.");
    }
    if file.turns() {
        let own = format!("void name({real} angle, {real} *sine, {real} *cosine)").replace(' ', TIED);
        paragraph("");
        paragraph(&format!(
            "Sines and cosines are computed in {real} alone, with errors below 1 ulp for angles up to 1e5 rad, the \
             sums of those of parallel joints included; beyond that results mean nothing. To use others, from a \
             CORDIC unit perhaps, compile with -DRNE_SIN_COS=name, the name of a function {own}."
        ));
    }
    paragraph("");
    paragraph(
        "Sums and products are rounded in the order in which they are written: with -ffast-math, \
         -funsafe-math-optimizations or -mfpmath=387 the source does not compile, unless its sine comes from outside. \
         With -ffp-contract=off the results are those of the Rust code built without fused multiply-add, bit for bit.",
    );
    text
}

/// Returns the operation counts of every function, in columns.
pub(crate) fn counts(programs: &[Program]) -> String {
    let titles = ["function", "products", "sums", "divisions", "angles"].map(str::to_owned);
    let lines: Vec<[String; 5]> = std::iter::once(titles).chain(programs.iter().map(table::counts)).collect();
    "//\n// Operations of one call, of the recursion -> of the code:\n//\n".to_owned() + &columns(&lines)
}

/// Returns a table of cells as lines of a comment.
pub(super) fn columns<const N: usize>(lines: &[[String; N]]) -> String {
    let mut text = String::new();
    for line in table::columns(lines) {
        let _ = writeln!(text, "//   {line}");
    }
    text
}
