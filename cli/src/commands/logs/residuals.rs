//! Writes measured, predicted and residual torques of a log as a table, one row for each state.

use std::fmt::Write as _;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use rne_identify::{Part, Prediction};
use rne_logs::Motion;
use rne_model::{Robot, one_line};

use crate::files::motion_log::MotionLog;
use crate::files::output_file::{Replacement, unwritable};
use crate::outcome::Failure;
use crate::palette::GOOD;
use crate::render::layout::cell;

/// Writes the torques of a robot and of parts of a log, both low-pass filtered, as CSV. A column says whether a part
/// was held out. The rows are the states of the picture, which are every n-th state of a long log. Returns a remark on
/// the file.
pub(crate) fn write(path: &Path, robot: &Robot, log: &MotionLog, parts: &[(Part, bool)]) -> Result<String, Failure> {
    let failure = |error: io::Error| unwritable(path, &error);
    let replacement = Replacement::begin(path).map_err(failure)?;
    let mut out = BufWriter::new(replacement.file().map_err(failure)?);
    writeln!(out, "{}", header(robot)).map_err(failure)?;
    let prediction = Prediction::new(robot, Some(log.cutoff()));
    let mut states = 0_u64;
    let mut failed = None;
    for (part, is_held_out) in parts {
        log.pass(*part, &mut |motion: &Motion| {
            let pairs = prediction.pairs(motion).map_err(|error| error.to_string())?;
            states += motion.len() as u64;
            rows(&mut out, motion, &pairs, *is_held_out).map_err(|error| {
                let what = error.to_string();
                failed = Some(error);
                what
            })
        })
        .map_err(|stopped| failed.take().map_or(stopped, failure))?;
    }
    out.flush().map_err(failure)?;
    drop(out);
    replacement.keep().map_err(failure)?;
    Ok(format!("{GOOD}wrote{GOOD:#} {}, {states} states\n", path.display()))
}

/// Returns the names of the columns.
fn header(robot: &Robot) -> String {
    let mut header = "t".to_owned();
    for joint in &robot.joints {
        for column in ["measured", "predicted", "residual"] {
            let _ = write!(header, ",{}", cell(&format!("{}.{column}", one_line(&joint.name))));
        }
    }
    header + ",held_out"
}

/// Writes the rows of a motion.
fn rows(out: &mut impl Write, motion: &Motion, pairs: &[Vec<(f64, f64)>], is_held_out: bool) -> io::Result<()> {
    let mut line = String::new();
    for (at, time) in motion.time.iter().enumerate() {
        line.clear();
        let _ = write!(line, "{time}");
        for (measured, predicted) in pairs.iter().map(|pairs| pairs[at]) {
            let _ = write!(line, ",{measured},{predicted},{}", measured - predicted);
        }
        writeln!(out, "{line},{}", u8::from(is_held_out))?;
    }
    Ok(())
}
