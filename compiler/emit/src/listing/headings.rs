//! The headings of sections, with the formulas of their steps.

use rne_codegen::{Form, Function, Program, Quantity, Step, WithRespectTo};
use rne_model::{Joint, JointKind, Robot, one_line};

use super::Line;
use crate::formula::{Numbers, formulas, payload_formulas, reduced_formulas};

/// Returns the heading of derivatives, or of the terms for a unit acceleration of one joint.
pub(super) fn by_title(robot: &Robot, program: &Program, joint: usize, step: Step, by: WithRespectTo) -> String {
    let what = match step {
        Step::Beyond => joint_title(robot, joint),
        _ => step_title(robot, program, joint, step),
    };
    match by {
        WithRespectTo::BaseRateDot(_) => format!("{what}, for {} = 1 alone", by.variable()),
        WithRespectTo::RateDot(by) => format!("{what}, for q̈{by} = 1 alone"),
        WithRespectTo::BasePosition(_) | WithRespectTo::BaseRate(_) => format!("{what}, by {}", by.variable()),
        WithRespectTo::Position(by) => format!("{what}, by q{by}"),
        WithRespectTo::Rate(by) => format!("{what}, by q̇{by}"),
    }
}

/// Returns the heading of a quantity that is not of the seven steps: that of the function, or one that several
/// functions share.
pub(super) fn beyond_title(program: &Program, quantity: Quantity, joint: usize) -> String {
    if let Some(own) = rne_codegen::own(program.function, quantity) {
        return (own.heading)(joint);
    }
    match quantity {
        Quantity::FrameRotation | Quantity::FrameOrigin if joint > program.joints => "the tip in the world".to_owned(),
        Quantity::FrameRotation | Quantity::FrameOrigin => format!("frame {joint} in the world"),
        Quantity::LowerFactor
        | Quantity::ScaledFactor
        | Quantity::Pivot
        | Quantity::InversePivot
        | Quantity::Reduced
        | Quantity::Scaled => "L D Lᵀ q̈ = τ - bias, where M = L D Lᵀ".to_owned(),
        _ => format!("joint {joint}: terms that have no meaning of their own"),
    }
}

/// Whether the link of a joint, counted from 1, has a first moment in addition to its mass.
pub(super) fn has_first_moment(robot: &Robot, joint: usize) -> bool {
    robot.joints.get(joint.wrapping_sub(1)).is_some_and(|joint| joint.row.link.has_first_moment())
}

/// Returns the heading of a step of one joint, and its formulas.
pub(super) fn heading<'a>(robot: &Robot, program: &Program, joint: usize, step: Step) -> Vec<Line<'a>> {
    let kind = robot.joints.get(joint.wrapping_sub(1)).map_or(JointKind::Revolute, |joint| joint.row.kind);
    let numbers = Numbers::of(robot, joint, program.function);
    let formulas = match recursion(program) {
        // in the lecture the base is at rest, so there are no formulas for it
        _ if joint == 0 => Vec::new(),
        Form::SevenSteps if joint > program.joints => payload_formulas(step, &numbers),
        Form::SevenSteps => formulas(step, kind, &numbers, has_first_moment(robot, joint)),
        Form::Reduced if program.is_of_bodies() => Vec::new(),
        Form::Reduced => reduced_formulas(step, kind, &numbers),
    };
    let title = Line::Heading(step_title(robot, program, joint, step));
    std::iter::once(title).chain(formulas.into_iter().map(Line::Formula)).collect()
}

/// Returns the recursion from which a program is derived. The regressor and programs of the reduced form use origins of
/// frames instead of centres of mass.
pub(in super::super) fn recursion(program: &Program) -> Form {
    let is_reduced = program.form != Form::SevenSteps
        && (Function::TORQUES.contains(&program.function) || !program.choices.is_empty());
    if is_reduced || program.function == Function::Regressor { Form::Reduced } else { Form::SevenSteps }
}

/// Returns a joint by its number; for a tree with its name as well, because the number does not tell the branch.
fn joint_title(robot: &Robot, joint: usize) -> String {
    match robot.joints.get(joint.wrapping_sub(1)).filter(|_| !robot.is_serial()) {
        Some(Joint { name, .. }) => format!("joint {joint} ({})", one_line(name)),
        None => format!("joint {joint}"),
    }
}

fn step_title(robot: &Robot, program: &Program, joint: usize, step: Step) -> String {
    if program.is_of_bodies() && step == Step::Wrenches {
        return format!("{}: the links from here on, as one body", joint_title(robot, joint));
    }
    let title = match (recursion(program), step) {
        (Form::SevenSteps, _) => step.title(),
        (_, Step::Acceleration) => "acceleration of the frame's origin",
        (_, Step::AngularAcceleration) => "angular acceleration, accelerations of points",
        _ => step.title(),
    };
    let body = match joint {
        0 => "base".to_owned(),
        _ if joint > program.joints => "payload".to_owned(),
        _ => joint_title(robot, joint),
    };
    format!("{body}, step {}: {title}", step.number())
}
