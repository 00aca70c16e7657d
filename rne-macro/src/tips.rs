//! The code for the names of the tips: their enum and their list.

use proc_macro2::TokenStream;
use quote::quote;
use rne_model::Robot;

use crate::implementation::Target;

impl Target<'_> {
    /// The enum of the tips, and `TIPS`.
    pub(crate) fn tips(&self, robot: &Robot) -> TokenStream {
        let (impl_generics, type_generics, where_clause) = self.item.generics.split_for_impl();
        let (ident, vis, names) = (&self.item.ident, self.visibility(), robot.tip_names());
        let (str, count) = (quote!(::core::primitive::str), &self.tips);
        let name = self.type_name();
        let about = format!(
            "The tips of [`{name}`]. `tip as usize` is the place of a tip in arrays of wrenches, `{name}::TIPS[tip as \
             usize]` its name in the robot file."
        );
        let tips = self.names_enum("Tip", &about, names.iter().copied());
        quote! {
            #tips

            #[automatically_derived]
            impl #impl_generics #ident #type_generics #where_clause {
                /// Names of the tips, in the order of arrays of wrenches.
                #vis const TIPS: [&'static #str; #count] = [#(#names),*];
            }
        }
    }
}
