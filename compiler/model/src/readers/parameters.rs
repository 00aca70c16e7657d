//! Reads the mapping `parameters` of a robot file: numbers with names.

use std::cell::Cell;

use crate::parts::quantity::Quantity;
use crate::text::decode::{Context, Parameter, quantity};
use crate::text::diagnostic::Diagnostic;
use crate::text::document;
use crate::text::document::{Content, Node};
use crate::text::expression::{Meaning, is_identifier, is_reserved};
use crate::text::source::quoted;

/// Largest number of parameters, more than if every number of 64 joints had a name of its own.
const MAX_PARAMETERS: usize = 2000;

pub(crate) fn parameters(cx: &Context, node: &Node) -> Option<Vec<(String, f64)>> {
    let Content::Mapping(entries) = &node.content else {
        let message = format!("found {} where a mapping from names to numbers is needed", node.described());
        return cx.refuse(Diagnostic::error(node.head(), message).help("such as `parameters: {m: 1.5, a: 0.6}`"));
    };
    if let Some(excess) = entries.get(MAX_PARAMETERS) {
        let message = format!("{} parameters; at most {MAX_PARAMETERS} are allowed", entries.len());
        return cx.refuse(Diagnostic::error(excess.key_span.clone(), message));
    }
    let declared = |entry: &document::Entry| {
        let span = entry.key_span.clone();
        let value = entry.value.span.clone();
        (entry.key.clone(), Parameter { span, value, meaning: Meaning::Later, used: Cell::new(false) })
    };
    // a repeated name is an error already; reversed, so that the first entry is the one that remains
    *cx.parameters.borrow_mut() = entries.iter().rev().map(declared).collect();
    let mut values = Vec::new();
    for (index, document::Entry { key, key_span, value }) in entries.iter().enumerate() {
        let name = parameter_name(cx, key, key_span.clone());
        let mut quantity = quantity(cx, value);
        if let Some(&(_, set)) = cx.settings.iter().find(|(name, _)| name == key) {
            quantity = quantity.map(|_| Quantity::constant(set));
        }
        values.push(name.zip(quantity.as_ref().map(|quantity| quantity.value)));
        if let Some(own) = cx.run_time_index(key) {
            // A run-time parameter replaces the formula of its own expression: in the file it only has a value.
            quantity = quantity.map(|quantity| Quantity::parameter(own, quantity.value));
        } else if let Some(formula) = quantity.as_ref().and_then(Quantity::varying) {
            cx.run_time.borrow_mut().parameters.push((index, formula.clone()));
        }
        if let Some(parameter) = cx.parameters.borrow_mut().get_mut(key).filter(|known| known.span == *key_span) {
            parameter.meaning = quantity.map_or(Meaning::Faulty, Meaning::Value);
        }
    }
    values.into_iter().collect()
}

fn parameter_name(cx: &Context, name: &str, span: std::ops::Range<usize>) -> Option<String> {
    if is_reserved(name) {
        let message = format!("the parameter name `{name}` already has a meaning in every expression");
        return cx
            .refuse(Diagnostic::error(span, message).help("choose another name than pi, sqrt, sin, cos, tan, deg"));
    }
    if !is_identifier(name) {
        let message = format!(
            "the parameter name {} is not an identifier; it must be a letter from a to z or `_`, then letters, digits \
             and `_`",
            quoted(name)
        );
        return cx.refuse(Diagnostic::error(span, message));
    }
    Some(name.to_owned())
}
