//! Mass matrix, Coriolis matrix, forward dynamics, regressor and derivatives of random arms.

use nalgebra::DMatrix;

use crate::arm::Maker;
use crate::case::{Case, cases, holds, largest, sum, transposed};
use crate::check::{Conditioning, Worst, conditioning, eigenvalues, error_on_scale, flat, product, relative_error};

#[test]
fn the_mass_matrix_is_symmetric_semidefinite_and_that_of_the_torques() {
    holds("mass matrix", |case, worst| {
        let mass = case.mass();
        assert_eq!(mass, transposed(&mass), "to the last bit");
        if case.is_of_bodies() {
            let lowest = eigenvalues(&mass).min();
            worst.see("negative eigenvalue", (-lowest).max(0.0) / largest(&flat(&mass)).max(f64::MIN_POSITIVE));
        }
        let bias = case.arm.bias_torques(&case.q, &case.qd);
        let tau = case.tau();
        worst.see("M q̈ + bias", relative_error(&sum(&product(&mass, &case.qdd), &bias), &tau));
    });
}

#[test]
fn forward_dynamics_undoes_inverse_dynamics() {
    for maker in Maker::ALL {
        let mut compared = 0;
        let mut worst = Worst::default();
        for case in cases(maker) {
            let Some(Conditioning { number, largest: of_matrix }) = conditioning(&case.mass()) else { continue };
            // A matrix near singularity multiplies the rounding of the torques; a singular one has no answer.
            if number > 1e4 {
                continue;
            }
            let found = case.arm.forward_dynamics(&case.q, &case.qd, &case.tau());
            compared += 1;
            let still = case.arm.bias_torques(&case.q, &case.qd);
            let scale = largest(&still) / of_matrix;
            worst.see("q̈", error_on_scale(&found, &case.qdd, scale) / number);
        }
        println!("{compared} arms");
        assert!(6 * compared > cases(maker).len(), "{compared}");
        worst.at_most(1e-14, &format!("forward dynamics, {maker}"));
    }
}

#[test]
fn the_inverse_of_the_mass_matrix_is_that_of_nalgebra() {
    for maker in Maker::ALL {
        let mut compared = 0;
        let mut worst = Worst::default();
        for case in cases(maker) {
            let (mass, inverse) = (case.mass(), case.arm.inverse_mass_matrix(&case.q));
            let Some(Conditioning { number, .. }) = conditioning(&mass) else { continue };
            // A matrix near singularity multiplies rounding; a singular one has no inverse.
            if number > 1e4 {
                continue;
            }
            compared += 1;
            assert_eq!(inverse, transposed(&inverse), "to the last bit");
            let dof = mass.len();
            let one = DMatrix::from_fn(dof, dof, |i, j| f64::from(u8::from(i == j)));
            let [mass, inverse] = [mass, inverse].map(|rows| DMatrix::from_row_iterator(dof, dof, flat(rows)));
            worst.see("M M⁻¹", (&mass * &inverse - one).amax() / number);
            let expected = mass.lu().try_inverse().expect("a regular matrix");
            worst.see("by LU", (&inverse - &expected).amax() / expected.amax() / number);
        }
        println!("{compared} arms");
        assert!(6 * compared > cases(maker).len(), "{compared}");
        worst.at_most(1e-14, &format!("inverse mass matrix, {maker}"));
    }
}

#[test]
fn the_coriolis_matrix_is_christoffel_s() {
    holds("Coriolis", |case, worst| {
        let Case { arm, q, qd, .. } = case;
        let coriolis = arm.coriolis_matrix(q, qd);
        let rate: Vec<Vec<f64>> = arm
            .mass_matrix(&case.moving())
            .into_iter()
            .map(|row| row.into_iter().map(|element| element.derivative).collect())
            .collect();
        // Torques at unit velocities are what the columns are differences of.
        let scale = largest(&flat(&coriolis)).max(largest(&flat(case.mass())));
        let both = sum(&flat(&coriolis), &flat(transposed(&coriolis)));
        worst.see("Ṁ = C + Cᵀ", error_on_scale(&both, &flat(&rate), scale));

        let torques = arm.coriolis_torques(q, qd);
        worst.see("C q̇", error_on_scale(&product(&coriolis, qd), &torques, scale));
        let bias = arm.bias_torques(q, qd);
        let gravity = arm.gravity_torques(q);
        worst.see("C q̇ + g", error_on_scale(&sum(&product(&coriolis, qd), &gravity), &bias, scale));

        // Element by element: half the derivative of the torques of the velocities.
        let zeros = vec![0.0; qd.len()];
        let derivatives = arm.inverse_dynamics_derivatives(q, qd, &zeros);
        let half: Vec<f64> = flat(derivatives.dqd).iter().map(|element| 0.5 * element).collect();
        worst.see("C = ½ ∂b/∂q̇", error_on_scale(&flat(&coriolis), &half, scale));
    });
}

#[test]
fn the_torques_are_linear_in_the_inertial_parameters() {
    holds("regressor", |case, worst| {
        let regressor = case.arm.regressor(&case.q, &case.qd, &case.qdd);
        worst.see("Y π", relative_error(&product(&regressor, &case.parameters()), &case.tau()));
    });
}

#[test]
fn derivatives_of_the_torques_are_small_differences() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for case in cases(maker).iter().take(100) {
            let Case { arm, q, qd, qdd, .. } = case;
            let found = arm.inverse_dynamics_derivatives(q, qd, qdd);
            let step = 1e-5;
            let differences = |torques: &dyn Fn(&[f64]) -> Vec<f64>, x: &[f64]| -> Vec<Vec<f64>> {
                let columns = (0..x.len()).map(|joint| {
                    let [more, less] = [step, -step].map(|step| {
                        let mut moved = x.to_vec();
                        moved[joint] += step;
                        torques(&moved)
                    });
                    more.iter().zip(less).map(|(more, less)| (more - less) / (2.0 * step)).collect()
                });
                transposed(&columns.collect::<Vec<_>>())
            };
            let dq = differences(&|q| arm.inverse_dynamics(q, qd, qdd), q);
            let dqd = differences(&|qd| arm.inverse_dynamics(q, qd, qdd), qd);
            let scale = largest(&case.tau()).max(1e-3);
            worst.see("∂τ/∂q", error_on_scale(&flat(found.dq), &flat(dq), scale));
            worst.see("∂τ/∂q̇", error_on_scale(&flat(found.dqd), &flat(dqd), scale));
        }
        worst.at_most(1e-8, &format!("derivatives, {maker}"));
    }
}
