//! Writes the results of many states while they are computed.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, IsTerminal as _, Seek as _, Write};
use std::path::Path;

use rne_logs::Npy;

use crate::files::file_name::{self, Format};
use crate::files::output_file::{self, Replacement};
use crate::outcome::Failure;

/// CSV or a numpy array, written while results are computed. The header of an array contains the number of states, so
/// it is written last, at the place reserved for it.
pub(crate) enum Results {
    Csv {
        out: BufWriter<Box<dyn Write>>,
        /// The line with the names of the columns, until it is written: if no state can be computed, nothing is
        /// written.
        header: Option<String>,
        is_terminal: bool,
        width: usize,
        kept: Option<Replacement>,
    },
    Npy {
        out: BufWriter<File>,
        width: usize,
        states: u64,
        kept: Replacement,
    },
}

impl Results {
    /// Opens a file or standard output; files that are `read` are not overwritten. Each row has the numbers `outputs`.
    pub(crate) fn open(path: Option<&Path>, read: &[&Path], force: bool, outputs: &[String]) -> Result<Self, Failure> {
        let (header, width) = (Some(outputs.join(",") + "\n"), outputs.len());
        let Some(path) = path else {
            let is_terminal = io::stdout().is_terminal();
            let out = BufWriter::new(Box::new(io::stdout()) as Box<dyn Write>);
            return Ok(Self::Csv { out, header, is_terminal, width, kept: None });
        };
        output_file::check_new(path, None, read, force)?;
        let format = file_name::format(path, &[Format::Csv, Format::Npy])?;
        let unwritable = |error: io::Error| output_file::unwritable(path, &error);
        let kept = Replacement::begin(path).map_err(unwritable)?;
        let file = kept.file().map_err(unwritable)?;
        if format == Format::Npy {
            let mut out = BufWriter::new(file);
            out.write_all(&Npy::header(0, width as u64)).map_err(unwritable)?;
            return Ok(Self::Npy { out, width, states: 0, kept });
        }
        let out = BufWriter::new(Box::new(file) as Box<dyn Write>);
        Ok(Self::Csv { out, header, is_terminal: false, width, kept: Some(kept) })
    }

    pub(crate) fn is_terminal(&self) -> bool {
        matches!(self, Self::Csv { is_terminal: true, .. })
    }

    pub(crate) fn write(&mut self, numbers: &[f64]) -> io::Result<()> {
        match self {
            Self::Csv { out, header, width, .. } => {
                if let Some(header) = header.take() {
                    out.write_all(header.as_bytes())?;
                }
                let mut line = String::new();
                for row in numbers.chunks((*width).max(1)) {
                    line.clear();
                    for (index, number) in row.iter().enumerate() {
                        let _ = write!(line, "{}{number:?}", if index > 0 { "," } else { "" });
                    }
                    line.push('\n');
                    out.write_all(line.as_bytes())?;
                }
                Ok(())
            }
            Self::Npy { out, width, states, .. } => {
                *states += (numbers.len() / (*width).max(1)) as u64;
                numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
            }
        }
    }

    /// Ends the writing: a file now appears at its place.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.write(&[])?;
        match self {
            Self::Csv { mut out, kept, .. } => {
                out.flush()?;
                kept.map_or(Ok(()), Replacement::keep)
            }
            Self::Npy { mut out, width, states, kept } => {
                out.seek(io::SeekFrom::Start(0))?;
                out.write_all(&Npy::header(states, width as u64))?;
                out.flush()?;
                drop(out);
                kept.keep()
            }
        }
    }
}

/// Makes the error for results that cannot be written. Text that went to a stream stays there; a file does not appear.
pub(crate) fn stopped(error: &io::Error) -> Failure {
    input_error!("the results cannot be written: {error}")
}
