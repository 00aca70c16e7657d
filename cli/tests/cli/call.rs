//! Calling `rne` as a user does: from the root of the project, as a process of its own.

use std::fs;
use std::io::Write as _;
use std::ops::{Deref, DerefMut};
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};

/// The root of the project, where `robots/` is.
pub(crate) const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// What a call printed, and its exit status.
#[derive(Debug)]
pub(crate) struct Called {
    pub(crate) out: String,
    pub(crate) err: String,
    pub(crate) status: i32,
}

impl Called {
    /// What was said on standard error, as one line: where a message is broken depends on how long the paths in it are.
    pub(crate) fn said(&self) -> String {
        self.err.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}

pub(crate) fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rne"));
    command.current_dir(ROOT).args(arguments).stdin(Stdio::null()).env_remove("CLICOLOR_FORCE");
    command
}

pub(crate) fn rne(arguments: &[&str]) -> Called {
    called(command(arguments).output().expect("rne starts"))
}

pub(crate) fn called(output: Output) -> Called {
    let Output { status, stdout, stderr } = output;
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    Called { out: text(stdout), err: text(stderr), status: status.code().expect("no signal") }
}

/// A program that runs beside a test, and ends with it: where the test fails, nothing runs on.
pub(crate) struct Running(Child);

impl Running {
    pub(crate) fn of(command: &mut Command) -> Self {
        Self(command.spawn().expect("the program starts"))
    }
}

impl Deref for Running {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.0
    }
}

impl DerefMut for Running {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.0
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // it has ended, unless the test fails
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A call that reads this text from standard input.
pub(crate) fn rne_reading(arguments: &[&str], text: &str) -> Called {
    let mut command = command(arguments);
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("rne starts");
    // a call that refuses its arguments need not read
    let _ = child.stdin.take().expect("a pipe").write_all(text.as_bytes());
    called(child.wait_with_output().expect("rne ends"))
}

/// The remark on efforts of a log whose unit nobody said, in the lines of `rne identify` and `rne watch`.
pub(crate) const EFFORTS: &str = "note: efforts are taken as torques, N m, or forces, N; if they are currents,\n      \
                                  give the N m/A with --torque-constant\n";

/// A call that succeeds and says nothing on standard error, but which positions and velocities are outside of the
/// limits of the file, how many warnings the file has, that rotors are left out, and that efforts are taken as torques.
pub(crate) fn fine(arguments: &[&str]) -> String {
    let called = rne(arguments);
    let is_note = |line: &str| {
        line.starts_with("note: q") && line.contains(" is outside of the limits of ")
            || line.starts_with("note: qd") && line.contains(" is beyond the velocity limit of ")
            || line.contains(" in the robot file; rne check ")
            || line.starts_with("note: 1 warning with ")
            || line.contains(" random states are few: ")
            || line.starts_with("the inertia of the rotors is left out")
            || EFFORTS.lines().any(|of| of == line)
    };
    let said: Vec<&str> = called.err.lines().filter(|line| !is_note(line)).collect();
    assert!(called.status == 0 && said.is_empty(), "{arguments:?}: {called:?}");
    called.out
}

/// A call that fails with `status` and has every one of `parts` in its message.
pub(crate) fn fails(status: i32, arguments: &[&str], parts: &[&str]) {
    let called = rne(arguments);
    assert_eq!(called.status, status, "{arguments:?}: {called:?}");
    assert_eq!(called.out, "", "{arguments:?}: an error is no answer");
    let said = called.said();
    for part in parts {
        assert!(called.err.contains(part) || said.contains(part), "{arguments:?}: no `{part}` in {}", called.err);
    }
}

/// An empty folder for one test.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}
