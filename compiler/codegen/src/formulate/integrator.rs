//! The step of the semi-implicit Euler method, and its derivatives: q̇' = q̇ + h q̈, then q' = q + h q̇'.
//!
//! A floating base has the pose R, p in the world. Its velocity v, its angular velocity ω and their rates a
//! (less gravity) and ω̇ are in axes of frame 0, gravity g is in those of the world:
//!
//! ```text
//! ω' = ω + h ω̇;  w = R (v + h a) + h g;  p' = p + h w
//! u = h ω' / 4;  s = u·u;  E: the rotation of the unit quaternion (1 - s, 2 u) / (1 + s)
//! B = R E;  R' = B (3 - Bᵀ B) / 2;  v' = R'ᵀ w
//! ```
//!
//! All of it is rational. R' is a step of Newton's method towards the rotation nearest to B, so that rounding errors do
//! not accumulate over many steps.

use std::array::from_fn;

use crate::coordinates::Coordinates;
use crate::formulate::arguments::vector;
use crate::formulate::layout::components;
use crate::formulate::{Frame, Outputs, pose_of_base, square};
use crate::ir::{Axis, Builder, Cause, Matrix, Name, Quantity, Symbol, Vector, WithRespectTo};

/// Returns the duration h of the step, which is an argument.
pub(crate) fn duration(builder: &Builder) -> Symbol<'_> {
    builder.argument(Name::scalar(Quantity::Duration, 0))
}

/// Returns the next positions, then the next velocities, given the accelerations of the coordinates.
pub(crate) fn step<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    accelerations: &[(Name, Symbol<'s>)],
) -> Outputs<'s> {
    let step = duration(builder);
    let (mut positions, mut rates) = (Vec::new(), Vec::new());
    for (&joint, &(_, acceleration)) in coordinates.joints().iter().zip(accelerations) {
        let (line, argument) =
            (builder.joint(joint + 1), |quantity| builder.argument(Name::scalar(quantity, joint + 1)));
        let rate = line.define(Quantity::NextRate).by(argument(Quantity::Rate) + step * acceleration);
        let position = line.define(Quantity::NextPosition).by(argument(Quantity::Position) + step * rate);
        positions.push((Name::scalar(Quantity::NextPosition, joint + 1), position));
        rates.push((Name::scalar(Quantity::NextRate, joint + 1), rate));
    }
    [positions, rates].concat()
}

/// Returns the pose, the velocity and the angular velocity of a floating base after a step, then the positions and the
/// velocities of the joints. `accelerations` are those of the base, less gravity, then those of the coordinates.
pub(crate) fn floating_step<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    gravity: Vector<'s>,
    accelerations: &Outputs<'s>,
) -> Outputs<'s> {
    let (of_base, of_joints) = accelerations.split_at(6);
    let [linear, angular] = [0, 3].map(|from| Vector(from_fn(|axis| of_base[from + axis].1)));
    let [velocity, omega] = [Quantity::OriginVelocity, Quantity::Omega].map(|quantity| vector(builder, quantity, 0));
    let Frame { rotation, origin } = pose_of_base(builder);
    let (line, step) = (builder.joint(0), duration(builder));
    let moved = |x: Vector<'s>, change: Vector<'s>| x + change * step;
    let omega = line.define(Quantity::NextOmega).by(moved(omega, angular));
    let in_world = line.within(Quantity::NextOrigin, || moved(rotation * moved(velocity, linear), gravity));
    let origin = line.define(Quantity::NextOrigin).by(moved(origin, in_world));
    let rotation = line
        .define(Quantity::NextRotation)
        .by(next_to(builder, rotation * Turn::of(builder, omega * step).matrix(builder)));
    let velocity = line.define(Quantity::NextVelocity).by(rotation.transpose() * in_world);
    let mut outputs = Outputs::new();
    for (row, elements) in Axis::ALL.into_iter().zip(rotation.0) {
        let name = |column| Name::matrix(Quantity::NextRotation, 0, row, column);
        outputs.extend(Axis::ALL.into_iter().zip(elements.0).map(|(column, element)| (name(column), element)));
    }
    let parts = [(Quantity::NextOrigin, origin), (Quantity::NextVelocity, velocity), (Quantity::NextOmega, omega)];
    outputs.extend(parts.into_iter().flat_map(|(part, vector)| components(Name::scalar(part, 0), vector)));
    outputs.extend(self::step(builder, coordinates, of_joints));
    outputs
}

/// The rotation of a frame in a step, as a unit quaternion.
pub(crate) struct Turn<'s> {
    /// The vector u = h ω / 4.
    u: Vector<'s>,
    /// 1 / (1 + s), with s = u · u.
    inverse: Symbol<'s>,
    w: Symbol<'s>,
    vector: Vector<'s>,
}

impl<'s> Turn<'s> {
    /// Returns the rotation of a step; `angle` is h ω.
    pub(crate) fn of(builder: &'s Builder, angle: Vector<'s>) -> Self {
        let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
        let u = angle * builder.constant(0.25, Cause::Arithmetic);
        let inverse = builder.quotient(one, one + u.dot(u));
        let factor = inverse + inverse;
        Self { u, inverse, w: factor - one, vector: u * factor }
    }

    /// Returns the rotation matrix E.
    pub(crate) fn matrix(&self, builder: &'s Builder) -> Matrix<'s> {
        let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
        let (w, [x, y, z], [x2, y2, z2]) = (self.w, self.vector.0, (self.vector + self.vector).0);
        let ([xx, yy, zz], [xy, xz, yz], [wx, wy, wz]) =
            ([x2 * x, y2 * y, z2 * z], [x2 * y, x2 * z, y2 * z], [x2 * w, y2 * w, z2 * w]);
        Matrix::from_rows([
            [one - (yy + zz), xy - wz, xz + wy],
            [xy + wz, one - (xx + zz), yz - wx],
            [xz - wy, yz + wx, one - (xx + yy)],
        ])
    }

    /// Returns the derivative of the rotation with respect to ω, in the axes after the step: h / (1 + s) times the
    /// rotation by half the angle of E in the opposite direction.
    pub(crate) fn by_rate(&self, step: Symbol<'s>) -> Matrix<'s> {
        let (scale, [u, v]) = (self.inverse * step, [self.u, self.vector]);
        let (w, [x, y, z]) = (self.w * scale, (v * scale).0);
        let ([xx, yy, zz], [xy, xz, yz]) = ([x * u.0[0], y * u.0[1], z * u.0[2]], [x * u.0[1], x * u.0[2], y * u.0[2]]);
        Matrix::from_rows([[w + xx, xy + z, xz - y], [xy - z, w + yy, yz + x], [xz + y, yz - x, w + zz]])
    }
}

/// Returns the rotation nearest to a matrix that is a rotation but for rounding errors.
fn next_to<'s>(builder: &'s Builder, near: Matrix<'s>) -> Matrix<'s> {
    let half = builder.entry(Name::scalar(Quantity::Half, 0), 0.5);
    let on_diagonal = builder.constant(1.5, Cause::Arithmetic);
    let columns = near.transpose().0;
    let element = |row: usize, column: usize| {
        let product = columns[row.min(column)].dot(columns[row.max(column)]) * half;
        if row == column { on_diagonal - product } else { -product }
    };
    near * Matrix::from_rows(from_fn(|row| from_fn(|column| element(row, column))))
}

/// Returns the derivatives of the next positions with respect to q, q̇ and τ, then those of the next velocities.
/// `by_state` are the derivatives of h q̈ with respect to q and q̇; `by_torques` are those with respect to τ, which are
/// named and symmetric. All are by rows.
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
    // the derivative of x + change, where x is the argument `own`: on the diagonal, 1 is added
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
