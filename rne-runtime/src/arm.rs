//! The runtime robot with a number of joints known at compile time.

use core::array;
use core::marker::PhantomData;

use rne_model::{Contact, ContactKind, FixedFrame, Link, Model, Motor};

use crate::definition::Definition;
use crate::definition::coordinates::Joints;
use crate::definition::floating_base::BASE;
use crate::definition::per_joint::Known;
use crate::seven_steps::at_tip::Tip;
use crate::seven_steps::link_frame::{Chain, LinkFrame, Table};
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::seven_steps::mount::Mount;
use crate::seven_steps::spin::Spins;
use crate::seven_steps::trace::{self, LinkTrace, Trace};
use crate::{BaseMotion, Constant, Scalar, Wrench};

/// A robot at run time: the seven steps as loops over links. It answers every question that generated code answers, and
/// is what generated code is tested against. In `f64`, without fused multiply-add, the seven steps give the same bits
/// for torques, mass matrix, forward dynamics, kinetic energy, derivatives and joint wrenches; positions, Jacobians,
/// potential energy, the Coriolis matrix and the regressor sum in another order and agree to rounding.
///
/// `S` is the scalar in which the constants are stored and prepared; the computations run in any [`Scalar`].
/// Computations in `f32` with constants in `f64` differ from generated code in their last bits.
///
/// The one-link example of lecture 38, a uniform rod that hangs along x:
///
/// ```
/// # #[cfg(feature = "std")] {
/// use rne_runtime::{Arm, InverseDynamics};
///
/// let rod = "
/// format: 1
/// name: rod
/// source: lecture 38, one-link example
/// convention: standard
/// gravity: [9.81, 0, 0]
/// joints:
///   - type: revolute
///     dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
///     link: {mass: 2.5, com: [-0.4, 0, 0], inertia: {yy: 2.5*0.8^2/12, zz: 2.5*0.8^2/12}}
/// ";
/// let arm = Arm::<1>::from_yaml(rod)?;
/// let [tau] = arm.inverse_dynamics(&[0.6], &[1.3], &[-0.7]);
/// assert!((tau - (2.5 * 0.8 * 0.8 * -0.7 / 3.0 + 2.5 * 9.81 * 0.4 * 0.6_f64.sin())).abs() < 1e-14);
///
/// // Every vector of the seven steps, here in the lecture's axes.
/// let trace = arm.trace(&[0.6], &[1.3], &[-0.7], &arm.fixed_base(), None);
/// assert_eq!(trace.to_lecture()[0].omega, [0.0, 0.0, 1.3]);
/// # }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Arm<const DOF: usize, S = f64> {
    model: Model<DOF, S>,
    branches: [Option<FixedFrame<S>>; DOF],
    tip_on: Option<usize>,
    links: [LinkFrame<S>; DOF],
    tip: Mount<S>,
    motors: [Option<Motor<S>>; DOF],
    rotors: bool,
    pub(crate) at: Option<FixedFrame<S>>,
    floating_base: Option<Link<S>>,
}

impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// The robot of a plain table, without motors. Needs neither `std` nor an allocator.
    #[must_use]
    pub fn new(model: Model<DOF, S>) -> Self {
        Self::prepared(model, [None; DOF], None, None)
    }

    pub(crate) fn prepared(
        model: Model<DOF, S>,
        branches: [Option<FixedFrame<S>>; DOF],
        tip_on: Option<usize>,
        floating_base: Option<Link<S>>,
    ) -> Self {
        let table = Table { floating_base, ..table_of(&model, &branches, tip_on) };
        let (links, tip) = (array::from_fn(|index| LinkFrame::new(table, index)), Mount::of_tip(table));
        Self { model, branches, tip_on, links, tip, motors: [None; DOF], rotors: false, at: None, floating_base }
    }

    /// Returns this robot as a tree. Row `i` begins at the frame `branches[i]` on an earlier link or on the base;
    /// `None` for a row that begins at the link frame of the row before. The tip is on the link of the joint `tip_on`;
    /// `None` for the last one. Returns `None` if a row comes before its parent, or if there is no joint `tip_on`.
    #[must_use]
    pub fn on_tree(self, branches: [Option<FixedFrame<S>>; DOF], tip_on: Option<usize>) -> Option<Self> {
        let is_earlier = |(joint, branch): (usize, &Option<FixedFrame<S>>)| {
            branch.and_then(|branch| branch.on).is_none_or(|parent| parent < joint)
        };
        let is_tree = branches.iter().enumerate().all(is_earlier) && tip_on.is_none_or(|joint| joint < DOF);
        let Self { model, motors, rotors, at, floating_base, .. } = self;
        is_tree.then(|| Self { motors, rotors, at, ..Self::prepared(model, branches, tip_on, floating_base) })
    }

    /// Returns this robot on a floating base: `link` is the base, with its centre of mass and inertia in frame 0.
    /// Functions of a fixed base compute the robot with this link fixed.
    #[must_use]
    pub fn with_floating_base(self, link: Link<S>) -> Self {
        let Self { model, branches, tip_on, motors, rotors, at, .. } = self;
        Self { motors, rotors, at, ..Self::prepared(model, branches, tip_on, Some(link)) }
    }

    /// Returns this robot with other motors, base to tip; `None` for a joint without a motor.
    #[must_use]
    pub const fn with_motors(mut self, motors: [Option<Motor<S>>; DOF]) -> Self {
        self.motors = motors;
        self
    }

    /// The arm with its rotors, as `Robot::with_rotors` of a robot file has it: G² Jm q̈ is part of its torques, its
    /// mass matrix and its kinetic energy, and friction alone is left to [`Actuation`](crate::Actuation).
    #[must_use]
    pub const fn with_rotors(mut self) -> Self {
        self.rotors = true;
        self
    }

    /// The motors, base to tip. Only [`Actuation`](crate::Actuation) uses them, unless the arm is used [with its
    /// rotors](Self::with_rotors).
    #[must_use]
    pub const fn motors(&self) -> &[Option<Motor<S>>; DOF] {
        &self.motors
    }

    /// The table this robot was made from.
    #[must_use]
    pub fn model(&self) -> &Model<DOF, S> {
        &self.model
    }

    /// The base at rest under the model's gravity.
    #[must_use]
    pub fn fixed_base<T: Scalar>(&self) -> BaseMotion<T> {
        BaseMotion::fixed(self.model.gravity.map(S::to))
    }

    /// Torques on a moving base: `base` replaces the model's gravity and the base at rest. `wrench` is what the last
    /// link exerts on its environment; `None` is a free tip.
    ///
    /// Joint arrays as in [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics).
    #[must_use]
    pub fn inverse_dynamics_on_moving_base_with_wrench<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        wrench: Option<&Wrench<T>>,
    ) -> [T; DOF] {
        self.definition().torques_on([q, qd, qdd], base, wrench.into())
    }

    /// Every vector of the seven steps, in the axes of form P. Arguments as in
    /// [`inverse_dynamics_on_moving_base_with_wrench`](Self::inverse_dynamics_on_moving_base_with_wrench);
    /// [`fixed_base`](Self::fixed_base) is the `base` of an arm that does not move.
    #[must_use]
    pub fn trace<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        wrench: Option<&Wrench<T>>,
    ) -> Trace<DOF, T> {
        let mut links = [LinkTrace::empty(); DOF];
        let joints = JointMotions::new(q, qd, qdd);
        let (motions, loads) = self.mechanism().passes(joints, base, wrench.into());
        let velocities = self.mechanism().velocities(joints, base, &motions);
        trace::record(self.mechanism().chain, joints.q, &velocities, &motions, &loads, &mut links);
        Trace { links }
    }

    pub(crate) fn mechanism(&self) -> Mechanism<'_, Known<DOF>, S> {
        let floating_base = self.floating_base;
        let table = Table { floating_base, ..table_of(&self.model, &self.branches, self.tip_on) };
        let (links, tip, tip_link, spins) = (&self.links, &self.tip, table.tip().on, Spins::NONE);
        let chain = Chain { links, tip, tip_link, tips: &[], spins, floating_base };
        let (motors, rotors, at) = (&self.motors, self.rotors, self.at.as_ref());
        let Model { gravity, base, .. } = &self.model;
        Mechanism { per_joint: Known, chain, table, frames: &[], motors, rotors, gravity, base, at }
    }

    pub(crate) fn definition(&self) -> Definition<'_, Known<DOF>, Known<0>, Known<0>, S> {
        let mechanism = self.mechanism();
        Definition { mechanism, coordinates: Joints(PhantomData), velocities: Known, tips: Known, contacts: &[] }
    }

    /// This arm with its named tips, for the functions that take wrenches at tips and for those of a floating base;
    /// `NV` is `DOF` + 6. A tip on a link that the arm does not have is on the base, and carries no load.
    #[must_use]
    pub fn with_tips<const NV: usize, const TIPS: usize>(
        &self,
        tips: &[FixedFrame<S>; TIPS],
    ) -> ArmWithTips<'_, DOF, NV, TIPS, S> {
        const { assert!(NV == DOF + BASE, "there is a velocity for each joint, and there are six for the base") };
        let table = self.mechanism().table;
        let on_a_link = |tip: &FixedFrame<S>| FixedFrame { on: tip.on.filter(|on| *on < DOF), ..*tip };
        let frames = tips.each_ref().map(on_a_link);
        let tips = frames.each_ref().map(|tip| Tip::new(table, tip));
        ArmWithTips { arm: self, frames, tips, contacts: [Contact { tip: TIPS, kind: ContactKind::Point }; TIPS] }
    }
}

/// An arm with its named tips, and with contacts at those tips that something outside the robot holds.
#[derive(Clone, Debug)]
pub struct ArmWithTips<'a, const DOF: usize, const NV: usize, const TIPS: usize, S = f64> {
    arm: &'a Arm<DOF, S>,
    frames: [FixedFrame<S>; TIPS],
    tips: [Tip<S>; TIPS],
    /// The contacts at held tips, first in the list. Entries for a tip that does not exist hold nothing.
    contacts: [Contact; TIPS],
}

impl<const DOF: usize, const NV: usize, const TIPS: usize, S: Constant> ArmWithTips<'_, DOF, NV, TIPS, S> {
    /// This arm while something outside the robot holds some of its tips; `None` is a free tip.
    #[must_use]
    pub fn in_contact(mut self, held: &[Option<ContactKind>; TIPS]) -> Self {
        let contacts = held.iter().enumerate().filter_map(|(tip, kind)| Some(Contact { tip, kind: (*kind)? }));
        for (place, contact) in self.contacts.iter_mut().zip(contacts) {
            *place = contact;
        }
        self
    }

    pub(crate) fn definition(&self) -> Definition<'_, Known<DOF>, Known<NV>, Known<TIPS>, S> {
        let mechanism = self.arm.mechanism();
        let chain = Chain { tips: &self.tips, ..mechanism.chain };
        let held = self.contacts.iter().take_while(|contact| contact.tip < TIPS).count();
        let mechanism = Mechanism { chain, frames: &self.frames, ..mechanism };
        Definition {
            mechanism,
            coordinates: Joints(PhantomData),
            velocities: Known,
            tips: Known,
            contacts: &self.contacts[..held],
        }
    }
}

fn table_of<'a, const DOF: usize, S>(
    model: &'a Model<DOF, S>,
    branches: &'a [Option<FixedFrame<S>>; DOF],
    tip_on: Option<usize>,
) -> Table<'a, S> {
    let Model { convention, rows, tool, .. } = model;
    Table { convention: *convention, rows, branches, tool, tip_on, floating_base: None }
}
