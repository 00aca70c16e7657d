//! Expands the derives: takes an item, and returns implementations.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use proc_macro2::{Span, TokenStream};
use quote::quote;
use rne_codegen::plan::PlanSet;
use rne_codegen::{Algorithm, Capability, CheckFor as _, Compiler, Form, Program};
use rne_model::{Checked, Reader, Report, Robot};
use rne_search::{Fingerprint, PlanFile};
use syn::{Data, DeriveInput};

use crate::attribute::{Attribute, Limit, Source};
use crate::error::{Errors, describe, not_compiled};
use crate::implementation::Target;
use crate::inspection;
use crate::location::{self, RobotFile};
use crate::own_tests;
use crate::parameters::Parameters;
use crate::warning::{misnamed_golden, warnings};

/// Expands the derive of a capability.
///
/// Every error becomes one `compile_error!`. An implementation is written in any case, for as much of the robot as is
/// known, so that code that uses it causes no further errors.
pub(crate) fn capability(capability: Capability, input: TokenStream) -> TokenStream {
    let Head { item, attribute, parameters, mut errors } = match Head::parse(input) {
        Ok(head) => head,
        Err(error) => return error.to_compile_error(),
    };
    own_tests::check(&item, &attribute, &parameters, &mut errors);
    let loaded = attribute.source.as_ref().map(|source| load(source, &parameters, &mut errors)).unwrap_or_default();
    if let (Capability::InverseDynamics, Some((report, source))) =
        (capability, loaded.one_identifier.zip(attribute.source.as_ref()))
    {
        let mistake = report.render(false);
        errors.at_span(source.span(), format!("`{}` gives two joints one identifier\n\n{mistake}\n", report.name));
    }
    let compiled =
        loaded.robot.and_then(|robot| compiled(robot, capability, &attribute, loaded.plan.as_ref(), &mut errors));
    let sizes = compiled.as_ref().map(|(robot, _)| rne_codegen::sizes_of(robot));
    let target = Target::new(&item, &attribute, sizes);
    let code = match &compiled {
        Some((robot, programs)) => {
            if let (Capability::InverseDynamics, Some(limit), Some(program)) =
                (capability, attribute.max_ops, programs.first())
            {
                is_within(limit, program, &mut errors);
            }
            if let Some(span) = attribute.inspect
                && let Err(error) = inspection::write(robot, capability, attribute.form, programs)
            {
                errors.at_span(span, format!("the readable code for `inspect` cannot be written: {error}"));
            }
            let code = target.robot(robot, capability, programs, &parameters);
            let golden = loaded.golden.as_ref().filter(|_| capability == Capability::InverseDynamics);
            let golden = golden.filter(|_| attribute.tests.is_some()).map(|file| {
                let watched = watch(file);
                let test = own_tests::golden(&item, &attribute, file, robot.dof(), &mut errors);
                quote!(#watched #test)
            });
            let (name, laws) = (capability.name(), own_tests::laws(capability));
            let functions = capability.functions();
            let tests = own_tests::module(&item, &attribute, name, functions, laws, robot.dof(), &loaded.text);
            quote!(#code #tests #golden)
        }
        None => target.stub(capability, loaded.joints),
    };
    // a user cannot change a shipped file, so its lints are not reported
    let is_silent = attribute.allow_lints || matches!(attribute.source, Some(Source::Builtin(_)));
    let said = if is_silent { None } else { attribute.source.as_ref().zip(loaded.lints.as_ref()) };
    let warnings = said.map(|(source, lints)| warnings(lints, &item, source.span()));
    let asks = capability == Capability::InverseDynamics && attribute.tests.is_some() && !is_silent;
    let misnamed = loaded.misnamed_golden.filter(|_| asks).zip(attribute.source.as_ref());
    let misnamed = misnamed.map(|((found, right), source)| misnamed_golden(&found, &right, &item, source.span()));
    // a plan is watched for changes only if the form uses it
    let plan = loaded.plan.filter(|_| attribute.form != Form::SevenSteps).map(|file| watch(&file));
    let watched = loaded.watched;
    let errors = errors.into_tokens();
    quote!(#errors #warnings #misnamed #watched #plan #code)
}

/// Compiles the programs of a capability. If that fails, adds an error to `errors` and returns `None`.
fn compiled(
    robot: Robot,
    capability: Capability,
    attribute: &Attribute,
    plan: Option<&RobotFile>,
    errors: &mut Errors,
) -> Option<(Robot, Vec<Program>)> {
    let robot = Robot { rotors: attribute.rotors, ..robot };
    let span = attribute.source.as_ref().map_or_else(Span::call_site, Source::span);
    let compiler = compiler(&robot, capability, attribute.form, plan, span, errors)?;
    if let Some(error) = without_base(&robot, capability).filter(|_| !attribute.allow_lints) {
        errors.at_span(span, error);
        return None;
    }
    let programs: Result<Vec<_>, _> =
        capability.functions().map(|function| compiler.compile(function, attribute.form)).collect();
    let programs = programs.map_err(|error| errors.at_span(span, not_compiled(&robot.name, &error))).ok()?;
    Some((robot, programs))
}

/// Expands the derive of `FrameKinematics`: implements the functions of the tip at each frame. Plans do not affect
/// them.
pub(crate) fn frame_kinematics(input: TokenStream) -> TokenStream {
    let Head { item, attribute, parameters, mut errors } = match Head::parse(input) {
        Ok(head) => head,
        Err(error) => return error.to_compile_error(),
    };
    let loaded = attribute.source.as_ref().map(|source| load(source, &parameters, &mut errors)).unwrap_or_default();
    let target = Target::new(&item, &attribute, None);
    let span = attribute.source.as_ref().map_or_else(Span::call_site, Source::span);
    let code =
        match loaded.robot.and_then(|robot| target.frames(&robot, attribute.form, &parameters, span, &mut errors)) {
            Some(code) => code,
            None => target.frames_stub(),
        };
    let (watched, errors) = (loaded.watched, errors.into_tokens());
    quote!(#errors #watched #code)
}

/// The parts of a derive that do not depend on the robot.
struct Head {
    item: DeriveInput,
    attribute: Attribute,
    parameters: Parameters,
    /// Errors in these parts.
    errors: Errors,
}

impl Head {
    fn parse(input: TokenStream) -> syn::Result<Self> {
        let item: DeriveInput = syn::parse2(input)?;
        let mut errors = Errors::default();
        is_struct(&item, &mut errors);
        let attribute = Attribute::parse(&item, &mut errors);
        let parameters = Parameters::of(&item, &mut errors);
        Ok(Self { item, attribute, parameters, errors })
    }
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

/// The result of reading a robot file.
#[derive(Default)]
pub(crate) struct Loaded {
    /// The robot, if the file is valid.
    pub(crate) robot: Option<Robot>,
    /// An expression that is the text of a valid file.
    pub(crate) text: TokenStream,
    /// Code that makes the compiler watch the file for changes.
    watched: TokenStream,
    /// The plan file beside the robot file.
    pub(crate) plan: Option<RobotFile>,
    /// The golden file beside the robot file.
    golden: Option<RobotFile>,
    /// A file that was probably meant to be the golden file, and the name that it should have.
    misnamed_golden: Option<(String, String)>,
    /// The number of joints; an estimate if the file is invalid.
    joints: usize,
    /// Suspicious points of a valid file.
    lints: Option<Report>,
    /// The error that two joints of a valid file give the same identifier.
    one_identifier: Option<Report>,
}

pub(crate) fn load(source: &Source, parameters: &Parameters, errors: &mut Errors) -> Loaded {
    let mut misnamed_golden = None;
    let (name, bytes, watched, plan, golden, text) = match source {
        Source::Yaml(text) => {
            ("<inline yaml>".to_owned(), text.value().into_bytes(), TokenStream::new(), None, None, quote!(#text))
        }
        Source::Path(path) => match location::read(path) {
            Ok(file) => {
                let plan = location::plan_beside(&file);
                let plan = plan.map_err(|unreadable| errors.at(path, unreadable)).unwrap_or_default();
                let golden = location::golden_beside(&file);
                let golden = golden.map_err(|unreadable| errors.at(path, unreadable)).unwrap_or_default();
                misnamed_golden = location::misnamed_golden_beside(&file).filter(|_| golden.is_none());
                let watched = watch(&file);
                let text = text(&file);
                (file.shown, file.bytes, watched, plan, golden, text)
            }
            Err(missing) => {
                errors.at(path, missing);
                return Loaded::default();
            }
        },
        Source::Builtin(name) => match location::shipped(&name.value()) {
            Ok((file, plan)) => {
                let text = text(&file);
                (file.shown, file.bytes, TokenStream::new(), plan, None, text)
            }
            Err(unknown) => {
                errors.at(name, unknown);
                return Loaded::default();
            }
        },
    };
    let names = parameters.names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let checked = Reader::new(&name).trees().couplings().loops().read(&bytes).and_then(|checked| {
        let known: Vec<&str> = checked.robot.parameters.iter().map(|(name, _)| name.as_str()).collect();
        match parameters.check(&known, errors) {
            _ if names.is_empty() => Ok(Some(checked)),
            true => Reader::new(&name).trees().couplings().loops().run_time(&names).read(&bytes).map(Some),
            false => Ok(None),
        }
    });
    match checked {
        Ok(Some(Checked { robot, lints, identifiers, .. })) => {
            let (joints, robot, lints, one_identifier) = (robot.dof(), Some(robot), Some(lints), identifiers.err());
            Loaded { robot, text, watched, plan, golden, misnamed_golden, joints, lints, one_identifier }
        }
        // a field is not a parameter of the file, which has been reported
        Ok(None) => Loaded { watched, ..Loaded::default() },
        Err(report) => {
            let joints = guess_joints(&report);
            errors.at_span(source.span(), describe(report));
            Loaded { watched, joints, ..Loaded::default() }
        }
    }
}

/// Estimates the number of joints of an invalid file by the number of keys `dh`, because every joint has one.
fn guess_joints(report: &Report) -> usize {
    report.text.matches("dh:").count()
}

/// Returns code that makes the compiler compile the crate again when the file changes.
fn watch(file: &RobotFile) -> TokenStream {
    // A path that is not Unicode cannot be written in source code.
    let Some(file) = file.absolute.as_deref().and_then(Path::to_str) else { return TokenStream::new() };
    quote!(
        const _: &[::core::primitive::u8] = ::core::include_bytes!(#file);
    )
}

/// Returns the text of a file, for code at run time: an `include_str!` of its path, or the text itself.
fn text(file: &RobotFile) -> TokenStream {
    if let Some(file) = file.absolute.as_deref().and_then(Path::to_str) {
        return quote!(::core::include_str!(#file));
    }
    let text = String::from_utf8_lossy(&file.bytes);
    quote!(#text)
}

/// Returns a compiler with the choices of the plan file, or with the choices that a build makes by itself.
pub(crate) fn compiler<'r>(
    robot: &'r Robot,
    capability: Capability,
    form: Form,
    plan: Option<&RobotFile>,
    span: Span,
    errors: &mut Errors,
) -> Option<Compiler<'r>> {
    let compiler = Compiler::new(robot);
    let is_planned = capability.functions().any(Algorithm::is_planned);
    match (form, plan) {
        (Form::Reduced, None) if is_planned => Some(compiler.with_plans(default_plans(robot))),
        // these forms need no choices
        (Form::SevenSteps, _) | (Form::Reduced, None) => Some(compiler),
        (Form::Reduced, Some(file)) => {
            let Ok(text) = std::str::from_utf8(&file.bytes) else {
                errors.at_span(span, format!("`{}` is not text in UTF-8", file.shown));
                return None;
            };
            let plan = PlanFile::read(&file.shown, text, robot);
            plan.map(|plan| compiler.with_plans(plan)).map_err(|report| errors.at_span(span, describe(report))).ok()
        }
    }
}

/// Returns the choices that a build makes by itself. All derives of a crate are expanded in one process, so they are
/// made once per robot.
fn default_plans(robot: &Robot) -> PlanSet {
    static KNOWN: Mutex<Vec<(Fingerprint, PlanSet)>> = Mutex::new(Vec::new());
    let print = rne_search::fingerprint(robot);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, plans)) = known.iter().find(|(other, _)| *other == print) {
        return plans.clone();
    }
    let plans = PlanSet::default_of(robot);
    known.push((print, plans.clone()));
    plans
}

/// Returns the error for a robot that lacks the floating base or the contacts that a derive needs. Without it, the
/// results would be those of a base without mass.
fn without_base(robot: &Robot, capability: Capability) -> Option<String> {
    let refused = capability.functions().find_map(|function| function.check_base(robot).err());
    let meant = if robot.floating_base.is_none() { "a base that has no mass" } else { "a robot with a floating base" };
    refused.map(|error| format!("{error}; or add `allow_lints` to the attribute, for {meant}"))
}

impl Source {
    fn span(&self) -> Span {
        match self {
            Self::Path(literal) | Self::Yaml(literal) | Self::Builtin(literal) => literal.span(),
        }
    }
}
