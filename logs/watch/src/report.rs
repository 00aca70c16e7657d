//! Watches the logs of an arm: finds changes of its parameters first, then contacts in the remaining torques.

use rne_identify::{ArmLog, Part, Stretches, Structure};
use rne_logs::{FrozenPosition, Motion};
use rne_model::{JointKind, Robot};

use crate::contact::{Contact, ContactNoise, contacts};
use crate::dates::Dates;
use crate::event::{Cause, Event, unit};
use crate::sensor::exchanged_efforts;
use crate::{Baseline, Candidate, Changes, Settings, Signals, WatchError};

/// Time below which two contacts are joined, s, such as those on both sides of the border of two pieces.
const JOINED: f64 = 0.25;

/// Smallest number of rows of each joint with which a log can be compared.
const FEWEST: u64 = 2;

/// Number of states in a picture.
const DRAWN: u64 = 20_000;

/// Factors by which a model is worse on motions other than that of its identification: for the noise of the observer,
/// and for the error of the model's terms, which may have any sign there.
const ELSEWHERE: [f64; 2] = [1.5, 2.0];

/// The result for a log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// Events, one for each cause: changes of parameters, the one that explains most first, then contacts by time.
    pub events: Vec<Event>,
    /// The comparison of all parameters with the baseline.
    pub changes: Changes,
    /// The noise of the observer from which the thresholds of contacts follow.
    pub contact: ContactNoise,
    /// The signals of the log for a picture, with only some of the samples.
    pub signals: Option<Signals>,
    /// The torques that changed parameters add, for each joint at the samples of `signals`, N m or N.
    pub explained: Vec<Vec<f64>>,
    /// Whether the picture ends early, because the times of the log go back there.
    pub is_cut: bool,
}

impl Baseline {
    /// Makes the baseline from quiet logs, which are opened with [`Purpose::Watch`](rne_identify::Purpose::Watch).
    ///
    /// # Errors
    /// When the logs are too short, do not fit the robot, or cannot be read.
    pub fn of_logs(
        robot: &Robot,
        quiet: &ArmLog,
        settings: &Settings,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, WatchError> {
        let structure = Self::structure(robot, quiet.cutoff());
        let mut baseline = Self::of_parameters(&structure, quiet, progress)?;
        let all = noise(robot, quiet, settings, progress, &|_, _| Ok(Vec::new()))?;
        let mut contact = ContactNoise::covering(&all).ok_or(WatchError::TooFew { found: 0, needed: 1 })?;
        each_signals(robot, quiet, settings, progress, &|_, _| Ok(Vec::new()), &mut |_, signals, _| {
            contact = std::mem::take(&mut contact).silent(&signals, settings)?;
            Ok(())
        })?;
        baseline.contact = Some(contact.widened(ELSEWHERE[0], ELSEWHERE[1]));
        Ok(baseline)
    }

    /// Makes a baseline from a log itself and the robot file, for an arm without a quiet log.
    ///
    /// # Errors
    /// When the log is too short, does not fit the robot, or cannot be read.
    pub fn of_file(robot: &Robot, log: &ArmLog, progress: &mut dyn FnMut(f64)) -> Result<Self, WatchError> {
        let structure = Self::structure(robot, log.cutoff());
        Ok(Self::of_parameters(&structure, log, progress)?.against_file(&structure))
    }

    /// Makes a baseline from logs for changes of parameters only, without the noise of the momentum observer.
    ///
    /// # Errors
    /// When the logs are too short, do not fit the robot, or cannot be read.
    pub fn of_parameters(
        structure: &Structure,
        log: &ArmLog,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, WatchError> {
        let judged = log.judged(progress).map_err(WatchError::Log)?;
        let mut baseline =
            Self::of::<WatchError>(structure, |take| Ok(judged.pass_runs(Part::All, take, progress)?))?;
        baseline.check(structure)?;
        baseline.span = log.span();
        Ok(baseline)
    }
}

/// Finds events in logs of a robot, which are opened with [`Purpose::Watch`](rne_identify::Purpose::Watch) and the
/// cut-off of the baseline. `is_drawn` keeps the data for a picture; `progress` is called with the fraction of each
/// pass that was read.
///
/// # Errors
/// When the logs are too short, do not fit the robot, or cannot be read.
pub fn watch(
    robot: &Robot,
    baseline: &Baseline,
    log: &ArmLog,
    settings: &Settings,
    is_drawn: bool,
    progress: &mut dyn FnMut(f64),
) -> Result<Report, WatchError> {
    settings.check()?;
    let structure = Baseline::structure(robot, baseline.cutoff);
    let changes = changes(&structure, baseline, log, progress)?;
    let explain = |run: u64, motion: &Motion| {
        let mut added = changes.torques(&structure, baseline, run, motion)?;
        if let Some([first, second]) = changes.exchanged {
            for (at, (one, other)) in motion.tau[first].iter().zip(&motion.tau[second]).enumerate() {
                added[first][at] += one - other;
                added[second][at] += other - one;
            }
        }
        Ok(added)
    };
    let contact = match &baseline.contact {
        Some(contact) => contact.clone(),
        None => ContactNoise::typical(&noise(robot, log, settings, progress, &explain)?)
            .ok_or(WatchError::TooFew { found: 0, needed: 1 })?,
    };
    let mut found: Vec<(u64, Vec<Contact>)> = Vec::new();
    let mut drawn = Drawn::new(robot.dof(), log.states());
    each_signals(robot, log, settings, progress, &explain, &mut |run, piece, added| {
        let mut contacts = contacts(&piece, &contact, settings)?;
        contacts.retain(|contact| !changes.is_frozen(contact.joint, run, contact.start..contact.end));
        match found.last_mut() {
            Some((last, of_run)) if *last == run => of_run.extend(contacts),
            _ => found.push((run, contacts)),
        }
        if is_drawn {
            drawn.push(&piece, added);
        }
        Ok(())
    })?;
    let mut events = changes.events.clone();
    for (run, of_run) in found {
        events.extend(touches(robot, &contact, run, Contact::joined(of_run, JOINED)));
    }
    let frozen: Vec<Event> = log.survey().frozen_positions.iter().map(|frozen| of_position(robot, frozen)).collect();
    if !frozen.is_empty() {
        // with a wrong position, all predicted torques are wrong, so only this event is reported
        events = frozen;
    }
    Dates::of(log, baseline.span).give(&mut events);
    let Drawn { signals, explained, is_cut, .. } = drawn;
    Ok(Report { events: one_cause(&events), changes, contact, signals, explained, is_cut })
}

/// The signals for a picture, for some of the states.
struct Drawn {
    /// One of this number of states is drawn.
    stride: usize,
    signals: Option<Signals>,
    /// The torques of each joint that changes already explain, N m or N.
    explained: Vec<Vec<f64>>,
    /// Whether the times go back, so that the rest is not drawn.
    is_cut: bool,
}

impl Drawn {
    fn new(dof: usize, states: u64) -> Self {
        let stride = usize::try_from(states.div_ceil(DRAWN)).unwrap_or(usize::MAX).max(1);
        Self { stride, signals: None, explained: vec![Vec::new(); dof], is_cut: false }
    }

    fn push(&mut self, piece: &Signals, added: &[Vec<f64>]) {
        if self.is_cut {
            return;
        }
        let thin = piece.thinned(self.stride);
        self.is_cut = self.signals.as_ref().is_some_and(|all| all.time.last() >= thin.time.first());
        if !self.is_cut {
            let columns = self.explained.iter_mut().zip(added);
            columns.for_each(|(all, added)| all.extend(added.iter().step_by(self.stride)));
            match &mut self.signals {
                Some(all) => all.append(thin),
                None => self.signals = Some(thin),
            }
        }
    }
}

/// Makes the event of a position that keeps one value while its joint moves.
fn of_position(robot: &Robot, frozen: &FrozenPosition) -> Event {
    let [since, until] = frozen.times;
    Event {
        joint: Some(frozen.joint),
        parameter: "frozen_position",
        value: frozen.value,
        unit: if robot.coordinate_kind(frozen.joint) == JointKind::Revolute { "rad" } else { "m" },
        run: frozen.run,
        since,
        until,
        is_whole: frozen.is_whole,
        ..Event::blank(Cause::Sensor)
    }
}

/// Number of contacts of one joint that is too large for a person or an obstacle, so that they count as an error of the
/// model.
const MANY: usize = 6;

/// Time around the beginning or end of a change within the log in which a remaining torque is no contact, s.
const EDGE: f64 = 1.0;

/// Removes events that are effects of another event, so that each cause has one event. A contact also increases the
/// error of the model. Six contacts are an error of the model. A change that begins or ends within the log leaves a
/// short torque there.
fn one_cause(events: &[Event]) -> Vec<Event> {
    let is_of = |event: &Event, cause: Cause, joint: usize| {
        event.cause == cause && (event.joint == Some(joint) || event.others.contains(&joint))
    };
    let contacts = |joint: usize| events.iter().filter(|event| is_of(event, Cause::Contact, joint)).count();
    let has_grown = |joint: usize| events.iter().any(|event| is_of(event, Cause::Model, joint));
    let is_edge = |change: &Event, contact: &Event| {
        let is_change = !matches!(change.cause, Cause::Contact | Cause::Model) && change.run == contact.run;
        let is_near = |time: f64| contact.since < time + EDGE && contact.until > time - EDGE;
        let is_short = contact.until - contact.since < 2.0 * EDGE;
        is_change && !change.is_whole && is_short && (is_near(change.since) || (!change.lasts && is_near(change.until)))
    };
    let is_kept = |event: &&Event| match (event.cause, event.joint) {
        (Cause::Model, Some(joint)) => contacts(joint) == 0 || contacts(joint) >= MANY,
        (Cause::Contact, _) if events.iter().any(|change| is_edge(change, event)) => false,
        (Cause::Contact, Some(joint)) => contacts(joint) < MANY || !has_grown(joint),
        _ => true,
    };
    events.iter().filter(is_kept).cloned().collect()
}

/// Compares the parameters of an arm in logs with a baseline, without searching for contacts.
///
/// # Errors
/// When the logs are too short, do not fit the robot, or cannot be read.
pub fn changes(
    structure: &Structure,
    baseline: &Baseline,
    log: &ArmLog,
    progress: &mut dyn FnMut(f64),
) -> Result<Changes, WatchError> {
    let judged = log.judged(progress).map_err(WatchError::Log)?;
    let mut stretches = Stretches::new(structure, &baseline.model);
    judged.pass_runs(Part::All, &mut |run, motion| stretches.absorb(structure, run, motion), progress)?;
    let exchanged = exchanged_efforts(structure, baseline, &stretches, |[first, second]| {
        let mut stretches = Stretches::new(structure, &baseline.model);
        let mut absorb = |run: u64, motion: &Motion| {
            let mut motion = motion.clone();
            motion.tau.swap(first, second);
            stretches.absorb(structure, run, &motion)
        };
        judged.pass_runs(Part::All, &mut absorb, progress)?;
        Ok::<_, WatchError>(stretches)
    })?;
    let is_silent = |joint: usize| stretches.list().iter().all(|stretch| stretch.is_silent(joint));
    if stretches.rows() > 0 && (0..structure.dof()).all(is_silent) {
        return Err(WatchError::NoEffort);
    }
    if stretches.rows() >= FEWEST
        && let Some(mut found) = match &exchanged {
            Some((joints, exchanged)) => Changes::of_exchanged(structure, baseline, exchanged, *joints),
            None => Changes::of(structure, baseline, &stretches),
        }
    {
        Dates::of(log, baseline.span).give(&mut found.events);
        return Ok(found);
    }
    let duration: f64 = log.survey().runs.iter().map(|run| run.duration).sum();
    #[allow(clippy::cast_precision_loss)] // two at most
    let more = FEWEST.saturating_sub(stretches.rows()).max(1) as f64 * baseline.row();
    Err(WatchError::ShortLog { duration, needed: duration + more, cutoff: baseline.cutoff })
}

/// Returns for each joint the torques of a run's motion that are explained already, N m or N; empty without such
/// torques.
type Explain<'a> = &'a dyn Fn(u64, &Motion) -> Result<Vec<Vec<f64>>, WatchError>;

/// Receives the signals of a piece of a run, with the torques that are explained already.
type Take<'a> = &'a mut dyn FnMut(u64, Signals, &[Vec<f64>]) -> Result<(), WatchError>;

/// Estimates the noise of each piece of a log that is long enough.
fn noise(
    robot: &Robot,
    log: &ArmLog,
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
    explain: Explain<'_>,
) -> Result<Vec<ContactNoise>, WatchError> {
    let mut all = Vec::new();
    each_signals(robot, log, settings, progress, explain, &mut |_, signals, _| {
        all.push(ContactNoise::of(&signals, 0..signals.time.len())?);
        Ok(())
    })?;
    Ok(all)
}

/// Passes the signals of each piece of a log that is long enough to `take`, less the torques that are explained
/// already.
fn each_signals(
    robot: &Robot,
    log: &ArmLog,
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
    explain: Explain<'_>,
    take: Take<'_>,
) -> Result<(), WatchError> {
    let mut pieces = 0;
    let unless_short = |found: Result<(), WatchError>| match found {
        Err(WatchError::TooFew { .. }) => Ok(false),
        other => other.map(|()| true),
    };
    let mut take_motion = |run: u64, motion: &Motion| -> Result<(), WatchError> {
        let added = explain(run, motion)?;
        let mut rest = motion.clone();
        for (tau, added) in rest.tau.iter_mut().zip(&added) {
            tau.iter_mut().zip(added).for_each(|(tau, added)| *tau -= added);
        }
        let taken = Signals::new(robot, &rest, settings.gain).and_then(|signals| take(run, signals, &added));
        pieces += u64::from(unless_short(taken)?);
        Ok(())
    };
    log.pass_runs(Part::All, &mut take_motion, progress)?;
    if pieces == 0 { Err(WatchError::TooFew { found: 0, needed: 1 }) } else { Ok(()) }
}

/// Makes events of the contacts of a run: contacts of several joints at the same time are one event.
fn touches(robot: &Robot, noise: &ContactNoise, run: u64, contacts: Vec<Contact>) -> Vec<Event> {
    let strength = |contact: &Contact| contact.peak.abs() / noise.joints[contact.joint].deviation;
    let mut groups: Vec<Vec<Contact>> = Vec::new();
    for contact in contacts {
        let ends = |group: &Vec<Contact>| group.iter().fold(f64::NEG_INFINITY, |end, of| end.max(of.end));
        match groups.last_mut() {
            Some(group) if contact.start <= ends(group) + JOINED => group.push(contact),
            _ => groups.push(vec![contact]),
        }
    }
    let event = |group: Vec<Contact>| {
        let most = group.iter().max_by(|a, b| strength(a).total_cmp(&strength(b))).copied()?;
        let mut others: Vec<usize> = group.iter().map(|of| of.joint).filter(|joint| *joint != most.joint).collect();
        others.sort_unstable();
        others.dedup();
        Some(Event {
            joint: Some(most.joint),
            parameter: "external",
            value: most.peak,
            deviation: noise.joints[most.joint].deviation,
            unit: unit(robot, Candidate::Offset(most.joint)),
            run,
            since: group.iter().fold(f64::INFINITY, |start, of| start.min(of.start)),
            until: group.iter().fold(f64::NEG_INFINITY, |end, of| end.max(of.end)),
            others,
            ..Event::blank(Cause::Contact)
        })
    };
    groups.into_iter().filter_map(event).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(cause: Cause, joint: usize) -> Event {
        Event { joint: Some(joint), value: 1.0, since: 1.0, until: 2.0, ..Event::blank(cause) }
    }

    fn causes(events: &[Event]) -> Vec<(Cause, Option<usize>)> {
        one_cause(events).into_iter().map(|event| (event.cause, event.joint)).collect()
    }

    #[test]
    fn a_contact_and_the_error_that_it_makes_are_one_event() {
        let (model, contact) = (event(Cause::Model, 1), event(Cause::Contact, 1));
        let other = event(Cause::Contact, 0);
        let few = vec![model.clone(), contact.clone(), other.clone()];
        assert_eq!(causes(&few), [(Cause::Contact, Some(1)), (Cause::Contact, Some(0))]);
        let mut many = vec![model.clone(), other];
        many.extend(vec![contact; MANY]);
        assert_eq!(causes(&many), [(Cause::Model, Some(1)), (Cause::Contact, Some(0))]);
        assert_eq!(causes(&[model]), [(Cause::Model, Some(1))]);
        // friction changes at 5 s: a contact at that time is an effect of the change, a later one is not
        let friction = Event { since: 5.0, until: 20.0, lasts: true, ..event(Cause::Friction, 2) };
        let at = |since: f64| Event { since, until: since + 0.2, ..event(Cause::Contact, 2) };
        let found = causes(&[friction, at(4.9), at(9.0)]);
        assert_eq!(found, [(Cause::Friction, Some(2)), (Cause::Contact, Some(2))]);
    }
}
