//! The order of a robot's joints in the arrays of another program.

use core::fmt;

use crate::frame_index;
use crate::values::names::Text;

/// Finds the joints of a robot in the list of names of another program.
///
/// `order[i]` is the place of the robot's joint `i` in `names`, so that `q[i] = theirs[order[i]]`:
///
/// ```
/// use rne_runtime::{JointOrderError, joint_order};
///
/// let joints = ["waist", "shoulder", "elbow"];
/// let order = joint_order(&joints, &["elbow", "shoulder", "waist"], false)?;
/// assert_eq!(order, [2, 1, 0]);
/// let mut theirs = [0.3, 0.2, 0.1];
/// let q = order.map(|place| theirs[place]);
/// assert_eq!(q, [0.1, 0.2, 0.3]);
/// // and back
/// for (place, value) in order.into_iter().zip(q) {
///     theirs[place] = value;
/// }
///
/// let gripper = ["waist", "gripper", "shoulder", "elbow"];
/// assert_eq!(joint_order(&joints, &gripper, true)?, [0, 2, 3]);
/// assert_eq!(joint_order(&joints, &gripper, false), Err(JointOrderError::Unknown("gripper")));
/// # Ok::<(), JointOrderError>(())
/// ```
///
/// # Errors
/// When a joint of the robot is not in the list or is in the list twice; unless `takes_others`, also when the list has
/// a name that no joint of the robot has.
pub const fn joint_order<'a, const DOF: usize>(
    joints: &[&'a str; DOF],
    names: &[&'a str],
    takes_others: bool,
) -> Result<[usize; DOF], JointOrderError<'a>> {
    let mut at = 0;
    while at < names.len() && !takes_others {
        if frame_index(joints, names[at]).is_none() {
            return Err(JointOrderError::Unknown(names[at]));
        }
        at += 1;
    }
    let mut order = [0; DOF];
    let mut joint = 0;
    while joint < DOF {
        let Some(place) = frame_index(names, joints[joint]) else {
            return Err(JointOrderError::Missing(joints[joint]));
        };
        if frame_index(names.split_at(place + 1).1, joints[joint]).is_some() {
            return Err(JointOrderError::Twice(joints[joint]));
        }
        order[joint] = place;
        joint += 1;
    }
    Ok(order)
}

/// Why a list of names gives no order of a robot's joints. Each variant contains the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointOrderError<'a> {
    /// A name in the list that no joint of the robot has.
    Unknown(&'a str),
    /// A joint of the robot that is not in the list.
    Missing(&'a str),
    /// A joint of the robot that is in the list twice.
    Twice(&'a str),
}

impl JointOrderError<'_> {
    /// Returns the name, and the words after it in the message.
    const fn words(&self) -> (&str, &'static str) {
        match self {
            Self::Unknown(name) => (name, "` in the list is not a joint of the robot"),
            Self::Missing(name) => (name, "` is a joint of the robot, but is not in the list"),
            Self::Twice(name) => (name, "` is in the list twice"),
        }
    }

    /// Panics with the message of the error, `remark`, and the joint that a name probably means. The functions `order`
    /// of derived robots call it and so stop the build. `followers` has the names of the joints that follow others,
    /// each with its remark.
    ///
    /// # Panics
    /// Always.
    #[doc(hidden)]
    pub const fn stop(&self, joints: &[&str], remark: &str, followers: &[[&str; 2]]) -> ! {
        let (name, words) = self.words();
        let mut at = 0;
        while at < followers.len() && matches!(self, Self::Unknown(_)) {
            let [follower, words] = followers[at];
            let is_follower = frame_index(&[follower], name).is_some();
            assert!(!is_follower, "{}", Text::EMPTY.with("`").with(name).with(words).as_str());
            at += 1;
        }
        let text = Text::EMPTY.with("`").with(name).with(words).with(remark);
        let text = if matches!(self, Self::Unknown(_)) { text.with_nearest(joints, name) } else { text };
        panic!("{}", text.as_str())
    }
}

impl fmt::Display for JointOrderError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, words) = self.words();
        write!(f, "`{name}{words}")
    }
}

impl core::error::Error for JointOrderError<'_> {}

#[cfg(test)]
mod tests {
    use super::{JointOrderError, joint_order};

    const JOINTS: [&str; 3] = ["a", "b", "ab"];

    #[test]
    fn every_mistake_names_the_joint() {
        let order = |names: &[&'static str], others| joint_order(&JOINTS, names, others);
        assert_eq!(order(&["ab", "a", "b"], false), Ok([1, 2, 0]));
        assert_eq!(order(&["ab", "a"], false), Err(JointOrderError::Missing("b")));
        assert_eq!(order(&["ab", "a", "c"], true), Err(JointOrderError::Missing("b")));
        assert_eq!(order(&["ab", "a", "c"], false), Err(JointOrderError::Unknown("c")));
        assert_eq!(order(&["ab", "a", "b", "a"], true), Err(JointOrderError::Twice("a")));
        assert_eq!(order(&["x", "ab", "x", "a", "b"], true), Ok([3, 4, 1]));
        assert_eq!(order(&[], false), Err(JointOrderError::Missing("a")));
        let text = JointOrderError::Missing("b").to_string();
        assert_eq!(text, "`b` is a joint of the robot, but is not in the list");
    }
}
