//! Finds and reads the robot file that the attribute names.

use std::collections::VecDeque;
use std::path::{Component, Path, PathBuf};
use std::{env, fmt, fs, io};

use proc_macro2::Span;
use rne_model::{golden_of, misnamed_golden_of, no_shipped_robot, plan_of, read_file};
use syn::LitStr;

/// A robot file that has been read.
#[derive(Debug)]
pub(crate) struct RobotFile {
    /// The absolute path of the file, which the compiler must watch; `None` for a shipped robot, whose file is part of
    /// this macro.
    pub(crate) absolute: Option<PathBuf>,
    /// Name of the file in messages.
    pub(crate) shown: String,
    /// Contents of the file.
    pub(crate) bytes: Vec<u8>,
}

/// Why there is no robot file.
#[derive(Debug)]
pub(crate) enum Missing {
    /// The file exists in none of these places. `meant` is a path that the user may have meant.
    NotFound { written: String, tried: Vec<Place>, meant: Option<String> },
    /// The file exists but cannot be read.
    Unreadable { shown: String, error: io::Error },
}

/// A place where the file may be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// The description of the place, for messages.
    what: &'static str,
    /// The path of the file in this place.
    file: PathBuf,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound { written, tried, meant } => {
                write!(f, "there is no robot file `{written}`")?;
                // An absolute path has only one place, which the message has named.
                if Path::new(written).is_absolute() {
                    return Ok(());
                }
                f.write_str("\n")?;
                for Place { what, file } in tried {
                    write!(f, "\n  {what}: {}", file.display())?;
                }
                f.write_str("\n\na relative path starts at the folder of the source file, as with `include_str!`")?;
                if let Some(meant) = meant {
                    write!(f, "; did you mean `{meant}`?")?;
                }
                f.write_str("\n")
            }
            Self::Unreadable { shown, error } if error.kind() == io::ErrorKind::IsADirectory => {
                write!(f, "`{shown}` is a folder; name a robot file in it")
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
    let short = |file: &Path| short(&working_directory.join(file), &working_directory, package.as_deref());
    let guessed = package.as_deref().filter(|_| source_file.is_none());
    let guessed = guessed.into_iter().flat_map(|package| guesses(Path::new(&written), package));
    for file in places.iter().map(|place| place.file.clone()).chain(guessed) {
        let shown = || {
            short(&file)
                .map(|file| file.display().to_string())
                .filter(|shown| !shown.is_empty())
                .unwrap_or_else(|| written.clone())
        };
        match read_file(&file) {
            Ok(bytes) => return Ok(RobotFile { absolute: Some(working_directory.join(&file)), shown: shown(), bytes }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(Missing::Unreadable { shown: shown(), error }),
        }
    }
    let source_folder = source_file.as_deref().and_then(Path::parent).map(|folder| working_directory.join(folder));
    let meant = source_folder
        .and_then(|folder| neighbours(Path::new(&written), &folder).find(|path| folder.join(path).is_file()));
    let tried = places
        .into_iter()
        .map(|place| Place { file: short(&place.file).unwrap_or_else(|| normal(&place.file)), ..place });
    Err(Missing::NotFound { tried: tried.collect(), meant: meant.map(|path| path.display().to_string()), written })
}

/// The plan file beside a robot file, if there is one.
pub(crate) fn plan_beside(file: &RobotFile) -> Result<Option<RobotFile>, Missing> {
    beside(file, plan_of)
}

/// The golden file beside a robot file, if there is one.
pub(crate) fn golden_beside(file: &RobotFile) -> Result<Option<RobotFile>, Missing> {
    beside(file, golden_of)
}

/// Returns a file beside a robot file that was probably meant to be its golden file, and the name that it should have.
pub(crate) fn misnamed_golden_beside(file: &RobotFile) -> Option<(String, String)> {
    let found = misnamed_golden_of(file.absolute.as_deref()?)?;
    let shown = Path::new(&file.shown);
    let found = shown.with_file_name(found.file_name()?);
    Some((found.display().to_string(), golden_of(shown).display().to_string()))
}

fn beside(file: &RobotFile, name: fn(&Path) -> PathBuf) -> Result<Option<RobotFile>, Missing> {
    let Some(absolute) = file.absolute.as_deref().map(name) else { return Ok(None) };
    let shown = name(Path::new(&file.shown)).display().to_string();
    match read_file(&absolute) {
        Ok(bytes) => Ok(Some(RobotFile { absolute: Some(absolute), shown, bytes })),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Missing::Unreadable { shown, error }),
    }
}

/// Finds a shipped robot and its plan; if there is no robot of this name, the error lists all names.
pub(crate) fn shipped(name: &str) -> Result<(RobotFile, Option<RobotFile>), String> {
    let Some(robot) = rne_robots::find(name) else {
        let names: Vec<&str> = rne_robots::all().map(|robot| robot.name).collect();
        return Err(no_shipped_robot(name, &names));
    };
    let file = |extension: &str, text: &str| RobotFile {
        absolute: None,
        shown: format!("{name}.{extension} (shipped)"),
        bytes: text.as_bytes().to_vec(),
    };
    Ok((file("yaml", robot.yaml), robot.plan.map(|plan| file("plan.yaml", plan))))
}

/// Returns the source file that contains the literal. The compiler knows it, but some editors do not.
fn source_file(span: Span) -> Option<PathBuf> {
    if proc_macro::is_available() { span.unwrap().local_file() } else { None }
}

/// Returns the places of a file: relative to the source file, as with `include_str!`. If the source file is unknown, as
/// in some editors, relative to folders of the package.
fn places(written: &Path, source_file: Option<&Path>, package: Option<&Path>) -> Vec<Place> {
    let beside = source_file.and_then(Path::parent).map(|folder| ("beside the source file", folder.to_owned()));
    let package = package.filter(|_| beside.is_none());
    let sources = package.map(|package| ("in the sources", package.join("src")));
    let package = package.map(|package| ("in the package folder", package.to_owned()));
    let mut places: Vec<Place> = Vec::new();
    for (what, folder) in beside.into_iter().chain(sources).chain(package) {
        let place = Place { what, file: folder.join(written) };
        // An absolute path gives the same file for every folder.
        if places.iter().all(|other| other.file != place.file) {
            places.push(place);
        }
    }
    places
}

/// Returns further paths to try when the source file is unknown. The source file is in some folder with sources, so the
/// path is tried relative to each of them, at most 200, those near the package first. At last the path without its
/// leading `..` is tried in the package and in `src`.
fn guesses(written: &Path, package: &Path) -> Vec<PathBuf> {
    const FOLDERS: usize = 200;
    if written.is_absolute() {
        return Vec::new();
    }
    let mut waiting: VecDeque<PathBuf> = ["src", "tests", "examples", "benches"].map(|name| package.join(name)).into();
    let mut folders = Vec::new();
    while let Some(folder) = waiting.pop_front().filter(|_| folders.len() < FOLDERS) {
        let inside = fs::read_dir(&folder).into_iter().flatten().flatten();
        let inside = inside.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
        let mut inside: Vec<PathBuf> = inside.map(|entry| entry.path()).collect();
        inside.sort();
        waiting.extend(inside);
        folders.push(folder);
    }
    // normalised first, because `a/../b` is only found if the folder `a` exists
    let mut guesses: Vec<PathBuf> = folders.iter().map(|folder| normal(&folder.join(written))).collect();
    let is_up = |part: &Component<'_>| matches!(part, Component::ParentDir | Component::CurDir);
    let rest: PathBuf = written.components().skip_while(is_up).collect();
    guesses.extend([package.join(&rest), package.join("src").join(&rest)]);
    guesses
}

/// Lists files of this name in the folders above the source file, nearest first. One of them may be the intended file,
/// if the path has a wrong number of `..`.
fn neighbours(written: &Path, source_folder: &Path) -> impl Iterator<Item = PathBuf> {
    let named: PathBuf = written.components().filter(|part| matches!(part, Component::Normal(_))).collect();
    let levels = normal(source_folder).components().filter(|part| matches!(part, Component::Normal(_))).count();
    let relative = written.is_relative() && named.file_name().is_some();
    (0..=levels).filter(move |_| relative).map(move |up| {
        let mut path: PathBuf = (0..up).map(|_| Component::ParentDir).collect();
        path.push(&named);
        path
    })
}

/// Returns a path relative to the working directory, as the compiler shows its own paths, or to the package; `None` if
/// it is in neither.
fn short(file: &Path, working_directory: &Path, package: Option<&Path>) -> Option<PathBuf> {
    let file = normal(file);
    let from = |folder: &Path| file.strip_prefix(normal(folder)).ok().map(Path::to_owned);
    from(working_directory).or_else(|| package.and_then(from))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn found(written: &str, source_file: Option<&str>) -> Vec<String> {
        places(Path::new(written), source_file.map(Path::new), Some(Path::new("/arm")))
            .iter()
            .map(|place| normal(&place.file).display().to_string())
            .collect()
    }

    #[test]
    fn a_path_starts_at_the_source_file() {
        assert_eq!(found("../robots/x.yaml", Some("/arm/src/main.rs")), ["/arm/robots/x.yaml"]);
        assert_eq!(found("x.yaml", Some("src/main.rs")), ["src/x.yaml"]);
    }

    #[test]
    fn a_path_starts_in_the_package_when_the_source_file_is_unknown() {
        assert_eq!(found("../robots/x.yaml", None), ["/arm/robots/x.yaml", "/robots/x.yaml"]);
    }

    /// Tests an editor that does not know the source file: this crate asks for a file of another package.
    #[test]
    fn a_source_file_that_is_unknown_is_in_some_folder_with_sources() {
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository");
        let first = |written: &str, package: &str| {
            let guesses = guesses(Path::new(written), &repository.join(package));
            let found = guesses.into_iter().find(|file| file.is_file());
            found.map(|file| file.strip_prefix(repository).expect("in the repository").to_owned())
        };
        // as if written in tests/users/tests/ui/pass and in tests/users/tests/ui
        assert_eq!(first("../robots/rod.yaml", "tests/users"), Some("tests/users/tests/ui/robots/rod.yaml".into()));
        assert_eq!(first("robots/rod.yaml", "tests/users"), Some("tests/users/tests/ui/robots/rod.yaml".into()));
        // as if written in src/a/b, if this folder existed
        assert_eq!(first("../../../robots/planar1.yaml", "."), Some("robots/planar1.yaml".into()));
        assert_eq!(first("robots/nowhere.yaml", "tests/users"), None);
        assert_eq!(first("/robots/rod.yaml", "tests/users"), None);
    }

    #[test]
    fn the_folders_above_are_neighbours() {
        let near = |written| {
            let paths = neighbours(Path::new(written), Path::new("/arm/src"));
            paths.map(|path| path.to_str().expect("Unicode").replace('\\', "/")).collect::<Vec<_>>()
        };
        assert_eq!(near("robots/x.yaml"), ["robots/x.yaml", "../robots/x.yaml", "../../robots/x.yaml"]);
        assert_eq!(near("../../../x.yaml"), ["x.yaml", "../x.yaml", "../../x.yaml"]);
        assert!(near("/x.yaml").is_empty() && near("..").is_empty());
    }

    #[test]
    fn an_absolute_path_is_one_place() {
        assert_eq!(found("/robots/x.yaml", Some("/arm/src/main.rs")), ["/robots/x.yaml"]);
    }

    #[test]
    fn messages_show_a_file_as_the_compiler_would() {
        let short = |file| short(Path::new(file), Path::new("/home"), Some(Path::new("/elsewhere/arm")));
        assert_eq!(short("/home/arm/src/../robots/x.yaml"), Some("arm/robots/x.yaml".into()));
        assert_eq!(short("/elsewhere/arm/robots/x.yaml"), Some("robots/x.yaml".into()));
        assert_eq!(short("/robots/x.yaml"), None);
    }
}
