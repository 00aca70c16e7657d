//! The names of the numbers in generated code: what they look like, and that two variables of one name are refused,
//! whoever made them.

mod common;

use rne_codegen::{Axis, CompileError, Compiler, Form, Function, Name, Operator, Program, Quantity, Value, ValueId};
use rne_model::{JointKind, Reader, Robot};

#[test]
fn names_are_the_interface() {
    use Axis::{X, Y, Z};
    for (name, text) in [
        (Name::vector(Quantity::Omega, 2, Z), "w2_z"),
        (Name::vector(Quantity::OmegaDot, 2, X), "dw2_x"),
        (Name::vector(Quantity::Velocity, 2, Y), "dc2_y"),
        (Name::vector(Quantity::Acceleration, 2, Y), "ddc2_y"),
        (Name::vector(Quantity::Gravity, 2, Z), "g2_z"),
        (Name::vector(Quantity::InertiaForce, 2, X), "f2_x"),
        (Name::vector(Quantity::InertiaMoment, 2, X), "n2_x"),
        (Name::vector(Quantity::JointForce, 2, X), "f1_2_x"),
        (Name::vector(Quantity::JointMoment, 2, X), "n1_2_x"),
        (Name::scalar(Quantity::Torque, 2), "tau2"),
        (Name::scalar(Quantity::Sine, 2), "s2"),
        (Name::scalar(Quantity::Cosine, 2), "c2"),
        (Name::matrix(Quantity::Rotation, 3, X, Y), "rot3_xy"),
        (Name { part: 1, ..Name::vector(Quantity::Acceleration, 3, X) }, "ddc3_x_1"),
    ] {
        assert_eq!(name.to_string(), text);
    }
}

#[test]
fn an_index_is_no_number_of_a_shared_term() {
    let element = Name::indexed(Quantity::ScaledFactor, 5, 2);
    let shared = Name { part: 2, ..Name::scalar(Quantity::ScaledFactor, 5) };
    assert_ne!(element, shared);
    assert_eq!(element.to_string(), shared.to_string(), "why texts are compared, not names");
    assert_eq!(Name { part: 1, ..element }.to_string(), "lowd5_2_1");
    assert_eq!(Name::indexed(Quantity::GroupSine, 4, 2).to_string(), "s2_4");
    let parameter = Name { indices: [3, 10], ..Name::scalar(Quantity::RegressorElement, 2) };
    assert_eq!(parameter.to_string(), "y2_3_10");
}

#[test]
fn shared_terms_name_the_links_of_their_joint() {
    let mut shared = 0;
    for (text, couplings) in
        [(include_str!("../../../docs/tree.yaml"), false), (include_str!("../../../docs/gripper.yaml"), true)]
    {
        let reader = Reader::new("robot").trees();
        let reader = if couplings { reader.couplings() } else { reader };
        let robot = reader.read(text.as_bytes()).expect("a robot file").robot;
        for form in [Form::SevenSteps, Form::Reduced] {
            let program = Compiler::new(&robot).compile(Function::InverseDynamics, form).expect("a program");
            let names = program.statements.iter().map(|statement| statement.name);
            for name in names.filter(|name| matches!(name.quantity, Quantity::JointForce | Quantity::JointMoment)) {
                let parent = robot.parent(name.joint - 1).map_or(0, |parent| parent + 1);
                let letter = if name.quantity == Quantity::JointForce { "f" } else { "n" };
                let start = format!("{letter}{parent}_{}_", name.joint);
                assert!(name.to_string().starts_with(&start), "{name}, which is not {start}");
                shared += usize::from(name.part > 0 && parent + 1 != name.joint);
            }
        }
    }
    assert!(shared > 0, "no shared term of a joint whose parent is not the joint before");
}

/// The names that a sum adds, those of sums within it, too.
fn summands(program: &Program, sum: ValueId) -> Vec<Name> {
    let Value::Binary(Operator::Sum | Operator::Difference, a, b) = program.values.get(sum) else { return Vec::new() };
    let of = |id: ValueId| program.values.name(id).map_or_else(|| summands(program, id), |name| vec![name]);
    [a, b].into_iter().flat_map(of).collect()
}

/// A part of a force that is a moment over a length is called a moment: whoever reads the code adds moments there.
#[test]
fn a_shared_sum_has_the_unit_of_what_it_adds() {
    let unit =
        |name: Name| Some(name.quantity.unit(JointKind::Revolute).replace("rad", "1")).filter(|unit| !unit.is_empty());
    let mut renamed = 0;
    for robot in common::all() {
        let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).expect("a program");
        for statement in program.statements.iter().filter(|statement| statement.name.part > 0) {
            let Some(own) = unit(statement.name) else { continue };
            let added: Vec<String> = summands(&program, statement.value).into_iter().filter_map(unit).collect();
            assert!(added.is_empty() || added.contains(&own), "{}: {}", robot.name, statement.name);
            renamed += usize::from(statement.place.quantity != statement.name.quantity);
        }
    }
    assert!(renamed > 0, "no part of a quantity has another unit");
}

fn rod() -> Program {
    let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
        {type: revolute, dh: {theta: 0.1, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0.1, 0]}}]}";
    Compiler::new(&Robot::from_yaml(yaml).unwrap()).compile(Function::InverseDynamics, Form::SevenSteps).unwrap()
}

fn refused(program: &Program) -> String {
    let error = program.check_names().unwrap_err();
    let CompileError::TwoOfOneName { name, .. } = &error else { panic!("{error}") };
    assert!(error.to_string().contains(&format!("two variables called `{name}`")), "{error}");
    name.clone()
}

#[test]
fn two_variables_of_one_name_are_refused() {
    let program = rod();
    assert_eq!(program.check_names(), Ok(()));
    for (from, to) in [(0, 1), (1, 0)] {
        let mut same = program.clone();
        same.statements[from].name = program.statements[to].name;
        assert_eq!(refused(&same), program.statements[to].name.to_string());
    }
    for name in [
        program.constants().next().unwrap().name,
        program.arguments().next().unwrap(),
        program.sines_and_cosines[0].sine.unwrap(),
    ] {
        let mut same = program.clone();
        same.statements[0].name = name;
        assert_eq!(refused(&same), name.to_string());
    }
}

#[test]
fn two_names_of_one_text_are_refused() {
    let mut program = rod();
    program.statements[0].name = Name::indexed(Quantity::LowerFactor, 1, 2);
    program.statements[1].name = Name { part: 2, ..Name::scalar(Quantity::LowerFactor, 1) };
    assert_eq!(refused(&program), "low1_2");
}
