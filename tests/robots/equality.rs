//! The heart of it: generated code computes what the generic runtime computes, bit for bit.
//!
//! 10,000 states of each robot with `RNE_EXHAUSTIVE` set, as `cargo xtask verify` does; else some hundreds.

use fastrand::Rng;
use rne::{InverseDynamics, Scalar};

use crate::shipped::seven_steps::visit_all;
use crate::shipped::{Shipped, Visitor};
use crate::states::{self, State};

struct Equality;

impl Visitor for Equality {
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R) {
        let arm = R::arm();
        let mut rng = Rng::with_seed(38);
        let mut differing = 0;
        let states = states::count();
        for index in 0..states {
            let State { q, qd, qdd, wrench } = states::any::<DOF, R>(&mut rng, index);
            let turns = q.map(Scalar::sin_cos);
            let (sin, cos) = (turns.map(|turn| turn.0), turns.map(|turn| turn.1));
            let equal = [
                (
                    robot.inverse_dynamics_from_sin_cos(&sin, &cos, &q, &qd, &qdd),
                    arm.inverse_dynamics_from_sin_cos(&sin, &cos, &q, &qd, &qdd),
                ),
                (robot.inverse_dynamics(&q, &qd, &qdd), arm.inverse_dynamics(&q, &qd, &qdd)),
                (
                    robot.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench),
                    arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench),
                ),
                (robot.gravity_torques(&q), arm.gravity_torques(&q)),
                (robot.bias_torques(&q, &qd), arm.bias_torques(&q, &qd)),
            ]
            .iter()
            .all(|(generated, runtime)| generated == runtime && generated.iter().all(|torque| torque.is_finite()));
            differing += usize::from(!equal);
        }
        println!("{:16} {differing} of {states} states differ", R::NAME);
        assert_eq!(differing, 0, "{}", R::NAME);
    }
}

#[test]
fn generated_code_equals_the_runtime_in_every_bit() {
    visit_all(&mut Equality);
}
