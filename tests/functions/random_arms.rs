//! Random arms, every function of them in both forms: names are distinct as text, the code is the runtime, and C is so
//! too.
//!
//! A plain `cargo test` tries arms of few joints and some others. All of them, in minutes, with
//! `RNE_EXHAUSTIVE=1 cargo test --release --test functions random_arms`; with 3 instead of 1, every third of them.

use std::collections::{BTreeMap, HashSet};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use fastrand::Rng;
use rne::{BaseMotion, ForwardDynamics, MassMatrix, Wrench};
use rne_codegen::{Form, Function, Program};
use rne_emit::Precision;
use rne_model::Robot;

use crate::arm::{Arm, Given, Maker, STEP};
use crate::arms;
use crate::check::Worst;
use crate::compiler::Compiler;
use crate::driver::{Driver, Unit};
use crate::equality;
use crate::states::{self, Numbers, State};

/// So many arms in all.
const ARMS: u64 = 2400;

/// Where not all are asked for: one in so many of those with at most so many joints.
const SOME: [(usize, u64); 3] = [(2, 80), (3, 320), (usize::MAX, 1200)];

/// Arms of whose variables two once had one name; they are always asked for.
const TWICE: [u64; 3] = [549, 661, 1810];

/// One arm in so many is written by the choices that a build makes for it; the others by none, which is sooner found.
const CHOSEN: u64 = 60;

/// Arms whose code in C is compiled, and how many where not all are asked for.
const IN_C: u64 = 60;
const SOME_IN_C: u64 = 2;

/// Of what numbers of a function are measured by.
const fn tolerance(form: Form) -> f64 {
    match form {
        Form::SevenSteps => 1e-12,
        Form::Reduced => 1e-11,
    }
}

fn robot(seed: u64) -> Robot {
    let yaml = arms::yaml(seed);
    Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"))
}

fn arm(seed: u64, form: Form) -> Arm {
    let (robot, maker) = (robot(seed), Maker::Code(form));
    if seed.is_multiple_of(CHOSEN) && robot.dof() <= if is_exhaustive() { 5 } else { 2 } {
        Arm::new(&robot, maker)
    } else {
        Arm::by_no_choice(&robot, maker)
    }
}

/// The texts of all variables, in their order, as any language reads them.
fn texts(program: &Program) -> Vec<String> {
    let constants = program.constants().map(|constant| constant.name);
    let statements = program.angles.iter().chain(&program.statements).map(|statement| statement.name);
    let turns = program.sines_and_cosines.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten();
    let names = program.arguments().chain(constants).chain(statements).chain(turns);
    names.map(|name| name.to_string()).collect()
}

fn names_are_distinct(program: &Program) {
    let mut seen = HashSet::new();
    for text in texts(program) {
        assert!(seen.insert(text.clone()), "{}, {}: two variables `{text}`", program.robot, program.function);
    }
}

/// Arms of the given seeds on all cores.
pub(crate) fn of_each(seeds: &[u64], property: impl Fn(u64, &mut Worst) + Sync) -> Worst {
    let (next, worst) = (AtomicU64::new(0), Mutex::new(Worst::default()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from).min(8) {
            scope.spawn(|| {
                let mut own = Worst::default();
                #[allow(clippy::cast_possible_truncation)] // an index of a list
                while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    property(seed, &mut own);
                }
                worst.lock().expect("no panic").join(own);
            });
        }
    });
    worst.into_inner().expect("no panic")
}

fn state(rng: &mut Rng, dof: usize) -> State {
    let between = |rng: &mut Rng, range: f64| (2.0 * rng.f64() - 1.0) * range;
    let joints = [3.2, 2.0, 5.0, 50.0].map(|range| (0..dof).map(|_| between(rng, range)).collect());
    let vectors = [(); 10].map(|()| [(); 3].map(|()| between(rng, 10.0)));
    State { joints, vectors, rotation: states::rotation([(); 4].map(|()| between(rng, 1.0))) }
}

/// What the functions are asked with at a state.
fn at<R>(state: &State, ask: impl FnOnce(&Given<'_, f64>) -> R) -> R {
    let Numbers { joints: [q, qd, qdd, tau], vectors, rotation, .. } = state.double();
    let [force, moment, omega, omega_dot, acceleration, gravity, ref payload @ ..] = vectors;
    let payload = states::payload(payload);
    // as C has the numbers of a twist
    let base = BaseMotion { omega, omega_dot, velocity: moment, acceleration, gravity };
    ask(&Given {
        q: &q,
        qd: &qd,
        qdd: &qdd,
        tau: &tau,
        wrench: Wrench { force, moment },
        payload,
        base,
        base_rotation: rotation,
        step: STEP,
    })
}

/// One in how many arms is tried at least, if `RNE_EXHAUSTIVE` says so.
pub(crate) fn one_in() -> Option<u64> {
    let said = std::env::var("RNE_EXHAUSTIVE").ok()?;
    Some(said.parse().unwrap_or(1).max(1))
}

fn is_exhaustive() -> bool {
    one_in().is_some()
}

/// Whether an arm is tried.
fn is_asked_for(seed: u64, form: Form) -> bool {
    let dof = robot(seed).dof();
    let rarity = SOME.iter().find(|(most, _)| dof <= *most).map_or(1, |&(_, rarity)| rarity);
    // a program of the reduced form is proved as well, which takes longer than to write it
    let rarity = if form == Form::SevenSteps { rarity } else { 3 * rarity };
    one_in().is_some_and(|n| seed.is_multiple_of(n)) || seed.is_multiple_of(rarity) || TWICE.contains(&seed)
}

fn every_function_is_the_runtime(form: Form) {
    let worst = of_each(&(0..ARMS).filter(|&seed| is_asked_for(seed, form)).collect::<Vec<_>>(), |seed, worst| {
        let arm = arm(seed, form);
        for function in Function::OF_TREES {
            names_are_distinct(arm.program(function));
        }
        let state = state(&mut Rng::with_seed(seed), arm.robot.dof());
        at(&state, |given| equality::compare(&arm, Maker::Code(form), given, tolerance(form), worst));
    });
    worst.at_most(tolerance(form), &format!("random arms, {form}"));
}

#[test]
fn every_function_of_random_arms_is_the_runtime() {
    every_function_is_the_runtime(Form::SevenSteps);
}

#[test]
fn every_reduced_function_of_random_arms_is_the_runtime() {
    every_function_is_the_runtime(Form::Reduced);
}

/// Compiles arms of as many joints in one call of the compiler, and compares every function at a few states.
fn c_code_is_the_runtime(name: &str, arms: &[(Form, &Arm)], compiler: &Compiler) {
    let dof = arms.first().map_or(0, |(_, arm)| arm.robot.dof());
    let unit = |(index, (form, arm)): (usize, &(Form, &Arm))| {
        let programs = Function::OF_TREES.map(|function| arm.program(function).clone());
        Unit::new(&arm.robot, &programs, Precision::Double, format!("{form}_{index}"))
    };
    let units: Vec<Unit> = arms.iter().enumerate().map(unit).collect();
    let mut rng = Rng::with_seed(dof as u64);
    let states = [(); 3].map(|()| state(&mut rng, dof));
    let words = Driver { name, units: &units, dof }.run(compiler, &states);
    let mut found = words.into_iter().map(f64::from_bits);
    for (state, (form, arm)) in states.iter().flat_map(|state| arms.iter().map(move |arm| (state, arm))) {
        for function in Function::OF_TREES {
            let found: Vec<f64> =
                found.by_ref().take(function.layout(rne_codegen::sizes_of(&arm.robot)).len()).collect();
            let maker = Maker::Code(*form);
            at(state, |given| equality::error(arm, maker, function, given, &found, tolerance(*form)));
        }
    }
    assert_eq!(found.next(), None, "more numbers than asked for");
}

#[test]
fn random_arms_in_c_are_the_runtime() {
    let Some(compiler) = Compiler::found() else { return };
    let count = one_in().map_or(SOME_IN_C, |n| (IN_C / n).max(SOME_IN_C));
    let mut of_dof: BTreeMap<usize, Vec<(Form, Arm)>> = BTreeMap::new();
    for seed in (0..count).map(|index| index * (ARMS / count)) {
        let arms = [Form::SevenSteps, Form::Reduced].map(|form| (form, arm(seed, form)));
        of_dof.entry(arms[0].1.robot.dof()).or_default().extend(arms);
    }
    for (dof, arms) in of_dof {
        let arms: Vec<(Form, &Arm)> = arms.iter().map(|(form, arm)| (*form, arm)).collect();
        c_code_is_the_runtime(&format!("random_arms_{dof}"), &arms, &compiler);
    }
}

#[derive(ForwardDynamics, MassMatrix)]
#[robot(path = "../random/files/shadow_fd.yaml")]
struct Shadowed;

/// An arm whose `forward_dynamics` had two variables `lowd5_2`: by the macro, the interpreter and in C.
#[test]
fn no_variable_shadows_another() {
    let [q, qd, tau] = [[0.3, 0.5, -0.2, 0.7, 0.4], [0.5, -1.0, 0.7, 1.1, -0.3], [1.0, 2.0, -1.0, 0.5, 0.8_f64]];
    let given = Given { tau: &tau, ..Given::of_joints(&q, &qd, &[]) };
    // M⁻¹ (τ - bias) of an M that was derived independently, to five digits
    let expected = [1.05263, -12.03787, -1.50214, 3.60589, 1.32669];
    let is_expected = |found: &[f64], of: &str| {
        assert_eq!(found.len(), expected.len());
        let error = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 6e-6, "{of}: {found:?}");
    };
    let forms = [Form::SevenSteps, Form::Reduced].map(|form| {
        let arm = Arm::from_file("tests/random/files/shadow_fd.yaml", Maker::Code(form));
        names_are_distinct(arm.program(Function::ForwardDynamics));
        is_expected(&arm.numbers(Function::ForwardDynamics, &given), form.name());
        (form, arm)
    });
    is_expected(&Shadowed.forward_dynamics(&q, &qd, &tau), "derived");
    is_expected(&forms[0].1.runtime.forward_dynamics(&q, &qd, &tau).expect("one per joint"), "runtime");
    if let Some(compiler) = Compiler::found() {
        c_code_is_the_runtime("shadow_fd", &forms, &compiler);
    }
}

/// The number of gravity in the table is that of an offset as well; gravity of the base is an argument of the same
/// letter.
#[test]
fn gravity_of_the_table_is_not_gravity_of_the_base() {
    let yaml = "{format: 1, name: low, source: own, convention: modified, gravity: [0, 0.5, -0.36], joints: [
        {type: prismatic, dh: {theta: 0, d: -0.36, a: 0, alpha: 0}, link: {mass: 1.15, com: [0, 0, 0]}},
        {type: revolute, dh: {theta: 0.2, d: 0, a: 0.4, alpha: -1.4}, link: {mass: 2, com: [0.1, 0.2, 0]}}]}";
    let robot = Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}"));
    for maker in Maker::CODE {
        let arm = Arm::new(&robot, maker);
        names_are_distinct(arm.program(Function::InverseDynamicsOnMovingBase));
        let given = state(&mut Rng::with_seed(1), robot.dof());
        at(&given, |given| equality::compare(&arm, maker, given, 1e-12, &mut Worst::default()));
    }
}
