//! `rne eval`: numbers from the runtime, which loops over the links and knows nothing of generated code.

use clap::Args;
use rne::{DynArm, DynTrace};
use rne_codegen::{Answer, Function, Layout, Record};
use rne_model::Robot;
use serde::Serialize;
use serde_json::Value;

use crate::arm::{ChosenArm, Setting};
use crate::numbers::List;
use crate::outcome::{Failure, Outcome};
use crate::state::{Given, State};
use crate::worksheet::{self, Axes, Entry};
use crate::{answer, arguments, golden, limits};

/// Compute a function at one state; --trace shows every vector
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne eval robots/planar2.yaml --q 0.6,-1.1 --qd 1.3,-0.4 --qdd -0.7,2.1 --trace
  rne eval robots/planar2.yaml --golden 100 > robots/planar2.golden.csv
  rne eval robots/planar2.yaml --q 0.6,-1.1 --qd 0,0 --qdd 0,0 \\
      --wrench 3,-2,0,0,0,0.5 --json

One number per joint, base to tip: rad for a revolute, m for a prismatic joint;
pi/2 and 'deg(30)' are numbers. Every function takes exactly its arguments, and
nothing is assumed to be zero: `rne explain arguments`. Tables are rounded for
reading; --json has every digit, in the shape that the Rust function returns.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    arm: ChosenArm,
    /// Which function; inverse_dynamics, with --wrench or --payload that with it, unless given
    #[arg(long, value_name = "F", value_parser = arguments::function(), hide_possible_values = true)]
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
    /// Joint torques, N m or N, of forward_dynamics
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    tau: Option<List>,
    /// fx,fy,fz,nx,ny,nz on the environment, at the tip, in tip axes: N, N m
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    wrench: Option<List>,
    /// m,cx,cy,cz[,xx,yy,zz,xy,xz,yz] of what is fixed to the tip, in tip axes: kg, m, kg m²
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    payload: Option<List>,
    /// x,y,z of the angular velocity of a moving base, in frame 0, rad/s
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    base_omega: Option<List>,
    /// Its angular acceleration, rad/s²
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    base_omega_dot: Option<List>,
    /// Acceleration of its origin, without gravity, m/s²
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    base_acceleration: Option<List>,
    /// Acceleration of gravity in the frame 0 of a moving base, m/s²; the file's, unless given
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    gravity: Option<List>,
    /// A golden file instead: torques at N states, which `#[robot(…, tests)]` reads
    #[arg(long, value_name = "N", value_parser = golden::states, allow_negative_numbers = true, conflicts_with_all = [
        "function", "q", "qd", "qdd", "tau", "wrench", "payload", "base_omega", "base_omega_dot", "base_acceleration",
        "gravity", "trace", "json",
    ])]
    golden: Option<u16>,
    /// The seven-step worksheet: every vector
    #[arg(long)]
    trace: bool,
    /// Axes of the worksheet: link, fixed to link i, the generated code's; lecture, fixed to link i-1; base, of frame 0
    #[arg(long, value_enum, hide_possible_values = true, default_value_t = Axes::Link, requires = "trace")]
    axes: Axes,
    /// {"result": …}, with --trace also "trace"
    #[arg(long)]
    json: bool,
}

/// The answer as JSON has it.
#[derive(Serialize)]
struct Reply<'a> {
    result: Value,
    #[serde(skip_serializing_if = "Option::is_none")]
    trace: Option<Vec<Entry<'a>>>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = arguments.arm.robot()?;
    if let Some(states) = arguments.golden {
        let settings: Vec<String> =
            arguments.arm.set.iter().map(|Setting { name, value }| format!("{name} = {value}")).collect();
        return golden::file(&robot, states, &settings).map(Outcome::text);
    }
    let function = arguments.function.unwrap_or(match (&arguments.wrench, &arguments.payload) {
        (Some(_), _) => Function::InverseDynamicsWithWrench,
        (None, Some(_)) => Function::InverseDynamicsWithPayload,
        (None, None) => Function::InverseDynamics,
    });
    if arguments.trace && !function.returns_torques() {
        let with: Vec<&str> = Function::ALL.iter().filter(|f| f.returns_torques()).map(|f| f.name()).collect();
        return Err(Failure::usage(format_args!(
            "--trace is the worksheet of torques, and {function} has none; these have one: {}",
            with.join(", ")
        )));
    }
    let state = State::new(function, arguments.given(), &robot)?;
    let arm = DynArm::from_robot(&robot);
    // The lengths are checked, so this error does not occur; if it does, it says what is wrong.
    let numbers = state.numbers(&arm).map_err(Failure::usage)?;
    let trace = if arguments.trace { Some(trace(&arm, &state).map_err(Failure::usage)?) } else { None };
    if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
        return Err(Failure::input(not_finite(&robot, function, index)));
    }
    let links = trace.map(|trace| match arguments.axes {
        Axes::Link => trace.links,
        Axes::Lecture => trace.to_lecture(),
        Axes::Base => trace.to_base(),
    });
    let remark = limits::remark(&robot, &state.q);
    if arguments.json {
        let trace = links.as_ref().map(|links| worksheet::entries(&robot, links));
        let result = grouped(&function.layout(robot.dof()), &numbers);
        return Ok(Outcome { remark, ..Outcome::json(&Reply { result, trace })? });
    }
    let mut text = String::new();
    if let Some(links) = links {
        text.push_str(&worksheet::text(&robot, &links, arguments.axes, &state));
        text.push('\n');
    }
    text.push_str(&answer::text(&robot, &state, &numbers));
    Ok(Outcome { remark, ..Outcome::text(text) })
}

impl Arguments {
    fn given(&self) -> Given<'_> {
        Given {
            q: self.q.as_ref(),
            qd: self.qd.as_ref(),
            qdd: self.qdd.as_ref(),
            tau: self.tau.as_ref(),
            wrench: self.wrench.as_ref(),
            payload: self.payload.as_ref(),
            base_omega: self.base_omega.as_ref(),
            base_omega_dot: self.base_omega_dot.as_ref(),
            base_acceleration: self.base_acceleration.as_ref(),
            gravity: self.gravity.as_ref(),
        }
    }
}

fn trace(arm: &DynArm, state: &State) -> Result<DynTrace<f64>, rne::WrongLength> {
    let zero = vec![0.0; arm.dof()];
    // what the function does not take is at rest
    let [qd, qdd] = [&state.qd, &state.qdd].map(|values| if values.is_empty() { &zero } else { values });
    match &state.payload {
        Some(payload) => arm.trace_with_payload(&state.q, qd, qdd, payload),
        None => arm.trace(&state.q, qd, qdd, &state.base, state.wrench.as_ref()),
    }
}

/// Numbers in the shape in which a function returns them.
fn grouped(layout: &Layout, numbers: &[f64]) -> Value {
    let record = |record: Record, parts| {
        let fields = record.fields().into_iter().map(str::to_owned);
        Value::Object(fields.zip::<Vec<Value>>(parts).collect())
    };
    layout.fold(&mut numbers.iter().map(|&number| Value::from(number)), &Value::Array, &record).unwrap_or_default()
}

/// Why a number is none.
pub(crate) fn not_finite(robot: &Robot, function: Function, index: usize) -> String {
    let joint = |index: usize| {
        let name = robot.joints.get(index).map_or("", |joint| &joint.name);
        format!("joint {} ({name})", index + 1)
    };
    if let Some(meaning) = function.divides() {
        return meaning.to_owned();
    }
    if *function.answer() == Answer::Torques {
        return format!("the torque of {} overflows: the state is too large", joint(index));
    }
    format!("{function} overflows: the state is too large")
}
