//! The centre of mass of random arms against the links one by one, dual numbers and the potential energy.

use nalgebra::Vector3;
use rne_model::Robot;

use crate::arm::{Arm, Maker};
use crate::case::{self, Case, largest};
use crate::check::{Worst, error_on_scale, product};

/// A property of all arms that have a mass.
#[track_caller]
fn holds(of: &str, property: impl Fn(&Case, &mut Worst)) {
    case::holds(of, |case, worst| {
        if case.robot.rows().any(|row| row.link.mass > 0.0) {
            property(case, worst);
        }
    });
}

/// How far the centre of mass can be from the origin of the world, about.
fn scale(case: &Case) -> f64 {
    let poses = case.arm.link_poses(&case.q);
    let mass: f64 = case.robot.rows().map(|row| row.link.mass).sum();
    let moments = case.robot.rows().map(|row| largest(&row.link.first_moment) / mass);
    poses
        .iter()
        .map(|pose| pose.translation_vector().norm())
        .chain(moments)
        .fold(largest(&case.robot.base.xyz), f64::max)
}

#[test]
fn it_is_the_mean_of_the_links() {
    holds("centre of mass", |case, worst| {
        let poses = case.arm.link_poses(&case.q);
        let (mut moment, mut mass) = (Vector3::zeros(), 0.0);
        for (row, pose) in case.robot.rows().zip(&poses) {
            let com = pose.rotation_matrix() * Vector3::from(row.link.com) + pose.translation_vector();
            moment += com * row.link.mass + pose.rotation_matrix() * Vector3::from(row.link.first_moment);
            mass += row.link.mass;
        }
        let (found, expected) = (case.arm.centre_of_mass(&case.q), moment / mass);
        worst.see("c", error_on_scale(&found, expected.as_slice(), scale(case)));
    });
}

#[test]
fn it_moves_as_its_jacobian_says() {
    holds("Jacobian of the centre of mass", |case, worst| {
        let moving = case.arm.centre_of_mass(&case.moving());
        let velocity: Vec<f64> = moving.iter().map(|x| x.derivative).collect();
        let found = product(&case.arm.centre_of_mass_jacobian(&case.q), &case.qd);
        worst.see("J q̇", error_on_scale(&found, &velocity, scale(case) * largest(&case.qd)));
    });
}

#[test]
fn the_potential_energy_is_that_of_the_whole_mass() {
    holds("energy of the centre of mass", |case, worst| {
        let mass = case.robot.rows().map(|row| row.link.mass).sum::<f64>();
        let centre = Vector3::from_vec(case.arm.centre_of_mass(&case.q)) - Vector3::from(case.robot.base.xyz);
        let gravity = case.gravity();
        let (found, expected) = (-mass * gravity.dot(&centre), case.arm.potential_energy(&case.q));
        worst.see("V", error_on_scale(&[found], &[expected], mass * gravity.norm() * scale(case)));
        // and so are the gravity torques the force that acts there
        let jacobian = case.arm.centre_of_mass_jacobian(&case.q);
        let of_joint = |joint: usize| -mass * (0..3).map(|axis| gravity[axis] * jacobian[axis][joint]).sum::<f64>();
        let found: Vec<f64> = (0..case.q.len()).map(of_joint).collect();
        let torques = case.arm.gravity_torques(&case.q);
        worst.see("τ", error_on_scale(&found, &torques, mass * gravity.norm() * scale(case)));
    });
}

/// Two slender bars: half the length of each from its joint.
#[test]
fn two_bars_by_hand() {
    const FILE: &str = "robots/planar2.yaml";
    let rows: Vec<_> = Arm::from_file(FILE, Maker::Runtime).robot.rows().collect();
    let (mass, length) = ([rows[0].link.mass, rows[1].link.mass], [rows[0].dh.a, rows[1].dh.a]);
    assert!(mass.iter().chain(&length).all(|&x| x > 0.0));
    assert_eq!([rows[0].link.com[0], rows[1].link.com[0]], [-length[0] / 2.0, -length[1] / 2.0]);
    let total = mass[0] + mass[1];
    // of the first bar's half, and of what it carries at its end; of the second bar's half
    let (first, second) = ((mass[0] / 2.0 + mass[1]) * length[0] / total, mass[1] / 2.0 * length[1] / total);
    for maker in Maker::ALL {
        let arm = Arm::from_file(FILE, maker);
        let q = [0.6_f64, -1.1];
        let (near, far) = (q[0], q[0] + q[1]);
        let (x, y) = (first * near.cos() + second * far.cos(), first * near.sin() + second * far.sin());
        assert!(error_on_scale(&arm.centre_of_mass(&q), &[x, y, 0.0], 1.0) < 1e-15, "{maker}");
        let jacobian = arm.centre_of_mass_jacobian(&q).concat();
        let expected = [-y, -second * far.sin(), x, second * far.cos(), 0.0, 0.0];
        assert!(error_on_scale(&jacobian, &expected, 1.0) < 1e-15, "{maker}");
    }
}

#[test]
fn an_arm_without_mass_has_none() {
    let yaml = "{format: 1, name: massless, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}},
        {type: prismatic, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}}]}";
    let robot = Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}"));
    for maker in Maker::ALL {
        let arm = Arm::new(&robot, maker);
        let numbers =
            [vec![arm.centre_of_mass(&[0.3, 0.4])], arm.centre_of_mass_jacobian(&[0.3, 0.4])].concat().concat();
        assert_eq!(numbers.len(), 9);
        assert!(numbers.iter().all(|number: &f64| !number.is_finite()), "{maker}: {numbers:?}");
    }
}
