//! Converts the rows of the table to the constants of the seven steps, in form P: frame i is at joint i, fixed to link
//! i.
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
//! p is the parent link, n the link of the tip. Row i of a modified table has the twist and the length before joint i.
//! On the base the rotation of a standard table is 1. R_t and p_t are the rotation and the translation of the tool.
//!
//! In a tree a row may begin at a placement R_b, p_b in the link frame of its parent. Then the placement comes before
//! the row:
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
    /// Rotation from the axes of the joint at θ = 0, or of the tip frame, to the axes of the parent.
    pub(crate) rotation: Matrix<'s>,
    /// Vector from the parent's centre of mass (for the base: from the origin of frame 0) to the joint or the tip.
    pub(crate) r: Vector<'s>,
    /// Vector to the joint or the tip from the end of the parent's offset, where the link frame of the table is.
    pub(crate) lever: Vector<'s>,
    /// Number that distinguishes the joints and tips of one parent; 0 for the first of them.
    pub(crate) label: usize,
}

/// The constants of one link, and of the joint that moves it relative to its parent.
pub(crate) struct Link<'s> {
    /// The link that carries the joint, counted from 0; `None` for the base.
    pub(crate) parent: Option<usize>,
    pub(crate) mount: Mount<'s>,
    pub(crate) kind: JointKind,
    /// The constant part of the joint angle.
    pub(crate) theta: Angle,
    /// The sine and cosine of the angle, if they are known at run time only.
    pub(crate) varying_turn: Option<[Symbol<'s>; 2]>,
    /// (a_i, 0, b_i) of a standard row, (0, 0, b_i) of a modified row; b_i without the joint variable.
    pub(crate) offset: Vector<'s>,
    /// Rotation from the axes of the link frame of the table to those of frame i.
    pub(crate) table_axes: Matrix<'s>,
    /// Mass, centre of mass and inertia of the link; the centre of mass is from the end of the offset.
    pub(crate) body: Body<'s>,
    /// G² Jm of the joint's rotor, if the rotor belongs to the arm.
    pub(crate) rotor: Option<Symbol<'s>>,
}

/// Mass, centre of mass and inertia of a link, or of the base, about a reference point fixed to it.
pub(crate) struct Body<'s> {
    pub(crate) mass: Symbol<'s>,
    /// Vector from the reference point to the centre of mass.
    pub(crate) com: Vector<'s>,
    /// Inertia about the centre of mass.
    pub(crate) inertia: Matrix<'s>,
    /// First moment h about the end of `com` that is given in addition to the mass; `None` for a body with physical
    /// parameters. Only sets of base parameters have it.
    pub(crate) first_moment: Option<Vector<'s>>,
}

/// The constants of a robot.
pub(crate) struct Arm<'s> {
    pub(crate) builder: &'s Builder,
    pub(crate) coordinates: Coordinates,
    pub(crate) links: Vec<Link<'s>>,
    /// The rotors of the list `motors`, which turn on links and on the base.
    pub(crate) spins: Vec<Spin<'s>>,
    /// Where the tip frame is mounted on its link; if the function is about another frame, where that frame is mounted.
    pub(crate) tip: Mount<'s>,
    /// The link that carries the tip frame, counted from 0; `None` for the base.
    pub(crate) tip_link: Option<usize>,
    /// The tips at which the function takes a load, each with its link: the tip frame, or the tips of the list `tips`.
    pub(crate) tips: Vec<(Option<usize>, Mount<'s>)>,
    /// Gravity in frame 0.
    pub(crate) gravity: Vector<'s>,
    /// Placement of frame 0 in the world.
    pub(crate) base: Placement<'s>,
    /// The floating base, if there is one; its reference point is the origin of frame 0.
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
        // for joint frames that are placed near the arm: the vectors from these frames to the link frames of the table
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
            // row i of a standard table has the twist after joint i, so its link frame is turned by that twist
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

    /// Returns the mount of the next joint on the way from a link to the tip, or that of the tip if no joint is left.
    pub(crate) fn carried_by(&self, index: usize) -> &Mount<'s> {
        self.carried_joints(index).find(|(joint, _)| self.moves_tip(*joint)).map_or(&self.tip, |(_, link)| &link.mount)
    }

    /// Returns the joints that a link carries, counted from 0.
    pub(crate) fn carried_joints(&self, index: usize) -> impl Iterator<Item = (usize, &Link<'s>)> {
        self.links.iter().enumerate().filter(move |(_, link)| link.parent == Some(index))
    }

    /// Returns the element for the link that carries the tip; `None` if the base carries it.
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

    /// Whether a joint moves a link (`None`: the base): it is the joint of this link, or that of a link before it in
    /// the chain.
    pub(crate) fn moves(&self, joint: usize, link: Option<usize>) -> bool {
        std::iter::successors(link, |&index| self.links[index].parent).any(|index| index == joint)
    }
}

/// Returns the placements of the tips in the link frames of the table; if the function is about another frame, returns
/// that frame only.
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
            // the frame of a link has the placement zero, which is no entry of the robot
            _ => Entry::ToolXyz(axis),
        };
        (*on, Placement::new(builder, robot, placement, entry))
    };
    tips.iter().enumerate().map(placed).collect()
}

/// Returns where tips are mounted on their links. If the function is about another frame, there is only that frame.
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
        // a frame carries no load, so its lever from the centre of mass is not used; the link's lever to the next joint
        // exists
        let r = match frame {
            Some(_) => builder.zeros(Cause::FreeTip),
            None => from_com(builder, (links, floating_base), link, (label, lever)),
        };
        let rotation = builder.name_matrix(Quantity::TipRotation, tip, rotation);
        tips.push((link, Mount { rotation, r, lever, label }));
    }
    tips
}

/// Returns the placement at which a row of a tree begins in the link frame of its parent; `None` if it is the identity.
/// It does not depend on run-time parameters.
fn beginning<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Option<Placement<'s>> {
    let placement = robot.joints.get(index)?.branch?.placement;
    (!placement.is_identity()).then(|| Placement::constant(builder, &placement))
}

/// Returns a lever from the parent's centre of mass. On a fixed base it is zero, because no point of the base moves. If
/// the motion of the base is an argument but the robot has no `floating_base`, the lever begins at the origin of frame
/// 0.
fn from_com<'s>(
    builder: &'s Builder,
    (links, floating_base): (&[Link<'s>], Option<&Body<'s>>),
    parent: Option<usize>,
    (label, lever): (usize, Vector<'s>),
) -> Vector<'s> {
    let from = |line: usize, com| builder.joint(line).with_second_number(label).name_vector(Quantity::R, lever - com);
    match (parent, floating_base) {
        (Some(parent), _) => from(parent + 1, links[parent].body.com),
        (None, Some(base)) => from(0, base.com),
        (None, None) if builder.function.takes(Argument::Base) => lever,
        (None, None) => builder.zeros(Cause::FixedBase),
    }
}

/// Returns the floating base. Its mass is zero where the robot has no `floating_base` and the function returns the
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

/// Returns the mass of a link as a named symbol. The trace gives that name as the cause of a constant mass.
fn mass<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Symbol<'s> {
    let name = Name::scalar(Quantity::Mass, index + 1);
    match robot.run_time.formula(Entry::Mass(index)) {
        Some(written) => builder.name(name, formula(builder, written)),
        None => builder.entry(name, robot.joints[index].row.link.mass),
    }
}

/// A constant placement: of the tip frame in frame n, or of frame 0 in the world.
#[derive(Clone, Copy)]
pub(crate) struct Placement<'s> {
    pub(crate) rotation: Matrix<'s>,
    pub(crate) translation: Vector<'s>,
}

impl<'s> Placement<'s> {
    /// Returns a placement with R = (Rz(yaw) Ry(pitch)) Rx(roll); `xyz` gives the entry of each translation component.
    fn new(builder: &'s Builder, robot: &Robot, transform: &Transform, xyz: impl Fn(usize) -> Entry) -> Self {
        let translation = [0, 1, 2].map(|axis| number(builder, robot, xyz(axis), transform.xyz[axis]));
        Self { translation: Vector(translation), ..Self::constant(builder, transform) }
    }

    /// Returns a placement whose translation does not depend on run-time parameters.
    pub(crate) fn constant(builder: &'s Builder, transform: &Transform) -> Self {
        let translation = transform.xyz.map(|x| builder.constant(x, Cause::Arithmetic));
        let [roll, pitch, yaw] = transform.rpy.map(|angle| builder.constant_turn(&angle, Cause::Arithmetic));
        let turn = |axis, turn| turned(builder, axis, turn, Cause::Arithmetic);
        let rotation = (turn(Axis::Z, yaw) * turn(Axis::Y, pitch)) * turn(Axis::X, roll);
        Self { rotation, translation: Vector(translation) }
    }
}

/// Returns G² Jm of a joint, if the robot includes the inertia of its rotors.
fn rotor<'s>(builder: &'s Builder, robot: &Robot, index: usize) -> Option<Symbol<'s>> {
    let motor = robot.joints.get(index)?.motor.filter(|_| robot.rotors)?;
    let ratio = number(builder, robot, Entry::GearRatio(index), motor.gear_ratio);
    let inertia = (ratio * ratio) * number(builder, robot, Entry::MotorInertia(index), motor.inertia);
    Some(builder.name(Name::scalar(Quantity::RotorInertia, index + 1), inertia))
}

/// Returns a number of the table: a constant, or a formula over parameters that are known at run time only.
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

/// Returns the inertia of a link about its centre of mass.
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

/// Returns two numbers if they are known at run time only, otherwise `None`.
fn varying<'s>(builder: &'s Builder, robot: &Robot, entries: [Entry; 2]) -> Option<[Symbol<'s>; 2]> {
    let [a, b] = entries.map(|entry| robot.run_time.formula(entry));
    Some([formula(builder, a?), formula(builder, b?)])
}

/// Returns Rx(α) of a row of the table.
fn turn_about_x<'s>(builder: &'s Builder, robot: &Robot, index: usize, alpha: &Angle) -> Matrix<'s> {
    let [s, c] = varying(builder, robot, [Entry::AlphaSine(index), Entry::AlphaCosine(index)])
        .unwrap_or_else(|| builder.constant_turn(alpha, Cause::Arithmetic).into());
    let s = builder.name(Name::scalar(Quantity::TwistSine, index + 1), s);
    let c = builder.name(Name::scalar(Quantity::TwistCosine, index + 1), c);
    turned(builder, Axis::X, (s, c), Cause::TurnAboutX)
}

/// Returns the rotation about an axis with the given sine and cosine. `cause` explains in the trace why some of its
/// elements are 0 and 1.
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

/// Returns the rotation 1 of the base, because α_0 of a standard table is 0.
pub(crate) fn identity(builder: &Builder) -> Matrix<'_> {
    let (zero, one) = (builder.constant(0.0, Cause::FirstFrame), builder.constant(1.0, Cause::FirstFrame));
    Matrix::from_rows([[one, zero, zero], [zero, one, zero], [zero, zero, one]])
}

/// Returns gravity in frame 0. The trace records that a zero component is due to the direction of gravity.
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
