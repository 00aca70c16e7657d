//! Batches of mass matrices, accelerations, derivatives and torques of floating bases: closed forms, single calls, and
//! arms at run time.
#![forbid(unsafe_code)]

use std::array::from_fn;

use fastrand::Rng;
use rne::compiled::{Arguments, Array, CompiledArm, Destination, Form, Function, Number};
use rne::testing::on_large_stack;
use rne::{
    BaseMotion, BatchFloatingInverseDynamics, BatchForwardDynamics, BatchInverseDynamicsDerivatives, BatchMassMatrix,
    BatchScalar, FloatingBase, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, VectorUnit,
    Wrench,
};

macro_rules! robots {
    ($($Robot:ident: $($key:ident = $value:literal),*;)*) => {$(
        #[derive(InverseDynamics, MassMatrix, BatchMassMatrix, ForwardDynamics, BatchForwardDynamics)]
        #[derive(InverseDynamicsDerivatives, BatchInverseDynamicsDerivatives)]
        #[robot($($key = $value),*)]
        struct $Robot;
    )*};
}
robots! {
    Gantry: path = "../robots/gantry_ppp.yaml";
    Scara: path = "../robots/scara_cobra600.yaml", form = "reduced";
    Puma560: path = "../robots/puma560.yaml";
    Panda: path = "../robots/panda.yaml", form = "reduced";
    Hyq: path = "../robots/trees/hyq.yaml", form = "reduced";
    Rod: yaml = "
        format: 1
        name: rod
        source: own numbers
        convention: standard
        gravity: [9.81, 0, 0]
        joints:
          - {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0], inertia: {}}}
    ";
}

/// A tree with a floating base.
#[derive(InverseDynamics, FloatingBase, BatchFloatingInverseDynamics)]
#[robot(path = "../benches/trees/hyq_floating.yaml", form = "reduced", allow_lints)]
struct Floating;

/// A chain with a floating base, in the seven steps.
#[derive(InverseDynamics, FloatingBase, BatchFloatingInverseDynamics)]
#[robot(path = "../robots/planar2.yaml", allow_lints)]
struct Drifting;

/// Around the lengths of a register, and beyond those for which threads are used.
const LENGTHS: [usize; 8] = [0, 1, 7, 8, 9, 17, 100, 8_203];

/// Random numbers between -`size` and `size`: N columns with a number for each state.
fn columns<T: BatchScalar, const N: usize>(seed: u64, size: f64, states: usize) -> [Vec<T>; N] {
    let mut rng = Rng::with_seed(seed);
    from_fn(|_| (0..states).map(|_| T::from_f64(size * (2.0 * rng.f64() - 1.0))).collect())
}

fn slices<T, const N: usize>(columns: &[Vec<T>; N]) -> [&[T]; N] {
    columns.each_ref().map(Vec::as_slice)
}

fn at<T: Copy, const N: usize>(columns: &[Vec<T>; N], state: usize) -> [T; N] {
    columns.each_ref().map(|numbers| numbers[state])
}

/// Numbers of the results: element by element, in each the states.
struct Room<T>(Vec<Vec<T>>);

impl<T: BatchScalar> Room<T> {
    fn new(elements: usize, states: usize) -> Self {
        Self(vec![vec![T::from_f64(f64::NAN); states]; elements])
    }

    fn vector<const N: usize>(&mut self) -> [&mut [T]; N] {
        let mut all = self.0.iter_mut();
        from_fn(|_| all.next().map(Vec::as_mut_slice).unwrap_or_default())
    }

    fn matrices<const N: usize, const M: usize>(&mut self) -> [[[&mut [T]; N]; N]; M] {
        let mut all = self.0.iter_mut();
        from_fn(|_| from_fn(|_| from_fn(|_| all.next().map(Vec::as_mut_slice).unwrap_or_default())))
    }
}

/// The motion of many states.
struct Motion<T, const DOF: usize>([[Vec<T>; DOF]; 4]);

impl<T: BatchScalar, const DOF: usize> Motion<T, DOF> {
    fn random(states: usize) -> Self {
        Self([(1, 3.2), (2, 2.0), (3, 5.0), (4, 20.0)].map(|(seed, size)| columns(seed, size, states)))
    }

    /// All functions, element after element: mass matrix, accelerations, derivatives.
    fn batches<R>(&self, robot: &R, unit: VectorUnit) -> [Vec<Vec<T>>; 3]
    where
        R: BatchMassMatrix<DOF> + BatchForwardDynamics<DOF> + BatchInverseDynamicsDerivatives<DOF> + Sync,
    {
        let [q, qd, qdd, tau] = self.0.each_ref().map(slices);
        let room = |elements| Room::new(elements, q[0].len());
        let (mut mass, mut motion, mut derivatives) = (room(DOF * DOF), room(DOF), room(2 * DOF * DOF));
        on_large_stack(|| {
            let [matrix] = mass.matrices();
            robot.mass_matrix_batch_on(unit, q, matrix).expect("arrays of one length");
            robot.forward_dynamics_batch_on(unit, q, qd, tau, motion.vector()).expect("arrays of one length");
            let [dq, dqd] = derivatives.matrices();
            robot.inverse_dynamics_derivatives_batch_on(unit, q, qd, qdd, dq, dqd).expect("arrays of one length");
        });
        [mass.0, motion.0, derivatives.0]
    }

    /// The single calls of a state.
    fn single<R>(&self, robot: &R, state: usize) -> [Vec<T>; 3]
    where
        R: MassMatrix<DOF> + ForwardDynamics<DOF> + InverseDynamicsDerivatives<DOF>,
    {
        let [q, qd, qdd, tau] = self.0.each_ref().map(|columns| at(columns, state));
        let derivatives = robot.inverse_dynamics_derivatives(&q, &qd, &qdd);
        [
            robot.mass_matrix(&q).concat(),
            robot.forward_dynamics(&q, &qd, &tau).to_vec(),
            [derivatives.dq, derivatives.dqd].concat().concat(),
        ]
    }
}

/// The largest difference of two lists, divided by the largest number. Two NaN in the same place are equal.
fn difference<T: Copy + Into<f64>>(a: &[T], b: &[T]) -> f64 {
    let largest = a.iter().fold(f64::MIN_POSITIVE, |largest, x| largest.max((*x).into().abs()));
    let differences = a.iter().zip(b).map(|(a, b)| {
        let (a, b): (f64, f64) = ((*a).into(), (*b).into());
        if a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() }
    });
    differences.sum::<f64>() / largest
}

/// m l² = 0.4 kg m², m l g sin q, (τ - m l g sin q) / (m l²).
#[test]
fn a_rod_has_its_closed_forms() {
    let (q, qd, tau) = ([0.1, -2.0, 1e6, 0.4, 3.0], [1.0, 0.0, 2.0, 5.0, 0.1], [0.0, 1.0, 2.0, 3.0, 4.0]);
    let [mut mass, mut qdd, mut dq, mut dqd] = [[f64::NAN; 5]; 4];
    Rod.mass_matrix_batch([&q], [[&mut mass]]).expect("arrays of one length");
    Rod.forward_dynamics_batch([&q], [&qd], [&tau], [&mut qdd]).expect("arrays of one length");
    let done = Rod.inverse_dynamics_derivatives_batch([&q], [&qd], [&tau], [[&mut dq]], [[&mut dqd]]);
    done.expect("arrays of one length");
    for state in 0..5 {
        let weight = 2.5 * 0.4 * 9.81;
        assert!((mass[state] - 0.4).abs() < 1e-15, "kg m²");
        let expected = (tau[state] - weight * f64::sin(q[state])) / 0.4;
        assert!((qdd[state] - expected).abs() < 1e-9, "rad/s², {} {expected}", qdd[state]);
        assert!((dq[state] - weight * f64::cos(q[state])).abs() < 1e-9, "N m per rad");
        assert!(dqd[state] == 0.0, "no friction");
    }
}

/// What a batch computes is that of single calls, on every unit, for every length.
#[test]
fn every_unit_gives_the_results_of_single_calls() {
    fn check<const DOF: usize, R>(name: &str, robot: &R)
    where
        R: BatchMassMatrix<DOF> + BatchForwardDynamics<DOF> + BatchInverseDynamicsDerivatives<DOF> + Sync,
    {
        for states in LENGTHS {
            let motion = Motion::<f64, DOF>::random(states);
            for unit in VectorUnit::all() {
                let batches = motion.batches(robot, unit);
                for state in (0..states).step_by(if states > 1000 { 97 } else { 1 }) {
                    for (of, (batch, single)) in batches.iter().zip(motion.single(robot, state)).enumerate() {
                        let batch: Vec<f64> = batch.iter().map(|numbers| numbers[state]).collect();
                        let worst = difference(&single, &batch);
                        assert!(worst < 1e-11, "{name}, function {of}, {unit}, {state} of {states}: {worst:e}");
                    }
                }
            }
        }
    }
    check("gantry", &Gantry);
    check("scara", &Scara);
    check("puma560", &Puma560);
    check("panda", &Panda);
    check("hyq", &Hyq);
}

/// An arm that is read when the program runs computes what is derived from its file, to the bit, on every unit.
#[test]
fn an_arm_read_at_run_time_has_the_bits_of_the_derived_one() {
    fn check<T: Number, const DOF: usize, R>(file: &str, robot: &R, form: Form)
    where
        R: BatchMassMatrix<DOF> + BatchForwardDynamics<DOF> + BatchInverseDynamicsDerivatives<DOF> + Sync,
    {
        let arm = CompiledArm::from_file(format!("robots/{file}.yaml")).expect("a shipped robot").in_form(form);
        let motion = Motion::<T, DOF>::random(100);
        let [q, qd, qdd, tau] = motion.0.each_ref().map(slices);
        let arguments = Arguments::new().q(Array::Columns(&q)).qd(Array::Columns(&qd));
        let arguments = arguments.qdd(Array::Columns(&qdd)).tau(Array::Columns(&tau));
        let functions = [Function::MassMatrix, Function::ForwardDynamics, Function::InverseDynamicsDerivatives];
        for unit in VectorUnit::all() {
            for (function, found) in functions.into_iter().zip(motion.batches(robot, unit)) {
                let mut room = Room::new(found.len(), 100);
                let results = Destination::Columns(room.0.iter_mut().map(Vec::as_mut_slice).collect());
                let compiled = arm.function(function).expect("a function that compiles");
                compiled.run(unit, 100, &arguments, results).expect("arrays of one length");
                assert_eq!(found, room.0, "{file}, {function}, {unit}");
            }
        }
    }
    check::<f64, 6, _>("puma560", &Puma560, Form::SevenSteps);
    check::<f32, 6, _>("puma560", &Puma560, Form::SevenSteps);
    check::<f64, 7, _>("panda", &Panda, Form::Reduced);
    check::<f32, 4, _>("scara_cobra600", &Scara, Form::Reduced);
    check::<f64, 12, _>("trees/hyq", &Hyq, Form::Reduced);
}

#[test]
fn angles_far_away_and_numbers_that_are_none_are_as_in_single_calls() {
    let mut motion = Motion::<f64, 7>::random(50);
    // Some of them in the last, shorter register.
    for (state, q) in [(3, 2e5), (11, f64::NAN), (12, -1e300), (13, f64::INFINITY), (48, -3e6), (49, 1e5)] {
        motion.0[0][2][state] = q;
    }
    for unit in VectorUnit::all() {
        let batches = motion.batches(&Panda, unit);
        for state in 0..50 {
            for (batch, single) in batches.iter().zip(motion.single(&Panda, state)) {
                let batch: Vec<f64> = batch.iter().map(|numbers| numbers[state]).collect();
                let worst = difference(&single, &batch);
                assert!(worst < 1e-10, "{unit}, state {state}: {worst:e}");
            }
        }
    }
}

/// An empty array is not wanted; zeros of the structure are written where they have an array.
#[test]
fn elements_without_an_array_are_left_out() {
    let motion = Motion::<f64, 12>::random(21);
    let [q, qd, qdd, _] = motion.0.each_ref().map(slices);
    let unit = VectorUnit::widest();
    let [mass, _, derivatives] = motion.batches(&Hyq, unit);
    assert!(mass.iter().chain(&derivatives).flatten().all(|number| number.is_finite()), "zeros are written");
    assert!(mass[3].iter().all(|number| *number == 0.0), "joints of two legs");
    let mut room = Room::new(144, 21);
    for (index, numbers) in room.0.iter_mut().enumerate() {
        if index % 12 > index / 12 {
            numbers.clear();
        }
    }
    let [lower] = room.matrices();
    on_large_stack(|| Hyq.mass_matrix_batch(q, lower).expect("arrays of one length, or empty ones"));
    for (index, numbers) in room.0.iter().enumerate() {
        assert!(numbers.is_empty() || *numbers == mass[index], "element {index}");
    }
    let mut one = [f64::NAN; 21];
    let nothing = || [[(); 12]; 12].map(|row| row.map(|()| <&mut [f64]>::default()));
    let mut dqd = nothing();
    dqd[2][1] = &mut one;
    on_large_stack(|| {
        Hyq.inverse_dynamics_derivatives_batch(q, qd, qdd, nothing(), dqd).expect("one array, and empty ones");
    });
    assert_eq!(one[..], derivatives[144 + 25]);
}

#[test]
fn arrays_of_different_lengths_are_named() {
    let (ten, nine) = ([0.5; 10], [0.5; 9]);
    let good: [&[f64]; 3] = [&ten; 3];
    let mut room = Room::new(9, 10);
    room.0[5].pop();
    let [mass] = room.matrices();
    let error = Gantry.mass_matrix_batch(good, mass).expect_err("a mismatch");
    assert_eq!((error.argument, error.joint, error.column, error.length, error.states), ("mass", 1, Some(2), 9, 10));
    assert_eq!(error.to_string(), "`mass[1][2]` has length 9 and `q[0]` 10: each holds one number per state, or none");
    assert!(room.0.iter().flatten().all(|number| number.is_nan()), "nothing is written");
    let mut room = Room::new(3, 10);
    let error = Gantry.forward_dynamics_batch(good, good, [&ten, &nine, &ten], room.vector()).expect_err("a mismatch");
    assert_eq!(error.to_string(), "`tau[1]` has length 9 and `q[0]` 10: each holds one number per state");
    room.0[0].clear();
    let error = Gantry.forward_dynamics_batch(good, good, good, room.vector()).expect_err("a mismatch");
    assert_eq!(error.to_string(), "`qdd[0]` has length 0 and `q[0]` 10: each holds one number per state");
    let mut room = Room::new(18, 10);
    room.0[11].push(0.0);
    let [dq, dqd] = room.matrices();
    let error = Gantry.inverse_dynamics_derivatives_batch(good, good, good, dq, dqd).expect_err("a mismatch");
    assert_eq!((error.argument, error.joint, error.column), ("dqd", 0, Some(2)));
}

/// The base and tips of many states.
struct Base<T, const TIPS: usize> {
    vectors: [Vec<T>; 12],
    wrenches: [[Vec<T>; 6]; TIPS],
}

impl<T: BatchScalar, const TIPS: usize> Base<T, TIPS> {
    fn random(states: usize) -> Self {
        Self { vectors: columns(5, 2.0, states), wrenches: from_fn(|tip| columns(6 + tip as u64, 9.0, states)) }
    }

    fn motion(&self) -> BaseMotion<&[T]> {
        let [a, b, c, d, e, f, g, h, i, j, k, l] = slices(&self.vectors);
        let velocity = Default::default();
        BaseMotion { omega: [a, b, c], omega_dot: [d, e, f], velocity, acceleration: [g, h, i], gravity: [j, k, l] }
    }

    fn wrenches(&self) -> [Wrench<&[T]>; TIPS] {
        self.wrenches.each_ref().map(|wrench| {
            let [a, b, c, d, e, f] = slices(wrench);
            Wrench { force: [a, b, c], moment: [d, e, f] }
        })
    }
}

#[test]
fn torques_and_wrenches_of_floating_bases_are_those_of_single_calls() {
    fn check<const DOF: usize, const NV: usize, const TIPS: usize, R>(name: &str, robot: &R)
    where
        R: BatchFloatingInverseDynamics<DOF, NV, TIPS> + Sync,
    {
        for states in LENGTHS {
            let (motion, base) = (Motion::<f64, DOF>::random(states), Base::<f64, TIPS>::random(states));
            let [q, qd, qdd, _] = motion.0.each_ref().map(slices);
            let free = Wrench { force: Default::default(), moment: Default::default() };
            for (unit, is_free) in VectorUnit::all().flat_map(|unit| [(unit, false), (unit, true)]) {
                let (mut wrench, mut tau) = (Room::new(6, states), Room::new(DOF, states));
                let wrenches = if is_free { [free; TIPS] } else { base.wrenches() };
                let (of_base, of_joints) = (wrench.vector(), tau.vector());
                let motion_of_base = base.motion();
                on_large_stack(|| {
                    let done = robot.inverse_dynamics_of_floating_base_batch_on(
                        unit,
                        q,
                        qd,
                        qdd,
                        &motion_of_base,
                        &wrenches,
                        of_base,
                        of_joints,
                    );
                    done.expect("arrays of one length");
                });
                for state in (0..states).step_by(if states > 1000 { 97 } else { 1 }) {
                    let [a, b, c, d, e, f, g, h, i, j, k, l] = at(&base.vectors, state);
                    let (velocity, zero) = ([0.0; 3], Wrench::zero());
                    let (omega, omega_dot) = ([a, b, c], [d, e, f]);
                    let of_base =
                        BaseMotion { omega, omega_dot, velocity, acceleration: [g, h, i], gravity: [j, k, l] };
                    let wrenches = base.wrenches.each_ref().map(|wrench| {
                        let [a, b, c, d, e, f] = at(wrench, state);
                        if is_free { zero } else { Wrench { force: [a, b, c], moment: [d, e, f] } }
                    });
                    let [q, qd, qdd, _] = motion.0.each_ref().map(|columns| at(columns, state));
                    let single = robot.inverse_dynamics_of_floating_base(&q, &qd, &qdd, &of_base, &wrenches);
                    let single = [&single.wrench.force[..], &single.wrench.moment, &single.tau].concat();
                    let found: Vec<f64> = wrench.0.iter().chain(&tau.0).map(|numbers| numbers[state]).collect();
                    let worst = difference(&single, &found);
                    assert!(worst < 1e-12, "{name}, {unit}, {state} of {states}: {worst:e}");
                }
            }
        }
    }
    check("hyq_floating", &Floating);
    check("planar2", &Drifting);
    let (motion, base) = (Motion::<f64, 2>::random(3), Base::<f64, 1>::random(3));
    let ([q, qd, qdd, _], mut wrenches) = (motion.0.each_ref().map(slices), base.wrenches());
    wrenches[0].moment[1] = &[1.0];
    let (mut wrench, mut tau) = (Room::new(6, 3), Room::new(2, 3));
    let (of_base, of_joints) = (wrench.vector(), tau.vector());
    let done =
        Drifting.inverse_dynamics_of_floating_base_batch(q, qd, qdd, &base.motion(), &wrenches, of_base, of_joints);
    let error = done.expect_err("a mismatch").to_string();
    let words = "has length 1 and `q[0]` 3: each holds one number per state, or none";
    assert_eq!(error, format!("`wrenches[0].moment[1]` {words}"));
}
