//! Functions that convert between the joints and the motors of the list `motors`.

use std::fmt::Write;

use rne_codegen::{Function, Name, Quantity};

use super::signature::wrapped;
use super::{ConstantTooLarge, File, comment};

/// A linear map between joints and motors, y = A x.
struct Map {
    name: &'static str,
    about: &'static str,
    /// The name of the argument x, with its number of elements.
    argument: (&'static str, usize),
    result: (&'static str, usize),
    rows: Vec<Vec<f64>>,
}

/// Returns the maps of a robot; none without the list `motors`.
fn maps(file: &File) -> Vec<Map> {
    let (dof, motors) = (file.robot.dof(), file.robot.drives.len());
    if motors == 0 {
        return Vec::new();
    }
    let matrix = file.robot.motor_matrix();
    let transposed = |matrix: &[Vec<f64>]| -> Vec<Vec<f64>> {
        (0..dof).map(|column| matrix.iter().map(|row| row[column]).collect()).collect()
    };
    let back = file.robot.inverse_motor_matrix().map(|inverse| Map {
        name: "motor_torques",
        about: "Torques of the motors that work as tau on the joints, N m.",
        argument: ("tau", dof),
        result: ("motor_tau", motors),
        rows: transposed(&inverse),
    });
    let joint_torques = Map {
        name: "joint_torques",
        about: "Torques that work on the joints when the motors exert motor_tau, N m or N.",
        argument: ("motor_tau", motors),
        result: ("tau", dof),
        rows: transposed(&matrix),
    };
    let speeds = Map {
        name: "motor_speeds",
        about: "Speeds of the motors of the list `motors` at rates qd of the joints, rad/s.",
        argument: ("qd", dof),
        result: ("motor_qd", motors),
        rows: matrix,
    };
    [speeds, joint_torques].into_iter().chain(back).collect()
}

fn head(file: &File, map: &Map) -> String {
    let real = file.precision.c_type();
    let ((argument, from), (result, to)) = (map.argument, map.result);
    let arguments = [format!("const {real} {argument}[{from}]"), format!("{real} {result}[{to}]")];
    wrapped(&format!("void {}_{}(", file.prefix, map.name), &arguments)
}

/// Returns the declarations of these functions for the header.
pub(super) fn declarations(file: &File) -> String {
    let mut text = String::new();
    for map in maps(file) {
        let _ = write!(text, "\n{}{};\n", comment("///", map.about), head(file, &map));
    }
    text
}

/// Returns the definitions of these functions.
pub(super) fn definitions(file: &File) -> Result<String, ConstantTooLarge> {
    let mut text = String::new();
    let real = file.precision.c_type();
    for map in maps(file) {
        let ((argument, from), (result, _)) = (map.argument, map.result);
        let _ = write!(text, "\n{}\n{{\n", head(file, &map));
        let used = |index: &usize| map.rows.iter().any(|row| row[*index] != 0.0);
        for index in (0..from).filter(used) {
            let _ = writeln!(text, "    const {real} {argument}{} = {argument}[{index}];", index + 1);
        }
        for (index, row) in map.rows.iter().enumerate() {
            let mut terms = Vec::new();
            for (column, &factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
                let too_large = || ConstantTooLarge {
                    name: Name::indexed(Quantity::Constant, column + 1, index + 1),
                    value: factor,
                    function: Function::ActuatorTorques,
                };
                let literal = file.precision.literal(factor).ok_or_else(too_large)?;
                terms.push(format!("({argument}{} * {literal})", column + 1));
            }
            let sum = if terms.is_empty() { file.syntax().zero().to_owned() } else { terms.join(" + ") };
            let _ = writeln!(text, "    {result}[{index}] = {sum};");
        }
        text.push_str("}\n");
    }
    Ok(text)
}
