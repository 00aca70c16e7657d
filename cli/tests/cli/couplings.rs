//! Robots some of whose joints follow others.

use crate::call::{ROOT, fails, fine, folder, rne, rne_reading};
use crate::certify::has_tools;
use std::fmt::Write as _;

const GRIPPER: &str = "docs/gripper.yaml";

#[test]
fn arrays_have_no_element_for_a_follower() {
    let state = ["--q", "0.1,0.2,0.01", "--qd", "1,2,3", "--qdd", "1,1,1"];
    let text = fine(&[&["eval", GRIPPER][..], &state].concat());
    assert!(text.contains("finger_a") && !text.contains("finger_b"), "{text}");
    let matrix = fine(&["eval", GRIPPER, "--function", "mass_matrix", "--q", "0,0,0"]);
    assert!(matrix.contains("0.200000"), "one coordinate moves both fingers\n{matrix}");
    let names = ["--q needs 3 numbers, not 4", "shoulder, elbow, finger_a"];
    fails(2, &["eval", GRIPPER, "--q", "0,0,0,0"], &names);
}

#[test]
fn code_and_tables_tell_what_follows() {
    let shown = fine(&["show", GRIPPER, "--joint", "3", "--step", "7"]);
    assert!(shown.contains("finger_b follows: q4 = 1 q3") && shown.contains("τ3 = e · f2,3 + e · f2,4"), "{shown}");
    for language in ["rust", "c"] {
        let code = fine(&["emit", GRIPPER, "--lang", language, "--form", "reduced"]);
        assert!(code.contains("finger_b follows: q4 = 1 q3"), "{code}");
        assert!(code.contains(if language == "c" { "qd[3]" } else { "qd: &[T; 3]" }), "{code}");
    }
    let counted = fine(&["ops", GRIPPER]);
    assert!(counted.contains("forward_dynamics") && !counted.contains("regressor"), "{counted}");
}

#[test]
fn a_file_of_states_and_a_plot_have_no_column_for_a_follower() {
    let file = folder("couplings").join("states.csv");
    let header = "t,q1,q2,q3,qd1,qd2,qd3,qdd1,qdd2,qdd3";
    let row = "0.3,-0.8,0.01,0.5,-0.7,0.3,1,2,-0.5";
    std::fs::write(&file, format!("{header}\n0,{row}\n0.1,{row}\n0.2,{row}\n")).expect("written");
    let file = file.to_str().expect("UTF-8");
    let state = ["--q", "0.3,-0.8,0.01", "--qd", "0.5,-0.7,0.3", "--qdd", "1,2,-0.5", "--json"];
    let one: serde_json::Value = serde_json::from_str(&fine(&[&["eval", GRIPPER][..], &state].concat())).expect("JSON");
    let expected: Vec<f64> =
        one["result"].as_array().expect("torques").iter().map(|tau| tau.as_f64().expect("a number")).collect();
    let many = rne(&["eval", GRIPPER, "--states", file]).out;
    let plotted = fine(&["plot", GRIPPER, "--trajectory", file, "--csv"]);
    for (text, skipped) in [(many, 0), (plotted, 1)] {
        let line = text.lines().nth(2).expect("a second state");
        let cells: Vec<f64> =
            line.split(',').skip(skipped).take(3).map(|cell| cell.parse().expect("a number")).collect();
        assert!(cells.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{text} {expected:?}");
        assert!(!text.contains("finger_b"), "{text}");
    }
}

#[test]
fn a_gripper_is_certified() {
    if !has_tools() {
        return;
    }
    let file = folder("couplings_certified").join("gripper.md");
    let file = file.to_str().expect("UTF-8");
    assert_eq!(rne(&["certify", GRIPPER, "--states", "5", "-o", file]).status, 0);
    let text = std::fs::read_to_string(file).expect("a certificate");
    assert!(text.contains("gripper") && text.contains("instructions"), "{text}");
}

#[test]
fn what_takes_no_followers_says_so() {
    fails(2, &["eval", GRIPPER, "--function", "regressor", "--q", "0,0,0"], &["`finger_b` follows other joints"]);
    fails(
        1,
        &["show", GRIPPER, "--symbolic"],
        &["docs/gripper.yaml:32:3", "joints that follow others are not supported here"],
    );
}

/// A log of torques of the file itself, at states that `rne eval` computes: its links are found again.
#[test]
fn a_gripper_is_identified_from_its_torques() {
    let place = folder("couplings_identified");
    let [states, log, out] = ["states.csv", "log.csv", "out.yaml"].map(|name| place.join(name));
    let name = |path: &std::path::Path| path.to_str().expect("UTF-8").to_owned();
    // sums of sines, no two of one frequency, at 50 Hz
    let mut text = "t,q1,q2,q3,qd1,qd2,qd3,qdd1,qdd2,qdd3\n".to_owned();
    let (mut times, mut rows) = (Vec::new(), Vec::new());
    for sample in 0..1500_u32 {
        let time = f64::from(sample) / 50.0;
        let mut lists = [[0.0; 3]; 3];
        for joint in 0..3_u32 {
            for k in 1..=3_u32 {
                let size = if joint == 2 { 0.01 } else { 0.6 } / f64::from(k);
                let rate = std::f64::consts::TAU * (0.11 * f64::from(k) + 0.017 * f64::from(joint));
                let (sin, cos) = (rate * time + f64::from(k + 2 * joint)).sin_cos();
                let at = joint as usize;
                lists[0][at] += size * sin;
                lists[1][at] += size * rate * cos;
                lists[2][at] -= size * rate * rate * sin;
            }
        }
        let row = lists.iter().flatten().map(|x| format!("{x:.12}")).collect::<Vec<_>>();
        let _ = writeln!(text, "{time},{}", row.join(","));
        times.push(time);
        rows.push(row);
    }
    std::fs::write(&states, text).expect("a table");
    let torques = place.join("torques.csv");
    let wrote = rne(&["eval", GRIPPER, "--states", &name(&states), "-o", &name(&torques), "--force"]);
    assert_eq!(wrote.status, 0, "{wrote:?}");
    let torques = std::fs::read_to_string(torques).expect("torques");
    let mut text =
        "time,shoulder_position,elbow_position,finger_a_position,shoulder_effort,elbow_effort,finger_a_effort\n"
            .to_owned();
    for ((time, row), torque) in times.iter().zip(&rows).zip(torques.lines().skip(1)) {
        let _ = writeln!(text, "{time},{},{},{},{torque}", row[0], row[1], row[2]);
    }
    std::fs::write(&log, text).expect("a log");
    let called = rne(&["identify", GRIPPER, &name(&log), "-o", &name(&out), "--force"]);
    assert_eq!(called.status, 0, "{called:?}");
    assert!(called.out.contains("all 3 joints"), "{called:?}");
    let file = std::fs::read_to_string(&out).expect("a robot file");
    assert!(file.contains("couplings:\n  - {joint: finger_b, follows: {finger_a: 1}}"), "{file}");
    fine(&["check", &name(&out)]);
    let described = fine(&["log", &name(&log), "--robot", GRIPPER]);
    assert!(described.contains("finger_a") && !described.contains("finger_b"), "{described}");
    fails(2, &["identify", "mini_cheetah", &name(&log), "--rotors"], &["leave out --rotors"]);
}

/// The limits of the second finger are those of the first, through the ratio; its effort limits no torque.
#[test]
fn limits_of_a_follower_are_in_the_code() {
    let folder = folder("couplings_limits");
    let text = std::fs::read_to_string(std::path::Path::new(crate::call::ROOT).join(GRIPPER)).expect("it is there");
    let file = folder.join("grip.yaml");
    let second = "dh: {theta: 0, d: 0, a: 0, alpha: -pi/2}";
    let with = |limits: &str| {
        let text = text.replace(second, &format!("limits: {{{limits}}}\n    {second}"));
        std::fs::write(&file, text.replace("{finger_a: 1}", "{finger_a: -2}")).expect("written");
        file.to_str().expect("UTF-8")
    };
    let code = rne(&["emit", with("position: [-0.06, 0.5], velocity: 0.5"), "--lang", "c"]).out;
    let end = |name: &str| {
        let line = code.lines().find(|line| line.starts_with(&format!("#define GRIPPER_{name} "))).expect("a limit");
        line.rsplit_once(", ").map(|(_, last)| last.trim_end_matches('}').to_owned())
    };
    // 0.06 / 2 of finger_b is nearer than 0.04 of finger_a, and 0 is nearer than -0.25
    let ends = ["POSITION_LOWER", "POSITION_UPPER", "VELOCITY_LIMIT"].map(end);
    assert_eq!(ends, ["0.0f", "0.03f", "0.25f"].map(|number| Some(number.to_owned())), "{code}");
    let said = "no joint has an effort limit, but for joints that follow others";
    fails(1, &["emit", with("effort: 5"), "--lang", "c", "--limits"], &[said, "effort: 40"]);
    fails(1, &["emit", GRIPPER, "--lang", "c", "--limits"], &["no joint has an effort limit; write it"]);
    let checked = rne(&["check", with("effort: 5")]);
    assert!(checked.out.contains("the effort limit of `finger_b` limits no torque"), "{checked:?}");
}

const FOUR_BAR: &str = "docs/four_bar.yaml";

/// The angle of the crank leads to torques, with and without the positions of the dependent joints.
#[test]
fn closed_loops_are_computed() {
    let torque = |more: &[&str]| -> f64 {
        let arguments = [&["eval", FOUR_BAR, "--q", "0.3", "--qd", "1", "--qdd", "2", "--json"][..], more].concat();
        let json: serde_json::Value = serde_json::from_str(&fine(&arguments)).expect("JSON");
        json["result"][0].as_f64().expect("a torque")
    };
    let closed = torque(&[]);
    let given = torque(&["--passive", "0.23838309638800434,1.3098110088633859"]);
    assert!((closed - given).abs() < 1e-12 * closed.abs(), "{closed} {given}");
    // a guess decides which closure is found: the other has the rocker below
    let other = torque(&["--passive", "-0.8,-1.8"]);
    assert!((torque(&["--passive", "0.3,1.2"]) - closed).abs() < 1e-12 * closed.abs() && (other - closed).abs() > 0.1);
    fails(2, &["eval", FOUR_BAR, "--q", "0.3", "--passive", "1e300,1"], &["Give another guess, or other positions"]);
    // without one the assembly is the same all the way round, and after two turns
    let rocker = |q: &str| {
        let text = fine(&["eval", FOUR_BAR, "--q", q, "--qd", "0", "--qdd", "0"]);
        let (_, rest) = text.split_once("rocker = ").expect("its position");
        rest.split(' ').next().and_then(|number| number.parse::<f64>().ok()).expect("a number")
    };
    let round: Vec<f64> = ["0", "0.5", "1.5", "3", "4.5", "6", "6.283185307179586"].map(rocker).into();
    assert!(round.iter().all(|&at| at.signum() == round[0].signum()), "{round:?}");
    assert!((round[0] - round[6]).abs() < 1e-9 && (rocker("13.066370614359172") - rocker("0.5")).abs() < 1e-9);
    fails(2, &["eval", FOUR_BAR, "--q", "0.3", "--passive", "1"], &["--passive needs 2 numbers, not 1"]);
    fails(2, &["eval", FOUR_BAR, "--q", "0.3", "--function", "mass_matrix"], &["Use `mass_matrix_of_loops`"]);
    fails(2, &["eval", "planar2", "--q", "0,0", "--function", "loop_map"], &["of robots with closed loops"]);
    let functions = fine(&["ops", FOUR_BAR]);
    assert!(functions.contains("closure_step") && !functions.contains(" mass_matrix "), "{functions}");
    assert!(rne(&["ops", FOUR_BAR, "--function", "mass_matrix"]).status != 0, "no function of loops");
}

/// The piston is where the triangle of crank and rod has it, and the crank holds the weights of both by virtual work.
#[test]
fn a_slider_crank_is_its_closed_form() {
    let (crank, rod, angle, gravity) = (0.1_f64, 0.3_f64, 0.4_f64, 9.81);
    let text = fine(&["eval", "docs/slider_crank.yaml", "--q", "0.4", "--qd", "0", "--qdd", "0"]);
    let number = |before: &str| -> f64 {
        let (_, rest) = text.split_once(before).expect(before);
        rest.split_whitespace().next().and_then(|word| word.trim_end_matches(',').parse().ok()).expect("a number")
    };
    let slope = -(crank * angle.sin() / rod).asin();
    assert!((number("piston = ") - (crank * angle.cos() + rod * slope.cos())).abs() < 1e-14, "{text}");
    assert!((number("rod = ") - (slope - angle)).abs() < 1e-14, "{text}");
    // the rod turns by this for each turn of the crank
    let ratio = -crank * angle.cos() / (rod * slope.cos());
    let of_rod = 0.8 * (crank * angle.cos() + 0.12 * slope.cos() * ratio);
    let holding = gravity * (0.5 * 0.04 * angle.cos() + of_rod);
    let row = text.lines().find(|line| line.trim_start().starts_with("crank")).expect("its row");
    let torque: f64 = row.split_whitespace().nth(4).and_then(|word| word.parse().ok()).expect("a torque");
    assert!((torque - holding).abs() < 1e-14, "{torque} {holding}");
}

/// The rods of the ankle reach no further than 0.77 rad with this foot: what is behind is another assembly, with a foot
/// that is turned over. A parallelogram and its crossed bars meet where all bars lie on one line.
#[test]
fn the_end_of_an_assembly_is_told() {
    let ankle = "benches/trees/loops/g1_ankle.yaml";
    let run = |q: &str| rne(&["eval", ankle, "--q", q, "--qd", "0,0", "--qdd", "0,0"]);
    let within = run("0.74,-0.74");
    assert!(within.status == 0 && !within.err.contains("assembly") && within.out.contains("roll = 0.98"), "{within:?}");
    let beyond = run("0.8,-0.8");
    let told = "note: the assembly of the first configuration of the file ends, or meets another one, near q = 0.76";
    assert!(beyond.status == 0 && beyond.err.contains(told), "{beyond:?}");
    let text = std::fs::read_to_string(format!("{ROOT}/{FOUR_BAR}")).expect("a file");
    let parallelogram = text.replace(
        "xyz: [0.45, 0, 0]}, {on: rocker, xyz: [0.3, 0, 0]}",
        "xyz: [0.5, 0, 0]}, {on: rocker, xyz: [0.2, 0, 0]}",
    );
    assert_ne!(text, parallelogram);
    let arguments = ["eval", "-", "--qd", "1", "--qdd", "0", "--passive", "-0.00001,0.00001", "--q", "0.00001"];
    let near = rne_reading(&arguments, &parallelogram);
    assert!(near.status == 0 && near.err.contains("the loops are close to a singular position"), "{near:?}");
}

/// A table of states has a column for each dependent joint.
#[test]
fn states_of_closed_loops_have_their_columns() {
    let ankle = "benches/trees/loops/g1_ankle.yaml";
    let header = "q1,q2,passive1,passive2,passive3,passive4,passive5,passive6";
    let states = format!("{header}\n0.1,0.1,0,0,0,0,0,0\n");
    let called = rne_reading(&["eval", ankle, "--function", "mass_matrix_of_loops", "--states", "-"], &states);
    assert!(called.status == 0 && called.out.lines().count() == 2, "{called:?}");
}

#[test]
fn closed_loops_are_checked_and_shown_and_refused_elsewhere() {
    assert!(fine(&["check", FOUR_BAR]).contains("four_bar, RRR, modified"));
    let shown = fine(&["show", FOUR_BAR]);
    for said in [
        "loop pin, cut at a revolute joint: from (0.45, 0, 0) m on coupler to (0.3, 0, 0) m on rocker",
        "; dependent: coupler, rocker",
        "order of elimination: coupler by y of pin, rocker by x of pin; within the limits, pivots are ",
        "by 20 configurations that close the loops",
    ] {
        assert!(shown.contains(said), "{said}\n{shown}");
    }
    let refused = ["docs/four_bar.yaml:13:5", "the robot has closed loops, which are not supported here"];
    for command in [
        &["show", FOUR_BAR, "--json"][..],
        &["show", FOUR_BAR, "--symbolic"],
        &["check", "--physics", FOUR_BAR],
        &["export", "--urdf", FOUR_BAR],
    ] {
        let run = rne(command);
        let said = format!("{}{}", run.out, run.err);
        assert!(run.status == 1 && refused.iter().all(|part| said.contains(part)), "{command:?}\n{said}");
    }
}
