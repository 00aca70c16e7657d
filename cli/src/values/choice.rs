//! Reads choices that several commands offer: a function, a form, a convention, a joint, a step, quantities to keep.

use std::fmt;

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use rne_codegen::CheckFor as _;
use rne_codegen::plan::Trick;
use rne_codegen::{Argument, Capability, Form, Function, Order, Quantity, Step};
use rne_model::{Convention, Robot};

use crate::outcome::Failure;
use crate::palette::TYPED;

/// Reads the name of a function; the help and the messages list all names.
pub(crate) fn function() -> impl TypedValueParser<Value = Function> {
    let value = |function: Function| PossibleValue::new(function.name()).help(function.summary());
    PossibleValuesParser::new(Function::ALL.map(value)).try_map(|name| rne_codegen::function_named(&name))
}

/// Explains a step of an integrator that is no function of its own, because it is composed of calls of another
/// function.
pub(crate) fn composed(name: &str) -> Option<String> {
    let where_it_is = match name {
        "runge_kutta_step" | "runge_kutta_step_derivatives" => format!(
            "it is composed of calls of forward_dynamics: {TYPED}rne emit FILE --lang c --runge-kutta{TYPED:#} writes \
             it in C, and Rust and Python have it as a method"
        ),
        "floating_runge_kutta_step" | "floating_runge_kutta_step_derivatives" => {
            "it is composed of calls of other functions, and Rust and Python have it as a method".to_owned()
        }
        "friction_torques" | "friction_derivatives" => {
            return Some(format!(
                "`{name}` is no value of {TYPED}--function{TYPED:#}: {TYPED}rne emit FILE --lang c \
                 --friction{TYPED:#} writes it in C, and Python has it as a method; see the section Friction and \
                 limits in C of docs/firmware/first-firmware.md"
            ));
        }
        _ => return None,
    };
    Some(format!(
        "`{name}` is no value of {TYPED}--function{TYPED:#}, because {where_it_is}; see the section A step of an \
         integrator of docs/control/optimal-control.md"
    ))
}

/// One function, or all functions of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FunctionOrAll {
    All,
    One(Function),
}

impl fmt::Display for FunctionOrAll {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::One(function) => function.fmt(f),
        }
    }
}

/// Reads the name of a function, or `all`.
pub(crate) fn function_or_all() -> impl TypedValueParser<Value = FunctionOrAll> {
    let value = |function: Function| PossibleValue::new(function.name()).help(function.summary());
    let all = PossibleValue::new("all").help("Every function of the robot");
    PossibleValuesParser::new(Function::ALL.map(value).into_iter().chain([all])).try_map(|name| match name.as_str() {
        "all" => Ok(FunctionOrAll::All),
        name => rne_codegen::function_named(name).map(FunctionOrAll::One),
    })
}

/// Reads the name of a form.
pub(crate) fn form() -> impl TypedValueParser<Value = Form> {
    let value = |form: Form| match form {
        Form::SevenSteps => PossibleValue::new(form.name()).help("With every intermediate value of the seven steps"),
        Form::Reduced => PossibleValue::new(form.name()).help("Fewest operations; only the results have a meaning"),
    };
    PossibleValuesParser::new(Form::ALL.map(value)).try_map(|name| name.parse::<Form>())
}

/// Reads the name of an order of statements.
pub(crate) fn order() -> impl TypedValueParser<Value = Order> {
    let value = |order: Order| match order {
        Order::Formulas => PossibleValue::new(order.name()).help("Joint by joint, as the formulas"),
        Order::Registers => PossibleValue::new(order.name()).help("Few values are alive at once"),
    };
    PossibleValuesParser::new(Order::ALL.map(value)).try_map(|name| name.parse::<Order>())
}

/// Reads the name of a trick of the reduced form.
pub(crate) fn trick() -> impl TypedValueParser<Value = Trick> {
    let value = |trick: Trick| PossibleValue::new(trick.name()).help(trick.formula());
    PossibleValuesParser::new(Trick::ALL.map(value)).try_map(|name| name.parse::<Trick>())
}

/// Reads a convention.
pub(crate) fn convention() -> impl TypedValueParser<Value = Convention> {
    // without descriptions, because docs/robot-file.md explains the conventions
    PossibleValuesParser::new(["standard", "modified"])
        .map(|word| if word == "modified" { Convention::Modified } else { Convention::Standard })
}

/// Reads the name of a robot.
pub(crate) fn robot_name(text: &str) -> Result<String, String> {
    let starts_well = text.starts_with(|c: char| c.is_ascii_lowercase());
    if starts_well && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_') {
        return Ok(text.to_owned());
    }
    Err("a robot's name has small letters, digits and underscores, and starts with a letter: my_arm".to_owned())
}

/// Reads the number of a joint, which is later compared with the joints of the robot.
pub(crate) fn joint(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "a joint is given by its number, counted from 1 at the base".to_owned())
}

/// Reads the number of a step.
pub(crate) fn step(text: &str) -> Result<Step, String> {
    let step = Step::ALL.into_iter().find(|step| step.number().to_string() == text);
    step.ok_or_else(|| {
        let steps: Vec<String> = Step::ALL.iter().map(|step| format!("{} {}", step.number(), step.title())).collect();
        let duration = if text.parse::<f64>().is_ok() && text.parse::<i64>().is_err() {
            "; the duration of a step of an integrator is `--duration`"
        } else {
            ""
        };
        format!("the steps are {}{duration}", steps.join(", "))
    })
}

/// A quantity of the lecture that may be folded away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub(crate) enum Kept {
    /// Angular velocity ω of a link
    Omega,
    /// Angular acceleration ω̇ of a link
    OmegaDot,
    /// Velocity ċ of the centre of mass of a link, from step 3
    Velocity,
    /// Acceleration c̈ of the centre of mass of a link
    Acceleration,
    /// Acceleration of gravity g in the axes of a link
    Gravity,
    /// Inertia force f_i = m c̈ of link i
    InertiaForce,
    /// Inertia moment n_i of link i about its centre of mass
    InertiaMoment,
    /// Force f_{i-1,i} that link i-1 exerts on link i
    JointForce,
    /// Moment n_{i-1,i} that link i-1 exerts on link i
    JointMoment,
}

impl Kept {
    pub(crate) const fn quantity(self) -> Quantity {
        match self {
            Self::Omega => Quantity::Omega,
            Self::OmegaDot => Quantity::OmegaDot,
            Self::Velocity => Quantity::Velocity,
            Self::Acceleration => Quantity::Acceleration,
            Self::Gravity => Quantity::Gravity,
            Self::InertiaForce => Quantity::InertiaForce,
            Self::InertiaMoment => Quantity::InertiaMoment,
            Self::JointForce => Quantity::JointForce,
            Self::JointMoment => Quantity::JointMoment,
        }
    }

    /// Returns the quantity in words, with its symbol.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Omega => "angular velocities ω",
            Self::OmegaDot => "angular accelerations ω̇",
            Self::Velocity => "velocities ċ of step 3",
            Self::Acceleration => "accelerations c̈",
            Self::Gravity => "gravity g of every link",
            Self::InertiaForce => "inertia forces f",
            Self::InertiaMoment => "inertia moments n",
            Self::JointForce => "joint forces",
            Self::JointMoment => "joint moments",
        }
    }
}

/// Returns the joint of a robot with this number, counted from 1 at the base, or with this name.
pub(crate) fn joint_of(robot: &Robot, told: Option<&str>) -> Result<Option<usize>, Failure> {
    let Some(told) = told else { return Ok(None) };
    let number = told.parse().ok().filter(|number| (1..=robot.joints.len()).contains(number));
    let by_name = || robot.joints.iter().position(|joint| joint.name == told).map(|index| index + 1);
    if let Some(joint) = number.or_else(by_name) {
        return Ok(Some(joint));
    }
    let joints = robot.joints.iter().enumerate().map(|(index, joint)| format!("{} ({})", index + 1, joint.name));
    let joints = joints.collect::<Vec<_>>().join(", ");
    Err(Failure::usage(format!("{} has no joint {told}; its joints are {joints}", robot.name)))
}

/// Replaces the default function, the torques of an open tree, by the torques of closed loops if the robot has loops.
pub(crate) fn of_loops(function: Function, robot: &Robot) -> Function {
    match function {
        Function::InverseDynamics if !robot.closed.is_empty() => Function::InverseDynamicsOfLoops,
        function => function,
    }
}

/// Returns the functions that are useful for a robot, in the order of the traits. Torques of motors are left out
/// without motors, because they are zero; `regressor` is left out with couplings, and motion in contact without
/// contacts. Without named tips, functions with a wrench at each tip are left out, because they equal those with a
/// wrench at the tip. Functions of a floating base are included only if the robot has one.
pub(crate) fn functions_of(robot: &Robot) -> impl Iterator<Item = Function> {
    let has_motors = robot.joints.iter().any(|joint| joint.motor.is_some());
    let has_tips = !robot.tips.is_empty();
    rne_codegen::functions_of(robot).filter(move |function| {
        (function.capability() != Capability::Actuation || has_motors)
            && function.check_for(robot).is_ok()
            && (has_tips || function.is_of_floating_base() || !function.takes(Argument::Wrenches))
    })
}
