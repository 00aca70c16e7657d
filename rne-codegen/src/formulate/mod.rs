//! Formulas of each function of a robot, written with a builder: the seven steps and the other functions.

pub(crate) mod actuation;
pub(crate) mod arm;
pub(crate) mod centre_of_mass;
pub(crate) mod energy;
pub(crate) mod joint;
pub(crate) mod kinematics;
pub(crate) mod ldlt;
pub(crate) mod mass_matrix;
pub(crate) mod momentum;
pub(crate) mod payload;
pub(crate) mod regressor;
pub(crate) mod seven_steps;

pub(crate) use arm::{Arm, Link, Mount};
pub(crate) use joint::{Joint, JointState, Wrench};
pub(crate) use kinematics::{Frame, Frames};
pub(crate) use payload::{AtTip, Payload};
pub(crate) use seven_steps::{Load, Motion, Turning};

use rne_model::Robot;

use crate::function::{Argument, Function};
use crate::ir::{Axis, Builder, Cause, Component, Name, Quantity, Ref, Symbol, Vector, WithRespectTo};

/// The results of a function of a robot, by name, in the order of its layout. Zeros of the function are put in before
/// anything is folded.
pub(crate) fn outputs(builder: &Builder, robot: &Robot, function: Function) -> Vec<(Name, Ref)> {
    let derivation = Derivation::new(builder, robot, function);
    let outputs = match function {
        Function::InverseDynamics
        | Function::InverseDynamicsWithWrench
        | Function::InverseDynamicsWithPayload
        | Function::InverseDynamicsFromSinCos
        | Function::GravityTorques
        | Function::BiasTorques
        | Function::InverseDynamicsOnMovingBase
        | Function::GravityTorquesWithPayload
        | Function::BiasTorquesWithPayload => derivation.torques(),
        Function::MassMatrix | Function::MassMatrixWithPayload => mass_matrix(&derivation.upper_half()),
        Function::CoriolisMatrix => derivation.coriolis_matrix(),
        Function::ForwardDynamics | Function::ForwardDynamicsWithPayload => {
            forward_dynamics(builder, &derivation.parents(), &derivation.upper_half(), derivation.tau())
        }
        Function::ForwardKinematics => derivation.tip_pose(),
        Function::LinkPoses => derivation.link_poses(),
        Function::Jacobian => derivation.jacobian(),
        Function::JacobianRateTimesVelocity => derivation.tip_acceleration(),
        Function::WrenchTorques => derivation.wrench_torques(),
        Function::KineticEnergy => derivation.kinetic_energy(),
        Function::PotentialEnergy => derivation.potential_energy(),
        Function::CentreOfMass => derivation.centre_of_mass(),
        Function::CentreOfMassJacobian => derivation.centre_of_mass_jacobian(),
        Function::Regressor => derivation.regressor(),
        Function::InverseDynamicsDerivatives | Function::InverseDynamicsDerivativesWithPayload => {
            derivatives(builder, &derivation.tau())
        }
        Function::JointWrenches => derivation.joint_wrenches(),
        Function::MomentumAndRate | Function::MomentumAndRateWithPayload => derivation.momentum_and_rate(),
        Function::ActuatorTorques => derivation.actuator_torques(),
        Function::InverseMassMatrix => inverse_mass_matrix(builder, &derivation.parents(), &derivation.upper_half()),
    };
    outputs.into_iter().map(|(name, symbol)| (name, symbol.at)).collect()
}

/// The results of a function, by name, in the order of its layout.
pub(crate) type Outputs<'s> = Vec<(Name, Symbol<'s>)>;

/// A function being written.
struct Derivation<'s, 'r> {
    builder: &'s Builder,
    robot: &'r Robot,
    arm: Arm<'s>,
    states: Vec<JointState<'s>>,
    base: Motion<'s>,
    tip: AtTip<'s>,
}

impl<'s, 'r> Derivation<'s, 'r> {
    fn new(builder: &'s Builder, robot: &'r Robot, function: Function) -> Self {
        let arm = Arm::new(builder, robot);
        let dof = robot.dof();
        let of_joint = |quantity, joint| builder.argument(Name::scalar(quantity, joint));
        let vector =
            |quantity, joint| Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, joint, axis))));
        let given = |argument, quantity, joint, otherwise| {
            if function.takes(argument) { of_joint(quantity, joint) } else { builder.constant(0.0, otherwise) }
        };
        let state = |joint| JointState {
            q: of_joint(Quantity::Position, joint),
            turn: function
                .takes(Argument::Sines)
                .then(|| (of_joint(Quantity::Sine, joint), of_joint(Quantity::Cosine, joint))),
            qd: given(Argument::Rates, Quantity::Rate, joint, Cause::AtRest),
            qdd: given(Argument::Accelerations, Quantity::RateDot, joint, Cause::NoAcceleration),
        };
        let states = (1..=dof).map(state).collect();
        let tip = if let Some(payload) = Payload::argument(builder, dof) {
            AtTip::Payload(payload)
        } else if function.takes(Argument::Wrench) {
            let [force, moment] = [Quantity::JointForce, Quantity::JointMoment].map(|part| vector(part, dof + 1));
            AtTip::Wrench(Wrench { force, moment })
        } else {
            AtTip::Nothing
        };
        let base = if function.takes(Argument::Base) {
            let motion = [Quantity::Omega, Quantity::OmegaDot, Quantity::Acceleration];
            Motion::of_base(builder, motion.map(|quantity| vector(quantity, 0)), vector(Quantity::Gravity, 0))
        } else {
            Motion::of_fixed_base(builder, arm.gravity)
        };
        Self { builder, robot, arm, states, base, tip }
    }

    fn loads(&self) -> Vec<Load<'s>> {
        seven_steps::inverse_dynamics(&self.arm, &self.states, &self.base, &self.tip)
    }

    fn motions(&self) -> Vec<Motion<'s>> {
        seven_steps::forward(&self.arm, &self.states, &self.base)
    }

    /// The torques of the seven steps.
    fn tau(&self) -> Vec<Symbol<'s>> {
        self.loads().into_iter().map(|load| load.torque).collect()
    }

    /// The vector from each joint to the centre of mass of its link, in the axes of the link.
    fn centres(&self) -> Vec<Vector<'s>> {
        self.motions().iter().map(|motion| motion.d).collect()
    }

    fn frames(&self) -> Frames<'s> {
        kinematics::frames(&self.arm, &self.states, kinematics::base(&self.arm))
    }

    /// In world axes, with their origins from that of the base: where the base stands moves no difference of them.
    fn frames_from_base(&self) -> Frames<'s> {
        let start = Frame { origin: self.builder.zeros(Cause::FirstFrame), ..kinematics::base(&self.arm) };
        kinematics::frames(&self.arm, &self.states, start)
    }

    fn torques(&self) -> Outputs<'s> {
        by_joint(Quantity::Torque, self.tau())
    }

    /// The links that carry the joints.
    fn parents(&self) -> Vec<Option<usize>> {
        self.arm.links.iter().map(|link| link.parent).collect()
    }

    /// The upper half of M.
    fn upper_half(&self) -> Vec<Vec<Symbol<'s>>> {
        mass_matrix::upper_half(&self.arm, &self.states, &self.tip)
    }

    fn coriolis_matrix(&self) -> Outputs<'s> {
        let torques = self.tau();
        coriolis_matrix(self.builder, &torques, self.builder.entry(Name::scalar(Quantity::Half, 0), 0.5))
    }

    fn tip_pose(&self) -> Outputs<'s> {
        pose(self.states.len() + 1, &self.frames().tip)
    }

    fn link_poses(&self) -> Outputs<'s> {
        self.frames().links.iter().enumerate().flat_map(|(index, frame)| pose(index + 1, frame)).collect()
    }

    fn jacobian(&self) -> Outputs<'s> {
        let columns = kinematics::jacobian(&self.arm, &self.frames());
        let [linear, angular] = [0, 1].map(|half| columns.iter().map(|column| column[half]).collect::<Vec<_>>());
        [by_row(Quantity::JacobianLinear, &linear), by_row(Quantity::JacobianAngular, &angular)].concat()
    }

    fn tip_acceleration(&self) -> Outputs<'s> {
        let parts = kinematics::tip_acceleration(&self.arm, &self.states, &self.base);
        let parts = parts.into_iter().enumerate();
        let tip = Name::scalar(Quantity::TipAcceleration, self.states.len() + 1);
        parts.flat_map(|(part, vector)| components(Name { indices: [part, 0], ..tip }, vector)).collect()
    }

    fn wrench_torques(&self) -> Outputs<'s> {
        let torques = match &self.tip {
            AtTip::Wrench(wrench) => kinematics::wrench_torques(&self.arm, &self.frames(), wrench),
            AtTip::Nothing | AtTip::Payload(_) => Vec::new(),
        };
        by_joint(Quantity::Torque, torques)
    }

    fn kinetic_energy(&self) -> Outputs<'s> {
        vec![(Name::scalar(Quantity::KineticEnergy, 0), energy::kinetic(&self.arm, &self.states, &self.motions()))]
    }

    fn potential_energy(&self) -> Outputs<'s> {
        let frame_0 = Frame { rotation: arm::identity(self.builder), origin: self.builder.zeros(Cause::FirstFrame) };
        let frames = kinematics::frames(&self.arm, &self.states, frame_0);
        let energy = energy::potential(&self.arm, &frames, &self.centres());
        vec![(Name::scalar(Quantity::PotentialEnergy, 0), energy)]
    }

    fn centre_of_mass(&self) -> Outputs<'s> {
        let centre = centre_of_mass::position(&self.arm, &self.frames_from_base(), &self.centres());
        components(Name::scalar(Quantity::ComPosition, 0), centre).into()
    }

    fn centre_of_mass_jacobian(&self) -> Outputs<'s> {
        let columns = centre_of_mass::jacobian(&self.arm, &self.frames_from_base(), &self.centres());
        by_row(Quantity::JacobianLinear, &columns)
    }

    fn regressor(&self) -> Outputs<'s> {
        let rows = regressor::regressor(&self.arm, &self.states, &self.motions());
        let mut outputs = Vec::new();
        for (joint, row) in rows.iter().enumerate() {
            for (link, elements) in row.iter().enumerate() {
                let elements = elements.iter().enumerate();
                outputs.extend(elements.map(|(i, element)| (regressor::element_name(joint, link, i), *element)));
            }
        }
        outputs
    }

    fn joint_wrenches(&self) -> Outputs<'s> {
        let wrenches = self.loads().into_iter().enumerate();
        let named = wrenches.flat_map(|(index, Load { wrench: Wrench { force, moment }, .. })| {
            let parts = [(Quantity::JointForce, force), (Quantity::JointMoment, moment)];
            parts.into_iter().flat_map(move |(part, vector)| components(Name::scalar(part, index + 1), vector))
        });
        named.collect()
    }

    fn momentum_and_rate(&self) -> Outputs<'s> {
        let [momenta, rates] =
            momentum::momentum_and_rate(&self.arm, &self.states, &self.motions(), &self.base, &self.tip);
        [by_joint(Quantity::Momentum, momenta), by_joint(Quantity::MomentumRate, rates)].concat()
    }

    fn actuator_torques(&self) -> Outputs<'s> {
        by_joint(Quantity::ActuatorTorque, actuation::torques(self.builder, self.robot, &self.states))
    }
}

/// M by its upper half: row i of `upper` holds the elements (i, i) to (i, n).
pub(crate) fn mass_matrix<'s>(upper: &[Vec<Symbol<'s>>]) -> Outputs<'s> {
    square(upper.len(), |row, column| {
        let (row, column) = (row.min(column), row.max(column));
        (torque_by(row, WithRespectTo::RateDot(column + 1)), upper[row][column - row])
    })
}

/// ½ ∂(bias torques)/∂q̇
pub(crate) fn coriolis_matrix<'s>(builder: &'s Builder, torques: &[Symbol<'s>], half: Symbol<'s>) -> Outputs<'s> {
    let columns = builder.derivatives(torques, (1..=torques.len()).map(WithRespectTo::Rate));
    square(torques.len(), |row, column| {
        let name = Name::indexed(Quantity::CoriolisElement, row + 1, column + 1);
        let line = builder.joint(row + 1);
        (name, builder.name(name, line.within(Quantity::CoriolisElement, || columns[column][row] * half)))
    })
}

/// M⁻¹ (τ - bias)
pub(crate) fn forward_dynamics<'s>(
    builder: &'s Builder,
    parents: &[Option<usize>],
    upper: &[Vec<Symbol<'s>>],
    bias: Vec<Symbol<'s>>,
) -> Outputs<'s> {
    let rest = |(index, torque): (usize, Symbol<'s>)| {
        let applied = builder.argument(Name::scalar(Quantity::AppliedTorque, index + 1));
        builder.joint(index + 1).within(Quantity::Reduced, || applied - torque)
    };
    let rest: Vec<_> = bias.into_iter().enumerate().map(rest).collect();
    by_joint(Quantity::RateDot, ldlt::solved(builder, parents, upper, &rest))
}

/// ∂τ/∂q, then ∂τ/∂q̇
pub(crate) fn derivatives<'s>(builder: &'s Builder, torques: &[Symbol<'s>]) -> Outputs<'s> {
    let by = |kind: fn(usize) -> WithRespectTo| {
        let columns = builder.derivatives(torques, (1..=torques.len()).map(kind));
        square(torques.len(), |row, column| (torque_by(row, kind(column + 1)), columns[column][row]))
    };
    [by(WithRespectTo::Position), by(WithRespectTo::Rate)].concat()
}

/// The name of the derivative of a torque, whose joint is counted from 0.
pub(crate) fn torque_by(row: usize, by: WithRespectTo) -> Name {
    Name { by: Some(by), ..Name::scalar(Quantity::Torque, row + 1) }
}

/// M⁻¹ = L⁻ᵀ D⁻¹ L⁻¹: column j is solved from joint j on in the order of elimination, and the rest is its mirror. Row i
/// of `upper` holds the elements (i, i) to (i, n) of M.
pub(crate) fn inverse_mass_matrix<'s>(
    builder: &'s Builder,
    parents: &[Option<usize>],
    upper: &[Vec<Symbol<'s>>],
) -> Outputs<'s> {
    let factors = ldlt::Factors::of(builder, parents, upper);
    let (zero, one) = (builder.constant(0.0, Cause::Arithmetic), builder.constant(1.0, Cause::Arithmetic));
    let name = |quantity, row: usize, column: usize| Name::indexed(quantity, row + 1, column + 1);
    let columns: Vec<Vec<Option<Symbol<'s>>>> = (0..upper.len())
        .map(|column| {
            let unit: Vec<_> = (0..upper.len()).map(|row| if row == column { one } else { zero }).collect();
            factors.solved(factors.place(column), &unit, |quantity, row| name(quantity, row, column))
        })
        .collect();
    square(upper.len(), |row, column| {
        let is_mirror = factors.place(row) < factors.place(column);
        let (row, column) = if is_mirror { (column, row) } else { (row, column) };
        (name(Quantity::RateDot, row, column), columns[column][row].unwrap_or(zero))
    })
}

/// Elements of an n × n matrix by rows.
pub(crate) fn square<'s>(dof: usize, element: impl Fn(usize, usize) -> (Name, Symbol<'s>)) -> Outputs<'s> {
    (0..dof)
        .flat_map(|row| (0..dof).map(move |column| (row, column)))
        .map(|(row, column)| element(row, column))
        .collect()
}

/// One result for each joint.
pub(crate) fn by_joint(quantity: Quantity, numbers: Vec<Symbol<'_>>) -> Outputs<'_> {
    let numbers = numbers.into_iter().enumerate();
    numbers.map(|(index, number)| (Name::scalar(quantity, index + 1), number)).collect()
}

/// The components of the vector with this name.
fn components(name: Name, vector: Vector<'_>) -> [(Name, Symbol<'_>); 3] {
    Axis::ALL.map(|axis| (Name { component: Component::Vector(axis), ..name }, vector.0[axis as usize]))
}

/// Vectors of the joints as the columns of a matrix, by rows.
fn by_row<'s>(quantity: Quantity, columns: &[Vector<'s>]) -> Outputs<'s> {
    let row = |axis: Axis| {
        let columns = columns.iter().enumerate();
        columns.map(move |(index, column)| (Name::vector(quantity, index + 1, axis), column.0[axis as usize]))
    };
    Axis::ALL.into_iter().flat_map(row).collect()
}

/// Rotation by rows, then translation.
fn pose<'s>(joint: usize, frame: &Frame<'s>) -> Outputs<'s> {
    let rotation = Axis::ALL.into_iter().zip(frame.rotation.0).flat_map(|(row, values)| {
        Axis::ALL.map(|column| (Name::matrix(Quantity::FrameRotation, joint, row, column), values.0[column as usize]))
    });
    rotation.chain(components(Name::scalar(Quantity::FrameOrigin, joint), frame.origin)).collect()
}
