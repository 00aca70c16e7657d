//! Kernels of PTX compute what the processor computes, to the bit, in whatever order a batch lies in memory.

mod ptx_interpreter;

use std::path::Path;

use ptx_interpreter::{Real, read};
use rne_codegen::{Compiler, Form, Function, Interpreter};
use rne_emit::{Additions, Precision, Prefix, ptx};
use rne_machine::{Arguments, Array, CompiledArm, Destination, Number};
use rne_runtime::VectorUnit;
use rne_runtime::machine::Kernel;

fn of_file(path: &str) -> CompiledArm {
    CompiledArm::from_file(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).expect("an arm")
}

fn shipped(name: &str) -> CompiledArm {
    let file = rne_robots::find(name).expect("shipped");
    match file.plan {
        Some(plan) => CompiledArm::with_plan(file.yaml, plan).expect("an arm"),
        None => CompiledArm::from_yaml(file.yaml).expect("an arm"),
    }
}

/// States that are the same numbers in both precisions: for each array its columns.
fn states(arm: &CompiledArm, function: Function, states: usize) -> Vec<(&'static str, Vec<Vec<f32>>)> {
    let mut random = fastrand::Rng::with_seed(11);
    let mut number = |array: &str, element: usize| match (array, element) {
        ("payload", 0) => 1.0 + random.f32(),
        ("q", _) => 6.0 * random.f32() - 3.0,
        _ => 2.0 * random.f32() - 1.0,
    };
    let arrays = arm.function(function).expect("a function of the arm").arguments().to_vec();
    let columns = |(array, elements)| {
        (array, (0..elements).map(|element| (0..states).map(|_| number(array, element)).collect()).collect())
    };
    arrays.into_iter().map(columns).collect()
}

/// The kernels of a function on these states, by columns and by rows, beside what the processor computes.
fn compare<T: Number + Real + PartialEq + std::fmt::Debug>(
    arm: &CompiledArm,
    function: Function,
    precision: Precision,
    of: fn(f32) -> T,
) {
    let program = arm.function(function).expect("a function of the arm").program();
    let prefix = Prefix::of(arm.robot());
    let text =
        ptx(arm.robot(), std::slice::from_ref(program), precision, &prefix, &Additions::default()).expect("text");
    let kernels = read(&text);
    assert_eq!(kernels.len(), 2);
    // one thread, an incomplete block, some blocks of which the last is incomplete
    for count in [1_usize, 31, 67] {
        let inputs = states(arm, function, count);
        let numbers: Vec<Vec<Vec<T>>> = inputs
            .iter()
            .map(|(_, columns)| columns.iter().map(|column| column.iter().map(|x| of(*x)).collect()).collect())
            .collect();
        let slices: Vec<Vec<&[T]>> = numbers.iter().map(|array| array.iter().map(Vec::as_slice).collect()).collect();
        let mut arguments = Arguments::new();
        for ((array, _), columns) in inputs.iter().zip(&slices) {
            arguments = arguments.with(array, Array::Columns(columns)).expect("an argument");
        }
        let outputs = program.outputs.len();
        let mut expected = vec![of(0.0); outputs * count];
        arm.run(function, count, &arguments, Destination::Rows(&mut expected)).expect("results");

        let run = |end: &str, arrays: &[Vec<T>]| {
            let kernel = &kernels[&format!("{}_{}_{end}", prefix.as_str(), program.name)];
            kernel.run(arrays, outputs * count, u32::try_from(count).expect("few"), 32)
        };
        let columns: Vec<Vec<T>> = numbers.iter().map(|array| array.concat()).collect();
        let by_state =
            |array: &Vec<Vec<T>>| (0..count).flat_map(|state| array.iter().map(move |column| column[state])).collect();
        let rows: Vec<Vec<T>> = numbers.iter().map(by_state).collect();
        let by_columns = run("columns", &columns);
        let by_columns = (0..count)
            .flat_map(|state| (0..outputs).map(|output| by_columns[output * count + state]).collect::<Vec<_>>());
        let by_rows = run("rows", &rows);
        let what = format!("{} of {}, {count} states, {precision:?}", program.name, arm.robot().name);
        let bits = |numbers: &[T]| numbers.iter().map(|number| number.bits()).collect::<Vec<_>>();
        assert_eq!(bits(&by_columns.collect::<Vec<_>>()), bits(&by_rows), "{what}");
        if Kernel::of::<f64>(VectorUnit::widest()).is_fused {
            assert_eq!(bits(&by_rows), bits(&expected), "{what}");
        } else {
            eprintln!("{what}: this processor has no fused multiply-add to compare with");
        }
    }
}

fn compare_both(arm: &CompiledArm, functions: &[Function]) {
    for &function in functions {
        compare::<f64>(arm, function, Precision::Double, f64::from);
        compare::<f32>(arm, function, Precision::Single, |x| x);
    }
}

#[test]
fn torques_of_every_shipped_arm_have_the_bits_of_the_processor() {
    for file in rne_robots::ROBOTS {
        compare_both(&shipped(file.name), &[Function::InverseDynamics]);
    }
}

#[test]
fn functions_of_an_arm_have_the_bits_of_the_processor() {
    // products and sums, divisions, records, run-time payloads, values chosen by a sign
    let functions = [
        Function::InverseDynamicsWithWrench,
        Function::InverseDynamicsWithPayload,
        Function::InverseDynamicsFromSinCos,
        Function::MassMatrix,
        Function::ForwardDynamics,
        Function::ForwardKinematics,
        Function::KineticEnergy,
        Function::InverseDynamicsDerivatives,
        Function::JointWrenches,
        Function::ActuatorTorques,
    ];
    compare_both(&shipped("puma560"), &functions);
    compare_both(&shipped("panda").in_form(Form::SevenSteps), &[Function::InverseDynamics]);
}

#[test]
fn trees_floating_bases_and_closed_loops_have_the_bits_of_the_processor() {
    compare_both(&of_file("docs/tree.yaml"), &[Function::InverseDynamics, Function::MassMatrix]);
    compare_both(
        &of_file("benches/trees/go2_floating.yaml"),
        &[Function::InverseDynamicsOfFloatingBase, Function::FloatingForwardDynamics, Function::FloatingMassMatrix],
    );
    compare_both(
        &of_file("docs/four_bar.yaml"),
        &[Function::InverseDynamicsOfLoops, Function::ForwardDynamicsOfLoops, Function::ClosureStep],
    );
}

/// The interpreter of programs rounds every operation by itself and has the sine of the standard library: another
/// oracle, for processors without fused multiply-add as well.
#[test]
fn a_kernel_gives_the_torques_of_the_interpreter_of_programs() {
    let robot = rne_model::Robot::from_yaml(rne_robots::find("puma560").expect("shipped").yaml).expect("a robot");
    let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).expect("a program");
    let text =
        ptx(&robot, std::slice::from_ref(&program), Precision::Double, &Prefix::of(&robot), &Additions::default());
    let kernels = read(&text.expect("text"));
    let (q, qd, qdd) =
        ([0.3, -0.8, 2.4, 1.0, -50.5, -0.2], [0.1, 1.3, -2.0, 0.4, 3.0, -1.0], [0.7, -5.0, 1.0, 2.0, 0.3, 9.0]);
    let arguments = rne_codegen::Arguments::of_joints(&q, &qd, &qdd, 0.0);
    let expected = Interpreter::new(&program).run(&arguments, |x| x, f64::sin_cos).expect("all arguments");
    let found = kernels["puma560_inverse_dynamics_rows"].run(&[q, qd, qdd].map(Vec::from), 6, 1, 256);
    let scale = expected.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 4e-15 * scale, "{found} {expected}");
    }
}

#[test]
fn text_is_ascii_in_short_lines() {
    for name in ["panda", "stanford"] {
        let arm = shipped(name);
        let program = arm.function(Function::InverseDynamicsDerivatives).expect("a function").program().clone();
        let text = ptx(arm.robot(), &[program], Precision::Single, &Prefix::of(arm.robot()), &Additions::default());
        let text = text.expect("text");
        assert!(text.is_ascii());
        assert!(text.lines().all(|line| line.len() <= 120), "{name}");
    }
}

/// Arguments and results of 64 states that take more than 48 KiB are read and written where they lie.
#[test]
fn rows_that_are_too_long_for_shared_memory_stay_where_they_are() {
    let arm = shipped("panda");
    for (precision, is_shared) in [(Precision::Single, true), (Precision::Double, false)] {
        let program = arm.function(Function::InverseDynamicsDerivatives).expect("a function").program();
        let text =
            ptx(arm.robot(), std::slice::from_ref(program), precision, &Prefix::of(arm.robot()), &Additions::default());
        assert_eq!(text.expect("text").contains(".shared"), is_shared, "{precision:?}");
    }
    compare::<f64>(&arm, Function::InverseDynamicsDerivatives, Precision::Double, f64::from);
    compare::<f32>(&arm, Function::InverseDynamicsDerivatives, Precision::Single, |x| x);
}
