//! The parameters that may have changed: friction, offset and gain of each joint, a payload at the tip, and the delay.

use nalgebra::DMatrix;
use rne_identify::{FittedModel, FrictionParameter, LEAST_FRICTION, LIGHT_ARM, SLOWEST, Structure};

use crate::selection::Statistic;

/// A parameter of the arm that may differ between two logs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Candidate {
    /// Coulomb friction of a joint, N m or N; joints count from 0.
    Coulomb(usize),
    /// Viscous friction of a joint, N m s/rad or N s/m.
    Viscous(usize),
    /// The constant part of a joint's torque, N m or N.
    Offset(usize),
    /// The additional mass on the link with the tip, kg.
    Payload,
    /// The time by which the efforts lag behind the positions, s.
    Delay,
    /// The gain of a joint's effort: 1 if the log has the torque of the baseline, 0 if it has none of it.
    Gain(usize),
}

impl Candidate {
    /// Returns every candidate of an arm.
    #[must_use]
    pub fn all(dof: usize) -> Vec<Self> {
        let parameters = [Self::Coulomb, Self::Viscous, Self::Offset].into_iter();
        parameters
            .flat_map(|parameter| (0..dof).map(parameter))
            .chain([Self::Payload, Self::Delay])
            .chain((0..dof).map(Self::Gain))
            .collect()
    }

    /// Returns the joint, counted from 0; `None` for a payload and the delay.
    #[must_use]
    pub fn joint(self) -> Option<usize> {
        match self {
            Self::Coulomb(joint) | Self::Viscous(joint) | Self::Offset(joint) | Self::Gain(joint) => Some(joint),
            Self::Payload | Self::Delay => None,
        }
    }

    /// The name of the parameter.
    #[must_use]
    pub fn parameter(self) -> &'static str {
        match self {
            Self::Coulomb(_) => "coulomb",
            Self::Viscous(_) => "viscous",
            Self::Offset(_) => "offset",
            Self::Payload => "mass",
            Self::Delay => "delay",
            Self::Gain(_) => "gain",
        }
    }

    /// Returns one column for each number of this candidate: the changes of all unknowns, and of the gain of each
    /// joint, if that number changes by 1. A payload has four numbers, its mass, kg, and its three first moments, kg m;
    /// the others have one.
    pub(crate) fn columns(self, structure: &Structure) -> DMatrix<f64> {
        let count = structure.count() + structure.dof();
        let unit = |at: Option<usize>| {
            let mut column = DMatrix::zeros(count, 1);
            if let Some(at) = at {
                column[(at, 0)] = 1.0;
            }
            column
        };
        let place = |joint, parameter| unit(FittedModel::place(structure, joint, parameter));
        match self {
            Self::Coulomb(joint) => place(joint, FrictionParameter::Coulomb),
            Self::Viscous(joint) => place(joint, FrictionParameter::Viscous),
            Self::Offset(joint) => place(joint, FrictionParameter::Offset),
            // the delay is the last of the unknowns
            Self::Delay => unit(structure.options().delay.then(|| structure.count() - 1)),
            Self::Gain(joint) => unit(Some(structure.count() + joint)),
            Self::Payload => {
                let mut columns = DMatrix::zeros(count, MOMENTS);
                let rank = structure.parameters().rank();
                columns.view_mut((0, 0), (rank, MOMENTS)).copy_from(&structure.payload_columns(MOMENTS));
                columns
            }
        }
    }
}

/// Count of a payload's numbers that a log determines: its mass and its first moments. The part of its inertia in the
/// torques is too small.
pub(crate) const MOMENTS: usize = 4;

/// Magnitudes of an arm from which the sizes of relevant changes follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Coulomb friction of each joint, N m or N: that of the baseline, at least 2 % of the joint's effort.
    pub friction: Vec<f64>,
    /// Root mean square of each joint's speed, rad/s or m/s.
    pub speed: Vec<f64>,
    /// Root mean square of each joint's effort, N m or N.
    pub effort: Vec<f64>,
    /// Mass of all links, kg; 0 if the file has no masses.
    pub mass: f64,
}

impl Scale {
    /// Makes the scale from the fitted model of a baseline, and the normal equations of each joint.
    pub(crate) fn of(structure: &Structure, model: &FittedModel, totals: &[DMatrix<f64>]) -> Self {
        let joints = 0..structure.dof();
        let effort: Vec<f64> =
            joints.clone().map(|joint| mean_square(structure, joint, &totals[joint], None).sqrt()).collect();
        let friction = |joint: usize| {
            let coulomb = FittedModel::place(structure, joint, FrictionParameter::Coulomb);
            let coulomb = coulomb.map_or(0.0, |at| model.solution[at].abs());
            coulomb.max(LEAST_FRICTION * effort[joint])
        };
        Self {
            friction: joints.map(friction).collect(),
            speed: speeds(structure, totals),
            mass: structure.robot().joints.iter().map(|joint| joint.row.link.mass).sum(),
            effort,
        }
    }

    /// Returns the smallest change that can be an event.
    #[must_use]
    pub fn least(&self, candidate: Candidate) -> f64 {
        self.least_and_error(candidate)[0]
    }

    /// Returns the standard deviation of a parameter between logs of an arm that has not changed. It is an error of the
    /// model, which does not decrease with the length of a log.
    #[must_use]
    pub fn model_error(&self, candidate: Candidate) -> f64 {
        self.least_and_error(candidate)[1]
    }

    fn least_and_error(&self, candidate: Candidate) -> [f64; 2] {
        match candidate {
            Candidate::Coulomb(joint) => [0.10, 0.04].map(|part| part * self.friction[joint]),
            Candidate::Viscous(joint) => {
                [0.25, 0.06].map(|part| part * self.friction[joint] / self.speed[joint].max(SLOWEST))
            }
            Candidate::Offset(joint) => {
                [self.friction[joint].max(0.05 * self.effort[joint]), 0.10 * self.friction[joint]]
            }
            Candidate::Payload => [0.1, 0.05].map(|mass| self.payload(mass)),
            Candidate::Delay => [0.004, 0.002],
            Candidate::Gain(_) => [0.15, 0.05],
        }
    }

    /// Whether the candidate of a statistic is determined well enough to detect its smallest event.
    #[must_use]
    pub fn is_watched(&self, statistic: &Statistic) -> bool {
        statistic.deviation < 2.0 * self.least(statistic.candidate)
    }

    /// Returns a mass, kg, which is reduced for an arm lighter than [`LIGHT_ARM`] in proportion to the mass of the arm.
    fn payload(&self, mass: f64) -> f64 {
        if self.mass > 0.0 { mass.min(mass * self.mass / LIGHT_ARM) } else { mass }
    }
}

/// Returns the root mean square of each joint's speed, rad/s or m/s, from the normal equations of each joint.
pub(crate) fn speeds(structure: &Structure, totals: &[DMatrix<f64>]) -> Vec<f64> {
    let speed = |(joint, total): (usize, &DMatrix<f64>)| {
        let at = FittedModel::place(structure, joint, FrictionParameter::Viscous);
        mean_square(structure, joint, total, at).sqrt()
    };
    totals.iter().enumerate().map(speed).collect()
}

/// Returns the mean square of a column of a joint's rows, or of its efforts if no column is given.
fn mean_square(structure: &Structure, joint: usize, total: &DMatrix<f64>, column: Option<usize>) -> f64 {
    let ones = FittedModel::place(structure, joint, FrictionParameter::Offset).map_or(0.0, |one| total[(one, one)]);
    let at = column.unwrap_or(structure.count());
    if ones > 0.0 { total[(at, at)] / ones } else { 0.0 }
}
