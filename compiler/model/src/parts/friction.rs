//! Friction of a joint: viscous friction plus Coulomb friction, whose sign changes about a speed or over a
//! displacement.
//! ```text
//! f_v q̇ + ½ (f⁺ + f⁻) s + ½ (f⁺ - f⁻)
//! about a speed w:          s = q̇ / √(q̇² + w²)
//! over a displacement ℓ:    ds = (sgn dq - s) |dq| / ℓ
//! ```
//!
//! From -f⁻ to f⁺ it goes in proportion to s: half their difference is an offset, of a current or a sensor, that is
//! The Coulomb part is between -f⁻ and f⁺, linear in s. Half the difference of f⁺ and f⁻ is an offset, such as of a
//! current sensor, and is there at rest, too. Friction whose sign changes at once is zero at rest.
//!
//! The second s remembers where the joint reversed: bristles, teeth and belts deform before they slip, so a joint that
//! sticks or creeps may have any friction between f⁺ and -f⁻. This is Dahl's model, of exponent one (P. R. Dahl, A
//! solid friction model, Aerospace Corporation TOR-0158(3107-18)-1, 1968), exact between two samples where the joint
//! does not reverse between them.
use crate::{Joint, Motor};

/// Speed above which a joint is slipping at its first state, rad/s or m/s.
const SLIPPING: f64 = 0.05;

/// Whether Coulomb friction changes its sign about a speed or over a displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionTransition {
    /// About a speed, rad/s or m/s.
    Speed(f64),
    /// Over a displacement after the joint turned, rad or m.
    Displacement(f64),
}

impl FrictionTransition {
    /// Returns the transition that the robot file gives; without one, the sign changes at once.
    #[must_use]
    pub fn of(joint: &Joint) -> Self {
        let speed = Self::Speed(joint.coulomb_width.unwrap_or(0.0));
        joint.coulomb_displacement.map_or(speed, Self::Displacement)
    }
}

/// The friction of a joint along a sequence of states.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// Viscous coefficient, Coulomb friction and offset at the joint, N m s/rad and N m.
    parts: [f64; 3],
    sign: TransitionSign,
}

impl Friction {
    /// Makes the friction of a joint before its first state.
    #[must_use]
    pub fn of(joint: &Joint) -> Self {
        let motor = joint.motor.unwrap_or(Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.0, coulomb: [0.0; 2] });
        let ratio = motor.gear_ratio.abs();
        let [forward, backward] = motor.coulomb;
        let parts =
            [ratio * ratio * motor.viscous, 0.5 * ratio * (forward - backward), 0.5 * ratio * (forward + backward)];
        Self { parts, sign: TransitionSign::new(FrictionTransition::of(joint)) }
    }

    /// Returns the friction of a joint that has moved at a constant speed for long, N m or N.
    #[must_use]
    pub fn at(joint: &Joint, speed: f64) -> f64 {
        let mut friction = Self::of(joint);
        if matches!(friction.sign.transition, FrictionTransition::Displacement(_)) {
            friction.sign.transition = FrictionTransition::Speed(0.0);
        }
        friction.next(0.0, speed)
    }

    /// Returns the friction at the next state, given by a position and a speed, N m or N.
    pub fn next(&mut self, position: f64, speed: f64) -> f64 {
        let [viscous, coulomb, offset] = self.parts;
        let sign = self.sign.next(position, speed);
        let is_nowhere = speed == 0.0 && self.sign.transition == FrictionTransition::Speed(0.0);
        viscous * speed + coulomb * sign + if is_nowhere { 0.0 } else { offset }
    }
}

/// The smooth sign s of Coulomb friction, from -1 to 1, along a sequence of states.
#[derive(Clone, Copy, Debug)]
pub struct TransitionSign {
    transition: FrictionTransition,
    /// The position at the previous state, and the sign there.
    before: Option<(f64, f64)>,
}

impl TransitionSign {
    /// Makes the sign of a joint before its first state.
    #[must_use]
    pub fn new(transition: FrictionTransition) -> Self {
        Self { transition, before: None }
    }

    /// Returns the sign at the next state, given by a position and a speed.
    pub fn next(&mut self, position: f64, speed: f64) -> f64 {
        let length = match self.transition {
            FrictionTransition::Speed(width) => return smooth_sign(speed, width),
            FrictionTransition::Displacement(length) => length,
        };
        let sign = match self.before {
            None => smooth_sign(speed, SLIPPING),
            Some((last, sign)) if position == last => sign,
            Some((last, sign)) => {
                let moved = position - last;
                moved.signum() + (sign - moved.signum()) * (-moved.abs() / length).exp()
            }
        };
        self.before = Some((position, sign));
        sign
    }
}

/// Returns v / √(v² + width²); for the width 0 this is the sign of the speed.
fn smooth_sign(speed: f64, width: f64) -> f64 {
    if speed == 0.0 { 0.0 } else { speed / (speed * speed + width * width).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After a reversal the sign is 1 - 2 exp(-x / ℓ), however finely the motion is sampled.
    #[test]
    fn a_transition_takes_its_displacement() {
        for steps in [1, 10, 1000] {
            let mut sign = TransitionSign::new(FrictionTransition::Displacement(0.01));
            let mut last = 0.0;
            for k in 0..=100 {
                last = sign.next(-0.01 * f64::from(k), -1.0);
            }
            assert!((last + 1.0).abs() < 1e-12);
            for k in 1..=steps {
                last = sign.next(-1.0 + 0.02 * f64::from(k) / f64::from(steps), 0.1);
            }
            assert!((last - (1.0 - 2.0 * (-2.0_f64).exp())).abs() < 1e-9, "{last}");
        }
    }

    /// Friction is linear between its two limits; friction whose sign changes at once is zero at rest.
    #[test]
    fn friction_is_between_its_limits() {
        let mut joint = crate::Robot::from_yaml(ONE).unwrap().joints.remove(0);
        for (speed, wanted) in [(-1e9, -1.0), (-0.3, 1.0 - 2.0 * 0.6), (0.0, 1.0), (0.3, 1.0 + 2.0 * 0.6), (1e9, 3.0)] {
            assert!((Friction::of(&joint).next(0.0, speed) - wanted).abs() < 1e-12, "{speed}");
        }
        joint.coulomb_width = None;
        for (speed, wanted) in [(-0.1, -1.0), (0.0, 0.0), (0.1, 3.0)] {
            assert_eq!(Friction::of(&joint).next(0.0, speed), wanted);
        }
    }

    /// A joint with Coulomb friction of 3 N m forward and 1 N m backward, whose sign changes about 0.4 rad/s.
    const ONE: &str = "\
format: 1
name: one
source: made for this test
convention: standard
gravity: [0, 0, -9.81]
joints:
  - name: a
    type: revolute
    dh: {theta: 0, d: 0, a: 0, alpha: 0}
    link: {mass: 1}
    motor: {coulomb: [3, -1], coulomb_width: 0.4}
";

    #[test]
    fn what_stands_still_keeps_its_friction() {
        let mut sign = TransitionSign::new(FrictionTransition::Displacement(0.002));
        let begun = sign.next(0.3, 0.05);
        assert!((begun - 0.5_f64.sqrt()).abs() < 1e-15);
        assert_eq!(sign.next(0.3, 0.0), begun);
        assert_eq!(TransitionSign::new(FrictionTransition::Speed(0.0)).next(1.0, -3.0), -1.0);
    }
}
