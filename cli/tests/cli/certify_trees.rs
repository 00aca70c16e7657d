//! `rne certify` of robots with branches, of functions with a payload and wrenches, and what it says about tools.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::call::{ROOT, called, command, fails, fine, folder, rne};
use crate::certify::{checked, has_tools};

/// Robots that are no serial arms: of the documents, and shipped ones.
const TREES: [&str; 10] = [
    "docs/tree.yaml",
    "docs/gripper.yaml",
    "docs/dual_arm.yaml",
    "docs/palletiser.yaml",
    "baxter",
    "dex3_left",
    "hyq",
    "mini_cheetah",
    "panda_hand",
    "wam7_coupled",
];

/// The list is that of the folder: a robot that is added there is certified, too.
#[test]
fn all_shipped_trees_are_tried() {
    for entry in fs::read_dir(Path::new(ROOT).join("robots/trees")).expect("a folder") {
        let name = entry.expect("a file").file_name().into_string().expect("UTF-8");
        let name = name.trim_end_matches(".yaml").trim_end_matches(".plan");
        assert!(TREES.contains(&name), "{name}");
    }
}

/// Each rule that cppcheck reports for the code and the header of a tree has a recorded deviation.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn trees_violate_no_rule_of_misra_without_a_deviation() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_misra");
    for tree in TREES {
        let functions = "inverse_dynamics,inverse_dynamics_with_wrenches";
        let source = folder.join("code.c");
        let emit = ["emit", tree, "--lang", "c", "--function", functions, "-o", source.to_str().expect("UTF-8")];
        assert_eq!(rne(&emit).status, 0, "{tree}");
        let options = ["--addon=misra", "--std=c99", "--enable=style", "--quiet", "--template={file}:{line}: {id}"];
        let output = Command::new("cppcheck").args(options).arg(&source).output().expect("it starts");
        let found = rne_certify::misra::violations(&String::from_utf8_lossy(&output.stderr));
        assert!(found.contains_key("19.2") || tree == "wam7_coupled", "{tree}: {found:?}");
        for (rule, places) in found {
            assert!(rne_certify::misra::deviation(&rule).is_some(), "{tree}: rule {rule} at {places:?}");
        }
    }
}

/// The command of a certificate writes the same header: with names for a tree, and on request for an arm.
#[test]
fn names_are_part_of_a_certificate() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_names");
    for (robot, more) in [("docs/tree.yaml", &[][..]), ("docs/desk_arm.yaml", &["--names"])] {
        let certify = [&["certify", robot, "--states", "5", "--require", "qemu,cppcheck", "--json"], more].concat();
        let json: Value = serde_json::from_str(&fine(&certify)).expect("JSON");
        assert_eq!(json["misra"]["2.4"], 1, "{robot}: the enumeration of the joints\n{}", json["misra"]);
        let emit = json["emit"].as_str().expect("a command");
        assert_eq!(emit.contains("--names"), more.contains(&"--names"), "{emit}");
        let source = folder.join("code.c");
        let emit = ["emit", robot, "--lang", "c", "--function", "inverse_dynamics"];
        let emit = [&emit[..], more, &["-o", source.to_str().expect("UTF-8")]].concat();
        assert_eq!(rne(&emit).status, 0, "{emit:?}");
        let header = fs::read(source.with_extension("h")).expect("a header");
        let stem = Path::new(robot).file_stem().expect("a name").to_str().expect("UTF-8");
        assert_eq!(json["hashes"][format!("{stem}.h")], rne_certify::sha256(&header), "{robot}");
    }
    fails(2, &["certify", "docs/desk_arm.yaml", "--names", "--lang", "rust"], &["--names", "is for --lang c"]);
}

/// QEMU, the listing and the interpreter agree on functions with a payload, a wrench, and a wrench at each tip.
#[test]
fn functions_with_a_payload_and_wrenches_are_certified() {
    if !has_tools() {
        return;
    }
    let functions = "inverse_dynamics_with_payload,inverse_dynamics_with_wrench,inverse_dynamics_with_wrenches";
    let json = fine(&["certify", "docs/dual_arm.yaml", "--states", "5", "--function", functions, "--json"]);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let more = json["more"].as_array().expect("functions");
    assert_eq!(more.len(), 2);
    for certified in more.iter().chain([&json]) {
        assert_eq!(certified["emulation"]["states"], 32, "{}", certified["function"]);
        let how = certified["accuracy"]["how"].as_str().expect("words");
        assert!(how.contains("At each state"), "{how}");
    }
}

/// Results of every shape: a number, a matrix, a struct, and the state after a step, whose duration is a number, too.
#[test]
fn results_of_every_shape_are_certified() {
    if !has_tools() {
        return;
    }
    let functions = "kinetic_energy,mass_matrix,momentum_and_rate,euler_step,regressor";
    let json = fine(&["certify", "docs/dual_arm.yaml", "--states", "5", "--function", functions, "--json"]);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let units = json["more"].as_array().expect("functions").iter().chain([&json]).map(|certified| {
        assert_eq!(certified["emulation"]["states"], 32, "{}", certified["function"]);
        let results = certified["accuracy"]["results"].as_array().expect("results");
        let unit = results[0]["unit"].as_str().expect("a unit").to_owned();
        (certified["function"].as_str().expect("a name").to_owned(), unit)
    });
    let units: std::collections::BTreeMap<String, String> = units.collect();
    assert_eq!(units["mass_matrix"], "SI");
    assert_eq!(units["euler_step"], "rad");
    assert_eq!(units.len(), 5);
}

/// What a controller calls: the functions that `rne emit` writes by default, among them one that takes sines and
/// cosines; and the torques of a robot that walks, whose results are a struct in C.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn functions_of_a_controller_are_certified() {
    if !has_tools() {
        return;
    }
    let json = |robot: &str, functions: &str| -> Value {
        let certify = ["certify", robot, "--states", "5", "--function", functions, "--json"];
        serde_json::from_str(&fine(&certify)).expect("JSON")
    };
    // a sliding joint, whose sine and cosine are not used
    let found = json("scara_cobra600", "inverse_dynamics,inverse_dynamics_from_sin_cos");
    assert_eq!(found["more"][0]["emulation"]["states"], 32, "{found}");
    let instructions = |found: &Value| found["cost"]["instructions"].as_u64().expect("a number");
    assert!(instructions(&found["more"][0]) < instructions(&found), "no sine is computed: {found}");
    let units: Vec<&Value> =
        found["accuracy"]["results"].as_array().expect("results").iter().map(|of| &of["unit"]).collect();
    assert_eq!(units, ["N m", "N m", "N", "N m"]);

    let found = json("tests/functions/floating/grid_hyq.yaml", "inverse_dynamics_of_floating_base");
    assert_eq!(found["emulation"]["states"], 32);
    let results = found["accuracy"]["results"].as_array().expect("results");
    let about = |at: usize| ["joint", "unit"].map(|key| results[at][key].as_str());
    assert_eq!(results.len(), 6 + 12);
    assert_eq!([about(0), about(3)], [[None, Some("N")], [None, Some("N m")]]);
    assert_eq!(about(6), [Some("lf_haa_joint"), Some("N m")]);
    // the robot weighs some 85 kg
    assert!(results[2]["largest"].as_f64().is_some_and(|force| (500.0..2000.0).contains(&force)), "{results:?}");
    let how = found["accuracy"]["how"].as_str().expect("words");
    assert!(how.contains("At each state the base has the angular velocity 0.5, -0.3, 0.7 (rad/s)"), "{how}");
}

/// The figures of robots/README.md are those of the compiler that is named there.
#[test]
fn the_figures_of_trees_are_those_of_their_certificates() {
    if !has_tools() {
        return;
    }
    let document = fs::read_to_string(Path::new(ROOT).join("robots/README.md")).expect("it is there");
    for robot in ["hyq", "panda_hand"] {
        let certify = ["certify", robot, "--cpu", "cortex-m4", "--states", "1", "--json"];
        let json: Value = serde_json::from_str(&fine(&certify)).expect("JSON");
        let version = json["tools"]["arm-none-eabi-gcc"].as_str().expect("a version");
        if !document.contains(version) {
            println!("not compared: robots/README.md has the figures of another compiler than {version}");
            continue;
        }
        let cost = &json["cost"];
        let [instructions, cycles, code, constants, stack] =
            ["instructions", "cycles", "code", "constants", "stack"].map(|key| cost[key].as_u64().expect("a number"));
        let row = format!("| {robot} | {instructions} | {cycles} | {} | {stack} |", code + constants);
        assert!(document.contains(&row), "robots/README.md has no line\n{row}");
    }
}

/// `rne` where no tool is installed but those of Arm.
fn with_arm_alone(name: &str, arguments: &[&str]) -> Option<crate::call::Called> {
    let folder = folder(name);
    for tool in ["arm-none-eabi-gcc", "arm-none-eabi-objdump"] {
        let paths = std::env::var_os("PATH")?;
        let tool_path = std::env::split_paths(&paths).map(|folder| folder.join(tool)).find(|path| path.is_file())?;
        #[cfg(unix)]
        std::os::unix::fs::symlink(fs::canonicalize(tool_path).ok()?, folder.join(tool)).ok()?;
    }
    Some(called(command(arguments).env("PATH", &folder).output().expect("rne starts")))
}

/// A tool that is not installed is named on the terminal, and is an error where it is required.
#[cfg(unix)]
#[test]
fn missing_tools_are_told() {
    if !has_tools() {
        return;
    }
    let certify = ["certify", "planar1", "--states", "5"];
    let found = with_arm_alone("certify_without", &certify).expect("the tools of Arm");
    assert_eq!(found.status, 0, "{found:?}");
    for part in ["note: qemu-system-arm is not installed", "note: cppcheck is not installed", "apt-get install"] {
        assert!(found.said().contains(part), "{found:?}");
    }
    for tool in ["qemu", "cppcheck"] {
        let certify = [&certify[..], &["--require", tool]].concat();
        let found = with_arm_alone(&format!("certify_require_{tool}"), &certify).expect("the tools of Arm");
        assert_eq!((found.status, found.out.as_str()), (1, ""), "{found:?}");
        assert!(found.said().contains(&format!("--require {tool} asks for it")), "{found:?}");
    }
}

/// A compiler for another processor, and a program that is no compiler.
#[cfg(target_os = "linux")]
#[test]
fn compilers_of_other_targets_are_refused() {
    if Command::new("gcc").arg("--version").output().is_ok() && !cfg!(target_arch = "arm") {
        fails(2, &["certify", "planar1", "--cc", "gcc"], &["gcc is no compiler for Arm: its target is", "--cc"]);
    }
    fails(2, &["certify", "planar1", "--cc", "/bin/true"], &["/bin/true is no compiler", "--cc"]);
}

/// A check with other options than those of the certificate begins with both commands.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn a_check_names_the_command_of_the_certificate() {
    if !has_tools() {
        return;
    }
    let file = folder("certify_other").join("arm.md");
    let file = file.to_str().expect("UTF-8");
    for format in [&[][..], &["--json"]] {
        let certify = [&["certify", "planar1", "--states", "5"], format].concat();
        assert_eq!(rne(&[&certify[..], &["-o", file, "--force"]].concat()).status, 0);
        let check = [&["certify", "planar1", "--states", "6"], format, &["--check", file]].concat();
        let said = rne(&check);
        assert_eq!(said.status, 1, "{said:?}");
        let first = said.err.lines().next().expect("a line");
        assert!(first.contains("was made by: rne certify planar1 ") && first.contains("--states 5 "), "{first}");
        assert!(said.err.lines().nth(1).is_some_and(|line| line.contains("--states 6 ")), "{said:?}");
    }
}

/// What the checker does not compute is not called wrong.
#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn the_checker_says_what_it_does_not_support() {
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !has_tools() {
        return;
    }
    let folder = folder("checker_supports");
    let path = folder.to_str().expect("UTF-8");
    for (robot, key) in [
        ("docs/gripper.yaml", "couplings"),
        ("wam7_coupled", "motors"),
        ("docs/dual_arm.yaml", "bodies"),
        ("tests/functions/floating/grid_hyq.yaml", "floating_base"),
    ] {
        let certified = rne(&["certify", robot, "--states", "5", "--evidence", path]);
        assert_eq!(certified.status, 0, "{certified:?}");
        let note = format!("note: check_c.py does not support robots with {key}");
        assert!(certified.err.contains(&note), "{certified:?}");
        let stem = Path::new(robot).file_stem().expect("a name").to_str().expect("UTF-8");
        let (source, trace) = (folder.join(format!("{stem}.c")), folder.join(format!("{stem}.trace.json")));
        let is_file = robot.contains('/');
        let shipped = format!("robots/trees/{robot}.yaml");
        let yaml = Path::new(ROOT).join(if is_file { robot } else { &shipped });
        let (is_accepted, said) = checked(&source, &trace, &yaml);
        assert!(!is_accepted && said.starts_with("not supported: ") && said.contains(key), "{said}");
    }
    // tips alone change no torque without wrenches
    let text = fs::read_to_string(Path::new(ROOT).join("docs/dual_arm.yaml")).expect("it is there");
    let robot = folder.join("tips.yaml");
    fs::write(&robot, text.split("bodies:").next().expect("a beginning")).expect("written");
    let certified = rne(&["certify", robot.to_str().expect("UTF-8"), "--states", "5", "--evidence", path]);
    assert!(certified.status == 0 && !certified.err.contains("check_c.py"), "{certified:?}");
    let (is_accepted, said) = checked(&folder.join("tips.c"), &folder.join("tips.trace.json"), &robot);
    assert!(is_accepted, "{said}");
}

/// A file that is no trace is named, without a traceback.
#[test]
fn the_checker_refuses_what_is_no_trace() {
    if Command::new("python3").arg("--version").output().is_err() {
        return;
    }
    let folder = folder("checker_no_trace");
    let (source, trace) = (folder.join("arm.c"), folder.join("e.json"));
    fs::write(&source, "int x;\n").expect("written");
    let table = r#""prefix": "a", "real": "float", "functions": [], "texts": {}"#;
    for (text, lacks) in [
        ("{}".to_owned(), "the file has no str 'prefix'"),
        ("[]".to_owned(), "the file is no mapping"),
        (format!("{{{table}, \"table\": {{}}}}"), "the table has no str 'convention'"),
        (
            format!("{{{table}, \"table\": {{\"convention\": \"standard\", \"gravity\": [], \"joints\": [{{}}]}}}}"),
            "a joint has no list 'com'",
        ),
    ] {
        fs::write(&trace, &text).expect("written");
        let checker = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/certify/checker/check_c.py");
        let robot = Path::new(ROOT).join("docs/desk_arm.yaml");
        let files = [Path::new(checker), &source, &trace, &robot];
        let output = Command::new("python3").args(files).output().expect("python3 starts");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!((output.status.code(), output.stderr.len()), (Some(2), 0), "{text}: {output:?}");
        assert!(said.contains("e.json is no trace") && said.contains(lacks), "{text}: {said}");
    }
}

/// The flags of docs/firmware/first-firmware.md give code without calls of a library, and `nm` shows the calls of other
/// flags.
#[test]
fn the_flags_of_the_page_give_code_without_a_library() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_flags");
    let (source, object) = (folder.join("my_arm.c"), folder.join("my_arm.o"));
    let emit = ["emit", "docs/gripper.yaml", "--lang", "c", "-o", source.to_str().expect("UTF-8")];
    assert_eq!(rne(&emit).status, 0);
    let undefined = |flags: &str| {
        let options = ["-std=c99", "-O2", "-ffp-contract=off", "-c", "-o"];
        let mut gcc = Command::new("arm-none-eabi-gcc");
        let status = gcc.args(flags.split(' ')).args(options).args([&object, &source]).status().expect("it starts");
        assert!(status.success(), "{flags}");
        let output = Command::new("arm-none-eabi-nm").arg("-u").arg(&object).output().expect("it starts");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let page = fs::read_to_string(Path::new(ROOT).join("docs/firmware/first-firmware.md")).expect("it is there");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| Cortex-M")?.split('`').nth(1));
    let rows: Vec<&str> = rows.filter(|flags| flags.contains("-mcpu=")).collect();
    assert_eq!(rows.len(), 2, "{rows:?}");
    for flags in rows {
        assert_eq!(undefined(flags), "", "{flags}");
    }
    for flags in ["-mcpu=cortex-m4 -mthumb -DRNE_SOFT_FLOAT", "-mcpu=cortex-m0 -mthumb -DRNE_SOFT_FLOAT"] {
        assert!(undefined(flags).contains("__aeabi_fmul"), "{flags}");
    }
}
