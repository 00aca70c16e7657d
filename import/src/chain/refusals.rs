//! Joints that no chain and no whole robot can have.

use rne_model::{Remedy, Report, one_line};

use super::walk::Walk;
use crate::source::{names, quoted, some};
use crate::urdf::Joint;

/// The help for a joint that no row of a table can describe.
const SEVERAL: &str = "a row of the table is one revolute or prismatic joint: write the joint as several of them, such \
                       as a ball as three hinges about x, y and z";

/// Returns the remedy for a joint that must not move: to lock it.
pub(super) fn lock(joint: &str) -> Remedy {
    Remedy::LockJoint { joint: one_line(joint) }
}

impl Walk<'_> {
    /// Refuses a joint of the chain of a kind that a table does not have.
    pub(super) fn refuse(&self, joint: &Joint) -> Result<(), Report> {
        let error = |message: String, help: String| Err(self.urdf.source.error(&joint.span, message, help));
        let name = quoted(&joint.name);
        if !joint.kind.has_one_freedom() {
            let message = format!("the joint {name} on the chain is {}", joint.kind.name());
            return error(message, format!("{SEVERAL}, or choose base and tip so that this joint is not between them"));
        }
        if let Some(mimic) = joint.mimic.as_ref().filter(|_| !self.selection.whole) {
            let message = format!("the joint {name} on the chain follows {}", quoted(&mimic.joint));
            let help = "its torque acts on the joint that it follows, and no row of the table can describe this: end \
                        the chain before this joint, lock it, or import the whole robot"
                .to_owned();
            let remedy = Remedy::WholeOrLock { joint: one_line(&joint.name) };
            return Err(self.urdf.source.error_with(&joint.span, message, help, &remedy));
        }
        if joint.axis == [0.0; 3] {
            return error(
                format!("the axis of the joint {name} has no direction"),
                "write a direction, such as 0 0 1".to_owned(),
            );
        }
        Ok(())
    }

    /// Refuses movable joints outside the chain that are not locked.
    pub(super) fn refuse_loose(&self) -> Result<(), Report> {
        let Some(&first) = self.loose.first() else { return Ok(()) };
        let (joints, whole) = (&self.urdf.joints, self.selection.whole);
        let loose = names(self.loose.iter().map(|&joint| &joints[joint].name));
        let is_before_base = |&joint: &usize| joints[joint].kind.has_one_freedom();
        let [base, tip] = [&self.told.base, &self.told.tip].map(|link| quoted(link));
        let mut help = "hold these joints still, each at a position of its own or all at zero".to_owned();
        let message = if whole && self.loose.iter().any(is_before_base) {
            format!("movable joints that do not come after the base {base}: {loose}")
        } else if whole {
            help = format!("{SEVERAL}, or hold it still at zero");
            format!("joints with more than one freedom, which no row of a table can describe: {loose}")
        } else {
            format!("movable joints that are not on the chain from {base} to {tip}: {loose}")
        };
        Err(self.urdf.source.error_with(&joints[first].span, message, help, &Remedy::LockOthers))
    }

    /// Refuses joints outside the chain that follow joints of the chain.
    pub(super) fn refuse_followers_outside(&self) -> Result<(), Report> {
        let Some(&(first, _)) = self.followers.first() else { return Ok(()) };
        let name = |joint: usize| &self.urdf.joints[joint].name;
        let follows =
            |&(joint, leader): &(usize, usize)| format!("{} follows {}", quoted(name(joint)), quoted(name(leader)));
        let followers = some(self.followers.iter().map(follows));
        let message = format!("joints outside the chain follow moving joints of the chain: {followers}");
        let help = "these joints carry mass, and no row of the table can describe that this mass moves along; if the \
                    mass may stand still, lock each of these joints by its name";
        Err(self.urdf.source.error_with(&self.urdf.joints[first].span, message, help, &lock(name(first))))
    }
}
