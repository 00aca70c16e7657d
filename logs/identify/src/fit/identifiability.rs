//! Finds exactly which inertial parameters the torques depend on.
//!
//! The regressor is generated as the compiler generates any function, and its graph is evaluated at random points of
//! two prime fields: sines and cosines are random points of the circle there, and nothing is rounded. The rows at a
//! point are eliminated, columns from the base to the tip. A column without a pivot is a linear combination of the
//! columns before it: no tolerance is needed.
//!
//! A rank over the fields is never above the true one, and below it with a probability under 10⁻²⁵ (J. T. Schwartz, J.
//! ACM 27, 1980). Angles of the table that are no right angles are treated as arbitrary angles: an arm whose parameters
//! a twist of just 60° couples would be found to have more base parameters than it has.

use rne_codegen::{ExactFunction, Function, Name, Quantity, Residue};
use rne_model::{PER_LINK, Robot};

/// Order in which a link's parameters are tried as base parameters: J, m c, m. So Jxx is preferred to Jyy and Jzz.
const ORDER: [usize; PER_LINK] = [4, 5, 6, 7, 8, 9, 1, 2, 3, 0];

/// Number of successive points that must not increase the rank before it is accepted; one would be enough.
const IDLE: usize = 2;

/// Largest factor of a regrouped parameter that is recognized as a whole number.
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
    /// The parameter is a part of these base parameters, each given by its index in [`Identifiability::kept`], with its
    /// factor if that is a small whole number.
    Regrouped(Vec<(usize, Option<i32>)>),
    /// No torque depends on the parameter.
    WithoutEffect,
}

/// Effect of each parameter of a robot's links and rotors on the torques.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Identifiability {
    /// Every parameter with its effect: link by link in the order J, m c, m, then the rotors.
    pub parameters: Vec<(Parameter, Visibility)>,
}

impl Identifiability {
    /// Returns the parameters that represent base parameters. Their number is the rank of the regressor.
    #[must_use]
    pub fn kept(&self) -> Vec<Parameter> {
        let kept = self.parameters.iter().filter(|(_, visibility)| *visibility == Visibility::Kept);
        kept.map(|(parameter, _)| *parameter).collect()
    }

    /// Finds which parameters of the links, and of the rotors if `rotors` is true, the torques depend on, without
    /// rounding and without a tolerance. The values of the links' parameters have no influence.
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
        // the regressor does not depend on the links' parameters, but it would on rotors
        let robot = Robot { rotors: false, ..robot.clone() };
        let coordinates = robot.coordinates().collect();
        Self { function: ExactFunction::new(&robot, Function::Regressor), links: robot.joints.len(), coordinates }
    }

    /// Returns a row for each coordinate at a point, with columns in the given order of the parameters.
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

/// Returns the small whole number that this element of the prime field represents, if there is one.
fn whole(residue: Residue) -> Option<i32> {
    (1..=LARGEST_WHOLE).find_map(|value| {
        let image = Residue::integer(u64::from(value.unsigned_abs()));
        if residue == image { Some(value) } else { (residue == -image).then_some(-value) }
    })
}
