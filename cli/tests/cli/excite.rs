//! `rne excite`: the file that it writes, what is said of it, and what it refuses.

use std::fs;

use crate::call::{fails, fine, folder, rne};

const DESK: &str = "docs/desk_arm.yaml";
const FEW: [&str; 4] = ["--evaluations", "60", "--seconds", "10"];

fn excite<'a>(more: &[&'a str]) -> Vec<&'a str> {
    ["excite", DESK].into_iter().chain(FEW).chain(more.iter().copied()).collect()
}

/// Numbers of a CSV, by row.
fn numbers(csv: &str) -> Vec<Vec<f64>> {
    let number = |cell: &str| cell.parse().unwrap_or_else(|_| panic!("{cell}"));
    csv.lines().skip(1).map(|line| line.split(',').map(number).collect()).collect()
}

#[test]
fn a_trajectory_is_what_other_commands_read() {
    let folder = folder("excite");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (csv, svg) = (path("trajectory.csv"), path("motion.svg"));
    // one file by two ways
    fails(2, &excite(&["-o", &csv, "--plot", &path("../excite/trajectory.csv")]), &["-o and --plot name the same"]);
    fails(2, &excite(&["-o", &path("trajectory.npy")]), &["ends with .npy, which this command does not write", ".csv"]);
    let called = rne(&excite(&["-o", &csv, "--plot", &svg]));
    assert!(called.status == 0 && called.err.matches("wrote").count() == 2, "{called:?}");
    assert!(called.out.lines().all(|line| line.chars().count() <= 80), "{}", called.out);
    for part in ["15 base parameters, 15 of them would be excited", "shoulder", "the best of 60 motions", "simulator"] {
        assert!(called.out.contains(part), "no `{part}` in {}", called.out);
    }
    let text = fs::read_to_string(&csv).expect("a trajectory");
    assert!(text.starts_with("t,q1,q2,q3,qd1,qd2,qd3,qdd1,qdd2,qdd3\n0,"), "{text:.60}");
    let rows = numbers(&text);
    assert_eq!((rows.len(), rows[1000][0]), (1001, 10.0));
    for end in [&rows[0], &rows[1000]] {
        assert_eq!(end[4..], [0.0; 6]);
        assert_eq!(end[1..4], rows[0][1..4]);
    }
    // the limits of the file: 120, 120, 180 degrees per second
    let fastest = |joint: usize| rows.iter().fold(0.0_f64, |most, row| most.max(row[4 + joint].abs()));
    assert!([120.0, 120.0, 180.0].iter().enumerate().all(|(joint, most)| fastest(joint) <= f64::to_radians(*most)));
    let states = rne(&["eval", DESK, "--states", &csv]);
    assert_eq!((states.status, states.out.lines().count()), (0, text.lines().count()));
    assert!(fine(&["plot", DESK, "--trajectory", &csv]).contains("<svg"));
    assert!(fs::read_to_string(&svg).expect("a picture").contains("starts at"));
    // the same again, through a pipe
    let piped = rne(&excite(&["-o", "-"]));
    assert_eq!((piped.status, piped.out), (0, text.clone()));
    assert!(piped.err.contains("the best of 60 motions"), "{}", piped.err);
    fails(2, &excite(&["-o", &csv]), &["exists and is not changed", "--force"]);
    assert!(rne(&excite(&["-o", &csv, "--force"])).err.contains("up to date"));
    // three periods of a third, and as many steps as the rate asks for
    let thrice = numbers(&rne(&excite(&["-o", "-", "--periods", "3", "--rate", "12"])).out);
    assert_eq!(thrice.len(), 121);
    assert!((0..10).all(|column| column == 0 || (thrice[40][column] - thrice[80][column]).abs() < 1e-9));
}

/// From a motion to the arm: its torques, as a log, give its parameters back.
#[test]
fn a_log_of_the_trajectory_identifies_the_arm() {
    let folder = folder("excite_identify");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (csv, log) = (path("trajectory.csv"), path("log.csv"));
    assert_eq!(rne(&excite(&["-o", &csv, "--no-friction"])).status, 0);
    let torques = rne(&["eval", DESK, "--states", &csv]).out;
    let motion = fs::read_to_string(&csv).expect("a trajectory");
    let rows = motion.lines().zip(torques.lines()).map(|(state, torque)| format!("{state},{torque}\n"));
    fs::write(&log, rows.collect::<String>()).expect("a log");
    let found = rne(&["identify", DESK, &log, "--no-friction", "--all"]).out;
    assert!(found.contains("15 base parameters of the links, 15 of them excited"), "{found}");
    // what the upper arm and all that hangs at the elbow weigh, times where: 3 kg at 0.18 m, 1.5 kg at 0.4 m
    let mcx2 = found.lines().find(|line| line.trim_start().starts_with("mcx2")).expect("a parameter");
    let value: f64 = mcx2.split_whitespace().nth(1).and_then(|value| value.parse().ok()).expect("a value");
    assert!((value - (3.0 * 0.18 + 1.5 * 0.4)).abs() < 1e-3, "{mcx2}");
}

#[test]
fn what_is_wrong_is_said() {
    for (seconds, words) in [("0", "0.001 to 86400"), ("-1", "0.001 to 86400"), ("nan", "0.001"), ("1e9", "86400")] {
        fails(2, &["excite", DESK, "--seconds", seconds], &[words]);
    }
    fails(2, &excite(&["--harmonics", "1"]), &["fewer than two cannot start and end at rest"]);
    fails(2, &excite(&["--velocity", "1,2"]), &["--velocity has 2 numbers, but the robot has 3 joints"]);
    fails(2, &excite(&["--velocity", "0"]), &["--velocity needs finite numbers above 0"]);
    fails(2, &excite(&["--acceleration", "nan"]), &["nan"]);
    fails(2, &excite(&["--rate", "0"]), &["samples per second"]);
    fails(2, &excite(&["--rate", "1e6"]), &["more than 500000 samples"]);
    fails(2, &["excite", DESK, "--evaluations", "0"], &["0 is not in 1.."]);
    fails(2, &excite(&["-o", DESK, "--force"]), &["is also the file that rne reads"]);
    fails(1, &excite(&["-o", "nowhere/trajectory.csv"]), &["there is no folder nowhere"]);
    fails(1, &["excite", "puma56"], &["puma560"]);
    let slide = folder("excite_wrong").join("slide.yaml");
    let text = "{format: 1, name: slide, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [\
                {name: rail, type: prismatic, LIMITS dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2}}]}";
    let path = slide.to_str().expect("UTF-8");
    fs::write(&slide, text.replace("LIMITS", "")).expect("a file");
    fails(1, &["excite", path], &["rail slides and has no position limits", "--range"]);
    fine(&["excite", path, "--range", "0.2", "--evaluations", "20"]);
    let weak = "limits: {position: [0, 1], effort: 5},";
    fs::write(&slide, text.replace("LIMITS", weak)).expect("a file");
    // 2 kg wherever they are
    let weighs = "gravity alone needs 19.620 of 5.000 N of rail at rail 0.500 m";
    let helps = "neither a slower motion nor a smaller --range helps";
    fails(
        1,
        &["excite", path, "--evaluations", "20"],
        &[weighs, helps, "check the effort limit of rail and the masses"],
    );
    fs::write(&slide, text.replace("LIMITS", "limits: {position: [1, 1]},")).expect("a file");
    fails(1, &["excite", path], &["the position limits of rail leave it no room to move"]);
}

/// A pendulum of 1 kg at 0.5 m, which weighs 4.905 N m times cos q: what is advised is what helps.
#[test]
fn gravity_beyond_the_effort_limits_is_told_apart() {
    let path = folder("excite_gravity").join("pendulum.yaml");
    let file = path.to_str().expect("UTF-8");
    let said = |position: &str, effort: f64, coulomb: f64| {
        let text = format!(
            "{{format: 1, name: pendulum, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [{{name: \
             swing, type: revolute, limits: {{position: {position}, velocity: 1, effort: {effort}}}, motor: {{coulomb: \
             [{coulomb}, -{coulomb}]}}, dh: {{theta: 0, d: 0, a: 0.5, alpha: 0}}, link: {{mass: 1}}}}]}}"
        );
        fs::write(&path, text).expect("a file");
        let called = rne(&["excite", file, "--evaluations", "20"]);
        assert_eq!((called.status, called.out.as_str()), (1, ""), "{called:?}");
        called.said()
    };
    let (slower, helps) = (
        "a slower or smaller motion needs less: change --seconds",
        "neither a slower motion nor a smaller --range helps",
    );
    let has = |said: &str, parts: &[&str]| parts.iter().for_each(|part| assert!(said.contains(part), "{part}: {said}"));
    // cos 0.2 of it at least: at the ends, not in the middle
    let everywhere = said("[-0.2, 0.2]", 4.0, 0.0);
    has(&everywhere, &["gravity alone needs 4.807 of 4.000 N m of swing at swing", helps, "2000 positions"]);
    assert!(!everywhere.contains(slower), "{everywhere}");
    // the ends would do, and leave no room
    let middle = said("[-0.5, 0.5]", 4.31, 0.0);
    has(&middle, &["gravity alone needs 4.905 of 4.310 N m of swing at swing 0 rad, which is the middle", helps]);
    assert!(!middle.contains(slower), "{middle}");
    // friction is in the way where it hangs lower
    let end = said("[-1.5, 0.2]", 4.2, 4.0);
    has(&end, &["swing would need", slower, "gravity alone needs 4.905 of 4.200", "use a smaller --range"]);
    let friction = said("[-1.5, 0.2]", 6.0, 6.0);
    has(&friction, &["swing would need", slower]);
    assert!(!friction.contains("gravity alone"), "{friction}");
}

/// Effort limits hold for the arm with what it carries.
#[test]
fn a_payload_counts_for_the_effort_limits() {
    assert_eq!(rne(&excite(&["--payload", "0.5,0,0,0"])).status, 0);
    fails(1, &excite(&["--payload", "30,0,0,0"]), &["gravity alone needs"]);
    fails(2, &excite(&["--payload", "1,2"]), &["--payload needs 10 or 4 numbers, not 2"]);
}
