//! Terms that each kind of joint adds to the seven steps: one file per kind.
//!
//! A joint lets its link move along or about its axis, e = (0, 0, 1) in form P. Every law takes what the link would
//! have if the joint were rigid and returns what it has.

mod prismatic;
mod revolute;

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::arm::{Arm, Link, turned};
use crate::ir::{Axis, Builder, Cause, JointLines, Matrix, Quantity, Symbol, Vector};

/// A force and a moment.
#[derive(Clone, Copy)]
pub(crate) struct Wrench<'s> {
    pub(crate) force: Vector<'s>,
    pub(crate) moment: Vector<'s>,
}

/// Position, rate and acceleration of one joint.
#[derive(Clone, Copy)]
pub(crate) struct JointState<'s> {
    pub(crate) q: Symbol<'s>,
    pub(crate) qd: Symbol<'s>,
    pub(crate) qdd: Symbol<'s>,
    /// Sine and cosine of q, if they are arguments.
    pub(crate) turn: Option<(Symbol<'s>, Symbol<'s>)>,
}

/// Joint i with the link that it moves.
#[derive(Clone, Copy)]
pub(crate) struct Joint<'a, 's> {
    /// Counted from 0.
    pub(crate) index: usize,
    pub(crate) link: &'a Link<'s>,
    pub(crate) state: JointState<'s>,
    pub(crate) lines: JointLines<'s>,
    /// e_i
    pub(crate) e: Vector<'s>,
}

impl<'s> Arm<'s> {
    /// The joints in these states, parents first.
    pub(crate) fn joints<'a>(
        &'a self,
        states: &'a [JointState<'s>],
    ) -> impl DoubleEndedIterator<Item = Joint<'a, 's>> + ExactSizeIterator {
        let (builder, e) = (self.builder, axis(self.builder));
        let joints = self.links.iter().zip(states).enumerate();
        joints.map(move |(index, (link, &state))| Joint { index, link, state, lines: builder.joint(index + 1), e })
    }
}

impl<'s> Joint<'_, 's> {
    /// The lines at this joint, for quantities that bear the number of its parent.
    pub(crate) fn lines_of_parent(&self) -> JointLines<'s> {
        self.lines.named(self.link.parent.map_or(0, |parent| parent + 1))
    }

    /// R_i: how the joint is mounted, then Rz(θ_i).
    pub(crate) fn rotation(&self) -> Matrix<'s> {
        let about_z = turned(self.lines.builder, Axis::Z, self.sine_and_cosine(), Cause::TurnAboutZ);
        self.lines.matrix(Quantity::Rotation, || self.link.mount.rotation * about_z)
    }

    /// Sine and cosine of the constant θ.
    fn constant_turn(&self) -> (Symbol<'s>, Symbol<'s>) {
        let fixed = || self.lines.builder.constant_turn(&self.link.theta, Cause::Arithmetic).into();
        let [s, c] = self.link.varying_turn.unwrap_or_else(fixed);
        (self.lines.name(Quantity::ThetaSine, s), self.lines.name(Quantity::ThetaCosine, c))
    }
}

/// Every law by the kind of the joint.
macro_rules! by_kind {
    ($($(#[$doc:meta])* fn $law:ident(self $(, $argument:ident: $type:ty)*) -> $result:ty;)*) => {
        impl<'s> Joint<'_, 's> {
            $($(#[$doc])* pub(crate) fn $law(&self $(, $argument: $type)*) -> $result {
                match self.link.kind {
                    Revolute => revolute::$law(self $(, $argument)*),
                    Prismatic => prismatic::$law(self $(, $argument)*),
                }
            })*
        }
    };
}

by_kind! {
    /// Sine and cosine of θ_i.
    fn sine_and_cosine(self) -> (Symbol<'s>, Symbol<'s>);
    /// Where the offset (a, 0, b) of the link leads.
    fn offset(self, offset: Vector<'s>) -> Vector<'s>;
    /// d_i: J_i → C_i.
    fn centre_of_mass(self) -> Vector<'s>;
    /// Step 1: ω of the link, from that of its parent.
    fn angular_velocity(self, rigid: Vector<'s>) -> Vector<'s>;
    /// Step 2: ω̇ of the link, from that of its parent and the link's ω.
    fn angular_acceleration(self, rigid: Vector<'s>, omega: Vector<'s>) -> Vector<'s>;
    /// Step 3: velocity of a point of the link.
    fn velocity(self, rigid: Vector<'s>) -> Vector<'s>;
    /// Step 4: acceleration of a point of the link.
    fn acceleration(self, rigid: Vector<'s>, omega: Vector<'s>) -> Vector<'s>;
    /// Step 4 where the joint does not accelerate.
    fn unaccelerated(self, rigid: Vector<'s>, omega: Vector<'s>) -> Vector<'s>;
    /// Step 7: what the actuator delivers of the joint's wrench.
    fn actuator(self, wrench: &Wrench<'s>) -> Symbol<'s>;
}

/// e, the joint's axis in its frame.
fn axis(builder: &Builder) -> Vector<'_> {
    Vector([0.0, 0.0, 1.0].map(|value| builder.constant(value, Cause::JointAxis)))
}
