//! The host's compiler of C.

use std::fs::{self, File};
use std::process::{Command, Stdio};

/// What is asked of the code: nothing that a compiler warns of.
const FLAGS: &[&str] = &[
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wfloat-conversion",
    "-Wshadow",
    "-Wmissing-prototypes",
    "-pedantic",
    "-Werror",
    "-ffp-contract=off",
];

/// A compiler that is there.
pub(crate) struct Compiler {
    name: String,
}

impl Compiler {
    /// `$CC` or `cc`; none where the results would not be comparable, or where there is none.
    pub(crate) fn found() -> Option<Self> {
        if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
            println!("left out: this build of Rust multiplies and adds in one rounding, C code does not");
            return None;
        }
        let name = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
        let found = Command::new(&name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        if !found.is_ok_and(|status| status.success()) {
            println!("left out: there is no compiler of C called `{name}`; CC names another");
            return None;
        }
        Some(Self { name })
    }

    /// Compiles a program and runs it: `input` are words for its standard input, in its standard output there are
    /// others.
    pub(crate) fn run(&self, name: &str, optimisation: &str, source: &str, input: &[u64]) -> Vec<u64> {
        // its own: tests of two programs run at a time, and name their robots alike
        let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("a folder");
        let path = |extension: &str| folder.path().join(format!("{name}.{extension}"));
        let (code, program, words) = (path("c"), path("bin"), path("words"));
        fs::write(&code, source).expect("written");
        let input: Vec<String> = input.iter().map(|word| format!("{word:x}")).collect();
        fs::write(&words, input.join("\n")).expect("written");

        let compiled =
            Command::new(&self.name).args(FLAGS).arg(optimisation).arg("-o").args([&program, &code]).output();
        let compiled = compiled.expect("it starts");
        let complaint: String = String::from_utf8_lossy(&compiled.stderr).chars().take(3000).collect();
        assert!(compiled.status.success() && complaint.is_empty(), "{name}: {complaint}");

        let computed =
            Command::new(&program).stdin(File::open(&words).expect("it is there")).output().expect("it starts");
        assert!(computed.status.success(), "{name}: {computed:?}");
        let words = String::from_utf8(computed.stdout).expect("digits");
        words.lines().map(|word| u64::from_str_radix(word, 16).expect("a word")).collect()
    }
}
