//! Explains why two tools compute different torques. Usually, one of them makes one of a few slips: it reads the rows
//! in the other convention, or takes gravity upwards, an inertia about another point, or degrees.
//!
//! The module [`worksheet`] finds the first wrong line of a calculation by hand.
//!
//! [`diagnose`] tries every slip and every [`Typo`] alone, then every pair of slips, and names those that give the
//! torques in question. This crate does not read files and does not print.
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
mod near_miss;
mod observation;
mod order;
mod slip;
mod typo;
mod wording;
pub mod worksheet;

use rne_model::Robot;
use rne_runtime::{DynArm, WrongLength};

use crate::computation::Computation;
pub use crate::links::LinkSlip;
pub use crate::near_miss::{Cause, NearMiss, near_miss};
pub use crate::observation::{COARSEST, Observation};
pub use crate::slip::Slip;
pub use crate::typo::Typo;

/// The diagnosis of given torques.
#[derive(Clone, Debug, PartialEq)]
pub enum Diagnosis {
    /// The torques are right; the number is the largest difference, as a part of the largest torque.
    Agrees(f64),
    /// These slips give the torques, the likeliest first. Each explanation has as few slips as possible.
    Explained(Vec<Explanation>),
    /// No slip gives the torques, nor does any pair of slips within [`COARSEST`] of the largest torque. The number is
    /// the largest difference from the right torques, as a part of the largest torque.
    Unexplained(f64),
}

/// Slips that, made together, give the torques in question.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// One slip, or two.
    pub slips: Vec<Slip>,
    /// The largest remaining difference, as a part of the largest torque.
    pub error: f64,
}

/// The digits of all torques together from which on pairs with a slip of one link are tried. There are thousands of
/// such pairs, which agree with fewer digits by chance.
const DIGITS_FOR_PAIRS: f64 = 10.0;

/// Finds the slips that explain the torques of all given states. More states make the diagnosis more reliable.
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
    // there are so many pairs that some agree with torques of few digits by chance
    let seen: Vec<Observation> = seen.iter().map(Observation::to_enough_digits).collect();
    // both slips of a pair that fits are needed, because no slip fits alone
    let pairs = slips.iter().enumerate().flat_map(|(index, &first)| {
        slips.iter().skip(index + 1).filter(move |second| first.goes_with(**second)).map(move |&second| [first, second])
    });
    let mut found = pairs.filter_map(|pair| explains(&seen, &pair).transpose()).collect::<Result<Vec<_>, _>>()?;
    if found.is_empty() && seen.iter().map(Observation::digits).sum::<f64>() >= DIGITS_FOR_PAIRS {
        let typos = Typo::candidates(robot).into_iter().map(Slip::Typo);
        let pairs = typos.flat_map(|typo| slips.iter().map(move |&slip| [slip, typo]));
        let pairs = pairs.filter(|[slip, typo]| slip.goes_with(*typo));
        found = pairs.filter_map(|pair| explains(&seen, &pair).transpose()).collect::<Result<Vec<_>, _>>()?;
    }
    let off = right.map_or(f64::NAN, |right| right.error);
    Ok(if found.is_empty() { Diagnosis::Unexplained(off) } else { Diagnosis::Explained(found) })
}

/// Finds one slip that explains the torques approximately, if [`diagnose`] finds none that explains all their digits:
/// one of the programs may use rounded angles. The tolerance is raised until the torques are right, or a slip gives
/// them. Returns this tolerance and the diagnosis, or `None` if nothing explains the torques.
///
/// `tolerances` are parts of the largest torque, in ascending order. Pairs of slips are not tried: there are so many
/// that some approximate almost any torques.
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
    // a slip that leaves much of the difference is no explanation, however small the difference is
    let nearest = if nearest <= near_miss::MOST * right { nearest } else { f64::INFINITY };
    let Some(&tolerance) = tolerances.iter().find(|tolerance| right.min(nearest) <= **tolerance) else {
        return Ok(None);
    };
    if right <= tolerance {
        return Ok(Some((tolerance, Diagnosis::Agrees(right))));
    }
    // an explanation that is far less accurate than the best one is a coincidence
    tried.retain(|explanation| explanation.error <= tolerance.min(3.0 * nearest));
    Ok(Some((tolerance, Diagnosis::Explained(tried))))
}

/// Returns the slips that are tried alone, the likeliest first.
fn one_by_one(robot: &Robot) -> Vec<Slip> {
    let typos = Typo::candidates(robot).into_iter().map(Slip::Typo);
    Slip::candidates(robot).into_iter().chain(Slip::alone(robot)).chain(typos).collect()
}

/// Computes the torques with some slips at the state of `at`, whose own torques are ignored. `None` if the slips are
/// impossible: the lecture's formulas only apply to standard tables of serial arms.
///
/// # Errors
/// When a list of `at` does not have one number per joint.
pub fn torques_with(robot: &Robot, slips: &[Slip], at: &Observation) -> Result<Option<Vec<f64>>, WrongLength> {
    let Some(computation) = Computation::with(robot, slips) else { return Ok(None) };
    computation.torques(&DynArm::from_robot(&computation.robot), at).map(Some)
}

/// The result of trying some slips.
struct Tried {
    /// Whether the torques with the slips agree with the observed ones.
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
