//! Finds positions that keep one value although the measured velocity shows that the joint moves.

/// Shortest time for which a frozen position keeps its value, s.
const SHORTEST: f64 = 1.0;

/// Smallest movement of the joint in that time by the integral of its velocity, rad or m.
const TRAVEL: f64 = 0.1;

/// Smallest mean speed in that time, rad/s or m/s, because the velocity of a joint at rest may have a small constant
/// error.
const SPEED: f64 = 0.05;

/// A position that keeps one value while the joint moves; the longest such interval of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FrozenPosition {
    /// The joint, counted from 0.
    pub joint: usize,
    /// The value, rad or m.
    pub value: f64,
    /// The number of the run in which it occurs, from 0.
    pub run: u64,
    /// The times of the first and of the last sample with the value, s.
    pub times: [f64; 2],
    /// Whether the position has this value in the whole log.
    pub is_whole: bool,
}

/// The samples of one joint since the last change of its position.
#[derive(Clone, Copy)]
struct Window {
    value: f64,
    start: f64,
    end: f64,
    velocity: f64,
    /// ∫ velocity dt, its smallest and largest value, and ∫ |velocity| dt.
    travel: f64,
    least: f64,
    most: f64,
    path: f64,
}

impl Window {
    fn at(time: f64, value: f64, velocity: f64) -> Self {
        Self { value, start: time, end: time, velocity, travel: 0.0, least: 0.0, most: 0.0, path: 0.0 }
    }

    fn push(&mut self, time: f64, velocity: f64) {
        let moved = (time - self.end) * (velocity + self.velocity) / 2.0;
        (self.end, self.velocity) = (time, velocity);
        self.travel += moved;
        self.path += moved.abs();
        (self.least, self.most) = (self.least.min(self.travel), self.most.max(self.travel));
    }

    fn duration(&self) -> f64 {
        self.end - self.start
    }

    fn is_frozen(&self) -> bool {
        let (duration, range) = (self.duration(), self.most - self.least);
        duration >= SHORTEST && range >= TRAVEL && self.path >= SPEED * duration
    }
}

/// Searches for frozen positions in the states of a log with measured velocities.
pub(crate) struct FrozenPositions {
    run: u64,
    windows: Vec<Option<Window>>,
    longest: Vec<Option<(u64, Window)>>,
    changes: Vec<bool>,
}

impl FrozenPositions {
    /// Begins the search; `joints` is 0 for a log without velocities.
    pub(crate) fn new(joints: usize) -> Self {
        Self { run: 0, windows: vec![None; joints], longest: vec![None; joints], changes: vec![false; joints] }
    }

    /// Begins a run, and ends the previous one, if any.
    pub(crate) fn begin_run(&mut self, is_first: bool) {
        (0..self.windows.len()).for_each(|joint| self.keep(joint));
        self.windows.fill(None);
        self.run += u64::from(!is_first);
    }

    /// Adds a state; `numbers` are positions, then velocities.
    pub(crate) fn push(&mut self, time: f64, numbers: &[f64]) {
        let joints = self.windows.len();
        for joint in 0..joints {
            let (value, velocity) = (numbers[joint], numbers[joints + joint]);
            match &mut self.windows[joint] {
                #[expect(clippy::float_cmp, reason = "a frozen channel repeats its bits")]
                Some(window) if window.value == value => window.push(time, velocity),
                window => {
                    self.changes[joint] |= window.is_some();
                    self.keep(joint);
                    self.windows[joint] = Some(Window::at(time, value, velocity));
                }
            }
        }
    }

    fn keep(&mut self, joint: usize) {
        let Some(window) = self.windows[joint].filter(Window::is_frozen) else { return };
        if self.longest[joint].is_none_or(|(_, longest)| longest.duration() < window.duration()) {
            self.longest[joint] = Some((self.run, window));
        }
    }

    pub(crate) fn end(mut self) -> Vec<FrozenPosition> {
        (0..self.windows.len()).for_each(|joint| self.keep(joint));
        let joints = self.longest.iter().enumerate();
        let position = |(joint, longest): (usize, &Option<(u64, Window)>)| {
            let (run, window) = (*longest)?;
            let times = [window.start, window.end];
            Some(FrozenPosition { joint, value: window.value, run, times, is_whole: !self.changes[joint] })
        };
        joints.filter_map(position).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Searches in samples of a joint with this velocity at 100 Hz, whose position keeps one value from sample `from`
    /// on.
    fn found(samples: u32, velocity: impl Fn(f64) -> f64, from: u32) -> Vec<FrozenPosition> {
        let mut positions = FrozenPositions::new(1);
        positions.begin_run(true);
        let (mut position, mut said) = (0.3, 0.3);
        for sample in 0..samples {
            let time = f64::from(sample) * 0.01;
            position += 0.01 * velocity(time);
            if sample <= from {
                said = position;
            }
            positions.push(time, &[said, velocity(time)]);
        }
        positions.end()
    }

    #[test]
    fn a_position_that_keeps_its_value_while_the_joint_moves_is_frozen() {
        let [one] = found(1000, f64::sin, 400)[..] else { panic!("one") };
        assert_eq!((one.joint, one.run, one.is_whole, one.times), (0, 0, false, [4.0, 9.99]));
        let [one] = found(1000, f64::sin, 0)[..] else { panic!("one") };
        assert!(one.is_whole && one.times == [0.0, 9.99]);
    }

    #[test]
    fn a_joint_that_moves_or_rests_has_no_frozen_position() {
        assert_eq!(found(1000, f64::sin, 1000), [], "it moves");
        assert_eq!(found(1000, |_| 0.0, 0), [], "it rests");
        assert_eq!(found(100_000, |_| 0.002, 0), [], "the velocity has a constant error");
        assert_eq!(found(1000, |time| if (100.0 * time) % 2.0 < 1.0 { 0.2 } else { -0.2 }, 0), [], "noise");
        assert_eq!(found(1000, f64::sin, 920), [], "shorter than a second");
    }
}
