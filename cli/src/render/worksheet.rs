//! Writes the seven steps of one state, as a student fills them in by hand: outwards from link to link, and back.

use std::fmt::Write as _;

use clap::ValueEnum;
use rne::BaseMotion;
use rne_codegen::{Argument, Step};
use rne_diagnose::worksheet::{self, Line, Quantity, Situation, Worksheet};
use rne_model::Robot;

use crate::palette::{FORMULA, QUIET, TITLE};
use crate::render::layout::{PAGE, left, width, wrap};
use crate::render::letters::Letters;
use crate::values::numbers::{WIDTH, fixed};
use crate::values::state::State;

/// Axes in which vectors are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Axes {
    /// Axes fixed to link i, z along joint i, as in the generated code
    Link,
    /// Axes fixed to link i-1, z along joint i, as in the lecture
    #[value(alias = "lecture")]
    Joint,
    /// Axes of frame 0
    Base,
}

impl From<Axes> for worksheet::Axes {
    fn from(axes: Axes) -> Self {
        match axes {
            Axes::Link => Self::Link,
            Axes::Joint => Self::Joint,
            Axes::Base => Self::Base,
        }
    }
}

/// The lines of a worksheet that the command line selects.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Narrowed {
    /// Only lines of this joint, counted from 1.
    pub(crate) joint: Option<usize>,
    /// Only lines of this step.
    pub(crate) step: Option<Step>,
}

impl Narrowed {
    pub(crate) fn has(self, line: &Line) -> bool {
        let of_step = |step: Step| usize::from(line.quantity.step()) == step.number();
        self.joint.is_none_or(|joint| joint == line.joint) && self.step.is_none_or(of_step)
    }

    pub(crate) const fn is_all(self) -> bool {
        self.joint.is_none() && self.step.is_none()
    }
}

/// Converts the state of the arm to the situation of a worksheet.
pub(crate) fn situation(state: &State, dof: usize) -> Situation {
    // lists that the function does not take are zero
    let [qd, qdd] =
        [&state.qd, &state.qdd].map(|values| if values.is_empty() { vec![0.0; dof] } else { values.clone() });
    let base = state.function.takes(Argument::Base).then_some(state.base);
    Situation { q: state.q.clone(), qd, qdd, base, wrench: state.wrench, payload: state.payload }
}

/// Number of columns before the numbers.
const MARGIN: usize = 12;

/// Number of columns for a unit, with the gap before the formula.
const UNIT: usize = 8;

/// A blank at which no line is broken.
const TIED: &str = "\u{A0}";

/// Writes the worksheet as text.
pub(crate) fn text(robot: &Robot, sheet: &Worksheet, narrowed: Narrowed, state: &State, letters: Letters) -> String {
    let mut text = format!("{TITLE}the seven steps of {}{TITLE:#}\n", robot.name);
    for line in heading(robot, sheet.axes, state) {
        let _ = writeln!(text, "{}", wrap(&letters.of(&line), PAGE, "  "));
    }
    let mut section = None;
    for line in sheet.lines.iter().filter(|line| narrowed.has(line)) {
        let here = (line.joint, line.quantity.is_inward());
        if section != Some(here) {
            section = Some(here);
            title(&mut text, robot, line, letters);
            if narrowed.step.is_none() && !line.quantity.is_inward() {
                let of_file = letters.of(&format!("    {}", of_file(robot, line.joint)));
                let of_file = wrap(&of_file, PAGE, "      ").replace(TIED, " ");
                let _ = writeln!(text, "{QUIET}{of_file}{QUIET:#}");
            }
        }
        write_line(&mut text, line, letters);
    }
    text
}

/// Writes the axes, and the values with which the recursion begins.
fn heading(robot: &Robot, axes: worksheet::Axes, state: &State) -> Vec<String> {
    let n = robot.dof();
    let meaning = match axes {
        worksheet::Axes::Link => {
            "link axes: fixed to link i, z along joint i, so e = (0, 0, 1); Ri turns components in them into those of \
             link i-1, R1 into those of frame 0"
        }
        worksheet::Axes::Joint => {
            "joint axes, the lecture's: fixed to link i-1, z along joint i, so e = (0, 0, 1); Ri turns components in \
             them into those of joint i-1, R1 into those of frame 0"
        }
        worksheet::Axes::Base => {
            "base axes: every vector in those of frame 0; Ai turns components in axes fixed to link i into them"
        }
    };
    let tip = match (&state.wrench, &state.payload) {
        (Some(_), _) => format!("f{n},{0} and n{n},{0}: what the last link exerts at the tip", n + 1),
        (None, Some(_)) => {
            format!("f{n},{0} and n{n},{0}: what the last link exerts on the payload, at the tip", n + 1)
        }
        (None, None) => format!("f{n},{0} = 0 and n{n},{0} = 0: nothing touches the tip", n + 1),
    };
    let BaseMotion { omega, omega_dot, acceleration, .. } = state.base;
    let [omega, omega_dot, acceleration] = [omega, omega_dot, acceleration].map(|value| triple(&value));
    let gravity = if state.function.takes(Argument::Base) { state.base.gravity } else { robot.gravity };
    let base = if state.function.takes(Argument::Base) {
        format!("at the base ω0 = {omega} rad/s, ω̇0 = {omega_dot} rad/s², ċ0 = 0, c̈0 = {acceleration} m/s²")
    } else {
        "at the base ω0, ω̇0, ċ0, c̈0 = 0".to_owned()
    };
    let a = robot.rows().next().map_or(0.0, |row| row.dh.a);
    let lever = match robot.convention {
        rne_model::Convention::Standard => "r0 = 0".to_owned(),
        rne_model::Convention::Modified => format!("r0 = {} m", triple(&[a, 0.0, 0.0])),
    };
    vec![meaning.to_owned(), format!("{base}, g0 = {} m/s², {lever}", triple(&gravity)), tip]
}

/// Writes three numbers in the form `(0, -9.81, 0)`.
pub(crate) fn triple(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|value| fixed(*value).trim().to_owned()).collect();
    format!("({})", numbers.join(", "))
}

fn title(text: &mut String, robot: &Robot, line: &Line, letters: Letters) {
    let kind = line.kind.name();
    let way = if line.quantity.is_inward() { "back" } else { "outward" };
    let name = letters.of(robot.joints.get(line.joint - 1).map_or("", |joint| &joint.name));
    let margin = left(&format!("link {}", line.joint), MARGIN);
    let [x, y, z] = ["x", "y", "z"].map(|axis| left(&format!("    {axis}"), WIDTH));
    let about = format!("  {way}, {kind}, {name}");
    let head = format!("{TITLE}{margin}{TITLE:#}{QUIET}{x}{y}{z}");
    let is_long = MARGIN + 3 * WIDTH + width(&about) > PAGE;
    let _ = if is_long {
        writeln!(text, "\n{head}  {way}, {kind}{QUIET:#}\n{QUIET}    {name}{QUIET:#}")
    } else {
        writeln!(text, "\n{head}{about}{QUIET:#}")
    };
}

/// Writes the numbers of a table row that the lines below it need.
fn of_file(robot: &Robot, joint: usize) -> String {
    let (i, row) = (joint, &robot.joints[joint - 1].row);
    let number = |value: f64| {
        let text = fixed(value).trim().to_owned();
        if text.contains(['e', 'E']) || !text.contains('.') {
            return text;
        }
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    let matter = if row.link.has_first_moment() {
        let [x, y, z] = row.link.first_moment.map(number);
        format!("h{i} ({x}, {y}, {z}) kg m, about the origin")
    } else {
        let [x, y, z] = row.link.com.map(number);
        format!("com{i} ({x}, {y}, {z}) m, about it")
    };
    let inertia = row.link.inertia;
    let named = [
        ("xx", inertia.xx),
        ("yy", inertia.yy),
        ("zz", inertia.zz),
        ("xy", inertia.xy),
        ("xz", inertia.xz),
        ("yz", inertia.yz),
    ];
    let inertia = named.into_iter().filter(|(_, value)| *value != 0.0);
    let inertia: Vec<String> = inertia.map(|(name, value)| format!("I{name}{TIED}{}", number(value))).collect();
    let inertia = if inertia.is_empty() { "I 0".to_owned() } else { inertia.join(", ") };
    format!(
        "of the file: a{i} {} m, α{i} {} rad, {matter} {inertia} kg m²",
        number(row.dh.a),
        number(row.dh.alpha.radians)
    )
}

fn write_line(text: &mut String, line: &Line, letters: Letters) {
    let step = line.quantity.step();
    let first = matches!(
        line.quantity,
        Quantity::Omega
            | Quantity::OmegaDot
            | Quantity::Velocity
            | Quantity::Acceleration
            | Quantity::Gravity
            | Quantity::InertiaForce
            | Quantity::Tau
    );
    let step = if first { step.to_string() } else { String::new() };
    let matrix = matrix(&line.values);
    let symbol = letters.of(&line.symbol());
    let name = if matrix.is_some() { format!("  {step:1} {symbol} x") } else { format!("  {step:1} {symbol}") };
    let numbers = match (&matrix, line.values.as_slice()) {
        (Some(rows), _) => rows[0].map(fixed).concat(),
        // τ is the z element of the moment vector
        (None, [tau]) if line.quantity == Quantity::Tau => {
            format!("{}{TITLE}{}{TITLE:#}", " ".repeat(2 * WIDTH), fixed(*tau))
        }
        (None, [one]) => fixed(*one) + &" ".repeat(2 * WIDTH),
        (None, several) => several.iter().map(|value| fixed(*value)).collect(),
    };
    let unit = left(&letters.of(if line.unit() == "1" { "" } else { line.unit() }), UNIT);
    let (equals, style) = if is_formula(line) { ("= ", FORMULA) } else { ("", QUIET) };
    let formula = letters.of(&format!("{equals}{}", line.formula));
    let row = format!("{}{numbers}", left(&name, MARGIN));
    let room = PAGE - (MARGIN + 3 * WIDTH + 2 + UNIT);
    let below = width(&formula) > room;
    if below && unit.trim().is_empty() {
        let _ = writeln!(text, "{}", row.trim_end());
    } else if below {
        let _ = writeln!(text, "{row}  {QUIET}{}{QUIET:#}", unit.trim_end());
    } else {
        let row = format!("{row}  {QUIET}{unit}{QUIET:#}");
        let _ = writeln!(text, "{row}{style}{formula}{style:#}");
    }
    if let Some([_, second, third]) = matrix {
        let indent = " ".repeat(width(&name).saturating_sub(1));
        for (axis, values) in [("y", second), ("z", third)] {
            let _ =
                writeln!(text, "{}{}", left(&format!("{indent}{axis}"), MARGIN), values.map(fixed).concat().trim_end());
        }
    }
    if below {
        // a line may be broken only before a term
        let tied = formula.replace(' ', TIED).replace(&format!("{TIED}+{TIED}"), &format!(" +{TIED}"));
        let wrapped = wrap(&format!("{}{tied}", TIED.repeat(6)), PAGE, "        ").replace(TIED, " ");
        let _ = writeln!(text, "{style}{wrapped}{style:#}");
    }
}

/// Returns whether the right-hand side of a line is a formula, and not a description.
pub(crate) fn is_formula(line: &Line) -> bool {
    let at_the_tip = matches!(line.quantity, Quantity::NextForce | Quantity::NextMoment) && line.terms.is_empty();
    !at_the_tip && !matches!(line.formula.as_str(), "given" | "of the row")
}

/// Returns the rows of a matrix from nine numbers, or from the six of a symmetric one.
pub(crate) fn matrix(values: &[f64]) -> Option<[[f64; 3]; 3]> {
    match *values {
        [xx, xy, xz, yx, yy, yz, zx, zy, zz] => Some([[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]),
        [xx, xy, xz, yy, yz, zz] => Some([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
        _ => None,
    }
}
