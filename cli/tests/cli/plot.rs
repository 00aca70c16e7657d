//! `rne plot`: pictures of torques, the numbers behind them, and trajectories that are none.

use std::fs;

use crate::call::{Called, fails, fine, folder, rne, rne_reading};

/// Columns of the CSV, by name.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let header: Vec<&str> = csv.lines().next().expect("a header").split(',').collect();
    let at = header.iter().position(|column| *column == name).unwrap_or_else(|| panic!("no {name} in {header:?}"));
    let cell = |line: &str| line.split(',').nth(at).and_then(|cell| cell.parse().ok()).expect("a number");
    csv.lines().skip(1).map(cell).collect()
}

/// A rod that is swung by hand: τ = m a²/3 q̈ + m g a/2 cos q, and power τ q̇.
#[test]
fn numbers_are_those_of_the_pendulum() {
    let (m, a, g) = (2.0, 0.5, 9.81);
    let mut trajectory = String::from("t,q1,qd1,qdd1\n");
    let states: Vec<[f64; 4]> = (0..50_u32)
        .map(|i| {
            let t = f64::from(i) * 0.02;
            [t, t.sin(), t.cos(), -t.sin()]
        })
        .collect();
    for [t, q, qd, qdd] in &states {
        trajectory += &[t, q, qd, qdd].map(f64::to_string).join(",");
        trajectory.push('\n');
    }
    let called = rne_reading(&["plot", "planar1", "--csv", "--trajectory", "-"], &trajectory);
    assert_eq!((called.status, called.err.as_str()), (0, ""));
    let of = |name| column(&called.out, name);
    let numbers = [of("tau1"), of("inertia1"), of("velocity1"), of("gravity1"), of("power1")];
    for (index, [_, q, qd, qdd]) in states.iter().enumerate() {
        let (inertia, gravity) = (m * a * a / 3.0 * qdd, m * g * a / 2.0 * q.cos());
        let expected = [inertia + gravity, inertia, 0.0, gravity, (inertia + gravity) * qd];
        for (found, expected) in numbers.iter().zip(expected) {
            assert!((found[index] - expected).abs() < 1e-12, "{index}: {} is not {expected}", found[index]);
        }
    }
    // without rates they are derived, and hardly differ; columns in another order, semicolons, a column that is passed
    // over
    let mut lean = String::from("note;q1;t\n");
    for [t, q, ..] in &states {
        lean.extend(["x;", &q.to_string(), ";", &t.to_string(), "\n"]);
    }
    let derived = rne_reading(&["plot", "planar1", "--csv", "--trajectory", "-"], &lean);
    let torques = column(&derived.out, "tau1");
    assert!(torques.iter().zip(&numbers[0]).all(|(a, b)| (a - b).abs() < 0.01), "{torques:?}");
    let picture = rne_reading(&["plot", "planar1", "--trajectory", "-"], &lean).out;
    assert!(picture.contains("50 samples; velocities and accelerations derived from the positions"), "{picture}");
}

#[test]
fn pictures_are_written() {
    let path = folder("plot").join("planar2.svg");
    let path = path.to_str().expect("UTF-8");
    let said = fine(&["plot", "planar2", "-o", path]);
    insta::assert_snapshot!(said.replace(path, "planar2.svg"));
    let picture = fs::read_to_string(path).expect("a picture");
    assert!(picture.starts_with("<svg") && picture.contains("Two-link planar arm") && picture.contains("in 2 s"));
    assert_eq!(picture, fine(&["plot", "planar2"]));
    assert!(fine(&["plot", "planar2", "-o", path]).starts_with("up to date"));
    fails(2, &["plot", "planar1", "-o", path], &["exists and is not changed", "--force"]);
    fine(&["plot", "planar1", "-o", path, "--force"]);
    // speed limits ask for time
    assert!(fine(&["plot", "panda", "--duration", "0.1"]).contains("faster than speed limits allow"));
    assert!(!fine(&["plot", "panda"]).contains("faster than"));
    let set = fine(&["plot", "planar2", "--set", "m2=3"]);
    assert!(set.contains(", m2 = 3") && set != picture);
    assert!(fine(&["plot", "puma560", "--rotors"]).contains("with rotors"));
    fails(2, &["plot", "planar1", "--duration", "0"], &["seconds above 0"]);
    fails(1, &["plot", "planar1", "--duration", "1e-170"], &["overflows"]);
    fails(2, &["plot", "planar1", "--duration", "1", "--trajectory", "x.csv"], &["cannot be used with"]);
    let file = folder("plots").join("arm.yaml");
    fs::copy(format!("{}/robots/planar1.yaml", crate::call::ROOT), &file).expect("a copy");
    let file = file.to_str().expect("UTF-8");
    fails(2, &["plot", file, "-o", file, "--force"], &["is also the file that rne reads"]);
    // with a trajectory two files are read
    let csv = &format!("{file}.csv");
    fs::write(csv, "t,q1,qd1,qdd1\n-1e308,0,0,1\n1e308,0,0,1\n").expect("a trajectory");
    for read in [file, csv] {
        let before = fs::read(read).expect("a file");
        fails(2, &["plot", file, "--trajectory", csv, "-o", read, "--force"], &["is also the file that rne reads"]);
        assert_eq!(fs::read(read).expect("a file"), before);
    }
}

/// What a file is named for is what is written into it.
#[test]
fn files_are_named_for_what_they_hold() {
    let folder = folder("plot_names");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    for name in ["x.png", "x.pdf", "x.svg.gz"] {
        fails(2, &["plot", "planar1", "-o", &path(name)], &["does not have the name of an SVG", "x.svg", "Inkscape"]);
    }
    fails(2, &["plot", "planar1", "-o", &path("x.csv")], &["add --csv to write numbers"]);
    fails(2, &["plot", "planar1", "--csv", "-o", &path("x.svg")], &["does not have the name of a CSV file", "x.csv"]);
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0, "nothing is written");
    for (name, more) in [("x.SVG", &[][..]), ("x", &[]), ("x.csv", &["--csv"])] {
        fine(&[&["plot", "planar1", "-o", &path(name)], more].concat());
    }
    let nowhere = path("nowhere/x.svg");
    fails(1, &["plot", "planar1", "-o", &nowhere], &["there is no folder", "make it first"]);
}

/// Every shipped robot has a picture.
#[test]
fn every_robot_is_drawn() {
    for robot in shipped::tried().map(|robot| robot.name) {
        let Called { out, err, status } = rne(&["plot", robot]);
        assert_eq!((status, err.as_str()), (0, ""), "{robot}");
        assert!(out.starts_with("<svg") && out.ends_with("</svg>\n") && !out.contains("NaN"), "{robot}");
    }
}

/// What is wrong with a trajectory, and where.
#[test]
fn trajectories_that_are_none() {
    let bad = |text: &str, parts: &[&str]| {
        let Called { out, err, status } = rne_reading(&["plot", "planar2", "--trajectory", "-"], text);
        assert_eq!((status, out.as_str()), (1, ""), "{text:?}: {err}");
        for part in parts {
            assert!(err.contains(part), "{text:?}: no `{part}` in {err}");
        }
    };
    let rows = |rows: &str, parts: &[&str]| bad(&format!("t,q1,q2\n0,0,0\n1,1,1\n{rows}"), parts);
    bad("", &["the file is empty", "the header is t,q1,q2"]);
    bad("t\tq1\tq2\n0\t0\t0\n", &["no column `t`", "separated by tabs"]);
    bad("t,q1,q2\n", &["0 samples, but at least 3"]);
    bad("t,q1,q2\n0,0,0\n1,1,1\n", &["2 samples, but at least 3", "at least three if rne must compute derivatives"]);
    bad("t,q1\n0,1\n", &["there is no column `q2`"]);
    bad("time,q1,q2\n0,1,2\n", &["there is no column `t`"]);
    bad("t,q1,q_2\n0,1,2\n", &["there is no column `q2`; is it `q_2`?"]);
    bad("t,q1,q2,qd1\n0,1,2,3\n", &["there is no column `qd2`"]);
    bad("t,q1,q2,q3\n0,1,2,3\n", &[":1:9", "`q3` belongs to no joint: there are joints 1 to 2"]);
    bad("t,q1,q2,q1\n0,1,2,3\n", &[":1:9", "`q1` occurs twice"]);
    rows("2,x,1\n", &[":4:3", "`x` of column `q1` is not a finite number"]);
    rows("2,nan,1\n", &[":4:3", "not a finite number"]);
    rows("2,,1\n", &[":4:3", "a number of column `q1` is missing"]);
    rows("2,1\n", &[":4:1", "the line has 2 cells, but the header has 3 columns"]);
    rows("2,0,5,1\n", &["the line has 4 cells, but the header has 3 columns", "decimal point"]);
    rows("1,2,2\n", &[":4:1", "the time of sample 3 is not later"]);
    rows("0.5,2,2\n", &[":4:1", "not later"]);
    bad(&("t,q1,q2\n".to_owned() + &"0,0,0\n".repeat(200_001)), &["more than 200000 samples"]);
    // each mistake is told
    rows("2,x,1\n3,1,y\n", &[":4:3", ":5:5"]);
    bad("t,q1,\"q2\n", &["this quote is not closed"]);
    let file = folder("trajectories").join("t.csv");
    fs::write(&file, b"t,q1\x81\n").expect("a file");
    fails(1, &["plot", "planar1", "--trajectory", file.to_str().expect("UTF-8")], &["t.csv:1:5", "not UTF-8"]);
    fails(1, &["plot", "planar1", "--trajectory", "nowhere.csv"], &["the trajectory nowhere.csv cannot be read"]);
}
