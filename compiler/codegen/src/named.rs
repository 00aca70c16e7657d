//! Enums whose variants have names in files, in attributes and on the command line.

use std::fmt;

use rne_model::did_you_mean;

/// Defines an enum with a list of its variants, their names, and the variant of a name.
macro_rules! named {
    ($(#[$doc:meta])* $type:ident, $what:literal {
        $($(#[$variant_doc:meta])* $variant:ident = $name:expr),* $(,)?
    }) => {
        rne_functions::named! {
            $(#[$doc])*
            $type { $($(#[$variant_doc])* $variant = $name),* }
        }

        impl std::str::FromStr for $type {
            type Err = $crate::UnknownName;

            fn from_str(text: &str) -> Result<Self, $crate::UnknownName> {
                Self::named(text).ok_or_else(|| {
                    $crate::UnknownName { found: text.to_owned(), what: $what, allowed: &Self::NAMES }
                })
            }
        }
    };
}
pub(crate) use named;

/// A name that is not allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    pub(crate) found: String,
    pub(crate) what: &'static str,
    pub(crate) allowed: &'static [&'static str],
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Largest number of valid words that a message lists.
        const FEW: usize = 20;
        let Self { found, what, allowed } = self;
        write!(f, "`{found}` is not a valid {what}; ")?;
        if allowed.len() > FEW {
            return match did_you_mean(found, allowed.iter().copied()) {
                Some(near) => write!(f, "did you mean `{near}`?"),
                None => write!(f, "there are {}, such as `{}` and `{}`", allowed.len(), allowed[0], allowed[1]),
            };
        }
        let allowed: Vec<String> = allowed.iter().map(|name| format!("`{name}`")).collect();
        write!(f, "the valid words are {}", allowed.join(", "))
    }
}

impl std::error::Error for UnknownName {}
