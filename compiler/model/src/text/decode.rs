//! Reads values out of the tree of a document: mappings with known keys, numbers, lists, words and texts.
//!
//! A reader gets a node and returns its value, or reports the mistake and returns `None`. So all mistakes of a file are
//! found, and a `None` always means that the file is refused.

mod context;
mod mapping;

pub(crate) use self::context::{Context, Parameter};
pub(crate) use self::mapping::{Fields, is_required, read_mapping};
use crate::parts::quantity::Quantity;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node, Scalar, Style};
use crate::text::expression::Expression;
use crate::text::source::inside;

/// Reads a finite number: a decimal or an expression. [`varying`](crate::readers::varying) checks which numbers may
/// depend on run-time parameters.
pub(crate) fn quantity(cx: &Context, node: &Node) -> Option<Quantity> {
    let Content::Scalar(scalar) = &node.content else { return cx.wrong_shape(node, "a number") };
    cx.problems.count(scalar.text.len().min(Expression::MAX_BYTES));
    let value = Expression::parse(&scalar.text).map_err(Some).and_then(|it| it.evaluate(&scalar.text, cx));
    match value {
        // -0 is 0: the sign of a zero carries no meaning in a table.
        Ok(quantity) => Some(quantity.without_negative_zero()),
        Err(None) => None,
        Err(Some(mistake)) => {
            // Points at the place of the mistake inside the scalar, unless escapes or line breaks make the value differ
            // from the text.
            let raw = cx.raw(node);
            let lead = usize::from(scalar.style == Style::Quoted);
            let literal = raw.get(lead..).is_some_and(|raw| raw.starts_with(scalar.text.trim_end()));
            let range = mistake.range.start + lead..mistake.range.end + lead;
            let span = if literal && !range.is_empty() { inside(&node.span, &range) } else { node.span.clone() };
            cx.refuse(Diagnostic::error(span, mistake.message).help(mistake.help))
        }
    }
}

/// Reads a list of exactly `N` numbers; `read` gets the index of each.
pub(crate) fn list<const N: usize>(
    cx: &Context,
    node: &Node,
    what: &str,
    read: impl Fn(&Context, &Node, usize) -> Option<f64>,
) -> Option<[f64; N]> {
    let Content::Sequence(items) = &node.content else {
        let help = separated::<N>(cx.raw(node));
        return cx.wrong_shape_with(node, &format!("a list of {N} numbers {what}"), help);
    };
    if items.len() != N {
        let message = format!("a list of {} where {N} numbers {what} are needed", items.len());
        let wrong = Diagnostic::error(node.span.clone(), message).label(format!("{N} numbers are needed"));
        return cx.refuse(wrong.maybe_help(separated::<N>(cx.raw(node))));
    }
    let values: Vec<Option<f64>> = items.iter().enumerate().map(|(index, item)| read(cx, item, index)).collect();
    values.into_iter().collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// Returns a help for `[0 -0.02 0]`, `0 0 0.3` or `[0, 0, 0,3]`, if `N` numbers can be recognised in the text.
fn separated<const N: usize>(raw: &str) -> Option<String> {
    let inner = raw.trim_start_matches('[').trim_end_matches(']').trim();
    if inner.len() > 100 {
        return None;
    }
    let words: Vec<&str> = inner.split_whitespace().map(|word| word.trim_end_matches(',')).collect();
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    if words.len() == N && words.iter().all(|word| is_number(word)) {
        return Some(format!("separate the numbers by commas: `[{}]`", words.join(", ")));
    }
    let points: Vec<String> = words.iter().map(|word| word.replacen(',', ".", 1)).collect();
    (words.len() == N && points.iter().all(|word| is_number(word)))
        .then(|| format!("the decimal sign is a point: `[{}]`", points.join(", ")))
}

/// Reads a number that must not be negative.
pub(crate) fn not_negative(
    what: &'static str,
    read: impl Fn(&Context, &Node) -> Option<f64>,
) -> impl Fn(&Context, &Node) -> Option<f64> {
    move |cx, node| {
        let value = read(cx, node)?;
        if value >= 0.0 {
            return Some(value);
        }
        let message = format!("the {what} {} is negative; it must be zero or positive", cx.shown(node, value));
        cx.refuse(Diagnostic::error(node.span.clone(), message).label("negative"))
    }
}

/// Reads a text that must not be empty. Numbers and `true` are accepted as texts, `~` and `null` are not.
pub(crate) fn text(cx: &Context, node: &Node) -> Option<String> {
    match &node.content {
        Content::Scalar(Scalar { text, style: Style::Plain }) if matches!(text.as_str(), "~" | "null") => {}
        Content::Scalar(Scalar { text, style: Style::Block }) if !text.trim().is_empty() => {
            return Some(text.trim_end().to_owned());
        }
        Content::Scalar(Scalar { text, .. }) if !text.trim().is_empty() => return Some(text.clone()),
        _ => {}
    }
    cx.wrong_shape(node, "a text")
}

/// Reads one of a few words.
pub(crate) fn choice<T: Copy>(cx: &Context, node: &Node, what: &str, words: &[(&'static str, T)]) -> Option<T> {
    let allowed = words.iter().map(|(word, _)| format!("`{word}`")).collect::<Vec<_>>().join(" or ");
    let Content::Scalar(scalar) = &node.content else { return cx.wrong_shape(node, &allowed) };
    if let Some((_, value)) = words.iter().find(|(word, _)| *word == scalar.text) {
        return Some(*value);
    }
    let message = format!("unknown {what} {}; it must be {allowed}", node.described());
    let meant = cx
        .did_you_mean(&scalar.text, words.iter().map(|(word, _)| *word))
        .or_else(|| synonym(&scalar.text).filter(|meant| words.iter().any(|(word, _)| word == meant)));
    cx.refuse(
        Diagnostic::error(node.span.clone(), message)
            .label(format!("must be {allowed}"))
            .maybe_help(meant.map(|meant| format!("did you mean `{meant}`?")).or_else(|| no_joint(what, &scalar.text))),
    )
}

/// Returns the help for a kind of joint of URDF that robot files do not have.
fn no_joint(what: &str, word: &str) -> Option<String> {
    (what == "joint type").then_some(())?;
    Some(match word.to_lowercase().as_str() {
        "fixed" => {
            "a robot file has no row for a fixed joint: add the mass, com and inertia of its link to the link before \
             it; after the last joint, write its offset as `tool`"
                .to_owned()
        }
        "floating" | "planar" | "spherical" | "ball" | "universal" | "cylindrical" | "screw" => {
            "write one revolute or prismatic joint for each degree of freedom, with massless links between these joints"
                .to_owned()
        }
        _ => return None,
    })
}

/// Returns the word of robot files for a word of other formats.
fn synonym(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "r" | "rotary" | "rotational" | "rotation" | "hinge" | "continuous" | "turning" => "revolute",
        "p" | "t" | "linear" | "translational" | "translation" | "sliding" | "slider" => "prismatic",
        "distal" | "classic" | "classical" | "paul" => "standard",
        "proximal" | "craig" | "khalil" | "mdh" => "modified",
        _ => return None,
    })
}
