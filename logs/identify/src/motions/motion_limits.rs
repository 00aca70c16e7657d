//! Limits of position, speed and acceleration of joints: from the robot file, from the caller, or a careful default.

use rne_model::{Joint, JointKind, Robot, one_line};

use crate::motions::excitation_error::ExcitationError;

/// Largest angle, in both directions, of a revolute joint without limits, rad.
const TURN: f64 = std::f64::consts::PI;
/// Speed limits of joints without one, rad/s and m/s; ISO 10218 calls 250 mm/s reduced speed.
const SPEED: [f64; 2] = [1.0, 0.25];
/// Time in which a joint reaches its speed limit if no acceleration limit is given, s: robot files have none.
const RISE: f64 = 0.5;

/// Limits that the caller gives in addition to those of the robot file: one number for all joints, or one for each, in
/// rad or m, rad/s or m/s, and rad/s² or m/s².
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct AskedLimits {
    /// Largest distance of a joint from the middle of its limits in the file, or from zero if it has no limits.
    pub range: Option<Vec<f64>>,
    /// The largest speed; the limit of the file applies too.
    pub velocity: Option<Vec<f64>>,
    /// The largest acceleration.
    pub acceleration: Option<Vec<f64>>,
}

/// Limits of the motion of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MotionLimits {
    /// Lower and upper end, rad or m.
    pub position: (f64, f64),
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
    /// Largest acceleration, rad/s² or m/s².
    pub acceleration: f64,
    /// Largest effort, N m or N; `None` if the file has no limit, or no masses by which torques are predicted.
    pub effort: Option<f64>,
}

impl MotionLimits {
    /// Returns the limits of every joint of a robot.
    ///
    /// A revolute joint without limits moves between -π and π. Without a speed limit, a joint moves with 1 rad/s or
    /// 0.25 m/s at most; without an acceleration limit, it reaches its speed in half a second.
    ///
    /// # Errors
    /// When the length of a list is wrong or a number is not positive, when a prismatic joint has no limits, or when
    /// limits do not allow a joint to move.
    pub fn of(robot: &Robot, asked: &AskedLimits) -> Result<Vec<Self>, ExcitationError> {
        let dof = robot.dof();
        let lists = [("range", &asked.range), ("velocity", &asked.velocity), ("acceleration", &asked.acceleration)];
        for (what, list) in lists.iter().filter_map(|(what, list)| Some((*what, list.as_ref()?))) {
            if list.len() != 1 && list.len() != dof {
                return Err(ExcitationError::Length { what, found: list.len(), joints: dof });
            }
            if !list.iter().all(|number| number.is_finite() && *number > 0.0) {
                return Err(ExcitationError::NotPositive(what));
            }
        }
        let asked_for = |list: &Option<Vec<f64>>, joint: usize| {
            let list = list.as_ref()?;
            list.get(joint).or(list.first()).copied()
        };
        let has_masses = robot.joints.iter().any(|joint| {
            let link = &joint.row.link;
            link.mass > 0.0 || link.has_first_moment()
        });
        let limits = robot.independent_joints().enumerate().map(|(at, joint)| {
            let position = position(joint, asked_for(&asked.range, at))?;
            let velocity =
                [asked_for(&asked.velocity, at), joint.limits.velocity].into_iter().flatten().reduce(f64::min);
            let velocity = velocity.unwrap_or(SPEED[usize::from(joint.row.kind == JointKind::Prismatic)]);
            let acceleration = asked_for(&asked.acceleration, at).unwrap_or(velocity / RISE);
            let effort = joint.limits.effort.filter(|_| has_masses);
            let what = if position.1 <= position.0 {
                "position"
            } else if velocity <= 0.0 {
                "velocity"
            } else if effort == Some(0.0) {
                "effort"
            } else {
                return Ok(Self { position, velocity, acceleration, effort });
            };
            Err(ExcitationError::NoRoom { joint: one_line(&joint.name), what })
        });
        limits.collect()
    }
}

/// Returns the position limits of the file, or the default ones about zero, reduced to at most `range` from their
/// middle.
fn position(joint: &Joint, range: Option<f64>) -> Result<(f64, f64), ExcitationError> {
    let (middle, half) = match joint.limits.position {
        Some((lower, upper)) => match range.filter(|range| 2.0 * range < upper - lower) {
            Some(range) => (f64::midpoint(lower, upper), range),
            None => return Ok((lower, upper)),
        },
        None if joint.row.kind == JointKind::Revolute => (0.0, range.unwrap_or(TURN)),
        None => (0.0, range.ok_or_else(|| ExcitationError::NoPosition { joint: one_line(&joint.name) })?),
    };
    Ok((middle - half, middle + half))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = "
        {format: 1, name: arm, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [
        {name: turn, type: revolute, limits: {position: [-1, 2], velocity: 3, effort: 40},
         dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1}},
        {name: free, type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}},
        {name: slide, type: prismatic, LIMITS dh: {theta: 0, d: 0, a: 0, alpha: 0}}]}";

    fn arm(limits: &str) -> Robot {
        Robot::from_yaml(&ARM.replace("LIMITS", limits)).unwrap_or_else(|report| panic!("{report}"))
    }

    #[test]
    fn the_file_then_what_is_asked_then_the_default() {
        let robot = arm("limits: {position: [0.1, 0.5]},");
        let limits = MotionLimits::of(&robot, &AskedLimits::default()).unwrap();
        assert_eq!(
            limits.iter().map(|joint| joint.position).collect::<Vec<_>>(),
            [(-1.0, 2.0), (-TURN, TURN), (0.1, 0.5)]
        );
        assert_eq!(limits.iter().map(|joint| joint.velocity).collect::<Vec<_>>(), [3.0, 1.0, 0.25]);
        assert_eq!(limits.iter().map(|joint| joint.acceleration).collect::<Vec<_>>(), [6.0, 2.0, 0.5]);
        assert_eq!(limits.iter().map(|joint| joint.effort).collect::<Vec<_>>(), [Some(40.0), None, None]);
        let asked = AskedLimits {
            range: Some(vec![0.5]),
            velocity: Some(vec![1.0, 4.0, 0.1]),
            acceleration: Some(vec![7.0, 8.0, 9.0]),
        };
        let limits = MotionLimits::of(&arm(""), &asked).unwrap();
        assert_eq!(limits[0].position, (0.0, 1.0));
        assert_eq!((limits[1].position, limits[2].position), ((-0.5, 0.5), (-0.5, 0.5)));
        assert_eq!(limits.iter().map(|joint| joint.velocity).collect::<Vec<_>>(), [1.0, 4.0, 0.1]);
        assert_eq!(limits[2].acceleration, 9.0);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let refused = |limits: &str, asked: &AskedLimits| {
            MotionLimits::of(&arm(limits), asked).map(|_| ()).unwrap_err().to_string()
        };
        let said = refused("", &AskedLimits::default());
        assert!(said.contains("slide") && said.contains("position") && said.contains("give a range"), "{said}");
        for limits in ["position: [1, 1]", "position: [0, 1], velocity: 0", "position: [0, 1], effort: 0"] {
            let said = refused(&format!("limits: {{{limits}}},"), &AskedLimits::default());
            assert!(said.contains("slide") && said.contains("no room"), "{said}");
        }
        for (list, words) in [(vec![1.0, 2.0], "2 numbers"), (vec![-1.0], "above 0"), (vec![f64::NAN], "above 0")] {
            let asked = AskedLimits { velocity: Some(list), ..AskedLimits::default() };
            let said = refused("limits: {position: [0, 1]},", &asked);
            assert!(said.starts_with("velocity") && said.contains(words), "{said}");
        }
    }
}
