//! Files on disk: which are read at all, how much of them, and what stands beside a robot file is called.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use crate::text::spelling::did_you_mean;

/// The largest robot file or plan that is read. The longest table, 64 joints, needs a fiftieth of it, a plan with a
/// graph of as many dense joints a half.
pub const MAX_BYTES: usize = 1 << 20;

/// The ending of the name of a plan file, in place of the extension of its robot file.
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

/// The file that was probably meant to be the [golden file](golden_of) of a robot file that has none: a file beside it
/// whose name is that but for its case, a slip or two, or the point before `golden`. It is not that of another robot
/// file there; and a digit tells robots apart.
pub fn misnamed_golden_of(robot_file: &Path) -> Option<PathBuf> {
    let stem = robot_file.file_stem()?.to_str()?;
    let golden = golden_of(robot_file);
    if golden.exists() {
        return None;
    }
    let folder = robot_file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = fs::read_dir(folder).ok()?.flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    let digits = |name: &str| name.chars().filter(char::is_ascii_digit).collect::<String>();
    let is_meant = |name: &&String| {
        let Some(end) = name.len().checked_sub("?golden.csv".len()) else { return false };
        let Some((other, ending)) = name.split_at_checked(end) else { return false };
        let ends = [".golden.csv", "_golden.csv", "-golden.csv"].contains(&ending.to_ascii_lowercase().as_str());
        let is_of_another = ["yaml", "yml"].iter().any(|extension| names.contains(&format!("{other}.{extension}")));
        ends && (other == stem || !is_of_another)
            && digits(other) == digits(stem)
            && did_you_mean(other, [stem]).is_some()
    };
    names.iter().find(is_meant).map(|name| robot_file.with_file_name(name))
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
    fn a_golden_file_with_another_name_is_found() {
        let meant = |files: &[&str]| {
            let folder = tempfile::tempdir().unwrap();
            for file in files {
                fs::write(folder.path().join(file), "").unwrap();
            }
            let found = misnamed_golden_of(&folder.path().join("wrist_2.yaml"))?;
            assert_eq!(found.parent(), Some(folder.path()));
            found.file_name().and_then(|name| name.to_str()).map(str::to_owned)
        };
        for name in [
            "Wrist_2.golden.csv",
            "wrist_2.Golden.CSV",
            "wirst_2.golden.csv",
            "wrist-2.golden.csv",
            "wrist_2_golden.csv",
            "wrist_2-golden.csv",
        ] {
            // where case is no difference the file is there
            let found = meant(&["wrist_2.yaml", name]);
            assert!(
                found.as_deref() == Some(name) || (found.is_none() && cfg!(any(windows, target_os = "macos"))),
                "{name}"
            );
        }
        assert_eq!(meant(&["wrist_2.golden.csv", "wirst_2.golden.csv"]), None, "it is there");
        for other in ["wrist_3.golden.csv", "elbow_2.golden.csv", ".golden.csv", "golden.csv", "wrist_2.csv", "ü"] {
            assert_eq!(meant(&["wrist_2.yaml", other]), None, "{other}");
        }
        assert_eq!(meant(&["wrist_2.yaml", "wrists_2.yaml", "wrists_2.golden.csv"]), None, "of another robot");
        assert_eq!(misnamed_golden_of(Path::new("nowhere/arm.yaml")), None);
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
