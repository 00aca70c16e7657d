//! The commands that a certificate contains: the one that made it, and the one that writes its code.

use std::fmt::Write as _;
use std::path::Path;

use rne_codegen::Function;

use crate::commands::certify::{Arguments, Language};
use crate::commands::emit::options;
use crate::files::robot_file;

/// Returns those options of the command that `rne emit` has, too.
fn shared(arguments: &Arguments) -> String {
    let mut options = String::new();
    if let Some(prefix) = &arguments.prefix {
        let _ = write!(options, " --prefix {prefix}");
    }
    for (option, _) in arguments.flags().into_iter().filter(|(_, is_given)| *is_given) {
        let _ = write!(options, " {option}");
    }
    options += &options::of_order(arguments.order);
    options
}

/// Returns the functions as the value of an option.
fn list(functions: &[Function]) -> String {
    functions.iter().map(|function| function.name()).collect::<Vec<_>>().join(",")
}

/// Returns the command that writes the certified code.
pub(super) fn of_code(arguments: &Arguments, source: &str) -> String {
    let file = robot_file::shell(Path::new(&file_name(&arguments.file)));
    let sine = if arguments.lang == Language::Rust { " --with-sin-cos" } else { "" };
    format!(
        "rne emit {file} --lang {} --function {} --form {}{sine}{} -o {source}",
        arguments.lang.name(),
        list(&arguments.programs()),
        arguments.form,
        shared(arguments)
    )
}

/// Returns the command that makes the certificate. It names the robot file without its folder, so that the certificate
/// is the same in each folder.
pub(super) fn of_certificate(arguments: &Arguments) -> String {
    let lang = arguments.lang.name();
    let mut function = format!("--function {}", list(&arguments.programs()));
    if arguments.observer {
        let _ = write!(function, " --observer --gain {} --period {}", arguments.gain, arguments.period);
    }
    let mut command = format!(
        "rne certify {} --lang {lang} --cpu {} {function} --form {} --states {} --seed {}",
        robot_file::shell(Path::new(&file_name(&arguments.file))),
        arguments.cpu.name(),
        arguments.form,
        arguments.states,
        arguments.seed
    );
    if let Some(compiler) = arguments.cc.as_ref().filter(|compiler| *compiler != arguments.lang.compiler()) {
        let _ = write!(command, " --cc {}", robot_file::shell(Path::new(compiler)));
    }
    if !arguments.cc_options.is_empty() {
        let _ = write!(command, " --cc-options={}", robot_file::shell(Path::new(&arguments.cc_options)));
    }
    command.push_str(&shared(arguments));
    if let Some(source) = &arguments.source {
        let _ = write!(command, " --source {}", robot_file::shell(Path::new(&file_name(source))));
    }
    if arguments.json {
        command.push_str(" --json");
    }
    command
}

pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
