//! Every vector of the seven steps, for reading and for comparing with the lecture.

use nalgebra::{Matrix3, Vector3};

use crate::seven_steps::link_frame::{Chain, rotation_z};
use crate::seven_steps::link_state::{ForceMoment, LinkLoad, LinkMotion};
use crate::{Constant, Scalar};

/// Results of the seven steps for link i.
///
/// The axes are those of form P when the entry comes from a [`Trace`]: fixed to link i, z along joint i. The
/// conversions of a trace return the same quantities in other axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LinkTrace<T> {
    /// The link that carries joint i, counted from 0; `None` for the base.
    pub parent: Option<usize>,
    /// sin θ_i.
    pub sin: T,
    /// cos θ_i.
    pub cos: T,
    /// Rows of R_i, which turns components in the axes of this entry into components in the axes of its parent (without
    /// one: of frame 0).
    pub rotation: [[T; 3]; 3],
    /// d_i, from the joint's reference point J_i to the centre of mass, m.
    pub d: [T; 3],
    /// r_i, from the centre of mass to J_{i+1} (for the last link: to the origin of the tip frame), m. Of a link that
    /// carries several joints, to the first of them.
    pub r: [T; 3],
    /// m_i, kg.
    pub mass: T,
    /// Rows of I_i, the inertia about the centre of mass, kg m².
    pub inertia: [[T; 3]; 3],
    /// h_i, the first moment about C_i of a link without mass that has one, kg m; zero of every body.
    pub first_moment: [T; 3],
    /// Step 1: angular velocity ω_i, rad/s.
    pub omega: [T; 3],
    /// Step 2: angular acceleration ω̇_i, rad/s².
    pub omega_dot: [T; 3],
    /// Step 3: velocity of the centre of mass ċ_i, m/s.
    pub velocity: [T; 3],
    /// Step 4: acceleration of the centre of mass c̈_i, m/s². The true one: gravity is not hidden in it.
    pub acceleration: [T; 3],
    /// Step 5: acceleration of gravity g_i, m/s².
    pub gravity: [T; 3],
    /// Step 6: f_i = m_i c̈_i, N.
    pub inertia_force: [T; 3],
    /// Step 6: n_i = I_i ω̇_i + ω_i × I_i ω_i, about the centre of mass, N m.
    pub inertia_moment: [T; 3],
    /// Step 6: f_{i,i+1}, exerted by link i on link i+1 (by the last link at the tip), turned into the axes of this
    /// entry, N. Of a link that carries several joints, this force and the next moment are sums.
    pub next_force: [T; 3],
    /// Step 6: n_{i,i+1}, exerted by link i on link i+1, about J_{i+1} (by the last link, about the origin of the tip
    /// frame), turned into the axes of this entry, N m.
    pub next_moment: [T; 3],
    /// Step 6: f_{i-1,i}, exerted by link i-1 on link i, N.
    pub joint_force: [T; 3],
    /// Step 6: n_{i-1,i}, exerted by link i-1 on link i, about J_i, N m.
    pub joint_moment: [T; 3],
    /// Step 7: what the actuator delivers, N m for a revolute joint, N for a prismatic one.
    pub tau: T,
}

/// The seven steps of one state of an arm with `DOF` joints, in the axes of form P.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trace<const DOF: usize, T> {
    /// One entry per link, base to tip.
    pub links: [LinkTrace<T>; DOF],
}

impl<const DOF: usize, T: Scalar> Trace<DOF, T> {
    /// The actuators' torques and forces, τ.
    #[must_use]
    pub fn tau(&self) -> [T; DOF] {
        self.links.map(|link| link.tau)
    }

    /// Converts the trace to the lecture's axes: `[x]_L = Rz(θ_i) [x]_P`, fixed to link i-1, z along joint i. For a
    /// standard table these are the axes of its frame i, and the rotations are Q_{i-1} (Q_0 = 1).
    #[must_use]
    pub fn to_lecture(&self) -> [LinkTrace<T>; DOF] {
        let mut links = self.links;
        turn_to_lecture(&mut links);
        links
    }

    /// Converts the trace to the axes of frame 0. The rotations between entries are then the identity.
    #[must_use]
    pub fn to_base(&self) -> [LinkTrace<T>; DOF] {
        let mut links = self.links;
        turn_to_base(&mut links);
        links
    }
}

impl<T: Scalar> LinkTrace<T> {
    /// A place for a result.
    pub(crate) fn empty() -> Self {
        let zero = [T::zero(); 3];
        Self {
            parent: None,
            sin: T::zero(),
            cos: T::one(),
            rotation: rows(&Matrix3::identity()),
            d: zero,
            r: zero,
            mass: T::zero(),
            inertia: [zero; 3],
            first_moment: zero,
            omega: zero,
            omega_dot: zero,
            velocity: zero,
            acceleration: zero,
            gravity: zero,
            inertia_force: zero,
            inertia_moment: zero,
            next_force: zero,
            next_moment: zero,
            joint_force: zero,
            joint_moment: zero,
            tau: T::zero(),
        }
    }

    /// R_i as an nalgebra matrix.
    #[must_use]
    pub fn rotation_matrix(&self) -> Matrix3<T> {
        Matrix3::from(self.rotation).transpose()
    }

    /// Every vector x becomes `turn` x; `rotation` is the R_i of the new axes.
    fn turned(&self, turn: &Matrix3<T>, rotation: &Matrix3<T>) -> Self {
        let turned = |x: [T; 3]| (turn * Vector3::from(x)).into();
        Self {
            parent: self.parent,
            sin: self.sin,
            cos: self.cos,
            rotation: rows(rotation),
            d: turned(self.d),
            r: turned(self.r),
            mass: self.mass,
            inertia: rows(&(turn * Matrix3::from(self.inertia).transpose() * turn.transpose())),
            first_moment: turned(self.first_moment),
            omega: turned(self.omega),
            omega_dot: turned(self.omega_dot),
            velocity: turned(self.velocity),
            acceleration: turned(self.acceleration),
            gravity: turned(self.gravity),
            inertia_force: turned(self.inertia_force),
            inertia_moment: turned(self.inertia_moment),
            next_force: turned(self.next_force),
            next_moment: turned(self.next_moment),
            joint_force: turned(self.joint_force),
            joint_moment: turned(self.joint_moment),
            tau: self.tau,
        }
    }
}

/// Collects the results of both passes, and step 3.
pub(crate) fn record<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    q: &[T],
    velocities: &[Vector3<T>],
    motions: &[LinkMotion<T>],
    loads: &[LinkLoad<T>],
    traces: &mut [LinkTrace<T>],
) {
    let found = chain.links::<T>().zip(q).zip(velocities).zip(motions).zip(loads);
    for (index, (((((link, &q), velocity), motion), load), trace)) in found.zip(traces).enumerate() {
        let angle = link.sin_cos(q);
        let next = load.carried.map_or_else(ForceMoment::zero, |carried| carried.wrench);
        *trace = LinkTrace {
            parent: link.parent,
            sin: angle.0,
            cos: angle.1,
            rotation: rows(&motion.rotation),
            d: motion.d.into(),
            r: chain.mount_behind(index).r.into(),
            mass: link.mass,
            inertia: rows(&link.inertia),
            first_moment: link.first_moment.unwrap_or_else(Vector3::zeros).into(),
            omega: motion.omega.into(),
            omega_dot: motion.omega_dot.into(),
            velocity: (*velocity).into(),
            acceleration: motion.acceleration.into(),
            gravity: motion.gravity.into(),
            inertia_force: load.inertia.force.into(),
            inertia_moment: load.inertia.moment.into(),
            next_force: next.force.into(),
            next_moment: next.moment.into(),
            joint_force: load.joint.force.into(),
            joint_moment: load.joint.moment.into(),
            tau: load.tau,
        };
    }
}

/// Form P → the lecture's axes, link by link.
pub(crate) fn turn_to_lecture<T: Scalar>(links: &mut [LinkTrace<T>]) {
    let about_z = |link: &LinkTrace<T>| rotation_z((link.sin, link.cos));
    for index in 0..links.len() {
        let (link, turn) = (links[index], about_z(&links[index]));
        let turn_of_parent = link.parent.map_or_else(Matrix3::identity, |parent| about_z(&links[parent]));
        let rotation = turn_of_parent * link.rotation_matrix() * turn.transpose();
        links[index] = link.turned(&turn, &rotation);
    }
}

/// Form P → the axes of frame 0.
pub(crate) fn turn_to_base<T: Scalar>(links: &mut [LinkTrace<T>]) {
    // a parent stands above what it carries, so its rotation is that from the base already
    for index in 0..links.len() {
        let of_parent = links[index].parent.map_or_else(Matrix3::identity, |parent| links[parent].rotation_matrix());
        links[index].rotation = rows(&(of_parent * links[index].rotation_matrix()));
    }
    for link in links {
        *link = link.turned(&link.rotation_matrix(), &Matrix3::identity());
    }
}

fn rows<T: Scalar>(matrix: &Matrix3<T>) -> [[T; 3]; 3] {
    matrix.transpose().into()
}
