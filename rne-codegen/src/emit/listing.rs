//! Annotated code for reading: each step's formula, its statements, what each component became, and what folded.

use std::collections::BTreeMap;
use std::fmt::Write;

use rne_model::{JointKind, Robot};

use super::expression::statement as written;
use super::formula::{formulas, reduced_formulas};
use super::syntax::Syntax;
use super::table::angle;
use super::text::returned;
use crate::function::{Form, Function};
use crate::ir::ledger::{Cause, Causes, Fate, Ledger, Place};
use crate::ir::name::{By, Name};
use crate::ir::quantity::{Quantity, Step};
use crate::program::{Expression, Finding, Found, Program, Sign, Statement, Turn};

/// Width of a comment.
const WIDTH: usize = 100;

/// Which part of a program to list, and how much to say.
#[derive(Clone, Copy, Debug, Default)]
pub struct Listing {
    /// One joint only, counted from 1.
    pub joint: Option<usize>,
    /// One step only.
    pub step: Option<Step>,
    /// Say what components became that are no statement, and what folded.
    pub explain: bool,
    /// Name at most so many reasons why operations are gone, the commonest first.
    pub reasons: Option<usize>,
}

/// The statements of a program as Rust text with a comment per joint and step.
#[must_use]
pub fn listing(robot: &Robot, program: &Program, what: Listing) -> String {
    listing_in(Syntax::Rust, robot, program, what)
}

/// The statements of a program as text of a language.
pub(super) fn listing_in(syntax: Syntax, robot: &Robot, program: &Program, what: Listing) -> String {
    // only what returns torques keeps to joints and steps
    if program.form != Form::SevenSteps
        || !(program.function.returns_torques() || program.function == Function::JointWrenches)
    {
        return in_order(syntax, robot, program, what);
    }
    let mut text = String::new();
    for (joint, step) in sections(program.dof) {
        if !what.includes(joint, step) {
            continue;
        }
        let here = |place: &Place| place.joint == joint && place.step == step;
        let statements: Vec<&Statement> =
            program.statements.iter().filter(|statement| here(&statement.place)).collect();
        let turns: Vec<&Turn> = program.turns.iter().filter(|turn| here(&turn.place)).collect();
        if statements.is_empty() && turns.is_empty() && !what.explain {
            continue;
        }
        heading(&mut text, robot, program, joint, step);
        for turn in turns {
            let _ = writeln!(text, "    // {}", turn_line(syntax, turn));
        }
        for statement in statements {
            let _ = writeln!(text, "{}", statement_line(syntax, statement));
        }
        if what.explain {
            explain(&mut text, robot, program, joint, step, what.reasons);
        }
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

impl Listing {
    fn includes(&self, joint: usize, step: Step) -> bool {
        self.joint.is_none_or(|only| only == joint) && self.step.is_none_or(|only| only == step)
    }
}

/// A program whose statements do not keep to joints and steps, in the order in which they are computed.
fn in_order(syntax: Syntax, robot: &Robot, program: &Program, what: Listing) -> String {
    let mut text = String::new();
    if what.explain && what.joint.is_none() && what.step.is_none() {
        // numbers that stand in no table
        for constant in &program.constants {
            let _ = writeln!(text, "    let {} = {:?};", constant.name, constant.value);
        }
        for statement in &program.angles {
            let _ = writeln!(text, "{}", statement_line(syntax, statement));
        }
        for turn in &program.turns {
            let _ = writeln!(text, "    // {}", turn_line(syntax, turn));
        }
        text.push('\n');
    }
    let mut section = None;
    for statement in &program.statements {
        let place = shown_place(program, statement);
        let Place { joint, step, by, .. } = place;
        if !what.includes(joint, step) {
            continue;
        }
        let title = match (by, step) {
            (Some(by), _) => by_title(program, joint, step, by),
            (None, Step::Beyond) => beyond_title(program, place.quantity, joint),
            (None, _) => step_title(program, joint, step),
        };
        if !program.is_rewritten && section.as_ref() != Some(&title) {
            if section.is_some() {
                text.push('\n');
            }
            if by.is_some() || step == Step::Beyond {
                let _ = writeln!(text, "    // {title}");
            } else {
                heading(&mut text, robot, program, joint, step);
            }
            section = Some(title);
        }
        let _ = writeln!(text, "{}", statement_line(syntax, statement));
    }
    let is_whole = what.explain && what.joint.is_none() && what.step.is_none();
    let has_shape = !program.function.returns_torques() && program.outputs.len() > 1;
    if let Some(returned) = returned(program).filter(|_| is_whole && has_shape) {
        let _ = writeln!(text, "\n    // {}\n    {returned}", program.function.entry().listed);
    }
    text
}

/// The place under which a statement is listed: that of its name, where it has a step. A value that two formulas share
/// stands at the first of them, whose joint and step may be others.
fn shown_place(program: &Program, statement: &Statement) -> Place {
    let Statement { name, place, .. } = statement;
    let has_own_form = program.form != Form::SevenSteps && Function::TORQUES.contains(&program.function);
    match name.quantity.step() {
        // the last row of the solution is what is returned
        _ if name.quantity == Quantity::RateDot => {
            Place { joint: name.joint, step: Step::Beyond, quantity: Quantity::Scaled, by: None }
        }
        Some(step) if !has_own_form => Place { joint: name.joint, step, quantity: name.quantity, by: name.by },
        _ => *place,
    }
}

/// The heading of derivatives, and of what one joint accelerates.
fn by_title(program: &Program, joint: usize, step: Step, by: By) -> String {
    let what = match step {
        Step::Beyond => format!("joint {joint}"),
        _ => step_title(program, joint, step),
    };
    match by {
        By::RateDot(by) => format!("{what}, for q̈{by} = 1 alone"),
        By::Position(by) => format!("{what}, by q{by}"),
        By::Rate(by) => format!("{what}, by q̇{by}"),
    }
}

/// The heading of what is none of the seven steps: the function's own, or what several functions share.
fn beyond_title(program: &Program, quantity: Quantity, joint: usize) -> String {
    if let Some(own) = program.function.own(quantity) {
        return (own.heading)(joint);
    }
    match quantity {
        Quantity::FrameRotation | Quantity::FrameOrigin if joint > program.dof => "the tip in the world".to_owned(),
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

fn heading(text: &mut String, robot: &Robot, program: &Program, joint: usize, step: Step) {
    let kind = robot.joints.get(joint.wrapping_sub(1)).map_or(JointKind::Revolute, |joint| joint.row.kind);
    let _ = writeln!(text, "    // {}", step_title(program, joint, step));
    let formulas = match recursion(program) {
        // the lecture's base is at rest
        _ if joint == 0 => Vec::new(),
        Form::SevenSteps => formulas(step, kind, joint),
        _ if program.is_of_bodies() => Vec::new(),
        _ => reduced_formulas(step, kind, joint),
    };
    for formula in formulas {
        let _ = writeln!(text, "    // {formula}");
    }
}

/// The recursion of which a program is made: the regressor and what is made of the reduced recursion know origins of
/// frames, not centres of mass.
fn recursion(program: &Program) -> Form {
    let is_reduced = program.form != Form::SevenSteps
        && (Function::TORQUES.contains(&program.function) || !program.choices.is_empty());
    if is_reduced || program.function == Function::Regressor { Form::Reduced } else { Form::SevenSteps }
}

fn step_title(program: &Program, joint: usize, step: Step) -> String {
    if program.is_of_bodies() && step == Step::Wrenches {
        return format!("joint {joint}: the links from here on, as one body");
    }
    let title = match (recursion(program), step) {
        (Form::SevenSteps, _) => step.title(),
        (_, Step::Acceleration) => "acceleration of the frame's origin",
        (_, Step::AngularAcceleration) => "angular acceleration, accelerations of points",
        _ => step.title(),
    };
    let of = if joint == 0 { "base".to_owned() } else { format!("joint {joint}") };
    format!("{of}, step {}: {title}", step.number())
}

/// Which sine and cosine stand at the head of the function.
fn turn_line(syntax: Syntax, turn: &Turn) -> String {
    let names: Vec<(String, &str)> = [(turn.sine, "sine"), (turn.cosine, "cosine")]
        .into_iter()
        .filter_map(|(name, what)| Some((name?.to_string(), what)))
        .collect();
    let (names, what): (Vec<String>, Vec<&str>) = names.into_iter().unzip();
    format!("{}: {} of {}", names.join(", "), what.join(" and "), super::expression::line(syntax, &turn.angle))
}

/// Joints and steps in the order of the recursion: out with steps 1 to 5, back with 6 and 7.
fn sections(dof: usize) -> impl Iterator<Item = (usize, Step)> {
    let outward = (1..=dof).flat_map(|joint| Step::ALL[..5].iter().map(move |&step| (joint, step)));
    let inward = (1..=dof).rev().flat_map(|joint| Step::ALL[5..].iter().map(move |&step| (joint, step)));
    outward.chain(inward)
}

/// One statement, on a line or several.
pub(super) fn statement_line(syntax: Syntax, statement: &Statement) -> String {
    written(syntax, "    ", &format!("{} {} =", syntax.declaration(), statement.name), &statement.value)
}

fn explain(text: &mut String, robot: &Robot, program: &Program, joint: usize, step: Step, most: Option<usize>) {
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for Finding { name, value } in &program.findings {
        let quantity = name.quantity;
        if name.joint != joint || quantity.step() != Some(step) || !quantity.is_of_the_lecture() {
            continue;
        }
        let Some(became) = became(robot, *name, value) else { continue };
        match groups.iter_mut().find(|(other, _)| *other == became) {
            Some((_, names)) => names.push(name.to_string()),
            None => groups.push((became, vec![name.to_string()])),
        }
    }
    for (became, names) in groups {
        comment(text, &format!("{}{became}", names.join(", ")));
    }
    if let Some(line) = folded(robot, &program.ledger, |place| place.joint == joint && place.step == step, most) {
        comment(text, &line);
    }
}

/// A blank at which no comment breaks.
const TIED: &str = "\u{A0}";

/// A comment, broken between words where it is too long; the lines after the first are indented.
fn comment(text: &mut String, comment: &str) {
    let mut line = "    //".to_owned();
    for word in comment.split(' ') {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(text, "{}", line.replace(TIED, " "));
            "    //  ".clone_into(&mut line);
        }
        line.push(' ');
        line.push_str(word);
    }
    let _ = writeln!(text, "{}", line.replace(TIED, " "));
}

fn became(robot: &Robot, name: Name, found: &Found) -> Option<String> {
    Some(match found {
        // the statement says it
        Found::Computed => return None,
        Found::Same(..) if name.quantity == Quantity::Torque => return None,
        Found::Same(other, Sign::Plus) => format!(" = {other}"),
        Found::Same(other, Sign::Minus) => format!(" = -{other}"),
        Found::Constant(0.0, causes) => format!(" = 0: {}", why(robot, causes, 0)),
        Found::Constant(value, causes) if causes.iter().any(|cause| matches!(cause, Cause::GravityDirection(_))) => {
            format!(" = {value}: gravity in frame 0")
        }
        Found::Constant(value, _) => format!(" = {value}, of constants"),
        Found::Inside => ": inside the statement that uses it".to_owned(),
        Found::Unused if name.quantity == Quantity::InertiaForce => " = m c̈: inside m (c̈ - g)".to_owned(),
        Found::Unused => ": not needed".to_owned(),
    })
}

/// How many operations are left at the places that pass, and why the others are not there.
fn folded(robot: &Robot, ledger: &Ledger, here: impl Fn(&Place) -> bool, most: Option<usize>) -> Option<String> {
    let (products, sums) = ledger.total(|line| here(&line.place));
    if products + sums == 0 {
        return None;
    }
    let (kept_products, kept_sums) = ledger.total(|line| here(&line.place) && line.fate == Fate::Kept);
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    for line in ledger.lines().filter(|line| here(&line.place)) {
        let reason = match line.fate {
            Fate::Kept => continue,
            Fate::Zero(cause) => one_cause(robot, cause, 0),
            Fate::One(cause) => one_cause(robot, cause, 1),
            Fate::Constant => "constants".to_owned(),
            Fate::Cancelled => "x - x".to_owned(),
            Fate::Shared => "computed before".to_owned(),
            Fate::Unused => "not needed".to_owned(),
        };
        *reasons.entry(reason).or_default() += line.count;
    }
    let mut reasons: Vec<(String, usize)> = reasons.into_iter().collect();
    reasons.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    // naming the last one takes no more room than counting it
    let named = most.filter(|&most| most + 1 < reasons.len()).unwrap_or(reasons.len());
    let others: usize = reasons.iter().skip(named).map(|(_, count)| count).sum();
    let mut gone: Vec<String> =
        reasons.iter().take(named).map(|(reason, count)| format!("{count} ({reason})").replace(' ', TIED)).collect();
    if others > 0 {
        gone.push(format!("{others} for other reasons"));
    }
    let mut text = format!("{products} products and {sums} sums, {kept_products} and {kept_sums} left");
    if !gone.is_empty() {
        let _ = write!(text, ". Gone: {}", gone.join(", "));
    }
    Some(text)
}

/// Causes in the words of the table; `magnitude` is what they made of a number, 0 or 1. Likes are told in one breath:
/// d1_x = d1_y = 0.
fn why(robot: &Robot, causes: &Causes, magnitude: u8) -> String {
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
        // a factor of -1 is folded like 1
        _ if magnitude == 1 && name.quantity != Quantity::TipRotation => format!("{name} is 1 or -1"),
        _ => Cause::Table(name).to_string(),
    }
}

impl Program {
    /// Whether the constant 0 stands somewhere: where it is returned, or chosen by a sign.
    pub(super) fn returns_zero(&self) -> bool {
        let statements = self.statements.iter().map(|statement| &statement.value);
        self.outputs.iter().map(|output| &output.value).chain(statements).any(Expression::has_zero)
    }
}
