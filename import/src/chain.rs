//! From a tree of links to the chain between a base and a tip, or to all of it: what is fixed to a link is lumped into
//! it.

mod follower;

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use rne_model::{Coupling, Limits, Motor, Remedy, Report, Transform, one_line, six_digits};

use self::follower::Coupled;
use crate::body::Body;
use crate::frames::transform;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::remark::{Remark, Remarks};
use crate::selection::{End, Selection, link, locks, path, refuse_value, tip};
use crate::snap::{Snapped, Snapping};
use crate::source::{names, quoted, some};
use crate::urdf::{Joint, Urdf};

/// More joints than a robot file may have.
const MAX_JOINTS: usize = 64;

/// The help against a joint that no row of a table can describe.
const SEVERAL: &str = "a row of the table is one revolute or prismatic joint: write the joint as several of them, such \
                       as a ball as three hinges about x, y and z";

/// A serial arm, or a whole tree: joints with bodies between them.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// World → base.
    pub(crate) base: Pose,
    /// The acceleration of gravity in the axes of the base, m/s².
    pub(crate) gravity: Vector,
    /// The floating base, if there is one, about the origin of its frame.
    pub(crate) floating_base: Option<Body>,
    pub(crate) joints: Vec<ChainJoint>,
    /// The joint that moves the link of the tip, from 0.
    pub(crate) tip_on: usize,
    /// Frame of the link of the tip → tip frame.
    pub(crate) tip: Pose,
    /// Other frames that are fixed to its links, or to the base.
    pub(crate) frames: Vec<ChainFrame>,
    /// The closed loops that its joints move.
    pub(crate) loops: Vec<ChainLoop>,
}

impl Chain {
    /// Whether each link carries one joint, the last one the tip, no joint follows another and no loop is closed: a
    /// table without branches has all of it.
    pub(crate) fn is_serial(&self) -> bool {
        let follows_the_last =
            |(index, joint): (usize, &ChainJoint)| joint.parent == index.checked_sub(1) && joint.coupling.is_none();
        self.joints.iter().enumerate().all(follows_the_last)
            && self.tip_on + 1 == self.joints.len()
            && self.loops.is_empty()
    }
}

/// A closed loop.
#[derive(Clone, Debug)]
pub(crate) struct ChainLoop {
    /// Its place in the list of the URDF.
    pub(crate) index: usize,
    /// The joints that move the two links, from 0, `None` for the base, and the places in the frames of these links.
    pub(crate) ends: [(Option<usize>, Pose); 2],
}

/// A frame that is fixed to a link of a chain.
#[derive(Clone, Debug)]
pub(crate) struct ChainFrame {
    pub(crate) name: String,
    /// The joint that moves the link, from 0; `None` for the base.
    pub(crate) on: Option<usize>,
    /// Frame of the moved link, or of the base → this frame.
    pub(crate) place: Pose,
}

/// A joint and the link that it moves, whose frame is at the joint.
#[derive(Clone, Debug)]
pub(crate) struct ChainJoint {
    pub(crate) name: String,
    pub(crate) is_prismatic: bool,
    /// The joint whose link carries this joint, from 0; `None` for the base.
    pub(crate) parent: Option<usize>,
    /// Frame of the link that carries it, or of the base → frame of this one's link, at q = 0.
    pub(crate) place: Pose,
    /// The unit vector of the axis, in the link's axes.
    pub(crate) axis: Vector,
    /// About the origin of the link's frame.
    pub(crate) body: Body,
    pub(crate) limits: Limits,
    pub(crate) motor: Option<Motor>,
    /// How it follows another joint of the chain.
    pub(crate) coupling: Option<Coupling>,
    pub(crate) coulomb_width: Option<f64>,
    pub(crate) coulomb_displacement: Option<f64>,
}

/// The record of a tree's way to a chain.
#[derive(Clone, Debug, Default)]
pub(crate) struct Extracted {
    pub(crate) base: String,
    pub(crate) tip: String,
    /// Per joint of the chain its place in the text.
    pub(crate) spans: Vec<Range<usize>>,
    /// Per joint of the chain that of the URDF.
    pub(crate) moving: Vec<usize>,
    /// Per joint of the chain the links that were lumped into the link it moves.
    pub(crate) lumped: Vec<Vec<String>>,
    /// Joints that are held, and where.
    pub(crate) held: Vec<(String, f64)>,
    /// Movable joints on fixed links, which do not belong to the arm.
    pub(crate) aside: Vec<String>,
    pub(crate) snapped: Vec<Snapped>,
    /// Whether the link that floats in the file is a floating base here; `None` where none floats.
    pub(crate) floats: Option<bool>,
    /// Links whose bodies are in the arm.
    pub(crate) links: BTreeSet<usize>,
    /// Joints of the chain, and those that are held.
    pub(crate) joints: BTreeSet<usize>,
    /// Notes for the reader of the robot file, in sentences.
    pub(crate) remarks: Remarks,
}

/// Takes the chain out of the tree. `gravity` is in the axes of the root link.
pub(crate) fn extract(
    urdf: &Urdf,
    selection: &Selection,
    gravity: [f64; 3],
    snap: bool,
) -> Result<(Chain, Extracted), Report> {
    let base = match &selection.base {
        Some(name) => link(urdf, name, "base")?,
        None => urdf.base,
    };
    let floats = selection.floats(urdf, base)?;
    let End { link: end, others } = tip(urdf, base, selection)?;
    let path = path(urdf, base, end)?;
    let tip = path.last().map_or(base, |&joint| urdf.joints[joint].child);
    let locks = locks(urdf, selection)?;
    let moves = |&joint: &usize| urdf.joints[joint].kind.has_one_freedom() && !locks.contains_key(&joint);
    let mut walk = Walk {
        urdf,
        selection,
        moving: if selection.whole {
            (0..urdf.joints.len()).filter(moves).collect()
        } else {
            path.iter().copied().filter(moves).collect()
        },
        locks,
        snapping: Snapping { is_on: snap, ..Snapping::default() },
        loose: Vec::new(),
        followers: Vec::new(),
        coupled: Vec::new(),
        places: HashMap::new(),
        frames: Vec::new(),
        standing: 0.0,
        told: Extracted {
            base: urdf.links[base].name.clone(),
            tip: urdf.links[tip].name.clone(),
            ..Extracted::default()
        },
    };
    let mut chain = Chain {
        base: walk.base(base)?,
        gravity: Vector::decimal(gravity),
        floating_base: floats.then_some(Body::NONE),
        joints: Vec::new(),
        tip_on: 0,
        tip: Pose::identity(),
        frames: Vec::new(),
        loops: Vec::new(),
    };
    walk.look_at_floating(floats.then_some(chain.base));
    if floats {
        // it has no place in the world, and gravity is that of the world
        chain.base = Pose::identity();
    }
    chain.gravity = chain.base.rotation.transpose() * chain.gravity;
    if selection.whole {
        walk.whole(base, tip, &mut chain)?;
        walk.couple(&mut chain);
    } else {
        walk.along(base, &path, &mut chain)?;
    }
    if chain.joints.len() > MAX_JOINTS {
        let what = if selection.whole { "robot" } else { "chain" };
        let message =
            format!("the {what} has {} movable joints; a robot file has at most {MAX_JOINTS}", chain.joints.len());
        return Err(urdf.source.error(&urdf.links[base].span, message, None));
    }
    if !walk.loose.is_empty() {
        let joints = names(walk.loose.iter().map(|&joint| &urdf.joints[joint].name));
        let is_before_base = |joint: &usize| urdf.joints[*joint].kind.has_one_freedom();
        let mut help = "hold these joints still, each at a position of its own or all at zero".to_owned();
        let message = if selection.whole && walk.loose.iter().any(is_before_base) {
            format!("movable joints that do not come after the base {}: {joints}", quoted(&walk.told.base))
        } else if selection.whole {
            help = format!("{SEVERAL}, or hold it still at zero");
            format!("joints with more than one freedom, which no row of a table can describe: {joints}")
        } else {
            format!(
                "movable joints that are not on the chain from {} to {}: {joints}",
                quoted(&walk.told.base),
                quoted(&walk.told.tip)
            )
        };
        let span = &urdf.joints[walk.loose[0]].span;
        return Err(urdf.source.error_with(span, message, help, &Remedy::LockOthers));
    }
    walk.refuse_followers_outside()?;
    walk.remark_on_standing_base();
    (chain.loops, chain.frames) = (walk.loops(base)?, walk.frames);
    walk.told.snapped = walk.snapping.found;
    if !others.is_empty() {
        let others = names(others.iter().map(|&link| &urdf.links[link].name));
        let tip = quoted(&walk.told.tip);
        walk.told.remarks.push(if selection.whole {
            format!("the tip is {tip}; these links are ends, too: {others}")
        } else {
            format!("the tip is {tip}; these links are also after the same joints: {others}")
        });
    }
    Ok((chain, walk.told))
}

/// The remedy against a joint that must not move.
fn lock(joint: &str) -> Remedy {
    Remedy::LockJoint { joint: one_line(joint) }
}

/// A walk through the tree.
struct Walk<'a> {
    urdf: &'a Urdf,
    selection: &'a Selection,
    locks: HashMap<usize, f64>,
    /// The joints of the chain that move.
    moving: BTreeSet<usize>,
    snapping: Snapping,
    /// Movable joints off the chain that nobody holds.
    loose: Vec<usize>,
    /// Joints off the chain that follow one of it, and which.
    followers: Vec<(usize, usize)>,
    /// Joints of a whole robot that follow another one: their place in the chain, and how.
    coupled: Vec<Coupled>,
    /// The places in the chain of the joints that move.
    places: HashMap<usize, usize>,
    /// The links, where they are fixed to the chain.
    frames: Vec<ChainFrame>,
    /// The mass of the links that stand still with the base, kg.
    standing: f64,
    told: Extracted,
}

impl Walk<'_> {
    /// Refuses joints outside the chain that follow joints of the chain.
    fn refuse_followers_outside(&self) -> Result<(), Report> {
        if let Some(&(first, _)) = self.followers.first() {
            let name = |joint: usize| &self.urdf.joints[joint].name;
            let followers = self
                .followers
                .iter()
                .map(|&(joint, leader)| format!("{} follows {}", quoted(name(joint)), quoted(name(leader))));
            let message = format!("joints outside the chain follow moving joints of the chain: {}", some(followers));
            let help =
                "these joints carry mass, and no row of the table can describe that this mass moves along; if the mass \
                 may stand still, lock each of these joints by its name"
                    .to_owned();
            return Err(self.urdf.source.error_with(&self.urdf.joints[first].span, message, help, &lock(name(first))));
        }
        Ok(())
    }

    /// Says that a base with mass stands still.
    fn remark_on_standing_base(&mut self) {
        if self.standing > 0.0 {
            let mass = six_digits(self.standing);
            let remark = Remark::from(format!("the base stands still: its mass of {mass} kg is left out"));
            // another remark says how a base floats that the file lets float
            let remark = if self.urdf.floats.is_none() { remark.remedy(Remedy::Float) } else { remark };
            self.told.remarks.push(remark);
        }
    }

    /// Tells whether the link that floats in the file is a floating base, whose joint is at `placement` in the world.
    fn look_at_floating(&mut self, placement: Option<Pose>) {
        let Some(link) = self.urdf.floats else { return };
        let name = quoted(&self.urdf.links[link].name);
        let floats = placement.is_some();
        let then = if floats { "so the robot has a floating base" } else { "and rne fixes it where the file has it" };
        self.told.remarks.push(format!("the link {name} floats in the file, {then}"));
        self.told.floats = Some(floats);
        // the free joint of an MJCF file counts from the world, wherever its body is in the file
        if let Some(placement) = placement.map(transform).filter(|it| *it != Transform::IDENTITY)
            && self.urdf.gravity.is_none()
        {
            let Transform { xyz, rpy: [roll, pitch, yaw] } = placement;
            let rpy = [roll.radians, pitch.radians, yaw.radians];
            self.told.remarks.push(format!(
                "the floating joint of {name} has the placement xyz {xyz:?} m, rpy {rpy:?} rad in the world; rne takes \
                 the pose of the base in the world: it is this placement times the position of the joint, such as q of \
                 Pinocchio"
            ));
        }
    }

    /// World → base: the joints up to there are held.
    fn base(&mut self, base: usize) -> Result<Pose, Report> {
        let before = path(self.urdf, self.urdf.root, base)?;
        let mut pose = Pose::identity();
        for joint in before {
            pose = pose * self.across(joint)?;
        }
        Ok(pose)
    }

    /// The placement of what a held joint carries.
    fn across(&mut self, index: usize) -> Result<Pose, Report> {
        let joint = &self.urdf.joints[index];
        self.told.joints.insert(index);
        let place = self.place(joint);
        if joint.kind == crate::urdf::Kind::Fixed {
            return Ok(place);
        }
        let Some(value) = self.held(index)? else {
            self.loose.push(index);
            return Ok(place);
        };
        refuse_value(self.urdf, joint, value)?;
        self.told.held.push((joint.name.clone(), value));
        if let Some((lower, upper)) = joint.limits.position.filter(|(lower, upper)| !is_within(value, *lower, *upper)) {
            let name = one_line(&joint.name);
            self.told.remarks.push(format!(
                "the joint {name} is locked at {value}, which is outside of its limits, from {lower} to {upper}"
            ));
        }
        let moved = match joint.kind {
            crate::urdf::Kind::Prismatic => {
                Pose { rotation: Rotation::identity(), translation: self.axis(joint) * decimal(value) }
            }
            kind if kind.has_one_freedom() => {
                Pose { rotation: Rotation::about(self.axis(joint), value), translation: Vector::ZERO }
            }
            // Planar, floating, spherical: held where they are at zero.
            _ => Pose::identity(),
        };
        Ok(place * moved)
    }

    /// Whether a link, or a link after it, has mass or inertia.
    fn carries_mass(&self, link: usize) -> bool {
        let mut open = vec![link];
        while let Some(index) = open.pop() {
            let link = &self.urdf.links[index];
            if link.has_mass() {
                return true;
            }
            open.extend(link.children.iter().map(|&joint| self.urdf.joints[joint].child));
        }
        false
    }

    fn place(&mut self, joint: &Joint) -> Pose {
        Pose::new(joint.xyz, self.snapping.rpy(&format!("joint {}", joint.name), joint.rpy))
    }

    /// The direction of a joint that `along` or `locks` has found to have one; the default where it has none.
    fn axis(&mut self, joint: &Joint) -> Vector {
        let direction = Vector::decimal(joint.axis).direction().unwrap_or_else(|| Vector::unit(0));
        self.snapping.axis(&format!("joint {}", joint.name), joint.axis, direction)
    }

    fn along(&mut self, base: usize, path: &[usize], chain: &mut Chain) -> Result<(), Report> {
        // The frame of the current link in that of the last one that moves.
        let mut pose = Pose::identity();
        self.aside(base, path.first().copied());
        self.frames_of_base(base, pose, path.first().copied());
        for (i, &index) in path.iter().enumerate() {
            let next = path.get(i + 1).copied();
            let joint = &self.urdf.joints[index];
            if joint.kind == crate::urdf::Kind::Fixed || self.locks.contains_key(&index) {
                pose = pose * self.across(index)?;
            } else {
                self.moving_joint(index, chain.joints.len().checked_sub(1), pose, chain)?;
                pose = Pose::identity();
            }
            if chain.joints.is_empty() {
                self.aside(joint.child, next);
                self.frames_of_base(joint.child, pose, next);
                continue;
            }
            let body = self.lump(joint.child, (chain.joints.len() - 1, pose), next)?;
            if let Some(last) = chain.joints.last_mut() {
                last.body = last.body + body;
            }
        }
        chain.tip = pose;
        chain.tip_on = chain.joints.len().saturating_sub(1);
        if chain.joints.is_empty() {
            let message =
                format!("there is no movable joint between {} and {}", quoted(&self.told.base), quoted(&self.told.tip));
            return Err(self.urdf.source.error(&self.urdf.links[base].span, message, None));
        }
        Ok(())
    }

    /// The joint that moves a link of the robot.
    fn moving_joint(
        &mut self,
        index: usize,
        parent: Option<usize>,
        pose: Pose,
        chain: &mut Chain,
    ) -> Result<(), Report> {
        let joint = &self.urdf.joints[index];
        self.refuse(joint)?;
        self.remark(index);
        self.look_at_coupling(index, chain.joints.len())?;
        let place = pose * self.place(joint);
        let axis = self.axis(joint);
        let [viscous, friction] = joint.friction;
        // a follower has no motor: what moves it is that of the joint that it follows
        let (inertia, gear_ratio) = (joint.rotor_inertia, joint.gear_ratio);
        let (viscous, friction) = (viscous / (gear_ratio * gear_ratio), friction / gear_ratio.abs());
        let has_motor = joint.friction != [0.0; 2] || [inertia, gear_ratio] != [0.0, 1.0];
        let motor = (has_motor && joint.mimic.is_none()).then_some(Motor {
            inertia,
            gear_ratio,
            viscous,
            coulomb: [friction, 0.0 - friction],
        });
        chain.joints.push(ChainJoint {
            name: joint.name.clone(),
            is_prismatic: joint.kind == crate::urdf::Kind::Prismatic,
            parent,
            place,
            axis,
            body: Body::NONE,
            limits: joint.limits,
            motor,
            coupling: None,
            coulomb_width: None,
            coulomb_displacement: None,
        });
        self.told.spans.push(joint.span.clone());
        self.told.moving.push(index);
        self.told.lumped.push(Vec::new());
        Ok(())
    }

    /// The loops that moving joints close. One of which no joint moves is left out.
    fn loops(&mut self, base: usize) -> Result<Vec<ChainLoop>, Report> {
        let mut loops = Vec::new();
        for (index, closed) in self.urdf.loops.iter().enumerate() {
            let name = quoted(&closed.name);
            let moved = self.urdf.between(closed.ends.map(|(link, _)| link));
            let Some(mover) = moved.into_iter().find(|joint| self.moving.contains(joint)) else {
                let remark = format!("the loop {name} is left out, because no joint that moves is in it");
                self.told.remarks.push(remark);
                continue;
            };
            let error = |message: String, help: &str| Err(self.urdf.source.error(&closed.span, message, help));
            if !self.selection.whole {
                let mover = quoted(&self.urdf.joints[mover].name);
                let message = format!("the joint {mover} of the arm moves the closed loop {name}");
                let help = "an arm alone has no closed loops";
                return Err(self.urdf.source.error_with(&closed.span, message, help, &Remedy::Whole));
            }
            let mut ends = [(None, Pose::identity()); 2];
            for (end, (link, place)) in ends.iter_mut().zip(closed.ends) {
                let link = &self.urdf.links[link].name;
                let Some(frame) = self.frames.iter().find(|frame| frame.name == *link) else {
                    let base = quoted(&self.urdf.links[base].name);
                    let message =
                        format!("the loop {name} has an end on {}, which is not after the base {base}", quoted(link));
                    return error(message, "name a base that carries both ends");
                };
                *end = (frame.on, frame.place * place);
            }
            loops.push(ChainLoop { index, ends });
        }
        Ok(loops)
    }

    /// All links after the base, branch by branch.
    fn whole(&mut self, base: usize, tip: usize, chain: &mut Chain) -> Result<(), Report> {
        // joints to cross, with the joint that moves the link before and the place of that link in its frame
        let mut open: Vec<(Option<usize>, Option<usize>, Pose)> = vec![(None, None, Pose::identity())];
        while let Some((crossed, mut on, mut pose)) = open.pop() {
            if let Some(index) = crossed {
                if self.moving.contains(&index) {
                    self.moving_joint(index, on, pose, chain)?;
                    (on, pose) = (Some(chain.joints.len() - 1), Pose::identity());
                } else {
                    pose = pose * self.across(index)?;
                }
            }
            let link = crossed.map_or(base, |index| self.urdf.joints[index].child);
            match on {
                Some(joint) => {
                    let body = self.body(link, (Some(joint), pose));
                    chain.joints[joint].body = chain.joints[joint].body + body;
                }
                None if chain.floating_base.is_some() => {
                    let body = self.body(link, (None, pose));
                    chain.floating_base = chain.floating_base.map(|base| base + body);
                }
                None => {
                    let link = &self.urdf.links[link];
                    self.standing += link.mass;
                    self.frames.push(ChainFrame { name: link.name.clone(), on, place: pose });
                }
            }
            if let (true, Some(joint)) = (link == tip, on) {
                (chain.tip_on, chain.tip) = (joint, pose);
            }
            let joints = self.urdf.links[link].children.iter().rev();
            open.extend(joints.map(|&joint| (Some(joint), on, pose)));
        }
        let error = |message: String| Err(self.urdf.source.error(&self.urdf.links[base].span, message, None));
        // joints that nobody holds are the mistake
        if !self.loose.is_empty() {
            return Ok(());
        }
        if chain.joints.is_empty() {
            return error(format!("there is no movable joint after {}", quoted(&self.told.base)));
        }
        let moves_tip = path(self.urdf, base, tip)?.iter().any(|joint| self.moving.contains(joint));
        if !moves_tip {
            return error(format!("no movable joint moves the tip {}", quoted(&self.told.tip)));
        }
        Ok(())
    }

    /// The body of a link alone, seen from the frame in which it stands at `pose`; `on` is the joint that moves it,
    /// `None` on a floating base.
    fn body(&mut self, index: usize, (on, pose): (Option<usize>, Pose)) -> Body {
        let link = &self.urdf.links[index];
        self.told.links.insert(index);
        self.frames.push(ChainFrame { name: link.name.clone(), on, place: pose });
        if !link.has_mass() {
            return Body::NONE;
        }
        let rpy = self.snapping.rpy(&format!("inertia of {}", link.name), link.rpy);
        if let Some(lumped) = on.and_then(|on| self.told.lumped.get_mut(on)) {
            lumped.push(link.name.clone());
        }
        Body::at(link.mass, Pose::new(link.xyz, rpy), link.inertia).seen_from(pose)
    }

    /// A joint of the chain must be one that a table has.
    fn refuse(&self, joint: &Joint) -> Result<(), Report> {
        let error = |message: String, help: String| Err(self.urdf.source.error(&joint.span, message, help));
        let name = quoted(&joint.name);
        if !joint.kind.has_one_freedom() {
            let message = format!("the joint {name} on the chain is {}", joint.kind.name());
            return error(message, format!("{SEVERAL}, or choose base and tip so that this joint is not between them"));
        }
        if let Some(mimic) = joint.mimic.as_ref().filter(|_| !self.selection.whole) {
            let message = format!("the joint {name} on the chain follows {}", quoted(&mimic.joint));
            let help = "its torque acts on the joint that it follows, and no row of the table can describe this: end \
                        the chain before this joint, lock it, or import the whole robot"
                .to_owned();
            let remedy = Remedy::WholeOrLock { joint: one_line(&joint.name) };
            return Err(self.urdf.source.error_with(&joint.span, message, help, &remedy));
        }
        if joint.axis == [0.0; 3] {
            return error(
                format!("the axis of the joint {name} has no direction"),
                "write a direction, such as 0 0 1".to_owned(),
            );
        }
        Ok(())
    }

    /// Remarks on a moving joint of the chain.
    fn remark(&mut self, index: usize) {
        self.told.joints.insert(index);
        let joint = &self.urdf.joints[index];
        let name = one_line(&joint.name);
        if !joint.has_axis {
            self.told.remarks.push(format!("the joint {name} has no element `axis`, so its axis is 1 0 0"));
        }
        if let Some((lower, upper)) = joint.crossed {
            self.told.remarks.push(Remark::warning(format!(
                "the joint {name} has a lower limit, {lower}, above its upper limit, {upper}; rne ignores both limits"
            )));
        }
        for (limit, value) in &joint.negative {
            let what = format!("the joint {name} has a negative limit of {limit}, {value}; rne ignores it");
            self.told.remarks.push(Remark::warning(what));
        }
    }

    /// The link and all that is fixed to it, but for what hangs on the joint `next`, seen from the frame in which the
    /// link stands at `pose`.
    /// `on` is the joint that moves them.
    fn lump(&mut self, link: usize, (on, pose): (usize, Pose), next: Option<usize>) -> Result<Body, Report> {
        let mut body = Body::NONE;
        let mut open = vec![(link, pose)];
        while let Some((index, pose)) = open.pop() {
            body = body + self.body(index, (Some(on), pose));
            let link = &self.urdf.links[index];
            let hanging = link.children.iter().filter(|&&joint| Some(joint) != next);
            let below: Vec<(usize, Pose)> = hanging
                .map(|&joint| Ok((self.urdf.joints[joint].child, pose * self.across(joint)?)))
                .collect::<Result<_, Report>>()?;
            open.extend(below.into_iter().rev());
        }
        Ok(body)
    }

    /// Collects the frames on the base: the link and all links that fixed joints fix to it, but for what hangs on the
    /// joint `next`.
    fn frames_of_base(&mut self, link: usize, pose: Pose, next: Option<usize>) {
        // what is snapped beside the arm changes no torque, and is not told
        let mut snapping = Snapping { is_on: self.snapping.is_on, ..Snapping::default() };
        let mut open = vec![(link, pose)];
        while let Some((index, pose)) = open.pop() {
            let link = &self.urdf.links[index];
            self.standing += link.mass;
            self.frames.push(ChainFrame { name: link.name.clone(), on: None, place: pose });
            for &index in link.children.iter().rev().filter(|&&joint| Some(joint) != next) {
                let joint = &self.urdf.joints[index];
                if joint.kind == crate::urdf::Kind::Fixed {
                    let rpy = snapping.rpy(&joint.name, joint.rpy);
                    open.push((joint.child, pose * Pose::new(joint.xyz, rpy)));
                }
            }
        }
    }

    /// A joint on a link that stands still moves by itself, unless it follows a joint of the chain.
    fn aside(&mut self, link: usize, next: Option<usize>) {
        let mut open = vec![link];
        while let Some(index) = open.pop() {
            for &index in self.urdf.links[index].children.iter().rev().filter(|&&joint| Some(joint) != next) {
                let joint = &self.urdf.joints[index];
                if joint.kind != crate::urdf::Kind::Fixed {
                    self.look_at_follower(index);
                    self.told.aside.push(joint.name.clone());
                }
                open.push(joint.child);
            }
        }
    }
}

/// Whether a position is within limits, to a millionth: limits are rounded, too.
fn is_within(value: f64, lower: f64, upper: f64) -> bool {
    (lower - 1e-6..=upper + 1e-6).contains(&value)
}
