//! Computes correct worksheets whose vectors are in other axes than those of the sheet.

use nalgebra::{Matrix3, Vector3};
use rne_model::{Angle, Convention, Robot};
use rne_runtime::WrongLength;

use super::{Axes, Line, Quantity, Situation, Worksheet, symmetric};

/// Axes that may have been used instead of those of a worksheet, and the values of each line in them.
pub(super) struct OtherAxes {
    pub(super) says: String,
    pub(super) values: Vec<Vec<f64>>,
}

/// Returns all axes except those of the sheet.
pub(super) fn all(robot: &Robot, at: &Situation, sheet: &Worksheet) -> Result<Vec<OtherAxes>, WrongLength> {
    let mut all = Vec::new();
    let linked = match sheet.axes {
        Axes::Link => None,
        Axes::Joint | Axes::Base => Some(Worksheet::new(robot, at, Axes::Link)?),
    };
    if robot.convention == Convention::Standard
        && robot.rows().any(|row| row.dh.alpha.sin != 0.0 || row.dh.alpha.cos < 0.0)
    {
        let alphas: Vec<Angle> = robot.rows().map(|row| row.dh.alpha).collect();
        let of_table = |line: &Line| in_table_frame(line, &alphas);
        all.push(OtherAxes {
            says: "the vectors are in the axes of frame i of the table, whose z is along joint i + 1".to_owned(),
            values: values_of(sheet, linked.as_ref().unwrap_or(sheet), of_table),
        });
    }
    for axes in [Axes::Link, Axes::Joint, Axes::Base].into_iter().filter(|axes| *axes != sheet.axes) {
        let other = Worksheet::new(robot, at, axes)?;
        let says = format!("the vectors are in the axes `{}`: {}", axes.name(), axes.explained());
        all.push(OtherAxes { says, values: values_of(sheet, &other, |line| line.values.clone()) });
    }
    Ok(all)
}

/// Returns the values of each line of a sheet from another sheet; those of the sheet itself if the other has no such
/// line.
fn values_of(sheet: &Worksheet, other: &Worksheet, of: impl Fn(&Line) -> Vec<f64>) -> Vec<Vec<f64>> {
    let by_other = |line: &Line| other.line(line.joint, line.quantity).map_or_else(|| line.values.clone(), &of);
    sheet.lines.iter().map(by_other).collect()
}

/// Returns a line in link axes, expressed in frame i of a standard table: link axes rotated by α_i about x.
fn in_table_frame(line: &Line, alphas: &[Angle]) -> Vec<f64> {
    let turn =
        |joint: usize| joint.checked_sub(1).and_then(|row| alphas.get(row)).map_or_else(Matrix3::identity, about_x);
    let own = turn(line.joint).transpose();
    match (line.quantity, &line.values[..]) {
        (Quantity::Axis | Quantity::Orientation, values) => values.to_vec(),
        (Quantity::Rotation, values) if values.len() == 9 => {
            let rotation = turn(line.joint - 1).transpose() * Matrix3::from_row_slice(values) * own.transpose();
            rotation.transpose().as_slice().to_vec()
        }
        (_, &[x, y, z]) => (own * Vector3::new(x, y, z)).as_slice().to_vec(),
        (Quantity::Inertia, &[xx, xy, xz, yy, yz, zz]) => {
            symmetric(&(own * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * own.transpose()))
        }
        (_, values) => values.to_vec(),
    }
}

fn about_x(angle: &Angle) -> Matrix3<f64> {
    let (s, c) = (angle.sin, angle.cos);
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}
