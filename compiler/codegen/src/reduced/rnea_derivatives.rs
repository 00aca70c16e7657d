//! ∂τ/∂q and ∂τ/∂q̇ by composite bodies: the recursion is differentiated, not its expressions.
//!
//! Joint j turns or slides all links after it as one body. Seen from these links, a change of q_j or q̇_j changes only
//! the motion of link j-1. So it changes the acceleration of each of them by
//!
//! ```text
//! ∂/∂q_j:  the field of the twist (κ, b), and 2 Ω × (its velocity)        κ = U' z = ω̇' × z + ω' × Ω,   Ω = ω' × z
//! ∂/∂q̇_j:  the field of the twist 2 (Ω, v' × z), and 2 z × (its velocity)  b = a' × z - 2 Ω × v'
//! ```
//!
//! with ω', ω̇', a', v' of link j-1 at joint j, in frame N_j. The wrench for this change is linear in P = Σ [S h; hᵀ
//! m], G = Σ ∫ r vᵀ dm and p = Σ ∫ v dm of the links after the joint:
//!
//! ```text
//! twist (e, b)    f = m b + e × h          n = J e + h × b
//! Ω × velocity    f = Ω × p                n = tr(G) Ω - Gᵀ Ω
//! ```
//!
//! For the torque of a joint nearer to the base than j this wrench is moved inward, plus the change z × f, z × n that
//! the rotation makes to the wrench at the joint. For the torque of a joint after j, i > j, the roles are exchanged:
//! the column of M for joint i is moved inward and multiplied by the twist of joint j, and so is tr(G) z - G z of joint
//! i.
//!
//! A floating base is the last body. Its angular velocity ω changes the motion of all links, while the acceleration of
//! its origin and its angular acceleration stay the same:
//!
//! ```text
//! ∂/∂ω_k:  the field of the twist (ω × e_k, 0), and 2 e_k × (its velocity)
//! ```
//!
//! A wrench at a tip is fixed to its link, and turns with it.
//!
//! After J. Carpentier and N. Mansard (2018) and S. Singh, R. Russell and P. Wensing (2022), who use spatial vectors;
//! here with regrouped inertial parameters and in frames N. All velocities are doubled at the start, which saves the
//! factors 2.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::coordinates::{Coordinates, scaled};
use crate::ir::{Number, Quantity, Symbol, Vector, square};
use crate::reduced::backward::{antisymmetric_of, tip_wrenches};
use crate::reduced::inward::{Carried, LoadOfLink, Loads, full};
use crate::reduced::joint_motion::{JointMotion, Motion, of_floating_base, stations};
use crate::reduced::{
    Arm, Body, Carrier, Composite, Gradient, Gyrostat, Inward, JointFrame, PseudoInertia, Turned, Wrench,
};

/// ∂τ_i/∂q_j and ∂τ_i/∂q̇_j; i is the row and j the column.
pub(crate) struct Sensitivity<'s> {
    pub(crate) by_position: Vec<Vec<Symbol<'s>>>,
    pub(crate) by_rate: Vec<Vec<Symbol<'s>>>,
    of_base: Option<OfBase<'s>>,
}

/// The derivatives that a floating base adds.
struct OfBase<'s> {
    /// Derivatives of the wrench on the base with respect to the position and the rate of each joint.
    by_joints: Vec<[Wrench<'s>; 2]>,
    /// Derivatives of the torque of each joint with respect to the angular velocity of the base.
    torques: Vec<Vector<'s>>,
    /// Derivatives of the wrench on the base with respect to the components of its angular velocity.
    wrench: [Wrench<'s>; 3],
}

impl<'s> Sensitivity<'s> {
    /// Returns the columns of derivatives with respect to q, q̇ and the angular velocity of a floating base: in each,
    /// force, moment and torques.
    pub(crate) fn with_base(&self, coordinates: &Coordinates) -> Option<Vec<Vec<Symbol<'s>>>> {
        let of_base = self.of_base.as_ref()?;
        let transposed =
            |rows: &[Vec<Symbol<'s>>], column: usize| rows.iter().map(|row| row[column]).collect::<Vec<_>>();
        let on_base = |wrench: &Wrench<'s>| wrench.force.0.into_iter().chain(wrench.moment.0);
        let by_joints = |kind: usize, torques: &[Vec<Symbol<'s>>]| {
            let rows = coordinates.matrix(torques);
            let wrenches: Vec<_> = of_base.by_joints.iter().map(|wrenches| wrenches[kind]).collect();
            let wrenches = coordinates.gathered(&wrenches, Wrench::plus, |wrench, ratio| {
                wrench.map(|part| part.map(|_, x| scaled(x, ratio)))
            });
            let column = |(index, wrench)| on_base(wrench).chain(transposed(&rows, index)).collect::<Vec<_>>();
            wrenches.iter().enumerate().map(column).collect::<Vec<_>>()
        };
        let about = [0, 1, 2].map(|axis: usize| {
            let torques: Vec<_> = of_base.torques.iter().map(|torque| torque.0[axis]).collect();
            on_base(&of_base.wrench[axis]).chain(coordinates.torques(&torques)).collect()
        });
        Some([by_joints(0, &self.by_position), by_joints(1, &self.by_rate), about.into()].concat())
    }
}

/// The moment ∫ r vᵀ dm of positions and velocities.
pub(crate) type Moment<'s> = [[Symbol<'s>; 3]; 3];

/// A link and all links after it, about the origin of its joint.
#[derive(Clone, Copy)]
pub(crate) struct Behind<'s> {
    pub(crate) body: Composite<'s>,
    /// ∫ r vᵀ dm, times the factor of the velocities.
    pub(crate) moment: Moment<'s>,
    /// G11 + G22, if it is known from before a rotation about z, which does not change it.
    pub(crate) around: Option<Symbol<'s>>,
    pub(crate) momentum: Vector<'s>,
    pub(crate) wrench: Wrench<'s>,
}

/// The contribution of joint `joint` to the rows and columns of joints nearer to the base.
#[derive(Clone, Copy)]
pub(crate) struct Column<'s> {
    joint: usize,
    /// The column of M: the wrench for a unit acceleration of the joint.
    pub(crate) unit: Wrench<'s>,
    /// tr(G) z - G z, with the moment G and the joint axis z.
    spin: Vector<'s>,
    pub(crate) by_position: Wrench<'s>,
    pub(crate) by_rate: Wrench<'s>,
}

impl<'s> Body<'s> for Behind<'s> {
    fn plus(self, other: Self) -> Self {
        let moment = square(|i, j| self.moment[i][j] + other.moment[i][j]);
        Self {
            body: self.body.plus(other.body),
            moment,
            around: (self.around.is_some() || other.around.is_some()).then(|| self.around() + other.around()),
            momentum: self.momentum + other.momentum,
            wrench: self.wrench.plus(other.wrench),
        }
    }
}

impl<'s> Behind<'s> {
    pub(crate) fn around(&self) -> Symbol<'s> {
        self.around.unwrap_or_else(|| self.moment[0][0] + self.moment[1][1])
    }

    /// Adds a rotor on the link. Its angular momentum Jm s a enters the moment ∫ r vᵀ dm by half, as an antisymmetric
    /// part.
    pub(crate) fn with_rotor(
        self,
        arm: &Arm<'_, 's>,
        gyrostat: &Gyrostat,
        carrier: &Motion<'s>,
        factor: Number,
    ) -> Self {
        let half = Number::integer(2).inverse().unwrap_or_default();
        let [x, y, z] = arm.builder.vector(gyrostat.axis).0;
        let rate = gyrostat.of_joints(arm, |joint| arm.rate(joint)).times(factor * half);
        let ([x, y, z], zero) = ([x * rate, y * rate, z * rate], arm.builder.zero());
        let turning = [[zero, z, -y], [-z, zero, x], [y, -x, zero]];
        let moment = square(|i, j| self.moment[i][j] + turning[i][j]);
        let Wrench { force, moment: of_wrench } = self.wrench;
        let wrench = Wrench { force, moment: of_wrench + gyrostat.moment(arm, carrier.omega) };
        Self { moment, wrench, ..self }
    }

    /// Adds the wrench that the link exerts at its tips, given in its axes and about the origin of its frame. For a
    /// spinning sphere it is turned into frame N.
    fn with_wrench(self, arm: &Arm<'_, 's>, index: usize, wrench: Wrench<'s>) -> Self {
        let turn = arm.is_spin(index).then(|| Turned::AboutZ(arm.turn_of_group(index)));
        let wrench = turn.map_or(wrench, |turn| wrench.turned(turn));
        Self { wrench: self.wrench.plus(wrench), ..self }
    }

    /// Returns (tr(G) - G) v.
    pub(crate) fn about(&self, v: Vector<'s>) -> Vector<'s> {
        about(&self.moment, self.around(), v)
    }

    /// Returns the wrench for the acceleration 2 Ω × velocity, given the doubled velocities.
    fn deflected(&self, by: Vector<'s>) -> Wrench<'s> {
        let g = &self.moment;
        let [x, y, z] = by.0;
        let moment = Vector([
            (g[1][1] + g[2][2]) * x - (g[1][0] * y + g[2][0] * z),
            (g[0][0] + g[2][2]) * y - (g[0][1] * x + g[2][1] * z),
            self.around() * z - (g[0][2] * x + g[1][2] * y),
        ]);
        Wrench { force: by.cross(self.momentum), moment }
    }
}

/// Returns (tr(G) - G) v; `around` is G11 + G22.
pub(crate) fn about<'s>(g: &Moment<'s>, around: Symbol<'s>, v: Vector<'s>) -> Vector<'s> {
    let [x, y, z] = v.0;
    Vector([
        (g[1][1] + g[2][2]) * x - (g[0][1] * y + g[0][2] * z),
        (g[0][0] + g[2][2]) * y - (g[1][0] * x + g[1][2] * z),
        around * z - (g[2][0] * x + g[2][1] * y),
    ])
}

/// Returns R G Rᵀ; rows are rotated first, then columns.
pub(crate) fn turned<'s>(moment: &Moment<'s>, turn: Turned<'s>) -> Moment<'s> {
    let rows = moment.map(|row| turn.of(Vector(row)).0);
    let columns = [0, 1, 2].map(|j| turn.of(Vector(rows.map(|row| row[j]))).0);
    square(|i, j| columns[j][i])
}

impl<'s> Inward<'s> for Behind<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        let around = if let Turned::AboutZ(_) = turn { Some(self.around()) } else { None };
        let moment = turned(&self.moment, turn);
        Self {
            body: self.body.turned(turn),
            moment,
            around,
            momentum: turn.of(self.momentum),
            wrench: self.wrench.turned(turn),
        }
    }

    fn moved(self, t: Vector<'s>) -> Self {
        let moment = square(|i, j| self.moment[i][j] + t.0[i] * self.momentum.0[j]);
        let ([x, y, _], [px, py, _]) = (t.0, self.momentum.0);
        let around = self.around.map(|around| around + (x * px + y * py));
        Self { body: self.body.moved(t), moment, around, wrench: self.wrench.about(t), ..self }
    }
}

impl<'s> Inward<'s> for Column<'s> {
    fn turned(self, turn: Turned<'s>) -> Self {
        Self {
            unit: self.unit.turned(turn),
            spin: turn.of(self.spin),
            by_position: self.by_position.turned(turn),
            by_rate: self.by_rate.turned(turn),
            ..self
        }
    }

    fn moved(self, t: Vector<'s>) -> Self {
        Self {
            unit: self.unit.about(t),
            by_position: self.by_position.about(t),
            by_rate: self.by_rate.about(t),
            ..self
        }
    }
}

/// Returns the derivatives of the torques. `factor` is that of the velocities: 2 for derivatives. With 1, the
/// derivatives with respect to the rates are halved, which gives the Coriolis matrix.
pub(crate) fn sensitivity<'s>(arm: &Arm<'_, 's>, factor: Number) -> Sensitivity<'s> {
    let builder = arm.builder;
    let stations = stations(arm, factor);
    let dof = stations.len();
    let rows = arm.rows();
    let zero = builder.zero();
    let nothing = || vec![vec![zero; dof]; dof];
    let mut found = Sensitivity { by_position: nothing(), by_rate: nothing(), of_base: None };
    let tips = tip_wrenches(arm, |_| Number::ONE);
    let mut loads: Loads<Behind<'s>, Column<'s>> = Loads::new();
    for index in (0..dof).rev() {
        builder.at(Quantity::ReducedForce, index + 1);
        let (row, station) = (&rows[index], &stations[index]);
        let own = own(Composite::of_link(arm, index, &matter(arm, Some(index))), &station.own);
        let own = row.gyrostats.iter().fold(own, |own, gyrostat| own.with_rotor(arm, gyrostat, &station.own, factor));
        let at_tips = tips.iter().filter(|(on, _)| *on == index).map(|(_, wrench)| *wrench).reduce(Wrench::plus);
        let own = at_tips.into_iter().fold(own, |own, wrench| own.with_wrench(arm, index, wrench));
        // all bodies and columns are turned into frame N of this joint
        let (mut load, turn) = (loads.take(index), (row.kind == Revolute).then_some(station.turn));
        for column in row.gyrostats.iter().flat_map(|gyrostat| columns_of(arm, gyrostat, &station.own)) {
            gather(&mut load.own.columns, column);
        }
        let behind = load.whole(load.with_link(own), turn);
        let mut columns = load.columns(turn);
        behind.body.name(builder, index + 1);
        let column = column(arm, index, &twists(arm, index, station), &behind);
        for column in &columns {
            meet(arm, index, station, column, &mut found);
            meet_back(arm, index, column, &mut found);
        }
        meet(arm, index, station, &column, &mut found);
        gather(&mut columns, column);
        if let Some(parent) = arm.joint_frames.carrier(index) {
            let carried = Carried { behind: Some(behind), columns };
            loads.put(parent, arm.is_grouped(index), arm.inward(index, carried));
        }
    }
    found.of_base = arm.joint_frames.base.as_ref().map(|base| of_base(arm, base, loads.take(dof), factor));
    for matrix in [&mut found.by_position, &mut found.by_rate] {
        for (elements, row) in matrix.iter_mut().zip(rows) {
            for (element, column) in elements.iter_mut().zip(rows) {
                *element = element.signed(row.reversed != column.reversed);
            }
        }
    }
    found
}

/// Returns the derivatives that a floating base adds, in its axes and about its origin, given the bodies that its
/// joints carry.
fn of_base<'s>(
    arm: &Arm<'_, 's>,
    base: &Carrier,
    mut load: LoadOfLink<Behind<'s>, Column<'s>>,
    factor: Number,
) -> OfBase<'s> {
    let (builder, rows) = (arm.builder, arm.rows());
    builder.at(Quantity::BaseForce, 0);
    let motion = of_floating_base(arm, factor);
    let own = own(Composite::of_matter(builder, &matter(arm, None)), &motion);
    let own = base.gyrostats.iter().fold(own, |own, gyrostat| own.with_rotor(arm, gyrostat, &motion, factor));
    let whole = load.with_link(own);
    // a rotor can be on another branch than its joint, so a joint can have more than one column here
    let mut columns = Vec::new();
    let of_rotors = base.gyrostats.iter().flat_map(|gyrostat| columns_of(arm, gyrostat, &motion));
    load.columns(None).into_iter().chain(of_rotors).for_each(|column| gather(&mut columns, column));
    let wrench = [0, 1, 2].map(|axis| {
        let unit = Vector([0, 1, 2].map(|other| if other == axis { builder.one() } else { builder.zero() }));
        let by_twist = whole.body.carried(motion.omega.cross(unit), builder.no_vector());
        by_twist.plus(whole.deflected(unit))
    });
    let nothing = (Wrench::zero(builder), Wrench::zero(builder), builder.no_vector());
    let of_joint = |(index, row): (usize, &JointFrame)| {
        let column = columns.iter().find(|column| column.joint == index);
        let (by_position, by_rate, by_omega) = column.map_or(nothing, |column| {
            (column.by_position, column.by_rate, column.unit.moment.cross(motion.omega) + column.spin)
        });
        let signed = |v: Vector<'s>| v.map(|_, x| x.signed(row.reversed));
        ([by_position, by_rate].map(|wrench| wrench.map(signed)), signed(by_omega))
    };
    let (by_joints, torques) = rows.iter().enumerate().map(of_joint).unzip();
    OfBase { by_joints, torques, wrench }
}

/// Returns the moments of a link, or of a floating base (`None`). If the plan takes the last link as a spinning sphere,
/// this undoes the transfer of the sphere's moments to the link before.
pub(crate) fn matter(arm: &Arm<'_, '_>, link: Option<usize>) -> PseudoInertia {
    let mut matter = link.map_or(arm.parameters.base, |link| arm.parameters.links[link]);
    let Some(c) = arm.parameters.sphere else { return matter };
    let half = c * Number::integer(2).inverse().unwrap_or_default();
    let rows = arm.rows();
    if link.is_some_and(|link| arm.is_spin(link)) {
        matter = PseudoInertia::default();
        (0..3).for_each(|k| matter.s[k][k] = half);
    } else if rows.last().is_some_and(|last| last.parent == link) {
        (0..3).for_each(|k| matter.s[k][k] = matter.s[k][k] - half);
    }
    matter
}

/// Returns the columns of the joints with which a rotor turns: their effect on the rotor's carrier.
fn columns_of<'s>(arm: &Arm<'_, 's>, gyrostat: &Gyrostat, carrier: &Motion<'s>) -> impl Iterator<Item = Column<'s>> {
    let half = Number::integer(2).inverse().unwrap_or_default();
    let nothing = Wrench::zero(arm.builder);
    let omega = carrier.twice_omega.times(half);
    gyrostat.columns(arm).map(move |(joint, unit)| {
        let turned = omega.cross(unit.moment);
        Column { joint, unit, spin: turned, by_position: nothing, by_rate: Wrench { moment: turned, ..nothing } }
    })
}

/// Adds a column to the column of the same joint, if there is one already.
fn gather<'s>(columns: &mut Vec<Column<'s>>, column: Column<'s>) {
    match columns.iter_mut().find(|other| other.joint == column.joint) {
        Some(known) => {
            *known = Column {
                joint: known.joint,
                unit: known.unit.plus(column.unit),
                spin: known.spin + column.spin,
                by_position: known.by_position.plus(column.by_position),
                by_rate: known.by_rate.plus(column.by_rate),
            }
        }
        None => columns.push(column),
    }
}

/// Returns the quantities of one link alone, in its axes.
pub(crate) fn own<'s>(body: Composite<'s>, motion: &Motion<'s>) -> Behind<'s> {
    let (h, m, s) = (body.h, body.mass, full(body.s));
    let moment = moment_of(h, &s, motion.twice_omega, motion.twice_velocity);
    let gradient = Gradient::new(motion.omega, motion.omega_dot);
    Behind {
        body,
        moment,
        around: None,
        momentum: motion.twice_velocity * m + motion.twice_omega.cross(h),
        wrench: Wrench {
            force: motion.acceleration * m + gradient.of(h),
            moment: antisymmetric_of(&gradient, &s) + h.cross(motion.acceleration),
        },
    }
}

/// Returns ∫ r vᵀ dm of a body with these moments.
pub(crate) fn moment_of<'s>(
    h: Vector<'s>,
    s: &[[Symbol<'s>; 3]; 3],
    omega: Vector<'s>,
    velocity: Vector<'s>,
) -> Moment<'s> {
    let ([x, y, z], [vx, vy, vz]) = (omega.0, velocity.0);
    [0, 1, 2].map(|i| {
        let [sx, sy, sz] = s[i];
        let hi = h.0[i];
        [hi * vx + (y * sz - z * sy), hi * vy + (z * sx - x * sz), hi * vz + (x * sy - y * sx)]
    })
}

/// The twists of a joint in its frame N (not turned by the joint), with respect to its position and to its rate, each
/// angular and linear; and Ω.
pub(crate) struct Twists<'s> {
    pub(crate) angular: Vector<'s>,
    pub(crate) linear: Vector<'s>,
    pub(crate) rate_angular: Vector<'s>,
    pub(crate) rate_linear: Vector<'s>,
    pub(crate) deflection: Vector<'s>,
}

pub(crate) fn twists<'s>(arm: &Arm<'_, 's>, index: usize, station: &JointMotion<'s>) -> Twists<'s> {
    let builder = arm.builder;
    let row = &arm.rows()[index];
    let Motion { omega, omega_dot, acceleration, twice_omega, twice_velocity } = station.before;
    let (zeros, zero) = (builder.no_vector(), builder.zero());
    match row.kind {
        Revolute => {
            let ([wx, wy, wz], [dx, dy, _]) = (omega.0, omega_dot.0);
            let ([ax, ay, _], [vx, vy, vz]) = (acceleration.0, twice_velocity.0);
            let [tx, ty, _] = twice_omega.0;
            Twists {
                angular: Vector([wx * wz + dy, wy * wz - dx, -(wx * wx + wy * wy)]),
                linear: Vector([ay + wx * vz, wy * vz - ax, -(wx * vx + wy * vy)]),
                rate_angular: Vector([ty, -tx, zero]),
                rate_linear: Vector([vy, -vx, zero]),
                deflection: Vector([wy, -wx, zero]),
            }
        }
        Prismatic => {
            let u = builder.vector(row.axis);
            Twists {
                angular: zeros,
                linear: Gradient::new(omega, omega_dot).of(u),
                rate_angular: zeros,
                rate_linear: twice_omega.cross(u),
                deflection: zeros,
            }
        }
    }
}

/// Returns the column that a joint contributes to rows and columns of joints nearer to the base.
pub(crate) fn column<'s>(arm: &Arm<'_, 's>, index: usize, twists: &Twists<'s>, behind: &Behind<'s>) -> Column<'s> {
    let builder = arm.builder;
    let row = &arm.rows()[index];
    let body = &behind.body;
    let (zero, g) = (builder.zero(), &behind.moment);
    let Wrench { force, moment } = behind.wrench;
    let by_position = body.carried(twists.angular, twists.linear);
    let by_rate = body.carried(twists.rate_angular, twists.rate_linear);
    match row.kind {
        Revolute => {
            let quarter = |v: Vector<'s>| Vector([-v.0[1], v.0[0], zero]);
            let around = Wrench { force: quarter(force), moment: quarter(moment) };
            let both = behind.around();
            let [px, py, _] = behind.momentum.0;
            let turned = Wrench { force: Vector([-py, px, zero]), moment: Vector([-g[2][0], -g[2][1], both]) };
            Column {
                joint: index,
                unit: body.turning(builder),
                spin: Vector([-g[0][2], -g[1][2], both]),
                by_position: by_position.plus(behind.deflected(twists.deflection)).plus(around),
                by_rate: by_rate.plus(turned),
            }
        }
        Prismatic => {
            let u = builder.vector(row.axis);
            let lever = Wrench { force: builder.no_vector(), moment: u.cross(force) };
            Column {
                joint: index,
                unit: body.sliding(u),
                spin: behind.momentum.cross(u),
                by_position: by_position.plus(lever),
                by_rate,
            }
        }
    }
}

/// Adds the derivatives of the torque of a column's joint with respect to joint `index`.
fn meet<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    station: &JointMotion<'s>,
    column: &Column<'s>,
    found: &mut Sensitivity<'s>,
) {
    let row = &arm.rows()[index];
    let twists = twists(arm, index, station);
    let Wrench { force, moment } = column.unit;
    let spin = if row.kind == Revolute { column.spin.0[2] } else { arm.builder.zero() };
    let by_position = moment.dot(twists.angular) + force.dot(twists.linear) + column.spin.dot(twists.deflection);
    add(&mut found.by_position[column.joint][index], by_position);
    let by_rate = moment.dot(twists.rate_angular) + force.dot(twists.rate_linear) + spin;
    add(&mut found.by_rate[column.joint][index], by_rate);
}

/// Adds the derivatives of the torque of joint `index` with respect to the joint of a column, which is a joint after it
/// or that of a rotor.
fn meet_back<'s>(arm: &Arm<'_, 's>, index: usize, column: &Column<'s>, found: &mut Sensitivity<'s>) {
    let row = &arm.rows()[index];
    let along = |wrench: &Wrench<'s>| match row.kind {
        Revolute => wrench.moment.0[2],
        Prismatic => arm.builder.vector(row.axis).dot(wrench.force),
    };
    add(&mut found.by_position[index][column.joint], along(&column.by_position));
    add(&mut found.by_rate[index][column.joint], along(&column.by_rate));
}

pub(crate) fn add<'s>(place: &mut Symbol<'s>, element: Symbol<'s>) {
    *place = if place.is_zero() { element } else { *place + element };
}
