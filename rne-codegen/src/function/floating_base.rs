//! The functions of a robot whose base nothing holds.

use super::Function;
use super::answer::{AXES, Answer, AnswerTable, Labels};
use super::capability::Capability;
use super::entry::{Entry, Own, WITHOUT_MASS};
use crate::quantity::Quantity;

/// Rows of the base, then of the joints.
const VELOCITIES: Labels = Labels::BaseAndJoints;
/// Three components along the axes, then three about them.
const ALONG_AND_ABOUT: Labels = Labels::Names(&["x", "y", "z", "about x", "about y", "about z"]);

/// Where the origins of frames are in the Jacobians of tips.
const FROM_BASE: &str = "origin of that frame, from frame 0 in world axes";

/// The force and the moment that must act on a base that nothing holds.
const ON_BASE: [Own; 2] = [
    Own::of(Quantity::BaseForce, |_| "force that must act on the base".to_owned()),
    Own::of(Quantity::BaseMoment, |_| "moment that must act on the base, about the origin of frame 0".to_owned()),
];

/// Rates of the momentum.
const CENTROIDAL: [Own; 2] = [
    Own::of(Quantity::BaseForce, |_| "rate of the momentum".to_owned()),
    Own::of(Quantity::CentroidalMoment, |_| "rate of the angular momentum about the centre of mass".to_owned()),
];

/// The velocity of a base that nothing holds.
const ORIGIN_VELOCITY: Own = Own::meaning(
    Quantity::OriginVelocity,
    "velocity of the frame's origin; of frame 0 for i = 0, in its axes",
    |joint| format!("velocity of the origin of frame {joint}"),
);

/// Torques, and the wrench on the base.
pub(super) const TORQUES: Entry = Entry {
    output: "torques",
    listed: "returned: force and moment on the base, then the torques",
    own: &ON_BASE,
    answer: Answer::Tables(&[
        AnswerTable::of("force on the base (N), in axes of frame 0", Labels::Names(&["force"]), AXES),
        AnswerTable::of("moment on the base (N m), about the origin of frame 0", Labels::Names(&["moment"]), AXES),
        AnswerTable::of("torques (N m, prismatic: N)", Labels::Names(&["tau"]), Labels::Joints),
    ]),
    ..Entry::of(Function::InverseDynamicsOfFloatingBase, Capability::FloatingBase)
};

/// The mass matrix with the rows of the base.
pub(super) const MASS_MATRIX: Entry = Entry {
    output: "mass",
    listed: "returned: the rows of the matrix",
    own: &ON_BASE,
    answer: Answer::Tables(&[AnswerTable::of(
        "force and moment on the base and torques per acceleration, axes of frame 0; SI units",
        VELOCITIES,
        VELOCITIES,
    )]),
    feels_rotors: true,
    ..Entry::of(Function::FloatingMassMatrix, Capability::FloatingBase)
};

/// Accelerations of the base and of the joints.
pub(super) const ACCELERATIONS: Entry = Entry {
    output: "accelerations",
    listed: "returned: linear and angular acceleration of the base, then those of the joints",
    own: &[
        Own::of(Quantity::OriginAcceleration, |_| "acceleration of the base, less gravity".to_owned()),
        Own::of(Quantity::OmegaDot, |_| "angular acceleration of the base".to_owned()),
    ],
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
    ..Entry::of(Function::FloatingForwardDynamics, Capability::FloatingBase)
};

/// The part of an entry that the step and its derivatives have in common.
const STEP: Entry = Entry {
    divides: Some(
        "the result of the step is not finite: the mass matrix is singular \
         (a joint or the base moves no mass), or the state is too large",
    ),
    inverts_mass: true,
    feels_rotors: true,
    ..Entry::of(Function::FloatingEulerStep, Capability::FloatingEulerStep)
};

/// The functions.
pub(super) static FLOATING_BASE: &[Entry] = &[
    TORQUES,
    MASS_MATRIX,
    Entry {
        output: "bias",
        listed: "returned: force and moment on the base, then the torques",
        own: &ON_BASE,
        answer: Answer::Tables(&[AnswerTable::of(
            "force (N) and moment (N m) on the base, axes of frame 0, then torques (N m, prismatic: N)",
            Labels::Names(&["bias"]),
            VELOCITIES,
        )]),
        ..Entry::of(Function::FloatingBias, Capability::FloatingBase)
    },
    ACCELERATIONS,
    Entry {
        output: "map",
        listed: "returned: the rows of the matrix",
        own: &CENTROIDAL,
        answer: Answer::Tables(&[AnswerTable::of(
            "momentum and angular momentum about the centre of mass per velocity, axes of frame 0; SI units",
            ALONG_AND_ABOUT,
            VELOCITIES,
        )]),
        divides: Some(WITHOUT_MASS),
        ..Entry::of(Function::CentroidalMomentumMatrix, Capability::CentroidalMomentum)
    },
    Entry {
        output: "rate",
        listed: "returned: force, then moment about the centre of mass",
        own: &CENTROIDAL,
        answer: Answer::Tables(&[AnswerTable::of(
            "force (N), then moment about the centre of mass (N m), axes of frame 0",
            Labels::Names(&["rate"]),
            ALONG_AND_ABOUT,
        )]),
        divides: Some(WITHOUT_MASS),
        ..Entry::of(Function::CentroidalBias, Capability::CentroidalMomentum)
    },
    Entry {
        output: "regressor",
        listed: "returned: force, moment and torque; base and link; parameter \
                 (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz)",
        own: &[
            Own::of(Quantity::BaseForce, |_| "force on the base per parameter".to_owned()),
            Own::of(Quantity::BaseMoment, |_| "moment on the base per parameter".to_owned()),
            Own::of(Quantity::RegressorElement, |joint| format!("torque {joint} per parameter")),
        ],
        answer: Answer::PerParameter,
        ..Entry::of(Function::FloatingRegressor, Capability::FloatingRegressor)
    },
    Entry {
        output: "energy",
        own: &[
            Own::of(Quantity::KineticEnergy, |_| "kinetic energy: ½ Σ (m ċ · ċ + ω · I ω)".to_owned()),
            ORIGIN_VELOCITY,
        ],
        answer: Answer::Number("J"),
        feels_rotors: true,
        ..Entry::of(Function::FloatingKineticEnergy, Capability::FloatingEnergy)
    },
    Entry {
        output: "energy",
        own: &[
            Own::meaning(
                Quantity::FrameRotation,
                "rotation from frame i to frame 0; of the base to the world for i = 0",
                |joint| format!("frame {joint}, in frame 0"),
            ),
            Own::meaning(
                Quantity::FrameOrigin,
                "origin of that frame, in frame 0; of the base in the world for i = 0",
                |joint| format!("frame {joint}, in frame 0"),
            ),
            Own::of(Quantity::ComPosition, |joint| format!("centre of mass of link {joint}, in frame 0")),
            Own::of(Quantity::PotentialEnergy, |_| "potential energy: -Σ m g · c".to_owned()),
        ],
        answer: Answer::Number("J"),
        ..Entry::of(Function::FloatingPotentialEnergy, Capability::FloatingEnergy)
    },
    Entry {
        output: "momentum",
        listed: "returned: momentum, then angular momentum about the centre of mass",
        own: &[
            ORIGIN_VELOCITY,
            Own::meaning(
                Quantity::LinearMomentum,
                "linear momentum of link i and all behind it; of the robot, in axes of frame 0, for i = 0",
                |joint| match joint {
                    0 => "momentum of the robot".to_owned(),
                    _ => format!("momentum of link {joint} and all behind it"),
                },
            ),
            Own::meaning(
                Quantity::CentroidalMoment,
                "angular momentum about the centre of mass of the robot, in axes of frame 0",
                |_| "angular momentum about the centre of mass".to_owned(),
            ),
        ],
        answer: Answer::Tables(&[AnswerTable::of(
            "momentum (N s), then angular momentum about the centre of mass (N m s), axes of frame 0",
            Labels::Names(&["momentum"]),
            ALONG_AND_ABOUT,
        )]),
        divides: Some(WITHOUT_MASS),
        ..Entry::of(Function::CentroidalMomentum, Capability::CentroidalMomentum)
    },
    Entry {
        output: "jacobians",
        listed: "returned: for each tip the rows of its Jacobian",
        own: &[
            Own::meaning(Quantity::FrameOrigin, FROM_BASE, |joint| format!("origin of frame {joint}, from frame 0")),
            Own::meaning(Quantity::JacobianLinear, "velocity of a tip per velocity, world axes", |joint| {
                format!("columns {joint} of the Jacobians; 0: of the base")
            }),
            Own::meaning(Quantity::JacobianAngular, "angular velocity of a tip per velocity, world axes", |joint| {
                format!("columns {joint} of the Jacobians; 0: of the base")
            }),
        ],
        answer: Answer::Tables(&[AnswerTable::of(
            "velocity of each tip per velocity, world axes; base in axes of frame 0; SI units",
            Labels::OfTips(&["vx", "vy", "vz", "wx", "wy", "wz"]),
            VELOCITIES,
        )]),
        ..Entry::of(Function::TipJacobians, Capability::FloatingKinematics)
    },
    Entry {
        output: "accelerations",
        listed: "returned: for each tip its acceleration, then its angular acceleration",
        own: &[
            Own::meaning(
                Quantity::JointPointAcceleration,
                "acceleration of joint i, in the axes of its parent",
                |joint| format!("acceleration of joint {joint}, in the axes of its parent"),
            ),
            Own::of(Quantity::TipAcceleration, |_| {
                "accelerations of the tips where nothing else accelerates".to_owned()
            }),
        ],
        answer: Answer::Tables(&[AnswerTable::of(
            "acceleration of each tip where those of the base and of the joints are zero, world axes",
            Labels::OfTips(&["linear, m/s²", "angular, rad/s²"]),
            AXES,
        )]),
        ..Entry::of(Function::TipAccelerations, Capability::FloatingKinematics)
    },
    Entry {
        output: "result",
        listed: "returned: accelerations of the base and of the joints, then force and moment of each tip",
        own: &[
            Own::of(Quantity::OriginAcceleration, |_| "acceleration of the base, less gravity".to_owned()),
            Own::of(Quantity::OmegaDot, |_| "angular acceleration of the base".to_owned()),
            Own::of(Quantity::ContactForce, |tip| format!("force of the contact at tip {tip}")),
            Own::of(Quantity::ContactMoment, |tip| format!("moment of the contact at tip {tip}")),
        ],
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
        ..Entry::of(Function::ForwardDynamicsInContact, Capability::ContactDynamics)
    },
    Entry {
        output: "derivatives",
        listed: "returned: force, moment and torques by q, then by q̇, then by the angular velocity of the base",
        own: &ON_BASE,
        answer: Answer::Tables(&[
            AnswerTable::of("force and moment on the base and torques by q; SI units", VELOCITIES, Labels::Joints),
            AnswerTable::of("by q̇; SI units", VELOCITIES, Labels::Joints),
            AnswerTable::of("by the angular velocity of the base, in axes of frame 0; SI units", VELOCITIES, AXES),
        ]),
        ..Entry::of(Function::FloatingInverseDynamicsDerivatives, Capability::FloatingInverseDynamicsDerivatives)
    },
    Entry {
        output: "next",
        listed: "returned: pose, velocity and angular velocity of the base after the step, then the positions and the \
                 velocities of the joints",
        own: &[
            Own::names(
                Quantity::FrameRotation,
                "rotation of the base: its columns are the axes of frame 0 in the world",
            ),
            Own::names(Quantity::FrameOrigin, "origin of frame 0 in the world"),
            Own::names(Quantity::OriginVelocity, "velocity of the origin of frame 0, in its axes"),
            Own::of(Quantity::OriginAcceleration, |_| "acceleration of the base, less gravity".to_owned()),
            Own::of(Quantity::OmegaDot, |_| "angular acceleration of the base".to_owned()),
            Own::of(Quantity::NextOmega, |_| "angular velocity of the base after the step".to_owned()),
            Own::of(Quantity::NextOrigin, |_| "origin of frame 0 after the step".to_owned()),
            Own::of(Quantity::NextRotation, |_| "rotation of the base after the step".to_owned()),
            Own::of(Quantity::NextVelocity, |_| "velocity of the origin of frame 0 after the step".to_owned()),
            Own::of(Quantity::NextRate, |joint| format!("velocity of joint {joint} after the step")),
            Own::of(Quantity::NextPosition, |joint| format!("position of joint {joint} after the step")),
        ],
        answer: Answer::Tables(&[
            AnswerTable::of("rotation of the base after the step: the columns are the axes of frame 0", AXES, AXES),
            AnswerTable::of("origin of frame 0 after the step, in the world (m)", Labels::Names(&["origin"]), AXES),
            AnswerTable::of("velocity of this origin (m/s), in axes of frame 0", Labels::Names(&["linear"]), AXES),
            AnswerTable::of(
                "angular velocity of the base (rad/s), in axes of frame 0",
                Labels::Names(&["angular"]),
                AXES,
            ),
            AnswerTable::of(
                "position (rad, prismatic: m) and velocity (rad/s, prismatic: m/s) of each joint after the step",
                Labels::Names(&["q", "qd"]),
                Labels::Joints,
            ),
        ]),
        ..STEP
    },
    Entry {
        output: "derivatives",
        listed: "returned: the rows of the derivatives of the next positions by the positions, by the velocities and \
                 by the torques, then those of the next velocities",
        own: &[
            Own::names(
                Quantity::FrameRotation,
                "rotation of the base: its columns are the axes of frame 0 in the world",
            ),
            Own::names(Quantity::FrameOrigin, "origin of frame 0 in the world"),
            Own::names(Quantity::OriginVelocity, "velocity of the origin of frame 0, in its axes"),
            Own::of(Quantity::OriginAcceleration, |_| "acceleration of the base, less gravity".to_owned()),
            Own::of(Quantity::OmegaDot, |_| "angular acceleration of the base".to_owned()),
            Own::of(Quantity::NextOmega, |_| "angular velocity of the base after the step".to_owned()),
            Own::meaning(
                Quantity::NextOrigin,
                "shift of the base after the step, along the axes that frame 0 has then",
                |_| "shift of the base after the step".to_owned(),
            ),
            Own::of(Quantity::NextTurn, |_| "turn of the base after the step".to_owned()),
            Own::of(Quantity::NextVelocity, |_| "velocity of the origin of frame 0 after the step".to_owned()),
            Own::of(Quantity::NextRate, |joint| format!("velocity of joint {joint} after the step")),
            Own::of(Quantity::NextPosition, |joint| format!("position of joint {joint} after the step")),
        ],
        answer: Answer::Tables(&[
            AnswerTable::of(
                "positions after the step by the positions, axes of frame 0; SI units",
                VELOCITIES,
                VELOCITIES,
            ),
            AnswerTable::of("positions after the step by the velocities (s)", VELOCITIES, VELOCITIES),
            AnswerTable::of("positions after the step by the torques; SI units", VELOCITIES, Labels::Joints),
            AnswerTable::of("velocities after the step by the positions; SI units", VELOCITIES, VELOCITIES),
            AnswerTable::of("velocities after the step by the velocities; SI units", VELOCITIES, VELOCITIES),
            AnswerTable::of("velocities after the step by the torques; SI units", VELOCITIES, Labels::Joints),
        ]),
        function: Function::FloatingEulerStepDerivatives,
        capability: Capability::FloatingEulerStepDerivatives,
        ..STEP
    },
];
