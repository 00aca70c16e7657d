//! The functions of a robot with closed loops.

use crate::Function;
use crate::answer::{Answer, AnswerTable, Labels, MatrixUnit};
use crate::capability::Capability;
use crate::entry::Entry;
use crate::floating_base;

/// Why a solution of the equations of loops may be none.
const SINGULAR: &str = "the numbers are not finite: the loops are singular in this position (the dependent joints are \
                        not determined), or the state is too large";

const OF_CLOSURE: Entry =
    Entry { divides: Some(SINGULAR), ..Entry::of(Function::ClosureStep, Capability::ClosedLoops) };

const TORQUES: Entry =
    Entry { divides: Some(SINGULAR), ..Entry::torques(Function::InverseDynamicsOfLoops, Capability::ClosedLoops) };

/// Why accelerations may be none.
const MOVES_NO_MASS: &str = "the accelerations are not finite: the mass matrix is singular (a joint moves no mass), \
                             the loops are singular in this position, or the state is too large";

/// The functions.
pub(crate) static CLOSED_LOOPS: &[Entry] = &[
    Entry {
        output: "step",
        listed: "returned: positions of the dependent joints after the step, then the equations before it",
        answer: Answer::Tables(&[
            AnswerTable::of("after the step (rad, prismatic: m)", Labels::Names(&["passive"]), Labels::Passive),
            AnswerTable::of(
                "before the step (m, and products of axes)",
                Labels::Names(&["residual"]),
                Labels::Equations,
            ),
        ]),
        ..OF_CLOSURE
    },
    Entry {
        output: "map",
        listed: "returned: the rows of the matrix",
        answer: Answer::Tables(&[AnswerTable::of(
            "velocity of each dependent joint per velocity; SI units",
            Labels::Passive,
            Labels::Joints,
        )]),
        function: Function::LoopMap,
        ..OF_CLOSURE
    },
    Entry {
        output: "acceleration",
        listed: "returned: accelerations of the dependent joints",
        answer: Answer::Tables(&[AnswerTable::of(
            "accelerations where q̈ is 0 (rad/s², prismatic: m/s²)",
            Labels::Names(&["passive"]),
            Labels::Passive,
        )]),
        function: Function::LoopMapRateTimesVelocity,
        ..OF_CLOSURE
    },
    TORQUES,
    Entry { function: Function::InverseDynamicsOfLoopsWithWrenches, ..TORQUES },
    Entry {
        output: "mass",
        listed: "returned: the rows of the matrix",
        answer: Answer::Tables(&[AnswerTable {
            about: "",
            unit: Some(MatrixUnit::Mass),
            rows: Labels::Joints,
            columns: Labels::Joints,
        }]),
        is_of_motion: true,
        feels_rotors: true,
        divides: Some(SINGULAR),
        ..Entry::of(Function::MassMatrixOfLoops, Capability::ClosedLoops)
    },
    Entry {
        output: "qdd",
        answer: Answer::Accelerations,
        divides: Some(MOVES_NO_MASS),
        inverts_mass: true,
        feels_rotors: true,
        ..Entry::of(Function::ForwardDynamicsOfLoops, Capability::ClosedLoops)
    },
    Entry {
        function: Function::InverseDynamicsOfFloatingLoops,
        capability: Capability::FloatingClosedLoops,
        divides: Some(SINGULAR),
        ..floating_base::TORQUES
    },
    Entry {
        function: Function::FloatingMassMatrixOfLoops,
        capability: Capability::FloatingClosedLoops,
        divides: Some(SINGULAR),
        ..floating_base::MASS_MATRIX
    },
    Entry {
        function: Function::FloatingForwardDynamicsOfLoops,
        capability: Capability::FloatingClosedLoops,
        divides: Some(MOVES_NO_MASS),
        ..floating_base::ACCELERATIONS
    },
];
