//! Symbols, vectors and rotations for the formulas of the reduced form, and the sheet on which they are written.

use std::cell::{Cell, RefCell};
use std::ops::{Add, Mul, Neg, Sub};

use super::point::Point;
use super::pseudo_inertia::Triple;
use super::rows::Row;
use super::sheet::{Identity, Leaf, Ref, Sheet};
use crate::exact::{Image, Number, Reading, Turn};
use crate::function::{Argument, Function};
use crate::ledger::Place;
use crate::name::{By, Name};
use crate::quantity::{Axis, Component, Quantity};
use rne_model::QuarterTurns;

/// The angle by which a joint, or a group of parallel joints, turns: a leaf up to sign and quarter turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angle {
    pub(crate) first: usize,
    pub(crate) last: usize,
    /// The constant part, if it is no right angle; counted with the sign of the first joint.
    pub(crate) constant: Option<Turn>,
    reversed: bool,
    quarters: QuarterTurns,
}

impl Angle {
    pub(crate) fn of(rows: &[Row], first: usize, last: usize) -> Self {
        let theta = rows[first..=last].iter().fold(Turn::NONE, |turn, row| turn.then(row.theta));
        let reversed = rows[first].reversed;
        let (constant, quarters) = match theta.quarters() {
            Some(quarters) => (None, quarters),
            None => (Some(if reversed { theta.back() } else { theta }), QuarterTurns::Zero),
        };
        Self { first, last, constant, reversed, quarters }
    }

    /// Sine and cosine of the leaf at a point.
    pub(crate) fn image(&self, rows: &[Row], point: &Point) -> (Image, Image) {
        let start = self.constant.map_or((Image::ZERO, Image::ONE), |turn| (turn.sin.image, turn.cos.image));
        (self.first..=self.last).fold(start, |(s, c), joint| {
            let (sine, cosine) = point.turn(joint);
            let sine = if rows[joint].reversed == self.reversed { sine } else { -sine };
            (s * cosine + c * sine, c * cosine - s * sine)
        })
    }
}

/// Names and places of nodes, for code that is read.
#[derive(Debug, Default)]
pub(crate) struct Naming {
    pub(crate) definitions: Vec<(Name, Ref)>,
    pub(crate) births: Vec<Option<(Place, Component)>>,
    place: Option<Place>,
}

/// The sheet being written, and where arguments come from.
pub(crate) struct Writer {
    pub(crate) sheet: RefCell<Sheet>,
    pub(crate) naming: Option<RefCell<Naming>>,
    function: Function,
    pub(crate) point: Point,
    /// The one joint that accelerates, while a column of the mass matrix is written; nothing moves then.
    accelerating: Cell<Option<usize>>,
    /// The variable of the derivatives that are being written.
    by: Cell<Option<By>>,
}

impl Writer {
    pub(crate) fn new(function: Function, reading: Reading, named: bool) -> Self {
        Self {
            sheet: RefCell::new(Sheet::new(Identity::Structure)),
            naming: named.then(RefCell::default),
            function,
            point: Point::new(reading, 0),
            accelerating: Cell::new(None),
            by: Cell::new(None),
        }
    }

    /// Starts anew, for another function or another reading of the numbers.
    pub(crate) fn restart(&mut self, reading: Reading) {
        self.sheet.get_mut().clear();
        self.point = Point::new(reading, 0);
    }

    pub(crate) fn number(&self, number: Number) -> Symbol<'_> {
        self.symbol(self.sheet.borrow_mut().constant(number))
    }

    pub(crate) fn zero(&self) -> Symbol<'_> {
        self.symbol(Sheet::zero())
    }

    pub(crate) fn zeros(&self) -> Vector<'_> {
        Vector([self.zero(); 3])
    }

    pub(crate) fn vector(&self, v: Triple) -> Vector<'_> {
        Vector(v.map(|x| self.number(x)))
    }

    pub(crate) fn symbol(&self, at: Ref) -> Symbol<'_> {
        Symbol { writer: self, at }
    }

    pub(crate) fn leaf(&self, leaf: Leaf, image: Image) -> Symbol<'_> {
        self.symbol(self.sheet.borrow_mut().leaf(leaf, image))
    }

    /// q of a prismatic joint.
    pub(crate) fn position(&self, rows: &[Row], joint: usize) -> Symbol<'_> {
        self.leaf(Leaf::Position(byte(joint)), self.point.position(joint)).signed(rows[joint].reversed)
    }

    pub(crate) fn rate(&self, rows: &[Row], joint: usize) -> Symbol<'_> {
        if !self.function.takes(Argument::Rates) || self.accelerating.get().is_some() {
            return self.zero();
        }
        self.leaf(Leaf::Rate(byte(joint)), self.point.rate(joint)).signed(rows[joint].reversed)
    }

    pub(crate) fn rate_dot(&self, rows: &[Row], joint: usize) -> Symbol<'_> {
        if let Some(accelerating) = self.accelerating.get() {
            let one = if accelerating == joint { self.number(Number::ONE) } else { self.zero() };
            return one.signed(accelerating == joint && rows[joint].reversed);
        }
        if !self.function.takes(Argument::Accelerations) {
            return self.zero();
        }
        self.leaf(Leaf::RateDot(byte(joint)), self.point.rate_dot(joint)).signed(rows[joint].reversed)
    }

    /// What `formulas` are when one joint accelerates with 1 and nothing moves.
    pub(crate) fn accelerating<R>(&self, joint: usize, formulas: impl FnOnce() -> R) -> R {
        self.accelerating.set(Some(joint));
        let by = self.by.replace(Some(By::RateDot(joint + 1)));
        let value = formulas();
        self.by.set(by);
        self.accelerating.set(None);
        value
    }

    /// τ of an actuator.
    pub(crate) fn torque(&self, joint: usize) -> Symbol<'_> {
        self.leaf(Leaf::Torque(byte(joint)), self.point.torque(joint))
    }

    /// Force and moment at the tip, if the function has them.
    pub(crate) fn wrench(&self) -> Option<(Vector<'_>, Vector<'_>)> {
        let axes = [0, 1, 2];
        self.function.takes(Argument::Wrench).then(|| {
            let force = axes.map(|axis| self.leaf(Leaf::Force(byte(axis)), self.point.force(axis)));
            let moment = axes.map(|axis| self.leaf(Leaf::Moment(byte(axis)), self.point.moment(axis)));
            (Vector(force), Vector(moment))
        })
    }

    /// The turn by the summed angle of joints `first` to `last`.
    pub(crate) fn turn(&self, rows: &[Row], first: usize, last: usize) -> SymbolicTurn<'_> {
        if self.function.takes(Argument::Sines) {
            return self.given_turn(rows, first, last);
        }
        let angle = Angle::of(rows, first, last);
        let (sine, cosine) = angle.image(rows, &self.point);
        let (from, to) = (byte(first), byte(last));
        let mut s = self.leaf(Leaf::Sine(from, to), sine).signed(angle.reversed);
        let mut c = self.leaf(Leaf::Cosine(from, to), cosine);
        let turns = match angle.quarters {
            QuarterTurns::Zero => 0,
            QuarterTurns::One => 1,
            QuarterTurns::Two => 2,
            QuarterTurns::Three => 3,
        };
        for _ in 0..turns {
            (s, c) = (c, -s);
        }
        SymbolicTurn { s, c }
    }

    /// The same from sines and cosines that are arguments, by the addition theorem.
    fn given_turn(&self, rows: &[Row], first: usize, last: usize) -> SymbolicTurn<'_> {
        let theta = rows[first..=last].iter().fold(Turn::NONE, |turn, row| turn.then(row.theta));
        (first..=last).fold(self.constant_turn(theta), |SymbolicTurn { s, c }, joint| {
            let (sine, cosine) = self.point.turn(joint);
            let sine = self.leaf(Leaf::GivenSine(byte(joint)), sine).signed(rows[joint].reversed);
            let cosine = self.leaf(Leaf::GivenCosine(byte(joint)), cosine);
            SymbolicTurn { s: s * cosine + c * sine, c: c * cosine - s * sine }
        })
    }

    /// A turn by a constant angle.
    pub(crate) fn constant_turn(&self, turn: Turn) -> SymbolicTurn<'_> {
        SymbolicTurn { s: self.number(turn.sin), c: self.number(turn.cos) }
    }

    /// The operations that follow belong to this quantity of this joint, counted from 1.
    pub(crate) fn at(&self, quantity: Quantity, joint: usize) {
        if let (Some(naming), Some(step)) = (&self.naming, quantity.step()) {
            let mut naming = naming.borrow_mut();
            self.settle(&mut naming, Component::Scalar);
            naming.place = Some(Place { joint, step, quantity, by: self.by.get() });
        }
    }

    /// Names the components of a vector.
    pub(crate) fn name<'s>(&'s self, quantity: Quantity, joint: usize, v: Vector<'s>) -> Vector<'s> {
        if self.naming.is_some() {
            for (axis, x) in Axis::ALL.into_iter().zip(v.0) {
                self.define(Name::vector(quantity, joint, axis), x);
            }
        }
        v
    }

    /// Names one value.
    pub(crate) fn define(&self, name: Name, x: Symbol<'_>) {
        if let Some(naming) = &self.naming {
            let mut naming = naming.borrow_mut();
            self.settle(&mut naming, name.component);
            let by = name.by.or(self.by.get()).filter(|_| name.quantity.step().is_some());
            naming.definitions.push((Name { by, ..name }, x.at));
        }
    }

    /// Nodes written since the last time belong to the place at hand.
    fn settle(&self, naming: &mut Naming, component: Component) {
        let len = self.sheet.borrow().nodes.len();
        let birth = naming.place.map(|place| (place, component));
        naming.births.resize(len, birth);
    }
}

/// Joints are at most 64.
pub(crate) fn byte(joint: usize) -> u8 {
    u8::try_from(joint).unwrap_or(u8::MAX)
}

/// A number on the sheet.
#[derive(Clone, Copy)]
pub(crate) struct Symbol<'s> {
    writer: &'s Writer,
    pub(crate) at: Ref,
}

impl Symbol<'_> {
    pub(crate) fn is_zero(self) -> bool {
        self.at == Sheet::zero()
    }

    pub(crate) fn signed(self, negative: bool) -> Self {
        Self { at: self.at.signed(negative), ..self }
    }

    /// 1/x
    pub(crate) fn inverse(self) -> Self {
        Self { at: self.writer.sheet.borrow_mut().inverse(self.at), ..self }
    }

    /// Times a constant.
    pub(crate) fn times(self, factor: Number) -> Self {
        if self.is_zero() { self } else { self * self.writer.number(factor) }
    }
}

impl<'s> Add for Symbol<'s> {
    type Output = Symbol<'s>;

    fn add(self, other: Self) -> Self {
        Self { at: self.writer.sheet.borrow_mut().sum(self.at, other.at), ..self }
    }
}

impl<'s> Sub for Symbol<'s> {
    type Output = Symbol<'s>;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<'s> Mul for Symbol<'s> {
    type Output = Symbol<'s>;

    fn mul(self, other: Self) -> Self {
        Self { at: self.writer.sheet.borrow_mut().product(self.at, other.at), ..self }
    }
}

impl Neg for Symbol<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        // zero has no sign
        self.signed(!self.is_zero())
    }
}

/// Three symbols along x, y, z.
#[derive(Clone, Copy)]
pub(crate) struct Vector<'s>(pub(crate) [Symbol<'s>; 3]);

impl<'s> Vector<'s> {
    /// a × b
    pub(crate) fn cross(self, other: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        Self([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
    }

    /// a · b
    pub(crate) fn dot(self, other: Self) -> Symbol<'s> {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        ax * bx + ay * by + az * bz
    }

    pub(crate) fn times(self, factor: Number) -> Self {
        Self(self.0.map(|x| x.times(factor)))
    }

    /// v + x z
    pub(crate) fn plus_z(self, x: Symbol<'s>) -> Self {
        let [a, b, c] = self.0;
        Self([a, b, c + x])
    }

    pub(crate) fn is_zero(self) -> bool {
        self.0.iter().all(|x| x.is_zero())
    }
}

impl Add for Vector<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self([0, 1, 2].map(|k| self.0[k] + other.0[k]))
    }
}

impl<'s> Mul<Symbol<'s>> for Vector<'s> {
    type Output = Self;

    fn mul(self, factor: Symbol<'s>) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

/// A turn: sine and cosine, about x or about z as it is used.
#[derive(Clone, Copy)]
pub(crate) struct SymbolicTurn<'s> {
    pub(crate) s: Symbol<'s>,
    pub(crate) c: Symbol<'s>,
}

impl<'s> SymbolicTurn<'s> {
    /// Rx v
    pub(crate) fn about_x(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x, y * c - z * s, y * s + z * c])
    }

    /// Rxᵀ v
    pub(crate) fn back_about_x(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x, y * c + z * s, z * c - y * s])
    }

    /// Rz v
    pub(crate) fn about_z(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x * c - y * s, x * s + y * c, z])
    }

    /// Rzᵀ v
    pub(crate) fn back_about_z(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x * c + y * s, y * c - x * s, z])
    }
}
