//! `#[derive(BatchInverseDynamics)]`.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{ToTokens, quote};
use rne_codegen::{Capability, Form, Function, Target as Machine};
use syn::DeriveInput;

use crate::attribute::Attribute;
use crate::error::Errors;
use crate::expand::{compiler, load};
use crate::implementation::Target;
use crate::own_tests::{self, OF_BATCHES};
use crate::parameters::Parameters;

/// The second derive on a robot. What is wrong with the struct, its attribute or the file has been said by the first,
/// `InverseDynamics`, which the trait requires: nothing is reported here, and an unknown robot computes nothing.
///
/// The torques are written once more, for they must be inlined into code of each vector unit, and must not into every
/// place where a user calls the first derive's methods.
pub(crate) fn batch_inverse_dynamics(input: TokenStream) -> TokenStream {
    let item: DeriveInput = match syn::parse2(input) {
        Ok(item) => item,
        Err(error) => return error.to_compile_error(),
    };
    let mut said = Errors::default();
    let attribute = Attribute::parse(&item, &mut said);
    let parameters = Parameters::of(&item, &mut said);
    let loaded = attribute.source.as_ref().map(|source| load(source, &parameters, &mut said)).unwrap_or_default();
    let mut refused = Errors::default();
    if let Some(name) = parameters.names().first() {
        let message = format!(
            "a batch needs a robot whose numbers are all known at compile time, but `{name}` is a run-time parameter"
        );
        refused.at(&item.ident, message);
    }
    let refused = refused.into_tokens();
    let joints = loaded.robot.as_ref().filter(|robot| !robot.run_time.is_empty()).map(rne_model::Robot::dof);
    let program = loaded.robot.and_then(|robot| {
        if !robot.run_time.is_empty() {
            return None;
        }
        let (capability, span) = (Capability::InverseDynamics, Span::call_site());
        let robot = rne_model::Robot { rotors: attribute.rotors, ..robot };
        let compiler = compiler(&robot, capability, attribute.form, loaded.plan.as_ref(), span, &mut said)?;
        compiler.for_target(Machine::Throughput).compile(Function::InverseDynamics, attribute.form).ok()
    });
    let target = Target::new(&item, &attribute, None);
    let (ident, krate) = (&item.ident, &attribute.krate);
    let (impl_generics, type_generics, where_clause) = item.generics.split_for_impl();
    let number = target.number();
    let method = |dof: &TokenStream, body: &TokenStream| {
        quote! {
            fn inverse_dynamics_batch_on<#number: #krate::BatchScalar>(
                &self,
                unit: #krate::VectorUnit,
                q: [&[#number]; #dof],
                qd: [&[#number]; #dof],
                qdd: [&[#number]; #dof],
                tau: [&mut [#number]; #dof],
            ) -> ::core::result::Result<(), #krate::LengthMismatch> {
                #body
            }
        }
    };
    let Some(program) = program else {
        let mut generics = item.generics.clone();
        // the robot is known where it is only refused
        let dof = joints.map_or(quote!(__JOINTS), |joints| Literal::usize_unsuffixed(joints).into_token_stream());
        if joints.is_none() {
            generics.params.push(syn::parse_quote!(const __JOINTS: ::core::primitive::usize));
        }
        let (impl_generics, ..) = generics.split_for_impl();
        let method = method(&dof, &quote!(::core::result::Result::Ok(())));
        return quote! {
            #refused
            #[automatically_derived]
            #[allow(unused_variables)]
            impl #impl_generics #krate::BatchInverseDynamics<#dof> for #ident #type_generics #where_clause {
                #method
            }
        };
    };
    let [dof, angle_count] = [program.dof, program.sines_and_cosines.len()].map(Literal::usize_unsuffixed);
    let tests = own_tests::module(&item, &attribute, "BatchInverseDynamics", OF_BATCHES, program.dof, &loaded.text);
    let scalar = quote!(#krate::Scalar);
    let body = rne_emit::Body::new(&program, &scalar);
    let body = if program.form == Form::SevenSteps { body } else { body.all_fused() };
    let (angles, torques) = (body.angles(), body.beyond_angles());
    let method = method(
        &quote!(#dof),
        &quote! {
            struct Torques;
            impl #krate::batch::Torques<#dof, #angle_count> for Torques {
                #[inline(always)]
                fn angles<T: #scalar>(&self, q: &[T; #dof]) -> [T; #angle_count] {
                    #angles
                }
                #[inline(always)]
                fn torques<T: #scalar>(
                    &self,
                    sin: &[T; #angle_count],
                    cos: &[T; #angle_count],
                    q: &[T; #dof],
                    qd: &[T; #dof],
                    qdd: &[T; #dof],
                ) -> [T; #dof] {
                    #torques
                }
            }
            #krate::batch::run(&Torques, unit, q, qd, qdd, tau)
        },
    );
    quote! {
        #[automatically_derived]
        #[allow(clippy::approx_constant)] // a mass of 3.14 kg is not π
        #[allow(clippy::inline_always)] // into the code of each vector unit
        impl #impl_generics #krate::BatchInverseDynamics<#dof> for #ident #type_generics #where_clause {
            #method
        }
        #tests
    }
}
