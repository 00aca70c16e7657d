//! The results for a robot with a floating base.

use crate::answer::{AXES, Answer, AnswerTable, Labels};
use crate::entry::{Entry, WITHOUT_MASS};

/// Rows of the base, then of the joints.
const VELOCITIES: Labels = Labels::BaseAndJoints;
/// Three components along the axes, then three about them.
const ALONG_AND_ABOUT: Labels = Labels::Names(&["x", "y", "z", "about x", "about y", "about z"]);

/// Torques, and the wrench on the base.
pub(crate) const TORQUES: Entry = Entry {
    has_bits_of_runtime: true,
    output: "torques",
    listed: "returned: force and moment on the base, then the torques",
    answer: Answer::Tables(&[
        AnswerTable::of("force on the base (N), in axes of frame 0", Labels::Names(&["force"]), AXES),
        AnswerTable::of("moment on the base (N m), about the origin of frame 0", Labels::Names(&["moment"]), AXES),
        AnswerTable::of("torques (N m, prismatic: N)", Labels::Names(&["tau"]), Labels::Joints),
    ]),
    ..Entry::NEW
};

/// The mass matrix with the rows of the base.
pub(crate) const MASS_MATRIX: Entry = Entry {
    has_bits_of_runtime: true,
    output: "mass",
    listed: "returned: the rows of the matrix",
    answer: Answer::Tables(&[AnswerTable::of(
        "force and moment on the base and torques per acceleration, axes of frame 0; SI units",
        VELOCITIES,
        VELOCITIES,
    )]),
    feels_rotors: true,
    ..Entry::NEW
};

/// Accelerations of the base and of the joints.
pub(crate) const ACCELERATIONS: Entry = Entry {
    has_bits_of_runtime: true,
    output: "accelerations",
    listed: "returned: linear and angular acceleration of the base, then those of the joints",
    answer: Answer::Tables(&[
        AnswerTable::of(
            "acceleration of the origin of frame 0 less gravity (m/s²), in axes of frame 0",
            Labels::Names(&["linear"]),
            AXES,
        ),
        AnswerTable::of("angular acceleration of the base (rad/s²)", Labels::Names(&["angular"]), AXES),
        AnswerTable::of("accelerations (rad/s², prismatic: m/s²)", Labels::Names(&["qdd"]), Labels::Joints),
    ]),
    divides: Some(
        "the accelerations are not finite: the mass matrix is singular \
         (a joint or the base moves no mass), or the state is too large",
    ),
    inverts_mass: true,
    feels_rotors: true,
    ..Entry::NEW
};

/// The part of an entry that the step and its derivatives have in common.
pub(crate) const STEP: Entry = Entry {
    divides: Some(
        "the result of the step is not finite: the mass matrix is singular \
         (a joint or the base moves no mass), or the state is too large",
    ),
    inverts_mass: true,
    feels_rotors: true,
    ..Entry::NEW
};

/// Force and moment on the base and torques, in one row.
const fn forces(row: &'static [&'static str]) -> AnswerTable {
    AnswerTable::of(
        "force (N) and moment (N m) on the base, axes of frame 0, then torques (N m, prismatic: N)",
        Labels::Names(row),
        VELOCITIES,
    )
}

pub(crate) const BIAS_TORQUES: Entry = Entry {
    has_bits_of_runtime: true,
    output: "bias",
    listed: "returned: force and moment on the base, then the torques",
    answer: Answer::Tables(&[forces(&["bias"])]),
    ..Entry::NEW
};

pub(crate) const GRAVITY_TORQUES: Entry = Entry {
    has_bits_of_runtime: false,
    output: "gravity",
    answer: Answer::Tables(&[forces(&["gravity"])]),
    ..BIAS_TORQUES
};

pub(crate) const CENTROIDAL_MOMENTUM_MATRIX: Entry = Entry {
    has_bits_of_runtime: true,
    output: "map",
    listed: "returned: the rows of the matrix",
    answer: Answer::Tables(&[AnswerTable::of(
        "momentum and angular momentum about the centre of mass per velocity, axes of frame 0; SI units",
        ALONG_AND_ABOUT,
        VELOCITIES,
    )]),
    divides: Some(WITHOUT_MASS),
    ..Entry::NEW
};

pub(crate) const CENTROIDAL_BIAS: Entry = Entry {
    has_bits_of_runtime: true,
    output: "rate",
    listed: "returned: force, then moment about the centre of mass",
    answer: Answer::Tables(&[AnswerTable::of(
        "force (N), then moment about the centre of mass (N m), axes of frame 0",
        Labels::Names(&["rate"]),
        ALONG_AND_ABOUT,
    )]),
    divides: Some(WITHOUT_MASS),
    ..Entry::NEW
};

pub(crate) const REGRESSOR: Entry = Entry {
    is_of_table_points: true,
    feels_links: false,
    output: "regressor",
    listed: "returned: force, moment and torque; base and link; parameter \
             (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz)",
    answer: Answer::PerParameter,
    ..Entry::NEW
};

pub(crate) const CENTROIDAL_MOMENTUM: Entry = Entry {
    has_bits_of_runtime: true,
    output: "momentum",
    listed: "returned: momentum, then angular momentum about the centre of mass",
    answer: Answer::Tables(&[AnswerTable::of(
        "momentum (N s), then angular momentum about the centre of mass (N m s), axes of frame 0",
        Labels::Names(&["momentum"]),
        ALONG_AND_ABOUT,
    )]),
    divides: Some(WITHOUT_MASS),
    ..Entry::NEW
};

pub(crate) const TIP_JACOBIANS: Entry = Entry {
    is_geometry: true,
    feels_links: false,
    output: "jacobians",
    listed: "returned: for each tip the rows of its Jacobian",
    answer: Answer::Tables(&[AnswerTable::of(
        "velocity of each tip per velocity, world axes; base in axes of frame 0; SI units",
        Labels::OfTips(&["vx", "vy", "vz", "wx", "wy", "wz"]),
        VELOCITIES,
    )]),
    ..Entry::NEW
};

pub(crate) const TIP_ACCELERATIONS: Entry = Entry {
    is_geometry: true,
    feels_links: false,
    output: "accelerations",
    listed: "returned: for each tip its acceleration, then its angular acceleration",
    answer: Answer::Tables(&[AnswerTable::of(
        "acceleration of each tip where those of the base and of the joints are zero, world axes",
        Labels::OfTips(&["linear, m/s²", "angular, rad/s²"]),
        AXES,
    )]),
    ..Entry::NEW
};

pub(crate) const FORWARD_DYNAMICS_IN_CONTACT: Entry = Entry {
    output: "result",
    listed: "returned: accelerations of the base and of the joints, then force and moment of each tip",
    answer: Answer::Tables(&[
        AnswerTable::of(
            "acceleration of the origin of frame 0 less gravity (m/s²), in axes of frame 0",
            Labels::Names(&["linear"]),
            AXES,
        ),
        AnswerTable::of("angular acceleration of the base (rad/s²)", Labels::Names(&["angular"]), AXES),
        AnswerTable::of("accelerations (rad/s², prismatic: m/s²)", Labels::Names(&["qdd"]), Labels::Joints),
        AnswerTable::of(
            "exerted on the robot at each tip, world axes",
            Labels::OfTips(&["force, N", "moment, N m"]),
            AXES,
        ),
    ]),
    divides: Some(
        "the accelerations are not finite: the mass matrix is singular \
         (a joint or the base moves no mass), or the state is too large",
    ),
    inverts_mass: true,
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const INVERSE_DYNAMICS_DERIVATIVES: Entry = Entry {
    has_bits_of_runtime: true,
    output: "derivatives",
    listed: "returned: force, moment and torques by q, then by q̇, then by the angular velocity of the base",
    answer: Answer::Tables(&[
        AnswerTable::of("force and moment on the base and torques by q; SI units", VELOCITIES, Labels::Joints),
        AnswerTable::of("by q̇; SI units", VELOCITIES, Labels::Joints),
        AnswerTable::of("by the angular velocity of the base, in axes of frame 0; SI units", VELOCITIES, AXES),
    ]),
    ..Entry::NEW
};

pub(crate) const EULER_STEP: Entry = Entry {
    has_bits_of_runtime: true,
    output: "next",
    listed: "returned: pose, velocity and angular velocity of the base after the step, then the positions and the \
             velocities of the joints",
    answer: Answer::Tables(&[
        AnswerTable::of("rotation of the base after the step: the columns are the axes of frame 0", AXES, AXES),
        AnswerTable::of("origin of frame 0 after the step, in the world (m)", Labels::Names(&["origin"]), AXES),
        AnswerTable::of("velocity of this origin (m/s), in axes of frame 0", Labels::Names(&["linear"]), AXES),
        AnswerTable::of("angular velocity of the base (rad/s), in axes of frame 0", Labels::Names(&["angular"]), AXES),
        AnswerTable::of(
            "position (rad, prismatic: m) and velocity (rad/s, prismatic: m/s) of each joint after the step",
            Labels::Names(&["q", "qd"]),
            Labels::Joints,
        ),
    ]),
    ..STEP
};

pub(crate) const EULER_STEP_DERIVATIVES: Entry = Entry {
    output: "derivatives",
    listed: "returned: the rows of the derivatives of the next positions by the positions, by the velocities and \
             by the torques, then those of the next velocities",
    answer: Answer::Tables(&[
        AnswerTable::of("positions after the step by the positions, axes of frame 0; SI units", VELOCITIES, VELOCITIES),
        AnswerTable::of("positions after the step by the velocities (s)", VELOCITIES, VELOCITIES),
        AnswerTable::of("positions after the step by the torques; SI units", VELOCITIES, Labels::Joints),
        AnswerTable::of("velocities after the step by the positions; SI units", VELOCITIES, VELOCITIES),
        AnswerTable::of("velocities after the step by the velocities; SI units", VELOCITIES, VELOCITIES),
        AnswerTable::of("velocities after the step by the torques; SI units", VELOCITIES, Labels::Joints),
    ]),
    ..STEP
};
