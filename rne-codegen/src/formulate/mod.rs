//! Which formulas a function of a robot is made of: the seven steps and what stands beside them, written on a builder.

pub(crate) mod actuation;
pub(crate) mod arm;
pub(crate) mod centre_of_mass;
pub(crate) mod energy;
pub(crate) mod kinematics;
pub(crate) mod ldlt;
pub(crate) mod mass_matrix;
pub(crate) mod regressor;
pub(crate) mod seven_steps;

use rne_model::Robot;

use crate::formulate::arm::Arm;
use crate::formulate::kinematics::Frame;
use crate::formulate::seven_steps::{Base, JointState, Load, Wrench};
use crate::function::{Argument, Function};
use crate::ir::ledger::Cause;
use crate::ir::name::{By, Name};
use crate::ir::quantity::{Axis, Quantity};
use crate::ir::{Builder, Ref, Symbol, Vector};

/// What a function of a robot returns, by name, in the order of its layout. Zeros of the function are put in before
/// anything is folded.
pub(crate) fn outputs(builder: &Builder, robot: &Robot, function: Function) -> Vec<(Name, Ref)> {
    let derivation = Derivation::new(builder, robot, function);
    let outputs = match function {
        Function::InverseDynamics
        | Function::InverseDynamicsWithWrench
        | Function::InverseDynamicsSc
        | Function::GravityTorques
        | Function::BiasTorques
        | Function::InverseDynamicsOnMovingBase => derivation.torques(),
        Function::MassMatrix => derivation.mass_matrix(),
        Function::CoriolisMatrix => derivation.coriolis_matrix(),
        Function::ForwardDynamics => derivation.forward_dynamics(),
        Function::ForwardKinematics => derivation.tip_pose(),
        Function::LinkPoses => derivation.link_poses(),
        Function::Jacobian => derivation.jacobian(),
        Function::JacobianRateTimesVelocity => derivation.tip_acceleration(),
        Function::KineticEnergy => derivation.kinetic_energy(),
        Function::PotentialEnergy => derivation.potential_energy(),
        Function::CentreOfMass => derivation.centre_of_mass(),
        Function::CentreOfMassJacobian => derivation.centre_of_mass_jacobian(),
        Function::Regressor => derivation.regressor(),
        Function::InverseDynamicsDerivatives => derivation.derivatives(),
        Function::JointWrenches => derivation.joint_wrenches(),
        Function::ActuatorTorques => derivation.actuator_torques(),
    };
    outputs.into_iter().map(|(name, symbol)| (name, symbol.at)).collect()
}

type Outputs<'s> = Vec<(Name, Symbol<'s>)>;

/// A function being written.
struct Derivation<'s, 'r> {
    builder: &'s Builder,
    robot: &'r Robot,
    arm: Arm<'s>,
    states: Vec<JointState<'s>>,
    base: Base<'s>,
    tip: Wrench<'s>,
}

impl<'s, 'r> Derivation<'s, 'r> {
    fn new(builder: &'s Builder, robot: &'r Robot, function: Function) -> Self {
        let arm = Arm::new(builder, robot);
        let dof = robot.dof();
        let of_joint = |quantity, joint| builder.argument(Name::scalar(quantity, joint));
        let vector =
            |quantity, joint| Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, joint, axis))));
        let state = |joint| JointState {
            q: of_joint(Quantity::Position, joint),
            turn: function
                .takes(Argument::Sines)
                .then(|| (of_joint(Quantity::Sine, joint), of_joint(Quantity::Cosine, joint))),
            qd: if function.takes(Argument::Rates) {
                of_joint(Quantity::Rate, joint)
            } else {
                builder.constant(0.0, Cause::AtRest)
            },
            qdd: if function.takes(Argument::Accelerations) {
                of_joint(Quantity::RateDot, joint)
            } else {
                builder.constant(0.0, Cause::NoAcceleration)
            },
        };
        let states = (1..=dof).map(state).collect();
        let tip = if function.takes(Argument::Wrench) {
            Wrench { force: vector(Quantity::JointForce, dof + 1), moment: vector(Quantity::JointMoment, dof + 1) }
        } else {
            Wrench { force: builder.zeros(Cause::FreeTip), moment: builder.zeros(Cause::FreeTip) }
        };
        let base = if function.takes(Argument::Base) {
            Base {
                omega: vector(Quantity::Omega, 0),
                omega_dot: vector(Quantity::OmegaDot, 0),
                acceleration: vector(Quantity::Acceleration, 0),
                gravity: vector(Quantity::Gravity, 0),
                lever: arm.base_lever,
            }
        } else {
            Base::fixed(builder, arm.gravity)
        };
        Self { builder, robot, arm, states, base, tip }
    }

    fn loads(&self) -> Vec<Load<'s>> {
        seven_steps::inverse_dynamics(self.builder, &self.arm, &self.states, &self.base, self.tip)
    }

    fn motions(&self) -> Vec<seven_steps::Motion<'s>> {
        seven_steps::forward(self.builder, &self.arm, &self.states, &self.base)
    }

    /// From each joint to the centre of mass of its link, in its axes.
    fn centres(&self) -> Vec<Vector<'s>> {
        self.motions().iter().map(|motion| motion.d).collect()
    }

    fn frames(&self) -> kinematics::Frames<'s> {
        kinematics::frames(self.builder, &self.arm, &self.states, kinematics::base(&self.arm))
    }

    /// In world axes, with their origins from that of the base: where the base stands moves no difference of them.
    fn frames_from_base(&self) -> kinematics::Frames<'s> {
        let start = Frame { origin: self.builder.zeros(Cause::FirstFrame), ..kinematics::base(&self.arm) };
        kinematics::frames(self.builder, &self.arm, &self.states, start)
    }

    fn torques(&self) -> Outputs<'s> {
        let torques = self.loads().into_iter().enumerate();
        torques.map(|(index, load)| (Name::scalar(Quantity::Torque, index + 1), load.torque)).collect()
    }

    fn mass_matrix(&self) -> Outputs<'s> {
        let upper = mass_matrix::upper_half(self.builder, &self.arm, &self.states);
        square(self.states.len(), |row, column| {
            let (row, column) = (row.min(column), row.max(column));
            let name = Name { by: Some(By::RateDot(column + 1)), ..Name::scalar(Quantity::Torque, row + 1) };
            (name, upper[row][column - row])
        })
    }

    /// ½ ∂(bias torques)/∂q̇
    fn coriolis_matrix(&self) -> Outputs<'s> {
        let torques: Vec<_> = self.loads().into_iter().map(|load| load.torque).collect();
        let dof = torques.len();
        let half = self.builder.entry(Name::scalar(Quantity::Half, 0), 0.5);
        let columns = self.builder.derivatives(&torques, (1..=dof).map(By::Rate));
        square(dof, |row, column| {
            let name = Name::indexed(Quantity::CoriolisElement, row + 1, column + 1);
            let line = self.builder.joint(row + 1);
            let value = line.within(Quantity::CoriolisElement, || columns[column][row] * half);
            (name, self.builder.name(name, value))
        })
    }

    fn forward_dynamics(&self) -> Outputs<'s> {
        let upper = mass_matrix::upper_half(self.builder, &self.arm, &self.states);
        let loads = self.loads().into_iter().enumerate();
        let rest: Vec<_> = loads
            .map(|(index, load)| {
                let joint = index + 1;
                let applied = self.builder.argument(Name::scalar(Quantity::AppliedTorque, joint));
                self.builder.joint(joint).within(Quantity::Reduced, || applied - load.torque)
            })
            .collect();
        let accelerations = ldlt::solved(self.builder, &upper, &rest);
        let accelerations = accelerations.into_iter().enumerate();
        accelerations.map(|(index, value)| (Name::scalar(Quantity::RateDot, index + 1), value)).collect()
    }

    fn tip_pose(&self) -> Outputs<'s> {
        pose(self.states.len() + 1, &self.frames().tip)
    }

    fn link_poses(&self) -> Outputs<'s> {
        self.frames().links.iter().enumerate().flat_map(|(index, frame)| pose(index + 1, frame)).collect()
    }

    fn jacobian(&self) -> Outputs<'s> {
        let columns = kinematics::jacobian(self.builder, &self.arm, &self.frames());
        let halves = [Quantity::JacobianLinear, Quantity::JacobianAngular].into_iter().enumerate();
        halves
            .flat_map(|(half, quantity)| Axis::ALL.map(|axis| (half, quantity, axis)))
            .flat_map(|(half, quantity, axis)| {
                columns.iter().enumerate().map(move |(index, column)| {
                    (Name::vector(quantity, index + 1, axis), column[half].0[axis as usize])
                })
            })
            .collect()
    }

    fn tip_acceleration(&self) -> Outputs<'s> {
        let parts = kinematics::tip_acceleration(self.builder, &self.arm, &self.states, &self.base);
        let tip = self.states.len() + 1;
        parts
            .into_iter()
            .enumerate()
            .flat_map(|(part, vector)| {
                let name =
                    move |axis| Name { indices: [part, 0], ..Name::vector(Quantity::TipAcceleration, tip, axis) };
                Axis::ALL.map(|axis| (name(axis), vector.0[axis as usize]))
            })
            .collect()
    }

    fn kinetic_energy(&self) -> Outputs<'s> {
        let energy = energy::kinetic(self.builder, &self.arm, &self.motions());
        vec![(Name::scalar(Quantity::KineticEnergy, 0), energy)]
    }

    fn potential_energy(&self) -> Outputs<'s> {
        let zero_frame = Frame {
            rotation: crate::formulate::arm::identity(self.builder),
            origin: self.builder.zeros(Cause::FirstFrame),
        };
        let frames = kinematics::frames(self.builder, &self.arm, &self.states, zero_frame);
        let energy = energy::potential(self.builder, &self.arm, &frames, &self.centres());
        vec![(Name::scalar(Quantity::PotentialEnergy, 0), energy)]
    }

    fn centre_of_mass(&self) -> Outputs<'s> {
        let (frames, centres) = (self.frames_from_base(), self.centres());
        let centre = centre_of_mass::position(self.builder, &self.arm, &frames, &centres);
        Axis::ALL.map(|axis| (Name::vector(Quantity::ComPosition, 0, axis), centre.0[axis as usize])).into()
    }

    fn centre_of_mass_jacobian(&self) -> Outputs<'s> {
        let (frames, centres) = (self.frames_from_base(), self.centres());
        centre_of_mass::rows(&centre_of_mass::jacobian(self.builder, &self.arm, &frames, &centres))
    }

    fn regressor(&self) -> Outputs<'s> {
        let rows = regressor::regressor(self.builder, &self.arm, &self.states, &self.motions());
        let element = |joint: usize, link: usize, parameter: usize| Name {
            indices: [link + 1, parameter + 1],
            ..Name::scalar(Quantity::RegressorElement, joint + 1)
        };
        rows.iter()
            .enumerate()
            .flat_map(|(joint, row)| row.iter().enumerate().map(move |(link, elements)| (joint, link, elements)))
            .flat_map(|(joint, link, elements)| {
                elements.iter().enumerate().map(move |(parameter, value)| (element(joint, link, parameter), *value))
            })
            .collect()
    }

    fn derivatives(&self) -> Outputs<'s> {
        let torques: Vec<_> = self.loads().into_iter().map(|load| load.torque).collect();
        let dof = torques.len();
        let by = |kind: fn(usize) -> By| {
            let columns = self.builder.derivatives(&torques, (1..=dof).map(kind));
            square(dof, |row, column| {
                let name = Name { by: Some(kind(column + 1)), ..Name::scalar(Quantity::Torque, row + 1) };
                (name, columns[column][row])
            })
        };
        [by(By::Position), by(By::Rate)].concat()
    }

    fn joint_wrenches(&self) -> Outputs<'s> {
        let loads = self.loads().into_iter().enumerate();
        loads
            .flat_map(|(index, Load { wrench, .. })| {
                let parts = [(Quantity::JointForce, wrench.force), (Quantity::JointMoment, wrench.moment)];
                parts.into_iter().flat_map(move |(quantity, vector)| {
                    Axis::ALL.map(|axis| (Name::vector(quantity, index + 1, axis), vector.0[axis as usize]))
                })
            })
            .collect()
    }

    fn actuator_torques(&self) -> Outputs<'s> {
        let torques = actuation::torques(self.builder, self.robot, &self.states).into_iter().enumerate();
        torques.map(|(index, torque)| (Name::scalar(Quantity::ActuatorTorque, index + 1), torque)).collect()
    }
}

/// Elements of an n × n matrix by rows.
pub(crate) fn square<S>(dof: usize, element: impl Fn(usize, usize) -> (Name, S)) -> Vec<(Name, S)> {
    (0..dof)
        .flat_map(|row| (0..dof).map(move |column| (row, column)))
        .map(|(row, column)| element(row, column))
        .collect()
}

/// Rotation by rows, then translation.
fn pose<'s>(joint: usize, frame: &Frame<'s>) -> Outputs<'s> {
    let rotation = Axis::ALL.into_iter().zip(frame.rotation.0).flat_map(|(row, values)| {
        Axis::ALL.map(|column| (Name::matrix(Quantity::FrameRotation, joint, row, column), values.0[column as usize]))
    });
    let translation =
        Axis::ALL.map(|axis| (Name::vector(Quantity::FrameOrigin, joint, axis), frame.origin.0[axis as usize]));
    rotation.chain(translation).collect()
}
