//! Draws the picture of a watched log.

use rne_model::{Robot, one_line};
use rne_plot::{Band, Panel, PanelCurve, panels};

use crate::contact::contact_limits;
use crate::event::Event;
use crate::{Report, Settings};

/// Returns an SVG with the residual torque of each joint (measured less predicted by the robot file) and its root mean
/// square, the observer's torque with its thresholds, and the events. The torques of changed parameters are a separate
/// curve. Thresholds far above the curves are cut off. Empty without signals. `about` describes the log. Texts of the
/// robot file are escaped.
#[must_use]
pub fn svg(robot: &Robot, report: &Report, settings: &Settings, about: &str) -> String {
    let Some(signals) = &report.signals else { return String::new() };
    let limits = contact_limits(signals, &report.contact, settings);
    let bound = |joint: usize, sign: f64| -> Vec<f64> {
        let mean = report.contact.joints[joint].mean;
        limits[joint].iter().map(|limit| mean + sign * limit).collect()
    };
    let bounds: Vec<[Vec<f64>; 2]> = (0..signals.dof()).map(|joint| [bound(joint, 1.0), bound(joint, -1.0)]).collect();
    let residuals: Vec<Vec<f64>> = (0..signals.dof())
        .map(|joint| {
            let explained = report.explained[joint].iter().copied().chain(std::iter::repeat(0.0));
            signals.residual[joint].iter().zip(explained).map(|(left, explained)| left + explained).collect()
        })
        .collect();
    let is_explained = report.explained.iter().flatten().any(|torque| *torque != 0.0);
    let panel = |(joint, row): (usize, &rne_model::Joint)| {
        let unit = row.row.kind.effort_unit();
        let mut curves = vec![PanelCurve { name: "residual", values: &residuals[joint] }];
        if is_explained {
            curves.push(PanelCurve { name: "changed parameters", values: &report.explained[joint] });
        }
        curves.push(PanelCurve { name: "external torque", values: &signals.external[joint] });
        let thresholds = bounds[joint].iter().map(|values| PanelCurve { name: "contact threshold", values });
        let is_here = |event: &&Event| event.joint.is_none_or(|of| of == joint) || event.others.contains(&joint);
        let bands = report.events.iter().filter(is_here).map(|event| Band {
            start: event.since,
            end: event.until,
            words: words(robot, event),
        });
        let note = format!("residual {} {unit}, RMS", significant(root_mean_square(&residuals[joint])));
        Panel {
            title: format!("{} {}, {unit}", joint + 1, row.name),
            note,
            curves,
            limits: Vec::new(),
            bounds: thresholds.collect(),
            bands: bands.collect(),
        }
    };
    let joints = robot.independent_joints().enumerate().take(signals.dof());
    let title = robot.title.as_deref().unwrap_or(&robot.name);
    panels(&format!("Watched: {title}"), title, about, &signals.time, &joints.map(panel).collect::<Vec<_>>())
}

/// Returns the root mean square of a curve.
fn root_mean_square(values: &[f64]) -> f64 {
    #[allow(clippy::cast_precision_loss)] // samples of a picture
    let count = values.len().max(1) as f64;
    (values.iter().map(|value| value * value).sum::<f64>() / count).sqrt()
}

/// Formats a number with three decimals or, from 10 on, with one.
fn significant(value: f64) -> String {
    if value < 10.0 { format!("{value:.3}") } else { format!("{value:.1}") }
}

/// Describes an event in words, such as `friction of elbow: coulomb 9.9 ± 0.5 N m, 0.3 s to 18.9 s`.
fn words(robot: &Robot, event: &Event) -> String {
    let joint = event.joint.map_or(String::new(), |joint| format!(" of {}", one_line(robot.coordinate_name(joint))));
    let deviation = if event.deviation.is_finite() { format!(" ± {:.3}", event.deviation) } else { String::new() };
    format!(
        "{}{joint}: {} {:.3}{deviation} {}, {:.3} s to {:.3} s",
        event.cause, event.parameter, event.value, event.unit, event.since, event.until
    )
}
