//! Reads robot files and plans from disk, up to a size limit, and finds the names of the files that belong to a robot
//! file.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use crate::text::spelling::did_you_mean;

/// Largest size of a robot file or plan that is read, bytes. The longest table, 64 joints, needs a fiftieth of it; a
/// plan with a dense graph for as many joints needs a half.
pub const MAX_BYTES: usize = 1 << 20;

/// The end of the name of a plan file; it replaces the extension of the robot file.
const PLAN: &str = "plan.yaml";

/// Reads the bytes of a robot file for [`Reader::read`](crate::Reader::read), but at most one more than the size limit,
/// which is enough to see that a file is too long. So an endless stream or a huge file takes neither memory nor time.
///
/// # Errors
///
/// As [`Read::read_to_end`].
pub fn read_limited(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads the bytes of a robot file or a plan, up to the [limit](read_limited).
///
/// # Errors
///
/// As [`open_file`] and [`Read::read_to_end`].
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    open_file(path).and_then(read_limited)
}

/// Opens a file for reading. Anything but a regular file is refused: a pipe would block the reader, and a device may be
/// endless.
///
/// # Errors
///
/// As [`File::open`]; a file that is not regular.
pub fn open_file(path: &Path) -> io::Result<File> {
    let metadata = fs::metadata(path)?;
    // a folder is let through, because the error of reading it says best what is wrong
    if !metadata.is_file() && !metadata.is_dir() {
        let message = "it is a pipe, a socket or a device, not a regular file";
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    File::open(path)
}

/// Returns the path of the plan of a robot file: `NAME.plan.yaml` beside `NAME.yaml`.
pub fn plan_of(robot_file: &Path) -> PathBuf {
    robot_file.with_extension(PLAN)
}

/// Returns the path of the golden file of a robot file, a [`GoldenFile`](crate::GoldenFile): `NAME.golden.csv` beside
/// `NAME.yaml`.
pub fn golden_of(robot_file: &Path) -> PathBuf {
    robot_file.with_extension("golden.csv")
}

/// Finds the file that was probably meant to be the [golden file](golden_of) of a robot file that has none: a file in
/// the same folder whose name differs only in case, in one or two letters, or in the separator before `golden`. A name
/// with other digits, or the golden file of another robot file in the folder, is not meant.
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

/// Returns the path of the robot file of a plan: `NAME.yaml` beside `NAME.plan.yaml`; `None` when the path is not that
/// of a plan.
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
            // on file systems that ignore case the golden file exists under this name
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
        // if a pipe without a writer were opened, this test would wait for ever
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
