//! Native code has the bits of the machine: every shipped robot, every function, both forms, on every vector unit.

use rne_codegen::{Compiler, Form, Function, Program};
use rne_machine::{Machine, Native, Number};
use rne_robots::RobotFile;
use rne_runtime::VectorUnit;
use rne_search::PlanFile;

/// Inputs of a state: ordinary ones, and some that the kernel of sines and cosines is not made for.
fn states<T: Number>(inputs: usize, random: &mut fastrand::Rng, number: impl Fn(f64) -> T) -> Vec<Vec<T>> {
    let mut states: Vec<Vec<f64>> =
        [0.0, 3.0, 300.0].map(|width| (0..inputs).map(|_| width * (2.0 * random.f64() - 1.0)).collect()).into();
    // around the limit of the sum of squares, and that of each angle
    for special in [9.9e4, 9.9999e4, 1.00001e5, 1e9, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -0.0] {
        let mut state: Vec<f64> = (0..inputs).map(|_| 6.0 * (random.f64() - 0.5)).collect();
        for number in &mut state {
            if random.u8(..3) == 0 {
                *number = special;
            }
        }
        states.push(state);
    }
    states.into_iter().map(|state| state.into_iter().map(&number).collect()).collect()
}

/// How many results were compared.
fn compare<T: Number>(name: &str, program: &Program, random: &mut fastrand::Rng, number: impl Fn(f64) -> T) -> usize {
    let machine = Machine::new(program).expect("a small program");
    let states = states(machine.inputs().len(), random, number);
    let mut compared = 0;
    for unit in VectorUnit::all() {
        let native = Native::<T>::on(unit, program).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(native.inputs(), machine.inputs());
        let [mut expected, mut found] = [(); 2].map(|()| vec![T::from_f64(7.0); program.outputs.len()]);
        for state in &states {
            machine.code().run_one(unit, state, &mut expected).expect("arrays of these lengths");
            native.call(state, &mut found).expect("arrays of these lengths");
            for (index, (expected, found)) in expected.iter().zip(&found).enumerate() {
                let (expected, found): (f64, f64) = ((*expected).into(), (*found).into());
                let is_equal = expected.to_bits() == found.to_bits() || expected.is_nan() && found.is_nan();
                let function = program.function.name();
                assert!(is_equal, "{name}, {function}, {unit}, output {index}: {found} for {expected} of {state:?}");
                compared += 1;
            }
        }
    }
    compared
}

fn with_compiler(file: &RobotFile, check: impl FnOnce(&Compiler<'_>)) {
    let robot = rne_model::Robot::from_yaml(file.yaml).expect("a shipped robot");
    let mut compiler = Compiler::new(&robot);
    if let Some(plan) = file.plan {
        compiler = compiler.with_plans(PlanFile::read(file.name, plan, &robot).expect("a shipped plan"));
    }
    check(&compiler);
}

/// A part of all; with `RNE_EXHAUSTIVE` set, all, which takes minutes in a release build.
#[test]
fn native_code_has_the_bits_of_the_machine() {
    let is_exhaustive = std::env::var_os("RNE_EXHAUSTIVE").is_some();
    let mut random = fastrand::Rng::with_seed(6);
    let (mut programs, mut compared) = (0, 0);
    for (at, file) in rne_robots::ROBOTS.iter().enumerate() {
        with_compiler(file, |compiler| {
            let all = Function::OF_TREES.into_iter().flat_map(|function| Form::ALL.map(|form| (function, form)));
            for (index, (function, form)) in all.enumerate() {
                // each function of some robots, some functions of each robot
                if !is_exhaustive && (index + 5 * at) % 29 != 0 {
                    continue;
                }
                let Ok(program) = compiler.compile(function, form) else { continue };
                compared += compare::<f64>(file.name, &program, &mut random, |number| number);
                #[allow(clippy::cast_possible_truncation)]
                let single = |number: f64| number as f32;
                compared += compare::<f32>(file.name, &program, &mut random, single);
                programs += 1;
            }
        });
    }
    println!("{programs} programs, {compared} results");
    assert!(compared > 10_000);
}

/// Torques of a link go to the link that carries it, whichever row that is.
#[test]
fn native_code_of_a_tree_has_the_bits_of_the_machine() {
    let text = include_str!("../../../docs/tree.yaml");
    let robot = rne_model::Reader::new("tree.yaml").trees().read(text).expect("a robot file").robot;
    let compiler = Compiler::new(&robot);
    let mut random = fastrand::Rng::with_seed(30);
    for function in [Function::InverseDynamics, Function::MassMatrix, Function::ForwardDynamics, Function::Jacobian] {
        for form in Form::ALL {
            let program = compiler.compile(function, form).expect("a program");
            compare::<f64>("tree", &program, &mut random, |number| number);
        }
    }
}

/// Joints that do not turn, functions of no input, outputs that are inputs or constants.
#[test]
fn programs_of_nearly_nothing() {
    let joint = "{type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 0, com: [0, 0, 0]}}";
    let yaml =
        format!("{{format: 1, name: slide, source: own, convention: standard, gravity: [0, 0, 0], joints: [{joint}]}}");
    let robot = rne_model::Robot::from_yaml(&yaml).expect("a robot file");
    let compiler = Compiler::new(&robot);
    let mut random = fastrand::Rng::with_seed(7);
    let (mut without_inputs, mut without_turns) = (0, 0);
    for function in Function::OF_TREES {
        for form in Form::ALL {
            let Ok(mut program) = compiler.compile(function, form) else { continue };
            without_inputs += usize::from(program.arguments().next().is_none());
            without_turns += usize::from(program.sines_and_cosines.is_empty());
            compare::<f64>("slide", &program, &mut random, |number| number);
            program.outputs.clear();
            compare::<f64>("slide", &program, &mut random, |number| number);
        }
    }
    assert!(without_inputs > 0 && without_turns > 0);
}

#[test]
fn what_an_output_may_be() {
    with_compiler(rne_robots::find("puma560").expect("it is shipped"), |compiler| {
        let mut program = compiler.compile(Function::InverseDynamics, Form::Reduced).expect("it compiles");
        let zero = program.values.push(None, rne_codegen::Value::Constant(0.0));
        let values: Vec<rne_codegen::ValueId> = program.values.iter().map(|(id, _)| id).collect();
        let is_named = |id: &&rne_codegen::ValueId| program.values.name(**id).is_some() || **id == zero;
        let mut outputs = program.outputs.iter().cycle().cloned();
        program.outputs = values
            .iter()
            .chain(&values)
            .filter(is_named)
            .filter_map(|value| Some(rne_codegen::Output { value: *value, ..outputs.next()? }))
            .collect();
        compare::<f64>("outputs", &program, &mut fastrand::Rng::with_seed(8), |number| number);
    });
}

#[test]
fn arrays_of_wrong_lengths_are_refused() {
    with_compiler(rne_robots::find("puma560").expect("it is shipped"), |compiler| {
        let program = compiler.compile(Function::GravityTorques, Form::Reduced).expect("it compiles");
        let native = Native::<f64>::new(&program).expect("native code");
        let inputs = vec![0.1; native.inputs().len()];
        let mut outputs = vec![7.0; program.outputs.len() + 1];
        assert!(native.call(&inputs, &mut outputs).is_err());
        outputs.pop();
        assert!(native.call(&inputs[1..], &mut outputs).is_err());
        assert!(native.call(&[], &mut []).is_err());
        assert!(outputs.iter().all(|output| *output == 7.0));
        native.call(&inputs, &mut outputs).expect("these lengths");
    });
}

#[test]
fn code_goes_to_other_threads_and_its_memory_is_freed() {
    with_compiler(rne_robots::find("puma560").expect("it is shipped"), |compiler| {
        let program = compiler.compile(Function::GravityTorques, Form::Reduced).expect("it compiles");
        for _ in 0..20 {
            let native = Native::<f64>::new(&program).expect("native code");
            let inputs = vec![0.1; native.inputs().len()];
            let call = || {
                let mut outputs = vec![0.0; program.outputs.len()];
                native.call(&inputs, &mut outputs).expect("these lengths");
                outputs
            };
            let results = std::thread::scope(|scope| {
                [(); 3].map(|()| scope.spawn(call)).map(|thread| thread.join().expect("no panic"))
            });
            assert!(results.iter().all(|result| *result == results[0]));
            // to another thread, and dropped there
            std::thread::spawn(move || drop(native)).join().expect("no panic");
        }
    });
}
