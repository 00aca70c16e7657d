//! An interpreter of programs over any number type, so that thousands of robots can be tried without compiling each.

use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::ir::name::Name;
use crate::ir::quantity::{Component, Quantity};
use crate::program::{Expression, Operator, Program, Statement};

/// The arguments of a function. What a function does not use may be empty or zero.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'a, T> {
    /// Joint positions, rad or m.
    pub q: &'a [T],
    /// Joint rates.
    pub qd: &'a [T],
    /// Joint accelerations.
    pub qdd: &'a [T],
    /// Force that the last link exerts at the tip, in tip axes, N.
    pub force: [T; 3],
    /// Moment that the last link exerts at the tip, N m.
    pub moment: [T; 3],
    /// What is fixed to the tip: mass, kg; centre of mass x, y, z from the origin of the tip frame, m; inertia about it
    /// xx, yy, zz, xy, xz, yz, kg m², all in tip axes.
    pub payload: [T; 10],
    /// Joint torques.
    pub tau: &'a [T],
    /// ω₀, ω̇₀, c̈₀ of the base and gravity, in frame 0.
    pub base: [[T; 3]; 4],
    /// Parameters that are known at run time only.
    pub parameters: &'a [T],
}

impl<'a, T: Copy> Arguments<'a, T> {
    /// Motion of the joints; everything else is `zero` or absent.
    #[must_use]
    pub const fn of_joints(q: &'a [T], qd: &'a [T], qdd: &'a [T], zero: T) -> Self {
        let zeros = [zero; 3];
        Self {
            q,
            qd,
            qdd,
            force: zeros,
            moment: zeros,
            payload: [zero; 10],
            tau: &[],
            base: [zeros; 4],
            parameters: &[],
        }
    }
}

/// A program made ready to run: names are resolved to slots, by their text as in the code that is emitted.
#[derive(Clone, Debug)]
pub struct Interpreter {
    code: Vec<Instruction>,
    outputs: Vec<usize>,
}

/// Writes the next slot (sine and cosine: the next two).
#[derive(Clone, Copy, Debug)]
enum Instruction {
    Argument(Name),
    Constant(Option<Name>, f64),
    SineCosine(usize),
    Negative(usize),
    Binary(Operator, usize, usize),
    BySign([usize; 3]),
}

/// What a number of the interpreter can do.
pub trait Real:
    Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// `positive` where it is above 0, `negative` where it is below, else 0.
    #[must_use]
    fn by_sign(self, positive: Self, negative: Self) -> Self;
}

macro_rules! real {
    ($($float:ty),*) => {$(
        impl Real for $float {
            fn by_sign(self, positive: Self, negative: Self) -> Self {
                if self > 0.0 {
                    positive
                } else if self < 0.0 {
                    negative
                } else {
                    0.0
                }
            }
        }
    )*};
}
real!(f32, f64);

impl Interpreter {
    /// Resolves the names of a program.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        let mut builder = Builder::default();
        for &name in &program.arguments {
            builder.define(name, Instruction::Argument(name));
        }
        for constant in &program.constants {
            builder.define(constant.name, Instruction::Constant(Some(constant.name), constant.value));
        }
        for statement in &program.angles {
            builder.statement(statement);
        }
        for turn in &program.sines_and_cosines {
            let angle = builder.expression(&turn.angle);
            let slot = builder.push(Instruction::SineCosine(angle));
            builder.slots += 1;
            builder.known.extend(turn.sine.map(|name| (name.to_string(), slot)));
            builder.known.extend(turn.cosine.map(|name| (name.to_string(), slot + 1)));
        }
        for statement in &program.statements {
            builder.statement(statement);
        }
        let outputs = program.outputs.iter().map(|output| builder.expression(&output.value)).collect();
        Self { code: builder.code, outputs }
    }

    /// Runs the program. `constant` turns a number of the program into a `T`, `sin_cos` gives (sine, cosine).
    ///
    /// Returns the outputs in the program's order; `None` when an argument array is too short.
    pub fn run<T>(
        &self,
        arguments: &Arguments<'_, T>,
        constant: impl Fn(f64) -> T,
        sin_cos: impl Fn(T) -> (T, T),
    ) -> Option<Vec<T>>
    where
        T: Real,
    {
        self.run_named(arguments, |_, value| Some(constant(value)), sin_cos)
    }

    /// As [`Interpreter::run`], with constants by their names: the name of a constant that is just 0 is `None`.
    pub(crate) fn run_named<T>(
        &self,
        arguments: &Arguments<'_, T>,
        constant: impl Fn(Option<Name>, f64) -> Option<T>,
        sin_cos: impl Fn(T) -> (T, T),
    ) -> Option<Vec<T>>
    where
        T: Real,
    {
        let mut slots: Vec<T> = Vec::with_capacity(self.code.len() + 64);
        for &instruction in &self.code {
            let value = match instruction {
                Instruction::Argument(name) => match name.quantity {
                    // sines and cosines that are arguments are those of the positions
                    Quantity::Sine => sin_cos(arguments.position(name.joint)?).0,
                    Quantity::Cosine => sin_cos(arguments.position(name.joint)?).1,
                    _ => arguments.get(name)?,
                },
                Instruction::Constant(name, value) => constant(name, value)?,
                Instruction::SineCosine(angle) => {
                    let (sine, cosine) = sin_cos(slots[angle]);
                    slots.push(sine);
                    cosine
                }
                Instruction::Negative(a) => -slots[a],
                Instruction::Binary(Operator::Sum, a, b) => slots[a] + slots[b],
                Instruction::Binary(Operator::Difference, a, b) => slots[a] - slots[b],
                Instruction::Binary(Operator::Product, a, b) => slots[a] * slots[b],
                Instruction::Binary(Operator::Quotient, a, b) => slots[a] / slots[b],
                Instruction::BySign([x, a, b]) => slots[x].by_sign(slots[a], slots[b]),
            };
            slots.push(value);
        }
        Some(self.outputs.iter().map(|&slot| slots[slot]).collect())
    }
}

impl<T: Copy> Arguments<'_, T> {
    fn position(&self, joint: usize) -> Option<T> {
        self.q.get(joint.checked_sub(1)?).copied()
    }

    fn get(&self, name: Name) -> Option<T> {
        if let Quantity::Mass | Quantity::Com | Quantity::Inertia = name.quantity {
            let index = Name::of_payload(name.joint).iter().position(|of| *of == name)?;
            return Some(self.payload[index]);
        }
        let Component::Vector(axis) = name.component else {
            let array = match name.quantity {
                Quantity::Position => self.q,
                Quantity::Rate => self.qd,
                Quantity::AppliedTorque => self.tau,
                Quantity::Parameter => self.parameters,
                _ => self.qdd,
            };
            return array.get(name.joint.checked_sub(1)?).copied();
        };
        let vector = match name.quantity {
            Quantity::JointForce => self.force,
            Quantity::JointMoment => self.moment,
            Quantity::Omega => self.base[0],
            Quantity::OmegaDot => self.base[1],
            Quantity::Acceleration => self.base[2],
            _ => self.base[3],
        };
        Some(vector[axis as usize])
    }
}

#[derive(Default)]
struct Builder {
    code: Vec<Instruction>,
    slots: usize,
    known: HashMap<String, usize>,
}

impl Builder {
    fn push(&mut self, instruction: Instruction) -> usize {
        self.code.push(instruction);
        self.slots += 1;
        self.slots - 1
    }

    fn define(&mut self, name: Name, instruction: Instruction) {
        let slot = self.push(instruction);
        self.known.insert(name.to_string(), slot);
    }

    fn statement(&mut self, Statement { name, value, .. }: &Statement) {
        let slot = self.expression(value);
        self.known.insert(name.to_string(), slot);
    }

    fn expression(&mut self, expression: &Expression) -> usize {
        let instruction = match expression {
            // every name is defined before it is used: programs are in order of evaluation
            Expression::Variable(name) => return self.known[&name.to_string()],
            Expression::Zero => Instruction::Constant(None, 0.0),
            Expression::Negative(a) => Instruction::Negative(self.expression(a)),
            Expression::Binary(operator, a, b) => {
                Instruction::Binary(*operator, self.expression(a), self.expression(b))
            }
            Expression::BySign(operands) => {
                Instruction::BySign(operands.each_ref().map(|operand| self.expression(operand)))
            }
        };
        self.push(instruction)
    }
}
