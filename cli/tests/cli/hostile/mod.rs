//! Inputs that want to break something: for each the binary runs with little memory and little time of the processor,
//! and must take it, or refuse it with a message that names the file.
//!
//! The limits are those of a shell on Linux; elsewhere the same inputs run without them. Time is that of the processor,
//! so a busy machine fails nothing.

mod command_lines;
mod logs;
mod outputs;
mod paths;
mod plans;
mod robot_files;
mod robots;
mod urdfs;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Mutex;

use crate::call::folder;

/// Address space, kB. The code itself counts: 40 MB of it where it is not optimised, SQLite and Parquet included.
const MEMORY: u32 = if cfg!(debug_assertions) { 240 * 1024 } else { 200 * 1024 };

/// Time of the processor, s. Code that is not optimised takes ten times as long.
const SECONDS: u32 = if cfg!(debug_assertions) { 20 } else { 2 };

/// What must come of an input.
#[derive(Clone, Copy, Debug)]
enum Expected {
    /// Status 0.
    Taken,
    /// This status, 1 or 2 where the command line is at fault, and a message with these words.
    Refused(u8, &'static str),
    /// Status 1 or 2.
    Failed,
    /// Status 1 or 2, and a message with these words.
    FailedSaying(&'static str),
    /// Any of the three: what a valid robot can be used for, its numbers decide.
    Either,
}

/// An input, and the command that it is given to.
struct Case {
    what: String,
    arguments: Vec<String>,
    /// Read by the shell from a file, and given to the command by a pipe.
    piped: Option<PathBuf>,
    expected: Expected,
    /// What the message must name, if there is one.
    names: String,
    /// No file may get a byte, as on a full disk.
    has_room: bool,
}

impl Case {
    fn new<A: AsRef<str>>(what: impl Into<String>, arguments: &[A], expected: Expected) -> Self {
        let arguments = arguments.iter().map(|argument| argument.as_ref().to_owned()).collect();
        Self { what: what.into(), arguments, piped: None, expected, names: String::new(), has_room: true }
    }

    fn naming(self, names: impl Into<String>) -> Self {
        Self { names: names.into(), ..self }
    }

    fn without_room(self) -> Self {
        Self { has_room: false, ..self }
    }
}

/// Taken where no words are given, else refused with these.
fn as_said(words: &'static str) -> Expected {
    if words.is_empty() { Expected::Taken } else { Expected::Refused(1, words) }
}

/// Writes an input as a file of its own folder.
fn written(folder: &Path, index: usize, name: &str, bytes: impl AsRef<[u8]>) -> String {
    let folder = folder.join(index.to_string());
    fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    fs::write(&path, bytes).expect("a file");
    path.to_str().expect("UTF-8").to_owned()
}

/// The limited call, in a folder of its own, from which every name that the command gives a file leads.
fn call(case: &Case, folder: &Path) -> Output {
    let mut limits = if cfg!(target_os = "linux") {
        format!("ulimit -v {MEMORY} && ulimit -t {SECONDS} && ")
    } else {
        String::new()
    };
    if !case.has_room {
        // the system ends a process that writes more, unless it passes over that signal
        limits += "trap '' XFSZ && ulimit -f 0 && ";
    }
    let line = match &case.piped {
        Some(_) => format!("{limits} cat \"$INPUT\" | \"$@\""),
        None => format!("{limits} exec \"$@\""),
    };
    let mut command = Command::new("sh");
    command.args(["-c", &line, "sh", env!("CARGO_BIN_EXE_rne")]).args(&case.arguments).current_dir(folder);
    command.stdin(Stdio::null()).env_remove("CLICOLOR_FORCE").env_remove("RUST_BACKTRACE");
    if let Some(piped) = &case.piped {
        command.env("INPUT", piped);
    }
    command.output().expect("a shell")
}

/// What is wrong with the answer to an input.
fn fault(case: &Case, output: &Output) -> Option<String> {
    let said = [&output.stdout[..], &output.stderr[..]].concat();
    let Ok(said) = String::from_utf8(said) else { return Some("it says what is not UTF-8".to_owned()) };
    let (allowed, words): (&[i32], &str) = match case.expected {
        Expected::Taken => (&[0], ""),
        Expected::Refused(1, words) => (&[1], words),
        Expected::Refused(_, words) => (&[2], words),
        Expected::Failed => (&[1, 2], ""),
        Expected::FailedSaying(words) => (&[1, 2], words),
        Expected::Either => (&[0, 1, 2], ""),
    };
    let status = output.status.code().unwrap_or_default();
    // a shell tells of a signal by 128 and its number
    let is_ended = output.status.code().is_none_or(|status| status > 128);
    let fault = if is_ended || said.contains("panicked") || said.contains("allocation") {
        format!("it ends by {}", output.status)
    } else if !allowed.contains(&status) {
        format!("status {status}, not {allowed:?}")
    } else if !said.contains(words) {
        format!("not said: {words}")
    } else if status != 0 && !said.contains(&case.names) {
        format!("not named: {}", case.names)
    } else if let Some(c) = said.chars().find(|&c| c != '\n' && controls(c)) {
        format!("the control character {c:?} is printed")
    } else if said.len() > 1 << 20 && status != 0 {
        format!("a message of {} bytes", said.len())
    } else {
        return None;
    };
    let shown: String = said.chars().take(600).collect();
    Some(format!("{fault}:\n{shown}"))
}

/// Whether a character does something to a terminal or to the order of a text.
fn controls(c: char) -> bool {
    let bidirectional = ['\u{61C}', '\u{200E}', '\u{200F}', '\u{2028}', '\u{2029}'].contains(&c);
    c.is_control() || bidirectional || ('\u{202A}'..='\u{202E}').contains(&c) || ('\u{2066}'..='\u{2069}').contains(&c)
}

/// The names of everything in a folder.
fn names(folder: &Path) -> BTreeSet<PathBuf> {
    fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
}

#[test]
#[cfg(unix)]
fn hostile_inputs() {
    let folder = folder("hostile");
    let place = |name: &str| {
        let place = folder.join(name);
        fs::create_dir_all(&place).expect("a folder");
        place
    };
    let cases: Vec<Case> = [
        robot_files::cases(&place("robot_files")),
        robots::cases(&place("robots")),
        plans::cases(&place("plans")),
        urdfs::cases(&place("urdfs")),
        paths::cases(&place("paths")),
        command_lines::cases(&place("command_lines")),
        logs::cases(&place("logs")),
        outputs::cases(&place("outputs")),
    ]
    .into_iter()
    .flatten()
    .collect();
    assert!(cases.len() >= 200, "{} inputs", cases.len());
    let one_in = if shipped::is_exhaustive() { 1 } else { 8 };

    // where the commands run: what they write stays there
    let here = place("here/below");
    let beside = names(&place("here"));
    let rest = Mutex::new(cases.iter().step_by(one_in));
    let faults = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let Some(case) = rest.lock().expect("no panic").next() else { break };
                    let shown: Vec<String> =
                        case.arguments.iter().map(|argument| argument.chars().take(80).collect()).collect();
                    if let Some(fault) = fault(case, &call(case, &here)) {
                        let fault = format!("{}: {}\n{fault}", case.what, shown.join(" "));
                        faults.lock().expect("no panic").push(fault);
                    }
                }
            });
        }
    });
    let mut faults = faults.into_inner().expect("no panic");
    faults.extend(outputs::faults(&place("outputs")));
    let left = names(&here).into_iter().filter(|path| path.ends_with("-") || path.extension() == Some("tmp".as_ref()));
    faults.extend(left.map(|path| format!("left: {}", path.display())));
    println!("{} inputs within {MEMORY} kB and {SECONDS} s", cases.len());
    assert!(faults.is_empty(), "{} of {}\n\n{}", faults.len(), cases.len(), faults.join("\n\n"));
    assert_eq!(names(&place("here")), beside, "nothing is written elsewhere");
}
