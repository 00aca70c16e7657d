//! The picture of a model beside what was measured: a panel for each joint with both torques and what is left.

use rne_model::{JointKind, Robot};

use crate::chart::{
    COLOURS, Curve, GAP, HEAD, PANEL, Place, QUIET, SIDE, Svg, TEXT, WIDTH, panel, pixels, shortened, subscript,
    width_of,
};

const LINES: [(&str, &str, &str, f64); 3] = [
    ("left: measured minus predicted", COLOURS[1], "", 1.8),
    ("predicted", COLOURS[0], "9 4", 2.4),
    ("measured", TEXT, "", 2.8),
];

/// Measured and predicted torques by joint, N m (N where it slides), over times in s, as an SVG of 1280 pixels width:
/// for each joint both and their difference. `about` says what was measured. Texts of the robot file are shown and do
/// nothing.
#[must_use]
pub fn comparison_svg(
    robot: &Robot,
    time: &[f64],
    measured: &[Vec<f64>],
    predicted: &[Vec<f64>],
    about: &str,
) -> String {
    let columns = if robot.dof() == 1 { 1 } else { 2 };
    #[allow(clippy::cast_precision_loss)] // at most 64 joints
    let (columns_f, rows_f) = (columns as f64, robot.dof().div_ceil(columns) as f64);
    let height = HEAD + rows_f * PANEL + 12.0;
    let mut svg = Svg::new();
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
    let title = robot.title.as_deref().unwrap_or(&robot.name);
    svg.words("title", &[], &format!("Measured and predicted torques of {title}"));
    svg.empty("rect", &[("width", "100%"), ("height", "100%"), ("fill", "#ffffff")]);
    svg.text(SIDE, 46.0, &[("font-size", "26"), ("font-weight", "600")], &shortened(title, 72));
    svg.text(SIDE, 74.0, &[("font-size", "16"), ("fill", QUIET)], &shortened(about, 130));
    let mut x = SIDE;
    for &(name, colour, dash, width) in LINES.iter().rev() {
        svg.stroke(x, 104.0, x + 38.0, 104.0, colour, dash, width);
        svg.text(x + 46.0, 109.0, &[("font-size", "16")], name);
        x += 46.0 + width_of(name, 16.0) + 30.0;
    }
    let wide = (WIDTH - 2.0 * SIDE - (columns_f - 1.0) * GAP) / columns_f;
    for (joint, (measured, predicted)) in measured.iter().zip(predicted).enumerate().take(robot.dof()) {
        #[allow(clippy::cast_precision_loss)]
        let (column, row) = ((joint % columns) as f64, (joint / columns) as f64);
        let place = Place { x: SIDE + column * (wide + GAP), y: HEAD + row * PANEL, width: wide, height: PANEL };
        let left = measured.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect();
        let values = [left, predicted.clone(), measured.clone()];
        let curves: Vec<Curve<'_>> = LINES
            .iter()
            .zip(values)
            .map(|(&(name, colour, dash, width), values)| Curve { name, colour, dash, width, values })
            .collect();
        let unit = match robot.joints[joint].row.kind {
            JointKind::Revolute => "N m",
            JointKind::Prismatic => "N",
        };
        let name = shortened(&robot.joints[joint].name, 30);
        panel(&mut svg, place, &format!("τ{} {name}, {unit}", subscript(joint + 1)), time, &curves);
    }
    svg.close("svg");
    svg.finish()
}
