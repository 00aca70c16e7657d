//! The momentum of the joints, and its rate, by composite bodies: everything from link i on as one body.
//!
//! ```text
//! p = M(q) q̇                ṗ = τ + τ_ext + ∂T/∂q - ∂V/∂q
//!
//! M_i = m_i + Σ M_k                                     mass of link i and of all that it carries
//! s_i = M_i d_i + Σ (M_k r_k + R_k s_k)                 first moment about J_i
//! P_i = m_i ċ_i + Σ R_k P_k                             linear momentum
//! L_i = I_i ω_i + Σ R_k L_k + d_i × P_i + Σ r_k × R_k P_k      angular momentum about J_i
//!
//!                       revolute                          prismatic
//! p_i                   e · L_i                           e · P_i               with a rotor + G² Jm q̇_i
//! ∂T/∂q_i               (ω_i × e) · L_i + (j̇_i × e) · P_i (ω_i × e) · P_i
//! -∂V/∂q_i              e · (s_i × g_i)                   M_i e · g_i
//! ```
//!
//! A floating base is link 0, about the origin of frame 0. Its P_0 is the momentum of the robot, and the
//! angular momentum about the centre of mass c = s_0 / M_0 is L_0 - c × P_0.
//!
//! k runs over the joints that link i carries, and over the payload at the tip; j̇_i = R_iᵀ (ċ_p + ω_p × r_i). A first
//! moment h beside the mass adds h_i
//! to s_i, ω_i × h_i to P_i and h_i × ċ_i to L_i. A rotor of the list `motors` adds Jm s a to L of its carrier c, and n
//! (Jm s + Jm a · ω_c) to p of each joint with which it turns. The order of the operations is part of the contract;
//! generated code repeats it.

use nalgebra::{Matrix3, Vector3};
use rne_model::JointKind;

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::per_joint::PerJoint;
use crate::seven_steps;
use crate::seven_steps::link_frame::LinkFrame;
use crate::seven_steps::link_state::{JointMotions, LinkMotion};
use crate::seven_steps::mechanism::Mechanism;
use crate::seven_steps::mount::Mount;
use crate::{BaseMotion, BaseTwist, Constant, Payload, Scalar};

/// Link i and all that it carries, as one body.
#[derive(Clone, Copy, Debug)]
struct Body<T> {
    mass: T,
    first_moment: Vector3<T>,
    linear: Vector3<T>,
    angular: Vector3<T>,
}

/// The sums of the bodies that a link carries, in its axes, and the terms with the levers r_k separately.
#[derive(Clone, Copy, Debug)]
struct Carried<T> {
    of_joints: Body<T>,
    /// Σ M_k r_k and Σ r_k × P_k
    of_levers: [Vector3<T>; 2],
}

impl<T: Scalar> Body<T> {
    /// Returns M_i, s_i, P_i and L_i of link i with all that it carries.
    fn of(
        link: &LinkFrame<T>,
        motion: &LinkMotion<T>,
        velocity: &Vector3<T>,
        spins: impl Iterator<Item = Vector3<T>>,
        carried: Option<&Carried<T>>,
    ) -> Self {
        let (d, omega) = (&motion.d, &motion.omega);
        let mass = carried.map_or(link.mass, |carried| link.mass + carried.of_joints.mass);
        let (mut first_moment, mut linear) = (d * mass, velocity * link.mass);
        let mut angular = link.inertia * omega;
        if let Some(h) = &link.first_moment {
            first_moment += h;
            linear += omega.cross(h);
            angular += h.cross(velocity);
        }
        for momentum in spins {
            angular += momentum;
        }
        match carried {
            None => Self { mass, first_moment, linear, angular: angular + d.cross(&linear) },
            Some(Carried { of_joints, of_levers: [of_masses, of_momenta] }) => {
                linear += of_joints.linear;
                let angular = ((angular + of_joints.angular) + d.cross(&linear)) + of_momenta;
                Self { mass, first_moment: (first_moment + of_masses) + of_joints.first_moment, linear, angular }
            }
        }
    }

    /// A payload in tip axes, about the origin of the tip frame: v = Rᵀ (ċ_n + ω_n × r) + ω × c, P = m v, L = I ω + c ×
    /// P.
    fn of_payload(payload: &Payload<T>, last: &LinkMotion<T>, velocity: &Vector3<T>, tip: &Mount<T>) -> Self {
        let (com, inertia) = (Vector3::from(payload.com), Matrix3::from(payload.inertia.rows()).transpose());
        let omega = tip.rotation.tr_mul(&last.omega);
        let origin = velocity + last.omega.cross(&tip.r);
        let velocity = tip.rotation.tr_mul(&origin) + omega.cross(&com);
        let linear = velocity * payload.mass;
        let angular = inertia * omega + com.cross(&linear);
        Self { mass: payload.mass, first_moment: com * payload.mass, linear, angular }
    }

    /// Rotates the values into the axes of the parent.
    fn turned(&self, rotation: &Matrix3<T>) -> Self {
        Self {
            mass: self.mass,
            first_moment: rotation * self.first_moment,
            linear: rotation * self.linear,
            angular: rotation * self.angular,
        }
    }
}

/// Adds one more body that a link carries. `body` is in the link's axes, about the joint at the end of `r`.
fn carry<T: Scalar>(others: Option<Carried<T>>, body: Body<T>, r: &Vector3<T>) -> Carried<T> {
    let of_levers = [r * body.mass, r.cross(&body.linear)];
    let Some(Carried { of_joints, of_levers: [masses, momenta] }) = others else {
        return Carried { of_joints: body, of_levers };
    };
    Carried {
        of_joints: Body {
            mass: of_joints.mass + body.mass,
            first_moment: of_joints.first_moment + body.first_moment,
            linear: of_joints.linear + body.linear,
            angular: of_joints.angular + body.angular,
        },
        of_levers: [masses + of_levers[0], momenta + of_levers[1]],
    }
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns p, and τ + ∂T/∂q - ∂V/∂q.
    pub(crate) fn momentum_and_rate<T: Scalar>(
        self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        payload: Option<&Payload<T>>,
    ) -> [J::Of<T>; 2] {
        let zeros = self.zeros();
        let joints = JointMotions::new(q, qd, zeros.as_ref());
        let base: BaseMotion<T> = self.fixed_base();
        let motions = self.motions(joints, &base);
        let velocities = self.velocities(joints, &base, &motions);
        let (motions, velocities) = (motions.as_ref(), velocities.as_ref());
        let still = (LinkMotion::of_base(&base, None), Vector3::zeros());
        let e = Vector3::new(T::zero(), T::zero(), T::one());
        let spins = self.chain.spins;
        let mut carried = self.per_joint.all(&None);
        if let (Some(link), Some(payload)) = (self.chain.tip_link, payload) {
            let tip = self.chain.tip.to::<T>();
            let body = Body::of_payload(payload, &motions[link], &velocities[link], &tip);
            carried.as_mut()[link] = Some(carry(None, body.turned(&tip.rotation), &tip.r));
        }
        let [mut momentum, mut rate] = [self.zeros::<T>(), self.zeros::<T>()];
        for (i, link) in self.chain.links::<T>().enumerate().rev() {
            let this = &motions[i];
            let of_spins = spins.on(Some(i)).map(|spin| spins.momentum(spin, qd));
            let body = Body::of(&link, this, &velocities[i], of_spins, carried.as_ref()[i].as_ref());
            let turning = this.omega.cross(&e);
            let (along, of_motion, of_gravity) = match link.kind {
                JointKind::Revolute => {
                    let (parent, velocity) = link.parent.map_or(still, |p| (motions[p], velocities[p]));
                    let point = velocity + parent.omega.cross(&link.mount.r);
                    let point = this.rotation.tr_mul(&point);
                    let of_motion = turning.dot(&body.angular) + point.cross(&e).dot(&body.linear);
                    (body.angular.z, of_motion, body.first_moment.cross(&this.gravity).z)
                }
                JointKind::Prismatic => (body.linear.z, turning.dot(&body.linear), this.gravity.z * body.mass),
            };
            momentum.as_mut()[i] = self.rotor(i).map_or(along, |rotor| along + rotor.to::<T>() * qd[i]);
            rate.as_mut()[i] = (tau[i] + of_motion) + of_gravity;
            if let Some(parent) = link.parent {
                let place = &mut carried.as_mut()[parent];
                *place = Some(carry(*place, body.turned(&this.rotation), &link.mount.r));
            }
        }
        let of_carrier = |on: Option<usize>| on.map_or_else(Vector3::zeros, |link| motions[link].omega);
        spins.resist(qd, of_carrier, |joint, more| momentum.as_mut()[joint] += more);
        [momentum, rate]
    }
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns the momentum of a robot with a floating base, and its angular momentum about the centre of mass.
    pub(crate) fn centroidal_momentum<T: Scalar>(self, q: &[T], qd: &[T], twist: &BaseTwist<T>) -> [T; 6] {
        let (zeros, base, chain) = (self.zeros(), twist.motion(), self.chain);
        let joints = JointMotions::new(q, qd, zeros.as_ref());
        let motions = self.motions(joints, &base);
        let velocities = self.velocities(joints, &base, &motions);
        let (motions, velocities) = (motions.as_ref(), velocities.as_ref());
        let of_spins = |link| chain.spins.on(link).map(|spin| chain.spins.momentum(spin, qd));
        let (mut carried, mut on_base) = (self.per_joint.all(&None), None);
        for (i, link) in chain.links::<T>().enumerate().rev() {
            let own = carried.as_ref()[i];
            let body = Body::of(&link, &motions[i], &velocities[i], of_spins(Some(i)), own.as_ref());
            let place = link.parent.map_or(&mut on_base, |parent| &mut carried.as_mut()[parent]);
            *place = Some(carry(*place, body.turned(&motions[i].rotation), &link.mount.r));
        }
        let link = LinkFrame::of_base(chain.base());
        let (motion, velocity) = (seven_steps::base::motion(chain, &base), seven_steps::base::velocity(chain, &base));
        let whole = Body::of(&link, &motion, &velocity, of_spins(None), on_base.as_ref());
        let centre = whole.first_moment * (T::one() / whole.mass);
        let about = whole.angular - centre.cross(&whole.linear);
        let [[x, y, z], [about_x, about_y, about_z]] = [whole.linear.into(), about.into()];
        [x, y, z, about_x, about_y, about_z]
    }
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn momentum_and_rate<T: Scalar>(
        self,
        [q, qd, tau]: [&[T]; 3],
        payload: Option<&Payload<T>>,
    ) -> (J::Of<T>, J::Of<T>) {
        let ([q, qd], tau) = ([q, qd].map(|values| self.of_joints(values)), self.coordinates.applied(tau));
        let both = self.mechanism.momentum_and_rate(q.as_ref(), qd.as_ref(), tau.as_ref(), payload);
        self.coordinates.rows(both).into()
    }
}
