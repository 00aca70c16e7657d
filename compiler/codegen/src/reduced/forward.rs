//! The outward pass of the Newton-Euler recursion, base to tip: the motion of each link (the reduced form, sections 3
//! and 5).
//!
//! ```text
//! ω_i = R_iᵀ ω_{i-1} + q̇ z     ω̇_i = R_iᵀ ω̇_{i-1} + q̇ (ω_y, -ω_x, 0) + q̈ z     a_i = R_iᵀ (a_{i-1} + U_{i-1} p_i)
//! U = [ω̇]× + [ω]×[ω]×              acceleration of the point r of a link: a + U r;       a_0 = -g
//! ```
//!
//! R_i = Rx(α) Rz(θ) is done in two steps. Between them is frame N, which is on the axis but does not turn with the
//! joint; all joints of a group of parallel axes share one N.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::base_rotation;
use crate::function::{Argument, What};
use crate::ir::{Axis, Builder, ExactAngle, Matrix, Moving, Name, Number, Quantity, Symbol, Vector};
use crate::reduced::inward::ExpressedIn;
use crate::reduced::regrouping::{group_start, is_parallel};
use crate::reduced::siblings::point_acceleration;
use crate::reduced::{JointFrame, JointFrames, JointPlan, Parameters, Plan, Side, SymbolicTurn, Turned};

/// The matrix U = [ω̇]× + [ω]×[ω]×, with the differences of its diagonal elements.
#[derive(Clone, Copy)]
pub(crate) struct Gradient<'s> {
    pub(crate) u: [[Symbol<'s>; 3]; 3],
    /// Differences of the diagonal elements: U33 - U22, U11 - U33, U22 - U11.
    pub(crate) differences: [Symbol<'s>; 3],
}

impl<'s> Gradient<'s> {
    pub(crate) fn new(omega: Vector<'s>, omega_dot: Vector<'s>) -> Self {
        let ([x, y, z], [dx, dy, dz]) = (omega.0, omega_dot.0);
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let (xy, xz, yz) = (x * y, x * z, y * z);
        Self {
            u: [[-(yy + zz), xy - dz, xz + dy], [xy + dz, -(xx + zz), yz - dx], [xz - dy, yz + dx, -(xx + yy)]],
            differences: [zz - yy, xx - zz, yy - xx],
        }
    }

    /// Returns U if U z is already known, from it, ω and ω̇_z (section 5.3).
    fn with_axis_column(omega: Vector<'s>, omega_dot_z: Symbol<'s>, column: Vector<'s>) -> Self {
        let ([x, y, z], [u13, u23, u33]) = (omega.0, column.0);
        let (xx, zz, xy, xz, yz) = (x * x, z * z, x * y, x * z, y * z);
        let (dx, dy) = (yz - u23, u13 - xz);
        let (u22, middle) = (-(xx + zz), xx - zz);
        let u11 = middle + u33;
        Self {
            u: [[u11, xy - omega_dot_z, u13], [xy + omega_dot_z, u22, u23], [xz - dy, yz + dx, u33]],
            differences: [u33 - u22, middle, u22 - u11],
        }
    }

    /// Returns U v.
    pub(crate) fn of(&self, v: Vector<'s>) -> Vector<'s> {
        Vector([0, 1, 2].map(|row| Vector(self.u[row]).dot(v)))
    }

    /// Returns U z.
    fn column_z(&self) -> Vector<'s> {
        Vector([0, 1, 2].map(|row| self.u[row][2]))
    }
}

/// The motion of a link in one frame.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'s> {
    pub(crate) omega: Vector<'s>,
    pub(crate) omega_dot: Vector<'s>,
    /// Acceleration of the frame's origin, less gravity, times λ.
    pub(crate) acceleration: Vector<'s>,
    pub(crate) gradient: Gradient<'s>,
}

/// The motion of a link, with all that the inward pass needs.
#[derive(Clone, Copy)]
pub(crate) struct Moved<'s> {
    /// Motion in the link's frame.
    pub(crate) own: Motion<'s>,
    /// Motion in frame N (not turned by the joint) on the joint's axis.
    pub(crate) unturned: Motion<'s>,
    pub(crate) twist: Twist<'s>,
    /// Rotation from the frame of the link to frame N of its group.
    pub(crate) group_turn: SymbolicTurn<'s>,
    /// Rotation about z by the angle of this joint alone, from the frame of the link.
    pub(crate) turn: SymbolicTurn<'s>,
    /// The motion that the group of parallel axes shares, up to this joint; `None` for a prismatic joint.
    group: Option<Group<'s>>,
}

/// The rotation Rz(γ) Rx(α) from frame N of a joint to the axes of its parent.
#[derive(Clone, Copy)]
pub(crate) struct Twist<'s> {
    gamma: Option<SymbolicTurn<'s>>,
    pub(crate) alpha: SymbolicTurn<'s>,
}

impl<'s> Twist<'s> {
    pub(crate) fn new(builder: &'s Builder, row: &JointFrame) -> Self {
        let gamma = (row.gamma != ExactAngle::NONE).then(|| builder.fixed_turn(row.gamma));
        Self { gamma, alpha: builder.fixed_turn(row.alpha) }
    }

    /// Returns Rz(γ) v.
    pub(crate) fn about_parent(self, v: Vector<'s>) -> Vector<'s> {
        self.gamma.map_or(v, |turn| turn.about_z(v))
    }

    /// Returns Rz(γ)ᵀ v.
    fn back_about_parent(self, v: Vector<'s>) -> Vector<'s> {
        self.gamma.map_or(v, |turn| turn.back_about_z(v))
    }

    /// Returns Rz(γ) Rx(α) v.
    pub(crate) fn of(self, v: Vector<'s>) -> Vector<'s> {
        self.about_parent(self.alpha.about_x(v))
    }

    /// Returns both rotations in the order in which they are applied.
    pub(crate) fn turns(self) -> impl Iterator<Item = Turned<'s>> {
        [Some(Turned::AboutX(self.alpha)), self.gamma.map(Turned::AboutZ)].into_iter().flatten()
    }

    /// Returns (Rz(γ) Rx(α))ᵀ v.
    pub(crate) fn back(self, v: Vector<'s>) -> Vector<'s> {
        self.alpha.back_about_x(self.back_about_parent(v))
    }
}

/// A group of parallel axes: the motion of the link before the group, in frame N (not turned by the joint), and the
/// summed rates of the group.
#[derive(Clone, Copy)]
struct Group<'s> {
    omega: Vector<'s>,
    omega_dot: Vector<'s>,
    /// U z of the first axis of the group, in N.
    column: Vector<'s>,
    rate: Symbol<'s>,
    rate_dot: Symbol<'s>,
}

/// The robot under a plan, with all that the formulas need.
#[derive(Clone, Copy)]
pub(crate) struct Arm<'a, 's> {
    pub(crate) builder: &'s Builder,
    /// The frames in which algorithms with composite or articulated bodies express these bodies.
    pub(crate) expressed_in: ExpressedIn,
    pub(crate) joint_frames: &'a JointFrames,
    pub(crate) plan: &'a Plan,
    pub(crate) parameters: &'a Parameters,
}

impl<'a> Arm<'a, '_> {
    pub(crate) fn rows(&self) -> &'a [JointFrame] {
        &self.joint_frames.rows
    }

    /// Returns two lengths, both times `scale`: the vector from the origin of the parent's frame to axis i, in the axes
    /// of the parent, and the offset d along axis i. Both include the shifts of the origins along their axes.
    pub(crate) fn lengths(&self, index: usize, scale: Number) -> ([Number; 3], Number) {
        let row = &self.rows()[index];
        let [x, y, z] = row.offset;
        let origin_shifts = &self.parameters.origin_shifts;
        let before = row.parent.map_or(Number::ZERO, |parent| origin_shifts[parent]);
        let is_held = self.joint_frames.carrier(index).is_none();
        let d = if is_held { Number::ZERO } else { row.d + origin_shifts[index] };
        ([x, y, z - before].map(|length| length * scale), d * scale)
    }

    /// Returns the point of the parent, in the parent's axes, whose acceleration is passed to a joint; times λ.
    pub(crate) fn outward_point(&self, index: usize) -> [Number; 3] {
        let (offset, d) = self.lengths(index, self.parameters.lambda[index]);
        let row = &self.rows()[index];
        let is_whole = row.kind == Revolute && self.plan.joints[index].outward_offset == Side::Parent;
        if is_whole { plus(offset, row.along_axis(d)) } else { offset }
    }

    /// Whether this is the last link, and the plan takes it as a spinning sphere (section 5.6).
    pub(crate) fn is_spin(&self, index: usize) -> bool {
        self.parameters.sphere.is_some() && index + 1 == self.rows().len()
    }
}

pub(crate) fn plus(a: [Number; 3], b: [Number; 3]) -> [Number; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns the motion of a floating base, in frame 0, from the arguments of the function.
pub(crate) fn motion_of_base<'s>(arm: &Arm<'_, 's>) -> Motion<'s> {
    let builder = arm.builder;
    if builder.moving.get() == Moving::RatesForAccelerations {
        return twist_of_base(arm);
    }
    let [omega, omega_dot] = [Quantity::Omega, Quantity::OmegaDot].map(|quantity| of_base(builder, quantity));
    builder.at(Quantity::OriginAcceleration, 0);
    let lambda = arm.parameters.lambda.first().copied().unwrap_or(Number::ONE);
    let acceleration = acceleration_of_base(arm).times(lambda);
    let acceleration = builder.name_vector(Quantity::OriginAcceleration, 0, acceleration);
    builder.at(Quantity::Gradient, 0);
    let gradient = Gradient::new(omega, omega_dot);
    builder.name_matrix(Quantity::Gradient, 0, Matrix::from_rows(gradient.u));
    Motion { omega, omega_dot, acceleration, gradient }
}

/// Returns the acceleration of the origin of frame 0, less gravity.
pub(crate) fn acceleration_of_base<'s>(arm: &Arm<'_, 's>) -> Vector<'s> {
    if arm.builder.function.what() == What::GravityTorques {
        return base_rotation(arm.builder).transpose()
            * arm.builder.vector(arm.joint_frames.gravity_in_world.map(|g| -g));
    }
    of_base(arm.builder, Quantity::Acceleration) - of_base(arm.builder, Quantity::Gravity)
}

/// Returns a vector of the motion of the base. Angular velocity, accelerations and gravity are zero if they are neither
/// arguments nor were solved for.
fn of_base(builder: &Builder, quantity: Quantity) -> Vector<'_> {
    let is_still = builder.function.what() == What::GravityTorques;
    if quantity == Quantity::Omega && !is_still || builder.function.takes(Argument::Base) {
        Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, 0, axis))))
    } else {
        builder.solved_of_base(quantity).unwrap_or_else(|| builder.no_vector())
    }
}

/// Returns the motion of a floating base with velocities in the place of accelerations; zero if they are no arguments.
fn twist_of_base<'s>(arm: &Arm<'_, 's>) -> Motion<'s> {
    let builder = arm.builder;
    let told = |quantity| {
        if builder.function.takes(Argument::BaseTwist) {
            Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, 0, axis))))
        } else {
            builder.no_vector()
        }
    };
    let (at_rest, omega) = (builder.no_vector(), told(Quantity::Omega));
    builder.at(Quantity::OriginAcceleration, 0);
    let lambda = arm.parameters.lambda.first().copied().unwrap_or(Number::ONE);
    let velocity = told(Quantity::OriginVelocity).times(lambda);
    Motion { omega: at_rest, omega_dot: omega, acceleration: velocity, gradient: Gradient::new(at_rest, omega) }
}

/// Returns the motion of all links.
pub(crate) fn motions<'s>(arm: &Arm<'_, 's>) -> Vec<Moved<'s>> {
    let zeros = arm.builder.no_vector();
    let floating = arm.joint_frames.base.as_ref().map(|_| motion_of_base(arm));
    let mut moved: Vec<Moved<'s>> = Vec::with_capacity(arm.rows().len());
    for (index, row) in arm.rows().iter().enumerate() {
        let before = match (row.parent, floating) {
            (Some(parent), _) => moved[parent].own,
            (None, Some(base)) => base,
            (None, None) => Motion {
                omega: zeros,
                omega_dot: zeros,
                acceleration: arm
                    .builder
                    .vector(arm.joint_frames.gravity[index].map(|g| -(g * arm.parameters.lambda[index]))),
                gradient: Gradient::new(zeros, zeros),
            },
        };
        moved.push(match row.kind {
            Revolute => revolute(arm, index, before, &moved),
            Prismatic => prismatic(arm, index, before, &moved),
        });
    }
    moved
}

/// Returns the acceleration of the next joint's point in the axes of the parent, the part of it that is U p, and
/// whether this part is in frame N of the parent, where it may be computed; otherwise it is in the axes of the parent.
fn joint_point<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    before: Motion<'s>,
    moved: &[Moved<'s>],
    p: [Number; 3],
) -> (Vector<'s>, Vector<'s>, bool) {
    let Some(parent) = arm.rows()[index].parent else {
        if arm.joint_frames.base.is_none() {
            return (before.acceleration, arm.builder.no_vector(), false);
        }
        return (point_acceleration(arm, index, &before, p), arm.builder.no_vector(), false);
    };
    let link = &moved[parent];
    let unturned = arm.plan.joints[parent].switches.origin_unturned && arm.rows()[parent].kind == Revolute;
    let v = arm.builder.vector(p);
    if unturned {
        let part = link.unturned.gradient.of(link.group_turn.about_z(v));
        (link.group_turn.back_about_z(link.unturned.acceleration + part), part, true)
    } else if !is_parallel(arm.rows(), index) {
        (point_acceleration(arm, index, &before, p), arm.builder.no_vector(), false)
    } else {
        let part = before.gradient.of(v);
        (before.acceleration + part, part, false)
    }
}

/// The data of a revolute joint while the motion of its link is being written.
struct Revolving<'s, 'a> {
    builder: &'s Builder,
    row: &'a JointFrame,
    /// The number of the joint, counted from 1.
    joint: usize,
    plan: &'a JointPlan,
    /// Whether the joint's axis is parallel to the one before, so that both share frame N (not turned by the joint).
    parallel: bool,
    twist: Twist<'s>,
    turn: SymbolicTurn<'s>,
    group_turn: SymbolicTurn<'s>,
    rate: Symbol<'s>,
    rate_dot: Symbol<'s>,
}

fn revolute<'s>(arm: &Arm<'_, 's>, index: usize, before: Motion<'s>, moved: &[Moved<'s>]) -> Moved<'s> {
    let (builder, rows) = (arm.builder, arm.rows());
    let parallel = is_parallel(rows, index);
    let last = rows[index].parent.map(|parent| &moved[parent]);
    let turn = arm.turn(index, index);
    let link = Revolving {
        builder,
        row: &rows[index],
        joint: index + 1,
        plan: &arm.plan.joints[index],
        parallel,
        twist: Twist::new(builder, &rows[index]),
        turn,
        group_turn: if parallel { arm.turn(group_start(rows, index), index) } else { turn },
        rate: arm.rate(index),
        rate_dot: arm.rate_dot(index),
    };
    if arm.is_spin(index) {
        return link.spin(before);
    }
    let (_, d) = arm.lengths(index, arm.parameters.lambda[index]);
    let to_parent = link.plan.outward_offset == Side::Parent;
    let p = arm.outward_point(index);

    builder.at(Quantity::OriginAcceleration, link.joint);
    let (point, part, part_unturned) = joint_point(arm, index, before, moved, p);
    let point_unturned = match last {
        Some(last) if parallel => {
            last.unturned.acceleration + if part_unturned { part } else { last.group_turn.about_z(part) }
        }
        _ => link.twist.back(point),
    };
    let shared = link.share(before, last.and_then(|last| last.group));
    let [mut own, mut unturned] = link.rates(before, &shared);
    let d = if to_parent { Number::ZERO } else { d };
    (own.acceleration, unturned.acceleration) =
        link.acceleration(point, point_unturned, d, &own.gradient, &unturned.gradient);
    Moved { own, unturned, twist: link.twist, group_turn: link.group_turn, turn, group: Some(shared) }
}

impl<'s> Revolving<'s, '_> {
    /// Returns the motion for a last link that is a spinning sphere: only ω and ω̇ of the link before are needed, in N.
    fn spin(&self, before: Motion<'s>) -> Moved<'s> {
        let motion =
            Motion { omega: self.twist.back(before.omega), omega_dot: self.twist.back(before.omega_dot), ..before };
        Moved { own: motion, unturned: motion, twist: self.twist, group_turn: self.turn, turn: self.turn, group: None }
    }

    /// Returns the motion of the link before the group, in frame N (not turned by the joint), and the sums of the
    /// group's rates up to this joint.
    fn share(&self, before: Motion<'s>, group: Option<Group<'s>>) -> Group<'s> {
        self.builder.at(Quantity::OmegaUnturned, self.joint);
        match group {
            Some(shared) if self.parallel => {
                Group { rate: shared.rate + self.rate, rate_dot: shared.rate_dot + self.rate_dot, ..shared }
            }
            _ => {
                let axis = self.builder.vector(self.row.along_axis(Number::ONE));
                Group {
                    omega: self.twist.back(before.omega),
                    omega_dot: self.twist.back(before.omega_dot),
                    column: self.twist.back(before.gradient.of(axis)),
                    rate: self.rate,
                    rate_dot: self.rate_dot,
                }
            }
        }
    }

    /// Returns Rz(θ)ᵀ (Rz(γ) Rx(α))ᵀ v; if the twist is no right angle, this can take seven products instead of eight
    /// (section 5.1).
    fn outward(&self, v: Vector<'s>) -> Vector<'s> {
        let Self { twist, turn, .. } = *self;
        let (true, Some(scaled)) = (self.plan.switches.scaled_twist_outward, ScaledTwist::new(self.row)) else {
            return turn.back_about_z(twist.back(v));
        };
        let ScaledTwist { ratio, larger, on_sine } = scaled;
        let [x, y, z] = twist.back_about_parent(v).0;
        let (s, c) = (turn.s.times(larger), turn.c.times(larger));
        let u = if on_sine { z + y.times(ratio) } else { y + z.times(ratio) };
        Vector([turn.c * x + s * u, c * u - turn.s * x, twist.alpha.c * z - twist.alpha.s * y])
    }

    /// Returns the motion of the link in its frame and in N: ω, ω̇ and U are computed, the accelerations are copied
    /// from `before`.
    fn rates(&self, before: Motion<'s>, shared: &Group<'s>) -> [Motion<'s>; 2] {
        let (builder, joint, on) = (self.builder, self.joint, self.plan.switches);
        let omega_unturned = builder.name_vector(Quantity::OmegaUnturned, joint, shared.omega.plus_z(shared.rate));
        let omega_dot_unturned = spun(shared.omega, shared.rate, shared.rate_dot, shared.omega_dot);

        // step 1: the angular velocity ω
        builder.at(Quantity::Omega, joint);
        let omega = if self.parallel && on.group_omega {
            self.group_turn.back_about_z(omega_unturned)
        } else {
            self.outward(before.omega).plus_z(self.rate)
        };
        let omega = builder.name_vector(Quantity::Omega, joint, omega);

        // step 2: the angular acceleration ω̇
        builder.at(Quantity::OmegaDot, joint);
        let mut omega_dot = if on.omega_dot_unturned {
            self.group_turn.back_about_z(omega_dot_unturned)
        } else if self.parallel && on.group_omega_dot {
            spun(omega, shared.rate, shared.rate_dot, self.group_turn.back_about_z(shared.omega_dot))
        } else {
            spun(omega, self.rate, self.rate_dot, self.outward(before.omega_dot))
        };
        let column = self.group_turn.back_about_z(shared.column);
        if on.axis_column {
            let ([x, y, z], [u13, u23, _]) = (omega.0, column.0);
            omega_dot = Vector([y * z - u23, u13 - x * z, omega_dot.0[2]]);
        }
        builder.name_vector(Quantity::OmegaDot, joint, omega_dot);

        // the matrix U = [ω̇]× + [ω]×[ω]×
        builder.at(Quantity::Gradient, joint);
        let (gradient, gradient_unturned) = if on.axis_column {
            (
                Gradient::with_axis_column(omega, omega_dot.0[2], column),
                Gradient::with_axis_column(omega_unturned, omega_dot_unturned.0[2], shared.column),
            )
        } else {
            (Gradient::new(omega, omega_dot), Gradient::new(omega_unturned, omega_dot_unturned))
        };
        builder.name_matrix(Quantity::Gradient, joint, Matrix::from_rows(gradient.u));
        builder.name_matrix(Quantity::GradientUnturned, joint, Matrix::from_rows(gradient_unturned.u));
        [
            Motion { omega, omega_dot, gradient, ..before },
            Motion { omega: omega_unturned, omega_dot: omega_dot_unturned, gradient: gradient_unturned, ..before },
        ]
    }

    /// Returns a in the link's frame and in N. The offset `d` is added here if the plan adds it in frame N or in the
    /// link's frame.
    fn acceleration(
        &self,
        point: Vector<'s>,
        point_unturned: Vector<'s>,
        d: Number,
        gradient: &Gradient<'s>,
        gradient_unturned: &Gradient<'s>,
    ) -> (Vector<'s>, Vector<'s>) {
        let (builder, joint, side) = (self.builder, self.joint, self.plan.outward_offset);
        builder.at(Quantity::OriginAcceleration, joint);
        let at_joint = !d.is_zero() && side == Side::Joint;
        let lift = gradient_unturned.column_z().times(d);
        let mut unturned = if at_joint { point_unturned + lift } else { point_unturned };
        let mut own = if self.parallel && !self.plan.switches.group_acceleration {
            let turned = self.turn.back_about_z(point);
            if at_joint { turned + self.group_turn.back_about_z(lift) } else { turned }
        } else if self.parallel || at_joint {
            self.group_turn.back_about_z(unturned)
        } else {
            self.outward(point)
        };
        if !d.is_zero() && side == Side::Link {
            let lift = gradient.column_z().times(d);
            own = own + lift;
            unturned = unturned + self.group_turn.about_z(lift);
        }
        builder.name_vector(Quantity::OriginAcceleration, joint, own);
        builder.name_vector(Quantity::OriginAccelerationUnturned, joint, unturned);
        (own, unturned)
    }
}

/// Returns ω̇ + q̇ (ω_y, -ω_x, 0) + q̈ z.
fn spun<'s>(omega: Vector<'s>, rate: Symbol<'s>, rate_dot: Symbol<'s>, omega_dot: Vector<'s>) -> Vector<'s> {
    let ([wx, wy, _], [x, y, z]) = (omega.0, omega_dot.0);
    Vector([x + rate * wy, y - rate * wx, z + rate_dot])
}

/// Returns the motion of a prismatic link, which turns as the link before: a = Rᵀ (a_{i-1} + U_{i-1} p) + (d + q) U u +
/// 2 q̇ ω × u + q̈ u.
fn prismatic<'s>(arm: &Arm<'_, 's>, index: usize, before: Motion<'s>, moved: &[Moved<'s>]) -> Moved<'s> {
    let builder = arm.builder;
    let (rows, joint) = (arm.rows(), index + 1);
    let row = &rows[index];
    let lambda = arm.parameters.lambda[index];
    let (offset, d) = arm.lengths(index, lambda);
    let (twist, turn) = (Twist::new(builder, row), builder.fixed_turn(row.theta));
    let (qd, qdd) = (arm.rate(index).times(lambda), arm.rate_dot(index).times(lambda));
    let twice_rate = qd.times(Number::integer(2));
    let q = arm.position(index).times(lambda) + builder.number(d);
    let u = builder.vector(row.axis);

    builder.at(Quantity::OriginAcceleration, joint);
    let own = if row.carried {
        let arm_vector = builder.vector(offset) + u * q;
        let acceleration =
            before.acceleration + before.gradient.of(arm_vector) + before.omega.cross(u * twice_rate) + u * qdd;
        Motion { acceleration, ..before }
    } else {
        let (point, ..) = joint_point(arm, index, before, moved, offset);
        let outward = |v: Vector<'s>| turn.back_about_z(twist.back(v));
        builder.at(Quantity::Omega, joint);
        let omega = builder.name_vector(Quantity::Omega, joint, outward(before.omega));
        builder.at(Quantity::OmegaDot, joint);
        let omega_dot = builder.name_vector(Quantity::OmegaDot, joint, outward(before.omega_dot));
        builder.at(Quantity::Gradient, joint);
        let gradient = Gradient::new(omega, omega_dot);
        builder.name_matrix(Quantity::Gradient, joint, Matrix::from_rows(gradient.u));
        builder.at(Quantity::OriginAcceleration, joint);
        let [wx, wy, _] = omega.0;
        let [x, y, z] = (outward(point) + gradient.column_z() * q).0;
        let acceleration = Vector([x + twice_rate * wy, y - twice_rate * wx, z + qdd]);
        Motion { omega, omega_dot, acceleration, gradient }
    };
    builder.name_vector(Quantity::OriginAcceleration, joint, own.acceleration);
    Moved { own, unturned: own, twist, group_turn: turn, turn, group: None }
}

/// sin α and cos α of a twist, with the smaller one given as a multiple (`ratio`) of the larger.
pub(crate) struct ScaledTwist {
    pub(crate) ratio: Number,
    pub(crate) larger: Number,
    pub(crate) on_sine: bool,
}

impl ScaledTwist {
    /// Returns `None` for multiples of a right angle.
    pub(crate) fn new(row: &JointFrame) -> Option<Self> {
        let (s, c) = (row.alpha.sin, row.alpha.cos);
        if row.alpha.quarters().is_some() {
            return None;
        }
        let on_sine = s.to_f64().abs() > c.to_f64().abs();
        let (smaller, larger) = if on_sine { (c, s) } else { (s, c) };
        Some(Self { ratio: smaller * larger.inverse()?, larger, on_sine })
    }
}
