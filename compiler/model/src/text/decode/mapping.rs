//! Reads mappings with known keys, and gives help for unknown keys.

use super::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Entry, Node};
use crate::text::keys::Mapping;
use crate::text::source::{one_line, quoted};

/// Reads a mapping by a table of its keys, one line each:
/// `variable: required "key" reader`, `variable: optional "key" reader` or `variable: or(default) "key" reader`.
///
/// Every key is read before the first `None` returns, so that every mistake is reported.
macro_rules! read_mapping {
    ($cx:ident, $node:ident, $what:literal, {
        $($variable:ident: $rule:ident $(($default:expr))? $key:literal $reader:expr,)*
    }) => {
        let keys = const {
            &[$($crate::Key { name: $key, is_required: $crate::text::decode::is_required(stringify!($rule)) }),*]
        };
        let fields = $crate::text::decode::Fields::open($cx, $node, $crate::Mapping { name: $what, keys })?;
        $(let $variable = fields.$rule($key, $($default,)? $reader);)*
        $(let $variable = $variable?;)*
    };
}
pub(crate) use read_mapping;

/// Returns whether a rule of [`read_mapping`] begins with the word `required`.
pub(crate) const fn is_required(rule: &str) -> bool {
    matches!(rule.as_bytes(), [b'r', ..])
}

/// The keys of a mapping while they are read.
pub(crate) struct Fields<'d> {
    cx: &'d Context<'d>,
    node: &'d Node,
    what: &'static str,
    /// Keys for which a misspelling has been reported already.
    misspelt: Vec<&'static str>,
}

impl<'d> Fields<'d> {
    /// Opens a mapping and reports every key that it may not have.
    pub(crate) fn open(cx: &'d Context<'d>, node: &'d Node, mapping: Mapping) -> Option<Self> {
        let what = mapping.name;
        let allowed: Vec<&'static str> = mapping.keys.iter().map(|key| key.name).collect();
        cx.opens(mapping);
        let Content::Mapping(entries) = &node.content else {
            let expected = format!("a mapping ({})", allowed.join(", "));
            if !allowed.contains(&"convention") {
                return cx.wrong_shape(node, &expected);
            }
            let message = format!("found {} where {expected} is needed", node.described());
            let help = "a robot file begins with `format: 1`, or with `format: 2`";
            return cx.refuse(Diagnostic::error(node.head(), message).label("no robot file").help(help));
        };
        // Each key is compared with the allowed ones, and each allowed key is searched among them.
        cx.problems.count(2 * entries.len() * allowed.len());
        let missing: Vec<_> = allowed.iter().copied().filter(|allowed| node.get(allowed).is_none()).collect();
        let mut misspelt = Vec::new();
        for (index, entry) in entries.iter().enumerate().filter(|(_, it)| !allowed.contains(&it.key.as_str())) {
            let Entry { key, key_span, .. } = entry;
            if let Some((meant, mistake)) = without_blank(entry, &missing) {
                misspelt.push(meant);
                cx.report(mistake);
                continue;
            }
            let before = index.checked_sub(1).and_then(|before| entries.get(before));
            if let Some(mistake) = before.and_then(|before| decimals(cx, before, entry)) {
                cx.report(mistake);
                continue;
            }
            if allowed.contains(&"position") && matches!(key.as_str(), "lower" | "upper") {
                if key == "lower" || node.get("lower").is_none() {
                    cx.report(one_position(cx, node, entry));
                }
                continue;
            }
            let synonym = SYNONYMS.iter().find(|(word, meant)| word == key && missing.contains(meant));
            let meant = synonym.map(|(_, meant)| *meant);
            let meant = meant.or_else(|| cx.did_you_mean(key, missing.iter().copied()));
            misspelt.extend(meant);
            let message = format!("unknown key {}; {what} has the keys {}", quoted(key), allowed.join(", "));
            let help = meant.map(|meant| format!("did you mean `{meant}`?")).or_else(|| place_of(key, &allowed));
            cx.report(Diagnostic::error(key_span.clone(), message).label("unknown key").maybe_help(help));
        }
        Some(Self { cx, node, what, misspelt })
    }

    /// Reads the value of a key that must be there.
    pub(crate) fn required<T>(
        &self,
        key: &'static str,
        reader: impl FnOnce(&Context, &Node) -> Option<T>,
    ) -> Option<T> {
        if let Some(node) = self.node.get(key) {
            return reader(self.cx, node);
        }
        if self.misspelt.contains(&key) {
            return None;
        }
        let message = format!("{} lacks the required key `{key}`", self.what);
        let missing = Diagnostic::error(self.node.head(), message).label(format!("`{key}` is missing"));
        self.cx.refuse(missing.maybe_help(how_to_write(key).map(str::to_owned)))
    }

    /// Reads the value of a key, or returns `default` when the key is not there.
    pub(crate) fn or<T>(
        &self,
        key: &'static str,
        default: T,
        reader: impl FnOnce(&Context, &Node) -> Option<T>,
    ) -> Option<T> {
        match self.node.get(key) {
            Some(node) => reader(self.cx, node),
            // The value of a misspelt key is unknown, and the default instead of it could only cause further messages.
            None => (!self.misspelt.contains(&key)).then_some(default),
        }
    }

    /// Reads the value of a key; returns `Some(None)` when the key is not there.
    #[allow(clippy::option_option)] // the outer `None`, as everywhere here, is a reported mistake
    pub(crate) fn optional<T>(
        &self,
        key: &'static str,
        reader: impl FnOnce(&Context, &Node) -> Option<T>,
    ) -> Option<Option<T>> {
        self.or(key, None, |cx, node| reader(cx, node).map(Some))
    }
}

/// Returns an example of a required key.
fn how_to_write(key: &str) -> Option<&'static str> {
    Some(match key {
        "format" => "begin the file with `format: 1`",
        "source" => "write where the numbers come from, such as `source: \"own measurement\"`",
        "convention" => {
            "write `convention: standard` (Rz(theta) Tz(d) Tx(a) Rx(alpha)) or `convention: modified` (Rx(alpha) Tx(a) \
             Rz(theta) Tz(d)); rne never guesses the convention"
        }
        "gravity" => "write the acceleration of gravity in frame 0 in m/s², such as `gravity: [0, 0, -9.81]`",
        "on" => "write the name of the joint that moves the link, such as `on: joint6`, or `on: base` for frame 0",
        "type" => "write `type: revolute` or `type: prismatic`",
        "dh" | "theta" | "d" | "a" | "alpha" => {
            "all four numbers of `dh` are required, such as `dh: {theta: 0, d: 0.4, a: 0, alpha: pi/2}`"
        }
        _ => return None,
    })
}

/// Recognises `theta:0` or `theta 0`, which YAML reads as a key without a value. Returns the key that is meant, and the
/// error.
fn without_blank(entry: &Entry, missing: &[&'static str]) -> Option<(&'static str, Diagnostic)> {
    let at = entry.key.find([':', ' '])?;
    let (key, value) = (entry.key.get(..at)?, entry.key.get(at + 1..)?);
    let lacks = if entry.key.get(at..)?.starts_with(':') { "a blank" } else { "a colon" };
    let meant = missing.iter().copied().find(|missing| *missing == key)?;
    let key = entry.key.get(..=at)?.trim_end();
    let message = format!("{lacks} is missing between `{key}` and its value {}", quoted(value));
    let help = format!("write `{meant}: {}`", one_line(value));
    let label = format!("{lacks} is missing");
    Some((meant, Diagnostic::error(entry.key_span.clone(), message).label(label).help(help)))
}

/// Words of other formats and books, with the keys of robot files that mean the same.
const SYNONYMS: [(&str, &str); 4] =
    [("weight", "mass"), ("ratio", "gear_ratio"), ("cog", "com"), ("tensor", "inertia")];

/// Recognises `{mass: 1,98}`, which YAML reads as the value 1 and a key `98`.
fn decimals(cx: &Context, before: &Entry, entry: &Entry) -> Option<Diagnostic> {
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let (Content::Scalar(whole), Content::Scalar(nothing)) = (&before.value.content, &entry.value.content) else {
        return None;
    };
    let joined = format!("{},{}", whole.text, entry.key);
    let is_comma = nothing.text.is_empty() && digits(whole.text.trim_start_matches('-')) && digits(&entry.key);
    // With a blank after the comma, two values are meant.
    let is_tight = cx.text.get(before.value.span.start..entry.key_span.end) == Some(joined.as_str());
    (is_comma && is_tight).then(|| {
        let message = format!("`{joined}` is read as two values, because the decimal sign is a point");
        let help = format!("write `{}: {}.{}`", one_line(&before.key), whole.text, entry.key);
        Diagnostic::error(before.value.span.start..entry.key_span.end, message).label("a decimal comma?").help(help)
    })
}

/// Makes the error for position limits as two keys, `{lower: -pi, upper: pi}`, which is the form of URDF.
fn one_position(cx: &Context, limits: &Node, entry: &Entry) -> Diagnostic {
    let limit = |key| limits.get(key).map_or_else(|| "…".to_owned(), |node| one_line(cx.raw(node)));
    let help = format!("write `position: [{}, {}]`", limit("lower"), limit("upper"));
    let message = format!("unknown key {}; the two limits of a position are one list", quoted(&entry.key));
    Diagnostic::error(entry.key_span.clone(), message).label("unknown key").help(help)
}

/// Returns help for a known key in the wrong mapping: where it belongs, or what to write instead; `allowed` are the
/// keys of this mapping.
fn place_of(key: &str, allowed: &[&str]) -> Option<String> {
    if allowed.contains(&"dh") && !key.is_empty() && key.chars().all(|c| c.is_ascii_digit()) {
        return Some(format!(
            "joints are not numbered, because their order counts: delete `{key}:`, so that the joint begins with `- \
             type: …`"
        ));
    }
    let place = match key {
        "first_moment" if allowed.contains(&"mass") => return Some("only the link of a joint has this key".to_owned()),
        "physical" if allowed.contains(&"mass") => return Some("only a link has this key".to_owned()),
        "theta" | "d" | "a" | "alpha" | "gamma" | "b" => "`dh`",
        "mass" | "com" | "first_moment" | "inertia" | "inertia_about" | "physical" => "`link`",
        "position" | "velocity" | "effort" => "`limits`",
        "gear_ratio" | "viscous" | "coulomb" | "coulomb_width" | "coulomb_displacement" => "`motor`",
        "follows" => "an entry of `couplings`",
        "turns" | "rotor" => "an entry of `motors`",
        "axis" => "`rotor`, in an entry of `motors`",
        "between" | "cut" | "dependent" => "an entry of `loops`",
        "xyz" | "rpy" => "`base`, `tool`, `at` or an entry of `frames`",
        "<<" => return Some("YAML merge keys are not part of the format; write the keys out".to_owned()),
        "offset" if allowed.contains(&"dh") => {
            return Some("write the offset of the joint as the constant in `theta` or `d`".to_owned());
        }
        _ => return None,
    };
    Some(format!("`{key}` belongs under {place}"))
}
