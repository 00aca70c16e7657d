//! The state that every reader of a file needs.

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

    /// The candidate that `word` was probably meant to be. The numbers of candidates and words bound the work that a
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

    pub(super) fn opens(&self, mapping: Mapping) {
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

    pub(super) fn wrong_shape<T>(&self, node: &Node, expected: &str) -> Option<T> {
        self.wrong_shape_with(node, expected, None)
    }

    pub(super) fn wrong_shape_with<T>(&self, node: &Node, expected: &str, help: Option<String>) -> Option<T> {
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
