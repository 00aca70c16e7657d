//! The opening of a listing: which robot this is, its table, and what was counted.

use std::fmt::Write as _;

use rne_codegen::{Program, emit};
use rne_model::{Robot, Transform};

use crate::terminal::{QUIET, TITLE};

/// Title, convention, gravity, and the Denavit-Hartenberg table.
pub(crate) fn robot(robot: &Robot) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{TITLE}{}{TITLE:#}", emit::title(robot));
    let _ = writeln!(text, "{}", emit::convention(robot));
    let [x, y, z] = robot.gravity;
    let _ = writeln!(text, "acceleration of gravity in frame 0: ({x}, {y}, {z}) m/s²");
    for (what, place) in
        [("base, from the world to frame 0", &robot.base), ("tool, behind the last frame", &robot.tool)]
    {
        if *place != Transform::IDENTITY {
            let [x, y, z] = place.xyz;
            let [roll, pitch, yaw] = place.rpy.map(|angle| emit::angle(&angle));
            let _ = writeln!(text, "{what}: ({x}, {y}, {z}) m, roll pitch yaw ({roll}, {pitch}, {yaw}) rad");
        }
    }
    text.push('\n');
    for (index, line) in emit::dh_table(robot).lines().enumerate() {
        let _ = match index {
            0 => writeln!(text, "  {QUIET}{line}   (rad, m, kg){QUIET:#}"),
            _ => writeln!(text, "  {line}"),
        };
    }
    text
}

/// The operations of a program, before and after, in one line.
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
