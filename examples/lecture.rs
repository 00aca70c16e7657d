//! Lecture 38 on one page: recursive Newton-Euler for a serial arm with a standard table. Its torques have the bits of
//! `rne::Arm`: `cargo test --test robots lecture`.
//!
//! Link i is the one that joint i moves; p is the link before it. Vectors of link i are in axes that are fixed to it,
//! with z along joint i.

use nalgebra::{Matrix3, Vector3};
use rne::Scalar;
use rne::model::{Angle, JointKind, Robot, Row};

/// Results of the forward pass for link i, which the backward pass needs.
struct Link {
    is_revolute: bool,
    /// R_i turns components in the axes of link i into those of link p.
    rotation: Matrix3<f64>,
    /// r_i: from the centre of mass of link p to joint i, m.
    r: Vector3<f64>,
    /// d_i: from joint i to the centre of mass of link i, m.
    d: Vector3<f64>,
    /// m_i (c̈_i - g_i): the force that accelerates the link, less its weight, N.
    force: Vector3<f64>,
    /// I_i ω̇_i + ω_i × (I_i ω_i): the moment that accelerates the link, N m.
    moment: Vector3<f64>,
}

/// Torques τ (N m, prismatic: N) for positions, velocities and accelerations of the joints.
pub(crate) fn inverse_dynamics(robot: &Robot, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    let (e, zero) = (Vector3::z(), Vector3::<f64>::zeros());
    let mut links: Vec<Link> = Vec::new();
    let (mut omega, mut omega_dot, mut c_ddot, mut g) = (zero, zero, zero, Vector3::from(robot.gravity));
    // The base is at rest. Below, R_i = Rx(α_p) Rz(θ_i).
    let (mut twist, mut r) = (Matrix3::<f64>::identity(), zero);

    // Forward, from the base to the tip.
    for (i, joint) in robot.joints.iter().enumerate() {
        let Row { kind, dh, link } = joint.row;
        let is_revolute = kind == JointKind::Revolute;
        let rotation = twist * rz(&joint.row, q[i]);
        let into_i = |vector: Vector3<f64>| rotation.tr_mul(&vector); // R_iᵀ, from axes of link p
        // the table has com and inertia in axes at the end of the link, which Rx(α_i) turns
        let com = rx(&dh.alpha) * Vector3::from(link.com);
        let d = Vector3::new(dh.a, 0.0, if is_revolute { dh.d } else { dh.d + q[i] }) + com;

        let origin_ddot = (c_ddot + omega_dot.cross(&r)) + omega.cross(&omega.cross(&r));
        // Steps 1 and 2: angular velocity ω_i and acceleration ω̇_i.
        (omega, omega_dot) = (into_i(omega), into_i(omega_dot));
        if is_revolute {
            omega += e * qd[i];
            omega_dot = (omega_dot + e * qdd[i]) + omega.cross(&e) * qd[i];
        }
        // Step 3, the velocity ċ_i, is not needed for the torques.
        // Step 4: acceleration c̈_i of the centre of mass.
        c_ddot = (into_i(origin_ddot) + omega_dot.cross(&d)) + omega.cross(&omega.cross(&d));
        if !is_revolute {
            c_ddot = (c_ddot + e * qdd[i]) + omega.cross(&e) * (2.0 * qd[i]);
        }
        // Step 5: gravity g_i.
        g = into_i(g);
        // Step 6, the link alone.
        let inertia = (rx(&dh.alpha) * Matrix3::from(link.inertia.rows()).transpose()) * rx(&dh.alpha).transpose();
        let force = (c_ddot - g) * link.mass;
        let moment = inertia * omega_dot + omega.cross(&(inertia * omega));
        links.push(Link { is_revolute, rotation, r, d, force, moment });
        (twist, r) = (rx(&dh.alpha), -com);
    }

    // Backward, from the tip to the base. Step 6, the balance of link i with the force and moment that it exerts on
    // link i + 1.
    let mut torques = vec![0.0; links.len()];
    let (mut f, mut n, mut r_cross_f) = (zero, zero, zero);
    for (i, link) in links.iter().enumerate().rev() {
        let force = link.force + f;
        let moment = ((link.moment + n) + link.d.cross(&force)) + r_cross_f;
        // Step 7: the actuator delivers the element along the joint's axis.
        torques[i] = if link.is_revolute { moment.z } else { force.z };
        (f, n) = (link.rotation * force, link.rotation * moment);
        r_cross_f = link.r.cross(&f);
    }
    torques
}

/// Rx(α)
fn rx(Angle { sin: s, cos: c, .. }: &Angle) -> Matrix3<f64> {
    Matrix3::new(1.0, 0.0, 0.0, 0.0, *c, -s, 0.0, *s, *c)
}

/// Rz(θ_i), with θ_i + q_i for a revolute joint. Quarter turns are exact: each maps (sin, cos) to (cos, -sin).
fn rz(row: &Row, q: f64) -> Matrix3<f64> {
    let theta = &row.dh.theta;
    let (s, c) = match (row.kind, theta.right) {
        (JointKind::Prismatic, _) => (theta.sin, theta.cos),
        (JointKind::Revolute, None) => Scalar::sin_cos(theta.radians + q),
        (JointKind::Revolute, Some(turns)) => (0..turns as usize).fold(Scalar::sin_cos(q), |(s, c), _| (c, -s)),
    };
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

fn main() {
    let robot = Robot::from_yaml(include_str!("../robots/puma560.yaml")).expect("a shipped robot");
    println!("{:.4?} N m", inverse_dynamics(&robot, &[0.1; 6], &[0.2; 6], &[0.3; 6]));
}
