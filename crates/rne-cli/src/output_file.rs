//! Files that are written: whole or not at all.

use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::process;

/// What stands where a file is to be written.
pub(crate) enum Existing {
    Nothing,
    Text(String),
    /// A file that is no text.
    Other,
    Folder,
    Unreadable(io::Error),
}

/// Whether writing changed anything.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Written {
    Anew,
    Unchanged,
}

pub(crate) fn existing(path: &Path) -> Existing {
    match fs::read_to_string(path) {
        Ok(text) => Existing::Text(text),
        Err(error) => match error.kind() {
            ErrorKind::NotFound => Existing::Nothing,
            ErrorKind::InvalidData => Existing::Other,
            _ if path.is_dir() => Existing::Folder,
            _ => Existing::Unreadable(error),
        },
    }
}

/// Whether two paths lead to one existing file.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Writes a file through a temporary one beside it, so that a reader finds the old text or the new one. A file that has
/// the text already keeps its date, so nothing is built again.
pub(crate) fn replace(path: &Path, text: &str) -> io::Result<Written> {
    // The file behind a symbolic link, not the link.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::read(&path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(Written::Unchanged);
    }
    let permissions = fs::metadata(&path).ok().map(|metadata| metadata.permissions());
    if permissions.as_ref().is_some_and(fs::Permissions::readonly) {
        return Err(io::Error::new(ErrorKind::PermissionDenied, "it is write-protected"));
    }
    let temporary = beside(&path)?;
    let written = (|| {
        let mut file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
        file.write_all(text.as_bytes())?;
        if let Some(permissions) = permissions {
            file.set_permissions(permissions)?;
        }
        file.sync_all()?;
        drop(file);
        fs::rename(&temporary, &path)
    })();
    if let Err(error) = written {
        // The first error is the one to tell.
        let _ = fs::remove_file(&temporary);
        return Err(error);
    }
    Ok(Written::Anew)
}

/// The name of a temporary file in the same folder, so that renaming it is one step.
fn beside(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "this is no name of a file"))?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.tmp", process::id()));
    Ok(path.with_file_name(hidden))
}
