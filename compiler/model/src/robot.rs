//! The validated robot: all data of a robot file, with every expression evaluated.

use crate::{
    Angle, Bodies, ClosedLoops, Contact, Convention, Coupling, Drive, FixedFrame, FloatingBase, Frame, FrameId,
    Friction, Inertia, JointKind, Model, Motor, Row, RunTime, Transform,
};

/// A validated robot, as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Identifier, `[a-z][a-z0-9_]*`.
    pub name: String,
    /// A title for human readers.
    pub title: Option<String>,
    /// Where the numbers of the file come from.
    pub source: String,
    /// Free text, such as which numbers are doubtful or converted.
    pub notes: Option<String>,
    /// Standard or modified rows.
    pub convention: Convention,
    /// Acceleration of gravity in frame 0, m/s² (it points down).
    pub gravity: [f64; 3],
    /// World → frame 0. Places the arm; never turns gravity.
    pub base: Transform,
    /// The link of frame 0, if the base floats; `None` for a base that is fixed to the world.
    pub floating_base: Option<FloatingBase>,
    /// Placement of the tip frame in the link frame of the last row, or of [`tip_on`](Self::tip_on).
    pub tool: Transform,
    /// The joint whose link carries the tip frame, counted from 0; `None` for the last row.
    pub tip_on: Option<usize>,
    /// The parameters of the file with their values, in the order of the file.
    pub parameters: Vec<(String, f64)>,
    /// The joints, 1 to 64, base to tip; in a tree each comes after the joint whose link carries it.
    pub joints: Vec<Joint>,
    /// The list `motors` of the file, in its order.
    pub drives: Vec<Drive>,
    /// The named frames of the file, in its order: places on links, in addition to the tip.
    pub frames: Vec<Frame>,
    /// The frames on which wrenches act, as indices into `frames`; empty where only the tip frame is one.
    pub tips: Vec<usize>,
    /// The tips that the surroundings hold, in the order of the file.
    pub contacts: Vec<Contact>,
    /// The closed loops, whose dependent joints are no coordinates.
    pub closed: ClosedLoops,
    /// The bodies that are fixed to links. The numbers of these links include them already.
    pub bodies: Bodies,
    /// The frame for which kinematic functions (pose, Jacobian, J̇q̇, torques of a wrench) are computed instead of the
    /// tip; `None` for the tip. A file never sets it, [`Robot::at_frame`] does. Other functions stay those of the tip.
    pub at: Option<FrameId>,
    /// The parameters that stay free until run time, and which numbers depend on them; empty unless the caller names
    /// some with [`Reader::run_time`](crate::Reader::run_time).
    pub run_time: RunTime,
    /// Whether torques include the inertia of motor rotors. A file never sets it, [`Robot::with_rotors`] does.
    pub rotors: bool,
}

/// One joint of a [`Robot`], with the link that the joint moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The name of the joint; `joint1`, `joint2`, … when the file gives none.
    pub name: String,
    /// Kind, Denavit-Hartenberg parameters and link (inertia about the centre of mass).
    pub row: Row,
    /// The link that carries the joint, and where on it the row of the joint begins; `None` if it begins at the link
    /// frame of the row before. `gamma` and `b` of a file are such a placement, Rz(gamma) Tz(b).
    pub branch: Option<FixedFrame>,
    /// The inertia of the link as the file writes it, and the point about which it is.
    pub written_inertia: (Inertia, InertiaReference),
    /// Position, velocity and effort limits of the joint.
    pub limits: Limits,
    /// How the joint follows others; such a joint is no coordinate of the robot. `None` for an independent joint.
    pub coupling: Option<Coupling>,
    /// The motor of the joint, if the file gives one.
    pub motor: Option<Motor>,
    /// The speed about which Coulomb friction changes its sign, rad/s or m/s, if it is known: the `width` of smooth
    /// friction. It is for information, as limits are.
    pub coulomb_width: Option<f64>,
    /// The displacement over which Coulomb friction changes its sign after a reversal, rad or m, if it is known: Dahl's
    /// friction model uses it. It is for information, as limits are.
    pub coulomb_displacement: Option<f64>,
}

/// The point a written inertia tensor refers to; its axes are the link's in both cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InertiaReference {
    /// The link's centre of mass.
    Com,
    /// The origin of the link frame.
    Origin,
}

/// Limits of a joint; `None` where the file says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Limits {
    /// Lower and upper end, rad or m.
    pub position: Option<(f64, f64)>,
    /// Largest speed, rad/s or m/s.
    pub velocity: Option<f64>,
    /// Largest torque or force, N m or N.
    pub effort: Option<f64>,
}

impl Joint {
    /// Returns the row for positions of 0 of the joints that this joint follows: the offset of its coupling is added to
    /// `theta` or `d`.
    #[must_use]
    pub fn row_with_offset(&self) -> Row {
        let mut row = self.row;
        match (&self.coupling, row.kind) {
            (Some(Coupling { offset, .. }), JointKind::Revolute) if *offset != 0.0 => {
                row.dh.theta = Angle::new(row.dh.theta.radians + offset);
            }
            (Some(Coupling { offset, .. }), JointKind::Prismatic) => row.dh.d += offset,
            _ => {}
        }
        row
    }

    /// Returns the friction at a constant speed that the joint has had for long, N m or N. [`Friction`] computes it
    /// along a motion.
    #[must_use]
    pub fn friction(&self, speed: f64) -> f64 {
        Friction::at(self, speed)
    }

    /// Returns the difference between the Coulomb friction of both directions, N m or N: a joint at rest may have any
    /// friction in this range.
    #[must_use]
    pub fn coulomb_span(&self) -> f64 {
        self.motor.map_or(0.0, |motor| motor.gear_ratio.abs() * (motor.coulomb[0] - motor.coulomb[1]))
    }

    /// Returns whether a physical body can have the inertia of the link: it is positive semidefinite about the centre
    /// of mass, up to rounding, and there is no first moment without mass. If not, a file must say `physical: false`.
    #[must_use]
    pub fn is_physical(&self) -> bool {
        self.row.link.is_physical(&self.written_inertia.0)
    }
}

impl Robot {
    /// Returns the number of coordinates, which are the joints that follow no other: q, q̇, q̈ and τ have this many
    /// elements.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.independent_joints().count()
    }

    /// Returns the joints that follow no other joint, counted from 0, in the order of q.
    pub fn coordinates(&self) -> impl DoubleEndedIterator<Item = usize> {
        (0..self.joints.len()).filter(|index| self.is_coordinate(*index))
    }

    /// Returns the joints that follow no other joint, in the order of q.
    pub fn independent_joints(&self) -> impl DoubleEndedIterator<Item = &Joint> {
        self.coordinates().map(|index| &self.joints[index])
    }

    /// Returns whether a joint follows no other joint, neither by a coupling nor by a closed loop.
    fn is_coordinate(&self, joint: usize) -> bool {
        self.joints[joint].coupling.is_none() && !self.closed.passive.contains(&joint)
    }

    /// Returns the joint that a coordinate, an element of q counted from 0, is the position of.
    #[must_use]
    pub fn independent_joint(&self, coordinate: usize) -> Option<&Joint> {
        self.independent_joints().nth(coordinate)
    }

    /// Returns the name of the joint of a coordinate, which is counted from 0; empty if there is no such coordinate.
    #[must_use]
    pub fn coordinate_name(&self, coordinate: usize) -> &str {
        self.independent_joint(coordinate).map_or("", |joint| &joint.name)
    }

    /// Returns the kind of the joint of a coordinate, which is counted from 0.
    #[must_use]
    pub fn coordinate_kind(&self, coordinate: usize) -> JointKind {
        self.independent_joint(coordinate).map_or(JointKind::Revolute, |joint| joint.row.kind)
    }

    /// Returns whether some joint follows others by a coupling.
    #[must_use]
    pub fn has_couplings(&self) -> bool {
        self.joints.iter().any(|joint| joint.coupling.is_some())
    }

    /// Returns the arm with its rotors: the inertia G² Jm of each motor rotor behind its gear is then part of the
    /// torques, the mass matrix, the kinetic energy and the forward dynamics. Friction is not included, and neither are
    /// gyroscopic torques of the rotors. A robot without motors stays as it is.
    #[must_use]
    pub fn with_rotors(self) -> Self {
        Self { rotors: true, ..self }
    }

    /// Returns whether the arm includes rotors, and some rotor has inertia.
    #[must_use]
    pub fn has_rotors(&self) -> bool {
        let resists = |motor: Motor| motor.inertia * motor.gear_ratio != 0.0;
        self.rotors && self.joints.iter().any(|joint| joint.motor.is_some_and(resists))
    }

    /// Returns the joint whose link carries `joint`, both counted from 0; `None` for the base. All recursions from link
    /// to link use it, because in a tree the parent is not always the row before.
    #[must_use]
    pub fn parent(&self, joint: usize) -> Option<usize> {
        parent(&self.joints, joint)
    }

    /// Returns the tip frame: the link that carries it, and its placement there.
    #[must_use]
    pub fn tip(&self) -> FixedFrame {
        FixedFrame { on: self.tip_on.or(self.joints.len().checked_sub(1)), placement: self.tool }
    }

    /// Returns whether each row begins where the row before it ends, and the last link carries the tip.
    #[must_use]
    pub fn is_serial(&self) -> bool {
        self.tip_on.is_none() && self.joints.iter().all(|joint| joint.branch.is_none())
    }

    /// Returns whether a file of `format: 1` can describe the robot: a chain on a fixed base with one tip, whose joints
    /// are independent and have motors of their own.
    #[must_use]
    pub fn is_chain(&self) -> bool {
        let has_more = self.has_couplings() || self.floating_base.is_some() || !self.closed.is_empty();
        self.is_serial() && !has_more && self.drives.is_empty() && self.tips.is_empty()
    }

    /// Returns the rows of the joints, base to tip.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &Row> + DoubleEndedIterator {
        self.joints.iter().map(|joint| &joint.row)
    }

    /// Converts the robot to a plain [`Model`], or returns `None` when it does not have `DOF` joints. A model does not
    /// say where the rows of a tree begin: [`Joint::branch`] and [`Robot::tip_on`] do.
    #[must_use]
    pub fn model<const DOF: usize>(&self) -> Option<Model<DOF>> {
        let rows: Vec<Row> = self.rows().copied().collect();
        let rows = rows.try_into().ok()?;
        Some(Model { convention: self.convention, gravity: self.gravity, base: self.base, tool: self.tool, rows })
    }
}

/// Returns the joint whose link carries `joint`, both counted from 0; `None` for the base.
pub(crate) fn parent(joints: &[Joint], joint: usize) -> Option<usize> {
    match joints.get(joint).and_then(|joint| joint.branch) {
        Some(branch) => branch.on,
        None => joint.checked_sub(1),
    }
}
