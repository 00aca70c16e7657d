//! How an expression is written: where parentheses stand and where a long line breaks.

use super::annotated::{Annotated, Part};
use super::syntax::Syntax;
use super::wrap::WIDTH;
use crate::program::{Expression, Operator};

/// Where an operand stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Position {
    /// Left of + or -.
    Summand,
    /// Right of + or -.
    RightSummand,
    /// Left of ·.
    Factor,
    /// Right of ·.
    RightFactor,
    /// Behind a unary minus.
    Negated,
}

impl Operator {
    /// As Rust and C write it.
    pub(super) const fn sign(self) -> char {
        match self {
            Self::Sum => '+',
            Self::Difference => '-',
            Self::Product => '*',
            Self::Quotient => '/',
        }
    }

    /// Where its operands stand.
    pub(super) const fn positions(self) -> [Position; 2] {
        match self {
            Self::Sum | Self::Difference => [Position::Summand, Position::RightSummand],
            Self::Product | Self::Quotient => [Position::Factor, Position::RightFactor],
        }
    }
}

/// Whether an operand needs parentheses. A right operand keeps them even where mathematics would not: floating-point
/// sums and products are computed in the order in which they are written.
pub(super) fn needs_parentheses(syntax: Syntax, operand: &Expression, position: Position) -> bool {
    match operand {
        Expression::Variable(_) | Expression::Zero | Expression::BySign(_) => false,
        Expression::Binary(Operator::Product | Operator::Quotient, ..) => match position {
            Position::Summand | Position::RightSummand => syntax.groups_products(),
            Position::Factor => false,
            Position::RightFactor | Position::Negated => true,
        },
        Expression::Negative(_) | Expression::Binary(..) => position != Position::Summand,
    }
}

fn in_parentheses(text: Annotated) -> Annotated {
    Annotated::default() + "(" + text + ")"
}

/// The expression on one line.
pub(super) fn line(syntax: Syntax, expression: &Expression) -> Annotated {
    let operand = |operand: &Expression, position| {
        let text = line(syntax, operand);
        if needs_parentheses(syntax, operand, position) { in_parentheses(text) } else { text }
    };
    match expression {
        Expression::Variable(name) => (*name).into(),
        Expression::Zero => Annotated::part(Part::Number, syntax.zero()),
        Expression::Negative(a) => Annotated::default() + "-" + operand(a, Position::Negated),
        Expression::Binary(operator, a, b) => {
            let [left, right] = operator.positions();
            operand(a, left) + format!(" {} ", operator.sign()) + operand(b, right)
        }
        Expression::BySign(operands) => {
            let arguments = Annotated::join(operands.iter().map(|argument| line(syntax, argument)), ", ");
            Annotated::from(syntax.by_sign()) + in_parentheses(arguments)
        }
    }
}

/// `START EXPRESSION;`, where the start is `let NAME =` or the like, broken where it is too long, as rustfmt does.
pub(super) fn statement(syntax: Syntax, indent: &str, start: Annotated, expression: &Expression) -> Annotated {
    let start = Annotated::default() + indent + start;
    let one_line = line(syntax, expression);
    // one column is for the blank before it, and one for the semicolon, wherever that stands
    let used = width(&start) + 1;
    if used + width(&one_line) < WIDTH {
        return start + " " + one_line + ";";
    }
    let room = |used: usize| (WIDTH - 1).saturating_sub(used);
    let beside = Room { width: room(used), indent: indent.len(), used };
    let below = indent.len() + 4;
    let below = Room { width: room(below), indent: below, used: below };
    let breaks = |text: &Annotated| text.as_str().matches('\n').count();
    match (broken(syntax, expression, beside), broken(syntax, expression, below)) {
        (Some(beside), Some(below)) if breaks(&below) > 0 && breaks(&beside) <= breaks(&below) + 1 => {
            start + " " + beside + ";"
        }
        (Some(beside), None) => start + " " + beside + ";",
        // no line is wide enough for the names of what has no room
        (_, below) => start + "\n" + indent + "    " + below.unwrap_or(one_line) + ";",
    }
}

/// Columns that code takes: it is ASCII.
fn width(code: &Annotated) -> usize {
    code.as_str().len()
}

/// The room for an expression.
#[derive(Clone, Copy)]
struct Room {
    /// Columns that are left on its first line, less what must follow it.
    width: usize,
    /// Indentation of the block in which it stands; its further lines are indented by four more.
    indent: usize,
    /// Columns used on its first line.
    used: usize,
}

impl Room {
    /// Behind so many columns.
    fn behind(self, columns: usize) -> Option<Self> {
        let width = self.width.checked_sub(columns)?;
        Some(Self { width, used: self.used + columns, ..self })
    }

    /// With so many columns behind it.
    fn before(self, columns: usize) -> Option<Self> {
        let width = self.width.checked_sub(columns)?;
        Some(Self { width, ..self })
    }

    /// A line of its own, indented by four more, with the same behind it.
    fn next_line(self) -> Option<Self> {
        let behind = WIDTH.saturating_sub(self.used + self.width);
        let indent = self.indent + 4;
        Some(Self { width: (WIDTH - behind).checked_sub(indent)?, indent, used: indent })
    }
}

/// An expression over several lines, if need be: the operands of its outermost operator each on a line of its own, and
/// so on inside those that are still too long. `None` where there is no room for it.
fn broken(syntax: Syntax, expression: &Expression, room: Room) -> Option<Annotated> {
    let one_line = line(syntax, expression);
    if width(&one_line) <= room.width {
        return Some(one_line);
    }
    match expression {
        Expression::Variable(_) | Expression::Zero | Expression::BySign(_) => Some(one_line),
        Expression::Negative(a) => {
            Some(Annotated::default() + "-" + operand(syntax, (a, Position::Negated), room.behind(1)?)?)
        }
        Expression::Binary(operator, ..) => {
            let (first, others) = chain(expression, *operator);
            last_line_broken(syntax, first, &others, operator.sign(), room)
                .or_else(|| all_broken(syntax, first, &others, operator.sign(), room))
        }
    }
}

type Operand<'a> = (&'a Expression, Position);

/// The operands of an operator and of the same operator in its left operand, and so on.
fn chain(expression: &Expression, operator: Operator) -> (Operand<'_>, Vec<Operand<'_>>) {
    let [left, right] = operator.positions();
    let mut others = Vec::new();
    let mut first = expression;
    while let Expression::Binary(same, a, b) = first
        && *same == operator
    {
        others.push((&**b, right));
        first = a;
    }
    others.reverse();
    ((first, left), others)
}

fn operand(syntax: Syntax, (expression, position): Operand<'_>, room: Room) -> Option<Annotated> {
    if !needs_parentheses(syntax, expression, position) {
        return broken(syntax, expression, room);
    }
    broken(syntax, expression, room.behind(1)?.before(1)?).map(in_parentheses)
}

/// All operands on one line, but for what the last one breaks: that is allowed where little stands before it.
fn last_line_broken(
    syntax: Syntax,
    first: Operand<'_>,
    others: &[Operand<'_>],
    sign: char,
    room: Room,
) -> Option<Annotated> {
    let sign = format!(" {sign} ");
    let (last, others) = others.split_last()?;
    let mut text = operand(syntax, first, room)?;
    for other in others {
        text = text + sign.as_str() + operand(syntax, *other, room.next_line()?.behind(2)?)?;
    }
    text = text + sign.as_str();
    if text.as_str().contains('\n') {
        return None;
    }
    let before = width(&text);
    let last = operand(syntax, *last, room.behind(before)?)?;
    let is_broken = last.as_str().contains('\n');
    let first_line = last.as_str().lines().next().unwrap_or_default();
    let fits = before + first_line.len() <= room.width;
    let is_neat = !is_broken || !(last.as_str().starts_with('(') || before > 4);
    (fits && is_neat).then(|| text + last)
}

/// Every operand on a line of its own.
fn all_broken(syntax: Syntax, first: Operand<'_>, others: &[Operand<'_>], sign: char, room: Room) -> Option<Annotated> {
    let mut text = operand(syntax, first, room)?;
    let next = room.next_line()?;
    for other in others {
        // what is shorter than the indentation is no line
        let used = if text.as_str().contains('\n') { 0 } else { room.used };
        let last_line = text.as_str().lines().last().unwrap_or_default();
        if last_line.len() + used <= next.used {
            let beside = room.behind(3 + last_line.trim_start().len());
            if let Some(beside) = beside.and_then(|room| operand(syntax, *other, room)) {
                text = text + format!(" {sign} ") + beside;
                continue;
            }
        }
        let start = format!("\n{}{sign} ", " ".repeat(next.indent));
        text = text + start + operand(syntax, *other, next.behind(2)?)?;
    }
    Some(text)
}
