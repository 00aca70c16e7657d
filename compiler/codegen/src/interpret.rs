//! An interpreter of programs over any number type, so that thousands of robots can be tried without compiling each.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::ir::{Component, Name, Operator, Quantity, all_names_of};
use crate::program::Program;
use crate::values::{Contraction, Negated, Value, ValueId, Values};

/// The arguments of a function. Arguments that a function does not use may be empty or zero.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'a, T> {
    /// Joint positions, rad or m.
    pub q: &'a [T],
    /// Positions of the dependent joints of closed loops.
    pub passive: &'a [T],
    /// Joint rates.
    pub qd: &'a [T],
    /// Joint accelerations.
    pub qdd: &'a [T],
    /// Force that the last link exerts at the tip, in tip axes, N.
    pub force: [T; 3],
    /// Moment that the last link exerts at the tip, N m.
    pub moment: [T; 3],
    /// The payload at the tip: mass, kg; centre of mass x, y, z from the origin of the tip frame, m; inertia about it
    /// xx, yy, zz, xy, xz, yz, kg m², all in tip axes.
    pub payload: [T; 10],
    /// Joint torques.
    pub tau: &'a [T],
    /// Force and moment that the robot exerts at each tip, in tip axes: fx, fy, fz, nx, ny, nz.
    pub wrenches: &'a [[T; 6]],
    /// ω₀, ω̇₀, c̈₀ of the base and gravity, in frame 0.
    pub base: [[T; 3]; 4],
    /// Velocity of the origin of frame 0, in axes of frame 0; the angular velocity is in `base`.
    pub velocity: [T; 3],
    /// Pose of frame 0 in the world: rotation by rows, origin.
    pub pose: [T; 12],
    /// The rotation of the base, by rows: its columns are the axes of frame 0 in the world.
    pub base_rotation: [T; 9],
    /// The duration of a step, s.
    pub step: T,
    /// Parameters that are known at run time only.
    pub parameters: &'a [T],
}

impl<'a, T: Copy> Arguments<'a, T> {
    /// Arguments with the motion of the joints only. All other arguments are `zero` or absent.
    #[must_use]
    pub const fn of_joints(q: &'a [T], qd: &'a [T], qdd: &'a [T], zero: T) -> Self {
        let zeros = [zero; 3];
        Self {
            q,
            passive: &[],
            qd,
            qdd,
            force: zeros,
            moment: zeros,
            payload: [zero; 10],
            tau: &[],
            wrenches: &[],
            base: [zeros; 4],
            velocity: zeros,
            pose: [zero; 12],
            base_rotation: [zero; 9],
            step: zero,
            parameters: &[],
        }
    }
}

/// The values of a program and which of them it returns, ready to run.
#[derive(Clone, Debug)]
pub struct Interpreter {
    values: Values,
    /// The joints, counted from 1, that the elements of joint arguments belong to.
    coordinates: Vec<usize>,
    /// The dependent joints, counted from 1.
    passive: Vec<usize>,
    outputs: Vec<ValueId>,
}

/// A number type with which the interpreter can compute.
pub trait Real:
    Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Returns `positive` if the number is above 0, `negative` if it is below, else 0.
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
    /// Makes the interpreter of a program.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        Self {
            values: program.values.clone(),
            coordinates: program.coordinates.clone(),
            passive: program.passive.clone(),
            outputs: program.outputs.iter().map(|output| output.value).collect(),
        }
    }

    /// Runs the program. `constant` turns a number of the program into a `T`, `sin_cos` gives (sine, cosine).
    ///
    /// Returns the outputs in the program's order; `None` when an argument array is too short.
    pub fn run<T: Real>(
        &self,
        arguments: &Arguments<'_, T>,
        constant: impl Fn(f64) -> T,
        sin_cos: impl Fn(T) -> (T, T),
    ) -> Option<Vec<T>> {
        let input = |name| arguments.input(name, [&self.coordinates, &self.passive], &sin_cos);
        self.run_named(input, |_, value| Some(constant(value)), &sin_cos)
    }

    /// Runs the program as [`Interpreter::run`] does, but asks for arguments and constants by their names; a constant
    /// that is only 0 has no name.
    pub(crate) fn run_named<T: Real>(
        &self,
        input: impl Fn(Name) -> Option<T>,
        constant: impl Fn(Option<Name>, f64) -> Option<T>,
        sin_cos: impl Fn(T) -> (T, T),
    ) -> Option<Vec<T>> {
        let mut slots: Vec<T> = Vec::with_capacity(self.values.len());
        // the cosine of an angle comes after its sine
        let mut turn: Option<(ValueId, (T, T))> = None;
        for (id, value) in self.values.iter() {
            let number = |id: ValueId| slots[id.index()];
            let mut turned = |angle: ValueId| match turn {
                Some((of, pair)) if of == angle => pair,
                _ => turn.insert((angle, sin_cos(number(angle)))).1,
            };
            let number = match value {
                Value::Argument => input(self.values.name(id)?)?,
                Value::Constant(number) => constant(self.values.name(id), number)?,
                Value::Sine(angle) => turned(angle).0,
                Value::Cosine(angle) => turned(angle).1,
                Value::Same(a) => number(a),
                Value::Negative(a) => -number(a),
                Value::Binary(Operator::Sum, a, b) => number(a) + number(b),
                Value::Binary(Operator::Difference, a, b) => number(a) - number(b),
                Value::Binary(Operator::Product, a, b) => number(a) * number(b),
                Value::Binary(Operator::Quotient, a, b) => number(a) / number(b),
                Value::Fused(Contraction { factors: [x, y], addend, negated }) => match negated {
                    None => number(addend) + number(x) * number(y),
                    Some(Negated::Factor) => number(addend) - number(x) * number(y),
                    Some(Negated::Addend) => number(x) * number(y) - number(addend),
                },
                Value::BySign([x, a, b]) => number(x).by_sign(number(a), number(b)),
            };
            slots.push(number);
        }
        Some(self.outputs.iter().map(|output| slots[output.index()]).collect())
    }
}

impl<T: Copy> Arguments<'_, T> {
    /// Returns the argument with this name. A sine or cosine as an argument is that of a joint position.
    fn input(&self, name: Name, joints: [&[usize]; 2], sin_cos: impl Fn(T) -> (T, T)) -> Option<T> {
        let [coordinates, passive] = joints;
        let place = || coordinates.binary_search(&name.joint).ok();
        match name.quantity {
            Quantity::Sine => Some(sin_cos(*self.q.get(place()?)?).0),
            Quantity::Cosine => Some(sin_cos(*self.q.get(place()?)?).1),
            Quantity::Position if passive.contains(&name.joint) => {
                self.passive.get(passive.binary_search(&name.joint).ok()?).copied()
            }
            _ => self.get(name, place),
        }
    }

    fn get(&self, name: Name, place: impl Fn() -> Option<usize>) -> Option<T> {
        let place_in = |names: &[Name]| names.iter().position(|known| *known == name);
        match name.quantity {
            Quantity::Mass | Quantity::Com | Quantity::Inertia => {
                return Some(self.payload[place_in(&all_names_of::<10>("payload", name.joint))?]);
            }
            Quantity::TipForce | Quantity::TipMoment => {
                let wrench = self.wrenches.get(name.joint.checked_sub(1)?)?;
                return Some(wrench[place_in(&all_names_of::<6>("wrenches", name.joint))?]);
            }
            Quantity::FrameRotation | Quantity::FrameOrigin => {
                return Some(self.pose[place_in(&all_names_of::<12>("pose", 0))?]);
            }
            Quantity::BaseRotation => {
                return Some(self.base_rotation[place_in(&all_names_of::<9>("base_rotation", 0))?]);
            }
            _ => {}
        }
        let Component::Vector(axis) = name.component else {
            let array = match name.quantity {
                Quantity::Position => self.q,
                Quantity::Rate => self.qd,
                // no function has both, so `tau` is used for either
                Quantity::AppliedTorque | Quantity::Multiplier => self.tau,
                Quantity::Duration => return Some(self.step),
                Quantity::Parameter => return self.parameters.get(name.joint.checked_sub(1)?).copied(),
                _ => self.qdd,
            };
            return array.get(place()?).copied();
        };
        let vector = match name.quantity {
            Quantity::JointForce => self.force,
            Quantity::JointMoment => self.moment,
            Quantity::Omega => self.base[0],
            Quantity::OmegaDot => self.base[1],
            Quantity::Acceleration => self.base[2],
            Quantity::OriginVelocity => self.velocity,
            _ => self.base[3],
        };
        Some(vector[axis as usize])
    }
}
