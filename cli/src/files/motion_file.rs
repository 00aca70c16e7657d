//! Writes motions to a file, filtered or as they were recorded: CSV, Parquet or a numpy array.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use indicatif::ProgressBar;
use rne_logs::{Heading, Layout, Log, LogError, Motion, Npy, Quantity, RecordedState, Survey};

use crate::files::file_name::{self, Format};
use crate::files::reading;
use crate::outcome::Failure;
use crate::palette::TYPED;
use crate::render::layout::cell;

/// Returns the format of a file of motions, from its name.
pub(crate) fn format(path: &Path, is_raw: bool) -> Result<Format, Failure> {
    if !is_raw && file_name::format(path, &[Format::Npy]).is_ok() {
        return Err(usage_error!(
            "{} is an array of numpy, which {TYPED}rne log{TYPED:#} writes with {TYPED}--raw{TYPED:#} only; name a \
             file that ends with {TYPED}.csv{TYPED:#} or {TYPED}.parquet{TYPED:#}",
            path.display()
        ));
    }
    let written = [Format::Csv, Format::Parquet, Format::Npy];
    let format = file_name::format(path, if is_raw { &written } else { &written[..2] })?;
    if format == Format::Parquet && cfg!(not(feature = "parquet")) {
        return Err(input_error!(
            "{}: this build of rne does not write Parquet; `cargo install --path cli --features full` in a clone \
             of rne builds one that does",
            path.display()
        ));
    }
    Ok(format)
}

/// A log whose motions are written, and its text in the label column.
pub(crate) struct Written<'a> {
    pub(crate) log: &'a Log,
    pub(crate) survey: &'a Survey,
    pub(crate) label: &'a str,
}

/// How motions are written.
#[derive(Clone, Copy)]
pub(crate) struct Manner<'a> {
    pub(crate) format: Format,
    /// Whether states are written as they were recorded and not filtered.
    pub(crate) is_raw: bool,
    /// Whether columns are named by the order of the robot's joints, `q1`, `q2`, …, as in other commands.
    pub(crate) is_by_order: bool,
    /// The name of a column that says which log a state is from.
    pub(crate) label: Option<&'a str>,
}

impl Manner<'_> {
    /// Returns the names of the columns of joints.
    pub(crate) fn heading<'l>(&self, layout: &'l Layout) -> Heading<'l> {
        if self.is_by_order { Heading::numbered(&layout.joints) } else { Heading::of(&layout.joints) }
    }

    /// Returns the quantities that are written.
    pub(crate) fn quantities(&self, layout: &Layout) -> Vec<Quantity> {
        let all = [
            (Quantity::Position, true),
            (Quantity::Velocity, !self.is_raw || layout.has_velocities),
            (Quantity::Acceleration, !self.is_raw),
            (Quantity::Effort, layout.has_efforts),
        ];
        all.into_iter().filter(|(_, is_there)| *is_there).map(|(quantity, _)| quantity).collect()
    }

    /// Returns whether rows of CSV begin with an absolute time stamp: recorded states keep their stamps if the times of
    /// the log are absolute, as in Parquet.
    fn is_stamped(&self, layout: &Layout) -> bool {
        self.is_raw && layout.origin != 0
    }

    /// Returns the first line of a CSV table.
    fn header(&self, layout: &Layout) -> String {
        let heading = self.heading(layout);
        let mut header = if self.is_stamped(layout) { "timestamp_ns,t" } else { "t" }.to_owned();
        for column in self.quantities(layout).into_iter().flat_map(|quantity| heading.columns(quantity)) {
            let _ = write!(header, ",{column}");
        }
        header += ",run";
        if let Some(label) = self.label {
            let _ = write!(header, ",{}", cell(label));
        }
        header
    }
}

/// The reason why writing stopped.
pub(crate) enum Stopped {
    Unreadable(LogError),
    Unwritable(io::Error),
}

/// Writes the motions of logs; returns the number of their states.
pub(crate) fn write(
    logs: &[Written<'_>],
    manner: Manner<'_>,
    bar: &ProgressBar,
    out: &mut (impl Write + Send),
) -> Result<u64, Stopped> {
    let Some(first) = logs.first() else { return Ok(0) };
    let expected = logs.iter().map(|log| log.survey.counts.states).sum();
    let mut table = begin(manner, out, first.log.layout(), expected).map_err(Stopped::Unwritable)?;
    let mut states = 0;
    for Written { log, survey, label } in logs {
        if manner.is_raw {
            let mut recorded = log.recorded(survey).map_err(Stopped::Unreadable)?;
            while let Some(state) = recorded.read().map_err(Stopped::Unreadable)? {
                table.push_recorded(log.layout(), &state, label).map_err(Stopped::Unwritable)?;
                states += 1;
                if states % 4096 == 0 {
                    reading::show(bar, recorded.progress());
                }
            }
            continue;
        }
        let mut motions = log.motions(survey).map_err(Stopped::Unreadable)?;
        while let Some(piece) = motions.next() {
            let piece = piece.map_err(Stopped::Unreadable)?;
            reading::show(bar, motions.progress());
            table.push(log.layout(), piece.run, &piece.motion, label).map_err(Stopped::Unwritable)?;
            states += piece.motion.len() as u64;
        }
    }
    table.finish(states == expected).map_err(Stopped::Unwritable)?;
    Ok(states)
}

/// A table to which states are appended.
trait Table {
    /// Appends filtered states.
    fn push(&mut self, layout: &Layout, run: u64, motion: &Motion, label: &str) -> io::Result<()>;

    /// Appends a state in the form in which it was recorded.
    fn push_recorded(&mut self, layout: &Layout, state: &RecordedState<'_>, label: &str) -> io::Result<()>;

    /// Ends the table. `is_whole` says whether it has all the states that were counted before.
    fn finish(self: Box<Self>, is_whole: bool) -> io::Result<()>;
}

/// A numpy array whose header, with the number of states, has been written.
struct Array<W>(W);

/// A CSV table.
struct Csv<W> {
    out: W,
    /// The first line, until it is written: a file without states has no header.
    header: String,
    /// Whether there is a column of labels.
    has_label: bool,
    is_stamped: bool,
    line: String,
}

impl<W: Write> Csv<W> {
    /// Writes a row.
    fn row(
        &mut self,
        stamp: i64,
        time: f64,
        numbers: impl Iterator<Item = f64>,
        run: u64,
        label: &str,
    ) -> io::Result<()> {
        if !self.header.is_empty() {
            writeln!(self.out, "{}", self.header)?;
            self.header.clear();
        }
        let line = &mut self.line;
        line.clear();
        if self.is_stamped {
            let _ = write!(line, "{stamp},");
        }
        let _ = write!(line, "{time}");
        for number in numbers {
            let _ = write!(line, ",{number}");
        }
        let _ = write!(line, ",{}", run + 1);
        if self.has_label {
            let _ = write!(line, ",{}", cell(label));
        }
        writeln!(self.out, "{line}")
    }
}

/// Begins a table of a format.
fn begin<'w, W: Write + Send + 'w>(
    manner: Manner<'_>,
    mut out: W,
    layout: &Layout,
    states: u64,
) -> io::Result<Box<dyn Table + 'w>> {
    Ok(match manner.format {
        #[cfg(feature = "parquet")]
        Format::Parquet => parquet::begin(manner, out, layout)?,
        Format::Npy => {
            let columns = 1 + manner.quantities(layout).len() * layout.joints.len();
            out.write_all(&Npy::header(states, columns as u64))?;
            Box::new(Array(out))
        }
        _ => Box::new(Csv {
            out,
            header: manner.header(layout),
            has_label: manner.label.is_some(),
            is_stamped: manner.is_stamped(layout),
            line: String::new(),
        }),
    })
}

impl<W: Write> Table for Csv<W> {
    fn push(&mut self, _layout: &Layout, run: u64, motion: &Motion, label: &str) -> io::Result<()> {
        let Motion { time, q, qd, qdd, tau, .. } = motion;
        for (i, time) in time.iter().enumerate() {
            self.row(0, *time, [q, qd, qdd, tau].into_iter().flatten().map(|list| list[i]), run, label)?;
        }
        Ok(())
    }

    fn push_recorded(&mut self, _layout: &Layout, state: &RecordedState<'_>, label: &str) -> io::Result<()> {
        self.row(state.stamp, state.time, numbers(state), state.run, label)
    }

    fn finish(mut self: Box<Self>, _is_whole: bool) -> io::Result<()> {
        self.out.flush()
    }
}

impl<W: Write> Table for Array<W> {
    fn push(&mut self, _layout: &Layout, _run: u64, _motion: &Motion, _label: &str) -> io::Result<()> {
        Err(io::Error::other("an array has only states as they were recorded"))
    }

    fn push_recorded(&mut self, _layout: &Layout, state: &RecordedState<'_>, _label: &str) -> io::Result<()> {
        let mut all = std::iter::once(state.time).chain(numbers(state));
        all.try_for_each(|number| self.0.write_all(&number.to_le_bytes()))
    }

    fn finish(mut self: Box<Self>, is_whole: bool) -> io::Result<()> {
        if !is_whole {
            return Err(io::Error::other("the log changed while it was read"));
        }
        self.0.flush()
    }
}

/// Returns the quantities of a recorded state, one after the other.
fn numbers<'s>(state: &'s RecordedState<'_>) -> impl Iterator<Item = f64> + use<'s> {
    [state.q, state.qd, state.tau].into_iter().flatten().copied()
}

#[cfg(feature = "parquet")]
mod parquet {
    use std::io::{self, Write};

    use rne_logs::{Layout, Motion, MotionParquet, RecordedState};

    use super::{Manner, Table};

    pub(super) fn begin<'w, W: Write + Send + 'w>(
        manner: Manner<'_>,
        out: W,
        layout: &Layout,
    ) -> io::Result<Box<dyn Table + 'w>> {
        let begin = if manner.is_raw { MotionParquet::of_recorded } else { MotionParquet::new };
        Ok(Box::new(begin(out, layout, manner.label)?))
    }

    impl<W: Write + Send> Table for MotionParquet<W> {
        fn push(&mut self, layout: &Layout, run: u64, motion: &Motion, label: &str) -> io::Result<()> {
            self.push(layout, run, motion, label)
        }

        fn push_recorded(&mut self, layout: &Layout, state: &RecordedState<'_>, label: &str) -> io::Result<()> {
            self.push_recorded(layout, state, label)
        }

        fn finish(self: Box<Self>, _is_whole: bool) -> io::Result<()> {
            (*self).finish()
        }
    }
}
