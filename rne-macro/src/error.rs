//! Collects errors and passes them to the compiler.

use std::fmt::Display;
use std::path::Path;

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use rne_codegen::{CompileError, Remedy};
use rne_model::{Report, Severity, robot_of};

/// The errors found so far, in order.
#[derive(Default)]
pub(crate) struct Errors {
    found: Vec<syn::Error>,
}

impl Errors {
    pub(crate) fn push(&mut self, error: syn::Error) {
        self.found.push(error);
    }

    /// Adds an error at the place of these tokens.
    pub(crate) fn at(&mut self, tokens: &impl ToTokens, message: impl Display) {
        self.push(syn::Error::new_spanned(tokens, message));
    }

    /// Adds an error at this place.
    pub(crate) fn at_span(&mut self, span: Span, message: impl Display) {
        self.push(syn::Error::new(span, message));
    }

    pub(crate) fn len(&self) -> usize {
        self.found.len()
    }

    /// Returns every error as an invocation of `compile_error!`.
    pub(crate) fn into_tokens(self) -> TokenStream {
        self.found.iter().map(syn::Error::to_compile_error).collect()
    }
}

/// Returns why a function cannot be compiled, with the command that helps.
pub(crate) fn not_compiled(robot: &str, error: &CompileError) -> String {
    let remedy = match error.remedy() {
        Some(Remedy::RewriteAfresh) => "; `rne search ROBOT.yaml --rewrite --fresh` writes a new plan",
        Some(_) => "; `rne search ROBOT.yaml --fresh` finds another plan",
        None => "",
    };
    format!("{robot}: {error}{remedy}")
}

/// Returns a remedy as a command.
pub(crate) fn in_commands(remedy: &rne_model::Remedy) -> Option<String> {
    match remedy {
        rne_model::Remedy::ImportUrdf { file } => {
            let file = file.as_deref().unwrap_or("FILE");
            Some(format!("`rne import {file} -o robot.yaml` converts a URDF to a robot file"))
        }
        rne_model::Remedy::Repair => Some("`rne check --repair FILE` proposes edits".to_owned()),
        _ => None,
    }
}

/// Returns the errors in a robot file or a plan as text. Lints are left out, because they do not stop a build.
pub(crate) fn describe(mut report: Report) -> String {
    report.diagnostics.retain(|found| found.severity == Severity::Error);
    // An empty line keeps the second `error:` apart from the compiler's own.
    let what = if robot_of(Path::new(&report.name)).is_some() {
        "plan of this robot"
    } else if report.name.ends_with(".golden.csv") {
        "golden file of this robot"
    } else {
        "robot file"
    };
    let report = report.worded(in_commands);
    let report = match (what, robot_of(Path::new(&report.name))) {
        ("plan of this robot", Some(robot)) => report.with_help(&format!(
            "`rne search {} --fresh` ignores the wrong parts of the plan and searches again; if you delete the plan \
             file, the build chooses by itself",
            robot.display()
        )),
        _ => report,
    };
    format!("`{}` is not a valid {what}\n\n{}\n", report.name, report.render(false))
}
