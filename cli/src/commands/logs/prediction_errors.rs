//! Computes how much the torques of a robot differ from those of a log, by joint and by speed.

use std::fmt::Write as _;

use rne_identify::{JointError, Part, Prediction, SPEEDS};
use rne_logs::median;
use rne_model::{Robot, one_line};

use crate::files::motion_log::MotionLog;
use crate::outcome::Failure;
use crate::palette::{GOOD, QUIET, TITLE, WARNING};
use crate::render::layout::{Align, PAGE, columns, shortened, wrap};
use crate::render::verdict::tenths;
use crate::values::numbers::rounded;

/// Computes how much the torques of a robot differ from those of a part of a log, for each joint.
pub(crate) fn prediction(robot: &Robot, log: &MotionLog, part: Part) -> Result<Vec<JointError>, Failure> {
    let mut prediction = Prediction::new(robot, Some(log.cutoff()));
    log.pass(part, &mut |motion| prediction.absorb(motion))?;
    Ok(prediction.errors())
}

/// Writes the errors by joint and by speed as a table.
pub(crate) fn errors_table(
    robot: &Robot,
    log: &MotionLog,
    errors: &[JointError],
    unknown: &[bool],
    title: &str,
) -> String {
    let mut heading = ["  joint", "error", "unfiltered", "residual", ""].map(str::to_owned).to_vec();
    heading.extend(SPEEDS.map(|speed| format!("≤ {speed}")));
    heading.push("faster".to_owned());
    let mut cells = vec![heading];
    let (mut filtered, mut unfiltered) = (Vec::new(), Vec::new());
    for (at, (joint, error)) in robot.joints.iter().zip(errors).enumerate() {
        let unit = joint.row.kind.effort_unit();
        let mut line = vec![
            format!("  {}", shortened(&one_line(&joint.name), 14)),
            tenths(error.error),
            tenths(error.unfiltered),
            rounded(error.residual, 3),
            unit.to_owned(),
        ];
        line.extend(error.by_speed.map(|left| if left.is_nan() { "-".to_owned() } else { rounded(left, 3) }));
        if unknown.get(at).is_some_and(|unknown| *unknown) {
            line.push("not excited".to_owned());
        }
        filtered.push(error.error);
        unfiltered.push(error.unfiltered);
        cells.push(line);
    }
    cells.push(vec!["  median".to_owned(), tenths(median(filtered)), tenths(median(unfiltered))]);
    let mut align = vec![Align::Left, Align::Right, Align::Right, Align::Right, Align::Left];
    align.extend([Align::Right; 4]);
    align.push(Align::Left);
    let lines = columns(&align, &cells);
    let about = format!(
        "error: RMS of measured - predicted over the effort's standard deviation, both low-passed at {:.1} Hz; \
         unfiltered: the same with raw efforts, {} of {} states; residual: RMS, then by joint speed in rad/s or m/s",
        log.cutoff(),
        errors.iter().map(|error| error.states).max().unwrap_or_default(),
        log.states()
    );
    let about = wrap(&about, PAGE, "");
    let mut text = format!("\n{TITLE}{title}{TITLE:#}\n{QUIET}{about}\n{}{QUIET:#}\n", lines[0]);
    for line in &lines[1..] {
        let marked = line.replace("not excited", &format!("{WARNING}not excited{WARNING:#}"));
        let marked = match marked.strip_prefix("  median ") {
            Some(rest) => format!("  {GOOD}median{GOOD:#} {rest}"),
            None => marked,
        };
        let _ = writeln!(text, "{marked}");
    }
    text
}
