//! Numbers of other precision, several at once, and with derivatives.

use fastrand::Rng;
use num_dual::Dual64;
use rne::Dual;
use simba::simd::{SimdValue, WideF64x4};

use crate::robots::{PLANAR_STATE, PUMA_STATE, Planar2, Puma560, Robot, State, all};

/// Accelerations of torques are as much less precise as the mass matrix is badly conditioned: 10⁵ of the PUMA without
/// rotors.
const CONDITION: f64 = 1e5;

/// Compares function by function, relative to the largest number of each.
#[track_caller]
fn close<T: Copy>(
    found: &[(&'static str, Vec<T>)],
    expected: &[(&'static str, Vec<f64>)],
    read: impl Fn(T) -> f64,
    tolerance: f64,
) {
    assert_eq!(found.len(), 26);
    for ((name, found), (_, expected)) in found.iter().zip(expected) {
        assert_eq!(found.len(), expected.len());
        let scale = expected.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
        let inverts = ["forward_dynamics", "inverse_mass_matrix", "inverse_mass_matrix_times_torques"].contains(name);
        let tolerance = if inverts { CONDITION * tolerance } else { tolerance };
        for (&found, &expected) in found.iter().zip(expected) {
            let error = (read(found) - expected).abs();
            assert!(error <= tolerance * scale, "{name}: {} for {expected}, of {scale}", read(found));
        }
    }
}

#[allow(clippy::cast_possible_truncation)] // rounding to f32 is what is measured
fn single<const DOF: usize>(robot: &impl Robot<DOF>, state: &State<DOF, f64>) {
    let rounded = state.map(|array| array.map(|x| x as f32));
    // 50 units in the last place
    close(
        &all(robot, &rounded),
        &all(robot, &rounded.map(|array| array.map(f64::from))),
        f64::from,
        50.0 * f64::from(f32::EPSILON),
    );
}

#[test]
fn single_precision_is_double_precision_rounded() {
    single(&Puma560, &PUMA_STATE);
    single(&Planar2, &PLANAR_STATE);
}

fn lanes<const DOF: usize>(robot: &impl Robot<DOF>) {
    let mut rng = Rng::with_seed(4);
    let states: [State<DOF, f64>; 4] = [(); 4].map(|()| [(); 3].map(|()| [(); DOF].map(|()| 4.0 * rng.f64() - 2.0)));
    let bundled: State<DOF, WideF64x4> = std::array::from_fn(|argument| {
        std::array::from_fn(|joint| {
            let mut bundle = WideF64x4::splat(0.0);
            for (lane, state) in states.iter().enumerate() {
                bundle.replace(lane, state[argument][joint]);
            }
            bundle
        })
    });
    let found = all(robot, &bundled);
    for (lane, state) in states.iter().enumerate() {
        // sine and cosine of lanes may differ in the last bits
        close(&found, &all(robot, state), |x| x.extract(lane), 1e-13);
    }
}

#[test]
fn lanes_are_states() {
    lanes(&Puma560);
    lanes(&Planar2);
}

/// A state and the direction in which it moves.
fn along<const DOF: usize, T>(
    state: &State<DOF, f64>,
    direction: &State<DOF, f64>,
    dual: impl Fn(f64, f64) -> T,
) -> State<DOF, T> {
    std::array::from_fn(|argument| {
        std::array::from_fn(|joint| dual(state[argument][joint], direction[argument][joint]))
    })
}

/// Along a random direction of the state.
fn duals<const DOF: usize>(robot: &impl Robot<DOF>, state: &State<DOF, f64>) {
    let mut rng = Rng::with_seed(5);
    let direction: State<DOF, f64> = [(); 3].map(|()| [(); DOF].map(|()| 2.0 * rng.f64() - 1.0));
    let own = all(robot, &along(state, &direction, |value, derivative| Dual { value, derivative }));
    let theirs = all(robot, &along(state, &direction, Dual64::new));
    let derivatives: Vec<(&str, Vec<f64>)> =
        own.iter().map(|(name, numbers)| (*name, numbers.iter().map(|x| x.derivative).collect())).collect();
    // where products and sums are fused, values alone are rounded less often
    close(&own, &all(robot, state), |x| x.value, 1e-13);
    close(&theirs, &all(robot, state), |x| x.re, 1e-13);
    close(&theirs, &derivatives, |x| x.eps, 1e-13);
}

#[test]
fn dual_numbers_of_this_crate_are_those_of_num_dual() {
    duals(&Puma560, &PUMA_STATE);
    duals(&Planar2, &PLANAR_STATE);
}

/// Column by column: the derivative that dual numbers carry through `inverse_dynamics` is that of the generated code.
fn columns<const DOF: usize>(robot: &impl Robot<DOF>, state: &State<DOF, f64>) {
    let [q, qd, qdd] = state;
    let found = robot.inverse_dynamics_derivatives(q, qd, qdd);
    let mass = robot.mass_matrix(q);
    for (argument, matrix) in [found.dq, found.dqd, mass].iter().enumerate() {
        let scale = matrix.concat().iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
        for column in 0..DOF {
            let mut moving = state.map(|array| array.map(Dual::constant));
            moving[argument][column].derivative = 1.0;
            let torques = robot.inverse_dynamics(&moving[0], &moving[1], &moving[2]);
            for (row, torque) in torques.iter().enumerate() {
                let error = (matrix[row][column] - torque.derivative).abs();
                assert!(error <= 1e-13 * scale, "argument {argument}, ({row}, {column}): {error:e} of {scale}");
            }
        }
    }
}

#[test]
fn generated_derivatives_are_those_of_dual_numbers() {
    columns(&Puma560, &PUMA_STATE);
    columns(&Planar2, &PLANAR_STATE);
}

/// Friction that changes its sign gradually is generated code on another number still.
#[test]
fn smooth_friction_tends_to_that_with_a_sign() {
    let [_, qd, qdd] = PUMA_STATE;
    let [sharp, smooth] = [
        rne::Actuation::actuator_torques(&Puma560, &qd, &qdd),
        rne::Actuation::actuator_torques_smooth(&Puma560, &qd, &qdd, 1e-9),
    ];
    for (sharp, smooth) in sharp.into_iter().zip(smooth) {
        assert!((sharp - smooth).abs() < 1e-12 * sharp.abs().max(1.0), "{smooth} for {sharp}");
    }
    let still = rne::Actuation::actuator_torques_smooth(&Puma560, &[0.0; 6], &[0.0; 6], 1e-3);
    assert_eq!(still, [0.0; 6]);
}
