//! From the graph to named statements: what is live, what gets a name of its own, and with which sign it is written.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use rne_model::Robot;

use crate::CompileError;
use crate::function::{Form, Function};
use crate::ir::ledger::{Operation, Place};
use crate::ir::name::Name;
use crate::ir::quantity::{Quantity, Step};
use crate::ir::{Number, Op, Ref, Traced, Turn as Angle};
use crate::program::{Constant, Exactly, Expression, Finding, Found, Operator, Output, Program, Sign, Statement, Turn};
use crate::reduced::algorithm::Way;

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
    let schedule = Schedule::new(&written, uses);
    let constants = schedule.constants()?;
    let exactly = constants.iter().map(|(constant, at)| (constant.name, schedule.exactly(constant, *at))).collect();
    let mut statements = schedule.statements();
    let outputs = schedule.outputs(&outputs, &mut statements);
    statements.sort_by_key(|&(position, _)| position);
    let statements = statements.into_iter().map(|(_, statement)| statement);
    let (angles, statements) = statements.partition(|statement| statement.name.quantity.is_of_an_angle());
    let program = Program {
        robot: heading.robot.name.clone(),
        dof: heading.robot.dof(),
        parameters: heading.robot.run_time.names.len(),
        function: heading.function,
        form: heading.form,
        arguments: schedule.arguments(),
        constants: constants.into_iter().map(|(constant, _)| constant).collect(),
        angles,
        turns: schedule.turns(),
        statements,
        outputs,
        findings: schedule.findings(),
        ledger: written.trace.ledger,
        algorithm: Way::default(),
        choices: Vec::new(),
        proof: None,
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
            written.trace.ledger.drop_unused(birth.place, operation);
        }
    }
}

/// The name under which a node stands in the code, and whether that name means the node's negative.
#[derive(Clone, Copy)]
struct Given {
    name: Name,
    negative: bool,
}

struct Schedule<'w> {
    written: &'w Traced,
    uses: Vec<usize>,
    is_output: Vec<bool>,
    names: Vec<Option<Given>>,
    /// Whether a name means the negative of its node.
    signs: HashMap<Name, bool>,
}

impl<'w> Schedule<'w> {
    fn new(written: &'w Traced, uses: Vec<usize>) -> Self {
        let mut is_output = vec![false; uses.len()];
        for at in &written.graph.outputs {
            is_output[at.index()] = true;
        }
        let definitions = written.trace.definitions.iter();
        let signs = definitions.map(|definition| (definition.name, definition.at.is_negative())).collect();
        let mut schedule = Self { written, names: vec![None; uses.len()], uses, is_output, signs };
        schedule.take_given_names();
        schedule.name_shared_terms();
        schedule
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
                Op::Sum(..) | Op::Product(..) | Op::Quotient(..) | Op::BySign(_) => {
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
    fn exactly(&self, constant: &Constant, at: Ref) -> (Number, Option<Angle>) {
        let at = at.magnitude().signed(constant.value < 0.0);
        let is_angle = matches!(constant.name.quantity, Quantity::Theta | Quantity::GroupTheta);
        let turn = if is_angle { self.written.graph.turn(at) } else { None };
        (self.written.graph.number(at).unwrap_or_default(), turn)
    }

    fn is_live(&self, id: Ref) -> bool {
        self.uses[id.index()] > 0
    }

    fn arguments(&self) -> Vec<Name> {
        let live = self.written.graph.nodes().filter(|&(id, _)| self.is_live(id));
        let names: BTreeSet<Name> =
            live.filter_map(|(_, op)| if let Op::Input(input) = op { Some(input.name()) } else { None }).collect();
        names.into_iter().collect()
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
        for (user, node) in self.written.graph.nodes().filter(|&(user, _)| self.is_live(user)) {
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
        let mut names: Vec<Given> = Vec::new();
        let mut put = |given: Option<Given>| {
            if let Some(given) = given
                && !names.iter().any(|known| known.name == given.name)
            {
                names.push(given);
            }
        };
        if self.uses[id.index()] == 0 || self.is_zero(id) {
            return names;
        }
        for &user in users {
            put(self.constant_name(user, id));
        }
        if self.is_output[id.index()] {
            put(self.names[id.index()]);
        }
        names
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
        for (id, node) in self.written.graph.nodes().filter(|&(id, _)| self.is_live(id)) {
            if let (Op::Sum(..) | Op::Product(..) | Op::Quotient(..) | Op::BySign(_), Some(given)) =
                (node, self.names[id.index()])
            {
                let (negative, value) = self.operation(id);
                let value = signed(negative != given.negative, value);
                let place = self.place(id, given.name);
                statements.push(((id.index(), 0), Statement { place, name: given.name, value }));
            }
        }
        statements
    }

    /// The sines and cosines, in the order in which they were asked for.
    fn turns(&self) -> Vec<Turn> {
        let mut turns: Vec<(Ref, Turn)> = Vec::new();
        for (id, node) in self.written.graph.nodes().filter(|&(id, _)| self.is_live(id)) {
            let (Op::Sine(angle) | Op::Cosine(angle)) = node else { continue };
            let name = self.names[id.index()].map(|given| given.name);
            let known = turns.iter().position(|(other, _)| *other == angle);
            let index = known.unwrap_or_else(|| {
                let joint = name.map_or(0, |name| name.joint);
                let place = Place { joint, step: Step::AngularVelocity, quantity: Quantity::Sine, by: None };
                turns.push((angle, Turn { place, sine: None, cosine: None, angle: self.expression(angle) }));
                turns.len() - 1
            });
            let turn = &mut turns[index].1;
            *(if matches!(node, Op::Sine(_)) { &mut turn.sine } else { &mut turn.cosine }) = name;
        }
        turns.into_iter().map(|(_, turn)| turn).collect()
    }

    fn place(&self, id: Ref, name: Name) -> Place {
        let step = name.quantity.step().unwrap_or(Step::AngularVelocity);
        let own = Place { joint: name.joint, step, quantity: name.quantity, by: name.by };
        self.written.trace.births[id.index()].as_ref().map_or(own, |birth| birth.place)
    }

    /// Outputs as variables; a torque, and whatever is computed for it alone, gets a statement of its own name.
    fn outputs(&self, outputs: &[(Name, Ref)], statements: &mut Vec<(Position, Statement)>) -> Vec<Output> {
        let mut returned = Vec::with_capacity(outputs.len());
        let mut first: HashMap<Name, usize> = HashMap::new();
        for (order, definition) in self.written.trace.definitions.iter().enumerate() {
            first.entry(definition.name).or_insert(order);
        }
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
            let step = name.quantity.step().unwrap_or(Step::Torque);
            let place = Place { joint: name.joint, step, quantity: name.quantity, by: name.by };
            // after the last node that was there when it was named, and after torques named before it
            statements.push(((definition.after.saturating_sub(1), order), Statement { place, name, value }));
            returned.push(Output { name, value: Expression::Variable(name) });
        }
        returned
    }

    fn findings(&self) -> Vec<Finding> {
        let mut seen = BTreeSet::new();
        let definitions = self.written.trace.definitions.iter().filter(|definition| seen.insert(definition.name));
        definitions
            .map(|definition| {
                let (node, negative) = (definition.at.magnitude(), definition.at.is_negative());
                let value = match self.written.graph.op(node) {
                    Op::Constant(_) => {
                        let magnitude = self.magnitude(node);
                        Found::Constant(if negative { -magnitude } else { magnitude }, definition.causes.clone())
                    }
                    _ if !self.is_live(node) => Found::Unused,
                    _ => match self.names[node.index()] {
                        Some(given) if given.name == definition.name => Found::Computed,
                        Some(given) => Found::Same(given.name, sign(given.negative != negative)),
                        None => Found::Inside,
                    },
                };
                Finding { name: definition.name, value }
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
        match self.written.graph.op(id) {
            Op::Sum(a, b) => {
                let (a_sign, a_value) = self.operand(Some(id), a.magnitude());
                let (b_sign, b_value) = self.operand(Some(id), b.magnitude());
                let sum = |a, b| Expression::binary(Operator::Sum, a, b);
                let difference = |a, b| Expression::binary(Operator::Difference, a, b);
                match (a_sign != a.is_negative(), b_sign != b.is_negative()) {
                    (false, false) => (false, sum(a_value, b_value)),
                    (false, true) => (false, difference(a_value, b_value)),
                    (true, false) => (false, difference(b_value, a_value)),
                    (true, true) => (true, sum(a_value, b_value)),
                }
            }
            op @ (Op::Product(a, b) | Op::Quotient(a, b)) => {
                let operator = if matches!(op, Op::Product(..)) { Operator::Product } else { Operator::Quotient };
                let (a_sign, a_value) = self.operand(Some(id), a);
                let (b_sign, b_value) = self.operand(Some(id), b);
                (a_sign != b_sign, Expression::binary(operator, a_value, b_value))
            }
            Op::BySign([x, a, b]) => {
                let operands = [x, a, b].map(|term| {
                    let (sign, value) = self.operand(Some(id), term.magnitude());
                    signed(sign != term.is_negative(), value)
                });
                (false, Expression::BySign(Box::new(operands)))
            }
            // leaves always have a name, but for the zero that no operation keeps
            Op::Constant(_) | Op::Input(_) | Op::Sine(_) | Op::Cosine(_) => (false, Expression::Zero),
        }
    }
}

fn sign(negative: bool) -> Sign {
    if negative { Sign::Minus } else { Sign::Plus }
}

/// An expression with a sign, which is carried inwards where it costs nothing: -(a - b) is b - a.
fn signed(negative: bool, expression: Expression) -> Expression {
    if !negative {
        return expression;
    }
    match negated(&expression) {
        Some(negated) => negated,
        None => Expression::Negative(Box::new(expression)),
    }
}

/// The negative of an expression without a minus sign in front, if there is one. Rounding is symmetric, so it is exact.
fn negated(expression: &Expression) -> Option<Expression> {
    match expression {
        Expression::Zero => Some(Expression::Zero),
        Expression::Negative(a) => Some((**a).clone()),
        Expression::Binary(Operator::Difference, a, b) => {
            Some(Expression::Binary(Operator::Difference, b.clone(), a.clone()))
        }
        Expression::Binary(Operator::Sum, a, b) => {
            let (first, second) = match (negated(a), negated(b)) {
                (Some(a), _) => (a, b),
                (None, Some(b)) => (b, a),
                (None, None) => return None,
            };
            Some(Expression::Binary(Operator::Difference, Box::new(first), second.clone()))
        }
        Expression::Binary(operator, a, b) => match (negated(a), negated(b)) {
            (Some(a), _) => Some(Expression::Binary(*operator, Box::new(a), b.clone())),
            (None, Some(b)) if *operator == Operator::Product => {
                Some(Expression::Binary(*operator, a.clone(), Box::new(b)))
            }
            _ => None,
        },
        Expression::BySign(operands) => {
            let [x, positive, negative] = &**operands;
            Some(Expression::BySign(Box::new([x.clone(), negated(positive)?, negated(negative)?])))
        }
        Expression::Variable(_) => None,
    }
}
