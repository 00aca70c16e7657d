//! Other files in YAML than robot files, read as plain data: every value knows its place, for messages.

use std::rc::Rc;

use crate::diagnostic::{Diagnostic, Problems, Report};
use crate::document::{self, Content, Node};

/// A YAML document of mappings, lists and texts.
#[derive(Debug)]
pub struct DataFile {
    name: String,
    text: String,
    root: Rc<Node>,
}

/// A value in a [`DataFile`].
#[derive(Clone, Copy, Debug)]
pub struct Value<'a> {
    file: &'a DataFile,
    node: &'a Node,
}

impl DataFile {
    /// Reads a document; `name` is what messages call it.
    ///
    /// # Errors
    /// What is wrong with the YAML.
    pub fn read(name: &str, text: &str) -> Result<Self, Report> {
        let problems = Problems::new();
        let root = document::parse(text, &problems);
        let report = problems.finish(name, text);
        match root {
            Some(root) if !report.has_errors() => Ok(Self { name: name.to_owned(), text: text.to_owned(), root }),
            _ => Err(report),
        }
    }

    /// The whole document.
    pub fn root(&self) -> Value<'_> {
        Value { file: self, node: &self.root }
    }
}

impl<'a> Value<'a> {
    /// The value of a key of a mapping.
    pub fn get(&self, key: &str) -> Option<Value<'a>> {
        Some(Value { file: self.file, node: self.node.get(key)? })
    }

    /// The keys of a mapping with their values; empty for anything else.
    pub fn entries(&self) -> impl Iterator<Item = (&'a str, Value<'a>)> {
        let (file, node) = (self.file, self.node);
        let entries = match &node.content {
            Content::Mapping(entries) => entries.as_slice(),
            _ => &[],
        };
        entries.iter().map(move |entry| (entry.key.as_str(), Value { file, node: &entry.value }))
    }

    /// The items of a list; `None` for anything else.
    pub fn items(&self) -> Option<impl ExactSizeIterator<Item = Value<'a>>> {
        let file = self.file;
        match &self.node.content {
            Content::Sequence(items) => Some(items.iter().map(move |node| Value { file, node })),
            _ => None,
        }
    }

    /// The text of a scalar.
    pub fn text(&self) -> Option<&'a str> {
        match &self.node.content {
            Content::Scalar(scalar) => Some(&scalar.text),
            _ => None,
        }
    }

    /// A report of one error at this value.
    pub fn error(&self, message: impl Into<String>, help: Option<String>) -> Report {
        let problems = Problems::new();
        problems.push(Diagnostic::error(self.node.head(), message).maybe_help(help));
        problems.finish(&self.file.name, &self.file.text)
    }
}
