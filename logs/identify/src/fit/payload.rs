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
//! E are the columns of friction and offsets. The file's values are not changed; E stands for their errors, whose
//! standard deviations are in P, so that they are not taken for a payload. P also contains weak prior knowledge of the
//! payload: its centre of mass lies about 0.1 m from the tip, and its inertia is about as large as its mass times 0.1 m
//! squared. Numbers that the log does not determine keep these values, and do not distort the mass.
//!
//! Standard deviations are those of least squares or, if larger, those by leaving out one segment of time after the
//! other (jackknife: B. Efron, C. Stein, Ann. Stat. 9, 1981), and they include the error of the model.

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

/// Standard deviation of the distance of a payload's centre of mass from the tip, and its radius of gyration, m.
pub const PAYLOAD_REACH: f64 = 0.1;

/// Mass, kg, from which the prior of first moments and inertia is proportional to the mass; lighter payloads have the
/// prior of this mass.
pub const LIGHTEST_PAYLOAD: f64 = 0.05;

/// Smallest Coulomb friction that is assumed for a joint, as a part of its effort.
pub const LEAST_FRICTION: f64 = 0.02;

/// Speed, rad/s or m/s, below which a joint does not determine viscous friction.
pub const SLOWEST: f64 = 1e-3;

/// Longest time by which torques may lag, s.
const LONGEST_DELAY: f64 = 0.05;

/// The error of the model as a mass at the last link, kg. For an arm lighter than [`LIGHT_ARM`], it is reduced in
/// proportion to the mass of the arm.
const MODEL_ERROR: f64 = 0.05;

/// Mass of an arm, kg, below which the smallest payload and the error of the model are proportional to the mass.
pub const LIGHT_ARM: f64 = 4.0;

/// Part of the arm's mass below which a payload's mass is small.
const SMALL: f64 = 0.1;

/// A mass counts as a payload if it is larger than this many standard deviations.
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
    /// Mass, kg; negative if the log shows less mass than the file has.
    pub mass: PayloadNumber,
    /// Centre of mass from the origin of the tip frame, in its axes, m.
    pub com: [PayloadNumber; 3],
    /// Inertia about the centre of mass in tip axes, kg m²: xx, yy, zz, xy, xz, yz.
    pub inertia: [PayloadNumber; 6],
    /// Time by which the torques lag behind the positions, s.
    pub delay: f64,
    /// Number of rows of each joint.
    pub rows: u64,
}

impl Payload {
    /// The names of the moments and products, in the order of [`inertia`](Self::inertia).
    pub const INERTIA: [&str; 6] = ["Jxx", "Jyy", "Jzz", "Jxy", "Jxz", "Jyz"];

    /// Estimates the payload. `pass` is called several times and passes every motion of the logs to its argument each
    /// time. `cutoff` is the cut-off of the low-pass filter, Hz.
    ///
    /// # Errors
    /// When a motion is of another robot; when all motions give fewer rows than standard deviations need, or have no
    /// efforts; or when `pass` fails.
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
        // a new run number for each motion only keeps stretches of different motions apart
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

    /// Makes the payload from an estimate; `moment` is the error of the model as a first moment, kg m, and as an
    /// inertia, kg m².
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

    /// Returns the payload as functions of an arm take it; [`added_to`](Self::added_to) adds the same one. The inertia
    /// is physically possible: numbers that the log does not determine are changed as needed.
    #[must_use]
    pub fn body(&self) -> rne_runtime::Payload<f64> {
        let mass = self.mass.value;
        let [xx, yy, zz, xy, xz, yz] = self.inertia.map(|number| number.value);
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        // a negative mass gets no inertia about its centre
        let tensor = if mass > 0.0 { of_body(&tensor) } else { Matrix3::zeros() };
        let j = |row, column| tensor[(row, column)];
        let inertia = Inertia { xx: j(0, 0), yy: j(1, 1), zz: j(2, 2), xy: j(0, 1), xz: j(0, 2), yz: j(1, 2) };
        rne_runtime::Payload { mass, com: self.com.map(|number| number.value), inertia }
    }

    /// Returns the ten inertial parameters about the origin of the tip frame, in its axes.
    #[must_use]
    pub fn parameters(&self) -> [f64; PER_LINK] {
        let rne_runtime::Payload { mass, com, inertia } = self.body();
        let com = Vector3::from(com);
        let about = Matrix3::from(inertia.rows()) + shifted(mass, &com);
        let h = com * mass;
        let j = |row, column| about[(row, column)];
        [mass, h.x, h.y, h.z, j(0, 0), j(0, 1), j(0, 2), j(1, 1), j(1, 2), j(2, 2)]
    }

    /// Returns the robot with the payload added to the link with the tip; `None` if the mass of this link would not be
    /// positive.
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

    /// Returns the text of a robot file of `robot`, with notes on the payload. `is_added` says whether the payload is
    /// already part of `robot`; `logs` describes the logs of the identification in words.
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

/// Returns the matrix T from inertial parameters about the origin of the tip frame, in its axes, to those in the frame
/// of the link that carries the tip. With the rotation R and the translation t of the tip, and h = m c, it gives m, R
/// h + m t, and `R J Rᵀ + 2 (R h · t) 1 - R h tᵀ - t (R h)ᵀ + m (t² 1 - t tᵀ)`.
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

/// Returns options of the identification with the transitions of friction in the file.
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

/// Returns the transition of each joint's friction in the file, as an index into the transitions of the options.
fn transitions(structure: &Structure, fitted: &[usize]) -> Vec<usize> {
    let all = structure.options().transitions();
    let of_file = |joint| all.iter().position(|transition| *transition == FrictionTransition::of(joint));
    let joints = structure.robot().independent_joints().zip(fitted);
    joints.map(|(joint, fitted)| of_file(joint).unwrap_or(*fitted)).collect()
}

/// Rows and columns in the inertia tensor of the inertial parameters Jxx, Jxy, Jxz, Jyy, Jyz and Jzz.
const TENSOR: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// Returns the inertia of a point mass at `com` about the origin.
fn shifted(mass: f64, com: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * com.norm_squared() - com * com.transpose()) * mass
}

/// Returns the nearest inertia that is physically possible: its mass has no negative second moment in any direction.
fn of_body(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let second = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
    let mut axes = SymmetricEigen::new(second);
    axes.eigenvalues.apply(|moment| *moment = moment.max(0.0));
    let second = axes.recompose();
    Matrix3::identity() * second.trace() - second
}
