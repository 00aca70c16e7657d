//! The list `motors`: motors that turn with several joints, and rotors that turn on the links that carry them.

use crate::parts::coupling::ratios;
use crate::parts::frame::{carrier, joint_names};
use crate::parts::tree::items;
use crate::parts::varying::fixed;
use crate::robot::parent;
use crate::text::decode::{Context, list, not_negative, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::schema::text_of_one_line;
use crate::text::source::quoted;
use crate::{Joint, Robot};

/// More motors than joints are a mistake of a program.
const MAX_DRIVES: usize = crate::text::document::MAX_JOINTS;

/// A motor of the list `motors`: it turns with Σ n q̇ of some joints. Not to be confused with the
/// [`Motor`](crate::Motor) of a joint, which has friction and turns with that joint alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Its name; `motor1`, `motor2`, … when the file gives none.
    pub name: String,
    /// The joints with which it turns, counted from 0, in the order of the rows, and n of each: motor turns per joint
    /// turn (rad/rad, rad/m for a prismatic joint). No n is zero.
    pub turns: Vec<(usize, f64)>,
    /// The part that turns; `None` for a motor that only maps torques and speeds.
    pub rotor: Option<Rotor>,
}

/// The rotor of a [`Drive`]: it turns on a link, its carrier, whose mass and inertia include the rotor at rest.
///
/// With the spin s = Σ n q̇ about the axis a, relative to the carrier, it adds Jm s a to the angular momentum of the
/// carrier, and n Jm (s + a · ω) to the momentum of each joint with which it turns; ω is that of the carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// The direction of its axis in the axes of the carrier's link frame: a unit vector.
    pub axis: [f64; 3],
    /// The joint whose link carries it, counted from 0; `None` for the base.
    pub on: Option<usize>,
    /// Jm, its inertia about the axis, kg m².
    pub inertia: f64,
}

impl Robot {
    /// Whether a rotor of the list `motors` turns on a link or on the base.
    #[must_use]
    pub fn has_spinning_rotors(&self) -> bool {
        self.spinning_rotors().next().is_some()
    }

    /// The rotors of the list `motors` that resist, with the joints with which they turn.
    pub fn spinning_rotors(&self) -> impl Iterator<Item = (&Rotor, &[(usize, f64)])> {
        self.drives.iter().filter_map(|drive| {
            let rotor = drive.rotor.as_ref().filter(|rotor| rotor.inertia != 0.0)?;
            Some((rotor, drive.turns.as_slice()))
        })
    }

    /// N, by rows: the speeds of the motors of the list `motors` are N q̇, and the torques that work on the coordinates
    /// are Nᵀ τ of the motors.
    #[must_use]
    pub fn motor_matrix(&self) -> Vec<Vec<f64>> {
        let coordinates: Vec<usize> = self.coordinates().collect();
        let row = |drive: &Drive| {
            let mut row = vec![0.0; coordinates.len()];
            let mut add = |joint: usize, n: f64| {
                if let Some(place) = coordinates.iter().position(|coordinate| *coordinate == joint) {
                    row[place] += n;
                }
            };
            for &(joint, n) in &drive.turns {
                match &self.joints[joint].coupling {
                    None => add(joint, n),
                    Some(coupling) => coupling.follows.iter().for_each(|&(followed, ratio)| add(followed, n * ratio)),
                }
            }
            row
        };
        self.drives.iter().map(row).collect()
    }

    /// N⁻¹, by rows, where there are as many motors as coordinates and no speed of the coordinates leaves all of them
    /// at rest; `None` elsewhere.
    #[must_use]
    pub fn inverse_motor_matrix(&self) -> Option<Vec<Vec<f64>>> {
        /// A smaller pivot, in parts of the largest element, counts as zero.
        const LEAST_PIVOT: f64 = 1e-12;
        let size = self.dof();
        let mut left = self.motor_matrix();
        let largest = left.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if left.len() != size || largest == 0.0 {
            return None;
        }
        let unit = |row: usize| (0..size).map(|column| f64::from(u8::from(row == column))).collect::<Vec<_>>();
        let mut right: Vec<Vec<f64>> = (0..size).map(unit).collect();
        for column in 0..size {
            let pivot = (column..size).max_by(|&a, &b| left[a][column].abs().total_cmp(&left[b][column].abs()))?;
            if left[pivot][column].abs() <= LEAST_PIVOT * largest {
                return None;
            }
            left.swap(column, pivot);
            right.swap(column, pivot);
            let scale = left[column][column];
            for matrix in [&mut left, &mut right] {
                matrix[column].iter_mut().for_each(|x| *x /= scale);
            }
            for row in (0..size).filter(|row| *row != column) {
                let factor = left[row][column];
                if factor != 0.0 {
                    for matrix in [&mut left, &mut right] {
                        let pivot = matrix[column].clone();
                        matrix[row].iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
                    }
                }
            }
        }
        // no element is -0
        right.iter_mut().flatten().for_each(|x| *x += 0.0);
        Some(right)
    }
}

/// Reads the list `motors` of a file whose root is `root`. `passive` are the dependent joints of closed loops.
pub(crate) fn drives(
    cx: &Context,
    root: &Node,
    format: u32,
    joints: &[Joint],
    passive: &[usize],
) -> Option<Vec<Drive>> {
    let help = "begin each motor with a dash, such as `- {turns: {joint2: 42, joint3: -25}}`";
    let items = items(cx, root, ("motors", format), "motors", help)?;
    if let Some(excess) = items.get(MAX_DRIVES) {
        let message = format!("{} motors; at most {MAX_DRIVES} motors are allowed", items.len());
        return cx.refuse(Diagnostic::error(excess.head(), message).label(format!("motor {}", MAX_DRIVES + 1)));
    }
    let names = joint_names(root);
    let drives: Vec<_> = items.iter().enumerate().map(|(index, item)| drive(cx, item, index, &names, joints)).collect();
    let drives = drives.into_iter().collect::<Option<Vec<_>>>()?;
    let mut valid = true;
    let mut refused = |mistake: Diagnostic| {
        valid = false;
        cx.report(mistake);
    };
    for (index, (item, drive)) in items.iter().zip(&drives).enumerate() {
        if let Some(first) = drives[..index].iter().position(|other| other.name == drive.name) {
            let place = item.get("name").map_or(item.head(), |name| name.span.clone());
            let message = format!(
                "the name {} of motor {} is already the name of motor {}; the names of motors must differ",
                quoted(&drive.name),
                index + 1,
                first + 1
            );
            refused(Diagnostic::error(place, message).label("name taken"));
        }
        // its speed would be no constant sum of those of the coordinates
        let is_dependent = |joint: usize| {
            let coupling = joints[joint].coupling.as_ref();
            let mut followed = coupling.into_iter().flat_map(|coupling| &coupling.follows);
            passive.contains(&joint) || followed.any(|(followed, _)| passive.contains(followed))
        };
        if let Some(&(joint, _)) = drive.turns.iter().find(|(joint, _)| is_dependent(*joint)) {
            let message = format!(
                "the motor {} turns with the joint {}, which is dependent in a closed loop",
                quoted(&drive.name),
                quoted(&names[joint])
            );
            let help = "name joints that are not dependent in `turns`; the inertia of a rotor that turns with a \
                        dependent joint belongs into its link";
            let place = item.get("turns").map_or(item.head(), Node::head);
            refused(Diagnostic::error(place, message).label("a dependent joint").help(help));
        }
        for &(joint, _) in drive.turns.iter().filter(|_| drive.rotor.is_some()) {
            if let Some(inertia) = inertia_of_joint(root, joint) {
                let message = format!(
                    "the joint {} has a `motor` with `inertia`, but the motor {} has a rotor that turns with it",
                    quoted(&names[joint]),
                    quoted(&drive.name)
                );
                let help =
                    "delete this `inertia`, or delete `rotor` in the list `motors`: each inertia is counted once";
                refused(Diagnostic::error(inertia.span.clone(), message).label("a second rotor").help(help));
            }
        }
    }
    valid.then_some(drives)
}

/// The `inertia` of the `motor` of a joint, counted from 0.
fn inertia_of_joint(root: &Node, joint: usize) -> Option<&Node> {
    match &root.get("joints")?.content {
        Content::Sequence(items) => items.get(joint)?.get("motor")?.get("inertia"),
        _ => None,
    }
}

/// The motor with this index, from 0.
fn drive(cx: &Context, node: &Node, index: usize, names: &[String], joints: &[Joint]) -> Option<Drive> {
    const EXAMPLE: &str = "write the joints with which it turns and its turns per turn of each, such as `turns: \
                           {joint2: 42, joint3: -25}`";
    read_mapping!(cx, node, "a motor", {
        name: or(format!("motor{}", index + 1)) "name" |cx, node| text_of_one_line(cx, node, "motor name"),
        turns: required "turns" |cx, node| ratios(cx, node, names, "turns", EXAMPLE),
        rotor: optional "rotor" |cx, node| rotor(cx, node, names),
    });
    let first = turns.first()?.0;
    let rotor =
        rotor.map(|(axis, on, inertia)| Rotor { axis, on: on.unwrap_or_else(|| parent(joints, first)), inertia });
    let mut turns = turns;
    turns.sort_by_key(|(joint, _)| *joint);
    // a name of a joint that could not be read has no joint
    turns.iter().all(|(joint, _)| *joint < joints.len()).then_some(Drive { name, turns, rotor })
}

/// The axis, the link that carries it if the file says so, and the inertia.
#[allow(clippy::option_option, clippy::type_complexity)] // the inner `None` is no key, or the base
fn rotor(cx: &Context, node: &Node, names: &[String]) -> Option<([f64; 3], Option<Option<usize>>, f64)> {
    read_mapping!(cx, node, "`rotor`", {
        axis: required "axis" axis,
        on: optional "on" |cx, node| carrier(cx, node, names, "on"),
        inertia: required "inertia" not_negative("rotor inertia", fixed("the rotor inertia")),
    });
    Some((axis, on, inertia))
}

/// A direction, as a unit vector.
fn axis(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    let axis = list(cx, node, "[x, y, z]", |cx, node, _| fixed("the axis")(cx, node))?;
    let largest = axis.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 {
        let message = "the axis [0, 0, 0] has no direction; the rotor must turn about an axis";
        let help = "write the direction in the axes of the link that carries the rotor, such as `axis: [0, 0, 1]`";
        return cx.refuse(Diagnostic::error(node.span.clone(), message).label("no direction").help(help));
    }
    let scaled = axis.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    // a unit vector stays as it is written
    let is_unit = (largest * length - 1.0).abs() < 4.0 * f64::EPSILON;
    Some(if is_unit { axis } else { scaled.map(|x| x / length) })
}
