//! Joints that follow others (`equality`), and closed loops, which are refused.

use rne_model::Report;

use super::LeftOut;
use super::element::Element;
use super::settings::Settings;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::source::quoted;
use crate::urdf::{Kind, Mimic, Urdf};

/// Couples joints by the equalities of the file: position = reference + polynomial of the other joint's position from
/// its reference.
pub(super) fn read(settings: &Settings, left_out: &mut LeftOut, root: &Element, urdf: &mut Urdf) -> Result<(), Report> {
    for element in root.below("equality") {
        let equality = settings.classed(element, 0)?;
        let name = element.text("name").unwrap_or(&element.name);
        if equality.flag("active")? == Some(false) {
            left_out.add("equalities that are not active are left out", name);
            continue;
        }
        if element.name != "joint" {
            let message = format!("the equality `{}` closes a loop, which the import does not convert", element.name);
            let help = "delete it to import the tree without this closed loop; a robot file describes closed loops \
                        in `loops`";
            return Err(equality.refused(message, help.to_owned()));
        }
        let find = |attribute: &str| {
            let Some(name) = equality.text(attribute) else { return Ok(None) };
            let Some(index) = urdf.joints.iter().position(|joint| joint.name == name) else {
                let message = format!("the equality names the joint {}, which does not exist", quoted(name));
                return Err(equality.refused(message, "there is no such joint in the file".to_owned()));
            };
            if urdf.joints[index].kind.has_one_freedom() {
                return Ok(Some(index));
            }
            let message = format!("the equality names the joint {}, which is neither hinge nor slide", quoted(name));
            Err(equality.refused(message, None))
        };
        let Some(joint) = find("joint1")? else {
            return Err(equality.refused("the equality lacks the attribute `joint1`", None));
        };
        let leader = find("joint2")?;
        let mut coefficients = equality.numbers("polycoef", 1, 5)?.unwrap_or(vec![0.0, 1.0]);
        coefficients.resize(5, 0.0);
        let [start, ratio, higher @ ..] = &coefficients[..] else { continue };
        if leader.is_some() && higher.iter().any(|coefficient| *coefficient != 0.0) {
            let message = format!(
                "the joint {} follows another one by a polynomial of a degree above 1",
                quoted(&urdf.joints[joint].name)
            );
            let help = "a robot file couples joints by a ratio and an offset: keep the first two numbers of `polycoef`";
            return Err(equality.refused(message, help.to_owned()));
        }
        if urdf.joints[joint].mimic.is_some() {
            let message = format!("the joint {} follows others twice", quoted(&urdf.joints[joint].name));
            return Err(equality.refused(message, "delete one of the equalities".to_owned()));
        }
        let reference = |joint: usize| decimal(urdf.joints[joint].reference);
        let start = reference(joint) + decimal(*start);
        if let Some(leader) = leader.filter(|_| *ratio != 0.0) {
            let offset = (start - decimal(*ratio) * reference(leader)).to_f64();
            let name = urdf.joints[leader].name.clone();
            urdf.joints[joint].mimic = Some(Mimic { joint: name, leader: Some(leader), multiplier: *ratio, offset });
        } else {
            let position = start.to_f64();
            left_out.add("joints that an equality holds are fixed", &urdf.joints[joint].name);
            hold(urdf, joint, position);
        }
    }
    Ok(())
}

/// Fixes a joint at a position.
fn hold(urdf: &mut Urdf, joint: usize, position: f64) {
    let joint = &mut urdf.joints[joint];
    let axis = Vector::decimal(joint.axis).direction().unwrap_or(Vector::unit(2));
    let moved = if joint.kind == Kind::Prismatic {
        Pose { rotation: Rotation::identity(), translation: axis * decimal(position) }
    } else {
        Pose { rotation: Rotation::about(axis, position), translation: Vector::ZERO }
    };
    (joint.xyz, joint.rpy) = super::body::placed(Pose::new(joint.xyz, joint.rpy) * moved);
    joint.kind = Kind::Fixed;
}
