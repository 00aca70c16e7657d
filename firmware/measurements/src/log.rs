//! Reads the output of code on its target, and computes the expected output.

use std::collections::BTreeMap;
use std::fmt;

use anyhow::{Context, Result, bail, ensure};
use robots::puma560::{self, Arguments};
use robots::{Numbers, STATES, State, Torques};

/// Results and times by their keys, such as `torques puma560 reduced 3` or `ticks puma560 reduced`.
#[derive(Debug, Default)]
pub(crate) struct Log {
    results: BTreeMap<String, Vec<Number>>,
    ticks: BTreeMap<String, u32>,
}

#[derive(Clone, Copy, Debug)]
enum Number {
    Single(f32),
    Double(f64),
}

/// The difference of results from those of the host, ordered by size.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) enum Agreement {
    /// All bits are the same.
    Identical,
    /// The largest difference, in units in the last place of the largest number of its state.
    Within(f64),
}

impl Log {
    /// Reads the output of a target:
    ///
    /// ```text
    /// torques ROBOT FORM STATE BITS…      results in hexadecimal, eight digits for `f32`, sixteen for `f64`
    /// double ROBOT FORM STATE BITS…
    /// method FORM FUNCTION STATE BITS…
    /// ticks ROBOT FORM TICKS
    /// ```
    pub(crate) fn read(text: &str) -> Result<Self> {
        let mut log = Self::default();
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.as_slice() {
                [kind @ ("torques" | "double" | "method"), a, b, state, bits @ ..] => {
                    let numbers: Result<Vec<Number>> = bits.iter().map(|bits| Number::read(bits)).collect();
                    let numbers = numbers.with_context(|| format!("printed: {line}"))?;
                    log.results.insert(format!("{kind} {a} {b} {state}"), numbers);
                }
                ["ticks", a, b, ticks] => {
                    log.ticks.insert(format!("{a} {b}"), ticks.parse().with_context(|| format!("printed: {line}"))?);
                }
                _ => bail!("this is no line of a log: `{line}`"),
            }
        }
        Ok(log)
    }

    /// Computes the results on the host.
    pub(crate) fn of_host() -> Self {
        let mut log = Self::default();
        robots::each(&mut log);
        robots::each_double(&mut log);
        puma560::each(&mut log);
        robots::each_controller(&mut log);
        log
    }

    /// Returns the ticks of a call.
    pub(crate) fn ticks(&self, function: &str) -> Result<u32> {
        self.ticks.get(function).copied().with_context(|| format!("no time of {function} was printed"))
    }

    /// Returns the difference of the results of a function, such as `torques puma560 reduced`, from those of another
    /// log.
    pub(crate) fn agreement(&self, expected: &Self, function: &str) -> Result<Agreement> {
        self.agreement_at(expected, function, 0..STATES)
    }

    /// Returns the difference of the results of a function from those of another log, at some states.
    pub(crate) fn agreement_at(
        &self,
        expected: &Self,
        function: &str,
        states: impl IntoIterator<Item = u32>,
    ) -> Result<Agreement> {
        let mut agreement = Agreement::Identical;
        for state in states {
            let key = format!("{function} {state}");
            let of = |log: &'_ Self| log.results.get(&key).cloned().with_context(|| format!("no results of {key}"));
            let (found, expected) = (of(self)?, of(expected)?);
            ensure!(found.len() == expected.len(), "{key}: {found:?} instead of {expected:?}");
            let unit = expected.iter().map(|number| number.unit()).fold(0.0, f64::max);
            for (found, expected) in found.iter().zip(&expected) {
                if !found.is_identical(*expected) {
                    let difference = (found.value() - expected.value()).abs() / unit;
                    ensure!(difference.is_finite(), "{key}: {found:?} instead of {expected:?}");
                    let before = if let Agreement::Within(before) = agreement { before } else { 0.0 };
                    agreement = Agreement::Within(before.max(difference));
                }
            }
        }
        Ok(agreement)
    }

    /// Returns a log with only the results of one function, under another name.
    pub(crate) fn renamed(&self, from: &str, to: &str) -> Self {
        let results = self.results.get(from).map(|results| (to.to_owned(), results.clone()));
        Self { results: results.into_iter().collect(), ticks: BTreeMap::new() }
    }

    fn insert(&mut self, key: String, numbers: &impl Numbers<f32>) {
        let mut list = Vec::new();
        numbers.each(&mut |number| list.push(Number::Single(*number)));
        self.results.insert(key, list);
    }
}

impl Number {
    fn read(bits: &str) -> Result<Self> {
        Ok(match bits.len() {
            8 => Self::Single(f32::from_bits(u32::from_str_radix(bits, 16)?)),
            16 => Self::Double(f64::from_bits(u64::from_str_radix(bits, 16)?)),
            _ => bail!("`{bits}` are neither the bits of an f32 nor of an f64"),
        })
    }

    fn value(self) -> f64 {
        match self {
            Self::Single(number) => number.into(),
            Self::Double(number) => number,
        }
    }

    /// Returns the unit in the last place of the number.
    fn unit(self) -> f64 {
        match self {
            Self::Single(number) => f64::from(number.abs().next_up()) - f64::from(number.abs()),
            Self::Double(number) => number.abs().next_up() - number.abs(),
        }
    }

    fn is_identical(self, other: Self) -> bool {
        match (self, other) {
            (Self::Single(a), Self::Single(b)) => a.to_bits() == b.to_bits(),
            (Self::Double(a), Self::Double(b)) => a.to_bits() == b.to_bits(),
            (Self::Single(_), Self::Double(_)) | (Self::Double(_), Self::Single(_)) => false,
        }
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Identical => f.write_str("bit-identical"),
            // rounded up to a tenth
            Self::Within(units) => write!(f, "within {:.1} ulp", (10.0 * units).ceil() / 10.0),
        }
    }
}

impl robots::Visitor for Log {
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, function: Torques<DOF>) {
        for number in 0..STATES {
            let State { q, qd, qdd } = State::new(number);
            self.insert(format!("torques {robot} {form} {number}"), &function(&q, &qd, &qdd));
        }
    }
}

impl robots::Visitor<f64> for Log {
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, function: Torques<DOF, f64>) {
        for number in 0..STATES {
            let State { q, qd, qdd } = State::new(number).double();
            let numbers = function(&q, &qd, &qdd).map(Number::Double).to_vec();
            self.results.insert(format!("double {robot} {form} {number}"), numbers);
        }
    }
}

impl puma560::Visitor for Log {
    fn visit<N: Numbers<f32>>(&mut self, form: &'static str, function: &'static str, call: impl Fn(&Arguments) -> N) {
        for number in 0..STATES {
            let numbers = call(&Arguments::at(State::new(number)));
            self.insert(format!("method {form} {function} {number}"), &numbers);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Agreement, Log};

    #[test]
    fn a_bit_is_a_difference() {
        let read = |bits| Log::read(&format!("torques arm reduced 0 3f800000 {bits}\n")).expect("a log");
        let agreement = |bits| read(bits).agreement_at(&read("3f800000"), "torques arm reduced", [0]).expect("results");
        assert_eq!(agreement("3f800000"), Agreement::Identical);
        assert_eq!(agreement("3f800003"), Agreement::Within(3.0));
        assert!(read("7fc00000").agreement_at(&read("3f800000"), "torques arm reduced", [0]).is_err(), "not a number");
    }

    #[test]
    fn what_is_no_log_is_told() {
        assert!(Log::read("index out of bounds\n").is_err());
        assert!(Log::read("torques arm reduced 0 xyz\n").is_err());
        assert!(Log::read("").expect("empty").ticks("arm reduced").is_err());
    }
}
