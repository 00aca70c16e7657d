//! Recognizes the format of a file by its first bytes.

use std::collections::BTreeSet;
use std::fmt;
use std::fs::{self, File};
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use crate::columns::label;
#[cfg(feature = "bags")]
use crate::formats::bags::mcap_bag::McapBag;
#[cfg(feature = "bags")]
use crate::formats::bags::sqlite_bag::SqliteBag;
use crate::formats::csv_table::CsvTable;
use crate::formats::npy_array::NpyArray;
#[cfg(feature = "parquet")]
use crate::formats::parquet::table::ParquetTable;
use crate::formats::sample::Source;
use crate::remedy::Setting;
use crate::{LogError, Options, Target};

/// Format of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A bag of ROS 2 in SQLite.
    Sqlite,
    /// A bag of ROS 2 in MCAP.
    Mcap,
    /// A table in Parquet.
    Parquet,
    /// An array of numpy.
    Npy,
    /// A table of text.
    Csv,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sqlite => "rosbag2, SQLite",
            Self::Mcap => "rosbag2, MCAP",
            Self::Parquet => "Parquet",
            Self::Npy => "array of numpy",
            Self::Csv => "CSV",
        })
    }
}

/// The first bytes of files of each format.
const BEGINNINGS: [(&[u8], Format); 4] = [
    (b"SQLite format 3\0", Format::Sqlite),
    (b"\x89MCAP0\r\n", Format::Mcap),
    (b"PAR1", Format::Parquet),
    (b"\x93NUMPY", Format::Npy),
];

/// Formats that are recognised by their first bytes and cannot be read.
const OTHERS: [(&[u8], &str); 6] = [
    (b"#ROSBAG V", "a bag of ROS 1; `rosbags-convert` makes one of ROS 2"),
    (b"\x28\xb5\x2f\xfd", "compressed with zstd; unpack it with `zstd -d`"),
    (b"\x1f\x8b", "compressed with gzip; unpack it with `gzip -d`"),
    (b"PK\x03\x04", "a zip archive, as of numpy.savez; save one array with numpy.save"),
    (b"\x89HDF", "HDF5; save it as CSV or Parquet"),
    (b"ARROW1", "Arrow's IPC format; save it as Parquet"),
];

impl Format {
    /// Whether states are rows, as in a table or an array, and not messages, as in a bag.
    #[must_use]
    pub fn has_rows(self) -> bool {
        match self {
            Self::Sqlite | Self::Mcap => false,
            Self::Parquet | Self::Npy | Self::Csv => true,
        }
    }

    /// Returns the format of a file.
    pub(crate) fn of(path: &Path) -> Result<Self, LogError> {
        let wrong = |error: std::io::Error| match error.kind() {
            ErrorKind::NotFound => LogError::file(path, "there is no such file"),
            _ => LogError::file(path, format_args!("the file cannot be read: {error}")),
        };
        if !fs::metadata(path).map_err(wrong)?.is_file() {
            return Err(LogError::file(
                path,
                "it is a pipe, a socket or a device, but rne reads a log twice and needs a regular file",
            ));
        }
        let mut first = Vec::new();
        File::open(path).and_then(|file| file.take(16).read_to_end(&mut first)).map_err(wrong)?;
        if let Some((_, format)) = BEGINNINGS.iter().find(|(magic, _)| first.starts_with(magic)) {
            return Ok(*format);
        }
        if let Some((_, other)) = OTHERS.iter().find(|(magic, _)| first.starts_with(magic)) {
            return Err(LogError::file(path, format_args!("this is {other}")));
        }
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
        let is_xml = first.starts_with(b"<") || ["urdf", "xacro"].contains(&extension.as_str());
        let is_yaml = first.starts_with(b"format:") || ["yaml", "yml"].contains(&extension.as_str());
        if path.file_name().is_some_and(|name| name == "metadata.yaml") {
            return Err(LogError::file(path, "this describes a bag of ROS 2; name the folder of the bag"));
        }
        if is_xml || is_yaml {
            let what = if is_xml { "a URDF or another XML file" } else { "a robot file or another YAML file" };
            return Err(LogError::file(
                path,
                format_args!(
                    "this is {what}, but a log is needed here: a CSV, Parquet or npy file, or a bag of ROS 2. One \
                     robot file comes first, then the logs"
                ),
            ));
        }
        let promised = match extension.as_str() {
            "db3" => Some(Self::Sqlite),
            "mcap" => Some(Self::Mcap),
            "parquet" => Some(Self::Parquet),
            "npy" => Some(Self::Npy),
            _ => None,
        };
        match promised {
            Some(format) if first.is_empty() => {
                Err(LogError::file(path, format_args!("the file is empty, so it is not {format}")))
            }
            Some(format) => Err(LogError::file(
                path,
                format_args!(
                    "the file does not begin like a file of the format {format}: it is corrupt or has another format"
                ),
            )),
            None => Ok(Self::Csv),
        }
    }

    /// Opens a file of this format. It selects rows by the options, and watches columns that name arms.
    pub(crate) fn open(self, path: &Path, options: &Options) -> Result<Box<dyn Source>, LogError> {
        let mut source = self.source(path, options)?;
        let columns = source.label_columns();
        for (column, value) in &options.select {
            if columns.is_empty() {
                let what =
                    format!("rows can be selected only by a column of a table, but the format of this file is {self}");
                let (column, value) = (column.clone(), value.clone());
                return Err(LogError::request(path, what).leave_out(Setting::Select { column, value }));
            }
            source.hold(label::find(path, &columns, column)?, Some(value));
        }
        for (place, column) in columns.iter().enumerate() {
            if label::names_arms(column) && !source.labels().iter().any(|label| label.name == *column) {
                source.hold(place, None);
            }
        }
        Ok(source)
    }

    fn source(self, path: &Path, options: &Options) -> Result<Box<dyn Source>, LogError> {
        if self != Self::Npy && !options.columns.is_empty() {
            let what = format!(
                "an order of columns can be given only for arrays of numpy, but this file is {self}, whose columns \
                 have names"
            );
            return Err(LogError::request(path, what).leave_out(Setting::Columns));
        }
        if !matches!(self, Self::Csv | Self::Parquet) && !options.map.is_empty() {
            let (what, setting) = if options.map.iter().all(|mapping| mapping.target == Target::Time) {
                ("a column of times can be named only", Setting::TimeColumn(Vec::new()))
            } else {
                ("a map of columns can be given only", Setting::Map(Vec::new()))
            };
            let what = format!("{what} for tables, but the format of this file is {self}");
            return Err(LogError::request(path, what).leave_out(setting));
        }
        if matches!(self, Self::Sqlite | Self::Mcap) && options.rate.is_some() {
            let what = "a sampling rate can be given only for tables without times, but the messages of this log have \
                        times";
            return Err(LogError::request(path, what).leave_out(Setting::Rate));
        }
        Ok(match self {
            #[cfg(feature = "bags")]
            Self::Sqlite => Box::new(SqliteBag::open(path, options.topic.as_deref())?),
            #[cfg(feature = "bags")]
            Self::Mcap => Box::new(McapBag::open(path, options.topic.as_deref())?),
            #[cfg(feature = "parquet")]
            Self::Parquet => Box::new(ParquetTable::open(path, options)?),
            Self::Npy => Box::new(NpyArray::open(path, options)?),
            Self::Csv => Box::new(CsvTable::open(path, options)?),
            #[cfg(not(all(feature = "bags", feature = "parquet")))]
            other => {
                let error = LogError::file(path, format_args!("this build of rne does not read {other}"));
                return Err(error.remedy(crate::Remedy::BuildWithFormats));
            }
        })
    }
}

/// Returns the files of the given paths. A folder, as rosbag2 writes it, is replaced by the bags inside.
pub(crate) fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, LogError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let wrong = |error: std::io::Error| LogError::file(path, format_args!("the folder cannot be read: {error}"));
        let mut inside = Vec::new();
        for entry in fs::read_dir(path).map_err(wrong)? {
            let file = entry.map_err(wrong)?.path();
            let is_bag = |extension: &std::ffi::OsStr| extension == "db3" || extension == "mcap";
            if file.extension().is_some_and(is_bag) {
                inside.push(file);
            }
        }
        if inside.is_empty() {
            let example = path.join("*.csv");
            return Err(LogError::file(
                path,
                format_args!(
                    "the folder has no rosbag2 bag (*.db3 or *.mcap); for other logs, name the files, such as {}",
                    example.display()
                ),
            ));
        }
        inside.sort_by_key(|file| part(file));
        files.append(&mut inside);
    }
    Ok(files)
}

/// Refuses a file that is given twice, also by different paths, because its states would count twice.
pub(crate) fn check_once(files: &[PathBuf]) -> Result<(), LogError> {
    let mut seen = BTreeSet::new();
    for file in files {
        // a missing file is reported when it is read
        if let Ok(place) = fs::canonicalize(file)
            && !seen.insert(place)
        {
            return Err(LogError::request(file, "the file is named twice, so its states would count twice"));
        }
    }
    Ok(())
}

/// Returns the sort key of a part of a bag: its number, so that `bag_10` comes after `bag_9`, then its name.
fn part(file: &Path) -> (u64, PathBuf) {
    let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    (stem[stem.len() - digits..].parse().unwrap_or(0), file.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_bag_are_in_their_order() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["run_10.db3", "run_9.db3", "run_0.db3", "metadata.yaml"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let found = files(&[folder.path().to_owned()]).unwrap();
        let names: Vec<_> = found.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["run_0.db3", "run_9.db3", "run_10.db3"]);
        assert!(check_once(&found).is_ok());
        let again = folder.path().join(".").join("run_9.db3");
        let twice = files(&[folder.path().to_owned(), again]).unwrap();
        assert!(check_once(&twice).unwrap_err().to_string().contains("run_9.db3: the file is named twice"));
    }
}
