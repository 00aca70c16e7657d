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
#[derive(Clone, Copy)]
pub struct Body<'a> {
    program: &'a Program,
    scalar: &'a TokenStream,
    is_fused: bool,
}

impl<'a> Body<'a> {
    /// The body of a program, its products and sums rounded one by one.
    #[must_use]
    pub fn new(program: &'a Program, scalar: &'a TokenStream) -> Self {
        Self { program, scalar, is_fused: false }
    }

    /// The same with the scalar's `mul_add` wherever a product is added: one instruction on a target that has it, product
    /// and sum on any other. Results differ in the last digits from target to target, so the seven steps are not written so.
    #[must_use]
    pub fn fused(self) -> Self {
        Self { is_fused: true, ..self }
    }

    /// All of it.
    #[must_use]
    pub fn whole(self) -> TokenStream {
        let arguments = self.arguments(|_| true);
        let angles = self.statements(&self.program.angles);
        let turns = self.turns();
        let (constants, rest) = (self.constants(), self.beyond_turns());
        quote!(#arguments #constants #angles #turns #rest)
    }

    /// Its first part, for a loop of its own: the angles of [`Program::turns`] as an array, from the argument `q`.
    #[must_use]
    pub fn angles(self) -> TokenStream {
        let arguments = self.arguments(|name| name == "q");
        let statements = self.statements(&self.program.angles);
        let angles = self.program.turns.iter().map(|turn| &turn.angle);
        let constants = self.constants();
        quote!(#arguments #constants #statements [#(#angles),*])
    }

    /// What follows the first part, when the arguments `sin` and `cos` are references to the sines and cosines of its angles.
    #[must_use]
    pub fn beyond_angles(self) -> TokenStream {
        let arguments = self.arguments(|_| true);
        let [sines, cosines] = self.turn_names();
        let (constants, rest) = (self.constants(), self.beyond_turns());
        quote!(#arguments let #sines = *sin; let #cosines = *cos; #constants #rest)
    }

    fn arguments(self, is_asked: impl Fn(&str) -> bool) -> TokenStream {
        let arrays = arguments(self.program).into_iter().filter(|array| is_asked(array.name));
        arrays
            .map(|ArgumentArray { name, elements }| {
                let array = ident(name);
                if elements.iter().all(Option::is_none) {
                    return quote!(let _ = #array;);
                }
                let elements = elements.into_iter().map(name_or_underscore);
                quote!(let [#(#elements),*] = *#array;)
            })
            .collect()
    }

    fn constants(self) -> TokenStream {
        let scalar = self.scalar;
        let zero = self.program.returns_zero().then(|| {
            let zero = literal(0.0);
            quote!(let zero: T = #scalar::from_f64(#zero);)
        });
        let constants = self.program.constants.iter().map(|constant| {
            let (name, value) = (constant.name, literal(constant.value));
            quote!(let #name: T = #scalar::from_f64(#value);)
        });
        quote!(#zero #(#constants)*)
    }

    fn statements(self, statements: &[Statement]) -> TokenStream {
        let lines = statements.iter().map(|Statement { name, value, .. }| {
            let value = self.expression(value);
            quote!(let #name = #value;)
        });
        lines.collect()
    }

    /// The names of the sines and of the cosines, as patterns of arrays.
    fn turn_names(self) -> [TokenStream; 2] {
        let sines = self.program.turns.iter().map(|turn| name_or_underscore(turn.sine));
        let cosines = self.program.turns.iter().map(|turn| name_or_underscore(turn.cosine));
        [quote!([#(#sines),*]), quote!([#(#cosines),*])]
    }

    /// The sines and cosines, all at once.
    fn turns(self) -> TokenStream {
        let scalar = self.scalar;
        let [sines, cosines] = self.turn_names();
        let angles = self.program.turns.iter().map(|turn| &turn.angle);
        match &self.program.turns[..] {
            [] => TokenStream::new(),
            [turn] => {
                let (sine, cosine) = (name_or_underscore(turn.sine), name_or_underscore(turn.cosine));
                quote!(let (#sine, #cosine) = #scalar::sin_cos(#(#angles)*);)
            }
            _ => quote!(let (#sines, #cosines) = #scalar::sin_cos_array([#(#angles),*]);),
        }
    }

    /// The statements and what is returned.
    fn beyond_turns(self) -> TokenStream {
        let statements = self.statements(&self.program.statements);
        let outputs = self.program.outputs.iter().map(|output| self.expression(&output.value));
        quote!(#statements [#(#outputs),*])
    }

    fn expression(self, expression: &Expression) -> TokenStream {
        if self.is_fused { fused(expression, self.scalar) } else { expression.to_token_stream() }
    }
}

fn name_or_underscore(name: Option<Name>) -> TokenStream {
    name.map_or_else(|| quote!(_), |name| name.to_token_stream())
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
