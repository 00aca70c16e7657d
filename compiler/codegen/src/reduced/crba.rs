//! The mass matrix by composite bodies: for each joint all links after it as one rigid body, from tip to base.
//!
//! ```text
//! P_i = moments of link i alone + P_{i+1}, turned and moved into its frame;   P = [S h; hᵀ m]
//! column j, on its axis in frame N_j:   f = (-h_y, h_x, 0)   n = (-S13, -S23, S11 + S22)
//!                                       (prismatic: f = m u, n = h × u)
//! M_jj = n_z;   M_ij = n_z of the same wrench, turned and moved to joint i < j
//! ```
//!
//! After R. Featherstone, "Rigid Body Dynamics Algorithms" (2008), section 6.2, with regrouped inertial parameters.
//! Rotations are done in two steps, about the joint's axis and about the twist. In frame N, between both steps, a new
//! column takes no products.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::mass_matrix::OfBase;
use crate::formulate::torque_by;
use crate::reduced::inward::{Carried, LoadOfLink, Loads};
use crate::reduced::{
    Arm, Body, Carrier, FirstMoment, Inward, JointFrame, PseudoInertia, Symmetric, Turned, Twist, Wrench,
};

pub(crate) use crate::reduced::inward::ExpressedIn;

use crate::ir::Axis::{self, X, Y, Z};
use crate::ir::{Builder, Name, Quantity, Symbol, Vector, WithRespectTo};

/// Mass, first and second moments of a link and all links after it.
#[derive(Clone, Copy)]
pub(crate) struct Composite<'s> {
    pub(crate) mass: Symbol<'s>,
    pub(crate) h: Vector<'s>,
    pub(crate) s: Symmetric<'s>,
    /// S11 + S22, if it is known from before a rotation about z, which does not change it.
    pub(crate) around: Option<Symbol<'s>>,
}

impl<'s> Composite<'s> {
    /// Returns the inertial parameters of a link, for the link of the tip with its payload.
    pub(crate) fn of_link(arm: &Arm<'_, 's>, index: usize, matter: &PseudoInertia) -> Self {
        let own = Self::of_matter(arm.builder, matter);
        arm.payload_on(index).map_or(own, |payload| own.plus(payload.matter(arm)))
    }

    pub(crate) fn of_matter(builder: &'s Builder, matter: &PseudoInertia) -> Self {
        let s = matter.second_moments().map(|x| builder.number(x));
        Self { mass: builder.number(matter.mass), h: builder.vector(matter.h), s, around: None }
    }

    /// Names these moments, which are in frame N of a joint.
    pub(crate) fn name(&self, builder: &'s Builder, joint: usize) {
        builder.name_vector(Quantity::CompositeFirstMoment, joint, self.h);
        let elements = [(X, X), (Y, Y), (Z, Z), (X, Y), (X, Z), (Y, Z)];
        for ((row, column), element) in elements.into_iter().zip(self.s) {
            builder.name(Name::matrix(Quantity::CompositeSecondMoment, joint, row, column), element);
        }
    }

    /// Returns S11 + S22, the inertia about z.
    pub(crate) fn around(&self) -> Symbol<'s> {
        self.around.unwrap_or_else(|| self.s[0] + self.s[1])
    }

    /// Returns the wrench that gives each point r of the body the acceleration b + e × r.
    pub(crate) fn carried(&self, e: Vector<'s>, b: Vector<'s>) -> Wrench<'s> {
        let ([xx, yy, zz, xy, xz, yz], [x, y, z]) = (self.s, e.0);
        // J e, with the inertia J = tr(S) 1 - S from the second moments S
        let momentum = Vector([
            (yy + zz) * x - (xy * y + xz * z),
            (xx + zz) * y - (xy * x + yz * z),
            self.around() * z - (xz * x + yz * y),
        ]);
        Wrench { force: b * self.mass + e.cross(self.h), moment: momentum + self.h.cross(b) }
    }

    /// Returns the wrench that accelerates the body about the z axis with 1 rad/s².
    pub(crate) fn turning(&self, builder: &'s Builder) -> Wrench<'s> {
        let ([hx, hy, _], [_, _, _, _, xz, yz]) = (self.h.0, self.s);
        Wrench { force: Vector([-hy, hx, builder.zero()]), moment: Vector([-xz, -yz, self.around()]) }
    }

    /// Returns the wrench that accelerates the body along u with 1 m/s².
    pub(crate) fn sliding(&self, u: Vector<'s>) -> Wrench<'s> {
        Wrench { force: u * self.mass, moment: self.h.cross(u) }
    }
}

impl<'s> Body<'s> for Composite<'s> {
    fn plus(self, other: Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            h: self.h + other.h,
            s: std::array::from_fn(|k| self.s[k] + other.s[k]),
            around: (self.around.is_some() || other.around.is_some()).then(|| self.around() + other.around()),
        }
    }
}

impl<'s> Inward<'s> for Composite<'s> {
    /// Rotates the moments: R P Rᵀ.
    fn turned(self, turn: Turned<'s>) -> Self {
        let (h, s) = (turn.of(self.h), turn.of_symmetric(self.s));
        let around = if let Turned::AboutZ(_) = turn { Some(self.around()) } else { None };
        Self { mass: self.mass, h, s, around }
    }

    /// Returns the moments about another point, from which the old one is at t.
    fn moved(self, t: Vector<'s>) -> Self {
        let ([hx, hy, hz], [x, y, z]) = (self.h.0, t.0);
        let m = self.mass;
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
}

/// The column of M of a joint: the joint, counted from 0, and the wrench for its unit acceleration.
pub(crate) type Column<'s> = (usize, Wrench<'s>);

impl<'s> Inward<'s> for Column<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        (self.0, self.1.turned(turn))
    }

    fn moved(self, t: Vector<'s>) -> Self {
        (self.0, self.1.about(t))
    }
}

/// Names the composite body and the columns, in frame N of a joint.
fn name<'s>(builder: &'s Builder, joint: usize, carried: &Carried<Composite<'s>, Column<'s>>) {
    if let Some(composite) = &carried.behind {
        composite.name(builder, joint);
    }
    for (column, Wrench { force, moment }) in &carried.columns {
        for (axis, (f, n)) in Axis::ALL.into_iter().zip(force.0.into_iter().zip(moment.0)) {
            let by = Some(WithRespectTo::RateDot(column + 1));
            builder.name(Name { by, ..Name::vector(Quantity::UnitForce, joint, axis) }, f);
            builder.name(Name { by, ..Name::vector(Quantity::UnitMoment, joint, axis) }, n);
        }
    }
}

/// Returns the upper half of M of the joints: row i has its elements (i, i) to (i, n). For a floating base, also
/// returns its rows; the base is the last body that is added.
#[allow(clippy::type_complexity)] // a tuple of both kinds of rows
pub(crate) fn mass_matrix<'s>(arm: &Arm<'_, 's>) -> (Vec<Vec<Symbol<'s>>>, Option<OfBase<'s>>) {
    let (builder, rows) = (arm.builder, arm.rows());
    let dof = rows.len();
    let mut matrix: Vec<Vec<Symbol<'s>>> = vec![vec![builder.zero(); dof]; dof];
    let mut loads: Loads<Composite<'s>, Column<'s>> = Loads::new();
    for index in (0..dof).rev() {
        let row = &rows[index];
        builder.at(Quantity::ReducedForce, index + 1);
        let twist = Twist::new(builder, row);
        if arm.is_spin(index) {
            let c = builder.number(arm.parameters.sphere.unwrap_or_default());
            matrix[index][index] = c;
            let moment = twist.of(Vector([builder.zero(), builder.zero(), c]));
            let column = (index, Wrench { force: builder.no_vector(), moment });
            if let Some(parent) = arm.joint_frames.carrier(index) {
                loads.put(parent, false, Carried { behind: None, columns: vec![column] });
            }
            continue;
        }
        let own = Composite::of_link(arm, index, &arm.parameters.links[index]);
        let u = builder.vector(row.axis);
        // the component of a wrench along the joint's axis
        let along = |wrench: &Wrench<'s>| match row.kind {
            Revolute => wrench.moment.0[2],
            Prismatic => u.dot(wrench.force),
        };
        let mut load = loads.take(index);
        for column in row.gyrostats.iter().flat_map(|gyrostat| gyrostat.columns(arm)) {
            gather(&mut load.own.columns, column);
        }
        for (column, wrench) in load.own.columns.iter().chain(&load.unturned.columns) {
            let element = along(wrench);
            // a rotor that turns with this joint and is carried by a link that this joint moves counts twice
            let element = if *column == index { element + element } else { element };
            add(&mut matrix, index, *column, element);
        }
        let turn = (row.kind == Revolute).then(|| arm.turn_of_group(index));
        let in_axes = load.with_link(own);
        let mut columns = load.columns(turn);
        let whole = load.whole(in_axes, turn);
        let column = match row.kind {
            Revolute => whole.turning(builder),
            Prismatic => whole.sliding(u),
        };
        add(&mut matrix, index, index, along(&column));
        gather(&mut columns, (index, column));
        let carried = Carried { behind: Some(whole), columns };
        if row.kind == Revolute {
            name(builder, index + 1, &carried);
        }
        if let Some(parent) = arm.joint_frames.carrier(index) {
            loads.put(parent, arm.is_grouped(index), arm.inward(index, carried));
        }
    }
    let of_base = arm.joint_frames.base.as_ref().map(|base| of_base(arm, base, loads.take(dof)));
    let coupled = |row: usize, column: usize| {
        let found = arm.joint_frames.coupled.iter().find(|(i, j, _)| (*i, *j) == (row, column));
        found.map(|(.., element)| *element)
    };
    let element = |row: usize, column: usize| {
        let element = matrix[row][column].signed(rows[row].reversed != rows[column].reversed);
        let constant = if row == column { Some(arm.joint_frames.rotors[row]) } else { coupled(row, column) };
        let element = constant.map_or(element, |constant| element + builder.number(constant));
        builder.name(torque_by(row, WithRespectTo::RateDot(column + 1)), element);
        element
    };
    ((0..dof).map(|row| (row..dof).map(|column| element(row, column)).collect()).collect(), of_base)
}

/// Returns the rows of a floating base, in its axes and about its origin, given the bodies and columns that its joints
/// carry.
fn of_base<'s>(arm: &Arm<'_, 's>, base: &Carrier, mut load: LoadOfLink<Composite<'s>, Column<'s>>) -> OfBase<'s> {
    let (builder, rows) = (arm.builder, arm.rows());
    builder.at(Quantity::BaseForce, 0);
    let Composite { mass, h, s, .. } = load.with_link(Composite::of_matter(builder, &arm.parameters.base));
    let [xx, yy, zz, xy, xz, yz] = s;
    let mut columns = load.columns(None);
    for column in base.gyrostats.iter().flat_map(|gyrostat| gyrostat.columns(arm)) {
        gather(&mut columns, column);
    }
    let column = |(index, row): (usize, &JointFrame)| {
        let own = columns.iter().filter(|(of, _)| *of == index).map(|(_, wrench)| *wrench);
        let Wrench { force, moment } = own.reduce(Wrench::plus).unwrap_or_else(|| Wrench::zero(builder));
        [force, moment].map(|part| part.map(|_, x| x.signed(row.reversed)))
    };
    let columns = rows.iter().enumerate().map(column).collect();
    // the inertia J = tr(S) 1 - S, from the second moments S
    OfBase { mass, h, inertia: [yy + zz, xx + zz, xx + yy, -xy, -xz, -yz], columns }
}

/// Adds a number to an element of the upper half of a symmetric matrix.
fn add<'s>(matrix: &mut [Vec<Symbol<'s>>], row: usize, column: usize, element: Symbol<'s>) {
    let place = &mut matrix[row.min(column)][row.max(column)];
    *place = if place.is_zero() { element } else { *place + element };
}

/// Adds a column to the column of the same joint, if there is one already.
fn gather<'s>(columns: &mut Vec<Column<'s>>, (joint, wrench): Column<'s>) {
    match columns.iter_mut().find(|(other, _)| *other == joint) {
        Some((_, known)) => *known = known.plus(wrench),
        None => columns.push((joint, wrench)),
    }
}

/// Returns the gravity torques; they need only the first moments of the composite bodies: τ = (h × a)_z.
pub(crate) fn gravity_torques<'s>(arm: &Arm<'_, 's>) -> Vec<Symbol<'s>> {
    let (builder, rows) = (arm.builder, arm.rows());
    let dof = rows.len();
    // acceleration of the base in frame N of each joint or of its group, and in the axes of its link
    let mut fields: Vec<[Vector<'s>; 2]> = Vec::with_capacity(dof);
    for (index, row) in rows.iter().enumerate() {
        builder.at(Quantity::OriginAcceleration, index + 1);
        let of_parent = row.parent.map(|parent| fields[parent]);
        let before =
            of_parent.map_or_else(|| builder.vector(arm.joint_frames.gravity[index].map(|g| -g)), |[_, own]| own);
        let field = match of_parent {
            Some([field, _]) if arm.is_grouped(index) => field,
            _ => Twist::new(builder, row).back(before),
        };
        let own = match row.kind {
            Revolute => arm.turn_of_group(index).back_about_z(field),
            Prismatic if row.carried => before,
            Prismatic => builder.fixed_turn(row.theta).back_about_z(field),
        };
        fields.push([if row.kind == Revolute { field } else { own }, own]);
    }
    let mut torques = vec![builder.zero(); dof];
    let mut loads: Loads<FirstMoment<'s>, Column<'s>> = Loads::new();
    for (index, (row, matter)) in rows.iter().zip(&arm.parameters.links).enumerate().rev() {
        builder.at(Quantity::ReducedMoment, index + 1);
        if arm.is_spin(index) {
            continue;
        }
        let own = FirstMoment { mass: builder.number(matter.mass), h: builder.vector(matter.h) };
        let own = arm.payload_on(index).map_or(own, |payload| own.plus(payload.first_moment(arm)));
        let ([field, _], load) = (fields[index], loads.take(index));
        let [carried, unturned] = [load.own.behind, load.unturned.behind];
        // the mass of the links after this one is added first
        let behind = [carried, unturned].into_iter().flatten().reduce(Body::plus);
        let mass = behind.map_or(builder.zero(), |behind| behind.mass) + own.mass;
        let h = match (carried, unturned) {
            (None, Some(_)) => own.h,
            (carried, _) => carried.map_or(builder.no_vector(), |carried| carried.h) + own.h,
        };
        let (h, torque) = match row.kind {
            Revolute => {
                let turned = arm.turn_of_group(index).about_z(h);
                let h = unturned.map_or(turned, |unturned| unturned.h + turned);
                let ([hx, hy, _], [ax, ay, _]) = (h.0, field.0);
                (h, hx * ay - hy * ax)
            }
            Prismatic => (h, builder.vector(row.axis).dot(field) * mass),
        };
        if let Some(parent) = row.parent {
            let carried = Carried { behind: Some(FirstMoment { mass, h }), columns: Vec::new() };
            loads.put(parent, arm.is_grouped(index), arm.inward(index, carried));
        }
        torques[index] = torque.signed(row.reversed);
        builder.name(arm.joint_frames.coordinates.name_of_torque(index), torques[index]);
    }
    torques
}
