//! The code for a type: the methods of a trait, and the constants that come with it.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rne_codegen::{Argument, Capability, Form, Function, Length, Operations, Program, Record, Shape, Sizes};
use rne_model::Robot;
use syn::{DeriveInput, Path};

use crate::attribute::Attribute;
use crate::constants::Constants;
use crate::description;
use crate::parameters::Parameters;

/// The type for which code is written, and the path of the library `rne`.
pub(crate) struct Target<'a> {
    pub(crate) item: &'a DeriveInput,
    pub(crate) krate: &'a Path,
    /// Whether single calls are compiled for the compiled target only, so that they can be inlined.
    pub(crate) inline: bool,
    /// The number of tips of the robot, or a parameter for it.
    pub(crate) tips: TokenStream,
    /// The number of dependent joints of its closed loops, or a parameter for it.
    pub(crate) passive: TokenStream,
    /// The number of equations of these loops, or a parameter for it.
    pub(crate) equations: TokenStream,
}

impl<'a> Target<'a> {
    /// The target of a derive; without sizes for a robot that is not known.
    pub(crate) fn new(item: &'a DeriveInput, attribute: &'a Attribute, sizes: Option<Sizes>) -> Self {
        let number = |unknown: &str, size: fn(Sizes) -> usize| {
            sizes.map_or_else(
                || Ident::new(unknown, Span::call_site()).into_token_stream(),
                |sizes| Literal::usize_unsuffixed(size(sizes)).into_token_stream(),
            )
        };
        Self {
            item,
            krate: &attribute.krate,
            inline: attribute.inline,
            tips: number("__TIPS", |sizes| sizes.tips),
            passive: number("__PASSIVE", |sizes| sizes.passive),
            equations: number("__EQUATIONS", |sizes| sizes.equations),
        }
    }
}

impl Target<'_> {
    /// Returns all code for a robot and the programs of one capability.
    pub(crate) fn robot(
        &self,
        robot: &Robot,
        capability: Capability,
        programs: &[Program],
        parameters: &Parameters,
    ) -> TokenStream {
        let constants = match capability {
            // a robot has only one of these two capabilities, which both define the constants
            Capability::InverseDynamics | Capability::ClosedLoops => {
                let (constants, joints) = (self.constants(&Constants::of(robot, programs)), self.joints(robot));
                let motors = self.motors(robot);
                let of_loops = (capability == Capability::ClosedLoops)
                    .then(|| [self.counts(programs), self.passive_joints(robot)])
                    .into_iter()
                    .flatten();
                quote!(#constants #joints #motors #(#of_loops)*)
            }
            Capability::TipWrenches => {
                let (counts, tips) = (self.counts(programs), self.tips(robot));
                quote!(#counts #tips)
            }
            _ => self.counts(programs),
        };
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, krate, dof) = (&self.item.ident, self.krate, Literal::usize_unsuffixed(robot.dof()));
        let (name, sizes) = (format_ident!("{}", capability.name()), self.sizes(capability, &quote!(#dof)));
        let operations = description::operations(programs);
        let evidence = description::evidence(programs).into_iter().map(|evidence| quote!(#[doc = #evidence]));
        let methods = programs.iter().map(|program| self.method(robot, program, parameters));
        quote! {
            #constants

            #[doc = #operations]
            #(#evidence)*
            #[automatically_derived]
            #[allow(clippy::approx_constant)] // a mass of 3.14 kg is not π
            #[allow(clippy::inline_always)] // inlined into code for the processor's instructions
            impl #impl_generics #krate::#name<#sizes> for #ident #type_generics #where_clause {
                #(#methods)*
            }
        }
    }

    /// Returns a stub for a robot that is not known. Every use of it compiles, so that the reported error remains the
    /// only one. The trait is implemented for every number of joints.
    pub(crate) fn stub(&self, capability: Capability, joints: usize) -> TokenStream {
        let constants = if matches!(capability, Capability::InverseDynamics | Capability::ClosedLoops) {
            let (constants, joints) = (self.constants(&Constants::unknown(joints)), self.joints_stub());
            quote!(#constants #joints)
        } else {
            self.counts_of(capability.functions().map(|function| (function, Operations::default())))
        };
        let (ident, krate, name) = (&self.item.ident, self.krate, format_ident!("{}", capability.name()));
        let (_, type_generics, where_clause) = self.item.generics.split_for_impl();
        let mut generics = self.item.generics.clone();
        let joints = quote!(__JOINTS);
        for length in capability.lengths() {
            let size = self.size(length, &joints);
            generics.params.push(syn::parse_quote!(const #size: ::core::primitive::usize));
        }
        let (impl_generics, ..) = generics.split_for_impl();
        let sizes = self.sizes(capability, &joints);
        let methods = capability.functions().map(|function| {
            // a result with the shape of the positions can return these; other bodies never return
            let body = if function.takes(Argument::Positions)
                && *function.shape() == Shape::Array(Length::Joints, &Shape::Number)
            {
                quote!(*q)
            } else {
                quote!(loop {})
            };
            self.signature(function, &joints, &body)
        });
        quote! {
            #constants

            #[automatically_derived]
            impl #impl_generics #krate::#name<#sizes> for #ident #type_generics #where_clause {
                #(#methods)*
            }
        }
    }

    pub(crate) fn method(&self, robot: &Robot, program: &Program, parameters: &Parameters) -> TokenStream {
        let krate = self.krate;
        let (scalar, library, arithmetic) = (quote!(#krate::Scalar), quote!(#krate), quote!(A));
        let is_asked = self.asks_processor(program);
        let body = rne_emit::Body::new(program, &scalar).with_records_of(&library);
        let body = if is_asked { body.with_arithmetic(&arithmetic) } else { body };
        // The seven steps compute the bits of the runtime, so that nothing is fused there.
        let body = match program.form {
            Form::SevenSteps => body,
            _ if program.is_long() => body.all_fused(),
            Form::Reduced => body.fused(),
        };
        let body = body.whole();
        let function = program.function;
        let arguments = function.arguments().iter().filter_map(|&argument| self.taken_apart(argument, program));
        let body = quote!(#(#arguments)* #body);
        let (count, parameters) = (parameters.names().len(), parameters.read(krate));
        let dof = Literal::usize_unsuffixed(program.dof);
        let of_trait = match program.frame {
            Some(_) => format_ident!("AtFrame"),
            None => format_ident!("{}", function.capability().name()),
        };
        let of_trait = quote!(#krate::#of_trait).to_string().replace(' ', "");
        let documentation = description::method(robot, program, of_trait.trim_start_matches("::"));
        let dof = quote!(#dof);
        let body =
            if is_asked { self.call(function, &dof, count, &parameters, &body) } else { quote!(#parameters #body) };
        let method = match program.frame {
            Some(_) => self.signature_at_frame(function, &dof, &body),
            None => self.signature(function, &dof, &body),
        };
        quote!(#[doc = #documentation] #method)
    }

    /// Returns the statement that splits an argument into the arrays that the body reads; `None` if it is one of these
    /// arrays.
    fn taken_apart(&self, argument: Argument, program: &Program) -> Option<TokenStream> {
        let (krate, name) = (self.krate, format_ident!("{}", argument.name()));
        let parts: Vec<_> = argument.parts().map(|part| format_ident!("{}", part.name)).collect();
        match argument.shape() {
            Shape::Number | Shape::Array(_, Shape::Number) => None,
            // the inertia of a payload is a type of the model, so the payload converts itself to an array
            Shape::Record(Record::Payload, _) => Some(quote!(let #name = &#krate::Payload::to_array(#name);)),
            Shape::Record(record, _) if parts.len() > 1 => {
                let fields = record.fields().iter().zip(&parts).map(|(field, part)| {
                    let field = format_ident!("{field}");
                    if field == *part { quote!(#field) } else { quote!(#field: #part) }
                });
                let type_name = format_ident!("{}", record.name());
                // the velocity of a base has no effect, so it is ignored
                let fields = if *record == Record::BaseMotion { quote!(#(#fields,)* ..) } else { quote!(#(#fields),*) };
                Some(quote!(let #krate::#type_name { #fields } = #name;))
            }
            // here the argument and its array have the same name
            shape => {
                let numbers = elements(quote!(#name), shape, program.tips.len());
                Some(quote!(let #name = &[#(#numbers),*];))
            }
        }
    }

    /// Whether a method uses the instructions that the processor has, and not only those for which the program is
    /// compiled.
    ///
    /// The seven steps must have the same bits on every processor. Short code without sines is compiled only once: the
    /// test of the processor and the call cost one or two nanoseconds, and values of inlined code stay in registers.
    /// Measured are consecutive calls in `f64`, in a plain build on an AMD EPYC with AVX-512 (`benches/plain_build.rs`
    /// with these arms):
    ///
    /// | | operations, angles | ns: inlined | asked |
    /// |---|---|---:|---:|
    /// | `inverse_dynamics` of gantry_ppp | 4, 0 | 1.0 | 1.7 |
    /// | `inverse_dynamics_from_sin_cos` of planar3 | 51, 0 | 4.8 | 5.1 |
    /// | `inverse_dynamics_from_sin_cos` of spherical_rrp | 83, 0 | 9.2 | 7.9 |
    /// | `inverse_dynamics` of planar1 | 3, 1 | 7.8 | 7.6 |
    /// | `inverse_dynamics` of scara_cobra600 | 22, 1 | 11.3 | 10.2 |
    /// | `inverse_dynamics` of planar2 | 23, 2 | 10.9 | 9.6 |
    /// | `inverse_dynamics` of planar3 | 51, 3 | 21.3 | 13.6 |
    fn asks_processor(&self, program: &Program) -> bool {
        const SHORT: usize = 60;
        let operations = program.operations();
        program.form == Form::Reduced && !self.inline && (operations.sincos > 0 || operations.total() >= SHORT)
    }

    /// Returns the body of a method that is also compiled for the processor's instructions.
    fn call(
        &self,
        function: Function,
        dof: &TokenStream,
        parameter_count: usize,
        parameters: &TokenStream,
        body: &TokenStream,
    ) -> TokenStream {
        let krate = self.krate;
        let arguments = self.arguments(function, dof, &quote!('a)).into_iter().zip(function.arguments());
        // a call takes references; `&step` serves as the pattern of the parameter and as the argument
        let by_reference = |((name, kind), argument): ((Ident, TokenStream), &Argument)| {
            if argument.is_number() { (quote!(&#name), quote!(&'a #kind)) } else { (quote!(#name), kind) }
        };
        let (mut names, mut kinds): (Vec<_>, Vec<_>) = arguments.map(by_reference).unzip();
        if parameter_count > 0 {
            let count = Literal::usize_unsuffixed(parameter_count);
            names.push(quote!(parameters));
            kinds.push(quote!(&'a [T; #count]));
        }
        let returned = self.returned(function.shape(), dof);
        quote! {
            enum Call {}
            impl #krate::processor::Call for Call {
                type Arguments<'a, T: #krate::Scalar> = (#(#kinds,)*);
                type Result<T: #krate::Scalar> = #returned;
                #[inline(always)]
                fn run<T: #krate::Scalar, A: #krate::processor::Arithmetic<T>>(
                    (#(#names,)*): Self::Arguments<'_, T>,
                ) -> Self::Result<T> {
                    #body
                }
            }
            #parameters
            #krate::processor::run::<Call, T>((#(#names,)*))
        }
    }
}

/// Returns expressions for the numbers of an argument of this shape, in order.
fn elements(of: TokenStream, shape: &Shape, tips: usize) -> Vec<TokenStream> {
    match shape {
        Shape::Number => vec![of],
        Shape::Array(length, element) => {
            let count = length.of(Sizes { dof: 0, tips, passive: 0, equations: 0 });
            let each = (0..count).map(Literal::usize_unsuffixed);
            each.flat_map(|at| elements(quote!(#of[#at]), element, tips)).collect()
        }
        Shape::Record(record, parts) => {
            let parts = record.fields().iter().zip(*parts);
            parts
                .flat_map(|(field, part)| {
                    let field = format_ident!("{field}");
                    elements(quote!(#of.#field), part, tips)
                })
                .collect()
        }
    }
}
