//! The code for a type: constants and the methods of the trait.

use proc_macro2::{Group, Ident, Literal, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};
use rne_codegen::{Argument, Capability, Form, Function, Length, Operations, Program, Record, Shape, Sizes};
use rne_model::Robot;
use syn::{DeriveInput, GenericParam, Path, Visibility};

use crate::attribute::Attribute;
use crate::description;
use crate::parameters::Parameters;

/// The type that the code is for, and where the library is.
pub(crate) struct Target<'a> {
    pub(crate) item: &'a DeriveInput,
    pub(crate) krate: &'a Path,
    /// Whether single calls are compiled for the target alone, to be inlined.
    pub(crate) inline: bool,
    /// The number of tips of the robot, or a parameter for it.
    pub(crate) tips: TokenStream,
    /// The number of dependent joints of its closed loops, or a parameter for it.
    passive: TokenStream,
    /// The number of their equations, or a parameter for it.
    equations: TokenStream,
}

/// The constants of a type.
struct Constants {
    /// For the documentation.
    description: Option<String>,
    name: String,
    joint_names: Vec<String>,
    position_limits: Vec<(f64, f64)>,
    velocity_limits: Vec<f64>,
    effort_limits: Vec<f64>,
    operations: Operations,
}

impl<'a> Target<'a> {
    /// The target of a derive; `None` for a robot that is not known.
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
    /// Everything for a robot and the programs of one capability.
    pub(crate) fn robot(
        &self,
        robot: &Robot,
        capability: Capability,
        programs: &[Program],
        parameters: &Parameters,
    ) -> TokenStream {
        let constants = match capability {
            Capability::InverseDynamics => {
                let (constants, joints) = (self.constants(&Constants::of(robot, programs)), self.joints(robot));
                let motors = self.motors(robot);
                quote!(#constants #joints #motors)
            }
            // with which no robot has `InverseDynamics`
            Capability::ClosedLoops => {
                let (constants, joints) = (self.constants(&Constants::of(robot, programs)), self.joints(robot));
                let (motors, counts) = (self.motors(robot), self.counts(programs));
                let passive = self.passive_joints(robot);
                quote!(#constants #joints #motors #counts #passive)
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
            #[allow(clippy::inline_always)] // into the code of the processor's instructions
            impl #impl_generics #krate::#name<#sizes> for #ident #type_generics #where_clause {
                #(#methods)*
            }
        }
    }

    /// The parameters of the trait of a capability: the number of joints, and others that it needs.
    fn sizes(&self, capability: Capability, dof: &TokenStream) -> TokenStream {
        let sizes = capability.lengths().map(|length| self.size(length, dof));
        quote!(#(#sizes),*)
    }

    /// Writes a stub for a robot that is not known: every use of it compiles, so that the mistake that is reported
    /// stays the only one. The trait is implemented for every number of joints.
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
            // what has the shape of an argument returns it
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

    /// The statement that takes an argument apart into the arrays that the body reads; `None` where it is one of them.
    fn taken_apart(&self, argument: Argument, program: &Program) -> Option<TokenStream> {
        let (krate, name) = (self.krate, format_ident!("{}", argument.name()));
        let parts: Vec<_> = argument.parts().map(|part| format_ident!("{}", part.name)).collect();
        match argument.shape() {
            Shape::Number | Shape::Array(_, Shape::Number) => None,
            // its inertia is a type of the model
            Shape::Record(Record::Payload, _) => Some(quote!(let #name = &#krate::Payload::to_array(#name);)),
            Shape::Record(record, _) if parts.len() > 1 => {
                let fields = record.fields().iter().zip(&parts).map(|(field, part)| {
                    let field = format_ident!("{field}");
                    if field == *part { quote!(#field) } else { quote!(#field: #part) }
                });
                let type_name = format_ident!("{}", record.name());
                // the velocity of a base has no influence
                let fields = if *record == Record::BaseMotion { quote!(#(#fields,)* ..) } else { quote!(#(#fields),*) };
                Some(quote!(let #krate::#type_name { #fields } = #name;))
            }
            // named as its array, too
            shape => {
                let numbers = elements(quote!(#name), shape, program.tips.len());
                Some(quote!(let #name = &[#(#numbers),*];))
            }
        }
    }

    /// Whether a method is computed by the instructions that the processor has, not by those alone that the program is
    /// compiled for.
    ///
    /// The seven steps keep their bits on every processor. What has no sine to compute and is short stays as it is: to
    /// ask and to call costs one or two nanoseconds, and what is inlined is not written to memory and read again. Calls
    /// one after the other in `f64`, plain build on an AMD EPYC with AVX-512 (`benches/plain_build.rs` with these
    /// arms):
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

    /// The body of a method that is compiled for the processor's instructions as well.
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
        // a call takes references; `&step` is the pattern and the argument
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

    /// The arguments of a function and their types, references of the given lifetime, in which `T` is the scalar.
    fn arguments(&self, function: Function, dof: &TokenStream, lifetime: &TokenStream) -> Vec<(Ident, TokenStream)> {
        let name_and_type = |argument: &Argument| {
            let kind = self.returned(argument.shape(), dof);
            let reference = (!argument.is_number()).then(|| quote!(&#lifetime));
            (format_ident!("{}", argument.name()), quote!(#reference #kind))
        };
        function.arguments().iter().map(name_and_type).collect()
    }

    /// A method of the trait with the given body, in which `T` is the scalar.
    fn signature(&self, function: Function, dof: &TokenStream, body: &TokenStream) -> TokenStream {
        self.signature_named(function.name(), function, dof, body)
    }

    /// A method of the trait `AtFrame`, as [`Self::signature`].
    pub(crate) fn signature_at_frame(&self, function: Function, dof: &TokenStream, body: &TokenStream) -> TokenStream {
        let name = format!("{}_at_frame", function.of_frame().unwrap_or_default());
        self.signature_named(&name, function, dof, body)
    }

    fn signature_named(&self, name: &str, function: Function, dof: &TokenStream, body: &TokenStream) -> TokenStream {
        let (krate, name) = (self.krate, format_ident!("{name}"));
        let (names, kinds): (Vec<_>, Vec<_>) = self.arguments(function, dof, &quote!()).into_iter().unzip();
        let returned = self.returned(function.shape(), dof);
        let method = quote! {
            fn #name<T: #krate::Scalar>(&self, #(#names: #kinds),*) -> #returned { #body }
        };
        if self.is_taken("T") { renamed(method, "T", &format_ident!("{}", self.free_name())) } else { method }
    }

    /// The type of an argument or a result.
    fn returned(&self, shape: &Shape, dof: &TokenStream) -> TokenStream {
        let krate = self.krate;
        match shape {
            Shape::Number => quote!(T),
            Shape::Array(length, of) => {
                let (of, length) = (self.returned(of, dof), self.size(*length, dof));
                quote!([#of; #length])
            }
            Shape::Record(record, _) => {
                let name = format_ident!("{}", record.name());
                let sizes = record.sizes().iter().map(|length| self.size(*length, dof));
                quote!(#krate::#name<#(#sizes,)* T>)
            }
        }
    }

    /// A length as it stands in a type.
    fn size(&self, length: Length, dof: &TokenStream) -> TokenStream {
        match length {
            Length::Joints => dof.clone(),
            Length::Velocities => velocities(dof),
            Length::Bodies => bodies(dof),
            Length::Tips => self.tips.clone(),
            Length::Passive => self.passive.clone(),
            Length::Equations => self.equations.clone(),
            Length::Fixed(length) => Literal::usize_unsuffixed(length).into_token_stream(),
        }
    }

    /// A name for a method's scalar.
    pub(crate) fn number(&self) -> Ident {
        if self.is_taken("T") { format_ident!("{}", self.free_name()) } else { format_ident!("T") }
    }

    /// Whether the user's type has a parameter of that name.
    fn is_taken(&self, name: &str) -> bool {
        self.item.generics.params.iter().any(|parameter| match parameter {
            GenericParam::Type(parameter) => parameter.ident == name,
            GenericParam::Const(parameter) => parameter.ident == name,
            GenericParam::Lifetime(_) => false,
        })
    }

    fn free_name(&self) -> String {
        let mut name = "Number".to_owned();
        while self.is_taken(&name) {
            name.push('_');
        }
        name
    }

    /// The visibility of the type. Its `pub` counts as generated: with that of the user, so would the constants count
    /// as the user's, and the compiler would warn of each that is never used.
    pub(crate) fn visibility(&self) -> Visibility {
        let mut visibility = self.item.vis.clone();
        match &mut visibility {
            Visibility::Public(token) => token.span = Span::call_site(),
            Visibility::Restricted(restricted) => restricted.pub_token.span = Span::call_site(),
            Visibility::Inherited => {}
        }
        visibility
    }

    /// A constant with the operations of each method.
    fn counts(&self, programs: &[Program]) -> TokenStream {
        self.counts_of(programs.iter().map(|program| (program.function, program.operations())))
    }

    fn counts_of(&self, counts: impl Iterator<Item = (Function, Operations)>) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, vis) = (&self.item.ident, self.visibility());
        let constants = counts.map(|(function, operations)| {
            let name = format_ident!("{}_OPERATIONS", function.name().to_uppercase());
            let documentation = format!("Operations of one call of `{function}`.");
            let (kind, value) = self.operations(&operations);
            quote! {
                #[doc = #documentation]
                #vis const #name: #kind = #value;
            }
        });
        quote! {
            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                #(#constants)*
            }
        }
    }

    /// The type of a count, and a value of it.
    fn operations(&self, operations: &Operations) -> (TokenStream, TokenStream) {
        let krate = self.krate;
        let [mul, add, div, sincos, statements] =
            [operations.mul, operations.add, operations.div, operations.sincos, operations.statements]
                .map(Literal::usize_unsuffixed);
        let kind = quote!(#krate::Operations);
        let value = quote! {
            #kind { mul: #mul, add: #add, div: #div, sincos: #sincos, statements: #statements }
        };
        (kind, value)
    }

    /// The constants of closed loops.
    fn passive_joints(&self, robot: &Robot) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, vis, passive, equations) = (&self.item.ident, self.visibility(), &self.passive, &self.equations);
        let names: Vec<&str> = robot.closed.passive.iter().map(|&joint| robot.joints[joint].name.as_str()).collect();
        let about = format!("Names of the dependent joints of closed loops.{}", description::values(&names));
        quote! {
            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                /// Number of dependent joints of closed loops.
                #vis const PASSIVE: ::core::primitive::usize = #passive;
                /// Number of equations of closed loops.
                #vis const EQUATIONS: ::core::primitive::usize = #equations;
                #[doc = #about]
                #vis const PASSIVE_NAMES: [&'static ::core::primitive::str; #passive] = [#(#names),*];
            }
        }
    }

    fn constants(&self, constants: &Constants) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, vis) = (&self.item.ident, self.visibility());
        let Constants { description, name, joint_names, .. } = constants;
        let description = description.as_ref().map(|description| quote!(#[doc = #description]));
        let dof = Literal::usize_unsuffixed(joint_names.len());
        let position_limits = constants.position_limits.iter().map(|(lower, upper)| {
            let (lower, upper) = (number(*lower), number(*upper));
            quote!((#lower, #upper))
        });
        let velocity_limits = constants.velocity_limits.iter().copied().map(number);
        let effort_limits = constants.effort_limits.iter().copied().map(number);
        let (count, operations) = self.operations(&constants.operations);
        let [positions, velocities, efforts] = [
            ("Lowest and highest position of each joint, rad or m", description::values(&constants.position_limits)),
            ("Highest speed of each joint, rad/s or m/s", description::values(&constants.velocity_limits)),
            ("Highest torque or force of each joint, N m or N", description::values(&constants.effort_limits)),
        ]
        .map(|(what, values)| format!("{what}; infinite where the robot file has none.{values}"));
        let names = format!("Names of the joints, base to tip.{}", description::values(joint_names));
        let (f64, str, usize) =
            (quote!(::core::primitive::f64), quote!(::core::primitive::str), quote!(::core::primitive::usize));
        quote! {
            #description
            #[automatically_derived]
            #[allow(clippy::approx_constant)] // a mass of 3.14 kg is not π
            impl #impl_generics #ident #type_generics #where_clause {
                /// Number of joints.
                #vis const DOF: #usize = #dof;
                /// Name of the robot.
                #vis const NAME: &'static #str = #name;
                #[doc = #names]
                #vis const JOINT_NAMES: [&'static #str; #dof] = [#(#joint_names),*];
                #[doc = #positions]
                #vis const POSITION_LIMITS: [(#f64, #f64); #dof] = [#(#position_limits),*];
                #[doc = #velocities]
                #vis const VELOCITY_LIMITS: [#f64; #dof] = [#(#velocity_limits),*];
                #[doc = #efforts]
                #vis const EFFORT_LIMITS: [#f64; #dof] = [#(#effort_limits),*];
                /// Operations of one call of `inverse_dynamics`.
                #vis const OPERATIONS: #count = #operations;
            }
        }
    }
}

impl Constants {
    fn of(robot: &Robot, programs: &[Program]) -> Self {
        let of_joints = robot.coordinate_limits();
        let limits = || of_joints.iter();
        let torques = programs.iter().find(|program| program.function.returns_torques());
        Self {
            description: Some(description::robot(robot)),
            name: robot.name.clone(),
            joint_names: robot.independent_joints().map(|joint| joint.name.clone()).collect(),
            position_limits: limits()
                .map(|limits| limits.position.unwrap_or((f64::NEG_INFINITY, f64::INFINITY)))
                .collect(),
            velocity_limits: limits().map(|limits| limits.velocity.unwrap_or(f64::INFINITY)).collect(),
            effort_limits: limits().map(|limits| limits.effort.unwrap_or(f64::INFINITY)).collect(),
            operations: torques.map(Program::operations).unwrap_or_default(),
        }
    }

    fn unknown(joints: usize) -> Self {
        Self {
            description: None,
            name: String::new(),
            joint_names: vec![String::new(); joints],
            position_limits: vec![(f64::NEG_INFINITY, f64::INFINITY); joints],
            velocity_limits: vec![f64::INFINITY; joints],
            effort_limits: vec![f64::INFINITY; joints],
            operations: Operations::default(),
        }
    }
}

/// The numbers of an argument of this shape, in order, as expressions.
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

/// The number of velocities of a robot with a floating base: six of the base, and those of its joints. Of a robot
/// that is not known, a parameter.
fn velocities(dof: &TokenStream) -> TokenStream {
    length(Length::Velocities, dof, quote!(__VELOCITIES))
}

/// The number of bodies of such a robot, as [`velocities`].
fn bodies(dof: &TokenStream) -> TokenStream {
    length(Length::Bodies, dof, quote!(__BODIES))
}

/// A length for a number of joints, which does not depend on the tips; `unknown` if that is a parameter.
fn length(length: Length, dof: &TokenStream, unknown: TokenStream) -> TokenStream {
    let dof = dof.to_string().parse::<usize>();
    let of = |dof| length.of(Sizes { dof, tips: 0, passive: 0, equations: 0 });
    dof.map_or(unknown, |dof| Literal::usize_unsuffixed(of(dof)).into_token_stream())
}

/// A number that reads back as the same bits, or infinity.
pub(crate) fn number(value: f64) -> TokenStream {
    let sign = value.is_sign_negative().then(|| quote!(-));
    if value.is_infinite() {
        return quote!(#sign ::core::primitive::f64::INFINITY);
    }
    let magnitude = Literal::f64_unsuffixed(value.abs());
    quote!(#sign #magnitude)
}

/// Replaces every identifier `from` in the tokens.
fn renamed(tokens: TokenStream, from: &str, to: &Ident) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Ident(ident) if ident == from => TokenTree::Ident(Ident::new(&to.to_string(), ident.span())),
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), renamed(group.stream(), from, to));
                inner.set_span(group.span());
                TokenTree::Group(inner)
            }
            token => token,
        })
        .collect()
}
