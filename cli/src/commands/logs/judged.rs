//! The errors and the picture of a part of a log on which a robot was judged.

use rne_identify::{JointError, JudgedPart, MotionError, Part, Prediction};
use rne_logs::Motion;
use rne_model::Robot;
use rne_plot::{Comparison, comparison_svg};

use crate::files::motion_log::MotionLog;
use crate::outcome::Failure;

/// Number of states in a picture.
const DRAWN: u64 = 4000;

/// A part of a log on which a robot was judged, with its errors.
pub(super) struct Judged {
    part: Part,
    pub(super) errors: Vec<JointError>,
    pub(super) extent: JudgedPart,
}

impl Judged {
    pub(super) fn of(robot: &Robot, log: &MotionLog, part: Part) -> Result<Self, Failure> {
        let mut prediction = Prediction::new(robot, Some(log.cutoff()));
        let mut extent = JudgedPart::default();
        log.pass(part, &mut |motion| {
            extent.add(motion);
            prediction.absorb(motion)
        })?;
        Ok(Self { part, errors: prediction.errors(), extent })
    }

    /// Describes the part, such as `from 13.5 s on`.
    pub(super) fn words(&self, log: &MotionLog) -> String {
        match self.extent.from {
            // only with one run, because the times of several runs may overlap
            Some(from) if log.runs() == 1 => format!("from {from:.1} s on"),
            _ => format!("the last {} of {} states", self.extent.states, log.states()),
        }
    }

    /// Draws the measured and the predicted torques, with a title and the text `about` below.
    pub(super) fn picture(&self, robot: &Robot, log: &MotionLog, title: &str, about: &str) -> Result<String, Failure> {
        let stride = usize::try_from(self.extent.states.div_ceil(DRAWN)).unwrap_or(usize::MAX).max(1);
        let prediction = Prediction::new(robot, Some(log.cutoff()));
        let (mut time, mut pairs) = (Vec::new(), vec![Vec::new(); robot.dof()]);
        log.pass(self.part, &mut |motion: &Motion| {
            time.extend(motion.time.iter().step_by(stride));
            for (all, of) in pairs.iter_mut().zip(prediction.pairs(motion)?) {
                all.extend(of.into_iter().step_by(stride));
            }
            Ok::<(), MotionError>(())
        })?;
        let side = |of: fn(&(f64, f64)) -> f64| -> Vec<Vec<f64>> {
            pairs.iter().map(|pairs: &Vec<(f64, f64)>| pairs.iter().map(of).collect()).collect()
        };
        // the same error that the table has
        let notes: Vec<String> =
            self.errors.iter().map(|error| format!("error {:.1} %", 100.0 * error.error)).collect();
        let picture = Comparison {
            title,
            about: &format!("{about}; both torques low-passed at {:.1} Hz", log.cutoff()),
            time: &time,
            measured: &side(|pair| pair.0),
            predicted: &side(|pair| pair.1),
            notes: &notes,
        };
        Ok(comparison_svg(robot, &picture))
    }
}
