//! The picture of what was watched.

use rne_model::Robot;
use rne_plot::{Band, Panel, PanelCurve, panels};

use crate::{Baseline, Report, Signals};

/// Residual and external torque of each joint over time, with the observer's thresholds and the events, as an SVG.
/// `about` says what the motion is. Texts of the robot file are shown and do nothing.
#[must_use]
pub fn svg(robot: &Robot, signals: &Signals, baseline: &Baseline, report: &Report, about: &str) -> String {
    let joints = robot.joints.iter().enumerate().take(signals.dof());
    let panel = |(joint, row): (usize, &rne_model::Joint)| {
        let unit = row.row.kind.effort_unit();
        let curves = vec![
            PanelCurve { name: "residual: measured less model", values: &signals.residual[joint] },
            PanelCurve { name: "external torque, by the observer", values: &signals.external[joint] },
        ];
        let limit = report.thresholds.get(joint).zip(baseline.external.get(joint));
        let limits = limit.map_or(Vec::new(), |(thresholds, level)| {
            [1.0, -1.0].map(|sign| level.mean + sign * thresholds.external * level.deviation).to_vec()
        });
        let events = report.events.iter().filter(|event| event.joint == joint);
        let bands = events.map(|event| Band {
            start: event.start,
            end: event.end,
            words: format!("{}, peak {:.3} {unit}, {:.3} s to {:.3} s", event.test, event.peak, event.start, event.end),
        });
        let note = report.errors.get(joint).copied().flatten();
        let note = note.map_or(String::new(), |error| format!("prediction error {:.1} %", 100.0 * error));
        Panel { title: format!("{} {}, {unit}", joint + 1, row.name), note, curves, limits, bands: bands.collect() }
    };
    let title = robot.title.as_deref().unwrap_or(&robot.name);
    panels(&format!("Watched: {title}"), title, about, &signals.time, &joints.map(panel).collect::<Vec<_>>())
}
