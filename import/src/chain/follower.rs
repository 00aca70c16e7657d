//! Joints that are locked, and joints that follow other joints (`mimic`, and `coupling` of URDF+).

use rne_model::{Coupling, Motor, Report, one_line};

use super::Chain;
use super::refusals::lock;
use super::walk::Walk;
use crate::source::{quoted, some};
use crate::urdf::{Gear, Joint, Mimic};

impl Walk<'_> {
    /// Returns the position at which a joint is locked, if it is locked. A joint that follows a locked joint is locked
    /// by it.
    pub(super) fn held(&mut self, index: usize) -> Result<Option<f64>, Report> {
        if !self.selection.lock_others && !self.locks.contains_key(&index) {
            return Ok(None);
        }
        self.look_at_follower(index);
        let value = self.held_by(self.follows(index)?);
        self.look_at_locked(index, value);
        Ok(Some(value))
    }

    /// Returns the position of a joint that follows a locked joint, through the joints in between.
    fn held_by(&self, (mimics, leader): (Vec<&Mimic>, usize)) -> f64 {
        let start = self.locks.get(&leader).copied().unwrap_or(0.0);
        mimics.iter().rev().fold(start, |value, mimic| mimic.multiplier * value + mimic.offset)
    }

    /// Remarks on a joint that is locked by name at another position than the one where the locked joint that it
    /// follows puts it: the robot cannot have both.
    fn look_at_locked(&mut self, index: usize, value: f64) {
        let joint = &self.urdf.joints[index];
        let leader = joint.mimic.as_ref().filter(|_| self.locks.contains_key(&index)).and_then(|mimic| {
            let (mut mimics, leader) = self.follows(mimic.leader?).ok()?;
            mimics.insert(0, mimic);
            (!self.moving.contains(&leader)).then_some((mimics, leader))
        });
        let Some((mimics, leader)) = leader else { return };
        let followed = self.held_by((mimics, leader));
        if (followed - value).abs() > 1e-9 * followed.abs().max(1.0) {
            let [name, leader] = [&joint.name, &self.urdf.joints[leader].name].map(|name| one_line(name));
            self.told.remarks.push(format!(
                "the joint {name} is locked at {value}, although it follows {leader}, whose position would put it at \
                 {followed}"
            ));
        }
    }

    /// Returns the joints that a joint follows one after the other, up to the first that is locked by name or follows
    /// none, and the index of this first one.
    pub(super) fn follows(&self, index: usize) -> Result<(Vec<&Mimic>, usize), Report> {
        let joints = &self.urdf.joints;
        let (mut mimics, mut leader) = (Vec::new(), index);
        while let Some(mimic) = joints[leader].mimic.as_ref().filter(|_| !self.locks.contains_key(&leader)) {
            let joint = &joints[leader];
            let error = |message: String| {
                let help = "correct the `mimic` of this joint, or lock the joint";
                self.urdf.source.error_with(&joint.span, message, help, &lock(&joint.name))
            };
            leader = mimic.leader.ok_or_else(|| {
                let free = joints.iter().enumerate().filter(|(at, _)| !self.locks.contains_key(at));
                let pair = |(_, joint): (usize, &Joint)| {
                    let lost = joint.mimic.as_ref().filter(|mimic| mimic.leader.is_none())?;
                    Some(format!("{} follows {}", quoted(&joint.name), quoted(&lost.joint)))
                };
                let pairs: Vec<String> = free.filter_map(pair).collect();
                error(if pairs.len() > 1 {
                    format!("joints follow others that the file has not: {}", some(pairs))
                } else {
                    format!("the joint {}, but the file has no such joint", some(pairs))
                })
            })?;
            mimics.push(mimic);
            if mimics.len() > joints.len() {
                let (follower, leader) = (quoted(&joint.name), quoted(&mimic.joint));
                return Err(error(format!(
                    "the joint {follower} follows {leader}, and the `mimic` elements form a circle"
                )));
            }
        }
        Ok((mimics, leader))
    }

    /// Returns the moving joint of the chain that a joint follows, if it follows one, even if the joint itself is
    /// locked.
    pub(super) fn moving_leader(&self, index: usize) -> Option<usize> {
        let mimic = self.urdf.joints[index].mimic.as_ref()?;
        let (mimics, leader) = self.follows(mimic.leader?).ok()?;
        let moves = self.moving.contains(&leader) && mimics.iter().all(|mimic| mimic.multiplier != 0.0);
        (moves && mimic.multiplier != 0.0).then_some(leader)
    }

    /// Checks whether a joint outside the chain follows a moving joint of the chain. A table cannot describe this
    /// motion, so the joint is refused at the end of the walk, unless it is locked by name or carries no mass.
    pub(super) fn look_at_follower(&mut self, index: usize) {
        let Some(leader) = self.moving_leader(index) else { return };
        let joint = &self.urdf.joints[index];
        let is_locked = self.locks.contains_key(&index);
        if !is_locked && self.carries_mass(joint.child) {
            self.followers.push((index, leader));
            return;
        }
        let [name, leader] = [&joint.name, &self.urdf.joints[leader].name].map(|name| one_line(name));
        self.told.remarks.push(if is_locked {
            format!("the joint {name} is locked, although it follows {leader}, which moves")
        } else {
            format!("the joint {name} follows {leader}, which moves; no link after it has mass, so rne locks it")
        });
    }

    /// Stores how a joint of a whole robot follows another one; `place` is the index of the follower in the chain. A
    /// joint that follows a locked joint is refused, because it does not move.
    pub(super) fn look_at_coupling(&mut self, index: usize, place: usize) -> Result<(), Report> {
        self.places.insert(index, place);
        let joint = &self.urdf.joints[index];
        if !self.selection.whole {
            return Ok(());
        }
        if let Some(gear) = self.urdf.gears.iter().find(|gear| gear.joint == index) {
            return self.look_at_gear(gear, place);
        }
        let Some(mimic) = joint.mimic.as_ref() else { return Ok(()) };
        let (mimics, leader) = self.follows(index)?;
        let (ratio, offset) = mimics
            .iter()
            .fold((1.0, 0.0), |(ratio, offset), mimic| (ratio * mimic.multiplier, offset + ratio * mimic.offset));
        if ratio == 0.0 || !self.moving.contains(&leader) {
            let why = if ratio == 0.0 { "with multiplier 0" } else { "which is locked" };
            let [name, leader] = [&joint.name, &mimic.joint].map(|name| quoted(name));
            let message = format!("the joint {name} follows {leader}, {why}, so it does not move");
            let help = "lock this joint";
            return Err(self.urdf.source.error_with(&joint.span, message, help, &lock(&joint.name)));
        }
        if joint.friction != [0.0; 2] {
            let [name, leader] = [&joint.name, &self.urdf.joints[leader].name].map(|name| one_line(name));
            self.told.remarks.push(format!(
                "the joint {name} follows {leader}; its friction is left out, because a joint that follows has no motor"
            ));
        }
        let rotor = joint.rotor_inertia * joint.gear_ratio * joint.gear_ratio;
        self.coupled.push(Coupled { place, follows: vec![(leader, ratio)], offset, rotor });
        Ok(())
    }

    /// Stores how a joint follows others by gears. These must move and must not be followers themselves.
    fn look_at_gear(&mut self, gear: &Gear, place: usize) -> Result<(), Report> {
        let joints = &self.urdf.joints;
        let follows =
            |joint: usize| joints[joint].mimic.is_some() || self.urdf.gears.iter().any(|other| other.joint == joint);
        let name = quoted(&joints[gear.joint].name);
        if joints[gear.joint].mimic.is_some() {
            let message = format!("the joint {name} follows others twice, by `mimic` and by a coupling");
            return Err(self.urdf.source.error(&gear.span, message, "delete one of both"));
        }
        if let Some(&(followed, _)) =
            gear.follows.iter().find(|(joint, _)| follows(*joint) || !self.moving.contains(joint))
        {
            let why = if follows(followed) { "follows others itself" } else { "is locked" };
            let message = format!("the joint {name} follows {}, which {why}", quoted(&joints[followed].name));
            let help = "lock this joint, or let it follow joints that move";
            return Err(self.urdf.source.error_with(&gear.span, message, help, &lock(&joints[gear.joint].name)));
        }
        self.coupled.push(Coupled { place, follows: gear.follows.clone(), offset: 0.0, rotor: 0.0 });
        Ok(())
    }

    /// Gives each follower of the chain its coupling.
    pub(super) fn couple(&self, chain: &mut Chain) {
        for Coupled { place, follows, offset, rotor } in &self.coupled {
            let placed = |&(joint, ratio): &(usize, f64)| Some((*self.places.get(&joint)?, ratio));
            let mut follows: Vec<(usize, f64)> = follows.iter().filter_map(placed).collect();
            follows.sort_by_key(|(joint, _)| *joint);
            // the rotor of a follower turns with the followed joint, so its inertia is added to the rotor there
            if let ([(leader, ratio)], true) = (&follows[..], *rotor != 0.0) {
                let motor = chain.joints[*leader].motor.get_or_insert(NO_MOTOR);
                motor.inertia += ratio * ratio * rotor / (motor.gear_ratio * motor.gear_ratio);
            }
            if !follows.is_empty() {
                chain.joints[*place].coupling = Some(Coupling { follows, offset: *offset });
            }
        }
    }
}

/// A joint that follows others.
pub(super) struct Coupled {
    /// The index of the follower in the chain.
    place: usize,
    /// The joints of the URDF that it follows, which are no followers themselves, and the ratios.
    follows: Vec<(usize, f64)>,
    offset: f64,
    /// The inertia of the follower's rotor, at its joint.
    rotor: f64,
}

/// A motor without rotor, gear and friction.
const NO_MOTOR: Motor = Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.0, coulomb: [0.0; 2] };
