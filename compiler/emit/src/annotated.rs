//! A text whose parts have kinds, so that a renderer can colour, link or typeset them.

use std::fmt;
use std::ops::{Add, Range};

use rne_codegen::Name;

/// The kind of a part of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The word with which a declaration begins, such as `let`.
    Keyword,
    /// The name of a number: its quantity, joint and axis.
    Name(Name),
    /// A number.
    Number,
}

/// A text with the kinds of some of its parts; all other parts are words, operators and brackets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Annotated {
    text: String,
    spans: Vec<(Range<usize>, Part)>,
}

impl Annotated {
    pub(super) fn part(part: Part, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { spans: vec![(0..text.len(), part)], text }
    }

    /// Joins several texts, with `between` between them.
    pub(super) fn join(parts: impl IntoIterator<Item = Self>, between: &str) -> Self {
        parts.into_iter().reduce(|all, part| all + between + part).unwrap_or_default()
    }

    /// Appends another text.
    pub(super) fn push(&mut self, other: &Self) {
        let before = self.text.len();
        self.text.push_str(&other.text);
        let behind = |(range, part): &(Range<usize>, Part)| (range.start + before..range.end + before, *part);
        self.spans.extend(other.spans.iter().map(behind));
    }

    /// Appends words, operators or brackets.
    pub(super) fn push_str(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Returns the text without the kinds.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// Returns the text in pieces, each with its kind; `None` for words, operators and brackets.
    pub fn pieces(&self) -> impl Iterator<Item = (Option<Part>, &str)> {
        let ends = self.spans.iter().map(|(range, _)| range.end);
        let between = std::iter::once(0).chain(ends).zip(&self.spans).flat_map(|(from, (range, part))| {
            [(None, &self.text[from..range.start]), (Some(*part), &self.text[range.clone()])]
        });
        let end = self.spans.last().map_or(0, |(range, _)| range.end);
        between.chain([(None, &self.text[end..])]).filter(|(_, text)| !text.is_empty())
    }
}

impl From<Name> for Annotated {
    fn from(name: Name) -> Self {
        Self::part(Part::Name(name), name.to_string())
    }
}

impl From<String> for Annotated {
    fn from(text: String) -> Self {
        Self { text, spans: Vec::new() }
    }
}

impl From<&str> for Annotated {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl<T: Into<Self>> Add<T> for Annotated {
    type Output = Self;

    fn add(mut self, other: T) -> Self {
        self.push(&other.into());
        self
    }
}

impl fmt::Display for Annotated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
