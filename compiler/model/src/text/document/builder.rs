//! Builds the tree of a document from the events of the YAML parser.

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use saphyr_parser::{Event, Parser, ScalarStyle};

use super::{Content, Entry, Kind, MAX_JOINTS, MAX_NODES, Node, Scalar, Style};
use crate::text::diagnostic::{Diagnostic, Problems};
use crate::text::expression::is_identifier;
use crate::text::source::quoted;

/// Largest depth of a document. A robot file is six levels deep, a plan file seven.
const MAX_DEPTH: usize = 16;

/// A mapping or a list that is not closed yet.
struct Open {
    start: usize,
    anchor: usize,
    children: Children,
}

enum Children {
    Sequence(Vec<Rc<Node>>),
    Mapping {
        entries: Vec<Entry>,
        /// The places of the keys that were read so far.
        known: HashMap<String, usize>,
        /// A key whose value has not been read yet.
        pending: Option<(String, Range<usize>)>,
    },
}

pub(super) struct Builder<'t> {
    text: &'t str,
    kind: Kind,
    /// The byte offset of every character, because the parser counts characters.
    offsets: Vec<usize>,
    /// The byte offset of every line break.
    breaks: Vec<usize>,
    problems: &'t Problems,
    stack: Vec<Open>,
    anchors: HashMap<usize, Rc<Node>>,
    /// The number of nodes so far, with aliases written out.
    nodes: usize,
    root: Option<Rc<Node>>,
}

impl<'t> Builder<'t> {
    pub(super) fn new(text: &'t str, kind: Kind, problems: &'t Problems) -> Self {
        let offsets = text.char_indices().map(|(offset, _)| offset).chain([text.len()]).collect();
        let breaks = text.match_indices('\n').map(|(offset, _)| offset).collect();
        let (stack, anchors) = (Vec::new(), HashMap::new());
        Self { text, kind, offsets, breaks, problems, stack, anchors, nodes: 0, root: None }
    }

    pub(super) fn run(mut self) -> Result<Rc<Node>, Diagnostic> {
        let mut parser = Parser::new_from_str(self.text);
        let mut documents = 0;
        while let Some(event) = parser.next_event() {
            self.problems.count(1);
            let (event, span) = event.map_err(|error| {
                let at = self.offset(error.marker().index());
                // The parser reads ahead and may reach its own limit of 255 levels before this crate's limit; then no
                // bracket is missing.
                if error.info().contains("recursion limit") {
                    return self.too_deep(at..at + 1);
                }
                if let Some(tab) = self.tab(at).filter(|_| error.info().contains("tab")) {
                    let line = line(&self.breaks, tab);
                    let message = format!("line {line} is indented with a tab; use spaces");
                    return Diagnostic::error(tab..tab + 1, message)
                        .help("YAML does not allow tabs in the indentation");
                }
                syntax_error(at, error.info()).maybe_help(self.open_bracket(at).or_else(|| self.around(at)))
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

    /// Returns the help that solves most syntax errors: write a comma before a key, or close the innermost open
    /// bracket.
    fn open_bracket(&self, at: usize) -> Option<String> {
        let start = self.stack.last()?.start;
        let bracket = self.text.get(start..)?.chars().next().filter(|c| matches!(c, '[' | '{'))?;
        let pair = self.text.get(start + 1..at).and_then(|text| text.rsplit(',').next());
        if let Some((_, key)) = pair.and_then(|pair| pair.split_once(": ")?.1.trim_start().rsplit_once(' '))
            && bracket == '{'
            && is_identifier(key)
        {
            return Some(format!("write a comma before `{key}`"));
        }
        Some(format!("check that the `{bracket}` in line {} is closed", line(&self.breaks, start)))
    }

    /// Returns help from the lines at a syntax error: a list item after lines that are not items, or a key without a
    /// blank after its colon.
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
                format!(
                    "a space is missing after the colon{place}: write `{key}: {}`",
                    crate::text::source::one_line(value)
                )
            })
        })
    }

    /// Returns the first tab in the indentation of a line, beginning with the line of `at`, because the parser names
    /// the line before the tab.
    fn tab(&self, at: usize) -> Option<usize> {
        let mut start = self.text.get(..at)?.rfind('\n').map_or(0, |newline| newline + 1);
        for line in self.text.get(start..)?.split_inclusive('\n') {
            let indentation = line.len() - line.trim_start_matches([' ', '\t']).len();
            if let Some(tab) = line[..indentation].find('\t').filter(|_| !line.trim().is_empty()) {
                return Some(start + tab);
            }
            start += line.len();
        }
        None
    }

    fn offset(&self, index: usize) -> usize {
        self.offsets.get(index).copied().unwrap_or(self.text.len())
    }

    /// Returns the span of a value without the anchor before it and the blanks after it. Refuses tags.
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
            // An empty value has no place of its own, so messages point at its key.
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
        // for a value in brackets, the parser's end is where the next value begins, so the closing bracket is used
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
        // too many joints have a message of their own
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
        .help("delete brackets, dashes or keys that are not needed: a list of numbers has one pair, `[0, 0, 1]`")
    }
}

fn syntax_error(at: usize, info: &str) -> Diagnostic {
    let help = if info.contains("':'") || info.contains("mapping values") {
        Some("put a text that contains `: ` into quotes; check the brackets and the indentation of this line")
    } else if info.contains("unknown anchor") {
        Some("an alias `*name` needs a value marked `&name` before it")
    } else {
        None
    };
    Diagnostic::error(at..at + 1, format!("this is not YAML: {info}")).maybe_help(help.map(str::to_owned))
}

/// Returns the line of a byte, given the places of the line breaks.
fn line(breaks: &[usize], offset: usize) -> usize {
    1 + breaks.partition_point(|at| *at < offset)
}

fn not_a_key(span: Range<usize>) -> Diagnostic {
    Diagnostic::error(span, "a key must be a plain word; lists, mappings and aliases are not allowed as keys")
}
