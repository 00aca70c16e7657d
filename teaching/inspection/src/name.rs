//! The meaning of a name: quantity, unit, frame, and the place in drawings of the arm.

use rne_codegen::{self as codegen, Component, Quantity};
use rne_model::{JointKind, Robot};

use crate::record::{self, Name};

/// Converts the name of a quantity, such as `JointForce` to `joint_force`.
pub(crate) fn quantity(quantity: Quantity) -> String {
    let mut text = String::new();
    for letter in format!("{quantity:?}").chars() {
        if letter.is_uppercase() && !text.is_empty() {
            text.push('_');
        }
        text.extend(letter.to_lowercase());
    }
    text
}

pub(crate) fn record(name: codegen::Name) -> Name {
    use Quantity::{ChildForce, ChildMoment, OmegaCrossR, R};
    let component = match name.component {
        Component::Scalar => None,
        Component::Vector(axis) => Some(axis.to_string()),
        Component::Matrix(row, column) => Some(format!("{row}{column}")),
    };
    let part = (name.part > 0).then_some(name.part);
    let is_carried = matches!(name.quantity, R | OmegaCrossR | ChildForce | ChildMoment) && name.indices[0] > 0;
    let carries = is_carried.then_some(name.indices[0]);
    Name { quantity: quantity(name.quantity), joint: name.joint, component, part, carries }
}

/// Describes a quantity of a robot's code.
pub(crate) fn of_quantity(robot: &Robot, of: Quantity) -> record::Quantity {
    record::Quantity {
        letter: of.letter(),
        meaning: rne_emit::meaning(robot, of),
        step: of.step().map(codegen::Step::number).filter(|step| *step <= 7),
        units: [of.unit(JointKind::Revolute), of.unit(JointKind::Prismatic)],
        axes: axes(of),
        drawn: drawn(of),
    }
}

/// Returns the number of the joint whose link carries a joint or the tip; 0 is the base.
pub(crate) fn parent(robot: &Robot, joint: usize) -> usize {
    match joint {
        0 => 0,
        _ if joint > robot.joints.len() => robot.tip().on.map_or(0, |link| link + 1),
        _ => robot.parent(joint - 1).map_or(0, |parent| parent + 1),
    }
}

const fn axes(quantity: Quantity) -> Option<&'static str> {
    match quantity {
        // a rotation belongs to two frames
        Quantity::Rotation | Quantity::TipRotation => None,
        // the joint's point belongs to both links; its velocity and acceleration are in the axes of the previous one
        Quantity::JointPointVelocity | Quantity::JointPointAcceleration => Some("parent"),
        _ if quantity.is_vector() => Some("link"),
        _ => None,
    }
}

#[allow(clippy::match_same_arms)] // one line for each group of quantities
const fn drawn(quantity: Quantity) -> Option<&'static str> {
    use Quantity as Q;
    Some(match quantity {
        Q::Omega | Q::OmegaDot | Q::JointForce | Q::JointMoment | Q::JointPointVelocity => "joint",
        Q::JointPointAcceleration | Q::OriginAcceleration | Q::ReducedForce | Q::ReducedMoment => "joint",
        Q::OmegaCrossD | Q::Velocity | Q::Acceleration | Q::BaseAcceleration | Q::Gravity => "com",
        Q::InertiaForce | Q::InertiaMoment | Q::AngularMomentum | Q::MasslessForce | Q::OmegaCrossMoment => "com",
        // drawn at the next joint
        Q::ChildForce | Q::ChildMoment | Q::OmegaCrossR | Q::R => "lever",
        Q::Position | Q::Rate | Q::RateDot | Q::Torque | Q::AppliedTorque | Q::TwiceRate => "axis",
        Q::Angle | Q::Sine | Q::Cosine | Q::TurnedSine | Q::TurnedCosine | Q::Theta => "axis",
        Q::TwistSine | Q::TwistCosine | Q::ThetaSine | Q::ThetaCosine | Q::Rotation | Q::TipRotation => "frame",
        Q::D | Q::Com => "position",
        Q::Mass | Q::Inertia | Q::FirstMoment | Q::SecondMoment | Q::MasslessMoment => "link",
        _ => return None,
    })
}
