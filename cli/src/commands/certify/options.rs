//! Refuses options of `rne certify` that do not fit together.

use rne_codegen::{Argument, Function, Shape};

use crate::commands::certify::{Arguments, Language, trace};
use crate::outcome::Failure;
use crate::palette::TYPED;

/// Checks that the options fit together, and that the gain and the period of an observer are above zero.
pub(super) fn fit_together(arguments: &Arguments) -> Result<(), Failure> {
    // all these options need C, except `--rotors`, which comes first
    let [_, of_c @ ..] = arguments.flags();
    if let Some((option, _)) = of_c.into_iter().find(|(_, is_given)| *is_given && arguments.lang != Language::C) {
        return Err(usage_error!("{TYPED}{option}{TYPED:#} is for {TYPED}--lang c{TYPED:#}"));
    }
    // only options that choose how code is compiled are allowed: others write files or stop the compiler
    let chooses = |word: &str| ["-f", "-m", "-O", "-W", "--param", "-C"].iter().any(|start| word.starts_with(start));
    let words = arguments.cc_options.split_whitespace();
    let writes = |word: &str| ["-fdump", "-flto", "-fsyntax-only"].iter().any(|start| word.starts_with(start));
    if let Some(word) = words.into_iter().find(|word| !chooses(word) || writes(word)) {
        return Err(usage_error!(
            "{TYPED}--cc-options{TYPED:#} takes options that choose the code, such as -O3, -fno-schedule-insns or \
             -mtune=cortex-a5, but not `{word}`"
        ));
    }
    let of_joints = |argument: &Argument| {
        matches!(argument, Argument::Positions | Argument::Rates | Argument::Accelerations | Argument::Torques)
    };
    let returns_numbers = |function: &Function| {
        let mut shape = function.shape();
        while let Shape::Array(_, of) = shape {
            shape = of;
        }
        *shape == Shape::Number
    };
    let in_rust = |of: &&Function| of.arguments().iter().all(of_joints) && returns_numbers(of);
    if arguments.lang != Language::C
        && let Some(function) = arguments.functions.iter().find(|of| !in_rust(of))
    {
        return Err(usage_error!(
            "{TYPED}--lang rust{TYPED:#} certifies functions that take arrays of the joints alone and return a number, \
             a vector or a matrix, and no struct; for {function}, give {TYPED}--lang c{TYPED:#}"
        ));
    }
    if arguments.evidence.is_some() {
        trace::check_options(arguments, &arguments.programs())?;
    }
    if !arguments.observer {
        return Ok(());
    }
    if arguments.lang != Language::C {
        return Err(usage_error!(
            "{TYPED}--observer{TYPED:#} is for {TYPED}--lang c{TYPED:#}: in Rust, the observer is `rne::ObserverState`"
        ));
    }
    for (option, value) in [("--gain", arguments.gain), ("--period", arguments.period)] {
        // within this range, numbers of single precision are far from underflow and overflow
        if !(1e-6..=1e6).contains(&value) {
            return Err(usage_error!("{option} is {value}; it must be between 1e-6 and 1e6"));
        }
    }
    Ok(())
}
