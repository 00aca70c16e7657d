//! The strict user of `tests/hygiene` gets no warning, from rustc or clippy, without `std`.

use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn generated_code_is_quiet() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let strict = package.join("tests/hygiene");
    // The versions that are at hand, since they built this test: the check below needs no network.
    fs::copy(package.join("Cargo.lock"), strict.join("Cargo.lock")).expect("the workspace's lock file");

    let cargo = || {
        let mut command = Command::new(env!("CARGO"));
        // Flags of the calling build (coverage, sanitizers) are not the user's.
        command.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS");
        command
    };
    let has_clippy = cargo().args(["clippy", "--version"]).output().is_ok_and(|output| output.status.success());
    if !has_clippy {
        println!("clippy is not installed: checked with rustc alone");
    }
    let output = cargo()
        .args([if has_clippy { "clippy" } else { "check" }, "--offline", "--manifest-path"])
        .arg(strict.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join("users"))
        .output()
        .expect("cargo runs");
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !messages.contains("warning"), "{messages}");
}
