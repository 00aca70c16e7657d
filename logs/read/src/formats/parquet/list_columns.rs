//! Finds by their names the columns of lists of a table, which have in each row one number for each joint.

use std::path::Path;

use crate::columns::guess::{Meaning, Named, meaning};
use crate::columns::quantity::Quantity;
use crate::columns::time_column::within;
use crate::columns::unit::{Dimension, JointUnits, Unit};
use crate::options::Angles;
use crate::remedy::Setting;
use crate::spelling::listed;
use crate::{LogError, Options};

/// The columns of lists that are read: their indices, and the factors of their numbers.
#[derive(Debug, Default)]
pub(crate) struct ListColumns {
    pub(crate) position: Option<(usize, f64)>,
    pub(crate) velocity: Option<(usize, f64)>,
    pub(crate) effort: Option<(usize, f64)>,
    /// The units, which are the same for every joint.
    pub(crate) units: JointUnits,
    /// The names of columns whose numbers are converted, because their names have units other than SI.
    pub(crate) converted: Vec<String>,
}

impl ListColumns {
    /// Finds the columns of lists among columns of numbers, given by their indices and names.
    pub(crate) fn of<'a>(
        path: &Path,
        columns: impl Iterator<Item = (usize, &'a str)>,
        options: &Options,
    ) -> Result<Self, LogError> {
        let mut lists = Self::default();
        // quantity, name and unit of each list
        let mut found: Vec<(Quantity, &str, Option<Unit>)> = Vec::new();
        for (place, name) in columns {
            let Named { quantity, is_current, unit, .. } = match meaning(name, true) {
                Meaning::Joint(named) => named,
                Meaning::Unknown { quantity, unit } => return Err(Unit::unknown(path, name, quantity, &unit)),
                Meaning::Like | Meaning::Nothing => continue,
            };
            if let Some((_, first, _)) = found.iter().find(|(other, ..)| *other == quantity) {
                let what = format!(
                    "the columns {first} and {name} are both {}; remove one, or choose a group",
                    quantity.plural()
                );
                return Err(LogError::request(path, what).give(Setting::Prefix));
            }
            found.push((quantity, name, unit));
            lists.converted.extend(unit.filter(|unit| !unit.is_si()).map(|_| name.to_owned()));
            let (list, said) = match quantity {
                Quantity::Position => (&mut lists.position, &mut lists.units.position),
                Quantity::Velocity => (&mut lists.velocity, &mut lists.units.velocity),
                Quantity::Effort => (&mut lists.effort, &mut lists.units.effort),
                // lists of accelerations have no known name
                Quantity::Acceleration => continue,
            };
            *list = Some((place, unit.map_or(1.0, |unit| unit.factor)));
            *said = unit.map(|unit| unit.dimension).or(is_current.then_some(Dimension::Current));
        }
        let motions = || found.iter().filter(|(quantity, ..)| *quantity != Quantity::Effort);
        let said = motions().find(|(.., unit)| unit.is_some_and(|unit| !unit.is_si()));
        let unsaid = motions().find(|(.., unit)| unit.is_none());
        if let (Some((_, said, _)), Some((_, unsaid, _)), Angles::Unsaid) = (said, unsaid, options.angles) {
            let what = format!("the name of the column {said} gives a unit, but the name {unsaid} does not");
            return Err(LogError::request(path, what).give(Setting::Angles));
        }
        Ok(lists)
    }
}

/// Returns the column with the names of the joints among columns of texts. If there are several, it takes those with
/// the prefix that the options ask for, then the one whose name begins like that of the positions.
pub(crate) fn names<'a>(
    path: &Path,
    texts: impl Iterator<Item = (usize, &'a str)>,
    position: &str,
    options: &Options,
) -> Result<Option<usize>, LogError> {
    let stem = |name: &'a str| name.trim_end_matches("names").trim_end_matches("name");
    let all: Vec<(usize, &str)> = texts.filter(|(_, name)| stem(name).len() < name.len()).collect();
    let of_group: Vec<(usize, &str)> =
        all.iter().filter(|(_, name)| within(name, options).is_some()).copied().collect();
    if let (true, [(_, name)]) = (of_group.is_empty(), all.as_slice())
        && stem(name).ends_with(['/', '.'])
    {
        let what = format!(
            "the column {name} has names of joints, but does not begin with {} like the columns of positions: rne does \
             not know to which arm the names belong; rename the column so that it begins with this prefix, or with no \
             prefix if the names are valid for every arm",
            options.topic.as_deref().unwrap_or_default()
        );
        return Err(LogError::request(path, what));
    }
    let near = if of_group.is_empty() { &all } else { &of_group };
    let begins = |(_, name): &&(usize, &'a str)| {
        let end = position.rfind(['/', '.', '_', ' ']).map_or(0, |end| end + 1);
        stem(name) == &position[..end]
    };
    match near.as_slice() {
        [] => Ok(None),
        [(place, _)] => Ok(Some(*place)),
        several => match several.iter().find(begins).map(|(place, _)| *place) {
            None => {
                let what = format!(
                    "the columns {} all contain names of joints, and none has the name of {position} with another \
                     ending; keep only one of these columns, or choose a group",
                    listed(several.iter().map(|(_, name)| name))
                );
                Err(LogError::request(path, what).give(Setting::Prefix))
            }
            place => Ok(place),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lists(names: &[&str]) -> Result<ListColumns, LogError> {
        ListColumns::of(Path::new("log.parquet"), names.iter().copied().enumerate(), &Options::default())
    }

    #[test]
    fn names_are_those_of_the_positions() {
        let right = Options { topic: Some("/right".into()), ..Options::default() };
        let (any, of) = (Options::default(), |texts: &[&'static str], position, options: &Options| {
            names(Path::new("log.parquet"), texts.iter().copied().enumerate(), position, options)
        });
        for (texts, position, options, place) in [
            (&["left.name", "right.name"][..], "right.position", &right, Some(1)),
            (&["/left/name", "/right/name"], "/right/position", &right, Some(1)),
            (&["left.name", "right.name"], "right.position", &any, Some(1)),
            (&["name", "camera_name"], "position", &any, Some(0)),
            (&["camera_name", "joint_names"], "joint_positions", &any, Some(1)),
            (&["name"], "right.position", &right, Some(0)),
            (&["frame", "label"], "position", &any, None),
        ] {
            assert_eq!(of(texts, position, options).unwrap(), place, "{texts:?}");
        }
        let error = of(&["left.name"], "right.position", &right).unwrap_err();
        assert!(error.to_string().contains("left.name has names of joints, but does not begin with /right"), "{error}");
        let error = of(&["left.name", "centre.name"], "right.position", &right).unwrap_err();
        assert!(
            error.is_of_request() && error.to_string().contains("left.name, centre.name all contain names of joints"),
            "{error}"
        );
    }

    #[test]
    fn lists_say_units() {
        let found = lists(&["position_deg", "velocity [deg/s]", "current", "image"]).unwrap();
        let degree = std::f64::consts::PI / 180.0;
        assert_eq!(
            (found.position, found.velocity, found.effort),
            (Some((0, degree)), Some((1, degree)), Some((2, 1.0)))
        );
        assert_eq!(found.units.position, Some(Dimension::Angle));
        assert_eq!(found.units.effort, Some(Dimension::Current));
        assert_eq!(found.converted, ["position_deg", "velocity [deg/s]"]);
        let found = lists(&["observation.state", "observation.environment_state"]).unwrap();
        assert_eq!(found.position, Some((0, 1.0)));
        for (names, wanted) in [
            (["actual.q", "target.q"], "actual.q and target.q are both positions"),
            (["position_deg", "velocity"], "position_deg gives a unit, but the name velocity does not"),
            (["position [gon]", "velocity"], "positions in gon, which is not a known unit"),
        ] {
            let error = lists(&names).unwrap_err().to_string();
            assert!(error.contains(wanted), "{error}");
        }
    }
}
