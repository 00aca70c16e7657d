//! `rne diagnose`: finds why the torques of another program differ.

use std::fmt::Write as _;

use clap::Args;
use rne::{DynArm, Wrench};
use rne_codegen::Function;
use rne_diagnose::{COARSEST, Diagnosis, Explanation, NearMiss, Observation};
use rne_model::{Robot, half_of_last_digit};
use serde::Serialize;

use crate::files::chosen_arm::ChosenArm;
use crate::files::robot_file::Shape;
use crate::outcome::{Failure, Outcome};
use crate::palette::{ERROR, FOUND, GOOD, QUIET, TITLE};
use crate::render::answer::not_finite;
use crate::render::layout::{Align, columns, wrap};
use crate::terminal;
use crate::values::numbers::{List, checked, rounded};
use crate::values::state::{Given, State};

/// Find mistakes that explain different torques of another program
#[derive(Args)]
#[command(override_usage = "rne diagnose [OPTIONS] --q <Q> --qd <QD> --qdd <QDD> --tau <TAU> <FILE>")]
#[command(after_help = "\
Exit status: 1 if the torques differ and no mistake explains them. Without
--tolerance, each torque may be off by half of its own last digit: 14.5 by 0.05,
2.40 by 0.005. Where no mistake explains these digits, rne accepts up to 1e-4 of
the largest torque, and says so.

Examples:
  rne diagnose robots/planar1.yaml --q 0.3 --qd 0.5 --qdd -1 --tau -4.853
  rne diagnose puma560 --q 0,0.3,-0.5,0.1,0.2,0 --qd 1,1,1,1,1,1 \\
    --qdd 1,0,0,0,0,0 --tau=-0.28771,-37.706,-1.35305,0.0035967,0.003694,5.56e-5

rne tries the usual mistakes one by one, then in pairs: convention, gravity,
inertia and centre of mass about another point, units, offsets, signs, motors,
wrench, order of lists, and the misprints of the lecture
(docs/teaching/lecture/errata.md). Mistakes of a single row or link come next:
signs, centre of mass, inertia, mass, exchanged numbers, zero position. In a
tree rne also tries exchanged branches and a tip on another link, and no
misprints; followers may have the other sign. If nothing agrees, rne tells what
comes nearest. Give speeds and accelerations of all joints: such a state
distinguishes most mistakes.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    arm: ChosenArm,
    /// Joint positions, base to tip, rad or m
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    q: List,
    /// Joint velocities, base to tip, rad/s or m/s
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    qd: List,
    /// Joint accelerations, base to tip, rad/s² or m/s²
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    qdd: List,
    /// Torques that the other program computed, with all digits, N m or N
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    tau: Printed,
    /// Force and moment of the tip on its environment, fx,fy,fz,nx,ny,nz, N and N m, in tip axes
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    wrench: Option<List>,
    /// Accepted error of a torque, relative to the largest torque [default: half of the last digit of each number of
    /// --tau]
    #[arg(long, value_name = "T", allow_hyphen_values = true,
        value_parser = checked(|part: &f64| (0.0..1.0).contains(part),
        "write a fraction of the largest torque, from 0 to below 1, such as --tolerance 1e-4"))]
    tolerance: Option<f64>,
    /// Print the answer as JSON: {"agrees": …, "tolerance": …, "accepted": […], "error": …, "explanations": […],
    /// "nearest": …}
    #[arg(long)]
    json: bool,
}

/// Numbers, and half of the last digit of each.
#[derive(Clone, Debug, PartialEq)]
struct Printed {
    values: List,
    resolution: Vec<f64>,
}

impl std::str::FromStr for Printed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let values: List = text.parse()?;
        Ok(Self { values, resolution: text.split(',').map(half_of_last_digit).collect() })
    }
}

/// The answer in JSON.
#[derive(Serialize)]
struct Reply {
    agrees: bool,
    /// The largest accepted error, as a part of the largest torque.
    tolerance: f64,
    /// The accepted error of each torque, N m or N.
    accepted: Vec<f64>,
    error: f64,
    explanations: Vec<Reason>,
    /// The cause that comes nearest where nothing explains the torques.
    nearest: Option<Nearest>,
}

#[derive(Serialize)]
struct Nearest {
    error: f64,
    says: String,
    right: String,
}

#[derive(Serialize)]
struct Reason {
    error: f64,
    slips: Vec<Named>,
}

#[derive(Serialize)]
struct Named {
    name: &'static str,
    says: String,
    right: String,
}

/// Tolerances that are tried if no mistake explains the torques to all their digits, as parts of the largest torque.
/// The last one is only for files whose angles were snapped, which changes torques by at most this.
const TOLERANCES: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// Largest number of explanations that are shown; the others are counted.
const SHOWN: usize = 5;

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = arguments.arm.robot_with_payload(Shape::Coupled)?;
    let (seen, right) = observation(arguments, &robot)?;
    let all = std::slice::from_ref(&seen);
    let snapped = robot.notes.as_deref().and_then(rne_convert::snapping_in);
    let mut found = (0.0, rne_diagnose::diagnose(&robot, all).map_err(Failure::usage)?);
    if matches!(found.1, Diagnosis::Unexplained(_)) && arguments.tolerance.is_none() {
        let tolerances = if snapped.is_some() { &TOLERANCES[..] } else { &TOLERANCES[..2] };
        found = rne_diagnose::diagnose_nearly(&robot, all, tolerances).map_err(Failure::usage)?.unwrap_or(found);
    }
    let (tolerance, diagnosis) = found;
    let is_near = tolerance > 0.0;
    let nearest = match diagnosis {
        Diagnosis::Unexplained(_) => rne_diagnose::near_miss(&robot, all).map_err(Failure::usage)?,
        _ => None,
    };
    let at_fault = match diagnosis {
        Diagnosis::Unexplained(_) => true,
        Diagnosis::Agrees(_) => is_near && snapped.is_none(),
        Diagnosis::Explained(_) => false,
    };
    if arguments.json {
        let largest = largest(&seen.tau, &right);
        let accepted = if is_near { vec![tolerance * largest; right.len()] } else { seen.resolution };
        let most = accepted.iter().fold(0.0, |most: f64, half| most.max(*half));
        let tolerance = if largest > 0.0 { most / largest } else { 0.0 };
        let told = |near: &NearMiss| Nearest { error: near.error, says: near.says(&robot), right: near.right(&robot) };
        let nearest = nearest.as_ref().map(told);
        let reply = Reply { tolerance, accepted, nearest, ..reply(&robot, &diagnosis) };
        let reply = Reply { agrees: reply.agrees && !at_fault, ..reply };
        return Ok(Outcome { at_fault, ..Outcome::json(&reply)? });
    }
    let text = match diagnosis {
        Diagnosis::Agrees(error) if is_near => nearly_right(&robot, &table(&robot, &seen, &right), error, snapped),
        Diagnosis::Agrees(error) => {
            format!(
                "{GOOD}ok{GOOD:#} the torques agree with {TITLE}{}{TITLE:#}{}\n",
                robot.name,
                closeness(&seen, error)
            )
        }
        Diagnosis::Explained(all) => {
            let remark = match snapped.filter(|_| is_near) {
                Some(snapped) => format!("{QUIET}{}{QUIET:#}\n", wrap(&of_snapping(snapped), terminal::width(80), "")),
                None => String::new(),
            };
            table(&robot, &seen, &right) + "\n" + &explained(&robot, &seen, &all) + &remark
        }
        Diagnosis::Unexplained(_) => {
            let trace = if robot.is_serial() { "compare link by link: rne eval … --trace; " } else { "" };
            let is_coarse = seen.resolution.iter().any(|half| *half > COARSEST * largest(&seen.tau, &[]));
            let pair = if is_coarse { "does to 1e-3 of the largest" } else { "of mistakes does" };
            table(&robot, &seen, &right)
                + &format!(
                    "\n{ERROR}no usual mistake{ERROR:#} gives these torques, and no pair {pair}\n{}\
                     {QUIET}{trace}accept larger errors: --tolerance 1e-3{QUIET:#}\n",
                    nearest.map_or_else(String::new, |nearest| coming_near(&robot, &nearest))
                )
        }
    };
    Ok(Outcome { text, at_fault, ..Outcome::default() })
}

/// Returns the torques of the other program with their state, and the right torques.
fn observation(arguments: &Arguments, robot: &Robot) -> Result<(Observation, Vec<f64>), Failure> {
    let Printed { values: List(tau), resolution } = &arguments.tau;
    if tau.len() != robot.dof() {
        let (found, joints) = (tau.len(), robot.dof());
        let numbers = if joints == 1 { "number" } else { "numbers" };
        return Err(usage_error!("--tau needs {joints} {numbers}, one for each joint, not {found}"));
    }
    let function = match arguments.wrench {
        Some(_) => Function::InverseDynamicsWithWrench,
        None => Function::InverseDynamics,
    };
    let given = Given {
        q: Some(arguments.q.clone()),
        qd: Some(arguments.qd.clone()),
        qdd: Some(arguments.qdd.clone()),
        wrench: arguments.wrench.clone(),
        ..Given::default()
    };
    let state = State::new(function, &given, robot)?;
    let right = state.numbers(&DynArm::from_robot(robot)).map_err(Failure::usage)?;
    if let Some(index) = right.iter().position(|number| !number.is_finite()) {
        return Err(Failure::input(not_finite(robot, function, index, &state.q)));
    }
    let largest = largest(tau, &right);
    // the digits of a zero do not show its accuracy, so it gets the accuracy of the other torques
    let is_zero = |(tau, half): &(&f64, &f64)| **tau == 0.0 && **half == 0.5;
    let digits = || tau.iter().zip(resolution);
    let of_others = digits().filter(|it| !is_zero(it)).fold(COARSEST * largest, |least, (_, half)| least.min(*half));
    let resolution = match arguments.tolerance {
        Some(tolerance) => vec![tolerance * largest; tau.len()],
        None => digits().map(|it| if is_zero(&it) { of_others } else { *it.1 }).collect(),
    };
    let State { q, qd, qdd, wrench, .. } = state;
    let wrench: Option<Wrench<f64>> = wrench;
    Ok((Observation { q, qd, qdd, wrench, tau: tau.clone(), resolution }, right))
}

/// Returns the magnitude of the largest torque.
fn largest(tau: &[f64], right: &[f64]) -> f64 {
    tau.iter().chain(right).fold(0.0, |largest: f64, tau| largest.max(tau.abs()))
}

fn reply(robot: &Robot, diagnosis: &Diagnosis) -> Reply {
    let named =
        |&slip: &rne_diagnose::Slip| Named { name: slip.name(), says: slip.says(robot), right: slip.right(robot) };
    let reason =
        |Explanation { slips, error }: &Explanation| Reason { error: *error, slips: slips.iter().map(named).collect() };
    let (agrees, error, explanations) = match diagnosis {
        Diagnosis::Agrees(error) => (true, *error, Vec::new()),
        Diagnosis::Explained(all) => {
            (false, all.first().map_or(0.0, |first| first.error), all.iter().map(reason).collect())
        }
        Diagnosis::Unexplained(error) => (false, *error, Vec::new()),
    };
    Reply { agrees, tolerance: 0.0, accepted: Vec::new(), error, explanations, nearest: None }
}

/// Returns the remark that angles of the robot file were snapped, with what its notes say about it.
fn of_snapping(snapped: &str) -> String {
    format!("the other program may have read a URDF with other angles; in this file, {snapped}: import with --no-snap")
}

/// Returns the answer for torques that are nearly right: snapped angles of an imported file explain the difference, or
/// nothing does.
fn nearly_right(robot: &Robot, table: &str, error: f64, snapped: Option<&str>) -> String {
    let (name, width) = (&robot.name, terminal::width(80));
    if let Some(snapped) = snapped {
        let remark = wrap(&of_snapping(snapped), width, "");
        return format!(
            "{GOOD}ok{GOOD:#} the torques agree with {TITLE}{name}{TITLE:#} to {error:.1e} of the largest\n\
             {QUIET}{remark}{QUIET:#}\n"
        );
    }
    let hint = "one of both programs may have rounded angles or lengths; accept the difference: --tolerance 1e-3";
    format!(
        "{table}\nthe torques agree with {TITLE}{name}{TITLE:#} to {error:.1e} of the largest, but not with all of \
         their digits;\n{ERROR}no usual mistake{ERROR:#} explains the difference\n{QUIET}{}{QUIET:#}\n",
        wrap(hint, width, "")
    )
}

/// Writes what comes nearest to torques that nothing explains, and what is right.
fn coming_near(robot: &Robot, nearest: &NearMiss) -> String {
    let (width, left) = (terminal::width(80), rounded(100.0 * nearest.error, 2));
    let says = wrap(&format!("  - {}", nearest.says(robot)), width, "    ");
    let right = wrap(&format!("    right: {}", nearest.right(robot)), width, "           ");
    format!(
        "{TITLE}this comes nearest{TITLE:#}; {left} % of the largest torque remain unexplained:\n{says}\n\
         {FOUND}{right}{FOUND:#}\n"
    )
}

/// Returns words on how well torques agree; empty if all torques are zero, because a relative error has no meaning
/// then.
fn closeness(seen: &Observation, error: f64) -> String {
    match error {
        _ if largest(&seen.tau, &[]) == 0.0 => String::new(),
        0.0..1e-15 => " exactly".to_owned(),
        _ => format!(" to {error:.0e} of the largest"),
    }
}

/// Writes the torques beside the right ones.
fn table(robot: &Robot, seen: &Observation, right: &[f64]) -> String {
    let mut cells = vec![["  joint", "yours", "robot file", "difference"].map(str::to_owned)];
    for ((joint, yours), right) in robot.independent_joints().zip(&seen.tau).zip(right) {
        let numbers = [*yours, *right, yours - right].map(|number| rounded(number, 6));
        let [yours, right, difference] = numbers;
        cells.push([format!("  {}", joint.name), yours, right, difference]);
    }
    let lines = columns(&[Align::Left, Align::Right, Align::Right, Align::Right], &cells);
    let (head, rest) = lines.split_first().map_or(("", &[][..]), |(head, rest)| (head.as_str(), rest));
    format!("{QUIET}{head}{QUIET:#}\n{}\n", rest.join("\n"))
}

/// Writes the mistakes that explain the torques, each with what is right.
fn explained(robot: &Robot, seen: &Observation, all: &[Explanation]) -> String {
    let width = terminal::width(80);
    let mut text = String::new();
    for (index, Explanation { slips, error }) in all.iter().take(SHOWN).enumerate() {
        let together = if slips.len() > 1 { " together" } else { "" };
        let _ = match index {
            0 => {
                let close = closeness(seen, *error);
                let close = if close.is_empty() { close } else { format!(",{close}") };
                writeln!(text, "{TITLE}your torques{TITLE:#} result from this{together}{close}:")
            }
            _ => writeln!(text, "{QUIET}or from this, which is the same at this state:{QUIET:#}"),
        };
        for slip in slips {
            let _ = writeln!(text, "{}", wrap(&format!("  - {}", slip.says(robot)), width, "    "));
            let right = wrap(&format!("    right: {}", slip.right(robot)), width, "           ");
            let _ = writeln!(text, "{FOUND}{right}{FOUND:#}");
        }
    }
    if all.len() > SHOWN {
        let more = all.len() - SHOWN;
        let _ = writeln!(text, "{QUIET}and {more} more; --json lists them{QUIET:#}");
    }
    if all.len() > 1 {
        let hint = "use a state in which every joint has a position, a speed and an acceleration to distinguish them";
        let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(hint, width, ""));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_tell_how_far_a_torque_may_be_off() {
        for (text, half) in [
            ("1.25", 0.005),
            ("14.5", 0.05),
            ("2.4", 0.05),
            ("2.40", 0.005),
            ("-3", 0.5),
            ("+120", 0.5),
            ("1.5e-3", 5e-5),
            ("1.50E+2", 0.5),
            ("2e2", 50.0),
            ("1e3", 500.0),
            ("pi/2", 0.0),
            (" 0.10 ", 0.005),
        ] {
            assert!((half_of_last_digit(text) - half).abs() <= 1e-12 * half, "{text}");
        }
    }
}
