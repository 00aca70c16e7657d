//! Joints and tips on a link. The lecture's chain has one of them on each link.

use crate::formulate::{Arm, Mount, Wrench};
use crate::ir::{JointLines, Matrix, Quantity, Vector};

/// One joint or tip on a link: the wrench f_{i,k}, n_{i,k} that the link exerts there, in the axes of the link, and
/// the vector r_k from its centre of mass.
#[derive(Clone)]
struct Carried<'s> {
    wrench: Wrench<'s>,
    r: Vector<'s>,
}

/// The joints and tips on one link.
#[derive(Clone, Default)]
pub(crate) struct Load<'s>(Vec<Carried<'s>>);

impl<'s> Load<'s> {
    /// Puts on a joint or tip: R_k f_{i,k} and R_k n_{i,k}. `line` is that of the link.
    pub(crate) fn put(&mut self, line: JointLines<'s>, rotation: Matrix<'s>, mount: &Mount<'s>, wrench: &Wrench<'s>) {
        let line = line.carrying(mount.label);
        let force = line.define(Quantity::ChildForce).by(rotation * wrench.force);
        let moment = line.define(Quantity::ChildMoment).by(rotation * wrench.moment);
        self.0.push(Carried { wrench: Wrench { force, moment }, r: mount.r });
    }

    /// + Σ R_k f_{i,k}
    pub(crate) fn with_forces(&self, force: Vector<'s>) -> Vector<'s> {
        plus_sum(force, self.0.iter().map(|k| k.wrench.force))
    }

    /// + Σ R_k n_{i,k}
    pub(crate) fn with_moments(&self, moment: Vector<'s>) -> Vector<'s> {
        plus_sum(moment, self.0.iter().map(|k| k.wrench.moment))
    }

    /// + Σ r_k × R_k f_{i,k}
    pub(crate) fn with_levers(&self, moment: Vector<'s>) -> Vector<'s> {
        plus_sum(moment, self.0.iter().map(|k| k.r.cross(k.wrench.force)))
    }
}

/// The loads of all links before the backward pass: what their tips exert.
pub(crate) fn at_tips<'s>(arm: &Arm<'s>, wrenches: &[Wrench<'s>]) -> Vec<Load<'s>> {
    let mut loads = vec![Load::default(); arm.links.len()];
    for ((link, tip), wrench) in arm.tips.iter().zip(wrenches) {
        if let Some(link) = *link {
            loads[link].put(arm.builder.joint(link + 1), tip.rotation, tip, wrench);
        }
    }
    loads
}

/// A vector and the sum of others, which is computed first; the vector itself without others.
pub(crate) fn plus_sum<'s>(vector: Vector<'s>, others: impl IntoIterator<Item = Vector<'s>>) -> Vector<'s> {
    others.into_iter().reduce(|sum, other| sum + other).map_or(vector, |sum| vector + sum)
}
