//! Inputs and results of the two passes of the recursion, link by link, in the axes of form P.

use nalgebra::{Matrix3, Vector3};

use crate::seven_steps::link_frame::{Chain, LinkFrame};
use crate::{BaseMotion, Constant, Scalar, Wrench};

/// Positions, velocities and accelerations of all joints, base to tip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointMotions<'a, T> {
    pub(crate) q: &'a [T],
    pub(crate) qd: &'a [T],
    pub(crate) qdd: &'a [T],
    /// Sines and cosines of the positions, if they are known.
    pub(crate) turns: Option<(&'a [T], &'a [T])>,
}

impl<'a, T> JointMotions<'a, T> {
    pub(crate) const fn new(q: &'a [T], qd: &'a [T], qdd: &'a [T]) -> Self {
        Self { q, qd, qdd, turns: None }
    }
}

/// Link i with the motion of its joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint<T> {
    pub(crate) link: LinkFrame<T>,
    /// θ_i or b_i without its constant part, rad or m.
    pub(crate) q: T,
    /// θ̇_i or ḃ_i.
    pub(crate) qd: T,
    /// θ̈_i or b̈_i.
    pub(crate) qdd: T,
    /// Sine and cosine of `q`, if they are known.
    pub(crate) turn: Option<(T, T)>,
}

/// Results of the forward pass for link i.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkMotion<T> {
    /// R_i
    pub(crate) rotation: Matrix3<T>,
    /// d_i
    pub(crate) d: Vector3<T>,
    /// ω_i
    pub(crate) omega: Vector3<T>,
    /// ω̇_i
    pub(crate) omega_dot: Vector3<T>,
    /// c̈_i
    pub(crate) acceleration: Vector3<T>,
    /// g_i
    pub(crate) gravity: Vector3<T>,
}

/// A force with a moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForceMoment<T> {
    pub(crate) force: Vector3<T>,
    pub(crate) moment: Vector3<T>,
}

/// Results of the backward pass for link i.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkLoad<T> {
    /// f_i, n_i
    pub(crate) inertia: ForceMoment<T>,
    /// f_{p,i}, n_{p,i}
    pub(crate) joint: ForceMoment<T>,
    /// τ_i
    pub(crate) tau: T,
    /// Load of the joints and the tip mounted on the link; `None` without any.
    pub(crate) carried: Option<Carried<T>>,
}

/// The wrenches that a link exerts on what is mounted on it, each about its own joint, in the axes of the link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried<T> {
    /// Σ f, Σ n
    pub(crate) wrench: ForceMoment<T>,
    /// Σ r × f
    pub(crate) of_levers: Vector3<T>,
}

impl<'a, S: Constant> Chain<'a, S> {
    /// The links from base to tip, each with the motion of its joint.
    pub(crate) fn joints<T: Scalar>(
        self,
        JointMotions { q, qd, qdd, turns }: JointMotions<'a, T>,
    ) -> impl Iterator<Item = Joint<T>> + 'a {
        let motions = q.iter().zip(qd).zip(qdd);
        self.links().zip(motions).enumerate().map(move |(index, (link, ((&q, &qd), &qdd)))| {
            let turn = turns.and_then(|(sin, cos)| Some((*sin.get(index)?, *cos.get(index)?)));
            Joint { link, q, qd, qdd, turn }
        })
    }
}

impl<T: Scalar> LinkMotion<T> {
    /// The base: c̈_0 = a + ω̇_0 × d_0 + ω_0 × (ω_0 × d_0), with the acceleration a of the origin of frame 0 and d_0
    /// from there to the centre of mass.
    pub(crate) fn of_base(motion: &BaseMotion<T>, d: Option<Vector3<T>>) -> Self {
        let [omega, omega_dot, origin, gravity] =
            [motion.omega, motion.omega_dot, motion.acceleration, motion.gravity].map(Vector3::from);
        let at_origin = Self { omega, omega_dot, acceleration: origin, gravity, ..Self::empty() };
        let Some(d) = d else { return at_origin };
        let acceleration = (origin + omega_dot.cross(&d)) + omega.cross(&omega.cross(&d));
        Self { d, acceleration, ..at_origin }
    }

    /// Link i where its joint has put it, its motion still unknown.
    pub(crate) fn placed(Joint { link, q, turn, .. }: &Joint<T>) -> Self {
        let rotation = match turn {
            Some(turn) => link.rotation_by(*turn),
            None => link.rotation(*q),
        };
        Self { rotation, d: link.d(*q), ..Self::empty() }
    }

    /// A place for a result.
    pub(crate) fn empty() -> Self {
        let zero = Vector3::zeros();
        Self { rotation: Matrix3::identity(), d: zero, omega: zero, omega_dot: zero, acceleration: zero, gravity: zero }
    }
}

impl<T: Scalar> LinkLoad<T> {
    /// A place for a result.
    pub(crate) fn empty() -> Self {
        Self { inertia: ForceMoment::zero(), joint: ForceMoment::zero(), tau: T::zero(), carried: None }
    }

    /// The link carries one wrench more, at the end of `r`.
    pub(crate) fn carry(&mut self, rotation: &Matrix3<T>, r: &Vector3<T>, wrench: &ForceMoment<T>) {
        let wrench = ForceMoment { force: rotation * wrench.force, moment: rotation * wrench.moment };
        let of_levers = r.cross(&wrench.force);
        self.carried = Some(match &self.carried {
            None => Carried { wrench, of_levers },
            Some(others) => {
                let Carried { wrench: ForceMoment { force, moment }, of_levers: levers } = *others;
                let wrench = ForceMoment { force: force + wrench.force, moment: moment + wrench.moment };
                Carried { wrench, of_levers: levers + of_levers }
            }
        });
    }
}

impl<T: Scalar> ForceMoment<T> {
    pub(crate) fn zero() -> Self {
        Self { force: Vector3::zeros(), moment: Vector3::zeros() }
    }
}

impl<T: Scalar> From<&Wrench<T>> for ForceMoment<T> {
    fn from(wrench: &Wrench<T>) -> Self {
        let (force, moment) = wrench.vectors();
        Self { force, moment }
    }
}
