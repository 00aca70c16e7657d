//! Builds of users. All share a target folder, so that what the derive is made of is built once for them.
#![allow(dead_code)] // each test uses its part

use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the repository, where `rne` is.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("this package is two folders below it")
}

/// The target folder: that of trybuild, which nobody can choose.
pub(crate) fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("tests").join("trybuild")
}

/// The manifest of a user's package that needs `rne` alone.
pub(crate) fn manifest(name: &str) -> String {
    let rne = root().display();
    format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         rne = {{ path = '{rne}', default-features = false }}\n\n[workspace]\n"
    )
}

/// Cargo in a folder, without the network: the versions are those that built this test.
pub(crate) fn cargo(command: &str, folder: &Path) -> Command {
    std::fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).expect("the workspace's lock file");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([command, "--offline", "--color", "never", "--target-dir"]).arg(target()).current_dir(folder);
    // Flags of the calling build (coverage, sanitizers) are not the user's. As trybuild has it: nothing is built twice.
    cargo.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS").env("CARGO_INCREMENTAL", "0");
    cargo
}
