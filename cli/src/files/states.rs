//! Computes a function over a file of states: it is read in parts, computed in parallel by compiled code, and written
//! meanwhile.

use std::io::{self, ErrorKind, IsTerminal as _};
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use rne::DynArm;
use rne_codegen::{Answer, Function, Layout};
use rne_logs::Heading;
use rne_machine::{Arguments, Array, CompiledArm, CompiledFunction, Destination, EvaluationError, OutOfRange};

use crate::files::input_file::{is_standard_input, name};
use crate::files::output_file::is_standard_output;
use crate::files::state_results::{self, Results};
use crate::files::state_table::{PART, Restricted, Table};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, QUIET};
use crate::values::closure;
use crate::values::limits::Degrees;

/// A file of states, and the place for its results.
pub(crate) struct Job<'a> {
    pub(crate) robot_file: &'a Path,
    pub(crate) arm: &'a CompiledArm,
    pub(crate) function: Function,
    pub(crate) states: &'a Path,
    /// The output file; `None` means standard output.
    pub(crate) out: Option<&'a Path>,
    pub(crate) force: bool,
}

/// Returns the columns of a table of states: the elements of the function's arguments.
fn columns(compiled: &CompiledFunction, arm: &CompiledArm) -> Vec<String> {
    let axes = ["x", "y", "z"];
    let payload = ["m", "cx", "cy", "cz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"];
    let headings = |&(name, elements): &(&str, usize)| -> Vec<String> {
        match name {
            "payload" => payload.map(str::to_owned).into(),
            "parameters" => arm.robot().run_time.names.clone(),
            // named like the options of `rne eval`
            "twist" => ["base_velocity", "base_omega"]
                .iter()
                .flat_map(|part| axes.map(|axis| format!("{part}_{axis}")))
                .collect(),
            "pose" => {
                let rotation = axes.iter().flat_map(|row| axes.map(|column| format!("pose_{row}{column}")));
                rotation.chain(axes.map(|axis| format!("pose_{axis}"))).collect()
            }
            "wrenches" => {
                let parts = ["fx", "fy", "fz", "nx", "ny", "nz"];
                let tips = arm.robot().tip_names().into_iter();
                tips.flat_map(|tip| parts.map(|part| format!("{tip}_{part}"))).collect()
            }
            "base_rotation" => {
                axes.into_iter().flat_map(|row| axes.map(|column| format!("{name}_{row}{column}"))).collect()
            }
            // named like the options of `rne eval`
            "omega" => axes.map(|axis| format!("base_omega_{axis}")).into(),
            "step" => vec!["duration".to_owned()],
            "q" | "passive" | "qd" | "qdd" | "tau" | "multipliers" | "sin" | "cos" => {
                (1..=elements).map(|joint| format!("{name}{joint}")).collect()
            }
            _ => axes.map(|axis| format!("{name}_{axis}")).into(),
        }
    };
    compiled.arguments().iter().flat_map(headings).collect()
}

/// Returns other names of these columns. Elements of joints may have the names that `rne log` writes, with the joint
/// names of the robot; the duration of a step and the velocity of a base may have their names in generated code.
fn named_columns(compiled: &CompiledFunction, arm: &CompiledArm) -> Vec<Option<String>> {
    let joints: Vec<String> = arm.robot().independent_joints().map(|joint| joint.name.clone()).collect();
    let headings = |&(name, elements): &(&str, usize)| -> Vec<Option<String>> {
        match Heading::quantity(name).filter(|_| elements == joints.len()) {
            Some(quantity) => Heading::of(&joints).columns(quantity).into_iter().map(Some).collect(),
            None if name == "step" => vec![Some(name.to_owned())],
            None if name == "omega" => ["x", "y", "z"].map(|axis| Some(format!("{name}_{axis}"))).into(),
            None => vec![None; if name == "parameters" { arm.robot().run_time.names.len() } else { elements }],
        }
    };
    compiled.arguments().iter().flat_map(headings).collect()
}

/// Returns the arguments whose numbers are restricted in range, each with the index of its first column.
fn restricted(compiled: &CompiledFunction) -> Restricted {
    let mut at = 0;
    let places = compiled.arguments().iter().map(|&(name, elements)| {
        at += elements;
        (name, at - elements)
    });
    Restricted(places.filter(|(name, _)| OutOfRange::elements(name) > 0).collect())
}

/// Returns the columns of the results: torques and accelerations by their symbols, others by the name of the function
/// and their indices from 1; elements of a matrix by row and column.
fn results(function: Function, arm: &CompiledArm) -> Vec<String> {
    let symbol = match function {
        _ if function.returns_accelerations() => Some("qdd"),
        _ if *function.answer() == Answer::Torques => Some("tau"),
        _ => None,
    };
    if let Some(symbol) = symbol {
        return (1..=arm.dof()).map(|joint| format!("{symbol}{joint}")).collect();
    }
    let mut names = Vec::new();
    places(&arm.layout(function), function.name().to_owned(), &mut names);
    names
}

fn places(layout: &Layout, name: String, names: &mut Vec<String>) {
    match layout {
        Layout::Number => names.push(name),
        Layout::Array(length, of) => (1..=*length).for_each(|index| places(of, format!("{name}_{index}"), names)),
        Layout::Record(record, parts) => {
            record.fields().iter().zip(parts).for_each(|(field, of)| places(of, format!("{name}_{field}"), names));
        }
    }
}

impl Job<'_> {
    pub(crate) fn run(&self) -> Result<Outcome, Failure> {
        let compiled = self.arm.function(self.function).map_err(Failure::input)?;
        let columns = columns(compiled, self.arm);
        let mut table = Table::open(self.states, &columns, &named_columns(compiled, self.arm), restricted(compiled))?;
        let outputs = results(self.function, self.arm);
        let read = [self.robot_file, self.states];
        let mut results = Results::open(self.out.filter(|out| !is_standard_output(out)), &read, self.force, &outputs)?;
        let progress = progress(self.states, table.states, results.is_terminal());
        let start = Instant::now();
        let (mut states, mut remarks) = (0_usize, Remarks::default());
        // positions come first, followed by those of dependent joints
        let of = |place: usize, of: &str| {
            compiled.arguments().get(place).map_or(0, |&(name, elements)| if name == of { elements } else { 0 })
        };
        let positions = (of(0, "q"), of(1, "passive"));
        let (mut rows, mut numbers) = (Vec::with_capacity(PART * columns.len()), vec![0.0; PART * outputs.len()]);
        loop {
            rows.clear();
            let count = table.read(&mut rows)?;
            if count == 0 {
                break;
            }
            remarks.see(self.arm, states, columns.len(), &rows, positions);
            let mut at = 0;
            let mut arguments = Arguments::new();
            for &(name, elements) in compiled.arguments() {
                let argument = Array::Strided { numbers: &rows[at..], state: columns.len(), element: 1 };
                arguments = arguments.with(name, argument).unwrap_or(arguments);
                at += elements;
            }
            let room = &mut numbers[..count * outputs.len()];
            let wrong = |error| match error {
                // `state` is counted within this part, so the states before it are added
                EvaluationError::OutOfRange { mistake, state, .. } => {
                    input_error!("{}: state {}: {mistake}", name(self.states), states + state)
                }
                error => Failure::input(error),
            };
            self.arm.run(self.function, count, &arguments, Destination::Rows(room)).map_err(wrong)?;
            remarks.results.see(states, room.chunks(outputs.len().max(1)), is_not_finite);
            match results.write(room) {
                // the reader of a pipe has read enough, which is no error
                Err(error) if error.kind() == ErrorKind::BrokenPipe => return Ok(Outcome::default()),
                written => written.map_err(|error| state_results::stopped(&error))?,
            }
            states += count;
            progress.inc(count as u64);
        }
        progress.finish_and_clear();
        match results.finish() {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => return Ok(Outcome::default()),
            written => written.map_err(|error| state_results::stopped(&error))?,
        }
        Ok(Outcome::remark(self.account(states, start.elapsed()) + &remarks.text()))
    }

    /// Returns a line on how many states were computed, and how fast.
    fn account(&self, states: usize, elapsed: Duration) -> String {
        #[allow(clippy::cast_precision_loss)] // of a rate, three digits are printed
        let rate = states as f64 / elapsed.as_secs_f64().max(1e-9);
        let rate = match states {
            0 => String::new(),
            _ => format!(" {QUIET}({rate:.2e} a second, reading and writing included){QUIET:#}"),
        };
        let noun = if states == 1 { "state" } else { "states" };
        let place = self
            .out
            .filter(|out| !is_standard_output(out))
            .map_or(String::new(), |out| format!("{GOOD}wrote{GOOD:#} {}: ", out.display()));
        format!("{place}{} of {states} {noun}{rate}\n", self.function)
    }
}

/// Counts states with a property that the user should know of.
#[derive(Default)]
struct Seen {
    count: usize,
    /// The number of the first such state, counted from 1; 0 without such a state.
    first: usize,
}

impl Seen {
    /// Counts states that have the property; they come after `before` other states.
    fn see<'a>(&mut self, before: usize, states: impl Iterator<Item = &'a [f64]>, is_so: impl Fn(&[f64]) -> bool) {
        for (index, numbers) in states.enumerate() {
            if is_so(numbers) {
                self.count += 1;
                self.first = if self.first == 0 { before + index + 1 } else { self.first };
            }
        }
    }

    /// Returns a note. Both arguments are the words before and after the state: for one such state, then for several.
    fn remark(&self, [of, is]: [&str; 2], [of_many, are]: [&str; 2]) -> String {
        match self {
            Self { count: 0, .. } => String::new(),
            Self { count: 1, first } => format!("note: {of} state {first} {is}\n"),
            Self { count, first } => format!("note: {of_many} {count} states {are}; the first is state {first}\n"),
        }
    }
}

fn is_not_finite(numbers: &[f64]) -> bool {
    !numbers.iter().all(|number| number.is_finite())
}

/// Largest residual of the equations of closed loops that is accepted, m: positions with six digits cause such
/// residuals.
const CLOSED: f64 = 1e-5;

/// Remarks on the states of a table.
#[derive(Default)]
struct Remarks {
    given: Seen,
    open: Seen,
    results: Seen,
    degrees: Degrees,
}

impl Remarks {
    /// Examines rows of arguments, whose first columns are positions, followed by those of dependent joints.
    fn see(&mut self, arm: &CompiledArm, before: usize, width: usize, rows: &[f64], (dof, passive): (usize, usize)) {
        self.given.see(before, rows.chunks(width), is_not_finite);
        rows.chunks(width).for_each(|row| self.degrees.see(arm.robot(), &row[..dof]));
        if passive > 0 {
            let definition = DynArm::from_robot(arm.robot());
            self.open.see(before, rows.chunks(width), |row| {
                closure::are_open(&definition, &row[..dof], &row[dof..dof + passive], CLOSED)
            });
        }
    }

    fn text(&self) -> String {
        let open = ["the loops of", "are not closed, so the numbers mean nothing"];
        [
            self.degrees.remark(|_| "convert the column to radians".to_owned()),
            self.given.remark(["an argument of", "is not finite"], ["arguments of", "are not finite"]),
            self.open.remark(open, open),
            self.results.remark(["the result of", "is not finite"], ["the results of", "are not finite"]),
        ]
        .concat()
    }
}

/// Makes a progress bar on a terminal, unless the results are shown there.
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
