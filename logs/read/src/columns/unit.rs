//! Units in the names of columns.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::Path;

use crate::columns::quantity::Quantity;
use crate::{LogError, TimeUnit};

/// Dimension of a joint's quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// An angle or angular velocity: rad, rad/s.
    Angle,
    /// A length or linear velocity: m, m/s.
    Length,
    /// A torque: N m.
    Torque,
    /// A force: N.
    Force,
    /// A current: A.
    Current,
}

/// Dimensions of a joint's quantities, as far as the names of a table's columns give them. Such numbers are converted
/// to SI units by their names, whatever the options are.
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

/// The units of a file, for each joint by its name, and for all other joints.
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

/// A unit: its dimension, and its factor to the SI unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    pub(crate) dimension: Dimension,
    pub(crate) factor: f64,
}

const DEGREE: f64 = PI / 180.0;

/// Largest number of bytes of a text that may be a unit.
const LONGEST: usize = 40;

/// Units of positions; divided by s, they are units of velocities.
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
    /// Reads the unit of a quantity, such as `deg`, `N·m` or `rad s^-1`; `None` if it is unknown.
    pub(crate) fn parse(quantity: Quantity, text: &str) -> Option<Self> {
        if text.len() > LONGEST {
            return None;
        }
        let text = text.replace("s^-1", "/s").replace("s⁻¹", "/s").replace("s-1", "/s").replace("per", "/");
        // `deg_s` means deg/s, for names that cannot have a slash
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
            // case matters, because `m` is milli and `M` is mega
            Quantity::Effort => find(&EFFORTS, |name| name == text),
        }
    }

    /// Whether numbers in this unit are in SI units already.
    pub(crate) fn is_si(self) -> bool {
        self.factor == 1.0
    }

    /// Returns the error for a column whose name has an unknown unit.
    pub(crate) fn unknown(path: &Path, name: &str, quantity: Quantity, unit: &str) -> LogError {
        let (quantities, known) = (quantity.plural(), Self::known(quantity));
        let what = format!(
            "the column {name} has {quantities} in {unit}, which is not a known unit; the known units are {known}"
        );
        LogError::file(path, what)
    }

    /// Lists the known units of a quantity for messages.
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
        // case is ignored for words such as DEG and Rad, but not for MM, which may not mean millimetre
        let is_word = |name: &str| name.len() > 2 && name != "mrad" && name.eq_ignore_ascii_case(text);
        find(&POSITIONS, is_word)
    })
}

fn find(units: &[(&str, Dimension, f64)], is: impl Fn(&str) -> bool) -> Option<Unit> {
    let unit = units.iter().find(|(name, ..)| is(name));
    unit.map(|(_, dimension, factor)| Unit { dimension: *dimension, factor: *factor })
}

/// Reads a unit of time.
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
        // every unit that a message lists is known
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
