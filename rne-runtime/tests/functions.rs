//! Every function beyond the torques, in every kind of scalar, for both kinds of arm.
#![cfg(feature = "std")]

use crate::common::{Numbers, SIX_BASE, SIX_Q, SIX_QD, SIX_QDD, model, one_link, relative_error, six_joints, tool};
use nalgebra::{Isometry3, IsometryMatrix3, Matrix3, Point3, Vector3};
use num_dual::Dual64;
use rne_model::Convention::{Modified, Standard};
use rne_model::Model;
use rne_runtime::{
    Arm, CentreOfMass, Constant, CoriolisMatrix, Dual, DynArm, DynMomentumAndRate, Energy, ForwardDynamics,
    InverseDynamics, InverseDynamicsDerivatives, JointWrenches, Kinematics, MassMatrix, MomentumObserver, MovingBase,
    Pose, Regressor, Scalar, Wrench, WrongLength,
};
use simba::simd::{AutoF32x4, AutoF64x4, SimdValue, WideF64x4};

const STATE: [[f64; 6]; 3] = [SIX_Q, SIX_QD, SIX_QDD];

fn arms() -> [Model<6>; 2] {
    [Standard, Modified].map(|convention| Model { tool: tool(), base: tool(), ..six_joints(convention) })
}

fn of_pose<T: Scalar>(pose: &Pose<T>) -> Vec<T> {
    [pose.rotation.concat(), pose.translation.to_vec()].concat()
}

fn of_wrench<T: Scalar>(wrench: &Wrench<T>) -> Vec<T> {
    [wrench.force, wrench.moment].concat()
}

/// What all functions find, function by function.
fn all<T: Scalar>(arm: &Arm<6, impl Constant>, [q, qd, qdd]: &[[T; 6]; 3]) -> Vec<Vec<T>> {
    let derivatives = arm.inverse_dynamics_derivatives(q, qd, qdd);
    let base = SIX_BASE;
    let constant = |x: [f64; 3]| x.map(T::from_f64);
    let base = rne_runtime::BaseMotion {
        omega: constant(base.omega),
        omega_dot: constant(base.omega_dot),
        velocity: constant(base.velocity),
        acceleration: constant(base.acceleration),
        gravity: constant(base.gravity),
    };
    vec![
        arm.mass_matrix(q).concat(),
        arm.coriolis_matrix(q, qd).concat(),
        arm.coriolis_torques(q, qd).to_vec(),
        arm.forward_dynamics(q, qd, qdd).to_vec(),
        of_pose(&arm.forward_kinematics(q)),
        arm.link_poses(q).iter().flat_map(of_pose).collect(),
        arm.jacobian(q).concat(),
        arm.jacobian_rate_times_velocity(q, qd).to_vec(),
        vec![arm.kinetic_energy(q, qd)],
        vec![arm.potential_energy(q)],
        arm.centre_of_mass(q).to_vec(),
        arm.centre_of_mass_jacobian(q).concat(),
        arm.regressor(q, qd, qdd).concat().concat(),
        derivatives.dq.concat(),
        derivatives.dqd.concat(),
        arm.joint_wrenches(q, qd, qdd).iter().flat_map(of_wrench).collect(),
        arm.inverse_dynamics_on_moving_base(q, qd, qdd, &base).to_vec(),
        {
            let found = arm.momentum_and_rate(q, qd, qdd);
            [found.momentum, found.rate].concat()
        },
    ]
}

fn all_of_dyn(arm: &DynArm, [q, qd, qdd]: &[[f64; 6]; 3]) -> Result<Vec<Vec<f64>>, WrongLength> {
    let derivatives = arm.inverse_dynamics_derivatives(q, qd, qdd)?;
    let DynMomentumAndRate { momentum, rate } = arm.momentum_and_rate(q, qd, qdd)?;
    Ok(vec![
        arm.mass_matrix(q)?.concat(),
        arm.coriolis_matrix(q, qd)?.concat(),
        arm.coriolis_torques(q, qd)?,
        arm.forward_dynamics(q, qd, qdd)?,
        of_pose(&arm.forward_kinematics(q)?),
        arm.link_poses(q)?.iter().flat_map(of_pose).collect(),
        arm.jacobian(q)?.concat(),
        arm.jacobian_rate_times_velocity(q, qd)?.to_vec(),
        vec![arm.kinetic_energy(q, qd)?],
        vec![arm.potential_energy(q)?],
        arm.centre_of_mass(q)?.to_vec(),
        arm.centre_of_mass_jacobian(q)?.concat(),
        arm.regressor(q, qd, qdd)?.concat().concat(),
        derivatives.dq.concat(),
        derivatives.dqd.concat(),
        arm.joint_wrenches(q, qd, qdd)?.iter().flat_map(of_wrench).collect(),
        arm.inverse_dynamics_on_moving_base(q, qd, qdd, &SIX_BASE)?,
        [momentum, rate].concat(),
    ])
}

/// The largest error of any function.
fn worst(found: &[Vec<f64>], expected: &[Vec<f64>]) -> f64 {
    assert_eq!(found.len(), expected.len());
    found.iter().zip(expected).map(|(found, expected)| relative_error(found, expected)).fold(0.0, f64::max)
}

fn map<T: Copy, U>(values: &[Vec<T>], function: impl Fn(T) -> U + Copy) -> Vec<Vec<U>> {
    values.iter().map(|values| values.iter().map(|&value| function(value)).collect()).collect()
}

#[test]
fn both_kinds_of_arm_give_the_same_bits() {
    let mut numbers = Numbers::new(41);
    for model in arms() {
        let (arm, dyn_arm) = (Arm::new(model), DynArm::new(&model));
        for _ in 0..20 {
            let state = [numbers.array(3.0), numbers.array(2.0), numbers.array(2.0)];
            assert_eq!(all_of_dyn(&dyn_arm, &state), Ok(all(&arm, &state)));
        }
    }
}

#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn single_precision() {
    for model in arms() {
        let expected = all(&Arm::new(model), &STATE);
        let state = STATE.map(|x| x.map(|x| x as f32));
        let found = all(&Arm::new(model.to_f32()), &state);
        // Forward dynamics: the condition of the mass matrix stands before the rounding.
        let error = worst(&map(&found, f64::from), &expected);
        assert!(error < 1e-4, "{error:e}");
        let lanes = all(&Arm::new(model.to_f32()), &state.map(|x| x.map(AutoF32x4::splat)));
        let error = worst(&map(&map(&lanes, |x| x.extract(2)), f64::from), &expected);
        assert!(error < 1e-4, "{error:e}");
    }
}

fn lanes_are_scalars<V: Scalar + SimdValue<Element = f64>>() {
    let mut numbers = Numbers::new(42);
    for model in arms() {
        let arm = Arm::new(model);
        let states: [[[f64; 6]; 3]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| numbers.array(2.0)));
        let bundled = std::array::from_fn(|argument| {
            std::array::from_fn(|joint| {
                let mut bundle = V::splat(0.0);
                for (lane, state) in states.iter().enumerate() {
                    bundle.replace(lane, state[argument][joint]);
                }
                bundle
            })
        });
        let found = all(&arm, &bundled);
        for (lane, state) in states.iter().enumerate() {
            let error = worst(&map(&found, |x: V| x.extract(lane)), &all(&arm, state));
            // Sine and cosine may differ in the last bit.
            assert!(error < 1e-11, "{error:e}");
        }
    }
}

#[test]
fn lanes() {
    lanes_are_scalars::<AutoF64x4>();
    lanes_are_scalars::<WideF64x4>();
}

#[test]
fn dual_numbers_of_this_crate_are_those_of_num_dual() {
    let mut numbers = Numbers::new(43);
    for model in arms() {
        let arm = Arm::new(model);
        let (state, rate): ([[f64; 6]; 3], [[f64; 6]; 3]) = (STATE, std::array::from_fn(|_| numbers.array(1.0)));
        let pairs = |argument: usize, joint: usize| (state[argument][joint], rate[argument][joint]);
        let own = std::array::from_fn(|argument| {
            std::array::from_fn(|joint| {
                let (value, derivative) = pairs(argument, joint);
                Dual { value, derivative }
            })
        });
        let theirs = std::array::from_fn(|argument| {
            std::array::from_fn(|joint| {
                let (value, derivative) = pairs(argument, joint);
                Dual64::new(value, derivative)
            })
        });
        let (own, theirs) = (all(&arm, &own), all(&arm, &theirs));
        assert_eq!(map(&own, |x| x.value), all(&arm, &state), "values are computed as without derivatives");
        assert!(worst(&map(&own, |x| x.value), &map(&theirs, |x| x.re)) < 1e-13);
        assert!(worst(&map(&own, |x| x.derivative), &map(&theirs, |x| x.eps)) < 1e-12);
    }
}

#[test]
fn derivatives_of_the_torques_are_those_of_num_dual() {
    for model in arms() {
        let arm = Arm::new(model);
        let [q, qd, qdd] = STATE;
        let found = arm.inverse_dynamics_derivatives(&q, &qd, &qdd);
        for joint in 0..6 {
            for (argument, matrix) in [(0, found.dq), (1, found.dqd)] {
                let mut state = STATE.map(|x| x.map(Dual64::from_re));
                state[argument][joint].eps = 1.0;
                let tau = arm.inverse_dynamics(&state[0], &state[1], &state[2]);
                let error = relative_error(&matrix.map(|row| row[joint]), &tau.map(|tau| tau.eps));
                assert!(error < 1e-13, "{error:e}");
            }
        }
    }
}

#[test]
fn a_dual_number_follows_the_rules() {
    let (x, y) = (Dual { value: 0.7, derivative: 1.0 }, Dual { value: -1.3, derivative: 0.4 });
    let (a, b) = (Dual64::new(0.7, 1.0), Dual64::new(-1.3, 0.4));
    let pair = |z: Dual64| (z.re, z.eps);
    for (own, theirs) in [(x + y, a + b), (x - y, a - b), (x * y, a * b), (x / y, a / b), (-x, -a)] {
        let (value, derivative) = pair(theirs);
        assert!((own.value - value).abs() < 1e-15 && (own.derivative - derivative).abs() < 1e-15, "{own:?}");
    }
    let root = Scalar::sqrt(x);
    assert!((root.value * root.value - 0.7).abs() < 1e-15);
    assert!((root.derivative - 0.5 / root.value).abs() < 1e-15);
    let mut z = x;
    z += y;
    z -= y;
    z *= y;
    z /= y;
    assert!((z.value - x.value).abs() < 1e-15 && (z.derivative - x.derivative).abs() < 1e-15);
}

#[test]
fn poses_are_those_of_nalgebra() {
    let arm = Arm::new(arms()[0]);
    let pose = arm.forward_kinematics(&SIX_Q);
    let (rotation, translation) = (pose.rotation_matrix(), pose.translation_vector());
    assert_eq!(Pose::from_matrix(rotation, translation), pose);
    assert_eq!(rotation[(0, 2)], pose.rotation[0][2], "rows are rows");
    let orthonormal = (rotation * rotation.transpose() - Matrix3::identity()).amax();
    assert!(orthonormal < 1e-14 && (rotation.determinant() - 1.0).abs() < 1e-14);

    let isometry = IsometryMatrix3::from(pose);
    assert_eq!(Pose::from(isometry), pose);
    let point = Point3::new(0.3, -0.2, 0.9);
    let expected = rotation * point.coords + translation;
    assert!((isometry * point - Point3::from(expected)).amax() < 1e-15);
    assert!((pose.to_homogeneous().transform_point(&point).coords - expected).amax() < 1e-15);
    // With a quaternion in place of the matrix.
    let isometry: Isometry3<f64> = nalgebra::convert(isometry);
    assert!((isometry * point - Point3::from(expected)).amax() < 1e-14);
    assert_eq!(Pose::<f64>::identity().translation_vector(), Vector3::zeros());
}

#[test]
fn a_rod_has_the_textbook_s_values() {
    let arm = Arm::new(one_link());
    let (m, a, g) = (2.5, 0.8, 9.81);
    let (q, qd) = (0.6_f64, 1.3);
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    close(arm.mass_matrix(&[q])[0][0], m * a * a / 3.0);
    assert_eq!(arm.coriolis_matrix(&[q], &[qd]), [[0.0]]);
    close(arm.kinetic_energy(&[q], &[qd]), m * a * a / 6.0 * qd * qd);
    close(arm.potential_energy(&[q]), -m * g * a / 2.0 * q.cos());
    close(arm.forward_dynamics(&[q], &[qd], &[0.0])[0], -1.5 * g / a * q.sin());
    close(arm.inverse_dynamics_derivatives(&[q], &[qd], &[0.4]).dq[0][0], m * g * a / 2.0 * q.cos());
    let [x, y, z] = arm.forward_kinematics(&[q]).translation;
    close(x, a * q.cos());
    close(y, a * q.sin());
    assert_eq!(z, 0.0);
    let jacobian = arm.jacobian(&[q]).map(|row| row[0]);
    close(jacobian[0], -a * q.sin());
    close(jacobian[1], a * q.cos());
    assert_eq!(jacobian[2..], [0.0, 0.0, 0.0, 1.0]);
    let [ax, ay, ..] = arm.jacobian_rate_times_velocity(&[q], &[qd]);
    close(ax, -a * q.cos() * qd * qd);
    close(ay, -a * q.sin() * qd * qd);
    // 5.1, turned into the rod's axes
    let [wrench] = arm.joint_wrenches(&[q], &[qd], &[-0.7]);
    close(wrench.force[0], -21.931_355_955_659_86);
    close(wrench.force[1], 13.147_856_660_013_242);
    close(wrench.moment[2], 5.165_809_330_671_964);
}

#[test]
fn a_mass_matrix_without_inverse_is_no_panic() {
    let mut model = six_joints(Standard);
    for row in &mut model.rows {
        row.link = rne_model::Link::default();
    }
    let arm = Arm::new(model);
    assert_eq!(arm.mass_matrix(&SIX_Q), [[0.0; 6]; 6]);
    assert!(arm.forward_dynamics(&SIX_Q, &SIX_QD, &[1.0; 6]).iter().all(|x| !x.is_finite()));
    let nan = [f64::NAN; 6];
    assert!(arm.forward_dynamics(&nan, &nan, &nan).iter().all(|x| x.is_nan()));
}

#[test]
fn an_arm_without_joints_is_its_tool() {
    let nothing = Model { tool: tool(), ..model(Standard, [0.0, 0.0, -9.81], []) };
    let (arm, dyn_arm) = (Arm::new(nothing), DynArm::new(&nothing));
    let q: [f64; 0] = [];
    assert_eq!(arm.forward_kinematics(&q).translation, nothing.tool.xyz);
    assert_eq!(dyn_arm.forward_kinematics(&q), Ok(arm.forward_kinematics(&q)));
    assert_eq!(arm.jacobian(&q), [[]; 6]);
    assert_eq!(arm.jacobian_rate_times_velocity(&q, &q), [0.0; 6]);
    assert_eq!((arm.kinetic_energy(&q, &q), arm.potential_energy(&q)), (0.0, 0.0));
    assert!(arm.centre_of_mass(&q).iter().all(|x| x.is_nan()));
    assert_eq!(arm.centre_of_mass_jacobian(&q), [[]; 3]);
    assert_eq!(dyn_arm.forward_dynamics(&q, &q, &q), Ok(vec![]));
    assert_eq!(dyn_arm.regressor(&q, &q, &q), Ok(vec![]));
}

#[test]
fn a_wrong_length_names_the_argument() {
    let arm = DynArm::new(&one_link());
    let wrong = |argument| WrongLength { argument, expected: 1, found: 2 };
    let (one, two) = ([0.0], [0.0; 2]);
    assert_eq!(arm.mass_matrix(&two), Err(wrong("q")));
    assert_eq!(arm.coriolis_matrix(&one, &two), Err(wrong("qd")));
    assert_eq!(arm.forward_dynamics(&one, &one, &two), Err(wrong("tau")));
    assert_eq!(arm.forward_kinematics(&two), Err(wrong("q")));
    assert_eq!(arm.link_poses(&two), Err(wrong("q")));
    assert_eq!(arm.jacobian(&two), Err(wrong("q")));
    assert_eq!(arm.jacobian_rate_times_velocity(&one, &two), Err(wrong("qd")));
    assert_eq!(arm.kinetic_energy(&one, &two), Err(wrong("qd")));
    assert_eq!(arm.potential_energy(&two), Err(wrong("q")));
    assert_eq!(arm.centre_of_mass(&two), Err(wrong("q")));
    assert_eq!(arm.centre_of_mass_jacobian(&two), Err(wrong("q")));
    assert_eq!(arm.regressor(&one, &one, &two), Err(wrong("qdd")));
    assert_eq!(arm.inverse_dynamics_derivatives(&one, &two, &one), Err(wrong("qd")));
    assert_eq!(arm.joint_wrenches(&two, &one, &one), Err(wrong("q")));
    assert_eq!(arm.inverse_dynamics_on_moving_base(&one, &one, &two, &SIX_BASE), Err(wrong("qdd")));
    assert_eq!(arm.momentum_and_rate(&one, &one, &two), Err(wrong("tau")));
    assert_eq!(arm.actuator_torques(&two, &one), Err(wrong("qd")));
    assert_eq!(arm.actuator_torques_smooth(&one, &two, 0.1), Err(wrong("qdd")));
    assert_eq!(arm.with_motors(vec![None; 2]), Err(wrong("motors")));
}
