//! `rne emit --lang c --friction --limits`: friction of joints and limits of torques, against the runtime and closed
//! forms.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use rne_model::Robot;

use crate::call::{ROOT, fails, fine, folder};
use crate::emit_c::{path, printed};

/// An arm with friction in all joints, and another of which one joint has none and one slides.
const ARM: &str = "docs/desk_arm_identified.yaml";
const SLIDER: &str = "
format: 1
name: slider
source: made for this test
convention: modified
gravity: [0, 0, -9.81]
joints:
  - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2, com: [0.1, 0, 0]},
     motor: {gear_ratio: -50, viscous: 1e-4, coulomb: [0.03, -0.02], coulomb_width: 0.3, inertia: 1e-5}}
  - {type: prismatic, dh: {theta: 0, d: 0, a: 0.2, alpha: pi/2}, link: {mass: 1}, limits: {effort: 200}}
  - {type: revolute, dh: {theta: 0, d: 0.1, a: 0, alpha: 0}, link: {mass: 1, com: [0, 0.1, 0]},
     motor: {viscous: 0.25}, limits: {effort: 8.5}}
";

/// What the three functions of C write at speeds and torques, state by state.
fn of_c(name: &str, robot: &str, real: &str, form: &str, states: &[[Vec<f64>; 2]]) -> Option<Vec<[Vec<f64>; 3]>> {
    let folder = folder(&format!("joints_{name}_{real}_{form}"));
    let code = fine(&[
        "emit",
        robot,
        "--lang",
        "c",
        "--real",
        real,
        "--form",
        form,
        "--prefix",
        "arm",
        "--friction",
        "--limits",
    ]);
    let dof = states[0][0].len();
    let mut main = format!(
        "#include <stdio.h>\n#include <math.h>\nint main(void)\n{{\n    {real} limited[{dof}], slope[{dof}];\n"
    );
    for [qd, tau] in states {
        let list = |numbers: &[f64]| {
            let numbers: Vec<String> =
                numbers.iter().map(|x| if x.is_nan() { "NAN".to_owned() } else { format!("({real}){x:?}") }).collect();
            numbers.join(", ")
        };
        // friction is written over the speeds
        let _ = write!(
            main,
            "    {{\n        {real} qd[{dof}] = {{{}}};\n        const {real} tau[{dof}] = {{{}}};\n        \
             arm_friction_derivatives(qd, slope);\n        arm_friction_torques(qd, qd);\n        \
             arm_limit_torques(tau, limited);\n        for (unsigned i = 0; i < {dof}u; ++i)\n            \
             printf(\"%.17g %.17g %.17g\\n\", (double)qd[i], (double)limited[i], (double)slope[i]);\n    }}\n",
            list(qd),
            list(tau)
        );
    }
    fs::write(folder.join("main.c"), code + &main + "    return 0;\n}\n").expect("written");
    let printed = printed(&folder, &["main.c"], &["-Wfloat-conversion", "-Wdouble-promotion"])?;
    let numbers: Vec<f64> = printed.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    let rows: Vec<&[f64]> = numbers.chunks(3).collect();
    Some(rows.chunks(dof).map(|rows| [0, 1, 2].map(|k| rows.iter().map(|row| row[k]).collect())).collect())
}

/// Friction by hand: the law of `actuator_torques_smooth`.
fn by_hand(motor: [f64; 5], qd: f64) -> f64 {
    let [ratio, viscous, forward, backward, width] = motor;
    let s = qd / (qd * qd + width * width).sqrt();
    let coulomb = 0.5 * (forward - backward) * s + 0.5 * (forward + backward) * s * s;
    ratio * ratio * viscous * qd + ratio * coulomb
}

/// Its derivative by hand: ds/dq̇ = width² / (q̇² + width²)^(3/2).
fn slope_by_hand([ratio, viscous, forward, backward, width]: [f64; 5], qd: f64) -> f64 {
    let root = (qd * qd + width * width).sqrt();
    let (s, slope) = (qd / root, width * width / root.powi(3));
    ratio * ratio * viscous + ratio * (0.5 * (forward - backward) + (forward + backward) * s) * slope
}

#[test]
#[allow(clippy::cast_possible_truncation, clippy::unreadable_literal)] // rounding to f32; numbers as the file has them
fn friction_and_limits_are_those_of_the_runtime_and_of_closed_forms() {
    let slider = path(&folder("joints"), "slider.yaml");
    fs::write(&slider, SLIDER).expect("written");
    // gear ratio without its sign, viscous, Coulomb forward and backward, width; and the effort limits
    let arm = [
        [1.0, 0.40409067, 0.50233474, -0.49798761, 0.025],
        [1.0, 0.58329411, 0.84433791, -0.7726074, 0.025],
        [1.0, 0.2043907, 0.3042285, -0.29317387, 0.012],
    ];
    let of_slider = [[50.0, 1e-4, 0.03, -0.02, 0.3], [1.0, 0.0, 0.0, 0.0, 1.0], [1.0, 0.25, 0.0, 0.0, 1.0]];
    let none = f64::INFINITY;
    let cases = [("arm", ARM.to_owned(), arm, [40.0, 40.0, 15.0]), ("slider", slider, of_slider, [none, 200.0, 8.5])];
    for (name, file, motors, limits) in cases {
        let text = fs::read_to_string(Path::new(ROOT).join(&file)).expect("a robot");
        let robot = Robot::from_yaml(&text).expect("a robot");
        let runtime = rne::DynArm::from_robot(&robot);
        for (real, epsilon) in [("float", f64::from(f32::EPSILON)), ("double", f64::EPSILON)] {
            let exact = |x: f64| if real == "float" { f64::from(x as f32) } else { x };
            let mut states: Vec<[Vec<f64>; 2]> = (0..200)
                .map(|number| {
                    // random numbers from -3 to 3: speeds from creeping to fast, and torques
                    let [size, exponent, tau] = rne_certify::board::state(number, 3)
                        .map(|row| row.into_iter().map(f64::from).collect::<Vec<f64>>());
                    let qd = size.iter().zip(exponent).map(|(x, e)| exact(x * 10_f64.powf(e - 1.0)));
                    [qd.collect(), tau.iter().map(|x| exact(100.0 * x)).collect()]
                })
                .collect();
            states.push([vec![0.0; 3], limits.map(|limit: f64| limit.min(1e3)).to_vec()]);
            states.push([vec![-0.0; 3], limits.map(|limit: f64| -limit.min(1e3)).to_vec()]);
            states.push([vec![f64::NAN; 3], vec![f64::NAN; 3]]);
            for form in ["reduced", "seven_steps"] {
                let Some(found) = of_c(name, &file, real, form, &states) else { return };
                assert_eq!(found.len(), states.len());
                for ([friction, limited, slope], [qd, tau]) in found.iter().zip(&states) {
                    for joint in 0..3 {
                        let what = format!("{name}, {real}, {form}, joint {joint} at {}", qd[joint]);
                        let of_hand = by_hand(motors[joint], qd[joint]);
                        let width = motors[joint][4];
                        let of_runtime = runtime.actuator_torques_smooth(qd, &[0.0; 3], width).expect("three")[joint];
                        if qd[joint].is_nan() {
                            let has_friction = motors[joint][1] > 0.0;
                            assert_eq!(friction[joint].is_nan(), has_friction, "{what}");
                            assert!(limited[joint].is_nan(), "{what}");
                            continue;
                        }
                        // a unit in the last place of each term for each of its few operations
                        let [ratio, viscous, forward, ..] = motors[joint];
                        let size = ratio * ratio * viscous * qd[joint].abs() + ratio * forward;
                        let error = (friction[joint] - of_hand).abs().max((friction[joint] - of_runtime).abs());
                        assert!(error <= 4.0 * epsilon * size, "{what}: {} is not {of_hand}", friction[joint]);
                        let slopes = runtime.actuator_torques_smooth_derivatives(qd, width).expect("three");
                        let of_hand = slope_by_hand(motors[joint], qd[joint]);
                        let size = ratio * ratio * viscous + ratio * forward / width;
                        let error = (slope[joint] - of_hand).abs().max((slope[joint] - slopes[joint][joint]).abs());
                        assert!(error <= 8.0 * epsilon * size, "{what}: the slope {} is not {of_hand}", slope[joint]);
                        let expected = tau[joint].max(-limits[joint]).min(limits[joint]);
                        assert!(limited[joint] == expected, "{what}: {} is not {expected}", limited[joint]);
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_missing_is_named_with_its_place() {
    let folder = folder("joints_missing");
    let emit = |robot: &str, option: &'static str| ["emit".to_owned(), robot.to_owned(), option.to_owned()];
    let refused = |robot: &str, option, status, parts: &[&str]| {
        let command = emit(robot, option);
        let command: Vec<&str> = command.iter().map(String::as_str).chain(["--lang", "c"]).collect();
        fails(status, &command, parts);
    };
    refused("planar2", "--friction", 1, &["no joint has friction", "`motor: {viscous: 0.4", "coulomb_width"]);
    refused("planar2", "--limits", 1, &["no joint has an effort limit", "`limits: {effort: 40}`"]);
    refused("puma560", "--friction", 1, &["the joint j1", "without `coulomb_width`", "`coulomb_width: 0.02`"]);
    refused("docs/every-key.yaml", "--friction", 1, &["the joint elbow", "`coulomb_displacement`"]);
    let text = fs::read_to_string(Path::new(ROOT).join(ARM)).expect("a robot");
    let (narrow, run_time) = (path(&folder, "narrow.yaml"), path(&folder, "run_time.yaml"));
    fs::write(&narrow, text.replace("coulomb_width: 0.012", "coulomb_width: 0")).expect("written");
    refused(&narrow, "--friction", 1, &["the joint elbow", "`coulomb_width: 0`", "1e-9"]);
    fs::write(&run_time, text.replace("viscous: 0.2043907", "viscous: fore/2")).expect("written");
    fails(2, &["emit", &run_time, "--lang", "c", "--friction", "--run-time", "fore"], &["elbow", "--run-time"]);
    fails(2, &["emit", ARM, "--friction"], &["--friction", "--lang c", "Actuation"]);
    fails(2, &["emit", ARM, "--limits"], &["--limits", "--lang c"]);
    // `--check` repeats the options
    let out = path(&folder, "arm.c");
    fails(1, &["emit", ARM, "--lang", "c", "--friction", "--limits", "--check", &out], &["--friction --limits -o"]);
}

/// On the microcontroller neither function has a branch, a call of a library or double precision.
#[test]
fn friction_and_limits_are_straight_on_a_microcontroller() {
    let compiler = "arm-none-eabi-gcc";
    if Command::new(compiler).arg("--version").output().is_err() {
        println!("not compiled: {compiler} is not installed (cargo xtask certificate --install)");
        return;
    }
    let folder = folder("joints_straight");
    let out = path(&folder, "arm.c");
    let emit = ["emit", ARM, "--lang", "c", "--prefix", "arm", "--friction", "--limits", "-o", &out];
    assert_eq!(crate::call::rne(&emit).status, 0);
    for core in [rne_certify::cycles::Core::M4, rne_certify::cycles::Core::M7] {
        let run = |program: &str, arguments: &[&str]| {
            let output = Command::new(program).current_dir(&folder).args(arguments).output().expect("it starts");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            String::from_utf8_lossy(&output.stdout).into_owned()
        };
        let options = [&rne_certify::board::OPTIONS[..], &core.flags(), &["-ffunction-sections", "-c", "arm.c"]];
        run(compiler, &options.concat());
        let listing = run("arm-none-eabi-objdump", &["--disassemble", "--no-show-raw-insn", "arm.o"]);
        let functions = rne_certify::listing::functions(&listing).expect("a listing");
        for function in ["arm_friction_torques", "arm_friction_derivatives", "arm_limit_torques"] {
            let (count, faults) = rne_certify::listing::judge(&functions[function]);
            println!("{function} on {}: {} instructions", core.name(), count.instructions);
            let faults: Vec<_> = faults.iter().filter(|fault| fault.callee() != Some("arm_inverse_root")).collect();
            assert!(faults.is_empty() && count.instructions > 5, "{function}: {faults:?}");
        }
    }
}
