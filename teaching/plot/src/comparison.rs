//! Draws measured and predicted torques: a panel for each joint with both and their difference.

use rne_model::{Joint, Robot};

use crate::elements::subscript;
use crate::panels::{Panel, PanelCurve, panels};

/// Measured and predicted torques of an arm.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<'a> {
    /// Title of the picture: the arm and the log.
    pub title: &'a str,
    /// Line below the title: the part of the log, and the filter.
    pub about: &'a str,
    /// Times, s.
    pub time: &'a [f64],
    /// Measured torques by joint, N m or N.
    pub measured: &'a [Vec<f64>],
    /// Predicted torques by joint, N m or N.
    pub predicted: &'a [Vec<f64>],
    /// A note on each joint, such as its error; empty for no notes.
    pub notes: &'a [String],
}

/// Draws measured and predicted torques and their difference for each joint, as an SVG of 1280 pixels width. Texts of
/// the robot file are escaped.
#[must_use]
pub fn comparison_svg(robot: &Robot, comparison: &Comparison<'_>) -> String {
    let Comparison { title, about, time, measured, predicted, notes } = *comparison;
    let residual = |(measured, predicted): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        measured.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect()
    };
    let residuals: Vec<Vec<f64>> = measured.iter().zip(predicted).map(residual).collect();
    let panel = |(joint, of_joint): (usize, &Joint)| {
        let unit = of_joint.row.kind.effort_unit();
        Panel {
            title: format!("τ{} {}, {unit}", subscript(joint + 1), of_joint.name),
            note: notes.get(joint).cloned().unwrap_or_default(),
            curves: vec![
                PanelCurve { name: "measured", values: &measured[joint] },
                PanelCurve { name: "predicted", values: &predicted[joint] },
                PanelCurve { name: "residual: measured - predicted", values: &residuals[joint] },
            ],
            limits: Vec::new(),
            bounds: Vec::new(),
            bands: Vec::new(),
        }
    };
    let all: Vec<Panel<'_>> = robot.independent_joints().take(residuals.len()).enumerate().map(panel).collect();
    panels(&format!("Measured and predicted torques: {title}"), title, about, time, &all)
}
