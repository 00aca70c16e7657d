//! The results of the lecture's example, 1 to 10, as its page has them in the lecture's symbols:
//! `docs/teaching/lecture/results.md`.
//!
//! Each is the polynomial that the seven steps find, turned into the lecture's frame, the number that the runtime
//! finds, and what the page shows of both.

use rne_codegen::Quantity;
use rne_model::Robot;
use rne_runtime::DynArm;

use crate::derivation::Derivation;
use crate::polynomial::Polynomial;
use crate::rational::{exact, fraction};
use crate::symbol::{Angle, Symbol};
use crate::table::Table;
use crate::{ClosedForm, read};

/// θ, θ̇, θ̈ of the commands on the page.
const STATE: [f64; 3] = [0.6, 1.3, -0.7];

fn of_docs(file: &str) -> String {
    let path = format!("{}/../../docs/teaching/lecture/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn rod() -> Robot {
    read("rod.yaml", of_docs("rod.yaml").as_bytes()).unwrap_or_else(|report| panic!("{report}"))
}

/// A formula in the lecture's symbols, read as a polynomial: sums of products of letters, powers, sines of θ,
/// parentheses, divided by whole numbers.
struct Reader<'t> {
    rest: &'t str,
    table: &'t Table,
}

impl Reader<'_> {
    fn take(&mut self, text: &str) -> bool {
        self.rest = self.rest.trim_start();
        let rest = self.rest.strip_prefix(text);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn sum(&mut self) -> Polynomial {
        let mut sum = if self.take("-") { -&self.product() } else { self.product() };
        loop {
            if self.take("+") {
                sum = sum + self.product();
            } else if self.take("-") {
                sum = &sum - &self.product();
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> Polynomial {
        let mut product = self.power();
        loop {
            self.rest = self.rest.trim_start();
            if self.take("/") {
                let divisor = self.whole_number().expect("a divisor");
                product = product.scaled(&fraction(1, divisor));
            } else if self.rest.is_empty() || self.rest.starts_with(['+', '-', ')', ',']) {
                return product;
            } else {
                product = &product * &self.power();
            }
        }
    }

    fn power(&mut self) -> Polynomial {
        let base = self.base();
        if self.take("²") { &base * &base } else { base }
    }

    fn base(&mut self) -> Polynomial {
        if self.take("(") {
            let sum = self.sum();
            assert!(self.take(")"), "not closed: {}", self.rest);
            return sum;
        }
        if let Some(number) = self.whole_number() {
            return Polynomial::integer(number);
        }
        let angle = Angle::Joint(0);
        let (rate, acceleration) = (Symbol::Rate(0), Symbol::Acceleration(0));
        // with the joint's number behind, or, as the lecture has it, without
        let variables =
            [("sin θ", Symbol::Sine(angle)), ("cos θ", Symbol::Cosine(angle)), ("θ̈", acceleration), ("θ̇", rate)];
        for (text, symbol) in variables {
            if self.take(text) {
                self.take("1");
                return Polynomial::symbol(symbol);
            }
        }
        let constants = &self.table.constants.0;
        let known = constants.iter().position(|constant| self.rest.trim_start().starts_with(&constant.name));
        let index = known.unwrap_or_else(|| panic!("what is {}?", self.rest));
        assert!(self.take(&constants[index].name));
        Polynomial::symbol(Symbol::Constant(index))
    }

    fn whole_number(&mut self) -> Option<i64> {
        self.rest = self.rest.trim_start();
        let digits = self.rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest.len());
        let (number, rest) = self.rest.split_at(digits);
        let number = number.parse().ok()?;
        self.rest = rest;
        Some(number)
    }
}

/// The components of a formula: three in parentheses, or a number.
fn components(formula: &str, table: &Table) -> Vec<Polynomial> {
    let is_vector = formula.starts_with('(') && formula.contains(", ");
    let inside = if is_vector { formula.strip_prefix('(').and_then(|all| all.strip_suffix(')')) } else { None };
    let read = |text: &str| {
        let mut reader = Reader { rest: text, table };
        let sum = reader.sum();
        assert_eq!(reader.rest.trim(), "", "{text}");
        sum
    };
    inside.unwrap_or(formula).split(", ").map(read).collect()
}

/// Results 1 to 10 by the seven steps, and by the runtime.
fn found(robot: &Robot, table: &Table) -> Vec<(Vec<Polynomial>, Vec<f64>)> {
    let vectors = [
        Quantity::Omega,
        Quantity::OmegaDot,
        Quantity::Velocity,
        Quantity::Acceleration,
        Quantity::Gravity,
        Quantity::InertiaForce,
        Quantity::InertiaMoment,
        Quantity::JointForce,
        Quantity::JointMoment,
    ];
    let derivation = Derivation::new(table, &[&vectors[..], &[Quantity::Rotation]].concat()).expect("it is short");
    // the lecture's frame 1 is the base frame
    let rotation = derivation.matrix(Quantity::Rotation, 1);
    let turned = vectors.map(|quantity| (&rotation * &derivation.vector(quantity, 1)).0.to_vec());
    let [q, qd, qdd] = STATE.map(|value| [value]);
    let base = rne_runtime::BaseMotion::fixed(robot.gravity);
    let trace = DynArm::from_robot(robot).trace(&q, &qd, &qdd, &base, None).expect("one joint").to_lecture();
    let [of] = trace.as_slice() else { panic!("one link") };
    let numbers = [
        of.omega,
        of.omega_dot,
        of.velocity,
        of.acceleration,
        of.gravity,
        of.inertia_force,
        of.inertia_moment,
        of.joint_force,
        of.joint_moment,
    ];
    let vectors = turned.into_iter().zip(numbers.map(|numbers| numbers.to_vec()));
    vectors.chain([(derivation.torques(), vec![of.tau])]).collect()
}

/// The cells of the table's rows.
fn rows(page: &str) -> Vec<Vec<&str>> {
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.as_bytes()[2].is_ascii_digit());
    rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`')).collect()).collect()
}

#[test]
fn the_page_has_the_lectures_results_and_they_are_ours() {
    let (page, robot) = (of_docs("results.md"), rod());
    let table = Table::new(&robot, 1);
    let (rows, found) = (rows(&page), found(&robot, &table));
    assert_eq!((rows.len(), found.len()), (10, 10));
    for (at, (row, (polynomials, numbers))) in rows.iter().zip(&found).enumerate() {
        let [number, _, file, formula, printed] = row.as_slice() else { panic!("{row:?}") };
        assert_eq!((*number, *file), ((at + 1).to_string().as_str(), "rod.yaml"));
        let formulas = components(formula, &table);
        assert_eq!(formulas, *polynomials, "result {number}: {formula}");
        for (polynomial, number) in formulas.iter().zip(numbers) {
            let [q, qd, qdd] = STATE.map(|value| [value]);
            let value = polynomial.evaluate(|symbol| table.value(symbol, &q, &qd, &qdd));
            assert!((value - number).abs() <= 1e-14, "{formula}: {value}, not {number}");
        }
        // the line that the command on the page prints
        let line = page.lines().find(|line| line.get(4..).is_some_and(|line| line.starts_with(&format!("{printed} "))));
        let line = line.unwrap_or_else(|| panic!("nothing is printed of {printed}"));
        let shown: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let shown = &shown[shown.len() - shown.len().min(numbers.len())..];
        assert_eq!(shown.len(), numbers.len(), "{line}");
        assert!(shown.iter().zip(numbers).all(|(a, b)| (a - b).abs() < 6e-7), "{line}: {numbers:?}");
    }
    // τ in closed form, as it is printed
    let closed = ClosedForm::of(&robot, 1).text();
    let torque = closed.lines().find_map(|line| line.strip_prefix("  τ1 = ")).expect("a torque");
    assert!(page.contains(&format!("\n  τ1 = {torque}\n")), "{torque}");
    assert_eq!(components(torque, &table), found[9].0);
}

/// Specification 5.1, with the digits it prints; and E16, which the page names: θ̇ where θ̈ belongs.
#[test]
#[allow(clippy::excessive_precision)] // the digits as they are printed
fn the_rod_is_the_lectures_and_a_misprint_is_noticed() {
    let robot = rod();
    let table = Table::new(&robot, 1);
    let found = found(&robot, &table);
    let expected = [
        (2, [-0.293_614_086_165_418_39, 0.429_174_519_753_032_71, 0.0]),
        (3, [-0.399_826_983_128_332_63, -0.612_792_284_189_753_82, 0.0]),
        (5, [-0.999_567_457_820_831_57, -1.531_980_710_474_384_6, 0.0]),
        (6, [0.0, 0.0, -0.093_333_333_333_333_333]),
        (7, [-25.524_567_457_820_832, -1.531_980_710_474_384_6, 0.0]),
        (8, [0.0, 0.0, 5.165_809_330_671_963_5]),
    ];
    for (at, numbers) in expected {
        for (found, expected) in found[at].1.iter().zip(numbers) {
            assert!((found - expected).abs() < 1e-13, "result {}: {found}, not {expected}", at + 1);
        }
    }
    let printed = components("(m a²/12) θ̈ + (m a²/4) θ̇ + (1/2) m g a sin θ", &table);
    assert_ne!(printed[0], found[8].0[2]);
    let [mass, length] = [2.5, 0.8].map(exact);
    assert_eq!([robot.joints[0].row.link.mass, robot.joints[0].row.dh.a].map(exact), [mass, length]);
}
