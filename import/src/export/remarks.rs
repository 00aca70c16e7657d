//! Remarks on what a URDF cannot express of a robot.

use rne_model::{Joint, Motor, Robot, exact_digits, one_line};

use super::friction::Friction;
use crate::chain::Chain;

/// Returns remarks on what the URDF of a robot lacks. `gravity` is in the axes of its root link, whose name is `root`.
pub(super) fn remarks(robot: &Robot, chain: &Chain, gravity: [f64; 3], root: &str) -> Vec<String> {
    let mut remarks = Vec::new();
    let [x, y, z] = gravity;
    if x != 0.0 || y != 0.0 || (z + 9.81).abs() > 1e-14 {
        let [x, y, z] = gravity.map(exact_digits);
        remarks.push(format!(
            "gravity is [{x}, {y}, {z}] m/s² in the axes of `{root}`; if your program has another default, set this \
             gravity: model.gravity.linear = np.array([{x}, {y}, {z}])"
        ));
    }
    remarks.extend(of_motors(robot));
    if !robot.contacts.is_empty() {
        let names = robot.tip_names();
        let contacts: Vec<&str> = robot.contacts.iter().map(|contact| names[contact.tip]).collect();
        remarks.push(format!(
            "the contacts at {} are left out: a URDF has no place for them, and has these tips as links",
            contacts.join(", ")
        ));
    }
    let without = chain.joints.iter().filter(|joint| joint.limits.effort.is_none() || joint.limits.velocity.is_none());
    let without: Vec<&str> = without.map(|joint| joint.name.as_str()).collect();
    if !without.is_empty() {
        let joints = if without.len() == chain.joints.len() { "all joints".to_owned() } else { without.join(", ") };
        remarks.push(format!(
            "the robot file has no limit of effort or velocity for {joints}; a URDF must have both, so the missing \
             ones are 0, which some programs take for a joint that cannot move"
        ));
    }
    remarks
}

/// Lists the data of motors that a URDF cannot contain.
fn of_motors(robot: &Robot) -> Vec<String> {
    let mut remarks = Vec::new();
    let motors = || robot.joints.iter().filter_map(|joint| Some((one_line(&joint.name), joint.motor?)));
    if motors().any(|(_, motor)| motor.inertia != 0.0 || motor.gear_ratio != 1.0) {
        let and =
            if motors().any(|(_, motor)| Friction::of(&motor).is_some()) { ", except their friction" } else { "" };
        remarks.push(format!("motors are left out{and}: a URDF has no place for gears and rotors"));
    }
    if !robot.drives.is_empty() {
        let names: Vec<String> = robot.drives.iter().map(|drive| one_line(&drive.name)).collect();
        remarks.push(format!(
            "these motors of the list `motors` are left out, with their rotors: {}; a URDF has no place for motors \
             that turn with several joints, and for rotors that spin on a link",
            names.join(", ")
        ));
    }
    let named = |is_so: fn(&Motor) -> bool| {
        let names: Vec<String> = motors().filter(|(_, motor)| is_so(motor)).map(|(name, _)| name).collect();
        (!names.is_empty()).then(|| names.join(", "))
    };
    if let Some(names) = named(|motor| motor.coulomb[0] != -motor.coulomb[1]) {
        remarks.push(format!(
            "Coulomb friction that differs with the direction is written as its mean, because a URDF has only one \
             value: {names}"
        ));
    }
    let has_transition = |joint: &&Joint| joint.coulomb_width.is_some() || joint.coulomb_displacement.is_some();
    let transitions: Vec<String> =
        robot.joints.iter().filter(has_transition).map(|joint| one_line(&joint.name)).collect();
    if !transitions.is_empty() {
        remarks.push(format!(
            "how Coulomb friction changes its sign, `coulomb_width` and `coulomb_displacement`, is left out, because \
             in a URDF the friction jumps: {}",
            transitions.join(", ")
        ));
    }
    if let Some(names) = named(|motor| Friction::at_joint(motor).is_none()) {
        remarks.push(format!(
            "the friction of these joints is left out, because it is too large for a 64-bit float: {names}"
        ));
    }
    remarks
}
