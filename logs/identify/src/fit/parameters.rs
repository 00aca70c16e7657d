//! The base parameters, as linear combinations of the parameters of links and rotors.

use std::fmt::Write as _;

use crate::fit::identifiability::{Identifiability, Parameter, Visibility};
use nalgebra::{DMatrix, DVector};
use rne_model::{PER_LINK, Robot};
use rne_runtime::{DynArm, LinkParameter};

use crate::fit::regressor::bare;
use crate::motions::random::Random;

/// Number of random states from which the factors that are no small whole numbers are computed.
const STATES: usize = 60;

/// A base parameter: a linear combination of parameters of links and rotors that the torques depend on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Base {
    /// The parameter that represents the combination, with factor 1.
    pub kept: Parameter,
    /// The other parameters of the combination, with their factors.
    pub regrouped: Vec<(f64, Parameter)>,
}

impl Base {
    /// Returns the name of the parameter that represents the combination, with joints counted from 1: `Jzz2`, `Jm3`.
    #[must_use]
    pub fn name(&self) -> String {
        name(self.kept)
    }

    /// Returns the combination as text, such as `Jzz2 + 0.3745 m3 - mcx4`.
    #[must_use]
    pub fn combination(&self) -> String {
        let mut text = self.name();
        for (factor, parameter) in &self.regrouped {
            let sign = if *factor < 0.0 { '-' } else { '+' };
            let size = factor.abs();
            let size = if size == 1.0 { String::new() } else { format!("{} ", (size * 1e4).round() / 1e4) };
            let _ = write!(text, " {sign} {size}{}", name(*parameter));
        }
        text
    }
}

/// The base parameters of a robot's geometry, and the map to them from the parameters of its links and rotors.
#[derive(Clone, Debug)]
pub struct Parameters {
    /// Base parameters, one for each independent column of the regressor, base to tip, then rotors.
    pub bases: Vec<Base>,
    /// Rank × (10 · links + rotors, of the coordinates): base parameters of link parameters, link by link as (m, m cx,
    /// m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz), then the rotors'.
    pub regrouping: DMatrix<f64>,
    pub(crate) rotors: bool,
}

impl Parameters {
    /// Finds the base parameters of a robot's geometry; the masses of its links have no influence. `rotors` includes
    /// rotors.
    #[must_use]
    pub fn of(robot: &Robot, rotors: bool) -> Self {
        let Identifiability { parameters, .. } = Identifiability::of(robot, rotors);
        let (links, coordinates) = (robot.joints.len(), robot.coordinates().collect::<Vec<_>>());
        let kept: Vec<Parameter> = parameters
            .iter()
            .filter(|(_, visibility)| *visibility == Visibility::Kept)
            .map(|(parameter, _)| *parameter)
            .collect();
        let place = |parameter: Parameter| match parameter {
            Parameter::Link(link, index) => link * PER_LINK + index,
            Parameter::Rotor(joint) => {
                links * PER_LINK + coordinates.iter().take_while(|&&other| other < joint).count()
            }
        };
        let all = links * PER_LINK + if rotors { coordinates.len() } else { 0 };
        let stacked = stacked(robot, all);
        let mut bases: Vec<Base> = kept.iter().map(|&kept| Base { kept, regrouped: Vec::new() }).collect();
        let mut regrouping = DMatrix::zeros(kept.len(), all);
        for (row, &parameter) in kept.iter().enumerate() {
            regrouping[(row, place(parameter))] = 1.0;
        }
        for (parameter, visibility) in &parameters {
            let Visibility::Regrouped(parts) = visibility else { continue };
            // which factors are not zero is known exactly; the values of those that are no whole numbers are computed
            // here
            let unknown: Vec<usize> = parts.iter().filter(|part| part.1.is_none()).map(|part| part.0).collect();
            let mut rest: DVector<f64> = stacked.column(place(*parameter)).clone_owned();
            for (at, whole) in parts {
                if let Some(whole) = whole {
                    rest.axpy(-f64::from(*whole), &stacked.column(place(kept[*at])), 1.0);
                }
            }
            let columns: Vec<usize> = unknown.iter().map(|&at| place(kept[at])).collect();
            // a matrix without columns has no factorisation
            let found = if columns.is_empty() {
                DVector::zeros(0)
            } else {
                stacked.select_columns(&columns).svd(true, true).solve(&rest, 0.0).unwrap_or_default()
            };
            for (at, whole) in parts {
                let position = unknown.iter().position(|other| other == at);
                let factor = whole.map(f64::from).or_else(|| Some(found[position?])).unwrap_or_default();
                regrouping[(*at, place(*parameter))] = factor;
                bases[*at].regrouped.push((factor, *parameter));
            }
        }
        Self { bases, regrouping, rotors }
    }

    /// Number of base parameters.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.bases.len()
    }

    /// Returns the parameters of a robot's links and rotors, in the order of the columns of
    /// [`regrouping`](Self::regrouping).
    #[must_use]
    pub fn of_robot(&self, robot: &Robot) -> DVector<f64> {
        let arm = DynArm::from_robot(robot);
        let mut values: Vec<f64> = arm.inertial_parameters().into_iter().flatten().collect();
        if self.rotors {
            values.extend(
                robot
                    .independent_joints()
                    .map(|joint| joint.motor.map_or(0.0, |motor| motor.gear_ratio * motor.gear_ratio * motor.inertia)),
            );
        }
        DVector::from_vec(values)
    }

    /// Whether the torque of a coordinate may depend on a base parameter.
    pub(crate) fn is_felt(robot: &Robot, base: &Base, coordinate: usize) -> bool {
        match base.kept {
            Parameter::Link(link, _) => moves(robot, coordinate, link),
            Parameter::Rotor(of) => robot.coordinates().nth(coordinate) == Some(of),
        }
    }
}

/// Whether a coordinate moves a link, by its own joint or by a joint that depends on it; both indices count from 0.
pub(crate) fn moves(robot: &Robot, coordinate: usize, link: usize) -> bool {
    let joint = robot.coordinates().nth(coordinate);
    let is_moved = |other: usize| match &robot.joints[other].coupling {
        None => Some(other) == joint,
        Some(coupling) => coupling.follows.iter().any(|(followed, _)| Some(*followed) == joint),
    };
    std::iter::successors(Some(link), |&link| robot.parent(link)).any(is_moved)
}

/// Returns the regressors at random states, with columns of rotors, stacked on each other.
fn stacked(robot: &Robot, columns: usize) -> DMatrix<f64> {
    let (dof, links) = (robot.dof(), robot.joints.len());
    let arm = DynArm::from_robot(&bare(robot));
    let mut random = Random::new(1);
    let mut stacked = DMatrix::zeros(STATES * dof, columns);
    for state in 0..STATES {
        let mut numbers = |most: f64| -> Vec<f64> { (0..dof).map(|_| most * random.number()).collect() };
        let (q, qd, qdd) = (numbers(std::f64::consts::PI), numbers(1.0), numbers(1.0));
        // no error: there is one number per joint
        let Ok(matrix) = arm.regressor(&q, &qd, &qdd) else { continue };
        for (joint, torque) in matrix.iter().enumerate() {
            for (at, element) in torque.iter().flatten().enumerate() {
                stacked[(state * dof + joint, at)] = *element;
            }
            if columns > links * PER_LINK {
                stacked[(state * dof + joint, links * PER_LINK + joint)] = qdd[joint];
            }
        }
    }
    stacked
}

fn name(parameter: Parameter) -> String {
    match parameter {
        Parameter::Link(link, index) => LinkParameter { link, index }.to_string(),
        Parameter::Rotor(joint) => format!("Jm{}", joint + 1),
    }
}
