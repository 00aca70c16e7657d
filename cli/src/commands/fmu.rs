//! `rne export --fmu`: writes an FMU with its sources, and with a binary if there is a C compiler.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;
use std::process::Command;

use clap::Args;
use rne_codegen::{Form, Program};
use rne_emit::{FmiVersion, Fmu, FmuCausality, Precision, Prefix};
use rne_model::Robot;

use crate::files::chosen_arm::Rotors;
use crate::files::file_name::{self, Format};
use crate::files::output_file::{check_new, is_standard_output, write_bytes};
use crate::files::plan_file::Compiler;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{TITLE, TYPED};

/// The options of an FMU.
#[derive(Args, Clone, Copy)]
pub(super) struct Options {
    /// FMU: motion in, torques out
    #[arg(long)]
    inverse: bool,
    /// FMU: sources only, no binary
    #[arg(long)]
    no_build: bool,
    /// FMU: include the inertia of the motors' rotors
    #[arg(long)]
    rotors: bool,
}

impl Options {
    /// Returns the first of these options that the command line gives.
    pub(super) fn given(self) -> Option<&'static str> {
        let options = [("--inverse", self.inverse), ("--no-build", self.no_build), ("--rotors", self.rotors)];
        options.into_iter().find_map(|(option, is_given)| is_given.then_some(option))
    }
}

/// Writes the FMU of a robot file.
pub(super) fn write(
    file: &Path,
    version: FmiVersion,
    options: Options,
    out: &Path,
    force: bool,
) -> Result<Outcome, Failure> {
    if is_standard_output(out) {
        return Err(usage_error!("{TYPED}--fmu{TYPED:#} needs the name of a file, such as {TYPED}-o arm.fmu{TYPED:#}"));
    }
    check_new(out, None, &[file], force)?;
    file_name::check(out, Format::Fmu)?;
    let checked = robot_file::read_with_free_parameters(file, Shape::Closed)?;
    can_be_fmu(file, &checked.robot)?;
    let rotors = Rotors { rotors: options.rotors };
    let robot = rne_emit::with_inertial_parameters(rotors.of(checked.robot));
    let causality = if options.inverse { FmuCausality::Inverse } else { FmuCausality::Forward };
    let compiler = Compiler::without_file(file, &robot);
    let functions = causality.functions().iter();
    let programs: Vec<Program> =
        functions.map(|&function| compiler.compile(function, Form::Reduced)).collect::<Result<_, _>>()?;
    let prefix = Prefix::of(&robot);
    let code = rne_emit::c_code(&robot, &programs, Precision::Double, &prefix)
        .map_err(|error| input_error!("{}: {error}", file.display()))?;
    // the token must change with the code and its parameters, so it is a hash of the code
    let token = rne_certify::sha256(code.one_file().as_bytes());
    let fmu = Fmu { robot: &robot, programs: &programs, code: &code, version, causality, token: &token };
    let files = fmu.files();

    let mut entries: Vec<(String, Vec<u8>)> =
        files.iter().map(|(path, text)| (path.clone(), text.clone().into_bytes())).collect();
    let mut remark = String::new();
    if options.no_build {
        remark.push_str("no binary was built, because of --no-build\n");
    } else {
        match binary(&fmu, &files)? {
            Some((path, bytes, compiler)) => {
                let _ = writeln!(remark, "{compiler} built {path}");
                entries.push((path, bytes));
            }
            None => {
                let _ = writeln!(
                    remark,
                    "{TITLE}note{TITLE:#}: there is no C compiler, so the FMU has sources and no binary; install one, \
                     or name it in the variable CC"
                );
            }
        }
    }
    let archive = archive(&entries).map_err(|error| input_error!("{}: {error}", out.display()))?;
    remark += &write_bytes(out, &archive)?;
    remark += &rotors.note(&robot);
    Ok(Outcome::remark(remark))
}

/// Refuses a robot that an FMU cannot represent.
fn can_be_fmu(file: &Path, robot: &Robot) -> Result<(), Failure> {
    if robot.floating_base.is_some() {
        return Err(input_error!(
            "{}: the base of this robot floats, and an FMU needs a fixed base; remove `floating_base` to fix the base",
            file.display()
        ));
    }
    if !robot.closed.is_empty() {
        return Err(input_error!(
            "{}: this robot has closed loops, and an FMU needs a robot without closed loops; remove `loops`, or use \
             {TYPED}rne emit --lang c{TYPED:#}, which writes functions of closed loops",
            file.display()
        ));
    }
    Ok(())
}

/// Compiles the binary for this computer; returns its path in the FMU, its bytes and the compiler, or `None` if there
/// is no compiler.
fn binary(fmu: &Fmu<'_>, files: &[(String, String)]) -> Result<Option<(String, Vec<u8>, String)>, Failure> {
    let folder = tempfile::tempdir().map_err(|error| {
        input_error!(
            "the folder of temporary files {} cannot be used: {error}. Set the variable TMPDIR to a folder that can be \
             written, or give {TYPED}--no-build{TYPED:#}",
            std::env::temp_dir().display()
        )
    })?;
    let library = folder.path().join("library");
    for (path, text) in files {
        if let Some(name) = path.strip_prefix("sources/") {
            fs::write(folder.path().join(name), text).map_err(Failure::input)?;
        }
    }
    let named = std::env::var("CC").ok().filter(|name| !name.trim().is_empty());
    let compiler = named.clone().unwrap_or_else(|| "cc".to_owned());
    // as in make, `CC` may contain options after the name of the compiler
    let mut words = compiler.split_whitespace();
    let mut command = Command::new(words.next().unwrap_or("cc"));
    command.args(words).args(["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-o"]).arg(&library);
    match command.args(fmu.sources()).current_dir(folder.path()).output() {
        Ok(output) if output.status.success() => {
            let path = format!("binaries/{}/{}.{}", platform(fmu.version), fmu.robot.name, extension());
            Ok(Some((path, fs::read(&library).map_err(Failure::input)?, compiler)))
        }
        Ok(output) => Err(input_error!(
            "{compiler} does not compile the sources; {TYPED}--no-build{TYPED:#} writes the FMU without a \
             binary:\n{}",
            String::from_utf8_lossy(&output.stderr)
        )),
        Err(error) if error.kind() == ErrorKind::NotFound && named.is_some() => Err(input_error!(
            "the compiler {compiler} that the variable CC names is not found; correct or remove the variable, or give \
             {TYPED}--no-build{TYPED:#}"
        )),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(input_error!("{compiler} cannot be started: {error}")),
    }
}

/// Returns the folder of an FMU for binaries of this computer.
fn platform(version: FmiVersion) -> String {
    let (system, short) = match std::env::consts::OS {
        "macos" => ("darwin", "darwin"),
        "windows" => ("windows", "win"),
        other => (other, other),
    };
    match version {
        FmiVersion::Two => format!("{short}{}", usize::BITS),
        FmiVersion::Three => format!("{}-{system}", std::env::consts::ARCH),
    }
}

/// Returns the extension of shared libraries.
const fn extension() -> &'static str {
    if cfg!(windows) {
        "dll"
    } else if cfg!(target_os = "macos") {
        "dylib"
    } else {
        "so"
    }
}

/// Makes a zip archive without compression, which every tool reads. All files get the earliest date of the format, so
/// that the same robot file gives the same bytes.
fn archive(entries: &[(String, Vec<u8>)]) -> io::Result<Vec<u8>> {
    let mut archive = rawzip::ZipArchiveWriter::new(Vec::new());
    let date = rawzip::time::UtcDateTime::from_components(1980, 1, 1, 0, 0, 0, 0);
    for (path, bytes) in entries {
        let mut file = archive.new_file(path.as_str());
        if let Some(date) = date {
            file = file.last_modified(date);
        }
        let (mut entry, config) = file.start().map_err(io::Error::other)?;
        let mut writer = config.wrap(&mut entry);
        writer.write_all(bytes)?;
        let (_, described) = writer.finish().map_err(io::Error::other)?;
        entry.finish(described).map_err(io::Error::other)?;
    }
    archive.finish().map_err(io::Error::other)
}
