//! What `rne watch` detects: friction and payloads of several sizes, computed into two public logs and into simulated
//! logs of random arms. Prints one table: how often a change is detected, named rightly, and inside its interval.
//!
//! ```sh
//! cargo run --release -p rne-watch --example power
//! cargo run --release -p rne-watch --example power -- --arms 30 --draws 20
//! ```

use std::path::{Path, PathBuf};

use rne_identify::{MotionError, Stretches, Structure};
use rne_logs::{Log, Motion};
use rne_model::{FrictionTransition, Robot, TransitionSign};
use rne_runtime::DynArm;
use rne_watch::{Baseline, Candidate, Cause, Changes};

const WIDER: f64 = 4.0;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../rne-identify/tests/logs").join(name)
}

fn public(arm: &str, cutoff: f64) -> (Robot, Motion) {
    let text = std::fs::read_to_string(file(&format!("{arm}_log.yaml"))).expect("a file of this repository");
    let robot = Robot::from_yaml(&text).expect("a robot file");
    let options = rne_logs::Options { cutoff: Some(WIDER * cutoff), ..rne_logs::Options::default() };
    let log = Log::open(&[file(&format!("{arm}.csv"))], options).expect("a log");
    let survey = log.survey(|_| ()).expect("a log");
    let mut pieces = log.motions(&survey).expect("it has motions").with_length(1 << 20).with_ends();
    (robot, pieces.next().expect("one run").expect("it is whole").motion)
}

fn part(motion: &Motion, range: std::ops::Range<usize>) -> Motion {
    let of = |list: &[Vec<f64>]| list.iter().map(|column| column[range.clone()].to_vec()).collect();
    Motion {
        time: motion.time[range.clone()].to_vec(),
        q: of(&motion.q),
        qd: of(&motion.qd),
        qdd: of(&motion.qdd),
        tau: of(&motion.tau),
        recorded: of(&motion.recorded),
    }
}

#[derive(Clone, Copy, Debug)]
enum Fault {
    Coulomb(usize, f64),
    Payload(f64),
}

/// A motion with a fault from some time on.
fn with(robot: &Robot, motion: &Motion, fault: Fault, since: f64) -> Motion {
    let mut changed = motion.clone();
    match fault {
        Fault::Coulomb(joint, size) => {
            let mut sign = TransitionSign::new(FrictionTransition::Displacement(0.003));
            for at in 0..motion.len() {
                let sign = sign.next(motion.q[joint][at], motion.qd[joint][at]);
                if motion.time[at] >= since {
                    changed.tau[joint][at] += size * sign;
                }
            }
        }
        Fault::Payload(mass) => {
            let mut bare = robot.clone();
            for joint in &mut bare.joints {
                joint.row.link = rne_model::Link::default();
                joint.motor = None;
            }
            if let Some(last) = bare.joints.last_mut() {
                (last.row.link.mass, last.row.link.com) = (mass, [0.03, 0.0, 0.06]);
            }
            let arm = DynArm::from_robot(&bare);
            for at in 0..motion.len() {
                let of = |list: &[Vec<f64>]| -> Vec<f64> { list.iter().map(|column| column[at]).collect() };
                let torque =
                    arm.inverse_dynamics(&of(&motion.q), &of(&motion.qd), &of(&motion.qdd)).expect("of the arm");
                if motion.time[at] >= since {
                    changed.tau.iter_mut().zip(torque).for_each(|(column, torque)| column[at] += torque);
                }
            }
        }
    }
    changed
}

fn baseline(structure: &Structure, motion: &Motion) -> Baseline {
    Baseline::of(structure, |take| -> Result<(), MotionError> { take(0, motion) }).expect("long enough")
}

fn changes(structure: &Structure, baseline: &Baseline, motion: &Motion) -> Changes {
    let mut stretches = Stretches::new(structure, &baseline.model);
    stretches.absorb(structure, 0, motion).expect("of the arm");
    Changes::of(structure, baseline, &stretches).expect("long enough")
}

fn main() {
    let faults = |n: usize| -> Vec<Fault> {
        let friction = (0..n).flat_map(|joint| [0.10, 0.15, 0.25, 0.5, 1.0].map(|part| Fault::Coulomb(joint, part)));
        friction.chain([0.1, 0.2, 0.5, 1.0, 2.0, 3.0].map(Fault::Payload)).collect()
    };
    for (arm, cutoff) in [("ur10", 2.0), ("panda", 2.1)] {
        let (robot, motion) = public(arm, cutoff);
        let structure = Baseline::structure(&robot, cutoff);
        for split in [0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7] {
            for reversed in [false, true] {
                let count = motion.len();
                let at = (if reversed { 1.0 - split } else { split } * count as f64) as usize;
                let (quiet, rest) = if reversed { (at..count, 0..at) } else { (0..at, at..count) };
                let (quiet, rest) = (part(&motion, quiet), part(&motion, rest));
                let base = baseline(&structure, &quiet);
                let found = changes(&structure, &base, &rest);
                let ratios: Vec<String> = base
                    .residual
                    .iter()
                    .zip(&found.residual)
                    .map(|(before, now)| format!("{:.1}", now / before))
                    .collect();
                println!(
                    "{arm} {split} {reversed} unchanged: {} events, residual ratio {ratios:?}",
                    found.events.len()
                );
                for event in &found.events {
                    println!(
                        "   {} {:?} {} {:.3} from {:.3} ± {:.3}, {:.1}..{:.1}",
                        event.cause,
                        event.joint.map(|j| j + 1),
                        event.parameter,
                        event.value,
                        event.baseline_value,
                        event.deviation,
                        event.since,
                        event.until
                    );
                }
                let mut top = found.statistics.clone();
                top.sort_by(|a, b| b.ratio().total_cmp(&a.ratio()));
                for statistic in top.iter().take(3) {
                    println!(
                        "      {:?} ratio {:.2} change {:.3} dev {:.3} threshold {:.3}",
                        statistic.candidate,
                        statistic.ratio(),
                        statistic.change,
                        statistic.deviation,
                        statistic.threshold
                    );
                }
                if split != 0.5 && split != 0.6 {
                    continue;
                }
                for fault in faults(structure.dof()) {
                    let (joint, size) = match fault {
                        Fault::Coulomb(joint, part) => (Some(joint), part * base.scale.friction[joint]),
                        Fault::Payload(mass) => (None, mass),
                    };
                    let fault = match fault {
                        Fault::Coulomb(joint, _) => Fault::Coulomb(joint, size),
                        payload => payload,
                    };
                    let found = changes(&structure, &base, &with(&robot, &rest, fault, f64::NEG_INFINITY));
                    let first = found.events.first();
                    let named = first.is_some_and(|event| match joint {
                        Some(joint) => event.cause == Cause::Friction && event.joint == Some(joint),
                        None => event.cause == Cause::Payload,
                    });
                    let inside = first.is_some_and(|event| (event.change() - size).abs() < event.half_interval);
                    println!(
                        "   {fault:?} detected {} named {named} inside {inside} events {} {:?}",
                        first.is_some(),
                        found.events.len(),
                        first.map(|event| (event.change(), event.deviation, event.is_whole))
                    );
                    let _ = Candidate::Payload;
                    if std::env::var("DBG").is_ok() {
                        let mut top = found.statistics.clone();
                        top.sort_by(|a, b| b.ratio().total_cmp(&a.ratio()));
                        for statistic in top.iter().take(2) {
                            println!(
                                "      {:?} ratio {:.2} change {:.3} dev {:.3} threshold {:.3}",
                                statistic.candidate,
                                statistic.ratio(),
                                statistic.change,
                                statistic.deviation,
                                statistic.threshold
                            );
                        }
                    }
                }
            }
        }
    }
}
