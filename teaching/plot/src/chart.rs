//! The picture of a torque history: a panel for each joint with its torque and what it is made of, and one of powers.
//!
//! Light background, letters that are read from the last row, and the colours of Okabe and Ito, which the colour-blind
//! tell apart; dashes tell them apart where there is no colour. No script, no font, no file beside it.

use std::fmt::Write as _;
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesEnd, BytesStart, BytesText, Event};
use rne_model::{Robot, one_line};

use crate::history::{Peak, TorqueHistory};
use crate::parts::TorqueParts;
use crate::scale::{Scale, label, range, significant};
use crate::trajectory::Trajectory;

/// Pixels.
pub(crate) const WIDTH: f64 = 1280.0;
pub(crate) const SIDE: f64 = 40.0;
pub(crate) const HEAD: f64 = 132.0;
pub(crate) const PANEL: f64 = 262.0;
const POWERS: f64 = 330.0;
/// Left of a panel's axes for numbers, above them for its title, below them for times.
const LEFT: f64 = 64.0;
const ABOVE: f64 = 40.0;
const BELOW: f64 = 44.0;
pub(crate) const GAP: f64 = 24.0;

pub(crate) const TEXT: &str = "#222222";
pub(crate) const QUIET: &str = "#595959";
const GRID: &str = "#e4e4e4";
const ZERO: &str = "#9a9a9a";

/// Okabe and Ito, without yellow, which light backgrounds swallow; black is the total.
pub(crate) const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#7a5195"];
/// Dashes of the lines that have a colour again.
const DASHES: [&str; 4] = ["", "9 4", "2 4", "11 4 2 4"];

/// More points than pixels tell nothing.
const BUCKETS: usize = 640;

/// A line of a panel.
pub(crate) struct Curve<'a> {
    pub(crate) name: &'a str,
    pub(crate) colour: &'a str,
    pub(crate) dash: &'a str,
    pub(crate) width: f64,
    pub(crate) values: Vec<f64>,
}

/// The torques and powers of a robot along a trajectory as an SVG of 1280 pixels width: for each joint its torque in
/// N m (N where it slides) with the inertia, velocity and gravity parts and its peak, then all powers in W, over time
/// in seconds. `about` says what the trajectory is. Texts of the robot file are shown and do nothing.
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

/// Where a panel stands, axes, numbers and all.
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

/// The peak of a torque, and how much of it comes of velocities.
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
    // the names stand between the title and the axes, on as many lines as they need
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
    // of 64 joints some lines have room
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

/// Axes with their grid, and the curves; returns the scales.
pub(crate) fn panel(svg: &mut Svg, place: Place, title: &str, time: &[f64], curves: &[Curve<'_>]) -> (Scale, Scale) {
    let values = curves.iter().flat_map(|curve| curve.values.iter().copied());
    let (across, up, _) = axes(svg, place, title, Ticks::Seconds, time, values);
    for curve in curves {
        svg.curve(curve, time, across, up);
    }
    (across, up)
}

/// Labels below the axes.
#[derive(Clone, Copy)]
pub(crate) enum Ticks<'a> {
    /// Times, s.
    Seconds,
    /// A name for each place, side by side.
    Names(&'a [String]),
}

/// Axes with their grid for values over times; returns the scales, and where the axes are between: [top, bottom].
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
    // a name has room on both sides of its place
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

/// The ticks of the axis across with their words: of many names as many as have room.
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

/// The samples of a curve that a picture shows: of each stretch the first, the least, the largest and the last.
fn kept(values: &[f64]) -> Vec<usize> {
    if values.len() <= 2 * BUCKETS {
        return (0..values.len()).collect();
    }
    let mut kept = Vec::new();
    let stretch = values.len().div_ceil(BUCKETS);
    for (index, chunk) in values.chunks(stretch).enumerate() {
        let start = index * stretch;
        let by = |order: fn(f64, f64) -> bool| {
            let better = |best: usize, next: usize| if order(chunk[next], chunk[best]) { next } else { best };
            (0..chunk.len()).reduce(better).unwrap_or(0)
        };
        let mut of_chunk = [0, by(|a, b| a < b), by(|a, b| a > b), chunk.len() - 1];
        of_chunk.sort_unstable();
        kept.extend(of_chunk.map(|at| start + at));
    }
    kept.dedup();
    kept
}

/// Elements, written one after the other.
pub(crate) struct Svg {
    writer: Writer<Vec<u8>>,
    /// Writing to memory does not fail; if it does, the picture is empty.
    failed: bool,
}

impl Svg {
    pub(crate) fn new() -> Self {
        Self { writer: Writer::new_with_indent(Vec::new(), b' ', 1), failed: false }
    }

    /// A white picture of `height` pixels; `name` is its title for readers who do not see it.
    pub(crate) fn with_root(name: &str, height: f64) -> Self {
        let mut svg = Self::new();
        let size = format!("0 0 {} {}", pixels(WIDTH), pixels(height));
        let root = [
            ("xmlns", "http://www.w3.org/2000/svg"),
            ("viewBox", size.as_str()),
            ("width", &pixels(WIDTH)),
            ("height", &pixels(height)),
            ("role", "img"),
            ("font-family", "Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"),
            ("font-size", "15"),
            ("fill", TEXT),
        ];
        svg.open("svg", &root);
        svg.words("title", &[], name);
        svg.empty("rect", &[("width", "100%"), ("height", "100%"), ("fill", "#ffffff")]);
        svg
    }

    pub(crate) fn event(&mut self, event: Event<'_>) {
        let written: io::Result<()> = self.writer.write_event(event);
        self.failed |= written.is_err();
    }

    pub(crate) fn open(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.event(Event::Start(BytesStart::new(name).with_attributes(attributes.iter().copied())));
    }

    pub(crate) fn close(&mut self, name: &str) {
        self.event(Event::End(BytesEnd::new(name)));
    }

    pub(crate) fn empty(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.event(Event::Empty(BytesStart::new(name).with_attributes(attributes.iter().copied())));
    }

    pub(crate) fn words(&mut self, name: &str, attributes: &[(&str, &str)], words: &str) {
        self.open(name, attributes);
        self.event(Event::Text(BytesText::new(&plain(words))));
        self.close(name);
    }

    pub(crate) fn text(&mut self, x: f64, y: f64, attributes: &[(&str, &str)], words: &str) {
        let (x, y) = (pixels(x), pixels(y));
        let place = [("x", x.as_str()), ("y", y.as_str())];
        let all: Vec<(&str, &str)> = place.into_iter().chain(attributes.iter().copied()).collect();
        self.words("text", &all, words);
    }

    #[allow(clippy::too_many_arguments)] // two points and how they are joined
    pub(crate) fn stroke(&mut self, x1: f64, y1: f64, x2: f64, y2: f64, colour: &str, dash: &str, width: f64) {
        let [x1, y1, x2, y2, width] = [x1, y1, x2, y2, width].map(pixels);
        let mut attributes = vec![
            ("x1", x1.as_str()),
            ("y1", &y1),
            ("x2", &x2),
            ("y2", &y2),
            ("stroke", colour),
            ("stroke-width", &width),
        ];
        if !dash.is_empty() {
            attributes.push(("stroke-dasharray", dash));
        }
        self.empty("line", &attributes);
    }

    pub(crate) fn curve(&mut self, curve: &Curve<'_>, time: &[f64], across: Scale, up: Scale) {
        let mut points = String::new();
        for at in kept(&curve.values) {
            let gap = if points.is_empty() { "" } else { " " };
            let _ = write!(points, "{gap}{},{}", pixels(across.at(time[at])), pixels(up.at(curve.values[at])));
        }
        let width = pixels(curve.width);
        let mut attributes = vec![
            ("points", points.as_str()),
            ("fill", "none"),
            ("stroke", curve.colour),
            ("stroke-width", &width),
            ("stroke-linejoin", "round"),
        ];
        if !curve.dash.is_empty() {
            attributes.push(("stroke-dasharray", curve.dash));
        }
        self.open("polyline", &attributes);
        self.words("title", &[], curve.name);
        self.close("polyline");
    }

    pub(crate) fn finish(self) -> String {
        let text = String::from_utf8(self.writer.into_inner()).unwrap_or_default();
        if self.failed { String::new() } else { text + "\n" }
    }
}

/// A text in which every character may stand in XML and none does anything.
fn plain(text: &str) -> String {
    one_line(text).replace(['\u{FFFE}', '\u{FFFF}'], "\u{FFFD}")
}

/// A text of at most `most` characters.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    let text = plain(text);
    if text.chars().count() <= most { text } else { text.chars().take(most - 1).chain(['…']).collect() }
}

/// Pixels in hundredths.
pub(crate) fn pixels(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    format!("{}", rounded + 0.0)
}

/// About how wide a text is: fonts differ, and a legend has gaps for that.
pub(crate) fn width_of(text: &str, size: f64) -> f64 {
    let width = |c: char| match c {
        '\u{300}'..='\u{36F}' => 0.0,
        'i' | 'j' | 'l' | 't' | 'f' | 'r' | ' ' | ',' | '(' | ')' | '.' => 0.34,
        'm' | 'w' | 'M' | 'W' => 0.86,
        c if c.is_uppercase() => 0.68,
        _ => 0.56,
    };
    size * text.chars().map(width).sum::<f64>()
}

/// ₁₂
pub(crate) fn subscript(number: usize) -> String {
    let digit = |c: char| c.to_digit(10).and_then(|digit| char::from_u32(0x2080 + digit)).unwrap_or(c);
    number.to_string().chars().map(digit).collect()
}
