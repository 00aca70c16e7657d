//! A program as Rust tokens.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{ToTokens, quote};

use super::expression::{Position, needs_parentheses};
use super::signature::{ArgumentArray, arguments};
use crate::program::{Expression, Program, Statement};
use crate::quantity::Name;

/// The body of a program's function: everything between its braces.
///
/// The arguments `q`, `qd`, `qdd`, `force`, `moment` (those that the function has) are references to arrays of the type
/// `T`; `scalar` is the path of the trait that gives `T` its `from_f64`, `sin_cos` and `sin_cos_array`.
#[must_use]
pub fn body(program: &Program, scalar: &TokenStream) -> TokenStream {
    written(program, scalar, &|expression| expression.to_token_stream())
}

/// As [`body`], with the scalar's `mul_add` wherever a product is added: one instruction on a target that has it, product
/// and sum on any other. Results differ in the last digits from target to target, so the seven steps are not written so.
#[must_use]
pub fn fused_body(program: &Program, scalar: &TokenStream) -> TokenStream {
    written(program, scalar, &|expression| fused(expression, scalar))
}

/// An expression with fused products.
fn fused(expression: &Expression, scalar: &TokenStream) -> TokenStream {
    use Expression::{Difference, Negative, Product, Sum, Variable, Zero};
    let inner = |expression: &Expression| fused(expression, scalar);
    let operand = |operand: &Expression, position| {
        let tokens = inner(operand);
        let is_call = matches!(operand, Sum(a, b) | Difference(a, b) if is_product(a) || is_product(b));
        if !is_call && needs_parentheses(operand, position) { quote!((#tokens)) } else { tokens }
    };
    let mul_add = |x: TokenStream, y: &Expression, z: TokenStream| {
        let y = inner(y);
        quote!(#scalar::mul_add(#x, #y, #z))
    };
    let minus = |expression: &Expression| {
        let tokens = operand(expression, Position::Negated);
        quote!(-#tokens)
    };
    match expression {
        Variable(_) | Zero => expression.to_token_stream(),
        Negative(a) => minus(a),
        Sum(a, b) => match (&**a, &**b) {
            (a, Product(x, y)) | (Product(x, y), a) => mul_add(inner(x), y, inner(a)),
            (a, b) => {
                let (a, b) = (operand(a, Position::Summand), operand(b, Position::RightSummand));
                quote!(#a + #b)
            }
        },
        Difference(a, b) => match (&**a, &**b) {
            (a, Product(x, y)) => mul_add(minus(x), y, inner(a)),
            (Product(x, y), b) => mul_add(inner(x), y, minus(b)),
            (a, b) => {
                let (a, b) = (operand(a, Position::Summand), operand(b, Position::RightSummand));
                quote!(#a - #b)
            }
        },
        Product(a, b) => {
            let (a, b) = (operand(a, Position::Factor), operand(b, Position::RightFactor));
            quote!(#a * #b)
        }
    }
}

fn is_product(expression: &Expression) -> bool {
    matches!(expression, Expression::Product(..))
}

fn written(program: &Program, scalar: &TokenStream, expression: &dyn Fn(&Expression) -> TokenStream) -> TokenStream {
    let arguments = arguments(program).into_iter().map(|ArgumentArray { name, elements }| {
        let array = ident(name);
        if elements.iter().all(Option::is_none) {
            return quote!(let _ = #array;);
        }
        let elements = elements.iter().map(|name| name.map_or_else(|| quote!(_), |name| name.to_token_stream()));
        quote!(let [#(#elements),*] = *#array;)
    });
    let zero = program.returns_zero().then(|| {
        let zero = literal(0.0);
        quote!(let zero: T = #scalar::from_f64(#zero);)
    });
    let constants = program.constants.iter().map(|constant| {
        let (name, value) = (constant.name, literal(constant.value));
        quote!(let #name: T = #scalar::from_f64(#value);)
    });
    let statement = |Statement { name, value, .. }: &Statement| {
        let value = expression(value);
        quote!(let #name = #value;)
    };
    let angles = program.angles.iter().map(statement);
    let turns = turns(program, scalar);
    let statements = program.statements.iter().map(statement);
    let outputs = program.outputs.iter().map(|output| expression(&output.value));
    quote! {
        #(#arguments)*
        #zero
        #(#constants)*
        #(#angles)*
        #turns
        #(#statements)*
        [#(#outputs),*]
    }
}

/// The sines and cosines, all at once.
fn turns(program: &Program, scalar: &TokenStream) -> TokenStream {
    let name = |name: Option<Name>| name.map_or_else(|| quote!(_), |name| name.to_token_stream());
    let sines = program.turns.iter().map(|turn| name(turn.sine));
    let cosines = program.turns.iter().map(|turn| name(turn.cosine));
    let angles = program.turns.iter().map(|turn| &turn.angle);
    match program.turns.len() {
        0 => TokenStream::new(),
        1 => quote!(let (#(#sines)*, #(#cosines)*) = #scalar::sin_cos(#(#angles)*);),
        _ => quote!(let ([#(#sines),*], [#(#cosines),*]) = #scalar::sin_cos_array([#(#angles),*]);),
    }
}

/// A number as a literal that reads back as the same bits; negative numbers as a minus and a literal, as in source text.
fn literal(value: f64) -> TokenStream {
    let text = format!("{:?}", value.abs());
    let magnitude = text.parse().unwrap_or_else(|_| Literal::f64_unsuffixed(value.abs()));
    if value < 0.0 { quote!(-#magnitude) } else { quote!(#magnitude) }
}

fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

impl ToTokens for Name {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        ident(&self.to_string()).to_tokens(tokens);
    }
}

impl ToTokens for Expression {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let operand = |operand: &Self, position| {
            if needs_parentheses(operand, position) { quote!((#operand)) } else { quote!(#operand) }
        };
        let stream = match self {
            Self::Variable(name) => quote!(#name),
            Self::Zero => quote!(zero),
            Self::Negative(a) => {
                let a = operand(a, Position::Negated);
                quote!(-#a)
            }
            Self::Sum(a, b) => {
                let (a, b) = (operand(a, Position::Summand), operand(b, Position::RightSummand));
                quote!(#a + #b)
            }
            Self::Difference(a, b) => {
                let (a, b) = (operand(a, Position::Summand), operand(b, Position::RightSummand));
                quote!(#a - #b)
            }
            Self::Product(a, b) => {
                let (a, b) = (operand(a, Position::Factor), operand(b, Position::RightFactor));
                quote!(#a * #b)
            }
        };
        tokens.extend(stream);
    }
}
