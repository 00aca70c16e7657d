//! Remarks on links and joints that the walk through the tree meets.

use rne_model::{Remedy, Transform, one_line, six_digits};

use super::walk::Walk;
use crate::frames::transform;
use crate::geometry::Pose;
use crate::remark::Remark;
use crate::source::{names, quoted};

impl Walk<'_> {
    /// Adds the remarks on a moving joint of the chain.
    pub(super) fn remark(&mut self, index: usize) {
        self.told.joints.insert(index);
        let joint = &self.urdf.joints[index];
        let name = one_line(&joint.name);
        if !joint.has_axis {
            self.told.remarks.push(format!("the joint {name} has no element `axis`, so its axis is 1 0 0"));
        }
        if let Some((lower, upper)) = joint.crossed {
            self.told.remarks.push(Remark::warning(format!(
                "the joint {name} has a lower limit, {lower}, above its upper limit, {upper}; rne ignores both limits"
            )));
        }
        for (limit, value) in &joint.negative {
            let what = format!("the joint {name} has a negative limit of {limit}, {value}; rne ignores it");
            self.told.remarks.push(Remark::warning(what));
        }
    }

    /// Adds a remark if the mass of the fixed base is left out.
    pub(super) fn remark_on_standing_base(&mut self) {
        if self.standing > 0.0 {
            let mass = six_digits(self.standing);
            let remark = Remark::from(format!("the base stands still: its mass of {mass} kg is left out"));
            // if a link floats in the file, another remark already says how the base can float
            let remark = if self.urdf.floats.is_none() { remark.remedy(Remedy::Float) } else { remark };
            self.told.remarks.push(remark);
        }
    }

    /// Adds a remark and records whether the link that floats in the file becomes a floating base; `placement` is that
    /// of its joint in the world, or `None` if it does not.
    pub(super) fn look_at_floating(&mut self, placement: Option<Pose>) {
        let Some(link) = self.urdf.floats else { return };
        let name = quoted(&self.urdf.links[link].name);
        let floats = placement.is_some();
        let then = if floats { "so the robot has a floating base" } else { "and rne fixes it where the file has it" };
        self.told.remarks.push(format!("the link {name} floats in the file, {then}"));
        self.told.floats = Some(floats);
        // the position of an MJCF free joint is counted from the world, not from the body's place in the file
        if let Some(placement) = placement.map(transform).filter(|it| *it != Transform::IDENTITY)
            && self.urdf.gravity.is_none()
        {
            let Transform { xyz, rpy: [roll, pitch, yaw] } = placement;
            let rpy = [roll.radians, pitch.radians, yaw.radians];
            self.told.remarks.push(format!(
                "the floating joint of {name} has the placement xyz {xyz:?} m, rpy {rpy:?} rad in the world; rne takes \
                 the pose of the base in the world: it is this placement times the position of the joint, such as q of \
                 Pinocchio"
            ));
        }
    }

    /// Adds a remark that the tip is one of several ends.
    pub(super) fn remark_on_other_ends(&mut self, others: &[usize]) {
        if others.is_empty() {
            return;
        }
        let others = names(others.iter().map(|&link| &self.urdf.links[link].name));
        let are = if self.selection.whole { "ends, too" } else { "also after the same joints" };
        self.told.remarks.push(format!("the tip is {}; these links are {are}: {others}", quoted(&self.told.tip)));
    }
}
