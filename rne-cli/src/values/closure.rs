//! Positions of the dependent joints that close the loops of a robot.

use std::f64::consts::TAU;

use rne::DynArm;
use rne_codegen::{Argument, Function};
use rne_model::{JointKind, Robot};

use crate::outcome::Failure;
use crate::values::state::State;

/// Newton steps from one guess: some are far away.
const STEPS: usize = 50;
/// The largest residual of an equation of a closed loop, m or a product of axes.
const CLOSED: f64 = 1e-12;

/// The largest residual of loops that count as closed, where a caller gives the positions with some digits.
const OPEN: f64 = 1e-6;

/// Positions without whole turns.
fn without_turns(robot: &Robot, passive: Vec<f64>) -> Vec<f64> {
    let of_joint = |(position, &joint): (f64, &usize)| match robot.joints[joint].row.kind {
        JointKind::Revolute => position - TAU * (position / TAU).round(),
        JointKind::Prismatic => position,
    };
    passive.into_iter().zip(&robot.closed.passive).map(of_joint).collect()
}

/// Positions of the dependent joints for positions `q` of the others: from the closures of the robot file, the nearest
/// first.
pub(crate) fn closed(robot: &Robot, q: &[f64]) -> Result<Vec<f64>, Failure> {
    let (arm, coordinates) = (DynArm::from_robot(robot), robot.coordinates().collect::<Vec<_>>());
    let mut guesses: Vec<(f64, Vec<f64>)> = robot
        .closed
        .closures
        .iter()
        .map(|closure| {
            let apart = coordinates.iter().zip(q).map(|(&joint, q)| (closure[joint] - q).powi(2)).sum();
            (apart, robot.closed.passive.iter().map(|&joint| closure[joint]).collect())
        })
        .collect();
    guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut least = f64::INFINITY;
    for (_, mut passive) in guesses {
        for _ in 0..STEPS {
            // a list of another length than the joints is refused elsewhere
            let Ok((next, residual)) = arm.closure_step(q, &passive) else { return Ok(passive) };
            let left = largest(&residual);
            if left < CLOSED {
                return Ok(without_turns(robot, passive));
            }
            least = least.min(left);
            passive = next;
        }
    }
    let names: Vec<_> = robot.closed.passive.iter().map(|&at| robot.joints[at].name.as_str()).collect();
    Err(Failure::usage(format_args!(
        "no positions of {} were found that close the loops of {} at these positions --q: {least:.2e} m are left. Give \
         a guess with --passive, or other positions",
        names.join(", "),
        robot.name
    )))
}

/// The remark on positions of dependent joints that do not close the loops; empty where they do.
pub(crate) fn remark(arm: &DynArm, State { function, q, passive, .. }: &State) -> String {
    // its residual is a part of the result of a step
    if *function == Function::ClosureStep || !function.takes(Argument::Passive) {
        return String::new();
    }
    let left = arm.closure_step(q, passive).map_or(0.0, |(_, residual)| largest(&residual));
    if left < OPEN {
        return String::new();
    }
    format!("note: --passive does not close the loops: {left:.2e} m are left, so these numbers mean nothing\n")
}

fn largest(residual: &[f64]) -> f64 {
    residual.iter().fold(0.0, |largest, x| if x.is_nan() { f64::INFINITY } else { f64::max(largest, x.abs()) })
}
