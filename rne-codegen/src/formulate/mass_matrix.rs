//! M(q) by columns: the torques of the seven steps for q̈ = e_j, of an arm at rest and without gravity.

use crate::formulate::{Arm, AtTip, JointState, Motion, seven_steps};
use crate::ir::{Cause, Symbol, WithRespectTo};

/// The upper half of M, of an arm with `tip` at its tip: row i holds its elements (i, i) to (i, n). Element (i, j) is
/// torque i for q̈ = e_j, `taui_qddj`.
///
/// The lower half is the same, so that M is symmetric to the last bit.
pub(crate) fn upper_half<'s>(arm: &Arm<'s>, states: &[JointState<'s>], tip: &AtTip<'s>) -> Vec<Vec<Symbol<'s>>> {
    let (builder, dof) = (arm.builder, states.len());
    let (rest, zero) = (builder.constant(0.0, Cause::AtRest), builder.constant(0.0, Cause::UnitAcceleration));
    let one = builder.constant(1.0, Cause::UnitAcceleration);
    let base = Motion::of_fixed_base(builder, builder.zeros(Cause::NoGravity));
    // where the links are does not depend on how they move
    let still: Vec<_> = states.iter().map(|state| JointState { qd: rest, qdd: zero, ..*state }).collect();
    seven_steps::forward(arm, &still, &base);
    let mut rows: Vec<Vec<_>> = vec![Vec::new(); dof];
    for column in 0..dof {
        let mut moved = still.clone();
        moved[column].qdd = one;
        let loads = builder
            .by(Some(WithRespectTo::RateDot(column + 1)), || seven_steps::inverse_dynamics(arm, &moved, &base, tip));
        for (row, load) in rows.iter_mut().zip(&loads).take(column + 1) {
            row.push(load.torque);
        }
    }
    rows
}
