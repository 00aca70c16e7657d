//! The shapes of values in a plan file: mappings with known keys, lists, words and numbers. Reading ends at the first
//! mistake, because a program has written the file.

use std::fmt::Display;
use std::ops::Range;
use std::str::FromStr;

use rne_model::did_you_mean;
use rne_model::document::{Content, Node, Style};

/// A mistake in a plan file, and its place in the text.
#[derive(Debug)]
pub(super) struct Mistake {
    pub(super) place: Range<usize>,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl Mistake {
    pub(super) fn new(place: Range<usize>, message: impl Into<String>) -> Self {
        Self { place, message: message.into(), help: None }
    }

    fn wrong_shape(node: &Node, needed: &str) -> Self {
        Self::new(node.head(), format!("found {} where {needed} is needed", node.described()))
    }

    fn unknown(place: Range<usize>, message: String, word: &str, known: &[&str]) -> Self {
        let meant = did_you_mean(word, known.iter().copied());
        Self { place, message, help: meant.map(|meant| format!("did you mean `{meant}`?")) }
    }
}

/// A mapping that has only known keys.
pub(super) struct Fields<'d> {
    node: &'d Node,
    what: &'static str,
}

impl<'d> Fields<'d> {
    /// Opens a mapping that may have these keys and no others.
    pub(super) fn open(node: &'d Node, what: &'static str, keys: &[&str]) -> Result<Self, Mistake> {
        let Content::Mapping(entries) = &node.content else {
            return Err(Mistake::wrong_shape(node, &format!("a mapping ({})", keys.join(", "))));
        };
        if let Some(unknown) = entries.iter().find(|entry| !keys.contains(&entry.key.as_str())) {
            let message =
                format!("unknown key `{}`; {what} has the keys {}", unknown.key.escape_debug(), keys.join(", "));
            return Err(Mistake::unknown(unknown.key_span.clone(), message, &unknown.key, keys));
        }
        Ok(Self { node, what })
    }

    /// Reads the value of a key that must be there.
    pub(super) fn required<T>(
        &self,
        key: &str,
        read: impl FnOnce(&'d Node) -> Result<T, Mistake>,
    ) -> Result<T, Mistake> {
        let missing = || Mistake::new(self.node.head(), format!("{} lacks the required key `{key}`", self.what));
        read(self.node.get(key).ok_or_else(missing)?)
    }

    /// Reads the value of a key; returns the default if the key is not there.
    pub(super) fn optional<T: Default>(
        &self,
        key: &str,
        read: impl FnOnce(&'d Node) -> Result<T, Mistake>,
    ) -> Result<T, Mistake> {
        self.node.get(key).map_or_else(|| Ok(T::default()), read)
    }
}

/// Reads a list.
pub(super) fn list<T>(node: &Node, read: impl Fn(&Node) -> Result<T, Mistake>) -> Result<Vec<T>, Mistake> {
    match &node.content {
        Content::Sequence(items) => items.iter().map(|item| read(item)).collect(),
        _ => Err(Mistake::wrong_shape(node, "a list")),
    }
}

/// Reads a list of exactly `N` items.
pub(super) fn array<const N: usize, T>(
    node: &Node,
    read: impl Fn(&Node) -> Result<T, Mistake>,
) -> Result<[T; N], Mistake> {
    let items = list(node, read)?;
    let found = items.len();
    items.try_into().map_err(|_| Mistake::new(node.span.clone(), format!("a list of {found} where {N} are needed")))
}

/// Reads a text.
pub(super) fn text(node: &Node) -> Result<&str, Mistake> {
    match &node.content {
        Content::Scalar(scalar) => Ok(&scalar.text),
        _ => Err(Mistake::wrong_shape(node, "a text")),
    }
}

/// Reads a text, and parses it as a value of type `T`.
pub(super) fn parsed<T: FromStr<Err: Display>>(node: &Node) -> Result<T, Mistake> {
    text(node)?.parse().map_err(|error: T::Err| Mistake::new(node.span.clone(), error.to_string()))
}

/// Reads a word, which must be one of `words`, and returns its value.
pub(super) fn word<T: Copy>(node: &Node, what: &str, words: &[(T, &str)]) -> Result<T, Mistake> {
    let word = text(node)?;
    words.iter().find(|(_, name)| *name == word).map(|(value, _)| *value).ok_or_else(|| {
        let names: Vec<&str> = words.iter().map(|(_, name)| *name).collect();
        let message =
            format!("`{}` is not a valid {what}; the valid words are `{}`", word.escape_debug(), names.join("`, `"));
        Mistake::unknown(node.span.clone(), message, word, &names)
    })
}

/// Reads `true` or `false`.
pub(super) fn switch(node: &Node) -> Result<bool, Mistake> {
    match plain(node) {
        Some("true") => Ok(true),
        Some("false") => Ok(false),
        _ => Err(Mistake::wrong_shape(node, "`true` or `false`")),
    }
}

/// Reads a whole number that is not negative.
pub(super) fn whole<T: TryFrom<usize>>(node: &Node) -> Result<T, Mistake> {
    // only the digits that the number is written with: no sign, no zero before them
    let whole = |digits: &str| digits.parse().ok().filter(|number: &usize| number.to_string() == digits);
    let number = plain(node).and_then(whole).and_then(|number| T::try_from(number).ok());
    number.ok_or_else(|| Mistake::wrong_shape(node, "a whole number"))
}

/// Reads a decimal number, or YAML's words for infinity and not-a-number.
pub(super) fn number(node: &Node) -> Result<f64, Mistake> {
    let number = match plain(node) {
        Some(".inf") => Some(f64::INFINITY),
        Some("-.inf") => Some(f64::NEG_INFINITY),
        Some(".nan") => Some(f64::NAN),
        // Rust would take `inf` and `nan` too
        Some(digits) if !digits.contains(|c: char| c.is_ascii_alphabetic() && c != 'e') => digits.parse().ok(),
        _ => None,
    };
    number.ok_or_else(|| Mistake::wrong_shape(node, "a number"))
}

fn plain(node: &Node) -> Option<&str> {
    match &node.content {
        Content::Scalar(scalar) if scalar.style == Style::Plain => Some(&scalar.text),
        _ => None,
    }
}
