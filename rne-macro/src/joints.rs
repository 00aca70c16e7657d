//! The code for the names of the joints: their enum, and their order in the arrays of another program.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use rne_model::{JointIdentifier, Robot, one_line};

use crate::implementation::Target;

impl Target<'_> {
    /// The enum of the joints, `JOINTS` and the functions `order`.
    pub(crate) fn joints(&self, robot: &Robot) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, krate, vis) = (&self.item.ident, self.krate, self.visibility());
        let dof = Literal::usize_unsuffixed(robot.dof());
        let (str, usize) = (quote!(::core::primitive::str), quote!(::core::primitive::usize));
        let names: Vec<String> =
            robot.independent_joints().map(|joint| format!("`{}`", one_line(&joint.name))).collect();
        let remark = format!("; the joints of {} are {}", robot.name, names.join(", "));
        let followers = robot.joints.iter().filter_map(|joint| {
            let coupling = joint.coupling.as_ref()?;
            let followed = |(followed, _): &(usize, f64)| format!("`{}`", one_line(&robot.joints[*followed].name));
            let followed = coupling.follows.iter().map(followed).collect::<Vec<_>>().join(" and ");
            let words =
                format!("` follows {followed}, so q has no element for it; leave it out, or call `order_with_others`");
            let name = &joint.name;
            Some(quote!([#name, #words]))
        });
        let followers = quote!([#(#followers),*]);
        let functions = [("order", ORDER, false), ("order_with_others", ORDER_WITH_OTHERS, true)];
        let functions = functions.map(|(name, about, takes_others)| {
            let name = Ident::new(name, Span::call_site());
            quote! {
                #[doc = #about]
                #[must_use]
                #vis const fn #name<const __NAMES: #usize>(names: [&#str; __NAMES]) -> [#usize; #dof] {
                    match #krate::joint_order(&Self::JOINTS, &names, #takes_others) {
                        ::core::result::Result::Ok(order) => order,
                        ::core::result::Result::Err(error) => error.stop(&Self::JOINTS, #remark, &#followers),
                    }
                }
            }
        });
        let name = self.type_name();
        let about = format!(
            "The joints of [`{name}`]. `joint as usize` is the place of a joint in arrays, `{name}::JOINTS[joint as \
             usize]` its name in the robot file."
        );
        let names = robot.independent_joints().map(|joint| joint.name.as_str());
        let joints = self.names_enum("Joint", &about, names);
        quote! {
            #joints

            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                /// Names of the joints, in the order of all arrays: `JOINT_NAMES` under a short name.
                #vis const JOINTS: [&'static #str; #dof] = Self::JOINT_NAMES;
                #(#functions)*
            }
        }
    }

    /// Returns an enum with a variant for each name of a joint or tip. If several names give one identifier, which is
    /// reported elsewhere as an error, only the first is used.
    pub(crate) fn names_enum<'n>(
        &self,
        suffix: &str,
        about: &str,
        names: impl Iterator<Item = &'n str>,
    ) -> TokenStream {
        let vis = self.visibility();
        let name = self.type_name();
        let all = Ident::new(&format!("{name}{suffix}"), Span::call_site());
        // allowed only where it is needed, because a lint that the user forbids cannot be allowed here
        let is_camel_case = name.starts_with(char::is_uppercase) && !name.contains('_');
        let name_of_the_user = (!is_camel_case).then(|| quote!(#[allow(non_camel_case_types)]));
        let mut known = BTreeSet::new();
        let (variants, uses): (Vec<_>, Vec<_>) = names
            .enumerate()
            .filter_map(|(index, name)| {
                let JointIdentifier { camel_case, .. } = JointIdentifier::of(name, index);
                let (about, variant) = (rne_emit::markdown(name), Ident::new(&camel_case, Span::call_site()));
                known.insert(camel_case).then(|| (quote!(#[doc = #about] #variant), quote!(#all::#variant)))
            })
            .unzip();
        let count = uses.len();
        quote! {
            #[doc = #about]
            #[derive(
                ::core::clone::Clone,
                ::core::marker::Copy,
                ::core::fmt::Debug,
                ::core::cmp::PartialEq,
                ::core::cmp::Eq,
                ::core::hash::Hash,
            )]
            #name_of_the_user
            #[allow(clippy::enum_variant_names)]
            #vis enum #all { #(#variants),* }
            // uses every variant, so that the compiler does not warn the user of unused ones
            const _: [#all; #count] = [#(#uses),*];
        }
    }

    /// The name of the type that a robot is derived for.
    pub(crate) fn type_name(&self) -> String {
        self.item.ident.to_string().trim_start_matches("r#").to_owned()
    }

    /// Returns the functions `order` for a robot that is not known; they return an array for any list.
    pub(crate) fn joints_stub(&self) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, vis) = (&self.item.ident, self.visibility());
        let (str, usize) = (quote!(::core::primitive::str), quote!(::core::primitive::usize));
        let functions = ["order", "order_with_others"].map(|name| {
            let name = Ident::new(name, Span::call_site());
            quote! {
                #vis const fn #name<const __NAMES: #usize, const __JOINTS: #usize>(
                    _: [&#str; __NAMES],
                ) -> [#usize; __JOINTS] {
                    [0; __JOINTS]
                }
            }
        });
        quote! {
            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                #(#functions)*
            }
        }
    }
}

const ORDER: &str = "The places of the joints in the list of names of another program, each name of the list being a \
    joint of this robot: `order[i]` is the place of joint `i`, so `q = order.map(|place| theirs[place])`. In a \
    constant, a name that is missing, unknown or there twice is a compile error. A joint that follows another one has \
    no element in `q`: leave it out, or call `order_with_others`.\n\n# Panics\n\n\
    At run time, where the compiler stops in a constant; `rne::joint_order` returns an error instead.";

const ORDER_WITH_OTHERS: &str = "As `order`, for a list that may also have names of other joints, such as a gripper's, \
    or of joints that follow others.\n\n# Panics\n\nAs `order`, but not for a name that is unknown.";
