//! The PUMA 560 against matrices and accelerations printed in the literature, with four decimals.

use serde_json::Value;

use crate::arm::{Arm, Maker};
use crate::check::{flat, json, numbers};

const PRINTED: f64 = 0.5001e-4;

#[track_caller]
fn as_printed(found: &[f64], printed: &Value) {
    let printed = numbers(printed);
    assert_eq!(found.len(), printed.len());
    for (found, printed) in found.iter().zip(&printed) {
        assert!((found - printed).abs() <= PRINTED, "{found} {printed}");
    }
}

#[test]
fn what_is_printed_of_the_puma() {
    for maker in Maker::ALL {
        as_published(Arm::from_file("robots/puma560.yaml", maker));
    }
}

fn as_published(arm: &Arm) {
    let published = &json("tests/reference/puma560.json")["published"];
    let q = numbers(&published["poses"]["qn"]);
    let (zero, one) = (vec![0.0; 6], vec![1.0; 6]);
    let rotors = arm.actuator_torques(&zero, &one);

    // Their mass matrix contains the rotors.
    let mut mass = arm.mass_matrix(&q);
    for (joint, rotor) in rotors.iter().enumerate() {
        mass[joint][joint] += rotor;
    }
    as_printed(&flat(&mass), &published["mass_matrix_qn"]["M"]);

    let coriolis = &published["coriolis_matrix_qn"];
    let found = arm.coriolis_matrix(&q, &numbers(&coriolis["qd"]));
    as_printed(&flat(&found), &coriolis["C"]);

    // Their accelerations of torques: inverse dynamics with motors gives the torques back. The collection of these
    // values says "friction off", and the numbers say on: -24 N m of inertia at joint 1 balance its friction. Rounding
    // q̈ to four decimals is multiplied by the matrix.
    let accelerations = &published["accel_qn"];
    let [qd, qdd, torque] = ["qd", "qdd", "torque"].map(|key| numbers(&accelerations[key]));
    let tau = arm.inverse_dynamics(&q, &qd, &qdd);
    let motors = arm.actuator_torques(&qd, &qdd);
    for ((tau, motor), torque) in tau.iter().zip(motors).zip(torque) {
        assert!((tau + motor - torque).abs() < 5e-4, "{tau} {motor} {torque}");
    }

    let mut motors = 0;
    for value in published["values"].as_array().expect("values") {
        let q = numbers(&published["poses"][value["q"].as_str().expect("a name")]);
        let (qd, qdd) = (numbers(&value["qd"]), numbers(&value["qdd"]));
        let mut tau = arm.inverse_dynamics(&q, &qd, &qdd);
        if value["gravity"] == false {
            let gravity = arm.gravity_torques(&q);
            tau.iter_mut().zip(gravity).for_each(|(tau, gravity)| *tau -= gravity);
        }
        if value["motor"] == true {
            motors += 1;
            let motor = arm.actuator_torques(&qd, &qdd);
            tau.iter_mut().zip(motor).for_each(|(tau, motor)| *tau += motor);
        }
        as_printed(&tau, &value["tau"]);
    }
    assert!(motors >= 3);
}
