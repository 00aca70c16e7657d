//! A YAML document as a tree in which every key and every value knows its place in the text: what reads robot files,
//! and plan files in the compiler.

mod builder;

use std::ops::Range;
use std::rc::Rc;

use builder::Builder;

use crate::text::diagnostic::{Diagnostic, Problems, Report};
use crate::text::source::{self, quoted};

/// The words of messages for a kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its kind: `a robot file`.
    pub name: &'static str,
    /// The number that it begins with: `format: 1`.
    pub format: u32,
}

pub(crate) const ROBOT_FILE: Kind = Kind { name: "a robot file", format: 1 };

/// More joints than any serial arm has; bounds the work of everything that follows.
pub(crate) const MAX_JOINTS: usize = 64;

/// Nodes of a document with every alias written out. The longest table, 64 joints, has a fifth of it.
const MAX_NODES: usize = 50_000;

/// A value and the bytes of the text it stands in.
#[derive(Debug)]
pub struct Node {
    /// The bytes.
    pub span: Range<usize>,
    /// The value.
    pub content: Content,
    /// Number of nodes in this subtree, aliases written out.
    size: usize,
    /// Number of levels of this subtree.
    height: usize,
}

/// The three kinds of values.
#[derive(Debug)]
pub enum Content {
    /// A word, a number or a text.
    Scalar(Scalar),
    // Shared, not copied: an alias costs no memory, however large its target.
    /// A list.
    Sequence(Vec<Rc<Node>>),
    /// Keys with their values, in the order of the text.
    Mapping(Vec<Entry>),
}

/// A scalar, unresolved: whether `1` is a number or a text is for the reader of the key to say.
#[derive(Debug)]
pub struct Scalar {
    /// Without quotation marks, its escapes resolved.
    pub text: String,
    /// How it is written.
    pub style: Style,
}

/// How a scalar is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// As it is.
    Plain,
    /// In quotation marks, single or double.
    Quoted,
    /// In lines of its own, behind `|` or `>`.
    Block,
}

/// A key of a mapping, with its value.
#[derive(Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// The bytes it stands in.
    pub key_span: Range<usize>,
    /// The value.
    pub value: Rc<Node>,
}

impl Node {
    fn new(span: Range<usize>, content: Content) -> Self {
        let children: &mut dyn Iterator<Item = &Rc<Node>> = match &content {
            Content::Scalar(_) => &mut std::iter::empty(),
            Content::Sequence(items) => &mut items.iter(),
            Content::Mapping(entries) => &mut entries.iter().map(|entry| &entry.value),
        };
        let (mut size, mut height) = (1_usize, 1);
        for child in children {
            size = size.saturating_add(child.size);
            height = height.max(child.height + 1);
        }
        Self { span, content, size, height }
    }

    /// The value of a key, if this is a mapping that has it.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Node> {
        let Content::Mapping(entries) = &self.content else { return None };
        entries.iter().find(|entry| entry.key == key).map(|entry| &*entry.value)
    }

    /// The items of the list under a key of this mapping; none where it has no such list.
    pub(crate) fn list(&self, key: &str) -> &[Rc<Self>] {
        match self.get(key).map(|node| &node.content) {
            Some(Content::Sequence(items)) => items,
            _ => &[],
        }
    }

    /// Whether this is a mapping that has the key, with another value than an empty list.
    pub(crate) fn has_entries(&self, key: &str) -> bool {
        self.get(key).is_some_and(|node| !matches!(&node.content, Content::Sequence(items) if items.is_empty()))
    }

    /// Where to point when the whole value is meant: a block mapping or list is represented by its first line.
    #[must_use]
    pub fn head(&self) -> Range<usize> {
        match &self.content {
            Content::Mapping(entries) => match entries.first() {
                Some(first) if first.key_span.start == self.span.start => first.key_span.clone(),
                _ => self.span.clone(),
            },
            _ => self.span.clone(),
        }
    }

    /// The value in a few words, for "found …".
    #[must_use]
    pub fn described(&self) -> String {
        match &self.content {
            Content::Scalar(scalar) if scalar.text.is_empty() => "nothing".to_owned(),
            Content::Scalar(scalar) => quoted(&scalar.text),
            Content::Sequence(items) => format!("a list of {}", items.len()),
            Content::Mapping(_) => "a mapping".to_owned(),
        }
    }
}

/// Reads the one document of a text in another format than that of robot files: `name` is the file's in messages,
/// `kind` is what it is.
///
/// # Errors
///
/// Reports text that is no YAML, or of a kind that no file of ours has: tags, several documents, a key that stands
/// twice, control characters, more than 1 MiB.
pub fn read(name: &str, text: &str, kind: Kind) -> Result<Rc<Node>, Report> {
    let problems = Problems::new();
    if !source::size_is_fine(text.len(), kind.name, &problems) {
        return Err(problems.finish(name, ""));
    }
    let root = if source::is_printable(text, &problems) { parse(text, kind, &problems) } else { None };
    match root {
        Some(root) if !problems.has_errors() => {
            let _ = problems.finish(name, "");
            Ok(root)
        }
        _ => Err(problems.finish(name, text)),
    }
}

/// Reads the one document of a text. Mistakes of YAML itself end the reading; a repeated key does not.
pub(crate) fn parse(text: &str, kind: Kind, problems: &Problems) -> Option<Rc<Node>> {
    let root = has_few_commas(text, kind).and_then(|()| Builder::new(text, kind, problems).run());
    root.map_err(|mistake| problems.push(mistake)).ok()
}

/// The parser gives nothing of `{…` before it knows whether that is the key of a mapping, and keeps it in memory until
/// then: a hundred times the text. So the commas of what could be one value are counted first; a dash that begins a
/// line begins a value.
fn has_few_commas(text: &str, kind: Kind) -> Result<(), Diagnostic> {
    let (mut commas, mut start) = (0, 0);
    for line in text.split_inclusive('\n') {
        if line.trim_start().starts_with("- ") {
            commas = 0;
        }
        let here = line.matches(',').count();
        if commas + here > MAX_NODES {
            let at = start + line.match_indices(',').nth(MAX_NODES - commas).map_or(0, |(at, _)| at);
            let message = format!("one value has more than {MAX_NODES} commas; {} must have fewer", kind.name);
            return Err(Diagnostic::error(at..at + 1, message).help("write each joint only once"));
        }
        commas += here;
        start += line.len();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text of the value behind each key of a path.
    fn value<'t>(text: &'t str, path: &[&str]) -> &'t str {
        let root = read("x.yaml", text, ROBOT_FILE).unwrap_or_else(|report| panic!("{report}"));
        let node = path.iter().fold(&*root, |node, key| node.get(key).unwrap_or_else(|| panic!("no {key}")));
        &text[node.span.clone()]
    }

    #[test]
    fn what_is_in_brackets_ends_with_them() {
        for after in ["", "   ", " # a comment", "\n\n", " # a comment\n\n# another ] }\n"] {
            let text =
                format!("a: [0, 1]{after}\nb:\n  c: {{d: [2,  # half\n    3], e: [f: 1]}}{after}\ng: &h {{}}{after}\n");
            assert_eq!(value(&text, &["a"]), "[0, 1]", "{text}");
            assert_eq!(value(&text, &["b", "c"]), "{d: [2,  # half\n    3], e: [f: 1]}", "{text}");
            assert_eq!(value(&text, &["b", "c", "d"]), "[2,  # half\n    3]", "{text}");
            assert_eq!(value(&text, &["b", "c", "e"]), "[f: 1]", "{text}");
            assert_eq!(value(&text, &["g"]), "{}", "{text}");
        }
        // a pair without brackets of its own
        let root = read("x.yaml", "[f: 1]  # one", ROBOT_FILE).expect("YAML");
        let Content::Sequence(items) = &root.content else { panic!("{root:?}") };
        assert!(items[0].span.start == 1 && items[0].span.end <= 5, "{items:?}");
    }
}
