//! Poses and Jacobians of random arms: derivatives with respect to time by dual numbers.

use nalgebra::Vector3;
use rne_model::{Robot, Transform};

use crate::arm::{Arm, Maker};
use crate::case::{Case, cases, holds, largest, sum};
use crate::check::{error_on_scale, flat, product, relative_error};

#[test]
fn the_jacobian_moves_the_tip_and_carries_its_wrench() {
    holds("Jacobian", |case, worst| {
        let Case { arm, q, qd, .. } = case;
        let jacobian = arm.jacobian(q);
        let velocity = product(&jacobian, qd);
        let moving = arm.forward_kinematics(&case.moving());
        let tip = arm.forward_kinematics(q);
        let scale = largest(&flat(&jacobian)) * largest(qd);
        worst.see("ṗ", error_on_scale(&moving.translation.map(|x| x.derivative), &velocity[..3], scale));
        // Ṙ = ω × R
        let spin = Vector3::from_column_slice(&velocity[3..]).cross_matrix() * tip.rotation_matrix();
        let rate = moving.rotation_matrix().map(|x| x.derivative);
        worst.see("Ṙ", error_on_scale(rate.as_slice(), spin.as_slice(), 1.0));

        // Jᵀ w, the wrench turned from the tip into the world
        let turned = |x: [f64; 3]| tip.rotation_matrix() * Vector3::from(x);
        let wrench: Vec<f64> =
            [turned(case.wrench.force), turned(case.wrench.moment)].iter().flat_map(|x| x.iter().copied()).collect();
        let load: Vec<f64> =
            (0..q.len()).map(|joint| (0..6).map(|row| jacobian[row][joint] * wrench[row]).sum()).collect();
        let loaded = arm.inverse_dynamics_with_wrench(q, qd, &case.qdd, &case.wrench);
        worst.see("τ + Jᵀ w", relative_error(&sum(&case.tau(), &load), &loaded));

        let rate: Vec<Vec<f64>> =
            arm.jacobian(&case.moving()).iter().map(|row| row.iter().map(|x| x.derivative).collect()).collect();
        let expected = product(&rate, qd);
        let found = arm.jacobian_rate_times_velocity(q, qd);
        worst.see("J̇ q̇", error_on_scale(&found, &expected, largest(&flat(&jacobian))));
    });
}

/// J̇ q̇ has to do with the arm's geometry alone: no digit is lost to a centre of mass 200 km away.
#[test]
fn centres_of_mass_have_no_part_in_the_acceleration_of_the_tip() {
    for (maker, case) in
        Maker::ALL.into_iter().flat_map(|maker| cases(maker).iter().step_by(6).map(move |case| (maker, case)))
    {
        let Case { robot, q, qd, .. } = case;
        let with_com = |com: [f64; 3]| {
            let mut robot = robot.clone();
            for joint in &mut robot.joints {
                joint.row.link.com = com;
            }
            Arm::new(&robot, maker)
        };
        let near = with_com([0.0; 3]).jacobian_rate_times_velocity(q, qd);
        for com in [[1e3, -1e3, 1e3], [-2e5, 2e5, 1e5], [1e30, 0.0, -1e30]] {
            let far = with_com(com).jacobian_rate_times_velocity(q, qd);
            let error = relative_error(&far, &near);
            assert!(error <= 1e-15, "{maker}, {}, com {com:?}: {error:e}", robot.name);
        }
    }
}

#[test]
fn the_base_turns_what_is_seen_from_the_world_and_no_torque() {
    let moved = |maker| {
        let moved = cases(maker).iter().filter(|case| case.robot.base != Transform::IDENTITY);
        // the other arm is compiled for this alone
        moved.take(if maker == Maker::Runtime { 200 } else { 5 })
    };
    for (maker, case) in Maker::ALL.into_iter().flat_map(|maker| moved(maker).map(move |case| (maker, case))) {
        let Case { robot, arm, q, qd, qdd, .. } = case;
        let unmoved = Arm::new(&Robot { base: Transform::IDENTITY, ..robot.clone() }, maker);
        assert_eq!(arm.inverse_dynamics(q, qd, qdd), unmoved.inverse_dynamics(q, qd, qdd));
        assert_eq!(arm.mass_matrix(q), unmoved.mass_matrix(q));
        assert_eq!(arm.coriolis_matrix(q, qd), unmoved.coriolis_matrix(q, qd));
        assert_eq!(arm.potential_energy(q), unmoved.potential_energy(q));
        assert_eq!(arm.kinetic_energy(q, qd), unmoved.kinetic_energy(q, qd));
        assert_eq!(arm.regressor(q, qd, qdd), unmoved.regressor(q, qd, qdd));

        let turn = case.base_rotation();
        let (tip, seen) = (unmoved.forward_kinematics(q), arm.forward_kinematics(q));
        let expected = turn * tip.translation_vector() + Vector3::from(robot.base.xyz);
        assert!(relative_error(&seen.translation, expected.as_slice()) < 1e-14);
        let (rows, seen) = (unmoved.jacobian(q), arm.jacobian(q));
        for joint in 0..q.len() {
            for part in [0, 3] {
                let column = |rows: &[Vec<f64>; 6]| Vector3::from_fn(|row, _| rows[part + row][joint]);
                let error = (turn * column(&rows) - column(&seen)).amax();
                assert!(error < 1e-13 * column(&rows).amax().max(1.0), "{error:e}");
            }
        }
    }
}
