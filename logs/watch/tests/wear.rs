//! Wear and payloads computed into two public logs of real arms: what has changed is named, with its size and time; of
//! what has not changed nothing is said.

mod common;

use common::simulated::Simulated;
use common::{Fault, PUBLIC, baseline, changes, noisy, public, split, with};
use fastrand::Rng;
use rne_identify::{Stretches, Structure};
use rne_logs::Motion;
use rne_model::Robot;
use rne_watch::{Baseline, Cause, Changes, Event};

/// The arm of a public log: its robot, its equations, its motion.
struct Arm {
    robot: Robot,
    structure: Structure,
    motion: Motion,
}

fn arm(name: &str) -> Arm {
    let (_, cutoff) = PUBLIC.into_iter().find(|(of, _)| *of == name).expect("a public log");
    let (robot, motion) = public(name, cutoff);
    Arm { structure: Baseline::structure(&robot, cutoff), robot, motion }
}

/// The events of the second half of a log with a fault, which may begin in its middle.
fn events(arm: &Arm, quiet: &Baseline, watched: &Motion, fault: Fault, since: f64) -> Vec<Event> {
    changes(&arm.structure, quiet, &with(&arm.robot, watched, fault, since)).events
}

const ALWAYS: f64 = f64::NEG_INFINITY;

/// The first few of some cases; with `RNE_EXHAUSTIVE` set, all of them.
fn tried<C: Copy>(cases: &[C], few: usize) -> &[C] {
    if is_exhaustive() { cases } else { &cases[..few] }
}

fn is_exhaustive() -> bool {
    std::env::var_os("RNE_EXHAUSTIVE").is_some()
}

/// Ways to split a public log into a quiet part and a part that is watched.
const SPLITS: [(f64, bool); 4] = [(0.5, false), (0.6, true), (0.5, true), (0.6, false)];

/// A part of a joint's Coulomb friction, N m.
fn friction(quiet: &Baseline, joint: usize, part: f64) -> f64 {
    part * quiet.scale.friction[joint]
}

#[test]
fn an_unchanged_log_has_no_event() {
    for (name, _) in PUBLIC {
        let arm = arm(name);
        for &(fraction, is_reversed) in tried(&SPLITS, 2) {
            let [quiet, watched] = split(&arm.motion, fraction, is_reversed);
            let quiet = baseline(&arm.structure, &quiet);
            let found = changes(&arm.structure, &quiet, &watched);
            assert_eq!(found.events, [], "{name} {fraction} {is_reversed}");
            let nearest = found.nearest(&quiet.scale).expect("candidates");
            println!("{name} {fraction} {is_reversed}: {:?} {:.2}", nearest.candidate, nearest.ratio());
        }
    }
}

/// More friction of one joint is one event: friction of that joint, as large as it is.
#[test]
fn friction_that_grows_is_named() {
    for (name, joint, part) in [("ur10", 2, 0.25), ("ur10", 3, 0.5), ("panda", 4, 1.0), ("panda", 6, 1.0)] {
        let arm = arm(name);
        let [quiet, watched] = split(&arm.motion, 0.5, false);
        let quiet = baseline(&arm.structure, &quiet);
        let size = friction(&quiet, joint, part);
        let found = events(&arm, &quiet, &watched, Fault::Coulomb(joint, size), ALWAYS);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        let event = &found[0];
        println!("{name} joint {}: {:.3} of {size:.3} ± {:.3}", joint + 1, event.change(), event.deviation);
        assert_eq!((event.cause, event.joint, event.parameter), (Cause::Friction, Some(joint), "coulomb"));
        assert!((event.change() - size).abs() < event.half_interval, "{event:?}");
        assert!(event.is_whole, "{event:?}");
    }
}

#[test]
fn friction_that_grows_from_the_middle_on_has_its_time() {
    // the baseline is the first half; the log that is watched is all of it, with more friction from the middle on
    for (name, joint, part) in [("ur10", 2, 0.25), ("ur10", 3, 0.5), ("panda", 4, 1.0), ("panda", 6, 1.0)] {
        let arm = arm(name);
        let [quiet, rest] = split(&arm.motion, 0.5, false);
        let quiet = baseline(&arm.structure, &quiet);
        let since = rest.time[0];
        let size = friction(&quiet, joint, part);
        let found = events(&arm, &quiet, &arm.motion, Fault::Coulomb(joint, size), since);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        println!("{name} joint {}: since {:.2} s, which is {since:.2} s", joint + 1, found[0].since);
        assert_eq!((found[0].cause, found[0].joint), (Cause::Friction, Some(joint)));
        assert!((found[0].since - since).abs() < 2.0, "{found:?}");
    }
}

#[test]
fn a_payload_is_weighed() {
    for (name, mass) in [("ur10", 1.0), ("ur10", 2.0), ("ur10", 3.0), ("panda", 0.5), ("panda", 1.0)] {
        let arm = arm(name);
        let [quiet, watched] = split(&arm.motion, 0.5, false);
        let quiet = baseline(&arm.structure, &quiet);
        let found = events(&arm, &quiet, &watched, Fault::Payload(mass), ALWAYS);
        assert_eq!(found.len(), 1, "{name} {mass}: {found:?}");
        println!("{name}: {:.2} ± {:.2} kg of {mass}", found[0].value, found[0].deviation);
        assert_eq!((found[0].cause, found[0].joint, found[0].unit), (Cause::Payload, None, "kg"));
        assert!((found[0].value - mass).abs() < 0.3, "{found:?}");
    }
}

/// Two faults are two events, although the payload explains far more than the friction.
#[test]
fn a_second_fault_is_not_hidden_by_a_large_one() {
    let arm = arm("ur10");
    let [quiet, watched] = split(&arm.motion, 0.5, false);
    let quiet = baseline(&arm.structure, &quiet);
    let size = friction(&quiet, 3, 0.5);
    let worn = with(&arm.robot, &watched, Fault::Coulomb(3, size), ALWAYS);
    let found = events(&arm, &quiet, &worn, Fault::Payload(5.0), ALWAYS);
    let causes: Vec<(Cause, Option<usize>)> = found.iter().map(|event| (event.cause, event.joint)).collect();
    assert_eq!(causes, [(Cause::Payload, None), (Cause::Friction, Some(3))]);
    assert!((found[0].change() - 5.0).abs() < 0.3 && (found[1].change() - size).abs() < found[1].half_interval);
}

/// The intervals hold: 200 logs with noise of half the residual of each joint, and a new baseline for every ten.
#[test]
fn intervals_hold_the_true_size() {
    let cases = [("ur10", Some(2), 0.25), ("ur10", Some(3), 0.5), ("panda", Some(4), 1.0), ("panda", Some(6), 1.0)];
    for (name, joint, part) in cases.into_iter().chain([("ur10", None, 1.0)]) {
        let arm = arm(name);
        let [quiet, watched] = split(&arm.motion, 0.5, false);
        let plain = baseline(&arm.structure, &quiet);
        let noise: Vec<f64> = plain.model.noise.iter().map(|noise| 0.5 * noise).collect();
        let size = joint.map_or(1.0, |joint| friction(&plain, joint, part));
        let fault = joint.map_or(Fault::Payload(size), |joint| Fault::Coulomb(joint, size));
        let watched = with(&arm.robot, &watched, fault, ALWAYS);
        let mut rng = Rng::with_seed(28);
        let (mut found, mut named, mut held) = (0, 0, 0);
        let draws = if is_exhaustive() { 20 } else { 1 };
        for _ in 0..draws {
            let before = baseline(&arm.structure, &noisy(&quiet, &noise, &mut rng));
            for _ in 0..10 {
                let log = noisy(&watched, &noise, &mut rng);
                let events = changes(&arm.structure, &before, &log).events;
                let Some(event) = events.first() else { continue };
                found += 1;
                let is_named = event.joint == joint && matches!(event.cause, Cause::Friction | Cause::Payload);
                named += u32::from(is_named);
                held += u32::from(is_named && (event.change() - size).abs() < event.half_interval);
            }
        }
        println!("{name} {fault:?}: of {} found {found}, named {named}, inside {held}", 10 * draws);
        assert!(10 * named >= 9 * 10 * draws, "{name} {fault:?}: {named} of {}", 10 * draws);
        assert!(10 * held >= 9 * named, "{name} {fault:?}: {held} of {named}");
    }
}

/// A channel that is dead, has the opposite sign or another gain is one event of its own: no payload, no friction.
#[test]
fn the_gain_of_a_channel_is_named() {
    let arms = if is_exhaustive() { 40 } else { 2 };
    for (seed, gain) in (0..arms).flat_map(|seed| [0.0, -1.0, 0.8].map(|gain| (seed, gain))) {
        let arm = Simulated::new(seed);
        let joint = usize::try_from(seed).expect("small") % arm.friction.len();
        let quiet = baseline(&arm.structure, &arm.quiet);
        let found = changes(&arm.structure, &quiet, &arm.with(Fault::Gain(joint, gain))).events;
        assert_eq!(found.len(), 1, "{seed} {gain}: {found:?}");
        let event = &found[0];
        assert_eq!((event.cause, event.joint, event.parameter), (Cause::Sensor, Some(joint), "gain"), "{seed} {gain}");
        assert!((event.value - gain).abs() < event.half_interval, "{seed} {gain}: {event:?}");
    }
}

/// Efforts of another recorder come later: one event, which is no friction.
#[test]
fn another_delay_is_named() {
    for (name, _) in PUBLIC {
        let arm = arm(name);
        let [quiet, watched] = split(&arm.motion, 0.5, false);
        let quiet = baseline(&arm.structure, &quiet);
        let found = events(&arm, &quiet, &watched, Fault::Delay(0.05), ALWAYS);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        assert_eq!((found[0].cause, found[0].parameter, found[0].joint), (Cause::Sensor, "delay", None));
        assert!((found[0].change() - 0.05).abs() < 0.02, "{found:?}");
    }
    for seed in [0, 1, 3] {
        let arm = Simulated::new(seed);
        let quiet = baseline(&arm.structure, &arm.quiet);
        let found = changes(&arm.structure, &quiet, &arm.with(Fault::Delay(0.02))).events;
        assert_eq!((found.len(), found[0].parameter), (1, "delay"), "{seed}: {found:?}");
        assert!((found[0].change() - 0.02).abs() < found[0].half_interval, "{found:?}");
    }
}

/// A payload below the smallest one is no friction either.
#[test]
fn a_small_payload_has_no_other_name() {
    let arm = arm("panda");
    for &(fraction, is_reversed) in tried(&SPLITS, 2) {
        let [quiet, watched] = split(&arm.motion, fraction, is_reversed);
        let quiet = baseline(&arm.structure, &quiet);
        for mass in [0.06, 0.09, 0.12, 0.14] {
            let found = events(&arm, &quiet, &watched, Fault::Payload(mass), ALWAYS);
            assert!(found.iter().all(|event| event.cause == Cause::Payload), "{fraction} {mass}: {found:?}");
        }
    }
}

/// Quiet logs of a much smaller or slower motion: three numbers of friction do not foretell it, and say so by their
/// deviations.
#[test]
fn a_quiet_log_of_another_motion_has_no_event() {
    let scales = [[0.1, 1.0], [0.05, 1.0], [1.0, 0.2], [1.0, 2.0], [0.0, 1.0]];
    let cases: Vec<(u64, [f64; 2])> = if is_exhaustive() {
        (0..40).flat_map(|seed| scales.map(|scale| (seed, scale))).collect()
    } else {
        [3, 7, 8, 29, 34].into_iter().zip(scales).collect()
    };
    for (seed, [amplitude, frequency]) in cases {
        let arm = Simulated::moved(seed, amplitude, frequency);
        let quiet = baseline(&arm.structure, &arm.quiet);
        assert_eq!(changes(&arm.structure, &quiet, &arm.watched).events, [], "{seed} {amplitude} {frequency}");
    }
}

/// Quiet logs of simulated arms: with the noise, the steps and the delay of real ones.
#[test]
fn simulated_quiet_logs_have_no_event() {
    let arms = if is_exhaustive() { 100 } else { 6 };
    let mut found = Vec::new();
    for seed in 0..arms {
        let simulated = Simulated::new(seed);
        let quiet = baseline(&simulated.structure, &simulated.quiet);
        found.extend(changes(&simulated.structure, &quiet, &simulated.watched).events);
    }
    assert_eq!(found, [], "of {arms} logs");
}

/// A payload that the arm carries in the whole log is also subtracted in runs that have too few rows to be compared.
#[test]
fn a_change_of_the_whole_log_is_in_every_run() {
    let arm = arm("ur10");
    let [quiet, watched] = split(&arm.motion, 0.5, false);
    let quiet = baseline(&arm.structure, &quiet);
    let watched = with(&arm.robot, &watched, Fault::Payload(2.0), ALWAYS);
    let mut stretches = Stretches::new(&arm.structure, &quiet.model);
    stretches.absorb(&arm.structure, 1, &watched).expect("a motion of the arm");
    let found = Changes::of(&arm.structure, &quiet, &stretches).expect("long enough");
    let torques = |run| found.torques(&arm.structure, &quiet, run, &watched).expect("a motion of the arm");
    assert!(torques(1)[1].iter().any(|torque| torque.abs() > 10.0), "{:?}", found.events);
    assert_eq!([torques(0), torques(2)], [torques(1), torques(1)]);
}

/// Stretches that are joined over many short runs begin and end in the runs of their rows.
#[test]
fn joined_stretches_name_both_runs() {
    let arm = arm("ur10");
    let [quiet, watched] = split(&arm.motion, 0.5, false);
    let quiet = baseline(&arm.structure, &quiet);
    let mut stretches = Stretches::new(&arm.structure, &quiet.model);
    for run in 0..700 {
        stretches.absorb(&arm.structure, run, &watched).expect("a motion of the arm");
    }
    let list = stretches.list();
    assert_eq!(list.first().map(|first| first.run), Some(0));
    assert_eq!(list.last().map(|last| last.last_run), Some(699));
    assert!(list.iter().any(|stretch| stretch.run < stretch.last_run));
    assert!(list.windows(2).all(|pair| pair[0].last_run <= pair[1].run));
}

/// A log without noise determines the parameters so well that the numbers of its baseline are huge.
#[test]
fn a_baseline_without_noise_is_read_back() {
    let arm = arm("ur10");
    let model = baseline(&arm.structure, &arm.motion).model;
    let tau = model.torques(&arm.structure, &arm.motion, &model.solution).expect("a motion of the arm");
    let quiet = baseline(&arm.structure, &Motion { tau: tau.clone(), recorded: tau, ..arm.motion.clone() });
    let text = quiet.to_yaml(&arm.robot, "a log without noise");
    let read = Baseline::from_yaml("arm.baseline.yaml", &text, &arm.robot).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(read.to_yaml(&arm.robot, "a log without noise"), text);
}

/// A channel without any effort is one event, and the torques that are missing are no changes of other joints. With the
/// channel, the other changes lose data: one of them, which is near its threshold in the whole log, exceeds it a
/// little.
#[test]
fn a_dead_channel_of_each_joint_is_one_event() {
    let mut others = Vec::new();
    for (name, _) in PUBLIC {
        let arm = arm(name);
        for &(fraction, is_reversed) in tried(&[(0.5, false), (0.6, false), (0.6, true)], 1) {
            let [quiet, watched] = split(&arm.motion, fraction, is_reversed);
            let quiet = baseline(&arm.structure, &quiet);
            for joint in 0..arm.robot.dof() {
                let found = events(&arm, &quiet, &watched, Fault::Gain(joint, 0.0), ALWAYS);
                let is_gain = |event: &&Event| (event.parameter, event.joint) == ("gain", Some(joint));
                assert_eq!(found.iter().filter(is_gain).count(), 1, "{name} {fraction} {is_reversed}: {found:#?}");
                let rest = found.iter().filter(|event| !is_gain(event));
                others.extend(
                    rest.map(|event| (name, joint, event.parameter, event.joint, event.change() / event.threshold)),
                );
            }
        }
    }
    println!("{others:#?}");
    assert!(others.len() <= 1 && others.iter().all(|(.., ratio)| ratio.abs() < 1.1), "{others:#?}");
}
