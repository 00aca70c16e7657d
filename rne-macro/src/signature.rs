//! The methods of a trait without their bodies: names, arguments, types and sizes.

use proc_macro2::{Group, Ident, Literal, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};
use rne_codegen::{Argument, Capability, Function, Length, Shape, Sizes};
use syn::GenericParam;

use crate::implementation::Target;

impl Target<'_> {
    /// Returns the constant parameters of a capability's trait: the number of joints, and other sizes that it needs.
    pub(crate) fn sizes(&self, capability: Capability, dof: &TokenStream) -> TokenStream {
        let sizes = capability.lengths().map(|length| self.size(length, dof));
        quote!(#(#sizes),*)
    }

    /// Returns the arguments of a function with their types. References have the given lifetime, and `T` is the scalar.
    pub(crate) fn arguments(
        &self,
        function: Function,
        dof: &TokenStream,
        lifetime: &TokenStream,
    ) -> Vec<(Ident, TokenStream)> {
        let name_and_type = |argument: &Argument| {
            let kind = self.returned(argument.shape(), dof);
            let reference = (!argument.is_number()).then(|| quote!(&#lifetime));
            (format_ident!("{}", argument.name()), quote!(#reference #kind))
        };
        function.arguments().iter().map(name_and_type).collect()
    }

    /// Returns a method of the trait with the given body; `T` is the scalar.
    pub(crate) fn signature(&self, function: Function, dof: &TokenStream, body: &TokenStream) -> TokenStream {
        self.signature_named(function.name(), function, dof, body)
    }

    /// Returns a method of the trait `AtFrame`, as [`Self::signature`] does for other traits.
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
    pub(crate) fn returned(&self, shape: &Shape, dof: &TokenStream) -> TokenStream {
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

    /// Returns a length as it is written in a type.
    pub(crate) fn size(&self, length: Length, dof: &TokenStream) -> TokenStream {
        match length {
            Length::Joints => dof.clone(),
            Length::Velocities => of_joints(length, dof, quote!(__VELOCITIES)),
            Length::Bodies => of_joints(length, dof, quote!(__BODIES)),
            Length::Tips => self.tips.clone(),
            Length::Passive => self.passive.clone(),
            Length::Equations => self.equations.clone(),
            Length::Fixed(length) => Literal::usize_unsuffixed(length).into_token_stream(),
        }
    }

    /// Returns a name for the scalar of a method that no parameter of the type has.
    pub(crate) fn number(&self) -> Ident {
        if self.is_taken("T") { format_ident!("{}", self.free_name()) } else { format_ident!("T") }
    }

    /// Whether the user's type has a parameter with this name.
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
}

/// Returns a length that depends only on the number of joints; `unknown` if this number is not known.
fn of_joints(length: Length, dof: &TokenStream, unknown: TokenStream) -> TokenStream {
    let dof = dof.to_string().parse::<usize>();
    let of = |dof| length.of(Sizes { dof, tips: 0, passive: 0, equations: 0 });
    dof.map_or(unknown, |dof| Literal::usize_unsuffixed(of(dof)).into_token_stream())
}

/// Returns the tokens with every identifier `from` replaced.
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
