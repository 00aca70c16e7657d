//! Finds a motion that excites an arm. Of the Fourier series within the limits that were tried, it is the one whose
//! regressor has the smallest condition number, unless it leaves more parameters unexcited than others do.
//!
//! The search has rounds: random starts, then a (1+1) evolution strategy from the best of them (I. Rechenberg,
//! Evolutionsstrategie, 1973). A change of all joints or of one joint is kept if the motion is not worse, and changes
//! become larger if more than one of five is kept. Position, speed and acceleration limits are not a penalty: a series
//! that exceeds them is scaled about its centre, and its centre is moved, until it is inside. Effort limits cannot be
//! met in this way: a motion that exceeds them is worse than all motions that do not.

use rne_machine::EvaluationError;
use rne_model::{Robot, one_line};

use crate::fit::identification::UNKNOWN;
use crate::motions::design::{Design, Quality};
use crate::motions::effort::Effort;
use crate::motions::excitation_error::ExcitationError;
use crate::motions::fourier::{Fourier, Grid, MotionBounds, Series, beyond, largest, range};
use crate::motions::motion_limits::MotionLimits;
use crate::motions::random::Random;

/// Number of rounds, each with new random starts and at least `ROUND` evaluations.
const ROUNDS: u64 = 5;
const ROUND: u64 = 500;
/// One of this many evaluations of a round is a random start.
const STARTS: u64 = 10;
/// Standard deviation of the first change of the coefficients, whose magnitude is about 1.
const FIRST: f64 = 0.3;
/// Factors of the change after a success and after a failure; four failures undo one success.
const GROWTH: f64 = 1.5;
const DECAY: f64 = 0.903_602_003_6;
/// Smallest standard deviation of the change of a coefficient.
const SMALLEST: f64 = 1e-4;

/// Options of the search for a motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ExcitationOptions {
    /// The period of the motion, s.
    pub period: f64,
    /// Number of harmonics of each joint's series, 2 or more.
    pub harmonics: usize,
    /// Number of motions that are tried.
    pub evaluations: u64,
    /// The seed of the random numbers.
    pub seed: u64,
    /// Whether friction is among the unknowns.
    pub friction: bool,
    /// Whether the inertia of rotors is among the unknowns.
    pub rotors: bool,
}

impl Default for ExcitationOptions {
    fn default() -> Self {
        Self { period: 20.0, harmonics: 5, evaluations: 5000, seed: 1, friction: true, rotors: false }
    }
}

/// Progress of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ExcitationProgress {
    /// Number of motions that were tried.
    pub evaluations: u64,
    /// The condition number of the best motion so far; infinite before one is within the effort limits.
    pub condition: f64,
    /// Number of base parameters that the best motion so far would excite.
    pub excited: usize,
}

/// A motion that excites an arm, with a report on it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Excitation {
    /// The motion, over one period.
    pub motion: Fourier,
    /// The condition number of the first motion within the effort limits that was tried. The search computes it from
    /// products of the columns, which are exact to half the digits.
    pub first_condition: f64,
    /// Condition number of the motion: largest over smallest singular value of the columns of base parameters and
    /// friction, each scaled to length one. Rows of a joint are divided by its effort limit where every joint has one.
    pub condition: f64,
    /// Number of instants of a period for which there are rows, evenly spaced from its start on.
    pub instants: usize,
    /// The use that each joint makes of its limits.
    pub joints: Vec<JointUse>,
    /// The precision of every base parameter, base to tip, then rotors.
    pub bases: Vec<BaseExcitation>,
    /// Number of motions that were tried.
    pub evaluations: u64,
}

/// The use that a joint makes of its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointUse {
    /// The limits of the joint's motion.
    pub limits: MotionLimits,
    /// Position in which the motion starts and ends, rad or m.
    pub start: f64,
    /// Bounds of the whole motion.
    pub bounds: MotionBounds,
    /// The largest torque that the file predicts, N m or N; `None` if the effort of the joint is not limited.
    pub effort: Option<f64>,
}

/// Precision with which a log of the motion would determine a base parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseExcitation {
    /// Name of the parameter that represents the base parameter, such as `Jzz2`.
    pub name: String,
    /// The linear combination, such as `Jzz2 + 0.3745 m3`.
    pub combination: String,
    /// The unit, such as `kg m²`.
    pub unit: &'static str,
    /// The standard deviation from a log of one period if the noise of all rows were independent. The assumed noise is
    /// 1 % of the effort limits or, if not every joint has one, 5 % of the torque for plausible links, root mean
    /// square.
    pub deviation: f64,
    /// The magnitude of the base parameter for plausible links.
    pub plausible: f64,
}

impl BaseExcitation {
    /// Whether a log of the motion would determine the base parameter, by the rule of an identification.
    #[must_use]
    pub fn is_excited(&self) -> bool {
        self.deviation < UNKNOWN * self.plausible
    }
}

/// Score of a motion; lower is better. The part by which it exceeds effort limits is compared first.
///
/// The condition number does not depend on the lengths of the columns, so a motion that hardly moves can have a good
/// one. Therefore, it is multiplied by the geometric mean, over the base parameters, of the factor by which their
/// uncertainty is too large; the factor is one for a parameter that is excited.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Score {
    beyond: f64,
    merit: f64,
}

/// A point of the search: for each joint its centre, as a part of the half range from the middle, then a and b of its
/// series, in multiples of the [unit](Problem::units).
type Point = Vec<f64>;

struct Problem<'a> {
    options: &'a ExcitationOptions,
    limits: &'a [MotionLimits],
    design: Design,
    effort: Option<Effort>,
    grid: Grid,
    /// For each joint, the value of a coefficient of 1, rad/s or m/s.
    units: Vec<f64>,
}

/// A motion that was tried.
#[derive(Clone)]
struct Tried {
    point: Point,
    motion: Fourier,
    score: Score,
    /// `None` if the motion exceeds the effort limits.
    quality: Option<Quality>,
}

/// Searches for a motion that excites an arm. `watch` is called after each motion that was tried; if it returns
/// `false`, the search ends with the best motion so far. The same arguments give the same motion, however fast the
/// machine.
///
/// # Errors
/// When the options are not valid, when the number of limits is not that of the joints, when no motion was found within
/// the effort limits, when no motion distinguishes all base parameters, or when the equations cannot be computed.
pub fn excite(
    robot: &Robot,
    limits: &[MotionLimits],
    options: &ExcitationOptions,
    watch: &mut dyn FnMut(&ExcitationProgress) -> bool,
) -> Result<Excitation, ExcitationError> {
    let problem = Problem::new(robot, limits, options)?;
    let mut random = Random::new(options.seed);
    let round = (options.evaluations / ROUNDS).max(ROUND);
    let starts = (round / STARTS).max(1);
    let mut best = problem.tried(problem.start(&mut random))?;
    let mut current = best.clone();
    let mut first = best.condition();
    let mut step = FIRST;
    let mut evaluations = 1;
    loop {
        let progress = ExcitationProgress { evaluations, condition: best.condition(), excited: problem.excited(&best) };
        if !watch(&progress) || evaluations >= options.evaluations {
            break;
        }
        let in_round = evaluations % round;
        let is_start = in_round < starts;
        let point =
            if is_start { problem.start(&mut random) } else { problem.changed(&current.point, step, &mut random) };
        let tried = problem.tried(point)?;
        evaluations += 1;
        if first.is_infinite() {
            first = tried.condition();
        }
        if tried.score < best.score {
            best = tried.clone();
        }
        let is_better = in_round == 0 || tried.score <= current.score;
        if is_better {
            current = tried;
        }
        step = if is_start { FIRST } else { (step * if is_better { GROWTH } else { DECAY }).clamp(SMALLEST, FIRST) };
    }
    problem.result(robot, &best, first, evaluations)
}

impl Tried {
    fn condition(&self) -> f64 {
        self.quality.as_ref().map_or(f64::INFINITY, |quality| quality.condition)
    }
}

impl<'a> Problem<'a> {
    fn new(robot: &Robot, limits: &'a [MotionLimits], options: &'a ExcitationOptions) -> Result<Self, ExcitationError> {
        if !(options.period.is_finite() && options.period > 0.0) {
            return Err(ExcitationError::Period);
        }
        if options.harmonics < 2 {
            return Err(ExcitationError::Harmonics);
        }
        if limits.len() != robot.dof() {
            return Err(ExcitationError::Length { what: "limits", found: limits.len(), joints: robot.dof() });
        }
        let frequency = std::f64::consts::TAU / options.period;
        let unit = |limits: &MotionLimits| {
            let half = 0.5 * (limits.position.1 - limits.position.0);
            limits.velocity.min(limits.acceleration / frequency).min(half * frequency)
        };
        Ok(Self {
            options,
            limits,
            design: Design::new(robot, limits, options.harmonics, options.friction, options.rotors),
            effort: Effort::of(robot, limits, options.harmonics),
            grid: Grid::dense(options.harmonics),
            units: limits.iter().map(unit).collect(),
        })
    }

    fn coordinates(&self) -> usize {
        1 + 2 * self.options.harmonics
    }

    /// Returns a random point with large coefficients, so that every joint reaches one of its limits.
    fn start(&self, random: &mut Random) -> Point {
        let own = self.coordinates();
        let coordinate = |at: usize| if at.is_multiple_of(own) { random.number() } else { random.bell() };
        (0..own * self.limits.len()).map(coordinate).collect()
    }

    /// Returns a point with random changes of all joints or of one joint.
    fn changed(&self, point: &Point, step: f64, random: &mut Random) -> Point {
        let own = self.coordinates();
        let joint = random.below(2 * self.limits.len());
        let mut changed = point.clone();
        for (at, coordinate) in changed.iter_mut().enumerate() {
            if joint >= self.limits.len() || at / own == joint {
                *coordinate += step * random.bell();
            }
        }
        changed
    }

    /// Returns the motion of a point, scaled and moved into all limits except those of effort; changes the point
    /// accordingly.
    fn motion(&self, point: &mut Point) -> Fourier {
        let own = self.coordinates();
        let series = point.chunks_mut(own).zip(self.limits).zip(&self.units).map(|((point, limits), unit)| {
            let (centre, coefficients) = point.split_at_mut(1);
            let (a, b) = coefficients.split_at_mut(self.options.harmonics);
            let times = |list: &[f64]| list.iter().map(|x| x * unit).collect::<Vec<f64>>();
            let series = Series::at_rest(0.0, times(a), times(b));
            let states = series.on(&self.grid, self.options.period);
            let (lowest, highest) = range(&states);
            let (lower, upper) = limits.position;
            let (middle, half) = (f64::midpoint(lower, upper), 0.5 * (upper - lower));
            // reduced, so that the extremes between the points of the grid are also inside
            let room = half / beyond();
            let most = |limit: f64, used: f64| if used > limit { limit / used } else { 1.0 };
            let factor = most(room, 0.5 * (highest - lowest))
                .min(most(limits.velocity / beyond(), largest(&states, 1)))
                .min(most(limits.acceleration / beyond(), largest(&states, 2)));
            let mut series = series.scaled(factor);
            let (least, greatest) = (middle - room - factor * lowest, middle + room - factor * highest);
            // `least.min`: rounding may make `least` larger than `greatest`
            series.centre = (middle + half * centre[0]).min(greatest).max(least.min(greatest));
            centre[0] = (series.centre - middle) / half;
            for (list, of_series) in [(a, &series.a), (b, &series.b)] {
                list.iter_mut().zip(of_series).for_each(|(x, value)| *x = value / unit);
            }
            series
        });
        Fourier::new(self.options.period, series.collect())
    }

    fn tried(&self, mut point: Point) -> Result<Tried, EvaluationError> {
        let motion = self.motion(&mut point);
        let beyond = match &self.effort {
            Some(effort) => {
                let uses = effort.largest(&motion)?;
                let parts = uses.iter().zip(self.limits).map(|(most, limits)| most / limits.effort.unwrap_or(f64::MAX));
                (parts.fold(0.0, f64::max) - 1.0).max(0.0)
            }
            None => 0.0,
        };
        // a motion that exceeds effort limits needs no condition number
        let quality = if beyond > 0.0 { None } else { Some(self.design.quality(&motion)?) };
        let merit = quality.as_ref().map_or(f64::INFINITY, |quality| quality.condition * self.shortfall(quality));
        Ok(Tried { point, motion, score: Score { beyond, merit }, quality })
    }

    /// Returns the standard deviation of each base parameter, over the largest one with which it counts as excited.
    fn uncertainties(&self, quality: &Quality) -> impl Iterator<Item = f64> {
        quality
            .deviations
            .iter()
            .zip(self.design.scales().iter())
            .map(|(deviation, scale)| deviation / (UNKNOWN * scale))
    }

    fn shortfall(&self, quality: &Quality) -> f64 {
        #[allow(clippy::cast_precision_loss)] // some dozens
        let count = quality.deviations.len().max(1) as f64;
        (self.uncertainties(quality).map(|times| times.max(1.0).ln()).sum::<f64>() / count).exp()
    }

    fn excited(&self, tried: &Tried) -> usize {
        tried.quality.as_ref().map_or(0, |quality| self.uncertainties(quality).filter(|times| *times < 1.0).count())
    }

    fn result(
        &self,
        robot: &Robot,
        best: &Tried,
        first_condition: f64,
        evaluations: u64,
    ) -> Result<Excitation, ExcitationError> {
        let motion = &best.motion;
        let efforts = self.effort.as_ref().map(|effort| effort.largest(motion)).transpose()?;
        let start = motion.after(0.0)[0].clone();
        let uses = motion.bounds().into_iter().zip(self.limits).enumerate().map(|(at, (bounds, limits))| JointUse {
            limits: *limits,
            start: start[at],
            bounds,
            effort: limits.effort.and(efforts.as_ref()).map(|efforts| efforts[at]),
        });
        let joints: Vec<JointUse> = uses.collect();
        let over = |(joint, used): (&rne_model::Joint, &JointUse)| {
            let (needed, limit) = (used.effort?, used.limits.effort?);
            (needed > limit).then(|| (needed / limit, one_line(&joint.name), needed, limit))
        };
        let worst = robot.independent_joints().zip(&joints).filter_map(over).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, joint, needed, limit)) = worst {
            return Err(ExcitationError::Effort { joint, needed, limit });
        }
        let Quality { condition, deviations } = self.design.quality(motion)?;
        if !condition.is_finite() {
            return Err(ExcitationError::Indistinct);
        }
        let bases = &self.design.structure().parameters().bases;
        let bases = bases.iter().zip(deviations).zip(self.design.scales().iter());
        let bases = bases.map(|((base, deviation), plausible)| BaseExcitation {
            name: base.name(),
            combination: base.combination(),
            unit: self.design.structure().unit(base.kept),
            deviation,
            plausible: *plausible,
        });
        Ok(Excitation {
            motion: motion.clone(),
            first_condition,
            condition: self.design.condition(motion)?,
            instants: self.design.instants(),
            joints,
            bases: bases.collect(),
            evaluations,
        })
    }
}
