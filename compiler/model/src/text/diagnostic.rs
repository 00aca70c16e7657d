//! Mistakes and warnings as data: where, what is wrong, what to do.

use std::cell::{Cell, RefCell};
use std::ops::Range;

use crate::text::render;

/// A choice of the caller that helps against a mistake: each door says it in its own words, as an option of the command
/// line or a keyword of Python.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// A URDF was read as a robot file and must be imported.
    ImportUrdf {
        /// The file, where messages name one.
        file: Option<String>,
    },
    /// The tree of a URDF has several ends: the link at the tip must be named.
    NameTip,
    /// A joint of a URDF can be locked by its name.
    LockJoint {
        /// The name of the joint.
        joint: String,
    },
    /// The movable joints off the chain can be locked, each by its name or all at zero.
    LockOthers,
    /// A body whose inertia no physical body has can be kept.
    KeepUnphysical,
    /// The whole robot of a URDF can be imported, and not one arm.
    Whole,
    /// So it can, or a joint can be locked by its name.
    WholeOrLock {
        /// The name of the joint.
        joint: String,
    },
    /// The base of a whole robot can float.
    Float,
    /// The inertia of rotors can belong to the arm.
    Rotors,
}

/// How grave a [`Diagnostic`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Severity {
    /// The file is refused.
    Error,
    /// The file is valid, yet this is probably not what was meant (a lint).
    Warning,
    /// The file is valid, and published data have the same, yet it is worth a look: nothing that a build should repeat
    /// each time.
    Note,
}

/// One mistake or warning, with its place in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Error, warning or note.
    pub severity: Severity,
    /// A sentence: what is wrong, the value found, what is allowed.
    pub message: String,
    /// A few words beside the caret.
    pub label: Option<String>,
    /// The bytes of the text the caret underlines.
    pub span: Range<usize>,
    /// Line of the first byte of `span`, from 1.
    pub line: usize,
    /// Column of the first byte of `span`, from 1, in characters.
    pub column: usize,
    /// The remedy in words that hold for every door.
    pub help: Option<String>,
    /// The choice of the caller that helps: [`Report::worded`] adds it to the help.
    pub remedy: Option<Box<Remedy>>,
}

impl Diagnostic {
    /// An error. Line and column follow from the span when the report is finished.
    pub(crate) fn error(span: Range<usize>, message: impl Into<String>) -> Self {
        let (label, help, remedy) = (None, None, None);
        Self { severity: Severity::Error, message: message.into(), label, span, line: 1, column: 1, help, remedy }
    }

    /// A warning.
    pub(crate) fn lint(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message) }
    }

    /// A note.
    pub(crate) fn note(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Note, ..Self::error(span, message) }
    }

    pub(crate) fn label(self, label: impl Into<String>) -> Self {
        Self { label: Some(label.into()), ..self }
    }

    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    pub(crate) fn remedy(self, remedy: Remedy) -> Self {
        Self { remedy: Some(Box::new(remedy)), ..self }
    }

    pub(crate) fn maybe_help(self, help: Option<String>) -> Self {
        Self { help: help.or(self.help), ..self }
    }

    /// Adds a sentence to the help, before a list.
    fn add_help(&mut self, words: &str) {
        self.help = Some(match self.help.take() {
            Some(question) if question.ends_with('?') => format!("{question} {words}"),
            Some(list) if list.contains('\n') => format!("{words}; {list}"),
            Some(help) => format!("{help}; {words}"),
            None => words.to_owned(),
        });
    }
}

/// The problems of one file: errors first, then warnings, then notes, each in the order of the text.
///
/// `Display` gives the full rendering without colour; [`Report::render`] and [`Report::short`] give the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The file, as the messages name it.
    pub name: String,
    /// Its text, without a byte order mark; spans count in it.
    pub text: String,
    /// The problems that were found.
    pub diagnostics: Vec<Diagnostic>,
    work: usize,
}

impl Report {
    /// A report of one error in a text, at the bytes of `span`: for what other readers than that of robot files find.
    pub fn of_error(
        name: &str,
        text: &str,
        span: Range<usize>,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> Self {
        let problems = Problems::new();
        problems.push(Diagnostic::error(span, message).maybe_help(help.map(str::to_owned)));
        problems.finish(name, text)
    }

    /// Gives each diagnostic a remedy.
    #[must_use]
    pub fn with_remedy(mut self, remedy: &Remedy) -> Self {
        for found in &mut self.diagnostics {
            found.remedy = Some(Box::new(remedy.clone()));
        }
        self
    }

    /// Adds each remedy to its help, in the words of a door.
    #[must_use]
    pub fn worded(mut self, words: impl Fn(&Remedy) -> Option<String>) -> Self {
        for found in &mut self.diagnostics {
            if let Some(words) = found.remedy.as_deref().and_then(&words) {
                found.add_help(&words);
                found.remedy = None;
            }
        }
        self
    }

    /// Adds a sentence to the help of each diagnostic.
    #[must_use]
    pub fn with_help(mut self, help: &str) -> Self {
        self.diagnostics.iter_mut().for_each(|found| found.add_help(help));
        self
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// Whether there is an error, not only warnings.
    pub fn has_errors(&self) -> bool {
        self.errors().next().is_some()
    }

    /// The errors, in the order of the text.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|found| found.severity == Severity::Error)
    }

    /// The warnings, in the order of the text.
    pub fn warnings(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|found| found.severity == Severity::Warning)
    }

    /// The notes, in the order of the text.
    pub fn notes(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|found| found.severity == Severity::Note)
    }

    /// How much work the reading was, the same on every machine: events of the parser, characters of expressions, parts
    /// of formulas, comparisons of keys and letters, characters passed on the way to the lines. It grows with the
    /// length of the text at most in proportion, and by a bounded amount beyond that.
    pub fn work(&self) -> usize {
        self.work
    }

    /// Every diagnostic with its source line, caret and help; `color` adds ANSI escapes for a terminal.
    ///
    /// After twenty diagnostics the rest is only counted.
    pub fn render(&self, color: bool) -> String {
        render::full(self, color)
    }

    /// One line per diagnostic, as editors and log searches like it: `robots/x.yaml:3:12: error: …`.
    pub fn short(&self) -> String {
        render::short(self)
    }
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Report {}

/// Collects the diagnostics of one file while it is read.
///
/// It has to be turned into a [`Report`]: dropping it with its contents unread is a mistake of this crate and panics.
pub(crate) struct Problems {
    found: RefCell<Option<Vec<Diagnostic>>>,
    work: Cell<usize>,
}

impl Problems {
    pub(crate) fn new() -> Self {
        Self { found: RefCell::new(Some(Vec::new())), work: Cell::new(0) }
    }

    pub(crate) fn push(&self, diagnostic: Diagnostic) {
        if let Some(found) = self.found.borrow_mut().as_mut() {
            found.push(diagnostic);
        }
    }

    /// Gives what has a label another one, and another help.
    pub(crate) fn relabel(&self, label: &str, new: &str, help: &str) {
        for found in self.found.borrow_mut().iter_mut().flatten().filter(|one| one.label.as_deref() == Some(label)) {
            (found.label, found.help) = (Some(new.to_owned()), Some(help.to_owned()));
        }
    }

    /// Enters `steps` of work, for [`Report::work`].
    pub(crate) fn count(&self, steps: usize) {
        self.work.set(self.work.get().saturating_add(steps));
    }

    /// Whether an error is found already.
    pub(crate) fn has_errors(&self) -> bool {
        self.found.borrow().iter().flatten().any(|found| found.severity == Severity::Error)
    }

    /// Everything found, located in `text`, errors first.
    pub(crate) fn finish(self, name: &str, text: &str) -> Report {
        let mut diagnostics = self.found.borrow_mut().take().unwrap_or_default();
        diagnostics.sort_by(|a, b| (a.span.start, a.severity, &a.message).cmp(&(b.span.start, b.severity, &b.message)));
        // A value behind an alias is read once per alias.
        diagnostics.dedup();
        self.count(locate(&mut diagnostics, text));
        diagnostics.sort_by_key(|found| found.severity);
        Report { name: name.to_owned(), text: text.to_owned(), diagnostics, work: self.work.get() }
    }
}

impl Drop for Problems {
    fn drop(&mut self) {
        let finished = self.found.borrow().is_none();
        assert!(finished || std::thread::panicking(), "the diagnostics of a robot file were dropped unread");
    }
}

/// Fills in lines and columns in one pass over the text; `diagnostics` are sorted by position. Returns how many
/// characters it looked at.
fn locate(diagnostics: &mut [Diagnostic], text: &str) -> usize {
    let (mut line, mut column, mut at) = (1, 1, 0);
    let mut passed = 0;
    for found in diagnostics {
        // Never beyond the text, nor inside a character.
        let start = char_boundary(text, found.span.start);
        let end = char_boundary(text, found.span.end).max(start);
        for character in text.get(at..start).unwrap_or_default().chars() {
            (line, column) = if character == '\n' { (line + 1, 1) } else { (line, column + 1) };
            passed += 1;
        }
        at = start;
        (found.span, found.line, found.column) = (start..end, line, column);
    }
    passed
}

/// The start of the character that `index` points at or into; the end of the text for anything beyond.
fn char_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}
