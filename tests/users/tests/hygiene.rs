//! The strict user of `tests/users/tests/hygiene` gets no warning, from rustc or clippy, without `std`.

mod build;

use std::path::Path;
use std::process::Command;

#[test]
fn generated_code_is_quiet() {
    let strict = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hygiene");
    let clippy = Command::new(env!("CARGO")).args(["clippy", "--version"]).output();
    let has_clippy = clippy.is_ok_and(|output| output.status.success());
    if !has_clippy {
        println!("clippy is not installed: checked with rustc alone");
    }
    let output = build::cargo(if has_clippy { "clippy" } else { "check" }, &strict).output().expect("cargo runs");
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !messages.contains("warning"), "{messages}");
}
