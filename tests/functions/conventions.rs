//! One arm in both conventions, and a moving base.

use fastrand::Rng;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rne::BaseMotion;
use rne_model::Convention::{Modified, Standard};
use rne_model::{Angle, Dh, Inertia, InertiaReference, Robot, Transform};

use crate::arm::{Arm, Maker};
use crate::case::{Case, cases};
use crate::check::{Worst, error_on_scale, flat, relative_error};

/// A state of an arm with six joints.
fn state(rng: &mut Rng) -> [Vec<f64>; 3] {
    [3.0, 2.0, 5.0].map(|scale| (0..6).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect())
}

/// The same arm in modified rows: row i takes α and a of the row before; the link frame moves from the far end of the
/// link to its joint, and link data and tool with it.
fn modified(robot: &Robot) -> Robot {
    assert_eq!(robot.convention, Standard);
    let mut modified = Robot { convention: Modified, ..robot.clone() };
    let (mut alpha, mut a) = (Angle::ZERO, 0.0);
    for joint in &mut modified.joints {
        let dh = joint.row.dh;
        let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), dh.alpha.radians);
        let link = &mut joint.row.link;
        let (way, h) = (Vector3::new(dh.a, 0.0, 0.0), turn * Vector3::from(link.first_moment));
        let mut i = turn * Matrix3::from(link.inertia.rows()) * turn.inverse();
        link.first_moment = h.into();
        if link.mass == 0.0 {
            // without mass the tensor is about the frame's origin: + 2 h·t 1 - h tᵀ - t hᵀ
            link.com = [0.0; 3];
            i += Matrix3::identity() * (2.0 * h.dot(&way)) - h * way.transpose() - way * h.transpose();
        } else {
            link.com = (turn * Vector3::from(link.com) + way).into();
        }
        link.inertia = Inertia { xx: i.m11, yy: i.m22, zz: i.m33, xy: i.m12, xz: i.m13, yz: i.m23 };
        joint.written_inertia = (link.inertia, InertiaReference::Com);
        joint.row.dh = Dh { alpha, a, ..dh };
        (alpha, a) = (dh.alpha, dh.a);
    }
    let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), alpha.radians);
    let [roll, pitch, yaw] = robot.tool.rpy.map(|angle| angle.radians);
    let (roll, pitch, yaw) = (turn * Rotation3::from_euler_angles(roll, pitch, yaw)).euler_angles();
    modified.tool = Transform {
        xyz: (turn * Vector3::from(robot.tool.xyz) + Vector3::new(a, 0.0, 0.0)).into(),
        rpy: [roll, pitch, yaw].map(Angle::new),
    };
    modified
}

#[test]
fn standard_and_modified_rows_of_one_arm_agree() {
    for maker in Maker::ALL {
        let mut arms = 0;
        let mut worst = Worst::default();
        let standard = cases(maker).iter().filter(|case| case.robot.convention == Standard);
        // the other arm is compiled for this alone
        for case in standard.take(if maker == Maker::Runtime { 200 } else { 8 }) {
            arms += 1;
            let modified = Arm::new(&modified(&case.robot), maker);
            let arms = [&case.arm, &modified];
            let Case { q, qd, qdd, wrench, .. } = case;
            let mut agree = |what: &'static str, function: &dyn Fn(&Arm) -> Vec<f64>| {
                let [standard, modified] = arms.map(function);
                worst.see(what, error_on_scale(&modified, &standard, 1e-2));
            };
            agree("tip", &|arm| arm.forward_kinematics(q).to_homogeneous().as_slice().to_vec());
            agree("J", &|arm| flat(arm.jacobian(q)));
            agree("J̇ q̇", &|arm| arm.jacobian_rate_times_velocity(q, qd));
            agree("τ", &|arm| arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench));
            agree("M", &|arm| flat(arm.mass_matrix(q)));
            agree("C", &|arm| flat(arm.coriolis_matrix(q, qd)));
            agree("∂τ/∂q", &|arm| flat(arm.inverse_dynamics_derivatives(q, qd, qdd).dq));
            agree("∂τ/∂q̇", &|arm| flat(arm.inverse_dynamics_derivatives(q, qd, qdd).dqd));
            agree("T and V", &|arm| vec![arm.kinetic_energy(q, qd), arm.potential_energy(q)]);
            agree("p", &|arm| arm.momentum_and_rate(q, qd, qdd).concat());
            // The reference points J_i and the axes of form P are those of the joints in both.
            agree("joint wrenches", &|arm| {
                arm.joint_wrenches(q, qd, qdd).iter().flat_map(|w| [w.force, w.moment].concat()).collect()
            });
        }
        assert!(arms >= 5);
        worst.at_most(1e-12, &format!("standard, modified, {maker}"));
    }
}

#[test]
fn a_base_that_turns_gravity_turns_the_arm_instead() {
    for maker in Maker::ALL {
        // An arm whose first axis is z of frame 0: turning it is turning gravity the other way.
        let arm = Arm::from_file("robots/stanford.yaml", maker);
        let mut rng = Rng::with_seed(2);
        for _ in 0..50 {
            let [mut q, qd, qdd] = state(&mut rng);
            let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
            let gravity = Vector3::new(3.0, -5.0, 7.0);
            let seen: Vector3<f64> = turn.inverse() * gravity;
            let still = arm.inverse_dynamics_on_moving_base(&q, &qd, &qdd, &BaseMotion::fixed(seen.into()));
            q[0] += 0.7;
            let turned = arm.inverse_dynamics_on_moving_base(&q, &qd, &qdd, &BaseMotion::fixed(gravity.into()));
            assert!(relative_error(&still, &turned) < 1e-13);
        }
    }
}

#[test]
fn a_base_that_rises_makes_heavier() {
    for case in Maker::ALL.into_iter().flat_map(cases) {
        let rising = BaseMotion { acceleration: case.robot.gravity.map(|g| -g), ..BaseMotion::fixed([0.0; 3]) };
        let torques = case.arm.inverse_dynamics_on_moving_base(&case.q, &case.qd, &case.qdd, &rising);
        let error = error_on_scale(&torques, &case.tau(), 0.0);
        assert!(error < 1e-12, "{error:e}");
    }
}
