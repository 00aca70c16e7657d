//! Terms by which revolute and prismatic joints differ in the seven steps.
//!
//! A joint lets its link move along or about its axis, e = (0, 0, 1) in form P. Each function takes the part of a
//! step that both kinds of joint have, and adds the term that only its kind has. A revolute joint turns its
//! link about e by q, which changes the motion of the link's points only through ω and ω̇. The link of a prismatic
//! joint slides along e by q and turns as its parent does.

use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::QuarterTurns;

use crate::formulate::arm::turned;
use crate::formulate::{Arm, Link};
use crate::ir::{Axis, Builder, Cause, JointLines, Matrix, Name, Quantity, Symbol, Vector, by_quarters};

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
    /// Index of the joint, counted from 0.
    pub(crate) index: usize,
    pub(crate) link: &'a Link<'s>,
    pub(crate) state: JointState<'s>,
    pub(crate) lines: JointLines<'s>,
    /// Joint axis e_i = (0, 0, 1) in frame i.
    pub(crate) e: Vector<'s>,
}

impl<'s> Arm<'s> {
    /// Returns the joints with the given states, parents first.
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
    /// Returns the lines at this joint for quantities that have the number of the parent in their names.
    pub(crate) fn lines_of_parent(&self) -> JointLines<'s> {
        self.lines.named(self.link.parent.map_or(0, |parent| parent + 1))
    }

    /// Returns R_i: the rotation of the joint's mount, then Rz(θ_i).
    pub(crate) fn rotation(&self) -> Matrix<'s> {
        let about_z = self.turn();
        self.lines.define(Quantity::Rotation).by(self.link.mount.rotation * about_z)
    }

    /// Returns Rz(θ_i).
    pub(crate) fn turn(&self) -> Matrix<'s> {
        turned(self.lines.builder, Axis::Z, self.sine_and_cosine(), Cause::TurnAboutZ)
    }

    /// Returns the sine and cosine of the constant part of θ.
    fn constant_turn(&self) -> (Symbol<'s>, Symbol<'s>) {
        let fixed = || self.lines.builder.constant_turn(&self.link.theta, Cause::Arithmetic).into();
        let [s, c] = self.link.varying_turn.unwrap_or_else(fixed);
        (self.lines.name(Quantity::ThetaSine, s), self.lines.name(Quantity::ThetaCosine, c))
    }
}

/// Terms of the seven steps that depend on the kind of the joint.
impl<'s> Joint<'_, 's> {
    /// Returns the sine and cosine of θ_i: of θ + q, or of the constant θ of a prismatic joint. If θ is a multiple of a
    /// right angle, they are ± sin q and ± cos q, without rounding; otherwise they are those of the sum.
    fn sine_and_cosine(&self) -> (Symbol<'s>, Symbol<'s>) {
        let (line, theta) = (self.lines, self.link.theta);
        match (self.link.kind, self.state.turn, theta.right) {
            (Prismatic, ..) => self.constant_turn(),
            (Revolute, Some(turn), Some(turns)) => by_quarters(turn, turns),
            // by the addition theorem, because sin q and cos q are arguments
            (Revolute, Some((s, c)), None) => {
                let (sin, cos) = self.constant_turn();
                (
                    line.define(Quantity::TurnedSine).by(s * cos + c * sin),
                    line.define(Quantity::TurnedCosine).by(c * cos - s * sin),
                )
            }
            (Revolute, None, right) => {
                let q = self.state.q;
                let angle =
                    if right.is_some() { q } else { line.define(Quantity::Angle).by(line.constant_angle(&theta) + q) };
                let (s, c) = line.builder.sine_and_cosine(angle);
                let turn = (line.name(Quantity::Sine, s), line.name(Quantity::Cosine, c));
                by_quarters(turn, right.unwrap_or(QuarterTurns::Zero))
            }
        }
    }

    /// Returns the offset of the link with its joint variable: (a, 0, b), or (a, 0, b + q) for a prismatic joint.
    pub(crate) fn offset(&self, offset: Vector<'s>) -> Vector<'s> {
        match self.link.kind {
            Revolute => offset,
            Prismatic => offset.plus_z(self.state.q),
        }
    }

    /// Returns d_i, the vector from J_i to C_i: a constant, unless the joint is prismatic.
    pub(crate) fn centre(&self) -> Vector<'s> {
        let d = || self.offset(self.link.offset) + self.link.body.com;
        match self.link.kind {
            Revolute => self.lines.name_vector(Quantity::D, d()),
            Prismatic => self.lines.define(Quantity::D).by(d()),
        }
    }

    /// Step 1: returns ω of the link, given that of its parent.
    pub(crate) fn angular_velocity(&self, common: Vector<'s>) -> Vector<'s> {
        match self.link.kind {
            Revolute => common + self.e * self.state.qd,
            Prismatic => common,
        }
    }

    /// Step 2: returns ω̇ of the link, given that of its parent and the link's ω.
    pub(crate) fn angular_acceleration(&self, common: Vector<'s>, omega: Vector<'s>) -> Vector<'s> {
        match self.link.kind {
            Revolute => common + self.e * self.state.qdd + omega.cross(self.e) * self.state.qd,
            Prismatic => common,
        }
    }

    /// Step 3: returns the velocity of a point of the link.
    pub(crate) fn velocity(&self, common: Vector<'s>) -> Vector<'s> {
        match self.link.kind {
            Revolute => common,
            Prismatic => common + self.e * self.state.qd,
        }
    }

    /// Step 4: returns the acceleration of a point of the link.
    pub(crate) fn acceleration(&self, common: Vector<'s>, omega: Vector<'s>) -> Vector<'s> {
        match self.link.kind {
            Revolute => common,
            Prismatic => self.unaccelerated(common + self.e * self.state.qdd, omega),
        }
    }

    /// Step 4 for a joint that does not accelerate (q̈ = 0).
    pub(crate) fn unaccelerated(&self, common: Vector<'s>, omega: Vector<'s>) -> Vector<'s> {
        match self.link.kind {
            Revolute => common,
            Prismatic => {
                let two = || self.lines.builder.entry(Name::scalar(Quantity::Two, 0), 2.0);
                let twice_rate = || self.lines.define(Quantity::TwiceRate).by(two() * self.state.qd);
                common + omega.cross(self.e) * twice_rate()
            }
        }
    }

    /// Step 7: returns the component of the joint's wrench that the actuator delivers.
    pub(crate) fn actuator(&self, wrench: &Wrench<'s>) -> Symbol<'s> {
        match self.link.kind {
            Revolute => wrench.moment.z(),
            Prismatic => wrench.force.z(),
        }
    }
}

/// Returns e, the joint's axis in its frame.
fn axis(builder: &Builder) -> Vector<'_> {
    Vector([0.0, 0.0, 1.0].map(|value| builder.constant(value, Cause::JointAxis)))
}
