//! The part of a joint's friction that logs determine: all of it, Coulomb friction without its offset, or nothing.
//!
//! Coulomb friction forward and backward are the sum and the difference of two unknowns: half their sum, which changes
//! its sign with the speed, and half their difference, an offset, which does not. A joint that moves little has almost
//! the same gravity all the time, so its offset can be anything, and each direction alone is as uncertain as the
//! offset. Their sum is not. So the two unknowns are decided on one by one. What is not told is held where the file has
//! it, and everything else is fitted again: gravity then takes what the offset took before.

use crate::fit::feasible::Feasible;
use crate::fit::fitted_model::file_friction;
use crate::fit::identification::UNKNOWN;
use crate::fit::information::Information;
use crate::fit::least_squares::LeastSquares;
use crate::fit::prior::Scales;
use crate::fit::structure::{FRICTION, Structure};

/// Deviation of friction that is held, as a part of the joint's effort.
const HELD: f64 = 1e-4;

/// An offset is known well enough if its deviation is less than this part of the joint's effort, however small Coulomb
/// friction is: a verdict calls an error of this part small, too.
const SMALL: f64 = 0.05;

/// Friction is not given up where the residual would grow by more than this factor, and to more than this part of the
/// effort.
const JUMP: [f64; 2] = [2.0, 0.05];

/// The part of a joint's friction that logs determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionExcitation {
    /// Viscous friction, and Coulomb friction of each direction.
    Full,
    /// Viscous friction, and half the sum of Coulomb friction in both directions. Their ratio is that of the file; they
    /// are equal if the file has none.
    WithoutOffset,
    /// Nothing: the friction is that of the file.
    None,
}

/// The friction of a joint as far as it is held.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    pub(crate) excitation: FrictionExcitation,
    /// Viscous friction, half the sum and half the difference of Coulomb friction of the file.
    pub(crate) of_file: [f64; FRICTION],
}

impl Hold {
    /// The weight of the rows that hold friction, by the effort of the joint.
    pub(crate) fn weight(effort: f64) -> f64 {
        1.0 / (HELD * effort)
    }

    /// Half the difference of Coulomb friction in both directions over half the sum: a ratio, because friction in each
    /// direction stays positive then, whatever the sum turns out to be.
    pub(crate) fn asymmetry(&self) -> f64 {
        let [_, coulomb, offset] = self.of_file;
        if coulomb > offset.abs() { offset / coulomb } else { 0.0 }
    }
}

/// The friction that is held, and the fit to logs that results.
pub(crate) struct HeldFriction {
    /// One entry for each joint; none without friction.
    pub(crate) holds: Vec<Hold>,
    /// `None` if nothing is held, or nothing could be fitted.
    fit: Option<LeastSquares>,
}

impl HeldFriction {
    /// Decides on each joint; `free` is the fit without any hold.
    pub(crate) fn of(structure: &Structure, information: &Information, free: &LeastSquares, scales: &Scales) -> Self {
        let joints = if structure.options.friction { structure.dof() } else { 0 };
        let hold =
            |joint| Hold { excitation: FrictionExcitation::Full, of_file: file_friction(&structure.robot, joint) };
        let mut holds: Vec<Hold> = (0..joints).map(hold).collect();
        if free.covariance.iter().any(|value| value.is_nan()) {
            // too few rows for deviations
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
        // Coulomb and viscous friction can be unknown apart and known together, as at one speed
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

    /// The fit, with everything held that is.
    pub(crate) fn fit<'a>(&'a self, free: &'a LeastSquares) -> &'a LeastSquares {
        self.fit.as_ref().unwrap_or(free)
    }

    /// Makes the ratio of Coulomb friction in both directions exactly that of the file where it is held.
    pub(crate) fn tie(&self, friction: &mut [[f64; FRICTION]]) {
        for (hold, [_, forward, backward]) in self.holds.iter().zip(friction) {
            if hold.excitation == FrictionExcitation::WithoutOffset {
                let coulomb = 0.5 * (*forward + *backward);
                (*forward, *backward) = (coulomb * (1.0 + hold.asymmetry()), coulomb * (1.0 - hold.asymmetry()));
            }
        }
    }

    /// Viscous friction, Coulomb friction forward and backward, with deviations.
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

    /// The deviation of a joint's Coulomb friction over the joint's effort; infinite where it is not a number.
    pub(crate) fn uncertainty(&self, structure: &Structure, free: &LeastSquares, scales: &Scales, joint: usize) -> f64 {
        coulomb_uncertainty(structure, self.fit_of(free, joint), scales, joint)
    }

    /// The fit that has the deviations of a joint's friction: friction of the file has none of its own.
    fn fit_of<'a>(&'a self, free: &'a LeastSquares, joint: usize) -> &'a LeastSquares {
        if self.holds[joint].excitation == FrictionExcitation::None { free } else { self.fit(free) }
    }
}

/// Whether logs tell the offset of a joint. A plausible offset is as large as Coulomb friction: no robot file holds
/// more. An offset that is far larger than its deviation is known, too.
fn is_offset_known(structure: &Structure, fit: &LeastSquares, scales: &Scales, joint: usize) -> bool {
    let Some(at) = structure.friction_at(joint) else { return false };
    let plausible = fit.solution[at + 1].max(fit.solution[at + 2].abs());
    let deviation = fit.deviation(at + 2);
    deviation < UNKNOWN * plausible || deviation < SMALL * scales.friction[joint]
}

/// The deviation of half the sum of Coulomb friction in both directions, over the joint's effort.
fn coulomb_uncertainty(structure: &Structure, fit: &LeastSquares, scales: &Scales, joint: usize) -> f64 {
    let deviation = structure.friction_at(joint).map_or(f64::INFINITY, |at| fit.deviation(at + 1));
    if deviation.is_nan() { f64::INFINITY } else { deviation / scales.friction[joint] }
}
