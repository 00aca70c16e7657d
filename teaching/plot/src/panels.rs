//! Draws panels over the same times: the curves of one joint in each, with limits and marked intervals.

use crate::chart::{COLOURS, HEAD, PANEL, Place, QUIET, SIDE, Ticks, axes};
use crate::clipped::{clipped, edges, room};
use crate::elements::{Curve, Svg, TEXT, WIDTH, pixels, shortened, width_of};

/// A curve of a panel.
#[derive(Clone, Copy, Debug)]
pub struct PanelCurve<'a> {
    /// The name in the legend, the same in every panel. Successive curves with the same name have the same colour and
    /// dash.
    pub name: &'a str,
    /// A value for each time.
    pub values: &'a [f64],
}

/// A marked interval of time.
#[derive(Clone, Debug)]
pub struct Band {
    /// Beginning, s.
    pub start: f64,
    /// End, s.
    pub end: f64,
    /// The text of the tooltip.
    pub words: String,
}

/// A panel: axes with their content.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// Title above the axes, with the unit.
    pub title: String,
    /// Note above the axes, on the right.
    pub note: String,
    /// The curves.
    pub curves: Vec<PanelCurve<'a>>,
    /// Values of horizontal dashed lines.
    pub limits: Vec<f64>,
    /// Curves that may exceed the axes, such as thresholds. They are drawn like the others, but values far outside are
    /// cut off, and the largest one is written at the edge.
    pub bounds: Vec<PanelCurve<'a>>,
    /// Marked intervals.
    pub bands: Vec<Band>,
}

/// Colour of marked intervals, so light that curves are visible on it.
const MARKED: &str = "#f7dfa5";

/// Returns an SVG, 1280 pixels wide, of panels over the same times (s), two in a row. `name` is the title for screen
/// readers, `title` is at the top and `about` below it. Texts are escaped.
#[must_use]
pub fn panels(name: &str, title: &str, about: &str, time: &[f64], panels: &[Panel<'_>]) -> String {
    drawn(Ticks::Seconds, name, title, about, time, panels)
}

/// Draws panels like [`panels`], but over names side by side instead of times.
#[must_use]
pub fn panels_over(names: &[String], name: &str, title: &str, about: &str, panels: &[Panel<'_>]) -> String {
    #[allow(clippy::cast_precision_loss)] // a number of names
    let places: Vec<f64> = (0..names.len()).map(|place| place as f64).collect();
    drawn(Ticks::Names(names), name, title, about, &places, panels)
}

fn drawn(ticks: Ticks<'_>, name: &str, title: &str, about: &str, time: &[f64], panels: &[Panel<'_>]) -> String {
    let columns = if panels.len() == 1 { 1 } else { 2 };
    #[allow(clippy::cast_precision_loss)] // at most some dozens
    let rows = panels.len().div_ceil(columns) as f64;
    let mut svg = Svg::with_root(name, HEAD + rows * PANEL + 12.0);
    svg.text(SIDE, 46.0, &[("font-size", "26"), ("font-weight", "600")], &shortened(title, 72));
    svg.text(SIDE, 74.0, &[("font-size", "16"), ("fill", QUIET)], &shortened(about, 130));
    let mut x = SIDE;
    let first: Vec<PanelCurve<'_>> = panels.first().map_or(Vec::new(), Panel::all);
    let mut named = first.iter().zip(looks(&first)).collect::<Vec<_>>();
    named.dedup_by_key(|(_, index)| *index);
    for (curve, index) in named {
        svg.stroke(x, 104.0, x + 38.0, 104.0, colour(index), dash(index), 2.2);
        svg.text(x + 46.0, 109.0, &[("font-size", "16")], curve.name);
        x += 46.0 + width_of(curve.name, 16.0) + 30.0;
    }
    if panels.iter().any(|panel| !panel.bands.is_empty()) {
        let place = [("x", pixels(x)), ("y", pixels(94.0)), ("width", "38".to_owned()), ("height", "20".to_owned())];
        let place = place.each_ref().map(|(name, value)| (*name, value.as_str()));
        svg.empty("rect", &[&place[..], &[("fill", MARKED)]].concat());
        svg.text(x + 46.0, 109.0, &[("font-size", "16")], "event");
    }
    let gap = 24.0;
    #[allow(clippy::cast_precision_loss)] // 1 or 2
    let wide = (WIDTH - 2.0 * SIDE - (columns as f64 - 1.0) * gap) / columns as f64;
    for (index, panel) in panels.iter().enumerate() {
        #[allow(clippy::cast_precision_loss)] // at most some dozens
        let (column, row) = ((index % columns) as f64, (index / columns) as f64);
        let place = Place { x: SIDE + column * (wide + gap), y: HEAD + row * PANEL, width: wide, height: PANEL };
        draw(&mut svg, place, panel, ticks, time);
    }
    svg.close("svg");
    svg.finish()
}

impl<'a> Panel<'a> {
    /// Returns all curves in the order of the legend.
    fn all(&self) -> Vec<PanelCurve<'a>> {
        self.curves.iter().chain(&self.bounds).copied().collect()
    }
}

fn draw(svg: &mut Svg, place: Place, panel: &Panel<'_>, ticks: Ticks<'_>, time: &[f64]) {
    let all = panel.all();
    let curves: Vec<Curve<'_>> = all
        .iter()
        .zip(looks(&all))
        .map(|(curve, index)| Curve {
            name: curve.name,
            colour: colour(index),
            dash: dash(index),
            width: 2.0,
            values: curve.values.to_vec(),
        })
        .collect();
    let (curves, bounds) = curves.split_at(panel.curves.len());
    let shown = curves.iter().flat_map(|curve| curve.values.iter().copied()).chain(panel.limits.iter().copied());
    let shown = room(shown, bounds.iter().flat_map(|bound| bound.values.iter().copied()));
    // without a note, the title may use the whole width
    let longest = if panel.note.is_empty() { 62 } else { 40 };
    let title = shortened(&panel.title, longest);
    let (across, up, [top, bottom]) = axes(svg, place, &title, ticks, time, shown.into_iter());
    for Band { start, end, words } in &panel.bands {
        let (from, to) = (across.at(*start), across.at(*end));
        let numbers = [("x", from), ("y", top), ("width", (to - from).max(2.0)), ("height", bottom - top)];
        let numbers = numbers.map(|(name, value)| (name, pixels(value)));
        let numbers = numbers.each_ref().map(|(name, value)| (*name, value.as_str()));
        svg.open("rect", &[&numbers[..], &[("fill", MARKED), ("fill-opacity", "0.7")]].concat());
        svg.words("title", &[], words);
        svg.close("rect");
    }
    let right = place.x + place.width;
    for limit in &panel.limits {
        svg.stroke(place.x + 64.0, up.at(*limit), right, up.at(*limit), TEXT, "4 4", 1.2);
    }
    for curve in curves {
        svg.curve(curve, time, across, up);
        if matches!(ticks, Ticks::Names(_)) && curve.dash.is_empty() {
            for (place, value) in time.iter().zip(&curve.values).filter(|(_, value)| value.is_finite()) {
                let (x, y) = (pixels(across.at(*place)), pixels(up.at(*value)));
                svg.empty("circle", &[("cx", x.as_str()), ("cy", &y), ("r", "3.4"), ("fill", curve.colour)]);
            }
        }
    }
    for bound in bounds {
        for (time, values) in clipped(time, &bound.values, up.ends()) {
            svg.curve(&Curve { values, ..*bound }, &time, across, up);
        }
    }
    for (is_above, words) in edges(bounds, up.ends()) {
        let y = if is_above { top + 14.0 } else { bottom - 6.0 };
        // a background, so that the label is legible where curves cross it
        let wide = width_of(&words, 13.0) + 8.0;
        let place = [("x", right - 2.0 - wide), ("y", y - 13.0), ("width", wide), ("height", 17.0)];
        let place = place.map(|(name, value)| (name, pixels(value)));
        let place = place.each_ref().map(|(name, value)| (*name, value.as_str()));
        svg.empty("rect", &[&place[..], &[("fill", "#ffffff"), ("fill-opacity", "0.8")]].concat());
        svg.text(right - 6.0, y, &[("text-anchor", "end"), ("font-size", "13"), ("fill", TEXT)], &words);
    }
    svg.text(right, place.y + 26.0, &[("text-anchor", "end"), ("fill", QUIET)], &panel.note);
}

/// Returns for each curve the index of its colour and dash.
fn looks(curves: &[PanelCurve<'_>]) -> Vec<usize> {
    let mut looks = Vec::with_capacity(curves.len());
    for (at, curve) in curves.iter().enumerate() {
        let before = looks.last().copied();
        looks.push(match before {
            Some(before) if curves[at - 1].name == curve.name => before,
            Some(before) => before + 1,
            None => 0,
        });
    }
    looks
}

fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}

/// Returns the dash of a curve; the first one has none.
fn dash(index: usize) -> &'static str {
    if index == 0 { "" } else { "9 3" }
}
