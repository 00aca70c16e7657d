//! `rne eval`: numbers from the runtime, which loops over the links and knows nothing of generated code.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne::{DynArm, DynTrace, Wrench};
use rne_codegen::{Argument, Function};
use rne_model::{JointKind, Robot};
use serde::Serialize;

use crate::layout::{Align, columns};
use crate::numbers::{List, at_the_point, exact};
use crate::outcome::{Failure, Outcome};
use crate::terminal::{QUIET, TITLE};
use crate::worksheet::{self, Axes, Entry};
use crate::{arguments, robot_file};

/// Compute torques at one state, by the runtime; --trace shows every vector of every step
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne eval robots/planar2.yaml --q 0.6,-1.1 --qd 1.3,-0.4 --qdd -0.7,2.1
  rne eval robots/planar2.yaml --q 0.6,-1.1 --qd 1.3,-0.4 --qdd -0.7,2.1 --trace --axes lecture
  rne eval robots/planar2.yaml --function gravity_torques --q 0.6,-pi/2
  rne eval robots/planar2.yaml --q 0.6,-1.1 --qd 0,0 --qdd 0,0 --wrench 3,-2,0,0,0,0.5 --json

One number per joint, base to tip: rad for a revolute, m for a prismatic joint; pi/2 and 'deg(30)' are numbers.
Nothing is assumed to be zero:
gravity_torques takes --q, bias_torques --q and --qd, inverse_dynamics all three.")]
pub(crate) struct Arguments {
    /// Robot file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Which function; inverse_dynamics, or with --wrench inverse_dynamics_with_wrench, unless given
    #[arg(long, value_name = "F", value_parser = arguments::function())]
    function: Option<Function>,
    /// Joint positions, rad or m
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    q: Option<List>,
    /// Joint velocities, rad/s or m/s
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    qd: Option<List>,
    /// Joint accelerations, rad/s² or m/s²
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    qdd: Option<List>,
    /// Force and moment that the last link exerts on its environment, at the tip, in tip axes: N and N m
    #[arg(long, value_name = "fx,fy,fz,nx,ny,nz", allow_hyphen_values = true)]
    wrench: Option<List>,
    /// The seven-step worksheet: every vector of every link
    #[arg(long)]
    trace: bool,
    /// Axes of the worksheet
    #[arg(long, value_enum, default_value_t = Axes::Link, requires = "trace")]
    axes: Axes,
    /// {"result": …}, with --trace also "trace": a list with an entry per link
    #[arg(long)]
    json: bool,
}

/// The arguments of the function, complete and of the right lengths.
struct State {
    function: Function,
    q: Vec<f64>,
    /// `None` where the function has no such argument: then it is zero.
    qd: Option<Vec<f64>>,
    qdd: Option<Vec<f64>>,
    wrench: Option<Wrench<f64>>,
}

/// The answer as JSON has it.
#[derive(Serialize)]
struct Answer<'a> {
    result: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    trace: Option<Vec<Entry<'a>>>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = robot_file::robot(&arguments.file)?;
    let state = state(arguments, &robot)?;
    let arm = DynArm::from_robot(&robot);
    // The lengths are checked, so this error does not occur; if it does, it says what is wrong.
    let result = torques(&arm, &state).map_err(Failure::usage)?;
    let trace = if arguments.trace { Some(trace(&arm, &state).map_err(Failure::usage)?) } else { None };

    if let Some(index) = result.iter().position(|torque| !torque.is_finite()) {
        let joint = &robot.joints[index].name;
        let message = format!("the torque of joint {} ({joint}) overflows: the state is too large", index + 1);
        return Err(Failure::input(message));
    }
    let links = trace.map(|trace| match arguments.axes {
        Axes::Link => trace.links,
        Axes::Lecture => trace.to_lecture(),
        Axes::Base => trace.to_base(),
    });
    if arguments.json {
        let trace = links.as_ref().map(|links| worksheet::entries(&robot, links));
        return Outcome::json(&Answer { result, trace });
    }
    let mut text = String::new();
    if let Some(links) = links {
        text.push_str(&worksheet::text(&robot, &links, arguments.axes, state.wrench.as_ref()));
        text.push('\n');
    }
    text.push_str(&table(&robot, &state, &result));
    Ok(Outcome::text(text))
}

fn torques(arm: &DynArm, state: &State) -> Result<Vec<f64>, rne::WrongLength> {
    let State { function, q, .. } = state;
    let none = Vec::new();
    let (qd, qdd) = (state.qd.as_ref().unwrap_or(&none), state.qdd.as_ref().unwrap_or(&none));
    match (function, &state.wrench) {
        (Function::GravityTorques, _) => arm.gravity_torques(q),
        (Function::BiasTorques, _) => arm.bias_torques(q, qd),
        (Function::InverseDynamicsWithWrench, Some(wrench)) => arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench),
        (_, _) => arm.inverse_dynamics(q, qd, qdd),
    }
}

fn trace(arm: &DynArm, state: &State) -> Result<DynTrace<f64>, rne::WrongLength> {
    let zero = vec![0.0; arm.dof()];
    let (qd, qdd) = (state.qd.as_ref().unwrap_or(&zero), state.qdd.as_ref().unwrap_or(&zero));
    arm.trace(&state.q, qd, qdd, &arm.fixed_base(), state.wrench.as_ref())
}

/// Checks that the function's arguments, all of them and no others, are there.
fn state(arguments: &Arguments, robot: &Robot) -> Result<State, Failure> {
    let function = arguments.function.unwrap_or(match arguments.wrench {
        Some(_) => Function::InverseDynamicsWithWrench,
        None => Function::InverseDynamics,
    });
    let (takes_qd, takes_qdd, takes_wrench) =
        (function.takes(Argument::Rates), function.takes(Argument::Accelerations), function.takes(Argument::Wrench));
    let joints: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    let per_joint = format!("one number for each joint of {}: {}", robot.name, joints.join(", "));
    let per_joint = |name, list, takes| argument(function, name, list, takes, robot.dof(), &per_joint);
    let q = per_joint("--q", arguments.q.as_ref(), true)?;
    let qd = per_joint("--qd", arguments.qd.as_ref(), takes_qd)?;
    let qdd = per_joint("--qdd", arguments.qdd.as_ref(), takes_qdd)?;
    let wrench = "three forces and three moments: fx,fy,fz,nx,ny,nz";
    let wrench = argument(function, "--wrench", arguments.wrench.as_ref(), takes_wrench, 6, wrench)?;
    let wrench = wrench.and_then(|wrench| match *wrench.as_slice() {
        [fx, fy, fz, nx, ny, nz] => Some(Wrench { force: [fx, fy, fz], moment: [nx, ny, nz] }),
        _ => None,
    });
    Ok(State { function, q: q.unwrap_or_default(), qd, qdd, wrench })
}

/// One argument of a function; `expected` numbers, in words `what`.
fn argument(
    function: Function,
    name: &str,
    list: Option<&List>,
    takes: bool,
    expected: usize,
    what: &str,
) -> Result<Option<Vec<f64>>, Failure> {
    match list {
        None if !takes => Ok(None),
        None => Err(Failure::usage(format_args!("{function} needs {name}, {what}"))),
        Some(_) if !takes => Err(Failure::usage(format_args!("{function} takes no {name}"))),
        Some(List(values)) if values.len() != expected => {
            let (found, numbers) = (values.len(), if expected == 1 { "number" } else { "numbers" });
            Err(Failure::usage(format_args!("{name} needs {expected} {numbers}, not {found}: {what}")))
        }
        Some(List(values)) => Ok(Some(values.clone())),
    }
}

/// State and torques, a line per joint.
fn table(robot: &Robot, state: &State, result: &[f64]) -> String {
    let column = |title: &str, values: Option<&[f64]>| -> Vec<String> {
        let numbers: Vec<String> = values.unwrap_or_default().iter().copied().map(exact).collect();
        let title = values.map_or("", |_| title);
        std::iter::once(title.to_owned()).chain(at_the_point(&numbers)).collect()
    };
    let q = column("q", Some(&state.q));
    let qd = column("qd", state.qd.as_deref());
    let qdd = column("qdd", state.qdd.as_deref());
    let torque = column("tau", Some(result));
    let cell = |column: &[String], line: usize| column.get(line).cloned().unwrap_or_default();
    let mut lines = vec![[String::new(), cell(&q, 0), cell(&qd, 0), cell(&qdd, 0), cell(&torque, 0), String::new()]];
    for (index, joint) in robot.joints.iter().enumerate() {
        let unit = match joint.row.kind {
            JointKind::Revolute => "N m",
            JointKind::Prismatic => "N",
        };
        let line = index + 1;
        let [q, qd, qdd, torque] = [&q, &qd, &qdd, &torque].map(|column| cell(column, line));
        lines.push([format!("  {}", joint.name), q, qd, qdd, torque, unit.to_owned()]);
    }
    let mut text = format!("{TITLE}{}{TITLE:#} of {}\n", state.function, robot.name);
    for (index, line) in columns([Align::Left; 6], &lines).iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "{QUIET}{line}{QUIET:#}"),
            _ => writeln!(text, "{line}"),
        };
    }
    if let Some(Wrench { force, moment }) = &state.wrench {
        let list = |values: &[f64; 3]| values.map(exact).join(", ");
        let _ = writeln!(text, "{QUIET}the last link exerts ({}) N, ({}) N m{QUIET:#}", list(force), list(moment));
    }
    text
}
