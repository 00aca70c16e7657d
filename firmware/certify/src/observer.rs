//! Computes the updates of the momentum observer of emitted C: in single precision, as the code does, and exactly.

use rne_codegen::{Interpreter, Program};
use rne_model::Robot;

use crate::accuracy::{self, Error, Range, Sample, enclosed, largest_errors, single, single_precision};
use crate::board::{self, Call};
use crate::interval::Interval;

/// The low-pass filter of an observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass {
    /// The gain of the observer, Hz.
    pub gain: f64,
    /// The time between two updates, s.
    pub period: f64,
}

/// Number of updates in a motion; the error is bounded at each.
pub const UPDATES: usize = 100;

impl LowPass {
    /// Returns the weight of an update, 1 - e^(-2π gain period), as the observer stores it.
    #[must_use]
    pub fn weight(self) -> f32 {
        single(-libm::expm1(-std::f64::consts::TAU * self.gain * self.period))
    }

    /// Returns 1 / period, Hz, as the observer stores it.
    #[must_use]
    pub fn frequency(self) -> f32 {
        single(1.0 / self.period)
    }

    /// Returns the call of the second update of an observer in C. The first update is at the state with the number of
    /// this state plus [`board::STATES`].
    #[must_use]
    pub fn call(self, prefix: &str, dof: usize) -> Call {
        let (weight, frequency) = (self.weight(), self.frequency());
        let update = format!("{prefix}_observer_update");
        let before = vec![
            format!("const struct state before = state_of(number + {}u, {dof}u);", board::STATES),
            format!("{prefix}_observer observer;"),
            format!("{prefix}_observer_begin(&observer, {:?}f, {:?}f);", single(self.gain), single(self.period)),
            // computed in double precision and rounded
            format!("observer.weight = {weight:?}f;"),
            format!("observer.frequency = {frequency:?}f;"),
            format!("{update}(&observer, before.q, before.qd, before.qdd, out);"),
        ];
        let Call { mut arguments, .. } = Call::of_arrays(&update, &["q", "qd", "qdd"], dof);
        arguments.insert(0, (format!("{prefix}_observer *"), "&observer".to_owned()));
        Call { arguments, before, ..Call::new(update, dof) }
    }

    /// Returns the numbers that [`call`](Self::call) must write at a state; `None` if the interpreter cannot run the
    /// program.
    #[must_use]
    pub fn result(
        self,
        robot: &Robot,
        interpreter: &Interpreter,
        number: u32,
        sin_cos: impl Fn(f32) -> (f32, f32),
    ) -> Option<Vec<f32>> {
        let mut observer = Observer::new(robot.dof(), self);
        for number in [number + board::STATES, number] {
            let [q, qd, tau] = board::state(number, robot.dof());
            observer.update(&single_precision(robot, interpreter, [&q, &[], &qd, &tau], &sin_cos)?);
        }
        Some(observer.external)
    }

    /// Returns the errors of the external torques; `None` if the interpreter cannot run `program`, which must be
    /// `momentum_and_rate`.
    ///
    /// The states of the sample are updates in motions of [`UPDATES`] updates: each joint follows a sine within its
    /// ranges, and each torque is a random number in each update. The exact torques are those of the same updates since
    /// the beginning of the motion, with the weight and the frequency that the observer stores.
    #[must_use]
    pub fn errors(
        self,
        robot: &Robot,
        program: &Program,
        sample: Sample,
        sin_cos: impl Fn(f32) -> (f32, f32),
    ) -> Option<Vec<Error>> {
        let interpreter = Interpreter::new(program);
        let ranges = accuracy::ranges(robot);
        let mut motion = None;
        largest_errors(sample, robot.dof(), |state, rng| {
            let update = state % UPDATES;
            if update == 0 {
                let waves: Vec<Wave> = ranges.iter().map(|range| Wave::random(range, rng)).collect();
                motion = Some((waves, Observer::new(robot.dof(), self), Enclosure::new(robot.dof(), self)));
            }
            let (waves, found, exact) = motion.as_mut()?;
            #[allow(clippy::cast_precision_loss)] // at most 100
            let time = update as f64 * self.period;
            let [q, qd] = [Wave::position, Wave::velocity]
                .map(|signal| -> Vec<f32> { waves.iter().map(|wave| single(signal(wave, time))).collect() });
            let tau = ranges.iter().map(|range| single((2.0 * rng.f64() - 1.0) * range.torque));
            let tau: Vec<f32> = tau.collect();
            found.update(&single_precision(robot, &interpreter, [&q, &[], &qd, &tau], &sin_cos)?);
            exact.update(&enclosed(robot, &interpreter, [&q, &[], &qd, &tau])?);
            Some((found.external.clone(), exact.external.clone()))
        })
    }
}

/// The motion of a joint along a sine.
struct Wave {
    middle: f64,
    amplitude: f64,
    /// Angular frequency, rad/s.
    frequency: f64,
    phase: f64,
}

impl Wave {
    /// Makes a sine within the range of positions; in its middle, the joint has the largest speed of the range.
    fn random(range: &Range, rng: &mut fastrand::Rng) -> Self {
        let (low, high) = range.position;
        let amplitude = 0.5 * (high - low) * rng.f64();
        let middle = low + amplitude + (high - low - 2.0 * amplitude) * rng.f64();
        let frequency = if amplitude > 0.0 { range.velocity / amplitude } else { 0.0 };
        Self { middle, amplitude, frequency, phase: std::f64::consts::TAU * rng.f64() }
    }

    fn position(&self, time: f64) -> f64 {
        self.middle + self.amplitude * libm::sin(self.frequency * time + self.phase)
    }

    fn velocity(&self, time: f64) -> f64 {
        self.amplitude * self.frequency * libm::cos(self.frequency * time + self.phase)
    }
}

/// The observer with the data and the operations of the code, in the same order.
struct Observer {
    momentum: Vec<f32>,
    rate: Vec<f32>,
    external: Vec<f32>,
    next: f32,
    weight: f32,
    frequency: f32,
}

impl Observer {
    fn new(dof: usize, low_pass: LowPass) -> Self {
        let zeros = vec![0.0; dof];
        let (weight, frequency) = (low_pass.weight(), low_pass.frequency());
        Self { momentum: zeros.clone(), rate: zeros.clone(), external: zeros, next: 0.0, weight, frequency }
    }

    /// Updates the observer with the results of `momentum_and_rate`: the momenta, then their rates.
    fn update(&mut self, now: &[f32]) {
        let (momentum, rate) = now.split_at(self.external.len());
        for i in 0..self.external.len() {
            let mean = (momentum[i] - self.momentum[i]) * self.frequency;
            let mean = mean - (rate[i] + self.rate[i]) * 0.5;
            self.external[i] += (mean - self.external[i]) * self.next;
        }
        (self.momentum, self.rate, self.next) = (momentum.to_vec(), rate.to_vec(), self.weight);
    }
}

/// The observer computed with intervals, which enclose the exact numbers.
struct Enclosure {
    before: Option<[Vec<Interval>; 2]>,
    external: Vec<Interval>,
    weight: Interval,
    frequency: Interval,
}

impl Enclosure {
    fn new(dof: usize, low_pass: LowPass) -> Self {
        let [weight, frequency] =
            [low_pass.weight(), low_pass.frequency()].map(|number| Interval::exactly(f64::from(number)));
        Self { before: None, external: vec![Interval::exactly(0.0); dof], weight, frequency }
    }

    fn update(&mut self, now: &[Interval]) {
        let (momentum, rate) = now.split_at(self.external.len());
        if let Some([momentum_before, rate_before]) = &self.before {
            let keep = Interval::exactly(1.0) - self.weight;
            for i in 0..self.external.len() {
                let change = (momentum[i] - momentum_before[i]) * self.frequency;
                let mean = change - (rate[i] + rate_before[i]) * Interval::exactly(0.5);
                // (1 - w) r + w t instead of r + w (t - r), so that the intervals do not grow from update to update
                self.external[i] = keep * self.external[i] + self.weight * mean;
            }
        }
        self.before = Some([momentum.to_vec(), rate.to_vec()]);
    }
}

#[cfg(test)]
mod tests {
    use rne_codegen::{Compiler, Form, Function};
    use rne_model::Robot;

    use super::{Enclosure, LowPass, Observer};
    use crate::accuracy::Sample;
    use crate::interval::Interval;

    /// A pendulum without gravity: the momentum is I q̇ with I = 1.3 0.4², and the rate is the torque.
    const PENDULUM: &str = "{format: 1, name: one, source: doc, convention: standard, gravity: [0, 0, 0], joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0.7, alpha: 0}, link: {mass: 1.3, com: [-0.3, 0, 0]}}]}";

    const LOW_PASS: LowPass = LowPass { gain: 20.0, period: 1e-3 };

    #[test]
    fn a_constant_torque_comes_through_the_low_pass() {
        // the rate of the momentum is 3 N m, of which the actuator gives 1: the external torque is 2 N m (1 - e^(-2π 20
        // t))
        let mut observer = Observer::new(1, LOW_PASS);
        let mut exact = Enclosure::new(1, LOW_PASS);
        for k in 0..50_u8 {
            let time = f64::from(k) * 1e-3;
            #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
            observer.update(&[(3.0 * time) as f32, 1.0]);
            exact.update(&[Interval::exactly(3.0 * time), Interval::exactly(1.0)]);
            let expected = 2.0 * (1.0 - (-std::f64::consts::TAU * 20.0 * time).exp());
            assert!((f64::from(observer.external[0]) - expected).abs() < 2e-4, "{k}: {expected}");
            let Interval { low, high } = exact.external[0];
            // the difference is that of the weight in single precision
            assert!(high - low < 1e-12 && (low - expected).abs() < 1e-6, "{k}: {low} {high} {expected}");
        }
    }

    #[test]
    fn the_bound_is_that_of_single_precision() {
        let robot = Robot::from_yaml(PENDULUM).expect("a robot");
        let program = Compiler::new(&robot).compile(Function::MomentumAndRate, Form::Reduced).expect("it compiles");
        let sample = Sample { states: 1000, seed: 1 };
        let error = LOW_PASS.errors(&robot, &program, sample, f32::sin_cos).expect("errors")[0];
        // torques up to 10 N m, and I times accelerations
        assert!(error.largest > 1.0 && error.largest < 12.0, "{error:?}");
        // rounding errors of 2⁻²⁴ of the momentum, up to 0.208 2, times 1000 Hz; up to two of them
        assert!(error.bound < 4.0 * 0.416 * 1e3 / f64::from(1 << 24) && error.bound > 1e-6, "{error:?}");
        // a larger gain passes more of the rounding errors
        let faster = LowPass { gain: 200.0, ..LOW_PASS };
        let faster = faster.errors(&robot, &program, sample, f32::sin_cos).expect("errors")[0];
        assert!(faster.bound > error.bound, "{faster:?}");
    }
}
