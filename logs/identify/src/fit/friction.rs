//! The part of a joint's friction that logs determine: all of it, Coulomb friction without its offset, or nothing.
//!
//! Coulomb friction forward and backward are the sum and the difference of two unknowns: half their sum, which changes
//! its sign with the speed, and half their difference, an offset, which does not. If a joint moves little, its gravity
//! torque is almost constant and cannot be separated from the offset, so each direction alone is as uncertain as the
//! offset. The half sum is not. So the two unknowns are decided on one by one. An unknown that the logs do not
//! determine is fixed at the value of the file, and everything else is fitted again: gravity then takes what the offset
//! took before.

use crate::fit::feasible::Feasible;
use crate::fit::fitted_model::file_friction;
use crate::fit::identification::UNKNOWN;
use crate::fit::information::Information;
use crate::fit::least_squares::LeastSquares;
use crate::fit::prior::Scales;
use crate::fit::structure::{FRICTION, Structure};

/// Standard deviation of friction that is fixed at the value of the file, as a part of the joint's effort.
const HELD: f64 = 1e-4;

/// An offset is known well enough if its standard deviation is less than this part of the joint's effort, however small
/// Coulomb friction is. A verdict on a model calls errors below this part small, too.
const SMALL: f64 = 0.05;

/// Friction is not fixed if the residual would then grow by more than this factor, and to more than this part of the
/// effort.
const JUMP: [f64; 2] = [2.0, 0.05];

/// The part of a joint's friction that logs determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionExcitation {
    /// Viscous friction, and Coulomb friction of each direction.
    Full,
    /// Viscous friction, and half the sum of Coulomb friction in both directions. The ratio of the two directions is
    /// that of the file; they are equal if the file has none.
    WithoutOffset,
    /// Nothing: the friction is that of the file.
    None,
}

/// The part of a joint's friction that is fixed at the values of the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    pub(crate) excitation: FrictionExcitation,
    /// Friction of the file: viscous friction, half the sum and half the difference of Coulomb friction in both
    /// directions.
    pub(crate) of_file: [f64; FRICTION],
}

impl Hold {
    /// Returns the weight of the rows that fix friction, for a joint with this effort.
    pub(crate) fn weight(effort: f64) -> f64 {
        1.0 / (HELD * effort)
    }

    /// Returns the difference of Coulomb friction in both directions over their sum. The ratio is fixed, not the
    /// difference, because then friction in each direction stays positive, whatever sum is fitted.
    pub(crate) fn asymmetry(&self) -> f64 {
        let [_, coulomb, offset] = self.of_file;
        if coulomb > offset.abs() { offset / coulomb } else { 0.0 }
    }
}

/// The friction that is fixed at the values of the file, and the fit to logs with it.
pub(crate) struct HeldFriction {
    /// One entry for each joint; empty without friction.
    pub(crate) holds: Vec<Hold>,
    /// `None` if no friction is fixed, or nothing could be fitted.
    fit: Option<LeastSquares>,
}

impl HeldFriction {
    /// Decides which friction of each joint is fixed; `free` is the fit without fixed friction.
    pub(crate) fn of(structure: &Structure, information: &Information, free: &LeastSquares, scales: &Scales) -> Self {
        let joints = if structure.options.friction { structure.dof() } else { 0 };
        let hold =
            |joint| Hold { excitation: FrictionExcitation::Full, of_file: file_friction(&structure.robot, joint) };
        let mut holds: Vec<Hold> = (0..joints).map(hold).collect();
        if free.covariance.iter().any(|value| value.is_nan()) {
            // too few rows for standard deviations: all friction is that of the file
            for hold in &mut holds {
                hold.excitation = FrictionExcitation::None;
            }
            return Self { holds, fit: None };
        }
        for (joint, hold) in holds.iter_mut().enumerate() {
            if !is_offset_known(structure, free, scales, joint) {
                hold.excitation = FrictionExcitation::WithoutOffset;
            }
        }
        if holds.iter().all(|hold| hold.excitation == FrictionExcitation::Full)
            && (0..joints).all(|joint| coulomb_uncertainty(structure, free, scales, joint) < UNKNOWN)
        {
            return Self { holds, fit: None };
        }
        let refit = |holds: &[Hold]| free.with_holds(structure, information, scales, holds.to_vec());
        let (without_offset, _) = refit(&holds);
        let unknown: Vec<usize> = (0..joints)
            .filter(|joint| coulomb_uncertainty(structure, &without_offset, scales, *joint) >= UNKNOWN)
            .collect();
        if unknown.is_empty() {
            return Self { holds, fit: Some(without_offset) };
        }
        let mut set = |excitation| {
            for joint in &unknown {
                holds[*joint].excitation = excitation;
            }
            refit(&holds)
        };
        let (_, before) = set(FrictionExcitation::WithoutOffset);
        let (fit, after) = set(FrictionExcitation::None);
        // at a single speed, the logs determine the sum of Coulomb and viscous friction but not each of them
        let [factor, part] = JUMP;
        let jumps =
            |joint: usize| after[joint] > factor * before[joint] && after[joint] > part * scales.friction[joint];
        let mut has_jumped = false;
        for joint in unknown.into_iter().filter(|joint| jumps(*joint)) {
            holds[joint].excitation = FrictionExcitation::WithoutOffset;
            has_jumped = true;
        }
        let fit = if has_jumped { refit(&holds).0 } else { fit };
        Self { holds, fit: Some(fit) }
    }

    /// Returns the fit with the fixed friction, or `free` if none is fixed.
    pub(crate) fn fit<'a>(&'a self, free: &'a LeastSquares) -> &'a LeastSquares {
        self.fit.as_ref().unwrap_or(free)
    }

    /// Makes the ratio of Coulomb friction in both directions exactly that of the file for joints whose offset is not
    /// determined.
    pub(crate) fn tie(&self, friction: &mut [[f64; FRICTION]]) {
        for (hold, [_, forward, backward]) in self.holds.iter().zip(friction) {
            if hold.excitation == FrictionExcitation::WithoutOffset {
                let coulomb = 0.5 * (*forward + *backward);
                (*forward, *backward) = (coulomb * (1.0 + hold.asymmetry()), coulomb * (1.0 - hold.asymmetry()));
            }
        }
    }

    /// Returns viscous friction and Coulomb friction forward and backward, each with its standard deviation.
    pub(crate) fn friction(
        &self,
        structure: &Structure,
        free: &LeastSquares,
        feasible: &Feasible,
        joint: usize,
    ) -> [(f64, f64); FRICTION] {
        let at = structure.parameters.rank() + FRICTION * joint;
        let [viscous, forward, backward] = feasible.friction[joint];
        let fit = self.fit_of(free, joint);
        [
            (viscous, fit.deviation(at)),
            (forward, fit.coulomb_deviation(at, 1.0)),
            (backward, fit.coulomb_deviation(at, -1.0)),
        ]
    }

    /// Returns the standard deviation of a joint's Coulomb friction over the joint's effort; infinite where it is not a
    /// number.
    pub(crate) fn uncertainty(&self, structure: &Structure, free: &LeastSquares, scales: &Scales, joint: usize) -> f64 {
        coulomb_uncertainty(structure, self.fit_of(free, joint), scales, joint)
    }

    /// Returns the fit from which the standard deviations of a joint's friction are taken: `free` where friction is
    /// that of the file, because fixed friction has none.
    fn fit_of<'a>(&'a self, free: &'a LeastSquares, joint: usize) -> &'a LeastSquares {
        if self.holds[joint].excitation == FrictionExcitation::None { free } else { self.fit(free) }
    }
}

/// Whether logs determine the offset of a joint. A plausible offset is at most as large as Coulomb friction: a robot
/// file cannot contain more. An offset that is far larger than its standard deviation is determined, too.
fn is_offset_known(structure: &Structure, fit: &LeastSquares, scales: &Scales, joint: usize) -> bool {
    let Some(at) = structure.friction_at(joint) else { return false };
    let plausible = fit.solution[at + 1].max(fit.solution[at + 2].abs());
    let deviation = fit.deviation(at + 2);
    deviation < UNKNOWN * plausible || deviation < SMALL * scales.friction[joint]
}

/// Returns the standard deviation of half the sum of Coulomb friction in both directions, over the joint's effort.
fn coulomb_uncertainty(structure: &Structure, fit: &LeastSquares, scales: &Scales, joint: usize) -> f64 {
    let deviation = structure.friction_at(joint).map_or(f64::INFINITY, |at| fit.deviation(at + 1));
    if deviation.is_nan() { f64::INFINITY } else { deviation / scales.friction[joint] }
}
