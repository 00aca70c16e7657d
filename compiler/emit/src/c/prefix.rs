//! Prefix of the names of a robot's functions.

use std::fmt;
use std::str::FromStr;

use rne_model::Robot;

/// The beginning of every name that a header declares: C has no modules.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prefix(String);

impl Prefix {
    /// The robot's name, which is an identifier of C as well.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        Self(robot.name.clone())
    }

    /// The prefix as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Prefix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl FromStr for Prefix {
    type Err = BadPrefix;

    /// A letter, then letters, digits and underscores: names that begin with an underscore are the compiler's, and so
    /// are those with two in C++.
    fn from_str(text: &str) -> Result<Self, BadPrefix> {
        let mut characters = text.chars();
        let starts = characters.next().is_some_and(|first| first.is_ascii_alphabetic());
        let goes_on = characters.all(|c| c.is_ascii_alphanumeric() || c == '_');
        let is_reserved = text.contains("__") || text.ends_with('_');
        if starts && goes_on && !is_reserved { Ok(Self(text.to_owned())) } else { Err(BadPrefix) }
    }
}

/// A prefix with which no name can begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadPrefix;

impl fmt::Display for BadPrefix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "names of functions begin with it and an underscore: a letter from a to z or A to Z, then letters, digits \
             and single underscores between them, such as `my_arm`",
        )
    }
}

impl std::error::Error for BadPrefix {}
