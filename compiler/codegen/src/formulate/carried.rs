//! The joints and tips that one link carries. In a chain, as in the lecture, there is exactly one on each link.

use crate::formulate::{Arm, Mount, Wrench};
use crate::ir::{JointLines, Matrix, Quantity, Vector};

/// A joint or tip k on link i: the wrench f_{i,k}, n_{i,k} that the link exerts there, in the axes of the link, and the
/// vector r_k from the link's centre of mass to it.
#[derive(Clone)]
struct Carried<'s> {
    wrench: Wrench<'s>,
    r: Vector<'s>,
}

/// All joints and tips on one link.
#[derive(Clone, Default)]
pub(crate) struct Load<'s>(Vec<Carried<'s>>);

impl<'s> Load<'s> {
    /// Adds joint or tip k to the load: defines R_k f_{i,k} and R_k n_{i,k}, its wrench in the axes of link i. `line`
    /// names these formulas and counts their operations; it is that of link i, not of k.
    pub(crate) fn put(&mut self, line: JointLines<'s>, rotation: Matrix<'s>, mount: &Mount<'s>, wrench: &Wrench<'s>) {
        let line = line.with_second_number(mount.label);
        let force = line.define(Quantity::ChildForce).by(rotation * wrench.force);
        let moment = line.define(Quantity::ChildMoment).by(rotation * wrench.moment);
        self.0.push(Carried { wrench: Wrench { force, moment }, r: mount.r });
    }

    /// Returns `force` + Σ R_k f_{i,k}.
    pub(crate) fn with_forces(&self, force: Vector<'s>) -> Vector<'s> {
        plus_sum(force, self.0.iter().map(|k| k.wrench.force))
    }

    /// Returns `moment` + Σ R_k n_{i,k}.
    pub(crate) fn with_moments(&self, moment: Vector<'s>) -> Vector<'s> {
        plus_sum(moment, self.0.iter().map(|k| k.wrench.moment))
    }

    /// Returns `moment` + Σ r_k × R_k f_{i,k}.
    pub(crate) fn with_levers(&self, moment: Vector<'s>) -> Vector<'s> {
        plus_sum(moment, self.0.iter().map(|k| k.r.cross(k.wrench.force)))
    }
}

/// Returns the loads of all links before the backward pass: the wrenches at their tips.
pub(crate) fn at_tips<'s>(arm: &Arm<'s>, wrenches: &[Wrench<'s>]) -> Vec<Load<'s>> {
    let mut loads = vec![Load::default(); arm.links.len()];
    for ((link, tip), wrench) in arm.tips.iter().zip(wrenches) {
        if let Some(link) = *link {
            loads[link].put(arm.builder.joint(link + 1), tip.rotation, tip, wrench);
        }
    }
    loads
}

/// Returns a vector plus the sum of others. The sum is computed first; without others the vector is returned as it is.
pub(crate) fn plus_sum<'s>(vector: Vector<'s>, others: impl IntoIterator<Item = Vector<'s>>) -> Vector<'s> {
    others.into_iter().reduce(|sum, other| sum + other).map_or(vector, |sum| vector + sum)
}
