//! From the rows of the table to the constants of the seven steps, in form P: frame i at joint i, fixed to link i.
//!
//! ```text
//! standard  Rx(α_{i-1})  d = (a_i, 0, b_i) + Rx(α_i) c̄   r = -Rx(α_i) c̄        I = Rx(α_i) Ī Rx(α_i)ᵀ  α_0 = 0
//! modified  Rx(α_{i-1})  d = (0, 0, b_i) + c̄             r = (a_i, 0, 0) - c̄   I = Ī                 r_n = -c̄
//! ```
//!
//! The tip frame: R_{n+1} = Rx(α_n) R_t (standard) or R_t (modified), and r_n grows by the tool's translation turned
//! into frame n. Row i of a modified table carries α_{i-1} and a_{i-1}.

use rne_model::{Angle, Convention, Entry, Formula, InertiaElement, JointKind, Robot};

use crate::ir::Builder;
use crate::ir::ledger::Cause;
use crate::ir::name::Name;
use crate::ir::quantity::{Axis, Quantity};
use crate::ir::{Matrix, Symbol, Vector};

/// The constants of one link and of the joint that moves it.
pub(crate) struct Link<'s> {
    pub(crate) kind: JointKind,
    /// Rx(α_{i-1}): the fixed part of R_i.
    pub(crate) twist: Matrix<'s>,
    /// The constant part of the joint angle.
    pub(crate) theta: Angle,
    /// (a_i, 0, b_i), J_i → J_{i+1} along the row; b_i without the joint variable.
    pub(crate) offset: Vector<'s>,
    /// Centre of mass from J_{i+1} of a standard, from J_i of a modified row.
    pub(crate) com: Vector<'s>,
    /// C_i → J_{i+1}.
    pub(crate) r: Vector<'s>,
    /// From the end of the offset, where the link frame of the table stands, to J_{i+1} or to the tip.
    pub(crate) lever: Vector<'s>,
    /// Turns components in the link frame of the table into components in frame i.
    pub(crate) table_axes: Matrix<'s>,
    pub(crate) mass: Symbol<'s>,
    /// About the centre of mass.
    pub(crate) inertia: Matrix<'s>,
}

/// The constants of a robot.
pub(crate) struct Arm<'s> {
    pub(crate) links: Vec<Link<'s>>,
    /// R_{n+1}: turns components in the tip frame into components in frame n.
    pub(crate) tip: Matrix<'s>,
    /// Gravity in frame 0.
    pub(crate) gravity: Vector<'s>,
    /// r_0: from the origin of frame 0 to J_1.
    pub(crate) base_lever: Vector<'s>,
    /// World → frame 0.
    pub(crate) base: Placement<'s>,
}

impl<'s> Arm<'s> {
    pub(crate) fn new(builder: &'s Builder, robot: &Robot) -> Self {
        let dof = robot.dof();
        let rows: Vec<_> = robot.rows().collect();
        let zero = || builder.constant(0.0, Cause::Arithmetic);
        let number = |entry: Entry, value: f64| number(builder, robot, entry, value);
        let along_x = |index: usize, length: f64| Vector([number(Entry::A(index), length), zero(), zero()]);
        let tool = Placement::tool(builder, robot);

        let turns: Vec<_> =
            rows.iter().enumerate().map(|(index, row)| turn_about_x(builder, index + 1, &row.dh.alpha)).collect();
        let mut tip = tool.rotation;
        let mut links = Vec::with_capacity(dof);
        for (index, row) in rows.iter().enumerate() {
            let joint = index + 1;
            let written_com = Vector([0, 1, 2].map(|axis| number(Entry::Com(index, axis), row.link.com[axis])));
            let written_inertia = inertia(builder, robot, index);
            let is_last = joint == dof;
            let (twist, offset, com, mut r, inertia, mut lever, table_axes);
            match robot.convention {
                Convention::Standard => {
                    // the twist before joint i stands in row i-1
                    let own = turns[index];
                    twist = index.checked_sub(1).map_or_else(|| identity(builder), |previous| turns[previous]);
                    offset = [number(Entry::A(index), row.dh.a), zero(), number(Entry::D(index), row.dh.d)];
                    com = own * written_com;
                    inertia = (own * written_inertia) * own.transpose();
                    r = -com;
                    lever = builder.zeros(Cause::Arithmetic);
                    table_axes = own;
                    if is_last {
                        lever = own * tool.translation;
                        r = r + lever;
                        tip = own * tool.rotation;
                    }
                }
                Convention::Modified => {
                    twist = turns[index];
                    offset = [zero(), zero(), number(Entry::D(index), row.dh.d)];
                    com = written_com;
                    inertia = written_inertia;
                    table_axes = identity(builder);
                    (lever, r) = match rows.get(index + 1) {
                        Some(next) => {
                            let lever = along_x(joint, next.dh.a);
                            (lever, lever - com)
                        }
                        None => (tool.translation, -com + tool.translation),
                    };
                }
            }
            links.push(Link {
                kind: row.kind,
                twist,
                theta: row.dh.theta,
                offset: Vector(offset),
                com,
                r: builder.name_vector(Quantity::R, joint, r),
                lever,
                table_axes,
                mass: {
                    let name = Name::scalar(Quantity::Mass, joint);
                    let is_fixed = robot.run_time.formula(Entry::Mass(index)).is_none();
                    // a constant says of itself which one it is
                    if is_fixed {
                        builder.entry(name, row.link.mass)
                    } else {
                        builder.name(name, number(Entry::Mass(index), row.link.mass))
                    }
                },
                inertia: builder.name_matrix(Quantity::Inertia, joint, inertia),
            });
        }
        Self {
            links,
            tip: builder.name_matrix(Quantity::TipRotation, dof + 1, tip),
            gravity: gravity(builder, robot),
            base_lever: match (robot.convention, rows.first()) {
                (Convention::Modified, Some(first)) => along_x(0, first.dh.a),
                _ => builder.zeros(Cause::FirstFrame),
            },
            base: Placement::base(builder, robot),
        }
    }
}

/// A constant placement: frame n → tip frame, or world → frame 0.
#[derive(Clone, Copy)]
pub(crate) struct Placement<'s> {
    pub(crate) rotation: Matrix<'s>,
    pub(crate) translation: Vector<'s>,
}

impl<'s> Placement<'s> {
    /// R = (Rz(yaw) Ry(pitch)) Rx(roll).
    fn new(builder: &'s Builder, rpy: [Angle; 3], translation: [Symbol<'s>; 3]) -> Self {
        let number = |value: f64| builder.constant(value, Cause::Arithmetic);
        let (zero, one) = (number(0.0), number(1.0));
        let [roll, pitch, yaw] = rpy.map(|angle| builder.constant_turn(&angle, Cause::Arithmetic));
        let about_x = {
            let (s, c) = roll;
            Matrix::from_rows([[one, zero, zero], [zero, c, -s], [zero, s, c]])
        };
        let about_y = {
            let (s, c) = pitch;
            Matrix::from_rows([[c, zero, s], [zero, one, zero], [-s, zero, c]])
        };
        let about_z = {
            let (s, c) = yaw;
            Matrix::from_rows([[c, -s, zero], [s, c, zero], [zero, zero, one]])
        };
        Self { rotation: (about_z * about_y) * about_x, translation: Vector(translation) }
    }

    fn tool(builder: &'s Builder, robot: &Robot) -> Self {
        let xyz = [0, 1, 2].map(|axis| number(builder, robot, Entry::ToolXyz(axis), robot.tool.xyz[axis]));
        Self::new(builder, robot.tool.rpy, xyz)
    }

    fn base(builder: &'s Builder, robot: &Robot) -> Self {
        let xyz = [0, 1, 2].map(|axis| number(builder, robot, Entry::BaseXyz(axis), robot.base.xyz[axis]));
        Self::new(builder, robot.base.rpy, xyz)
    }
}

/// A number of the table: a constant, or a formula over what is known at run time only.
pub(crate) fn number<'s>(builder: &'s Builder, robot: &Robot, entry: Entry, value: f64) -> Symbol<'s> {
    match robot.run_time.formula(entry) {
        Some(written) => formula(builder, written),
        None => builder.constant(value, Cause::Arithmetic),
    }
}

fn formula<'s>(builder: &'s Builder, written: &Formula) -> Symbol<'s> {
    let of = |written: &Formula| formula(builder, written);
    match written {
        Formula::Number(value) => builder.constant(*value, Cause::Arithmetic),
        Formula::Parameter(index) => builder.argument(Name::scalar(Quantity::Parameter, index + 1)),
        Formula::Negative(a) => -of(a),
        Formula::Sum(a, b) => of(a) + of(b),
        Formula::Difference(a, b) => of(a) - of(b),
        Formula::Product(a, b) => of(a) * of(b),
        Formula::Quotient(a, b) => {
            let (a, b) = (of(a), of(b));
            builder.quotient(a, b)
        }
    }
}

/// The inertia of a link about its centre of mass.
fn inertia<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Matrix<'s> {
    use InertiaElement::{Xx, Xy, Xz, Yy, Yz, Zz};
    let Matrix(fixed) = builder.inertia(&robot.joints[index]);
    let element = |row: usize, column: usize, element: InertiaElement| {
        let written = robot.run_time.formula(Entry::Inertia(index, element));
        written.map_or(fixed[row].0[column], |written| formula(builder, written))
    };
    let [xx, yy, zz] = [element(0, 0, Xx), element(1, 1, Yy), element(2, 2, Zz)];
    let [xy, xz, yz] = [element(0, 1, Xy), element(0, 2, Xz), element(1, 2, Yz)];
    Matrix::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
}

/// Rx(α) of a row of the table.
fn turn_about_x<'s>(builder: &'s Builder, row: usize, alpha: &Angle) -> Matrix<'s> {
    let (zero, one) = (builder.constant(0.0, Cause::TurnAboutX), builder.constant(1.0, Cause::TurnAboutX));
    let (s, c) = builder.constant_turn(alpha, Cause::Arithmetic);
    let s = builder.name(Name::scalar(Quantity::TwistSine, row), s);
    let c = builder.name(Name::scalar(Quantity::TwistCosine, row), c);
    Matrix::from_rows([[one, zero, zero], [zero, c, -s], [zero, s, c]])
}

/// α_0 of a standard table is 0.
pub(crate) fn identity(builder: &Builder) -> Matrix<'_> {
    let (zero, one) = (builder.constant(0.0, Cause::FirstFrame), builder.constant(1.0, Cause::FirstFrame));
    Matrix::from_rows([[one, zero, zero], [zero, one, zero], [zero, zero, one]])
}

/// Gravity in frame 0; a component that is zero says so.
fn gravity<'s>(builder: &'s Builder, robot: &Robot) -> Vector<'s> {
    let [x, y, z] = robot.gravity;
    let component = |axis: Axis, value| {
        let written = robot.run_time.formula(Entry::Gravity(axis as usize));
        let symbol = written.map_or_else(
            || builder.constant(value, Cause::GravityDirection(axis)),
            |written| formula(builder, written),
        );
        builder.name(Name::vector(Quantity::Gravity, 0, axis), symbol)
    };
    Vector([component(Axis::X, x), component(Axis::Y, y), component(Axis::Z, z)])
}
