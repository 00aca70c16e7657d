//! Where the links and the tip are in the world, and how fast they get there.
//!
//! ```text
//! W_i = W_{i-1} R_i        axes of frame i (at joint i, fixed to link i) in the world;  z_i = W_i e
//! p_i                      joint point J_i;  O_i = p_i + W_i o_i,  p_{i+1} = O_i + W_i l_i
//! column i of J            z_i × (p_tip - p_i), z_i (revolute);   z_i, 0 (prismatic)
//! ```
//!
//! o_i is the offset along row i of the table, l_i leads from there to the next joint or to the tip.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::arm::Arm;
use crate::formulate::seven_steps::{self, Base, JointState, Turning, rotation};
use crate::ir::ledger::Cause;
use crate::ir::name::Name;
use crate::ir::quantity::{Axis, Quantity};
use crate::ir::{Builder, Matrix, Symbol, Vector};

/// A frame in the world.
#[derive(Clone, Copy)]
pub(crate) struct Frame<'s> {
    pub(crate) rotation: Matrix<'s>,
    pub(crate) origin: Vector<'s>,
}

/// All frames of an arm in the world.
pub(crate) struct Frames<'s> {
    /// Frame i at joint i, in the axes of link i.
    pub(crate) joints: Vec<Frame<'s>>,
    /// The link frames of the table.
    pub(crate) links: Vec<Frame<'s>>,
    pub(crate) tip: Frame<'s>,
}

/// The frames from the world, or from frame 0 if `start` is that.
pub(crate) fn frames<'s>(
    builder: &'s Builder,
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    start: Frame<'s>,
) -> Frames<'s> {
    let dof = states.len();
    let first = builder.joint(1);
    let mut before = start;
    before.origin = first.within(Quantity::FrameOrigin, || start.rotation * arm.base_lever + start.origin);
    let mut joints = Vec::with_capacity(dof);
    let mut links = Vec::with_capacity(dof);
    for (index, (link, state)) in arm.links.iter().zip(states).enumerate() {
        let line = builder.joint(index + 1);
        let own = rotation(line, builder, index + 1, link, state.q, state.turn);
        let axes = line.within(Quantity::FrameRotation, || before.rotation * own);
        let origin =
            line.within(Quantity::FrameOrigin, || axes * offset(link.offset, link.kind, state.q) + before.origin);
        let table = line.within(Quantity::FrameRotation, || axes * link.table_axes);
        builder.name_matrix(Quantity::FrameRotation, index + 1, table);
        builder.name_vector(Quantity::FrameOrigin, index + 1, origin);
        joints.push(Frame { rotation: axes, origin: before.origin });
        links.push(Frame { rotation: table, origin });
        before = Frame { rotation: axes, origin: line.within(Quantity::FrameOrigin, || axes * link.lever + origin) };
    }
    let line = builder.joint(dof);
    let rotation = line.within(Quantity::FrameRotation, || before.rotation * arm.tip);
    builder.name_matrix(Quantity::FrameRotation, dof + 1, rotation);
    builder.name_vector(Quantity::FrameOrigin, dof + 1, before.origin);
    Frames { joints, links, tip: Frame { rotation, origin: before.origin } }
}

/// The frame that carries the arm in the world.
pub(crate) fn base<'s>(arm: &Arm<'s>) -> Frame<'s> {
    Frame { rotation: arm.base.rotation, origin: arm.base.translation }
}

/// (a_i, 0, b_i), with the travel of a prismatic joint.
pub(crate) fn offset<'s>(offset: Vector<'s>, kind: rne_model::JointKind, q: Symbol<'s>) -> Vector<'s> {
    let [x, y, z] = offset.0;
    match kind {
        Revolute => offset,
        Prismatic => Vector([x, y, z + q]),
    }
}

/// The columns of the Jacobian: linear and angular part.
pub(crate) fn jacobian<'s>(builder: &'s Builder, arm: &Arm<'s>, frames: &Frames<'s>) -> Vec<[Vector<'s>; 2]> {
    let columns = arm.links.iter().zip(&frames.joints).enumerate().map(|(index, (link, frame))| {
        let line = builder.joint(index + 1);
        let axis = Vector(frame.rotation.0.map(Vector::z));
        let (linear, angular) = match link.kind {
            Revolute => {
                let lever = line.within(Quantity::JacobianLinear, || frames.tip.origin - frame.origin);
                (line.within(Quantity::JacobianLinear, || axis.cross(lever)), axis)
            }
            Prismatic => (axis, builder.zeros(Cause::JointAxis)),
        };
        let linear = builder.name_vector(Quantity::JacobianLinear, index + 1, linear);
        let angular = builder.name_vector(Quantity::JacobianAngular, index + 1, angular);
        [linear, angular]
    });
    columns.collect()
}

/// Linear and angular acceleration of the tip in world axes, for a base at rest and joints that do not accelerate: step
/// 4 from joint to joint, without centres of mass. s_i = J_i → J_{i+1}, the last to the tip:
///
/// p̈_{i+1} = R_iᵀ p̈_i + ω̇_i × s_i + ω_i × (ω_i × s_i)      (+ 2 q̇_i ω_i × e)
///
/// then p̈ and ω̇_n turned by R_n … R_1 and by the base.
pub(crate) fn tip_acceleration<'s>(
    builder: &'s Builder,
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Base<'s>,
) -> [Vector<'s>; 2] {
    let e = seven_steps::axis(builder);
    let dof = states.len();
    let tip = dof + 1;
    let mut point = builder.zeros(Cause::FixedBase);
    let mut turning = Turning::of_base(builder, base);
    let mut rotations = Vec::with_capacity(dof);
    for (index, (link, state)) in arm.links.iter().zip(states).enumerate() {
        let line = builder.joint(index + 1);
        turning = turning.of_next(builder, index + 1, link, state);
        let Turning { rotation, omega, omega_dot } = turning;
        let span = offset(link.offset + link.lever, link.kind, state.q);
        let twice_qd =
            || line.scalar(Quantity::TwiceRate, || builder.entry(Name::scalar(Quantity::Two, 0), 2.0) * state.qd);
        let next = || {
            let rigid = rotation.transpose() * point + omega_dot.cross(span) + omega.cross(omega.cross(span));
            match link.kind {
                Revolute => rigid,
                Prismatic => rigid + omega.cross(e) * twice_qd(),
            }
        };
        point = if index + 1 == dof {
            line.within(Quantity::TipAcceleration, next)
        } else {
            line.of_link_after().vector(Quantity::JointPointAcceleration, next)
        };
        rotations.push(rotation);
    }
    let [linear, angular] = [point, turning.omega_dot].map(|mut vector| {
        for (index, rotation) in rotations.iter().enumerate().rev() {
            vector = builder.joint(index + 1).within(Quantity::TipAcceleration, || *rotation * vector);
        }
        builder.joint(1).within(Quantity::TipAcceleration, || arm.base.rotation * vector)
    });
    let linear = builder.name_vector(Quantity::TipAcceleration, tip, linear);
    let name =
        |axis: Axis, x| builder.name(Name { indices: [1, 0], ..Name::vector(Quantity::TipAcceleration, tip, axis) }, x);
    [linear, angular.map(name)]
}
