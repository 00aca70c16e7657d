//! Positions of the dependent joints that close the loops of a robot.

use rne::DynArm;
use rne_model::Robot;

use crate::outcome::Failure;

/// Newton steps from one guess: some are far away.
const STEPS: usize = 50;
/// The largest residual of an equation of a closed loop, m or a product of axes.
const CLOSED: f64 = 1e-12;

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
            let left = residual.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            if left < CLOSED {
                return Ok(passive);
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
