//! One robot after the other: C code against derived Rust code, bit for bit. A zero's sign is free, as everywhere.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rne_codegen::plan::PlanSet;
use rne_codegen::{Form, Function, Program};
use rne_emit::Precision;
use rne_model::Robot;
use rne_search::PlanFile;

use crate::compiler::Compiler;
use crate::derived::{Derived, Forms};
use crate::driver::{Driver, Unit};
use crate::special;

pub(crate) const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The functions of a robot in a form.
fn programs(robot: &Robot, plans: &PlanSet, form: Form) -> Vec<Program> {
    let compiler = rne_codegen::Compiler::new(robot).with_plans(plans);
    let compiled = |function| compiler.compile(function, form).unwrap_or_else(|error| panic!("{error}"));
    Function::OF_TREES.map(compiled).to_vec()
}

pub(crate) fn read(path: &str) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Each form in each number type. Of an arm of many joints a plain `cargo test` takes each form and each number type
/// once, because its C code is long: `every_robot.rs` takes all four.
fn units(dof: usize, is_sample: bool) -> impl Iterator<Item = (Form, Precision)> {
    let all = [Form::SevenSteps, Form::Reduced].into_iter().flat_map(|form| Precision::ALL.map(|of| (form, of)));
    all.filter(move |(form, of)| !is_sample || dof <= 4 || (*form == Form::SevenSteps) == (*of == Precision::Single))
}

/// Emits, compiles, runs and compares one robot; returns how many numbers were compared.
fn compare(name: &str, derived: &[(Form, Box<dyn Derived>)], compiler: &Compiler, is_sample: bool) -> usize {
    let robot = Robot::from_yaml(&read(&format!("{ROOT}/robots/{name}.yaml"))).unwrap_or_else(|why| panic!("{why}"));
    let plan = read(&format!("{ROOT}/robots/{name}.plan.yaml"));
    let plan = PlanFile::read(name, &plan, &robot).unwrap_or_else(|report| panic!("{report}"));
    let plans = PlanSet::from(plan);
    let code: Vec<(Form, Vec<Program>)> =
        derived.iter().map(|(form, _)| (*form, programs(&robot, &plans, *form))).collect();

    let of = |form: Form| code.iter().zip(derived).find(|((of, _), _)| *of == form).expect("both forms are derived");
    let units_of_robot = || units(robot.dof(), is_sample);
    let units: Vec<Unit> = units_of_robot()
        .map(|(form, precision)| Unit::new(&robot, &of(form).0.1, precision, format!("{form}_{}", precision.c_type())))
        .collect();
    let states = special::states(&robot);
    let mut found = Driver { name, units: &units, dof: robot.dof() }.run(compiler, &states).into_iter();
    let mut compared = 0;
    for state in &states {
        for (form, precision) in units_of_robot() {
            let ((_, programs), (_, derived)) = of(form);
            for function in programs.iter().map(|program| program.function) {
                let expected = match precision {
                    Precision::Single => words(derived.single(function, &state.single()), |x| x.to_bits().into()),
                    Precision::Double => words(derived.double(function, &state.double()), f64::to_bits),
                };
                let computed: Vec<u64> = found.by_ref().take(expected.len()).collect();
                assert_eq!(computed.len(), expected.len(), "{name}, {function}, {form}: too few numbers");
                for (index, (computed, expected)) in computed.iter().zip(&expected).enumerate() {
                    assert!(
                        is_same(precision, *computed, *expected),
                        "{name}, {function}, {form}, {}, number {index}: {computed:x} in C, {expected:x} in Rust, \
                         at {state:?}",
                        precision.c_type()
                    );
                }
                compared += expected.len();
            }
        }
    }
    assert_eq!(found.next(), None, "{name}: more numbers than asked for");
    compared
}

fn words<T>(numbers: Vec<T>, bits: impl Fn(T) -> u64) -> Vec<u64> {
    numbers.into_iter().map(bits).collect()
}

/// Whether two numbers have the same bits, but for the sign of a zero and what is no number.
#[allow(clippy::cast_possible_truncation)] // the words of single precision have 32 bits
pub(crate) fn is_same(precision: Precision, a: u64, b: u64) -> bool {
    match precision {
        Precision::Single => {
            let [a, b] = [a, b].map(|word| f32::from_bits(word as u32));
            a == b || (a.is_nan() && b.is_nan())
        }
        Precision::Double => {
            let [a, b] = [a, b].map(f64::from_bits);
            a == b || (a.is_nan() && b.is_nan())
        }
    }
}

/// Compares robots on all cores: in all forms and number types, or in a sample of them.
pub(crate) fn compare_all(robots: &[Forms], is_sample: bool) {
    let Some(compiler) = Compiler::found() else { return };
    let (next, compared) = (AtomicUsize::new(0), Mutex::new(0));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from).min(4) {
            scope.spawn(|| {
                while let Some((name, derived)) = robots.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let count = compare(name, derived, &compiler, is_sample);
                    *compared.lock().expect("no panic") += count;
                }
            });
        }
    });
    println!("{} robots, {} numbers with the same bits", robots.len(), compared.into_inner().expect("no panic"));
}
