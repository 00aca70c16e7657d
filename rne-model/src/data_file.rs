//! Files on disk: which are read at all, how much of them, and what stands beside a robot file is called.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The largest robot file or plan that is read. The longest table, 64 joints, needs a fiftieth of it, a plan with a
/// graph of as many dense joints a half.
pub const MAX_BYTES: usize = 1 << 20;

/// What the name of a plan file ends with, in place of the extension of its robot file.
const PLAN: &str = "plan.yaml";

/// The bytes of a robot file for [`Reader::read`](crate::Reader::read), and no more of them than tell that a file is
/// too long: a stream without an end, or a huge file, takes neither memory nor time.
///
/// # Errors
///
/// As [`Read::read_to_end`].
pub fn read_limited(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes of a robot file or a plan, [limited](read_limited).
///
/// # Errors
///
/// As [`open_file`] and [`Read::read_to_end`].
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    open_file(path).and_then(read_limited)
}

/// A file to read. What is no regular file is not opened: a pipe would keep its reader waiting, a device may have no
/// end.
///
/// # Errors
///
/// As [`File::open`]; a file that is not regular.
pub fn open_file(path: &Path) -> io::Result<File> {
    let metadata = fs::metadata(path)?;
    // of a folder, reading says best what is wrong
    if !metadata.is_file() && !metadata.is_dir() {
        let message = "it is a pipe, a socket or a device, not a regular file";
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    File::open(path)
}

/// The plan of a robot file: `NAME.plan.yaml` beside `NAME.yaml`.
pub fn plan_of(robot_file: &Path) -> PathBuf {
    robot_file.with_extension(PLAN)
}

/// The golden file of a robot file, a [`GoldenFile`](crate::GoldenFile): `NAME.golden.csv` beside `NAME.yaml`.
pub fn golden_of(robot_file: &Path) -> PathBuf {
    robot_file.with_extension("golden.csv")
}

/// The robot file of a plan: `NAME.yaml` beside `NAME.plan.yaml`; `None` when a path is not that of a plan.
pub fn robot_of(plan: &Path) -> Option<PathBuf> {
    let name = plan.file_name()?.to_str()?.strip_suffix(PLAN)?.strip_suffix('.')?;
    Some(plan.with_file_name(format!("{name}.yaml")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robot_files_and_their_plans() {
        let (robot, plan) = (Path::new("robots/arm.yaml"), Path::new("robots/arm.plan.yaml"));
        assert_eq!((plan_of(robot).as_path(), robot_of(plan).as_deref()), (plan, Some(robot)));
        for other in ["arm.yaml", "plan.yaml", "armplan.yaml", "-", "robots/"] {
            assert_eq!(robot_of(Path::new(other)), None, "{other}");
        }
    }

    #[test]
    fn a_folder_is_no_file() {
        assert_eq!(read_file(Path::new(".")).unwrap_err().kind(), ErrorKind::IsADirectory);
        assert_eq!(read_file(Path::new("nowhere.yaml")).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    #[cfg(unix)]
    fn a_device_is_not_opened() {
        // a pipe without a writer would keep this test waiting for ever
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success());
        if made {
            let error = read_file(&pipe).unwrap_err();
            assert!(error.to_string().contains("a pipe"), "{error}");
        }
        for device in ["/dev/zero", "/dev/null"] {
            let error = read_file(Path::new(device)).unwrap_err();
            assert!(
                error.kind() == ErrorKind::InvalidInput && error.to_string().contains("not a regular file"),
                "{error}"
            );
        }
    }
}
