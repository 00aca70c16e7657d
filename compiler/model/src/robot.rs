//! The validated robot: what a robot file says, with every expression evaluated.

use crate::{
    Angle, Bodies, ClosedLoops, Contact, Convention, Coupling, Drive, FixedFrame, FloatingBase, Frame, FrameId,
    Friction, Inertia, JointKind, Model, Motor, Row, RunTime, Transform,
};

/// A validated robot, as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Identifier, `[a-z][a-z0-9_]*`.
    pub name: String,
    /// A title for people.
    pub title: Option<String>,
    /// Where the numbers come from.
    pub source: String,
    /// Free text: what is doubtful, what was converted.
    pub notes: Option<String>,
    /// Standard or modified rows.
    pub convention: Convention,
    /// Acceleration of gravity in frame 0, m/s² (it points down).
    pub gravity: [f64; 3],
    /// World → frame 0. Places the arm; never turns gravity.
    pub base: Transform,
    /// The link of frame 0, if the base floats; `None` for a base that is fixed to the world.
    pub floating_base: Option<FloatingBase>,
    /// Link frame → tip frame: of the last row, or of [`tip_on`](Self::tip_on).
    pub tool: Transform,
    /// The joint whose link carries the tip frame, counted from 0; `None` for the last row.
    pub tip_on: Option<usize>,
    /// The named constants of the file, in its order, evaluated.
    pub parameters: Vec<(String, f64)>,
    /// The joints, 1 to 64: base to tip, and in a tree each behind the joint that carries it.
    pub joints: Vec<Joint>,
    /// The list `motors` of the file, in its order.
    pub drives: Vec<Drive>,
    /// The named frames of the file, in its order: places on links, beside the tip.
    pub frames: Vec<Frame>,
    /// The frames that carry wrenches, by their places in `frames`; empty where the tip frame alone does.
    pub tips: Vec<usize>,
    /// The tips that something outside the robot holds, in the order of the file.
    pub contacts: Vec<Contact>,
    /// The closed loops, whose dependent joints are no coordinates.
    pub closed: ClosedLoops,
    /// The bodies that are fixed to links. They are parts of these links already.
    pub bodies: Bodies,
    /// The frame that the kinematic functions of the tip are taken at instead of the tip (pose, Jacobian, J̇q̇, torques
    /// of a wrench); no file says so, [`Robot::at_frame`] does. Other functions stay those of the tip.
    pub at: Option<FrameId>,
    /// The parameters that stay free until run time, and which numbers depend on them; empty unless asked for, by
    /// [`Reader::run_time`](crate::Reader::run_time).
    pub run_time: RunTime,
    /// Whether rotors belong to the arm; no file says so, [`Robot::with_rotors`] does.
    pub rotors: bool,
}

/// One joint of a [`Robot`], with the link it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name; `joint1`, `joint2`, … when the file gives none.
    pub name: String,
    /// Kind, Denavit-Hartenberg parameters and link (inertia about the centre of mass).
    pub row: Row,
    /// Where its row begins, if that is not the link frame of the row before: the link that carries the joint, and a
    /// placement in the link frame of that link. A `gamma` and a `b` of the file are such a placement, Rz(gamma) Tz(b).
    pub branch: Option<FixedFrame>,
    /// The inertia as the file writes it, and the point it refers to.
    pub written_inertia: (Inertia, InertiaReference),
    /// Position, velocity and effort limits.
    pub limits: Limits,
    /// How it follows other joints, if it does: it is no coordinate of the robot then.
    pub coupling: Option<Coupling>,
    /// The motor, if the file has one.
    pub motor: Option<Motor>,
    /// The speed about which Coulomb friction changes its sign, rad/s or m/s, where somebody found it: the `width` that
    /// smooth friction takes. Information, as limits are.
    pub coulomb_width: Option<f64>,
    /// The displacement over which Coulomb friction changes its sign after a reversal, rad or m, where somebody found
    /// it: friction that remembers where it turned, of Dahl's model. Information, as limits are.
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
    /// The row where the joint is when those that it follows are at 0: `theta` or `d` with the offset of its coupling.
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

    /// Friction, N m or N, at a speed that the joint has had for long: [`Friction`] knows the way there.
    #[must_use]
    pub fn friction(&self, speed: f64) -> f64 {
        Friction::at(self, speed)
    }

    /// From Coulomb's friction of one direction to that of the other, N m or N: a joint at rest may be held by anything
    /// between.
    #[must_use]
    pub fn coulomb_span(&self) -> f64 {
        self.motor.map_or(0.0, |motor| motor.gear_ratio.abs() * (motor.coulomb[0] - motor.coulomb[1]))
    }

    /// Whether the inertia of its link is positive semidefinite about the centre of mass, but for rounding, and there
    /// is no first moment without mass: so it is with a body. A file must say `physical: false` where it is not.
    #[must_use]
    pub fn is_physical(&self) -> bool {
        self.row.link.is_physical(&self.written_inertia.0)
    }
}

impl Robot {
    /// Number of coordinates: of the joints that follow no other. So many elements q, q̇, q̈ and τ have.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.independent_joints().count()
    }

    /// The joints that follow no other, counted from 0, in the order of q.
    pub fn coordinates(&self) -> impl DoubleEndedIterator<Item = usize> {
        (0..self.joints.len()).filter(|index| self.is_coordinate(*index))
    }

    /// The joints that follow no other, in the order of q.
    pub fn independent_joints(&self) -> impl DoubleEndedIterator<Item = &Joint> {
        self.coordinates().map(|index| &self.joints[index])
    }

    /// Whether a joint follows no other, neither by a coupling nor by a closed loop.
    fn is_coordinate(&self, joint: usize) -> bool {
        self.joints[joint].coupling.is_none() && !self.closed.passive.contains(&joint)
    }

    /// The joint of a coordinate, which is counted from 0: an element of q belongs to it.
    #[must_use]
    pub fn independent_joint(&self, coordinate: usize) -> Option<&Joint> {
        self.independent_joints().nth(coordinate)
    }

    /// The name of the joint of a coordinate, which is counted from 0; empty if there is no such coordinate.
    #[must_use]
    pub fn coordinate_name(&self, coordinate: usize) -> &str {
        self.independent_joint(coordinate).map_or("", |joint| &joint.name)
    }

    /// The kind of the joint of a coordinate, which is counted from 0.
    #[must_use]
    pub fn coordinate_kind(&self, coordinate: usize) -> JointKind {
        self.independent_joint(coordinate).map_or(JointKind::Revolute, |joint| joint.row.kind)
    }

    /// Whether some joint follows others.
    #[must_use]
    pub fn has_couplings(&self) -> bool {
        self.joints.iter().any(|joint| joint.coupling.is_some())
    }

    /// The arm with its rotors: what a rotor behind a gear resists with, G² Jm q̈, is part of its torques, of its mass
    /// matrix and of its kinetic energy, and so of its forward dynamics. Friction is not, and the rotor's gyroscopic
    /// torques are left out. A robot without motors stays as it is.
    #[must_use]
    pub fn with_rotors(self) -> Self {
        Self { rotors: true, ..self }
    }

    /// Whether some rotor belongs to the arm and resists.
    #[must_use]
    pub fn has_rotors(&self) -> bool {
        let resists = |motor: Motor| motor.inertia * motor.gear_ratio != 0.0;
        self.rotors && self.joints.iter().any(|joint| joint.motor.is_some_and(resists))
    }

    /// The joint whose link carries `joint`, both counted from 0; `None` for the base. What goes from link to link asks
    /// here, and nowhere takes one from an index.
    #[must_use]
    pub fn parent(&self, joint: usize) -> Option<usize> {
        parent(&self.joints, joint)
    }

    /// The tip frame: the link that carries it, and its place there.
    #[must_use]
    pub fn tip(&self) -> FixedFrame {
        FixedFrame { on: self.tip_on.or(self.joints.len().checked_sub(1)), placement: self.tool }
    }

    /// Whether each row begins where the row before it ends, and the last link carries the tip.
    #[must_use]
    pub fn is_serial(&self) -> bool {
        self.tip_on.is_none() && self.joints.iter().all(|joint| joint.branch.is_none())
    }

    /// Whether a file of `format: 1` describes it: a chain on a base that is held, whose joints move by themselves,
    /// each with a motor of its own, and which has one tip.
    #[must_use]
    pub fn is_chain(&self) -> bool {
        let has_more = self.has_couplings() || self.floating_base.is_some() || !self.closed.is_empty();
        self.is_serial() && !has_more && self.drives.is_empty() && self.tips.is_empty()
    }

    /// The rows alone, base to tip.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &Row> + DoubleEndedIterator {
        self.joints.iter().map(|joint| &joint.row)
    }

    /// The robot as a plain [`Model`], or `None` when it does not have `DOF` joints. A model does not say where the
    /// rows of a tree begin: [`Joint::branch`] and [`Robot::tip_on`] do.
    #[must_use]
    pub fn model<const DOF: usize>(&self) -> Option<Model<DOF>> {
        let rows: Vec<Row> = self.rows().copied().collect();
        let rows = rows.try_into().ok()?;
        Some(Model { convention: self.convention, gravity: self.gravity, base: self.base, tool: self.tool, rows })
    }
}

/// The joint whose link carries `joint`, both counted from 0; `None` for the base.
pub(crate) fn parent(joints: &[Joint], joint: usize) -> Option<usize> {
    match joints.get(joint).and_then(|joint| joint.branch) {
        Some(branch) => branch.on,
        None => joint.checked_sub(1),
    }
}
