//! Gives meanings to columns of a table whose names do not show them.

use std::fmt;
use std::str::FromStr;

use crate::TimeUnit;
use crate::columns::guess::{self, Named, bracketed, joint_number};
use crate::columns::quantity::Quantity;
use crate::columns::unit::{Unit, time};
use crate::spelling::{instead, listed};

/// A column of a table with its meaning.
///
/// ```
/// use rne_logs::{Mapping, Quantity, Target};
///
/// let target: Target = "elbow.position".parse()?;
/// assert_eq!(target, Target::Joint { joint: "elbow".into(), quantity: Quantity::Position });
/// let mapping = Mapping { target, column: "Pos 2 [deg]".into() };
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mapping {
    /// The meaning of the column.
    pub target: Target,
    /// The name of the column, with its unit in brackets: either the brackets belong to the name, or they are added to
    /// it. Without a unit, positions are in the unit of [`Options::angles`](crate::Options::angles).
    pub column: String,
}

/// The meaning of a column: time, or a quantity of a joint.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// The time of a sample.
    Time,
    /// A quantity of a joint.
    Joint {
        /// The name of the joint in the log.
        joint: String,
        /// The quantity.
        quantity: Quantity,
    },
}

impl Target {
    /// Returns the target that a column with this name has without a map.
    pub(crate) fn of(named: &Named) -> Self {
        Self::Joint { joint: named.joint.clone(), quantity: named.quantity }
    }
}

impl FromStr for Target {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "time" {
            return Ok(Self::Time);
        }
        let Some((joint, word)) = text.rsplit_once('.').filter(|(joint, _)| !joint.is_empty()) else {
            return Err(format!("`{text}` is neither `time` nor a joint with a quantity, such as `elbow.position`"));
        };
        let quantity = Quantity::ALL.into_iter().find(|quantity| quantity.word() == word).ok_or_else(|| {
            let words = Quantity::ALL.map(Quantity::word);
            let near = instead(word, words);
            format!("`{word}` is not a quantity of a joint{near}; the quantities are {}", words.join(", "))
        })?;
        Ok(Self::Joint { joint: joint.to_owned(), quantity })
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => f.write_str("time"),
            Self::Joint { joint, quantity } => write!(f, "{joint}.{}", quantity.word()),
        }
    }
}

/// The meaning of a mapped column, with its unit.
pub(crate) enum Mapped {
    Time(Option<TimeUnit>),
    Joint(Named),
}

impl Mapping {
    /// Returns the index of the column among the names of a header, with its meaning.
    ///
    /// # Errors
    /// When no column has this name, or its unit is unknown.
    pub(crate) fn find(&self, header: &[String]) -> Result<(usize, Mapped), String> {
        let place = |name: &str| header.iter().position(|other| other.trim() == name.trim());
        let (base, unit) = bracketed(&self.column);
        let found = place(&self.column).or_else(|| unit.and_then(|_| place(base)));
        let Some(found) = found else {
            let near = instead(base, header);
            let all = listed(header);
            return Err(format!(
                "the table has no column `{}` for {}{near}; its columns are {all}",
                self.column, self.target
            ));
        };
        let unknown = |unit: &str, known: &str| {
            format!(
                "`{unit}` is not a unit for {}, the column `{}`; the known units are {known}",
                self.target, self.column
            )
        };
        let mapped = match &self.target {
            Target::Time => {
                let read = |unit: &str| time(unit).ok_or_else(|| unknown(unit, "s, ms, us, ns"));
                Mapped::Time(unit.map(read).transpose()?)
            }
            Target::Joint { joint, quantity } => {
                let read =
                    |unit: &str| Unit::parse(*quantity, unit).ok_or_else(|| unknown(unit, Unit::known(*quantity)));
                Mapped::Joint(Named {
                    quantity: *quantity,
                    is_current: false,
                    number: joint_number(joint),
                    joint: joint.clone(),
                    unit: unit.map(read).transpose()?,
                })
            }
        };
        Ok((found, mapped))
    }
}

/// Parts of words in several languages that hint at a quantity. They are not used to read a table, only to make a
/// [suggestion](suggested).
const HINTS: [(Quantity, &[&str]); 3] = [
    (Quantity::Position, &["pos", "angle", "winkel", "lage", "theta"]),
    (Quantity::Velocity, &["vel", "speed", "geschw", "omega", "vitesse"]),
    (Quantity::Effort, &["tau", "torque", "effort", "moment", "couple", "force", "kraft", "current", "strom"]),
];

/// Words in names of columns that hint at times.
const HINTS_OF_TIME: [&str; 6] = ["time", "stamp", "zeit", "temps", "clock", "date"];

/// Suggests mappings of a table for these joints, which the user corrects. A column is chosen by hints in its name;
/// without any, its name in the suggestion is `COLUMN`.
#[must_use]
pub fn suggested(columns: &[String], joints: &[String]) -> Vec<Mapping> {
    let is_time = |name: &&String| bracketed(name).1.is_some_and(|unit| time(unit).is_some());
    let mut found = Vec::new();
    let mut suggest = |target: Target, column: Option<&String>| {
        found.push(Mapping { target, column: column.map_or_else(|| "COLUMN".to_owned(), Clone::clone) });
    };
    if !columns.iter().any(|column| matches!(guess::time(column), Some(Ok(_)))) {
        let hints = |column: &&String| HINTS_OF_TIME.iter().any(|hint| column.to_lowercase().contains(hint));
        suggest(Target::Time, columns.iter().find(is_time).or_else(|| columns.iter().find(hints)));
    }
    for (index, joint) in joints.iter().enumerate() {
        for (quantity, hints) in HINTS {
            let number = (index + 1).to_string();
            let column = columns.iter().find(|column| {
                let column = column.to_lowercase();
                let has_number = column.split(|c: char| !c.is_ascii_digit()).any(|digits| digits == number);
                (column.contains(&joint.to_lowercase()) || has_number) && hints.iter().any(|hint| column.contains(hint))
            });
            if column.is_some() || quantity != Quantity::Velocity {
                suggest(Target::Joint { joint: joint.clone(), quantity }, column);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn targets_are_written_as_they_are_read() {
        for text in ["time", "elbow.position", "arm.left.velocity", "1.effort", "j.acceleration"] {
            assert_eq!(text.parse::<Target>().unwrap().to_string(), text);
        }
        for (text, wanted) in [
            ("elbow", "`elbow` is neither `time` nor a joint with a quantity, such as `elbow.position`"),
            (".position", "is neither `time`"),
            (
                "elbow.positon",
                "`positon` is not a quantity of a joint (did you mean position?); the quantities are position, \
                 velocity, effort, acceleration",
            ),
        ] {
            let error = text.parse::<Target>().unwrap_err();
            assert!(error.contains(wanted), "{error}");
        }
    }

    #[test]
    fn columns_are_found_with_their_units() {
        let header = names(&["Zeit", "w 1 [deg]", "w 1", "F"]);
        let find = |target: &str, column: &str| {
            let mapping = Mapping { target: target.parse().unwrap(), column: column.to_owned() };
            mapping.find(&header).map(|(place, mapped)| match mapped {
                Mapped::Time(unit) => (place, unit.map(|unit| unit.name().to_owned())),
                Mapped::Joint(named) => (place, named.unit.map(|unit| format!("{:.4}", unit.factor))),
            })
        };
        assert_eq!(find("time", "Zeit [ms]"), Ok((0, Some("ms".into()))));
        assert_eq!(find("time", "Zeit"), Ok((0, None)));
        assert_eq!(find("a.position", "w 1 [deg]"), Ok((1, Some("0.0175".into()))), "brackets of the name");
        assert_eq!(find("a.position", "w 1 [mrad]"), Ok((2, Some("0.0010".into()))), "brackets that were added");
        assert_eq!(find("a.effort", "F"), Ok((3, None)));
        for (target, column, wanted) in [
            ("a.position", "W 1", "the table has no column `W 1` for a.position (did you mean w 1?)"),
            (
                "a.effort",
                "F [deg]",
                "`deg` is not a unit for a.effort, the column `F [deg]`; the known units are Nm, mNm",
            ),
            (
                "time",
                "Zeit [min]",
                "`min` is not a unit for time, the column `Zeit [min]`; the known units are s, ms, us, ns",
            ),
            ("a.acceleration", "F [deg/s]", "the known units are rad/s^2"),
        ] {
            let error = find(target, column).unwrap_err();
            assert!(error.contains(wanted), "{error}");
        }
    }

    #[test]
    fn suggestions_take_columns_by_name_or_number() {
        let columns = names(&["Zeit [s]", "Achse1_Lage", "Achse1_Moment", "Achse12_Lage", "elbow speed", "x"]);
        let said: Vec<String> = suggested(&columns, &names(&["base", "elbow"]))
            .iter()
            .map(|mapping| format!("{}={}", mapping.target, mapping.column))
            .collect();
        assert_eq!(
            said,
            [
                "time=Zeit [s]",
                "base.position=Achse1_Lage",
                "base.effort=Achse1_Moment",
                "elbow.position=COLUMN",
                "elbow.velocity=elbow speed",
                "elbow.effort=COLUMN",
            ]
        );
    }
}
