//! An independent reader of YAML, with serde's own number parsing, agrees with ours on documents of plain numbers.

use rne_model::{Convention, Joint, JointKind, Reader};
use serde_yaml::Value;

const PLAIN: &str = r#"
# Plain numbers only: serde knows no expressions.
format: 1
name: plain            # a comment
source: >
  folded
  text
convention: modified
gravity: [0.5, -0.25, -9.81]
base: {xyz: [1, 2.5, -3e-1], rpy: [0.1, -0.2, 0.3]}
joints:
  - name: "quoted name"
    type: revolute
    dh: &row {theta: 0.1, d: 4.0e-1, a: -0, alpha: 1}
    link: {mass: 2.5, com: [0.01, .02, -0.03], inertia: {xx: 0.1, yy: 0.12, zz: 0.02, xy: 1e-3, xz: -2E-3, yz: 3.0e-3}}
    limits:
      position:
        - -2.5
        - 2.5
      velocity: 2
      effort: 50.125
    motor: {inertia: 2.0e-4, gear_ratio: -62.6111, viscous: 1.48e-3, coulomb: [0.395, -0.435],
            coulomb_width: 0.02, coulomb_displacement: 0.003}
  - {name: 'it''s', type: prismatic, dh: *row, link: {mass: 0.1234567890123456789}}
"#;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value:?} is not a number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_sequence().unwrap().iter().map(number).collect()
}

fn or_zero(value: &Value, key: &str) -> f64 {
    value.get(key).map_or(0.0, number)
}

#[test]
fn serde_reads_the_same_document() {
    let robot = Reader::new("plain.yaml").read(PLAIN).unwrap().robot;
    let value: Value = serde_yaml::from_str(PLAIN).unwrap();
    assert_eq!(robot.name, value["name"].as_str().unwrap());
    assert_eq!(robot.source, value["source"].as_str().unwrap().trim_end());
    assert_eq!(robot.convention, Convention::Modified);
    assert_eq!(robot.gravity[..], numbers(&value["gravity"])[..]);
    assert_eq!(robot.base.xyz[..], numbers(&value["base"]["xyz"])[..]);
    assert_eq!(robot.base.rpy.map(|angle| angle.radians)[..], numbers(&value["base"]["rpy"])[..]);
    let joints = value["joints"].as_sequence().unwrap();
    assert_eq!(robot.joints.len(), joints.len());
    for (joint, value) in robot.joints.iter().zip(joints) {
        assert_joint(joint, value);
    }
}

fn assert_joint(joint: &Joint, value: &Value) {
    assert_eq!(joint.name, value["name"].as_str().unwrap());
    let kind = value["type"].as_str().unwrap();
    assert_eq!(joint.row.kind == JointKind::Revolute, kind == "revolute");
    let dh = joint.row.dh;
    let ours = [dh.theta.radians, dh.d, dh.a, dh.alpha.radians];
    assert_eq!(ours, ["theta", "d", "a", "alpha"].map(|key| number(&value["dh"][key])));
    let link = joint.row.link;
    assert_eq!(link.mass, number(&value["link"]["mass"]));
    if let Some(com) = value["link"].get("com") {
        assert_eq!(link.com[..], numbers(com)[..]);
    }
    if let Some(inertia) = value["link"].get("inertia") {
        let i = link.inertia;
        let theirs = ["xx", "yy", "zz", "xy", "xz", "yz"].map(|key| or_zero(inertia, key));
        assert_eq!([i.xx, i.yy, i.zz, i.xy, i.xz, i.yz], theirs);
    }
    if let Some(limits) = value.get("limits") {
        let (lower, upper) = joint.limits.position.unwrap();
        assert_eq!([lower, upper][..], numbers(&limits["position"])[..]);
        assert_eq!(joint.limits.velocity, limits["velocity"].as_f64());
        assert_eq!(joint.limits.effort, limits["effort"].as_f64());
    }
    if let Some(motor) = value.get("motor") {
        let ours = joint.motor.unwrap();
        assert_eq!(
            [ours.inertia, ours.gear_ratio, ours.viscous],
            ["inertia", "gear_ratio", "viscous"].map(|key| number(&motor[key]))
        );
        assert_eq!(ours.coulomb[..], numbers(&motor["coulomb"])[..]);
        assert_eq!(joint.coulomb_width, motor.get("coulomb_width").and_then(Value::as_f64));
        assert_eq!(joint.coulomb_displacement, motor.get("coulomb_displacement").and_then(Value::as_f64));
    }
}
