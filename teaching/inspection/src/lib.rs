//! The compiler's knowledge of an arm as data: for every component of every step the general equation, the equation for
//! this robot, the terms that were folded away with the zeros that cause it, the remaining code, units, frames and
//! counts of operations.
//!
//! [`inspect`] makes an inspection, which serde can write as JSON. Text, pages and plots only display it; they do not
//! compute dynamics themselves. This crate does not read files and does not print.
//!
//! ```
//! use rne_codegen::{Form, Function};
//!
//! let file = rne_robots::find("puma560").expect("it is shipped");
//! let robot = rne_model::Robot::from_yaml(file.yaml)?;
//! let inspection = rne_inspection::inspect(&robot, Function::InverseDynamics)?;
//! let cell = inspection.cell(2, 1).expect("joint 2 has a first step");
//! assert_eq!(cell.formulas[0].text, "ω2 = R2ᵀ ω1 + q̇2 e");
//! assert_eq!(cell.component("w2_x").expect("ω2 has an x").statements, ["w2_x"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod component;
mod name;
mod record;
mod tree;

use std::collections::{BTreeMap, BTreeSet, HashSet};

use rne_codegen::{self as codegen, CompileError, Compiler, Form, Function, Program};
use rne_emit::{Line, Selection};
use rne_model::Angle;

use crate::component::{Equations, owner};
pub use crate::record::{
    Became, Cell, Component, Counts, Folded, Follows, Formula, Inspection, Joint, Name, Operations, Quantity, Robot,
    SineCosine, Statement, Transform,
};
pub use crate::tree::{Mark, Tree};

/// The version of the shape.
pub const VERSION: u32 = 1;

/// Compiles the seven steps of a function and inspects the program.
///
/// # Errors
/// When the function does not compile: [`Compiler::compile`].
pub fn inspect(robot: &rne_model::Robot, function: Function) -> Result<Inspection, CompileError> {
    let program = Compiler::new(robot).with_equations().compile(function, Form::SevenSteps)?;
    Ok(Inspection::new(robot, &program))
}

impl Inspection {
    /// Inspects a program. It needs equations ([`Compiler::with_equations`]) to describe components.
    #[must_use]
    pub fn new(robot: &rne_model::Robot, program: &Program) -> Self {
        let mut equations = Equations::new(robot, program);
        let (before, after) = (program.before(), program.operations());
        let statements = rust(robot, program);
        let components: HashSet<codegen::Name> = program.equations.iter().map(|equation| equation.name).collect();
        let table = equations.components(|equation| equation.place.is_none());
        let cells = cells(robot, program, &mut equations);
        let names = names(program);
        Self {
            schema: "rne-inspection",
            version: VERSION,
            generator: concat!("rne ", env!("CARGO_PKG_VERSION")).to_owned(),
            robot: described(robot),
            function: program.function.to_string(),
            form: program.form.to_string(),
            refusals: program.refusals.iter().map(ToString::to_string).collect(),
            counts: Counts {
                before: Operations { products: before.0, sums: before.1 },
                after: Operations { products: after.mul, sums: after.add },
                divisions: after.div,
                angles: after.sincos,
                statements: after.statements,
            },
            quantities: names
                .iter()
                .map(|name| (name::quantity(name.quantity), name::of_quantity(robot, name.quantity)))
                .collect(),
            names: names.iter().map(|name| (name.to_string(), name::record(*name))).collect(),
            reasons: equations.into_reasons(),
            arguments: program.arguments().map(|name| name.to_string()).collect(),
            constants: program.constants().map(|constant| (constant.name.to_string(), constant.value)).collect(),
            angles: program
                .angles
                .iter()
                .map(|statement| of_statement(program, &components, statement, &statements))
                .collect(),
            sines_and_cosines: program.sines_and_cosines.iter().map(|turn| sine_and_cosine(program, turn)).collect(),
            statements: program
                .statements
                .iter()
                .map(|statement| of_statement(program, &components, statement, &statements))
                .collect(),
            outputs: program
                .outputs
                .iter()
                .map(|output| (output.name.to_string(), Tree::of_expression(program.values.used(output.value))))
                .collect(),
            table,
            cells,
        }
    }

    /// Returns a step of a joint; both count from 1.
    #[must_use]
    pub fn cell(&self, joint: usize, step: usize) -> Option<&Cell> {
        self.cells.iter().find(|cell| cell.joint == joint && cell.step == step)
    }

    /// Returns the unit of a name; empty for plain numbers.
    #[must_use]
    pub fn unit(&self, name: &str) -> &'static str {
        let Some((name, quantity)) = self.meaning(name) else { return "" };
        let kind = self.robot.joints.get(name.joint.wrapping_sub(1)).map_or("revolute", |joint| joint.kind);
        quantity.units[usize::from(kind == "prismatic")]
    }

    /// Returns the number of the joint in whose link axes a name is expressed; 0 for the base.
    #[must_use]
    pub fn frame(&self, name: &str) -> Option<usize> {
        let (name, quantity) = self.meaning(name)?;
        match quantity.axes? {
            "link" => Some(name.joint),
            _ => self.robot.joints.get(name.joint.wrapping_sub(1)).map(|joint| joint.parent),
        }
    }

    /// Returns the meaning of a name, and its quantity.
    #[must_use]
    pub fn meaning(&self, name: &str) -> Option<(&Name, &Quantity)> {
        let name = self.names.get(name)?;
        Some((name, self.quantities.get(&name.quantity)?))
    }

    /// Returns a component of any step, or of the table.
    #[must_use]
    pub fn component(&self, name: &str) -> Option<&Component> {
        let of_cells = self.cells.iter().flat_map(|cell| &cell.components);
        of_cells.chain(&self.table).find(|component| component.name == name)
    }
}

impl Cell {
    /// Returns one of the components of this cell.
    #[must_use]
    pub fn component(&self, name: &str) -> Option<&Component> {
        self.components.iter().find(|component| component.name == name)
    }
}

/// Returns the steps of the joints with their equations; empty if the program has no equations.
fn cells(robot: &rne_model::Robot, program: &Program, equations: &mut Equations<'_>) -> Vec<Cell> {
    if program.equations.is_empty() {
        return Vec::new();
    }
    let what = Selection { explain: true, ..Selection::default() };
    let listing = rne_emit::listing(robot, program, what);
    let mut cells = Vec::new();
    for section in &listing.sections {
        let Some((joint, step, None)) = section.place else { continue };
        let place = |equation: &codegen::Equation| {
            equation.place.is_some_and(|place| place.joint == joint && place.step == step)
        };
        let mut cell = Cell {
            joint,
            step: step.number(),
            title: step.title(),
            formulas: Vec::new(),
            before: Operations::default(),
            after: Operations::default(),
            reasons: Vec::new(),
            components: equations.components(place),
        };
        for line in &section.lines {
            match line {
                Line::Formula(formula) => {
                    let quantity = name::quantity(formula.quantity);
                    cell.formulas.push(Formula { quantity, text: formula.text.clone() });
                }
                Line::Folds(folds) => {
                    cell.before = Operations { products: folds.before.0, sums: folds.before.1 };
                    cell.after = Operations { products: folds.left.0, sums: folds.left.1 };
                    cell.reasons.clone_from(&folds.reasons);
                }
                _ => {}
            }
        }
        cells.push(cell);
    }
    cells
}

/// Returns the text of each statement in Rust, by name.
fn rust(robot: &rne_model::Robot, program: &Program) -> BTreeMap<String, String> {
    let listing = rne_emit::listing(robot, program, Selection::default());
    let lines = listing.sections.iter().flat_map(|section| &section.lines);
    let statement = |line: &Line<'_>| match line {
        Line::Statement(statement, _) => Some((statement.name.to_string(), line.annotated().to_string())),
        _ => None,
    };
    lines.filter_map(statement).collect()
}

fn of_statement(
    program: &Program,
    components: &HashSet<codegen::Name>,
    statement: &codegen::Statement,
    rust: &BTreeMap<String, String>,
) -> Statement {
    let (name, owner) = (statement.name.to_string(), owner(statement));
    let value = Tree::of_expression(program.values.defined(statement.value));
    Statement {
        component: components.contains(&owner).then(|| owner.to_string()),
        rust: rust.get(&name).cloned().unwrap_or_else(|| format!("let {name} = {value};")),
        name,
        value,
    }
}

fn sine_and_cosine(program: &Program, turn: &codegen::SineCosine) -> SineCosine {
    let text = |name: &Option<codegen::Name>| name.map(|name| name.to_string());
    let joint = turn.sine.or(turn.cosine).map_or(turn.place.joint, |name| name.joint);
    let angle = Tree::of_expression(program.values.used(turn.angle));
    SineCosine { joint, sine: text(&turn.sine), cosine: text(&turn.cosine), angle }
}

/// Returns every name of the program.
fn names(program: &Program) -> BTreeSet<codegen::Name> {
    let turned = program.sines_and_cosines.iter().flat_map(|turn| turn.sine.into_iter().chain(turn.cosine));
    let written = program.equations.iter().flat_map(|of| std::iter::once(of.name).chain(of.term.names()));
    let stated = program.angles.iter().chain(&program.statements).map(|statement| statement.name);
    let constants = program.constants().map(|constant| constant.name);
    let outputs = program.outputs.iter().map(|output| output.name);
    let all = program.arguments().chain(constants).chain(turned).chain(written).chain(stated);
    all.chain(outputs).collect()
}

fn described(robot: &rne_model::Robot) -> Robot {
    let transform =
        |of: &rne_model::Transform| Transform { xyz: of.xyz, rpy: of.rpy.map(|angle: Angle| angle.radians) };
    let joint = |(index, joint): (usize, &rne_model::Joint)| {
        let (row, inertia) = (&joint.row, joint.row.link.inertia);
        Joint {
            name: joint.name.clone(),
            kind: row.kind.name(),
            parent: name::parent(robot, index + 1),
            begins: joint.branch.map(|branch| branch.placement).filter(|it| !it.is_identity()).map(|it| transform(&it)),
            follows: joint.coupling.as_ref().map(|coupling| Follows {
                ratios: coupling.follows.iter().map(|&(followed, ratio)| (followed + 1, ratio)).collect(),
                offset: coupling.offset,
            }),
            theta: row.dh.theta.radians,
            d: row.dh.d,
            a: row.dh.a,
            alpha: row.dh.alpha.radians,
            mass: row.link.mass,
            com: row.link.com,
            first_moment: row.link.has_first_moment().then_some(row.link.first_moment),
            inertia: [inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.xz, inertia.yz],
            position_limits: joint.limits.position.map(Into::into),
            velocity_limit: joint.limits.velocity,
            effort_limit: joint.limits.effort,
        }
    };
    Robot {
        name: robot.name.clone(),
        title: robot.title.clone().unwrap_or_else(|| robot.name.clone()),
        source: robot.source.clone(),
        convention: robot.convention.name(),
        gravity: robot.gravity,
        base: transform(&robot.base),
        tool: transform(&robot.tool),
        tip: name::parent(robot, robot.joints.len() + 1),
        joints: robot.joints.iter().enumerate().map(joint).collect(),
    }
}
