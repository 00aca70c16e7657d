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

/// Each form in each number type.
fn units() -> impl Iterator<Item = (Form, Precision)> {
    [Form::SevenSteps, Form::Reduced].into_iter().flat_map(|form| Precision::ALL.map(|precision| (form, precision)))
}

/// The words of observers with these gains and periods in C: by form and number type, setting, tick and joint. One
/// program computes them all.
fn of_c<const DOF: usize>(compiler: &Compiler, robot: &Robot, settings: &[[f64; 2]]) -> Vec<u64> {
    let (mut source, mut calls, mut input) = (INCLUDES.to_owned(), String::new(), Vec::new());
    for (form, precision) in units() {
        let program = rne_codegen::Compiler::new(robot).compile(Function::MomentumAndRate, form).expect("it compiles");
        let (real, prefix) = (precision.c_type(), format!("{form}_{}", precision.c_type()));
        source.push_str(Unit::new(robot, &[program], precision, prefix.clone()).code());
        let _ = write!(
            calls,
            "    for (setting = 0u; setting < {}u; ++setting) {{\n        {prefix}_observer observer;\n        \
             {real} x[{}], seen[{DOF}];\n        if (!read_{real}(x, 2u)) {{ return 1; }}\n        \
             {prefix}_observer_begin(&observer, x[0], x[1]);\n        \
             for (tick = 0u; tick < {TICKS}u && read_{real}(x, {}u); ++tick) {{\n            \
             {prefix}_observer_update(&observer, x, x + {DOF}, x + {}, seen);\n            \
             print_{real}(seen, {DOF}u);\n        }}\n    }}\n",
            settings.len(),
            3 * DOF,
            3 * DOF,
            2 * DOF
        );
        #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
        let word = |x: f64| match precision {
            Precision::Single => u64::from((x as f32).to_bits()),
            Precision::Double => x.to_bits(),
        };
        for setting in settings {
            input.extend(setting.iter().copied().map(word));
            input.extend((0..TICKS).flat_map(|number| tick::<DOF>(number).concat()).map(word));
        }
    }
    source.extend(Precision::ALL.map(words));
    let _ = write!(source, "int main(void)\n{{\n    unsigned setting, tick;\n{calls}    return 0;\n}}\n");
    compiler.run("observer", "-O2", &source, &input)
}

fn compare<const DOF: usize>(compiler: &Compiler, name: &str) {
    let robot = Robot::from_yaml(&read(&format!("{ROOT}/{name}.yaml"))).unwrap_or_else(|why| panic!("{why}"));
    let arm = Arm::<DOF>::from_robot(&robot).expect("so many joints");
    let settings = [[20.0, 0.001], [2.0, 0.01], [400.0, 0.01], [0.0, 0.001]];
    let mut words = of_c::<DOF>(compiler, &robot, &settings).into_iter();
    for (form, precision) in units() {
        let tolerance = if precision == Precision::Double { 1e-11 } else { 1e-4 };
        for [gain, period] in settings {
            let mut observer = ObserverState::<DOF, f64>::new(gain, period);
            let expected: Vec<f64> = (0..TICKS)
                .flat_map(|number| {
                    let [q, qd, tau] = tick(number);
                    observer.update(&arm, &q, &qd, &tau)
                })
                .collect();
            let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert_eq!(largest > 1.0, gain > 0.0, "{name}: {largest}");
            for (index, expected) in expected.iter().enumerate() {
                let word = words.next().expect("a number for each tick and joint");
                let found = match precision {
                    #[allow(clippy::cast_possible_truncation)] // the lower half
                    Precision::Single => f64::from(f32::from_bits(word as u32)),
                    Precision::Double => f64::from_bits(word),
                };
                // of momenta that a tick changes by little, in periods
                let scale = largest.max(0.1 / period) * f64::from(u8::from(gain > 0.0));
                let error = (found - expected).abs();
                assert!(error <= tolerance * scale, "{name}, {form}, {gain} Hz, {index}: {found}, not {expected}");
            }
        }
    }
    assert_eq!(words.next(), None, "{name}: more numbers than asked for");
}

/// A period of zero, below zero, and one whose frequency is not finite write zeros, as those of the runtime do.
#[test]
fn the_observer_in_c_without_a_period_writes_zeros() {
    let Some(compiler) = Compiler::found() else { return };
    let robot = Robot::from_yaml(&read(&format!("{ROOT}/robots/planar3.yaml"))).unwrap_or_else(|why| panic!("{why}"));
    let found = of_c::<3>(&compiler, &robot, &[0.0, -1e-3, 2.9e-39, 9e-31].map(|period| [20.0, period]));
    assert_eq!(found, vec![0; 4 * 4 * 3 * TICKS]);
}

#[test]
fn the_observer_in_c_is_that_of_the_runtime() {
    let Some(compiler) = Compiler::found() else { return };
    compare::<3>(&compiler, "robots/planar3");
    compare::<4>(&compiler, "cli/tests/cli/arms/lift");
    if shipped::is_exhaustive() {
        compare::<4>(&compiler, "robots/scara_cobra600");
        compare::<4>(&compiler, "cli/tests/cli/arms/palletizer");
        compare::<6>(&compiler, "cli/tests/cli/arms/wrist");
        compare::<6>(&compiler, "robots/puma560");
    }
}
