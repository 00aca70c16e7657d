//! The results of each function in the reduced form, computed from the recursions of [`crate::reduced`].

use rne_model::Robot;

use crate::coordinates::Coordinates;
use crate::formulate::arm::gravity;
use crate::formulate::floating::{centroid, contact};
use crate::formulate::ldlt::System;
use crate::formulate::mass_matrix::OfBase;
use crate::formulate::{self, Closure, Contacts, FloatingStep, Outputs, adjoint, integrator, square, torque_by};
use crate::function::{Argument, What};
use crate::ir::{Builder, Name, Number, Quantity, Symbol, Vector, WithRespectTo};
use crate::reduced::backward::{torques, torques_of_floating_base};
use crate::reduced::forward::motions;
use crate::reduced::rnea_derivatives::{Sensitivity, sensitivity};
use crate::reduced::{Algorithm, Arm, JointFrames, Wrench, aba, crba, hessian, momentum};

/// Writes the builder's function and returns its results by name, in the order of its layout; `None` if the function
/// has no reduced recursion.
pub(crate) fn write<'s>(arm: Arm<'_, 's>, robot: &Robot, algorithm: Algorithm) -> Option<Outputs<'s>> {
    let function = arm.builder.function;
    if function.is_of_closed_loops() {
        Closure::keep(arm.builder, robot, function.takes(Argument::Rates));
    }
    let results = Results { arm, robot, algorithm };
    if function.is_of_floating_base() { results.of_floating_base() } else { results.of_joints() }
}

/// Computes the results of a function by one algorithm.
#[derive(Clone, Copy)]
struct Results<'a, 's> {
    arm: Arm<'a, 's>,
    robot: &'a Robot,
    algorithm: Algorithm,
}

impl<'a, 's> Results<'a, 's> {
    /// Returns the results for a base that does not move or whose motion is an argument.
    fn of_joints(&self) -> Option<Outputs<'s>> {
        let (builder, coordinates) = (self.builder(), self.coordinates());
        Some(match (builder.function.what(), self.algorithm) {
            (What::GravityTorques, Algorithm::Crba(_)) => {
                self.by_joint(Quantity::Torque, &crba::gravity_torques(&self.arm))
            }
            (What::CoriolisTorques, _) => {
                let weightless = self.arm.joint_frames.without_gravity();
                self.by_joint(Quantity::Torque, &self.with(&weightless).recursion())
            }
            (What::InverseDynamics | What::InverseDynamicsFromSinCos | What::GravityTorques | What::BiasTorques, _) => {
                self.by_joint(Quantity::Torque, &self.recursion())
            }
            (What::MomentumAndRate, _) => {
                let [momenta, rates] = momentum::momentum_and_rate(&self.arm);
                [self.by_joint(Quantity::Momentum, &momenta), self.by_joint(Quantity::MomentumRate, &rates)].concat()
            }
            (What::MassMatrix, _) => formulate::mass_matrix(coordinates, &self.upper_half()),
            (What::InverseMassMatrix, _) => formulate::inverse_mass_matrix(builder, &self.system(), &self.upper_half()),
            (What::InverseMassMatrixTimesTorques, Algorithm::Aba(_)) => {
                let weightless = self.arm.joint_frames.without_gravity();
                self.by_joint(Quantity::RateDot, &aba::forward_dynamics(&self.with(&weightless).arm).1)
            }
            (What::InverseMassMatrixTimesTorques, _) => {
                formulate::accelerations(builder, &self.system(), &self.upper_half(), |applied, _| applied)
            }
            (What::ForwardDynamics, _) => self.accelerations()?,
            (What::EulerStep, _) => integrator::step(builder, coordinates, &self.accelerations()?),
            (What::InverseDynamicsDerivatives, Algorithm::Crba(_)) => self.derivatives(),
            (What::InverseDynamicsDerivatives, _) => formulate::derivatives(builder, coordinates, &self.tau()),
            (What::CoriolisMatrix, Algorithm::Crba(_)) => {
                let found = coordinates.matrix(&sensitivity(&self.arm, Number::ONE).by_rate);
                self.named_square(&found, |row, column| Name::indexed(Quantity::CoriolisElement, row, column))
            }
            (What::CoriolisMatrix, _) => {
                let torques = self.tau();
                let half = builder.number(Number::integer(2).inverse().unwrap_or_default());
                formulate::coriolis_matrix(builder, coordinates, &torques, half)
            }
            (What::ForwardDynamicsDerivatives | What::EulerStepDerivatives, _) => {
                // the torques at zero acceleration are not named: they are written again below with the solved
                // accelerations
                let bias = builder.unnamed(|| self.tau());
                let (upper, system) = (self.upper_half(), self.system());
                let inverse = adjoint::Inverse::of(builder, &system, &upper);
                inverse.keep_accelerations(bias);
                let found = self.sensitivity();
                inverse.derivatives(&[&found.by_position, &found.by_rate].map(|rows| coordinates.matrix(rows)))
            }
            (What::TorqueGradient, _) => adjoint::gradient(builder, coordinates, &self.tau()),
            (What::TorqueHessian, Algorithm::Crba(_)) => self.hessian(),
            (What::TorqueHessian, _) => adjoint::hessian(builder, coordinates, &self.tau()),
            _ => return None,
        })
    }

    /// Returns the results for a floating base.
    fn of_floating_base(&self) -> Option<Outputs<'s>> {
        let (builder, coordinates) = (self.builder(), self.coordinates());
        Some(match builder.function.what() {
            What::InverseDynamics | What::GravityTorques | What::BiasTorques => self.forces(),
            What::MassMatrix => formulate::floating_mass_matrix(builder, &self.system(), &self.floating_half()?),
            What::ForwardDynamics => self.accelerations()?,
            What::EulerStep => {
                let gravity = builder.unnamed(|| gravity(builder, self.robot));
                integrator::floating_step(builder, coordinates, gravity, &self.accelerations()?)
            }
            What::InverseDynamicsDerivatives => self.derivatives_of_floating_base()?,
            What::EulerStepDerivatives => {
                let gravity = builder.unnamed(|| gravity(builder, self.robot));
                let bias = builder.unnamed(|| self.forces());
                let (half, system) = (self.floating_half()?, self.system());
                let step = FloatingStep::new(builder, &system, &half, bias, gravity);
                step.derivatives(&self.sensitivity().with_base(coordinates)?)
            }
            What::ForwardDynamicsInContact => {
                let contacts = Contacts::new(builder, self.robot);
                let (system, half) = (self.system(), self.floating_half()?);
                contact::forward_dynamics(builder, &system, &half, self.forces(), &contacts)
            }
            What::CentroidalMomentumMatrix => {
                centroid::momentum_matrix(builder, &self.system(), &self.composite_base()?)
            }
            What::CentroidalBias => {
                let (wrench, _) = torques_of_floating_base(&self.arm);
                self.about_centre(Quantity::BaseForce, wrench)?
            }
            What::CentroidalMomentum => {
                self.about_centre(Quantity::LinearMomentum, momentum::of_floating_base(&self.arm))?
            }
            _ => return None,
        })
    }

    fn builder(&self) -> &'s Builder {
        self.arm.builder
    }

    fn coordinates(&self) -> &'a Coordinates {
        &self.arm.joint_frames.coordinates
    }

    /// Returns the structure of the mass matrix: its coordinates, and the links that carry the joints.
    fn system(&self) -> System<'a> {
        System::new(self.builder().function, self.coordinates(), self.arm.rows().iter().map(|row| row.parent))
    }

    /// Returns the same algorithm for other rows, such as those without gravity.
    fn with<'b>(&self, joint_frames: &'b JointFrames) -> Results<'b, 's>
    where
        'a: 'b,
    {
        Results { arm: Arm { joint_frames, ..self.arm }, ..*self }
    }

    /// Returns the torques of the joints, computed by the Newton-Euler recursion.
    fn recursion(&self) -> Vec<Symbol<'s>> {
        torques(&self.arm, &motions(&self.arm), self.arm.load(self.algorithm == Algorithm::UnturnedPayload))
    }

    /// Returns the torques of the coordinates, computed by the Newton-Euler recursion.
    fn tau(&self) -> Vec<Symbol<'s>> {
        self.coordinates().torques(&self.recursion())
    }

    /// Returns one result for each coordinate, from one number for each joint.
    fn by_joint(&self, quantity: Quantity, of_joints: &[Symbol<'s>]) -> Outputs<'s> {
        formulate::by_joint(self.coordinates(), quantity, self.coordinates().torques(of_joints))
    }

    /// Returns the wrench on a floating base, then the torques.
    fn forces(&self) -> Outputs<'s> {
        let (Wrench { force, moment }, of_joints) = torques_of_floating_base(&self.arm);
        [formulate::on_base([force, moment]), self.by_joint(Quantity::Torque, &of_joints)].concat()
    }

    /// Returns the upper half of M.
    fn upper_half(&self) -> Vec<Vec<Symbol<'s>>> {
        let of_joints =
            if self.algorithm == Algorithm::UnitColumns { self.unit_columns() } else { crba::mass_matrix(&self.arm).0 };
        self.coordinates().upper_half(self.builder(), of_joints)
    }

    /// Returns the upper half of M of the joints, computed by one recursion for each joint with a unit acceleration.
    fn unit_columns(&self) -> Vec<Vec<Symbol<'s>>> {
        let weightless = self.arm.joint_frames.without_gravity();
        let still = self.with(&weightless);
        let dof = self.arm.rows().len();
        let mut rows: Vec<Vec<_>> = vec![Vec::new(); dof];
        for column in 0..dof {
            let torques = self.builder().accelerating(column, || still.recursion());
            for (row, torque) in torques.into_iter().take(column + 1).enumerate() {
                rows[row].push(torque);
            }
        }
        rows
    }

    /// Returns the upper half of M of a robot with a floating base.
    fn floating_half(&self) -> Option<Vec<Vec<Symbol<'s>>>> {
        let (joints, of_base) = crba::mass_matrix(&self.arm);
        let joints = |of_base: OfBase<'s>| {
            let of_base = of_base.gathered(self.coordinates());
            of_base.above(self.builder(), self.coordinates().upper_half(self.builder(), joints))
        };
        of_base.map(joints)
    }

    /// Returns the floating base with all links as one body.
    fn composite_base(&self) -> Option<OfBase<'s>> {
        Some(crba::mass_matrix(&self.arm).1?.gathered(self.coordinates()))
    }

    /// Converts a wrench or momentum to one about the centre of mass of the whole robot.
    fn about_centre(&self, quantity: Quantity, Wrench { force, moment }: Wrench<'s>) -> Option<Outputs<'s>> {
        let OfBase { mass, h, .. } = self.composite_base()?;
        Some(centroid::about_centre(self.builder(), (mass, h), quantity, [force, moment]))
    }

    fn accelerations(&self) -> Option<Outputs<'s>> {
        let builder = self.builder();
        if let Algorithm::Aba(_) = self.algorithm {
            let (of_base, of_joints) = aba::forward_dynamics(&self.arm);
            let elements = |[linear, angular]: [Vector<'s>; 2]| linear.0.into_iter().chain(angular.0);
            let of_base = of_base.into_iter().flat_map(elements).enumerate();
            let of_base = of_base.map(|(row, x)| (self.system().name(Quantity::RateDot, row), x));
            return Some(of_base.chain(self.by_joint(Quantity::RateDot, &of_joints)).collect());
        }
        if builder.function.is_of_floating_base() {
            let (half, bias) = (self.floating_half()?, self.forces());
            return Some(formulate::floating_forward_dynamics(builder, &self.system(), &half, bias));
        }
        let (upper, bias) = (self.upper_half(), self.tau());
        Some(formulate::forward_dynamics(builder, &self.system(), &upper, &bias))
    }

    /// Returns the derivatives of the torques of the joints.
    fn sensitivity(&self) -> Sensitivity<'s> {
        sensitivity(&self.arm, Number::integer(2))
    }

    /// Names the elements of a square matrix of the coordinates; `name` takes row and column as numbers of joints,
    /// counted from 1.
    fn named_square(&self, matrix: &[Vec<Symbol<'s>>], name: impl Fn(usize, usize) -> Name) -> Outputs<'s> {
        let joints = self.coordinates().joints();
        square(joints.len(), |row, column| {
            let name = name(joints[row] + 1, joints[column] + 1);
            (name, self.builder().name(name, matrix[row][column]))
        })
    }

    fn derivatives(&self) -> Outputs<'s> {
        let found = self.sensitivity();
        let by = |kind: fn(usize) -> WithRespectTo, of_joints: &[Vec<Symbol<'s>>]| {
            let matrix = self.coordinates().matrix(of_joints);
            self.named_square(&matrix, |row, column| torque_by(row - 1, kind(column)))
        };
        [by(WithRespectTo::Position, &found.by_position), by(WithRespectTo::Rate, &found.by_rate)].concat()
    }

    fn derivatives_of_floating_base(&self) -> Option<Outputs<'s>> {
        let (builder, coordinates) = (self.builder(), self.coordinates());
        let of_base = formulate::on_base([builder.no_vector(); 2]).into_iter().map(|(name, _)| name);
        let of_joints = coordinates.joints().iter().map(|joint| Name::scalar(Quantity::Torque, joint + 1));
        let names: Vec<_> = of_base.chain(of_joints).collect();
        let columns = self.sensitivity().with_base(coordinates)?;
        let found = formulate::sensitivity_of_floating_base(coordinates, &names, &columns).into_iter();
        Some(found.map(|(name, symbol)| (name, builder.name(name, symbol))).collect())
    }

    fn hessian(&self) -> Outputs<'s> {
        let coordinates = self.coordinates();
        let adjoint::Hessian { dq_dq, dq_dqd, dqd_dqd, dq_dqdd } = hessian::hessian(&self.arm);
        let upper = |rows: Vec<Vec<Symbol<'s>>>| {
            let rows = rows.into_iter().enumerate().map(|(at, row)| row[at..].to_vec());
            coordinates.upper_half(self.builder(), rows.collect())
        };
        let found = adjoint::Hessian {
            dq_dq: upper(dq_dq),
            dq_dqd: coordinates.matrix(&dq_dqd),
            dqd_dqd: upper(dqd_dqd),
            dq_dqdd: coordinates.matrix(&dq_dqdd),
        };
        found.outputs(coordinates)
    }
}
