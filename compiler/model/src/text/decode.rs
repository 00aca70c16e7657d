//! Reading shapes out of the tree: mappings with known keys, numbers, lists, words and texts.
//!
//! A reader gets a node and returns its value, or reports what is wrong and returns `None`. So one file's mistakes are
//! all found, and a `None` always means that the file is refused.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;

use crate::RunTime;
use crate::parts::quantity::Quantity;
use crate::text::diagnostic::{Diagnostic, Problems};
use crate::text::document::{Content, Entry, Node, Scalar, Style};
use crate::text::expression::{Expression, Meaning, Names};
use crate::text::keys::Mapping;
use crate::text::source::{inside, one_line, quoted, six_digits};
use crate::text::spelling::{LONGEST_WORD, did_you_mean};

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

/// Whether a rule of [`read_mapping`] is `required`, which alone begins so.
pub(crate) const fn is_required(rule: &str) -> bool {
    matches!(rule.as_bytes(), [b'r', ..])
}

/// The state that every reader needs: the text, the names of the numbers, and where mistakes go.
pub(crate) struct Context<'t> {
    pub(crate) text: &'t str,
    pub(crate) problems: &'t Problems,
    /// The named constants; in the order of their names, so that suggestions do not depend on chance.
    pub(crate) parameters: RefCell<BTreeMap<String, Parameter>>,
    /// The parameters that stay free until run time, and what is found to depend on them.
    pub(crate) run_time: RefCell<RunTime>,
    /// Parameters that have another value than that of the file.
    pub(crate) settings: &'t [(&'t str, f64)],
    /// The mappings that the format has, of those the file opens; once each.
    pub(crate) mappings: RefCell<Vec<Mapping>>,
    /// The name of the floating base, if the file has one: it means the same as `base`.
    pub(crate) base_name: RefCell<Option<String>>,
    /// How many unknown words were compared with known ones.
    suggestions: Cell<usize>,
}

/// A named constant of the file.
pub(crate) struct Parameter {
    pub(crate) span: Range<usize>,
    /// The place of its expression.
    pub(crate) value: Range<usize>,
    pub(crate) meaning: Meaning,
    pub(crate) used: Cell<bool>,
}

impl Names for Context<'_> {
    fn meaning(&self, name: &str) -> Meaning {
        let parameters = self.parameters.borrow();
        parameters.get(name).map_or(Meaning::Unknown, |parameter| {
            parameter.used.set(true);
            if let Meaning::Value(quantity) = &parameter.meaning {
                self.count(quantity.parts());
            }
            parameter.meaning.clone()
        })
    }

    fn similar(&self, name: &str) -> Option<String> {
        let parameters = self.parameters.borrow();
        self.did_you_mean(name, parameters.keys().map(String::as_str)).map(str::to_owned)
    }

    fn run_time_parameter(&self, index: usize) -> String {
        self.parameter_name(Some(index))
    }

    fn count(&self, steps: usize) {
        self.problems.count(steps);
    }
}

impl<'t> Context<'t> {
    /// `run_time` are the names of the parameters that stay free until run time.
    pub(crate) fn new(text: &'t str, problems: &'t Problems, run_time: &[&str]) -> Self {
        let names = run_time.iter().map(|&name| name.to_owned()).collect();
        let run_time = RefCell::new(RunTime { names, ..RunTime::default() });
        Self {
            text,
            problems,
            parameters: RefCell::default(),
            run_time,
            settings: &[],
            mappings: RefCell::default(),
            base_name: RefCell::default(),
            suggestions: Cell::new(0),
        }
    }

    /// With other values of these parameters.
    pub(crate) fn with_settings(self, settings: &'t [(&'t str, f64)]) -> Self {
        Self { settings, ..self }
    }

    /// The candidate that `word` was probably meant to be. So many candidates and so many words bound the work that a
    /// file of nothing but unknown words can cause; a report shows fewer mistakes.
    pub(crate) fn did_you_mean<'c>(
        &self,
        word: &str,
        candidates: impl IntoIterator<Item = &'c str>,
    ) -> Option<&'c str> {
        const MOST: usize = 100;
        self.suggestions.set(self.suggestions.get() + 1);
        if self.suggestions.get() > MOST {
            return None;
        }
        // What is so much longer is not meant; a character has at most four bytes.
        let candidates = candidates.into_iter().take(MOST).filter(|candidate| candidate.len() <= 8 * LONGEST_WORD);
        let compared = |candidate: &&str| self.problems.count(candidate.len() * word.len().min(LONGEST_WORD));
        did_you_mean(word, candidates.inspect(compared))
    }

    /// Whether a mistake is found already.
    pub(crate) fn has_errors(&self) -> bool {
        self.problems.has_errors()
    }

    /// Index of the run-time parameter with this name, if there is one.
    pub(crate) fn run_time_index(&self, name: &str) -> Option<usize> {
        self.run_time.borrow().names.iter().position(|known| known == name)
    }

    /// The name of a run-time parameter.
    pub(crate) fn parameter_name(&self, index: Option<usize>) -> String {
        let run_time = self.run_time.borrow();
        index.and_then(|index| run_time.names.get(index)).cloned().unwrap_or_default()
    }

    fn opens(&self, mapping: Mapping) {
        let mut mappings = self.mappings.borrow_mut();
        if mappings.iter().all(|known| known.name != mapping.name) {
            mappings.push(mapping);
        }
    }

    pub(crate) fn report(&self, diagnostic: Diagnostic) {
        self.problems.push(diagnostic);
    }

    /// Reports a mistake in place of a value.
    pub(crate) fn refuse<T>(&self, diagnostic: Diagnostic) -> Option<T> {
        self.report(diagnostic);
        None
    }

    fn wrong_shape<T>(&self, node: &Node, expected: &str) -> Option<T> {
        self.wrong_shape_with(node, expected, None)
    }

    fn wrong_shape_with<T>(&self, node: &Node, expected: &str, help: Option<String>) -> Option<T> {
        let message = format!("found {} where {expected} is needed", node.described());
        self.refuse(Diagnostic::error(node.head(), message).label(format!("{expected} is needed")).maybe_help(help))
    }

    /// The text as it stands in the file, for messages and suggestions.
    pub(crate) fn raw(&self, node: &Node) -> &'t str {
        self.text.get(node.span.clone()).unwrap_or_default()
    }

    /// A number as its author wrote it, with the value where that is an expression.
    pub(crate) fn shown(&self, node: &Node, value: f64) -> String {
        let raw = self.raw(node);
        match raw.parse::<f64>() {
            Ok(_) => quoted(raw),
            Err(_) => format!("{} = {}", quoted(raw), six_digits(value)),
        }
    }
}

/// The keys of one mapping, while they are read.
pub(crate) struct Fields<'d> {
    cx: &'d Context<'d>,
    node: &'d Node,
    what: &'static str,
    /// Keys for which a misspelling is already reported.
    misspelt: Vec<&'static str>,
}

impl<'d> Fields<'d> {
    /// Opens a mapping; every key that it may not have is reported here.
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
        // Each key is compared with those allowed, and looked for by each of them.
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

    /// The value of a key that must be there.
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

    /// The value of a key, or `default` when it is not there.
    pub(crate) fn or<T>(
        &self,
        key: &'static str,
        default: T,
        reader: impl FnOnce(&Context, &Node) -> Option<T>,
    ) -> Option<T> {
        match self.node.get(key) {
            Some(node) => reader(self.cx, node),
            // What a misspelt key holds is unknown: the default would only cause further complaints.
            None => (!self.misspelt.contains(&key)).then_some(default),
        }
    }

    /// The value of a key; `Some(None)` when it is not there.
    #[allow(clippy::option_option)] // the outer `None`, as everywhere here, is a reported mistake
    pub(crate) fn optional<T>(
        &self,
        key: &'static str,
        reader: impl FnOnce(&Context, &Node) -> Option<T>,
    ) -> Option<Option<T>> {
        self.or(key, None, |cx, node| reader(cx, node).map(Some))
    }
}

/// An example of a required key.
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

/// `theta:0` or `theta 0`, which YAML takes for a key without a value: the key that is meant, and what is wrong.
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

/// Words that other formats and books have for keys.
const SYNONYMS: [(&str, &str); 4] =
    [("weight", "mass"), ("ratio", "gear_ratio"), ("cog", "com"), ("tensor", "inertia")];

/// `{mass: 1,98}`, which YAML takes for the value 1 and a key `98`.
fn decimals(cx: &Context, before: &Entry, entry: &Entry) -> Option<Diagnostic> {
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let (Content::Scalar(whole), Content::Scalar(nothing)) = (&before.value.content, &entry.value.content) else {
        return None;
    };
    let joined = format!("{},{}", whole.text, entry.key);
    let is_comma = nothing.text.is_empty() && digits(whole.text.trim_start_matches('-')) && digits(&entry.key);
    // A blank after the comma separates on purpose.
    let is_tight = cx.text.get(before.value.span.start..entry.key_span.end) == Some(joined.as_str());
    (is_comma && is_tight).then(|| {
        let message = format!("`{joined}` is read as two values, because the decimal sign is a point");
        let help = format!("write `{}: {}.{}`", one_line(&before.key), whole.text, entry.key);
        Diagnostic::error(before.value.span.start..entry.key_span.end, message).label("a decimal comma?").help(help)
    })
}

/// `{lower: -pi, upper: pi}`, as in URDF.
fn one_position(cx: &Context, limits: &Node, entry: &Entry) -> Diagnostic {
    let limit = |key| limits.get(key).map_or_else(|| "…".to_owned(), |node| one_line(cx.raw(node)));
    let help = format!("write `position: [{}, {}]`", limit("lower"), limit("upper"));
    let message = format!("unknown key {}; the two limits of a position are one list", quoted(&entry.key));
    Diagnostic::error(entry.key_span.clone(), message).label("unknown key").help(help)
}

/// Where a key belongs that stands in the wrong mapping, or what stands for it here; `allowed` are the keys that it
/// might have.
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

/// A finite number: a decimal or an expression. What may vary at run time, and where, is for
/// [`varying`](crate::parts::varying).
pub(crate) fn quantity(cx: &Context, node: &Node) -> Option<Quantity> {
    let Content::Scalar(scalar) = &node.content else { return cx.wrong_shape(node, "a number") };
    cx.problems.count(scalar.text.len().min(Expression::MAX_BYTES));
    let value = Expression::parse(&scalar.text).map_err(Some).and_then(|it| it.evaluate(&scalar.text, cx));
    match value {
        // -0 is 0: the sign of a zero carries no meaning in a table.
        Ok(quantity) => Some(quantity.without_negative_zero()),
        Err(None) => None,
        Err(Some(mistake)) => {
            // The place inside the scalar, unless escapes or line breaks stand between the text and its value.
            let raw = cx.raw(node);
            let lead = usize::from(scalar.style == Style::Quoted);
            let literal = raw.get(lead..).is_some_and(|raw| raw.starts_with(scalar.text.trim_end()));
            let range = mistake.range.start + lead..mistake.range.end + lead;
            let span = if literal && !range.is_empty() { inside(&node.span, &range) } else { node.span.clone() };
            cx.refuse(Diagnostic::error(span, mistake.message).help(mistake.help))
        }
    }
}

/// A list of exactly `N` numbers; `read` gets the index of each.
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

/// The help for `[0 -0.02 0]`, `0 0 0.3` or `[0, 0, 0,3]`, where as many numbers as are needed can be seen.
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

/// A number that is not negative.
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

/// A text that is not empty; numbers and `true` are texts too where a text is asked for, `~` and `null` are not.
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

/// One of a few words.
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

/// The help for a kind of joint of URDF that does not exist here.
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

/// The format's word for a word of others.
fn synonym(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "r" | "rotary" | "rotational" | "rotation" | "hinge" | "continuous" | "turning" => "revolute",
        "p" | "t" | "linear" | "translational" | "translation" | "sliding" | "slider" => "prismatic",
        "distal" | "classic" | "classical" | "paul" => "standard",
        "proximal" | "craig" | "khalil" | "mdh" => "modified",
        _ => return None,
    })
}
