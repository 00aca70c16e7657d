//! The annotated code of a program as data: each step's formulas, its statements, what each component became, and what
//! folded. Text, colour and whatever else shows it are renderers.

use std::collections::{BTreeMap, HashSet};
use std::fmt;

use rne_codegen::{
    Argument, Cause, Causes, Constant, Expression, Fold, FoldReport, Form, Function, Length, Name, Place, Program,
    Quantity, Record, Resolution, ResolvedAs, Shape, Sign, SineCosine, Statement, Step, WithRespectTo,
};
use rne_model::{Joint, JointKind, Robot, one_line};

use super::annotated::{Annotated, Part};
use super::expression;
use super::formula::{Formula, Numbers, base_formulas, formulas, payload_formulas, reduced_formulas};
use super::line_breaks::statement as written;
use super::syntax::Syntax;
use super::table::angle;
use super::text::returned;
use super::wrap::{TIED, WIDTH, fill};

/// The part of a program to list, and how much of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Selection {
    /// One joint only, counted from 1.
    pub joint: Option<usize>,
    /// One step only.
    pub step: Option<Step>,
    /// Say what components became that are no statement, and what folded.
    pub explain: bool,
    /// Largest number of reasons why operations are gone that are named, the commonest first.
    pub reasons: Option<usize>,
}

impl Selection {
    fn includes(&self, joint: usize, step: Step) -> bool {
        self.joint.is_none_or(|only| only == joint) && self.step.is_none_or(|only| only == step)
    }

    fn is_everything(&self) -> bool {
        self.explain && self.joint.is_none() && self.step.is_none()
    }
}

/// A program, or a part of it, for reading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Listing<'a> {
    /// The sections, in order.
    pub sections: Vec<Section<'a>>,
}

/// Lines of one section: the statements of one step for one joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section<'a> {
    /// The joint and the step, and of which variable the statements are derivatives; `None` for what belongs to no
    /// step: the constants and angles at the head of a function, what it returns, and a program without sections.
    pub place: Option<(usize, Step, Option<WithRespectTo>)>,
    /// Its lines, in order.
    pub lines: Vec<Line<'a>>,
}

/// A line of a listing. Every [`Name`] in it has a quantity, a joint and an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Line<'a> {
    /// The heading of the section.
    Heading(String),
    /// A formula of its step.
    Formula(Formula),
    /// A number that stands in no table.
    Constant(Constant),
    /// A sine and cosine at the head of the function.
    SineCosine(&'a SineCosine, Expression<'a>),
    /// A statement and its value.
    Statement(&'a Statement, Expression<'a>),
    /// The fate of components that have no statement.
    Resolution {
        /// The components.
        names: Vec<Name>,
        /// Their fate, with the sign or word between.
        became: Annotated,
    },
    /// How many operations are left, and why the others are gone.
    Folds(Folds),
    /// The results of the function.
    Returned(Annotated),
}

/// The effect of folding on the operations of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folds {
    /// Products and sums of the formulas.
    pub before: (usize, usize),
    /// Products and sums that are left.
    pub left: (usize, usize),
    /// How many are gone for which reason, the commonest first.
    pub reasons: Vec<(usize, String)>,
    /// How many are gone for other reasons.
    pub others: usize,
}

impl Listing<'_> {
    /// Whether the text is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// The listing in a language: blank lines between the sections.
    pub(super) fn text(&self, syntax: Syntax) -> String {
        let section =
            |section: &Section| -> String { section.lines.iter().map(|line| line.indented(syntax) + "\n").collect() };
        self.sections.iter().map(section).collect::<Vec<_>>().join("\n")
    }
}

impl<'a> Line<'a> {
    /// A statement of a program.
    pub(super) fn statement(program: &'a Program, statement: &'a Statement) -> Self {
        Self::Statement(statement, program.values.defined(statement.value))
    }

    fn turn(program: &'a Program, turn: &'a SineCosine) -> Self {
        Self::SineCosine(turn, program.values.used(turn.angle))
    }

    /// The line as words and code of Rust, neither indented nor marked as a comment.
    #[must_use]
    pub fn annotated(&self) -> Annotated {
        self.annotated_in(Syntax::Rust, "")
    }

    /// Whether it is a comment of the code.
    #[must_use]
    pub const fn is_comment(&self) -> bool {
        !matches!(self, Self::Constant(_) | Self::Statement(..) | Self::Returned(_))
    }

    fn annotated_in(&self, syntax: Syntax, indent: &str) -> Annotated {
        let names = |names: &[Name]| Annotated::join(names.iter().map(|&name| name.into()), ", ");
        match self {
            Self::Heading(words) => words.clone().into(),
            Self::Formula(formula) => formula.text.clone().into(),
            Self::Constant(Constant { name, value }) => {
                let value = Annotated::part(Part::Number, format!("{value:?}"));
                Annotated::default() + indent + declaration(syntax, *name) + " " + value + ";"
            }
            Self::SineCosine(SineCosine { sine, cosine, .. }, angle) => {
                let what = match (sine, cosine) {
                    (Some(_), Some(_)) => "sine and cosine",
                    (Some(_), None) => "sine",
                    _ => "cosine",
                };
                let turned: Vec<Name> = sine.iter().chain(cosine).copied().collect();
                names(&turned) + ": " + what + " of " + expression::line(syntax, *angle)
            }
            Self::Statement(Statement { name, .. }, value) => {
                written(syntax, indent, declaration(syntax, *name), *value)
            }
            Self::Resolution { names: found, became } => names(found) + became.clone(),
            Self::Folds(folds) => folds.to_string().into(),
            Self::Returned(code) => Annotated::default() + indent + code.clone(),
        }
    }

    /// The line inside a function.
    pub(super) fn indented(&self, syntax: Syntax) -> String {
        let text = self.annotated_in(syntax, "    ").to_string();
        if self.is_comment() { fill(&text, WIDTH, "    // ", "    //   ") } else { text }
    }
}

/// The listing in Rust.
impl fmt::Display for Listing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(Syntax::Rust))
    }
}

/// The line inside a function of Rust, as text.
impl fmt::Display for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.indented(Syntax::Rust))
    }
}

fn declaration(syntax: Syntax, name: Name) -> Annotated {
    Annotated::part(Part::Keyword, syntax.declaration()) + " " + name + " ="
}

impl fmt::Display for Folds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { before: (products, sums), left: (kept_products, kept_sums), reasons, others } = self;
        write!(f, "{products} products and {sums} sums, {kept_products} and {kept_sums} left")?;
        let mut gone: Vec<String> =
            reasons.iter().map(|(count, reason)| format!("{count} ({reason})").replace(' ', TIED)).collect();
        if *others > 0 {
            gone.push(format!("{others} for other reasons"));
        }
        if gone.is_empty() { Ok(()) } else { write!(f, ". Gone: {}", gone.join(", ")) }
    }
}

/// The statements of a program, with the headings and explanations of each joint and step.
#[must_use]
pub fn listing<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Listing<'a> {
    // only what returns torques keeps to joints and steps; the code of a floating base does not, its explanation does
    let keeps_to_steps = program.form == Form::SevenSteps
        && (program.function.returns_torques()
            || matches!(program.function.shape(), Shape::Array(Length::Joints, Shape::Record(Record::Wrench, _)))
            || what.explain && program.function == Function::InverseDynamicsOfFloatingBase);
    let mut sections = if keeps_to_steps { by_steps(robot, program, what) } else { in_order(robot, program, what) };
    sections.retain(|section| !section.lines.is_empty());
    Listing { sections }
}

fn by_steps<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Vec<Section<'a>> {
    // out with steps 1 to 5, back with 6 and 7
    // a payload is one link more
    let last = program.joints + usize::from(program.function.takes(Argument::Payload));
    let floats = program.function.is_of_floating_base();
    let first = usize::from(!(floats && robot.floating_base.is_some()));
    let outward = (first..=last).flat_map(|joint| Step::ALL[..5].iter().map(move |&step| (joint, step)));
    let inward = (first..=last).rev().flat_map(|joint| Step::ALL[5..].iter().map(move |&step| (joint, step)));
    let mut sections = Vec::new();
    // several steps use them, and not the first one first
    let of_parameters = of_parameters(program);
    if what.joint.is_none() && what.step.is_none() && !of_parameters.is_empty() {
        let heading = Line::Heading("numbers of the table, from the parameters".to_owned());
        let statements = program.statements.iter().filter(|statement| of_parameters.contains(&statement.name));
        let lines =
            std::iter::once(heading).chain(statements.map(|statement| Line::statement(program, statement))).collect();
        sections.push(Section { place: None, lines });
    }
    let is_of_links = |joint, step| match step {
        // nobody gives the velocity of a floating base
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

/// The statements that depend on run-time parameters alone.
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

/// A program whose statements do not keep to joints and steps, in the order in which they are computed.
fn in_order<'a>(robot: &Robot, program: &'a Program, what: Selection) -> Vec<Section<'a>> {
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

/// The place under which a statement is listed: that of its name, where it has a step. A value that two formulas share
/// stands at the first of them, whose joint and step may be others.
fn shown_place(program: &Program, statement: &Statement) -> Place {
    let Statement { name, place, .. } = statement;
    let has_own_form = program.form != Form::SevenSteps && Function::TORQUES.contains(&program.function);
    match name.quantity.step() {
        // the last row of the solution is the result
        _ if name.quantity == Quantity::RateDot => {
            Place { joint: name.joint, step: Step::Beyond, quantity: Quantity::Scaled, by: None }
        }
        Some(step) if !has_own_form => Place { joint: name.joint, step, quantity: name.quantity, by: name.by },
        _ => *place,
    }
}

/// The heading of derivatives, and of what one joint accelerates.
fn by_title(robot: &Robot, program: &Program, joint: usize, step: Step, by: WithRespectTo) -> String {
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

/// The heading of a formula beyond the seven steps: the function's own, or what several functions share.
fn beyond_title(program: &Program, quantity: Quantity, joint: usize) -> String {
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

/// Whether the link of a joint, counted from 1, has a first moment and no mass.
fn has_first_moment(robot: &Robot, joint: usize) -> bool {
    robot.joints.get(joint.wrapping_sub(1)).is_some_and(|joint| joint.row.link.has_first_moment())
}

fn heading<'a>(robot: &Robot, program: &Program, joint: usize, step: Step) -> Vec<Line<'a>> {
    let kind = robot.joints.get(joint.wrapping_sub(1)).map_or(JointKind::Revolute, |joint| joint.row.kind);
    let numbers = Numbers::of(robot, joint, program.function);
    let formulas = match recursion(program) {
        // the lecture's base is at rest
        _ if joint == 0 => Vec::new(),
        Form::SevenSteps if joint > program.joints => payload_formulas(step, &numbers),
        Form::SevenSteps => formulas(step, kind, &numbers, has_first_moment(robot, joint)),
        Form::Reduced if program.is_of_bodies() => Vec::new(),
        Form::Reduced => reduced_formulas(step, kind, &numbers),
    };
    let title = Line::Heading(step_title(robot, program, joint, step));
    std::iter::once(title).chain(formulas.into_iter().map(Line::Formula)).collect()
}

/// The recursion of which a program is made: the regressor and what is made of the reduced recursion know origins of
/// frames, not centres of mass.
pub(super) fn recursion(program: &Program) -> Form {
    let is_reduced = program.form != Form::SevenSteps
        && (Function::TORQUES.contains(&program.function) || !program.choices.is_empty());
    if is_reduced || program.function == Function::Regressor { Form::Reduced } else { Form::SevenSteps }
}

/// A joint by its number; on a tree, where the number alone does not say the branch, with its name.
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

fn resolutions<'a>(robot: &Robot, program: &Program, joint: usize, step: Step) -> Vec<Line<'a>> {
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
        // the statement shows it
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

/// How many operations are left at the places that pass, and why the others are not there.
fn folds(robot: &Robot, fold_report: &FoldReport, here: impl Fn(&Place) -> bool, most: Option<usize>) -> Option<Folds> {
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
    // naming the last one takes no more room than counting it
    let named = most.filter(|&most| most + 1 < reasons.len()).unwrap_or(reasons.len());
    let others = reasons.split_off(named).into_iter().map(|(count, _)| count).sum();
    (before != (0, 0)).then_some(Folds { before, left, reasons, others })
}

/// Causes in the words of the table; `magnitude` is what they made of a number, 0 or 1. Likes are told in one breath:
/// d1_x = d1_y = 0.
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
        // a factor of -1 is folded like 1
        _ if magnitude == 1 && name.quantity != Quantity::TipRotation => format!("{name} is 1 or -1"),
        _ => Cause::Table(name).to_string(),
    }
}
