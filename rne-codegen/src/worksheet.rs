//! The sheet on which a function is written: the graph, the names given to its nodes, and the ledger of what folded.

use std::cell::RefCell;
use std::collections::HashMap;

use rne_model::{Angle, Joint};

use crate::exact::{Number, Reading};
use crate::graph::{Graph, Node, NodeId, Outcome, Side, Term};
use crate::ledger::{Alternatives, Cause, Causes, Fate, Ledger, Operation, Place};
use crate::name::{By, Name};
use crate::quantity::{Axis, Component, Quantity};
use crate::symbol::{Matrix, Symbol, Vector};

/// A name given to a term, in the order in which the names were given.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub(crate) name: Name,
    pub(crate) term: Term,
    /// Why it is the constant that it is, if it is one.
    pub(crate) causes: Causes,
    /// How many nodes there were when it got the name.
    pub(crate) after: usize,
}

/// Where a node was created.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Birth {
    pub(crate) place: Place,
    pub(crate) component: Component,
}

/// Everything a worksheet holds once it is written.
#[derive(Default)]
pub(crate) struct Written {
    pub(crate) graph: Graph,
    pub(crate) ledger: Ledger,
    pub(crate) definitions: Vec<Definition>,
    /// By node index; `None` for what belongs to no step.
    pub(crate) births: Vec<Option<Birth>>,
    /// As what a constant entered a node: (node, constant) → its name there.
    pub(crate) roles: HashMap<(NodeId, NodeId), Name>,
}

/// What has been written so far: nodes, where each was created, and names.
pub(crate) struct Snapshot {
    pub(crate) nodes: Vec<Node>,
    pub(crate) births: Vec<Option<Birth>>,
    pub(crate) definitions: Vec<Definition>,
}

/// The index of [`Causes`] on their sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct CausesId(usize);

/// What numbers are zero or one because of, each kept once, and what they give together.
#[derive(Default)]
struct KnownCauses {
    list: Vec<Alternatives>,
    ids: HashMap<Alternatives, CausesId>,
    both: HashMap<(CausesId, CausesId), CausesId>,
    either: HashMap<(CausesId, CausesId), CausesId>,
}

impl KnownCauses {
    fn id(&mut self, alternatives: Alternatives) -> CausesId {
        let next = CausesId(self.list.len());
        if let Some(&known) = self.ids.get(&alternatives) {
            return known;
        }
        self.list.push(alternatives.clone());
        self.ids.insert(alternatives, next);
        next
    }

    fn one(&mut self, cause: Cause) -> CausesId {
        self.id(Alternatives::one(cause))
    }

    /// The best of the alternatives.
    fn get(&self, id: CausesId) -> &Causes {
        self.list[id.0].best()
    }

    /// Of a sum of two zeros.
    fn both(&mut self, a: CausesId, b: CausesId) -> CausesId {
        if a == b {
            return a;
        }
        if let Some(&known) = self.both.get(&(a, b)) {
            return known;
        }
        let id = self.id(self.list[a.0].and(&self.list[b.0]));
        self.both.insert((a, b), id);
        id
    }

    /// Of a product of two zeros.
    fn either(&mut self, a: CausesId, b: CausesId) -> CausesId {
        if a == b {
            return a;
        }
        if let Some(&known) = self.either.get(&(a, b)) {
            return known;
        }
        let id = self.id(self.list[a.0].or(&self.list[b.0]));
        self.either.insert((a, b), id);
        id
    }
}

/// A sheet being written. [`Symbol`]s refer to it, so that formulas are written with operators.
#[derive(Default)]
pub(crate) struct Worksheet {
    state: RefCell<State>,
}

#[derive(Default)]
struct State {
    written: Written,
    causes: KnownCauses,
    place: Option<Place>,
    axis: Option<Axis>,
    by: Option<By>,
}

impl Worksheet {
    /// A sheet whose constants are exact, for a proof.
    pub(crate) fn exact(reading: Reading) -> Self {
        let sheet = Self::default();
        sheet.state.borrow_mut().written.graph = Graph::exact(reading);
        sheet
    }

    /// A sheet on which equal values are computed once, however they come about.
    pub(crate) fn merged(reading: Reading) -> Self {
        let sheet = Self::default();
        sheet.state.borrow_mut().written.graph = Graph::merged(reading);
        sheet
    }

    /// Sine and cosine of a constant angle.
    pub(crate) fn constant_turn(&self, angle: &Angle, cause: Cause) -> (Symbol<'_>, Symbol<'_>) {
        let reading = self.state.borrow().written.graph.reading();
        match reading.map(|reading| reading.turn(angle)) {
            Some(turn) => (self.exact_number(turn.sin, cause), self.exact_number(turn.cos, cause)),
            None => (self.constant(angle.sin, cause), self.constant(angle.cos, cause)),
        }
    }

    /// The inertia of a link about its centre of mass.
    pub(crate) fn inertia(&self, joint: &Joint) -> Matrix<'_> {
        let reading = self.state.borrow().written.graph.reading();
        Matrix::from_rows(match reading {
            Some(reading) => reading.inertia(joint).map(|row| row.map(|x| self.exact_number(x, Cause::Arithmetic))),
            None => joint.row.link.inertia.rows().map(|row| row.map(|x| self.constant(x, Cause::Arithmetic))),
        })
    }

    fn exact_number(&self, number: Number, cause: Cause) -> Symbol<'_> {
        let state = &mut *self.state.borrow_mut();
        let term = state.written.graph.constant_number(number);
        Symbol { sheet: self, term, causes: state.causes.one(cause) }
    }

    /// A number that stands for itself; `cause` tells why it is what it is.
    pub(crate) fn constant(&self, value: f64, cause: Cause) -> Symbol<'_> {
        let state = &mut *self.state.borrow_mut();
        let term = state.written.graph.constant(value);
        Symbol { sheet: self, term, causes: state.causes.one(cause) }
    }

    /// A number of the table under its name.
    pub(crate) fn entry(&self, name: Name, value: f64) -> Symbol<'_> {
        self.name(name, self.constant(value, Cause::Table(name)))
    }

    /// An argument of the function.
    pub(crate) fn argument(&self, name: Name) -> Symbol<'_> {
        let state = &mut *self.state.borrow_mut();
        let term = state.written.graph.argument(name);
        Symbol { sheet: self, term, causes: state.causes.one(Cause::Arithmetic) }
    }

    /// The zero vector, with its cause.
    pub(crate) fn zeros(&self, cause: Cause) -> Vector<'_> {
        Vector([self.constant(0.0, cause); 3])
    }

    /// Gives a symbol a name. A constant of the table takes its name as cause, so that a fold can say what was zero.
    pub(crate) fn name<'s>(&'s self, name: Name, symbol: Symbol<'s>) -> Symbol<'s> {
        let state = &mut *self.state.borrow_mut();
        let is_entry = name.quantity.step().is_none() || name.quantity == Quantity::D;
        let name = if is_entry { name } else { Name { by: name.by.or(state.by), ..name } };
        let is_zero = state.written.graph.value(symbol.term) == Some(0.0);
        // the two halves of a symmetric tensor are zero because of one number of the table
        let told = if is_zero { name.of_upper_half() } else { name };
        let causes = if is_entry { state.causes.one(Cause::Table(told)) } else { symbol.causes };
        let after = state.written.graph.len();
        let told = state.causes.get(causes).clone();
        state.written.definitions.push(Definition { name, term: symbol.term, causes: told, after });
        Symbol { causes, ..symbol }
    }

    /// A vector of the table under its name.
    pub(crate) fn entry_vector<'s>(&'s self, quantity: Quantity, joint: usize, v: Vector<'s>) -> Vector<'s> {
        v.map(|axis, x| self.name(Name::vector(quantity, joint, axis), x))
    }

    /// A matrix of the table under its name.
    pub(crate) fn entry_matrix<'s>(&'s self, quantity: Quantity, joint: usize, m: Matrix<'s>) -> Matrix<'s> {
        m.map(|row, column, x| self.name(Name::matrix(quantity, joint, row, column), x))
    }

    /// The lines of one joint.
    pub(crate) fn joint(&self, joint: usize) -> JointLines<'_> {
        JointLines { sheet: self, joint, named: joint }
    }

    pub(crate) fn sine_and_cosine<'s>(&'s self, angle: Symbol<'s>) -> (Symbol<'s>, Symbol<'s>) {
        let state = &mut *self.state.borrow_mut();
        let sine = state.written.graph.sine(angle.term);
        let cosine = state.written.graph.cosine(angle.term);
        let causes = state.causes.one(Cause::Arithmetic);
        let symbol = |term| Symbol { sheet: self, term, causes };
        (symbol(sine), symbol(cosine))
    }

    pub(crate) fn sum<'s>(&'s self, a: Symbol<'s>, b: Symbol<'s>) -> Symbol<'s> {
        let state = &mut *self.state.borrow_mut();
        let (term, outcome) = state.written.graph.sum(a.term, b.term);
        let both_zero = outcome == Outcome::Zero(Side::Right) && state.written.graph.value(a.term) == Some(0.0);
        let (causes, reason) = match outcome {
            // a sum is zero when both are
            Outcome::Zero(_) if both_zero => (state.causes.both(a.causes, b.causes), b.causes),
            Outcome::Zero(Side::Right) => (a.causes, b.causes),
            Outcome::Zero(Side::Left) => (b.causes, a.causes),
            _ if state.written.graph.value(term) == Some(0.0) => {
                (state.causes.one(Cause::Cancellation), state.arithmetic())
            }
            _ => (state.arithmetic(), state.arithmetic()),
        };
        state.record(Operation::Sum, outcome, reason);
        state.record_roles(term, outcome, [a, b]);
        Symbol { sheet: self, term, causes }
    }

    pub(crate) fn product<'s>(&'s self, a: Symbol<'s>, b: Symbol<'s>) -> Symbol<'s> {
        let state = &mut *self.state.borrow_mut();
        let (term, outcome) = state.written.graph.product(a.term, b.term);
        let both_zero = outcome == Outcome::Zero(Side::Right) && state.written.graph.value(a.term) == Some(0.0);
        let reason = match outcome {
            // a product is zero when either is
            Outcome::Zero(_) if both_zero => state.causes.either(a.causes, b.causes),
            Outcome::Zero(Side::Left) | Outcome::One(Side::Left) => a.causes,
            Outcome::Zero(Side::Right) | Outcome::One(Side::Right) => b.causes,
            _ => state.arithmetic(),
        };
        let causes = match outcome {
            Outcome::One(Side::Left) => b.causes,
            Outcome::One(Side::Right) => a.causes,
            _ => reason,
        };
        state.record(Operation::Product, outcome, reason);
        state.record_roles(term, outcome, [a, b]);
        Symbol { sheet: self, term, causes }
    }

    /// Writes what is the derivative by one variable: its quantities bear that in their names.
    pub(crate) fn by<R>(&self, by: By, formulas: impl FnOnce() -> R) -> R {
        let outer = self.state.borrow_mut().by.replace(by);
        let value = formulas();
        self.state.borrow_mut().by = outer;
        value
    }

    pub(crate) fn quotient<'s>(&'s self, a: Symbol<'s>, b: Symbol<'s>) -> Symbol<'s> {
        let state = &mut *self.state.borrow_mut();
        let (term, outcome) = state.written.graph.quotient(a.term, b.term);
        let causes = state.arithmetic();
        state.record_birth();
        state.record_roles(term, outcome, [a, b]);
        Symbol { sheet: self, term, causes }
    }

    pub(crate) fn by_sign<'s>(&'s self, x: Symbol<'s>, positive: Symbol<'s>, negative: Symbol<'s>) -> Symbol<'s> {
        let state = &mut *self.state.borrow_mut();
        let before = state.written.graph.len();
        let term = state.written.graph.by_sign(x.term, positive.term, negative.term);
        let causes = state.arithmetic();
        state.record_birth();
        let is_new = term.node.index() >= before;
        state.record_roles(term, if is_new { Outcome::Computed } else { Outcome::Shared }, [positive, negative]);
        Symbol { sheet: self, term, causes }
    }

    /// What has been written so far.
    pub(crate) fn snapshot(&self) -> Snapshot {
        let written = &mut self.state.borrow_mut().written;
        let len = written.graph.len();
        written.births.resize_with(len, || None);
        Snapshot {
            nodes: written.graph.nodes().map(|(_, node)| node).collect(),
            births: written.births.clone(),
            definitions: written.definitions.clone(),
        }
    }

    /// A term as a symbol.
    pub(crate) fn symbol(&self, term: Term) -> Symbol<'_> {
        let causes = self.state.borrow_mut().arithmetic();
        Symbol { sheet: self, term, causes }
    }

    /// Writes what belongs where something else was born.
    pub(crate) fn at_birth<R>(&self, birth: Option<Birth>, formula: impl FnOnce() -> R) -> R {
        let outer = self.enter(birth.map(|birth| birth.place), birth.and_then(|birth| birth.component.axis()));
        let value = formula();
        self.enter(outer.0, outer.1);
        value
    }

    /// Sets the component that the next operations belong to.
    pub(crate) fn along(&self, axis: Axis) {
        self.state.borrow_mut().axis = Some(axis);
    }

    /// Sets the place and component of the next operations; returns those of the operations before.
    fn enter(&self, place: Option<Place>, axis: Option<Axis>) -> (Option<Place>, Option<Axis>) {
        let state = &mut *self.state.borrow_mut();
        let outer = (state.place, state.axis);
        // leaves and constants of the table that came before belong to no step
        let len = state.written.graph.len();
        state.written.births.resize_with(len, || None);
        (state.place, state.axis) = (place, axis);
        outer
    }

    pub(crate) fn finish(self) -> Written {
        let mut written = self.state.into_inner().written;
        written.births.resize_with(written.graph.len(), || None);
        written
    }
}

impl State {
    fn arithmetic(&mut self) -> CausesId {
        self.causes.one(Cause::Arithmetic)
    }

    /// Remembers as what a constant enters a new node: the same number may be a length here and a mass there.
    fn record_roles(&mut self, term: Term, outcome: Outcome, operands: [Symbol<'_>; 2]) {
        if outcome != Outcome::Computed {
            return;
        }
        for operand in operands {
            if self.written.graph.value(operand.term).is_some()
                && let Some(name) = self.causes.get(operand.causes).entry()
            {
                self.written.roles.insert((term.node, operand.term.node), name);
            }
        }
    }

    /// New nodes belong to the place at hand.
    fn record_birth(&mut self) {
        let component = self.axis.map_or(Component::Scalar, Component::Vector);
        let birth = self.place.map(|place| Birth { place, component });
        self.written.births.resize_with(self.written.graph.len(), || birth);
    }

    fn record(&mut self, operation: Operation, outcome: Outcome, causes: CausesId) {
        // Constants of the table are formed outside any step: a runtime forms them once, too.
        let Some(place) = self.place else { return };
        let cause = self.causes.get(causes).main();
        let fate = match outcome {
            Outcome::Computed => Fate::Kept,
            Outcome::Shared => Fate::Shared,
            Outcome::Zero(_) => Fate::Zero(cause),
            Outcome::One(_) => Fate::One(cause),
            Outcome::Constants => Fate::Constant,
            Outcome::Cancelled => Fate::Cancelled,
        };
        self.written.ledger.enter(place, operation, fate);
        self.record_birth();
    }
}

/// The lines of one joint: each gives a quantity of the lecture its value.
#[derive(Clone, Copy)]
pub(crate) struct JointLines<'s> {
    sheet: &'s Worksheet,
    /// The joint at whose place the lines stand.
    joint: usize,
    /// The joint whose name the quantities bear.
    named: usize,
}

impl<'s> JointLines<'s> {
    /// The same lines, for quantities that belong to the link before.
    pub(crate) fn of_link_before(self) -> Self {
        Self { named: self.joint.saturating_sub(1), ..self }
    }

    /// The same lines, for quantities that belong to the link after.
    pub(crate) fn of_link_after(self) -> Self {
        Self { named: self.joint + 1, ..self }
    }

    /// A quantity that is one number.
    pub(crate) fn scalar(&self, quantity: Quantity, formula: impl FnOnce() -> Symbol<'s>) -> Symbol<'s> {
        let value = self.within(quantity, formula);
        self.sheet.name(Name::scalar(quantity, self.named), value)
    }

    /// A vector.
    pub(crate) fn vector(&self, quantity: Quantity, formula: impl FnOnce() -> Vector<'s>) -> Vector<'s> {
        let value = self.within(quantity, formula);
        self.sheet.entry_vector(quantity, self.named, value)
    }

    /// A matrix.
    pub(crate) fn matrix(&self, quantity: Quantity, formula: impl FnOnce() -> Matrix<'s>) -> Matrix<'s> {
        let value = self.within(quantity, formula);
        self.sheet.entry_matrix(quantity, self.named, value)
    }

    /// Writes what belongs to a quantity and gets no name of its own.
    pub(crate) fn within<R>(&self, quantity: Quantity, formula: impl FnOnce() -> R) -> R {
        let by = self.sheet.state.borrow().by;
        let place = quantity.step().map(|step| Place { joint: self.joint, step, quantity, by });
        let outer = self.sheet.enter(place, None);
        let value = formula();
        self.sheet.enter(outer.0, outer.1);
        value
    }
}
