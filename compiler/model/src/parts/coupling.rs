//! Couplings: joints that follow others, such as the second finger of a gripper.

use crate::{Limits, Robot};

/// How a joint follows others: its position is Σ ratio · q + offset, with the positions q of the joints that it
/// follows. Such a joint, a follower, is not a coordinate of the robot: q, q̇, q̈ and τ have no element for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// The joints that the follower follows, counted from 0, in the order of the rows, and the ratio of each: rad/rad,
    /// m/m, m/rad or rad/m. None of them is a follower, and no ratio is zero.
    pub follows: Vec<(usize, f64)>,
    /// The position of the follower where all joints that it follows are at 0, rad or m.
    pub offset: f64,
}

impl Coupling {
    /// Returns the joint that the follower follows, and limits for this joint that keep the follower within its own
    /// limits of position and speed; `None` where it follows several. An effort limit of the follower limits no torque
    /// of the followed joint, because gravity and inertia act on the follower, too.
    pub(crate) fn limits_of_followed(&self, follower: Limits) -> Option<(usize, Limits)> {
        let &[(joint, ratio)] = self.follows.as_slice() else { return None };
        let position = follower.position.map(|(lower, upper)| {
            // adding 0.0 changes -0 to 0
            let [a, b] = [lower, upper].map(|end| (end - self.offset) / ratio + 0.0);
            (a.min(b), a.max(b))
        });
        let velocity = follower.velocity.map(|velocity| velocity / ratio.abs());
        Some((joint, Limits { position, velocity, effort: None }))
    }
}

impl Limits {
    /// Returns the narrower of both limits for each quantity; where no position satisfies both, the position limits of
    /// `self`.
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
    /// Returns the limits of the coordinates, in the order of q. They are those of the joint, narrowed so that each
    /// joint that follows only this one stays within its own limits of position and speed. Effort limits are those of
    /// the joint itself; limits of a joint that follows several others have no effect.
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
