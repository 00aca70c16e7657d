//! A listing is data: every statement once, every name and number marked as one, findings and folds as values.

#[path = "../../codegen/tests/common/mod.rs"]
mod common;

use std::collections::BTreeSet;

use common::{programs, reduced_programs, shipped};
use rne_codegen::{Compiler, Form, Function, Name, Program, Quantity, Statement, Step};
use rne_emit::{Line, Listing, Part, Precision, Prefix, Selection, c_code, listing, rust_file};

fn everything() -> Selection {
    Selection { explain: true, ..Selection::default() }
}

fn statements<'a>(listing: &Listing<'a>) -> Vec<&'a Statement> {
    let lines = listing.sections.iter().flat_map(|section| &section.lines);
    lines.filter_map(|line| if let Line::Statement(statement, _) = line { Some(*statement) } else { None }).collect()
}

#[test]
fn every_statement_is_listed_once_and_marks_its_names() {
    for robot in shipped().into_iter().filter(|robot| robot.dof() < 4) {
        for program in programs(&robot).into_iter().chain(reduced_programs(&robot)) {
            let listing = listing(&robot, &program, Selection::default());
            let mut listed: Vec<Name> = statements(&listing).iter().map(|statement| statement.name).collect();
            let mut all: Vec<Name> = program.statements.iter().map(|statement| statement.name).collect();
            listed.sort_unstable();
            all.sort_unstable();
            assert_eq!(listed, all, "{} of {}", program.function, robot.name);
            for statement in statements(&listing) {
                let value = program.values.defined(statement.value);
                let line = Line::Statement(statement, value).annotated();
                let pieces: Vec<_> = line.pieces().collect();
                assert_eq!(pieces.iter().map(|(_, text)| *text).collect::<String>(), line.as_str());
                assert_eq!(pieces[0], (Some(Part::Keyword), "let"));
                let named = pieces.iter().filter_map(|(part, text)| match part {
                    Some(Part::Name(name)) => Some((*name, *text)),
                    _ => None,
                });
                let names: BTreeSet<Name> = named.clone().map(|(name, _)| name).collect();
                let used: BTreeSet<Name> = value.names().chain([statement.name]).collect();
                assert_eq!(names, used, "{line}");
                assert!(named.into_iter().all(|(name, text)| name.to_string() == text), "{line}");
            }
        }
    }
}

fn puma(form: Form) -> (rne_model::Robot, Program) {
    let robot = shipped().into_iter().find(|robot| robot.name == "puma560").expect("shipped");
    let program = Compiler::new(&robot).compile(Function::InverseDynamics, form).expect("finite constants");
    (robot, program)
}

#[test]
fn a_step_has_a_heading_its_formulas_and_what_folded() {
    let (robot, program) = puma(Form::SevenSteps);
    let what = Selection { joint: Some(2), step: Some(Step::Wrenches), ..everything() };
    let listing = listing(&robot, &program, what);
    let [section] = &listing.sections[..] else { panic!("one section") };
    assert_eq!(section.place, Some((2, Step::Wrenches, None)));
    assert_eq!(section.lines[0], Line::Heading("joint 2, step 6: forces and moments".to_owned()));
    let given = section.lines.iter().filter_map(|line| match line {
        Line::Formula(formula) => Some(formula.quantity),
        _ => None,
    });
    let quantities = [Quantity::InertiaMoment, Quantity::JointForce, Quantity::JointMoment];
    assert!(given.eq(quantities));
    let Some(Line::Folds(folds)) = section.lines.last() else { panic!("{:?}", section.lines.last()) };
    let gone: usize = folds.reasons.iter().map(|(count, _)| count).sum::<usize>() + folds.others;
    assert_eq!(folds.before.0 + folds.before.1, folds.left.0 + folds.left.1 + gone);
}

#[test]
fn a_program_knows_its_algorithm() {
    use rne_codegen::Algorithm;

    let (robot, program) = puma(Form::Reduced);
    assert_eq!(program.algorithm, Algorithm::Rnea);
    let mass_matrix = Compiler::new(&robot).compile(Function::MassMatrix, Form::Reduced).expect("finite constants");
    assert!(matches!(mass_matrix.algorithm, Algorithm::Crba(_)), "{:?}", mass_matrix.algorithm);
    let listing = listing(&robot, &mass_matrix, everything());
    let lines = listing.sections.iter().flat_map(|section| &section.lines);
    assert!(lines.clone().all(|line| !matches!(line, Line::Formula(_))), "composite bodies have formulas of their own");
}

#[test]
fn no_line_of_a_file_ends_with_a_blank() {
    for robot in shipped() {
        // one by one: motors that are not there leave a file without names
        for program in programs(&robot).chunks(1) {
            let c = c_code(&robot, program, Precision::Double, &Prefix::of(&robot)).expect("finite constants");
            for text in [c.one_file(), rust_file(&robot, program)] {
                let line = text.lines().find(|line| line.ends_with(' '));
                assert_eq!(line, None, "{} of {}", program[0].function, robot.name);
            }
        }
    }
}
