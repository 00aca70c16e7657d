//! Formulas of each function of a robot, written with a builder: the seven steps and the other functions.

pub(crate) mod actuation;
pub(crate) mod adjoint;
pub(crate) mod arm;
pub(crate) mod base;
pub(crate) mod carried;
pub(crate) mod centre_of_mass;
pub(crate) mod centroid;
pub(crate) mod closure;
pub(crate) mod contact;
pub(crate) mod energy;
pub(crate) mod first_moment;
pub(crate) mod floating;
pub(crate) mod floating_step;
pub(crate) mod integrator;
pub(crate) mod joint;
pub(crate) mod kinematics;
pub(crate) mod ldlt;
pub(crate) mod mass_matrix;
pub(crate) mod momentum;
pub(crate) mod payload;
pub(crate) mod regressor;
pub(crate) mod seven_steps;
pub(crate) mod spin;
pub(crate) mod tips;

pub(crate) use arm::{Arm, Body, Link, Mount};
pub(crate) use closure::Closure;
pub(crate) use contact::Contacts;
pub(crate) use floating::{
    base_rotation, floating_derivatives, floating_forward_dynamics, floating_mass_matrix, on_base, pose_of_base,
    sensitivity_of_floating_base,
};
pub(crate) use floating_step::FloatingStep;
pub(crate) use joint::{Joint, JointState, Wrench};
pub(crate) use kinematics::{Frame, Frames};
pub(crate) use payload::{AtTip, Payload};
pub(crate) use seven_steps::{JointLoad, Motion, Turning};
pub(crate) use spin::Spin;
pub(crate) use tips::Tips;

use std::array::from_fn;

use rne_model::{PER_LINK, Robot};

use crate::coordinates::{Coordinates, scaled};
use crate::formulate::ldlt::System;
use crate::formulate::mass_matrix::OfBase;
use crate::function::{Argument, Function, What};
use crate::ir::{Axis, Builder, Cause, Component, Name, Quantity, Ref, Symbol, Vector, WithRespectTo, all_names_of};

/// The results of a function of a robot, by name, in the order of its layout. Zeros of the function are put in before
/// anything is folded.
pub(crate) fn outputs(builder: &Builder, robot: &Robot, function: Function) -> Vec<(Name, Ref)> {
    let derivation = Derivation::new(builder, robot, function);
    let is_floating = function.is_of_floating_base();
    let outputs = match function.what() {
        What::InverseDynamics
        | What::InverseDynamicsFromSinCos
        | What::GravityTorques
        | What::BiasTorques
        | What::CoriolisTorques => derivation.forces(),
        What::MassMatrix if is_floating => {
            floating_mass_matrix(builder, &derivation.system(), &derivation.floating_half())
        }
        What::MassMatrix => mass_matrix(derivation.coordinates(), &derivation.upper_half()),
        What::CoriolisMatrix => derivation.coriolis_matrix(),
        What::ForwardDynamics => derivation.accelerations(),
        What::EulerStep if is_floating => integrator::floating_step(
            builder,
            derivation.coordinates(),
            derivation.arm.gravity,
            &derivation.accelerations(),
        ),
        What::EulerStep => integrator::step(builder, derivation.coordinates(), &derivation.accelerations()),
        What::EulerStepDerivatives if is_floating => derivation.derivatives_of_floating_step(),
        What::ForwardDynamicsDerivatives | What::EulerStepDerivatives => {
            derivation.derivatives_of_accelerations(function)
        }
        What::ForwardKinematics => derivation.tip_pose(),
        What::LinkPoses => derivation.link_poses(),
        What::Jacobian => derivation.jacobian(),
        What::JacobianRateTimesVelocity => derivation.tip_acceleration(),
        What::JacobianRate => derivation.jacobian_rate(),
        What::JacobianDerivatives => derivation.jacobian_derivatives(),
        What::WrenchTorques => derivation.wrench_torques(),
        What::KineticEnergy => derivation.kinetic_energy(),
        What::PotentialEnergy if is_floating => derivation.floating_potential_energy(),
        What::PotentialEnergy => derivation.potential_energy(),
        What::CentreOfMass => derivation.centre_of_mass(),
        What::CentreOfMassJacobian => derivation.centre_of_mass_jacobian(),
        What::Regressor if is_floating => derivation.floating_regressor(),
        What::Regressor => derivation.regressor(),
        What::InverseDynamicsDerivatives if is_floating => {
            floating_derivatives(builder, derivation.coordinates(), derivation.forces())
        }
        What::InverseDynamicsDerivatives => derivatives(builder, derivation.coordinates(), &derivation.tau()),
        What::JointWrenches => derivation.joint_wrenches(),
        What::MomentumAndRate => derivation.momentum_and_rate(),
        What::ActuatorTorques => derivation.actuator_torques(),
        What::CentroidalMomentumMatrix => {
            centroid::momentum_matrix(builder, &derivation.system(), &derivation.of_base().0)
        }
        What::CentroidalBias => derivation.centroidal_bias(),
        What::CentroidalMomentum => derivation.centroidal_momentum(),
        What::TipJacobians => derivation.tip_jacobians(),
        What::TipAccelerations => derivation.tip_accelerations(),
        What::ForwardDynamicsInContact => contact::forward_dynamics(
            builder,
            &derivation.system(),
            &derivation.floating_half(),
            derivation.forces(),
            &Contacts::of(&derivation),
        ),
        What::TorqueGradient => adjoint::gradient(builder, derivation.coordinates(), &derivation.tau()),
        What::TorqueHessian => adjoint::hessian(builder, derivation.coordinates(), &derivation.tau()),
        What::ClosureStep => closure::step(builder, robot),
        What::LoopMap => closure::map(builder, derivation.coordinates()),
        What::LoopMapRateTimesVelocity => closure::bias(builder, derivation.coordinates()),
        What::InverseMassMatrix => inverse_mass_matrix(builder, &derivation.system(), &derivation.upper_half()),
        What::InverseMassMatrixTimesTorques => {
            accelerations(builder, &derivation.system(), &derivation.upper_half(), |applied, _| applied)
        }
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
    /// The accelerations by the torques.
    fn accelerations(&self) -> Outputs<'s> {
        if self.builder.function.is_of_floating_base() {
            return floating_forward_dynamics(self.builder, &self.system(), &self.floating_half(), self.forces());
        }
        forward_dynamics(self.builder, &self.system(), &self.upper_half(), &self.tau())
    }

    /// The derivatives of the accelerations, or of the step that has them.
    fn derivatives_of_accelerations(&self, function: Function) -> Outputs<'s> {
        let (builder, system) = (self.builder, self.system());
        let inverse = adjoint::Inverse::of(builder, &system, &self.upper_half());
        // the same quantities come again, at these accelerations
        inverse.keep_accelerations(builder.unnamed(|| self.tau()));
        builder.hold_accelerations();
        let solved = Self::new(builder, self.robot, function);
        let joints = solved.coordinates().joints();
        let torques = solved.tau();
        inverse.derivatives(&[WithRespectTo::Position, WithRespectTo::Rate].map(|kind: fn(usize) -> _| {
            let columns = builder.derivatives(&torques, joints.iter().map(|joint| kind(joint + 1)));
            (0..joints.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
        }))
    }

    /// The derivatives of a step of a robot with a floating base.
    fn derivatives_of_floating_step(&self) -> Outputs<'s> {
        let (builder, system) = (self.builder, self.system());
        let bias = builder.unnamed(|| self.forces());
        let step = FloatingStep::new(builder, &system, &self.floating_half(), bias, self.arm.gravity);
        builder.hold_accelerations();
        let solved = Self::new(builder, self.robot, Function::FloatingEulerStepDerivatives);
        let forces: Vec<_> = solved.forces().into_iter().map(|(_, force)| force).collect();
        let variables = floating::variables(solved.coordinates()).concat();
        step.derivatives(&builder.derivatives(&forces, variables.into_iter()))
    }

    fn new(builder: &'s Builder, robot: &'r Robot, function: Function) -> Self {
        let arm = Arm::new(builder, robot);
        let joints = robot.joints.len();
        if function.is_of_closed_loops() && function != Function::ClosureStep {
            Closure::keep(builder, robot, function.takes(Argument::Rates));
        }
        let turn_of = |quantity, joint| builder.argument(Name::scalar(quantity, joint + 1));
        let of_joint = |quantity, joint| arm.coordinates.of_joint(builder, quantity, joint);
        let vector = |quantity, joint| vector(builder, quantity, joint);
        let given = |argument, quantity, joint, otherwise| {
            if function.takes(argument) { of_joint(quantity, joint) } else { builder.constant(0.0, otherwise) }
        };
        let state = |joint| JointState {
            q: of_joint(Quantity::Position, joint),
            // the sine of a part of an angle is no function of that of the angle
            turn: (function.takes(Argument::Sines) && arm.coordinates.has(joint))
                .then(|| (turn_of(Quantity::Sine, joint), turn_of(Quantity::Cosine, joint))),
            qd: given(Argument::Rates, Quantity::Rate, joint, Cause::AtRest),
            // closed loops accelerate their dependent joints
            qdd: match arm.coordinates.bias(builder, joint) {
                Some(bias) if !function.takes(Argument::Accelerations) => bias,
                _ if builder.has_accelerations() => of_joint(Quantity::RateDot, joint),
                _ => given(Argument::Accelerations, Quantity::RateDot, joint, Cause::NoAcceleration),
            },
        };
        let states = (0..joints).map(state).collect();
        let tip = if let Some(payload) = Payload::argument(builder, joints) {
            AtTip::Payload(payload)
        } else if function.takes(Argument::Wrench) {
            let [force, moment] = [Quantity::JointForce, Quantity::JointMoment].map(|part| vector(part, joints + 1));
            AtTip::Wrench(Wrench { force, moment })
        } else if function.takes(Argument::Wrenches) {
            let wrench = |tip| {
                let [fx, fy, fz, nx, ny, nz] = all_names_of::<6>("wrenches", tip).map(|name| builder.argument(name));
                Wrench { force: Vector([fx, fy, fz]), moment: Vector([nx, ny, nz]) }
            };
            AtTip::Wrenches((1..=arm.tips.len()).map(wrench).collect())
        } else {
            AtTip::Nothing
        };
        let base = if function.takes(Argument::Base) {
            let motion = [Quantity::Omega, Quantity::OmegaDot, Quantity::Acceleration];
            Motion::of_base(&arm, motion.map(|quantity| vector(quantity, 0)), vector(Quantity::Gravity, 0))
        } else if function.takes(Argument::BaseTwist) && !function.takes(Argument::Step) {
            Motion::of_twist(&arm, [Quantity::OriginVelocity, Quantity::Omega].map(|quantity| vector(quantity, 0)))
        } else if function.takes(Argument::BaseVelocity) || function.takes(Argument::BaseTwist) {
            // accelerations do not depend on the linear velocity
            let nothing = builder.zeros(Cause::NoAcceleration);
            let [omega_dot, acceleration] = [Quantity::OmegaDot, Quantity::Acceleration]
                .map(|quantity| builder.solved_of_base(quantity).unwrap_or(nothing));
            let of_base = || Motion::of_base(&arm, [vector(Quantity::Omega, 0), omega_dot, acceleration], nothing);
            // the same quantities come again, at the accelerations that are solved for
            let is_first = function == Function::FloatingEulerStepDerivatives && !builder.has_accelerations();
            if is_first { builder.unnamed(of_base) } else { of_base() }
        } else if function.is_of_floating_base() && function.what() == What::GravityTorques {
            let still = builder.zeros(Cause::FixedBase);
            let gravity = base_rotation(builder).transpose() * builder.unnamed(|| arm::gravity(builder, robot));
            Motion::of_base(&arm, [still; 3], gravity)
        } else {
            let is_weightless = function.what() == What::CoriolisTorques;
            Motion::of_fixed_base(builder, if is_weightless { builder.zeros(Cause::NoGravity) } else { arm.gravity })
        };
        Self { builder, robot, arm, states, base, tip }
    }

    fn loads(&self) -> Vec<JointLoad<'s>> {
        seven_steps::inverse_dynamics(&self.arm, &self.states, &self.base, &self.tip)
    }

    fn motions(&self) -> Vec<Motion<'s>> {
        seven_steps::forward(&self.arm, &self.states, &self.base)
    }

    /// The torques of the seven steps.
    fn tau(&self) -> Vec<Symbol<'s>> {
        let of_joints: Vec<_> = self.loads().into_iter().map(|load| load.torque).collect();
        self.coordinates().torques(&of_joints)
    }

    const fn coordinates(&self) -> &Coordinates {
        &self.arm.coordinates
    }

    /// One number for each coordinate, from one for each joint.
    fn gathered(&self, quantity: Quantity, of_joints: &[Symbol<'s>]) -> Outputs<'s> {
        by_joint(self.coordinates(), quantity, self.coordinates().torques(of_joints))
    }

    /// Vectors of the joints, one for each coordinate.
    fn columns(&self, of_joints: &[Vector<'s>]) -> Vec<Vector<'s>> {
        let times = |column: Vector<'s>, ratio| column.map(|_, x| scaled(x, ratio));
        self.coordinates().gathered(of_joints, |a, b| a + b, times)
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

    /// The torques, behind the wrench on a floating base.
    fn forces(&self) -> Outputs<'s> {
        if self.builder.function.is_of_floating_base() {
            return self.floating_torques();
        }
        by_joint(self.coordinates(), Quantity::Torque, self.tau())
    }

    /// The coordinates and links of a mass matrix that is solved by.
    fn system(&self) -> System<'_> {
        System::new(self.builder.function, self.coordinates(), self.arm.links.iter().map(|link| link.parent))
    }

    /// The upper half of M with the rows of a floating base.
    fn floating_half(&self) -> Vec<Vec<Symbol<'s>>> {
        let (of_base, joints) = self.of_base();
        of_base.above(self.builder, self.coordinates().upper_half(self.builder, joints))
    }

    /// The rows of the base in M, and the upper half of that of the joints.
    fn of_base(&self) -> (OfBase<'s>, Vec<Vec<Symbol<'s>>>) {
        let (of_base, joints) = mass_matrix::with_base(&self.arm, &self.states, &self.system(), self.matter_at_tip());
        (of_base.gathered(self.coordinates()), joints)
    }

    /// The upper half of M.
    fn upper_half(&self) -> Vec<Vec<Symbol<'s>>> {
        let of_joints = mass_matrix::upper_half(&self.arm, &self.states, self.matter_at_tip());
        self.coordinates().upper_half(self.builder, of_joints)
    }

    /// The load that changes the mass matrix: no force does.
    const fn matter_at_tip(&self) -> &AtTip<'s> {
        if let AtTip::Payload(_) = self.tip { &self.tip } else { &AtTip::Nothing }
    }

    fn coriolis_matrix(&self) -> Outputs<'s> {
        let torques = self.tau();
        coriolis_matrix(
            self.builder,
            self.coordinates(),
            &torques,
            self.builder.entry(Name::scalar(Quantity::Half, 0), 0.5),
        )
    }

    fn tip_pose(&self) -> Outputs<'s> {
        pose(self.states.len() + 1, &self.frames().tip)
    }

    fn link_poses(&self) -> Outputs<'s> {
        let frames = self.frames().links;
        self.coordinates().joints().iter().flat_map(|&joint| pose(joint + 1, &frames[joint])).collect()
    }

    fn jacobian(&self) -> Outputs<'s> {
        let columns = kinematics::jacobian(&self.arm, &self.frames());
        self.spatial_rows([Quantity::JacobianLinear, Quantity::JacobianAngular], &columns)
    }

    fn jacobian_rate(&self) -> Outputs<'s> {
        let columns = kinematics::jacobian_rate(&self.arm, &self.states, &self.frames());
        self.spatial_rows([Quantity::JacobianLinearRate, Quantity::JacobianAngularRate], &columns)
    }

    /// Three linear rows, then three angular ones, of columns of the joints.
    fn spatial_rows(&self, quantities: [Quantity; 2], columns: &[[Vector<'s>; 2]]) -> Outputs<'s> {
        let rows = |half: usize| {
            let of_joints: Vec<_> = columns.iter().map(|column| column[half]).collect();
            by_row(self.coordinates(), quantities[half], &self.columns(&of_joints))
        };
        [rows(0), rows(1)].concat()
    }

    fn jacobian_derivatives(&self) -> Outputs<'s> {
        let found = kinematics::jacobian_derivatives(&self.arm, &self.frames());
        let joints = self.coordinates().joints();
        let mut outputs = Vec::new();
        for (row, quantity) in [Quantity::JacobianLinear, Quantity::JacobianAngular].iter().enumerate() {
            for axis in Axis::ALL {
                let elements: Vec<Vec<_>> = found
                    .iter()
                    .map(|column| column.iter().map(|parts: &[Vector<'s>; 2]| parts[row].0[axis as usize]).collect())
                    .collect();
                let matrix = self.coordinates().matrix(&elements);
                outputs.extend(square(joints.len(), |column, position| {
                    let by = Some(WithRespectTo::Position(joints[position] + 1));
                    let name = Name { by, ..Name::vector(*quantity, joints[column] + 1, axis) };
                    self.coordinates().named(name, matrix[column][position])
                }));
            }
        }
        outputs
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
            AtTip::Nothing | AtTip::Wrenches(_) | AtTip::Payload(_) => Vec::new(),
        };
        self.gathered(Quantity::Torque, &torques)
    }

    fn kinetic_energy(&self) -> Outputs<'s> {
        let base = self.builder.function.is_of_floating_base().then_some(&self.base);
        let energy = energy::kinetic(&self.arm, &self.states, (base, &self.motions()));
        vec![(Name::scalar(Quantity::Kinetic, 0), energy)]
    }

    fn potential_energy(&self) -> Outputs<'s> {
        let energy = energy::potential(&self.arm, &self.frames_in_frame_0(), &self.centres());
        vec![(Name::scalar(Quantity::Potential, 0), energy)]
    }

    fn floating_potential_energy(&self) -> Outputs<'s> {
        let pose = pose_of_base(self.builder);
        let energy = energy::floating_potential(&self.arm, &pose, &self.frames_in_frame_0(), &self.centres());
        vec![(Name::scalar(Quantity::Potential, 0), energy)]
    }

    fn frames_in_frame_0(&self) -> Frames<'s> {
        let frame_0 = Frame { rotation: arm::identity(self.builder), origin: self.builder.zeros(Cause::FirstFrame) };
        kinematics::frames(&self.arm, &self.states, frame_0)
    }

    fn centroidal_momentum(&self) -> Outputs<'s> {
        momentum::centroidal_momentum(&self.arm, &self.states, &self.motions(), &self.base)
    }

    fn centre_of_mass(&self) -> Outputs<'s> {
        let centre = centre_of_mass::position(&self.arm, &self.frames_from_base(), &self.centres());
        components(Name::scalar(Quantity::ComPosition, 0), centre).into()
    }

    fn centre_of_mass_jacobian(&self) -> Outputs<'s> {
        let columns = centre_of_mass::jacobian(&self.arm, &self.frames_from_base(), &self.centres());
        by_row(self.coordinates(), Quantity::JacobianLinear, &self.columns(&columns))
    }

    fn regressor(&self) -> Outputs<'s> {
        let of_joints = regressor::regressor(&self.arm, &self.states, &self.motions());
        let rows = self.coordinates().gathered(
            &of_joints,
            |sum, row| sum.iter().zip(row).map(|(a, b)| from_fn(|parameter| a[parameter] + b[parameter])).collect(),
            |row, ratio| row.into_iter().map(|elements| elements.map(|element| scaled(element, ratio))).collect(),
        );
        let mut outputs = Vec::new();
        for (&joint, row) in self.coordinates().joints().iter().zip(&rows) {
            for (link, elements) in row.iter().enumerate() {
                let elements = elements.iter().enumerate();
                outputs.extend(elements.map(|(i, element)| (regressor::element_name(joint, link, i), *element)));
            }
        }
        outputs
    }

    /// The regressor of a robot without couplings: it has numbers of every link, so it is compiled for no other robot.
    fn floating_regressor(&self) -> Outputs<'s> {
        let acceleration = vector(self.builder, Quantity::Acceleration, 0) - vector(self.builder, Quantity::Gravity, 0);
        let acceleration = self.builder.name_vector(Quantity::OriginAcceleration, 0, acceleration);
        let base = (&self.base, acceleration);
        let rows = regressor::floating_regressor(&self.arm, &self.states, &self.motions(), base);
        let of_body = |row, body, elements: [Symbol<'s>; PER_LINK]| {
            let elements = elements.into_iter().enumerate();
            elements.map(move |(i, element)| (regressor::name_of_floating(row, body, i), element))
        };
        let of_row = |(row, bodies): (usize, Vec<_>)| {
            bodies.into_iter().enumerate().flat_map(move |(body, elements)| of_body(row, body, elements))
        };
        rows.into_iter().enumerate().flat_map(of_row).collect()
    }

    fn joint_wrenches(&self) -> Outputs<'s> {
        let wrenches = self.loads().into_iter().enumerate();
        let named = wrenches.filter(|(index, _)| self.coordinates().has(*index)).flat_map(
            |(index, JointLoad { wrench: Wrench { force, moment }, .. })| {
                let parent = self.robot.parent(index).map_or(0, |parent| parent + 1);
                let parts = [(Quantity::JointForce, force), (Quantity::JointMoment, moment)];
                parts.into_iter().flat_map(move |(part, vector)| {
                    components(Name::indexed(part, index + 1, Name::index_of_parent(index + 1, parent)), vector)
                })
            },
        );
        named.collect()
    }

    fn floating_torques(&self) -> Outputs<'s> {
        let (base, loads) =
            seven_steps::inverse_dynamics_of_floating_base(&self.arm, &self.states, &self.base, &self.tip);
        let torques: Vec<_> = loads.into_iter().map(|load| load.torque).collect();
        let mut outputs = base.map_or_else(Vec::new, |base| on_base([base.force, base.moment]));
        outputs.extend(self.gathered(Quantity::Torque, &torques));
        outputs
    }

    fn centroidal_bias(&self) -> Outputs<'s> {
        let (base, _) = seven_steps::inverse_dynamics_of_floating_base(&self.arm, &self.states, &self.base, &self.tip);
        let wrench = base.map_or([self.builder.no_vector(); 2], |base| [base.force, base.moment]);
        let of_base = self.of_base().0;
        centroid::about_centre(self.builder, (of_base.mass, of_base.h), Quantity::BaseForce, wrench)
    }

    /// The frames and tips in world axes, with their origins from that of the base.
    fn tips_in_world(&self) -> Tips<'s> {
        Tips::of(&self.arm, &self.states, base_rotation(self.builder))
    }

    fn tip_jacobians(&self) -> Outputs<'s> {
        self.tips_in_world().jacobians(&self.arm, self.coordinates())
    }

    fn tip_accelerations(&self) -> Outputs<'s> {
        let accelerations = self.tips_in_world().accelerations(&self.arm, &self.states, &self.base.turning);
        let tips = accelerations.into_iter().flatten().enumerate().map(|(part, vector)| {
            let tip = Name::scalar(Quantity::TipAcceleration, self.states.len() + 1 + part / 2);
            components(Name { indices: [part % 2, 0], ..tip }, vector)
        });
        tips.flatten().collect()
    }

    fn momentum_and_rate(&self) -> Outputs<'s> {
        let [momenta, rates] =
            momentum::momentum_and_rate(&self.arm, &self.states, &self.motions(), &self.base, &self.tip);
        [self.gathered(Quantity::Momentum, &momenta), self.gathered(Quantity::MomentumRate, &rates)].concat()
    }

    fn actuator_torques(&self) -> Outputs<'s> {
        self.gathered(Quantity::ActuatorTorque, &actuation::torques(self.builder, self.robot, &self.states))
    }
}

/// An argument that is a vector.
fn vector(builder: &Builder, quantity: Quantity, joint: usize) -> Vector<'_> {
    Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, joint, axis))))
}

/// M by its upper half: row i of `upper` holds the elements (i, i) to (i, n).
pub(crate) fn mass_matrix<'s>(coordinates: &Coordinates, upper: &[Vec<Symbol<'s>>]) -> Outputs<'s> {
    let joints = coordinates.joints();
    square(upper.len(), |row, column| {
        let (row, column) = (row.min(column), row.max(column));
        coordinates.named(torque_by(joints[row], WithRespectTo::RateDot(joints[column] + 1)), upper[row][column - row])
    })
}

/// ½ ∂(bias torques)/∂q̇
pub(crate) fn coriolis_matrix<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    torques: &[Symbol<'s>],
    half: Symbol<'s>,
) -> Outputs<'s> {
    let joints = coordinates.joints();
    let columns = builder.derivatives(torques, joints.iter().map(|joint| WithRespectTo::Rate(joint + 1)));
    square(torques.len(), |row, column| {
        let name = Name::indexed(Quantity::CoriolisElement, joints[row] + 1, joints[column] + 1);
        let line = builder.joint(joints[row] + 1);
        (name, builder.name(name, line.within(Quantity::CoriolisElement, || columns[column][row] * half)))
    })
}

/// M⁻¹ (τ - bias)
pub(crate) fn forward_dynamics<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    bias: &[Symbol<'s>],
) -> Outputs<'s> {
    accelerations(builder, system, upper, |applied, place| applied - bias[place])
}

/// M⁻¹ times what is left of the torques at each place.
pub(crate) fn accelerations<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    left: impl Fn(Symbol<'s>, usize) -> Symbol<'s>,
) -> Outputs<'s> {
    let rest = |(place, &joint): (usize, &usize)| {
        let applied = system.coordinates.applied(builder, joint);
        builder.joint(joint + 1).within(Quantity::Reduced, || left(applied, place))
    };
    let rest: Vec<_> = system.coordinates.joints().iter().enumerate().map(rest).collect();
    by_joint(system.coordinates, Quantity::RateDot, ldlt::solved(builder, system, upper, &rest))
}

/// ∂τ/∂q, then ∂τ/∂q̇
pub(crate) fn derivatives<'s>(builder: &'s Builder, coordinates: &Coordinates, torques: &[Symbol<'s>]) -> Outputs<'s> {
    let joints = coordinates.joints();
    let by = |kind: fn(usize) -> WithRespectTo| {
        let columns = builder.derivatives(torques, joints.iter().map(|joint| kind(joint + 1)));
        square(torques.len(), |row, column| {
            coordinates.named(torque_by(joints[row], kind(joints[column] + 1)), columns[column][row])
        })
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
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
) -> Outputs<'s> {
    inverse_by(builder, system, &ldlt::Factors::of(builder, system, upper), Quantity::RateDot)
}

/// The inverse by the factors of the matrix; its elements are of the quantity `element`.
fn inverse_by<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    factors: &ldlt::Factors<'s>,
    element: Quantity,
) -> Outputs<'s> {
    let joints = system.coordinates.joints();
    let dof = joints.len();
    let (zero, one) = (builder.constant(0.0, Cause::Arithmetic), builder.constant(1.0, Cause::Arithmetic));
    let name = |quantity, row: usize, column: usize| {
        let quantity = if quantity == Quantity::RateDot { element } else { quantity };
        Name::indexed(quantity, joints[row] + 1, joints[column] + 1)
    };
    let columns: Vec<Vec<Option<Symbol<'s>>>> = (0..dof)
        .map(|column| {
            let unit: Vec<_> = (0..dof).map(|row| if row == column { one } else { zero }).collect();
            factors.solved(factors.place(column), &unit, |quantity, row| name(quantity, row, column))
        })
        .collect();
    square(dof, |row, column| {
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

/// One result for each coordinate.
pub(crate) fn by_joint<'s>(coordinates: &Coordinates, quantity: Quantity, numbers: Vec<Symbol<'s>>) -> Outputs<'s> {
    let numbers = coordinates.joints().iter().zip(numbers);
    numbers.map(|(joint, number)| coordinates.named(Name::scalar(quantity, joint + 1), number)).collect()
}

/// The components of the vector with this name.
fn components(name: Name, vector: Vector<'_>) -> [(Name, Symbol<'_>); 3] {
    Axis::ALL.map(|axis| (Name { component: Component::Vector(axis), ..name }, vector.0[axis as usize]))
}

/// Vectors of the coordinates as the columns of a matrix, by rows.
fn by_row<'s>(coordinates: &Coordinates, quantity: Quantity, columns: &[Vector<'s>]) -> Outputs<'s> {
    let row = |axis: Axis| {
        let columns = coordinates.joints().iter().zip(columns);
        columns.map(move |(joint, column)| {
            coordinates.named(Name::vector(quantity, joint + 1, axis), column.0[axis as usize])
        })
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
