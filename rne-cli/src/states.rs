//! A function over a file of states: read in parts, computed by the machine, written as it is computed.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, IsTerminal as _, Read, Seek as _, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use npyz::{DType, NpyFile, Order, WriterBuilder as _};
use rne_codegen::Function;
use rne_machine::{Arguments, Array, CompiledArm, CompiledFunction, Destination};
use rne_model::{did_you_mean, open_file};

use crate::input_file::is_standard_input;
use crate::outcome::{Failure, Outcome};
use crate::output_file;
use crate::terminal::{GOOD, QUIET};

/// States of a part: some megabytes, whatever the file's size.
const PART: usize = 16_384;

/// What a file of numpy begins with.
const MAGIC: &[u8] = b"\x93NUMPY";

/// A file of states, and where its results go.
pub(crate) struct Job<'a> {
    pub(crate) robot_file: &'a Path,
    pub(crate) arm: &'a CompiledArm,
    pub(crate) function: Function,
    pub(crate) states: &'a Path,
    /// Standard output, unless given.
    pub(crate) out: Option<&'a Path>,
    pub(crate) force: bool,
}

/// The columns of a table of states: the elements of the function's arguments.
fn columns(compiled: &CompiledFunction, arm: &CompiledArm) -> Vec<String> {
    let axes = ["x", "y", "z"];
    let payload = ["m", "cx", "cy", "cz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"];
    let of = |&(name, elements): &(&str, usize)| -> Vec<String> {
        match name {
            "payload" => payload.map(str::to_owned).into(),
            "parameters" => arm.robot().run_time.names.clone(),
            "q" | "qd" | "qdd" | "tau" | "sin" | "cos" => {
                (1..=elements).map(|joint| format!("{name}{joint}")).collect()
            }
            _ => axes.map(|axis| format!("{name}_{axis}")).into(),
        }
    };
    compiled.arguments().iter().flat_map(of).collect()
}

impl Job<'_> {
    pub(crate) fn run(&self) -> Result<Outcome, Failure> {
        let compiled = self.arm.function(self.function).map_err(Failure::input)?;
        let columns = columns(compiled, self.arm);
        let mut table = Table::open(self.states, &columns)?;
        let outputs: Vec<String> = compiled.program().outputs.iter().map(|output| output.name.to_string()).collect();
        let mut results = Results::open(self, &outputs)?;
        let progress = progress(self.states, table.states, results.is_terminal());
        let start = Instant::now();
        let mut states = 0_usize;
        let (mut rows, mut numbers) = (Vec::with_capacity(PART * columns.len()), vec![0.0; PART * outputs.len()]);
        loop {
            rows.clear();
            let count = table.read(&mut rows)?;
            if count == 0 {
                break;
            }
            let mut at = 0;
            let mut arguments = Arguments::new();
            for &(name, elements) in compiled.arguments() {
                let argument = Array::Strided { numbers: &rows[at..], state: columns.len(), element: 1 };
                arguments = arguments.with(name, argument).unwrap_or(arguments);
                at += elements;
            }
            let room = &mut numbers[..count * outputs.len()];
            self.arm.run(self.function, count, &arguments, Destination::Rows(room)).map_err(Failure::input)?;
            results.write(room)?;
            states += count;
            progress.inc(count as u64);
        }
        progress.finish_and_clear();
        results.finish()?;
        #[allow(clippy::cast_precision_loss)] // of a rate, three digits are told
        let rate = states as f64 / start.elapsed().as_secs_f64().max(1e-9);
        let place = self
            .out
            .filter(|out| !is_standard_input(out))
            .map_or(String::new(), |out| format!("{GOOD}wrote{GOOD:#} {}: ", out.display()));
        Ok(Outcome::remark(format!(
            "{place}{} of {states} states {QUIET}({rate:.2e} a second, reading and writing included){QUIET:#}\n",
            self.function
        )))
    }
}

/// A bar on a terminal that shows nothing else.
fn progress(states: &Path, count: Option<u64>, is_result_shown: bool) -> ProgressBar {
    if is_result_shown || is_standard_input(states) && io::stdin().is_terminal() {
        return ProgressBar::hidden();
    }
    let (bar, template) = match count {
        Some(count) => (ProgressBar::new(count), "{bar:30} {human_pos} of {human_len} states, {per_sec}"),
        None => (ProgressBar::no_length(), "{spinner} {human_pos} states, {per_sec}"),
    };
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}

/// A table of numbers that is read in parts.
struct Table {
    /// How many states there are, where the file says so.
    states: Option<u64>,
    name: String,
    rows: Rows,
}

enum Rows {
    Csv { reader: Box<csv::Reader<Box<dyn BufRead>>>, columns: Vec<(usize, String)>, record: csv::StringRecord },
    Npy { numbers: Box<dyn Iterator<Item = io::Result<f64>>>, width: usize },
}

impl Table {
    fn open(path: &Path, columns: &[String]) -> Result<Self, Failure> {
        let name = if is_standard_input(path) { "<standard input>".to_owned() } else { path.display().to_string() };
        let unreadable = |error: io::Error| Failure::input(format_args!("the states {name} cannot be read: {error}"));
        let file: Box<dyn Read> = if is_standard_input(path) {
            Box::new(io::stdin())
        } else {
            Box::new(open_file(path).map_err(unreadable)?)
        };
        let mut file: Box<dyn BufRead> = Box::new(BufReader::with_capacity(1 << 18, file));
        // a pipe may give a few bytes at first
        let first = file.fill_buf().map_err(unreadable)?;
        if first.starts_with(&MAGIC[..MAGIC.len().min(first.len())]) && !first.is_empty() {
            return Self::npy(name, file, columns);
        }
        Self::csv(name, file, columns)
    }

    fn csv(name: String, file: Box<dyn BufRead>, wanted: &[String]) -> Result<Self, Failure> {
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).has_headers(true).from_reader(file);
        let header = reader.headers().map_err(|error| Failure::input(format_args!("{name}: {error}")))?.clone();
        let has = |c: char| header.iter().any(|cell| cell.contains(c));
        let separator = if header.len() == 1 { [';', '\t'].into_iter().find(|c| has(*c)) } else { None };
        let mut columns = Vec::new();
        let mut missing = Vec::new();
        for column in wanted {
            match header.iter().position(|cell| cell.trim_start_matches('\u{feff}') == column) {
                Some(place) => columns.push((place, column.clone())),
                None => missing.push(column.as_str()),
            }
        }
        if let Some(first) = missing.first() {
            let found: Vec<&str> = header.iter().collect();
            let near = match separator {
                Some('\t') => " (the header has tabs; columns are separated by commas)".to_owned(),
                Some(_) => " (the header has semicolons; columns are separated by commas)".to_owned(),
                None => did_you_mean(first, found.iter().copied())
                    .map_or(String::new(), |near| format!(" (there is `{near}`)")),
            };
            return Err(Failure::input(format_args!(
                "{name}: line 1 has no column `{first}`{near}; needed are {}, others are passed over",
                wanted.join(", ")
            )));
        }
        Ok(Self {
            states: None,
            name,
            rows: Rows::Csv { reader: Box::new(reader), columns, record: csv::StringRecord::new() },
        })
    }

    fn npy(name: String, file: Box<dyn BufRead>, wanted: &[String]) -> Result<Self, Failure> {
        let wrong = |what: &dyn std::fmt::Display| Failure::input(format_args!("{name}: {what}"));
        let npy = NpyFile::new(file).map_err(|error| wrong(&format_args!("no array of numpy: {error}")))?;
        let (shape, order) = (npy.shape().to_vec(), npy.order());
        let [states, width] = shape[..] else {
            return Err(wrong(&format_args!("the array has {} axes; it is (states, {})", shape.len(), wanted.len())));
        };
        if width != wanted.len() as u64 {
            return Err(wrong(&format_args!(
                "a state has {width} numbers; it has {}: {}",
                wanted.len(),
                wanted.join(", ")
            )));
        }
        if order == Order::Fortran && states > 1 && width > 1 {
            return Err(wrong(&"the array is in Fortran's order; save numpy.ascontiguousarray(states)"));
        }
        let kind = match npy.dtype() {
            DType::Plain(kind) => kind.to_string(),
            other => other.descr(),
        };
        let numbers: Box<dyn Iterator<Item = io::Result<f64>>> = match kind.trim_start_matches(['<', '>', '=', '|']) {
            "f8" => Box::new(npy.data::<f64>().map_err(|error| wrong(&error))?),
            "f4" => Box::new(npy.data::<f32>().map_err(|error| wrong(&error))?.map(|x| x.map(f64::from))),
            _ => return Err(wrong(&format_args!("the numbers are `{kind}`; save them as float64 or float32"))),
        };
        Ok(Self { states: Some(states), name, rows: Rows::Npy { numbers, width: wanted.len() } })
    }

    /// Appends the rows of the next part; how many there are.
    fn read(&mut self, rows: &mut Vec<f64>) -> Result<usize, Failure> {
        let name = &self.name;
        match &mut self.rows {
            Rows::Csv { reader, columns, record } => {
                let mut count = 0;
                while count < PART {
                    let line = reader.position().line();
                    let is_there = reader.read_record(record).map_err(|error| {
                        let line = error.position().map_or(line, csv::Position::line);
                        let what = match error.kind() {
                            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                                format!("{len} cells where the header has {expected_len}")
                            }
                            _ => error.to_string(),
                        };
                        Failure::input(format_args!("{name}:{line}: {what}"))
                    })?;
                    if !is_there {
                        break;
                    }
                    for (place, column) in &*columns {
                        let cell = record.get(*place).unwrap_or_default();
                        let number: f64 = cell.parse().map_err(|_| {
                            let line = record.position().map_or(line, csv::Position::line);
                            Failure::input(format_args!("{name}:{line}: `{column}` is `{cell}`, which is no number"))
                        })?;
                        rows.push(number);
                    }
                    count += 1;
                }
                Ok(count)
            }
            Rows::Npy { numbers, width } => {
                for number in numbers.by_ref().take(PART * *width) {
                    let number = number.map_err(|error| {
                        Failure::input(format_args!("{name}: the file ends before its last state: {error}"))
                    })?;
                    rows.push(number);
                }
                Ok(rows.len() / (*width).max(1))
            }
        }
    }
}

/// Where results go: CSV as they come; arrays of numpy behind a header that tells their number.
enum Results {
    Csv { out: BufWriter<Box<dyn Write>>, is_terminal: bool, width: usize, kept: Option<Kept> },
    Npy { out: BufWriter<File>, width: usize, kept: Kept },
}

/// A file that is kept when it is whole.
struct Kept {
    file: tempfile::NamedTempFile,
    path: PathBuf,
}

impl Results {
    fn open(job: &Job<'_>, outputs: &[String]) -> Result<Self, Failure> {
        let header = outputs.join(",") + "\n";
        let Some(path) = job.out.filter(|out| !is_standard_input(out)) else {
            let is_terminal = io::stdout().is_terminal();
            let mut out = BufWriter::new(Box::new(io::stdout()) as Box<dyn Write>);
            out.write_all(header.as_bytes()).map_err(stopped)?;
            return Ok(Self::Csv { out, is_terminal, width: outputs.len(), kept: None });
        };
        output_file::check_new(path, None, &[job.robot_file, job.states], job.force)?;
        let unwritable = |error: io::Error| output_file::unwritable(path, &error);
        let file = output_file::beside(path).map_err(unwritable)?;
        let kept = Kept { path: path.to_owned(), file };
        let handle = kept.file.reopen().map_err(unwritable)?;
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("npy")) {
            // the numbers now; the header, which tells how many states there are, when they are known
            return Ok(Self::Npy { out: BufWriter::new(handle), width: outputs.len(), kept });
        }
        let mut out = BufWriter::new(Box::new(handle) as Box<dyn Write>);
        out.write_all(header.as_bytes()).map_err(unwritable)?;
        Ok(Self::Csv { out, is_terminal: false, width: outputs.len(), kept: Some(kept) })
    }

    fn is_terminal(&self) -> bool {
        matches!(self, Self::Csv { is_terminal: true, .. })
    }

    fn write(&mut self, numbers: &[f64]) -> Result<(), Failure> {
        match self {
            Self::Csv { out, width, .. } => {
                let mut line = String::new();
                for row in numbers.chunks((*width).max(1)) {
                    line.clear();
                    for (index, number) in row.iter().enumerate() {
                        let _ = std::fmt::Write::write_fmt(
                            &mut line,
                            format_args!("{}{number:?}", if index > 0 { "," } else { "" }),
                        );
                    }
                    line.push('\n');
                    out.write_all(line.as_bytes()).map_err(stopped)?;
                }
                Ok(())
            }
            Self::Npy { out, .. } => {
                numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes())).map_err(stopped)
            }
        }
    }

    fn finish(self) -> Result<(), Failure> {
        match self {
            Self::Csv { mut out, kept, .. } => {
                out.flush().map_err(stopped)?;
                kept.map_or(Ok(()), Kept::persist)
            }
            Self::Npy { out, width, kept } => {
                let mut numbers = out.into_inner().map_err(|error| stopped(error.into_error()))?;
                let states = numbers.stream_position().map_err(stopped)? / (8 * width.max(1) as u64);
                numbers.seek(io::SeekFrom::Start(0)).map_err(stopped)?;
                // a second file beside it, with the header in front
                let whole = output_file::beside(&kept.path).map_err(stopped)?;
                let mut out = BufWriter::new(whole.reopen().map_err(stopped)?);
                npyz::WriteOptions::new()
                    .default_dtype()
                    .shape(&[states, width as u64])
                    .writer(&mut out)
                    .begin_nd()
                    .and_then(|mut writer: npyz::NpyWriter<f64, _>| {
                        let mut numbers = BufReader::new(kept.file.reopen()?);
                        let mut bytes = [0; 8];
                        for _ in 0..states * width as u64 {
                            numbers.read_exact(&mut bytes)?;
                            writer.push(&f64::from_le_bytes(bytes))?;
                        }
                        writer.finish()
                    })
                    .map_err(stopped)?;
                out.flush().map_err(stopped)?;
                Kept { file: whole, path: kept.path }.persist()
            }
        }
    }
}

impl Kept {
    fn persist(self) -> Result<(), Failure> {
        let path = self.path;
        self.file
            .persist(&path)
            .map(drop)
            .map_err(|error| Failure::input(format_args!("{} cannot be written: {}", path.display(), error.error)))
    }
}

/// Writing that ended; what is already written of a stream stays, files do not appear.
fn stopped(error: io::Error) -> Failure {
    Failure::input(format_args!("the results cannot be written: {error}"))
}
