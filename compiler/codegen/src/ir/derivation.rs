//! How the constants of a program are computed from the numbers of the robot file: for checkers that share no code with
//! the compiler.
//!
//! A constant is known by its image in the fields of the proof. While [`recorded`] runs, each operation on constants
//! notes from which images it computed its result. The first way to compute an image is kept, so no constant depends on
//! itself. Outside [`recorded`], an operation only reads a flag of its thread.

use rustc_hash::FxHashMap;
use std::cell::{Cell, RefCell};

use super::numbers::canonical;
use super::{ExactAngle, Name, Number, Residue};

/// The exact constants of a program, by name: each as a number and, if it is an angle, as its sine and cosine.
pub(crate) type Exactly = FxHashMap<Name, (Number, Option<ExactAngle>)>;

/// A step of an expression. Operands are given by their indices among the steps before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExactStep {
    /// A number of the robot file, or a small integer: exactly the shortest decimal that is read as this `f64`.
    Decimal(f64),
    /// The sine of an angle of the robot file, rad.
    Sine(f64),
    /// The cosine of an angle of the robot file, rad.
    Cosine(f64),
    /// -a
    Negative(usize),
    /// a + b
    Sum(usize, usize),
    /// a · b
    Product(usize, usize),
    /// 1/a
    Inverse(usize),
    /// √a
    Root(usize),
}

/// The exact value of a constant, given by indices of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExactConstant {
    /// A number, by the index of its step.
    Number(usize),
    /// The angle with this sine and this cosine, rad, between -π and π.
    Angle {
        /// The index of the step that computes its sine.
        sine: usize,
        /// The index of the step that computes its cosine.
        cosine: usize,
    },
}

/// The exact expressions of the constants of a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Derivation {
    /// The steps. An operand comes before the step that uses it.
    pub steps: Vec<ExactStep>,
    /// The constants, by their names.
    pub constants: Vec<(Name, ExactConstant)>,
}

/// The operation that computed an image, with the images of its operands.
#[derive(Clone, Copy)]
pub(crate) enum Way {
    Decimal(f64),
    Sine(f64),
    Cosine(f64),
    Sum(Residue, Residue),
    Product(Residue, Residue),
    Inverse(Residue),
    Root(Residue),
}

thread_local! {
    static IS_ON: Cell<bool> = const { Cell::new(false) };
    /// The constants of the programs that were lowered while recording.
    static LOWERED: RefCell<Vec<Exactly>> = const { RefCell::new(Vec::new()) };
    /// For each image without its sign: whether the way computes the negative image, and the way.
    static WAYS: RefCell<FxHashMap<Residue, (bool, Way)>> = RefCell::new(FxHashMap::default());
}

/// Runs an action; returns its result and the ways in which all its constants were computed.
pub(crate) fn recorded<T>(act: impl FnOnce() -> T) -> (T, Ways) {
    WAYS.take();
    LOWERED.take();
    IS_ON.set(true);
    // the constant 1 of the compiler
    note(Residue::ONE, || Way::Decimal(1.0));
    let result = act();
    IS_ON.set(false);
    (result, Ways { ways: WAYS.take(), lowered: LOWERED.take() })
}

/// Notes the constants of a program that is lowered, while [`recorded`] runs.
pub(crate) fn note_program(constants: &Exactly) {
    if IS_ON.get() {
        LOWERED.with_borrow_mut(|lowered| lowered.push(constants.clone()));
    }
}

/// Notes how an image is computed, while [`recorded`] runs.
pub(crate) fn note(image: Residue, way: impl FnOnce() -> Way) {
    if !IS_ON.get() || image.is_zero() {
        return;
    }
    WAYS.with_borrow_mut(|ways| {
        let (key, negative) = canonical(image);
        if ways.contains_key(&key) {
            return;
        }
        let way = way();
        let is_known = |operand: Residue| operand.is_zero() || ways.contains_key(&canonical(operand).0);
        let is_rooted = match way {
            Way::Decimal(_) | Way::Sine(_) | Way::Cosine(_) => true,
            Way::Sum(a, b) | Way::Product(a, b) => is_known(a) && is_known(b),
            Way::Inverse(a) | Way::Root(a) => is_known(a),
        };
        if is_rooted {
            ways.insert(key, (negative, way));
        }
    });
}

/// How images were computed, and the constants of all programs that were lowered.
#[derive(Default)]
pub(crate) struct Ways {
    ways: FxHashMap<Residue, (bool, Way)>,
    lowered: Vec<Exactly>,
}

impl Ways {
    /// Returns the exact expressions of a program's constants, given by name and value; `None` if one of them was not
    /// computed by recorded operations.
    pub(crate) fn derivation(&self, constants: &[(Name, f64)]) -> Option<Derivation> {
        let is_of_program = |exactly: &&Exactly| {
            constants.iter().all(|(name, value)| exactly.get(name).is_some_and(|(number, _)| number.to_f64() == *value))
        };
        // the last program that fits: earlier ones were refused, or are those that the program was compared with
        let exactly = self.lowered.iter().rev().find(is_of_program)?;
        let mut derivation = Derivation::default();
        let mut places = FxHashMap::default();
        for &(name, _) in constants {
            let (number, turn) = exactly.get(&name)?;
            let mut place = |number: &Number| self.place(number.residue, &mut derivation.steps, &mut places);
            let exact = match turn {
                None => ExactConstant::Number(place(number)?),
                Some(turn) => ExactConstant::Angle { sine: place(&turn.sin)?, cosine: place(&turn.cos)? },
            };
            derivation.constants.push((name, exact));
        }
        Some(derivation)
    }

    fn place(
        &self,
        image: Residue,
        steps: &mut Vec<ExactStep>,
        places: &mut FxHashMap<Residue, usize>,
    ) -> Option<usize> {
        if let Some(&place) = places.get(&image) {
            return Some(place);
        }
        let (key, negative) = canonical(image);
        let step = if image.is_zero() {
            ExactStep::Decimal(0.0)
        } else {
            let (way_is_negative, way) = *self.ways.get(&key)?;
            if way_is_negative == negative {
                let mut operand = |image| self.place(image, steps, places);
                match way {
                    Way::Decimal(value) => ExactStep::Decimal(value),
                    Way::Sine(angle) => ExactStep::Sine(angle),
                    Way::Cosine(angle) => ExactStep::Cosine(angle),
                    Way::Sum(a, b) => ExactStep::Sum(operand(a)?, operand(b)?),
                    Way::Product(a, b) => ExactStep::Product(operand(a)?, operand(b)?),
                    Way::Inverse(a) => ExactStep::Inverse(operand(a)?),
                    Way::Root(a) => ExactStep::Root(operand(a)?),
                }
            } else {
                ExactStep::Negative(self.place(-image, steps, places)?)
            }
        };
        steps.push(step);
        places.insert(image, steps.len() - 1);
        Some(steps.len() - 1)
    }
}
