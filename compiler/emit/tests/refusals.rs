//! A reduced form that is refused stays in the program, and the headings of emitted files say it.

use rne_codegen::{Attempt, CompileError, Compiler, Form, Function, LeftOut, Program, Reason, Refusal};
use rne_emit::{Precision, Prefix};
use rne_model::Robot;

fn robot(path: &str) -> Robot {
    let path = format!("{}/../../{path}.yaml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"))
}

fn reduced(robot: &Robot, function: Function) -> Program {
    Compiler::new(robot).compile(function, Form::Reduced).unwrap_or_else(|error| panic!("{error}"))
}

/// The emitted files in both languages, every run of blanks and comment marks as one blank.
fn files(robot: &Robot, program: &Program) -> [String; 2] {
    let programs = std::slice::from_ref(program);
    let c = rne_emit::c_code(robot, programs, Precision::Double, &Prefix::of(robot)).expect("constants of a double");
    let words = |text: &str| {
        let lines = text.lines().map(|line| line.trim_start_matches("//!").trim_start_matches("//").trim());
        lines.collect::<Vec<_>>().join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
    };
    [words(&rne_emit::rust_file(robot, programs)), words(&c.one_file())]
}

#[test]
fn a_mass_matrix_that_is_always_singular_is_told() {
    let robot = robot("cli/tests/cli/plans/singular");
    let program = reduced(&robot, Function::ForwardDynamics);
    assert_eq!(program.form, Form::SevenSteps);
    assert_eq!(program.refusals, [Refusal { attempt: Attempt::Any, reason: Reason::DividesByZero }]);
    for text in files(&robot, &program) {
        assert!(text.contains("its code is that of the seven steps. Refused:"), "{text}");
        assert!(text.contains("any reduced form: the seven steps divide by zero in every state"), "{text}");
    }
}

/// The Jacobian of a gantry is constant, so there are no accelerations whose rounding could be measured.
#[test]
fn rounding_that_cannot_be_measured_is_told() {
    let robot = robot("robots/gantry_ppp");
    let program = reduced(&robot, Function::JacobianRateTimesVelocity);
    for text in files(&robot, &program) {
        assert!(text.contains("Rounding was measured at no state"), "{text}");
    }
}

/// Masses and lengths of eighteen orders of magnitude.
#[test]
fn rounding_that_is_refused_is_told() {
    let robot = robot("cli/tests/cli/plans/extreme");
    // a base without mass has no forward dynamics in any form
    let solvable =
        Function::OF_TREES.into_iter().filter(|function| !(function.is_of_floating_base() && function.inverts_mass()));
    let refused: Vec<Program> = solvable.map(|function| reduced(&robot, function)).collect();
    let refused: Vec<&Program> = refused.iter().filter(|program| !program.refusals.is_empty()).collect();
    let is_rounding = |refusal: &Refusal| matches!(refusal.reason, Reason::Error(CompileError::Imprecise { .. }));
    assert!(refused.iter().any(|program| program.refusals.iter().any(is_rounding)), "{refused:#?}");
    for program in refused {
        let first = program.refusals[0].attempt;
        assert!(matches!(first, Attempt::Planned(LeftOut::Nothing) | Attempt::EveryValueOnce), "{first}");
        for text in files(&robot, program) {
            assert!(text.contains(&format!("Not every reduced form of {} could be taken", program.function)), "{text}");
            for refusal in &program.refusals {
                assert!(text.contains(&refusal.to_string()), "{refusal}: {text}");
            }
        }
    }
}

#[test]
fn nothing_is_told_of_an_arm_without_a_refusal() {
    for name in ["robots/planar2", "robots/puma560"] {
        let robot = robot(name);
        for function in [Function::InverseDynamics, Function::ForwardDynamics, Function::JointWrenches] {
            let program = reduced(&robot, function);
            assert!(program.refusals.is_empty(), "{name}, {function}: {:?}", program.refusals);
            for text in files(&robot, &program) {
                assert!(!text.contains("Refused") && !text.contains("could be taken"), "{text}");
            }
        }
    }
}
