//! M(q) by columns: the torques of the seven steps for q̈ = e_j, of an arm at rest and without gravity. For a floating
//! base, M also has the wrenches on the base as rows, and six columns for the base's accelerations.

use crate::coordinates::{Coordinates, scaled};
use crate::formulate::ldlt::System;
use crate::formulate::{Arm, AtTip, JointState, Motion, Wrench, seven_steps};
use crate::ir::{Axis, Builder, Cause, Quantity, Symbol, Vector, WithRespectTo};

/// Returns the upper half of M, of an arm with the load `tip` at its tip: row i has the elements (i, i) to (i, n).
/// Element (i, j) is the torque of joint i for q̈ = e_j, named `taui_qddj`.
///
/// The lower half is a copy of it, so that M is exactly symmetric.
pub(crate) fn upper_half<'s>(arm: &Arm<'s>, states: &[JointState<'s>], tip: &AtTip<'s>) -> Vec<Vec<Symbol<'s>>> {
    let builder = arm.builder;
    let base = Motion::of_fixed_base(builder, builder.zeros(Cause::NoGravity));
    of_joints(arm, &at_rest(arm, states), &base, tip).0
}

/// Returns the joints at their positions, with zero rates and accelerations.
fn at_rest<'s>(arm: &Arm<'s>, states: &[JointState<'s>]) -> Vec<JointState<'s>> {
    let (rest, zero) = (arm.builder.constant(0.0, Cause::AtRest), arm.builder.constant(0.0, Cause::UnitAcceleration));
    states.iter().map(|state| JointState { qd: rest, qdd: zero, ..*state }).collect()
}

/// Returns the upper half of M of the joints, and for each column the wrench on a floating base, if there is one.
#[allow(clippy::type_complexity)] // a tuple of rows and of wrenches
fn of_joints<'s>(
    arm: &Arm<'s>,
    still: &[JointState<'s>],
    base: &Motion<'s>,
    tip: &AtTip<'s>,
) -> (Vec<Vec<Symbol<'s>>>, Vec<Option<Wrench<'s>>>) {
    let (builder, dof) = (arm.builder, still.len());
    let one = builder.constant(1.0, Cause::UnitAcceleration);
    // the rotations are the same for each column, so they are written once, here
    seven_steps::forward(arm, still, base);
    let mut rows: Vec<Vec<_>> = vec![Vec::new(); dof];
    let column = |column: usize| {
        let mut moved = still.to_vec();
        moved[column].qdd = one;
        let (on_base, loads) = builder.by(Some(WithRespectTo::RateDot(column + 1)), || {
            seven_steps::inverse_dynamics_of_floating_base(arm, &moved, base, tip)
        });
        for (row, load) in rows.iter_mut().zip(&loads).take(column + 1) {
            row.push(load.torque);
        }
        on_base
    };
    let on_base = (0..dof).map(column).collect();
    (rows, on_base)
}

/// The rows of a floating base in M, in axes of frame 0 and about its origin.
pub(crate) struct OfBase<'s> {
    pub(crate) mass: Symbol<'s>,
    /// The first moment of the whole robot.
    pub(crate) h: Vector<'s>,
    /// The inertia of the whole robot: xx, yy, zz, xy, xz, yz.
    pub(crate) inertia: [Symbol<'s>; 6],
    /// Force and moment on the base for a unit acceleration of each coordinate.
    pub(crate) columns: Vec<[Vector<'s>; 2]>,
}

impl<'s> OfBase<'s> {
    /// Converts `columns` from one column for each joint to one for each coordinate.
    pub(crate) fn gathered(self, coordinates: &Coordinates) -> Self {
        let plus = |a: [Vector<'s>; 2], b: [Vector<'s>; 2]| [a[0] + b[0], a[1] + b[1]];
        let times = |column: [Vector<'s>; 2], ratio| column.map(|part| part.map(|_, x| scaled(x, ratio)));
        Self { columns: coordinates.gathered(&self.columns, plus, times), ..self }
    }

    /// Returns the upper half of M of the whole robot: row i has its elements (i, i) to (i, 6 + n). `joints` is the
    /// upper half of the joint block.
    pub(crate) fn above(&self, builder: &'s Builder, joints: Vec<Vec<Symbol<'s>>>) -> Vec<Vec<Symbol<'s>>> {
        let columns: Vec<_> = (0..6 + self.columns.len()).map(|column| self.column(builder, column)).collect();
        let row = |row: usize| columns[row..].iter().map(|parts| parts[row / 3].0[row % 3]).collect();
        (0..6).map(row).chain(joints).collect()
    }

    /// Returns the force and moment on the base for a unit of one acceleration; `column` is the column of this
    /// acceleration in M.
    pub(crate) fn column(&self, builder: &'s Builder, column: usize) -> [Vector<'s>; 2] {
        let ([x, y, z], [xx, yy, zz, xy, xz, yz]) = (self.h.0, self.inertia);
        let (mass, zero) = (self.mass, builder.zero());
        let [force, moment] = match column {
            0 => [[mass, zero, zero], [zero, z, -y]],
            1 => [[zero, mass, zero], [-z, zero, x]],
            2 => [[zero, zero, mass], [y, -x, zero]],
            3 => [[zero, -z, y], [xx, xy, xz]],
            4 => [[z, zero, -x], [xy, yy, yz]],
            5 => [[-y, x, zero], [xz, yz, zz]],
            _ => return self.columns[column - 6],
        };
        [Vector(force), Vector(moment)]
    }
}

/// Returns the rows of a floating base, by joint, and the upper half of M of the joints, of a robot with the load
/// `tip`.
///
/// For the base's angular acceleration ω̇ = e_k the force is e_k × h and the moment J e_k.
pub(crate) fn with_base<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    system: &System<'_>,
    tip: &AtTip<'s>,
) -> (OfBase<'s>, Vec<Vec<Symbol<'s>>>) {
    let (builder, still) = (arm.builder, at_rest(arm, states));
    let (zeros, weightless) = (builder.zeros(Cause::UnitAcceleration), builder.zeros(Cause::NoGravity));
    let one = builder.constant(1.0, Cause::UnitAcceleration);
    let at_rest = builder.zeros(Cause::AtRest);
    let nothing = Wrench { force: zeros, moment: zeros };
    let base = Motion::of_base(arm, [at_rest, zeros, zeros], weightless);
    let (joints, on_base) = of_joints(arm, &still, &base, tip);
    let turning = |axis: Axis| {
        let mut omega_dot = zeros;
        omega_dot.0[axis as usize] = one;
        builder.by(Some(WithRespectTo::BaseRateDot(4 + axis as usize)), || {
            let base = Motion::of_base(arm, [at_rest, omega_dot, zeros], weightless);
            seven_steps::inverse_dynamics_of_floating_base(arm, &still, &base, tip).0.unwrap_or(nothing)
        })
    };
    let [x, y, z] = Axis::ALL.map(turning);
    let line = builder.joint(0);
    let of_base = arm.floating_base.as_ref().map_or_else(|| builder.zero(), |base| base.mass);
    let mass = builder.by(Some(WithRespectTo::BaseRateDot(1)), || {
        line.within(Quantity::BaseForce, || {
            let of_links = arm.links.iter().fold(of_base, |mass, link| mass + link.body.mass);
            if let AtTip::Payload(payload) = tip { of_links + payload.mass } else { of_links }
        })
    });
    let mass = builder.name(system.name_of_element(0, 0), mass);
    let h = Vector([-y.force.0[2], -z.force.0[0], y.force.0[0]]);
    let ([xx, ..], [xy, yy, _], [xz, yz, zz]) = (x.moment.0, y.moment.0, z.moment.0);
    let columns = on_base.into_iter().map(|wrench| wrench.unwrap_or(nothing)).map(|it| [it.force, it.moment]).collect();
    (OfBase { mass, h, inertia: [xx, yy, zz, xy, xz, yz], columns }, joints)
}
