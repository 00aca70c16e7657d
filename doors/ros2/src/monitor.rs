//! Computes torques from messages with joint states.
//!
//! ```text
//! gravity torques    g(q), what the actuators deliver to hold the arm still
//! external torques   the momentum observer of (effort - friction), with the rotors; it needs no accelerations
//! ```

use std::collections::HashMap;

use rne_identify::{JointMatch, Mismatch, match_joints};
use rne_machine::{CompiledArm, EvaluationError};
use rne_model::Friction;
use rne_runtime::DynObserverState;

use crate::diagnosis::{Report, Source};
use crate::fault::{Fault, Lacking, listed};
use crate::messages::{DiagnosticArray, JointState, Time};

/// Settings of a monitor.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The names that the joints have in the messages, base to tip. If it is `None`, [`match_joints`] decides as for
    /// logs: by the names in the robot file, or by the order in a message that has as many joints with other names.
    pub joints: Option<Vec<String>>,
    /// The low-pass of the observer, Hz.
    pub gain: f64,
    /// A message whose stamp differs more than this from the clock is not used, s; 0: any stamp.
    pub stale_after: f64,
    /// The longest time between two stamps, s; after a longer one the observer starts anew.
    pub gap: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { joints: None, gain: 20.0, stale_after: 0.5, gap: 0.05 }
    }
}

/// The torques that belong to one message: joint states with efforts only, with the header and the joint names of the
/// message, base to tip. N m, or N for a prismatic joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Torques {
    /// The torques of the actuators that hold the arm at rest in this position.
    pub gravity: JointState,
    /// The torques of the environment on the arm, positive along the joint.
    pub external: Result<JointState, Lacking>,
}

/// An arm with its observer and its diagnostics.
#[derive(Debug)]
pub struct Monitor {
    arm: CompiledArm,
    settings: Settings,
    /// The names that messages must have, base to tip.
    joints: Vec<String>,
    /// Whether a message with all joints has arrived, and whether the joints are matched by its order and not by names.
    is_matched: bool,
    is_by_order: bool,
    /// The names in the last message, and the index of each joint among them.
    places: (Vec<String>, Result<Vec<usize>, Fault>),
    observer: DynObserverState<f64>,
    friction: Vec<Friction>,
    /// The stamps of the last message that was used, and of the last one that the observer used, ns.
    last: Option<i64>,
    observed: Option<i64>,
    report: Report,
}

impl Monitor {
    /// Creates a monitor for an arm.
    ///
    /// # Errors
    /// When a setting is no possible value, when a function of the arm cannot be compiled, or when the settings have
    /// another number of joints than the arm.
    pub fn new(arm: CompiledArm, settings: Settings) -> Result<Self, String> {
        for (name, value, is_possible) in [
            ("gain", settings.gain, settings.gain > 0.0),
            ("gap", settings.gap, settings.gap > 0.0),
            ("stale-after", settings.stale_after, settings.stale_after >= 0.0),
        ] {
            if !(value.is_finite() && is_possible) {
                let least = if name == "stale-after" { "0 or more" } else { "above 0" };
                return Err(format!("--{name} is {value}; it must be a number {least}"));
            }
        }
        let robot = arm.robot();
        let of_robot = names_of(&arm);
        if let Some(joints) = &settings.joints {
            if joints.len() != of_robot.len() {
                return Err(format!(
                    "--joints has {} names, but {} has {} joints: {}",
                    joints.len(),
                    robot.name,
                    of_robot.len(),
                    listed(&of_robot)
                ));
            }
            if let Some(twice) = (1..joints.len()).find(|&at| joints[..at].contains(&joints[at])) {
                return Err(format!("--joints names {} twice", joints[twice]));
            }
        }
        // compiled now, so that the first message does not wait for it
        let zeros = vec![0.0; arm.dof()];
        let compiled = arm.gravity_torques(&zeros).and_then(|_| arm.momentum_and_rate(&zeros, &zeros, &zeros));
        compiled.map_err(|error| error.to_string())?;
        Ok(Self {
            joints: settings.joints.clone().unwrap_or(of_robot),
            is_matched: false,
            is_by_order: false,
            places: (Vec::new(), Err(Fault::Foreign)),
            observer: DynObserverState::new(arm.dof(), settings.gain, 0.0),
            friction: arm.robot().independent_joints().map(Friction::of).collect(),
            last: None,
            observed: None,
            report: Report::default(),
            arm,
            settings,
        })
    }

    /// Returns the torques for a message that arrives at the time `now`. Every fault is counted for the diagnostics.
    ///
    /// # Errors
    /// When the message is not used.
    pub fn update(&mut self, message: &JointState, now: Time) -> Result<Torques, Fault> {
        self.report.received(now);
        let torques = self.torques(message, now);
        match &torques {
            Ok(torques) => self.report.used(torques),
            Err(fault) => self.report.rejected(fault),
        }
        torques
    }

    /// Counts messages that DDS lost before this one.
    pub fn lost(&mut self, messages: u64) {
        self.report.lost(messages);
    }

    /// Counts a message that cannot be decoded or published, with the reason.
    pub fn failed(&mut self, key: &'static str, why: String) {
        self.report.failed(key, why);
    }

    /// Returns the diagnostics of the time since the last call.
    pub fn diagnostics(&mut self, now: Time, source: &Source<'_>) -> DiagnosticArray {
        let robot = self.arm.robot();
        let of_robot = names_of(&self.arm);
        let matched = if self.joints == of_robot {
            listed(&self.joints)
        } else {
            let pairs: Vec<String> = self.joints.iter().zip(&of_robot).map(|(a, b)| format!("{a} = {b}")).collect();
            listed(&pairs)
        };
        self.report.written(now, source, &robot.name, &matched, self.is_by_order)
    }

    fn torques(&mut self, message: &JointState, now: Time) -> Result<Torques, Fault> {
        let (names, numbers) = (message.name.len(), message.position.len());
        let places = self.places(&message.name)?;
        if names != numbers {
            return Err(Fault::Positions { names, positions: numbers });
        }
        let stamp = self.stamp(message, now)?;
        let taken = |list: &[f64]| -> Vec<f64> { places.iter().map(|&place| list[place]).collect() };
        let q = taken(&message.position);
        if let Some(joint) = q.iter().position(|q| !q.is_finite()) {
            return Err(Fault::Position { joint: self.joints[joint].clone(), value: q[joint] });
        }
        let gravity = finite(self.arm.gravity_torques(&q)).map_err(Fault::Torques)?;
        self.last = Some(stamp);
        let answer = |effort| JointState {
            header: message.header.clone(),
            name: self.joints.clone(),
            effort,
            ..JointState::default()
        };
        let gravity = answer(gravity);
        let external = self.measured(message, &places).and_then(|[qd, effort]| self.external(stamp, &q, &qd, &effort));
        if external.as_ref().is_err_and(|lacking| *lacking != Lacking::First) {
            self.begin();
        }
        let external = external.map(|effort| JointState { effort, ..gravity.clone() });
        Ok(Torques { gravity, external })
    }

    /// Returns the index of each joint of the arm among the names of a message.
    fn places(&mut self, names: &[String]) -> Result<Vec<usize>, Fault> {
        if self.places.0 != names {
            self.places = (names.to_vec(), self.matched(names));
        }
        self.places.1.clone()
    }

    /// Finds the index of each joint among the names of a message, by the rule that also holds for logs.
    fn matched(&mut self, names: &[String]) -> Result<Vec<usize>, Fault> {
        let mut places: HashMap<&str, usize> = HashMap::with_capacity(names.len());
        for (place, name) in names.iter().enumerate() {
            places.entry(name).or_insert(place);
        }
        // if a later message has the names in the robot file, these replace the match by order
        if self.is_by_order {
            let of_robot = names_of(&self.arm);
            if match_joints(&of_robot, names) == Ok(JointMatch::ByName) {
                (self.joints, self.is_by_order) = (of_robot, false);
                self.begin();
            }
        }
        // names that were given, or found in an earlier message, are not matched by order again
        let is_known = self.settings.joints.is_some() || self.is_matched;
        match match_joints(&self.joints, names) {
            Ok(JointMatch::ByName) => {}
            Ok(JointMatch::ByOrder) if !is_known && places.len() == names.len() => {
                (self.joints, self.is_by_order) = (names.to_vec(), true);
            }
            rule => {
                let has_some = self.joints.iter().any(|joint| places.contains_key(joint.as_str()));
                return Err(match rule {
                    _ if names.is_empty() || is_known && !has_some => Fault::Foreign,
                    Err(mismatch) if !is_known && (!has_some || matches!(mismatch, Mismatch::Order { .. })) => {
                        Fault::Unmatched { measured: names.to_vec(), joints: self.joints.clone(), mismatch }
                    }
                    _ => {
                        let is_missing = |joint: &&String| !places.contains_key(joint.as_str());
                        Fault::Incomplete { joint: self.joints.iter().find(is_missing).cloned().unwrap_or_default() }
                    }
                });
            }
        }
        self.is_matched = true;
        Ok(self.joints.iter().filter_map(|joint| places.get(joint.as_str()).copied()).collect())
    }

    /// Returns the stamp of a message, ns, if it is later than the last one.
    fn stamp(&mut self, message: &JointState, now: Time) -> Result<i64, Fault> {
        let stamp = message.header.stamp.nanoseconds();
        if stamp == 0 {
            return Err(Fault::NoStamp);
        }
        let (age, limit) = (seconds(stamp, now.nanoseconds()), self.settings.stale_after);
        if limit > 0.0 && age.abs() > limit {
            return Err(Fault::Stale { age, limit });
        }
        let by = self.last.map_or(f64::NEG_INFINITY, |last| seconds(stamp, last));
        // a simulation or a bag that restarts goes back further than messages that overtake each other
        if by >= 0.0 && by <= self.settings.gap {
            return Err(Fault::NotLater { by });
        }
        Ok(stamp)
    }

    /// Returns the velocities and the efforts of the joints of the arm.
    fn measured(&self, message: &JointState, places: &[usize]) -> Result<[Vec<f64>; 2], Lacking> {
        let names = message.name.len();
        let of = |list: &[f64], what, one| {
            if list.is_empty() {
                return Err(Lacking::Missing { what });
            }
            if list.len() != names {
                return Err(Lacking::Length { what, names, found: list.len() });
            }
            let taken: Vec<f64> = places.iter().map(|&place| list[place]).collect();
            match taken.iter().position(|number| !number.is_finite()) {
                Some(joint) => {
                    Err(Lacking::Number { what: one, joint: self.joints[joint].clone(), value: taken[joint] })
                }
                None => Ok(taken),
            }
        };
        Ok([of(&message.velocity, "velocities", "velocity")?, of(&message.effort, "efforts", "effort")?])
    }

    /// Updates the observer with a message and returns the external torques.
    fn external(&mut self, stamp: i64, q: &[f64], qd: &[f64], effort: &[f64]) -> Result<Vec<f64>, Lacking> {
        let period = self.observed.map(|last| seconds(last, stamp));
        let period = period.filter(|period| *period > 0.0 && *period <= self.settings.gap);
        if period.is_none() {
            self.begin();
        }
        let states = q.iter().zip(qd).zip(effort);
        let friction = self.friction.iter_mut().zip(states);
        let tau: Vec<f64> = friction.map(|(friction, ((q, qd), effort))| effort - friction.next(*q, *qd)).collect();
        let now = self.arm.momentum_and_rate(q, qd, &tau).map_err(|error| Lacking::Torques(error.to_string()))?;
        let seen = self.observer.advance(period.unwrap_or(0.0), now.momentum, now.rate);
        let seen = seen.map_err(|error| Lacking::Torques(error.to_string()))?;
        self.observed = Some(stamp);
        if period.is_none() {
            return Err(Lacking::First);
        }
        finite(Ok(seen)).map_err(Lacking::Torques)
    }

    /// Resets the observer, which starts anew with the next complete message.
    fn begin(&mut self) {
        self.observer.reset();
        self.friction = self.arm.robot().independent_joints().map(Friction::of).collect();
        self.observed = None;
    }
}

/// Returns the time from one stamp to another, both in ns, in s.
#[allow(clippy::cast_precision_loss)] // nanoseconds of long times do not matter
fn seconds(from: i64, to: i64) -> f64 {
    to.saturating_sub(from) as f64 * 1e-9
}

/// Returns the names of the joints in the robot file, base to tip.
fn names_of(arm: &CompiledArm) -> Vec<String> {
    arm.robot().independent_joints().map(|joint| joint.name.clone()).collect()
}

/// Returns the torques if all of them are finite, otherwise an error.
fn finite(torques: Result<Vec<f64>, EvaluationError>) -> Result<Vec<f64>, String> {
    let torques = torques.map_err(|error| error.to_string())?;
    match torques.iter().position(|torque| !torque.is_finite()) {
        Some(joint) => Err(format!("the torque of joint {} is {}", joint + 1, torques[joint])),
        None => Ok(torques),
    }
}
