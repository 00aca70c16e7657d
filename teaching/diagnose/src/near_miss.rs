//! The cause that comes nearest to torques that no slip explains.

use rne_model::{Robot, six_digits};
use rne_runtime::{DynArm, WrongLength};

use crate::observation::{Observation, largest};
use crate::slip::Slip;
use crate::{Tried, one_by_one, torques_with};

/// The slip, or the different number of one link, that comes nearest to torques in question.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMiss {
    /// The difference of the other program.
    pub cause: Cause,
    /// The largest difference that remains, as a part of the largest torque.
    pub error: f64,
}

/// A difference of another program.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// A slip.
    Slip(Slip),
    /// Another inertial parameter of one link, which explains the differences of all joints.
    Parameter {
        /// The link, counted from 0.
        link: usize,
        /// The parameter, in the order of the [regressor](DynArm::regressor); 10 is the mass where the centre of mass
        /// and the inertia about it stay.
        parameter: usize,
        /// The other program's number minus that of the file; kg, kg m or kg m².
        difference: f64,
        /// The joints whose torques differ, counted from 0.
        joints: Vec<usize>,
    },
}

/// A near miss leaves at most this part of the difference.
pub(crate) const MOST: f64 = 0.2;
/// A torque differs if its difference is at least this part of the largest one.
const LEAST: f64 = 1e-3;

/// The words for an inertial parameter, and its unit.
const PARAMETERS: [(&str, &str); 11] = [
    ("the mass", "kg"),
    ("the first moment along x", "kg m"),
    ("the first moment along y", "kg m"),
    ("the first moment along z", "kg m"),
    ("the inertia xx", "kg m²"),
    ("the inertia xy", "kg m²"),
    ("the inertia xz", "kg m²"),
    ("the inertia yy", "kg m²"),
    ("the inertia yz", "kg m²"),
    ("the inertia zz", "kg m²"),
    ("with the same centre of mass, the mass", "kg"),
];

/// Finds what comes nearest to the torques of all given states: one slip, or one inertial parameter that two joints or
/// more have in common. `None` if nothing explains four fifths of the difference.
///
/// # Errors
/// When a list of an observation does not have one number per joint.
pub fn near_miss(robot: &Robot, seen: &[Observation]) -> Result<Option<NearMiss>, WrongLength> {
    let Some(Tried { error: all, .. }) = Tried::of(robot, seen, &[])? else { return Ok(None) };
    let mut nearest: Option<NearMiss> = None;
    for slip in one_by_one(robot) {
        let Some(Tried { error, .. }) = Tried::of(robot, seen, &[slip])? else { continue };
        if nearest.as_ref().is_none_or(|nearest| error < nearest.error) {
            nearest = Some(NearMiss { cause: Cause::Slip(slip), error });
        }
    }
    // a parameter has a free number, so it has to be far better than a slip
    let slips = nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.error);
    let parameter = other_parameter(robot, seen)?.filter(|found| found.error < 0.3 * slips);
    Ok(parameter.or(nearest).filter(|found| found.error <= MOST * all))
}

/// Finds the inertial parameter of one link whose change comes nearest, by least squares.
fn other_parameter(robot: &Robot, seen: &[Observation]) -> Result<Option<NearMiss>, WrongLength> {
    let arm = DynArm::from_robot(robot);
    let (mut differences, mut rows, mut size) = (Vec::new(), Vec::new(), 0.0_f64);
    for at in seen {
        let Some(right) = torques_with(robot, &[], at)? else { return Ok(None) };
        size = size.max(largest(&right)).max(largest(&at.tau));
        differences.extend(at.tau.iter().zip(&right).map(|(seen, right)| seen - right));
        rows.extend(arm.regressor(&at.q, &at.qd, &at.qdd)?);
    }
    let most = largest(&differences);
    let differs = |joint: &usize| differences.iter().skip(*joint).step_by(robot.dof()).any(|d| d.abs() > LEAST * most);
    let joints: Vec<usize> = (0..robot.dof()).filter(differs).collect();
    if joints.len() < 2 || !most.is_finite() {
        return Ok(None);
    }
    let mut nearest: Option<NearMiss> = None;
    for (link, parameter) in (0..robot.joints.len()).flat_map(|link| (0..11).map(move |number| (link, number))) {
        // 1 kg at the centre of mass, as parameters of the regressor
        let [x, y, z] = robot.joints[link].row.link.com;
        let point = [1.0, x, y, z, y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y];
        let of_mass = |row: &[f64; 10]| row.iter().zip(point).map(|(y, of_point)| y * of_point).sum();
        let column = || rows.iter().map(|row| row[link].get(parameter).copied().unwrap_or_else(|| of_mass(&row[link])));
        let dot: f64 = column().zip(&differences).map(|(y, d)| y * d).sum();
        let difference = dot / column().map(|y| y * y).sum::<f64>();
        let left: Vec<f64> = column().zip(&differences).map(|(y, d)| d - y * difference).collect();
        let error = largest(&left) / size;
        if difference.is_finite() && nearest.as_ref().is_none_or(|nearest| error < nearest.error) {
            let cause = Cause::Parameter { link, parameter, difference, joints: joints.clone() };
            nearest = Some(NearMiss { cause, error });
        }
    }
    Ok(nearest)
}

impl NearMiss {
    /// Describes what the other program has in a clause.
    #[must_use]
    pub fn says(&self, robot: &Robot) -> String {
        match &self.cause {
            Cause::Slip(slip) => slip.says(robot),
            Cause::Parameter { link, parameter, difference, joints } => {
                let (what, unit) = PARAMETERS[(*parameter).min(10)];
                let name = robot.joints.get(*link).map_or("", |joint| &joint.name);
                let numbers: Vec<String> = joints.iter().map(|joint| (joint + 1).to_string()).collect();
                let (last, others) = numbers.split_last().map_or(("", &[][..]), |(last, others)| (last, others));
                format!(
                    "joints {} and {last} differ by one number: {what} of link {} ({name}) is {} {unit} {}",
                    others.join(", "),
                    link + 1,
                    // the torques have few digits
                    format!("{:.2e}", difference.abs()).parse().map_or_else(|_| String::new(), six_digits),
                    if *difference < 0.0 { "smaller" } else { "larger" }
                )
            }
        }
    }

    /// Describes the correct way.
    #[must_use]
    pub fn right(&self, robot: &Robot) -> String {
        match &self.cause {
            Cause::Slip(slip) => slip.right(robot),
            Cause::Parameter { .. } => {
                "the number is in axes of the link frame, from its origin; compare the mass and the centre of mass of \
                 this link, and of what is fixed to it"
                    .to_owned()
            }
        }
    }
}
