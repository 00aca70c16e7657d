//! `rne eval`: the runtime's numbers, compared with those of the reference files.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};
use rne::{
    Actuation, Arm, BaseMotion, CentreOfMass, CoriolisMatrix, Energy, ForwardDynamics, InverseDynamics,
    InverseDynamicsDerivatives, JointWrenches, Kinematics, MassMatrix, MovingBase, Payload, PayloadDynamics, Pose,
    Regressor, Wrench,
};
use serde_json::{Value, json};

fn reference(robot: &str) -> Vec<Value> {
    let text = fs::read_to_string(format!("{ROOT}/tests/reference/{robot}.golden.json")).expect("reference values");
    let golden: Value = serde_json::from_str(&text).expect("JSON");
    golden["states"].as_array().expect("states").clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn list(value: &Value) -> String {
    numbers(value).iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

fn result(arguments: &[&str]) -> Vec<f64> {
    let json: Value = serde_json::from_str(&fine(arguments)).expect("JSON");
    assert_eq!(json.as_object().expect("an object").len(), 1, "the result alone");
    numbers(&json["result"])
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-12 * scale, "{found:?} is not {expected:?}");
    }
}

#[test]
fn a_number_is_no_file() {
    fails(2, &["eval", "--q", "0.5", "0.3"], &["found `0.3` where FILE, the robot, is expected", "--q 0.5,0.3"]);
    fails(2, &["eval", "--q", "0.5", "pi/2"], &["found `pi/2` where FILE, the robot, is expected"]);
    fails(1, &["eval", "nowhere", "--q", "1"], &["there is no robot file nowhere"]);
}

#[test]
fn a_payload_that_no_body_can_be_is_told() {
    let with = |payload| {
        rne(&["eval", "robots/planar2.yaml", "--function", "gravity_torques", "--q", "0,0", "--payload", payload])
    };
    let told = with("1,0,0,0,1,1,9,0,0,0");
    assert!(told.status == 0 && told.err.contains("violates the triangle inequality"), "{told:?}");
    assert!(told.err.contains("moment, 9.0000 kg") && told.err.contains("others, 2.0000 kg m²"), "{told:?}");
    assert_eq!(with("1,0,0,0,1,1,2,0,0,0").err, "");
    let refused = with("1,0,0,0,1,1,-9,0,0,0");
    assert!(refused.status == 2 && refused.err.contains("a principal moment of -9"), "{refused:?}");
}

#[test]
fn torques_are_the_known_ones() {
    for robot in ["planar1", "puma560", "scara_cobra600", "panda"] {
        let file = format!("robots/{robot}.yaml");
        for state in reference(robot).iter().take(3) {
            let [q, qd, qdd, wrench] = ["q", "qd", "qdd", "wrench"].map(|key| list(&state[key]));
            let motion = ["eval", &file, "--json", "--q", &q, "--qd", &qd, "--qdd", &qdd];
            close(&result(&motion), &numbers(&state["tau"]));
            let with_wrench: Vec<&str> = motion.into_iter().chain(["--wrench", &wrench]).collect();
            close(&result(&with_wrench), &numbers(&state["tau_wrench"]));
            let at_rest = ["eval", &file, "--json", "--function", "gravity_torques", "--q", &q];
            close(&result(&at_rest), &numbers(&state["gravity"]));
            let bias = ["eval", &file, "--json", "--function", "bias_torques", "--q", &q, "--qd", &qd];
            let (gravity, coriolis) = (numbers(&state["gravity"]), numbers(&state["coriolis"]));
            let expected: Vec<f64> = gravity.iter().zip(&coriolis).map(|(g, c)| g + c).collect();
            close(&result(&bias), &expected);
        }
    }
}

#[test]
fn a_leading_minus_is_a_value() {
    let robot = "robots/planar2.yaml";
    let apart = ["eval", robot, "--q", "-0.1,0.2", "--qd", "-1,0", "--qdd", "-2e-1,0"];
    let joined = ["eval", robot, "--q=-0.1,0.2", "--qd=-1,0", "--qdd=-2e-1,0"];
    assert_eq!(fine(&apart), fine(&joined));
}

#[test]
fn numbers_are_written_as_in_a_file() {
    let call = |q| fine(&["eval", "robots/planar2.yaml", "--function", "gravity_torques", "--q", q]);
    assert_eq!(call("pi/2,-deg(30)"), call("1.5707963267948966,-0.5235987755982988"));
}

#[test]
fn the_worksheet() {
    let state = ["--q", "0.6", "--qd", "1.3", "--qdd", "-0.7"];
    let call = |more: &[&str]| {
        let arguments: Vec<&str> = ["eval", "robots/planar1.yaml"].iter().chain(&state).chain(more).copied().collect();
        fine(&arguments)
    };
    insta::assert_snapshot!(call(&["--trace"]));
    let json: Value = serde_json::from_str(&call(&["--trace", "--json"])).expect("JSON");
    assert_eq!((&json["trace"]["format"], &json["trace"]["axes"]), (&json!(1), &json!("link")));
    let vector = |json: &Value, quantity: &str| -> Vec<f64> {
        let rows = json["trace"]["rows"].as_array().expect("rows");
        let of = rows.iter().filter(|row| row["quantity"] == *quantity && row["joint"] == 1);
        of.map(|row| row["value"].as_f64().expect("a number")).collect()
    };
    let (a, q, qd, qdd) = (0.5, 0.6_f64, 1.3, -0.7);
    close(&vector(&json, "omega"), &[0.0, 0.0, qd]);
    close(&vector(&json, "velocity"), &[0.0, a / 2.0 * qd, 0.0]);
    close(&vector(&json, "acceleration"), &[-a / 2.0 * qd * qd, a / 2.0 * qdd, 0.0]);
    assert_eq!(numbers(&json["result"]), vector(&json, "tau"));
    let json: Value = serde_json::from_str(&call(&["--trace", "--json", "--axes", "base"])).expect("JSON");
    close(&vector(&json, "velocity"), &[-a / 2.0 * qd * q.sin(), a / 2.0 * qd * q.cos(), 0.0]);
    assert_eq!(vector(&json, "gravity"), [0.0, -9.81, 0.0]);
}

#[test]
fn a_prismatic_joint_in_the_worksheet() {
    let state = ["--q", "0.6,0.2,0.1", "--qd", "1.3,-0.4,0.5", "--qdd", "-0.7,2.1,0"];
    let arguments: Vec<&str> =
        ["eval", "robots/cylindrical_rpp.yaml"].iter().chain(&state).chain(&["--trace"]).copied().collect();
    insta::assert_snapshot!(fine(&arguments));
}

/// Velocities and accelerations that are not given are 0, and it is said.
#[test]
fn an_arm_at_rest_needs_positions_alone() {
    let [rest, given] = [&["--q", "0.6,0.2"][..], &["--q", "0.6,0.2", "--qd", "0,0", "--qdd", "0,0"]]
        .map(|state| rne(&[&["eval", "robots/planar2.yaml"], state].concat()));
    assert_eq!((rest.status, &rest.out), (0, &given.out), "{}", rest.err);
    assert_eq!(
        (rest.err.as_str(), given.err.as_str()),
        ("note: --qd and --qdd are not given, so these numbers are 0\n", "")
    );
    let call = rne(&["eval", "robots/planar2.yaml", "--function", "bias_torques", "--q", "0.6,0.2"]);
    assert_eq!(call.err, "note: --qd is not given, so these numbers are 0\n");
    let call = rne(&["eval", "docs/satellite.yaml", "--function", "floating_bias", "--q", "0.6,0.2"]);
    assert_eq!(call.err, "note: --qd and --base-omega are not given, so these numbers are 0\n");
}

#[test]
fn arguments_that_do_not_fit() {
    let robot = "robots/cylindrical_rpp.yaml";
    let three = "1,2,3";
    let call = |status, more: &[&str], parts: &[&str]| {
        let arguments: Vec<&str> = ["eval", robot].iter().chain(more).copied().collect();
        fails(status, &arguments, parts);
    };
    call(2, &["--qd", three], &["needs --q,", "waist, lift, reach"]);
    call(2, &["--qd", three, "--qdd", three], &["needs --q,"]);
    call(2, &["--q", "1,2", "--qd", three, "--qdd", three], &["--q needs 3 numbers, not 2", "waist, lift, reach"]);
    call(2, &["--function", "gravity_torques", "--q", three, "--qd", three], &["gravity_torques takes no --qd"]);
    call(
        2,
        &["--function", "inverse_dynamics_with_wrench", "--q", three, "--qd", three, "--qdd", three],
        &["--wrench"],
    );
    let wrench = ["--q", three, "--qd", three, "--qdd", three, "--wrench", "1,2,3"];
    call(2, &wrench, &["--wrench needs 6 numbers, not 3", "fx,fy,fz,nx,ny,nz"]);
    for bad in ["1,nan,3", "1,inf,3", "1,1e999,3"] {
        call(
            2,
            &["--q", bad],
            &["--q", "number 2", "is not a number", if bad.contains('e') { "too large" } else { "finite" }],
        );
    }
    call(2, &["--q", "1,90°,3"], &["number 2", "write `deg(90)`"]);
    // numbers may begin with a sign or a point, and behind an option too
    let minus = ["eval", robot, "--qd", three, "--qdd", three, "--json"];
    let torques = fine(&[&minus[..], &["--q=-0.5,0.3,0.1"]].concat());
    for q in [&["--q", "-0.5,0.3,0.1"][..], &["--q", "-.5,.3,1/10"], &["--q", "-1/2, 0.3, 0.1"]] {
        assert_eq!(fine(&[&minus[..], q].concat()), torques, "{q:?}");
    }
    let commas = ["write --q -0.5,0.3,0.1\n", "try 'rne eval --help'"];
    call(2, &["--qd", three, "--qdd", three, "--q", "-0.5", "0.3", "0.1"], &commas);
    for bad in ["1,x,3", "1,,3"] {
        call(2, &["--q", bad], &["number 2"]);
    }
    call(1, &["--q", three, "--qd", "1e200,1,1", "--qdd", three], &["overflows"]);
}

const PUMA: &str = "robots/puma560.yaml";
const Q: [f64; 6] = [0.3, -0.8, 0.5, 1.1, -0.4, 0.6];
const QD: [f64; 6] = [0.9, -0.5, 0.4, 1.2, -0.3, 0.7];
const QDD: [f64; 6] = [-1.1, 0.6, 0.8, -0.9, 1.4, 0.35];

fn written(values: &[f64]) -> String {
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// The result of a function of the PUMA 560 with these of its arguments, and what is given beyond them.
fn of_puma(function: &str, arguments: &str, more: &[&str]) -> Value {
    let all = [("q", written(&Q)), ("qd", written(&QD)), ("qdd", written(&QDD))];
    let mut call: Vec<String> = ["eval", PUMA, "--json", "--function", function].map(str::to_owned).into();
    for (name, values) in all.iter().filter(|(name, _)| arguments.split(' ').any(|argument| argument == *name)) {
        call.extend([format!("--{name}"), values.clone()]);
    }
    let call: Vec<&str> = call.iter().map(String::as_str).chain(more.iter().copied()).collect();
    let mut answer: Value = serde_json::from_str(&fine(&call)).expect("JSON");
    answer["result"].take()
}

fn pose(pose: &Pose<f64>) -> Value {
    json!({"rotation": pose.rotation, "translation": pose.translation})
}

/// The same shape and the same numbers; the reader of JSON may round the last bit.
#[track_caller]
fn same(found: &Value, expected: &Value) {
    match (found, expected) {
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => a.iter().zip(b).for_each(|(a, b)| same(a, b)),
        (Value::Object(a), Value::Object(b)) => {
            assert!(a.keys().eq(b.keys()), "{found} is not {expected}");
            a.values().zip(b.values()).for_each(|(a, b)| same(a, b));
        }
        _ => {
            let (a, b) = (found.as_f64().expect("a number"), expected.as_f64().expect("a number"));
            assert!((a - b).abs() <= 2.0 * f64::EPSILON * b.abs(), "{a} is not {b}");
        }
    }
}

/// A parameter of the file has another value, and what is defined through it follows.
#[test]
fn parameters_are_set() {
    let file = folder("settings").join("pendulum.yaml");
    let text = "{format: 1, name: pendulum, source: own, convention: standard, gravity: [0, -9.81, 0],
        parameters: {held: 0, m: 1.2 + held}, joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: m, com: [-1/4, 0, 0]}}]}";
    fs::write(&file, text).expect("a file");
    let file = file.to_str().expect("UTF-8");
    let call = ["eval", file, "--json", "--function", "gravity_torques", "--q", "0"];
    let torque = |more: &[&str]| {
        let reply: Value = serde_json::from_str(&fine(&[&call[..], more].concat())).expect("JSON");
        reply["result"][0].as_f64().expect("a number")
    };
    assert!((torque(&[]) - 1.2 * 9.81 / 4.0).abs() < 1e-14);
    assert!((torque(&["--set", "held=2"]) - 3.2 * 9.81 / 4.0).abs() < 1e-14);
    assert!((torque(&["--set", "held=0.5", "--set", "m=2*4"]) - 8.0 * 9.81 / 4.0).abs() < 1e-13);
    let fails = |status, more: &[&str], words: &[&str]| fails(status, &[&call[..], more].concat(), words);
    fails(2, &["--set", "hold=2"], &["no parameter `hold`", "there are `held`, `m`", "did you mean `held`?"]);
    fails(1, &["--set", "held=-2"], &["the mass `m` = -0.8 is negative"]);
    fails(2, &["--set", "held=2", "--set", "held=3"], &["--set gives held twice"]);
    fails(2, &["--set", "held"], &["write NAME=VALUE"]);
}

#[test]
fn rotors_are_part_of_the_arm_where_asked_for() {
    let call = ["eval", PUMA, "--json", "--function", "mass_matrix", "--q", "0,0,0,0,0,0"];
    let element = |more: &[&str]| {
        let reply: Value = serde_json::from_str(&fine(&[&call[..], more].concat())).expect("JSON");
        reply["result"][1][1].as_f64().expect("a number")
    };
    // G² Jm = 107.815² 2e-4 kg m²
    assert!((element(&["--rotors"]) - element(&[]) - 107.815 * 107.815 * 2e-4).abs() < 1e-12);
}

/// The numbers of the runtime, in the shape of the traits.
#[test]
fn every_function_has_the_shape_of_its_trait() {
    let arm = Arm::<6>::from_file(format!("{ROOT}/{PUMA}")).expect("a robot");
    let full = "q qd qdd";
    same(&of_puma("inverse_dynamics", full, &[]), &json!(arm.inverse_dynamics(&Q, &QD, &QDD)));
    same(&of_puma("inverse_dynamics_from_sin_cos", full, &[]), &json!(arm.inverse_dynamics(&Q, &QD, &QDD)));
    let wrench = Wrench { force: [3.0, -2.0, 1.0], moment: [0.1, 0.2, 0.5] };
    let with_wrench = of_puma("inverse_dynamics_with_wrench", full, &["--wrench", "3,-2,1,0.1,0.2,0.5"]);
    same(&with_wrench, &json!(arm.inverse_dynamics_with_wrench(&Q, &QD, &QDD, &wrench)));
    let bob = Payload { mass: 2.0, com: [0.1, 0.2, -0.3], ..Payload::none() };
    let body = Payload::from_array([2.0, 0.1, 0.2, -0.3, 0.04, 0.05, 0.06, 0.001, -0.002, 0.003]);
    for (payload, written) in [(bob, "2,0.1,0.2,-0.3"), (body, "2,0.1,0.2,-0.3,0.04,0.05,0.06,0.001,-0.002,0.003")] {
        let found = of_puma("inverse_dynamics_with_payload", full, &["--payload", written]);
        same(&found, &json!(arm.inverse_dynamics_with_payload(&Q, &QD, &QDD, &payload)));
        let of = |function, arguments| of_puma(function, arguments, &["--payload", written]);
        same(&of("inverse_dynamics", full), &found);
        same(&of("gravity_torques", "q"), &json!(arm.gravity_torques_with_payload(&Q, &payload)));
        same(&of("gravity_torques_with_payload", "q"), &of("gravity_torques", "q"));
        same(&of("bias_torques", "q qd"), &json!(arm.bias_torques_with_payload(&Q, &QD, &payload)));
        same(&of("mass_matrix", "q"), &json!(arm.mass_matrix_with_payload(&Q, &payload)));
        // a function that takes no payload has it as a part of the last link: ½ q̇ᵀ M q̇
        let energy = of("kinetic_energy", "q qd").as_f64().expect("a number");
        let mass = arm.mass_matrix_with_payload(&Q, &payload);
        let twice: f64 =
            mass.iter().zip(&QD).map(|(row, qd)| qd * row.iter().zip(&QD).map(|(m, qd)| m * qd).sum::<f64>()).sum();
        assert!((2.0 * energy - twice).abs() < 1e-12 * twice, "{energy} {twice}");
    }
    same(&of_puma("gravity_torques", "q", &[]), &json!(arm.gravity_torques(&Q)));
    same(&of_puma("bias_torques", "q qd", &[]), &json!(arm.bias_torques(&Q, &QD)));
    same(&of_puma("mass_matrix", "q", &[]), &json!(arm.mass_matrix(&Q)));
    same(&of_puma("coriolis_matrix", "q qd", &[]), &json!(arm.coriolis_matrix(&Q, &QD)));
    same(&of_puma("coriolis_torques", "q qd", &[]), &json!(arm.coriolis_torques(&Q, &QD)));
    let tau = [1.0, 30.0, 5.0, 0.1, -0.2, 0.3];
    let forward = of_puma("forward_dynamics", "q qd", &["--tau", &written(&tau)]);
    same(&forward, &json!(arm.forward_dynamics(&Q, &QD, &tau)));
    same(&of_puma("forward_kinematics", "q", &[]), &pose(&arm.forward_kinematics(&Q)));
    same(&of_puma("link_poses", "q", &[]), &json!(arm.link_poses(&Q).each_ref().map(pose)));
    same(&of_puma("jacobian", "q", &[]), &json!(arm.jacobian(&Q)));
    let carried = of_puma("jacobian_rate_times_velocity", "q qd", &[]);
    same(&carried, &json!(arm.jacobian_rate_times_velocity(&Q, &QD)));
    same(&of_puma("kinetic_energy", "q qd", &[]), &json!(arm.kinetic_energy(&Q, &QD)));
    same(&of_puma("potential_energy", "q", &[]), &json!(arm.potential_energy(&Q)));
    same(&of_puma("centre_of_mass", "q", &[]), &json!(arm.centre_of_mass(&Q)));
    same(&of_puma("centre_of_mass_jacobian", "q", &[]), &json!(arm.centre_of_mass_jacobian(&Q)));
    same(&of_puma("regressor", full, &[]), &json!(arm.regressor(&Q, &QD, &QDD)));
    let derivatives = arm.inverse_dynamics_derivatives(&Q, &QD, &QDD);
    let expected = json!({"dq": derivatives.dq, "dqd": derivatives.dqd});
    same(&of_puma("inverse_dynamics_derivatives", full, &[]), &expected);
    let wrenches = arm.joint_wrenches(&Q, &QD, &QDD);
    let expected = wrenches.map(|wrench| json!({"force": wrench.force, "moment": wrench.moment}));
    same(&of_puma("joint_wrenches", full, &[]), &json!(expected));
    same(&of_puma("actuator_torques", "qd qdd", &[]), &json!(arm.actuator_torques(&QD, &QDD)));
}

#[test]
fn a_moving_base_is_under_the_gravity_of_the_file_unless_told() {
    let arm = Arm::<6>::from_file(format!("{ROOT}/{PUMA}")).expect("a robot");
    let function = "inverse_dynamics_on_moving_base";
    let motion = ["--base-omega", "0.1,0.2,-0.3", "--base-omega-dot", "0.4,-0.5,0.6", "--base-acceleration", "1,-2,3"];
    let mut base = BaseMotion {
        omega: [0.1, 0.2, -0.3],
        omega_dot: [0.4, -0.5, 0.6],
        acceleration: [1.0, -2.0, 3.0],
        ..arm.fixed_base()
    };
    let expected = arm.inverse_dynamics_on_moving_base(&Q, &QD, &QDD, &base);
    same(&of_puma(function, "q qd qdd", &motion), &json!(expected));
    base.gravity = [1.0, 0.5, -9.7];
    let expected = arm.inverse_dynamics_on_moving_base(&Q, &QD, &QDD, &base);
    let tilted: Vec<&str> = motion.into_iter().chain(["--gravity", "1,0.5,-9.7"]).collect();
    same(&of_puma(function, "q qd qdd", &tilted), &json!(expected));

    let q = written(&Q);
    let state = ["eval", PUMA, "--function", function, "--q", &q, "--qd", &q, "--qdd", &q];
    let with = |more: &[&'static str]| -> Vec<&str> { state.iter().copied().chain(more.iter().copied()).collect() };
    // Python's name of a function
    fails(2, &["eval", PUMA, "--q", &q, "--function", "pose"], &["did you mean forward_kinematics?"]);
    let at_rest = rne(&with(&motion[..2]));
    let note = "note: --base-omega-dot and --base-acceleration are not given, so these numbers are 0";
    assert!(at_rest.status == 0 && at_rest.err.contains(note), "{at_rest:?}");
    let zeros = ["--base-omega-dot", "0,0,0", "--base-acceleration", "0,0,0"];
    assert_eq!(at_rest.out, fine(&with(&[&motion[..2], &zeros].concat())));
    let names = "--base-omega, --base-omega-dot and --base-acceleration are not given";
    let resting = rne(&with(&[]));
    assert!(resting.status == 0 && resting.err.contains(names), "{resting:?}");
    fails(2, &with(&["--base-omega", "1,2"]), &["--base-omega needs 3 numbers, not 2"]);
    let worksheet: Vec<&str> = with(&motion).into_iter().chain(["--trace"]).collect();
    assert!(fine(&worksheet).contains("at the base ω0 = (0.100000, 0.200000, -0.300000) rad/s"));
    let listed = "inverse_dynamics takes no --base-omega; `rne explain arguments` lists the functions that do";
    let named = "inverse_dynamics takes no --gravity; inverse_dynamics_on_moving_base, \
                 inverse_dynamics_of_floating_base, floating_regressor, floating_inverse_dynamics_derivatives and \
                 floating_inverse_dynamics_with_payload do";
    for (name, value, expected) in [("--base-omega", "0,0,1", listed), ("--gravity", "0,0,-9", named)] {
        let call = ["eval", PUMA, "--q", &q, "--qd", &q, "--qdd", &q, name, value];
        fails(2, &call, &[expected]);
    }
}

#[test]
fn functions_take_their_arguments_and_no_others() {
    let robot = "robots/planar2.yaml";
    let call = |status, function: &str, more: &[&str], parts: &[&str]| {
        let arguments: Vec<&str> = ["eval", robot, "--function", function].iter().chain(more).copied().collect();
        fails(status, &arguments, parts);
    };
    let (q, qd) = (["--q", "0.1,0.2"], ["--qd", "1,2"]);
    call(2, "mass_matrix", &[], &["mass_matrix needs --q, one number for each joint of planar2: j1, j2"]);
    call(2, "mass_matrix", &[q, qd].concat(), &["mass_matrix takes no --qd"]);
    call(2, "forward_dynamics", &[q, qd].concat(), &["forward_dynamics needs --tau"]);
    call(2, "forward_dynamics", &[q, qd, ["--tau", "1"]].concat(), &["--tau needs 2 numbers, not 1"]);
    call(
        2,
        "bias_torques",
        &[q, qd, ["--tau", "1,2"]].concat(),
        &["takes no --tau; `rne explain arguments` lists the functions that do"],
    );
    call(
        2,
        "inverse_dynamics",
        &[q, ["--tip-wrench", "tip=0,0,0,0,0,0"]].concat(),
        &["takes no --tip-wrench; `rne explain arguments` lists the functions that do"],
    );
    let (zeros, mirrored) = (["--base-rotation", "0,0,0,0,0,0,0,0,0"], ["--base-rotation", "1,0,0,0,1,0,0,0,-1"]);
    for (rotation, part) in [(zeros, "--base-rotation is no rotation: its three rows must"), (mirrored, "right-handed")]
    {
        let satellite = ["eval", "docs/satellite.yaml", "--function", "tip_jacobians"];
        fails(2, &[&satellite[..], &q, &rotation].concat(), &[part]);
    }
    // a function of a floating base, of every kind
    for function in ["floating_mass_matrix", "centroidal_momentum_matrix", "floating_potential_energy", "tip_jacobians"]
    {
        call(
            2,
            function,
            &q,
            &[function, "the file of planar2 has no `floating_base`", "Import the whole robot with a floating base"],
        );
        let emitted = ["emit", robot, "--lang", "c", "--function", function];
        fails(2, &emitted, &["the file of planar2 has no `floating_base`"]);
    }
    let certified = ["certify", robot, "--function", "inverse_dynamics_of_floating_base"];
    fails(2, &certified, &["the file of planar2 has no `floating_base`"]);
    call(
        2,
        "jacobian",
        &[&q[..], &["--trace"]].concat(),
        &["--trace", "jacobian does not compute torques", "gravity_torques"],
    );
    call(1, "kinetic_energy", &[q, ["--qd", "1e200,1"]].concat(), &["kinetic_energy overflows"]);
    fails(2, &["eval", PUMA, "--function", "actuator_torques", "--q", "1"], &["actuator_torques takes no --q"]);
}

/// A base without mass turns about the axis of its only leg without any moment: rounding makes accelerations of 1e15
/// there. With a second leg on another axis, it has accelerations.
#[test]
fn a_mass_matrix_that_is_singular_but_for_rounding_has_no_accelerations() {
    let folder = tempfile::tempdir().expect("a folder");
    let leg = |name: &str, alpha: &str| {
        format!(
            "  - {{name: {name}, parent: base, type: revolute, dh: {{gamma: 0, b: 0, theta: 0, d: 0, a: 0.2, \
             alpha: {alpha}}},\n     \
             link: {{mass: 2, com: [0.1, 0.05, 0.3], inertia: {{xx: 0.5, yy: 0.8, zz: 0.7}}}}}}\n"
        )
    };
    let robot = |name: &str, legs: &str| {
        let path = folder.path().join(name);
        let text = format!(
            "format: 2\nname: legs\nsource: own\nconvention: modified\ngravity: [0, 0, -9.81]\ntool: {{on: j1}}\n\
             floating_base: {{name: trunk, link: {{mass: 0}}}}\n\
             frames: [{{name: foot, on: j1, xyz: [0.2, 0, 0]}}]\ntips: [foot]\n\
             contacts: [{{tip: foot, kind: point}}]\njoints:\n{legs}"
        );
        fs::write(&path, text).expect("a file");
        path.to_str().expect("UTF-8").to_owned()
    };
    let (one, other) = (leg("j1", "pi/2"), leg("j2", "0.7"));
    let (hopper, biped) = (robot("hopper.yaml", &one), robot("biped.yaml", &(one + &other)));
    let call = |file: &str, function: &str, q: &str| {
        rne(&["eval", file, "--function", function, "--q", q, "--qd", q, "--tau", q])
    };
    for function in ["floating_forward_dynamics", "forward_dynamics_in_contact"] {
        let called = call(&hopper, function, "0.3");
        assert_eq!((called.status, called.out.as_str()), (1, ""), "{called:?}");
        let said = format!("{function} has no result: the mass matrix is singular at this position");
        assert!(called.err.contains(&said) && called.err.contains("`rne check` names the link"), "{called:?}");
        assert_eq!(call(&biped, function, "0.3,0.4").status, 0, "{function}");
    }
    assert_eq!(call(&hopper, "forward_dynamics", "0.3").status, 0, "the base is held still");
    assert!(fine(&["check", &hopper]).contains("no inertia resists the floating base"));
}

#[test]
fn functions_for_reading() {
    let robot = "robots/cylindrical_rpp.yaml";
    let (q, qd, qdd) = (["--q", "0.6,0.2,0.1"], ["--qd", "1.3,-0.4,0.5"], ["--qdd", "-0.7,2.1,0"]);
    let call = |function: &str, more: &[[&str; 2]]| {
        let arguments: Vec<&str> =
            ["eval", robot, "--function", function].into_iter().chain(more.iter().flatten().copied()).collect();
        fine(&arguments)
    };
    let texts = [
        call("mass_matrix", &[q]),
        call("coriolis_matrix", &[q, qd]),
        call("forward_dynamics", &[q, qd, ["--tau", "1,60,3"]]),
        call("forward_kinematics", &[q]),
        call("link_poses", &[q]),
        call("jacobian", &[q]),
        call("jacobian_rate_times_velocity", &[q, qd]),
        call("kinetic_energy", &[q, qd]),
        call("centre_of_mass", &[q]),
        call("centre_of_mass_jacobian", &[q]),
        call("regressor", &[q, qd, qdd]),
        call("inverse_dynamics_derivatives", &[q, qd, qdd]),
        call("joint_wrenches", &[q, qd, qdd]),
        call(
            "inverse_dynamics_on_moving_base",
            &[q, qd, qdd, ["--base-omega", "0,0,1"], ["--base-omega-dot", "0,0,0"], ["--base-acceleration", "0,0,0"]],
        ),
    ];
    insta::assert_snapshot!(texts.join("\n"));
}

/// What `--golden` writes is a golden file, of the torques that `eval` computes.
#[test]
fn a_golden_file_is_written() {
    let robot = "docs/desk_arm.yaml";
    let text = fine(&["eval", robot, "--golden", "3", "--set", "fore=0.25"]);
    let golden =
        rne_model::GoldenFile::read("arm.golden.csv", text.as_bytes(), 3).unwrap_or_else(|why| panic!("{why}"));
    assert_eq!(golden.states.len(), 3);
    let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    for state in &golden.states {
        let [q, qd, qdd] = [&state.q, &state.qd, &state.qdd].map(|numbers| list(numbers));
        let motion = ["--q", &q, "--qd", &qd, "--qdd", &qdd];
        let json = fine(&[&["eval", robot, "--json", "--set", "fore=0.25"], &motion[..]].concat());
        let torques = json.split(|c: char| c.is_whitespace() || "[]{},".contains(c));
        let torques: Vec<f64> = torques.filter_map(|word| word.parse().ok()).collect();
        assert_eq!(torques, state.tau, "in every bit");
    }
    let longer = fine(&["eval", robot, "--golden", "5", "--set", "fore=0.25"]);
    assert!(longer.starts_with(&text), "the same states in each run");
    for bad in ["0", "-3", "65536", "ten", "1.5"] {
        fails(2, &["eval", robot, "--golden", bad], &["a golden file has 1 to 65535 states, such as --golden 100"]);
    }
    fails(2, &["eval", robot, "--golden", "3", "--q", "0,0,0"], &["--q is for one state; with --golden"]);
    let rotors = fine(&["eval", "robots/puma560.yaml", "--golden", "1", "--rotors"]);
    assert_ne!(rotors.lines().last(), fine(&["eval", "robots/puma560.yaml", "--golden", "1"]).lines().last());
    assert!(rotors.starts_with("# Torques of puma560, with its rotors"), "{rotors}");
}

/// Limits are no part of the dynamics: what lies outside is noted beside the answer, and is no part of it.
#[test]
fn positions_outside_of_the_limits_are_noted() {
    let text = fs::read_to_string(format!("{ROOT}/{PUMA}")).expect("a robot");
    let robot = rne_model::Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
    let (_, upper) = robot.joints[1].limits.position.expect("limits");
    let beyond = format!("0,{},0,0,0,0", upper + 0.25);
    for more in [&[][..], &["--json"]] {
        let at = ["eval", PUMA, "--function", "gravity_torques", "--q"];
        let called = rne(&[&at[..], &[&beyond], more].concat());
        assert_eq!((called.status, called.err.lines().count()), (0, 1), "{called:?}");
        assert!(called.err.starts_with("note: q2 = ") && called.err.contains("outside of the limits of"), "{called:?}");
        assert!(!called.out.contains("note") && !called.out.is_empty(), "{called:?}");
        assert_eq!(rne(&[&at[..], &["0,0,0,0,0,0"], more].concat()).err, "");
    }
    // no limits, no notes
    let free = rne(&["eval", "robots/planar2.yaml", "--function", "gravity_torques", "--q", "30.05,-30.05"]);
    assert_eq!((free.status, free.err.as_str()), (0, ""));
}

/// M = [[0, 1], [1, 1]] has the eigenvalues (1 ± √5)/2: it is not singular, but no real bodies have it. With -0.5 in
/// place of -1 the pivots are no zeros, and accelerations are computed, with a note.
#[test]
fn a_mass_matrix_that_is_not_positive_definite_is_told() {
    let file = folder("eval_indefinite").join("arm.yaml");
    let row = "{type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 0, inertia: {zz:";
    let text = &format!(
        "format: 1\nname: arm\nsource: own\nconvention: modified\ngravity: [0, 0, 0]\njoints:\n  - {row} -1}}, \
         physical: false}}}}\n  - {row} 1}}}}}}\n"
    );
    let name = file.to_str().expect("UTF-8");
    let arguments = ["eval", name, "--function", "forward_dynamics", "--q", "0,0", "--tau", "1,1"];
    fs::write(&file, text).expect("a robot file");
    fails(1, &arguments, &["is not finite: the mass matrix is not positive definite at this position"]);
    fs::write(&file, text.replace("zz: -1", "zz: -0.5")).expect("a robot file");
    let called = rne(&arguments);
    assert!(called.err.contains("note: the mass matrix is not positive definite"), "{}", called.err);
    // there is no note on bodies
    fs::write(&file, text.replace("zz: -1", "zz: 1")).expect("a robot file");
    assert!(!rne(&arguments).err.contains("positive definite"));
}

/// A warning that `rne check` prints is counted on standard error; the numbers are on standard output as before.
#[test]
fn warnings_of_the_robot_file_are_counted() {
    let link = "{mass: 1, com: [0, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}";
    let joint = format!("  - {{type: revolute, dh: {{theta: 0, d: 0.1, a: 0.8, alpha: 0}}, link: {link}}}\n");
    let head = "format: 1\nname: p\nsource: own\nconvention: standard\ngravity: [0, -9.81, 0]\njoints:\n";
    let text = format!("{head}{}", joint.repeat(3));
    let eval = ["eval", "-", "--json", "--function", "gravity_torques", "--q", "0,0,0"];
    let called = crate::call::rne_reading(&eval, &text);
    assert_eq!(called.status, 0, "{called:?}");
    assert_eq!(called.err, "note: 1 warning in the robot file; rne check - shows it\n");
    assert!(serde_json::from_str::<Value>(&called.out).is_ok(), "{}", called.out);
    assert_eq!(rne(&["eval", "planar1", "--q", "0", "--function", "gravity_torques"]).err, "");
}

/// Degrees on the command line, with their unit and without.
#[test]
fn degrees_of_positions() {
    let at = |q: &str| rne(&["eval", "planar2", "--q", q, "--qd", "0,0", "--qdd", "0,0"]);
    let radians = at("pi/6,-deg(45)");
    assert_eq!((at("30deg,-45deg").out, radians.err.as_str()), (radians.out, ""));
    let said = at("30,45");
    let told = "j1 is at 30 rad, more than a full turn; if this is in degrees, write 30deg";
    assert!(said.status == 0 && said.err.contains(told), "{said:?}");
    // once, where a joint has limits, too
    let limited = rne(&["eval", "puma560", "--q", "90,0,0,0,0,0"]);
    assert_eq!(limited.err.matches("degrees").count(), 1, "{limited:?}");
    let pose = "--base-pose";
    let turned = |pose_of: &str| {
        rne(&["eval", "docs/satellite.yaml", "--q", "0,0", "--function", "floating_potential_energy", pose, pose_of])
    };
    assert!(turned("0,0,0.5,90,0,0").err.contains("if the roll of --base-pose, 90 rad, is in degrees, write 90deg"));
    assert_eq!(turned("0,0,0.5,90deg,0,0").err, "");
    let far = rne(&["eval", "planar2", "--q", "0,0", "--payload", "1,100,50,0"]);
    assert!(far.err.contains("is 112 m from its frame; if this is in millimetres, write mm(100)"), "{far:?}");
    for right in ["0.3,6.2", "30deg,400deg"] {
        assert_eq!(at(right).err, "", "{right}");
    }
}

/// The table of another robot, numbers beside a table, and the names of a base and of a tip that mean two things.
#[test]
fn what_may_be_meant_for_another_robot_is_said() {
    let folder = folder("of_another_robot");
    let write = |name: &str, text: &str| {
        fs::write(folder.join(name), text).expect("a file");
        folder.join(name).display().to_string()
    };
    let wide = write("wide.csv", "q1,q2,q3\n0,0,0\n");
    let states = ["eval", "planar2", "--function", "gravity_torques", "--states", &wide];
    let called = rne(&states);
    assert_eq!(called.status, 0, "{called:?}");
    assert!(called.err.contains("the column `q3` belongs to no joint"), "{}", called.err);
    let called = rne(&[&states[..], &["--payload", "1,0,0,0"]].concat());
    assert_eq!(called.status, 2);
    assert!(called.err.contains("has columns for the payload"), "{}", called.err);
    let called = rne(&[&states[..], &["--q", "0,0"]].concat());
    assert!(called.err.contains("--q is for one state"), "{}", called.err);

    let two = write(
        "two.yaml",
        "{format: 2, name: two, source: own, convention: modified, gravity: [0, 0, -9.81], floating_base: {name: bus, \
         link: {mass: 5, inertia: {xx: 1, yy: 1, zz: 1}}}, frames: [{name: tip, on: j1, xyz: [0.1, 0, 0]}], joints: [\
         {name: j1, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1, com: [0.3, 0, 0], inertia: \
         {xx: 0.1, yy: 0.1, zz: 0.1}}}, {name: j2, type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: pi/2}, link: \
         {mass: 1, com: [0.1, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}}]}",
    );
    let called = rne(&["eval", &two, "--q", "1,2", "--tip-wrench", "tip=0,0,0,3,5,7"]);
    assert_eq!(called.status, 2);
    assert!(called.err.contains("also a frame of its file"), "{}", called.err);
    for base in ["base", "bus"] {
        let called = rne(&["eval", &two, "--q", "1,2", "--function", "jacobian", "--frame", base]);
        assert!(called.err.contains(&format!("`{base}` is the base of two")), "{}", called.err);
        let payload = ["--payload", "1,0,0,0", "--payload-on", base];
        let called = rne(&[&["eval", &two, "--q", "1,2", "--function", "gravity_torques"][..], &payload].concat());
        assert!(called.err.contains("into the list `bodies`"), "{}", called.err);
    }
}

/// Every command that computes with a robot file says that the file has warnings; with other values of parameters, it
/// says which.
#[test]
fn every_command_counts_the_warnings_of_its_robot_file() {
    let folder = folder("warnings");
    let link = "{mass: 1, com: [-0.5, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}";
    let text = |alpha: &str| {
        format!(
            "{{format: 1, name: two, source: own, convention: standard, gravity: [0, -9.81, 0], parameters: {{a: 1}}, \
             joints: [{{type: revolute, dh: {{theta: 0, d: 0, a: a, alpha: {alpha}}}, link: {link}}}, {{type: \
             revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}, link: {link}}}]}}"
        )
    };
    let path = folder.join("two.yaml").display().to_string();
    fs::write(&path, text("90")).expect("a file");
    let out = |name: &str| folder.join(name).display().to_string();
    let (report, plot, fmu, sheets) = (out("report.html"), out("plot.svg"), out("two.fmu"), out("sheets"));
    let state = ["--q", "0.1,0.2", "--qd", "1,1", "--qdd", "1,1"];
    let commands: [Vec<&str>; 16] = [
        vec!["show", &path],
        vec!["show", &path, "--symbolic"],
        vec!["emit", &path],
        vec!["certify", &path, "--cc", "none"],
        vec!["ops", &path],
        vec!["report", &path, "-o", &report],
        [&["eval", &path][..], &state].concat(),
        vec!["eval", &path, "--golden", "2"],
        vec!["worksheet", &path, "--seed", "1", "-o", &sheets, "ada"],
        [&["diagnose", &path][..], &state, &["--tau", "1,2"]].concat(),
        vec!["plot", &path, "-o", &plot],
        vec!["excite", &path, "--seconds", "0.01"],
        vec!["search", &path, "--seconds", "0.01"],
        vec!["convert", &path, "--convention", "modified"],
        vec!["export", &path, "--urdf"],
        vec!["export", &path, "--fmu", "--no-build", "-o", &fmu],
    ];
    for command in commands {
        let called = rne(&command);
        let times = called.err.matches("1 warning in the robot file").count();
        assert_eq!(times, 1, "{command:?}: {}", called.err);
    }
    fs::write(&path, text("0")).expect("a file");
    let called = rne(&["eval", &path, "--q", "0,0", "--function", "gravity_torques", "--set", "a=500"]);
    assert_eq!(called.err, "note: 1 warning with a = 500: the length `a` = 500 m is over 20 m\n");
    let called = rne(&["eval", &path, "--q", "90.25,45", "--function", "gravity_torques"]);
    assert!(called.err.contains("if this is in degrees, write 90.25deg"), "{}", called.err);
}
