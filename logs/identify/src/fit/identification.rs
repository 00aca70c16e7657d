//! From a geometry and logs to a robot: passes over the logs, the fit, the bodies, and the report on them.

mod robot;

use std::ops::Range;

use rne_logs::Motion;
use rne_model::{FrictionTransition, Robot};

pub(crate) use self::robot::link;
use self::robot::{not_finite, robot_of};
use crate::fit::feasible::Feasible;
use crate::fit::friction::{FrictionExcitation, HeldFriction};
use crate::fit::information::{Information, MotionError, Rejected, Weighting};
use crate::fit::least_squares::LeastSquares;
use crate::fit::parameters::Parameters;
use crate::fit::prior::Scales;
use crate::fit::steady::steady;
use crate::fit::structure::{FRICTION, Options, Structure};
use crate::replies::prediction::{JointError, Prediction};

/// Passes over the logs: one to begin with, and two in which rows that are far off count less.
const PASSES: usize = 3;

/// A row that is off by more standard deviations does not count where the arm was pushed or touched during some
/// segments.
const OUTLIER_BOUND: f64 = 30.0;

/// A base parameter is not excited where its deviation is larger than this part of what plausible links would give it.
pub(crate) const UNKNOWN: f64 = 0.5;

/// A joint is not excited where more than this part of its effort is no torque of any model, root mean square.
const NOISE: f64 = 0.5;

/// The residual of a joint that no model explains, as a part of its effort; above this range the effort does not
/// change.
const UNEXPLAINED: Range<f64> = 0.9..10.0;

/// Efforts that are all smaller than this, in N m or N, are not torques.
const LEAST_EFFORT: f64 = 1e-9;

/// A robot that was identified, with the report on it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Identification {
    /// The robot: the geometry that was given, links and motors that were identified.
    pub robot: Robot,
    /// The columns.
    pub structure: Structure,
    /// The least-squares estimate, whether or not bodies can be so.
    pub least_squares: LeastSquares,
    /// The estimate whose links are bodies.
    pub feasible: Feasible,
    /// Every base parameter, base to tip.
    pub bases: Vec<BaseReport>,
    /// Every joint.
    pub joints: Vec<JointReport>,
    /// Delay of the torques against the positions, s, with its deviation.
    pub delay: Option<(f64, f64)>,
    /// States that were read, and rows of each joint that were made of them.
    pub states: u64,
    /// Rows of each joint.
    pub rows: u64,
    /// s
    pub duration: f64,
}

/// The result for a base parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseReport {
    /// `Jzz2`
    pub name: String,
    /// `Jzz2 + 0.3745 m3`
    pub combination: String,
    /// kg m², kg m or kg: by least squares alone.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Its value for the links of the file.
    pub written: f64,
    /// Half the width of its interval of 95 %, by Student's t of the segments of time.
    pub half_interval: f64,
    /// Its deviation over what plausible links would give it: below 0.5 it counts as excited. Infinite if the
    /// logs do not move any joint whose torque depends on it: then no torque separates it from noise.
    pub uncertainty: f64,
}

impl BaseReport {
    /// Whether the logs tell it; else the file's value is what was supposed before.
    #[must_use]
    pub fn is_excited(&self) -> bool {
        self.uncertainty < UNKNOWN
    }
}

/// The result for a joint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointReport {
    /// Noise after the filter, N m or N.
    pub noise: f64,
    /// Effort after the filter, root mean square, N m or N; at least 1e-6.
    pub effort: f64,
    /// Rows so far from all others that they do not count: of a push, of a sensor that failed.
    pub rejected: Option<Rejected>,
    /// Over the logs that it was identified from.
    pub error: JointError,
    /// Viscous friction, N m s/rad, Coulomb friction forward and backward, N m, with deviations, at the joint.
    pub friction: Option<[(f64, f64); FRICTION]>,
    /// The deviation of Coulomb friction, half the sum of both directions, over the joint's effort, root mean square:
    /// below 0.5 friction counts as excited. Infinite without friction.
    pub friction_uncertainty: f64,
    /// The part of its friction that the logs determine; the rest is that of the file.
    pub friction_excitation: FrictionExcitation,
    /// Transition of Coulomb friction between its two signs.
    pub transition: Option<FrictionTransition>,
    /// An offset that least squares find to be larger than Coulomb friction, and the latter, N m or N: a spring, a
    /// counterweight, a sensor. A robot file holds as much of it as there is Coulomb friction, and nothing of the rest.
    pub offset: Option<(f64, f64)>,
    /// kg m² or kg, at the joint.
    pub rotor: Option<f64>,
}

impl JointReport {
    /// Whether the logs tell its torque from noise.
    #[must_use]
    pub fn is_excited(&self) -> bool {
        if self.rejected.is_none() && self.offset.is_none() {
            self.error.as_read < NOISE
        } else {
            // errors are of what does not count, too
            self.noise < NOISE * self.effort
        }
    }

    /// Whether no model of the arm explains efforts that do change: they are noise, of another sign, or those of
    /// another joint.
    #[must_use]
    pub fn is_unexplained(&self) -> bool {
        !self.is_excited() && UNEXPLAINED.contains(&self.error.as_read)
    }

    /// Whether the logs tell its friction.
    #[must_use]
    pub fn is_friction_excited(&self) -> bool {
        self.friction_excitation != FrictionExcitation::None
    }

    /// Whether the logs tell its friction, but not how much the two directions differ: that half of their difference
    /// is an offset, which gravity hides if the joint moves little.
    #[must_use]
    pub fn is_offset_unknown(&self) -> bool {
        self.friction_excitation == FrictionExcitation::WithoutOffset
    }
}

impl Identification {
    /// Whether the logs tell anything at all: a base parameter or the friction of a joint.
    #[must_use]
    pub fn is_anything_excited(&self) -> bool {
        self.bases.iter().any(BaseReport::is_excited) || self.joints.iter().any(JointReport::is_friction_excited)
    }
}

/// The result of one pass over the logs.
pub(crate) struct OverLogs {
    pub(crate) information: Information,
    pub(crate) scales: Scales,
    pub(crate) least_squares: LeastSquares,
}

/// Identifies a robot. `pass` hands every motion of the logs to what it is given, each time it is called; the motions
/// may be parts of logs. `regularization` is γ of [`Feasible`].
///
/// # Errors
/// When a motion is of another robot; when all of them make fewer rows than deviations need, or have no efforts; when
/// what is found is not finite; or what `pass` fails with.
pub fn identify<E: From<MotionError>>(
    robot: &Robot,
    options: Options,
    regularization: f64,
    mut pass: impl FnMut(&mut dyn FnMut(&Motion) -> Result<(), MotionError>) -> Result<(), E>,
) -> Result<Identification, E> {
    let structure = Structure::new(robot, options);
    let OverLogs { information, scales, least_squares } = over_logs(&structure, false, &mut pass)?;
    let fit = Fit::of_least_squares(&structure, &information, least_squares, &scales, regularization);
    if let Some(joint) = not_finite(&fit.robot) {
        return Err(MotionError::NotANumber(joint).into());
    }
    let mut prediction = Prediction::new(&fit.robot, structure.options.cutoff);
    pass(&mut |motion| prediction.absorb(motion))?;
    let joints = joints(&structure, &fit, &prediction.errors(), &information.rejected);
    let Fit { robot: identified, least_squares, feasible, mut bases, .. } = fit;
    for (base, report) in structure.parameters.bases.iter().zip(&mut bases) {
        let mut felt = joints.iter().enumerate().filter(|(joint, _)| Parameters::is_felt(robot, base, *joint));
        if !felt.any(|(_, joint)| joint.is_excited()) {
            report.uncertainty = f64::INFINITY;
        }
    }
    // what the last pass found beyond what its rows were shifted by
    let delay = structure.options.delay.then(|| {
        let at = least_squares.solution.len() - 1;
        (least_squares.delay, least_squares.deviation(at))
    });
    Ok(Identification {
        robot: identified,
        states: information.states(),
        rows: information.rows(),
        duration: information.duration(),
        structure,
        least_squares,
        feasible,
        bases,
        joints,
        delay,
    })
}

/// Least squares over logs in several passes, by which noise, outliers and the delay settle; `doubts_rest` gives rows
/// near rest less weight.
pub(crate) fn over_logs<E: From<MotionError>>(
    structure: &Structure,
    doubts_rest: bool,
    pass: &mut impl FnMut(&mut dyn FnMut(&Motion) -> Result<(), MotionError>) -> Result<(), E>,
) -> Result<OverLogs, E> {
    let mut pass_once = |weighting: Option<&Weighting>| -> Result<OverLogs, E> {
        let mut information = Information::new(structure);
        pass(&mut |motion| information.absorb(structure, motion, weighting))?;
        if information.segments.len() < 2 {
            let (rows, needed, duration) = (information.rows(), information.needed(), information.duration());
            return Err(MotionError::TooFew { rows, needed, duration }.into());
        }
        if information.largest.iter().all(|most| *most <= LEAST_EFFORT) {
            return Err(MotionError::NoEfforts.into());
        }
        let scales = information.scales(structure);
        let least_squares = LeastSquares::of(structure, &information, &scales);
        Ok(OverLogs { information, scales, least_squares })
    };
    let mut found = pass_once(None)?;
    let steady = steady(structure, &found.information, &found.least_squares);
    let outlier_bound = if steady.is_some() { OUTLIER_BOUND } else { f64::INFINITY };
    found.least_squares = steady.unwrap_or(found.least_squares);
    for _ in 1..PASSES {
        let weighting = Weighting { outlier_bound, ..found.least_squares.weighting(structure) };
        let weighting = if doubts_rest { weighting.with_doubt_near_rest() } else { weighting };
        found = pass_once(Some(&weighting))?;
    }
    Ok(found)
}

/// The robot that fits gathered rows, all of which count alike.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The robot: the geometry that was given, links and motors that were identified.
    pub robot: Robot,
    /// The least-squares estimate, whether or not bodies can be so.
    pub least_squares: LeastSquares,
    /// The estimate whose links are bodies, and whose friction is that of the file where the rows do not tell it.
    pub feasible: Feasible,
    /// Every base parameter, base to tip.
    pub bases: Vec<BaseReport>,
    /// Viscous friction, N m s/rad, Coulomb friction forward and backward, N m, with deviations, at each joint; without
    /// friction none. Where the rows do not tell the offset, the deviations are for the offset of the file.
    pub friction: Vec<[(f64, f64); FRICTION]>,
    /// The part of the friction of each joint that the rows determine.
    pub friction_excitation: Vec<FrictionExcitation>,
    /// The deviation of the Coulomb friction of each joint over its effort.
    friction_uncertainties: Vec<f64>,
    /// The root mean square of each joint's efforts, N m or N.
    pub efforts: Vec<f64>,
}

impl Fit {
    /// Whether the rows tell the friction of a joint, with its offset or without. Viscous friction is told by the same
    /// rows: in its own unit it has no effort to be held against.
    #[must_use]
    pub fn is_friction_excited(&self, joint: usize) -> bool {
        self.excitation(joint) != FrictionExcitation::None
    }

    fn excitation(&self, joint: usize) -> FrictionExcitation {
        self.friction_excitation.get(joint).copied().unwrap_or(FrictionExcitation::None)
    }

    /// Fits what was gathered. `regularization` is γ of [`Feasible`].
    #[must_use]
    pub fn new(structure: &Structure, information: &Information, regularization: f64) -> Self {
        let scales = information.scales(structure);
        let least_squares = LeastSquares::of(structure, information, &scales);
        Self::of_least_squares(structure, information, least_squares, &scales, regularization)
    }

    fn of_least_squares(
        structure: &Structure,
        information: &Information,
        fit: LeastSquares,
        scales: &Scales,
        regularization: f64,
    ) -> Self {
        let held = HeldFriction::of(structure, information, &fit, scales);
        let mut feasible = Feasible::of(structure, held.fit(&fit), scales, regularization);
        held.tie(&mut feasible.friction);
        let friction = (0..held.holds.len()).map(|joint| held.friction(structure, &fit, &feasible, joint)).collect();
        let uncertainties = (0..held.holds.len()).map(|joint| held.uncertainty(structure, &fit, scales, joint));
        let mut fit = Self {
            robot: structure.robot.clone(),
            bases: Vec::new(),
            friction,
            friction_uncertainties: uncertainties.collect(),
            friction_excitation: held.holds.iter().map(|hold| hold.excitation).collect(),
            efforts: scales.friction.clone(),
            // deviations without any hold: what is held has none
            least_squares: fit,
            feasible,
        };
        fit.robot = robot_of(structure, &fit);
        fit.bases = bases(structure, &fit.least_squares, scales, &fit.robot);
        fit
    }
}

fn bases(structure: &Structure, fit: &LeastSquares, scales: &Scales, robot: &Robot) -> Vec<BaseReport> {
    let parameters = structure.parameters();
    let written = &parameters.regrouping * parameters.of_robot(robot);
    let reports = parameters.bases.iter().enumerate().map(|(at, base)| BaseReport {
        name: base.name(),
        combination: base.combination(),
        value: fit.solution[at],
        deviation: fit.deviation(at),
        half_interval: fit.half_interval(at),
        written: written[at],
        uncertainty: fit.deviation(at) / scales.bases[at],
    });
    reports.collect()
}

fn joints(structure: &Structure, one: &Fit, errors: &[JointError], rejected: &[Option<Rejected>]) -> Vec<JointReport> {
    let reports = errors.iter().zip(rejected).enumerate().map(|(joint, (error, rejected))| JointReport {
        noise: one.least_squares.noise[joint],
        effort: one.efforts[joint],
        rejected: *rejected,
        error: *error,
        friction: one.friction.get(joint).copied(),
        friction_uncertainty: one.friction_uncertainties.get(joint).copied().unwrap_or(f64::INFINITY),
        friction_excitation: one.excitation(joint),
        transition: structure.options.friction.then(|| structure.transitions[one.least_squares.transitions[joint]]),
        offset: one.least_squares.loose_offset(structure, joint, one.efforts[joint]),
        rotor: structure.options.rotors.then(|| one.feasible.rotors[joint]),
    });
    reports.collect()
}
