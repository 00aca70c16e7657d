//! The functions of an image: their instructions, sizes and stack frames.

use std::collections::BTreeMap;
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
    /// Bytes of stack, of what is saved and of what is spilled.
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
    /// Its stack frame, bytes, where something says it.
    pub stack: Option<u64>,
    /// Its instructions and constants.
    pub lines: Vec<Line>,
}

/// Why a function has no figures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoFigures {
    /// The image has no such function.
    Absent(String),
    /// Nothing says how much stack it uses.
    NoFrame(String),
    /// It has more than one path, calls, or computes in double precision.
    NotStraight(String, Vec<Fault>),
}

impl Image {
    /// An image with these functions, by their names.
    #[must_use]
    pub const fn new(functions: BTreeMap<String, Function>) -> Self {
        Self { functions }
    }

    /// Adds the stack frames of functions that the image says nothing about.
    #[must_use]
    pub fn with_frames(mut self, frame: impl Fn(&str) -> Option<u64>) -> Self {
        for (name, function) in &mut self.functions {
            function.stack = function.stack.or_else(|| frame(name));
        }
        self
    }

    /// The faults that keep a function from being straight.
    ///
    /// # Errors
    /// When there is no such function.
    pub fn faults(&self, name: &str) -> Result<Vec<Fault>, NoFigures> {
        Ok(listing::judge(&self.function(name)?.lines).1)
    }

    /// The figures of a function that must be straight; an error lists its faults.
    ///
    /// # Errors
    /// When it is not straight, or nothing says how much stack it uses.
    pub fn straight(&self, name: &str) -> Result<Figures, NoFigures> {
        self.straight_but_for(name, |_| false)
    }

    /// The figures of a function that may call some others, which must be straight; theirs are included.
    ///
    /// # Errors
    /// When it or one that it calls is not straight, or nothing says how much stack they use.
    pub fn straight_but_for(&self, name: &str, may_be_called: impl Fn(&str) -> bool) -> Result<Figures, NoFigures> {
        let function = self.function(name)?;
        let (Count { instructions, constants }, _) = listing::judge(&function.lines);
        let stack = function.stack.ok_or_else(|| NoFigures::NoFrame(name.to_owned()))?;
        let mut figures = Figures { instructions, code: function.size - constants, constants, stack };
        let mut callees: BTreeMap<String, Figures> = BTreeMap::new();
        for callee in self.calls(name, may_be_called)? {
            let called = self.straight(&callee)?;
            figures.instructions += called.instructions;
            callees.insert(callee, called);
        }
        figures.code += callees.values().map(|called| called.code).sum::<u64>();
        figures.constants += callees.values().map(|called| called.constants).sum::<u64>();
        figures.stack += callees.values().map(|called| called.stack).max().unwrap_or(0);
        Ok(figures)
    }

    /// The functions that a function calls, once for each call; it must be straight but for these calls.
    ///
    /// # Errors
    /// When it has another fault than a call of a function that may be called.
    pub fn calls(&self, name: &str, may_be_called: impl Fn(&str) -> bool) -> Result<Vec<String>, NoFigures> {
        let (calls, faults): (Vec<Fault>, Vec<Fault>) =
            self.faults(name)?.into_iter().partition(|fault| fault.callee().is_some_and(&may_be_called));
        if !faults.is_empty() {
            return Err(NoFigures::NotStraight(name.to_owned(), faults));
        }
        Ok(calls.iter().filter_map(Fault::callee).map(str::to_owned).collect())
    }

    /// A function by its name.
    ///
    /// # Errors
    /// When the image has no function with this name.
    pub fn function(&self, name: &str) -> Result<&Function, NoFigures> {
        self.functions.get(name).ok_or_else(|| NoFigures::Absent(name.to_owned()))
    }

    /// The one function whose name begins and ends so.
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
            Self::NotStraight(name, faults) => {
                let faults: Vec<String> = faults.iter().map(|fault| format!("  {fault}")).collect();
                write!(f, "{name} is not straight:\n{}", faults.join("\n"))
            }
        }
    }
}

impl std::error::Error for NoFigures {}
