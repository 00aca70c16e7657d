//! `rne certify`: a certificate of the user's own arm.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::call::{ROOT, called as called_as, command, fails, fine, folder, rne, rne_reading};

const ROBOT: &str = "docs/desk_arm.yaml";

/// Whether all tools are there; a line says that the test is skipped.
pub(crate) fn has_tools() -> bool {
    let missing: Vec<&str> = ["arm-none-eabi-gcc", "arm-none-eabi-objdump", "qemu-system-arm", "cppcheck"]
        .into_iter()
        .filter(|tool| Command::new(tool).arg("--version").output().is_err())
        .collect();
    if !missing.is_empty() {
        println!("not certified: {} is not installed (cargo xtask certificate --install)", missing.join(", "));
    }
    missing.is_empty()
}

/// Whether all tools are there and all tests are asked for: `cargo xtask verify certify` asks for them.
fn tries_all() -> bool {
    if !shipped::is_exhaustive() {
        println!("not certified: set RNE_EXHAUSTIVE");
    }
    shipped::is_exhaustive() && has_tools()
}

#[test]
fn a_compiler_that_is_missing_is_named_with_its_package() {
    // a package of another name than the one of the default may hold it
    let called = rne(&["certify", ROBOT, "--cc", "clang-99"]);
    assert!(called.status == 1 && called.err.contains("there is no program clang-99; install it"), "{called:?}");
    assert!(!called.err.contains("apt-get"), "{called:?}");
    let mut without = command(&["certify", ROBOT]);
    let called = called_as(without.env("PATH", "").output().expect("rne starts"));
    assert!(called.status == 1 && called.said().contains("apt-get install gcc-arm-none-eabi"), "{called:?}");
    fails(2, &["certify", ROBOT, "--states", "0"], &["--states", "give 1 or more"]);
    fails(2, &["certify", ROBOT, "--cpu", "cortex-m0"], &["cortex-m4 and cortex-m7"]);
    let record = ["certify", ROBOT, "--lang", "rust", "--function", "momentum_and_rate"];
    fails(2, &record, &["a vector or a matrix", "momentum_and_rate", "--lang c"]);
}

#[test]
fn a_certificate_is_checked_and_a_change_is_found() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify");
    let out = folder.join("arm.cert.md");
    let out = out.to_str().expect("UTF-8");
    let certify = ["certify", ROBOT, "--states", "100", "-o", out];
    let said = rne(&certify);
    assert!(said.status == 0 && !said.err.contains("states are few"), "{said:?}");
    let page = fs::read_to_string(out).expect("it was written");
    for part in ["| double precision | none |", "QEMU runs the code", "| 19.2 | 4 |", "SHA-256"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    // two pages for a reader: the lines of the code are in JSON
    assert!(page.lines().count() < 250 && page.contains("| result | joint | unit |"), "{page}");
    let check = ["certify", ROBOT, "--states", "100", "--check", out];
    assert_eq!(rne(&check).status, 0);
    fs::write(out, page.replacen("| bytes of constants | ", "| bytes of constants | 1", 1)).expect("written");
    fails(1, &check, &["1 lines differ", "bytes of constants"]);
    // the compiler of the default, by its name
    fs::write(out, &page).expect("written");
    assert_eq!(rne(&[&check[..], &["--cc", "arm-none-eabi-gcc"]].concat()).status, 0);
    fs::write(out, "").expect("written");
    fails(1, &check, &["is empty", "-o"]);
    fails(2, &["certify", ROBOT, "--cc", "python3"], &["python3 is no GCC", "--cc"]);
    // another arm, and a file that is no certificate
    fs::write(out, &page).expect("written");
    fails(1, &["certify", "planar2", "--states", "100", "--check", out], &["lines differ"]);
    fs::write(out, "mine").expect("written");
    fails(2, &certify, &["is no certificate of rne and is not changed", "--force"]);
    assert_eq!(fs::read_to_string(out).expect("it is there"), "mine");
}

#[test]
fn the_figures_of_json_are_those_of_the_page() {
    if !tries_all() {
        return;
    }
    for cpu in ["cortex-m4", "cortex-m7"] {
        let certify = ["certify", ROBOT, "--states", "50", "--cpu", cpu];
        let json: serde_json::Value = serde_json::from_str(&fine(&[&certify[..], &["--json"]].concat())).expect("JSON");
        let page = fine(&certify);
        let instructions = json["cost"]["instructions"].as_u64().expect("a number");
        assert_eq!(json["emulation"]["instructions"].as_u64(), Some(instructions));
        assert!(page.contains(&format!("a call executes once | {instructions} |")), "{page}");
        let kinds = json["cost"]["classes"].as_array().expect("kinds").iter();
        let sum: u64 = kinds.map(|kind| kind["instructions"].as_u64().expect("a number")).sum();
        assert_eq!(sum, instructions, "each instruction is of one kind");
        assert_eq!(json["cost"]["stack"], json["cost"]["stack_of_listing"]);
    }
}

/// The tables of docs/firmware/first-firmware.md, and that more options of the compiler do not change a bit: QEMU's
/// results are compared with those of this computer.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn options_of_the_compiler_make_robots_smaller() {
    if !has_tools() {
        return;
    }
    let document = fs::read_to_string(Path::new(ROOT).join("docs/firmware/first-firmware.md")).expect("it is there");
    let rows = |start: &str| -> Vec<Vec<&str>> {
        document
            .lines()
            .filter(|line| line.starts_with(start))
            .map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`')).collect())
            .collect()
    };
    let certify = ["certify", "docs/standing_hyq.yaml", "--function", "inverse_dynamics_of_floating_base", "--json"];
    let is_right = |certify: &[&str], options: &str, figures: &[&str]| {
        let text = fine(&[certify, &["--states", "100", &format!("--cc-options={options}")]].concat());
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let cost = &json["cost"];
        let of = |figure: &str| cost[figure].as_u64().expect("a number");
        assert!(options.is_empty() || json["command"].as_str().expect("text").contains(options), "{text}");
        assert_eq!(json["emulation"]["instructions"], cost["instructions"]);
        // the figures are those of one compiler
        if text.contains("12.2.1") {
            let found = [of("instructions"), of("cycles"), of("code") + of("constants"), of("stack")];
            assert_eq!(found.map(|figure| figure.to_string()).as_slice(), figures, "{certify:?} {options}");
        }
    };
    let of_legs = rows("| `-O2");
    assert_eq!(of_legs.len(), 3);
    for row in of_legs {
        is_right(&certify, row[0].trim_start_matches("-O2").trim(), &row[1..]);
    }
    let is_of_arm = |row: &Vec<&str>| row.get(1).is_some_and(|name| ["panda", "puma560"].contains(name));
    let of_arms: Vec<_> = rows("| ").into_iter().filter(is_of_arm).collect();
    assert_eq!(of_arms.len(), 6);
    for row in of_arms {
        is_right(&["certify", row[1], "--json"], row[0].trim_start_matches("none"), &row[2..]);
    }
    fails(1, &[&certify[..], &["--cc-options=-fno-such-option"]].concat(), &["-fno-such-option"]);
    // what would write another file, and a function that the certificate of Rust does not call
    fails(2, &[&certify[..], &["--cc-options=-O3 -o arm.o"]].concat(), &["options that choose the code", "`-o`"]);
    fails(2, &[&certify[..], &["--lang", "rust"]].concat(), &["arrays of the joints alone", "--lang c"]);
}

/// The code of the certificate is a file that anybody can write: by its command, and of a robot file on standard input.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn the_code_of_a_certificate_is_what_its_command_writes() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_emit");
    let other = ["--function", "gravity_torques", "--form", "seven_steps", "--prefix", "my"];
    let whole = ["--function", "bias_torques,inverse_dynamics", "--friction", "--limits", "--tests", "--ascii"];
    for (robot, more) in
        [(ROBOT, &[][..]), (ROBOT, &["--observer"]), (ROBOT, &other), ("docs/desk_arm_identified.yaml", &whole)]
    {
        let certify = [&["certify", robot, "--states", "5", "--json"], more].concat();
        let json: serde_json::Value = serde_json::from_str(&fine(&certify)).expect("JSON");
        let command = json["emit"].as_str().expect("a command");
        let (command, name) = command.rsplit_once(" -o ").expect("a file");
        let source = folder.join(name);
        let words = command.strip_prefix("rne emit ").expect("rne emit");
        let words = words.split_once(' ').expect("a file").1;
        let words = ["emit", robot].into_iter().chain(words.split(' '));
        let words = words.chain(["-o", source.to_str().expect("UTF-8"), "--force"]).collect::<Vec<_>>();
        assert_eq!(rne(&words).status, 0, "{words:?}");
        let text = fs::read(&source).expect("it was written");
        assert_eq!(json["hashes"][name], rne_certify::sha256(&text), "{more:?}");
    }
    let yaml = fs::read_to_string(Path::new(ROOT).join(ROBOT)).expect("an arm");
    let called = rne_reading(&["certify", "-", "--states", "5"], &yaml);
    assert_eq!(called.status, 0, "{called:?}");
    assert!(called.out.contains("| robot file | `"), "{}", called.out);
}

/// Functions in both languages: the trace names each number of the result, and the options that do not fit are refused.
#[test]
fn both_languages_and_other_functions_have_a_trace() {
    fails(2, &["certify", ROBOT, "--check", "x.md", "--evidence", "x"], &["cannot be used with"]);
    let has_rust = Command::new("rustup").args(["target", "list", "--installed"]).output();
    let has_rust = has_rust.is_ok_and(|out| String::from_utf8_lossy(&out.stdout).contains("thumbv7em-none-eabihf"));
    if !tries_all() {
        return;
    }
    for lang in ["c", "rust"].into_iter().filter(|lang| *lang == "c" || has_rust) {
        for function in ["inverse_dynamics", "forward_dynamics"] {
            let certify = ["certify", ROBOT, "--states", "20", "--lang", lang, "--function", function];
            let page = fine(&certify);
            let json: serde_json::Value =
                serde_json::from_str(&fine(&[&certify[..], &["--json"]].concat())).expect("JSON");
            let trace = json["trace"].as_array().expect("a trace");
            assert!(trace.len() > 40, "{lang} {function}: {trace:?}");
            let is_of_joint =
                |line: &serde_json::Value| line["step"].as_str().is_some_and(|step| step.starts_with("joint 3, "));
            assert!(trace.iter().any(is_of_joint), "{lang} {function}: {trace:?}");
            // a long expression begins on the line after its name
            assert!(trace.iter().all(|line| line["name"] != "="), "{lang} {function}: {trace:?}");
            assert_eq!(page.contains("the rules are for C"), lang == "rust", "{page}");
            assert!(!page.contains("cppcheck is not installed"), "{page}");
        }
    }
}

/// Arms that the repository does not ship.
const ARMS: [&str; 3] = ["palletizer", "wrist", "lift"];

/// How many of these arms are tried: with `RNE_EXHAUSTIVE` set, all.
fn tried() -> usize {
    if shipped::is_exhaustive() { ARMS.len() } else { 1 }
}

/// The listing, QEMU and the interpreter agree on each number of an update; the bound is that of roundings of the
/// momentum, times the rate of the updates.
#[test]
fn the_observer_of_each_arm_has_a_certificate() {
    if !tries_all() {
        return;
    }
    for (arm, joints, turning) in
        ARMS.into_iter().zip([4, 6, 4]).zip([4, 6, 3]).map(|((a, n), t)| (a, n, t)).take(tried())
    {
        let file = format!("cli/tests/cli/arms/{arm}.yaml");
        for cpu in ["cortex-m4", "cortex-m7"] {
            let certify = ["certify", &file, "--function", "momentum_and_rate", "--observer"];
            let certify = [&certify[..], &["--states", "200", "--cpu", cpu]].concat();
            let json: serde_json::Value =
                serde_json::from_str(&fine(&[&certify[..], &["--json"]].concat())).expect("JSON");
            assert_eq!(json["function"], "observer_update", "{arm}");
            let cost = &json["cost"];
            assert_eq!(json["emulation"]["instructions"], cost["instructions"], "{arm}, {cpu}");
            assert_eq!(json["emulation"]["states"], 32);
            assert_eq!(cost["stack"], cost["stack_of_listing"], "{arm}, {cpu}");
            assert_eq!(cost["calls"][format!("{arm}_momentum_and_rate")], 1, "{arm}: {}", cost["calls"]);
            let sines = cost["calls"][format!("{arm}_sin_cos")].as_u64().expect("sines");
            assert!(sines > 0 && sines <= turning, "{arm}: {sines}");
            let kinds = cost["classes"].as_array().expect("kinds").iter();
            let sum: u64 = kinds.map(|kind| kind["instructions"].as_u64().expect("a number")).sum();
            assert_eq!(Some(sum), cost["instructions"].as_u64(), "{arm}: each instruction is of one kind");
            // more than momentum and rate alone
            let function = ["certify", &file, "--function", "gravity_torques", "--states", "5", "--cpu", cpu, "--json"];
            let function: serde_json::Value = serde_json::from_str(&fine(&function)).expect("JSON");
            assert!(cost["instructions"].as_u64() > function["cost"]["instructions"].as_u64());
            let results = json["accuracy"]["results"].as_array().expect("results");
            assert_eq!(results.len(), joints, "{arm}");
            for result in results {
                let [largest, bound] = ["largest", "bound"].map(|key| result[key].as_f64().expect("a number"));
                assert!(largest > 0.1 && bound > 1e-8 && bound < 1e-2 * largest, "{arm}: {result}");
            }
            let traced = json["trace"].as_array().expect("lines").iter();
            let last = traced.filter(|line| line["name"] == format!("external[{}]", joints - 1)).count();
            assert_eq!(last, 1, "{arm}: the last number is traced once");
        }
        // twice the gain lets more errors through
        let bound = |gain: &str| {
            let certify = ["certify", &file, "--function", "momentum_and_rate", "--observer", "--gain", gain];
            let certify = [&certify[..], &["--states", "200", "--json"]].concat();
            let json: serde_json::Value = serde_json::from_str(&fine(&certify)).expect("JSON");
            json["accuracy"]["results"][0]["bound"].as_f64().expect("a number")
        };
        assert!(bound("200") > bound("20"), "{arm}");
    }
}

#[test]
fn options_of_the_observer_are_checked() {
    fails(2, &["certify", ROBOT, "--observer", "--lang", "rust"], &["--observer", "rne::ObserverState"]);
    let alone = ["certify", ROBOT, "--function", "momentum_and_rate", "--observer", "--evidence", "e"];
    fails(2, &alone, &["--evidence", "inverse_dynamics", "--function"]);
    fails(2, &["certify", ROBOT, "--observer", "--gain", "0"], &["--gain is 0", "1e-6"]);
    fails(2, &["certify", ROBOT, "--observer", "--period", "-1"], &["--period"]);
    fails(2, &["certify", ROBOT, "--gain", "20"], &["--observer"]);
}

/// Whether the checker accepts a source with a trace of a robot file, and what it says.
pub(crate) fn checked(source: &Path, trace: &Path, robot: &Path) -> (bool, String) {
    run_checker(&[source, trace, robot])
}

/// Whether the checker accepts what its arguments name, and what it says.
pub(crate) fn run_checker(arguments: &[&Path]) -> (bool, String) {
    let checker = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/certify/checker/check_c.py");
    let output = Command::new("python3").arg(checker).args(arguments).output().expect("python3 starts");
    (output.status.code() == Some(0), String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The places where one part of a source can be changed to another of its kind, with the change: (start, end, new
/// text).
fn mutations(source: &str, kind: usize) -> Vec<(usize, usize, String)> {
    let start = source.find("_inverse_dynamics(").expect("the function");
    let mut found = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    let mut at = start;
    for line in source[start..].split_inclusive('\n') {
        let (begin, code) = (at, line.trim_end());
        at += line.len();
        let Some(equals) = code.find(" = ").filter(|_| !code.trim_start().starts_with("//")) else { continue };
        let right = begin + equals + 3;
        let words = &code[equals + 3..];
        let constant = words.trim_end_matches([';', 'f']).parse::<f32>().ok();
        match kind {
            // an operator
            0 => {
                for (operator, other) in [(" + ", " - "), (" - ", " + "), (" * ", " + ")] {
                    found.extend(
                        words.match_indices(operator).map(|(i, _)| (right + i, right + i + 3, other.to_owned())),
                    );
                }
            }
            // an operand
            1 => {
                for (index, name) in names.iter().enumerate() {
                    let is_whole = |i: usize| {
                        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
                        !words[..i].ends_with(is_part) && !words[i + name.len()..].starts_with(is_part)
                    };
                    let other = names[(index + names.len() / 2) % names.len()];
                    let places = words.match_indices(name).filter(|(i, _)| is_whole(*i) && other != *name);
                    found.extend(places.map(|(i, _)| (right + i, right + i + name.len(), other.to_owned())));
                }
            }
            // a sign
            2 if constant.is_none() && !words.starts_with('-') => found.push((right, right, "-".to_owned())),
            // an index
            3 => found.extend(code.find("[0]").map(|i| (begin + i, begin + i + 3, "[1]".to_owned()))),
            // a literal, by one unit in the last place
            _ => {
                let literal = constant.filter(|_| kind == 4);
                found.extend(literal.map(|x| (right, right + words.len(), format!("{:e}f;", x.next_up()))));
            }
        }
        let name = code[..equals].split_whitespace().last().expect("a name");
        if !name.contains('[') && constant.is_none() {
            names.push(name);
        }
    }
    found
}

#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn the_checker_accepts_emitted_code_and_refuses_thirty_mutations_of_thirty() {
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !has_tools() {
        println!("not checked: there is no python3, or a tool of rne certify is missing");
        return;
    }
    let mut refused = 0;
    for arm in ARMS.into_iter().take(tried()) {
        let folder = folder(&format!("checker_{arm}"));
        let file = format!("cli/tests/cli/arms/{arm}.yaml");
        let evidence = folder.to_str().expect("UTF-8");
        fine(&["certify", &file, "--states", "10", "--evidence", evidence]);
        let (source, trace) = (folder.join(format!("{arm}.c")), folder.join(format!("{arm}.trace.json")));
        let robot = Path::new(ROOT).join(&file);
        let (is_accepted, said) = checked(&source, &trace, &robot);
        assert!(is_accepted, "{arm}: {said}");
        let text = fs::read_to_string(&source).expect("it was written");
        let mutant = folder.join("mutant.c");
        for kind in 0..5 {
            let places = mutations(&text, kind);
            assert!(places.len() > 1, "{arm}: no mutations of kind {kind}");
            for pick in [1, 2] {
                let (start, end, new) = &places[places.len() * pick / 3];
                fs::write(&mutant, format!("{}{new}{}", &text[..*start], &text[*end..])).expect("written");
                let (is_accepted, said) = checked(&mutant, &trace, &robot);
                let line = text[..*start].lines().last().unwrap_or_default();
                assert!(!is_accepted, "{arm}, kind {kind}: `{line}` with `{new}` is accepted: {said}");
                assert!(said.contains("\nwrong: "), "{arm}, kind {kind}: {said}");
                refused += 1;
            }
        }
    }
    println!("the checker refuses {refused} of {} mutations", 10 * tried());
    assert_eq!(refused, 10 * tried());
}

#[test]
fn the_checker_refuses_another_sine_and_more_code() {
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !tries_all() {
        return;
    }
    let folder = folder("checker_sine");
    fine(&["certify", ROBOT, "--states", "10", "--evidence", folder.to_str().expect("UTF-8")]);
    let (source, trace) = (folder.join("desk_arm.c"), folder.join("desk_arm.trace.json"));
    let text = fs::read_to_string(&source).expect("it was written");
    for (old, new) in [("4.825592e-4f", "4.825593e-4f"), ("tau[2] = tau3;", ""), ("\n}\n", "\n}\nint more;\n")] {
        let mutant = folder.join("mutant.c");
        fs::write(&mutant, text.replace(old, new)).expect("written");
        let (is_accepted, said) = checked(&mutant, &trace, &Path::new(ROOT).join(ROBOT));
        assert!(!is_accepted && said.contains("\nwrong: "), "{old}: {said}");
    }
}

/// The checker reads the robot file itself: a table that is not that of the file is refused, however the code agrees
/// with it.
#[test]
fn the_checker_compares_the_table_of_the_trace_with_the_robot_file() {
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !tries_all() {
        return;
    }
    let other: [&[(&str, &str)]; 3] = [
        &[
            ("mm(330)", "mm(330.001)"),
            ("mass: 7.1", "mass: 7.1000001"),
            ("convention: standard", "convention: modified"),
            ("alpha: pi/2", "alpha: -pi/2"),
            ("xz: 0.004", "yz: 0.004"),
            ("-9.81]", "9.81]"),
            ("com: [-0.17, 0, 0.02]", "com: [-0.17, 0.02, 0]"),
            ("g(830)", "mm(831)"),
            ("source:", "sauce:"),
            ("g(4250)", "grams"),
            ("mass: 12.4,", "mass: 12.4, mass: 12.4,"),
            ("yz: -0.003", "yz: 1_0"),
        ],
        &[
            ("deg(-72)", "deg(-72.0001)"),
            ("a: 0.24", "a: 0.2400001"),
            ("zz: 0.00009", "zz: 0.00008"),
            ("theta: 0.1,", "theta: 0.1 + pi,"),
        ],
        &[
            ("type: prismatic", "type: revolute"),
            ("inertia_about: com", "inertia_about: origin"),
            ("d: 0.15", "d: 1.5e-1 + 1e-9"),
            ("  - {type: revolute, dh: {theta: deg(30)", "  - &a {type: revolute, dh: {theta: deg(30)"),
        ],
    ];
    let same: [&[(&str, &str)]; 3] = [
        &[
            ("alpha: pi/2", "alpha: deg(90) # a {comment\n   "),
            ("mass: 7.1", "mass: (1 + 2^2*10*sqrt(3 + 1)/8 + 60)/10"),
            ("gravity: [0, 0, -9.81]", "gravity:\n  - 0\n  - 0\n  - -9.81"),
            ("format: 1\n", "---\nformat: 1\nnotes: |\n  words: {of\n\n  a text\nparameters: {r: 0.21, m: r^2/r}\n"),
            ("xx: 0.21", "xx: m"),
            ("name: palletizer", "name: palletizer\ntitle: 'an arm: # 3'"),
        ],
        &[("alpha: -pi/2", "alpha: 3*pi/2"), ("deg(-90)", "-2*pi/4")],
        &[("inertia_about: com", "inertia_about: com, physical: true"), ("0.35", "mm(350)")],
    ];
    for ((arm, other), same) in ARMS.into_iter().zip(other).zip(same).take(tried()) {
        let folder = folder(&format!("checker_table_{arm}"));
        let file = format!("cli/tests/cli/arms/{arm}.yaml");
        fine(&["certify", &file, "--states", "5", "--evidence", folder.to_str().expect("UTF-8")]);
        let (source, trace) = (folder.join(format!("{arm}.c")), folder.join(format!("{arm}.trace.json")));
        let text = fs::read_to_string(Path::new(ROOT).join(&file)).expect("an arm");
        let robot = folder.join("changed.yaml");
        for (changes, is_same) in [(other, false), (same, true)] {
            for (old, new) in changes {
                assert!(text.contains(old), "{arm}: {old}");
                // a value may need a parameter of another change
                let old_text = if *new == "xx: m" { text.replace(same[3].0, same[3].1) } else { text.clone() };
                fs::write(&robot, old_text.replacen(old, new, 1)).expect("written");
                let (is_accepted, said) = checked(&source, &trace, &robot);
                assert_eq!(is_accepted, is_same, "{arm}, {new}: {said}");
                assert!(is_same || said.starts_with("wrong: "), "{arm}, {new}: {said}");
            }
        }
    }
}

/// Double precision, and the other functions that the checker computes.
#[test]
fn the_checker_takes_double_and_other_functions() {
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !tries_all() {
        return;
    }
    let folder = folder("checker_functions");
    let evidence = folder.to_str().expect("UTF-8");
    for function in ["inverse_dynamics", "bias_torques", "gravity_torques"] {
        let robot = "cli/tests/cli/arms/wrist.yaml";
        let certify = ["certify", robot, "--states", "5", "--real", "double", "--function", function];
        fine(&[&certify[..], &["--evidence", evidence]].concat());
        let (source, trace) = (folder.join("wrist.c"), folder.join("wrist.trace.json"));
        let text = fs::read_to_string(&source).expect("it was written");
        assert!(text.contains("double tau[6]") && !text.contains("float tau"), "{text}");
        let robot = Path::new(ROOT).join(robot);
        let (is_accepted, said) = checked(&source, &trace, &robot);
        assert!(is_accepted && said.contains(&format!("wrist_{function}: 6 torques")), "{said}");
        // the sign of the last torque
        let mutant = folder.join("mutant.c");
        fs::write(&mutant, text.replace("tau[5] = ", "tau[5] = -")).expect("written");
        let (is_accepted, said) = checked(&mutant, &trace, &robot);
        assert!(!is_accepted && said.contains("torque 6 is another function"), "{said}");
    }
    fails(2, &["certify", ROBOT, "--real", "double"], &["--evidence"]);
    let other = ["certify", ROBOT, "--function", "forward_dynamics", "--evidence", evidence];
    fails(2, &other, &["inverse_dynamics, bias_torques, gravity_torques"]);
}
