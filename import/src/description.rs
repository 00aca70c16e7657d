//! Opens robot descriptions by a path or from a text: a shipped robot, a robot file or a URDF. Every interface of rne
//! uses it.

use std::error::Error;
use std::fmt;
use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use rne_model::{nearest_name, no_shipped_robot, open_file, read_limited, robot_of};
use rne_robots::RobotFile;

/// Largest size of a URDF that is read, in bytes.
const LONGEST_URDF: u64 = 16 << 20;

/// Largest number of files that a message about a folder lists.
const NAMED: usize = 16;

/// A description of an arm that has been opened.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Description {
    /// A robot that rne includes.
    Shipped(&'static RobotFile),
    /// The bytes of a robot file.
    RobotFile(Vec<u8>),
    /// The bytes of a URDF, or of other XML, which [`Urdf::read`](crate::Urdf::read) refuses.
    Urdf(Vec<u8>),
}

/// The reason why a description cannot be opened.
#[derive(Debug)]
#[non_exhaustive]
pub enum OpenError {
    /// The path is that of a plan file, not of a robot.
    Plan {
        /// The path.
        path: PathBuf,
        /// The path of the robot file to which the plan belongs.
        robot: PathBuf,
    },
    /// There is neither such a file nor a shipped robot of this name.
    NotFound {
        /// The path.
        path: PathBuf,
        /// A sentence with the name that was probably meant, if there is one.
        hint: Option<String>,
        /// The error of the operating system.
        error: io::Error,
    },
    /// The file is a scene in Universal Scene Description.
    Usd {
        /// The path.
        path: PathBuf,
    },
    /// The file cannot be read.
    Unreadable {
        /// The path.
        path: PathBuf,
        /// The error of the operating system.
        error: io::Error,
    },
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan { path, robot } => write!(f, "{} is a plan; its robot is {}", path.display(), robot.display()),
            Self::NotFound { path, hint, .. } => {
                let what = if is_named_urdf(path) { "URDF" } else { "robot file" };
                write!(f, "there is no {what} {}", path.display())?;
                hint.as_ref().map_or(Ok(()), |hint| write!(f, "; {hint}"))
            }
            Self::Usd { path } => write!(
                f,
                "{} is a USD file (Universal Scene Description), which rne does not read; export the robot as URDF or \
                 MJCF",
                path.display()
            ),
            Self::Unreadable { path, error } if error.kind() == ErrorKind::IsADirectory => {
                if path.join("metadata.yaml").is_file() {
                    return write!(
                        f,
                        "{} is a ROS bag, but here a robot file is expected; logs come after the robot file",
                        path.display()
                    );
                }
                let inside = path.join("*.yaml");
                write!(f, "{} is a folder; name the robot files in it, such as {}", path.display(), inside.display())
            }
            Self::Unreadable { path, error } => write!(f, "{} cannot be read: {error}", path.display()),
        }
    }
}

impl Error for OpenError {}

impl Description {
    /// Opens the description at a path. It is, in this order:
    ///
    /// 1. an error, when the path is that of a plan file;
    /// 2. a shipped robot, when the path is its name and there is no such file;
    /// 3. a URDF, when its text begins as XML does, whatever the file name is;
    /// 4. a robot file.
    ///
    /// # Errors
    /// When the path is that of a plan, when there is no such file, or when it cannot be read.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        Self::open_by(path, open_file)
    }

    /// Opens the description at a path with `file` as the function that opens the file: for callers of
    /// [`Description::open`] that also read pipes.
    ///
    /// # Errors
    /// As [`Description::open`].
    pub fn open_by<R: Read>(path: &Path, file: impl FnOnce(&Path) -> io::Result<R>) -> Result<Self, OpenError> {
        if let Some(robot) = robot_of(path) {
            return Err(OpenError::Plan { path: path.to_owned(), robot });
        }
        if let Some(robot) = shipped_at(path) {
            return Ok(Self::Shipped(robot));
        }
        let read = |mut file: R| {
            let mut bytes = read_limited(&mut file)?;
            let is_urdf = is_xml(&bytes);
            if is_urdf {
                let rest = (LONGEST_URDF + 1).saturating_sub(bytes.len() as u64);
                file.take(rest).read_to_end(&mut bytes)?;
            }
            Ok(if is_urdf { Self::Urdf(bytes) } else { Self::RobotFile(bytes) })
        };
        let opened = file(path).and_then(read).map_err(|error| {
            let path = path.to_owned();
            if error.kind() == ErrorKind::NotFound {
                OpenError::NotFound { hint: hint(&path), path, error }
            } else {
                OpenError::Unreadable { path, error }
            }
        })?;
        match &opened {
            Self::RobotFile(bytes) if [&b"#usda"[..], b"PXR-USDC"].iter().any(|usd| bytes.starts_with(usd)) => {
                Err(OpenError::Usd { path: path.to_owned() })
            }
            _ => Ok(opened),
        }
    }

    /// Returns the description that a text is: a URDF if it begins as XML does, else a robot file.
    #[must_use]
    pub fn of_text(text: String) -> Self {
        let bytes = text.into_bytes();
        if is_xml(&bytes) { Self::Urdf(bytes) } else { Self::RobotFile(bytes) }
    }
}

/// Returns whether a text begins as XML does. `<<` does not count, because it is a key of YAML.
fn is_xml(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix("\u{FEFF}".as_bytes()).unwrap_or(bytes).trim_ascii_start();
    bytes.starts_with(b"<") && !bytes.starts_with(b"<<")
}

/// Returns whether a path has the extension of a URDF.
fn is_named_urdf(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// Returns the shipped robot whose name the path is, if there is no such file.
#[must_use]
pub fn shipped_at(path: &Path) -> Option<&'static RobotFile> {
    rne_robots::find(path.to_str()?).filter(|_| !path.exists())
}

/// Returns the shipped robot of a name.
///
/// # Errors
/// When there is none: the message has the name that was probably meant, and all names.
pub fn shipped(name: &str) -> Result<&'static RobotFile, String> {
    rne_robots::find(name).ok_or_else(|| no_shipped_robot(name, &names()))
}

fn names() -> Vec<&'static str> {
    rne_robots::all().map(|robot| robot.name).collect()
}

/// Returns a sentence with the file or the robot that was probably meant by a path at which there is no file.
fn hint(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| folder.is_dir() && !folder.as_os_str().is_empty());
    if let Some(probably) = candidates(path).into_iter().find(|candidate| candidate.is_file()) {
        return Some(format!("did you mean {}?", probably.display()));
    }
    if let Some(near) = path.to_str().and_then(|name| nearest_name(name, &names())) {
        return Some(format!("did you mean the shipped robot {near}?"));
    }
    let inside = folder.map(robots_in).filter(|names| !names.is_empty())?;
    let more = if inside.len() > NAMED { ", …" } else { "" };
    let shown = inside.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    Some(format!("{} has {shown}{more}", path.with_file_name("").display()))
}

/// Returns other paths at which the file may be: with an extension, or in `robots/`.
fn candidates(path: &Path) -> Vec<PathBuf> {
    let Some(name) = path.file_name() else { return Vec::new() };
    let shipped = |folder: &str| Path::new(folder).join(name).with_extension("yaml");
    vec![path.with_extension("yaml"), shipped("robots"), shipped("robots/trees")]
}

/// Returns the names of the robot files in a folder, sorted, without plan files.
fn robots_in(folder: &Path) -> Vec<String> {
    let paths = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_robot =
        |path: &PathBuf| path.extension().is_some_and(|extension| extension == "yaml") && robot_of(path).is_none();
    let name = |path: PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let mut names: Vec<String> = paths.filter(is_robot).filter_map(name).collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(path: &Path) -> Description {
        Description::open(path).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn a_file_hides_a_shipped_robot_and_a_text_says_what_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::write(&path, text).expect("a file");
            path
        };
        assert!(matches!(opened(Path::new("puma560")), Description::Shipped(robot) if robot.name == "puma560"));
        for (name, text, is_urdf) in [
            ("a.yaml", "format: 1", false),
            ("b.yaml", "<<: {format: 1}", false),
            ("c.urdf", "format: 1", false),
            ("d.xml", "<robot name=\"d\"/>", true),
            ("e.yaml", "\u{FEFF}\n <!-- a --><robot/>", true),
        ] {
            let bytes = text.as_bytes().to_vec();
            let expected = if is_urdf { Description::Urdf(bytes) } else { Description::RobotFile(bytes) };
            assert_eq!(opened(&file(name, text)), expected, "{name}");
            assert_eq!(Description::of_text(text.to_owned()), expected, "{name}");
        }
        // this text is longer than a robot file may be, but not too long for a URDF
        let long = format!("<robot>{}</robot>", " ".repeat(3 << 20));
        assert_eq!(opened(&file("long.urdf", &long)), Description::Urdf(long.into_bytes()));
        let yaml = format!("format: 1{}", " ".repeat(3 << 20));
        let Description::RobotFile(bytes) = opened(&file("long.yaml", &yaml)) else { panic!("a robot file") };
        assert_eq!(bytes.len(), rne_model::MAX_BYTES + 1);
    }

    #[test]
    fn what_was_meant_is_named() {
        let said = |path: &str| Description::open(Path::new(path)).expect_err(path).to_string();
        assert_eq!(said("puma"), "there is no robot file puma; did you mean the shipped robot puma560?");
        assert_eq!(said("my/arm.plan.yaml"), "my/arm.plan.yaml is a plan; its robot is my/arm.yaml");
        assert_eq!(said("xyzzy.urdf"), "there is no URDF xyzzy.urdf");
        assert!(said("src").starts_with("src is a folder"), "{}", said("src"));
        let folder = tempfile::tempdir().expect("a folder");
        for text in ["#usda 1.0\ndef Xform \"arm\" {}\n", "PXR-USDC\0\0"] {
            let path = folder.path().join("scene.usd");
            fs::write(&path, text).expect("a file");
            assert!(said(path.to_str().expect("Unicode")).contains("is a USD file (Universal Scene Description)"));
        }
        for name in ["one.yaml", "two.yaml", "two.plan.yaml"] {
            fs::write(folder.path().join(name), "").expect("a file");
        }
        let in_folder = |name: &str| said(folder.path().join(name).to_str().expect("Unicode"));
        assert!(in_folder("xyzzy").ends_with(" has one.yaml, two.yaml"), "{}", in_folder("xyzzy"));
        assert!(in_folder("one").ends_with("one.yaml?"), "{}", in_folder("one"));
        let unknown = shipped("puma").expect_err("no such robot");
        assert!(
            unknown.starts_with("there is no shipped robot `puma`; did you mean `puma560`? the shipped robots are "),
            "{unknown}"
        );
    }
}
