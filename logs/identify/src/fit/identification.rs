//! Identifies a robot from its geometry and logs: passes over the logs, the fit, feasible links, and a report.

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

/// Number of passes over the logs: a first one, and two in which rows with large residuals have less weight.
const PASSES: usize = 3;

/// If some segments of time are outliers, as when the arm was pushed or touched, rows whose residual is above this
/// number of standard deviations do not count.
const OUTLIER_BOUND: f64 = 30.0;

/// A base parameter is not excited if its standard deviation is larger than this part of its value for plausible links.
pub(crate) const UNKNOWN: f64 = 0.5;

/// A joint is not excited if its residual is more than this part of its effort, root mean square.
const NOISE: f64 = 0.5;

/// Range of the residual of a joint, as a part of its effort, that means that no model explains the effort. Above this
/// range, the effort does not change.
const UNEXPLAINED: Range<f64> = 0.9..10.0;

/// Largest magnitude, N m or N, of efforts that count as zeros and not as torques.
const LEAST_EFFORT: f64 = 1e-9;

/// The result of an identification: the robot and a report on it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Identification {
    /// The robot: the geometry that was given, links and motors that were identified.
    pub robot: Robot,
    /// The equations of the identification: their columns and unknowns.
    pub structure: Structure,
    /// The least-squares estimate, which may be physically impossible.
    pub least_squares: LeastSquares,
    /// The estimate whose links are physically possible.
    pub feasible: Feasible,
    /// The result for every base parameter, base to tip.
    pub bases: Vec<BaseReport>,
    /// The result for every joint, base to tip.
    pub joints: Vec<JointReport>,
    /// Time by which the torques lag behind the positions, s, with its standard deviation; `None` if it was not asked
    /// for.
    pub delay: Option<(f64, f64)>,
    /// Number of states that were read.
    pub states: u64,
    /// Number of rows of each joint that were made of the states.
    pub rows: u64,
    /// Duration of the motions, s.
    pub duration: f64,
}

/// The result for a base parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseReport {
    /// Name of the parameter that represents the base parameter, such as `Jzz2`.
    pub name: String,
    /// The linear combination, such as `Jzz2 + 0.3745 m3`.
    pub combination: String,
    /// Value by least squares alone, kg m², kg m or kg.
    pub value: f64,
    /// Standard deviation of the value.
    pub deviation: f64,
    /// The value that the links of the identified robot file give.
    pub written: f64,
    /// Half the width of the 95 % confidence interval, by Student's t from the segments of time.
    pub half_interval: f64,
    /// The standard deviation over the value for plausible links: below 0.5 the parameter counts as excited. Infinite
    /// if the logs excite no joint whose torque depends on the parameter.
    pub uncertainty: f64,
}

impl BaseReport {
    /// Whether the logs determine the base parameter. If not, the value in the file is the prior one.
    #[must_use]
    pub fn is_excited(&self) -> bool {
        self.uncertainty < UNKNOWN
    }
}

/// The result for a joint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointReport {
    /// Standard deviation of the noise after the filter, N m or N.
    pub noise: f64,
    /// Effort after the filter, root mean square, N m or N; at least 1e-6.
    pub effort: f64,
    /// Rows whose residuals are so large that they do not count, as after a push or a sensor's failure.
    pub rejected: Option<Rejected>,
    /// Error of the predicted torques on the logs of the identification.
    pub error: JointError,
    /// Viscous friction, N m s/rad, and Coulomb friction forward and backward, N m, at the joint, each with its
    /// standard deviation.
    pub friction: Option<[(f64, f64); FRICTION]>,
    /// The standard deviation of half the sum of Coulomb friction in both directions, over the joint's effort, root
    /// mean square: below 0.5 friction counts as excited. Infinite without friction.
    pub friction_uncertainty: f64,
    /// The part of the joint's friction that the logs determine; the rest is that of the file.
    pub friction_excitation: FrictionExcitation,
    /// Transition of Coulomb friction between its two signs.
    pub transition: Option<FrictionTransition>,
    /// Offset and Coulomb friction of the joint, N m or N, if least squares find a larger offset than Coulomb friction:
    /// a spring, a counterweight, a faulty sensor. A robot file can contain an offset up to Coulomb friction only.
    pub offset: Option<(f64, f64)>,
    /// Inertia of the rotor at the joint, kg m² or kg.
    pub rotor: Option<f64>,
}

impl JointReport {
    /// Whether the logs distinguish the joint's torque from noise.
    #[must_use]
    pub fn is_excited(&self) -> bool {
        if self.rejected.is_none() && self.offset.is_none() {
            self.error.as_read < NOISE
        } else {
            // the error is no measure here, because it includes outliers or an offset that the file cannot contain
            self.noise < NOISE * self.effort
        }
    }

    /// Whether no model of the arm explains the efforts although they change: they are noise, have the opposite sign,
    /// or belong to another joint.
    #[must_use]
    pub fn is_unexplained(&self) -> bool {
        !self.is_excited() && UNEXPLAINED.contains(&self.error.as_read)
    }

    /// Whether the logs determine the joint's friction.
    #[must_use]
    pub fn is_friction_excited(&self) -> bool {
        self.friction_excitation != FrictionExcitation::None
    }

    /// Whether the logs determine the joint's friction, but not how much the two directions differ. Half the difference
    /// is an offset, which cannot be separated from gravity if the joint moves little.
    #[must_use]
    pub fn is_offset_unknown(&self) -> bool {
        self.friction_excitation == FrictionExcitation::WithoutOffset
    }
}

impl Identification {
    /// Whether the logs determine anything: a base parameter or the friction of a joint.
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

/// Identifies a robot. `pass` is called several times and passes every motion of the logs to its argument each time;
/// the motions may be parts of logs. `regularization` is γ of [`Feasible`].
///
/// # Errors
/// When a motion is of another robot; when all motions give fewer rows than standard deviations need, or have no
/// efforts; when a result is not finite; or when `pass` fails.
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
    // the total delay: the shift of the last pass plus the rest that this pass found
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

/// Fits logs by least squares in several passes, in which noise, outliers and the delay converge; `doubts_rest` gives
/// rows near rest less weight.
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

/// The robot that fits the rows in an [`Information`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The robot: the geometry that was given, links and motors that were identified.
    pub robot: Robot,
    /// The least-squares estimate, which may be physically impossible.
    pub least_squares: LeastSquares,
    /// The estimate whose links are physically possible, and whose friction is that of the file where the rows do not
    /// determine it.
    pub feasible: Feasible,
    /// The result for every base parameter, base to tip.
    pub bases: Vec<BaseReport>,
    /// Viscous friction, N m s/rad, and Coulomb friction forward and backward, N m, at each joint, each with its
    /// standard deviation; empty without friction. Where the rows do not determine the offset, the standard deviations
    /// are for the offset of the file.
    pub friction: Vec<[(f64, f64); FRICTION]>,
    /// The part of the friction of each joint that the rows determine.
    pub friction_excitation: Vec<FrictionExcitation>,
    /// The standard deviation of the Coulomb friction of each joint over the joint's effort.
    friction_uncertainties: Vec<f64>,
    /// The root mean square of each joint's efforts, N m or N.
    pub efforts: Vec<f64>,
}

impl Fit {
    /// Whether the rows determine the friction of a joint, with its offset or without. This is judged by Coulomb
    /// friction alone: viscous friction has another unit than the effort, so the two cannot be compared.
    #[must_use]
    pub fn is_friction_excited(&self, joint: usize) -> bool {
        self.excitation(joint) != FrictionExcitation::None
    }

    fn excitation(&self, joint: usize) -> FrictionExcitation {
        self.friction_excitation.get(joint).copied().unwrap_or(FrictionExcitation::None)
    }

    /// Fits the gathered rows. `regularization` is γ of [`Feasible`].
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
            // the fit without fixed friction, because fixed friction has no standard deviation
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
