//! The keys of the format as data, for tools that document or complete them.

use crate::readers::robot::{Takes, robot};
use crate::text::decode::Context;
use crate::text::diagnostic::Problems;
use crate::{text::document, text::source};

/// A mapping of the format, such as a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Mapping {
    /// The name of the mapping in messages.
    pub name: &'static str,
    /// The keys that the mapping may have, in the order in which they are read.
    pub keys: &'static [Key],
}

/// A key of a mapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Key {
    /// The key as a file writes it.
    pub name: &'static str,
    /// Whether the key is required, because it has no default.
    pub is_required: bool,
}

/// Returns the kinds of mappings that a robot file contains, each once, with all keys that the format has for them. A
/// file with a mapping of each kind gives the whole format. Mistakes in the file are not reported.
///
/// ```
/// let mappings = rne_model::mappings("joints: [{dh: {}}]");
/// let names: Vec<&str> = mappings.iter().map(|mapping| mapping.name).collect();
/// assert_eq!(names, ["a robot file", "a joint", "`dh`"]);
/// let required = mappings[2].keys.iter().filter(|key| key.is_required).map(|key| key.name);
/// assert_eq!(required.collect::<Vec<_>>(), ["theta", "d", "a", "alpha"]);
/// ```
#[must_use]
pub fn mappings(text: &str) -> Vec<Mapping> {
    let problems = Problems::new();
    let mut mappings = Vec::new();
    if source::size_is_fine(text.len(), document::ROBOT_FILE.name, &problems)
        && let Some(root) = document::parse(text, document::ROBOT_FILE, &problems)
    {
        let cx = Context::new(text, &problems, &[]);
        let _ = robot(&cx, &root, Takes { trees: true, couplings: true, loops: true });
        mappings = cx.mappings.take();
    }
    let _ = problems.finish("", text);
    mappings
}
