//! Writes the verdict of an identification in words, and its errors by joint.

use std::fmt::Write as _;
use std::path::Path;

use rne_identify::{Doubt, Evidence, Excited, JointError, JointVerdict, Standstill, Verdict};
use rne_logs::median;
use rne_model::{Joint, Robot, one_line};

use crate::palette::{GOOD, QUIET, TITLE, TYPED, WARNING};
use crate::render::counts::{counted, enumerated, groups, listed};
use crate::render::layout::{self, Align, PAGE, columns, shortened};
use crate::values::numbers::rounded;

/// Largest number of lines of a verdict with its heading. If it would be longer, some joints that do not fit the model
/// are named without reasons.
const LINES: usize = 10;

/// Largest number of joints that are named without reasons; the others are counted.
const SHOWN: usize = 5;

/// A blank at which no line is broken.
pub(crate) const TIED: &str = "\u{A0}";

/// The option that computes errors on other data; no line is broken in it.
const HOLD_OUT: &str = "--hold-out\u{A0}0.3";

/// A verdict, with the data that its description needs.
pub(crate) struct Worded<'a> {
    pub(crate) verdict: &'a Verdict,
    pub(crate) robot: &'a Robot,
    /// The robot file of the command line.
    pub(crate) file: &'a Path,
    /// The held-out part of the log in words, such as `from 13.5 s on`.
    pub(crate) held_out: &'a str,
    /// Number of rows of the log for each joint.
    pub(crate) rows: u64,
}

impl Worded<'_> {
    /// Writes the verdict in sentences below a heading.
    pub(crate) fn below(&self, heading: &str) -> String {
        let joints = || self.robot.independent_joints().zip(&self.verdict.joints);
        let mut doubtful: Vec<(&Joint, &JointVerdict)> =
            joints().filter(|(_, verdict)| !verdict.is_predicted).collect();
        // joints with a reason come first, sorted by error from the largest on
        let error = |verdict: &JointVerdict| verdict.error().map_or(f64::INFINITY, |error| error.error);
        doubtful.sort_by(|(_, one), (_, other)| {
            (one.doubts.is_empty().cmp(&other.doubts.is_empty())).then(error(other).total_cmp(&error(one)))
        });
        let with_reasons = doubtful.iter().filter(|(_, verdict)| !verdict.doubts.is_empty()).count();
        let first = wrap(&self.first(), "");
        let last = self.verdict.excited.as_ref().map(|excited| self.excited(excited)).unwrap_or_default();
        // as many joints get reasons as the lines allow
        let whole = |explained: usize| {
            let sentences = doubtful[..explained].iter().map(|(joint, verdict)| self.explained(joint, verdict));
            let mut lines: Vec<String> = sentences.collect();
            lines.extend(self.others(&doubtful[explained..], explained > 0));
            let lines = [vec![first.clone()], lines, last.clone()].concat();
            format!("{heading}{}\n", lines.join("\n"))
        };
        let fits = (0..=with_reasons).rev().find(|explained| whole(*explained).lines().count() <= LINES);
        whole(fits.unwrap_or(0))
    }

    /// Says how many joints the model predicts, and how well.
    fn first(&self) -> String {
        let Verdict { evidence, joints, .. } = self.verdict;
        let [does, data] = match evidence {
            Evidence::Fitted => ["The model reproduces the torque of", "on the data that it was fitted to"],
            Evidence::Judged => ["The robot file predicts the torque of", "on this log"],
            _ => ["The model predicts the torque of", "on held-out data"],
        };
        let predicted = joints.iter().filter(|joint| joint.is_predicted);
        let errors: Vec<f64> = predicted.filter_map(|joint| Some(joint.error()?.error)).collect();
        let style = if errors.len() == joints.len() { GOOD } else { WARNING };
        let mut text = format!("{does} {style}{}{style:#} {data}", counted(errors.len(), joints.len()).of("joint"));
        if *evidence == Evidence::HeldOut {
            let _ = write!(text, " ({})", self.held_out);
        }
        if !errors.is_empty() {
            let noun = if errors.len() == 1 { "an RMS error" } else { "RMS errors" };
            let limit = percent(Verdict::limit());
            let _ = write!(text, ", with {noun} of {} of its standard deviation (limit: {limit})", range(&errors));
        }
        text.push('.');
        if *evidence == Evidence::Fitted {
            let _ = write!(text, " {TYPED}{HOLD_OUT}{TYPED:#} computes errors on data that it was not fitted to.");
        }
        text
    }

    /// Returns the words for a joint that the model does not predict.
    fn not_predicted(&self) -> &'static str {
        if self.verdict.evidence == Evidence::Fitted { "not reproduced" } else { "not predicted" }
    }

    /// Explains why the model does not predict a joint.
    fn explained(&self, joint: &Joint, verdict: &JointVerdict) -> String {
        // that the held-out error is larger is no cause, unless it is the only doubt
        let is_cause = |doubt: &&Doubt| verdict.doubts.len() == 1 || !matches!(doubt, Doubt::Grown(_));
        let causes = verdict.doubts.iter().filter(is_cause);
        let reasons: Vec<String> = causes.map(|doubt| self.reason(joint, verdict, doubt)).collect();
        let (named, fails) = (named(joint, verdict), self.not_predicted());
        wrap(&format!("{named} is {WARNING}{fails}{WARNING:#}: {}.", reasons.join("; ")), "  ")
    }

    /// Names joints for whose reasons there is no room.
    fn others(&self, joints: &[(&Joint, &JointVerdict)], is_more: bool) -> Option<String> {
        let with_fitted_part = |(joint, verdict): &(&Joint, &JointVerdict)| match (verdict.growth(), verdict.fitted) {
            (Some(_), Some(fitted)) => {
                let both = format!("; {} on the fitted part)", percent(fitted.error));
                named(joint, verdict).trim_end_matches(')').to_owned() + &both
            }
            _ => named(joint, verdict),
        };
        let mut named: Vec<String> = joints.iter().take(SHOWN).map(with_fitted_part).collect();
        if joints.len() > SHOWN {
            named.push(format!("{} more", joints.len() - SHOWN));
        }
        let fails = self.not_predicted();
        let also = if is_more { format!("Also {fails}") } else { fails.replacen('n', "N", 1) };
        (!named.is_empty()).then(|| wrap(&format!("{also}: {}.", enumerated(&named)), "  "))
    }

    fn reason(&self, joint: &Joint, verdict: &JointVerdict, doubt: &Doubt) -> String {
        let unit = joint.row.kind.effort_unit();
        match doubt {
            Doubt::Unexplained => "no model of this arm explains its efforts".to_owned(),
            Doubt::NotExcited if self.verdict.evidence == Evidence::Judged => {
                "its file says that it was not excited when it was identified".to_owned()
            }
            Doubt::WithoutFriction => "the robot file has no friction for it".to_owned(),
            Doubt::NotExcited => {
                let noise = verdict.fitted.map_or(f64::NAN, |error| error.as_read);
                format!("noise is {} of its unfiltered torque", percent(noise))
            }
            Doubt::Offset { offset, .. } => {
                format!("it has an offset of {} {unit}, more than a robot file can store", rounded(*offset, 3))
            }
            Doubt::Outliers(rejected) => {
                format!("{} of {} rows are outliers, the first at {:.1} s", rejected.rows, self.rows, rejected.time)
            }
            Doubt::Standstill(Standstill { start, end, .. }) => {
                let moving = verdict.error().and_then(JointError::in_motion);
                let moving = moving.map(|error| format!("; in motion, its error is {}", percent(error)));
                format!(
                    "it stands still from {start:.1} to {end:.1} s, where static friction is not known{}",
                    moving.unwrap_or_default()
                )
            }
            Doubt::FrictionNotExcited => "the log does not excite its friction".to_owned(),
            Doubt::Grown(_) => {
                let fitted = verdict.fitted.map_or(f64::NAN, |error| error.error);
                format!("its error is {} on the fitted part only", percent(fitted))
            }
            _ => String::new(),
        }
    }

    /// Says how many parameters are excited, which are not, and what to do about it.
    fn excited(&self, excited: &Excited) -> Vec<String> {
        let parameters = counted(excited.known_parameters(), excited.base_parameters).of("base parameter");
        let mut text = format!("The log determines {parameters}");
        if excited.frictions > 0 {
            let joints = counted(excited.known_frictions(), excited.frictions).of("joint");
            let _ = write!(text, " and the friction of {joints}");
        }
        let mut unknown = groups(&excited.unknown_parameters);
        if !excited.unknown_friction.is_empty() {
            unknown.push(format!("the friction of {}", listed("joint", &excited.unknown_friction)));
        }
        if unknown.is_empty() {
            return vec![wrap(&(text + "."), "")];
        }
        let unknown = enumerated(&unknown);
        let _ = write!(text, ", but not {unknown}: the model holds for similar motions only.");
        // no line is broken inside a command
        let command = format!("rne excite {}", one_line(&self.file.display().to_string())).replace(' ', TIED);
        let next = format!("{TYPED}`{command}`{TYPED:#} designs a better motion.");
        vec![wrap(&text, ""), wrap(&next, "")]
    }

    /// Writes the errors by joint, a row for each.
    pub(crate) fn errors(&self, cutoff: f64) -> String {
        let has = |side: fn(&JointVerdict) -> bool| self.verdict.joints.iter().any(side);
        let (has_fitted, has_other) = (has(|joint| joint.fitted.is_some()), has(|joint| joint.other.is_some()));
        let both = has_fitted && has_other;
        let mut heading = vec!["  joint"];
        heading.extend(has_fitted.then_some(if both { "fitted" } else { "error" }));
        heading.extend(has_other.then_some(if both { "held out" } else { "error" }));
        heading.extend(["residual", "", ""]);
        let mut cells: Vec<Vec<String>> = vec![heading.into_iter().map(str::to_owned).collect()];
        for (joint, verdict) in self.robot.independent_joints().zip(&self.verdict.joints) {
            let mut row = vec![format!("  {}", shortened(&one_line(&joint.name), 20))];
            row.extend([verdict.fitted, verdict.other].into_iter().flatten().map(|error| tenths(error.error)));
            row.push(verdict.error().map_or(String::new(), |error| rounded(error.residual, 3)));
            row.push(joint.row.kind.effort_unit().to_owned());
            row.push(self.mark(verdict));
            cells.push(row);
        }
        let mut last = vec!["  median".to_owned()];
        let sides: [fn(&JointVerdict) -> Option<f64>; 2] =
            [|joint| Some(joint.fitted?.error), |joint| Some(joint.other?.error)];
        for side in sides {
            let errors: Vec<f64> = self.verdict.joints.iter().filter_map(side).collect();
            last.extend((!errors.is_empty()).then(|| tenths(median(errors))));
        }
        cells.push(last);
        let mut align = vec![Align::Left, Align::Right];
        align.extend(both.then_some(Align::Right));
        align.extend([Align::Right, Align::Left, Align::Left]);
        let lines = columns(&align, &cells);
        let (title, of_residual) =
            if both { (" on the fitted and on the held-out part", ", on the held-out part") } else { ("", "") };
        let all = match self.verdict.evidence {
            Evidence::Judged => "errors by speed, too",
            _ => "parameters, friction and errors by speed",
        };
        let about = format!(
            "error: RMS of measured - predicted torque over the standard deviation of the measured torque, both \
             low-passed at {cutoff:.1} Hz, at most {} counts as {}; residual: this RMS itself{of_residual}. \
             {TYPED}--all{TYPED:#} prints {all}.",
            percent(Verdict::limit()),
            self.not_predicted().trim_start_matches("not ")
        );
        let about = wrap(&about, "");
        let mut text = format!("\n{TITLE}errors by joint{title}{TITLE:#}\n{QUIET}{about}\n{}{QUIET:#}\n", lines[0]);
        for line in &lines[1..] {
            let fails = self.not_predicted();
            let marked = line.replace(fails, &format!("{WARNING}{fails}{WARNING:#}"));
            let _ = writeln!(text, "{marked}");
        }
        text
    }

    /// Returns the mark of a joint that is not predicted, with the first reason.
    fn mark(&self, verdict: &JointVerdict) -> String {
        if verdict.is_predicted {
            return String::new();
        }
        let reason = match verdict.doubts.first() {
            None => "",
            Some(Doubt::Unexplained) => ": unexplained efforts",
            Some(Doubt::NotExcited) => ": not excited",
            Some(Doubt::Offset { .. }) => ": offset",
            Some(Doubt::Outliers(_)) => ": outliers",
            Some(Doubt::Standstill(_)) => ": stands still",
            Some(Doubt::WithoutFriction) => ": no friction in the file",
            Some(Doubt::FrictionNotExcited) => ": friction not excited",
            Some(_) => ": larger than fitted",
        };
        format!("{}{reason}", self.not_predicted())
    }

    /// Returns a note on joints whose offset the logs do not determine.
    pub(crate) fn offsets(&self) -> Option<String> {
        let unknown = &self.verdict.excited.as_ref()?.unknown_offsets;
        let is_equal = |joint: &usize| {
            let coulomb = self
                .robot
                .independent_joint(*joint)
                .and_then(|joint| joint.motor)
                .map_or([0.0; 2], |motor| motor.coulomb);
            coulomb[0] == -coulomb[1]
        };
        let joints = listed("joint", unknown);
        let written = if unknown.iter().all(is_equal) {
            format!("rne uses the same Coulomb friction in both directions of {joints}")
        } else {
            format!("rne keeps the ratio of FILE between the Coulomb friction in both directions of {joints}")
        };
        (!unknown.is_empty()).then(|| {
            format!("the log does not determine the offset of {joints}: gravity hides it. Therefore {written}")
        })
    }

    /// Returns a warning on joints whose held-out error is much larger than the error on the fitted data.
    pub(crate) fn grown(&self) -> Option<String> {
        let joints = self.robot.independent_joints().zip(&self.verdict.joints);
        let named = joints.filter(|(_, verdict)| verdict.growth().is_some()).map(|(joint, verdict)| {
            let part = |error: Option<rne_identify::JointError>| percent(error.map_or(f64::NAN, |error| error.error));
            format!("{} ({}, fitted {})", one_line(&joint.name), part(verdict.other), part(verdict.fitted))
        });
        let named: Vec<String> = named.collect();
        (!named.is_empty()).then(|| {
            format!(
                "the held-out error is more than twice the error on the fitted part: {}. The model fits these joints \
                 better than it predicts them; a longer log, or a log of a motion that excites more, helps",
                named.join(", ")
            )
        })
    }
}

/// Writes a joint with the error on which its verdict depends.
fn named(joint: &Joint, verdict: &JointVerdict) -> String {
    let error = verdict.error().map_or(f64::NAN, |error| error.error);
    format!("{} ({})", shortened(&one_line(&joint.name), 30), percent(error))
}

/// Wraps words into lines of a page.
fn wrap(text: &str, indent: &str) -> String {
    layout::wrap(text, PAGE, indent).replace(TIED, " ")
}

/// Writes a range of errors from the smallest to the largest.
fn range(errors: &[f64]) -> String {
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let most = errors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (from, to) = (percent(least), percent(most));
    if from == to { to } else { format!("{} to {to}", from.trim_end_matches("\u{A0}%")) }
}

/// Writes a part with two digits of percent; no line is broken in it.
fn percent(part: f64) -> String {
    match 100.0 * part {
        percent if percent.is_nan() => "no error".to_owned(),
        percent if percent < 9.95 => format!("{percent:.1}{TIED}%"),
        percent if percent < 1000.0 => format!("{percent:.0}{TIED}%"),
        _ => format!(">{TIED}999{TIED}%"),
    }
}

/// Writes a part in percent with one decimal, for a table; `-` if the effort does not change, so that there is no
/// relative error.
pub(crate) fn tenths(part: f64) -> String {
    match 100.0 * part {
        percent if percent.is_nan() => "-".to_owned(),
        percent if percent < 1000.0 => format!("{percent:.1} %"),
        _ => "> 999 %".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_errors_are_short() {
        assert_eq!(range(&[0.0391, 0.153, 0.05]), "3.9 to 15 %".replace(" %", "\u{A0}%"));
        assert_eq!(range(&[0.0391]), "3.9 %".replace(" %", "\u{A0}%"));
        assert_eq!(range(&[0.0996, 0.1004]), "10 %".replace(" %", "\u{A0}%"));
    }
}
