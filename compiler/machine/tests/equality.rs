//! The machine against the interpreter of programs, an independent reader of the same text: every shipped robot, every
//! function, both forms. On a unit without fused multiply-add to the bit.

use fastrand::Rng;
use rne_codegen::CheckFor as _;
use rne_codegen::{Arguments as Numbers, Compiler, Interpreter, Target};
use rne_machine::{Arguments, Array, CompiledArm, Destination, Form, Function, OutOfRange};
use rne_model::Robot;
use rne_runtime::{Payload, Quaternion, Scalar, VectorUnit};
use rne_search::PlanFile;

/// States: some blocks, and some that fill none.
const STATES: usize = 150;

/// Arguments and their elements for any function of an arm.
fn widths(dof: usize) -> [(&'static str, usize); 20] {
    [
        ("q", dof),
        ("qd", dof),
        ("qdd", dof),
        ("tau", dof),
        ("sin", dof),
        ("cos", dof),
        ("force", 3),
        ("moment", 3),
        ("payload", 10),
        ("base_omega", 3),
        ("omega", 3),
        ("base_omega_dot", 3),
        ("base_acceleration", 3),
        ("base_gravity", 3),
        // one tip
        ("wrenches", 6),
        ("twist", 6),
        ("pose", 12),
        ("base_rotation", 9),
        ("multipliers", dof),
        ("step", 1),
    ]
}

/// Random numbers of every argument, state by state.
struct States {
    dof: usize,
    rows: Vec<Vec<f64>>,
}

/// The rows of a random rotation.
fn rotation(rng: &mut Rng) -> [f64; 9] {
    let turn = Quaternion::identity().turned_by([(); 3].map(|()| 6.0 * rng.f64() - 3.0));
    turn.rotation().concat().try_into().expect("nine")
}

/// Whether a robot has a function, so that an arm that is compiled at run time has it.
fn has(arm: &CompiledArm, function: Function) -> bool {
    function.check_for(arm.robot()).is_ok()
}

impl States {
    fn random(rng: &mut Rng, dof: usize) -> Self {
        let mut rows: Vec<Vec<f64>> = widths(dof)
            .iter()
            .map(|(name, width)| {
                let scale = if *name == "q" { 3.0 } else { 5.0 };
                (0..STATES * width).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect()
            })
            .collect();
        // those of the positions
        let q = rows[0].clone();
        rows[4] = q.iter().map(|&q| Scalar::sin_cos(q).0).collect();
        rows[5] = q.iter().map(|&q| Scalar::sin_cos(q).1).collect();
        // no payload has a mass or a principal moment of inertia below zero
        for payload in rows[8].chunks_mut(10) {
            payload[0] = payload[0].abs();
            payload[4..7].iter_mut().for_each(|moment| *moment = 10.0 + moment.abs());
        }
        // no step goes back in time
        rows[19].iter_mut().for_each(|step| *step = step.abs());
        let rotations: Vec<[f64; 9]> = (0..STATES).map(|_| rotation(rng)).collect();
        rows[17] = rotations.concat();
        for (pose, rotation) in rows[16].chunks_mut(12).zip(&rotations) {
            pose[..9].copy_from_slice(rotation);
        }
        // the base has one angular velocity
        let omega = rows[9].clone();
        for (twist, omega) in rows[15].chunks_mut(6).zip(omega.chunks(3)) {
            twist[3..].copy_from_slice(omega);
        }
        rows[10] = omega;
        // the interpreter has one array for both
        let tau = rows[3].clone();
        rows[18] = tau;
        Self { dof, rows }
    }

    fn given<'a>(&'a self, array: impl Fn(usize, usize) -> Array<'a, f64>) -> Arguments<'a, f64> {
        let all = widths(self.dof).into_iter().enumerate();
        all.fold(Arguments::new(), |given, (index, (name, width))| {
            given.with(name, array(index, width)).expect("an argument of this name")
        })
    }

    fn by_rows(&self) -> Arguments<'_, f64> {
        self.given(|index, _| Array::Rows(&self.rows[index]))
    }

    fn of_state(&self, state: usize) -> Arguments<'_, f64> {
        self.given(|index, width| Array::Same(&self.rows[index][state * width..][..width]))
    }

    fn interpreted(&self, interpreter: &Interpreter, state: usize) -> Vec<f64> {
        let of = |index: usize, width: usize| &self.rows[index][state * width..][..width];
        let joints = |index: usize| of(index, self.dof);
        let triple = |index: usize| of(index, 3).try_into().expect("three");
        let numbers = Numbers {
            tau: joints(3),
            force: triple(6),
            moment: triple(7),
            wrenches: &[of(14, 6).try_into().expect("one tip")],
            payload: of(8, 10).try_into().expect("ten"),
            base: [9, 11, 12, 13].map(triple),
            velocity: of(15, 6)[..3].try_into().expect("three"),
            pose: of(16, 12).try_into().expect("twelve"),
            step: of(19, 1)[0],
            base_rotation: of(17, 9).try_into().expect("nine"),
            ..Numbers::of_joints(joints(0), joints(1), joints(2), 0.0)
        };
        interpreter.run(&numbers, f64::from_f64, Scalar::sin_cos).expect("arrays of the right length")
    }
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

/// Whether two numbers have the same bits, or are none both.
fn are_same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan())
}

/// The shipped robots that are tried, as they are shipped: by their plans.
fn arms() -> impl Iterator<Item = CompiledArm> {
    shipped::tried().map(|file| {
        let arm = match file.plan {
            Some(plan) => CompiledArm::with_plan(file.yaml, plan),
            None => CompiledArm::from_yaml(file.yaml),
        };
        arm.unwrap_or_else(|error| panic!("{}: {error}", file.name))
    })
}

/// What compiles the same programs.
fn compiler(robot: &Robot) -> Compiler<'_> {
    let compiler = Compiler::new(robot).for_target(Target::Throughput);
    match rne_robots::find(&robot.name).and_then(|file| file.plan) {
        Some(plan) => compiler.with_plans(PlanFile::read("plan", plan, robot).expect("a shipped plan")),
        None => compiler,
    }
}

#[test]
fn every_function_of_every_robot_is_the_program() {
    let mut rng = Rng::with_seed(14);
    let (mut compared, mut worst) = (0_usize, 0.0_f64);
    for arm in arms().step_by(if shipped::is_exhaustive() { 1 } else { 2 }) {
        let robot = arm.robot();
        let states = States::random(&mut rng, robot.dof());
        let compiler = compiler(robot);
        for form in Form::ALL {
            let arm = arm.in_form(form);
            for function in Function::OF_TREES {
                let program = compiler.compile(function, form).unwrap_or_else(|error| panic!("{function}: {error}"));
                let interpreter = Interpreter::new(&program);
                let expected: Vec<f64> =
                    (0..STATES).flat_map(|state| states.interpreted(&interpreter, state)).collect();
                if function.check_base(robot).is_err() {
                    let said = arm.function(function).expect_err("no base").to_string();
                    assert!(said.contains(&format!("the file of {} has no `floating_base`", robot.name)), "{said}");
                    continue;
                }
                let compiled = arm.function(function).expect("a function that compiles");
                for (index, unit) in VectorUnit::all().enumerate() {
                    let mut found = vec![f64::NAN; expected.len()];
                    let rows = Destination::Rows(&mut found);
                    compiled.run(unit, STATES, &states.by_rows(), rows).expect("arrays of one length");
                    compared += found.len();
                    let what = format!("{}, {function}, {form}, {unit}", robot.name);
                    if index == 0 && !cfg!(target_feature = "fma") {
                        assert!(are_same(&found, &expected), "{what}: {found:?} {expected:?}");
                    }
                    // A fused multiply-add rounds once, on the scale of what is summed: of the largest of all states
                    // where results are sums, of a state's where a matrix that may be nearly singular is divided by.
                    let width = compiled.outputs();
                    let (of_all, divides) = (largest(&expected), function.divides().is_some());
                    for (found, expected) in found.chunks(width).zip(expected.chunks(width)) {
                        let difference = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                        let (scale, limit) = if divides { (largest(expected), 1e-9) } else { (of_all, 1e-13) };
                        let error = difference / scale.max(1e-300);
                        assert!(error <= limit || expected.iter().any(|x| !x.is_finite()), "{what}: {error:e}");
                        worst = worst.max(if divides { 0.0 } else { error });
                    }
                }
            }
        }
    }
    println!("{compared} numbers, worst with fused multiply-add {worst:.1e} of the largest of a result");
}

#[test]
fn a_state_has_the_same_bits_in_every_layout_and_alone() {
    let mut rng = Rng::with_seed(15);
    for arm in arms() {
        let robot = arm.robot();
        let states = States::random(&mut rng, robot.dof());
        let columns: Vec<Vec<Vec<f64>>> = widths(robot.dof())
            .iter()
            .zip(&states.rows)
            .map(|((_, width), rows)| {
                (0..*width).map(|element| rows.iter().skip(element).step_by(*width).copied().collect()).collect()
            })
            .collect();
        let slices: Vec<Vec<&[f64]>> =
            columns.iter().map(|columns| columns.iter().map(Vec::as_slice).collect()).collect();
        // as numpy has them in Fortran's order
        let of_fortran: Vec<Vec<f64>> = columns.iter().map(|columns| columns.concat()).collect();
        for function in
            [Function::InverseDynamics, Function::MassMatrix, Function::ForwardDynamics, Function::LinkPoses]
        {
            let compiled = arm.function(function).expect("a function that compiles");
            for unit in VectorUnit::all() {
                let width = compiled.outputs();
                let run = |arguments: &Arguments<'_, f64>| {
                    let mut found = vec![f64::NAN; STATES * width];
                    compiled.run(unit, STATES, arguments, Destination::Rows(&mut found)).expect("arrays of one length");
                    found
                };
                let expected = run(&states.by_rows());
                assert!(are_same(&expected, &run(&states.given(|index, _| Array::Columns(&slices[index])))));
                let strided =
                    |index: usize, _| Array::Strided { numbers: &of_fortran[index], state: 1, element: STATES };
                assert!(are_same(&expected, &run(&states.given(strided))), "{}, {function}, {unit}", robot.name);

                let mut found: Vec<Vec<f64>> = vec![vec![f64::NAN; STATES]; width];
                let room = Destination::Columns(found.iter_mut().map(Vec::as_mut_slice).collect());
                compiled.run(unit, STATES, &states.by_rows(), room).expect("arrays of one length");
                let as_rows: Vec<f64> =
                    (0..STATES).flat_map(|state| found.iter().map(move |column| column[state])).collect();
                assert!(are_same(&expected, &as_rows), "{}, {function}, {unit}: columns", robot.name);

                for (state, expected) in expected.chunks(width).enumerate() {
                    let mut found = vec![f64::NAN; width];
                    compiled.run_one(unit, &states.of_state(state), &mut found).expect("arrays of one length");
                    assert!(are_same(expected, &found), "{}, {function}, {unit}: state {state} alone", robot.name);
                }
            }
        }
    }
}

/// Angles beyond the kernel of sine and cosine, infinities and NaN: as in single calls, and no neighbour notices.
/// More numbers than find room on the stack of a single call.
#[test]
fn a_long_arm_is_computed_alone_as_among_others() {
    const JOINTS: usize = 24;
    let joint = "  - {type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: pi/2}, link: {mass: 1, com: [-0.1, 0, 0]}}\n";
    let head = "format: 1\nname: snake\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
    let arm = CompiledArm::from_yaml(&(head.to_owned() + &joint.repeat(JOINTS))).expect("an arm");
    let mut rng = Rng::with_seed(24);
    let rows: Vec<f64> = (0..3 * 3 * JOINTS).map(|_| rng.f64()).collect();
    let [q, qd, qdd] = [0, 1, 2].map(|index| &rows[index * 3 * JOINTS..][..3 * JOINTS]);
    let given = Arguments::new().q(Array::Rows(q)).qd(Array::Rows(qd)).qdd(Array::Rows(qdd));
    let mut many = [0.0; 3 * JOINTS];
    arm.run(Function::InverseDynamics, 3, &given, Destination::Rows(&mut many)).expect("numbers");
    for state in 0..3 {
        let part = |rows: &'_ [f64]| rows[state * JOINTS..][..JOINTS].to_vec();
        let one = arm.inverse_dynamics(&part(q), &part(qd), &part(qdd)).expect("numbers");
        assert!(are_same(&one, &part(&many)));
    }
}

#[test]
fn large_angles_and_no_numbers_stay_with_their_state() {
    let arm = arms().find(|arm| arm.robot().name == "puma560").expect("a shipped robot");
    let robot = arm.robot();
    let mut rng = Rng::with_seed(16);
    let mut states = States::random(&mut rng, robot.dof());
    let compiled = arm.function(Function::InverseDynamics).expect("a function that compiles");
    let run = |states: &States, unit| {
        let mut found = vec![f64::NAN; STATES * 6];
        compiled.run(unit, STATES, &states.by_rows(), Destination::Rows(&mut found)).expect("arrays of one length");
        found
    };
    let before: Vec<Vec<f64>> = VectorUnit::all().map(|unit| run(&states, unit)).collect();
    let strange = [(3, 1e5 + 1.0), (17, -3e8), (64, f64::INFINITY), (149, f64::NAN)];
    for (state, angle) in strange {
        states.rows[0][state * 6 + 2] = angle;
    }
    let program = compiler(robot).compile(Function::InverseDynamics, Form::Reduced).expect("a program");
    let interpreter = Interpreter::new(&program);
    for (unit, before) in VectorUnit::all().zip(before) {
        let found = run(&states, unit);
        for state in 0..STATES {
            let of = |numbers: &[f64]| numbers[state * 6..][..6].to_vec();
            match strange.iter().find(|(of, _)| *of == state) {
                None => assert!(are_same(&of(&found), &of(&before)), "{unit}: state {state}"),
                Some((_, angle)) => {
                    let expected = states.interpreted(&interpreter, state);
                    let error = largest(&of(&found).iter().zip(&expected).map(|(a, b)| a - b).collect::<Vec<_>>());
                    assert_eq!(of(&found).iter().any(|x| x.is_nan()), !angle.is_finite(), "{unit}: {angle}");
                    assert!(!angle.is_finite() || error <= 1e-12 * largest(&expected), "{unit}: {angle}: {error:e}");
                }
            }
        }
    }
}

/// In single precision: within its rounding of double precision.
#[test]
fn single_precision_is_near() {
    let mut rng = Rng::with_seed(17);
    for arm in arms() {
        let robot = arm.robot();
        let states = States::random(&mut rng, robot.dof());
        let compiled = arm.function(Function::InverseDynamics).expect("a function that compiles");
        let mut expected = vec![f64::NAN; STATES * robot.dof()];
        #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
        let rows: Vec<Vec<f32>> = states.rows[..3].iter().map(|row| row.iter().map(|&x| x as f32).collect()).collect();
        let rounded: Vec<Vec<f64>> = rows.iter().map(|row| row.iter().map(|&x| x.into()).collect()).collect();
        let [q, qd, qdd] = [0, 1, 2].map(|index| Array::Rows(&rounded[index]));
        let arguments = Arguments::new().q(q).qd(qd).qdd(qdd);
        let room = Destination::Rows(&mut expected);
        compiled.run(VectorUnit::widest(), STATES, &arguments, room).expect("arrays of one length");
        let [q, qd, qdd] = [0, 1, 2].map(|index| Array::Rows(&rows[index][..]));
        let arguments = Arguments::new().q(q).qd(qd).qdd(qdd);
        for unit in VectorUnit::all() {
            let mut found = vec![f32::NAN; expected.len()];
            compiled.run(unit, STATES, &arguments, Destination::Rows(&mut found)).expect("arrays of one length");
            let error = found.iter().zip(&expected).map(|(&a, b)| (f64::from(a) - b).abs()).fold(0.0, f64::max);
            assert!(error <= 2e-5 * largest(&expected), "{}, {unit}: {error:e}", robot.name);
        }
    }
}

/// In every layout and precision, alone and among others, and nothing is written.
#[test]
fn a_payload_of_negative_mass_is_refused() {
    let arm = arms().find(|arm| arm.robot().name == "planar2").expect("a shipped robot");
    let function = Function::InverseDynamicsWithPayload;
    let zeros = [0.0; 6];
    let motion = || Arguments::new().q(Array::Rows(&zeros)).qd(Array::Rows(&zeros)).qdd(Array::Rows(&zeros));
    let mut rows = [1.0; 30];
    rows[10] = -0.5;
    let columns: Vec<Vec<f64>> =
        (0..10).map(|element| (0..3).map(|state| rows[10 * state + element]).collect()).collect();
    let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let strided = Array::Strided { numbers: &rows[..], state: 10, element: 1 };
    for payload in [Array::Rows(&rows[..]), Array::Columns(&columns), strided] {
        let mut results = [7.0; 6];
        let error = arm.run(function, 3, &motion().payload(payload), Destination::Rows(&mut results)).unwrap_err();
        assert_eq!(error.to_string(), "state 2 of 3: the payload's mass is -0.5 kg: no body has less than 0");
        assert_eq!(results, [7.0; 6]);
    }
    let mut same = [7.0; 6];
    let arguments = motion().payload(Array::Same(&rows[10..20]));
    assert!(arm.run(function, 3, &arguments, Destination::Rows(&mut same)).is_err());
    assert_eq!(same, [7.0; 6]);

    let none = [0.0_f32; 2];
    let payload = Payload { mass: -1.0_f32, ..Payload::none() };
    let error = arm.inverse_dynamics_with_payload(&none, &none, &none, &payload).unwrap_err();
    assert_eq!(error.to_string(), "the payload's mass is -1 kg: no body has less than 0");
    for mass in [0.0, -0.0, f32::NAN] {
        let payload = Payload { mass, ..Payload::none() };
        assert!(arm.inverse_dynamics_with_payload(&none, &none, &none, &payload).is_ok(), "{mass}");
    }
}

/// A value that an argument cannot have is refused by every function that takes the argument, in every layout, and
/// nothing is written; without contacts there is no motion in contact. The functions are those of the table.
#[test]
fn what_an_argument_cannot_be_is_refused_by_every_function_that_takes_it() {
    let arm = CompiledArm::from_file(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/satellite.yaml"));
    let arm = arm.expect("a robot file");
    let rotations =
        [[2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0], [0.0; 9]];
    let rotations: Vec<Vec<f64>> = rotations.map(|rotation| [&rotation[..], &[0.0; 3]].concat()).to_vec();
    let steps: Vec<Vec<f64>> = [0.0, -0.0, -1e-3, f64::NAN, f64::INFINITY].map(|step| vec![step]).to_vec();
    // a mass below zero; moments below zero about one axis, and about an axis between two
    let inertia = |[xx, yy, zz, xy]: [f64; 4]| vec![1.0, 0.0, 0.0, 0.0, xx, yy, zz, xy, 0.0, 0.0];
    let payloads = vec![vec![-1.0], inertia([0.1, 0.1, -0.1, 0.0]), inertia([0.1, 0.1, 0.1, 0.2])];
    let wrong = [("step", &steps), ("pose", &rotations), ("base_rotation", &rotations), ("payload", &payloads)];
    let states = States::random(&mut Rng::with_seed(57), 2);
    let mut refused = 0;
    for function in Function::OF_TREES.into_iter().filter(|function| has(&arm, *function)) {
        let compiled = arm.function(function).expect("a function that compiles");
        let outputs = compiled.outputs();
        for &(name, width) in compiled.arguments() {
            let values = wrong.iter().find(|(other, _)| *other == name).map_or(&[][..], |(_, values)| values);
            assert_eq!(values.is_empty(), OutOfRange::elements(name) == 0, "{name}");
            for value in values {
                let index = widths(2).iter().position(|(other, _)| *other == name).expect("an argument");
                let mut rows = states.rows[index][..3 * width].to_vec();
                let changed = value.len().min(width);
                rows[2 * width..2 * width + changed].copy_from_slice(&value[..changed]);
                let columns: Vec<Vec<f64>> =
                    (0..width).map(|element| rows.iter().skip(element).step_by(width).copied().collect()).collect();
                let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
                let same = &rows[2 * width..];
                for (array, state) in [(Array::Rows(&rows), 3), (Array::Columns(&columns), 3), (Array::Same(same), 1)] {
                    let given = states.given(|index, width| Array::Rows(&states.rows[index][..3 * width]));
                    let given = given.with(name, array).expect("an argument");
                    let mut room = vec![7.0; 3 * outputs];
                    let found = arm.run(function, 3, &given, Destination::Rows(&mut room));
                    let said = found.expect_err("it is refused").to_string();
                    assert!(said.starts_with(&format!("state {state} of 3: ")), "{function}, {name}: {said}");
                    assert!(room.iter().all(|number| *number == 7.0), "{function}, {name}");
                    refused += 1;
                }
                let given = states.of_state(0).with(name, Array::Same(same)).expect("an argument");
                let mut room = vec![7.0; outputs];
                assert!(arm.run_one(function, &given, &mut room).is_err(), "{function}, {name}");
                assert!(room.iter().all(|number| *number == 7.0), "{function}, {name}");
            }
        }
    }
    assert!(refused > 50, "{refused}");
    let zeros = [0.0; 2];
    assert!(arm.runge_kutta_step(&zeros, &zeros, &zeros, 0.1).is_ok());
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let said = arm.runge_kutta_step(&zeros, &zeros, &zeros, step).unwrap_err().to_string();
        assert!(said.contains("it must be a finite number above 0"), "{said}");
        assert!(arm.runge_kutta_step_derivatives(&zeros, &zeros, &zeros, step).is_err());
    }
    // of the joint whose angle the function uses
    let turned = Function::InverseDynamicsFromSinCos;
    let planar = CompiledArm::from_file(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/planar2.yaml"));
    let planar = planar.expect("a robot file");
    let (sin, cos) = ([0.0, 0.6], [1.0, 0.8]);
    // rounded to four digits
    let rounded = ([0.0, -0.1548], [1.0, -0.988], 0);
    for (sin, cos, joint) in
        [rounded, (sin, cos, 0), ([0.0, 0.5], cos, 2), (sin, [0.0, 0.8], 1), (sin, [1.0, f64::NAN], 0)]
    {
        let given = Arguments::new().q(Array::Same(&zeros)).qd(Array::Same(&zeros)).qdd(Array::Same(&zeros));
        let given = given.with("sin", Array::Same(&sin)).and_then(|given| given.with("cos", Array::Same(&cos)));
        let mut room = [7.0; 2];
        match planar.run_one(turned, &given.expect("arguments"), &mut room) {
            Ok(()) => assert!(joint == 0 && room != [7.0; 2], "{room:?}"),
            Err(error) => {
                assert!(error.to_string().contains(&format!("for joint {joint}, but the sum of their")), "{error}");
                assert_eq!(room, [7.0; 2]);
            }
        }
    }
    let said = arm.function(Function::ForwardDynamicsInContact).unwrap_err().to_string();
    assert!(said.contains("the robot file has no `contacts`") && said.contains("kind: point"), "{said}");
}
