//! Golden files: tables of states and torques beside a robot file, with which its tests compare.

use std::ops::Range;

use crate::text::diagnostic::{Diagnostic, Problems, Report};
use crate::text::source::{not_utf8, quoted};
use crate::text::spelling::did_you_mean;

/// Tolerance of torques where the file gives none, as a part of the largest torque of the file.
const TOLERANCE: f64 = 1e-9;

/// The word of the comment that gives the tolerance of torques.
const TOLERANCE_KEY: &str = "tolerance:";

/// A golden file: lines of comma-separated numbers below the header `q1, …, qd1, …, qdd1, …, tau1, …`, with n columns
/// of each for n joints; rad, rad/s, rad/s² and N m, or m, m/s, m/s² and N for a prismatic joint. `#` begins a comment;
/// the comment `# tolerance: 1e-6` says by which part of the largest torque of the file torques may differ, `1e-9` by
/// default.
/// ```
/// let text = "# of a test rig\nq1,qd1,qdd1,tau1\n0, 0, 0, 4.9 # at rest\n";
/// let golden = rne_model::GoldenFile::read("rod.golden.csv", text.as_bytes(), 1).unwrap();
/// assert_eq!((golden.states[0].line, golden.states[0].tau[0], golden.tolerance), (3, 4.9, 1e-9));
///
/// let report = rne_model::GoldenFile::read("rod.golden.csv", b"q1,qd1,qdd1,tau1\n0,0,O,4.9\n", 1).unwrap_err();
/// assert_eq!(report.short(), "rod.golden.csv:2:5: error: `O` of qdd1 is not a number");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GoldenFile {
    /// By which part of the largest torque of the file torques may differ.
    pub tolerance: f64,
    /// The states, in the order of the file; there is at least one.
    pub states: Vec<GoldenState>,
}

/// A line of a [`GoldenFile`]; each array has an element per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct GoldenState {
    /// The number of the line, from 1.
    pub line: usize,
    /// Positions, rad or m.
    pub q: Vec<f64>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<f64>,
    /// Accelerations, rad/s² or m/s².
    pub qdd: Vec<f64>,
    /// Torques, N m or N.
    pub tau: Vec<f64>,
}

impl GoldenFile {
    /// Returns the names of the columns for a number of joints.
    #[must_use]
    pub fn header(joints: usize) -> Vec<String> {
        let columns = |name: &'static str| (1..=joints).map(move |joint| format!("{name}{joint}"));
        ["q", "qd", "qdd", "tau"].into_iter().flat_map(columns).collect()
    }

    /// Reads the golden file of a robot with a number of joints; `name` is the file's name in messages.
    ///
    /// # Errors
    /// Everything that is wrong, with line and column: bytes that are no text, another header, another number of
    /// columns, a cell that is no finite number, a tolerance that is not above 0, a file without states.
    pub fn read(name: &str, bytes: &[u8], joints: usize) -> Result<Self, Report> {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let problems = Problems::new();
        let text = match std::str::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                not_utf8(bytes, error, "a golden file", &problems);
                return Err(problems.finish(name, &String::from_utf8_lossy(bytes)));
            }
        };
        let golden = read(text, joints, &problems);
        let report = problems.finish(name, text);
        match golden {
            Some(golden) if !report.has_errors() => Ok(golden),
            _ => Err(report),
        }
    }
}

fn read(text: &str, joints: usize, problems: &Problems) -> Option<GoldenFile> {
    let names = GoldenFile::header(joints);
    let (mut tolerance, mut states, mut has_header) = (TOLERANCE, Vec::new(), false);
    let mut start = 0;
    for (index, line) in text.split('\n').enumerate() {
        let (data, comment) = line.split_once('#').unwrap_or((line, ""));
        let place = start + data.len() + 1;
        if let Some(value) = comment.trim_start().strip_prefix(TOLERANCE_KEY) {
            let at = place + comment.len() - value.len();
            tolerance = tolerance_of(value, at, problems).unwrap_or(tolerance);
        } else if is_nearly_a_tolerance(comment) {
            let from = place + comment.len() - comment.trim_start().len();
            let message = format!("{} sets no tolerance", quoted(comment.trim()));
            let help = "write `# tolerance: 1e-6`";
            problems.push(Diagnostic::error(from..from + comment.trim().len(), message).help(help));
        }
        if !data.trim().is_empty() {
            let cells = cells(data, start);
            if !has_header {
                has_header = true;
                // below another header every number would have another meaning, so reading stops
                is_header(&cells, &names, problems).then_some(())?;
            } else if let Some(numbers) = numbers(&cells, &names, problems) {
                let list = |index: usize| numbers[index * joints..(index + 1) * joints].to_vec();
                states.push(GoldenState { line: index + 1, q: list(0), qd: list(1), qdd: list(2), tau: list(3) });
            }
        }
        start += line.len() + 1;
    }
    if states.is_empty() && !problems.has_errors() {
        let message = if has_header { "there is no state below the header" } else { "there is no header" };
        let help = format!("the header is `{}`; each line below it is a state", names.join(","));
        problems.push(Diagnostic::error(text.len()..text.len(), message).help(help));
    }
    Some(GoldenFile { tolerance, states })
}

/// Splits a line into cells without surrounding blanks, with the place of each cell in the text.
fn cells(data: &str, start: usize) -> Vec<(&str, Range<usize>)> {
    let mut at = start;
    let cell = |cell: &'_ str| {
        let from = at + cell.len() - cell.trim_start().len();
        at += cell.len() + 1;
        from
    };
    let starts: Vec<usize> = data.split(',').map(cell).collect();
    let cells = data.split(',').zip(starts).map(|(cell, from)| (cell.trim(), from..from + cell.trim().len()));
    cells.collect()
}

fn is_header(cells: &[(&str, Range<usize>)], names: &[String], problems: &Problems) -> bool {
    let help = format!("the columns of {} joints are `{}`", names.len() / 4, names.join(","));
    for (index, (cell, place)) in cells.iter().enumerate() {
        let message = match names.get(index) {
            Some(name) if cell == name => continue,
            Some(name) => format!("column {} is {}, but must be `{name}`", index + 1, quoted(cell)),
            None => format!("{} columns are too many; {} joints need {}", cells.len(), names.len() / 4, names.len()),
        };
        problems.push(Diagnostic::error(place.clone(), message).help(help));
        return false;
    }
    if cells.len() < names.len() {
        let end = cells.last().map_or(0..0, |(_, place)| place.clone());
        let message = format!("{} columns are too few; {} joints need {}", cells.len(), names.len() / 4, names.len());
        problems.push(Diagnostic::error(end, message).help(help));
    }
    cells.len() == names.len()
}

fn numbers(cells: &[(&str, Range<usize>)], names: &[String], problems: &Problems) -> Option<Vec<f64>> {
    if cells.len() != names.len() {
        // points at the first surplus cell, or at the last cell of a line that is too short
        let place = cells.get(names.len()).or(cells.last()).map_or(0..0, |(_, place)| place.clone());
        let columns = if cells.len() == 1 { "column" } else { "columns" };
        let message = format!("the line has {} {columns}, but the header has {}", cells.len(), names.len());
        problems.push(
            Diagnostic::error(place, message).help("write one number per column, with commas between the numbers"),
        );
        return None;
    }
    let number = |((cell, place), name): (&(&str, Range<usize>), &String)| {
        let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
        if value.is_none() {
            let message = if cell.is_empty() {
                format!("the number of {name} is missing")
            } else {
                format!("{} of {name} is not a number", quoted(cell))
            };
            problems.push(
                Diagnostic::error(place.clone(), message).help("write a finite decimal number, such as -1.5 or 2e-3"),
            );
        }
        value
    };
    // collected before any return, so that every mistake of the line is reported
    let values: Vec<Option<f64>> = cells.iter().zip(names).map(number).collect();
    values.into_iter().collect()
}

/// Returns whether a comment begins with the word for the tolerance, or a misspelling of it, followed by a number.
fn is_nearly_a_tolerance(comment: &str) -> bool {
    let mut words = comment.trim_start().split([':', '=', ' ']).filter(|word| !word.is_empty());
    let word = words.next().unwrap_or_default().to_lowercase();
    let is_meant = did_you_mean(&word, ["tolerance"]).is_some() || word == "tolerance";
    is_meant && words.next().is_some_and(|value| value.starts_with(|c: char| c.is_ascii_digit() || c == '.'))
}

fn tolerance_of(value: &str, at: usize, problems: &Problems) -> Option<f64> {
    let trimmed = value.trim();
    let from = at + value.len() - value.trim_start().len();
    let tolerance = trimmed.parse::<f64>().ok().filter(|tolerance| tolerance.is_finite() && *tolerance > 0.0);
    if tolerance.is_none() {
        let message = format!("{} is not a tolerance", quoted(trimmed));
        let help = "write a fraction of the largest torque, above 0: `# tolerance: 1e-6`";
        problems.push(Diagnostic::error(from..from + trimmed.len(), message).help(help));
    }
    tolerance
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> String {
        let report = GoldenFile::read("arm.golden.csv", text.as_bytes(), 2).expect_err("a mistake");
        report.short()
    }

    const HEADER: &str = "q1,q2,qd1,qd2,qdd1,qdd2,tau1,tau2\n";

    #[test]
    fn a_table_is_read() {
        let text =
            format!("# rig\r\n\n#tolerance: 1e-6\n{HEADER}1, 2,3,4,5,6, -7e-1 ,8\r\n\n# x\n0,0,0,0,0,0,0,.5 # y\n");
        let golden = GoldenFile::read("arm.golden.csv", text.as_bytes(), 2).unwrap_or_else(|why| panic!("{why}"));
        assert_eq!(golden.tolerance, 1e-6);
        let [first, second] = golden.states.as_slice() else { panic!("two states") };
        assert_eq!((first.line, second.line), (5, 8));
        assert_eq!((&first.q[..], &first.qd[..]), (&[1.0, 2.0][..], &[3.0, 4.0][..]));
        assert_eq!((&first.qdd[..], &first.tau[..]), (&[5.0, 6.0][..], &[-0.7, 8.0][..]));
        assert_eq!(second.tau, [0.0, 0.5]);
        assert_eq!(GoldenFile::header(2).join(",") + "\n", HEADER);
    }

    #[test]
    fn mistakes_have_a_place() {
        let state = |line: &str| said(&format!("# é\n{HEADER}{line}\n"));
        for (found, expected) in [
            (said(&format!("# tolerence: 1e-1\n{HEADER}")), "1:3: error: `tolerence: 1e-1` sets no tolerance"),
            (said(&format!("# Tolerance = 1e-1\n{HEADER}")), "1:3: error: `Tolerance = 1e-1` sets no tolerance"),
            (state("1;2;3;4;5;6;7;8"), "3:1: error: the line has 1 column, but the header has 8"),
            (state("1,2,3,4,5,6,7"), "3:13: error: the line has 7 columns, but the header has 8"),
            (state("1,2,3,4,5,6,7,8, 9"), "3:18: error: the line has 9 columns, but the header has 8"),
            (state("1,2,3,4,5,6,7,8x"), "3:15: error: `8x` of tau2 is not a number"),
            (state("1,,3,4,5,6,7,8"), "3:3: error: the number of q2 is missing"),
            (state("1,2,3,4,inf,6,7,8"), "3:9: error: `inf` of qdd1 is not a number"),
            (state("# none"), "4:1: error: there is no state below the header"),
            (said(""), "1:1: error: there is no header"),
            (said("1,2,3,4,5,6,7,8\n"), "1:1: error: column 1 is `1`, but must be `q1`"),
            (said("q1,q2,qd1,qd2\n"), "1:11: error: 4 columns are too few; 2 joints need 8"),
            (said(&HEADER.replace('\n', ",q3\n")), "1:35: error: 9 columns are too many; 2 joints need 8"),
            (said(&HEADER.replace("tau1", "t1")), "1:25: error: column 7 is `t1`, but must be `tau1`"),
            (said(&format!("#  tolerance: none\n{HEADER}")), "1:15: error: `none` is not a tolerance"),
            (said(&format!("{HEADER}# tolerance: 0\n")), "2:14: error: `0` is not a tolerance"),
        ] {
            assert_eq!(found, format!("arm.golden.csv:{expected}"));
        }
        // two mistakes in one line are both reported
        assert_eq!(state("a,b,3,4,5,6,7,8").lines().count(), 2);
        let report = GoldenFile::read("arm.golden.csv", b"q1\xFF", 2).expect_err("no text");
        assert!(
            report.short().contains("arm.golden.csv:1:3: error: byte 0xFF is not UTF-8; a golden file is"),
            "{report}"
        );
    }
}
