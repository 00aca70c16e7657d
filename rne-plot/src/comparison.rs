//! The picture of a model beside what was measured: a panel for each joint with both torques and what is left.

use rne_model::Robot;

use crate::chart::subscript;
use crate::panels::{Panel, PanelCurve, panels};

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
    let left = |(measured, predicted): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        measured.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect()
    };
    let left: Vec<Vec<f64>> = measured.iter().zip(predicted).map(left).collect();
    let panel = |joint: usize| {
        let unit = robot.joints[joint].row.kind.effort_unit();
        Panel {
            title: format!("τ{} {}, {unit}", subscript(joint + 1), robot.joints[joint].name),
            note: String::new(),
            curves: vec![
                PanelCurve { name: "measured", values: &measured[joint] },
                PanelCurve { name: "predicted", values: &predicted[joint] },
                PanelCurve { name: "left: measured minus predicted", values: &left[joint] },
            ],
            limits: Vec::new(),
            bands: Vec::new(),
        }
    };
    let all: Vec<Panel<'_>> = (0..robot.dof().min(left.len())).map(panel).collect();
    let title = robot.title.as_deref().unwrap_or(&robot.name);
    panels(&format!("Measured and predicted torques of {title}"), title, about, time, &all)
}
