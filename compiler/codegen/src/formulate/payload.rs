//! A payload that is fixed to the tip: it is computed as one more link, whose joint does not move.
//!
//! ```text
//! R, r    of the tip, from the axes and the centre of mass of the last link n   c, m, I   of the payload, in tip axes
//!
//! ω = Rᵀ ω_n      ω̇ = Rᵀ ω̇_n      g = Rᵀ g_n
//! c̈ = Rᵀ (c̈_n + ω̇_n × r + ω_n × (ω_n × r)) + ω̇ × c + ω × (ω × c)
//! f = m (c̈ - g)                   n = I ω̇ + ω × (I ω) + c × f          about the origin of the tip frame
//! ```

use crate::formulate::{Arm, Motion, Wrench};
use crate::function::Argument;
use crate::ir::{Builder, Cause, Matrix, Quantity, Symbol, Vector, all_names_of};

/// A payload: its mass, centre of mass and inertia in tip axes.
#[derive(Clone, Copy)]
pub(crate) struct Payload<'s> {
    pub(crate) mass: Symbol<'s>,
    /// Vector from the origin of the tip frame to the centre of mass.
    pub(crate) com: Vector<'s>,
    /// Inertia about the centre of mass.
    pub(crate) inertia: Matrix<'s>,
}

impl<'s> Payload<'s> {
    /// Returns the payload among the arguments of the function, if the function takes one.
    pub(crate) fn argument(builder: &'s Builder, dof: usize) -> Option<Self> {
        if !builder.function.takes(Argument::Payload) {
            return None;
        }
        let [mass, x, y, z, xx, yy, zz, xy, xz, yz] =
            all_names_of::<10>("payload", dof + 1).map(|name| builder.argument(name));
        Some(Self {
            mass,
            com: Vector([x, y, z]),
            inertia: Matrix::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
        })
    }

    /// Returns the wrench that the last link exerts on the payload, at the tip, in tip axes.
    fn wrench(&self, arm: &Arm<'s>, last: &Motion<'s>) -> Wrench<'s> {
        let Self { mass, com, inertia } = *self;
        let dof = arm.links.len();
        let (line, r, back) = (arm.builder.joint(dof + 1), arm.tip.r, arm.tip.rotation.transpose());
        let link = arm.tip_link.map_or(0, |link| link + 1);

        // steps 1 and 2: angular velocity and acceleration
        let omega = line.define(Quantity::Omega).by(back * last.turning.omega);
        let omega_dot = line.define(Quantity::OmegaDot).by(back * last.turning.omega_dot);

        // step 4: acceleration of the centre of mass
        let omega_cross_r = line
            .named(link)
            .with_second_number(arm.tip.label)
            .define(Quantity::OmegaCrossR)
            .by(last.turning.omega.cross(r));
        let tip = line
            .define(Quantity::JointPointAcceleration)
            .by(last.c_ddot + last.turning.omega_dot.cross(r) + last.turning.omega.cross(omega_cross_r));
        let omega_cross_c = line.define(Quantity::OmegaCrossD).by(omega.cross(com));
        let c_ddot =
            line.define(Quantity::Acceleration).by(back * tip + omega_dot.cross(com) + omega.cross(omega_cross_c));

        // step 5: gravity in tip axes
        let gravity = line.define(Quantity::Gravity).by(back * last.gravity);

        // step 6: force and moment
        let angular_momentum = line.define(Quantity::AngularMomentum).by(inertia * omega);
        let inertia_moment =
            line.define(Quantity::InertiaMoment).by(inertia * omega_dot + omega.cross(angular_momentum));
        let at_tip = line.behind(arm.tip_link);
        let force = at_tip.define(Quantity::JointForce).by((c_ddot - gravity) * mass);
        let moment = at_tip.define(Quantity::JointMoment).by(inertia_moment + com.cross(force));
        Wrench { force, moment }
    }

    /// Returns the linear and angular momentum P and L of the payload, in tip axes and about the origin of the tip
    /// frame: v = Rᵀ (ċ_n + ω_n × r) + ω × c, P = m v and L = I ω + c × P. `last` is the motion of the last link.
    pub(crate) fn momenta(&self, arm: &Arm<'s>, last: &Motion<'s>) -> [Vector<'s>; 2] {
        let Self { mass, com, inertia } = *self;
        let dof = arm.links.len();
        let (line, r, back) = (arm.builder.joint(dof + 1), arm.tip.r, arm.tip.rotation.transpose());
        let link = arm.tip_link.map_or(0, |link| link + 1);
        let omega = line.define(Quantity::Omega).by(back * last.turning.omega);
        let omega_cross_r = line
            .named(link)
            .with_second_number(arm.tip.label)
            .define(Quantity::OmegaCrossR)
            .by(last.turning.omega.cross(r));
        let tip = line.define(Quantity::JointPointVelocity).by(last.c_dot + omega_cross_r);
        let velocity = line.define(Quantity::Velocity).by(back * tip + omega.cross(com));
        let linear = line.define(Quantity::LinearMomentum).by(velocity * mass);
        let angular = line.define(Quantity::AngularMomentumBehind).by(inertia * omega + com.cross(linear));
        [linear, angular]
    }
}

/// The load of the last link at the tip.
pub(crate) enum AtTip<'s> {
    /// The tip is free.
    Nothing,
    /// A wrench, which the last link exerts on the environment.
    Wrench(Wrench<'s>),
    /// A wrench at each tip.
    Wrenches(Vec<Wrench<'s>>),
    /// A payload.
    Payload(Payload<'s>),
}

impl<'s> AtTip<'s> {
    /// Returns the wrench that the link of each tip exerts there, in tip axes.
    pub(crate) fn wrenches(&self, arm: &Arm<'s>, motions: &[Motion<'s>]) -> Vec<Wrench<'s>> {
        match (self, arm.at_tip(motions)) {
            (Self::Wrench(wrench), _) => vec![*wrench],
            (Self::Wrenches(wrenches), _) => wrenches.clone(),
            (Self::Payload(payload), Some(last)) => vec![payload.wrench(arm, last)],
            _ => {
                let zeros = arm.builder.zeros(Cause::FreeTip);
                vec![Wrench { force: zeros, moment: zeros }; arm.tips.len()]
            }
        }
    }
}
