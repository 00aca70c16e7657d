//! Why is my torque different? Two tools that disagree have, as a rule, made one of the same few slips: the rows read
//! in the other convention, gravity upwards, an inertia about another point, degrees.
//!
//! Where a computation by hand goes wrong, [`worksheet`] says line by line.
//!
//! [`diagnose`] makes every one of them, one [`Typo`] at a time, then every pair, and names those that give the
//! numbers in question. Numbers in, data out: nothing here opens a file or prints.
//!
//! ```
//! use rne_diagnose::{Diagnosis, Observation, Slip, diagnose};
//!
//! let file = rne_robots::find("planar2").expect("it is shipped");
//! let robot = rne_model::Robot::from_yaml(file.yaml)?;
//! // from a tool that has gravity upwards
//! let (q, qd, qdd) = (vec![0.3, 0.5], vec![1.0, 2.0], vec![0.5, -1.0]);
//! let (tau, resolution) = (vec![-14.1097, -1.95268], vec![5e-5, 5e-6]);
//! let seen = Observation { q, qd, qdd, wrench: None, tau, resolution };
//! let Diagnosis::Explained(explanations) = diagnose(&robot, &[seen])? else { panic!("there is a slip") };
//! assert_eq!(explanations[0].slips, [Slip::GravityReversed]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod computation;
pub mod lecture;
mod links;
mod misprint;
mod observation;
mod order;
mod slip;
mod typo;
mod wording;
pub mod worksheet;

use rne_model::Robot;
use rne_runtime::{DynArm, WrongLength};

use crate::computation::Computation;
pub use crate::observation::{COARSEST, Observation};
pub use crate::slip::Slip;
pub use crate::typo::Typo;

/// The diagnosis of given torques.
#[derive(Clone, Debug, PartialEq)]
pub enum Diagnosis {
    /// They are right: the largest difference, in parts of the largest torque.
    Agrees(f64),
    /// These slips give them, the likeliest first; each explanation has as few slips as there must be.
    Explained(Vec<Explanation>),
    /// None of the slips does, nor does any pair to [`COARSEST`] of the largest torque: how far the torques are off, in
    /// parts of the largest.
    Unexplained(f64),
}

/// Slips that, made together, give the torques in question.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// One, or two.
    pub slips: Vec<Slip>,
    /// The largest difference that is left, in parts of the largest torque.
    pub error: f64,
}

/// Looks for the slips that explain the torques of some states, all of them at once: the more states, the surer.
///
/// # Errors
/// When a list of an observation does not have one number per joint.
pub fn diagnose(robot: &Robot, seen: &[Observation]) -> Result<Diagnosis, WrongLength> {
    let right = Tried::of(robot, seen, &[])?;
    if let Some(Tried { error, fits: true }) = right {
        return Ok(Diagnosis::Agrees(error));
    }
    let slips = Slip::candidates(robot);
    let explains = |seen: &[Observation], slips: &[Slip]| -> Result<Option<Explanation>, WrongLength> {
        let tried = Tried::of(robot, seen, slips)?.filter(|tried| tried.fits);
        Ok(tried.map(|Tried { error, .. }| Explanation { slips: slips.to_vec(), error }))
    };
    let found = one_by_one(robot)
        .into_iter()
        .filter_map(|slip| explains(seen, &[slip]).transpose())
        .collect::<Result<Vec<_>, _>>()?;
    if !found.is_empty() {
        return Ok(Diagnosis::Explained(found));
    }
    // some of so many pairs give torques of few digits by accident
    let seen: Vec<Observation> = seen.iter().map(Observation::to_enough_digits).collect();
    // of two that fit together neither is idle: the other would have fitted alone
    let pairs = slips.iter().enumerate().flat_map(|(index, &first)| {
        slips.iter().skip(index + 1).filter(move |second| first.goes_with(**second)).map(move |&second| [first, second])
    });
    let found = pairs.filter_map(|pair| explains(&seen, &pair).transpose()).collect::<Result<Vec<_>, _>>()?;
    let off = right.map_or(f64::NAN, |right| right.error);
    Ok(if found.is_empty() { Diagnosis::Unexplained(off) } else { Diagnosis::Explained(found) })
}

/// Looks for one slip that explains the torques only nearly, where [`diagnose`] explains them with all of their digits
/// by none: the angles of one of both programs may be rounded. The tolerance grows until the torques are right, or a
/// slip gives them; returns this tolerance and the diagnosis, or `None` where nothing explains the torques.
///
/// `tolerances` are parts of the largest torque, in ascending order. Pairs of slips are not tried, because some of so
/// many pairs give almost any torques nearly.
///
/// # Errors
/// When a list of an observation does not have one number per joint.
pub fn diagnose_nearly(
    robot: &Robot,
    seen: &[Observation],
    tolerances: &[f64],
) -> Result<Option<(f64, Diagnosis)>, WrongLength> {
    let right = Tried::of(robot, seen, &[])?.map_or(f64::INFINITY, |right| right.error);
    let mut tried = Vec::new();
    for slip in one_by_one(robot) {
        if let Some(Tried { error, .. }) = Tried::of(robot, seen, &[slip])? {
            tried.push(Explanation { slips: vec![slip], error });
        }
    }
    let nearest = tried.iter().map(|explanation| explanation.error).fold(f64::INFINITY, f64::min);
    let Some(&tolerance) = tolerances.iter().find(|tolerance| right.min(nearest) <= **tolerance) else {
        return Ok(None);
    };
    if right <= tolerance {
        return Ok(Some((tolerance, Diagnosis::Agrees(right))));
    }
    // what explains the torques far less well than the best explanation does is a coincidence
    tried.retain(|explanation| explanation.error <= tolerance.min(3.0 * nearest));
    Ok(Some((tolerance, Diagnosis::Explained(tried))))
}

/// The slips that are made one at a time, the likeliest first.
fn one_by_one(robot: &Robot) -> Vec<Slip> {
    let typos = Typo::candidates(robot).into_iter().map(Slip::Typo);
    Slip::candidates(robot).into_iter().chain(Slip::alone(robot)).chain(typos).collect()
}

/// The torques of a computation that makes some slips, at the state of `at`, whose own torques do not count; `None`
/// where they cannot be made: the lecture's formulas are of standard tables of serial arms.
///
/// # Errors
/// When a list of `at` does not have one number per joint.
pub fn torques_with(robot: &Robot, slips: &[Slip], at: &Observation) -> Result<Option<Vec<f64>>, WrongLength> {
    let Some(computation) = Computation::with(robot, slips) else { return Ok(None) };
    computation.torques(&DynArm::from_robot(&computation.robot), at).map(Some)
}

/// The result of trying some slips.
struct Tried {
    /// Whether the torques are the torques that were seen.
    fits: bool,
    error: f64,
}

impl Tried {
    fn of(robot: &Robot, seen: &[Observation], slips: &[Slip]) -> Result<Option<Self>, WrongLength> {
        let Some(computation) = Computation::with(robot, slips) else { return Ok(None) };
        let arm = DynArm::from_robot(&computation.robot);
        let torques =
            seen.iter().map(|at| computation.torques(&arm, at)).collect::<Result<Vec<Vec<f64>>, WrongLength>>()?;
        let fits = seen.iter().zip(&torques).all(|(at, tau)| at.shows(tau));
        let error = seen.iter().zip(&torques).map(|(at, tau)| at.error(tau)).fold(0.0, f64::max);
        Ok(Some(Self { fits, error }))
    }
}
