//! The ways in which a function can be written under a plan, and which of them takes the fewest operations.

use rne_model::Robot;

use crate::formulate::arm::gravity;
use crate::formulate::ldlt::System;
use crate::formulate::mass_matrix::OfBase;
use crate::formulate::{
    self, Closure, Contacts, FloatingStep, Outputs, adjoint, centroid, contact, integrator, square, torque_by,
};
use crate::function::{Argument, Function};
use crate::ir::{Name, Number, Quantity, Symbol, WithRespectTo};
use crate::reduced::backward::{torques, torques_of_floating_base};
use crate::reduced::crba::ExpressedIn;
use crate::reduced::forward::motions;
use crate::reduced::rnea_derivatives::sensitivity;
use crate::reduced::{Arm, Wrench, aba, crba, momentum, torque_hessian};

/// How a function is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Algorithm {
    /// The recursion, out and back, and what follows from its torques.
    #[default]
    Rnea,
    /// Composite bodies.
    Crba(ExpressedIn),
    /// The recursion, once per joint that accelerates.
    UnitColumns,
    /// Articulated bodies.
    Aba(ExpressedIn),
    /// The recursion, with the payload in frame N of the last joint instead of the last link's.
    UnturnedPayload,
}

impl Algorithm {
    /// All of them, with their names in plan files.
    pub const NAMES: [(Self, &'static str); 7] = [
        (Self::Rnea, "rnea"),
        (Self::Crba(ExpressedIn::GroupFrame), "crba_by_groups"),
        (Self::Crba(ExpressedIn::JointFrame), "crba_by_joints"),
        (Self::UnitColumns, "unit_columns"),
        (Self::Aba(ExpressedIn::GroupFrame), "aba_by_groups"),
        (Self::Aba(ExpressedIn::JointFrame), "aba_by_joints"),
        (Self::UnturnedPayload, "unturned_payload"),
    ];

    /// Its name in plan files.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.into_iter().find(|(other, _)| *other == self).map_or("", |(_, name)| name)
    }

    /// Whether the choices of a plan matter to a function.
    #[must_use]
    pub const fn is_planned(function: Function) -> bool {
        !Self::of(function).is_empty()
    }

    /// The ways of a function; none for what has no reduced recursion.
    #[must_use]
    pub const fn of(function: Function) -> &'static [Self] {
        const BY_GROUPS: Algorithm = Algorithm::Crba(ExpressedIn::GroupFrame);
        const BY_JOINTS: Algorithm = Algorithm::Crba(ExpressedIn::JointFrame);
        match function {
            Function::InverseDynamics
            | Function::InverseDynamicsWithWrench
            | Function::InverseDynamicsFromSinCos
            | Function::BiasTorques
            | Function::InverseDynamicsWithWrenches
            | Function::InverseDynamicsOfFloatingBase
            | Function::FloatingBias
            | Function::InverseDynamicsOfFloatingLoops
            | Function::InverseDynamicsOfLoops
            | Function::InverseDynamicsOfLoopsWithWrenches
            | Function::TorqueGradient => &[Algorithm::Rnea],
            Function::InverseDynamicsWithPayload | Function::BiasTorquesWithPayload => {
                &[Algorithm::Rnea, Algorithm::UnturnedPayload]
            }
            Function::CoriolisMatrix | Function::InverseDynamicsDerivatives | Function::TorqueHessian => {
                &[BY_GROUPS, BY_JOINTS, Algorithm::Rnea]
            }
            Function::GravityTorques => &[Algorithm::Rnea, BY_GROUPS, BY_JOINTS],
            Function::GravityTorquesWithPayload => &[Algorithm::Rnea, Algorithm::UnturnedPayload, BY_GROUPS, BY_JOINTS],
            Function::MassMatrix | Function::InverseMassMatrix => &[BY_GROUPS, BY_JOINTS, Algorithm::UnitColumns],
            // the momentum, where the first moments behind the joints are gathered
            Function::MomentumAndRate
            | Function::MomentumAndRateWithPayload
            | Function::MassMatrixWithPayload
            | Function::InverseDynamicsDerivativesWithPayload
            | Function::ForwardDynamicsWithWrenches
            | Function::FloatingMassMatrix
            | Function::CentroidalMomentumMatrix
            | Function::CentroidalBias
            | Function::CentroidalMomentum
            | Function::ForwardDynamicsInContact
            | Function::FloatingInverseDynamicsDerivatives
            | Function::MassMatrixOfLoops
            | Function::ForwardDynamicsOfLoops
            | Function::FloatingMassMatrixOfLoops
            | Function::FloatingForwardDynamicsOfLoops
            | Function::ForwardDynamicsDerivatives
            | Function::InverseDynamicsDerivativesWithWrenches
            | Function::ForwardDynamicsDerivativesWithWrenches
            | Function::ForwardDynamicsDerivativesWithPayload
            | Function::EulerStepDerivatives
            | Function::FloatingEulerStepDerivatives => &[BY_GROUPS, BY_JOINTS],
            Function::ForwardDynamicsWithPayload | Function::FloatingForwardDynamics | Function::FloatingEulerStep => {
                &[
                    BY_GROUPS,
                    BY_JOINTS,
                    Algorithm::Aba(ExpressedIn::GroupFrame),
                    Algorithm::Aba(ExpressedIn::JointFrame),
                ]
            }
            Function::ForwardDynamics | Function::InverseMassMatrixTimesTorques | Function::EulerStep => &[
                BY_GROUPS,
                BY_JOINTS,
                Algorithm::UnitColumns,
                Algorithm::Aba(ExpressedIn::GroupFrame),
                Algorithm::Aba(ExpressedIn::JointFrame),
            ],
            Function::ForwardKinematics
            | Function::LinkPoses
            | Function::Jacobian
            | Function::JacobianRateTimesVelocity
            | Function::WrenchTorques
            | Function::KineticEnergy
            | Function::PotentialEnergy
            | Function::CentreOfMass
            | Function::CentreOfMassJacobian
            | Function::Regressor
            | Function::JointWrenches
            | Function::InverseDynamicsOnMovingBase
            | Function::ActuatorTorques
            | Function::FloatingRegressor
            | Function::FloatingKineticEnergy
            | Function::FloatingPotentialEnergy
            | Function::TipJacobians
            | Function::TipAccelerations
            | Function::ClosureStep
            | Function::LoopMap
            | Function::LoopMapRateTimesVelocity
            | Function::JacobianRate
            | Function::JacobianDerivatives => &[],
        }
    }

    /// The ways of a function that are worth counting for a robot. Those that write the recursion anew for every joint
    /// grow faster than composite bodies, and lose long before `MANY`, second derivatives before `FEW`. Articulated
    /// bodies are those of links alone, each with a joint that moves freely.
    pub(crate) fn of_robot(function: Function, robot: &Robot) -> Vec<Self> {
        const MANY: usize = 10;
        const FEW: usize = 5;
        let is_worth = |algorithm: Self| match algorithm {
            Self::UnitColumns => robot.joints.len() < MANY,
            Self::Rnea if matches!(function, Function::CoriolisMatrix | Function::InverseDynamicsDerivatives) => {
                robot.joints.len() < MANY
            }
            Self::Rnea if function == Function::TorqueHessian => robot.joints.len() < FEW,
            Self::Rnea | Self::UnturnedPayload | Self::Crba(_) => true,
            Self::Aba(_) => {
                !robot.has_rotors() && !robot.has_couplings() && robot.closed.is_empty() && !robot.has_spinning_rotors()
            }
        };
        Self::of(function).iter().copied().filter(|&algorithm| is_worth(algorithm)).collect()
    }

    /// The frames of its composite or articulated bodies.
    pub(crate) const fn expressed_in(self) -> ExpressedIn {
        match self {
            Self::Crba(expressed_in) | Self::Aba(expressed_in) => expressed_in,
            Self::Rnea | Self::UnitColumns | Self::UnturnedPayload => ExpressedIn::GroupFrame,
        }
    }

    /// The words for the choices of a program; none for the recursion.
    pub(crate) const fn words(self) -> Option<&'static str> {
        match self {
            Self::Rnea => None,
            Self::Crba(ExpressedIn::GroupFrame) => Some("composite bodies, gathered per group of parallel axes"),
            Self::Crba(ExpressedIn::JointFrame) => Some("composite bodies, gathered joint by joint"),
            Self::UnitColumns => Some("columns: one recursion per joint that accelerates"),
            Self::Aba(ExpressedIn::GroupFrame) => Some("articulated bodies, gathered per group of parallel axes"),
            Self::Aba(ExpressedIn::JointFrame) => Some("articulated bodies, gathered joint by joint"),
            Self::UnturnedPayload => Some("the payload in frame N of the last joint (13)"),
        }
    }
}

/// Writes a function on the builder's sheet: what it returns, by name, in the order of its layout; `None` for
/// what has no reduced recursion.
#[allow(clippy::too_many_lines)] // an arm for each way
pub(crate) fn write<'s>(arm: &Arm<'_, 's>, robot: &Robot, algorithm: Algorithm) -> Option<Outputs<'s>> {
    let builder = arm.builder;
    if builder.function.is_of_closed_loops() {
        Closure::keep(builder, robot, builder.function.takes(Argument::Rates));
    }
    let coordinates = &arm.joint_frames.coordinates;
    let joints = coordinates.joints();
    let upper_half = || coordinates.upper_half(builder, mass_matrix(arm, algorithm));
    let system = || System::new(builder.function, coordinates, arm.rows().iter().map(|row| row.parent));
    let by_joint = |quantity, of_joints: Vec<Symbol<'s>>| {
        formulate::by_joint(coordinates, quantity, coordinates.torques(&of_joints))
    };
    let of_floating_base = || {
        let (Wrench { force, moment }, of_joints) = torques_of_floating_base(arm);
        [formulate::on_base([force, moment]), by_joint(Quantity::Torque, of_joints)].concat()
    };
    let floating_half = || {
        let (joints, of_base) = crba::mass_matrix(arm);
        Some(of_base?.gathered(coordinates).above(builder, coordinates.upper_half(builder, joints)))
    };
    let of_base = || Some(crba::mass_matrix(arm).1?.gathered(coordinates));
    let floating_accelerations = || {
        let Algorithm::Aba(_) = algorithm else {
            let (half, bias) = (floating_half()?, of_floating_base());
            return Some(formulate::floating_forward_dynamics(builder, &system(), &half, bias));
        };
        let (of_base, of_joints) = aba::forward_dynamics(arm);
        let [linear, angular] = of_base?;
        let of_base = linear.0.into_iter().chain(angular.0).enumerate();
        let named = of_base.map(|(row, x)| (system().name(Quantity::RateDot, row), x)).collect();
        Some([named, by_joint(Quantity::RateDot, of_joints)].concat())
    };
    let named = |name: Name, symbol: Symbol<'s>| (name, builder.name(name, symbol));
    Some(match (builder.function, algorithm) {
        (Function::GravityTorques | Function::GravityTorquesWithPayload, Algorithm::Crba(_)) => {
            by_joint(Quantity::Torque, crba::gravity_torques(arm))
        }
        (Function::MomentumAndRate | Function::MomentumAndRateWithPayload, _) => {
            let [momenta, rates] = momentum::momentum_and_rate(arm);
            [by_joint(Quantity::Momentum, momenta), by_joint(Quantity::MomentumRate, rates)].concat()
        }
        (Function::MassMatrix | Function::MassMatrixWithPayload | Function::MassMatrixOfLoops, _) => {
            formulate::mass_matrix(coordinates, &upper_half())
        }
        (Function::InverseMassMatrix, _) => formulate::inverse_mass_matrix(builder, &system(), &upper_half()),
        (Function::InverseMassMatrixTimesTorques, Algorithm::Aba(_)) => {
            let joint_frames = arm.joint_frames.without_gravity();
            let weightless = Arm { joint_frames: &joint_frames, ..*arm };
            by_joint(Quantity::RateDot, aba::forward_dynamics(&weightless).1)
        }
        (Function::InverseMassMatrixTimesTorques, _) => {
            formulate::accelerations(builder, &system(), &upper_half(), |applied, _| applied)
        }
        (Function::ForwardDynamics | Function::ForwardDynamicsWithPayload, Algorithm::Aba(_)) => {
            by_joint(Quantity::RateDot, aba::forward_dynamics(arm).1)
        }
        (Function::EulerStep, Algorithm::Aba(_)) => {
            integrator::euler_step(builder, coordinates, &by_joint(Quantity::RateDot, aba::forward_dynamics(arm).1))
        }
        (Function::EulerStep, _) => {
            let (upper, bias) = (upper_half(), coordinates.torques(&recursion(arm, algorithm)));
            let accelerations = formulate::forward_dynamics(builder, &system(), &upper, &bias);
            integrator::euler_step(builder, coordinates, &accelerations)
        }
        (
            Function::ForwardDynamics
            | Function::ForwardDynamicsWithPayload
            | Function::ForwardDynamicsWithWrenches
            | Function::ForwardDynamicsOfLoops,
            _,
        ) => {
            let (upper, bias) = (upper_half(), coordinates.torques(&recursion(arm, algorithm)));
            formulate::forward_dynamics(builder, &system(), &upper, &bias)
        }
        (
            Function::InverseDynamicsDerivatives
            | Function::InverseDynamicsDerivativesWithPayload
            | Function::InverseDynamicsDerivativesWithWrenches,
            Algorithm::Crba(_),
        ) => {
            let found = sensitivity(arm, Number::integer(2));
            let by = |kind: fn(usize) -> WithRespectTo, of_joints: &[Vec<Symbol<'s>>]| {
                let matrix = coordinates.matrix(of_joints);
                square(joints.len(), |row, column| {
                    named(torque_by(joints[row], kind(joints[column] + 1)), matrix[row][column])
                })
            };
            [by(WithRespectTo::Position, &found.by_position), by(WithRespectTo::Rate, &found.by_rate)].concat()
        }
        (Function::FloatingInverseDynamicsDerivatives, _) => {
            let names: Vec<_> = formulate::on_base([builder.no_vector(); 2])
                .into_iter()
                .map(|(name, _)| name)
                .chain(joints.iter().map(|joint| Name::scalar(Quantity::Torque, joint + 1)))
                .collect();
            let columns = sensitivity(arm, Number::integer(2)).with_base(coordinates)?;
            formulate::sensitivity_of_floating_base(coordinates, &names, &columns)
                .into_iter()
                .map(|(name, symbol)| named(name, symbol))
                .collect()
        }
        (Function::CoriolisMatrix, Algorithm::Crba(_)) => {
            let found = coordinates.matrix(&sensitivity(arm, Number::ONE).by_rate);
            square(joints.len(), |row, column| {
                let name = Name::indexed(Quantity::CoriolisElement, joints[row] + 1, joints[column] + 1);
                named(name, found[row][column])
            })
        }
        (Function::InverseDynamicsDerivatives, _) => {
            formulate::derivatives(builder, coordinates, &coordinates.torques(&recursion(arm, algorithm)))
        }
        (
            Function::ForwardDynamicsDerivatives
            | Function::ForwardDynamicsDerivativesWithWrenches
            | Function::ForwardDynamicsDerivativesWithPayload
            | Function::EulerStepDerivatives,
            _,
        ) => {
            // the same quantities come again, at the accelerations that are solved for
            let bias = builder.unnamed(|| coordinates.torques(&recursion(arm, algorithm)));
            let (upper, system) = (upper_half(), system());
            let inverse = adjoint::Inverse::of(builder, &system, &upper);
            inverse.keep_accelerations(bias);
            let found = sensitivity(arm, Number::integer(2));
            inverse.derivatives(&[&found.by_position, &found.by_rate].map(|rows| coordinates.matrix(rows)))
        }
        (Function::TorqueGradient, _) => {
            adjoint::gradient(builder, coordinates, &coordinates.torques(&recursion(arm, algorithm)))
        }
        (Function::TorqueHessian, Algorithm::Crba(_)) => {
            let adjoint::Hessian { dq_dq, dq_dqd, dqd_dqd, dq_dqdd } = torque_hessian::hessian(arm);
            let upper = |rows: Vec<Vec<Symbol<'s>>>| {
                let rows = rows.into_iter().enumerate().map(|(at, row)| row[at..].to_vec());
                coordinates.upper_half(builder, rows.collect())
            };
            let found = adjoint::Hessian {
                dq_dq: upper(dq_dq),
                dq_dqd: coordinates.matrix(&dq_dqd),
                dqd_dqd: upper(dqd_dqd),
                dq_dqdd: coordinates.matrix(&dq_dqdd),
            };
            found.outputs(coordinates)
        }
        (Function::TorqueHessian, _) => {
            adjoint::hessian(builder, coordinates, &coordinates.torques(&recursion(arm, algorithm)))
        }
        (Function::CoriolisMatrix, _) => {
            let torques = coordinates.torques(&recursion(arm, algorithm));
            let half = builder.number(Number::integer(2).inverse().unwrap_or_default());
            formulate::coriolis_matrix(builder, coordinates, &torques, half)
        }
        (
            Function::InverseDynamics
            | Function::InverseDynamicsWithWrench
            | Function::InverseDynamicsWithPayload
            | Function::InverseDynamicsFromSinCos
            | Function::GravityTorques
            | Function::BiasTorques
            | Function::GravityTorquesWithPayload
            | Function::BiasTorquesWithPayload
            | Function::InverseDynamicsWithWrenches
            | Function::InverseDynamicsOfLoops
            | Function::InverseDynamicsOfLoopsWithWrenches,
            algorithm,
        ) => by_joint(Quantity::Torque, recursion(arm, algorithm)),
        (
            Function::InverseDynamicsOfFloatingBase | Function::FloatingBias | Function::InverseDynamicsOfFloatingLoops,
            _,
        ) => of_floating_base(),
        (Function::FloatingMassMatrix | Function::FloatingMassMatrixOfLoops, _) => {
            formulate::floating_mass_matrix(builder, &system(), &floating_half()?)
        }
        (Function::FloatingForwardDynamics | Function::FloatingForwardDynamicsOfLoops, _) => floating_accelerations()?,
        (Function::FloatingEulerStep, _) => {
            let gravity = builder.unnamed(|| gravity(builder, robot));
            integrator::floating_euler_step(builder, coordinates, gravity, &floating_accelerations()?)
        }
        (Function::FloatingEulerStepDerivatives, _) => {
            let gravity = builder.unnamed(|| gravity(builder, robot));
            let bias = builder.unnamed(of_floating_base);
            let (half, system) = (floating_half()?, system());
            let step = FloatingStep::new(builder, &system, &half, bias, gravity);
            step.derivatives(&sensitivity(arm, Number::integer(2)).with_base(coordinates)?)
        }
        (Function::ForwardDynamicsInContact, _) => {
            let contacts = Contacts::new(builder, robot);
            contact::forward_dynamics(builder, &system(), &floating_half()?, of_floating_base(), &contacts)
        }
        (Function::CentroidalMomentumMatrix, _) => centroid::momentum_matrix(builder, &system(), &of_base()?),
        (Function::CentroidalBias, _) => {
            let (Wrench { force, moment }, _) = torques_of_floating_base(arm);
            let OfBase { mass, h, .. } = of_base()?;
            centroid::about_centre(builder, (mass, h), Quantity::BaseForce, [force, moment])
        }
        (Function::CentroidalMomentum, _) => {
            let Wrench { force, moment } = momentum::of_floating_base(arm);
            let OfBase { mass, h, .. } = of_base()?;
            centroid::about_centre(builder, (mass, h), Quantity::LinearMomentum, [force, moment])
        }
        // `Algorithm::of` matches them all
        _ => return None,
    })
}

fn recursion<'s>(arm: &Arm<'_, 's>, algorithm: Algorithm) -> Vec<Symbol<'s>> {
    torques(arm, &motions(arm), arm.load(algorithm == Algorithm::UnturnedPayload))
}

/// The upper half of M.
fn mass_matrix<'s>(arm: &Arm<'_, 's>, algorithm: Algorithm) -> Vec<Vec<Symbol<'s>>> {
    if algorithm != Algorithm::UnitColumns {
        return crba::mass_matrix(arm).0;
    }
    let joint_frames = arm.joint_frames.without_gravity();
    let still = Arm { joint_frames: &joint_frames, ..*arm };
    let dof = arm.rows().len();
    let mut rows: Vec<Vec<_>> = vec![Vec::new(); dof];
    for column in 0..dof {
        let torques = arm.builder.accelerating(column, || recursion(&still, algorithm));
        for (row, torque) in torques.into_iter().take(column + 1).enumerate() {
            rows[row].push(torque);
        }
    }
    rows
}
