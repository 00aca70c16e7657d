//! The prefix of the names of a robot's functions in C.

use std::fmt;
use std::str::FromStr;

use rne_model::Robot;

/// The prefix of every name that a header declares, which replaces the modules that C does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prefix(String);

impl Prefix {
    /// Returns the robot's name as prefix; it is an identifier of C.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        Self(robot.name.clone())
    }

    /// Returns the prefix as text.
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

    /// Parses a prefix: a letter, then letters, digits and single underscores. Names that begin with an underscore are
    /// reserved for the compiler, in C++ also names with two underscores in sequence.
    fn from_str(text: &str) -> Result<Self, BadPrefix> {
        let mut characters = text.chars();
        let starts = characters.next().is_some_and(|first| first.is_ascii_alphabetic());
        let goes_on = characters.all(|c| c.is_ascii_alphanumeric() || c == '_');
        let is_reserved = text.contains("__") || text.ends_with('_');
        if starts && goes_on && !is_reserved { Ok(Self(text.to_owned())) } else { Err(BadPrefix) }
    }
}

/// The error of a text that cannot be a prefix of names in C.
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
