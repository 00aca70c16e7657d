//! The Denavit-Hartenberg table for people.

use std::fmt::Write;

use rne_model::{Angle, Convention, JointKind, QuarterTurns, Robot, one_line};

/// The table of a robot as text: one line per joint, aligned, angles as multiples of π where they are right angles.
#[must_use]
pub fn dh_table(robot: &Robot) -> String {
    let titles = ["i", "joint", "type", "theta", "d", "a", "alpha", "mass"].map(str::to_owned);
    let mut lines = vec![titles];
    for (index, joint) in robot.joints.iter().enumerate() {
        let (row, i) = (&joint.row, index + 1);
        let (theta, d) = match row.kind {
            JointKind::Revolute => (with_variable(i, &angle(&row.dh.theta)), number(row.dh.d)),
            JointKind::Prismatic => (angle(&row.dh.theta), with_variable(i, &number(row.dh.d))),
        };
        let kind = match row.kind {
            JointKind::Revolute => "revolute",
            JointKind::Prismatic => "prismatic",
        };
        lines.push([
            i.to_string(),
            one_line(&joint.name),
            kind.to_owned(),
            theta,
            d,
            number(row.dh.a),
            angle(&row.dh.alpha),
            number(row.link.mass),
        ]);
    }
    let widths: Vec<usize> =
        (0..8).map(|column| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0)).collect();
    let mut text = String::new();
    for line in &lines {
        let mut row = String::new();
        for (cell, width) in line.iter().zip(&widths) {
            let padding = " ".repeat(width - cell.chars().count());
            let _ = write!(row, "{cell}{padding}   ");
        }
        text.push_str(row.trim_end());
        text.push('\n');
    }
    text
}

/// The convention of a robot's table in one line.
#[must_use]
pub fn convention(robot: &Robot) -> &'static str {
    match robot.convention {
        Convention::Standard => "standard (distal) Denavit-Hartenberg: Rz(theta) Tz(d) Tx(a) Rx(alpha)",
        Convention::Modified => "modified (proximal) Denavit-Hartenberg: Rx(alpha) Tx(a) Rz(theta) Tz(d)",
    }
}

fn with_variable(joint: usize, constant: &str) -> String {
    match constant.strip_prefix('-') {
        _ if constant == "0" => format!("q{joint}"),
        Some(magnitude) => format!("q{joint} - {magnitude}"),
        None => format!("q{joint} + {constant}"),
    }
}

fn number(value: f64) -> String {
    // -0 is 0
    if value == 0.0 { "0".to_owned() } else { format!("{value}") }
}

/// An angle as text; a right one, up to a full turn, as a multiple of π.
#[must_use]
pub fn angle(angle: &Angle) -> String {
    let Some(right) = angle.right else { return number(angle.radians) };
    // One full turn or less is written as a multiple of π; more keeps its digits.
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
