//! Poses, the Jacobian of the tip, J̇ q̇, and the torques of a wrench at the tip.
//!
//! A frame on any link can replace the tip. Then the joints after this link do not move it.
//!
//! Poses are accumulated from the base, row by row of the table, and not by the frames of the seven steps. The order of
//! the operations is part of the contract; generated code repeats it:
//!
//! ```text
//! start             R = Rz(yaw) Ry(pitch) Rx(roll), p = xyz of the base
//! row i             p := R p_i + p,   R := R R_i
//! tip               p := R p_t + p,   R := R R_t     of the tool
//!
//!              R_i              p_i
//! standard     Rz(θ) Rx(α)      (cos θ a, sin θ a, d)
//! modified     Rx(α) Rz(θ)      (a, -sin α d, cos α d)
//! ```
//!
//! Products of matrices are sums of three products, from the first to the last. θ or d contains the joint variable, d
//! as the sum of constant and variable.

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, FixedFrame, JointKind, Row, Transform};

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::per_joint::PerJoint;
use crate::seven_steps::joint::JointLaws;
use crate::seven_steps::link_frame::{LinkFrame, rotation_of, rotation_x, rotation_z};
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::seven_steps::mount::Mount;
use crate::{Arm, BaseMotion, Constant, Pose, Scalar, Wrench};

/// A pose in nalgebra's types.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement<T> {
    pub(crate) rotation: Matrix3<T>,
    pub(crate) translation: Vector3<T>,
}

impl<T: Scalar> Placement<T> {
    pub(crate) fn identity() -> Self {
        Self { rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// Returns the placement of a constant transform.
    pub(crate) fn constant<S: Constant>(transform: &Transform<S>) -> Self {
        let translation = Vector3::from(transform.xyz).map(S::to);
        Self { rotation: rotation_of(transform).map(S::to), translation }
    }

    /// Returns the placement of a link in the link before, with the joint between them at `q`.
    fn of_row<S: Constant>(convention: Convention, row: &Row<S>, link: &LinkFrame<S>, q: T) -> Self {
        let turn @ (sin, cos) = link.to().sin_cos(q);
        let (a, twist) = (row.dh.a.to::<T>(), rotation_x(&row.dh.alpha).map(S::to));
        let d = match row.kind {
            JointKind::Revolute => row.dh.d.to(),
            JointKind::Prismatic => row.dh.d.to::<T>() + q,
        };
        match convention {
            Convention::Standard => {
                Self { rotation: rotation_z(turn) * twist, translation: Vector3::new(cos * a, sin * a, d) }
            }
            Convention::Modified => {
                let (sin_alpha, cos_alpha) = (row.dh.alpha.sin.to::<T>(), row.dh.alpha.cos.to::<T>());
                let translation = Vector3::new(a, -sin_alpha * d, cos_alpha * d);
                Self { rotation: twist * rotation_z(turn), translation }
            }
        }
    }

    /// Returns the placement of `next`, which is given relative to this one.
    fn then(&self, next: &Self) -> Self {
        Self {
            rotation: self.rotation * next.rotation,
            translation: self.rotation * next.translation + self.translation,
        }
    }

    fn pose(&self) -> Pose<T> {
        Pose::from_matrix(self.rotation, self.translation)
    }
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns the placements of the link frames when frame 0 is at `start`.
    pub(crate) fn placements<T: Scalar>(self, start: Placement<T>, q: &[T]) -> J::Of<Placement<T>> {
        let mut placements = self.per_joint.all(&start);
        for (i, link) in self.chain.links.iter().enumerate() {
            let parent = self.row_start(i, start, placements.as_ref());
            let row = Placement::of_row(self.table.convention, &self.table.rows[i], link, q[i]);
            placements.as_mut()[i] = parent.then(&row);
        }
        placements
    }

    /// Returns the frame whose z axis is joint i: the parent's link frame in a standard table, the link's own in a
    /// modified one.
    pub(crate) fn joint_frame<T: Scalar>(self, i: usize, start: Placement<T>, links: &[Placement<T>]) -> Placement<T> {
        match self.table.convention {
            Convention::Modified => links[i],
            Convention::Standard => self.row_start(i, start, links),
        }
    }

    /// Returns the frame at which row i begins: the parent's link frame, or a placement relative to it.
    fn row_start<T: Scalar>(self, i: usize, start: Placement<T>, links: &[Placement<T>]) -> Placement<T> {
        let parent = self.chain.links[i].parent.map_or(start, |parent| links[parent]);
        self.table.placement(i).map_or(parent, |placement| parent.then(&Placement::constant(placement)))
    }

    /// Returns the centre of mass of link i.
    pub(crate) fn centre<T: Scalar>(self, i: usize, links: &[Placement<T>]) -> Vector3<T> {
        let Placement { rotation, translation } = links[i];
        rotation * Vector3::from(self.table.rows[i].link.com).map(S::to) + translation
    }

    /// Returns the first moment that link i has in addition to that of its mass, in the axes in which the links are
    /// placed; `None` if it has none.
    pub(crate) fn first_moment<T: Scalar>(self, i: usize, links: &[Placement<T>]) -> Option<Vector3<T>> {
        self.chain.links[i].first_moment?;
        Some(links[i].rotation * Vector3::from(self.table.rows[i].link.first_moment).map(S::to))
    }

    /// Returns the frame that the functions compute: the tip, or the frame that replaces it.
    fn observed(self) -> FixedFrame<S> {
        self.at.copied().unwrap_or_else(|| self.table.tip())
    }

    /// Returns the placement of this frame, on one of `links`, when frame 0 is at `start`.
    pub(crate) fn tip<T: Scalar>(self, start: Placement<T>, links: &[Placement<T>]) -> Placement<T> {
        let FixedFrame { on, placement } = self.observed();
        let link = on.map_or(start, |link| links[link]);
        link.then(&Placement::constant(&placement))
    }

    /// Whether a joint moves this frame: whether it is a joint between the base and the link of the frame.
    fn moves_tip(self, joint: usize) -> bool {
        let mut link = self.observed().on;
        while let Some(index) = link {
            if index == joint {
                return true;
            }
            link = self.chain.links[index].parent;
        }
        false
    }

    pub(crate) fn tip_pose<T: Scalar>(self, q: &[T]) -> Pose<T> {
        let base = Placement::constant(self.base);
        self.tip(base, self.placements(base, q).as_ref()).pose()
    }

    pub(crate) fn link_poses<T: Scalar>(self, q: &[T]) -> J::Of<Pose<T>> {
        let links = self.placements(Placement::constant(self.base), q);
        self.per_joint.of(|i| links.as_ref()[i].pose())
    }

    pub(crate) fn jacobian<T: Scalar>(self, q: &[T]) -> [J::Of<T>; 6] {
        let base = Placement::constant(self.base);
        self.jacobian_from(base, self.placements(base, q).as_ref()).0
    }

    /// Returns the Jacobian when frame 0 is at `base`, and the origin of the frame.
    ///
    /// Column i of a revolute joint: z_i × (p_tip - p_i), z_i; of a prismatic one: z_i, 0; of a joint that does not
    /// move the frame: 0, 0.
    pub(crate) fn jacobian_from<T: Scalar>(
        self,
        base: Placement<T>,
        links: &[Placement<T>],
    ) -> ([J::Of<T>; 6], Vector3<T>) {
        let tip = self.tip(base, links);
        let columns = self.per_joint.of(|i| {
            if !self.moves_tip(i) {
                return (Vector3::zeros(), Vector3::zeros());
            }
            let frame = self.joint_frame(i, base, links);
            let axis = frame.rotation.column(2).into_owned();
            match self.table.rows[i].kind {
                JointKind::Revolute => (axis.cross(&(tip.translation - frame.translation)), axis),
                JointKind::Prismatic => (axis, Vector3::zeros()),
            }
        });
        let rows = core::array::from_fn(|row| {
            self.per_joint.of(|i| {
                let (linear, angular) = &columns.as_ref()[i];
                if row < 3 { linear[row] } else { angular[row - 3] }
            })
        });
        (rows, tip.translation)
    }

    /// The tip's acceleration at q̈ = 0: steps 1 and 2, and step 4 from joint to joint instead of by centres of mass,
    /// which may be far away, and on which it does not depend. s_i leads from joint i to joint i+1, the last to the
    /// tip:
    ///
    /// - R: p̈_{i+1} = R_iᵀ p̈_i + ω̇_i × s_i + ω_i × (ω_i × s_i)      p̈_1 = 0
    /// - P: the same + 2 q̇_i ω_i × e_i
    ///
    /// then the last p̈ and ω̇_n turned by R_n … R_1 and by the base.
    ///
    /// A frame on another link than the last one replaces the tip; then the links after it have no effect.
    pub(crate) fn jacobian_rate_times_velocity<T: Scalar>(self, q: &[T], qd: &[T]) -> [T; 6] {
        let frame = self.observed();
        let zeros = self.zeros();
        let weightless = BaseMotion::fixed([T::zero(); 3]);
        let motions = self.motions(JointMotions::new(q, qd, zeros.as_ref()), &weightless);
        let (mut linear, mut angular) = (Vector3::zeros(), Vector3::zeros());
        for (i, (link, this)) in
            self.chain.links().zip(motions.as_ref()).enumerate().filter(|(i, _)| self.moves_tip(*i))
        {
            let towards = frame.on.and_then(|end| self.chain.mount_towards(end, i));
            let at_end = || match self.at {
                Some(frame) => Mount::of_frame(self.table.convention, self.table.rows, frame).to(),
                None => self.chain.tip.to(),
            };
            let span = link.span(q[i], &towards.unwrap_or_else(at_end));
            let centripetal = this.omega.cross(&this.omega.cross(&span));
            let rigid = (this.rotation.tr_mul(&linear) + this.omega_dot.cross(&span)) + centripetal;
            linear = link.kind.acceleration(rigid, &this.omega, qd[i], T::zero());
            angular = this.omega_dot;
        }
        for (_, motion) in motions.as_ref().iter().enumerate().rev().filter(|(i, _)| self.moves_tip(*i)) {
            linear = motion.rotation * linear;
            angular = motion.rotation * angular;
        }
        let base = rotation_of(self.base).map(S::to);
        linear = base * linear;
        angular = base * angular;
        [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
    }

    /// Jᵀ w of a wrench at the tip, in its axes: with F = R_tip f and N = R_tip n,
    ///
    /// - R: z_i · (N + (p_tip - p_i) × F)
    /// - P: z_i · F
    pub(crate) fn wrench_torques<T: Scalar>(self, q: &[T], wrench: &Wrench<T>) -> J::Of<T> {
        let base = Placement::constant(self.base);
        let links = self.placements(base, q);
        let tip = self.tip(base, links.as_ref());
        let (force, moment) = wrench.vectors();
        let (force, moment) = (tip.rotation * force, tip.rotation * moment);
        self.per_joint.of(|i| {
            if !self.moves_tip(i) {
                return T::zero();
            }
            let frame = self.joint_frame(i, base, links.as_ref());
            let axis = frame.rotation.column(2).into_owned();
            match self.table.rows[i].kind {
                JointKind::Revolute => axis.dot(&((tip.translation - frame.translation).cross(&force) + moment)),
                JointKind::Prismatic => axis.dot(&force),
            }
        })
    }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn jacobian<T: Scalar>(self, q: &[T]) -> [J::Of<T>; 6] {
        self.coordinates.rows(self.mechanism.jacobian(self.of_joints(q).as_ref()))
    }
}

impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// This arm with the frame `frame` in the place of the tip: the functions of [`Kinematics`](crate::Kinematics) are
    /// those of the frame, except [`link_poses`](crate::Kinematics::link_poses). The functions of all other traits stay
    /// those of the tip.
    ///
    /// `None` when `frame` is on a link that the arm does not have.
    #[must_use]
    pub fn at_frame(mut self, frame: FixedFrame<S>) -> Option<Self> {
        self.at = Some(frame);
        frame.on.is_none_or(|link| link < DOF).then_some(self)
    }
}
