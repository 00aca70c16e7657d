//! `docs/reference/robot-file-keys.md`, and `docs/every-key.yaml` with the examples of `format: 2`, have the keys that
//! the format has, no more and no fewer. The list of keys is that of rne-model's schema.

use std::collections::BTreeSet;
use std::path::Path;

use rne::DynArm;
use rne_model::{Mapping, Reader, mappings};
use serde_yaml::Value;

fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A file with every key of `format: 1`, and those that have the keys of `format: 2`.
const FILES: [&str; 9] = [
    "docs/every-key.yaml",
    "docs/tree.yaml",
    "docs/gripper.yaml",
    "docs/palletiser.yaml",
    "docs/four_bar.yaml",
    "docs/dual_arm.yaml",
    "docs/satellite.yaml",
    "docs/standing_hyq.yaml",
    "robots/trees/mini_cheetah.yaml",
];

/// Keys of `format: 2` in mappings that `format: 1` has, too.
const KEYS_OF_FORMAT_2: [&str; 12] =
    ["parent", "at", "gamma", "b", "on", "floating_base", "couplings", "loops", "motors", "bodies", "tips", "contacts"];

/// The mappings of the format, of all files.
fn format() -> Vec<Mapping> {
    let mut all = mappings(&read(FILES[0]));
    for file in &FILES[1..] {
        let others = mappings(&read(file)).into_iter();
        let others: Vec<Mapping> = others.filter(|other| all.iter().all(|known| known.name != other.name)).collect();
        all.extend(others);
    }
    all
}

#[test]
fn a_file_with_every_key_is_in_order() {
    for name in [
        "docs/every-key.yaml",
        "docs/desk_arm.yaml",
        "docs/tree.yaml",
        "docs/gripper.yaml",
        "docs/palletiser.yaml",
        "docs/four_bar.yaml",
        "robots/trees/wam7_coupled.yaml",
        "docs/dual_arm.yaml",
        "docs/satellite.yaml",
        "docs/standing_hyq.yaml",
    ] {
        let checked =
            Reader::new(name).trees().couplings().loops().read(&read(name)).unwrap_or_else(|report| panic!("{report}"));
        assert!(checked.lints.is_empty(), "{}", checked.lints);
    }
}

/// Arms weigh in proportion to the cube of their reach, kg/m³: the bound of the lint is half of what the lightest
/// shipped arm of 4 to 7 joints has, and no shipped arm has a warning.
#[test]
fn shipped_arms_have_no_warning_and_are_twice_as_heavy_as_the_lint_asks() {
    let density = |file: &rne_robots::RobotFile| {
        let checked = Reader::new(file.name).read(file.yaml).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(checked.lints.warnings().count(), 0, "{}", checked.lints);
        let reach: f64 = checked.robot.rows().map(|row| row.dh.a.hypot(row.dh.d)).sum();
        let mass: f64 = checked.robot.rows().map(|row| row.link.mass).sum();
        ((4..=7).contains(&checked.robot.dof())).then_some(mass / reach.powi(3))
    };
    let densities: Vec<f64> = rne_robots::ROBOTS.iter().filter_map(density).collect();
    let least = densities.iter().copied().fold(f64::MAX, f64::min);
    println!("{} arms, {least:.2} kg/m³ at least", densities.len());
    assert!(densities.len() > 20 && least > 2.0 * 1.25, "{densities:?}");
}

/// Two bars by their base parameters, without a mass, have the torques of the bars.
#[test]
fn base_parameters_are_a_robot_file() {
    let robot = |name: &str| {
        let checked = Reader::new(name).read(&read(name)).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(checked.lints.warnings().count(), 0, "{}", checked.lints);
        checked.robot
    };
    let robots = ["docs/two_bars.yaml", "robots/planar2.yaml"].map(robot);
    assert!(robots[0].rows().all(|row| row.link.mass == 0.0 && row.link.has_first_moment()));
    let arms = robots.map(|robot| DynArm::from_robot(&robot));
    for state in [[0.3, -0.7, 1.0, 2.0, 3.0, -1.0], [-2.1, 0.4, -0.6, 1.3, 0.0, 7.0]] {
        let [q, qd, qdd] = [0, 2, 4].map(|at| &state[at..at + 2]);
        let close = |what: [Vec<f64>; 2]| {
            let [found, expected] = &what;
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14 * b.abs().max(10.0)), "{what:?}");
        };
        close([0, 1].map(|arm| arms[arm].inverse_dynamics(q, qd, qdd).expect("two joints")));
        close([0, 1].map(|arm| arms[arm].mass_matrix(q).expect("two joints").concat()));
        close([0, 1].map(|arm| arms[arm].forward_dynamics(q, qd, qdd).expect("two joints")));
        close([0, 1].map(|arm| vec![arms[arm].kinetic_energy(q, qd).expect("two joints")]));
    }
}

/// The mappings of a document, parameters left out, with their keys.
fn collect(value: &Value, found: &mut Vec<BTreeSet<String>>) {
    match value {
        Value::Mapping(entries) => {
            let name = |key: &Value| key.as_str().expect("a word").to_owned();
            found.push(entries.keys().map(name).collect());
            entries
                .iter()
                .filter(|(key, _)| key.as_str() != Some("parameters"))
                .for_each(|(_, value)| collect(value, found));
        }
        Value::Sequence(items) => items.iter().for_each(|item| collect(item, found)),
        _ => {}
    }
}

#[test]
fn a_file_with_every_key_has_every_key() {
    let mut found = Vec::new();
    collect(&serde_yaml::from_str(&read(FILES[0])).expect("YAML"), &mut found);
    for mapping in mappings(&read(FILES[0])) {
        let keys: BTreeSet<String> = mapping.keys.iter().map(|key| key.name.to_owned()).collect();
        let here: BTreeSet<String> = found.iter().filter(|names| names.is_subset(&keys)).flatten().cloned().collect();
        let missing: Vec<&String> = keys.difference(&here).collect();
        let is_of_format_2 = |key: &&String| KEYS_OF_FORMAT_2.contains(&key.as_str());
        assert!(missing.iter().all(is_of_format_2), "{} has no {missing:?} of {}", FILES[0], mapping.name);
    }
    for file in &FILES[1..] {
        collect(&serde_yaml::from_str(&read(file)).expect("YAML"), &mut found);
    }
    let format = format();
    assert!(format.len() >= 8, "{format:?}");
    for mapping in format {
        let keys: BTreeSet<String> = mapping.keys.iter().map(|key| key.name.to_owned()).collect();
        // it takes two links to have `com` and `first_moment`, and seven files to have the lists of `format: 2`
        let of_this_kind = found.iter().filter(|names| names.is_subset(&keys));
        let most = of_this_kind.clone().map(BTreeSet::len).max().unwrap_or(0);
        let all: BTreeSet<String> = of_this_kind.flatten().cloned().collect();
        assert!(most + 7 >= keys.len(), "{FILES:?} have no {} with nearly all of {keys:?}", mapping.name);
        assert_eq!(all, keys, "{FILES:?}: {}", mapping.name);
    }
}

#[test]
fn the_page_explains_every_key() {
    const PAGE: &str = "docs/reference/robot-file-keys.md";
    let page = read(PAGE);
    let (_, files) = page.split_once("\n## A file with every key\n").expect("the section");
    for file in FILES {
        let link = file.strip_prefix("docs/").map_or_else(|| format!("(../../{file})"), |file| format!("(../{file})"));
        assert!(files.contains(&link), "{PAGE}, A file with every key: no {link}");
    }
    for mapping in format() {
        let heading = format!("\n### Keys of {}\n", mapping.name);
        let (_, section) = page.split_once(&heading).unwrap_or_else(|| panic!("{PAGE}: no{heading}"));
        let rows = section.lines().skip_while(|line| !line.starts_with("| `")).take_while(|line| line.starts_with('|'));
        let written: Vec<(String, bool)> = rows
            .map(|row| {
                let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
                assert!(cells.len() == 4 && !cells[3].is_empty(), "{row}");
                (cells[0].trim_matches('`').to_owned(), cells[2] == "required")
            })
            .collect();
        let keys: Vec<(String, bool)> = mapping.keys.iter().map(|key| (key.name.to_owned(), key.is_required)).collect();
        assert_eq!(written, keys, "{PAGE},{heading}");
    }
}
