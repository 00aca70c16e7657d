//! Random arms at random states.

use std::sync::LazyLock;

use fastrand::Rng;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rne::{BaseMotion, Dual, Payload, Wrench};
use rne_codegen::Form;
use rne_model::{Inertia, Motor, Robot};

use crate::arm::{Arm, Given, Maker, STEP, base_rotation};
use crate::check::Worst;
use crate::robots;

const TOLERANCE: f64 = 1e-11;

/// An arm at a state.
pub(crate) struct Case {
    pub(crate) robot: Robot,
    pub(crate) arm: Arm,
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) applied: Vec<f64>,
    pub(crate) wrench: Wrench<f64>,
    pub(crate) payload: Payload<f64>,
    pub(crate) base: BaseMotion<f64>,
}

static OF_THE_RUNTIME: LazyLock<Vec<Case>> =
    LazyLock::new(|| (0..300).map(|seed| case(seed, Maker::Runtime)).collect());
static OF_SEVEN_STEPS: LazyLock<Vec<Case>> = LazyLock::new(|| compiled(Form::SevenSteps));
static OF_THE_REDUCED_FORM: LazyLock<Vec<Case>> = LazyLock::new(|| compiled(Form::Reduced));

/// As many robots as can be compiled in some seconds, from all over the seeds.
fn compiled(form: Form) -> Vec<Case> {
    let one_in = if shipped::is_exhaustive() { 17 } else { 37 };
    (0..300).step_by(one_in).map(|seed| case(seed, Maker::Code(form))).collect()
}

/// Random robots with 1 to 8 joints, half of them with a base that stands anywhere in the world, some joints with
/// motors. What is compiled is so once in all tests.
pub(crate) fn cases(maker: Maker) -> &'static [Case] {
    match maker {
        Maker::Runtime => &OF_THE_RUNTIME,
        Maker::Code(Form::SevenSteps) => &OF_SEVEN_STEPS,
        Maker::Code(_) => &OF_THE_REDUCED_FORM,
    }
}

fn case(seed: u64, maker: Maker) -> Case {
    let mut rng = Rng::with_seed(seed);
    let dof = rng.usize(1..=8);
    let mut yaml = robots::yaml(seed, dof);
    if seed.is_multiple_of(2) {
        yaml = yaml.replace("joints:", "base: {xyz: [0.3, -0.7, 1.1], rpy: [0.4, -1.2, 2.5]}\njoints:");
    }
    let mut robot = Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"));
    let mut array = |scale: f64| -> Vec<f64> { (0..dof).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect() };
    let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
    let applied = array(20.0);
    for (joint, x) in robot.joints.iter_mut().zip(array(1.0)) {
        let motor = Motor { inertia: 1e-4 * x, gear_ratio: 100.0 - 300.0 * x, viscous: 1e-3, coulomb: [0.3 * x, -x] };
        joint.motor = (x > 0.0).then_some(motor);
    }
    let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
    let wrench = Wrench { force: triple(), moment: triple() };
    let [omega, omega_dot, velocity, acceleration, gravity] = [(); 5].map(|()| triple());
    let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity };
    let payload = payload(&mut rng);
    Case { arm: Arm::new(&robot, maker), robot, q, qd, qdd, applied, wrench, payload, base }
}

/// Any payload of a robot: up to 5 kg, half a metre from the tip, with moments of inertia above zero about any axis.
pub(crate) fn payload(rng: &mut Rng) -> Payload<f64> {
    let mut any = |range: f64| (2.0 * rng.f64() - 1.0) * range;
    let (mass, com) = (2.5 + any(2.5), [any(0.5), any(0.5), any(0.5)]);
    let [xx, yy, zz] = [0.3 + any(0.1), 0.3 + any(0.1), 0.3 + any(0.1)];
    Payload { mass, com, inertia: Inertia { xx, yy, zz, xy: any(0.1), xz: any(0.1), yz: any(0.1) } }
}

/// A function of all cases of every maker, which reports its errors.
#[track_caller]
pub(crate) fn holds(of: &str, property: impl Fn(&Case, &mut Worst)) {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for case in cases(maker) {
            property(case, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("{of}, {maker}"));
    }
}

impl Case {
    /// All that a function can be asked with.
    pub(crate) fn given(&self) -> Given<'_, f64> {
        let Self { q, qd, qdd, applied, wrench, payload, base, .. } = self;
        Given {
            q,
            qd,
            qdd,
            tau: applied,
            wrench: *wrench,
            payload: *payload,
            base: *base,
            base_rotation: base_rotation(),
            step: STEP,
        }
    }

    pub(crate) fn tau(&self) -> Vec<f64> {
        self.arm.inverse_dynamics(&self.q, &self.qd, &self.qdd)
    }

    pub(crate) fn mass(&self) -> Vec<Vec<f64>> {
        self.arm.mass_matrix(&self.q)
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

    /// Whether every link is a body: a first moment without mass may make a mass matrix indefinite.
    pub(crate) fn is_of_bodies(&self) -> bool {
        self.robot.rows().all(|row| !row.link.has_first_moment())
    }

    /// m, m c, J about the link frame's origin, from the table.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        let of_row = |row: &rne_model::Row| {
            let (m, c, i) = (row.link.mass, row.link.com, row.link.inertia);
            // J = I + m (c·c 1 - c cᵀ)
            let c = Vector3::from(c);
            let shift = (Matrix3::identity() * c.dot(&c) - c * c.transpose()) * m;
            let j = Matrix3::from(i.rows()) + shift;
            // without mass c is the origin
            let h = c * m + Vector3::from(row.link.first_moment);
            [m, h.x, h.y, h.z, j.m11, j.m12, j.m13, j.m22, j.m23, j.m33]
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
