//! What the derives cost the user's build: one on a chain of 30 dense joints, all on an arm of 7 joints, each in a
//! crate of its own.
//!
//! `cargo test --test compile_time -- --nocapture` prints the figures. Times are for reading; what is asserted is
//! counted: operations written on the sheet, which the compiler works through, statements, which rustc works through,
//! and crates.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use rne::DynArm;
use rne_codegen::plan::PlanSet;
use rne_codegen::{Capability, Compiler, Form, Function, Program};
use rne_model::Robot;

const JOINTS: usize = 30;

/// A chain of so many joints in which no number is zero and no angle right.
fn chain(joints: usize) -> String {
    let mut text =
        String::from("format: 1\nname: chain\nsource: no arm\nconvention: standard\ngravity: [1, 2, -9]\njoints:\n");
    for joint in 1..=joints {
        let _ = writeln!(
            text,
            "  - type: revolute\n    dh: {{theta: 0.1, d: 0.2, a: 0.0{joint}, alpha: 0.3}}\n    \
             link: {{mass: 1.{joint}, com: [0.01, 0.02, 0.03], inertia: {{xx: 0.2, yy: 0.3, zz: 0.4, xy: 0.01, xz: \
             0.02, yz: 0.03}}}}"
        );
    }
    text
}

/// A user's crate with one robot file and one program.
fn user(name: &str, robot: &str, program: &str) -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(folder.join("src")).expect("a folder for sources");
    let manifest = format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         rne = {{ path = '{}', default-features = false }}\n\n[workspace]\n",
        package.display()
    );
    fs::write(folder.join("Cargo.toml"), manifest).expect("the manifest");
    fs::write(folder.join("robot.yaml"), robot).expect("the robot file");
    fs::write(folder.join("src/main.rs"), program).expect("the program");
    // The versions that are at hand, since they built this test: the build below needs no network.
    fs::copy(package.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the workspace's lock file");
    folder
}

/// Other people's crates that a crate compiles which only derives. Each costs every user: a new one needs a reason.
const CRATES: [&str; 19] = [
    // the macro
    "proc-macro2",
    "quote",
    "rustc-hash",
    "syn",
    "unicode-ident",
    // robot files and plan files, with their messages
    "annotate-snippets",
    "anstyle",
    "arraydeque",
    "saphyr-parser",
    "strsim",
    "thiserror",
    "thiserror-impl",
    "unicode-width",
    // the compiler: random states of its proof, tables of its graph, lines of its comments
    "fastrand",
    "hashbrown",
    "textwrap",
    // the scalar
    "autocfg",
    "libm",
    "num-traits",
];

#[test]
fn a_crate_that_only_derives_compiles_few_crates() {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--package", "rne", "--no-default-features"])
        .args(["--edges", "normal,build", "--prefix", "none", "--format", "{lib}"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let tree = String::from_utf8(output.stdout).expect("text");
    let crates: BTreeSet<String> = tree
        .lines()
        .map(|line| line.trim_end_matches(" (*)").replace('_', "-"))
        .filter(|name| name != "rne" && !name.starts_with("rne-"))
        .collect();
    assert_eq!(crates, CRATES.map(str::to_owned).into());
}

fn cargo(folder: &Path, command: &str) -> String {
    let output = Command::new(env!("CARGO"))
        .args([command, "--offline", "--quiet", "--target-dir"])
        // that of tests/users
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("tests").join("trybuild"))
        .current_dir(folder)
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env("CARGO_INCREMENTAL", "0")
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

/// How long the user's crate alone takes, without what an earlier build left of it.
fn built_again(folder: &Path) -> Duration {
    let main = folder.join("src/main.rs");
    let program = fs::read_to_string(&main).expect("the program");
    fs::write(&main, program + "// changed\n").expect("the program");
    let start = Instant::now();
    cargo(folder, "build");
    start.elapsed()
}

/// Every derive that needs no motor, but that of six functions with a payload; every method called.
fn everything(form: &str) -> String {
    format!(
        "use rne::*;

#[derive(
    InverseDynamics, MassMatrix, CoriolisMatrix, ForwardDynamics, Kinematics, Energy, CentreOfMass, Regressor,
    InverseDynamicsDerivatives, JointWrenches, MomentumObserver, MovingBase,
)]
#[robot(path = \"../robot.yaml\", form = \"{form}\")]
struct Arm;

fn main() {{
    let x = [0.1_f64; 7];
    let base = BaseMotion::fixed([0.0, 0.0, -9.81]);
    println!(\"{{:?}}\", (Arm.inverse_dynamics(&x, &x, &x), Arm.gravity_torques(&x), Arm.bias_torques(&x, &x)));
    println!(\"{{:?}}\", (Arm.mass_matrix(&x), Arm.coriolis_matrix(&x, &x), Arm.forward_dynamics(&x, &x, &x)));
    println!(\"{{:?}}\", (Arm.forward_kinematics(&x), Arm.link_poses(&x), Arm.jacobian(&x)));
    println!(\"{{:?}}\", Arm.jacobian_rate_times_velocity(&x, &x));
    println!(\"{{:?}}\", (Arm.kinetic_energy(&x, &x), Arm.potential_energy(&x), Arm.regressor(&x, &x, &x)));
    println!(\"{{:?}}\", (Arm.centre_of_mass(&x), Arm.centre_of_mass_jacobian(&x)));
    println!(\"{{:?}}\", (Arm.inverse_dynamics_derivatives(&x, &x, &x), Arm.joint_wrenches(&x, &x, &x)));
    println!(\"{{:?}}\", Arm.momentum_and_rate(&x, &x, &x));
    println!(\"{{:?}}\", Arm.inverse_dynamics_on_moving_base(&x, &x, &x, &base));
}}
"
    )
}

/// The statements of these functions.
fn statements<'p>(programs: impl IntoIterator<Item = &'p Program>) -> usize {
    programs.into_iter().map(|program| program.operations().statements).sum()
}

#[test]
fn all_derives_of_seven_joints_build() {
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/robots/panda.yaml");
    let robot = fs::read_to_string(robot).expect("the robot file");
    for (form, most) in [(Form::SevenSteps, 9400), (Form::Reduced, 4900)] {
        let read = Robot::from_yaml(&robot).unwrap_or_else(|report| panic!("{report}"));
        let plans = PlanSet::default_of(&read);
        let is_left_out = |function: Function| {
            function == Function::ActuatorTorques
                || matches!(
                    function.capability(),
                    Capability::PayloadDynamics
                        | Capability::TipWrenches
                        | Capability::FloatingBase
                        | Capability::CentroidalMomentum
                        | Capability::FloatingRegressor
                        | Capability::FloatingEnergy
                        | Capability::FloatingKinematics
                        | Capability::ContactDynamics
                        | Capability::FloatingInverseDynamicsDerivatives
                        | Capability::InverseDynamicsGradient
                        | Capability::ForwardDynamicsDerivatives
                        | Capability::JacobianDerivatives
                        | Capability::InverseDynamicsHessian
                        | Capability::EulerStep
                        | Capability::EulerStepDerivatives
                        | Capability::FloatingEulerStep
                        | Capability::FloatingEulerStepDerivatives
                        | Capability::FloatingPayloadDynamics
                )
        };
        let functions = Function::OF_TREES.into_iter().filter(|&function| !is_left_out(function));
        let programs: Result<Vec<Program>, _> =
            functions.map(|function| Compiler::new(&read).with_plans(&plans).compile(function, form)).collect();
        let programs = programs.unwrap_or_else(|error| panic!("{error}"));
        let statements = statements(&programs);
        println!("7 joints, ten derives, {form}: {statements} statements");
        assert!(statements <= most, "{form}: {statements} statements");

        let folder = user(&format!("everything_{form}"), &robot, &everything(&form.to_string()));
        cargo(&folder, "build");
        let elapsed = built_again(&folder);
        println!("7 joints, ten derives, {form}: the user's crate is built again in {elapsed:.1?} (dev profile)");
    }
}

#[test]
fn a_chain_of_thirty_joints_builds() {
    let robot = Robot::from_yaml(&chain(JOINTS)).unwrap_or_else(|report| panic!("{report}"));

    // at q = q̇ = q̈ = 0.1
    let program = format!(
        "use rne::InverseDynamics;\n\n#[derive(InverseDynamics)]\n#[robot(path = \"../robot.yaml\")]\nstruct Chain;\n\n\
         fn main() {{\n    let x = [0.1_f64; {JOINTS}];\n    \
         println!(\"{{:?}}\", Chain.inverse_dynamics(&x, &x, &x));\n}}\n"
    );
    let folder = user("chain", &chain(JOINTS), &program);
    cargo(&folder, "build"); // its dependencies, and itself once
    let elapsed = built_again(&folder);
    println!("{JOINTS} joints: the user's crate is built again in {elapsed:.1?} (dev profile)");

    let x = [0.1; JOINTS];
    let torques = DynArm::from_robot(&robot).inverse_dynamics(&x, &x, &x).expect("the right length");
    assert_eq!(cargo(&folder, "run"), format!("{torques:?}"));
}

/// A joint costs the compiler as much behind thirty joints as behind ten, in operations written on the sheet and in
/// statements.
#[test]
fn torques_grow_with_the_number_of_joints() {
    let work = |joints: usize| {
        let robot = Robot::from_yaml(&chain(joints)).unwrap_or_else(|report| panic!("{report}"));
        Function::TORQUES.map(|function| {
            let program = Compiler::new(&robot).compile(function, Form::SevenSteps).expect("finite constants");
            let (products, sums) = program.before();
            [products + sums, program.operations().total(), statements([&program])]
        })
    };
    let [ten, twenty, thirty] = [10, 20, 30].map(work);
    println!("10 joints {ten:?}\n20 joints {twenty:?}\n30 joints {thirty:?}");
    for (index, function) in Function::TORQUES.into_iter().enumerate() {
        for count in 0..3 {
            let increments = [twenty[index][count] - ten[index][count], thirty[index][count] - twenty[index][count]];
            assert_eq!(increments[0], increments[1], "{function}: {increments:?}");
        }
    }
}
