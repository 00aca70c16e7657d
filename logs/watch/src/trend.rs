//! Follows friction, residuals and the payload of an arm from log to log.

use std::fmt::Write as _;

use rne_model::{Robot, one_line};
use rne_plot::{Panel, PanelCurve, panels_over};

use crate::candidate::Candidate;
use crate::changes::{Changes, values};
use crate::event::{Event, unit};
use crate::selection::Statistic;
use rne_identify::Structure;

use crate::Baseline;

/// The parameters of an arm in one log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TrendRow {
    /// The name of the log, the day or the group.
    pub name: String,
    /// Coulomb friction of each joint, N m or N.
    pub friction: Vec<TrendValue>,
    /// The payload, kg.
    pub payload: TrendValue,
    /// Root mean square of the model's residual torque of each joint, N m or N.
    pub residual: Vec<f64>,
    /// The number of events.
    pub events: usize,
}

/// A parameter in one log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrendValue {
    /// The value in the log; NaN if the log does not determine it.
    pub value: f64,
    /// Standard deviation of the value.
    pub deviation: f64,
    /// The smallest change against the baseline that is an event.
    pub threshold: f64,
}

/// The parameters of an arm in several logs, all compared with the same baseline.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trend {
    /// Coulomb friction of each joint in the robot file and in the baseline, N m or N.
    pub friction: Vec<[f64; 2]>,
    /// A row for each log.
    pub rows: Vec<TrendRow>,
    /// The names of the logs that cannot be compared, each with the reason.
    pub left_out: Vec<(String, String)>,
}

impl Trend {
    /// Makes a trend without rows.
    #[must_use]
    pub fn new(structure: &Structure, baseline: &Baseline) -> Self {
        let joints = 0..structure.dof();
        Self {
            friction: joints.clone().map(|joint| values(structure, baseline, Candidate::Coulomb(joint))).collect(),
            rows: Vec::new(),
            left_out: Vec::new(),
        }
    }

    /// Adds a log.
    pub fn push(&mut self, name: String, changes: &Changes) {
        let value = |candidate: Candidate, before: f64| {
            let found = changes
                .events
                .iter()
                .find(|event| (event.joint, event.parameter) == (candidate.joint(), candidate.parameter()));
            let statistic = || changes.statistics.iter().find(|statistic| statistic.candidate == candidate);
            match (found, statistic()) {
                (Some(Event { value, deviation, threshold, .. }), _) => {
                    TrendValue { value: *value, deviation: *deviation, threshold: *threshold }
                }
                (None, Some(Statistic { change, deviation, threshold, .. })) => {
                    TrendValue { value: before + change, deviation: *deviation, threshold: *threshold }
                }
                (None, None) => TrendValue { value: f64::NAN, deviation: f64::NAN, threshold: f64::NAN },
            }
        };
        let friction = self.friction.iter().enumerate();
        let friction = friction.map(|(joint, [_, before])| value(Candidate::Coulomb(joint), *before)).collect();
        let payload = value(Candidate::Payload, 0.0);
        let (residual, events) = (changes.residual.clone(), changes.events.len());
        self.rows.push(TrendRow { name, friction, payload, residual, events });
    }

    /// Returns the rows as CSV: a header, then a line for each log; numbers have six digits.
    #[must_use]
    pub fn csv(&self, robot: &Robot) -> String {
        let name = |text: &str| {
            let line = one_line(text);
            if line.contains([',', '"']) { format!("\"{}\"", line.replace('"', "\"\"")) } else { line }
        };
        let mut text = "log".to_owned();
        for joint in robot.independent_joints() {
            let joint = one_line(&joint.name);
            for column in ["coulomb", "coulomb_deviation", "residual"] {
                let _ = write!(text, ",{}", name(&format!("{joint}_{column}")));
            }
        }
        text += ",payload,payload_deviation,events\n";
        for row in &self.rows {
            text += &name(&row.name);
            for (TrendValue { value, deviation, .. }, residual) in row.friction.iter().zip(&row.residual) {
                let _ = write!(text, ",{value:.6},{deviation:.6},{residual:.6}");
            }
            let _ = writeln!(text, ",{:.6},{:.6},{}", row.payload.value, row.payload.deviation, row.events);
        }
        text
    }

    /// Returns an SVG with Coulomb friction of each joint and the payload over the names of the logs, with 95 %
    /// confidence intervals and the thresholds of events. `about` names the logs that were compared.
    #[must_use]
    pub fn svg(&self, robot: &Robot, about: &str) -> String {
        let names: Vec<String> = self.rows.iter().map(|row| row.name.clone()).collect();
        let of_joint = |(joint, [_, before]): (usize, &[f64; 2])| {
            let unit = unit(robot, Candidate::Coulomb(joint));
            let title = format!("{} {}: Coulomb friction, {unit}", joint + 1, robot.coordinate_name(joint));
            Series::new(title, *before, self.rows.iter().map(|row| row.friction[joint]))
        };
        let mut series: Vec<Series> = self.friction.iter().enumerate().map(of_joint).collect();
        series.push(Series::new("payload, kg".to_owned(), 0.0, self.rows.iter().map(|row| row.payload)));
        let panels: Vec<Panel<'_>> = series.iter().map(Series::panel).collect();
        let title = robot.title.as_deref().unwrap_or(&robot.name);
        panels_over(&names, &format!("Trend of {title}"), title, about, &panels)
    }
}

/// Half the width of a 95 % confidence interval, in standard deviations.
const INTERVAL: f64 = 1.96;

/// A panel with its curves: the value, the ends of its interval, the thresholds.
struct Series {
    title: String,
    curves: [Vec<f64>; 5],
}

impl Series {
    fn new(title: String, before: f64, values: impl Iterator<Item = TrendValue>) -> Self {
        let values: Vec<TrendValue> = values.collect();
        let series = |each: &dyn Fn(TrendValue) -> f64| values.iter().copied().map(each).collect();
        let curves = [
            series(&|value| value.value),
            series(&|value| value.value + INTERVAL * value.deviation),
            series(&|value| value.value - INTERVAL * value.deviation),
            series(&|value| before + value.threshold),
            series(&|value| before - value.threshold),
        ];
        Self { title, curves }
    }

    fn panel(&self) -> Panel<'_> {
        let names = ["value", "interval of 95 %", "interval of 95 %", "threshold", "threshold"];
        let curves = names.into_iter().zip(&self.curves).map(|(name, values)| PanelCurve { name, values }).collect();
        Panel {
            title: self.title.clone(),
            note: String::new(),
            curves,
            limits: Vec::new(),
            bounds: Vec::new(),
            bands: Vec::new(),
        }
    }
}
