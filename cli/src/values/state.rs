//! The arguments of a function, complete and with the right lengths.

use clap::Args;
use rne::{BaseMotion, BaseTwist, DynArm, Inputs, Payload, Pose, Quaternion, Wrench, WrongLength};
use rne_codegen::{Argument, Capability, Function};
use rne_model::Robot;

use crate::outcome::Failure;
use crate::values::closure;
use crate::values::numbers::{List, duration};
use crate::values::payload::{PAYLOAD, payload};
use crate::values::tip_wrench::{TipWrench, tip_wrenches};

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The arguments of a function on the command line, where they are given.
#[derive(Args, Clone, Default)]
pub(crate) struct Given {
    /// Joint positions, base to tip, rad or m
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) q: Option<List>,
    /// Joint velocities, rad/s or m/s [default: 0]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) qd: Option<List>,
    /// Joint accelerations, rad/s² or m/s² [default: 0]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) qdd: Option<List>,
    /// Joint torques for forward_dynamics, N m or N
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) tau: Option<List>,
    /// Duration of the step of an integrator, s
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = duration())]
    pub(crate) duration: Option<List>,
    /// Multipliers for torque_gradient, torque_hessian
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) multipliers: Option<List>,
    /// Wrench by the tip: fx,fy,fz,nx,ny,nz, tip axes
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) wrench: Option<List>,
    /// A wrench at the tip N of `tips`; may be repeated
    #[arg(long, value_name = "N=LIST", allow_hyphen_values = true)]
    pub(crate) tip_wrench: Vec<TipWrench>,
    /// Guess of the dependent joints of closed loops
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) passive: Option<List>,
    /// Angular velocity of the base, rad/s [default: 0]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub(crate) base_omega: Option<List>,
    /// Its angular acceleration, rad/s² [default: 0]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub(crate) base_omega_dot: Option<List>,
    /// Its acceleration, m/s² [default: 0]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub(crate) base_acceleration: Option<List>,
    /// Velocity of its origin, m/s [default: 0]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub(crate) base_velocity: Option<List>,
    /// Frame 0 in the world, x,y,z,roll,pitch,yaw
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) base_pose: Option<List>,
    /// Gravity in frame 0, x,y,z, m/s² [default: FILE]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub(crate) gravity: Option<List>,
    /// Rotation of the base, 9 numbers [default: 1]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) base_rotation: Option<List>,
    /// Payload, which the options of the robot have.
    #[arg(skip)]
    pub(crate) payload: Option<List>,
}

impl Given {
    /// Uses q, q̇ and q̈ of a state if no positions are given.
    pub(crate) fn or_state(mut self, state: [Option<List>; 3]) -> Self {
        if self.q.is_none() {
            for (own, of_state) in [&mut self.q, &mut self.qd, &mut self.qdd].into_iter().zip(state) {
                *own = own.take().or(of_state);
            }
        }
        self
    }

    /// Sets velocities and accelerations that a function takes and that are not given to zero: those of the joints, of
    /// a moving base, and its pose. Returns the lists, and the options that were assumed.
    pub(crate) fn at_rest(mut self, function: Function, dof: usize) -> (Self, Vec<&'static str>) {
        use Argument::{Accelerations, Base, BasePose, BaseTwist, BaseVelocity, Rates};
        let mut assumed = Vec::new();
        let turning = [BaseTwist, BaseVelocity].into_iter().find(|kind| function.takes(*kind)).unwrap_or(Base);
        let lists = [
            ("--qd", &mut self.qd, Rates, dof),
            ("--qdd", &mut self.qdd, Accelerations, dof),
            ("--base-velocity", &mut self.base_velocity, BaseTwist, 3),
            ("--base-omega", &mut self.base_omega, turning, 3),
            ("--base-omega-dot", &mut self.base_omega_dot, Base, 3),
            ("--base-acceleration", &mut self.base_acceleration, Base, 3),
            ("--base-pose", &mut self.base_pose, BasePose, 6),
        ];
        for (name, list, kind, count) in lists {
            if list.is_none() && function.takes(kind) {
                *list = Some(List(vec![0.0; count]));
                assumed.push(name);
            }
        }
        (self, assumed)
    }
}

/// The arguments of a function. Those that it does not take are empty, zero or `None`.
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) function: Function,
    pub(crate) q: Vec<f64>,
    /// Positions of the dependent joints of closed loops.
    pub(crate) passive: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) tau: Vec<f64>,
    /// Duration of a step of an integrator, s.
    pub(crate) step: f64,
    pub(crate) multipliers: Vec<f64>,
    pub(crate) wrench: Option<Wrench<f64>>,
    /// A wrench for each tip.
    pub(crate) wrenches: Vec<Wrench<f64>>,
    pub(crate) payload: Option<Payload<f64>>,
    pub(crate) base: BaseMotion<f64>,
    /// The pose of frame 0 in the world.
    pub(crate) pose: Pose<f64>,
    /// Rotation matrix of the base; its columns are the axes of frame 0 in the world.
    pub(crate) base_rotation: [[f64; 3]; 3],
}

impl State {
    /// Checks that all arguments of the function are given, and no others, and completes them.
    pub(crate) fn new(function: Function, given: &Given, robot: &Robot) -> Result<Self, Failure> {
        use Argument::{Accelerations, Positions, Rates, Torques};
        let joints: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
        let which = if robot.closed.is_empty() { "" } else { " that is not dependent" };
        let per_joint = format!("one number for each joint of {}{which}: {}", robot.name, joints.join(", "));
        let of_joints = |name, list, kind| argument(function, name, list, kind, robot.dof(), &per_joint);
        let q = of_joints("--q", given.q.as_ref(), Positions)?;
        let passive = passive(function, given.passive.as_ref(), q.as_deref(), robot)?;
        let qd = of_joints("--qd", given.qd.as_ref(), Rates)?;
        let qdd = of_joints("--qdd", given.qdd.as_ref(), Accelerations)?;
        let tau = of_joints("--tau", given.tau.as_ref(), Torques)?;
        let seconds = "the duration of the step in seconds, one number";
        let step = argument(function, "--duration", given.duration.as_ref(), Argument::Step, 1, seconds)?;
        let step = step.and_then(|list| list.first().copied()).unwrap_or_default();
        let multipliers = of_joints("--multipliers", given.multipliers.as_ref(), Argument::Multipliers)?;
        let wrench = "three forces and three moments: fx,fy,fz,nx,ny,nz";
        let wrench = argument(function, "--wrench", given.wrench.as_ref(), Argument::Wrench, 6, wrench)?;
        let wrench = wrench.map(|w| Wrench { force: triple(&w, 0), moment: triple(&w, 3) });
        let wrenches = tip_wrenches(function, &given.tip_wrench, robot)?;
        let payload = match &given.payload {
            Some(list) => Some(payload(list)?),
            None if function.takes(Argument::Payload) => {
                return Err(usage_error!("{function} needs --payload, {PAYLOAD}"));
            }
            None => None,
        };
        let base = motion_of_base(function, given, robot)?;
        let rows = "nine numbers, row by row; its columns are the axes of frame 0 in the world";
        let base_rotation = match given.base_rotation.as_ref() {
            // the default is a world with the axes of frame 0
            None => IDENTITY,
            list => argument(function, "--base-rotation", list, Argument::BaseRotation, 9, rows)?
                .map_or(Ok(IDENTITY), |list| rotation("--base-rotation", &list))?,
        };
        let [q, qd, qdd, tau, multipliers] = [q, qd, qdd, tau, multipliers].map(Option::unwrap_or_default);
        let pose = pose_of_base(function, given.base_pose.as_ref())?;
        Ok(Self {
            function,
            q,
            passive,
            qd,
            qdd,
            tau,
            step,
            multipliers,
            wrench,
            wrenches,
            payload,
            base,
            pose,
            base_rotation,
        })
    }

    /// Returns the numbers of an argument that has an element for each joint; `None` for other arguments.
    pub(crate) fn of_joints(&self, argument: Argument) -> Option<&[f64]> {
        match argument {
            Argument::Positions => Some(&self.q),
            Argument::Rates => Some(&self.qd),
            Argument::Accelerations => Some(&self.qdd),
            Argument::Torques => Some(&self.tau),
            _ => None,
        }
    }

    /// Returns the velocity of a floating base.
    pub(crate) const fn twist(&self) -> BaseTwist<f64> {
        BaseTwist { linear: self.base.velocity, angular: self.base.omega }
    }

    /// Returns the same arguments for another function.
    pub(crate) fn of(&self, function: Function) -> Self {
        Self { function, ..self.clone() }
    }

    /// Computes the result of the function, in the order of its layout.
    pub(crate) fn numbers(&self, arm: &DynArm) -> Result<Vec<f64>, WrongLength> {
        let Self { q, passive, qd, qdd, tau, multipliers, wrenches, base, pose, base_rotation, step, .. } = self;
        let (sin, cos): (Vec<f64>, Vec<f64>) = q.iter().map(|&q| rne::Scalar::sin_cos(q)).unzip();
        let inputs = Inputs {
            q,
            qd,
            qdd,
            tau,
            sin: &sin,
            cos: &cos,
            passive,
            multipliers,
            wrench: &self.wrench.unwrap_or_default(),
            wrenches,
            payload: &self.payload.unwrap_or_default(),
            base,
            omega: &base.omega,
            twist: &self.twist(),
            pose,
            base_rotation,
            step: *step,
        };
        arm.evaluate(self.function, &inputs)
    }
}

/// Returns positions of the dependent joints that close the loops, beginning at the given positions. For a Newton step
/// the given positions are used without change.
fn passive(function: Function, list: Option<&List>, q: Option<&[f64]>, robot: &Robot) -> Result<Vec<f64>, Failure> {
    if !function.takes(Argument::Passive) {
        let refused = list.map(|_| not_taken(function, "--passive", Argument::Passive));
        return refused.map_or(Ok(Vec::new()), Err);
    }
    let Some(q) = q else { return Ok(Vec::new()) };
    let names: Vec<_> = robot.closed.passive.iter().map(|&at| robot.joints[at].name.as_str()).collect();
    let each = format!("one number for each dependent joint of {}: {}", robot.name, names.join(", "));
    let given = match list {
        Some(_) => argument(function, "--passive", list, Argument::Passive, names.len(), &each)?,
        None => None,
    };
    match given {
        Some(given) if function.closes_loops() => Ok(given),
        given => closure::closed(robot, q, given.as_deref()),
    }
}

/// Returns the motion of the base, which is at rest where it is not given, and gravity.
fn motion_of_base(function: Function, given: &Given, robot: &Robot) -> Result<BaseMotion<f64>, Failure> {
    let axes = "three numbers x,y,z, in the axes of frame 0";
    let of_base = |name, list: &Option<List>| {
        let kind = match name {
            "--base-velocity" => Argument::BaseTwist,
            "--base-omega" if function.takes(Argument::BaseVelocity) => Argument::BaseVelocity,
            "--base-omega" if function.takes(Argument::BaseTwist) => Argument::BaseTwist,
            _ => Argument::Base,
        };
        let list = argument(function, name, list.as_ref(), kind, 3, axes)?;
        Ok::<_, Failure>(list.map_or([0.0; 3], |list| triple(&list, 0)))
    };
    Ok(BaseMotion {
        omega: of_base("--base-omega", &given.base_omega)?,
        omega_dot: of_base("--base-omega-dot", &given.base_omega_dot)?,
        velocity: of_base("--base-velocity", &given.base_velocity)?,
        acceleration: of_base("--base-acceleration", &given.base_acceleration)?,
        // without `--gravity`, a moving base has the gravity of the file
        gravity: if given.gravity.is_some() { of_base("--gravity", &given.gravity)? } else { robot.gravity },
    })
}

/// The numbers of a pose in words, for messages.
const POSE: &str = "position and rotation of frame 0 in the world: x,y,z,roll,pitch,yaw; or the rows of the rotation \
                    matrix, then x,y,z";

/// Makes a pose from a list: a position and three angles, as in the robot file; or a rotation matrix and a position.
fn pose_of_base(function: Function, given: Option<&List>) -> Result<Pose<f64>, Failure> {
    let Some(List(values)) = given else {
        return argument(function, "--base-pose", None, Argument::BasePose, 6, POSE).map(|_| Pose::identity());
    };
    let expected = if values.len() == 12 { 12 } else { 6 };
    argument(function, "--base-pose", given, Argument::BasePose, expected, POSE)?;
    if let [rows @ .., x, y, z] = &values[..]
        && rows.len() == 9
    {
        return Ok(Pose { rotation: rotation("--base-pose", rows)?, translation: [*x, *y, *z] });
    }
    let [roll, pitch, yaw] = triple(values, 3);
    let turn =
        Quaternion::identity().turned_by([0.0, 0.0, yaw]).turned_by([0.0, pitch, 0.0]).turned_by([roll, 0.0, 0.0]);
    Ok(Pose { rotation: turn.rotation(), translation: triple(values, 0) })
}

/// The conditions for a rotation matrix in words, for messages.
const ROTATION: &str = "its three rows must have the length 1, be at right angles to each other, and be right-handed";

/// Makes a rotation matrix from nine numbers, row by row.
fn rotation(name: &str, numbers: &[f64]) -> Result<[[f64; 3]; 3], Failure> {
    let rotation = [0, 3, 6].map(|row| triple(numbers, row));
    if (Pose { rotation, translation: [0.0; 3] }).is_rigid() {
        return Ok(rotation);
    }
    Err(usage_error!("{name} is no rotation: {ROTATION}"))
}

pub(super) fn triple(list: &[f64], from: usize) -> [f64; 3] {
    [0, 1, 2].map(|index| list.get(from + index).copied().unwrap_or_default())
}

/// Largest number of functions that a message names.
const MOST_NAMED: usize = 6;

/// Returns the numbers of an argument of a function; it must have `expected` numbers, which `what` describes.
fn argument(
    function: Function,
    name: &str,
    list: Option<&List>,
    kind: Argument,
    expected: usize,
    what: &str,
) -> Result<Option<Vec<f64>>, Failure> {
    match list {
        None if !function.takes(kind) => Ok(None),
        None => Err(usage_error!("{function} needs {name}, {what}")),
        Some(_) if !function.takes(kind) => Err(not_taken(function, name, kind)),
        Some(List(values)) if values.len() != expected => {
            let (found, numbers) = (values.len(), if expected == 1 { "number" } else { "numbers" });
            Err(usage_error!("{name} needs {expected} {numbers}, not {found}: {what}"))
        }
        Some(List(values)) => Ok(Some(values.clone())),
    }
}

/// Returns the options of `rne eval` for an argument of a function.
const fn option(argument: Argument) -> &'static str {
    match argument {
        Argument::Positions => "--q",
        // sines and cosines are computed from the positions
        Argument::Sines | Argument::Cosines => "",
        Argument::Rates => "--qd",
        Argument::Accelerations => "--qdd",
        Argument::Torques => "--tau",
        Argument::Multipliers => "--multipliers",
        Argument::Step => "--duration",
        Argument::Wrench => "--wrench",
        Argument::Wrenches => "--tip-wrench",
        Argument::Payload => "--payload",
        Argument::Base => "--base-omega --base-omega-dot --base-acceleration --gravity",
        Argument::BaseVelocity => "--base-omega",
        Argument::BaseTwist => "--base-velocity --base-omega",
        Argument::BasePose => "--base-pose",
        Argument::BaseRotation => "--base-rotation",
        Argument::Passive => "--passive",
    }
}

/// Returns the options of `rne eval` for a function, in the order of its arguments.
pub(crate) fn options(function: Function) -> String {
    let options = function.arguments().iter().map(|argument| option(*argument)).filter(|option| !option.is_empty());
    options.collect::<Vec<_>>().join(" ")
}

/// Makes the error for an option that a function does not take; it names functions that do.
pub(super) fn not_taken(function: Function, name: &str, kind: Argument) -> Failure {
    // variants with a payload are not named, because `--payload` chooses them; and functions of closed loops are for
    // other robots than functions without loops
    let is_named = |other: &Function| {
        other.arguments().iter().any(|argument| option(*argument).split(' ').any(|option| option == name))
            && other.capability() != Capability::PayloadDynamics
            && other.is_of_closed_loops() == function.is_of_closed_loops()
    };
    let others: Vec<String> = Function::ALL.iter().filter(|other| is_named(other)).map(ToString::to_string).collect();
    let variant = format!("{function}_with_wrenches");
    let hint = match others.as_slice() {
        _ if kind == Argument::Wrench && Function::ALL.iter().any(|other| other.name() == variant) => {
            format!("; {variant} takes it as --tip-wrench TIP=…, with the name of a tip, or `tip`")
        }
        _ if kind == Argument::Wrench && function.takes(Argument::Wrenches) => {
            "; give it as --tip-wrench TIP=…, with the name of a tip, or `tip`".to_owned()
        }
        [only] => format!("; {only} does"),
        [some @ .., last] if others.len() <= MOST_NAMED => format!("; {} and {last} do", some.join(", ")),
        [] => String::new(),
        _ => "; `rne explain arguments` lists the functions that do".to_owned(),
    };
    usage_error!("{function} takes no {name}{hint}")
}
