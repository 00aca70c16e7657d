//! The table of a robot in letters.
//!
//! Zeros of the file are zeros here, and right angles are exact. Of the other numbers those that the file writes
//! by its parameters are formulas of these; each of the rest is a letter, called as textbooks do: m1, a2, d3, x_C2,
//! I2_xx.

use rne_model::{
    Angle as Turn, Convention, Entry, FixedFrame, Formula, Inertia, InertiaElement, InertiaReference, JointKind, Robot,
};

use crate::polynomial::Polynomial;
use crate::rational::exact;
use crate::symbol::{Angle, Constant, Constants, Kind, Symbol};
use crate::vector::{Matrix, Vector};

/// One row with its link, in letters.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) kind: JointKind,
    /// Sine and cosine of θ; of a revolute joint they are letters.
    pub(crate) theta: (Polynomial, Polynomial),
    /// d; of a prismatic joint a letter.
    pub(crate) d: Polynomial,
    /// The constant part of d.
    pub(crate) d_constant: Polynomial,
    pub(crate) a: Polynomial,
    /// Sine and cosine of α.
    pub(crate) alpha: (Polynomial, Polynomial),
    pub(crate) mass: Polynomial,
    /// Centre of mass in the link frame of the table.
    pub(crate) com: Vector,
    /// About the centre of mass, in the axes of the table's link frame.
    pub(crate) inertia: Matrix,
    /// First moment about the end of `com` that no mass accounts for, in the same axes; zero of every body.
    pub(crate) first_moment: Vector,
    /// G² Jm, where rotors belong to the arm.
    pub(crate) rotor: Polynomial,
}

/// The arm in letters.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// The robot with the joints of the rows alone.
    pub(crate) robot: Robot,
    pub(crate) convention: Convention,
    pub(crate) rows: Vec<Row>,
    /// The acceleration of gravity in frame 0.
    pub(crate) gravity: Vector,
    pub(crate) constants: Constants,
    /// The angles that are letters, with their value in the file: of a joint the constant part.
    pub(crate) angles: Vec<(Angle, Turn)>,
    /// The constant part of d of each prismatic joint, in the file.
    pub(crate) offsets: Vec<f64>,
}

/// Gives letters to numbers, in the order in which factors are written.
struct Letters<'r> {
    robot: &'r Robot,
    constants: Constants,
    /// The letter of each parameter of the file, once it was met.
    parameters: Vec<Option<Symbol>>,
    angles: Vec<(Angle, Turn)>,
}

/// The parameters of a formula that have its unit: those that it is a sum of, each times a number.
fn summands(formula: &Formula) -> Vec<usize> {
    match formula {
        Formula::Parameter(index) => vec![*index],
        Formula::Negative(x) => summands(x),
        Formula::Sum(x, y) | Formula::Difference(x, y) => [summands(x), summands(y)].concat(),
        Formula::Product(x, y) => match (&**x, &**y) {
            (Formula::Number(_), other) | (other, Formula::Number(_)) => summands(other),
            _ => Vec::new(),
        },
        Formula::Quotient(x, y) if matches!(**y, Formula::Number(_)) => summands(x),
        _ => Vec::new(),
    }
}

impl Letters<'_> {
    fn parameter(&mut self, index: usize, kind: Kind) -> Polynomial {
        let known = self.parameters.get(index).copied().flatten();
        let symbol = known.unwrap_or_else(|| {
            let name = self.robot.run_time.names.get(index).cloned().unwrap_or_default();
            let value =
                self.robot.parameters.iter().find(|(known, _)| *known == name).map_or(f64::NAN, |known| known.1);
            let constant = Constant { name, kind, value, unit: "", is_parameter: true, also: Vec::new() };
            let symbol = self.constants.add(constant);
            if let Some(place) = self.parameters.get_mut(index) {
                *place = Some(symbol);
            }
            symbol
        });
        Polynomial::symbol(symbol)
    }

    /// A formula of parameters; `None` where it divides by a sum.
    fn formula(&mut self, formula: &Formula, kind: Kind) -> Option<Polynomial> {
        Some(match formula {
            Formula::Number(value) => Polynomial::number(exact(*value)),
            Formula::Parameter(index) => self.parameter(*index, kind),
            Formula::Negative(x) => -self.formula(x, kind)?,
            Formula::Sum(x, y) => self.formula(x, kind)? + self.formula(y, kind)?,
            Formula::Difference(x, y) => self.formula(x, kind)? - self.formula(y, kind)?,
            Formula::Product(x, y) => self.formula(x, kind)? * self.formula(y, kind)?,
            Formula::Quotient(x, y) => self.formula(x, kind)? * self.formula(y, kind)?.inverse()?,
        })
    }

    /// A number of the table: zero, a formula, or a letter of this name.
    fn number(
        &mut self,
        written: Option<&Formula>,
        value: f64,
        name: &str,
        (kind, unit): (Kind, &'static str),
    ) -> Polynomial {
        if value == 0.0 {
            return Polynomial::zero();
        }
        // a sum to divide by, or a formula that grew too long: a letter stands for it
        let formula = written.and_then(|written| self.formula(written, kind));
        for parameter in written.map(summands).unwrap_or_default() {
            if let Some(Some(Symbol::Constant(at))) = self.parameters.get(parameter)
                && let Some(constant) = self.constants.0.get_mut(*at).filter(|constant| constant.unit.is_empty())
            {
                constant.unit = unit;
            }
        }
        if let Some(formula) = formula.filter(|formula| !formula.is_too_long()) {
            return formula;
        }
        let constant = Constant { name: name.to_owned(), kind, value, unit, is_parameter: false, also: Vec::new() };
        Polynomial::symbol(self.constants.add(constant))
    }

    fn entry(&mut self, entry: Entry, value: f64, name: &str, kind: (Kind, &'static str)) -> Polynomial {
        let robot = self.robot;
        self.number(robot.run_time.formula(entry), value, name, kind)
    }

    /// Sine and cosine of a constant angle.
    fn turn(&mut self, angle: Angle, turn: &Turn) -> (Polynomial, Polynomial) {
        if let Some(right) = turn.right {
            let (sine, cosine) = right.sin_cos();
            return (Polynomial::number(exact(sine)), Polynomial::number(exact(cosine)));
        }
        self.variable_turn(angle, turn)
    }

    fn variable_turn(&mut self, angle: Angle, turn: &Turn) -> (Polynomial, Polynomial) {
        self.angles.push((angle, *turn));
        (Polynomial::symbol(Symbol::Sine(angle)), Polynomial::symbol(Symbol::Cosine(angle)))
    }

    /// The acceleration of gravity: one component is ±g, several are gx, gy, gz.
    fn gravity(&mut self) -> Vector {
        let components = self.robot.gravity;
        let is_single = components.iter().filter(|component| **component != 0.0).count() == 1;
        Vector([(0, "gx"), (1, "gy"), (2, "gz")].map(|(axis, name)| {
            let (value, kind) = (components[axis], (Kind::Gravity, "m/s²"));
            let written = self.robot.run_time.formula(Entry::Gravity(axis)).cloned();
            match (written, is_single) {
                (None, true) if value < 0.0 => -self.number(None, -value, "g", kind),
                (None, true) => self.number(None, value, "g", kind),
                (written, _) => self.number(written.as_ref(), value, name, kind),
            }
        }))
    }

    /// The inertia as the file writes it. Principal moments that are the same number are one letter.
    fn written_inertia(&mut self, joint: usize) -> Inertia<Polynomial> {
        let (tensor, about) = &self.robot.joints[joint].written_inertia;
        let letter = if *about == InertiaReference::Com { 'I' } else { 'J' };
        let run_time = &self.robot.run_time;
        let [xx, yy, zz, xy, xz, yz] = InertiaElement::ALL;
        let mut known: Vec<(f64, Symbol)> = Vec::new();
        let mut element = |element: InertiaElement| {
            let value = *element.of(tensor);
            let written = match about {
                InertiaReference::Com => run_time.formula(Entry::Inertia(joint, element)),
                InertiaReference::Origin => run_time
                    .written_inertia
                    .iter()
                    .find(|(of, which, _)| (*of, *which) == (joint, element))
                    .map(|(.., formula)| formula),
            };
            let name = format!("{letter}{}_{}", joint + 1, element.key());
            let is_moment = matches!(element, InertiaElement::Xx | InertiaElement::Yy | InertiaElement::Zz);
            let same = known.iter().find(|(number, _)| is_moment && written.is_none() && *number == value);
            if let Some(&(_, symbol)) = same {
                if let Symbol::Constant(index) = symbol {
                    self.constants.0[index].also.push(name);
                }
                return Polynomial::symbol(symbol);
            }
            let number = self.number(written, value, &name, (Kind::Other, "kg m²"));
            if let (None, Some((monomial, _))) = (written, number.single()) {
                known.extend(monomial.0.first().map(|(symbol, _)| (value, *symbol)));
            }
            number
        };
        Inertia { xx: element(xx), yy: element(yy), zz: element(zz), xy: element(xy), xz: element(xz), yz: element(yz) }
    }
}

impl Table {
    /// The first `joints` rows of a robot; its run-time parameters are letters.
    pub(crate) fn new(robot: &Robot, joints: usize) -> Self {
        let mut letters = Letters {
            robot,
            constants: Constants::default(),
            parameters: vec![None; robot.run_time.names.len()],
            angles: Vec::new(),
        };
        let robot_rows: Vec<_> = robot.rows().take(joints).copied().collect();
        let masses: Vec<Polynomial> = robot_rows
            .iter()
            .enumerate()
            .map(|(i, row)| letters.entry(Entry::Mass(i), row.link.mass, &format!("m{}", i + 1), (Kind::Mass, "kg")))
            .collect();
        let gravity = letters.gravity();
        let inertias: Vec<Inertia<Polynomial>> = (0..robot_rows.len()).map(|i| letters.written_inertia(i)).collect();
        let rotors: Vec<Polynomial> = (0..robot_rows.len()).map(|i| rotor(&mut letters, i)).collect();
        let mut rows = Vec::with_capacity(robot_rows.len());
        let mut offsets = Vec::new();
        for (i, row) in robot_rows.iter().enumerate() {
            // row i of a modified table has the length and the twist behind link i - 1; in a tree several rows have
            // those of one link
            let behind = match robot.convention {
                Convention::Modified if robot.is_serial() => i,
                _ => i + 1,
            };
            let length = (Kind::Other, "m");
            let a = letters.entry(Entry::A(i), row.dh.a, &format!("a{behind}"), length);
            let is_revolute = row.kind == JointKind::Revolute;
            let d_name = format!("d{}{}", i + 1, if is_revolute { "" } else { "_0" });
            let d_constant = letters.entry(Entry::D(i), row.dh.d, &d_name, length);
            let com = [(0, 'x'), (1, 'y'), (2, 'z')].map(|(axis, letter)| {
                letters.entry(Entry::Com(i, axis), row.link.com[axis], &format!("{letter}_C{}", i + 1), length)
            });
            let moment = (Kind::Other, "kg m");
            let first_moment = Vector([(0, 'x'), (1, 'y'), (2, 'z')].map(|(axis, letter)| {
                let name = format!("mc{letter}{}", i + 1);
                letters.entry(Entry::FirstMoment(i, axis), row.link.first_moment[axis], &name, moment)
            }));
            let alpha = letters.turn(Angle::Twist(behind), &row.dh.alpha);
            let theta = match row.kind {
                JointKind::Revolute => letters.variable_turn(Angle::Joint(i), &row.dh.theta),
                JointKind::Prismatic => letters.turn(Angle::Turn(i), &row.dh.theta),
            };
            let d = if is_revolute { d_constant.clone() } else { Polynomial::symbol(Symbol::Position(i)) };
            offsets.push(if is_revolute { 0.0 } else { row.dh.d });
            let (mass, com) = (masses[i].clone(), Vector(com));
            let about_origin = robot.joints[i].written_inertia.1 == InertiaReference::Origin;
            let inertia = about_com(&inertias[i], about_origin.then_some((&mass, &com)));
            let rotor = rotors[i].clone();
            rows.push(Row { kind: row.kind, theta, d, d_constant, a, alpha, mass, com, inertia, first_moment, rotor });
        }
        let Letters { mut constants, angles, .. } = letters;
        constants.distinguish(structure(&robot_rows.iter().map(|row| row.kind).collect::<Vec<_>>()));
        let mut robot = robot.clone();
        robot.joints.truncate(rows.len());
        // the tip is free: no torque depends on its place
        robot.tip_on = None;
        Self { convention: robot.convention, robot, rows, gravity, constants, angles, offsets }
    }

    /// The row that begins at an angle that is not a multiple of a right angle, counted from 0: no fractions tell its
    /// sine.
    pub(crate) fn oblique(&self) -> Option<usize> {
        let is_oblique = |branch: &FixedFrame| branch.placement.rpy.iter().any(|angle| angle.right.is_none());
        self.robot.joints.iter().position(|joint| joint.branch.as_ref().is_some_and(is_oblique))
    }

    /// The values of all letters in a state of the arm: positions, rates and accelerations of the joint variables q.
    pub(crate) fn value(&self, symbol: Symbol, q: &[f64], qd: &[f64], qdd: &[f64]) -> f64 {
        let value_of = |values: &[f64], joint: usize| values.get(joint).copied().unwrap_or(f64::NAN);
        let angle = |angle: Angle| {
            let constant = self.angles.iter().find(|(known, _)| *known == angle).map_or(0.0, |(_, turn)| turn.radians);
            match angle {
                Angle::Joint(joint) => value_of(q, joint) + constant,
                Angle::Twist(_) | Angle::Turn(_) => constant,
            }
        };
        match symbol {
            Symbol::Constant(index) => self.constants.0.get(index).map_or(f64::NAN, |constant| constant.value),
            Symbol::Position(joint) => value_of(q, joint) + value_of(&self.offsets, joint),
            Symbol::Sine(turn) => angle(turn).sin(),
            Symbol::Cosine(turn) => angle(turn).cos(),
            Symbol::Rate(joint) => value_of(qd, joint),
            Symbol::Acceleration(joint) => value_of(qdd, joint),
        }
    }
}

/// The names of variables, matrices and torques in the equations, which a parameter might have too.
fn structure(kinds: &[JointKind]) -> Vec<String> {
    let joints = 1..=kinds.len();
    let mut names: Vec<String> = joints
        .clone()
        .flat_map(|i| ["h", "theta", "tau", "gamma", "alpha"].map(|letter| format!("{letter}{i}")))
        .chain(["alpha0".to_owned()])
        .collect();
    let slides = joints.clone().zip(kinds).filter(|(_, kind)| **kind == JointKind::Prismatic);
    names.extend(slides.map(|(i, _)| format!("d{i}")));
    // more joints than that have commas between their indices
    if kinds.len() < 10 {
        for (i, j) in joints.clone().flat_map(|i| joints.clone().map(move |j| (i, j))) {
            names.push(format!("M{i}{j}"));
            names.extend(joints.clone().map(|k| format!("c{i}{j}{k}")));
        }
    }
    names
}

/// G² Jm, where rotors belong to the arm; a gear ratio of 1 is no letter.
fn rotor(letters: &mut Letters<'_>, joint: usize) -> Polynomial {
    let robot = letters.robot;
    let Some(motor) = robot.joints[joint].motor.filter(|_| robot.rotors) else { return Polynomial::zero() };
    let inertia =
        letters.entry(Entry::MotorInertia(joint), motor.inertia, &format!("Jm{}", joint + 1), (Kind::Other, "kg m²"));
    let is_direct = motor.gear_ratio.abs() == 1.0 && robot.run_time.formula(Entry::GearRatio(joint)).is_none();
    let ratio = if is_direct {
        Polynomial::integer(1)
    } else {
        letters.entry(Entry::GearRatio(joint), motor.gear_ratio, &format!("G{}", joint + 1), (Kind::Other, ""))
    };
    &(&ratio * &ratio) * &inertia
}

/// A tensor about the centre of mass: as it is, or from that about the origin of the link frame.
fn about_com(written: &Inertia<Polynomial>, moved: Option<(&Polynomial, &Vector)>) -> Matrix {
    let Inertia { xx, yy, zz, xy, xz, yz } = written;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    Matrix([0, 1, 2].map(|i| {
        Vector([0, 1, 2].map(|j| {
            let Some((mass, com)) = moved else { return rows[i][j].clone() };
            // Steiner: I = J - m (c·c 1 - c cᵀ)
            let square = if i == j { com.dot(com) } else { Polynomial::zero() };
            rows[i][j] - &(mass * &(square - &com.0[i] * &com.0[j]))
        }))
    }))
}
