//! Swings a two-link arm up to its upright position with motors that are too weak to lift it: model-predictive path
//! integral control (MPPI).
//!
//! `cargo run --release --example swing_up`
//!
//! Each cycle rolls out some hundred random variations of the planned torques, and takes their mean, in which a
//! variation with a lower cost has a greater weight (G. Williams, A. Aldrich, E. Theodorou, Model predictive path
//! integral control using covariance variable importance sampling, 2015). The first torque of the plan moves the arm.

use std::f64::consts::FRAC_PI_2;

use fastrand::Rng;
use rne::compiled::{Arguments, Array, CompiledArm, FrictionWidth, Rollout, RolloutLimits};

/// Two rods of 1 kg and 0.5 m in a vertical plane. To hold them level takes 9.8 N m at the first joint.
const ARM: &str = "
format: 1
name: swing_up
source: made for this example
convention: standard
gravity: [0, -9.81, 0] # m/s²
joints:
  - name: shoulder
    type: revolute
    dh: {theta: 0, d: 0, a: 0.5, alpha: 0}
    link: {mass: 1, com: [-0.25, 0, 0], inertia: {zz: 1/48}}
    motor: {viscous: 0.02, coulomb: [0.05, -0.05]}
    limits: {effort: 5, velocity: 12} # N m, rad/s
  - name: elbow
    type: revolute
    dh: {theta: 0, d: 0, a: 0.5, alpha: 0}
    link: {mass: 1, com: [-0.25, 0, 0], inertia: {zz: 1/48}}
    motor: {viscous: 0.02, coulomb: [0.05, -0.05]}
    limits: {position: [-2.5, 2.5], effort: 4, velocity: 12}
";

const SAMPLES: usize = 128;
/// Steps that are planned ahead.
const STEPS: usize = 30;
/// Duration of a step, s.
const STEP: f64 = 0.025;
/// The largest torques of the motors, N m.
const EFFORT: [f64; 2] = [5.0, 4.0];
/// Standard deviation of the largest variations of each torque, N m.
const DEVIATION: [f64; 2] = [2.5, 2.0];
/// Number of steps for which a variation stays constant.
const HELD: usize = 6;
/// The extra cost at which a variation has 1/e of the weight of the best one.
const TEMPERATURE: f64 = 0.1;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (time, [q1, q2]) = swing_up(1)?;
    println!("upright after {time:.2} s: the joints are at {q1:.3} and {q2:.3} rad");
    Ok(())
}

/// Swings the arm up. Returns the time, s, when the arm has been upright for half a second, and the positions of its
/// joints then, rad.
fn swing_up(seed: u64) -> Result<(f64, [f64; 2]), Box<dyn std::error::Error>> {
    let arm = CompiledArm::from_yaml(ARM)?;
    let model = Rollout {
        friction: Some(FrictionWidth::Of(0.1)), // rad/s
        limits: RolloutLimits::ALL,
        ..Rollout::new(STEPS, STEP)
    };
    let mut rng = Rng::with_seed(seed);
    let (mut q, mut qd) = ([-FRAC_PI_2, 0.0], [0.0; 2]); // it hangs at rest
    let mut plan = [[0.0; 2]; STEPS];
    let mut upright = 0.0;
    for cycle in 1..=400_u16 {
        // the first sample is the plan itself
        let mut tau = plan.repeat(SAMPLES);
        for (index, sample) in (0_u16..).zip(tau.chunks_mut(STEPS)).skip(1) {
            // large variations find the swing, small ones are needed to balance the arm
            vary(&mut rng, sample, 0.96_f64.powi(index.into()));
        }
        let [mut positions, mut velocities] = [(); 2].map(|()| vec![0.0; SAMPLES * STEPS * 2]);
        let start = Arguments::new().q(Array::Same(&q)).qd(Array::Same(&qd)).tau(Array::Rows(tau.as_flattened()));
        arm.rollout(&model, SAMPLES, &start, &mut positions, &mut velocities)?;

        let states = positions.chunks(2 * STEPS).zip(velocities.chunks(2 * STEPS));
        let costs: Vec<f64> = states.map(|(q, qd)| cost(q, qd)).collect();
        let lowest = costs.iter().copied().fold(f64::INFINITY, f64::min);
        let weights: Vec<f64> = costs.iter().map(|cost| ((lowest - cost) / TEMPERATURE).exp()).collect();
        let sum: f64 = weights.iter().sum();
        for (step, torques) in plan.iter_mut().enumerate() {
            *torques = [0, 1].map(|joint| {
                let of_samples = tau.chunks(STEPS).zip(&weights);
                of_samples.map(|(sample, weight)| sample[step][joint] * weight / sum).sum()
            });
        }

        // the real arm: a rollout of one sample and one step
        let torques = plan[0];
        let start = Arguments::new().q(Array::Same(&q)).qd(Array::Same(&qd)).tau(Array::Same(&torques));
        let [mut next, mut speed] = [[0.0; 2]; 2];
        arm.rollout(&Rollout { steps: 1, ..model }, 1, &start, &mut next, &mut speed)?;
        (q, qd) = (next, speed);
        plan.rotate_left(1);
        plan[STEPS - 1] = [0.0; 2];

        let is_upright = height(&q) > 0.98 && qd.iter().all(|qd| qd.abs() < 1.0);
        upright = if is_upright { upright + STEP } else { 0.0 };
        if upright > 0.5 {
            return Ok((f64::from(cycle) * STEP, q));
        }
    }
    Err(format!("the arm is not upright after 400 cycles: {q:?} rad, {qd:?} rad/s").into())
}

/// Adds random variations to torques, within the largest torques `EFFORT`.
fn vary(rng: &mut Rng, torques: &mut [[f64; 2]], scale: f64) {
    for torques in torques.chunks_mut(HELD) {
        let variation = DEVIATION.map(|deviation| scale * deviation * normal(rng));
        for torque in torques {
            *torque = [0, 1].map(|joint| (torque[joint] + variation[joint]).clamp(-EFFORT[joint], EFFORT[joint]));
        }
    }
}

/// Returns a random number of the normal distribution (G. E. P. Box, M. E. Muller, 1958).
fn normal(rng: &mut Rng) -> f64 {
    let [a, b] = [(); 2].map(|()| 1.0 - rng.f64());
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// Returns the height of the tip relative to the length of the arm: 1 if it is upright, -1 if it hangs.
fn height(q: &[f64]) -> f64 {
    0.5 * (q[0].sin() + (q[0] + q[1]).sin())
}

/// Returns the cost of a sample's states: the missing height, and the speed.
fn cost(positions: &[f64], velocities: &[f64]) -> f64 {
    let states = positions.chunks(2).zip(velocities.chunks(2));
    let of_state = |(q, qd): (&[f64], &[f64])| {
        let speed = qd[0] * qd[0] + qd[1] * qd[1];
        let missing = 1.0 - height(q);
        // near the upright position a high speed costs more
        4.0 * missing + 0.005 * speed + 0.05 * (1.0 - missing).max(0.0).powi(2) * speed
    };
    states.map(of_state).sum()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_arm_swings_up() {
        let (time, _) = super::swing_up(1).expect("it is upright");
        assert!(time < 10.0);
    }
}
