//! The logarithm of poses, near 0 and near π too.

use std::f64::consts::PI;

use crate::common::Numbers;
use rne_runtime::Pose;

fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Rodrigues: v cos θ + a × v sin θ + a (a · v)(1 - cos θ), for an axis and an angle; θ = base + rest, so that an angle
/// beside π has all its digits.
fn turned(axis: [f64; 3], (base_is_pi, rest): (bool, f64), v: [f64; 3]) -> [f64; 3] {
    let sign = if base_is_pi { -1.0 } else { 1.0 };
    let (sin, cos) = (sign * rest.sin(), sign * rest.cos());
    let versine = if base_is_pi { 2.0 * (rest / 2.0).cos().powi(2) } else { 2.0 * (rest / 2.0).sin().powi(2) };
    let across = cross(axis, v);
    let along: f64 = (0..3).map(|i| axis[i] * v[i]).sum();
    std::array::from_fn(|i| v[i] * cos + across[i] * sin + axis[i] * along * versine)
}

fn rotation(axis: [f64; 3], angle: (bool, f64)) -> [[f64; 3]; 3] {
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|unit| turned(axis, angle, unit));
    std::array::from_fn(|row| columns.map(|column| column[row]))
}

fn unit(numbers: &mut Numbers) -> [f64; 3] {
    loop {
        let v: [f64; 3] = numbers.array(1.0);
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.1 {
            return v.map(|x| x / length);
        }
    }
}

/// The exponential by its power series: products of 4 × 4 matrices of a part of the twist, then squared.
fn exponential(twist: [f64; 6]) -> Pose<f64> {
    const HALVINGS: i32 = 12;
    let [x, y, z, a, b, c] = twist.map(|x| x / 2.0_f64.powi(HALVINGS));
    let m = [[0.0, -c, b, x], [c, 0.0, -a, y], [-b, a, 0.0, z], [0.0; 4]];
    let times = |p: [[f64; 4]; 4], q: [[f64; 4]; 4]| -> [[f64; 4]; 4] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| p[i][k] * q[k][j]).sum()))
    };
    // exp(M) - 1, so that squaring loses nothing: (1 + E)² - 1 = 2 E + E²
    let (mut sum, mut term) = (m, m);
    for n in 2..10 {
        term = times(term, m).map(|row| row.map(|x| x / f64::from(n)));
        sum = std::array::from_fn(|i| std::array::from_fn(|j| sum[i][j] + term[i][j]));
    }
    for _ in 0..HALVINGS {
        let square = times(sum, sum);
        sum = std::array::from_fn(|i| std::array::from_fn(|j| 2.0 * sum[i][j] + square[i][j]));
    }
    let rotation = std::array::from_fn(|i| std::array::from_fn(|j| sum[i][j] + if i == j { 1.0 } else { 0.0 }));
    Pose { rotation, translation: [sum[0][3], sum[1][3], sum[2][3]] }
}

#[test]
fn a_pose_is_rigid_if_its_rotation_is_one() {
    let [s, c] = [0.6_f32, 0.8].map(f64::from);
    let pose = |rotation: [[f64; 3]; 3]| Pose { rotation, translation: [0.0; 3] };
    let turned = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    assert!(pose(turned).is_rigid() && pose([[f64::NAN; 3]; 3]).is_rigid());
    for (row, column, off) in [(0, 0, 2e-4), (0, 1, 2e-3), (1, 0, -2e-3), (2, 0, 2e-4), (2, 2, -2.0)] {
        let mut wrong = turned;
        wrong[row][column] += off;
        assert!(!pose(wrong).is_rigid(), "{wrong:?}");
    }
    assert!(!pose([[0.0; 3]; 3]).is_rigid());
}

#[test]
fn the_angle_is_found_from_0_to_pi() {
    let mut numbers = Numbers::new(5);
    let near_zero = (0..=16).map(|n| (false, 10.0_f64.powi(-n)));
    let near_pi = (0..=16).map(|n| (true, -(10.0_f64.powi(-n))));
    for angle in near_zero.chain(near_pi).chain([(false, 2.0), (false, 3.0), (false, 1e-100), (true, -1e-100)]) {
        for _ in 0..50 {
            let axis = unit(&mut numbers);
            let theta = if angle.0 { PI + angle.1 } else { angle.1 };
            let log = Pose { rotation: rotation(axis, angle), translation: [0.0; 3] }.rotation_log();
            let same = (0..3).map(|i| log[i] * axis[i]).sum::<f64>() >= 0.0;
            // at π both signs of the axis are the same rotation
            let sign = if same || PI - theta > 1e-12 { 1.0 } else { -1.0 };
            for i in 0..3 {
                // rounding of the elements of R, 1e-16, moves the vector by as much
                let error = (log[i] - sign * theta * axis[i]).abs();
                assert!(error < 2e-15, "{angle:?} {axis:?}: {log:?}");
            }
        }
    }
}

#[test]
fn no_rotation_is_zero_and_half_turns_are_exact() {
    assert_eq!(Pose::<f64>::identity().log(), [0.0; 6]);
    for (diagonal, axis) in [([1.0, -1.0, -1.0], 0), ([-1.0, 1.0, -1.0], 1), ([-1.0, -1.0, 1.0], 2)] {
        let rotation: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { diagonal[i] } else { 0.0 }));
        let log = Pose { rotation, translation: [0.0; 3] }.rotation_log();
        for (i, x) in log.iter().enumerate() {
            assert_eq!(x.abs(), if i == axis { PI } else { 0.0 }, "{log:?}");
        }
    }
}

#[test]
fn the_twist_leads_to_the_pose() {
    let mut numbers = Numbers::new(9);
    let scales = (1..12).map(|n| 10.0_f64.powi(-n)).chain([0.05, 0.1, 0.105, 0.11, 0.3, 0.7, 0.9, 0.999, 0.999_999_9]);
    for scale in scales {
        for _ in 0..50 {
            let (axis, linear): ([f64; 3], [f64; 3]) = (unit(&mut numbers), numbers.array(1.0));
            let angular = axis.map(|x| x * PI * scale);
            let twist = [linear[0], linear[1], linear[2], angular[0], angular[1], angular[2]];
            let log = exponential(twist).log();
            for (found, expected) in log.iter().zip(twist) {
                assert!((found - expected).abs() < 1e-13, "{twist:?} {log:?}");
            }
        }
    }
}

#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn single_precision_uses_its_own_digits() {
    let rotation = rotation([0.6, 0.0, 0.8], (false, 2.5)).map(|row| row.map(|x| x as f32));
    let log = Pose { rotation, translation: [0.1_f32, 0.2, 0.3] }.log();
    for (found, expected) in log[3..].iter().zip([1.5_f32, 0.0, 2.0]) {
        assert!((found - expected).abs() < 1e-6, "{log:?}");
    }
}

#[test]
fn a_pose_undoes_its_inverse_and_errors_point_to_the_target() {
    let mut numbers = Numbers::new(3);
    for _ in 0..100 {
        let pose = |numbers: &mut Numbers| exponential(numbers.array(1.5));
        let (a, b) = (pose(&mut numbers), pose(&mut numbers));
        for x in a.then(&a.inverse()).log() {
            assert!(x.abs() < 1e-15 * 10.0, "{a:?}");
        }
        // turning by the error in world axes gives the target
        let error = a.error_to(&b);
        let turn = exponential([0.0, 0.0, 0.0, error[3], error[4], error[5]]);
        let reached = turn.then(&Pose { translation: [0.0; 3], ..a });
        for (x, y) in reached.rotation.as_flattened().iter().zip(b.rotation.as_flattened()) {
            assert!((x - y).abs() < 1e-14, "{a:?} {b:?}");
        }
        let way: [f64; 3] = std::array::from_fn(|i| b.translation[i] - a.translation[i]);
        assert_eq!(error[..3], way);
    }
}

/// A quaternion that is not of length 1 is the same rotation in the orders of Pinocchio and of MuJoCo.
#[test]
fn quaternions_of_any_length_are_rotations() {
    let mut numbers = Numbers::new(91);
    for _ in 0..100 {
        let (axis, angle): (_, [f64; 1]) = (unit(&mut numbers), numbers.array(3.0));
        let (sin, cos) = (angle[0] / 2.0).sin_cos();
        let [length]: [f64; 1] = numbers.array(5.0);
        let [w, x, y, z] = [cos, axis[0] * sin, axis[1] * sin, axis[2] * sin].map(|part| part * length);
        let expected = rotation(axis, (false, angle[0]));
        for found in
            [Pose::from_pinocchio(&[0.0, 0.0, 0.0, x, y, z, w]), Pose::from_mujoco(&[0.0, 0.0, 0.0, w, x, y, z])]
        {
            for (found, expected) in found.rotation.as_flattened().iter().zip(expected.as_flattened()) {
                assert!((found - expected).abs() < 1e-13, "{found} {expected} for the length {length}");
            }
        }
    }
    assert!(!Pose::<f64>::from_mujoco(&[0.0; 7]).rotation[0][0].is_finite());
}
