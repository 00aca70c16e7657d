//! Remarks on parts that an import leaves out or assumes, which every interface prints in its own words.

use std::fmt;

use rne_model::Remedy;

/// A remark of an import.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Remark {
    /// A sentence without its full stop.
    pub text: String,
    /// Whether this is a warning: the numbers of the file are probably wrong, or functions give other results than the
    /// program to which the file belongs.
    pub is_warning: bool,
    /// The choice of the caller that changes what the remark says.
    pub remedy: Option<Remedy>,
}

impl Remark {
    /// Returns the sentence; `words` adds the remedy in the words of an interface.
    pub fn worded(&self, words: impl Fn(&Remedy) -> Option<String>) -> String {
        let words = self.remedy.as_ref().and_then(words);
        words.map_or_else(|| self.text.clone(), |words| format!("{}; {words}", self.text))
    }

    pub(crate) fn warning(text: String) -> Self {
        Self { is_warning: true, ..text.into() }
    }

    pub(crate) fn remedy(self, remedy: Remedy) -> Self {
        Self { remedy: Some(remedy), ..self }
    }
}

impl From<String> for Remark {
    fn from(text: String) -> Self {
        Self { text, is_warning: false, remedy: None }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A list to which remarks are added.
#[derive(Clone, Debug, Default)]
pub(crate) struct Remarks(pub(crate) Vec<Remark>);

impl Remarks {
    pub(crate) fn push(&mut self, remark: impl Into<Remark>) {
        self.0.push(remark.into());
    }
}
