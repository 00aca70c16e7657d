//! The builder of formulas: it writes them into a graph and, where wanted, keeps a trace of names, places and causes.

use std::cell::{Cell, RefCell};

use rne_model::{Angle, Joint};
use rustc_hash::FxHashMap;

use super::{
    Axis, Birth, Cause, CausesId, Definition, Embedding, ExactAngle, Graph, Input, Matrix, Name, Number, Operation,
    Operator, Outcome, Place, Policy, Quantity, Ref, Symbol, TermId, Trace, Traced, Vector, WithRespectTo, Written,
    WrittenTerms,
};
use crate::function::Function;

/// The motion of the joints in the formulas that are being written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Moving {
    /// The joints move as the arguments say.
    #[default]
    AsGiven,
    /// All rates are zero, this joint (counted from 0) has the acceleration 1 and the others 0: a column of the mass
    /// matrix.
    OneAccelerates(usize),
    /// The rates are zero and the accelerations are replaced by the rates: computed torques are then momenta.
    RatesForAccelerations,
}

/// A graph that is being written. [`Symbol`]s refer to it, so that operators such as `+` write formulas.
pub(crate) struct Builder {
    pub(crate) graph: RefCell<Graph>,
    trace: Option<RefCell<Trace>>,
    /// The function that is being written. Arguments that this function does not have are zero.
    pub(crate) function: Function,
    /// Whether the origin of a joint frame may be another point of the joint axis than in the table.
    pub(crate) moves_origins: bool,
    /// For each joint, the distance along its axis from the table's origin to the origin that is used, m; `None` if the
    /// formulas use the origins of the table.
    pub(crate) origins: Option<Vec<f64>>,
    /// The variable with respect to which the formulas being written are derivatives.
    by: Cell<Option<WithRespectTo>>,
    /// The motion of the joints in the formulas that are being written.
    pub(crate) moving: Cell<Moving>,
    /// Whether the values being written get no names, because other formulas name the same quantities in other axes.
    is_unnamed: Cell<bool>,
    /// The matrix by which rates of coordinates give rates of the dependent joints of closed loops, by rows; and the
    /// accelerations of the dependent joints if no coordinate accelerates.
    of_loops: RefCell<(Vec<Vec<Ref>>, Vec<Ref>)>,
    /// The accelerations that were solved for, by the names of their arguments, if later formulas of the function use
    /// them.
    solved: RefCell<FxHashMap<Name, Ref>>,
}

impl Builder {
    /// An empty graph with a trace.
    pub(crate) fn traced(policy: Policy, embedding: Embedding, function: Function) -> Self {
        Self { trace: Some(RefCell::default()), ..Self::untraced(policy, embedding, function) }
    }

    /// An empty graph with a trace that keeps formulas as they are written, before anything folds.
    pub(crate) fn explained(policy: Policy, embedding: Embedding, function: Function) -> Self {
        let mut trace = Trace::default();
        trace.terms = Some(WrittenTerms::default());
        Self { trace: Some(RefCell::new(trace)), ..Self::untraced(policy, embedding, function) }
    }

    /// An empty graph without a trace, for formulas that are counted or evaluated but not read.
    pub(crate) fn untraced(policy: Policy, embedding: Embedding, function: Function) -> Self {
        Self {
            graph: RefCell::new(Graph::new(policy, embedding)),
            trace: None,
            function,
            // the seven steps use the joint origins of the table
            moves_origins: policy != Policy::Structure,
            origins: None,
            by: Cell::new(None),
            moving: Cell::default(),
            is_unnamed: Cell::default(),
            of_loops: RefCell::default(),
            solved: RefCell::default(),
        }
    }

    /// Allows joint origins at other points of the joint axes than in the table.
    pub(crate) fn moving_origins(self) -> Self {
        Self { moves_origins: true, ..self }
    }

    /// Whether a trace with names is kept.
    pub(crate) fn is_traced(&self) -> bool {
        self.trace.is_some()
    }

    /// Clears the graph for formulas with another embedding of the numbers into the prime fields.
    pub(crate) fn restart(&mut self, embedding: Embedding) {
        self.graph.get_mut().clear(embedding);
        self.of_loops.take();
        self.solved.take();
    }

    fn embedding(&self) -> Embedding {
        self.graph.borrow().embedding()
    }

    /// Returns the symbol of a node, without causes of its value.
    pub(crate) fn symbol(&self, at: Ref) -> Symbol<'_> {
        Symbol { builder: self, at, causes: CausesId::ARITHMETIC, term: TermId::NONE }
    }

    fn caused(&self, at: Ref, cause: Cause) -> Symbol<'_> {
        let causes = self.trace.as_ref().map_or(CausesId::ARITHMETIC, |trace| trace.borrow_mut().causes.single(cause));
        Symbol { builder: self, at, causes, term: TermId::NONE }
    }

    /// Stores a term of a formula and returns its index; [`TermId::NONE`] if formulas are not kept.
    fn written(&self, term: Written) -> TermId {
        let Some(trace) = &self.trace else { return TermId::NONE };
        trace.borrow_mut().terms.as_mut().map_or(TermId::NONE, |terms| terms.push(term))
    }

    /// Returns the negative of a term; a leaf stays a leaf, because its node says whether it is negative.
    pub(super) fn negative(&self, term: TermId) -> TermId {
        if term == TermId::NONE { term } else { self.written(Written::Negative(term)) }
    }

    /// An exact number.
    pub(crate) fn number(&self, number: Number) -> Symbol<'_> {
        self.symbol(self.graph.borrow_mut().constant(number))
    }

    /// A constant angle.
    pub(crate) fn angle(&self, turn: ExactAngle) -> Symbol<'_> {
        self.symbol(self.graph.borrow_mut().angle(turn))
    }

    /// The number 0.
    pub(crate) fn zero(&self) -> Symbol<'_> {
        self.symbol(self.graph.borrow_mut().zero())
    }

    /// The number 1.
    pub(crate) fn one(&self) -> Symbol<'_> {
        self.symbol(self.graph.borrow_mut().one())
    }

    /// The zero vector.
    pub(crate) fn no_vector(&self) -> Vector<'_> {
        Vector([self.zero(); 3])
    }

    /// Sine and cosine of a constant angle.
    pub(crate) fn constant_turn(&self, angle: &Angle, cause: Cause) -> (Symbol<'_>, Symbol<'_>) {
        let turn = self.embedding().turn(angle);
        // with the policy `Structure`, numbers are the rounded ones of the runtime
        let [sine, cosine] = [(turn.sin, angle.sin), (turn.cos, angle.cos)].map(|(exact, value)| {
            let number = self.rounded(exact, value);
            self.caused(self.graph.borrow_mut().constant(number), cause)
        });
        (sine, cosine)
    }

    /// The inertia of a link about its centre of mass.
    pub(crate) fn inertia(&self, joint: &Joint) -> Matrix<'_> {
        let exact = self.embedding().inertia(joint);
        let rows = joint.row.link.inertia.rows();
        let element = |i: usize, j: usize| {
            let number = self.rounded(exact[i][j], rows[i][j]);
            self.caused(self.graph.borrow_mut().constant(number), Cause::Arithmetic)
        };
        Matrix::from_rows([0, 1, 2].map(|i| [0, 1, 2].map(|j| element(i, j))))
    }

    /// Returns the exact number; with the policy `Structure`, the rounded number of the runtime, so that results agree
    /// bit by bit.
    fn rounded(&self, exact: Number, value: f64) -> Number {
        match self.graph.borrow().policy() {
            Policy::Structure => Number::rounded(value, exact.residue),
            _ => exact,
        }
    }

    /// A number without a name; `cause` is the reason for its value.
    pub(crate) fn constant(&self, value: f64, cause: Cause) -> Symbol<'_> {
        let number = self.embedding().decimal(value);
        self.caused(self.graph.borrow_mut().constant(number), cause)
    }

    /// A number of the table under its name.
    pub(crate) fn entry(&self, name: Name, value: f64) -> Symbol<'_> {
        self.name(name, self.constant(value, Cause::Table(name)))
    }

    /// An argument of the function.
    pub(crate) fn argument(&self, name: Name) -> Symbol<'_> {
        self.symbol(self.graph.borrow_mut().input(Input::new(name)))
    }

    /// The zero vector; `cause` says why it is zero.
    pub(crate) fn zeros(&self, cause: Cause) -> Vector<'_> {
        Vector([self.constant(0.0, cause); 3])
    }

    /// Stores the map of closed loops, whose elements [`loop_map`](Self::loop_map) returns.
    pub(crate) fn keep_loop_map(&self, map: &[Vec<Symbol<'_>>]) {
        self.of_loops.borrow_mut().0 = map.iter().map(|row| row.iter().map(|x| x.at).collect()).collect();
    }

    /// Stores the accelerations of the dependent joints if no coordinate accelerates.
    pub(crate) fn keep_loop_bias(&self, bias: &[Symbol<'_>]) {
        self.of_loops.borrow_mut().1 = bias.iter().map(|x| x.at).collect();
    }

    /// Stores solved accelerations of the joints and of a floating base. From now on formulas use them in place of the
    /// arguments.
    pub(crate) fn keep_accelerations<'s>(&self, solved: impl Iterator<Item = (WithRespectTo, Symbol<'s>)>) {
        *self.solved.borrow_mut() = solved.map(|(of, x)| (of.variable(), x.at)).collect();
    }

    /// Whether accelerations were solved for.
    pub(crate) fn has_accelerations(&self) -> bool {
        !self.solved.borrow().is_empty()
    }

    /// An acceleration that was solved for, by the name of its argument.
    pub(crate) fn solved_acceleration(&self, name: Name) -> Option<Symbol<'_>> {
        self.solved.borrow().get(&name).map(|&at| self.symbol(at))
    }

    /// An acceleration vector of a floating base, if it was solved for.
    pub(crate) fn solved_of_base(&self, quantity: Quantity) -> Option<Vector<'_>> {
        let [x, y, z] = Axis::ALL.map(|axis| self.solved_acceleration(Name::vector(quantity, 0, axis)));
        Some(Vector([x?, y?, z?]))
    }

    /// The nodes of the solved accelerations. Derivatives of the torques treat them as constant.
    pub(super) fn held(&self) -> Vec<usize> {
        self.solved.borrow().values().map(|at| at.index()).collect()
    }

    /// Replaces the solved accelerations by arguments until the values are numbered, if formulas fold by value.
    /// Derivatives keep these accelerations constant, so formulas must not know their values: with them, the torques
    /// would fold to the given torques.
    pub(crate) fn hold_accelerations(&self) {
        let mut graph = self.graph.borrow_mut();
        let Some(trace) = self.trace.as_ref().filter(|_| graph.policy() == Policy::Value) else { return };
        for (&name, at) in self.solved.borrow_mut().iter_mut() {
            if !graph.is_constant(*at) {
                let argument = graph.input(Input::new(name));
                trace.borrow_mut().held.push((argument, std::mem::replace(at, argument)));
            }
        }
    }

    /// Returns an element of the map of closed loops; zero before the map is stored.
    pub(crate) fn loop_map(&self, passive: usize, coordinate: usize) -> Symbol<'_> {
        let at = self.of_loops.borrow().0.get(passive).and_then(|row| row.get(coordinate)).copied();
        at.map_or_else(|| self.zero(), |at| self.symbol(at))
    }

    /// Returns the acceleration of a dependent joint if no coordinate accelerates; zero before it is stored.
    pub(crate) fn loop_bias(&self, passive: usize) -> Symbol<'_> {
        let at = self.of_loops.borrow().1.get(passive).copied();
        at.map_or_else(|| self.zero(), |at| self.symbol(at))
    }

    /// Gives a symbol a name. For a constant of the table, the name is also the cause of its value, so that a fold
    /// report can say which number was zero.
    pub(crate) fn name<'s>(&'s self, name: Name, symbol: Symbol<'s>) -> Symbol<'s> {
        let Some(trace) = &self.trace else { return symbol };
        let Some(quantity) = self.meant(name.quantity) else { return symbol };
        let name = Name { quantity, ..name };
        let trace = &mut *trace.borrow_mut();
        let is_entry = name.quantity.step().is_none() || name.quantity == Quantity::D;
        let name = if is_entry { name } else { Name { by: name.by.or(self.by.get()), ..name } };
        let graph = self.graph.borrow();
        // the elements (i, j) and (j, i) of a symmetric tensor are zero because of one number of the table
        let told = if graph.is_zero(symbol.at) { name.of_upper_half() } else { name };
        let causes = if is_entry { trace.causes.single(Cause::Table(told)) } else { symbol.causes };
        let after = graph.len();
        let told = trace.causes.get(causes).clone();
        let place = if name.quantity.step().is_some() { trace.place() } else { None };
        trace.definitions.push(Definition { name, at: symbol.at, causes: told, after, term: symbol.term, place });
        let term = trace.terms.as_mut().map_or(TermId::NONE, |terms| terms.push(Written::Named(name)));
        Symbol { causes, term, ..symbol }
    }

    /// Names the components of a vector.
    pub(crate) fn name_vector<'s>(&'s self, quantity: Quantity, joint: usize, v: Vector<'s>) -> Vector<'s> {
        self.name_carried(quantity, [joint, 0], v)
    }

    /// Names the components of a vector of one joint or tip that a link carries; `carried` counts these, 0 for the
    /// first.
    fn name_carried<'s>(&'s self, quantity: Quantity, [joint, carried]: [usize; 2], v: Vector<'s>) -> Vector<'s> {
        if !self.is_traced() {
            return v;
        }
        v.map(|axis, x| self.name(Name { indices: [carried, 0], ..Name::vector(quantity, joint, axis) }, x))
    }

    /// Names the elements of a matrix.
    pub(crate) fn name_matrix<'s>(&'s self, quantity: Quantity, joint: usize, m: Matrix<'s>) -> Matrix<'s> {
        if !self.is_traced() {
            return m;
        }
        m.map(|row, column, x| self.name(Name::matrix(quantity, joint, row, column), x))
    }

    /// Starts formulas of one joint, counted from 1.
    pub(crate) fn joint(&self, joint: usize) -> JointLines<'_> {
        JointLines { builder: self, joint, named: joint, carried: 0 }
    }

    pub(crate) fn sine_and_cosine<'s>(&'s self, angle: Symbol<'s>) -> (Symbol<'s>, Symbol<'s>) {
        let graph = &mut *self.graph.borrow_mut();
        let (sine, cosine) = (graph.sine(angle.at), graph.cosine(angle.at));
        (self.symbol(sine), self.symbol(cosine))
    }

    pub(crate) fn sum<'s>(&'s self, a: Symbol<'s>, b: Symbol<'s>) -> Symbol<'s> {
        let made = self.graph.borrow_mut().sum(a.at, b.at);
        self.recorded(made, Some(Operator::Sum), [a, b])
    }

    pub(crate) fn product<'s>(&'s self, a: Symbol<'s>, b: Symbol<'s>) -> Symbol<'s> {
        let made = self.graph.borrow_mut().product(a.at, b.at);
        self.recorded(made, Some(Operator::Product), [a, b])
    }

    /// Writes a / b. The fold report does not count it.
    pub(crate) fn quotient<'s>(&'s self, a: Symbol<'s>, b: Symbol<'s>) -> Symbol<'s> {
        let made = self.graph.borrow_mut().quotient(a.at, b.at);
        self.recorded(made, Some(Operator::Quotient), [a, b])
    }

    /// Writes the choice of a value by the sign of `x`. The fold report does not count it.
    pub(crate) fn by_sign<'s>(&'s self, x: Symbol<'s>, positive: Symbol<'s>, negative: Symbol<'s>) -> Symbol<'s> {
        let made = self.graph.borrow_mut().by_sign(x.at, positive.at, negative.at);
        let symbol = self.recorded(made, None, [positive, negative]);
        let operands = [x, positive, negative].map(|operand| self.term(operand));
        let term = self.written(Written::BySign(operands));
        Symbol { term, ..symbol }
    }

    /// Records an operation in the trace, and returns the symbol of its result.
    fn recorded<'s>(
        &'s self,
        (at, outcome): (Ref, Outcome),
        operator: Option<Operator>,
        operands: [Symbol<'s>; 2],
    ) -> Symbol<'s> {
        let Some(trace) = &self.trace else { return self.symbol(at) };
        let terms = operands.map(|operand| self.term(operand));
        let (graph, trace) = (&*self.graph.borrow(), &mut *trace.borrow_mut());
        let (mut causes, mut reason) = (CausesId::ARITHMETIC, CausesId::ARITHMETIC);
        let counted = match operator {
            Some(Operator::Sum) => Some(Operation::Sum),
            Some(Operator::Product) => Some(Operation::Product),
            _ => None,
        };
        if let Some(operation) = counted {
            (causes, reason) = trace.causes_of(graph, operation, at, outcome, operands);
            trace.record(graph.len(), operation, outcome, reason);
        } else {
            trace.record_birth(graph.len());
        }
        trace.record_roles(graph, at, outcome, operands);
        let counted = trace.place().is_some();
        let written =
            operator.map(|operator| Written::Operation { operator, operands: terms, at, outcome, reason, counted });
        let kept = trace.terms.as_mut().zip(written);
        let term = kept.map_or(TermId::NONE, |(terms, written)| terms.push(written));
        Symbol { builder: self, at, causes, term }
    }

    /// Returns the term of a symbol; a symbol without a term becomes a leaf of the formula.
    fn term(&self, symbol: Symbol<'_>) -> TermId {
        match symbol.term {
            TermId::NONE => self.written(Written::Node(symbol.at, symbol.causes)),
            term => term,
        }
    }

    /// Writes formulas of derivatives with respect to `by`, which the names of their quantities then contain.
    pub(crate) fn by<R>(&self, by: Option<WithRespectTo>, formulas: impl FnOnce() -> R) -> R {
        let outer = self.by.replace(by);
        let value = formulas();
        self.by.set(outer);
        value
    }

    /// Returns the trace so far: the place where each node was created, and the named values.
    pub(super) fn told(&self) -> (Vec<Option<Birth>>, Vec<Definition>) {
        let Some(trace) = &self.trace else { return Default::default() };
        let trace = &mut *trace.borrow_mut();
        trace.births.resize_with(self.graph.borrow().len(), || None);
        (trace.births.clone(), trace.definitions.clone())
    }

    /// Writes a formula whose operations are counted at the place of another node.
    pub(super) fn at_birth<R>(&self, birth: Option<Birth>, formula: impl FnOnce() -> R) -> R {
        let outer = self.enter(birth.map(|birth| birth.place), birth.and_then(|birth| birth.component.axis()));
        let value = formula();
        self.enter(outer.0, outer.1);
        value
    }

    /// Assigns the next operations to this quantity of this joint; joints count from 1.
    pub(crate) fn at(&self, quantity: Quantity, joint: usize) {
        if let Some(place) = self.place(quantity, joint) {
            self.enter(Some(place), None);
        }
    }

    /// Writes a formula whose values get no names.
    pub(crate) fn unnamed<R>(&self, formula: impl FnOnce() -> R) -> R {
        let outer = self.is_unnamed.replace(true);
        let value = formula();
        self.is_unnamed.set(outer);
        value
    }

    /// Returns the quantity that results if rates replace accelerations, such as a momentum for a torque; `None` if the
    /// value gets no name.
    fn meant(&self, quantity: Quantity) -> Option<Quantity> {
        if self.is_unnamed.get() {
            return None;
        }
        if self.moving.get() == Moving::RatesForAccelerations { quantity.of_momentum() } else { Some(quantity) }
    }

    fn place(&self, quantity: Quantity, joint: usize) -> Option<Place> {
        let quantity = self.meant(quantity).unwrap_or(quantity);
        quantity.step().map(|step| Place { joint, step, quantity, by: self.by.get() })
    }

    /// Sets the component that the next operations belong to.
    pub(super) fn along(&self, axis: Axis) {
        if let Some(trace) = &self.trace {
            trace.borrow_mut().along(axis);
        }
    }

    /// Sets the place and component of the next operations; returns those of the operations before.
    fn enter(&self, place: Option<Place>, axis: Option<Axis>) -> (Option<Place>, Option<Axis>) {
        let Some(trace) = &self.trace else { return (None, None) };
        trace.borrow_mut().enter(self.graph.borrow().len(), place, axis)
    }

    /// The finished graph with these results, and its trace.
    pub(crate) fn finish(self, outputs: Vec<Ref>) -> Traced {
        let mut graph = self.graph.into_inner();
        graph.outputs = outputs;
        let mut trace = self.trace.map(RefCell::into_inner).unwrap_or_default();
        trace.births.resize_with(graph.len(), || None);
        Traced { graph, trace }
    }
}

/// The formulas of one joint. Each computes a quantity of the lecture and names it.
#[derive(Clone, Copy)]
pub(crate) struct JointLines<'s> {
    pub(crate) builder: &'s Builder,
    /// The joint at which the operations are counted.
    joint: usize,
    /// The joint whose number is in the names of the quantities.
    named: usize,
    /// The number of the joint or tip, among those that the link carries; 0 for the first.
    carried: usize,
}

impl<'s> JointLines<'s> {
    /// Returns these formulas with the number of another joint in the names of their quantities.
    pub(crate) fn named(self, joint: usize) -> Self {
        Self { named: joint, ..self }
    }

    /// Returns these formulas for a link that carries several joints or tips; the number `carried` in names tells them
    /// apart.
    pub(crate) fn with_second_number(self, carried: usize) -> Self {
        Self { carried, ..self }
    }

    /// Returns these formulas for quantities between the link of the joint and its parent link; `None` is the base.
    pub(crate) fn behind(self, parent: Option<usize>) -> Self {
        self.with_second_number(Name::index_of_parent(self.named, parent.map_or(0, |parent| parent + 1)))
    }

    /// A number of the table.
    pub(crate) fn entry(&self, quantity: Quantity, value: f64) -> Symbol<'s> {
        self.builder.entry(Name::scalar(quantity, self.named), value)
    }

    /// Returns the constant part of a joint angle. If it gets no name, it is stored as an angle, with sine and cosine.
    pub(crate) fn constant_angle(&self, theta: &Angle) -> Symbol<'s> {
        if self.builder.is_unnamed.get() {
            return self.builder.angle(self.builder.embedding().turn(theta));
        }
        self.entry(Quantity::Theta, theta.radians)
    }

    /// Gives a number a name.
    pub(crate) fn name(&self, quantity: Quantity, symbol: Symbol<'s>) -> Symbol<'s> {
        self.builder.name(Name::scalar(quantity, self.named), symbol)
    }

    /// Names the components of a vector.
    pub(crate) fn name_vector(&self, quantity: Quantity, vector: Vector<'s>) -> Vector<'s> {
        self.builder.name_carried(quantity, [self.named, self.carried], vector)
    }

    /// Begins a quantity: `line.define(quantity).by(formula)` computes the formula and gives its result the name of
    /// the quantity. The operations of the formula belong to this quantity.
    pub(crate) fn define(&self, quantity: Quantity) -> Begun<'s> {
        Begun { line: *self, quantity, outer: self.builder.enter(self.builder.place(quantity, self.joint), None) }
    }

    /// Writes a formula whose operations belong to a quantity, without giving its result a name.
    pub(crate) fn within<R>(&self, quantity: Quantity, formula: impl FnOnce() -> R) -> R {
        let outer = self.builder.enter(self.builder.place(quantity, self.joint), None);
        let value = formula();
        self.builder.enter(outer.0, outer.1);
        value
    }
}

/// A quantity of a joint that has no formula yet.
#[must_use]
pub(crate) struct Begun<'s> {
    line: JointLines<'s>,
    quantity: Quantity,
    /// The place and axis of the operations before, which are set again at the end.
    outer: (Option<Place>, Option<Axis>),
}

impl<'s> Begun<'s> {
    /// Gives the quantity the value of this formula, and returns it under the name of the quantity.
    pub(crate) fn by<V: Value<'s>>(self, formula: V) -> V {
        let value = formula.named(&self.line, self.quantity);
        self.line.builder.enter(self.outer.0, self.outer.1);
        value
    }
}

/// The value of a quantity: a number, a vector or a matrix.
pub(crate) trait Value<'s> {
    /// Names each element of the value after a quantity, and returns the value.
    fn named(self, line: &JointLines<'s>, quantity: Quantity) -> Self;
}

impl<'s> Value<'s> for Symbol<'s> {
    fn named(self, line: &JointLines<'s>, quantity: Quantity) -> Self {
        line.name(quantity, self)
    }
}

impl<'s> Value<'s> for Vector<'s> {
    fn named(self, line: &JointLines<'s>, quantity: Quantity) -> Self {
        line.name_vector(quantity, self)
    }
}

impl<'s> Value<'s> for Matrix<'s> {
    fn named(self, line: &JointLines<'s>, quantity: Quantity) -> Self {
        line.builder.name_matrix(quantity, line.named, self)
    }
}
