//! `rne emit --tests`: code passes the tests that are written beside it, and code that is wrong does not.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::call::{ROOT, fails, fine, folder};

/// Motors that choose by a sign; a joint that slides, a modified table and accelerations that are divided; parameters.
const ROBOTS: [&[&str]; 7] = [
    &["robots/puma560.yaml", "--rotors"],
    &["robots/stanford.yaml"],
    &["robots/puma560_mdh.yaml", "--form", "reduced"],
    &["docs/desk_arm.yaml", "--run-time", "upper,fore"],
    // numbers of the table that several steps need
    &["docs/every-key.yaml", "--run-time", "upper,rod"],
    // closed loops
    &["docs/four_bar.yaml"],
    &["benches/trees/loops/g1_ankle.yaml", "--form", "reduced"],
];

/// Every second robot, with the two ways to write its code in turns; each with both where all is asked for.
fn calls<'a>(ways: [&'a [&'a str]; 2]) -> impl Iterator<Item = (&'static [&'static str], &'a [&'a str])> {
    let in_turns =
        move |robot: usize, way: usize| shipped::is_exhaustive() || robot.is_multiple_of(2) && robot / 2 % 2 == way;
    let pairs = ROBOTS.into_iter().enumerate().flat_map(move |(robot, of)| [0, 1].map(|way| (robot, of, way)));
    pairs.filter(move |&(robot, _, way)| in_turns(robot, way)).map(move |(_, of, way)| (of, ways[way]))
}

/// What the tests of a file of Rust say.
fn tested_rust(folder: &Path, code: &str, options: &[&str]) -> Output {
    fs::write(folder.join("arm.rs"), code).expect("written");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let warnings = ["-D", "warnings", "-A", "dead_code"];
    let built = Command::new(rustc)
        .current_dir(folder)
        .args(["--edition", "2024", "--test", "arm.rs", "-o", "arm_rs"].iter().chain(&warnings).chain(options))
        .output()
        .expect("rustc starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    Command::new(folder.join("arm_rs")).output().expect("it starts")
}

/// What the tests of a file of C say; `None` where there is no compiler.
fn tested_c(folder: &Path, code: &str) -> Option<Output> {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    if Command::new(&compiler).arg("--version").output().is_err() {
        println!("not compiled: there is no compiler of C called `{compiler}`; CC names another");
        return None;
    }
    fs::write(folder.join("arm.c"), code).expect("written");
    let flags = "-std=c99 -O1 -Wall -Wextra -Wconversion -Wdouble-promotion -Wfloat-conversion -Wshadow \
                 -Wmissing-prototypes -pedantic -Werror -DRNE_TEST arm.c -o arm_c";
    let built = Command::new(compiler).current_dir(folder).args(flags.split_whitespace()).output().expect("it starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    Some(Command::new(folder.join("arm_c")).output().expect("it starts"))
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The code with a constant of its own that is a hundredth off, of so many that it has.
fn broken(code: &str, start: &str, end: &str) -> Vec<String> {
    let is_constant = |line: &str| line.trim_start().starts_with(start) && line.ends_with(end);
    let lines: Vec<&str> =
        code.lines().take_while(|line| !line.contains("cfg(test)") && !line.contains("RNE_TEST")).collect();
    let number = |line: &str| -> Option<(String, f64)> {
        let text = line.rsplit(['(', ' ']).next()?.trim_end_matches(end).trim_end_matches('f');
        Some((text.to_owned(), text.parse().ok()?))
    };
    let mut copies = Vec::new();
    for (at, line) in lines.iter().enumerate().filter(|(_, line)| is_constant(line)) {
        let Some((text, value)) = number(line) else { continue };
        let wrong = line.replacen(&text, &format!("{:?}", value * 1.01), 1);
        let changed: Vec<&str> =
            code.lines().enumerate().map(|(i, other)| if i == at { &wrong } else { other }).collect();
        copies.push(changed.join("\n") + "\n");
    }
    copies
}

#[test]
fn rust_passes_its_tests() {
    let folder = folder("tests_rust");
    for (robot, options) in calls([&[], &["--with-sin-cos", "--ascii"]]) {
        let code = fine(&[&["emit", "--tests", "--function", "all"], robot, options].concat());
        let output = tested_rust(&folder, &code, &[]);
        assert!(output.status.success(), "{robot:?}: {}", said(&output));
        let tests = code.matches("#[test]").count();
        assert!(tests >= 6 && said(&output).contains(&format!("{tests} passed; 0 failed")), "{}", said(&output));
    }
    // tests change nothing else, and those of a crate without `std` have it
    let plain = fine(&["emit", "robots/planar2.yaml"]);
    let code = fine(&["emit", "robots/planar2.yaml", "--tests"]);
    assert!(code.starts_with(&plain) && !plain.contains("cfg(test)"));
    let output = tested_rust(&folder, &format!("#![no_std]\n{code}"), &[]);
    assert!(output.status.success() && said(&output).contains("9 passed"), "{}", said(&output));
}

#[test]
fn c_passes_its_tests() {
    let folder = folder("tests_c");
    for (robot, options) in calls([&[], &["--real", "double", "--prefix", "arm"]]) {
        let code = fine(&[&["emit", "--tests", "--lang", "c", "--function", "all"], robot, options].concat());
        let Some(output) = tested_c(&folder, &code) else { return };
        assert!(output.status.success() && said(&output).contains(" tests, 0 wrong"), "{robot:?}: {}", said(&output));
    }
    // the step of a floating base begins at a pose, whose rotation is one
    for real in ["float", "double"] {
        let steps = "floating_euler_step,floating_euler_step_derivatives,floating_potential_energy";
        let code =
            fine(&["emit", "docs/satellite.yaml", "--tests", "--lang", "c", "--function", steps, "--real", real]);
        let Some(output) = tested_c(&folder, &code) else { return };
        assert!(output.status.success() && said(&output).contains(" tests, 0 wrong"), "{real}: {}", said(&output));
    }
    // friction and limits are tested, too, and a wrong number of theirs is noticed
    for real in ["float", "double"] {
        let joints = ["emit", "docs/desk_arm_identified.yaml", "--lang", "c", "--tests", "--friction", "--limits"];
        let code = fine(&[&joints[..], &["--real", real]].concat());
        let Some(output) = tested_c(&folder, &code) else { return };
        assert!(output.status.success() && said(&output).contains(" tests, 0 wrong"), "{}", said(&output));
        for (right, wrong) in [(" + coulomb1;", " - coulomb1;"), ("limited[0] = ", "limited[0] = -")] {
            assert!(code.contains(right), "{right}: {code}");
            let Some(output) = tested_c(&folder, &code.replace(right, wrong)) else { return };
            assert_eq!(output.status.code(), Some(1), "{right}: {}", said(&output));
        }
    }
    // so is the step of Runge-Kutta with its derivatives, also of parameters at run time
    let robots: [&[&str]; 2] = [&["docs/desk_arm.yaml", "--run-time", "upper,fore"], &["robots/planar2.yaml"]];
    for (robot, real) in robots.into_iter().zip(["float", "double"]) {
        let step = ["emit", "--lang", "c", "--tests", "--runge-kutta", "--real", real];
        let code = fine(&[&step[..], robot].concat());
        let Some(output) = tested_c(&folder, &code) else { return };
        assert!(output.status.success() && said(&output).contains("4 tests, 0 wrong"), "{robot:?}: {}", said(&output));
        let wrong = [
            ("(qdd[0][i] + (middle + middle))", "(qdd[0][i] + middle)", "runge_kutta_step, state"),
            ("(first[i][j] + (middle + middle))", "(first[i][j] + middle)", "runge_kutta_step_derivatives, state"),
            // single precision has too few digits for what is of the order of the step
            ("duration * change", "(duration - duration) * change", "runge_kutta_step_derivatives, state"),
        ];
        for (right, wrong, what) in wrong.into_iter().take(if real == "float" { 2 } else { 3 }) {
            assert!(code.contains(right), "{right}: {code}");
            let Some(output) = tested_c(&folder, &code.replace(right, wrong)) else { return };
            assert!(output.status.code() == Some(1) && said(&output).contains(what), "{right}: {}", said(&output));
        }
    }
    // a robot without the function has no step, and no empty file
    fails(1, &["emit", "docs/four_bar.yaml", "--lang", "c", "--runge-kutta"], &["closed loops"]);
    let alone = ["emit", "robots/planar2.yaml", "--lang", "c", "--tests", "--runge-kutta"];
    let code = fine(&[&alone[..], &["--function", "forward_dynamics"]].concat());
    let Some(output) = tested_c(&folder, &code) else { return };
    assert!(output.status.success() && said(&output).contains("2 tests, 0 wrong"), "{}", said(&output));
    // a follower that turns: its offset is an angle, and `d` may vary at run time
    let gripper = fs::read_to_string(Path::new(ROOT).join("docs/gripper.yaml")).expect("a gripper");
    let prismatic = "type: prismatic\n    dh: {theta: 0, d: 0, a: 0, alpha: -pi/2}";
    let revolute = "type: revolute\n    dh: {theta: 0, d: reach, a: 0, alpha: -pi/2}";
    assert!(gripper.contains(prismatic) && gripper.contains("offset: 0}"));
    let turning = (gripper.replace(prismatic, revolute).replace("offset: 0}", "offset: 0.2}"))
        .replace("joints:\n", "parameters: {reach: 0.1}\njoints:\n");
    fs::write(folder.join("turning.yaml"), turning).expect("written");
    let turning = folder.join("turning.yaml").display().to_string();
    let code = fine(&["emit", &turning, "--lang", "c", "--tests", "--run-time", "reach", "--real", "double"]);
    let Some(output) = tested_c(&folder, &code) else { return };
    assert!(code.contains("reach") && output.status.success(), "{}", said(&output));
    // the code and the runtime agree where the rotation of the base is one, to the last digit
    let contacts = |real| {
        let functions = ["--function", "forward_dynamics_in_contact,tip_accelerations"];
        [&["emit", "docs/standing_hyq.yaml", "--lang", "c", "--tests", "--real", real], &functions[..]].concat()
    };
    for real in ["float", "double"] {
        let code = fine(&contacts(real));
        let Some(output) = tested_c(&folder, &code) else { return };
        assert!(output.status.success() && said(&output).contains("2 tests, 0 wrong"), "{real}: {}", said(&output));
    }
    // where two contacts hold one foot, no state has forces to compare
    let twice = fs::read_to_string(Path::new(ROOT).join("docs/standing_hyq.yaml")).expect("HyQ");
    let twice = (twice.replace("tips: [", "tips: [toe, "))
        .replace("contacts:\n", "contacts:\n  - {tip: toe, kind: weld}\n")
        .replace("joints:\n", "  - {name: toe, on: lf_kfe_joint, xyz: [0.3, 0.1, 0]}\njoints:\n");
    fs::write(folder.join("twice.yaml"), twice).expect("written");
    let twice = folder.join("twice.yaml").display().to_string();
    let code = fine(&[&["emit", &twice][..], &contacts("double")[2..]].concat());
    let Some(output) = tested_c(&folder, &code) else { return };
    assert!(output.status.success() && said(&output).contains("1 test, 0 wrong"), "{}", said(&output));
    // or where the mass matrix is singular, also but for rounding: then there is no test, and nothing that no test uses
    let planar = fs::read_to_string(Path::new(ROOT).join("robots/planar2.yaml")).expect("planar2");
    let massless = planar.lines().filter(|line| !line.trim_start().starts_with("link:")).collect::<Vec<_>>().join("\n");
    let hopper = "{format: 2, name: hopper, source: own, convention: modified, gravity: [0, 0, -9.81], joints: [{name: \
                  hip, type: revolute, dh: {theta: 0, d: 0, a: 0.2, alpha: 0.7}, link: {mass: 2, com: [0.1, 0, 0.3], \
                  inertia: {xx: 0.5, yy: 0.8, zz: 0.7}}}], floating_base: {name: trunk, link: {mass: 0}}}";
    let none = "0 tests, as no state has results to compare";
    for (robot, function, tests) in [
        (massless.as_str(), "forward_dynamics", none),
        (&massless, "jacobian", "1 test"),
        (hopper, "floating_forward_dynamics", none),
        (hopper, "floating_forward_dynamics,floating_bias", "1 test"),
    ] {
        fs::write(folder.join("singular.yaml"), robot).expect("written");
        let robot = folder.join("singular.yaml").display().to_string();
        let code = fine(&["emit", &robot, "--lang", "c", "--real", "double", "--tests", "--function", function]);
        let Some(output) = tested_c(&folder, &code) else { return };
        let verdict = format!("{tests}, 0 wrong numbers");
        assert!(output.status.success() && said(&output).contains(&verdict), "{function}: {}", said(&output));
    }
    let plain = fine(&["emit", "robots/planar2.yaml", "--lang", "c"]);
    assert!(fine(&["emit", "robots/planar2.yaml", "--lang", "c", "--tests"]).starts_with(&plain));
    let out = folder.join("none.c");
    let check = ["emit", "robots/planar2.yaml", "--lang", "c", "--tests", "--check", out.to_str().expect("UTF-8")];
    fails(1, &check, &["--lang c --tests -o"]);
}

#[test]
fn a_wrong_constant_is_noticed() {
    let folder = folder("tests_broken");
    let emit = ["emit", "robots/planar2.yaml", "--tests", "--function", "inverse_dynamics,mass_matrix"];
    let copies = broken(&fine(&emit), "let ", ");");
    assert!(copies.len() > 4, "{}", copies.len());
    let one_in = if shipped::is_exhaustive() { 1 } else { 4 };
    for code in copies.iter().step_by(one_in) {
        let output = tested_rust(&folder, code, &[]);
        assert!(!output.status.success(), "{code}");
        assert!(said(&output).contains("_has_the_values_of_the_runtime ... FAILED"), "{}", said(&output));
    }
    for real in ["float", "double"] {
        let copies = broken(&fine(&[&emit[..], &["--lang", "c", "--real", real]].concat()), "const ", ";");
        assert!(copies.len() > 4, "{}", copies.len());
        for code in copies.iter().step_by(one_in) {
            let Some(output) = tested_c(&folder, code) else { return };
            assert_eq!(output.status.code(), Some(1), "{code}");
            assert!(said(&output).contains(", number "), "{}", said(&output));
        }
    }
    // laws alone notice what breaks them
    let code =
        fine(&["emit", "robots/planar2.yaml", "--tests", "--function", "mass_matrix,kinetic_energy", "--lang", "c"]);
    let (before, function) = code.split_once("planar2_mass_matrix(const float q[2], float mass[2][2])\n{").expect("it");
    let wrong = function.replacen("    mass[0][1] = ", "    mass[0][1] = 1.5f * ", 1);
    assert_ne!(wrong, function);
    let Some(output) =
        tested_c(&folder, &format!("{before}planar2_mass_matrix(const float q[2], float mass[2][2])\n{{{wrong}"))
    else {
        return;
    };
    for law in ["mass matrix is symmetric", "kinetic energy is that of the mass matrix"] {
        assert!(said(&output).contains(&format!("{law}, state 0")), "{}", said(&output));
    }
}
