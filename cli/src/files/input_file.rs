//! Opens files for reading: regular files, and streams that a shell has opened already.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use rne_model::open_file;

/// Returns whether a path is standard input: `-`, or the name that the system has for it.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdin")
}

/// Returns whether a path is a stream that is open already: standard input, or the path that a shell puts in place of
/// `<(…)`. Other files, such as a plan, cannot be beside it.
pub(crate) fn is_stream(path: &Path) -> bool {
    let folders = [Path::new("/dev/fd"), Path::new("/proc/self/fd")];
    is_standard_input(path) || path.parent().is_some_and(|folder| folders.contains(&folder))
}

/// Reads the bytes of a file, but at most one more than `longest`, which is enough to see that it is too long. Apart
/// from regular files only open streams are read: a named pipe would block until somebody writes to it.
pub(crate) fn read(path: &Path, longest: usize) -> io::Result<Vec<u8>> {
    let most = longest as u64 + 1;
    let mut bytes = Vec::new();
    open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a file for reading, or returns an open stream.
pub(crate) fn open(path: &Path) -> io::Result<Box<dyn Read>> {
    if is_standard_input(path) {
        return Ok(Box::new(io::stdin().lock()));
    }
    let file = if is_stream(path) { File::open(path) } else { open_file(path) };
    Ok(Box::new(file?))
}

/// Returns the name of a file in messages.
pub(crate) fn name(path: &Path) -> String {
    if is_standard_input(path) { "<standard input>".to_owned() } else { path.display().to_string() }
}
