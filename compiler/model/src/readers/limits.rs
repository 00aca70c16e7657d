//! Reads the key `limits` of a joint.

use crate::Limits;
use crate::readers::varying::fixed;
use crate::text::decode::{Context, list, not_negative, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::six_digits;

pub(crate) fn limits(cx: &Context, node: &Node) -> Option<Limits> {
    read_mapping!(cx, node, "`limits`", {
        position: optional "position" position_limits,
        velocity: optional "velocity" not_negative("velocity limit", fixed("the limit")),
        effort: optional "effort" not_negative("effort limit", fixed("the limit")),
    });
    Some(Limits { position, velocity, effort })
}

fn position_limits(cx: &Context, node: &Node) -> Option<(f64, f64)> {
    let [lower, upper] = list(cx, node, "[lower, upper] (rad or m)", |cx, node, _| fixed("the limit")(cx, node))?;
    if lower <= upper {
        return Some((lower, upper));
    }
    let message = format!(
        "the lower position limit {} lies above the upper one, {}; the order is [lower, upper]",
        six_digits(lower),
        six_digits(upper)
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).help("exchange the two"))
}
