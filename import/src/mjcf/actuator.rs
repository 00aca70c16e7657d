//! Reads the actuators of joints: force limits, rotors and damping.

use std::collections::HashMap;

use rne_model::Report;

use super::body::effort;
use super::element::Element;
use super::settings::Settings;
use super::{LeftOut, is_there};
use crate::source::quoted;
use crate::urdf::Urdf;

/// Gives joints the data of their actuators. The force at a joint is the force of its actuator times the gear ratio.
pub(super) fn read(settings: &Settings, left_out: &mut LeftOut, root: &Element, urdf: &mut Urdf) -> Result<(), Report> {
    let joints: HashMap<String, usize> =
        urdf.joints.iter().enumerate().map(|(index, joint)| (joint.name.clone(), index)).collect();
    let mut limits: Vec<(usize, Option<(f64, f64)>)> = Vec::new();
    for element in root.below("actuator") {
        let actuator = settings.classed(element, 0)?;
        let Some(name) = actuator.text("joint").or_else(|| actuator.text("jointinparent")) else {
            if let Some(tendon) = actuator.text("tendon")
                && is_there(actuator, &["armature", "damping"])?
            {
                left_out.add_felt("rotors and damping of actuators on tendons are left out", tendon);
            }
            continue;
        };
        let Some(&joint) = joints.get(name) else {
            let message = format!("the actuator is one of the joint {}, which does not exist", quoted(name));
            return Err(actuator.refused(message, "there is no such joint in the file"));
        };
        let gear = actuator.first("gear", 6)?.unwrap_or(1.0);
        let force = actuator.range("forcerange", "forcelimited")?;
        // the control signal of a motor is its force, so its range limits the force
        let control = if element.name == "motor" { actuator.range("ctrlrange", "ctrllimited")? } else { None };
        let narrower = |one: (f64, f64), other: (f64, f64)| (one.0.max(other.0), one.1.min(other.1));
        let range = match (force, control) {
            (Some(force), Some(control)) => Some(narrower(force, control)),
            (force, control) => force.or(control),
        };
        limits.push((
            joint,
            range.map(|(low, high)| {
                let (low, high) = (low * gear, high * gear);
                (low.min(high), low.max(high))
            }),
        ));
        let rotor = actuator.number("armature")?.unwrap_or(0.0);
        urdf.joints[joint].rotor_inertia += gear * gear * rotor;
        if is_there(actuator, &["damping"])? {
            left_out.add_felt("forces that damp actuators are left out", name);
        }
    }
    if !limits.is_empty() {
        for (index, joint) in urdf.joints.iter_mut().enumerate() {
            joint.has_motor = Some(limits.iter().any(|(with_motor, _)| *with_motor == index));
        }
    }
    for (joint, range) in &limits {
        // the torque of a joint with several actuators is their sum, so no single range limits it
        let is_alone = limits.iter().filter(|(other, _)| other == joint).count() == 1;
        let Some(range) = range.filter(|_| is_alone) else { continue };
        let joint = &mut urdf.joints[*joint];
        let limit = effort(left_out, &joint.name, range);
        joint.limits.effort = match (joint.limits.effort, limit) {
            (Some(one), Some(other)) => Some(one.min(other)),
            (one, other) => one.or(other),
        };
    }
    Ok(())
}
