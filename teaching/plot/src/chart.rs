//! Draws a torque history: a panel for each joint with its torque and its parts, and one panel with powers.
//!
//! The background is light, letters are large enough for the last row of a lecture room, and the colours are those of
//! Okabe and Ito, which colour-blind people can distinguish; dashes distinguish lines without colours. The picture has
//! no scripts, fonts or other files.

use rne_model::Robot;

use crate::elements::{Curve, Svg, TEXT, WIDTH, pixels, shortened, subscript, width_of};
use crate::history::{Peak, TorqueHistory};
use crate::parts::TorqueParts;
use crate::scale::{Scale, label, range, significant};
use crate::trajectory::Trajectory;

/// Margin, height of the head, and height of a panel, pixels.
pub(crate) const SIDE: f64 = 40.0;
pub(crate) const HEAD: f64 = 132.0;
pub(crate) const PANEL: f64 = 262.0;
const POWERS: f64 = 330.0;
/// Space left of a panel's axes for numbers, above them for the title, and below them for times, pixels.
const LEFT: f64 = 64.0;
const ABOVE: f64 = 40.0;
const BELOW: f64 = 44.0;
pub(crate) const GAP: f64 = 24.0;

pub(crate) const QUIET: &str = "#595959";
const GRID: &str = "#e4e4e4";
const ZERO: &str = "#9a9a9a";

/// The colours of Okabe and Ito without yellow, which is hard to see on a light background. Black is for the total.
pub(crate) const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#7a5195"];
/// Dashes of lines, for when the colours repeat.
const DASHES: [&str; 4] = ["", "9 4", "2 4", "11 4 2 4"];

/// Returns an SVG, 1280 pixels wide, of the torques and powers of a robot along a trajectory: for each joint its torque
/// in N m (N for a prismatic joint) with the inertia, velocity and gravity parts and its peak, then all powers in W,
/// over time in seconds. `about` describes the trajectory. Texts of the robot file are escaped.
#[must_use]
pub fn svg(robot: &Robot, trajectory: &Trajectory, history: &TorqueHistory, about: &str) -> String {
    let columns = if robot.dof() == 1 { 1 } else { 2 };
    let rows = robot.dof().div_ceil(columns);
    #[allow(clippy::cast_precision_loss)] // at most 64 joints
    let (columns_f, rows_f) = (columns as f64, rows as f64);
    let height = HEAD + rows_f * PANEL + POWERS + 12.0;
    let title = robot.title.as_deref().unwrap_or(&robot.name);
    let mut svg = Svg::with_root(&format!("Torques of {title}"), height);
    svg.text(SIDE, 46.0, &[("font-size", "26"), ("font-weight", "600")], &shortened(title, 72));
    svg.text(SIDE, 74.0, &[("font-size", "16"), ("fill", QUIET)], &shortened(about, 130));
    legend(&mut svg);

    let wide = (WIDTH - 2.0 * SIDE - (columns_f - 1.0) * GAP) / columns_f;
    for joint in 0..robot.dof() {
        #[allow(clippy::cast_precision_loss)]
        let (column, row) = ((joint % columns) as f64, (joint / columns) as f64);
        let place = Place { x: SIDE + column * (wide + GAP), y: HEAD + row * PANEL, width: wide, height: PANEL };
        torque_panel(&mut svg, place, robot, joint, trajectory, history);
    }
    let place = Place { x: SIDE, y: HEAD + rows_f * PANEL, width: WIDTH - 2.0 * SIDE, height: POWERS };
    power_panel(&mut svg, place, robot, trajectory, history);
    svg.close("svg");
    svg.finish()
}

const PARTS: [(&str, &str, &str, f64); 4] = [
    ("inertia, M(q) q̈", COLOURS[0], "", 2.2),
    ("Coriolis and centrifugal, C(q, q̇) q̇", COLOURS[1], "9 4", 2.2),
    ("gravity, g(q)", COLOURS[2], "2 4", 2.4),
    ("torque τ, their sum", TEXT, "", 3.2),
];

fn legend(svg: &mut Svg) {
    let mut x = SIDE;
    for &(name, colour, dash, width) in PARTS.iter().rev() {
        svg.stroke(x, 104.0, x + 38.0, 104.0, colour, dash, width);
        svg.text(x + 46.0, 109.0, &[("font-size", "16")], name);
        x += 46.0 + width_of(name, 16.0) + 30.0;
    }
}

/// Position and size of a panel, including axes and numbers.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

fn torque_panel(
    svg: &mut Svg,
    place: Place,
    robot: &Robot,
    joint: usize,
    trajectory: &Trajectory,
    history: &TorqueHistory,
) {
    let curve = |part: fn(&TorqueParts) -> &Vec<f64>| history.parts.iter().map(|parts| part(parts)[joint]).collect();
    let values: [Vec<f64>; 4] = [
        curve(|parts| &parts.inertia),
        curve(|parts| &parts.velocity),
        curve(|parts| &parts.gravity),
        curve(|parts| &parts.total),
    ];
    let curves: Vec<Curve<'_>> = PARTS
        .iter()
        .zip(values)
        .map(|(&(name, colour, dash, width), values)| Curve { name, colour, dash, width, values })
        .collect();
    let Some(of_joint) = robot.independent_joint(joint) else { return };
    let unit = of_joint.row.kind.effort_unit();
    let name = shortened(&of_joint.name, 18);
    let axes = panel(svg, place, &format!("τ{} {name}, {unit}", subscript(joint + 1)), &trajectory.time, &curves);
    if let Some(peak) = history.peaks.get(joint) {
        mark(svg, place, axes, *peak, unit);
    }
}

/// Marks the peak of a torque, and the part of it that velocities cause.
fn mark(svg: &mut Svg, place: Place, (across, up): (Scale, Scale), peak: Peak, unit: &str) {
    let (x, y) = (across.at(peak.time), up.at(peak.tau));
    let share = 100.0 * peak.velocity_share;
    let share = if share > 0.0 && share < 1.0 { "under 1".to_owned() } else { format!("{share:.0}") };
    let words = format!(
        "peak {} {unit} at {} s, velocity terms {share} %",
        significant(peak.tau, 3),
        significant(peak.time, 3)
    );
    svg.open(
        "circle",
        &[
            ("cx", pixels(x).as_str()),
            ("cy", &pixels(y)),
            ("r", "6"),
            ("fill", "#ffffff"),
            ("stroke", TEXT),
            ("stroke-width", "2.6"),
        ],
    );
    svg.words("title", &[], &words);
    svg.close("circle");
    svg.text(place.x + place.width, place.y + 26.0, &[("text-anchor", "end"), ("fill", QUIET)], &words);
}

fn power_panel(svg: &mut Svg, place: Place, robot: &Robot, trajectory: &Trajectory, history: &TorqueHistory) {
    let names: Vec<String> = robot.independent_joints().map(|joint| shortened(&joint.name, 18)).collect();
    let mut curves: Vec<Curve<'_>> = names
        .iter()
        .enumerate()
        .map(|(joint, name)| Curve {
            name,
            colour: COLOURS[joint % COLOURS.len()],
            dash: DASHES[(joint / COLOURS.len()) % DASHES.len()],
            width: 2.2,
            values: history.powers.iter().map(|powers| powers[joint]).collect(),
        })
        .collect();
    if robot.dof() > 1 {
        let values = history.powers.iter().map(|powers| powers.iter().sum()).collect();
        curves.push(Curve { name: "all joints", colour: TEXT, dash: "", width: 3.2, values });
    }
    // the names are between the title and the axes, on as many lines as needed
    let mut lines = vec![Vec::new()];
    let mut x = place.x;
    for curve in &curves {
        let needed = 38.0 + width_of(curve.name, 15.0) + 22.0;
        if x + needed > place.x + place.width && !lines.last().is_none_or(Vec::is_empty) {
            lines.push(Vec::new());
            x = place.x;
        }
        if let Some(line) = lines.last_mut() {
            line.push((x, curve));
        }
        x += needed;
    }
    // at most four lines, even for 64 joints
    let shown = lines.len().min(4);
    #[allow(clippy::cast_precision_loss)]
    let below = 22.0 * shown as f64;
    for (index, line) in lines.iter().take(shown).enumerate() {
        #[allow(clippy::cast_precision_loss)]
        let y = place.y + ABOVE + 2.0 + 22.0 * index as f64;
        for (x, curve) in line {
            svg.stroke(*x, y, x + 30.0, y, curve.colour, curve.dash, curve.width);
            svg.text(x + 38.0, y + 5.0, &[], curve.name);
        }
    }
    svg.text(
        place.x,
        place.y + 24.0,
        &[("font-size", "17"), ("font-weight", "600")],
        "power τ q̇, W: positive drives, negative brakes",
    );
    let inner = Place { y: place.y + below, height: place.height - below, ..place };
    panel(svg, inner, "", &trajectory.time, &curves);
}

/// Draws axes with their grid, and the curves; returns the scales.
pub(crate) fn panel(svg: &mut Svg, place: Place, title: &str, time: &[f64], curves: &[Curve<'_>]) -> (Scale, Scale) {
    let values = curves.iter().flat_map(|curve| curve.values.iter().copied());
    let (across, up, _) = axes(svg, place, title, Ticks::Seconds, time, values);
    for curve in curves {
        svg.curve(curve, time, across, up);
    }
    (across, up)
}

/// Kind of labels below the axes.
#[derive(Clone, Copy)]
pub(crate) enum Ticks<'a> {
    /// Times, s.
    Seconds,
    /// A name for each position, side by side.
    Names(&'a [String]),
}

/// Draws axes with their grid for values over times; returns the scales, and the vertical ends [top, bottom].
pub(crate) fn axes(
    svg: &mut Svg,
    place: Place,
    title: &str,
    ticks: Ticks<'_>,
    time: &[f64],
    values: impl Iterator<Item = f64>,
) -> (Scale, Scale, [f64; 2]) {
    const ABOUT_UP: f64 = 5.0;
    let (left, right) = (place.x + LEFT, place.x + place.width);
    let (top, bottom) = (place.y + ABOVE, place.y + place.height - BELOW);
    let (start, end) = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(1.0));
    // leaves space on both sides of a name
    let beside = if matches!(ticks, Ticks::Names(_)) { 0.5 } else { 0.0 };
    let across = Scale::new(start - beside, end + beside, left, right);
    let (low, high) = range(values, ABOUT_UP);
    let up = Scale::new(low, high, bottom, top);
    if !title.is_empty() {
        svg.text(place.x, place.y + 26.0, &[("font-size", "17"), ("font-weight", "600")], title);
    }
    for (tick, words) in labels(ticks, time, across, place.width) {
        let x = across.at(tick);
        svg.stroke(x, top, x, bottom, GRID, "", 1.0);
        svg.text(x, bottom + 19.0, &[("text-anchor", "middle"), ("fill", QUIET)], &words);
    }
    for tick in up.ticks(ABOUT_UP) {
        let y = up.at(tick);
        let colour = if tick == 0.0 { ZERO } else { GRID };
        svg.stroke(left, y, right, y, colour, "", if tick == 0.0 { 1.4 } else { 1.0 });
        svg.text(left - 9.0, y + 5.0, &[("text-anchor", "end"), ("fill", QUIET)], &label(tick));
    }
    if matches!(ticks, Ticks::Seconds) {
        svg.text(left - 20.0, bottom + 19.0, &[("text-anchor", "end"), ("fill", QUIET)], "t, s");
    }
    (across, up, [top, bottom])
}

/// Returns the ticks of the horizontal axis with their labels: only as many names as there is space for.
fn labels(ticks: Ticks<'_>, time: &[f64], across: Scale, width: f64) -> Vec<(f64, String)> {
    const LONGEST: usize = 24;
    match ticks {
        Ticks::Seconds => {
            let about = if width > 800.0 { 10.0 } else { 6.0 };
            across.ticks(about).into_iter().map(|tick| (tick, label(tick))).collect()
        }
        Ticks::Names(names) => {
            let names: Vec<String> = names.iter().map(|name| shortened(name, LONGEST)).collect();
            let widest = names.iter().map(|name| width_of(name, 15.0)).fold(1.0, f64::max) + 16.0;
            #[allow(clippy::cast_precision_loss)] // a number of logs
            let apart = (width - LEFT) / names.len().max(1) as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
            let every = (widest / apart).ceil().max(1.0) as usize;
            time.iter().copied().zip(names).step_by(every).collect()
        }
    }
}
