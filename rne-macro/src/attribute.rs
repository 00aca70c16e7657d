//! Reads the attribute `#[robot(…)]`.

use proc_macro2::Span;
use rne_codegen::Form;
use rne_model::did_you_mean;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser};
use syn::{DeriveInput, Ident, LitInt, LitStr, Meta, Path, Token};

use crate::error::Errors;

/// All entries of the attribute, with defaults for those that it leaves out.
pub(crate) struct Attribute {
    /// The source of the robot file; `None` if it is missing or wrong, which has been reported.
    pub(crate) source: Option<Source>,
    /// The form of the code.
    pub(crate) form: Form,
    /// The most operations allowed.
    pub(crate) max_ops: Option<Limit>,
    /// Whether the lints of the robot file are not reported.
    pub(crate) allow_lints: bool,
    /// Whether rotors belong to the arm.
    pub(crate) rotors: bool,
    /// Whether single calls are compiled for the compiled target only, so that they can be inlined.
    pub(crate) inline: bool,
    /// The place of the key `inspect`, which asks for the code as a file to read.
    pub(crate) inspect: Option<Span>,
    /// The place of the key `tests`, which asks for tests.
    pub(crate) tests: Option<Span>,
    /// The path of the crate `rne` in the user's crate.
    pub(crate) krate: Path,
}

/// The source of the robot file.
pub(crate) enum Source {
    /// A file with this path.
    Path(LitStr),
    /// This text.
    Yaml(LitStr),
    /// A shipped robot with this name.
    Builtin(LitStr),
}

/// A number of operations, and its place in the attribute.
#[derive(Clone, Copy)]
pub(crate) struct Limit {
    pub(crate) operations: usize,
    pub(crate) span: Span,
}

impl Attribute {
    /// Reads all attributes `#[robot(…)]` of the item. Errors are added to `errors`, and the entries with errors keep
    /// their defaults.
    pub(crate) fn parse(item: &DeriveInput, errors: &mut Errors) -> Self {
        let mut entries = Entries::default();
        let mut place = None;
        let before = errors.len();
        for attribute in item.attrs.iter().filter(|attribute| attribute.path().is_ident("robot")) {
            place.get_or_insert_with(|| attribute.path().clone());
            match &attribute.meta {
                Meta::List(list) => {
                    let parser = |input: ParseStream<'_>| {
                        entries.list(input, errors);
                        Ok(())
                    };
                    if let Err(error) = Parser::parse2(parser, list.tokens.clone()) {
                        errors.push(error);
                    }
                }
                Meta::Path(_) | Meta::NameValue(_) => {
                    errors.at(
                        &attribute.meta,
                        "write this as `#[robot(path = \"…\")]`, `#[robot(yaml = \"…\")]` or `#[robot(builtin = \
                         \"…\")]`",
                    );
                }
            }
        }
        match (&entries.source, place) {
            (Some(_), _) => {}
            // An entry had an error, which may be the reason why the robot is missing.
            (None, Some(_)) if errors.len() > before => {}
            (None, Some(place)) => {
                errors.at(&place, "the robot is missing: write `path = \"…\"`, `yaml = \"…\"` or `builtin = \"…\"`");
            }
            (None, None) => errors.at(
                &item.ident,
                "the robot is missing: write the attribute `#[robot(path = \"…\")]` with the path of the robot file, \
                 relative to this source file, or `#[robot(builtin = \"puma560\")]` with the name of a shipped robot",
            ),
        }
        Self {
            source: entries.source,
            form: entries.form.unwrap_or_default(),
            max_ops: entries.max_ops,
            allow_lints: entries.seen.iter().any(|key| key == "allow_lints"),
            rotors: entries.seen.iter().any(|key| key == "rotors"),
            inline: entries.seen.iter().any(|key| key == "inline"),
            inspect: entries.inspect,
            tests: entries.tests,
            krate: entries.krate.unwrap_or_else(|| syn::parse_quote!(::rne)),
        }
    }
}

const KEYS: [&str; 11] =
    ["path", "yaml", "builtin", "form", "max_ops", "rotors", "inline", "tests", "inspect", "allow_lints", "crate"];

/// Lists the keys in a sentence.
fn keys() -> String {
    format!("the keys are {}", KEYS.map(|key| format!("`{key}`")).join(", "))
}

#[derive(Default)]
struct Entries {
    seen: Vec<String>,
    source: Option<Source>,
    form: Option<Form>,
    max_ops: Option<Limit>,
    inspect: Option<Span>,
    tests: Option<Span>,
    krate: Option<Path>,
}

impl Entries {
    /// Reads a list `key = value, key = value`. An error in one entry does not prevent the reading of the next.
    fn list(&mut self, input: ParseStream<'_>, errors: &mut Errors) {
        while !input.is_empty() {
            if let Err(error) = self.entry(input) {
                errors.push(error);
                skip_entry(input);
            }
            if input.parse::<Option<Token![,]>>().is_ok_and(|comma| comma.is_none()) && !input.is_empty() {
                errors.push(input.error("a comma is missing before this"));
                if !input.peek(Ident::peek_any) {
                    skip_entry(input);
                }
            }
        }
    }

    fn entry(&mut self, input: ParseStream<'_>) -> syn::Result<()> {
        let key = key(input)?;
        let name = key.to_string();
        let mistake = |message: String| Err(syn::Error::new(key.span(), message));
        if self.seen.contains(&name) {
            return mistake(format!("`{name}` is given twice"));
        }
        self.seen.push(name.clone());
        let has_value = input.peek(Token![=]);
        if matches!(name.as_str(), "rotors" | "inline" | "tests" | "inspect" | "allow_lints") {
            match name.as_str() {
                "tests" => self.tests = Some(key.span()),
                "inspect" => self.inspect = Some(key.span()),
                _ => {}
            }
            let message = format!("`{name}` takes no value: write `{name}` alone to switch it on, or leave it out");
            return if has_value { mistake(message) } else { Ok(()) };
        }
        if !has_value {
            let example = match name.as_str() {
                "path" => "\"robots/arm.yaml\"",
                "yaml" => "\"…\"",
                "builtin" => "\"puma560\"",
                "form" => "\"seven_steps\"",
                "max_ops" => "500",
                _ => "::rne",
            };
            return mistake(format!("`{name}` needs a value: `{name} = {example}`"));
        }
        input.parse::<Token![=]>()?;
        match name.as_str() {
            "form" => {
                let text = string(input, &name)?;
                self.form =
                    Some(text.value().parse().map_err(|unknown| syn::Error::new(text.span(), format!("{unknown}")))?);
            }
            "max_ops" => self.max_ops = Some(limit(input)?),
            "crate" => self.krate = Some(path(input)?),
            of_source => {
                let text = string(input, of_source)?;
                if self.source.is_some() {
                    return mistake(
                        "give only one of `path` (a robot file), `yaml` (the text of a robot file) and `builtin` (a \
                         shipped robot)"
                            .to_owned(),
                    );
                }
                self.source = Some(match of_source {
                    "path" => Source::Path(text),
                    "yaml" => Source::Yaml(text),
                    _ => Source::Builtin(text),
                });
            }
        }
        Ok(())
    }
}

/// Reads the key of an entry.
fn key(input: ParseStream<'_>) -> syn::Result<Ident> {
    if !input.peek(Ident::peek_any) {
        let meant = input.fork().parse::<LitStr>();
        let meant = meant.map(|file| format!(": write `path = {:?}`", file.value())).unwrap_or_default();
        return Err(input.error(format!("a key is missing here{meant}; {}", keys())));
    }
    let key = Ident::parse_any(input)?;
    let name = key.to_string();
    if name == "urdf" {
        return Err(syn::Error::new(key.span(), of_urdf(input)));
    }
    if !KEYS.contains(&name.as_str()) {
        let meant = did_you_mean(&name, KEYS).map(|meant| format!("; did you mean `{meant}`?"));
        let message = format!("`{name}` is not a key of `#[robot(…)]`; {}", keys());
        return Err(syn::Error::new(key.span(), message + &meant.unwrap_or_default()));
    }
    Ok(key)
}

/// Returns advice for a URDF, with the name of the file if it was given.
fn of_urdf(input: ParseStream<'_>) -> String {
    let ahead = input.fork();
    let named = ahead.parse::<Token![=]>().and_then(|_| ahead.parse::<LitStr>());
    let urdf = named.map_or_else(|_| "arm.urdf".to_owned(), |urdf| urdf.value());
    let file = urdf.strip_suffix(".urdf").unwrap_or(&urdf);
    format!(
        "a URDF is not read by `#[robot(…)]`: convert it to a robot file with `rne import {urdf} -o {file}.yaml`, then \
         write `#[robot(path = \"{file}.yaml\")]`"
    )
}

/// Skips the rest of an entry, up to its comma.
fn skip_entry(input: ParseStream<'_>) {
    while !input.is_empty() && !input.peek(Token![,]) {
        // A token tree is always there: the input is not empty.
        let _: syn::Result<proc_macro2::TokenTree> = input.parse();
    }
}

fn string(input: ParseStream<'_>, key: &str) -> syn::Result<LitStr> {
    let start = input.fork();
    input.parse().map_err(|error: syn::Error| {
        let is_macro = start.parse::<Path>().is_ok() && start.peek(Token![!]);
        let hint = if is_macro { "; rne does not expand macros in it" } else { "" };
        syn::Error::new(error.span(), format!("the value of `{key}` must be a string literal{hint}"))
    })
}

fn limit(input: ParseStream<'_>) -> syn::Result<Limit> {
    let explain =
        |span| syn::Error::new(span, "the value of `max_ops` must be a whole number of operations, such as 500");
    let number: LitInt = input.parse().map_err(|error| explain(error.span()))?;
    let operations = number.base10_parse().map_err(|_| explain(number.span()))?;
    Ok(Limit { operations, span: number.span() })
}

/// A path, bare or in quotes.
fn path(input: ParseStream<'_>) -> syn::Result<Path> {
    let explain =
        |span| syn::Error::new(span, "the value of `crate` must be a path, such as `::rne` or `crate::dynamics`");
    if input.peek(LitStr) {
        let text: LitStr = input.parse()?;
        return text.parse_with(Path::parse_mod_style).map_err(|_| explain(text.span()));
    }
    let start = input.span();
    Path::parse_mod_style(input).map_err(|_| explain(start))
}
