//! The ways in which a function can be written under a plan, and which of them takes the fewest operations.

use rne_functions::Recursion;
use rne_model::Robot;

use crate::formulate::arm::gravity;
use crate::formulate::ldlt::System;
use crate::formulate::mass_matrix::OfBase;
use crate::formulate::{
    self, Closure, Contacts, FloatingStep, Outputs, adjoint, centroid, contact, integrator, square, torque_by,
};
use crate::function::{Argument, Axes, Base, Function, Load, What};
use crate::ir::{Name, Number, Quantity, Symbol, WithRespectTo};
use crate::reduced::backward::{torques, torques_of_floating_base};
use crate::reduced::crba::ExpressedIn;
use crate::reduced::forward::motions;
use crate::reduced::rnea_derivatives::sensitivity;
use crate::reduced::{Arm, Wrench, aba, crba, hessian, momentum};

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
        const ABA: [Algorithm; 2] = [Algorithm::Aba(ExpressedIn::GroupFrame), Algorithm::Aba(ExpressedIn::JointFrame)];
        const COMPOSITE_BODIES: &[Algorithm] = &[BY_GROUPS, BY_JOINTS];
        let Axes { what, base, load, loops } = function.axes();
        let is_plain = matches!((base, load, loops), (Base::Held, Load::Free, false));
        let carries = matches!(load, Load::Payload);
        let Some(recursion) = what.recursion() else { return &[] };
        match recursion {
            Recursion::Torques if matches!(base, Base::Moving) => &[],
            Recursion::Torques if carries => &[Algorithm::Rnea, Algorithm::UnturnedPayload],
            Recursion::Torques => &[Algorithm::Rnea],
            Recursion::GravityTorques if matches!(base, Base::Floating) => &[Algorithm::Rnea],
            Recursion::GravityTorques if carries => {
                &[Algorithm::Rnea, Algorithm::UnturnedPayload, BY_GROUPS, BY_JOINTS]
            }
            Recursion::GravityTorques => &[Algorithm::Rnea, BY_GROUPS, BY_JOINTS],
            Recursion::Derivatives | Recursion::SecondDerivatives if is_plain => {
                &[BY_GROUPS, BY_JOINTS, Algorithm::Rnea]
            }
            Recursion::MassMatrix if is_plain => &[BY_GROUPS, BY_JOINTS, Algorithm::UnitColumns],
            Recursion::Accelerations if is_plain => &[BY_GROUPS, BY_JOINTS, Algorithm::UnitColumns, ABA[0], ABA[1]],
            Recursion::Accelerations if !loops && (carries || matches!(base, Base::Floating)) => {
                &[BY_GROUPS, BY_JOINTS, ABA[0], ABA[1]]
            }
            Recursion::Derivatives
            | Recursion::SecondDerivatives
            | Recursion::MassMatrix
            | Recursion::Accelerations
            | Recursion::CompositeBodies => COMPOSITE_BODIES,
        }
    }

    /// The ways of a function that are worth counting for a robot. Those that write the recursion anew for every joint
    /// grow faster than composite bodies, and lose long before `MANY`, second derivatives before `FEW`. Articulated
    /// bodies are those of links alone, each with a joint that moves freely.
    pub(crate) fn of_robot(function: Function, robot: &Robot) -> Vec<Self> {
        const MANY: usize = 10;
        const FEW: usize = 5;
        let recursion = function.what().recursion();
        let is_worth = |algorithm: Self| match algorithm {
            Self::UnitColumns => robot.joints.len() < MANY,
            Self::Rnea if recursion == Some(Recursion::Derivatives) => robot.joints.len() < MANY,
            Self::Rnea if recursion == Some(Recursion::SecondDerivatives) => robot.joints.len() < FEW,
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
    let is_floating = builder.function.is_of_floating_base();
    let accelerations = || {
        if let Algorithm::Aba(_) = algorithm {
            let (of_base, of_joints) = aba::forward_dynamics(arm);
            let of_base = of_base.into_iter().flat_map(|[linear, angular]| linear.0.into_iter().chain(angular.0));
            let of_base = of_base.enumerate().map(|(row, x)| (system().name(Quantity::RateDot, row), x));
            return Some(of_base.chain(by_joint(Quantity::RateDot, of_joints)).collect());
        }
        if is_floating {
            let (half, bias) = (floating_half()?, of_floating_base());
            return Some(formulate::floating_forward_dynamics(builder, &system(), &half, bias));
        }
        let (upper, bias) = (upper_half(), coordinates.torques(&recursion(arm, algorithm)));
        Some(formulate::forward_dynamics(builder, &system(), &upper, &bias))
    };
    let named = |name: Name, symbol: Symbol<'s>| (name, builder.name(name, symbol));
    Some(match (builder.function.what(), algorithm) {
        (What::GravityTorques, Algorithm::Crba(_)) => by_joint(Quantity::Torque, crba::gravity_torques(arm)),
        (What::CoriolisTorques, _) => {
            let joint_frames = arm.joint_frames.without_gravity();
            by_joint(Quantity::Torque, recursion(&Arm { joint_frames: &joint_frames, ..*arm }, algorithm))
        }
        (What::MomentumAndRate, _) => {
            let [momenta, rates] = momentum::momentum_and_rate(arm);
            [by_joint(Quantity::Momentum, momenta), by_joint(Quantity::MomentumRate, rates)].concat()
        }
        (What::MassMatrix, _) if is_floating => formulate::floating_mass_matrix(builder, &system(), &floating_half()?),
        (What::MassMatrix, _) => formulate::mass_matrix(coordinates, &upper_half()),
        (What::InverseMassMatrix, _) => formulate::inverse_mass_matrix(builder, &system(), &upper_half()),
        (What::InverseMassMatrixTimesTorques, Algorithm::Aba(_)) => {
            let joint_frames = arm.joint_frames.without_gravity();
            let weightless = Arm { joint_frames: &joint_frames, ..*arm };
            by_joint(Quantity::RateDot, aba::forward_dynamics(&weightless).1)
        }
        (What::InverseMassMatrixTimesTorques, _) => {
            formulate::accelerations(builder, &system(), &upper_half(), |applied, _| applied)
        }
        (What::ForwardDynamics, _) => accelerations()?,
        (What::EulerStep, _) if is_floating => {
            let gravity = builder.unnamed(|| gravity(builder, robot));
            integrator::floating_step(builder, coordinates, gravity, &accelerations()?)
        }
        (What::EulerStep, _) => integrator::step(builder, coordinates, &accelerations()?),
        (What::InverseDynamicsDerivatives, _) if is_floating => {
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
        (What::InverseDynamicsDerivatives, Algorithm::Crba(_)) => {
            let found = sensitivity(arm, Number::integer(2));
            let by = |kind: fn(usize) -> WithRespectTo, of_joints: &[Vec<Symbol<'s>>]| {
                let matrix = coordinates.matrix(of_joints);
                square(joints.len(), |row, column| {
                    named(torque_by(joints[row], kind(joints[column] + 1)), matrix[row][column])
                })
            };
            [by(WithRespectTo::Position, &found.by_position), by(WithRespectTo::Rate, &found.by_rate)].concat()
        }
        (What::CoriolisMatrix, Algorithm::Crba(_)) => {
            let found = coordinates.matrix(&sensitivity(arm, Number::ONE).by_rate);
            square(joints.len(), |row, column| {
                let name = Name::indexed(Quantity::CoriolisElement, joints[row] + 1, joints[column] + 1);
                named(name, found[row][column])
            })
        }
        (What::InverseDynamicsDerivatives, _) => {
            formulate::derivatives(builder, coordinates, &coordinates.torques(&recursion(arm, algorithm)))
        }
        (What::EulerStepDerivatives, _) if is_floating => {
            let gravity = builder.unnamed(|| gravity(builder, robot));
            let bias = builder.unnamed(of_floating_base);
            let (half, system) = (floating_half()?, system());
            let step = FloatingStep::new(builder, &system, &half, bias, gravity);
            step.derivatives(&sensitivity(arm, Number::integer(2)).with_base(coordinates)?)
        }
        (What::ForwardDynamicsDerivatives | What::EulerStepDerivatives, _) => {
            // the same quantities come again, at the accelerations that are solved for
            let bias = builder.unnamed(|| coordinates.torques(&recursion(arm, algorithm)));
            let (upper, system) = (upper_half(), system());
            let inverse = adjoint::Inverse::of(builder, &system, &upper);
            inverse.keep_accelerations(bias);
            let found = sensitivity(arm, Number::integer(2));
            inverse.derivatives(&[&found.by_position, &found.by_rate].map(|rows| coordinates.matrix(rows)))
        }
        (What::TorqueGradient, _) => {
            adjoint::gradient(builder, coordinates, &coordinates.torques(&recursion(arm, algorithm)))
        }
        (What::TorqueHessian, Algorithm::Crba(_)) => {
            let adjoint::Hessian { dq_dq, dq_dqd, dqd_dqd, dq_dqdd } = hessian::hessian(arm);
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
        (What::TorqueHessian, _) => {
            adjoint::hessian(builder, coordinates, &coordinates.torques(&recursion(arm, algorithm)))
        }
        (What::CoriolisMatrix, _) => {
            let torques = coordinates.torques(&recursion(arm, algorithm));
            let half = builder.number(Number::integer(2).inverse().unwrap_or_default());
            formulate::coriolis_matrix(builder, coordinates, &torques, half)
        }
        (
            What::InverseDynamics | What::InverseDynamicsFromSinCos | What::GravityTorques | What::BiasTorques,
            algorithm,
        ) => {
            if is_floating {
                of_floating_base()
            } else {
                by_joint(Quantity::Torque, recursion(arm, algorithm))
            }
        }
        (What::ForwardDynamicsInContact, _) => {
            let contacts = Contacts::new(builder, robot);
            contact::forward_dynamics(builder, &system(), &floating_half()?, of_floating_base(), &contacts)
        }
        (What::CentroidalMomentumMatrix, _) => centroid::momentum_matrix(builder, &system(), &of_base()?),
        (What::CentroidalBias, _) => {
            let (Wrench { force, moment }, _) = torques_of_floating_base(arm);
            let OfBase { mass, h, .. } = of_base()?;
            centroid::about_centre(builder, (mass, h), Quantity::BaseForce, [force, moment])
        }
        (What::CentroidalMomentum, _) => {
            let Wrench { force, moment } = momentum::of_floating_base(arm);
            let OfBase { mass, h, .. } = of_base()?;
            centroid::about_centre(builder, (mass, h), Quantity::LinearMomentum, [force, moment])
        }
        // the table of results says which functions have no recursion
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
