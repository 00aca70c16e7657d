//! Turns a tree of links into the chain between a base and a tip, or into a whole tree of joints. All links that are
//! fixed to a link are merged into it.

mod follower;
mod refusals;
mod remarks;
mod walk;

use std::collections::BTreeSet;
use std::ops::Range;

use rne_model::{Coupling, Limits, Motor, Report};

use self::walk::Walk;
use crate::body::Body;
use crate::geometry::{Pose, Vector};
use crate::remark::Remarks;
use crate::selection::{End, Selection, link, path, tip};
use crate::snap::Snapped;
use crate::urdf::Urdf;

/// Largest number of joints that a robot file may have.
const MAX_JOINTS: usize = 64;

/// A serial arm, or a whole tree: joints with bodies between them.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// Placement of the base in the world.
    pub(crate) base: Pose,
    /// The acceleration of gravity in the axes of the base, m/s².
    pub(crate) gravity: Vector,
    /// The floating base, if there is one: its mass and inertia about the origin of its frame.
    pub(crate) floating_base: Option<Body>,
    pub(crate) joints: Vec<ChainJoint>,
    /// The joint that moves the link of the tip, from 0.
    pub(crate) tip_on: usize,
    /// Placement of the tip frame in the frame of the link that carries it.
    pub(crate) tip: Pose,
    /// Other frames that are fixed to links of the chain, or to the base.
    pub(crate) frames: Vec<ChainFrame>,
    /// The closed loops in which joints of the chain move.
    pub(crate) loops: Vec<ChainLoop>,
}

impl Chain {
    /// Returns whether a table without branches can describe it: each link carries one joint, the last one carries the
    /// tip, no joint follows another one, and no loop is closed.
    pub(crate) fn is_serial(&self) -> bool {
        let follows_the_last =
            |(index, joint): (usize, &ChainJoint)| joint.parent == index.checked_sub(1) && joint.coupling.is_none();
        self.joints.iter().enumerate().all(follows_the_last)
            && self.tip_on + 1 == self.joints.len()
            && self.loops.is_empty()
    }

    /// Returns whether it is a serial arm on a fixed base. A serial arm on a floating base is not, because its table
    /// must keep the frame of this base.
    pub(crate) fn is_arm(&self) -> bool {
        self.is_serial() && self.floating_base.is_none()
    }
}

/// A closed loop of a chain.
#[derive(Clone, Debug)]
pub(crate) struct ChainLoop {
    /// The index of the loop in the list of the URDF.
    pub(crate) index: usize,
    /// Both ends: the joint that moves the link, from 0, or `None` for the base, and the place in the frame of this
    /// link.
    pub(crate) ends: [(Option<usize>, Pose); 2],
}

/// A frame that is fixed to a link of a chain.
#[derive(Clone, Debug)]
pub(crate) struct ChainFrame {
    pub(crate) name: String,
    /// The joint that moves the link, from 0; `None` for the base.
    pub(crate) on: Option<usize>,
    /// Placement of this frame in the frame of the link, or of the base.
    pub(crate) place: Pose,
}

/// A joint and the link that it moves; the link's frame is at the joint.
#[derive(Clone, Debug)]
pub(crate) struct ChainJoint {
    pub(crate) name: String,
    pub(crate) is_prismatic: bool,
    /// The joint whose link carries this joint, from 0; `None` for the base.
    pub(crate) parent: Option<usize>,
    /// Placement of the moved link's frame at q = 0, in the frame of the link that carries the joint, or of the base.
    pub(crate) place: Pose,
    /// The unit vector of the axis, in the link's axes.
    pub(crate) axis: Vector,
    /// Mass and inertia of the moved link, about the origin of its frame.
    pub(crate) body: Body,
    pub(crate) limits: Limits,
    pub(crate) motor: Option<Motor>,
    /// How the joint follows other joints of the chain; `None` for an independent joint.
    pub(crate) coupling: Option<Coupling>,
    pub(crate) coulomb_width: Option<f64>,
    pub(crate) coulomb_displacement: Option<f64>,
}

/// Events on the way from a tree to a chain.
#[derive(Clone, Debug, Default)]
pub(crate) struct Extracted {
    pub(crate) base: String,
    pub(crate) tip: String,
    /// For each joint of the chain, its place in the text.
    pub(crate) spans: Vec<Range<usize>>,
    /// For each joint of the chain, the index of the joint in the URDF.
    pub(crate) moving: Vec<usize>,
    /// For each joint of the chain, the links that were merged into the link that it moves.
    pub(crate) lumped: Vec<Vec<String>>,
    /// Joints that are locked, and the position at which they are.
    pub(crate) held: Vec<(String, f64)>,
    /// Movable joints on links that stand still, which do not belong to the arm.
    pub(crate) aside: Vec<String>,
    pub(crate) snapped: Vec<Snapped>,
    /// Whether the link that floats in the file became a floating base; `None` where none floats.
    pub(crate) floats: Option<bool>,
    /// Links whose mass and inertia are in the arm.
    pub(crate) links: BTreeSet<usize>,
    /// Joints of the chain, and joints that are locked.
    pub(crate) joints: BTreeSet<usize>,
    /// Remarks for the reader of the robot file, in sentences.
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
    let mut walk = Walk::new(urdf, selection, &path, [base, tip], snap)?;
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
        // a floating base has no placement in the world, and gravity is given in the axes of the world
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
    walk.refuse_loose()?;
    walk.refuse_followers_outside()?;
    walk.remark_on_standing_base();
    chain.loops = walk.loops(base)?;
    walk.remark_on_other_ends(&others);
    chain.frames = walk.frames;
    Ok((chain, Extracted { snapped: walk.snapping.found, ..walk.told }))
}
