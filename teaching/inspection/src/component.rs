//! Describes one component: its general equation, that for this robot, the folded terms, and the remaining code.

use std::collections::{BTreeMap, HashMap};

use rne_codegen::{self as codegen, Equation, Program, ResolvedAs};
use rne_model::Robot;

use crate::record::{Became, Component, Folded};
use crate::tree::{Mark, Tree, signed};

/// Largest number of operations of a constant of the table whose equation is shown.
const SIMPLE: usize = 12;

/// The equations of a program, with tables for frequent look-ups.
pub(crate) struct Equations<'p> {
    robot: &'p Robot,
    program: &'p Program,
    became: HashMap<String, Became>,
    /// The components that no statement needs and that are a symbol or a number.
    plain: HashMap<String, Tree>,
    used_by: BTreeMap<String, Vec<String>>,
    statements: HashMap<String, Vec<String>>,
    /// Whether each statement has an equation.
    is_whole: bool,
    reasons: Vec<String>,
}

impl<'p> Equations<'p> {
    pub(crate) fn new(robot: &'p Robot, program: &'p Program) -> Self {
        let became = program.resolutions.iter().map(|resolution| {
            let found = match &resolution.value {
                ResolvedAs::Computed => Became::Computed,
                ResolvedAs::Same(name, sign) => Became::Same { name: signed(name.to_string(), *sign) },
                ResolvedAs::Constant(value, causes) => {
                    let why =
                        if *value == 0.0 { rne_emit::reason(robot, causes, 0) } else { "of the table".to_owned() };
                    Became::Constant { value: *value, why }
                }
                ResolvedAs::Inside => Became::Inside,
                ResolvedAs::Unused => Became::Unused,
            };
            (resolution.name.to_string(), found)
        });
        let mut used_by: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for equation in &program.equations {
            let user = equation.name.to_string();
            for name in equation.term.names() {
                let users = used_by.entry(name.to_string()).or_default();
                if !users.contains(&user) {
                    users.push(user.clone());
                }
            }
        }
        let mut statements: HashMap<String, Vec<String>> = HashMap::new();
        for statement in program.angles.iter().chain(&program.statements) {
            statements.entry(owner(statement).to_string()).or_default().push(statement.name.to_string());
        }
        let has_equation = |name| program.equations.iter().any(|equation| equation.name == name);
        let is_whole = program.statements.iter().map(owner).all(has_equation);
        let mut all = Self {
            robot,
            program,
            became: became.collect(),
            plain: HashMap::new(),
            used_by,
            statements,
            is_whole,
            reasons: Vec::new(),
        };
        all.find_plain();
        all
    }

    /// Returns the components of the chosen equations, in order.
    pub(crate) fn components(&mut self, is_here: impl Fn(&Equation) -> bool) -> Vec<Component> {
        let program = self.program;
        program.equations.iter().filter(|equation| is_here(equation)).map(|of| self.component(of)).collect()
    }

    /// Finds the components that the code does not compute because they are a symbol or a number, such as an element of
    /// a rotation that is s1, or an angular velocity that is qd1. One pass is enough, because an equation only uses
    /// earlier components.
    fn find_plain(&mut self) {
        for equation in &self.program.equations {
            let name = equation.name.to_string();
            if !matches!(self.became.get(&name), None | Some(Became::Unused)) {
                continue;
            }
            let tree = Tree::of_term(&equation.term, &mut |_, _| 0).map_names(&|name| self.here(name)).folded();
            let is_plain = match &tree {
                Tree::Name(_) | Tree::Number(_) => true,
                Tree::Node("neg", operands, _) => matches!(operands.as_slice(), [Tree::Name(_)]),
                Tree::Node(..) => false,
            };
            if is_plain && tree.names() != [name.as_str()] {
                self.plain.insert(name, tree);
            }
        }
    }

    /// Returns all reasons, to which trees refer by number.
    pub(crate) fn into_reasons(self) -> Vec<String> {
        self.reasons
    }

    /// Whether a value has a statement, or is a part of another value that has one. If some statement has no equation,
    /// like the sums of a floating base, it is unknown which values it uses, so the result is true.
    fn is_stated(&self, name: &str) -> bool {
        self.statements.contains_key(name)
            || !self.is_whole
            || self.used_by.get(name).is_some_and(|users| {
                users.iter().any(|user| match self.became.get(user) {
                    Some(Became::Constant { .. } | Became::Unused) => false,
                    _ => self.is_stated(user),
                })
            })
    }

    fn component(&mut self, equation: &Equation) -> Component {
        let name = equation.name.to_string();
        let (robot, reasons) = (self.robot, &mut self.reasons);
        let general = Tree::of_term(&equation.term, &mut |causes, magnitude| {
            let reason = rne_emit::reason(robot, causes, magnitude);
            reasons.iter().position(|known| *known == reason).unwrap_or_else(|| {
                reasons.push(reason);
                reasons.len() - 1
            })
        });
        // the rotation of a link's inertia is no step of the lecture, and its equation is long
        let general = match self.became.get(&name) {
            Some(Became::Constant { value, .. }) if equation.place.is_none() && general.size() > SIMPLE => {
                Tree::Number(*value)
            }
            _ => general,
        };
        let with_numbers = general.map_names(&|name| self.here(name)).to_string();
        let mut folded = Vec::new();
        self.fold(&general, &mut folded);
        folded.dedup();
        let statements = self.statements.get(&name).cloned().unwrap_or_default();
        let became = match self.became.get(&name) {
            // a torque that equals another value still has a statement of its own
            Some(Became::Same { .. }) if statements.contains(&name) => Became::Computed,
            // the code contains the same product, but for another value
            None | Some(Became::Inside) if !self.is_stated(&name) => Became::Unused,
            found => found.cloned().unwrap_or(Became::Inside),
        };
        Component {
            with_numbers,
            general,
            folded,
            became,
            statements,
            used_by: self.used_by.get(&name).cloned().unwrap_or_default(),
            name,
        }
    }

    /// Returns the tree that replaces a name for this robot.
    fn here(&self, name: &str) -> Tree {
        match self.became.get(name) {
            Some(Became::Constant { value, .. }) => Tree::Number(*value),
            Some(Became::Same { name }) => match name.strip_prefix('-') {
                Some(name) => Tree::Node("neg", vec![Tree::Name(name.to_owned())], None),
                None => Tree::Name(name.clone()),
            },
            _ => self.plain.get(name).cloned().unwrap_or_else(|| Tree::Name(name.to_owned())),
        }
    }

    /// Lists the largest terms that were folded away, from left to right.
    fn fold(&self, tree: &Tree, folded: &mut Vec<Folded>) {
        let Tree::Node(operator, operands, mark) = tree else { return };
        let (fold, why, name) = match mark {
            None => ("kept", None, None),
            Some(Mark { fold, why, name }) => (*fold, why.and_then(|why| self.reasons.get(why)), name.clone()),
        };
        let why = why.cloned().unwrap_or_default();
        let mut gone = |left: String, why: String| folded.push(Folded { term: tree.to_string(), left, why });
        match (*operator, fold) {
            ("*", "zero") => return gone("0".to_owned(), why),
            (_, "constant") => {
                let value = tree.map_names(&|name| self.here(name)).evaluate(&|_| f64::NAN);
                return gone(value.to_string(), "constants".to_owned());
            }
            (_, "cancelled") => return gone("0".to_owned(), "its terms cancel".to_owned()),
            (_, "shared") => {
                return gone(name.unwrap_or_else(|| "the same".to_owned()), "computed before".to_owned());
            }
            (_, "one") => gone(self.other_factor(operands), why),
            _ => {}
        }
        let is_sum = matches!(*operator, "+" | "-");
        for operand in operands {
            match operand {
                // a summand that is zero
                Tree::Name(name) if is_sum => {
                    if let Some(Became::Constant { value: 0.0, why }) = self.became.get(name) {
                        folded.push(Folded { term: name.clone(), left: "0".to_owned(), why: why.clone() });
                    }
                }
                _ => self.fold(operand, folded),
            }
        }
    }

    /// Returns the rest of a product with a factor of 1 or -1.
    fn other_factor(&self, operands: &[Tree]) -> String {
        let unit = |operand: &Tree| match operand.map_names(&|name| self.here(name)) {
            of if !of.names().is_empty() => None,
            of => Some(of.evaluate(&|_| f64::NAN)).filter(|value| value.abs() == 1.0),
        };
        let [a, b] = operands else { return String::new() };
        let (sign, left) = match (unit(b), unit(a)) {
            (Some(sign), _) => (sign, a),
            (None, Some(sign)) => (sign, b),
            (None, None) => return "its other factor".to_owned(),
        };
        if sign < 0.0 { Tree::Node("neg", vec![left.clone()], None).to_string() } else { left.to_string() }
    }
}

/// Returns the component that a statement computes, completely or in part.
pub(crate) fn owner(statement: &codegen::Statement) -> codegen::Name {
    codegen::Name { part: 0, ..statement.name }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use rne_codegen::{Compiler, Form, Function};

    use super::*;

    /// Returns an arbitrary number for a symbol, always the same one.
    fn letter(name: &str) -> f64 {
        let sum = name.bytes().fold(7_u32, |sum, byte| (sum * 31 + u32::from(byte)) % 1009);
        f64::from(sum) / 500.0 - 1.0
    }

    /// The values of components, computed from the equations only, each once.
    struct Values<'e> {
        equations: &'e Equations<'e>,
        trees: HashMap<String, Tree>,
        known: RefCell<HashMap<String, f64>>,
    }

    impl<'e> Values<'e> {
        fn new(equations: &'e Equations<'e>) -> Self {
            let tree = |equation: &Equation| (equation.name.to_string(), Tree::of_term(&equation.term, &mut |_, _| 0));
            let trees = equations.program.equations.iter().map(tree).collect();
            Self { equations, trees, known: RefCell::default() }
        }

        fn of(&self, name: &str) -> f64 {
            if let Some(value) = self.known.borrow().get(name) {
                return *value;
            }
            let evaluated = |tree: &Tree| tree.evaluate(&|name| self.of(name));
            let value = match self.trees.get(name) {
                Some(tree) => evaluated(tree),
                None => match self.equations.here(name) {
                    Tree::Name(own) if own == name => letter(name),
                    other => evaluated(&other),
                },
            };
            self.known.borrow_mut().insert(name.to_owned(), value);
            value
        }
    }

    #[test]
    fn what_is_dead_in_the_code_is_what_its_equation_says() {
        let mut compared = 0;
        for name in ["planar1", "planar2", "stanford", "puma560"] {
            let robot = Robot::from_yaml(rne_robots::find(name).expect("shipped").yaml).expect("valid");
            let compiler = Compiler::new(&robot).with_equations();
            let program = compiler.compile(Function::InverseDynamics, Form::SevenSteps).expect("it compiles");
            let equations = Equations::new(&robot, &program);
            let values = Values::new(&equations);
            for (name, tree) in &equations.plain {
                let (found, expected) = (tree.evaluate(&|name| values.of(name)), values.of(name));
                assert!((found - expected).abs() < 1e-12, "{name} is {tree}: {found}, not {expected}");
                compared += 1;
            }
            if name == "planar1" {
                let plain = |name: &str| equations.plain.get(name).map(ToString::to_string);
                let expected = [("rot1_yx", "s1"), ("rot1_xy", "-s1"), ("w1_z", "qd1"), ("ddc1_x", "")];
                for (name, expected) in expected {
                    assert_eq!(plain(name).unwrap_or_default(), expected, "{name}");
                }
            }
        }
        assert!(compared > 20, "{compared} components");
    }
}
