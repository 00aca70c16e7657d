//! The tests that `#[robot(…, tests)]` puts into the user's crate: calls of `rne::testing`, one per test.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};
use rne_codegen::{Capability, Form, Function, Shape};
use rne_model::{GoldenFile, GoldenState};
use syn::ext::IdentExt;
use syn::{Data, DeriveInput, Path, PathSegment};

use crate::attribute::Attribute;
use crate::constants::number;
use crate::error::{Errors, describe};
use crate::location::RobotFile;
use crate::parameters::Parameters;

/// The laws that the functions of a capability obey, named as the functions of `rne::testing` that compare them.
pub(crate) const fn laws(capability: Capability) -> &'static [&'static str] {
    match capability {
        Capability::InverseDynamics => {
            &["torques_are_linear_in_accelerations", "gravity_and_bias_are_torques_without_motion"]
        }
        Capability::MassMatrix => &["mass_matrix_is_symmetric"],
        Capability::ForwardDynamics => &["accelerations_need_the_torques_that_cause_them"],
        Capability::Kinematics => &["rotations_are_orthonormal"],
        Capability::Energy => &["kinetic_energy_is_that_of_the_mass_matrix"],
        Capability::MomentumObserver => &["momentum_is_that_of_the_mass_matrix"],
        _ => &[],
    }
}

/// Returns the tests of a batch. The base of the runtime robot does not move, so a batch with a floating base has none.
pub(crate) fn of_batch(function: Function) -> &'static [&'static str] {
    match function {
        Function::InverseDynamics => &["batches_are_those_of_the_runtime"],
        Function::MassMatrix => &["mass_matrices_of_a_batch_are_those_of_the_runtime"],
        Function::ForwardDynamics => &["accelerations_of_a_batch_need_the_torques_that_cause_them"],
        Function::InverseDynamicsDerivatives => &["derivatives_of_a_batch_are_those_of_the_runtime"],
        _ => &[],
    }
}

/// Reports why a struct cannot have tests: they need a value of it without fields, and numbers that are all known.
pub(crate) fn check(item: &DeriveInput, attribute: &Attribute, parameters: &Parameters, errors: &mut Errors) {
    let Some(span) = attribute.tests else { return };
    if let Some(name) = parameters.names().first() {
        errors.at_span(
            span,
            format!(
                "`tests` needs a robot whose numbers are all known at compile time, but `{name}` is a run-time \
                 parameter. Without `tests`, compare with `rne::Arm` at the values that you use"
            ),
        );
    } else if !is_made_of_nothing(item) {
        let ident = item.ident.unraw();
        errors.at_span(
            span,
            format!(
                "`tests` make a value of the struct, so it has neither fields nor generics: `struct {ident};`. A \
                 second struct of the same robot, under `#[cfg(test)]`, can have the tests"
            ),
        );
    }
}

/// Whether `Name {}` is a value of the struct.
fn is_made_of_nothing(item: &DeriveInput) -> bool {
    let Data::Struct(data) = &item.data else { return true }; // an error that has been reported
    data.fields.is_empty() && item.generics.params.is_empty()
}

/// Returns the module with the tests of one derive: each of `functions` is compared with the runtime, and `tests` names
/// further tests of `rne::testing`. `trait_name` is the name of the derive, `text` the robot file.
pub(crate) fn module(
    item: &DeriveInput,
    attribute: &Attribute,
    trait_name: &str,
    functions: impl Iterator<Item = Function>,
    tests: &[&str],
    dof: usize,
    text: &TokenStream,
) -> TokenStream {
    if attribute.tests.is_none() || !is_made_of_nothing(item) {
        return TokenStream::new();
    }
    let (ident, dof) = (&item.ident, Literal::usize_unsuffixed(dof));
    let module = format_ident!("{}_{}_tests", snake(&ident.unraw().to_string()), snake(trait_name));
    let (import, krate) = seen_from_inside(&attribute.krate);
    let (rotors, seven_steps) = (attribute.rotors, attribute.form == Form::SevenSteps);
    let functions = functions.map(|function| is_that_of_the_runtime(function, ident, &krate));
    let tests = tests.iter().map(|name| {
        let name = Ident::new(name, Span::call_site());
        quote! {
            #[::core::prelude::v1::test]
            fn #name() {
                #krate::testing::#name::<#dof, _>(&super::#ident {}, &ROBOT_FILE);
            }
        }
    });
    quote! {
        #[cfg(test)]
        mod #module {
            #import
            #krate::testing::with_runtime! {
                const ROBOT_FILE: #krate::testing::RobotFile = #krate::testing::RobotFile {
                    text: #text,
                    rotors: #rotors,
                    seven_steps: #seven_steps,
                };
                #(#functions)*
                #(#tests)*
            }
        }
    }
}

/// The test that compares a function of a type with the runtime.
fn is_that_of_the_runtime(function: Function, ident: &Ident, krate: &Path) -> TokenStream {
    let (name, method) = (function.name(), format_ident!("{}", function.name()));
    let test = format_ident!("{name}_is_that_of_the_runtime");
    let capability = format_ident!("{}", function.capability().name());
    let arguments = function.arguments().iter().map(|argument| {
        let name = format_ident!("{}", argument.name());
        match argument.shape() {
            Shape::Array(..) => quote!(#krate::testing::array(given.#name)),
            Shape::Number | Shape::Record(..) => quote!(given.#name),
        }
    });
    quote! {
        #[::core::prelude::v1::test]
        fn #test() {
            #krate::testing::is_that_of_the_runtime(&ROBOT_FILE, #name, |given| {
                #krate::testing::numbers(#krate::#capability::#method(&super::#ident {}, #(#arguments),*))
            });
        }
    }
}

/// The module with the test that compares with the golden file beside the robot file.
pub(crate) fn golden(
    item: &DeriveInput,
    attribute: &Attribute,
    file: &RobotFile,
    dof: usize,
    errors: &mut Errors,
) -> TokenStream {
    let Some(span) = attribute.tests.filter(|_| is_made_of_nothing(item)) else { return TokenStream::new() };
    let GoldenFile { tolerance, states } = match GoldenFile::read(&file.shown, &file.bytes, dof) {
        Ok(golden) => golden,
        Err(report) => {
            errors.at_span(span, describe(report));
            return TokenStream::new();
        }
    };
    let (ident, shown) = (&item.ident, &file.shown);
    let module = format_ident!("{}_golden_tests", snake(&ident.unraw().to_string()));
    let (import, krate) = seen_from_inside(&attribute.krate);
    let states = states.into_iter().map(|GoldenState { line, q, qd, qdd, tau }| {
        let line = Literal::usize_unsuffixed(line);
        let [q, qd, qdd, tau] = [q, qd, qdd, tau].map(|numbers| numbers.into_iter().map(number).collect::<Vec<_>>());
        quote!(#krate::testing::GoldenState {
            line: #line, q: [#(#q),*], qd: [#(#qd),*], qdd: [#(#qdd),*], tau: [#(#tau),*]
        })
    });
    let (dof, tolerance) = (Literal::usize_unsuffixed(dof), number(tolerance));
    quote! {
        #[cfg(test)]
        mod #module {
            #import
            #krate::testing::with_runtime! {
                #[::core::prelude::v1::test]
                #[allow(clippy::all, clippy::pedantic)] // the numbers are those of the file
                fn torques_are_those_of_the_golden_file() {
                    #krate::testing::torques_are_those_of_the_golden_file::<#dof, _>(
                        &super::#ident {},
                        #shown,
                        &super::#ident::JOINT_NAMES,
                        #tolerance,
                        &[#(#states),*],
                    );
                }
            }
        }
    }
}

/// Returns a path as it must be written inside of a module, and the import that the module needs for it.
fn seen_from_inside(path: &Path) -> (TokenStream, Path) {
    let mut inner = path.clone();
    let first = path.segments.first().map(|segment| segment.ident.to_string());
    let outer = || PathSegment::from(Ident::new("super", Span::call_site()));
    match first.as_deref() {
        _ if path.leading_colon.is_some() => {}
        Some("crate") | None => {}
        Some("self") => inner.segments[0] = outer(),
        Some("super") => inner.segments.insert(0, outer()),
        // the first segment is a module of the user or a crate
        Some(_) => {
            let import = quote! {
                #[allow(unused_imports, clippy::wildcard_imports)]
                use super::*;
            };
            return (import, inner);
        }
    }
    (TokenStream::new(), inner)
}

/// `InverseDynamics` as `inverse_dynamics`, `UR5e` as `ur5e`.
fn snake(name: &str) -> String {
    let mut snake = String::new();
    let mut is_inside = false;
    for character in name.chars() {
        if is_inside && character.is_uppercase() {
            snake.push('_');
        }
        is_inside = character.is_lowercase() || character.is_numeric();
        snake.extend(character.to_lowercase());
    }
    snake
}

#[cfg(test)]
mod tests {
    use quote::quote;
    use syn::parse_quote;

    use super::{seen_from_inside, snake};

    #[test]
    fn modules_are_named_as_modules_are() {
        for (name, expected) in [
            ("InverseDynamics", "inverse_dynamics"),
            ("Puma560", "puma560"),
            ("Puma560Reduced", "puma560_reduced"),
            ("UR5e", "ur5e"),
        ] {
            assert_eq!(snake(name), expected);
        }
    }

    #[test]
    fn a_path_leads_to_the_same_place_from_inside() {
        let shown = |path: &syn::Path| quote!(#path).to_string();
        for (path, expected) in [
            (parse_quote!(::rne), parse_quote!(::rne)),
            (parse_quote!(crate::dynamics), parse_quote!(crate::dynamics)),
            (parse_quote!(self::dynamics), parse_quote!(super::dynamics)),
            (parse_quote!(super::dynamics), parse_quote!(super::super::dynamics)),
        ] {
            let (import, inner) = seen_from_inside(&path);
            assert!(import.is_empty());
            assert_eq!(shown(&inner), shown(&expected));
        }
        let (import, inner) = seen_from_inside(&parse_quote!(dynamics));
        assert!(!import.is_empty());
        assert_eq!(shown(&inner), "dynamics");
    }
}
