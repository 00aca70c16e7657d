//! What is no regular file, and names that a file should not have.

use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::process::Command;

use super::robot_files::ARM;
use super::{Case, Expected, written};

/// What reads a robot file, and what reads a URDF.
const COMMANDS: [&[&str]; 8] = [
    &["check"],
    &["show"],
    &["ops"],
    &["emit"],
    &["eval", "--q", "0"],
    &["convert", "--convention", "modified"],
    &["export", "--urdf"],
    &["import"],
];

fn every_command(what: &str, path: &str, expected: Expected, names: &str) -> Vec<Case> {
    let case = |command: &&[&str]| {
        let (name, options) = command.split_first().expect("a name");
        let arguments: Vec<&str> = [*name, path].into_iter().chain(options.iter().copied()).collect();
        Case::new(format!("{what}, {name}"), &arguments, expected).naming(names)
    };
    COMMANDS.iter().map(case).collect()
}

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let place = |name: &str| folder.join(name);
    let made = Command::new("mkfifo").arg(place("pipe.yaml")).status();
    assert!(made.is_ok_and(|made| made.success()), "a pipe");
    symlink("circle.yaml", place("circle.yaml")).expect("a link");
    symlink("nowhere", place("dangling.yaml")).expect("a link");
    symlink("/dev/zero", place("zero.yaml")).expect("a link");
    symlink(place("pipe.yaml"), place("to_pipe.yaml")).expect("a link");
    fs::create_dir_all(place("folder.yaml")).expect("a folder");
    let in_folder = |name: &str| place(name).to_str().expect("UTF-8").to_owned();
    // a socket's name is short: it stands in the folder of the process while it is made
    let socket = UnixListener::bind(place("s")).is_ok().then(|| in_folder("s"));
    let long = "x".repeat(5000);
    let deep = "a/".repeat(3000);

    let refused = |words| Expected::Refused(1, words);
    let mut cases = Vec::new();
    let mut all = |what: &str, path: &str, words, names: &str| {
        cases.extend(every_command(what, path, refused(words), names));
    };
    all("a pipe without a writer", &in_folder("pipe.yaml"), "it is a pipe, a socket or a device", "pipe.yaml");
    all("a link to it", &in_folder("to_pipe.yaml"), "it is a pipe, a socket or a device", "to_pipe.yaml");
    all("a circle of links", &in_folder("circle.yaml"), "cannot be read", "circle.yaml");
    all("a link to nothing", &in_folder("dangling.yaml"), "there is no", "dangling.yaml");
    all("a device without an end, by a link", &in_folder("zero.yaml"), "not a regular file", "zero.yaml");
    all("a device without an end", "/dev/zero", "not a regular file", "/dev/zero");
    all("a device of nothing", "/dev/null", "not a regular file", "/dev/null");
    all("a folder", &in_folder("folder.yaml"), "folder.yaml", "folder.yaml");
    all("a file below a file", "/dev/null/x.yaml", "cannot be read", "/dev/null/x.yaml");
    all("5,000 letters", &long, "cannot be read", "xxx");
    all("3,000 folders", &deep, "cannot be read", "a/a/a");
    all("a missing file that controls", "no\u{1B}[2J\u{7}\u{9B}2J\u{202E}\n.yaml", "there is no", "no");
    all("no descriptor", "/dev/fd/99", "", "/dev/fd/99");
    if let Some(socket) = &socket {
        all("a socket", socket, "it is a pipe, a socket or a device", socket);
    }
    if cfg!(target_os = "linux") {
        all("the memory of the process", "/proc/self/mem", "cannot be read", "/proc/self/mem");
    }

    cases.extend(every_command("nothing", "", Expected::Refused(2, "a value is required"), ""));
    // names as of good files; pipes and standard input, which are read
    for name in
        ["-rf.yaml", "a b.yaml", "$(touch here).yaml", "\u{202E}\u{1B}[2J.yaml", "\n.yaml", "CON.yaml", "x.YAML"]
    {
        let path = written(folder, 1, name, ARM);
        cases.extend(["check", "ops"].map(|command| Case::new("a name", &[command, &path], Expected::Taken)));
    }
    let arm = written(folder, 2, "arm.yaml", ARM);
    let zeros = written(folder, 3, "zeros", vec![0; 3 << 20]);
    for stream in ["-", "/dev/stdin", "/dev/fd/0"] {
        let piped = |what: &str, arguments: &[&str], piped: &str, expected| Case {
            piped: Some(piped.into()),
            ..Case::new(format!("{what} as {stream}"), arguments, expected)
        };
        cases.extend([
            piped("an arm", &["check", stream], &arm, Expected::Taken),
            piped("an arm", &["emit", stream, "--lang", "c"], &arm, Expected::Taken),
            piped("nothing", &["check", stream], "/dev/null", refused("the file is empty")),
            piped("an endless stream", &["check", stream], "/dev/zero", refused("more than 1048576 bytes")),
            piped("an endless stream", &["import", stream], "/dev/zero", refused("there is no element `robot`")),
            piped("zeros", &["show", stream], &zeros, refused("more than 1048576 bytes")),
            piped("an arm", &["search", stream], &arm, Expected::Refused(2, "it needs a file")),
        ]);
    }
    cases
}
