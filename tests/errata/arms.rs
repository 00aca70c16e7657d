//! The arms on which the slips are tried, and their states.

use std::f64::consts::{FRAC_PI_2, PI};

use fastrand::Rng;
use nalgebra::{Matrix3, Vector3};
use rne::{DynArm, Wrench};
use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::{Angle, Convention, Dh, Inertia, JointKind, Link, Model, Row, Transform};

use rne_diagnose::lecture::State;

/// An arm with a standard table. Its own gravity is not used: a [`State`] brings one.
fn arm<const DOF: usize>(rows: [Row; DOF]) -> DynArm {
    let gravity = [0.0; 3];
    let (base, tool) = (Transform::IDENTITY, Transform::IDENTITY);
    DynArm::new(&Model { convention: Convention::Standard, gravity, base, tool, rows })
}

/// Columns as in the specification: a, α, b, θ.
fn row(kind: JointKind, [a, alpha, b, theta]: [f64; 4], link: Link) -> Row {
    Row { kind, dh: Dh { theta: Angle::new(theta), d: b, a, alpha: Angle::new(alpha) }, link }
}

/// Mass, centre of mass, and Ixx Iyy Izz Ixy Ixz Iyz about it.
pub(crate) fn link(mass: f64, com: [f64; 3], [xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Link {
    Link { mass, com, inertia: Inertia { xx, yy, zz, xy, xz, yz }, ..Link::default() }
}

/// A uniform thin rod whose distal end is the origin of its link frame.
fn rod(mass: f64, length: f64) -> Link {
    let about_com = mass * length * length / 12.0;
    link(mass, [-length / 2.0, 0.0, 0.0], [0.0, about_com, about_com, 0.0, 0.0, 0.0])
}

/// Mass and length of the lecture's rod.
pub(crate) const ROD: (f64, f64) = (2.5, 0.8);

/// The lecture's example.
pub(crate) fn one_link() -> DynArm {
    one_link_with(rod(ROD.0, ROD.1))
}

/// The lecture's example with another body in place of the rod.
pub(crate) fn one_link_with(link: Link) -> DynArm {
    arm([row(Revolute, [ROD.1, 0.0, 0.0, 0.0], link)])
}

/// The lecture's rod and a second one.
pub(crate) fn two_rods() -> DynArm {
    arm([row(Revolute, [0.8, 0.0, 0.0, 0.0], rod(2.5, 0.8)), row(Revolute, [0.6, 0.0, 0.0, 0.0], rod(1.5, 0.6))])
}

/// A slide on a turning joint.
pub(crate) fn revolute_prismatic() -> DynArm {
    arm([
        row(Revolute, [0.0, FRAC_PI_2, 0.0, 0.0], link(2.5, [0.0, 0.0, 0.3], [0.0, 0.12, 0.0, 0.0, 0.0, 0.0])),
        row(Prismatic, [0.0; 4], link(1.5, [0.0; 3], [0.0, 0.05, 0.0, 0.0, 0.0, 0.0])),
    ])
}

/// A turning joint on a slide.
pub(crate) fn prismatic_revolute() -> DynArm {
    arm([
        row(Prismatic, [0.0, FRAC_PI_2, 0.0, 0.0], link(2.5, [0.0; 3], [0.0; 6])),
        row(Revolute, [0.6, 0.0, 0.0, 0.0], link(1.5, [-0.3, 0.0, 0.0], [0.0, 0.0, 0.05, 0.0, 0.0, 0.0])),
    ])
}

/// R R P R P R: skew axes, full inertias, both kinds of joint.
#[rustfmt::skip]
pub(crate) fn six_joints() -> DynArm {
    arm([
        row(Revolute,  [0.10, 0.9, 0.40, 0.0],   link(4.0, [-0.05, 0.02, 0.03], [0.050, 0.060, 0.040, 0.004, -0.003, 0.002])),
        row(Revolute,  [0.45, -0.3, 0.05, 0.2],  link(3.0, [-0.20, 0.01, 0.04], [0.020, 0.070, 0.065, -0.002, 0.001, 0.003])),
        row(Prismatic, [0.20, 0.7, 0.15, -0.4],  link(2.0, [0.03, -0.06, 0.02], [0.030, 0.025, 0.015, 0.001, 0.002, -0.001])),
        row(Revolute,  [-0.05, 1.3, 0.30, 0.1],  link(1.5, [0.02, 0.03, -0.05], [0.012, 0.010, 0.008, -0.001, 0.0005, 0.0007])),
        row(Prismatic, [0.08, -1.1, 0.10, 0.6],  link(1.0, [-0.03, 0.01, 0.02], [0.006, 0.005, 0.004, 0.0003, -0.0002, 0.0004])),
        row(Revolute,  [0.12, 0.5, -0.07, -0.3], link(0.5, [0.01, -0.02, 0.06], [0.0020, 0.0018, 0.0009, 0.0001, 0.0002, -0.0001])),
    ])
}

/// The same without the masses of links 2 and 5: of them there are first moments.
pub(crate) fn six_joints_two_without_mass() -> DynArm {
    let mut rows: [Row; 6] = std::array::from_fn(|index| six_joints().rows()[index]);
    for index in [1, 4] {
        let Link { mass, com, inertia, .. } = rows[index].link;
        rows[index].link = Link { inertia, first_moment: com.map(|c| mass * c), ..Link::default() };
    }
    arm(rows)
}

/// The state of the lecture's example: θ, θ̇, θ̈ = 0.6 rad, 1.3 rad/s, -0.7 rad/s²; X points down.
pub(crate) fn one_link_state() -> State {
    State { q: vec![0.6], qd: vec![1.3], qdd: vec![-0.7], gravity: [9.81, 0.0, 0.0], wrench: Wrench::zero() }
}

/// Positions 0.6 and -1.1; the first joint as in the example.
pub(crate) fn two_rods_state() -> State {
    State { q: vec![0.6, -1.1], qd: vec![1.3, -0.4], qdd: vec![-0.7, 2.1], ..one_link_state() }
}

pub(crate) fn revolute_prismatic_state() -> State {
    State { q: vec![0.6, 0.9], gravity: [0.0, -9.81, 0.0], ..two_rods_state() }
}

pub(crate) fn prismatic_revolute_state() -> State {
    State { q: vec![0.9, 0.6], gravity: [0.0, 0.0, -9.81], ..two_rods_state() }
}

/// Free tip.
pub(crate) fn six_joints_state() -> State {
    State {
        q: vec![0.3, -0.8, 0.25, 1.1, 0.15, -0.6],
        qd: vec![0.9, -0.5, 0.4, 1.2, -0.3, 0.7],
        qdd: vec![-1.1, 0.6, 0.8, -0.9, 1.4, 0.35],
        gravity: [0.0, 0.0, -9.81],
        wrench: Wrench::zero(),
    }
}

/// With force and moment at the tip.
pub(crate) fn six_joints_loaded() -> State {
    State { wrench: Wrench { force: [2.0, -1.5, 4.0], moment: [0.3, 0.7, -0.2] }, ..six_joints_state() }
}

/// The ten arms of the table "which arm notices which slip", in its order.
#[rustfmt::skip]
pub(crate) fn arms_of_the_table() -> [(&'static str, DynArm); 10] {
    let [l1, l2, l3, l4] = bodies();
    [
        ("R", one_link()),
        ("RR", arm([row(Revolute, [0.8, 0.0, 0.0, 0.0], l1), row(Revolute, [0.6, 0.0, 0.0, 0.0], l2)])),
        ("RP", arm([row(Revolute, [0.0, FRAC_PI_2, 0.1, 0.0], l1), row(Prismatic, [0.0, 0.0, 0.2, 0.0], l2)])),
        ("PR", arm([row(Prismatic, [0.25, FRAC_PI_2, 0.2, 0.0], l1), row(Revolute, [0.6, 0.0, 1.0 / 12.0, 0.0], l2)])),
        // The arm of a SCARA, then all of it.
        ("RRP", arm([
            row(Revolute, [0.4, 0.0, 0.5, 0.0], l1),
            row(Revolute, [0.3, PI, 0.0, 0.0], l2),
            row(Prismatic, [0.0, 0.0, 0.0, 1.0 / 7.0], l3),
        ])),
        ("RRPR", arm([
            row(Revolute, [0.4, 0.0, 0.5, 0.0], l1),
            row(Revolute, [0.3, PI, 0.0, 0.0], l2),
            row(Prismatic, [0.0, 0.0, 0.0, 0.0], l3),
            row(Revolute, [0.0, 0.0, 0.1, 0.0], l4),
        ])),
        // Skew axes.
        ("3R", arm([
            row(Revolute, [0.1, FRAC_PI_2, 0.4, 0.0], l1),
            row(Revolute, [0.5, -0.3, 0.05, 0.0], l2),
            row(Revolute, [0.3, 0.7, -1.0 / 15.0, 0.2], l3),
        ])),
        ("RPR", arm([
            row(Revolute, [0.1, 0.9, 0.4, 0.0], l1),
            row(Prismatic, [0.2, -0.7, 0.05, 0.3], l2),
            row(Revolute, [0.3, 0.4, -1.0 / 15.0, 0.2], l3),
        ])),
        ("PPR", arm([
            row(Prismatic, [0.1, 0.9, 0.4, 0.4], l1),
            row(Prismatic, [0.2, -0.7, 0.05, 0.3], l2),
            row(Revolute, [0.3, 0.4, -1.0 / 15.0, 0.2], l3),
        ])),
        ("6dof", six_joints()),
    ]
}

/// Four links with full inertia tensors, each made of four point masses.
fn bodies() -> [Link; 4] {
    let body = |k: f64, mass: f64, com: [f64; 3]| {
        let points = [
            [(k + 3.0) / 20.0, -1.0 / 9.0, 1.0 / 7.0],
            [-0.2, (k + 1.0) / 11.0, 1.0 / 13.0],
            [1.0 / 17.0, 1.0 / 6.0, -(k + 2.0) / 14.0],
            [0.125, -1.0 / 12.0, 0.1],
        ];
        Link { mass, com, inertia: of_equal_masses(mass, &points.map(Vector3::from)), ..Link::default() }
    };
    [
        body(1.0, 2.5, [-0.2, 0.05, 1.0 / 30.0]),
        body(2.0, 1.5, [-0.15, -0.04, 1.0 / 12.0]),
        body(3.0, 1.2, [0.1, 1.0 / 15.0, -0.125]),
        body(4.0, 0.8, [-1.0 / 14.0, 1.0 / 16.0, 1.0 / 9.0]),
    ]
}

/// Inertia of `mass`, shared equally among `points`, about their centre.
#[allow(clippy::cast_precision_loss)] // a handful of points
fn of_equal_masses(mass: f64, points: &[Vector3<f64>]) -> Inertia {
    let share = 1.0 / points.len() as f64;
    let centre = points.iter().sum::<Vector3<f64>>() * share;
    tensor(&points.iter().map(|point| (mass * share, point - centre)).collect::<Vec<_>>())
}

/// Inertia of point masses about the origin: Σ m (p² 1 - p pᵀ).
pub(crate) fn tensor(masses: &[(f64, Vector3<f64>)]) -> Inertia {
    let sum: Matrix3<f64> =
        masses.iter().map(|(m, p)| *m * (p.norm_squared() * Matrix3::identity() - p * p.transpose())).sum();
    Inertia { xx: sum[(0, 0)], yy: sum[(1, 1)], zz: sum[(2, 2)], xy: sum[(0, 1)], xz: sum[(0, 2)], yz: sum[(1, 2)] }
}

/// Arms, states and loads without any special value, always the same ones.
pub(crate) struct Random(Rng);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Rng::with_seed(seed))
    }

    /// R R P R P R with any geometry and any links.
    pub(crate) fn six_joints(&mut self) -> DynArm {
        arm([Revolute, Revolute, Prismatic, Revolute, Prismatic, Revolute].map(|kind| {
            let parameters = [0.6, 3.0, 0.5, 3.0].map(|largest| self.number(largest));
            let mass = 2.15 + self.number(1.85);
            let com = self.vector(0.3);
            let points: [_; 5] = std::array::from_fn(|_| self.vector(0.35).into());
            row(kind, parameters, Link { mass, com, inertia: of_equal_masses(mass, &points), ..Link::default() })
        }))
    }

    /// Gravity points anywhere.
    pub(crate) fn state(&mut self, dof: usize) -> State {
        let mut joints = || (0..dof).map(|_| self.number(2.0)).collect();
        let (q, qd, qdd) = (joints(), joints(), joints());
        let gravity = self.vector(10.0);
        State { q, qd, qdd, gravity, wrench: Wrench { force: self.vector(9.0), moment: self.vector(9.0) } }
    }

    /// Uniform in [-largest, largest).
    fn number(&mut self, largest: f64) -> f64 {
        largest * (2.0 * self.0.f64() - 1.0)
    }

    fn vector(&mut self, largest: f64) -> [f64; 3] {
        std::array::from_fn(|_| self.number(largest))
    }
}
