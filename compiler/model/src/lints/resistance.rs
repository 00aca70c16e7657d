//! Joints and floating bases that no inertia resists: the mass matrix is singular in every state.

use crate::robot::parent;
use crate::{Angle, Convention, FixedFrame, Joint, JointKind, Link, Row};

/// An inertia is taken for rounding if it is below this part of the largest moment that the links could have at their
/// distance from the base.
const ROUNDING: f64 = 1e-12;

/// Number of states at which resistance is computed, at irrational parts of a turn. A joint without resistance at all
/// of them never has any, because the determinant of the mass matrix is analytic in the positions.
const STATES: u32 = 3;

/// Number of rows of a floating base in the mass matrix: three along the axes of frame 0, then three about them.
const BASE: usize = 6;

const UNIT: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A joint that no inertia resists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unresisted {
    /// Even with all other joints at rest the joint moves no mass and turns no inertia.
    Alone,
    /// The joint moves without resistance if distal joints move against it.
    WithOthers,
}

/// Returns for each joint, base to tip, how it lacks resistance; `None` where an inertia resists it.
///
/// The mass matrix is M(q) = Σ m Jvᵀ Jv + Jωᵀ I Jω over the links (Siciliano et al., Robotics, 2009, 7.32); a link with
/// a first moment h beside `com` adds Jvᵀ (Jω × h) and its transpose. M is factorised as Lᵀ L from the tip to the base:
/// the pivot of a joint is the inertia that resists it while all distal joints move freely. Only the link of the joint
/// itself, and links before it, cannot move away, so the joint's own link is the one that a message names.
pub(crate) fn unresisted(convention: Convention, joints: &[Joint]) -> Vec<Option<Unresisted>> {
    let mut all = vec![Some(Unresisted::Alone); joints.len()];
    for state in 1..=STATES {
        for (known, found) in all.iter_mut().zip(in_state(convention, joints, None, state)) {
            *known = match (*known, found) {
                (Some(Unresisted::Alone), Some(Unresisted::Alone)) => Some(Unresisted::Alone),
                (Some(_), Some(_)) => Some(Unresisted::WithOthers),
                _ => None,
            };
        }
    }
    all
}

/// Returns whether a floating base with this link moves in some direction without any force or moment on it, while all
/// joints move freely.
pub(crate) fn base_is_unresisted(convention: Convention, joints: &[Joint], base: &Link) -> bool {
    (1..=STATES).all(|state| in_state(convention, joints, Some(base), state)[..BASE].iter().any(Option::is_some))
}

/// Returns how each row of the mass matrix lacks resistance at a state: the rows of a floating base, if there is one,
/// then those of the joints.
fn in_state(convention: Convention, joints: &[Joint], base: Option<&Link>, state: u32) -> Vec<Option<Unresisted>> {
    let (whole, reach) = mass_matrix(convention, joints, base, state);
    let mut matrix = whole.clone();
    let mut found = vec![None; reach.len()];
    for row in (0..reach.len()).rev() {
        let least = ROUNDING * reach[row];
        let pivot = matrix[row][row];
        if pivot <= least {
            found[row] = Some(if whole[row][row] <= least { Unresisted::Alone } else { Unresisted::WithOthers });
            continue;
        }
        let column: Vec<f64> = (0..row).map(|before| matrix[before][row]).collect();
        for (before, a) in column.iter().enumerate() {
            for (of, b) in column.iter().enumerate() {
                matrix[before][of] -= a * b / pivot;
            }
        }
    }
    found
}

type Vector = [f64; 3];

/// Returns the mass matrix, and for each row the largest moment that the distal links could have at their distance from
/// the base, which rounding errors are relative to.
fn mass_matrix(convention: Convention, joints: &[Joint], base: Option<&Link>, state: u32) -> (Vec<Vec<f64>>, Vec<f64>) {
    let first = if base.is_some() { BASE } else { 0 };
    let size = first + joints.len();
    let (mut matrix, mut reach) = (vec![vec![0.0; size]; size], vec![0.0; size]);
    let frames = frames(convention, joints, state);
    let of_joints = joints.iter().zip(&frames).enumerate().map(|(index, (joint, frame))| {
        let carriers: Vec<usize> = core::iter::successors(Some(index), |&joint| parent(joints, joint)).collect();
        (&joint.row.link, frame.rotation, frame.origin, carriers)
    });
    for (link, rotation, origin, carriers) in
        base.map(|link| (link, UNIT, [0.0; 3], Vec::new())).into_iter().chain(of_joints)
    {
        let com = add(origin, turned(&rotation, link.com));
        let trace = link.inertia.xx + link.inertia.yy + link.inertia.zz;
        let moment = link.has_first_moment().then_some(link.first_moment);
        let moment_size = libm::sqrt(dot(link.first_moment, link.first_moment));
        // the moments of an unphysical link may have any sign
        let trace = if moment.is_some() { trace.abs() } else { trace };
        let mut about = |row: usize, axis: Vector, foot: Vector| {
            reach[row] += link.mass * (dot(com, com) + dot(foot, foot)) + trace;
            reach[row] += moment_size * (libm::sqrt(dot(com, com)) + libm::sqrt(dot(foot, foot)));
            (row, cross(axis, sub(com, foot)), turned_back(&rotation, axis))
        };
        // for each joint that carries the link: velocity of the centre of mass, and angular velocity in the axes of the
        // link
        let mut columns: Vec<(usize, Vector, Vector)> = Vec::new();
        for carrier in carriers {
            let Frame { axis, foot, .. } = &frames[carrier];
            columns.push(match joints[carrier].row.kind {
                JointKind::Revolute => about(first + carrier, *axis, *foot),
                JointKind::Prismatic => (first + carrier, *axis, [0.0; 3]),
            });
        }
        if base.is_some() {
            columns.extend(UNIT.iter().enumerate().map(|(row, axis)| (row, *axis, [0.0; 3])));
            columns.extend(UNIT.iter().enumerate().map(|(row, axis)| about(BASE / 2 + row, *axis, [0.0; 3])));
        }
        for (row, _, _) in columns.iter().filter(|(_, _, w)| *w == [0.0; 3]) {
            reach[*row] += link.mass;
        }
        let tensor = link.inertia.rows();
        for (row, v, w) in &columns {
            let spin = tensor.map(|line| dot(line, *w));
            for (column, other_v, other_w) in &columns {
                matrix[*row][*column] += link.mass * dot(*v, *other_v) + dot(spin, *other_w);
                if let Some(h) = moment {
                    let [own, other] = [w, other_w].map(|w| turned(&rotation, cross(*w, h)));
                    matrix[*row][*column] += dot(*v, other) + dot(*other_v, own);
                }
            }
        }
    }
    (matrix, reach)
}

/// A link frame in the axes of frame 0, with the axis of the joint that moves the link.
struct Frame {
    rotation: [Vector; 3],
    origin: Vector,
    axis: Vector,
    /// A point on the axis.
    foot: Vector,
}

fn frames(convention: Convention, joints: &[Joint], state: u32) -> Vec<Frame> {
    let mut frames: Vec<Frame> = Vec::with_capacity(joints.len());
    for (index, joint) in joints.iter().enumerate() {
        let Row { kind, dh, .. } = &joint.row;
        let carrier = parent(joints, index).and_then(|parent| frames.get(parent));
        let (mut rotation, mut origin) = carrier.map_or((UNIT, [0.0; 3]), |it| (it.rotation, it.origin));
        if let Some(FixedFrame { placement, .. }) = joint.branch {
            origin = add(origin, turned(&rotation, placement.xyz));
            rotation = product(&rotation, &turn(placement.rpy));
        }
        // multiples of the golden ratio: no joint is at a right angle, and no two joints have equal positions
        #[allow(clippy::cast_precision_loss)] // small numbers
        let q = 0.3 + 1.618_033_988_749_895 * ((index + 1) as f64 * f64::from(state)).rem_euclid(3.7);
        let (theta, d) = match kind {
            JointKind::Revolute => (dh.theta.radians + q, dh.d),
            JointKind::Prismatic => (dh.theta.radians, dh.d + q),
        };
        let (sin, cos) = libm::sincos(theta);
        let z = [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let x = [[1.0, 0.0, 0.0], [0.0, dh.alpha.cos, -dh.alpha.sin], [0.0, dh.alpha.sin, dh.alpha.cos]];
        frames.push(match convention {
            Convention::Standard => {
                let axis = turned(&rotation, [0.0, 0.0, 1.0]);
                let turn = product(&rotation, &z);
                let end = add(origin, turned(&turn, [dh.a, 0.0, d]));
                Frame { rotation: product(&turn, &x), origin: end, axis, foot: origin }
            }
            Convention::Modified => {
                let turn = product(&rotation, &x);
                let foot = add(origin, turned(&rotation, [dh.a, 0.0, 0.0]));
                let axis = turned(&turn, [0.0, 0.0, 1.0]);
                let end = add(foot, turned(&turn, [0.0, 0.0, d]));
                Frame { rotation: product(&turn, &z), origin: end, axis, foot }
            }
        });
    }
    frames
}

/// Returns the rotation Rz(yaw) Ry(pitch) Rx(roll).
fn turn([roll, pitch, yaw]: [Angle; 3]) -> [Vector; 3] {
    let x = [[1.0, 0.0, 0.0], [0.0, roll.cos, -roll.sin], [0.0, roll.sin, roll.cos]];
    let y = [[pitch.cos, 0.0, pitch.sin], [0.0, 1.0, 0.0], [-pitch.sin, 0.0, pitch.cos]];
    let z = [[yaw.cos, -yaw.sin, 0.0], [yaw.sin, yaw.cos, 0.0], [0.0, 0.0, 1.0]];
    product(&product(&z, &y), &x)
}

fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn turned(rotation: &[Vector; 3], v: Vector) -> Vector {
    rotation.map(|row| dot(row, v))
}

fn turned_back(rotation: &[Vector; 3], v: Vector) -> Vector {
    [0, 1, 2].map(|column| dot(rotation.map(|row| row[column]), v))
}

fn product(a: &[Vector; 3], b: &[Vector; 3]) -> [Vector; 3] {
    a.map(|row| [0, 1, 2].map(|column| dot(row, b.map(|row| row[column]))))
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;
    use crate::Robot;

    /// Tests an arm of revolute joints about parallel z axes: each entry has the length of a link and the text under
    /// its key `link`.
    fn planar(links: &[(f64, &str)]) -> Vec<Option<Unresisted>> {
        let mut text = "format: 1\nname: x\nsource: x\nconvention: standard\ngravity: [0, 0, 0]\njoints:\n".to_owned();
        for (length, link) in links {
            let dh = format!("{{theta: 0, d: 0, a: {length}, alpha: 0}}");
            let _ = writeln!(text, "  - {{type: revolute, dh: {dh}, link: {{{link}}}}}");
        }
        let robot = Robot::from_yaml(&text).unwrap();
        unresisted(robot.convention, &robot.joints)
    }

    #[test]
    fn a_bar_resists_and_a_massless_one_does_not() {
        let bar = "mass: 2, com: [-0.2, 0, 0]";
        assert_eq!(planar(&[(0.4, bar)]), [None]);
        assert_eq!(planar(&[(0.4, "")]), [Some(Unresisted::Alone)]);
        assert_eq!(planar(&[(0.4, bar), (0.4, "")]), [None, Some(Unresisted::Alone)]);
        // the second link has a mass, which resists the first joint, too
        assert_eq!(planar(&[(0.4, ""), (0.4, bar)]), [None, None]);
        // the mass of the second link is on its own joint axis
        assert_eq!(planar(&[(0.4, bar), (0.4, "mass: 2, com: [-0.4, 0, 0]")]), [None, Some(Unresisted::Alone)]);
        assert_eq!(planar(&[(0.0, "inertia: {zz: 0.1}")]), [None]);
    }

    #[test]
    fn a_first_moment_resists_without_mass() {
        // about the joint, 0.4 m away, the first moment gives 2 · 0.3 · 0.4 kg m²
        let moment = "first_moment: [0.3, 0, 0], physical: false";
        assert_eq!(planar(&[(0.4, moment)]), [None]);
        assert_eq!(planar(&[(0.4, &format!("{moment}, inertia: {{zz: -0.24}}"))]), [Some(Unresisted::Alone)]);
        assert_eq!(planar(&[(0.0, moment)]), [Some(Unresisted::Alone)]);
        // the first joint moves this link sideways, which gives 2 · 0.3 · 0.4 kg m² again; about its own joint it has
        // nothing
        assert_eq!(planar(&[(0.4, "inertia: {zz: 1}"), (0.0, moment)]), [None, Some(Unresisted::Alone)]);
    }

    #[test]
    fn two_joints_on_one_axis_need_two_inertias() {
        let bar = "mass: 2, com: [-0.2, 0, 0]";
        assert_eq!(planar(&[(0.0, ""), (0.4, bar)]), [Some(Unresisted::WithOthers), None]);
        assert_eq!(planar(&[(0.0, "inertia: {zz: 0.001}"), (0.4, bar)]), [None, None]);
    }

    /// Tests a floating base with the link `base` and legs: each leg has the text of its key `dh` and that under its
    /// `link`.
    fn floating(base: &str, legs: &[(&str, &str)]) -> bool {
        let mut text = format!(
            "format: 2\nname: x\nsource: x\nconvention: modified\ngravity: [0, 0, 0]\ntool: {{on: j0}}\n\
             floating_base: {{name: trunk, link: {{{base}}}}}\njoints:\n"
        );
        for (index, (dh, link)) in legs.iter().enumerate() {
            let dh = format!("{{theta: 0, d: 0, gamma: 0, b: 0, {dh}}}");
            let _ = writeln!(text, "  - {{name: j{index}, parent: base, type: revolute, dh: {dh}, link: {{{link}}}}}");
        }
        let robot = crate::Reader::new("x").trees().read(&text).unwrap().robot;
        base_is_unresisted(robot.convention, &robot.joints, &robot.floating_base.unwrap().link)
    }

    #[test]
    fn a_base_without_mass_needs_two_legs_on_different_axes() {
        const BODY: &str = "mass: 2, com: [0.1, 0.2, 0.3], inertia: {xx: 0.2, yy: 0.3, zz: 0.4}";
        let (about_z, about_y) = (("a: 0.3, alpha: 0", BODY), ("a: 0.3, alpha: pi/2", BODY));
        assert!(!floating(BODY, &[about_z]));
        assert!(!floating(BODY, &[("a: 0.3, alpha: 0", "")]), "the base alone is resisted, the joint is not");
        assert!(floating("mass: 0", &[("a: 0.3, alpha: 0", "")]));
        // the base turns about the axis of its only leg
        assert!(floating("mass: 0", &[about_z]));
        assert!(!floating("mass: 0", &[about_z, about_y]));
        // with both leg axes on one line the base turns about it; with two parallel axes apart from each other it
        // cannot
        assert!(floating("mass: 0", &[about_z, about_z]));
        assert!(!floating("mass: 0", &[about_z, ("a: -0.3, alpha: 0", BODY)]));
        // two point masses have six degrees of freedom, but this robot has seven
        assert!(floating("mass: 2", &[("a: 0.3, alpha: 0", "mass: 2, com: [0.1, 0, 0]")]));
    }

    #[test]
    fn a_point_mass_resists_two_joints_of_a_plane() {
        let point = (0.4, "mass: 2");
        assert_eq!(planar(&[(0.4, ""), point]), [None, None]);
        assert_eq!(planar(&[(0.4, ""), (0.4, ""), point]), [Some(Unresisted::WithOthers), None, None]);
    }
}
