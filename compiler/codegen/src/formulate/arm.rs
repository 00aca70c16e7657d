//! From the rows of the table to the constants of the seven steps, in form P: frame i at joint i, fixed to link i.
//!
//! ```text
//! standard   d = (a_i, 0, b_i) + Rx(α_i) c̄   I = Rx(α_i) Ī Rx(α_i)ᵀ
//! modified   d = (0, 0, b_i) + c̄             I = Ī
//!
//! mount       rotation   lever l_i      r_i                  of the tip: rotation   lever
//! standard    Rx(α_p)    0              l_i - Rx(α_p) c̄_p    Rx(α_n) R_t            Rx(α_n) p_t
//! modified    Rx(α_i)    (a_i, 0, 0)    l_i - c̄_p            R_t                    p_t
//! ```
//!
//! p is the parent link, n the link of the tip; row i of a modified table carries the twist and the length before joint
//! i. On the base the rotation of a standard table is 1. R_t and p_t are the tool's.
//!
//! In a tree a row may begin at a placement R_b, p_b in the link frame of its parent. It then stands before the row:
//!
//! ```text
//! standard    Rx(α_p) R_b       Rx(α_p) p_b
//! modified    R_b Rx(α_i)       R_b (a_i, 0, 0) + p_b
//! ```

use rne_model::{
    Angle, Convention, Entry, FixedFrame, Formula, FrameId, InertiaElement, Joint, JointKind, Robot, Row, Transform,
};

use crate::coordinates::Coordinates;
use crate::formulate::Spin;
use crate::function::Argument;
use crate::function::OfRobot as _;
use crate::ir::{Axis, Builder, Cause, Matrix, Name, Quantity, Symbol, Vector};

/// Where a joint, or the tip frame, is mounted on its parent link: the constants between a link and what it carries.
#[derive(Clone, Copy)]
pub(crate) struct Mount<'s> {
    /// Turns components in the axes of the joint at θ = 0, or of the tip frame, into components in those of the parent.
    pub(crate) rotation: Matrix<'s>,
    /// Vector from the parent's centre of mass to the joint or the tip; for the base, from the origin of frame 0.
    pub(crate) r: Vector<'s>,
    /// To the same point from the end of the parent's offset, where the link frame of the table stands.
    pub(crate) lever: Vector<'s>,
    /// Tells it from the other things that the parent carries; 0 for the first of them.
    pub(crate) label: usize,
}

/// The constants of one link and of the joint that moves it.
pub(crate) struct Link<'s> {
    /// The link that carries the joint, counted from 0; `None` for the base.
    pub(crate) parent: Option<usize>,
    pub(crate) mount: Mount<'s>,
    pub(crate) kind: JointKind,
    /// The constant part of the joint angle.
    pub(crate) theta: Angle,
    /// The sine and cosine of the angle, if they are known at run time only.
    pub(crate) varying_turn: Option<[Symbol<'s>; 2]>,
    /// (a_i, 0, b_i) of a standard, (0, 0, b_i) of a modified row; b_i without the joint variable.
    pub(crate) offset: Vector<'s>,
    /// Turns components in the link frame of the table into components in frame i.
    pub(crate) table_axes: Matrix<'s>,
    /// From the end of the offset.
    pub(crate) body: Body<'s>,
    /// G² Jm of the joint's rotor, if that belongs to the arm.
    pub(crate) rotor: Option<Symbol<'s>>,
}

/// The matter of a link, or of the base, about a point of it.
pub(crate) struct Body<'s> {
    pub(crate) mass: Symbol<'s>,
    /// Centre of mass from this point.
    pub(crate) com: Vector<'s>,
    /// About the centre of mass.
    pub(crate) inertia: Matrix<'s>,
    /// h, the first moment about the end of `com` that no mass accounts for; `None` of every body.
    pub(crate) first_moment: Option<Vector<'s>>,
}

/// The constants of a robot.
pub(crate) struct Arm<'s> {
    pub(crate) builder: &'s Builder,
    pub(crate) coordinates: Coordinates,
    pub(crate) links: Vec<Link<'s>>,
    /// The rotors that turn on links and on the base.
    pub(crate) spins: Vec<Spin<'s>>,
    /// Where the tip frame is mounted on its link; a frame may stand in its place.
    pub(crate) tip: Mount<'s>,
    /// The link that carries the tip frame, counted from 0; `None` for the base.
    pub(crate) tip_link: Option<usize>,
    /// The tips at which the function that is being written takes a load, with their links: the tip frame, or those
    /// of the list `tips`.
    pub(crate) tips: Vec<(Option<usize>, Mount<'s>)>,
    /// Gravity in frame 0.
    pub(crate) gravity: Vector<'s>,
    /// World → frame 0.
    pub(crate) base: Placement<'s>,
    /// The floating base, if there is one, about the origin of frame 0.
    pub(crate) floating_base: Option<Body<'s>>,
}

impl<'s> Arm<'s> {
    pub(crate) fn new(builder: &'s Builder, robot: &Robot) -> Self {
        let joints = robot.joints.len();
        let zero = || builder.constant(0.0, Cause::Arithmetic);
        let number = |entry: Entry, value: f64| number(builder, robot, entry, value);
        let placed = placed_tips(builder, robot);
        let rows: Vec<Row> = robot.joints.iter().map(Joint::row_with_offset).collect();
        let twists: Vec<_> =
            rows.iter().enumerate().map(|(index, row)| turn_about_x(builder, robot, index, &row.dh.alpha)).collect();
        let floating_base = floating_base(builder, robot);
        let near = builder.origins.clone();
        // where joints are near the arm: from there to the link frame of the table
        let mut ends: Vec<Vector<'s>> = Vec::new();
        let mut links: Vec<Link<'s>> = Vec::with_capacity(joints);
        for (index, row) in rows.iter().enumerate() {
            let (joint, parent) = (index + 1, robot.parent(index));
            let length = || Vector([number(Entry::A(index), row.dh.a), zero(), zero()]);
            let (rotation, lever) = match (beginning(builder, robot, index), robot.convention, parent) {
                (None, Convention::Standard, None) => (identity(builder), builder.zeros(Cause::FirstFrame)),
                (None, Convention::Standard, Some(parent)) => (twists[parent], builder.zeros(Cause::Arithmetic)),
                (None, Convention::Modified, _) => (twists[index], length()),
                (Some(it), Convention::Standard, None) => (it.rotation, it.translation),
                (Some(it), Convention::Standard, Some(parent)) => {
                    (twists[parent] * it.rotation, twists[parent] * it.translation)
                }
                (Some(it), Convention::Modified, _) => {
                    (it.rotation * twists[index], it.rotation * length() + it.translation)
                }
            };
            let end = parent.and_then(|parent| ends.get(parent));
            let lever = end.map_or(lever, |end| *end + lever);
            let along =
                near.as_ref().map(|near| Vector([zero(), zero(), builder.constant(near[index], Cause::Arithmetic)]));
            let lever = along.map_or(lever, |along| lever + rotation * along);
            let is_first = links.iter().all(|link| link.parent != parent);
            let label = if is_first { 0 } else { joint };
            let r = from_com(builder, (&links, floating_base.as_ref()), parent, (label, lever));
            let mount = Mount { rotation, r, lever, label };
            let com = Vector([0, 1, 2].map(|axis| number(Entry::Com(index, axis), row.link.com[axis])));
            let inertia = inertia(builder, robot, index);
            // in a standard table, the twist after joint i is in row i
            let (length, table_axes) = match robot.convention {
                Convention::Standard => (number(Entry::A(index), row.dh.a), Some(twists[index])),
                Convention::Modified => (zero(), None),
            };
            let varying_turn = varying(builder, robot, [Entry::ThetaSine(index), Entry::ThetaCosine(index)]);
            let offset = Vector([length, zero(), number(Entry::D(index), row.dh.d)]);
            let com = table_axes.map_or(com, |axes| axes * com);
            let (offset, com) = match along {
                Some(along) => {
                    let end = offset - along;
                    ends.push(end);
                    (builder.zeros(Cause::Arithmetic), end + com)
                }
                None => (offset, com),
            };
            let written_axes = table_axes.unwrap_or_else(|| identity(builder));
            let (mass, rotor) = (mass(builder, robot, index), rotor(builder, robot, index));
            let inertia = table_axes.map_or(inertia, |axes| (axes * inertia) * axes.transpose());
            let inertia = builder.name_matrix(Quantity::Inertia, joint, inertia);
            let first_moment = row.link.has_first_moment().then(|| {
                let entry = |axis| number(Entry::FirstMoment(index, axis), row.link.first_moment[axis]);
                let written = Vector([0, 1, 2].map(entry));
                let turned = table_axes.map_or(written, |axes| axes * written);
                builder.name_vector(Quantity::MasslessMoment, joint, turned)
            });
            let body = Body { mass, com, inertia, first_moment };
            let (kind, theta) = (row.kind, row.dh.theta);
            links.push(Link {
                parent,
                mount,
                kind,
                theta,
                varying_turn,
                offset,
                body,
                table_axes: written_axes,
                rotor,
            });
        }
        let tips = mounted((builder, robot), (&links, floating_base.as_ref()), (&twists, &ends), placed);
        let (tip_link, tip) = tips[0];
        let spins = Spin::all(builder, robot, &twists);
        Self {
            builder,
            coordinates: Coordinates::of(robot),
            links,
            spins,
            tip,
            tip_link,
            tips,
            gravity: gravity(builder, robot),
            base: Placement::new(builder, robot, &robot.base, Entry::BaseXyz),
            floating_base,
        }
    }

    /// The mount of what a link carries on the way to the tip: the next joint, or the tip.
    pub(crate) fn carried_by(&self, index: usize) -> &Mount<'s> {
        self.carried_joints(index).find(|(joint, _)| self.moves_tip(*joint)).map_or(&self.tip, |(_, link)| &link.mount)
    }

    /// The joints that a link carries, counted from 0.
    pub(crate) fn carried_joints(&self, index: usize) -> impl Iterator<Item = (usize, &Link<'s>)> {
        self.links.iter().enumerate().filter(move |(_, link)| link.parent == Some(index))
    }

    /// The element that belongs to the link of the tip.
    pub(crate) fn at_tip<'a, T>(&self, of_links: &'a [T]) -> Option<&'a T> {
        of_links.get(self.tip_link?)
    }

    /// Whether a joint moves the tip frame.
    pub(crate) fn moves_tip(&self, joint: usize) -> bool {
        self.moves(joint, self.tip_link)
    }

    /// Whether a joint moves one of the tips.
    pub(crate) fn moves_a_tip(&self, joint: usize) -> bool {
        self.tips.iter().any(|(on, _)| self.moves(joint, *on))
    }

    /// Whether a joint moves a link, `None` for the base: it is the joint of this link, or of one that carries it.
    pub(crate) fn moves(&self, joint: usize, link: Option<usize>) -> bool {
        std::iter::successors(link, |&index| self.links[index].parent).any(|index| index == joint)
    }
}

/// The tips, or the frame in their place, in the link frames of the table.
fn placed_tips<'s>(builder: &'s Builder, robot: &Robot) -> Vec<(Option<usize>, Placement<'s>)> {
    let frame = builder.function.frame(robot);
    let tips = match frame {
        Some(frame) => vec![robot.fixed_frame(frame)],
        None if builder.function.has_tips() => robot.wrench_frames(),
        None => vec![robot.tip()],
    };
    let placed = |(tip, FixedFrame { on, placement }): (usize, &FixedFrame)| {
        let entry = |axis| match frame {
            Some(FrameId::Named(frame)) => Entry::FrameXyz(frame, axis),
            None if builder.function.has_tips() => robot.tip_entry(tip, axis),
            // the placement of a link frame is no entry, and zero
            _ => Entry::ToolXyz(axis),
        };
        (*on, Placement::new(builder, robot, placement, entry))
    };
    tips.iter().enumerate().map(placed).collect()
}

/// Where tips are mounted on their links. Of a frame in the place of the tip there is one.
fn mounted<'s>(
    (builder, robot): (&'s Builder, &Robot),
    (links, floating_base): (&[Link<'s>], Option<&Body<'s>>),
    (twists, ends): (&[Matrix<'s>], &[Vector<'s>]),
    placed: Vec<(Option<usize>, Placement<'s>)>,
) -> Vec<(Option<usize>, Mount<'s>)> {
    let frame = builder.function.frame(robot);
    let mut tips: Vec<(Option<usize>, Mount<'s>)> = Vec::with_capacity(placed.len());
    for (index, (link, at)) in placed.into_iter().enumerate() {
        let (rotation, lever) = match (robot.convention, link.map(|link| &twists[link])) {
            (Convention::Standard, Some(&twist)) => (twist * at.rotation, twist * at.translation),
            _ => (at.rotation, at.translation),
        };
        let lever = link.and_then(|link| ends.get(link)).map_or(lever, |end| *end + lever);
        let tip = links.len() + 1 + index;
        let is_first = links.iter().all(|other| other.parent != link) && tips.iter().all(|(on, _)| *on != link);
        let label = if is_first { 0 } else { tip };
        // a frame carries no load, and its link has a lever to the next joint already
        let r = match frame {
            Some(_) => builder.zeros(Cause::FreeTip),
            None => from_com(builder, (links, floating_base), link, (label, lever)),
        };
        let rotation = builder.name_matrix(Quantity::TipRotation, tip, rotation);
        tips.push((link, Mount { rotation, r, lever, label }));
    }
    tips
}

/// Where a row of a tree begins in the link frame of its parent, if not there. Run-time parameters do not change it.
fn beginning<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Option<Placement<'s>> {
    let placement = robot.joints.get(index)?.branch?.placement;
    (!placement.is_identity()).then(|| Placement::constant(builder, &placement))
}

/// A lever from the parent's centre of mass. A base that stands still moves no point of itself, whatever the lever is.
/// If the function has the motion of a base without `floating_base`, the lever begins at the origin of frame 0.
fn from_com<'s>(
    builder: &'s Builder,
    (links, floating_base): (&[Link<'s>], Option<&Body<'s>>),
    parent: Option<usize>,
    (label, lever): (usize, Vector<'s>),
) -> Vector<'s> {
    let from = |line: usize, com| builder.joint(line).carrying(label).name_vector(Quantity::R, lever - com);
    match (parent, floating_base) {
        (Some(parent), _) => from(parent + 1, links[parent].body.com),
        (None, Some(base)) => from(0, base.com),
        (None, None) if builder.function.takes(Argument::Base) => lever,
        (None, None) => builder.zeros(Cause::FixedBase),
    }
}

/// The floating base: without mass, where the file has no `floating_base` and the function returns the
/// wrench on the base.
fn floating_base<'s>(builder: &'s Builder, robot: &Robot) -> Option<Body<'s>> {
    let (function, base) = (builder.function, robot.floating_base.as_ref().map(|base| base.link));
    let link = base.or_else(|| function.is_of_floating_base().then(rne_model::Link::default))?;
    let rows = link.inertia.rows();
    let inertia = rows.map(|row| row.map(|x| builder.constant(x, Cause::Arithmetic)));
    Some(Body {
        mass: builder.entry(Name::scalar(Quantity::Mass, 0), link.mass),
        com: Vector(link.com.map(|x| builder.constant(x, Cause::Arithmetic))),
        inertia: builder.name_matrix(Quantity::Inertia, 0, Matrix::from_rows(inertia)),
        first_moment: None,
    })
}

/// The mass of a link. A constant mass has its name as the cause.
fn mass<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Symbol<'s> {
    let name = Name::scalar(Quantity::Mass, index + 1);
    match robot.run_time.formula(Entry::Mass(index)) {
        Some(written) => builder.name(name, formula(builder, written)),
        None => builder.entry(name, robot.joints[index].row.link.mass),
    }
}

/// A constant placement: frame n → tip frame, or world → frame 0.
#[derive(Clone, Copy)]
pub(crate) struct Placement<'s> {
    pub(crate) rotation: Matrix<'s>,
    pub(crate) translation: Vector<'s>,
}

impl<'s> Placement<'s> {
    /// R = (Rz(yaw) Ry(pitch)) Rx(roll); `xyz` are the entries of the translation.
    fn new(builder: &'s Builder, robot: &Robot, transform: &Transform, xyz: impl Fn(usize) -> Entry) -> Self {
        let translation = [0, 1, 2].map(|axis| number(builder, robot, xyz(axis), transform.xyz[axis]));
        Self { translation: Vector(translation), ..Self::constant(builder, transform) }
    }

    /// With a constant translation.
    pub(crate) fn constant(builder: &'s Builder, transform: &Transform) -> Self {
        let translation = transform.xyz.map(|x| builder.constant(x, Cause::Arithmetic));
        let [roll, pitch, yaw] = transform.rpy.map(|angle| builder.constant_turn(&angle, Cause::Arithmetic));
        let turn = |axis, turn| turned(builder, axis, turn, Cause::Arithmetic);
        let rotation = (turn(Axis::Z, yaw) * turn(Axis::Y, pitch)) * turn(Axis::X, roll);
        Self { rotation, translation: Vector(translation) }
    }
}

/// G² Jm at a joint, of a robot that is taken with its rotors.
fn rotor<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Option<Symbol<'s>> {
    let motor = robot.joints.get(index)?.motor.filter(|_| robot.rotors)?;
    let ratio = number(builder, robot, Entry::GearRatio(index), motor.gear_ratio);
    let inertia = (ratio * ratio) * number(builder, robot, Entry::MotorInertia(index), motor.inertia);
    Some(builder.name(Name::scalar(Quantity::RotorInertia, index + 1), inertia))
}

/// A number of the table: a constant, or a formula over what is known at run time only.
pub(crate) fn number<'s>(builder: &'s Builder, robot: &Robot, entry: Entry, value: f64) -> Symbol<'s> {
    match robot.run_time.formula(entry) {
        Some(written) => formula(builder, written),
        None => builder.constant(value, Cause::Arithmetic),
    }
}

fn formula<'s>(builder: &'s Builder, written: &Formula) -> Symbol<'s> {
    let symbol = |written: &Formula| formula(builder, written);
    match written {
        Formula::Number(value) => builder.constant(*value, Cause::Arithmetic),
        Formula::Parameter(index) => builder.argument(Name::scalar(Quantity::Parameter, index + 1)),
        Formula::Negative(a) => -symbol(a),
        Formula::Sum(a, b) => symbol(a) + symbol(b),
        Formula::Difference(a, b) => symbol(a) - symbol(b),
        Formula::Product(a, b) => symbol(a) * symbol(b),
        Formula::Quotient(a, b) => {
            let (a, b) = (symbol(a), symbol(b));
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

/// Two numbers that are known at run time only.
fn varying<'s>(builder: &'s Builder, robot: &Robot, entries: [Entry; 2]) -> Option<[Symbol<'s>; 2]> {
    let [a, b] = entries.map(|entry| robot.run_time.formula(entry));
    Some([formula(builder, a?), formula(builder, b?)])
}

/// Rx(α) of a row of the table.
fn turn_about_x<'s>(builder: &'s Builder, robot: &Robot, index: usize, alpha: &Angle) -> Matrix<'s> {
    let [s, c] = varying(builder, robot, [Entry::AlphaSine(index), Entry::AlphaCosine(index)])
        .unwrap_or_else(|| builder.constant_turn(alpha, Cause::Arithmetic).into());
    let s = builder.name(Name::scalar(Quantity::TwistSine, index + 1), s);
    let c = builder.name(Name::scalar(Quantity::TwistCosine, index + 1), c);
    turned(builder, Axis::X, (s, c), Cause::TurnAboutX)
}

/// A rotation about an axis by sine and cosine; `cause` is the reason why it does not change the axis.
pub(crate) fn turned<'s>(
    builder: &'s Builder,
    axis: Axis,
    (s, c): (Symbol<'s>, Symbol<'s>),
    cause: Cause,
) -> Matrix<'s> {
    let [zero, one] = [0.0, 1.0].map(|value| builder.constant(value, cause));
    Matrix::from_rows(match axis {
        Axis::X => [[one, zero, zero], [zero, c, -s], [zero, s, c]],
        Axis::Y => [[c, zero, s], [zero, one, zero], [-s, zero, c]],
        Axis::Z => [[c, -s, zero], [s, c, zero], [zero, zero, one]],
    })
}

/// α_0 of a standard table is 0.
pub(crate) fn identity(builder: &Builder) -> Matrix<'_> {
    let (zero, one) = (builder.constant(0.0, Cause::FirstFrame), builder.constant(1.0, Cause::FirstFrame));
    Matrix::from_rows([[one, zero, zero], [zero, one, zero], [zero, zero, one]])
}

/// Gravity in frame 0. The trace records that a zero component is due to the direction of gravity.
pub(crate) fn gravity<'s>(builder: &'s Builder, robot: &Robot) -> Vector<'s> {
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
