//! Events with their causes.

use rne_logs::UtcTime;
use rne_model::{JointKind, Robot};

use crate::Candidate;

/// The cause of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// The friction of a joint has changed: wear, a brake, cold or lost grease.
    Friction,
    /// The arm carries an additional mass, or lost one.
    Payload,
    /// Something touched the arm for some time, such as an obstacle or a hand.
    Contact,
    /// The effort of a joint has an offset or another gain, or all efforts have another delay, because of a sensor, a
    /// spring, a brake or another recorder.
    Sensor,
    /// The error of the model has grown, and no single parameter explains it.
    Model,
}

impl Cause {
    /// The name of the cause.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Payload => "payload",
            Self::Contact => "contact",
            Self::Sensor => "sensor",
            Self::Model => "model",
        }
    }

    /// Returns the cause of a change of this parameter.
    #[must_use]
    pub const fn of(candidate: Candidate) -> Self {
        match candidate {
            Candidate::Coulomb(_) | Candidate::Viscous(_) => Self::Friction,
            Candidate::Offset(_) | Candidate::Gain(_) | Candidate::Delay => Self::Sensor,
            Candidate::Payload => Self::Payload,
        }
    }
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// Something that has changed, or has happened, with its cause.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// The cause that explains most.
    pub cause: Cause,
    /// The joint, counted from 0; `None` for a payload and the delay.
    pub joint: Option<usize>,
    /// The parameter: `coulomb`, `viscous`, `offset`, `gain`, `delay`, `mass`, `external` (the largest external
    /// torque), `residual` (the root mean square of the model's residual), `frozen` (the value that an effort repeats),
    /// `frozen_position` (the value that a position repeats) or `exchanged` (the efforts of `joint` and of the joint in
    /// `others`; it has no value).
    pub parameter: &'static str,
    /// The value in the log, in `unit`.
    pub value: f64,
    /// The value in the robot file, in `unit`; for a residual, the value of the baseline.
    pub file_value: f64,
    /// The value of the baseline, in `unit`.
    pub baseline_value: f64,
    /// Standard deviation of the value; NaN for residuals.
    pub deviation: f64,
    /// Half the width of the 95 % confidence interval; NaN for contacts and residuals.
    pub half_interval: f64,
    /// The smallest change that would be an event; NaN for contacts.
    pub threshold: f64,
    /// The unit of all values.
    pub unit: &'static str,
    /// The number of the run in which the event begins, from 0.
    pub run: u64,
    /// The time at which the event begins, s.
    pub since: f64,
    /// The time at which the event ends, s.
    pub until: f64,
    /// Whether the event lasts from the beginning of the log to its end.
    pub is_whole: bool,
    /// Whether the event lasts until the end of the log.
    pub lasts: bool,
    /// The date at which the event begins; that of the beginning of the log if the event lasts over the whole log.
    /// `None` if the times of the log do not count from 1970.
    pub since_time: Option<UtcTime>,
    /// The date at which the event ends; that of the end of the log if the event lasts until then.
    pub until_time: Option<UtcTime>,
    /// For a change over the whole log: the end of the quiet logs, if they end before the log begins. The change began
    /// after this date.
    pub not_before: Option<UtcTime>,
    /// For a change over the whole log: the beginning of the quiet logs, if they begin after the log ends. The change
    /// ended before this date.
    pub not_after: Option<UtcTime>,
    /// Further joints of the same event, counted from 0.
    pub others: Vec<usize>,
    /// Further friction parameters of the joint, each of which would explain the change almost as well: `coulomb` or
    /// `viscous`.
    pub rivals: Vec<&'static str>,
}

impl Event {
    /// Makes an event with a cause only: values and times are 0, deviations are NaN.
    pub(crate) fn blank(cause: Cause) -> Self {
        Self {
            cause,
            joint: None,
            parameter: "external",
            value: 0.0,
            file_value: 0.0,
            baseline_value: 0.0,
            deviation: f64::NAN,
            half_interval: f64::NAN,
            threshold: f64::NAN,
            unit: "N m",
            run: 0,
            since: 0.0,
            until: 0.0,
            is_whole: false,
            lasts: false,
            since_time: None,
            until_time: None,
            not_before: None,
            not_after: None,
            others: Vec::new(),
            rivals: Vec::new(),
        }
    }

    /// Returns the change of the value against the baseline.
    #[must_use]
    pub fn change(&self) -> f64 {
        self.value - self.baseline_value
    }
}

/// Returns the unit of a candidate's value.
#[must_use]
pub fn unit(robot: &Robot, candidate: Candidate) -> &'static str {
    let kind = candidate.joint().and_then(|joint| robot.independent_joint(joint)).map(|joint| joint.row.kind);
    match (candidate, kind) {
        (Candidate::Payload, _) => "kg",
        (Candidate::Gain(_), _) => "1",
        (Candidate::Delay, _) => "s",
        (Candidate::Viscous(_), Some(JointKind::Prismatic)) => "N s/m",
        (Candidate::Viscous(_), _) => "N m s/rad",
        (_, Some(kind)) => kind.effort_unit(),
        (_, None) => "N m",
    }
}
