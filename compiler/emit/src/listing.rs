//! The annotated code of a program as data: each step's formulas, its statements, what each component became, and which
//! operations were removed. Renderers show it as text or with colours.

mod explanations;
mod headings;
mod sections;

use std::fmt;

use rne_codegen::{
    Constant, Expression, Form, Function, Length, Name, Program, Record, Shape, SineCosine, Statement, Step,
    WithRespectTo,
};
use rne_model::Robot;

use self::sections::{by_steps, in_order};
use super::annotated::{Annotated, Part};
use super::expression;
use super::formula::Formula;
use super::line_breaks::statement as written;
use super::syntax::Syntax;
use super::wrap::{TIED, WIDTH, fill};

pub use self::explanations::reason;
pub(super) use self::headings::recursion;

/// The part of a program to list, and the number of explanations.
#[derive(Clone, Copy, Debug, Default)]
pub struct Selection {
    /// List one joint only, counted from 1.
    pub joint: Option<usize>,
    /// List one step only.
    pub step: Option<Step>,
    /// Whether to say what became of components that have no statement, and which operations were removed.
    pub explain: bool,
    /// Largest number of reasons for removed operations that are named, the most frequent first.
    pub reasons: Option<usize>,
}

impl Selection {
    fn includes(&self, joint: usize, step: Step) -> bool {
        self.joint.is_none_or(|only| only == joint) && self.step.is_none_or(|only| only == step)
    }

    fn is_everything(&self) -> bool {
        self.explain && self.joint.is_none() && self.step.is_none()
    }
}

/// A program, or a part of it, for reading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Listing<'a> {
    /// The sections, in order.
    pub sections: Vec<Section<'a>>,
}

/// A section of a listing: the statements of one step for one joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section<'a> {
    /// The joint and the step, and the variable with respect to which the statements are derivatives. `None` for lines
    /// that belong to no step: the constants and angles at the beginning of a function, its results, and a program
    /// without sections.
    pub place: Option<(usize, Step, Option<WithRespectTo>)>,
    /// Its lines, in order.
    pub lines: Vec<Line<'a>>,
}

/// A line of a listing. Every [`Name`] in it says its quantity, joint and axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Line<'a> {
    /// The heading of the section.
    Heading(String),
    /// A formula of its step.
    Formula(Formula),
    /// A constant at the beginning of the function.
    Constant(Constant),
    /// A sine and cosine at the beginning of the function.
    SineCosine(&'a SineCosine, Expression<'a>),
    /// A statement and its expression.
    Statement(&'a Statement, Expression<'a>),
    /// The fate of components that have no statement.
    Resolution {
        /// The components.
        names: Vec<Name>,
        /// The value that they have, with the sign or word before it.
        became: Annotated,
    },
    /// The number of operations that are left, and why the others were removed.
    Folds(Folds),
    /// The results of the function.
    Returned(Annotated),
}

/// The operations of a step before and after the removal of unneeded ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folds {
    /// Number of products and sums of the formulas.
    pub before: (usize, usize),
    /// Number of products and sums that are left.
    pub left: (usize, usize),
    /// Number of removed operations for each reason, the most frequent first.
    pub reasons: Vec<(usize, String)>,
    /// Number of operations that were removed for other reasons.
    pub others: usize,
}

impl Listing<'_> {
    /// Whether the listing has no section.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// Returns the listing in a language, with blank lines between the sections.
    pub(super) fn text(&self, syntax: Syntax) -> String {
        let section =
            |section: &Section| -> String { section.lines.iter().map(|line| line.indented(syntax) + "\n").collect() };
        self.sections.iter().map(section).collect::<Vec<_>>().join("\n")
    }
}

impl<'a> Line<'a> {
    /// Returns the line of a statement of a program.
    pub(super) fn statement(program: &'a Program, statement: &'a Statement) -> Self {
        Self::Statement(statement, program.values.defined(statement.value))
    }

    fn turn(program: &'a Program, turn: &'a SineCosine) -> Self {
        Self::SineCosine(turn, program.values.used(turn.angle))
    }

    /// Returns the line as words and Rust code, neither indented nor marked as a comment.
    #[must_use]
    pub fn annotated(&self) -> Annotated {
        self.annotated_in(Syntax::Rust, "")
    }

    /// Whether the line is a comment of the code.
    #[must_use]
    pub const fn is_comment(&self) -> bool {
        !matches!(self, Self::Constant(_) | Self::Statement(..) | Self::Returned(_))
    }

    fn annotated_in(&self, syntax: Syntax, indent: &str) -> Annotated {
        let names = |names: &[Name]| Annotated::join(names.iter().map(|&name| name.into()), ", ");
        match self {
            Self::Heading(words) => words.clone().into(),
            Self::Formula(formula) => formula.text.clone().into(),
            Self::Constant(Constant { name, value }) => {
                let value = Annotated::part(Part::Number, format!("{value:?}"));
                Annotated::default() + indent + declaration(syntax, *name) + " " + value + ";"
            }
            Self::SineCosine(SineCosine { sine, cosine, .. }, angle) => {
                let what = match (sine, cosine) {
                    (Some(_), Some(_)) => "sine and cosine",
                    (Some(_), None) => "sine",
                    _ => "cosine",
                };
                let turned: Vec<Name> = sine.iter().chain(cosine).copied().collect();
                names(&turned) + ": " + what + " of " + expression::line(syntax, *angle)
            }
            Self::Statement(Statement { name, .. }, value) => {
                written(syntax, indent, declaration(syntax, *name), *value)
            }
            Self::Resolution { names: found, became } => names(found) + became.clone(),
            Self::Folds(folds) => folds.to_string().into(),
            Self::Returned(code) => Annotated::default() + indent + code.clone(),
        }
    }

    /// Returns the line as it is inside a function.
    pub(super) fn indented(&self, syntax: Syntax) -> String {
        let text = self.annotated_in(syntax, "    ").to_string();
        if self.is_comment() { fill(&text, WIDTH, "    // ", "    //   ") } else { text }
    }
}

/// Displays the listing in Rust.
impl fmt::Display for Listing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(Syntax::Rust))
    }
}

/// Displays the line as it is inside a function of Rust.
impl fmt::Display for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.indented(Syntax::Rust))
    }
}

fn declaration(syntax: Syntax, name: Name) -> Annotated {
    Annotated::part(Part::Keyword, syntax.declaration()) + " " + name + " ="
}

impl fmt::Display for Folds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { before: (products, sums), left: (kept_products, kept_sums), reasons, others } = self;
        write!(f, "{products} products and {sums} sums, {kept_products} and {kept_sums} left")?;
        let mut gone: Vec<String> =
            reasons.iter().map(|(count, reason)| format!("{count} ({reason})").replace(' ', TIED)).collect();
        if *others > 0 {
            gone.push(format!("{others} for other reasons"));
        }
        if gone.is_empty() { Ok(()) } else { write!(f, ". Gone: {}", gone.join(", ")) }
    }
}

/// Returns the statements of a program, with the headings and explanations of each joint and step.
#[must_use]
pub fn listing<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Listing<'a> {
    // only functions that return torques are listed by joints and steps; code for a floating base is not, but its
    // explanation is
    let keeps_to_steps = program.form == Form::SevenSteps
        && (program.function.returns_torques()
            || matches!(program.function.shape(), Shape::Array(Length::Joints, Shape::Record(Record::Wrench, _)))
            || what.explain && program.function == Function::InverseDynamicsOfFloatingBase);
    let mut sections = if keeps_to_steps { by_steps(robot, program, what) } else { in_order(robot, program, what) };
    sections.retain(|section| !section.lines.is_empty());
    Listing { sections }
}
