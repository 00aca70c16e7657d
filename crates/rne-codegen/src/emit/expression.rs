//! How an expression is written: where parentheses stand and where a long line breaks.

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
pub(super) fn needs_parentheses(operand: &Expression, position: Position) -> bool {
    use Expression::{BySign, Difference, Negative, Product, Quotient, Sum, Variable, Zero};
    match operand {
        Variable(_) | Zero | BySign(..) => false,
        Negative(_) | Sum(..) | Difference(..) => position != Position::Summand,
        Product(..) | Quotient(..) => matches!(position, Position::RightFactor | Position::Negated),
    }
}

/// The expression on one line.
pub(super) fn line(expression: &Expression) -> String {
    let operand = |operand: &Expression, position| {
        let text = line(operand);
        if needs_parentheses(operand, position) { format!("({text})") } else { text }
    };
    match expression {
        Expression::Variable(name) => name.to_string(),
        Expression::Zero => "zero".to_owned(),
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
            format!("Scalar::by_sign({}, {}, {})", line(x), line(positive), line(negative))
        }
    }
}

/// `let NAME = EXPRESSION;`, broken before + and - where it is too long, as rustfmt does.
pub(super) fn let_statement(indent: &str, name: &str, expression: &Expression) -> String {
    let start = format!("{indent}let {name} = ");
    let one_line = format!("{start}{};", line(expression));
    if one_line.chars().count() <= WIDTH {
        return one_line;
    }
    let beside = broken(expression, indent, start.chars().count());
    let next_line = format!("{indent}    {};", line(expression));
    let below = if next_line.chars().count() <= WIDTH {
        line(expression)
    } else {
        broken(expression, &format!("{indent}    "), indent.len() + 4)
    };
    let breaks = |text: &str| text.matches('\n').count();
    if breaks(&below) == 0 || breaks(&beside) > breaks(&below) + 1 {
        return format!("{}\n{indent}    {below};", start.trim_end());
    }
    format!("{start}{beside};")
}

/// An expression over several lines: the summands of its outermost operator each on a line of its own, and so on inside
/// the first of them where that is still too long.
fn broken(expression: &Expression, indent: &str, start: usize) -> String {
    let adds = matches!(expression, Expression::Sum(..));
    let mut summands = Vec::new();
    let mut first = expression;
    loop {
        let (operand, sign) = match first {
            Expression::Sum(a, b) if adds => {
                first = a;
                (b, '+')
            }
            Expression::Difference(a, b) if !adds => {
                first = a;
                (b, '-')
            }
            _ => break,
        };
        let inner = format!("{indent}    ");
        let text = match line(operand) {
            text if !needs_parentheses(operand, Position::RightSummand) => text,
            // sign, space, parentheses and the end of the statement
            text if inner.len() + text.chars().count() + 5 <= WIDTH => format!("({text})"),
            _ => format!("({})", broken(operand, &inner, inner.len() + 3)),
        };
        summands.push(format!("\n{inner}{sign} {text}"));
    }
    summands.reverse();
    let one_line = line(first);
    let breaks = matches!(first, Expression::Sum(..) | Expression::Difference(..));
    let first =
        // one column is for the semicolon, wherever it stands
        if breaks && start + one_line.chars().count() >= WIDTH { broken(first, indent, start) } else { one_line };
    first + &summands.concat()
}
