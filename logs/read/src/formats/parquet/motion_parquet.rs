//! Writes motions as a table in Parquet with a column of lists for each quantity, for queries in SQL.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type};

use crate::limits::MOST_NUMBERS;
use crate::{Layout, Motion, RecordedState};

/// Number of rows of a group: query engines read groups in parallel.
const ROWS: usize = 1 << 16;

/// The names of the columns of the table; a label must have another name.
const COLUMNS: [&str; 7] = ["time", "name", "q", "qd", "qdd", "tau", "run"];

/// Writes motions as a table in Parquet; it keeps one group of rows in memory.
///
/// The columns are `time`, `name`, `q`, `qd`, `qdd`, `tau` and `run`. `name` is the list of joint names, base to tip;
/// the following four are lists with a number per joint, in SI units; `tau` is missing where the log has no efforts.
/// `run` is the number of the run, from 1. `time` is a time stamp in ns if the times of the log are absolute
/// ([`Layout::origin`] is not 0), and a number of seconds otherwise. A table of unfiltered states has no `qdd`, and no
/// `qd` if the log has no velocities. [`Log`](crate::Log) reads such a table.
pub struct MotionParquet<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    joints: Vec<String>,
    is_stamped: bool,
    /// Whether the table has columns of positions, velocities, accelerations and torques.
    has: [bool; 4],
    has_label: bool,
    rows: Rows,
}

impl<W: Write + Send> std::fmt::Debug for MotionParquet<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("MotionParquet").field("joints", &self.joints).finish_non_exhaustive()
    }
}

/// Rows that are not written yet.
#[derive(Default)]
struct Rows {
    seconds: Vec<f64>,
    stamps: Vec<i64>,
    /// Positions, velocities, accelerations and torques, row by row.
    lists: [Vec<f64>; 4],
    runs: Vec<i64>,
    labels: Vec<ByteArray>,
}

impl<W: Write + Send> MotionParquet<W> {
    /// Begins a table for motions of a log with this layout. `label` is the name of an additional column of texts.
    ///
    /// # Errors
    /// When the table already has a column with the label's name, or the output cannot be written.
    pub fn new(out: W, layout: &Layout, label: Option<&str>) -> io::Result<Self> {
        Self::with(out, layout, label, [true, true, true, layout.has_efforts])
    }

    /// Begins a table for the unfiltered states of a log with this layout, which [`MotionParquet::push_recorded`]
    /// appends.
    ///
    /// # Errors
    /// The errors of [`MotionParquet::new`].
    pub fn of_recorded(out: W, layout: &Layout, label: Option<&str>) -> io::Result<Self> {
        Self::with(out, layout, label, [true, layout.has_velocities, false, layout.has_efforts])
    }

    fn with(out: W, layout: &Layout, label: Option<&str>, has: [bool; 4]) -> io::Result<Self> {
        if let Some(label) = label.filter(|label| COLUMNS.contains(label)) {
            let what = format!("the table has a column {label} of its own, so no other column can have this name");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
        }
        let is_stamped = layout.origin != 0;
        let schema = schema(is_stamped, has, label)?;
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_dictionary_enabled(false)
            .set_column_dictionary_enabled(ColumnPath::new(LIST.map(|part| part.replace('*', "name")).to_vec()), true);
        if let Some(label) = label {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(label), true);
        }
        Ok(Self {
            writer: SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build()))?,
            joints: layout.joints.clone(),
            is_stamped,
            has,
            has_label: label.is_some(),
            rows: Rows::default(),
        })
    }

    /// Appends a motion of run number `run`, from 0, with the text of its label. `layout` is that of the motion's log.
    ///
    /// # Errors
    /// When the joints are not those of the table, or the output cannot be written.
    pub fn push(&mut self, layout: &Layout, run: u64, motion: &Motion, label: &str) -> io::Result<()> {
        self.check(layout)?;
        let label = ByteArray::from(label);
        for (row, time) in motion.time.iter().enumerate() {
            let quantities = [&motion.q, &motion.qd, &motion.qdd, &motion.tau];
            for (list, numbers) in self.rows.lists.iter_mut().zip(quantities) {
                list.extend(numbers.iter().map(|of_joint| of_joint[row]));
            }
            self.end_row(layout.origin.saturating_add(nanoseconds(*time)), *time, layout, run, &label)?;
        }
        Ok(())
    }

    /// Appends an unfiltered state with the text of its label. `layout` is that of the state's log.
    ///
    /// # Errors
    /// The errors of [`MotionParquet::push`].
    pub fn push_recorded(&mut self, layout: &Layout, state: &RecordedState<'_>, label: &str) -> io::Result<()> {
        self.check(layout)?;
        for (list, numbers) in self.rows.lists.iter_mut().zip([state.q, state.qd, &[], state.tau]) {
            list.extend_from_slice(numbers);
        }
        self.end_row(state.stamp, state.time, layout, state.run, &ByteArray::from(label))
    }

    /// Refuses a log with other joints or quantities than the table.
    fn check(&self, layout: &Layout) -> io::Result<()> {
        let [_, has_velocities, has_accelerations, has_efforts] = self.has;
        // a filtered motion always has velocities
        let has_others = has_accelerations || layout.has_velocities == has_velocities;
        if layout.joints == self.joints && layout.has_efforts == has_efforts && has_others {
            return Ok(());
        }
        let what = format!(
            "the joints of one table and their quantities must be the same in all of its rows: {} and {}",
            self.joints.join(", "),
            layout.joints.join(", ")
        );
        Err(io::Error::new(io::ErrorKind::InvalidInput, what))
    }

    /// Completes a row whose lists have been added: by its stamp, ns, its time since the origin, s, its run and its
    /// label.
    #[expect(clippy::cast_precision_loss, reason = "an origin that is not 0 is far from it")]
    fn end_row(&mut self, stamp: i64, time: f64, layout: &Layout, run: u64, label: &ByteArray) -> io::Result<()> {
        let rows = &mut self.rows;
        if self.is_stamped {
            rows.stamps.push(stamp);
        } else {
            rows.seconds.push(time + layout.origin as f64 * 1e-9);
        }
        rows.runs.push(i64::try_from(run).unwrap_or(i64::MAX).saturating_add(1));
        if self.has_label {
            rows.labels.push(label.clone());
        }
        if rows.runs.len() == (MOST_NUMBERS / 4 / self.joints.len()).clamp(1, ROWS) {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes the remaining rows and the end of the file.
    ///
    /// # Errors
    /// When the output cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        self.writer.close()?;
        Ok(())
    }

    fn flush(&mut self) -> Result<(), ParquetError> {
        let rows = std::mem::take(&mut self.rows);
        if rows.runs.is_empty() {
            return Ok(());
        }
        let count = rows.runs.len();
        let joints = self.joints.len();
        let definitions = vec![1; count * joints];
        let repetitions: Vec<i16> = (0..count * joints).map(|place| i16::from(place % joints != 0)).collect();
        let levels = Some((definitions.as_slice(), repetitions.as_slice()));
        let names = self.joints.iter().map(|name| ByteArray::from(name.as_str())).cycle();
        let names: Vec<ByteArray> = names.take(count * joints).collect();
        let mut group = self.writer.next_row_group()?;
        if self.is_stamped {
            write::<Int64Type, _>(&mut group, &rows.stamps, None)?;
        } else {
            write::<DoubleType, _>(&mut group, &rows.seconds, None)?;
        }
        write::<ByteArrayType, _>(&mut group, &names, levels)?;
        for (list, _) in rows.lists.iter().zip(self.has).filter(|(_, is_there)| *is_there) {
            write::<DoubleType, _>(&mut group, list, levels)?;
        }
        write::<Int64Type, _>(&mut group, &rows.runs, None)?;
        if self.has_label {
            write::<ByteArrayType, _>(&mut group, &rows.labels, None)?;
        }
        group.close()?;
        Ok(())
    }
}

#[expect(clippy::cast_possible_truncation, reason = "seconds of a log")]
fn nanoseconds(seconds: f64) -> i64 {
    (seconds * 1e9).round() as i64
}

/// The path of the elements of a list.
const LIST: [&str; 3] = ["*", "list", "element"];

fn write<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &[T::T],
    levels: Option<(&[i16], &[i16])>,
) -> Result<(), ParquetError> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("the schema has too few columns".to_owned()));
    };
    let (definitions, repetitions) = levels.unzip();
    column.typed::<T>().write_batch(values, definitions, repetitions)?;
    column.close()
}

fn schema(is_stamped: bool, has: [bool; 4], label: Option<&str>) -> Result<Type, ParquetError> {
    use parquet::basic::{LogicalType, Repetition, TimeUnit, Type as Physical};
    let leaf = |name: &str, physical: Physical, logical: Option<LogicalType>| {
        let builder = Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED);
        builder.with_logical_type(logical).build().map(Arc::new)
    };
    let group = |name: &str, repetition, logical, field| {
        let builder = Type::group_type_builder(name).with_repetition(repetition).with_logical_type(logical);
        builder.with_fields(vec![field]).build().map(Arc::new)
    };
    let list = |name: &str, element| {
        let list = group(LIST[1], Repetition::REPEATED, None, element)?;
        group(name, Repetition::REQUIRED, Some(LogicalType::List), list)
    };
    let text = Some(LogicalType::String);
    let mut fields = vec![
        if is_stamped {
            let stamp = LogicalType::timestamp(true, TimeUnit::NANOS);
            leaf(COLUMNS[0], Physical::INT64, Some(stamp))?
        } else {
            leaf(COLUMNS[0], Physical::DOUBLE, None)?
        },
        list(COLUMNS[1], leaf(LIST[2], Physical::BYTE_ARRAY, text.clone())?)?,
    ];
    for (name, _) in COLUMNS[2..6].iter().zip(has).filter(|(_, is_there)| *is_there) {
        fields.push(list(name, leaf(LIST[2], Physical::DOUBLE, None)?)?);
    }
    fields.push(leaf(COLUMNS[6], Physical::INT64, None)?);
    if let Some(label) = label {
        fields.push(leaf(label, Physical::BYTE_ARRAY, text)?);
    }
    Type::group_type_builder("motion").with_fields(fields).build()
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader as _, SerializedFileReader};
    use parquet::record::RowAccessor as _;

    use super::*;
    use crate::formats::parquet::table::ParquetTable;
    use crate::formats::sample::{Sample, Source as _};
    use crate::{Log, Options};

    /// Returns a motion of two joints with numbers that need all digits.
    fn motion(states: u32, from: f64) -> Motion {
        let time: Vec<f64> = (0..states).map(|state| from + f64::from(state) * 0.01).collect();
        let lists = |factor: f64| [0.3, 0.7].map(|speed| time.iter().map(|t| factor * (speed * t).sin()).collect());
        let [q, qd, qdd, tau] = [1.0, -2.0, 3.0, 1e-3].map(|factor| lists(factor).to_vec());
        Motion { time, q, qd, qdd, tau, recorded: Vec::new() }
    }

    /// Returns the layout of a log of these joints whose times begin at `origin`, ns.
    fn layout(origin: i64) -> Layout {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let header = "timestamp_ns,elbow_position,wrist_position,elbow_effort,wrist_effort".to_owned();
        let rows = (0..10).map(|state| format!("{},0.1,0.2,1,2", origin + state * 10_000_000));
        std::fs::write(&path, [header].into_iter().chain(rows).collect::<Vec<_>>().join("\n")).unwrap();
        Log::open(&[path], Options::default()).unwrap().layout().clone()
    }

    /// Writes two runs; the second has enough states for two groups of rows.
    fn written(origin: i64, label: Option<&str>) -> (tempfile::TempDir, std::path::PathBuf, [Motion; 2]) {
        let (layout, motions) = (layout(origin), [motion(50, 0.8), motion(70_000, 3.1)]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("motion.parquet");
        let mut table = MotionParquet::new(std::fs::File::create(&path).unwrap(), &layout, label).unwrap();
        for (run, motion) in motions.iter().enumerate() {
            table.push(&layout, run as u64, motion, ["r1", "r2"][run]).unwrap();
        }
        table.finish().unwrap();
        (folder, path, motions)
    }

    #[test]
    fn what_is_written_is_read_again() {
        for origin in [0, 1_700_000_000_123_456_789] {
            let (_folder, path, motions) = written(origin, None);
            let mut table = ParquetTable::open(&path, &Options::default()).unwrap();
            assert!(table.is_time_unit_known() == (origin != 0) && table.unread().is_empty(), "{:?}", table.unread());
            let mut sample = Sample::default();
            for motion in &motions {
                for row in 0..motion.len() {
                    assert!(table.read(&mut sample).unwrap());
                    let at_row = |lists: &[Vec<f64>]| lists.iter().map(|list| list[row]).collect::<Vec<_>>();
                    assert_eq!(sample.names, ["elbow", "wrist"]);
                    assert_eq!(sample.measured, origin + nanoseconds(motion.time[row]));
                    assert_eq!(sample.position, at_row(&motion.q));
                    assert_eq!(sample.velocity, at_row(&motion.qd));
                    assert_eq!(sample.effort, at_row(&motion.tau));
                }
            }
            assert!(!table.read(&mut sample).unwrap());
        }
    }

    #[test]
    fn accelerations_runs_and_labels_have_columns() {
        let (_folder, path, motions) = written(0, Some("robot_id"));
        let reader = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
        assert_eq!(reader.num_row_groups(), 2);
        let schema = reader.metadata().file_metadata().schema();
        let names: Vec<&str> = schema.get_fields().iter().map(|field| field.name()).collect();
        assert_eq!(names, ["time", "name", "q", "qd", "qdd", "tau", "run", "robot_id"]);
        let mut rows = reader.get_row_iter(None).unwrap();
        for (run, motion) in motions.iter().enumerate() {
            for row in 0..motion.len() {
                let read = rows.next().unwrap().unwrap();
                let list = read.get_list(4).unwrap();
                let list: Vec<f64> = list.elements().iter().map(|field| field.to_string().parse().unwrap()).collect();
                assert_eq!(list, [motion.qdd[0][row], motion.qdd[1][row]]);
                assert_eq!(read.get_long(6).unwrap(), [1, 2][run]);
                assert_eq!(read.get_string(7).unwrap(), ["r1", "r2"][run]);
            }
        }
        assert!(rows.next().is_none());
    }

    #[test]
    fn joints_and_names_of_columns_are_checked() {
        let layout = layout(0);
        let error = MotionParquet::new(Vec::new(), &layout, Some("run")).unwrap_err();
        assert!(error.to_string().contains("has a column run of its own"), "{error}");
        let mut table = MotionParquet::new(Vec::new(), &layout, None).unwrap();
        let other = Layout { joints: vec!["a".into(), "b".into()], ..layout.clone() };
        let error = table.push(&other, 0, &motion(3, 0.0), "").unwrap_err();
        assert!(error.to_string().ends_with("elbow, wrist and a, b"), "{error}");
    }
}
