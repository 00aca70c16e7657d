//! The friction of a joint as a function of its speed.

use std::fmt;

use rne_codegen::Real;
use rne_model::{Entry, Joint, Robot};

/// Friction of a joint: viscous q̇ + odd s + even s², with s = q̇ / √(q̇² + width²).
///
/// It is the friction of `actuator_torques_smooth` of the runtime: |G| (½ (Tc⁺ - Tc⁻) s + ½ (Tc⁺ + Tc⁻) s²) + G² B q̇.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointFriction {
    /// Viscous friction, N m s/rad or N s/m.
    pub(super) viscous: f64,
    /// N m or N: half of the difference of forward and backward Coulomb friction.
    pub(super) odd: f64,
    /// N m or N: half of the sum of both.
    pub(super) even: f64,
    /// The speed at which s is 0.7, rad/s or m/s.
    pub(super) width: f64,
}

/// Why the friction of a robot cannot be computed from the speeds of its joints.
#[derive(Clone, Debug, PartialEq)]
pub enum NoFriction {
    /// No joint has friction.
    Nowhere,
    /// The joint has Coulomb friction, but no width of speeds in which it changes its sign.
    NoWidth(String),
    /// The width of the joint is so small that its square is zero in single precision.
    NarrowWidth(String, f64),
    /// The friction of the joint changes its sign over a displacement, so it is no function of the speed.
    Displacement(String),
    /// The friction of the joint depends on a parameter that is given at run time.
    RunTime(String),
}

impl JointFriction {
    /// The smallest width, rad/s or m/s.
    pub const NARROWEST: f64 = 1e-9;

    /// Returns the friction of the joints from base to tip.
    ///
    /// # Errors
    /// When no joint has friction, or when the friction of a joint cannot be computed from its speed alone.
    pub fn of(robot: &Robot) -> Result<Vec<Self>, NoFriction> {
        let frictions = Self::about(robot, None)?;
        if frictions.iter().all(|friction| friction.viscous == 0.0 && friction.odd == 0.0) {
            return Err(NoFriction::Nowhere);
        }
        Ok(frictions)
    }

    /// Returns the friction of the joints from base to tip, zero for a joint that has none. Coulomb friction changes
    /// its sign within `width`, rad/s or m/s, around zero speed; without `width`, within the `coulomb_width` of each
    /// joint. A `width` must be at least [`NARROWEST`](Self::NARROWEST).
    ///
    /// # Errors
    /// When the friction of a joint cannot be computed from its speed alone.
    pub fn about(robot: &Robot, width: Option<f64>) -> Result<Vec<Self>, NoFriction> {
        robot.coordinates().map(|index| Self::of_joint(robot, index, &robot.joints[index], width)).collect()
    }

    /// Returns the numbers viscous, odd, even and width of the formula.
    #[must_use]
    pub fn numbers(&self) -> [f64; 4] {
        [self.viscous, self.odd, self.even, self.width]
    }

    /// Returns the friction at a speed, N m or N.
    #[must_use]
    pub fn torque(&self, qd: f64) -> f64 {
        self.torque_in(qd, |number| number, |x| 1.0 / x.sqrt())
    }

    /// Returns the friction at a speed in another number type, with the same operations as the emitted code in the same
    /// order. `number` converts to this type, and `inverse_root` returns 1/√x.
    pub fn torque_in<T: Real>(&self, qd: T, number: impl Fn(f64) -> T, inverse_root: impl Fn(T) -> T) -> T {
        let viscous = (self.viscous != 0.0).then(|| number(self.viscous) * qd);
        let coulomb = (self.odd != 0.0).then(|| {
            let s = qd * inverse_root(qd * qd + number(self.width * self.width));
            let odd = number(self.odd) * s;
            if self.even == 0.0 { odd } else { odd + number(self.even) * (s * s) }
        });
        match (viscous, coulomb) {
            (Some(viscous), Some(coulomb)) => viscous + coulomb,
            (one, other) => one.or(other).unwrap_or_else(|| number(0.0)),
        }
    }

    /// Returns the derivative of the friction with respect to the speed, N m s/rad or N s/m.
    #[must_use]
    pub fn derivative(&self, qd: f64) -> f64 {
        self.derivative_in(qd, |number| number, |x| 1.0 / x.sqrt())
    }

    /// Returns the derivative of the friction with respect to the speed, viscous + (odd + 2 even s) width² r³ with r =
    /// 1/√(q̇² + width²), in another number type, as [`torque_in`](Self::torque_in) does for the friction.
    pub fn derivative_in<T: Real>(&self, qd: T, number: impl Fn(f64) -> T, inverse_root: impl Fn(T) -> T) -> T {
        let viscous = (self.viscous != 0.0).then(|| number(self.viscous));
        let coulomb = (self.odd != 0.0).then(|| {
            let square = number(self.width * self.width);
            let r = inverse_root(qd * qd + square);
            let slope = square * r * r * r;
            let odd = number(self.odd);
            if self.even == 0.0 { odd * slope } else { (odd + number(2.0 * self.even) * (qd * r)) * slope }
        });
        match (viscous, coulomb) {
            (Some(viscous), Some(coulomb)) => viscous + coulomb,
            (one, other) => one.or(other).unwrap_or_else(|| number(0.0)),
        }
    }

    fn of_joint(robot: &Robot, index: usize, joint: &Joint, width: Option<f64>) -> Result<Self, NoFriction> {
        let Some(motor) = joint.motor else { return Ok(Self { viscous: 0.0, odd: 0.0, even: 0.0, width: 1.0 }) };
        let name = || joint.name.clone();
        let entries = [
            Entry::GearRatio(index),
            Entry::Viscous(index),
            Entry::CoulombPositive(index),
            Entry::CoulombNegative(index),
        ];
        if entries.into_iter().any(|entry| robot.run_time.formula(entry).is_some()) {
            return Err(NoFriction::RunTime(name()));
        }
        let ratio = motor.gear_ratio.abs();
        let [forward, backward] = motor.coulomb.map(|friction| ratio * friction);
        let width = match width.or(joint.coulomb_width) {
            _ if forward == 0.0 && backward == 0.0 => 1.0,
            _ if width.is_none() && joint.coulomb_displacement.is_some() => {
                return Err(NoFriction::Displacement(name()));
            }
            None => return Err(NoFriction::NoWidth(name())),
            Some(width) if width < Self::NARROWEST => return Err(NoFriction::NarrowWidth(name(), width)),
            Some(width) => width,
        };
        let viscous = ratio * ratio * motor.viscous;
        Ok(Self { viscous, odd: 0.5 * (forward - backward), even: 0.5 * (forward + backward), width })
    }
}

impl fmt::Display for NoFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nowhere => f.write_str(
                "no joint has friction; write it in `motor` of the joint: `motor: {viscous: 0.4, coulomb: [0.5, -0.5], \
                 coulomb_width: 0.02}`",
            ),
            Self::NoWidth(joint) => write!(
                f,
                "the joint {joint} has Coulomb friction without `coulomb_width`; write the speed about which the \
                 friction changes its sign in `motor` of the joint, for example `coulomb_width: 0.02` (rad/s or m/s)"
            ),
            Self::NarrowWidth(joint, width) => {
                let narrowest = JointFriction::NARROWEST;
                write!(
                    f,
                    "the joint {joint} has `coulomb_width: {width}`; the smallest width for this function is \
                     {narrowest:e} rad/s or m/s"
                )
            }
            Self::Displacement(joint) => write!(
                f,
                "the joint {joint} has `coulomb_displacement`: its friction depends on the way since the last \
                 reversal, and the function knows only the speed; write `coulomb_width` instead"
            ),
            Self::RunTime(joint) => {
                write!(f, "the friction of the joint {joint} depends on a parameter that is given at run time")
            }
        }
    }
}

impl std::error::Error for NoFriction {}
