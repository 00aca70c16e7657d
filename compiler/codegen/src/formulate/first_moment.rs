//! The terms of a link's first moment h that is given without mass. The lecture's equations do not have them.
//!
//! Only links with base parameters have such an h. For a link with physical parameters each function here returns its
//! argument.
//!
//! ```text
//! f_i  + ω̇_i × h_i + ω_i × (ω_i × h_i)
//! n_i  + h_i × c̈_i
//! n_{p,i}  - h_i × g_i
//! ```

use crate::formulate::carried::plus_sum;
use crate::formulate::{Body, Motion};
use crate::ir::{JointLines, Quantity, Vector};

/// The first moment h of a link, if it has one in addition to its mass, with the motion of the link.
pub(crate) struct FirstMoment<'a, 's> {
    h: Option<Vector<'s>>,
    /// The inertia force of h: ω̇ × h + ω × (ω × h).
    force: Option<Vector<'s>>,
    motion: &'a Motion<'s>,
}

impl<'a, 's> FirstMoment<'a, 's> {
    pub(crate) fn of(body: &Body<'s>, line: JointLines<'s>, motion: &'a Motion<'s>) -> Self {
        let force = body.first_moment.map(|h| {
            let (omega, omega_dot) = (motion.turning.omega, motion.turning.omega_dot);
            let omega_cross_h = line.define(Quantity::OmegaCrossMoment).by(omega.cross(h));
            line.define(Quantity::MasslessForce).by(omega_dot.cross(h) + omega.cross(omega_cross_h))
        });
        Self { h: body.first_moment, force, motion }
    }

    /// Returns the force f_i with the inertia force of h.
    pub(crate) fn add_to_force(&self, force: Vector<'s>) -> Vector<'s> {
        plus_sum(force, self.force)
    }

    /// Returns the moment n_i with h_i × c̈_i.
    pub(crate) fn add_to_moment(&self, moment: Vector<'s>) -> Vector<'s> {
        plus_sum(moment, self.h.map(|h| h.cross(self.motion.c_ddot)))
    }

    /// Returns the joint moment n_{p,i} with the weight term - h_i × g_i.
    pub(crate) fn subtract_weight(&self, moment: Vector<'s>) -> Vector<'s> {
        self.h.map_or(moment, |h| moment - h.cross(self.motion.gravity))
    }
}
