//! Units that the names of columns say.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::Path;

use crate::columns::quantity::Quantity;
use crate::{LogError, TimeUnit};

/// Dimension of a joint's quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// rad, rad/s
    Angle,
    /// m, m/s
    Length,
    /// N m
    Torque,
    /// N
    Force,
    /// A
    Current,
}

/// Dimensions of a joint's quantities, as far as the names of a table's columns give them: those numbers are in SI
/// units then, whatever the options are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct JointUnits {
    /// An angle or a length.
    pub position: Option<Dimension>,
    /// The angle or the length, per second.
    pub velocity: Option<Dimension>,
    /// A torque, a force or a current.
    pub effort: Option<Dimension>,
    /// The angle or the length, per second squared.
    pub acceleration: Option<Dimension>,
}

/// The units of a file: of joints by their names, and of all others.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FileUnits {
    pub(crate) joints: HashMap<String, JointUnits>,
    pub(crate) others: JointUnits,
}

impl FileUnits {
    pub(crate) fn of(&self, joint: &str) -> JointUnits {
        self.joints.get(joint).copied().unwrap_or(self.others)
    }
}

/// A unit: what it measures, and how much of the SI unit one is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    pub(crate) dimension: Dimension,
    pub(crate) factor: f64,
}

const DEGREE: f64 = PI / 180.0;

/// Bytes of the longest text that is looked at for a unit.
const LONGEST: usize = 40;

/// Units of positions, which per second are units of velocities.
const POSITIONS: [(&str, Dimension, f64); 15] = [
    ("rad", Dimension::Angle, 1.0),
    ("radian", Dimension::Angle, 1.0),
    ("radians", Dimension::Angle, 1.0),
    ("mrad", Dimension::Angle, 1e-3),
    ("deg", Dimension::Angle, DEGREE),
    ("degree", Dimension::Angle, DEGREE),
    ("degrees", Dimension::Angle, DEGREE),
    ("°", Dimension::Angle, DEGREE),
    ("m", Dimension::Length, 1.0),
    ("meter", Dimension::Length, 1.0),
    ("meters", Dimension::Length, 1.0),
    ("metre", Dimension::Length, 1.0),
    ("metres", Dimension::Length, 1.0),
    ("cm", Dimension::Length, 1e-2),
    ("mm", Dimension::Length, 1e-3),
];

const EFFORTS: [(&str, Dimension, f64); 10] = [
    ("Nm", Dimension::Torque, 1.0),
    ("mNm", Dimension::Torque, 1e-3),
    ("kNm", Dimension::Torque, 1e3),
    ("Ncm", Dimension::Torque, 1e-2),
    ("Nmm", Dimension::Torque, 1e-3),
    ("N", Dimension::Force, 1.0),
    ("mN", Dimension::Force, 1e-3),
    ("kN", Dimension::Force, 1e3),
    ("A", Dimension::Current, 1.0),
    ("mA", Dimension::Current, 1e-3),
];

const TIMES: [(&[&str], TimeUnit); 4] = [
    (&["s", "sec", "secs", "second", "seconds"], TimeUnit::Seconds),
    (&["ms", "msec", "millis", "millisecond", "milliseconds"], TimeUnit::Milliseconds),
    (&["us", "µs", "μs", "usec", "micros", "microsecond", "microseconds"], TimeUnit::Microseconds),
    (&["ns", "nsec", "nsecs", "nanosec", "nanos", "nanosecond", "nanoseconds"], TimeUnit::Nanoseconds),
];

impl Unit {
    /// The unit of a quantity, as in `deg`, `N·m`, `rad s^-1`; none where it is not one that is known.
    pub(crate) fn parse(quantity: Quantity, text: &str) -> Option<Self> {
        if text.len() > LONGEST {
            return None;
        }
        let text = text.replace("s^-1", "/s").replace("s⁻¹", "/s").replace("s-1", "/s").replace("per", "/");
        // deg_s, where a name may have no stroke
        let text = match text.rsplit_once('_') {
            Some((before, behind)) if quantity == Quantity::Velocity && !text.contains('/') => {
                format!("{before}/{behind}")
            }
            _ => text,
        };
        let text: String = text.chars().filter(|c| !matches!(c, ' ' | '*' | '·' | '⋅' | '.' | '-' | '_')).collect();
        match quantity {
            Quantity::Position => of_position(&text),
            Quantity::Velocity if text.eq_ignore_ascii_case("rpm") || text == "1/min" => {
                Some(Self { dimension: Dimension::Angle, factor: PI / 30.0 })
            }
            Quantity::Velocity => {
                let per = ["/s", "/sec", "/second"].iter().find_map(|per| text.strip_suffix(per))?;
                of_position(per)
            }
            Quantity::Acceleration => {
                let per = ["/s²", "/s^2", "/s2"].iter().find_map(|per| text.strip_suffix(per))?;
                of_position(per)
            }
            // the case of a letter is a prefix, of which one is a billion times the other
            Quantity::Effort => find(&EFFORTS, |name| name == text),
        }
    }

    /// Whether numbers are as they are in SI units.
    pub(crate) fn is_si(self) -> bool {
        self.factor == 1.0
    }

    /// The error for a column whose name says a unit that is not known.
    pub(crate) fn unknown(path: &Path, name: &str, quantity: Quantity, unit: &str) -> LogError {
        let (quantities, known) = (quantity.plural(), Self::known(quantity));
        let what = format!(
            "the column {name} has {quantities} in {unit}, which is not a known unit; the known units are {known}"
        );
        LogError::file(path, what)
    }

    /// The units of a quantity that are known, for people.
    pub(crate) fn known(quantity: Quantity) -> &'static str {
        match quantity {
            Quantity::Position => "rad, mrad, deg, m, cm, mm",
            Quantity::Velocity => "rad/s, mrad/s, deg/s, rpm, m/s, cm/s, mm/s",
            Quantity::Effort => "Nm, mNm, kNm, Ncm, Nmm, N, mN, kN, A, mA",
            Quantity::Acceleration => "rad/s^2, mrad/s^2, deg/s^2, m/s^2, cm/s^2, mm/s^2",
        }
    }
}

fn of_position(text: &str) -> Option<Unit> {
    find(&POSITIONS, |name| name == text).or_else(|| {
        // DEG and Rad are written, MM is no millimetre for sure
        let is_word = |name: &str| name.len() > 2 && name != "mrad" && name.eq_ignore_ascii_case(text);
        find(&POSITIONS, is_word)
    })
}

fn find(units: &[(&str, Dimension, f64)], is: impl Fn(&str) -> bool) -> Option<Unit> {
    let unit = units.iter().find(|(name, ..)| is(name));
    unit.map(|(_, dimension, factor)| Unit { dimension: *dimension, factor: *factor })
}

/// A unit of time.
pub(crate) fn time(text: &str) -> Option<TimeUnit> {
    let text = text.trim();
    TIMES.iter().find(|(names, _)| names.contains(&text)).map(|(_, unit)| *unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_what_they_say() {
        for (quantity, text, dimension, factor) in [
            (Quantity::Position, "rad", Dimension::Angle, 1.0),
            (Quantity::Position, "DEG", Dimension::Angle, PI / 180.0),
            (Quantity::Position, "°", Dimension::Angle, PI / 180.0),
            (Quantity::Position, "mm", Dimension::Length, 1e-3),
            (Quantity::Velocity, "deg/s", Dimension::Angle, PI / 180.0),
            (Quantity::Velocity, "rad s^-1", Dimension::Angle, 1.0),
            (Quantity::Velocity, "deg_per_s", Dimension::Angle, PI / 180.0),
            (Quantity::Velocity, "rad·s⁻¹", Dimension::Angle, 1.0),
            (Quantity::Velocity, "m/s", Dimension::Length, 1.0),
            (Quantity::Velocity, "RPM", Dimension::Angle, PI / 30.0),
            (Quantity::Acceleration, "deg/s^2", Dimension::Angle, PI / 180.0),
            (Quantity::Acceleration, "m/s²", Dimension::Length, 1.0),
            (Quantity::Effort, "N m", Dimension::Torque, 1.0),
            (Quantity::Effort, "mN·m", Dimension::Torque, 1e-3),
            (Quantity::Effort, "N*m", Dimension::Torque, 1.0),
            (Quantity::Effort, "mA", Dimension::Current, 1e-3),
        ] {
            assert_eq!(Unit::parse(quantity, text), Some(Unit { dimension, factor }), "{text}");
        }
        for (quantity, text) in [
            (Quantity::Position, "rad/s"),
            (Quantity::Position, "MM"),
            (Quantity::Position, "gon"),
            (Quantity::Position, "%"),
            (Quantity::Velocity, "deg"),
            (Quantity::Effort, "MNm"),
            (Quantity::Effort, "nm"),
            (Quantity::Effort, "deg"),
        ] {
            assert_eq!(Unit::parse(quantity, text), None, "{text}");
        }
        // what a message names is known
        for quantity in Quantity::ALL {
            for text in Unit::known(quantity).split(", ") {
                assert!(Unit::parse(quantity, text).is_some(), "{text}");
            }
        }
        assert_eq!(
            (time("ms"), time("seconds"), time("min")),
            (Some(TimeUnit::Milliseconds), Some(TimeUnit::Seconds), None)
        );
    }
}
