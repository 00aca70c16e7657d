//! The table of a robot in letters.
//!
//! Zeros of the file are zeros here, and right angles are exact. Numbers that the file gives by its parameters are
//! formulas of these. Each other number is a letter with a name as in textbooks: m1, a2, d3, x_C2, I2_xx.

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
    /// Sine and cosine of θ; they are letters for a revolute joint.
    pub(crate) theta: (Polynomial, Polynomial),
    /// The offset d; a letter for a prismatic joint.
    pub(crate) d: Polynomial,
    /// The constant part of d.
    pub(crate) d_constant: Polynomial,
    pub(crate) a: Polynomial,
    /// Sine and cosine of α.
    pub(crate) alpha: (Polynomial, Polynomial),
    pub(crate) mass: Polynomial,
    /// Centre of mass in the link frame of the table.
    pub(crate) com: Vector,
    /// Inertia about the centre of mass, in the axes of the table's link frame.
    pub(crate) inertia: Matrix,
    /// First moment, about the end of `com`, that is not due to the mass, in the same axes; zero for every real body.
    pub(crate) first_moment: Vector,
    /// Rotor inertia G² Jm if rotors belong to the arm, otherwise 0.
    pub(crate) rotor: Polynomial,
}

/// The arm in letters.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// The robot, reduced to the joints of the rows.
    pub(crate) robot: Robot,
    pub(crate) convention: Convention,
    pub(crate) rows: Vec<Row>,
    /// The acceleration of gravity in frame 0.
    pub(crate) gravity: Vector,
    pub(crate) constants: Constants,
    /// The angles that are letters, with their values in the file; for a joint, the constant part.
    pub(crate) angles: Vec<(Angle, Turn)>,
    /// The constant part of d in the file, for each prismatic joint.
    pub(crate) offsets: Vec<f64>,
}

/// Gives letters to numbers, in the order in which factors are written.
struct Letters<'r> {
    robot: &'r Robot,
    constants: Constants,
    /// The letter of each parameter of the file; `None` before it is first used.
    parameters: Vec<Option<Symbol>>,
    angles: Vec<(Angle, Turn)>,
}

/// Returns the parameters that have the unit of a formula: its summands, each with a number as factor.
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

    /// Converts a formula of parameters to a polynomial; `None` if it divides by a sum.
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

    /// Returns a number of the table: zero, a formula, or a letter with this name.
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
        // a formula that divides by a sum or is too long is replaced by a letter
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

    /// Returns sine and cosine of a constant angle.
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

    /// Returns the acceleration of gravity: a single component is ±g, several are gx, gy, gz.
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

    /// Returns the inertia as written in the file. Principal moments with equal numbers have the same letter.
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
    /// Makes the table of the first `joints` rows of a robot; its run-time parameters are letters.
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
            // row i of a modified table has the length and the twist after link i - 1; in a tree, several rows may have
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
        // the tip is free, so its placement has no effect on torques
        robot.tip_on = None;
        Self { convention: robot.convention, robot, rows, gravity, constants, angles, offsets }
    }

    /// Returns the row, counted from 0, whose beginning is rotated by an angle that is no multiple of a right angle, so
    /// that its sine is no fraction.
    pub(crate) fn oblique(&self) -> Option<usize> {
        let is_oblique = |branch: &FixedFrame| branch.placement.rpy.iter().any(|angle| angle.right.is_none());
        self.robot.joints.iter().position(|joint| joint.branch.as_ref().is_some_and(is_oblique))
    }

    /// Returns the value of a letter for positions, rates and accelerations of the joint variables q.
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

/// Returns the names of variables, matrices and torques in the equations, which a parameter may have by chance.
fn structure(kinds: &[JointKind]) -> Vec<String> {
    let joints = 1..=kinds.len();
    let mut names: Vec<String> = joints
        .clone()
        .flat_map(|i| ["h", "theta", "tau", "gamma", "alpha"].map(|letter| format!("{letter}{i}")))
        .chain(["alpha0".to_owned()])
        .collect();
    let slides = joints.clone().zip(kinds).filter(|(_, kind)| **kind == JointKind::Prismatic);
    names.extend(slides.map(|(i, _)| format!("d{i}")));
    // with ten or more joints, indices are separated by commas
    if kinds.len() < 10 {
        for (i, j) in joints.clone().flat_map(|i| joints.clone().map(move |j| (i, j))) {
            names.push(format!("M{i}{j}"));
            names.extend(joints.clone().map(|k| format!("c{i}{j}{k}")));
        }
    }
    names
}

/// Returns the rotor inertia G² Jm if rotors belong to the arm, otherwise 0; a gear ratio of 1 is no letter.
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

/// Returns an inertia tensor about the centre of mass: unchanged, or converted from the origin of the link frame.
fn about_com(written: &Inertia<Polynomial>, moved: Option<(&Polynomial, &Vector)>) -> Matrix {
    let Inertia { xx, yy, zz, xy, xz, yz } = written;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    Matrix([0, 1, 2].map(|i| {
        Vector([0, 1, 2].map(|j| {
            let Some((mass, com)) = moved else { return rows[i][j].clone() };
            // parallel axis theorem: I = J - m (c·c 1 - c cᵀ)
            let square = if i == j { com.dot(com) } else { Polynomial::zero() };
            rows[i][j] - &(mass * &(square - &com.0[i] * &com.0[j]))
        }))
    }))
}
