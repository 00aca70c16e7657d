//! The fifteen robots against independent values: mass matrix, Coriolis torques, forward dynamics, tip, Jacobian, motors.

use crate::check::{Worst, arm, error_on_scale, flat, json, numbers, product, relative_error};

pub(crate) const ROBOTS: [&str; 15] = [
    "cylindrical_rpp",
    "gantry_ppp",
    "iiwa14",
    "panda",
    "planar1",
    "planar2",
    "planar3",
    "puma560",
    "puma560_mdh",
    "scara_cobra600",
    "spherical_rrp",
    "stanford",
    "ur5",
    "ur5e",
    "wam7",
];

#[test]
fn functions_of_the_shipped_robots_are_the_independent_ones() {
    let mut motors = 0;
    for name in ROBOTS {
        let arm = arm(&format!("robots/{name}.yaml"));
        let golden = json(&format!("tests/reference/{name}.golden.json"));
        let states = golden["states"].as_array().expect("states");
        assert_eq!(states.len(), 16);
        let mut worst = Worst::default();
        for state in states {
            let array = |key: &str| numbers(&state[key]);
            let (q, qd, qdd, tau) = (array("q"), array("qd"), array("qdd"), array("tau"));
            let scale = tau.iter().fold(0.0_f64, |scale, tau| scale.max(tau.abs()));

            let mass = arm.mass_matrix(&q).expect("one per joint");
            worst.see("mass matrix", relative_error(&flat(&mass), &array("mass_matrix")));
            let coriolis = arm.coriolis_matrix(&q, &qd).expect("one per joint");
            // Where nothing turns, nothing is left but the rounding of a difference.
            worst.see("C q̇", error_on_scale(&product(&coriolis, &qd), &array("coriolis"), scale));
            let tip = arm.forward_kinematics(&q).expect("one per joint");
            worst.see("tip", relative_error(tip.to_homogeneous().transpose().as_slice(), &array("T_tip")));
            let jacobian = arm.jacobian(&q).expect("one per joint");
            worst.see("Jacobian", relative_error(&flat(&jacobian), &array("jacobian_world")));
            let accelerations = arm.forward_dynamics(&q, &qd, &tau).expect("one per joint");
            worst.see("forward dynamics", relative_error(&accelerations, &qdd));
            if state.get("tau_motor").is_some() {
                motors += 1;
                let motor = arm.actuator_torques(&qd, &qdd).expect("one per joint");
                let total: Vec<f64> = tau.iter().zip(motor).map(|(tau, motor)| tau + motor).collect();
                worst.see("with motors", relative_error(&total, &array("tau_motor")));
            }
        }
        worst.at_most(1e-11, name);
    }
    assert!(motors >= 16);
}
