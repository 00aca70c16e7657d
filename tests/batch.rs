//! Batches give the torques of single calls, on every vector unit of the processor that runs the tests.
#![forbid(unsafe_code)]

use std::array::from_fn;
use std::fmt::Debug;

use fastrand::Rng;
use rne::compiled::{Arguments, Array, CompiledArm, Destination, Form, Function, Number};
use rne::{BatchInverseDynamics, BatchScalar, InverseDynamics, VectorUnit};

macro_rules! robots {
    ($($Robot:ident: $file:literal;)*) => {$(
        #[derive(InverseDynamics, BatchInverseDynamics)]
        #[robot(path = $file)]
        struct $Robot;
    )*};
}
robots! {
    Pendulum: "../robots/planar1.yaml";
    Gantry: "../robots/gantry_ppp.yaml";
    Scara: "../robots/scara_cobra600.yaml";
    Stanford: "../robots/stanford.yaml";
    Puma560: "../robots/puma560.yaml";
    Panda: "../robots/panda.yaml";
}

macro_rules! reduced {
    ($($Robot:ident: $file:literal;)*) => {$(
        #[derive(InverseDynamics, BatchInverseDynamics)]
        #[robot(path = $file, form = "reduced")]
        struct $Robot;
    )*};
}
reduced! {
    ReducedGantry: "../robots/gantry_ppp.yaml";
    ReducedScara: "../robots/scara_cobra600.yaml";
    ReducedPuma560: "../robots/puma560.yaml";
    ReducedPanda: "../robots/panda.yaml";
}

/// A parameter with the name of a method's scalar, and a field that no thread may share.
#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "../robots/puma560.yaml")]
struct Tooled<'a, T>(#[robot(skip)] std::cell::RefCell<&'a T>);

/// Around the lengths of a register, and beyond those for which threads are used.
fn lengths() -> [usize; 10] {
    let longest = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 20_011 } else { 8_203 };
    [0, 1, 7, 8, 9, 16, 17, 1000, 1003, longest]
}

/// Structure of arrays.
struct States<T, const DOF: usize>([[Vec<T>; DOF]; 3]);

impl<T: BatchScalar, const DOF: usize> States<T, DOF> {
    fn random(count: usize) -> Self {
        let mut rng = Rng::with_seed(20_26);
        let mut numbers = |size: f64| (0..count).map(|_| T::from_f64(size * (2.0 * rng.f64() - 1.0))).collect();
        Self([3.2, 2.0, 5.0].map(|size| from_fn(|_| numbers(size))))
    }

    fn slices(&self) -> [[&[T]; DOF]; 3] {
        self.0.each_ref().map(|arrays| arrays.each_ref().map(Vec::as_slice))
    }

    fn one_by_one(&self, robot: &impl InverseDynamics<DOF>) -> [Vec<T>; DOF] {
        let states = self.0[0][0].len();
        let mut tau = from_fn(|_| Vec::with_capacity(states));
        for state in 0..states {
            let [q, qd, qdd] = self.slices().map(|arrays| arrays.map(|numbers| numbers[state]));
            for (numbers, torque) in tau.iter_mut().zip(robot.inverse_dynamics(&q, &qd, &qdd)) {
                numbers.push(torque);
            }
        }
        tau
    }

    fn batch(&self, robot: &impl BatchInverseDynamics<DOF>, unit: VectorUnit) -> [Vec<T>; DOF] {
        let [q, qd, qdd] = self.slices();
        let mut tau = from_fn(|_| vec![T::from_f64(f64::NAN); q[0].len()]);
        let slices = tau.each_mut().map(Vec::as_mut_slice);
        robot.inverse_dynamics_batch_on(unit, q, qd, qdd, slices).expect("arrays of one length");
        tau
    }
}

/// An arm that is read when the program runs computes what is derived from its file, to the bit, on every unit.
#[test]
fn a_robot_read_at_run_time_has_the_bits_of_the_derived_one() {
    fn check<const DOF: usize>(file: &str, robot: &impl BatchInverseDynamics<DOF>, form: Form) {
        let arm = CompiledArm::from_file(format!("robots/{file}.yaml")).expect("a shipped robot").in_form(form);
        check_of::<f64, DOF>(file, robot, &arm);
        check_of::<f32, DOF>(file, robot, &arm);
    }
    fn check_of<T: Number, const DOF: usize>(file: &str, robot: &impl BatchInverseDynamics<DOF>, arm: &CompiledArm) {
        let compiled = arm.function(Function::InverseDynamics).expect("a function that compiles");
        for length in lengths() {
            let states = States::<T, DOF>::random(length);
            let [q, qd, qdd] = states.slices();
            let arguments = Arguments::new().q(Array::Columns(&q)).qd(Array::Columns(&qd)).qdd(Array::Columns(&qdd));
            for unit in VectorUnit::all() {
                let mut tau: [Vec<T>; DOF] = from_fn(|_| vec![T::from_f64(f64::NAN); length]);
                let room = Destination::Columns(tau.iter_mut().map(Vec::as_mut_slice).collect());
                compiled.run(unit, length, &arguments, room).expect("arrays of one length");
                assert_eq!(tau, states.batch(robot, unit), "{file}, {}, {unit}, {length} states", arm.form());
            }
        }
    }
    check("planar1", &Pendulum, Form::SevenSteps);
    check("gantry_ppp", &Gantry, Form::SevenSteps);
    check("scara_cobra600", &Scara, Form::SevenSteps);
    check("stanford", &Stanford, Form::SevenSteps);
    check("puma560", &Puma560, Form::SevenSteps);
    check("panda", &Panda, Form::SevenSteps);
    check("gantry_ppp", &ReducedGantry, Form::Reduced);
    check("scara_cobra600", &ReducedScara, Form::Reduced);
    check("puma560", &ReducedPuma560, Form::Reduced);
    check("panda", &ReducedPanda, Form::Reduced);
}

/// The largest difference of two torques, in units of the largest torque of their state.
fn difference<T: BatchScalar + Into<f64>, const DOF: usize>(a: &[Vec<T>; DOF], b: &[Vec<T>; DOF]) -> f64 {
    let of_state = |state: usize| {
        let torques = |tau: &[Vec<T>; DOF]| -> [f64; DOF] { from_fn(|joint| tau[joint][state].into()) };
        let (a, b) = (torques(a), torques(b));
        let largest = a.into_iter().fold(0.0, |largest: f64, torque| largest.max(torque.abs()));
        let difference = a.into_iter().zip(b).map(|(a, b)| (a - b).abs());
        // A sum and not a maximum: that would lose a NaN.
        difference.sum::<f64>() / largest
    };
    (0..a[0].len()).map(of_state).fold(0.0, |worst, state| if state <= worst { worst } else { state })
}

/// Compares all units with single calls, at all lengths, and gives the largest difference. In the seven steps the unit
/// of the compiled target has their bits; the sums of the reduced form have their terms in another order in a batch.
fn compared<T: BatchScalar + Into<f64>, const DOF: usize>(
    robot: &impl BatchInverseDynamics<DOF>,
    is_reduced: bool,
) -> f64 {
    let mut worst = 0.0_f64;
    for length in lengths() {
        let states = States::<T, DOF>::random(length);
        let single = states.one_by_one(robot);
        for (index, unit) in VectorUnit::all().enumerate() {
            let batch = states.batch(robot, unit);
            // The first is that of the compiled target, on which single calls run too.
            if index == 0 && !is_reduced {
                assert_eq!(batch, single, "{unit}, {length} states");
            }
            let difference = difference(&single, &batch);
            assert!(!difference.is_nan(), "{unit}, {length} states");
            worst = worst.max(difference);
        }
    }
    worst
}

#[test]
fn every_unit_gives_the_torques_of_single_calls() {
    fn check<const DOF: usize>(name: &str, robot: &impl BatchInverseDynamics<DOF>, is_reduced: bool) {
        let (double, single) = (compared::<f64, DOF>(robot, is_reduced), compared::<f32, DOF>(robot, is_reduced));
        println!("{name:<9} f64 {double:.1e}  f32 {single:.1e}");
        assert!(double < 1e-13 && single < 1e-5, "{name}: {double:e}, {single:e}");
    }
    println!("{:?}", VectorUnit::all().collect::<Vec<_>>());
    check("planar1", &Pendulum, false);
    check("gantry", &Gantry, false);
    check("scara", &Scara, false);
    check("stanford", &Stanford, false);
    check("puma560", &Puma560, false);
    check("panda", &Panda, false);
    check("gantry", &ReducedGantry, true);
    check("scara", &ReducedScara, true);
    check("puma560", &ReducedPuma560, true);
    check("panda", &ReducedPanda, true);
}

/// Whatever is beside it, in whatever lane it is and whichever thread computes it.
#[test]
fn a_torque_depends_on_its_state_alone() {
    fn check<T: BatchScalar + Debug>() {
        let states = States::<T, 6>::random(20_011);
        for unit in VectorUnit::all() {
            let together = states.batch(&Puma560, unit);
            for range in [0..1, 3..20, 5000..5007, 8190..8195, 20_000..20_011] {
                let part =
                    States(states.0.each_ref().map(|arrays| arrays.each_ref().map(|a| a[range.clone()].to_vec())));
                let alone = part.batch(&Puma560, unit);
                assert_eq!(alone, together.each_ref().map(|tau| tau[range.clone()].to_vec()), "{unit} {range:?}");
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn angles_far_away_and_numbers_that_are_none_are_as_in_single_calls() {
    fn check(robot: &impl BatchInverseDynamics<6>, is_reduced: bool) {
        let mut states = States::<f64, 6>::random(50);
        // Some of them in the last, shorter register.
        for (state, q) in [(3, 2e5), (11, f64::NAN), (12, -1e300), (13, f64::INFINITY), (48, -3e6), (49, 1e5)] {
            states.0[0][2][state] = q;
        }
        states.0[1][1][20] = 1e200;
        let single = states.one_by_one(robot);
        for unit in VectorUnit::all() {
            let batch = states.batch(robot, unit);
            for state in 0..50 {
                for joint in 0..6 {
                    let (single, batch) = (single[joint][state], batch[joint][state]);
                    let near = (single - batch).abs() <= 1e-11 || single.is_nan() && batch.is_nan() || state == 20;
                    assert!(near, "{unit}: state {state}, joint {joint}: {single} {batch}");
                }
            }
            if !is_reduced {
                assert_eq!(batch[2][3], single[2][3], "{unit}");
            }
        }
    }
    check(&Puma560, false);
    check(&ReducedPuma560, true);
}

/// Each angle is near enough for the kernel, and the sum of two of them, which this robot turns by, is not.
#[test]
fn angles_whose_sum_is_far_away_are_as_in_single_calls() {
    let mut states = States::<f64, 4>::random(20);
    states.0[0][0][5] = 6e4;
    states.0[0][1][5] = 7e4;
    let single = states.one_by_one(&ReducedScara);
    for unit in VectorUnit::all() {
        assert!(difference(&single, &states.batch(&ReducedScara, unit)) < 1e-12, "{unit}");
    }
}

#[test]
fn the_widest_unit_is_the_last() {
    let last = VectorUnit::all().last().expect("there is one");
    assert_eq!(VectorUnit::widest().name(), last.name());
    let states = States::<f64, 6>::random(100);
    let [q, qd, qdd] = states.slices();
    let mut tau = from_fn(|_| vec![0.0; 100]);
    Puma560.inverse_dynamics_batch(q, qd, qdd, tau.each_mut().map(Vec::as_mut_slice)).expect("arrays of one length");
    assert_eq!(tau, states.batch(&Puma560, last));
}

#[cfg(all(feature = "batch", target_arch = "x86_64"))]
#[test]
fn the_processor_s_units_are_found() {
    let names: Vec<_> = VectorUnit::all().map(VectorUnit::name).collect();
    assert_eq!(names.contains(&"AVX2"), is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"));
    assert_eq!(names.contains(&"AVX-512"), is_x86_feature_detected!("avx512vl"));
}

#[test]
fn arrays_of_different_lengths_are_named() {
    let (ten, nine) = ([0.5; 10], [0.5; 9]);
    let mut tau = [[7.0; 10]; 3];
    let mut call = |q: [&[f64]; 3], qd: [&[f64]; 3], qdd: [&[f64]; 3], torques: usize| {
        let [a, b, c] = tau.each_mut();
        let error = Gantry.inverse_dynamics_batch(q, qd, qdd, [a, b, &mut c[..torques]]).expect_err("a mismatch");
        assert_eq!(tau, [[7.0; 10]; 3], "no torque is written");
        error
    };
    let good: [&[f64]; 3] = [&ten; 3];
    let error = call(good, [&ten, &ten, &nine], good, 10);
    assert_eq!((error.argument, error.joint, error.length, error.states), ("qd", 2, 9, 10));
    let error: Box<dyn std::error::Error> = Box::new(error);
    assert_eq!(error.to_string(), "`qd[2]` has length 9 and `q[0]` 10: each holds one number per state");
    assert_eq!(call([&ten, &nine, &ten], good, good, 10).to_string().split(' ').next(), Some("`q[1]`"));
    assert_eq!(call(good, good, [&nine, &ten, &ten], 10).to_string().split(' ').next(), Some("`qdd[0]`"));
    assert_eq!(call(good, good, good, 0).to_string().split(' ').next(), Some("`tau[2]`"));
}

#[test]
fn a_struct_may_have_parameters_and_fields() {
    let states = States::<f64, 6>::random(100);
    let tooled = Tooled(std::cell::RefCell::new(&1));
    assert_eq!(**tooled.0.borrow(), 1);
    assert_eq!(states.batch(&tooled, VectorUnit::widest()), states.batch(&Puma560, VectorUnit::widest()));
}

#[cfg(feature = "std")]
#[test]
fn a_robot_at_run_time_computes_batches_too() {
    let arm = rne::Arm::<6>::from_file("robots/puma560.yaml").expect("a robot file");
    let states = States::<f64, 6>::random(20_011);
    assert_eq!(states.batch(&arm, VectorUnit::widest()), states.one_by_one(&Puma560));
}
