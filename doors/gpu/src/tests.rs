//! Tests the whole way from an arm to numbers, with a fake driver that runs kernels on the processor. Only the hardware
//! itself is not tested here.

use std::path::{Path, PathBuf};

use rne_machine::{Arguments, Array, CompiledArm, Destination, Function, Number, Rollout};
use rne_runtime::VectorUnit;
use rne_runtime::machine::Kernel;

use crate::{Device, GpuArm, GpuError, GpuRollout, Order, Precision, Real};

/// Returns the path of the library of the crate `fake-driver`, which cargo builds beside the tests.
fn fake() -> PathBuf {
    use fake_driver as _;
    let folder = std::env::current_exe().expect("a program");
    folder.with_file_name(format!("{}fake_driver{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX))
}

fn device() -> Device {
    Device::of_library(&fake(), 0).expect("a driver")
}

fn arm(name: &str) -> CompiledArm {
    let file = rne_robots::find(name).expect("shipped");
    CompiledArm::with_plan(file.yaml, file.plan.expect("a plan")).expect("an arm")
}

/// Returns random values for each argument of a function, state by state.
fn rows<T>(
    arm: &CompiledArm,
    function: Function,
    states: usize,
    steps: usize,
    of: fn(f32) -> T,
) -> Vec<(&'static str, Vec<T>)> {
    let mut random = fastrand::Rng::with_seed(3);
    let arguments = arm.function(function).expect("a function").arguments().to_vec();
    let array = |(name, elements): (&'static str, usize)| {
        let count = elements * states * if name == "tau" { steps } else { 1 };
        // moments of inertia exceed the products of inertia, so that the inertia of the payload is positive about every
        // axis
        let least = |at: usize| if name == "payload" && matches!(at % elements, 4..7) { 3.0 } else { 0.0 };
        (name, (0..count).map(|at| of(least(at) + random.f32())).collect())
    };
    arguments.into_iter().map(array).collect()
}

fn in_columns<T: Copy>(rows: &[T], states: usize) -> Vec<T> {
    let elements = rows.len() / states;
    (0..rows.len()).map(|at| rows[at % states * elements + at / states]).collect()
}

fn given<'a, T: Number>(rows: &'a [(&'static str, Vec<T>)]) -> Arguments<'a, T> {
    rows.iter().fold(Arguments::new(), |arguments, (name, numbers)| {
        arguments.with(name, Array::Rows(numbers)).expect("an argument")
    })
}

/// Asserts that results are close, and that they are equal if the processor has fused multiply-add.
fn agree<T: Number>(found: &[T], expected: &[T], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    if Kernel::of::<f64>(VectorUnit::widest()).is_fused {
        assert!(found == expected, "{what}");
    }
    for (found, expected) in found.iter().zip(expected) {
        let (found, expected): (f64, f64) = ((*found).into(), (*expected).into());
        assert!((found - expected).abs() <= 1e-3 * (1.0 + expected.abs()), "{what}: {found} {expected}");
    }
}

fn compare<T: Number + Real + Default>(name: &str, function: Function, of: fn(f32) -> T) {
    let (arm, states) = (arm(name), 67);
    let rows = rows(&arm, function, states, 1, of);
    let outputs = arm.function(function).expect("a function").outputs();
    let mut expected = vec![of(0.0); outputs * states];
    arm.run(function, states, &given(&rows), Destination::Rows(&mut expected)).expect("results");
    let device = device();
    let gpu = GpuArm::new(&arm, &device);
    for order in [Order::Rows, Order::Columns] {
        let on_card = rows.iter().map(|(name, numbers)| {
            let numbers = if order == Order::Rows { numbers.clone() } else { in_columns(numbers, states) };
            (*name, device.upload(&numbers).expect("memory"))
        });
        let on_card: Vec<_> = on_card.collect();
        let arguments: Vec<_> = on_card.iter().map(|(name, memory)| (*name, memory)).collect();
        let mut results = device.zeros::<T>(outputs * states).expect("memory");
        gpu.run(function, order, states, &arguments, &mut results).expect("results");
        let expected = if order == Order::Rows { expected.clone() } else { in_columns(&expected, states) };
        agree(&results.download().expect("numbers"), &expected, &format!("{name} {function} {order:?}"));
    }
}

#[test]
fn functions_are_those_of_the_processor() {
    compare("panda", Function::InverseDynamics, |x| x);
    compare("panda", Function::InverseDynamics, f64::from);
    compare("puma560", Function::MassMatrix, |x| x);
    compare("puma560", Function::InverseDynamicsWithPayload, f64::from);
}

fn compare_rollout<T: Number + Real + Default>(function: Function, of: fn(f32) -> T) {
    let (arm, samples, steps, step) = (arm("puma560"), 33, 6, 0.01);
    let rows = rows(&arm, function, samples, steps, of);
    let dof = arm.dof();
    let [mut q, mut qd] = [(); 2].map(|()| vec![of(0.0); samples * steps * dof]);
    arm.rollout(&Rollout::new(steps, step), samples, &given(&rows), &mut q, &mut qd).expect("states");
    let device = device();
    let gpu = GpuArm::new(&arm, &device);
    let on_card: Vec<_> = rows.iter().map(|(name, numbers)| (*name, device.upload(numbers).expect("memory"))).collect();
    let arguments: Vec<_> = on_card.iter().map(|(name, memory)| (*name, memory)).collect();
    for every in [1, 6] {
        let rollout = GpuRollout { every, ..GpuRollout::new(6, step) };
        let size = samples * rollout.written() as usize * dof;
        let [mut found_q, mut found_qd] = [(); 2].map(|()| device.zeros::<T>(size).expect("memory"));
        gpu.rollout(&rollout, Order::Rows, samples, &arguments, [&mut found_q, &mut found_qd]).expect("states");
        for (found, all) in [(found_q, &q), (found_qd, &qd)] {
            let expected: Vec<T> =
                all.chunks(steps * dof).flat_map(|sample| sample[steps * dof - size / samples..].to_vec()).collect();
            agree(&found.download().expect("numbers"), &expected, "rollout");
        }
    }
}

#[test]
fn rollouts_are_those_of_the_processor() {
    compare_rollout::<f32>(Function::ForwardDynamics, |x| x);
    compare_rollout::<f64>(Function::ForwardDynamicsWithPayload, f64::from);
}

#[test]
fn a_machine_without_a_driver_is_told_so() {
    let words = |library: &Path, ordinal| Device::of_library(library, ordinal).expect_err("no card").to_string();
    let missing = words(Path::new("/nowhere/libcuda.so.1"), 0);
    assert!(missing.starts_with("no NVIDIA driver: /nowhere/libcuda.so.1 cannot be opened ("), "{missing}");
    assert!(missing.contains("No such file") || !cfg!(target_os = "linux"), "{missing}");
    assert!(missing.contains("a card of NVIDIA and its driver"), "{missing}");
    assert_eq!(words(&fake(), 1), "there is no graphics card 1: this machine has 1, counted from 0");
    // a file that exists but is not the driver
    let other = words(&std::env::current_exe().expect("a program"), 0);
    assert!(other.contains("cannot be opened (") || other.contains("no call cu"), "{other}");
}

#[test]
fn wrong_arguments_are_refused_before_a_launch() {
    let (device, arm) = (device(), arm("puma560"));
    let gpu = GpuArm::new(&arm, &device);
    let six = device.zeros::<f32>(6).expect("memory");
    let mut tau = device.zeros::<f32>(6).expect("memory");
    let mut run = |arguments: &[(&str, &crate::Memory<f32>)], states| {
        gpu.run(Function::InverseDynamics, Order::Rows, states, arguments, &mut tau).expect_err("wrong").to_string()
    };
    let all = [("q", &six), ("qd", &six), ("qdd", &six)];
    assert_eq!(run(&all[..2], 1), "the argument `qdd` is missing; the function takes q, qd, qdd");
    assert_eq!(run(&[("speed", &six)], 1), "the function has no argument `speed`; it takes q, qd, qdd");
    assert_eq!(run(&all, 2), "`q` has 6 numbers, but it must have 12");
    assert_eq!(run(&[], 1), "the argument `q` is missing; the function takes q, qd, qdd");
    let short = device.zeros::<f32>(5).expect("memory");
    assert_eq!(run(&[("q", &short), all[1], all[2]], 1), "`q` has 5 numbers, but it must have 6");
    let other = Device::of_library(&fake(), 0).expect("a driver");
    let elsewhere = other.zeros::<f32>(6).expect("memory");
    assert!(run(&[("q", &elsewhere), all[1], all[2]], 1).contains("on another graphics card"));

    let rolled = |rollout: &GpuRollout| {
        let size = (6 * rollout.written()) as usize;
        let tau = device.zeros::<f32>(6 * rollout.steps as usize).expect("memory");
        let [mut q, mut qd] = [(); 2].map(|()| device.zeros::<f32>(size).expect("memory"));
        let arguments = [all[0], all[1], ("tau", &tau)];
        gpu.rollout(rollout, Order::Rows, 1, &arguments, [&mut q, &mut qd]).expect_err("wrong").to_string()
    };
    assert_eq!(rolled(&GpuRollout::new(0, 0.1)), "`steps` is 0, but it must be from 1 to 2147483647");
    assert_eq!(rolled(&GpuRollout { every: 0, ..GpuRollout::new(3, 0.1) }), "`every` is 0, but it must be from 1 to 3");
    assert_eq!(rolled(&GpuRollout { every: 4, ..GpuRollout::new(3, 0.1) }), "`every` is 4, but it must be from 1 to 3");
    // in `f32` the last two are 0 and infinite
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-60, 1e60] {
        let said = rolled(&GpuRollout::new(3, step));
        assert!(said.starts_with(&format!("`step` is {step} s, but it must be a finite number above zero")), "{said}");
    }
    let unfit = gpu.prepare(Function::MassMatrix, Precision::Single, true).expect_err("no accelerations").to_string();
    assert_eq!(unfit, "no rollout is possible by mass_matrix; by forward_dynamics it is");
}

#[test]
fn a_text_that_the_driver_refuses_gives_its_log() {
    let device = device();
    let refused = device.driver().module(device.context(), "not PTX").expect_err("a translation");
    assert!(matches!(&refused, GpuError::Translation { log } if log.starts_with("line 1: error")), "{refused}");
    assert!(refused.to_string().contains("The driver says: line 1: error"), "{refused}");
}
