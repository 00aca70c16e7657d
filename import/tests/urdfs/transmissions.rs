//! Gears and rotors of transmissions.

use super::*;

fn with(transmission: &str) -> String {
    pendulum("<axis xyz=\"0 1 0\"/><dynamics damping=\"8\" friction=\"6\"/>")
        .replace("</robot>", &format!("{transmission}</robot>"))
}

/// Torques with the rotor are those without and G² Jm q̈; friction at the joint is that of the URDF.
#[test]
fn a_transmission_is_the_gear_of_a_motor() {
    let drake = "<transmission name=\"t\"><type>SimpleTransmission</type><joint name=\"hinge\"/><actuator name=\"m\">\
                 <drake:gear_ratio value=\"-20\"/><drake:rotor_inertia value=\"0.003\"/></actuator></transmission>";
    let Imported { robot, text, .. } = plain(&with(drake));
    assert!(text.contains("motor: {inertia: 0.003, gear_ratio: -20, viscous: 0.02, coulomb: [0.3, -0.3]}"), "{text}");
    let [without, with_rotor] = [DynArm::from_robot(&robot), DynArm::from_robot(&robot).with_rotors()]
        .map(|arm| arm.inverse_dynamics(&[0.3], &[0.4], &[2.0]).unwrap()[0]);
    assert_close(&[with_rotor - without], &[400.0 * 0.003 * 2.0], 1e-12);
    let ros = "<transmission name=\"t\"><type>transmission_interface/SimpleTransmission</type><joint name=\"hinge\">\
               <hardwareInterface>EffortJointInterface</hardwareInterface></joint><actuator name=\"m\">\
               <mechanicalReduction> 40 </mechanicalReduction></actuator></transmission>";
    let Imported { text, account, .. } = plain(&with(ros));
    assert!(text.contains("motor: {gear_ratio: 40, viscous: 0.005, coulomb: [0.15, -0.15]}"), "{text}");
    assert_eq!(account.sentences(), Vec::<String>::new());
}

#[test]
fn other_transmissions_are_noted_or_refused() {
    let left_out = "the transmission `t` is left out";
    let of = |parts: &str| with(&format!("<transmission name=\"t\">{parts}</transmission>"));
    let reduction = "<actuator name=\"m\"><mechanicalReduction>2</mechanicalReduction></actuator>";
    for parts in [
        format!("<joint name=\"hinge\"/><joint name=\"other\"/>{reduction}"),
        format!("<joint name=\"other\"/>{reduction}"),
        format!("<joint name=\"hinge\"/>{reduction}{reduction}"),
    ] {
        let remarks = plain(&of(&parts)).account.sentences();
        assert!(remarks.len() == 1 && remarks[0].starts_with(left_out), "{remarks:?}");
    }
    for number in ["0", "nan", "1e9", "two"] {
        let said = refused(&of(&reduction.replace('2', number)), &Options::default());
        assert!(said.contains("a ratio is a number from 1e-6 to 1e6"), "{said}");
    }
    let said = refused(&of("<rotor_inertia value=\"-1\"/>"), &Options::default());
    assert!(said.contains("it must be a number from 0 to 1e9"), "{said}");
    let one = of(&format!("<joint name=\"hinge\"/>{}", reduction.replace('2', "1.0")));
    assert_eq!(plain(&one).account.sentences(), Vec::<String>::new());
}
