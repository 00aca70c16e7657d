//! `rne eval --trace --compare`: compares a worksheet that somebody filled in with the right one, and finds the first
//! difference.

use std::fmt::Write as _;

use rne_diagnose::worksheet::{Comparison, Difference, Line, Quantity, Reach, Reason, Situation, Worksheet};
use rne_model::Robot;
use serde::Serialize;

use crate::files::worksheet_file::{Filled, steps_in_words};
use crate::outcome::{Failure, Outcome};
use crate::palette::{ERROR, FORMULA, FOUND, GOOD, QUIET, TITLE};
use crate::render::layout::{Align, PAGE, columns, left, wrap};
use crate::render::worksheet::{is_formula, matrix, triple};
use crate::terminal;
use crate::values::numbers::fixed;

/// How values are compared: the accepted error, and whether the answer is JSON for a program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manner {
    pub(crate) digits: u8,
    pub(crate) json: bool,
    /// Whether the right values stay hidden.
    pub(crate) hint: bool,
}

/// The answer in JSON.
#[derive(Serialize)]
struct Reply {
    agrees: bool,
    compared: usize,
    differing: usize,
    steps_not_given: Vec<u8>,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<First>,
}

#[derive(Serialize)]
struct First {
    joint: usize,
    step: u8,
    quantity: &'static str,
    component: &'static str,
    yours: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    right: Option<f64>,
    unit: &'static str,
    frame: &'static str,
    formula: String,
    reasons: Vec<Because>,
}

#[derive(Serialize)]
struct Because {
    says: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    right: Option<String>,
    explains: &'static str,
}

pub(crate) fn run(
    Filled { values, axes, .. }: &Filled,
    robot: &Robot,
    at: &Situation,
    manner: Manner,
) -> Result<Outcome, Failure> {
    let axes = axes.unwrap_or(rne_diagnose::worksheet::Axes::Link);
    let sheet = Worksheet::new(robot, at, axes).map_err(Failure::usage)?;
    let comparison = sheet.compare(robot, at, values, manner.digits).map_err(Failure::usage)?;
    let at_fault = comparison.first.is_some();
    if manner.json {
        return Ok(Outcome { at_fault, ..Outcome::json(&reply(&sheet, &comparison, manner.hint))? });
    }
    let text = match &comparison.first {
        None => agreement(robot, &comparison, manner.digits),
        Some(first) => difference(robot, &sheet, &comparison, first, manner.hint),
    };
    Ok(Outcome { text, at_fault, ..Outcome::default() })
}

fn reply(sheet: &Worksheet, comparison: &Comparison, hint: bool) -> Reply {
    let because = |reason: &Reason| Because {
        says: reason.says.clone(),
        right: reason.right.clone().filter(|_| !hint),
        explains: explains(reason.reach),
    };
    let first = comparison.first.as_ref().map(|first| {
        let line = &sheet.lines[first.line];
        First {
            joint: line.joint,
            step: line.quantity.step(),
            quantity: line.quantity.name(),
            component: line.quantity.components()[first.component],
            yours: first.theirs,
            right: Some(first.ours).filter(|_| !hint),
            unit: line.unit(),
            frame: if line.quantity.has_axes() { sheet.axes.name() } else { "" },
            formula: format!("{} = {}", line.symbol(), line.formula),
            reasons: first.reasons.iter().map(because).collect(),
        }
    });
    let Comparison { compared, differing, steps_not_given, .. } = comparison.clone();
    Reply { agrees: first.is_none(), compared, differing, steps_not_given, first }
}

const fn explains(reach: Reach) -> &'static str {
    match reach {
        Reach::Everything => "everything",
        Reach::Torques => "torques",
        Reach::Line => "line",
        Reach::UpToHere => "up to here",
        _ => "component",
    }
}

fn values(number: usize) -> String {
    if number == 1 { "1 value".to_owned() } else { format!("{number} values") }
}

fn not_given(comparison: &Comparison) -> String {
    steps_in_words(&comparison.steps_not_given).map_or_else(String::new, |steps| format!("; not given: {steps}"))
}

fn agreement(robot: &Robot, comparison: &Comparison, digits: u8) -> String {
    let text = format!(
        "ok {} of {} compared, all agree to {digits} digits{}",
        values(comparison.compared),
        robot.name,
        not_given(comparison)
    );
    let text = wrap(&text, terminal::width(PAGE), "   ");
    format!("{GOOD}ok{GOOD:#}{}\n", text.strip_prefix("ok").unwrap_or(&text))
}

fn difference(robot: &Robot, sheet: &Worksheet, comparison: &Comparison, first: &Difference, hint: bool) -> String {
    let line = &sheet.lines[first.line];
    let component = line.quantity.components()[first.component];
    let name = robot.joints.get(line.joint - 1).map_or("", |joint| &joint.name);
    let (symbol, what) = (line.symbol(), place(line));
    let of_component = if component.is_empty() { String::new() } else { format!(", component {component}") };
    let mut text = format!(
        "{ERROR}first difference{ERROR:#}: {TITLE}{what}, joint {} ({name}), {symbol}{of_component}{TITLE:#}\n\n",
        line.joint
    );
    let numbers = [first.theirs, first.ours, first.theirs - first.ours].map(fixed);
    let unit = if line.unit() == "1" { "" } else { line.unit() };
    let _ = if hint {
        writeln!(text, "  yours   {}  {QUIET}{unit}{QUIET:#}\n", numbers[0].trim_end())
    } else {
        writeln!(
            text,
            "  yours   {}\n  right   {}  {QUIET}{unit}{QUIET:#}\n  off by  {}\n",
            numbers[0].trim_end(),
            numbers[1].trim_end(),
            numbers[2].trim_end()
        )
    };
    let width = terminal::width(PAGE);
    let equals = if is_formula(line) { " =" } else { ":" };
    let formula = wrap(&format!("  {symbol}{equals} {}", line.formula), width, "    ");
    let _ = writeln!(text, "{FORMULA}{formula}{FORMULA:#}");
    if !hint {
        text.push_str(&inputs(line));
        text.push_str(&terms(line));
    }
    text.push('\n');
    let mut previous = None;
    for reason in &first.reasons {
        let says = wrap(&format!("{} {}", introduced(reason.reach, previous), reason.says), width, "  ");
        let _ = writeln!(text, "{says}");
        if let Some(right) = reason.right.as_ref().filter(|_| !hint) {
            let right = wrap(&format!("  right: {right}"), width, "         ");
            let _ = writeln!(text, "{FOUND}{right}{FOUND:#}");
        }
        previous = Some(reason.reach);
    }
    let is_state = matches!(line.quantity, Quantity::Q | Quantity::Qd | Quantity::Qdd);
    if is_state {
        let _ = writeln!(text, "your worksheet is for another state than the command line");
    } else if first.reasons.is_empty() {
        let check = if line.terms.len() > 1 { ": check each term" } else { "" };
        let _ = writeln!(text, "no usual mistake gives this value{check}");
    }
    let tally = format!(
        "{} compared, {} {}{}; compute again what depends on this value",
        values(comparison.compared),
        comparison.differing,
        if comparison.differing == 1 { "differs" } else { "differ" },
        not_given(comparison)
    );
    let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(&tally, width, ""));
    text
}

fn place(line: &Line) -> String {
    match line.quantity.step() {
        0 => "before the steps".to_owned(),
        step => format!("step {step}"),
    }
}

fn introduced(reach: Reach, previous: Option<Reach>) -> &'static str {
    match (reach, previous) {
        (_, Some(_)) => "or",
        (Reach::Everything, None) => "all your values are right except for this:",
        (Reach::Torques, None) => "this mistake gives your torques:",
        (Reach::UpToHere, None) => "up to here it could be this:",
        (_, None) => "it looks as if",
    }
}

/// Writes the numbers that a formula uses.
fn inputs(line: &Line) -> String {
    let mut text = String::new();
    let width = line.inputs.iter().map(|input| crate::render::layout::width(&input.symbol)).max().unwrap_or(0);
    for input in &line.inputs {
        let symbol = left(&input.symbol, width);
        let unit = if input.unit == "1" { String::new() } else { format!(" {QUIET}{}{QUIET:#}", input.unit) };
        let numbers = match (matrix(&input.values), input.values.as_slice()) {
            (Some(rows), _) => {
                let margin = " ".repeat(width + 7);
                rows.map(|row| triple(&row)).join(&format!("\n{margin}"))
            }
            (None, [one]) => fixed(*one).trim().to_owned(),
            (None, several) => triple(several),
        };
        let _ = writeln!(text, "    {symbol} = {numbers}{unit}");
    }
    text
}

/// Writes the terms of a formula, and their sum.
fn terms(line: &Line) -> String {
    if line.terms.len() < 2 {
        return String::new();
    }
    let names = if line.values.len() == 1 { &[""][..] } else { line.quantity.components() };
    let mut cells = vec![vec!["  its terms".to_owned()]];
    for name in names {
        cells[0].push((*name).to_owned());
    }
    for term in &line.terms {
        let numbers = term.values.iter().map(|value| fixed(*value).trim().to_owned());
        cells.push(std::iter::once(format!("    {}", term.text)).chain(numbers).collect());
    }
    let sum = line.values.iter().map(|value| fixed(*value).trim().to_owned());
    cells.push(std::iter::once(format!("  {}", line.symbol())).chain(sum).collect());
    let mut alignment = vec![Align::Left];
    alignment.extend(names.iter().map(|_| Align::Right));
    let lines = columns(&alignment, &cells);
    format!("{QUIET}{}{QUIET:#}\n{}\n", lines[0], lines[1..].join("\n"))
}
