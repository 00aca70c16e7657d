//! The cost of a plan: writes the form, merges equal values, and counts the remaining operations.

use rne_model::{JointKind, Robot};

use crate::CompileError;
use crate::formulate::Outputs;
use crate::formulation::Formulation;
use crate::function::{Argument, Function};
use crate::ir::{Builder, Cost, Graph, Number, Policy, Ref, number_values};
use crate::plan::{OriginShift, Plan, Scale};
use crate::program::Scales;
use crate::reduced::regrouping::{is_parallel, parameters};
use crate::reduced::{Algorithm, Arm, FrameChoice, JointFrames, Offers, Parameters, algorithm};

/// A table and the choices that it offers.
#[derive(Clone, Debug)]
pub(crate) struct FramedRobot {
    frames: FrameChoice,
    pub(crate) joint_frames: JointFrames,
    pub(crate) offers: Offers,
}

/// The choices that a robot leaves open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpenChoices {
    /// The choices of each joint, base to tip.
    pub joints: Vec<OpenJoint>,
    /// The different lengths of the robot, in which lengths and forces can be measured.
    pub lengths: Vec<Scale>,
    /// Whether the last link can be a spinning sphere without mass.
    pub gyrostat: bool,
    /// Whether the last frame can be turned.
    pub turned_last_frame: bool,
    /// Whether prismatic links can keep the axes of the revolute link before.
    pub carried_prismatics: bool,
}

/// The choices that one joint leaves open.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenJoint {
    /// Revolute or prismatic.
    pub kind: JointKind,
    /// Whether its axis is parallel to the one before, both revolute.
    pub is_parallel: bool,
    /// Whether the twist between the axes is no multiple of a right angle.
    pub is_twisted: bool,
    /// The rules that give different slides of the origin.
    pub origin_shifts: Vec<OriginShift>,
}

impl OpenChoices {
    /// Whether a rule for a slide gives something of its own at a joint.
    #[must_use]
    pub fn offers(&self, index: usize, rule: OriginShift) -> bool {
        self.joints.get(index).is_some_and(|joint| joint.origin_shifts.contains(&rule))
    }
}

/// Counts plans of one robot, as many as a search wants.
pub(crate) struct Evaluator {
    frames: Vec<FramedRobot>,
    builder: Builder,
    numbered: Graph,
    live: Vec<bool>,
    map: Vec<Ref>,
}

/// The tables of a robot under every choice of frames that applies to it.
pub(crate) fn frames(robot: &Robot) -> Vec<FramedRobot> {
    let choices = [false, true]
        .into_iter()
        .flat_map(|carried| [false, true].map(|turned_last| FrameChoice { turned_last, carried }));
    choices
        .filter_map(|frames| {
            let joint_frames = JointFrames::new(robot, frames)?;
            let offers = Offers::new(&joint_frames);
            Some(FramedRobot { frames, joint_frames, offers })
        })
        .collect()
}

/// The table of a robot under the frames of one plan.
pub(crate) fn frame(robot: &Robot, plan: &Plan) -> Option<FramedRobot> {
    let frames = plan.frames();
    let joint_frames = JointFrames::new(robot, frames)?;
    let offers = Offers::new(&joint_frames);
    Some(FramedRobot { frames, joint_frames, offers })
}

impl FramedRobot {
    pub(crate) fn is_of(&self, plan: &Plan) -> bool {
        self.frames == plan.frames()
    }

    pub(crate) fn parameters(&self, plan: &Plan) -> Option<Parameters> {
        (plan.joints.len() == self.joint_frames.rows.len())
            .then(|| parameters(&self.joint_frames, &self.offers, plan))?
    }

    /// The results of the builder's function under a plan.
    fn outputs<'s>(
        &self,
        builder: &'s Builder,
        plan: &Plan,
        parameters: &Parameters,
        algorithm: Algorithm,
    ) -> Option<Outputs<'s>> {
        let expressed_in = algorithm.expressed_in();
        algorithm::write(&Arm { builder, expressed_in, joint_frames: &self.joint_frames, plan, parameters }, algorithm)
    }

    /// A function under a plan, every value once, with names; `None` when the plan does not apply to the robot.
    pub(crate) fn written(&self, plan: &Plan, function: Function, algorithm: Algorithm) -> Option<Formulation> {
        if plan.gyrostat && function.takes(Argument::Payload) {
            // with a payload no last link is a sphere
            return None;
        }
        let parameters = self.parameters(plan)?;
        let builder = Builder::traced(Policy::Value, self.joint_frames.embedding, function);
        let (names, outputs) = self
            .outputs(&builder, plan, &parameters, algorithm)?
            .into_iter()
            .map(|(name, symbol)| (name, builder.name(name, symbol).at))
            .unzip();
        let mut traced = builder.finish(outputs);
        // a number of the plan means what it is called, or nothing, wherever it is first used
        traced.trace.forget_births_of_leaves(&traced.graph);
        let [length, force] = [parameters.lambda, parameters.mu].map(Number::to_f64);
        let scales = Some(Scales { length, force }).filter(|scales| *scales != Scales::default());
        Some(Formulation { names, traced: traced.numbered(), scales })
    }
}

impl Formulation {
    /// A function written by one algorithm under a plan, every value once.
    ///
    /// # Errors
    /// When the plan does not fit the robot.
    pub fn by_plan(robot: &Robot, plan: &Plan, function: Function, algorithm: Algorithm) -> Result<Self, CompileError> {
        let sphere = plan.gyrostat && !function.takes(Argument::Payload);
        let plan = &Plan { gyrostat: sphere, ..plan.clone() };
        let written = frame(robot, plan).and_then(|frame| frame.written(plan, function, algorithm));
        written.ok_or_else(|| CompileError::PlanDoesNotFit { robot: robot.name.clone() })
    }
}

impl Evaluator {
    pub(crate) fn new(robot: &Robot, function: Function) -> Self {
        let frames = frames(robot);
        let embedding = frames.first().map(|frame| frame.joint_frames.embedding).unwrap_or_default();
        Self {
            frames,
            builder: Builder::untraced(Policy::Value, embedding, function),
            numbered: Graph::new(Policy::Numbered, embedding),
            live: Vec::new(),
            map: Vec::new(),
        }
    }

    /// The choices that the robot leaves open.
    pub(crate) fn open_choices(&self) -> OpenChoices {
        let has = |test: fn(&FrameChoice) -> bool| self.frames.iter().any(|frame| test(&frame.frames));
        let Some(FramedRobot { joint_frames, offers, .. }) = self.frames.first() else { return OpenChoices::default() };
        let rows = &joint_frames.rows;
        let joints = rows.iter().zip(&offers.origin_shifts).enumerate().map(|(index, (row, shifts))| OpenJoint {
            kind: row.kind,
            is_parallel: is_parallel(rows, index),
            is_twisted: row.alpha.quarters().is_none(),
            origin_shifts: shifts.iter().map(|(rule, _)| *rule).collect(),
        });
        OpenChoices {
            joints: joints.collect(),
            lengths: offers.lengths.clone(),
            gyrostat: offers.gyrostat,
            turned_last_frame: has(|frames| frames.turned_last),
            carried_prismatics: has(|frames| frames.carried),
        }
    }

    /// The cost of a plan; `None` when it does not apply to the robot.
    pub(crate) fn cost(&mut self, plan: &Plan) -> Option<Cost> {
        self.cost_of(plan, Algorithm::Rnea)
    }

    /// The cost of a plan when the function is written in one of its ways.
    pub(crate) fn cost_of(&mut self, plan: &Plan, algorithm: Algorithm) -> Option<Cost> {
        let Self { frames, builder, numbered, live, map } = self;
        let frame = frames.iter().find(|frame| frame.is_of(plan))?;
        let parameters = frame.parameters(plan)?;
        builder.restart(frame.joint_frames.embedding);
        let outputs = frame.outputs(builder, plan, &parameters, algorithm)?;
        let outputs: Vec<Ref> = outputs.into_iter().map(|(_, symbol)| symbol.at).collect();
        let graph = builder.graph.get_mut();
        graph.outputs = outputs;
        number_values(graph, numbered, live, map);
        Some(numbered.cost(live))
    }
}
