//! The shipped robots against independent values: mass matrix, Coriolis torques, forward dynamics, tip, Jacobian,
//! motors.

use std::sync::LazyLock;

use rne_codegen::Function;

use crate::arm::{Arm, Given, Maker};
use crate::case::sum;
use crate::check::{Worst, error_on_scale, flat, json, numbers, product, relative_error, wrench};

/// The shipped robots that are tried.
pub(crate) static ROBOTS: LazyLock<Vec<String>> =
    LazyLock::new(|| shipped::tried().map(|robot| robot.name.to_owned()).collect());

#[test]
fn functions_of_the_shipped_robots_are_the_independent_ones() {
    let mut motors = 0;
    for (maker, name) in Maker::ALL.into_iter().flat_map(|maker| ROBOTS.iter().map(move |name| (maker, name))) {
        let arm = Arm::from_file(&format!("robots/{name}.yaml"), maker);
        let golden = json(&format!("tests/reference/{name}.golden.json"));
        let states = golden["states"].as_array().expect("states");
        assert_eq!(states.len(), 16);
        let mut worst = Worst::default();
        for state in states {
            let array = |key: &str| numbers(&state[key]);
            let (q, qd, qdd, tau) = (array("q"), array("qd"), array("qdd"), array("tau"));
            let scale = tau.iter().fold(0.0_f64, |scale, tau| scale.max(tau.abs()));

            let given = Given {
                wrench: wrench(array("wrench").try_into().expect("six numbers")),
                ..Given::of_joints(&q, &qd, &qdd)
            };
            for (what, function, key) in [
                ("torques", Function::InverseDynamics, "tau"),
                ("torques of sines", Function::InverseDynamicsFromSinCos, "tau"),
                ("tip wrench", Function::InverseDynamicsWithWrench, "tau_wrench"),
                ("gravity", Function::GravityTorques, "gravity"),
                ("Coriolis", Function::CoriolisTorques, "coriolis"),
            ] {
                worst.see(what, error_on_scale(&arm.numbers(function, &given), &array(key), 1e-2 * scale));
            }
            worst.see(
                "bias",
                error_on_scale(&arm.bias_torques(&q, &qd), &sum(&array("gravity"), &array("coriolis")), 1e-2 * scale),
            );
            let mass = arm.mass_matrix(&q);
            worst.see("mass matrix", relative_error(&flat(&mass), &array("mass_matrix")));
            let coriolis = arm.coriolis_matrix(&q, &qd);
            // Where nothing turns, nothing is left but the rounding of a difference.
            worst.see("C q̇", error_on_scale(&product(&coriolis, &qd), &array("coriolis"), scale));
            let tip = arm.forward_kinematics(&q);
            worst.see("tip", relative_error(tip.to_homogeneous().transpose().as_slice(), &array("T_tip")));
            let jacobian = arm.jacobian(&q);
            worst.see("Jacobian", relative_error(&flat(&jacobian), &array("jacobian_world")));
            let accelerations = arm.forward_dynamics(&q, &qd, &tau);
            worst.see("forward dynamics", relative_error(&accelerations, &qdd));
            if state.get("tau_motor").is_some() {
                motors += 1;
                let motor = arm.actuator_torques(&qd, &qdd);
                let total: Vec<f64> = tau.iter().zip(motor).map(|(tau, motor)| tau + motor).collect();
                worst.see("with motors", relative_error(&total, &array("tau_motor")));
            }
        }
        worst.at_most(1e-11, &format!("{name}, {maker}"));
    }
    assert!(motors >= 3 * 16);
}
