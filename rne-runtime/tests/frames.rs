//! Frames on links: against the arm that ends at the frame, against products of 4 × 4 matrices, and against the motion.
#![cfg(all(feature = "arm", feature = "std"))]

use crate::common::{Numbers, SIX_Q, SIX_QD, SIX_WRENCH, six_joints, tool};
use rne_model::{Angle, Convention, FixedFrame, Joint, JointKind, Robot, Transform};
use rne_runtime::{Arm, Dual, DynArm, Kinematics, Pose};

type Matrix4 = [[f64; 4]; 4];

fn product(a: Matrix4, b: Matrix4) -> Matrix4 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn turn_x(angle: f64) -> Matrix4 {
    let (s, c) = angle.sin_cos();
    [[1.0, 0.0, 0.0, 0.0], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn turn_y(angle: f64) -> Matrix4 {
    let (s, c) = angle.sin_cos();
    [[c, 0.0, s, 0.0], [0.0, 1.0, 0.0, 0.0], [-s, 0.0, c, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn turn_z(angle: f64) -> Matrix4 {
    let (s, c) = angle.sin_cos();
    [[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn shift([x, y, z]: [f64; 3]) -> Matrix4 {
    [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]
}

fn placed(transform: &Transform) -> Matrix4 {
    let [roll, pitch, yaw] = transform.rpy.map(|angle| angle.radians);
    product(shift(transform.xyz), product(turn_z(yaw), product(turn_y(pitch), turn_x(roll))))
}

/// The pose of a frame by the definition of the table.
fn by_hand(robot: &Robot, frame: &FixedFrame, q: &[f64]) -> Matrix4 {
    let mut pose = placed(&robot.base);
    for (joint, q) in robot.joints.iter().zip(q).take(frame.on.map_or(0, |on| on + 1)) {
        let dh = joint.row.dh;
        let (theta, d) = match joint.row.kind {
            JointKind::Revolute => (dh.theta.radians + q, dh.d),
            JointKind::Prismatic => (dh.theta.radians, dh.d + q),
        };
        let (a, alpha) = (shift([dh.a, 0.0, 0.0]), turn_x(dh.alpha.radians));
        let along_z = product(turn_z(theta), shift([0.0, 0.0, d]));
        pose = product(
            pose,
            match robot.convention {
                Convention::Standard => product(along_z, product(a, alpha)),
                Convention::Modified => product(product(alpha, a), along_z),
            },
        );
    }
    product(pose, placed(&frame.placement))
}

fn placement(numbers: &mut Numbers) -> Transform {
    Transform { xyz: numbers.array(0.5), rpy: numbers.array(3.0).map(Angle::new) }
}

/// An arm of 1 to 9 joints of both kinds, some of its angles right ones.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a small positive number
fn random_robot(numbers: &mut Numbers) -> Robot {
    let text = "{format: 1, name: r, source: t, convention: standard, gravity: [0, 0, -9.81], joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}}]}";
    let mut robot = Robot::from_yaml(text).expect("valid");
    let model = robot.joints[0].clone();
    let dof = 1 + (4.5 * (numbers.next() + 1.0)) as usize;
    let angle = |numbers: &mut Numbers| match numbers.next() {
        x if x < -0.4 => Angle::new(std::f64::consts::FRAC_PI_2),
        x if x < 0.0 => Angle::new(0.0),
        x => Angle::new(3.0 * x),
    };
    robot.convention = if numbers.next() < 0.0 { Convention::Standard } else { Convention::Modified };
    robot.joints = (0..dof)
        .map(|index| {
            let mut joint = Joint { name: format!("joint{}", index + 1), ..model.clone() };
            joint.row.kind = if numbers.next() < -0.4 { JointKind::Prismatic } else { JointKind::Revolute };
            joint.row.dh.theta = angle(numbers);
            joint.row.dh.alpha = angle(numbers);
            [joint.row.dh.a, joint.row.dh.d] = numbers.array(0.6);
            joint.row.link.com = numbers.array(0.3);
            joint.row.link.mass = 1.0;
            joint
        })
        .collect();
    (robot.base, robot.tool) = (placement(numbers), placement(numbers));
    robot
}

fn assert_near(actual: &[f64], expected: &[f64], what: &str) {
    assert_eq!(actual.len(), expected.len(), "{what}");
    for (a, e) in actual.iter().zip(expected) {
        assert!((a - e).abs() <= 1e-12 * (1.0 + e.abs()), "{what}: {actual:?} {expected:?}");
    }
}

fn numbers_of(pose: &Pose<f64>) -> Vec<f64> {
    pose.rotation.as_flattened().iter().chain(&pose.translation).copied().collect()
}

/// Calls `check` with random arms and a frame on the base and on every link.
fn every_frame(arms: usize, check: impl Fn(&Robot, FixedFrame, &[f64], &[f64])) {
    let mut numbers = Numbers::new(17);
    for _ in 0..arms {
        let robot = random_robot(&mut numbers);
        let q: Vec<f64> = (0..robot.dof()).map(|_| 2.0 * numbers.next()).collect();
        let qd: Vec<f64> = (0..robot.dof()).map(|_| numbers.next()).collect();
        for on in [None].into_iter().chain((0..robot.dof()).map(Some)) {
            check(&robot, FixedFrame { on, placement: placement(&mut numbers) }, &q, &qd);
        }
    }
}

fn arm_at(robot: &Robot, frame: FixedFrame) -> DynArm {
    DynArm::from_robot(robot).at_frame(frame).expect("the link is there")
}

#[test]
fn poses_are_products_of_matrices() {
    every_frame(500, |robot, frame, q, _| {
        let expected = by_hand(robot, &frame, q);
        let pose = arm_at(robot, frame).forward_kinematics(q).expect("lengths");
        let rows = expected.iter().take(3).flat_map(|row| row[..3].to_vec());
        let expected: Vec<f64> = rows.chain((0..3).map(|i| expected[i][3])).collect();
        assert_near(&numbers_of(&pose), &expected, &format!("{frame:?} of {robot:?}"));
    });
}

#[test]
fn a_frame_is_the_tip_of_the_arm_that_ends_there() {
    every_frame(500, |robot, frame, q, qd| {
        let Some(on) = frame.on else { return };
        let mut short = Robot { tool: frame.placement, ..robot.clone() };
        short.joints.truncate(on + 1);
        let (arm, short) = (arm_at(robot, frame), DynArm::from_robot(&short));
        let (q_short, qd_short, zeros) = (&q[..=on], &qd[..=on], &vec![0.0; on + 1][..]);
        let rows = arm.jacobian(q).expect("lengths");
        for (row, expected) in rows.iter().zip(short.jacobian(q_short).expect("lengths")) {
            assert_near(&row[..=on], &expected, "the columns of the joints before the frame");
            assert!(row[on + 1..].iter().all(|x| *x == 0.0), "those behind it: {row:?}");
        }
        let rate = arm.jacobian_rate_times_velocity(q, qd).expect("lengths");
        assert_near(&rate, &short.jacobian_rate_times_velocity(q_short, qd_short).expect("lengths"), "J̇q̇");
        // a wrench at the tip changes the torques of the seven steps by Jᵀ w
        let torques = arm.wrench_torques(q, &SIX_WRENCH).expect("lengths");
        let with = short.inverse_dynamics_with_wrench(q_short, zeros, zeros, &SIX_WRENCH).expect("lengths");
        let without = short.gravity_torques(q_short).expect("lengths");
        let difference: Vec<f64> = with.iter().zip(&without).map(|(with, without)| with - without).collect();
        for (torque, expected) in torques.iter().zip(&difference) {
            assert!((torque - expected).abs() < 1e-11, "{torques:?} {difference:?}");
        }
        assert!(torques[on + 1..].iter().all(|x| *x == 0.0), "{torques:?}");
    });
}

/// q + q̇ t as dual numbers: the derivatives of what they give are exact.
#[test]
fn jacobians_are_derivatives_of_poses() {
    every_frame(100, |robot, frame, q, qd| {
        let arm = arm_at(robot, frame);
        let moving: Vec<Dual<f64>> =
            q.iter().zip(qd).map(|(&q, &qd)| Dual { derivative: qd, ..Dual::constant(q) }).collect();
        let pose = arm.forward_kinematics(&moving).expect("lengths");
        let rows = arm.jacobian(&moving).expect("lengths");
        let velocity: Vec<f64> = rows.iter().map(|row| row.iter().zip(qd).map(|(j, qd)| j.value * qd).sum()).collect();
        assert_near(&pose.translation.map(|x| x.derivative), &velocity[..3], "ẋ");
        // Ṙ = ω × R
        let [wx, wy, wz] = [velocity[3], velocity[4], velocity[5]];
        for column in 0..3 {
            let [x, y, z] = [0, 1, 2].map(|row| pose.rotation[row][column].value);
            let expected = [wy * z - wz * y, wz * x - wx * z, wx * y - wy * x];
            assert_near(&[0, 1, 2].map(|row| pose.rotation[row][column].derivative), &expected, "Ṙ");
        }
        let rate: Vec<f64> = rows.iter().map(|row| row.iter().zip(qd).map(|(j, qd)| j.derivative * qd).sum()).collect();
        assert_near(&arm.jacobian_rate_times_velocity(q, qd).expect("lengths"), &rate, "J̇q̇");
    });
}

#[test]
fn central_differences_of_the_pose_give_the_jacobian() {
    let frame = FixedFrame { on: Some(3), placement: tool() };
    for convention in [Convention::Standard, Convention::Modified] {
        let arm = Arm::new(six_joints(convention)).at_frame(frame).expect("six joints");
        let step = 1e-5;
        let at = |sign: f64| {
            let q: [f64; 6] = std::array::from_fn(|i| SIX_Q[i] + sign * step * SIX_QD[i]);
            arm.forward_kinematics(&q)
        };
        // the twist from the earlier pose to the later one, in world axes
        let error = at(-1.0).error_to(&at(1.0)).map(|x| x / (2.0 * step));
        let velocity = arm.jacobian(&SIX_Q).map(|row| row.iter().zip(SIX_QD).map(|(j, qd)| j * qd).sum::<f64>());
        for (error, velocity) in error.iter().zip(velocity) {
            assert!((error - velocity).abs() < 1e-9, "{error} {velocity}");
        }
    }
}

#[test]
fn arrays_and_slices_give_the_same_bits() {
    let frame = FixedFrame { on: Some(2), placement: tool() };
    let model = six_joints(Convention::Standard);
    let arm = Arm::new(model).at_frame(frame).expect("six joints");
    let slices = DynArm::new(&model).at_frame(frame).expect("six joints");
    assert_eq!(arm.forward_kinematics(&SIX_Q), slices.forward_kinematics(&SIX_Q).expect("lengths"));
    assert_eq!(arm.jacobian(&SIX_Q).map(Vec::from), slices.jacobian(&SIX_Q).expect("lengths"));
    let rate = slices.jacobian_rate_times_velocity(&SIX_Q, &SIX_QD).expect("lengths");
    assert_eq!(arm.jacobian_rate_times_velocity(&SIX_Q, &SIX_QD), rate);
    assert_eq!(Vec::from(arm.wrench_torques(&SIX_Q, &SIX_WRENCH)), slices.wrench_torques(&SIX_Q, &SIX_WRENCH).unwrap());
    // the other functions are those of the tip
    let (plain, zeros) = (Arm::new(model), [0.0; 6]);
    let with_wrench = |arm: &Arm<6>| {
        rne_runtime::InverseDynamics::inverse_dynamics_with_wrench(arm, &SIX_Q, &zeros, &zeros, &SIX_WRENCH)
    };
    assert_eq!(with_wrench(&arm), with_wrench(&plain));
    assert_eq!(arm.link_poses(&SIX_Q), plain.link_poses(&SIX_Q));
}

#[test]
fn a_frame_needs_its_link() {
    let model = six_joints(Convention::Standard);
    let frame = FixedFrame { on: Some(6), placement: Transform::IDENTITY };
    assert_eq!(Arm::new(model).at_frame(frame), None);
    assert_eq!(DynArm::new(&model).at_frame(frame), None);
}

/// A user's own implementation of the trait gets `wrench_torques` from its Jacobian.
#[test]
fn the_default_of_wrench_torques_is_the_arm_s() {
    struct Own(Arm<6>);
    impl Kinematics<6> for Own {
        fn forward_kinematics<T: rne_runtime::Scalar>(&self, q: &[T; 6]) -> Pose<T> {
            self.0.forward_kinematics(q)
        }
        fn link_poses<T: rne_runtime::Scalar>(&self, q: &[T; 6]) -> [Pose<T>; 6] {
            self.0.link_poses(q)
        }
        fn jacobian<T: rne_runtime::Scalar>(&self, q: &[T; 6]) -> [[T; 6]; 6] {
            self.0.jacobian(q)
        }
        fn jacobian_rate_times_velocity<T: rne_runtime::Scalar>(&self, q: &[T; 6], qd: &[T; 6]) -> [T; 6] {
            self.0.jacobian_rate_times_velocity(q, qd)
        }
    }
    let arm = Arm::new(six_joints(Convention::Modified));
    assert_near(&Own(arm.clone()).wrench_torques(&SIX_Q, &SIX_WRENCH), &arm.wrench_torques(&SIX_Q, &SIX_WRENCH), "Jᵀw");
}
