//! The seven steps of recursive Newton-Euler over symbols.
//!
//! NPTEL "Industrial Robotics: Theories for Implementation", lecture 38 (A. D. Udai), after S. K. Saha. Frame i is at
//! joint i and fixed to link i (form P), which serves standard and modified Denavit-Hartenberg tables with one text:
//! d_i = J_i → C_i, r_i = C_i → J_{i+1}, e = (0, 0, 1), and [x]_i = R_iᵀ [x]_{i-1}.

use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::QuarterTurns;

use crate::formulate::arm::{Arm, Link, identity};
use crate::ir::ledger::Cause;
use crate::ir::name::Name;
use crate::ir::quantity::Quantity;
use crate::ir::{Builder, JointLines, Matrix, Symbol, Vector};

/// Position, rate and acceleration of one joint.
#[derive(Clone, Copy)]
pub(crate) struct JointState<'s> {
    pub(crate) q: Symbol<'s>,
    pub(crate) qd: Symbol<'s>,
    pub(crate) qdd: Symbol<'s>,
    /// Sine and cosine of q, if they are arguments.
    pub(crate) turn: Option<(Symbol<'s>, Symbol<'s>)>,
}

/// A force and a moment.
#[derive(Clone, Copy)]
pub(crate) struct Wrench<'s> {
    pub(crate) force: Vector<'s>,
    pub(crate) moment: Vector<'s>,
}

/// How the base moves, and gravity, in frame 0.
#[derive(Clone, Copy)]
pub(crate) struct Base<'s> {
    pub(crate) omega: Vector<'s>,
    pub(crate) omega_dot: Vector<'s>,
    pub(crate) acceleration: Vector<'s>,
    pub(crate) gravity: Vector<'s>,
    /// r_0, from the origin of frame 0 to joint 1. Nobody needs it while the base stands still.
    pub(crate) lever: Vector<'s>,
}

impl<'s> Base<'s> {
    /// A base that stands still.
    pub(crate) fn fixed(builder: &'s Builder, gravity: Vector<'s>) -> Self {
        let at_rest = builder.zeros(Cause::FixedBase);
        Self { omega: at_rest, omega_dot: at_rest, acceleration: at_rest, gravity, lever: at_rest }
    }
}

/// How a link turns, in its frame: what steps 1 and 2 find.
#[derive(Clone, Copy)]
pub(crate) struct Turning<'s> {
    /// R_i
    pub(crate) rotation: Matrix<'s>,
    pub(crate) omega: Vector<'s>,
    pub(crate) omega_dot: Vector<'s>,
}

impl<'s> Turning<'s> {
    /// How the base turns.
    pub(crate) fn of_base(builder: &'s Builder, base: &Base<'s>) -> Self {
        Self { rotation: identity(builder), omega: base.omega, omega_dot: base.omega_dot }
    }

    /// How the link behind `joint` turns, when this is the link before it.
    pub(crate) fn of_next(self, builder: &'s Builder, joint: usize, link: &Link<'s>, state: &JointState<'s>) -> Self {
        let JointState { q, qd, qdd, turn } = *state;
        let e = axis(builder);
        let line = builder.joint(joint);
        let rotation = rotation(line, builder, joint, link, q, turn);
        let back = rotation.transpose();

        // 1   ω_i = R_iᵀ ω_{i-1} + q̇_i e
        let omega = line.vector(Quantity::Omega, || match link.kind {
            Revolute => back * self.omega + e * qd,
            Prismatic => back * self.omega,
        });

        // 2   ω̇_i = R_iᵀ ω̇_{i-1} + q̈_i e + q̇_i ω_i × e
        let omega_dot = line.vector(Quantity::OmegaDot, || match link.kind {
            Revolute => back * self.omega_dot + e * qdd + omega.cross(e) * qd,
            Prismatic => back * self.omega_dot,
        });
        Self { rotation, omega, omega_dot }
    }
}

/// The motion of a link and gravity, in its frame, with what the backward pass needs again.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'s> {
    pub(crate) rotation: Matrix<'s>,
    pub(crate) d: Vector<'s>,
    pub(crate) omega: Vector<'s>,
    pub(crate) omega_dot: Vector<'s>,
    pub(crate) c_dot: Vector<'s>,
    pub(crate) c_ddot: Vector<'s>,
    pub(crate) gravity: Vector<'s>,
}

/// What link i-1 exerts on link i, and the actuator.
#[derive(Clone, Copy)]
pub(crate) struct Load<'s> {
    pub(crate) wrench: Wrench<'s>,
    pub(crate) torque: Symbol<'s>,
}

/// What the actuators of all joints deliver, base to tip, when the last link exerts `tip` on its environment.
pub(crate) fn inverse_dynamics<'s>(
    builder: &'s Builder,
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Base<'s>,
    tip: Wrench<'s>,
) -> Vec<Load<'s>> {
    let motions = forward(builder, arm, states, base);
    backward(builder, arm, &motions, tip)
}

/// Forward, i = 1 … n: the motion of each link from that of the link before it.
pub(crate) fn forward<'s>(
    builder: &'s Builder,
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Base<'s>,
) -> Vec<Motion<'s>> {
    let e = axis(builder);
    let mut turning = Turning::of_base(builder, base);
    // no function asks how fast the base itself moves
    let (mut c_dot, mut c_ddot) = (builder.zeros(Cause::FixedBase), base.acceleration);
    let mut r = base.lever;
    let mut gravity = base.gravity;
    let mut motions = Vec::with_capacity(arm.links.len());
    for (index, (link, state)) in arm.links.iter().zip(states).enumerate() {
        let line = builder.joint(index + 1);
        let JointState { q, qd, qdd, .. } = *state;
        let Turning { omega: omega_before, omega_dot: omega_dot_before, .. } = turning;
        // 1, 2
        turning = turning.of_next(builder, index + 1, link, state);
        let Turning { rotation, omega, omega_dot } = turning;
        let back = rotation.transpose();

        let d = centre_of_mass(line, builder, index + 1, link, q);

        // 3   ċ_i = R_iᵀ (ċ_{i-1} + ω_{i-1} × r_{i-1}) + ω_i × d_i      (+ q̇_i e)
        let omega_cross_r = line.of_link_before().vector(Quantity::OmegaCrossR, || omega_before.cross(r));
        let omega_cross_d = line.vector(Quantity::OmegaCrossD, || omega.cross(d));
        c_dot = line.vector(Quantity::Velocity, || {
            let turning = back * (c_dot + omega_cross_r) + omega_cross_d;
            match link.kind {
                Revolute => turning,
                Prismatic => turning + e * qd,
            }
        });

        // 4   c̈_i = R_iᵀ (c̈_{i-1} + ω̇_{i-1} × r_{i-1} + ω_{i-1} × (ω_{i-1} × r_{i-1}))
        //           + ω̇_i × d_i + ω_i × (ω_i × d_i)      (+ q̈_i e + 2 q̇_i ω_i × e)
        let joint_point = line.vector(Quantity::JointPointAcceleration, || {
            c_ddot + omega_dot_before.cross(r) + omega_before.cross(omega_cross_r)
        });
        let twice_qd = || line.scalar(Quantity::TwiceRate, || builder.entry(Name::scalar(Quantity::Two, 0), 2.0) * qd);
        c_ddot = line.vector(Quantity::Acceleration, || {
            let turning = back * joint_point + omega_dot.cross(d) + omega.cross(omega_cross_d);
            match link.kind {
                Revolute => turning,
                Prismatic => turning + e * qdd + omega.cross(e) * twice_qd(),
            }
        });

        // 5   g_i = R_iᵀ g_{i-1}
        gravity = line.vector(Quantity::Gravity, || back * gravity);

        r = link.r;
        motions.push(Motion { rotation, d, omega, omega_dot, c_dot, c_ddot, gravity });
    }
    motions
}

/// Backward, i = n … 1: the wrench of each joint from that of the joint after it.
pub(crate) fn backward<'s>(
    builder: &'s Builder,
    arm: &Arm<'s>,
    motions: &[Motion<'s>],
    tip: Wrench<'s>,
) -> Vec<Load<'s>> {
    let mut child = tip;
    let mut into_frame = arm.tip;
    let mut loads = Vec::with_capacity(arm.links.len());
    for (index, (link, motion)) in arm.links.iter().zip(motions).enumerate().rev() {
        let line = builder.joint(index + 1);
        let Motion { rotation, d, omega, omega_dot, c_ddot, gravity, .. } = *motion;
        let child_force = line.vector(Quantity::ChildForce, || into_frame * child.force);
        let child_moment = line.vector(Quantity::ChildMoment, || into_frame * child.moment);

        // 6   f_i = m_i c̈_i                n_i = I_i ω̇_i + ω_i × (I_i ω_i)
        //     f_{i-1,i} = f_i + f_{i,i+1} - m_i g_i
        //     n_{i-1,i} = n_i + n_{i,i+1} + d_i × f_{i-1,i} + r_i × f_{i,i+1}
        // f_i - m_i g_i is written m_i (c̈_i - g_i): one product instead of two. So torques do not need f_i by itself.
        line.vector(Quantity::InertiaForce, || c_ddot * link.mass);
        let angular_momentum = line.vector(Quantity::AngularMomentum, || link.inertia * omega);
        let inertia_moment =
            line.vector(Quantity::InertiaMoment, || link.inertia * omega_dot + omega.cross(angular_momentum));
        let force = line.vector(Quantity::JointForce, || (c_ddot - gravity) * link.mass + child_force);
        let moment = line.vector(Quantity::JointMoment, || {
            inertia_moment + child_moment + d.cross(force) + link.r.cross(child_force)
        });

        // 7   τ_i = e · n_{i-1,i}     (prismatic: e · f_{i-1,i})
        let torque = line.scalar(Quantity::Torque, || match link.kind {
            Revolute => moment.z(),
            Prismatic => force.z(),
        });

        child = Wrench { force, moment };
        into_frame = rotation;
        loads.push(Load { wrench: child, torque });
    }
    loads.reverse();
    loads
}

/// e, the joint's axis in its frame.
pub(crate) fn axis(builder: &Builder) -> Vector<'_> {
    Vector([0.0, 0.0, 1.0].map(|value| builder.constant(value, Cause::JointAxis)))
}

/// R_i = Rx(α_{i-1}) Rz(θ_i).
pub(crate) fn rotation<'s>(
    line: JointLines<'s>,
    builder: &'s Builder,
    joint: usize,
    link: &Link<'s>,
    q: Symbol<'s>,
    turn: Option<(Symbol<'s>, Symbol<'s>)>,
) -> Matrix<'s> {
    let (s, c) = match link.kind {
        Revolute => joint_angle(line, builder, joint, link, q, turn),
        Prismatic => {
            let (s, c) = builder.constant_turn(&link.theta, Cause::Arithmetic);
            (
                builder.name(Name::scalar(Quantity::ThetaSine, joint), s),
                builder.name(Name::scalar(Quantity::ThetaCosine, joint), c),
            )
        }
    };
    let (zero, one) = (builder.constant(0.0, Cause::TurnAboutZ), builder.constant(1.0, Cause::TurnAboutZ));
    let about_z = Matrix::from_rows([[c, -s, zero], [s, c, zero], [zero, zero, one]]);
    line.matrix(Quantity::Rotation, || link.twist * about_z)
}

/// Sine and cosine of θ + q. A right angle θ permutes and negates those of q exactly; any other is added to q.
fn joint_angle<'s>(
    line: JointLines<'s>,
    builder: &'s Builder,
    joint: usize,
    link: &Link<'s>,
    q: Symbol<'s>,
    turn: Option<(Symbol<'s>, Symbol<'s>)>,
) -> (Symbol<'s>, Symbol<'s>) {
    if let Some(turn) = turn {
        if let Some(turns) = link.theta.right {
            return by_quarters(turn, turns);
        }
        // the addition theorem
        let ((s, c), (sin, cos)) = (turn, builder.constant_turn(&link.theta, Cause::Arithmetic));
        let sin = builder.name(Name::scalar(Quantity::ThetaSine, joint), sin);
        let cos = builder.name(Name::scalar(Quantity::ThetaCosine, joint), cos);
        return (
            line.scalar(Quantity::TurnedSine, || s * cos + c * sin),
            line.scalar(Quantity::TurnedCosine, || c * cos - s * sin),
        );
    }
    let angle = if link.theta.right.is_some() {
        q
    } else {
        line.scalar(Quantity::Angle, || builder.entry(Name::scalar(Quantity::Theta, joint), link.theta.radians) + q)
    };
    let (s, c) = builder.sine_and_cosine(angle);
    let s = builder.name(Name::scalar(Quantity::Sine, joint), s);
    let c = builder.name(Name::scalar(Quantity::Cosine, joint), c);
    link.theta.right.map_or((s, c), |turns| by_quarters((s, c), turns))
}

/// Sine and cosine of an angle that is so many right angles larger.
fn by_quarters<'s>((s, c): (Symbol<'s>, Symbol<'s>), turns: QuarterTurns) -> (Symbol<'s>, Symbol<'s>) {
    match turns {
        QuarterTurns::Zero => (s, c),
        QuarterTurns::One => (c, -s),
        QuarterTurns::Two => (-s, -c),
        QuarterTurns::Three => (-c, s),
    }
}

/// d_i: J_i → C_i, a constant of the table; a prismatic joint moves it along its axis.
fn centre_of_mass<'s>(
    line: JointLines<'s>,
    builder: &'s Builder,
    joint: usize,
    link: &Link<'s>,
    q: Symbol<'s>,
) -> Vector<'s> {
    match link.kind {
        Revolute => builder.name_vector(Quantity::D, joint, link.offset + link.com),
        Prismatic => line.vector(Quantity::D, || {
            let [x, y, z] = link.offset.0;
            Vector([x, y, z + q]) + link.com
        }),
    }
}
