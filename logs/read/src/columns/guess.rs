//! Finds the meaning of a table's column by the pattern of its name.

use crate::TimeUnit;
use crate::columns::quantity::Quantity;
use crate::columns::unit::{self, Unit};
use crate::limits::LONGEST_NAME;

/// The words for a quantity, and whether they mean a current. Upper and lower case are equal.
const WORDS: [(Quantity, bool, &[&str]); 4] = [
    (Quantity::Position, false, &["q", "position", "positions", "pos", "angle", "angles"]),
    (Quantity::Velocity, false, &["qd", "dq", "velocity", "velocities", "vel", "speed"]),
    (Quantity::Effort, false, &["tau", "effort", "efforts", "torque", "torques"]),
    (Quantity::Effort, true, &["current", "currents", "i"]),
];

/// The patterns of the names of columns of joints, in the order in which they are tried. An optional unit follows, as
/// in `q1 [deg]`, `q1_deg` or `q1 deg`. The documentation of logs has this table.
const PATTERNS: [Pattern; 12] = [
    Pattern(Form::Number, "", ""),        // tables of `rne`, libfranka
    Pattern(Form::Number, "_", ""),       // ur_rtde
    Pattern(Form::Number, "[", "]"),      // arrays
    Pattern(Form::Number, ".", ""),       // messages written as columns
    Pattern(Form::Number, " ", ""),       // hand-written tables
    Pattern(Form::JointBefore, "/", ""),  // PlotJuggler, ros2_control
    Pattern(Form::JointBefore, ".", ""),  // tables of `rne`
    Pattern(Form::JointBefore, "_", ""),  // hand-written tables
    Pattern(Form::JointBefore, " ", ""),  // hand-written tables
    Pattern(Form::JointBehind, ".", ""),  // messages written as columns
    Pattern(Form::JointBehind, "[", "]"), // messages written as columns
    Pattern(Form::JointBehind, "/", ""),  // messages written as columns
];

/// The patterns of the names of columns of lists, which have in each row one number for each joint. An optional unit
/// follows.
const LISTS: [Pattern; 1] = [Pattern(Form::List, "", "")];

/// Names of lists of positions in data sets for robot learning.
const STATES: [&str; 3] = ["observation.state", "observation/state", "observation_state"];

const TIMES: [&str; 8] = ["time", "t", "ts", "timestamp", "stamp", "__time", "seconds", "time_from_start"];

/// Characters between the words of a name.
const SEPARATORS: [char; 7] = ['/', '.', '_', '[', ']', ' ', ':'];

/// Characters before a unit that is not in brackets.
const BEFORE_UNITS: [char; 3] = ['_', ' ', '.'];

/// Largest number of words of a name. It bounds the work, because each ending of a name may be a unit.
const MOST_WORDS: usize = 32;

/// Whether a name is too long to be that of a column of a joint or of times.
fn is_too_long(name: &str) -> bool {
    name.len() > LONGEST_NAME || name.matches(BEFORE_UNITS).count() > MOST_WORDS
}

/// The meaning of a column of a joint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Named {
    pub(crate) quantity: Quantity,
    /// Whether the word for the quantity means a current.
    pub(crate) is_current: bool,
    /// The name of the joint; empty for a column of lists, which has all joints.
    pub(crate) joint: String,
    /// The number of the joint, if its name is a number.
    pub(crate) number: Option<u32>,
    pub(crate) unit: Option<Unit>,
}

/// Meaning of the name of a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Meaning {
    Joint(Named),
    /// A quantity of a joint with an unknown unit.
    Unknown {
        quantity: Quantity,
        unit: String,
    },
    /// The name begins like that of a column of a joint, but its ending is unknown, as in `q1_filtered`.
    Like,
    Nothing,
}

/// The form in which a name gives its joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// `q1`, or with the name of a group before it, `actual_q_1`.
    Number,
    /// `elbow.position`, or with a path before it, `/joint_states/elbow/position`.
    JointBefore,
    /// `position.elbow`
    JointBehind,
    /// `joint_positions`
    List,
}

/// A pattern of names: its form, the text between the joint and the word for the quantity, and the text at the end.
struct Pattern(Form, &'static str, &'static str);

impl Pattern {
    /// Returns the meaning of a name without a unit, if it fits this pattern.
    fn read(&self, name: &str) -> Option<(Named, Form)> {
        let &Self(form, between, after) = self;
        let name = name.trim_start_matches(SEPARATORS).strip_suffix(after)?;
        let (word, joint) = match form {
            Form::Number => {
                let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
                (last(stem.strip_suffix(between)?), without_zeros(&name[stem.len()..])?)
            }
            Form::JointBefore => {
                let (joint, word) = name.rsplit_once(between)?;
                (word, joint.trim_end_matches(SEPARATORS).rsplit('/').next().filter(|joint| !joint.is_empty())?)
            }
            Form::JointBehind => name.split_once(between).filter(|(_, joint)| !joint.is_empty())?,
            Form::List if STATES.contains(&name) => ("position", ""),
            Form::List => (last(name), ""),
        };
        let is_word = |known: &&str| word.eq_ignore_ascii_case(known);
        let &(quantity, is_current, _) = WORDS.iter().find(|(.., words)| words.iter().any(is_word))?;
        let named = Named { quantity, is_current, joint: joint.to_owned(), number: joint_number(joint), unit: None };
        Some((named, form))
    }
}

/// Returns the meaning of the name of a column of numbers or, with `is_list`, of lists. A column of lists never belongs
/// to a single joint.
pub(crate) fn meaning(name: &str, is_list: bool) -> Meaning {
    if is_list {
        return by(&LISTS, name);
    }
    // columns of the tool centre point do not belong to a joint
    let is_tip = |name: &str| name.split(SEPARATORS).any(|word| word.eq_ignore_ascii_case("tcp"));
    if !is_too_long(name) && is_tip(name) { Meaning::Nothing } else { by(&PATTERNS, name) }
}

fn by(patterns: &[Pattern], name: &str) -> Meaning {
    let name = name.trim();
    if is_too_long(name) {
        return Meaning::Nothing;
    }
    let plain = |name: &str| patterns.iter().find_map(|pattern| pattern.read(name));
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
    // tries the longest ending as a unit first
    for (place, separator) in name.match_indices(BEFORE_UNITS) {
        let (rest, behind) = (&name[..place], &name[place + separator.len()..]);
        let Some((mut named, form)) = plain(rest) else { continue };
        is_like |= form == Form::Number;
        // `A` or `m` at the end may be the name of a joint
        let is_short = behind.chars().count() == 1;
        if let Some(unit) = Unit::parse(named.quantity, behind)
            && !(is_short && form == Form::JointBehind)
        {
            named.unit = Some(unit);
            return Meaning::Joint(named);
        }
    }
    match plain(name) {
        Some((named, _)) => Meaning::Joint(named),
        None if is_like => Meaning::Like,
        None => Meaning::Nothing,
    }
}

/// Returns the number of a joint whose name is a number.
pub(crate) fn joint_number(joint: &str) -> Option<u32> {
    joint.parse().ok().filter(|_| joint.bytes().all(|byte| byte.is_ascii_digit()))
}

fn last(name: &str) -> &str {
    name.rsplit(SEPARATORS).next().unwrap_or_default()
}

/// Removes leading zeros, so that `01` is joint 1; `None` without digits.
fn without_zeros(digits: &str) -> Option<&str> {
    let significant = digits.trim_start_matches('0');
    if significant.is_empty() { digits.get(..1) } else { Some(significant) }
}

/// Splits a name from the unit in brackets after it, as in `q1 [rad]` or `time (s)`. The number of a joint in brackets
/// is not a unit.
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

/// Whether a name is that of a column of times, and the unit in the name. `Err` has a text that is no unit of time.
pub(crate) fn time(name: &str) -> Option<Result<Option<TimeUnit>, String>> {
    if is_too_long(name) {
        return None;
    }
    if is_time(name) {
        return Some(Ok(None));
    }
    if let (base, Some(text)) = bracketed(name) {
        // a unit in brackets, as in `time_ms [ms]`
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

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;

    fn joint(name: &str) -> Option<(Quantity, String, Option<f64>)> {
        match meaning(name, false) {
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
            ("actual_q_3_rad", Position, "3", Some(1.0)),
            ("q3 [mm]", Position, "3", Some(1e-3)),
            ("q3_m", Position, "3", Some(1.0)),
            ("elbow_position_m", Position, "elbow", Some(1.0)),
            ("elbow/position [deg]", Position, "elbow", Some(degree)),
            ("position.elbow_deg", Position, "elbow", Some(degree)),
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
            // no pattern has a unit in the middle of a name, or a joint's name after an underscore
            ("q_deg_1", Meaning::Nothing),
            ("position_deg.elbow", Meaning::Nothing),
            ("position_elbow", Meaning::Nothing),
            ("position.", Meaning::Nothing),
            ("temperature [C]", Meaning::Nothing),
            ("actual_TCP_speed_0", Meaning::Nothing),
        ] {
            assert_eq!(meaning(name, false), wanted, "{name}");
        }
    }

    /// The tables of patterns and words in the documentation are equal to those of this module.
    #[test]
    fn the_documentation_has_these_patterns_and_words() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/control/logs.md");
        let text = std::fs::read_to_string(path).unwrap();
        let has = |row: &str| assert!(text.contains(row), "docs/control/logs.md does not have\n{row}");
        for Pattern(form, between, after) in PATTERNS {
            let names = |quantity: &str, joint: &str| match form {
                Form::JointBefore => format!("`{joint}{between}{quantity}{after}`"),
                _ => format!("`{quantity}{between}{joint}{after}`"),
            };
            let [joint, example, words] = match form {
                Form::Number => ["{number}", "1", "q qd tau"],
                _ => ["{joint}", "elbow", "position velocity effort"],
            };
            let examples: Vec<String> = words.split(' ').map(|word| names(word, example)).collect();
            for example in &examples {
                assert!(matches!(meaning(example.trim_matches('`'), false), Meaning::Joint(_)), "{example}");
            }
            has(&format!("\n| {} | {} |", names("{quantity}", joint), examples.join(", ")));
        }
        let rows =
            text.lines().filter(|row| row.starts_with("| `") && row.contains("{quantity}") && row.contains("`, `"));
        assert_eq!(rows.count(), PATTERNS.len(), "docs/control/logs.md has other patterns too");
        let mut table = "\n| `{quantity}` | words |\n|---|---|\n".to_owned();
        for (quantity, is_current, words) in WORDS {
            let what = if is_current { "current" } else { quantity.word() };
            writeln!(table, "| {what} | `{}` |", words.join("`, `")).unwrap();
        }
        writeln!(table, "| time | `{}` |", TIMES.join("`, `")).unwrap();
        has(&table);
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
