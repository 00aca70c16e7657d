//! Compares the torques that a robot file predicts with the measured torques of a log.

use rne_logs::Motion;
use rne_machine::{CompiledArm, Function};
use rne_model::{Friction, Robot};

use crate::fit::information::{MotionError, checked};
use crate::fit::smoothing::Kernel;
use crate::motions::design::run;

/// States that are computed at once.
const WINDOW: usize = 4096;

/// Bounds of the four ranges of speed for which errors are given separately (at rest, very slow, slow, fast), rad/s or
/// m/s.
pub const SPEEDS: [f64; 3] = [0.02, 0.1, 0.5];

/// Longest gap between states of one standstill, in intervals between states.
const GAP: f64 = 4.0;

/// Comparison of the torques of a robot file with those of logs, in memory that does not grow with them.
#[derive(Clone, Debug)]
pub struct Prediction {
    robot: Robot,
    arm: CompiledArm,
    cutoff: Option<f64>,
    sums: Vec<Sums>,
}

/// Differences between the predicted and measured torques of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointError {
    /// Root mean square of measured minus predicted torques, both after the same low-pass filter, over the standard
    /// deviation of the measured effort. Only states are used around which the log has samples for the whole kernel of
    /// the filter, unless the log is shorter than the kernel.
    pub error: f64,
    /// Root mean square of recorded minus predicted torques, over the standard deviation of the recorded effort. All
    /// states are used, and the efforts of the log are not filtered.
    pub unfiltered: f64,
    /// The error of predictions without the low-pass filter against efforts after the log's own filter, whose cut-off
    /// is higher.
    pub as_read: f64,
    /// Root mean square of measured minus predicted torques after the low-pass filter, N m or N.
    pub residual: f64,
    /// Standard deviation of the measured effort, N m or N.
    pub deviation: f64,
    /// Root mean square of the residual, N m or N, in each range of speed that [`SPEEDS`] bound; NaN for ranges in
    /// which the joint never was.
    pub by_speed: [f64; 4],
    /// Part of the squared residual at speeds up to the first of [`SPEEDS`], 0 to 1.
    pub part_at_rest: f64,
    /// Longest standstill of the joint: no speed is above the first of [`SPEEDS`]. `None` if it never stood still.
    pub standstill: Option<Standstill>,
    /// Number of states.
    pub states: u64,
}

impl JointError {
    /// Returns the error at speeds above the first of [`SPEEDS`], over the standard deviation of the measured effort of
    /// all states; `None` if the joint never moved.
    #[must_use]
    pub fn in_motion(&self) -> Option<f64> {
        let Self { error, residual, by_speed: [at_rest, ..], part_at_rest, .. } = *self;
        let squared = residual * residual;
        // part of the states at which the joint was at rest
        let rest = if at_rest > 0.0 { part_at_rest * squared / (at_rest * at_rest) } else { 0.0 };
        let in_motion = (1.0 - part_at_rest) / (1.0 - rest);
        (rest < 1.0 && in_motion.is_finite() && in_motion >= 0.0).then(|| error * in_motion.sqrt())
    }
}

/// An interval of time in which a joint stood still.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Standstill {
    /// Time of the first state of the standstill in the log, s.
    pub start: f64,
    /// Time of the last state of the standstill in the log, s.
    pub end: f64,
}

impl Standstill {
    /// The duration of the standstill, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    states: u64,
    measured: Deviation,
    recorded: Deviation,
    unfiltered: f64,
    as_read: f64,
    inner: u64,
    filtered: f64,
    by_speed: [(u64, f64); 4],
    longest: Option<Standstill>,
    /// The standstill that lasted until the latest state and may continue.
    current: Option<Standstill>,
}

/// The standard deviation of a series of numbers, updated number by number.
#[derive(Clone, Copy, Debug, Default)]
struct Deviation {
    mean: f64,
    /// The sum of squared differences from the mean.
    squares: f64,
}

/// For each joint, measured and predicted torques after the low-pass filter.
type Pairs = Vec<Vec<(f64, f64)>>;

impl Prediction {
    /// Sets up predictions by a robot with its rotors and friction. Measured and predicted torques pass a low-pass
    /// filter of this cut-off, Hz; none without a cut-off.
    #[must_use]
    pub fn new(robot: &Robot, cutoff: Option<f64>) -> Self {
        let arm = CompiledArm::from_robot(&robot.clone().with_rotors());
        Self { robot: robot.clone(), arm, cutoff, sums: vec![Sums::default(); robot.dof()] }
    }

    /// Predicts the torques of each joint along a motion, N m or N: inverse dynamics with rotors, and friction.
    ///
    /// # Errors
    /// When the motion is of another robot.
    pub fn torques(&self, motion: &Motion) -> Result<Vec<Vec<f64>>, MotionError> {
        checked(self.robot.dof(), motion)?;
        let mut torques = vec![vec![0.0; motion.len()]; self.robot.dof()];
        for start in (0..motion.len()).step_by(WINDOW) {
            let range = start..motion.len().min(start + WINDOW);
            let columns = torques.iter_mut().map(|torques| &mut torques[range.clone()]).collect();
            run(&self.arm, Function::InverseDynamics, motion, range, columns)?;
        }
        for (at, (torques, joint)) in torques.iter_mut().zip(self.robot.independent_joints()).enumerate() {
            let mut friction = Friction::of(joint);
            for ((torque, position), speed) in torques.iter_mut().zip(&motion.q[at]).zip(&motion.qd[at]) {
                *torque += friction.next(*position, *speed);
            }
        }
        Ok(torques)
    }

    /// Returns measured and predicted torques of a motion after the low-pass filter, for each joint.
    ///
    /// # Errors
    /// When the motion is of another robot.
    pub fn pairs(&self, motion: &Motion) -> Result<Pairs, MotionError> {
        let predicted = self.torques(motion)?;
        Ok(self.smoothed(motion, &predicted))
    }

    fn smoothed(&self, motion: &Motion, predicted: &[Vec<f64>]) -> Pairs {
        let both = motion.tau.iter().zip(predicted);
        let Some(kernel) = self.cutoff.map(Kernel::of_cutoff) else {
            return both.map(|(tau, of)| tau.iter().copied().zip(of.iter().copied()).collect()).collect();
        };
        let mut pairs: Pairs = vec![Vec::with_capacity(motion.len()); self.robot.dof()];
        for instant in &motion.time {
            let weights = kernel.about(&motion.time, *instant);
            for ((pairs, tau), predicted) in pairs.iter_mut().zip(&motion.tau).zip(predicted) {
                pairs.push((weights.of(tau), weights.of(predicted)));
            }
        }
        pairs
    }

    /// Adds a motion to the errors.
    ///
    /// # Errors
    /// When the motion is of another robot; nothing has been added then.
    pub fn absorb(&mut self, motion: &Motion) -> Result<(), MotionError> {
        let predicted = self.torques(motion)?;
        let pairs = self.smoothed(motion, &predicted);
        let inner = self.inner(&motion.time);
        let recorded = if motion.recorded.is_empty() { &motion.tau } else { &motion.recorded };
        for (joint, sums) in self.sums.iter_mut().enumerate() {
            sums.take_speeds(&motion.time, &motion.qd[joint]);
            for (at, (measured, of)) in pairs[joint].iter().enumerate() {
                sums.take(motion.tau[joint][at], recorded[joint][at], predicted[joint][at]);
                if inner.contains(&at) {
                    sums.take_filtered(measured - of, motion.qd[joint][at].abs());
                }
            }
        }
        Ok(())
    }

    /// Returns the states around which the log has samples for the whole kernel; all states if there are no such
    /// states.
    fn inner(&self, time: &[f64]) -> std::ops::Range<usize> {
        let reach = self.cutoff.map_or(0.0, |cutoff| Kernel::of_cutoff(cutoff).reach());
        let (Some(first), Some(last)) = (time.first(), time.last()) else { return 0..0 };
        let start = time.partition_point(|time| *time < first + reach);
        let end = time.partition_point(|time| *time <= last - reach);
        if start < end { start..end } else { 0..time.len() }
    }

    /// Returns the error of each joint over all motions.
    #[must_use]
    pub fn errors(&self) -> Vec<JointError> {
        self.sums.iter().map(Sums::error).collect()
    }
}

/// Returns the errors of a robot file over motions: for each joint the root mean square of measured minus predicted
/// torques, both after a low-pass filter of this cut-off, Hz, over the standard deviation of the measured effort.
///
/// # Errors
/// When a motion is of another robot.
pub fn prediction_errors<'a>(
    robot: &Robot,
    motions: impl IntoIterator<Item = &'a Motion>,
    cutoff: Option<f64>,
) -> Result<Vec<JointError>, MotionError> {
    let mut prediction = Prediction::new(robot, cutoff);
    for motion in motions {
        prediction.absorb(motion)?;
    }
    Ok(prediction.errors())
}

impl Deviation {
    /// Updates the deviation by a number, the `count`-th of the series. B. P. Welford, Technometrics 4, 1962.
    #[allow(clippy::cast_precision_loss)] // fewer than 2⁵³ states
    fn take(&mut self, number: f64, count: u64) {
        let from = number - self.mean;
        self.mean += from / count as f64;
        self.squares += from * (number - self.mean);
    }
}

impl Sums {
    fn take(&mut self, tau: f64, recorded: f64, predicted: f64) {
        self.states += 1;
        self.measured.take(tau, self.states);
        self.recorded.take(recorded, self.states);
        self.unfiltered += (recorded - predicted).powi(2);
        self.as_read += (tau - predicted).powi(2);
    }

    fn take_filtered(&mut self, filtered: f64, speed: f64) {
        self.inner += 1;
        self.filtered += filtered * filtered;
        let (states, squares) = &mut self.by_speed[SPEEDS.partition_point(|most| *most < speed)];
        *states += 1;
        *squares += filtered * filtered;
    }

    #[allow(clippy::cast_precision_loss)]
    fn take_speeds(&mut self, time: &[f64], speeds: &[f64]) {
        let step = match time {
            [first, .., last] => (last - first) / (time.len() - 1) as f64,
            _ => 0.0,
        };
        for (time, speed) in time.iter().zip(speeds) {
            if speed.abs() > SPEEDS[0] {
                self.current = None;
                continue;
            }
            let follows = |standstill: &Standstill| (0.0..=GAP * step).contains(&(time - standstill.end));
            let start = self.current.filter(follows).map_or(*time, |standstill| standstill.start);
            let current = Standstill { start, end: *time };
            self.current = Some(current);
            if self.longest.is_none_or(|longest| longest.duration() < current.duration()) {
                self.longest = Some(current);
            }
        }
    }

    #[allow(clippy::cast_precision_loss)]
    fn error(&self) -> JointError {
        let root = |sum: f64, states: u64| (sum / states as f64).sqrt();
        let deviation = root(self.measured.squares, self.states);
        let residual = root(self.filtered, self.inner);
        JointError {
            error: residual / deviation,
            unfiltered: root(self.unfiltered, self.states) / root(self.recorded.squares, self.states),
            as_read: root(self.as_read, self.states) / deviation,
            residual,
            deviation,
            by_speed: self.by_speed.map(|(states, squares)| root(squares, states)),
            part_at_rest: if self.filtered > 0.0 { self.by_speed[0].1 / self.filtered } else { 0.0 },
            standstill: self.longest,
            states: self.states,
        }
    }
}
