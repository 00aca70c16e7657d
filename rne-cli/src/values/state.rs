//! Arguments of a function, complete and of the right lengths.

use std::str::FromStr;

use rne::{BaseMotion, BaseTwist, DynArm, Inputs, Payload, Pose, Quaternion, Wrench, WrongLength};
use rne_codegen::{Argument, Capability, Function};
use rne_model::{Robot, nearest_name};

use crate::outcome::Failure;
use crate::values::closure;
use crate::values::numbers::List;

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The lists of the command line, where they are given.
#[derive(Clone, Copy, Default)]
pub(crate) struct Given<'a> {
    pub(crate) q: Option<&'a List>,
    pub(crate) passive: Option<&'a List>,
    pub(crate) qd: Option<&'a List>,
    pub(crate) qdd: Option<&'a List>,
    pub(crate) tau: Option<&'a List>,
    pub(crate) duration: Option<&'a List>,
    pub(crate) multipliers: Option<&'a List>,
    pub(crate) wrench: Option<&'a List>,
    pub(crate) tip_wrenches: &'a [TipWrench],
    pub(crate) payload: Option<&'a List>,
    pub(crate) base_omega: Option<&'a List>,
    pub(crate) base_omega_dot: Option<&'a List>,
    pub(crate) base_acceleration: Option<&'a List>,
    pub(crate) base_velocity: Option<&'a List>,
    pub(crate) base_pose: Option<&'a List>,
    pub(crate) gravity: Option<&'a List>,
    pub(crate) base_rotation: Option<&'a List>,
}

impl<'a> Given<'a> {
    /// The lists with q, q̇ and q̈ of a state, where no positions are given.
    pub(crate) fn or_state(mut self, state: &'a [Option<List>; 3]) -> Self {
        if self.q.is_none() {
            for (own, of_state) in [&mut self.q, &mut self.qd, &mut self.qdd].into_iter().zip(state) {
                *own = own.or(of_state.as_ref());
            }
        }
        self
    }

    /// The lists with zeros for velocities and accelerations that a function takes and that are not given, of the
    /// joints, of a base that moves and of its pose; with their options. `zeros` has a number for each joint, three for
    /// the base and six for its pose.
    pub(crate) fn at_rest(mut self, function: Function, zeros: [&'a List; 3]) -> (Self, Vec<&'static str>) {
        use Argument::{Accelerations, Base, BasePose, BaseTwist, BaseVelocity, Rates};
        let (mut assumed, [of_joints, of_base, of_pose]) = (Vec::new(), zeros);
        let turning = [BaseTwist, BaseVelocity].into_iter().find(|kind| function.takes(*kind)).unwrap_or(Base);
        let lists = [
            ("--qd", &mut self.qd, Rates, of_joints),
            ("--qdd", &mut self.qdd, Accelerations, of_joints),
            ("--base-velocity", &mut self.base_velocity, BaseTwist, of_base),
            ("--base-omega", &mut self.base_omega, turning, of_base),
            ("--base-omega-dot", &mut self.base_omega_dot, Base, of_base),
            ("--base-acceleration", &mut self.base_acceleration, Base, of_base),
            ("--base-pose", &mut self.base_pose, BasePose, of_pose),
        ];
        for (name, list, kind, zeros) in lists {
            if list.is_none() && function.takes(kind) {
                *list = Some(zeros);
                assumed.push(name);
            }
        }
        (self, assumed)
    }
}

/// The arguments of a function. What it does not take is empty, zero, or at rest, or is not asked for.
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) function: Function,
    pub(crate) q: Vec<f64>,
    /// Positions of the dependent joints of closed loops.
    pub(crate) passive: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) tau: Vec<f64>,
    /// The duration of a step.
    pub(crate) step: f64,
    pub(crate) multipliers: Vec<f64>,
    pub(crate) wrench: Option<Wrench<f64>>,
    /// One for each tip.
    pub(crate) wrenches: Vec<Wrench<f64>>,
    pub(crate) payload: Option<Payload<f64>>,
    pub(crate) base: BaseMotion<f64>,
    /// The pose of frame 0 in the world.
    pub(crate) pose: Pose<f64>,
    /// Its columns are the axes of frame 0 in the world.
    pub(crate) base_rotation: [[f64; 3]; 3],
}

impl State {
    /// Checks that the function's arguments, all of them and no others, are there.
    pub(crate) fn new(function: Function, given: Given<'_>, robot: &Robot) -> Result<Self, Failure> {
        use Argument::{Accelerations, Base, Positions, Rates, Torques};
        let joints: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
        let which = if robot.closed.is_empty() { "" } else { " that is not dependent" };
        let per_joint = format!("one number for each joint of {}{which}: {}", robot.name, joints.join(", "));
        let of_joints = |name, list, kind| argument(function, name, list, kind, robot.dof(), &per_joint);
        let q = of_joints("--q", given.q, Positions)?;
        let passive = passive(function, given.passive, q.as_deref(), robot)?;
        let qd = of_joints("--qd", given.qd, Rates)?;
        let qdd = of_joints("--qdd", given.qdd, Accelerations)?;
        let tau = of_joints("--tau", given.tau, Torques)?;
        let seconds = "the duration of the step in seconds, one number";
        let step = argument(function, "--duration", given.duration, Argument::Step, 1, seconds)?;
        let step = step.and_then(|list| list.first().copied()).unwrap_or_default();
        let multipliers = of_joints("--multipliers", given.multipliers, Argument::Multipliers)?;
        let wrench = "three forces and three moments: fx,fy,fz,nx,ny,nz";
        let wrench = argument(function, "--wrench", given.wrench, Argument::Wrench, 6, wrench)?;
        let wrench = wrench.map(|w| Wrench { force: triple(&w, 0), moment: triple(&w, 3) });
        let wrenches = tip_wrenches(function, given.tip_wrenches, robot)?;
        let payload = match given.payload {
            Some(list) => Some(payload(list)?),
            None if function.takes(Argument::Payload) => {
                return Err(Failure::usage(format_args!("{function} needs --payload, {PAYLOAD}")));
            }
            None => None,
        };
        let axes = "three numbers x,y,z, in the axes of frame 0";
        let of_base = |name, list| {
            let kind = match name {
                "--base-velocity" => Argument::BaseTwist,
                "--base-omega" if function.takes(Argument::BaseVelocity) => Argument::BaseVelocity,
                "--base-omega" if function.takes(Argument::BaseTwist) => Argument::BaseTwist,
                _ => Base,
            };
            let list = argument(function, name, list, kind, 3, axes)?;
            Ok::<_, Failure>(list.map_or([0.0; 3], |list| triple(&list, 0)))
        };
        let base = BaseMotion {
            omega: of_base("--base-omega", given.base_omega)?,
            omega_dot: of_base("--base-omega-dot", given.base_omega_dot)?,
            velocity: of_base("--base-velocity", given.base_velocity)?,
            acceleration: of_base("--base-acceleration", given.base_acceleration)?,
            // a base that only moves stays under the gravity of the file
            gravity: if given.gravity.is_some() { of_base("--gravity", given.gravity)? } else { robot.gravity },
        };
        let rows = "nine numbers, row by row; its columns are the axes of frame 0 in the world";
        let base_rotation = match given.base_rotation {
            // the world has the axes of frame 0
            None => IDENTITY,
            list => argument(function, "--base-rotation", list, Argument::BaseRotation, 9, rows)?
                .map_or(Ok(IDENTITY), |list| rotation("--base-rotation", &list))?,
        };
        let [q, qd, qdd, tau, multipliers] = [q, qd, qdd, tau, multipliers].map(Option::unwrap_or_default);
        let pose = pose_of_base(function, given.base_pose)?;
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

    /// The numbers of an argument that says how the joints move and what drives them.
    pub(crate) fn of_joints(&self, argument: Argument) -> Option<&[f64]> {
        match argument {
            Argument::Positions => Some(&self.q),
            Argument::Rates => Some(&self.qd),
            Argument::Accelerations => Some(&self.qdd),
            Argument::Torques => Some(&self.tau),
            _ => None,
        }
    }

    /// The velocity of a base that nothing holds.
    pub(crate) const fn twist(&self) -> BaseTwist<f64> {
        BaseTwist { linear: self.base.velocity, angular: self.base.omega }
    }

    /// The arguments for another function.
    pub(crate) fn of(&self, function: Function) -> Self {
        Self { function, ..self.clone() }
    }

    /// The function's result, in the order of its layout.
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

/// Positions of the dependent joints of closed loops: those that close the loops, from the given ones. A Newton step
/// takes the given ones as they are.
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
        Some(given) if function == Function::ClosureStep => Ok(given),
        given => closure::closed(robot, q, given.as_deref()),
    }
}

/// The numbers of a payload in words.
const PAYLOAD: &str =
    "mass, centre of mass and inertia about it: m,cx,cy,cz,xx,yy,zz,xy,xz,yz; or m,cx,cy,cz of a point";

/// A payload from its list: mass and centre of mass, and inertia where it is given.
pub(crate) fn payload(List(values): &List) -> Result<Payload<f64>, Failure> {
    if values.len() != 4 && values.len() != 10 {
        let found = values.len();
        return Err(Failure::usage(format_args!("--payload needs 10 numbers, not {found}: {PAYLOAD}")));
    }
    let mut all = [0.0; 10];
    all.iter_mut().zip(values).for_each(|(number, value)| *number = *value);
    let payload = Payload::from_array(all);
    payload.check().map_err(|error| Failure::usage(format_args!("--payload: {error}")))?;
    payload.inertia.check_of_payload().map_err(|error| Failure::usage(format_args!("--payload: {error}")))?;
    Ok(payload)
}

/// The numbers of a pose in words.
const POSE: &str = "position and rotation of frame 0 in the world: x,y,z,roll,pitch,yaw; or the rows of the rotation \
                    matrix, then x,y,z";

/// A pose from its list: a position with three angles, as in the robot file, or with a rotation matrix before it.
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

/// The conditions for a rotation.
const ROTATION: &str = "its three rows must have the length 1, be at right angles to each other, and be right-handed";

/// The rotation of these nine numbers, row by row.
fn rotation(name: &str, numbers: &[f64]) -> Result<[[f64; 3]; 3], Failure> {
    let rotation = [0, 3, 6].map(|row| triple(numbers, row));
    if (Pose { rotation, translation: [0.0; 3] }).is_rigid() {
        return Ok(rotation);
    }
    Err(Failure::usage(format_args!("{name} is no rotation: {ROTATION}")))
}

/// The wrench at a tip: `left=0,0,-5,0,0,0`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TipWrench {
    tip: String,
    numbers: List,
}

impl FromStr for TipWrench {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (tip, numbers) = text.split_once('=').ok_or("write NAME=fx,fy,fz,nx,ny,nz, such as left=0,0,-5,0,0,0")?;
        let numbers: List = numbers.parse()?;
        match numbers.0.len() {
            6 => Ok(Self { tip: tip.trim().to_owned(), numbers }),
            found => Err(format!("a wrench has 6 numbers, not {found}: fx,fy,fz,nx,ny,nz")),
        }
    }
}

/// The wrench at each tip of a robot, for a function that takes them: that of the command line, or zero.
fn tip_wrenches(function: Function, given: &[TipWrench], robot: &Robot) -> Result<Vec<Wrench<f64>>, Failure> {
    let names = robot.tip_names();
    if !function.takes(Argument::Wrenches) {
        let refused = given.first().map(|_| not_taken(function, "--tip-wrench", Argument::Wrenches));
        return refused.map_or(Ok(Vec::new()), Err);
    }
    let mut wrenches = vec![Wrench::zero(); names.len()];
    if given.is_empty() && !function.is_of_floating_base() {
        return Err(Failure::usage(format_args!(
            "{function} needs --tip-wrench NAME=fx,fy,fz,nx,ny,nz for at least one tip of {}: `{}`",
            robot.name,
            names.join("`, `")
        )));
    }
    for (index, TipWrench { tip, numbers: List(numbers) }) in given.iter().enumerate() {
        if let Some(two) = robot.two_tips(tip) {
            return Err(Failure::usage(two));
        }
        let Some(place) = names.iter().position(|name| name == tip) else {
            if robot.frames.iter().any(|frame| frame.name == *tip) {
                let listed = if robot.tips.is_empty() { tip.clone() } else { format!("{}, {tip}", names.join(", ")) };
                return Err(Failure::usage(format_args!(
                    "`{tip}` is a frame of {}, but not a tip; list it under `tips` of the robot file: tips: [{listed}]",
                    robot.name
                )));
            }
            let meant = nearest_name(tip, &names).map(|meant| format!("; did you mean `{meant}`?"));
            return Err(Failure::usage(format_args!(
                "{} has no tip `{tip}`; its tips are `{}`{}",
                robot.name,
                names.join("`, `"),
                meant.unwrap_or_default()
            )));
        };
        if given[..index].iter().any(|other| other.tip == *tip) {
            return Err(Failure::usage(format_args!("--tip-wrench gives the wrench at `{tip}` twice")));
        }
        wrenches[place] = Wrench { force: triple(numbers, 0), moment: triple(numbers, 3) };
    }
    Ok(wrenches)
}

fn triple(list: &[f64], from: usize) -> [f64; 3] {
    [0, 1, 2].map(|index| list.get(from + index).copied().unwrap_or_default())
}

/// The most functions that a message names.
const MOST_NAMED: usize = 6;

/// One argument of a function; `expected` numbers, in words `what`.
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
        None => Err(Failure::usage(format_args!("{function} needs {name}, {what}"))),
        Some(_) if !function.takes(kind) => Err(not_taken(function, name, kind)),
        Some(List(values)) if values.len() != expected => {
            let (found, numbers) = (values.len(), if expected == 1 { "number" } else { "numbers" });
            Err(Failure::usage(format_args!("{name} needs {expected} {numbers}, not {found}: {what}")))
        }
        Some(List(values)) => Ok(Some(values.clone())),
    }
}

/// The option of `rne eval` for an argument of a function.
const fn option(argument: Argument) -> &'static str {
    match argument {
        Argument::Positions => "--q",
        // those of the positions
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

/// The options of `rne eval` for a function, in the order of its arguments.
pub(crate) fn options(function: Function) -> String {
    let options = function.arguments().iter().map(|argument| option(*argument)).filter(|option| !option.is_empty());
    options.collect::<Vec<_>>().join(" ")
}

/// The error of an option that a function does not take, with the functions that do.
fn not_taken(function: Function, name: &str, kind: Argument) -> Failure {
    // --payload chooses the others
    // no robot has functions of closed loops and others
    let is_named = |other: &Function| {
        other.takes(kind)
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
    Failure::usage(format_args!("{function} takes no {name}{hint}"))
}
