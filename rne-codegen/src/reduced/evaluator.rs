//! What a plan costs: the form is written, equal values are merged, and what is left is counted.

use rne_model::Robot;

use super::outward::Arm;
use super::plan::Plan;
use super::regroup::{Offers, Parameters, parameters};
use super::rows::{Frames, Table};
use super::sheet::{Cost, Dag, Identity, Ref, Sheet};
use super::way::{self, Way};
use super::writer::{Angle, Writer};
use crate::function::Function;
use crate::name::Name;

/// A table and what it offers.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    frames: Frames,
    pub(crate) table: Table,
    pub(crate) offers: Offers,
}

/// Counts plans of one robot, as many as a search wants.
pub(crate) struct Evaluator {
    frames: Vec<Frame>,
    writer: Writer,
    function: Function,
    dag: Dag,
    live: Vec<bool>,
}

/// The tables of a robot under every choice of frames that applies to it.
pub(crate) fn frames(robot: &Robot) -> Vec<Frame> {
    let choices =
        [false, true].into_iter().flat_map(|carried| [false, true].map(|turned_last| Frames { turned_last, carried }));
    choices
        .filter_map(|frames| {
            let table = Table::new(robot, frames)?;
            let offers = Offers::new(&table);
            Some(Frame { frames, table, offers })
        })
        .collect()
}

/// The table of a robot under the frames of one plan.
pub(crate) fn frame(robot: &Robot, plan: &Plan) -> Option<Frame> {
    let frames = plan.frames();
    let table = Table::new(robot, frames)?;
    let offers = Offers::new(&table);
    Some(Frame { frames, table, offers })
}

impl Frame {
    pub(crate) fn is_of(&self, plan: &Plan) -> bool {
        self.frames == plan.frames()
    }

    pub(crate) fn turns_last(&self) -> bool {
        self.frames.turned_last
    }

    pub(crate) fn carries(&self) -> bool {
        self.frames.carried
    }

    pub(crate) fn parameters(&self, plan: &Plan) -> Option<Parameters> {
        (plan.joints.len() == self.table.rows.len()).then(|| parameters(&self.table, &self.offers, plan))?
    }
}

/// Writes a function on the writer's sheet.
pub(crate) fn write(
    writer: &Writer,
    frame: &Frame,
    plan: &Plan,
    parameters: &Parameters,
    function: Function,
    way: Way,
) -> Vec<(Name, Ref)> {
    let arm = Arm { table: &frame.table, plan, parameters };
    way::write(writer, &arm, function, way).into_iter().map(|(name, symbol)| (name, symbol.at)).collect()
}

impl Evaluator {
    pub(crate) fn new(robot: &Robot, function: Function) -> Self {
        let frames = frames(robot);
        let reading = frames.first().map(|frame| frame.table.reading).unwrap_or_default();
        Self {
            frames,
            writer: Writer::new(function, reading, false),
            function,
            dag: Dag { sheet: Sheet::new(Identity::Value), outputs: Vec::new() },
            live: Vec::new(),
        }
    }

    pub(crate) fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// What a plan costs; `None` when it does not apply to the robot.
    pub(crate) fn cost(&mut self, plan: &Plan) -> Option<Cost> {
        self.cost_of(plan, Way::Recursion)
    }

    /// What a plan costs when the function is written in one of its ways.
    pub(crate) fn cost_of(&mut self, plan: &Plan, way: Way) -> Option<Cost> {
        let frame = self.frames.iter().find(|frame| frame.is_of(plan))?;
        let parameters = frame.parameters(plan)?;
        self.writer.restart(frame.table.reading);
        let outputs: Vec<Ref> =
            write(&self.writer, frame, plan, &parameters, self.function, way).into_iter().map(|(_, at)| at).collect();
        self.dag.rewrite_from(&self.writer.sheet.borrow(), &outputs, &mut self.live);
        Some(cost(&self.dag, frame, &mut self.live))
    }
}

/// Operations of a graph.
pub(crate) fn cost(dag: &Dag, frame: &Frame, live: &mut Vec<bool>) -> Cost {
    let rows = &frame.table.rows;
    dag.cost(live, |first, last| Angle::of(rows, first.into(), last.into()).constant.is_some())
}
