//! Reads texts of a robot file.

use crate::lints::single_value;
use crate::text::decode::{Context, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::{is_control, is_line_break, quoted};

/// Reads a text that must have one line, because headings and comments of generated code contain it.
pub(crate) fn text_of_one_line(cx: &Context, node: &Node, what: &str) -> Option<String> {
    let text = printable(cx, node, &format!("the {what}"), is_line_break)?;
    if !text.contains(is_line_break) {
        return Some(text);
    }
    let message = format!("the {what} {} has a line break; a {what} is one line", quoted(&text));
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("more than one line"))
}

/// Reads a text that may have several lines.
pub(crate) fn lines(cx: &Context, node: &Node) -> Option<String> {
    printable(cx, node, "the text", |c| is_line_break(c) || c == '\t')
}

/// Reads a text and refuses control characters, except those that `is_allowed` accepts.
fn printable(cx: &Context, node: &Node, what: &str, is_allowed: impl Fn(char) -> bool) -> Option<String> {
    let text = text(cx, node)?;
    let Some(control) = text.chars().find(|&c| is_control(c) && !is_allowed(c)) else {
        single_value::invisible(cx, node, &text);
        return Some(text);
    };
    let message = format!(
        "{what} {} has the control character U+{:04X}; it must be readable text",
        quoted(&text),
        u32::from(control)
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("control character"))
}
