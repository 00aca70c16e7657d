//! Reads the values of a worksheet from the cells of its rows.

use std::collections::HashMap;
use std::ops::Range;

use rne_diagnose::worksheet::{Axes, GivenValue, Quantity};
use rne_model::{Robot, did_you_mean};

use crate::files::csv_table::{Cell, Mistakes, quoted, with_point};
use crate::files::worksheet_file::{Cells, Filled, SheetRow};
use crate::outcome::Failure;

/// Turns the rows of a worksheet into values.
pub(super) struct Reading<'a> {
    pub(super) robot: &'a Robot,
    pub(super) mistakes: Mistakes<'a>,
    pub(super) axes: Option<Axes>,
    /// For each component that was given: its joint, quantity and index, with the byte at which it was given.
    pub(super) seen: HashMap<(usize, Quantity, usize), usize>,
    pub(super) values: Vec<GivenValue>,
    pub(super) text: &'a str,
}

impl Reading<'_> {
    pub(super) fn rows(mut self, rows: &[SheetRow<'_>]) -> Result<Filled, Failure> {
        for (cells, span) in rows {
            self.row(cells, span);
        }
        if self.values.is_empty() && !self.mistakes.are_there() {
            let help = "each row has a joint, a quantity, its component and a value; empty values are left out";
            self.mistakes.push(0..0, "the worksheet has no value to compare", Some(help));
        }
        let filled = Filled { values: self.values, axes: self.axes, ..Filled::default() };
        self.mistakes.finish(filled)
    }

    fn row(&mut self, cells: &Cells<'_>, span: &Range<usize>) {
        let cell = |column: &str| cells.get(column).filter(|cell| !cell.text.is_empty());
        // an empty cell: the student has not filled it in
        let Some(value_cell) = cell("value") else { return };
        let (Some(joint), Some(quantity)) = (self.joint(cell("joint"), span), self.quantity(cell("quantity"), span))
        else {
            return;
        };
        let kind = self.robot.joints[joint - 1].row.kind;
        if let Some(step) = cell("step").filter(|step| step.text.trim() != quantity.step().to_string()) {
            let message =
                format!("{quantity} is computed by step {}, not by step {}", quantity.step(), quoted(&step.text));
            self.mistakes.push(step.span.clone(), message, None);
        }
        let unit = quantity.unit(kind);
        if let Some(found) = cell("unit").filter(|found| plain_unit(&found.text) != plain_unit(unit)) {
            let unit = if unit == "1" { "a plain number, without a unit".to_owned() } else { format!("in {unit}") };
            let message = format!("{quantity} of joint {joint} is {unit}, not in {}", quoted(&found.text));
            let help = found.text.contains(['°', 'd']).then_some("degrees can be written as deg(30)");
            self.mistakes.push(found.span.clone(), message, help);
        }
        self.frame(quantity, cell("frame"));
        let Some(component) = self.component(quantity, cell("component"), span) else { return };
        let Some(value) = self.value(value_cell) else { return };
        let first = *self.seen.entry((joint, quantity, component)).or_insert(span.start);
        if first != span.start {
            let first = 1 + self.text.get(..first).unwrap_or_default().matches('\n').count();
            let name = quantity.components()[component];
            let message = format!("{quantity} {name} of joint {joint} is given twice; first on line {first}");
            self.mistakes.push(span.clone(), message.replace("  ", " "), Some("keep one of them"));
            return;
        }
        let text = with_point(&value_cell.text);
        let resolution = if text.contains('.') { rne_model::half_of_last_digit(&text) } else { 0.0 };
        self.values.push(GivenValue { joint, quantity, component, value, resolution });
    }

    fn joint(&mut self, cell: Option<&Cell<'_>>, span: &Range<usize>) -> Option<usize> {
        let dof = self.robot.dof();
        let Some(cell) = cell else {
            self.mistakes.push(span.clone(), "there is a value without a joint", None);
            return None;
        };
        let names: Vec<&str> = self.robot.joints.iter().map(|joint| joint.name.as_str()).collect();
        if let Some(index) = names.iter().position(|name| *name == cell.text) {
            return Some(index + 1);
        }
        let number = cell.text.parse::<usize>().ok();
        if let Some(joint) = number.filter(|joint| (1..=dof).contains(joint)) {
            return Some(joint);
        }
        let near = did_you_mean(&cell.text, names).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        let message = format!("{} is not a joint of {}{near}", quoted(&cell.text), self.robot.name);
        let help = format!("joints have the numbers 1 to {dof}, or their names");
        self.mistakes.push(cell.span.clone(), message, Some(&help));
        None
    }

    fn quantity(&mut self, cell: Option<&Cell<'_>>, span: &Range<usize>) -> Option<Quantity> {
        let Some(cell) = cell else {
            self.mistakes.push(span.clone(), "there is a value without a quantity", None);
            return None;
        };
        match cell.text.parse::<Quantity>() {
            Ok(quantity) => Some(quantity),
            Err(error) => {
                let message = format!("{}: {error}", quoted(&cell.text));
                let help = format!("the quantities are {}", Quantity::ALL.map(Quantity::name).join(", "));
                self.mistakes.push(cell.span.clone(), message, Some(&help));
                None
            }
        }
    }

    fn frame(&mut self, quantity: Quantity, cell: Option<&Cell<'_>>) {
        let Some(cell) = cell else { return };
        let axes = Axes::of_name(&cell.text);
        match (axes, self.axes) {
            (None, _) => {
                let message = format!("{} is not a name of axes", quoted(&cell.text));
                self.mistakes.push(
                    cell.span.clone(),
                    message,
                    Some("the axes are `link`, `joint` (or `lecture`) and `base`"),
                );
            }
            _ if !quantity.has_axes() => {}
            (Some(found), Some(asked)) if found != asked => {
                let message =
                    format!("this value is in {} axes, but the comparison is in {} axes", found.name(), asked.name());
                let help = format!(
                    "use the same axes for the whole file; for the axes of this value, add --axes {}",
                    found.name()
                );
                self.mistakes.push(cell.span.clone(), message, Some(&help));
            }
            (Some(found), _) => self.axes = Some(found),
        }
    }

    fn component(&mut self, quantity: Quantity, cell: Option<&Cell<'_>>, span: &Range<usize>) -> Option<usize> {
        let names = quantity.components();
        let word = cell.map_or(String::new(), |cell| cell.text.to_lowercase());
        // both off-diagonal elements of a symmetric matrix mean the same component
        let word = match (word.as_str(), names.len()) {
            ("yx", 6) => "xy",
            ("zx", 6) => "xz",
            ("zy", 6) => "yz",
            (word, _) => word,
        };
        let found = names.iter().position(|name| *name == word);
        if found.is_none() {
            let span = cell.map_or_else(|| span.clone(), |cell| cell.span.clone());
            let message = match cell {
                Some(cell) => format!("{quantity} has no component {}", quoted(&cell.text)),
                None => format!("the component of {quantity} is missing"),
            };
            let help = match names {
                [_] => format!("{quantity} is one number: leave the component empty"),
                names => format!("its components are {}", names.join(", ")),
            };
            self.mistakes.push(span, message, Some(&help));
        }
        let on_axes = !matches!(quantity, Quantity::Orientation | Quantity::Axis | Quantity::Rotation);
        let exists = on_axes || (quantity == Quantity::Rotation) != (self.axes == Some(Axes::Base));
        if !exists {
            let help = "`rotation` occurs in link and joint axes, `orientation` and `axis` in base axes";
            let message = format!("a worksheet in {} axes has no {quantity}", self.axes.unwrap_or(Axes::Link).name());
            self.mistakes.push(span.clone(), message, Some(help));
            return None;
        }
        found
    }

    fn value(&mut self, cell: &Cell<'_>) -> Option<f64> {
        match rne_model::number(&with_point(&cell.text)) {
            Ok(value) => Some(value),
            Err(mistake) => {
                let help = mistake.help.as_deref().unwrap_or("write a number, such as -0.25, 1.2e-3 or pi/2");
                let message = format!("the value {} is not a number: {}", quoted(&cell.text), mistake.message);
                self.mistakes.push(cell.span.clone(), message, Some(help));
                None
            }
        }
    }
}

/// Writes a unit in one spelling: `kg m²` and `kg*m^2` become the same.
fn plain_unit(unit: &str) -> String {
    let unit = unit.replace('²', "2").replace("**", "");
    let unit: String = unit.chars().filter(|c| !c.is_whitespace() && !"*·^.".contains(*c)).collect();
    match unit.as_str() {
        "" | "-" | "1" => "1".to_owned(),
        "m/s/s" => "m/s2".to_owned(),
        "rad/s/s" => "rad/s2".to_owned(),
        _ => unit,
    }
}
