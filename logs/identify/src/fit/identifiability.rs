//! The inertial parameters that the torques can see, computed exactly.
//!
//! The regressor is written as the compiler writes any function, and its graph is evaluated at random points of two
//! prime fields: sines and cosines are random points of the circle there, and nothing is rounded. The rows that a point
//! gives are eliminated, columns from the base to the tip. A column without a pivot is a combination of those before
//! it: no tolerance says so.
//!
//! A rank over the fields is never above the true one, and below it with a probability under 10⁻²⁵ (J. T. Schwartz,
//! J. ACM 27, 1980). Angles of the table that are no right angles stand for any angle: an arm whose parameters a twist
//! of just 60° couples would be found to have more base parameters than it has.

use rne_codegen::{ExactFunction, Function, Name, Quantity, Residue};
use rne_model::{PER_LINK, Robot};

/// The order in which a link's parameters are kept: J, m c, m, so that Jxx stays where Jyy or Jzz goes.
const ORDER: [usize; PER_LINK] = [4, 5, 6, 7, 8, 9, 1, 2, 3, 0];

/// Points that must not add to the rank before it is believed; one would do.
const IDLE: usize = 2;

/// Largest factor of a regrouped parameter that counts as a whole number.
const LARGEST_WHOLE: i32 = 8;

/// A parameter that torques may depend on linearly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Parameter {
    /// A parameter of a link, both counted from 0: the place in (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz),
    /// about the origin of the link frame.
    Link(usize, usize),
    /// The inertia of a rotor, at its joint, counted from 0 among all joints.
    Rotor(usize),
}

/// Effect of a parameter on the torques.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Visibility {
    /// The parameter represents a base parameter.
    Kept,
    /// It is a part of these base parameters, each given by its place among [`Identifiability::kept`]; with its factor
    /// where that is a small whole number.
    Regrouped(Vec<(usize, Option<i32>)>),
    /// No torque depends on it.
    WithoutEffect,
}

/// Effect of each parameter of a robot's links and rotors on the torques.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Identifiability {
    /// Every parameter with what is seen of it: link by link in the order J, m c, m, then the rotors.
    pub parameters: Vec<(Parameter, Visibility)>,
}

impl Identifiability {
    /// The parameters that represent base parameters: as many as the rank of the regressor.
    #[must_use]
    pub fn kept(&self) -> Vec<Parameter> {
        let kept = self.parameters.iter().filter(|(_, visibility)| *visibility == Visibility::Kept);
        kept.map(|(parameter, _)| *parameter).collect()
    }

    /// Finds what the torques can see of the parameters of the links, and of the rotors where `rotors` asks for them,
    /// without rounding and without a tolerance. The numbers of the links do not matter.
    #[must_use]
    pub fn of(robot: &Robot, rotors: bool) -> Self {
        let links = (0..robot.joints.len()).flat_map(|link| ORDER.map(|index| Parameter::Link(link, index)));
        let of_rotors = robot.coordinates().filter(|_| rotors).map(Parameter::Rotor);
        let order: Vec<Parameter> = links.chain(of_rotors).collect();
        let regressor = Regressor::new(robot);
        let mut rows = Rows { reduced: Vec::new(), width: order.len() };
        let (mut idle, mut index) = (0, 1);
        while idle < IDLE {
            let before = rows.reduced.len();
            for row in regressor.rows(index, &order) {
                rows.insert(row);
            }
            idle = if rows.reduced.len() == before { idle + 1 } else { 0 };
            index += 1;
        }
        let parameters = order.iter().enumerate().map(|(at, parameter)| (*parameter, rows.visibility(at)));
        Self { parameters: parameters.collect() }
    }
}

/// The regressor of a robot, ready to be evaluated.
struct Regressor {
    function: ExactFunction,
    /// Number of links.
    links: usize,
    /// The joints that follow no other, counted from 0.
    coordinates: Vec<usize>,
}

impl Regressor {
    fn new(robot: &Robot) -> Self {
        // what a link has does not enter, but rotors would
        let robot = Robot { rotors: false, ..robot.clone() };
        let coordinates = robot.coordinates().collect();
        Self { function: ExactFunction::new(&robot, Function::Regressor), links: robot.joints.len(), coordinates }
    }

    /// A row per coordinate, in the order of the parameters.
    fn rows(&self, point: u64, order: &[Parameter]) -> Vec<Vec<Residue>> {
        let outputs = self.function.at(point);
        let output = |at: usize| outputs[at];
        let acceleration = |joint: usize| self.function.argument(point, Name::scalar(Quantity::RateDot, joint + 1));
        let element = |at: usize, joint: usize, parameter: &Parameter| match *parameter {
            Parameter::Link(link, place) => output((at * self.links + link) * PER_LINK + place),
            Parameter::Rotor(of) if of == joint => acceleration(joint),
            Parameter::Rotor(_) => Residue::ZERO,
        };
        let row = |(at, &joint): (usize, &usize)| order.iter().map(|parameter| element(at, joint, parameter)).collect();
        self.coordinates.iter().enumerate().map(row).collect()
    }
}

/// Rows in reduced echelon form, each with the column of its leading one.
struct Rows {
    reduced: Vec<(usize, Vec<Residue>)>,
    width: usize,
}

impl Rows {
    fn insert(&mut self, mut row: Vec<Residue>) {
        for (pivot, other) in &self.reduced {
            let factor = row[*pivot];
            subtract(&mut row, factor, other);
        }
        let invertible = |at: usize| row[at].inverse().map(|inverse| (at, inverse));
        let Some((pivot, inverse)) = (0..self.width).find_map(invertible) else { return };
        for element in &mut row {
            *element = *element * inverse;
        }
        for (_, other) in &mut self.reduced {
            let factor = other[pivot];
            subtract(other, factor, &row);
        }
        let place = self.reduced.partition_point(|(other, _)| *other < pivot);
        self.reduced.insert(place, (pivot, row));
    }

    fn visibility(&self, column: usize) -> Visibility {
        if self.reduced.iter().any(|(pivot, _)| *pivot == column) {
            return Visibility::Kept;
        }
        let parts: Vec<_> = self
            .reduced
            .iter()
            .enumerate()
            .filter(|(_, (_, row))| !row[column].is_zero())
            .map(|(kept, (_, row))| (kept, whole(row[column])))
            .collect();
        if parts.is_empty() { Visibility::WithoutEffect } else { Visibility::Regrouped(parts) }
    }
}

fn subtract(row: &mut [Residue], factor: Residue, other: &[Residue]) {
    if factor.is_zero() {
        return;
    }
    for (element, other) in row.iter_mut().zip(other) {
        *element = *element - factor * *other;
    }
}

/// The small whole number whose image this is.
fn whole(residue: Residue) -> Option<i32> {
    (1..=LARGEST_WHOLE).find_map(|value| {
        let image = Residue::integer(u64::from(value.unsigned_abs()));
        if residue == image { Some(value) } else { (residue == -image).then_some(-value) }
    })
}
