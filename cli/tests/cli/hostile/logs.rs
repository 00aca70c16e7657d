//! Logs in CSV and npy that want to be wrong, endless or large: a sample of `tests/doors`, which has hundreds.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::{Case, Expected, written};

/// The commands that read logs, by what they take before the log.
const COMMANDS: [&[&str]; 3] = [&["log"], &["identify", "planar2"], &["watch", "planar2"]];

/// A log as a file, given to each command that reads one.
pub(super) fn every_command(what: &str, path: &str, options: &[&str], expected: Expected) -> Vec<Case> {
    let name = Path::new(path).file_name().expect("a name").to_str().expect("UTF-8");
    let case = |command: &&[&str]| {
        let arguments = [*command, &[path], options].concat();
        // a log that can be listed need not be enough to identify an arm, and an arm may be refused before its log
        let expected = match expected {
            Expected::Taken if command[0] != "log" => Expected::Either,
            Expected::FailedSaying(_) if command[0] != "log" => Expected::Failed,
            _ => expected,
        };
        let case = Case::new(format!("{what}, {}", command[0]), &arguments, expected);
        if command[0] == "log" { case.naming(name) } else { case }
    };
    COMMANDS.iter().map(case).collect()
}

/// A log of two joints: a time for each row, and what each cell is.
fn csv(rows: usize, time: impl Fn(usize) -> String) -> String {
    let mut text = "t,q1,q2,qd1,qd2,tau1,tau2\n".to_owned();
    for row in 0..rows {
        #[allow(clippy::cast_precision_loss)] // rows are few
        let t = row as f64 / 100.0;
        let _ = writeln!(text, "{},{:.6},{:.6},{:.6},{:.6},1,1", time(row), t.sin(), t.cos(), t.cos(), -t.sin());
    }
    text
}

/// A log of many joints.
fn wide(joints: usize, rows: usize, micros: usize) -> String {
    let names: Vec<String> = (1..=joints).map(|joint| format!("q{joint}")).collect();
    let cells = ",0".repeat(joints);
    let rows = (0..rows).map(|row| format!("0.{:06}{cells}\n", row * micros));
    format!("t,{}\n{}", names.join(","), rows.collect::<String>())
}

/// An array of numpy whose kind of number is this text.
fn npy(kind: &str, shape: &str, body: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': {kind}, 'fortran_order': False, 'shape': {shape}, }}");
    while (header.len() + 11) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let length = u16::try_from(header.len()).expect("a short header").to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), body].concat()
}

/// A kind of number that nests so deep.
fn nested(depth: usize) -> String {
    format!("{}'<f8'{}", "[('a', ".repeat(depth), ")]".repeat(depth))
}

/// What it is, the name of the file, what is in it, options, what shall become of it.
type Input<Content> = (&'static str, &'static str, Content, &'static [&'static str], Expected);

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let refused = |words| Expected::FailedSaying(words);
    let good = csv(400, |row| format!("{row}e-2"));
    let far = csv(400, |row| if row < 200 { format!("{row}e-2") } else { format!("{}", 90_000 + row) });
    let century =
        csv(400, |row| if row < 200 { format!("{row}e-2") } else { format!("{}", 3_000_000_000_usize + row) });
    let stamped = |step: usize| csv(400, move |row| (row * step).to_string());
    let named = |name: &str| good.replace("q1,q2", &format!("{name}/position,other/position"));
    let inputs: Vec<Input<Vec<u8>>> = vec![
        ("a good log", "a.csv", good.clone().into(), &[], Expected::Taken),
        ("nothing", "a.csv", vec![], &[], refused("")),
        ("a header alone", "a.csv", good.lines().next().expect("a header").into(), &[], refused("")),
        ("zeros", "a.csv", vec![0; 1 << 20], &[], refused("")),
        ("UTF-16", "a.csv", good.encode_utf16().flat_map(u16::to_le_bytes).collect(), &[], refused("")),
        ("decimal commas", "a.csv", good.replace(',', ";").replace('.', ",").into(), &[], refused("decimal")),
        ("whole milliseconds at 1 kHz", "a.csv", stamped(1).into(), &[], refused("time-unit")),
        ("whole milliseconds at 500 Hz", "a.csv", stamped(2).into(), &[], refused("time-unit")),
        ("whole microseconds at 1 kHz", "a.csv", stamped(1000).into(), &[], refused("time-unit")),
        ("numbers of frames", "a.csv", stamped(1).into(), &["--cutoff", "0.1"], refused("time-unit")),
        ("a day between rows, in one gap", "a.csv", far.into(), &["--gap", "1e7"], Expected::Either),
        ("a century between rows, in one gap", "a.csv", century.into(), &["--gap", "1e15"], Expected::Either),
        ("1,000 columns at 1 MHz", "a.csv", wide(1000, 100, 1).into(), &[], Expected::Either),
        ("2,000 columns at 1 MHz", "a.csv", wide(2000, 100, 1).into(), &[], refused("")),
        ("130,000 columns", "a.csv", wide(130_000, 2, 1).into(), &[], refused("")),
        ("a line of 5 MB", "a.csv", [good.as_bytes(), &vec![b'1'; 5 << 20]].concat(), &[], refused("")),
        ("a name that controls", "a.csv", named("\u{1B}]0;x\u{7}\u{9B}2J").into(), &[], Expected::Either),
        ("a name that conceals", "a.csv", named("\u{1B}[8mhidden").into(), &[], Expected::Either),
        ("a name that turns around", "a.csv", named("\u{202E}abc").into(), &[], Expected::Either),
        ("192 bytes that nest 12 deep", "a.npy", npy(&nested(12), "(1, 1)", &[]), &[], refused("")),
        ("a kind that nests 5,000 deep", "a.npy", npy(&nested(5000), "(1, 1)", &[]), &[], refused("")),
        ("a shape of 56 GB", "a.npy", npy("'<f8'", "(1000000000, 7)", &[0; 56]), &[], refused("")),
        ("a shape beyond 64 bits", "a.npy", npy("'<f8'", "(4294967296, 4294967296)", &[0; 56]), &[], refused("")),
        ("objects of Python", "a.npy", npy("'|O'", "(1, 7)", b"cos\nsystem\n(S'touch x'\ntR."), &[], refused("")),
        ("an array cut off", "a.npy", npy("'<f8'", "(100, 7)", &[0; 99]), &[], refused("")),
    ];
    let mut cases = Vec::new();
    for (index, (what, name, bytes, options, expected)) in inputs.into_iter().enumerate() {
        cases.extend(every_command(what, &written(folder, index, name, bytes), options, expected));
    }
    cases.extend(formats(folder));
    cases
}

/// The files of formats that are features: `tests/doors` says how such are made.
fn formats(folder: &Path) -> Vec<Case> {
    let refused = |words| Expected::FailedSaying(words);
    // whether this build reads them
    let (parquet, bags) = (cfg!(feature = "parquet"), cfg!(feature = "bags"));
    let files: [Input<bool>; 7] = [
        ("one list of 50 million numbers", "long_list.parquet", parquet, &[], refused("")),
        ("a compression that is not read", "brotli.parquet", parquet, &[], refused("brotli")),
        ("whole milliseconds in u4", "milliseconds.parquet", parquet, &[], refused("time-unit")),
        ("two arms", "two_arms.parquet", parquet, &[], Expected::Failed),
        ("a channel of two topics", "channel_again.mcap", bags, &[], refused("")),
        ("a chunk of 1 GB", "large_chunk.mcap", bags, &[], Expected::Either),
        ("data that SQLite computes", "computed.db3", bags, &[], refused("")),
    ];
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/hostile/files");
    let mut cases = Vec::new();
    for (index, (what, name, is_read, options, expected)) in files.into_iter().enumerate() {
        // what is not read is refused, with the command that has it
        let expected = if is_read { expected } else { refused("--features") };
        let bytes = fs::read(source.join(name)).expect("a file of the project");
        cases.extend(every_command(what, &written(folder, 1000 + index, name, bytes), options, expected));
    }
    cases
}
