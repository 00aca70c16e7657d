//! Steps of integrators of a compiled arm are those of the runtime, and their derivatives are those of their functions.

use rne_machine::{CompiledArm, Form};
use rne_model::Robot;
use rne_runtime::DynArm;

fn close(found: &[f64], expected: &[f64]) {
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-11 * largest, "{found:e} {expected:e}");
    }
    assert_eq!(found.len(), expected.len());
}

#[test]
fn steps_are_those_of_the_runtime() {
    let yaml = rne_robots::find("ur5").expect("a robot").yaml;
    let arm = CompiledArm::from_yaml(yaml).expect("a robot");
    let runtime = DynArm::from_robot(&Robot::from_yaml(yaml).expect("a robot"));
    let (q, qd, tau) = ([0.3, -0.8, 0.9, 0.2, -0.4, 0.1], [0.5, -0.2, 0.3, 0.4, 0.1, -0.3], [1.0; 6]);
    let flat = |blocks: [Vec<Vec<f64>>; 6]| blocks.concat().concat();
    for form in [Form::SevenSteps, Form::Reduced] {
        let arm = arm.clone().in_form(form);
        let (found, expected) = (
            arm.euler_step(&q, &qd, &tau, 0.01).expect("six joints"),
            runtime.euler_step(&q, &qd, &tau, 0.01).expect("six joints"),
        );
        close(&[found.q, found.qd].concat(), &[expected.q, expected.qd].concat());
        let (found, expected) = (
            arm.runge_kutta_step(&q, &qd, &tau, 0.01).expect("six joints"),
            runtime.runge_kutta_step(&q, &qd, &tau, 0.01).expect("six joints"),
        );
        close(&[found.q, found.qd].concat(), &[expected.q, expected.qd].concat());
        let found = arm.euler_step_derivatives(&q, &qd, &tau, 0.01).expect("six joints");
        let expected = runtime.euler_step_derivatives(&q, &qd, &tau, 0.01).expect("six joints");
        close(
            &flat([found.q.dq, found.q.dqd, found.q.dtau, found.qd.dq, found.qd.dqd, found.qd.dtau]),
            &flat([expected.q.dq, expected.q.dqd, expected.q.dtau, expected.qd.dq, expected.qd.dqd, expected.qd.dtau]),
        );
        let found = arm.runge_kutta_step_derivatives(&q, &qd, &tau, 0.01).expect("six joints");
        let expected = runtime.runge_kutta_step_derivatives(&q, &qd, &tau, 0.01).expect("six joints");
        close(
            &flat([found.q.dq, found.q.dqd, found.q.dtau, found.qd.dq, found.qd.dqd, found.qd.dtau]),
            &flat([expected.q.dq, expected.q.dqd, expected.q.dtau, expected.qd.dq, expected.qd.dqd, expected.qd.dtau]),
        );
        assert!(arm.runge_kutta_step(&q[..5], &qd, &tau, 0.01).is_err());
        assert!(arm.runge_kutta_step_derivatives(&q, &qd, &tau[..5], 0.01).is_err());
    }
}
