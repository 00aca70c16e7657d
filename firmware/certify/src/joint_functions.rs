//! Computes the optional functions of emitted C for friction of the joints and limits of their torques: in single
//! precision, as the code does, and exactly.

use rne_emit::JointFriction;
use rne_model::{JointKind, Robot};

use crate::accuracy::{self, Error, Sample, largest_errors, single};
use crate::board::{self, Call};
use crate::interval::Interval;

/// An optional function of emitted C.
#[derive(Clone, Debug, PartialEq)]
pub enum JointFunction {
    /// `friction_torques`, a function of the speeds.
    Friction(Vec<JointFriction>),
    /// `friction_derivatives`, a function of the speeds.
    FrictionDerivatives(Vec<JointFriction>),
    /// `limit_torques`, a function of torques, with the effort limits of the joints, N m or N.
    Limits(Vec<Option<f64>>),
}

/// Largest torque that is tried, as a multiple of the effort limit.
pub const BEYOND: f64 = 2.0;

impl JointFunction {
    /// Makes `limit_torques` of an arm.
    #[must_use]
    pub fn limits(robot: &Robot) -> Self {
        Self::Limits(robot.independent_joints().map(|joint| joint.limits.effort).collect())
    }

    /// Returns the name in the code, without the prefix.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Friction(_) => "friction_torques",
            Self::FrictionDerivatives(_) => "friction_derivatives",
            Self::Limits(_) => "limit_torques",
        }
    }

    /// Returns the name of the result in the code.
    #[must_use]
    pub const fn result(&self) -> &'static str {
        match self {
            Self::Friction(_) => "friction",
            Self::FrictionDerivatives(_) => "derivatives",
            Self::Limits(_) => "limited",
        }
    }

    /// Returns the unit of the result for a kind of joint.
    #[must_use]
    pub const fn unit(&self, kind: JointKind) -> &'static str {
        match (self, kind) {
            (Self::FrictionDerivatives(_), JointKind::Revolute) => "N m s/rad",
            (Self::FrictionDerivatives(_), JointKind::Prismatic) => "N s/m",
            _ => kind.effort_unit(),
        }
    }

    /// Returns the static function of the C file that this function may call, without the prefix.
    #[must_use]
    pub const fn helper(&self) -> &'static str {
        match self {
            Self::Friction(_) | Self::FrictionDerivatives(_) => "inverse_root",
            Self::Limits(_) => "limited",
        }
    }

    /// Returns the call at a state of the board. Friction takes the speeds of the state; limits take its accelerations,
    /// multiplied by the limits, as torques.
    #[must_use]
    pub fn call(&self, prefix: &str, dof: usize) -> Call {
        let function = format!("{prefix}_{}", self.name());
        let Self::Limits(limits) = self else { return Call::of_arrays(&function, &["qd"], dof) };
        let torques = limits.iter().enumerate().map(|(joint, limit)| match limit {
            Some(limit) => format!("s->qdd[{joint}] * {:?}f", single(*limit)),
            None => format!("s->qdd[{joint}]"),
        });
        let before = vec![format!("const float tau[{dof}] = {{{}}};", torques.collect::<Vec<_>>().join(", "))];
        let arguments = vec![("const float *".to_owned(), "tau".to_owned())];
        Call { arguments, before, ..Call::new(function, dof) }
    }

    /// Returns the numbers that [`call`](Self::call) must write at a state.
    #[must_use]
    pub fn result_at(&self, number: u32, dof: usize) -> Vec<f32> {
        let [_, qd, qdd] = board::state(number, dof);
        match self {
            Self::Friction(_) | Self::FrictionDerivatives(_) => self.in_single_precision(&qd),
            Self::Limits(limits) => {
                let torques = qdd.iter().zip(limits).map(|(x, limit)| limit.map_or(*x, |limit| x * single(limit)));
                self.in_single_precision(&torques.collect::<Vec<_>>())
            }
        }
    }

    /// Returns the errors at random speeds within the limits, or at random torques up to [`BEYOND`] times the limits.
    #[must_use]
    pub fn errors(&self, robot: &Robot, sample: Sample) -> Option<Vec<Error>> {
        let ranges = accuracy::ranges(robot);
        largest_errors(sample, robot.dof(), |_, rng| {
            let largest = ranges.iter().map(|range| match self {
                Self::Friction(_) | Self::FrictionDerivatives(_) => range.velocity,
                Self::Limits(_) => BEYOND * range.torque,
            });
            let arguments: Vec<f32> = largest.map(|largest| single((2.0 * rng.f64() - 1.0) * largest)).collect();
            Some((self.in_single_precision(&arguments), self.exactly(&arguments)))
        })
    }

    fn in_single_precision(&self, arguments: &[f32]) -> Vec<f32> {
        match self {
            Self::Friction(frictions) => {
                let torque = |(law, qd): (&JointFriction, &f32)| law.torque_in(*qd, single, inverse_root);
                frictions.iter().zip(arguments).map(torque).collect()
            }
            Self::FrictionDerivatives(frictions) => {
                let derivative = |(law, qd): (&JointFriction, &f32)| law.derivative_in(*qd, single, inverse_root);
                frictions.iter().zip(arguments).map(derivative).collect()
            }
            Self::Limits(limits) => {
                // a limit that is infinite in single precision has no effect
                let limited = |(limit, tau): (&Option<f64>, &f32)| {
                    limit.map_or(*tau, |limit| tau.clamp(-single(limit), single(limit)))
                };
                limits.iter().zip(arguments).map(limited).collect()
            }
        }
    }

    fn exactly(&self, arguments: &[f32]) -> Vec<Interval> {
        let arguments = arguments.iter().map(|&x| Interval::exactly(f64::from(x)));
        match self {
            Self::Friction(frictions) => {
                let torque = |(law, qd): (&JointFriction, Interval)| {
                    law.torque_in(qd, Interval::exactly, Interval::inverse_root)
                };
                frictions.iter().zip(arguments).map(torque).collect()
            }
            Self::FrictionDerivatives(frictions) => {
                let derivative = |(law, qd): (&JointFriction, Interval)| {
                    law.derivative_in(qd, Interval::exactly, Interval::inverse_root)
                };
                frictions.iter().zip(arguments).map(derivative).collect()
            }
            Self::Limits(limits) => {
                limits.iter().zip(arguments).map(|(limit, tau)| limit.map_or(tau, |limit| tau.limited(limit))).collect()
            }
        }
    }
}

/// Returns 1/√x with the operations of the code in single precision.
fn inverse_root(x: f32) -> f32 {
    let h = 0.5 * x;
    let mut y = f32::from_bits(0x5f37_5a86_u32.wrapping_sub(x.to_bits() >> 1));
    for _ in 0..3 {
        y *= 1.5 - (h * y) * y;
    }
    y
}

#[cfg(test)]
mod tests {
    use rne_model::Robot;

    use super::{JointFriction, JointFunction};
    use crate::accuracy::{Sample, single};

    /// A prismatic joint with a viscous friction of 0.5 N s/m, Coulomb friction of 3 N forward and 2 N backward, and an
    /// effort limit of 7.3 N.
    const SLIDER: &str = "{format: 1, name: one, source: doc, convention: standard, gravity: [0, 0, 0], joints: [
        {type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}, limits: {effort: 7.3, velocity: 4},
         motor: {viscous: 0.5, coulomb: [3, -2], coulomb_width: 0.01}}]}";
    const SAMPLE: Sample = Sample { states: 2000, seed: 1 };
    const ROUNDING: f64 = 1.0 / 16_777_216.0;

    #[test]
    fn friction_is_that_of_the_law_and_its_bound_that_of_single_precision() {
        let robot = Robot::from_yaml(SLIDER).expect("a robot");
        let friction = JointFunction::Friction(JointFriction::of(&robot).expect("friction"));
        // calculated by hand, far from rest: 0.5 4 + 3 forward, and -0.5 4 - 2 backward
        for (qd, expected) in [(4.0, 5.0), (-4.0, -4.0), (0.0, 0.0)] {
            let found = f64::from(friction.in_single_precision(&[qd])[0]);
            assert!((found - expected).abs() < 3e-5, "{found} at {qd}");
            let exact = friction.exactly(&[qd])[0];
            assert!(exact.farthest(expected) < 3e-5 && exact.high - exact.low < 1e-14, "{exact:?} at {qd}");
        }
        let error = friction.errors(&robot, SAMPLE).expect("errors")[0];
        assert!(error.largest > 4.9 && error.largest < 5.0, "{error:?}");
        // several rounding errors of the largest friction, and more than two
        assert!(error.bound > 2.0 * ROUNDING && error.bound < 8.0 * 5.0 * ROUNDING, "{error:?}");
    }

    #[test]
    fn the_derivative_of_friction_is_that_of_the_law() {
        let robot = Robot::from_yaml(SLIDER).expect("a robot");
        let law = JointFriction::of(&robot).expect("friction");
        let derivatives = JointFunction::FrictionDerivatives(law.clone());
        // calculated by hand: at rest, 0.5 + (3 + 2) / 2 / 0.01; far from rest, 0.5 + (2.5 ± 1) 0.01² / |4|³
        for (qd, expected) in [(0.0, 250.5), (4.0, 0.5 + 3.5e-4 / 64.0), (-4.0, 0.5 + 1.5e-4 / 64.0)] {
            let found = f64::from(derivatives.in_single_precision(&[qd])[0]);
            assert!((found - expected).abs() < 1e-6 * expected, "{found} at {qd}");
        }
        for qd in [-0.02, -0.003, 0.001, 0.01, 0.05] {
            let slope = (law[0].torque(qd + 1e-6) - law[0].torque(qd - 1e-6)) / 2e-6;
            let exact = derivatives.exactly(&[single(qd)])[0];
            assert!(exact.farthest(slope) < 1e-5 * 250.0 && exact.high - exact.low < 1e-11, "{exact:?} at {qd}");
        }
        let error = derivatives.errors(&robot, SAMPLE).expect("errors")[0];
        assert!(error.largest > 0.5 && error.bound < 20.0 * 250.0 * ROUNDING, "{error:?}");
    }

    #[test]
    fn limits_cut_and_err_by_the_rounding_of_the_limit() {
        let robot = Robot::from_yaml(SLIDER).expect("a robot");
        let limits = JointFunction::limits(&robot);
        let found: Vec<f32> = [9.0, -8.0, 7.25].map(|tau| limits.in_single_precision(&[tau])[0]).to_vec();
        assert_eq!(found, [7.3, -7.3, 7.25]);
        let error = limits.errors(&robot, SAMPLE).expect("errors")[0];
        // the float nearest to 7.3 is 7.300000190734863
        assert!((error.bound - 1.907_348_63e-7).abs() < 1e-14, "{error:?}");
        assert!((error.largest - 7.3).abs() < 1e-6, "{error:?}");
    }
}
