//! Lints of a robot file, and of what stands beside it, as warnings of the compiler.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{quote, quote_spanned};
use rne_model::{Diagnostic, Report};
use syn::{Attribute, DeriveInput, Meta};

/// Largest number of warnings to print.
const SAID: usize = 8;

/// One warning for each lint, at the place of the robot in the attribute.
///
/// Stable Rust lets a macro refuse a program, not warn. A use of a deprecated constant is a warning that carries a text
/// of ours. It is shown where its tokens have the span of something that the user wrote, as it is: what a derive itself
/// resolves is exempt. Of the derives of one struct the first says it.
pub(crate) fn warnings(lints: &Report, item: &DeriveInput, place: Span) -> TokenStream {
    if !is_first(item, place) {
        return TokenStream::new();
    }
    let mut notes: Vec<String> = lints.warnings().take(SAID).map(|lint| note(&lints.name, lint)).collect();
    let more = lints.warnings().count().saturating_sub(SAID);
    if more > 0 {
        notes.push(format!("{}: and {more} more warnings; `rne check` shows them all", lints.name));
    }
    used(&notes, item, place)
}

/// The warning that the tests compare with no golden file, although one is nearly there.
pub(crate) fn misnamed_golden(found: &str, right: &str, item: &DeriveInput, place: Span) -> TokenStream {
    let note =
        format!("{found} is not the golden file of this robot, and no test reads it\ndid you mean to name it {right}?");
    used(&[note], item, place)
}

fn used(notes: &[String], item: &DeriveInput, place: Span) -> TokenStream {
    let levels: Vec<&Attribute> = item.attrs.iter().filter(|attribute| is_level(attribute)).collect();
    let used = notes.iter().map(|note| {
        let body = quote_spanned! {place=>
            const _: () = {
                #[deprecated(note = #note)]
                const ROBOT_FILE: () = ();
                ROBOT_FILE
            };
        };
        quote!(#(#levels)* #body)
    });
    quote!(#(#used)*)
}

/// Whether no other derive of this struct has been expanded. They all are in one process; where a process lives longer,
/// as in editors, nobody is told the source file, and each derive counts as the first.
fn is_first(item: &DeriveInput, place: Span) -> bool {
    static KNOWN: Mutex<Vec<(PathBuf, usize, usize, String)>> = Mutex::new(Vec::new());
    if !proc_macro::is_available() {
        return true;
    }
    let place = place.unwrap();
    let Some(file) = place.local_file() else { return true };
    let here = (file, place.line(), place.column(), item.ident.to_string());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let is_first = !known.contains(&here);
    if is_first {
        known.push(here);
    }
    is_first
}

fn note(name: &str, lint: &Diagnostic) -> String {
    let help = lint.help.as_ref().map(|help| format!("\n{help}")).unwrap_or_default();
    format!("{name}:{}:{}: {}{help}", lint.line, lint.column, lint.message)
}

/// Whether an attribute of the struct decides about these warnings: it holds for the struct alone, so it is repeated.
fn is_level(attribute: &Attribute) -> bool {
    let path = attribute.path();
    let Meta::List(list) = &attribute.meta else { return false };
    let is_level = ["allow", "warn", "deny", "forbid"].iter().any(|level| path.is_ident(level));
    let about =
        |token: TokenTree| matches!(token, TokenTree::Ident(name) if name == "deprecated" || name == "warnings");
    is_level && list.tokens.clone().into_iter().any(about)
}
