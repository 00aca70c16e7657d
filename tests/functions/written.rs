//! Emitted code defines each name before it uses it, also where joints follow joints further out, or rotors turn with
//! several joints. The text is read by rules of its own, without a compiler.

use std::collections::HashSet;

use rne_codegen::{Compiler, Form, Function, Program};
use rne_emit::{Precision, Prefix};
use rne_model::{Reader, Robot};

use crate::{couplings, motors};

/// The identifiers of a text of C, without those of calls and of fields.
fn identifiers(text: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find(is_part) {
        let (before, word) = rest.split_at(start);
        let end = word.find(|c| !is_part(c)).unwrap_or(word.len());
        let (word, behind) = word.split_at(end);
        let is_field = before.ends_with("->") || before.ends_with('.');
        if word.starts_with(|c: char| !c.is_ascii_digit()) && !behind.starts_with('(') && !is_field {
            found.push(word);
        }
        rest = behind;
    }
    found
}

/// The names that a function of C uses and does not define before.
fn undefined(function: &str) -> Vec<String> {
    let (head, body) = function.split_once("\n{\n").expect("a body");
    let mut known: HashSet<&str> = identifiers(head).into_iter().collect();
    known.extend(["const", "double", "void", "if", "else", "return"]);
    let body: String = body.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let mut missing = Vec::new();
    for statement in body.split([';', '{', '}']) {
        let statement = statement.trim();
        let (defined, used) = match statement.strip_prefix("const double ") {
            Some(definition) => definition.split_once('=').expect("a value"),
            // sine and cosine, which a call fills
            None if statement.starts_with("double ") => (statement, ""),
            None => ("", statement),
        };
        missing.extend(identifiers(used).into_iter().filter(|name| !known.contains(name)).map(str::to_owned));
        known.extend(identifiers(defined));
    }
    missing
}

fn check(robot: &Robot) {
    for form in Form::ALL {
        let compiled = |function| Compiler::new(robot).compile(function, form).ok();
        let programs: Vec<Program> = Function::OF_TREES.into_iter().filter_map(compiled).collect();
        let of_links = Function::OF_TREES.into_iter().filter(|function| function.is_of_every_link()).count();
        assert!(
            programs.len() + of_links >= Function::OF_TREES.len(),
            "{}: a function with numbers of every link",
            robot.name
        );
        for program in programs {
            let function = program.function;
            let code =
                rne_emit::c_code(robot, &[program], Precision::Double, &Prefix::of(robot)).expect("it is emitted");
            let text = code.one_file();
            let is_asked = |text: &&str| text.split('(').next().is_some_and(|name| name.ends_with(function.name()));
            let functions = text.split("\nvoid ").skip(1).filter(is_asked);
            for text in functions.filter(|text| text.split(';').next().is_some_and(|head| head.contains("\n{\n"))) {
                let text = text.split_once("\n}\n").map_or(text, |(function, _)| function);
                assert_eq!(undefined(text), [""; 0], "{}, {form}, {function}:\n{text}", robot.name);
            }
        }
    }
}

#[test]
fn names_are_defined_before_they_are_used() {
    const MOST: u64 = 2;
    let read = |text: &str| {
        let read = Reader::new("robot").trees().couplings().read(text);
        read.unwrap_or_else(|report| panic!("{report}")).robot
    };
    check(&read(include_str!("../../docs/palletiser.yaml")));
    for seed in 0..if shipped::is_exhaustive() { 40 * MOST } else { MOST } {
        let dof = 2 + usize::try_from(seed).expect("small") % 4;
        check(&couplings::robots(seed, dof).1);
        check(&motors::robot(seed, dof, motors::Shape::Any, seed % 2 == 0));
    }
    // a follower above what it follows, one that slides twice as far, and rotors with a common part
    let file = |rows: &str, lists: &str| {
        let head = "{format: 2, name: r, source: own, convention: modified, gravity: [0, 0, -9.81], joints: [";
        read(&format!("{head}{rows}], {lists}}}"))
    };
    let row = |name: &str, kind: &str, alpha: &str| {
        format!(
            "{{name: {name}, type: {kind}, dh: {{theta: 0, d: 0, a: 0.3, alpha: {alpha}}}, link: {{mass: 1, inertia: \
             {{zz: 1}}}}}}"
        )
    };
    let two = |kind: &str| [row("a", kind, "0"), row("b", kind, "0.4")].join(", ");
    for kind in ["revolute", "prismatic"] {
        check(&file(&two(kind), "couplings: [{joint: a, follows: {b: 2}}]"));
    }
    let telescope = [row("t", "revolute", "0"), row("a", "prismatic", "pi/2"), row("b", "prismatic", "0.3")].join(", ");
    check(&file(&telescope, "couplings: [{joint: b, follows: {a: 2}}]"));
    let axis = "rotor: {axis: [0, 1, 0], on: a, inertia: 1}";
    check(&file(&two("revolute"), &format!("motors: [{{turns: {{a: 1, b: 2}}, {axis}}}]")));
}
