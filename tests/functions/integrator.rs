//! Runge-Kutta steps of random arms and trees, with code of both forms: beside the method of a textbook on the runtime,
//! and dual numbers through that. The compiled Euler step is among the functions of the other tests.

use rne::{
    AccelerationDerivatives, Dual, ForwardDynamics, ForwardDynamicsDerivatives, Numbers, RungeKuttaStep,
    RungeKuttaStepDerivatives, Scalar,
};
use rne_codegen::Function;
use rne_model::Robot;

use crate::arm::{Arm, Given, Maker};
use crate::arms;
use crate::check::{Worst, conditioning, error_on_scale};
use crate::tree_functions::State;
use crate::trees;

/// A robot whose number of joints is known.
struct Joints<'a, const DOF: usize>(&'a Arm);

fn given<T: Scalar>([q, qd, tau]: [&[T]; 3]) -> Given<'_, T> {
    // the accelerations are not used
    Given { tau, ..Given::of_joints(q, qd, qd) }
}

impl<const DOF: usize> ForwardDynamics<DOF> for Joints<'_, DOF> {
    fn forward_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF]) -> [T; DOF] {
        let of_code = self.0.of_code(Function::ForwardDynamics, &given([q, qd, tau]));
        let found = of_code.unwrap_or_else(|| self.0.runtime.forward_dynamics(q, qd, tau).expect("one per joint"));
        found.try_into().expect("one per joint")
    }
}

impl<const DOF: usize> ForwardDynamicsDerivatives<DOF> for Joints<'_, DOF> {
    fn forward_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
    ) -> AccelerationDerivatives<DOF, T> {
        let of_runtime = || {
            let found = self.0.runtime.forward_dynamics_derivatives(q, qd, tau).expect("one per joint");
            [found.dq, found.dqd, found.dtau].concat().concat()
        };
        let of_code = self.0.of_code(Function::ForwardDynamicsDerivatives, &given([q, qd, tau]));
        let found = of_code.unwrap_or_else(of_runtime);
        let block = |kind: usize| std::array::from_fn(|i| std::array::from_fn(|j| found[(kind * DOF + i) * DOF + j]));
        AccelerationDerivatives { dq: block(0), dqd: block(1), dtau: block(2) }
    }
}

/// x + h y
fn moved<T: Scalar>(x: &[T], y: &[T], step: T) -> Vec<T> {
    x.iter().zip(y).map(|(&x, &y)| x + step * y).collect()
}

/// The next positions and velocities by slopes of the whole state.
fn textbook<T: Scalar + Numbers<T>>(arm: &Arm, [q, qd, tau]: [&[T]; 3], step: T) -> Vec<T> {
    let state = [q, qd].concat();
    let slope = |x: &[T]| {
        let (q, qd) = x.split_at(q.len());
        [qd, &arm.numbers(Function::ForwardDynamics, &given([q, qd, tau]))].concat()
    };
    let number = |x: f64| T::from_f64(x);
    let first = slope(&state);
    let second = slope(&moved(&state, &first, step * number(0.5)));
    let third = slope(&moved(&state, &second, step * number(0.5)));
    let fourth = slope(&moved(&state, &third, step));
    let sum = moved(&moved(&moved(&first, &second, number(2.0)), &third, number(2.0)), &fourth, number(1.0));
    moved(&state, &sum, step / number(6.0))
}

/// The blocks of the derivatives of a step by dual numbers.
fn by_dual_numbers(state: [&[f64]; 3], step: impl Fn([&[Dual<f64>]; 3]) -> Vec<Dual<f64>>) -> Vec<f64> {
    let dof = state[0].len();
    let mut found = vec![0.0; 6 * dof * dof];
    for (kind, column) in (0..3).flat_map(|kind| (0..dof).map(move |column| (kind, column))) {
        let mut moving = state.map(|x| x.iter().copied().map(Dual::constant).collect::<Vec<_>>());
        moving[kind][column].derivative = 1.0;
        let next = step([&moving[0], &moving[1], &moving[2]]);
        for (row, number) in next.into_iter().enumerate() {
            found[((row / dof * 3 + kind) * dof + row % dof) * dof + column] = number.derivative;
        }
    }
    found
}

/// Compares the steps of a robot of at most five joints whose mass matrix is not nearly singular.
pub(crate) fn compare(runtime: &Arm, code: &[Arm], seed: u64, worst: &mut Worst) -> bool {
    match runtime.robot.dof() {
        1 => of_joints::<1>(runtime, code, seed, worst),
        2 => of_joints::<2>(runtime, code, seed, worst),
        3 => of_joints::<3>(runtime, code, seed, worst),
        4 => of_joints::<4>(runtime, code, seed, worst),
        5 => of_joints::<5>(runtime, code, seed, worst),
        _ => false,
    }
}

fn of_joints<const DOF: usize>(runtime: &Arm, code: &[Arm], seed: u64, worst: &mut Worst) -> bool {
    let State { q, qd, tau, .. } = State::random(seed, DOF);
    if conditioning(&runtime.mass_matrix(&q)).is_none_or(|of| of.number > 1e3) {
        return false;
    }
    let accelerations = runtime.forward_dynamics(&q, &qd, &tau);
    // a step after which the velocities are others, not numbers without measure
    let step = 0.5 / accelerations.iter().fold(10.0_f64, |largest, x| largest.max(x.abs()));
    let state: [&[f64]; 3] = [&q, &qd, &tau];
    let expected = textbook(runtime, state, step);
    let of_derivatives = by_dual_numbers(state, |x| textbook(runtime, x, Dual::constant(step)));
    let [q, qd, tau]: [[f64; DOF]; 3] = state.map(|x| x.try_into().expect("one per joint"));
    for arm in code {
        let robot = Joints::<DOF>(arm);
        let next = robot.runge_kutta_step(&q, &qd, &tau, step);
        worst.see("runge_kutta_step", error_on_scale(&[next.q, next.qd].concat(), &expected, 0.0));
        let by = robot.runge_kutta_step_derivatives(&q, &qd, &tau, step);
        let blocks = [by.q.dq, by.q.dqd, by.q.dtau, by.qd.dq, by.qd.dqd, by.qd.dtau];
        for (found, expected) in blocks.iter().zip(of_derivatives.chunks(DOF * DOF)) {
            worst.see("runge_kutta_step_derivatives", error_on_scale(found.as_flattened(), expected, 0.0));
        }
    }
    true
}

#[test]
fn steps_of_random_robots_are_those_of_the_textbook() {
    let (mut worst, mut compared) = (Worst::default(), 0);
    let arms = (0..260).map(|seed| (seed, Robot::from_yaml(&arms::yaml(seed)).expect("an arm")));
    let trees = (0..90).map(|seed| (seed, trees::random(seed, trees::dof(seed).min(5))));
    for (seed, robot) in arms.chain(trees) {
        let code = Maker::CODE.map(|maker| Arm::by_no_choice(&robot, maker));
        compared += usize::from(compare(&Arm::by_no_choice(&robot, Maker::Runtime), &code, seed, &mut worst));
    }
    println!("{compared} robots");
    assert!(compared >= 100, "{compared}");
    worst.at_most(1e-11, "random arms and trees");
}
