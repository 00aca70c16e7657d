//! `rne eval`: computes numbers with the runtime, which loops over the links and is independent of generated code.

pub(super) mod compare;
pub(super) mod golden;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne::DynArm;
use rne_codegen::CheckFor as _;
use rne_codegen::{Argument, Function, Record, Step};
use rne_diagnose::worksheet::{Quantity, Worksheet};
use rne_machine::CompiledArm;
use rne_model::Robot;
use serde_json::{Value, json};

use crate::commands::eval::compare::Manner;
use crate::files::chosen_arm::{AtFrame, ChosenArm, Setting};
use crate::files::input_file::is_standard_input;
use crate::files::plan_file;
use crate::files::states;
use crate::files::worksheet_file::{self, Filled};
use crate::files::worksheet_text;
use crate::outcome::{Failure, Outcome};
use crate::palette::QUIET;
use crate::render::answer;
use crate::render::answer::not_finite;
use crate::render::layout::PAGE;
use crate::render::letters::Letters;
use crate::render::worksheet::{self, Axes, Narrowed};
use crate::values::choice;
use crate::values::closure;
use crate::values::definite::{BUT_FOR_ROUNDING, NOT_DEFINITE, is_indefinite, is_singular};
use crate::values::limits;
use crate::values::numbers::List;
use crate::values::payload::payload;
use crate::values::state::{Given, State};

/// Compute torques, or another function of an arm, at given states
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne eval planar1 --q 0.3 --qd 0.5 --qdd 1 --trace --csv > mine.csv
  rne eval planar1 --trace --compare mine.csv
  rne eval robots/planar2.yaml --states docs/states.csv -o torques.csv")]
#[allow(clippy::struct_excessive_bools)] // each is an option
pub(crate) struct Arguments {
    #[command(flatten)]
    arm: ChosenArm,
    #[command(flatten)]
    at: AtFrame,
    /// Function to compute [default: inverse_dynamics]
    #[arg(long, value_name = "F", value_parser = choice::function(), hide_possible_values = true)]
    function: Option<Function>,
    #[command(flatten)]
    given: Given,
    /// Print a golden file of torques at N random states
    #[arg(long, value_name = "N", value_parser = golden::states, allow_negative_numbers = true, conflicts_with_all = [
        "function", "Given", "payload", "payload_on", "trace", "axes", "joint", "step", "json", "csv", "compare",
        "digits", "hint", "frame", "out", "force",
    ])]
    golden: Option<u16>,
    /// Compute it at each state of a table; - is stdin
    #[arg(long, value_name = "TABLE", conflicts_with_all = [
        "Given", "payload", "payload_on", "hint", "golden", "trace", "axes", "joint", "step", "json", "csv", "compare",
        "digits",
    ])]
    states: Option<PathBuf>,
    /// Output file of --states: CSV, or NAME.npy
    #[arg(short, long = "output", value_name = "TABLE", requires = "states")]
    out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, requires = "out", hide = true)]
    force: bool,
    /// Print every intermediate value of the seven steps
    #[arg(long)]
    trace: bool,
    /// Axes of --trace: link (default), joint, base
    #[arg(long, value_enum, hide_possible_values = true, requires = "trace")]
    axes: Option<Axes>,
    /// Print only a joint of --trace, number or name
    #[arg(long, value_name = "JOINT", requires = "trace", conflicts_with = "compare")]
    joint: Option<String>,
    /// Print only step S of --trace, 1 to 7
    #[arg(long, value_name = "S", value_parser = choice::step, requires = "trace", conflicts_with = "compare")]
    step: Option<Step>,
    /// Print the values of --trace as CSV
    #[arg(long, requires = "trace", conflicts_with_all = ["json", "compare"])]
    csv: bool,
    /// With --trace: print a worksheet's first error
    #[arg(long, value_name = "MINE", requires = "trace")]
    compare: Option<PathBuf>,
    /// Significant digits for --compare [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=15), requires = "compare")]
    digits: Option<u8>,
    /// With --compare: do not print the right values
    #[arg(long, requires = "compare")]
    hint: bool,
    /// Print JSON, {"result": …}; --trace adds "trace"
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    letters: Letters,
}

/// Significant digits to which a person computes by hand.
pub(crate) const DIGITS_BY_HAND: u8 = 4;

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let (robot, lints) = arguments.robot()?;
    let q = arguments.given.q.as_ref().map_or(&[][..], |List(q)| q);
    let degrees = limits::Degrees::of(&robot, [q]).remark(|q| format!("write {q}deg"));
    let remark = degrees + &turned_base(arguments) + &far_payload(arguments) + &impossible_payload(arguments) + &lints;
    let outcome = computed(arguments, robot)?;
    let outcome = Outcome { remark: outcome.remark + &remark, ..outcome };
    let letters = arguments.letters;
    let text = match &outcome.text {
        json if arguments.json => letters.json(json),
        // a line of CSV must not be wrapped
        csv if arguments.csv || arguments.golden.is_some() => letters.of(csv),
        text => letters.page(text, PAGE),
    };
    Ok(Outcome { text, remark: letters.page(&outcome.remark, PAGE), ..outcome })
}

/// Remarks on an angle of the base that is probably in degrees.
fn turned_base(arguments: &Arguments) -> String {
    let pose = arguments.given.base_pose.as_ref().map(|List(pose)| pose).filter(|pose| pose.len() == 6);
    let mut remark = String::new();
    for (name, angle) in pose.into_iter().flat_map(|pose| ["roll", "pitch", "yaw"].into_iter().zip(&pose[3..])) {
        if angle.abs() > std::f64::consts::TAU && (10.0 * angle).fract() == 0.0 {
            let _ =
                writeln!(remark, "note: if the {name} of --base-pose, {angle} rad, is in degrees, write {angle}deg");
        }
    }
    remark
}

/// Distance of a payload's centre of mass, m, above which it is probably in millimetres; the same limit as in robot
/// files.
const FARTHEST: f64 = 5.0;

/// Remarks on a payload whose centre of mass is probably in millimetres.
fn far_payload(arguments: &Arguments) -> String {
    let payload = arguments.arm.carried.payload.as_ref().and_then(|list| payload(list).ok());
    let com = payload.map(|payload| payload.com);
    let distance = |com: &[f64; 3]| com.iter().map(|x| x * x).sum::<f64>().sqrt();
    com.filter(|com| distance(com) > FARTHEST).map_or_else(String::new, |com| {
        let largest = com.into_iter().fold(0.0_f64, |largest, x| if x.abs() > largest.abs() { x } else { largest });
        format!(
            "note: the centre of mass of --payload is {:.0} m from its frame; if this is in millimetres, write \
             mm({largest}) and so on\n",
            distance(&com)
        )
    })
}

/// Remarks on a payload whose inertia no distribution of mass has. For a link in a robot file this is a warning.
fn impossible_payload(arguments: &Arguments) -> String {
    let payload = arguments.arm.carried.payload.as_ref().and_then(|list| payload(list).ok());
    payload.and_then(|payload| payload.inertia.impossible_moments()).map_or_else(String::new, |[a, b, c]| {
        format!(
            "note: the inertia of --payload violates the triangle inequality: its largest principal moment, {c:.4} \
             kg m², is more than the sum of the two others, {:.4} kg m²\n",
            a + b
        )
    })
}

/// Computes the results at the states of a table, at random states, or at one state.
fn computed(arguments: &Arguments, robot: Robot) -> Result<Outcome, Failure> {
    let function = arguments.asked(&robot);
    arguments.at.check(function)?;
    function.check_for(&robot).map_err(Failure::usage)?;
    arguments.arm.check(function)?;
    if let Some(states) = &arguments.states {
        let file = arguments.arm.file();
        return states::Job {
            robot_file: file,
            // the plan of a file is only for the robot with the numbers of this file
            arm: &if arguments.arm.set.is_empty() && arguments.arm.without.is_empty() {
                plan_file::compiled_arm(file, &robot)?
            } else {
                CompiledArm::from_robot(&robot)
            },
            function,
            states,
            out: arguments.out.as_deref(),
            force: arguments.force,
        }
        .run();
    }
    if let Some(states) = arguments.golden {
        if !robot.closed.is_empty() {
            return Err(Failure::usage("--golden writes torques of open trees; this robot has closed loops"));
        }
        let settings: Vec<String> =
            arguments.arm.set.iter().map(|Setting { name, value }| format!("{name} = {value}")).collect();
        return golden::file(&robot, states, &settings).map(Outcome::text);
    }
    let (function, robot) = arguments.loaded(function, robot)?;
    arguments.check(function, &robot)?;
    at_one_state(arguments, function, &robot)
}

/// Computes the result at the state of the command line or of a worksheet.
fn at_one_state(arguments: &Arguments, function: Function, robot: &Robot) -> Result<Outcome, Failure> {
    let (sheet, of_sheet) = arguments.sheet(function, robot)?;
    let payload = arguments.arm.carried.payload.clone().filter(|_| function.takes(Argument::Payload));
    let given = Given { payload, ..arguments.given.clone() };
    let (given, assumed) = given.or_state(of_sheet).at_rest(function, robot.dof());
    let state = State::new(function, &given, robot)?;
    let arm = DynArm::from_robot(robot);
    // The lengths were checked before, so this error should not occur; if it does, it says what is wrong.
    let numbers = state.numbers(&arm).map_err(Failure::usage)?;
    if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
        return Err(Failure::input(not_finite(robot, function, index, &state.q)));
    }
    if is_singular(robot, function, [&state.q, &state.passive], state.payload.as_ref()) {
        return Err(input_error!("{function} has no result: {BUT_FOR_ROUNDING}"));
    }
    if let Some(sheet) = &sheet {
        let digits = arguments.digits.unwrap_or(DIGITS_BY_HAND);
        let manner = Manner { digits, json: arguments.json, hint: arguments.hint };
        return compare::run(sheet, robot, &worksheet::situation(&state, robot.dof()), manner);
    }
    let mut remark = limits::remark(robot, [&state.q, &state.qd], &state.passive)
        + &closure::remark(robot, &arm, &state, arguments.given.passive.is_some());
    if is_indefinite(robot, function, [&state.q, &state.passive], state.payload.as_ref()) {
        let _ = writeln!(remark, "note: {NOT_DEFINITE}");
    }
    if !assumed.is_empty() {
        let names = match assumed.as_slice() {
            [first @ .., last] if !first.is_empty() => format!("{} and {last} are", first.join(", ")),
            alone => format!("{} is", alone.concat()),
        };
        let _ = writeln!(remark, "note: {names} not given, so these numbers are 0");
    }
    let text = if arguments.trace {
        traced(arguments, robot, &state, &numbers)?
    } else if arguments.json {
        Outcome::json(&json!({ "result": result(robot, function, &numbers) }))?.text
    } else {
        let mut text = answer::text(robot, &state, &numbers);
        if arguments.arm.carried.payload.is_some() && !function.takes(Argument::Payload) {
            let _ = writeln!(text, "{QUIET}the payload of --payload is a part of the link that carries it{QUIET:#}");
        }
        text
    };
    Ok(Outcome { remark, ..Outcome::text(text) })
}

/// Writes the intermediate values of the seven steps, as CSV, as JSON, or as text with the result.
fn traced(arguments: &Arguments, robot: &Robot, state: &State, numbers: &[f64]) -> Result<String, Failure> {
    let narrowed = Narrowed { joint: choice::joint_of(robot, arguments.joint.as_deref())?, step: arguments.step };
    let axes = arguments.axes.unwrap_or(Axes::Link).into();
    let situation = worksheet::situation(state, robot.dof());
    let sheet = Worksheet::new(robot, &situation, axes).map_err(Failure::usage)?;
    if arguments.csv {
        return Ok(worksheet_text::csv(robot, &sheet, narrowed));
    }
    if arguments.json {
        return worksheet_text::json(robot, &sheet, narrowed, &result(robot, state.function, numbers));
    }
    let mut text = worksheet::text(robot, &sheet, narrowed, state, arguments.letters);
    if narrowed.is_all() {
        text.push('\n');
        text.push_str(&answer::text(robot, state, numbers));
    }
    Ok(text)
}

impl Arguments {
    /// Reads the robot, and returns a note that counts the warnings of its file.
    fn robot(&self) -> Result<(Robot, String), Failure> {
        if self.out.is_some() && self.states.is_none() {
            return Err(Failure::usage("-o is for the results of --states; the result of one state is printed"));
        }
        let is_read_twice = |states: &PathBuf| is_standard_input(states) && is_standard_input(self.arm.file());
        if self.states.as_ref().is_some_and(is_read_twice) {
            return Err(Failure::usage("FILE and --states are both standard input; give one of them as a file"));
        }
        self.arm.robot_at(&self.at)
    }

    /// Returns the function that the command line names, or else the one that the given wrenches, frame and loops
    /// require.
    fn asked(&self, robot: &Robot) -> Function {
        let has_loops = !robot.closed.is_empty();
        self.function.unwrap_or(match (&self.given.wrench, self.at.frame.is_some()) {
            _ if has_loops && !self.given.tip_wrench.is_empty() => Function::InverseDynamicsOfLoopsWithWrenches,
            (None, false) if has_loops => Function::InverseDynamicsOfLoops,
            _ if !self.given.tip_wrench.is_empty() => Function::InverseDynamicsWithWrenches,
            (Some(_), true) => Function::WrenchTorques,
            (None, true) => Function::ForwardKinematics,
            (Some(_), false) => Function::InverseDynamicsWithWrench,
            (None, false) => Function::InverseDynamics,
        })
    }

    /// Checks that the function can be computed and traced for a robot.
    fn check(&self, function: Function, robot: &Robot) -> Result<(), Failure> {
        if self.trace && !function.returns_torques() {
            let is_traced = |f: &&Function| f.returns_torques() && f.check_for(robot).is_ok();
            let with: Vec<&str> = Function::ALL.iter().filter(is_traced).map(|f| f.name()).collect();
            return Err(usage_error!(
                "--trace prints the steps that compute torques, but {function} does not compute torques; use one of \
                 these functions: {}",
                with.join(", ")
            ));
        }
        if self.trace && !robot.is_serial() {
            return Err(Failure::usage(
                "--trace takes serial arms, but the robot is a tree; without --trace, `rne eval` computes the torques \
                 of a tree, and `rne show` prints the formulas of its joints",
            ));
        }
        Ok(())
    }

    /// Reads the worksheet for `--compare`, and takes from it q, q̇ and q̈ as far as the function needs them.
    fn sheet(&self, function: Function, robot: &Robot) -> Result<(Option<Filled>, [Option<List>; 3]), Failure> {
        let read = |path: &PathBuf| worksheet_file::read(path, robot, self.axes.map(Into::into));
        let sheet = self.compare.as_ref().map(read).transpose()?;
        let lists = [
            (Quantity::Q, Argument::Positions),
            (Quantity::Qd, Argument::Rates),
            (Quantity::Qdd, Argument::Accelerations),
        ];
        let given = lists.map(|(quantity, kind)| {
            let given = sheet.as_ref().filter(|_| function.takes(kind))?.given(quantity, robot.dof());
            given.map(List)
        });
        Ok((sheet, given))
    }

    /// Returns the function and the robot for a payload: the payload is an argument if a function takes it, else a part
    /// of a link.
    fn loaded(&self, function: Function, robot: Robot) -> Result<(Function, Robot), Failure> {
        let carried = &self.arm.carried;
        let function = function.with_payload().filter(|_| carried.is_at_tip()).unwrap_or(function);
        if !function.takes(Argument::Payload) {
            return Ok((function, carried.of(robot)?));
        }
        if carried.payload_on.is_some() {
            return Err(usage_error!(
                "{function} takes a payload at the tip; for a payload at another frame, name the function without a \
                 payload, such as inverse_dynamics"
            ));
        }
        Ok((function, robot))
    }
}

/// Arranges numbers in the shape of the function's result.
fn result(robot: &Robot, function: Function, numbers: &[f64]) -> Value {
    let record = |record: Record, parts| {
        let fields = record.fields().iter().copied().map(str::to_owned);
        Value::Object(fields.zip::<Vec<Value>>(parts).collect())
    };
    let numbers = &mut numbers.iter().map(|&number| Value::from(number));
    let layout = function.layout(rne_codegen::sizes_of(robot));
    layout.fold(numbers, &Value::Array, &record).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::iter;

    use clap::Parser;
    use rne_codegen::Argument::{
        Accelerations, Base, BasePose, BaseRotation, BaseTwist, BaseVelocity, Multipliers, Passive, Positions, Rates,
        Step, Torques, Wrench, Wrenches,
    };

    use super::*;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        arguments: Arguments,
    }

    /// Runs the command with options, some of them with values.
    fn run_with<'a>(file: &'a str, options: impl Iterator<Item = &'a str>) -> Result<Outcome, Failure> {
        let words = ["eval", file].into_iter().chain(options);
        run(&Command::try_parse_from(words).unwrap_or_else(|error| panic!("{error}")).arguments)
    }

    /// Options, each with a value for two joints or for a base, and with the arguments of functions that use it.
    const OPTIONS: [(&str, &str, &[Argument]); 18] = [
        ("--q", "0.1,0.2", &[Positions]),
        ("--qd", "0.1,0.2", &[Rates]),
        ("--qdd", "0.1,0.2", &[Accelerations]),
        ("--tau", "0.1,0.2", &[Torques]),
        ("--duration", "0.01", &[Step]),
        ("--multipliers", "1,2", &[Multipliers]),
        ("--wrench", "1,2,3,4,5,6", &[Wrench]),
        ("--tip-wrench", "tip=1,2,3,4,5,6", &[Wrenches]),
        ("--passive", "1", &[Passive]),
        ("--base-omega", "1,2,3", &[Base, BaseVelocity, BaseTwist]),
        ("--base-omega-dot", "1,2,3", &[Base]),
        ("--base-acceleration", "1,2,3", &[Base]),
        ("--base-velocity", "1,2,3", &[BaseTwist]),
        ("--base-pose", "1,2,3,0,0,0", &[BasePose]),
        ("--gravity", "1,2,3", &[Base]),
        ("--base-rotation", "1,0,0,0,1,0,0,0,1", &[BaseRotation]),
        ("--payload", "1,0,0,0", &[Argument::Payload]),
        ("--frame", "shoulder", &[]),
    ];

    /// For every function, every option that has a value, and `--rotors`, is either used or refused with a message that
    /// names it. The table of functions says which functions use it.
    #[test]
    fn every_function_uses_or_refuses_every_option() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/satellite.yaml");
        let robot =
            crate::files::robot_file::robot(std::path::Path::new(file), crate::files::robot_file::Shape::Closed);
        let robot = robot.expect("a shipped robot");
        let (mut used, mut refused) = (0, 0);
        for function in Function::ALL.into_iter().filter(|function| function.check_for(&robot).is_ok()) {
            let needed = || {
                OPTIONS
                    .into_iter()
                    .filter(|(_, _, arguments)| arguments.iter().any(|argument| function.takes(*argument)))
            };
            let needed = || {
                let all = needed().flat_map(|(option, value, _)| [option, value]);
                ["--function", function.name()].into_iter().chain(all)
            };
            let plain = run_with(file, needed());
            assert!(plain.is_ok(), "{function}: {}", plain.err().map(|error| error.text).unwrap_or_default());
            for (option, value) in OPTIONS
                .into_iter()
                .map(|(option, value, _)| (option, Some(value)))
                .chain(iter::once(("--rotors", None)))
            {
                if needed().any(|other| other == option) {
                    continue;
                }
                let is_used = match option {
                    "--rotors" => function.feels_rotors(),
                    "--frame" => function.of_frame().is_some(),
                    "--payload" => function.entry().feels_links,
                    _ => false,
                };
                let given = needed().chain(iter::once(option)).chain(value);
                match run_with(file, given) {
                    Ok(_) => assert!(is_used, "{function} takes {option}, which it does not use"),
                    Err(error) => {
                        let error = error.text;
                        assert!(!is_used && error.contains(option), "{function}, {option}: {error}");
                        refused += 1;
                        continue;
                    }
                }
                used += 1;
            }
        }
        assert!(used > 50 && refused > 500, "{used} used, {refused} refused");
    }

    /// `--golden` and `--states` either use an option of one state or refuse it; none is accepted and then ignored.
    #[test]
    fn many_states_use_or_refuse_every_option() {
        use clap::CommandFactory as _;
        let of_robot = ["rotors", "set", "without", "ascii"];
        let of_table = ["function", "frame", "output"];
        for (states, used) in [("--golden=1", &[][..]), ("--states=x.csv", &of_table)] {
            for arg in Command::command().get_arguments() {
                let Some(long) = arg.get_long().filter(|long| !states.starts_with(&format!("--{long}="))) else {
                    continue;
                };
                let value = match long {
                    "tip-wrench" => "a=1,2,3,4,5,6",
                    "axes" => "link",
                    "function" => "mass_matrix",
                    "set" => "a=1",
                    _ => "1",
                };
                let takes_value = arg.get_action().takes_values();
                let word = if takes_value { format!("--{long}={value}") } else { format!("--{long}") };
                let is_refused = Command::try_parse_from(["eval", "x.yaml", states, &word]).is_err();
                let is_used = of_robot.contains(&long) || used.contains(&long);
                assert_eq!(is_refused, !is_used, "{states} {word}");
            }
        }
    }

    /// A payload changes the results of exactly those functions whose entry `feels_links` says that they depend on link
    /// masses.
    #[test]
    fn what_feels_links_is_what_a_payload_changes() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/satellite.yaml");
        let robot =
            crate::files::robot_file::robot(std::path::Path::new(file), crate::files::robot_file::Shape::Closed);
        let robot = Robot { gravity: [1.0, 2.0, -9.81], ..robot.expect("a shipped robot") };
        let loaded = rne_convert::carrying(
            &robot,
            3.0,
            [0.1, 0.2, 0.3],
            rne_model::Inertia { xx: 0.1, yy: 0.1, zz: 0.1, ..rne_model::Inertia::default() },
        );
        let lists = |numbers: &[f64]| List(numbers.to_vec());
        let (joints, triple, six) =
            (lists(&[0.3, 0.7]), lists(&[0.4, -0.5, 0.6]), lists(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]));
        let (one, payload) = (lists(&[0.01]), lists(&[1.0, 0.1, 0.0, 0.2]));
        for function in Function::ALL.into_iter().filter(|function| function.check_for(&robot).is_ok()) {
            let take = |argument, list: &List| Some(list.clone()).filter(|_| function.takes(argument));
            let base = |list| take(Base, list);
            let given = Given {
                q: take(Positions, &joints),
                qd: take(Rates, &joints),
                qdd: take(Accelerations, &joints),
                tau: take(Torques, &joints),
                duration: take(Step, &one),
                multipliers: take(Multipliers, &joints),
                wrench: take(Wrench, &six),
                payload: take(Argument::Payload, &payload),
                base_omega: base(&triple).or(take(BaseVelocity, &triple)).or(take(BaseTwist, &triple)),
                base_omega_dot: base(&triple),
                base_acceleration: base(&triple),
                base_velocity: take(BaseTwist, &triple),
                base_pose: take(BasePose, &six),
                ..Given::default()
            };
            // functions that need a wrench at each tip are skipped: they are like those with one wrench
            let Ok(state) = State::new(function, &given, &robot) else { continue };
            let [alone, loaded] = [&robot, &loaded]
                .map(|robot| state.numbers(&DynArm::from_robot(robot)).expect("arrays of the right length"));
            assert_eq!(alone != loaded, function.entry().feels_links, "{function}");
        }
    }
}
