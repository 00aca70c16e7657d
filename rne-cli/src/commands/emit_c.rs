//! `rne emit --lang c`: the source, its header, and the functions that are added on request.

use std::path::{Path, PathBuf};

use rne_codegen::Program;
use rne_emit::{Additions, CCode, JointFriction, NoFriction, Origin, Precision, Prefix};
use rne_model::Robot;

use crate::commands::emit::{Arguments, Real};
use crate::commands::golden;
use crate::files::input_file::is_stream;
use crate::outcome::Failure;
use crate::palette::TYPED;

/// A header's file.
pub(super) struct Header {
    pub(super) path: PathBuf,
    /// Without the folder, as the source includes it.
    pub(super) name: String,
}

/// The header beside a source of C.
pub(super) fn header_beside(source: &Path) -> Result<Header, Failure> {
    let extension = source.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let path = source.with_extension("h");
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    // what ends an `#include "…"`
    let name = name.filter(|name| !name.contains(['"', '\\', '\n', '\r', char::REPLACEMENT_CHARACTER]));
    match name {
        _ if extension == "h" => Err(Failure::usage(format_args!(
            "{} is the name of a header, which is written next to the source; name the source: {TYPED}{}{TYPED:#}",
            source.display(),
            source.with_extension("c").display()
        ))),
        Some(name) => Ok(Header { path, name }),
        None => Err(Failure::usage(format_args!(
            "{} is not a name of a source file whose header can be included; name a file, such as \
             {TYPED}robot.c{TYPED:#}",
            source.display()
        ))),
    }
}

/// The code, with the tests that are asked for.
pub(super) fn c_code(
    arguments: &Arguments,
    robot: &Robot,
    programs: &[Program],
    bytes: &[u8],
) -> Result<CCode, Failure> {
    let precision = arguments.real.map_or_else(Precision::default, Real::precision);
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    // without its folder: the same file gives the same bytes wherever it is
    let name = arguments.file.file_name().unwrap_or_default().to_string_lossy();
    let name = if is_stream(&arguments.file) { "on standard input" } else { &*name };
    let origin = Origin::new(name, &rne_certify::sha256(bytes));
    let friction = if arguments.friction { Some(friction(arguments, robot)?) } else { None };
    let additions = Additions { origin: Some(&origin), friction: friction.as_deref(), limits: arguments.limits };
    if arguments.limits && robot.joints.iter().all(|joint| joint.limits.effort.is_none()) {
        return Err(Failure::input(format_args!(
            "{}: no joint has an effort limit; write it in `limits` of the joint, for example `limits: {{effort: 40}}` \
             (N m or N)",
            arguments.file.display()
        )));
    }
    let code = rne_emit::c_code_with(robot, programs, precision, &prefix, &additions).map_err(|error| {
        let file = arguments.file.display();
        Failure::input(format_args!("{file}: {error}. {TYPED}--real double{TYPED:#} can store this number"))
    })?;
    if !arguments.tests {
        return Ok(code);
    }
    let golden = golden::of_programs(robot, programs, precision)?;
    Ok(code.with_tests(&rne_emit::c_tests(robot, programs, precision, &prefix, &golden, &additions)))
}

/// The friction of the joints; an error says where to write what is missing.
fn friction(arguments: &Arguments, robot: &Robot) -> Result<Vec<JointFriction>, Failure> {
    JointFriction::of(robot).map_err(|why| {
        let file = arguments.file.display();
        match why {
            NoFriction::RunTime(_) => Failure::usage(format_args!(
                "{file}: {why}. Leave this parameter out of {TYPED}--run-time{TYPED:#}, or leave out \
                 {TYPED}--friction{TYPED:#}"
            )),
            _ => Failure::input(format_args!("{file}: {why}")),
        }
    })
}
