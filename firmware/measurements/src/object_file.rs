//! Compiles the certified functions to an object file, for a target without an emulated board.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};

use crate::tools::Build;

/// Compiles the robots for a target without linking.
pub(crate) fn build(workspace: &Path, target: &str, flags: &[&str], features: &[&str]) -> Result<PathBuf> {
    // with link-time optimisation, the file would not contain machine code
    let arguments = [features, &["--config=profile.release.lto=\"off\"", "--", "--emit=obj"]].concat();
    let build = Build { target, linker: "false", flags, package: "robots", arguments: &arguments };
    let folder = build.run(workspace)?.join("deps");
    newest(&folder)?.with_context(|| format!("cargo left no object file in {}", folder.display()))
}

/// Returns the newest object file; older ones were compiled with other flags.
fn newest(folder: &Path) -> Result<Option<PathBuf>> {
    let mut newest: Option<(SystemTime, PathBuf)> = None;
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry?;
        let path = entry.path();
        let is_ours = entry.file_name().to_string_lossy().starts_with("robots-");
        if is_ours && path.extension().is_some_and(|extension| extension == "o") {
            let modified = entry.metadata()?.modified()?;
            if newest.as_ref().is_none_or(|(time, _)| *time <= modified) {
                newest = Some((modified, path));
            }
        }
    }
    Ok(newest.map(|(_, path)| path))
}
