//! The seven steps as in the slides of lecture 38, with every misprint of its transcript as an option.
//!
//! Frame i is on the axis of joint i and fixed to link i-1. The vectors of link i are expressed in frame i, so e_i is
//! always (0, 0, 1), and a_i, d_i, r_i and I_i depend on the joint angle:
//!
//! ```text
//! T_i = Rz(θ_i) Tz(b_i) Tx(a_i) Rx(α_i)    frame i+1 from frame i; its rotation is Q_i, its translation [a_i]_i
//! a_i   O_i → O_{i+1}       d_i   O_i → C_i (centre of mass)       r_i   C_i → O_{i+1}       I_i   about C_i
//! ```
//!
//! The numbers of the table are constant in frame i+1: \[r_i\]_{i+1} and \[I_i\]_{i+1}.

use nalgebra::{Matrix3, Vector3};
use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::Row;
use rne_runtime::Wrench;

pub use crate::misprint::Misprint;

/// The motion of an arm, and the forces on it.
#[derive(Clone, Debug)]
pub struct State {
    /// Joint variables θ_i or b_i, without the constant of the table.
    pub q: Vec<f64>,
    /// Joint velocities θ̇_i or ḃ_i.
    pub qd: Vec<f64>,
    /// Joint accelerations θ̈_i or b̈_i.
    pub qdd: Vec<f64>,
    /// Acceleration of gravity \[g\]_1, in frame 1.
    pub gravity: [f64; 3],
    /// The wrench of the last link on its environment: f_{n,n+1} and n_{n,n+1}, in frame n+1.
    pub wrench: Wrench<f64>,
}

/// The results of the seven steps for link i, in frame i.
#[derive(Clone, Copy, Debug, Default)]
pub struct LinkVectors {
    /// Angular velocity ω_i.
    pub omega: Vector3<f64>,
    /// Angular acceleration ω̇_i.
    pub omega_dot: Vector3<f64>,
    /// Velocity ċ_i of the centre of mass.
    pub velocity: Vector3<f64>,
    /// Acceleration c̈_i of the centre of mass.
    pub acceleration: Vector3<f64>,
    /// Acceleration of gravity g_i.
    pub gravity: Vector3<f64>,
    /// Force f_i that accelerates the link, m_i c̈_i.
    pub inertia_force: Vector3<f64>,
    /// Moment n_i that accelerates the link, about the centre of mass.
    pub inertia_moment: Vector3<f64>,
    /// Force f_{i-1,i} of link i-1 on link i.
    pub joint_force: Vector3<f64>,
    /// Moment n_{i-1,i} of link i-1 on link i.
    pub joint_moment: Vector3<f64>,
    /// Torque or force τ_i of the actuator.
    pub tau: f64,
}

/// The vectors and the inertia of link i at a joint angle.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The rotation Q_i.
    pub turn: Matrix3<f64>,
    /// The transposed rotation Q_iᵀ.
    turn_back: Matrix3<f64>,
    /// The vector \[a_i\]_i from O_i to O_{i+1}.
    pub a: Vector3<f64>,
    /// The vector \[d_i\]_i from O_i to C_i.
    pub d: Vector3<f64>,
    /// The vector \[r_i\]_i from C_i to O_{i+1}.
    pub r: Vector3<f64>,
    /// The inertia \[I_i\]_i about C_i.
    pub inertia: Matrix3<f64>,
    /// The offset b_i.
    offset: f64,
}

/// Returns Q_i, whose columns are the axes of frame i+1 in frame i.
#[rustfmt::skip]
pub fn turn(theta: f64, alpha: f64) -> Matrix3<f64> {
    let ((s, c), (sa, ca)) = (theta.sin_cos(), alpha.sin_cos());
    Matrix3::new(
        c,   -s * ca, s * sa,
        s,   c * ca,  -c * sa,
        0.0, sa,      ca,
    )
}

/// Returns Q_iᵀ, which step 1 uses.
#[rustfmt::skip]
pub fn turn_back(theta: f64, alpha: f64, misprints: &[Misprint]) -> Matrix3<f64> {
    let ((s, c), (sa, ca)) = (theta.sin_cos(), alpha.sin_cos());
    let third = if misprints.contains(&Misprint::E1ThirdColumn) { [0.0, -1.0, -1.0] } else { [0.0, sa, ca] };
    Matrix3::new(
        c,       s,       third[0],
        -s * ca, c * ca,  third[1],
        s * sa,  -c * sa, third[2],
    )
}

/// Returns a_i, d_i, r_i and I_i of every link at the joint positions `q`.
pub fn place(rows: &[Row], q: &[f64], misprints: &[Misprint]) -> Vec<Placed> {
    let mut placed = Vec::new();
    let mut frames_before = Vector3::zeros(); // O_{i-1} → O_i
    for (row, &q) in rows.iter().zip(q) {
        // θ_i and b_i, one of which is the joint variable
        let (theta, b) = match row.kind {
            Revolute => (row.dh.theta.radians + q, row.dh.d),
            Prismatic => (row.dh.theta.radians, row.dh.d + q),
        };
        let alpha = row.dh.alpha.radians;
        let (turn, turn_back) = (turn(theta, alpha), turn_back(theta, alpha, misprints));

        let frames = Vector3::new(row.dh.a * theta.cos(), row.dh.a * theta.sin(), b); // O_i → O_{i+1}
        let a = if misprints.contains(&Misprint::E9FramesBefore) { frames_before } else { frames };
        frames_before = turn.transpose() * frames;

        let constant_r = -Vector3::from(row.link.com);
        let r = if misprints.contains(&Misprint::E7ConstantR) { constant_r } else { turn * constant_r };

        let slides = row.kind == Prismatic;
        let d = if misprints.contains(&Misprint::E8OffsetForD) && slides { Vector3::new(0.0, 0.0, b) } else { a - r };

        let constant_inertia = Matrix3::from(row.link.inertia.rows());
        let inertia = if misprints.contains(&Misprint::E11InertiaNotTurned) {
            constant_inertia
        } else {
            turn * constant_inertia * turn.transpose()
        };
        placed.push(Placed { turn, turn_back, a, d, r, inertia, offset: b });
    }
    placed
}

/// Computes the seven steps for the standard table `rows`; they are correct without misprints.
pub fn seven_steps(rows: &[Row], state: &State, misprints: &[Misprint]) -> Vec<LinkVectors> {
    let links = place(rows, &state.q, misprints);
    let mut found = forward(rows, &links, state, misprints);
    backward(rows, &links, state, misprints, &mut found);
    found
}

/// Computes steps 1 to 5, from the base to the tip.
fn forward(rows: &[Row], links: &[Placed], state: &State, misprints: &[Misprint]) -> Vec<LinkVectors> {
    let e = axis(misprints);
    let mut all = Vec::new();
    // link 0 is at rest in frame 1
    let mut prev = LinkVectors { gravity: state.gravity.into(), ..LinkVectors::default() };
    if misprints.contains(&Misprint::E13GroundFrame) {
        prev.gravity = links[0].turn.transpose() * prev.gravity;
    }
    let mut r_prev = Vector3::zeros();
    for (i, (row, link)) in rows.iter().zip(links).enumerate() {
        let (rate, rate_dot) = (state.qd[i], state.qdd[i]);
        let qt = turn_from_before(links, i, misprints);

        // Step 1, R: ω_i = Q_{i-1}ᵀ ω_{i-1} + θ̇_i e_i   P: without θ̇_i e_i
        let omega = match row.kind {
            Revolute if misprints.contains(&Misprint::E22NoJointRate) => qt * prev.omega,
            Revolute => qt * prev.omega + rate * e,
            Prismatic => qt * prev.omega,
        };
        let mut this = LinkVectors { omega, ..LinkVectors::default() };

        // Step 2, R: ω̇_i = Q_{i-1}ᵀ ω̇_{i-1} + θ̈_i e_i + θ̇_i ω_i × e_i   P: the first term
        let right_side = match row.kind {
            Revolute => qt * prev.omega_dot + rate_dot * e + rate * this.omega.cross(&e),
            Prismatic if misprints.contains(&Misprint::E4TurnedTwice) => qt * (qt * prev.omega_dot),
            Prismatic => qt * prev.omega_dot,
        };
        let left_side = if misprints.contains(&Misprint::E3LeftSide) { &mut this.omega } else { &mut this.omega_dot };
        *left_side = right_side;

        // Step 3: ċ_i = Q_{i-1}ᵀ (ċ_{i-1} + ω_{i-1} × r_{i-1}) + ω_i × d_i   P: + ḃ_i e_i
        let lever = if misprints.contains(&Misprint::E6FactorsSwapped) {
            r_prev.cross(&prev.omega)
        } else {
            prev.omega.cross(&r_prev)
        };
        this.velocity = qt * (prev.velocity + lever) + this.omega.cross(&link.d);
        if row.kind == Prismatic {
            this.velocity += if misprints.contains(&Misprint::E5NoDot) { link.offset } else { rate } * e;
        }

        // Step 4: c̈_i = Q_{i-1}ᵀ (c̈_{i-1} + ω̇_{i-1} × r_{i-1} + ω_{i-1} × (ω_{i-1} × r_{i-1}))
        //               + ω̇_i × d_i + ω_i × (ω_i × d_i)   P: + b̈_i e_i + 2 ḃ_i ω_i × e_i
        let joint_origin =
            prev.acceleration + prev.omega_dot.cross(&r_prev) + prev.omega.cross(&prev.omega.cross(&r_prev));
        this.acceleration =
            qt * joint_origin + this.omega_dot.cross(&link.d) + this.omega.cross(&this.omega.cross(&link.d));
        if row.kind == Prismatic {
            let factor = if misprints.contains(&Misprint::CoriolisOnce) { 1.0 } else { 2.0 };
            this.acceleration += rate_dot * e + factor * rate * this.omega.cross(&e);
        }

        // Step 5: g_i = Q_{i-1}ᵀ g_{i-1}
        this.gravity = qt * prev.gravity;

        all.push(this);
        (prev, r_prev) = (this, link.r);
    }
    all
}

/// Returns Q_{i-1}ᵀ, the rotation from frame i-1 to frame i.
fn turn_from_before(links: &[Placed], i: usize, misprints: &[Misprint]) -> Matrix3<f64> {
    match i {
        _ if misprints.contains(&Misprint::E2WrongQ) => links[i].turn.transpose(),
        0 => Matrix3::identity(),
        _ => links[i - 1].turn_back,
    }
}

/// Computes steps 6 and 7, from the tip to the base.
fn backward(rows: &[Row], links: &[Placed], state: &State, misprints: &[Misprint], found: &mut [LinkVectors]) {
    let e = axis(misprints);
    // f_{i,i+1} and n_{i,i+1}, in frame i+1
    let (mut force, mut moment) = state.wrench.vectors();
    for ((row, link), this) in rows.iter().zip(links).zip(found).rev() {
        let mass = row.link.mass;

        // [f_{i,i+1}]_i = Q_i [f_{i,i+1}]_{i+1}, and the same for n
        if !misprints.contains(&Misprint::E10ForceNotTurned) {
            force = link.turn * force;
        }
        if !misprints.contains(&Misprint::E10MomentNotTurned) {
            moment = link.turn * moment;
        }

        // Step 6: f_i = m_i c̈_i
        //         n_i = I_i ω̇_i + ω_i × (I_i ω_i)
        //         f_{i-1,i} = f_i + f_{i,i+1} - m_i g_i
        //         n_{i-1,i} = n_i + n_{i,i+1} + d_i × f_{i-1,i} + r_i × f_{i,i+1}
        this.inertia_force = mass * this.acceleration;
        this.inertia_moment = link.inertia * this.omega_dot;
        if !misprints.contains(&Misprint::NoGyroscopicMoment) {
            this.inertia_moment += this.omega.cross(&(link.inertia * this.omega));
        }
        // a first moment in addition to the mass, which no body has and the lecture does not treat
        let first_moment = row.link.has_first_moment().then(|| link.turn * Vector3::from(row.link.first_moment));
        if let Some(h) = first_moment {
            this.inertia_force += this.omega_dot.cross(&h) + this.omega.cross(&this.omega.cross(&h));
            this.inertia_moment += h.cross(&this.acceleration);
        }
        this.joint_force = this.inertia_force + force - mass * this.gravity;
        this.joint_moment = this.inertia_moment + moment + link.d.cross(&this.joint_force) + link.r.cross(&force);
        if let Some(h) = first_moment {
            this.joint_moment -= h.cross(&this.gravity);
        }

        // Step 7, R: τ_i = e_i · n_{i-1,i}   P: τ_i = e_i · f_{i-1,i}
        this.tau = match row.kind {
            Revolute => e.dot(&this.joint_moment),
            Prismatic => e.dot(&this.joint_force),
        };
        (force, moment) = (this.joint_force, this.joint_moment);
    }
}

/// Returns e_i, the axis of joint i in frame i.
fn axis(misprints: &[Misprint]) -> Vector3<f64> {
    if misprints.contains(&Misprint::E17AxisX) { Vector3::x() } else { Vector3::z() }
}
