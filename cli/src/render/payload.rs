//! Describes an identified payload in words and as JSON; docs/control/identify.md lists the keys.

use std::fmt::Write as _;

use rne_identify::{JointError, JudgedPart, Payload, PayloadNumber, PayloadReply};
use rne_logs::median;
use rne_model::{Robot, one_line};

use crate::palette::{GOOD, WARNING};
use crate::render::layout::{Align, PAGE, push_table, shortened, wrap};
use crate::values::numbers::with_deviation;

/// Largest number of columns of a joint's name.
const NAME: usize = 24;

/// A payload, with the data that its description needs.
pub(crate) struct WordedPayload<'a> {
    /// The robot without the payload.
    pub(crate) robot: &'a Robot,
    pub(crate) payload: &'a Payload,
    /// The errors of the robot without the payload on the log.
    pub(crate) errors: &'a [JointError],
    /// The errors of the robot with the payload; `None` if there is no payload.
    pub(crate) with: Option<&'a [JointError]>,
}

impl WordedPayload<'_> {
    /// Writes the verdict below a heading, the numbers, and the errors by joint.
    pub(crate) fn below(&self, heading: &str) -> String {
        let mut text = format!("{heading}{}\n", wrap(&self.verdict(), PAGE, ""));
        let Payload { mass, com, inertia, .. } = self.payload;
        if self.payload.is_there() {
            let centre = ["cx", "cy", "cz"].into_iter().zip(com).map(|(name, number)| (name, number, "m"));
            // if no element of the inertia is known, one row says so
            let is_known = inertia.iter().any(|number| number.is_excited);
            let names = if is_known { &Payload::INERTIA[..] } else { &["J"] };
            let moments = names.iter().zip(inertia).map(|(name, number)| (*name, number, "kg m²"));
            let rows = [("m", mass, "kg")].into_iter().chain(centre).chain(moments);
            let row = |(name, number, unit): (&str, &PayloadNumber, &str)| {
                let value = if number.is_excited {
                    with_deviation(number.value, number.deviation)
                } else {
                    "not excited".to_owned()
                };
                [format!("  {name}"), value, unit.to_owned()]
            };
            let mut cells = vec![["  number".to_owned(), "value".to_owned(), "unit".to_owned()]];
            cells.extend(rows.map(row));
            let title = "payload in tip axes, from their origin; inertia about its centre of mass";
            push_table(&mut text, title, &[Align::Left, Align::Right, Align::Left], &cells);
        }
        if let Some(with) = self.with {
            let mut cells = vec![["  joint", "FILE", "with payload"].map(str::to_owned)];
            for ((joint, before), after) in self.robot.independent_joints().zip(self.errors).zip(with) {
                let name = shortened(&one_line(&joint.name), NAME);
                cells.push([format!("  {name}"), percent(before.error), percent(after.error)]);
            }
            let title = "errors by joint: RMS of measured - predicted torque over the standard deviation\n\
                         of the measured torque, both low-passed";
            push_table(&mut text, title, &[Align::Left, Align::Right, Align::Right], &cells);
        }
        text
    }

    fn verdict(&self) -> String {
        let Payload { mass, com, .. } = self.payload;
        let kilograms = format!("{} kg", with_deviation(mass.value, mass.deviation));
        let link = link_with_tip(self.robot);
        if !mass.is_excited {
            return format!("The log does {WARNING}not determine{WARNING:#} the mass of a payload.");
        }
        if !self.payload.is_there() {
            return format!(
                "{GOOD}no payload{GOOD:#}: the log shows a mass of {kilograms} at {link} beyond that of FILE"
            );
        }
        let centre = if com.iter().all(|number| number.is_excited) {
            let largest = com.iter().map(|number| number.deviation).fold(0.0, f64::max);
            let each = com.map(|number| of_deviation(number.value, largest));
            let deviation = of_deviation(largest, largest);
            format!("centre of mass ({}) ± {deviation} m in tip axes", each.join(", "))
        } else {
            let known = ["x", "y", "z"].into_iter().zip(com).filter(|(_, number)| number.is_excited);
            let known: Vec<String> = known
                .map(|(axis, number)| format!("{axis} {} m", with_deviation(number.value, number.deviation)))
                .collect();
            if known.is_empty() {
                "centre of mass not excited".to_owned()
            } else {
                format!(
                    "centre of mass {} in tip axes; the log does not excite the other coordinates",
                    known.join(", ")
                )
            }
        };
        let mut text = format!("{GOOD}payload {kilograms}{GOOD:#}, {centre}");
        let middle = |errors: &[JointError]| {
            let finite: Vec<f64> = errors.iter().map(|error| error.error).filter(|error| error.is_finite()).collect();
            (!finite.is_empty()).then(|| percent(median(finite)))
        };
        if let (Some(before), Some(after)) = (middle(self.errors), self.with.and_then(middle)) {
            let _ = write!(
                text,
                "; the model with it predicts the torques with a median error of {after} instead of {before}"
            );
        }
        text
    }

    /// Returns the answer as data for JSON.
    pub(crate) fn reply(&self, logs: Vec<String>, cutoff: f64, part: JudgedPart) -> PayloadReply {
        PayloadReply::of(self.robot, self.payload, [Some(self.errors), self.with], logs, cutoff, part)
    }
}

/// Returns words for the link that carries the tip.
pub(crate) fn link_with_tip(robot: &Robot) -> String {
    match robot.tip().on.and_then(|on| robot.joints.get(on)) {
        Some(joint) if !robot.is_serial() => format!("the link of {}", one_line(&joint.name)),
        _ => "the last link".to_owned(),
    }
}

/// Writes a number with as many decimals as two digits of its deviation need.
fn of_deviation(value: f64, deviation: f64) -> String {
    let text = with_deviation(value, deviation);
    text.split(' ').next().unwrap_or_default().to_owned()
}

fn percent(part: f64) -> String {
    if part.is_finite() { format!("{:.1} %", 100.0 * part) } else { "no motion".to_owned() }
}
