//! Lints of closed loops.

use crate::loops::mobility::Remarks;
use crate::readers::loops::{listed, short};
use crate::text::decode::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::quoted;
use crate::{ClosedLoop, Joint};

/// Reports loops for which few closed configurations were found, loops that cannot move or are closed only beyond the
/// limits, and singular configurations within the limits.
pub(crate) fn closed_loops(cx: &Context, item: &Node, joints: &[Joint], loops: &[ClosedLoop], remarks: &Remarks) {
    let place = item.get("dependent").unwrap_or(item).head();
    if let Some((found, wanted)) = remarks.few {
        let message = format!("{found} of {wanted} configurations that close the loops were found");
        let help = "if position limits leave the loops more room than this, check the lengths";
        cx.report(Diagnostic::note(place.clone(), message).label("few configurations").help(help));
    }
    for closed in remarks.rigid.iter().filter_map(|&index| loops.get(index)) {
        let message = format!("the loop {} cannot move: all joints that move it are dependent", quoted(&closed.name));
        let help = "if it should move, check its lengths and axes; if it is a rigid frame, weld its links to one";
        cx.report(Diagnostic::lint(place.clone(), message).label("rigid").help(help));
    }
    if remarks.beyond {
        let message = "no configuration within the position limits was found that closes the loops";
        let help = "check the position limits of the joints of the loops, and the lengths";
        cx.report(Diagnostic::lint(place.clone(), message).label("beyond the limits").help(help));
    }
    // shows a zero as 0 although rounding left a tiny number
    let rounded = |position: f64| short(if position.abs() < 1e-9 { 0.0 } else { position });
    let at = |positions: &[f64]| {
        let shown = remarks.joints.iter().take(8);
        let shown = shown.map(|&joint| format!("{} = {}", joints[joint].name, rounded(positions[joint])));
        shown.collect::<Vec<_>>().join(", ")
    };
    if let Some((ratio, positions)) = &remarks.singular {
        let message = format!(
            "near {}, the other joints hardly determine {}: the smallest singular value of the equations is {} of the \
             largest there",
            at(positions),
            listed(joints, &remarks.undetermined),
            short(*ratio)
        );
        let help =
            "narrow the position limits so that the robot keeps away from there, or choose other dependent joints";
        cx.report(Diagnostic::note(place, message).label("a singular configuration").help(help));
    } else if let Some((ratio, positions)) = &remarks.pivot {
        let message = format!(
            "a pivot of the equations of the loops is {} of their largest singular value near {}: the order of \
             elimination is fixed",
            short(*ratio),
            at(positions)
        );
        let help = "narrow the position limits so that the robot keeps away from there";
        cx.report(Diagnostic::note(place, message).label("a small pivot").help(help));
    }
}
