//! The functions of a binary image: their instructions, sizes and stack frames.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::listing::{self, Count, Fault, Line};

/// The cost of a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Instructions of one call.
    pub instructions: u64,
    /// Bytes of instructions.
    pub code: u64,
    /// Bytes of constants.
    pub constants: u64,
    /// Bytes of stack, for saved registers and spilled values.
    pub stack: u64,
}

/// The functions of an image.
#[derive(Clone, Debug, Default)]
pub struct Image {
    functions: BTreeMap<String, Function>,
}

/// A function of an image.
#[derive(Clone, Debug)]
pub struct Function {
    /// The size of its symbol, bytes.
    pub size: u64,
    /// The stack frame, bytes, if it is known.
    pub stack: Option<u64>,
    /// The instructions and constants.
    pub lines: Vec<Line>,
}

/// A function in a chain of calls, with its name.
type Called<'a> = (&'a str, &'a Function);

/// The reason why a function has no figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoFigures {
    /// The image has no such function.
    Absent(String),
    /// The stack frame of the function is unknown.
    NoFrame(String),
    /// The function calls itself, directly or indirectly.
    Recursive(String),
    /// The function has branches or calls, or computes in double precision.
    NotStraight(String, Vec<Fault>),
}

impl Image {
    /// Makes an image with these functions, by their names.
    #[must_use]
    pub const fn new(functions: BTreeMap<String, Function>) -> Self {
        Self { functions }
    }

    /// Adds the stack frames of functions that have none in the image.
    #[must_use]
    pub fn with_frames(mut self, frame: impl Fn(&str) -> Option<u64>) -> Self {
        for (name, function) in &mut self.functions {
            function.stack = function.stack.or_else(|| frame(name));
        }
        self
    }

    /// Returns the faults because of which a function is not straight-line code.
    ///
    /// # Errors
    /// When the image has no function with this name.
    pub fn faults(&self, name: &str) -> Result<Vec<Fault>, NoFigures> {
        Ok(listing::judge(&self.function(name)?.lines).1)
    }

    /// Returns the figures of a function that must be straight-line code; an error lists its faults.
    ///
    /// # Errors
    /// When it is not straight-line code, or its stack frame is unknown.
    pub fn straight(&self, name: &str) -> Result<Figures, NoFigures> {
        self.straight_but_for(name, |_| false)
    }

    /// Returns the figures of a function that may call some others. All must be straight-line code except for these
    /// calls, and their figures are included.
    ///
    /// # Errors
    /// When one of them is not straight-line code, or its stack frame is unknown.
    pub fn straight_but_for(&self, name: &str, may_be_called: impl Fn(&str) -> bool) -> Result<Figures, NoFigures> {
        let executed = self.executed(name, &may_be_called)?;
        let mut figures = Figures::default();
        let mut seen = BTreeSet::new();
        for name in &executed {
            let function = self.function(name)?;
            let (Count { instructions, constants }, _) = listing::judge(&function.lines);
            figures.instructions += instructions;
            if seen.insert(name) {
                function.stack.ok_or_else(|| NoFigures::NoFrame(name.clone()))?;
                figures.code += function.size - constants;
                figures.constants += constants;
            }
        }
        figures.stack = self.deepest(name, &may_be_called, &|function| function.stack.unwrap_or(0))?;
        Ok(figures)
    }

    /// Returns the functions that a call executes: the function itself, and those that it calls directly or indirectly,
    /// once for each call. All must be straight-line code except for these calls.
    ///
    /// # Errors
    /// When a function has another fault, or calls itself.
    pub fn executed(&self, name: &str, may_be_called: &dyn Fn(&str) -> bool) -> Result<Vec<String>, NoFigures> {
        let mut executed = Vec::new();
        self.walk(name, may_be_called, &mut Vec::new(), &mut |path| {
            executed.extend(path.last().map(|(name, _)| (*name).to_owned()));
        })?;
        Ok(executed)
    }

    /// Returns the sum of the frames of the deepest chain of calls, bytes.
    ///
    /// # Errors
    /// The errors of [`executed`](Self::executed).
    pub fn deepest(
        &self,
        name: &str,
        may_be_called: &dyn Fn(&str) -> bool,
        frame: &dyn Fn(&Function) -> u64,
    ) -> Result<u64, NoFigures> {
        let mut deepest = 0;
        self.walk(name, may_be_called, &mut Vec::new(), &mut |path| {
            deepest = deepest.max(path.iter().map(|(_, function)| frame(function)).sum());
        })?;
        Ok(deepest)
    }

    /// Visits each call with the chain of calls that leads to it.
    fn walk<'a>(
        &'a self,
        name: &str,
        may_be_called: &dyn Fn(&str) -> bool,
        path: &mut Vec<Called<'a>>,
        visit: &mut dyn FnMut(&[Called<'a>]),
    ) -> Result<(), NoFigures> {
        let Some((name, function)) = self.functions.get_key_value(name) else {
            return Err(NoFigures::Absent(name.to_owned()));
        };
        if path.iter().any(|(above, _)| above == name) {
            return Err(NoFigures::Recursive(name.clone()));
        }
        path.push((name, function));
        visit(path);
        for callee in self.calls(name, may_be_called)? {
            self.walk(&callee, may_be_called, path, visit)?;
        }
        path.pop();
        Ok(())
    }

    /// Returns the functions that a function calls, once for each call. It must be straight-line code except for these
    /// calls.
    ///
    /// # Errors
    /// When the function has another fault than the calls that are allowed.
    pub fn calls(&self, name: &str, may_be_called: impl Fn(&str) -> bool) -> Result<Vec<String>, NoFigures> {
        let (calls, faults): (Vec<Fault>, Vec<Fault>) =
            self.faults(name)?.into_iter().partition(|fault| fault.callee().is_some_and(&may_be_called));
        if !faults.is_empty() {
            return Err(NoFigures::NotStraight(name.to_owned(), faults));
        }
        Ok(calls.iter().filter_map(Fault::callee).map(str::to_owned).collect())
    }

    /// Returns a function by its name.
    ///
    /// # Errors
    /// When the image has no function with this name.
    pub fn function(&self, name: &str) -> Result<&Function, NoFigures> {
        self.functions.get(name).ok_or_else(|| NoFigures::Absent(name.to_owned()))
    }

    /// Returns the name of the only function with this beginning and end; `None` if there are several or none.
    #[must_use]
    pub fn find(&self, start: &str, end: &str) -> Option<&str> {
        let mut found = self.functions.keys().filter(|name| name.starts_with(start) && name.ends_with(end));
        let first = found.next()?;
        found.next().is_none().then_some(first)
    }
}

impl fmt::Display for NoFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent(name) => write!(f, "the image has no function {name}"),
            Self::NoFrame(name) => write!(f, "nothing says how much stack {name} uses"),
            Self::Recursive(name) => write!(f, "{name} calls itself"),
            Self::NotStraight(name, faults) => {
                let faults: Vec<String> = faults.iter().map(|fault| format!("  {fault}")).collect();
                write!(f, "{name} is not straight:\n{}", faults.join("\n"))
            }
        }
    }
}

impl std::error::Error for NoFigures {}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{Figures, Function, Image, NoFigures};
    use crate::listing;

    /// Returns an image in which `a` calls `b` twice and `c` once, and `b` calls `c`.
    fn image(of_c: &str) -> Image {
        let text = format!(
            "00000000 <a>:\n   0:\tbl\t40 <b>\n   4:\tbl\t40 <b>\n   8:\tbl\t80 <c>\n   c:\tbx\tlr\n\n\
             00000040 <b>:\n  40:\tnop\n  42:\tbl\t80 <c>\n  46:\tbx\tlr\n\n00000080 <c>:\n{of_c}  84:\tbx\tlr\n"
        );
        let listed = listing::functions(&text).expect("a listing");
        let frames = BTreeMap::from([("a", 8), ("b", 24), ("c", 4)]);
        let functions = listed.into_iter().map(|(name, lines)| {
            let stack = frames.get(name.as_str()).copied();
            (name, Function { size: 10, stack, lines })
        });
        Image::new(functions.collect())
    }

    #[test]
    fn calls_of_calls_are_counted() {
        let image = image("");
        // a has 4 instructions, b 3, c 1: 4 + 2 (3 + 1) + 1
        let expected = Figures { instructions: 13, code: 30, constants: 0, stack: 8 + 24 + 4 };
        assert_eq!(image.straight_but_for("a", |_| true), Ok(expected));
        assert_eq!(image.executed("a", &|_| true).expect("straight").join(" "), "a b c b c c");
        assert!(matches!(image.straight_but_for("a", |name| name == "b"), Err(NoFigures::NotStraight(..))));
    }

    #[test]
    fn recursion_is_refused() {
        let recursive = image("  80:\tbl\t40 <b>\n");
        assert_eq!(recursive.straight_but_for("a", |_| true), Err(NoFigures::Recursive("b".to_owned())));
    }
}
