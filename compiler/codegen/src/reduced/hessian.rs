//! Second derivatives of λᵀτ, the torques weighted by multipliers λ, computed by composite bodies.
//!
//! λᵀτ is the virtual power L = ∫ ξ · a dm, with the velocities ξ that all points would have if the joints had the
//! velocities λ. Joint j turns or slides all links after it as one body (see `rnea_derivatives`). So q_j changes L only
//! through the motion before the joint: through ξ and a, on which L depends linearly, and through the velocities v in
//! the term 2 Ω × v of a. The first derivatives of L with respect to the motion before a joint are the wrench f, n of
//! the links after it, their momentum p, k under ξ, and the vector W = ∫ 2 v × ξ dm:
//!
//! ```text
//! by ξ: f, n          by a and ω̇: p, k          by ω, with a and ω̇ of the twists of `rnea_derivatives`: W
//! ```
//!
//! A column of joint j has the derivatives of all of them with respect to q_j, q̇_j and q̈_j. It is moved inward to
//! joint i and multiplied there by the changes that q_i, q̇_i and q̈_i make to the motion before i: that gives the
//! second derivatives of L. With δ = ξ' × z of the motion before j under λ (two vectors), Ω = ω' × z, and Gξ = ∫ r ξᵀ
//! dm in addition to G = ∫ r 2vᵀ dm:
//!
//! ```text
//! by q_j:  f, n as there    p, k: those of the twist δ, and z × p, z × k
//!          W: z × W + 2p_v × δ_v + (tr(G) - G) δ_ω - (tr(Gξ) - Gξ) 2Ω + (2v' × z) × p
//! by q̇_j:  f, n as there    W: -2 (tr(Gξ) - Gξ) z          by q̈_j:  f, n: the column of M
//! ```
//!
//! W does not depend on the reference point, and it is the same before and after a joint.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::adjoint::Hessian;
use crate::ir::{Number, Quantity, Symbol, Vector, square};
use crate::reduced::inward::{Carried, Loads, full};
use crate::reduced::joint_motion::{JointMotion, Motion, stations};
use crate::reduced::rnea_derivatives::{self, Behind, Moment, Twists, add, matter, moment_of, twists};
use crate::reduced::{Arm, Body, Composite, Gyrostat, Inward, Outward, SymbolicTurn, Turned, Wrench};

/// The velocities of a link for the joint rates λ, in some axes.
#[derive(Clone, Copy)]
struct Virtual<'s> {
    omega: Vector<'s>,
    velocity: Vector<'s>,
}

impl<'s> Outward<'s> for Virtual<'s> {
    fn turned_back(self, f: impl Fn(Vector<'s>) -> Vector<'s>) -> Self {
        Self { omega: f(self.omega), velocity: f(self.velocity) }
    }

    fn at(self, p: Vector<'s>) -> Self {
        Self { velocity: self.velocity + self.omega.cross(p), ..self }
    }
}

/// The velocities for the rates λ at a joint: of the parent, and of the link in frame N (not turned by the joint) and
/// in its axes.
struct VirtualMotion<'s> {
    before: Virtual<'s>,
    unturned: Virtual<'s>,
    own: Virtual<'s>,
}

fn virtual_motions<'s>(arm: &Arm<'_, 's>, stations: &[JointMotion<'s>]) -> Vec<VirtualMotion<'s>> {
    let builder = arm.builder;
    let still = Virtual { omega: builder.no_vector(), velocity: builder.no_vector() };
    let no_turn = SymbolicTurn { s: builder.zero(), c: builder.one() };
    let mut motions: Vec<VirtualMotion<'s>> = Vec::with_capacity(stations.len());
    for (index, (row, station)) in arm.rows().iter().zip(stations).enumerate() {
        builder.at(Quantity::Omega, index + 1);
        let of_parent = |parent: usize| (motions[parent].own, motions[parent].unturned, stations[parent].turn);
        let (last, last_unturned, turn) = row.parent.map_or((still, still, no_turn), of_parent);
        let before = arm.outward(index, last, last_unturned, turn);
        let rate = arm.multiplier(index);
        let (own, unturned) = match row.kind {
            Revolute => {
                let unturned = Virtual { omega: before.omega.plus_z(rate), ..before };
                (unturned.turned_back(|v| station.turn.back_about_z(v)), unturned)
            }
            Prismatic => {
                let own = Virtual { velocity: before.velocity + builder.vector(row.axis) * rate, ..before };
                (own, own)
            }
        };
        motions.push(VirtualMotion { before, unturned, own });
    }
    motions
}

/// A link and all links after it, about the origin of its joint, with their velocities for the rates λ.
#[derive(Clone, Copy)]
struct Weighted<'s> {
    behind: Behind<'s>,
    /// ∫ ξ dm, the momentum for the rates λ.
    momentum: Vector<'s>,
    /// The moment Gξ = ∫ r ξᵀ dm.
    moment: Moment<'s>,
    /// The sum of the first two diagonal elements of `moment`, if it is known, as in [`Behind`].
    around: Option<Symbol<'s>>,
    /// W = ∫ 2 v × ξ dm.
    mixed: Vector<'s>,
}

impl<'s> Weighted<'s> {
    fn of_link(arm: &Arm<'_, 's>, index: usize, motion: &Motion<'s>, Virtual { omega, velocity }: Virtual<'s>) -> Self {
        let body = Composite::of_link(arm, index, &matter(arm, Some(index)));
        let behind = rnea_derivatives::own(body, motion);
        let momentum = velocity * body.mass + omega.cross(body.h);
        let moment = moment_of(body.h, &full(body.s), omega, velocity);
        // 2v × (ξ₀ + η × r), integrated over the mass of the link
        let mixed = behind.momentum.cross(velocity) + behind.about(omega);
        let own = Self { behind, momentum, moment, around: None, mixed };
        arm.rows()[index].gyrostats.iter().fold(own, |own, gyrostat| own.with_rotor(arm, gyrostat, motion, omega))
    }

    /// Adds a rotor on the link, as [`Behind::with_rotor`] does.
    fn with_rotor(self, arm: &Arm<'_, 's>, gyrostat: &Gyrostat, motion: &Motion<'s>, omega: Vector<'s>) -> Self {
        let two = Number::integer(2);
        let behind = self.behind.with_rotor(arm, gyrostat, motion, two);
        let axis = arm.builder.vector(gyrostat.axis);
        let spin = axis * gyrostat.of_joints(arm, |joint| arm.rate(joint));
        let weighted = axis * gyrostat.of_joints(arm, |joint| arm.multiplier(joint));
        let [x, y, z] = weighted.times(two.inverse().unwrap_or_default()).0;
        let zero = arm.builder.zero();
        let turning = [[zero, z, -y], [-z, zero, x], [y, -x, zero]];
        let moment = square(|i, j| self.moment[i][j] + turning[i][j]);
        let mixed = self.mixed + (spin.cross(omega) + motion.omega.cross(weighted));
        Self { behind, moment, mixed, ..self }
    }

    fn around(&self) -> Symbol<'s> {
        self.around.unwrap_or_else(|| self.moment[0][0] + self.moment[1][1])
    }

    /// Returns (tr(Gξ) - Gξ) v.
    fn about(&self, v: Vector<'s>) -> Vector<'s> {
        rnea_derivatives::about(&self.moment, self.around(), v)
    }
}

impl<'s> Body<'s> for Weighted<'s> {
    fn plus(self, other: Self) -> Self {
        Self {
            behind: self.behind.plus(other.behind),
            momentum: self.momentum + other.momentum,
            moment: square(|i, j| self.moment[i][j] + other.moment[i][j]),
            around: (self.around.is_some() || other.around.is_some()).then(|| self.around() + other.around()),
            mixed: self.mixed + other.mixed,
        }
    }
}

impl<'s> Inward<'s> for Weighted<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        Self {
            behind: Behind {
                body: self.behind.body.turned(turn),
                moment: turned(&self.behind.moment, turn),
                around: if let Turned::AboutZ(_) = turn { Some(self.behind.around()) } else { None },
                momentum: turn.of(self.behind.momentum),
                wrench: self.behind.wrench.turned(turn),
            },
            momentum: turn.of(self.momentum),
            moment: turned(&self.moment, turn),
            around: if let Turned::AboutZ(_) = turn { Some(self.around()) } else { None },
            mixed: turn.of(self.mixed),
        }
    }

    fn moved(self, t: Vector<'s>) -> Self {
        let ([x, y, _], [px, py, _]) = (t.0, self.momentum.0);
        Self {
            behind: self.behind.moved(t),
            moment: square(|i, j| self.moment[i][j] + t.0[i] * self.momentum.0[j]),
            around: self.around.map(|around| around + (x * px + y * py)),
            ..self
        }
    }
}

/// Returns R G Rᵀ. For a rotation about z, the sum and the difference of the off-diagonal elements turn by the doubled
/// angle.
fn turned<'s>(moment: &Moment<'s>, turn: Turned<'s>) -> Moment<'s> {
    let SymbolicTurn { s: sine, c: cosine } = match turn {
        Turned::AboutZ(turn) => turn,
        Turned::AboutX(turn) => {
            // a rotation about x is one about z after the axes are renamed: y, z, x for x, y, z
            let turned = turned(&square(|i, j| moment[(i + 1) % 3][(j + 1) % 3]), Turned::AboutZ(turn));
            return square(|i, j| turned[(i + 2) % 3][(j + 2) % 3]);
        }
    };
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *moment;
    let (difference, both) = (xx - yy, xy + yx);
    let (mixed, squared) = (cosine * sine, cosine * cosine);
    let (u, w) = (squared * difference - mixed * both, mixed * difference + squared * both);
    let [xz, yz, _] = turn.of(Vector([xz, yz, zz])).0;
    let [zx, zy, _] = turn.of(Vector([zx, zy, zz])).0;
    [[u + yy, w - yx, xz], [w - xy, xx - u, yz], [zx, zy, zz]]
}

/// The derivatives of f, n, p, k and W with respect to the motion of joint `joint`. They are moved inward and
/// multiplied by the changes of the motion before a joint nearer to the base.
#[derive(Clone, Copy)]
struct Column<'s> {
    joint: usize,
    /// Derivative of f, n with respect to q̈: the column of M.
    unit: Wrench<'s>,
    /// Derivatives of f, n with respect to q and q̇.
    wrench: [Wrench<'s>; 2],
    /// Derivative of p, k with respect to q.
    momentum: Wrench<'s>,
    /// Derivatives of W with respect to q and q̇.
    mixed: [Vector<'s>; 2],
}

impl<'s> Column<'s> {
    fn map(self, wrench: impl Fn(Wrench<'s>) -> Wrench<'s>, vector: impl Fn(Vector<'s>) -> Vector<'s>) -> Self {
        Self {
            joint: self.joint,
            unit: wrench(self.unit),
            wrench: self.wrench.map(&wrench),
            momentum: wrench(self.momentum),
            mixed: self.mixed.map(vector),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            joint: self.joint,
            unit: self.unit.plus(other.unit),
            wrench: [0, 1].map(|kind| self.wrench[kind].plus(other.wrench[kind])),
            momentum: self.momentum.plus(other.momentum),
            mixed: [0, 1].map(|kind| self.mixed[kind] + other.mixed[kind]),
        }
    }
}

impl<'s> Inward<'s> for Column<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        self.map(|wrench| wrench.turned(turn), |v| turn.of(v))
    }

    fn moved(self, t: Vector<'s>) -> Self {
        self.map(|wrench| wrench.about(t), |v| v)
    }
}

/// Returns the columns of the joints with which a rotor turns: their effect on the rotor's carrier.
fn columns_of<'s>(arm: &Arm<'_, 's>, gyrostat: &Gyrostat, carrier: &Motion<'s>, omega: Vector<'s>) -> Vec<Column<'s>> {
    let (nothing, none) = (Wrench::zero(arm.builder), arm.builder.no_vector());
    let column = |(joint, unit): (usize, Wrench<'s>)| Column {
        joint,
        unit,
        wrench: [nothing, Wrench { moment: carrier.omega.cross(unit.moment), ..nothing }],
        momentum: nothing,
        mixed: [none, unit.moment.cross(omega)],
    };
    gyrostat.columns(arm).map(column).collect()
}

/// Adds a column to the column of the same joint, if there is one already.
fn gather<'s>(columns: &mut Vec<Column<'s>>, column: Column<'s>) {
    match columns.iter_mut().find(|other| other.joint == column.joint) {
        Some(known) => *known = known.plus(column),
        None => columns.push(column),
    }
}

/// Changes that a joint's own motion makes to the motion before it.
struct Turns<'s> {
    twists: Twists<'s>,
    /// Change of the velocities for the rates λ: angular and linear.
    weighted: [Vector<'s>; 2],
}

fn turns_of<'s>(arm: &Arm<'_, 's>, index: usize, station: &JointMotion<'s>, before: Virtual<'s>) -> Turns<'s> {
    let (row, zero) = (&arm.rows()[index], arm.builder.zero());
    let quarter = |v: Vector<'s>| Vector([v.0[1], -v.0[0], zero]);
    let weighted = match row.kind {
        Revolute => [quarter(before.omega), quarter(before.velocity)],
        Prismatic => [arm.builder.no_vector(), before.omega.cross(arm.builder.vector(row.axis))],
    };
    Turns { twists: twists(arm, index, station), weighted }
}

/// Returns the column that a joint contributes to the elements of joints nearer to the base.
fn column<'s>(arm: &Arm<'_, 's>, index: usize, turns: &Turns<'s>, whole: &Weighted<'s>) -> Column<'s> {
    let (row, builder) = (&arm.rows()[index], arm.builder);
    let Turns { twists, weighted: [angular, linear] } = turns;
    let behind = &whole.behind;
    let of_torques = rnea_derivatives::column(arm, index, twists, behind);
    let momentum = behind.body.carried(*angular, *linear);
    let mixed = behind.momentum.cross(*linear) + twists.rate_linear.cross(whole.momentum);
    let two = Number::integer(2);
    let (momentum, mixed) = match row.kind {
        Revolute => {
            let quarter = |v: Vector<'s>| Vector([-v.0[1], v.0[0], builder.zero()]);
            let g = &whole.moment;
            // ∫ r × ξ dm, from the off-diagonal elements of Gξ
            let angular_momentum = Vector([g[1][2] - g[2][1], g[2][0] - g[0][2], builder.zero()]);
            let turned = Wrench { force: quarter(whole.momentum), moment: quarter(angular_momentum) };
            let by_position =
                mixed + quarter(whole.mixed) + (behind.about(*angular) - whole.about(twists.rate_angular));
            let by_rate = Vector([g[0][2], g[1][2], -whole.around()]).times(two);
            (momentum.plus(turned), [by_position, by_rate])
        }
        Prismatic => {
            let u = builder.vector(row.axis);
            let lever = Wrench { force: builder.no_vector(), moment: u.cross(whole.momentum) };
            (momentum.plus(lever), [mixed, u.cross(whole.momentum).times(two)])
        }
    };
    let wrench = [of_torques.by_position, of_torques.by_rate];
    Column { joint: index, unit: of_torques.unit, wrench, momentum, mixed }
}

/// All second derivatives by rows; symmetric matrices have only their upper halves.
struct Found<'s>(Hessian<Vec<Vec<Symbol<'s>>>>);

impl<'s> Found<'s> {
    /// Adds the second derivatives with respect to joint `index` and the joint of a column.
    fn meet(&mut self, arm: &Arm<'_, 's>, index: usize, turns: &Turns<'s>, column: &Column<'s>) {
        let Turns { twists, weighted: [angular, linear] } = turns;
        let (row, other) = (&arm.rows()[index], column.joint);
        let virtually = |wrench: &Wrench<'s>| wrench.moment.dot(*angular) + wrench.force.dot(*linear);
        let Wrench { force, moment } = column.momentum;
        let (first, second) = (index.min(other), index.max(other));
        let by_both = virtually(&column.wrench[0])
            + (moment.dot(twists.angular) + force.dot(twists.linear) + column.mixed[0].dot(twists.deflection));
        add(&mut self.0.dq_dq[first][second], by_both);
        let (along, [by_position, by_rate]) = match row.kind {
            Revolute => (moment.0[2], column.mixed.map(|mixed| mixed.0[2])),
            Prismatic => (arm.builder.vector(row.axis).dot(force), [arm.builder.zero(); 2]),
        };
        let by_rate_here = moment.dot(twists.rate_angular) + force.dot(twists.rate_linear) + by_position;
        add(&mut self.0.dq_dqd[other][index], by_rate_here);
        add(&mut self.0.dq_dqdd[other][index], along);
        add(&mut self.0.dqd_dqd[first][second], by_rate);
    }

    /// Adds the mixed derivatives with both joints exchanged; only for columns of another joint or of a rotor.
    fn meet_back(&mut self, arm: &Arm<'_, 's>, index: usize, turns: &Turns<'s>, column: &Column<'s>) {
        let Turns { twists, weighted: [angular, linear] } = turns;
        let virtually = |wrench: &Wrench<'s>| wrench.moment.dot(*angular) + wrench.force.dot(*linear);
        let by_rate = virtually(&column.wrench[1]) + column.mixed[1].dot(twists.deflection);
        add(&mut self.0.dq_dqd[index][column.joint], by_rate);
        add(&mut self.0.dq_dqdd[index][column.joint], virtually(&column.unit));
        if index == column.joint && arm.rows()[index].kind == Revolute {
            // the product of the rotor's spin and its carrier's motion, differentiated in both orders
            add(&mut self.0.dqd_dqd[index][index], column.mixed[1].0[2]);
        }
    }
}

/// Returns the Hessian of λᵀτ with respect to the joints; symmetric matrices have only their upper halves.
pub(crate) fn hessian<'s>(arm: &Arm<'_, 's>) -> Hessian<Vec<Vec<Symbol<'s>>>> {
    let (builder, rows) = (arm.builder, arm.rows());
    let stations = stations(arm, Number::integer(2));
    let motions = virtual_motions(arm, &stations);
    let dof = rows.len();
    let nothing = || vec![vec![builder.zero(); dof]; dof];
    let mut found = Found(Hessian { dq_dq: nothing(), dq_dqd: nothing(), dqd_dqd: nothing(), dq_dqdd: nothing() });
    let mut loads: Loads<Weighted<'s>, Column<'s>> = Loads::new();
    for index in (0..dof).rev() {
        builder.at(Quantity::ReducedForce, index + 1);
        let (row, station, motion) = (&rows[index], &stations[index], &motions[index]);
        let own = Weighted::of_link(arm, index, &station.own, motion.own);
        // all bodies and columns are turned into frame N of this joint
        let (mut load, turn) = (loads.take(index), (row.kind == Revolute).then_some(station.turn));
        for gyrostat in &row.gyrostats {
            for column in columns_of(arm, gyrostat, &station.own, motion.own.omega) {
                gather(&mut load.own.columns, column);
            }
        }
        let whole = load.whole(load.with_link(own), turn);
        let mut columns = load.columns(turn);
        whole.behind.body.name(builder, index + 1);
        let turns = turns_of(arm, index, station, motion.before);
        let column = column(arm, index, &turns, &whole);
        for column in &columns {
            found.meet(arm, index, &turns, column);
            found.meet_back(arm, index, &turns, column);
        }
        found.meet(arm, index, &turns, &column);
        gather(&mut columns, column);
        if let Some(parent) = arm.joint_frames.carrier(index) {
            let carried = Carried { behind: Some(whole), columns };
            loads.put(parent, arm.is_grouped(index), arm.inward(index, carried));
        }
    }
    let Found(mut found) = found;
    let Hessian { dq_dq, dq_dqd, dqd_dqd, dq_dqdd } = &mut found;
    for matrix in [dq_dq, dq_dqd, dqd_dqd, dq_dqdd] {
        for (elements, row) in matrix.iter_mut().zip(rows) {
            for (element, column) in elements.iter_mut().zip(rows) {
                *element = element.signed(row.reversed != column.reversed);
            }
        }
    }
    found
}
