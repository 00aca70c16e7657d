//! Describes a robot in a few words: the beginning of a listing, its table, its counts of operations, the rounding
//! error of a conversion.

use std::fmt::Write as _;

use rne_codegen::Program;
use rne_convert::Difference;
use rne_model::{JointKind, Robot};

use crate::palette::{QUIET, TITLE};

/// Writes the title, convention, gravity, and the Denavit-Hartenberg table of a robot.
pub(crate) fn robot(robot: &Robot) -> String {
    let rne_emit::Heading { title, frames, ends, table, .. } = rne_emit::Heading::of(robot);
    let mut text = format!("{TITLE}{title}{TITLE:#}\n{frames}\n");
    for end in ends {
        let _ = writeln!(text, "{end}");
    }
    text.push('\n');
    for (index, line) in table.lines().enumerate() {
        let _ = match index {
            0 => writeln!(text, "  {QUIET}{line}   (rad, m, kg){QUIET:#}"),
            _ => writeln!(text, "  {line}"),
        };
    }
    text
}

/// Writes in one line the operations of a program, before and after folding.
pub(crate) fn counts(program: &Program) -> String {
    let (products, sums) = program.before();
    let after = program.operations();
    let angles = match after.sincos {
        0 => "no sine or cosine".to_owned(),
        1 => "sine and cosine of 1 angle".to_owned(),
        angles => format!("sine and cosine of {angles} angles"),
    };
    format!(
        "{TITLE}{}{TITLE:#}, form {}\n\
         {products} products -> {TITLE}{}{TITLE:#}, {sums} sums -> {TITLE}{}{TITLE:#}; \
         {angles}; {} statements",
        program.function, program.form, after.mul, after.add, after.statements,
    )
}

/// Describes the robot in a few words: `puma560, RRRRRR, standard`, and whether its base floats.
pub(crate) fn about(robot: &Robot) -> String {
    let joints: String = robot
        .rows()
        .map(|row| match row.kind {
            JointKind::Revolute => 'R',
            JointKind::Prismatic => 'P',
        })
        .collect();
    let base = if robot.floating_base.is_some() { ", floating base" } else { "" };
    format!("{}, {joints}, {}{base}", robot.name, robot.convention.name())
}

/// Describes the rounding error of a conversion.
pub(crate) fn rounding(difference: &Difference) -> String {
    format!(
        "the table gives the same arm over 1,000 states: tip to {:.1e} m and {:.1e} rad, torques to {:.1e}",
        difference.position, difference.rotation, difference.torque
    )
}
