//! Computes positions of the dependent joints that close the loops of a robot.

use std::f64::consts::TAU;

use rne::DynArm;
use rne_model::{JointKind, Robot, six_digits};

use crate::outcome::Failure;
use crate::values::state::State;

/// Largest number of Newton steps from one guess, because a guess may be far away.
const STEPS: usize = 50;
/// Largest residual of an equation of a closed loop, m or a scalar product of axes.
const CLOSED: f64 = 1e-12;
/// Largest step of the other joints between two closures on the path from a known configuration, rad or m.
const STRIDE: f64 = 0.05;
/// The shortest part of such a step, where the solution curves strongly.
const SHORTEST: f64 = 1e-3;
/// Largest number of steps on a path.
const STRIDES: f64 = 1000.0;
/// A pivot below this part of the largest singular value is nearly zero.
const NEARLY_SINGULAR: f64 = 1e-3;

/// Returns positions of the dependent joints for positions `q` of the others: the closure to which a guess leads.
/// Without a guess, the closure that a path reaches from the first configuration of the robot file without a singular
/// position, and so without a jump to another assembly; if there is no such path, from the other configurations.
pub(crate) fn closed(robot: &Robot, q: &[f64], guess: Option<&[f64]>) -> Result<Vec<f64>, Failure> {
    let arm = DynArm::from_robot(robot);
    let names: Vec<_> = robot.closed.passive.iter().map(|&at| robot.joints[at].name.as_str()).collect();
    let (names, name) = (names.join(", "), &robot.name);
    if let Some(guess) = guess {
        let found = newton(&arm, q, guess.to_vec()).ok_or_else(|| {
            usage_error!(
                "--passive leads to no positions of {names} that close the loops of {name} at these positions --q: \
                 the loops may be open at all of them. Give another guess, or other positions"
            )
        });
        return found.map(|passive| without_turns(robot, passive));
    }
    let mut nearest: Option<(f64, Vec<f64>)> = None;
    for closure in &robot.closed.closures {
        match reached(robot, &arm, closure, q) {
            Ok(passive) => return Ok(without_turns(robot, passive)),
            Err(end) => {
                let left = end.iter().zip(q).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
                if nearest.as_ref().is_none_or(|(least, _)| left < *least) {
                    nearest = Some((left, end));
                }
            }
        }
    }
    let end = nearest.map_or_else(Vec::new, |(_, end)| end);
    let end = end.into_iter().map(six_digits).collect::<Vec<_>>().join(", ");
    Err(usage_error!(
        "no assembly of {name} that was found reaches these positions --q: the nearest one ends at a singular \
         position, or the loops open, at q = {end}. Give other positions, or with --passive a guess of {names} for \
         another assembly"
    ))
}

/// Returns a note if the loops are close to a singular position, because positions with few digits then give torques
/// with fewer digits, and other assemblies are near.
///
/// Returns another note if the user did not choose the assembly and it is not that of the first configuration.
pub(crate) fn remark(robot: &Robot, arm: &DynArm, state: &State, is_chosen: bool) -> String {
    if state.passive.is_empty() {
        return String::new();
    }
    let first =
        (!is_chosen).then(|| robot.closed.closures.first().map(|closure| reached(robot, arm, closure, &state.q)));
    let other = match first.flatten() {
        Some(Err(end)) => {
            let end = end.into_iter().map(six_digits).collect::<Vec<_>>().join(", ");
            format!(
                "note: the assembly of the first configuration of the file ends, or meets another one, near q = {end} \
                 on the way to this position; the numbers are of another assembly, and --passive chooses one\n"
            )
        }
        _ => String::new(),
    };
    let least = pivots(robot, arm, &state.q, &state.passive).iter().fold(f64::INFINITY, |least, x| least.min(x.abs()));
    let part = least / robot.closed.singular_values[1];
    if part >= NEARLY_SINGULAR {
        return other;
    }
    other
        + &format!(
            "note: the loops are close to a singular position, where the dependent joints do not follow from q (a \
             pivot of their equations is {} of the largest singular value): torques can be very large, and have fewer \
             digits than the positions\n",
            three_digits(part)
        )
}

/// Follows the path from a configuration of the file to the positions `q`. Returns the closure there, or the positions
/// of the other joints at which the path ends.
fn reached(robot: &Robot, arm: &DynArm, closure: &[f64], q: &[f64]) -> Result<Vec<f64>, Vec<f64>> {
    let of = |joints: &mut dyn Iterator<Item = usize>| joints.map(|at| closure[at]).collect::<Vec<f64>>();
    let start = of(&mut robot.coordinates());
    continued(robot, arm, [&start, q], of(&mut robot.closed.passive.iter().copied()))
}

/// Writes a number with three digits.
fn three_digits(x: f64) -> String {
    format!("{x:.2e}").parse().map_or_else(|_| six_digits(x), six_digits)
}

/// Searches a closure by Newton's method, beginning at a guess.
fn newton(arm: &DynArm, q: &[f64], mut passive: Vec<f64>) -> Option<Vec<f64>> {
    for _ in 0..STEPS {
        let step = arm.closure_step(q, &passive).ok()?;
        if step.residual.iter().all(|left| left.abs() < CLOSED) {
            return Some(passive);
        }
        passive = step.passive;
    }
    None
}

/// Returns whether an equation of the loops has a larger residual than `allowed`, m or a scalar product of axes.
pub(crate) fn are_open(arm: &DynArm, q: &[f64], passive: &[f64], allowed: f64) -> bool {
    arm.closure_step(q, passive).is_ok_and(|step| step.residual.iter().any(|left| left.abs() > allowed))
}

/// Returns the pivots of the equations in the order of elimination, from finite differences of the residuals. Their
/// product is the determinant, which changes its sign where an assembly ends or meets another one.
fn pivots(robot: &Robot, arm: &DynArm, q: &[f64], passive: &[f64]) -> Vec<f64> {
    const STEP: f64 = 1e-6;
    let order = &robot.closed.elimination;
    let column = |joint: usize| {
        let [ahead, behind] = [STEP, -STEP].map(|step| {
            let mut moved = passive.to_vec();
            moved[joint] += step;
            arm.closure_step(q, &moved).map(|step| step.residual).unwrap_or_default()
        });
        let slope = |equation: usize| (ahead.get(equation).zip(behind.get(equation))).map_or(0.0, |(a, b)| a - b);
        order.iter().map(|row| slope(row.equation) / (2.0 * STEP)).collect::<Vec<f64>>()
    };
    // the matrix is stored by columns, in the order of elimination
    let mut matrix: Vec<Vec<f64>> = order.iter().map(|pivot| column(pivot.passive)).collect();
    for step in 0..matrix.len() {
        let (before, after) = matrix.split_at_mut(step + 1);
        let pivot = &before[step];
        for column in after {
            let factor = column[step] / pivot[step];
            column.iter_mut().zip(pivot).skip(step).for_each(|(x, by)| *x -= factor * by);
        }
    }
    (0..matrix.len()).map(|step| matrix[step][step]).collect()
}

/// Follows the closure along a straight path of the other joints. Each step is predicted by the velocities that the
/// loops allow, and halved if the closure found is not near. If the assembly ends, or the determinant of its equations
/// changes its sign, the error has the positions of the other joints there.
fn continued(
    robot: &Robot,
    arm: &DynArm,
    [from, to]: [&[f64]; 2],
    mut passive: Vec<f64>,
) -> Result<Vec<f64>, Vec<f64>> {
    let at = |part: f64| -> Vec<f64> { from.iter().zip(to).map(|(a, b)| a + part * (b - a)).collect() };
    let is_negative = |q: &[f64], passive: &[f64]| {
        pivots(robot, arm, q, passive).into_iter().filter(|pivot| *pivot < 0.0).count() % 2 == 1
    };
    let longest = from.iter().zip(to).fold(0.0_f64, |longest, (a, b)| longest.max((b - a).abs()));
    let whole = 1.0 / (longest / STRIDE).ceil().clamp(1.0, STRIDES);
    let sign = is_negative(from, &passive);
    let (mut part, mut stride) = (0.0, whole);
    while part < 1.0 {
        let next = (part + stride).min(1.0);
        // the end of the path is exactly `to`, without rounding
        let q = if next >= 1.0 { to.to_vec() } else { at(next) };
        let step: Vec<f64> = q.iter().zip(at(part)).map(|(a, b)| a - b).collect();
        let map = arm.loop_map(&at(part), &passive).unwrap_or_default();
        let rates = map.iter().map(|row| row.iter().zip(&step).map(|(g, dq)| g * dq).sum::<f64>());
        let expected: Vec<f64> = passive.iter().zip(rates).map(|(p, change)| p + change).collect();
        let reach = expected.iter().zip(&passive).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let found = newton(arm, &q, expected.clone()).filter(|found| {
            let off = found.iter().zip(&expected).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            off <= 0.5 * reach + 1e-9 && is_negative(&q, found) == sign
        });
        match found {
            Some(found) => {
                (passive, part) = (found, next);
                stride = (2.0 * stride).min(whole);
            }
            None if stride > SHORTEST * whole => stride /= 2.0,
            None => return Err(at(part)),
        }
    }
    Ok(passive)
}

/// Removes whole turns from the positions of revolute joints.
fn without_turns(robot: &Robot, passive: Vec<f64>) -> Vec<f64> {
    let of_joint = |(position, &joint): (f64, &usize)| match robot.joints[joint].row.kind {
        JointKind::Revolute => position - TAU * (position / TAU).round(),
        JointKind::Prismatic => position,
    };
    passive.into_iter().zip(&robot.closed.passive).map(of_joint).collect()
}
