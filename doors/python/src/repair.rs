//! Repairs of links that cannot exist, as data.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_convert::repair::{Candidate, Proposal, Test, bodies_of, line_and_column, proposals};
use serde::Serialize;

use crate::arrays::reply::dict_of;
use crate::errors::of_report;
use crate::load::Given;

/// A link that needs a repair.
#[derive(Serialize)]
struct Finding<'a> {
    link: &'a str,
    line: usize,
    column: usize,
    failed: Vec<&'static str>,
    equal: usize,
    candidates: Vec<Edit<'a>>,
}

/// A single edit.
#[derive(Serialize)]
struct Edit<'a> {
    name: &'static str,
    mistake: String,
    failed: Vec<&'static str>,
    complete: bool,
    changes: Vec<Change<'a>>,
}

/// The change of one element of the file.
#[derive(Serialize)]
struct Change<'a> {
    line: usize,
    column: usize,
    old: &'a str,
    new: String,
}

fn sentences(failed: &[Test]) -> Vec<&'static str> {
    failed.iter().map(|test| test.sentence()).collect()
}

/// Propose repairs of the links of a robot file, a URDF or an MJCF file that cannot exist, or that are improbable.
///
/// The file is read and not changed. Each proposal is one edit of the mass or the inertia of one link, such as another
/// sign, another power of ten, or another order of the elements; `rne check --repair` prints the same.
///
/// Parameters
/// ----------
/// source : str or os.PathLike
///     A path, a text, or the name of a built-in robot, as for `rne.load`.
///
/// Returns
/// -------
/// list of dict
///     One for each link with a finding: `link`, `line`, `column`, `failed` (sentences that say what is wrong),
///     `candidates` (best first) and `equal`, the number of candidates at the beginning that are equally good. One
///     means that the first is the repair. A candidate has `name`, `mistake`, `failed` (what it leaves), `complete` and
///     `changes`: the text `old` at `line` and `column` becomes `new`. It is not complete if the file lacks a number,
///     which `new` shows as a question mark. The list is empty if nothing needs a repair.
///
/// Raises
/// ------
/// RobotFileError
///     When the text is not a URDF, an MJCF file or YAML.
/// OSError
///     When the file cannot be read.
#[pyfunction]
pub(crate) fn repair<'py>(py: Python<'py>, source: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let (name, text) = Given::of(source)?.text()?;
    let text = text.trim_start_matches('\u{FEFF}');
    let bodies = py.detach(|| bodies_of(&name, text)).map_err(|report| of_report(py, &report))?;
    let found = py.detach(|| proposals(&bodies));
    let edit = |candidate: &Candidate| {
        let changes = candidate.diffs(text, &bodies).into_iter().map(|diff| {
            let [line, column] = line_and_column(text, diff.span.start);
            Change { line, column, old: text.get(diff.span).unwrap_or_default(), new: diff.new }
        });
        let (name, mistake, complete) = (candidate.edit.name, candidate.what.clone(), candidate.is_complete());
        Edit { name, mistake, failed: sentences(&candidate.failed), complete, changes: changes.collect() }
    };
    let finding = |proposal: &Proposal| {
        let [line, column] = proposal.place(text, &bodies);
        let (link, failed) = (bodies[proposal.body].name.as_str(), sentences(&proposal.failed));
        let candidates = proposal.candidates.iter().map(edit).collect();
        dict_of(py, &Finding { link, line, column, failed, equal: proposal.equal, candidates })
    };
    found.iter().map(finding).collect()
}
