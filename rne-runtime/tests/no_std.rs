//! The runtime builds into a library that has neither `std` nor an allocator.

use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn a_static_library_without_std() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let library = here.join("tests/no_std");
    // The versions that are at hand, since they built this test: the build below needs no network.
    fs::copy(here.join("../Cargo.lock"), library.join("Cargo.lock")).expect("the workspace's lock file");

    // that of tests/users
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("tests").join("trybuild");
    let output = Command::new(env!("CARGO"))
        .args(["build", "--offline", "--manifest-path"])
        .arg(library.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        // Flags of the calling build (coverage, sanitizers) may need `std`.
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env("CARGO_INCREMENTAL", "0")
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
