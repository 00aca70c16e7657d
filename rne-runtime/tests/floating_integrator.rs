//! A step of a robot with a floating base: its derivatives beside dual numbers through the step, the turn of the
//! base beside the exponential, and conserved momentum.

use std::array::from_fn;

use crate::common::{Numbers, SIX_BASE, assert_close, link, six_joints};
use rne_model::Convention::{Modified, Standard};
use rne_runtime::{
    Arm, ArmWithTips, BaseAcceleration, BaseMotion, BaseTwist, CentroidalMomentum, Dual, FloatingAccelerations,
    FloatingBase, FloatingEulerStep, FloatingEulerStepDerivatives, FloatingIntegratorStep, FloatingNextState,
    FloatingRungeKuttaStepDerivatives, FloatingState, FloatingStepDerivatives, FloatingTorques, Pose, Quaternion,
    Scalar, Wrench,
};

const DOF: usize = 6;
const NV: usize = 12;
const GRAVITY: [f64; 3] = [0.4, -0.3, -9.7];

type State<T> = FloatingState<DOF, T>;

/// Arms on a floating trunk, without tips.
fn arms() -> [Arm<DOF>; 2] {
    let trunk = link(5.0, [0.02, -0.03, 0.05], [0.08, 0.09, 0.06, 0.004, -0.003, 0.002]);
    [Standard, Modified].map(|convention| Arm::new(six_joints(convention)).with_floating_base(trunk))
}

type Floating<'a> = ArmWithTips<'a, DOF, NV, 0>;

fn state(numbers: &mut Numbers) -> State<f64> {
    let turn: [f64; 3] = numbers.array(2.0);
    FloatingState {
        orientation: Quaternion::identity().turned_by(turn),
        position: numbers.array(1.0),
        twist: BaseTwist { linear: numbers.array(2.0), angular: numbers.array(3.0) },
        q: numbers.array(3.0),
        qd: numbers.array(2.0),
    }
}

fn constant(x: &[f64]) -> Vec<Dual<f64>> {
    x.iter().copied().map(Dual::constant).collect()
}

fn of<const N: usize>(x: &[Dual<f64>]) -> [Dual<f64>; N] {
    x.try_into().unwrap_or_else(|_| unreachable!("as many"))
}

/// The state as it moves along one of the directions of positions and velocities.
fn along(state: &State<f64>, direction: usize) -> State<Dual<f64>> {
    let rate = |first: usize, count: usize| -> Vec<f64> {
        (first..first + count).map(|at| f64::from(u8::from(at == direction))).collect()
    };
    let moving = |x: &[f64], first: usize| -> Vec<Dual<f64>> {
        let rates = rate(first, x.len());
        x.iter().zip(rates).map(|(&value, derivative)| Dual { value, derivative }).collect()
    };
    let rotation = state.orientation.rotation();
    let shift = rate(0, 3);
    let position: Vec<Dual<f64>> = (0..3)
        .map(|row| {
            let derivative = (0..3).map(|at| rotation[row][at] * shift[at]).sum();
            Dual { value: state.position[row], derivative }
        })
        .collect();
    let turn = rate(3, 3);
    let half = |at: usize| Dual { value: 0.0, derivative: turn[at] / 2.0 };
    let turn = Quaternion { w: Dual::constant(1.0), x: half(0), y: half(1), z: half(2) };
    let orientation = Quaternion::from_wxyz(of(&constant(&state.orientation.to_wxyz())));
    FloatingState {
        orientation: orientation.then(&turn),
        position: of(&position),
        twist: BaseTwist {
            linear: of(&moving(&state.twist.linear, NV)),
            angular: of(&moving(&state.twist.angular, NV + 3)),
        },
        q: of(&moving(&state.q, 6)),
        qd: of(&moving(&state.qd, NV + 6)),
    }
}

/// The changes of positions and velocities of a state.
fn change(state: &State<Dual<f64>>) -> [[f64; NV]; 2] {
    let [w, x, y, z] = state.orientation.to_wxyz();
    let back = Quaternion { w: w.value, x: -x.value, y: -y.value, z: -z.value };
    let rate = Quaternion { w: w.derivative, x: x.derivative, y: y.derivative, z: z.derivative };
    let [scalar, turn @ ..] = back.then(&rate).to_wxyz();
    assert!(scalar.abs() < 1e-13, "the length of the quaternion stays: {scalar:e}");
    let back = back.rotation();
    let origin: [f64; 3] = from_fn(|row| (0..3).map(|at| back[row][at] * state.position[at].derivative).sum());
    let derivatives = |x: &[Dual<f64>]| x.iter().map(|x| x.derivative).collect::<Vec<_>>();
    let positions = [&origin[..], &turn.map(|x| 2.0 * x), &derivatives(&state.q)].concat();
    let velocities =
        [derivatives(&state.twist.linear), derivatives(&state.twist.angular), derivatives(&state.qd)].concat();
    [positions, velocities].map(|x| x.try_into().unwrap_or_else(|_| unreachable!("NV")))
}

#[test]
fn derivatives_are_those_by_dual_numbers() {
    let mut numbers = Numbers::new(81);
    for arm in &arms() {
        let arm: Floating<'_> = arm.with_tips(&[]);
        for round in 0..6 {
            let mut state = state(&mut numbers);
            if round == 0 {
                // the turn is smooth there
                state.twist.angular = [0.0; 3];
            }
            let tau: [f64; DOF] = numbers.array(5.0);
            let step = 0.05;
            let State { orientation, position, twist, q, qd } = state;
            let pose = Pose { rotation: orientation.rotation(), translation: position };
            let found = arm.floating_euler_step_derivatives(&q, &qd, &tau, &pose, &twist, step, &[]);
            are_those_of(&found, (&arm, &state, &tau, step), |arm, state, tau, wrenches, gravity, step| {
                arm.floating_quaternion_step(state, tau, wrenches, gravity, step)
            });
            let found = arm.floating_runge_kutta_step_derivatives(&state, &tau, &[], &SIX_BASE.gravity, step);
            are_those_of(&found, (&arm, &state, &tau, step), |arm, state, tau, wrenches, gravity, step| {
                arm.floating_runge_kutta_step(state, tau, wrenches, gravity, step)
            });
        }
    }
}

/// A step over dual numbers.
type Step = fn(
    &Floating,
    &State<Dual<f64>>,
    &[Dual<f64>; DOF],
    &[Wrench<Dual<f64>>; 0],
    &[Dual<f64>; 3],
    Dual<f64>,
) -> State<Dual<f64>>;

/// Compares the derivatives of a step with dual numbers through it.
fn are_those_of(
    found: &FloatingStepDerivatives<DOF, NV, f64>,
    (arm, state, tau, step): (&Floating, &State<f64>, &[f64; DOF], f64),
    next: Step,
) {
    let by = |direction: usize| {
        let tau =
            from_fn(|joint| Dual { value: tau[joint], derivative: f64::from(u8::from(direction == 2 * NV + joint)) });
        let (gravity, step) = (SIX_BASE.gravity.map(Dual::constant), Dual::constant(step));
        change(&next(arm, &along(state, direction), &tau, &[], &gravity, step))
    };
    for (part, [by_positions, by_velocities]) in
        [[&found.q_dq, &found.q_dv], [&found.v_dq, &found.v_dv]].into_iter().enumerate()
    {
        let expected: [[[f64; NV]; NV]; 2] = from_fn(|kind| {
            let columns: Vec<[f64; NV]> = (0..NV).map(|at| by(kind * NV + at)[part]).collect();
            from_fn(|row| from_fn(|column| columns[column][row]))
        });
        assert_close("by positions", by_positions.as_flattened(), expected[0].as_flattened());
        assert_close("by velocities", by_velocities.as_flattened(), expected[1].as_flattened());
    }
    let columns: Vec<_> = (0..DOF).map(|joint| by(2 * NV + joint)).collect();
    for (part, found) in [&found.q_dtau, &found.v_dtau].into_iter().enumerate() {
        let expected: [[f64; DOF]; NV] = from_fn(|row| from_fn(|joint| columns[joint][part][row]));
        assert_close("by torques", found.as_flattened(), expected.as_flattened());
    }
}

/// In free flight without gravity, with a turn of exactly the angle h |ω|.
#[test]
fn the_base_turns_by_the_exponential_to_third_order() {
    let mut numbers = Numbers::new(82);
    let [arm, _] = arms();
    let arm: Floating<'_> = arm.with_tips(&[]);
    let state = state(&mut numbers);
    let tau: [f64; DOF] = numbers.array(5.0);
    let error = |step: f64| {
        let next =
            FloatingIntegratorStep::<DOF, NV, 0>::floating_quaternion_step(&arm, &state, &tau, &[], &GRAVITY, step);
        let expected = state.orientation.turned_by(next.twist.angular.map(|x| x * step));
        let pairs = next.orientation.to_wxyz().into_iter().zip(expected.to_wxyz());
        let length: f64 = next.orientation.to_wxyz().iter().map(|x| x * x).sum();
        assert!((length - 1.0).abs() < 1e-15, "{length}");
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let order = (error(0.02) / error(0.01)).log2();
    assert!((order - 3.0).abs() < 0.2, "{order}");
}

#[test]
fn momentum_is_conserved_to_the_order_of_the_method() {
    let mut numbers = Numbers::new(83);
    for arm in &arms() {
        let arm: Floating<'_> = arm.with_tips(&[]);
        let start = state(&mut numbers);
        let tau: [f64; DOF] = numbers.array(1.0);
        // about the centre of mass, in world axes
        let momentum = |state: &State<f64>| -> [f64; 6] {
            let matrix: [[f64; NV]; 6] = arm.centroidal_momentum_matrix(&state.q);
            let velocities = [&state.twist.linear[..], &state.twist.angular, &state.qd].concat();
            let found = matrix.map(|row| row.iter().zip(&velocities).map(|(a, v)| a * v).sum::<f64>());
            let rotation = state.orientation.rotation();
            from_fn(|at| (0..3).map(|k| rotation[at % 3][k] * found[at / 3 * 3 + k]).sum())
        };
        let mass = 5.0 + 4.0 + 3.0 + 2.0 + 1.5 + 1.0 + 0.5;
        let error = |steps: u32| {
            let time = 0.1;
            let end = (0..steps).fold(start, |state, _| {
                FloatingIntegratorStep::<DOF, NV, 0>::floating_quaternion_step(
                    &arm,
                    &state,
                    &tau,
                    &[],
                    &GRAVITY,
                    time / f64::from(steps),
                )
            });
            let (before, after) = (momentum(&start), momentum(&end));
            let weight = |at: usize| if at < 3 { mass * GRAVITY[at] * time } else { 0.0 };
            (0..6).map(|at| (after[at] - before[at] - weight(at)).abs()).fold(0.0, f64::max)
        };
        let order = (error(200) / error(400)).log2();
        println!("order {order:.3}");
        assert!((order - 1.0).abs() < 0.1, "{order}");
    }
}

/// The step with a rotation matrix is that with a quaternion, over many steps.
#[test]
fn the_step_with_a_matrix_is_that_with_a_quaternion() {
    let mut numbers = Numbers::new(85);
    for arm in &arms() {
        let arm: Floating<'_> = arm.with_tips(&[]);
        let mut with_quaternion = state(&mut numbers);
        let tau: [f64; DOF] = numbers.array(1.0);
        let State { orientation, position, twist, q, qd } = with_quaternion;
        let pose = Pose { rotation: orientation.rotation(), translation: position };
        let mut with_matrix = FloatingNextState { pose, twist, q, qd };
        for _ in 0..100 {
            with_quaternion = FloatingIntegratorStep::<DOF, NV, 0>::floating_quaternion_step(
                &arm,
                &with_quaternion,
                &tau,
                &[],
                &SIX_BASE.gravity,
                0.001,
            );
            let FloatingNextState { pose, twist, q, qd } = with_matrix;
            with_matrix = arm.floating_euler_step(&q, &qd, &tau, &pose, &twist, 0.001, &[]);
        }
        let rotation = with_quaternion.orientation.rotation();
        assert_close("rotation", with_matrix.pose.rotation.as_flattened(), rotation.as_flattened());
        assert_close("origin", &with_matrix.pose.translation, &with_quaternion.position);
        assert_close("velocity", &with_matrix.twist.linear, &with_quaternion.twist.linear);
        assert_close("angular velocity", &with_matrix.twist.angular, &with_quaternion.twist.angular);
        assert_close("positions", &with_matrix.q, &with_quaternion.q);
        assert_close("velocities", &with_matrix.qd, &with_quaternion.qd);
    }
}

/// The error of all numbers of a state falls by 16 where the step halves.
#[test]
fn the_runge_kutta_step_is_of_fourth_order() {
    let mut numbers = Numbers::new(84);
    for arm in &arms() {
        let arm: Floating<'_> = arm.with_tips(&[]);
        let start = state(&mut numbers);
        let tau: [f64; DOF] = numbers.array(1.0);
        let after = |steps: u32| {
            (0..steps).fold(start, |state, _| {
                let step = 0.04 / f64::from(steps);
                FloatingIntegratorStep::<DOF, NV, 0>::floating_runge_kutta_step(&arm, &state, &tau, &[], &GRAVITY, step)
            })
        };
        let all = |state: &State<f64>| {
            let twist = [state.twist.linear, state.twist.angular].concat();
            [&state.orientation.to_wxyz()[..], &state.position, &twist, &state.q, &state.qd].concat()
        };
        let exact = all(&after(100));
        let error = |steps: u32| all(&after(steps)).iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let order = (error(10) / error(20)).log2();
        println!("order {order:.3}, error {:.1e}", error(20));
        assert!((order - 4.0).abs() < 0.3, "{order}");
        // semi-implicit Euler tends to the same motion
        let euler = (0..1000).fold(start, |state, _| {
            FloatingIntegratorStep::<DOF, NV, 0>::floating_quaternion_step(
                &arm,
                &state,
                &tau,
                &[],
                &GRAVITY,
                0.04 / 1000.0,
            )
        });
        let difference = all(&euler).iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("semi-implicit Euler: {difference:.1e}");
        assert!(difference < 4e-2, "{difference}");
    }
}

/// A symmetric top without torques: its axis and its angular velocity turn about the momentum at constant rates.
#[test]
fn a_free_symmetric_top_precesses() {
    let (across, along) = (0.08, 0.05);
    let top = Top { across, along };
    let spin = [0.6, 0.0, 4.0];
    let start = FloatingState {
        orientation: Quaternion::identity(),
        position: [0.0; 3],
        twist: BaseTwist { linear: [0.3, -0.2, 0.1], angular: spin },
        q: [],
        qd: [],
    };
    let (time, steps) = (1.0, 200);
    let end = (0..steps).fold(start, |state, _| {
        let step = time / f64::from(steps);
        FloatingIntegratorStep::<0, 6, 0>::floating_runge_kutta_step(&top, &state, &[], &[], &GRAVITY, step)
    });
    // Euler's equations: ω turns about z of the body
    let rate = spin[2] * (along - across) / across;
    let expected = [spin[0] * (rate * time).cos(), spin[0] * (rate * time).sin(), spin[2]];
    for (found, expected) in end.twist.angular.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
    // the body turns about its momentum, then about its own axis
    let momentum = [across * spin[0], 0.0, along * spin[2]];
    let about_momentum = momentum.map(|x| x / across * time);
    let turned = Quaternion::identity().turned_by(about_momentum).turned_by([0.0, 0.0, -rate * time]);
    for (found, expected) in end.orientation.to_wxyz().iter().zip(turned.to_wxyz()) {
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
    let fallen: [f64; 3] = from_fn(|axis| [0.3, -0.2, 0.1][axis] * time + GRAVITY[axis] * time * time / 2.0);
    for (found, expected) in end.position.iter().zip(fallen) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

/// A rigid body with its origin at its centre of mass, 5 kg.
struct Top {
    across: f64,
    along: f64,
}

impl FloatingBase<0, 6, 0> for Top {
    fn inverse_dynamics_of_floating_base<T: Scalar>(
        &self,
        _: &[T; 0],
        _: &[T; 0],
        _: &[T; 0],
        _: &BaseMotion<T>,
        _: &[Wrench<T>; 0],
    ) -> FloatingTorques<0, T> {
        unreachable!("no step needs it")
    }

    fn floating_mass_matrix<T: Scalar>(&self, _: &[T; 0]) -> [[T; 6]; 6] {
        unreachable!("no step needs it")
    }

    fn floating_bias<T: Scalar>(&self, _: &[T; 0], _: &[T; 0], _: &[T; 3], _: &[Wrench<T>; 0]) -> [T; 6] {
        unreachable!("no step needs it")
    }

    fn floating_gravity_torques<T: Scalar>(&self, _: &[T; 0], _: &[[T; 3]; 3]) -> [T; 6] {
        unreachable!("no step needs it")
    }

    /// Euler's equations. The acceleration of the origin less gravity is zero.
    fn floating_forward_dynamics<T: Scalar>(
        &self,
        _: &[T; 0],
        _: &[T; 0],
        _: &[T; 0],
        omega: &[T; 3],
        _: &[Wrench<T>; 0],
    ) -> FloatingAccelerations<0, T> {
        let ratio = T::from_f64((self.across - self.along) / self.across);
        let [x, y, z] = *omega;
        let angular = [ratio * y * z, -(ratio * x * z), T::zero()];
        FloatingAccelerations { base: BaseAcceleration { linear: [T::zero(); 3], angular }, qdd: [] }
    }
}
