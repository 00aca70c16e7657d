//! Compares the names that users rely on with a list, so that none disappears unnoticed.

use std::collections::BTreeSet;

use anyhow::{Context, Result, bail};
use clap::Args;
use regex_lite::Regex;
use serde_json::Value;
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Compares the names that users have with the committed list
///
/// The list is `tests/surface.txt`: a line for each command, option, value of an option, key of `--json`, name of the
/// Python package, name of the C library, and SQL function. A test of the SQL functions compares their lines.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a name is new or is missing.

Examples:
  cargo xtask surface             compare
  cargo xtask surface --update    write the list anew; git diff tests/surface.txt then says what changed")]
pub(crate) struct Surface {
    /// Write the list anew instead of comparing with it
    #[arg(long)]
    update: bool,
}

const LIST: &str = "tests/surface.txt";

/// Commands that print JSON, each with files of this repository as arguments.
const JSON: &[&str] = &[
    "eval planar2 --q 0,0",
    "eval puma560 --q 0,0,0,0,0,0 --function joint_wrenches",
    "eval docs/satellite.yaml --q 0,0 --function floating_forward_dynamics --tau 0,0",
    "ops planar1 --function inverse_dynamics",
    "show planar1",
    "diagnose planar2 --q 0.3,0.5 --qd 1,2 --qdd 0.5,-1 --tau=-14.1097,-1.95268",
    "mark planar1 --states docs/teaching/lecture/class/key.csv docs/teaching/lecture/class/ada.csv",
    "log docs/desk_arm_log.csv --robot docs/desk_arm.yaml",
    "identify docs/desk_arm.yaml docs/desk_arm_log.csv --hold-out 0.3",
    "watch docs/desk_arm_identified.yaml docs/desk_arm_worn.csv --quiet docs/desk_arm_log.csv",
];

impl Surface {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let rne = |arguments: &str| -> Result<String> {
            let arguments = arguments.split(' ');
            Ok(cmd!(shell, "cargo run --quiet -- {arguments...}").quiet().ignore_status().ignore_stderr().read()?)
        };
        let committed = machine::read(LIST).unwrap_or_default();
        // the query engine takes minutes to compile, so a test in its own workspace compares these names
        let sql = committed.lines().filter(|line| line.starts_with("sql ")).map(str::to_owned);
        let mut names: BTreeSet<String> = sql.collect();
        of_command_line(&rne("completions fish")?, &mut names)?;
        for command in JSON {
            let printed = rne(&format!("{command} --json"))?;
            let value = serde_json::from_str(&printed).with_context(|| format!("rne {command} --json"))?;
            let command = command.split(' ').next().unwrap_or_default();
            keys(&format!("json {command} "), &value, &mut names);
        }
        of_python(&machine::read("doors/python/package/rne/__init__.pyi")?, &mut names)?;
        for found in Regex::new(r"\b(rne|RNE)_\w+")?.find_iter(&machine::read("doors/c/include/rne.h")?) {
            names.insert(format!("c {}", found.as_str()));
        }
        if self.update {
            let lines: Vec<&str> = names.iter().map(String::as_str).collect();
            machine::write(LIST, &format!("{}\n", lines.join("\n")))?;
            println!("{} names in {LIST}", names.len());
            return Ok(Verdict::Holds);
        }
        let committed: BTreeSet<String> = committed.lines().map(str::to_owned).collect();
        for missing in committed.difference(&names) {
            println!("missing: {missing}");
        }
        for new in names.difference(&committed) {
            println!("new: {new}");
        }
        println!("surface: {} names", names.len());
        Ok(Verdict::from(names == committed))
    }
}

/// Adds commands, options and values of options, from the completions for a shell.
fn of_command_line(completions: &str, names: &mut BTreeSet<String>) -> Result<()> {
    let line = Regex::new(r#"^complete -c rne -n "__fish_rne_using_subcommand (\w+)" .*?-l ([\w-]+)"#)?;
    let value = Regex::new(r#"(?:^|-a ")([\w.-]+)\\t"#)?;
    let mut option = None;
    for text in completions.lines() {
        if let Some(found) = line.captures(text) {
            names.insert(format!("command {} --{}", &found[1], &found[2]));
            option = Some(found[2].to_owned());
        } else if text.starts_with("complete") {
            option = None;
        }
        if let (Some(option), Some(value)) = (&option, value.captures(text)) {
            names.insert(format!("value --{option} {}", &value[1]));
        }
    }
    if names.len() < 100 {
        bail!("the completions name {} commands, options and values: their form has changed", names.len());
    }
    Ok(())
}

/// Adds the paths of all keys in a JSON document. All elements of a list have the same path.
fn keys(path: &str, value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                // the keys below `names` depend on the robot, so they are replaced by `*`
                let key = if path.rsplit('.').next() == Some("names") { "*" } else { key };
                let path = format!("{path}.{key}");
                names.insert(path.clone());
                keys(&path, value, names);
            }
        }
        Value::Array(elements) => elements.iter().for_each(|element| keys(path, element, names)),
        _ => {}
    }
}

/// Adds the names in a Python stub: classes, their members, functions with their arguments, and types.
fn of_python(stub: &str, names: &mut BTreeSet<String>) -> Result<()> {
    let name = Regex::new(r"^( *)(?:(class|def) (\w+)|(\w+)(?:: | = ))")?;
    let argument = Regex::new(r"(?:[(,*] ?|^ +)(\w+): ")?;
    let (mut class, mut function) = (String::new(), None::<String>);
    for line in stub.lines() {
        if let Some(found) = name.captures(line).filter(|_| function.is_none()) {
            let own = found.get(3).or(found.get(4)).map_or("", |name| name.as_str());
            if found[1].is_empty() {
                class.clear();
            }
            names.insert(format!("python {class}{own}"));
            match found.get(2).map(|kind| kind.as_str()) {
                Some("class") => class = format!("{own}."),
                Some("def") => function = Some(format!("{class}{own}")),
                _ => {}
            }
        }
        let Some(of) = &function else { continue };
        for found in argument.captures_iter(line) {
            names.insert(format!("python {of}({})", &found[1]));
        }
        if line.contains("->") {
            function = None;
        }
    }
    Ok(())
}
