//! The step of the semi-implicit Euler method, and its derivatives: q̇' = q̇ + h q̈, then q' = q + h q̇'.

use crate::coordinates::Coordinates;
use crate::formulate::{Outputs, square};
use crate::ir::{Builder, Name, Quantity, Symbol, WithRespectTo};

/// The duration h.
pub(crate) fn duration(builder: &Builder) -> Symbol<'_> {
    builder.argument(Name::scalar(Quantity::Duration, 0))
}

/// The next positions, then the next velocities, by the accelerations of the coordinates.
pub(crate) fn euler_step<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    accelerations: &Outputs<'s>,
) -> Outputs<'s> {
    let step = duration(builder);
    let (mut positions, mut rates) = (Vec::new(), Vec::new());
    for (&joint, &(_, acceleration)) in coordinates.joints().iter().zip(accelerations) {
        let (line, argument) =
            (builder.joint(joint + 1), |quantity| builder.argument(Name::scalar(quantity, joint + 1)));
        let rate = line.scalar(Quantity::NextRate, || argument(Quantity::Rate) + step * acceleration);
        let position = line.scalar(Quantity::NextPosition, || argument(Quantity::Position) + step * rate);
        positions.push((Name::scalar(Quantity::NextPosition, joint + 1), position));
        rates.push((Name::scalar(Quantity::NextRate, joint + 1), rate));
    }
    [positions, rates].concat()
}

/// The derivatives of the next positions by q, by q̇ and by τ, then those of the next velocities. `by_state` are those
/// of h q̈ by q and by q̇; `by_torques`, those by τ, are named and symmetric. All are by rows.
pub(crate) fn derivatives<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    by_state: &[Vec<Symbol<'s>>; 2],
    by_torques: Outputs<'s>,
) -> Outputs<'s> {
    let (joints, step) = (coordinates.joints(), duration(builder));
    let dof = joints.len();
    let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
    let kinds: [fn(usize) -> WithRespectTo; 2] = [WithRespectTo::Position, WithRespectTo::Rate];
    // x + what changes it, where x is the argument `own`
    let moved = |quantity, own: usize, kind: usize, change: &dyn Fn(usize) -> Symbol<'s>| {
        square(dof, |row, column| {
            let name = Name { by: Some(kinds[kind](joints[column] + 1)), ..Name::scalar(quantity, joints[row] + 1) };
            let moved = builder.joint(joints[row] + 1).within(quantity, || {
                let change = change(row * dof + column);
                if own == kind && row == column { one + change } else { change }
            });
            (name, builder.name(name, moved))
        })
    };
    let [rates_by_q, rates_by_qd] = [0, 1].map(|kind| moved(Quantity::NextRate, 1, kind, &|at| by_state[kind][at]));
    let [by_q, by_qd] = [(0, &rates_by_q), (1, &rates_by_qd)]
        .map(|(kind, rates)| moved(Quantity::NextPosition, 0, kind, &|at| step * rates[at].1));
    let by_tau = square(dof, |row, column| {
        let (row, column) = (row.max(column), row.min(column));
        let name = Name::indexed(Quantity::NextPosition, joints[row] + 1, joints[column] + 1);
        let line = builder.joint(joints[row] + 1);
        let element = line.within(Quantity::NextPosition, || step * by_torques[row * dof + column].1);
        (name, builder.name(name, element))
    });
    [by_q, by_qd, by_tau, rates_by_q, rates_by_qd, by_torques].concat()
}
