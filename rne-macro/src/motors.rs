//! The inherent functions of a type whose robot has a list `motors`: the maps between its motors and its joints.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use rne_model::Robot;

use crate::constants::number;
use crate::description;
use crate::implementation::Target;

impl Target<'_> {
    /// The functions between motors and joints; nothing for a robot without the list.
    pub(crate) fn motors(&self, robot: &Robot) -> TokenStream {
        if robot.drives.is_empty() {
            return TokenStream::new();
        }
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, krate, vis, scalar) = (&self.item.ident, self.krate, self.visibility(), self.number());
        let [dof, count] = [robot.dof(), robot.drives.len()].map(Literal::usize_unsuffixed);
        let names: Vec<&str> = robot.drives.iter().map(|drive| drive.name.as_str()).collect();
        let about_names = format!("Names of the motors of the list `motors`.{}", description::values(&names));
        let matrix = robot.motor_matrix();
        let rows = |argument: &str, rows: &[Vec<f64>]| {
            let argument = format_ident!("{argument}");
            let row = |row: &Vec<f64>| {
                let terms = row.iter().enumerate().filter(|(_, factor)| **factor != 0.0).map(|(index, factor)| {
                    let (index, factor) = (Literal::usize_unsuffixed(index), number(*factor));
                    quote!(#argument[#index] * <#scalar as #krate::Scalar>::from_f64(#factor))
                });
                let sum = terms.reduce(|sum, term| quote!(#sum + #term));
                sum.unwrap_or_else(|| quote!(<#scalar as #krate::Scalar>::from_f64(0.0)))
            };
            rows.iter().map(row).collect::<Vec<_>>()
        };
        let (speeds, torques) = (rows("qd", &matrix), rows("motor_torques", &transposed(&matrix, robot.dof())));
        let back = robot.inverse_motor_matrix().map(|inverse| {
            let torques = rows("tau", &transposed(&inverse, robot.dof()));
            quote! {
                /// The torques of the motors that work as `tau` on the joints, N m.
                #[must_use]
                #vis fn motor_torques<#scalar: #krate::Scalar>(&self, tau: &[#scalar; #dof]) -> [#scalar; #count] {
                    [#(#torques),*]
                }
            }
        });
        let str = quote!(::core::primitive::str);
        quote! {
            #[automatically_derived]
            #[allow(clippy::approx_constant, clippy::unused_self)] // a ratio of 3.14 is not π
            impl #impl_generics #ident #type_generics #where_clause {
                #[doc = #about_names]
                #vis const MOTOR_NAMES: [&'static #str; #count] = [#(#names),*];

                /// The speeds of the motors at rates of the joints, rad/s.
                #[must_use]
                #vis fn motor_speeds<#scalar: #krate::Scalar>(&self, qd: &[#scalar; #dof]) -> [#scalar; #count] {
                    [#(#speeds),*]
                }

                /// The torques that work on the joints when the motors exert `motor_torques`, N m or N.
                #[must_use]
                #vis fn joint_torques<#scalar: #krate::Scalar>(
                    &self,
                    motor_torques: &[#scalar; #count],
                ) -> [#scalar; #dof] {
                    [#(#torques),*]
                }

                #back
            }
        }
    }
}

fn transposed(rows: &[Vec<f64>], columns: usize) -> Vec<Vec<f64>> {
    (0..columns).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}
