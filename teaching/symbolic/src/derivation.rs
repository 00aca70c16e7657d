//! Derives torques by the compiler's seven steps over polynomials.
//!
//! The steps are compiled for an arm all of whose numbers, except zeros and right angles, are run-time parameters. The
//! program is then run with the letters of the table for these numbers.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use rne_codegen::{Arguments, Axis, Compiler, Form, Function, Interpreter, Name, Quantity, Real};
use rne_model::{Angle as Turn, Entry, Formula, InertiaElement, JointKind, Motor, Robot, RunTime, Transform};

use crate::polynomial::Polynomial;
use crate::rational::exact;
use crate::symbol::{Angle, Symbol};
use crate::table::Table;
use crate::vector::{Matrix, Vector};

/// The error that a polynomial of the derivation has too many terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooLong;

/// The results of the seven steps for an arm in letters: torques, and the requested quantities.
#[derive(Debug)]
pub(crate) struct Derivation {
    values: HashMap<Name, Polynomial>,
}

impl Derivation {
    /// Derives the torques, and every component of some quantities.
    pub(crate) fn new(table: &Table, quantities: &[Quantity]) -> Result<Self, TooLong> {
        let (derivation, is_too_long) = Self::run(table, quantities, Polynomial::clone)?;
        if is_too_long { Err(TooLong) } else { Ok(derivation) }
    }

    /// Derives quantities that do not depend on motion and gravity, which are set to zero.
    pub(crate) fn at_rest(table: &Table, quantities: &[Quantity]) -> Result<Self, TooLong> {
        Ok(Self::run(table, quantities, |_| Polynomial::zero())?.0)
    }

    /// Runs the program, and returns whether a polynomial became too long; `moving` is applied to rates, accelerations
    /// and gravity.
    fn run(
        table: &Table,
        quantities: &[Quantity],
        moving: impl Fn(&Polynomial) -> Polynomial,
    ) -> Result<(Self, bool), TooLong> {
        let Lettered { robot, mut parameters, gravity } = Lettered::new(table);
        for parameter in parameters.iter_mut().take(gravity) {
            *parameter = moving(parameter);
        }
        let compiler = Compiler::new(&robot).with_intermediates(quantities);
        let program = compiler.compile(Function::InverseDynamics, Form::SevenSteps).map_err(|_| TooLong)?;
        let pages = Pages::default();
        let symbols = |of: fn(usize) -> Symbol, change: &dyn Fn(&Polynomial) -> Polynomial| -> Vec<Value<'_>> {
            (0..robot.dof()).map(|joint| pages.add(change(&Polynomial::symbol(of(joint))))).collect()
        };
        let (q, qd) = (symbols(Symbol::Position, &Polynomial::clone), symbols(Symbol::Rate, &moving));
        let qdd = symbols(Symbol::Acceleration, &moving);
        let parameters: Vec<Value<'_>> = parameters.into_iter().map(|parameter| pages.add(parameter)).collect();
        let zero = pages.add(Polynomial::zero());
        let arguments = Arguments { parameters: &parameters, ..Arguments::of_joints(&q, &qd, &qdd, zero) };
        let number = |value| pages.add(Polynomial::number(exact(value)));
        let outputs = Interpreter::new(&program).run(&arguments, number, Value::sine_and_cosine).ok_or(TooLong)?;
        let polynomials = pages.polynomials.borrow();
        let value = |value: &Value<'_>| polynomials[value.at].clone();
        let names = program.outputs.iter().map(|output| output.name);
        let values = names.zip(outputs.iter().map(value)).collect();
        Ok((Self { values }, pages.too_long.get().is_some()))
    }

    fn value(&self, name: Name) -> Polynomial {
        self.values.get(&name).cloned().unwrap_or_else(Polynomial::zero)
    }

    /// Returns the torques or forces of all actuators, base to tip.
    pub(crate) fn torques(&self) -> Vec<Polynomial> {
        let torque = |joint| self.values.get(&Name::scalar(Quantity::Torque, joint)).cloned();
        (1..).map_while(torque).collect()
    }

    /// Returns a vector quantity of a joint, counted from 1.
    pub(crate) fn vector(&self, quantity: Quantity, joint: usize) -> Vector {
        Vector(Axis::ALL.map(|axis| self.value(Name::vector(quantity, joint, axis))))
    }

    /// Returns a matrix quantity of a joint, counted from 1.
    pub(crate) fn matrix(&self, quantity: Quantity, joint: usize) -> Matrix {
        let row = |row| Vector(Axis::ALL.map(|column| self.value(Name::matrix(quantity, joint, row, column))));
        Matrix(Axis::ALL.map(row))
    }
}

/// The arm of a table whose numbers, except zeros and right angles, are run-time parameters.
struct Lettered {
    robot: Robot,
    /// The values of the parameters: letters, or polynomials of letters.
    parameters: Vec<Polynomial>,
    /// How many parameters at the beginning are components of gravity.
    gravity: usize,
}

impl Lettered {
    fn new(table: &Table) -> Self {
        let mut robot = Robot {
            run_time: RunTime::default(),
            base: Transform::IDENTITY,
            tool: Transform::IDENTITY,
            rotors: true,
            ..table.robot.clone()
        };
        let mut entries: Vec<(Entry, Polynomial)> = Vec::new();
        let triple = |of: &dyn Fn(usize) -> Entry, vector: &Vector, entries: &mut Vec<(Entry, Polynomial)>| {
            entries.extend(vector.0.iter().enumerate().map(|(axis, component)| (of(axis), component.clone())));
        };
        triple(&Entry::Gravity, &table.gravity, &mut entries);
        let gravity = table.gravity.0.iter().filter(|component| !component.is_zero()).count();
        for (i, (row, joint)) in table.rows.iter().zip(&mut robot.joints).enumerate() {
            let dh = &mut joint.row.dh;
            let is_revolute = row.kind == JointKind::Revolute;
            // the letters of a joint variable include its constant part
            let d = if is_revolute { row.d.clone() } else { Polynomial::zero() };
            if is_revolute {
                dh.theta = Turn::ZERO;
            } else if dh.theta.right.is_none() {
                let (sine, cosine) = row.theta.clone();
                entries.extend([(Entry::ThetaSine(i), sine), (Entry::ThetaCosine(i), cosine)]);
            }
            if dh.alpha.right.is_none() {
                let (sine, cosine) = row.alpha.clone();
                entries.extend([(Entry::AlphaSine(i), sine), (Entry::AlphaCosine(i), cosine)]);
            }
            joint.motor = Some(Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.0, coulomb: [0.0; 2] });
            let (a, mass, rotor) = (row.a.clone(), row.mass.clone(), row.rotor.clone());
            entries.extend([(Entry::D(i), d), (Entry::A(i), a), (Entry::Mass(i), mass)]);
            entries.push((Entry::MotorInertia(i), rotor));
            triple(&|axis| Entry::Com(i, axis), &row.com, &mut entries);
            triple(&|axis| Entry::FirstMoment(i, axis), &row.first_moment, &mut entries);
            let places = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
            let element =
                |(element, (j, k)): (_, (usize, usize))| (Entry::Inertia(i, element), row.inertia.0[j].0[k].clone());
            entries.extend(InertiaElement::ALL.into_iter().zip(places).map(element));
        }
        let mut parameters = Vec::new();
        for (entry, polynomial) in entries {
            // of a run-time parameter, the compiler uses only whether it is zero
            if let Some(number) = robot.number_mut(entry) {
                *number = if polynomial.is_zero() { 0.0 } else { 1.0 };
            }
            if !polynomial.is_zero() {
                robot.run_time.entries.push((entry, Formula::Parameter(parameters.len())));
                robot.run_time.names.push(format!("p{}", parameters.len()));
                parameters.push(polynomial);
            }
        }
        Self { robot, parameters, gravity }
    }
}

/// The polynomials of a derivation. After one that is too long, no more are computed.
#[derive(Default)]
struct Pages {
    polynomials: RefCell<Vec<Polynomial>>,
    too_long: Cell<Option<usize>>,
}

impl Pages {
    fn add(&self, polynomial: Polynomial) -> Value<'_> {
        let mut polynomials = self.polynomials.borrow_mut();
        if polynomial.is_too_long() {
            self.too_long.set(Some(polynomials.len()));
        }
        polynomials.push(polynomial);
        Value { pages: self, at: polynomials.len() - 1 }
    }
}

/// A polynomial of a derivation, which the interpreter uses as its number type.
#[derive(Clone, Copy)]
struct Value<'p> {
    pages: &'p Pages,
    at: usize,
}

impl Value<'_> {
    fn made(self, of: impl FnOnce(&[Polynomial]) -> Polynomial) -> Self {
        if let Some(at) = self.pages.too_long.get() {
            return Self { at, ..self };
        }
        let polynomial = of(&self.pages.polynomials.borrow());
        self.pages.add(polynomial)
    }

    /// Returns sine and cosine of the variable of a revolute joint.
    fn sine_and_cosine(self) -> (Self, Self) {
        let joint = match self.pages.polynomials.borrow()[self.at].single().map(|(monomial, _)| monomial.0.as_slice()) {
            Some([(Symbol::Position(joint), 1)]) => Angle::Joint(*joint),
            _ => unreachable!("the angles of an arm in letters are its joint variables"),
        };
        let [sine, cosine] =
            [Symbol::Sine(joint), Symbol::Cosine(joint)].map(|symbol| self.made(|_| Polynomial::symbol(symbol)));
        (sine, cosine)
    }
}

macro_rules! operators {
    ($($operation:ident $method:ident $operator:tt),*) => {$(
        impl $operation for Value<'_> {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                self.made(|all| &all[self.at] $operator &all[other.at])
            }
        }
    )*};
}
operators! { Add add +, Sub sub -, Mul mul * }

impl Neg for Value<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.made(|all| -&all[self.at])
    }
}

/// Not used: the seven steps have no divisions.
impl Div for Value<'_> {
    type Output = Self;

    fn div(self, _: Self) -> Self {
        unreachable!("the seven steps have no quotients")
    }
}

impl Real for Value<'_> {
    fn by_sign(self, _: Self, _: Self) -> Self {
        unreachable!("the seven steps ask for no signs")
    }
}
