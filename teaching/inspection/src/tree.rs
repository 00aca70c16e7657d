//! Formulas as trees that other programs can walk, and as text.

use std::fmt::Write as _;

use rne_codegen::{Expression, ExpressionKind, Fold, Negated, Operator, Sign, Term};
use serde::ser::{Serialize, SerializeSeq, Serializer};

/// A formula. In JSON a name is a string, a number a number, and everything else an array with the operator first:
/// `["+", "a", ["*", "b", 2.0]]`. Operators: `+ - * /` with two operands; `neg`, `sin`, `cos` with one; `sign` with
/// three (the second where the first is positive, the third where it is negative, else 0). If an operation was folded,
/// an object after its operands describes the result.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// A name.
    Name(String),
    /// A number.
    Number(f64),
    /// An operator and its operands.
    Node(&'static str, Vec<Tree>, Option<Mark>),
}

/// The result of folding an operation.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Mark {
    /// The kind of result: `kept`, `zero`, `one`, `constant`, `cancelled`, `shared` or `unused`.
    pub fold: &'static str,
    /// The reason, as an index into [`Inspection::reasons`](crate::Inspection::reasons), from 0; absent if the arm is
    /// not the reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<usize>,
    /// The name of the value in the code, with a minus sign if the name has the negative value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

impl Serialize for Tree {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Name(name) => serializer.serialize_str(name),
            Self::Number(value) => serializer.serialize_f64(*value),
            Self::Node(operator, operands, mark) => {
                let mut array = serializer.serialize_seq(None)?;
                array.serialize_element(operator)?;
                operands.iter().try_for_each(|operand| array.serialize_element(operand))?;
                mark.iter().try_for_each(|mark| array.serialize_element(mark))?;
                array.end()
            }
        }
    }
}

const fn sign(operator: Operator) -> &'static str {
    match operator {
        Operator::Sum => "+",
        Operator::Difference => "-",
        Operator::Product => "*",
        Operator::Quotient => "/",
    }
}

const fn word(fold: Fold) -> &'static str {
    match fold {
        Fold::Kept => "kept",
        Fold::Zero(_) => "zero",
        Fold::One(_) => "one",
        Fold::Constant => "constant",
        Fold::Cancelled => "cancelled",
        Fold::Shared => "shared",
        Fold::Unused => "unused",
    }
}

impl Tree {
    /// Makes the tree of a formula before folding. `why` returns the index of the reason for a zero (0) or a one (1)
    /// from its causes.
    pub(crate) fn of_term(term: &Term, why: &mut impl FnMut(&rne_codegen::Causes, u8) -> usize) -> Self {
        match term {
            Term::Variable(name) => Self::Name(name.to_string()),
            Term::Number(value, _) => Self::Number(*value),
            Term::Negative(a) => Self::Node("neg", vec![Self::of_term(a, why)], None),
            Term::Sine(a) => Self::Node("sin", vec![Self::of_term(a, why)], None),
            Term::Cosine(a) => Self::Node("cos", vec![Self::of_term(a, why)], None),
            Term::BySign(operands) => {
                Self::Node("sign", operands.iter().map(|operand| Self::of_term(operand, why)).collect(), None)
            }
            Term::Operation(operation) => {
                let magnitude = u8::from(matches!(operation.fold, Fold::One(_)));
                let mark = Mark {
                    fold: word(operation.fold),
                    why: operation.causes.as_ref().map(|causes| why(causes, magnitude)),
                    name: operation.name.map(|(name, sign)| signed(name.to_string(), sign)),
                };
                // a mark that only says `kept` is left out
                let mark = (mark.fold != "kept" || mark.name.is_some()).then_some(mark);
                let operands = operation.operands.iter().map(|operand| Self::of_term(operand, why)).collect();
                Self::Node(sign(operation.operator), operands, mark)
            }
        }
    }

    /// Makes the tree of a statement of the code.
    pub(crate) fn of_expression(expression: Expression<'_>) -> Self {
        let node = |operator, operands| Self::Node(operator, operands, None);
        match expression.kind() {
            ExpressionKind::Variable(name) => Self::Name(name.to_string()),
            ExpressionKind::Zero => Self::Number(0.0),
            ExpressionKind::Negative(a) => node("neg", vec![Self::of_expression(a)]),
            ExpressionKind::Binary(operator, a, b) => node(sign(operator), [a, b].map(Self::of_expression).to_vec()),
            ExpressionKind::Fused(factors, addend, negated) => {
                let (product, addend) =
                    (node("*", factors.map(Self::of_expression).to_vec()), Self::of_expression(addend));
                match negated {
                    None => node("+", vec![addend, product]),
                    Some(Negated::Factor) => node("-", vec![addend, product]),
                    Some(Negated::Addend) => node("-", vec![product, addend]),
                }
            }
            ExpressionKind::BySign(operands) => node("sign", operands.map(Self::of_expression).to_vec()),
        }
    }

    /// Replaces names by other trees.
    #[must_use]
    pub fn map_names(&self, of: &impl Fn(&str) -> Self) -> Self {
        match self {
            Self::Name(name) => of(name),
            Self::Number(_) => self.clone(),
            Self::Node(operator, operands, mark) => {
                let operands = operands.iter().map(|operand| operand.map_names(of)).collect();
                Self::Node(operator, operands, mark.clone())
            }
        }
    }

    /// Folds products of 0 and 1, sums with 0, and two signs in a row.
    #[must_use]
    pub(crate) fn folded(&self) -> Self {
        let Self::Node(operator, operands, _) = self else { return self.clone() };
        let operands: Vec<Self> = operands.iter().map(Self::folded).collect();
        let negative = |of: &Self| match of {
            Self::Number(value) => Self::Number(if *value == 0.0 { 0.0 } else { -value }),
            Self::Node("neg", inner, _) if inner.len() == 1 => inner[0].clone(),
            of => Self::Node("neg", vec![of.clone()], None),
        };
        match (*operator, operands.as_slice()) {
            ("*", [Self::Number(0.0), _] | [_, Self::Number(0.0)]) => Self::Number(0.0),
            ("*", [Self::Number(a), Self::Number(b)]) => Self::Number(a * b),
            ("+", [Self::Number(a), Self::Number(b)]) => Self::Number(a + b),
            ("-", [Self::Number(a), Self::Number(b)]) => Self::Number(a - b),
            ("*", [Self::Number(1.0), a] | [a, Self::Number(1.0)])
            | ("+", [Self::Number(0.0), a] | [a, Self::Number(0.0)])
            | ("-", [a, Self::Number(0.0)]) => a.clone(),
            ("neg", [a]) | ("*", [Self::Number(-1.0), a] | [a, Self::Number(-1.0)]) | ("-", [Self::Number(0.0), a]) => {
                negative(a)
            }
            _ => Self::Node(operator, operands, None),
        }
    }

    /// Returns the number of operations.
    #[must_use]
    pub fn size(&self) -> usize {
        match self {
            Self::Name(_) | Self::Number(_) => 0,
            Self::Node(_, operands, _) => 1 + operands.iter().map(Self::size).sum::<usize>(),
        }
    }

    /// Returns the names in the tree from left to right, each as often as it occurs.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Name(name) => vec![name],
            Self::Number(_) => Vec::new(),
            Self::Node(_, operands, _) => operands.iter().flat_map(Self::names).collect(),
        }
    }

    /// Returns the value of the tree; `of` returns the values of names.
    pub fn evaluate(&self, of: &impl Fn(&str) -> f64) -> f64 {
        match self {
            Self::Name(name) => of(name),
            Self::Number(value) => *value,
            Self::Node(operator, operands, _) => {
                let value = |index: usize| operands.get(index).map_or(f64::NAN, |operand| operand.evaluate(of));
                match *operator {
                    "+" => value(0) + value(1),
                    "-" => value(0) - value(1),
                    "*" => value(0) * value(1),
                    "/" => value(0) / value(1),
                    "neg" => -value(0),
                    "sin" => value(0).sin(),
                    "cos" => value(0).cos(),
                    _ if value(0) > 0.0 => value(1),
                    _ if value(0) < 0.0 => value(2),
                    _ => 0.0,
                }
            }
        }
    }

    /// Returns the precedence of the operator; sums have the lowest.
    fn rank(&self) -> u8 {
        match self {
            Self::Node("+" | "-" | "neg", ..) => 0,
            Self::Node("*" | "/", ..) => 1,
            Self::Number(value) if value.is_sign_negative() => 0,
            _ => 2,
        }
    }

    fn write(&self, text: &mut String) {
        let inner = |operand: &Self, least: u8, text: &mut String| {
            if operand.rank() < least {
                text.push('(');
                operand.write(text);
                text.push(')');
            } else {
                operand.write(text);
            }
        };
        match self {
            Self::Name(name) => text.push_str(name),
            Self::Number(value) => {
                let _ = write!(text, "{value}");
            }
            Self::Node(operator @ ("+" | "-" | "*" | "/"), operands, _) => {
                let (rank, is_sum) = (self.rank(), *operator == "+");
                if let [a, b] = &operands[..] {
                    // an operand with a sign needs no parentheses at the beginning of a sum
                    let begins =
                        if matches!(a, Self::Node("neg", ..) | Self::Number(_)) && rank == 0 { 0 } else { rank };
                    inner(a, begins, text);
                    let _ = write!(text, " {operator} ");
                    // a right operand of the same rank needs parentheses, to keep the order of computation
                    let least = if is_sum && matches!(b, Self::Node("*" | "/", ..)) { 1 } else { rank + 1 };
                    inner(b, least, text);
                }
            }
            Self::Node("neg", operands, _) => {
                text.push('-');
                if let Some(a) = operands.first() {
                    inner(a, 2, text);
                }
            }
            Self::Node(function, operands, _) => {
                text.push_str(function);
                text.push('(');
                for (index, operand) in operands.iter().enumerate() {
                    text.push_str(if index > 0 { ", " } else { "" });
                    operand.write(text);
                }
                text.push(')');
            }
        }
    }
}

impl std::fmt::Display for Tree {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = String::new();
        self.write(&mut text);
        f.write_str(&text)
    }
}

/// Returns a name, with a minus sign for the negative.
pub(crate) fn signed(name: String, sign: Sign) -> String {
    if sign == Sign::Minus { format!("-{name}") } else { name }
}
