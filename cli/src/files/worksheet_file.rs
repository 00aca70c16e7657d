//! Worksheets that are read: a row per joint, step, quantity and component, as CSV and as JSON.
//!
//! `rne eval --trace` and `rne worksheet` write them by [`worksheet_text`](super::worksheet_text); any part of one can
//! be read.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;
use std::path::Path;

use rne_diagnose::worksheet::{Axes, GivenValue, Quantity, Situation};
use rne_model::{Report, Robot, did_you_mean};
use serde_json::value::RawValue;

use crate::files::csv_table::{self, Cell, Mistakes, OPEN_QUOTE, quoted, text_of, with_point};
use crate::files::input_file;
use crate::files::worksheet_text::{COLUMNS, FORMAT};
use crate::outcome::Failure;

/// A worksheet of 64 joints has half a megabyte.
const LONGEST: usize = 4 << 20;

/// More rows than any worksheet has for a joint.
const MOST: usize = 200;

/// A worksheet that a student filled in.
#[derive(Debug, Default)]
pub(crate) struct Filled {
    pub(crate) values: Vec<GivenValue>,
    /// The axes that the file names.
    pub(crate) axes: Option<Axes>,
    /// The student whom the file names.
    pub(crate) student: Option<String>,
    /// The steps that the file asks for, where it names them.
    pub(crate) steps: Option<Vec<u8>>,
    /// The cells that the file asks for, joint and step, where it names them.
    pub(crate) cells: Option<Vec<(usize, u8)>>,
}

impl Filled {
    /// The values of q, q̇ or q̈, a number for each joint; `None` if one of them is not given.
    pub(crate) fn given(&self, quantity: Quantity, dof: usize) -> Option<Vec<f64>> {
        let of_joint = |joint| self.values.iter().find(|given| given.quantity == quantity && given.joint == joint);
        (1..=dof).map(|joint| of_joint(joint).map(|given| given.value)).collect()
    }

    /// Whether the worksheet gives this state.
    pub(crate) fn is_at(&self, at: &Situation) -> bool {
        [(Quantity::Q, &at.q), (Quantity::Qd, &at.qd), (Quantity::Qdd, &at.qdd)].into_iter().all(|(quantity, own)| {
            let given = self.given(quantity, own.len());
            given.is_some_and(|given| given.iter().zip(own).all(|(a, b)| (a - b).abs() <= 1e-9))
        })
    }
}

/// Contents of the first line of a worksheet.
#[derive(Default)]
struct Head {
    student: Option<String>,
    steps: Option<Vec<u8>>,
    cells: Option<Vec<(usize, u8)>>,
}

/// The cells of a row, by their columns.
type Cells<'a> = BTreeMap<&'static str, Cell<'a>>;

/// Reads a worksheet of a robot. `axes` are those asked for; without any, the file's count.
pub(crate) fn read(path: &Path, robot: &Robot, axes: Option<Axes>) -> Result<Filled, Failure> {
    let name = input_file::name(path);
    let bytes = input_file::read(path, LONGEST)
        .map_err(|error| Failure::input(format_args!("the worksheet {name} cannot be read: {error}")))?;
    if bytes.len() > LONGEST {
        return Err(Failure::input(format_args!("{name} has more than {LONGEST} bytes: is this a worksheet?")));
    }
    let decoded = text_of(&name, &bytes)?;
    let text = decoded.as_ref();
    let keys = ["convention:", "joints:", "format:"];
    if keys.iter().filter(|key| text.lines().any(|line| line.starts_with(**key))).count() > 1 {
        return Err(Failure::input(format_args!(
            "{name} is a robot file, not a worksheet; name the worksheets after the robot file"
        )));
    }
    let mut mistakes = Mistakes::new(&name, text);
    let is_json = text.trim_start().starts_with(['{', '[']);
    let mut head = Head::default();
    let rows = if is_json {
        json_rows(&name, text, robot, &mut mistakes)?
    } else {
        csv_rows(text, robot, &mut head, &mut mistakes)
    };
    if mistakes.are_there() {
        return mistakes.finish(Filled::default());
    }
    let reading = Reading { robot, mistakes, axes, seen: HashMap::new(), values: Vec::new(), text };
    Ok(Filled { student: head.student, steps: head.steps, cells: head.cells, ..reading.rows(&rows)? })
}

fn csv_rows<'a>(
    text: &'a str,
    robot: &Robot,
    head: &mut Head,
    mistakes: &mut Mistakes<'_>,
) -> Vec<(Cells<'a>, Range<usize>)> {
    let mut lines = Vec::new();
    for line in csv_table::lines(text) {
        match line {
            csv_table::Line::Row(row) if lines.len() > MOST * robot.dof() => {
                too_many(&row.span, robot, mistakes);
                break;
            }
            csv_table::Line::Row(row) => lines.push(row),
            csv_table::Line::OpenQuote(span) => mistakes.push(span, OPEN_QUOTE, None),
            csv_table::Line::Comment(comment, span) => {
                if let Some(about) = comment.strip_prefix("rne worksheet") {
                    // a spreadsheet has other separators, ends each line with those of the other columns, and may put
                    // each part in quotes
                    let word = |key: &str| {
                        let mut parts = about.split([',', ';']).map(|part| part.trim_matches(['"', ' ']));
                        parts.find_map(|part| part.strip_prefix(key).map(str::trim))
                    };
                    is_ours(word("format "), word("robot "), &span, robot, mistakes);
                    head.student = word("student ").map(str::to_owned);
                    let named = word("steps ");
                    head.steps = named.and_then(steps_of);
                    if named.is_some() && head.steps.is_none() {
                        let help = "write numbers from 1 to 7 with blanks between them, such as `steps 1 2 7`";
                        mistakes.push(span.clone(), "the steps in this line are not steps", Some(help));
                    }
                    let named = word("cells ");
                    head.cells = named.and_then(cells_of);
                    if named.is_some() && head.cells.is_none() {
                        let help =
                            "write joint and step of each cell with blanks between cells, such as `cells 1.4 2.4`";
                        mistakes.push(span, "the cells in this line are not cells", Some(help));
                    }
                }
            }
        }
    }
    let header = format!("the header is `{}`; each line below it contains one value", COLUMNS.join(","));
    let Some((first, rest)) = lines.split_first() else {
        if !mistakes.are_there() {
            mistakes.push(0..0, "the file is empty: there is no header", Some(&header));
        }
        return Vec::new();
    };
    let mut columns: Vec<Option<&'static str>> = Vec::new();
    for cell in &first.cells {
        let column = COLUMNS.into_iter().find(|column| column.eq_ignore_ascii_case(&cell.text));
        if column.is_some() && columns.contains(&column) {
            mistakes.push(cell.span.clone(), format!("the column {} occurs twice", quoted(&cell.text)), None);
        }
        // a column of somebody's own is nobody's mistake, one that is nearly ours is
        if let Some(near) = did_you_mean(&cell.text, COLUMNS).filter(|_| column.is_none()) {
            let message = format!("there is no column {}; did you mean `{near}`?", quoted(&cell.text));
            mistakes.push(cell.span.clone(), message, Some(&header));
        }
        columns.push(column);
    }
    for needed in ["joint", "quantity", "value"] {
        if !columns.contains(&Some(needed)) && !mistakes.are_there() {
            let help = csv_table::other_separator(first).unwrap_or(&header);
            mistakes.push(first.span.clone(), format!("there is no column `{needed}`"), Some(help));
        }
    }
    if mistakes.are_there() {
        return Vec::new();
    }
    let mut rows = Vec::new();
    for row in rest {
        if row.cells.len() > columns.len() {
            let message =
                format!("the line has {} cells, but the header has {} columns", row.cells.len(), columns.len());
            let help = "write numbers with a decimal point, or separate the columns with semicolons; put a text with a \
                        comma in quotes";
            mistakes.push(row.span.clone(), message, Some(help));
        }
        let cells = columns.iter().zip(&row.cells).filter_map(|(column, cell)| Some(((*column)?, cell.clone())));
        rows.push((cells.collect(), row.span.clone()));
    }
    rows
}

/// The steps of a text such as `1 2 7`.
fn steps_of(text: &str) -> Option<Vec<u8>> {
    text.split_whitespace().map(|step| step.parse().ok().filter(|step| (1..=7).contains(step))).collect()
}

/// The cells of a text such as `1.4 2.4`: joint and step.
fn cells_of(text: &str) -> Option<Vec<(usize, u8)>> {
    let cell = |text: &str| {
        let (joint, step) = text.split_once('.')?;
        Some((joint.parse().ok()?, step.parse().ok().filter(|step| (1..=7).contains(step))?))
    };
    text.split_whitespace().map(cell).collect()
}

fn too_many(span: &Range<usize>, robot: &Robot, mistakes: &mut Mistakes<'_>) {
    let message = format!("there are more rows than a worksheet of {} has", robot.name);
    mistakes.push(span.clone(), message, Some("give each component of each joint only once"));
}

/// Whether a worksheet is of this format and robot, where it says so.
fn is_ours(format: Option<&str>, name: Option<&str>, span: &Range<usize>, robot: &Robot, mistakes: &mut Mistakes<'_>) {
    if let Some(format) = format.filter(|format| *format != FORMAT.to_string()) {
        let message = format!("this worksheet has format {format}; this rne reads format {FORMAT}");
        mistakes.push(span.clone(), message, None);
    }
    if let Some(name) = name.filter(|name| *name != robot.name) {
        let message = format!("this worksheet is for {}, and the robot file is for {}", quoted(name), robot.name);
        mistakes.push(span.clone(), message, Some("compare it with the file of its own robot"));
    }
}

/// The members of an object, each as it is written.
fn object(raw: &str) -> Result<BTreeMap<String, &RawValue>, serde_json::Error> {
    serde_json::from_str(raw)
}

fn json_rows<'a>(
    name: &str,
    text: &'a str,
    robot: &Robot,
    mistakes: &mut Mistakes<'_>,
) -> Result<Vec<(Cells<'a>, Range<usize>)>, Failure> {
    let place = |raw: &RawValue| {
        let start = (raw.get().as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
        start..start + raw.get().len()
    };
    let broken = |error: &serde_json::Error, within: &str| {
        let offset = (within.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
        let before: usize = within.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
        let at = offset + before + error.column().saturating_sub(1);
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        let help = "a worksheet is an object with `rows`, as `rne eval … --trace --json` prints it, or a list of rows; \
                    JSON has no NaN and no comma after the last element";
        Failure::from(&Report::of_error(
            name,
            text,
            at..at + 1,
            format!("this is not a worksheet: {message}"),
            Some(help),
        ))
    };
    let mut list = text.trim();
    if list.starts_with('{') {
        let mut sheet = object(list).map_err(|error| broken(&error, list))?;
        if let Some(trace) = sheet.get("trace").copied() {
            sheet = object(trace.get()).map_err(|error| broken(&error, trace.get()))?;
        }
        let words = |key: &str| sheet.get(key).map(|raw| (raw.get().trim_matches('"'), place(raw)));
        for (format, robot_name, span) in [
            words("format").map(|(format, span)| (Some(format), None, span)),
            words("robot").map(|(name, span)| (None, Some(name), span)),
        ]
        .into_iter()
        .flatten()
        {
            is_ours(format, robot_name, &span, robot, mistakes);
        }
        let Some(rows) = sheet.get("rows") else {
            mistakes.push(0..1, "there is no key `rows`", Some("`rows` is a list of objects, one for each value"));
            return Ok(Vec::new());
        };
        list = rows.get();
    }
    let raw_rows: Vec<&RawValue> = serde_json::from_str(list).map_err(|error| broken(&error, list))?;
    let mut rows = Vec::new();
    for (index, raw) in raw_rows.into_iter().enumerate() {
        if index > MOST * robot.dof() {
            too_many(&place(raw), robot, mistakes);
            break;
        }
        let fields = object(raw.get()).map_err(|error| broken(&error, raw.get()))?;
        let mut cells = Cells::new();
        for (key, value) in &fields {
            let Some(column) = COLUMNS.into_iter().find(|column| column == key) else {
                if let Some(near) = did_you_mean(key, COLUMNS) {
                    let message = format!("there is no key {}; did you mean `{near}`?", quoted(key));
                    mistakes.push(place(raw), message, None);
                }
                continue;
            };
            let text = match value.get() {
                "null" => Cow::Borrowed(""),
                text if text.starts_with('"') => Cow::Owned(serde_json::from_str(text).unwrap_or_default()),
                text => Cow::Borrowed(text),
            };
            cells.insert(column, Cell { text, span: place(value) });
        }
        for needed in ["joint", "quantity", "value"] {
            if !cells.contains_key(needed) {
                mistakes.push(place(raw), format!("this row has no `{needed}`"), None);
            }
        }
        rows.push((cells, place(raw)));
    }
    Ok(rows)
}

/// Rows are made values.
struct Reading<'a> {
    robot: &'a Robot,
    mistakes: Mistakes<'a>,
    axes: Option<Axes>,
    /// The byte at which a component was given.
    seen: HashMap<(usize, Quantity, usize), usize>,
    values: Vec<GivenValue>,
    text: &'a str,
}

impl Reading<'_> {
    fn rows(mut self, rows: &[(Cells<'_>, Range<usize>)]) -> Result<Filled, Failure> {
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
        // a value that is not filled in
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
        // a symmetric matrix has each of these twice
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
                [_] => "{quantity} is one number: leave the component empty".to_owned(),
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

/// A unit without what people write differently: `kg m²` is `kg*m^2`.
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

/// The steps of which a file has no value, in words: `steps 3 and 5`.
pub(crate) fn steps_in_words(steps: &[u8]) -> Option<String> {
    let steps: BTreeSet<u8> = steps.iter().copied().collect();
    let words: Vec<String> = steps.iter().map(ToString::to_string).collect();
    match words.split_last() {
        None => None,
        Some((one, [])) => Some(format!("step {one}")),
        Some((last, others)) => Some(format!("steps {} and {last}", others.join(", "))),
    }
}
