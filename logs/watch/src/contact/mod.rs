//! Finds contacts: external torques from the momentum observer that stay above a threshold for a minimum time (the
//! hold).

mod noise;
mod threshold;

use crate::{Settings, Signals, WatchError};

pub use noise::{ContactNoise, JointNoise};

/// A segment of a motion in which something touches the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// The joint, counted from 0.
    pub joint: usize,
    /// The time at which it begins, s.
    pub start: f64,
    /// The time at which it ends, s: the end of the motion if it lasts until then.
    pub end: f64,
    /// The largest external torque on the arm, N m or N, less the uncertainty of friction.
    pub peak: f64,
}

impl Contact {
    /// Joins contacts of the same joint that are closer than `gap`, s, and sorts them by their beginnings.
    #[must_use]
    pub fn joined(mut contacts: Vec<Self>, gap: f64) -> Vec<Self> {
        contacts.sort_by(|a, b| a.joint.cmp(&b.joint).then(a.start.total_cmp(&b.start)));
        let mut joined: Vec<Self> = Vec::with_capacity(contacts.len());
        for contact in contacts {
            match joined.last_mut() {
                Some(last) if last.joint == contact.joint && contact.start - last.end <= gap => {
                    last.end = last.end.max(contact.end);
                    last.peak = farther(last.peak, contact.peak);
                }
                _ => joined.push(contact),
            }
        }
        joined.sort_by(|a, b| a.start.total_cmp(&b.start).then(a.joint.cmp(&b.joint)));
        joined
    }
}

/// Finds the contacts in the signals of a motion.
///
/// # Errors
/// When the noise has another number of joints, or a setting is not above 0.
pub fn contacts(signals: &Signals, noise: &ContactNoise, settings: &Settings) -> Result<Vec<Contact>, WatchError> {
    settings.check()?;
    let dof = signals.dof();
    if noise.joints.len() != dof {
        return Err(WatchError::Joints { expected: dof, found: noise.joints.len() });
    }
    if noise.joints.iter().any(|noise| !(noise.deviation > 0.0 && noise.mean.is_finite())) {
        return Err(WatchError::Setting("the deviation of the observer"));
    }
    let (threshold, held) = threshold(signals, settings);
    let contacts = |(joint, noise)| of_joint(signals, joint, noise, threshold, held);
    let mut found: Vec<Contact> = noise.joints.iter().enumerate().flat_map(contacts).collect();
    found.sort_by(|a, b| a.start.total_cmp(&b.start).then(a.joint.cmp(&b.joint)));
    Ok(found)
}

/// Returns the threshold in standard deviations, and the number of samples of the hold.
fn threshold(signals: &Signals, settings: &Settings) -> (f64, usize) {
    let held = samples_in(settings.hold, signals.period);
    #[allow(clippy::cast_precision_loss)] // samples of a hold
    let hold = held as f64 * signals.period;
    (threshold::threshold(&Settings { hold, ..settings.clone() }, signals.dof()), held)
}

/// Returns for each joint and sample the largest torque that is no contact, N m or N, as a distance from the mean of
/// the noise in both directions.
#[must_use]
pub fn contact_limits(signals: &Signals, noise: &ContactNoise, settings: &Settings) -> Vec<Vec<f64>> {
    let (threshold, _) = threshold(signals, settings);
    noise.joints.iter().enumerate().map(|(joint, noise)| limits(signals, joint, noise, threshold)).collect()
}

fn limits(signals: &Signals, joint: usize, noise: &JointNoise, threshold: f64) -> Vec<f64> {
    let (terms, inertia) = (&signals.terms[joint], &signals.inertia[joint]);
    let at_sample = |(at, open): (usize, &f64)| threshold * noise.deviation_at(terms[at], inertia[at]) + open;
    signals.open[joint].iter().enumerate().map(at_sample).collect()
}

/// Returns the number of samples in a time, at least one.
fn samples_in(time: f64, period: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
    let samples = (time / period - 1e-9).ceil() as usize;
    samples.max(1)
}

/// Returns the contacts of a joint: from the first of `held` samples above the threshold until the torque is below half
/// of it.
fn of_joint(signals: &Signals, joint: usize, noise: &JointNoise, threshold: f64, held: usize) -> Vec<Contact> {
    let mut found = Vec::new();
    let limits = limits(signals, joint, noise, threshold);
    let mut open: Option<Contact> = None;
    let mut beyond = 0;
    // subtracts the uncertainty of friction, which may not be an external torque
    let sure = |at: usize| {
        let off = signals.external[joint][at] - noise.mean;
        off.signum() * (off.abs() - signals.open[joint][at]).max(0.0)
    };
    for (at, seen) in signals.external[joint].iter().enumerate() {
        let off = seen - noise.mean;
        if !signals.settled[at] {
            (beyond, open) = (
                0,
                open.and_then(|event| {
                    found.push(event);
                    None
                }),
            );
            continue;
        }
        let sign_stays = beyond == 0 || off * (signals.external[joint][at - 1] - noise.mean) > 0.0;
        let limit = limits[at];
        beyond = if off.abs() > limit { if sign_stays { beyond + 1 } else { 1 } } else { 0 };
        if let Some(event) = &mut open {
            event.peak = farther(event.peak, sure(at));
            event.end = signals.time[at];
            if off.abs() < 0.5 * limit {
                found.extend(open.take());
            }
        } else if beyond >= held {
            let first = at + 1 - held;
            let peak = (first..=at).map(sure).fold(0.0, farther);
            let (start, end) = (signals.time[first], signals.time[at]);
            open = Some(Contact { joint, start, end, peak });
        }
    }
    found.extend(open);
    found
}

/// Returns the number with the larger magnitude.
fn farther(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}
