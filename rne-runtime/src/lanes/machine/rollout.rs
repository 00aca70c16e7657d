//! Rollouts: samples of states that move step by step under torques.
//!
//! A block of samples goes through all steps before the next block begins, so its states stay in the first-level cache,
//! one row of numbers per joint. Nothing is allocated between steps.

use super::WrongArrays;
use super::arrays::{Source, States};
use super::code::Code;
use super::execution::{Port, execute, slots};
use super::many::{BLOCK, WIDEST, turns};
use crate::VectorUnit;
use crate::lanes::batch::BatchScalar;
use crate::lanes::batch::vector::{Vector, Work};
use crate::number::sin_cos::Float;

/// Number of bytes of the widest register.
#[cfg(feature = "rayon")]
const REGISTER: usize = 64;

/// A rollout of an arm: the initial states of the samples, their torques, and their limits.
///
/// A step of duration h takes a state q, q̇ and torques τ to the next state by semi-implicit Euler, in this order:
///
/// ```text
/// u  = τ, not beyond ± effort
/// u  = u - friction(q̇)
/// q̈  = accelerations of the code for q, q̇, u
/// q̇' = q̇ + h q̈, not beyond ± velocity
/// q' = q + h q̇'
/// where q' is beyond an end of the positions: q' = that end, q̇' = 0
/// ```
///
/// A number that is NaN remains NaN in every line, and does not affect other samples.
#[derive(Clone, Copy, Debug)]
pub struct Rollout<'a, T> {
    /// The number of steps of each sample.
    pub steps: usize,
    /// The duration h of a step, s.
    pub step: T,
    /// Limits and friction of each joint.
    pub joints: &'a [RolloutJoint<T>],
    /// For each input of the code, its index in the list of all arguments: the position of every joint, the velocity of
    /// every joint, the torque of every joint, and then `constants`.
    pub inputs: &'a [usize],
    /// Initial positions: a source per joint.
    pub q: &'a [Source<'a, T>],
    /// Initial velocities: a source per joint.
    pub qd: &'a [Source<'a, T>],
    /// Torques: for each step, a source per joint.
    pub tau: &'a [Source<'a, T>],
    /// Other arguments, which are the same in all steps.
    pub constants: &'a [Source<'a, T>],
}

/// Limits and friction of a joint during a rollout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RolloutJoint<T> {
    /// The largest torque of the actuator, N m or N.
    pub effort: Option<T>,
    /// The friction of the joint.
    pub friction: Option<SmoothFriction<T>>,
    /// The largest speed, rad/s or m/s.
    pub velocity: Option<T>,
    /// The two ends of the positions, rad or m.
    pub position: Option<[T; 2]>,
}

/// Viscous friction, and Coulomb friction that changes its sign gradually: `viscous` q̇ + `odd` s + `even` s², with
/// s = q̇ / √(q̇² + `width`²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothFriction<T> {
    /// Viscous friction at the joint, N m s/rad or N s/m.
    pub viscous: T,
    /// Half the difference of the Coulomb friction of both directions, N m or N.
    pub odd: T,
    /// Half the sum of the Coulomb friction of both directions, N m or N.
    pub even: T,
    /// The speed about which Coulomb friction changes its sign, rad/s or m/s; above zero.
    pub width: T,
}

impl<T: BatchScalar> SmoothFriction<T> {
    #[inline(always)]
    fn torque(&self, velocity: T) -> T {
        let sign = velocity / (velocity * velocity + self.width * self.width).sqrt();
        self.viscous * velocity + (self.odd * sign + self.even * (sign * sign))
    }
}

/// Returns the nearest number between two ends; NaN remains NaN.
#[inline(always)]
fn bounded<T: BatchScalar>(value: T, [lower, upper]: [T; 2]) -> T {
    if value > upper {
        upper
    } else if value < lower {
        lower
    } else {
        value
    }
}

impl Code {
    /// Rolls out samples, where this code computes the accelerations of the joints. Writes the positions and the
    /// velocities after each step to `states`, ordered by sample, then by step, then by joint.
    ///
    /// With the feature `rayon`, on all cores for more than some thousand states.
    ///
    /// # Errors
    /// When a source has too few numbers, the code has other inputs or outputs, or the room for the states is of
    /// another size. Nothing is written then.
    pub fn roll_out<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        samples: usize,
        rollout: &Rollout<'_, T>,
        states: [&mut [T]; 2],
    ) -> Result<(), WrongArrays> {
        let Rollout { joints, inputs, q, qd, tau, constants, steps, .. } = *rollout;
        let joints = joints.len();
        let arguments = 3 * joints + constants.len();
        if inputs.len() != self.inputs || inputs.iter().any(|&input| input >= arguments) {
            return Err(WrongArrays::Inputs { expected: self.inputs, found: inputs.len() });
        }
        let of_sample = joints.saturating_mul(steps);
        if [q.len(), qd.len(), tau.len()] != [joints, joints, of_sample] {
            let (expected, found) = (of_sample.saturating_add(2 * joints), q.len() + qd.len() + tau.len());
            return Err(WrongArrays::Inputs { expected, found });
        }
        let mut sources = q.iter().chain(qd).chain(tau).chain(constants);
        if let Some(index) = sources.position(|source| !source.holds(samples)) {
            return Err(WrongArrays::Input(index));
        }
        let size = of_sample.checked_mul(samples);
        if self.outputs != joints || states.iter().any(|numbers| Some(numbers.len()) != size) {
            return Err(WrongArrays::Outputs);
        }
        if size != Some(0) {
            self.roll_out_part(unit, 0..samples, rollout, states);
        }
        Ok(())
    }

    fn roll_out_part<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        samples: States,
        rollout: &Rollout<'_, T>,
        states: [&mut [T]; 2],
    ) {
        #[cfg(feature = "rayon")]
        {
            // number of samples in a block of the widest unit
            let block = REGISTER / size_of::<T>() * BLOCK;
            let half = (samples.len() / 2).next_multiple_of(block);
            if half < samples.len() && samples.len() * rollout.steps >= 2 * super::TASK {
                let (middle, size) = (samples.start + half, rollout.steps * rollout.joints.len());
                let [positions, velocities] = states.map(|numbers| numbers.split_at_mut(half * size));
                crate::lanes::threads::join(
                    || self.roll_out_part(unit, samples.start..middle, rollout, [positions.0, velocities.0]),
                    || self.roll_out_part(unit, middle..samples.end, rollout, [positions.1, velocities.1]),
                );
                return;
            }
        }
        let rows = 4 * rollout.joints.len() + rollout.constants.len();
        T::with_memory((self.slots + rows) * WIDEST * BLOCK, |memory| {
            unit.run(Task { code: self, memory, rollout, samples, states });
        });
    }
}

/// Samples to be rolled out in one task.
struct Task<'a, T> {
    code: &'a Code,
    memory: &'a mut [T],
    rollout: &'a Rollout<'a, T>,
    samples: States,
    states: [&'a mut [T]; 2],
}

impl<T: BatchScalar> Work<T> for Task<'_, T> {
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, unit: V::Unit) {
        let Self { code, memory, rollout, samples, states: [positions, velocities] } = self;
        let Rollout { steps, step, joints, inputs, q, qd, tau, constants } = *rollout;
        let width = size_of::<[V::Numbers; BLOCK]>() / size_of::<T>();
        let (of_slots, rows) = memory.split_at_mut(code.slots * width);
        let slots_of_code = slots::<V, BLOCK>(of_slots);
        let dof = joints.len();
        let accelerations = 3 * dof + constants.len();
        let rows = &mut rows[..(accelerations + dof) * width];
        let of_sample = steps * dof;
        for start in samples.clone().step_by(width) {
            // lanes after the last sample repeat this sample
            let block = Block { start, count: width.min(samples.end - start), width };
            block.read(q, &mut rows[..dof * width]);
            block.read(qd, &mut rows[dof * width..][..dof * width]);
            block.read(constants, &mut rows[3 * dof * width..accelerations * width]);
            for index in 0..steps {
                block.read(&tau[index * dof..][..dof], &mut rows[2 * dof * width..][..dof * width]);
                drive(joints, width, &mut rows[dof * width..3 * dof * width]);
                let mut port = StatePort::<V, BLOCK> { unit, rows: slots::<V, BLOCK>(rows), inputs, accelerations };
                // one loop for both parts, so that the code of `execute` is compiled once here
                for (part, instructions) in [&code.angles, &code.rest].into_iter().enumerate() {
                    if part == 1 {
                        turns::<V, BLOCK>(unit, &code.turns, slots_of_code);
                    }
                    execute::<V, _, BLOCK>(unit, instructions, slots_of_code, &mut port);
                }
                let (states, others) = rows.split_at_mut(2 * dof * width);
                move_on(joints, step, width, states, &others[(accelerations - 2 * dof) * width..]);
                let place = (start - samples.start) * of_sample + index * dof;
                let (of_positions, of_velocities) = states.split_at(dof * width);
                block.write(of_positions, &mut positions[place..], of_sample);
                block.write(of_velocities, &mut velocities[place..], of_sample);
            }
        }
    }
}

/// The samples of a block.
struct Block {
    /// The number of the first sample.
    start: usize,
    /// The number of samples.
    count: usize,
    /// The number of samples for which a row has space.
    width: usize,
}

impl Block {
    /// Reads a row from each source, sample by sample, because the numbers of a sample are next to each other.
    #[inline(always)]
    fn read<T: BatchScalar>(&self, sources: &[Source<'_, T>], rows: &mut [T]) {
        for lane in 0..self.width {
            let sample = self.start + lane.min(self.count - 1);
            for (row, source) in rows.chunks_exact_mut(self.width).zip(sources) {
                row[lane] = source.at(sample);
            }
        }
    }

    /// Writes one number of each row for each sample. The samples are `apart` numbers apart in `room`.
    #[inline(always)]
    fn write<T: BatchScalar>(&self, rows: &[T], room: &mut [T], apart: usize) {
        for (lane, room) in room.chunks_mut(apart).take(self.count).enumerate() {
            for (row, room) in rows.chunks_exact(self.width).zip(room) {
                *room = row[lane];
            }
        }
    }
}

/// Limits the torques and subtracts friction. `rows` has the rows of velocities, then those of torques.
#[inline(always)]
fn drive<T: BatchScalar>(joints: &[RolloutJoint<T>], width: usize, rows: &mut [T]) {
    let (velocities, torques) = rows.split_at_mut(joints.len() * width);
    let rows = velocities.chunks_exact(width).zip(torques.chunks_exact_mut(width));
    for (joint, (velocities, torques)) in joints.iter().zip(rows) {
        if let Some(effort) = joint.effort {
            for torque in &mut *torques {
                *torque = bounded(*torque, [-effort, effort]);
            }
        }
        if let Some(friction) = joint.friction {
            for (torque, velocity) in torques.iter_mut().zip(velocities) {
                *torque -= friction.torque(*velocity);
            }
        }
    }
}

/// Moves states by one step. `states` has the rows of positions, then those of velocities.
#[inline(always)]
fn move_on<T: BatchScalar>(joints: &[RolloutJoint<T>], step: T, width: usize, states: &mut [T], accelerations: &[T]) {
    let (positions, velocities) = states.split_at_mut(joints.len() * width);
    let rows = positions.chunks_exact_mut(width).zip(velocities.chunks_exact_mut(width));
    let rows = rows.zip(accelerations.chunks_exact(width));
    for (joint, ((positions, velocities), accelerations)) in joints.iter().zip(rows) {
        for (velocity, acceleration) in velocities.iter_mut().zip(accelerations) {
            *velocity += step * *acceleration;
        }
        if let Some(largest) = joint.velocity {
            for velocity in &mut *velocities {
                *velocity = bounded(*velocity, [-largest, largest]);
            }
        }
        for (position, velocity) in positions.iter_mut().zip(&*velocities) {
            *position += step * *velocity;
        }
        if let Some(ends) = joint.position {
            for (position, velocity) in positions.iter_mut().zip(&mut *velocities) {
                let inside = bounded(*position, ends);
                // a joint stops at the end of its positions; comparisons with NaN are false
                *velocity = if *position > ends[1] || *position < ends[0] { T::ZERO } else { *velocity };
                *position = inside;
            }
        }
    }
}

/// Reads inputs of the code from the rows of a block and writes its outputs to them.
struct StatePort<'a, V: Vector, const N: usize> {
    unit: V::Unit,
    rows: &'a mut [[V::Numbers; N]],
    inputs: &'a [usize],
    /// The index of the first row of the outputs.
    accelerations: usize,
}

impl<V: Vector<Element: BatchScalar>, const N: usize> Port<V, N> for StatePort<'_, V, N> {
    #[inline(always)]
    fn input(&mut self, index: usize) -> [V; N] {
        let row = &self.rows[self.inputs[index]];
        let mut values = [V::splat(V::Element::ZERO); N];
        for i in 0..N {
            values[i] = V::load(self.unit, &row[i]);
        }
        values
    }

    #[inline(always)]
    fn output(&mut self, index: usize, values: &[V; N]) {
        let row = &mut self.rows[self.accelerations + index];
        for i in 0..N {
            row[i] = values[i].store();
        }
    }
}
