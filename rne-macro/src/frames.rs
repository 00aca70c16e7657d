//! The code for the named frames and the link frames of a robot.

use proc_macro2::{Literal, Span, TokenStream};
use quote::quote;
use rne_codegen::{Compiler, Form, Function, Program};
use rne_model::Robot;

use crate::description;
use crate::error::{Errors, not_compiled};
use crate::implementation::Target;
use crate::parameters::Parameters;

/// The documentation of the function `frame`.
const ABOUT_FRAME: &str = "\
    The place of a frame, for `jacobian_of` and the other methods of `FrameKinematics`. The name is that of a frame in \
    the list `frames` of the robot file, or that of a joint for its link frame. In a constant, \
    `{ Self::frame(\"NAME\") }`, an unknown name is a compile error.\n\n# Panics\n\n\
    Where the robot file has no frame of this name.";

impl Target<'_> {
    /// Returns all code for the frames of a robot. If a program cannot be compiled, adds an error to `errors` and
    /// returns `None`.
    pub(crate) fn frames(
        &self,
        robot: &Robot,
        form: Form,
        parameters: &Parameters,
        span: Span,
        errors: &mut Errors,
    ) -> Option<TokenStream> {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, krate, dof) = (&self.item.ident, self.krate, Literal::usize_unsuffixed(robot.dof()));
        let mut implementations = TokenStream::new();
        for (index, frame) in robot.frame_ids().enumerate() {
            let robot = robot.clone().at_frame(frame);
            let compiler = Compiler::new(&robot);
            let programs: Result<Vec<Program>, _> =
                Function::of_frames().map(|function| compiler.compile(function, form)).collect();
            let programs = programs.map_err(|error| errors.at_span(span, not_compiled(&robot.name, &error))).ok()?;
            implementations.extend(self.at_frame(index, &robot, &programs, parameters));
        }
        let names: Vec<&str> = robot.frame_ids().map(|frame| robot.frame_name(frame)).collect();
        let count = robot.frames.len();
        let of_list = (0..count).map(|index| {
            let index = Literal::usize_unsuffixed(index);
            quote!(<Self as #krate::AtFrame<#dof, #index>>::pose_at_frame(self, q))
        });
        let (number, listed, described) = (self.number(), &names[..count], description::values(&names[..count]));
        let unknown = format!(" {}: {}", robot.name, robot.known_frames());
        let about_names = format!("Names of the list `frames`, in the order of `frame_poses`.{described}");
        let (vis, length) = (self.visibility(), Literal::usize_unsuffixed(count));
        let (str, usize) = (quote!(::core::primitive::str), quote!(::core::primitive::usize));
        Some(quote! {
            #implementations

            #[automatically_derived]
            impl #impl_generics #krate::FrameKinematics<#dof, #length> for #ident #type_generics #where_clause {
                fn frame_poses<#number: #krate::Scalar>(
                    &self,
                    q: &[#number; #dof],
                ) -> [#krate::Pose<#number>; #length] {
                    let _ = q;
                    [#(#of_list),*]
                }
            }

            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                #[doc = #about_names]
                #vis const FRAME_NAMES: [&'static #str; #length] = [#(#listed),*];
                #[doc = #ABOUT_FRAME]
                #[must_use]
                #vis const fn frame(name: &#str) -> #usize {
                    let names = [#(#names),*];
                    match #krate::frame_index(&names, name) {
                        ::core::option::Option::Some(index) => index,
                        ::core::option::Option::None => #krate::unknown_frame(&names, name, #unknown),
                    }
                }
            }
        })
    }

    /// The implementation of `AtFrame` for one frame.
    fn at_frame(&self, index: usize, robot: &Robot, programs: &[Program], parameters: &Parameters) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, krate) = (&self.item.ident, self.krate);
        let [dof, index] = [robot.dof(), index].map(Literal::usize_unsuffixed);
        let operations = description::operations(programs);
        let methods = programs.iter().map(|program| self.method(robot, program, parameters));
        quote! {
            #[doc = #operations]
            #[automatically_derived]
            #[allow(clippy::approx_constant)]
            #[allow(clippy::inline_always)]
            impl #impl_generics #krate::AtFrame<#dof, #index> for #ident #type_generics #where_clause {
                #(#methods)*
            }
        }
    }

    /// Returns a stub for a robot that is not known, as [`Target::stub`] does. Its list of frames is empty: with an
    /// unknown length, the compiler could not choose the trait for a call of `FrameKinematics`.
    pub(crate) fn frames_stub(&self) -> TokenStream {
        let (ident, krate, vis) = (&self.item.ident, self.krate, self.visibility());
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let mut generics = self.item.generics.clone();
        generics.params.push(syn::parse_quote!(const __JOINTS: ::core::primitive::usize));
        generics.params.push(syn::parse_quote!(const __FRAME: ::core::primitive::usize));
        let (with_both, ..) = generics.split_for_impl();
        let mut generics = self.item.generics.clone();
        generics.params.push(syn::parse_quote!(const __JOINTS: ::core::primitive::usize));
        let (with_joints, ..) = generics.split_for_impl();
        let joints = quote!(__JOINTS);
        let methods =
            Function::of_frames().map(|function| self.signature_at_frame(function, &joints, &quote!(loop {})));
        let number = self.number();
        quote! {
            #[automatically_derived]
            impl #with_both #krate::AtFrame<__JOINTS, __FRAME> for #ident #type_generics #where_clause {
                #(#methods)*
            }

            #[automatically_derived]
            impl #with_joints #krate::FrameKinematics<__JOINTS, 0> for #ident #type_generics #where_clause {
                fn frame_poses<#number: #krate::Scalar>(
                    &self,
                    _: &[#number; __JOINTS],
                ) -> [#krate::Pose<#number>; 0] {
                    loop {}
                }
            }

            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                #vis const FRAME_NAMES: [&'static ::core::primitive::str; 0] = [];
                #vis const fn frame(_: &::core::primitive::str) -> ::core::primitive::usize {
                    0
                }
            }
        }
    }
}
