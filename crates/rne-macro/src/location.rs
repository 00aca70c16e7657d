//! From the path in the attribute to the bytes of the file.

use std::path::{Component, Path, PathBuf};
use std::{env, fmt, fs, io};

use proc_macro2::Span;
use syn::LitStr;

/// A robot file that has been read.
#[derive(Debug)]
pub(crate) struct RobotFile {
    /// Where it is, from the root, for the compiler to watch.
    pub(crate) absolute: PathBuf,
    /// What messages call it.
    pub(crate) shown: String,
    /// What is in it.
    pub(crate) bytes: Vec<u8>,
}

/// Why there is no robot file.
#[derive(Debug)]
pub(crate) enum Missing {
    /// It is in none of these places.
    NotFound { written: String, tried: Vec<String> },
    /// It is there and cannot be read.
    Unreadable { shown: String, error: io::Error },
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound { written, tried } => {
                write!(f, "there is no robot file `{written}`; these places were tried:")?;
                tried.iter().try_for_each(|place| write!(f, "\n  {place}"))?;
                f.write_str("\nA relative path starts at the folder of the source file, like that of `include_str!`.")
            }
            Self::Unreadable { shown, error } => write!(f, "the robot file `{shown}` cannot be read: {error}"),
        }
    }
}

/// Finds and reads the file of a path in the attribute.
pub(crate) fn read(literal: &LitStr) -> Result<RobotFile, Missing> {
    let source_file = source_file(literal.span());
    let package = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let working_directory = env::current_dir().unwrap_or_default();
    let written = literal.value();
    let places = places(Path::new(&written), source_file.as_deref(), package.as_deref());
    let shown = |place: &Path| shown(&working_directory.join(place), &working_directory, package.as_deref());
    for place in &places {
        match fs::read(place) {
            Ok(bytes) => {
                return Ok(RobotFile { absolute: working_directory.join(place), shown: shown(place), bytes });
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(Missing::Unreadable { shown: shown(place), error }),
        }
    }
    Err(Missing::NotFound { tried: places.iter().map(|place| shown(place)).collect(), written })
}

/// The file in which the literal stands. The compiler knows it; some editors do not.
fn source_file(span: Span) -> Option<PathBuf> {
    if proc_macro::is_available() { span.unwrap().local_file() } else { None }
}

/// Where the file may be: beside the source file as with `include_str!`, then in the package's own folder. The second is
/// for editors that do not tell the source file and for documentation tests, which have none of their own.
fn places(written: &Path, source_file: Option<&Path>, package: Option<&Path>) -> Vec<PathBuf> {
    let beside = source_file.and_then(Path::parent).map(Path::to_owned);
    let unknown = if source_file.is_none() { package.map(|package| package.join("src")) } else { None };
    let mut places = Vec::new();
    for folder in beside.into_iter().chain(unknown).chain(package.map(Path::to_owned)) {
        let place = folder.join(written);
        if !places.contains(&place) {
            places.push(place);
        }
    }
    if places.is_empty() {
        places.push(written.to_owned());
    }
    places
}

/// A path as short as it gets: from the working directory, as the compiler shows its own, or from the package.
fn shown(path: &Path, working_directory: &Path, package: Option<&Path>) -> String {
    let path = normal(path);
    let from = |folder: &Path| path.strip_prefix(normal(folder)).ok().map(Path::to_owned);
    let short = from(working_directory).or_else(|| package.and_then(from)).unwrap_or_else(|| path.clone());
    short.display().to_string()
}

/// A path without `.` and `..`, as far as that is possible without asking the file system.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(normal.components().next_back(), Some(Component::Normal(_))) => {
                normal.pop();
            }
            component => normal.push(component),
        }
    }
    normal
}
