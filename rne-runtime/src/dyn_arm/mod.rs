//! The runtime robot with a number of joints known at run time.

mod error;
mod evaluate;
mod load;

pub use error::{LoadError, WrongJointCount, WrongLength};
pub use evaluate::Inputs;

use rne_model::{Contact, Convention, FixedFrame, Joint, Link, Model, Motor, Robot, Row, Transform};

use crate::definition::Definition;
use crate::definition::closed_loops::Loops;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::couplings::{Counted, Couplings};
use crate::definition::floating_base::BASE;
use crate::definition::motors::Motors;
use crate::definition::regressor::{Elements, element};
use crate::seven_steps::at_tip::{AtTip, Tip};
use crate::seven_steps::link_frame::{Chain, LinkFrame, Table};
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::seven_steps::mount::Mount;
use crate::seven_steps::trace::{self, LinkTrace, turn_to_base, turn_to_lecture};
use crate::{BaseMotion, Constant, Payload, Scalar, Wrench};

/// A robot like [`Arm`](crate::Arm), whose number of joints is only known at run time. It computes by the same
/// recursion, with the same bits, and takes slices in place of arrays.
///
/// Functions of closed loops take the positions of the dependent joints, too. The other functions are those of the open
/// tree: their slices have an element for each joint that follows no other by a coupling, in the order of the joints.
///
/// Slices run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, m/s², N.
#[derive(Clone, Debug, PartialEq)]
pub struct DynArm<S = f64> {
    convention: Convention,
    gravity: [S; 3],
    base: Transform<S>,
    tool: Transform<S>,
    rows: Vec<Row<S>>,
    branches: Vec<Option<FixedFrame<S>>>,
    tip_on: Option<usize>,
    pub(crate) floating_base: Option<Link<S>>,
    links: Vec<LinkFrame<S>>,
    tip: Mount<S>,
    motors: Vec<Option<Motor<S>>>,
    rotors: bool,
    pub(crate) couplings: Couplings<S>,
    pub(crate) drives: Motors<S>,
    pub(crate) at: Option<FixedFrame<S>>,
    /// The frames that carry wrenches.
    tips: Vec<FixedFrame<S>>,
    prepared_tips: Vec<Tip<S>>,
    /// The contacts, at tips that something outside the robot holds.
    pub(crate) contacts: Vec<Contact>,
    /// The closed loops.
    pub(crate) closed: Loops<S>,
}

/// The seven steps of one state of a [`DynArm`], in the axes of form P.
#[derive(Clone, Debug, PartialEq)]
pub struct DynTrace<T> {
    /// One entry per link, base to tip.
    pub links: Vec<LinkTrace<T>>,
}

impl DynArm {
    /// The runtime robot of a robot file that has been read, at the frame of [`Robot::at`].
    #[must_use]
    pub fn from_robot(robot: &Robot) -> Self {
        let motors = robot.joints.iter().map(|joint| joint.motor).collect();
        let rows: Vec<Row> = robot.joints.iter().map(Joint::row_with_offset).collect();
        let branches: Vec<_> = robot.joints.iter().map(|joint| joint.branch).collect();
        let (convention, tool, tip_on) = (robot.convention, &robot.tool, robot.tip_on);
        let floating_base = robot.floating_base.as_ref().map(|base| base.link);
        let table = Table { convention, rows: &rows, branches: &branches, tool, tip_on, floating_base };
        let at = robot.at.map(|frame| robot.fixed_frame(frame));
        let (couplings, drives) = (Couplings::of(robot), Motors::of(robot));
        let rotors = robot.rotors;
        let parts = Self::of_table(table, robot.gravity, robot.base, robot.wrench_frames());
        Self {
            motors,
            rotors,
            couplings,
            drives,
            at,
            contacts: robot.contacts.clone(),
            closed: Loops::of(robot),
            ..parts
        }
    }
}

impl<S: Constant> DynArm<S> {
    /// The robot of a plain table, without motors.
    #[must_use]
    pub fn new<const DOF: usize>(model: &Model<DOF, S>) -> Self {
        let Model { convention, gravity, base, tool, rows } = model;
        let convention = *convention;
        let table = Table { convention, rows, branches: &[], tool, tip_on: None, floating_base: None };
        Self::of_table(table, *gravity, *base, vec![table.tip()])
    }

    fn of_table(table: Table<'_, S>, gravity: [S; 3], base: Transform<S>, tips: Vec<FixedFrame<S>>) -> Self {
        let Table { convention, rows, tool, tip_on, floating_base, .. } = table;
        Self {
            convention,
            gravity,
            base,
            tool: *tool,
            rows: rows.to_vec(),
            branches: (0..rows.len()).map(|joint| table.branch(joint).copied()).collect(),
            tip_on,
            floating_base,
            links: (0..rows.len()).map(|index| LinkFrame::new(table, index)).collect(),
            tip: Mount::of_tip(table),
            motors: vec![None; rows.len()],
            rotors: false,
            couplings: Couplings::none(rows.len()),
            drives: Motors::NONE,
            at: None,
            prepared_tips: tips.iter().map(|tip| Tip::new(table, tip)).collect(),
            tips,
            contacts: Vec::new(),
            closed: Loops::none(),
        }
    }

    /// Returns this robot with other motors, base to tip; `None` for a joint without a motor.
    ///
    /// # Errors
    /// When `motors` does not have one element per joint.
    pub fn with_motors(self, motors: Vec<Option<Motor<S>>>) -> Result<Self, WrongLength> {
        let (expected, found) = (self.rows.len(), motors.len());
        if expected == found {
            Ok(Self { motors, ..self })
        } else {
            Err(WrongLength { argument: "motors", expected, found })
        }
    }

    /// Returns the arm with its rotors, as [`Arm::with_rotors`](crate::Arm::with_rotors) does.
    #[must_use]
    pub fn with_rotors(self) -> Self {
        Self { rotors: true, ..self }
    }

    /// Number of coordinates: of all joints that follow no other joint by a coupling. Dependent joints of closed loops
    /// are included, as joints of the open tree.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.couplings.dof()
    }

    /// The table, base to tip.
    #[must_use]
    pub fn rows(&self) -> &[Row<S>] {
        &self.rows
    }

    /// The motors, base to tip. Only [`actuator_torques`](Self::actuator_torques) uses them.
    #[must_use]
    pub fn motors(&self) -> &[Option<Motor<S>>] {
        &self.motors
    }

    /// The convention by which the rows are read.
    #[must_use]
    pub fn convention(&self) -> Convention {
        self.convention
    }

    /// The placement of frame 0 in the world.
    #[must_use]
    pub fn base(&self) -> &Transform<S> {
        &self.base
    }

    /// The placement of the tip frame in frame n.
    #[must_use]
    pub fn tool(&self) -> &Transform<S> {
        &self.tool
    }

    /// The frames at which wrenches act, in the order of arrays of wrenches: those of the list `tips` of the robot
    /// file, or the tip frame alone.
    #[must_use]
    pub fn tips(&self) -> &[FixedFrame<S>] {
        &self.tips
    }

    /// The tips that something outside the robot holds.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// The base at rest under the robot's gravity.
    #[must_use]
    pub fn fixed_base<T: Scalar>(&self) -> BaseMotion<T> {
        BaseMotion::fixed(self.gravity.map(S::to))
    }

    /// Torques on a moving base: `base` replaces the robot's gravity and the base at rest. `wrench` is what the last
    /// link exerts on its environment; `None` is a free tip.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint.
    pub fn inverse_dynamics_on_moving_base_with_wrench<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
        wrench: Option<&Wrench<T>>,
    ) -> Result<Vec<T>, WrongLength> {
        self.have_lengths(&[("q", q), ("qd", qd), ("qdd", qdd)])?;
        Ok(self.definition().torques_on([q, qd, qdd], base, wrench.into()))
    }

    /// Every vector of the seven steps, in the axes of form P. Arguments as in
    /// [`inverse_dynamics_on_moving_base_with_wrench`](Self::inverse_dynamics_on_moving_base_with_wrench).
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint.
    pub fn trace<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
        wrench: Option<&Wrench<T>>,
    ) -> Result<DynTrace<T>, WrongLength> {
        self.traced([q, qd, qdd], base, wrench.into())
    }

    /// Traces the seven steps on a base at rest, with `payload` fixed to the tip.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint.
    pub fn trace_with_payload<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        payload: &Payload<T>,
    ) -> Result<DynTrace<T>, WrongLength> {
        self.traced([q, qd, qdd], &self.fixed_base(), AtTip::Payload(payload))
    }

    fn traced<T: Scalar>(
        &self,
        [q, qd, qdd]: [&[T]; 3],
        base: &BaseMotion<T>,
        tip: AtTip<'_, T>,
    ) -> Result<DynTrace<T>, WrongLength> {
        self.have_lengths(&[("q", q), ("qd", qd), ("qdd", qdd)])?;
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.couplings.of_joints(values));
        let (joints, mechanism) = (JointMotions::new(&q, &qd, &qdd), self.mechanism());
        let (motions, loads) = mechanism.passes(joints, base, tip);
        let mut links = vec![LinkTrace::empty(); self.rows.len()];
        let velocities = mechanism.velocities(joints, base, &motions);
        trace::record(mechanism.chain, joints.q, &velocities, &motions, &loads, &mut links);
        Ok(DynTrace { links })
    }

    /// Whether each list has one element for each coordinate.
    pub(crate) fn have_lengths<T>(&self, lists: &[(&'static str, &[T])]) -> Result<(), WrongLength> {
        lists.iter().try_for_each(|(argument, values)| self.has_length(argument, values))
    }

    /// Whether there is a wrench for each tip.
    pub(crate) fn has_tips<T>(&self, wrenches: &[Wrench<T>]) -> Result<(), WrongLength> {
        let (expected, found) = (self.tips.len(), wrenches.len());
        if expected == found { Ok(()) } else { Err(WrongLength { argument: "wrenches", expected, found }) }
    }

    pub(crate) fn has_length<T>(&self, argument: &'static str, values: &[T]) -> Result<(), WrongLength> {
        if values.len() == self.dof() {
            return Ok(());
        }
        Err(WrongLength { argument, expected: self.dof(), found: values.len() })
    }

    /// This arm with the frame `frame` in the place of the tip; see [`Arm::at_frame`](crate::Arm::at_frame).
    ///
    /// `None` when `frame` is on a link that the arm does not have.
    #[must_use]
    pub fn at_frame(mut self, frame: FixedFrame<S>) -> Option<Self> {
        self.at = Some(frame);
        frame.on.is_none_or(|link| link < self.rows().len()).then_some(self)
    }

    /// As [`FloatingRegressor::floating_regressor`](crate::FloatingRegressor::floating_regressor): 6 + n rows, the base
    /// and the links, parameter.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn floating_regressor<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
    ) -> Result<Vec<Vec<Elements<T>>>, crate::WrongLength> {
        self.have_lengths(&[("q", q), ("qd", qd), ("qdd", qdd)])?;
        let (of_base, of_joints) = self.definition().regressor([q, qd, qdd], base);
        let row = |row| (0..=self.rows().len()).map(|body| element(&of_base, &of_joints, row, body)).collect();
        Ok((0..BASE + self.dof()).map(row).collect())
    }

    pub(crate) fn mechanism(&self) -> Mechanism<'_, Counted, S> {
        let Self {
            convention,
            gravity,
            base,
            tool,
            rows,
            branches,
            tip_on,
            floating_base,
            links,
            tip,
            motors,
            rotors,
            drives,
            at,
            tips: frames,
            prepared_tips,
            ..
        } = self;
        let (convention, tip_on, floating_base) = (*convention, *tip_on, *floating_base);
        let table = Table { convention, rows, branches, tool, tip_on, floating_base };
        let (tip_link, spins) = (table.tip().on, drives.spins());
        let chain = Chain { links, tip, tip_link, tips: prepared_tips, spins, floating_base };
        let (per_joint, rotors, at) = (Counted(rows.len()), *rotors, at.as_ref());
        Mechanism { per_joint, chain, table, frames, motors, rotors, gravity, base, at }
    }

    pub(crate) fn definition(&self) -> Definition<'_, Counted, Counted, Counted, S> {
        let [velocities, tips] = [BASE + self.dof(), self.tips.len()].map(Counted);
        let (mechanism, coordinates) = (self.mechanism(), &self.couplings);
        Definition { mechanism, coordinates, velocities, tips, contacts: &self.contacts }
    }
}

impl DynArm<f64> {
    /// Returns this robot with its constants in single precision: each number of the table rounded once, then prepared
    /// in single precision, as [`Model::to_f32`] does it.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    pub fn to_f32(&self) -> DynArm<f32> {
        let rows: Vec<_> = self.rows.iter().map(|row| row.to_f32()).collect();
        let branches: Vec<_> = self.branches.iter().map(|branch| branch.map(FixedFrame::to_f32)).collect();
        let motors = self.motors.iter().map(|motor| motor.map(Motor::to_f32)).collect();
        let (convention, tool, tip_on) = (self.convention, &self.tool.to_f32(), self.tip_on);
        let (rotors, couplings, at) = (self.rotors, self.couplings.to_f32(), self.at.map(FixedFrame::to_f32));
        let floating_base = self.floating_base.map(Link::to_f32);
        let tips = self.tips.iter().map(|tip| tip.to_f32()).collect();
        let table = Table { convention, rows: &rows, branches: &branches, tool, tip_on, floating_base };
        DynArm {
            motors,
            rotors,
            couplings,
            drives: self.drives.to_f32(),
            at,
            contacts: self.contacts.clone(),
            closed: self.closed.to_f32(),
            ..DynArm::of_table(table, self.gravity.map(|x| x as f32), self.base.to_f32(), tips)
        }
    }
}

impl<T: Scalar> DynTrace<T> {
    /// The actuators' torques and forces, τ.
    #[must_use]
    pub fn tau(&self) -> Vec<T> {
        self.links.iter().map(|link| link.tau).collect()
    }

    /// Returns the vectors in the lecture's axes, as [`Trace::to_lecture`](crate::Trace::to_lecture) does.
    #[must_use]
    pub fn to_lecture(&self) -> Vec<LinkTrace<T>> {
        let mut links = self.links.clone();
        turn_to_lecture(&mut links);
        links
    }

    /// Returns the vectors in the axes of the base, as [`Trace::to_base`](crate::Trace::to_base) does.
    #[must_use]
    pub fn to_base(&self) -> Vec<LinkTrace<T>> {
        let mut links = self.links.clone();
        turn_to_base(&mut links);
        links
    }
}
