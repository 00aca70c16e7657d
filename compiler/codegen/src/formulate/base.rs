//! The motion of the base, from which the forward pass begins.

use crate::formulate::arm::identity;
use crate::formulate::{Arm, Motion, Turning};
use crate::ir::{Builder, Cause, Quantity, Vector};

impl<'s> Motion<'s> {
    /// Returns the motion of a base that does not move.
    pub(crate) fn of_fixed_base(builder: &'s Builder, gravity: Vector<'s>) -> Self {
        let at_rest = builder.zeros(Cause::FixedBase);
        let turning = Turning { rotation: identity(builder), omega: at_rest, omega_dot: at_rest };
        Self { turning, d: at_rest, c_dot: at_rest, c_ddot: at_rest, gravity }
    }

    /// Returns the motion of a base with the angular velocity ω_0, the angular acceleration ω̇_0, and the acceleration
    /// a of the origin of frame 0. The velocity of that origin is not needed.
    ///
    /// d_0 leads from that origin to the centre of mass of a floating base: c̈_0 = a + ω̇_0 × d_0 + ω_0 × (ω_0 × d_0).
    /// A base without mass has c̈_0 = a.
    pub(crate) fn of_base(arm: &Arm<'s>, [omega, omega_dot, of_origin]: [Vector<'s>; 3], gravity: Vector<'s>) -> Self {
        let turning = Turning { rotation: identity(arm.builder), omega, omega_dot };
        let at_rest = arm.builder.zeros(Cause::FixedBase);
        let Some(body) = &arm.floating_base else {
            return Self { turning, d: at_rest, c_dot: at_rest, c_ddot: of_origin, gravity };
        };
        let (line, d) = (arm.builder.joint(0), body.com);
        let omega_cross_d = line.define(Quantity::OmegaCrossD).by(omega.cross(d));
        // c̈_0 and the argument a need two names
        let c_ddot =
            line.define(Quantity::BaseAcceleration).by(of_origin + omega_dot.cross(d) + omega.cross(omega_cross_d));
        Self { turning, d, c_dot: at_rest, c_ddot, gravity }
    }

    /// Returns the motion of a floating base without accelerations: from its angular velocity, and the velocity of the
    /// origin of frame 0.
    pub(crate) fn of_twist(arm: &Arm<'s>, [origin, omega]: [Vector<'s>; 2]) -> Self {
        let nothing = arm.builder.zeros(Cause::NoAcceleration);
        let base = Self::of_base(arm, [omega, nothing, nothing], nothing);
        let line = arm.builder.joint(0);
        let c_dot = line.define(Quantity::Velocity).by(origin + omega.cross(base.d));
        Self { c_dot, ..base }
    }
}
