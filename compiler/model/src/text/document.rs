//! A YAML document as a tree in which every key and every value has its place in the text; readers of robot files use
//! it, and those of plan files in the compiler.

mod builder;

use std::ops::Range;
use std::rc::Rc;

use builder::Builder;

use crate::text::diagnostic::{Diagnostic, Problems, Report};
use crate::text::source::{self, quoted};

/// The words that messages use for a kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// The kind of file in words, such as `a robot file`.
    pub name: &'static str,
    /// The number of the first key: 1 for `format: 1`.
    pub format: u32,
}

pub(crate) const ROBOT_FILE: Kind = Kind { name: "a robot file", format: 1 };

/// Largest number of joints, more than any serial arm has; it bounds the work of all later steps.
pub(crate) const MAX_JOINTS: usize = 64;

/// Largest number of nodes in a document, with every alias written out. The longest table, 64 joints, has a fifth of
/// it.
const MAX_NODES: usize = 50_000;

/// A value, and the place of its bytes in the text.
#[derive(Debug)]
pub struct Node {
    /// The bytes of the text that the value has.
    pub span: Range<usize>,
    /// The value itself.
    pub content: Content,
    /// The number of nodes in this subtree, with aliases written out.
    size: usize,
    /// The number of levels in this subtree.
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
    /// A mapping: keys with their values, in the order of the text.
    Mapping(Vec<Entry>),
}

/// A scalar, not yet interpreted: the reader of its key decides whether `1` is a number or a text.
#[derive(Debug)]
pub struct Scalar {
    /// The text without quotation marks, with escapes resolved.
    pub text: String,
    /// How the text is written.
    pub style: Style,
}

/// How a scalar is written in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Without quotation marks.
    Plain,
    /// In single or double quotation marks.
    Quoted,
    /// In lines of its own after `|` or `>`.
    Block,
}

/// A key of a mapping, with its value.
#[derive(Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// The bytes of the text that the key has.
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

    /// Returns the value of a key, if this node is a mapping that has it.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Node> {
        let Content::Mapping(entries) = &self.content else { return None };
        entries.iter().find(|entry| entry.key == key).map(|entry| &*entry.value)
    }

    /// Returns the items of the list under a key of this mapping; none where it has no such list.
    pub fn list(&self, key: &str) -> &[Rc<Self>] {
        match self.get(key).map(|node| &node.content) {
            Some(Content::Sequence(items)) => items,
            _ => &[],
        }
    }

    /// Returns whether this node is a mapping that has the key with a value other than an empty list.
    pub(crate) fn has_entries(&self, key: &str) -> bool {
        self.get(key).is_some_and(|node| !matches!(&node.content, Content::Sequence(items) if items.is_empty()))
    }

    /// Returns where a message points if it means the whole value: the first line of a block mapping or block list,
    /// else all of it.
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

    /// Describes the value in a few words, for messages such as "found …".
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

/// Reads the only document of a text whose format is not that of robot files: `name` is the name of the file in
/// messages, `kind` its kind.
///
/// # Errors
///
/// Reports text that is no YAML, or that has what files of rne never have: tags, several documents, a repeated key,
/// control characters, more than 1 MiB.
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

/// Parses the only document of a text. A syntax error of YAML ends the reading; a repeated key does not.
pub(crate) fn parse(text: &str, kind: Kind, problems: &Problems) -> Option<Rc<Node>> {
    let root = has_few_commas(text, kind).and_then(|()| Builder::new(text, kind, problems).run());
    root.map_err(|mistake| problems.push(mistake)).ok()
}

/// Refuses a value with too many commas, before parsing. For `{…` the parser reports nothing until it knows whether
/// this is the key of a mapping, and its memory grows to a hundred times the text. A dash at the beginning of a line
/// begins a new value.
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

    /// Returns the text of the value at a path of keys.
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
        // the pair in the list has no brackets of its own
        let root = read("x.yaml", "[f: 1]  # one", ROBOT_FILE).expect("YAML");
        let Content::Sequence(items) = &root.content else { panic!("{root:?}") };
        assert!(items[0].span.start == 1 && items[0].span.end <= 5, "{items:?}");
    }
}
