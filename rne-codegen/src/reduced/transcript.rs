//! From the graph of the reduced form to a program with names, and what its constants are exactly.

use std::collections::HashMap;

use rne_model::Robot;

use super::evaluator::{Frame, write};
use super::plan::Plan;
use super::sheet::{Dag, Identity, Leaf, Op, Ref, Sheet, mark_live};
use super::way::Way;
use super::writer::{Angle, Writer};
use crate::CompileError;
use crate::exact::{Image, Number, Turn};
use crate::function::{Form, Function};
use crate::graph::{Graph, NodeId, Term};
use crate::ledger::{Cause, Causes, Place};
use crate::name::Name;
use crate::program::Program;
use crate::proof::{self, Exactly};
use crate::quantity::{Axis, Component, Quantity, Step};
use crate::schedule;
use crate::worksheet::{Birth, Definition, Written};

/// The graph of a function under a plan, with names for its values.
pub(crate) struct Drawing {
    pub(crate) dag: Dag,
    /// The names of what is returned.
    returned: Vec<Name>,
    /// Names in the order in which they were given, and the value that bears each.
    names: Vec<(Name, Image)>,
    /// Where a value was first written.
    births: HashMap<Image, (Place, Component)>,
}

impl Drawing {
    /// Writes the reduced form.
    pub(crate) fn new(frame: &Frame, plan: &Plan, function: Function, way: Way) -> Option<Self> {
        let parameters = frame.parameters(plan)?;
        let writer = Writer::new(function, frame.table.reading, true);
        let (returned, outputs): (Vec<Name>, Vec<Ref>) =
            write(&writer, frame, plan, &parameters, function, way).into_iter().unzip();
        let sheet = writer.sheet.into_inner();
        let naming = writer.naming.map(std::cell::RefCell::into_inner).unwrap_or_default();
        let mut dag = Dag { sheet: Sheet::new(Identity::Value), outputs: Vec::new() };
        let mut live = Vec::new();
        dag.rewrite_from(&sheet, &outputs, &mut live);
        let names = naming.definitions.iter().map(|&(name, at)| (name, sheet.image(at))).collect();
        let mut births = HashMap::new();
        for ((node, birth), _) in sheet.nodes.iter().zip(&naming.births).zip(&live).filter(|(_, live)| **live) {
            if let Some(birth) = birth {
                births.entry(positive(node.image)).or_insert(*birth);
            }
        }
        Some(Self { dag, returned, names, births })
    }

    /// Another graph of the same outputs: values keep their names.
    pub(crate) fn with(self, dag: Dag) -> Self {
        Self { dag, ..self }
    }

    /// The program, `arranged` and proved to be that of the seven steps.
    pub(crate) fn program(
        &self,
        robot: &Robot,
        frame: &Frame,
        function: Function,
        form: Form,
        arranged: fn(Program) -> Program,
    ) -> Result<Program, CompileError> {
        let (program, exactly) = self.unproved(robot, frame, function, form)?;
        let mut program = arranged(program);
        program.proof = Some(proof::prove(robot, &program, &exactly, frame.table.reading)?);
        Ok(program)
    }

    /// The program, and what its constants are.
    pub(crate) fn unproved(
        &self,
        robot: &Robot,
        frame: &Frame,
        function: Function,
        form: Form,
    ) -> Result<(Program, Exactly), CompileError> {
        let written = Written { graph: Graph::exact(frame.table.reading), ..Written::default() };
        let mut transcript = Transcript { frame, written, turns: HashMap::new() };
        let terms = transcript.nodes(self, form);
        let mut outputs = Vec::new();
        for (&name, &at) in self.returned.iter().zip(&self.dag.outputs) {
            let term = mapped(&terms, at);
            transcript.define(name, term);
            outputs.push((name, term));
        }
        for (name, image) in &self.names {
            let Some(at) = self.dag.sheet.valued(*image).filter(|at| terms[at.index()].is_some()) else { continue };
            if !self.returned.contains(name) && at.index() > 1 {
                transcript.define(*name, mapped(&terms, at));
            }
        }
        let Transcript { mut written, turns, .. } = transcript;
        let graph = &written.graph;
        let numbers: Vec<Option<Number>> =
            graph.nodes().map(|(node, _)| graph.number(Term { node, negative: false })).collect();
        written.births.resize_with(written.graph.len(), || None);
        let heading = schedule::Heading {
            robot: &robot.name,
            dof: robot.dof(),
            parameters: robot.run_time.names.len(),
            function,
            form,
        };
        let (program, nodes) = schedule::program_and_constants(&heading, written, &outputs)?;
        let mut exactly = Exactly::new();
        for (constant, node) in program.constants.iter().zip(nodes) {
            let Some(number) = numbers[node.index()] else { continue };
            let turn = turns.get(&node).copied();
            let negative = constant.value < 0.0;
            let signed = if negative { (-number, turn.map(Turn::back)) } else { (number, turn) };
            exactly.insert(constant.name, signed);
        }
        Ok((program, exactly))
    }
}

fn positive(image: Image) -> Image {
    if image.is_negative() { -image } else { image }
}

fn mapped(terms: &[Option<Term>], at: Ref) -> Term {
    // what is live has been written before
    let term = terms[at.index()].unwrap_or(Term { node: NodeId::default(), negative: false });
    if at.is_negative() { -term } else { term }
}

/// A sheet of names being filled.
struct Transcript<'a> {
    frame: &'a Frame,
    written: Written,
    /// What the magnitudes of angles are.
    turns: HashMap<NodeId, Turn>,
}

impl Transcript<'_> {
    /// Writes the live nodes of a graph; their terms by their places.
    fn nodes(&mut self, drawing: &Drawing, form: Form) -> Vec<Option<Term>> {
        let dag = &drawing.dag;
        let mut live = Vec::new();
        mark_live(&dag.sheet.nodes, &dag.outputs, &mut live);
        let mut terms: Vec<Option<Term>> = vec![None; dag.sheet.nodes.len()];
        for (index, node) in dag.sheet.nodes.iter().enumerate().filter(|(index, _)| live[*index]) {
            let graph = &mut self.written.graph;
            let term = match node.op {
                Op::Constant(place) => {
                    let (number, _) = dag.sheet.numbers.get(place);
                    self.constant(number)
                }
                Op::Leaf(leaf) => self.leaf(leaf),
                Op::Sum(a, b) => graph.sum(mapped(&terms, a), mapped(&terms, b)).0,
                Op::Product(a, b) => graph.product(mapped(&terms, a), mapped(&terms, b)).0,
                Op::Inverse(a) => {
                    let one = self.constant(Number::ONE);
                    self.define(Name::scalar(Quantity::One, 0), one);
                    self.written.graph.quotient(one, mapped(&terms, a)).0
                }
            };
            terms[index] = Some(term);
            let len = self.written.graph.len();
            let birth = drawing.births.get(&positive(node.image)).map(|&(place, component)| Birth { place, component });
            let term_place = Place { joint: 0, step: Step::Torque, quantity: Quantity::Term, by: None };
            let unborn = (form == Form::Rewritten).then_some(Birth { place: term_place, component: Component::Scalar });
            let is_operation = matches!(node.op, Op::Sum(..) | Op::Product(..) | Op::Inverse(_));
            let birth = if is_operation { birth.or(unborn) } else { None };
            self.written.births.resize_with(len, || birth);
        }
        terms
    }

    fn constant(&mut self, number: Number) -> Term {
        self.written.graph.constant_number(number)
    }

    fn define(&mut self, name: Name, term: Term) {
        let (after, causes) = (self.written.graph.len(), Causes::one(Cause::Arithmetic));
        self.written.definitions.push(Definition { name, term, causes, after });
    }

    fn leaf(&mut self, leaf: Leaf) -> Term {
        let joint = |joint: u8| usize::from(joint) + 1;
        let tip = self.frame.table.rows.len() + 1;
        let axis = |axis: u8| Axis::ALL[usize::from(axis) % 3];
        let name = match leaf {
            Leaf::Position(at) => Name::scalar(Quantity::Position, joint(at)),
            Leaf::Rate(at) => Name::scalar(Quantity::Rate, joint(at)),
            Leaf::RateDot(at) => Name::scalar(Quantity::RateDot, joint(at)),
            Leaf::Torque(at) => Name::scalar(Quantity::AppliedTorque, joint(at)),
            Leaf::Force(along) => Name::vector(Quantity::JointForce, tip, axis(along)),
            Leaf::Moment(along) => Name::vector(Quantity::JointMoment, tip, axis(along)),
            Leaf::GivenSine(at) => Name::scalar(Quantity::Sine, joint(at)),
            Leaf::GivenCosine(at) => Name::scalar(Quantity::Cosine, joint(at)),
            Leaf::Sine(first, last) | Leaf::Cosine(first, last) => {
                let is_sine = matches!(leaf, Leaf::Sine(..));
                return self.of_angle(usize::from(first), usize::from(last), is_sine);
            }
        };
        self.written.graph.argument(name)
    }

    /// Sine or cosine of the summed angle of joints `first` to `last`, counted from 0.
    fn of_angle(&mut self, first: usize, last: usize, is_sine: bool) -> Term {
        let rows = &self.frame.table.rows;
        let constant = Angle::of(rows, first, last).constant;
        let mut angle = self.written.graph.argument(Name::scalar(Quantity::Position, first + 1));
        for at in first + 1..=last {
            let q = self.written.graph.argument(Name::scalar(Quantity::Position, at + 1));
            let q = if rows[at].reversed == rows[first].reversed { q } else { -q };
            angle = self.written.graph.sum(angle, q).0;
            // without the constant part, if that has one
            let is_angle = Angle::of(rows, first, at).constant.is_none();
            let group = if is_angle { Quantity::GroupAngle } else { Quantity::GroupPosition };
            self.define(group_name(group, Quantity::Angle, first, at), angle);
        }
        if let Some(turn) = constant {
            let theta = self.constant(turn.angle());
            self.turns.insert(theta.node, if theta.negative { turn.back() } else { turn });
            self.define(group_name(Quantity::GroupTheta, Quantity::Theta, first, last), theta);
            angle = self.written.graph.sum(theta, angle).0;
            self.define(group_name(Quantity::GroupAngle, Quantity::Angle, first, last), angle);
        }
        let graph = &mut self.written.graph;
        let term = if is_sine { graph.sine(angle) } else { graph.cosine(angle) };
        let name = if is_sine {
            group_name(Quantity::GroupSine, Quantity::Sine, first, last)
        } else {
            group_name(Quantity::GroupCosine, Quantity::Cosine, first, last)
        };
        self.define(name, term);
        term
    }
}

/// `s3` for one joint, `s2_4` for the sum of three.
fn group_name(group: Quantity, single: Quantity, first: usize, last: usize) -> Name {
    if first == last {
        Name::scalar(single, last + 1)
    } else {
        Name { part: first + 1, ..Name::scalar(group, last + 1) }
    }
}
