//! `rne emit`: what it writes compiles, and what it overwrites is its own.

use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use crate::call::{ROOT, fails, fine, folder, rne};
use serde_json::Value;

const ROBOT: &str = "robots/planar2.yaml";

/// With parameters: the lengths of its links.
const DESK: &str = "docs/desk_arm.yaml";

/// A path in `folder` as text.
fn path(folder: &std::path::Path, name: &str) -> String {
    folder.join(name).to_str().expect("UTF-8").to_owned()
}

/// The numbers that a file computes once `rustc` has compiled it with `body` as its main function.
fn printed(folder: &std::path::Path, code: &str, body: &str) -> Vec<f64> {
    let (source, program) = (path(folder, "main.rs"), path(folder, "main"));
    let by_sign = if code.contains("fn by_sign") { BY_SIGN } else { "" };
    let mut scalar = format!("\nimpl Scalar for f64 {{{SCALAR}{by_sign}}}\n");
    if code.contains("\nimpl Scalar for f64 {") {
        scalar.clear();
    }
    fs::write(&source, format!("{code}{scalar}fn main() {{{body}}}\n")).expect("written");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let compiled = Command::new(rustc).args(["--edition", "2024", "-A", "dead_code", "-o", &program, &source]).output();
    let compiled = compiled.expect("rustc starts");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let computed = Command::new(&program).output().expect("it starts");
    String::from_utf8_lossy(&computed.stdout).lines().map(|line| line.parse().expect("a number")).collect()
}

const SCALAR: &str = "
    fn from_f64(value: f64) -> Self { value }
    fn sin_cos(self) -> (Self, Self) { f64::sin_cos(self) }
";

const BY_SIGN: &str = "
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        if self > 0.0 { positive } else if self < 0.0 { negative } else { 0.0 }
    }
";

/// The torques that a file computes.
fn compiled(folder: &std::path::Path, code: &str, state: &str) -> Vec<f64> {
    printed(folder, code, &format!("for torque in inverse_dynamics(&{state}) {{ println!(\"{{torque}}\"); }}"))
}

/// The numbers of `rne eval --json`, whatever their shape: the fields of records are in alphabetical order.
fn evaluated(arguments: &[&str]) -> Vec<f64> {
    let json: Value = serde_json::from_str(&fine(arguments)).expect("JSON");
    flat(&json["result"])
}

/// The same of a list or a number, to the last bit, which `serde_json` may miss.
fn every_bit(arguments: &[&str]) -> Vec<f64> {
    let text = fine(arguments);
    text.split(|c: char| c.is_whitespace() || "[]{},".contains(c)).filter_map(|word| word.parse().ok()).collect()
}

fn flat(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(elements) => elements.iter().flat_map(flat).collect(),
        Value::Object(fields) => fields.values().flat_map(flat).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-11 * b.abs(), "{found:?} is not {expected:?}");
    }
}

/// Placeholders of an exporter are told where code is made of them, and the code is the same.
#[test]
fn warnings_of_the_robot_file_are_counted() {
    let link = "{mass: 1, com: [0, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}";
    let joint = format!("  - {{type: revolute, dh: {{theta: 0, d: 0.1, a: 0.8, alpha: 0}}, link: {link}}}\n");
    let head = "format: 1\nname: p\nsource: own\nconvention: standard\ngravity: [0, -9.81, 0]\njoints:\n";
    let called = crate::call::rne_reading(&["emit", "-", "--lang", "c"], &format!("{head}{}", joint.repeat(3)));
    assert_eq!(called.status, 0, "{called:?}");
    assert_eq!(called.err, "note: 1 warning in the robot file; rne check - shows it\n");
    assert!(called.out.contains("p_inverse_dynamics"), "{}", called.out);
    assert_eq!(rne(&["emit", DESK, "--lang", "c"]).err, "");
}

#[test]
fn the_file_compiles_by_itself_and_computes_the_same() {
    let folder = folder("compiles");
    let state = "[0.6_f64, -1.1], &[1.3, -0.4], &[-0.7, 2.1]";
    let expected = evaluated(&["eval", ROBOT, "--q", "0.6,-1.1", "--qd", "1.3,-0.4", "--qdd", "-0.7,2.1", "--json"]);
    let code = fine(&["emit", ROBOT, "--lang", "rust"]);
    assert_eq!(compiled(&folder, &code, state), expected, "in every bit");
    let code = fine(&["emit", ROBOT, "--form", "reduced"]);
    assert!(code.contains("Identical to the seven steps but for a probability below 1e-100"), "{code}");
    close(&compiled(&folder, &code, state), &expected);
}

/// A program that reads angles and writes the bits of their sines and cosines, each as a number.
const SINES: &str = "
    for line in std::io::stdin().lines() {
        let angle = f64::from_bits(line.unwrap().parse().unwrap());
        let (sine, cosine) = Scalar::sin_cos(angle);
        println!(\"{} {}\", sine.to_bits(), cosine.to_bits());
        let (sine, cosine) = Scalar::sin_cos(angle as f32);
        println!(\"{} {}\", sine.to_bits(), cosine.to_bits());
    }
";

/// Angles of every magnitude up to 1e5 rad, and those at which a quadrant ends.
fn angles() -> Vec<f64> {
    let mut angles = vec![0.0, -0.0, 1e5, -1e5, f64::MIN_POSITIVE, f64::from(f32::MIN_POSITIVE)];
    for step in 1..5000_u32 {
        // multiples of the golden ratio fill the unit interval evenly
        let part = (f64::from(step) * 0.618_033_988_749_894_9).fract();
        let sign = if step % 2 == 0 { 1.0 } else { -1.0 };
        let end = f64::from(step * 25) * std::f64::consts::FRAC_PI_4;
        angles.extend(
            [part * 1e5, 10_f64.powf(part * 13.0 - 8.0), end, end * (1.0 + (part - 0.5) * 1e-6)].map(|x| sign * x),
        );
    }
    angles
}

/// In every bit, where the runtime is compiled without fused multiply-add: the file never has it.
#[test]
fn a_file_brings_its_own_sine_and_cosine() {
    use std::io::Write as _;
    use std::process::Stdio;

    let folder = folder("with_sin_cos");
    let state = "[0.6_f64, -1.1], &[1.3, -0.4], &[-0.7, 2.1]";
    let emit = ["emit", ROBOT, "--function", "inverse_dynamics,actuator_torques", "--with-sin-cos"];
    let code = fine(&emit);
    let torques = format!("for torque in inverse_dynamics(&{state}) {{ eprintln!(\"{{torque}}\"); }}");
    let (source, program) = (path(&folder, "main.rs"), path(&folder, "main"));
    fs::write(&source, format!("{code}fn main() {{{torques}{SINES}}}\n")).expect("written");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let built = Command::new(rustc)
        .args(["--edition", "2024", "-O", "-A", "dead_code", "-D", "warnings", "-o", &program, &source])
        .output()
        .expect("rustc starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    if cfg!(any(target_arch = "aarch64", target_feature = "fma")) {
        eprintln!("skipped: the runtime is compiled with fused multiply-add");
        return;
    }

    let angles = angles();
    let mut running = Command::new(&program);
    let mut running =
        running.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let typed = angles.iter().fold(String::new(), |text, angle| text + &angle.to_bits().to_string() + "\n");
    let mut input = running.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(typed.as_bytes()));
    let output = running.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("all was read");
    let found = String::from_utf8(output.stdout).expect("UTF-8");
    let mut found = found.lines();
    for angle in &angles {
        let (sine, cosine) = rne::Scalar::sin_cos(*angle);
        let double = format!("{} {}", sine.to_bits(), cosine.to_bits());
        #[allow(clippy::cast_possible_truncation)]
        let (sine, cosine) = rne::Scalar::sin_cos(*angle as f32);
        let single = format!("{} {}", sine.to_bits(), cosine.to_bits());
        assert_eq!([found.next(), found.next()], [Some(&*double), Some(&*single)], "of {angle:e}");
    }
    assert_eq!(found.next(), None);
    let eval = ["eval", ROBOT, "--q", "0.6,-1.1", "--qd", "1.3,-0.4", "--qdd", "-0.7,2.1", "--json"];
    let torques = String::from_utf8(output.stderr).expect("UTF-8");
    let torques: Vec<f64> = torques.lines().map(|line| line.parse().expect("a number")).collect();
    assert_eq!(torques, evaluated(&eval), "in every bit");

    fails(2, &["emit", ROBOT, "--lang", "c", "--with-sin-cos"], &["--with-sin-cos", "always contains its sine"]);
    let out = path(&folder, "arm.rs");
    fails(1, &[&emit[..], &["--check", &out]].concat(), &["actuator_torques --with-sin-cos -o "]);
}

/// Every function of a robot with motors, in both forms, against the runtime.
#[test]
fn all_functions_compile_and_compute_the_same() {
    const PUMA: &str = "robots/puma560.yaml";
    let folder = folder("all");
    let [q, qd, qdd] = ["0.3,-0.8,0.5,1.1,-0.4,0.6", "0.9,-0.5,0.4,1.2,-0.3,0.7", "-1.1,0.6,0.8,-0.9,1.4,0.35"];
    let (wrench, tau) = ("3,-2,1,0.1,0.2,0.5", "1,30,5,0.1,-0.2,0.3");
    let motion = ["0.1,0.2,-0.3", "0.4,-0.5,0.6", "1,-2,3", "0.5,0.6,-9.7"];
    let names = ["--base-omega", "--base-omega-dot", "--base-acceleration", "--gravity"];
    let base: Vec<&str> = names.iter().zip(&motion).flat_map(|(name, value)| [*name, value]).collect();
    let all: [&[&str]; 5] = [
        &["--q", q],
        &["--q", q, "--qd", qd],
        &["--q", q, "--qd", qd, "--qdd", qdd],
        &["--qd", qd, "--qdd", qdd],
        &base,
    ];
    let [positions, rates, full, shaft, base] = all;
    let expect = |function: &str, arguments: &[&[&str]]| {
        let call = [&["eval", PUMA, "--json", "--function", function], &arguments.concat()[..]].concat();
        evaluated(&call)
    };
    let calls: [(&str, &[&[&str]], &str); 25] = [
        ("inverse_dynamics", &[full], "q, qd, qdd"),
        (
            "inverse_dynamics_with_wrench",
            &[full, &["--wrench", wrench]],
            "q, qd, qdd, &[3., -2., 1.], &[0.1, 0.2, 0.5]",
        ),
        (
            "inverse_dynamics_with_payload",
            &[full, &["--payload", "2,0.1,0.2,-0.3,0.04,0.05,0.06,0.001,-0.002,0.003"]],
            "q, qd, qdd, &[2., 0.1, 0.2, -0.3, 0.04, 0.05, 0.06, 0.001, -0.002, 0.003]",
        ),
        ("inverse_dynamics_from_sin_cos", &[full], "&q.map(f64::sin), &q.map(f64::cos), q, qd, qdd"),
        ("gravity_torques", &[positions], "q"),
        ("bias_torques", &[rates], "q, qd"),
        ("mass_matrix", &[positions], "q"),
        ("inverse_mass_matrix", &[positions], "q"),
        ("coriolis_matrix", &[rates], "q, qd"),
        ("coriolis_torques", &[rates], "q, qd"),
        ("forward_dynamics", &[rates, &["--tau", tau]], "q, qd, &[1., 30., 5., 0.1, -0.2, 0.3]"),
        ("forward_kinematics", &[positions], "q"),
        ("link_poses", &[positions], "q"),
        ("jacobian", &[positions], "q"),
        ("jacobian_rate_times_velocity", &[rates], "q, qd"),
        ("kinetic_energy", &[rates], "q, qd"),
        ("potential_energy", &[positions], "q"),
        ("centre_of_mass", &[positions], "q"),
        ("centre_of_mass_jacobian", &[positions], "q"),
        ("regressor", &[full], "q, qd, qdd"),
        ("inverse_dynamics_derivatives", &[full], "q, qd, qdd"),
        ("joint_wrenches", &[full], "q, qd, qdd"),
        ("momentum_and_rate", &[rates, &["--tau", tau]], "q, qd, &[1., 30., 5., 0.1, -0.2, 0.3]"),
        (
            "inverse_dynamics_on_moving_base",
            &[full, base],
            "q, qd, qdd, &[0.1, 0.2, -0.3], &[0.4, -0.5, 0.6], &[1., -2., 3.], &[0.5, 0.6, -9.7]",
        ),
        ("actuator_torques", &[shaft], "qd, qdd"),
    ];
    let expected: Vec<Vec<f64>> = calls.iter().map(|(function, arguments, _)| expect(function, arguments)).collect();
    let mut body = format!("let (q, qd, qdd) = (&[{q}], &[{qd}], &[{qdd}]);\n");
    for (function, _, arguments) in calls {
        let _ = writeln!(body, "print(&format!(\"{{:?}}\", {function}::<f64>({arguments})));");
    }
    // numbers between brackets and commas
    let print = "fn print(text: &str) {
        for number in text.split(|c: char| \"[(, )]\".contains(c)).filter(|word| !word.is_empty()) {
            println!(\"{number}\");
        }
    }\n";
    for form in ["seven_steps", "reduced"] {
        let code = fine(&["emit", PUMA, "--function", "all", "--form", form]) + print;
        let computed = printed(&folder, &code, &body);
        let mut from = 0;
        for ((function, ..), expected) in calls.iter().zip(&expected) {
            let found = computed.get(from..from + expected.len()).expect("as many numbers");
            from += expected.len();
            let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
            let error = found.iter().zip(expected).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max);
            assert!(error < 1e-12, "{function}, {form}: {error:e}");
        }
        assert_eq!(from, computed.len());
    }
}

/// Parallel axes with angles that are no right ones: sums of positions, of constants and of angles have names of their
/// own.
#[test]
fn sums_of_oblique_angles_compile() {
    let folder = folder("oblique");
    let (robot, plan) = (path(&folder, "oblique.yaml"), path(&folder, "oblique.plan.yaml"));
    let text = fs::read_to_string(format!("{}/robots/planar3.yaml", crate::call::ROOT)).expect("a robot");
    let oblique = text.replace("theta: 0,", "theta: 0.2,");
    assert_eq!(oblique.matches("theta: 0.2,").count(), 3);
    fs::write(&robot, oblique).expect("written");
    fine(&["search", &robot, "--seconds", "0"]);
    let text = fs::read_to_string(&plan).expect("a plan");
    let (before, _) = text.split_once("    joints:\n").expect("its joints");
    let joint = "      - {on: [group_acceleration, group_wrench]}\n";
    fs::write(&plan, format!("{before}    joints:\n{}", joint.repeat(3))).expect("written");
    let code = fine(&["emit", &robot, "--form", "reduced"]);
    for name in ["q1_2 = q1 + q2", "theta1_2: T", "angle1_2 = ", "theta1_3: T", "angle1_3 = "] {
        assert!(code.contains(name), "no `{name}` in {code}");
    }
    let eval = ["eval", &robot, "--q", "0.6,-1.1,0.4", "--qd", "1.3,-0.4,0.2", "--qdd", "-0.7,2.1,0.9", "--json"];
    let expected = evaluated(&eval);
    close(&compiled(&folder, &code, "[0.6_f64, -1.1, 0.4], &[1.3, -0.4, 0.2], &[-0.7, 2.1, 0.9]"), &expected);
}

/// In every bit of `rne eval --set`, for the seven steps; the reduced form up to rounding.
#[test]
fn parameters_at_run_time() {
    let folder = folder("run_time");
    let functions = "inverse_dynamics,kinetic_energy";
    // the sine of the runtime
    let emit = ["emit", DESK, "--function", functions, "--run-time", "fore,upper", "--with-sin-cos"];
    let [q, qd, qdd] = ["0.3,-0.8,0.5", "0.9,-0.5,0.4", "-1.1,0.6,0.8"];
    let states = [("0.4", "0.3"), ("0.55", "0.125"), ("1", "0.31")];
    let expected: Vec<f64> = states
        .iter()
        .flat_map(|(upper, fore)| {
            let (upper, fore) = (format!("upper={upper}"), format!("fore={fore}"));
            let set = ["--set", &upper, "--set", &fore, "--json", "--q", q, "--qd", qd];
            let torques = every_bit(&[&["eval", DESK, "--qdd", qdd][..], &set].concat());
            let energy = every_bit(&[&["eval", DESK, "--function", "kinetic_energy"][..], &set].concat());
            [torques, energy].concat()
        })
        .collect();
    let mut body = format!("let (q, qd, qdd) = (&[{q}], &[{qd}], &[{qdd}]);\n");
    for (index, (upper, fore)) in states.into_iter().enumerate() {
        let literal = format!("Parameters::<f64> {{ upper: {upper} as f64, fore: {fore} }}");
        // the first are those of the file
        let made = if index == 0 { "Parameters::<f64>::of_file()" } else { &literal };
        let _ = writeln!(
            body,
            "let p = {made}; for x in inverse_dynamics(q, qd, qdd, &p) {{ println!(\"{{x}}\"); }}
             println!(\"{{}}\", kinetic_energy(q, qd, &p));"
        );
    }
    let code = fine(&emit);
    assert_eq!(printed(&folder, &code, &body), expected, "in every bit");
    let reduced = fine(&[&emit[..], &["--form", "reduced"]].concat());
    assert_ne!(code, reduced);
    close(&printed(&folder, &reduced, &body), &expected);

    assert!(code.contains("\n//! parameters at run time, with their values in the file: fore = 0.3, upper = 0.4\n"));
    let one = fine(&["emit", DESK, "--run-time", "fore"]);
    assert!(one.contains("file: fore = 0.3\n//!\n//! parameters folded: upper = 0.4\n"), "{one}");
    let none = fine(&["emit", DESK]);
    assert!(none.contains("\n//! parameters folded: upper = 0.4, fore = 0.3\n") && !none.contains("Parameters"));
    // what does not depend on them does not take them
    let waist = fine(&["emit", DESK, "--run-time", "fore", "--function", "actuator_torques"]);
    assert!(!waist.contains("Parameters"), "{waist}");
}

#[test]
fn parameters_that_cannot_stay_free() {
    let emit = |names| ["emit", DESK, "--run-time", names];
    fails(2, &emit("uper"), &["no parameter `uper` for run time", "did you mean `upper`?"]);
    fails(2, &emit("fore,fore"), &["--run-time names fore twice"]);
    let folder = folder("run_time_angle");
    let (robot, out) = (path(&folder, "arm.yaml"), path(&folder, "arm.rs"));
    let text = fs::read_to_string(format!("{ROOT}/{DESK}")).expect("a robot");
    fs::write(&robot, text.replace("alpha: pi/2", "alpha: pi/2 + fore")).expect("written");
    let angle =
        ["the angle `pi/2 + fore` depends on the run-time parameter `fore`", "arm.yaml:11:", "remove `fore` from"];
    fails(1, &["emit", &robot, "--run-time", "fore"], &angle);
    // the command that writes it anew has them
    fails(1, &["emit", DESK, "--run-time", "fore,upper", "--check", &out], &["--run-time fore,upper -o"]);
}

#[test]
fn functions_are_chosen() {
    let all = fine(&["emit", ROBOT]);
    assert_eq!(all.matches("pub fn ").count(), 6);
    let two = fine(&["emit", ROBOT, "--function", "bias_torques", "--function", "gravity_torques"]);
    assert_eq!(two.matches("pub fn ").count(), 2);
    let twice = fine(&["emit", ROBOT, "--function", "gravity_torques", "--function", "gravity_torques"]);
    assert_eq!(twice.matches("pub fn ").count(), 1);
    let others = fine(&["emit", ROBOT, "--function", "mass_matrix,jacobian"]);
    assert!(others.contains("pub fn mass_matrix") && others.contains("pub fn jacobian"), "{others}");
    assert_eq!(fine(&["emit", ROBOT, "--function", "all"]).matches("pub fn ").count(), 40, "no motors");
    for lang in ["rust", "c"] {
        let zeros = fine(&["emit", ROBOT, "--function", "actuator_torques", "--lang", lang]);
        assert!(zeros.contains("actuator_torques"), "{zeros}");
    }
    fails(2, &["emit", ROBOT, "--lang", "fortran"], &["rust", "c"]);
    fails(2, &["emit", ROBOT, "--function", "torques"], &["did you mean inverse_dynamics?"]);
}

#[test]
fn rollouts_are_kernels_of_ptx() {
    let emit = ["emit", "robots/puma560.yaml", "--rollout"];
    let text = fine(&[&emit[..], &["--lang", "ptx", "--real", "double"]].concat());
    for end in ["columns", "rows"] {
        assert!(text.contains(&format!(".visible .entry puma560_forward_dynamics_{end}(\n")), "{text}");
        assert!(text.contains(&format!(".visible .entry puma560_rollout_{end}(\n")), "{text}");
    }
    assert!(text.contains("    .param .f64 step,\n    .param .u32 steps,\n    .param .u32 every,\n"), "{text}");
    let loaded = ["--lang", "ptx", "--function", "forward_dynamics_with_payload"];
    assert!(fine(&[&emit[..], &loaded].concat()).contains(".entry puma560_rollout_with_payload_rows("));
    fails(2, &emit, &["--rollout", "is for --lang ptx", "CompiledArm::rollout"]);
    let torques = ["--lang", "ptx", "--function", "inverse_dynamics"];
    fails(2, &[&emit[..], &torques].concat(), &["can be rolled out", "--function forward_dynamics"]);
    let rolled = |file| ["emit", file, "--lang", "ptx", "--rollout"];
    let loops = "docs/four_bar.yaml";
    fails(2, &rolled(loops), &["closed loops cannot be rolled out"]);
    fails(2, &[&rolled(loops)[..], &["--function", "forward_dynamics"]].concat(), &["closed loops cannot be rolled"]);
    // not silently that of the arm on a base at rest
    fails(2, &rolled("docs/satellite.yaml"), &["a floating base cannot be rolled out", "a locked base"]);
    let held = ["--function", "forward_dynamics"];
    assert!(fine(&[&rolled("docs/satellite.yaml")[..], &held].concat()).contains("satellite_rollout_rows"));
}

#[test]
fn own_files_are_overwritten_and_others_are_not() {
    let folder = folder("overwriting");
    let out = path(&folder, "arm.rs");
    let written = rne(&["emit", ROBOT, "-o", &out]);
    assert_eq!((written.status, written.out.as_str()), (0, ""));
    let code = fs::read_to_string(&out).expect("written");
    assert_eq!(code, fine(&["emit", ROBOT]));
    assert!(rne(&["emit", ROBOT, "-o", &out]).err.contains("up to date"));
    assert!(rne(&["emit", "robots/planar1.yaml", "-o", &out]).err.contains("wrote"), "another robot, still ours");

    let mine = path(&folder, "mine.rs");
    fs::write(&mine, "fn mine() {}\n").expect("written");
    fails(2, &["emit", ROBOT, "-o", &mine], &["mine.rs was not generated by rne", "--force"]);
    assert_eq!(fs::read_to_string(&mine).expect("still there"), "fn mine() {}\n");
    assert_eq!(rne(&["emit", ROBOT, "-o", &mine, "--force"]).status, 0);
    assert_eq!(fs::read_to_string(&mine).expect("overwritten"), code);

    let robot = path(&folder, "arm.yaml");
    fs::copy(format!("{}/{ROBOT}", crate::call::ROOT), &robot).expect("a copy");
    fails(2, &["emit", &robot, "-o", &robot, "--force"], &["the robot file itself"]);
    fails(2, &["emit", ROBOT, "-o", folder.to_str().expect("UTF-8")], &["folder"]);

    assert_eq!(fine(&["emit", ROBOT, "-o", "-"]), code, "standard output");

    let names = fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<_> = names.collect();
    names.sort();
    assert_eq!(names, ["arm.rs", "arm.yaml", "mine.rs"], "no temporary file is left");
}

/// What is no regular file is neither read to its end nor replaced by one.
#[test]
#[cfg(unix)]
fn devices_stay_devices() {
    use std::os::unix::fs::FileTypeExt as _;

    let folder = folder("devices");
    let socket = path(&folder, "socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
    for device in [socket.as_str(), "/dev/null", "/dev/zero"] {
        fails(2, &["emit", ROBOT, "-o", device], &[device, "is not a regular file"]);
        fails(2, &["emit", ROBOT, "-o", device, "--force"], &[device, "is not a regular file"]);
        fails(2, &["emit", ROBOT, "--check", device], &[device, "is not a regular file"]);
    }
    assert!(fs::metadata(&socket).expect("still there").file_type().is_socket());
    let huge = folder.join("huge.rs");
    fs::File::create(&huge).and_then(|file| file.set_len(3 << 30)).expect("a sparse file");
    fails(2, &["emit", ROBOT, "-o", huge.to_str().expect("UTF-8")], &["huge.rs was not generated by rne"]);
    fs::remove_file(&huge).expect("it is gone");
}

#[test]
fn stale_files_are_found() {
    let folder = folder("stale");
    let out = path(&folder, "arm.rs");
    let check = ["emit", ROBOT, "--function", "bias_torques", "--check", &out];
    let refresh = format!("rne emit {ROBOT} --lang rust --function bias_torques -o {out}");
    fails(1, &check, &["there is no file", &refresh]);
    assert_eq!(rne(&["emit", ROBOT, "--function", "bias_torques", "-o", &out]).status, 0);
    let checked = rne(&check);
    assert_eq!((checked.status, checked.out.as_str()), (0, ""));
    assert!(checked.err.contains("up to date"));

    let code = fs::read_to_string(&out).expect("written");
    fs::write(&out, code.replace("from_f64(0.25)", "from_f64(0.26)")).expect("changed");
    fails(1, &check, &["is stale: line ", "0.26", "0.25", &refresh]);
    assert_ne!(fs::read_to_string(&out).expect("there"), code, "checking writes nothing");
    fs::write(&out, "mine").expect("changed");
    fails(1, &check, &["was not generated by rne", "--force"]);
}

/// A title that would be a test of the documentation, code that a page runs, and a comment of C that goes on.
#[test]
fn a_title_is_no_code() {
    let folder = folder("a_title_is_no_code");
    let robot = fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    let title = robot.lines().find(|line| line.starts_with("title:")).expect("a title");
    let emitted = |text: &str, lang: &str| {
        let file = folder.join("titled.yaml");
        fs::write(&file, robot.replace(title, &format!("title: \"{text}\""))).expect("written");
        fine(&["emit", file.to_str().expect("UTF-8"), "--lang", lang])
    };
    let code = emitted("     let _ = std::fs::write('PWNED', 'x'); //", "rust");
    assert!(code.starts_with("//! let \\_ = std::fs::write('PWNED', 'x'); //: straight-line recursive"), "{code}");
    let page = emitted("<img src=x onerror=alert(1)>", "rust");
    assert!(page.starts_with("//! \\<img src=x onerror=alert(1)\\>: straight-line"), "{page}");
    let c = emitted(&format!("{}???/ next", "x".repeat(93)), "c");
    assert!(c.starts_with(&format!("// {}?/\n// next: straight-line", "x".repeat(93))), "{c}");
}

/// A file that is written through a temporary one is a file like any other.
#[test]
#[cfg(unix)]
fn a_new_file_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = folder("permissions");
    let (plain, emitted) = (path(&folder, "plain.rs"), path(&folder, "emitted.rs"));
    fs::write(&plain, "").expect("written");
    rne(&["emit", ROBOT, "-o", &emitted]);
    let mode = |file: &str| fs::metadata(file).expect("a file").permissions().mode();
    assert_eq!(mode(&emitted), mode(&plain));
    fs::set_permissions(&emitted, fs::Permissions::from_mode(0o640)).expect("permitted");
    rne(&["emit", "robots/planar3.yaml", "-o", &emitted]);
    assert_eq!(mode(&emitted) & 0o777, 0o640, "those of the file that is replaced");
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 2, "no temporary file is left");
}

#[test]
fn functions_are_written_at_frames() {
    const FRAMES: &str = "docs/desk_arm_frames.yaml";
    let names = |arguments: &[&str]| -> Vec<String> {
        let text = fine(&[&["emit", FRAMES], arguments].concat());
        let names = text.lines().filter_map(|line| line.strip_prefix("pub fn ")?.split('<').next());
        names.map(str::to_owned).collect()
    };
    assert_eq!(
        names(&["--function", "jacobian"]),
        ["jacobian", "jacobian_of_camera", "jacobian_of_gripper", "jacobian_of_table"],
        "the tip and the list of the file"
    );
    assert_eq!(
        names(&["--frame", "camera"]),
        [
            "pose_of_camera",
            "jacobian_of_camera",
            "jacobian_rate_times_velocity_of_camera",
            "wrench_torques_of_camera",
            "jacobian_rate_of_camera",
            "jacobian_derivatives_of_camera"
        ]
    );
    assert_eq!(
        names(&["--function", "jacobian,gravity_torques", "--frame", "elbow,table"]),
        ["gravity_torques", "jacobian_of_elbow", "jacobian_of_table"]
    );
    let others = ["emit", FRAMES, "--function", "mass_matrix", "--frame", "camera"];
    fails(2, &others, &["--frame is for functions of a frame, and none of the functions that are written is one"]);
    fails(2, &["emit", FRAMES, "--frame", "camra"], &["`camera`, `gripper`, `table`", "did you mean `camera`?"]);
    fails(2, &["eval", FRAMES, "--q", "0,0,0", "--frame", "camra"], &["did you mean `camera`?"]);
    let refused = ["eval", FRAMES, "--q", "0,0,0", "--frame", "camera", "--function", "mass_matrix"];
    fails(2, &refused, &["--frame is for functions of a frame", "wrench_torques"]);
}
