//! Explanations of components that have no statement, and of operations that were removed.

use std::collections::BTreeMap;

use rne_codegen::{
    Cause, Causes, Fold, FoldReport, Name, Place, Program, Quantity, Resolution, ResolvedAs, Sign, Step,
};
use rne_model::Robot;

use super::headings::has_first_moment;
use super::{Folds, Line};
use crate::annotated::Annotated;
use crate::table::angle;

pub(super) fn resolutions<'a>(robot: &Robot, program: &Program, joint: usize, step: Step) -> Vec<Line<'a>> {
    let mut groups: Vec<(Annotated, Vec<Name>)> = Vec::new();
    for Resolution { name, value } in &program.resolutions {
        let quantity = name.quantity;
        if name.joint != joint || quantity.step() != Some(step) || !quantity.is_of_the_lecture() {
            continue;
        }
        let Some(became) = became(robot, *name, value) else { continue };
        match groups.iter_mut().find(|(other, _)| *other == became) {
            Some((_, names)) => names.push(*name),
            None => groups.push((became, vec![*name])),
        }
    }
    groups.into_iter().map(|(became, names)| Line::Resolution { names, became }).collect()
}

fn became(robot: &Robot, name: Name, found: &ResolvedAs) -> Option<Annotated> {
    let words = match found {
        // the statement itself shows it
        ResolvedAs::Computed => return None,
        ResolvedAs::Same(..) if matches!(name.quantity, Quantity::Torque | Quantity::AxisTorque) => return None,
        ResolvedAs::Same(other, sign) => {
            let sign = if *sign == Sign::Minus { "-" } else { "" };
            return Some(Annotated::default() + " = " + sign + *other);
        }
        ResolvedAs::Constant(0.0, causes) => format!(" = 0: {}", reason(robot, causes, 0)),
        ResolvedAs::Constant(value, causes)
            if causes.iter().any(|cause| matches!(cause, Cause::GravityDirection(_))) =>
        {
            format!(" = {value}: gravity in frame 0")
        }
        ResolvedAs::Constant(value, _) => format!(" = {value}, of constants"),
        ResolvedAs::Inside => ": inside the statement that uses it".to_owned(),
        ResolvedAs::Unused if name.quantity == Quantity::InertiaForce && !has_first_moment(robot, name.joint) => {
            " = m c̈: inside m (c̈ - g)".to_owned()
        }
        ResolvedAs::Unused => ": not needed".to_owned(),
    };
    Some(words.into())
}

/// Returns how many operations are left at the places for which `here` is true, and why the others were removed.
pub(super) fn folds(
    robot: &Robot,
    fold_report: &FoldReport,
    here: impl Fn(&Place) -> bool,
    most: Option<usize>,
) -> Option<Folds> {
    let before = fold_report.total(|line| here(&line.place));
    let left = fold_report.total(|line| here(&line.place) && line.fold == Fold::Kept);
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    for rne_codegen::Line { fold, count, .. } in fold_report.lines().filter(|line| here(&line.place)) {
        let reason = match fold {
            Fold::Kept => continue,
            Fold::Zero(cause) => one_cause(robot, cause, 0),
            Fold::One(cause) => one_cause(robot, cause, 1),
            Fold::Constant => "constants".to_owned(),
            Fold::Cancelled => "x - x".to_owned(),
            Fold::Shared => "computed before".to_owned(),
            Fold::Unused => "not needed".to_owned(),
        };
        *reasons.entry(reason).or_default() += count;
    }
    let mut reasons: Vec<(usize, String)> = reasons.into_iter().map(|(reason, count)| (count, reason)).collect();
    reasons.sort_by_key(|&(count, _)| std::cmp::Reverse(count));
    // if only one reason would be left, it is named instead of counted
    let named = most.filter(|&most| most + 1 < reasons.len()).unwrap_or(reasons.len());
    let others = reasons.split_off(named).into_iter().map(|(count, _)| count).sum();
    (before != (0, 0)).then_some(Folds { before, left, reasons, others })
}

/// Returns causes in words; `magnitude`, 0 or 1, is the absolute value that they give a number. Causes with the same
/// words are combined: d1_x = d1_y = 0.
#[must_use]
pub fn reason(robot: &Robot, causes: &Causes, magnitude: u8) -> String {
    let mut words: Vec<String> = causes.iter().map(|cause| one_cause(robot, cause, magnitude)).collect();
    words.dedup();
    for (likeness, joint) in [(" = 0", " = "), (" in frame 0", ", ")] {
        let alike: Vec<usize> = (0..words.len()).filter(|&index| words[index].ends_with(likeness)).collect();
        let (Some(&first), true) = (alike.first(), alike.len() > 1) else { continue };
        let stems: Vec<&str> = alike.iter().map(|&index| words[index].trim_end_matches(likeness)).collect();
        let told = format!("{}{likeness}", stems.join(joint)).replace(", gravity has", ",");
        words[first] = told;
        let mut index = 0;
        words.retain(|_| {
            index += 1;
            index - 1 == first || !alike.contains(&(index - 1))
        });
    }
    words.join(" and ")
}

fn one_cause(robot: &Robot, cause: Cause, magnitude: u8) -> String {
    let Cause::Table(name) = cause else { return cause.to_string() };
    let name = name.of_upper_half();
    let row = robot.joints.get(name.joint.wrapping_sub(1)).map(|joint| &joint.row.dh);
    match (name.quantity, row) {
        (Quantity::TwistSine | Quantity::TwistCosine, Some(dh)) => {
            format!("alpha{} = {}", name.joint, angle(&dh.alpha))
        }
        (Quantity::ThetaSine | Quantity::ThetaCosine, Some(dh)) => {
            format!("theta{} = {}", name.joint, angle(&dh.theta))
        }
        // a factor of -1 is removed as a factor of 1 is
        _ if magnitude == 1 && name.quantity != Quantity::TipRotation => format!("{name} is 1 or -1"),
        _ => Cause::Table(name).to_string(),
    }
}
