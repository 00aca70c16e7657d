//! Lowering: turns a graph into named statements. It finds the live nodes, and decides which of them get names and with
//! which sign each is written.

mod cells;
mod equations;
mod writing;

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::{FxHashMap, FxHashSet};

use rne_model::{JointKind, Robot};
use writing::Writing;

use crate::CompileError;
use crate::function::OfRobot as _;
use crate::function::{Form, Function};
use crate::ir::derivation;
use crate::ir::{ExactAngle, Exactly, Indices, Name, Number, Op, Operation, Place, Quantity, Ref, Sign, Step, Traced};
use crate::program::{Constant, Order, Program, Resolution, ResolvedAs};
use crate::reduced::Algorithm;
use crate::values::{Value, Values};

/// The position of a statement: the index of its node, and its order among the statements after this node.
type Position = (usize, usize);

/// The robot, function and form of a program.
pub(crate) struct Heading<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) function: Function,
    pub(crate) form: Form,
}

/// Turns a written graph into a program that returns its outputs under these names. Also returns the exact values of
/// its constants.
pub(crate) fn lower(
    heading: &Heading<'_>,
    mut written: Traced,
    names: &[Name],
) -> Result<(Program, Exactly), CompileError> {
    leave_names_to_arguments(&mut written);
    leave_names_to_results(&mut written, names);
    let outputs: Vec<(Name, Ref)> = names.iter().copied().zip(written.graph.outputs.iter().copied()).collect();
    let uses = count_uses(&written);
    drop_unused(&mut written, &uses);
    let lowering = Lowering::new(&written, uses, heading.form);
    let constants = lowering.constants()?;
    let exactly = constants.iter().map(|(constant, at)| (constant.name, lowering.exactly(constant, *at))).collect();
    derivation::note_program(&exactly);
    let (mut definitions, returned) = lowering.definitions(&outputs);
    definitions.sort_by_key(|definition| definition.position);
    let slides = |name: Name| {
        let joint = name.joint.checked_sub(1).and_then(|joint| heading.robot.joints.get(joint));
        joint.is_some_and(|joint| joint.row.kind == JointKind::Prismatic)
    };
    // The position of a prismatic joint is a length, but a revolute joint that follows it has it in its angle.
    let within_angles = lowering.within_angles();
    let is_angle = |definition: &Definition| {
        let Name { quantity, .. } = definition.name;
        let is_named =
            quantity.is_of_an_angle() && !(quantity == Quantity::FollowerPosition && slides(definition.name));
        is_named || (definition.is_node && within_angles.contains(&definition.at.magnitude()))
    };
    let (of_angles, definitions): (Vec<_>, Vec<_>) = definitions.into_iter().partition(is_angle);
    let mut writing = Writing { lowering: &lowering, values: Values::default(), known: FxHashMap::default() };
    for name in lowering.arguments() {
        writing.leaf(name, Value::Argument);
    }
    for (constant, _) in &constants {
        writing.leaf(constant.name, Value::Constant(constant.value));
    }
    let angles = of_angles.iter().map(|definition| writing.statement(definition)).collect();
    let sines_and_cosines = writing.sines_and_cosines();
    let statements = definitions.iter().map(|definition| writing.statement(definition)).collect();
    let outputs = returned.iter().map(|(name, value)| writing.output(*name, value)).collect();
    let resolutions = lowering.resolutions(&definitions.iter().map(|definition| definition.name).collect());
    let program = Program {
        robot: heading.robot.name.clone(),
        dof: heading.robot.dof(),
        joints: heading.robot.joints.len(),
        coordinates: heading.robot.coordinates().map(|joint| joint + 1).collect(),
        passive: heading.robot.closed.passive.iter().map(|joint| joint + 1).collect(),
        equations_of_loops: heading.robot.closed.equations(),
        parameters: heading.robot.run_time.names.len(),
        function: heading.function,
        tips: heading.robot.tip_names().into_iter().map(str::to_owned).collect(),
        frame: heading.function.frame(heading.robot).map(|frame| heading.robot.frame_name(frame).to_owned()),
        name: heading.function.name_for(heading.robot),
        form: heading.form,
        values: writing.values,
        angles,
        sines_and_cosines,
        statements,
        outputs,
        resolutions,
        equations: lowering.equations(),
        fold_report: written.trace.fold_report,
        algorithm: Algorithm::default(),
        is_rewritten: false,
        order: Order::Formulas,
        scales: Vec::new(),
        choices: Vec::new(),
        proof: None,
        loss: None,
        refusals: Vec::new(),
    };
    let mut program = program.in_written_order();
    program.check_names()?;
    cells::settle(&program.values, &mut program.statements, &program.sines_and_cosines);
    Ok((program, exactly))
}

/// Removes definitions that have the name of an argument but another value: gravity as an argument differs from gravity
/// of the table.
fn leave_names_to_arguments(written: &mut Traced) {
    let argument = |(at, op)| if let Op::Input(input) = op { Some((input.name(), at)) } else { None };
    let arguments: FxHashMap<Name, Ref> = written.graph.nodes().filter_map(argument).collect();
    let is_free = |name: &Name, at: Ref| arguments.get(name).is_none_or(|argument| *argument == at.magnitude());
    written.trace.definitions.retain(|definition| is_free(&definition.name, definition.at));
}

/// Removes definitions that have the name of a result but another value: a torque to which followers add differs from
/// the torque of the joint alone.
fn leave_names_to_results(written: &mut Traced, names: &[Name]) {
    let results: FxHashMap<Name, Ref> = names.iter().copied().zip(written.graph.outputs.iter().copied()).collect();
    let is_free = |name: &Name, at: Ref| results.get(name).is_none_or(|result| *result == at);
    written.trace.definitions.retain(|definition| is_free(&definition.name, definition.at));
}

/// Counts how often live nodes and outputs use each node; 0 is a dead node.
fn count_uses(Traced { graph, .. }: &Traced) -> Vec<usize> {
    let mut uses = vec![0_usize; graph.len()];
    for at in &graph.outputs {
        uses[at.index()] += 1;
    }
    for (at, op) in graph.nodes().rev() {
        if uses[at.index()] > 0 {
            op.operands().for_each(|operand| uses[operand.index()] += 1);
        }
    }
    uses
}

fn drop_unused(written: &mut Traced, uses: &[usize]) {
    for (at, op) in written.graph.nodes() {
        let operation = match op {
            Op::Sum(..) => Operation::Sum,
            Op::Product(..) => Operation::Product,
            _ => continue,
        };
        if uses[at.index()] == 0
            && let Some(birth) = &written.trace.births[at.index()]
        {
            written.trace.fold_report.drop_unused(birth.place, operation);
        }
    }
}

/// The name of a node in the code, and whether that name means the node's negative.
#[derive(Clone, Copy)]
struct Given {
    name: Name,
    negative: bool,
}

struct Lowering<'w> {
    written: &'w Traced,
    form: Form,
    uses: Vec<usize>,
    is_output: Vec<bool>,
    names: Vec<Option<Given>>,
    /// Whether a name means the negative of its node.
    signs: FxHashMap<Name, bool>,
}

impl<'w> Lowering<'w> {
    fn new(written: &'w Traced, uses: Vec<usize>, form: Form) -> Self {
        let mut is_output = vec![false; uses.len()];
        for at in &written.graph.outputs {
            is_output[at.index()] = true;
        }
        let definitions = written.trace.definitions.iter();
        let signs = definitions.map(|definition| (definition.name, definition.at.is_negative())).collect();
        let mut lowering = Self { written, form, names: vec![None; uses.len()], uses, is_output, signs };
        lowering.take_given_names();
        lowering.name_shared_terms();
        lowering
    }

    /// Gives each node the first of its names; a letter of the lecture wins over an auxiliary name of the same step.
    fn take_given_names(&mut self) {
        for definition in &self.written.trace.definitions {
            let (node, negative) = (definition.at.magnitude(), definition.at.is_negative());
            let quantity = definition.name.quantity;
            let slot = &mut self.names[node.index()];
            let lectures = |name: Name| name.quantity.is_of_the_lecture();
            let is_turn = matches!(self.written.graph.op(node), Op::Sine(_) | Op::Cosine(_));
            let wins = slot.is_none_or(|old| {
                // sines and cosines keep their own names
                !is_turn
                    && !lectures(old.name)
                    && lectures(definition.name)
                    && old.name.quantity.step() == quantity.step()
            });
            // aliases give no name: a torque is a component of a force or moment, a derivative may be a sine, and the
            // sine of one angle may be plus or minus the cosine of another
            let is_alias = matches!(quantity, Quantity::Torque | Quantity::AxisTorque)
                || (is_turn && (negative || definition.name.by.is_some()));
            if wins && !is_alias {
                *slot = Some(Given { name: definition.name, negative });
            }
        }
        for (id, node) in self.written.graph.nodes() {
            let index = id.index();
            match node {
                Op::Input(input) => self.names[index] = Some(Given { name: input.name(), negative: false }),
                _ if node.is_operation() => {
                    let keeps = self.names[index].is_some_and(|given| given.name.quantity.is_of_the_lecture());
                    // an auxiliary quantity that is used once gets no statement: it is clearer where it is used
                    if !keeps && self.uses[index] < 2 && !self.is_angle(id) {
                        self.names[index] = None;
                    }
                }
                _ => {}
            }
        }
        // if two values have the same name, the second one loses it, and is then named as a value without a name
        let mut taken = FxHashSet::default();
        for (given, _) in self.names.iter_mut().zip(&self.uses).filter(|(_, uses)| **uses > 0) {
            if given.is_some_and(|given| !taken.insert(given.name)) {
                *given = None;
            }
        }
    }

    /// Names terms without a name that are used more than once, and leaves without a name, after the quantity in which
    /// they were first written; a sum of another unit is named after its summand. Generated code sees only the text of
    /// a name, so a number that would give an existing text is left out.
    fn name_shared_terms(&mut self) {
        let given = self.names.iter().flatten().map(|given| given.name);
        let defined = self.written.trace.definitions.iter().map(|definition| definition.name);
        let mut taken: FxHashSet<String> = given.chain(defined).map(|name| name.to_string()).collect();
        // the first link of each quantity between two links: it is not always the link before
        let between = self.written.trace.definitions.iter().map(|definition| definition.name);
        let between = between.filter(|name| name.quantity.indices() == Indices::Links);
        let between: FxHashMap<(Quantity, usize), [usize; 2]> =
            between.map(|name| ((name.quantity, name.joint), name.indices)).collect();
        let mut parts: BTreeMap<Name, usize> = BTreeMap::new();
        for (id, node) in self.written.graph.nodes() {
            let index = id.index();
            let is_constant = matches!(node, Op::Constant(_));
            let is_leaf = is_constant || matches!(node, Op::Sine(_) | Op::Cosine(_));
            let needs_name = self.uses[index] > 0 && (is_leaf || self.uses[index] > 1);
            if self.names[index].is_some() || !needs_name {
                continue;
            }
            let base =
                self.written.trace.births[index].as_ref().map_or(Name::scalar(Quantity::Constant, 0), |birth| Name {
                    component: birth.component,
                    by: birth.place.by,
                    indices: between.get(&(birth.place.quantity, birth.place.joint)).copied().unwrap_or_default(),
                    ..Name::scalar(birth.place.quantity, birth.place.joint)
                });
            let base = self.summand_of_another_unit(id, base).unwrap_or(base);
            // parts are counted per text: the names of some quantities do not contain the joint
            let part =
                parts.entry(Name { joint: if base.tells_joint() { base.joint } else { 0 }, ..base }).or_default();
            let name = loop {
                *part += 1;
                let name = Name { part: *part, ..base };
                if taken.insert(name.to_string()) {
                    break name;
                }
            };
            // the name means the node or its negative, whichever needs no minus; operands have names already, because
            // they are older
            let negative = !is_constant && self.is_negative(id);
            self.names[index] = Some(Given { name, negative });
        }
    }

    /// Returns the name of a summand whose unit is not that of `name`. A force may contain a moment divided by a
    /// length; this part is named as a moment. Units are those of a revolute joint. A quantity without a unit gives no
    /// name. In the seven steps, a term is a part of one equation of the lecture, and keeps its name.
    fn summand_of_another_unit(&self, id: Ref, name: Name) -> Option<Name> {
        let (Form::Reduced, Op::Sum(a, b)) = (self.form, self.written.graph.op(id)) else { return None };
        // rad counts as 1: U, in 1/s², contains ω̇, in rad/s²
        let unit = |name: Name| name.quantity.unit(JointKind::Revolute).replace("rad", "1");
        [a, b].map(Ref::magnitude).into_iter().find_map(|summand| match self.names[summand.index()] {
            None => self.summand_of_another_unit(summand, name),
            Some(given) if unit(name).is_empty() || unit(given.name).is_empty() => None,
            Some(given) => (unit(name) != unit(given.name)).then_some(Name { part: 0, ..given.name }),
        })
    }

    /// Whether the expression of a node is written with a minus sign in front: signs move outwards in expressions.
    fn is_negative(&self, id: Ref) -> bool {
        let operand = |at: Ref| {
            let is_negative = match self.name_where_used(id, at.magnitude()) {
                _ if self.is_zero(at.magnitude()) => false,
                Some(given) => given.negative,
                None => self.is_negative(at.magnitude()),
            };
            is_negative != at.is_negative()
        };
        match self.written.graph.op(id) {
            Op::Sum(a, b) => operand(a) && operand(b),
            Op::Product(a, b) | Op::Quotient(a, b) => operand(a) != operand(b),
            _ => false,
        }
    }

    /// The name of a node where `user` uses it.
    fn name_where_used(&self, user: Ref, id: Ref) -> Option<Given> {
        match self.written.graph.op(id) {
            Op::Constant(_) => self.constant_name(user, id),
            _ => self.names[id.index()],
        }
    }

    fn is_angle(&self, id: Ref) -> bool {
        self.names[id.index()].is_some_and(|given| given.name.quantity.is_of_an_angle())
    }

    fn is_zero(&self, at: Ref) -> bool {
        matches!(self.written.graph.op(at), Op::Constant(_)) && self.magnitude(at) == 0.0
    }

    /// The value of a constant without its sign.
    fn magnitude(&self, at: Ref) -> f64 {
        self.written.graph.number(at.magnitude()).map_or(0.0, Number::to_f64)
    }

    /// The exact value of a constant under its name.
    fn exactly(&self, constant: &Constant, at: Ref) -> (Number, Option<ExactAngle>) {
        let at = at.magnitude().signed(constant.value < 0.0);
        let turn = match constant.name.quantity {
            Quantity::Theta | Quantity::GroupTheta => self.written.graph.turn(at),
            // another constant may have been made as an angle, too
            _ => self.written.graph.known_turn(at),
        };
        (self.written.graph.number(at).unwrap_or_default(), turn)
    }

    fn is_live(&self, id: Ref) -> bool {
        self.uses[id.index()] > 0
    }

    fn live_nodes(&self) -> impl Iterator<Item = (Ref, Op)> {
        self.written.graph.nodes().filter(|&(id, _)| self.is_live(id))
    }

    /// The nodes from which the angles of sines and cosines are computed.
    fn within_angles(&self) -> FxHashSet<Ref> {
        let angle = |(_, op)| if let Op::Sine(angle) | Op::Cosine(angle) = op { Some(angle.magnitude()) } else { None };
        let mut waiting: Vec<Ref> = self.live_nodes().filter_map(angle).collect();
        let mut found = FxHashSet::default();
        while let Some(node) = waiting.pop() {
            if found.insert(node) {
                waiting.extend(self.written.graph.op(node).operands().map(Ref::magnitude));
            }
        }
        found
    }

    fn arguments(&self) -> BTreeSet<Name> {
        let input = |(_, op)| if let Op::Input(input) = op { Some(input.name()) } else { None };
        self.live_nodes().filter_map(input).collect()
    }

    fn constants(&self) -> Result<Vec<(Constant, Ref)>, CompileError> {
        let mut constants = Vec::new();
        let users = self.users_of_constants();
        for (id, node) in self.written.graph.nodes() {
            let Op::Constant(_) = node else { continue };
            let magnitude = self.magnitude(id);
            for given in self.constant_names(id, users.get(&id).map_or(&[], Vec::as_slice)) {
                let value = if given.negative { -magnitude } else { magnitude };
                if !value.is_finite() {
                    return Err(CompileError::NotFinite { name: given.name });
                }
                constants.push((Constant { name: given.name, value }, id));
            }
        }
        // sorted by link, like the statements
        constants.sort_by_key(|(constant, _)| (constant.name.joint, constant.name));
        Ok(constants)
    }

    /// The live nodes that use each constant, in order.
    fn users_of_constants(&self) -> FxHashMap<Ref, Vec<Ref>> {
        let mut users: FxHashMap<Ref, Vec<Ref>> = FxHashMap::default();
        for (user, node) in self.live_nodes() {
            for operand in node.operands().map(Ref::magnitude) {
                if matches!(self.written.graph.op(operand), Op::Constant(_)) {
                    users.entry(operand).or_default().push(user);
                }
            }
        }
        users
    }

    /// The names under which `users`, live statements, use a constant.
    fn constant_names(&self, id: Ref, users: &[Ref]) -> Vec<Given> {
        if !self.is_live(id) || self.is_zero(id) {
            return Vec::new();
        }
        let returned = self.names[id.index()].filter(|_| self.is_output[id.index()]);
        let mut seen = FxHashSet::default();
        let used = users.iter().filter_map(|&user| self.constant_name(user, id));
        used.chain(returned).filter(|given| seen.insert(given.name)).collect()
    }

    /// The name of a constant where `user` uses it.
    fn constant_name(&self, user: Ref, id: Ref) -> Option<Given> {
        let role = self.written.trace.roles.get(&(user, id)).copied();
        let given = role.and_then(|name| Some(Given { name, negative: *self.signs.get(&name)? }));
        given.or(self.names[id.index()])
    }

    fn place(&self, id: Ref, name: Name) -> Place {
        let own = || place_of(name, Step::AngularVelocity);
        self.written.trace.births[id.index()].as_ref().map_or_else(own, |birth| birth.place)
    }

    /// Returns the values with statements of their own, in no order, and the results. A result has a statement if it is
    /// a torque, or if its value has no other name.
    fn definitions(&self, outputs: &[(Name, Ref)]) -> (Vec<Definition>, Vec<(Name, Returned)>) {
        let mut found = Vec::new();
        for (id, node) in self.live_nodes() {
            if let (true, Some(Given { name, negative })) = (node.is_operation(), self.names[id.index()]) {
                let (position, place) = ((id.index(), 0), self.place(id, name));
                found.push(Definition { position, place, name, at: id.signed(negative), is_node: true });
            }
        }
        let mut returned = Vec::with_capacity(outputs.len());
        let definitions = self.written.trace.definitions.iter().enumerate();
        let first: FxHashMap<Name, usize> =
            definitions.rev().map(|(order, definition)| (definition.name, order)).collect();
        let mut stated = BTreeSet::new();
        for &(name, at) in outputs {
            let is_named = self.names[at.index()].is_some();
            let is_stated = !self.is_zero(at.magnitude()) && (!is_named || name.quantity == Quantity::Torque);
            let Some(&order) = first.get(&name).filter(|_| is_stated) else {
                returned.push((name, Returned::Value(at)));
                continue;
            };
            returned.push((name, Returned::Statement));
            if stated.insert(name) {
                // after the last node that existed when it was named, and after torques that were named before it
                let position = (self.written.trace.definitions[order].after.saturating_sub(1), order);
                found.push(Definition { position, place: place_of(name, Step::Torque), name, at, is_node: false });
            }
        }
        (found, returned)
    }

    /// Returns how each name appears in the code; `stated` are the names of statements.
    fn resolutions(&self, stated: &BTreeSet<Name>) -> Vec<Resolution> {
        let mut seen = BTreeSet::new();
        let definitions = self.written.trace.definitions.iter().filter(|definition| seen.insert(definition.name));
        definitions
            .map(|definition| {
                let (node, negative) = (definition.at.magnitude(), definition.at.is_negative());
                let value = match self.written.graph.op(node) {
                    Op::Constant(_) => {
                        let magnitude = self.magnitude(node);
                        ResolvedAs::Constant(if negative { -magnitude } else { magnitude }, definition.causes.clone())
                    }
                    _ if !self.is_live(node) => ResolvedAs::Unused,
                    _ => match self.names[node.index()] {
                        Some(given) if given.name == definition.name => ResolvedAs::Computed,
                        Some(given) => ResolvedAs::Same(given.name, sign(given.negative != negative)),
                        // a torque has a statement although its node does not have its name
                        None if stated.contains(&definition.name) => ResolvedAs::Computed,
                        None => ResolvedAs::Inside,
                    },
                };
                Resolution { name: definition.name, value }
            })
            .collect()
    }
}

/// A statement that is to be written.
struct Definition {
    position: Position,
    place: Place,
    name: Name,
    /// The value that has the name.
    at: Ref,
    /// Whether the statement computes the node `at`; otherwise it gives a result its name.
    is_node: bool,
}

/// How a result is returned: as the value of the statement with its name, or as a value without a statement.
enum Returned {
    Statement,
    Value(Ref),
}

/// The place of a named value; `otherwise` is the step if no step computes its quantity.
fn place_of(name: Name, otherwise: Step) -> Place {
    let step = name.quantity.step().unwrap_or(otherwise);
    Place { joint: name.joint, step, quantity: name.quantity, by: name.by }
}

fn sign(negative: bool) -> Sign {
    if negative { Sign::Minus } else { Sign::Plus }
}
