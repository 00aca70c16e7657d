//! The compiled function: its values in order, the statements that name them, and how every operation was folded.
//!
//! A `Program` is rendered in many ways: as tokens, text, counts, by an interpreter, by a machine.

use rustc_hash::FxHashSet;

use crate::CompileError;
use crate::equation::Equation;
use crate::expression::Expression;
use crate::function::{Form, Function, Layout, Sizes};
use crate::ir::{Causes, FoldReport, Name, Operator, Place, Sign};
use crate::named::named;
use crate::reduced::{Algorithm, JointFrame, Parameters};
use crate::refusal::Refusal;
use crate::values::{Value, ValueId, Values};

named! {
    /// The order of the statements of a program.
    Order, "order" {
        /// The order of its formulas, joint by joint.
        Formulas = "formulas",
        /// An order in which few values are alive at once.
        Registers = "registers",
    }
}

/// A function of one robot as straight-line code.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The robot's name.
    pub robot: String,
    /// Number of coordinates, the joints that follow no other.
    pub dof: usize,
    /// Number of joints.
    pub joints: usize,
    /// The joints that follow no other, counted from 1, in the order of the elements of q.
    pub coordinates: Vec<usize>,
    /// The dependent joints of closed loops, counted from 1.
    pub passive: Vec<usize>,
    /// How many equations the closed loops have.
    pub equations_of_loops: usize,
    /// Number of parameters that are known at run time only.
    pub parameters: usize,
    /// The function.
    pub function: Function,
    /// The frame of the function, by its name in the robot file; `None` for the tip.
    pub frame: Option<String>,
    /// The names of the frames that carry wrenches, in the order of the wrenches.
    pub tips: Vec<String>,
    /// The name of its code: that of the function, or with a frame for example `jacobian_of_camera`.
    pub name: String,
    /// Its form: the seven steps, or reduced.
    pub form: Form,
    /// All values, in the order in which they are computed: arguments, constants, angles, sines and cosines, values of
    /// statements, and results without a statement.
    pub values: Values,
    /// Angles that are sums.
    pub angles: Vec<Statement>,
    /// The sines and cosines of all joint angles, evaluated at once.
    pub sines_and_cosines: Vec<SineCosine>,
    /// The values that have statements, in order.
    pub statements: Vec<Statement>,
    /// The values returned: those of the function in the order of [`Function::layout`], then intermediate quantities
    /// that were asked for.
    pub outputs: Vec<Output>,
    /// How every quantity of the recursion appears in the code, in the order of the recursion.
    pub resolutions: Vec<Resolution>,
    /// How every operation of the recursion was folded.
    pub fold_report: FoldReport,
    /// Its formulas before folding, component by component in the order in which they are computed; only for the seven
    /// steps, and only if they were asked for ([`crate::Compiler::with_equations`]).
    pub equations: Vec<Equation>,
    /// The algorithm by which it is written.
    pub algorithm: Algorithm,
    /// Whether the graph of its formulas was made smaller by algebra: it resembles no recursion any more.
    pub is_rewritten: bool,
    /// The order of its statements.
    pub order: Order,
    /// The factors of lengths and forces, if the code measures them in units of the arm.
    pub scales: Vec<Scales>,
    /// The choices of a program that is not the seven steps, one line each.
    pub choices: Vec<String>,
    /// The evidence that a program that is not the seven steps gives their numbers.
    pub proof: Option<Proof>,
    /// The largest error in single precision at random states, in parts of the largest number that it returns at any of
    /// them, if that is above 1e-4 (1e-2 if the function solves by the mass matrix). For the seven steps it is known if
    /// frames of the table are far from the arm, or after [`measured`](crate::measured).
    pub loss: Option<f64>,
    /// The reduced forms that were tried before this one and refused, in order.
    pub refusals: Vec<Refusal>,
}

/// The evidence that a program computes what the seven steps compute.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Proof {
    /// Number of random points of two prime fields at which all numbers are identical.
    pub points: usize,
    /// Number of random states at which the rounding was measured.
    pub states: usize,
    /// The largest difference of a torque from the seven steps at these states in double precision, relative to the
    /// largest torque.
    pub rounding: f64,
    /// The largest difference of the program in single precision from the seven steps in double precision, relative to
    /// the largest torque.
    pub single: f64,
    /// The largest difference of the seven steps in single precision from themselves in double precision, relative to
    /// the largest torque.
    pub single_of_seven_steps: f64,
    /// (products, sums) of the seven steps before folding.
    pub before: (usize, usize),
}

/// The factors by which the form `reduced` multiplies lengths and forces, so that constants become 1. Results are in SI
/// units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// The joint on the base, counted from 1, that carries the links whose values are scaled; `None` for all links.
    pub behind: Option<usize>,
    /// λ, by which lengths, and the velocities and accelerations of points, are multiplied.
    pub length: f64,
    /// μ, by which forces are multiplied.
    pub force: f64,
}

impl Scales {
    /// Returns the factors that are not 1: one entry for all links, or one per joint on the base.
    pub(crate) fn of(rows: &[JointFrame], Parameters { lambda, mu, .. }: &Parameters) -> Vec<Self> {
        let on_base = (0..rows.len()).filter(|&index| rows[index].parent.is_none());
        let factors = on_base.map(|index| Self {
            behind: Some(index + 1),
            length: lambda[index].to_f64(),
            force: mu[index].to_f64(),
        });
        let mut factors: Vec<Self> = factors.collect();
        let is_one = |of: &Self, other: &Self| (of.length, of.force) == (other.length, other.force);
        if factors.iter().all(|of| is_one(of, &factors[0])) {
            factors.truncate(1);
            for all in &mut factors {
                all.behind = None;
            }
        }
        factors.retain(|of| (of.length, of.force) != (1.0, 1.0));
        factors
    }
}

/// A named constant. A number that is used for two entries of the table occurs once with each name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// Its name.
    pub name: Name,
    /// Its value, finite.
    pub value: f64,
}

/// One statement: a name and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Step, joint and quantity that it belongs to.
    pub place: Place,
    /// The name of its value.
    pub name: Name,
    /// The value.
    pub value: ValueId,
}

/// Sine and cosine of an angle; a name is `None` when it is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct SineCosine {
    /// Joint and quantity that it belongs to.
    pub place: Place,
    /// Name of the sine.
    pub sine: Option<Name>,
    /// Name of the cosine.
    pub cosine: Option<Name>,
    /// The angle, rad.
    pub angle: ValueId,
}

/// A returned value.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name.
    pub name: Name,
    /// The value.
    pub value: ValueId,
}

/// How a component of a quantity appears in the code.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// The component.
    pub name: Name,
    /// How it appears in the code.
    pub value: ResolvedAs,
}

/// How a component of a quantity appears in the code.
#[derive(Clone, Debug, PartialEq)]
pub enum ResolvedAs {
    /// It is computed by the statement of its own name.
    Computed,
    /// It equals the value of another name, or its negative: an earlier statement or an argument.
    Same(Name, Sign),
    /// It is a constant: its value, and the causes of this value.
    Constant(f64, Causes),
    /// It is computed inside another statement.
    Inside,
    /// Nothing that is returned depends on it.
    Unused,
}

/// Operations of one evaluation. A subtraction counts as an addition, a negation is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Multiplications.
    pub mul: usize,
    /// Additions and subtractions.
    pub add: usize,
    /// Divisions.
    pub div: usize,
    /// Angles whose sine or cosine is used.
    pub sincos: usize,
    /// Statements.
    pub statements: usize,
}

impl Operations {
    /// Multiplications and additions together.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.mul + self.add
    }
}

impl Program {
    /// The shape of its results.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.function.layout(self.sizes())
    }

    /// The lengths of its arrays.
    #[must_use]
    pub fn sizes(&self) -> Sizes {
        Sizes { dof: self.dof, tips: self.tips.len(), passive: self.passive.len(), equations: self.equations_of_loops }
    }

    /// Refuses two variables with the same name, because the second would shadow the first. Names are compared as text
    /// in the generated code, together with the variables that renderers add.
    ///
    /// # Errors
    /// [`CompileError::TwoOfOneName`], with the first such name.
    pub fn check_names(&self) -> Result<(), CompileError> {
        let mut taken: FxHashSet<String> = self.reserved_names().map(str::to_owned).collect();
        let turns = self.sines_and_cosines.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten();
        let constants = self.constants().map(|constant| constant.name);
        let statements = self.angles.iter().chain(&self.statements).map(|statement| statement.name);
        let names = self.arguments().chain(constants).chain(turns).chain(statements);
        match names.map(|name| name.to_string()).find(|text| !taken.insert(text.clone())) {
            Some(name) => Err(CompileError::TwoOfOneName { function: self.function, name }),
            None => Ok(()),
        }
    }

    /// (products, sums) of the seven steps before folding, step 3 included.
    #[must_use]
    pub fn before(&self) -> (usize, usize) {
        self.proof.map_or_else(|| self.fold_report.before(), |proof| proof.before)
    }

    /// The names of the arguments that are used, in order: they are the first values.
    pub fn arguments(&self) -> impl Iterator<Item = Name> {
        let arguments = self.values.iter().take_while(|(_, value)| *value == Value::Argument);
        arguments.filter_map(|(id, _)| self.values.name(id))
    }

    /// The constants that are used.
    pub fn constants(&self) -> impl Iterator<Item = Constant> {
        self.values.iter().filter_map(|(id, value)| match value {
            Value::Constant(value) => Some(Constant { name: self.values.name(id)?, value }),
            _ => None,
        })
    }

    /// The expressions of the statements, then those that are returned.
    pub fn expressions(&self) -> impl Iterator<Item = Expression<'_>> {
        let statements = self.statements.iter().map(|statement| self.values.defined(statement.value));
        statements.chain(self.outputs.iter().map(|output| self.values.used(output.value)))
    }

    /// Sums of angles, then the angles whose sines and cosines are evaluated.
    pub fn angle_expressions(&self) -> impl Iterator<Item = Expression<'_>> {
        let angles = self.angles.iter().map(|statement| self.values.defined(statement.value));
        angles.chain(self.sines_and_cosines.iter().map(|turn| self.values.used(turn.angle)))
    }

    /// Returns the program with its values in the order in which they are written, without unused ones.
    pub(crate) fn in_written_order(self) -> Self {
        let mut moving = Moving { old: &self.values, new: vec![None; self.values.len()], values: Values::default() };
        let is_leaf = |(_, value): &(ValueId, Value)| matches!(value, Value::Argument | Value::Constant(_));
        for (id, _) in self.values.iter().take_while(is_leaf) {
            moving.value(id);
        }
        let angles = moving.statements(&self.angles);
        let mut turn = |old: &SineCosine| SineCosine { angle: moving.value(old.angle), ..old.clone() };
        let sines_and_cosines = self.sines_and_cosines.iter().map(&mut turn).collect();
        let is_turn = |(_, value): &(ValueId, Value)| matches!(value, Value::Sine(_) | Value::Cosine(_));
        for (id, _) in self.values.iter().filter(is_turn) {
            moving.value(id);
        }
        let statements = moving.statements(&self.statements);
        let mut output = |old: &Output| Output { value: moving.value(old.value), ..old.clone() };
        let outputs = self.outputs.iter().map(&mut output).collect();
        let values = moving.values;
        Self { values, angles, sines_and_cosines, statements, outputs, ..self }
    }

    /// The number of values before those of the statements: arguments, constants, angles, sines and cosines.
    #[must_use]
    pub fn before_statements(&self) -> usize {
        let is_turn = |(_, value): &(ValueId, Value)| matches!(value, Value::Sine(_) | Value::Cosine(_));
        match self.values.iter().rev().find(is_turn) {
            Some((last, _)) => last.index() + 1,
            None => self.arguments().count() + self.constants().count(),
        }
    }

    /// Whether a value is chosen by a sign somewhere.
    #[must_use]
    pub fn chooses_by_sign(&self) -> bool {
        self.values.iter().any(|(_, value)| matches!(value, Value::BySign(_)))
    }

    /// Whether the code contains the constant 0, because it is returned or chosen by a sign.
    pub fn returns_zero(&self) -> bool {
        self.values.iter().any(|(id, value)| matches!(value, Value::Constant(_)) && self.values.name(id).is_none())
    }

    /// Whether its algorithm uses composite or articulated bodies (CRBA or ABA).
    pub const fn is_of_bodies(&self) -> bool {
        matches!(self.algorithm, Algorithm::Crba(_) | Algorithm::Aba(_))
    }

    /// Whether its statements are in the order of a recursion, joint by joint.
    #[must_use]
    pub fn follows_recursion(&self) -> bool {
        !self.is_rewritten && self.order == Order::Formulas
    }

    /// Whether the program is so long that the processor needs more time to read its instructions than to compute its
    /// longest chain of operations: then code with the fewest instructions is the fastest.
    #[must_use]
    pub fn is_long(&self) -> bool {
        /// The code of more operations does not fit into the first-level instruction cache of current processors, 32
        /// KB.
        const LONG: usize = 4000;
        self.operations().total() > LONG
    }

    /// The operations of one evaluation.
    #[must_use]
    pub fn operations(&self) -> Operations {
        // all sines and cosines are one statement
        let statements = self.angles.len() + usize::from(!self.sines_and_cosines.is_empty()) + self.statements.len();
        let mut count = Operations { statements, sincos: self.sines_and_cosines.len(), ..Operations::default() };
        for (_, value) in self.values.iter() {
            match value {
                Value::Binary(Operator::Sum | Operator::Difference, ..) => count.add += 1,
                Value::Binary(Operator::Product, ..) => count.mul += 1,
                Value::Binary(Operator::Quotient, ..) => count.div += 1,
                Value::Fused(_) => (count.mul, count.add) = (count.mul + 1, count.add + 1),
                _ => {}
            }
        }
        count
    }
}

/// Copies values from one list into another.
struct Moving<'v> {
    old: &'v Values,
    new: Vec<Option<ValueId>>,
    values: Values,
}

impl Moving<'_> {
    /// Returns the place of a value in the new list, after copying its operands and the value if needed.
    fn value(&mut self, id: ValueId) -> ValueId {
        if let Some(new) = self.new[id.index()] {
            return new;
        }
        let value = self.old.get(id).map(|operand| self.value(operand));
        let new = self.values.push(self.old.name(id), value);
        self.new[id.index()] = Some(new);
        new
    }

    fn statements(&mut self, old: &[Statement]) -> Vec<Statement> {
        old.iter().map(|old| Statement { value: self.value(old.value), ..old.clone() }).collect()
    }
}
