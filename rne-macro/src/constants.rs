//! The associated constants of a type, and numbers as source code.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{format_ident, quote};
use rne_codegen::{Function, Operations, Program};
use rne_model::Robot;
use syn::Visibility;

use crate::description;
use crate::implementation::Target;

/// The constants of a type.
pub(crate) struct Constants {
    /// The description of the robot, for the documentation.
    description: Option<String>,
    name: String,
    joint_names: Vec<String>,
    position_limits: Vec<(f64, f64)>,
    velocity_limits: Vec<f64>,
    effort_limits: Vec<f64>,
    operations: Operations,
}

impl Constants {
    pub(crate) fn of(robot: &Robot, programs: &[Program]) -> Self {
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

    pub(crate) fn unknown(joints: usize) -> Self {
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

impl Target<'_> {
    /// Returns the visibility of the type. Its `pub` gets a span of generated code. With the user's span, the compiler
    /// would warn of each constant that is never used.
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
    pub(crate) fn counts(&self, programs: &[Program]) -> TokenStream {
        self.counts_of(programs.iter().map(|program| (program.function, program.operations())))
    }

    pub(crate) fn counts_of(&self, counts: impl Iterator<Item = (Function, Operations)>) -> TokenStream {
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
    pub(crate) fn passive_joints(&self, robot: &Robot) -> TokenStream {
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

    pub(crate) fn constants(&self, constants: &Constants) -> TokenStream {
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

/// A number that reads back as the same bits, or infinity.
pub(crate) fn number(value: f64) -> TokenStream {
    let sign = value.is_sign_negative().then(|| quote!(-));
    if value.is_infinite() {
        return quote!(#sign ::core::primitive::f64::INFINITY);
    }
    let magnitude = Literal::f64_unsuffixed(value.abs());
    quote!(#sign #magnitude)
}
