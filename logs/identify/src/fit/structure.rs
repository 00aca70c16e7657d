//! The options and unknowns of an identification: which parameters, which friction, which low-pass filter.

use crate::Parameter;
use nalgebra::DMatrixView;
use rne_model::{FrictionTransition, JointKind, PER_LINK, Robot};

use crate::fit::parameters::Parameters;
use crate::fit::regressor::Regressor;
use crate::fit::smoothing::Kernel;

/// Options of an identification.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Whether viscous friction and Coulomb friction of each direction are unknowns. If not, the arm has no friction,
    /// whatever its file says.
    pub friction: bool,
    /// Whether the inertias of rotors, at their joints, are unknowns. If not, those of the file are taken as known.
    pub rotors: bool,
    /// Whether the delay of the torques against the positions is an unknown.
    pub delay: bool,
    /// Cut-off of the low-pass filter of both sides of the equations of motion, Hz; `None` for no filter.
    pub cutoff: Option<f64>,
    /// Candidate widths of the range of speed in which Coulomb friction changes its sign, rad/s or m/s.
    pub widths: Vec<f64>,
    /// Candidate displacements after a reversal over which Coulomb friction changes its sign, rad or m. For each joint,
    /// the width or displacement that fits the data best is chosen.
    pub displacements: Vec<f64>,
}

impl Default for Options {
    fn default() -> Self {
        let widths = vec![0.003, 0.006, 0.012, 0.025, 0.05, 0.1];
        let displacements = vec![0.001, 0.002, 0.005, 0.01, 0.02];
        Self { friction: true, rotors: false, delay: true, cutoff: Some(2.0), widths, displacements }
    }
}

impl Options {
    /// Returns the time before and after an instant that the low-pass filter of both sides covers, s: there are no rows
    /// nearer to the ends of a run. `cutoff` is in Hz.
    #[must_use]
    pub fn filter_reach(cutoff: f64) -> f64 {
        Kernel::of_cutoff(cutoff).reach()
    }

    /// Returns the time between rows after a low-pass filter, s. `cutoff` is in Hz.
    #[must_use]
    pub fn row(cutoff: f64) -> f64 {
        Kernel::of_cutoff(cutoff).width()
    }

    /// Returns the transitions by which Coulomb friction may change its sign; a step if the options give none.
    #[must_use]
    pub fn transitions(&self) -> Vec<FrictionTransition> {
        let widths = self.widths.iter().map(|width| FrictionTransition::Speed(*width));
        let all: Vec<FrictionTransition> =
            widths.chain(self.displacements.iter().map(|length| FrictionTransition::Displacement(*length))).collect();
        if all.is_empty() { vec![FrictionTransition::Speed(0.0)] } else { all }
    }
}

/// The form of a robot's equations: the columns and unknowns of each joint.
#[derive(Clone, Debug)]
pub struct Structure {
    pub(crate) options: Options,
    pub(crate) transitions: Vec<FrictionTransition>,
    pub(crate) parameters: Parameters,
    pub(crate) robot: Robot,
    /// Computes the columns of the links' parameters.
    pub(crate) regressor: Regressor,
    /// The base parameters that the torque of each joint may depend on.
    pub(crate) felt: Vec<Vec<usize>>,
}

/// Number of unknowns of the friction of one joint: viscous friction, Coulomb friction, and the offset.
pub(crate) const FRICTION: usize = 3;

impl Structure {
    /// Sets up the equations of a robot's geometry; the parameters of its links are only prior knowledge. The inertia
    /// of rotors in the list `motors` is known: a robot with such rotors ignores [`Options::rotors`].
    #[must_use]
    pub fn new(robot: &Robot, options: Options) -> Self {
        let options = Options { rotors: options.rotors && !robot.has_spinning_rotors(), ..options };
        let parameters = Parameters::of(robot, options.rotors);
        let felt = (0..robot.dof())
            .map(|joint| {
                let felt = |base: &usize| Parameters::is_felt(robot, &parameters.bases[*base], joint);
                (0..parameters.rank()).filter(felt).collect()
            })
            .collect();
        let transitions = options.transitions();
        Self { parameters, robot: robot.clone(), regressor: Regressor::of(robot), felt, options, transitions }
    }

    /// The base parameters.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The options with which the structure was made.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The robot with this geometry.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Returns the unit of a parameter: kg for the rotor of a prismatic joint.
    #[must_use]
    pub fn unit(&self, parameter: Parameter) -> &'static str {
        let slides =
            |joint: usize| self.robot.joints.get(joint).is_some_and(|joint| joint.row.kind == JointKind::Prismatic);
        match parameter {
            Parameter::Link(_, 0) => "kg",
            Parameter::Link(_, 1..=3) => "kg m",
            Parameter::Rotor(joint) if slides(joint) => "kg",
            Parameter::Link(..) | Parameter::Rotor(_) => "kg m²",
        }
    }

    /// Returns the number of coordinates: the joints that depend on no other. Rows, friction and motions exist only for
    /// these joints.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.robot.dof()
    }

    /// Returns the columns of the regrouping for the first `count` of the ten parameters of the link with the tip: the
    /// changes of the base parameters by a payload.
    #[must_use]
    pub fn payload_columns(&self, count: usize) -> DMatrixView<'_, f64> {
        let link = self.robot.tip().on.unwrap_or_default();
        self.parameters.regrouping.columns(PER_LINK * link, count)
    }

    /// Returns the number of columns of a joint's rows: base parameters; viscous friction, then Coulomb friction and
    /// the offset for each transition; the slope of the torque; the torque.
    pub(crate) fn columns(&self, joint: usize) -> usize {
        self.felt[joint].len() + self.own_columns() + 1
    }

    pub(crate) fn own_columns(&self) -> usize {
        let friction = if self.options.friction { 1 + 2 * self.transitions.len() } else { 0 };
        friction + usize::from(self.options.delay)
    }

    /// Returns the columns of a joint's rows that are used with the transition of this index.
    pub(crate) fn used(&self, joint: usize, transition: usize) -> Vec<usize> {
        let felt = self.felt[joint].len();
        let mut used: Vec<usize> = (0..felt).collect();
        if self.options.friction {
            used.extend([felt, felt + 1 + 2 * transition, felt + 2 + 2 * transition]);
        }
        if self.options.delay {
            used.push(felt + self.own_columns() - 1);
        }
        used.push(felt + self.own_columns());
        used
    }

    /// Returns the unknowns that belong to the columns of [`used`](Self::used), without the torque.
    pub(crate) fn unknowns(&self, joint: usize) -> Vec<usize> {
        let rank = self.parameters.rank();
        let mut unknowns = self.felt[joint].clone();
        if self.options.friction {
            unknowns.extend((0..FRICTION).map(|k| rank + joint * FRICTION + k));
        }
        if self.options.delay {
            unknowns.push(self.count() - 1);
        }
        unknowns
    }

    /// Returns the index of the first unknown of a joint's friction (viscous friction, Coulomb friction, offset);
    /// `None` without friction.
    pub(crate) fn friction_at(&self, joint: usize) -> Option<usize> {
        (self.options.friction && joint < self.dof()).then(|| self.parameters.rank() + FRICTION * joint)
    }

    /// Returns the known rotor inertia G² Jm of a joint, kg m² or kg: that of the file, or 0 if rotors are unknowns.
    pub(crate) fn known_rotor(&self, joint: usize) -> f64 {
        match self.robot.independent_joint(joint).and_then(|joint| joint.motor) {
            Some(motor) if !self.options.rotors => motor.gear_ratio * motor.gear_ratio * motor.inertia,
            _ => 0.0,
        }
    }

    /// Number of unknowns: base parameters, friction joint by joint, the delay.
    #[must_use]
    pub fn count(&self) -> usize {
        let friction = if self.options.friction { FRICTION * self.dof() } else { 0 };
        self.parameters.rank() + friction + usize::from(self.options.delay)
    }
}
