//! Writes a folder of files completely or not at all.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use crate::files::interruption::{self, Registered};
use crate::files::output_file::{is_standard_output, unreadable, unwritable};
use crate::outcome::Failure;
use crate::palette::TYPED;

/// Checks that nothing exists at the path of a new folder; `what` says in words what it is for.
pub(crate) fn is_free(folder: &Path, what: &str) -> Result<(), Failure> {
    let shown = folder.display();
    if is_standard_output(folder) {
        return Err(usage_error!(
            "{what} is a folder of files, so it cannot go to standard output; name the folder with {TYPED}-o \
             FOLDER{TYPED:#}"
        ));
    }
    match fs::read_dir(folder).map(|mut entries| entries.next().is_none()) {
        Ok(true) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Ok(false) => Err(usage_error!(
            "{shown} is not empty and is not changed; name another folder with {TYPED}-o FOLDER{TYPED:#}"
        )),
        Err(error) if error.kind() == ErrorKind::NotADirectory => {
            Err(usage_error!("{shown} is not a folder and is not changed; name another with {TYPED}-o FOLDER{TYPED:#}"))
        }
        Err(error) => Err(unreadable(folder, &error)),
    }
}

/// Makes a folder and the folders above it; an existing folder is not changed.
pub(crate) fn make(folder: &Path) -> Result<(), Failure> {
    let shown = folder.display();
    fs::create_dir_all(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            let file = folder.ancestors().find(|part| part.exists()).unwrap_or(folder);
            usage_error!("{} is not a folder and is not changed; name another folder", file.display())
        }
        // all folders above exist, but this one refuses new entries, as /proc does
        ErrorKind::NotFound => {
            input_error!("{shown} cannot be written: the system does not allow a new file in this folder")
        }
        _ => unwritable(folder, &error),
    })
}

/// A path that could not be written, and the reason.
type Unwritable = (PathBuf, io::Error);

/// Writes files, given by their paths in a folder that is empty or does not exist. They are written into a temporary
/// folder on the same disk, and moved when all are complete.
pub(crate) fn write(folder: &Path, files: &[(PathBuf, String)]) -> Result<(), Unwritable> {
    let (root, rest) = first_missing(folder);
    let of_folder = |error| (folder.to_owned(), error);
    if !rest.components().all(|part| matches!(part, Component::Normal(_))) {
        return Err(of_folder(io::Error::new(ErrorKind::NotFound, "the path contains a folder that does not exist")));
    }
    let make = || tempfile::Builder::new().prefix(".rne.").suffix(".tmp").tempdir_in(&root);
    let (_registered, temporary) = Registered::new(make).map_err(of_folder)?;
    for (file, text) in files {
        let path = temporary.path().join(&rest).join(file);
        let written = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(&path, text));
        written.map_err(|error| (folder.join(file), error))?;
    }
    let entries = fs::read_dir(temporary.path()).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let _held = interruption::hold();
    let mut moved: Vec<PathBuf> = Vec::new();
    for entry in entries.map_err(of_folder)? {
        let place = root.join(entry.file_name());
        // files that somebody else has put there meanwhile are not overwritten
        let is_moved = match fs::symlink_metadata(&place) {
            Ok(_) => Err(io::Error::from(ErrorKind::AlreadyExists)),
            Err(_) => fs::rename(entry.path(), &place),
        };
        if let Err(error) = is_moved {
            for place in &moved {
                remove(place);
            }
            return Err((place, error));
        }
        moved.push(place);
    }
    Ok(())
}

/// Splits the path of a folder into the part that exists and the rest.
fn first_missing(folder: &Path) -> (PathBuf, PathBuf) {
    let root = folder.ancestors().find(|part| part.is_dir()).unwrap_or(Path::new(""));
    let rest = folder.strip_prefix(root).unwrap_or(folder);
    let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
    (root.to_owned(), rest.to_owned())
}

fn remove(path: &Path) {
    let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<String> = names.map(|name| name.into_string().expect("UTF-8")).collect();
        names.sort();
        names
    }

    fn files(names: &[&str]) -> Vec<(PathBuf, String)> {
        names.iter().map(|name| (PathBuf::from(name), (*name).to_owned())).collect()
    }

    #[test]
    fn a_folder_appears_with_all_its_files() {
        let empty = tempfile::tempdir().expect("a folder");
        let folder = empty.path().join("deep/er");
        write(&folder, &files(&["a", ".b/c"])).expect("written");
        assert_eq!((names(empty.path()), names(&folder)), (vec!["deep".to_owned()], vec![".b".into(), "a".into()]));
        assert_eq!(fs::read_to_string(folder.join(".b/c")).expect("a file"), ".b/c");

        // writing into an existing, empty folder
        let there = empty.path().join("there");
        fs::create_dir(&there).expect("a folder");
        write(&there, &files(&["a", ".b/c"])).expect("written");
        assert_eq!(names(&there), [".b", "a"]);
    }

    #[test]
    fn what_cannot_be_whole_leaves_nothing() {
        let empty = tempfile::tempdir().expect("a folder");
        // `a` would have to be a file and a folder, so the second file cannot be written
        let (path, _) = write(&empty.path().join("deep/er"), &files(&["a", "a/b"])).expect_err("no place");
        assert_eq!(path, empty.path().join("deep/er/a/b"));
        assert_eq!(names(empty.path()), Vec::<String>::new());

        // an existing folder `b` is no place for a file `b`
        fs::create_dir(empty.path().join("b")).expect("a folder");
        write(empty.path(), &files(&["a", "b", "c"])).expect_err("no place");
        assert_eq!(names(empty.path()), ["b"]);
    }
}
