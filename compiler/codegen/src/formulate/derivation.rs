//! The derivation of a function of a robot: the arm, the arguments, and the results, which the recursions give.

use std::array::from_fn;

use rne_model::{PER_LINK, Robot};

use crate::coordinates::{Coordinates, scaled};
use crate::formulate::arguments::{self, vector};
use crate::formulate::floating::tips::Tips;
use crate::formulate::floating::{self, centroid, contact};
use crate::formulate::layout::{by_row, components, pose};
use crate::formulate::ldlt::System;
use crate::formulate::mass_matrix::OfBase;
use crate::formulate::{
    Arm, AtTip, Closure, Contacts, FloatingStep, Frame, Frames, JointLoad, JointState, Motion, Outputs, Wrench,
    actuation, adjoint, arm, base_rotation, by_joint, centre_of_mass, coriolis_matrix, derivatives,
    floating_derivatives, floating_forward_dynamics, floating_mass_matrix, forward_dynamics, integrator, kinematics,
    mass_matrix, momentum, on_base, regressor, seven_steps, square,
};
use crate::function::Argument;
use crate::ir::{Axis, Builder, Cause, Name, Quantity, Symbol, Vector, WithRespectTo};

/// The state of one derivation: the robot's constants, the arguments and the builder.
pub(super) struct Derivation<'s, 'r> {
    pub(super) builder: &'s Builder,
    pub(super) robot: &'r Robot,
    pub(super) arm: Arm<'s>,
    pub(super) states: Vec<JointState<'s>>,
    pub(super) base: Motion<'s>,
    pub(super) tip: AtTip<'s>,
}

impl<'s, 'r> Derivation<'s, 'r> {
    pub(super) fn is_floating(&self) -> bool {
        self.builder.function.is_of_floating_base()
    }

    pub(super) fn mass_matrix(&self) -> Outputs<'s> {
        if self.is_floating() {
            return floating_mass_matrix(self.builder, &self.system(), &self.floating_half());
        }
        mass_matrix(self.coordinates(), &self.upper_half())
    }

    /// Returns the derivatives of the torques.
    pub(super) fn derivatives(&self) -> Outputs<'s> {
        if self.is_floating() {
            return floating_derivatives(self.builder, self.coordinates(), self.forces());
        }
        derivatives(self.builder, self.coordinates(), &self.tau())
    }

    /// Returns the state after a step of the integrator.
    pub(super) fn step(&self) -> Outputs<'s> {
        let accelerations = self.accelerations();
        if self.is_floating() {
            return integrator::floating_step(self.builder, self.coordinates(), self.arm.gravity, &accelerations);
        }
        integrator::step(self.builder, self.coordinates(), &accelerations)
    }

    pub(super) fn accelerations_in_contact(&self) -> Outputs<'s> {
        let (system, half) = (self.system(), self.floating_half());
        contact::forward_dynamics(self.builder, &system, &half, self.forces(), &Contacts::of(self))
    }

    /// Returns the accelerations that follow from the torques.
    pub(super) fn accelerations(&self) -> Outputs<'s> {
        if self.is_floating() {
            return floating_forward_dynamics(self.builder, &self.system(), &self.floating_half(), self.forces());
        }
        forward_dynamics(self.builder, &self.system(), &self.upper_half(), &self.tau())
    }

    /// Returns the derivatives of the accelerations, or those of the Euler step that uses these accelerations.
    pub(super) fn derivatives_of_accelerations(&self) -> Outputs<'s> {
        let (builder, system) = (self.builder, self.system());
        let inverse = adjoint::Inverse::of(builder, &system, &self.upper_half());
        // the torques at zero acceleration are not named: they are written again below with the solved accelerations
        inverse.keep_accelerations(builder.unnamed(|| self.tau()));
        builder.hold_accelerations();
        let solved = Self::new(builder, self.robot);
        let joints = solved.coordinates().joints();
        let torques = solved.tau();
        inverse.derivatives(&[WithRespectTo::Position, WithRespectTo::Rate].map(|kind: fn(usize) -> _| {
            let columns = builder.derivatives(&torques, joints.iter().map(|joint| kind(joint + 1)));
            (0..joints.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
        }))
    }

    /// Returns the derivatives of a step of the integrator.
    pub(super) fn derivatives_of_step(&self) -> Outputs<'s> {
        if !self.is_floating() {
            return self.derivatives_of_accelerations();
        }
        let (builder, system) = (self.builder, self.system());
        let bias = builder.unnamed(|| self.forces());
        let step = FloatingStep::new(builder, &system, &self.floating_half(), bias, self.arm.gravity);
        builder.hold_accelerations();
        let solved = Self::new(builder, self.robot);
        let forces: Vec<_> = solved.forces().into_iter().map(|(_, force)| force).collect();
        let variables = floating::variables(solved.coordinates()).concat();
        step.derivatives(&builder.derivatives(&forces, variables.into_iter()))
    }

    pub(super) fn new(builder: &'s Builder, robot: &'r Robot) -> Self {
        let (arm, function) = (Arm::new(builder, robot), builder.function);
        if function.is_of_closed_loops() && !function.closes_loops() {
            Closure::keep(builder, robot, function.takes(Argument::Rates));
        }
        let (states, tip, base) = (arguments::states(&arm), arguments::tip(&arm), arguments::base(&arm, robot));
        Self { builder, robot, arm, states, base, tip }
    }

    pub(super) fn loads(&self) -> Vec<JointLoad<'s>> {
        seven_steps::inverse_dynamics(&self.arm, &self.states, &self.base, &self.tip)
    }

    pub(super) fn motions(&self) -> Vec<Motion<'s>> {
        seven_steps::forward(&self.arm, &self.states, &self.base)
    }

    /// Returns the joint torques of the seven steps, one for each coordinate.
    pub(super) fn tau(&self) -> Vec<Symbol<'s>> {
        let of_joints: Vec<_> = self.loads().into_iter().map(|load| load.torque).collect();
        self.coordinates().torques(&of_joints)
    }

    pub(super) const fn coordinates(&self) -> &Coordinates {
        &self.arm.coordinates
    }

    /// Returns one result for each coordinate, from one number for each joint.
    pub(super) fn gathered(&self, quantity: Quantity, of_joints: &[Symbol<'s>]) -> Outputs<'s> {
        by_joint(self.coordinates(), quantity, self.coordinates().torques(of_joints))
    }

    /// Returns one vector for each coordinate, from one vector for each joint.
    pub(super) fn columns(&self, of_joints: &[Vector<'s>]) -> Vec<Vector<'s>> {
        let times = |column: Vector<'s>, ratio| column.map(|_, x| scaled(x, ratio));
        self.coordinates().gathered(of_joints, |a, b| a + b, times)
    }

    /// Returns the vector from each joint to the centre of mass of its link, in the axes of the link.
    pub(super) fn centres(&self) -> Vec<Vector<'s>> {
        self.motions().iter().map(|motion| motion.d).collect()
    }

    pub(super) fn frames(&self) -> Frames<'s> {
        kinematics::frames(&self.arm, &self.states, kinematics::base(&self.arm))
    }

    /// Returns the frames in world axes, with origins measured from the base: results that depend only on differences
    /// of origins do not depend on the position of the base.
    pub(super) fn frames_from_base(&self) -> Frames<'s> {
        let start = Frame { origin: self.builder.zeros(Cause::FirstFrame), ..kinematics::base(&self.arm) };
        kinematics::frames(&self.arm, &self.states, start)
    }

    /// Returns the torques; for a floating base, the wrench on the base before them.
    pub(super) fn forces(&self) -> Outputs<'s> {
        if self.builder.function.is_of_floating_base() {
            return self.floating_torques();
        }
        by_joint(self.coordinates(), Quantity::Torque, self.tau())
    }

    /// Returns the coordinates and parent links of the mass matrix, as the L D Lᵀ solver needs them.
    pub(super) fn system(&self) -> System<'_> {
        System::new(self.builder.function, self.coordinates(), self.arm.links.iter().map(|link| link.parent))
    }

    /// Returns the upper half of M, including the rows of the floating base.
    pub(super) fn floating_half(&self) -> Vec<Vec<Symbol<'s>>> {
        let (of_base, joints) = self.of_base();
        of_base.above(self.builder, self.coordinates().upper_half(self.builder, joints))
    }

    /// Returns the rows of the base in M, and the upper half of the joint block.
    pub(super) fn of_base(&self) -> (OfBase<'s>, Vec<Vec<Symbol<'s>>>) {
        let (of_base, joints) = mass_matrix::with_base(&self.arm, &self.states, &self.system(), self.matter_at_tip());
        (of_base.gathered(self.coordinates()), joints)
    }

    /// Returns the upper half of M.
    pub(super) fn upper_half(&self) -> Vec<Vec<Symbol<'s>>> {
        let of_joints = mass_matrix::upper_half(&self.arm, &self.states, self.matter_at_tip());
        self.coordinates().upper_half(self.builder, of_joints)
    }

    /// Returns the load at the tip if it is a payload, which changes the mass matrix; a force does not.
    const fn matter_at_tip(&self) -> &AtTip<'s> {
        if let AtTip::Payload(_) = self.tip { &self.tip } else { &AtTip::Nothing }
    }

    pub(super) fn coriolis_matrix(&self) -> Outputs<'s> {
        let torques = self.tau();
        coriolis_matrix(
            self.builder,
            self.coordinates(),
            &torques,
            self.builder.entry(Name::scalar(Quantity::Half, 0), 0.5),
        )
    }

    pub(super) fn tip_pose(&self) -> Outputs<'s> {
        pose(self.states.len() + 1, &self.frames().tip)
    }

    pub(super) fn link_poses(&self) -> Outputs<'s> {
        let frames = self.frames().links;
        self.coordinates().joints().iter().flat_map(|&joint| pose(joint + 1, &frames[joint])).collect()
    }

    pub(super) fn jacobian(&self) -> Outputs<'s> {
        let columns = kinematics::jacobian(&self.arm, &self.frames());
        self.spatial_rows([Quantity::JacobianLinear, Quantity::JacobianAngular], &columns)
    }

    pub(super) fn jacobian_rate(&self) -> Outputs<'s> {
        let columns = kinematics::jacobian_rate(&self.arm, &self.states, &self.frames());
        self.spatial_rows([Quantity::JacobianLinearRate, Quantity::JacobianAngularRate], &columns)
    }

    /// Returns three linear rows, then three angular rows, from the columns of the joints.
    pub(super) fn spatial_rows(&self, quantities: [Quantity; 2], columns: &[[Vector<'s>; 2]]) -> Outputs<'s> {
        let rows = |half: usize| {
            let of_joints: Vec<_> = columns.iter().map(|column| column[half]).collect();
            by_row(self.coordinates(), quantities[half], &self.columns(&of_joints))
        };
        [rows(0), rows(1)].concat()
    }

    pub(super) fn jacobian_derivatives(&self) -> Outputs<'s> {
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

    pub(super) fn tip_acceleration(&self) -> Outputs<'s> {
        let parts = kinematics::tip_acceleration(&self.arm, &self.states, &self.base);
        let parts = parts.into_iter().enumerate();
        let tip = Name::scalar(Quantity::TipAcceleration, self.states.len() + 1);
        parts.flat_map(|(part, vector)| components(Name { indices: [part, 0], ..tip }, vector)).collect()
    }

    pub(super) fn wrench_torques(&self) -> Outputs<'s> {
        let torques = match &self.tip {
            AtTip::Wrench(wrench) => kinematics::wrench_torques(&self.arm, &self.frames(), wrench),
            AtTip::Nothing | AtTip::Wrenches(_) | AtTip::Payload(_) => Vec::new(),
        };
        self.gathered(Quantity::Torque, &torques)
    }

    pub(super) fn frames_in_frame_0(&self) -> Frames<'s> {
        let frame_0 = Frame { rotation: arm::identity(self.builder), origin: self.builder.zeros(Cause::FirstFrame) };
        kinematics::frames(&self.arm, &self.states, frame_0)
    }

    pub(super) fn centroidal_momentum(&self) -> Outputs<'s> {
        momentum::centroidal_momentum(&self.arm, &self.states, &self.motions(), &self.base)
    }

    pub(super) fn centre_of_mass(&self) -> Outputs<'s> {
        let centre = centre_of_mass::position(&self.arm, &self.frames_from_base(), &self.centres());
        components(Name::scalar(Quantity::ComPosition, 0), centre).into()
    }

    pub(super) fn centre_of_mass_jacobian(&self) -> Outputs<'s> {
        let columns = centre_of_mass::jacobian(&self.arm, &self.frames_from_base(), &self.centres());
        by_row(self.coordinates(), Quantity::JacobianLinear, &self.columns(&columns))
    }

    pub(super) fn regressor(&self) -> Outputs<'s> {
        if self.is_floating() {
            return self.floating_regressor();
        }
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

    /// Returns the regressor of a robot without couplings. It is written for the inertial parameters of each link, so
    /// code for it is compiled for this robot only.
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

    pub(super) fn joint_wrenches(&self) -> Outputs<'s> {
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

    pub(super) fn floating_torques(&self) -> Outputs<'s> {
        let (base, loads) =
            seven_steps::inverse_dynamics_of_floating_base(&self.arm, &self.states, &self.base, &self.tip);
        let torques: Vec<_> = loads.into_iter().map(|load| load.torque).collect();
        let mut outputs = base.map_or_else(Vec::new, |base| on_base([base.force, base.moment]));
        outputs.extend(self.gathered(Quantity::Torque, &torques));
        outputs
    }

    pub(super) fn centroidal_momentum_matrix(&self) -> Outputs<'s> {
        centroid::momentum_matrix(self.builder, &self.system(), &self.of_base().0)
    }

    pub(super) fn centroidal_bias(&self) -> Outputs<'s> {
        let (base, _) = seven_steps::inverse_dynamics_of_floating_base(&self.arm, &self.states, &self.base, &self.tip);
        let wrench = base.map_or([self.builder.no_vector(); 2], |base| [base.force, base.moment]);
        let of_base = self.of_base().0;
        centroid::about_centre(self.builder, (of_base.mass, of_base.h), Quantity::BaseForce, wrench)
    }

    /// Returns the frames and tips in world axes, with their origins measured from that of the base.
    pub(super) fn tips_in_world(&self) -> Tips<'s> {
        Tips::of(&self.arm, &self.states, base_rotation(self.builder))
    }

    pub(super) fn tip_jacobians(&self) -> Outputs<'s> {
        self.tips_in_world().jacobians(&self.arm, self.coordinates())
    }

    pub(super) fn tip_accelerations(&self) -> Outputs<'s> {
        let accelerations = self.tips_in_world().accelerations(&self.arm, &self.states, &self.base.turning);
        let tips = accelerations.into_iter().flatten().enumerate().map(|(part, vector)| {
            let tip = Name::scalar(Quantity::TipAcceleration, self.states.len() + 1 + part / 2);
            components(Name { indices: [part % 2, 0], ..tip }, vector)
        });
        tips.flatten().collect()
    }

    pub(super) fn momentum_and_rate(&self) -> Outputs<'s> {
        let [momenta, rates] =
            momentum::momentum_and_rate(&self.arm, &self.states, &self.motions(), &self.base, &self.tip);
        [self.gathered(Quantity::Momentum, &momenta), self.gathered(Quantity::MomentumRate, &rates)].concat()
    }

    pub(super) fn actuator_torques(&self) -> Outputs<'s> {
        self.gathered(Quantity::ActuatorTorque, &actuation::torques(self.builder, self.robot, &self.states))
    }
}
