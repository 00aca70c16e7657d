//! Rollouts against Euler's method, written out here, on the runtime's arm, which loops over links with nalgebra.
//!
//! Motions of arms are chaotic: rounding grows from step to step. So each step is compared by itself, from the state
//! that the rollout has reached before it.

#[path = "random/arms.rs"]
mod arms;

use fastrand::Rng;
use nalgebra::DMatrix;
use rne::compiled::{Arguments, Array, CompiledArm, FrictionWidth, Function, Number, Rollout, RolloutLimits};
use rne::model::{Reader, Robot};
use rne::{DynArm, Payload, VectorUnit};

/// rad/s or m/s: about which Coulomb friction changes its sign.
const WIDTH: f64 = 0.05;

/// The allowed error of a step, relative to its largest number, or to 1 if that is larger.
const TOLERANCE: f64 = 1e-12;

/// Beyond this condition of the mass matrix a step is not compared: its accelerations are rounding.
const CONDITION: f64 = 1e5;

/// Arguments of a rollout, sample by sample.
struct Samples {
    rollout: Rollout,
    dof: usize,
    q: Vec<f64>,
    qd: Vec<f64>,
    tau: Vec<f64>,
    payload: Option<Vec<f64>>,
}

impl Samples {
    /// Random states, and torques for random accelerations of these states.
    fn random(rng: &mut Rng, arm: &DynArm, rollout: Rollout, samples: usize) -> Self {
        let dof = arm.dof();
        let mut numbers =
            |count: usize, size: f64| -> Vec<f64> { (0..count).map(|_| (2.0 * rng.f64() - 1.0) * size).collect() };
        let [q, qd] = [3.0, 2.0].map(|size| numbers(samples * dof, size));
        let mut tau = Vec::new();
        for (q, qd) in q.chunks(dof).zip(qd.chunks(dof)) {
            for _ in 0..rollout.steps {
                tau.extend(arm.inverse_dynamics(q, qd, &numbers(dof, 5.0)).expect("one per joint"));
            }
        }
        let payload = (0..samples).flat_map(|_| {
            let [mass, x, y, z] = [(); 4].map(|()| numbers(1, 0.5)[0]);
            let [xx, yy, zz] = [0.02, 0.03, 0.04];
            [mass.abs(), x, y, z, xx, yy, zz, 0.001, 0.002, -0.003]
        });
        let payload = Some(payload.collect());
        Self { rollout, dof, q, qd, tau, payload }
    }

    fn samples(&self) -> usize {
        self.q.len() / self.dof
    }

    /// The states after each step, on a unit.
    fn roll_out(&self, arm: &CompiledArm, unit: VectorUnit) -> [Vec<f64>; 2] {
        let mut states = [(); 2].map(|()| vec![f64::NAN; self.tau.len()]);
        let arguments = Arguments::new().q(Array::Rows(&self.q)).qd(Array::Rows(&self.qd)).tau(Array::Rows(&self.tau));
        let arguments = match &self.payload {
            Some(payload) => arguments.payload(Array::Rows(payload)),
            None => arguments,
        };
        let slices = states.each_mut().map(Vec::as_mut_slice);
        arm.rollout_on(unit, &self.rollout, self.samples(), &arguments, slices).expect("arrays of these sizes");
        states
    }

    /// The state before a step of a sample, as a rollout has reached it, and the torques of the step.
    fn before<'a>(&'a self, [q, qd]: &'a [Vec<f64>; 2], sample: usize, step: usize) -> [&'a [f64]; 3] {
        let at = (sample * self.rollout.steps + step) * self.dof;
        let tau = &self.tau[at..][..self.dof];
        match step {
            0 => [&self.q[sample * self.dof..][..self.dof], &self.qd[sample * self.dof..][..self.dof], tau],
            _ => [&q[at - self.dof..][..self.dof], &qd[at - self.dof..][..self.dof], tau],
        }
    }

    fn payload_of(&self, sample: usize) -> Payload<f64> {
        let none = Payload::none();
        self.payload
            .as_ref()
            .map_or(none, |payload| Payload::from_array(payload[10 * sample..][..10].try_into().expect("ten numbers")))
    }
}

/// A step by the rules of [`Rollout`], with accelerations from whoever computes them.
fn euler(
    robot: &Robot,
    rollout: &Rollout,
    [q, qd, tau]: [&[f64]; 3],
    accelerations: impl FnOnce(&[f64]) -> Vec<f64>,
) -> [Vec<f64>; 2] {
    let limits = |joint: usize| robot.joints[joint].limits;
    let mut u = tau.to_vec();
    if rollout.limits.effort {
        u.iter_mut().enumerate().for_each(|(joint, u)| {
            let effort = limits(joint).effort.unwrap_or(f64::INFINITY);
            *u = u.clamp(-effort, effort);
        });
    }
    if let Some(FrictionWidth::Of(width)) = rollout.friction {
        let zero = vec![0.0; q.len()];
        let friction = DynArm::from_robot(robot).actuator_torques_smooth(qd, &zero, width).expect("one per joint");
        u.iter_mut().zip(friction).for_each(|(u, friction)| *u -= friction);
    }
    let qdd = accelerations(&u);
    let mut velocities: Vec<f64> = qd.iter().zip(&qdd).map(|(qd, qdd)| qd + rollout.step * qdd).collect();
    if rollout.limits.velocity {
        velocities.iter_mut().enumerate().for_each(|(joint, velocity)| {
            let largest = limits(joint).velocity.unwrap_or(f64::INFINITY);
            *velocity = velocity.clamp(-largest, largest);
        });
    }
    let mut positions: Vec<f64> = q.iter().zip(&velocities).map(|(q, qd)| q + rollout.step * qd).collect();
    if rollout.limits.position {
        for joint in 0..q.len() {
            let Some((lower, upper)) = limits(joint).position else { continue };
            if positions[joint] < lower || positions[joint] > upper {
                positions[joint] = positions[joint].clamp(lower, upper);
                velocities[joint] = 0.0;
            }
        }
    }
    [positions, velocities]
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

fn condition(arm: &DynArm, q: &[f64], payload: &Payload<f64>) -> f64 {
    let rows = arm.mass_matrix_with_payload(q, payload).expect("one per joint");
    let values = DMatrix::from_fn(q.len(), q.len(), |i, j| rows[i][j]).symmetric_eigenvalues();
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    if smallest > 0.0 { values.max() / smallest } else { f64::INFINITY }
}

/// The largest error of all steps, and how many were compared.
fn worst(arm: &CompiledArm, samples: &Samples) -> (f64, usize) {
    let robot = arm.robot();
    let oracle = DynArm::from_robot(robot);
    let mut worst = (0.0_f64, 0);
    let last = VectorUnit::all().last();
    for unit in VectorUnit::all().take(1).chain(last) {
        let found = samples.roll_out(arm, unit);
        for sample in 0..samples.samples() {
            let payload = samples.payload_of(sample);
            for step in 0..samples.rollout.steps {
                let before = samples.before(&found, sample, step);
                let is_finite = before.iter().all(|numbers| numbers.iter().all(|number| number.is_finite()));
                if !is_finite || largest(before[1]) > 1e3 || condition(&oracle, before[0], &payload) > CONDITION {
                    continue;
                }
                let expected = euler(robot, &samples.rollout, before, |tau| {
                    oracle.forward_dynamics_with_payload(before[0], before[1], tau, &payload).expect("one per joint")
                });
                let at = (sample * samples.rollout.steps + step) * samples.dof;
                for (found, expected) in found.iter().zip(&expected) {
                    let found = &found[at..][..samples.dof];
                    let difference: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
                    assert!(difference.iter().all(|difference| difference.is_finite()), "{}: {found:?}", robot.name);
                    worst.0 = worst.0.max(largest(&difference) / largest(expected).max(1.0));
                }
                worst.1 += 1;
            }
        }
    }
    worst
}

/// Shipped arms, with friction, limits, rotors and payloads, and without.
#[test]
fn each_step_of_shipped_arms_is_eulers() {
    let mut rng = Rng::with_seed(31);
    let (mut arms, mut largest_error) = (0, 0.0_f64);
    for file in shipped::tried() {
        let arm = CompiledArm::from_yaml(file.yaml).expect("a shipped robot").with_rotors();
        let oracle = DynArm::from_robot(arm.robot());
        let bare = Rollout::new(6, 2e-3);
        let full = Rollout { friction: Some(FrictionWidth::Of(WIDTH)), limits: RolloutLimits::ALL, ..bare };
        let mut compared = 0;
        for rollout in [full, bare] {
            let mut samples = Samples::random(&mut rng, &oracle, rollout, 9);
            if rollout == bare {
                samples.payload = None;
            }
            let (error, steps) = worst(&arm, &samples);
            assert!(error <= TOLERANCE, "{}: {error:e}", file.name);
            largest_error = largest_error.max(error);
            compared += steps;
        }
        arms += usize::from(compared > 0);
    }
    println!("{arms} shipped arms: the largest error of a step is {largest_error:.1e}");
    assert!(arms >= if shipped::is_exhaustive() { 20 } else { 10 }, "{arms} arms");
}

/// Random arms: parallel and coincident axes, links without mass, motors with gears. 500 of them with `RNE_EXHAUSTIVE`.
#[test]
fn each_step_of_random_arms_is_eulers() {
    let wanted = if shipped::is_exhaustive() { 500 } else { 60 };
    let mut rng = Rng::with_seed(32);
    let (mut arms, mut largest_error) = (0, 0.0_f64);
    let mut seeds = 0_u64..700;
    while arms < wanted {
        let seed = seeds.next().expect("most arms have mass matrices that can be inverted");
        let arm = CompiledArm::from_yaml(&arms::yaml(seed)).expect("an arm").with_rotors();
        let oracle = DynArm::from_robot(arm.robot());
        let rollout = Rollout { friction: Some(FrictionWidth::Of(WIDTH)), ..Rollout::new(2, 1e-3) };
        let (error, steps) = worst(&arm, &Samples::random(&mut rng, &oracle, rollout, 2));
        assert!(error <= TOLERANCE, "seed {seed}: {error:e}");
        largest_error = largest_error.max(error);
        arms += usize::from(steps > 0);
    }
    println!("{arms} random arms: the largest error of a step is {largest_error:.1e}");
}

/// A rollout has the bits of one call of forward dynamics after the other, in both precisions and on every unit.
#[test]
fn a_rollout_has_the_bits_of_single_calls() {
    fn compare<T: Number>(arm: &CompiledArm, rollout: &Rollout, samples: &Samples) {
        let rounded = |numbers: &[f64]| -> Vec<T> { numbers.iter().map(|&number| T::from_f64(number)).collect() };
        let [q, qd, tau] = [&samples.q, &samples.qd, &samples.tau].map(|numbers| rounded(numbers));
        let dof = arm.dof();
        let start = Arguments::new().q(Array::Rows(&q)).qd(Array::Rows(&qd)).tau(Array::Rows(&tau));
        let step = T::from_f64(rollout.step);
        for unit in VectorUnit::all() {
            let mut found = [(); 2].map(|()| vec![T::zero(); tau.len()]);
            let room = found.each_mut().map(Vec::as_mut_slice);
            arm.rollout_on(unit, rollout, samples.samples(), &start, room).expect("arrays of these sizes");
            let function = arm.function(Function::ForwardDynamics).expect("a function that compiles");
            for sample in 0..samples.samples() {
                let of = |numbers: &[T]| numbers[sample * dof..][..dof].to_vec();
                let (mut q, mut qd) = (of(&q), of(&qd));
                for index in 0..rollout.steps {
                    let at = (sample * rollout.steps + index) * dof;
                    let mut qdd = vec![T::zero(); dof];
                    let state = Arguments::new().q(Array::Same(&q)).qd(Array::Same(&qd));
                    let state = state.tau(Array::Same(&tau[at..][..dof]));
                    function.run_one(unit, &state, &mut qdd).expect("one per joint");
                    for joint in 0..dof {
                        qd[joint] += step * qdd[joint];
                        q[joint] += step * qd[joint];
                    }
                    assert_eq!([&q[..], &qd[..]], [&found[0][at..][..dof], &found[1][at..][..dof]], "{unit}, {sample}");
                }
            }
        }
    }
    let file = rne_robots::find("puma560").expect("a shipped robot");
    let arm = CompiledArm::from_yaml(file.yaml).expect("a shipped robot");
    let rollout = Rollout::new(3, 1e-3);
    // more than a block of any unit, and no multiple of a register
    let samples = Samples::random(&mut Rng::with_seed(33), &DynArm::from_robot(arm.robot()), rollout, 131);
    compare::<f64>(&arm, &rollout, &samples);
    compare::<f32>(&arm, &rollout, &samples);
}

/// A uniform rod of 1 kg and 0.6 m on an axis without gravity.
fn rod(keys: &str) -> CompiledArm {
    let yaml = format!(
        "{{format: 1, name: rod, source: own, convention: standard, gravity: [0, 0, 0], joints: [{{type: revolute, \
         name: hinge, dh: {{theta: 0, d: 0, a: 0.6, alpha: 0}}, link: {{mass: 1, com: [-0.3, 0, 0], inertia: {{zz: \
         0.03}}}}{keys}}}]}}"
    );
    CompiledArm::from_yaml(&yaml).expect("an arm")
}

/// kg m², about its axis.
const INERTIA: f64 = 0.12;

fn of_rod(arm: &CompiledArm, rollout: Rollout, [q, qd]: [f64; 2], tau: &[f64]) -> [Vec<f64>; 2] {
    let [mut positions, mut velocities] = [(); 2].map(|()| vec![f64::NAN; rollout.steps]);
    let (q, qd) = ([q], [qd]);
    let start = Arguments::new().q(Array::Rows(&q)).qd(Array::Rows(&qd)).tau(Array::Rows(tau));
    arm.rollout(&rollout, 1, &start, &mut positions, &mut velocities).expect("arrays of these sizes");
    [positions, velocities]
}

#[test]
fn a_rod_moves_by_closed_forms() {
    let h = 0.01;
    // constant torque: q̇ = k h τ/J, q = k (k + 1)/2 h² τ/J
    let [q, qd] = of_rod(&rod(""), Rollout::new(50, h), [0.0, 0.0], &[0.6; 50]);
    for (index, (q, qd)) in q.iter().zip(&qd).enumerate() {
        let k = f64::from(u8::try_from(index + 1).expect("few"));
        assert!(
            (qd - k * h * 0.6 / INERTIA).abs() < 1e-12
                && (q - k * (k + 1.0) / 2.0 * h * h * 0.6 / INERTIA).abs() < 1e-12
        );
    }
    // viscous friction G² B: q̇ = (1 - h G² B/J)^k q̇0; a negative ratio has no meaning
    let arm = rod(", motor: {gear_ratio: -10, viscous: 0.004}");
    let friction = Some(FrictionWidth::Of(1e-3));
    let [_, qd] = of_rod(&arm, Rollout { friction, ..Rollout::new(50, h) }, [0.0, 2.0], &[0.0; 50]);
    assert!((qd[49] - 2.0 * (1.0 - h * 0.4 / INERTIA).powi(50)).abs() < 1e-12, "{}", qd[49]);
    let [_, qd] = of_rod(&arm, Rollout::new(1, h), [0.0, 2.0], &[0.0]);
    assert_eq!(qd[0], 2.0, "no friction unless asked for");
    // Coulomb friction |G| Tc, forward and backward, about the width: s = 0.8 at q̇ = 4/3 width
    let arm = rod(", motor: {gear_ratio: -10, coulomb: [0.03, -0.01], coulomb_width: 0.3}");
    for (friction, width) in [(FrictionWidth::OfFile, 0.3), (FrictionWidth::Of(0.06), 0.06)] {
        for (sign, opposed) in [(1.0, 0.1 * (0.03 + 0.01) * 50.0 * 0.8 + 0.5 * 0.2 * 0.64), (-1.0, -0.16 + 0.064)] {
            let rollout = Rollout { friction: Some(friction), ..Rollout::new(1, h) };
            let speed = sign * width / 0.75;
            let [_, qd] = of_rod(&arm, rollout, [0.0, speed], &[0.0]);
            assert!((qd[0] - (speed - h * opposed / INERTIA)).abs() < 1e-14, "{width}: {qd:?}");
        }
    }
}

#[test]
fn limits_hold() {
    let arm = rod(", limits: {position: [-0.5, 0.25], velocity: 1.5, effort: 0.6}");
    let none = Rollout::new(60, 0.01);
    let with = |limits| Rollout { limits, ..none };
    // pushed up for 40 steps, then down
    let tau: Vec<f64> = (0..60).map(|index| if index < 40 { 3.0 } else { -0.3 }).collect();

    let effort = RolloutLimits { effort: true, ..RolloutLimits::NONE };
    let within: Vec<f64> = tau.iter().map(|tau| tau.min(0.6)).collect();
    assert_eq!(of_rod(&arm, with(effort), [0.0, 0.0], &tau), of_rod(&arm, none, [0.0, 0.0], &within));
    assert_ne!(of_rod(&arm, none, [0.0, 0.0], &tau), of_rod(&arm, none, [0.0, 0.0], &within));

    let velocity = RolloutLimits { velocity: true, ..RolloutLimits::NONE };
    let [q, qd] = of_rod(&arm, with(velocity), [0.0, 0.0], &tau);
    assert!(qd[4] < 1.5 && qd[5..40].iter().all(|qd| *qd == 1.5) && qd[40] < 1.5, "{qd:?}");
    assert!((q[39] - q[38] - 0.015).abs() < 1e-15, "the position follows the bounded velocity");

    // it runs into its stop, stays there while it is pushed, and leaves when it is pushed back
    let position = RolloutLimits { position: true, ..RolloutLimits::NONE };
    let [q, qd] = of_rod(&arm, with(position), [0.0, 0.0], &tau);
    let stop = q.iter().position(|q| *q == 0.25).expect("it arrives");
    assert!(stop < 39 && q[..stop].iter().all(|q| *q < 0.25), "{q:?}");
    assert!(q[stop..40].iter().all(|q| *q == 0.25) && qd[stop..40].iter().all(|qd| *qd == 0.0), "{q:?}");
    assert!(q[40..].windows(2).all(|pair| pair[1] < pair[0]) && q[40] < 0.25, "{q:?}");
    // a start beyond an end is brought there
    assert_eq!(of_rod(&arm, with(position), [-0.9, -1.0], &tau)[0][0], -0.5);
    // all limits at once, each with its own sign
    let [q, qd] = of_rod(&arm, with(RolloutLimits::ALL), [0.0, 0.0], &vec![-3.0; 60]);
    assert!((qd[0] + 0.01 * 0.6 / INERTIA).abs() < 1e-15 && q[59] == -0.5 && qd[59] == 0.0);
    // without a limit in the file there is none
    assert_eq!(of_rod(&rod(""), with(RolloutLimits::ALL), [0.0, 0.0], &tau), of_rod(&arm, none, [0.0, 0.0], &tau));
}

/// A payload is part of the last link: by formulas for a point at the end of a rod.
#[test]
fn a_payload_is_that_of_its_sample() {
    let arm = rod("");
    let payload: Vec<f64> =
        [0.0, 0.5, 2.0].iter().flat_map(|mass| Payload { mass: *mass, ..Payload::none() }.to_array()).collect();
    let start = Arguments::new().q(Array::Same(&[0.0])).qd(Array::Same(&[0.0])).tau(Array::Same(&[0.6]));
    let [mut q, mut qd] = [[f64::NAN; 3]; 2];
    let start = start.payload(Array::Rows(&payload));
    arm.rollout(&Rollout::new(1, 0.01), 3, &start, &mut q, &mut qd).expect("arrays of these sizes");
    for (mass, qd) in [0.0, 0.5, 2.0].iter().zip(qd) {
        assert!((qd - 0.01 * 0.6 / (INERTIA + mass * 0.36)).abs() < 1e-15);
    }
}

/// Without friction and torque the energy drifts by half as much with half the step: the method is of first order.
#[test]
fn energy_drifts_in_proportion_to_the_step() {
    let file = rne_robots::find("planar2").expect("a shipped robot");
    let arm = CompiledArm::from_yaml(file.yaml).expect("a shipped robot");
    let energy = |q: &[f64], qd: &[f64]| {
        arm.kinetic_energy(q, qd).expect("one per joint") + arm.potential_energy(q).expect("one per joint")
    };
    let (q, qd) = ([0.3, -0.4], [0.5, 1.0]);
    let drifts = [1_000, 2_000, 4_000].map(|steps| {
        let rollout = Rollout::new(steps, 1.0 / f64::from(u16::try_from(steps).expect("few")));
        let tau = vec![0.0; 2 * steps];
        let [mut positions, mut velocities] = [(); 2].map(|()| vec![f64::NAN; 2 * steps]);
        let start = Arguments::new().q(Array::Rows(&q)).qd(Array::Rows(&qd)).tau(Array::Rows(&tau));
        arm.rollout(&rollout, 1, &start, &mut positions, &mut velocities).expect("arrays of these sizes");
        energy(&positions[2 * steps - 2..], &velocities[2 * steps - 2..]) - energy(&q, &qd)
    });
    println!("drift of the energy in 1 s: {drifts:?} J");
    for pair in drifts.windows(2) {
        assert!((pair[0] / pair[1] - 2.0).abs() < 0.05, "{drifts:?}");
    }
    assert!(drifts[0].abs() > 1e-6, "a check of rounding proves nothing: {drifts:?}");
}

/// The number and the places of samples, threads and NaN change no bit of another sample.
#[test]
fn samples_do_not_notice_each_other() {
    let file = rne_robots::find("puma560").expect("a shipped robot");
    let arm = CompiledArm::from_yaml(file.yaml).expect("a shipped robot").with_rotors();
    let friction = Some(FrictionWidth::Of(WIDTH));
    let rollout = Rollout { friction, limits: RolloutLimits::ALL, ..Rollout::new(30, 1e-3) };
    // with the feature `rayon` enough for threads
    let mut samples = Samples::random(&mut Rng::with_seed(34), &DynArm::from_robot(arm.robot()), rollout, 301);
    let all = samples.roll_out(&arm, VectorUnit::widest());
    let of = |states: &[Vec<f64>; 2], first: usize, count: usize| {
        states.each_ref().map(|numbers| numbers[first * 180..][..count * 180].to_vec())
    };
    for (first, count) in [(0, 1), (7, 60), (100, 150), (300, 1)] {
        let part = |numbers: &[f64], of_sample: usize| numbers[first * of_sample..][..count * of_sample].to_vec();
        let some = Samples {
            q: part(&samples.q, 6),
            qd: part(&samples.qd, 6),
            tau: part(&samples.tau, 180),
            payload: samples.payload.as_ref().map(|payload| part(payload, 10)),
            ..samples
        };
        assert!(some.roll_out(&arm, VectorUnit::widest()) == of(&all, first, count), "{first}, {count}");
    }
    // a torque of the tenth step, and a position
    (samples.tau[5 * 180 + 9 * 6 + 2], samples.q[200 * 6 + 1]) = (f64::NAN, f64::NAN);
    let found = samples.roll_out(&arm, VectorUnit::widest());
    for sample in 0..301 {
        let [is_nan, before] = match sample {
            5 => [true, of(&found, 5, 1)[0][..9 * 6] == of(&all, 5, 1)[0][..9 * 6]],
            200 => [true, true],
            _ => [false, of(&found, sample, 1) == of(&all, sample, 1)],
        };
        assert!(before, "sample {sample}");
        let last = &of(&found, sample, 1).map(|numbers| numbers[174..].to_vec());
        assert!(
            last.iter().all(|numbers| numbers.iter().any(|number| number.is_nan()) == is_nan),
            "{sample}: {last:?}"
        );
    }
}

#[test]
fn nothing_is_rolled_out_for_no_samples_or_no_steps() {
    let arm = rod("");
    let start = Arguments::new().q(Array::Rows(&[])).qd(Array::Rows(&[])).tau(Array::Rows(&[]));
    assert_eq!(arm.rollout::<f64>(&Rollout::new(3, 0.1), 0, &start, &mut [], &mut []), Ok(()));
    let start = Arguments::new().q(Array::Same(&[0.1])).qd(Array::Same(&[0.0])).tau(Array::Rows(&[]));
    assert_eq!(arm.rollout::<f64>(&Rollout::new(0, 0.1), 5, &start, &mut [], &mut []), Ok(()));
}

#[test]
fn what_is_wrong_is_said() {
    let arm = rod(", motor: {coulomb: [0.1, -0.1]}");
    let tau = [0.0; 6];
    let start = Arguments::new().q(Array::Same(&[0.0])).qd(Array::Rows(&[0.0; 2])).tau(Array::Rows(&tau));
    let said = |arm: &CompiledArm, rollout: Rollout, start: &Arguments<'_, f64>, room: usize| {
        let [mut q, mut qd] = [(); 2].map(|()| vec![7.0; room]);
        let error = arm.rollout(&rollout, 2, start, &mut q, &mut qd).expect_err("it is wrong").to_string();
        assert!(q.iter().chain(&qd).all(|number| *number == 7.0), "nothing is written");
        error
    };
    let rollout = Rollout::new(3, 0.1);
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let expected = format!("the step of a rollout is {step} s, but it must be a finite number above 0");
        assert_eq!(said(&arm, Rollout { step, ..rollout }, &start, 6), expected);
    }
    let with = |friction| Rollout { friction: Some(friction), ..rollout };
    assert_eq!(
        said(&arm, with(FrictionWidth::Of(-1.0)), &start, 6),
        "the width of Coulomb friction is -1, but it must be a finite number above 0"
    );
    assert_eq!(
        said(&arm, with(FrictionWidth::OfFile), &start, 6),
        "joint `hinge` has Coulomb friction, but no `coulomb_width` in the robot file: add this key, or give one width \
         for all joints"
    );
    let sharp = rod(", motor: {coulomb: [0.1, -0.1], coulomb_width: 0}");
    assert!(said(&sharp, with(FrictionWidth::OfFile), &start, 6).contains("`coulomb_width` of joint `hinge` is 0"));
    let missing = "`tau` must have 6 numbers, which are 2 samples × 3 steps × 1 joints, but it has 5";
    assert_eq!(said(&arm, rollout, &start.tau(Array::Rows(&tau[1..])), 6), missing);
    let missing = "`positions` must have 6 numbers, which are 2 samples × 3 steps × 1 joints, but it has 5";
    assert_eq!(said(&arm, rollout, &start, 5), missing);
    let wrong = "`q` must have 1 numbers for each of 2 states, but 1 were given and 2 are needed";
    assert_eq!(said(&arm, rollout, &start.q(Array::Rows(&[0.0])), 6), wrong);
    let start_without = Arguments::new().q(Array::Same(&[0.0])).qd(Array::Same(&[0.0]));
    assert_eq!(said(&arm, rollout, &start_without, 6), "`forward_dynamics` needs the argument `tau`");
    let negative = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let error = said(&arm, rollout, &start.payload(Array::Same(&negative)), 6);
    assert_eq!(error, "state 1 of 2: the payload's mass is -1 kg: no body has less than 0");
    // friction that a run-time parameter changes
    let text = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, 0, 0], parameters: {b: 0.1}, \
                joints: [{type: revolute, name: hinge, dh: {theta: 0, d: 0, a: 0.6, alpha: 0}, link: {mass: 1}, motor: \
                {viscous: b}}]}";
    let robot = Reader::new("rod").run_time(&["b"]).read(text.as_bytes()).expect("a robot file").robot;
    let error = said(&CompiledArm::from_robot(&robot), with(FrictionWidth::Of(0.1)), &start, 6);
    assert!(error.starts_with("the friction of joint `hinge` depends on run-time parameters"), "{error}");
}
