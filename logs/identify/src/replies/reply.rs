//! The report on an identification that `rne identify --json` and Python return; docs/control/identify.md lists its
//! keys.

use rne_logs::Motion;
use rne_model::{FrictionTransition, Joint, JointKind, Robot};
use serde::Serialize;

use crate::fit::identification::{Identification, JointReport};
use crate::replies::prediction::JointError;
use crate::replies::verdict::{Doubt, Evidence, Excited, JointVerdict, Verdict};

/// The part of the logs on which a robot was judged.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct JudgedPart {
    /// Time of the first state, s.
    pub from: Option<f64>,
    /// Time of the last state, s.
    pub until: Option<f64>,
    /// Number of states.
    pub states: u64,
    /// Total duration of the motions, s.
    pub duration: f64,
}

impl JudgedPart {
    /// Adds the states of a motion.
    pub fn add(&mut self, motion: &Motion) {
        if let (Some(first), Some(last)) = (motion.time.first(), motion.time.last()) {
            self.from.get_or_insert(*first);
            self.until = Some(*last);
            self.states += motion.len() as u64;
            self.duration += last - first;
        }
    }
}

/// The report on an identification with all numbers of the verdict, which serde can write in any format. Numbers that
/// are not finite are null.
#[derive(Debug, Serialize)]
pub struct IdentificationReply {
    robot: String,
    logs: Vec<String>,
    states: u64,
    duration: f64,
    cutoff: f64,
    held_out: Option<JudgedPart>,
    verdict: OfVerdict,
    joints: Vec<OfJoint>,
    base_parameters: Vec<OfBase>,
    friction: Vec<OfFriction>,
    delay: Option<Measured>,
}

#[derive(Debug, Serialize)]
struct OfVerdict {
    errors_on: &'static str,
    limit: f64,
    predicted: Vec<String>,
    not_predicted: Vec<String>,
    base_parameters: Option<usize>,
    excited_base_parameters: Option<usize>,
    not_excited_base_parameters: Vec<String>,
    frictions: Option<usize>,
    excited_frictions: Option<usize>,
    not_excited_friction: Vec<String>,
    not_excited_offset: Vec<String>,
}

#[derive(Debug, Serialize)]
struct OfJoint {
    joint: usize,
    name: String,
    predicted: bool,
    unit: &'static str,
    fitted: Option<OfError>,
    held_out: Option<OfError>,
    judged: Option<OfError>,
    doubts: Vec<OfDoubt>,
    rotor: Option<f64>,
}

#[derive(Debug, Serialize)]
struct OfError {
    error: Option<f64>,
    unfiltered: Option<f64>,
    residual: Option<f64>,
    effort_deviation: Option<f64>,
    residual_by_speed: [Option<f64>; 4],
    states: u64,
}

#[derive(Debug, Serialize)]
#[serde(tag = "reason", rename_all = "snake_case")]
enum OfDoubt {
    Unexplained,
    NotExcited,
    Offset { offset: f64, coulomb: f64 },
    Outliers { rows: u64, first: f64 },
    Standstill { from: f64, until: f64, part_of_squared_error: Option<f64>, error_in_motion: Option<f64> },
    FrictionNotExcited,
    WithoutFriction,
    HeldOutErrorGrown { factor: Option<f64> },
}

/// A number with its standard deviation.
#[derive(Debug, Serialize)]
struct Measured {
    value: f64,
    deviation: f64,
    unit: &'static str,
}

#[derive(Debug, Serialize)]
struct OfBase {
    name: String,
    combination: String,
    value: f64,
    deviation: f64,
    half_interval: f64,
    written: f64,
    unit: &'static str,
    excited: bool,
}

#[derive(Debug, Serialize)]
struct OfFriction {
    joint: usize,
    name: String,
    excited: bool,
    offset_excited: bool,
    viscous: Measured,
    coulomb_forward: Measured,
    coulomb_backward: Measured,
    transition_speed: Option<f64>,
    transition_displacement: Option<f64>,
}

impl IdentificationReply {
    /// Makes the report on an identified model.
    #[must_use]
    pub fn of(
        found: &Identification,
        verdict: &Verdict,
        logs: Vec<String>,
        cutoff: f64,
        held_out: Option<JudgedPart>,
    ) -> Self {
        let bases = found.structure.parameters().bases.iter().zip(&found.bases);
        let base_parameters = bases.map(|(base, report)| OfBase {
            name: report.name.clone(),
            combination: report.combination.clone(),
            value: report.value,
            deviation: report.deviation,
            half_interval: report.half_interval,
            written: report.written,
            unit: found.structure.unit(base.kept),
            excited: report.is_excited(),
        });
        let mut joints = joints(&found.robot, verdict);
        for (joint, report) in joints.iter_mut().zip(&found.joints) {
            joint.rotor = report.rotor;
        }
        Self {
            robot: found.robot.name.clone(),
            logs,
            states: found.states,
            duration: found.duration,
            cutoff,
            held_out,
            verdict: OfVerdict::of(&found.robot, verdict, Some(found)),
            joints,
            base_parameters: base_parameters.collect(),
            friction: friction(found),
            delay: found.delay.map(|(value, deviation)| Measured { value, deviation, unit: "s" }),
        }
    }

    /// Makes the report on a robot file that was judged on logs.
    #[must_use]
    pub fn of_file(robot: &Robot, verdict: &Verdict, logs: Vec<String>, cutoff: f64, judged: JudgedPart) -> Self {
        Self {
            robot: robot.name.clone(),
            logs,
            states: judged.states,
            duration: judged.duration,
            cutoff,
            held_out: None,
            verdict: OfVerdict::of(robot, verdict, None),
            joints: joints(robot, verdict),
            base_parameters: Vec::new(),
            friction: Vec::new(),
            delay: None,
        }
    }
}

impl OfVerdict {
    fn of(robot: &Robot, verdict: &Verdict, found: Option<&Identification>) -> Self {
        let named = |is_predicted: bool| {
            let all = robot.independent_joints().zip(&verdict.joints);
            all.filter(|(_, verdict)| verdict.is_predicted == is_predicted)
                .map(|(joint, _)| joint.name.clone())
                .collect()
        };
        let excited = verdict.excited.as_ref();
        let unknown = excited.iter().flat_map(|excited| &excited.unknown_friction);
        let offsets = excited.iter().flat_map(|excited| &excited.unknown_offsets);
        let not_excited = found.iter().flat_map(|found| &found.bases).filter(|base| !base.is_excited());
        Self {
            errors_on: match verdict.evidence {
                Evidence::HeldOut => "held_out",
                Evidence::Judged => "judged",
                Evidence::Fitted => "fitted",
            },
            limit: Verdict::limit(),
            predicted: named(true),
            not_predicted: named(false),
            base_parameters: excited.map(|excited| excited.base_parameters),
            excited_base_parameters: excited.map(Excited::known_parameters),
            not_excited_base_parameters: not_excited.map(|base| base.name.clone()).collect(),
            frictions: excited.map(|excited| excited.frictions),
            excited_frictions: excited.map(Excited::known_frictions),
            not_excited_friction: unknown.map(|joint| robot.coordinate_name(*joint).to_owned()).collect(),
            not_excited_offset: offsets.map(|joint| robot.coordinate_name(*joint).to_owned()).collect(),
        }
    }
}

fn joints(robot: &Robot, verdict: &Verdict) -> Vec<OfJoint> {
    let each = robot.independent_joints().zip(&verdict.joints).enumerate();
    let joint = |(at, (joint, of)): (usize, (&Joint, &JointVerdict))| {
        let other = of.other.as_ref().map(OfError::of);
        let (held_out, judged) = if verdict.evidence == Evidence::Judged { (None, other) } else { (other, None) };
        OfJoint {
            joint: at + 1,
            name: joint.name.clone(),
            predicted: of.is_predicted,
            unit: joint.row.kind.effort_unit(),
            fitted: of.fitted.as_ref().map(OfError::of),
            held_out,
            judged,
            doubts: of.doubts.iter().map(|doubt| OfDoubt::of(doubt, of)).collect(),
            rotor: None,
        }
    };
    each.map(joint).collect()
}

/// Returns the number, or `None` if it is not finite.
pub(crate) fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

impl OfError {
    fn of(error: &JointError) -> Self {
        Self {
            error: finite(error.error),
            unfiltered: finite(error.unfiltered),
            residual: finite(error.residual),
            effort_deviation: finite(error.deviation),
            residual_by_speed: error.by_speed.map(finite),
            states: error.states,
        }
    }
}

impl OfDoubt {
    fn of(doubt: &Doubt, verdict: &JointVerdict) -> Self {
        match doubt {
            Doubt::Unexplained => Self::Unexplained,
            Doubt::NotExcited => Self::NotExcited,
            Doubt::Offset { offset, coulomb } => Self::Offset { offset: *offset, coulomb: *coulomb },
            Doubt::Outliers(rejected) => Self::Outliers { rows: rejected.rows, first: rejected.time },
            Doubt::Standstill(standstill) => Self::Standstill {
                from: standstill.start,
                until: standstill.end,
                part_of_squared_error: verdict.error().and_then(|error| finite(error.part_at_rest)),
                error_in_motion: verdict.error().and_then(JointError::in_motion),
            },
            Doubt::FrictionNotExcited => Self::FrictionNotExcited,
            Doubt::WithoutFriction => Self::WithoutFriction,
            Doubt::Grown(factor) => Self::HeldOutErrorGrown { factor: finite(*factor) },
        }
    }
}

fn friction(found: &Identification) -> Vec<OfFriction> {
    let each = found.robot.independent_joints().zip(&found.joints).enumerate();
    let joint = |(at, (joint, report)): (usize, (&Joint, &JointReport))| {
        let [viscous, forward, backward] = report.friction?;
        let effort = joint.row.kind.effort_unit();
        let rate = match joint.row.kind {
            JointKind::Revolute => "N m s/rad",
            JointKind::Prismatic => "N s/m",
        };
        let measured = |(value, deviation): (f64, f64), unit| Measured { value, deviation, unit };
        let (speed, displacement) = match report.transition {
            Some(FrictionTransition::Speed(speed)) => (Some(speed), None),
            Some(FrictionTransition::Displacement(length)) => (None, Some(length)),
            None => (None, None),
        };
        Some(OfFriction {
            joint: at + 1,
            name: joint.name.clone(),
            excited: report.is_friction_excited(),
            offset_excited: report.is_friction_excited() && !report.is_offset_unknown(),
            viscous: measured(viscous, rate),
            coulomb_forward: measured(forward, effort),
            coulomb_backward: measured(backward, effort),
            transition_speed: speed,
            transition_displacement: displacement,
        })
    };
    each.filter_map(joint).collect()
}
