//! `rne eval`: the runtime's numbers, compared with those of the reference files.

use std::fs;

use crate::call::{ROOT, fails, fine};
use serde_json::Value;

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
    let [link] = json["trace"].as_array().expect("a list").as_slice() else { panic!("one link: {json}") };
    let (a, q, qd, qdd) = (0.5, 0.6_f64, 1.3, -0.7);
    close(&numbers(&link["omega"]), &[0.0, 0.0, qd]);
    close(&numbers(&link["velocity"]), &[0.0, a / 2.0 * qd, 0.0]);
    close(&numbers(&link["acceleration"]), &[-a / 2.0 * qd * qd, a / 2.0 * qdd, 0.0]);
    assert_eq!(json["result"][0], link["tau"]);
    let json: Value = serde_json::from_str(&call(&["--trace", "--json", "--axes", "base"])).expect("JSON");
    close(&numbers(&json["trace"][0]["velocity"]), &[-a / 2.0 * qd * q.sin(), a / 2.0 * qd * q.cos(), 0.0]);
    assert_eq!(json["trace"][0]["gravity"], serde_json::json!([0.0, -9.81, 0.0]));
}

#[test]
fn a_prismatic_joint_in_the_worksheet() {
    let state = ["--q", "0.6,0.2,0.1", "--qd", "1.3,-0.4,0.5", "--qdd", "-0.7,2.1,0"];
    let arguments: Vec<&str> =
        ["eval", "robots/cylindrical_rpp.yaml"].iter().chain(&state).chain(&["--trace"]).copied().collect();
    insta::assert_snapshot!(fine(&arguments));
}

#[test]
fn arguments_that_do_not_fit() {
    let robot = "robots/cylindrical_rpp.yaml";
    let three = "1,2,3";
    let call = |status, more: &[&str], parts: &[&str]| {
        let arguments: Vec<&str> = ["eval", robot].iter().chain(more).copied().collect();
        fails(status, &arguments, parts);
    };
    call(2, &["--q", three, "--qd", three], &["needs --qdd", "waist, lift, reach"]);
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
        call(2, &["--q", bad], &["--q", "number 2", "is none", if bad.contains('e') { "too large" } else { "finite" }]);
    }
    call(2, &["--q", "1,90°,3"], &["number 2", "write `deg(90)`"]);
    for bad in ["1,x,3", "1,,3"] {
        call(2, &["--q", bad], &["number 2"]);
    }
    call(1, &["--q", three, "--qd", "1e200,1,1", "--qdd", three], &["overflows"]);
}
