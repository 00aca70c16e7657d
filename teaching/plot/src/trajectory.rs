//! Motions of an arm: samples of positions, velocities and accelerations.

use std::fmt;

use rne_model::{JointKind, Robot};

/// Samples of a motion; lists run from base to tip, rad or m, and per second.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trajectory {
    /// Times, s, each later than the one before.
    pub time: Vec<f64>,
    /// Positions, a list for each time.
    pub q: Vec<Vec<f64>>,
    /// Velocities.
    pub qd: Vec<Vec<f64>>,
    /// Accelerations.
    pub qdd: Vec<Vec<f64>>,
}

/// Why there is no such trajectory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TrajectoryError {
    /// Fewer samples than there must be.
    TooFew {
        /// Numbers that were found.
        found: usize,
        /// Numbers that are needed.
        needed: usize,
    },
    /// A time that is not later than the one before it, or is no number: the index of its sample.
    Time(usize),
    /// A list of another length: the index of its sample.
    Length(usize),
    /// A number that is not finite: the index of its sample.
    NotFinite(usize),
    /// A duration that is not above 0.
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
    /// A trajectory of samples. Where velocities or accelerations are not given they are derived: each joint moves on
    /// the parabola through a sample and its two neighbours (at the ends, through the three samples there); with
    /// velocities, these are what the parabola is of.
    ///
    /// # Errors
    /// When lists do not fit, times do not grow, a number is not finite, or there are fewer than two samples, three
    /// where something is derived.
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

    /// From rest to rest in `duration` seconds, all joints in step, on the polynomial of fifth degree whose speed and
    /// acceleration vanish at both ends: q = a + (b - a)(10 s³ - 15 s⁴ + 6 s⁵), s = t / duration.
    ///
    /// # Errors
    /// When the postures are of other lengths, the duration is not above 0, or there are fewer than two samples.
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

    /// Two postures of a robot that are well inside its limits: at a quarter and at three quarters of the way between
    /// them. A joint without limits turns from -45° to 45°, or slides from -0.1 m to 0.1 m; one that has more than a
    /// turn uses the turn in the middle of it.
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

    /// The least duration, in seconds, in which a [quintic](Self::quintic) leads from one posture to another within
    /// the speed limits of a robot; 0 if the robot has no limits.
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

/// First and second derivatives of the parabolas through each sample and its neighbours.
fn parabolas(time: &[f64], values: &[Vec<f64>]) -> (Samples, Samples) {
    let last = time.len() - 1;
    let at = |sample: usize| {
        let middle = sample.clamp(1, last - 1);
        let [t0, t1, t2] = [time[middle - 1], time[middle], time[middle + 1]];
        let t = time[sample];
        let joints = values[middle - 1].iter().zip(&values[middle]).zip(&values[middle + 1]);
        joints
            .map(|((a, b), c)| {
                // Newton's form: slopes, and how they change
                let (left, right) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
                let curvature = (right - left) / (t2 - t0);
                (left + curvature * ((t - t0) + (t - t1)), 2.0 * curvature)
            })
            .unzip()
    };
    (0..time.len()).map(at).unzip()
}
