//! Closed loops that `rne import` reads, beside the golden values of `closed_loops`. Robot files by hand gave these,
//! and their loops are often cut elsewhere. So joints are compared by their names, and the positions of others are
//! solved for.

use std::collections::BTreeMap;

use rne::{DynArm, DynClosureStep};
use rne_convert::{Imported, Options, Selection, Urdf};
use rne_model::{Convention, Reader, Robot};
use serde_json::Value;

use crate::check::ROOT;

const TOLERANCE: f64 = 1e-9;
/// The file of the delta robot by hand has twelve digits, and one of them more or less in `b` of `free1_rod3` moves the
/// rates of `free2_rod1` by 4e-9: the two parallel rods are nearly singular.
const TOLERANCE_OF_DELTA: f64 = 1e-8;

/// The numbers of a state, by the names of joints.
type Named = BTreeMap<String, f64>;

fn path(name: &str) -> String {
    format!("{ROOT}/tests/functions/loops/{name}")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn options(gravity: [f64; 3], lock: &[&str]) -> Options {
    let lock = lock.iter().map(|joint| ((*joint).to_owned(), 0.0)).collect();
    Options { gravity, selection: Selection { lock, ..Selection::default() }, ..Options::default() }
}

fn import(file: &str, text: &str, options: &Options) -> Imported {
    let imported = Urdf::read(&path(file), text).and_then(|urdf| urdf.import(options));
    let imported = imported.unwrap_or_else(|report| panic!("{file}: {report}"));
    assert!(imported.account.rounding.torque < 1e-12, "{:?}", imported.account.rounding);
    imported
}

fn names(robot: &Robot) -> [Vec<String>; 2] {
    let passive = robot.closed.passive.iter().map(|&joint| robot.joints[joint].name.clone()).collect();
    [robot.independent_joints().map(|joint| joint.name.clone()).collect(), passive]
}

fn named(names: &[String], numbers: &Value) -> Named {
    let numbers = numbers.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number"));
    names.iter().cloned().zip(numbers).collect()
}

fn listed(names: &[String], numbers: &Named) -> Vec<f64> {
    names.iter().map(|name| numbers.get(name).copied().unwrap_or(0.0)).collect()
}

/// Positions of the dependent joints at `q`, of which those by name in `positions` are known. Newton's method begins at
/// random positions of the others, again for each loop that does not close.
fn close(arm: &DynArm, robot: &Robot, q: &[f64], positions: &Named) -> Vec<f64> {
    let [_, dependent] = names(robot);
    let place = |joint: &usize| robot.closed.passive.iter().position(|passive| passive == joint).expect("dependent");
    let mut random = fastrand::Rng::with_seed(1);
    let mut start = listed(&dependent, positions);
    for _ in 0..100 {
        let mut passive = start.clone();
        let mut residual = vec![f64::NAN];
        for _ in 0..25 {
            let DynClosureStep { passive: next, residual: left } =
                arm.closure_step(q, &passive).expect("as many joints");
            residual = left;
            if residual.iter().all(|left| left.abs() < 1e-14) {
                break;
            }
            // long steps leave the configuration
            let steps = passive.iter().zip(&next).map(|(here, next)| next - here);
            passive = passive.iter().zip(steps).map(|(here, step)| here + step.clamp(-0.5, 0.5)).collect();
        }
        let mut rows = residual.as_slice();
        let mut is_closed = true;
        for closed in &robot.closed.loops {
            let (own, rest) = rows.split_at(closed.cut.equations());
            rows = rest;
            let places: Vec<usize> = closed.dependent.iter().map(place).collect();
            let is_known = |place: &usize| positions.contains_key(&dependent[*place]);
            // the known configuration, but for whole turns
            let is_meant = |place: &usize| {
                positions.get(&dependent[*place]).is_none_or(|it| ((passive[*place] - it) / 2.0).sin().abs() < 1e-9)
            };
            let fine = own.iter().all(|left| left.abs() < 1e-12) && places.iter().all(is_meant);
            is_closed &= fine;
            for &place in places.iter().filter(|place| !is_known(place)) {
                start[place] = if fine { passive[place] } else { std::f64::consts::TAU * random.f64() };
            }
        }
        if is_closed {
            return passive;
        }
    }
    panic!("no start leads to the closure of {positions:?}");
}

/// Compares an imported robot with the golden values of the robot file `golden`: torques of the motors, and the rates
/// of the dependent joints that both have. Joints that the golden robot has not are at rest.
fn compare(imported: &Imported, golden: &str) {
    compare_renamed(imported, golden, &[]);
}

/// [`compare`] with other names for joints of the golden robot.
fn compare_renamed(imported: &Imported, golden: &str, other_names: &[(&str, &str)]) {
    let tolerance = if golden == "delta" { TOLERANCE_OF_DELTA } else { TOLERANCE };
    let yaml = read(&format!("{ROOT}/benches/trees/loops/{golden}.yaml"));
    let by_hand = Reader::new(golden).trees().couplings().loops().read(&yaml).expect("a robot file").robot;
    let states = read(&format!("{ROOT}/tests/golden/loops/{golden}.json"));
    let states: Vec<Value> = serde_json::from_str(&states).expect("JSON");
    let robot = &imported.robot;
    let (arm, [independent, dependent], mut of_hand) = (DynArm::from_robot(robot), names(robot), names(&by_hand));
    for name in of_hand.iter_mut().flatten() {
        if let Some((_, other)) = other_names.iter().find(|(known, _)| known == name) {
            (*other).clone_into(name);
        }
    }
    let [motors, followers] = of_hand;
    assert!(motors.iter().all(|motor| independent.contains(motor)), "{golden}: {independent:?} and not {motors:?}");
    let known = |name: &String| dependent.contains(name);
    for state in &states {
        let [q, qd, qdd, tau] = ["q", "qd", "qdd", "inverse_dynamics"].map(|key| named(&motors, &state[key]));
        let [positions, rates] = ["passive", "passive_rates"].map(|key| named(&followers, &state[key]));
        let [at, speed, acceleration] = [&q, &qd, &qdd].map(|numbers| listed(&independent, numbers));
        let passive = close(&arm, robot, &at, &positions);
        let found = arm.inverse_dynamics_of_loops(&at, &passive, &speed, &acceleration).expect("as many joints");
        let scale = tau.values().fold(1.0_f64, |largest, torque| largest.max(torque.abs()));
        for (name, found) in independent.iter().zip(found) {
            if let Some(expected) = tau.get(name) {
                assert!((found - expected).abs() < tolerance * scale, "{golden}, {name}: {found} and not {expected}");
            }
        }
        let map = arm.loop_map(&at, &passive).expect("as many joints");
        let scale = rates.values().fold(1.0_f64, |largest, rate| largest.max(rate.abs()));
        for (name, row) in dependent.iter().zip(map) {
            let found: f64 = row.iter().zip(&speed).map(|(a, b)| a * b).sum();
            if let Some(expected) = rates.get(name) {
                assert!((found - expected).abs() < tolerance * scale, "{golden}, {name}: {found} and not {expected}");
            }
        }
    }
    assert!(!states.is_empty() && followers.iter().any(known), "{golden}");
}

#[test]
fn urdf_plus_gives_the_torques_of_virtual_work() {
    for name in ["four_bar", "six_bar", "planar_leg_linkage"] {
        let file = format!("grbda_{name}.urdf");
        let imported = import(&file, &read(&path(&file)), &options([0.0, -9.81, 0.0], &[]));
        let read = Reader::new(name).trees().couplings().loops().read(&imported.text);
        assert_eq!(read.unwrap_or_else(|report| panic!("{report}")).robot, imported.robot, "reading gives the robot");
        compare(&imported, name);
    }
}

#[test]
fn connect_of_mjcf_is_the_same_four_bar() {
    let imported = import("four_bar.xml", &read(&path("four_bar.xml")), &options([0.0, 0.0, -9.81], &[]));
    compare(&imported, "four_bar");
}

/// The URDF without the masses of the links of this name that mark the ends of loops: the file by hand is without them.
fn without_mass(file: &str, mark: &str) -> String {
    let text = read(&path(file));
    let mut parts = text.split("<link name=\"");
    let mut rest = parts.next().expect("a beginning").to_owned();
    for part in parts {
        let inertial = part.starts_with(mark).then(|| Some((part.find("<inertial>")?, part.find("</inertial>")?)));
        let part = match inertial.flatten() {
            Some((from, to)) => format!("{}{}", &part[..from], &part[to + "</inertial>".len()..]),
            None => part.to_owned(),
        };
        rest = format!("{rest}<link name=\"{part}");
    }
    assert!(rest.len() < text.len(), "{file} has such links");
    rest
}

/// The spheres at the ends turn about themselves, so of each pair one is locked.
#[test]
fn extended_urdf_gives_the_torques_of_virtual_work() {
    let upright = |lock: &[&str]| options([0.0, 0.0, -9.81], lock);
    let file = "epr_5bar_linkage.urdf";
    compare(&import(file, &without_mass(file, "sphere"), &upright(&["closedloop1_B"])), "five_bar");
    let file = "epr_robot_delta.urdf";
    let spheres = ["closedloop1_B", "closedloop2_B", "closedloop3_B"];
    compare(&import(file, &without_mass(file, "sphere"), &upright(&spheres)), "delta");
}

/// Each rod turns about itself: one of its joints is locked.
#[test]
fn legs_give_the_torques_of_virtual_work() {
    let file = "epr_cassie_like.urdf";
    let lock = ["foot_2_half_planta_rode_2_rev2", "tigh_half_hachil_rode_2_rev2"];
    compare(&import(file, &read(&path(file)), &options([0.0, 0.0, -9.81], &lock)), "cassie_like");
}

/// The left leg is locked, and its loops with it.
#[test]
fn spherical_and_universal_joints_give_the_torques_of_virtual_work() {
    let file = "epr_digit_like_2legs.urdf";
    let text = without_mass(file, "closedloop");
    let mut left: Vec<String> = Vec::new();
    for part in text.split("<joint name=\"").skip(1) {
        let (name, rest) = part.split_once('"').expect("a name");
        if !name.ends_with("_left") || !rest.trim_start().starts_with("type=\"revolute\"") {
            continue;
        }
        let axes: &[&str] = match name {
            "spherical_free_hip_left" | "spherical_free_shin1_left" | "spherical_free_shin2_left" => {
                &["_x", "_y", "_z"]
            }
            name if name.starts_with("spherical") => &["_x", "_y"],
            _ => &[""],
        };
        left.extend(axes.iter().map(|axis| format!("{name}{axis}")));
    }
    assert_eq!(left.len(), 24);
    let left: Vec<&str> = left.iter().map(String::as_str).collect();
    let Options { selection, .. } = options([0.0, 0.0, -9.81], &left);
    let selection = Selection { whole: true, tip: Some("foot".to_owned()), ..selection };
    let imported = import(file, &text, &Options { selection, convention: Convention::Modified, ..Options::default() });
    let told =
        imported.account.sentences().iter().filter(|remark| remark.contains("no joint that moves is in it")).count();
    assert_eq!(told, 3, "{:?}", imported.account.sentences());
    let other_names = [
        ("heel_rod_x", "spherical_free_knee_x"),
        ("heel_rod_y", "spherical_free_knee_y"),
        ("rod1_x", "spherical_free_foot1_x"),
        ("rod1_y", "spherical_free_foot1_y"),
        ("rod2_x", "spherical_free_foot2_x"),
        ("rod2_y", "spherical_free_foot2_y"),
    ];
    compare_renamed(&imported, "digit_like", &other_names);
}
