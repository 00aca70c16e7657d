//! The seven steps of recursive Newton-Euler over symbols.
//!
//! NPTEL "Industrial Robotics: Theories for Implementation", lecture 38 (A. D. Udai), after S. K. Saha. Frame i is at
//! joint i and fixed to link i (form P), which serves standard and modified Denavit-Hartenberg tables with one text:
//! d_i = J_i → C_i, e = (0, 0, 1), and [x]_i = R_iᵀ [x]_p.
//!
//! Link i is the one that joint i moves, link p the one that carries joint i: its parent, or the base. In a chain p is
//! i-1. r_i = C_p → J_i tells where joint i is mounted; the lecture calls it r_{i-1}. What a kind of joint adds stands
//! in [`super::joint`]. `line.vector(name, || formula)` computes a formula and gives the result its name in the
//! generated code.
//!
//! The lecture has no rotors of motors, no floating base and no first moment h: a body has h = 0, and only a set of
//! base parameters has links without mass that have one.

use crate::formulate::arm::identity;
use crate::formulate::{Arm, AtTip, Body, Joint, JointState, Mount, Spin, Wrench};
use crate::ir::{Builder, Cause, JointLines, Matrix, Quantity, Symbol, Vector};

/// How a link turns, in its frame: what steps 1 and 2 find.
#[derive(Clone, Copy)]
pub(crate) struct Turning<'s> {
    /// R_i
    pub(crate) rotation: Matrix<'s>,
    pub(crate) omega: Vector<'s>,
    pub(crate) omega_dot: Vector<'s>,
}

/// The motion of a link and gravity, in its frame, with what the backward pass needs again.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'s> {
    pub(crate) turning: Turning<'s>,
    pub(crate) d: Vector<'s>,
    pub(crate) c_dot: Vector<'s>,
    pub(crate) c_ddot: Vector<'s>,
    pub(crate) gravity: Vector<'s>,
}

/// The wrench that the parent exerts on link i, and the torque of the actuator.
#[derive(Clone, Copy)]
pub(crate) struct Load<'s> {
    pub(crate) wrench: Wrench<'s>,
    pub(crate) torque: Symbol<'s>,
}

/// The wrench that a link hands on to a joint k that it carries, or to what the tip touches: f_{i,k} and n_{i,k} in its
/// frame.
#[derive(Clone)]
struct Carried<'s> {
    wrench: Wrench<'s>,
    r: Vector<'s>,
}

impl<'s> Motion<'s> {
    /// The base, in frame 0, whose origin accelerates with `of_origin`. No function asks how fast this moves.
    ///
    /// With a floating base, d_0 leads to its centre of mass, and c̈_0 = a + ω̇_0 × d_0 + ω_0 × (ω_0 × d_0).
    pub(crate) fn of_base(arm: &Arm<'s>, [omega, omega_dot, of_origin]: [Vector<'s>; 3], gravity: Vector<'s>) -> Self {
        let turning = Turning { rotation: identity(arm.builder), omega, omega_dot };
        let at_rest = arm.builder.zeros(Cause::FixedBase);
        let Some(body) = &arm.floating_base else {
            return Self { turning, d: at_rest, c_dot: at_rest, c_ddot: of_origin, gravity };
        };
        let (line, d) = (arm.builder.joint(0), body.com);
        let omega_cross_d = line.vector(Quantity::OmegaCrossD, || omega.cross(d));
        // the argument has the name of c̈_0
        let c_ddot =
            line.vector(Quantity::BaseAcceleration, || of_origin + omega_dot.cross(d) + omega.cross(omega_cross_d));
        Self { turning, d, c_dot: at_rest, c_ddot, gravity }
    }

    /// A floating base that moves with this velocity of the origin of frame 0 and this angular velocity,
    /// without accelerations.
    pub(crate) fn of_twist(arm: &Arm<'s>, [origin, omega]: [Vector<'s>; 2]) -> Self {
        let nothing = arm.builder.zeros(Cause::NoAcceleration);
        let turning = Self::of_base(arm, [omega, nothing, nothing], nothing);
        let velocity = || origin + omega.cross(turning.d);
        let c_dot = arm.builder.joint(0).vector(Quantity::Velocity, velocity);
        Self { c_dot, ..turning }
    }

    /// A base that does not move.
    pub(crate) fn of_fixed_base(builder: &'s Builder, gravity: Vector<'s>) -> Self {
        let at_rest = builder.zeros(Cause::FixedBase);
        let turning = Turning { rotation: identity(builder), omega: at_rest, omega_dot: at_rest };
        Self { turning, d: at_rest, c_dot: at_rest, c_ddot: at_rest, gravity }
    }
}

impl<'s> Wrench<'s> {
    /// Nothing touches the tip.
    pub(crate) fn of_free_tip(builder: &'s Builder) -> Self {
        Self { force: builder.zeros(Cause::FreeTip), moment: builder.zeros(Cause::FreeTip) }
    }

    /// The wrench in the axes of the link of `line`, on which it acts where `mount` is.
    fn carried(&self, line: JointLines<'s>, rotation: Matrix<'s>, mount: &Mount<'s>) -> Carried<'s> {
        let line = line.carrying(mount.label);
        let force = line.vector(Quantity::ChildForce, || rotation * self.force);
        let moment = line.vector(Quantity::ChildMoment, || rotation * self.moment);
        Carried { wrench: Wrench { force, moment }, r: mount.r }
    }
}

/// The torques of all joints, base to tip.
pub(crate) fn inverse_dynamics<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Motion<'s>,
    tip: &AtTip<'s>,
) -> Vec<Load<'s>> {
    let motions = forward(arm, states, base);
    backward(arm, states, (base, &motions), &tip.wrenches(arm, &motions)).0
}

/// The wrench that must act on a floating base, and the torques of all joints.
pub(crate) fn inverse_dynamics_of_floating_base<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Motion<'s>,
    tip: &AtTip<'s>,
) -> (Option<Wrench<'s>>, Vec<Load<'s>>) {
    let motions = forward(arm, states, base);
    let (loads, on_base) = backward(arm, states, (base, &motions), &tip.wrenches(arm, &motions));
    (on_base, loads)
}

/// Steps 1 and 2: how link i turns.
pub(crate) fn turning<'s>(joint: &Joint<'_, 's>, parent: &Turning<'s>) -> Turning<'s> {
    let rotation = joint.rotation();
    let back = rotation.transpose();

    // 1   ω_i = R_iᵀ ω_p (+ q̇_i e: revolute)
    let omega = joint.lines.vector(Quantity::Omega, || joint.angular_velocity(back * parent.omega));

    // 2   ω̇_i = R_iᵀ ω̇_p (+ q̈_i e + q̇_i ω_i × e: revolute)
    let omega_dot =
        joint.lines.vector(Quantity::OmegaDot, || joint.angular_acceleration(back * parent.omega_dot, omega));

    Turning { rotation, omega, omega_dot }
}

/// Forward, parents first: the motion of each link from that of its parent.
pub(crate) fn forward<'s>(arm: &Arm<'s>, states: &[JointState<'s>], base: &Motion<'s>) -> Vec<Motion<'s>> {
    let mut motions: Vec<Motion<'s>> = Vec::with_capacity(states.len());
    for joint in arm.joints(states) {
        let (line, r) = (joint.lines, joint.link.mount.r);
        let parent = joint.link.parent.map_or(*base, |parent| motions[parent]);
        let turning = turning(&joint, &parent.turning);
        let Turning { rotation, omega, omega_dot } = turning;
        let back = rotation.transpose();
        let d = joint.centre();

        // 3   ċ_i = R_iᵀ (ċ_p + ω_p × r_i) + ω_i × d_i (+ q̇_i e: prismatic)
        let of_parent = joint.lines_of_parent().carrying(joint.link.mount.label);
        let omega_cross_r = of_parent.vector(Quantity::OmegaCrossR, || parent.turning.omega.cross(r));
        let omega_cross_d = line.vector(Quantity::OmegaCrossD, || omega.cross(d));
        let joint_point = line.vector(Quantity::JointPointVelocity, || parent.c_dot + omega_cross_r);
        let c_dot = line.vector(Quantity::Velocity, || joint.velocity(back * joint_point + omega_cross_d));

        // 4   c̈_i = R_iᵀ (c̈_p + ω̇_p × r_i + ω_p × (ω_p × r_i))
        //           + ω̇_i × d_i + ω_i × (ω_i × d_i) (+ q̈_i e + 2 q̇_i ω_i × e: prismatic)
        let joint_point = line.vector(Quantity::JointPointAcceleration, || {
            parent.c_ddot + parent.turning.omega_dot.cross(r) + parent.turning.omega.cross(omega_cross_r)
        });
        let c_ddot = line.vector(Quantity::Acceleration, || {
            joint.acceleration(back * joint_point + omega_dot.cross(d) + omega.cross(omega_cross_d), omega)
        });

        // 5   g_i = R_iᵀ g_p
        let gravity = line.vector(Quantity::Gravity, || back * parent.gravity);

        motions.push(Motion { turning, d, c_dot, c_ddot, gravity });
    }
    motions
}

/// A rotor with its spin s and ṡ.
type Spinning<'a, 's> = (&'a Spin<'s>, [Symbol<'s>; 2]);

/// Step 6: the wrench that makes a body move as it does, with what it carries and the rotors that turn on it.
///
/// ```text
/// f_i = m_i c̈_i                n_i = I_i ω̇_i + ω_i × (I_i ω_i)
/// f_{p,i} = f_i + Σ R_k f_{i,k} - m_i g_i
/// n_{p,i} = n_i + Σ R_k n_{i,k} + d_i × f_{p,i} + Σ r_k × R_k f_{i,k}
/// ```
///
/// f_i - m_i g_i is written m_i (c̈_i - g_i): one product instead of two. So torques do not need f_i by itself. Of a
/// first moment h_i: f_i + ω̇_i × h_i + ω_i × (ω_i × h_i), n_i + h_i × c̈_i and n_{p,i} - h_i × g_i.
fn wrench<'s>(
    (line, at_joint, names): (JointLines<'s>, JointLines<'s>, [Quantity; 2]),
    body: &Body<'s>,
    motion: &Motion<'s>,
    carries: &[Carried<'s>],
    spins: &[Spinning<'_, 's>],
) -> Wrench<'s> {
    let Motion { turning: Turning { omega, omega_dot, .. }, d, c_ddot, gravity, .. } = *motion;
    let of_moment = body.first_moment.map(|h| turning_force(line, &motion.turning, h));
    // only listings show it
    line.vector(Quantity::InertiaForce, || with(c_ddot * body.mass, of_moment));
    let angular_momentum = line.vector(Quantity::AngularMomentum, || body.inertia * omega);
    let inertia_moment = line.vector(Quantity::InertiaMoment, || {
        let moment = body.inertia * omega_dot + omega.cross(angular_momentum);
        let moment = with(moment, body.first_moment.map(|h| h.cross(c_ddot)));
        spins.iter().fold(moment, |moment, (spin, [rate, rate_dot])| {
            moment + (spin.momentum(*rate_dot) + omega.cross(spin.momentum(*rate)))
        })
    });
    let [of_force, of_moments] = names;
    let force = at_joint.vector(of_force, || {
        let own = with((c_ddot - gravity) * body.mass, of_moment);
        with(own, carries.iter().map(|k| k.wrench.force).reduce(|sum, force| sum + force))
    });
    let moment = at_joint.vector(of_moments, || {
        let of_joints = carries.iter().map(|k| k.wrench.moment).reduce(|sum, moment| sum + moment);
        let moments = with(inertia_moment, of_joints) + d.cross(force);
        let of_levers = carries.iter().map(|k| k.r.cross(k.wrench.force)).reduce(|sum, moment| sum + moment);
        let moment = with(moments, of_levers);
        body.first_moment.map_or(moment, |h| moment - h.cross(gravity))
    });
    Wrench { force, moment }
}

/// Backward, parents last: the wrench at each joint, which its parent hands on. At the end, the wrench that must act on
/// a floating base.
pub(crate) fn backward<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    (base, motions): (&Motion<'s>, &[Motion<'s>]),
    at_tips: &[Wrench<'s>],
) -> (Vec<Load<'s>>, Option<Wrench<'s>>) {
    // of each rotor: s and ṡ
    let spinning = |spin: &Spin<'s>| {
        let rate = spin.of_joints(Quantity::Spin, states, |state| state.qd);
        [rate, spin.of_joints(Quantity::SpinDot, states, |state| state.qdd)]
    };
    let spins: Vec<Spinning<'_, 's>> = arm.spins.iter().map(|spin| (spin, spinning(spin))).collect();
    let on =
        |carrier: Option<usize>| -> Vec<_> { spins.iter().filter(|(spin, _)| spin.on == carrier).copied().collect() };
    let mut carried: Vec<Vec<Carried<'s>>> = vec![Vec::new(); motions.len()];
    let mut on_base = Vec::new();
    for (&(link, tip), wrench) in arm.tips.iter().zip(at_tips) {
        if let Some(link) = link {
            carried[link].push(wrench.carried(arm.builder.joint(link + 1), tip.rotation, &tip));
        }
    }
    let mut loads = Vec::with_capacity(motions.len());
    for (joint, motion) in arm.joints(states).zip(motions).rev() {
        let Joint { lines: line, link, .. } = joint;
        let lines = (line, line.behind(link.parent), [Quantity::JointForce, Quantity::JointMoment]);
        let wrench = wrench(lines, &link.body, motion, &carried[joint.index], &on(Some(joint.index)));

        // 7   τ_i = e · n_{p,i} (prismatic: e · f_{p,i})      with the rotor, if that belongs to the arm: + G² Jm q̈_i
        // rotors of the list `motors`, which turn on links: [`super::spin`] has their terms in steps 6 and 7
        let torque = line.scalar(arm.coordinates.torque(joint.index).quantity, || {
            let torque = joint.actuator(&wrench);
            let torque = link.rotor.map_or(torque, |rotor| torque + rotor * joint.state.qdd);
            let resistances = spins.iter().filter_map(|(spin, [_, rate_dot])| {
                let carrier = spin.on.map_or(base, |link| &motions[link]);
                spin.resistance(joint.index, *rate_dot, carrier.turning.omega_dot)
            });
            resistances.fold(torque, |torque, resistance| torque + resistance)
        });

        loads.push(Load { wrench, torque });
        let rotation = motion.turning.rotation;
        match link.parent {
            Some(parent) => {
                carried[parent].push(wrench.carried(arm.builder.joint(parent + 1), rotation, &link.mount));
            }
            None if arm.floating_base.is_some() => {
                on_base.push(wrench.carried(arm.builder.joint(0), rotation, &link.mount));
            }
            None => {}
        }
    }
    loads.reverse();
    let line = arm.builder.joint(0);
    let lines = (line, line, [Quantity::BaseForce, Quantity::BaseMoment]);
    let of_base = arm.floating_base.as_ref().map(|body| wrench(lines, body, base, &on_base, &on(None)));
    (loads, of_base)
}

/// ω̇ × h + ω × (ω × h)
fn turning_force<'s>(line: JointLines<'s>, turning: &Turning<'s>, h: Vector<'s>) -> Vector<'s> {
    let omega_cross_h = line.vector(Quantity::OmegaCrossMoment, || turning.omega.cross(h));
    line.vector(Quantity::MasslessForce, || turning.omega_dot.cross(h) + turning.omega.cross(omega_cross_h))
}

/// The vector, and what is added to it if anything is.
pub(crate) fn with<'s>(vector: Vector<'s>, more: Option<Vector<'s>>) -> Vector<'s> {
    more.map_or(vector, |more| vector + more)
}
