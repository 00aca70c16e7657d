//! One robot after the other, three ways that share no code after the compiler: what a build derives, the interpreter
//! of programs, and the machine of arms at run time on every vector unit.
//!
//! The seven steps have the same bits, on a unit without fused multiply-add; there the machine has those of the
//! interpreter in the reduced form too. Derived code of the reduced form orders its sums otherwise, for a short wait,
//! as a fused multiply-add rounds otherwise: these differ by rounding.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use fastrand::Rng;
use rne::Scalar;
use rne::VectorUnit;
use rne::compiled::{Arguments, Array, CompiledArm, Destination};
use rne_codegen::CheckFor as _;
use rne_codegen::{Arguments as Numbers, Compiler, Form, Function, Interpreter, Target};
use rne_model::Robot;
use rne_search::PlanFile;

use crate::comparison::{ROOT, read};
use crate::derived::{Derived, Forms};
use crate::states::{self, State};

/// Of the largest number of a result over all states, and of the largest of a state where is divided by a matrix that
/// may be nearly singular.
const TOLERANCES: [f64; 2] = [1e-13, 1e-9];

/// States of each of some robots: with all functions in both forms a million, or a sample.
fn count(robots: usize) -> usize {
    let of_a_state = robots * Function::OF_TREES.len() * Form::ALL.len();
    if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 1_000_000_usize.div_ceil(of_a_state) } else { 20 }
}

/// Random states of an arm, and the numbers of each argument, state by state.
struct States {
    each: Vec<State>,
    rows: Vec<(&'static str, Vec<f64>)>,
}

impl States {
    fn random(rng: &mut Rng, dof: usize, count: usize) -> Self {
        let mut between = |range: f64| (2.0 * rng.f64() - 1.0) * range;
        let mut state = || {
            let joints = [3.2, 2.0, 5.0, 50.0].map(|range| (0..dof).map(|_| between(range)).collect());
            let mut vectors = [(); 10].map(|()| [(); 3].map(|()| between(10.0)));
            // a payload of negative mass is refused, and so are moments of inertia below zero about any axis
            vectors[6][2] = vectors[6][2].abs();
            vectors[8] = vectors[8].map(|moment| 20.0 + moment.abs());
            State { joints, vectors, rotation: states::rotation([(); 4].map(|()| between(1.0))) }
        };
        let each: Vec<State> = (0..count).map(|_| state()).collect();
        let rows = |of: &dyn Fn(&State) -> Vec<f64>| each.iter().flat_map(of).collect();
        let turns = |of: fn((f64, f64)) -> f64| {
            rows(&|state| state.joints[0].iter().map(|q| of(Scalar::sin_cos(*q))).collect())
        };
        let vector = |index: usize| rows(&|state| state.vectors[index].to_vec());
        let rows = vec![
            ("q", rows(&|state| state.joints[0].clone())),
            ("qd", rows(&|state| state.joints[1].clone())),
            ("qdd", rows(&|state| state.joints[2].clone())),
            ("tau", rows(&|state| state.joints[3].clone())),
            ("step", rows(&|_| vec![0.03125])),
            ("multipliers", rows(&|state| state.joints[3].clone())),
            ("sin", turns(|turn| turn.0)),
            ("cos", turns(|turn| turn.1)),
            ("force", vector(0)),
            ("moment", vector(1)),
            ("wrenches", rows(&|state| state.vectors[..2].concat())),
            ("payload", rows(&|state| payload(state).to_vec())),
            ("base_omega", vector(2)),
            ("omega", vector(2)),
            ("base_omega_dot", vector(3)),
            ("base_acceleration", vector(4)),
            ("base_gravity", vector(5)),
            ("twist", rows(&|state| state.vectors[1..3].concat())),
            ("pose", rows(&|state| [&state.rotation.concat()[..], &state.vectors[5]].concat())),
            ("base_rotation", rows(&|state| state.rotation.concat())),
        ];
        Self { each, rows }
    }

    fn given(&self) -> Arguments<'_, f64> {
        self.rows.iter().fold(Arguments::new(), |given, (name, rows)| {
            given.with(name, Array::Rows(rows)).expect("an argument of this name")
        })
    }
}

/// Mass, centre of mass and inertia, as `states::payload` finds them.
fn payload(state: &State) -> [f64; 10] {
    state.vectors[6..].as_flattened()[2..].try_into().expect("ten")
}

fn interpreted(interpreter: &Interpreter, state: &State) -> Vec<f64> {
    let [q, qd, qdd, tau] = state.joints.each_ref().map(Vec::as_slice);
    let [force, moment, base @ .., _, _, _, _] = state.vectors;
    let wrenches = [std::array::from_fn(|at| if at < 3 { force[at] } else { moment[at - 3] })];
    let of_joints = Numbers::of_joints(q, qd, qdd, 0.0);
    let numbers = Numbers {
        tau,
        force,
        moment,
        wrenches: &wrenches,
        payload: payload(state),
        base,
        velocity: moment,
        pose: [state.rotation.as_flattened(), &state.vectors[5]].concat().try_into().expect("twelve"),
        step: 0.03125,
        base_rotation: state.rotation.as_flattened().try_into().expect("nine"),
        ..of_joints
    };
    interpreter.run(&numbers, f64::from_f64, Scalar::sin_cos).expect("arrays of the right length")
}

/// What was compared with what, how many numbers differ in their bits, and by how much at most: of the largest number.
#[derive(Default)]
struct Seen(BTreeMap<&'static str, (usize, usize, f64)>);

impl Seen {
    /// Compares results of states, each of so many numbers.
    fn see(&mut self, what: &'static str, width: usize, function: Function, [found, expected]: [&[f64]; 2]) -> f64 {
        let largest = |numbers: &[f64]| numbers.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let of_all = largest(expected);
        let (numbers, differing, worst) = self.0.entry(what).or_default();
        let mut error = 0.0_f64;
        for (found, expected) in found.chunks(width).zip(expected.chunks(width)) {
            if expected.iter().any(|x| !x.is_finite()) {
                continue;
            }
            let scale = if function.divides().is_some() { largest(expected) } else { of_all };
            for (a, b) in found.iter().zip(expected) {
                *differing += usize::from(a != b);
                error = error.max((a - b).abs() / scale.max(1e-300));
                assert!(!a.is_nan(), "{what}, {function}");
            }
        }
        *numbers += found.len();
        if function.divides().is_none() {
            *worst = worst.max(error);
        }
        error
    }

    fn add(&mut self, other: Self) {
        for (what, (numbers, differing, worst)) in other.0 {
            let seen = self.0.entry(what).or_default();
            *seen = (seen.0 + numbers, seen.1 + differing, seen.2.max(worst));
        }
    }
}

fn compare(name: &str, derived: &[(Form, Box<dyn Derived>)], count: usize) -> Seen {
    let (yaml, plan) = (read(&format!("{ROOT}/robots/{name}.yaml")), read(&format!("{ROOT}/robots/{name}.plan.yaml")));
    let robot = Robot::from_yaml(&yaml).unwrap_or_else(|why| panic!("{why}"));
    let arm = CompiledArm::with_plan(&yaml, &plan).unwrap_or_else(|why| panic!("{why}"));
    let plans = PlanFile::read(name, &plan, &robot).unwrap_or_else(|report| panic!("{report}"));
    let compiler = Compiler::new(&robot).for_target(Target::Throughput).with_plans(plans);
    let states = States::random(&mut Rng::with_seed(100), robot.dof(), count);
    let mut seen = Seen::default();
    for (form, derived) in derived {
        let arm = arm.in_form(*form);
        // a base without mass may turn against its joints: the mass matrix is singular in every state
        let is_solvable =
            |it: &Function| robot.floating_base.is_some() || !(it.is_of_floating_base() && it.inverts_mass());
        for function in Function::OF_TREES.into_iter().filter(is_solvable) {
            let what = format!("{name}, {function}, {form}");
            let tolerance = TOLERANCES[usize::from(function.divides().is_some())];
            let program = compiler.compile(function, *form).unwrap_or_else(|why| panic!("{what}: {why}"));
            let interpreter = Interpreter::new(&program);
            let expected: Vec<f64> = states.each.iter().flat_map(|state| interpreted(&interpreter, state)).collect();
            let built: Vec<f64> =
                states.each.iter().flat_map(|state| derived.double(function, &state.double())).collect();
            let width = expected.len() / count;
            let (pair, is_same) = match form {
                Form::SevenSteps => ("derived and interpreter, seven steps", !cfg!(target_feature = "fma")),
                Form::Reduced => ("derived and interpreter, reduced", false),
            };
            let error = seen.see(pair, width, function, [&built, &expected]);
            assert!(error <= if is_same { 0.0 } else { tolerance }, "{what}: derived, {error:e}");
            if function.check_base(&robot).is_err() {
                assert!(arm.function(function).is_err(), "{what}: the file has no floating base");
                continue;
            }
            let compiled = arm.function(function).unwrap_or_else(|why| panic!("{what}: {why}"));
            for (index, unit) in VectorUnit::all().enumerate() {
                let mut found = vec![f64::NAN; expected.len()];
                compiled
                    .run(unit, count, &states.given(), Destination::Rows(&mut found))
                    .expect("arrays of one length");
                let is_same = index == 0 && !cfg!(target_feature = "fma");
                let pair =
                    if is_same { "machine and interpreter" } else { "machine with fused multiply-add and interpreter" };
                let error = seen.see(pair, width, function, [&found, &expected]);
                assert!(error <= if is_same { 0.0 } else { tolerance }, "{what}, {unit}: {error:e}");
            }
        }
    }
    seen
}

/// Compares robots on all cores.
pub(crate) fn compare_all(robots: &[Forms]) {
    let (next, all, count) = (AtomicUsize::new(0), Mutex::new(Seen::default()), count(robots.len()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from).min(4) {
            scope.spawn(|| {
                while let Some((name, derived)) = robots.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let seen = compare(name, derived, count);
                    all.lock().expect("no panic").add(seen);
                }
            });
        }
    });
    let evaluations = robots.len() * Function::OF_TREES.len() * Form::ALL.len() * count;
    println!("{} robots, {} functions, 2 forms, {count} states: {evaluations}", robots.len(), Function::OF_TREES.len());
    for (pair, (numbers, differing, worst)) in all.into_inner().expect("no panic").0 {
        println!("{pair}: {numbers} numbers, {differing} differ, by {worst:.1e} of the largest at most");
    }
}
