//! Energies of random arms: derivatives with respect to time by dual numbers.

use nalgebra::Vector3;

use crate::case::{Case, along, holds};
use crate::check::{dot, error_on_scale, product};

#[test]
fn energy_changes_by_the_power_of_the_joints() {
    holds("energy", |case, worst| {
        let Case { arm, q, qd, qdd, .. } = case;
        let kinetic = arm.kinetic_energy(q, qd);
        let quadratic = 0.5 * dot(qd, &product(&case.mass(), qd));
        worst.see("½ q̇ᵀ M q̇", error_on_scale(&[kinetic], &[quadratic], f64::MIN_POSITIVE));

        let (q, qd) = (case.moving(), along(qd, qdd));
        let kinetic = arm.kinetic_energy(&q, &qd).derivative;
        let potential = arm.potential_energy(&q).derivative;
        let power = dot(&case.tau(), &case.qd);
        let scale = kinetic.abs().max(potential.abs());
        worst.see("power", error_on_scale(&[kinetic + potential], &[power], scale));
    });
}

#[test]
fn potential_energy_is_that_of_the_centres_of_mass_in_the_world() {
    holds("potential energy", |case, worst| {
        let gravity = case.gravity();
        let poses = case.arm.link_poses(&case.q);
        let (mut energy, mut scale) = (0.0, 0.0);
        for (row, pose) in case.robot.rows().zip(&poses) {
            let com = pose.rotation_matrix() * Vector3::from(row.link.com) + pose.translation_vector();
            let com = com - Vector3::from(case.robot.base.xyz);
            energy -= row.link.mass * gravity.dot(&com);
            scale += row.link.mass * gravity.norm() * com.norm();
            let moment = pose.rotation_matrix() * Vector3::from(row.link.first_moment);
            energy -= gravity.dot(&moment);
            scale += gravity.norm() * moment.norm();
        }
        let found = case.arm.potential_energy(&case.q);
        worst.see("V", error_on_scale(&[found], &[energy], scale));
    });
}
