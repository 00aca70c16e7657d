//! The momentum of random arms and its rate: against mass matrix, Christoffel's matrix and energies.

use crate::case::{Case, holds, largest, sum};
use crate::check::{error_on_scale, product};

#[test]
fn momentum_and_its_rate_are_those_of_the_matrices() {
    holds("momentum", |case, worst| {
        let Case { arm, q, qd, qdd, .. } = case;
        let mass = case.mass();
        // torques as large as accelerations happen to be
        let [momentum, rate] = arm.momentum_and_rate(q, qd, qdd);
        let size = largest(&mass.concat()) * largest(qd);
        worst.see("M q̇", error_on_scale(&momentum, &product(&mass, qd), 1e-2 * size));

        let coriolis = arm.coriolis_matrix(q, qd);
        let turned: Vec<f64> =
            (0..q.len()).map(|i| coriolis.iter().zip(qd).map(|(row, qd)| row[i] * qd).sum()).collect();
        let gravity: Vec<f64> = arm.gravity_torques(q).iter().map(|g| -g).collect();
        let expected = sum(&sum(qdd, &turned), &gravity);
        let scale = largest(qdd).max(largest(&gravity)).max(size * largest(qd));
        worst.see("τ + Cᵀ q̇ - g", error_on_scale(&rate, &expected, scale));
    });
}

/// d/dt (M q̇) along the motion that torques cause is the rate: there is nothing else that acts on the arm.
#[test]
fn momentum_changes_by_its_rate() {
    holds("rate of momentum", |case, worst| {
        let Case { arm, q, qd, qdd, .. } = case;
        let tau = case.tau();
        let [_, rate] = arm.momentum_and_rate(q, qd, &tau);
        let nothing: Vec<_> = q.iter().map(|_| rne::Dual::constant(0.0)).collect();
        let [momentum, _] = arm.momentum_and_rate(&case.moving(), &crate::case::along(qd, qdd), &nothing);
        let found: Vec<f64> = momentum.iter().map(|p| p.derivative).collect();
        worst.see("ṗ", error_on_scale(&found, &rate, largest(&tau)));
    });
}
