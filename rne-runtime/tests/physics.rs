//! What must hold for every arm and state, whatever the formulas.

use crate::common;
use crate::common::{Numbers, SIX_BASE, SIX_WRENCH, assert_close, relative_error, row, six_joints, tool};
use nalgebra::{Matrix3, Vector3};
use num_dual::Dual64;
use rne_model::Convention::{Modified, Standard};
use rne_model::{Angle, JointKind, Model, Transform};
use rne_runtime::{Arm, BaseMotion, InverseDynamics, Wrench};

#[test]
fn power_of_the_actuators_is_the_change_of_energy() {
    let mut numbers = Numbers::new(21);
    for convention in [Standard, Modified] {
        let model = six_joints(convention);
        let arm = Arm::new(model);
        for _ in 0..20 {
            let (q, qd, qdd): ([f64; 6], [f64; 6], [f64; 6]) =
                (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
            let along = |x: [f64; 6], rate: [f64; 6]| std::array::from_fn(|i| Dual64::new(x[i], rate[i]));
            let trace = arm.trace(&along(q, qd), &along(qd, qdd), &qdd.map(Dual64::from_re), &arm.fixed_base(), None);

            let mut kinetic = Dual64::from_re(0.0);
            let mut weight_power = 0.0;
            for (link, row) in trace.links.iter().zip(&model.rows) {
                // Form P and the link frame of the table differ by Rx(α) in a standard table, not at all in a modified
                // one.
                let turn = match convention {
                    Standard => rotation_x(&row.dh.alpha),
                    Modified => Matrix3::identity(),
                };
                let inertia = turn * Matrix3::from(row.link.inertia.rows()) * turn.transpose();
                let (omega, velocity) = (Vector3::from(link.omega), Vector3::from(link.velocity));
                let spin = omega.dot(&(inertia.map(Dual64::from_re) * omega));
                kinetic += (velocity.dot(&velocity) * row.link.mass + spin) * 0.5;
                weight_power += row.link.mass * Vector3::from(link.gravity).dot(&velocity).re;
            }
            let power: f64 = trace.tau().iter().zip(qd).map(|(tau, qd)| tau.re * qd).sum();
            let scale = kinetic.eps.abs().max(weight_power.abs()).max(1.0);
            assert!((power - (kinetic.eps - weight_power)).abs() < 1e-12 * scale);
        }
    }
}

#[test]
fn gravity_is_an_upward_acceleration_of_the_base() {
    let mut numbers = Numbers::new(22);
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        let (q, qd, qdd) = (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
        let lifted = BaseMotion { acceleration: [0.0, 0.0, 9.81], ..BaseMotion::fixed([0.0; 3]) };
        let tau = arm.inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &lifted, None);
        assert_close("τ", &tau, &arm.inverse_dynamics(&q, &qd, &qdd));
    }
}

#[test]
fn a_base_that_spins_about_the_first_axis_is_a_faster_first_joint() {
    let mut numbers = Numbers::new(23);
    let arm = Arm::new(six_joints(Standard));
    for _ in 0..20 {
        let (q, mut qd, mut qdd): ([f64; 6], [f64; 6], [f64; 6]) =
            (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
        let [spin, spin_up] = numbers.array(2.0);
        let base = BaseMotion { omega: [0.0, 0.0, spin], omega_dot: [0.0, 0.0, spin_up], ..arm.fixed_base() };
        let on_spinning_base = arm.inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &base, None);
        qd[0] += spin;
        qdd[0] += spin_up;
        assert_close("τ", &on_spinning_base, &arm.inverse_dynamics(&q, &qd, &qdd));
    }
}

#[test]
fn the_velocity_of_the_base_changes_no_torque() {
    let arm = Arm::new(six_joints(Modified));
    let (q, qd, qdd) = (common::SIX_Q, common::SIX_QD, common::SIX_QDD);
    let slow = BaseMotion { velocity: [0.0; 3], ..SIX_BASE };
    assert_eq!(
        arm.inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &SIX_BASE, None),
        arm.inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &slow, None)
    );
}

/// A wrench at the tool equals the same wrench, turned and with its moment moved, at the tip of the last link.
#[test]
fn a_tool_moves_the_wrench() {
    let mut numbers = Numbers::new(24);
    let tool = tool();
    let [roll, pitch, yaw] = tool.rpy.map(|angle| angle.radians);
    let turn = nalgebra::Rotation3::from_euler_angles(roll, pitch, yaw);
    let (force, moment) = SIX_WRENCH.vectors();
    let force = turn * force;
    let moment = turn * moment + Vector3::from(tool.xyz).cross(&force);
    let moved = Wrench::from_vectors(force, moment);
    for convention in [Standard, Modified] {
        let bare = Arm::new(six_joints(convention));
        let tooled = Arm::new(Model { tool, ..six_joints(convention) });
        let (q, qd, qdd) = (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
        let expected = bare.inverse_dynamics_with_wrench(&q, &qd, &qdd, &moved);
        assert_close("τ", &tooled.inverse_dynamics_with_wrench(&q, &qd, &qdd, &SIX_WRENCH), &expected);
        // A tool weighs nothing.
        assert_close("free", &tooled.inverse_dynamics(&q, &qd, &qdd), &bare.inverse_dynamics(&q, &qd, &qdd));
    }
}

/// A wrench works on the tip's motion: τ = free τ + Jᵀ w, with the tip's velocity found from the last link's.
#[test]
fn a_wrench_does_the_work_of_its_torques() {
    let mut numbers = Numbers::new(25);
    for convention in [Standard, Modified] {
        let arm = Arm::new(Model { tool: tool(), ..six_joints(convention) });
        for _ in 0..20 {
            let (q, qd, qdd): ([f64; 6], [f64; 6], [f64; 6]) =
                (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
            let (force, moment): ([f64; 3], [f64; 3]) = (numbers.array(5.0), numbers.array(2.0));
            let wrench = Wrench { force, moment };
            let free = arm.inverse_dynamics(&q, &qd, &qdd);
            let loaded = arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench);
            let work: f64 = (0..6).map(|i| (loaded[i] - free[i]) * qd[i]).sum();

            // The axes of the tip: R_{n+1} = Rx(α_n) R_tool, or R_tool alone.
            let [roll, pitch, yaw] = tool().rpy.map(|angle| angle.radians);
            let turn = *nalgebra::Rotation3::from_euler_angles(roll, pitch, yaw).matrix();
            let turn = match convention {
                Standard => rotation_x(&Angle::new(0.5)) * turn,
                Modified => turn,
            };
            let last = arm.trace(&q, &qd, &qdd, &arm.fixed_base(), None).links[5];
            let omega = Vector3::from(last.omega);
            let tip_velocity = Vector3::from(last.velocity) + omega.cross(&Vector3::from(last.r));
            let expected =
                (turn * Vector3::from(force)).dot(&tip_velocity) + (turn * Vector3::from(moment)).dot(&omega);
            assert!((work - expected).abs() < 1e-12 * expected.abs().max(10.0), "{work} {expected}");
        }
    }
}

/// The kinetic energy's metric: τ is linear in q̈, with a symmetric matrix.
#[test]
fn the_mass_matrix_is_symmetric() {
    for convention in [Standard, Modified] {
        let arm = Arm::new(Model { gravity: [0.0; 3], ..six_joints(convention) });
        let column = |j: usize| {
            let mut unit = [0.0; 6];
            unit[j] = 1.0;
            arm.inverse_dynamics(&common::SIX_Q, &[0.0; 6], &unit)
        };
        let columns: [[f64; 6]; 6] = std::array::from_fn(column);
        for (i, column) in columns.iter().enumerate() {
            assert!(column[i] > 0.0);
            assert!(relative_error(column, &columns.map(|other| other[i])) < 1e-14);
        }
    }
}

/// Joint angle with a constant part of a quarter turn: sine and cosine are exchanged, not computed with π/2.
#[test]
fn right_angles_are_exact() {
    use std::f64::consts::{FRAC_PI_2, PI};
    let q = 0.3_f64;
    let (s, c) = q.sin_cos();
    for (theta, sin, cos) in [
        (0.0, s, c),
        (FRAC_PI_2, c, -s),
        (PI, -s, -c),
        (-PI, -s, -c),
        (-FRAC_PI_2, -c, s),
        (0.2, (0.2 + q).sin(), (0.2 + q).cos()),
    ] {
        let mut model = six_joints(Standard);
        model.rows[0].dh.theta = Angle::new(theta);
        let arm = Arm::new(model);
        let link = arm.trace(&[q; 6], &[0.0; 6], &[0.0; 6], &arm.fixed_base(), None).links[0];
        assert_eq!((link.sin, link.cos), (sin, cos), "{theta}");
        assert_eq!(link.rotation, [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]], "{theta}");
    }
    // A prismatic joint's angle is constant.
    let mut model = six_joints(Standard);
    model.rows[0] = row(JointKind::Prismatic, [0.0, 0.0, 0.0, -FRAC_PI_2], model.rows[0].link);
    let arm = Arm::new(model);
    let link = arm.trace(&[q; 6], &[0.0; 6], &[0.0; 6], &arm.fixed_base(), None).links[0];
    assert_eq!((link.sin, link.cos), (-1.0, 0.0));
}

/// The rotations between the lecture's axes are its Q_{i-1}: Rz(θ) Rx(α) of the row before.
#[test]
fn the_lecture_s_rotations() {
    let model = six_joints(Standard);
    let arm = Arm::new(model);
    let (q, zero) = (common::SIX_Q, [0.0; 6]);
    let links = arm.trace(&q, &zero, &zero, &arm.fixed_base(), None).to_lecture();
    assert!(relative_error(links[0].rotation.as_flattened(), Matrix3::<f64>::identity().as_slice()) < 1e-15);
    for (previous, (link, row)) in links.iter().zip(links[1..].iter().zip(&model.rows)) {
        let (s, c, sa, ca) = (previous.sin, previous.cos, row.dh.alpha.sin, row.dh.alpha.cos);
        let q_matrix = [[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0.0, sa, ca]];
        assert!(relative_error(link.rotation.as_flattened(), q_matrix.as_flattened()) < 1e-15);
        assert_eq!(link.rotation_matrix()[(0, 2)], link.rotation[0][2]);
    }
}

#[test]
fn a_trace_ends_in_the_torques() {
    for convention in [Standard, Modified] {
        let arm = Arm::new(Model { tool: tool(), base: Transform::IDENTITY, ..six_joints(convention) });
        let (q, qd, qdd) = (common::SIX_Q, common::SIX_QD, common::SIX_QDD);
        let trace = arm.trace(&q, &qd, &qdd, &SIX_BASE, Some(&SIX_WRENCH));
        assert_eq!(
            trace.tau(),
            arm.inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &SIX_BASE, Some(&SIX_WRENCH))
        );
    }
}

fn rotation_x(angle: &Angle) -> Matrix3<f64> {
    Matrix3::new(1.0, 0.0, 0.0, 0.0, angle.cos, -angle.sin, 0.0, angle.sin, angle.cos)
}
