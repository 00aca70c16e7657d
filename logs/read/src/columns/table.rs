//! Chooses the columns of a table that are read, by their names.

use std::collections::HashSet;
use std::path::Path;

use crate::columns::header::{Found, Header, by_joint};
use crate::columns::quantity::Quantity;
use crate::columns::time_column::{TimeColumn, unread};
use crate::columns::unit::{Dimension, FileUnits, JointUnits};
use crate::limits::work;
use crate::spelling::listed;
use crate::{LogError, Options, TimeUnit};

/// A column of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Column {
    /// Index of the column in a row.
    pub(crate) place: usize,
    /// Factor from the unit in the column's name to the SI unit.
    pub(crate) factor: f64,
}

/// The columns of a table that are read, with their indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Columns {
    /// The index of the column of times, and the unit in its name.
    pub(crate) time: Option<(usize, Option<TimeUnit>)>,
    /// Names of the joints that have a position: first numbered joints by their numbers, then the others in the order
    /// of their columns.
    pub(crate) names: Vec<String>,
    pub(crate) position: Vec<Column>,
    /// For each joint its column, if it has one; empty if no joint has one.
    pub(crate) velocity: Vec<Option<Column>>,
    pub(crate) effort: Vec<Option<Column>>,
    pub(crate) acceleration: Vec<Option<Column>>,
    pub(crate) units: FileUnits,
    /// The names of columns whose numbers are converted, because their names have units other than SI.
    pub(crate) converted: Vec<String>,
    /// The names of columns that are not read: those that resemble columns of joints and, if no joint has a velocity or
    /// none has an effort, all others.
    pub(crate) unread: Vec<String>,
    /// Other remarks for the reader of a survey.
    notes: Vec<String>,
}

impl Columns {
    /// Finds the meanings of the columns. If the options have a topic, it is a prefix: only columns that begin with it
    /// belong to joints.
    pub(crate) fn of(path: &Path, header: &[String], options: &Options) -> Result<Self, LogError> {
        let named = Header::read(path, header, options)?;
        let [positions, velocities, efforts, accelerations] = Quantity::ALL.map(|quantity| named.of(quantity));
        if positions.is_empty() {
            return Err(named.without_positions());
        }
        named.check_map(&positions, options)?;
        let efforts = torques_or_currents(&efforts, !options.torque_constants.is_empty());
        for found in [&positions, &velocities, &efforts, &accelerations] {
            named.check_count(found)?;
            named.check_once(found)?;
        }
        named.check_numbers(&positions, &[&velocities, &efforts, &accelerations], options)?;
        named.check_units(&positions, &[&velocities[..], &accelerations].concat(), &efforts, options)?;
        let mut joints = positions;
        joints.sort_by_key(|found| found.named.number.unwrap_or(u32::MAX));
        let name = |place: usize| header[place].as_str();
        let time = TimeColumn::choose(path, &named.times, name, options)?;
        let mut notes = Vec::new();
        note("other times that are not read", &unread(&named.times, time, name), &mut notes);
        notes.extend(lacking(&joints, &velocities, &efforts));
        let mut columns = Self {
            time: time.map(|time| (time.place, time.unit)),
            converted: named.converted(time, &[&joints[..], &velocities, &efforts, &accelerations].concat()),
            unread: named.unread(&joints, &velocities, &[&efforts[..], &accelerations].concat()),
            names: joints.iter().map(|found| found.named.joint.clone()).collect(),
            position: joints.iter().map(|found| found.column()).collect(),
            notes,
            ..Self::default()
        };
        let others = [&velocities, &efforts, &accelerations].map(|found| by_joint(found));
        for (joint, position) in columns.names.iter().zip(&joints) {
            let [velocity, effort, acceleration] = others.each_ref().map(|found| found.get(joint.as_str()).copied());
            let dimension = |found: Option<&Found>| found.and_then(Found::dimension);
            let units = JointUnits {
                position: position.dimension(),
                velocity: dimension(velocity),
                effort: dimension(effort),
                acceleration: dimension(acceleration),
            };
            columns.units.joints.insert(joint.clone(), units);
            columns.velocity.push(velocity.map(Found::column));
            columns.effort.push(effort.map(Found::column));
            columns.acceleration.push(acceleration.map(Found::column));
        }
        for list in [&mut columns.velocity, &mut columns.effort, &mut columns.acceleration] {
            if list.iter().all(Option::is_none) {
                list.clear();
            }
        }
        Ok(columns)
    }

    /// Returns remarks on columns with converted units, on columns that are not read, and other notes.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let unread = (!self.unread.is_empty()).then(|| format!("columns that are not read: {}", listed(&self.unread)));
        converted(&self.converted).into_iter().chain(unread).chain(self.notes.iter().cloned()).collect()
    }
}

/// Returns a remark on columns with units other than SI in their names.
pub(crate) fn converted(names: &[String]) -> Option<String> {
    let listed = listed(names);
    (!names.is_empty()).then(|| format!("rne converts numbers from the units in the names of columns: {listed}"))
}

/// Selects one column of efforts for joints that have torques and currents: currents if the options have torque
/// constants, torques otherwise.
fn torques_or_currents<'f>(efforts: &[&'f Found], has_constants: bool) -> Vec<&'f Found> {
    let is_current = |found: &Found| found.dimension() == Some(Dimension::Current);
    let joints = |current: bool| -> HashSet<&str> {
        work::add(efforts.len());
        let found = efforts.iter().filter(|found| is_current(found) == current);
        found.map(|found| found.named.joint.as_str()).collect()
    };
    let (currents, torques) = (joints(true), joints(false));
    let has_other = |found: &Found| {
        let others = if is_current(found) { &torques } else { &currents };
        others.contains(found.named.joint.as_str())
    };
    let is_meant = |found: &&&Found| !has_other(found) || is_current(found) == has_constants;
    efforts.iter().filter(is_meant).copied().collect()
}

/// Adds a remark on these names, if there are any.
pub(crate) fn note(what: &str, names: &[&str], notes: &mut Vec<String>) {
    if !names.is_empty() {
        notes.push(format!("{what}: {}", listed(names)));
    }
}

/// Returns remarks on joints without a velocity or an effort that other joints have.
fn lacking(joints: &[&Found], velocities: &[&Found], efforts: &[&Found]) -> Vec<String> {
    let mut notes = Vec::new();
    for found in [velocities, efforts] {
        let has = by_joint(found);
        let has = |joint: &str| has.contains_key(joint);
        let names = || joints.iter().map(|joint| joint.named.joint.as_str());
        if let Some(one) = found.first().filter(|_| names().any(has)) {
            let without: Vec<&str> = names().filter(|joint| !has(joint)).collect();
            note(&format!("joints without a column of {}", one.named.quantity.plural()), &without, &mut notes);
        }
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Angles;

    fn columns(header: &[&str], options: &Options) -> Result<Columns, LogError> {
        let header: Vec<String> = header.iter().map(|name| (*name).to_owned()).collect();
        Columns::of(Path::new("log.csv"), &header, options)
    }

    fn places(columns: &[Option<Column>]) -> Vec<Option<usize>> {
        columns.iter().map(|column| column.map(|column| column.place)).collect()
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
            let columns = columns(&header, &Options::default()).unwrap();
            assert_eq!(columns.time.map(|(place, _)| place), Some(0), "{header:?}");
            assert_eq!(columns.names, names, "{header:?}");
            assert_eq!(columns.position.iter().map(|column| column.place).collect::<Vec<_>>(), [1, 2]);
            assert_eq!(places(&columns.velocity), [Some(3), Some(4)]);
            assert_eq!(places(&columns.effort), [Some(5), Some(6)]);
        }
    }

    #[test]
    fn one_of_two_groups_is_named() {
        let header = ["timestamp", "target_q_0", "actual_q_0", "actual_current_0"];
        let error = columns(&header, &Options::default()).unwrap_err();
        assert!(error.is_of_request() && error.to_string().contains("target_q_0 and actual_q_0, 2 and 3"), "{error}");
        let options = Options { topic: Some("actual".into()), ..Options::default() };
        let columns = columns(&header, &options).unwrap();
        assert_eq!((columns.position[0].place, places(&columns.effort)), (2, vec![Some(3)]));
        assert_eq!(columns.units.of("0").effort, Some(Dimension::Current));
    }

    #[test]
    fn a_table_without_positions_says_what_it_has() {
        let error = columns(&["a", "b"], &Options::default()).unwrap_err();
        assert!(error.to_string().ends_with("the columns of this file are a, b"), "{error}");
    }

    #[test]
    fn numbers_are_joints_in_any_order() {
        let mut header = vec!["time".to_owned()];
        for quantity in ["q", "position_", "qd", "tau"] {
            // in the order of sorted texts: 1, 10, 11, 2 and so on
            let mut names: Vec<String> = (1..=11).map(|joint| format!("{quantity}{joint}")).collect();
            names.sort();
            header.extend(names.into_iter().filter(|_| quantity != "position_"));
        }
        let columns = Columns::of(Path::new("log.csv"), &header, &Options::default()).unwrap();
        for joint in 0..11 {
            let number = joint + 1;
            assert_eq!(columns.names[joint], number.to_string());
            assert_eq!(header[columns.position[joint].place], format!("q{number}"));
            assert_eq!(header[columns.velocity[joint].unwrap().place], format!("qd{number}"));
            assert_eq!(header[columns.effort[joint].unwrap().place], format!("tau{number}"));
        }
    }

    /// Unclear headers are refused; each entry has a part of the message.
    #[test]
    fn what_is_not_clear_is_refused() {
        let degrees = Options { angles: Angles::Degrees, ..Options::default() };
        let radians = Options { angles: Angles::Radians, ..Options::default() };
        let currents = Options { torque_constants: vec![0.1], ..Options::default() };
        let milliseconds = Options { time_unit: Some(TimeUnit::Milliseconds), ..Options::default() };
        let two = Options { joints: Some(vec!["3".into(), "1".into()]), ..Options::default() };
        let unsaid = Options::default();
        for (header, options, wanted) in [
            (&["t", "q1", "q3"][..], &unsaid, Some("but 2 is missing; name the joints if you want only these")),
            (&["t", "q1", "q3"], &two, None),
            (&["t", "q2", "q3"], &unsaid, Some("but 1 is missing")),
            (&["t", "q0", "q1"], &unsaid, None),
            (&["t", "q1", "q2", "tau1"], &unsaid, Some("the position of joint 2 but not its effort")),
            (&["t", "q1", "q2", "tau0", "tau1"], &unsaid, Some("the position of joint 2 but not its effort")),
            (&["t", "q1", "q2", "tau1", "tau2", "tau3"], &unsaid, Some("the effort of joint 3 but not its position")),
            (
                &["t", "q1", "q01"],
                &unsaid,
                Some("the columns q1 and q01, 2 and 3 of the table, are both positions of 1"),
            ),
            (&["t", "q1", "tau1", "tau1"], &unsaid, Some("tau1 and tau1, 3 and 4 of the table, are both efforts of 1")),
            (&["t", "q1", "tau1", "torque_1"], &unsaid, Some("tau1 and torque_1, 3 and 4 of the table")),
            (&["t", "q1", "qd1", "dq1"], &unsaid, Some("qd1 and dq1, 3 and 4 of the table, are both velocities")),
            (
                &["t", "q1 [furlong]"],
                &unsaid,
                Some("positions in furlong, which is not a known unit; the known units are rad"),
            ),
            (&["t", "q1 [deg]", "q2"], &unsaid, Some("q1 [deg] gives a unit, but the name q2 does not")),
            (&["t", "q1 [deg]", "qd1"], &unsaid, Some("q1 [deg] gives a unit, but the name qd1 does not")),
            (&["t", "q1 [deg]", "qd1"], &degrees, None),
            (&["t", "q1 [deg]", "qd1"], &radians, None),
            (&["t", "q1 [deg]"], &degrees, None),
            (&["t", "q1 [deg]"], &radians, Some("q1 [deg] gives its unit, and so do all other columns")),
            (&["t", "q1 [rad]"], &degrees, Some("q1 [rad] gives its unit, and so do all other columns")),
            (
                &["t", "q1 [mm]", "qd1"],
                &degrees,
                Some("q1 [mm], qd1 belong to one joint, but a joint either turns or slides, and rne reads columns"),
            ),
            (&["t", "q1", "qd1 [m/s]"], &degrees, Some("q1, qd1 [m/s] belong to one joint")),
            (&["t", "q1 [mm]", "qd1 [deg/s]"], &unsaid, Some("a joint either turns or slides")),
            (&["t", "q1 [rad]", "tau1 [N]"], &unsaid, Some("a joint either turns or slides")),
            (
                &["t", "q1", "q2", "tau1 [mNm]", "tau2"],
                &unsaid,
                Some("tau1 [mNm] gives a unit, but the name tau2 does not"),
            ),
            (&["t", "q1", "tau1 [Nm]"], &currents, Some("tau1 [Nm] has no current")),
            (&["t", "q1", "i1 [A]"], &currents, None),
            (&["t [s]", "q1"], &milliseconds, Some("the column t [s] has times in s, but you gave ms")),
            (&["t [min]", "q1"], &unsaid, Some("times in min, but the known units are s, ms, us, ns")),
            (&["stamp_sec", "stamp_nanosec", "q1"], &unsaid, Some("stamp_sec and stamp_nanosec both contain times")),
        ] {
            match (columns(header, options), wanted) {
                (Err(error), Some(wanted)) => assert!(error.to_string().contains(wanted), "{header:?}: {error}"),
                (Ok(_), None) => {}
                (found, wanted) => panic!("{header:?}: {found:?} and not {wanted:?}"),
            }
        }
    }

    /// Names of columns with this number of joints, each with a position, a torque and a current, and with as many
    /// other columns.
    fn wide(joints: usize) -> Vec<String> {
        let names_of = |joint| [format!("a{joint}_position"), format!("a{joint}_torque"), format!("a{joint}_current")];
        let others = (0..joints).map(|other| format!("temperature {other}"));
        ["t".to_owned()].into_iter().chain((0..joints).flat_map(names_of)).chain(others).collect()
    }

    #[test]
    fn the_work_on_columns_grows_as_they_do() {
        let work = [300, 600].map(|joints| {
            let header = wide(joints);
            work::of(|| {
                let columns = Columns::of(Path::new("log.csv"), &header, &Options::default()).unwrap();
                assert_eq!((columns.names.len(), columns.unread.len()), (joints, 2 * joints));
            })
        });
        assert!(work[0] > 4 * 300 && work[0] < 40 * 300, "{work:?}");
        assert!(work[1] <= 2 * work[0], "{work:?}");
    }

    #[test]
    fn a_table_has_1024_joints_at_most() {
        let header = |quantity: &str, joints: usize| -> Vec<String> {
            ["t".to_owned(), "q1".to_owned()]
                .into_iter()
                .chain((0..joints).map(|joint| format!("j{joint}_{quantity}")))
                .collect()
        };
        let read = |header: &[String]| Columns::of(Path::new("log.csv"), header, &Options::default());
        assert_eq!(read(&header("position", 1023)).unwrap().names.len(), 1024);
        for (quantity, joints, plural) in [("position", 1024, "positions"), ("effort", 1025, "efforts")] {
            let error = read(&header(quantity, joints)).unwrap_err().to_string();
            assert!(error.contains(&format!("1025 columns of {plural}; rne reads at most 1024 joints")), "{error}");
        }
        // a long name that is not that of a joint takes no time
        let long = "q_1_".repeat(250_000);
        assert!(read(&["t".into(), "q1".into(), long]).is_ok());
    }

    /// With two arms in one table, the column of times of the arm that is read is used.
    #[test]
    fn times_are_those_of_the_group() {
        let right = Options { topic: Some("right".into()), ..Options::default() };
        let time = |header: &[&str], options: &Options| columns(header, options).map(|columns| columns.time.unwrap().0);
        for (header, place) in [
            (["left/t", "left/q1", "right/t", "right/q1"], 2),
            (["t", "left/q1", "right/t", "right/q1"], 2),
            (["/left/stamp", "/left/q1", "/right/stamp", "/right/q1"], 2),
            (["t", "left/q1", "x", "right/q1"], 0),
        ] {
            assert_eq!(time(&header, &right).unwrap(), place, "{header:?}");
        }
        let error = columns(&["t", "left/t", "right/q1"], &right).unwrap_err();
        assert!(error.is_of_request(), "{error}");
        assert!(
            error.to_string().contains("the columns t and left/t both contain times, and neither begins"),
            "{error}"
        );
        assert_eq!(time(&["t", "stamp", "q1"], &Options::default()).unwrap(), 0);
    }

    #[test]
    fn torques_and_currents_of_one_joint_are_told_apart() {
        let header = ["t", "q1", "tau1", "current1"];
        let torques = columns(&header, &Options::default()).unwrap();
        assert_eq!((places(&torques.effort), torques.units.of("1").effort), (vec![Some(2)], None));
        assert!(torques.unread.contains(&"current1".to_owned()), "{:?}", torques.unread);
        let currents = columns(&header, &Options { torque_constants: vec![0.1], ..Options::default() }).unwrap();
        assert_eq!(
            (places(&currents.effort), currents.units.of("1").effort),
            (vec![Some(3)], Some(Dimension::Current))
        );
    }

    #[test]
    fn what_is_not_read_is_said() {
        let remarks = |header: &[&str]| columns(header, &Options::default()).unwrap().remarks();
        assert_eq!(
            remarks(&["t_ms", "stamp", "q1 [deg]", "q1_ref", "wrist_effort", "qd1 [rad/s]", "tau1", "temperature"]),
            [
                "rne converts numbers from the units in the names of columns: t_ms, q1 [deg]",
                "columns that are not read: q1_ref, wrist_effort",
                "other times that are not read: stamp",
            ]
        );
        // a missing quantity may be in a column whose name has no known meaning
        assert_eq!(
            remarks(&["t", "q1", "Drehmoment 1", "", "Geschwindigkeit 1"]),
            ["columns that are not read: Drehmoment 1, Geschwindigkeit 1"]
        );
        assert_eq!(remarks(&["t [s]", "q1", "qd1", "tau1", "Temperatur"]), [""; 0]);
    }
}
