//! What the user sees: each likely mistake as the compiler reports it, and what has to compile without a word.
//!
//! The messages in `ui/*.stderr` are the derive's own, in the frame that rustc puts around them; `TRYBUILD=overwrite
//! cargo test --test ui` writes them again. Messages whose words are rustc's (`ui/rustc`) change with its versions: of
//! those, the code, the place and the names are looked for.

mod build;

use std::fs;
use std::path::Path;

#[test]
fn mistakes_and_their_messages() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/ui/*.rs");
    cases.pass("tests/ui/pass/*.rs");
}

/// File, and what the one message has in it.
const BY_RUSTC: [(&str, &[&str]); 11] = [
    ("array_length", &["error[E0308]", "array_length.rs:8:49", "size of 2", "size of 3"]),
    (
        "batch_alone",
        &[
            "error[E0277]",
            "batch_alone.rs:6:8",
            "`Rod: InverseDynamics<1>`",
            "derive(InverseDynamics, BatchInverseDynamics)",
        ],
    ),
    (
        "batch_of_another_function",
        &[
            "error[E0277]",
            "batch_of_another_function.rs:6:8",
            "`Rod: MassMatrix<1>`",
            "derive(MassMatrix, BatchMassMatrix)",
        ],
    ),
    ("crate_is_elsewhere", &["error[E0433]", "crate_is_elsewhere.rs:4:48", "`dynamics`"]),
    (
        "field_of_text",
        &["error[E0277]", "field_of_text.rs:6:5", "`String` cannot be a run-time parameter", "`#[robot(skip)]`"],
    ),
    (
        "frame_unknown",
        &[
            "error[E0080]",
            "`join1` is not a frame of the robot two: ",
            "each joint names its link frame: `joint1`, `joint2`; did you mean `joint1`?",
            "frame_unknown.rs:9:",
        ],
    ),
    (
        "joint_missing",
        &[
            "error[E0080]",
            "`joint1` is a joint of the robot, but is not in the list; the joints of two are `joint1`, `joint2`",
            "joint_missing.rs:7:27",
        ],
    ),
    ("joint_twice", &["error[E0080]", "`joint1` is in the list twice; the joints of two are", "joint_twice.rs:7:27"]),
    (
        "joint_unknown",
        &[
            "error[E0080]",
            "`elbow` in the list is not a joint of the robot; the joints of two are",
            "joint_unknown.rs:7:27",
        ],
    ),
    (
        "rows_of_arrays",
        &["error[E0277]", "rows_of_arrays.rs:10:9", "`[f64; 7]` is not a number of a state", "`.q(&states)`"],
    ),
    ("without_the_trait", &["error[E0599]", "without_the_trait.rs:6:29", "`inverse_dynamics`", "InverseDynamics"]),
];

#[test]
fn mistakes_that_rustc_finds_by_itself() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("by_rustc");
    fs::create_dir_all(folder.join("src/bin")).expect("a folder for sources");
    fs::create_dir_all(folder.join("src/robots")).expect("a folder for robots");
    let manifest = format!(
        "[package]\nname = \"by_rustc\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         rne = {{ path = '{}', default-features = false }}\n\n[workspace]\n",
        build::root().display()
    );
    fs::write(folder.join("Cargo.toml"), manifest).expect("the manifest");
    for robot in ["rod.yaml", "two.yaml"] {
        let source = package.join("tests/ui/robots").join(robot);
        fs::copy(source, folder.join("src/robots").join(robot)).expect("a robot file");
    }
    for name in BY_RUSTC.map(|(name, _)| name).into_iter().chain(["tests_without_the_runtime"]) {
        let source = package.join(format!("tests/ui/rustc/{name}.rs"));
        fs::copy(source, folder.join(format!("src/bin/{name}.rs"))).expect("a program");
    }
    for (name, parts) in BY_RUSTC {
        // not `check`: what the others have built serves
        let mut build = build::cargo("build", &folder);
        build.args(["--quiet", "--bin", name]);
        if name == "rows_of_arrays" {
            build.args(["--features", "rne/compiled"]);
        }
        let output = build.output().expect("cargo runs");
        let messages = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success(), "{name} compiles");
        for part in parts {
            assert!(messages.contains(part), "{name}: no `{part}` in {messages}");
        }
        assert_eq!(messages.matches("error[").count(), 1, "{name}: {messages}");
    }
    // The library compiles without the runtime; its own tests say what they need.
    let run = |command: &str, arguments: &[&str]| {
        let mut cargo = build::cargo(command, &folder);
        cargo.args(["--quiet", "--bin", "tests_without_the_runtime"]).args(arguments).output().expect("cargo runs")
    };
    let library = run("build", &[]);
    assert!(library.status.success(), "{}", String::from_utf8_lossy(&library.stderr));
    let tests = run("test", &["--no-run"]);
    let messages = String::from_utf8_lossy(&tests.stderr);
    assert!(messages.contains("needs the features `arm` and `std`"), "{messages}");
    assert_eq!(messages.matches("error: ").count(), 2, "the message, and that it could not compile: {messages}");
}
