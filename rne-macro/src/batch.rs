//! The derives of batches, such as `#[derive(BatchInverseDynamics)]`.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rne_codegen::{Argument, Form, Function, Length, Program, Target as Machine};
use syn::DeriveInput;

use crate::attribute::Attribute;
use crate::error::Errors;
use crate::expand::{compiler, load};
use crate::implementation::Target;
use crate::own_tests::{self, of_batch};
use crate::parameters::Parameters;

/// The sizes of a robot, as literals or parameters.
struct Sizes {
    dof: TokenStream,
    velocities: TokenStream,
    tips: TokenStream,
}

/// A result: its name, and the dimensions of its arrays.
struct Answer(&'static str, Vec<TokenStream>);

/// Expands the derive of a batch. The derive that its trait requires, such as `InverseDynamics`, reports all errors in
/// the struct, the attribute or the file. So nothing is reported here, and for an unknown robot nothing is computed.
///
/// The code of the function is written a second time, because it must be inlined into the code for each vector unit,
/// but not into every place where a user calls the methods of the first derive.
pub(crate) fn batch(function: Function, input: TokenStream) -> TokenStream {
    let item: DeriveInput = match syn::parse2(input) {
        Ok(item) => item,
        Err(error) => return error.to_compile_error(),
    };
    let mut said = Errors::default();
    let attribute = Attribute::parse(&item, &mut said);
    let parameters = Parameters::of(&item, &mut said);
    let loaded = attribute.source.as_ref().map(|source| load(source, &parameters, &mut said)).unwrap_or_default();
    let refused = refusal(&item, &parameters);
    // a refused robot still has known sizes
    let robot = loaded.robot.map(|robot| rne_model::Robot { rotors: attribute.rotors, ..robot });
    let sizes = robot.as_ref().map_or_else(Sizes::unknown, |robot| Sizes::of(robot.dof(), robot.tip_count()));
    let program = robot.as_ref().filter(|robot| robot.run_time.is_empty()).and_then(|robot| {
        let (capability, span) = (function.capability(), Span::call_site());
        let compiler = compiler(robot, capability, attribute.form, loaded.plan.as_ref(), span, &mut said)?;
        compiler.for_target(Machine::Throughput).compile(function, attribute.form).ok()
    });
    let target = Target::new(&item, &attribute, None);
    let (ident, krate) = (&item.ident, &attribute.krate);
    let (_, type_generics, where_clause) = item.generics.split_for_impl();
    let mut generics = item.generics.clone();
    if robot.is_none() {
        let parameters = sizes.of_trait(function);
        generics.params.extend(
            parameters.into_iter().map(|parameter| -> syn::GenericParam {
                syn::parse_quote!(const #parameter: ::core::primitive::usize)
            }),
        );
    }
    let (impl_generics, ..) = generics.split_for_impl();
    let (name, of_trait) = (format_ident!("{}", trait_name(function)), sizes.of_trait(function));
    let body = program.as_ref().map_or_else(
        || quote!(::core::result::Result::Ok(())),
        |program| body(program, krate, &answers(function, &sizes)),
    );
    let method = sizes.method(function, &target.number(), krate, &body);
    // without a robot, the method uses none of its arguments
    let unused = program.is_none().then(|| quote!(#[allow(unused_variables)]));
    let tests = program.as_ref().map(|program| {
        let (name, tests) = (trait_name(function), of_batch(function));
        own_tests::module(&item, &attribute, name, [].into_iter(), tests, program.dof, &loaded.text)
    });
    quote! {
        #refused
        #[automatically_derived]
        #unused
        #[allow(clippy::approx_constant)] // a mass of 3.14 kg is not π
        #[allow(clippy::inline_always)] // must be inlined into the code of each vector unit
        impl #impl_generics #krate::#name<#(#of_trait),*> for #ident #type_generics #where_clause {
            #method
        }
        #tests
    }
}

/// Returns the error for a robot with run-time parameters, which a batch cannot have.
fn refusal(item: &DeriveInput, parameters: &Parameters) -> Option<TokenStream> {
    let name = parameters.names().into_iter().next()?;
    let message = format!(
        "a batch needs a robot whose numbers are all known at compile time, but `{name}` is a run-time parameter"
    );
    Some(syn::Error::new_spanned(&item.ident, message).to_compile_error())
}

/// The name of the trait and the derive.
fn trait_name(function: Function) -> &'static str {
    match function {
        Function::MassMatrix => "BatchMassMatrix",
        Function::ForwardDynamics => "BatchForwardDynamics",
        Function::InverseDynamicsDerivatives => "BatchInverseDynamicsDerivatives",
        Function::InverseDynamicsOfFloatingBase => "BatchFloatingInverseDynamics",
        _ => "BatchInverseDynamics",
    }
}

fn answers(function: Function, sizes: &Sizes) -> Vec<Answer> {
    let vector = || vec![sizes.dof.clone()];
    let matrix = || vec![sizes.dof.clone(); 2];
    match function {
        Function::MassMatrix => vec![Answer("mass", matrix())],
        Function::ForwardDynamics => vec![Answer("qdd", vector())],
        Function::InverseDynamicsDerivatives => vec![Answer("dq", matrix()), Answer("dqd", matrix())],
        Function::InverseDynamicsOfFloatingBase => vec![Answer("wrench", vec![quote!(6)]), Answer("tau", vector())],
        _ => vec![Answer("tau", vector())],
    }
}

impl Sizes {
    fn of(dof: usize, tips: usize) -> Self {
        let size = |size| Literal::usize_unsuffixed(size).into_token_stream();
        Self { dof: size(dof), velocities: size(Length::OF_BASE + dof), tips: size(tips) }
    }

    fn unknown() -> Self {
        Self { dof: quote!(__JOINTS), velocities: quote!(__VELOCITIES), tips: quote!(__TIPS) }
    }

    /// Returns the constant parameters of the trait.
    fn of_trait(&self, function: Function) -> Vec<&TokenStream> {
        match function {
            Function::InverseDynamicsOfFloatingBase => vec![&self.dof, &self.velocities, &self.tips],
            _ => vec![&self.dof],
        }
    }

    fn method(&self, function: Function, number: &Ident, krate: &syn::Path, body: &TokenStream) -> TokenStream {
        let name = format_ident!("{function}_batch_on", function = function.name());
        let (dof, tips) = (&self.dof, &self.tips);
        let arguments = function.arguments().iter().map(|argument| match argument {
            Argument::Base => quote!(base: &#krate::BaseMotion<&[#number]>),
            Argument::Wrenches => quote!(wrenches: &[#krate::Wrench<&[#number]>; #tips]),
            Argument::Rates => quote!(qd: [&[#number]; #dof]),
            Argument::Accelerations => quote!(qdd: [&[#number]; #dof]),
            Argument::Torques => quote!(tau: [&[#number]; #dof]),
            _ => quote!(q: [&[#number]; #dof]),
        });
        let results = answers(function, self).into_iter().map(|Answer(name, lengths)| {
            let name = format_ident!("{name}");
            let kind = lengths.iter().rev().fold(quote!(&mut [#number]), |kind, length| quote!([#kind; #length]));
            quote!(#name: #kind)
        });
        quote! {
            fn #name<#number: #krate::BatchScalar>(
                &self,
                unit: #krate::VectorUnit,
                #(#arguments,)*
                #(#results,)*
            ) -> ::core::result::Result<(), #krate::LengthMismatch> {
                #body
            }
        }
    }
}

/// Returns the expressions for the numbers of an argument of the program, and its entries in the list of arguments.
fn inputs(name: &'static str, length: usize, krate: &syn::Path) -> (Vec<TokenStream>, Vec<TokenStream>) {
    let list = quote!(#krate::batch::Argument);
    let elements = |of: &TokenStream, length: usize| {
        (0..length).map(Literal::usize_unsuffixed).map(|index| quote!(#of[#index])).collect::<Vec<_>>()
    };
    if name == "wrenches" {
        let parts = (0..length / 6).flat_map(|tip| ["force", "moment"].map(|part| (tip, part)));
        return parts
            .map(|(tip, part)| {
                let name = format!("wrenches[{tip}].{part}");
                let (tip, part) = (Literal::usize_unsuffixed(tip), format_ident!("{part}"));
                (elements(&quote!(wrenches[#tip].#part), 3), quote!(#list::optional_vector(#name, 3)))
            })
            .fold((Vec::new(), Vec::new()), |(mut numbers, mut arguments), (of_part, argument)| {
                numbers.extend(of_part);
                arguments.push(argument);
                (numbers, arguments)
            });
    }
    let count = Literal::usize_unsuffixed(length);
    let (of, shown) = match name.strip_prefix("base_") {
        Some(part) => {
            let ident = format_ident!("{part}");
            (quote!(base.#ident), format!("base.{part}"))
        }
        None => (format_ident!("{name}").into_token_stream(), name.to_owned()),
    };
    (elements(&of, length), vec![quote!(#list::vector(#shown, #count))])
}

/// The arrays that the code of a batch reads.
#[derive(Default)]
struct Inputs {
    /// Expressions for the arrays, one per input.
    numbers: Vec<TokenStream>,
    /// The list of arguments.
    arguments: Vec<TokenStream>,
    /// Statements that collect the inputs of each argument into an array.
    taken: Vec<TokenStream>,
    /// How many of the arrays, from the first on, must be given.
    required: usize,
}

impl Inputs {
    fn of(program: &Program, krate: &syn::Path) -> Self {
        let mut all = Self::default();
        for array in program.arrays_without_parameters() {
            let length = array.elements.len();
            let first = all.numbers.len();
            let places = (first..first + length).map(Literal::usize_unsuffixed);
            let name = format_ident!("{}", array.name);
            all.taken.push(quote!(let #name = &[#(inputs[#places]),*];));
            let (numbers, arguments) = inputs(array.name, length, krate);
            all.numbers.extend(numbers);
            all.arguments.extend(arguments);
            if array.name != "wrenches" {
                all.required = all.numbers.len();
            }
        }
        all
    }
}

/// Returns an expression for the arrays of the results, and the statement that must precede it.
fn elements(answers: &[Answer]) -> (Option<TokenStream>, TokenStream) {
    if let [Answer(name, lengths)] = answers
        && lengths.len() == 1
    {
        return (None, format_ident!("{name}").into_token_stream());
    }
    let names = answers.iter().map(|Answer(name, _)| format_ident!("{name}")).collect::<Vec<_>>();
    let parts = answers.iter().zip(&names).map(|(Answer(_, lengths), name)| {
        let arrays = if lengths.len() == 1 { quote!(#name) } else { quote!(#name.as_flattened_mut()) };
        // borrowed again, because the arguments may have different lifetimes
        quote!(::core::iter::Iterator::map(#arrays.iter_mut(), |numbers| &mut **numbers))
    });
    let parts = parts.reduce(|all, part| quote!(::core::iter::Iterator::chain(#all, #part)));
    let elements = quote!({
        let mut all = #parts;
        ::core::array::from_fn(|_| ::core::iter::Iterator::next(&mut all).unwrap_or_default())
    });
    (Some(quote!(let (#(mut #names,)*) = (#(#names,)*);)), elements)
}

/// Returns the body of the method: the code for a state, and the call of the loop over states.
fn body(program: &Program, krate: &syn::Path, answers: &[Answer]) -> TokenStream {
    let scalar = quote!(#krate::Scalar);
    let body = rne_emit::Body::new(program, &scalar);
    let body = if program.form == Form::SevenSteps { body } else { body.all_fused() };
    let Inputs { numbers, arguments, taken, required } = Inputs::of(program, krate);
    let is_whole = answers.iter().all(|Answer(_, lengths)| lengths.len() == 1);
    let distinct = body.distinct();
    // if no result may be left out, every output is written, even one that is always zero
    let outputs: Vec<usize> = if is_whole {
        (0..distinct.len()).collect()
    } else {
        (0..distinct.len()).filter(|index| distinct[*index] == Some(*index)).collect()
    };
    let places = distinct.iter().enumerate().map(|(index, first)| {
        let wanted = if is_whole { Some(index) } else { *first };
        let place = wanted.and_then(|wanted| outputs.binary_search(&wanted).ok()).map(Literal::usize_unsuffixed);
        place.map_or_else(|| quote!(#krate::batch::ZERO), Literal::into_token_stream)
    });
    let [input_count, angle_count, output_count, element_count, required] =
        [numbers.len(), program.sines_and_cosines.len(), outputs.len(), distinct.len(), required]
            .map(Literal::usize_unsuffixed);
    let results = answers.iter().map(|Answer(name, lengths)| match &lengths[..] {
        [rows, columns] => quote!(#krate::batch::Argument::matrix(#name, #rows, #columns)),
        lengths => quote!(#krate::batch::Argument::vector(#name, #(#lengths)*)),
    });
    let (mutable, elements) = elements(answers);
    let (angles, statements) = (body.angles(), body.beyond_angles(&outputs));
    let of_angles = &taken[..1]; // the positions, which are the first argument
    quote! {
        struct Code;
        impl #krate::batch::BatchFunction<#input_count, #angle_count, #output_count, #element_count> for Code {
            const ARGUMENTS: &'static [#krate::batch::Argument] = &[#(#arguments),*];
            const RESULTS: &'static [#krate::batch::Argument] = &[#(#results),*];
            const REQUIRED: ::core::primitive::usize = #required;
            const PLACES: [::core::primitive::u16; #element_count] = [#(#places),*];
            const IS_WHOLE: ::core::primitive::bool = #is_whole;
            #[inline(always)]
            fn angles<T: #scalar>(&self, inputs: &[T; #input_count]) -> [T; #angle_count] {
                #(#of_angles)*
                #angles
            }
            #[inline(always)]
            fn outputs<T: #scalar>(
                &self,
                sin: &[T; #angle_count],
                cos: &[T; #angle_count],
                inputs: &[T; #input_count],
                outputs: &mut [T; #output_count],
            ) {
                #(#taken)*
                #statements
            }
        }
        #mutable
        #krate::batch::run(&Code, unit, [#(#numbers),*], #elements)
    }
}
