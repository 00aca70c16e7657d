//! Motions of an arm: samples of positions, velocities and accelerations.

use std::fmt;

use rne_model::{JointKind, Robot};

/// Samples of a motion. Lists run from base to tip, in rad or m, rad/s or m/s, and rad/s² or m/s².
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trajectory {
    /// Times, s, each later than the one before.
    pub time: Vec<f64>,
    /// Positions, a list for each time.
    pub q: Vec<Vec<f64>>,
    /// Velocities, a list for each time.
    pub qd: Vec<Vec<f64>>,
    /// Accelerations, a list for each time.
    pub qdd: Vec<Vec<f64>>,
}

/// The reason why a trajectory is not valid.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TrajectoryError {
    /// There are too few samples.
    TooFew {
        /// Number of samples that were given.
        found: usize,
        /// Number of samples that are needed.
        needed: usize,
    },
    /// The time of the sample with this index is not later than the previous one, or is not a number.
    Time(usize),
    /// A list of the sample with this index has another length.
    Length(usize),
    /// A number of the sample with this index is not finite.
    NotFinite(usize),
    /// The duration is not above 0.
    Duration,
}

impl fmt::Display for TrajectoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { found, needed } => write!(f, "{found} samples, but at least {needed} are needed"),
            Self::Time(sample) => write!(f, "the time of sample {} is not later than that before it", sample + 1),
            Self::Length(sample) => write!(f, "sample {} does not have one number for each joint", sample + 1),
            Self::NotFinite(sample) => write!(f, "a number of sample {} is not finite", sample + 1),
            Self::Duration => f.write_str("a duration is a number above 0, in seconds"),
        }
    }
}

impl std::error::Error for TrajectoryError {}

/// Columns of numbers, one list for each sample.
type Samples = Vec<Vec<f64>>;

impl Trajectory {
    /// Makes a trajectory from samples. Missing velocities or accelerations are derived: each joint moves on the
    /// parabola through a sample and its two neighbours (at the ends, through the three samples there). If velocities
    /// are given, accelerations follow from the parabola through them.
    ///
    /// # Errors
    /// When lengths of lists do not fit, times do not increase, a number is not finite, or there are fewer than two
    /// samples, or fewer than three if something is derived.
    pub fn new(time: Vec<f64>, q: Samples, qd: Option<Samples>, qdd: Option<Samples>) -> Result<Self, TrajectoryError> {
        let needed = if qd.is_some() && qdd.is_some() { 2 } else { 3 };
        if time.len() < needed {
            return Err(TrajectoryError::TooFew { found: time.len(), needed });
        }
        let joints = q.first().map_or(0, Vec::len);
        for samples in [Some(&q), qd.as_ref(), qdd.as_ref()].into_iter().flatten() {
            if let Some(at) = samples.iter().position(|sample| sample.len() != joints) {
                return Err(TrajectoryError::Length(at));
            }
            if samples.len() != time.len() {
                return Err(TrajectoryError::Length(samples.len().min(time.len())));
            }
            if let Some(at) = samples.iter().position(|sample| sample.iter().any(|number| !number.is_finite())) {
                return Err(TrajectoryError::NotFinite(at));
            }
        }
        let grows = |pair: &[f64]| pair[0].is_finite() && pair[1].is_finite() && pair[1] > pair[0];
        if let Some(at) = time.windows(2).position(|pair| !grows(pair)) {
            return Err(TrajectoryError::Time(at + 1));
        }
        let (first, second) = match (&qd, &qdd) {
            (Some(_), Some(_)) => (None, None),
            (Some(qd), None) => (None, Some(parabolas(&time, qd).0)),
            (None, _) => {
                let (first, second) = parabolas(&time, &q);
                (Some(first), Some(second))
            }
        };
        let qd = qd.or(first).unwrap_or_default();
        let qdd = qdd.or(second).unwrap_or_default();
        Ok(Self { time, q, qd, qdd })
    }

    /// Makes a motion from rest to rest in `duration` seconds, for all joints at the same time. It is the polynomial of
    /// fifth degree whose speed and acceleration vanish at both ends: q = a + (b - a)(10 s³ - 15 s⁴ + 6 s⁵), s = t /
    /// duration.
    ///
    /// # Errors
    /// When the lengths of the postures differ, the duration is not above 0, or there are fewer than two samples.
    pub fn quintic(from: &[f64], to: &[f64], duration: f64, samples: usize) -> Result<Self, TrajectoryError> {
        if !(duration.is_finite() && duration > 0.0) {
            return Err(TrajectoryError::Duration);
        }
        if samples < 2 {
            return Err(TrajectoryError::TooFew { found: samples, needed: 2 });
        }
        if from.len() != to.len() {
            return Err(TrajectoryError::Length(0));
        }
        #[allow(clippy::cast_precision_loss)] // fewer than 2⁵² samples
        let parts: Vec<f64> = (0..samples).map(|index| index as f64 / (samples - 1) as f64).collect();
        let along = |start: f64, shape: &dyn Fn(f64) -> f64, unit: f64| -> Samples {
            let at = |s: f64| {
                let scale = shape(s) / unit;
                from.iter().zip(to).map(|(a, b)| start * a + (b - a) * scale).collect()
            };
            parts.iter().map(|&s| at(s)).collect()
        };
        let q = along(1.0, &|s| s * s * s * (10.0 + s * (6.0 * s - 15.0)), 1.0);
        let qd = along(0.0, &|s| 30.0 * s * s * (1.0 - s) * (1.0 - s), duration);
        let qdd = along(0.0, &|s| 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s), duration * duration);
        let time = parts.iter().map(|s| s * duration).collect();
        Self::new(time, q, Some(qd), Some(qdd))
    }

    /// Returns two postures of a robot well inside its limits: at a quarter and at three quarters of each joint's
    /// range. A joint without limits moves from -45° to 45°, or from -0.1 m to 0.1 m. If the range is more than a turn,
    /// the turn in its middle is used.
    #[must_use]
    pub fn postures(robot: &Robot) -> [Vec<f64>; 2] {
        use std::f64::consts::{FRAC_PI_2, PI};
        let range = |joint: &rne_model::Joint| {
            let turns = joint.row.kind == JointKind::Revolute;
            let (lower, upper) =
                joint.limits.position.unwrap_or(if turns { (-FRAC_PI_2, FRAC_PI_2) } else { (-0.2, 0.2) });
            let middle = f64::midpoint(lower, upper);
            let half = (upper - lower) / 2.0;
            let half = if turns { half.min(PI) } else { half };
            (middle - half / 2.0, middle + half / 2.0)
        };
        let (from, to) = robot.independent_joints().map(range).unzip();
        [from, to]
    }

    /// Returns the shortest duration, s, of a [quintic](Self::quintic) from one posture to another within the speed
    /// limits of a robot; 0 if the robot has no limits.
    #[must_use]
    pub fn least_duration(robot: &Robot, from: &[f64], to: &[f64]) -> f64 {
        // the quintic is fastest in its middle
        const FASTEST: f64 = 15.0 / 8.0;
        let duration = |(joint, (from, to)): (&rne_model::Joint, (&f64, &f64))| {
            let limit = joint.limits.velocity.filter(|limit| *limit > 0.0)?;
            Some(FASTEST * (to - from).abs() / limit)
        };
        robot.independent_joints().zip(from.iter().zip(to)).filter_map(duration).fold(0.0, f64::max)
    }
}

/// Returns first and second derivatives of the parabolas through each sample and its neighbours.
fn parabolas(time: &[f64], values: &[Vec<f64>]) -> (Samples, Samples) {
    let last = time.len() - 1;
    let at = |sample: usize| {
        let middle = sample.clamp(1, last - 1);
        let [t0, t1, t2] = [time[middle - 1], time[middle], time[middle + 1]];
        let t = time[sample];
        let joints = values[middle - 1].iter().zip(&values[middle]).zip(&values[middle + 1]);
        joints
            .map(|((a, b), c)| {
                // Newton's form of the parabola: two slopes, and their difference
                let (left, right) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
                let curvature = (right - left) / (t2 - t0);
                (left + curvature * ((t - t0) + (t - t1)), 2.0 * curvature)
            })
            .unzip()
    };
    (0..time.len()).map(at).unzip()
}
