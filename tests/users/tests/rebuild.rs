//! A change of the robot file reaches the program with the next build.

mod build;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

const PROGRAM: &str = r#"
use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../robots/slide.yaml", tests)]
struct Slide;

fn main() {
    let [force] = Slide.gravity_torques(&[0.0_f64]);
    println!("{force}");
}
"#;

const ROBOT: &str = "
format: 1
name: slide
source: own numbers
convention: standard
gravity: [0, 0, -10]
joints:
  - type: prismatic
    dh: {theta: 0, d: 0, a: 0, alpha: 0}
    link: {mass: <mass>}
";

/// A program of a user, outside this workspace.
struct Program {
    folder: PathBuf,
}

impl Program {
    fn new() -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rebuild");
        // of a run that failed
        let _ = fs::remove_file(folder.join("robots/slide.golden.csv"));
        fs::create_dir_all(folder.join("src")).expect("a folder for sources");
        fs::create_dir_all(folder.join("robots")).expect("a folder for robots");
        fs::write(folder.join("Cargo.toml"), build::manifest("rebuild")).expect("the manifest");
        fs::write(folder.join("src/main.rs"), PROGRAM).expect("the program");
        Self { folder }
    }

    fn write_robot(&self, mass: &str) {
        fs::write(self.folder.join("robots/slide.yaml"), ROBOT.replace("<mass>", mass)).expect("the robot file");
    }

    fn run(&self) -> Output {
        build::cargo("run", &self.folder).arg("--quiet").output().expect("cargo runs")
    }

    fn printed(&self) -> String {
        let output = self.run();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }
}

#[test]
fn a_changed_robot_file_is_compiled_again() {
    let program = Program::new();
    program.write_robot("2.5");
    assert_eq!(program.printed(), "25");
    program.write_robot("4");
    assert_eq!(program.printed(), "40");

    // As a user sees it, with the place in the file that an editor can jump to.
    program.write_robot("-4");
    let output = program.run();
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(messages.contains("--> robots/slide.yaml:10:18"), "{messages}");
    assert!(messages.contains("--> src/main.rs:5:16"), "{messages}");
    assert!(!messages.contains("warning"), "{messages}");

    program.write_robot("0.5");
    assert_eq!(program.printed(), "5");

    // and so is the golden file beside it, whether its tests run or not
    let golden = program.folder.join("robots/slide.golden.csv");
    let header = "q1,qd1,qdd1,tau1\n";
    fs::write(&golden, format!("{header}0, 0, 2, 6\n")).expect("the golden file");
    program.write_robot("0.50");
    assert_eq!(program.printed(), "5");
    fs::write(&golden, format!("{header}0, 0, 2, six\n")).expect("the golden file");
    let output = program.run();
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(messages.contains("--> robots/slide.golden.csv:2:10"), "{messages}");
    fs::write(&golden, format!("{header}0, 0, 2, 6.0\n")).expect("the golden file");
    assert_eq!(program.printed(), "5");
    fs::remove_file(&golden).expect("it was there");
}

#[test]
fn the_code_for_reading_stands_beside_what_the_compiler_writes() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("inspect");
    fs::create_dir_all(folder.join("src")).expect("a folder for sources");
    fs::write(folder.join("Cargo.toml"), build::manifest("inspect")).expect("the manifest");
    let program = "#[derive(rne::InverseDynamics)]\n#[robot(builtin = \"planar2\", inspect)]\nstruct Arm;\n\n\
                   fn main() {\n    let _ = rne::InverseDynamics::gravity_torques(&Arm, &[0.0_f64; 2]);\n}\n";
    fs::write(folder.join("src/main.rs"), program).expect("the program");
    let file = build::target().join("debug/rne/planar2.InverseDynamics.seven_steps.rs");
    // of a run before, which the compiler would not repeat
    let _ = fs::remove_file(&file);
    let touched = fs::read_to_string(folder.join("src/main.rs")).expect("the program") + "// anew\n";
    fs::write(folder.join("src/main.rs"), touched).expect("the program");
    let output = build::cargo("build", &folder).arg("--quiet").output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(&file).expect("the file is there");
    for part in ["// joint 2, step 1: angular velocity", "let w2_z = qd1 + qd2;", "ω: angular velocity", "rne explain"]
    {
        assert!(text.contains(part), "no `{part}` in {text}");
    }
}
