//! Writes a program as Rust tokens.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, Literal, Punct, Spacing, Span, TokenStream};
use quote::{ToTokens, quote};
use rne_codegen::{
    ArgumentArray, Expression, ExpressionKind, Name, Negated, Output, Program, Record, Statement, ValueId, fma,
    fma::Fusing,
};

use super::expression::{Infix as _, Position, needs_parentheses};
use super::syntax::Syntax;

/// The body of a program's function: the tokens between its braces.
///
/// The arguments `q`, `qd`, `qdd`, `force`, `moment` (those that the function has) must be references to arrays of the
/// type `T`; `scalar` is the path of the trait that gives `T` its `from_f64`, `sin_cos` and `sin_cos_array`.
#[derive(Debug)]
pub struct Body<'a> {
    program: Cow<'a, Program>,
    scalar: &'a TokenStream,
    /// The path of the type with `mul_add`, `sin_cos` and `sin_cos_array`: the scalar, if no other path is given.
    arithmetic: &'a TokenStream,
    /// The path of the record types; if it is `None`, records are tuples.
    library: Option<&'a TokenStream>,
}

impl<'a> Body<'a> {
    /// Returns the body of a program whose products and sums are rounded one by one.
    #[must_use]
    pub fn new(program: &'a Program, scalar: &'a TokenStream) -> Self {
        Self { program: Cow::Borrowed(program), scalar, arithmetic: scalar, library: None }
    }

    /// Returns the body with `mul_add`, `sin_cos` and `sin_cos_array` of the type or the trait at `arithmetic`.
    #[must_use]
    pub fn with_arithmetic(self, arithmetic: &'a TokenStream) -> Self {
        Self { arithmetic, ..self }
    }

    /// Returns the body with poses and other records as types of the crate at `library`; without this call they are
    /// tuples.
    #[must_use]
    pub fn with_records_of(self, library: &'a TokenStream) -> Self {
        Self { library: Some(library), ..self }
    }

    /// Returns the body with the scalar's `mul_add` for a product and the sum to which it is added: one instruction if
    /// the target has it, otherwise two. They stay separate where the result is known sooner that way and the caller
    /// has to wait for it.
    ///
    /// The results then differ in the last digits from target to target, so this is not used for the seven steps.
    #[must_use]
    pub fn fused(self) -> Self {
        Self { program: Cow::Owned(fma::fused(&self.program, Fusing::Soonest)), ..self }
    }

    /// Returns the body with `mul_add` for every product that is added: the fewest instructions.
    #[must_use]
    pub fn all_fused(self) -> Self {
        Self { program: Cow::Owned(fma::fused(&self.program, Fusing::All)), ..self }
    }

    /// Returns the whole body.
    #[must_use]
    pub fn whole(&self) -> TokenStream {
        let arguments = self.arguments(|_| true, |_| true);
        let constants = self.constants(|_| true);
        let angles = self.statements(&self.program.angles);
        let turns = self.turns();
        let rest = self.beyond_turns();
        quote!(#arguments #constants #angles #turns #rest)
    }

    /// Returns the first part of the body, for a separate loop: it computes the angles of
    /// [`Program::sines_and_cosines`] as an array, from the argument `q`.
    #[must_use]
    pub fn angles(&self) -> TokenStream {
        let used: BTreeSet<Name> = self.program.angle_expressions().flat_map(Expression::names).collect();
        let arguments = self.arguments(|name| name == "q", |name| used.contains(&name));
        let constants = self.constants(|name| used.contains(&name));
        let statements = self.statements(&self.program.angles);
        let turns = self.program.sines_and_cosines.iter().map(|turn| self.used(turn.angle));
        quote!(#arguments #constants #statements [#(#turns),*])
    }

    /// Returns the part after the angles; the arguments `sin` and `cos` must be references to the sines and cosines of
    /// these angles.
    ///
    /// The results that `places` names, in the order of [`Program::outputs`], are written to `outputs`, a reference to
    /// an array, each as soon as it is known. Otherwise a result that waits in a register may be written to memory and
    /// read again.
    #[must_use]
    pub fn beyond_angles(&self, places: &[usize]) -> TokenStream {
        let used: BTreeSet<Name> = self.program.expressions().flat_map(Expression::names).collect();
        let arguments = self.arguments(|_| true, |name| used.contains(&name));
        let constants = self.constants(|name| used.contains(&name));
        let turns = if self.program.sines_and_cosines.is_empty() {
            quote!(let _ = (sin, cos);)
        } else {
            let [sines, cosines] = self.turn_names();
            quote!(let #sines = *sin; let #cosines = *cos;)
        };
        let statements = &self.program.statements;
        let at: BTreeMap<Name, usize> = statements.iter().enumerate().map(|(at, known)| (known.name, at + 1)).collect();
        let mut results = vec![TokenStream::new(); statements.len() + 1];
        for (place, &output) in places.iter().enumerate() {
            let value = self.program.outputs[output].value;
            let names = self.program.values.used(value).names();
            let known = names.filter_map(|name| at.get(&name).copied()).max().unwrap_or_default();
            let (place, value) = (Literal::usize_unsuffixed(place), self.used(value));
            results[known].extend(quote!(outputs[#place] = #value;));
        }
        let mut results = results.into_iter();
        let known = results.next();
        let rest = statements.iter().zip(results).map(|(known, results)| {
            let statement = self.statements(std::slice::from_ref(known));
            quote!(#statement #results)
        });
        quote!(#arguments #turns #constants #known #(#rest)*)
    }

    /// Returns, for each result in the order of [`Program::outputs`], the first result with the same value: for an
    /// element above the diagonal of a symmetric matrix, that is the element below it. `None` for a result that is
    /// always zero.
    #[must_use]
    pub fn distinct(&self) -> Vec<Option<usize>> {
        let (values, mut first) = (&self.program.values, BTreeMap::new());
        let outputs = self.program.outputs.iter().enumerate();
        let place = |(index, output): (usize, &Output)| {
            let is_zero = matches!(values.used(output.value).kind(), ExpressionKind::Zero);
            (!is_zero).then(|| *first.entry(output.value).or_insert(index))
        };
        outputs.map(place).collect()
    }

    fn arguments(&self, is_asked: impl Fn(&str) -> bool, is_used: impl Fn(Name) -> bool) -> TokenStream {
        let arrays = self.program.argument_arrays().into_iter();
        arrays
            .filter(|array| is_asked(array.name))
            .map(|ArgumentArray { name, elements, is_number, .. }| {
                let array = ident(name);
                let elements: Vec<_> = elements.into_iter().map(|name| name.filter(|name| is_used(*name))).collect();
                if elements.iter().all(Option::is_none) {
                    return quote!(let _ = #array;);
                }
                let elements = elements.into_iter().map(name_or_underscore);
                if is_number { quote!(#(let #elements = #array;)*) } else { quote!(let [#(#elements),*] = *#array;) }
            })
            .collect()
    }

    fn constants(&self, is_used: impl Fn(Name) -> bool) -> TokenStream {
        let scalar = self.scalar;
        let zero = self.program.returns_zero().then(|| {
            let zero = literal(0.0);
            quote!(let zero: T = #scalar::from_f64(#zero);)
        });
        let constants = self.program.constants().filter(|constant| is_used(constant.name)).map(|constant| {
            let (name, value) = (variable(constant.name), literal(constant.value));
            quote!(let #name: T = #scalar::from_f64(#value);)
        });
        quote!(#zero #(#constants)*)
    }

    fn statements(&self, statements: &[Statement]) -> TokenStream {
        let lines = statements.iter().map(|Statement { name, value, .. }| {
            let (value, name) = (self.expression(self.program.values.defined(*value)), variable(*name));
            quote!(let #name = #value;)
        });
        lines.collect()
    }

    /// Returns the names of the sines and of the cosines, as patterns of arrays.
    fn turn_names(&self) -> [TokenStream; 2] {
        let sines = self.program.sines_and_cosines.iter().map(|turn| name_or_underscore(turn.sine));
        let cosines = self.program.sines_and_cosines.iter().map(|turn| name_or_underscore(turn.cosine));
        [quote!([#(#sines),*]), quote!([#(#cosines),*])]
    }

    /// Returns the statement that computes all sines and cosines at once.
    fn turns(&self) -> TokenStream {
        let arithmetic = self.arithmetic;
        let [sines, cosines] = self.turn_names();
        let angles = self.program.sines_and_cosines.iter().map(|turn| self.used(turn.angle));
        match &self.program.sines_and_cosines[..] {
            [] => TokenStream::new(),
            [turn] => {
                let (sine, cosine) = (name_or_underscore(turn.sine), name_or_underscore(turn.cosine));
                quote!(let (#sine, #cosine) = #arithmetic::sin_cos(#(#angles)*);)
            }
            _ => quote!(let (#sines, #cosines) = #arithmetic::sin_cos_array([#(#angles),*]);),
        }
    }

    /// Returns the statements and the results.
    fn beyond_turns(&self) -> TokenStream {
        let statements = self.statements(&self.program.statements);
        let outputs = self.returned();
        quote!(#statements #outputs)
    }

    /// Returns the results in their layout; if additional values are kept, the results are a list.
    fn returned(&self) -> TokenStream {
        let outputs = || self.program.outputs.iter().map(|output| self.used(output.value));
        let layout = self.program.layout();
        let array = |elements: Vec<TokenStream>| quote!([#(#elements),*]);
        let record = |record: Record, parts: Vec<TokenStream>| {
            let Some(library) = self.library else { return quote!((#(#parts),*)) };
            let (name, fields) = (ident(record.name()), record.fields().iter().copied().map(ident));
            quote!(#library::#name { #(#fields: #parts),* })
        };
        let grouped = layout.fold(&mut outputs(), &array, &record);
        match grouped {
            Some(grouped) if layout.len() == self.program.outputs.len() => grouped,
            _ => array(outputs().collect()),
        }
    }

    fn used(&self, value: ValueId) -> TokenStream {
        self.expression(self.program.values.used(value))
    }

    fn expression(&self, expression: Expression<'_>) -> TokenStream {
        let operand = |operand: Expression<'_>, position| {
            let tokens = self.expression(operand);
            if needs_parentheses(Syntax::Rust, operand, position) { quote!((#tokens)) } else { tokens }
        };
        let minus = |negated: Expression<'_>| {
            let tokens = operand(negated, Position::Negated);
            quote!(-#tokens)
        };
        let (scalar, arithmetic) = (self.scalar, self.arithmetic);
        match expression.kind() {
            ExpressionKind::Variable(name) => variable(name).to_token_stream(),
            ExpressionKind::Zero => quote!(zero),
            ExpressionKind::Negative(a) => minus(a),
            ExpressionKind::Binary(operator, a, b) => {
                let [left, right] = operator.positions();
                let (a, b, sign) = (operand(a, left), operand(b, right), Punct::new(operator.sign(), Spacing::Alone));
                quote!(#a #sign #b)
            }
            ExpressionKind::Fused([x, y], addend, negated) => {
                let signed = |factor, part| if negated == Some(part) { minus(factor) } else { self.expression(factor) };
                let (x, y, addend) = (signed(x, Negated::Factor), self.expression(y), signed(addend, Negated::Addend));
                quote!(#arithmetic::mul_add(#x, #y, #addend))
            }
            ExpressionKind::BySign(operands) => {
                let operands = operands.map(|operand| self.expression(operand));
                quote!(#scalar::by_sign(#(#operands),*))
            }
        }
    }
}

fn name_or_underscore(name: Option<Name>) -> TokenStream {
    name.map_or_else(|| quote!(_), |name| variable(name).to_token_stream())
}

/// Returns a number as a literal that is read as the same number; a negative number is a minus and a literal, as in
/// source text.
fn literal(value: f64) -> TokenStream {
    let text = format!("{:?}", value.abs());
    let magnitude = text.parse().unwrap_or_else(|_| Literal::f64_unsuffixed(value.abs()));
    if value < 0.0 { quote!(-#magnitude) } else { quote!(#magnitude) }
}

fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

fn variable(name: Name) -> Ident {
    ident(&name.to_string())
}
