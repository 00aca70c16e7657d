//! Writes worksheets as CSV or JSON, with a row for each joint, step, quantity and component.

use std::fmt::Write as _;

use rne_diagnose::worksheet::{Axes, Line, Worksheet};
use rne_emit::Heading;
use rne_model::{Convention, Robot, exact_digits, six_digits};
use serde::Serialize;

use crate::outcome::Failure;
use crate::render::worksheet::Narrowed;

/// The version of the CSV and JSON formats of worksheets, which a reader compares before it reads on.
pub(super) const FORMAT: u32 = 1;

/// The columns in CSV, and the keys of a row in JSON.
pub(super) const COLUMNS: [&str; 7] = ["joint", "step", "quantity", "component", "value", "unit", "frame"];

/// One number of a worksheet.
#[derive(Serialize)]
struct Row {
    joint: usize,
    step: u8,
    quantity: &'static str,
    component: &'static str,
    value: f64,
    unit: &'static str,
    frame: &'static str,
}

impl Row {
    /// Appends a line of CSV with the text `value` in the column of values.
    fn write(&self, text: &mut String, separator: char, value: &str) {
        let Self { joint, step, quantity, component, unit, frame, .. } = self;
        let s = separator;
        let _ = writeln!(text, "{joint}{s}{step}{s}{quantity}{s}{component}{s}{value}{s}{unit}{s}{frame}");
    }
}

fn rows(sheet: &Worksheet, narrowed: Narrowed) -> impl Iterator<Item = Row> {
    let of_line = |line: &Line| {
        let (joint, quantity, unit) = (line.joint, line.quantity, line.unit());
        let frame = if quantity.has_axes() { sheet.axes.name() } else { "" };
        let row = move |(component, value): (&&'static str, &f64)| Row {
            joint,
            step: quantity.step(),
            quantity: quantity.name(),
            component,
            value: *value,
            unit,
            frame,
        };
        quantity.components().iter().zip(&line.values).map(row).collect::<Vec<_>>()
    };
    sheet.lines.iter().filter(move |line| narrowed.has(line)).flat_map(of_line)
}

/// Writes the worksheet as CSV.
pub(crate) fn csv(robot: &Robot, sheet: &Worksheet, narrowed: Narrowed) -> String {
    let mut text = format!("# rne worksheet, format {FORMAT}, robot {}\n{}\n", robot.name, COLUMNS.join(","));
    for row in rows(sheet, narrowed) {
        row.write(&mut text, ',', &exact_digits(row.value));
    }
    text
}

/// Writes the numbers of the arm as comments, so that a student does not need the robot file.
fn arm(robot: &Robot) -> String {
    let Heading { frames, ends, table, .. } = Heading::of(robot);
    let mut lines: Vec<String> = frames.lines().map(str::to_owned).chain(ends).collect();
    lines.extend(table.lines().map(str::to_owned));
    lines.push(
        "link i: mass, centre of mass in frame i of the table, inertia about the centre of mass in axes of frame i"
            .to_owned(),
    );
    for (index, row) in robot.rows().enumerate() {
        let (mass, [x, y, z], inertia) = (six_digits(row.link.mass), row.link.com.map(six_digits), row.link.inertia);
        let mut line = format!("link {}: m = {mass} kg; com = ({x}, {y}, {z}) m; inertia", index + 1);
        let [xx, yy, zz] = [inertia.xx, inertia.yy, inertia.zz];
        let [xy, xz, yz] = [inertia.xy, inertia.xz, inertia.yz];
        for (name, value) in [("xx", xx), ("yy", yy), ("zz", zz), ("xy", xy), ("xz", xz), ("yz", yz)] {
            let _ = write!(line, " {name} {},", six_digits(value));
        }
        lines.push(format!("{} kg m²", line.trim_end_matches(',')));
    }
    format!("# {}\n", lines.join("\n# "))
}

/// Writes the axes of the vectors as a comment: in a standard table the axes of link i are not those of frame i.
fn axes(robot: &Robot, axes: Axes) -> String {
    let of_table = match (axes, robot.convention) {
        (Axes::Link, Convention::Standard) => "; frame i of the table is these axes turned by alpha_i about x",
        _ => "",
    };
    format!("# axes of the vectors: {} = {}{of_table}\n", axes.name(), axes.explained())
}

/// Returns the largest magnitude of a quantity over all joints.
fn scale(sheet: &Worksheet, quantity: &str) -> f64 {
    let of_quantity = sheet.lines.iter().filter(|line| line.quantity.name() == quantity);
    of_quantity.flat_map(|line| &line.values).fold(0.0, |most, value| most.max(value.abs()))
}

/// Writes a right value with eight significant digits; a rounding error of zero becomes 0.
fn answer(value: f64, scale: f64) -> String {
    let value = if value.abs() <= 1e-12 * scale { 0.0 } else { value };
    exact_digits(format!("{value:.7e}").parse().unwrap_or(value))
}

/// Writes a student's worksheet as CSV, with the arm and the state filled in, and with `answers` also everything else.
/// `comma` means a decimal comma in numbers, and semicolons between the columns.
pub(crate) fn of_student(
    robot: &Robot,
    sheet: &Worksheet,
    student: &str,
    steps: &[u8],
    answers: bool,
    comma: bool,
) -> String {
    let separator = if comma { ';' } else { ',' };
    let columns = COLUMNS.join(separator.encode_utf8(&mut [0; 4]));
    // because of the byte order mark, a spreadsheet reads the file as UTF-8, which units such as m/s² need
    let mut text = format!("\u{feff}# rne worksheet, format {FORMAT}, robot {}", robot.name);
    if steps.len() < 7 {
        let steps: Vec<String> = steps.iter().map(ToString::to_string).collect();
        let _ = write!(text, ", steps {}", steps.join(" "));
    }
    let _ = writeln!(text, ", student {student}\n{}{}{columns}", arm(robot), axes(robot, sheet.axes));
    for row in rows(sheet, Narrowed::default()) {
        let is_state = ["q", "qd", "qdd"].contains(&row.quantity);
        if !is_state && !steps.contains(&row.step) {
            continue;
        }
        let value = match answers {
            _ if is_state => exact_digits(row.value),
            true => answer(row.value, scale(sheet, row.quantity)),
            false => String::new(),
        };
        row.write(&mut text, separator, &if comma { value.replace('.', ",") } else { value });
    }
    text
}

/// Writes the worksheet and the result of the function as JSON, with a row on each line.
pub(crate) fn json(
    robot: &Robot,
    sheet: &Worksheet,
    narrowed: Narrowed,
    result: &serde_json::Value,
) -> Result<String, Failure> {
    let rows: Vec<String> = rows(sheet, narrowed)
        .map(|row| serde_json::to_string(&row))
        .collect::<Result<_, _>>()
        .map_err(Failure::input)?;
    let rows = rows.join(",\n      ");
    let (name, axes) = (serde_json::Value::from(robot.name.as_str()), sheet.axes.name());
    let about = format!(r#""format": {FORMAT}, "robot": {name}, "axes": "{axes}""#);
    Ok(format!(
        "{{\n  \"result\": {result},\n  \"trace\": {{\n    {about},\n    \"rows\": [\n      {rows}\n    ]\n  }}\n}}\n"
    ))
}
