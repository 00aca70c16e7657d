//! Rollouts against Euler's method, written out here, on the runtime's arm, which loops over links with nalgebra.
//!
//! Motions of arms are chaotic: rounding grows from step to step. So each step is compared by itself, from the state that
//! the rollout has reached before it.

#[path = "random/arms.rs"]
mod arms;

use fastrand::Rng;
use nalgebra::DMatrix;
use rne::compiled::{
    Arguments, Array, CompiledArm, FrictionWidth, Function, Number, Rollout, RolloutError, RolloutLimits,
};
use rne::model::{Robot, RunTime};
use rne::{DynArm, Payload, VectorUnit};

/// rad/s or m/s: about which Coulomb friction changes its sign.
const WIDTH: f64 = 0.05;

/// More than a block on the widest unit, and no multiple of a register.
const SAMPLES: usize = 67;

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
        let mut numbers = |count: usize, size: f64| -> Vec<f64> {
            (0..count).map(|_| (2.0 * rng.f64() - 1.0) * size).collect()
        };
        let [q, qd] = [3.0, 2.0].map(|size| numbers(samples * dof, size));
        let mut tau = Vec::new();
        for (q, qd) in q.chunks(dof).zip(qd.chunks(dof)) {
            for _ in 0..rollout.steps {
                tau.extend(arm.inverse_dynamics(q, qd, &numbers(dof, 5.0)).expect("one per joint"));
            }
        }
        let payload = (0..samples).flat_map(|_| {
            let [mass, x, y, z] = [(); 4].map(|()| numbers(1, 0.5)[0]);
            // of a body: that of two crossed rods and more
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
        self.payload.as_ref().map_or(none, |payload| {
            Payload::from_array(payload[10 * sample..][..10].try_into().expect("ten numbers"))
        })
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

/// The largest error of all steps, of the larger of 1 and the numbers of the step; and how many were compared.
fn worst(arm: &CompiledArm, samples: &Samples) -> (f64, usize) {
    let robot = arm.robot();
    let oracle = DynArm::from_robot(robot);
    let mut worst = (0.0_f64, 0);
    for unit in VectorUnit::all() {
        let found = samples.roll_out(arm, unit);
        for sample in 0..samples.samples() {
            let payload = samples.payload_of(sample);
            for step in 0..samples.rollout.steps {
                let before = samples.before(&found, sample, step);
                // where the mass matrix is nearly singular, accelerations are rounding
                let is_finite = before.iter().all(|numbers| numbers.iter().all(|number| number.is_finite()));
                if !is_finite || largest(before[1]) > 1e3 || condition(&oracle, before[0], &payload) > 1e7 {
                    continue;
                }
                let expected = euler(robot, &samples.rollout, before, |tau| {
                    oracle.forward_dynamics_with_payload(before[0], before[1], tau, &payload).expect("one per joint")
                });
                let at = (sample * samples.rollout.steps + step) * samples.dof;
                for (found, expected) in found.iter().zip(&expected) {
                    let found = &found[at..][..samples.dof];
                    let difference: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
                    let scale = largest(expected).max(1.0);
                    assert!(difference.iter().all(|difference| difference.is_finite()), "{}: {found:?}", robot.name);
                    worst.0 = worst.0.max(largest(&difference) / scale);
                }
                worst.1 += 1;
            }
        }
    }
    worst
}

/// Shipped arms, with friction, limits, rotors and payloads.
#[test]
fn each_step_of_shipped_arms_is_eulers() {
    let mut rng = Rng::with_seed(31);
    let mut count = 0;
    for file in rne_robots::ROBOTS {
        let arm = CompiledArm::from_yaml(file.yaml).expect("a shipped robot").with_rotors();
        let oracle = DynArm::from_robot(arm.robot());
        let full = Rollout {
            friction: Some(FrictionWidth::Of(WIDTH)),
            limits: RolloutLimits::ALL,
            ..Rollout::new(8, 2e-3)
        };
        for rollout in [full, Rollout::new(8, 2e-3)] {
            let mut samples = Samples::random(&mut rng, &oracle, rollout, 11);
            if rollout != full {
                samples.payload = None;
            }
            let (worst, steps) = worst(&arm, &samples);
            println!("{}: {worst:.1e}, {steps} steps", file.name);
        }
        count += 1;
    }
    assert!(count >= 20, "{count} arms");
}

/// Random arms: parallel and coincident axes, links without mass, motors with gears.
#[test]
fn each_step_of_random_arms_is_eulers() {
    let mut rng = Rng::with_seed(32);
    let mut count = 0;
    for seed in 0.. {
        let arm = CompiledArm::from_yaml(&arms::yaml(seed)).expect("an arm").with_rotors();
        let oracle = DynArm::from_robot(arm.robot());
        let rollout = Rollout { friction: Some(FrictionWidth::Of(WIDTH)), ..Rollout::new(3, 1e-3) };
        let samples = Samples::random(&mut rng, &oracle, rollout, 5);
        let (worst, steps) = worst(&arm, &samples);
        println!("{seed} {}: {worst:.1e}, {steps} steps", samples.dof);
        if steps > 0 {
            count += 1;
        }
        if count == 500 {
            println!("{seed} seeds");
            return;
        }
    }
}
