//! Writes the robot file of an identification, with sources and standard deviations in its comments.

use std::fmt::Write as _;

use rne_convert::robot_file;
use rne_model::{JointKind, Robot, one_line};

use crate::fit::identification::{Fit, Identification, JointReport};

/// The beginning of a note on a joint that was not excited.
const NOT_EXCITED: &str = "- joint not excited: ";

impl Identification {
    /// Returns the text of the robot file; `logs` describes the logs of the identification in words.
    #[must_use]
    pub fn robot_file(&self, logs: &str) -> String {
        let mut unknown = String::new();
        for (report, joint) in self.joints.iter().zip(self.robot.independent_joints()) {
            if !report.is_excited() {
                let _ = write!(unknown, "\n{NOT_EXCITED}{}", one_line(&joint.name));
            }
        }
        let robot = described(&self.robot, logs, &unknown);
        let mut text = head(self);
        let mut joint: usize = 0;
        for line in robot_file::write(&robot).lines() {
            if line.starts_with("  - name:") {
                joint += 1;
            }
            let row = joint.checked_sub(1);
            let coordinate = row.and_then(|row| self.robot.coordinates().position(|joint| joint == row));
            if let Some((at, report)) = coordinate.and_then(|at| Some((at, self.joints.get(at)?))) {
                let kind = self.robot.coordinate_kind(at);
                if line == "    link:" {
                    let _ = writeln!(text, "    # {}", of_link(self, report, at));
                } else if line.starts_with("    motor:")
                    && let Some(words) = of_motor(report, kind)
                {
                    let _ = writeln!(text, "    # {words}");
                }
            }
            text.push_str(line);
            text.push('\n');
        }
        text
    }

    /// Returns for each joint whether the notes of a robot file say that it was not excited in the identification.
    /// [`robot_file`](Self::robot_file) writes these notes.
    #[must_use]
    pub fn not_excited(robot: &Robot) -> Vec<bool> {
        let notes = robot.notes.as_deref().unwrap_or_default();
        let named: Vec<&str> = notes.lines().filter_map(|line| line.trim().strip_prefix(NOT_EXCITED)).collect();
        robot.independent_joints().map(|joint| named.iter().any(|name| *name == one_line(&joint.name))).collect()
    }
}

impl Fit {
    /// Returns the text of the robot file, without standard deviations; `logs` describes the logs of the identification
    /// in words.
    #[must_use]
    pub fn robot_file(&self, logs: &str) -> String {
        robot_file::write(&described(&self.robot, logs, ""))
    }
}

/// Returns a robot with title, source and notes of the identification; `added` is appended to the notes.
fn described(robot: &Robot, logs: &str, added: &str) -> Robot {
    let mut robot = robot.clone();
    let geometry = one_line(&robot.source);
    // the title of the geometry's robot file would describe its links, not the identified ones
    robot.title = Some(format!("{} identified from {}", one_line(&robot.name), one_line(logs)));
    robot.source = format!("identified by rne from {}; geometry: {geometry}", one_line(logs));
    robot.notes = Some(format!(
        "- identified: torques are those of the log, single numbers of a link are one choice among many with the same \
         torques\n- what the log does not excite is what was supposed before{added}"
    ));
    robot
}

/// Returns a comment that lists the base parameters: the least-squares values with their standard deviations, and the
/// values from the links of the file.
fn head(identification: &Identification) -> String {
    let excited = identification.bases.iter().filter(|base| base.is_excited()).count();
    let mut text = format!(
        "# Identified from {} states over {:.1} s. Of {} base parameters the log excites {excited}.\n#\n# base \
         parameter: least squares ± deviation; what the links below make of it\n",
        identification.states,
        identification.duration,
        identification.bases.len(),
    );
    for base in &identification.bases {
        if base.is_excited() {
            let _ = writeln!(
                text,
                "#   {:<6} {:>11} ± {:<9}  {:>11}",
                base.name,
                short(base.value),
                short(base.deviation),
                short(base.written)
            );
        } else {
            let _ = writeln!(text, "#   {:<6} {:>23}  {:>11}", base.name, "not excited", short(base.written));
        }
    }
    text
}

fn of_link(identification: &Identification, report: &JointReport, joint: usize) -> String {
    let unit = identification.robot.coordinate_kind(joint).effort_unit();
    if let (true, Some((offset, _))) = (report.is_excited(), report.offset) {
        format!("identified: its offset of {} {unit} is more than its Coulomb friction can store", short(offset))
    } else if report.is_excited() {
        format!(
            "identified: error {:.1} %, residual {} {unit}",
            100.0 * report.error.error,
            short(report.error.residual)
        )
    } else if report.error.as_read < 10.0 {
        format!(
            "joint not excited: no model explains {:.0} % of its effort before the low-pass filter",
            100.0 * report.error.as_read
        )
    } else {
        "joint not excited: its effort changes only by noise".to_owned()
    }
}

fn of_motor(report: &JointReport, kind: JointKind) -> Option<String> {
    let [viscous, forward, backward] = report.friction?;
    if !report.is_friction_excited() {
        return Some("friction not excited".to_owned());
    }
    let unit = kind.effort_unit();
    let offset = if report.is_offset_unknown() { "; the log cannot tell an offset from gravity" } else { "" };
    Some(format!(
        "deviations at the joint: viscous {}, Coulomb {} and {} {unit}{offset}",
        short(viscous.1),
        short(forward.1),
        short(backward.1)
    ))
}

/// Formats a number with four digits.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    #[allow(clippy::cast_possible_truncation)] // an exponent
    let exponent = value.abs().log10().floor() as i32;
    match exponent {
        -4..=3 => format!("{value:.*}", usize::try_from(3 - exponent).unwrap_or_default()),
        _ => format!("{value:.3e}"),
    }
}
