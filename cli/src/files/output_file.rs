//! Writes files completely or not at all; of several files that belong together, all or none.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};

use clap::Args;
use tempfile::NamedTempFile;

use crate::files::file_name::{self, Format};
use crate::files::interruption::{self, Registered};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TYPED};
use crate::render::layout::shortened;

/// The present contents of the path at which a file will be written.
pub(crate) enum Existing {
    Nothing,
    Text(String),
    /// A file that is not text, or is longer than any generated file.
    Other,
    Folder,
    /// A device, a pipe or a socket.
    Special,
    Unreadable(io::Error),
}

/// Largest size of an existing text that is read, in bytes: far more than the code of the largest robot.
const LONGEST: u64 = 64 << 20;

/// Whether writing a file changed it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Written {
    Anew,
    Unchanged,
}

pub(crate) fn existing(path: &Path) -> Existing {
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => Existing::Folder,
        Ok(metadata) if !metadata.is_file() => Existing::Special,
        Ok(metadata) if metadata.len() > LONGEST => Existing::Other,
        Ok(_) => match File::open(path).and_then(text) {
            Ok(text) => Existing::Text(text),
            Err(error) if error.kind() == ErrorKind::InvalidData => Existing::Other,
            Err(error) => Existing::Unreadable(error),
        },
        Err(error) if error.kind() == ErrorKind::NotFound => Existing::Nothing,
        Err(error) => Existing::Unreadable(error),
    }
}

/// Reads the text of a file; the length is limited, because the file may grow meanwhile.
fn text(file: File) -> io::Result<String> {
    let mut text = String::new();
    file.take(LONGEST).read_to_string(&mut text)?;
    Ok(text)
}

/// Returns whether two paths lead to the same existing file.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Returns whether two paths lead to the same file, which may not exist yet.
pub(crate) fn will_be_same(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::canonicalize(folder).ok()
    };
    let is_one_name = || a.file_name() == b.file_name() && folder(a).is_some_and(|of_a| Some(of_a) == folder(b));
    a == b || is_same(a, b) || is_one_name()
}

/// Writes a file through a temporary one beside it, so that a reader finds either the old text or the new one. A file
/// that already has this text keeps its date, so that no build runs again.
pub(crate) fn replace(path: &Path, text: &str) -> Result<Written, Failure> {
    Ok(replace_all(&[(path, text)])?[0])
}

/// Replaces files that belong together: none changes before all are written to temporary files beside them.
pub(crate) fn replace_all<P: AsRef<Path>, T: AsRef<str>>(files: &[(P, T)]) -> Result<Vec<Written>, Failure> {
    let mut written = Vec::with_capacity(files.len());
    let mut replacements = Vec::new();
    for (path, text) in files {
        let (path, text) = (path.as_ref(), text.as_ref());
        let is_old = matches!(existing(path), Existing::Text(old) if old == text);
        if !is_old {
            let replacement = Replacement::with(path, text).map_err(|error| unwritable(path, &error))?;
            replacements.push(replacement);
        }
        written.push(if is_old { Written::Unchanged } else { Written::Anew });
    }
    Replacement::keep_all(replacements).map_err(|(path, error)| unwritable(&path, &error))?;
    Ok(written)
}

/// Writes files that belong together; returns a message on what was done.
pub(crate) fn write_all<P: AsRef<Path>, T: AsRef<str>>(files: &[(P, T)]) -> Result<String, Failure> {
    let written = replace_all(files)?;
    let mut remark = String::new();
    for ((path, _), written) in files.iter().zip(written) {
        let word = match written {
            Written::Anew => "wrote",
            Written::Unchanged => "up to date:",
        };
        let _ = writeln!(remark, "{GOOD}{word}{GOOD:#} {}", path.as_ref().display());
    }
    Ok(remark)
}

/// A temporary file beside the one that it will replace; it is removed if it is not kept.
pub(crate) struct Replacement {
    file: NamedTempFile,
    /// The registration by which a signal also removes the temporary file.
    registered: Registered,
    path: PathBuf,
    /// The permissions of the existing file; `None` for a new file.
    permissions: Option<fs::Permissions>,
}

impl Replacement {
    /// Makes an empty replacement for the file at a path.
    pub(crate) fn begin(path: &Path) -> io::Result<Self> {
        // If the path is a symbolic link, its target is replaced, not the link.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let permissions = fs::metadata(&path).ok().map(|metadata| metadata.permissions());
        if permissions.as_ref().is_some_and(fs::Permissions::readonly) {
            return Err(io::Error::new(ErrorKind::PermissionDenied, "it is write-protected"));
        }
        let (registered, file) = Registered::new(|| beside(&path))?;
        Ok(Self { file, registered, path, permissions })
    }

    /// Makes a replacement that already contains a text.
    fn with(path: &Path, text: &str) -> io::Result<Self> {
        let replacement = Self::begin(path)?;
        replacement.file.as_file().write_all(text.as_bytes())?;
        replacement.file.as_file().sync_all()?;
        Ok(replacement)
    }

    /// Returns the temporary file, open for writing and reading from its beginning.
    pub(crate) fn file(&self) -> io::Result<File> {
        self.file.reopen()
    }

    /// Puts the temporary file in the place of the file.
    pub(crate) fn keep(self) -> io::Result<()> {
        Self::keep_all(vec![self]).map_err(|(_, error)| error)
    }

    /// Puts all temporary files in their places. If one of them fails, the files that did not exist before are removed
    /// again.
    fn keep_all(replacements: Vec<Self>) -> Result<(), (PathBuf, io::Error)> {
        for Self { file, path, permissions, .. } in &replacements {
            let ready = match permissions {
                Some(permissions) => file.as_file().set_permissions(permissions.clone()),
                None => Ok(()),
            };
            ready.and_then(|()| file.as_file().sync_all()).map_err(|error| (path.clone(), error))?;
        }
        let mut new: Vec<PathBuf> = Vec::new();
        // dropped only after the lock is released
        let mut forgotten = Vec::new();
        let held = interruption::hold();
        let mut kept = Ok(());
        for Self { file, registered, path, permissions } in replacements {
            forgotten.push(registered);
            if kept.is_err() {
                continue;
            }
            match file.persist(&path) {
                Ok(_) if permissions.is_none() => new.push(path),
                Ok(_) => {}
                Err(error) => kept = Err((path, error.error)),
            }
        }
        if kept.is_err() {
            for path in new {
                let _ = fs::remove_file(path);
            }
        }
        drop(held);
        kept
    }
}

/// Writes a file that people may edit afterwards. An existing file is not overwritten without `force`; the files
/// `sources`, which were read for it, never are. Returns a message on what was done.
pub(crate) fn write_new(path: &Path, text: &str, sources: &[&Path], force: bool) -> Result<String, Failure> {
    check_new(path, Some(text), sources, force)?;
    write_all(&[(path, text)])
}

/// Writes bytes to a file for which [`check_new`] was successful; returns a message on what was done.
pub(crate) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<String, Failure> {
    let written = Replacement::begin(path).and_then(|replacement| {
        replacement.file()?.write_all(bytes)?;
        replacement.keep()
    });
    written.map_err(|error| unwritable(path, &error))?;
    Ok(format!("{GOOD}wrote{GOOD:#} {}\n", path.display()))
}

/// The file of a result, or standard output.
#[derive(Args)]
pub(crate) struct Output {
    /// Output file; - is standard output [default: -]
    #[arg(short, long = "output", value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite the output file if it exists
    #[arg(long, requires = "out")]
    pub(crate) force: bool,
}

impl Output {
    /// Writes a text, which was made from the file `source`, to the output file or to standard output. An existing file
    /// is not overwritten without `--force`, as in [`write_new`].
    pub(crate) fn deliver(
        &self,
        format: Format,
        text: String,
        mut remark: String,
        source: &Path,
    ) -> Result<Outcome, Failure> {
        let Some(out) = self.out.as_deref().filter(|out| !is_standard_output(out)) else {
            return Ok(Outcome { text, remark, ..Outcome::default() });
        };
        check_new(out, Some(&text), &[source], self.force)?;
        file_name::check(out, format)?;
        remark += &write_all(&[(out, &text)])?;
        Ok(Outcome::remark(remark))
    }
}

/// Returns whether a path means standard output.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdout")
}

/// Refuses standard output as the file of a picture, because the report is printed there.
pub(crate) fn check_picture(path: Option<&Path>) -> Result<(), Failure> {
    check_file(path, "--plot", "picture.svg")
}

/// Refuses standard output as the file of an option, because the report is printed there; `example` is a name for the
/// message.
pub(crate) fn check_file(path: Option<&Path>, option: &str, example: &str) -> Result<(), Failure> {
    if path.is_some_and(is_standard_output) {
        return Err(usage_error!("{TYPED}{option}{TYPED:#} needs the name of a file, such as {example}"));
    }
    Ok(())
}

/// Checks that a file may be written: it does not exist, already has this text, or `force` allows to overwrite it; and
/// it is not one of `sources`.
pub(crate) fn check_new(path: &Path, text: Option<&str>, sources: &[&Path], force: bool) -> Result<(), Failure> {
    // signals must be caught before the command starts threads
    interruption::catch();
    let shown = path.display();
    if sources.iter().any(|source| is_same(path, source)) {
        return Err(usage_error!("{shown} is also the file that rne reads; name another file"));
    }
    match existing(path) {
        Existing::Folder => return Err(usage_error!("{shown} is a folder; name a file in it")),
        Existing::Special => return Err(usage_error!("{shown} is not a regular file; name another")),
        Existing::Unreadable(error) => return Err(unreadable(path, &error)),
        Existing::Text(old) if Some(old.as_str()) == text => {}
        Existing::Text(_) | Existing::Other if !force => {
            return Err(usage_error!("{shown} exists and is not changed; {TYPED}--force{TYPED:#} overwrites it"));
        }
        Existing::Nothing | Existing::Text(_) | Existing::Other => {}
    }
    Ok(())
}

/// Checks that a file can be written before the work whose result it gets, so that nobody waits in vain. An existing
/// text that begins as the new one will is accepted, because it may turn out to be the same; [`write_new`] compares
/// them.
pub(crate) fn check_place(
    path: &Path,
    (format, begins): (Format, &str),
    sources: &[&Path],
    force: bool,
) -> Result<(), Failure> {
    let alike = match existing(path) {
        Existing::Text(text) if text.starts_with(begins) => Some(text),
        _ => None,
    };
    check_new(path, alike.as_deref(), sources, force)?;
    check_name(path, format)
}

/// Checks that a new file of a format can be written, before its contents are computed.
pub(crate) fn check_new_place(path: &Path, format: Format, sources: &[&Path], force: bool) -> Result<(), Failure> {
    check_new(path, None, sources, force)?;
    check_name(path, format)
}

/// Checks that the name of a file fits its format, and that its folder accepts new files.
fn check_name(path: &Path, format: Format) -> Result<(), Failure> {
    file_name::check(path, format)?;
    // creates a temporary file beside it and removes it at once
    Replacement::begin(path).map(drop).map_err(|error| unwritable(path, &error))
}

/// Makes the error for an existing file that cannot be read.
pub(crate) fn unreadable(path: &Path, error: &io::Error) -> Failure {
    if error.kind() == ErrorKind::InvalidFilename {
        return unwritable(path, error);
    }
    input_error!("{} cannot be read: {error}", path.display())
}

/// Makes the error for a file that cannot be written: the system does not allow its name, its folder is missing, or
/// else the message of the system. It never contains the name of the temporary file.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let shown = path.display();
    if error.kind() == ErrorKind::InvalidFilename {
        return usage_error!(
            "{} cannot be written: its name is too long for this system, or contains letters that are not \
             allowed; name another file",
            shortened(&shown.to_string(), 80)
        );
    }
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    match path.parent().filter(|_| error.kind() == ErrorKind::NotFound).filter(is_missing) {
        Some(folder) => {
            input_error!("{shown} cannot be written: there is no folder {}; make it first", folder.display())
        }
        // a message of the system with the path of the temporary file is replaced
        None if error.get_ref().is_some_and(|inner| inner.to_string().contains(" at path ")) => {
            // for example /proc, a folder that exists but refuses new files
            let why = match error.kind() {
                ErrorKind::NotFound => "the system does not allow a new file in this folder".to_owned(),
                kind => kind.to_string(),
            };
            input_error!("{shown} cannot be written: {why}")
        }
        None => input_error!("{shown} cannot be written: {error}"),
    }
}

/// Makes a temporary file in the same folder, so that renaming it is one step. It has the permissions of any new file.
fn beside(path: &Path) -> io::Result<NamedTempFile> {
    // a long name is shortened, because the name of the temporary file is longer
    const LONGEST_NAME: usize = 40;
    let name =
        path.file_name().ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "this is not a name of a file"))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name: String = name.to_string_lossy().chars().take(LONGEST_NAME).collect();
    let mut builder = tempfile::Builder::new();
    let hidden = format!(".{name}.");
    builder.prefix(&hidden).suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
