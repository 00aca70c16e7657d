//! The momentum observer that stands beside its function in C: against the runtime's, tick by tick.

use std::fmt::Write;

use rne::{Arm, ObserverState};
use rne_codegen::{Form, Function};
use rne_emit::Precision;
use rne_model::Robot;

use crate::comparison::{ROOT, read};
use crate::compiler::Compiler;
use crate::driver::{INCLUDES, Unit, words};

const TICKS: usize = 40;

/// Random joint positions, rates and torques of a tick.
fn tick<const DOF: usize>(number: usize) -> [[f64; DOF]; 3] {
    let mut rng = fastrand::Rng::with_seed(number as u64);
    [3.0, 0.8, 5.0].map(|range| std::array::from_fn(|_| (2.0 * rng.f64() - 1.0) * range))
}

/// What C sees, as bits, with an observer of this gain and period.
fn of_c<const DOF: usize>(
    compiler: &Compiler,
    robot: &Robot,
    form: Form,
    precision: Precision,
    [gain, period]: [f64; 2],
) -> Vec<u64> {
    let program = rne_codegen::Compiler::new(robot).compile(Function::MomentumAndRate, form).expect("it compiles");
    let unit = Unit::new(robot, &[program], precision, "arm".to_owned());
    let real = precision.c_type();
    let mut source = INCLUDES.to_owned() + unit.code() + &words(precision);
    let suffix = if precision == Precision::Single { "f" } else { "" };
    let _ = write!(
        source,
        "int main(void)\n{{\n    {real} x[{}], seen[{DOF}];\n    arm_observer observer;\n    \
         arm_observer_begin(&observer, {gain:?}{suffix}, {period:?}{suffix});\n    \
         while (read_{real}(x, {}u)) {{\n        \
         arm_observer_update(&observer, x, x + {DOF}, x + {}, seen);\n        print_{real}(seen, {DOF}u);\n    }}\n    \
         return 0;\n}}\n",
        3 * DOF,
        3 * DOF,
        2 * DOF
    );
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    let word = |x: f64| match precision {
        Precision::Single => u64::from((x as f32).to_bits()),
        Precision::Double => x.to_bits(),
    };
    let input: Vec<u64> = (0..TICKS).flat_map(|number| tick::<DOF>(number).concat()).map(word).collect();
    compiler.run("observer", "-O2", &source, &input)
}

fn compare<const DOF: usize>(compiler: &Compiler, name: &str) {
    let robot = Robot::from_yaml(&read(&format!("{ROOT}/{name}.yaml"))).unwrap_or_else(|why| panic!("{why}"));
    let arm = Arm::<DOF>::from_robot(&robot).expect("so many joints");
    for [gain, period] in [[20.0, 0.001], [2.0, 0.01], [400.0, 0.01], [0.0, 0.001]] {
        let mut observer = ObserverState::<DOF, f64>::new(gain, period);
        let expected: Vec<f64> = (0..TICKS)
            .flat_map(|number| {
                let [q, qd, tau] = tick(number);
                observer.update(&arm, &q, &qd, &tau)
            })
            .collect();
        let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert_eq!(largest > 1.0, gain > 0.0, "{name}: {largest}");
        for form in [Form::SevenSteps, Form::Reduced] {
            for (precision, tolerance) in [(Precision::Double, 1e-11), (Precision::Single, 1e-4)] {
                let words = of_c::<DOF>(compiler, &robot, form, precision, [gain, period]);
                let found = words.iter().map(|&word| match precision {
                    #[allow(clippy::cast_possible_truncation)] // the lower half
                    Precision::Single => f64::from(f32::from_bits(word as u32)),
                    Precision::Double => f64::from_bits(word),
                });
                assert_eq!(words.len(), expected.len());
                for (index, (found, expected)) in found.zip(&expected).enumerate() {
                    // of momenta that a tick changes by little, in periods
                    let scale = largest.max(0.1 / period) * f64::from(u8::from(gain > 0.0));
                    let error = (found - expected).abs();
                    assert!(error <= tolerance * scale, "{name}, {form}, {gain} Hz, {index}: {found}, not {expected}");
                }
            }
        }
    }
}

/// A period of zero, below zero, and one whose frequency is not finite write zeros, as those of the runtime do.
#[test]
fn the_observer_in_c_without_a_period_writes_zeros() {
    let Some(compiler) = Compiler::found() else { return };
    let robot = Robot::from_yaml(&read(&format!("{ROOT}/robots/planar3.yaml"))).unwrap_or_else(|why| panic!("{why}"));
    for precision in [Precision::Double, Precision::Single] {
        for period in [0.0, -1e-3, 2.9e-39, 9e-31] {
            let found = of_c::<3>(&compiler, &robot, Form::Reduced, precision, [20.0, period]);
            assert_eq!(found, vec![0; 3 * TICKS], "{precision:?}, {period} s");
        }
    }
}

#[test]
fn the_observer_in_c_is_that_of_the_runtime() {
    let Some(compiler) = Compiler::found() else { return };
    compare::<3>(&compiler, "robots/planar3");
    compare::<4>(&compiler, "rne-cli/tests/cli/arms/lift");
    if shipped::is_exhaustive() {
        compare::<4>(&compiler, "robots/scara_cobra600");
        compare::<4>(&compiler, "rne-cli/tests/cli/arms/palletizer");
        compare::<6>(&compiler, "rne-cli/tests/cli/arms/wrist");
        compare::<6>(&compiler, "robots/puma560");
    }
}
