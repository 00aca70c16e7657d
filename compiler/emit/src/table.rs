//! Readable tables: the Denavit-Hartenberg table, and operation counts.

use rne_codegen::Program;
use rne_model::{Angle, JointKind, QuarterTurns, Robot, one_line};
use unicode_width::UnicodeWidthStr;

/// Returns the table of a robot as text: one line per joint, in aligned columns, right angles as multiples of π.
pub(super) fn dh_table(robot: &Robot) -> String {
    let titles = ["i", "joint", "on", "type", "theta", "d", "a", "alpha", "mass"].map(str::to_owned);
    let mut lines = vec![titles];
    for (index, joint) in robot.joints.iter().enumerate() {
        let (row, i) = (&joint.row, index + 1);
        let (theta, d) = match row.kind {
            JointKind::Revolute => (with_variable(i, &angle(&row.dh.theta)), number(row.dh.d)),
            JointKind::Prismatic => (angle(&row.dh.theta), with_variable(i, &number(row.dh.d))),
        };
        lines.push([
            i.to_string(),
            one_line(&joint.name),
            carrier(robot, robot.parent(index)),
            row.kind.name().to_owned(),
            theta,
            d,
            number(row.dh.a),
            angle(&row.dh.alpha),
            number(row.link.mass),
        ]);
    }
    let lines = if robot.is_serial() {
        // in a chain, each joint is on the link before it, so the column `on` is left out
        columns(&lines.into_iter().map(|[i, joint, _, rest @ ..]| without_carrier(i, joint, rest)).collect::<Vec<_>>())
    } else {
        columns(&lines)
    };
    lines.join("\n") + "\n"
}

fn without_carrier(i: String, joint: String, [kind, theta, d, a, alpha, mass]: [String; 6]) -> [String; 8] {
    [i, joint, kind, theta, d, a, alpha, mass]
}

/// Returns the name of the joint whose link carries another joint; `base` for `None`.
pub(super) fn carrier(robot: &Robot, joint: Option<usize>) -> String {
    joint.map_or_else(|| "base".to_owned(), |joint| one_line(&robot.joints[joint].name))
}

/// Returns lines of cells: each column is as wide as its widest cell, with three blanks between columns.
pub(super) fn columns<const N: usize>(lines: &[[String; N]]) -> Vec<String> {
    let widths: [usize; N] =
        std::array::from_fn(|column| lines.iter().map(|line| line[column].width()).max().unwrap_or(0));
    let padded = |(cell, width): (&String, usize)| format!("{cell}{}", " ".repeat(width - cell.width()));
    let row = |line: &[String; N]| line.iter().zip(widths).map(padded).collect::<Vec<_>>().join("   ");
    lines.iter().map(|line| row(line).trim_end().to_owned()).collect()
}

/// Returns the function of a program, and its products, sums, divisions and angles before and after folding.
pub(super) fn counts(program: &Program) -> [String; 5] {
    let ((products, sums), after) = (program.before(), program.operations());
    let [products, sums] =
        [(products, after.mul), (sums, after.add)].map(|(before, after)| format!("{before} -> {after}"));
    [program.function.to_string(), products, sums, after.div.to_string(), after.sincos.to_string()]
}

/// Returns the operation counts of each program before and after folding, as a table of Markdown.
#[must_use]
pub fn operations_table(programs: &[Program]) -> String {
    let row = |[function, products, sums, _, angles]: [String; 5]| {
        format!("| `{function}` | {products} | {sums} | {angles} |\n")
    };
    let rows = programs.iter().map(|program| row(counts(program)));
    "| function | products | sums | angles |\n|---|---|---|---|\n".to_owned() + &rows.collect::<String>()
}

fn with_variable(joint: usize, constant: &str) -> String {
    match constant.strip_prefix('-') {
        _ if constant == "0" => format!("q{joint}"),
        Some(magnitude) => format!("q{joint} - {magnitude}"),
        None => format!("q{joint} + {constant}"),
    }
}

fn number(value: f64) -> String {
    // -0 is written as 0
    if value == 0.0 { "0".to_owned() } else { format!("{value}") }
}

/// Returns an angle as text; multiples of a right angle, up to a full turn, as multiples of π.
#[must_use]
pub fn angle(angle: &Angle) -> String {
    let Some(right) = angle.right else { return number(angle.radians) };
    // An angle of more than a full turn keeps its digits.
    let quarters = (angle.radians / std::f64::consts::FRAC_PI_2).round();
    let text = match right {
        _ if quarters.abs() > 4.0 => return number(angle.radians),
        QuarterTurns::Zero if quarters == 0.0 => return "0".to_owned(),
        QuarterTurns::Zero => "2π",
        QuarterTurns::Two => "π",
        QuarterTurns::One | QuarterTurns::Three if quarters.abs() == 3.0 => "3π/2",
        QuarterTurns::One | QuarterTurns::Three => "π/2",
    };
    if quarters < 0.0 { format!("-{text}") } else { text.to_owned() }
}
