//! From the graph to named statements: what is live, what gets a name of its own, and with which sign it is written.

mod equations;

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use rne_model::Robot;

use crate::CompileError;
use crate::function::{Form, Function};
use crate::ir::fold_report::{Operation, Place};
use crate::ir::name::Name;
use crate::ir::quantity::{Quantity, Step};
use crate::ir::{ExactAngle, Number, Op, Ref, Traced};
use crate::program::{
    Constant, Exactly, Expression, Operator, Output, Program, Resolution, ResolvedAs, Sign, SineCosine, Statement,
};
use crate::reduced::algorithm::Algorithm;

/// Where a statement stands: the index of its node, and an order among those that stand behind one node.
type Position = (usize, usize);

/// What the program is of.
pub(crate) struct Heading<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) function: Function,
    pub(crate) form: Form,
}

/// Turns a written graph into a program that returns its outputs under these names, and tells what its constants are.
pub(crate) fn lower(
    heading: &Heading<'_>,
    mut written: Traced,
    names: &[Name],
) -> Result<(Program, Exactly), CompileError> {
    leave_names_to_arguments(&mut written);
    let outputs: Vec<(Name, Ref)> = names.iter().copied().zip(written.graph.outputs.iter().copied()).collect();
    let uses = count_uses(&written);
    drop_unused(&mut written, &uses);
    let lowering = Lowering::new(&written, uses);
    let constants = lowering.constants()?;
    let exactly = constants.iter().map(|(constant, at)| (constant.name, lowering.exactly(constant, *at))).collect();
    let mut statements = lowering.statements();
    let outputs = lowering.outputs(&outputs, &mut statements);
    statements.sort_by_key(|&(position, _)| position);
    let statements = statements.into_iter().map(|(_, statement)| statement);
    let (angles, statements) = statements.partition(|statement| statement.name.quantity.is_of_an_angle());
    let program = Program {
        robot: heading.robot.name.clone(),
        dof: heading.robot.dof(),
        parameters: heading.robot.run_time.names.len(),
        function: heading.function,
        form: heading.form,
        arguments: lowering.arguments(),
        constants: constants.into_iter().map(|(constant, _)| constant).collect(),
        angles,
        sines_and_cosines: lowering.sines_and_cosines(),
        statements,
        outputs,
        resolutions: lowering.resolutions(),
        equations: lowering.equations(),
        fold_report: written.trace.fold_report,
        algorithm: Algorithm::default(),
        is_rewritten: false,
        choices: Vec::new(),
        proof: None,
        refusals: Vec::new(),
    };
    program.check_names()?;
    Ok((program, exactly))
}

/// The name of an argument is that of nothing else: gravity that is given is another number than gravity of the table.
fn leave_names_to_arguments(written: &mut Traced) {
    let argument = |(at, op)| if let Op::Input(input) = op { Some((input.name(), at)) } else { None };
    let arguments: HashMap<Name, Ref> = written.graph.nodes().filter_map(argument).collect();
    let is_free = |name: &Name, at: Ref| arguments.get(name).is_none_or(|argument| *argument == at.magnitude());
    written.trace.definitions.retain(|definition| is_free(&definition.name, definition.at));
}

/// How often each node is used by live nodes and outputs; 0 is dead.
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

/// The name under which a node stands in the code, and whether that name means the node's negative.
#[derive(Clone, Copy)]
struct Given {
    name: Name,
    negative: bool,
}

struct Lowering<'w> {
    written: &'w Traced,
    uses: Vec<usize>,
    is_output: Vec<bool>,
    names: Vec<Option<Given>>,
    /// Whether a name means the negative of its node.
    signs: HashMap<Name, bool>,
}

impl<'w> Lowering<'w> {
    fn new(written: &'w Traced, uses: Vec<usize>) -> Self {
        let mut is_output = vec![false; uses.len()];
        for at in &written.graph.outputs {
            is_output[at.index()] = true;
        }
        let definitions = written.trace.definitions.iter();
        let signs = definitions.map(|definition| (definition.name, definition.at.is_negative())).collect();
        let mut lowering = Self { written, names: vec![None; uses.len()], uses, is_output, signs };
        lowering.take_given_names();
        lowering.name_shared_terms();
        lowering
    }

    /// A node takes the first name it was given; a letter of the lecture wins over an auxiliary name of the same step.
    fn take_given_names(&mut self) {
        for definition in &self.written.trace.definitions {
            let (node, negative) = (definition.at.magnitude(), definition.at.is_negative());
            let quantity = definition.name.quantity;
            let slot = &mut self.names[node.index()];
            let lectures = |name: Name| name.quantity.is_of_the_lecture();
            let is_turn = matches!(self.written.graph.op(node), Op::Sine(_) | Op::Cosine(_));
            let wins = slot.is_none_or(|old| {
                // sines and cosines are called what they are
                !is_turn
                    && !lectures(old.name)
                    && lectures(definition.name)
                    && old.name.quantity.step() == quantity.step()
            });
            // a torque is an alias of a component of a force or moment, a derivative may be a sine
            let is_alias = quantity == Quantity::Torque || (is_turn && definition.name.by.is_some());
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
                    // an auxiliary quantity that is used once is clearer where it is used
                    if !keeps && self.uses[index] < 2 && !self.is_angle(id) {
                        self.names[index] = None;
                    }
                }
                _ => {}
            }
        }
    }

    /// A term without a name that is used more than once, and a constant without a name, are called after the quantity
    /// in which they first stood. Other names may look alike, and what a language tells apart is their text: a number
    /// that gives a text of them is left out.
    fn name_shared_terms(&mut self) {
        let given = self.names.iter().flatten().map(|given| given.name);
        let defined = self.written.trace.definitions.iter().map(|definition| definition.name);
        let mut taken: HashSet<String> = given.chain(defined).map(|name| name.to_string()).collect();
        let mut parts: BTreeMap<Name, usize> = BTreeMap::new();
        for (id, node) in self.written.graph.nodes() {
            let index = id.index();
            let is_constant = matches!(node, Op::Constant(_));
            let needs_name = self.uses[index] > 0 && (is_constant || self.uses[index] > 1);
            if self.names[index].is_some() || !needs_name {
                continue;
            }
            let base =
                self.written.trace.births[index].as_ref().map_or(Name::scalar(Quantity::Constant, 0), |birth| Name {
                    component: birth.component,
                    by: birth.place.by,
                    ..Name::scalar(birth.place.quantity, birth.place.joint)
                });
            // counted among those that look alike: of some quantities a name does not tell the joint
            let part =
                parts.entry(Name { joint: if base.tells_joint() { base.joint } else { 0 }, ..base }).or_default();
            let name = loop {
                *part += 1;
                let name = Name { part: *part, ..base };
                if taken.insert(name.to_string()) {
                    break name;
                }
            };
            // with the sign that needs no minus; operands have their names, for they are older
            let negative = !is_constant && self.operation(id).0;
            self.names[index] = Some(Given { name, negative });
        }
    }

    fn is_angle(&self, id: Ref) -> bool {
        self.names[id.index()].is_some_and(|given| given.name.quantity.is_of_an_angle())
    }

    fn is_zero(&self, at: Ref) -> bool {
        matches!(self.written.graph.op(at), Op::Constant(_)) && self.magnitude(at) == 0.0
    }

    /// The magnitude of a constant.
    fn magnitude(&self, at: Ref) -> f64 {
        self.written.graph.number(at.magnitude()).map_or(0.0, Number::to_f64)
    }

    /// What a constant under its name is.
    fn exactly(&self, constant: &Constant, at: Ref) -> (Number, Option<ExactAngle>) {
        let at = at.magnitude().signed(constant.value < 0.0);
        let is_angle = matches!(constant.name.quantity, Quantity::Theta | Quantity::GroupTheta);
        let turn = if is_angle { self.written.graph.turn(at) } else { None };
        (self.written.graph.number(at).unwrap_or_default(), turn)
    }

    fn is_live(&self, id: Ref) -> bool {
        self.uses[id.index()] > 0
    }

    fn live_nodes(&self) -> impl Iterator<Item = (Ref, Op)> {
        self.written.graph.nodes().filter(|&(id, _)| self.is_live(id))
    }

    fn arguments(&self) -> Vec<Name> {
        let input = |(_, op)| if let Op::Input(input) = op { Some(input.name()) } else { None };
        self.live_nodes().filter_map(input).collect::<BTreeSet<_>>().into_iter().collect()
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
        // by link, as the statements are
        constants.sort_by_key(|(constant, _)| (constant.name.joint, constant.name));
        Ok(constants)
    }

    /// The live nodes that use each constant, in order.
    fn users_of_constants(&self) -> HashMap<Ref, Vec<Ref>> {
        let mut users: HashMap<Ref, Vec<Ref>> = HashMap::new();
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
        let mut seen = HashSet::new();
        let used = users.iter().filter_map(|&user| self.constant_name(user, id));
        used.chain(returned).filter(|given| seen.insert(given.name)).collect()
    }

    /// The name of a constant where `user` uses it.
    fn constant_name(&self, user: Ref, id: Ref) -> Option<Given> {
        let role = self.written.trace.roles.get(&(user, id)).copied();
        let given = role.and_then(|name| Some(Given { name, negative: *self.signs.get(&name)? }));
        given.or(self.names[id.index()])
    }

    /// Statements with their position.
    fn statements(&self) -> Vec<(Position, Statement)> {
        let mut statements = Vec::new();
        for (id, node) in self.live_nodes() {
            if let (true, Some(given)) = (node.is_operation(), self.names[id.index()]) {
                let (negative, value) = self.operation(id);
                let value = signed(negative != given.negative, value);
                let place = self.place(id, given.name);
                statements.push(((id.index(), 0), Statement { place, name: given.name, value }));
            }
        }
        statements
    }

    /// The sines and cosines, in the order in which they were asked for.
    fn sines_and_cosines(&self) -> Vec<SineCosine> {
        let mut turns: Vec<(Ref, SineCosine)> = Vec::new();
        for (id, node) in self.live_nodes() {
            let (Op::Sine(angle) | Op::Cosine(angle)) = node else { continue };
            let name = self.names[id.index()].map(|given| given.name);
            let known = turns.iter().position(|(other, _)| *other == angle);
            let index = known.unwrap_or_else(|| {
                let joint = name.map_or(0, |name| name.joint);
                let place = Place { joint, step: Step::AngularVelocity, quantity: Quantity::Sine, by: None };
                turns.push((angle, SineCosine { place, sine: None, cosine: None, angle: self.expression(angle) }));
                turns.len() - 1
            });
            let turn = &mut turns[index].1;
            *(if matches!(node, Op::Sine(_)) { &mut turn.sine } else { &mut turn.cosine }) = name;
        }
        turns.into_iter().map(|(_, turn)| turn).collect()
    }

    fn place(&self, id: Ref, name: Name) -> Place {
        let own = || place_of(name, Step::AngularVelocity);
        self.written.trace.births[id.index()].as_ref().map_or_else(own, |birth| birth.place)
    }

    /// Outputs as variables; a torque, and whatever is computed for it alone, gets a statement of its own name.
    fn outputs(&self, outputs: &[(Name, Ref)], statements: &mut Vec<(Position, Statement)>) -> Vec<Output> {
        let mut returned = Vec::with_capacity(outputs.len());
        let definitions = self.written.trace.definitions.iter().enumerate();
        let first: HashMap<Name, usize> =
            definitions.rev().map(|(order, definition)| (definition.name, order)).collect();
        let mut stated = BTreeSet::new();
        for &(name, term) in outputs {
            let value = self.expression(term);
            let is_stated = match &value {
                Expression::Zero => false,
                Expression::Variable(_) => name.quantity == Quantity::Torque,
                Expression::Negative(a) if matches!(**a, Expression::Variable(_)) => name.quantity == Quantity::Torque,
                _ => true,
            };
            let Some(&order) = first.get(&name).filter(|_| is_stated) else {
                returned.push(Output { name, value });
                continue;
            };
            if !stated.insert(name) {
                returned.push(Output { name, value: Expression::Variable(name) });
                continue;
            }
            let definition = &self.written.trace.definitions[order];
            let place = place_of(name, Step::Torque);
            // after the last node that was there when it was named, and after torques named before it
            statements.push(((definition.after.saturating_sub(1), order), Statement { place, name, value }));
            returned.push(Output { name, value: Expression::Variable(name) });
        }
        returned
    }

    fn resolutions(&self) -> Vec<Resolution> {
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
                        None => ResolvedAs::Inside,
                    },
                };
                Resolution { name: definition.name, value }
            })
            .collect()
    }

    /// A term as an expression: the name of its node, or what the node computes.
    fn expression(&self, term: Ref) -> Expression {
        let (negative, expression) = self.operand(None, term.magnitude());
        signed(negative != term.is_negative(), expression)
    }

    /// A node, as `user` uses it, as a sign and an expression. Signs are carried outwards, to where they cost nothing.
    fn operand(&self, user: Option<Ref>, id: Ref) -> (bool, Expression) {
        if self.is_zero(id) {
            return (false, Expression::Zero);
        }
        let given = match (self.written.graph.op(id), user) {
            (Op::Constant(_), Some(user)) => self.constant_name(user, id),
            _ => self.names[id.index()],
        };
        match given {
            Some(given) => (given.negative, Expression::Variable(given.name)),
            None => self.operation(id),
        }
    }

    fn operation(&self, id: Ref) -> (bool, Expression) {
        let operand = |at: Ref| {
            let (negative, value) = self.operand(Some(id), at.magnitude());
            (negative != at.is_negative(), Box::new(value))
        };
        match self.written.graph.op(id) {
            Op::Sum(a, b) => match (operand(a), operand(b)) {
                ((false, a), (false, b)) => (false, Expression::Binary(Operator::Sum, a, b)),
                ((false, a), (true, b)) | ((true, b), (false, a)) => {
                    (false, Expression::Binary(Operator::Difference, a, b))
                }
                ((true, a), (true, b)) => (true, Expression::Binary(Operator::Sum, a, b)),
            },
            op @ (Op::Product(a, b) | Op::Quotient(a, b)) => {
                let operator = if matches!(op, Op::Product(..)) { Operator::Product } else { Operator::Quotient };
                let ((a_negative, a), (b_negative, b)) = (operand(a), operand(b));
                (a_negative != b_negative, Expression::Binary(operator, a, b))
            }
            Op::BySign(operands) => {
                let operands = operands.map(operand).map(|(negative, value)| signed(negative, *value));
                (false, Expression::BySign(Box::new(operands)))
            }
            // leaves always have a name, but for the zero that no operation keeps
            Op::Constant(_) | Op::Input(_) | Op::Sine(_) | Op::Cosine(_) => (false, Expression::Zero),
        }
    }
}

/// Where what bears a name belongs; `otherwise` is the step of what no step computes.
fn place_of(name: Name, otherwise: Step) -> Place {
    let step = name.quantity.step().unwrap_or(otherwise);
    Place { joint: name.joint, step, quantity: name.quantity, by: name.by }
}

fn sign(negative: bool) -> Sign {
    if negative { Sign::Minus } else { Sign::Plus }
}

/// An expression with a sign, which is carried inwards where it costs nothing: -(a - b) is b - a.
fn signed(negative: bool, expression: Expression) -> Expression {
    if !negative {
        return expression;
    }
    negated(&expression).unwrap_or_else(|| Expression::Negative(Box::new(expression)))
}

/// The negative of an expression without a minus sign in front, if there is one. Rounding is symmetric, so it is exact.
fn negated(expression: &Expression) -> Option<Expression> {
    let negative = |a: &Expression| negated(a).map(Box::new);
    match expression {
        Expression::Zero => Some(Expression::Zero),
        Expression::Negative(a) => Some((**a).clone()),
        Expression::Binary(Operator::Difference, a, b) => {
            Some(Expression::Binary(Operator::Difference, b.clone(), a.clone()))
        }
        Expression::Binary(Operator::Sum, a, b) => match negative(a) {
            Some(a) => Some(Expression::Binary(Operator::Difference, a, b.clone())),
            None => negative(b).map(|b| Expression::Binary(Operator::Difference, b, a.clone())),
        },
        Expression::Binary(operator, a, b) => match negative(a) {
            Some(a) => Some(Expression::Binary(*operator, a, b.clone())),
            None if *operator == Operator::Product => negative(b).map(|b| Expression::Binary(*operator, a.clone(), b)),
            None => None,
        },
        Expression::BySign(operands) => {
            let [x, a, b] = &**operands;
            Some(Expression::BySign(Box::new([x.clone(), *negative(a)?, *negative(b)?])))
        }
        Expression::Variable(_) => None,
    }
}
