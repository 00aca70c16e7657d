//! A payload: the rigid body that the link with the tip carries beyond what a robot file has. It is the last link of a
//! serial arm.
//!
//! Its ten inertial parameters φ = (m, m c, J), about the origin of the tip frame and in its axes, add S T φ to the
//! base parameters θ of the file, where S has the columns of the regrouping that belong to this link, and T moves φ to
//! the frame of the link. With the normal matrix N and the right-hand side b of the log,
//!
//! ```text
//! G = Aᵀ N A    g = Aᵀ (b - N θ)    A = [S T  E]    (G + P) x = g + P x₀    covariance = (G + P)⁻¹
//! ```
//!
//! E are the columns of friction and offsets. The file keeps them; here they are errors of the file with a deviation of
//! their own in P, so that they do not pass for a payload. P also contains weak prior knowledge of the payload: its
//! centre of mass lies about 0.1 m from the tip, and its inertia is about as large as its mass times 0.1 m
//! squared. Numbers that the log does not determine keep these values, and do not spoil the mass.
//!
//! Deviations are those of least squares or, if larger, those by leaving out one segment of time after the other
//! (jackknife: B. Efron, C. Stein, Ann. Stat. 9, 1981), and they contain the error of the model.

mod equations;

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};
use rne_convert::robot_file;
use rne_logs::Motion;
use rne_model::{FrictionTransition, Inertia, InertiaReference, Robot, Transform, one_line};
use rne_runtime::{DynArm, Quaternion};

use self::equations::{Equations, Estimate, Numbers, jackknife};
use crate::fit::fitted_model::FittedModel;
use crate::fit::identification::{UNKNOWN, link, over_logs};
use crate::fit::information::MotionError;
use crate::fit::pseudo_inertia;
use crate::fit::stretches::Stretches;
use crate::fit::structure::{Options, Structure};
use rne_model::PER_LINK;

/// m: the distance of a payload's centre of mass from the tip, one deviation, and its radius of gyration.
pub const PAYLOAD_REACH: f64 = 0.1;

/// kg: from this mass on, first moments and inertia may be as large as `PAYLOAD_REACH` allows.
pub const LIGHTEST_PAYLOAD: f64 = 0.05;

/// The least Coulomb friction of a joint, as a part of its effort.
pub const LEAST_FRICTION: f64 = 0.02;

/// rad/s or m/s: a slower joint does not determine viscous friction.
pub const SLOWEST: f64 = 1e-3;

/// s: no torque lags more.
const LONGEST_DELAY: f64 = 0.05;

/// kg: the error of the model as a mass at the last link; for an arm lighter than [`LIGHT_ARM`] in proportion to its
/// mass.
const MODEL_ERROR: f64 = 0.05;

/// kg: for a lighter arm, the smallest payload and the error of the model are in proportion to the mass of the arm.
pub const LIGHT_ARM: f64 = 4.0;

/// A mass of this part of the arm's mass is small.
const SMALL: f64 = 0.1;

/// A mass counts as a payload if it is larger than this many deviations.
const DEVIATIONS: f64 = 2.0;

/// A number of a payload.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadNumber {
    /// The estimate; near the prior knowledge if it is not excited.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Whether the log determines it.
    pub is_excited: bool,
}

/// The rigid body at the link with the tip that a robot file does not have, with standard deviations.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Payload {
    /// kg; negative if the log shows less mass than the file has.
    pub mass: PayloadNumber,
    /// Centre of mass from the origin of the tip frame, in its axes, m.
    pub com: [PayloadNumber; 3],
    /// Inertia about the centre of mass in tip axes, kg m²: xx, yy, zz, xy, xz, yz.
    pub inertia: [PayloadNumber; 6],
    /// Time by which the torques lag behind the positions, s.
    pub delay: f64,
    /// Rows of each joint.
    pub rows: u64,
}

impl Payload {
    /// The numbers of the inertia, in the order of [`inertia`](Self::inertia).
    pub const INERTIA: [&str; 6] = ["Jxx", "Jyy", "Jzz", "Jxy", "Jxz", "Jyz"];

    /// Estimates the payload. `pass` hands every motion of the logs to what it is given, each time it is called. The
    /// cut-off of the low-pass is in Hz.
    ///
    /// # Errors
    /// When a motion is of another robot; when all of them make fewer rows than deviations need, or have no efforts; or
    /// what `pass` fails with.
    pub fn identify<E: From<MotionError>>(
        robot: &Robot,
        cutoff: f64,
        mut pass: impl FnMut(&mut dyn FnMut(&Motion) -> Result<(), MotionError>) -> Result<(), E>,
    ) -> Result<Self, E> {
        let structure = Structure::new(robot, options(robot, cutoff));
        let fit = over_logs(&structure, true, &mut pass)?.least_squares;
        let transitions = transitions(&structure, &fit.transitions);
        let delay = if fit.delay.abs() < LONGEST_DELAY { fit.delay } else { 0.0 };
        let model = FittedModel { noise: fit.noise, delay, ..FittedModel::of_file(&structure, &transitions) };
        let mut stretches = Stretches::new(&structure, &model);
        // the number of a run only separates stretches
        let mut run = 0;
        pass(&mut |motion| {
            run += 1;
            stretches.absorb(&structure, run, motion)
        })?;
        let equations = Equations::new(&structure, &model, &stretches);
        let all = equations.estimate(None);
        let parts = (0..equations.parts.len()).map(|part| equations.estimate(Some(part)).numbers);
        let jackknife = jackknife(&parts.collect::<Vec<_>>());
        let moment = equations.moment_error(robot);
        let found = Self::of(robot, &all, &jackknife, moment);
        Ok(Self { delay, rows: stretches.rows(), ..found })
    }

    /// The payload of an estimate; `moment` is the error of the model as a first moment and inertia, kg m and
    /// kg m².
    fn of(robot: &Robot, all: &Estimate, jackknife: &Numbers, moment: f64) -> Self {
        let arm: f64 = robot.joints.iter().map(|joint| joint.row.link.mass).sum();
        let error = if arm > 0.0 { MODEL_ERROR * (arm / LIGHT_ARM).min(1.0) } else { MODEL_ERROR };
        let mass = all.numbers[0];
        let size = mass.abs().max(LIGHTEST_PAYLOAD);
        let deviation = |at: usize, error: f64| all.variances[at].max(jackknife[at]).sqrt().hypot(error);
        let of_mass = deviation(0, error);
        let is_known = of_mass < UNKNOWN * mass.abs().max(SMALL * arm);
        let is_there = is_known && mass.abs() > DEVIATIONS * of_mass;
        let number = |at: usize, error: f64, scale: f64| {
            let (value, deviation) = (all.numbers[at], deviation(at, error));
            // no body has a moment of inertia below 0
            let is_possible = !(4..7).contains(&at) || value > 0.0 || mass < 0.0;
            let is_excited = is_there && is_possible && deviation < UNKNOWN * scale.max(value.abs());
            PayloadNumber { value, deviation, is_excited }
        };
        Self {
            mass: PayloadNumber { value: mass, deviation: of_mass, is_excited: is_known },
            com: std::array::from_fn(|axis| number(1 + axis, moment.max(PAYLOAD_REACH * error) / size, PAYLOAD_REACH)),
            inertia: std::array::from_fn(|at| {
                number(4 + at, moment.max(PAYLOAD_REACH * PAYLOAD_REACH * error), PAYLOAD_REACH * PAYLOAD_REACH * size)
            }),
            delay: 0.0,
            rows: 0,
        }
    }

    /// Whether the log shows a payload: a mass that differs from 0 by more than two deviations.
    #[must_use]
    pub fn is_there(&self) -> bool {
        self.mass.is_excited && self.mass.value.abs() > DEVIATIONS * self.mass.deviation
    }

    /// The payload as an argument of functions, which is the one that [`added_to`](Self::added_to) adds. The inertia is
    /// that of a body: products and moments that the log does not determine are made so that they are possible.
    #[must_use]
    pub fn body(&self) -> rne_runtime::Payload<f64> {
        let mass = self.mass.value;
        let [xx, yy, zz, xy, xz, yz] = self.inertia.map(|number| number.value);
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        // less than no mass has the inertia of a point
        let tensor = if mass > 0.0 { of_body(&tensor) } else { Matrix3::zeros() };
        let j = |row, column| tensor[(row, column)];
        let inertia = Inertia { xx: j(0, 0), yy: j(1, 1), zz: j(2, 2), xy: j(0, 1), xz: j(0, 2), yz: j(1, 2) };
        rne_runtime::Payload { mass, com: self.com.map(|number| number.value), inertia }
    }

    /// The ten inertial parameters about the origin of the tip frame, in its axes.
    #[must_use]
    pub fn parameters(&self) -> [f64; PER_LINK] {
        let rne_runtime::Payload { mass, com, inertia } = self.body();
        let com = Vector3::from(com);
        let about = Matrix3::from(inertia.rows()) + shifted(mass, &com);
        let h = com * mass;
        let j = |row, column| about[(row, column)];
        [mass, h.x, h.y, h.z, j(0, 0), j(0, 1), j(0, 2), j(1, 1), j(1, 2), j(2, 2)]
    }

    /// The robot with the payload added to its link with the tip; `None` if this link would not have a positive mass.
    #[must_use]
    pub fn added_to(&self, robot: &Robot) -> Option<Robot> {
        let mut robot = robot.clone();
        let on = robot.tip().on?;
        let mut sum = *DynArm::from_robot(&robot).inertial_parameters().get(on)?;
        let of_link = of_tip(&robot) * DVector::from(self.parameters().to_vec());
        sum.iter_mut().zip(&of_link).for_each(|(sum, of)| *sum += of);
        let joint = robot.joints.get_mut(on)?;
        if sum[0] <= 0.0 {
            return None;
        }
        joint.row.link = link(&pseudo_inertia::of(&sum));
        joint.written_inertia = (joint.row.link.inertia, InertiaReference::Com);
        Some(robot)
    }

    /// The text of a robot file of `robot`, to which the payload was added or not; `logs` says in words from what the
    /// payload was identified.
    #[must_use]
    pub fn robot_file(&self, robot: &Robot, is_added: bool, logs: &str) -> String {
        let mut robot = robot.clone();
        let PayloadNumber { value, deviation, .. } = self.mass;
        let on = robot.tip().on.and_then(|on| robot.joints.get(on));
        let on = on.map(|joint| one_line(&joint.name)).unwrap_or_default();
        let does = if is_added { "added to" } else { "not added to" };
        let logs = one_line(logs);
        let note =
            format!("- payload: {value:.3} ± {deviation:.3} kg, {does} the link of {on}; identified from {logs}");
        robot.notes = Some(match &robot.notes {
            Some(notes) => format!("{}\n{note}", notes.trim_end()),
            None => note,
        });
        format!("# Identified payload, from {} rows of each joint.\n{}", self.rows, robot_file::write(&robot))
    }
}

/// The matrix T from inertial parameters about the origin of the tip frame, in its axes, to those in the frame of the
/// link that carries it: with R and t of the tip, m, R h + m t, and R J Rᵀ + 2 (R h · t) 1 - R h tᵀ - t (R h)ᵀ + m (t²
/// 1
/// - t tᵀ).
fn of_tip(robot: &Robot) -> DMatrix<f64> {
    let Transform { xyz, rpy } = robot.tip().placement;
    let [roll, pitch, yaw] = rpy.map(|angle| angle.radians);
    let turn = [[0.0, 0.0, yaw], [0.0, pitch, 0.0], [roll, 0.0, 0.0]];
    let turn = turn.into_iter().fold(Quaternion::identity(), |turn, angle| turn.turned_by(angle));
    let (rotation, translation) = (Matrix3::from(turn.rotation()).transpose(), Vector3::from(xyz));
    let mut moved = DMatrix::zeros(PER_LINK, PER_LINK);
    for column in 0..PER_LINK {
        let unit = |at: usize| if at == column { 1.0 } else { 0.0 };
        let (mass, h) = (unit(0), rotation * Vector3::new(unit(1), unit(2), unit(3)));
        let mut tensor = Matrix3::zeros();
        for (number, (row, column)) in TENSOR.into_iter().enumerate() {
            (tensor[(row, column)], tensor[(column, row)]) = (unit(4 + number), unit(4 + number));
        }
        let products = h * translation.transpose();
        let tensor = rotation * tensor * rotation.transpose() + Matrix3::identity() * (2.0 * h.dot(&translation))
            - products
            - products.transpose()
            + shifted(mass, &translation);
        let h = h + translation * mass;
        let numbers = [mass, h.x, h.y, h.z].into_iter().chain(TENSOR.map(|place| tensor[place]));
        numbers.enumerate().for_each(|(row, number)| moved[(row, column)] = number);
    }
    moved
}

/// Options with the transitions of the file's friction.
fn options(robot: &Robot, cutoff: f64) -> Options {
    let mut options =
        Options { cutoff: Some(cutoff), widths: Vec::new(), displacements: Vec::new(), ..Options::default() };
    for joint in robot.independent_joints() {
        let (list, value) = match FrictionTransition::of(joint) {
            FrictionTransition::Speed(width) => (&mut options.widths, width),
            FrictionTransition::Displacement(length) => (&mut options.displacements, length),
        };
        if !list.contains(&value) {
            list.push(value);
        }
    }
    options
}

/// The transition of each joint's friction in the file, as an index.
fn transitions(structure: &Structure, fitted: &[usize]) -> Vec<usize> {
    let all = structure.options().transitions();
    let of_file = |joint| all.iter().position(|transition| *transition == FrictionTransition::of(joint));
    let joints = structure.robot().independent_joints().zip(fitted);
    joints.map(|(joint, fitted)| of_file(joint).unwrap_or(*fitted)).collect()
}

/// Places of the inertial parameters from the fifth on in the tensor of inertia.
const TENSOR: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// The inertia of a point mass about the origin.
fn shifted(mass: f64, com: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * com.norm_squared() - com * com.transpose()) * mass
}

/// The nearest inertia of a body: its mass has no negative second moment in any direction.
fn of_body(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let second = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
    let mut axes = SymmetricEigen::new(second);
    axes.eigenvalues.apply(|moment| *moment = moment.max(0.0));
    let second = axes.recompose();
    Matrix3::identity() * second.trace() - second
}
