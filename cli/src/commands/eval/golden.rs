//! Golden values: results of the runtime, which is independent of generated code, at states that are the same in each
//! run.

use std::borrow::Cow;

use rne::{BaseMotion, DynArm, Scalar, Wrench};
use rne_codegen::{Function, Program};
use rne_emit::{Golden, Precision};
use rne_model::{Contact, GoldenFile, Robot, exact_digits};

use crate::outcome::Failure;
use crate::values::definite::least_resistance;
use crate::values::random::{self, rounding};
use crate::values::state::State;

/// Number of states at which emitted code is compared with the runtime.
const STATES: usize = 4;

/// Returns the states at which emitted code is tested, with the expected results of its functions. Run-time parameters
/// have other values there than in the file.
pub(crate) fn of_programs(robot: &Robot, programs: &[Program], precision: Precision) -> Result<Vec<Golden>, Failure> {
    let (random, rounded) = (random::of(precision), rounding(precision));
    let in_file = robot.run_time.values(robot);
    (0..STATES)
        .map(|_| {
            let state = random::state(&random, robot);
            let parameters: Vec<f64> =
                in_file.iter().map(|value| rounded(value * (1.25 + random.number(0.5)))).collect();
            let robot = &robot.with_parameters(&parameters).unwrap_or_else(|| robot.clone());
            let arm = DynArm::from_robot(robot);
            let results = programs.iter().map(|program| {
                let arm = &at_frame(robot, program, &arm);
                let numbers = state.of(program.function).numbers(arm).map_err(Failure::usage)?;
                let is_finite = numbers.iter().all(|number| number.is_finite());
                let least = least_resistance(arm, program.function, [&state.q, &state.passive], state.payload.as_ref());
                let is_left_out = least.is_some_and(|least| least <= least_of(precision));
                let is_possible = program.function != Function::ForwardDynamicsInContact || can_hold(&numbers, arm);
                Ok(if is_finite && is_possible && !is_left_out { numbers } else { Vec::new() })
            });
            let results = results.collect::<Result<Vec<_>, Failure>>()?;
            let sizes =
                programs.iter().map(|program| size(program.function, &state, &arm)).collect::<Result<_, _>>()?;
            let steps = steps(&state, &arm, programs, &results)?;
            Ok(Golden { arguments: arguments(&state, parameters), results, sizes, steps })
        })
        .collect()
}

/// Computes the changes that a step of the Runge-Kutta method makes, and its derivatives, for code that has
/// accelerations.
fn steps(
    State { q, qd, tau, .. }: &State,
    arm: &DynArm,
    programs: &[Program],
    results: &[Vec<f64>],
) -> Result<[Vec<f64>; 2], Failure> {
    let is_compared = |(program, numbers): (&Program, &Vec<f64>)| {
        program.function == Function::ForwardDynamics && !numbers.is_empty()
    };
    if !programs.iter().zip(results).any(is_compared) {
        return Ok([Vec::new(), Vec::new()]);
    }
    let next = arm.runge_kutta_step(q, qd, tau, Golden::STEP).map_err(Failure::usage)?;
    let by = arm.runge_kutta_step_derivatives(q, qd, tau, Golden::STEP).map_err(Failure::usage)?;
    let changes = next.q.iter().zip(q).chain(next.qd.iter().zip(qd)).map(|(next, start)| next - start).collect();
    let blocks = [by.q, by.qd].into_iter().flat_map(|by| [by.dq, by.dqd, by.dtau]);
    let steps = [changes, blocks.flatten().flatten().collect::<Vec<f64>>()];
    Ok(steps.map(|numbers| if numbers.iter().all(|number| number.is_finite()) { numbers } else { Vec::new() }))
}

/// Returns the arm with the frame of a program in place of the tip, if the program has a frame.
fn at_frame<'a>(robot: &Robot, program: &Program, arm: &'a DynArm) -> Cow<'a, DynArm> {
    let frame = program.frame.as_deref().and_then(|name| robot.frame(name).ok());
    match frame.and_then(|frame| arm.clone().at_frame(robot.fixed_frame(frame))) {
        Some(at) => Cow::Owned(at),
        None => Cow::Borrowed(arm),
    }
}

/// Estimates the size of the terms in a function, to which errors are relative. Lengths and directions are about 1; for
/// dynamics it is the largest torque on a base that moves in all directions, with gravity parallel to no axis.
fn size(function: Function, state: &State, arm: &DynArm) -> Result<f64, Failure> {
    if function.entry().is_geometry {
        return Ok(1.0);
    }
    let torques = if function.is_of_closed_loops() {
        Function::InverseDynamicsOfLoopsWithWrenches
    } else {
        Function::InverseDynamicsOnMovingBase
    };
    let torques = state.of(torques).numbers(arm).map_err(Failure::usage)?;
    Ok(torques.iter().filter(|torque| torque.is_finite()).fold(0.0, |largest, torque| torque.abs().max(largest)))
}

/// Returns the pivot of the mass matrix below which accelerations lose too many digits to be compared. This happens at
/// a joint, or a base, that hardly any inertia resists while the distal joints move freely.
const fn least_of(precision: Precision) -> f64 {
    match precision {
        Precision::Single => 1e-3,
        Precision::Double => 1e-7,
    }
}

/// Returns whether the contacts can be fulfilled, from the result of forward dynamics in contact. Redundant contacts
/// cannot if they require different motions of their tips; the forces are then large.
fn can_hold(numbers: &[f64], arm: &DynArm) -> bool {
    /// Largest accepted acceleration of a tip in contact, m/s² or rad/s².
    const MOST: f64 = 1e-3;
    let forces = numbers.len().saturating_sub(6 * arm.tips().len());
    numbers[forces..].iter().all(|force| force.abs() * Contact::DAMPING < MOST)
}

/// Returns every argument with its name in emitted code.
fn arguments(state: &State, parameters: Vec<f64>) -> Vec<(&'static str, Vec<f64>)> {
    let (sin, cos) = state.q.iter().map(|&q| Scalar::sin_cos(q)).unzip();
    let wrench = state.wrench.unwrap_or_else(Wrench::zero);
    let BaseMotion { omega, omega_dot, acceleration, gravity, .. } = state.base;
    vec![
        ("sin", sin),
        ("cos", cos),
        ("q", state.q.clone()),
        ("passive", state.passive.clone()),
        ("qd", state.qd.clone()),
        ("qdd", state.qdd.clone()),
        ("tau", state.tau.clone()),
        ("step", vec![state.step]),
        ("multipliers", state.multipliers.clone()),
        ("force", wrench.force.to_vec()),
        ("moment", wrench.moment.to_vec()),
        ("wrenches", state.wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment]).flatten().collect()),
        ("payload", state.payload.unwrap_or_default().to_array().to_vec()),
        ("base_omega", omega.to_vec()),
        ("omega", omega.to_vec()),
        ("base_omega_dot", omega_dot.to_vec()),
        ("base_acceleration", acceleration.to_vec()),
        ("base_gravity", gravity.to_vec()),
        ("twist", [state.twist().linear, omega].concat()),
        ("pose", [state.pose.rotation.concat(), state.pose.translation.to_vec()].concat()),
        ("base_rotation", state.base_rotation.concat()),
        ("parameters", parameters),
    ]
}

/// Reads the number of states that a golden file should have.
pub(crate) fn states(text: &str) -> Result<u16, String> {
    let states = text.parse().ok().filter(|&states| states > 0);
    states.ok_or_else(|| format!("a golden file has 1 to {} states, such as --golden 100", u16::MAX))
}

/// Writes a golden file: torques of a robot at a number of states. Its heading lists the settings that differ from the
/// robot file.
pub(crate) fn file(robot: &Robot, states: u16, settings: &[String]) -> Result<String, Failure> {
    let (random, arm) = (random::of(Precision::Double), DynArm::from_robot(robot));
    let rotors = if robot.has_rotors() { ", with its rotors" } else { "" };
    let with = if settings.is_empty() { String::new() } else { format!(" with {}", settings.join(", ")) };
    let mut text = format!(
        "# Torques of {}{rotors}{with}, by the runtime of rne {}: rad, rad/s, rad/s^2, N m; m, m/s, m/s^2, N where a \
         joint slides\n{}\n",
        robot.name,
        env!("CARGO_PKG_VERSION"),
        GoldenFile::header(robot.dof()).join(",")
    );
    for _ in 0..states {
        let state = random::state(&random, robot);
        let torques = state.numbers(&arm).map_err(Failure::usage)?;
        let numbers = [&state.q, &state.qd, &state.qdd, &torques].into_iter().flatten();
        let numbers: Vec<String> = numbers.copied().map(exact_digits).collect();
        if torques.iter().any(|torque| !torque.is_finite()) {
            return Err(input_error!("a torque of {} overflows", robot.name));
        }
        text.push_str(&numbers.join(","));
        text.push('\n');
    }
    Ok(text)
}
