//! Writes the elements of a picture as SVG.

use std::fmt::Write as _;
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesEnd, BytesStart, BytesText, Event};
use rne_model::one_line;

use crate::scale::Scale;

/// Width of a picture, pixels.
pub(crate) const WIDTH: f64 = 1280.0;

/// Colour of letters and of the most important line.
pub(crate) const TEXT: &str = "#222222";

/// Number of stretches of a curve of which points are drawn: half a picture's width in pixels.
const BUCKETS: usize = 640;

/// A line of a panel.
pub(crate) struct Curve<'a> {
    pub(crate) name: &'a str,
    pub(crate) colour: &'a str,
    pub(crate) dash: &'a str,
    pub(crate) width: f64,
    pub(crate) values: Vec<f64>,
}

/// Returns the samples of a curve that are drawn: the first, the smallest, the largest and the last of each stretch.
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

/// A picture to which elements are appended.
pub(crate) struct Svg {
    writer: Writer<Vec<u8>>,
    /// Whether writing has failed, so that the picture is empty; writing to memory normally does not fail.
    failed: bool,
}

impl Svg {
    /// Begins a white picture of `height` pixels; `name` is its title for screen readers.
    pub(crate) fn with_root(name: &str, height: f64) -> Self {
        let mut svg = Self { writer: Writer::new_with_indent(Vec::new(), b' ', 1), failed: false };
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

    fn event(&mut self, event: Event<'_>) {
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

/// Replaces the characters of a text that XML does not allow.
fn plain(text: &str) -> String {
    one_line(text).replace(['\u{FFFE}', '\u{FFFF}'], "\u{FFFD}")
}

/// Shortens a text to at most `most` characters.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    let text = plain(text);
    if text.chars().count() <= most { text } else { text.chars().take(most - 1).chain(['…']).collect() }
}

/// Formats pixels, rounded to hundredths.
pub(crate) fn pixels(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    format!("{}", rounded + 0.0)
}

/// Returns the approximate width of a text, pixels; fonts differ, and gaps in a legend allow for that.
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

/// Writes a number in subscript digits, such as ₁₂.
pub(crate) fn subscript(number: usize) -> String {
    let digit = |c: char| c.to_digit(10).and_then(|digit| char::from_u32(0x2080 + digit)).unwrap_or(c);
    number.to_string().chars().map(digit).collect()
}
