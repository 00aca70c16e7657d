//! Friction, residuals and a payload of an arm from log to log.

use std::fmt::Write as _;

use rne_model::{Robot, one_line};
use rne_plot::{Panel, PanelCurve, panels_over};

use crate::candidate::Candidate;
use crate::changes::{Changes, values};
use crate::event::unit;
use rne_identify::Structure;

use crate::Baseline;

/// The parameters of an arm in one log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TrendRow {
    /// The name of the log, of the day or of the group.
    pub name: String,
    /// Coulomb friction of each joint with its standard deviation, N m or N.
    pub friction: Vec<(f64, f64)>,
    /// The payload with its standard deviation, kg.
    pub payload: (f64, f64),
    /// Root mean square of what the model leaves of each joint's torque, N m or N.
    pub residual: Vec<f64>,
    /// The number of events.
    pub events: usize,
}

/// The parameters of an arm in several logs, all compared with the same baseline.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trend {
    /// Coulomb friction of each joint in the robot file and in the baseline, N m or N.
    pub friction: Vec<[f64; 2]>,
    /// The smallest change of each joint's friction that is an event, N m or N, and of the payload, kg.
    pub least: (Vec<f64>, f64),
    /// A row for each log.
    pub rows: Vec<TrendRow>,
}

impl Trend {
    /// A trend without rows.
    #[must_use]
    pub fn new(structure: &Structure, baseline: &Baseline) -> Self {
        let joints = 0..structure.dof();
        let least = |candidate| baseline.scale.least(candidate);
        Self {
            friction: joints.clone().map(|joint| values(structure, baseline, Candidate::Coulomb(joint))).collect(),
            least: (joints.map(|joint| least(Candidate::Coulomb(joint))).collect(), least(Candidate::Payload)),
            rows: Vec::new(),
        }
    }

    /// Adds a log.
    pub fn push(&mut self, name: String, changes: &Changes) {
        let of = |candidate: Candidate, before: f64| {
            let found = changes
                .events
                .iter()
                .find(|event| (event.joint, event.parameter) == (candidate.joint(), candidate.parameter()));
            let statistic = || changes.statistics.iter().find(|statistic| statistic.candidate == candidate);
            match (found, statistic()) {
                (Some(event), _) => (event.value, event.deviation),
                (None, Some(statistic)) => (before + statistic.change, statistic.deviation),
                (None, None) => (f64::NAN, f64::NAN),
            }
        };
        let friction = self.friction.iter().enumerate();
        let friction = friction.map(|(joint, [_, before])| of(Candidate::Coulomb(joint), *before)).collect();
        let payload = of(Candidate::Payload, 0.0);
        let (residual, events) = (changes.residual.clone(), changes.events.len());
        self.rows.push(TrendRow { name, friction, payload, residual, events });
    }

    /// The rows as CSV: a header, then a line for each log; numbers have six digits.
    #[must_use]
    pub fn csv(&self, robot: &Robot) -> String {
        let name = |text: &str| {
            let line = one_line(text);
            if line.contains([',', '"']) { format!("\"{}\"", line.replace('"', "\"\"")) } else { line }
        };
        let mut text = "log".to_owned();
        for joint in &robot.joints {
            let joint = one_line(&joint.name);
            for column in ["coulomb", "coulomb_deviation", "residual"] {
                let _ = write!(text, ",{}", name(&format!("{joint}_{column}")));
            }
        }
        text += ",payload,payload_deviation,events\n";
        for row in &self.rows {
            text += &name(&row.name);
            for ((value, deviation), residual) in row.friction.iter().zip(&row.residual) {
                let _ = write!(text, ",{value:.6},{deviation:.6},{residual:.6}");
            }
            let _ = writeln!(text, ",{:.6},{:.6},{}", row.payload.0, row.payload.1, row.events);
        }
        text
    }

    /// Coulomb friction of each joint and the payload over the logs, with intervals of 95 %, as an SVG. Dashed lines are
    /// the smallest changes that are events. `about` says what was compared.
    #[must_use]
    pub fn svg(&self, robot: &Robot, about: &str) -> String {
        #[allow(clippy::cast_precision_loss)] // a number of logs
        let numbers: Vec<f64> = (1..=self.rows.len()).map(|number| number as f64).collect();
        let joints = self.friction.iter().enumerate();
        let mut series: Vec<Series> = joints
            .map(|(joint, [_, before])| Series {
                title: format!(
                    "{} {}: Coulomb friction, {}",
                    joint + 1,
                    robot.joints[joint].name,
                    unit(robot, Candidate::Coulomb(joint))
                ),
                values: self.rows.iter().map(|row| row.friction[joint]).collect(),
                limits: [-1.0, 1.0].map(|sign| before + sign * self.least.0[joint]),
            })
            .collect();
        series.push(Series {
            title: "payload, kg".to_owned(),
            values: self.rows.iter().map(|row| row.payload).collect(),
            limits: [-self.least.1, self.least.1],
        });
        let bounds: Vec<[Vec<f64>; 3]> = series
            .iter()
            .map(|series| {
                [0.0, 1.0, -1.0].map(|sign| {
                    series.values.iter().map(|(value, deviation)| value + sign * INTERVAL * deviation).collect()
                })
            })
            .collect();
        let panels = series.iter().zip(&bounds).map(|(series, [values, high, low])| Panel {
            title: series.title.clone(),
            note: String::new(),
            curves: vec![
                PanelCurve { name: "value", values },
                PanelCurve { name: "interval of 95 %", values: high },
                PanelCurve { name: "interval of 95 %", values: low },
            ],
            limits: series.limits.to_vec(),
            bands: Vec::new(),
        });
        let title = robot.title.as_deref().unwrap_or(&robot.name);
        let panels: Vec<Panel<'_>> = panels.collect();
        panels_over("log", &format!("Trend of {title}"), title, about, &numbers, &panels)
    }
}

/// Deviations of an interval of 95 %.
const INTERVAL: f64 = 1.96;

struct Series {
    title: String,
    values: Vec<(f64, f64)>,
    limits: [f64; 2],
}
