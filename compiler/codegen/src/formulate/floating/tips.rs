//! Jacobians J of the named tips of a robot with a floating base, and the terms J̇ v of the accelerations of the tips.
//!
//! ```text
//! W_0 = R          axes of frame 0 in the world; p of the origin of frame 0 is 0, wherever the base is
//! columns of J     linear:  R_k;  angular: R_k × p_tip, R_k;  joint i: z_i × (p_tip - p_i), z_i (revolute);  z_i, 0
//! J̇ v              point of a joint or tip k on link i:  p̈_k = p̈ + ω̇_i × s + ω_i × (ω_i × s) (+ 2 q̇_i ω_i × e)
//! ```
//!
//! s is the vector from joint i to joint or tip k, p̈ is the acceleration of joint i. On the base p̈ = 0, ω̇ = 0 and s
//! begins at the origin of frame 0. All these are in axes of link i; the frame of link i turns the results into world
//! axes.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::coordinates::{Coordinates, scaled};
use crate::formulate::{Arm, Frame, Frames, JointState, Link, Mount, Outputs, Turning, kinematics, seven_steps};
use crate::ir::{Axis, Cause, Matrix, Name, Quantity, Vector};

/// Linear and angular part of a Jacobian column or of an acceleration.
type Parts<'s> = [Vector<'s>; 2];

/// The frames of a robot, and the positions of its tips from the origin of frame 0.
pub(crate) struct Tips<'s> {
    /// Rotation of frame 0.
    rotation: Matrix<'s>,
    frames: Frames<'s>,
    origins: Vec<Vector<'s>>,
}

impl<'s> Tips<'s> {
    /// Computes the frames and tips; `rotation` turns frame 0 into the axes of the results.
    pub(crate) fn of(arm: &Arm<'s>, states: &[JointState<'s>], rotation: Matrix<'s>) -> Self {
        let base = Frame { rotation, origin: arm.builder.zeros(Cause::FirstFrame) };
        let frames = kinematics::frames(arm, states, base);
        let origin = |(index, (link, mount)): (usize, &(Option<usize>, Mount<'s>))| {
            let line = arm.builder.joint(link.map_or(0, |link| link + 1)).named(states.len() + 1 + index);
            line.define(Quantity::FrameOrigin).by(match link {
                Some(link) => frames.joints[*link].rotation * mount.lever + frames.links[*link].origin,
                None => rotation * mount.lever,
            })
        };
        let origins = arm.tips.iter().enumerate().map(origin).collect();
        Self { rotation, frames, origins }
    }

    /// Returns the columns of the Jacobian of a tip: six of the base, then one of each joint.
    fn columns(&self, arm: &Arm<'s>, tip: usize) -> Vec<Parts<'s>> {
        let (builder, origin, on) = (arm.builder, self.origins[tip], arm.tips[tip].0);
        let still = builder.zeros(Cause::BehindFrame);
        let line = builder.joint(0);
        let axes = self.rotation.transpose().0;
        let linear = axes.map(|axis| [axis, still]);
        let angular = axes.map(|axis| [line.within(Quantity::JacobianLinear, || axis.cross(origin)), axis]);
        let of_joint = |(index, (link, frame)): (usize, (&Link<'s>, &Frame<'s>))| {
            if !arm.moves(index, on) {
                return [still; 2];
            }
            let axis = frame.axis();
            match link.kind {
                Revolute => {
                    let lever = || axis.cross(origin - frame.origin);
                    [builder.joint(index + 1).within(Quantity::JacobianLinear, lever), axis]
                }
                Prismatic => [axis, builder.zeros(Cause::JointAxis)],
            }
        };
        let joints = arm.links.iter().zip(&self.frames.joints).enumerate().map(of_joint);
        linear.into_iter().chain(angular).chain(joints).collect()
    }

    /// Returns the columns of the Jacobian of a tip: six of the base, then one of each coordinate.
    pub(crate) fn gathered(&self, arm: &Arm<'s>, coordinates: &Coordinates, tip: usize) -> Vec<Parts<'s>> {
        let mut of_base = self.columns(arm, tip);
        let of_joints = of_base.split_off(6);
        let plus = |a: Parts<'s>, b: Parts<'s>| [a[0] + b[0], a[1] + b[1]];
        let times = |parts: Parts<'s>, ratio| parts.map(|part| part.map(|_, x| scaled(x, ratio)));
        of_base.into_iter().chain(coordinates.gathered(&of_joints, plus, times)).collect()
    }

    /// Returns the Jacobians of all tips, each by rows.
    pub(crate) fn jacobians(&self, arm: &Arm<'s>, coordinates: &Coordinates) -> Outputs<'s> {
        let mut outputs = Vec::new();
        for tip in 0..self.origins.len() {
            let columns = self.gathered(arm, coordinates, tip);
            for row in 0..6 {
                let quantity = if row < 3 { Quantity::JacobianLinear } else { Quantity::JacobianAngular };
                outputs.extend(columns.iter().enumerate().map(|(column, parts)| {
                    // the joint of the column, or the number of the column of the base
                    let (joint, of_base) = match column.checked_sub(6) {
                        Some(place) => (coordinates.joints()[place] + 1, 0),
                        None => (0, column + 1),
                    };
                    let name = Name::vector(quantity, joint, Axis::ALL[row % 3]);
                    let name = Name { indices: [tip + 1, of_base], ..name };
                    (name, arm.builder.name(name, parts[row / 3].0[row % 3]))
                }));
            }
        }
        outputs
    }

    /// Returns the accelerations J̇ v of the tips: the base turns with the angular velocity of `base`, and neither base
    /// nor joints accelerate.
    pub(crate) fn accelerations(&self, arm: &Arm<'s>, states: &[JointState<'s>], base: &Turning<'s>) -> Vec<Parts<'s>> {
        let builder = arm.builder;
        let at_rest = builder.zeros(Cause::FixedBase);
        // the angular motion of each link, and the acceleration of its joint in its axes
        let mut turnings: Vec<Turning<'s>> = Vec::with_capacity(states.len());
        let mut joints: Vec<Vector<'s>> = Vec::with_capacity(states.len());
        let rigid = |point: Vector<'s>, turning: &Turning<'s>, span: Vector<'s>| {
            let Turning { omega, omega_dot, .. } = *turning;
            point + omega_dot.cross(span) + omega.cross(omega.cross(span))
        };
        let on_link = |turnings: &[Turning<'s>], joints: &[Vector<'s>], on: Option<usize>, lever: Vector<'s>| {
            let Some(link) = on.and_then(|on| arm.joints(states).nth(on)) else {
                return rigid(at_rest, base, lever);
            };
            let (turning, span) = (&turnings[link.index], link.offset(link.link.offset + lever));
            link.unaccelerated(rigid(joints[link.index], turning, span), turning.omega)
        };
        for joint in arm.joints(states).filter(|joint| arm.moves_a_tip(joint.index)) {
            // links that move no tip are skipped; these entries only fill their places
            turnings.resize(joint.index, *base);
            joints.resize(joint.index, at_rest);
            let parent = joint.link.parent;
            let turning = seven_steps::turning(&joint, parent.map_or(base, |parent| &turnings[parent]));
            let point = joint.lines.define(Quantity::JointPointAcceleration).by(on_link(
                &turnings,
                &joints,
                parent,
                joint.link.mount.lever,
            ));
            let back = turning.rotation.transpose();
            joints.push(joint.lines.within(Quantity::TipAcceleration, || back * point));
            turnings.push(turning);
        }
        let tip = |(index, &(on, mount)): (usize, &(Option<usize>, Mount<'s>))| {
            let number = states.len() + 1 + index;
            let line = builder.joint(on.map_or(0, |on| on + 1)).named(number);
            let (axes, angular) = match on {
                Some(link) => (self.frames.joints[link].rotation, turnings[link].omega_dot),
                None => (self.rotation, base.omega_dot),
            };
            let linear = line.within(Quantity::TipAcceleration, || axes * on_link(&turnings, &joints, on, mount.lever));
            let angular = line.within(Quantity::TipAcceleration, || axes * angular);
            let name = |part: usize, vector: Vector<'s>| {
                vector.map(|axis, x| {
                    let name = Name::vector(Quantity::TipAcceleration, number, axis);
                    builder.name(Name { indices: [part, 0], ..name }, x)
                })
            };
            [name(0, linear), name(1, angular)]
        };
        arm.tips.iter().enumerate().map(tip).collect()
    }
}
