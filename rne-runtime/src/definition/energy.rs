//! Kinetic and potential energy.
//!
//! ```text
//! T = ½ Σ (m_i ċ_i · ċ_i + ω_i · I_i ω_i) [+ ½ Σ G² Jm q̇², of an arm with its rotors]
//!                                              ω and ċ of steps 1 and 3, in the axes of form P
//! V = - Σ m_i g · c_i                          c_i = R_i c̄_i + p_i from the rows of the table, in the axes of frame 0
//! ```
//!
//! A rotor of the list `motors`, of spin s about the axis a on link c, adds ½ Jm s (s + 2 a · ω_c) to T.
//!
//! A link with a first moment h beside its mass has ċ_i · (ω_i × h_i) in T, and - g · R_i h̄_i in V.
//!
//! Sums run from the base to the tip; the half, and the sign, come last.
//!
//! A floating base moves and is a link, too: link 0. Where frame 0 stands in the world at p, turned by R:
//!
//! ```text
//! V = - Σ m_i Rᵀ g · c_i - Σ m_i g · p             g in world axes
//! ```

use nalgebra::{Matrix3, Vector3};

use crate::definition::Definition;
use crate::definition::kinematics::Placement;
use crate::definition::per_joint::PerJoint;
use crate::seven_steps;
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::{BaseMotion, BaseTwist, Constant, Pose, Scalar};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns the kinetic energy on a base with a given motion, or at rest.
    pub(crate) fn kinetic<T: Scalar>(self, q: &[T], qd: &[T], twist: Option<&BaseTwist<T>>) -> T {
        let zeros = self.zeros();
        let joints = JointMotions::new(q, qd, zeros.as_ref());
        let base = twist.map_or_else(BaseMotion::default, BaseTwist::motion);
        let motions = self.motions(joints, &base);
        let velocities = self.velocities(joints, &base, &motions);
        let turning = twist.map(|twist| Vector3::from(twist.angular));
        let mut twice = turning.map_or_else(T::zero, |omega| {
            let (link, velocity) = (self.chain.base(), seven_steps::base::velocity(self.chain, &base));
            let spin = omega.dot(&(link.inertia * omega));
            link.mass * velocity.dot(&velocity) + spin
        });
        for ((link, motion), velocity) in self.chain.links::<T>().zip(motions.as_ref()).zip(velocities.as_ref()) {
            let spin = motion.omega.dot(&(link.inertia * motion.omega));
            twice += link.mass * velocity.dot(velocity) + spin;
            if let Some(h) = &link.first_moment {
                let half = velocity.dot(&motion.omega.cross(h));
                twice += half + half;
            }
        }
        for (index, &qd) in qd.iter().enumerate() {
            if let Some(rotor) = self.rotor(index) {
                twice += rotor.to::<T>() * (qd * qd);
            }
        }
        let spins = self.chain.spins;
        for spin in spins.all() {
            let speed = spins.of_joints(spin, qd);
            let carrier = spin.on.map_or(turning, |link| Some(motions.as_ref()[link].omega));
            let carried = carrier.map(|omega| spin.axis.map(S::to::<T>).dot(&omega));
            let whole = carried.map_or(speed, |along| (speed + along) + along);
            twice += (spin.inertia.to::<T>() * speed) * whole;
        }
        twice * T::from_f64(0.5)
    }

    pub(crate) fn potential<T: Scalar>(self, q: &[T]) -> T {
        self.potential_in(q, &Vector3::from(*self.gravity).map(S::to::<T>))
    }

    /// Returns the potential energy, where `pose` is that of frame 0 in the world.
    pub(crate) fn floating_potential<T: Scalar>(self, q: &[T], pose: &Pose<T>) -> T {
        let gravity = Vector3::from(*self.gravity).map(S::to::<T>);
        let mass = self.chain.links::<T>().fold(self.chain.base::<T>().mass, |mass, link| mass + link.mass);
        let (back, origin) = (Matrix3::from(pose.rotation), Vector3::from(pose.translation));
        self.potential_in(q, &(back * gravity)) - mass * gravity.dot(&origin)
    }

    /// Returns the potential energy, with `gravity` in the axes of frame 0.
    fn potential_in<T: Scalar>(self, q: &[T], gravity: &Vector3<T>) -> T {
        let links = self.placements(Placement::identity(), q);
        let base = self.chain.base::<T>();
        let mut sum = base.mass * gravity.dot(&base.com);
        for (i, row) in self.table.rows.iter().enumerate() {
            sum += row.link.mass.to::<T>() * gravity.dot(&self.centre(i, links.as_ref()));
            if let Some(moment) = self.first_moment(i, links.as_ref()) {
                sum += gravity.dot(&moment);
            }
        }
        -sum
    }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn kinetic<T: Scalar>(self, q: &[T], qd: &[T], twist: Option<&BaseTwist<T>>) -> T {
        let [q, qd] = [q, qd].map(|values| self.of_joints(values));
        self.mechanism.kinetic(q.as_ref(), qd.as_ref(), twist)
    }
}
