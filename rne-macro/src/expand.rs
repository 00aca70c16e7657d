//! The expansion: an item in, implementations out.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use proc_macro2::{Span, TokenStream};
use quote::quote;
use rne_codegen::plan::{self, Choice, Fingerprint, PlanFile};
use rne_codegen::{Capability, Form, Program};
use rne_model::{Report, Robot, check_bytes, check_bytes_with_run_time};
use syn::{Data, DeriveInput};

use crate::attribute::{Attribute, Limit, Source};
use crate::error::{Errors, describe};
use crate::implementation::Target;
use crate::location::{self, RobotFile};
use crate::parameters::Parameters;

/// The derive of a capability.
///
/// Every mistake becomes one `compile_error!`; beside them stands an implementation, of the robot as far as it is
/// known, so that the code that uses it causes no errors of its own.
pub(crate) fn capability(capability: Capability, input: TokenStream) -> TokenStream {
    let item: DeriveInput = match syn::parse2(input) {
        Ok(item) => item,
        Err(error) => return error.to_compile_error(),
    };
    let mut errors = Errors::default();
    is_struct(&item, &mut errors);
    let attribute = Attribute::parse(&item, &mut errors);
    let parameters = Parameters::of(&item, &mut errors);
    let loaded = attribute.source.as_ref().map(|source| load(source, &parameters, &mut errors)).unwrap_or_default();
    let compiled = loaded.robot.and_then(|robot| {
        let span = attribute.source.as_ref().map_or_else(Span::call_site, Source::span);
        // what makes no choices is compiled without
        let is_planned = capability.functions().iter().any(|&function| plan::is_planned(function));
        let form = if is_planned { attribute.form } else { Form::SevenSteps };
        let choice = choice(&robot, form, loaded.plan.as_ref(), span, &mut errors)?;
        let programs = programs(&robot, capability, attribute.form, &choice, span, &mut errors)?;
        Some((robot, programs))
    });
    let target = Target { item: &item, krate: &attribute.krate };
    let code = match &compiled {
        Some((robot, programs)) => {
            if let (Capability::InverseDynamics, Some(limit), Some(program)) =
                (capability, attribute.max_ops, programs.first())
            {
                is_within(limit, program, &mut errors);
            }
            target.robot(robot, capability, programs, &parameters)
        }
        None => target.stub(capability, loaded.joints),
    };
    // a plan that is not used is not watched
    let plan = loaded.plan.filter(|_| attribute.form != Form::SevenSteps).map(|file| watch(&file.absolute));
    let watched = loaded.watched;
    let errors = errors.into_tokens();
    quote!(#errors #watched #plan #code)
}

fn is_struct(item: &DeriveInput, errors: &mut Errors) {
    let (kind, span) = match &item.data {
        Data::Struct(_) => return,
        Data::Enum(data) => ("an enum", data.enum_token.span),
        Data::Union(data) => ("a union", data.union_token.span),
    };
    errors.at_span(span, format!("a robot is a struct, such as `struct {};`, not {kind}", item.ident));
}

fn is_within(limit: Limit, program: &Program, errors: &mut Errors) {
    let count = program.operations();
    if count.total() > limit.operations {
        errors.at_span(
            limit.span,
            format!(
                "`{}` of {} takes {} operations ({} products and {} sums), more than `max_ops = {}`",
                program.function,
                program.robot,
                count.total(),
                count.mul,
                count.add,
                limit.operations
            ),
        );
    }
}

/// What became of a robot file.
#[derive(Default)]
pub(crate) struct Loaded {
    /// The robot, if the file is valid.
    pub(crate) robot: Option<Robot>,
    /// Makes the compiler watch the file.
    watched: TokenStream,
    /// The plan file beside it.
    pub(crate) plan: Option<RobotFile>,
    /// How many joints it has, or seems to have if it is invalid.
    joints: usize,
}

pub(crate) fn load(source: &Source, parameters: &Parameters, errors: &mut Errors) -> Loaded {
    let (name, bytes, watched, plan) = match source {
        Source::Yaml(text) => ("<inline yaml>".to_owned(), text.value().into_bytes(), TokenStream::new(), None),
        Source::Path(path) => match location::read(path) {
            Ok(file) => {
                let plan = location::plan_beside(&file);
                let plan = plan.map_err(|unreadable| errors.at(path, unreadable)).unwrap_or_default();
                (file.shown, file.bytes, watch(&file.absolute), plan)
            }
            Err(missing) => {
                errors.at(path, missing);
                return Loaded::default();
            }
        },
    };
    let names = parameters.names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let checked = check_bytes(&name, &bytes).and_then(|checked| {
        let known: Vec<&str> = checked.robot.parameters.iter().map(|(name, _)| name.as_str()).collect();
        match parameters.check(&known, errors) {
            _ if names.is_empty() => Ok(Some(checked)),
            true => check_bytes_with_run_time(&name, &bytes, &names).map(Some),
            false => Ok(None),
        }
    });
    match checked {
        Ok(Some(checked)) => Loaded { joints: checked.robot.dof(), robot: Some(checked.robot), watched, plan },
        // a field is no parameter, which has been said
        Ok(None) => Loaded { watched, ..Loaded::default() },
        Err(report) => {
            let joints = guess_joints(&report);
            errors.at_span(source.span(), describe(report));
            Loaded { robot: None, watched, plan: None, joints }
        }
    }
}

/// Every joint has a `dh`.
fn guess_joints(report: &Report) -> usize {
    report.text.matches("dh:").count()
}

/// Tells the compiler that the code depends on the file: it is compiled again when the file changes.
fn watch(file: &Path) -> TokenStream {
    // A path that is not Unicode cannot be written in source code.
    let Some(file) = file.to_str() else { return TokenStream::new() };
    quote!(
        const _: &[::core::primitive::u8] = ::core::include_bytes!(#file);
    )
}

/// The choices of the form: those of the plan file, or those that a build makes by itself.
pub(crate) fn choice(
    robot: &Robot,
    form: Form,
    plan: Option<&RobotFile>,
    span: Span,
    errors: &mut Errors,
) -> Option<Choice> {
    match (form, plan) {
        // whatever the choices, the seven steps make none
        (Form::SevenSteps, _) => Some(Choice::none(robot)),
        (Form::Reduced | Form::Rewritten, None) => Some(default_choice(robot)),
        (Form::Reduced | Form::Rewritten, Some(file)) => {
            let Ok(text) = std::str::from_utf8(&file.bytes) else {
                errors.at_span(span, format!("`{}` is no text in UTF-8", file.shown));
                return None;
            };
            let plan = PlanFile::read(&file.shown, text, robot);
            plan.map(Choice::from).map_err(|report| errors.at_span(span, describe(report))).ok()
        }
    }
}

/// The choice that a build makes by itself. The derives of one crate are expanded in one process, so it is made once
/// per robot.
fn default_choice(robot: &Robot) -> Choice {
    static KNOWN: Mutex<Vec<(Fingerprint, Choice)>> = Mutex::new(Vec::new());
    let print = plan::fingerprint(robot);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, choice)) = known.iter().find(|(other, _)| *other == print) {
        return choice.clone();
    }
    let choice = Choice::default_of(robot);
    known.push((print, choice.clone()));
    choice
}

fn programs(
    robot: &Robot,
    capability: Capability,
    form: Form,
    choice: &Choice,
    span: Span,
    errors: &mut Errors,
) -> Option<Vec<Program>> {
    let programs: Result<Vec<_>, _> =
        capability.functions().iter().map(|&function| choice.compile(robot, function, form)).collect();
    programs.map_err(|error| errors.at_span(span, format!("{}: {error}", robot.name))).ok()
}

impl Source {
    fn span(&self) -> Span {
        match self {
            Self::Path(literal) | Self::Yaml(literal) => literal.span(),
        }
    }
}
