//! Files that are read: regular ones, and streams that a shell has opened already.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use rne_model::open_file;

/// Whether a path is standard input, by the name that commands have for it or by that of the system.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdin")
}

/// Whether a path is a stream that is open already: standard input, or what a shell puts in the place of `<(…)`.
/// Nothing can stand beside it, such as a plan.
pub(crate) fn is_stream(path: &Path) -> bool {
    let folders = [Path::new("/dev/fd"), Path::new("/proc/self/fd")];
    is_standard_input(path) || path.parent().is_some_and(|folder| folders.contains(&folder))
}

/// The bytes of a file, and at most one more than `longest`, which tells that it is too long. Of what is no regular
/// file only open streams are read: a pipe with a name would keep its reader waiting until somebody writes.
pub(crate) fn read(path: &Path, longest: usize) -> io::Result<Vec<u8>> {
    let most = longest as u64 + 1;
    let mut bytes = Vec::new();
    open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A file to be read, or an open stream.
pub(crate) fn open(path: &Path) -> io::Result<Box<dyn Read>> {
    if is_standard_input(path) {
        return Ok(Box::new(io::stdin().lock()));
    }
    let file = if is_stream(path) { File::open(path) } else { open_file(path) };
    Ok(Box::new(file?))
}

/// The name of a file in messages.
pub(crate) fn name(path: &Path) -> String {
    if is_standard_input(path) { "<standard input>".to_owned() } else { path.display().to_string() }
}
