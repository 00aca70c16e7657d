//! The state that all readers of a file share.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::Range;

use crate::RunTime;
use crate::text::diagnostic::{Diagnostic, Problems};
use crate::text::document::Node;
use crate::text::expression::{Meaning, Names};
use crate::text::keys::Mapping;
use crate::text::source::{quoted, six_digits};
use crate::text::spelling::{LONGEST_WORD, did_you_mean};

/// The state that all readers of a file share: its text, its parameters, and the mistakes found so far.
pub(crate) struct Context<'t> {
    pub(crate) text: &'t str,
    pub(crate) problems: &'t Problems,
    /// The parameters of the file, sorted by name, so that suggestions are the same in every run.
    pub(crate) parameters: RefCell<BTreeMap<String, Parameter>>,
    /// The parameters that stay free until run time, and the numbers found to depend on them.
    pub(crate) run_time: RefCell<RunTime>,
    /// Parameters that the caller gives another value than the file has.
    pub(crate) settings: &'t [(&'t str, f64)],
    /// The kinds of mappings that were read in this file, each once.
    pub(crate) mappings: RefCell<Vec<Mapping>>,
    /// The name of the floating base, if the file has one; references may use it instead of `base`.
    pub(crate) base_name: RefCell<Option<String>>,
    /// How many unknown words have been compared with known ones.
    suggestions: Cell<usize>,
}

/// A parameter of the file.
pub(crate) struct Parameter {
    pub(crate) span: Range<usize>,
    /// The place of the expression of the parameter.
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
    /// Makes the context of a text; `run_time` are the names of the parameters that stay free until run time.
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

    /// Sets other values for these parameters.
    pub(crate) fn with_settings(self, settings: &'t [(&'t str, f64)]) -> Self {
        Self { settings, ..self }
    }

    /// Returns the candidate that `word` was probably meant to be. The numbers of words and candidates are limited,
    /// because a file of nothing but unknown words could cause too much work; a report shows fewer mistakes than that.
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
        // A candidate this much longer cannot be meant; a character has at most four bytes.
        let candidates = candidates.into_iter().take(MOST).filter(|candidate| candidate.len() <= 8 * LONGEST_WORD);
        let compared = |candidate: &&str| self.problems.count(candidate.len() * word.len().min(LONGEST_WORD));
        did_you_mean(word, candidates.inspect(compared))
    }

    /// Returns whether an error has been found already.
    pub(crate) fn has_errors(&self) -> bool {
        self.problems.has_errors()
    }

    /// Returns the index of the run-time parameter with this name, if there is one.
    pub(crate) fn run_time_index(&self, name: &str) -> Option<usize> {
        self.run_time.borrow().names.iter().position(|known| known == name)
    }

    /// Returns the name of a run-time parameter.
    pub(crate) fn parameter_name(&self, index: Option<usize>) -> String {
        let run_time = self.run_time.borrow();
        index.and_then(|index| run_time.names.get(index)).cloned().unwrap_or_default()
    }

    pub(super) fn opens(&self, mapping: Mapping) {
        let mut mappings = self.mappings.borrow_mut();
        if mappings.iter().all(|known| known.name != mapping.name) {
            mappings.push(mapping);
        }
    }

    pub(crate) fn report(&self, diagnostic: Diagnostic) {
        self.problems.push(diagnostic);
    }

    /// Reports a mistake and returns `None` in place of a value.
    pub(crate) fn refuse<T>(&self, diagnostic: Diagnostic) -> Option<T> {
        self.report(diagnostic);
        None
    }

    pub(super) fn wrong_shape<T>(&self, node: &Node, expected: &str) -> Option<T> {
        self.wrong_shape_with(node, expected, None)
    }

    pub(super) fn wrong_shape_with<T>(&self, node: &Node, expected: &str, help: Option<String>) -> Option<T> {
        let message = format!("found {} where {expected} is needed", node.described());
        self.refuse(Diagnostic::error(node.head(), message).label(format!("{expected} is needed")).maybe_help(help))
    }

    /// Returns the text of a node as the file writes it, for messages and suggestions.
    pub(crate) fn raw(&self, node: &Node) -> &'t str {
        self.text.get(node.span.clone()).unwrap_or_default()
    }

    /// Shows a number as the file writes it; an expression is followed by its value.
    pub(crate) fn shown(&self, node: &Node, value: f64) -> String {
        let raw = self.raw(node);
        match raw.parse::<f64>() {
            Ok(_) => quoted(raw),
            Err(_) => format!("{} = {}", quoted(raw), six_digits(value)),
        }
    }
}
