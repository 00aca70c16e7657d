//! Positions of the links and of the tip in the world, and their velocities and accelerations.
//!
//! ```text
//! W_i = W_p R_i            axes of frame i (at joint i, fixed to link i) in the world;  z_i = W_i e
//! p_i = O_p + W_p l_i      joint point J_i;  O_i = p_i + W_i o_i
//! column i of J            z_i × (p_tip - p_i), z_i (revolute);   z_i, 0 (prismatic)
//! ```
//!
//! p is the parent of i. o_i is the offset along row i of the table, l_i is the vector from the end of the parent's
//! offset to joint i.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::{Arm, JointState, Link, Motion, Mount, Turning, Wrench, seven_steps};
use crate::ir::{Axis, Cause, Matrix, Name, Quantity, Symbol, Vector};

/// The pose of a frame in the world: rotation and origin.
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

impl<'s> Frame<'s> {
    /// Returns z_i, the joint axis in world axes.
    pub(crate) fn axis(&self) -> Vector<'s> {
        Vector(self.rotation.0.map(Vector::z))
    }
}

/// Returns the frames in the world, or in frame 0 if `base` is the identity.
pub(crate) fn frames<'s>(arm: &Arm<'s>, states: &[JointState<'s>], base: Frame<'s>) -> Frames<'s> {
    let (builder, dof) = (arm.builder, states.len());
    let (mut joints, mut links): (Vec<Frame<'s>>, Vec<Frame<'s>>) = (Vec::with_capacity(dof), Vec::with_capacity(dof));
    for joint in arm.joints(states) {
        let (line, link) = (joint.lines, joint.link);
        let before = mounted(arm, &link.mount, link.parent.map_or((1, base, base), |p| (p + 1, joints[p], links[p])));
        let own = joint.rotation();
        let axes = line.within(Quantity::FrameRotation, || before.rotation * own);
        let origin = line.within(Quantity::FrameOrigin, || axes * joint.offset(link.offset) + before.origin);
        let table = line.define(Quantity::FrameRotation).by(axes * link.table_axes);
        line.name_vector(Quantity::FrameOrigin, origin);
        joints.push(Frame { rotation: axes, origin: before.origin });
        links.push(Frame { rotation: table, origin });
    }
    let last = arm.tip_link.map_or((1, base, base), |link| (link + 1, joints[link], links[link]));
    let before = mounted(arm, &arm.tip, last);
    let line = builder.joint(dof).named(dof + 1);
    let rotation = line.define(Quantity::FrameRotation).by(before.rotation * arm.tip.rotation);
    line.name_vector(Quantity::FrameOrigin, before.origin);
    Frames { joints, links, tip: Frame { rotation, origin: before.origin } }
}

/// Returns where something is mounted on a parent, in the parent's axes. The tuple is the number of the parent's joint,
/// the frame at that joint, and the frame at the end of its offset.
fn mounted<'s>(arm: &Arm<'s>, mount: &Mount<'s>, (number, joint, link): (usize, Frame<'s>, Frame<'s>)) -> Frame<'s> {
    let line = arm.builder.joint(number);
    let origin = line.within(Quantity::FrameOrigin, || joint.rotation * mount.lever + link.origin);
    Frame { rotation: joint.rotation, origin }
}

/// Returns the pose of frame 0 in the world.
pub(crate) fn base<'s>(arm: &Arm<'s>) -> Frame<'s> {
    Frame { rotation: arm.base.rotation, origin: arm.base.translation }
}

/// Returns the columns of the Jacobian of the tip: linear and angular part.
pub(crate) fn jacobian<'s>(arm: &Arm<'s>, frames: &Frames<'s>) -> Vec<[Vector<'s>; 2]> {
    let columns = arm.links.iter().zip(&frames.joints).enumerate().map(|(index, (link, frame))| {
        let line = arm.builder.joint(index + 1);
        if !arm.moves_tip(index) {
            return [arm.builder.zeros(Cause::BehindFrame); 2];
        }
        let axis = frame.axis();
        let (linear, angular) = match link.kind {
            Revolute => {
                let lever = line.within(Quantity::JacobianLinear, || frames.tip.origin - frame.origin);
                (line.within(Quantity::JacobianLinear, || axis.cross(lever)), axis)
            }
            Prismatic => (axis, arm.builder.zeros(Cause::JointAxis)),
        };
        [line.name_vector(Quantity::JacobianLinear, linear), line.name_vector(Quantity::JacobianAngular, angular)]
    });
    columns.collect()
}

/// Returns the columns of J̇. ω is the angular velocity of the link before joint i, and u is the velocity of the tip
/// due to joint i and the joints after it:
///
/// ω × J_v + z_i × u, ω × z_i (revolute);   ω × z_i, 0 (prismatic)
pub(crate) fn jacobian_rate<'s>(arm: &Arm<'s>, states: &[JointState<'s>], frames: &Frames<'s>) -> Vec<[Vector<'s>; 2]> {
    let builder = arm.builder;
    let columns = jacobian(arm, frames);
    let still = builder.zeros(Cause::BehindFrame);
    let mut behind = vec![builder.zeros(Cause::FixedBase); columns.len() + 1];
    for index in (0..columns.len()).rev() {
        behind[index] = behind[index + 1];
        if arm.moves_tip(index) {
            let sum = || columns[index][0] * states[index].qd + behind[index + 1];
            behind[index] = builder.joint(index + 1).within(Quantity::JacobianLinearRate, sum);
        }
    }
    let mut omega = builder.zeros(Cause::FixedBase);
    let column = |(index, link): (usize, &Link<'s>)| {
        let (line, [linear, axis]) = (builder.joint(index + 1), columns[index]);
        if !arm.moves_tip(index) {
            return [still; 2];
        }
        let (linear, angular) = match link.kind {
            Revolute => {
                let before = omega;
                omega = line.within(Quantity::JacobianAngularRate, || axis * states[index].qd + before);
                let linear = || before.cross(linear) + axis.cross(behind[index]);
                (line.within(Quantity::JacobianLinearRate, linear), before.cross(axis))
            }
            Prismatic => {
                (line.within(Quantity::JacobianLinearRate, || omega.cross(linear)), builder.zeros(Cause::JointAxis))
            }
        };
        [
            line.name_vector(Quantity::JacobianLinearRate, linear),
            line.name_vector(Quantity::JacobianAngularRate, angular),
        ]
    };
    arm.links.iter().enumerate().map(column).collect()
}

/// Returns the derivatives of each column of J with respect to the position of each joint. Joint i turns all that is
/// after it in the chain, with the tip and the joint axes, so that for i ≤ k
///
/// ∂J_v,k/∂q_i = ∂J_v,i/∂q_k = z_i × J_v,k (revolute i; otherwise 0);   ∂z_k/∂q_i = z_i × z_k, i < k, both revolute
pub(crate) fn jacobian_derivatives<'s>(arm: &Arm<'s>, frames: &Frames<'s>) -> Vec<Vec<[Vector<'s>; 2]>> {
    let builder = arm.builder;
    let columns = jacobian(arm, frames);
    let dof = columns.len();
    let mut found = vec![vec![[builder.no_vector(); 2]; dof]; dof];
    let turns = |index: usize| arm.moves_tip(index) && arm.links[index].kind == Revolute;
    for near in (0..dof).filter(|&near| turns(near)) {
        let axis = columns[near][1];
        for far in (near..dof).filter(|&far| arm.moves_tip(far)) {
            let line = builder.joint(far + 1);
            let linear = line.within(Quantity::JacobianLinear, || axis.cross(columns[far][0]));
            found[near][far][0] = linear;
            found[far][near][0] = linear;
            if far > near && turns(far) {
                found[far][near][1] = line.within(Quantity::JacobianAngular, || axis.cross(columns[far][1]));
            }
        }
    }
    found
}

/// Returns the linear and angular acceleration of the tip in world axes, for a base at rest and joints that do not
/// accelerate: step 4 from joint to joint, without centres of mass. s_i is the vector from J_i to J_{i+1}, the last one
/// to the tip:
///
/// p̈_{i+1} = R_iᵀ p̈_i + ω̇_i × s_i + ω_i × (ω_i × s_i) (+ 2 q̇_i ω_i × e: prismatic)
///
/// then p̈ and ω̇_n are turned into world axes by R_n to R_1 and by the base.
pub(crate) fn tip_acceleration<'s>(arm: &Arm<'s>, states: &[JointState<'s>], base: &Motion<'s>) -> [Vector<'s>; 2] {
    let (builder, dof) = (arm.builder, states.len());
    let mut point = builder.zeros(Cause::FixedBase);
    let mut turning = base.turning;
    let mut rotations = Vec::with_capacity(dof);
    for joint in arm.joints(states).filter(|joint| arm.moves_tip(joint.index)) {
        let line = joint.lines;
        turning = seven_steps::turning(&joint, &turning);
        let Turning { rotation, omega, omega_dot } = turning;
        let span = joint.offset(joint.link.offset + arm.carried_by(joint.index).lever);
        let next = || {
            let rigid = rotation.transpose() * point + omega_dot.cross(span) + omega.cross(omega.cross(span));
            joint.unaccelerated(rigid, omega)
        };
        let mut carried = arm.carried_joints(joint.index).map(|(index, _)| index);
        point = match carried.find(|index| arm.moves_tip(*index)) {
            None => line.within(Quantity::TipAcceleration, next),
            Some(carried) => line.named(carried + 1).define(Quantity::JointPointAcceleration).by(next()),
        };
        rotations.push((line, rotation));
    }
    let [linear, angular] = [point, turning.omega_dot].map(|mut vector| {
        for (line, rotation) in rotations.iter().rev() {
            vector = line.within(Quantity::TipAcceleration, || *rotation * vector);
        }
        builder.joint(1).within(Quantity::TipAcceleration, || arm.base.rotation * vector)
    });
    let tip = dof + 1;
    let linear = builder.name_vector(Quantity::TipAcceleration, tip, linear);
    let name =
        |axis: Axis, x| builder.name(Name { indices: [1, 0], ..Name::vector(Quantity::TipAcceleration, tip, axis) }, x);
    [linear, angular.map(name)]
}

/// Returns the joint torques Jᵀ w for a wrench w = (f, n) at the tip, in tip axes: with F = R_tip f and N = R_tip n,
///
/// z_i · ((p_tip - p_i) × F + N) (revolute);   z_i · F (prismatic)
pub(crate) fn wrench_torques<'s>(arm: &Arm<'s>, frames: &Frames<'s>, wrench: &Wrench<'s>) -> Vec<Symbol<'s>> {
    let builder = arm.builder;
    let tip = builder.joint(arm.links.len());
    let [force, moment] =
        [wrench.force, wrench.moment].map(|part| tip.within(Quantity::Torque, || frames.tip.rotation * part));
    let torque = |(index, (link, frame)): (usize, (&Link<'s>, &Frame<'s>))| {
        if !arm.moves_tip(index) {
            return builder.constant(0.0, Cause::BehindFrame);
        }
        let (line, axis) = (builder.joint(index + 1), frame.axis());
        let torque = line.within(Quantity::Torque, || match link.kind {
            Revolute => axis.dot((frames.tip.origin - frame.origin).cross(force) + moment),
            Prismatic => axis.dot(force),
        });
        builder.name(arm.coordinates.name_of_torque(index), torque)
    };
    arm.links.iter().zip(&frames.joints).enumerate().map(torque).collect()
}
