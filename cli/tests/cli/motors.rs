//! Robots with a list `motors`.

use std::path::Path;

use crate::call::{ROOT, fine, folder};

const WAM: &str = "robots/trees/wam7_coupled.yaml";

#[test]
fn rotors_on_links_are_part_of_the_torques() {
    let state = ["--q", "0.1,0.2,0.3,0.4,0.5,0.6,0.7", "--qd", "1,2,3,4,5,6,7", "--qdd", "1,1,1,1,1,1,1"];
    let of = |robot| fine(&[&["eval", robot, "--json"][..], &state].concat());
    // motors without rotors map torques, and change none
    assert_eq!(of(WAM), of("robots/wam7.yaml").replace("wam7", "wam7_coupled"));
    let zeros = "0,0,0,0,0,0,0,0,0,0,0,0";
    let state = ["--q", "0,1,0,0,1,0,0,1,0,0,1,0", "--qd", zeros, "--qdd", "0,0,1,0,0,0,0,0,0,0,0,0", "--json"];
    let with = fine(&[&["eval", "mini_cheetah"][..], &state].concat());
    let text = std::fs::read_to_string(Path::new(ROOT).join("robots/trees/mini_cheetah.yaml")).expect("a file");
    let file = folder("motors").join("without.yaml");
    std::fs::write(&file, text.split("motors:").next().expect("the text before")).expect("written");
    let without = fine(&[&["eval", file.to_str().expect("UTF-8")][..], &state].concat());
    let knee = |text: &str| {
        let value: serde_json::Value = serde_json::from_str(text).expect("JSON");
        value["result"][2].as_f64().expect("a torque")
    };
    // n² Jm of the knee, and no gravity of it
    assert!((knee(&with) - knee(&without) - 9.33 * 9.33 * 6.3e-5).abs() < 1e-12, "{with}");
}

#[test]
fn code_and_tables_tell_what_turns() {
    let shown = fine(&["show", WAM, "--joint", "3", "--step", "7"]);
    assert!(shown.contains("motor m2 turns with 28.25 q2 - 16.8155 q3"), "{shown}");
    let shown = fine(&["show", "mini_cheetah", "--joint", "3", "--step", "7"]);
    assert!(shown.contains("its rotor on fr_hip turns about (0, 0, 1), inertia 0.000063 kg m²"), "{shown}");
    let code = fine(&["emit", WAM, "--lang", "c", "--real", "double", "--form", "reduced"]);
    for function in ["wam7_coupled_motor_speeds(", "wam7_coupled_joint_torques(", "wam7_coupled_motor_torques("] {
        assert_eq!(code.matches(function).count(), 2, "{function}\n{code}");
    }
    assert!(code.contains("motor_qd[0] = (qd1 * -42.0);"), "{code}");
    assert!(code.contains("tau[1] = (motor_tau2 * 28.25) + (motor_tau3 * -28.25);"), "{code}");
}
