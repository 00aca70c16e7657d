//! Checks the options of `rne emit`, and writes the command that repeats a call.

use std::fmt::Write as _;
use std::path::Path;

use rne_codegen::Order;

use crate::commands::emit::{Arguments, Language, Real};
use crate::files::robot_file;
use crate::outcome::Failure;
use crate::palette::TYPED;

/// Refuses an output file whose extension is that of another language.
pub(super) fn is_named_for(lang: Language, out: &Path) -> Result<(), Failure> {
    let extension = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let (is_other, other) = match lang {
        Language::Rust => (matches!(extension.as_str(), "c" | "h" | "cc" | "cpp" | "cxx" | "hpp"), Language::C),
        Language::C => (matches!(extension.as_str(), "rs" | "cc" | "cpp" | "cxx" | "hpp"), Language::Rust),
        Language::Cuda | Language::Ptx => return Ok(()),
    };
    if !is_other {
        return Ok(());
    }
    let right = out.with_extension(lang.extension());
    let instead = if extension == other.extension() {
        format!(", or ask for {TYPED}--lang {}{TYPED:#}", other.name())
    } else {
        String::new()
    };
    Err(usage_error!(
        "{} is not a name for a file in {}; name it {TYPED}{}{TYPED:#}{instead}",
        out.display(),
        lang.title(),
        right.display()
    ))
}

/// Refuses an empty name of a parameter, or one that is there twice.
pub(super) fn is_named_once(run_time: &[String]) -> Result<(), Failure> {
    if run_time.iter().any(String::is_empty) {
        return Err(Failure::usage("--run-time names no parameter; write --run-time NAME,NAME"));
    }
    let twice = run_time.iter().enumerate().find(|(index, name)| run_time[..*index].contains(name));
    twice.map_or(Ok(()), |(_, name)| Err(usage_error!("--run-time names {name} twice")))
}

/// Refuses options that do not exist for the language.
pub(super) fn only_of_one_language(arguments: &Arguments) -> Result<(), Failure> {
    use Language::{C, Cuda, Ptx, Rust};
    let options: [(&str, bool, &[Language], &str); 11] = [
        (
            "--with-sin-cos",
            arguments.with_sin_cos,
            &[Rust],
            "code in other languages always contains its sine and cosine",
        ),
        ("--real", arguments.real.is_some(), &[C, Ptx], "code in Rust and CUDA is generic over the number type"),
        ("--prefix", arguments.prefix.is_some(), &[C, Cuda, Ptx], "a file of Rust is a module with a name of its own"),
        ("--friction", arguments.friction, &[C], "in Rust, the derive `Actuation` computes friction"),
        ("--limits", arguments.limits, &[C], "in Rust, `f64::clamp` limits a torque"),
        ("--runge-kutta", arguments.runge_kutta, &[C], "in Rust, every type with `ForwardDynamics` has the step"),
        ("--rollout", arguments.rollout, &[Ptx], "`CompiledArm::rollout` rolls samples out on the processor"),
        (
            "--order registers",
            arguments.order == Order::Registers,
            &[Rust, C, Cuda],
            "kernels of PTX always have an order in which few values are alive at once",
        ),
        ("--names", arguments.names, &[Rust, C], "code for processors of graphics has functions alone"),
        ("--tests", arguments.tests, &[Rust, C], "code for processors of graphics has functions alone"),
        ("--casadi", arguments.casadi, &[C], "CasADi calls functions of C"),
    ];
    if arguments.casadi && arguments.real == Some(Real::Float) {
        return Err(usage_error!(
            "{TYPED}--real float{TYPED:#} is not for CasADi, which computes in double precision. Write \
             {TYPED}--real double{TYPED:#}"
        ));
    }
    let refused = options.iter().find(|(_, is_given, of, _)| *is_given && !of.contains(&arguments.lang));
    let Some((option, _, of, why)) = refused else { return Ok(()) };
    let of: Vec<String> = of.iter().map(|lang| format!("{TYPED}--lang {}{TYPED:#}", lang.name())).collect();
    Err(usage_error!(
        "{TYPED}{option}{TYPED:#} is for {}: {why}. Leave it out, or ask for another language",
        of.join(" and ")
    ))
}

/// Returns the command that writes `out`.
pub(super) fn command(arguments: &Arguments, out: &Path) -> String {
    let mut command = format!("rne emit {} --lang {}", robot_file::shell(&arguments.file), arguments.lang.name());
    if let Some(real) = arguments.real {
        let _ = write!(command, " --real {}", real.precision().c_type());
    }
    if let Some(prefix) = &arguments.prefix {
        let _ = write!(command, " --prefix {prefix}");
    }
    for function in &arguments.functions {
        let _ = write!(command, " --function {function}");
    }
    if !arguments.frames.is_empty() {
        let _ = write!(command, " --frame {}", arguments.frames.join(","));
    }
    if arguments.rotors.rotors {
        command.push_str(" --rotors");
    }
    if let Some(form) = arguments.form {
        let _ = write!(command, " --form {form}");
    }
    command.push_str(&of_order(arguments.order));
    if !arguments.run_time.is_empty() {
        let _ = write!(command, " --run-time {}", arguments.run_time.join(","));
    }
    for (option, is_given) in [
        (" --friction", arguments.friction),
        (" --limits", arguments.limits),
        (" --runge-kutta", arguments.runge_kutta),
        (" --rollout", arguments.rollout),
        (" --names", arguments.names),
        (" --with-sin-cos", arguments.with_sin_cos),
        (" --casadi", arguments.casadi),
        (" --acados", arguments.acados),
        (" --tests", arguments.tests),
        (" --ascii", arguments.ascii),
    ] {
        command.push_str(if is_given { option } else { "" });
    }
    let _ = write!(command, " -o {}", robot_file::shell(out));
    command
}

/// Returns the option for an order of statements, if it is not the default.
pub(crate) fn of_order(order: Order) -> String {
    if order == Order::Formulas { String::new() } else { format!(" --order {order}") }
}
