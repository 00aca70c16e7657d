//! The text of an expression: where it needs parentheses, and how wide its parts are.

use std::cell::Cell;

use rne_codegen::{Expression, ExpressionKind, Negated, Operator};

use super::annotated::{Annotated, Part};
use super::syntax::Syntax;

/// The position of an operand in an expression.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Position {
    /// Left operand of + or -.
    Summand,
    /// Right operand of + or -.
    RightSummand,
    /// Left operand of · or /.
    Factor,
    /// Right operand of · or /.
    RightFactor,
    /// After a unary minus.
    Negated,
}

/// The way in which an operator is written.
pub(super) trait Infix {
    /// Returns the character of the operator in Rust and C.
    fn sign(self) -> char;
    /// Returns the sign with a blank on each side.
    fn between_blanks(self) -> &'static str;
    /// Returns the positions of the two operands.
    fn positions(self) -> [Position; 2];
}

impl Infix for Operator {
    fn sign(self) -> char {
        match self {
            Self::Sum => '+',
            Self::Difference => '-',
            Self::Product => '*',
            Self::Quotient => '/',
        }
    }

    fn between_blanks(self) -> &'static str {
        match self {
            Self::Sum => " + ",
            Self::Difference => " - ",
            Self::Product => " * ",
            Self::Quotient => " / ",
        }
    }

    fn positions(self) -> [Position; 2] {
        match self {
            Self::Sum | Self::Difference => [Position::Summand, Position::RightSummand],
            Self::Product | Self::Quotient => [Position::Factor, Position::RightFactor],
        }
    }
}

/// Whether an operand needs parentheses. A right operand keeps them even if mathematics would not need them, because
/// floating-point sums and products are computed in the order in which they are written.
pub(super) fn needs_parentheses(syntax: Syntax, operand: Expression<'_>, position: Position) -> bool {
    match operand.kind() {
        ExpressionKind::Variable(_) | ExpressionKind::Zero | ExpressionKind::Fused(..) | ExpressionKind::BySign(_) => {
            false
        }
        ExpressionKind::Binary(Operator::Product | Operator::Quotient, ..) => match position {
            Position::Summand | Position::RightSummand => syntax.groups_products(),
            Position::Factor => false,
            Position::RightFactor | Position::Negated => true,
        },
        ExpressionKind::Negative(_) | ExpressionKind::Binary(..) => position != Position::Summand,
    }
}

/// Returns the expression on one line.
pub(super) fn line(syntax: Syntax, expression: Expression<'_>) -> Annotated {
    let measured = Measured::new(syntax, expression);
    let mut text = Annotated::default();
    measured.write(measured.whole(), &mut text);
    text
}

/// An expression in a language, with the width of each part: so no part has to be written only to be measured.
#[derive(Default)]
pub(super) struct Measured {
    /// The parts. An operand comes before the part that uses it, so the last part is the whole expression.
    parts: Vec<Measure>,
    /// Number of times that a part was read to be measured, laid out or written.
    pub(super) visits: Cell<usize>,
}

/// A part of an expression, with its width for the decision on line breaks.
pub(super) struct Measure {
    /// The number of columns that it takes on one line. Code is ASCII.
    pub(super) width: usize,
    /// Whether the text of the part begins with a parenthesis.
    pub(super) opens: bool,
    pub(super) kind: Kind,
}

/// The kind of a part of an expression.
pub(super) enum Kind {
    /// A name, a number or zero.
    Word(Annotated),
    Negative(Operand),
    /// Two or more operands of one operator, computed from left to right.
    Chain(Operator, Vec<Operand>),
    /// The name of a function, and its arguments.
    Call(String, Vec<usize>),
}

/// An operand, by its index among the parts.
#[derive(Clone, Copy)]
pub(super) struct Operand {
    pub(super) part: usize,
    pub(super) in_parentheses: bool,
}

impl Measured {
    pub(super) fn new(syntax: Syntax, expression: Expression<'_>) -> Self {
        let mut measured = Self::default();
        measured.add(syntax, expression);
        measured
    }

    /// Returns the index of the part that is the whole expression.
    pub(super) fn whole(&self) -> usize {
        self.parts.len() - 1
    }

    /// Returns a part and counts this visit.
    pub(super) fn visit(&self, part: usize) -> &Measure {
        self.visits.set(self.visits.get() + 1);
        &self.parts[part]
    }

    /// Returns the number of columns of an operand on one line, with its parentheses.
    pub(super) fn width(&self, operand: Operand) -> usize {
        self.parts[operand.part].width + if operand.in_parentheses { 2 } else { 0 }
    }

    /// Whether an operand begins with a parenthesis.
    pub(super) fn opens(&self, operand: Operand) -> bool {
        operand.in_parentheses || self.parts[operand.part].opens
    }

    fn add(&mut self, syntax: Syntax, expression: Expression<'_>) -> usize {
        self.visits.set(self.visits.get() + 1);
        let word = |word: Annotated| (word.as_str().len(), false, Kind::Word(word));
        let (width, opens, kind) = match expression.kind() {
            ExpressionKind::Variable(name) => word(name.into()),
            ExpressionKind::Zero => word(Annotated::part(Part::Number, syntax.zero())),
            ExpressionKind::Negative(a) => return self.negative(syntax, a),
            ExpressionKind::Binary(operator, ..) => {
                let operands = self.chain(syntax, expression, operator);
                let widths: usize = operands.iter().map(|operand| self.width(*operand)).sum();
                let between = operator.between_blanks().len() * (operands.len() - 1);
                let opens = operands.first().is_some_and(|first| self.opens(*first));
                (widths + between, opens, Kind::Chain(operator, operands))
            }
            ExpressionKind::Fused([x, y], z, negated) => {
                let x = if negated == Some(Negated::Factor) { self.negative(syntax, x) } else { self.add(syntax, x) };
                let y = self.add(syntax, y);
                let z = if negated == Some(Negated::Addend) { self.negative(syntax, z) } else { self.add(syntax, z) };
                return self.call(syntax.mul_add(), vec![x, y, z]);
            }
            ExpressionKind::BySign(operands) => {
                let arguments = operands.map(|operand| self.add(syntax, operand)).to_vec();
                return self.call(syntax.by_sign(), arguments);
            }
        };
        self.push(width, opens, kind)
    }

    fn push(&mut self, width: usize, opens: bool, kind: Kind) -> usize {
        self.parts.push(Measure { width, opens, kind });
        self.parts.len() - 1
    }

    fn negative(&mut self, syntax: Syntax, of: Expression<'_>) -> usize {
        let operand = self.operand(syntax, of, Position::Negated);
        self.push(1 + self.width(operand), false, Kind::Negative(operand))
    }

    fn call(&mut self, name: String, arguments: Vec<usize>) -> usize {
        let widths: usize = arguments.iter().map(|argument| self.parts[*argument].width).sum();
        let width = name.len() + "()".len() + widths + ", ".len() * (arguments.len() - 1);
        self.push(width, false, Kind::Call(name, arguments))
    }

    fn operand(&mut self, syntax: Syntax, expression: Expression<'_>, position: Position) -> Operand {
        let in_parentheses = needs_parentheses(syntax, expression, position);
        Operand { part: self.add(syntax, expression), in_parentheses }
    }

    /// Returns the operands of an operator; if the left operand has the same operator, its operands are included, and
    /// so on.
    fn chain(&mut self, syntax: Syntax, expression: Expression<'_>, operator: Operator) -> Vec<Operand> {
        let [left, right] = operator.positions();
        let mut others = Vec::new();
        let mut first = expression;
        while let ExpressionKind::Binary(same, a, b) = first.kind()
            && same == operator
        {
            others.push(b);
            first = a;
        }
        let mut operands = vec![self.operand(syntax, first, left)];
        operands.extend(others.into_iter().rev().map(|other| self.operand(syntax, other, right)));
        operands
    }

    /// Writes a part on one line, after the text that is already written.
    pub(super) fn write(&self, part: usize, text: &mut Annotated) {
        match &self.visit(part).kind {
            Kind::Word(word) => text.push(word),
            Kind::Negative(operand) => {
                text.push_str("-");
                self.write_operand(*operand, text);
            }
            Kind::Chain(operator, operands) => {
                for (index, operand) in operands.iter().enumerate() {
                    text.push_str(if index > 0 { operator.between_blanks() } else { "" });
                    self.write_operand(*operand, text);
                }
            }
            Kind::Call(name, arguments) => {
                text.push_str(name);
                text.push_str("(");
                for (index, argument) in arguments.iter().enumerate() {
                    text.push_str(if index > 0 { ", " } else { "" });
                    self.write(*argument, text);
                }
                text.push_str(")");
            }
        }
    }

    fn write_operand(&self, operand: Operand, text: &mut Annotated) {
        text.push_str(if operand.in_parentheses { "(" } else { "" });
        self.write(operand.part, text);
        text.push_str(if operand.in_parentheses { ")" } else { "" });
    }
}
