//! How an expression is written: where parentheses stand and where a long line breaks.

use std::fmt::Write;

use super::syntax::Syntax;
use crate::program::Expression;

/// Width of a line of emitted code, rustfmt's default.
const WIDTH: usize = 100;

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

/// Whether an operand needs parentheses. A right operand keeps them even where mathematics would not: floating-point
/// sums and products are computed in the order in which they are written.
pub(super) fn needs_parentheses(syntax: Syntax, operand: &Expression, position: Position) -> bool {
    use Expression::{BySign, Difference, Negative, Product, Quotient, Sum, Variable, Zero};
    match operand {
        Variable(_) | Zero | BySign(..) => false,
        Negative(_) | Sum(..) | Difference(..) => position != Position::Summand,
        Product(..) | Quotient(..) => match position {
            Position::Summand | Position::RightSummand => syntax.groups_products(),
            Position::Factor => false,
            Position::RightFactor | Position::Negated => true,
        },
    }
}

/// The expression on one line.
pub(super) fn line(syntax: Syntax, expression: &Expression) -> String {
    let operand = |operand: &Expression, position| {
        let text = line(syntax, operand);
        if needs_parentheses(syntax, operand, position) { format!("({text})") } else { text }
    };
    match expression {
        Expression::Variable(name) => name.to_string(),
        Expression::Zero => syntax.zero().to_owned(),
        Expression::Negative(a) => format!("-{}", operand(a, Position::Negated)),
        Expression::Sum(a, b) => format!("{} + {}", operand(a, Position::Summand), operand(b, Position::RightSummand)),
        Expression::Difference(a, b) => {
            format!("{} - {}", operand(a, Position::Summand), operand(b, Position::RightSummand))
        }
        Expression::Product(a, b) => {
            format!("{} * {}", operand(a, Position::Factor), operand(b, Position::RightFactor))
        }
        Expression::Quotient(a, b) => {
            format!("{} / {}", operand(a, Position::Factor), operand(b, Position::RightFactor))
        }
        Expression::BySign(x, positive, negative) => {
            let [x, positive, negative] = [x, positive, negative].map(|argument| line(syntax, argument));
            format!("{}({x}, {positive}, {negative})", syntax.by_sign())
        }
    }
}

/// `START EXPRESSION;`, where the start is `let NAME =` or the like, broken where it is too long, as rustfmt does.
pub(super) fn statement(syntax: Syntax, indent: &str, start: &str, expression: &Expression) -> String {
    let start = format!("{indent}{start} ");
    let one_line = format!("{start}{};", line(syntax, expression));
    if one_line.chars().count() <= WIDTH {
        return one_line;
    }
    // one column is for the semicolon, wherever it stands
    let room = |used: usize| (WIDTH - 1).saturating_sub(used);
    let used = start.chars().count();
    let beside = Room { width: room(used), indent: indent.len(), used };
    let below = indent.len() + 4;
    let below = Room { width: room(below), indent: below, used: below };
    let next_line = |text: &str| format!("{}\n{indent}    {text};", start.trim_end());
    let breaks = |text: &str| text.matches('\n').count();
    match (broken(syntax, expression, beside), broken(syntax, expression, below)) {
        (Some(beside), Some(below)) if breaks(&below) > 0 && breaks(&beside) <= breaks(&below) + 1 => {
            format!("{start}{beside};")
        }
        (_, Some(below)) => next_line(&below),
        (Some(beside), None) => format!("{start}{beside};"),
        // no line is wide enough for its names
        (None, None) => next_line(&line(syntax, expression)),
    }
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
fn broken(syntax: Syntax, expression: &Expression, room: Room) -> Option<String> {
    let one_line = line(syntax, expression);
    if one_line.chars().count() <= room.width {
        return Some(one_line);
    }
    match expression {
        Expression::Variable(_) | Expression::Zero | Expression::BySign(..) => Some(one_line),
        Expression::Negative(a) => Some(format!("-{}", operand(syntax, a, Position::Negated, room.behind(1)?)?)),
        Expression::Sum(..) | Expression::Difference(..) | Expression::Product(..) | Expression::Quotient(..) => {
            let (first, others, sign) = chain(expression);
            last_line_broken(syntax, first, &others, sign, room)
                .or_else(|| all_broken(syntax, first, &others, sign, room))
        }
    }
}

type Operand<'a> = (&'a Expression, Position);

/// The operands of an operator and of the same operator in its left operand, and so on.
fn chain(expression: &Expression) -> (Operand<'_>, Vec<Operand<'_>>, char) {
    use Expression::{Difference, Product, Quotient, Sum};
    let (sign, left, right) = match expression {
        Sum(..) => ('+', Position::Summand, Position::RightSummand),
        Difference(..) => ('-', Position::Summand, Position::RightSummand),
        Quotient(..) => ('/', Position::Factor, Position::RightFactor),
        _ => ('*', Position::Factor, Position::RightFactor),
    };
    let mut others = Vec::new();
    let mut first = expression;
    while let (Sum(a, b), '+') | (Difference(a, b), '-') | (Product(a, b), '*') | (Quotient(a, b), '/') = (first, sign)
    {
        others.push((&**b, right));
        first = a;
    }
    others.reverse();
    ((first, left), others, sign)
}

fn operand(syntax: Syntax, expression: &Expression, position: Position, room: Room) -> Option<String> {
    if !needs_parentheses(syntax, expression, position) {
        return broken(syntax, expression, room);
    }
    Some(format!("({})", broken(syntax, expression, room.behind(1)?.before(1)?)?))
}

/// All operands on one line, but for what the last one breaks: that is allowed where little stands before it.
fn last_line_broken(
    syntax: Syntax,
    first: Operand<'_>,
    others: &[Operand<'_>],
    sign: char,
    room: Room,
) -> Option<String> {
    let (last, others) = others.split_last()?;
    let mut text = operand(syntax, first.0, first.1, room)?;
    for (expression, position) in others {
        let _ = write!(text, " {sign} {}", operand(syntax, expression, *position, room.next_line()?.behind(2)?)?);
    }
    let _ = write!(text, " {sign} ");
    if text.contains('\n') {
        return None;
    }
    let before = text.chars().count();
    let last = operand(syntax, last.0, last.1, room.behind(before)?)?;
    let first_line = last.lines().next().unwrap_or_default();
    let fits = before + first_line.chars().count() <= room.width;
    let is_neat = !last.contains('\n') || !(last.starts_with('(') || before > 4);
    (fits && is_neat).then(|| text + &last)
}

/// Every operand on a line of its own.
fn all_broken(syntax: Syntax, first: Operand<'_>, others: &[Operand<'_>], sign: char, room: Room) -> Option<String> {
    let mut text = operand(syntax, first.0, first.1, room)?;
    let next = room.next_line()?;
    for (expression, position) in others {
        // what is shorter than the indentation is no line
        let used = if text.contains('\n') { 0 } else { room.used };
        let last_line = text.lines().last().unwrap_or_default();
        if last_line.chars().count() + used <= next.used {
            let beside = room.behind(3 + last_line.trim_start().chars().count());
            if let Some(beside) = beside.and_then(|room| operand(syntax, expression, *position, room)) {
                let _ = write!(text, " {sign} {beside}");
                continue;
            }
        }
        let _ = write!(
            text,
            "\n{}{sign} {}",
            " ".repeat(next.indent),
            operand(syntax, expression, *position, next.behind(2)?)?
        );
    }
    Some(text)
}
