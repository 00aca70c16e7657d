//! Chooses the functions that `rne emit` writes, and compiles their programs.

use std::fmt::Write as _;

use rne_codegen::CheckFor as _;
use rne_codegen::{Form, Function, Order, Program, Target, ordered_for_registers};
use rne_model::{FrameId, Robot};

use crate::commands::emit::{Arguments, Language};
use crate::files::chosen_arm::not_of_frames;
use crate::files::plan_file::Compiler;
use crate::outcome::Failure;
use crate::palette::TYPED;
use crate::values::choice::{self, FunctionOrAll};

/// Returns the functions that the command line asks for, each once, in the order of the traits.
fn functions(arguments: &Arguments, robot: &Robot) -> Vec<Function> {
    let asked = &arguments.functions;
    if asked.contains(&FunctionOrAll::All) {
        return choice::functions_of(robot).collect();
    }
    let (is_for_casadi, has_frames) = (arguments.casadi && robot.closed.is_empty(), !arguments.frames.is_empty());
    let is_asked = |function: &Function| match asked.as_slice() {
        _ if (arguments.acados || arguments.runge_kutta) && *function == Function::ForwardDynamics => true,
        // the derivatives of a Runge-Kutta step need this function
        [] if arguments.runge_kutta && *function == Function::ForwardDynamicsDerivatives => true,
        // without `--functions`, each of these options adds the functions that it needs
        [] if arguments.runge_kutta || arguments.rollout || is_for_casadi || has_frames => match function {
            Function::InverseDynamics => is_for_casadi,
            Function::ForwardDynamics => is_for_casadi || arguments.rollout,
            function => has_frames && function.of_frame().is_some(),
        },
        // a robot with named tips gets functions that take a wrench at each tip
        [] => {
            Function::TORQUES.contains(function)
                || matches!(function, Function::ClosureStep | Function::InverseDynamicsOfLoops)
                || (*function == Function::InverseDynamicsWithWrenches && !robot.tips.is_empty())
        }
        asked => asked.contains(&FunctionOrAll::One(*function)),
    };
    // a function that is named is kept: the compiler refuses it, and says why the robot does not have it
    let of_robot: Vec<Function> = match asked.as_slice() {
        [] if arguments.runge_kutta => rne_codegen::functions_of(robot).chain([Function::ForwardDynamics]).collect(),
        [] => rne_codegen::functions_of(robot).collect(),
        _ => Function::ALL.to_vec(),
    };
    let asked: Vec<Function> = of_robot.into_iter().filter(is_asked).collect();
    let for_derivatives = asked.iter().filter(|_| arguments.casadi);
    let for_derivatives: Vec<Function> =
        for_derivatives.flat_map(|&function| rne_emit::casadi_derivatives(function)).collect();
    let is_needed = |function: &Function| asked.contains(function) || for_derivatives.contains(function);
    Function::ALL.into_iter().filter(is_needed).collect()
}

fn compiled(arguments: &Arguments, compiler: &Compiler<'_>, function: Function) -> Result<Program, Failure> {
    let is_for_derivatives = arguments.casadi && !arguments.functions.contains(&FunctionOrAll::One(function));
    compiler.compile(function, arguments.form()).map_err(|mut failure| {
        if is_for_derivatives {
            let _ = write!(
                failure.text,
                "\n`{function}` is needed for CasADi's derivatives of another function. Name the functions that you \
                 need, such as {TYPED}--function inverse_dynamics{TYPED:#}"
            );
        }
        failure
    })
}

/// Compiles the programs: first those of the tip or the whole robot, then those of the frames.
pub(super) fn programs(arguments: &Arguments, robot: &Robot) -> Result<Vec<Program>, Failure> {
    // kernels that compute many states need few instructions, not a short dependency chain
    let target = if arguments.lang == Language::Ptx { Target::Throughput } else { Target::Latency };
    let compiler = Compiler::new(&arguments.file, robot).for_target(target);
    if arguments.rollout {
        can_be_rolled_out(arguments, robot)?;
    }
    let functions = functions(arguments, robot);
    functions.iter().try_for_each(|function| function.check_base(robot)).map_err(Failure::usage)?;
    let (of_frames, of_arm): (Vec<_>, Vec<_>) = functions.iter().partition(|function| function.of_frame().is_some());
    if !arguments.frames.is_empty() && of_frames.is_empty() {
        return Err(not_of_frames("none of the functions that are written is one of them"));
    }
    let of_tip = if arguments.frames.is_empty() { &functions } else { &of_arm };
    let mut programs: Vec<Program> =
        of_tip.iter().map(|&function| compiled(arguments, &compiler, function)).collect::<Result<_, _>>()?;
    for frame in frames(arguments, robot)? {
        let robot = robot.clone().at_frame(frame);
        let compiler = Compiler::new(&arguments.file, &robot).for_target(target);
        for &function in &of_frames {
            let program = compiler.compile(function, arguments.form())?;
            if let Some(other) = programs.iter().find(|other| other.name == program.name) {
                return Err(usage_error!(
                    "the frames {} and {} both give the name {}; write them to two files",
                    other.frame.as_deref().unwrap_or("tip"),
                    robot.frame_name(frame),
                    program.name
                ));
            }
            programs.push(program);
        }
    }
    in_order(arguments.order, arguments.form(), programs)
}

/// Puts the statements of programs in an order.
pub(crate) fn in_order(order: Order, form: Form, programs: Vec<Program>) -> Result<Vec<Program>, Failure> {
    match (order, form) {
        (Order::Formulas, _) => Ok(programs),
        (Order::Registers, Form::SevenSteps) => Err(usage_error!(
            "{TYPED}--order registers{TYPED:#} is for {TYPED}--form reduced{TYPED:#}: code of the seven steps keeps \
             their order, and code in Rust has this form unless you write {TYPED}--form reduced{TYPED:#}"
        )),
        (Order::Registers, Form::Reduced) => Ok(programs.iter().map(ordered_for_registers).collect()),
    }
}

/// Returns the frames that the command line names, or those of the list `frames`.
fn frames(arguments: &Arguments, robot: &Robot) -> Result<Vec<FrameId>, Failure> {
    if arguments.frames.is_empty() {
        return Ok((0..robot.frames.len()).map(FrameId::Named).collect());
    }
    arguments.frames.iter().map(|name| robot.frame(name).map_err(Failure::usage)).collect()
}

/// Refuses rollouts of a robot whose equations of motion no kernel can integrate.
fn can_be_rolled_out(arguments: &Arguments, robot: &Robot) -> Result<(), Failure> {
    if !robot.closed.is_empty() {
        return Err(usage_error!(
            "a robot with closed loops cannot be rolled out in a kernel; leave {TYPED}--rollout{TYPED:#} out: \
             {TYPED}--function forward_dynamics_of_loops{TYPED:#} writes a kernel of its accelerations"
        ));
    }
    if robot.floating_base.is_some() && arguments.functions.is_empty() {
        return Err(usage_error!(
            "a robot on a floating base cannot be rolled out in a kernel; {TYPED}--function forward_dynamics{TYPED:#} \
             rolls out the robot with a locked base"
        ));
    }
    Ok(())
}
