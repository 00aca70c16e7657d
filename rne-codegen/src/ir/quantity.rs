//! What a number of the recursion means: its step, quantity, joint and axis, and the name these give it in the code.

use std::fmt;

/// One of the seven steps of the lecture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Step {
    /// 1: angular velocity ω.
    AngularVelocity = 1,
    /// 2: angular acceleration ω̇.
    AngularAcceleration,
    /// 3: velocity of the centre of mass ċ.
    Velocity,
    /// 4: acceleration of the centre of mass c̈.
    Acceleration,
    /// 5: acceleration of gravity g, carried into the link's frame.
    Gravity,
    /// 6: forces and moments f, n.
    Wrenches,
    /// 7: torque τ.
    Torque,
    /// What a function makes of them, beyond the lecture.
    Beyond,
}

impl Step {
    /// All seven, in order.
    pub const ALL: [Self; 7] = [
        Self::AngularVelocity,
        Self::AngularAcceleration,
        Self::Velocity,
        Self::Acceleration,
        Self::Gravity,
        Self::Wrenches,
        Self::Torque,
    ];

    /// Its number in the lecture, 1 to 7.
    #[must_use]
    pub const fn number(self) -> usize {
        self as usize
    }

    /// What the step computes, in words.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::AngularVelocity => "angular velocity",
            Self::AngularAcceleration => "angular acceleration",
            Self::Velocity => "velocity of the centre of mass",
            Self::Acceleration => "acceleration of the centre of mass",
            Self::Gravity => "gravity in the link's frame",
            Self::Wrenches => "forces and moments",
            Self::Torque => "torque",
            Self::Beyond => "beyond the seven steps",
        }
    }
}

/// A component along one axis of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
}

impl Axis {
    /// x, y, z.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        })
    }
}

/// Which component of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Component {
    /// The quantity is one number.
    Scalar,
    /// A component of a vector.
    Vector(Axis),
    /// An element of a matrix: row, column.
    Matrix(Axis, Axis),
}

impl Component {
    /// The axis of a vector's component or of a matrix element's row.
    #[must_use]
    pub const fn axis(self) -> Option<Axis> {
        match self {
            Self::Scalar => None,
            Self::Vector(axis) | Self::Matrix(axis, _) => Some(axis),
        }
    }
}

/// A quantity of the recursion. Vectors of link i are in frame i, in form P: at joint i, fixed to link i.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    // Arguments of the function.
    /// q: joint position.
    Position,
    /// q̇: joint rate.
    Rate,
    /// q̈: joint acceleration.
    RateDot,
    /// τ of an actuator, as an argument.
    AppliedTorque,
    /// A parameter that is known at run time only.
    Parameter,

    // Constants of the table.
    /// A number without a name of its own.
    Constant,
    /// The number 2 of step 4 (prismatic joint).
    Two,
    /// The number 1 of a quotient.
    One,
    /// The number 1/2.
    Half,
    /// Rotor inertia as seen at the joint, G² Jm.
    RotorInertia,
    /// Viscous friction as seen at the joint, G² B.
    ViscousFriction,
    /// Coulomb friction as seen at the joint, |G| Tc⁺ and |G| Tc⁻.
    CoulombFriction,
    /// Constant part of a joint angle θ.
    Theta,
    /// Sine of a twist angle α.
    TwistSine,
    /// Cosine of a twist angle α.
    TwistCosine,
    /// Sine of the constant θ of a prismatic joint.
    ThetaSine,
    /// Cosine of the constant θ of a prismatic joint.
    ThetaCosine,
    /// Constant part of the offset along a prismatic joint's axis.
    Offset,
    /// c̄: centre of mass from the link frame's origin, turned into frame i.
    Com,
    /// m: mass of the link.
    Mass,
    /// r: C_i → J_{i+1}.
    R,
    /// I: inertia about the centre of mass.
    Inertia,
    /// Rotation into the tip frame, of the table's last twist and the tool.
    TipRotation,
    /// h = m c̄ of regrouped matter, about the origin of the link's frame.
    FirstMoment,
    /// S = ∫ r rᵀ dm of regrouped matter.
    SecondMoment,

    // Step 1.
    /// θ + q, where θ is no right angle.
    Angle,
    /// Sine of the joint angle.
    Sine,
    /// Cosine of the joint angle.
    Cosine,
    /// Sine of θ + q, from the sine and cosine of q.
    TurnedSine,
    /// Its cosine.
    TurnedCosine,
    /// The sum of the positions of parallel joints; the first of them is the name's index.
    GroupPosition,
    /// Constant part of the sum of their angles.
    GroupTheta,
    /// The sum of the angles of parallel joints.
    GroupAngle,
    /// Sine of such a sum.
    GroupSine,
    /// Cosine of such a sum.
    GroupCosine,
    /// A term of a rewritten graph.
    Term,
    /// R: turns components of frame i into components of frame i-1.
    Rotation,
    /// ω: angular velocity.
    Omega,
    /// ω in frame N, on the axis but not turning with the joint.
    OmegaUnturned,
    // Step 2.
    /// ω̇: angular acceleration.
    OmegaDot,
    /// U = ω̇× + ω× ω×: accelerations of the points of a link.
    Gradient,
    /// U in frame N.
    GradientUnturned,
    // Step 3.
    /// ω × r: velocity of the next joint as seen from the centre of mass.
    OmegaCrossR,
    /// d: J_i → C_i. Constant for a revolute joint.
    D,
    /// ω × d: velocity of the centre of mass as seen from the joint.
    OmegaCrossD,
    /// ċ: velocity of the centre of mass.
    Velocity,
    // Step 4.
    /// Acceleration of the joint's point J_i, in frame i-1.
    JointPointAcceleration,
    /// 2 q̇ of a prismatic joint.
    TwiceRate,
    /// c̈: acceleration of the centre of mass.
    Acceleration,
    /// a: acceleration of the frame's origin, less gravity.
    OriginAcceleration,
    /// a in frame N.
    OriginAccelerationUnturned,
    // Step 5.
    /// g: acceleration of gravity.
    Gravity,
    // Step 6.
    /// f_{i,i+1}, turned into frame i.
    ChildForce,
    /// n_{i,i+1}, turned into frame i.
    ChildMoment,
    /// f_i = m c̈.
    InertiaForce,
    /// I ω: angular momentum about the centre of mass.
    AngularMomentum,
    /// n_i = I ω̇ + ω × I ω.
    InertiaMoment,
    /// f_{i-1,i}: force exerted by link i-1 on link i.
    JointForce,
    /// n_{i-1,i}: moment exerted by link i-1 on link i, about J_i.
    JointMoment,
    /// f: force on a link and all behind it, of regrouped matter.
    ReducedForce,
    /// n: moment on a link and all behind it, of regrouped matter.
    ReducedMoment,
    /// f of the next joint in the axes of this link, or of its frame N.
    TurnedForce,
    /// n of the next joint there.
    TurnedMoment,
    /// First moment of all bodies behind a joint.
    CompositeFirstMoment,
    /// Their second moment.
    CompositeSecondMoment,
    /// Force for a unit acceleration of one joint.
    UnitForce,
    /// Moment for it.
    UnitMoment,
    // Step 7.
    /// τ: torque of a revolute, force of a prismatic joint.
    Torque,

    // Beyond the seven steps.
    /// A term that has no meaning of its own.
    Partial,
    /// Rotation from the axes of a frame to those of the world.
    FrameRotation,
    /// Origin of a frame in the world.
    FrameOrigin,
    /// A column of the Jacobian, linear rows.
    JacobianLinear,
    /// A column of the Jacobian, angular rows.
    JacobianAngular,
    /// Acceleration of the tip, linear and angular.
    TipAcceleration,
    /// Centre of mass in frame 0.
    ComPosition,
    /// T
    KineticEnergy,
    /// V
    PotentialEnergy,
    /// An element of the Coriolis matrix.
    CoriolisElement,
    /// An element of the regressor.
    RegressorElement,
    /// L of M = L D Lᵀ.
    LowerFactor,
    /// L D.
    ScaledFactor,
    /// D
    Pivot,
    /// 1/D
    InversePivot,
    /// τ less the bias torque, then solved with L.
    Reduced,
    /// The same times 1/D.
    Scaled,
    /// What a motor adds.
    ActuatorTorque,
}

impl Quantity {
    /// The step that computes it; `None` for arguments and constants.
    #[must_use]
    pub const fn step(self) -> Option<Step> {
        match self {
            Self::Angle
            | Self::Sine
            | Self::Cosine
            | Self::TurnedSine
            | Self::TurnedCosine
            | Self::GroupPosition
            | Self::GroupAngle
            | Self::GroupSine
            | Self::GroupCosine
            | Self::Rotation
            | Self::Omega
            | Self::OmegaUnturned => Some(Step::AngularVelocity),
            Self::OmegaDot | Self::Gradient | Self::GradientUnturned => Some(Step::AngularAcceleration),
            Self::Velocity => Some(Step::Velocity),
            Self::OmegaCrossR
            | Self::D
            | Self::OmegaCrossD
            | Self::JointPointAcceleration
            | Self::TwiceRate
            | Self::OriginAcceleration
            | Self::OriginAccelerationUnturned
            | Self::Acceleration => Some(Step::Acceleration),
            Self::Gravity => Some(Step::Gravity),
            Self::ChildForce
            | Self::ChildMoment
            | Self::InertiaForce
            | Self::AngularMomentum
            | Self::InertiaMoment
            | Self::ReducedForce
            | Self::ReducedMoment
            | Self::TurnedForce
            | Self::TurnedMoment
            | Self::CompositeFirstMoment
            | Self::CompositeSecondMoment
            | Self::UnitForce
            | Self::UnitMoment
            | Self::JointForce
            | Self::JointMoment => Some(Step::Wrenches),
            Self::Torque => Some(Step::Torque),
            Self::Partial
            | Self::FrameRotation
            | Self::FrameOrigin
            | Self::JacobianLinear
            | Self::JacobianAngular
            | Self::TipAcceleration
            | Self::ComPosition
            | Self::KineticEnergy
            | Self::PotentialEnergy
            | Self::CoriolisElement
            | Self::RegressorElement
            | Self::LowerFactor
            | Self::ScaledFactor
            | Self::Pivot
            | Self::InversePivot
            | Self::Reduced
            | Self::Scaled
            | Self::ActuatorTorque => Some(Step::Beyond),
            _ => None,
        }
    }

    /// Whether the lecture gives it a letter of its own, or the reduced form does: then each of its components is a
    /// statement.
    #[must_use]
    pub const fn is_of_the_lecture(self) -> bool {
        matches!(
            self,
            Self::Omega
                | Self::OmegaDot
                | Self::Velocity
                | Self::Acceleration
                | Self::Gravity
                | Self::InertiaForce
                | Self::InertiaMoment
                | Self::JointForce
                | Self::JointMoment
                | Self::OriginAcceleration
                | Self::OriginAccelerationUnturned
                | Self::ReducedForce
                | Self::ReducedMoment
                | Self::TurnedForce
                | Self::TurnedMoment
                | Self::Torque
                | Self::FrameRotation
                | Self::FrameOrigin
                | Self::JacobianLinear
                | Self::JacobianAngular
                | Self::ComPosition
                | Self::LowerFactor
                | Self::Pivot
                | Self::InversePivot
                | Self::Reduced
                | Self::Scaled
        )
    }

    /// Whether it is an angle, or a sum that becomes one.
    #[must_use]
    pub const fn is_of_an_angle(self) -> bool {
        matches!(self, Self::Angle | Self::GroupAngle | Self::GroupPosition)
    }

    /// How its names begin.
    pub(crate) const fn prefix(self) -> &'static str {
        match self {
            Self::Position | Self::GroupPosition => "q",
            Self::Rate => "qd",
            Self::RateDot => "qdd",
            Self::Constant => "k",
            Self::Two => "two",
            Self::Theta | Self::GroupTheta => "theta",
            Self::TwistSine => "sa",
            Self::TwistCosine => "ca",
            Self::ThetaSine => "st",
            Self::ThetaCosine => "ct",
            Self::Offset => "b",
            Self::Com => "com",
            Self::Mass => "m",
            Self::R => "r",
            Self::Inertia => "i",
            Self::TipRotation | Self::Rotation => "rot",
            Self::SecondMoment => "p",
            Self::OmegaUnturned => "wn",
            Self::Gradient => "u",
            Self::GradientUnturned => "un",
            Self::OriginAcceleration => "a",
            Self::OriginAccelerationUnturned => "an",
            Self::Angle | Self::GroupAngle => "angle",
            Self::Sine | Self::GroupSine => "s",
            Self::Cosine | Self::GroupCosine => "c",
            Self::TurnedSine => "sj",
            Self::TurnedCosine => "cj",
            Self::Term => "t",
            Self::Omega => "w",
            Self::OmegaDot => "dw",
            Self::OmegaCrossR => "wxr",
            Self::D => "d",
            Self::OmegaCrossD => "wxd",
            Self::Velocity => "dc",
            Self::JointPointAcceleration => "ddj",
            Self::TwiceRate => "twice_qd",
            Self::Acceleration => "ddc",
            Self::Gravity => "g",
            Self::ChildForce | Self::TurnedForce => "fc",
            Self::ChildMoment | Self::TurnedMoment => "nc",
            Self::InertiaForce | Self::JointForce | Self::ReducedForce => "f",
            Self::AngularMomentum | Self::FirstMoment => "h",
            Self::InertiaMoment | Self::JointMoment | Self::ReducedMoment => "n",
            Self::Torque | Self::AppliedTorque => "tau",
            Self::Parameter => "par",
            Self::One => "one",
            Self::Half => "half",
            Self::RotorInertia => "jm",
            Self::ViscousFriction => "bv",
            Self::CoulombFriction => "tc",
            Self::CompositeFirstMoment => "hc",
            Self::CompositeSecondMoment => "pc",
            Self::UnitForce => "fu",
            Self::UnitMoment => "nu",
            Self::Partial => "x",
            Self::FrameRotation => "frame",
            Self::FrameOrigin => "origin",
            Self::JacobianLinear => "jv",
            Self::JacobianAngular => "jw",
            Self::TipAcceleration => "acc",
            Self::ComPosition => "pos",
            Self::KineticEnergy => "kinetic",
            Self::PotentialEnergy => "potential",
            Self::CoriolisElement => "cor",
            Self::RegressorElement => "y",
            Self::LowerFactor => "low",
            Self::ScaledFactor => "lowd",
            Self::Pivot => "pivot",
            Self::InversePivot => "inv",
            Self::Reduced => "rhs",
            Self::Scaled => "sol",
            Self::ActuatorTorque => "act",
        }
    }

    /// How its names look, for the legend of a listing: `wi_x`.
    #[must_use]
    pub fn pattern(self) -> String {
        let prefix = self.prefix();
        match self {
            Self::Two | Self::One | Self::Half | Self::KineticEnergy | Self::PotentialEnergy => prefix.to_owned(),
            Self::CoriolisElement | Self::LowerFactor | Self::ScaledFactor => format!("{prefix}i_j"),
            Self::RegressorElement => format!("{prefix}i_j_1"),
            Self::Constant | Self::Term => format!("{prefix}_1"),
            Self::GroupPosition | Self::GroupTheta | Self::GroupAngle | Self::GroupSine | Self::GroupCosine => {
                format!("{prefix}h_i")
            }
            Self::JointForce | Self::JointMoment => format!("{prefix}h_i_x"),
            Self::Inertia
            | Self::Rotation
            | Self::TipRotation
            | Self::SecondMoment
            | Self::Gradient
            | Self::FrameRotation
            | Self::CompositeSecondMoment
            | Self::GradientUnturned => format!("{prefix}i_xy"),
            Self::Position
            | Self::Rate
            | Self::RateDot
            | Self::Theta
            | Self::TwistSine
            | Self::TwistCosine
            | Self::ThetaSine
            | Self::ThetaCosine
            | Self::Offset
            | Self::Mass
            | Self::Angle
            | Self::Sine
            | Self::Cosine
            | Self::TurnedSine
            | Self::TurnedCosine
            | Self::TwiceRate
            | Self::AppliedTorque
            | Self::Parameter
            | Self::RotorInertia
            | Self::ViscousFriction
            | Self::CoulombFriction
            | Self::Partial
            | Self::Pivot
            | Self::InversePivot
            | Self::Reduced
            | Self::Scaled
            | Self::ActuatorTorque
            | Self::Torque => format!("{prefix}i"),
            _ => format!("{prefix}i_x"),
        }
    }

    /// What its name stands for, for the legend of a listing.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Position => "joint position",
            Self::Rate => "joint rate",
            Self::RateDot => "joint acceleration",
            Self::Constant => "a number",
            Self::Two => "the number 2",
            Self::Theta => "constant part of the joint angle",
            Self::TwistSine => "sine of the twist α",
            Self::TwistCosine => "cosine of the twist α",
            Self::ThetaSine => "sine of the constant θ",
            Self::ThetaCosine => "cosine of the constant θ",
            Self::Offset => "constant part of the offset along the axis",
            Self::Com => "centre of mass from the link frame's origin",
            Self::Mass => "mass",
            Self::R => "r: centre of mass → next joint",
            Self::Inertia => "inertia about the centre of mass",
            Self::TipRotation => "rotation from the last link to the tip frame",
            Self::Angle => "θ + q",
            Self::Sine => "sine of the joint angle",
            Self::Cosine => "cosine of the joint angle",
            Self::TurnedSine => "sine of θ + q, from those of q",
            Self::GroupPosition => "sum of the positions of joints h to i, whose axes are parallel",
            Self::GroupTheta => "constant part of the sum of their angles",
            Self::GroupAngle => "sum of the angles of joints h to i, whose axes are parallel",
            Self::GroupSine => "its sine",
            Self::TurnedCosine | Self::GroupCosine => "its cosine",
            Self::Term | Self::Partial => "a term that has no meaning of its own",
            Self::Rotation => "R: frame i → frame i-1",
            Self::FirstMoment => "first moment of regrouped matter about the frame's origin",
            Self::SecondMoment => "second moment ∫ r rᵀ dm of regrouped matter",
            Self::Omega => "ω: angular velocity",
            Self::OmegaUnturned => "ω in frame N, on the axis but not turning with the joint",
            Self::Gradient => "U = [ω̇]× + [ω]×[ω]×",
            Self::GradientUnturned => "U in frame N",
            Self::OriginAcceleration => "acceleration of the frame's origin, less gravity",
            Self::OriginAccelerationUnturned => "the same in frame N",
            Self::ReducedForce => "force on the link and all behind it, of regrouped matter",
            Self::TurnedForce => "f of the next joint, in the axes of this link or of its frame N",
            Self::TurnedMoment => "n of the next joint there",
            Self::ReducedMoment => "moment on the link and all behind it, of regrouped matter",
            Self::OmegaDot => "ω̇: angular acceleration",
            Self::OmegaCrossR => "ω × r",
            Self::D => "d: joint → centre of mass",
            Self::OmegaCrossD => "ω × d",
            Self::Velocity => "ċ: velocity of the centre of mass",
            Self::JointPointAcceleration => "acceleration of the joint's point, in the frame before it",
            Self::TwiceRate => "2 q̇",
            Self::Acceleration => "c̈: acceleration of the centre of mass",
            Self::Gravity => "g: acceleration of gravity",
            Self::ChildForce => "f of the next joint, turned into this frame",
            Self::ChildMoment => "n of the next joint, turned into this frame",
            Self::InertiaForce => "f = m c̈",
            Self::AngularMomentum => "I ω",
            Self::InertiaMoment => "n = I ω̇ + ω × I ω",
            Self::JointForce => "force exerted by link h = i - 1 on link i",
            Self::JointMoment => "moment exerted by link h = i - 1 on link i, about joint i",
            Self::Torque => "τ: joint torque (force, for a prismatic joint)",
            Self::CompositeFirstMoment => "first moment of all links from i on, as one body",
            Self::CompositeSecondMoment => "their second moment ∫ r rᵀ dm",
            Self::UnitForce => "force on link i and all behind it, for q̈ = 1 of one joint",
            Self::UnitMoment => "moment on them",
            Self::AppliedTorque => "τ of the actuator",
            Self::Parameter => "a parameter of the robot file that is given at run time",
            Self::One => "the number 1",
            Self::Half => "the number 1/2",
            Self::RotorInertia => "rotor inertia at the joint, G² Jm",
            Self::ViscousFriction => "viscous friction at the joint, G² B",
            Self::CoulombFriction => "Coulomb friction at the joint, |G| Tc",
            Self::FrameRotation => "rotation from the axes of frame i to those of the world; of the tip for i = n + 1",
            Self::FrameOrigin => "origin of that frame in the world",
            Self::JacobianLinear => "velocity of the tip per rate of joint i, world axes",
            Self::JacobianAngular => "angular velocity of the tip per rate of joint i, world axes",
            Self::TipAcceleration => "acceleration of the tip where joints do not accelerate",
            Self::ComPosition => "centre of mass in frame 0",
            Self::KineticEnergy => "kinetic energy",
            Self::PotentialEnergy => "potential energy",
            Self::CoriolisElement => "element (i, j) of the Coriolis matrix",
            Self::RegressorElement => "torque i per parameter of link j",
            Self::LowerFactor => "element (i, j) of L, M = L D Lᵀ",
            Self::ScaledFactor => "the same times D",
            Self::Pivot => "element i of D",
            Self::InversePivot => "1/D",
            Self::Reduced => "L⁻¹ (τ - bias)",
            Self::Scaled => "the same divided by D",
            Self::ActuatorTorque => "what the motor adds",
        }
    }
}
