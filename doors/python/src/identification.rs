//! Identification of an arm from its logs, with the keys of `rne identify --json`.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_identify::{
    ArmLog, Doubt, Evidence, Excited, Identification, JointError, JointVerdict, MotionError, Options, Part, PassError,
    Prediction, Purpose, Verdict, identify,
};
use rne_logs::Motion;
use rne_model::{FrictionTransition, JointKind, Robot, one_line};
use rne_plot::{Comparison, comparison_svg};

use crate::arm::Arm;
use crate::interruption::interruptible;
use crate::log_errors::{of_arm_log, of_pass};
use crate::logs::{Reading, Said, finite, robot_of, said};

/// States of a picture.
const DRAWN: u64 = 4000;

/// A part of the logs.
#[derive(Clone, Copy, Default, IntoPyObject)]
pub(crate) struct Extent {
    from: Option<f64>,
    until: Option<f64>,
    pub(crate) states: u64,
    pub(crate) duration: f64,
}

#[derive(IntoPyObject)]
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

impl OfVerdict {
    fn of(found: &Identification, verdict: &Verdict) -> Self {
        let robot = &found.robot;
        let named = |is_predicted: bool| {
            let all = robot.joints.iter().zip(&verdict.joints);
            let named = all.filter(|(_, verdict)| verdict.is_predicted == is_predicted);
            named.map(|(joint, _)| joint.name.clone()).collect()
        };
        let excited = verdict.excited.as_ref();
        let unknown = excited.iter().flat_map(|excited| &excited.unknown_friction);
        let offsets = excited.iter().flat_map(|excited| &excited.unknown_offsets);
        let not_excited = found.bases.iter().filter(|base| !base.is_excited());
        Self {
            errors_on: if verdict.evidence == Evidence::HeldOut { "held_out" } else { "fitted" },
            limit: Verdict::limit(),
            predicted: named(true),
            not_predicted: named(false),
            base_parameters: excited.map(|excited| excited.base_parameters),
            excited_base_parameters: excited.map(Excited::known_parameters),
            not_excited_base_parameters: not_excited.map(|base| base.name.clone()).collect(),
            frictions: excited.map(|excited| excited.frictions),
            excited_frictions: excited.map(Excited::known_frictions),
            not_excited_friction: unknown.map(|joint| robot.joints[*joint].name.clone()).collect(),
            not_excited_offset: offsets.map(|joint| robot.joints[*joint].name.clone()).collect(),
        }
    }
}

#[derive(IntoPyObject)]
struct OfError {
    error: Option<f64>,
    unfiltered: Option<f64>,
    residual: Option<f64>,
    effort_deviation: Option<f64>,
    residual_by_speed: [Option<f64>; 4],
    states: u64,
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

#[derive(IntoPyObject)]
struct OfJoint<'py> {
    joint: usize,
    name: String,
    predicted: bool,
    unit: &'static str,
    fitted: Option<OfError>,
    held_out: Option<OfError>,
    doubts: Vec<Bound<'py, PyDict>>,
    rotor: Option<f64>,
}

/// A doubt: its reason, and what belongs to it.
fn doubt<'py>(py: Python<'py>, doubt: &Doubt, verdict: &JointVerdict) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    let reason = match doubt {
        Doubt::Unexplained => "unexplained",
        Doubt::NotExcited => "not_excited",
        Doubt::Offset { offset, coulomb } => {
            found.set_item("offset", offset)?;
            found.set_item("coulomb", coulomb)?;
            "offset"
        }
        Doubt::Outliers(rejected) => {
            found.set_item("rows", rejected.rows)?;
            found.set_item("first", rejected.time)?;
            "outliers"
        }
        Doubt::Standstill(standstill) => {
            found.set_item("from", standstill.start)?;
            found.set_item("until", standstill.end)?;
            let part = verdict.error().and_then(|error| finite(error.part_at_rest));
            found.set_item("part_of_squared_error", part)?;
            found.set_item("error_in_motion", verdict.error().and_then(JointError::in_motion))?;
            "standstill"
        }
        Doubt::FrictionNotExcited => "friction_not_excited",
        Doubt::WithoutFriction => "without_friction",
        Doubt::Grown(factor) => {
            found.set_item("factor", finite(*factor))?;
            "held_out_error_grown"
        }
        _ => "other",
    };
    found.set_item("reason", reason)?;
    Ok(found)
}

/// A number with its standard deviation.
#[derive(IntoPyObject)]
struct Measured {
    value: f64,
    deviation: f64,
    unit: &'static str,
}

#[derive(IntoPyObject)]
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

#[derive(IntoPyObject)]
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

fn friction(found: &Identification) -> Vec<OfFriction> {
    let each = found.robot.joints.iter().zip(&found.joints).enumerate();
    let of_joint = each.filter_map(|(at, (joint, report))| {
        let [viscous, forward, backward] = report.friction?;
        let effort = joint.row.kind.effort_unit();
        let rate = match joint.row.kind {
            JointKind::Revolute => "N m s/rad",
            JointKind::Prismatic => "N s/m",
        };
        let measured = |(value, deviation): (f64, f64), unit| Measured { value, deviation, unit };
        let (transition_speed, transition_displacement) = match report.transition {
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
            transition_speed,
            transition_displacement,
        })
    });
    of_joint.collect()
}

/// Errors of a robot on a part of a log.
pub(crate) struct Judged {
    pub(crate) errors: Vec<JointError>,
    pub(crate) extent: Extent,
}

impl Judged {
    pub(crate) fn of(robot: &Robot, log: &ArmLog, part: Part, look: &mut dyn FnMut(f64)) -> PyResult<Self> {
        let mut prediction = Prediction::new(robot, Some(log.cutoff()));
        let mut extent = Extent::default();
        let mut take = |motion: &Motion| {
            if let (Some(first), Some(last)) = (motion.time.first(), motion.time.last()) {
                extent.from.get_or_insert(*first);
                extent.until = Some(*last);
                extent.states += motion.len() as u64;
                extent.duration += last - first;
            }
            prediction.absorb(motion)
        };
        log.pass_with_progress(part, &mut take, look).map_err(of_pass)?;
        Ok(Self { errors: prediction.errors(), extent })
    }
}

/// Measured and predicted torques of a part of a log.
fn picture(
    robot: &Robot,
    log: &ArmLog,
    part: Part,
    judged: &Judged,
    [title, about]: [&str; 2],
    look: &mut dyn FnMut(f64),
) -> PyResult<String> {
    let stride = usize::try_from(judged.extent.states.div_ceil(DRAWN)).unwrap_or(usize::MAX).max(1);
    let prediction = Prediction::new(robot, Some(log.cutoff()));
    let mut time = Vec::new();
    let (mut measured, mut predicted) = (vec![Vec::new(); robot.dof()], vec![Vec::new(); robot.dof()]);
    let mut take = |motion: &Motion| {
        time.extend(motion.time.iter().step_by(stride));
        for (joint, pairs) in prediction.pairs(motion)?.into_iter().enumerate() {
            measured[joint].extend(pairs.iter().step_by(stride).map(|pair| pair.0));
            predicted[joint].extend(pairs.iter().step_by(stride).map(|pair| pair.1));
        }
        Ok::<(), MotionError>(())
    };
    log.pass_with_progress(part, &mut take, look).map_err(of_pass)?;
    let notes: Vec<String> = judged.errors.iter().map(|error| format!("error {:.1} %", 100.0 * error.error)).collect();
    let about = format!("{about}; both torques low-passed at {:.1} Hz", log.cutoff());
    let of =
        Comparison { title, about: &about, time: &time, measured: &measured, predicted: &predicted, notes: &notes };
    Ok(comparison_svg(robot, &of))
}

/// What was computed without the interpreter.
struct Found {
    identification: Identification,
    verdict: Verdict,
    held_out: Option<Extent>,
    cutoff: f64,
    words: String,
    remarks: Vec<Said>,
    picture: String,
}

/// An identified model: a dict with the keys of `rne identify --json`, and `text_of_file`, `picture`, `remarks`.
#[pyfunction]
pub(crate) fn identified<'py>(
    py: Python<'py>,
    arm: PyRef<'_, Arm>,
    paths: Vec<PathBuf>,
    reading: Reading,
    hold_out: Option<f64>,
    rotors: bool,
    friction: bool,
    regularization: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let robot = robot_of(&arm)?;
    let log_options = reading.of_arm(Purpose::Fit)?;
    let found = interruptible(py, |look| {
        let log = ArmLog::open_with_progress(&paths, &robot, &log_options, look).map_err(|error| of_arm_log(&error))?;
        let mut options = Options::default();
        options.friction = friction;
        options.rotors = rotors;
        options.cutoff = Some(log.cutoff());
        let (training, held) = match hold_out {
            Some(part) => (Part::Before(1.0 - part), Some(Part::From(1.0 - part))),
            None => (Part::All, None),
        };
        let found = identify::<PassError<MotionError>>(&robot, options, regularization, |take| {
            log.pass_with_progress(training, take, look)
        })
        .map_err(of_pass)?;
        let judged = Judged::of(&found.robot, &log, held.unwrap_or(Part::All), look)?;
        let held_errors = held.map(|_| &judged.errors[..]);
        let verdict = Verdict::of(&found, held_errors);
        let title = format!("{} identified from {}", one_line(&robot.name), log.summary());
        let about = if held.is_some() { "held-out part of the log" } else { "the data of the identification" };
        let picture = picture(&found.robot, &log, held.unwrap_or(Part::All), &judged, [title.as_str(), about], look)?;
        Ok::<_, PyErr>(Found {
            identification: found,
            verdict,
            held_out: held.map(|_| judged.extent),
            cutoff: log.cutoff(),
            words: log.summary(),
            remarks: said(log.remarks()),
            picture,
        })
    })??;
    dict(py, &found, &paths)
}

fn dict<'py>(py: Python<'py>, found: &Found, paths: &[PathBuf]) -> PyResult<Bound<'py, PyDict>> {
    let Found { identification, verdict, .. } = found;
    let robot = &identification.robot;
    let bases = identification.structure.parameters().bases.iter().zip(&identification.bases);
    let base_parameters: Vec<OfBase> = bases
        .map(|(base, report)| OfBase {
            name: report.name.clone(),
            combination: report.combination.clone(),
            value: report.value,
            deviation: report.deviation,
            half_interval: report.half_interval,
            written: report.written,
            unit: identification.structure.unit(base.kept),
            excited: report.is_excited(),
        })
        .collect();
    let of_joint = |(at, of): (usize, &JointVerdict)| {
        let joint = &robot.joints[at];
        Ok(OfJoint {
            joint: at + 1,
            name: joint.name.clone(),
            predicted: of.is_predicted,
            unit: joint.row.kind.effort_unit(),
            fitted: of.fitted.as_ref().map(OfError::of),
            held_out: of.other.as_ref().map(OfError::of),
            doubts: of.doubts.iter().map(|one| doubt(py, one, of)).collect::<PyResult<_>>()?,
            rotor: identification.joints[at].rotor,
        })
    };
    let joints = verdict.joints.iter().enumerate().map(of_joint).collect::<PyResult<Vec<_>>>()?;
    let reply = PyDict::new(py);
    reply.set_item("robot", &robot.name)?;
    reply.set_item("logs", paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>())?;
    reply.set_item("states", identification.states)?;
    reply.set_item("duration", identification.duration)?;
    reply.set_item("cutoff", found.cutoff)?;
    reply.set_item("held_out", found.held_out)?;
    reply.set_item("verdict", OfVerdict::of(identification, verdict))?;
    reply.set_item("joints", joints)?;
    reply.set_item("base_parameters", base_parameters)?;
    reply.set_item("friction", friction(identification))?;
    let delay = identification.delay.map(|(value, deviation)| Measured { value, deviation, unit: "s" });
    reply.set_item("delay", delay)?;
    reply.set_item("rows", identification.rows)?;
    reply.set_item("words", &found.words)?;
    reply.set_item("remarks", &found.remarks)?;
    reply.set_item("picture", &found.picture)?;
    // a model of which nothing is known is no file
    let text = identification.is_anything_excited().then(|| identification.robot_file(&found.words));
    reply.set_item("robot_file", text)?;
    Ok(reply)
}
