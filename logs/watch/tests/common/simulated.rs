//! Arms that are simulated: random links on two geometries, Fourier motions, noise, quantisation, a delay, friction
//! that gives way over some travel.

use fastrand::Rng;
use rne_identify::Structure;
use rne_logs::Motion;
use rne_model::{FrictionTransition, Link, Robot, TransitionSign};
use rne_runtime::DynArm;
use rne_watch::Baseline;

use super::{Fault, normal, public, torques};

/// Hz: the low-pass.
const CUTOFF: f64 = 2.0;

/// A simulated arm with two logs.
pub(crate) struct Simulated {
    /// Its geometry; links and friction are for the watch to find.
    pub(crate) robot: Robot,
    /// Its equations.
    pub(crate) structure: Structure,
    /// A quiet log.
    pub(crate) quiet: Motion,
    /// Another log, quiet as well.
    pub(crate) watched: Motion,
    /// Coulomb friction of each joint, N m.
    pub(crate) friction: Vec<f64>,
    /// A large payload of such an arm, kg.
    pub(crate) payload: f64,
}

impl Simulated {
    /// The arm of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self::moved(seed, 1.0, 1.0)
    }

    /// The arm of a seed, whose second log has another motion: so many times the amplitude, and so many times the
    /// frequencies, of the quiet one.
    pub(crate) fn moved(seed: u64, amplitude: f64, frequency: f64) -> Self {
        let mut rng = Rng::with_seed(1000 + seed);
        let mut range = |low: f64, high: f64| low + (high - low) * rng.f64();
        let is_large = range(0.0, 1.0) < 0.5;
        let (robot, _) = public(if is_large { "ur10" } else { "panda" }, CUTOFF);
        let dof = robot.dof();
        let mut loaded = robot.clone();
        let heaviest = if is_large { 20.0 } else { 6.0 };
        for (at, joint) in loaded.joints.iter_mut().enumerate() {
            #[allow(clippy::cast_precision_loss)]
            let mass = heaviest * (1.0 - 0.8 * at as f64 / dof as f64) * range(0.5, 1.2);
            let mut link = Link { mass, com: [0.0; 3].map(|_| range(-0.1, 0.1)), ..Link::default() };
            let own = mass * 0.0036;
            (link.inertia.xx, link.inertia.yy, link.inertia.zz) = (own, own, own);
            joint.row.link = link;
            joint.motor = None;
        }
        let efforts: &[f64] =
            if is_large { &[60.0, 60.0, 40.0, 10.0, 10.0, 8.0] } else { &[10.0, 30.0, 15.0, 15.0, 3.0, 3.0, 1.5] };
        let efforts: Vec<f64> = efforts.iter().map(|effort| effort * range(0.7, 1.3)).collect();
        let way = range(0.001, 0.01);
        let [noise, step, delay] = [range(0.01, 0.04), range(0.002, 0.01), range(0.0, 0.015)];
        let rate = if range(0.0, 1.0) < 0.5 { 30.0 } else { 50.0 };
        let durations = [range(12.0, 30.0), range(8.0, 20.0)];
        let offsets: Vec<f64> = efforts.iter().map(|effort| 0.01 * effort * range(-1.7, 1.7)).collect();
        let motions = [(durations[0], [1.0; 2]), (durations[1], [amplitude, frequency])];
        let [quiet, watched] = motions.map(|(duration, scale)| {
            let mut motion = fourier(&loaded, rate, duration, scale, &mut rng);
            for joint in 0..dof {
                let mut sign = TransitionSign::new(FrictionTransition::Displacement(way));
                let effort = efforts[joint];
                let mut torque: Vec<f64> = (0..motion.len())
                    .map(|at| {
                        let (q, qd) = (motion.q[joint][at], motion.qd[joint][at]);
                        motion.tau[joint][at] + 0.06 * effort * qd + 0.12 * effort * sign.next(q, qd) + offsets[joint]
                    })
                    .collect();
                torque = late(&motion.time, &torque, delay);
                for (tau, torque) in motion.tau[joint].iter_mut().zip(torque) {
                    *tau = ((torque + noise * effort * normal(&mut rng)) / (step * effort)).round() * step * effort;
                }
                for (qd, q) in motion.qd[joint].iter_mut().zip(&mut motion.q[joint]) {
                    *qd += 0.0005 * normal(&mut rng);
                    *q = (*q / 1e-5).round() * 1e-5;
                }
            }
            motion
        });
        let friction = efforts.iter().map(|effort| 0.12 * effort).collect();
        let structure = Baseline::structure(&robot, CUTOFF);
        Self { robot, structure, quiet, watched, friction, payload: if is_large { 5.0 } else { 2.0 } }
    }

    /// The second log with a fault.
    pub(crate) fn with(&self, fault: Fault) -> Motion {
        let mut changed = self.watched.clone();
        let added = torques(&self.robot, &self.watched, fault);
        changed.tau.iter_mut().zip(added).for_each(|(tau, added)| {
            tau.iter_mut().zip(added).for_each(|(tau, added)| *tau += added);
        });
        changed
    }
}

/// Values at times that are earlier by a delay, s.
pub(crate) fn late(time: &[f64], values: &[f64], delay: f64) -> Vec<f64> {
    let at = |instant: f64| {
        let next = time.partition_point(|time| *time < instant).clamp(1, time.len() - 1);
        let part = ((instant - time[next - 1]) / (time[next] - time[next - 1])).clamp(0.0, 1.0);
        (1.0 - part) * values[next - 1] + part * values[next]
    };
    time.iter().map(|time| at(time - delay)).collect()
}

/// A motion of five harmonics, with the torques of the links; amplitudes and frequencies are scaled.
fn fourier(robot: &Robot, rate: f64, duration: f64, [amplitude, frequency]: [f64; 2], rng: &mut Rng) -> Motion {
    let arm = DynArm::from_robot(robot);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let count = (duration * rate) as usize;
    let mut motion = Motion::default();
    #[allow(clippy::cast_precision_loss)]
    let time: Vec<f64> = (0..count).map(|at| at as f64 / rate).collect();
    for _ in 0..robot.dof() {
        let centre = 2.0 * rng.f64() - 1.0;
        let waves: Vec<[f64; 3]> = (1..6)
            .map(|k| {
                let speed = frequency * std::f64::consts::TAU * 0.1 * f64::from(k) * (0.9 + 0.2 * rng.f64());
                [amplitude * 0.5 * normal(rng) / f64::from(k), speed, std::f64::consts::TAU * rng.f64()]
            })
            .collect();
        let sum = |each: &dyn Fn(&[f64; 3], f64) -> f64| -> Vec<f64> {
            time.iter().map(|time| waves.iter().map(|wave| each(wave, *time)).sum()).collect()
        };
        motion.q.push(sum(&|[a, w, p], t| a * (w * t + p).sin()).into_iter().map(|q| q + centre).collect());
        motion.qd.push(sum(&|[a, w, p], t| a * w * (w * t + p).cos()));
        motion.qdd.push(sum(&|[a, w, p], t| -a * w * w * (w * t + p).sin()));
    }
    motion.tau = vec![Vec::with_capacity(count); robot.dof()];
    for at in 0..count {
        let of = |list: &[Vec<f64>]| -> Vec<f64> { list.iter().map(|column| column[at]).collect() };
        let torque = arm.inverse_dynamics(&of(&motion.q), &of(&motion.qd), &of(&motion.qdd)).expect("of the arm");
        motion.tau.iter_mut().zip(torque).for_each(|(column, torque)| column.push(torque));
    }
    motion.time = time;
    motion
}
