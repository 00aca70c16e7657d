//! Files that are written: whole or not at all.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::outcome::Failure;
use crate::terminal::{GOOD, TYPED};

/// What stands where a file is to be written.
pub(crate) enum Existing {
    Nothing,
    Text(String),
    /// A file that is no text, or longer than any that is generated.
    Other,
    Folder,
    /// A device, a pipe, a socket.
    Special,
    Unreadable(io::Error),
}

/// Far more than the code of the largest robot.
const LONGEST: u64 = 64 << 20;

/// Whether writing changed anything.
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

/// The text of a file, which may grow while it is read.
fn text(file: File) -> io::Result<String> {
    let mut text = String::new();
    file.take(LONGEST).read_to_string(&mut text)?;
    Ok(text)
}

/// Whether two paths lead to one existing file.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Whether two paths lead to one file, which may not be there yet.
pub(crate) fn will_be_same(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::canonicalize(folder).ok()
    };
    let is_one_name = || a.file_name() == b.file_name() && folder(a).is_some_and(|of_a| Some(of_a) == folder(b));
    a == b || is_same(a, b) || is_one_name()
}

/// Writes a file through a temporary one beside it, so that a reader finds the old text or the new one. A file that has
/// the text already keeps its date, so nothing is built again.
pub(crate) fn replace(path: &Path, text: &str) -> io::Result<Written> {
    if matches!(existing(path), Existing::Text(old) if old == text) {
        return Ok(Written::Unchanged);
    }
    let replacement = Replacement::begin(path)?;
    replacement.file()?.write_all(text.as_bytes())?;
    replacement.keep()?;
    Ok(Written::Anew)
}

/// A file beside the one whose place it takes when it is whole; it is gone when it is not kept.
pub(crate) struct Replacement {
    file: NamedTempFile,
    path: PathBuf,
    /// Those of the file that is there.
    permissions: Option<fs::Permissions>,
}

impl Replacement {
    /// An empty one.
    pub(crate) fn begin(path: &Path) -> io::Result<Self> {
        // The file behind a symbolic link, not the link.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let permissions = fs::metadata(&path).ok().map(|metadata| metadata.permissions());
        if permissions.as_ref().is_some_and(fs::Permissions::readonly) {
            return Err(io::Error::new(ErrorKind::PermissionDenied, "it is write-protected"));
        }
        Ok(Self { file: beside(&path)?, path, permissions })
    }

    /// The file, to be written and read, from its beginning.
    pub(crate) fn file(&self) -> io::Result<File> {
        self.file.reopen()
    }

    /// Takes the place of the file.
    pub(crate) fn keep(self) -> io::Result<()> {
        let Self { file, path, permissions } = self;
        if let Some(permissions) = permissions {
            file.as_file().set_permissions(permissions)?;
        }
        file.as_file().sync_all()?;
        file.persist(&path)?;
        Ok(())
    }
}

/// Writes a file that people may edit afterwards: one that is there stays, unless `force` says otherwise, and
/// `sources`, which were read for it, stay in any case. Returns what was done, for the reader.
pub(crate) fn write_new(path: &Path, text: &str, sources: &[&Path], force: bool) -> Result<String, Failure> {
    check_new(path, Some(text), sources, force)?;
    let shown = path.display();
    let word = match replace(path, text) {
        Ok(Written::Anew) => "wrote",
        Ok(Written::Unchanged) => "up to date:",
        Err(error) => return Err(unwritable(path, &error)),
    };
    Ok(format!("{GOOD}{word}{GOOD:#} {shown}\n"))
}

/// Whether a path names standard output.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdout")
}

/// Whether a file may be written: none stands there, or one with this text, or `force` says so, and none of `sources`.
pub(crate) fn check_new(path: &Path, text: Option<&str>, sources: &[&Path], force: bool) -> Result<(), Failure> {
    let shown = path.display();
    if sources.iter().any(|source| is_same(path, source)) {
        return Err(Failure::usage(format_args!("{shown} is the file that is read; name another")));
    }
    match existing(path) {
        Existing::Folder => return Err(Failure::usage(format_args!("{shown} is a folder; name a file in it"))),
        Existing::Special => return Err(Failure::usage(format_args!("{shown} is not a regular file; name another"))),
        Existing::Unreadable(error) => return Err(Failure::input(format_args!("{shown} cannot be read: {error}"))),
        Existing::Text(old) if Some(old.as_str()) == text => {}
        Existing::Text(_) | Existing::Other if !force => {
            return Err(Failure::usage(format_args!(
                "{shown} is there already and stays as it is; {TYPED}--force{TYPED:#} overwrites it"
            )));
        }
        Existing::Nothing | Existing::Text(_) | Existing::Other => {}
    }
    Ok(())
}

/// Whether a file can be written, before there is anything to write: where it cannot, nobody should wait for the work
/// that makes it. A text of the same kind, that `begins` as the new one will, may be the same: [`write_new`] knows.
pub(crate) fn check_place(path: &Path, begins: &str, sources: &[&Path], force: bool) -> Result<(), Failure> {
    let alike = match existing(path) {
        Existing::Text(text) if text.starts_with(begins) => Some(text),
        _ => None,
    };
    check_new(path, alike.as_deref(), sources, force)?;
    // a file beside it, which is gone at once
    Replacement::begin(path).map(drop).map_err(|error| unwritable(path, &error))
}

/// Why a file cannot be written: its folder is missing, or what the system says; not of the temporary file beside it.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let shown = path.display();
    match path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
        Some(folder) => Failure::input(format_args!(
            "{shown} cannot be written: there is no folder {}; make it first",
            folder.display()
        )),
        // the message of a temporary file has its name
        None if error.get_ref().is_some_and(|inner| inner.to_string().contains(" at path ")) => {
            Failure::input(format_args!("{shown} cannot be written: {}", error.kind()))
        }
        None => Failure::input(format_args!("{shown} cannot be written: {error}")),
    }
}

/// A temporary file in the same folder, so that renaming it is one step; it is gone when it is not kept. With the
/// permissions that any new file has.
pub(crate) fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "this is no name of a file"))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(".");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&hidden).suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
