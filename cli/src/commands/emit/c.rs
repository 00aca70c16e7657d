//! `rne emit --lang c`: writes the source, its header, and the functions that options add.

use std::path::{Path, PathBuf};

use rne_codegen::Program;
use rne_emit::{Additions, CCode, ConstantTooLarge, JointFriction, NoFriction, Origin, Precision, Prefix};
use rne_model::Robot;

use crate::commands::emit::Language;
use crate::commands::eval::golden;
use crate::files::input_file::is_stream;
use crate::files::output_file::is_standard_output;
use crate::outcome::Failure;
use crate::palette::TYPED;

/// The file of a header.
pub(crate) struct Header {
    pub(crate) path: PathBuf,
    /// The file name without the folder, as the source includes it.
    pub(crate) name: String,
}

/// Returns the header beside a C source.
pub(crate) fn header_beside(source: &Path) -> Result<Header, Failure> {
    let extension = source.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let path = source.with_extension("h");
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    // these characters would end an `#include "…"` or change its meaning
    let name = name.filter(|name| !name.contains(['"', '\\', '\n', '\r', char::REPLACEMENT_CHARACTER]));
    match name {
        _ if extension.is_empty() && !is_standard_output(source) => Err(usage_error!(
            "{} is no name of a source file in C, beside which the header is written; name it {TYPED}{}{TYPED:#}",
            source.display(),
            source.with_extension("c").display()
        )),
        _ if extension == "h" => Err(usage_error!(
            "{} is the name of a header, which is written next to the source; name the source: {TYPED}{}{TYPED:#}",
            source.display(),
            source.with_extension("c").display()
        )),
        Some(name) => Ok(Header { path, name }),
        None => Err(usage_error!(
            "{} is not a name of a source file whose header can be included; name a file, such as \
             {TYPED}robot.c{TYPED:#}",
            source.display()
        )),
    }
}

/// Contents of a C file besides the programs, as the command line asks for them, and the robot file that its heading
/// names.
#[allow(clippy::struct_excessive_bools)] // options of commands
pub(crate) struct Request<'a> {
    pub(crate) file: &'a Path,
    pub(crate) bytes: &'a [u8],
    pub(crate) prefix: Option<&'a Prefix>,
    pub(crate) precision: Precision,
    pub(crate) friction: bool,
    pub(crate) limits: bool,
    pub(crate) names: bool,
    pub(crate) rollout: bool,
    pub(crate) casadi: bool,
    pub(crate) acados: bool,
    pub(crate) runge_kutta: bool,
    pub(crate) tests: bool,
    pub(crate) ascii: bool,
}

/// Writes the C code, with tests if they are asked for.
pub(crate) fn c_code(request: &Request<'_>, robot: &Robot, programs: &[Program]) -> Result<CCode, Failure> {
    let &Request { file, precision, limits, names, casadi, acados, runge_kutta, .. } = request;
    let prefix = request.prefix.cloned().unwrap_or_else(|| Prefix::of(robot));
    let origin = origin(request);
    let friction = if request.friction { Some(friction(file, robot)?) } else { None };
    let friction = friction.as_deref();
    let additions = Additions {
        origin: Some(&origin),
        friction,
        limits,
        names,
        casadi,
        acados,
        runge_kutta,
        ..Additions::default()
    };
    if limits && robot.independent_joints().all(|joint| joint.limits.effort.is_none()) {
        let has_follower = robot.joints.iter().any(|joint| joint.limits.effort.is_some());
        let follower =
            if has_follower { ", but for joints that follow others and have no torque of their own" } else { "" };
        return Err(input_error!(
            "{}: no joint has an effort limit{follower}; write it in `limits` of the joint, for example `limits: \
             {{effort: 40}}` (N m or N)",
            file.display()
        ));
    }
    let code = rne_emit::c_code_with(robot, programs, precision, &prefix, &additions)
        .map_err(|error| too_large(request, &error))?;
    let code = if request.tests {
        let golden = golden::of_programs(robot, programs, precision)?;
        code.with_tests(&rne_emit::c_tests(robot, programs, precision, &prefix, &golden, &additions))
    } else {
        code
    };
    Ok(if request.ascii { code.in_ascii() } else { code })
}

/// Writes kernels in PTX, or a header for CUDA and C++.
pub(super) fn for_gpu(
    language: Language,
    request: &Request<'_>,
    robot: &Robot,
    programs: &[Program],
) -> Result<String, Failure> {
    let origin = origin(request);
    let additions = Additions { origin: Some(&origin), rollout: request.rollout, ..Additions::default() };
    let prefix = request.prefix.cloned().unwrap_or_else(|| Prefix::of(robot));
    let text = match language {
        Language::Ptx => rne_emit::ptx(robot, programs, request.precision, &prefix, &additions),
        _ => rne_emit::cuda(robot, programs, &prefix, &additions),
    };
    text.map_err(|error| too_large(request, &error))
}

/// Returns the origin of the code for its heading: the robot file without its folder, so that the same file gives the
/// same code everywhere.
fn origin(request: &Request<'_>) -> Origin {
    let name = request.file.file_name().unwrap_or_default().to_string_lossy();
    let name = if is_stream(request.file) { "on standard input" } else { &*name };
    Origin::new(name, &rne_certify::sha256(request.bytes))
}

fn too_large(request: &Request<'_>, error: &ConstantTooLarge) -> Failure {
    let file = request.file.display();
    input_error!("{file}: {error}. {TYPED}rne emit --real double{TYPED:#} can store this number")
}

/// Returns the friction of the joints; an error says where to write missing numbers.
pub(crate) fn friction(file: &Path, robot: &Robot) -> Result<Vec<JointFriction>, Failure> {
    JointFriction::of(robot).map_err(|why| {
        let file = file.display();
        match why {
            NoFriction::RunTime(_) => usage_error!(
                "{file}: {why}. Leave this parameter out of {TYPED}--run-time{TYPED:#}, or leave out \
                 {TYPED}--friction{TYPED:#}"
            ),
            _ => input_error!("{file}: {why}"),
        }
    })
}
