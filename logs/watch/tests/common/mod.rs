//! Public logs and faults that are computed into them, for tests and the table of power.
#![allow(dead_code, reason = "each test uses a part")]

pub(crate) mod simulated;

use std::ops::Range;
use std::path::{Path, PathBuf};

use fastrand::Rng;
use rne_identify::{MotionError, Stretches, Structure};
use rne_logs::{Log, Motion};
use rne_model::{FrictionTransition, Link, Robot, TransitionSign};
use rne_runtime::DynArm;
use rne_watch::{Baseline, Changes};

/// The log's own filter, in cut-offs of the low-pass: as `rne watch` reads logs.
const WIDER: f64 = 4.0;

/// The public logs, with the low-pass of each, Hz.
pub(crate) const PUBLIC: [(&str, f64); 2] = [("ur10", 2.0), ("panda", 2.1)];

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../identify/tests/logs").join(name)
}

/// The geometry and the motion of a public log.
pub(crate) fn public(arm: &str, cutoff: f64) -> (Robot, Motion) {
    let text = std::fs::read_to_string(file(&format!("{arm}_log.yaml"))).expect("a file of this repository");
    let robot = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
    let options = rne_logs::Options { cutoff: Some(WIDER * cutoff), ..rne_logs::Options::default() };
    let log = Log::open(&[file(&format!("{arm}.csv"))], options).expect("a log");
    let survey = log.survey(|_| ()).expect("a log");
    let mut pieces = log.motions(&survey).expect("it has motions").with_length(1 << 20);
    (robot, pieces.next().expect("one run").expect("it is whole").motion)
}

/// Some of the states of a motion.
pub(crate) fn part(motion: &Motion, range: Range<usize>) -> Motion {
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

/// The two parts of a motion at a fraction of it: the quiet one, and the other one. `is_reversed` takes the end for the
/// quiet one.
pub(crate) fn split(motion: &Motion, fraction: f64, is_reversed: bool) -> [Motion; 2] {
    let count = motion.len();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    let quiet = (fraction * count as f64) as usize;
    if is_reversed {
        [part(motion, count - quiet..count), part(motion, 0..count - quiet)]
    } else {
        [part(motion, 0..quiet), part(motion, quiet..count)]
    }
}

/// A change of an arm.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fault {
    /// More Coulomb friction of a joint, N m; it gives way over three milliradians, as no model here does.
    Coulomb(usize, f64),
    /// More viscous friction of a joint, N m s/rad.
    Viscous(usize, f64),
    /// A payload, kg, with its centre of mass 7 cm from the last frame.
    Payload(f64),
    /// A channel of efforts that shows so many times the torque of its joint: 0 if it is dead.
    Gain(usize, f64),
    /// Efforts that are later by a time, s.
    Delay(f64),
}

/// The torques that a fault adds, by the engine that the watch does not use.
pub(crate) fn torques(robot: &Robot, motion: &Motion, fault: Fault) -> Vec<Vec<f64>> {
    let mut torques = vec![vec![0.0; motion.len()]; robot.dof()];
    match fault {
        Fault::Coulomb(joint, size) => {
            let mut sign = TransitionSign::new(FrictionTransition::Displacement(0.003));
            for (at, torque) in torques[joint].iter_mut().enumerate() {
                *torque = size * sign.next(motion.q[joint][at], motion.qd[joint][at]);
            }
        }
        Fault::Viscous(joint, size) => torques[joint] = motion.qd[joint].iter().map(|qd| size * qd).collect(),
        Fault::Gain(joint, gain) => {
            torques[joint] = motion.tau[joint].iter().map(|torque| (gain - 1.0) * torque).collect();
        }
        Fault::Delay(delay) => {
            for (torque, tau) in torques.iter_mut().zip(&motion.tau) {
                let late = simulated::late(&motion.time, tau, delay);
                *torque = late.into_iter().zip(tau).map(|(late, tau)| late - tau).collect();
            }
        }
        Fault::Payload(mass) => {
            let mut bare = robot.clone();
            for joint in &mut bare.joints {
                joint.row.link = Link::default();
                joint.motor = None;
            }
            let last = &mut bare.joints.last_mut().expect("a joint").row.link;
            (last.mass, last.com) = (mass, [0.03, 0.0, 0.06]);
            let arm = DynArm::from_robot(&bare);
            for at in 0..motion.len() {
                let of = |list: &[Vec<f64>]| -> Vec<f64> { list.iter().map(|column| column[at]).collect() };
                let of_state = arm.inverse_dynamics(&of(&motion.q), &of(&motion.qd), &of(&motion.qdd));
                let of_state = of_state.expect("a state of the arm");
                torques.iter_mut().zip(of_state).for_each(|(column, torque)| column[at] = torque);
            }
        }
    }
    torques
}

/// A motion with a fault from some time on.
pub(crate) fn with(robot: &Robot, motion: &Motion, fault: Fault, since: f64) -> Motion {
    let mut changed = motion.clone();
    for (tau, added) in changed.tau.iter_mut().zip(torques(robot, motion, fault)) {
        for ((tau, added), time) in tau.iter_mut().zip(added).zip(&motion.time) {
            *tau += if *time >= since { added } else { 0.0 };
        }
    }
    changed
}

/// A number of the standard normal distribution (Box and Muller).
pub(crate) fn normal(rng: &mut Rng) -> f64 {
    let (u, v) = (1.0 - rng.f64(), rng.f64());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// A motion with noise in its efforts, correlated over 0.15 s, of these standard deviations.
pub(crate) fn noisy(motion: &Motion, deviations: &[f64], rng: &mut Rng) -> Motion {
    let mut noisy = motion.clone();
    for (tau, deviation) in noisy.tau.iter_mut().zip(deviations) {
        let mut state = normal(rng);
        for (at, tau) in tau.iter_mut().enumerate() {
            let step = if at == 0 { 0.0 } else { motion.time[at] - motion.time[at - 1] };
            let keep = (-step / 0.15).exp();
            state = keep * state + (1.0 - keep * keep).sqrt() * normal(rng);
            *tau += deviation * state;
        }
    }
    noisy
}

/// The baseline of one motion.
pub(crate) fn baseline(structure: &Structure, motion: &Motion) -> Baseline {
    Baseline::of(structure, |take| -> Result<(), MotionError> { take(0, motion) }).expect("long enough")
}

/// The changes between a baseline and a motion.
pub(crate) fn changes(structure: &Structure, baseline: &Baseline, motion: &Motion) -> Changes {
    let mut stretches = Stretches::new(structure, &baseline.model);
    stretches.absorb(structure, 0, motion).expect("a motion of the arm");
    Changes::of(structure, baseline, &stretches).expect("long enough")
}
