//! One entry per function: all that is told of it elsewhere than in its formulas.
//!
//! A function is added by a variant and an entry here, its formulas in `formulate`, and the runtime's own
//! implementation. The entries stand in the order of the variants, those of a capability beside each other.

use serde::{Deserialize, Serialize};

use super::Argument::{Accelerations, Base, Cosines, Positions, Rates, Sines, Torques, Wrench};
use super::Length::{Fixed, Joints};
use super::{Answer, AnswerTable, Entry, Labels, MatrixUnit, Own, Record, Shape};
use crate::ir::quantity::Quantity;

/// A function of a robot, named as its trait method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "&str")]
pub enum Function {
    /// τ(q, q̇, q̈).
    InverseDynamics,
    /// τ(q, q̇, q̈) when the last link exerts a wrench on its environment.
    InverseDynamicsWithWrench,
    /// τ(q, q̇, q̈) from the sines and cosines of the positions.
    InverseDynamicsSc,
    /// τ(q, 0, 0).
    GravityTorques,
    /// τ(q, q̇, 0).
    BiasTorques,
    /// M(q).
    MassMatrix,
    /// C(q, q̇).
    CoriolisMatrix,
    /// q̈(q, q̇, τ).
    ForwardDynamics,
    /// The tip in the world.
    ForwardKinematics,
    /// The frame of every link in the world.
    LinkPoses,
    /// J(q) of the tip.
    Jacobian,
    /// J̇ q̇ of the tip.
    JacobianRateTimesVelocity,
    /// T(q, q̇).
    KineticEnergy,
    /// V(q).
    PotentialEnergy,
    /// Where the centre of mass of the arm is.
    CentreOfMass,
    /// How fast it gets there.
    CentreOfMassJacobian,
    /// Y(q, q̇, q̈), torques per inertial parameter.
    Regressor,
    /// ∂τ/∂q and ∂τ/∂q̇.
    InverseDynamicsDerivatives,
    /// f_{i-1,i} and n_{i-1,i} of every joint.
    JointWrenches,
    /// τ(q, q̇, q̈) on a base that moves.
    InverseDynamicsOnMovingBase,
    /// What the motors add.
    ActuatorTorques,
}

/// What a robot can compute, named as the trait that a struct derives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Capability {
    /// Torques from motion.
    InverseDynamics,
    /// M(q).
    MassMatrix,
    /// C(q, q̇).
    CoriolisMatrix,
    /// Motion from torques.
    ForwardDynamics,
    /// Poses and Jacobian.
    Kinematics,
    /// Kinetic and potential.
    Energy,
    /// The centre of mass of the arm.
    CentreOfMass,
    /// Torques per inertial parameter.
    Regressor,
    /// ∂τ/∂q and ∂τ/∂q̇.
    InverseDynamicsDerivatives,
    /// Bearing loads.
    JointWrenches,
    /// Torques on a base that moves.
    MovingBase,
    /// Rotors, gears, friction.
    Actuation,
}

/// The capabilities and the names of their traits.
pub(crate) const CAPABILITIES: &[(Capability, &str)] = &[
    (Capability::InverseDynamics, "InverseDynamics"),
    (Capability::MassMatrix, "MassMatrix"),
    (Capability::CoriolisMatrix, "CoriolisMatrix"),
    (Capability::ForwardDynamics, "ForwardDynamics"),
    (Capability::Kinematics, "Kinematics"),
    (Capability::Energy, "Energy"),
    (Capability::CentreOfMass, "CentreOfMass"),
    (Capability::Regressor, "Regressor"),
    (Capability::InverseDynamicsDerivatives, "InverseDynamicsDerivatives"),
    (Capability::JointWrenches, "JointWrenches"),
    (Capability::MovingBase, "MovingBase"),
    (Capability::Actuation, "Actuation"),
];

const VECTOR: Shape = Shape::Array(Joints, &Shape::Number);
const MATRIX: Shape = Shape::Array(Joints, &VECTOR);
const TRIPLE: Shape = Shape::Array(Fixed(3), &Shape::Number);
const POSE: Shape = Shape::Record(Record::Pose, &[Shape::Array(Fixed(3), &TRIPLE), TRIPLE]);
const AXES: Labels = Labels::Names(&["x", "y", "z"]);

/// A row and a column per joint.
const fn of_joints(about: &'static str, unit: MatrixUnit) -> AnswerTable {
    AnswerTable { about, unit: Some(unit), rows: Labels::Joints, columns: Labels::Joints }
}

/// Why a centre of mass may be none.
const WITHOUT_MASS: &str = "the centre of mass is not finite: the arm has no mass, or the state is too large";

/// The functions.
pub(crate) const TABLE: &[Entry] = &[
    Entry {
        name: "inverse_dynamics",
        capability: Capability::InverseDynamics,
        summary: "Torques for positions `q`, velocities `qd` and accelerations `qdd`, with a free tip.",
        details: "tau: what the actuators must deliver, M(q) q̈ + C(q, q̇) q̇ + g(q). No friction, no rotor inertia.",
        arguments: &[Positions, Rates, Accelerations],
        shape: VECTOR,
        output: "tau",
        answer: Answer::Torques,
        returns_torques: true,
        ..Entry::of(Function::InverseDynamics)
    },
    Entry {
        name: "inverse_dynamics_with_wrench",
        capability: Capability::InverseDynamics,
        summary: "Torques when the last link exerts a force and a moment on its environment, at the tip, in tip axes.",
        details: "force (N), moment (N m): exerted BY the last link ON its environment, about the origin of the tip \
            frame (tool included); what the environment exerts on the robot is the negative of them. tau: τ_free \
            + Jᵀ w.",
        arguments: &[Positions, Rates, Accelerations, Wrench],
        shape: VECTOR,
        output: "tau",
        answer: Answer::Torques,
        returns_torques: true,
        ..Entry::of(Function::InverseDynamicsWithWrench)
    },
    Entry {
        name: "inverse_dynamics_sc",
        capability: Capability::InverseDynamics,
        summary: "Torques from the sines and cosines of the joint positions; `q` is used for prismatic joints alone.",
        details: "sine[i], cosine[i]: those of q[i], without the constant part of the joint's angle. Those of a \
            prismatic joint are not used, as q[i] of a revolute joint is not.",
        arguments: &[Sines, Cosines, Positions, Rates, Accelerations],
        shape: VECTOR,
        output: "tau",
        answer: Answer::Torques,
        returns_torques: true,
        ..Entry::of(Function::InverseDynamicsSc)
    },
    Entry {
        name: "gravity_torques",
        capability: Capability::InverseDynamics,
        summary: "Torques that hold the arm still against gravity, τ(q, 0, 0).",
        arguments: &[Positions],
        shape: VECTOR,
        output: "tau",
        answer: Answer::Torques,
        returns_torques: true,
        is_of_motion: true,
        ..Entry::of(Function::GravityTorques)
    },
    Entry {
        name: "bias_torques",
        capability: Capability::InverseDynamics,
        summary: "Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).",
        arguments: &[Positions, Rates],
        shape: VECTOR,
        output: "tau",
        answer: Answer::Torques,
        returns_torques: true,
        is_of_motion: true,
        ..Entry::of(Function::BiasTorques)
    },
    Entry {
        name: "mass_matrix",
        capability: Capability::MassMatrix,
        summary: "The mass matrix M(q), symmetric: column j holds the torques for q̈ = e_j of an arm at rest.",
        details: "mass[i][j]: torque of joint i for a unit acceleration of joint j, from rest and without gravity; kg \
            m², kg m or kg, as the kinds of joints i and j have it. No rotor inertia.",
        arguments: &[Positions],
        shape: MATRIX,
        output: "mass",
        listed: "returned: the rows of the matrix",
        answer: Answer::Tables(&[of_joints("", MatrixUnit::Mass)]),
        is_of_motion: true,
        ..Entry::of(Function::MassMatrix)
    },
    Entry {
        name: "coriolis_matrix",
        capability: Capability::CoriolisMatrix,
        summary: "The Coriolis matrix C(q, q̇) of Christoffel: Ṁ - 2C is skew, and C = ½ ∂(bias torques)/∂q̇.",
        details: "coriolis[i][j]: row i is torque i. Its product with q̇ are the Coriolis and centrifugal torques.",
        arguments: &[Positions, Rates],
        shape: MATRIX,
        output: "coriolis",
        listed: "returned: the rows of the matrix",
        own: &[Own {
            quantity: Quantity::CoriolisElement,
            heading: |joint| format!("row {joint} of the Coriolis matrix: ½ ∂(bias torques)/∂q̇"),
            meaning: None,
        }],
        answer: Answer::Tables(&[of_joints("", MatrixUnit::PerRate)]),
        is_of_motion: true,
        ..Entry::of(Function::CoriolisMatrix)
    },
    Entry {
        name: "forward_dynamics",
        capability: Capability::ForwardDynamics,
        summary: "Accelerations for positions `q`, velocities `qd` and torques `tau`, with a free tip.",
        details: "qdd: M(q)⁻¹ (τ - C(q, q̇) q̇ - g(q)). A singular mass matrix (a joint that moves nothing) gives \
            numbers that are not finite.",
        arguments: &[Positions, Rates, Torques],
        shape: VECTOR,
        output: "qdd",
        answer: Answer::Accelerations,
        divides: Some(
            "the accelerations are not finite: the mass matrix is singular \
             (a joint moves no mass), or the state is too large",
        ),
        ..Entry::of(Function::ForwardDynamics)
    },
    Entry {
        name: "forward_kinematics",
        capability: Capability::Kinematics,
        summary: "The tip in the world, base and tool included.",
        details: "tip->rotation: its columns are the axes of the tip frame, in world axes. tip->translation: its \
            origin in the world, m.",
        arguments: &[Positions],
        shape: POSE,
        output: "tip",
        listed: "returned: the rows of the rotation, then the translation",
        answer: Answer::Poses,
        ..Entry::of(Function::ForwardKinematics)
    },
    Entry {
        name: "link_poses",
        capability: Capability::Kinematics,
        summary: "The frame of every row of the table in the world.",
        details: "poses[i]: at the far end of link i + 1 in a standard table, on its joint in a modified one; axes as \
            columns, origin in m. The tool is not included.",
        arguments: &[Positions],
        shape: Shape::Array(Joints, &POSE),
        output: "poses",
        listed: "returned: rotation and translation of every link",
        answer: Answer::Poses,
        ..Entry::of(Function::LinkPoses)
    },
    Entry {
        name: "jacobian",
        capability: Capability::Kinematics,
        summary: "The geometric Jacobian of the tip in world axes: three linear rows, then three angular ones.",
        details: "jacobian: its product with q̇ is the velocity of the origin of the tip frame (m/s) above the angular \
            velocity of the last link (rad/s).",
        arguments: &[Positions],
        shape: Shape::Array(Fixed(6), &VECTOR),
        output: "jacobian",
        listed: "returned: three linear rows, then three angular ones",
        own: &[
            Own {
                quantity: Quantity::JacobianLinear,
                heading: |joint| format!("column {joint} of the Jacobian"),
                meaning: None,
            },
            Own {
                quantity: Quantity::JacobianAngular,
                heading: |joint| format!("column {joint} of the Jacobian"),
                meaning: None,
            },
        ],
        answer: Answer::Tables(&[AnswerTable {
            about: "velocity of the tip per joint velocity, world axes: v in m/s, w in rad/s",
            unit: None,
            rows: Labels::Names(&["vx", "vy", "vz", "wx", "wy", "wz"]),
            columns: Labels::Joints,
        }]),
        ..Entry::of(Function::Jacobian)
    },
    Entry {
        name: "jacobian_rate_times_velocity",
        capability: Capability::Kinematics,
        summary: "J̇ q̇: the acceleration of the tip in world axes when q̈ = 0, linear, then angular.",
        details: "acceleration: of the origin of the tip frame (m/s²), then angular (rad/s²). At any other q̈ they are \
            J q̈ + J̇ q̇.",
        arguments: &[Positions, Rates],
        shape: Shape::Array(Fixed(6), &Shape::Number),
        output: "acceleration",
        own: &[Own {
            quantity: Quantity::TipAcceleration,
            heading: |_| "acceleration of the tip where q̈ = 0".to_owned(),
            meaning: None,
        }],
        answer: Answer::Tables(&[AnswerTable {
            about: "acceleration of the tip where q̈ = 0, world axes",
            unit: None,
            rows: Labels::Names(&["linear, m/s²", "angular, rad/s²"]),
            columns: AXES,
        }]),
        ..Entry::of(Function::JacobianRateTimesVelocity)
    },
    Entry {
        name: "kinetic_energy",
        capability: Capability::Energy,
        summary: "Kinetic energy, J.",
        details: "½ q̇ᵀ M(q) q̇ of the links; rotors are not included.",
        arguments: &[Positions, Rates],
        shape: Shape::Number,
        output: "energy",
        own: &[Own {
            quantity: Quantity::KineticEnergy,
            heading: |_| "kinetic energy: ½ Σ (m ċ · ċ + ω · I ω)".to_owned(),
            meaning: None,
        }],
        answer: Answer::Number("J"),
        ..Entry::of(Function::KineticEnergy)
    },
    Entry {
        name: "potential_energy",
        capability: Capability::Energy,
        summary: "Potential energy in gravity, J; zero where a mass is at the origin of frame 0.",
        details: "-Σ m g·c, with c from the origin of frame 0 to each centre of mass.",
        arguments: &[Positions],
        shape: Shape::Number,
        output: "energy",
        own: &[
            Own {
                quantity: Quantity::ComPosition,
                heading: |joint| format!("centre of mass of link {joint}, in frame 0"),
                meaning: None,
            },
            Own {
                quantity: Quantity::PotentialEnergy,
                heading: |_| "potential energy: -Σ m g · c".to_owned(),
                meaning: None,
            },
        ],
        answer: Answer::Number("J"),
        ..Entry::of(Function::PotentialEnergy)
    },
    Entry {
        name: "centre_of_mass",
        capability: Capability::CentreOfMass,
        summary: "The centre of mass of all links in the world, base included.",
        details: "centre: Σ m c / Σ m, m. Rotors are not included. An arm without mass gives numbers that are not \
        finite.",
        arguments: &[Positions],
        shape: TRIPLE,
        output: "centre",
        listed: "returned: x, y, z",
        own: &[Own {
            quantity: Quantity::ComPosition,
            heading: |joint| match joint {
                0 => "centre of mass of the arm: Σ m c / Σ m, in the world".to_owned(),
                _ => format!("centre of mass of link {joint}, from the base in world axes"),
            },
            meaning: Some("centre of mass of link i, from the base in world axes; i = 0: of the arm, in the world"),
        }],
        answer: Answer::Tables(&[AnswerTable {
            about: "centre of mass of the arm in the world, m",
            unit: None,
            rows: Labels::Names(&["arm"]),
            columns: AXES,
        }]),
        divides: Some(WITHOUT_MASS),
        ..Entry::of(Function::CentreOfMass)
    },
    Entry {
        name: "centre_of_mass_jacobian",
        capability: Capability::CentreOfMass,
        summary: "The Jacobian of the centre of mass in world axes: its velocity per joint velocity.",
        details: "jacobian: its product with q̇ is the velocity of the centre of mass, m/s. An arm without mass \
        gives numbers that \
            are not finite.",
        arguments: &[Positions],
        shape: Shape::Array(Fixed(3), &VECTOR),
        output: "jacobian",
        listed: "returned: the rows of the Jacobian",
        own: &[
            Own {
                quantity: Quantity::ComPosition,
                heading: |joint| format!("centre of mass of link {joint}, from the base in world axes"),
                meaning: Some("centre of mass of link i, from the base in world axes"),
            },
            Own {
                quantity: Quantity::JacobianLinear,
                heading: |joint| format!("column {joint} of the Jacobian: what is behind joint {joint} moves with it"),
                meaning: Some("velocity of the centre of mass per rate of joint i, world axes"),
            },
        ],
        answer: Answer::Tables(&[AnswerTable {
            about: "velocity of the centre of mass per joint velocity, world axes, m/s",
            unit: None,
            rows: Labels::Names(&["vx", "vy", "vz"]),
            columns: Labels::Joints,
        }]),
        divides: Some(WITHOUT_MASS),
        ..Entry::of(Function::CentreOfMassJacobian)
    },
    Entry {
        name: "regressor",
        capability: Capability::Regressor,
        summary: "Torques per inertial parameter: joint, link, (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz).",
        details: "regressor[i][j][k]: torque i per parameter k of link j, gravity included. The parameters refer to \
            the link frame of the table: c and J from its origin, in its axes; Jxy is the tensor's element, -∫ x \
            y dm.",
        arguments: &[Positions, Rates, Accelerations],
        shape: Shape::Array(Joints, &Shape::Array(Joints, &Shape::Array(Fixed(10), &Shape::Number))),
        output: "regressor",
        listed: "returned: torque, link, parameter (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz)",
        own: &[Own {
            quantity: Quantity::RegressorElement,
            heading: |joint| format!("torque {joint} per parameter"),
            meaning: None,
        }],
        answer: Answer::PerParameter,
        ..Entry::of(Function::Regressor)
    },
    Entry {
        name: "inverse_dynamics_derivatives",
        capability: Capability::InverseDynamicsDerivatives,
        summary: "∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics`; row i is torque i.",
        details: "dq[i][j], dqd[i][j]: of torque i, by joint j. The derivative by q̈ is the mass matrix.",
        arguments: &[Positions, Rates, Accelerations],
        shape: Shape::Record(Record::TorqueDerivatives, &[MATRIX, MATRIX]),
        output: "derivatives",
        listed: "returned: the rows of ∂τ/∂q, then those of ∂τ/∂q̇",
        answer: Answer::Tables(&[of_joints("∂τ/∂q", MatrixUnit::PerPosition), of_joints("∂τ/∂q̇", MatrixUnit::PerRate)]),
        is_of_motion: true,
        ..Entry::of(Function::InverseDynamicsDerivatives)
    },
    Entry {
        name: "joint_wrenches",
        capability: Capability::JointWrenches,
        summary: "Force and moment that link i-1 exerts on link i, at joint i, in axes fixed to link i.",
        details: "wrenches[i]: exerted BY the link before joint i + 1 ON the link behind it, with a free tip; force in \
            N, moment in N m; axis z is that of the joint. The moment is about the origin of the frame before it \
            in a standard table, about the foot of the common normal on its axis in a modified one.",
        arguments: &[Positions, Rates, Accelerations],
        shape: Shape::Array(Joints, &Shape::Record(Record::Wrench, &[TRIPLE, TRIPLE])),
        output: "wrenches",
        listed: "returned: force and moment of every joint",
        answer: Answer::Tables(&[AnswerTable {
            about: "what the link before exerts at each joint, axes fixed to the link, z along the joint: f in N, n \
            in N m",
            unit: None,
            rows: Labels::Joints,
            columns: Labels::Names(&["fx", "fy", "fz", "nx", "ny", "nz"]),
        }]),
        is_irreducible: true,
        ..Entry::of(Function::JointWrenches)
    },
    Entry {
        name: "inverse_dynamics_on_moving_base",
        capability: Capability::MovingBase,
        summary: "Torques on a base that moves as told, under gravity as told, with a free tip.",
        details: "base_omega (rad/s), base_omega_dot (rad/s²): of frame 0. base_acceleration (m/s²): of its origin, \
            gravity not included. base_gravity (m/s²): points down, and replaces the robot's own. All in the \
            axes of frame 0.",
        arguments: &[Positions, Rates, Accelerations, Base],
        shape: VECTOR,
        output: "tau",
        answer: Answer::Torques,
        returns_torques: true,
        ..Entry::of(Function::InverseDynamicsOnMovingBase)
    },
    Entry {
        name: "actuator_torques",
        capability: Capability::Actuation,
        summary: "What rotors behind gears and friction add to the torques.",
        details: "G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇), to be added to the torques of the links. Friction of Coulomb \
            is zero at rest; a joint without a motor needs nothing.",
        arguments: &[Rates, Accelerations],
        shape: VECTOR,
        output: "tau",
        own: &[Own {
            quantity: Quantity::ActuatorTorque,
            heading: |joint| format!("motor {joint}: G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇)"),
            meaning: None,
        }],
        answer: Answer::Torques,
        is_irreducible: true,
        ..Entry::of(Function::ActuatorTorques)
    },
];
