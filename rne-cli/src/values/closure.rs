//! Positions of the dependent joints that close the loops of a robot.

use std::f64::consts::TAU;

use rne::DynArm;
use rne_model::{JointKind, Robot, six_digits};

use crate::outcome::Failure;
use crate::values::state::State;

/// Newton steps from one guess: some are far away.
const STEPS: usize = 50;
/// The largest residual of an equation of a closed loop, m or a product of axes.
const CLOSED: f64 = 1e-12;
/// How far the other joints move between two closures on the way from a reference, rad or m.
const STRIDE: f64 = 0.05;
/// Strides of the longest way.
const STRIDES: f64 = 1000.0;

/// Positions of the dependent joints for positions `q` of the others: the closure that a guess leads to. Without a
/// guess, the closure that is reached from the first configuration of the robot file, without a jump to another
/// assembly; where no way leads there, from the other configurations.
pub(crate) fn closed(robot: &Robot, q: &[f64], guess: Option<&[f64]>) -> Result<Vec<f64>, Failure> {
    let arm = DynArm::from_robot(robot);
    let found = match guess {
        Some(guess) => newton(&arm, q, guess.to_vec()),
        None => robot.closed.closures.iter().find_map(|closure| {
            let of = |joints: &mut dyn Iterator<Item = usize>| joints.map(|at| closure[at]).collect::<Vec<f64>>();
            let start = of(&mut robot.coordinates());
            continued(&arm, [&start, q], of(&mut robot.closed.passive.iter().copied()))
        }),
    };
    let names: Vec<_> = robot.closed.passive.iter().map(|&at| robot.joints[at].name.as_str()).collect();
    let failure = || {
        let what = if guess.is_some() { "another guess" } else { "a guess" };
        Failure::usage(format_args!(
            "no positions of {} were found that close the loops of {} at these positions --q. Give {what} with \
             --passive, or other positions",
            names.join(", "),
            robot.name
        ))
    };
    found.map(|passive| without_turns(robot, passive)).ok_or_else(failure)
}

/// A note where the loops are close to a singular position: dependent joints then move much faster than the others, and
/// torques are as much larger.
pub(crate) fn remark(robot: &Robot, arm: &DynArm, state: &State) -> String {
    const FAST: f64 = 1e3;
    let map = arm.loop_map(&state.q, &state.passive).unwrap_or_default();
    let speeds = map.iter().map(|row| row.iter().fold(0.0_f64, |largest, x| largest.max(x.abs())));
    let fastest = robot.closed.passive.iter().zip(speeds).max_by(|a, b| a.1.total_cmp(&b.1));
    match fastest.filter(|(_, speed)| *speed > FAST) {
        Some((&joint, speed)) => format!(
            "note: the loops are close to a singular position: {} moves {} times as fast as the joints of q, so \
             positions of few digits give torques of fewer\n",
            robot.joints[joint].name,
            six_digits(speed)
        ),
        None => String::new(),
    }
}

/// The closure that Newton's method finds from a guess.
fn newton(arm: &DynArm, q: &[f64], mut passive: Vec<f64>) -> Option<Vec<f64>> {
    for _ in 0..STEPS {
        let (next, residual) = arm.closure_step(q, &passive).ok()?;
        if residual.iter().all(|left| left.abs() < CLOSED) {
            return Some(passive);
        }
        passive = next;
    }
    None
}

/// The closure at the end of a straight way of the other joints, stride by stride.
fn continued(arm: &DynArm, [from, to]: [&[f64]; 2], mut passive: Vec<f64>) -> Option<Vec<f64>> {
    let longest = from.iter().zip(to).fold(0.0_f64, |longest, (a, b)| longest.max((b - a).abs()));
    let strides = (longest / STRIDE).ceil().clamp(1.0, STRIDES);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most a thousand
    for stride in 1..=strides as u32 {
        let part = f64::from(stride) / strides;
        let q: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + part * (b - a)).collect();
        passive = newton(arm, if part == 1.0 { to } else { &q }, passive)?;
    }
    Some(passive)
}

/// Positions without whole turns.
fn without_turns(robot: &Robot, passive: Vec<f64>) -> Vec<f64> {
    let of_joint = |(position, &joint): (f64, &usize)| match robot.joints[joint].row.kind {
        JointKind::Revolute => position - TAU * (position / TAU).round(),
        JointKind::Prismatic => position,
    };
    passive.into_iter().zip(&robot.closed.passive).map(of_joint).collect()
}
