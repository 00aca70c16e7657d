//! The cost of a plan: writes the form, merges equal values, and counts the remaining operations.

use rne_model::{JointKind, Robot};

use crate::CompileError;
use crate::formulate::Outputs;
use crate::formulation::Formulation;
use crate::function::{Argument, Function};
use crate::ir::{Builder, Cost, Graph, Policy, Ref, number_values};
use crate::plan::branches::{self, BaseBranch};
use crate::plan::{OriginShift, Plan, Scale};
use crate::program::Scales;
use crate::reduced::regrouping::{is_parallel, parameters};
use crate::reduced::{Algorithm, Arm, FrameChoice, JointFrames, Offers, Parameters, results};

/// Largest number of plans whose costs are remembered, per branch of the base.
const MOST_KNOWN: usize = 100_000;

/// A robot with one choice of frames, and the other choices that it then has.
#[derive(Clone, Debug)]
pub(crate) struct FramedRobot {
    robot: Robot,
    frames: FrameChoice,
    pub(crate) joint_frames: JointFrames,
    pub(crate) offers: Offers,
}

/// The choices that a robot leaves open.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(clippy::struct_excessive_bools)] // independent choices
pub struct OpenChoices {
    /// The choices of each joint, base to tip.
    pub joints: Vec<OpenJoint>,
    /// The different lengths of the robot that can be units of lengths and forces.
    pub lengths: Vec<Scale>,
    /// Whether the last link can be a spinning sphere without mass.
    pub gyrostat: bool,
    /// Whether the last frame can be turned.
    pub turned_last_frame: bool,
    /// Whether prismatic links can keep the axes of the revolute link before.
    pub carried_prismatics: bool,
    /// Whether the base floats, so that it is a link.
    pub floating_base: bool,
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
    /// The rules for a shift of the origin along the axis that give different results.
    pub origin_shifts: Vec<OriginShift>,
    /// This joint and the joints that it carries, counted from 0, if it is one of several joints on the base: these can
    /// have scales of their own. Empty for other joints.
    pub scaled: Vec<usize>,
    /// This joint and the joints in the same place of branches of the same structure, counted from 0.
    pub alike: Vec<usize>,
}

impl OpenChoices {
    /// Whether a rule for a shift of the origin gives a result of its own at a joint.
    #[must_use]
    pub fn offers(&self, index: usize, rule: OriginShift) -> bool {
        self.joints.get(index).is_some_and(|joint| joint.origin_shifts.contains(&rule))
    }
}

/// Counts the operations of many plans of one robot, and uses its memory again for each.
pub(crate) struct Evaluator {
    robot: Robot,
    frames: Vec<FramedRobot>,
    /// Per choice of frames, the branches of the base.
    branches: Vec<Vec<BaseBranch>>,
    builder: Builder,
    numbered: Graph,
    live: Vec<bool>,
    map: Vec<Ref>,
}

/// The tables of a robot under every choice of frames that applies to it.
pub(crate) fn frames(robot: &Robot, function: Function) -> Vec<FramedRobot> {
    let floating = function.is_of_floating_base();
    let choices = [false, true]
        .into_iter()
        .flat_map(|carried| [false, true].map(|turned_last| FrameChoice { turned_last, carried, floating }));
    choices
        .filter_map(|frames| {
            let joint_frames = JointFrames::new(robot, frames)?;
            let offers = Offers::new(&joint_frames);
            Some(FramedRobot { robot: robot.clone(), frames, joint_frames, offers })
        })
        .collect()
}

/// The table of a robot under the frames of one plan.
pub(crate) fn frame(robot: &Robot, plan: &Plan, function: Function) -> Option<FramedRobot> {
    let frames = FrameChoice { floating: function.is_of_floating_base(), ..plan.frames() };
    let joint_frames = JointFrames::new(robot, frames)?;
    let offers = Offers::new(&joint_frames);
    Some(FramedRobot { robot: robot.clone(), frames, joint_frames, offers })
}

impl FramedRobot {
    pub(crate) fn is_of(&self, plan: &Plan) -> bool {
        self.frames == (FrameChoice { floating: self.frames.floating, ..plan.frames() })
    }

    pub(crate) fn parameters(&self, plan: &Plan) -> Option<Parameters> {
        (plan.joints.len() == self.joint_frames.rows.len())
            .then(|| parameters(&self.joint_frames, &self.offers, plan))?
    }

    /// Writes a function under a plan, with names and with every value computed once; `None` if the plan does not fit
    /// the robot.
    pub(crate) fn written(&self, plan: &Plan, function: Function, algorithm: Algorithm) -> Option<Formulation> {
        if plan.gyrostat && function.takes(Argument::Payload) {
            // with a payload, the last link is not a sphere
            return None;
        }
        let parameters = self.parameters(plan)?;
        let builder = Builder::traced(Policy::Value, self.joint_frames.embedding, function);
        let (names, outputs) = outputs(&builder, &self.robot, &self.joint_frames, plan, &parameters, algorithm)?
            .into_iter()
            .map(|(name, symbol)| (name, builder.name(name, symbol).at))
            .unzip();
        let mut traced = builder.finish(outputs);
        // a constant is named by the plan or not at all, and not after the step where it is first used
        traced.trace.forget_births_of_leaves(&traced.graph);
        let scales = Scales::of(&self.joint_frames.rows, &parameters);
        Some(Formulation { names, traced: traced.numbered(), scales })
    }
}

/// The results of the builder's function under a plan.
fn outputs<'s>(
    builder: &'s Builder,
    robot: &Robot,
    joint_frames: &JointFrames,
    plan: &Plan,
    parameters: &Parameters,
    algorithm: Algorithm,
) -> Option<Outputs<'s>> {
    let expressed_in = algorithm.expressed_in();
    results::write(Arm { builder, expressed_in, joint_frames, plan, parameters }, robot, algorithm)
}

impl Formulation {
    /// Writes a function by one algorithm under a plan, with every value computed once.
    ///
    /// # Errors
    /// When the plan does not fit the robot.
    pub fn by_plan(robot: &Robot, plan: &Plan, function: Function, algorithm: Algorithm) -> Result<Self, CompileError> {
        let sphere = plan.gyrostat && !function.takes(Argument::Payload);
        let plan = &Plan { gyrostat: sphere, ..plan.clone() };
        let written = frame(robot, plan, function).and_then(|frame| frame.written(plan, function, algorithm));
        written.ok_or_else(|| CompileError::PlanDoesNotFit { robot: robot.name.clone() })
    }
}

impl Evaluator {
    pub(crate) fn new(robot: &Robot, function: Function) -> Self {
        let frames = frames(robot, function);
        let embedding = frames.first().map(|frame| frame.joint_frames.embedding).unwrap_or_default();
        Self {
            robot: robot.clone(),
            branches: frames.iter().map(|frame| BaseBranch::of(&frame.joint_frames)).collect(),
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
        let Some(FramedRobot { frames, joint_frames, offers, .. }) = self.frames.first() else {
            return OpenChoices::default();
        };
        let rows = &joint_frames.rows;
        let joints = rows.iter().zip(&offers.origin_shifts).enumerate().map(|(index, (row, shifts))| OpenJoint {
            kind: row.kind,
            is_parallel: is_parallel(rows, index),
            is_twisted: row.alpha.quarters().is_none(),
            origin_shifts: shifts.iter().map(|(rule, _)| *rule).collect(),
            scaled: if frames.floating { Vec::new() } else { branches::scaled(rows, index) },
            alike: Vec::new(),
        });
        let mut joints: Vec<OpenJoint> = joints.collect();
        for (joint, alike) in branches::alike(rows, &joints).into_iter().enumerate() {
            joints[joint].alike = alike;
        }
        OpenChoices {
            joints,
            lengths: offers.lengths.clone(),
            gyrostat: offers.gyrostat,
            turned_last_frame: has(|frames| frames.turned_last),
            carried_prismatics: has(|frames| frames.carried),
            floating_base: frames.floating,
        }
    }

    /// The cost of a plan; `None` if it does not fit the robot.
    pub(crate) fn cost(&mut self, plan: &Plan) -> Option<Cost> {
        let place = self.frames.iter().position(|frame| frame.is_of(plan))?;
        if self.branches[place].is_empty() {
            return self.cost_of(plan, Algorithm::Rnea);
        }
        let parameters = self.frames[place].parameters(plan)?;
        let mut branches = std::mem::take(&mut self.branches[place]);
        let costs = branches.iter_mut().map(|branch| {
            let parameters = branch.parameters(&parameters);
            let scales = [parameters.lambda[0], parameters.mu[0]].map(|scale| scale.residue);
            let key = (branch.plan(plan), scales);
            if let Some(known) = branch.known.get(&key) {
                return *known;
            }
            let cost = self.counted(&branch.joint_frames, &key.0, &parameters, Algorithm::Rnea);
            if branch.known.len() > MOST_KNOWN {
                branch.known.clear();
            }
            branch.known.insert(key, cost);
            cost
        });
        let sum = costs.collect::<Vec<_>>().into_iter().try_fold(Cost::default(), |sum, cost| Some(sum + cost?));
        self.branches[place] = branches;
        sum
    }

    /// The cost of a plan if the function is written by this algorithm.
    pub(crate) fn cost_of(&mut self, plan: &Plan, algorithm: Algorithm) -> Option<Cost> {
        let place = self.frames.iter().position(|frame| frame.is_of(plan))?;
        let parameters = self.frames[place].parameters(plan)?;
        let frames = std::mem::take(&mut self.frames);
        let cost = self.counted(&frames[place].joint_frames, plan, &parameters, algorithm);
        self.frames = frames;
        cost
    }

    fn counted(
        &mut self,
        joint_frames: &JointFrames,
        plan: &Plan,
        parameters: &Parameters,
        algorithm: Algorithm,
    ) -> Option<Cost> {
        let Self { robot, builder, numbered, live, map, .. } = self;
        builder.restart(joint_frames.embedding);
        let outputs = outputs(builder, robot, joint_frames, plan, parameters, algorithm)?;
        let outputs: Vec<Ref> = outputs.into_iter().map(|(_, symbol)| symbol.at).collect();
        let graph = builder.graph.get_mut();
        graph.outputs = outputs;
        number_values(graph, numbered, live, map);
        Some(numbered.cost(live))
    }
}
