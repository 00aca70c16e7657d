//! The annotated code of a program as data: each step's formulas, its statements, what each component became, and what
//! folded. Text, colour and whatever else shows it are renderers.

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

/// The part of a program to list, and how much of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Selection {
    /// One joint only, counted from 1.
    pub joint: Option<usize>,
    /// One step only.
    pub step: Option<Step>,
    /// Say what components became that are no statement, and what folded.
    pub explain: bool,
    /// Largest number of reasons why operations are gone that are named, the commonest first.
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

/// Lines of one section: the statements of one step for one joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section<'a> {
    /// The joint and the step, and of which variable the statements are derivatives; `None` for what belongs to no
    /// step: the constants and angles at the head of a function, what it returns, and a program without sections.
    pub place: Option<(usize, Step, Option<WithRespectTo>)>,
    /// Its lines, in order.
    pub lines: Vec<Line<'a>>,
}

/// A line of a listing. Every [`Name`] in it has a quantity, a joint and an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Line<'a> {
    /// The heading of the section.
    Heading(String),
    /// A formula of its step.
    Formula(Formula),
    /// A number that stands in no table.
    Constant(Constant),
    /// A sine and cosine at the head of the function.
    SineCosine(&'a SineCosine, Expression<'a>),
    /// A statement and its value.
    Statement(&'a Statement, Expression<'a>),
    /// The fate of components that have no statement.
    Resolution {
        /// The components.
        names: Vec<Name>,
        /// Their fate, with the sign or word between.
        became: Annotated,
    },
    /// How many operations are left, and why the others are gone.
    Folds(Folds),
    /// The results of the function.
    Returned(Annotated),
}

/// The effect of folding on the operations of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folds {
    /// Products and sums of the formulas.
    pub before: (usize, usize),
    /// Products and sums that are left.
    pub left: (usize, usize),
    /// How many are gone for which reason, the commonest first.
    pub reasons: Vec<(usize, String)>,
    /// How many are gone for other reasons.
    pub others: usize,
}

impl Listing<'_> {
    /// Whether the text is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// The listing in a language: blank lines between the sections.
    pub(super) fn text(&self, syntax: Syntax) -> String {
        let section =
            |section: &Section| -> String { section.lines.iter().map(|line| line.indented(syntax) + "\n").collect() };
        self.sections.iter().map(section).collect::<Vec<_>>().join("\n")
    }
}

impl<'a> Line<'a> {
    /// A statement of a program.
    pub(super) fn statement(program: &'a Program, statement: &'a Statement) -> Self {
        Self::Statement(statement, program.values.defined(statement.value))
    }

    fn turn(program: &'a Program, turn: &'a SineCosine) -> Self {
        Self::SineCosine(turn, program.values.used(turn.angle))
    }

    /// The line as words and code of Rust, neither indented nor marked as a comment.
    #[must_use]
    pub fn annotated(&self) -> Annotated {
        self.annotated_in(Syntax::Rust, "")
    }

    /// Whether it is a comment of the code.
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

    /// The line inside a function.
    pub(super) fn indented(&self, syntax: Syntax) -> String {
        let text = self.annotated_in(syntax, "    ").to_string();
        if self.is_comment() { fill(&text, WIDTH, "    // ", "    //   ") } else { text }
    }
}

/// The listing in Rust.
impl fmt::Display for Listing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(Syntax::Rust))
    }
}

/// The line inside a function of Rust, as text.
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

/// The statements of a program, with the headings and explanations of each joint and step.
#[must_use]
pub fn listing<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Listing<'a> {
    // only what returns torques keeps to joints and steps; the code of a floating base does not, its explanation does
    let keeps_to_steps = program.form == Form::SevenSteps
        && (program.function.returns_torques()
            || matches!(program.function.shape(), Shape::Array(Length::Joints, Shape::Record(Record::Wrench, _)))
            || what.explain && program.function == Function::InverseDynamicsOfFloatingBase);
    let mut sections = if keeps_to_steps { by_steps(robot, program, what) } else { in_order(robot, program, what) };
    sections.retain(|section| !section.lines.is_empty());
    Listing { sections }
}
