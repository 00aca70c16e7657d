//! Checks names of output files: the extension says the format, and no other format is written into the file.

use std::path::Path;

use crate::outcome::Failure;
use crate::palette::TYPED;

/// A format of output files.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Format {
    Csv,
    Npy,
    Parquet,
    RobotFile,
    Urdf,
    Svg,
    Html,
    Rust,
    C,
    Ptx,
    Cuda,
    Fmu,
}

/// Extensions of other formats, which rne does not write.
const OTHERS: [&str; 14] =
    ["bag", "cc", "cpp", "cxx", "db3", "jpg", "json", "mcap", "npz", "pdf", "png", "py", "toml", "xacro"];

impl Format {
    const ALL: [Self; 12] = [
        Self::Csv,
        Self::Npy,
        Self::Parquet,
        Self::RobotFile,
        Self::Urdf,
        Self::Svg,
        Self::Html,
        Self::Rust,
        Self::C,
        Self::Ptx,
        Self::Cuda,
        Self::Fmu,
    ];

    /// Returns the extensions of the format, the usual one first.
    const fn ends(self) -> &'static [&'static str] {
        match self {
            Self::Csv => &["csv"],
            Self::Npy => &["npy"],
            Self::Parquet => &["parquet"],
            Self::RobotFile => &["yaml", "yml"],
            Self::Urdf => &["urdf", "xml"],
            Self::Svg => &["svg"],
            Self::Html => &["html", "htm"],
            Self::Rust => &["rs"],
            // the header of a C source is written beside it
            Self::C => &["c", "h"],
            Self::Ptx => &["ptx"],
            // this code can also be included as a C++ header
            Self::Cuda => &["cuh", "cu", "hpp"],
            Self::Fmu => &["fmu"],
        }
    }
}

/// Returns the format of a table from the name of its file; it must be one of `written`.
pub(crate) fn format(path: &Path, written: &[Format]) -> Result<Format, Failure> {
    let end = end(path);
    if let Some(format) = written.iter().find(|format| format.ends().contains(&end.as_str())) {
        return Ok(*format);
    }
    let ends: Vec<String> = written.iter().map(|format| format!("{TYPED}.{}{TYPED:#}", format.ends()[0])).collect();
    let shown = path.display();
    let has = match end.as_str() {
        "" => format!("the name {shown} has no ending that gives the format"),
        end => format!("{shown} ends with .{end}, which this command does not write"),
    };
    Err(usage_error!("{has}; name a file that ends with {}", ends.join(" or ")))
}

/// Checks that a name does not have the extension of another format. A name may have an unknown extension or none.
pub(crate) fn check(path: &Path, written: Format) -> Result<(), Failure> {
    let end = end(path);
    let is_known = || OTHERS.into_iter().chain(Format::ALL.iter().flat_map(|format| format.ends().iter().copied()));
    if written.ends().contains(&end.as_str()) || !is_known().any(|known| known == end) {
        return Ok(());
    }
    let right = path.with_extension(written.ends()[0]);
    Err(usage_error!(
        "{} ends with .{end}, but the file is written as .{}; name it {TYPED}{}{TYPED:#}",
        path.display(),
        written.ends()[0],
        right.display()
    ))
}

/// Returns the extension of a file name in small letters; empty if the name has no extension.
fn end(path: &Path) -> String {
    path.extension().map_or_else(String::new, |end| end.to_string_lossy().to_lowercase())
}
