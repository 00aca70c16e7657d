//! The diagnostics of the node: messages that arrived, and messages that were rejected with the reasons.

use std::collections::BTreeMap;

use crate::fault::{Fault, Lacking};
use crate::messages::{DiagnosticArray, DiagnosticStatus, ERROR, Header, KeyValue, OK, STALE, Time, WARN};
use crate::monitor::Torques;

/// Where the joint states come from.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The name of the node, with which the names of its parts begin.
    pub node: &'a str,
    /// The topic of the joint states.
    pub topic: &'a str,
    /// The number of publishers of this topic that the node is connected with.
    pub publishers: usize,
}

/// Counts since the node started, and events since the last diagnostics.
#[derive(Debug, Default)]
pub(crate) struct Report {
    counts: BTreeMap<&'static str, u64>,
    last_received: Option<Time>,
    recent: Recent,
}

/// Counts of events since the last diagnostics.
#[derive(Debug, Default)]
struct Recent {
    received: u64,
    foreign: u64,
    used: u64,
    external: u64,
    begun: u64,
    lost: u64,
    fault: Option<String>,
    lacking: Option<String>,
    failure: Option<String>,
    largest: f64,
}

const RECEIVED: &str = "received";
const USED: &str = "used";
const LOST: &str = "lost";
const EXTERNAL: &str = "computed";

impl Report {
    pub(crate) fn received(&mut self, now: Time) {
        self.count(RECEIVED, 1);
        self.recent.received += 1;
        self.last_received = Some(now);
    }

    pub(crate) fn used(&mut self, torques: &Torques) {
        self.count(USED, 1);
        self.recent.used += 1;
        match &torques.external {
            Ok(external) => {
                self.count(EXTERNAL, 1);
                self.recent.external += 1;
                let largest = |largest: f64, torque: &f64| largest.max(torque.abs());
                self.recent.largest = external.effort.iter().fold(self.recent.largest, largest);
            }
            Err(lacking) => {
                self.count(lacking.key(), 1);
                if *lacking != Lacking::First {
                    self.recent.lacking = Some(lacking.to_string());
                } else if self.counts[lacking.key()] > 1 {
                    self.recent.begun += 1;
                }
            }
        }
    }

    pub(crate) fn rejected(&mut self, fault: &Fault) {
        self.count(fault.key(), 1);
        if *fault == Fault::Foreign {
            self.recent.foreign += 1;
        } else {
            self.recent.fault = Some(fault.to_string());
        }
    }

    pub(crate) fn lost(&mut self, messages: u64) {
        self.count(LOST, messages);
        self.recent.lost += messages;
    }

    pub(crate) fn failed(&mut self, key: &'static str, why: String) {
        self.count(key, 1);
        self.recent.failure = Some(why);
    }

    fn count(&mut self, key: &'static str, by: u64) {
        *self.counts.entry(key).or_default() += by;
    }

    /// Returns the diagnostics, and resets the events for the next ones.
    pub(crate) fn written(
        &mut self,
        now: Time,
        source: &Source<'_>,
        robot: &str,
        joints: &str,
        is_by_order: bool,
    ) -> DiagnosticArray {
        let (states, external) = (self.joint_states(now, source, is_by_order), self.external_torques());
        let is_of_external = |key: &str| {
            [EXTERNAL, "beginnings of the observer", "without velocities", "without efforts"].contains(&key)
                || ["wrong number of velocities or efforts", "velocity or effort not finite"].contains(&key)
                || key == "external torques not finite"
        };
        let value = |key: &str, value: String| KeyValue { key: key.to_owned(), value };
        let mut values = [Vec::new(), Vec::new()];
        for (key, count) in &self.counts {
            values[usize::from(is_of_external(key))].push(value(key, count.to_string()));
        }
        let [mut of_states, mut of_external] = values;
        of_states.push(value("topic", source.topic.to_owned()));
        of_states.push(value("publishers", source.publishers.to_string()));
        of_states.push(value("joints, base to tip", joints.to_owned()));
        of_external.push(value("largest since the last diagnostics (N m or N)", self.recent.largest.to_string()));
        let status = |part: &str, (level, message), values| DiagnosticStatus {
            level,
            name: format!("{}: {part}", source.node),
            message,
            hardware_id: robot.to_owned(),
            values,
        };
        let status = vec![status("joint states", states, of_states), status("external torques", external, of_external)];
        self.recent = Recent::default();
        DiagnosticArray { header: Header { stamp: now, frame_id: String::new() }, status }
    }

    fn joint_states(&self, now: Time, source: &Source<'_>, is_by_order: bool) -> (u8, String) {
        let recent = &self.recent;
        if recent.received == 0 {
            let since = match self.last_received {
                Some(last) => {
                    let age = now.nanoseconds().saturating_sub(last.nanoseconds()) / 1_000_000;
                    format!("no message on {} for {}.{:03} s", source.topic, age / 1000, (age % 1000).abs())
                }
                None => format!("no message on {} since the node began", source.topic),
            };
            let why = match &recent.failure {
                Some(why) => why.as_str(),
                None if source.publishers == 0 => {
                    "no publisher is connected: is one there, in the same domain, and is it reliable or \
                     is the node started with --best-effort?"
                }
                None => "a publisher is connected and sends nothing",
            };
            return (STALE, format!("{since}; {why}"));
        }
        let (rejected, of_arm) = (recent.received - recent.used - recent.foreign, recent.received - recent.foreign);
        if of_arm == 0 {
            return (STALE, format!("no message on {} has a joint of the arm", source.topic));
        }
        if let Some(fault) = &recent.fault {
            let level = if recent.used == 0 { ERROR } else { WARN };
            return (level, format!("{rejected} of {of_arm} messages are not used; the last one: {fault}"));
        }
        if let Some(failure) = &recent.failure {
            return (WARN, failure.clone());
        }
        if recent.lost > 0 {
            return (WARN, format!("{} messages were lost before the node", recent.lost));
        }
        if is_by_order {
            let message = "the messages have other names than the robot file, so their joints are taken in their \
                           order; name them, base to tip, by --joints";
            return (WARN, message.to_owned());
        }
        (OK, format!("{} messages are used", recent.used))
    }

    fn external_torques(&self) -> (u8, String) {
        let recent = &self.recent;
        if recent.used == 0 {
            return (STALE, "no message to compute external torques from".to_owned());
        }
        if let Some(lacking) = &recent.lacking {
            let without = recent.used - recent.external;
            return (WARN, format!("{without} of {} messages give no external torques: {lacking}", recent.used));
        }
        if recent.begun > 0 {
            let message = format!(
                "the observer began anew {} times, because the time between two stamps is longer than --gap or \
                 something was missing before",
                recent.begun
            );
            return (WARN, message);
        }
        (OK, format!("external torques of {} messages", recent.external))
    }
}
