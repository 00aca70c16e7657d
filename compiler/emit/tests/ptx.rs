//! Kernels of PTX compute what the processor computes, to the bit, in whatever order a batch lies in memory.

use std::path::Path;

use ptx_interpreter::{Real, read};
use rne_codegen::{Compiler, Form, Function, Interpreter};
use rne_emit::{Additions, Precision, Prefix, ptx};
use rne_machine::{Arguments, Array, CompiledArm, Destination, Number, Rollout};
use rne_runtime::VectorUnit;
use rne_runtime::machine::Kernel;

fn of_file(path: &str) -> CompiledArm {
    CompiledArm::from_file(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)).expect("an arm")
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
        // moments of inertia that a body can have beside these products
        ("payload", 4..=6) => 3.0 + random.f32(),
        ("q", _) => 6.0 * random.f32() - 3.0,
        _ => 2.0 * random.f32() - 1.0,
    };
    let arrays = arm.function(function).expect("a function of the arm").arguments().to_vec();
    let columns = |(array, elements)| {
        (array, (0..elements).map(|element| (0..states).map(|_| number(array, element)).collect()).collect())
    };
    let mut found: Vec<(_, Vec<Vec<f32>>)> = arrays.into_iter().map(columns).collect();
    // those of an angle
    let angles = found.iter().find(|(array, _)| *array == "q").map(|(_, columns)| columns.clone()).unwrap_or_default();
    for (array, columns) in &mut found {
        let of = match *array {
            "sin" => f32::sin,
            "cos" => f32::cos,
            _ => continue,
        };
        *columns = angles.iter().map(|column| column.iter().copied().map(of).collect()).collect();
    }
    found
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

/// A rollout on the processor and its kernel: the states after each step, and those after some steps alone.
fn compare_rollout<T: Number + Real>(arm: &CompiledArm, function: Function, precision: Precision, of: fn(f32) -> T) {
    let program = arm.function(function).expect("a function of the arm").program();
    let (prefix, additions) = (Prefix::of(arm.robot()), Additions { rollout: true, ..Additions::default() });
    let text = ptx(arm.robot(), std::slice::from_ref(program), precision, &prefix, &additions).expect("text");
    let kernels = read(&text);
    assert_eq!(kernels.len(), 4);
    let name = program.name.replace("forward_dynamics", "rollout");
    let (dof, steps, step) = (arm.dof(), 5, 0.004_f32);
    for count in [1, 31, 67] {
        let mut random = fastrand::Rng::with_seed(5);
        // a mass, its centre and the symmetric tensor of a body are given as a payload
        let arrays = arm.function(function).expect("a function of the arm").arguments().to_vec();
        let inputs: Vec<(&str, Vec<T>)> = arrays
            .iter()
            .map(|&(array, elements)| {
                let elements = if array == "tau" { elements * steps } else { elements };
                let number = |at: usize| match (array, at % elements) {
                    ("payload", 4..=6) => of(3.0 + random.f32()),
                    ("payload", _) => of(random.f32()),
                    _ => of(2.0 * random.f32() - 1.0),
                };
                (array, (0..count * elements).map(number).collect())
            })
            .collect();
        let mut arguments = Arguments::new();
        for (array, numbers) in &inputs {
            arguments = arguments.with(array, Array::Rows(numbers)).expect("an argument");
        }
        let [mut q, mut qd] = [(); 2].map(|()| vec![of(0.0); count * steps * dof]);
        arm.rollout(&Rollout::new(steps, step.into()), count, &arguments, &mut q, &mut qd).expect("states");
        if !Kernel::of::<f64>(VectorUnit::widest()).is_fused {
            eprintln!("this processor has no fused multiply-add to compare with");
            return;
        }
        for (every, end) in [1, 2, 5].into_iter().flat_map(|every| ["columns", "rows"].map(|end| (every, end))) {
            let kept = steps / every;
            let in_order = |numbers: &[T]| {
                let of_sample = numbers.len() / count;
                match end {
                    "columns" => (0..numbers.len()).map(|at| numbers[at % count * of_sample + at / count]).collect(),
                    _ => numbers.to_vec(),
                }
            };
            let given: Vec<Vec<T>> = inputs.iter().map(|(_, numbers)| in_order(numbers)).collect();
            let others = [of(step).bits(), steps as u64, every as u64, count as u64];
            let kernel = &kernels[&format!("{}_{name}_{end}", prefix.as_str())];
            let found = kernel.run_with(&given, &[count * kept * dof; 2], &others, 32);
            for (found, all) in found.iter().zip([&q, &qd]) {
                let written = |state: &(usize, &T)| (state.0 / dof % steps + 1).is_multiple_of(every);
                let written: Vec<T> = all
                    .iter()
                    .enumerate()
                    .filter(|state| written(state) && state.0 / dof % steps < kept * every)
                    .map(|state| *state.1)
                    .collect();
                let bits = |numbers: &[T]| numbers.iter().map(|number| number.bits()).collect::<Vec<_>>();
                assert_eq!(bits(found), bits(&in_order(&written)), "{name} {end}, {count} samples, every {every}");
            }
        }
    }
}

#[test]
fn rollouts_have_the_bits_of_the_processor() {
    let of_sliders = shipped("gantry_ppp");
    for arm in [shipped("panda"), shipped("stanford"), of_sliders, of_file("docs/tree.yaml")] {
        compare_rollout::<f64>(&arm, Function::ForwardDynamics, Precision::Double, f64::from);
        compare_rollout::<f32>(&arm, Function::ForwardDynamics, Precision::Single, |x| x);
    }
    let arm = shipped("puma560");
    compare_rollout::<f64>(&arm, Function::ForwardDynamicsWithPayload, Precision::Double, f64::from);
    compare_rollout::<f32>(&arm.in_form(Form::SevenSteps), Function::ForwardDynamics, Precision::Single, |x| x);
}

/// What the interpreter must see: kernels that read or write beside their arrays, and addresses of no number.
#[test]
fn kernels_beside_their_arrays_are_seen() {
    let arm = shipped("planar2");
    let prefix = Prefix::of(arm.robot());
    let text = |function| {
        let program = arm.function(function).expect("a function").program();
        ptx(arm.robot(), std::slice::from_ref(program), Precision::Double, &prefix, &Additions::default())
            .expect("text")
    };
    let good = text(Function::InverseDynamics);
    let run = |text: &str, end: &str, results: usize, numbers: usize| {
        let kernel = read(text).remove(&format!("planar2_inverse_dynamics_{end}")).expect("a kernel");
        let arguments: [Vec<f64>; 3] = [vec![0.5; 10], vec![0.5; numbers], vec![0.5; 10]];
        std::panic::catch_unwind(|| kernel.run(&arguments, results, 5, 64)).is_ok()
    };
    for end in ["columns", "rows"] {
        let seen = |from: &str, to: &str| {
            assert!(good.contains(from), "{from}");
            !run(&good.replace(from, to), end, 10, 10)
        };
        assert!(run(&good, end, 10, 10), "{end}");
        assert!(!run(&good, end, 9, 10) && !run(&good, end, 10, 9), "{end}: arrays that are too short");
        assert!(seen("@%is_beyond ret;", ""), "{end}: threads beyond the last state");
        assert!(seen("ld.param.u64 %out, [out]", "ld.param.u64 %out, [in_q]"), "{end}: results over arguments");
        assert!(seen("ld.param.u64 %in_q, [in_q]", "ld.param.u64 %in_q, [out]"), "{end}: arguments from results");
        assert!(seen("%in_q, %in_q;\n", "%in_q, %in_q;\n    add.u64 %in_q, %in_q, 4;\n"), "{end}: half a number");
        assert!(seen("%out, %out;\n", "%out, %out;\n    add.u64 %out, %out, 4;\n"), "{end}: half a result");
    }
}

/// A rod that falls, in closed form: nothing of it is written twice.
#[test]
fn a_rollout_of_a_slider_is_a_sum() {
    let yaml = "{format: 1, name: slider, source: own, convention: standard, gravity: [0, 0, -10], joints: \
                [{type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2, com: [0, 0, 0]}}]}";
    let arm = CompiledArm::from_yaml(yaml).expect("an arm");
    let program = arm.function(Function::ForwardDynamics).expect("a function").program();
    let (prefix, additions) = (Prefix::of(arm.robot()), Additions { rollout: true, ..Additions::default() });
    let text = ptx(arm.robot(), std::slice::from_ref(program), Precision::Double, &prefix, &additions).expect("text");
    let others = [0.5_f64.to_bits(), 4, 1, 1];
    let arguments = [vec![1.0], vec![3.0], vec![24.0, 24.0, 16.0, 20.0]];
    let found = read(&text)["slider_rollout_rows"].run_with(&arguments, &[4, 4], &others, 64);
    // accelerations 2, 2, -2, 0 m/s²; steps of 0.5 s
    assert_eq!(found, [[3.0, 5.5, 7.5, 9.5], [4.0, 5.0, 4.0, 4.0]]);
}
