//! One robot, many number types: single precision, SIMD lanes, dual numbers.
#![cfg(feature = "std")]

use crate::common::{Numbers, SIX_Q, SIX_QD, SIX_QDD, SIX_WRENCH, relative_error, six_joints};
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_dual::Dual64;
use num_traits::{One, Zero};
use rne_model::Convention::{Modified, Standard};
use rne_runtime::{
    Arm, CoriolisMatrix, DynArm, Energy, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, Kinematics,
    MassMatrix, Regressor, Scalar, Wrench,
};
use simba::simd::{AutoF32x4, AutoF64x4, SimdValue, WideF64x4};

const LANES: usize = 4;

#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn single_precision_stays_close_to_double() {
    for convention in [Standard, Modified] {
        let model = six_joints(convention);
        let double = Arm::new(model);
        let stored_single = Arm::new(model.to_f32());
        let (q, qd, qdd) = (SIX_Q.map(|x| x as f32), SIX_QD.map(|x| x as f32), SIX_QDD.map(|x| x as f32));
        let expected = double.inverse_dynamics(&SIX_Q, &SIX_QD, &SIX_QDD);
        for found in [stored_single.inverse_dynamics(&q, &qd, &qdd), double.inverse_dynamics(&q, &qd, &qdd)] {
            let error = relative_error(&found.map(f64::from), &expected);
            assert!(error < 2e-6, "{error:e}");
            assert!(error > 0.0);
        }
        // Constants rounded to single precision, computed with in double precision.
        let error = relative_error(&stored_single.inverse_dynamics(&SIX_Q, &SIX_QD, &SIX_QDD), &expected);
        assert!(error < 1e-6, "{error:e}");
    }
}

/// Four random states, as scalars per lane and as lanes.
fn lanes<V: SimdValue<Element = f64> + Copy>(numbers: &mut Numbers) -> ([[f64; 6]; LANES], [V; 6]) {
    let states: [[f64; 6]; LANES] = std::array::from_fn(|_| numbers.array(3.0));
    let bundled = std::array::from_fn(|joint| {
        let mut bundle = V::splat(0.0);
        for (lane, state) in states.iter().enumerate() {
            bundle.replace(lane, state[joint]);
        }
        bundle
    });
    (states, bundled)
}

/// Torques of four states at once against those of one at a time; the largest relative difference.
fn lanes_against_scalars<V: Scalar + SimdValue<Element = f64>>() -> f64 {
    let mut numbers = Numbers::new(7);
    let mut worst = 0.0_f64;
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        for _ in 0..100 {
            let (qs, q) = lanes::<V>(&mut numbers);
            let (qds, qd) = lanes::<V>(&mut numbers);
            let (qdds, qdd) = lanes::<V>(&mut numbers);
            let wrench =
                Wrench { force: SIX_WRENCH.force.map(|x| V::splat(x)), moment: SIX_WRENCH.moment.map(|x| V::splat(x)) };
            let tau = arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench);
            for lane in 0..LANES {
                let alone = arm.inverse_dynamics_with_wrench(&qs[lane], &qds[lane], &qdds[lane], &SIX_WRENCH);
                worst = worst.max(relative_error(&tau.map(|t| t.extract(lane)), &alone));
            }
        }
    }
    worst
}

#[test]
fn lanes_differ_by_their_sine_and_cosine_only() {
    // simba's lanes take `std`'s functions, `wide`'s their own polynomials: the last bits may differ.
    for worst in [lanes_against_scalars::<AutoF64x4>(), lanes_against_scalars::<WideF64x4>()] {
        assert!(worst < 5e-15, "{worst:e}");
    }
}

#[test]
fn single_precision_lanes() {
    let arm = Arm::new(six_joints(Standard).to_f32());
    let q = [0.3_f32, -0.8, 0.25, 1.1, 0.15, -0.6];
    let tau = arm.gravity_torques(&q.map(AutoF32x4::splat));
    let error = relative_error(&tau.map(|t| f64::from(t.extract(3))), &arm.gravity_torques(&q).map(f64::from));
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn dual_numbers_differentiate() {
    let step = 1e-6;
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        let torques = |x: &[[f64; 6]; 3]| arm.inverse_dynamics(&x[0], &x[1], &x[2]);
        let state = [SIX_Q, SIX_QD, SIX_QDD];
        // With respect to q, q̇ and q̈ of every joint.
        for (argument, joint) in (0..3).flat_map(|a| (0..6).map(move |j| (a, j))) {
            let mut dual = state.map(|x| x.map(Dual64::from_re));
            dual[argument][joint].eps = 1.0;
            let tau = arm.inverse_dynamics(&dual[0], &dual[1], &dual[2]);
            // num-dual takes the sine and cosine of `std`.
            let error = relative_error(&tau.map(|t| t.re), &torques(&state));
            assert!(error < 1e-14, "{error:e}");

            let (mut more, mut less) = (state, state);
            more[argument][joint] += step;
            less[argument][joint] -= step;
            let (more, less) = (torques(&more), torques(&less));
            let differences: [f64; 6] = std::array::from_fn(|i| (more[i] - less[i]) / (2.0 * step));
            let derivative = tau.map(|t| t.eps);
            let scale = differences.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            for (d, e) in differences.iter().zip(derivative) {
                assert!((d - e).abs() < 1e-8 * scale, "{differences:?} {derivative:?}");
            }
        }
    }
}

/// A state that moves along q̇, q̈: dual parts are derivatives with respect to time.
fn moving(q: [f64; 6], qd: [f64; 6], qdd: [f64; 6]) -> [[Dual64; 6]; 3] {
    let along = |x: [f64; 6], rate: [f64; 6]| std::array::from_fn(|i| Dual64::new(x[i], rate[i]));
    [along(q, qd), along(qd, qdd), along(qdd, [0.0; 6])]
}

#[test]
fn accelerations_are_the_time_derivatives_of_velocities() {
    let mut numbers = Numbers::new(11);
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        for _ in 0..20 {
            let [q, qd, qdd] = moving(numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
            // In the axes of the base, which do not turn.
            for link in arm.trace(&q, &qd, &qdd, &arm.fixed_base(), None).to_base() {
                let rate = |x: [Dual64; 3]| x.map(|x| x.eps);
                let value = |x: [Dual64; 3]| x.map(|x| x.re);
                assert!(relative_error(&rate(link.omega), &value(link.omega_dot)) < 1e-13);
                assert!(relative_error(&rate(link.velocity), &value(link.acceleration)) < 1e-13);
                assert!(relative_error(&rate(link.gravity), &[0.0; 3]) < 1e-13);
            }
        }
    }
}

#[test]
fn velocities_are_the_time_derivatives_of_positions() {
    let mut numbers = Numbers::new(12);
    for convention in [Standard, Modified] {
        let arm = Arm::new(six_joints(convention));
        for _ in 0..20 {
            let [q, qd, qdd] = moving(numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
            // J_1 stands still, so the sum of d and r from there on is the way to each centre of mass.
            let mut joint = [Dual64::from_re(0.0); 3];
            for link in arm.trace(&q, &qd, &qdd, &arm.fixed_base(), None).to_base() {
                let com: [Dual64; 3] = std::array::from_fn(|k| joint[k] + link.d[k]);
                assert!(relative_error(&com.map(|x| x.eps), &link.velocity.map(|x| x.re)) < 1e-13);
                joint = std::array::from_fn(|k| com[k] + link.r[k]);
            }
        }
    }
}

#[test]
fn the_run_time_arm_takes_every_scalar_too() {
    let model = six_joints(Standard);
    let (arm, dyn_arm) = (Arm::new(model), DynArm::new(&model));
    let q = SIX_Q.map(Dual64::from_re);
    let found = dyn_arm.gravity_torques(&q).expect("six joints");
    assert_eq!(found, arm.gravity_torques(&q));
    let q = SIX_Q.map(WideF64x4::splat);
    assert_eq!(dyn_arm.gravity_torques(&q).expect("six joints"), arm.gravity_torques(&q));
}

/// A type of a user's own that is no real field to nalgebra.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Own(f64);

macro_rules! operators {
    ($($operator:ident $method:ident $assigning:ident $assign:ident,)*) => {
        $(
            impl $operator for Own {
                type Output = Self;
                fn $method(self, other: Self) -> Self {
                    Self(self.0.$method(other.0))
                }
            }
            impl $assigning for Own {
                fn $assign(&mut self, other: Self) {
                    self.0.$assign(other.0);
                }
            }
        )*
    };
}

operators! {
    Add add AddAssign add_assign,
    Sub sub SubAssign sub_assign,
    Mul mul MulAssign mul_assign,
    Div div DivAssign div_assign,
}

impl Neg for Own {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for Own {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Own {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Scalar for Own {
    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Scalar::sin_cos(self.0);
        (Self(sin), Self(cos))
    }
}

#[test]
fn a_type_of_ones_own_needs_a_constant_and_a_sine() {
    let model = six_joints(Modified);
    let state = [SIX_Q, SIX_QD, SIX_QDD];
    let [q, qd, qdd] = state.map(|x| x.map(Own));
    let expected = Arm::new(model).inverse_dynamics(&SIX_Q, &SIX_QD, &SIX_QDD);
    assert_eq!(Arm::new(model).inverse_dynamics(&q, &qd, &qdd), expected.map(Own));
    let single = Arm::new(model.to_f32());
    let expected = single.inverse_dynamics(&SIX_Q, &SIX_QD, &SIX_QDD);
    assert_eq!(single.inverse_dynamics(&q, &qd, &qdd), expected.map(Own), "constants in single precision");
}

/// It has no `by_sign` and no `sqrt`: `actuator_torques` would not compile for it, and all else does.
#[test]
fn a_type_of_ones_own_has_every_function_but_friction() {
    let arm = Arm::new(six_joints(Modified));
    let state = [SIX_Q, SIX_QD, SIX_QDD];
    let [q, qd, qdd] = state.map(|x| x.map(Own));
    assert_eq!(arm.mass_matrix(&q), arm.mass_matrix(&SIX_Q).map(|row| row.map(Own)));
    assert_eq!(arm.coriolis_matrix(&q, &qd), arm.coriolis_matrix(&SIX_Q, &SIX_QD).map(|row| row.map(Own)));
    assert_eq!(arm.forward_dynamics(&q, &qd, &qdd), arm.forward_dynamics(&SIX_Q, &SIX_QD, &SIX_QDD).map(Own));
    assert_eq!(arm.jacobian(&q), arm.jacobian(&SIX_Q).map(|row| row.map(Own)));
    assert_eq!(arm.forward_kinematics(&q).translation, arm.forward_kinematics(&SIX_Q).translation.map(Own));
    assert_eq!(arm.kinetic_energy(&q, &qd), Own(arm.kinetic_energy(&SIX_Q, &SIX_QD)));
    let (own, double) =
        (arm.inverse_dynamics_derivatives(&q, &qd, &qdd), arm.inverse_dynamics_derivatives(&SIX_Q, &SIX_QD, &SIX_QDD));
    assert_eq!(own.dq, double.dq.map(|row| row.map(Own)));
    let (own, double) = (arm.regressor(&q, &qd, &qdd), arm.regressor(&SIX_Q, &SIX_QD, &SIX_QDD));
    assert_eq!(own, double.map(|row| row.map(|link| link.map(Own))));
}
