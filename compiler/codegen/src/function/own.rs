//! Headings and meanings of quantities in the listing of a function, where they differ from the usual ones.

use super::{Base, Function, Load, What};
use crate::quantity::Quantity;

/// A quantity in the listing of a function.
#[derive(Debug)]
pub struct Own {
    /// The quantity.
    pub quantity: Quantity,
    /// The heading above its statements at a joint.
    pub heading: fn(usize) -> String,
    /// The meaning of its names in this function, where it differs from the usual one.
    pub meaning: Option<&'static str>,
}

impl Own {
    /// A quantity with its own heading.
    const fn of(quantity: Quantity, heading: fn(usize) -> String) -> Self {
        Self { quantity, heading, meaning: None }
    }

    /// An argument whose names have a special meaning in this function.
    const fn names(quantity: Quantity, meaning: &'static str) -> Self {
        Self::meaning(quantity, meaning, |_| String::new())
    }

    /// A quantity with its own heading, whose names have a special meaning in this function.
    const fn meaning(quantity: Quantity, meaning: &'static str, heading: fn(usize) -> String) -> Self {
        Self { quantity, heading, meaning: Some(meaning) }
    }
}

/// Meaning of the origins of frames in the Jacobians of tips.
const FROM_BASE: &str = "origin of that frame, from frame 0 in world axes";

/// The quantities of the payload in a listing.
static PAYLOAD: [Own; 3] = [
    Own::names(Quantity::Mass, "mass of link i; of the payload for i = n + 1"),
    Own::names(
        Quantity::Com,
        "centre of mass from the link frame's origin; of the payload, from the tip frame's, for i = n + 1",
    ),
    Own::names(Quantity::Inertia, "inertia about the centre of mass; of the payload, in tip axes, for i = n + 1"),
];

/// The force and the moment that must act on a floating base.
const ON_BASE: [Own; 2] = [
    Own::of(Quantity::BaseForce, |_| "force that must act on the base".to_owned()),
    Own::of(Quantity::BaseMoment, |_| "moment that must act on the base, about the origin of frame 0".to_owned()),
];

/// Rates of the linear and of the angular momentum.
const CENTROIDAL: [Own; 2] = [
    Own::of(Quantity::BaseForce, |_| "rate of the momentum".to_owned()),
    Own::of(Quantity::CentroidalMoment, |_| "rate of the angular momentum about the centre of mass".to_owned()),
];

/// The velocity of a floating base.
const ORIGIN_VELOCITY: Own = Own::meaning(
    Quantity::OriginVelocity,
    "velocity of the frame's origin; of frame 0 for i = 0, in its axes",
    |joint| format!("velocity of the origin of frame {joint}"),
);

/// The accelerations of a floating base.
const OF_BASE: [Own; 2] = [
    Own::of(Quantity::OriginAcceleration, |_| "acceleration of the base, less gravity".to_owned()),
    Own::of(Quantity::OmegaDot, |_| "angular acceleration of the base".to_owned()),
];

/// Returns the heading and meaning of a quantity that are special to the listing of one function.
#[must_use]
pub fn own(function: Function, quantity: Quantity) -> Option<&'static Own> {
    let axes = function.axes();
    let payload = PAYLOAD.iter().filter(|_| axes.load == Load::Payload);
    let rows =
        OWN.iter().filter(|(whats, base, _)| whats.contains(&axes.what) && base.is_none_or(|base| base == axes.base));
    let floating = FLOATING.iter().filter(|_| axes.base == Base::Floating);
    let all = rows.flat_map(|(.., all)| *all).chain(payload).chain(floating).chain(&ANY);
    all.into_iter().find(|own| own.quantity == quantity)
}

/// The quantities of one or more functions that have a special meaning or heading there.
static OWN: &[(&[What], Option<Base>, &[Own])] = &[
    (
        &[What::MomentumAndRate],
        None,
        &[
            Own::of(Quantity::Momentum, |joint| format!("momentum of joint {joint}: row {joint} of M q̇")),
            Own::of(Quantity::MomentumRate, |joint| {
                format!("its rate at joint {joint} without external torques: τ + ∂T/∂q - ∂V/∂q")
            }),
        ],
    ),
    (
        &[What::Jacobian],
        None,
        &[
            Own::of(Quantity::JacobianLinear, |joint| format!("column {joint} of the Jacobian")),
            Own::of(Quantity::JacobianAngular, |joint| format!("column {joint} of the Jacobian")),
        ],
    ),
    (
        &[What::JacobianRateTimesVelocity],
        None,
        &[Own::of(Quantity::TipAcceleration, |_| "acceleration of the tip where q̈ = 0".to_owned())],
    ),
    (
        &[What::PotentialEnergy],
        None,
        &[Own::of(Quantity::ComPosition, |joint| format!("centre of mass of link {joint}, in frame 0"))],
    ),
    (
        &[What::CentreOfMass],
        None,
        &[Own::meaning(
            Quantity::ComPosition,
            "centre of mass of link i, from the base in world axes; i = 0: of the arm, in the world",
            |joint| match joint {
                0 => "centre of mass of the arm: Σ m c / Σ m, in the world".to_owned(),
                _ => format!("centre of mass of link {joint}, from the base in world axes"),
            },
        )],
    ),
    (
        &[What::CentreOfMassJacobian],
        None,
        &[
            Own::meaning(Quantity::ComPosition, "centre of mass of link i, from the base in world axes", |joint| {
                format!("centre of mass of link {joint}, from the base in world axes")
            }),
            Own::meaning(
                Quantity::JacobianLinear,
                "velocity of the centre of mass per rate of joint i, world axes",
                |joint| format!("column {joint} of the Jacobian: what is behind joint {joint} moves with it"),
            ),
        ],
    ),
    (
        &[What::InverseMassMatrix],
        None,
        &[
            Own::meaning(Quantity::RateDot, "element (i, j) of M⁻¹", |joint| {
                format!("row {joint} of the inverse: L⁻ᵀ D⁻¹ L⁻¹")
            }),
            Own::of(Quantity::LowerFactor, |_| "M = L D Lᵀ".to_owned()),
            Own::of(Quantity::ScaledFactor, |_| "M = L D Lᵀ".to_owned()),
            Own::of(Quantity::Pivot, |_| "M = L D Lᵀ".to_owned()),
            Own::of(Quantity::InversePivot, |_| "M = L D Lᵀ".to_owned()),
            Own::meaning(Quantity::Reduced, "element (i, j) of L⁻¹", |joint| format!("row {joint} of L⁻¹")),
            Own::meaning(Quantity::Scaled, "element (i, j) of D⁻¹ L⁻¹", |joint| {
                format!("row {joint} of D⁻¹ L⁻¹")
            }),
        ],
    ),
    (
        &[What::InverseDynamics, What::MassMatrix, What::BiasTorques, What::InverseDynamicsDerivatives],
        Some(Base::Floating),
        &ON_BASE,
    ),
    (
        &[What::ForwardDynamics, What::ForwardDynamicsInContact, What::EulerStep, What::EulerStepDerivatives],
        Some(Base::Floating),
        &OF_BASE,
    ),
    (&[What::CentroidalMomentumMatrix, What::CentroidalBias], None, &CENTROIDAL),
    (
        &[What::Regressor],
        Some(Base::Floating),
        &[
            Own::of(Quantity::BaseForce, |_| "force on the base per parameter".to_owned()),
            Own::of(Quantity::BaseMoment, |_| "moment on the base per parameter".to_owned()),
        ],
    ),
    (
        &[What::PotentialEnergy],
        Some(Base::Floating),
        &[
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
        ],
    ),
    (
        &[What::CentroidalMomentum],
        None,
        &[
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
    ),
    (
        &[What::TipJacobians],
        None,
        &[
            Own::meaning(Quantity::FrameOrigin, FROM_BASE, |joint| format!("origin of frame {joint}, from frame 0")),
            Own::meaning(Quantity::JacobianLinear, "velocity of a tip per velocity, world axes", |joint| {
                format!("columns {joint} of the Jacobians; 0: of the base")
            }),
            Own::meaning(Quantity::JacobianAngular, "angular velocity of a tip per velocity, world axes", |joint| {
                format!("columns {joint} of the Jacobians; 0: of the base")
            }),
        ],
    ),
    (
        &[What::TipAccelerations],
        None,
        &[
            Own::meaning(
                Quantity::JointPointAcceleration,
                "acceleration of joint i, in the axes of its parent",
                |joint| format!("acceleration of joint {joint}, in the axes of its parent"),
            ),
            Own::of(Quantity::TipAcceleration, |_| {
                "accelerations of the tips where nothing else accelerates".to_owned()
            }),
        ],
    ),
    (
        &[What::EulerStep, What::EulerStepDerivatives],
        Some(Base::Floating),
        &[
            Own::names(
                Quantity::FrameRotation,
                "rotation of the base: its columns are the axes of frame 0 in the world",
            ),
            Own::names(Quantity::FrameOrigin, "origin of frame 0 in the world"),
            Own::names(Quantity::OriginVelocity, "velocity of the origin of frame 0, in its axes"),
            Own::of(Quantity::NextOmega, |_| "angular velocity of the base after the step".to_owned()),
            Own::of(Quantity::NextVelocity, |_| "velocity of the origin of frame 0 after the step".to_owned()),
        ],
    ),
    (
        &[What::EulerStep],
        Some(Base::Floating),
        &[
            Own::of(Quantity::NextOrigin, |_| "origin of frame 0 after the step".to_owned()),
            Own::of(Quantity::NextRotation, |_| "rotation of the base after the step".to_owned()),
        ],
    ),
    (
        &[What::EulerStepDerivatives],
        Some(Base::Floating),
        &[
            Own::meaning(
                Quantity::NextOrigin,
                "shift of the base after the step, along the axes that frame 0 has then",
                |_| "shift of the base after the step".to_owned(),
            ),
            Own::of(Quantity::NextTurn, |_| "turn of the base after the step".to_owned()),
        ],
    ),
];

/// Quantities of a floating base.
static FLOATING: [Own; 1] = [ORIGIN_VELOCITY];

/// Quantities that mean the same in each function.
static ANY: [Own; 18] = [
    Own::of(Quantity::CoriolisElement, |joint| format!("row {joint} of the Coriolis matrix: ½ ∂(bias torques)/∂q̇")),
    Own::of(Quantity::Kinetic, |_| "kinetic energy: ½ Σ (m ċ · ċ + ω · I ω)".to_owned()),
    Own::of(Quantity::Potential, |_| "potential energy: -Σ m g · c".to_owned()),
    Own::of(Quantity::RegressorElement, |joint| format!("torque {joint} per parameter")),
    Own::of(Quantity::ActuatorTorque, |joint| format!("motor {joint}: G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇)")),
    Own::of(Quantity::WeightedTorque, |_| "derivatives of λᵀτ".to_owned()),
    Own::of(Quantity::JacobianLinearRate, |joint| format!("column {joint} of the rate of the Jacobian")),
    Own::of(Quantity::JacobianAngularRate, |joint| format!("column {joint} of the rate of the Jacobian")),
    Own::of(Quantity::WeightedByPosition, |joint| format!("second derivatives of λᵀτ, by q{joint}")),
    Own::of(Quantity::WeightedByRate, |joint| format!("second derivatives of λᵀτ, by q̇{joint}")),
    Own::of(Quantity::NextRate, |joint| format!("velocity of joint {joint} after the step")),
    Own::of(Quantity::NextPosition, |joint| format!("position of joint {joint} after the step")),
    Own::of(Quantity::ContactForce, |tip| format!("force of the contact at tip {tip}")),
    Own::of(Quantity::ContactMoment, |tip| format!("moment of the contact at tip {tip}")),
    Own::of(Quantity::ClosedPosition, |joint| format!("position of joint {joint} after the step")),
    Own::of(Quantity::Residual, |_| "what is left of the equations of the loops".to_owned()),
    Own::of(Quantity::LoopMap, |joint| format!("velocity of joint {joint} per velocity of the others")),
    Own::of(Quantity::LoopBias, |joint| format!("acceleration of joint {joint} where q̈ is 0")),
];
