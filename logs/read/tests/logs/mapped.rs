//! Tables whose names say nothing: by a map they are the motion of the plain table.

use rne_logs::{Angles, LogError, Mapping, Motion, Options, suggested};

use crate::written::{csv, file, runs, survey};

/// The plain table, and another with its header.
fn plain() -> (String, impl Fn(&str) -> String) {
    let times: Vec<f64> = (0..600).map(|i| f64::from(i) * 0.01).collect();
    let text = csv(&times);
    let rows = text.split_once('\n').unwrap().1.to_owned();
    (text, move |header: &str| format!("{header}\n{rows}"))
}

fn map(mappings: &[(&str, &str)]) -> Vec<Mapping> {
    let mapping =
        |(target, column): &(&str, &str)| Mapping { target: target.parse().unwrap(), column: (*column).to_owned() };
    mappings.iter().map(mapping).collect()
}

fn read(text: &str, map: Vec<Mapping>, options: Options) -> Result<Motion, LogError> {
    let (_folder, path) = file("log.csv", text);
    let mut runs = runs(&[path], Options { cutoff: Some(8.0), map, ..options }, 1000)?;
    assert_eq!(runs.len(), 1);
    Ok(runs.remove(0).1)
}

const ALL: [(&str, &str); 7] = [
    ("time", "Zeit"),
    ("1.position", "w1"),
    ("2.position", "w2"),
    ("1.velocity", "W1"),
    ("2.velocity", "W2"),
    ("1.effort", "M1"),
    ("2.effort", "M2"),
];

#[test]
fn a_mapped_table_is_the_plain_one() {
    let (text, with) = plain();
    let expected = read(&text, Vec::new(), Options::default()).unwrap();
    let strange = with("Zeit,w1,w2,W1,W2,M1,M2");
    assert_eq!(read(&strange, map(&ALL), Options::default()).unwrap(), expected, "to the bit");
    // the order of the map does not matter, and units that are those of SI change nothing
    let said: Vec<(&str, &str)> = [
        ("2.effort", "M2 [Nm]"),
        ("1.effort", "M1 [Nm]"),
        ("2.velocity", "W2 [rad/s]"),
        ("1.velocity", "W1 [rad/s]"),
        ("2.position", "w2 [rad]"),
        ("1.position", "w1 [rad]"),
        ("time", "Zeit [s]"),
    ]
    .to_vec();
    assert_eq!(read(&strange, map(&said), Options::default()).unwrap(), expected);
    // what is not mapped is read by its name, and a mapped quantity by the map alone
    let partly = with("t,q1,q2,W1,qd2,M1,tau2");
    assert_eq!(read(&partly, map(&[("1.velocity", "W1"), ("1.effort", "M1")]), Options::default()).unwrap(), expected);
    let swapped = with("t,q2,q1,qd1,qd2,tau1,tau2");
    let of_map = map(&[("1.position", "q2"), ("2.position", "q1")]);
    assert_eq!(read(&swapped, of_map, Options::default()).unwrap(), expected);
    // names of joints are those of the map
    let named = ALL.map(|(target, column)| (target.replace("1.", "base.").replace("2.", "elbow."), column));
    let named: Vec<(&str, &str)> = named.iter().map(|(target, column)| (target.as_str(), *column)).collect();
    let (_folder, path) = file("log.csv", &strange);
    let options = Options { map: map(&named), ..Options::default() };
    assert_eq!(survey(&[path], options).unwrap().0.layout().joints, ["base", "elbow"]);
}

#[test]
fn units_of_a_map_convert() {
    let (text, with) = plain();
    let expected = read(&text, Vec::new(), Options::default()).unwrap();
    let degrees = |quantity: usize| {
        let rows = text.lines().skip(1).map(|row| {
            let cells = row.split(',').enumerate().map(|(place, cell)| match place {
                place if place == quantity => cell.parse::<f64>().unwrap().to_degrees().to_string(),
                _ => cell.to_owned(),
            });
            cells.collect::<Vec<_>>().join(",") + "\n"
        });
        format!("Zeit,w1,w2,W1,W2,M1,M2\n{}", rows.collect::<String>())
    };
    let all_but = |target: &str, column: &'static str| -> Vec<Mapping> {
        let all = ALL.map(|(other, own)| (other, if other == target { column } else { own }));
        map(&all)
    };
    let radians = Options { angles: Angles::Radians, ..Options::default() };
    let is_near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-14 * (1.0 + b.abs()));
    let found = read(&degrees(1), all_but("1.position", "w1 [deg]"), radians.clone()).unwrap();
    assert!(is_near(&found.q[0], &expected.q[0]) && found.q[1] == expected.q[1]);
    let found = read(&degrees(4), all_but("2.velocity", "W2 [deg/s]"), radians).unwrap();
    assert!(is_near(&found.qd[1], &expected.qd[1]) && found.q == expected.q);
    // brackets of the column's own name say the unit, too
    let error = read(&with("Zeit,w1 [deg],w2,W1,W2,M1,M2"), all_but("1.position", "w1 [deg]"), Options::default());
    assert!(error.unwrap_err().to_string().contains("w1 [deg] gives a unit, but the name w2 does not"));
}

/// Accelerations are those of the log, through the same filter as all else.
#[test]
fn accelerations_are_read_by_a_map_alone() {
    let (text, _) = plain();
    let with = |name: &str| -> String {
        let mut lines = text.lines();
        let header = lines.next().unwrap();
        let rows = lines.map(|row| format!("{row},{},{}\n", row.split(',').nth(5).unwrap(), -1.5));
        format!("{header},{name}1,{name}2\n{}", rows.collect::<String>())
    };
    let derived = read(&text, Vec::new(), Options::default()).unwrap();
    assert_eq!(read(&with("qdd"), Vec::new(), Options::default()).unwrap(), derived, "no name says it");
    let of_map = map(&[("1.acceleration", "qdd1"), ("2.acceleration", "qdd2")]);
    let found = read(&with("qdd"), of_map, Options::default()).unwrap();
    // the first has the numbers of the effort, and the second is constant
    assert_eq!(found.qdd[0], found.tau[0]);
    assert!(found.qdd[1].iter().all(|number| (number + 1.5).abs() < 1e-12), "{:?}", &found.qdd[1][..3]);
    assert_eq!((&found.q, &found.qd, &found.tau), (&derived.q, &derived.qd, &derived.tau));
    let error = read(&with("qdd"), map(&[("1.acceleration", "qdd1")]), Options::default()).unwrap_err().to_string();
    assert!(error.contains("the position of joint 2 but not its acceleration"), "{error}");
    let (_folder, path) = file("log.csv", with("qdd").replace(",-1.5\n", ",1e13\n"));
    let of_map = map(&[("1.acceleration", "qdd1"), ("2.acceleration", "qdd2")]);
    let (_, survey) = survey(&[path], Options { map: of_map, ..Options::default() }).unwrap();
    assert_eq!(
        survey.invalid_sample.map(|invalid_sample| (invalid_sample.joint, invalid_sample.quantity)),
        Some((1, "acceleration"))
    );
}

#[test]
fn a_wrong_map_is_refused() {
    let (_, with) = plain();
    let strange = with("Zeit,w1,w2,W1,W2,M1,M2");
    let changed = |at: usize, other: (&'static str, &'static str)| {
        let mut all = ALL;
        all[at] = other;
        map(&all)
    };
    for (mappings, wanted) in [
        (
            changed(1, ("1.position", "w3")),
            "no column `w3` for 1.position (did you mean w1?); its columns are Zeit, w1, w2",
        ),
        (changed(2, ("1.position", "w2")), "1.position is mapped twice"),
        (changed(2, ("2.position", "w1")), "the column `w1` is mapped twice"),
        (
            changed(2, ("2.position", "w2 [Nm]")),
            "`Nm` is not a unit for 2.position, the column `w2 [Nm]`; the known units are rad",
        ),
        (
            changed(0, ("time", "Zeit [h]")),
            "`h` is not a unit for time, the column `Zeit [h]`; the known units are s, ms, us, ns",
        ),
        (
            changed(6, ("elbow.effort", "M2")),
            "no column has positions of a joint `elbow`; the joints with positions are 1, 2",
        ),
        (map(&ALL[1..]), "no column has times"),
        (map(&ALL[..6]), "the position of joint 2 but not its effort"),
    ] {
        let error = read(&strange, mappings, Options::default()).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
        assert!(error.is_of_request(), "{error}");
    }
    let npy = b"\x93NUMPY\x01\x00";
    let (_folder, path) = file("log.npy", npy);
    let error = survey(&[path], Options { map: map(&ALL), ..Options::default() }).err().unwrap();
    assert!(error.to_string().contains("for tables, but the format of this file is array of numpy"), "{error}");
}

/// The suggestion for a table that is refused reads it, once its blanks are filled.
#[test]
fn a_suggestion_can_be_used() {
    let (text, with) = plain();
    let expected = read(&text, Vec::new(), Options::default()).unwrap();
    let strange = with("Zeit [s],Achse 1 Lage,Achse 2 Lage,Achse 1 Geschw.,Achse 2 Geschw.,Achse 1 Moment,x");
    let refused = read(&strange, Vec::new(), Options::default()).unwrap_err();
    let [rne_logs::Remedy::Give(rne_logs::Setting::Map(columns))] = refused.remedies() else {
        panic!("{refused}: {:?}", refused.remedies());
    };
    let mut map = suggested(columns, &["1".into(), "2".into()]);
    assert_eq!(map.iter().filter(|mapping| mapping.column == "COLUMN").count(), 1, "{map:?}");
    map.iter_mut().filter(|mapping| mapping.column == "COLUMN").for_each(|mapping| mapping.column = "x".into());
    assert_eq!(read(&strange, map, Options::default()).unwrap(), expected);
}
