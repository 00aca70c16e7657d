//! Writes the inspection as text: four lines for each component of each step.

use std::fmt::Write as _;

use rne_inspection::{Became, Cell, Component, Inspection, Operations};

use crate::palette::{FORMULA, FOUND, QUIET, Style, TITLE};
use crate::render::layout::{PAGE, wrap};
use crate::render::letters::Letters;
use crate::terminal;

/// The beginnings of the four lines of a component.
const LABELS: [&str; 4] = ["general   ", "here      ", "gone      ", "code      "];

/// An inspection, and the letters in which it is written.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) inspection: &'a Inspection,
    pub(crate) letters: Letters,
}

impl View<'_> {
    /// Wraps a text; its first line begins with `first`, further lines begin with `others`.
    fn fill(self, text: &str, first: &str, others: &str) -> String {
        wrap(&self.letters.of(&format!("{first}{text}")), terminal::width(PAGE), others)
    }
}

/// Writes the steps that the command line asks for, with all components of each.
pub(crate) fn text(view: View<'_>, joint: Option<usize>, step: Option<usize>) -> String {
    let is_wanted =
        |cell: &&Cell| joint.is_none_or(|joint| joint == cell.joint) && step.is_none_or(|step| step == cell.step);
    let cells: Vec<String> = view.inspection.cells.iter().filter(is_wanted).map(|cell| of_cell(view, cell)).collect();
    if cells.is_empty() {
        return format!(
            "{QUIET}{} has no equations there; only torques keep to the steps{QUIET:#}\n",
            view.inspection.function
        );
    }
    cells.join("\n")
}

/// Explains a name: a component by its four lines, any other name by its meaning and the terms that use it.
pub(crate) fn of_name(view: View<'_>, name: &str) -> Option<String> {
    let (known, quantity) = view.inspection.meaning(name)?;
    let place = match quantity.step {
        Some(step) => format!("joint {}, step {step}\n\n", known.joint),
        None => String::new(),
    };
    let equations = view.inspection.component(name).map(|component| of_component(view, component));
    let mut text = equations.unwrap_or_else(|| of_other(view, name));
    let users = view.inspection.statements.iter().filter(|statement| statement.value.names().contains(&name));
    let turned = view.inspection.sines_and_cosines.iter().filter(|turn| turn.angle.names().contains(&name));
    let turned = turned.flat_map(|turn| turn.sine.iter().chain(&turn.cosine)).map(String::as_str);
    let users: Vec<&str> = turned.chain(users.map(|statement| statement.name.as_str())).collect();
    if !users.is_empty() {
        let users = users.join(", ");
        let _ = writeln!(text, "{}", styled(QUIET, &view.fill(&users, "    used by   ", "              ")));
    }
    Some(place + &text)
}

/// Explains a shared term, a number, an argument, or a name of a form that has no equations.
fn of_other(view: View<'_>, name: &str) -> String {
    let stated =
        view.inspection.angles.iter().chain(&view.inspection.statements).find(|statement| statement.name == name);
    let mut text = opening(view, name);
    if let Some(owner) = stated.and_then(|statement| statement.component.as_ref()) {
        let _ = writeln!(text, "    part of   {owner}");
    }
    if let Some((_, value)) = view.inspection.constants.iter().find(|(constant, _)| constant == name) {
        let _ = writeln!(text, "    number    {value}");
    }
    if let Some(statement) = stated {
        let code = statement.rust.split_whitespace().collect::<Vec<_>>().join(" ");
        let code = view.fill(&code, &format!("    {}", LABELS[3]), "                  ");
        let _ = writeln!(text, "{}", styled(FOUND, &code));
    }
    text
}

fn of_cell(view: View<'_>, cell: &Cell) -> String {
    let Cell { joint, step, title, before, after, .. } = cell;
    let body =
        if *joint > view.inspection.robot.joints.len() { "payload".to_owned() } else { format!("joint {joint}") };
    let mut text = format!("{TITLE}{body}, step {step}: {title}{TITLE:#}\n");
    for formula in &cell.formulas {
        let _ = writeln!(text, "{}", styled(FORMULA, &view.fill(&formula.text, "  ", "      ")));
    }
    if *before != Operations::default() {
        let counts = format!(
            "{} products and {} sums, {} and {} left",
            before.products, before.sums, after.products, after.sums
        );
        let _ = writeln!(text, "{}", styled(QUIET, &view.fill(&counts, "  ", "  ")));
    }
    for component in &cell.components {
        text.push('\n');
        text.push_str(&of_component(view, component));
    }
    text
}

fn of_component(view: View<'_>, component: &Component) -> String {
    let name = &component.name;
    let mut text = opening(view, name);
    let mut line = |label: &str, of: &str| {
        let _ = writeln!(text, "{}", view.fill(of, &format!("    {label}"), "                "));
    };
    line(LABELS[0], &format!("{name} = {}", component.general));
    line(LABELS[1], &format!("{name} = {}", component.with_numbers));
    for (index, folded) in component.folded.iter().enumerate() {
        let label = if index == 0 { LABELS[2] } else { "          " };
        line(label, &format!("{} = {}: {}", folded.term, folded.left, folded.why));
    }
    let code = code(view, component);
    for (index, code) in code.iter().enumerate() {
        let label = if index == 0 { LABELS[3] } else { "          " };
        let _ = writeln!(text, "{}", styled(FOUND, &view.fill(code, &format!("    {label}"), "                  ")));
    }
    text
}

/// Writes a name and its meaning.
fn opening(view: View<'_>, name: &str) -> String {
    let all = view.fill(&format!("{name}   {}", about(view, name)), "  ", "      ");
    let words = all.trim_start().strip_prefix(name).unwrap_or_default();
    format!("  {TITLE}{name}{TITLE:#}{}\n", styled(QUIET, words))
}

/// Describes the meaning of a name, with its unit and its axes.
fn about(view: View<'_>, name: &str) -> String {
    let meaning = view.inspection.meaning(name).map_or("", |(_, quantity)| quantity.meaning);
    let unit = view.inspection.unit(name);
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let frame = view.inspection.frame(name).map_or(String::new(), |frame| format!(", axes of frame {frame}"));
    format!("{meaning}{unit}{frame}")
}

/// Returns the statements that compute a component, or a line on what has replaced it.
fn code(view: View<'_>, component: &Component) -> Vec<String> {
    let rust = |name: &String| {
        let statement = view.inspection.statements.iter().find(|statement| statement.name == *name);
        statement.map(|statement| statement.rust.split_whitespace().collect::<Vec<_>>().join(" "))
    };
    let mut lines: Vec<String> = component.statements.iter().filter_map(rust).collect();
    match &component.became {
        Became::Computed => {}
        Became::Same { name } => lines.push(format!("none: it is {name}")),
        Became::Constant { value, why } => lines.push(format!("none: it is {value}, {why}")),
        Became::Inside => {
            let users = component.used_by.join(", ");
            let users = if users.is_empty() { "another statement" } else { &users };
            lines.push(format!("no statement of its own; it is part of {users}"));
        }
        Became::Unused => lines.push(format!("none: {} does not need it", view.inspection.function)),
    }
    lines
}

/// Applies a style to each line of a text.
fn styled(style: Style, text: &str) -> String {
    text.lines().map(|line| format!("{style}{line}{style:#}")).collect::<Vec<_>>().join("\n")
}
