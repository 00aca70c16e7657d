//! Verdict on a model: the joints that it predicts, the reasons where it does not, and the parameters that the logs do
//! not excite.

use rne_model::{Joint, Robot};

use crate::fit::identifiability::Parameter;
use crate::fit::identification::{BaseReport, Identification, JointReport};
use crate::fit::information::Rejected;
use crate::replies::prediction::{JointError, Standstill};

/// The model predicts a joint if the error is at most this part of the effort's standard deviation.
const PREDICTED: f64 = 0.25;

/// A held-out error is much larger than the error on the data of the identification if it is more than this many times
/// as large.
const GROWTH: f64 = 2.0;

/// A held-out error below this part of the effort's standard deviation is small, however much it has grown.
const SMALL: f64 = 0.05;

/// Shortest standstill that may explain an error, s.
const STANDSTILL: f64 = 0.5;

/// Part of the squared residual that has to arise at rest for a standstill to explain an error.
const AT_REST: f64 = 0.5;

/// Largest residual that counts as rounding, N m or N.
const NOTHING: f64 = 1e-9;

/// The data on which a verdict is based.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Evidence {
    /// The data from which the model was identified: errors on other data may be larger.
    Fitted,
    /// Data of the same logs that the identification did not use.
    HeldOut,
    /// Logs on which a robot file is judged.
    Judged,
}

/// Verdict on a model, joint by joint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Verdict {
    /// The data on which the verdict is based.
    pub evidence: Evidence,
    /// A verdict for each joint, base to tip.
    pub joints: Vec<JointVerdict>,
    /// Parameters that the logs excite and those that they do not; `None` for a robot file that was only judged.
    pub excited: Option<Excited>,
}

/// Verdict on the predictions of a joint's torque.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointVerdict {
    /// Error on the data from which the model was identified; `None` for a robot file that was only judged.
    pub fitted: Option<JointError>,
    /// Error on other data: the held-out part, or the logs on which a robot file is judged.
    pub other: Option<JointError>,
    /// Whether the model predicts the torque.
    pub is_predicted: bool,
    /// Reasons for doubt, the most important one first. A joint that is predicted can have some, too; one that is not
    /// predicted has none if no cause is known.
    pub doubts: Vec<Doubt>,
}

/// A reason for which the model may not predict a joint's torque.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// No model of the arm explains the efforts: they are noise, have the opposite sign, or belong to another joint.
    Unexplained,
    /// The logs hardly load the joint, so its torque cannot be separated from noise.
    NotExcited,
    /// An offset is larger than Coulomb friction, N m or N; a robot file cannot store the rest.
    Offset {
        /// The offset.
        offset: f64,
        /// Coulomb friction.
        coulomb: f64,
    },
    /// Rows of the logs are far from all others: a push, or a sensor that failed.
    Outliers(Rejected),
    /// The joint stands still, and most of the error arises at rest. Its friction can have any value there between
    /// Coulomb friction in one direction and in the other.
    Standstill(Standstill),
    /// The logs do not determine the friction of the joint.
    FrictionNotExcited,
    /// The robot file that is judged has no friction for the joint.
    WithoutFriction,
    /// The held-out error is this many times the error on the data from which the model was identified.
    Grown(f64),
}

/// Parameters that logs excite, and those that they do not.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Excited {
    /// Number of base parameters.
    pub base_parameters: usize,
    /// The base parameters that are not excited, by the parameters that represent them.
    pub unknown_parameters: Vec<Parameter>,
    /// Number of joints whose friction was to be identified.
    pub frictions: usize,
    /// The joints whose friction is not excited, from 0.
    pub unknown_friction: Vec<usize>,
    /// The joints whose friction is excited, but whose offset is not: half the difference of Coulomb friction in both
    /// directions, from 0.
    pub unknown_offsets: Vec<usize>,
}

impl Verdict {
    /// The error up to which a joint counts as predicted, as a part of the effort's standard deviation.
    #[must_use]
    pub const fn limit() -> f64 {
        PREDICTED
    }

    /// Judges an identified model; `held_out` are its errors on data that the identification did not use.
    #[must_use]
    pub fn of(found: &Identification, held_out: Option<&[JointError]>) -> Self {
        let joint = |(at, report): (usize, &JointReport)| {
            let other = held_out.and_then(|errors| errors.get(at)).copied();
            let doubts = doubts(report, other.as_ref());
            JointVerdict::new(Some(report.error), other, doubts, report.is_excited())
        };
        Self {
            evidence: if held_out.is_some() { Evidence::HeldOut } else { Evidence::Fitted },
            joints: found.joints.iter().enumerate().map(joint).collect(),
            excited: Some(Excited::of(found)),
        }
    }

    /// Judges a robot file by its errors on logs.
    #[must_use]
    pub fn of_file(robot: &Robot, errors: &[JointError]) -> Self {
        let joint = |((error, joint), is_unknown): ((&JointError, &Joint), bool)| {
            let mut doubts = if is_unknown { vec![Doubt::NotExcited] } else { Vec::new() };
            if joint.motor.is_none_or(|motor| motor.viscous == 0.0 && motor.coulomb == [0.0; 2]) {
                doubts.push(Doubt::WithoutFriction);
            }
            JointVerdict::new(None, Some(*error), doubts, !is_unknown)
        };
        let joints =
            errors.iter().zip(robot.independent_joints()).zip(Identification::not_excited(robot)).map(joint).collect();
        Self { evidence: Evidence::Judged, joints, excited: None }
    }

    /// Number of joints that the model predicts.
    #[must_use]
    pub fn predicted(&self) -> usize {
        self.joints.iter().filter(|joint| joint.is_predicted).count()
    }
}

impl JointVerdict {
    fn new(fitted: Option<JointError>, other: Option<JointError>, doubts: Vec<Doubt>, is_excited: bool) -> Self {
        let mut verdict = Self { fitted, other, is_predicted: false, doubts };
        let Some(error) = verdict.error().copied() else { return verdict };
        // a constant effort has no standard deviation; it is predicted if the residual is only rounding
        let is_constant = error.deviation == 0.0 && error.residual <= NOTHING;
        verdict.is_predicted = is_excited && (is_constant || error.error <= PREDICTED);
        if let (false, Some(standstill)) = (verdict.is_predicted, error.standstill)
            && standstill.duration() >= STANDSTILL
            && error.part_at_rest >= AT_REST
        {
            let causes =
                |doubt: &Doubt| !matches!(doubt, Doubt::FrictionNotExcited | Doubt::WithoutFriction | Doubt::Grown(_));
            let place = verdict.doubts.iter().filter(|doubt| causes(doubt)).count();
            verdict.doubts.insert(place, Doubt::Standstill(standstill));
        }
        verdict
    }

    /// Returns the error that decides the verdict: the one on other data or, without one, that on the data of the
    /// identification.
    #[must_use]
    pub fn error(&self) -> Option<&JointError> {
        self.other.as_ref().or(self.fitted.as_ref())
    }

    /// Returns the factor by which the held-out error is larger than the error on the data of the identification;
    /// `None` if it is not much larger.
    #[must_use]
    pub fn growth(&self) -> Option<f64> {
        self.doubts.iter().find_map(|doubt| if let Doubt::Grown(factor) = doubt { Some(*factor) } else { None })
    }
}

/// Returns the reasons for doubt that follow from an identification.
fn doubts(report: &JointReport, held_out: Option<&JointError>) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    if report.is_unexplained() {
        doubts.push(Doubt::Unexplained);
    } else if !report.is_excited() {
        doubts.push(Doubt::NotExcited);
    } else if let Some((offset, coulomb)) = report.offset {
        doubts.push(Doubt::Offset { offset, coulomb });
    }
    doubts.extend(report.rejected.map(Doubt::Outliers));
    if report.friction.is_some() && !report.is_friction_excited() {
        doubts.push(Doubt::FrictionNotExcited);
    }
    let grown = held_out.map(|held_out| held_out.error / report.error.error);
    if let (Some(factor), Some(held_out)) = (grown, held_out)
        && factor > GROWTH
        && held_out.error > SMALL
    {
        doubts.push(Doubt::Grown(factor));
    }
    doubts
}

impl Excited {
    fn of(found: &Identification) -> Self {
        let bases = found.structure.parameters().bases.iter().zip(&found.bases);
        let unknown = bases.filter(|(_, report)| !BaseReport::is_excited(report)).map(|(base, _)| base.kept);
        let with_friction = || found.joints.iter().enumerate().filter(|(_, joint)| joint.friction.is_some());
        Self {
            base_parameters: found.bases.len(),
            unknown_parameters: unknown.collect(),
            frictions: with_friction().count(),
            unknown_friction: with_friction()
                .filter(|(_, joint)| !joint.is_friction_excited())
                .map(|(at, _)| at)
                .collect(),
            unknown_offsets: with_friction().filter(|(_, joint)| joint.is_offset_unknown()).map(|(at, _)| at).collect(),
        }
    }

    /// Number of base parameters that are excited.
    #[must_use]
    pub fn known_parameters(&self) -> usize {
        self.base_parameters - self.unknown_parameters.len()
    }

    /// Number of joints whose friction is excited.
    #[must_use]
    pub fn known_frictions(&self) -> usize {
        self.frictions - self.unknown_friction.len()
    }
}
