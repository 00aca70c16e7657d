//! Meaning of a table's column, by its name.

use crate::TimeUnit;
use crate::columns::quantity::Quantity;
use crate::columns::unit::{self, Unit};
use crate::limits::LONGEST_NAME;

/// The words by which columns are known: at the end of a name or at its beginning, and before the number of a joint.
const WORDS: [(Quantity, &[&str]); 3] = [
    (Quantity::Position, &["q", "position", "positions", "pos", "angle", "angles"]),
    (Quantity::Velocity, &["qd", "dq", "velocity", "velocities", "vel", "speed"]),
    (Quantity::Effort, &["tau", "effort", "efforts", "torque", "torques", "current", "currents", "i"]),
];

/// Words of efforts that are currents.
const CURRENTS: [&str; 3] = ["current", "currents", "i"];

const TIMES: [&str; 8] = ["time", "t", "ts", "timestamp", "stamp", "__time", "seconds", "time_from_start"];

const SEPARATORS: [char; 7] = ['/', '.', '_', '[', ']', ' ', ':'];

/// Characters before a unit that is not in brackets.
const BEFORE_UNITS: [char; 3] = ['_', ' ', '.'];

/// Words that a name has at most: each end of a name is looked at, whether it is a unit.
const MOST_WORDS: usize = 32;

/// Whether a name is too long to be that of a joint or of times.
fn is_too_long(name: &str) -> bool {
    name.len() > LONGEST_NAME || name.matches(BEFORE_UNITS).count() > MOST_WORDS
}

/// A column of a joint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Named {
    pub(crate) quantity: Quantity,
    /// Whether its word is one of currents.
    pub(crate) is_current: bool,
    pub(crate) joint: String,
    /// The joint's number, where its name is one.
    pub(crate) number: Option<u32>,
    pub(crate) unit: Option<Unit>,
}

/// Meaning of a name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Meaning {
    Joint(Named),
    /// A quantity of a joint with an unknown unit.
    Unknown {
        quantity: Quantity,
        unit: String,
    },
    /// It begins as a joint's and ends as nothing that is known, as in `q1_filtered`.
    Like,
    Nothing,
}

/// The meaning of a column's name.
pub(crate) fn meaning(name: &str) -> Meaning {
    let name = name.trim();
    // the tool centre point is no joint
    if is_too_long(name) || name.split(SEPARATORS).any(|word| word.eq_ignore_ascii_case("tcp")) {
        return Meaning::Nothing;
    }
    if let (base, Some(text)) = bracketed(name)
        && let Some((mut named, _)) = plain(base)
    {
        named.unit = Unit::parse(named.quantity, text);
        return match named.unit {
            Some(_) => Meaning::Joint(named),
            None => Meaning::Unknown { quantity: named.quantity, unit: text.to_owned() },
        };
    }
    let name = name.trim_end_matches("[]").trim_end_matches("()").trim_end();
    let mut is_like = false;
    for (rest, behind) in splits(name) {
        let Some((mut named, form)) = plain(rest) else { continue };
        is_like |= form == Form::Number;
        // a joint may be called A or m
        let is_short = behind.chars().count() == 1;
        if let Some(unit) = Unit::parse(named.quantity, behind)
            && !(is_short && form == Form::JointBehind)
        {
            named.unit = Some(unit);
            return Meaning::Joint(named);
        }
    }
    match plain(name) {
        // q_1_raw is no joint called 1_raw
        Some((_, Form::JointBehind)) | None if is_like => Meaning::Like,
        Some((named, form)) => Meaning::Joint(within(named, form)),
        None => Meaning::Nothing,
    }
}

/// The ways to part a name before its last words, the longest end first.
fn splits(name: &str) -> impl Iterator<Item = (&str, &str)> {
    let places = name.match_indices(BEFORE_UNITS);
    places.map(|(place, separator)| (&name[..place], &name[place + separator.len()..]))
}

/// How a name says its joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// q1, qd_2, actual_q_3
    Number,
    /// elbow/position
    JointBefore,
    /// position.elbow
    JointBehind,
}

/// The meaning of a name without a unit at its end.
fn plain(name: &str) -> Option<(Named, Form)> {
    let name = name.trim_matches(SEPARATORS);
    let named = |(quantity, is_current), joint: &str| Named {
        quantity,
        is_current,
        joint: joint.to_owned(),
        number: joint_number(joint),
        unit: None,
    };
    let (stem, number) = numbered(name);
    if !number.is_empty() {
        if let Some(found) = of_word(last(stem)) {
            return Some((named(found, without_zeros(number)), Form::Number));
        }
        // q_deg_1
        for (rest, behind) in splits(stem) {
            if let Some(found) = of_word(last(rest))
                && let Some(unit) = Unit::parse(found.0, behind).filter(|_| behind.chars().count() > 1)
            {
                let named = Named { unit: Some(unit), ..named(found, without_zeros(number)) };
                return Some((named, Form::Number));
            }
        }
    }
    if let Some((joint, last)) = name.rsplit_once(SEPARATORS)
        && let Some(found) = of_word(last)
    {
        let joint = joint.trim_end_matches(SEPARATORS).rsplit('/').next().unwrap_or_default();
        return Some((named(found, joint), Form::JointBefore));
    }
    let (first, joint) = name.split_once(SEPARATORS)?;
    Some((named(of_word(first)?, joint), Form::JointBehind))
}

/// A unit between the word and the joint, as in `position_deg.elbow`. One that changes no number may be part of the
/// joint's name.
fn within(mut named: Named, form: Form) -> Named {
    if form == Form::JointBehind && named.unit.is_none() {
        let joint = named.joint.clone();
        let mut ends: Vec<(usize, &str)> = joint.match_indices(['_', ' ', '.', '/']).collect();
        ends.reverse();
        for (end, separator) in ends {
            let unit = Unit::parse(named.quantity, &joint[..end]).filter(|unit| !unit.is_si());
            if let Some(unit) = unit {
                named.unit = Some(unit);
                joint[end + separator.len()..].clone_into(&mut named.joint);
                break;
            }
        }
    }
    named
}

/// The number of a joint whose name is one.
pub(crate) fn joint_number(joint: &str) -> Option<u32> {
    joint.parse().ok().filter(|_| joint.bytes().all(|byte| byte.is_ascii_digit()))
}

/// A name, and the number at its end.
fn numbered(name: &str) -> (&str, &str) {
    let bare = name.trim_end_matches(|c: char| c.is_ascii_digit());
    (bare.trim_end_matches(SEPARATORS), &name[bare.len()..])
}

fn last(name: &str) -> &str {
    name.rsplit(SEPARATORS).next().unwrap_or_default()
}

/// `01` is joint 1.
fn without_zeros(number: &str) -> &str {
    let significant = number.trim_start_matches('0');
    if significant.is_empty() { "0" } else { significant }
}

/// The quantity of a word, and whether it is a current.
fn of_word(word: &str) -> Option<(Quantity, bool)> {
    let word = word.to_lowercase();
    let (quantity, _) = WORDS.iter().find(|(_, words)| words.contains(&word.as_str()))?;
    Some((*quantity, CURRENTS.contains(&word.as_str())))
}

/// A name and the unit in brackets after it, as in `q1 [rad]`, `time (s)`; the number of a joint is not a unit.
pub(crate) fn bracketed(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    let Some(begin) = name.rfind(['[', '(']) else { return (name, None) };
    let Some(inner) = name[begin + 1..].strip_suffix([']', ')']) else { return (name, None) };
    let inner = inner.trim();
    if inner.is_empty() || inner.bytes().all(|byte| byte.is_ascii_digit()) {
        return (name, None);
    }
    (name[..begin].trim_end(), Some(inner))
}

/// Whether a name is that of times, and the unit that it says; a text that is no unit of time is an error.
pub(crate) fn time(name: &str) -> Option<Result<Option<TimeUnit>, String>> {
    if is_too_long(name) {
        return None;
    }
    if is_time(name) {
        return Some(Ok(None));
    }
    if let (base, Some(text)) = bracketed(name) {
        // time_ms [ms]
        return time(base).map(|_| unit::time(text).map(Some).ok_or_else(|| text.to_owned()));
    }
    let (rest, behind) = name.trim().rsplit_once(['_', ' '])?;
    let unit = unit::time(behind)?;
    is_time(rest).then_some(Ok(Some(unit)))
}

fn is_time(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let last = name.rsplit(['/', '.']).next().unwrap_or_default();
    TIMES.contains(&last) || TIMES.contains(&name.trim_start_matches('/'))
}

/// Quantity and unit of a list of numbers, by the last word of its name; a text in brackets that is not a unit is an
/// error.
#[cfg(feature = "parquet")]
pub(crate) fn list(name: &str) -> Option<(Quantity, bool, Result<Option<Unit>, String>)> {
    if is_too_long(name) {
        return None;
    }
    let of = |name: &str| {
        let last = name.rsplit(['/', '.', '_', ' ']).next().unwrap_or_default();
        // what collections for learning have
        let is_state = matches!(name, "observation.state" | "observation/state" | "observation_state");
        of_word(last).or(is_state.then_some((Quantity::Position, false)))
    };
    if let (base, Some(text)) = bracketed(name) {
        let (quantity, is_current) = of(base)?;
        let unit = Unit::parse(quantity, text);
        return Some((quantity, is_current, unit.map(Some).ok_or_else(|| text.to_owned())));
    }
    if let Some((quantity, is_current)) = of(name) {
        return Some((quantity, is_current, Ok(None)));
    }
    let mut units = splits(name).filter_map(|(rest, behind)| {
        let (quantity, is_current) = of(rest)?;
        Some((quantity, is_current, Ok(Some(Unit::parse(quantity, behind)?))))
    });
    units.next()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(name: &str) -> Option<(Quantity, String, Option<f64>)> {
        match meaning(name) {
            Meaning::Joint(named) => Some((named.quantity, named.joint, named.unit.map(|unit| unit.factor))),
            _ => None,
        }
    }

    #[test]
    fn names_say_joints_and_units() {
        use Quantity::{Effort, Position, Velocity};
        let degree = std::f64::consts::PI / 180.0;
        for (name, quantity, wanted, factor) in [
            ("q1", Position, "1", None),
            ("Q_02", Position, "2", None),
            ("q[0]", Position, "0", None),
            (" q1 [deg] ", Position, "1", Some(degree)),
            ("q1[deg]", Position, "1", Some(degree)),
            ("q[0] (°)", Position, "0", Some(degree)),
            ("q1_deg", Position, "1", Some(degree)),
            ("q1 deg", Position, "1", Some(degree)),
            ("q_deg_1", Position, "1", Some(degree)),
            ("actual_q_3_rad", Position, "3", Some(1.0)),
            ("q3 [mm]", Position, "3", Some(1e-3)),
            ("q3_m", Position, "3", Some(1.0)),
            ("elbow_position_m", Position, "elbow", Some(1.0)),
            ("elbow/position [deg]", Position, "elbow", Some(degree)),
            ("position.elbow_deg", Position, "elbow", Some(degree)),
            ("position_deg.elbow", Position, "elbow", Some(degree)),
            ("position.joint_A", Position, "joint_A", None),
            ("position.joint_m", Position, "joint_m", None),
            ("position[elbow]", Position, "elbow", None),
            ("qd1_deg_s", Velocity, "1", Some(degree)),
            ("qd1_deg/s", Velocity, "1", Some(degree)),
            ("qd1 [rad/s]", Velocity, "1", Some(1.0)),
            ("velocity.elbow_rad_per_s", Velocity, "elbow", Some(1.0)),
            ("tau1 [mNm]", Effort, "1", Some(1e-3)),
            ("tau1 [N m]", Effort, "1", Some(1.0)),
            ("torque_1_Nm", Effort, "1", Some(1.0)),
            ("i1 [A]", Effort, "1", Some(1.0)),
            ("current_1_mA", Effort, "1", Some(1e-3)),
        ] {
            assert_eq!(joint(name), Some((quantity, wanted.to_owned(), factor)), "{name}");
        }
        for (name, wanted) in [
            ("q1 [furlong]", Meaning::Unknown { quantity: Position, unit: "furlong".into() }),
            ("q1 [-]", Meaning::Unknown { quantity: Position, unit: "-".into() }),
            ("q1 [deg/s]", Meaning::Unknown { quantity: Position, unit: "deg/s".into() }),
            ("tau1 [MNm]", Meaning::Unknown { quantity: Effort, unit: "MNm".into() }),
            ("q1_filtered", Meaning::Like),
            ("tau1_lbft", Meaning::Like),
            ("qdd1", Meaning::Nothing),
            ("temperature [C]", Meaning::Nothing),
            ("actual_TCP_speed_0", Meaning::Nothing),
        ] {
            assert_eq!(meaning(name), wanted, "{name}");
        }
    }

    #[test]
    fn names_say_times() {
        for (name, wanted) in [
            ("time", Some(Ok(None))),
            ("header.stamp", Some(Ok(None))),
            ("t [ms]", Some(Ok(Some(TimeUnit::Milliseconds)))),
            ("t(us)", Some(Ok(Some(TimeUnit::Microseconds)))),
            ("timestamp_ns", Some(Ok(Some(TimeUnit::Nanoseconds)))),
            ("time_s", Some(Ok(Some(TimeUnit::Seconds)))),
            ("time [min]", Some(Err("min".to_owned()))),
            ("time_min", None),
            ("q_s", None),
        ] {
            assert_eq!(time(name), wanted, "{name}");
        }
    }
}
