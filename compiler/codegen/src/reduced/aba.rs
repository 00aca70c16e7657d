//! Forward dynamics by articulated bodies: for each joint, the inertia with which its link and all links after it
//! resist acceleration while the joints after it are free to move.
//!
//! ```text
//! n = A ω̇ + B a + n°,   f = Bᵀ ω̇ + C a + f°             about the joint's origin; rigid: A = J, B = [h]×, C = m 1
//! joint:   U = (A z, Bᵀ z),  D = z·A z,  u = τ - z·n°      (prismatic: U = (B u, C u), D = u·C u, u = τ - u·f°)
//!          A, B, C less U Uᵀ/D;   (n°, f°) plus what the velocities do to these, plus U u/D
//! moved:   B' = B + [p]× C,  A' = A - B' [p]× + [p]× Bᵀ
//! outward: q̈ = (u - U · (ω̇' + q̇ ω' × z, a'))/D
//! a floating base:   A ω̇ + B a = -n°,   Bᵀ ω̇ + C a = -f°
//! ```
//!
//! After R. Featherstone, "Rigid Body Dynamics Algorithms" (2008), chapter 7, but with accelerations of points instead
//! of spatial accelerations, and with regrouped inertial parameters: D is a pivot of M, which regrouping does not
//! change.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::coordinates::Coordinates;
use crate::formulate::ldlt::{self, System};
use crate::ir::{Builder, ExactAngle, Number, Quantity, Symbol, Vector, square};
use crate::reduced::backward::{antisymmetric_of, tip_wrenches};
use crate::reduced::forward::motion_of_base;
use crate::reduced::inward::full;
use crate::reduced::joint_motion::stations;
use crate::reduced::rnea_derivatives::matter;
use crate::reduced::{
    Arm, Composite, Gradient, Inward, JointMotion, Outward, SymbolicTurn, Symmetric, Turned, Twist, Wrench,
};

type Square<'s> = [[Symbol<'s>; 3]; 3];

/// The articulated inertia of a joint's link and of all links after it, with the bias wrench.
#[derive(Clone, Copy)]
struct Articulated<'s> {
    angular: Symmetric<'s>,
    mixed: Square<'s>,
    linear: Symmetric<'s>,
    bias: Wrench<'s>,
}

/// The numbers of a joint that the outward pass uses again.
#[derive(Clone, Copy)]
struct Pivot<'s> {
    /// U = (A z, Bᵀ z), or (B u, C u) for a prismatic joint: angular and linear part.
    resistance: [Vector<'s>; 2],
    /// The terms of ω̇ and a that depend on velocities only.
    drift: [Vector<'s>; 2],
    inverse: Symbol<'s>,
    rest: Symbol<'s>,
}

fn of<'s>(matrix: &Square<'s>, v: Vector<'s>) -> Vector<'s> {
    Vector(matrix.map(|row| Vector(row).dot(v)))
}

fn transposed<'s>(matrix: &Square<'s>) -> Square<'s> {
    square(|i, j| matrix[j][i])
}

/// Returns the matrix minus a sᵀ, where s is `scaled`, a times a factor.
fn less<'s>(matrix: Symmetric<'s>, a: Vector<'s>, scaled: Vector<'s>) -> Symmetric<'s> {
    let ([x, y, z], [sx, sy, sz]) = (a.0, scaled.0);
    let [xx, yy, zz, xy, xz, yz] = matrix;
    [xx - x * sx, yy - y * sy, zz - z * sz, xy - x * sy, xz - x * sz, yz - y * sz]
}

impl<'s> Articulated<'s> {
    fn plus(self, other: Self) -> Self {
        Self {
            angular: std::array::from_fn(|k| self.angular[k] + other.angular[k]),
            mixed: square(|i, j| self.mixed[i][j] + other.mixed[i][j]),
            linear: std::array::from_fn(|k| self.linear[k] + other.linear[k]),
            bias: self.bias.plus(other.bias),
        }
    }

    /// Adds the articulated inertias of other bodies, which are given in the same axes.
    fn with(self, others: impl Iterator<Item = Self>) -> Self {
        others.fold(self, Self::plus)
    }

    fn turned(self, turn: Turned<'s>) -> Self {
        let rows = self.mixed.map(|row| turn.of(Vector(row)).0);
        let columns = transposed(&rows).map(|column| turn.of(Vector(column)).0);
        Self {
            angular: turn.of_symmetric(self.angular),
            mixed: transposed(&columns),
            linear: turn.of_symmetric(self.linear),
            bias: self.bias.turned(turn),
        }
    }

    /// Returns the inertia about another point, from which the old reference point is at p; the link has the angular
    /// velocity ω.
    fn moved(self, p: Vector<'s>, omega: Vector<'s>) -> Self {
        let linear = full(self.linear);
        let columns = transposed(&linear).map(|column| p.cross(Vector(column)).0);
        let shift = transposed(&columns);
        let mixed = square(|i, j| self.mixed[i][j] + shift[i][j]);
        // -B' [p]× is computed row by row: row b of B' becomes p × b; [p]× Bᵀ column by column: column c of Bᵀ becomes
        // p × c
        let first = mixed.map(|row| p.cross(Vector(row)).0);
        let second = transposed(&self.mixed.map(|row| p.cross(Vector(row)).0));
        let sum = |i: usize, j: usize| first[i][j] + second[i][j];
        let [xx, yy, zz, xy, xz, yz] = self.angular;
        let drift = omega.cross(omega.cross(p));
        let force = self.bias.force + of(&linear, drift);
        let moment = self.bias.moment + of(&self.mixed, drift) + p.cross(force);
        Self {
            angular: [xx + sum(0, 0), yy + sum(1, 1), zz + sum(2, 2), xy + sum(0, 1), xz + sum(0, 2), yz + sum(1, 2)],
            mixed,
            linear: self.linear,
            bias: Wrench { force, moment },
        }
    }

    /// Returns the inertia as it is before the joint, which is free to move, with the numbers that the outward pass
    /// needs.
    fn released(self, arm: &Arm<'_, 's>, index: usize, station: &JointMotion<'s>) -> (Self, Pivot<'s>) {
        let builder = arm.builder;
        let row = &arm.rows()[index];
        let rate = arm.rate(index);
        let torque = arm.joint_frames.coordinates.applied(builder, index);
        let torque = if row.reversed { -torque } else { torque };
        let zeros = builder.no_vector();
        let omega = station.before.omega;
        let (angular, linear) = (full(self.angular), full(self.linear));
        let (resistance, pivot, rest, drift) = match row.kind {
            Revolute => {
                let [wx, wy, _] = omega.0;
                let drift = Vector([rate * wy, -(rate * wx), builder.zero()]);
                let resistance = [Vector(angular[2]), Vector(self.mixed[2])];
                (resistance, angular[2][2], torque - self.bias.moment.0[2], [drift, zeros])
            }
            Prismatic => {
                let u = builder.vector(row.axis);
                let resistance = [of(&self.mixed, u), of(&linear, u)];
                let drift = omega.cross(u * rate.times(Number::integer(2)));
                (resistance, u.dot(resistance[1]), torque - u.dot(self.bias.force), [zeros, drift])
            }
        };
        let inverse = pivot.inverse();
        let scaled = resistance.map(|v| v * inverse);
        let mixed = square(|i, j| self.mixed[i][j] - resistance[0].0[i] * scaled[1].0[j]);
        let given = Self {
            angular: less(self.angular, resistance[0], scaled[0]),
            mixed,
            linear: less(self.linear, resistance[1], scaled[1]),
            bias: self.bias,
        };
        let moment = of(&full(given.angular), drift[0]) + of(&mixed, drift[1]) + scaled[0] * rest;
        let force = of(&transposed(&mixed), drift[0]) + of(&full(given.linear), drift[1]) + scaled[1] * rest;
        let bias = self.bias.plus(Wrench { force, moment });
        (Self { bias, ..given }, Pivot { resistance, drift, inverse, rest })
    }
}

/// Returns the inertia of one rigid body, with the angular velocity ω and the wrench that it exerts at its tips.
fn rigid<'s>(
    builder: &'s Builder,
    body: &Composite<'s>,
    omega: Vector<'s>,
    at_tips: Option<Wrench<'s>>,
) -> Articulated<'s> {
    let Composite { mass: m, h, s, .. } = *body;
    let (s, zero) = (full(s), builder.zero());
    let [x, y, z] = h.0;
    let gradient = Gradient::new(omega, builder.no_vector());
    Articulated {
        // the inertia J = tr(S) 1 - S, from the second moments S
        angular: [s[1][1] + s[2][2], s[0][0] + s[2][2], s[0][0] + s[1][1], -s[0][1], -s[0][2], -s[1][2]],
        mixed: [[zero, -z, y], [z, zero, -x], [-y, x, zero]],
        linear: [m, m, m, zero, zero, zero],
        bias: at_tips
            .into_iter()
            .fold(Wrench { force: gradient.of(h), moment: antisymmetric_of(&gradient, &s) }, Wrench::plus),
    }
}

/// Returns the acceleration of a floating base, given the articulated inertia of the whole robot.
fn of_base<'s>(arm: &Arm<'_, 's>, omega: Vector<'s>, whole: &Articulated<'s>) -> Accelerated<'s> {
    let builder = arm.builder;
    let [xx, yy, zz, xy, xz, yz] = whole.linear;
    let [jxx, jyy, jzz, jxy, jxz, jyz] = whole.angular;
    let [x, y, z] = transposed(&whole.mixed);
    let upper = [
        [&[xx, xy, xz], &x[..]].concat(),
        [&[yy, yz], &y[..]].concat(),
        [&[zz], &z[..]].concat(),
        vec![jxx, jxy, jxz],
        vec![jyy, jyz],
        vec![jzz],
    ];
    let coordinates = Coordinates::of_free_joints(0);
    let system = System::new(builder.function, &coordinates, std::iter::empty());
    let needed = whole.bias.force.0.into_iter().chain(whole.bias.moment.0);
    let rest: Vec<_> = needed.map(|x| -x).collect();
    let x = ldlt::solved(builder, &system, &upper, &rest);
    let part = |from: usize| Vector([0, 1, 2].map(|axis| x[from + axis]));
    Accelerated { omega, omega_dot: part(3), acceleration: part(0) }
}

/// Returns the linear and angular acceleration of a floating base, if there is one, and the accelerations of the
/// joints.
pub(crate) fn forward_dynamics<'s>(arm: &Arm<'_, 's>) -> (Option<[Vector<'s>; 2]>, Vec<Symbol<'s>>) {
    let (builder, rows) = (arm.builder, arm.rows());
    let dof = rows.len();
    let (stations, floating) =
        (stations(arm, Number::ONE), arm.joint_frames.base.as_ref().map(|_| motion_of_base(arm)));
    let tips = tip_wrenches(arm, |_| Number::ONE);
    let grouped = |index: usize| arm.is_grouped(index);
    let mut pivots = Vec::with_capacity(dof);
    // inertias that each link carries: in the axes of that link, or in frame N of its group if the joint's axis is
    // parallel
    let mut behind: Vec<(usize, Articulated<'s>)> = Vec::with_capacity(dof);
    for index in (0..dof).rev() {
        builder.at(Quantity::ReducedForce, index + 1);
        let (row, station) = (&rows[index], &stations[index]);
        let (offset, d) = arm.lengths(index, Number::ONE);
        let (offset, twist) = (builder.vector(offset), Twist::new(builder, row));
        let turn = Turned::AboutZ(station.turn);
        let carried = |unturned: bool| {
            let behind =
                behind.iter().filter(move |(of, _)| rows[*of].parent == Some(index) && grouped(*of) == unturned);
            behind.map(|(_, body)| *body)
        };
        let at_tips = tips.iter().filter(|(on, _)| *on == index).map(|(_, wrench)| *wrench).reduce(Wrench::plus);
        let body = Composite::of_link(arm, index, &matter(arm, Some(index)));
        let own = rigid(builder, &body, station.own.omega, at_tips).with(carried(false));
        let here = if row.kind == Revolute { own.turned(turn).with(carried(true)) } else { own };
        let (given, pivot) = here.released(arm, index, station);
        pivots.push(pivot);
        // `given` is about this joint's origin; it is moved to the origin of the parent's frame
        let omega = station.before.omega;
        let (parent_turn, parent_omega) = match (row.parent, floating) {
            (Some(parent), _) => (stations[parent].turn, stations[parent].own.omega),
            (None, Some(base)) => (builder.fixed_turn(ExactAngle::NONE), base.omega),
            (None, None) => continue,
        };
        let moved = match row.kind {
            Revolute if grouped(index) => given.moved(parent_turn.about_z(offset) + builder.along_z(d), omega),
            Revolute => {
                let given = twist.turns().fold(given.moved(builder.along_z(d), omega), Articulated::turned);
                given.moved(offset, parent_omega)
            }
            Prismatic => {
                let q = arm.position(index) + builder.number(d);
                let given = given.moved(builder.vector(row.axis) * q, omega);
                let given = if row.carried {
                    given
                } else {
                    let given = given.turned(Turned::AboutZ(builder.fixed_turn(row.theta)));
                    twist.turns().fold(given, Articulated::turned)
                };
                given.moved(offset, parent_omega)
            }
        };
        behind.push((index, moved));
    }
    pivots.reverse();
    let base = floating.map(|base| {
        builder.at(Quantity::ReducedForce, 0);
        let body = Composite::of_matter(builder, &matter(arm, None));
        let carried = behind.iter().filter(|(of, _)| rows[*of].parent.is_none()).map(|(_, body)| *body);
        of_base(arm, base.omega, &rigid(builder, &body, base.omega, None).with(carried))
    });
    (base.map(|base| [base.acceleration, base.omega_dot]), outward(arm, base, &stations, &pivots))
}

/// The angular velocity and the accelerations of a link, in one frame.
#[derive(Clone, Copy)]
struct Accelerated<'s> {
    omega: Vector<'s>,
    omega_dot: Vector<'s>,
    acceleration: Vector<'s>,
}

/// The motion of a link in its axes and in frame N (not turned by the joint), with the rotation between both.
type Link<'s> = (Accelerated<'s>, Accelerated<'s>, SymbolicTurn<'s>);

impl<'s> Outward<'s> for Accelerated<'s> {
    fn turned_back(self, f: impl Fn(Vector<'s>) -> Vector<'s>) -> Self {
        Self { omega: f(self.omega), omega_dot: f(self.omega_dot), acceleration: f(self.acceleration) }
    }

    fn at(self, p: Vector<'s>) -> Self {
        let Self { omega, omega_dot, acceleration } = self;
        Self { acceleration: acceleration + omega_dot.cross(p) + omega.cross(omega.cross(p)), ..self }
    }
}

/// The outward pass: computes each joint's acceleration from that of its parent, or of a floating base.
fn outward<'s>(
    arm: &Arm<'_, 's>,
    floating: Option<Accelerated<'s>>,
    stations: &[JointMotion<'s>],
    pivots: &[Pivot<'s>],
) -> Vec<Symbol<'s>> {
    let (builder, rows) = (arm.builder, arm.rows());
    let zeros = builder.no_vector();
    let mut links: Vec<Link<'s>> = Vec::with_capacity(rows.len());
    let mut accelerations = Vec::with_capacity(rows.len());
    for (index, (row, (station, pivot))) in rows.iter().zip(stations.iter().zip(pivots)).enumerate() {
        builder.at(Quantity::OmegaDot, index + 1);
        let (last, last_unturned, last_turn) = if let Some(parent) = row.parent {
            links[parent]
        } else {
            let gravity = builder.vector(arm.joint_frames.gravity[index].map(|g| -g));
            let held = Accelerated { omega: zeros, omega_dot: zeros, acceleration: gravity };
            let base = floating.unwrap_or(held);
            (base, base, builder.fixed_turn(ExactAngle::NONE))
        };
        let before = arm.outward(index, last, last_unturned, last_turn);
        let (angular, linear) = (before.omega_dot + pivot.drift[0], before.acceleration + pivot.drift[1]);
        // U · (ω̇' + drift, a' + drift): `rest` has no drift yet, because the drift was added only to the bias of the
        // links before
        let resisted = pivot.resistance[0].dot(angular) + pivot.resistance[1].dot(linear);
        let own = (pivot.rest - resisted) * pivot.inverse;
        accelerations.push(if row.reversed { -own } else { own });
        let turn = station.turn;
        let omega = station.own.omega;
        links.push(match row.kind {
            Revolute => {
                let unturned = Accelerated {
                    omega: before.omega.plus_z(arm.rate(index)),
                    omega_dot: angular.plus_z(own),
                    acceleration: linear,
                };
                (Accelerated { omega, ..unturned.turned_back(|v| turn.back_about_z(v)) }, unturned, turn)
            }
            Prismatic => {
                let acceleration = linear + builder.vector(row.axis) * own;
                let link = Accelerated { omega, omega_dot: angular, acceleration };
                (link, link, turn)
            }
        });
    }
    accelerations
}
