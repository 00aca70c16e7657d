//! Seven arms against values that another program made: matrices, forward dynamics by another algorithm, derivatives,
//! regressors.

use crate::arm::{Arm, Maker};
use crate::check::{Worst, flat, json, numbers, product, relative_error, wrench};

const ARMS: [(&str, &str); 7] = [
    ("tests/reference/peers", "planar2"),
    ("tests/reference/peers", "puma560"),
    ("tests/reference/peers", "stanford"),
    ("tests/reference/peers", "panda"),
    ("tests/reference/peers", "iiwa14"),
    ("tests/dense", "dense6_2p"),
    ("tests/dense", "dense7"),
];

#[test]
fn functions_are_those_of_another_program() {
    for (maker, (folder, name)) in Maker::ALL.into_iter().flat_map(|maker| ARMS.map(|arm| (maker, arm))) {
        let arm = Arm::from_file(&format!("{folder}/{name}.yaml"), maker);
        let golden = json(&format!("{folder}/{name}.golden.json"));
        let parameters = numbers(&golden["params"]);
        let mut worst = Worst::default();
        for state in golden["states"].as_array().expect("states") {
            let array = |key: &str| numbers(&state[key]);
            let (q, qd, qdd, tau) = (array("q"), array("qd"), array("qdd"), array("tau"));
            let mass = arm.mass_matrix(&q);
            worst.see("mass matrix", relative_error(&flat(mass), &array("M")));
            let coriolis = arm.coriolis_matrix(&q, &qd);
            let bias: Vec<f64> =
                product(&coriolis, &qd).iter().zip(array("grav")).map(|(c, gravity)| c + gravity).collect();
            worst.see("C q̇ + g", relative_error(&bias, &array("nle")));
            let accelerations = arm.forward_dynamics(&q, &qd, &tau);
            worst.see("forward dynamics", relative_error(&accelerations, &array("qdd_aba")));

            // The wrench of the environment on the robot: the opposite sign.
            let w: Vec<f64> = array("wrench").iter().map(|x| -x).collect();
            let w = wrench(w.try_into().expect("six numbers"));
            let loaded = arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &w);
            worst.see("tip wrench", relative_error(&loaded, &array("tau_wrench")));

            // G² Jm is all that is known of these motors.
            let unit = vec![1.0; arm.robot.dof()];
            let still = vec![0.0; arm.robot.dof()];
            let rotors = arm.actuator_torques(&still, &unit);
            worst.see("rotors", relative_error(&rotors, &numbers(&golden["motor"])));
        }

        let extras = golden["extras"].as_array().expect("extras");
        assert_eq!(extras.len(), 4);
        for (state, extra) in golden["states"].as_array().expect("states").iter().zip(extras) {
            let array = |key: &str| numbers(&extra[key]);
            let [q, qd, qdd] = ["q", "qd", "qdd"].map(|key| numbers(&state[key]));
            let derivatives = arm.inverse_dynamics_derivatives(&q, &qd, &qdd);
            worst.see("∂τ/∂q", relative_error(&flat(derivatives.dq), &array("dtau_dq")));
            worst.see("∂τ/∂q̇", relative_error(&flat(derivatives.dqd), &array("dtau_dqd")));
            let regressor = arm.regressor(&q, &qd, &qdd);
            worst.see("regressor", relative_error(&flat(&regressor), &array("regressor")));
            worst.see("Y π", relative_error(&product(&regressor, &parameters), &numbers(&state["tau"])));
            let tip = arm.forward_kinematics(&q);
            worst.see("tip", relative_error(tip.to_homogeneous().transpose().as_slice(), &array("T")));
        }
        worst.at_most(1e-11, &format!("{name}, {maker}"));
    }
}
