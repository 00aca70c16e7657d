//! Channels of effort that do not measure their joint: one that repeats a value, and two that are exchanged.

mod common;

use std::convert::Infallible;

use common::simulated::Simulated;
use common::{PUBLIC, baseline, changes, public, split};
use rne_identify::{Stretches, Structure};
use rne_logs::Motion;
use rne_watch::{Baseline, Cause, Event, exchanged_efforts};

/// A motion in which the effort of a joint stays as it is at one sample from there on.
fn frozen(motion: &Motion, joint: usize, from: usize) -> Motion {
    let mut frozen = motion.clone();
    let value = frozen.tau[joint][from];
    frozen.tau[joint][from..].fill(value);
    frozen
}

fn is_frozen(event: &Event) -> bool {
    event.parameter == "frozen"
}

/// An effort that repeats one value, in the whole log or in its second half, is one event with its value and time.
#[test]
fn an_effort_that_repeats_a_value_is_one_event() {
    let (name, cutoff) = PUBLIC[0];
    let (robot, motion) = public(name, cutoff);
    let structure = Baseline::structure(&robot, cutoff);
    let [quiet, watched] = split(&motion, 0.5, false);
    let quiet = baseline(&structure, &quiet);
    for joint in 0..5 {
        for from in [0, watched.len() / 2] {
            let log = frozen(&watched, joint, from);
            let events = changes(&structure, &quiet, &log).events;
            let found: Vec<&Event> = events.iter().filter(|event| is_frozen(event)).collect();
            assert_eq!(found.len(), 1, "{joint} {from}: {events:#?}");
            assert_eq!((found[0].cause, found[0].joint, found[0].lasts), (Cause::Sensor, Some(joint), true));
            assert_eq!(found[0].is_whole, from == 0);
            let (value, since) = (watched.tau[joint][from], watched.time[from]);
            assert!((found[0].value - value).abs() < 1e-3 * value.abs(), "{value}: {found:#?}");
            assert!((found[0].since - since).abs() < 1.5, "{since}: {found:#?}");
            assert!(events.iter().all(|event| event.joint != Some(joint) || is_frozen(event)), "{events:#?}");
        }
    }
}

/// An arm at rest has constant efforts without any fault.
#[test]
fn constant_efforts_of_an_arm_at_rest_are_no_event() {
    let arm = Simulated::moved(3, 0.0, 1.0);
    let quiet = baseline(&arm.structure, &arm.quiet);
    let log = (0..arm.robot.dof()).fold(arm.watched.clone(), |log, joint| frozen(&log, joint, 0));
    let events = changes(&arm.structure, &quiet, &log).events;
    assert!(!events.iter().any(|event| event.parameter == "frozen"), "{events:#?}");
}

fn with_exchanged(motion: &Motion, [first, second]: [usize; 2]) -> Motion {
    let mut exchanged = motion.clone();
    exchanged.tau.swap(first, second);
    exchanged
}

/// The joints whose efforts look exchanged in a motion.
fn exchanged(structure: &Structure, quiet: &Baseline, motion: &Motion) -> Option<[usize; 2]> {
    let stretches = |motion: &Motion| {
        let mut stretches = Stretches::new(structure, &quiet.model);
        stretches.absorb(structure, 0, motion).expect("a motion of the arm");
        stretches
    };
    let back = |joints| Ok::<_, Infallible>(stretches(&with_exchanged(motion, joints)));
    let found = exchanged_efforts(structure, quiet, &stretches(motion), back).unwrap_or_else(|never| match never {});
    found.map(|(joints, _)| joints)
}

/// The efforts of each two of the first five joints of a real arm. The torque of the last joint is nearly
/// noise: with it, not every pair is found.
#[test]
fn exchanged_efforts_are_named() {
    let (name, cutoff) = PUBLIC[0];
    let (robot, motion) = public(name, cutoff);
    let structure = Baseline::structure(&robot, cutoff);
    let [quiet, watched] = split(&motion, 0.5, false);
    let quiet = baseline(&structure, &quiet);
    for second in 1..5 {
        for first in 0..second {
            let log = with_exchanged(&watched, [first, second]);
            assert_eq!(exchanged(&structure, &quiet, &log), Some([first, second]));
        }
    }
}

/// Quiet logs of real and simulated arms have no exchanged efforts.
#[test]
fn efforts_of_quiet_logs_are_not_exchanged() {
    for (name, cutoff) in PUBLIC {
        let (robot, motion) = public(name, cutoff);
        let structure = Baseline::structure(&robot, cutoff);
        for (fraction, is_reversed) in [(0.5, false), (0.5, true)] {
            let [quiet, watched] = split(&motion, fraction, is_reversed);
            let quiet = baseline(&structure, &quiet);
            assert_eq!(exchanged(&structure, &quiet, &watched), None, "{name} {fraction} {is_reversed}");
        }
    }
    let arms = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 100 } else { 4 };
    for seed in 0..arms {
        let arm = Simulated::new(seed);
        let quiet = baseline(&arm.structure, &arm.quiet);
        assert_eq!(exchanged(&arm.structure, &quiet, &arm.watched), None, "{seed}");
    }
}
