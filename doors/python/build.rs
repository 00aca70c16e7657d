//! Writes those methods of the class `Arm` that are functions of the compiler, with signatures and docstrings from the
//! compiler's table.

use std::fmt::Write as _;
use std::{env, fs, io, path::Path};

use rne_functions::{Argument, Function, Length, Record, Shape};

/// The vectors of the motion of a base, which may be left out of a call.
const OF_BASE: [&str; 4] = ["base_omega", "base_omega_dot", "base_acceleration", "base_gravity"];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let mut methods = String::from("#[pymethods]\nimpl Arm {\n");
    for function in Function::ALL {
        write(&mut methods, function, function.name());
        // a function of the pose of the tip has a second name, that at a frame, which becomes a method too
        if let Some(other) = function.of_frame().filter(|name| *name != function.name()) {
            write(&mut methods, function, other);
        }
    }
    methods.push_str("}\n");
    fs::write(Path::new(&env::var_os("OUT_DIR").unwrap_or_default()).join("methods.rs"), methods)
}

/// Writes the method of a function under a name.
fn write(methods: &mut String, function: Function, name: &str) {
    let mut documentation = summary(function);
    // arguments that must be given, arguments that may be left out, and arguments that are given by name only
    let (mut needed, mut optional, mut named) = (Vec::new(), Vec::new(), Vec::new());
    let mut given = String::new();
    for &argument in function.arguments() {
        let (name, variant) = (argument.name(), format!("{argument:?}"));
        documentation.push_str(&about(argument));
        if argument == Argument::Base {
            named.extend(OF_BASE);
            for vector in OF_BASE {
                let _ = write!(given, "self.of_base_motion(\"{vector}\", {vector}), ");
            }
        } else if argument.is_of_each_tip() && function.is_of_floating_base() {
            documentation.push_str("Without `wrenches` no tip exerts anything.\n\n");
            optional.push(name);
            let _ = write!(given, "self.of_tips(\"{name}\", {name})?, ");
        } else {
            needed.push(name);
            let _ = write!(given, "self.given(Argument::{variant}, {name})?, ");
        }
    }
    if function.of_frame().is_some() {
        documentation.push_str(
            "`frame`: the name of a frame that stands in the place of the tip: a frame in the list `frames` of the \
             robot file, or a joint for its link frame. None is the tip.\n\n",
        );
        named.push("frame");
    }
    let with_payload = function.with_payload().map_or(String::new(), |with_payload| {
        documentation.push_str(&about(Argument::Payload));
        named.push("payload");
        format!(
            "if let Some(payload) = payload {{ function = Function::{with_payload:?}; \
             given.push(self.given(Argument::Payload, payload)?); }}"
        )
    });
    let _ = write!(documentation, "Returns {}", returned(function));
    if let names @ [_, ..] = function.what().aliases() {
        let _ = write!(documentation, "\n\nOther names: {}.", names.join(", "));
    }
    named.extend(["parameters", "out"]);
    let frame = if function.of_frame().is_some() { "frame" } else { "None" };
    let mutable = if with_payload.is_empty() { "" } else { "mut " };
    let kinds = needed.iter().map(|name| format!("{name}: &Bound<'py, PyAny>, "));
    let left_out = optional.iter().chain(&named);
    let kinds: String = kinds.chain(left_out.map(|name| format!("{name}: Option<&Bound<'py, PyAny>>, "))).collect();
    let optional = optional.iter().map(|name| format!("{name}=None, "));
    let signature: String = needed.iter().map(|name| format!("{name}, ")).chain(optional).collect();
    let named: Vec<String> = named.iter().map(|name| format!("{name}=None")).collect();
    for line in documentation.lines() {
        let _ = writeln!(methods, "    #[doc = {line:?}]");
    }
    let _ = writeln!(
        methods,
        "    #[pyo3(signature = ({signature}*, {}))]\n    \
         fn {name}<'py>(&self, py: Python<'py>, {kinds}) -> PyResult<Bound<'py, PyAny>> {{\n        \
         let ({mutable}function, {mutable}given) = (Function::{function:?}, vec![{given}]);\n        \
         {with_payload}\n        \
         self.compute_at(py, {frame}, function, given, parameters, out)\n    }}",
        named.join(", ")
    );
}

/// Returns the first sentence of the docstring: what the function computes.
fn summary(function: Function) -> String {
    let mut documentation = format!("{}\n\n", function.summary());
    if !function.details().is_empty() {
        let is_pose = matches!(function.shape(), Shape::Record(Record::Pose, _));
        let of_pose = "The columns of its rotation are the axes of the tip frame, in world axes; its origin is in m.";
        let _ = writeln!(documentation, "{}\n", if is_pose { of_pose } else { function.details() });
    }
    documentation
}

/// Returns a sentence about an argument whose name does not say what it is.
fn about(argument: Argument) -> String {
    let (name, shape) = (argument.name(), argument.shape());
    let numbers = in_words(&[dimensions(shape)].concat());
    let text = match shape {
        Shape::Array(Length::Joints, _) => return String::new(),
        Shape::Number => "a number, or shape (N,).".to_owned(),
        Shape::Array(Length::Passive, _) => {
            format!(
                "{numbers}, the positions of the dependent joints in their order, or a dict by their names; \
                 `close` finds them."
            )
        }
        Shape::Array(Length::Tips, _) => format!(
            "force, then moment, of each tip; a dict from names of tips to six numbers, or to arrays of shape (N, 6), \
             where a tip without an entry exerts nothing; or an array of {numbers}."
        ),
        Shape::Record(Record::Payload, _) => {
            "shape (10,) or (N, 10); `rne.payload` makes one. A point mass has the first four numbers alone: \
             shape (4,) or (N, 4)."
                .to_owned()
        }
        Shape::Record(Record::BaseMotion, _) => {
            let names = OF_BASE.join("`, `");
            return format!(
                "`{names}`: shape (3,) or (N, 3). What is left out is zero, `base_gravity` the robot's own.\n\n"
            );
        }
        Shape::Record(Record::Pose, _) => format!("a homogeneous matrix; {numbers}."),
        Shape::Record(record, _) => format!("{}; {numbers}.", record.fields().join(", then ")),
        Shape::Array(..) => format!("{numbers}."),
    };
    format!("`{name}`: {text}\n\n")
}

/// Returns the sentence about what a function returns.
fn returned(function: Function) -> String {
    let shape = function.shape();
    let numbers = in_words(&dimensions(shape));
    match shape {
        Shape::Number => "a number, or an array of shape (N,).".to_owned(),
        Shape::Array(_, rows) if function.is_of_every_link() => {
            let rows = dimensions(rows);
            let (first, columns) = (&dimensions(shape)[0], format!("10 ({})", rows[0]));
            let floating = if function.is_of_floating_base() { "floating_" } else { "" };
            format!(
                "the matrix whose product with the `{floating}inertial_parameters`, body by body, are the torques, \
                 with force and moment before them for a floating base: {}.",
                in_words(&[first.clone(), columns])
            )
        }
        Shape::Array(_, Shape::Record(record, _)) => match record {
            Record::Pose => format!("homogeneous matrices: {numbers}."),
            _ => format!("{} of each: {numbers}.", record.fields().join(", then ")),
        },
        Shape::Array(..) => format!("{numbers}."),
        Shape::Record(Record::Pose, _) => format!("a homogeneous matrix: {numbers}."),
        Shape::Record(Record::NextStateDerivatives, _) => {
            "A and B, of shape (2 n, 2 n) and (2 n, n), or (N, 2 n, 2 n) and (N, 2 n, n). `out` has their blocks: \
             shape (2, 3, n, n) or (N, 2, 3, n, n), of the positions and of the velocities, by q, by qd and by tau."
                .to_owned()
        }
        Shape::Record(Record::FloatingStepDerivatives, _) => {
            "A and B, of shape (12 + 2 n, 12 + 2 n) and (12 + 2 n, n), or (N, 12 + 2 n, 12 + 2 n) and \
             (N, 12 + 2 n, n); rows and columns are the positions, then the velocities, each of the base \
             before the joints. `out` is one array with the rows of q_dq, q_dv, q_dtau, v_dq, \
             v_dv and v_dtau, one after the other."
                .to_owned()
        }
        Shape::Record(record, parts) => of_record(*record, parts),
    }
}

/// Returns a text about the parts of a record, and about the array `out` that contains them all.
fn of_record(record: Record, parts: &[Shape]) -> String {
    let names = record.fields();
    if parts.iter().all(|part| *part == parts[0]) {
        let (last, others) = names.split_last().unwrap_or((&"", &[]));
        let count = ["two", "three", "four"][names.len() - 2];
        let all = [vec![names.len().to_string()], dimensions(&parts[0])].concat();
        let (each, all) = (in_words(&dimensions(&parts[0])), in_words(&all));
        return format!("{} and {last}, {count} arrays of {each}; `out` is one array of {all}.", others.join(", "));
    }
    let listed = flat(names, parts);
    let (last, others) = listed.split_last().map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
    format!("{}, and {last}; `out` is one array with their numbers, one after the other.", others.join(", "))
}

/// Returns the parts of a record with their shapes. A part that is itself a record of different shapes is replaced by
/// its parts.
fn flat(names: &[&str], parts: &[Shape]) -> Vec<String> {
    let of_part = |(name, part): (&&str, &Shape)| match part {
        Shape::Record(record, of) if of.iter().any(|part| *part != of[0]) && *record != Record::Pose => {
            flat(record.fields(), of)
        }
        Shape::Record(Record::Pose, _) => {
            vec![format!("{name}, a homogeneous matrix, of {}", in_words(&dimensions(part)))]
        }
        Shape::Record(record, _) => {
            vec![format!("{name} ({}), of {}", record.fields().join(", then "), in_words(&dimensions(part)))]
        }
        _ => vec![format!("{name}, of {}", in_words(&dimensions(part)))],
    };
    names.iter().zip(parts).flat_map(of_part).collect()
}

/// Returns the dimensions of an array for one state.
fn dimensions(shape: &Shape) -> Vec<String> {
    match shape {
        Shape::Number => Vec::new(),
        Shape::Array(length, of) => {
            let length = match length {
                Length::Joints => "n".to_owned(),
                Length::Velocities => "6 + n".to_owned(),
                Length::Bodies => "n + 1".to_owned(),
                Length::Tips => "tips".to_owned(),
                Length::Passive => "p".to_owned(),
                Length::Equations => "e".to_owned(),
                Length::Fixed(length) => length.to_string(),
            };
            [vec![length], dimensions(of)].concat()
        }
        Shape::Record(Record::Pose, _) => vec!["4".to_owned(), "4".to_owned()],
        Shape::Record(..) => vec!["6".to_owned()],
    }
}

/// Returns the shape of an array for one state and for N states, as a text.
fn in_words(dimensions: &[String]) -> String {
    let all = dimensions.join(", ");
    let comma = if dimensions.len() == 1 { "," } else { "" };
    format!("shape ({all}{comma}) or (N, {all})")
}
