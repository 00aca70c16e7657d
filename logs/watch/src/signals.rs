//! Computes the part of an arm's efforts that its model does not explain, along a motion.
//!
//! ```text
//! residual = τ_measured - (τ(q, q̇, q̈) + friction(q̇))
//! external = the momentum observer of τ_measured - friction(q̇), which needs no q̈
//! ```
//!
//! External torques on the arm have the opposite sign of the actuator torques that balance them: in free motion and in
//! quasi-static contact, `external` is about -`residual` after a low-pass filter.

use rne_logs::{Motion, median};
use rne_model::{Friction, Joint, Robot};
use rne_runtime::{DynArm, DynObserverState, WrongLength};

use crate::WatchError;

/// Smallest number of samples of a motion.
const FEWEST: usize = 16;

/// Speed up to which friction is uncertain (the joint creeps), in multiples of the speed below which the joint counts
/// as at rest.
const CREEPING: f64 = 5.0;

/// Speed at rest, rad/s or m/s, of a joint whose friction changes its sign over a displacement. It may stick up to
/// `CREEPING` times this speed.
const SLIPPING: f64 = 0.004;

/// Time before and after creeping in which the residual of a joint has no meaning, s, because the filter spreads
/// measured values.
const SMEARED: f64 = 0.05;

/// Number of samples on both sides over which the filter of a log spreads a sudden change.
const SPREAD: usize = 3;

/// Time in which the terms of a torque hardly change, s.
const COUNTED: f64 = 0.05;

/// Part of the uncertainty of friction below which it counts as zero.
const FORGOTTEN: f64 = 0.02;

/// Ratio of a time step to the usual one above which it is a gap, after which the observer restarts.
const GAP: f64 = 2.5;

/// Signals along a motion: a list per joint, base to tip, each as long as `time`. N m, or N of a joint that slides.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Signals {
    /// Times, s.
    pub time: Vec<f64>,
    /// The usual time between two samples, s.
    pub period: f64,
    /// Measured efforts.
    pub measured: Vec<Vec<f64>>,
    /// Measured efforts less those of the model, with rotors and friction of the robot file.
    pub residual: Vec<Vec<f64>>,
    /// External torques on the arm from the momentum observer.
    pub external: Vec<Vec<f64>>,
    /// The uncertainty of friction, N m or N, 0 or more: when a joint creeps or reverses, its friction may have any
    /// value between Coulomb friction in both directions.
    pub open: Vec<Vec<f64>>,
    /// Whether a joint creeps, shortly before or after, so that its residual has no meaning.
    pub creeps: Vec<Vec<bool>>,
    /// The sum of the magnitudes of the terms of the model's torque, N m or N, 0 or more: if parameters are wrong by
    /// some part, the torque is wrong by at most this part of the sum.
    pub terms: Vec<Vec<f64>>,
    /// Magnitude of the joint's row of the mass matrix, kg m² or kg, which is the factor of velocity noise in the
    /// observer.
    pub inertia: Vec<Vec<f64>>,
    /// Whether the observer has settled: false for three time constants after the beginning and after each gap.
    pub settled: Vec<bool>,
}

impl Signals {
    /// Computes the signals of a robot along a motion; `gain` is that of the observer, Hz.
    ///
    /// # Errors
    /// When the motion does not fit the robot, is too short, or has numbers that are not finite.
    pub fn new(robot: &Robot, motion: &Motion, gain: f64) -> Result<Self, WatchError> {
        check(robot.dof(), motion)?;
        if !(gain.is_finite() && gain > 0.0) {
            return Err(WatchError::Setting("the gain"));
        }
        let arm = DynArm::from_robot(&robot.clone().with_rotors());
        let period = usual_step(&motion.time);
        Self::along(robot, &arm, motion, gain, period)
            .map_err(|WrongLength { expected, found, .. }| WatchError::Joints { expected, found })
    }

    fn along(robot: &Robot, arm: &DynArm, motion: &Motion, gain: f64, period: f64) -> Result<Self, WrongLength> {
        let (dof, samples) = (arm.dof(), motion.len());
        let lists = || vec![Vec::with_capacity(samples); dof];
        let (mut residual, mut external) = (lists(), lists());
        let (mut terms, mut inertia) = (lists(), lists());
        let (parameters, mut counted) = (arm.inertial_parameters(), 0.0);
        let (mut magnitudes, mut rows) = (Vec::new(), Vec::new());
        let mut settled = Vec::with_capacity(samples);
        let begun = || -> Vec<Friction> { robot.independent_joints().map(Friction::of).collect() };
        let mut frictions = begun();
        let mut observer = DynObserverState::new(dof, gain, period);
        let still = still(&motion.qd);
        let wait = 3.0 / (std::f64::consts::TAU * gain);
        let mut since = 0.0;
        for sample in 0..samples {
            let at_sample = |lists: &[Vec<f64>]| -> Vec<f64> { lists.iter().map(|list| list[sample]).collect() };
            let [q, qd, qdd, tau] = [&motion.q, &motion.qd, &motion.qdd, &motion.tau].map(|lists| at_sample(lists));
            let step = if sample == 0 { 0.0 } else { motion.time[sample] - motion.time[sample - 1] };
            if step > GAP * period {
                observer.reset();
                frictions = begun();
                since = 0.0;
            } else {
                since += step;
            }
            let states = q.iter().zip(&qd);
            let friction = frictions.iter_mut().zip(states).map(|(friction, (q, qd))| friction.next(*q, *qd));
            let friction: Vec<f64> = friction.collect();
            let model = arm.inverse_dynamics(&q, &qd, &qdd)?;
            if sample == 0 || motion.time[sample] - counted >= COUNTED {
                counted = motion.time[sample];
                magnitudes = magnitudes_of_terms(&arm.regressor(&q, &qd, &qdd)?, &parameters, &model);
                rows = arm.mass_matrix(&q)?.iter().map(|row| norm(row)).collect();
            }
            let net: Vec<f64> = tau.iter().zip(&friction).map(|(tau, friction)| tau - friction).collect();
            let seen = observer.update(arm, &q, &qd, &net)?;
            settled.push(since > wait);
            for joint in 0..dof {
                residual[joint].push(net[joint] - model[joint]);
                external[joint].push(seen[joint]);
                terms[joint].push(magnitudes[joint] + friction[joint].abs());
                inertia[joint].push(rows[joint]);
            }
        }
        let (mut open, mut creeps) = (Vec::with_capacity(dof), Vec::with_capacity(dof));
        for (joint, row) in robot.independent_joints().enumerate() {
            let now = left_open(row, &motion.qd[joint], still[joint]);
            creeps.push(creeping(&motion.time, &now));
            open.push(faded(&motion.time, &now, gain, FORGOTTEN * row.coulomb_span()));
        }
        let (time, measured) = (motion.time.clone(), motion.tau.clone());
        Ok(Self { time, period, measured, residual, external, open, creeps, terms, inertia, settled })
    }

    /// Returns every `stride`-th sample, for pictures of a long motion.
    #[must_use]
    pub fn thinned(&self, stride: usize) -> Self {
        fn of<T: Clone>(list: &[T], stride: usize) -> Vec<T> {
            list.iter().step_by(stride.max(1)).cloned().collect()
        }
        fn each<T: Clone>(lists: &[Vec<T>], stride: usize) -> Vec<Vec<T>> {
            lists.iter().map(|list| of(list, stride)).collect()
        }
        Self {
            time: of(&self.time, stride),
            period: self.period,
            measured: each(&self.measured, stride),
            residual: each(&self.residual, stride),
            external: each(&self.external, stride),
            open: each(&self.open, stride),
            creeps: each(&self.creeps, stride),
            terms: each(&self.terms, stride),
            inertia: each(&self.inertia, stride),
            settled: of(&self.settled, stride),
        }
    }

    /// Appends the samples of the next motion.
    pub fn append(&mut self, next: Self) {
        self.time.extend(next.time);
        self.settled.extend(next.settled);
        self.creeps.iter_mut().zip(next.creeps).for_each(|(list, next)| list.extend(next));
        let lists = [
            (&mut self.measured, next.measured),
            (&mut self.residual, next.residual),
            (&mut self.external, next.external),
            (&mut self.open, next.open),
            (&mut self.terms, next.terms),
            (&mut self.inertia, next.inertia),
        ];
        for (lists, next) in lists {
            lists.iter_mut().zip(next).for_each(|(list, next)| list.extend(next));
        }
    }

    /// The number of joints.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.residual.len()
    }

    /// Returns the prediction error of a joint: the root mean square of measured less predicted efforts, over the
    /// standard deviation of the measured effort. 0 means a perfect model, and 1 a model that is no better than the
    /// mean. `None` if the effort does not change.
    #[must_use]
    pub fn prediction_error(&self, joint: usize) -> Option<f64> {
        let (measured, residual) = (self.measured.get(joint)?, self.residual.get(joint)?);
        #[allow(clippy::cast_precision_loss)] // no log has 2⁵² samples
        let count = measured.len() as f64;
        let mean = measured.iter().sum::<f64>() / count;
        let spread = (measured.iter().map(|tau| (tau - mean).powi(2)).sum::<f64>() / count).sqrt();
        let error = (residual.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
        (spread > 0.0).then(|| error / spread)
    }
}

/// Returns for each joint the sum of the magnitudes of the terms that each parameter of each link adds to its torque.
fn magnitudes_of_terms(regressor: &[Vec<[f64; 10]>], parameters: &[[f64; 10]], model: &[f64]) -> Vec<f64> {
    let of_joint = |(row, model): (&Vec<[f64; 10]>, &f64)| {
        let terms = row.iter().flatten().zip(parameters.iter().flatten()).map(|(y, pi)| y * pi);
        let (links, magnitude) = terms.fold((0.0, 0.0), |(sum, most), term| (sum + term, most + f64::abs(term)));
        // the difference is the torque of the rotors
        magnitude + (model - links).abs()
    };
    regressor.iter().zip(model).map(of_joint).collect()
}

fn norm(row: &[f64]) -> f64 {
    row.iter().map(|number| number * number).sum::<f64>().sqrt()
}

/// Returns the uncertainty of friction at each sample: not zero where a joint creeps, and where it reverses between two
/// samples.
fn left_open(joint: &Joint, qd: &[f64], still: f64) -> Vec<f64> {
    let of_file = joint.coulomb_displacement.map(|_| SLIPPING).or(joint.coulomb_width).unwrap_or(0.0);
    let slow = CREEPING * of_file.max(still);
    let turns = |at: usize| {
        let beside = [at.checked_sub(1), Some(at + 1)].into_iter().flatten().filter_map(|at| qd.get(at));
        beside.into_iter().any(|other| other * qd[at] < 0.0)
    };
    let open = |at: usize| if qd[at].abs() > slow && !turns(at) { 0.0 } else { joint.coulomb_span() };
    (0..qd.len()).map(open).collect()
}

/// Whether friction is uncertain at a time, or shortly before or after.
fn creeping(time: &[f64], open: &[f64]) -> Vec<bool> {
    let spread = spread(open);
    let pass = |order: &mut dyn Iterator<Item = usize>| {
        let mut last = f64::INFINITY;
        let mut near = vec![false; time.len()];
        for at in order {
            if spread[at] > 0.0 {
                last = time[at];
            }
            near[at] = (time[at] - last).abs() <= SMEARED;
        }
        near
    };
    let (behind, before) = (pass(&mut (0..time.len())), pass(&mut (0..time.len()).rev()));
    behind.into_iter().zip(before).map(|(behind, before)| behind || before).collect()
}

/// Returns the largest value among the neighbouring samples over which the filter spreads it.
fn spread(open: &[f64]) -> Vec<f64> {
    let largest = |at: usize| {
        let near = &open[at.saturating_sub(SPREAD)..(at + SPREAD + 1).min(open.len())];
        near.iter().fold(0.0, |most: f64, open| most.max(*open))
    };
    (0..open.len()).map(largest).collect()
}

/// Returns the uncertainty of friction with the decay of the observer after it; it ends where it is less than `over`.
fn faded(time: &[f64], open: &[f64], gain: f64, over: f64) -> Vec<f64> {
    let mut open = spread(open);
    for at in 1..open.len() {
        let before = open[at - 1] * (-std::f64::consts::TAU * gain * (time[at] - time[at - 1])).exp();
        if before >= over {
            open[at] = open[at].max(before);
        }
    }
    open
}

/// Returns for each joint the speed below which it counts as at rest: a fiftieth of the 95th percentile of its speed.
fn still(qd: &[Vec<f64>]) -> Vec<f64> {
    let of_joint = |rates: &Vec<f64>| {
        let mut speeds: Vec<f64> = rates.iter().map(|rate| rate.abs()).collect();
        speeds.sort_unstable_by(f64::total_cmp);
        speeds.get(speeds.len() * 95 / 100).map_or(0.0, |speed| 0.02 * speed)
    };
    qd.iter().map(of_joint).collect()
}

/// Returns the median of the time steps.
fn usual_step(time: &[f64]) -> f64 {
    let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() { 1.0 } else { median(steps) }
}

/// Refuses a motion that cannot be watched.
///
/// # Errors
/// When the motion does not have `dof` joints, is too short, or has numbers that are not finite.
fn check(dof: usize, motion: &Motion) -> Result<(), WatchError> {
    let samples = motion.len();
    for (name, lists) in [("q", &motion.q), ("qd", &motion.qd), ("qdd", &motion.qdd), ("tau", &motion.tau)] {
        if lists.len() != dof {
            return Err(WatchError::Joints { expected: dof, found: lists.len() });
        }
        for (joint, list) in lists.iter().enumerate() {
            if list.len() != samples {
                return Err(WatchError::Length(name, joint + 1));
            }
            if let Some(sample) = list.iter().position(|number| !number.is_finite()) {
                return Err(WatchError::Sample(sample));
            }
        }
    }
    if let Some(sample) = motion.time.iter().position(|time| !time.is_finite()) {
        return Err(WatchError::Sample(sample));
    }
    if let Some(before) = motion.time.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(WatchError::Sample(before + 1));
    }
    if samples < FEWEST {
        return Err(WatchError::TooFew { found: samples, needed: FEWEST });
    }
    Ok(())
}
