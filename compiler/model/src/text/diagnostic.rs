//! Errors and warnings as data: where they are, what is wrong, and what to do.

use std::cell::{Cell, RefCell};
use std::ops::Range;

use crate::text::render;

/// A choice of the caller that solves a problem. Each interface names it in its own words, as an option of the command
/// line or a keyword argument in Python.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// The text is a URDF, not a robot file, and must be imported.
    ImportUrdf {
        /// The file, where the message names one.
        file: Option<String>,
    },
    /// The tree of a URDF has several ends, so the caller must name the link at the tip.
    NameTip,
    /// The caller can lock a joint of a URDF, by its name.
    LockJoint {
        /// The name of the joint.
        joint: String,
    },
    /// The caller can lock the movable joints outside the chain, each by its name or all at zero.
    LockOthers,
    /// The caller can keep a body whose inertia no physical body has.
    KeepUnphysical,
    /// The caller can ask for edits after which the inertia is possible.
    Repair,
    /// The caller can import the whole robot of a URDF instead of one arm.
    Whole,
    /// The caller can import the whole robot, or lock this joint by its name.
    WholeOrLock {
        /// The name of the joint.
        joint: String,
    },
    /// The caller can let the base of a whole robot float.
    Float,
    /// The caller can include the inertia of motor rotors.
    Rotors,
}

/// How serious a [`Diagnostic`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Severity {
    /// An error: the file is refused.
    Error,
    /// A warning: the file is valid, but its author probably meant something else.
    Warning,
    /// A note: the file is valid, and published data have such values, but it is worth a look. A build does not repeat
    /// it each time.
    Note,
}

/// One mistake or warning, with its place in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Error, warning or note.
    pub severity: Severity,
    /// A sentence that says what is wrong, which value was found, and what is allowed.
    pub message: String,
    /// A few words that are printed beside the caret.
    pub label: Option<String>,
    /// The bytes of the text that the caret underlines.
    pub span: Range<usize>,
    /// The line of the first byte of `span`, counted from 1.
    pub line: usize,
    /// The column of the first byte of `span`, counted from 1 in characters.
    pub column: usize,
    /// The advice, in words that fit every interface.
    pub help: Option<String>,
    /// A choice of the caller that solves the problem; [`Report::worded`] adds it to the help.
    pub remedy: Option<Box<Remedy>>,
}

impl Diagnostic {
    /// Makes an error. Line and column are computed from the span when the report is finished.
    pub(crate) fn error(span: Range<usize>, message: impl Into<String>) -> Self {
        let (label, help, remedy) = (None, None, None);
        Self { severity: Severity::Error, message: message.into(), label, span, line: 1, column: 1, help, remedy }
    }

    /// Makes a warning.
    pub(crate) fn lint(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message) }
    }

    /// Makes a note.
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

    /// Adds a sentence to the help; if the help ends with a list, before this list.
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
    /// The name of the file in messages.
    pub name: String,
    /// The text of the file, without a byte order mark; spans count in it.
    pub text: String,
    /// The problems that were found.
    pub diagnostics: Vec<Diagnostic>,
    work: usize,
}

impl Report {
    /// Makes a report of one error in a text, at the bytes of `span`, for readers of other files than robot files.
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

    /// Moves each remedy into the help of its diagnostic, in the words of an interface that `words` returns.
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

    /// Returns whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// Returns whether the report has an error, not only warnings and notes.
    pub fn has_errors(&self) -> bool {
        self.errors().next().is_some()
    }

    /// Returns the errors, in the order of the text.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|found| found.severity == Severity::Error)
    }

    /// Returns the warnings, in the order of the text.
    pub fn warnings(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|found| found.severity == Severity::Warning)
    }

    /// Returns the notes, in the order of the text.
    pub fn notes(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|found| found.severity == Severity::Note)
    }

    /// Returns how many steps reading took, the same on every machine: events of the parser, characters of expressions,
    /// parts of formulas, comparisons of keys and letters, characters counted for line numbers. It grows at most in
    /// proportion to the length of the text, plus a bounded amount.
    pub fn work(&self) -> usize {
        self.work
    }

    /// Renders every diagnostic with its source line, caret and help; `color` adds ANSI escapes for a terminal.
    ///
    /// After twenty diagnostics the others are only counted.
    pub fn render(&self, color: bool) -> String {
        render::full(self, color)
    }

    /// Renders one line per diagnostic, which editors and log searches understand: `robots/x.yaml:3:12: error: …`.
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
/// It must be turned into a [`Report`]: dropping it before that is a mistake in this crate and panics.
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

    /// Replaces the label and the help of every diagnostic that has this label.
    pub(crate) fn relabel(&self, label: &str, new: &str, help: &str) {
        for found in self.found.borrow_mut().iter_mut().flatten().filter(|one| one.label.as_deref() == Some(label)) {
            (found.label, found.help) = (Some(new.to_owned()), Some(help.to_owned()));
        }
    }

    /// Adds `steps` of work to the count of [`Report::work`].
    pub(crate) fn count(&self, steps: usize) {
        self.work.set(self.work.get().saturating_add(steps));
    }

    /// Returns whether an error has been found already.
    pub(crate) fn has_errors(&self) -> bool {
        self.found.borrow().iter().flatten().any(|found| found.severity == Severity::Error)
    }

    /// Makes the report: all diagnostics with their places in `text`, errors first.
    pub(crate) fn finish(self, name: &str, text: &str) -> Report {
        let mut diagnostics = self.found.borrow_mut().take().unwrap_or_default();
        diagnostics.sort_by(|a, b| (a.span.start, a.severity, &a.message).cmp(&(b.span.start, b.severity, &b.message)));
        // A value with an anchor is read again for each alias, which repeats its diagnostics.
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

/// Fills in lines and columns in one pass over the text; `diagnostics` must be sorted by position. Returns the number
/// of characters read.
fn locate(diagnostics: &mut [Diagnostic], text: &str) -> usize {
    let (mut line, mut column, mut at) = (1, 1, 0);
    let mut passed = 0;
    for found in diagnostics {
        // Keeps the span inside the text, and at the boundaries of characters.
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

/// Returns the start of the character that `index` points at or into; the end of the text for anything beyond it.
fn char_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}
