//! What the columns of a table are, by their names.

use std::path::Path;

use crate::LogError;
use crate::spelling::listed;

/// What a column has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    Position,
    Velocity,
    Effort,
}

/// The words by which columns are known: at the end of a name or at its beginning, and before the number of a joint.
const WORDS: [(Quantity, &[&str]); 3] = [
    (Quantity::Position, &["q", "position", "positions", "pos", "angle", "angles"]),
    (Quantity::Velocity, &["qd", "dq", "velocity", "velocities", "vel", "speed"]),
    (Quantity::Effort, &["tau", "effort", "efforts", "torque", "torques", "current", "currents"]),
];

const TIMES: [&str; 8] = ["time", "t", "timestamp", "stamp", "__time", "time_s", "seconds", "time_from_start"];

/// The columns of a table that are read, by their places.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Columns {
    pub(crate) time: Option<usize>,
    /// Joints that have a position, in the order of these columns.
    pub(crate) names: Vec<String>,
    pub(crate) position: Vec<usize>,
    /// By joint; empty where no joint has one.
    pub(crate) velocity: Vec<Option<usize>>,
    pub(crate) effort: Vec<Option<usize>>,
    /// Remarks for the reader of a survey.
    pub(crate) notes: Vec<String>,
}

impl Columns {
    /// Finds out what columns are. With `prefix` those alone are joints' that begin with it.
    pub(crate) fn of(path: &Path, header: &[String], prefix: Option<&str>) -> Result<Self, LogError> {
        let mut columns = Self::default();
        let mut velocity = Vec::new();
        let mut effort = Vec::new();
        let mut currents = false;
        for (place, name) in header.iter().enumerate() {
            let inner = match prefix {
                Some(prefix) => name.trim_start_matches('/').strip_prefix(prefix.trim_matches('/')),
                None => Some(name.as_str()),
            };
            if is_time(name) || inner.is_some_and(is_time) {
                columns.time = columns.time.or(Some(place));
                continue;
            }
            let Some((quantity, word, joint)) = inner.and_then(meaning) else { continue };
            match quantity {
                Quantity::Position => {
                    if let Some(other) = columns.names.iter().position(|name| *name == joint) {
                        let other = &header[columns.position[other]];
                        let what = format!(
                            "the columns {other} and {name} are both positions of {joint}; say how the names of those \
                             that are meant begin, as in --topic actual"
                        );
                        return Err(LogError::request(path, what));
                    }
                    columns.names.push(joint);
                    columns.position.push(place);
                }
                Quantity::Velocity => velocity.push((joint, place)),
                Quantity::Effort => {
                    currents |= word.starts_with("current");
                    effort.push((joint, place));
                }
            }
        }
        if columns.names.is_empty() {
            let all = listed(header.iter().map(String::as_str));
            let of_prefix = prefix.map_or(String::new(), |prefix| format!(" that begins with {prefix}"));
            return Err(LogError::file(
                path,
                format_args!(
                    "no column{of_prefix} is the position of a joint: names are q1, q2, … or position and the \
                     joint, as in elbow/position, position.elbow, elbow_position; there is {all}"
                ),
            ));
        }
        columns.velocity = columns.by_joint(&velocity);
        columns.effort = columns.by_joint(&effort);
        if currents {
            columns
                .notes
                .push("efforts are from columns named current: --torque-constant makes torques of them".into());
        }
        Ok(columns)
    }

    fn by_joint(&self, found: &[(String, usize)]) -> Vec<Option<usize>> {
        let place = |name: &String| found.iter().find(|(joint, _)| joint == name).map(|(_, place)| *place);
        let places: Vec<_> = self.names.iter().map(place).collect();
        if places.iter().all(Option::is_none) { Vec::new() } else { places }
    }
}

pub(crate) fn is_time(name: &str) -> bool {
    let name = without_unit(name).to_lowercase();
    let last = name.rsplit(['/', '.']).next().unwrap_or_default();
    TIMES.contains(&last) || TIMES.contains(&name.trim_start_matches('/'))
}

/// What a list of numbers has, by the last word of its name.
#[cfg(feature = "parquet")]
pub(crate) fn list(name: &str) -> Option<Quantity> {
    let last = name.rsplit(['/', '.', '_']).next().unwrap_or_default().to_lowercase();
    // observation.state: what collections for learning have
    let is_state = last == "state" && name.starts_with("observation");
    let of_word = WORDS.iter().find(|(_, words)| words.contains(&last.as_str())).map(|(quantity, _)| *quantity);
    of_word.or(is_state.then_some(Quantity::Position))
}

/// What a column has, the word that says so, and the joint's name.
fn meaning(name: &str) -> Option<(Quantity, String, String)> {
    const SEPARATORS: [char; 7] = ['/', '.', '_', '[', ']', ' ', ':'];
    let name = without_unit(name).trim_matches(SEPARATORS);
    let quantity = |word: &str| {
        let word = word.to_lowercase();
        WORDS.iter().find(|(_, words)| words.contains(&word.as_str())).map(|(quantity, _)| (*quantity, word))
    };
    // q1, qd_2, actual_q_3
    let bare = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = &name[bare.len()..];
    let bare = bare.trim_end_matches(SEPARATORS);
    if !number.is_empty()
        && let Some((quantity, word)) = quantity(bare.rsplit(SEPARATORS).next().unwrap_or_default())
    {
        return Some((quantity, word, number.to_owned()));
    }
    // elbow/position
    if let Some((joint, last)) = name.rsplit_once(SEPARATORS)
        && let Some((quantity, word)) = quantity(last)
    {
        let joint = joint.trim_end_matches(SEPARATORS).rsplit('/').next().unwrap_or_default();
        return Some((quantity, word, joint.to_owned()));
    }
    // position.elbow
    let (first, joint) = name.split_once(SEPARATORS)?;
    let (quantity, word) = quantity(first)?;
    Some((quantity, word, joint.to_owned()))
}

/// A name without the unit behind it, as in `q1 [rad]`, `time (s)`.
fn without_unit(name: &str) -> &str {
    let name = name.trim();
    let Some(begin) = name.rfind(['[', '(']) else { return name };
    let inner = &name[begin + 1..];
    let is_unit = inner.ends_with([']', ')']) && inner.chars().any(char::is_alphabetic);
    if is_unit { name[..begin].trim_end() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(header: &[&str], prefix: Option<&str>) -> Result<Columns, LogError> {
        let header: Vec<String> = header.iter().map(|name| (*name).to_owned()).collect();
        Columns::of(Path::new("log.csv"), &header, prefix)
    }

    #[test]
    fn usual_names_are_understood() {
        for (header, names) in [
            (["time", "q1", "q2", "qd1", "qd2", "tau1", "tau2"], ["1", "2"]),
            (["t [s]", "q_0 [rad]", "q_1", "dq_0", "dq_1", "current_0", "current_1"], ["0", "1"]),
            (
                [
                    "__time",
                    "/js/a/position",
                    "/js/b/position",
                    "/js/a/velocity",
                    "/js/b/velocity",
                    "/js/a/effort",
                    "/js/b/effort",
                ],
                ["a", "b"],
            ),
            (
                [
                    "header.stamp",
                    "position.a_1",
                    "position.b_joint",
                    "velocity.a_1",
                    "velocity.b_joint",
                    "effort.a_1",
                    "effort.b_joint",
                ],
                ["a_1", "b_joint"],
            ),
            (
                ["time", "elbow_pos", "wrist_pos", "elbow_vel", "wrist_vel", "elbow_torque", "wrist_torque"],
                ["elbow", "wrist"],
            ),
        ] {
            let columns = columns(&header, None).unwrap();
            assert_eq!(columns.time, Some(0), "{header:?}");
            assert_eq!(columns.names, names, "{header:?}");
            assert_eq!(columns.position, [1, 2]);
            assert_eq!(columns.velocity, [Some(3), Some(4)]);
            assert_eq!(columns.effort, [Some(5), Some(6)]);
        }
    }

    #[test]
    fn one_of_two_groups_is_named() {
        let header = ["timestamp", "target_q_0", "actual_q_0", "actual_current_0"];
        let error = columns(&header, None).unwrap_err();
        assert!(error.is_of_request() && error.to_string().contains("target_q_0 and actual_q_0"), "{error}");
        let columns = columns(&header, Some("actual")).unwrap();
        assert_eq!((columns.position, columns.effort), (vec![2], vec![Some(3)]));
        assert!(columns.notes[0].contains("--torque-constant"));
    }

    #[test]
    fn a_table_without_positions_says_what_it_has() {
        let error = columns(&["a", "b"], None).unwrap_err();
        assert!(error.to_string().ends_with("there is a, b"), "{error}");
    }
}
