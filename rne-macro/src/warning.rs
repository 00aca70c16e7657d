//! Reports lints of a robot file, and of files beside it, as warnings of the compiler.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{quote, quote_spanned};
use rne_model::{Diagnostic, Report};
use syn::{Attribute, DeriveInput, Meta};

use crate::error::in_commands;

/// The largest number of warnings that are reported.
const SAID: usize = 8;

/// Returns code that causes one warning for each lint, at the place of the robot in the attribute.
///
/// In stable Rust a macro can report errors, but no warnings. So the code uses a deprecated constant, and the text of
/// the warning is the note of its deprecation. The warning is only shown if its tokens have the span of something that
/// the user wrote, because paths in derived code are exempt. If a struct has several derives, the first one warns.
pub(crate) fn warnings(lints: &Report, item: &DeriveInput, place: Span) -> TokenStream {
    if !is_first(item, place) {
        return TokenStream::new();
    }
    let lints = lints.clone().worded(in_commands);
    let mut notes: Vec<String> = lints.warnings().take(SAID).map(|lint| note(&lints.name, lint)).collect();
    let more = lints.warnings().count().saturating_sub(SAID);
    if more > 0 {
        notes.push(format!("{}: and {more} more warnings; `rne check` shows them all", lints.name));
    }
    used(&notes, item, place)
}

/// Returns code that warns that the tests compare with no golden file, although there is a file with a similar name.
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

/// Whether no other derive of this struct has been expanded. The compiler expands all of them in one process. Processes
/// of editors live longer, but do not tell the source file, so that each derive counts as the first.
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

/// Whether an attribute of the struct sets the level of these warnings. It applies to the struct only, so it must be
/// repeated for the code that warns.
fn is_level(attribute: &Attribute) -> bool {
    let path = attribute.path();
    let Meta::List(list) = &attribute.meta else { return false };
    let is_level = ["allow", "warn", "deny", "forbid"].iter().any(|level| path.is_ident(level));
    let about =
        |token: TokenTree| matches!(token, TokenTree::Ident(name) if name == "deprecated" || name == "warnings");
    is_level && list.tokens.clone().into_iter().any(about)
}
