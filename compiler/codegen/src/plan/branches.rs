//! Branches of the tree of a robot: those on the base share no operation, and branches of the same structure can share
//! their choices.

use rustc_hash::FxHashMap;
use std::ops::Range;

use crate::coordinates::Coordinates;
use crate::ir::{Cost, Residue};
use crate::plan::Plan;
use crate::plan::cost::OpenJoint;
use crate::reduced::joint_frames::Tip;
use crate::reduced::{JointFrame, JointFrames, Parameters};

/// A joint on the base with all links that it carries. Such a branch shares no operation with others, so its operations
/// are counted alone.
#[derive(Clone, Debug)]
pub(crate) struct BaseBranch {
    rows: Range<usize>,
    pub(crate) joint_frames: JointFrames,
    /// The costs of its plans. The key has the values of both scales, because a unit may be a length of another branch.
    pub(crate) known: FxHashMap<(Plan, [Residue; 2]), Option<Cost>>,
}

impl BaseBranch {
    /// Returns the branches of the base. There are none if the base floats or carries one joint, if the rows of two
    /// branches are mixed, or if joints follow others or a rotor turns with several joints: then torques of branches
    /// depend on each other.
    pub(crate) fn of(joint_frames: &JointFrames) -> Vec<Self> {
        let turn_together =
            !joint_frames.coupled.is_empty() || joint_frames.rows.iter().any(|row| !row.gyrostats.is_empty());
        if !joint_frames.coordinates.is_every_joint() || turn_together || joint_frames.base.is_some() {
            return Vec::new();
        }
        let rows = &joint_frames.rows;
        let starts: Vec<usize> = (0..rows.len()).filter(|&index| rows[index].parent.is_none()).collect();
        let ends = starts.iter().skip(1).copied().chain([rows.len()]);
        let ranges: Vec<Range<usize>> = starts.iter().zip(ends).map(|(&start, end)| start..end).collect();
        let is_whole = |range: &Range<usize>| {
            rows[range.clone()].iter().skip(1).all(|row| row.parent.is_some_and(|parent| range.contains(&parent)))
        };
        if ranges.len() < 2 || !ranges.iter().all(is_whole) {
            return Vec::new();
        }
        let branch = |rows: Range<usize>| {
            let joint_frames = joint_frames.of_rows(rows.clone());
            Self { rows, joint_frames, known: FxHashMap::default() }
        };
        ranges.into_iter().map(branch).collect()
    }

    /// Returns the part of a plan for this branch: the choices of its joints, with those of the whole arm.
    pub(crate) fn plan(&self, plan: &Plan) -> Plan {
        Plan { joints: plan.joints[self.rows.clone()].to_vec(), ..plan.clone() }
    }

    /// Returns the parameters of the links of this branch.
    pub(crate) fn parameters(&self, parameters: &Parameters) -> Parameters {
        let has_last = self.rows.end == parameters.links.len();
        Parameters {
            links: parameters.links[self.rows.clone()].to_vec(),
            base: parameters.base,
            origin_shifts: parameters.origin_shifts[self.rows.clone()].to_vec(),
            sphere: parameters.sphere.filter(|_| has_last),
            lambda: parameters.lambda[self.rows.clone()].to_vec(),
            mu: parameters.mu[self.rows.clone()].to_vec(),
        }
    }
}

impl JointFrames {
    /// Returns the frames of a range of rows on which no other row depends. A tip elsewhere is moved to the last of
    /// these rows.
    fn of_rows(&self, run: Range<usize>) -> Self {
        let from_start = |index: usize| index.checked_sub(run.start);
        let row = |row: &JointFrame| JointFrame { parent: row.parent.and_then(from_start), ..row.clone() };
        let moved = |tip: &Tip| {
            let on = if run.contains(&tip.on) { tip.on } else { run.end - 1 };
            Tip { on: on - run.start, ..*tip }
        };
        let tips = self.tips.iter().map(moved).collect();
        Self {
            rows: self.rows[run.clone()].iter().map(row).collect(),
            gravity: self.gravity[run.clone()].to_vec(),
            tips,
            coordinates: Coordinates::of_free_joints(run.len()),
            rotors: self.rotors[run].to_vec(),
            ..self.clone()
        }
    }
}

/// Returns a joint on the base and the joints that it carries, if several joints are on the base; empty for other
/// joints.
pub(crate) fn scaled(rows: &[JointFrame], index: usize) -> Vec<usize> {
    let on_base = rows.iter().filter(|row| row.parent.is_none()).count();
    if rows[index].parent.is_some() || on_base < 2 {
        return Vec::new();
    }
    let is_behind = |other: &usize| {
        let mut parents = std::iter::successors(Some(*other), |&joint| rows[joint].parent);
        parents.any(|joint| joint == index)
    };
    (index..rows.len()).filter(is_behind).collect()
}

/// Returns, for each joint, itself and the joints in the same place of branches of the same structure. Such branches
/// begin at the same link, or at links in the same place, and have the same kinds of joints with the same parallel or
/// twisted axes. Numbers do not count, so a left arm and a right arm have the same structure.
pub(crate) fn alike(rows: &[JointFrame], joints: &[OpenJoint]) -> Vec<Vec<usize>> {
    let mut shapes: Vec<String> = vec![String::new(); rows.len()];
    for index in (0..rows.len()).rev() {
        let OpenJoint { kind, is_parallel, is_twisted, .. } = &joints[index];
        let carried: Vec<&str> = (index + 1..rows.len())
            .filter(|&other| rows[other].parent == Some(index))
            .map(|other| shapes[other].as_str())
            .collect();
        shapes[index] = format!("{kind:?} {is_parallel} {is_twisted} ({})", carried.join(","));
    }
    let mut places: Vec<usize> = Vec::with_capacity(rows.len());
    for index in 0..rows.len() {
        let place_of_parent = |joint: usize| rows[joint].parent.map(|parent| places[parent]);
        let is_alike =
            |other: &usize| place_of_parent(*other) == place_of_parent(index) && shapes[*other] == shapes[index];
        let place = (0..index).find(is_alike).unwrap_or(index);
        places.push(place);
    }
    places.iter().map(|place| (0..rows.len()).filter(|&other| places[other] == *place).collect()).collect()
}
