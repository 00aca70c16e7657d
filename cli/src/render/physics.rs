//! `rne check --physics`: checks laws of mechanics that the numbers of any arm must obey, computed by the runtime.

use std::fmt::Write as _;

use rne::{DynArm, WrongLength};
use rne_model::Robot;

use crate::palette::{ERROR, GOOD, QUIET};
use crate::render::layout::{Align, columns};

/// Number of states at which the laws are checked, the same in every run.
const STATES: u32 = 5;
/// Rounding error of a sum that is zero in exact arithmetic, relative to its terms.
const ROUNDING: f64 = 1e-11;
/// Largest error of a difference quotient.
const DIFFERENCE: f64 = 1e-7;
/// Largest error of a numerical integration.
const INTEGRATION: f64 = 1e-6;
/// Half the time span of difference quotients, s.
const STEP: f64 = 1e-3;
/// Time step and number of steps of the integration, 0.1 s in total.
const TICK: f64 = 1e-3;
const TICKS: u32 = 100;

/// Result for one law of mechanics.
struct Law {
    name: &'static str,
    /// The worst error over all states, relative to the terms that cancel; `NaN` where it could not be computed.
    worst: f64,
    /// The bound that the error must satisfy.
    bound: Bound,
}

#[derive(Clone, Copy)]
enum Bound {
    AtMost(f64),
    Above(f64),
}

impl Law {
    /// Returns whether the law holds; with a `NaN` it does not.
    fn holds(&self) -> bool {
        match self.bound {
            Bound::AtMost(bound) => self.worst <= bound,
            Bound::Above(bound) => self.worst > bound,
        }
    }
}

/// Returns the laws with their numbers, a line for each, and whether all hold.
pub(crate) fn check(robot: &Robot) -> Result<(String, bool), WrongLength> {
    let laws = laws(&DynArm::from_robot(robot))?;
    let mut cells = Vec::new();
    for law in &laws {
        let bound = match law.bound {
            Bound::AtMost(bound) => format!("at most {bound:.0e}"),
            Bound::Above(bound) => format!("above {bound:.0e}"),
        };
        cells.push(vec![format!("   {}", law.name), format!("{:.1e}", law.worst), bound]);
    }
    let mut text = String::new();
    for (law, line) in laws.iter().zip(columns(&[Align::Left, Align::Right, Align::Left], &cells)) {
        let verdict = if law.holds() { format!("{GOOD}holds{GOOD:#}") } else { format!("{ERROR}fails{ERROR:#}") };
        let _ = writeln!(text, "{line}  {verdict}");
    }
    let _ = writeln!(text, "   {QUIET}worst of {STATES} states, relative to what cancels; links alone{QUIET:#}");
    Ok((text, laws.iter().all(Law::holds)))
}

fn laws(arm: &DynArm) -> Result<Vec<Law>, WrongLength> {
    let [mut symmetry, mut power, mut conservation, mut skew] = [0.0_f64; 4];
    let mut definiteness = f64::INFINITY;
    for state in 1..=STATES {
        let [q, qd, qdd] = [(1, 3.0), (2, 1.0), (3, 1.0)].map(|(kind, size)| numbers(arm.dof(), state, kind, size));
        symmetry = worse(symmetry, asymmetry(arm, &q)?);
        definiteness = definiteness.min(smallest_pivot(arm.mass_matrix(&q)?));
        power = worse(power, power_balance(arm, &q, &qd, &qdd)?);
        skew = worse(skew, skewness(arm, &q, &qd)?);
        conservation = worse(conservation, energy_drift(arm, &q, &qd)?);
    }
    let law = |name, worst, bound| Law { name, worst, bound };
    Ok(vec![
        law("mass matrix: symmetric, and what unit accelerations take", symmetry, Bound::AtMost(ROUNDING)),
        law("mass matrix: positive definite (smallest pivot)", definiteness, Bound::Above(ROUNDING)),
        law("power of the torques: the change of energy", power, Bound::AtMost(DIFFERENCE)),
        law("Ṁ - 2C: skew", skew, Bound::AtMost(DIFFERENCE)),
        law("energy: conserved for 0.1 s without torques", conservation, Bound::AtMost(INTEGRATION)),
    ])
}

/// Returns the larger of two numbers, or not-a-number if one of them is that.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// Returns pseudorandom numbers in ±`size`: multiples of irrational numbers, without their whole part.
fn numbers(count: usize, state: u32, kind: u32, size: f64) -> Vec<f64> {
    let number = |index: u32| {
        let phase = f64::from(state) * 0.754_877_666_246_693 + f64::from(kind) * 0.569_840_290_998_053;
        size * (2.0 * (phase + f64::from(index) * 0.618_033_988_749_895).fract() - 1.0)
    };
    (1..).map(number).take(count).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| worse(largest, value.abs()))
}

/// Compares the columns M e = τ(q, 0, e) - τ(q, 0, 0) with the transposed matrix and with `mass_matrix`.
fn asymmetry(arm: &DynArm, q: &[f64]) -> Result<f64, WrongLength> {
    let rest = vec![0.0; q.len()];
    let still = arm.inverse_dynamics(q, &rest, &rest)?;
    let mut columns = Vec::new();
    for joint in 0..q.len() {
        let unit: Vec<f64> = (0..q.len()).map(|other| f64::from(u8::from(other == joint))).collect();
        let moving = arm.inverse_dynamics(q, &rest, &unit)?;
        columns.push(moving.iter().zip(&still).map(|(moving, still)| moving - still).collect::<Vec<f64>>());
    }
    let matrix = arm.mass_matrix(q)?;
    let size = columns.iter().fold(largest(&still), |size, column| worse(size, largest(column)));
    let mut off = 0.0;
    for (i, column) in columns.iter().enumerate() {
        for (j, value) in column.iter().enumerate() {
            off = worse(off, (value - columns[j][i]).abs());
            off = worse(off, (value - matrix[j][i]).abs());
        }
    }
    Ok(relative(off, size))
}

/// Divides a difference by the size of its terms; returns zero if both are zero.
fn relative(off: f64, size: f64) -> f64 {
    if off == 0.0 { 0.0 } else { off / size }
}

/// Returns the smallest pivot of M = Lᵀ L from tip to base, each relative to the diagonal element: the inertia that
/// resists a joint while the distal joints move freely. It is zero or negative if M is not positive definite.
pub(crate) fn smallest_pivot(mut matrix: Vec<Vec<f64>>) -> f64 {
    let diagonal: Vec<f64> = matrix.iter().enumerate().map(|(index, row)| row[index]).collect();
    let mut smallest = f64::INFINITY;
    for joint in (0..matrix.len()).rev() {
        let pivot = matrix[joint][joint];
        // no inertia resists this joint, or the matrix is not positive definite
        if pivot.is_nan() || pivot <= 0.0 {
            return 0.0;
        }
        smallest = smallest.min(pivot / diagonal[joint]);
        for row in 0..joint {
            for column in 0..joint {
                matrix[row][column] -= matrix[row][joint] * matrix[joint][column] / pivot;
            }
        }
    }
    smallest
}

fn energy(arm: &DynArm, q: &[f64], qd: &[f64]) -> Result<f64, WrongLength> {
    Ok(arm.kinetic_energy(q, qd)? + arm.potential_energy(q)?)
}

/// Returns `a + t b`.
fn along(a: &[f64], t: f64, b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + t * b).collect()
}

/// Returns the derivative at 0 from values at ±h and ±2h; its error is of order h⁴.
fn slope(near: [f64; 2], far: [f64; 2]) -> f64 {
    (8.0 * (near[1] - near[0]) - (far[1] - far[0])) / (12.0 * STEP)
}

/// Returns τ·q̇ - dE/dt along q(t) = q + q̇ t + q̈ t²/2.
fn power_balance(arm: &DynArm, q: &[f64], qd: &[f64], qdd: &[f64]) -> Result<f64, WrongLength> {
    let at = |t: f64| energy(arm, &along(&along(q, t, qd), t * t / 2.0, qdd), &along(qd, t, qdd));
    let rate = slope([at(-STEP)?, at(STEP)?], [at(-2.0 * STEP)?, at(2.0 * STEP)?]);
    let tau = arm.inverse_dynamics(q, qd, qdd)?;
    let (power, size) =
        tau.iter().zip(qd).fold((0.0, 0.0), |(power, size), (tau, qd)| (power + tau * qd, size + (tau * qd).abs()));
    Ok(relative((power - rate).abs(), size + at(0.0)?.abs()))
}

/// Returns the symmetric part of Ṁ - 2C.
fn skewness(arm: &DynArm, q: &[f64], qd: &[f64]) -> Result<f64, WrongLength> {
    let at = |t: f64| arm.mass_matrix(&along(q, t, qd));
    let (near, far) = ([at(-STEP)?, at(STEP)?], [at(-2.0 * STEP)?, at(2.0 * STEP)?]);
    let (matrix, coriolis) = (at(0.0)?, arm.coriolis_matrix(q, qd)?);
    let rate = |i: usize, j: usize| slope([near[0][i][j], near[1][i][j]], [far[0][i][j], far[1][i][j]]);
    let (mut off, mut size) = (0.0, 0.0);
    for (i, row) in coriolis.iter().enumerate() {
        for (j, c) in row.iter().enumerate() {
            off = worse(off, (rate(i, j) + rate(j, i) - 2.0 * (c + coriolis[j][i])).abs());
            size = worse(worse(size, c.abs()), matrix[i][j].abs());
        }
    }
    Ok(relative(off, size))
}

/// Returns the drift of the energy of an arm without torques, integrated by the fourth-order Runge-Kutta method,
/// relative to its largest kinetic energy.
fn energy_drift(arm: &DynArm, q: &[f64], qd: &[f64]) -> Result<f64, WrongLength> {
    let free = vec![0.0; q.len()];
    let (mut q, mut qd) = (q.to_vec(), qd.to_vec());
    let start = energy(arm, &q, &qd)?;
    let (mut off, mut size) = (0.0, start.abs());
    for _ in 0..TICKS {
        let (v1, a1) = (qd.clone(), arm.forward_dynamics(&q, &qd, &free)?);
        let v2 = along(&qd, TICK / 2.0, &a1);
        let a2 = arm.forward_dynamics(&along(&q, TICK / 2.0, &v1), &v2, &free)?;
        let v3 = along(&qd, TICK / 2.0, &a2);
        let a3 = arm.forward_dynamics(&along(&q, TICK / 2.0, &v2), &v3, &free)?;
        let v4 = along(&qd, TICK, &a3);
        let a4 = arm.forward_dynamics(&along(&q, TICK, &v3), &v4, &free)?;
        for (y, rates) in [(&mut q, [&v1, &v2, &v3, &v4]), (&mut qd, [&a1, &a2, &a3, &a4])] {
            for (joint, y) in y.iter_mut().enumerate() {
                let [k1, k2, k3, k4] = rates.map(|rates| rates[joint]);
                *y += TICK / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            }
        }
        off = worse(off, (energy(arm, &q, &qd)? - start).abs());
        size = worse(size, arm.kinetic_energy(&q, &qd)?);
    }
    Ok(relative(off, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_that_do_not_hold_fail() {
        let law = |worst, bound| Law { name: "", worst, bound }.holds();
        assert!(law(1e-12, Bound::AtMost(1e-11)) && !law(1e-10, Bound::AtMost(1e-11)));
        assert!(law(1e-3, Bound::Above(1e-11)) && !law(0.0, Bound::Above(1e-11)));
        assert!(!law(f64::NAN, Bound::AtMost(1.0)) && !law(f64::NAN, Bound::Above(0.0)));
        assert!(worse(f64::NAN, 1.0).is_nan() && worse(1.0, f64::NAN).is_nan());
    }

    #[test]
    fn pivots() {
        assert_eq!(smallest_pivot(vec![vec![2.0, 1.0], vec![1.0, 2.0]]), 0.75);
        assert_eq!(smallest_pivot(vec![vec![1.0, 1.0], vec![1.0, 1.0]]), 0.0);
        assert_eq!(smallest_pivot(vec![vec![1.0, 0.0], vec![0.0, 0.0]]), 0.0);
        // the pivot is relative to the diagonal element, so a light wrist on a heavy arm counts as well resisted
        assert!((smallest_pivot(vec![vec![1e6, 0.6], vec![0.6, 1e-6]]) - 0.64).abs() < 1e-12);
    }
}
