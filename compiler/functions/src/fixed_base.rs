//! The results for a robot on a base that stands still or that something else moves.

use crate::answer::{AXES, Answer, AnswerTable, Labels, MatrixUnit};
use crate::entry::{Entry, SINGULAR_LOOPS, WITHOUT_MASS};

/// A row and a column per joint.
const fn of_joints(about: &'static str, unit: MatrixUnit) -> AnswerTable {
    AnswerTable { about, unit: Some(unit), rows: Labels::Joints, columns: Labels::Joints }
}

/// A row for each column of the Jacobian, and a column for each position.
const fn by_position(about: &'static str) -> AnswerTable {
    AnswerTable::of(about, Labels::Joints, Labels::Joints)
}

pub(crate) const MASS_MATRIX: Entry = Entry {
    has_bits_of_runtime: true,
    output: "mass",
    listed: "returned: the rows of the matrix",
    answer: Answer::Tables(&[of_joints("", MatrixUnit::Mass)]),
    is_of_motion: true,
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const FORWARD_DYNAMICS: Entry = Entry {
    has_bits_of_runtime: true,
    output: "qdd",
    answer: Answer::Accelerations,
    divides: Some(
        "the accelerations are not finite: the mass matrix is singular \
         (a joint moves no mass), or the state is too large",
    ),
    inverts_mass: true,
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const DERIVATIVES: Entry = Entry {
    has_bits_of_runtime: true,
    output: "derivatives",
    listed: "returned: the rows of ∂τ/∂q, then those of ∂τ/∂q̇",
    answer: Answer::Tables(&[of_joints("∂τ/∂q", MatrixUnit::PerPosition), of_joints("∂τ/∂q̇", MatrixUnit::PerRate)]),
    is_of_motion: true,
    ..Entry::NEW
};

pub(crate) const MOMENTUM_AND_RATE: Entry = Entry {
    has_bits_of_runtime: true,
    output: "momentum",
    listed: "returned: the momenta of the joints, then their rates",
    answer: Answer::Tables(&[AnswerTable::of(
        "momentum of each joint, M q̇ (N m s, prismatic: N s), and its rate without external torques (N m, \
        prismatic: N)",
        Labels::Names(&["momentum", "rate"]),
        Labels::Joints,
    )]),
    is_of_motion: true,
    feels_rotors: true,
    ..Entry::NEW
};

/// The elements of an inverse mass matrix.
const PER_TORQUE: &str =
    "acceleration of the row's joint per torque of the column's: 1/(kg m²), prismatic 1/kg, mixed 1/(kg m)";

/// Why a mass matrix may have no inverse.
const INVERSE_OF_NOTHING: &str =
    "the inverse is not finite: the mass matrix is singular (a joint moves no mass), or the positions are too large";

pub(crate) const ACCELERATION_DERIVATIVES: Entry = Entry {
    output: "derivatives",
    listed: "returned: the rows of ∂q̈/∂q, then those of ∂q̈/∂q̇, then those of ∂q̈/∂τ",
    answer: Answer::Tables(&[
        AnswerTable::of("∂q̈/∂q (1/s²; rows in rad/s² or m/s², columns per rad or m)", Labels::Joints, Labels::Joints),
        AnswerTable::of("∂q̈/∂q̇ (1/s)", Labels::Joints, Labels::Joints),
        AnswerTable::of(PER_TORQUE, Labels::Joints, Labels::Joints),
    ]),
    divides: Some(
        "the derivatives are not finite: the mass matrix is singular \
         (a joint moves no mass), or the state is too large",
    ),
    inverts_mass: true,
    feels_rotors: true,
    ..Entry::NEW
};

/// The part of an entry that the step and its derivatives have in common.
pub(crate) const STEP: Entry = Entry {
    inverts_mass: true,
    feels_rotors: true,
    divides: Some(
        "the result of the step is not finite: the mass matrix is singular \
         (a joint moves no mass), or the state is too large",
    ),
    ..Entry::NEW
};

/// A block of the derivatives of a step.
const fn of_step(about: &'static str) -> AnswerTable {
    AnswerTable::of(about, Labels::Joints, Labels::Joints)
}

/// The part of an entry that functions of the loops alone have in common.
pub(crate) const OF_CLOSURE: Entry =
    Entry { is_geometry: true, feels_links: false, divides: Some(SINGULAR_LOOPS), ..Entry::NEW };

pub(crate) const GRAVITY_TORQUES: Entry = Entry { is_of_motion: true, ..Entry::TORQUES };

pub(crate) const BIAS_TORQUES: Entry = Entry { is_of_motion: true, ..Entry::TORQUES };

pub(crate) const CORIOLIS_MATRIX: Entry = Entry {
    output: "coriolis",
    listed: "returned: the rows of the matrix",
    answer: Answer::Tables(&[of_joints("", MatrixUnit::PerRate)]),
    is_of_motion: true,
    ..Entry::NEW
};

pub(crate) const CORIOLIS_TORQUES: Entry = Entry { is_of_motion: true, ..Entry::TORQUES };

pub(crate) const FORWARD_KINEMATICS: Entry = Entry {
    is_geometry: true,
    feels_links: false,
    output: "tip",
    listed: "returned: the rows of the rotation, then the translation",
    answer: Answer::Poses,
    ..Entry::NEW
};

pub(crate) const LINK_POSES: Entry = Entry {
    is_of_table_points: true,
    is_geometry: true,
    feels_links: false,
    output: "poses",
    listed: "returned: rotation and translation of every link",
    answer: Answer::Poses,
    ..Entry::NEW
};

pub(crate) const JACOBIAN: Entry = Entry {
    is_geometry: true,
    feels_links: false,
    output: "jacobian",
    listed: "returned: three linear rows, then three angular ones",
    answer: Answer::Tables(&[AnswerTable::of(
        "velocity of the tip per joint velocity, world axes: v in m/s, w in rad/s",
        Labels::Names(&["vx", "vy", "vz", "wx", "wy", "wz"]),
        Labels::Joints,
    )]),
    ..Entry::NEW
};

pub(crate) const JACOBIAN_RATE_TIMES_VELOCITY: Entry = Entry {
    has_bits_of_runtime: true,
    is_geometry: true,
    feels_links: false,
    output: "acceleration",
    answer: Answer::Tables(&[AnswerTable::of(
        "acceleration of the tip where q̈ = 0, world axes",
        Labels::Names(&["linear, m/s²", "angular, rad/s²"]),
        AXES,
    )]),
    ..Entry::NEW
};

pub(crate) const KINETIC_ENERGY: Entry = Entry {
    has_bits_of_runtime: true,
    output: "energy",
    answer: Answer::Number("J"),
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const POTENTIAL_ENERGY: Entry = Entry { output: "energy", answer: Answer::Number("J"), ..Entry::NEW };

pub(crate) const CENTRE_OF_MASS: Entry = Entry {
    is_geometry: true,
    output: "centre",
    listed: "returned: x, y, z",
    answer: Answer::Tables(&[AnswerTable::of(
        "centre of mass of the arm in the world, m",
        Labels::Names(&["arm"]),
        AXES,
    )]),
    divides: Some(WITHOUT_MASS),
    ..Entry::NEW
};

pub(crate) const CENTRE_OF_MASS_JACOBIAN: Entry = Entry {
    is_geometry: true,
    output: "jacobian",
    listed: "returned: the rows of the Jacobian",
    answer: Answer::Tables(&[AnswerTable::of(
        "velocity of the centre of mass per joint velocity, world axes, m/s",
        Labels::Names(&["vx", "vy", "vz"]),
        Labels::Joints,
    )]),
    divides: Some(WITHOUT_MASS),
    ..Entry::NEW
};

pub(crate) const REGRESSOR: Entry = Entry {
    is_of_table_points: true,
    feels_links: false,
    output: "regressor",
    listed: "returned: torque, link, parameter (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz)",
    answer: Answer::PerParameter,
    ..Entry::NEW
};

pub(crate) const JOINT_WRENCHES: Entry = Entry {
    has_bits_of_runtime: true,
    is_of_table_points: true,
    output: "wrenches",
    listed: "returned: force and moment of every joint",
    answer: Answer::Tables(&[AnswerTable::of(
        "what the link before exerts at each joint, axes fixed to the link, z along the joint: f in N, n \
        in N m",
        Labels::Joints,
        Labels::Names(&["fx", "fy", "fz", "nx", "ny", "nz"]),
    )]),
    is_irreducible: true,
    ..Entry::NEW
};

pub(crate) const ACTUATOR_TORQUES: Entry = Entry {
    has_bits_of_runtime: true,
    feels_links: false,
    output: "tau",
    answer: Answer::Torques,
    is_irreducible: true,
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const INVERSE_MASS_MATRIX: Entry = Entry {
    has_bits_of_runtime: true,
    output: "inverse",
    listed: "returned: the rows of the matrix",
    answer: Answer::Tables(&[AnswerTable::of(PER_TORQUE, Labels::Joints, Labels::Joints)]),
    feels_rotors: true,
    is_of_motion: true,
    inverts_mass: true,
    divides: Some(INVERSE_OF_NOTHING),
    ..Entry::NEW
};

pub(crate) const WRENCH_TORQUES: Entry = Entry { feels_links: false, output: "tau", ..Entry::NEW };

pub(crate) const TORQUE_GRADIENT: Entry = Entry {
    output: "gradient",
    listed: "returned: derivatives by q, then by q̇, then by q̈",
    answer: Answer::Tables(&[AnswerTable::of(
        "derivative of λᵀτ by each joint's position (per rad, prismatic: m), velocity and acceleration",
        Labels::Names(&["dq", "dqd", "dqdd"]),
        Labels::Joints,
    )]),
    is_of_motion: true,
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const INVERSE_MASS_MATRIX_TIMES_TORQUES: Entry = Entry { is_of_motion: true, ..FORWARD_DYNAMICS };

pub(crate) const JACOBIAN_RATE: Entry = Entry {
    is_geometry: true,
    feels_links: false,
    output: "rate",
    listed: "returned: three linear rows, then three angular ones",
    answer: Answer::Tables(&[AnswerTable::of(
        "acceleration of the tip per joint velocity, world axes: v in m/s², w in rad/s²",
        Labels::Names(&["vx", "vy", "vz", "wx", "wy", "wz"]),
        Labels::Joints,
    )]),
    ..Entry::NEW
};

pub(crate) const JACOBIAN_DERIVATIVES: Entry = Entry {
    is_geometry: true,
    feels_links: false,
    output: "derivatives",
    listed: "returned: six matrices, of vx, vy, vz, wx, wy, wz: the column of the Jacobian, then the position",
    answer: Answer::Tables(&[
        by_position(
            "∂(row vx of the Jacobian)/∂q, world axes; a row per column of the Jacobian, a column per position",
        ),
        by_position("∂(row vy)/∂q"),
        by_position("∂(row vz)/∂q"),
        by_position("∂(row wx)/∂q"),
        by_position("∂(row wy)/∂q"),
        by_position("∂(row wz)/∂q"),
    ]),
    ..Entry::NEW
};

pub(crate) const TORQUE_HESSIAN: Entry = Entry {
    output: "hessian",
    listed: "returned: the rows by q and q, by q and q̇, by q̇ and q̇, by q and q̈",
    answer: Answer::Tables(&[
        AnswerTable::of("∂²(λᵀτ)/∂q∂q (per rad or m, of each joint)", Labels::Joints, Labels::Joints),
        AnswerTable::of("∂²(λᵀτ)/∂q∂q̇ (rows by q, columns by q̇)", Labels::Joints, Labels::Joints),
        AnswerTable::of("∂²(λᵀτ)/∂q̇∂q̇", Labels::Joints, Labels::Joints),
        AnswerTable::of("∂²(λᵀτ)/∂q∂q̈ (rows by q, columns by q̈)", Labels::Joints, Labels::Joints),
    ]),
    is_of_motion: true,
    feels_rotors: true,
    ..Entry::NEW
};

pub(crate) const EULER_STEP: Entry = Entry {
    has_bits_of_runtime: true,
    output: "next",
    listed: "returned: the positions after the step, then the velocities",
    answer: Answer::Tables(&[AnswerTable::of(
        "position (rad, prismatic: m) and velocity (rad/s, prismatic: m/s) of each joint after the step",
        Labels::Names(&["q", "qd"]),
        Labels::Joints,
    )]),
    ..STEP
};

pub(crate) const EULER_STEP_DERIVATIVES: Entry = Entry {
    output: "derivatives",
    listed: "returned: the rows of ∂q'/∂q, ∂q'/∂q̇ and ∂q'/∂τ, then those of ∂q̇'/∂q, ∂q̇'/∂q̇ and ∂q̇'/∂τ",
    answer: Answer::Tables(&[
        of_step("∂q'/∂q (rows in rad or m after the step, columns per rad or m)"),
        of_step("∂q'/∂q̇ (s)"),
        of_step("∂q'/∂τ (rad or m, per N m or N)"),
        of_step("∂q̇'/∂q (1/s)"),
        of_step("∂q̇'/∂q̇"),
        of_step("∂q̇'/∂τ (rad/s or m/s, per N m or N)"),
    ]),
    ..STEP
};

pub(crate) const CLOSURE_STEP: Entry = Entry {
    output: "step",
    listed: "returned: positions of the dependent joints after the step, then the equations before it",
    answer: Answer::Tables(&[
        AnswerTable::of("after the step (rad, prismatic: m)", Labels::Names(&["passive"]), Labels::Passive),
        AnswerTable::of("before the step (m, and products of axes)", Labels::Names(&["residual"]), Labels::Equations),
    ]),
    ..OF_CLOSURE
};

pub(crate) const LOOP_MAP: Entry = Entry {
    output: "map",
    listed: "returned: the rows of the matrix",
    answer: Answer::Tables(&[AnswerTable::of(
        "velocity of each dependent joint per velocity; SI units",
        Labels::Passive,
        Labels::Joints,
    )]),
    ..OF_CLOSURE
};

pub(crate) const LOOP_MAP_RATE_TIMES_VELOCITY: Entry = Entry {
    output: "acceleration",
    listed: "returned: accelerations of the dependent joints",
    answer: Answer::Tables(&[AnswerTable::of(
        "accelerations where q̈ is 0 (rad/s², prismatic: m/s²)",
        Labels::Names(&["passive"]),
        Labels::Passive,
    )]),
    ..OF_CLOSURE
};
