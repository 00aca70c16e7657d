//! Every function of every kind of robot: through each door it is the number of the definition, or it is refused with
//! the reason that all doors give. docs/reference/matrix.md is the table; `RNE_WRITE_DOCUMENTS=1` writes it anew.

mod kinds;

use std::fmt::Write as _;
use std::panic::resume_unwind;
use std::{env, fs, thread};

use rne_codegen::plan::PlanSet;
use rne_codegen::{CheckFor as _, CompileError, Compiler, Form, Function, Program};
use rne_emit::{Additions, Precision, Prefix, Selection};
use rne_machine::{CompiledArm, Destination};

use crate::kinds::{Kind, State};

/// Functions of accelerations divide by the masses; others have a few roundings of the largest number.
const TOLERANCE: f64 = 1e-9;

/// The reasons for which a function is refused, and how the document calls them.
const REASONS: [(char, &str); 5] = [
    ('b', "The robot file has no floating base."),
    ('c', "The robot file has no contacts."),
    ('l', "The robot has closed loops; the functions of closed loops end in `_of_loops`."),
    ('n', "The robot has no closed loops."),
    ('e', "The result has numbers of every link, and a link of this robot follows other joints."),
];

fn letter(error: &CompileError) -> char {
    match error {
        CompileError::NoFloatingBase { .. } => 'b',
        CompileError::NoContacts { .. } => 'c',
        CompileError::HasClosedLoops { .. } => 'l',
        CompileError::NoClosedLoops { .. } => 'n',
        CompileError::OfEveryLink { .. } => 'e',
        other => panic!("a reason that the document does not have: {other}"),
    }
}

/// A robot at the doors: its state, and its plan and compiled arms, which all functions share.
struct Column<'a> {
    kind: &'a Kind,
    state: State,
    plans: PlanSet,
    arms: [CompiledArm; 2],
}

impl<'a> Column<'a> {
    fn new(kind: &'a Kind) -> Self {
        let arm = CompiledArm::from_robot(&kind.robot);
        let arms = Form::ALL.map(|form| arm.in_form(form));
        Self { kind, state: State::of(kind), plans: PlanSet::default_of(&kind.robot), arms }
    }

    /// The programs of a function in both forms.
    fn programs(&self, function: Function) -> [Result<Program, CompileError>; 2] {
        let compiler = Compiler::new(&self.kind.robot);
        let planned = compiler.clone().with_plans(&self.plans);
        [compiler.compile(function, Form::SevenSteps), planned.compile(function, Form::Reduced)]
    }
}

/// Writes a program through every door that makes text of it.
fn write(kind: &Kind, program: &Program) {
    let (robot, programs) = (&kind.robot, std::slice::from_ref(program));
    let prefix: Prefix = "arm".parse().expect("a prefix");
    let additions = Additions::default();
    for precision in [Precision::Single, Precision::Double] {
        let c = rne_emit::c_code(robot, programs, precision, &prefix).expect("constants that fit");
        assert!(c.one_file().contains(&program.name), "{}", program.name);
        let ptx = rne_emit::ptx(robot, programs, precision, &prefix, &additions).expect("constants that fit");
        assert!(ptx.contains(&program.name), "{}", program.name);
    }
    let cuda = rne_emit::cuda(robot, programs, &prefix, &additions).expect("constants that fit");
    assert!(cuda.contains(&program.name) && rne_emit::rust_file(robot, programs).contains(&program.name));
    for explain in [false, true] {
        let listing = rne_emit::listing(robot, program, Selection { explain, ..Selection::default() });
        assert!(listing.sections.iter().all(|section| !section.lines.is_empty()), "{}: {}", kind.name, program.name);
    }
}

/// The cell of a function and a kind of robot: nothing where every door computes it, or the letter of the reason.
fn cell(column: &Column<'_>, function: Function) -> Option<char> {
    let Column { kind, state, arms, .. } = column;
    if let Err(reason) = function.check_for(&kind.robot) {
        for arm in arms {
            let refused = arm.function(function).expect_err("a function that another door refuses").to_string();
            assert_eq!(refused, reason.to_string(), "{}: {function}", kind.name);
        }
        // the compiler alone takes a robot without a base as one whose base has no mass
        if let Err(of_kind) = function.check_kind(&kind.robot) {
            for program in column.programs(function) {
                assert_eq!(program.expect_err("a function that another door refuses"), of_kind, "{}", kind.name);
            }
        }
        return Some(letter(&reason));
    }
    let expected = kind.definition().evaluate(function, &state.inputs()).expect("arguments of the right lengths");
    let largest = expected.iter().fold(1.0, |largest: f64, number| largest.max(number.abs()));
    assert!(largest.is_finite(), "{}: {function}: {expected:?}", kind.name);
    for (arm, form) in arms.iter().zip(Form::ALL) {
        for states in [1, 9] {
            let mut found = vec![0.0; expected.len() * states];
            let done = arm.run(function, states, &state.arguments(), Destination::Rows(&mut found));
            done.unwrap_or_else(|error| panic!("{}: {function}: {error}", kind.name));
            let worst = found.chunks(expected.len()).flat_map(|row| row.iter().zip(&expected));
            let worst = worst.fold(0.0, |worst: f64, (found, expected)| worst.max((found - expected).abs()));
            assert!(worst <= TOLERANCE * largest, "{}: {function}, {form}: {worst:e} of {largest}", kind.name);
        }
    }
    for program in column.programs(function) {
        write(kind, &program.unwrap_or_else(|error| panic!("{}: {function}: {error}", kind.name)));
    }
    None
}

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference/matrix.md");

const TEXT: &str = "\
# Which function for which robot

A test walks through every function and every kind of robot, and writes this page: \
`RNE_WRITE_DOCUMENTS=1 cargo test -p matrix`. `●` means that each of these doors has the function: `rne::DynArm`, \
`rne::compiled` in both forms, for one state and for many, C and PTX in both precisions, CUDA, Rust, and the listing \
of `rne show`. The numbers of `rne::compiled` are those of `rne::DynArm`. A letter means that each of these doors \
refuses the function, for this reason:

";

#[test]
fn every_function_of_every_kind_of_robot_is_computed_or_refused_at_all_doors() {
    let kinds = kinds::all();
    let of_kind = |kind: &Kind| -> Vec<Option<char>> {
        let column = Column::new(kind);
        Function::ALL.into_iter().map(|function| cell(&column, function)).collect()
    };
    let columns: Vec<Vec<Option<char>>> = thread::scope(|scope| {
        let threads: Vec<_> = kinds.iter().map(|kind| scope.spawn(|| of_kind(kind))).collect();
        threads.into_iter().map(|column| column.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    });
    let mut page = TEXT.to_owned();
    for (letter, reason) in REASONS {
        let _ = writeln!(page, "- {letter}: {reason}");
    }
    let names: Vec<&str> = kinds.iter().map(|kind| kind.name).collect();
    let _ = writeln!(page, "\n| function | {} |\n|---|{}", names.join(" | "), "---|".repeat(kinds.len()));
    for (index, function) in Function::ALL.into_iter().enumerate() {
        let cells: Vec<String> = columns.iter().map(|column| column[index].unwrap_or('●').to_string()).collect();
        let _ = writeln!(page, "| `{function}` | {} |", cells.join(" | "));
    }
    let (all, refused) = (columns.concat().len(), columns.concat().into_iter().flatten().count());
    let _ = writeln!(page, "\n{refused} of {all} cells are refused.");
    if env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
        fs::write(DOCUMENT, &page).expect("a document of the repository");
    }
    let written = fs::read_to_string(DOCUMENT).unwrap_or_default();
    assert!(
        written == page,
        "docs/reference/matrix.md is older: RNE_WRITE_DOCUMENTS=1 cargo test -p matrix writes it anew"
    );
}
