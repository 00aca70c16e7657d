//! Walks through the tree of links and merges all links that are fixed to a link into it.

use std::collections::{BTreeSet, HashMap};

use rne_model::{Motor, Remedy, Report, one_line};

use super::follower::Coupled;
use super::{Chain, ChainFrame, ChainJoint, ChainLoop, Extracted};
use crate::body::Body;
use crate::geometry::{Pose, Rotation, Vector, decimal};
use crate::selection::{Selection, locks, path, refuse_value};
use crate::snap::Snapping;
use crate::source::quoted;
use crate::urdf::{Joint, Kind, Urdf};

/// A walk through the tree of links.
pub(super) struct Walk<'a> {
    pub(super) urdf: &'a Urdf,
    pub(super) selection: &'a Selection,
    pub(super) locks: HashMap<usize, f64>,
    /// The joints of the chain that move.
    pub(super) moving: BTreeSet<usize>,
    pub(super) snapping: Snapping,
    /// Movable joints outside the chain that are not locked.
    pub(super) loose: Vec<usize>,
    /// Joints outside the chain, each with the joint of the chain that it follows.
    pub(super) followers: Vec<(usize, usize)>,
    /// Joints of a whole robot that follow others.
    pub(super) coupled: Vec<Coupled>,
    /// For each moving joint of the URDF, its index in the chain.
    pub(super) places: HashMap<usize, usize>,
    /// The frames of the links, each with its placement on the chain.
    pub(super) frames: Vec<ChainFrame>,
    /// Total mass of the links that stand still with the base, kg.
    pub(super) standing: f64,
    pub(super) told: Extracted,
}

impl<'a> Walk<'a> {
    /// Prepares a walk. `path` has the joints from the link `base` to the link `tip`.
    pub(super) fn new(
        urdf: &'a Urdf,
        selection: &'a Selection,
        path: &[usize],
        [base, tip]: [usize; 2],
        snap: bool,
    ) -> Result<Self, Report> {
        let locks = locks(urdf, selection)?;
        let moves = |&joint: &usize| urdf.joints[joint].kind.has_one_freedom() && !locks.contains_key(&joint);
        Ok(Self {
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
        })
    }

    /// Returns the placement of the base in the world; the joints from the root to the base are locked.
    pub(super) fn base(&mut self, base: usize) -> Result<Pose, Report> {
        let before = path(self.urdf, self.urdf.root, base)?;
        let mut pose = Pose::identity();
        for joint in before {
            pose = pose * self.across(joint)?;
        }
        Ok(pose)
    }

    /// Returns the placement of the link after a locked or fixed joint, in the frame of the link before it.
    fn across(&mut self, index: usize) -> Result<Pose, Report> {
        let joint = &self.urdf.joints[index];
        self.told.joints.insert(index);
        let place = self.place(joint);
        if joint.kind == Kind::Fixed {
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
            Kind::Prismatic => Pose { rotation: Rotation::identity(), translation: self.axis(joint) * decimal(value) },
            kind if kind.has_one_freedom() => {
                Pose { rotation: Rotation::about(self.axis(joint), value), translation: Vector::ZERO }
            }
            // Planar, floating and spherical joints are locked at zero.
            _ => Pose::identity(),
        };
        Ok(place * moved)
    }

    /// Returns whether a link, or a link after it, has mass or inertia.
    pub(super) fn carries_mass(&self, link: usize) -> bool {
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

    /// Returns the unit vector of a joint axis, or the default x if the axis has no direction. `along` and `locks` have
    /// refused a zero axis where it matters.
    fn axis(&mut self, joint: &Joint) -> Vector {
        let direction = Vector::decimal(joint.axis).direction().unwrap_or_else(|| Vector::unit(0));
        self.snapping.axis(&format!("joint {}", joint.name), joint.axis, direction)
    }

    pub(super) fn along(&mut self, base: usize, path: &[usize], chain: &mut Chain) -> Result<(), Report> {
        // The frame of the current link in the frame of the last moving link.
        let mut pose = Pose::identity();
        self.aside(base, path.first().copied());
        self.frames_of_base(base, pose, path.first().copied());
        for (i, &index) in path.iter().enumerate() {
            let next = path.get(i + 1).copied();
            let joint = &self.urdf.joints[index];
            if joint.kind == Kind::Fixed || self.locks.contains_key(&index) {
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

    /// Adds a joint that moves a link of the robot to the chain.
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
        // a follower has no motor: the motor of the joint that it follows moves it
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
            is_prismatic: joint.kind == Kind::Prismatic,
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

    /// Returns the closed loops that moving joints are in. A loop that no joint moves is left out, with a remark.
    pub(super) fn loops(&mut self, base: usize) -> Result<Vec<ChainLoop>, Report> {
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

    /// Adds all links after the base, branch by branch.
    pub(super) fn whole(&mut self, base: usize, tip: usize, chain: &mut Chain) -> Result<(), Report> {
        // stack of: a joint to cross, the joint that moves the link before it, and the placement of this link in the
        // frame of the last moving link
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
        // movable joints that are not locked are refused elsewhere, with a better message
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

    /// Returns mass and inertia of a link alone, in the frame in which its placement is `pose`. `on` is the joint that
    /// moves the link, `None` on a floating base.
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

    /// Merges a link with all links that are fixed to it, except those after the joint `next`, and returns mass and
    /// inertia in the frame in which the placement of the link is `pose`. `on` is the joint that moves them.
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

    /// Collects the frames of the base link and of all links that fixed joints attach to it, except those after the
    /// joint `next`.
    fn frames_of_base(&mut self, link: usize, pose: Pose, next: Option<usize>) {
        // snapped angles on the base change no torque, so no remark lists them
        let mut snapping = Snapping { is_on: self.snapping.is_on, ..Snapping::default() };
        let mut open = vec![(link, pose)];
        while let Some((index, pose)) = open.pop() {
            let link = &self.urdf.links[index];
            self.standing += link.mass;
            self.frames.push(ChainFrame { name: link.name.clone(), on: None, place: pose });
            for &index in link.children.iter().rev().filter(|&&joint| Some(joint) != next) {
                let joint = &self.urdf.joints[index];
                if joint.kind == Kind::Fixed {
                    let rpy = snapping.rpy(&joint.name, joint.rpy);
                    open.push((joint.child, pose * Pose::new(joint.xyz, rpy)));
                }
            }
        }
    }

    /// Records the joints after a link that stands still as joints that do not belong to the arm, except those after
    /// the joint `next`. Joints among them that follow a joint of the chain are checked.
    fn aside(&mut self, link: usize, next: Option<usize>) {
        let mut open = vec![link];
        while let Some(index) = open.pop() {
            for &index in self.urdf.links[index].children.iter().rev().filter(|&&joint| Some(joint) != next) {
                let joint = &self.urdf.joints[index];
                if joint.kind != Kind::Fixed {
                    self.look_at_follower(index);
                    self.told.aside.push(joint.name.clone());
                }
                open.push(joint.child);
            }
        }
    }
}

/// Returns whether a position is within limits up to 1e-6, because limits are rounded, too.
fn is_within(value: f64, lower: f64, upper: f64) -> bool {
    (lower - 1e-6..=upper + 1e-6).contains(&value)
}
