//! Tests that deeply nested expressions are laid out in linear time, and that a broken statement has the same words as
//! that on a single line.

use fastrand::Rng;
use rne_codegen::{
    Compiler, Contraction, Expression, ExpressionKind, Form, Function, Name, Negated, Operator, Quantity, Value,
    ValueId, Values,
};

use super::LineBreaks;
use crate::annotated::Annotated;
use crate::expression::line;
use crate::syntax::{Precision, Syntax};
use crate::wrap::WIDTH;

const LANGUAGES: [Syntax<'_>; 2] = [Syntax::Rust, Syntax::C { precision: Precision::Double, prefix: "arm" }];

/// Largest number of visits for each part of an expression: one when it is measured, those when it is laid out in two
/// or three rooms, and one when it is written.
const VISITS: usize = 6;

/// Writes a statement, compares it with the same statement on one line, and returns the number of visited parts.
fn visits(syntax: Syntax, expression: Expression<'_>) -> usize {
    let mut breaks = LineBreaks::new(syntax, expression);
    let text = breaks.statement("    ", Annotated::from("let x ="));
    let words = text.as_str().lines().map(str::trim_start).collect::<Vec<_>>().join(" ");
    assert_eq!(words, format!("let x = {};", line(syntax, expression)));
    breaks.measured.visits.get()
}

fn robot(name: &str) -> rne_model::Robot {
    let path = format!("{}/../../tests/nested/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    rne_model::Reader::new(name).read(&std::fs::read(path).unwrap()).unwrap().robot
}

#[test]
fn deeply_nested_code_of_arms_is_written_in_linear_time() {
    let arms = ["nested8", "nested8_scaled", "nested8_alike", "nested9_prismatic", "nested10"];
    let (mut deepest, mut most) = (0, 0);
    for arm in arms {
        let robot = robot(arm);
        let compiler = Compiler::new(&robot);
        for function in [Function::InverseDynamicsDerivatives, Function::ForwardDynamics] {
            let program = compiler.compile(function, Form::Reduced).unwrap();
            for expression in program.expressions() {
                let nodes = expression.parts().count();
                for syntax in LANGUAGES {
                    let visits = visits(syntax, expression);
                    assert!(visits <= VISITS * nodes, "{arm}, {function}: {visits} visits of {nodes} nodes");
                    most = most.max(visits / nodes);
                }
                deepest = deepest.max(depth(expression));
            }
        }
    }
    // otherwise the test does not test deep expressions
    assert!(deepest > 20, "{deepest} levels");
    println!("{deepest} levels, {most} visits of a node");
}

fn depth(expression: Expression<'_>) -> usize {
    1 + match expression.kind() {
        ExpressionKind::Variable(_) | ExpressionKind::Zero => 0,
        ExpressionKind::Negative(a) => depth(a),
        ExpressionKind::Binary(_, a, b) => depth(a).max(depth(b)),
        ExpressionKind::Fused([x, y], z, _) => depth(x).max(depth(y)).max(depth(z)),
        ExpressionKind::BySign(operands) => operands.into_iter().map(depth).max().unwrap_or(0),
    }
}

/// Returns a random expression of `levels` levels; at each level, one operand goes deeper and the others are small.
fn random(rng: &mut Rng, levels: usize, values: &mut Values) -> ValueId {
    let name = |rng: &mut Rng, values: &mut Values| {
        let quantity = [Quantity::Mass, Quantity::Position, Quantity::Omega, Quantity::JointMoment][rng.usize(..4)];
        values.push(Some(Name::scalar(quantity, [1, 7, 10, 1_000_000][rng.usize(..4)])), Value::Argument)
    };
    if levels == 0 {
        return if rng.usize(..20) == 0 { values.push(None, Value::Constant(0.0)) } else { name(rng, values) };
    }
    let deep = random(rng, levels - 1, values);
    if rng.usize(..8) == 0 {
        return values.push(None, Value::Negative(deep));
    }
    if rng.usize(..40) == 0 {
        let operands = [name(rng, values), deep, name(rng, values)];
        return values.push(None, Value::BySign(operands));
    }
    let operator = [Operator::Sum, Operator::Difference, Operator::Product, Operator::Quotient][rng.usize(..4)];
    let size = rng.usize(..3);
    let small = random(rng, size.min(levels - 1), values);
    let (a, b) = if rng.bool() { (deep, small) } else { (small, deep) };
    if rng.usize(..20) == 0 {
        let negated = [None, Some(Negated::Factor), Some(Negated::Addend)][rng.usize(..3)];
        let addend = name(rng, values);
        return values.push(None, Value::Fused(Contraction { factors: [a, b], addend, negated }));
    }
    values.push(None, Value::Binary(operator, a, b))
}

#[test]
fn random_expressions_of_any_depth_are_written_in_linear_time() {
    let mut rng = Rng::with_seed(12);
    for _ in 0..500 {
        let levels = rng.usize(1..200);
        let mut values = Values::default();
        let root = random(&mut rng, levels, &mut values);
        let expression = values.used(root);
        let nodes = expression.parts().count();
        for syntax in LANGUAGES {
            let visits = visits(syntax, expression);
            assert!(visits <= VISITS * nodes, "{visits} visits of {nodes} nodes: {}", line(syntax, expression));
        }
    }
}

#[test]
fn the_lines_of_a_statement_are_as_wide_as_code_may_be() {
    let mut rng = Rng::with_seed(7);
    let mut broken = 0;
    for _ in 0..500 {
        let levels = rng.usize(1..12);
        let mut values = Values::default();
        let root = random(&mut rng, levels, &mut values);
        let expression = values.used(root);
        for syntax in LANGUAGES {
            let text = LineBreaks::new(syntax, expression).statement("    ", Annotated::from("let x ="));
            broken += usize::from(text.as_str().contains('\n'));
            // a call is never broken, so its line may be too long
            let widest = text
                .as_str()
                .lines()
                .filter(|line| !line.contains("by_sign") && !line.contains("fma") && !line.contains("mul_add"))
                .map(str::len)
                .max();
            assert!(widest.is_none_or(|widest| widest <= WIDTH), "{text}");
        }
    }
    assert!(broken > 200, "{broken} of 1000 statements have several lines");
}
