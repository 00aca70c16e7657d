//! The inspection against the runtime, whose recursion shares no code with the compiler: equations before folding and
//! code after it give its torques, and what is said of folding adds up.

use std::cell::RefCell;
use std::collections::HashMap;

use rne_codegen::Function;
use rne_inspection::{Became, Inspection, Operations, Tree, inspect};
use rne_model::Robot;
use rne_runtime::DynArm;

fn shipped() -> impl Iterator<Item = Robot> {
    rne_robots::ROBOTS.iter().map(|file| Robot::from_yaml(file.yaml).unwrap_or_else(|error| panic!("{error}")))
}

fn inspected(robot: &Robot) -> Inspection {
    inspect(robot, Function::InverseDynamics).unwrap_or_else(|error| panic!("{}: {error}", robot.name))
}

struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
}

impl State {
    fn random(dof: usize, random: &mut fastrand::Rng) -> Self {
        let mut list = || (0..dof).map(|_| random.f64() * 4.0 - 2.0).collect();
        Self { q: list(), qd: list(), qdd: list() }
    }

    fn arguments(&self) -> HashMap<String, f64> {
        let named = |prefix: &'static str, list: &[f64]| {
            list.iter().enumerate().map(|(index, value)| (format!("{prefix}{}", index + 1), *value)).collect::<Vec<_>>()
        };
        [named("q", &self.q), named("qd", &self.qd), named("qdd", &self.qdd)].into_iter().flatten().collect()
    }

    fn torques(&self, robot: &Robot) -> Vec<f64> {
        DynArm::from_robot(robot).inverse_dynamics(&self.q, &self.qd, &self.qdd).expect("one number per joint")
    }
}

fn value(values: &HashMap<String, f64>, name: &str) -> f64 {
    *values.get(name).unwrap_or_else(|| panic!("{name} is used before it is known"))
}

/// All equations before folding, each when it is asked for.
struct ByEquations<'i> {
    equations: HashMap<&'i str, &'i Tree>,
    known: RefCell<HashMap<String, f64>>,
}

impl<'i> ByEquations<'i> {
    fn new(inspection: &'i Inspection, state: &State) -> Self {
        let components = inspection.cells.iter().flat_map(|cell| &cell.components).chain(&inspection.table);
        let equations = components.map(|component| (component.name.as_str(), &component.general)).collect();
        Self { equations, known: RefCell::new(state.arguments()) }
    }

    fn value(&self, name: &str) -> f64 {
        if let Some(known) = self.known.borrow().get(name) {
            return *known;
        }
        let equation = self.equations.get(name).unwrap_or_else(|| panic!("nothing gives {name}"));
        let value = equation.evaluate(&|name| self.value(name));
        self.known.borrow_mut().insert(name.to_owned(), value);
        value
    }
}

/// The statements of the code.
fn by_code(inspection: &Inspection, state: &State) -> HashMap<String, f64> {
    let mut values = state.arguments();
    values.extend(inspection.constants.iter().cloned());
    for angle in &inspection.angles {
        let found = angle.value.evaluate(&|name| value(&values, name));
        values.insert(angle.name.clone(), found);
    }
    for turn in &inspection.sines_and_cosines {
        let (sine, cosine) = rne_runtime::Scalar::sin_cos(turn.angle.evaluate(&|name| value(&values, name)));
        values.extend(turn.sine.iter().map(|name| (name.clone(), sine)));
        values.extend(turn.cosine.iter().map(|name| (name.clone(), cosine)));
    }
    for statement in &inspection.statements {
        let found = statement.value.evaluate(&|name| value(&values, name));
        values.insert(statement.name.clone(), found);
    }
    values
}

#[test]
fn equations_before_folding_give_the_torques_of_the_runtime() {
    let mut random = fastrand::Rng::with_seed(13);
    for robot in shipped() {
        let inspection = inspected(&robot);
        for _ in 0..5 {
            let state = State::random(robot.dof(), &mut random);
            let (values, torques) = (ByEquations::new(&inspection, &state), state.torques(&robot));
            let largest = torques.iter().fold(1.0_f64, |largest, torque| largest.max(torque.abs()));
            for (joint, torque) in torques.iter().enumerate() {
                let found = values.value(&format!("tau{}", joint + 1));
                // the library's sine and the runtime's may differ in the last digit
                assert!((found - torque).abs() <= 1e-13 * largest, "{} {joint}: {found} {torque}", robot.name);
            }
        }
    }
}

#[test]
fn the_code_gives_the_torques_of_the_runtime_bit_for_bit() {
    let mut random = fastrand::Rng::with_seed(14);
    for robot in shipped() {
        let inspection = inspected(&robot);
        let state = State::random(robot.dof(), &mut random);
        let (values, torques) = (by_code(&inspection, &state), state.torques(&robot));
        for ((name, tree), torque) in inspection.outputs.iter().zip(&torques) {
            let found = tree.evaluate(&|name| value(&values, name));
            assert!(found == *torque, "{} {name}: {found} {torque}", robot.name);
        }
    }
}

/// Code and equations agree in every component that both have, not in the torques alone.
#[test]
fn every_component_of_the_code_is_that_of_its_equation() {
    let mut random = fastrand::Rng::with_seed(15);
    for robot in shipped() {
        let inspection = inspected(&robot);
        let state = State::random(robot.dof(), &mut random);
        let (general, code) = (ByEquations::new(&inspection, &state), by_code(&inspection, &state));
        for component in inspection.cells.iter().flat_map(|cell| &cell.components) {
            let name = &component.name;
            let expected = general.value(name);
            let found = match &component.became {
                Became::Computed => value(&code, name),
                Became::Same { name } => match name.strip_prefix('-') {
                    Some(name) => -value(&code, name),
                    None => value(&code, name),
                },
                Became::Constant { value, .. } => *value,
                Became::Inside | Became::Unused => continue,
            };
            assert!(
                (found - expected).abs() <= 1e-12 * expected.abs().max(1.0),
                "{} {name}: {found} {expected}",
                robot.name
            );
        }
    }
}

fn operations(tree: &Tree, kept: bool) -> Operations {
    let mut count = Operations::default();
    let Tree::Node(operator, operands, mark) = tree else { return count };
    let is_kept = mark.as_ref().is_none_or(|mark| mark.fold == "kept");
    if is_kept || !kept {
        match *operator {
            "*" => count.products += 1,
            "+" | "-" => count.sums += 1,
            _ => {}
        }
    }
    for of in operands.iter().map(|operand| operations(operand, kept)) {
        count.products += of.products;
        count.sums += of.sums;
    }
    count
}

#[test]
fn the_operations_of_the_trees_are_those_of_the_counts() {
    for robot in shipped() {
        let inspection = inspected(&robot);
        for cell in &inspection.cells {
            for (kept, expected) in [(false, cell.before), (true, cell.after)] {
                let mut found = Operations::default();
                for of in cell.components.iter().map(|component| operations(&component.general, kept)) {
                    found.products += of.products;
                    found.sums += of.sums;
                }
                assert_eq!(found, expected, "{} joint {} step {} {kept}", robot.name, cell.joint, cell.step);
            }
        }
    }
}

/// From every statement of the code to its equation, its unit, its place on the arm, and back.
#[test]
fn every_statement_leads_to_its_equation_and_back() {
    for robot in shipped() {
        let inspection = inspected(&robot);
        assert!(!inspection.statements.is_empty(), "{}", robot.name);
        for statement in &inspection.statements {
            let name = &statement.name;
            let owner = statement.component.as_ref().unwrap_or_else(|| panic!("{}: {name} is of nothing", robot.name));
            let component = inspection.component(owner).expect("statements name components");
            assert!(component.statements.contains(name), "{}: {owner} has no {name}", robot.name);
            let (_, quantity) = inspection.meaning(name).expect("every name has a meaning");
            assert!(!inspection.unit(name).is_empty() || quantity.units == [""; 2], "{name}");
            assert!(quantity.drawn.is_some(), "{}: nobody knows where to draw {name}", robot.name);
            for used in statement.value.names() {
                assert!(inspection.names.contains_key(used), "{}: {used}", robot.name);
            }
        }
        for component in inspection.cells.iter().flat_map(|cell| &cell.components) {
            let is_computed = matches!(component.became, Became::Computed);
            assert_eq!(is_computed, component.statements.contains(&component.name), "{}", component.name);
            for statement in &component.statements {
                let all = inspection.angles.iter().chain(&inspection.statements);
                let known = all.into_iter().find(|known| known.name == *statement);
                assert_eq!(known.and_then(|known| known.component.as_ref()), Some(&component.name));
            }
            for user in &component.used_by {
                let user = inspection.component(user).expect("users are components");
                assert!(user.general.names().contains(&component.name.as_str()), "{}", component.name);
            }
        }
    }
}

/// Whether it has a number 0 as a summand, which needs no reason.
fn zeros(tree: &Tree) -> bool {
    let Tree::Node(_, operands, _) = tree else { return false };
    operands.iter().any(|operand| *operand == Tree::Number(0.0) || zeros(operand))
}

#[test]
fn what_has_no_statement_of_its_own_is_part_of_one_or_not_needed() {
    fn reaches(name: &str, all: &HashMap<&str, &rne_inspection::Component>) -> bool {
        let component = all[name];
        !component.statements.is_empty() || component.used_by.iter().any(|user| reaches(user, all))
    }
    for robot in shipped() {
        let inspection = inspected(&robot);
        let components = inspection.cells.iter().flat_map(|cell| &cell.components).chain(&inspection.table);
        let all = components.map(|component| (component.name.as_str(), component)).collect();
        for component in inspection.cells.iter().flat_map(|cell| &cell.components) {
            let is_inside = component.became == Became::Inside;
            assert!(!is_inside || reaches(&component.name, &all), "{} {}", robot.name, component.name);
        }
    }
}

#[test]
fn what_is_gone_has_a_reason_and_what_is_left_has_none() {
    for robot in shipped() {
        let inspection = inspected(&robot);
        for component in inspection.cells.iter().flat_map(|cell| &cell.components) {
            for folded in &component.folded {
                assert!(folded.why.len() > 3 && !folded.left.is_empty(), "{}: {folded:?}", component.name);
            }
            let count = operations(&component.general, false);
            let left = operations(&component.general, true);
            let is_needed = !matches!(component.became, Became::Unused | Became::Inside);
            let is_plain = zeros(&component.general) || component.general.names().is_empty();
            if count != left && is_needed && !is_plain {
                assert!(!component.folded.is_empty(), "{} {}", robot.name, component.name);
            }
        }
    }
}
