//! Reads the key `motor` of a joint.

use crate::readers::varying::{entry, fixed};
use crate::text::decode::{Context, list, not_negative, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::{Entry, Motor, lints::single_value};

/// Reads the motor; also the speed about which its friction changes sign, and the displacement over which it does.
pub(crate) fn motor(cx: &Context, node: &Node, joint: usize) -> Option<(Motor, [Option<f64>; 2])> {
    read_mapping!(cx, node, "`motor`", {
        inertia: or(0.0) "inertia" not_negative("rotor inertia", entry(Entry::MotorInertia(joint))),
        gear_ratio: or(1.0) "gear_ratio" |cx, node| gear_ratio(cx, node, joint),
        viscous: or(0.0) "viscous" not_negative("viscous friction", entry(Entry::Viscous(joint))),
        coulomb: or([0.0; 2]) "coulomb" |cx, node| coulomb(cx, node, joint),
        width: optional "coulomb_width" not_negative("width", fixed("the width")),
        displacement: optional "coulomb_displacement" not_negative("displacement", fixed("the displacement")),
    });
    if let (Some(of_width), Some(_)) = (node.get("coulomb_width"), node.get("coulomb_displacement")) {
        single_value::width_beside_displacement(cx, of_width);
    }
    Some((Motor { inertia, gear_ratio, viscous, coulomb }, [width, displacement]))
}

fn gear_ratio(cx: &Context, node: &Node, joint: usize) -> Option<f64> {
    let ratio = entry(Entry::GearRatio(joint))(cx, node)?;
    if ratio != 0.0 {
        return Some(ratio);
    }
    let message = format!("the gear ratio {} is zero; it must be motor turns per joint turn", cx.shown(node, ratio));
    cx.refuse(Diagnostic::error(node.span.clone(), message).help("a direct drive has `gear_ratio: 1`, the default"))
}

fn coulomb(cx: &Context, node: &Node, joint: usize) -> Option<[f64; 2]> {
    let places = [Entry::CoulombPositive(joint), Entry::CoulombNegative(joint)];
    let values: [f64; 2] =
        list(cx, node, "[Tc⁺, Tc⁻] (N m)", |cx, node, index| entry(*places.get(index)?)(cx, node))?;
    let Content::Sequence(items) = &node.content else { return None };
    let mut valid = true;
    for (item, value, sign, (name, rule)) in [
        (items.first(), values[0], 1.0, ("positive", "zero or positive")),
        (items.last(), values[1], -1.0, ("negative", "zero or negative")),
    ] {
        let Some(item) = item.filter(|_| sign * value < 0.0) else { continue };
        valid = false;
        let message = format!(
            "the Coulomb friction {} for {name} speed has the wrong sign; it must be {rule}",
            cx.shown(item, value)
        );
        cx.report(Diagnostic::error(item.span.clone(), message).help("the order is [Tc⁺, Tc⁻], Tc⁺ ≥ 0, Tc⁻ ≤ 0"));
    }
    valid.then_some(values)
}
