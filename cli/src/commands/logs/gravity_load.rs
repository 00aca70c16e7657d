//! Computes the effort that gravity alone needs at rest, because it may leave no effort for a motion.

use rne_identify::{ExcitationError, MotionLimits};
use rne_machine::{CompiledArm, Form};
use rne_model::{Joint, Robot, one_line};

use crate::commands::logs::excite::failure;
use crate::outcome::Failure;
use crate::remedy;
use crate::values::numbers::rounded;

/// Makes the error for a search that found no motion within the effort limits. Where gravity alone exceeds them, it
/// says so, because a slower motion would not help.
pub(super) fn beyond_effort(robot: &Robot, limits: &[MotionLimits], error: &ExcitationError) -> Failure {
    let none = "no motion was found within the effort limits";
    let Some(loads) = Load::all(robot, limits) else { return failure(error) };
    let [Some(middle), Some(least), Some(most)] = [
        loads.first(),
        loads.iter().reduce(|least, load| if load.part < least.part * (1.0 - SAME) { load } else { least }),
        loads.iter().reduce(|most, load| if load.part > most.part * (1.0 + SAME) { load } else { most }),
    ] else {
        return failure(error);
    };
    let helps = "neither a slower motion nor a smaller --range helps";
    Failure::input(if least.part > 1.0 {
        let name = one_line(robot.coordinate_name(least.joint));
        format!(
            "{none}: {}, and gravity needs no less at {POSITIONS} positions within the limits, so {helps}: check the \
             effort limit of {name} and the masses that this joint carries",
            least.words(robot, limits)
        )
    } else if middle.part > 1.0 {
        format!(
            "{none}: {}, which is the middle of the limits, so {helps}; set position limits in the robot file around a \
             posture that needs less",
            middle.words(robot, limits)
        )
    } else if most.part > 1.0 {
        format!(
            "{}; {}; use a smaller --range to avoid this posture",
            remedy::of_excitation(error),
            most.words(robot, limits)
        )
    } else {
        return failure(error);
    })
}

/// Number of positions at which gravity torques are computed.
const POSITIONS: u32 = 2000;

/// Relative difference below which two loads count as equal.
const SAME: f64 = 1e-9;

/// The load by gravity at rest, on the joint that has the least effort in reserve.
struct Load {
    q: Vec<f64>,
    joint: usize,
    /// Torque or force that gravity needs, N m or N.
    needed: f64,
    /// The torque or force that gravity needs, as a part of the joint's effort limit; above 1 it exceeds the limit.
    part: f64,
}

impl Load {
    /// Computes the loads at positions that fill the range of the limits evenly, the first in the middle: multiples of
    /// powers of the root of x^(n + 1) = x + 1 for n joints, without their whole parts (Roberts, The Unreasonable
    /// Effectiveness of Quasirandom Sequences, 2018). `None` if there are no effort limits.
    fn all(robot: &Robot, limits: &[MotionLimits]) -> Option<Vec<Self>> {
        let arm = CompiledArm::from_robot(robot).in_form(Form::SevenSteps);
        let power = f64::from(u32::try_from(robot.dof() + 1).ok()?);
        let root = (0..60).fold(2.0_f64, |root, _| (1.0 + root).powf(1.0 / power));
        let at = |number: u32| {
            let mut step = 1.0;
            let of_joint = limits.iter().map(|limits| {
                step /= root;
                let (lower, upper) = limits.position;
                lower + (upper - lower) * (0.5 + f64::from(number) * step).fract()
            });
            of_joint.collect::<Vec<f64>>()
        };
        (0..POSITIONS).map(|number| Self::of(&arm, limits, at(number))).collect()
    }

    fn of(arm: &CompiledArm, limits: &[MotionLimits], q: Vec<f64>) -> Option<Self> {
        let torques = arm.gravity_torques(&q).ok()?;
        let parts = torques.iter().zip(limits).map(|(torque, limits)| Some((torque.abs(), limits.effort?)));
        let parts = parts.enumerate().filter_map(|(joint, part)| Some((joint, part?)));
        let (joint, (needed, limit)) = parts.max_by(|(_, a), (_, b)| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
        Some(Self { q, joint, needed, part: needed / limit })
    }

    fn words(&self, robot: &Robot, limits: &[MotionLimits]) -> String {
        let position = |(joint, q): (&Joint, &f64)| {
            format!("{} {} {}", one_line(&joint.name), rounded(*q, 3), joint.row.kind.position_unit())
        };
        let positions: Vec<String> = robot.independent_joints().zip(&self.q).map(position).collect();
        format!(
            "gravity alone needs {} of {} {} of {} at {}",
            rounded(self.needed, 3),
            limits[self.joint].effort.map_or_else(String::new, |limit| rounded(limit, 3)),
            robot.coordinate_kind(self.joint).effort_unit(),
            one_line(robot.coordinate_name(self.joint)),
            positions.join(", ")
        )
    }
}
