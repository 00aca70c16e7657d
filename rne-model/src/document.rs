//! A YAML document as a tree in which every key and every value knows its place in the text: what reads robot files,
//! and plan files in the compiler.

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use saphyr_parser::{Event, Parser, ScalarStyle};

use crate::diagnostic::{Diagnostic, Problems, Report};
use crate::source::{self, quoted};

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

/// A robot file is six levels deep, a plan file seven.
const MAX_DEPTH: usize = 16;

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

/// A mapping or sequence that is not closed yet.
struct Open {
    start: usize,
    anchor: usize,
    children: Children,
}

enum Children {
    Sequence(Vec<Rc<Node>>),
    Mapping {
        entries: Vec<Entry>,
        /// The places of the keys already met.
        known: HashMap<String, usize>,
        /// A key that still waits for its value.
        pending: Option<(String, Range<usize>)>,
    },
}

struct Builder<'t> {
    text: &'t str,
    kind: Kind,
    /// Byte offset of every character: the parser counts characters.
    offsets: Vec<usize>,
    /// Byte offset of every line break.
    breaks: Vec<usize>,
    problems: &'t Problems,
    stack: Vec<Open>,
    anchors: HashMap<usize, Rc<Node>>,
    /// Nodes so far, aliases written out.
    nodes: usize,
    root: Option<Rc<Node>>,
}

impl<'t> Builder<'t> {
    fn new(text: &'t str, kind: Kind, problems: &'t Problems) -> Self {
        let offsets = text.char_indices().map(|(offset, _)| offset).chain([text.len()]).collect();
        let breaks = text.match_indices('\n').map(|(offset, _)| offset).collect();
        let (stack, anchors) = (Vec::new(), HashMap::new());
        Self { text, kind, offsets, breaks, problems, stack, anchors, nodes: 0, root: None }
    }

    fn run(mut self) -> Result<Rc<Node>, Diagnostic> {
        let mut parser = Parser::new_from_str(self.text);
        let mut documents = 0;
        while let Some(event) = parser.next_event() {
            self.problems.count(1);
            let (event, span) = event.map_err(|error| {
                let at = self.offset(error.marker().index());
                self.syntax_error(at, error.info()).maybe_help(self.open_bracket().or_else(|| self.around(at)))
            })?;
            let span = self.offset(span.start.index())..self.offset(span.end.index());
            match event {
                Event::DocumentStart(_) => {
                    documents += 1;
                    if documents > 1 {
                        let message =
                            format!("a second YAML document begins here; {} must have exactly one", self.kind.name);
                        let help = "write one file per robot, without a second `---`";
                        return Err(Diagnostic::error(span, message).help(help));
                    }
                }
                Event::Alias(anchor) => self.alias(anchor, span)?,
                Event::Scalar(text, style, anchor, tag) => {
                    let span = self.without_properties(span, tag.is_some())?;
                    self.scalar(text.into_owned(), style, anchor, span)?;
                }
                Event::SequenceStart(anchor, tag) => {
                    let span = self.without_properties(span, tag.is_some())?;
                    self.open(span, anchor, Children::Sequence(Vec::new()))?;
                }
                Event::MappingStart(anchor, tag) => {
                    let span = self.without_properties(span, tag.is_some())?;
                    let children = Children::Mapping { entries: Vec::new(), known: HashMap::new(), pending: None };
                    self.open(span, anchor, children)?;
                }
                Event::SequenceEnd | Event::MappingEnd => self.close(&span)?,
                Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => {}
            }
        }
        self.root.ok_or_else(|| {
            let Kind { name, format } = self.kind;
            let message = format!("the file is empty; {name} is a YAML mapping that begins with `format: {format}`");
            Diagnostic::error(0..0, message)
        })
    }

    /// A question that solves most syntax errors: the innermost bracket that is still open.
    fn open_bracket(&self) -> Option<String> {
        let start = self.stack.last()?.start;
        let bracket = self.text.get(start..)?.chars().next().filter(|c| matches!(c, '[' | '{'))?;
        Some(format!("check that the `{bracket}` in line {} is closed", line(&self.breaks, start)))
    }

    /// Recognises the lines at a syntax error: a list that begins as a mapping, or a key without its blank.
    fn around(&self, at: usize) -> Option<String> {
        let before = self.text.get(..at)?;
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let here = self.text.get(start..)?.lines().next()?;
        if here.trim_start().starts_with("- ") {
            let help = "this line begins a list item with `- `, but the lines above it at this indentation do not: put \
                        `- ` before the first of those lines, too";
            return Some(help.to_owned());
        }
        let above = before.get(..start)?.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
        [(here, ""), (above, " in the line above")].into_iter().find_map(|(line, place)| {
            let line = line.trim().trim_start_matches("- ");
            let (key, value) = line.split_once(':')?;
            let is_key = !key.is_empty() && key.chars().all(|c| c.is_ascii_lowercase() || c == '_');
            let is_tight =
                value.starts_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '+' | '.' | '[' | '{'));
            (is_key && is_tight && line.len() < 80).then(|| {
                format!("a space is missing after the colon{place}: write `{key}: {}`", crate::source::one_line(value))
            })
        })
    }

    fn offset(&self, index: usize) -> usize {
        self.offsets.get(index).copied().unwrap_or(self.text.len())
    }

    /// The span of a value without the anchor before it and the blanks after it. Tags are refused.
    fn without_properties(&self, span: Range<usize>, tagged: bool) -> Result<Range<usize>, Diagnostic> {
        let raw = self.text.get(span.clone()).unwrap_or_default();
        if tagged {
            return Err(Diagnostic::error(span, format!("YAML tag in {}; tags are not allowed", quoted(raw))).help(
                format!("delete the tag: rne knows the type of every value of {} from its key", self.kind.name),
            ));
        }
        let value = match raw.strip_prefix('&') {
            Some(anchor) => anchor.trim_start_matches(|c: char| !c.is_whitespace()).trim_start(),
            None => raw,
        };
        let start = span.end - value.len();
        Ok(start..start + value.trim_end().len())
    }

    fn scalar(
        &mut self,
        text: String,
        style: ScalarStyle,
        anchor: usize,
        span: Range<usize>,
    ) -> Result<(), Diagnostic> {
        let style = match style {
            ScalarStyle::Plain => Style::Plain,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => Style::Quoted,
            ScalarStyle::Literal | ScalarStyle::Folded => Style::Block,
        };
        let mut place = span;
        match self.stack.last_mut().map(|open| &mut open.children) {
            Some(Children::Mapping { known, pending: pending @ None, .. }) => {
                if let Some(first) = known.get(&text) {
                    let message =
                        format!("repeated key {}; it is already in line {}", quoted(&text), line(&self.breaks, *first));
                    self.problems
                        .push(Diagnostic::error(place.clone(), message).label("repeated").help("keep one of the two"));
                } else {
                    known.insert(text.clone(), place.start);
                }
                *pending = Some((text, place));
                return Ok(());
            }
            // A value that is not there: its key is the place to point at.
            Some(Children::Mapping { pending: Some((_, key)), .. }) if text.is_empty() && style == Style::Plain => {
                place = key.clone();
            }
            _ => {}
        }
        self.place(Node::new(place, Content::Scalar(Scalar { text, style })), anchor)
    }

    fn open(&mut self, span: Range<usize>, anchor: usize, children: Children) -> Result<(), Diagnostic> {
        if self.stack.len() + 1 >= MAX_DEPTH {
            return Err(self.too_deep(span));
        }
        if let Some(Open { children: Children::Mapping { pending: None, .. }, .. }) = self.stack.last() {
            return Err(not_a_key(span));
        }
        self.stack.push(Open { start: span.start, anchor, children });
        Ok(())
    }

    fn close(&mut self, end: &Range<usize>) -> Result<(), Diagnostic> {
        let Some(open) = self.stack.pop() else { return Ok(()) };
        // the parser ends what is in brackets where the next value begins, behind comments
        let is_at = |at: usize, brackets: [char; 2]| self.text.get(at..).is_some_and(|rest| rest.starts_with(brackets));
        let is_in_brackets = is_at(open.start, ['[', '{']) && is_at(end.start, [']', '}']);
        let end = if is_in_brackets { end.start + 1 } else { end.end };
        let text = self.text.get(open.start..end).unwrap_or_default();
        let span = open.start..open.start + text.trim_end().len();
        let content = match open.children {
            Children::Sequence(items) => Content::Sequence(items),
            Children::Mapping { entries, .. } => Content::Mapping(entries),
        };
        self.place(Node::new(span, content), open.anchor)
    }

    fn alias(&mut self, anchor: usize, span: Range<usize>) -> Result<(), Diagnostic> {
        if let Some(Open { children: Children::Mapping { pending: None, .. }, .. }) = self.stack.last() {
            return Err(not_a_key(span));
        }
        let Some(target) = self.anchors.get(&anchor).cloned() else {
            let raw = self.text.get(span.clone()).unwrap_or_default();
            let message = format!("the alias {} does not name a complete value above it", quoted(raw));
            return Err(Diagnostic::error(span, message).help("write the value out"));
        };
        if self.stack.len() + target.height > MAX_DEPTH {
            return Err(self.too_deep(span));
        }
        self.count(target.size, &span)?;
        self.attach(target);
        Ok(())
    }

    fn place(&mut self, node: Node, anchor: usize) -> Result<(), Diagnostic> {
        self.count(1, &node.span)?;
        let node = Rc::new(node);
        if anchor != 0 {
            self.anchors.insert(anchor, Rc::clone(&node));
        }
        self.attach(node);
        Ok(())
    }

    fn count(&mut self, nodes: usize, span: &Range<usize>) -> Result<(), Diagnostic> {
        self.nodes = self.nodes.saturating_add(nodes);
        if self.nodes <= MAX_NODES {
            return Ok(());
        }
        // the list of joints is told by its own limit
        if let [Open { children: Children::Mapping { pending: Some((key, place)), .. }, .. }, joints, ..] =
            self.stack.as_slice()
            && key == "joints"
            && matches!(&joints.children, Children::Sequence(items) if items.len() > MAX_JOINTS)
        {
            let message = format!("more than {MAX_JOINTS} joints; 1 to {MAX_JOINTS} joints are allowed");
            return Err(Diagnostic::error(place.clone(), message).help("one file describes one robot"));
        }
        let message = format!(
            "more than {MAX_NODES} values when aliases (`*name`) are written out; {} must have fewer",
            self.kind.name
        );
        Err(Diagnostic::error(span.clone(), message).help("write each joint only once"))
    }

    fn attach(&mut self, node: Rc<Node>) {
        match self.stack.last_mut().map(|open| &mut open.children) {
            None => self.root = Some(node),
            Some(Children::Sequence(items)) => items.push(node),
            Some(Children::Mapping { entries, pending, .. }) => {
                if let Some((key, key_span)) = pending.take() {
                    entries.push(Entry { key, key_span, value: node });
                }
            }
        }
    }

    fn too_deep(&self, span: Range<usize>) -> Diagnostic {
        Diagnostic::error(
            span,
            format!(
                "the values are nested more than {MAX_DEPTH} levels deep; {} must have fewer levels",
                self.kind.name
            ),
        )
    }

    fn syntax_error(&self, at: usize, info: &str) -> Diagnostic {
        // The parser reads ahead and may meet its own limit, 255, before ours.
        if info.contains("recursion limit") {
            return self.too_deep(at..at + 1);
        }
        let help = if info.contains(" tab") {
            Some("indent with spaces; YAML does not allow tabs in the indentation")
        } else if info.contains("':'") || info.contains("mapping values") {
            Some("put a text that contains `: ` into quotes; check the brackets and the indentation of this line")
        } else if info.contains("unknown anchor") {
            Some("an alias `*name` needs a value marked `&name` before it")
        } else {
            None
        };
        Diagnostic::error(at..at + 1, format!("this is not YAML: {info}")).maybe_help(help.map(str::to_owned))
    }
}

/// The line of a byte, given the places of the line breaks.
fn line(breaks: &[usize], offset: usize) -> usize {
    1 + breaks.partition_point(|at| *at < offset)
}

fn not_a_key(span: Range<usize>) -> Diagnostic {
    Diagnostic::error(span, "a key must be a plain word; lists, mappings and aliases are not allowed as keys")
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
