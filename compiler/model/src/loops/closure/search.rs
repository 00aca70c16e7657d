//! The search for positions of the joints at which the loops are closed.

use std::f64::consts::{PI, TAU};

use super::{Equations, Ways};
use crate::{Joint, JointKind};

/// A loop counts as closed if every residual of its equations is below this; lengths are divided by the loops' size.
const CLOSED: f64 = 1e-12;
/// How far a position may be outside its limits by rounding, rad or m.
const ROUNDING: f64 = 1e-9;
/// Number of starts of Newton's method; and the number after which the search gives up if no start has closed the
/// loops.
const STARTS: usize = 150;
const STARTS_WITHOUT_SUCCESS: usize = 40;
/// Largest number of products and sums that the search for closures may cost.
const MOST_WORK: usize = 200_000_000;
/// Largest number of products and sums that the search for singular configurations may cost.
const MOST_WORK_OF_DESCENT: usize = 20_000_000;

impl Equations<'_> {
    /// Returns the products and sums that one step of Newton's method costs.
    fn work(&self) -> usize {
        let n = self.variables.len();
        let of_loop = |ways: &Ways| (3 + ways.cut.differences(), ways.joints.iter().map(Vec::len).sum::<usize>());
        let (rows, joints) = self.ways.iter().map(of_loop).fold((0, 0), |sum, it| (sum.0 + it.0, sum.1 + it.1));
        (rows + n) * n * n + 200 * joints
    }

    /// Closes the loops, beginning at `positions`, by the method of Levenberg and Marquardt over all variables. Returns
    /// the largest residual that is left, free of units, and the positions found. `within` keeps variables within their
    /// limits.
    fn closed(&self, mut positions: Vec<f64>, within: bool, work: &mut usize) -> (f64, Vec<f64>) {
        const STEPS: usize = 80;
        // damping never becomes 0, because redundant equations make the matrix of the normal equations singular
        const LEAST_DAMPING: f64 = 1e-13;
        let size = |residual: &[f64]| residual.iter().map(|it| it.abs()).fold(0.0, worse);
        let square = |residual: &[f64]| residual.iter().map(|it| it * it).sum::<f64>();
        self.complete(&mut positions);
        let (mut residual, mut derivatives) = self.open(&positions);
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            *work = work.saturating_add(self.work());
            if size(&residual) < 1e-16 || damping > 1e8 || !square(&residual).is_finite() {
                break;
            }
            let Some(step) = derivatives.damped_step(&residual, damping) else {
                damping *= 10.0;
                continue;
            };
            // a long step could jump to another assembly mode of the mechanism
            let longest = step.iter().map(|it| it.abs()).fold(1.0, worse);
            let mut next = positions.clone();
            for (&joint, step) in self.variables.iter().zip(&step) {
                next[joint] += self.unit(joint) * step / longest;
                if let (true, Some((lower, upper))) = (within, self.joints[joint].limits.position) {
                    next[joint] = next[joint].clamp(lower, upper);
                }
            }
            self.complete(&mut next);
            let (next_residual, next_derivatives) = self.open(&next);
            let (before, after) = (square(&residual), square(&next_residual));
            if after < before {
                (positions, residual, derivatives) = (next, next_residual, next_derivatives);
                damping = (damping * 0.1).min(after).max(LEAST_DAMPING);
            } else if size(&residual) < 0.01 * CLOSED {
                break;
            } else {
                damping *= 10.0;
            }
        }
        (size(&residual), positions)
    }

    /// Returns whether all joints are within their position limits, up to rounding.
    pub(crate) fn is_within(&self, positions: &[f64]) -> bool {
        let is_within = |(joint, position): (&Joint, &f64)| {
            joint.limits.position.is_none_or(|(lower, upper)| (lower - ROUNDING..=upper + ROUNDING).contains(position))
        };
        self.joints.iter().zip(positions).all(is_within)
    }

    /// Returns start positions within the limits: without `random` 0 for each joint, else pseudorandom ones.
    fn start(&self, random: Option<&mut Random>) -> Vec<f64> {
        let mut random = random;
        let position = |joint: &Joint| {
            let (lower, upper) = joint.limits.position.unwrap_or(match joint.row.kind {
                JointKind::Revolute => (-PI, PI),
                JointKind::Prismatic => (-1.0, 1.0),
            });
            match &mut random {
                None => 0.0_f64.clamp(lower, upper),
                Some(random) => lower + random.next() * (upper - lower),
            }
        };
        self.joints.iter().map(position).collect()
    }

    /// Searches up to `wanted` configurations that close all loops, within the position limits as far as possible:
    /// first from a start with all positions 0, then from pseudorandom ones, the same in every run. Returns them, and
    /// the positions at which the loops came nearest to closing.
    pub(crate) fn closures(&self, wanted: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
        let (mut within, mut outside) = (Vec::new(), Vec::new());
        let (mut nearest, mut least) = (vec![0.0; self.joints.len()], f64::INFINITY);
        let (mut random, mut work) = (Random(1), 0);
        for start in 0..STARTS {
            let is_hopeless = start == STARTS_WITHOUT_SUCCESS && within.is_empty() && outside.is_empty();
            if within.len() == wanted || is_hopeless || work > MOST_WORK {
                break;
            }
            let positions = self.start((start > 0).then_some(&mut random));
            let (mut off, mut found) = self.closed(positions.clone(), true, &mut work);
            if off >= CLOSED || off.is_nan() {
                (off, found) = self.closed(positions, false, &mut work);
            }
            if off < least || start == 0 {
                (least, nearest) = (off, found.clone());
            }
            if off < CLOSED {
                self.turn_back(&mut found);
                if self.is_within(&found) { within.push(found) } else { outside.push(found) }
            }
        }
        let missing = wanted - within.len();
        within.extend(outside.into_iter().take(missing));
        (within, nearest)
    }

    /// Removes whole turns from the positions of joints that turn without limits and that no other joint follows.
    fn turn_back(&self, positions: &mut [f64]) {
        let is_followed = |joint: usize| {
            let of = self.joints.iter().filter_map(|it| it.coupling.as_ref());
            of.flat_map(|coupling| &coupling.follows).any(|(leader, _)| *leader == joint)
        };
        for &joint in &self.variables {
            let of = &self.joints[joint];
            if of.row.kind == JointKind::Revolute && of.limits.position.is_none() && !is_followed(joint) {
                positions[joint] -= TAU * libm::round(positions[joint] / TAU);
            }
        }
    }

    /// Searches the smallest value of `number` at closures within the limits, by random steps downhill from known
    /// closures. Returns an upper bound of the minimum, and the positions where it is.
    pub(crate) fn least(&self, closures: &[Vec<f64>], number: impl Fn(&[f64]) -> f64) -> Option<(f64, Vec<f64>)> {
        const STARTS: usize = 5;
        const STEPS: usize = 40;
        let known = closures.iter().filter(|positions| self.is_within(positions));
        let mut known: Vec<(f64, Vec<f64>)> = known.map(|it| (number(it), it.clone())).collect();
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut random, mut work) = (Random(2), 0);
        for (least, positions) in known.iter_mut().take(STARTS) {
            let mut reach = 0.5;
            for _ in 0..STEPS {
                if work > MOST_WORK_OF_DESCENT {
                    break;
                }
                let mut start = positions.clone();
                for &joint in &self.variables {
                    start[joint] += self.unit(joint) * reach * (2.0 * random.next() - 1.0);
                    if let Some((lower, upper)) = self.joints[joint].limits.position {
                        start[joint] = start[joint].clamp(lower, upper);
                    }
                }
                let (off, mut found) = self.closed(start, true, &mut work);
                self.turn_back(&mut found);
                let value = if off < CLOSED && self.is_within(&found) { number(&found) } else { f64::INFINITY };
                if value < *least {
                    (*least, *positions) = (value, found);
                } else {
                    reach *= 0.8;
                }
            }
        }
        known.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Returns the larger of two numbers, or not-a-number if one of them is that.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// A generator of pseudorandom numbers from 0 to 1: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number
/// Generators", 2014.
struct Random(u64);

impl Random {
    #[allow(clippy::cast_precision_loss)] // 53 bits
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
