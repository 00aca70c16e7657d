//! Writes results of functions as text: a line for each joint, matrices with the names of their joints, poses,
//! wrenches.

use std::fmt::Write as _;

use rne_codegen::OfRobot as _;
use rne_codegen::{Answer, Argument, Function, Labels, MatrixUnit, Shape};
use rne_model::{INERTIAL_PARAMETERS, Inertia, InertiaElement, JointKind, Robot, exact_digits};

use crate::palette::{QUIET, TITLE};
use crate::render::layout::{Align, columns, left, width};
use crate::render::payload::link_with_tip;
use crate::values::definite::{NOT_DEFINITE, is_indefinite};
use crate::values::numbers::{at_the_point, rounded};
use crate::values::state::State;

/// Decimals of the numbers in a matrix.
const DIGITS: usize = 6;

/// Decimals of the numbers in a row of ten parameters.
const FEW_DIGITS: usize = 4;

/// The names of the six velocities of a floating base.
const OF_BASE: [&str; 6] = ["x", "y", "z", "about x", "about y", "about z"];

/// Writes the numbers that a function returns.
pub(crate) fn text(robot: &Robot, state: &State, numbers: &[f64]) -> String {
    let frame = state.function.frame(robot).map(|frame| robot.frame_name(frame));
    let at = frame.map(|frame| format!(" at the frame {frame}")).unwrap_or_default();
    let mut text = format!("{TITLE}{}{TITLE:#} of {}{at}\n", state.function, robot.name);
    let joints: Vec<String> = robot.independent_joints().map(|joint| joint.name.clone()).collect();
    match state.function.answer() {
        Answer::Torques | Answer::Accelerations => per_joint(&mut text, robot, state, numbers),
        Answer::Number(unit) => {
            let number = numbers.iter().copied().map(exact_digits).collect::<String>();
            let _ = writeln!(text, "  {number} {unit}");
        }
        Answer::Tables(tables) => {
            let mut numbers = numbers;
            for (index, table) in tables.iter().enumerate() {
                if index > 0 {
                    text.push('\n');
                }
                let labels = |labels: &Labels| match labels {
                    Labels::Joints => joints.clone(),
                    Labels::BaseAndJoints => OF_BASE.map(str::to_owned).into_iter().chain(joints.clone()).collect(),
                    Labels::Names(names) => names.iter().map(|&name| name.to_owned()).collect(),
                    Labels::Passive => {
                        let passive = robot.closed.passive.iter();
                        passive.map(|&joint| robot.joints[joint].name.clone()).collect()
                    }
                    Labels::Equations => {
                        let equations = robot.closed.loops.iter().flat_map(|closed| {
                            (1..=closed.cut.equations()).map(move |equation| format!("{} {equation}", closed.name))
                        });
                        equations.collect()
                    }
                    Labels::OfTips(names) => {
                        let tips = robot.tip_names().into_iter();
                        tips.flat_map(|tip| names.iter().map(move |name| format!("{tip} {name}"))).collect()
                    }
                };
                let (rows, columns) = (labels(&table.rows), labels(&table.columns));
                let (of_table, rest) = numbers.split_at((rows.len() * columns.len()).min(numbers.len()));
                numbers = rest;
                let units = table.unit.map(|unit| Kinds::of(robot).units(unit));
                let about = match frame {
                    Some(frame) => table.about.replace("the tip", frame),
                    None => table.about.to_owned(),
                };
                let about = [Some(about.as_str()).filter(|about| !about.is_empty()), units];
                let about = about.into_iter().flatten().collect::<Vec<_>>().join(", ");
                Table { about: &about, rows: &rows, columns: &columns, numbers: of_table, digits: DIGITS }
                    .write(&mut text);
            }
        }
        Answer::Poses => match state.function.shape() {
            Shape::Array(..) => poses(&mut text, &joints, numbers),
            _ => poses(&mut text, &[frame.unwrap_or("tip").to_owned()], numbers),
        },
        Answer::PerParameter => regressor(&mut text, state.function, &joints, numbers),
    }
    text
}

/// Writes the state and the result, a line for each joint, with all digits.
fn per_joint(text: &mut String, robot: &Robot, state: &State, result: &[f64]) {
    let forward = state.function.returns_accelerations();
    let takes = |argument| state.function.takes(argument);
    let given = state.function.arguments().iter();
    let given = given.filter_map(|argument| Some((argument.name(), state.of_joints(*argument)?)));
    let all = given.chain([(if forward { "qdd" } else { "tau" }, result)]);
    let mut cells = vec![vec![String::new()]];
    cells.extend(robot.independent_joints().map(|joint| vec![format!("  {}", joint.name)]));
    for (title, values) in all {
        let numbers: Vec<String> = values.iter().copied().map(exact_digits).collect();
        let column = std::iter::once(title.to_owned()).chain(at_the_point(&numbers));
        cells.iter_mut().zip(column).for_each(|(line, cell)| line.push(cell));
    }
    for (line, joint) in cells.iter_mut().skip(1).zip(robot.independent_joints()) {
        line.push(unit(joint.row.kind, forward).to_owned());
    }
    write_lines(text, &cells);
    if let Some(wrench) = &state.wrench {
        let frame = state.function.frame(robot).map(|frame| robot.frame_name(frame));
        let link = frame.map_or_else(|| link_with_tip(robot), |frame| format!("the link of {frame}, in its axes,"));
        let _ = writeln!(text, "{QUIET}{link} exerts {}{QUIET:#}", exerted(&wrench.force, &wrench.moment));
    }
    for (tip, wrench) in robot.tip_names().iter().zip(&state.wrenches) {
        let _ = writeln!(text, "{QUIET}tip {tip} exerts {}{QUIET:#}", exerted(&wrench.force, &wrench.moment));
    }
    if let Some(payload) = &state.payload {
        let (mass, com) = (exact_digits(payload.mass), list(&payload.com));
        let _ = writeln!(text, "{QUIET}the tip carries {mass} kg with its centre at ({com}) m{QUIET:#}");
        if payload.inertia != Inertia::default() {
            let elements = InertiaElement::ALL.map(|element| exact_digits(*element.of(&payload.inertia))).join(", ");
            let _ = writeln!(text, "{QUIET}and the inertia xx, yy, zz, xy, xz, yz = {elements} kg m²{QUIET:#}");
        }
    }
    if takes(Argument::Passive) {
        let passive = robot.closed.passive.iter().zip(&state.passive);
        let named = passive.map(|(&joint, &at)| format!("{} = {}", robot.joints[joint].name, exact_digits(at)));
        let named = named.collect::<Vec<_>>().join(", ");
        let _ = writeln!(text, "{QUIET}the dependent joints of the loops are at {named} (rad, prismatic: m){QUIET:#}");
    }
    if takes(Argument::Step) {
        let _ = writeln!(text, "{QUIET}the step takes {} s{QUIET:#}", exact_digits(state.step));
    }
    if takes(Argument::BaseVelocity) {
        let omega = list(&state.base.omega);
        let _ = writeln!(text, "{QUIET}the base turns with ({omega}) rad/s, in frame 0{QUIET:#}");
    }
    if takes(Argument::BaseRotation) {
        let [x, y, z] = state.base_rotation.map(|row| list(&row));
        let _ = writeln!(text, "{QUIET}the rows of the rotation of the base are ({x}), ({y}), ({z}){QUIET:#}");
    }
    if takes(Argument::Base) {
        let base = &state.base;
        let [omega, omega_dot, acceleration, gravity] =
            [base.omega, base.omega_dot, base.acceleration, base.gravity].map(|vector| list(&vector));
        let _ = writeln!(text, "{QUIET}the base turns with ({omega}) rad/s, ({omega_dot}) rad/s² and accelerates with");
        let _ = writeln!(text, "({acceleration}) m/s², gravity is ({gravity}) m/s², all in frame 0{QUIET:#}");
    }
}

/// Writes a force and a moment with their units.
fn exerted(force: &[f64; 3], moment: &[f64; 3]) -> String {
    format!("({}) N, ({}) N m", list(force), list(moment))
}

/// Writes three numbers with commas between them.
pub(crate) fn list(values: &[f64; 3]) -> String {
    values.map(exact_digits).join(", ")
}

const fn unit(kind: JointKind, acceleration: bool) -> &'static str {
    match (kind, acceleration) {
        (kind, false) => kind.effort_unit(),
        (JointKind::Revolute, true) => "rad/s²",
        (JointKind::Prismatic, true) => "m/s²",
    }
}

fn axes() -> [String; 3] {
    ["x", "y", "z"].map(str::to_owned)
}

/// Writes poses: the columns of each rotation are the axes of the frame, and beside them is its origin.
fn poses(text: &mut String, frames: &[String], numbers: &[f64]) {
    let about = "axes of the frame and its origin (m), in the world";
    let widest = frames.iter().map(|frame| width(frame)).max().unwrap_or(0);
    let mut rows = Vec::new();
    let mut elements = Vec::new();
    for (frame, pose) in frames.iter().zip(numbers.chunks_exact(12)) {
        let (rotation, origin) = pose.split_at(9);
        let names = [frame, "", ""];
        for (((axis, name), row), origin) in axes().iter().zip(names).zip(rotation.chunks_exact(3)).zip(origin) {
            rows.push(format!("{}  {axis}", left(name, widest)));
            elements.extend(row.iter().chain([origin]));
        }
    }
    let columns = ["x axis", "y axis", "z axis", "origin"].map(str::to_owned);
    Table { about, rows: &rows, columns: &columns, numbers: &elements, digits: DIGITS }.write(text);
}

/// Writes a regressor as a table for each torque, with a line for each link that contributes to it; tables of the force
/// and moment on a floating base come first.
fn regressor(text: &mut String, function: Function, joints: &[String], numbers: &[f64]) {
    let columns = INERTIAL_PARAMETERS.map(|name| name.replacen("mc", "m c", 1));
    let floats = function.is_of_floating_base();
    let on_base = OF_BASE.iter().filter(|_| floats).enumerate();
    let on_base = on_base.map(|(row, axis)| {
        let (what, axis) = if row < 3 { ("force along", *axis) } else { ("moment", *axis) };
        format!("{what} {axis} on the base")
    });
    let torques: Vec<String> = on_base.chain(joints.iter().map(|joint| format!("torque of {joint}"))).collect();
    let body = |index: usize| match index.checked_sub(usize::from(floats)) {
        Some(link) => format!("link {}", link + 1),
        None => "base".to_owned(),
    };
    let per_torque = (usize::from(floats) + joints.len()) * INERTIAL_PARAMETERS.len();
    for (row, torque) in torques.iter().zip(numbers.chunks_exact(per_torque.max(1))) {
        let links: Vec<(String, &[f64])> = torque
            .chunks_exact(INERTIAL_PARAMETERS.len())
            .enumerate()
            .filter(|(_, link)| link.iter().any(|number| *number != 0.0))
            .map(|(index, link)| (body(index), link))
            .collect();
        let about = format!("{row} per parameter");
        if links.is_empty() {
            let _ = writeln!(text, "{QUIET}{about}: none{QUIET:#}");
            continue;
        }
        let (rows, numbers): (Vec<String>, Vec<&[f64]>) = links.into_iter().unzip();
        Table { about: &about, rows: &rows, columns: &columns, numbers: &numbers.concat(), digits: FEW_DIGITS }
            .write(text);
    }
    let _ = writeln!(
        text,
        "{QUIET}links that are not listed do not enter; c and J from the link frame's origin, in its axes{QUIET:#}"
    );
}

/// Numbers in rows and columns with names.
struct Table<'a> {
    /// Description and units of the numbers.
    about: &'a str,
    rows: &'a [String],
    columns: &'a [String],
    /// The numbers, row by row.
    numbers: &'a [f64],
    digits: usize,
}

impl Table<'_> {
    fn write(&self, text: &mut String) {
        let _ = writeln!(text, "{QUIET}{}{QUIET:#}", self.about);
        let mut cells = vec![vec![String::new()]];
        cells.extend(self.rows.iter().map(|row| vec![format!("  {row}")]));
        for (index, title) in self.columns.iter().enumerate() {
            let numbers = self.numbers.iter().skip(index).step_by(self.columns.len());
            let numbers: Vec<String> = numbers.map(|&number| rounded(number, self.digits)).collect();
            let column = std::iter::once(title.clone()).chain(at_the_point(&numbers));
            cells.iter_mut().zip(column).for_each(|(line, cell)| line.push(cell));
        }
        write_lines(text, &cells);
    }
}

/// Writes lines of cells; the first line has the titles.
fn write_lines(text: &mut String, cells: &[Vec<String>]) {
    let most = cells.iter().map(Vec::len).max().unwrap_or(0);
    for (index, line) in columns(&vec![Align::Left; most], cells).iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "{QUIET}{line}{QUIET:#}"),
            _ => writeln!(text, "{line}"),
        };
    }
}

/// The kinds of joints that a robot has, which determine the units of its matrices.
enum Kinds {
    Revolute,
    Prismatic,
    Both,
}

impl Kinds {
    fn of(robot: &Robot) -> Self {
        let revolute = robot.independent_joints().filter(|joint| joint.row.kind == JointKind::Revolute).count();
        match revolute {
            0 => Self::Prismatic,
            all if all == robot.dof() => Self::Revolute,
            _ => Self::Both,
        }
    }

    const fn units(&self, of: MatrixUnit) -> &'static str {
        match (of, self) {
            (MatrixUnit::Mass, Self::Revolute) => "kg m²",
            (MatrixUnit::Mass, Self::Prismatic) => "kg",
            (MatrixUnit::Mass, Self::Both) => {
                "kg m² between revolute joints, kg between prismatic ones, kg m between the kinds"
            }
            (MatrixUnit::PerPosition, Self::Revolute) => "N m/rad",
            (MatrixUnit::PerPosition, Self::Prismatic) => "N/m",
            (MatrixUnit::PerPosition, Self::Both) => "N m or N of the row per rad or m of the column",
            (MatrixUnit::PerRate, Self::Revolute) => "N m s/rad",
            (MatrixUnit::PerRate, Self::Prismatic) => "N s/m",
            (MatrixUnit::PerRate, Self::Both) => "N m or N of the row per rad/s or m/s of the column",
        }
    }
}

/// Explains why a result is not a finite number.
pub(crate) fn not_finite(robot: &Robot, function: Function, index: usize, q: &[f64]) -> String {
    let joint = |index: usize| {
        let name = robot.independent_joints().nth(index).map_or("", |joint| &joint.name);
        format!("joint {} ({name})", index + 1)
    };
    if is_indefinite(robot, function, [q, &[]], None) {
        return format!("the result of {function} is not finite: {NOT_DEFINITE}");
    }
    if let Some(meaning) = function.divides() {
        return meaning.to_owned();
    }
    if *function.answer() == Answer::Torques {
        return format!("the torque of {} overflows: the state is too large", joint(index));
    }
    format!("{function} overflows: the state is too large")
}
