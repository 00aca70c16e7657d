//! `rne show --base-parameters`: lists the combinations of link parameters on which the torques depend.

use std::fmt::Write as _;

use rne::{BaseParameter, BaseParameters, DynArm, LinkParameter};
use rne_model::Robot;

use crate::palette::{FOUND, QUIET, TITLE, WARNING};
use crate::render::layout::{left, width, wrap};
use crate::terminal;
use crate::values::numbers::{at_the_point, rounded};

/// Largest number of columns of a line.
const WIDTH: usize = 100;

/// Number of significant digits of a coefficient.
const DIGITS: usize = 8;

/// The explanation of how to read the list.
const ABOUT: &str = "mcx2 is the mass of link 2 times x of its centre of mass; J is about the link frame's origin, in \
    its axes. A parameter that the torques cannot distinguish from earlier ones (J, m c, m; base to tip) is \
    combined with them (Gautier and Khalil, 1990). The computation is numerical, at fixed random states.";

pub(crate) fn text(robot: &Robot) -> String {
    let columns = terminal::width(WIDTH);
    let base = DynArm::from_robot(robot).base_parameters();
    let mut text = String::new();
    let heading = format!(
        "{TITLE}{} base parameters{TITLE:#}: the torques depend on these combinations of the {} inertial parameters",
        base.rank(),
        10 * robot.joints.len()
    );
    let about = wrap(ABOUT, columns, "");
    let _ = writeln!(text, "{heading}\n{QUIET}{about}{QUIET:#}\n");
    let names =
        |parameters: &[LinkParameter]| parameters.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let alone: Vec<LinkParameter> = base.alone().map(|base| base.kept).collect();
    for (title, parameters) in [("no effect", &base.without_effect), ("by itself", &alone)] {
        if !parameters.is_empty() {
            let indent = "             ";
            let line = wrap(&format!("{title} {}", names(parameters)), columns, indent);
            let list = line.strip_prefix(title).unwrap_or(&line).trim_start();
            let _ = writeln!(text, "{QUIET}{title}{QUIET:#}    {list}\n");
        }
    }
    if base.visible_rank < base.rank() {
        let hidden = format!(
            "Torques in double precision determine only {} combinations. Each one with a ? differs from a \
             combination of the others by less than {:e} of what it adds to the torques. Nearly right angles cause \
             this, such as 1.5708 for pi/2.",
            base.visible_rank,
            BaseParameters::VISIBLE
        );
        let _ = writeln!(text, "{WARNING}{}{WARNING:#}\n", wrap(&hidden, columns, ""));
    }
    let values: Vec<String> = base.parameters.iter().map(|base| rounded(base.value, 6)).collect();
    let values = at_the_point(&values);
    let widest = values.iter().map(|value| width(value)).max().unwrap_or(0);
    for (base, value) in base.parameters.iter().zip(&values) {
        let unit = unit(base.kept);
        let margin = widest + UNIT + 4;
        let combination =
            wrap(&combination(base), columns - margin.min(columns / 2), &" ".repeat(margin)).replace(TIED, " ");
        let (value, unit) = (left(value, widest), left(unit, UNIT));
        let mark = if base.is_visible { ' ' } else { '?' };
        let _ = writeln!(text, "{mark} {value} {QUIET}{unit}{QUIET:#} {FOUND}{combination}{FOUND:#}");
    }
    text
}

/// Number of columns of the longest unit.
const UNIT: usize = 5;

const fn unit(parameter: LinkParameter) -> &'static str {
    match parameter.index {
        0 => "kg",
        1..=3 => "kg m",
        _ => "kg m²",
    }
}

/// Writes a combination, such as `Jzz2 + Jyy3 + 0.1864 (m3 + m4)`.
fn combination(base: &BaseParameter) -> String {
    // parameters with the same coefficient are put in one group
    let mut groups: Vec<(bool, String, Vec<String>)> = Vec::new();
    for (coefficient, parameter) in &base.regrouped {
        let (is_negative, magnitude) = (*coefficient < 0.0, short(coefficient.abs()));
        let name = parameter.to_string();
        match groups.iter_mut().find(|(sign, other, _)| *sign == is_negative && *other == magnitude) {
            Some((.., names)) if magnitude != "1" => names.push(name),
            _ => groups.push((is_negative, magnitude, vec![name])),
        }
    }
    let mut text = base.kept.to_string();
    for (is_negative, magnitude, names) in groups {
        let sign = if is_negative { '-' } else { '+' };
        let factor = if magnitude == "1" { String::new() } else { magnitude + TIED };
        let sum = match names.as_slice() {
            [one] => one.clone(),
            several => format!("({})", several.join(&format!("{TIED}+{TIED}"))),
        };
        let _ = write!(text, " {sign}{TIED}{factor}{sum}");
    }
    text
}

/// A blank at which no line is broken.
const TIED: &str = "\u{A0}";

/// Writes a positive number with few digits.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.0$e}", DIGITS - 1).parse().unwrap_or(value);
    format!("{rounded}")
}
