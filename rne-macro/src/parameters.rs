//! Run-time parameters: fields of the struct that are parameters of the robot file.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use syn::spanned::Spanned;
use syn::{Data, DeriveInput, Ident, Path, Type};

use crate::error::Errors;

/// The fields of the struct that are run-time parameters, in their order.
#[derive(Default)]
pub(crate) struct Parameters {
    fields: Vec<Field>,
}

struct Field {
    ident: Ident,
    kind: Type,
}

impl Parameters {
    /// Returns the named fields of a struct, except those with `#[robot(skip)]` and those of type `PhantomData`.
    pub(crate) fn of(item: &DeriveInput, errors: &mut Errors) -> Self {
        let Data::Struct(data) = &item.data else { return Self::default() };
        let mut fields = Vec::new();
        for field in &data.fields {
            if is_skipped(field, errors) || is_phantom(&field.ty) {
                continue;
            }
            let Some(ident) = &field.ident else {
                errors.at(
                    field,
                    "a field without a name cannot be a parameter of the robot file: rne finds the parameter by the \
                     name of the field. Name the field, or write `#[robot(skip)]` before it if it has another purpose",
                );
                continue;
            };
            fields.push(Field { ident: ident.clone(), kind: field.ty.clone() });
        }
        Self { fields }
    }

    pub(crate) fn names(&self) -> Vec<String> {
        self.fields.iter().map(|field| unraw(&field.ident)).collect()
    }

    /// Reports which fields are not parameters of the file. `known` are the parameters that it has.
    pub(crate) fn check(&self, known: &[&str], errors: &mut Errors) -> bool {
        let before = errors.len();
        for Field { ident, .. } in &self.fields {
            let name = unraw(ident);
            if known.contains(&name.as_str()) {
                continue;
            }
            let there = match known {
                [] => "the robot file has no `parameters`".to_owned(),
                _ => format!(
                    "the robot file has {}",
                    known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
                ),
            };
            errors.at(
                ident,
                format!(
                    "`{name}` is not a parameter of the robot file: {there}. A field is a parameter whose value is \
                     given at run time; for any other field, write `#[robot(skip)]` before it"
                ),
            );
        }
        errors.len() == before
    }

    /// Returns a statement that reads the fields into an array `parameters`, which the body of a method expects.
    pub(crate) fn read(&self, krate: &Path) -> TokenStream {
        if self.fields.is_empty() {
            return TokenStream::new();
        }
        let values = self.fields.iter().map(|Field { ident, kind }| {
            let span = kind.span();
            quote_spanned!(span=> #krate::RunTimeParameter::to::<T>(self.#ident))
        });
        let (parameters, count) = (format_ident!("parameters"), Literal::usize_unsuffixed(self.fields.len()));
        quote!(let #parameters: &[T; #count] = &[#(#values),*];)
    }
}

fn unraw(ident: &Ident) -> String {
    use syn::ext::IdentExt;
    ident.unraw().to_string()
}

fn is_skipped(field: &syn::Field, errors: &mut Errors) -> bool {
    let mut skipped = false;
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("robot")) {
        let parsed = attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident("skip") {
                skipped = true;
                Ok(())
            } else {
                Err(meta.error(
                    "the only attribute of a field is `#[robot(skip)]`: it excludes the field from the run-time \
                     parameters",
                ))
            }
        });
        if let Err(error) = parsed {
            errors.push(error);
        }
    }
    skipped
}

fn is_phantom(kind: &Type) -> bool {
    matches!(kind, Type::Path(path) if path.path.segments.last().is_some_and(|last| last.ident == "PhantomData"))
}
