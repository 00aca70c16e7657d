//! The friction of a motor at its joint.

use rne_model::Motor;

/// The friction of a joint in the terms of a URDF.
pub(super) struct Friction {
    /// Viscous friction at the joint, N m s/rad or N s/m.
    pub(super) damping: f64,
    /// Coulomb friction at the joint, N m or N.
    pub(super) friction: f64,
}

impl Friction {
    /// Computes the friction at the joint, after the gear: G² B, and |G| Tc with the mean Tc of both directions; `None`
    /// where this overflows.
    pub(super) fn at_joint(motor: &Motor) -> Option<Self> {
        let Motor { gear_ratio, viscous, coulomb: [positive, negative], .. } = *motor;
        let mean = 0.5 * positive - 0.5 * negative;
        let (damping, friction) = (gear_ratio * gear_ratio * viscous, gear_ratio.abs() * mean);
        (damping.is_finite() && friction.is_finite()).then_some(Self { damping, friction })
    }

    /// Computes the friction at the joint; `None` without friction, or where it overflows.
    pub(super) fn of(motor: &Motor) -> Option<Self> {
        Self::at_joint(motor).filter(|at_joint| at_joint.damping != 0.0 || at_joint.friction != 0.0)
    }
}
