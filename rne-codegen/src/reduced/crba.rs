//! The mass matrix by composite bodies: everything behind a joint as one body, from tip to base.
//!
//! ```text
//! P_i = own matter of link i + P_{i+1}, turned and moved into its frame;   P = [S h; hᵀ m]
//! column j, on its axis in frame N_j:   f = (-h_y, h_x, 0)   n = (-S13, -S23, S11 + S22)
//!                                       (prismatic: f = m u, n = h × u)
//! M_jj = n_z;   M_ij = n_z of the same wrench, turned and moved to joint i < j
//! ```
//!
//! After R. Featherstone, "Rigid Body Dynamics Algorithms" (2008), section 6.2, over regrouped matter. Turns are made
//! in two steps, about the joint's axis and about the twist; in frame N, between the two, a column costs nothing to
//! begin with.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::reduced::arguments::SymbolicTurn;
use crate::reduced::backward::Wrench;
use crate::reduced::forward::Arm;
use crate::reduced::link_parameters::PseudoInertia;
use crate::reduced::regrouping::{group_start, is_parallel};

use crate::ir::name::{By, Name};
use crate::ir::quantity::Axis::{self, X, Y, Z};
use crate::ir::quantity::Quantity;
use crate::ir::{Builder, Number, Symbol, Vector};

/// Whether bodies behind parallel axes are gathered in the frame N of the first of these axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gathering {
    /// Joint by joint.
    Joints,
    /// Per group of parallel axes.
    Groups,
}

/// The matter of all links from one on. Its mass is a number.
#[derive(Clone, Copy)]
pub(crate) struct Composite<'s> {
    mass: Number,
    h: Vector<'s>,
    /// S11, S22, S33, S12, S13, S23
    s: [Symbol<'s>; 6],
    /// S11 + S22, which a turn about z leaves alone, where it has been turned so.
    around: Option<Symbol<'s>>,
}

/// Rz S Rzᵀ of a symmetric matrix: xx, yy, zz, xy, xz, yz.
pub(crate) fn turned_about_z<'s>(matrix: [Symbol<'s>; 6], turn: SymbolicTurn<'s>) -> [Symbol<'s>; 6] {
    let SymbolicTurn { s: sine, c: cosine } = turn;
    let [xx, yy, zz, xy, xz, yz] = matrix;
    let difference = xx - yy;
    let twice = xy + xy;
    let (both, square) = (cosine * sine, cosine * cosine);
    let u = square * difference - both * twice;
    let turned_xy = both * difference + (square * twice - xy);
    [u + yy, xx - u, zz, turned_xy, cosine * xz - sine * yz, sine * xz + cosine * yz]
}

/// Rx S Rxᵀ: the same with y, z, x in the places of x, y, z.
pub(crate) fn turned_about_x<'s>(matrix: [Symbol<'s>; 6], turn: SymbolicTurn<'s>) -> [Symbol<'s>; 6] {
    let [xx, yy, zz, xy, xz, yz] = matrix;
    let [yy, zz, xx, yz, xy, xz] = turned_about_z([yy, zz, xx, yz, xy, xz], turn);
    [xx, yy, zz, xy, xz, yz]
}

impl<'s> Composite<'s> {
    pub(crate) fn of(builder: &'s Builder, matter: &PseudoInertia) -> Self {
        let s = matter.s;
        let s = [s[0][0], s[1][1], s[2][2], s[0][1], s[0][2], s[1][2]].map(|x| builder.number(x));
        Self { mass: matter.mass, h: builder.vector(matter.h), s, around: None }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            h: self.h + other.h,
            s: std::array::from_fn(|k| self.s[k] + other.s[k]),
            around: (self.around.is_some() || other.around.is_some()).then(|| self.around() + other.around()),
        }
    }

    /// Names what is there, in frame N of a joint.
    pub(crate) fn name(&self, builder: &'s Builder, joint: usize) {
        builder.name_vector(Quantity::CompositeFirstMoment, joint, self.h);
        let elements = [(X, X), (Y, Y), (Z, Z), (X, Y), (X, Z), (Y, Z)];
        for ((row, column), element) in elements.into_iter().zip(self.s) {
            builder.name(Name::matrix(Quantity::CompositeSecondMoment, joint, row, column), element);
        }
    }

    /// S11 + S22: the inertia about z.
    pub(crate) fn around(&self) -> Symbol<'s> {
        self.around.unwrap_or_else(|| self.s[0] + self.s[1])
    }

    /// Rz P Rzᵀ
    pub(crate) fn about_z(self, turn: SymbolicTurn<'s>) -> Self {
        Self { mass: self.mass, h: turn.about_z(self.h), s: turned_about_z(self.s, turn), around: Some(self.around()) }
    }

    /// Rx P Rxᵀ
    pub(crate) fn about_x(self, turn: SymbolicTurn<'s>) -> Self {
        Self { mass: self.mass, h: turn.about_x(self.h), s: turned_about_x(self.s, turn), around: None }
    }

    /// The same matter about a point from which the old one is at t.
    pub(crate) fn moved(self, t: Vector<'s>, builder: &'s Builder) -> Self {
        let ([hx, hy, hz], [x, y, z]) = (self.h.0, t.0);
        let m = builder.number(self.mass);
        let [xx, yy, zz, xy, xz, yz] = self.s;
        let ([mx, my, mz], twice) = ([x * m, y * m, z * m], |a: Symbol<'s>| a + a);
        let (dx, dy) = (x * (twice(hx) + mx), y * (twice(hy) + my));
        Self {
            mass: self.mass,
            h: Vector([hx + mx, hy + my, hz + mz]),
            around: self.around.map(|around| around + (dx + dy)),
            s: [
                xx + dx,
                yy + dy,
                zz + z * (twice(hz) + mz),
                xy + (x * hy + y * (hx + mx)),
                xz + (x * hz + z * (hx + mx)),
                yz + (y * hz + z * (hy + my)),
            ],
        }
    }

    /// What gives its points the accelerations b + e × r.
    pub(crate) fn carried(&self, builder: &'s Builder, e: Vector<'s>, b: Vector<'s>) -> Wrench<'s> {
        let ([xx, yy, zz, xy, xz, yz], [x, y, z]) = (self.s, e.0);
        // J = tr(S) 1 - S
        let momentum = Vector([
            (yy + zz) * x - (xy * y + xz * z),
            (xx + zz) * y - (xy * x + yz * z),
            self.around() * z - (xz * x + yz * y),
        ]);
        Wrench { force: b * builder.number(self.mass) + e.cross(self.h), moment: momentum + self.h.cross(b) }
    }

    /// What accelerates it about the z axis with 1 rad/s².
    pub(crate) fn turning(&self, builder: &'s Builder) -> Wrench<'s> {
        let ([hx, hy, _], [_, _, _, _, xz, yz]) = (self.h.0, self.s);
        Wrench { force: Vector([-hy, hx, builder.zero()]), moment: Vector([-xz, -yz, self.around()]) }
    }

    /// What accelerates it along u with 1 m/s².
    pub(crate) fn sliding(&self, u: Vector<'s>, builder: &'s Builder) -> Wrench<'s> {
        Wrench { force: u * builder.number(self.mass), moment: self.h.cross(u) }
    }
}

/// What link i carries: its composite body and the columns of the joints from there on, about the origin of its frame,
/// in its axes or in the frame N of its group.
struct Carried<'s> {
    composite: Option<Composite<'s>>,
    columns: Vec<(usize, Wrench<'s>)>,
    unturned: bool,
}

impl<'s> Carried<'s> {
    fn map(
        self,
        unturned: bool,
        composite: impl Fn(Composite<'s>) -> Composite<'s>,
        wrench: impl Fn(Wrench<'s>) -> Wrench<'s>,
    ) -> Self {
        Self {
            composite: self.composite.map(composite),
            columns: self.columns.into_iter().map(|(column, one)| (column, wrench(one))).collect(),
            unturned,
        }
    }

    fn name(&self, builder: &'s Builder, joint: usize) {
        if let Some(composite) = &self.composite {
            composite.name(builder, joint);
        }
        for (column, Wrench { force, moment }) in &self.columns {
            for (axis, (f, n)) in Axis::ALL.into_iter().zip(force.0.into_iter().zip(moment.0)) {
                let by = Some(By::RateDot(column + 1));
                builder.name(Name { by, ..Name::vector(Quantity::UnitForce, joint, axis) }, f);
                builder.name(Name { by, ..Name::vector(Quantity::UnitMoment, joint, axis) }, n);
            }
        }
    }

    fn turned_about_z(self, turn: SymbolicTurn<'s>, unturned: bool) -> Self {
        self.map(unturned, |body| body.about_z(turn), |wrench| wrench.map(|v| turn.about_z(v)))
    }

    fn turned_about_x(self, turn: SymbolicTurn<'s>) -> Self {
        self.map(false, |body| body.about_x(turn), |wrench| wrench.map(|v| turn.about_x(v)))
    }

    fn moved(self, t: Vector<'s>, builder: &'s Builder) -> Self {
        let unturned = self.unturned;
        self.map(unturned, |body| body.moved(t, builder), |wrench| wrench.about(t))
    }
}

/// The upper half of M: row i holds its elements (i, i) to (i, n).
pub(crate) fn mass_matrix<'s>(builder: &'s Builder, arm: &Arm<'_>, gathering: Gathering) -> Vec<Vec<Symbol<'s>>> {
    let rows = arm.rows();
    let dof = rows.len();
    let mut matrix: Vec<Vec<Symbol<'s>>> = vec![vec![builder.zero(); dof]; dof];
    let mut carried = Carried { composite: None, columns: Vec::new(), unturned: false };
    for index in (0..dof).rev() {
        let row = &rows[index];
        builder.at(Quantity::ReducedForce, index + 1);
        let (offset, d) = arm.lengths(index, Number::ONE);
        let twist = builder.fixed_turn(row.alpha);
        if arm.is_spin(index) {
            let c = builder.number(arm.parameters.sphere.unwrap_or_default());
            matrix[index][index] = c;
            let moment = twist.about_x(Vector([builder.zero(), builder.zero(), c]));
            carried.columns.push((index, Wrench { force: builder.no_vector(), moment }));
            continue;
        }
        let own = Composite::of(builder, &arm.parameters.links[index]);
        let parallel = is_parallel(rows, index);
        match row.kind {
            Revolute => {
                let grouped = parallel && gathering == Gathering::Groups;
                let start = if grouped { group_start(rows, index) } else { index };
                let turn = builder.turn(rows, start, index);
                for (column, wrench) in &carried.columns {
                    matrix[index][*column] = wrench.moment.0[2];
                }
                let (own_unturned, rest) = if carried.unturned {
                    (own.about_z(turn), carried)
                } else {
                    let whole = carried.composite.map_or(own, |behind| own.plus(behind));
                    let rest = carried.map(false, |body| body, |wrench| wrench);
                    let rest = Carried { composite: None, ..rest }.turned_about_z(turn, true);
                    (whole.about_z(turn), rest)
                };
                let whole = rest.composite.map_or(own_unturned, |behind| own_unturned.plus(behind));
                let column = whole.turning(builder);
                matrix[index][index] = column.moment.0[2];
                let mut next = Carried { composite: Some(whole), columns: rest.columns, unturned: true };
                next.columns.push((index, column));
                next.name(builder, index + 1);
                let along = |x: Number| Vector([builder.zero(), builder.zero(), builder.number(x)]);
                carried = if index == 0 {
                    next
                } else if grouped {
                    // the frame of the group goes on, but for its origin
                    let before = builder.turn(rows, start, index - 1);
                    next.moved(before.about_z(builder.vector(offset)) + along(d), builder)
                } else {
                    next.moved(along(d), builder).turned_about_x(twist).moved(builder.vector(offset), builder)
                };
            }
            Prismatic => {
                let u = builder.vector(row.axis);
                for (column, wrench) in &carried.columns {
                    matrix[index][*column] = u.dot(wrench.force);
                }
                let whole = carried.composite.map_or(own, |behind| own.plus(behind));
                let column = whole.sliding(u, builder);
                matrix[index][index] = u.dot(column.force);
                let mut next = Carried { composite: Some(whole), columns: carried.columns, unturned: false };
                next.columns.push((index, column));
                let q = builder.position(rows, index) + builder.number(d);
                let next = next.moved(u * q, builder);
                let next = if row.carried {
                    next
                } else {
                    next.turned_about_z(builder.fixed_turn(row.theta), false).turned_about_x(twist)
                };
                carried = next.moved(builder.vector(offset), builder);
            }
        }
    }
    (0..dof)
        .map(|row| {
            (row..dof)
                .map(|column| {
                    let element = matrix[row][column];
                    let element = if rows[row].reversed == rows[column].reversed { element } else { -element };
                    let by = Some(By::RateDot(column + 1));
                    builder.name(Name { by, ..Name::scalar(Quantity::Torque, row + 1) }, element);
                    element
                })
                .collect()
        })
        .collect()
}

/// Torques against gravity, by the first moments of the composite bodies alone: τ = (h × a)_z.
pub(crate) fn gravity_torques<'s>(builder: &'s Builder, arm: &Arm<'_>, gathering: Gathering) -> Vec<Symbol<'s>> {
    let rows = arm.rows();
    let dof = rows.len();
    // acceleration of the base in the frame N of each joint, or of its group
    let mut fields: Vec<Vector<'s>> = Vec::with_capacity(dof);
    let mut own = builder.vector(arm.table.gravity.map(|g| -g));
    for (index, row) in rows.iter().enumerate() {
        builder.at(Quantity::OriginAcceleration, index + 1);
        let twist = builder.fixed_turn(row.alpha);
        let grouped = is_parallel(rows, index) && gathering == Gathering::Groups;
        let field = match fields.last() {
            Some(field) if grouped => *field,
            _ => twist.back_about_x(own),
        };
        own = match row.kind {
            Revolute => {
                let start = if grouped { group_start(rows, index) } else { index };
                builder.turn(rows, start, index).back_about_z(field)
            }
            Prismatic if row.carried => own,
            Prismatic => builder.fixed_turn(row.theta).back_about_z(field),
        };
        fields.push(if row.kind == Revolute { field } else { own });
    }
    let zero = builder.zero();
    let mut torques = vec![zero; dof];
    // first moment of what is behind, in the axes of link i or in its frame N
    let (mut h, mut mass, mut unturned) = (builder.no_vector(), Number::ZERO, false);
    for index in (0..dof).rev() {
        let row = &rows[index];
        builder.at(Quantity::ReducedMoment, index + 1);
        if arm.is_spin(index) {
            continue;
        }
        let matter = &arm.parameters.links[index];
        mass = mass + matter.mass;
        let (offset, d) = arm.lengths(index, Number::ONE);
        let twist = builder.fixed_turn(row.alpha);
        let own = builder.vector(matter.h);
        let field = fields[index];
        let m = builder.number(mass);
        let torque = match row.kind {
            Revolute => {
                let grouped = is_parallel(rows, index) && gathering == Gathering::Groups;
                let start = if grouped { group_start(rows, index) } else { index };
                let turn = builder.turn(rows, start, index);
                h = if unturned { h + turn.about_z(own) } else { turn.about_z(h + own) };
                let ([hx, hy, _], [ax, ay, _]) = (h.0, field.0);
                let torque = hx * ay - hy * ax;
                let along = Vector([zero, zero, builder.number(d)]);
                unturned = grouped;
                if grouped {
                    let before = builder.turn(rows, start, index - 1);
                    h = h + (before.about_z(builder.vector(offset)) + along) * m;
                } else {
                    h = twist.about_x(h + along * m) + builder.vector(offset) * m;
                }
                torque
            }
            Prismatic => {
                let u = builder.vector(row.axis);
                let torque = u.dot(field) * m;
                let q = builder.position(rows, index) + builder.number(d);
                h = h + own + u * (q * m);
                if !row.carried {
                    h = twist.about_x(builder.fixed_turn(row.theta).about_z(h));
                }
                h = h + builder.vector(offset) * m;
                torque
            }
        };
        torques[index] = if row.reversed { -torque } else { torque };
        builder.name(Name::scalar(Quantity::Torque, index + 1), torques[index]);
    }
    torques
}
