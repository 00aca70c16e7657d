//! States of floating bases in the vectors of other tools, which `tests/reference/conventions.py` got from these tools.

use rne::{BaseMotion, BaseTwist, Pose, Quaternion, Wrench};
use serde_json::Value;

use crate::check::{flat, json, numbers, relative_error};

const TOLERANCE: f64 = 1e-14;

fn golden() -> Value {
    json("tests/functions/floating/conventions.json")
}

fn vector<const N: usize>(part: &Value, key: &str) -> [f64; N] {
    numbers(&part[key]).try_into().unwrap_or_else(|found| panic!("{key}: {found:?}"))
}

fn pose(base: &Value) -> Pose<f64> {
    let [a, b, c, d, e, f, g, h, i] = vector(base, "rotation");
    Pose { rotation: [[a, b, c], [d, e, f], [g, h, i]], translation: vector(base, "position") }
}

#[track_caller]
fn same(found: impl AsRef<[f64]>, expected: impl AsRef<[f64]>) {
    let error = relative_error(found.as_ref(), expected.as_ref());
    assert!(error < TOLERANCE, "{error:.1e}: {:?}, not {:?}", found.as_ref(), expected.as_ref());
}

fn check(motion: &BaseMotion<f64>, base: &Value) {
    let turn = pose(base).rotation;
    let world: [f64; 3] = vector(base, "gravity");
    let gravity: Vec<f64> = (0..3).map(|i| (0..3).map(|k| turn[k][i] * world[k]).sum()).collect();
    let told = ["omega", "omega_dot", "velocity", "acceleration"].map(|key| numbers(&base[key]));
    same([motion.omega, motion.omega_dot, motion.velocity, motion.acceleration].concat(), told.concat());
    same(motion.gravity, gravity);
}

#[test]
fn states_of_pinocchio() {
    let golden = golden();
    let (base, tool) = (&golden["base"], &golden["pinocchio"]);
    let ([q, v, a], world) = (["q", "v", "a"].map(|key| numbers(&tool[key])), vector(base, "gravity"));
    let (q, v, a): ([f64; 7], [f64; 6], [f64; 6]) =
        (q.try_into().expect("7"), v.try_into().expect("6"), a.try_into().expect("6"));
    let motion = BaseMotion::from_pinocchio(&q, &v, &a, world);
    check(&motion, base);
    same(motion.to_pinocchio(), a);
    same(flat(Pose::from_pinocchio(&q).rotation), numbers(&base["rotation"]));
    let back = pose(base).to_pinocchio();
    // q and -q are one rotation
    let sign = if back[6] * q[6] < 0.0 { -1.0 } else { 1.0 };
    same(back, [q[0], q[1], q[2], sign * q[3], sign * q[4], sign * q[5], sign * q[6]]);
    same(BaseTwist::from_pinocchio(&v).linear, numbers(&base["velocity"]));
    same(BaseTwist::from_pinocchio(&v).to_pinocchio(), v);
    let wrench = Wrench { force: vector(base, "force"), moment: vector(base, "moment") };
    same(wrench.to_pinocchio(), numbers(&tool["force"]));
}

#[test]
fn states_of_mujoco() {
    let golden = golden();
    let (base, tool) = (&golden["base"], &golden["mujoco"]);
    let (q, v, a): ([f64; 7], [f64; 6], [f64; 6]) = (vector(tool, "q"), vector(tool, "v"), vector(tool, "a"));
    let motion = BaseMotion::from_mujoco(&q, &v, &a, vector(base, "gravity"));
    check(&motion, base);
    let placed = Pose::from_mujoco(&q);
    same(motion.to_mujoco(&placed), a);
    same(flat(placed.rotation), numbers(&base["rotation"]));
    let back = pose(base).to_mujoco();
    let sign = if back[3] * q[3] < 0.0 { -1.0 } else { 1.0 };
    same(back, [q[0], q[1], q[2], sign * q[3], sign * q[4], sign * q[5], sign * q[6]]);
    let twist = BaseTwist::from_mujoco(&placed, &v);
    same(twist.linear, numbers(&base["velocity"]));
    same(twist.to_mujoco(&placed), v);
    let wrench = Wrench { force: vector(base, "force"), moment: vector(base, "moment") };
    same(wrench.to_mujoco(&placed), numbers(&tool["force"]));
}

/// The lines of Drake, iDynTree and dynibo in docs/reference/conventions.md.
#[test]
fn tools_in_world_axes() {
    let golden = golden();
    let base = &golden["base"];
    let turn = pose(base).rotation;
    let in_world = |key: &str| -> Vec<f64> {
        let vector: [f64; 3] = vector(base, key);
        turn.iter().map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum()).collect()
    };
    for (tool, linear_first) in [("drake", false), ("idyntree", true), ("dynibo", false)] {
        for (key, [linear, angular]) in
            [("v", ["velocity", "omega"]), ("a", ["acceleration", "omega_dot"]), ("force", ["force", "moment"])]
        {
            let (linear, angular) = (in_world(linear), in_world(angular));
            let expected = if linear_first { [linear, angular] } else { [angular, linear] };
            same(numbers(&golden[tool][key]), expected.concat());
        }
    }
    let (quaternion, position) = (numbers(&golden["drake"]["q"])[..4].to_vec(), numbers(&base["position"]));
    assert_eq!(numbers(&golden["drake"]["q"])[4..], position);
    assert_eq!(numbers(&golden["mujoco"]["q"]), [position.clone(), quaternion.clone()].concat());
    assert_eq!(numbers(&golden["dynibo"]["q"]), [&position[..], &quaternion[1..], &quaternion[..1]].concat());
    assert_eq!(numbers(&golden["dynibo"]["q"]), numbers(&golden["pinocchio"]["q"]));
}

/// MuJoCo's sensors on a site of the body.
#[test]
fn readings_of_an_inertial_measurement_unit() {
    let golden = golden();
    let (base, unit) = (&golden["base"], &golden["imu"]);
    let turn = Quaternion::from_wxyz(vector(unit, "quaternion"));
    let imu = Pose { rotation: turn.rotation(), translation: vector(unit, "position") };
    let omega_dot: [f64; 3] = vector(base, "omega_dot");
    // the unit has no sensor of it
    let rate = imu.inverse().rotation.map(|row| row.iter().zip(omega_dot).map(|(a, b)| a * b).sum());
    let motion = BaseMotion::from_imu_at(&imu, vector(unit, "gyroscope"), rate, vector(unit, "accelerometer"));
    let placed = pose(base).inverse().rotation;
    let gravity: [f64; 3] = vector(base, "gravity");
    let gravity = placed.map(|row| row.iter().zip(gravity).map(|(a, b)| a * b).sum::<f64>());
    let acceleration: [f64; 3] = vector(base, "acceleration");
    let felt: Vec<f64> = acceleration.iter().zip(gravity).map(|(a, g)| a - g).collect();
    same([motion.omega, motion.omega_dot].concat(), [vector::<3>(base, "omega"), omega_dot].concat());
    same(motion.acceleration, felt);
    assert_eq!(motion.gravity, [0.0; 3]);
    let there = BaseMotion::from_imu(motion.omega, motion.omega_dot, motion.acceleration);
    assert_eq!(there, motion);
}

/// A thousand steps of a gyroscope with constant readings are one turn by their sum.
#[test]
fn quaternions_are_integrated() {
    let omega = [0.3, -1.2, 2.0];
    let start = Quaternion::from_wxyz([0.5, -0.5, 0.5, 0.5]);
    let steps = (0..1000).fold(start, |turn, _| turn.turned_by(omega.map(|x: f64| x * 2e-3)));
    let once = start.turned_by(omega.map(|x| x * 2.0));
    same(flat(steps.rotation()), flat(once.rotation()));
    let length: f64 = steps.to_wxyz().iter().map(|x| x * x).sum();
    assert!((length - 1.0).abs() < 1e-15, "{length}");
    // the logarithm of a pose, which knows no quaternion, turns it back
    let relative = Pose { rotation: Quaternion::identity().turned_by(omega).rotation(), translation: [0.0; 3] };
    same(relative.rotation_log(), omega);
    let tiny = Quaternion::identity().turned_by([1e-9, 0.0, 2e-12]);
    assert_eq!(tiny.to_wxyz(), [1.0, 5e-10, 0.0, 1e-12]);
    let again = Quaternion::of_rotation(&once.rotation());
    let sign = if again.w * once.w < 0.0 { -1.0 } else { 1.0 };
    same(again.to_xyzw(), once.to_xyzw().map(|x| sign * x));
}
