//! The compiled function: constants and named statements, in order, and what became of every operation.
//!
//! One `Program`, many renderers: tokens, text, counts, an interpreter.

use std::collections::{BTreeSet, HashMap, HashSet};

use crate::CompileError;
use crate::emit;
use crate::function::{Form, Function};
use crate::ir::ledger::{Causes, Ledger, Place};
use crate::ir::name::Name;
use crate::ir::{Number, Turn as ConstantTurn};

/// A function of one robot as straight-line code.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The robot's name.
    pub robot: String,
    /// Number of joints.
    pub dof: usize,
    /// Number of parameters that are known at run time only.
    pub parameters: usize,
    /// The function.
    pub function: Function,
    /// How it is computed.
    pub form: Form,
    /// The arguments that are used.
    pub arguments: Vec<Name>,
    /// The constants that are used.
    pub constants: Vec<Constant>,
    /// Angles that are sums, each using only what stands before it.
    pub angles: Vec<Statement>,
    /// The sines and cosines of all joint angles, evaluated at once.
    pub turns: Vec<Turn>,
    /// The statements, each using only what stands before it.
    pub statements: Vec<Statement>,
    /// The values returned, in the order of [`Function::layout`], then what was asked to be kept.
    pub outputs: Vec<Output>,
    /// What every quantity of the recursion became, in its order.
    pub findings: Vec<Finding>,
    /// What became of every operation of the recursion.
    pub ledger: Ledger,
    /// Whether the graph of its formulas was made smaller by algebra: it resembles no recursion any more.
    pub is_rewritten: bool,
    /// The choices of a program that is not the seven steps, one line each.
    pub choices: Vec<String>,
    /// Why a program that is not the seven steps gives their torques.
    pub proof: Option<Proof>,
}

/// The evidence that a program computes what the seven steps compute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proof {
    /// At how many random points of two prime fields all torques are identical.
    pub points: usize,
    /// At how many random states the rounding was measured.
    pub states: usize,
    /// The largest difference of a torque from the seven steps there in double precision, relative to the largest
    /// torque.
    pub rounding: f64,
    /// The same in single precision, from double precision.
    pub single: f64,
    /// The same of the seven steps themselves in single precision.
    pub single_of_seven_steps: f64,
    /// (products, sums) of the seven steps before folding.
    pub before: (usize, usize),
}

/// What a constant of a program is exactly, as a number and, if it is an angle, as a turn.
pub(crate) type Exactly = HashMap<Name, (Number, Option<ConstantTurn>)>;

/// A named constant. A number that is two entries of the table stands under each name that the statements use.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// Its name.
    pub name: Name,
    /// Its value, finite.
    pub value: f64,
}

/// Whether a value enters as itself or negated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// As itself.
    Plus,
    /// Negated.
    Minus,
}

/// One statement: a name and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Step, joint and quantity that it belongs to.
    pub place: Place,
    /// The name of its value.
    pub name: Name,
    /// The value.
    pub value: Expression,
}

/// Sine and cosine of an angle; a name is `None` when it is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// Joint and quantity that it belongs to.
    pub place: Place,
    /// Name of the sine.
    pub sine: Option<Name>,
    /// Name of the cosine.
    pub cosine: Option<Name>,
    /// The angle, rad.
    pub angle: Expression,
}

/// An expression over arguments, constants and earlier statements.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// An argument, a constant or an earlier statement.
    Variable(Name),
    /// The constant 0, where a function returns one.
    Zero,
    /// -a
    Negative(Box<Expression>),
    /// a + b
    Sum(Box<Expression>, Box<Expression>),
    /// a - b
    Difference(Box<Expression>, Box<Expression>),
    /// a · b
    Product(Box<Expression>, Box<Expression>),
    /// a / b
    Quotient(Box<Expression>, Box<Expression>),
    /// One of two values by the sign of the first: positive, negative; 0 where that is 0.
    BySign(Box<Expression>, Box<Expression>, Box<Expression>),
}

/// A returned value.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Expression,
}

/// What a component of a quantity became.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The component.
    pub name: Name,
    /// What it became.
    pub value: Found,
}

/// What a component of a quantity became in the code.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// It is computed by the statement of its own name.
    Computed,
    /// It is another name, or its negative: an earlier statement or an argument.
    Same(Name, Sign),
    /// It is a constant, and why it is that one.
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
    /// Refuses two variables of one name. Names are compared as the text that a language sees, with the variables that
    /// the emitters add: the second of two would shadow the first.
    ///
    /// # Errors
    /// [`CompileError::TwoOfOneName`], with the first such name.
    pub fn check_names(&self) -> Result<(), CompileError> {
        let mut taken: HashSet<String> = emit::locals(self).map(str::to_owned).collect();
        let statements = |statements: &'_ [Statement]| statements.iter().map(|statement| statement.name).collect();
        let names: [Vec<Name>; 5] = [
            self.arguments.clone(),
            self.constants.iter().map(|constant| constant.name).collect(),
            statements(&self.angles),
            self.turns.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten().collect(),
            statements(&self.statements),
        ];
        match names.iter().flatten().map(Name::to_string).find(|text| !taken.insert(text.clone())) {
            Some(name) => Err(CompileError::TwoOfOneName { function: self.function, name }),
            None => Ok(()),
        }
    }

    /// The same program with other statements.
    pub(crate) fn computed_by(&self, statements: Vec<Statement>, outputs: Vec<Output>) -> Self {
        Self {
            robot: self.robot.clone(),
            arguments: self.arguments.clone(),
            constants: self.constants.clone(),
            angles: self.angles.clone(),
            turns: self.turns.clone(),
            statements,
            outputs,
            findings: self.findings.clone(),
            ledger: self.ledger.clone(),
            choices: self.choices.clone(),
            ..*self
        }
    }

    /// (products, sums) of the seven steps before folding, step 3 included.
    #[must_use]
    pub fn before(&self) -> (usize, usize) {
        self.proof.map_or_else(|| self.ledger.before(), |proof| proof.before)
    }

    /// Whether a value is chosen by a sign somewhere.
    #[must_use]
    pub fn chooses_by_sign(&self) -> bool {
        let statements = self.statements.iter().map(|statement| &statement.value);
        statements.chain(self.outputs.iter().map(|output| &output.value)).any(Expression::chooses_by_sign)
    }

    /// Whether it is written by composite or articulated bodies, which its first choice says.
    pub(crate) fn is_of_bodies(&self) -> bool {
        self.choices.first().is_some_and(|way| way.contains(" bodies, "))
    }

    /// Whether the processor is longer busy reading the instructions than waiting for the longest chain of them: then
    /// the fewest instructions are the fastest.
    #[must_use]
    pub fn is_long(&self) -> bool {
        /// Their code does not fit into the nearest cache of the processors of these years, 32 KB.
        const LONG: usize = 4000;
        self.operations().total() > LONG
    }

    /// The operations of one evaluation.
    #[must_use]
    pub fn operations(&self) -> Operations {
        // all sines and cosines are one statement
        let statements = self.angles.len() + usize::from(!self.turns.is_empty()) + self.statements.len();
        let mut count = Operations { statements, sincos: self.turns.len(), ..Operations::default() };
        for statement in self.angles.iter().chain(&self.statements) {
            statement.value.count(&mut count);
        }
        for turn in &self.turns {
            turn.angle.count(&mut count);
        }
        for output in &self.outputs {
            output.value.count(&mut count);
        }
        count
    }
}

impl Expression {
    /// Adds the names that it uses.
    pub fn names(&self, found: &mut BTreeSet<Name>) {
        match self {
            Self::Variable(name) => {
                found.insert(*name);
            }
            Self::Zero => {}
            Self::Negative(a) => a.names(found),
            Self::Sum(a, b) | Self::Difference(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => {
                a.names(found);
                b.names(found);
            }
            Self::BySign(x, positive, negative) => [x, positive, negative].into_iter().for_each(|a| a.names(found)),
        }
    }

    fn chooses_by_sign(&self) -> bool {
        match self {
            Self::Variable(_) | Self::Zero => false,
            Self::BySign(..) => true,
            Self::Negative(a) => a.chooses_by_sign(),
            Self::Sum(a, b) | Self::Difference(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => {
                a.chooses_by_sign() || b.chooses_by_sign()
            }
        }
    }

    /// Whether the constant 0 stands in it.
    pub(crate) fn has_zero(&self) -> bool {
        match self {
            Self::Variable(_) => false,
            Self::Zero => true,
            Self::Negative(a) => a.has_zero(),
            Self::Sum(a, b) | Self::Difference(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => {
                a.has_zero() || b.has_zero()
            }
            Self::BySign(x, positive, negative) => x.has_zero() || positive.has_zero() || negative.has_zero(),
        }
    }

    fn count(&self, count: &mut Operations) {
        match self {
            Self::Variable(_) | Self::Zero => {}
            Self::Negative(a) => a.count(count),
            Self::Sum(a, b) | Self::Difference(a, b) => {
                count.add += 1;
                a.count(count);
                b.count(count);
            }
            Self::Product(a, b) => {
                count.mul += 1;
                a.count(count);
                b.count(count);
            }
            Self::Quotient(a, b) => {
                count.div += 1;
                a.count(count);
                b.count(count);
            }
            Self::BySign(x, positive, negative) => [x, positive, negative].into_iter().for_each(|a| a.count(count)),
        }
    }
}

#[cfg(test)]
mod tests {
    use rne_model::Robot;

    use super::*;
    use crate::ir::quantity::Quantity;
    use crate::{Compiler, Interpreter};

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
        for name in [program.constants[0].name, program.arguments[0], program.turns[0].sine.unwrap()] {
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

    #[test]
    fn the_interpreter_takes_the_last_of_two_as_a_language_does() {
        let mut program = rod();
        let value = program.outputs[0].value.clone();
        let (first, second) =
            (Name::indexed(Quantity::LowerFactor, 1, 2), Name { part: 2, ..Name::scalar(Quantity::LowerFactor, 1) });
        let place = program.statements[0].place;
        program.statements.push(Statement { place, name: first, value });
        program.statements.push(Statement { place, name: second, value: Expression::Zero });
        program.outputs[0].value = Expression::Variable(first);
        let arguments = crate::Arguments::of_joints(&[0.3], &[0.2], &[0.1], 0.0);
        assert_eq!(Interpreter::new(&program).run(&arguments, |x| x, f64::sin_cos), Some(vec![0.0]));
    }

    #[test]
    fn variables_of_the_emitters_are_taken() {
        let locals: Vec<_> = emit::locals(&rod()).collect();
        for local in ["q", "qd", "qdd", "zero", "unused", "tau"] {
            assert!(locals.contains(&local), "{locals:?}");
        }
    }
}
