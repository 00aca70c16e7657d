//! Couplings: joints that follow others, such as the second finger of a gripper.

use crate::{Limits, Robot};

/// How a joint follows others: its position is Σ ratio · q + offset, with the positions q of the joints that it
/// follows. Such a joint, a follower, is not among the coordinates of the robot: q, q̇, q̈ and τ have no element for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// The joints that it follows, counted from 0, in the order of the rows, and the ratio of each: rad/rad, m/m, m/rad
    /// or rad/m. None of them is a follower, and no ratio is zero.
    pub follows: Vec<(usize, f64)>,
    /// The position of the joint where those that it follows are at 0, rad or m.
    pub offset: f64,
}

impl Coupling {
    /// The limits of the one joint that the follower follows, by which the follower keeps within its own limits of
    /// position and speed; `None` where it follows several. An effort limit of the follower limits no torque of this
    /// joint, because gravity and inertia act on the follower, too.
    pub(crate) fn limits_of_followed(&self, follower: Limits) -> Option<(usize, Limits)> {
        let &[(joint, ratio)] = self.follows.as_slice() else { return None };
        let position = follower.position.map(|(lower, upper)| {
            // + 0.0 makes a zero of a negative zero
            let [a, b] = [lower, upper].map(|end| (end - self.offset) / ratio + 0.0);
            (a.min(b), a.max(b))
        });
        let velocity = follower.velocity.map(|velocity| velocity / ratio.abs());
        Some((joint, Limits { position, velocity, effort: None }))
    }
}

impl Limits {
    /// The narrower of both limits each; without a position within both, the own ones.
    fn narrowed(self, other: Self) -> Self {
        let position = match (self.position, other.position) {
            (Some((lower, upper)), Some((low, high))) if low.max(lower) <= high.min(upper) => {
                Some((low.max(lower), high.min(upper)))
            }
            (own, other) => own.or(other),
        };
        let velocity = [self.velocity, other.velocity].into_iter().flatten().reduce(f64::min);
        Self { position, velocity, effort: self.effort }
    }
}

impl Robot {
    /// Limits of the coordinates, in the order of q: those of the joint, narrowed so that each joint that follows it
    /// alone is within its own limits of position and speed. Effort limits are those of the joint, and limits of a
    /// joint that follows several are in none of them.
    #[must_use]
    pub fn coordinate_limits(&self) -> Vec<Limits> {
        let limits = |index: usize| {
            let of_followers = self.joints.iter().filter_map(|joint| {
                let (followed, limits) = joint.coupling.as_ref()?.limits_of_followed(joint.limits)?;
                (followed == index).then_some(limits)
            });
            of_followers.fold(self.joints[index].limits, Limits::narrowed)
        };
        self.coordinates().map(limits).collect()
    }
}
