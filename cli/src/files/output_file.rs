//! Files that are written: whole or not at all, and of several that belong together all or none.

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

/// The existing entry at the path of a file that will be written.
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
pub(crate) fn replace(path: &Path, text: &str) -> Result<Written, Failure> {
    Ok(replace_all(&[(path, text)])?[0])
}

/// Replaces files that belong together: none of them changes before all are written to temporary files beside them.
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

/// Writes files that belong together; what was done, for the reader.
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

/// A file beside the one whose place it takes when it is whole; it is gone when it is not kept.
pub(crate) struct Replacement {
    file: NamedTempFile,
    /// A signal removes the file too.
    registered: Registered,
    path: PathBuf,
    /// Permissions of the existing file; `None` if there is no file.
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
        let (registered, file) = Registered::new(|| beside(&path))?;
        Ok(Self { file, registered, path, permissions })
    }

    /// One that has a text already.
    fn with(path: &Path, text: &str) -> io::Result<Self> {
        let replacement = Self::begin(path)?;
        replacement.file.as_file().write_all(text.as_bytes())?;
        replacement.file.as_file().sync_all()?;
        Ok(replacement)
    }

    /// The file, to be written and read, from its beginning.
    pub(crate) fn file(&self) -> io::Result<File> {
        self.file.reopen()
    }

    /// Takes the place of the file.
    pub(crate) fn keep(self) -> io::Result<()> {
        Self::keep_all(vec![self]).map_err(|(_, error)| error)
    }

    /// All take their places. Where one cannot, the files that were not there before are removed again.
    fn keep_all(replacements: Vec<Self>) -> Result<(), (PathBuf, io::Error)> {
        for Self { file, path, permissions, .. } in &replacements {
            let ready = match permissions {
                Some(permissions) => file.as_file().set_permissions(permissions.clone()),
                None => Ok(()),
            };
            ready.and_then(|()| file.as_file().sync_all()).map_err(|error| (path.clone(), error))?;
        }
        let mut new: Vec<PathBuf> = Vec::new();
        // forgotten when no signal waits any more
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

/// Writes a file that people may edit afterwards: one that is there stays, unless `force` says otherwise, and
/// `sources`, which were read for it, stay in any case. Returns what was done, for the reader.
pub(crate) fn write_new(path: &Path, text: &str, sources: &[&Path], force: bool) -> Result<String, Failure> {
    check_new(path, Some(text), sources, force)?;
    write_all(&[(path, text)])
}

/// Writes bytes in place of a file that [`check_new`] allows; what was done, for the reader.
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
    /// Writes a text, which was made of `source`, to the file or for standard output. A file that exists is not
    /// changed, as [`write_new`] has it.
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

/// Whether a path names standard output.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdout")
}

/// Whether the file of a picture is a file: standard output has the account.
pub(crate) fn check_picture(path: Option<&Path>) -> Result<(), Failure> {
    check_file(path, "--plot", "picture.svg")
}

/// Whether what an option names is a file, such as the example: standard output has the account.
pub(crate) fn check_file(path: Option<&Path>, option: &str, example: &str) -> Result<(), Failure> {
    if path.is_some_and(is_standard_output) {
        return Err(usage_error!("{TYPED}{option}{TYPED:#} needs the name of a file, such as {example}"));
    }
    Ok(())
}

/// Whether a file may be written: none stands there, or one with this text, or `force` says so, and none of `sources`.
pub(crate) fn check_new(path: &Path, text: Option<&str>, sources: &[&Path], force: bool) -> Result<(), Failure> {
    // before the work starts its threads
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

/// Whether a file can be written, before there is anything to write: where it cannot, nobody should wait for the work
/// that makes it. A text of the same kind, that `begins` as the new one will, may be the same: [`write_new`] knows.
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

/// Whether a new file of a format can be written, before there is anything to write.
pub(crate) fn check_new_place(path: &Path, format: Format, sources: &[&Path], force: bool) -> Result<(), Failure> {
    check_new(path, None, sources, force)?;
    check_name(path, format)
}

/// Whether a file can have its name and stand in its folder.
fn check_name(path: &Path, format: Format) -> Result<(), Failure> {
    file_name::check(path, format)?;
    // a file beside it, which is gone at once
    Replacement::begin(path).map(drop).map_err(|error| unwritable(path, &error))
}

/// Why what is at the place of a file cannot be read.
pub(crate) fn unreadable(path: &Path, error: &io::Error) -> Failure {
    if error.kind() == ErrorKind::InvalidFilename {
        return unwritable(path, error);
    }
    input_error!("{} cannot be read: {error}", path.display())
}

/// Error for a file that cannot be written: the system does not allow its name, its folder is missing, or the system's
/// own message. It never names the temporary file.
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
        // the message of a temporary file has its name
        None if error.get_ref().is_some_and(|inner| inner.to_string().contains(" at path ")) => {
            // the folder exists, but refuses new files, as /proc does
            let why = match error.kind() {
                ErrorKind::NotFound => "the system does not allow a new file in this folder".to_owned(),
                kind => kind.to_string(),
            };
            input_error!("{shown} cannot be written: {why}")
        }
        None => input_error!("{shown} cannot be written: {error}"),
    }
}

/// A temporary file in the same folder, so that renaming it is one step. With the permissions that any new file has.
fn beside(path: &Path) -> io::Result<NamedTempFile> {
    // of a long name the beginning, for the name of the temporary file is longer
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
