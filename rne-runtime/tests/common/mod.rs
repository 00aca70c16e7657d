//! The arms of the specification's acceptance tests, section 5, and how numbers are compared.

use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::{Angle, Convention, Dh, Inertia, JointKind, Link, Model, Row, Transform};
use rne_runtime::{BaseMotion, Wrench};

/// a, α, b, θ.
pub(crate) fn dh([a, alpha, b, theta]: [f64; 4]) -> Dh {
    Dh { theta: Angle::new(theta), d: b, a, alpha: Angle::new(alpha) }
}

/// Mass, centre of mass, and Ixx Iyy Izz Ixy Ixz Iyz about it.
pub(crate) fn link(mass: f64, com: [f64; 3], [xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Link {
    Link { mass, com, inertia: Inertia { xx, yy, zz, xy, xz, yz }, ..Link::default() }
}

pub(crate) fn row(kind: JointKind, parameters: [f64; 4], link: Link) -> Row {
    Row { kind, dh: dh(parameters), link }
}

pub(crate) fn model<const DOF: usize>(convention: Convention, gravity: [f64; 3], rows: [Row; DOF]) -> Model<DOF> {
    Model { convention, gravity, base: Transform::IDENTITY, tool: Transform::IDENTITY, rows }
}

/// A uniform thin rod along x whose centre stands at `com_x`.
pub(crate) fn rod(mass: f64, length: f64, com_x: f64) -> Link {
    let i = mass * length * length / 12.0;
    link(mass, [com_x, 0.0, 0.0], [0.0, i, i, 0.0, 0.0, 0.0])
}

/// 5.1
pub(crate) fn one_link() -> Model<1> {
    let a = 0.8;
    model(Convention::Standard, [9.81, 0.0, 0.0], [row(Revolute, [a, 0.0, 0.0, 0.0], rod(2.5, a, -a / 2.0))])
}

pub(crate) const TWO_LINK_LENGTHS: [f64; 2] = [0.8, 0.6];
pub(crate) const TWO_LINK_MASSES: [f64; 2] = [2.5, 1.5];

/// 5.2
pub(crate) fn two_links(convention: Convention, gravity: [f64; 3]) -> Model<2> {
    let ([a1, a2], [m1, m2]) = (TWO_LINK_LENGTHS, TWO_LINK_MASSES);
    let rows = match convention {
        Convention::Standard => [
            row(Revolute, [a1, 0.0, 0.0, 0.0], rod(m1, a1, -a1 / 2.0)),
            row(Revolute, [a2, 0.0, 0.0, 0.0], rod(m2, a2, -a2 / 2.0)),
        ],
        Convention::Modified => [
            row(Revolute, [0.0, 0.0, 0.0, 0.0], rod(m1, a1, a1 / 2.0)),
            row(Revolute, [a1, 0.0, 0.0, 0.0], rod(m2, a2, a2 / 2.0)),
        ],
    };
    model(convention, gravity, rows)
}

/// 5.3
pub(crate) fn revolute_prismatic() -> Model<2> {
    let rows = [
        row(
            Revolute,
            [0.0, std::f64::consts::FRAC_PI_2, 0.0, 0.0],
            link(2.5, [0.0, 0.0, 0.3], [0.0, 0.12, 0.0, 0.0, 0.0, 0.0]),
        ),
        row(Prismatic, [0.0; 4], link(1.5, [0.0; 3], [0.0, 0.05, 0.0, 0.0, 0.0, 0.0])),
    ];
    model(Convention::Standard, [0.0, -9.81, 0.0], rows)
}

/// 5.4
pub(crate) fn prismatic_revolute() -> Model<2> {
    let rows = [
        row(Prismatic, [0.0, std::f64::consts::FRAC_PI_2, 0.0, 0.0], link(2.5, [0.0; 3], [0.0; 6])),
        row(Revolute, [0.6, 0.0, 0.0, 0.0], link(1.5, [-0.3, 0.0, 0.0], [0.0, 0.0, 0.05, 0.0, 0.0, 0.0])),
    ];
    model(Convention::Standard, [0.0, 0.0, -9.81], rows)
}

/// 5.5: skew axes, full inertias, both joint kinds.
#[rustfmt::skip]
pub(crate) fn six_joints(convention: Convention) -> Model<6> {
    let rows = [
        row(Revolute,  [0.10, 0.9, 0.40, 0.0],   link(4.0, [-0.05, 0.02, 0.03], [0.050, 0.060, 0.040, 0.004, -0.003, 0.002])),
        row(Revolute,  [0.45, -0.3, 0.05, 0.2],  link(3.0, [-0.20, 0.01, 0.04], [0.020, 0.070, 0.065, -0.002, 0.001, 0.003])),
        row(Prismatic, [0.20, 0.7, 0.15, -0.4],  link(2.0, [0.03, -0.06, 0.02], [0.030, 0.025, 0.015, 0.001, 0.002, -0.001])),
        row(Revolute,  [-0.05, 1.3, 0.30, 0.1],  link(1.5, [0.02, 0.03, -0.05], [0.012, 0.010, 0.008, -0.001, 0.0005, 0.0007])),
        row(Prismatic, [0.08, -1.1, 0.10, 0.6],  link(1.0, [-0.03, 0.01, 0.02], [0.006, 0.005, 0.004, 0.0003, -0.0002, 0.0004])),
        row(Revolute,  [0.12, 0.5, -0.07, -0.3], link(0.5, [0.01, -0.02, 0.06], [0.0020, 0.0018, 0.0009, 0.0001, 0.0002, -0.0001])),
    ];
    model(convention, [0.0, 0.0, -9.81], rows)
}

pub(crate) const SIX_Q: [f64; 6] = [0.3, -0.8, 0.25, 1.1, 0.15, -0.6];
pub(crate) const SIX_QD: [f64; 6] = [0.9, -0.5, 0.4, 1.2, -0.3, 0.7];
pub(crate) const SIX_QDD: [f64; 6] = [-1.1, 0.6, 0.8, -0.9, 1.4, 0.35];
pub(crate) const SIX_WRENCH: Wrench<f64> = Wrench { force: [2.0, -1.5, 4.0], moment: [0.3, 0.7, -0.2] };
pub(crate) const SIX_BASE: BaseMotion<f64> = BaseMotion {
    omega: [0.2, -0.1, 0.3],
    omega_dot: [0.5, 0.4, -0.6],
    velocity: [0.1, 0.2, -0.3],
    acceleration: [0.7, -0.2, 0.1],
    gravity: [0.0, 0.0, -9.81],
};

/// Largest difference, relative to the largest element of `expected`.
pub(crate) fn relative_error(actual: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(actual.len(), expected.len());
    let largest = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let worst = actual.iter().zip(expected).fold(0.0_f64, |m, (a, e)| {
        assert!(a.is_finite() && e.is_finite(), "{actual:?} {expected:?}");
        m.max((a - e).abs())
    });
    if largest == 0.0 { worst } else { worst / largest }
}

/// The specification's tolerance.
#[track_caller]
pub(crate) fn assert_close(what: &str, actual: &[f64], expected: &[f64]) {
    let error = relative_error(actual, expected);
    assert!(error <= 1e-13, "{what}: relative error {error:e}\n  actual   {actual:?}\n  expected {expected:?}");
}

/// Reproducible numbers for random states (a linear congruential generator).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [-1, 1).
    #[allow(clippy::cast_precision_loss)] // 53 bits
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Uniform in [-largest, largest).
    pub(crate) fn array<const N: usize>(&mut self, largest: f64) -> [f64; N] {
        std::array::from_fn(|_| largest * self.next())
    }
}

/// An orthonormal tool transform with no special angle.
pub(crate) fn tool() -> Transform {
    Transform { xyz: [0.11, -0.07, 0.23], rpy: [Angle::new(0.4), Angle::new(-0.9), Angle::new(1.7)] }
}
