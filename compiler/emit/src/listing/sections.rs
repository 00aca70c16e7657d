//! The order of statements in a listing: joint by joint and step by step, or as they are computed.

use std::collections::HashSet;

use rne_codegen::{Argument, Form, Function, Name, Place, Program, Quantity, Statement, Step};
use rne_model::Robot;

use super::explanations::{folds, resolutions};
use super::headings::{beyond_title, by_title, heading};
use super::{Line, Section, Selection};
use crate::formula::{Numbers, base_formulas};
use crate::text::returned;

/// Returns the sections of a program whose statements are listed by joints and steps.
pub(super) fn by_steps<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Vec<Section<'a>> {
    // the outward pass has steps 1 to 5, the inward pass 6 and 7; a payload is one more link
    let last = program.joints + usize::from(program.function.takes(Argument::Payload));
    let floats = program.function.is_of_floating_base();
    let first = usize::from(!(floats && robot.floating_base.is_some()));
    let outward = (first..=last).flat_map(|joint| Step::ALL[..5].iter().map(move |&step| (joint, step)));
    let inward = (first..=last).rev().flat_map(|joint| Step::ALL[5..].iter().map(move |&step| (joint, step)));
    let mut sections = Vec::new();
    // several steps use these statements, in any order, so they come first
    let of_parameters = of_parameters(program);
    if what.joint.is_none() && what.step.is_none() && !of_parameters.is_empty() {
        let heading = Line::Heading("numbers of the table, from the parameters".to_owned());
        let statements = program.statements.iter().filter(|statement| of_parameters.contains(&statement.name));
        let lines =
            std::iter::once(heading).chain(statements.map(|statement| Line::statement(program, statement))).collect();
        sections.push(Section { place: None, lines });
    }
    let is_of_links = |joint, step| match step {
        // the velocity of a floating base is no argument
        Step::Velocity if floats => false,
        Step::Acceleration | Step::Wrenches => true,
        // the joint of a payload does not move
        Step::Velocity | Step::Torque => joint > 0 && joint <= program.joints,
        _ => joint > 0,
    };
    let places = outward.chain(inward).filter(|&(joint, step)| what.includes(joint, step) && is_of_links(joint, step));
    for (joint, step) in places {
        let here = |place: &Place| place.joint == joint && place.step == step;
        let turns =
            program.sines_and_cosines.iter().filter(|turn| here(&turn.place)).map(|turn| Line::turn(program, turn));
        let is_here = |statement: &&Statement| here(&statement.place) && !of_parameters.contains(&statement.name);
        let statements = program.statements.iter().filter(is_here).map(|statement| Line::statement(program, statement));
        let code: Vec<Line> = turns.chain(statements).collect();
        if code.is_empty() && !what.explain {
            continue;
        }
        let mut lines = heading(robot, program, joint, step);
        if joint == 0 {
            let numbers = Numbers::of(robot, joint, program.function);
            lines.extend(base_formulas(step, &numbers).into_iter().map(Line::Formula));
        }
        lines.extend(code);
        if what.explain {
            lines.extend(resolutions(robot, program, joint, step));
            lines.extend(folds(robot, &program.fold_report, here, what.reasons).map(Line::Folds));
        }
        sections.push(Section { place: Some((joint, step, None)), lines });
    }
    sections
}

/// Returns the names of the statements that depend on run-time parameters only.
fn of_parameters(program: &Program) -> HashSet<Name> {
    let constants: HashSet<Name> = program.constants().map(|constant| constant.name).collect();
    let mut found: HashSet<Name> = HashSet::new();
    let is_known = |name: &Name, found: &HashSet<Name>| name.quantity == Quantity::Parameter || found.contains(name);
    for Statement { name, value, .. } in &program.statements {
        let names = || program.values.defined(*value).names();
        let depends = names().any(|name| is_known(&name, &found));
        if depends && names().all(|name| is_known(&name, &found) || constants.contains(&name)) {
            found.insert(*name);
        }
    }
    found
}

/// Returns the sections of a program whose statements are listed in the order in which they are computed.
pub(super) fn in_order<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Vec<Section<'a>> {
    let mut sections = Vec::new();
    if what.is_everything() {
        let constants = program.constants().map(Line::Constant);
        let angles = program.angles.iter().map(|statement| Line::statement(program, statement));
        let turns = program.sines_and_cosines.iter().map(|turn| Line::turn(program, turn));
        sections.push(Section { place: None, lines: constants.chain(angles).chain(turns).collect() });
    }
    let mut last_opening = None;
    for statement in &program.statements {
        let Place { joint, step, by, quantity } = shown_place(program, statement);
        if !what.includes(joint, step) {
            continue;
        }
        let opening = match (by, step) {
            _ if !program.follows_recursion() => Vec::new(),
            (Some(by), _) => vec![Line::Heading(by_title(robot, program, joint, step, by))],
            (None, Step::Beyond) => vec![Line::Heading(beyond_title(program, quantity, joint))],
            (None, _) => heading(robot, program, joint, step),
        };
        if last_opening.as_ref() != Some(&opening) {
            let place = program.follows_recursion().then_some((joint, step, by));
            sections.push(Section { place, lines: opening.clone() });
            last_opening = Some(opening);
        }
        if let Some(section) = sections.last_mut() {
            section.lines.push(Line::statement(program, statement));
        }
    }
    let has_shape = !program.function.returns_torques() && program.outputs.len() > 1;
    if let Some(returned) = returned(program).filter(|_| what.is_everything() && has_shape) {
        let heading = Line::Heading(program.function.entry().listed.to_owned());
        sections.push(Section { place: None, lines: vec![heading, Line::Returned(returned)] });
    }
    sections
}

/// Returns the place under which a statement is listed: that of its name, if its quantity belongs to a step. A value
/// that two formulas share is listed at the first of them, which may have another joint and step.
fn shown_place(program: &Program, statement: &Statement) -> Place {
    let Statement { name, place, .. } = statement;
    let has_own_form = program.form != Form::SevenSteps && Function::TORQUES.contains(&program.function);
    match name.quantity.step() {
        // the last statement of the solution for a joint is the result itself
        _ if name.quantity == Quantity::RateDot => {
            Place { joint: name.joint, step: Step::Beyond, quantity: Quantity::Scaled, by: None }
        }
        Some(step) if !has_own_form => Place { joint: name.joint, step, quantity: name.quantity, by: name.by },
        _ => *place,
    }
}
