//! Filtered motions in a file: CSV or Parquet.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use indicatif::ProgressBar;
#[cfg(feature = "parquet")]
use rne_logs::MotionParquet;
use rne_logs::{Layout, Log, LogError, Motion, Survey};

use crate::files::file_name::{self, Format};
use crate::files::reading;
use crate::outcome::Failure;

/// The format of a file of motions, by its name.
pub(crate) fn format(path: &Path) -> Result<Format, Failure> {
    let format = file_name::format(path, &[Format::Csv, Format::Parquet])?;
    if format == Format::Parquet && cfg!(not(feature = "parquet")) {
        return Err(Failure::input(format_args!(
            "{}: this build of rne does not write Parquet; `cargo install --path rne-cli --features full` in a clone \
             of rne builds one that does",
            path.display()
        )));
    }
    Ok(format)
}

/// A log whose motions are written, with the text that they have in the column of [`write`].
pub(crate) struct Written<'a> {
    pub(crate) log: &'a Log,
    pub(crate) survey: &'a Survey,
    pub(crate) label: &'a str,
}

/// Reason for which writing stopped.
pub(crate) enum Stopped {
    Unreadable(LogError),
    Unwritable(io::Error),
}

/// Writes the filtered motions of logs, and the number of their states as the result. `label` is the name of a column
/// that says of which log a state is.
pub(crate) fn write(
    logs: &[Written<'_>],
    label: Option<&str>,
    format: Format,
    bar: &ProgressBar,
    out: &mut (impl Write + Send),
) -> Result<u64, Stopped> {
    let Some(first) = logs.first() else { return Ok(0) };
    let mut table = Table::begin(format, out, first.log.layout(), label).map_err(Stopped::Unwritable)?;
    let mut states = 0;
    for Written { log, survey, label } in logs {
        let mut motions = log.motions(survey).map_err(Stopped::Unreadable)?;
        while let Some(piece) = motions.next() {
            let piece = piece.map_err(Stopped::Unreadable)?;
            reading::show(bar, motions.progress());
            table.push(log.layout(), piece.run, &piece.motion, label).map_err(Stopped::Unwritable)?;
            states += piece.motion.len() as u64;
        }
    }
    table.finish().map_err(Stopped::Unwritable)?;
    Ok(states)
}

/// A table that is written.
enum Table<W: Write + Send> {
    Csv {
        out: W,
        header: String,
        /// Whether there is a column of labels.
        has_label: bool,
    },
    #[cfg(feature = "parquet")]
    Parquet(Box<MotionParquet<W>>),
}

impl<W: Write + Send> Table<W> {
    #[cfg_attr(not(feature = "parquet"), expect(clippy::unnecessary_wraps, reason = "Parquet may fail"))]
    fn begin(format: Format, out: W, layout: &Layout, label: Option<&str>) -> io::Result<Self> {
        #[cfg(feature = "parquet")]
        if format == Format::Parquet {
            return Ok(Self::Parquet(Box::new(MotionParquet::new(out, layout, label)?)));
        }
        debug_assert!(format == Format::Csv);
        let mut header = "t".to_owned();
        for (quantity, is_there) in [("q", true), ("qd", true), ("qdd", true), ("tau", layout.has_efforts)] {
            for joint in (1..=layout.joints.len()).filter(|_| is_there) {
                let _ = write!(header, ",{quantity}{joint}");
            }
        }
        header += ",run";
        if let Some(label) = label {
            let _ = write!(header, ",{}", cell(label));
        }
        Ok(Self::Csv { out, header, has_label: label.is_some() })
    }

    fn push(&mut self, layout: &Layout, run: u64, motion: &Motion, label: &str) -> io::Result<()> {
        let (out, header, has_label) = match self {
            Self::Csv { out, header, has_label } => (out, header, *has_label),
            #[cfg(feature = "parquet")]
            Self::Parquet(table) => return table.push(layout, run, motion, label),
        };
        let _ = layout;
        // a file without states has no header either
        if !header.is_empty() && !motion.is_empty() {
            writeln!(out, "{header}")?;
            header.clear();
        }
        let end = if has_label { format!("{},{}", run + 1, cell(label)) } else { (run + 1).to_string() };
        let mut line = String::new();
        let Motion { time, q, qd, qdd, tau, .. } = motion;
        for (i, time) in time.iter().enumerate() {
            line.clear();
            let _ = write!(line, "{time}");
            for list in [q, qd, qdd, tau].into_iter().flatten() {
                let _ = write!(line, ",{}", list[i]);
            }
            writeln!(out, "{line},{end}")?;
        }
        Ok(())
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Csv { mut out, .. } => out.flush(),
            #[cfg(feature = "parquet")]
            Self::Parquet(table) => table.finish(),
        }
    }
}

/// A text as a cell of CSV.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
