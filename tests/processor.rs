//! Single calls by the instructions that the processor has: derived code of the reduced form asks it, with
//! `#[robot(inline)]` it does not.
//!
//! Where a processor of x86 has AVX2, the results have the bits of the code's own operations with every `mul_add`
//! rounded once, whatever this is compiled for. Elsewhere both are one code.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use fastrand::Rng;
use num_traits::{One, Zero};
use rne::{InverseDynamics, MassMatrix, Scalar, VectorUnit};

/// Whether single calls have more instructions than the program was compiled with, or were compiled with them.
fn is_fused() -> bool {
    cfg!(target_feature = "fma")
        || cfg!(target_arch = "aarch64")
        || VectorUnit::all().any(|unit| ["AVX2", "AVX-512"].contains(&unit.name()))
}

/// A number whose `mul_add` is rounded once on every machine. It is of no type that derived code knows, so that its
/// code is that of the compiled target.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fused<T>(T);

trait Float: Scalar + Into<f64> {
    fn fused(a: Self, b: Self, c: Self) -> Self;
}

impl Float for f64 {
    fn fused(a: Self, b: Self, c: Self) -> Self {
        f64::mul_add(a, b, c)
    }
}

impl Float for f32 {
    fn fused(a: Self, b: Self, c: Self) -> Self {
        f32::mul_add(a, b, c)
    }
}

impl<T: Float> Scalar for Fused<T> {
    fn from_f64(value: f64) -> Self {
        Self(T::from_f64(value))
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = Scalar::sin_cos(self.0);
        (Self(sine), Self(cosine))
    }

    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(T::fused(self.0, factor.0, addend.0))
    }
}

macro_rules! operators {
    ($($Operator:ident :: $operator:ident, $Assign:ident :: $assign:ident, $symbol:tt;)*) => {$(
        impl<T: Float> $Operator for Fused<T> {
            type Output = Self;

            fn $operator(self, other: Self) -> Self {
                Self(self.0 $symbol other.0)
            }
        }

        impl<T: Float> $Assign for Fused<T> {
            fn $assign(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    )*};
}
operators! {
    Add::add, AddAssign::add_assign, +;
    Sub::sub, SubAssign::sub_assign, -;
    Mul::mul, MulAssign::mul_assign, *;
    Div::div, DivAssign::div_assign, /;
}

impl<T: Float> Neg for Fused<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T: Float> Zero for Fused<T> {
    fn zero() -> Self {
        Self(T::zero())
    }

    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl<T: Float> One for Fused<T> {
    fn one() -> Self {
        Self(T::one())
    }
}

/// A shipped robot that asks the processor, and the same as it is compiled.
trait Pair<const DOF: usize> {
    const NAME: &'static str;
    /// Of the torques.
    const OPERATIONS: usize;
    type Asking: InverseDynamics<DOF> + MassMatrix<DOF>;
    type Compiled: InverseDynamics<DOF> + MassMatrix<DOF>;
    fn both(&self) -> (Self::Asking, Self::Compiled);
}

macro_rules! pairs {
    ($([$name:ident, $path:literal])*) => {
        $(mod $name {
            #[derive(rne::InverseDynamics, rne::MassMatrix)]
            #[robot(path = $path, form = "reduced", allow_lints)]
            pub(super) struct Asking;

            #[derive(rne::InverseDynamics, rne::MassMatrix)]
            #[robot(path = $path, form = "reduced", inline, allow_lints)]
            pub(super) struct Compiled;

            impl super::Pair<{ Asking::DOF }> for Asking {
                const NAME: &'static str = Asking::NAME;
                const OPERATIONS: usize = Asking::OPERATIONS.total();
                type Asking = Self;
                type Compiled = Compiled;

                fn both(&self) -> (Self, Compiled) {
                    (Asking, Compiled)
                }
            }
        })*

        fn visit_all(visitor: &mut impl Visitor) {
            $(visitor.visit(&$name::Asking);)*
        }
    };
}
shipped::for_each_tried_robot!(pairs!);

trait Visitor {
    fn visit<const DOF: usize, P: Pair<DOF>>(&mut self, pair: &P);
}

fn random<const DOF: usize, T: Scalar>(rng: &mut Rng, range: f64) -> [T; DOF] {
    std::array::from_fn(|_| T::from_f64((2.0 * rng.f64() - 1.0) * range))
}

/// A method of so few operations, and without an angle, does not ask: `asks_processor` of the derive.
const SHORT: usize = 60;

/// Numbers that differ in their bits between the processor's instructions and those of the compiled target.
struct Bits {
    compared: usize,
    different: usize,
}

impl Bits {
    /// From sines and cosines that are given, so that all operations are those of the code.
    fn compare<const DOF: usize, T: Float, P: Pair<DOF>>(&mut self, pair: &P) {
        let (asking, compiled) = pair.both();
        let mut rng = Rng::with_seed(26);
        for _ in 0..20 {
            let q: [T; DOF] = random(&mut rng, 3.0);
            let (sin, cos) = T::sin_cos_array(q);
            let (qd, qdd) = (random::<DOF, T>(&mut rng, 2.0), random::<DOF, T>(&mut rng, 5.0));
            let found = asking.inverse_dynamics_from_sin_cos(&sin, &cos, &q, &qd, &qdd);
            let target = compiled.inverse_dynamics_from_sin_cos(&sin, &cos, &q, &qd, &qdd);
            let [sin, cos, q, qd, qdd] = [sin, cos, q, qd, qdd].map(|numbers| numbers.map(Fused));
            let fused = compiled.inverse_dynamics_from_sin_cos(&sin, &cos, &q, &qd, &qdd).map(|torque| torque.0);
            assert_eq!(found, if is_fused() && P::OPERATIONS >= SHORT { fused } else { target }, "{}", P::NAME);
            self.compared += DOF;
            self.different += found.iter().zip(target).filter(|(found, target)| **found != *target).count();
        }
    }
}

impl Visitor for Bits {
    fn visit<const DOF: usize, P: Pair<DOF>>(&mut self, pair: &P) {
        self.compare::<DOF, f64, P>(pair);
        self.compare::<DOF, f32, P>(pair);
    }
}

#[test]
fn a_processor_that_fuses_is_used_for_all_it_has() {
    let mut bits = Bits { compared: 0, different: 0 };
    visit_all(&mut bits);
    println!("{} numbers, {} other than as compiled", bits.compared, bits.different);
    if !is_fused() {
        println!("skipped: this processor has no AVX2 with fused multiply-add");
    } else if !cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
        assert!(bits.different > bits.compared / 10, "the processor was not asked");
    }
}

/// The largest difference between the two, of the largest number.
struct Near {
    double: f64,
    single: f64,
}

fn difference<T: Into<f64> + Copy>(found: &[T], expected: &[T]) -> f64 {
    let scale = expected.iter().fold(0.0_f64, |scale, &x| scale.max(x.into().abs()));
    let differences = found.iter().zip(expected).map(|(&a, &b)| (a.into() - b.into()).abs());
    if scale == 0.0 { differences.sum() } else { differences.fold(0.0, f64::max) / scale }
}

impl Near {
    fn worst<const DOF: usize, T: Float>(pair: &impl Pair<DOF>) -> f64 {
        let (asking, compiled) = pair.both();
        let mut rng = Rng::with_seed(27);
        let mut worst = 0.0_f64;
        for _ in 0..20 {
            let q: [T; DOF] = random(&mut rng, 3.0);
            let (qd, qdd) = (random::<DOF, T>(&mut rng, 2.0), random::<DOF, T>(&mut rng, 5.0));
            worst = worst
                .max(difference(&asking.inverse_dynamics(&q, &qd, &qdd), &compiled.inverse_dynamics(&q, &qd, &qdd)))
                .max(difference(asking.mass_matrix(&q).as_flattened(), compiled.mass_matrix(&q).as_flattened()));
        }
        worst
    }
}

impl Visitor for Near {
    fn visit<const DOF: usize, P: Pair<DOF>>(&mut self, pair: &P) {
        let (double, single) = (Self::worst::<DOF, f64>(pair), Self::worst::<DOF, f32>(pair));
        println!("{:16} f64 {double:.1e}  f32 {single:.1e}", P::NAME);
        self.double = self.double.max(double);
        self.single = self.single.max(single);
    }
}

#[test]
fn both_codes_agree_but_for_the_last_digits() {
    let mut near = Near { double: 0.0, single: 0.0 };
    visit_all(&mut near);
    assert!(near.double < 2e-14 && near.single < 2e-6, "{:e}, {:e}", near.double, near.single);
}

/// Angles that the kernel of sine and cosine does not know, and numbers that are none.
struct Far;

impl Far {
    fn check<const DOF: usize, T: Float + PartialOrd>(pair: &impl Pair<DOF>, tolerance: f64) {
        let (asking, compiled) = pair.both();
        let mut rng = Rng::with_seed(28);
        for joint in 0..DOF {
            for special in [2e5, -3e6, 1e5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0] {
                let mut q: [T; DOF] = random(&mut rng, 3.0);
                let (qd, qdd) = (random::<DOF, T>(&mut rng, 2.0), random::<DOF, T>(&mut rng, 5.0));
                q[joint] = T::from_f64(special);
                let found: [f64; DOF] = asking.inverse_dynamics(&q, &qd, &qdd).map(Into::into);
                let expected: [f64; DOF] = compiled.inverse_dynamics(&q, &qd, &qdd).map(Into::into);
                let is_none = |x: &f64| !x.is_finite();
                if expected.iter().any(is_none) {
                    assert_eq!(found.map(|x| is_none(&x)), expected.map(|x| is_none(&x)), "joint {joint}: {special}");
                } else {
                    let difference = difference(&found, &expected);
                    assert!(difference <= tolerance, "joint {joint}: {special}: {difference:e}");
                }
            }
        }
    }
}

impl Visitor for Far {
    fn visit<const DOF: usize, P: Pair<DOF>>(&mut self, pair: &P) {
        Self::check::<DOF, f64>(pair, 1e-11);
        Self::check::<DOF, f32>(pair, 1e-3);
    }
}

#[test]
fn angles_far_away_and_numbers_that_are_none_are_as_compiled() {
    visit_all(&mut Far);
}
