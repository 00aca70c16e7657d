//! The seven steps of one state, as one would fill them in by hand: link by link out, and back.

use std::fmt::Write as _;

use clap::ValueEnum;
use rne::LinkTrace;
use rne_codegen::Argument;
use rne_model::{Joint, JointKind, Robot};
use serde::Serialize;

use crate::layout::left;
use crate::numbers::{WIDTH, fixed};
use crate::state::State;
use crate::terminal::{FORMULA, QUIET, TITLE};

/// Axes in which vectors are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Axes {
    /// Fixed to link i, z along joint i: the generated code's
    Link,
    /// Fixed to link i-1, z along joint i: the lecture's
    Lecture,
    /// Those of frame 0
    Base,
}

impl Axes {
    fn meaning(self) -> &'static str {
        match self {
            Self::Link => "link i in axes fixed to link i, z along joint i; R turns them into those of the link before",
            Self::Lecture => {
                "link i in the lecture's axes, fixed to link i-1, z along joint i; R turns them into those before"
            }
            Self::Base => "every vector in the axes of frame 0, so R = 1",
        }
    }
}

/// One line of the worksheet.
struct Line {
    /// Step of the lecture, on its first line.
    step: Option<usize>,
    name: String,
    /// x, y, z.
    value: [f64; 3],
    unit: &'static str,
    /// Right side of its formula, a line each.
    formula: Vec<String>,
}

impl Line {
    fn new(step: usize, name: String, value: [f64; 3], unit: &'static str, formula: &[String]) -> Self {
        Self { step: Some(step), name, value, unit, formula: formula.to_vec() }
    }

    fn again(self) -> Self {
        Self { step: None, ..self }
    }
}

/// The worksheet for reading.
pub(crate) fn text(robot: &Robot, links: &[LinkTrace<f64>], axes: Axes, state: &State) -> String {
    let mut text = format!("{TITLE}the seven steps of {}{TITLE:#}\n", robot.name);
    let n = links.len();
    let tip = match (&state.wrench, &state.payload) {
        (Some(_), _) => "what the last link exerts at the tip",
        (None, Some(_)) => "what the last link exerts on the payload, at the tip",
        (None, None) => "0, nothing touches the tip",
    };
    let _ = writeln!(text, "{}", axes.meaning());
    let base = if state.function.takes(Argument::Base) {
        "ω0, ω̇0, c̈0, g0 as given, ċ0 = 0"
    } else {
        "ω0, ω̇0, ċ0, c̈0 = 0, g0 = gravity"
    };
    let _ = writeln!(text, "at the base {base}; f{n},{0} and n{n},{0} = {tip}", n + 1);
    let joints = links.iter().zip(&robot.joints).enumerate();
    for (index, (link, joint)) in joints.clone() {
        title(&mut text, "outward", index + 1, joint);
        for line in forward(index + 1, n, joint.row.kind, link) {
            write_line(&mut text, &line);
        }
    }
    for (index, (link, joint)) in joints.rev() {
        title(&mut text, "back", index + 1, joint);
        for line in backward(index + 1, link) {
            write_line(&mut text, &line);
        }
        write_torque(&mut text, index + 1, joint.row.kind, link.tau);
    }
    text
}

fn title(text: &mut String, way: &str, i: usize, joint: &Joint) {
    let kind = match joint.row.kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    };
    let margin = left(&format!("link {i}"), MARGIN);
    let [x, y, z] = ["x", "y", "z"].map(|axis| left(&format!("    {axis}"), WIDTH));
    let gap = " ".repeat(UNIT + 2);
    let name = &joint.name;
    let _ = writeln!(text, "\n{TITLE}{margin}{TITLE:#}{QUIET}{x}{y}{z}{gap}{way}, {name}, {kind}{QUIET:#}");
}

/// Steps 1 to 5, and the two vectors of the table that they use.
fn forward(i: usize, n: usize, kind: JointKind, link: &LinkTrace<f64>) -> Vec<Line> {
    let p = i - 1;
    let next = if i < n { format!("from there to joint {}", i + 1) } else { "from there to the tip".to_owned() };
    let slides = kind == JointKind::Prismatic;
    let with = |base: String, own: String| if slides { base } else { base + &own };
    let plus = |base: String, own: String| if slides { base + &own } else { base };
    let omega = with(format!("R{i}ᵀ ω{p}"), format!(" + q̇{i} e"));
    let omega_dot = with(format!("R{i}ᵀ ω̇{p}"), format!(" + q̈{i} e + q̇{i} ω{i} × e"));
    let velocity = plus(format!("R{i}ᵀ (ċ{p} + ω{p} × r{p}) + ω{i} × d{i}"), format!(" + q̇{i} e"));
    let carried = format!("R{i}ᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p}))");
    let own = format!("  + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})");
    let sliding = format!("  + q̈{i} e + 2 q̇{i} ω{i} × e");
    let acceleration = if slides { vec![carried, own, sliding] } else { vec![carried, own] };
    vec![
        Line::new(0, format!("d{i}"), link.d, "m", &[format!("from joint {i} to the centre of mass")]).again(),
        Line::new(0, format!("r{i}"), link.r, "m", &[next]).again(),
        Line::new(1, format!("ω{i}"), link.omega, "rad/s", &[omega]),
        Line::new(2, format!("ω̇{i}"), link.omega_dot, "rad/s²", &[omega_dot]),
        Line::new(3, format!("ċ{i}"), link.velocity, "m/s", &[velocity]),
        Line::new(4, format!("c̈{i}"), link.acceleration, "m/s²", &acceleration),
        Line::new(5, format!("g{i}"), link.gravity, "m/s²", &[format!("R{i}ᵀ g{p}")]),
    ]
}

/// Step 6.
fn backward(i: usize, link: &LinkTrace<f64>) -> Vec<Line> {
    let (p, n) = (i - 1, i + 1);
    let moment = format!("n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n}");
    vec![
        Line::new(6, format!("f{i}"), link.inertia_force, "N", &[format!("m{i} c̈{i}")]),
        Line::new(6, format!("n{i}"), link.inertia_moment, "N m", &[format!("I{i} ω̇{i} + ω{i} × I{i} ω{i}")]).again(),
        Line::new(6, format!("f{p},{i}"), link.joint_force, "N", &[format!("f{i} + f{i},{n} - m{i} g{i}")]).again(),
        Line::new(6, format!("n{p},{i}"), link.joint_moment, "N m", &[moment]).again(),
    ]
}

/// Columns before the numbers.
const MARGIN: usize = 12;

/// Columns of a unit, with the gap before the formula.
const UNIT: usize = 8;

fn write_line(text: &mut String, Line { step, name, value, unit, formula }: &Line) {
    let step = step.map_or_else(String::new, |step| step.to_string());
    let name = left(&format!("  {step:1} {name}"), MARGIN);
    let [x, y, z] = value.map(fixed);
    let unit = left(unit, UNIT);
    let mut formula = formula.iter();
    let first = formula.next().map_or("", String::as_str);
    let equals = if step.is_empty() && first.starts_with("from") { "" } else { "= " };
    let style = if equals.is_empty() { QUIET } else { FORMULA };
    let _ = writeln!(text, "{name}{x}{y}{z}  {QUIET}{unit}{QUIET:#}{style}{equals}{first}{style:#}");
    let margin = " ".repeat(MARGIN + 3 * WIDTH + 2 + UNIT);
    for more in formula {
        let _ = writeln!(text, "{margin}{FORMULA}{more}{FORMULA:#}");
    }
}

/// Step 7: one number, in the column of z, for it is the z element.
fn write_torque(text: &mut String, i: usize, kind: JointKind, tau: f64) {
    let (unit, wrench) = match kind {
        JointKind::Revolute => ("N m", 'n'),
        JointKind::Prismatic => ("N", 'f'),
    };
    let name = left(&format!("  7 τ{i}"), MARGIN + 2 * WIDTH);
    let (tau, unit) = (fixed(tau), left(unit, UNIT));
    let _ = writeln!(
        text,
        "{name}{TITLE}{tau}{TITLE:#}  {QUIET}{unit}{QUIET:#}{FORMULA}= e · {wrench}{},{i}{FORMULA:#}",
        i - 1
    );
}

/// One link of the worksheet, as JSON has it.
#[derive(Serialize)]
pub(crate) struct Entry<'a> {
    link: usize,
    joint: &'a str,
    sin: f64,
    cos: f64,
    rotation: [[f64; 3]; 3],
    d: [f64; 3],
    r: [f64; 3],
    omega: [f64; 3],
    omega_dot: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
    gravity: [f64; 3],
    inertia_force: [f64; 3],
    inertia_moment: [f64; 3],
    joint_force: [f64; 3],
    joint_moment: [f64; 3],
    tau: f64,
}

/// The worksheet for programs: an entry per link, base to tip, named as in the runtime.
pub(crate) fn entries<'a>(robot: &'a Robot, links: &[LinkTrace<f64>]) -> Vec<Entry<'a>> {
    let entry = |(index, (link, joint)): (usize, (&LinkTrace<f64>, &'a Joint))| Entry {
        link: index + 1,
        joint: &joint.name,
        sin: link.sin,
        cos: link.cos,
        rotation: link.rotation,
        d: link.d,
        r: link.r,
        omega: link.omega,
        omega_dot: link.omega_dot,
        velocity: link.velocity,
        acceleration: link.acceleration,
        gravity: link.gravity,
        inertia_force: link.inertia_force,
        inertia_moment: link.inertia_moment,
        joint_force: link.joint_force,
        joint_moment: link.joint_moment,
        tau: link.tau,
    };
    links.iter().zip(&robot.joints).enumerate().map(entry).collect()
}
