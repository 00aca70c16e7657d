//! Finds mistakes on the command line for which the parser's message would mislead or not help: blanks in a list of
//! numbers, an option without its value, a value that looks like an option, an option of another command, a function
//! that a command does not have, missing arguments, and surplus arguments.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgAction, Command, CommandFactory as _};
use rne_codegen::{Function, What};
use rne_model::did_you_mean;

use crate::commands::Arguments;
use crate::outcome::Failure;
use crate::palette::TYPED;
use crate::values::choice;
use crate::values::numbers::List;

/// Returns the command, named for a message about its help, and what is wrong with its words; `None` if the message of
/// the parser is good. `words` are those after the name of the program.
pub(crate) fn explained(error: &clap::Error, words: &[String]) -> Option<(String, Failure)> {
    if !error.use_stderr() {
        return None;
    }
    let mut grammar = Arguments::command();
    grammar.build();
    let name = words.first()?;
    let command = grammar.get_subcommands().find(|command| command.get_name() == name)?;
    let words = &words[1..];
    let is_stray = error.kind() == ErrorKind::UnknownArgument;
    let stray = || refused(command, words).or_else(|| of_others(&grammar, command, error));
    let text = with_blanks(command, words)
        .or_else(|| without_value(command, words))
        .or_else(|| unknown_function(error))
        .or_else(|| of_synonym(command, error))
        .or_else(|| is_stray.then(stray).flatten())
        .or_else(|| needed_by_another(command, error, words))
        .or_else(|| beside_states(command, error, words))
        .or_else(|| missing_or_too_many(command, error))?;
    Some((format!("rne {name}"), Failure::usage(text)))
}

/// Returns the texts that the parser gives for one kind of context; it may give none.
fn texts(error: &clap::Error, kind: ContextKind) -> &[String] {
    match error.get(kind) {
        Some(ContextValue::String(text)) => std::slice::from_ref(text),
        Some(ContextValue::Strings(texts)) => texts,
        _ => &[],
    }
}

/// Returns the option that a word means, `--q` or `--q=1`, and its value if the same word contains it.
fn option<'c, 'w>(command: &'c Command, word: &'w str) -> Option<(&'c Arg, Option<&'w str>)> {
    let word = word.strip_prefix("--")?;
    let (name, value) = word.split_once('=').map_or((word, None), |(name, value)| (name, Some(value)));
    let arg = command.get_arguments().find(|arg| arg.get_long() == Some(name))?;
    Some((arg, value))
}

fn takes_value(arg: &Arg) -> bool {
    matches!(arg.get_action(), ArgAction::Set | ArgAction::Append)
}

fn takes_list(arg: &Arg) -> bool {
    let is_list = |name: &clap::builder::Str| matches!(name.as_str(), "LIST" | "V");
    arg.get_value_names().is_some_and(|names| names.iter().any(is_list))
}

/// Describes an option as its help does: its value and its purpose.
fn described(arg: &Arg) -> String {
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    format!("{TYPED}{arg}{TYPED:#}: {help}")
}

/// Finds lists of numbers with blanks between them: `--q 0.5 0.3`, `--q 0.5, 0.3`.
fn with_blanks(command: &Command, words: &[String]) -> Option<String> {
    let numbers = |word: &str| {
        let word = word.trim_matches(',');
        word.parse::<List>().is_ok().then(|| word.to_owned())
    };
    let mut meant = Vec::new();
    for (index, word) in words.iter().enumerate() {
        let Some((arg, value)) = option(command, word).filter(|(arg, _)| takes_list(arg)) else { continue };
        let rest = words[index + 1..].iter().map(String::as_str);
        let parts: Vec<String> = value.into_iter().chain(rest).map_while(numbers).collect();
        if parts.len() > 1 {
            meant.push(format!("{TYPED}--{} {}{TYPED:#}", arg.get_long().unwrap_or_default(), parts.join(",")));
        }
    }
    (!meant.is_empty())
        .then(|| format!("separate the numbers of a list by commas without blanks: write {}", meant.join(" ")))
}

/// Finds an option that needs numbers and is followed by another option or by nothing: `--q --qd 1,1`.
fn without_value(command: &Command, words: &[String]) -> Option<String> {
    let is_missing = |(index, word): (usize, &String)| {
        let (arg, value) = option(command, word).filter(|(arg, _)| takes_list(arg))?;
        let is_next = words.get(index + 1).is_none_or(|next| option(command, next).is_some());
        (value.is_none() && is_next).then_some(arg)
    };
    let arg = words.iter().enumerate().find_map(is_missing)?;
    let long = arg.get_long().unwrap_or_default();
    let example = if long == "payload" { "2,0,0,0.1" } else { "0.1,-0.2,pi/2" };
    Some(format!(
        "the numbers of {}\nare missing; write for example {TYPED}--{long} {example}{TYPED:#}",
        described(arg)
    ))
}

/// Finds a value that begins with a dash after an option that does not accept such values: `--joint -1`.
fn refused(command: &Command, words: &[String]) -> Option<String> {
    words.windows(2).find_map(|pair| {
        let [before, word] = pair else { return None };
        let (arg, value) = option(command, before).filter(|(arg, _)| takes_value(arg))?;
        let is_dashed = word.strip_prefix('-').is_some_and(|rest| !rest.is_empty() && !rest.starts_with('-'));
        let is_refused = is_dashed && value.is_none() && !arg.is_allow_hyphen_values_set();
        let is_refused = is_refused && !(arg.is_allow_negative_numbers_set() && word.parse::<f64>().is_ok());
        is_refused.then(|| format!("`{word}` is not a valid value of {}", described(arg)))
    })
}

/// Functions that return matrices, which only the libraries for Rust and Python have.
const OF_LIBRARIES: [&str; 2] = ["operational_space_inertia", "dynamically_consistent_inverse"];

/// The function whose C code contains the observer.
const OBSERVER: &str = "momentum_and_rate";

/// Finds a value of `--function` that is no function of the command. The list of all names is long, so the message has
/// only similar names, and the command that prints all of them.
fn unknown_function(error: &clap::Error) -> Option<String> {
    /// Largest number of names that a message proposes.
    const MOST: usize = 6;
    let [value] = texts(error, ContextKind::InvalidValue) else { return None };
    let valid = texts(error, ContextKind::ValidValue);
    let names = || valid.iter().map(String::as_str);
    let is_known = |name: &str| names().any(|known| known == name);
    if !is_known(Function::InverseDynamics.name()) {
        return None;
    }
    if OF_LIBRARIES.contains(&value.as_str()) {
        return Some(format!(
            "`{value}` is a function of Rust and Python only, because its arguments are matrices: see the section \
             Operational space of docs/reference/functions.md; rne eval computes the arguments, `mass_matrix` and \
             `jacobian`"
        ));
    }
    if let Some(composed) = choice::composed(value) {
        return Some(composed);
    }
    let word = value.to_lowercase().replace('-', "_");
    if word == "observer" && is_known(OBSERVER) {
        return Some(format!(
            "`{value}` is no function; the C code of {OBSERVER} contains the momentum observer: write \
             {TYPED}--function {OBSERVER}{TYPED:#}, or {TYPED}--observer{TYPED:#} of {TYPED}rne certify{TYPED:#}"
        ));
    }
    let other = What::of_alias(value).map(What::name);
    let meant = names().find(|name| *name == word || other == Some(*name)).or_else(|| did_you_mean(value, names()));
    let near: Vec<&str> = match meant {
        Some(meant) => vec![meant],
        None => names().filter(|name| word.len() > 3 && (name.contains(&word) || word.contains(name))).collect(),
    };
    let listed = format!("{TYPED}rne explain functions{TYPED:#} lists all functions");
    let proposed = |names: &[&str]| names.iter().map(|name| format!("{TYPED}{name}{TYPED:#}")).collect::<Vec<_>>();
    Some(match proposed(&near[..near.len().min(MOST)]).as_slice() {
        [] if value == "all" => format!("this command takes functions by their names, F,F,…; {listed}"),
        [] => {
            let usual = ["inverse_dynamics", "mass_matrix", "forward_dynamics", "jacobian"];
            let usual: Vec<&str> = usual.into_iter().filter(|name| is_known(name)).collect();
            format!("there is no function `{value}`; {listed}, such as {}", proposed(&usual).join(", "))
        }
        [only] => format!("there is no function `{value}`; did you mean {only}? {listed}"),
        [some @ .., last] => {
            format!("there is no function `{value}`; did you mean {} or {last}? {listed}", some.join(", "))
        }
    })
}

/// Options, each with other words of the field for it; the parser only compares letters, so it does not know them.
const SYNONYMS: [(&str, &[&str]); 6] = [
    ("q", &["pos", "position", "positions", "angles"]),
    ("qd", &["dq", "vel", "velocity", "velocities"]),
    ("qdd", &["ddq", "acc", "acceleration", "accelerations"]),
    ("tau", &["torque", "torques", "effort"]),
    ("cpu", &["core", "processor", "target"]),
    ("lang", &["language"]),
];

/// Finds an option with another word of the field: `--velocity 1,1`.
fn of_synonym(command: &Command, error: &clap::Error) -> Option<String> {
    let [typed] = texts(error, ContextKind::InvalidArg) else { return None };
    let (meant, _) = SYNONYMS.into_iter().find(|(_, words)| words.contains(&typed.trim_start_matches('-')))?;
    let arg = command.get_arguments().find(|arg| arg.get_long() == Some(meant))?;
    Some(format!("there is no option {TYPED}{typed}{TYPED:#}; did you mean {}?", described(arg)))
}

/// Finds the commands that have an option which this command does not have: `eval --seed 1`. The parser would propose
/// an option of this command that merely looks alike.
fn of_others(grammar: &Command, command: &Command, error: &clap::Error) -> Option<String> {
    let [option] = texts(error, ContextKind::InvalidArg) else { return None };
    let long = option.strip_prefix("--")?;
    let has = |other: &&Command| other.get_arguments().any(|arg| arg.get_long() == Some(long) && !arg.is_hide_set());
    let others = grammar.get_subcommands().filter(has);
    let others: Vec<String> = others.map(|other| format!("{TYPED}rne {}{TYPED:#}", other.get_name())).collect();
    if others.is_empty() {
        return None;
    }
    let name = command.get_name();
    let instead = match (name, long) {
        ("eval", "seed") => {
            format!("; {TYPED}rne eval FILE --golden 10{TYPED:#} computes the torques at 10 random states")
        }
        _ => String::new(),
    };
    Some(format!(
        "{TYPED}rne {name}{TYPED:#} has no option {TYPED}{option}{TYPED:#}, which is an option of {}{instead}",
        others.join(", ")
    ))
}

/// Returns the first example in the help of a command, without its description.
fn example(command: &Command) -> Option<String> {
    let help = command.get_after_help()?.to_string();
    let mut example = String::new();
    for line in help.split_once("Examples:\n")?.1.lines() {
        let line = line.trim();
        let command = line.strip_suffix('\\');
        example.push_str(command.unwrap_or(line));
        if command.is_none() {
            break;
        }
    }
    Some(example.split("  ").next().unwrap_or_default().to_owned())
}

/// Joins names in the style of text to type.
fn joined(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("{TYPED}{name}{TYPED:#}")).collect();
    names.join(" and ")
}

/// Finds an option that needs another option which is missing. The parser reports the missing option without the one
/// that needs it.
fn needed_by_another(command: &Command, error: &clap::Error, words: &[String]) -> Option<String> {
    let missing = |error: &clap::Error| match error.kind() {
        ErrorKind::MissingRequiredArgument => texts(error, ContextKind::InvalidArg).to_vec(),
        _ => Vec::new(),
    };
    let names = missing(error);
    if names.iter().any(|name| !name.starts_with('-')) {
        return None;
    }
    let missing_with = |words: &[String]| {
        let line = std::iter::once(command.get_name()).chain(words.iter().map(String::as_str));
        command.clone().try_get_matches_from(line).err().map_or_else(Vec::new, |error| missing(&error))
    };
    let always = missing_with(&[]);
    let needing = words.iter().enumerate().find_map(|(index, word)| {
        let (arg, value) = option(command, word)?;
        let count = 1 + usize::from(takes_value(arg) && value.is_none() && index + 1 < words.len());
        let missing = missing_with(&words[index..index + count]);
        let is_needing = names.iter().any(|name| missing.contains(name) && !always.contains(name));
        is_needing.then(|| format!("--{}", arg.get_long().unwrap_or_default()))
    })?;
    // if the command itself requires the first option, leaving both out is no solution
    let is_required = command.get_arguments().any(|arg| arg.is_required_set() && Some(&needing[2..]) == arg.get_long());
    let advice = match names.len() {
        1 if is_required => "give it, too",
        1 => "give both, or neither",
        _ => "give all of them",
    };
    Some(format!("{TYPED}{needing}{TYPED:#} needs {}; {advice}", joined(&names)))
}

/// Finds an option with numbers of one state beside an option that has its own states: `--states TABLE --payload LIST`.
fn beside_states(command: &Command, error: &clap::Error, words: &[String]) -> Option<String> {
    let conflicts = error.kind() == ErrorKind::ArgumentConflict && command.get_name() == "eval";
    let given = || words.iter().filter(|_| conflicts).filter_map(|word| Some(option(command, word)?.0));
    let of_table = given().find(|arg| arg.get_long() == Some("states"));
    let own = of_table.or_else(|| given().find(|arg| arg.get_long() == Some("golden")))?.get_long()?;
    let of_state = command.get_groups().find(|group| group.get_id() == "Given")?;
    let is_of_state =
        |arg: &&Arg| of_state.get_args().any(|id| id == arg.get_id()) || arg.get_long() == Some("payload");
    let list = given().find(is_of_state)?.get_long()?;
    let states = if of_table.is_some() { "the columns of the table have its numbers" } else { "the states are random" };
    let payload = if of_table.is_some() && list == "payload" {
        "; a function such as --function mass_matrix_with_payload has columns for the payload"
    } else {
        ""
    };
    Some(format!("{TYPED}--{list}{TYPED:#} is for one state; with {TYPED}--{own}{TYPED:#}, {states}{payload}"))
}

/// Finds missing arguments, and words that no argument accepts, if the parser has no proposal: the message has an
/// example.
fn missing_or_too_many(command: &Command, error: &clap::Error) -> Option<String> {
    let name = command.get_name();
    let example = format!("for example {TYPED}{}{TYPED:#}", example(command)?);
    match (error.kind(), texts(error, ContextKind::InvalidArg)) {
        (ErrorKind::MissingRequiredArgument, missing @ [_, ..]) => {
            Some(format!("{TYPED}rne {name}{TYPED:#} needs {}; {example}", joined(missing)))
        }
        (ErrorKind::UnknownArgument, [word]) if error.get(ContextKind::SuggestedArg).is_none() => {
            Some(if word.starts_with('-') {
                format!("{TYPED}rne {name}{TYPED:#} has no option {TYPED}{word}{TYPED:#}; {example}")
            } else {
                format!("the argument `{word}` is one too many for {TYPED}rne {name}{TYPED:#}; {example}")
            })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    /// Returns the message for a command line that is refused.
    fn said(line: &str) -> Option<String> {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let all = std::iter::once("rne".to_owned()).chain(words.iter().cloned());
        let error = Arguments::try_parse_from(all).err()?;
        explained(&error, &words).map(|(_, failure)| anstream::adapter::strip_str(&failure.text).to_string())
    }

    #[test]
    fn blanks_in_lists_are_commas() {
        for (line, meant) in [
            ("eval planar2 --q 0.5 0.3 --qd 0,0 --qdd 0,0", "--q 0.5,0.3"),
            ("eval planar2 --q 0.5, 0.3 --qd 0,0 --qdd 0,0", "--q 0.5,0.3"),
            ("eval planar2 --q=0.5 -0.3 --qd 0,0", "--q 0.5,-0.3"),
            ("eval --q -pi/2 .3 --qd 1 2 planar2", "--q -pi/2,.3 --qd 1,2"),
            ("eval arm --q 1,2 3 --base-omega 0 0 1", "--q 1,2,3 --base-omega 0,0,1"),
            ("diagnose planar2 --q 1,2 --qd 1,2 --qdd 1,2 --tau 1 2", "--tau 1,2"),
        ] {
            let expected = format!("error: separate the numbers of a list by commas without blanks: write {meant}");
            assert_eq!(said(line), Some(expected), "{line}");
        }
    }

    #[test]
    fn options_without_their_numbers() {
        for line in ["eval planar2 --q --qd 1,1", "eval planar2 --qd 1,1 --q", "eval planar2 --q --json"] {
            let said = said(line).expect(line);
            assert!(said.contains("--q <LIST>: Joint positions") && said.contains("--q 0.1,-0.2"), "{line}: {said}");
        }
    }

    #[test]
    fn dashes_before_values() {
        let joint = said("show puma560 --joint -1").expect("refused");
        assert!(
            joint.starts_with("error: `-1` is not a valid value of --joint <") && !joint.contains("-- -1"),
            "{joint}"
        );
        let set = said("eval planar2 --set -m --q 1,1").expect("refused");
        assert!(set.contains("`-m` is not a valid value of --set <NAME=VALUE>: Set a parameter of FILE"), "{set}");
    }

    #[test]
    fn options_of_other_commands() {
        let seed = said("eval planar2 --seed 1").expect("refused");
        assert!(seed.starts_with("error: rne eval has no option --seed, which is an option of rne "), "{seed}");
        assert!(
            seed.contains("rne worksheet") && seed.ends_with("--golden 10 computes the torques at 10 random states")
        );
        let latex = said("eval planar2 --latex").expect("refused");
        assert_eq!(latex, "error: rne eval has no option --latex, which is an option of rne show");
        // no command has this option
        assert_eq!(said("eval planar2 --payloads 1,0,0,0"), None);
    }

    #[test]
    fn functions_of_libraries() {
        for name in ["operational_space_inertia", "dynamically_consistent_inverse"] {
            let said = said(&format!("eval panda --function {name}")).expect("refused");
            assert!(said.starts_with(&format!("error: `{name}` is a function of Rust and Python only")), "{said}");
        }
        let step = said("emit panda --lang c --function runge_kutta_step").expect("refused");
        assert!(step.contains("rne emit FILE --lang c --runge-kutta writes it in C"), "{step}");
    }

    #[test]
    fn functions_of_another_name() {
        for command in ["emit", "certify"] {
            let observer = said(&format!("{command} planar2 --function observer")).expect("refused");
            assert!(
                observer.contains("write --function momentum_and_rate, or --observer of rne certify"),
                "{observer}"
            );
        }
    }

    #[test]
    fn what_the_parser_says_well_stays() {
        for line in [
            "eval planar2 --qq 1",
            "evil",
            "eval --help",
            "eval planar2 --golden -3",
            "emit planar2 --real half",
            "emit planar2 --lang C",
        ] {
            assert_eq!(said(line), None, "{line}");
        }
    }

    #[test]
    fn functions_that_are_not_there() {
        for (name, near) in [
            ("inverse_dynamic", "did you mean inverse_dynamics? rne explain functions lists all functions"),
            ("tip-jacobian", "did you mean tip_jacobians?"),
            ("kinetic", "did you mean kinetic_energy or floating_kinetic_energy?"),
            ("inverse_dynamics_of_everything", "did you mean inverse_dynamics?"),
            ("foo", "lists all functions, such as inverse_dynamics, mass_matrix, forward_dynamics, jacobian"),
        ] {
            for command in ["eval", "emit", "ops"] {
                let said = said(&format!("{command} planar2 --function {name}")).expect("refused");
                assert!(said.starts_with(&format!("error: there is no function `{name}`; ")), "{said}");
                assert!(said.contains(near) && said.len() < 250, "{said}");
            }
        }
    }

    /// The parser does not require an option that conflicts with another given one; so options that need it must
    /// conflict, too.
    #[test]
    fn nothing_is_given_without_what_it_needs() {
        for line in [
            "certify a.yaml --check a.md --force",
            "certify a.yaml --check a.md --real double",
            "emit a.yaml --lang c --check a.c --force",
            "man eval --force",
            "watch a.yaml a.csv --baseline b.yaml --save-baseline c.yaml",
            "eval a.yaml --states a.csv --payload-on hand",
        ] {
            let words = std::iter::once("rne").chain(line.split(' '));
            assert!(Arguments::try_parse_from(words).is_err(), "{line}");
        }
    }

    #[test]
    fn missing_and_stray_arguments_have_an_example() {
        for command in ["eval", "emit", "export", "ops"] {
            let example = format!("; for example rne {command} ");
            let missing = said(command).expect("refused");
            assert!(missing.contains(" needs <") && missing.contains(&example), "{missing}");
            let option = said(&format!("{command} planar2 --wibble")).expect("refused");
            assert!(option.contains("has no option --wibble; for example rne "), "{option}");
        }
        for command in ["eval", "emit", "export --urdf"] {
            let stray = said(&format!("{command} planar2 more")).expect("refused");
            assert!(stray.starts_with("error: the argument `more` is one too many for rne e"), "{stray}");
        }
        let needed = said("emit planar2 --lang c --acados").expect("refused");
        assert_eq!(needed, "error: --acados needs --casadi; give both, or neither");
        let needed = said("emit planar2 --names --force --lang c").expect("refused");
        assert_eq!(needed, "error: --force needs --output <OUT>; give both, or neither");
    }
}
