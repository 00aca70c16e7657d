//! Random arms at random states.

use fastrand::Rng;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rne::{Dual, DynArm, Wrench};
use rne_model::Robot;

use crate::check::Worst;
use crate::robots;

const TOLERANCE: f64 = 1e-11;

/// An arm at a state.
pub(crate) struct Case {
    pub(crate) robot: Robot,
    pub(crate) arm: DynArm,
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) wrench: Wrench<f64>,
}

/// Random robots with 1 to 8 joints, half of them with a base that stands anywhere in the world.
pub(crate) fn cases() -> impl Iterator<Item = Case> {
    (0..300_u64).map(|seed| {
        let mut rng = Rng::with_seed(seed);
        let dof = rng.usize(1..=8);
        let mut yaml = robots::yaml(seed, dof);
        if seed % 2 == 0 {
            yaml = yaml.replace("joints:", "base: {xyz: [0.3, -0.7, 1.1], rpy: [0.4, -1.2, 2.5]}\njoints:");
        }
        let robot = Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"));
        let mut array = |scale: f64| -> Vec<f64> { (0..dof).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect() };
        let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        Case { arm: DynArm::from_robot(&robot), robot, q, qd, qdd, wrench }
    })
}

/// A function of all cases, which reports its errors.
#[track_caller]
pub(crate) fn holds(of: &str, property: impl Fn(&Case, &mut Worst)) {
    let mut worst = Worst::default();
    for case in cases() {
        property(&case, &mut worst);
    }
    worst.at_most(TOLERANCE, of);
}

impl Case {
    pub(crate) fn tau(&self) -> Vec<f64> {
        self.arm.inverse_dynamics(&self.q, &self.qd, &self.qdd).expect("one per joint")
    }

    pub(crate) fn mass(&self) -> Vec<Vec<f64>> {
        self.arm.mass_matrix(&self.q).expect("one per joint")
    }

    /// The positions, on their way with the velocities: derivatives are those with respect to time.
    pub(crate) fn moving(&self) -> Vec<Dual<f64>> {
        along(&self.q, &self.qd)
    }

    /// The base's rotation, by nalgebra.
    pub(crate) fn base_rotation(&self) -> Rotation3<f64> {
        let [roll, pitch, yaw] = self.robot.base.rpy.map(|angle| angle.radians);
        Rotation3::from_euler_angles(roll, pitch, yaw)
    }

    /// Gravity in the world: it is given in frame 0.
    pub(crate) fn gravity(&self) -> Vector3<f64> {
        self.base_rotation() * Vector3::from(self.robot.gravity)
    }

    /// m, m c, J about the link frame's origin, from the table.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        let of_row = |row: &rne_model::Row| {
            let (m, c, i) = (row.link.mass, row.link.com, row.link.inertia);
            // J = I + m (c·c 1 - c cᵀ)
            let c = Vector3::from(c);
            let shift = (Matrix3::identity() * c.dot(&c) - c * c.transpose()) * m;
            let j = Matrix3::from(i.rows()) + shift;
            [m, m * c.x, m * c.y, m * c.z, j.m11, j.m12, j.m13, j.m22, j.m23, j.m33]
        };
        self.robot.rows().flat_map(of_row).collect()
    }
}

pub(crate) fn along(x: &[f64], rate: &[f64]) -> Vec<Dual<f64>> {
    x.iter().zip(rate).map(|(&value, &derivative)| Dual { value, derivative }).collect()
}

pub(crate) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

pub(crate) fn transposed(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..rows.len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}

pub(crate) fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}
