//! Closed loops of a description, and the choice of the joints that depend on others because of them.

use std::collections::BTreeSet;
use std::ops::Range;

use rne_model::{
    Actuation, Angle, ClosedLoop, Convention, Cut, FixedFrame, NoDependents, Report, Robot, choose_dependents, one_line,
};

use crate::chain::{Chain, ChainLoop, Extracted};
use crate::frames::transform;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::source::{Source, names, quoted};
use crate::table::Table;
use crate::urdf::xml::Seen;
use crate::urdf::{Joint, Kind, Link, Urdf, cut};

/// Distance, m and rad, up to which the two ends of a loop are taken for one place where the loops come nearest to
/// closing, because descriptions round their numbers.
const ROUNDING: f64 = 1e-6;

/// A closed loop, and the cut joint that closes it.
#[derive(Clone, Debug)]
pub(crate) struct Loop {
    pub(crate) name: String,
    /// The place of its tag in the text.
    pub(crate) span: Range<usize>,
    pub(crate) cut: Cut,
    /// Both ends: a link, and the place on it, as in [`ClosedLoop::between`].
    pub(crate) ends: [(usize, Pose); 2],
}

impl Urdf {
    /// Reads the elements `loop` of URDF+ (arXiv 2411.19753). The axis of a revolute cut joint has the same components
    /// in the axes of both origins.
    pub(crate) fn take_loops(&mut self, loops: &[Seen]) -> Result<(), Report> {
        for (index, seen) in loops.iter().enumerate() {
            let error = |message: String, help: &str| Err(self.source.error(&seen.span, message, help));
            let name = seen.text("loop", "name").map_or_else(|| format!("loop{}", index + 1), str::to_owned);
            let cut = seen.text("loop", "type").and_then(cut).unwrap_or(Cut::Weld);
            let axis = seen.vector("axis", "xyz");
            let turned = axis.map_or(Some(Rotation::identity()), Rotation::to_z);
            if (cut == Cut::Revolute) != axis.is_some() {
                return match cut {
                    Cut::Revolute => error(
                        format!("the loop {} is revolute and has no element `axis`", quoted(&name)),
                        "write a direction into it, such as <axis xyz=\"0 0 1\"/>",
                    ),
                    _ => error(
                        format!("the loop {} has an `axis`, but it is not revolute", quoted(&name)),
                        "delete `axis`: a universal joint turns about x of the predecessor's origin and about y of the \
                         successor's, and other joints have no axis",
                    ),
                };
            }
            let Some(turned) = turned else {
                let message = format!("the axis of the loop {} has no direction", quoted(&name));
                return error(message, "write a direction, such as 0 0 1");
            };
            let mut ends = [(0, Pose::identity()); 2];
            for (end, of) in ends.iter_mut().zip(["predecessor", "successor"]) {
                let help = "write both into it: <predecessor link=\"NAME\"><origin xyz=\"0 0 0\"/></predecessor>";
                let find = |name: &str| self.links.iter().position(|link| link.name == name);
                let known = self.named_link(seen, of, &format!("the loop {}", quoted(&name)), help, find)?;
                let [xyz, rpy] = ["xyz", "rpy"].map(|part| seen.vector(of, part).unwrap_or_default());
                let turned = Pose { rotation: turned, translation: Vector::ZERO };
                *end = (known, Pose::new(xyz, rpy) * turned);
            }
            let source = self.source.clone();
            self.add_loop(Loop { name, span: seen.span.clone(), cut, ends }, &source)?;
        }
        Ok(())
    }

    /// Adds a loop from the text `source`, after checking it.
    pub(crate) fn add_loop(&mut self, closed: Loop, source: &Source) -> Result<(), Report> {
        let error = |message: String, help: &str| Err(source.error(&closed.span, message, help));
        let name = quoted(&closed.name);
        if self.loops.iter().any(|other| other.name == closed.name) {
            return error(format!("two loops have the name {name}"), "names of loops must differ");
        }
        let [one, other] = closed.ends.map(|(link, _)| link);
        let moves = |joint: &usize| !matches!(self.joints[*joint].kind, Kind::Fixed);
        if !self.between([one, other]).iter().any(moves) {
            let [one, other] = [one, other].map(|link| quoted(&self.links[link].name));
            let message = format!("no joint moves the ends of the loop {name} against each other: {one} and {other}");
            return error(message, "a loop joins two links that joints move against each other");
        }
        self.loops.push(closed);
        Ok(())
    }

    /// Replaces each spherical joint in a loop by three revolute joints.
    pub(crate) fn split_spherical_joints(&mut self, source: &Source) -> Result<(), Report> {
        let in_loops = self.loops.iter().flat_map(|closed| self.between(closed.ends.map(|(link, _)| link)));
        let is_spherical = |joint: &usize| self.joints[*joint].kind == Kind::Spherical;
        let joints: BTreeSet<usize> = in_loops.filter(is_spherical).collect();
        if joints.is_empty() {
            return Ok(());
        }
        let named = names(joints.iter().map(|&joint| &self.joints[joint].name));
        self.remarks.push(format!(
            "these spherical joints of closed loops become three revolute joints each, about x, y and z, without \
             limits and friction: {named}"
        ));
        joints.into_iter().try_for_each(|joint| {
            let span = self.joints[joint].span.clone();
            self.split(joint, &[0, 1, 2], (source, &span))
        })
    }

    /// Replaces a joint by revolute joints in series, about the given axes of its frame (0 to 2 for x to z), with
    /// massless links between them.
    pub(crate) fn split(
        &mut self,
        index: usize,
        axes: &[usize],
        (source, place): (&Source, &Range<usize>),
    ) -> Result<(), Report> {
        let of = self.joints[index].clone();
        let (mut parent, mut at) = (of.parent, index);
        for (turn, &axis) in axes.iter().enumerate() {
            let name = format!("{}_{}", of.name, ["x", "y", "z"][axis]);
            let link = format!("{name}_link");
            if self.joints.iter().any(|joint| joint.name == name) || self.links.iter().any(|known| known.name == link) {
                let (of, name) = (quoted(&of.name), quoted(&name));
                let message = format!("a part of the joint {of} gets the name {name}, which is taken");
                return Err(source.error(place, message, None));
            }
            let child = if turn + 1 == axes.len() { of.child } else { self.links.len() };
            if child == self.links.len() {
                self.links.push(Link::new(link, of.span.clone()));
            }
            let mut joint = Joint { name, parent, child, ..Joint::new(Kind::Continuous, of.span.clone()) };
            joint.axis = [0.0; 3];
            joint.axis[axis] = 1.0;
            joint.has_motor = of.has_motor;
            if turn == 0 {
                (joint.xyz, joint.rpy, joint.unknown) = (of.xyz, of.rpy, of.unknown.clone());
                self.joints[index] = joint;
            } else {
                at = self.joints.len();
                self.joints.push(joint);
                self.links[parent].children.push(at);
            }
            self.links[child].parent = Some(at);
            parent = child;
        }
        Ok(())
    }

    /// Returns the joints that move one of two links but not the other.
    pub(crate) fn between(&self, links: [usize; 2]) -> Vec<usize> {
        let [one, other] = links.map(|link| self.to_root(link));
        let of = |of: &[usize], than: &[usize]| -> Vec<usize> {
            of.iter().copied().filter(|joint| !than.contains(joint)).collect()
        };
        [of(&one, &other), of(&other, &one)].concat()
    }

    /// Gives a robot the closed loops of its chain, and chooses the dependent joints, whose motors are removed.
    pub(crate) fn close(
        &self,
        (chain, told): (&Chain, &mut Extracted),
        table: &Table,
        robot: &mut Robot,
    ) -> Result<(), Report> {
        if chain.loops.is_empty() {
            return Ok(());
        }
        let mut ends: Vec<[(Option<usize>, Pose); 2]> = chain.loops.iter().map(|closed| closed.ends).collect();
        let mut fitted = false;
        loop {
            let mut loops: Vec<ClosedLoop> =
                chain.loops.iter().zip(&ends).map(|(it, ends)| self.cut(it, ends, table)).collect();
            let actuation: Vec<Actuation> = told.moving.iter().map(|&joint| self.actuation(joint)).collect();
            match choose_dependents(&robot.joints, Convention::Modified, &mut loops, &actuation) {
                Ok(rest) => {
                    tell(told, robot, (&loops, &rest), &actuation);
                    for &joint in loops.iter().flat_map(|closed| &closed.dependent) {
                        robot.joints[joint].motor = None;
                    }
                    robot.closed.loops = loops;
                    return Ok(());
                }
                Err(NoDependents::Open { apart, positions, .. })
                    if !fitted && apart.into_iter().all(|by| by < ROUNDING) =>
                {
                    fitted = true;
                    for (closed, ends) in chain.loops.iter().zip(&mut ends) {
                        fit(chain, self.loops[closed.index].cut, ends, &positions);
                    }
                    told.remarks.push(format!(
                        "the loops close within {:.1e} m and {:.1e} rad only, which is taken for rounding of the file: \
                         the second places of the loops are moved by that",
                        apart[0], apart[1]
                    ));
                }
                Err(fault) => return Err(self.refuse_loops(&fault, chain)),
            }
        }
    }

    /// Converts a loop to the form of robot files, without dependent joints.
    fn cut(&self, closed: &ChainLoop, ends: &[(Option<usize>, Pose); 2], table: &Table) -> ClosedLoop {
        let Loop { name, cut, .. } = &self.loops[closed.index];
        let between = ends.map(|(on, place)| {
            let link = on.map_or(table.start, |joint| table.frames[joint]);
            let placement = transform(link.inverse() * place);
            // a spherical joint is the same in all axes
            let rpy = if *cut == Cut::Spherical { [0.0; 3].map(Angle::new) } else { placement.rpy };
            FixedFrame { on, placement: rne_model::Transform { rpy, ..placement } }
        });
        ClosedLoop { name: one_line(name), cut: *cut, between, dependent: Vec::new() }
    }

    /// Returns whether a joint has a motor, as far as the file says it.
    fn actuation(&self, joint: usize) -> Actuation {
        match self.joints[joint].has_motor {
            Some(true) => Actuation::Motor,
            Some(false) => Actuation::None,
            None => Actuation::Unknown,
        }
    }

    /// Makes the error for loops for which no dependent joints exist.
    fn refuse_loops(&self, fault: &NoDependents, chain: &Chain) -> Report {
        let of = |index: &usize| &self.loops[chain.loops[*index].index];
        let (closed, message, help) = match fault {
            NoDependents::Open { index, apart: [length, angle], .. } => {
                let apart = format!("{length:.1e} m and {angle:.1e} rad apart");
                let message = format!("no position of the joints closes the loop {}", quoted(&of(index).name));
                let message = format!("{message}: the nearest one leaves its two ends {apart}");
                (of(index), message, "check the lengths, and the origins at both ends")
            }
            NoDependents::Repeats(index) => {
                let name = quoted(&of(index).name);
                let message = format!("the loop {name} adds no equation to those of the loops before it");
                (of(index), message, "delete this loop")
            }
            NoDependents::Rigid(index) => {
                let name = quoted(&of(index).name);
                let message =
                    format!("the loop {name}, and the loops that share joints with it, leave no joint that moves");
                (of(index), message, "check the type of the joint that closes it: a planar loop is revolute")
            }
            NoDependents::Singular(index) => {
                let message = format!("the loop {} is singular wherever it is closed", quoted(&of(index).name));
                (of(index), message, "check the lengths, and the origins at both ends")
            }
            _ => (of(&0), "the loops cannot be solved".to_owned(), "check the lengths, and the origins at both ends"),
        };
        self.source.error(&closed.span, message, help)
    }
}

/// Adds remarks that say which joints are dependent, and why.
fn tell(told: &mut Extracted, robot: &Robot, (loops, rest): (&[ClosedLoop], &[usize]), of: &[Actuation]) {
    let chosen: Vec<usize> = loops.iter().flat_map(|closed| closed.dependent.iter().copied()).collect();
    let named = |joints: &[usize]| names(joints.iter().map(|&joint| &robot.joints[joint].name));
    let among = |joints: &[usize], level: Actuation| -> Vec<usize> {
        joints.iter().copied().filter(|&joint| of[joint] == level).collect()
    };
    let rank = chosen.len();
    let are = format!("the closed loops determine {rank} joints, and the dependent joints are {}", named(&chosen));
    let idle = among(rest, Actuation::None);
    let unsaid = among(&chosen, Actuation::Unknown);
    let moved = among(&chosen, Actuation::Motor);
    let unsaid_rest = among(rest, Actuation::Unknown);
    told.remarks.push(if moved.is_empty() && unsaid.is_empty() && idle.is_empty() {
        format!("{are}: the file says that these joints have no motors, and the rank of the equations says the same")
    } else {
        format!("{are}; rne has chosen them by the rank of the equations, and joints without motors first")
    });
    if !idle.is_empty() {
        told.remarks.push(format!(
            "the loops leave freedoms that no motor of the file moves, so these joints have elements of q and torques \
             like joints with motors: {}. Lock those that turn a part about itself only",
            named(&idle)
        ));
    }
    if !unsaid.is_empty() {
        let others = if unsaid_rest.is_empty() { named(rest) } else { named(&unsaid_rest) };
        told.remarks.push(format!(
            "the file does not say whether {} have motors; if one of them has one, name a joint among {others} in \
             `dependent` in its place",
            named(&unsaid)
        ));
    }
    if !moved.is_empty() {
        told.remarks.push(format!(
            "the file gives {} motors, but the loops leave fewer freedoms than there are motors: these joints have \
             no torques of their own in the robot file",
            named(&moved)
        ));
    }
    let lost: Vec<usize> = chosen.into_iter().filter(|&joint| robot.joints[joint].motor.is_some()).collect();
    if !lost.is_empty() {
        told.remarks.push(format!(
            "friction and rotors of dependent joints are left out, because these joints have no motors: {}",
            named(&lost)
        ));
    }
}

/// Moves the second end of a loop onto the first one, so that the loop is closed at the given positions of all joints.
fn fit(chain: &Chain, cut: Cut, ends: &mut [(Option<usize>, Pose); 2], positions: &[f64]) {
    let [one, other] =
        ends.map(|(on, place)| on.map_or(Pose::identity(), |joint| link(chain, joint, positions)) * place);
    let [(_, _), (on, place)] = ends;
    let rotation = match cut {
        Cut::Weld => one.rotation,
        Cut::Revolute => {
            let z = one.rotation.columns[2];
            let x = other.rotation.columns[0].across(z).direction().unwrap_or(one.rotation.columns[0]);
            Rotation::of_axes(x, z)
        }
        Cut::Spherical | Cut::Universal => other.rotation,
    };
    let carrier = on.map_or(Pose::identity(), |joint| link(chain, joint, positions));
    *place = carrier.inverse() * Pose { rotation, translation: one.translation };
}

/// Returns the placement of a link, which a joint moves, in the frame of the base.
fn link(chain: &Chain, joint: usize, positions: &[f64]) -> Pose {
    let of = &chain.joints[joint];
    let carrier = of.parent.map_or(Pose::identity(), |parent| link(chain, parent, positions));
    let position = positions[joint];
    let moved = if of.is_prismatic {
        Pose { rotation: Rotation::identity(), translation: of.axis * decimal(position) }
    } else {
        Pose { rotation: Rotation::about(of.axis, position), translation: Vector::ZERO }
    };
    carrier * of.place * moved
}
