//! Reads a log once: its states, and where runs begin.

use std::fmt;

use crate::columns::quantity::Quantity;
use crate::formats::sample::Sample;
use crate::log::chain::Chain;
use crate::log::joints::{Joints, Presence};
use crate::signal::spikes::Spike;
use crate::{Log, LogError};

impl Log {
    pub(crate) fn pass(&self) -> Result<Pass<'_>, LogError> {
        Pass::of(self)
    }
}

/// Largest speed, rad/s or m/s. A position that changes faster was set to another value and did not move there.
const FASTEST: f64 = 30.0;

/// Largest magnitude of a measured number, in any unit. Sums of its squares do not overflow.
const LARGEST: f64 = 1e12;

/// An unfiltered state of the log, in SI units.
#[derive(Clone, Debug, Default)]
pub(crate) struct State {
    /// The number of its message, from 1.
    pub(crate) message: u64,
    /// Time, ns.
    pub(crate) time: i64,
    /// Positions of the joints, then velocities, efforts and accelerations as far as the log has them.
    pub(crate) numbers: Vec<f64>,
}

/// A number that makes a sample invalid: it is not a number, infinite, or larger than anything measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct InvalidSample {
    /// The number of the message or row, from 1, header and comments not counted.
    pub message: u64,
    /// Time, s.
    pub time: f64,
    /// Index of the joint among those that are read, from 0.
    pub joint: usize,
    /// The quantity: `position`, `velocity`, `effort` or `acceleration`.
    pub quantity: &'static str,
    /// The value in the log, in SI units.
    pub value: f64,
}

/// Counts of messages, and of those that are not states of the arm, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All messages or rows.
    pub messages: u64,
    /// Messages that are states of the arm.
    pub states: u64,
    /// Messages that have none of the joints.
    pub of_others: u64,
    /// Messages that have some but not all of the joints.
    pub without_joints: u64,
    /// Messages whose number of positions is not that of their joints.
    pub without_positions: u64,
    /// Messages whose number of velocities is not that of their joints, if the log has velocities.
    pub without_velocities: u64,
    /// Messages whose number of efforts is not that of their joints, if the log has efforts.
    pub without_efforts: u64,
    /// Messages with a number that is NaN, infinite, or beyond 10¹² of its unit.
    pub not_finite: u64,
    /// Messages with the same time and numbers as the previous one.
    pub repeats: u64,
}

/// The reason for which a run begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interruption {
    /// It is the first run.
    Beginning,
    /// Nothing was measured for some time.
    Gap {
        /// The duration of the gap, s.
        seconds: f64,
    },
    /// Time went back.
    Reset {
        /// The time by which it went back, s.
        seconds: f64,
    },
    /// Two successive states have the same time but different numbers.
    Duplicate,
    /// The position of a joint changed faster than a joint can move.
    Jump {
        /// Index of the joint among those that are read, from 0.
        joint: usize,
        /// The change of the position, rad or m.
        by: f64,
    },
}

impl fmt::Display for Interruption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Beginning => f.write_str("begins the log"),
            Self::Gap { seconds } => write!(f, "after a gap of {seconds:.3} s"),
            Self::Reset { seconds } => write!(f, "time went back by {seconds:.3} s"),
            Self::Duplicate => f.write_str("two states have the same time"),
            Self::Jump { joint, by } => write!(f, "joint {} jumped by {by:.3}", joint + 1),
        }
    }
}

/// One reading of a log.
pub(crate) struct Pass<'a> {
    log: &'a Log,
    chain: Chain<'a>,
    joints: Joints,
    sample: Sample,
    state: State,
    previous: Option<State>,
    pub(crate) counts: Counts,
    pub(crate) invalid_sample: Option<InvalidSample>,
    /// The numbers of messages that are left out, in increasing order.
    without: Vec<u64>,
}

impl<'a> Pass<'a> {
    pub(crate) fn of(log: &'a Log) -> Result<Self, LogError> {
        Ok(Self {
            log,
            chain: Chain::open(&log.files, &log.options)?,
            joints: log.joints.clone(),
            sample: Sample::default(),
            state: State::default(),
            previous: None,
            counts: Counts::default(),
            invalid_sample: None,
            without: Vec::new(),
        })
    }

    /// Leaves out the messages that have a spike.
    pub(crate) fn without(self, spikes: &[Spike]) -> Self {
        Self { without: spikes.iter().map(|spike| spike.message).collect(), ..self }
    }

    /// Returns the fraction of the log that was read, 0 to 1.
    pub(crate) fn progress(&self) -> f64 {
        self.chain.progress()
    }

    /// Reads the next state, and the reason for which a run begins with it, if one does.
    pub(crate) fn next(&mut self) -> Result<Option<(&State, Option<Interruption>)>, LogError> {
        loop {
            if !self.chain.read(&mut self.sample)? {
                return Ok(None);
            }
            self.counts.messages += 1;
            if !self.take() || self.without.binary_search(&self.counts.messages).is_ok() {
                continue;
            }
            let begins = match &self.previous {
                None => Some(Interruption::Beginning),
                Some(previous) if previous.time == self.state.time && previous.numbers == self.state.numbers => {
                    self.counts.repeats += 1;
                    continue;
                }
                Some(previous) => self.interruption(previous),
            };
            self.counts.states += 1;
            let previous = self.previous.get_or_insert_default();
            previous.message = self.state.message;
            previous.time = self.state.time;
            previous.numbers.clone_from(&self.state.numbers);
            return Ok(Some((&self.state, begins)));
        }
    }

    /// Makes a state from the sample and returns true; if that is impossible, counts the reason.
    fn take(&mut self) -> bool {
        let Self { log, sample, state, counts, .. } = self;
        match self.joints.find(sample) {
            Presence::All => {}
            Presence::Some => {
                counts.without_joints += 1;
                return false;
            }
            Presence::None => {
                counts.of_others += 1;
                return false;
            }
        }
        let width = sample.names.len();
        let layout = &log.layout;
        if sample.position.len() != width {
            counts.without_positions += 1;
            return false;
        }
        if layout.has_velocities && sample.velocity.len() != width {
            counts.without_velocities += 1;
            return false;
        }
        if layout.has_efforts && sample.effort.len() != width {
            counts.without_efforts += 1;
            return false;
        }
        state.message = counts.messages;
        state.time = if layout.recorded { sample.recorded } else { sample.measured };
        state.numbers.clear();
        let units = &layout.units;
        self.joints.take(&sample.position, |joint| log.of_angle(joint, units[joint].position), &mut state.numbers);
        if layout.has_velocities {
            self.joints.take(&sample.velocity, |joint| log.of_angle(joint, units[joint].velocity), &mut state.numbers);
        }
        if layout.has_efforts {
            self.joints.take(&sample.effort, |joint| log.torque_constant(joint), &mut state.numbers);
        }
        if layout.has_accelerations {
            let factor = |joint: usize| log.of_angle(joint, units[joint].acceleration);
            self.joints.take(&sample.acceleration, factor, &mut state.numbers);
        }
        if let Some(at) = state.numbers.iter().position(|number| number.is_nan() || number.abs() > LARGEST) {
            counts.not_finite += 1;
            let joints = self.joints.names.len();
            let is_of = |quantity: &Quantity| layout.places(*quantity).contains(&at);
            let quantity = Quantity::ALL.into_iter().find(is_of).map_or("", Quantity::word);
            self.invalid_sample.get_or_insert(InvalidSample {
                message: counts.messages,
                time: log.seconds(state.time),
                joint: at % joints,
                quantity,
                value: state.numbers[at],
            });
            return false;
        }
        true
    }

    /// Returns the reason for which the state does not continue the run of the previous one, if any.
    #[expect(clippy::cast_precision_loss, reason = "ns between samples")]
    fn interruption(&self, previous: &State) -> Option<Interruption> {
        let step = self.log.layout.step;
        let interval = self.state.time.saturating_sub(previous.time) as f64 * 1e-9;
        if interval == 0.0 {
            return Some(Interruption::Duplicate);
        }
        if interval < 0.0 {
            return Some(Interruption::Reset { seconds: -interval });
        }
        if interval > self.log.options.gap * step {
            return Some(Interruption::Gap { seconds: interval });
        }
        let joints = self.joints.names.len();
        let moved = |joint: &usize| (self.state.numbers[*joint] - previous.numbers[*joint]).abs();
        // if messages arrive in a burst, their stamps are closer together than the samples were
        let most = FASTEST * interval.max(step);
        let joint = (0..joints).find(|joint| moved(joint) > most)?;
        Some(Interruption::Jump { joint, by: moved(&joint) })
    }
}
