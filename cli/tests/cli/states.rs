//! `rne eval --states`: files of states, CSV and arrays of numpy, against `rne eval` of each state.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::Stdio;

use rne_codegen::{Argument, Function};
use serde_json::Value;

use crate::call::{Called, Running, called, command, fails, fine, folder, rne, rne_reading};

/// The columns that a function asks for, as it tells them.
fn columns(robot: &str, function: &str) -> Vec<String> {
    let said = rne_reading(&["eval", robot, "--function", function, "--states", "-"], "t\n0\n").err;
    let needed = said.split("required columns are ").nth(1).and_then(|rest| rest.split("; others are ignored").next());
    needed.unwrap_or_else(|| panic!("{function}: {said}")).split(", ").map(str::to_owned).collect()
}

/// A number of a state: small, of both signs, never the same.
fn number(state: usize, column: usize) -> f64 {
    let steps = u32::try_from((state * 31 + column * 17 + 5) % 97).expect("small");
    f64::from(steps) / 40.0 - 1.2
}

/// Rows of an array as numpy saves it.
fn npy(kind: &str, fortran: &str, shape: &str, numbers: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}");
    header.push_str(&" ".repeat(127_usize.saturating_sub(10 + header.len())));
    header.push('\n');
    let length = u16::try_from(header.len()).expect("a short header").to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), numbers].concat()
}

fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// The shape in the header of an array, and its numbers.
fn read_npy(path: &Path) -> (String, Vec<f64>) {
    let file = fs::read(path).expect("an array");
    assert_eq!(&file[..8], b"\x93NUMPY\x01\x00", "the version that every numpy reads");
    let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
    let header = String::from_utf8(file[10..10 + length].to_vec()).expect("text");
    assert!(header.contains("'descr': '<f8'") && header.contains("'fortran_order': False"), "{header}");
    let shape = header.split("'shape': (").nth(1).and_then(|rest| rest.split(')').next()).expect("a shape");
    let numbers = file[10 + length..].chunks_exact(8);
    (
        shape.trim_end_matches([',', ' ']).to_owned(),
        numbers.map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight"))).collect(),
    )
}

/// The header and the numbers of CSV.
fn table(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (header, lines.map(row).collect())
}

fn flat(value: &Value, numbers: &mut Vec<f64>) {
    match value {
        Value::Array(parts) => parts.iter().for_each(|part| flat(part, numbers)),
        // in their order, which is not that of their names
        Value::Object(parts) => {
            let names = [
                "pose",
                "twist",
                "q",
                "qd",
                "rotation",
                "translation",
                "wrench",
                "force",
                "moment",
                "tau",
                "dq",
                "dqd",
                "dqdd",
                "domega",
                "dtau",
                "dq_dq",
                "dq_dqd",
                "dqd_dqd",
                "dq_dqdd",
                "q_dq",
                "q_dv",
                "q_dtau",
                "v_dq",
                "v_dv",
                "v_dtau",
                "momentum",
                "rate",
            ];
            let of_accelerations = ["accelerations", "base", "linear", "angular", "qdd", "wrenches_on_robot"];
            let known = |name: &String| names.iter().chain(&of_accelerations).any(|known| known == name);
            assert!(parts.keys().all(known), "this test does not read all of {:?}", parts.keys());
            names
                .iter()
                .chain(&of_accelerations)
                .filter_map(|name| parts.get(*name))
                .for_each(|part| flat(part, numbers));
        }
        number => numbers.push(number.as_f64().expect("a number")),
    }
}

/// One state by `rne eval`.
fn single(robot: &str, function: Function, columns: &[String], state: &[f64]) -> Vec<f64> {
    let list = |prefix: &str| -> Option<String> {
        let is_of = |column: &&String| {
            column.strip_prefix(prefix).is_some_and(|rest| {
                let is_axis = ["_x", "_y", "_z", "x", "y", "z"].contains(&rest);
                let is_whole = rest.is_empty() && prefix == "duration";
                is_whole || rest.parse::<usize>().is_ok() || is_axis || prefix == "base_rotation"
            })
        };
        let numbers: Vec<String> = columns
            .iter()
            .zip(state)
            .filter(|(column, _)| is_of(column))
            .map(|(_, number)| number.to_string())
            .collect();
        (!numbers.is_empty()).then(|| numbers.join(","))
    };
    let mut arguments =
        vec!["eval".to_owned(), robot.into(), "--json".into(), "--function".into(), function.to_string()];
    let mut give = |option: &str, list: Option<String>| {
        arguments.extend(list.into_iter().flat_map(|list| [option.to_owned(), list]));
    };
    for (option, prefix) in
        [("--q", "q"), ("--qd", "qd"), ("--qdd", "qdd"), ("--tau", "tau"), ("--multipliers", "multipliers")]
    {
        give(option, list(prefix));
    }
    give("--duration", list("duration"));
    give("--wrench", list("force").zip(list("moment")).map(|(force, moment)| format!("{force},{moment}")));
    give("--base-omega", list("base_omega").or_else(|| list("omega")));
    give("--base-omega-dot", list("base_omega_dot"));
    give("--base-acceleration", list("base_acceleration"));
    give("--base-velocity", list("base_velocity"));
    let rows: Vec<String> = ["x", "y", "z"].iter().filter_map(|row| list(&format!("pose_{row}"))).collect();
    give("--base-pose", list("pose").map(|origin| [rows.join(","), origin].join(",")));
    give("--gravity", list("base_gravity"));
    give("--base-rotation", list("base_rotation"));
    if function.takes(Argument::Wrenches) {
        let from = columns.iter().position(|column| column == "tip_fx").expect("a force");
        let wrench: Vec<String> = state[from..from + 6].iter().map(f64::to_string).collect();
        give("--tip-wrench", Some(format!("tip={}", wrench.join(","))));
    }
    if function.takes(Argument::Payload) {
        let from = columns.iter().position(|column| column == "m").expect("a mass");
        let payload: Vec<String> = state[from..from + 10].iter().map(f64::to_string).collect();
        give("--payload", Some(payload.join(",")));
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let json: Value = serde_json::from_str(&fine(&arguments)).expect("JSON");
    let mut numbers = Vec::new();
    flat(&json["result"], &mut numbers);
    numbers
}

/// A rotation none of whose angles is a right one, row by row.
const ROTATION: [f64; 9] = [0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6];

/// Every function, of a file of CSV whose columns stand in any order and of an array, is that of each state by itself.
#[test]
fn every_function_is_that_of_single_states() {
    const STATES: usize = 2;
    let folder = folder("states_functions");
    let path = |name: &str| folder.join(name).display().to_string();
    for function in Function::OF_TREES.into_iter().step_by(if shipped::is_exhaustive() { 1 } else { 3 }) {
        let robot = match function {
            Function::ForwardDynamicsInContact => "docs/standing_hyq.yaml",
            _ if function.is_of_floating_base() => "docs/satellite.yaml",
            _ => "robots/stanford.yaml",
        };
        let name = function.name();
        let columns = columns(robot, name);
        let mut states: Vec<Vec<f64>> =
            (0..STATES).map(|state| (0..columns.len()).map(|column| number(state, column)).collect()).collect();
        let place = |wanted: &str| columns.iter().position(|column| column == wanted);
        for state in &mut states {
            if let Some(mass) = place("m") {
                state[mass] = state[mass].abs();
                // a body
                state[mass + 4..mass + 7].iter_mut().for_each(|moment| *moment = 9.0 + moment.abs());
            }
            if let Some(duration) = place("duration") {
                state[duration] = state[duration].abs();
            }
            // rotations, row by row
            for prefix in ["base_rotation", "pose_"] {
                let places = columns.iter().enumerate().filter(|(_, column)| column.starts_with(prefix));
                places.zip(ROTATION).for_each(|((place, _), element)| state[place] = element);
            }
            for joint in 1..=6 {
                if let (Some(q), Some(sin), Some(cos)) =
                    (place(&format!("q{joint}")), place(&format!("sin{joint}")), place(&format!("cos{joint}")))
                {
                    (state[sin], state[cos]) = state[q].sin_cos();
                }
            }
        }
        // the columns from the last to the first, and one that nobody asks for
        let line =
            |cells: Vec<String>| format!("{},no number\n", cells.into_iter().rev().collect::<Vec<_>>().join(","));
        let mut csv = line(columns.clone());
        csv.extend(states.iter().map(|state| line(state.iter().map(f64::to_string).collect())));
        fs::write(path("in.csv"), csv).expect("a file");
        let called = rne(&["eval", robot, "--function", name, "--states", &path("in.csv")]);
        assert_eq!(called.status, 0, "{called:?}");
        assert!(called.err.starts_with(&format!("{name} of {STATES} states (")), "{called:?}");
        let (header, found) = table(&called.out);
        assert!((1..header.len()).all(|at| !header[..at].contains(&header[at])), "two columns of a name: {header:?}");

        let shape = format!("({STATES}, {})", columns.len());
        fs::write(path("in.npy"), npy("<f8", "False", &shape, &bytes(&states.concat()))).expect("a file");
        let arguments =
            ["eval", robot, "--function", name, "--states", &path("in.npy"), "-o", &path("out.npy"), "--force"];
        let wrote = rne(&arguments);
        assert!(wrote.status == 0 && wrote.out.is_empty() && wrote.err.starts_with("wrote "), "{wrote:?}");
        let (shape, numbers) = read_npy(&folder.join("out.npy"));
        assert_eq!(shape, format!("{STATES}, {}", header.len()), "{name}");
        assert_eq!(numbers, found.concat(), "{name}: the same as CSV");

        for (state, found) in states.iter().zip(&found) {
            let expected = single(robot, function, &columns, state);
            assert_eq!(found.len(), expected.len(), "{name}");
            let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
            let error = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error <= 1e-12 * scale, "{name}: {found:?} is not {expected:?}");
        }
    }
}

/// The column of a duration has the name of the option, or the name of generated code.
#[test]
fn a_duration_has_two_names() {
    let arguments = ["eval", "planar1", "--function", "euler_step", "--states", "-"];
    assert_eq!(columns("planar1", "euler_step"), ["q1", "qd1", "tau1", "duration"]);
    let table = |name: &str, duration: &str| format!("tau1,{name},q1,qd1\n1,{duration},0.5,2\n");
    let found = rne_reading(&arguments, &table("duration", "0.01"));
    assert!(found.status == 0 && found.out.lines().count() == 2, "{found:?}");
    assert_eq!(rne_reading(&arguments, &table("step", "0.01")).out, found.out);
}

/// A duration that is not above zero is refused in a table and as an option.
#[test]
fn a_duration_is_positive() {
    let arguments = ["eval", "planar1", "--function", "euler_step", "--states", "-"];
    let table = |name: &str, duration: &str| format!("tau1,{name},q1,qd1\n1,{duration},0.5,2\n");
    for (name, duration) in [("duration", "0"), ("step", "-1"), ("duration", "NaN"), ("duration", "inf")] {
        let refused = rne_reading(&arguments, &table(name, duration));
        let said =
            format!("<standard input>:2: `{name}`: the step is {duration} s, but it must be a finite number above 0");
        assert!(refused.status == 1 && refused.said().contains(&said), "{refused:?}");
    }
    let single = ["eval", "planar1", "--function", "euler_step", "--q", "0.5", "--qd", "2", "--tau", "1"];
    assert_eq!(rne(&[&single[..], &["--duration", "1/100"]].concat()).status, 0);
    for duration in ["0", "-1", "-0.0", "nan", "inf", "0.01,0.02"] {
        let said = ["'--duration <H>': write a number of seconds above 0, such as 0.01"];
        fails(2, &[&single[..], &["--duration", duration]].concat(), &said);
    }
}

fn gravity(states: &str) -> Called {
    rne_reading(&["eval", "planar2", "--function", "gravity_torques", "--states", "-"], states)
}

#[test]
fn columns_of_results_are_named() {
    let header = |function: &str| {
        let columns = columns("planar2", function).join(",") + "\n";
        rne_reading(&["eval", "planar2", "--function", function, "--states", "-"], &columns).out
    };
    assert_eq!(header("inverse_dynamics"), "tau1,tau2\n");
    assert_eq!(header("forward_dynamics"), "qdd1,qdd2\n");
    assert_eq!(header("kinetic_energy"), "kinetic_energy\n");
    assert_eq!(header("mass_matrix"), "mass_matrix_1_1,mass_matrix_1_2,mass_matrix_2_1,mass_matrix_2_2\n");
    assert!(header("joint_wrenches").starts_with("joint_wrenches_1_force_1,joint_wrenches_1_force_2,"));
}

/// What spreadsheets and shells write.
#[test]
fn csv_has_many_faces() {
    let plain = gravity("q1,q2\n0.3,-0.7\n1,2\n");
    assert_eq!(plain.status, 0, "{plain:?}");
    for other in [
        "\u{feff}q1,q2\r\n0.3,-0.7\r\n1,2\r\n",
        "# measured\n\n\"q1\", \"q2\" \n \"0.3\" , -0.7\n# half of it\n\n1.0,2e0",
        "note,q2,q1\n\"a, b\",-0.70,0.3\n,+2,1.\n",
    ] {
        assert_eq!(gravity(other).out, plain.out, "{other}");
    }
    let empty = gravity("q1,q2\n");
    assert_eq!(
        (empty.status, empty.out.as_str(), empty.err.as_str()),
        (0, "tau1,tau2\n", "gravity_torques of 0 states\n")
    );
    assert!(gravity("q1,q2\n1,2\n").err.starts_with("gravity_torques of 1 state ("));
}

/// Positions of dependent joints in a table are no guess, so those that leave a loop open are told.
#[test]
fn open_loops_are_told() {
    let header = "q1,qd1,qdd1,passive1,passive2\n";
    let arguments = ["eval", "docs/four_bar.yaml", "--states", "-"];
    let open = rne_reading(&arguments, &format!("{header}0.3,0,0,0.5,1\n"));
    assert!(open.err.ends_with("note: the loops of state 1 are not closed, so the numbers mean nothing\n"), "{open:?}");
    // as `rne eval --passive 0.5,1` finds them, to six digits
    let closed = rne_reading(&arguments, &format!("{header}0.3,0,0,0.238383,1.309811\n"));
    assert!(closed.status == 0 && !closed.err.contains("not closed"), "{closed:?}");
}

/// States without a finite result have none, and are counted.
#[test]
fn what_is_not_finite_is_told() {
    let found = gravity("q1,q2\n1,2\ninf,0\nNaN,0\n1,2\n");
    assert_eq!(found.status, 0, "{found:?}");
    assert!(found.err.ends_with("note: the results of 2 states are not finite; the first is state 2\n"), "{found:?}");
    let lines: Vec<&str> = found.out.lines().collect();
    assert_eq!((lines[1], lines[2], lines[3]), (lines[4], "NaN,NaN", "NaN,NaN"));
    assert!(found.err.contains("note: arguments of 2 states are not finite; the first is state 2\n"), "{found:?}");
    let told = "j1 is at 90 rad, more than a full turn; if this is in degrees, convert the column to radians\n";
    assert!(gravity("q1,q2\n0,1\n90,0.5\n").err.ends_with(told));
    assert!(!gravity("q1,q2\n0,1\n30,0.51\n").err.contains("degrees"));
    assert!(gravity("q1,q2\n0,1\n90,0.51\n").err.contains("degrees"));
    assert!(gravity("q1,q2\ninf,0\n").err.ends_with("note: the result of state 1 is not finite\n"));
}

/// A body of negative mass is refused, as `rne eval --payload` refuses it, in its row.
#[test]
fn a_negative_mass_of_a_payload_is_refused() {
    let arguments = ["eval", "planar2", "--function", "inverse_dynamics_with_payload", "--states", "-"];
    let names = columns("planar2", "inverse_dynamics_with_payload");
    let place = names.iter().position(|name| name == "m").expect("a mass");
    let row = |mass: f64| {
        let mut numbers = vec![0.5; names.len()];
        numbers[place] = mass;
        numbers
    };
    let line = |mass: f64| row(mass).iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n";
    let table = |masses: &[f64]| names.join(",") + "\n" + &masses.iter().map(|mass| line(*mass)).collect::<String>();
    let found = rne_reading(&arguments, &table(&[1.0, 0.0, -0.25, 1.0]));
    assert!(found.status == 1 && found.out.is_empty(), "{found:?}");
    let said = "<standard input>:4: `m`: the payload's mass is -0.25 kg: no body has less than 0";
    assert!(found.err.contains(said), "{found:?}");
    assert_eq!(rne_reading(&arguments, &table(&[1.0, 0.0, -0.0])).status, 0);

    // no body has such an inertia
    let moment = names.iter().position(|name| name == "Izz").expect("an inertia");
    let negative: Vec<String> =
        row(1.0).iter().enumerate().map(|(at, x)| if at == moment { "-9".into() } else { x.to_string() }).collect();
    let found = rne_reading(&arguments, &format!("{}{}\n", table(&[1.0]), negative.join(",")));
    assert!(
        found.status == 1 && found.err.contains("<standard input>:3: `Ixx`: the payload's inertia has"),
        "{found:?}"
    );

    // the same rule for one state
    let single = [&arguments[..4], &["--q", "0,0", "--qd", "0,0", "--qdd", "0,0", "--payload=-0.25,0,0,0"]].concat();
    fails(2, &single, &["--payload: the payload's mass is -0.25 kg: no body has less than 0"]);

    let folder = folder("states_payload");
    let (path, out) = (folder.join("in.npy"), folder.join("out.npy"));
    // in the second part
    let masses = |state: usize| if state == 20_000 { -0.25 } else { 1.0 };
    let numbers: Vec<f64> = (1..=20_001).flat_map(|state| row(masses(state))).collect();
    let shape = format!("(20001, {})", names.len());
    fs::write(&path, npy("<f8", "False", &shape, &bytes(&numbers))).expect("a file");
    let [path, output] = [&path, &out].map(|path| path.display().to_string());
    let said = format!("{path}: state 20000: in column {}: the payload's mass is -0.25 kg", place + 1);
    fails(1, &[&arguments[..5], &[path.as_str(), "-o", &output]].concat(), &[&said]);
    assert!(!out.exists(), "a file is whole or not there");
}

/// A table of states is refused if a row has a matrix that is no rotation. `rne eval --base-rotation` refuses it, too.
#[test]
fn a_rotation_that_is_none_is_refused() {
    for (function, first, at) in [("tip_jacobians", "base_rotation_xx", 2), ("floating_potential_energy", "pose_xx", 2)]
    {
        let arguments = ["eval", "docs/satellite.yaml", "--function", function, "--states", "-"];
        let names = columns("docs/satellite.yaml", function);
        assert_eq!(names[at], first);
        let line = |xx: f64| {
            let mut numbers = vec![0.5; names.len()];
            numbers[at..at + 9].copy_from_slice(&ROTATION);
            numbers[at] += xx;
            numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n"
        };
        let table = |off: f64| names.join(",") + "\n" + &line(0.0) + &line(off);
        assert_eq!(rne_reading(&arguments, &table(1e-6)).status, 0);
        let found = rne_reading(&arguments, &table(1e-3));
        let argument = if function == "tip_jacobians" { "base_rotation" } else { "pose" };
        let said = format!("<standard input>:3: `{first}`: `{argument}` is no rotation: its three rows must have");
        assert!(found.status == 1 && found.err.contains(&said), "{found:?}");
    }
}

/// Also in a file of several parts, whose states are counted from its first one.
#[test]
fn a_sine_and_a_cosine_of_no_angle_are_refused() {
    let mut text = "q1,q2,qd1,qd2,qdd1,qdd2,sin1,sin2,cos1,cos2\n".to_owned();
    let row = |state: i32| ["0,0,0,0,0,0,0,0.6,1,0.8\n", "0,0,0,0,0,0,0,0.5,1,0.8\n"][usize::from(state == 19_000)];
    text.extend((1..=20_000).map(row));
    let said = rne_reading(&["eval", "planar2", "--function", "inverse_dynamics_from_sin_cos", "--states", "-"], &text);
    assert_eq!(said.status, 1, "{}", said.err);
    assert!(said.err.contains("state 19000: `sin` and `cos` are 0.5 and 0.8 for joint 2"), "{}", said.err);
}

/// Nothing is printed beside a message where the mistake is among the first states.
#[test]
fn mistakes_in_csv_have_a_line() {
    for (states, said) in [
        ("", "<standard input> is empty; its header is q1,q2, in any order"),
        ("q1,q2\n1,2\n0.5,-1e400\n", "<standard input>:3: `q2` is `-1e400`, which is too large for a 64-bit float"),
        ("q1,q2\n1e-400,2\n", "<standard input>:2: `q1` is `1e-400`, which is too small for a 64-bit float"),
        ("q1\n1\n", "<standard input>: the header has no column `q2` (there is `q1`); the required columns are q1, q2"),
        ("# angles\nQ1,Q2\n1,2\n", ": the header has no column `q1` (there is `Q1`)"),
        ("1,2\n3,4\n", ": the header has no column `q1`; the required columns are q1, q2; others are ignored"),
        ("q1;q2\n1;2\n", "(it has semicolons; columns are separated by commas)"),
        ("q1\tq2\n1\t2\n", "(it has tabs; columns are separated by commas)"),
        ("q1,q2,q1\n1,2,3\n", ": the column `q1` occurs twice"),
        ("q1,q2\n1,2\n\n1,pi/2\n", ":4: `q2` is `pi/2`, which is not a number"),
        ("q1,q2\r\n1,2\r\n# and\r\n\r\n1,pi/2", ":5: `q2` is `pi/2`, which is not a number"),
        ("q1,q2,of\n1,2,\"a\nb\"\n1,x,\"a\nb\"\n", ":4: `q2` is `x`, which is not a number"),
        ("q1,q2\n1,\n", ":2: `q2` is empty"),
        ("q1,q2\n1,2\u{1b}[31m\n", ":2: `q2` is `2\\u{1b}[31m`, which is not a number"),
        ("q1,q2\n1,2\n1,2,3\n", ":3: the line has 3 cells, but the header has 2"),
        ("q1,q2\n1\n", ":2: the line has 1 cell, but the header has 2"),
        (
            "q1,q2\n\"1,2\n3,4\n",
            ":2: the line has 1 cell, but the header has 2; a quote in it is not closed on its line",
        ),
    ] {
        let found = gravity(states);
        assert!(found.status == 1 && found.out.is_empty(), "{states:?}: {found:?}");
        assert!(found.err.contains(said), "{states:?}: {}", found.err);
    }
    let long = gravity(&("q1,q2\n\"".to_owned() + &"1\n".repeat(1 << 20)));
    assert!(
        long.err.contains(":2: the line has more than a million characters, or a quote in it is not closed"),
        "{long:?}"
    );
}

fn reading(bytes: &[u8]) -> Called {
    let mut command = command(&["eval", "planar2", "--function", "gravity_torques", "--states", "-"]);
    let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("rne starts");
    let _ = child.stdin.take().expect("a pipe").write_all(bytes);
    called(child.wait_with_output().expect("rne ends"))
}

#[test]
fn arrays_of_numpy_are_read() {
    let states = [0.5, -0.75, 1.0, 2.0, 0.25, 0.0];
    let expected = gravity("q1,q2\n0.5,-0.75\n1,2\n0.25,0\n").out;
    let big: Vec<u8> = states.iter().flat_map(|x: &f64| x.to_be_bytes()).collect();
    #[allow(clippy::cast_possible_truncation)] // these have few digits
    let single: Vec<u8> = states.iter().flat_map(|x| (*x as f32).to_le_bytes()).collect();
    for (kind, numbers) in [("<f8", bytes(&states)), (">f8", big), ("<f4", single)] {
        assert_eq!(reading(&npy(kind, "False", "(3, 2)", &numbers)).out, expected, "{kind}");
    }
    let one = gravity("q1,q2\n0.5,-0.75\n").out;
    assert_eq!(reading(&npy("<f8", "True", "(1, 2)", &bytes(&states[..2]))).out, one, "either order of one row");
    assert_eq!(reading(&npy("<f8", "False", "(0, 2)", &[])).out, "tau1,tau2\n");
}

#[test]
fn mistakes_in_arrays_are_told() {
    let six = bytes(&[0.0; 6]);
    for (kind, fortran, shape, said) in [
        ("<f8", "False", "(6,)", "the array has 1 axis; its shape is (states, 2)"),
        ("<f8", "False", "(1, 3, 2)", "the array has 3 axes; its shape is (states, 2)"),
        ("<f8", "False", "(2, 3)", "the array has 3 columns, but 2 are needed: q1, q2"),
        ("<f8", "True", "(3, 2)", "the array is in Fortran's order; save numpy.ascontiguousarray(states)"),
        ("<i8", "False", "(3, 2)", "the numbers are `<i8`; save them as float64 or float32"),
        ("<f8", "False", "(4, 2)", "the file ends before the last of 4 states"),
        ("<f8", "False", "(9223372036854775807, 2)", "not an array of numpy: its shape is too large"),
        (
            "<f8",
            "False",
            "(0, 0xffffffffffffffff, 2)",
            "not an array of numpy: its shape is too large, or is not a tuple of whole numbers",
        ),
        ("<f8", "False", "(0, 9999999999, 9999999999, 2)", "not an array of numpy: its shape is too large"),
        ("<f8", "False", "(-3, 2)", "its shape is too large, or is not a tuple of whole numbers"),
        ("<f8", "False", "3, 2)", "not an array of numpy: its header must have '(' here, but there is `3, 2)"),
    ] {
        let found = reading(&npy(kind, fortran, shape, &six));
        assert!(found.status == 1 && found.out.is_empty(), "{kind} {shape}: {found:?}");
        assert!(found.err.contains(said), "{kind} {shape}: {}", found.err);
    }
    let whole = npy("<f8", "False", "(3, 2)", &six);
    for length in 1..whole.len() {
        if length > 12 && length % 7 != 0 {
            continue;
        }
        let found = reading(&whole[..length]);
        let said =
            if length < 128 { "the file ends in its header" } else { "the file ends before the last of 3 states" };
        assert!(found.status == 1 && found.out.is_empty() && found.err.contains(said), "{length}: {found:?}");
    }
    let long = [b"\x93NUMPY\x02\x00".as_slice(), &u32::MAX.to_le_bytes(), b"{}"].concat();
    assert!(
        reading(&long).err.contains("not an array of numpy: its header has 4294967295 bytes; at most 65536 are read")
    );
    assert!(reading(b"\xff\xfeq\x001\x00").err.contains("looks like UTF-16; save the file as UTF-8"));
}

#[test]
fn files_stay_unless_told_otherwise() {
    let folder = folder("states_files");
    let path = |name: &str| folder.join(name).display().to_string();
    let (states, out) = (path("states.csv"), path("out.csv"));
    fs::write(&states, "q1,q2\n1,2\n").expect("a file");
    fs::write(path("wrong.csv"), "q1,q2\n1,x\n").expect("a file");
    let to = |states: &str, out: &str, more: &[&str]| {
        let all = [&["eval", "planar2", "--function", "gravity_torques", "--states", states, "-o", out], more].concat();
        rne(&all)
    };
    assert_eq!(to(&path("wrong.csv"), &out, &[]).status, 1);
    assert!(!folder.join("out.csv").exists(), "it appears when it is whole");
    let wrote = to(&states, &out, &[]);
    assert!(
        wrote.status == 0 && wrote.err.starts_with(&format!("wrote {out}: gravity_torques of 1 state (")),
        "{wrote:?}"
    );
    let text = fs::read_to_string(&out).expect("results");
    assert_eq!(text, gravity("q1,q2\n1,2\n").out);
    for (out, more, status, said) in [
        (&out, &[][..], 2, "exists and is not changed; --force overwrites it"),
        (&states, &["--force"], 2, "is also the file that rne reads; name another file"),
        (&folder.display().to_string(), &["--force"], 2, "is a folder; name a file in it"),
        (&path("nowhere/out.csv"), &[], 1, "make it first"),
        (
            &path("out.parquet"),
            &[],
            2,
            "ends with .parquet, which this command does not write; name a file that ends with .csv or .npy",
        ),
        (&path("out"), &[], 2, "has no ending that gives the format; name a file that ends with .csv or .npy"),
    ] {
        let found = to(&states, out, more);
        assert!(found.status == status && found.err.contains(said), "{found:?}");
    }
    assert_eq!(to(&states, &out, &["--force"]).status, 0);
    let rest = fs::read_dir(&folder).expect("a folder").count();
    assert_eq!(rest, 3, "nothing else is left");
}

/// A link leads to the file that is written, and a file that is protected stays.
#[cfg(unix)]
#[test]
fn links_and_protected_files_are_respected() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = folder("states_links");
    let path = |name: &str| folder.join(name).display().to_string();
    fs::write(path("states.csv"), "q1,q2\n1,2\n").expect("a file");
    for name in ["out.csv", "out.npy"] {
        fs::write(path(name), "old").expect("a file");
        fs::set_permissions(path(name), fs::Permissions::from_mode(0o600)).expect("permissions");
        let link = format!("link_to_{name}");
        symlink(name, path(&link)).expect("a link");
        let to = |out: &str| {
            let states = path("states.csv");
            rne(&["eval", "planar2", "--function", "gravity_torques", "--states", &states, "-o", &path(out), "--force"])
        };
        assert_eq!(to(&link).status, 0);
        assert!(fs::symlink_metadata(path(&link)).expect("it is there").is_symlink());
        assert_ne!(fs::read(path(name)).expect("results"), b"old");
        assert_eq!(fs::metadata(path(name)).expect("results").permissions().mode() & 0o777, 0o600);
        fs::set_permissions(path(name), fs::Permissions::from_mode(0o400)).expect("permissions");
        let found = to(name);
        assert!(found.status == 1 && found.err.contains("it is write-protected"), "{found:?}");
    }
}

/// `rne eval … | head` is no error, and results come as they are computed.
#[test]
fn a_reader_that_goes_away_is_no_error() {
    let states = "q1,q2\n".to_owned() + &"0.1,0.2\n".repeat(40_000);
    let mut command = command(&["eval", "planar2", "--function", "gravity_torques", "--states", "-"]);
    let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("rne starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || {
        let _ = stdin.write_all(states.as_bytes());
    });
    let mut out = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut line = String::new();
    out.read_line(&mut line).expect("a line");
    assert_eq!(line, "tau1,tau2\n");
    drop(out);
    let called = called(child.wait_with_output().expect("rne ends"));
    writer.join().expect("it ends");
    assert!(called.status == 0 && called.err.is_empty(), "{called:?}");
}

/// The most memory, in kB, that `rne eval` had while it read so many states from a pipe.
#[cfg(target_os = "linux")]
fn peak(states: usize) -> u64 {
    const PART: usize = 1000;
    let mut command = command(&["eval", "planar2", "--states", "-"]);
    let mut child = Running::of(command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()));
    let mut stdin = child.stdin.take().expect("a pipe");
    let part = bytes(&(0..6 * PART).map(|index| number(index / 6, index % 6)).collect::<Vec<_>>());
    stdin.write_all(&npy("<f8", "False", &format!("({states}, 6)"), &[])).expect("it reads");
    for _ in 0..states / PART {
        stdin.write_all(&part).expect("it reads");
    }
    // it waits for the end of the pipe
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).expect("it runs");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("the most memory it had");
    drop(stdin);
    assert!(child.wait().expect("it ends").success());
    line.trim().trim_end_matches(" kB").parse().expect("a number")
}

/// A million states, ten and a hundred with `RNE_EXHAUSTIVE` set:
/// `RNE_EXHAUSTIVE=1 cargo test --release -p rne-cli --test cli -- memory_does_not_grow --nocapture`.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_states() {
    let is_exhaustive = std::env::var_os("RNE_EXHAUSTIVE").is_some();
    let counts = if is_exhaustive { &[1_000_000, 10_000_000, 100_000_000][..] } else { &[40_000, 160_000] };
    let peaks: Vec<u64> = counts.iter().map(|&states| peak(states)).collect();
    println!("{counts:?} states of planar2 in a pipe: {peaks:?} kB at most");
    assert!(peaks.iter().max().expect("some") - peaks[0] < 2_000, "{peaks:?} kB of {counts:?} states");
}

#[test]
fn options_that_do_not_go_with_states_are_refused() {
    let of_one = ["eval", "planar2", "--q", "1,2", "--qd", "1,2", "--qdd", "1,2", "-o", "nowhere.csv"];
    fails(2, &of_one, &["-o is for the results of --states"]);
    fails(2, &["eval", "planar2", "--states", "nowhere.csv", "--q", "1,2"], &["--q is for one state; with --states"]);
    for other in [["--axes", "link"], ["--step", "4"], ["--golden", "3"]] {
        fails(
            2,
            &["eval", "planar2", "--states", "nowhere.csv", other[0], other[1]],
            &["cannot be used with", other[0]],
        );
    }
    fails(2, &["eval", "-", "--states", "-"], &["FILE and --states are both standard input"]);
    fails(1, &["eval", "planar2", "--states", "nowhere.csv"], &["the states nowhere.csv cannot be read"]);
    fails(1, &["eval", "planar2", "--states", "robots"], &["robots is a folder; name a file of states"]);
}
