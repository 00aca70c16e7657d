//! The meaning of a number of the recursion: its step, quantity, joint and axis, and its name in the code.

use std::fmt;

use rne_model::JointKind;

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
    /// 5: acceleration of gravity g, rotated into the link's frame.
    Gravity,
    /// 6: forces and moments f, n.
    Wrenches,
    /// 7: torque τ.
    Torque,
    /// Formulas of a function beyond the lecture.
    Beyond,
}

impl Step {
    /// All seven steps, in order.
    pub const ALL: [Self; 7] = [
        Self::AngularVelocity,
        Self::AngularAcceleration,
        Self::Velocity,
        Self::Acceleration,
        Self::Gravity,
        Self::Wrenches,
        Self::Torque,
    ];

    /// The number of a step: 0 for no step, 8 for a formula beyond the lecture.
    const fn of(number: usize) -> Option<Self> {
        match number {
            0 => None,
            1..=7 => Some(Self::ALL[number - 1]),
            _ => Some(Self::Beyond),
        }
    }

    /// Its number in the lecture, 1 to 7.
    #[must_use]
    pub const fn number(self) -> usize {
        self as usize
    }

    /// The title of the step, in words.
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
        f.write_str(["x", "y", "z"][*self as usize])
    }
}

/// A component of a quantity.
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

/// The indices that follow the beginning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Indices {
    /// No index: the quantity exists once.
    Alone,
    /// A running number.
    Counted,
    /// The joint.
    Joint,
    /// The joint and the axis.
    Vector,
    /// The joint, row and column.
    Matrix,
    /// The joint as the row of a matrix, and the column.
    Column,
    /// The joint, the link and which of its parameters.
    Parameter,
    /// The first and the last joint of a group.
    Group,
    /// Both links of a joint, as in f_{i-1,i}, and the axis.
    Links,
}

impl Indices {
    /// The pattern of the indices in a legend, such as `i_x`.
    const fn pattern(self) -> &'static str {
        match self {
            Self::Alone => "",
            Self::Counted => "_1",
            Self::Joint => "i",
            Self::Vector => "i_x",
            Self::Matrix => "i_xy",
            Self::Column => "i_j",
            Self::Parameter => "i_j_1",
            Self::Group => "h_i",
            Self::Links => "h_i_x",
        }
    }
}

/// A row of the table of quantities; the methods of [`Quantity`] document its columns.
struct Row {
    prefix: &'static str,
    indices: Indices,
    step: Option<Step>,
    has_statements: bool,
    letter: &'static str,
    unit: &'static str,
    meaning: &'static str,
}

/// Makes the enumeration of the quantities and the table of their properties from one row for each quantity.
macro_rules! quantities {
    ($(
        $quantity:ident: $prefix:literal, $indices:ident, $step:literal, $has_statements:literal, $letter:literal,
        $unit:literal, $meaning:literal;
    )*) => {
        /// A quantity of the recursion. Vectors of link i are in axes of frame i in form P (proximal): this frame is at
        /// joint i and fixed to link i.
        #[allow(rustdoc::broken_intra_doc_links)] // [ω]× is no link
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Quantity {
            $(#[doc = $meaning] $quantity,)*
        }

        /// The row of each quantity, in the order of the variants.
        static TABLE: &[Row] = &[$(Row {
            prefix: $prefix,
            indices: Indices::$indices,
            step: Step::of($step),
            has_statements: $has_statements,
            letter: $letter,
            unit: $unit,
            meaning: $meaning,
        },)*];
    };
}

quantities! {
    // quantity                 its name, indices, step (0: none, 8: beyond), statements of its own, letter, unit (of a
    //                          revolute joint | of a prismatic one), meaning
    // Arguments of the function.
    Position:                   "q",         Joint,     0, false, "q", "rad|m", "joint position";
    Rate:                       "qd",        Joint,     0, false, "q̇", "rad/s|m/s", "joint rate";
    RateDot:                    "qdd",       Joint,     0, false, "q̈", "rad/s²|m/s²", "joint acceleration";
    AppliedTorque:              "tau",       Joint,     0, false, "τ", "N m|N", "τ of the actuator";
    Parameter:                  "par",       Joint,     0, false, "p", "",
        "a parameter of the robot file that is given at run time";

    // Constants of the table.
    Constant:                   "k",         Counted,   0, false, "k", "", "a number";
    Two:                        "two",       Alone,     0, false, "2", "", "the number 2";
    One:                        "one",       Alone,     0, false, "1", "", "the number 1";
    Half:                       "half",      Alone,     0, false, "1/2", "", "the number 1/2";
    RotorInertia:               "jm",        Joint,     0, false, "Jm", "kg m²|kg",
        "rotor inertia at the joint, G² Jm";
    ViscousFriction:            "bv",        Joint,     0, false, "B", "N m s/rad|N s/m",
        "viscous friction at the joint, G² B";
    CoulombFriction:            "tc",        Joint,     0, false, "Tc", "N m|N",
        "Coulomb friction at the joint, |G| Tc";
    Theta:                      "theta",     Joint,     0, false, "θ", "rad", "constant part of the joint angle";
    TwistSine:                  "sa",        Joint,     0, false, "sα", "", "sine of the twist α";
    TwistCosine:                "ca",        Joint,     0, false, "cα", "", "cosine of the twist α";
    ThetaSine:                  "st",        Joint,     0, false, "sθ", "", "sine of the constant θ";
    ThetaCosine:                "ct",        Joint,     0, false, "cθ", "", "cosine of the constant θ";
    Offset:                     "b",         Joint,     0, false, "b", "m",
        "constant part of the offset along the axis";
    Com:                        "com",       Vector,    0, false, "com", "m",
        "centre of mass from the link frame's origin";
    Mass:                       "m",         Joint,     0, false, "m", "kg", "mass";
    R:                          "r",         Vector,    0, false, "r", "m", "r: centre of mass → next joint";
    Inertia:                    "i",         Matrix,    0, false, "I", "kg m²", "inertia about the centre of mass";
    TipRotation:                "rot",       Matrix,    0, false, "R", "",
        "rotation from the last link to the tip frame";
    FirstMoment:                "h",         Vector,    0, false, "h", "kg m",
        "first moment of regrouped matter about the frame's origin";
    SecondMoment:               "p",         Matrix,    0, false, "P", "kg m²",
        "second moment ∫ r rᵀ dm of regrouped matter";

    // Step 1.
    FollowerPosition:           "q",         Joint,     1, false, "q", "rad|m",
        "position of a joint that follows others";
    FollowerRate:               "qd",        Joint,     1, false, "q̇", "rad/s|m/s", "its rate";
    FollowerRateDot:            "qdd",       Joint,     2, false, "q̈", "rad/s²|m/s²", "its acceleration";
    Angle:                      "angle",     Joint,     1, false, "θ", "rad", "θ + q";
    Sine:                       "s",         Joint,     1, false, "s", "", "sine of the joint angle";
    Cosine:                     "c",         Joint,     1, false, "c", "", "cosine of the joint angle";
    TurnedSine:                 "sj",        Joint,     1, false, "s", "", "sine of θ + q, from those of q";
    TurnedCosine:               "cj",        Joint,     1, false, "c", "", "its cosine";
    GroupPosition:              "q",         Group,     1, false, "q", "rad",
        "sum of the positions of joints h to i, whose axes are parallel";
    GroupTheta:                 "theta",     Group,     0, false, "θ", "rad",
        "constant part of the sum of their angles";
    GroupAngle:                 "angle",     Group,     1, false, "θ", "rad",
        "sum of the angles of joints h to i, whose axes are parallel";
    GroupSine:                  "s",         Group,     1, false, "s", "", "its sine";
    GroupCosine:                "c",         Group,     1, false, "c", "", "its cosine";
    Term:                       "t",         Counted,   0, false, "t", "", "a term that has no meaning of its own";
    Rotation:                   "rot",       Matrix,    1, false, "R", "", "R: frame i → frame i-1";
    Omega:                      "w",         Vector,    1, true,  "ω", "rad/s", "ω: angular velocity";
    OmegaUnturned:              "wn",        Vector,    1, false, "ωN", "rad/s",
        "ω in frame N, on the axis but not turning with the joint";

    // Step 2.
    OmegaDot:                   "dw",        Vector,    2, true,  "ω̇", "rad/s²", "ω̇: angular acceleration";
    Gradient:                   "u",         Matrix,    2, false, "U", "1/s²", "U = [ω̇]× + [ω]×[ω]×";
    GradientUnturned:           "un",        Matrix,    2, false, "UN", "1/s²", "U in frame N";

    // Step 3.
    OmegaCrossR:                "wxr",       Vector,    4, false, "(ω×r)", "m/s", "ω × r";
    D:                          "d",         Vector,    4, false, "d", "m", "d: joint → centre of mass";
    JointPointVelocity:         "dj",        Vector,    3, false, "j̇", "m/s",
        "velocity of the joint's point, in the frame before it";
    OmegaCrossD:                "wxd",       Vector,    4, false, "(ω×d)", "m/s", "ω × d";
    Velocity:                   "dc",        Vector,    3, true,  "ċ", "m/s", "ċ: velocity of the centre of mass";

    // Step 4.
    JointPointAcceleration:     "ddj",       Vector,    4, false, "j̈", "m/s²",
        "acceleration of the joint's point, in the frame before it";
    TwiceRate:                  "twice_qd",  Joint,     4, false, "2q̇", "rad/s|m/s", "2 q̇";
    Acceleration:               "ddc",       Vector,    4, true,  "c̈", "m/s²",
        "c̈: acceleration of the centre of mass";
    BaseAcceleration:           "ddcb",      Vector,    4, true,  "c̈", "m/s²",
        "c̈: acceleration of the centre of mass of a floating base";
    OriginAcceleration:         "a",         Vector,    4, true,  "a", "m/s²",
        "acceleration of the frame's origin, less gravity";
    OriginAccelerationUnturned: "an",        Vector,    4, true,  "aN", "m/s²", "the same in frame N";

    // Step 5.
    Gravity:                    "g",         Vector,    5, true,  "g", "m/s²", "g: acceleration of gravity";

    // Step 6.
    ChildForce:                 "fc",        Vector,    6, false, "f", "N",
        "f of the next joint, turned into this frame";
    ChildMoment:                "nc",        Vector,    6, false, "n", "N m",
        "n of the next joint, turned into this frame";
    InertiaForce:               "f",         Vector,    6, true,  "f", "N", "f = m c̈";
    AngularMomentum:            "h",         Vector,    6, false, "(Iω)", "N m s", "I ω";
    InertiaMoment:              "n",         Vector,    6, true,  "n", "N m", "n = I ω̇ + ω × I ω";
    JointForce:                 "f",         Links,     6, true,  "f", "N",
        "force exerted by link h = i - 1 on link i";
    JointMoment:                "n",         Links,     6, true,  "n", "N m",
        "moment exerted by link h = i - 1 on link i, about joint i";
    ReducedForce:               "f",         Vector,    6, true,  "f", "N",
        "force on the link and all behind it, of regrouped matter";
    ReducedMoment:              "n",         Vector,    6, true,  "n", "N m",
        "moment on the link and all behind it, of regrouped matter";
    TurnedForce:                "fc",        Vector,    6, true,  "f", "N",
        "f of the next joint, in the axes of this link or of its frame N";
    TurnedMoment:               "nc",        Vector,    6, true,  "n", "N m", "n of the next joint there";
    CompositeFirstMoment:       "hc",        Vector,    6, false, "h", "kg m",
        "first moment of all links from i on, as one body";
    CompositeSecondMoment:      "pc",        Matrix,    6, false, "P", "kg m²", "their second moment ∫ r rᵀ dm";
    UnitForce:                  "fu",        Vector,    6, false, "f", "N",
        "force on link i and all behind it, for q̈ = 1 of one joint";
    UnitMoment:                 "nu",        Vector,    6, false, "n", "N m", "moment on them";

    // Step 7.
    Torque:                     "tau",       Joint,     7, true,  "τ", "N m|N",
        "τ: joint torque (force, for a prismatic joint)";

    // Beyond the seven steps.
    Partial:                    "x",         Joint,     8, false, "", "", "a term that has no meaning of its own";
    FrameRotation:              "frame",     Matrix,    8, true,  "", "",
        "rotation from the axes of frame i to those of the world; of the tip for i = n + 1";
    FrameOrigin:                "origin",    Vector,    8, true,  "", "", "origin of that frame in the world";
    JacobianLinear:             "jv",        Vector,    8, true,  "", "",
        "velocity of the tip per rate of joint i, world axes";
    JacobianAngular:            "jw",        Vector,    8, true,  "", "",
        "angular velocity of the tip per rate of joint i, world axes";
    TipAcceleration:            "acc",       Vector,    8, false, "", "",
        "acceleration of the tip where joints do not accelerate";
    ComPosition:                "pos",       Vector,    8, true,  "", "", "centre of mass in frame 0";
    Kinetic:                    "kinetic",   Alone,     8, false, "", "J", "kinetic energy";
    Potential:                  "potential", Alone,     8, false, "", "J", "potential energy";
    CoriolisElement:            "cor",       Column,    8, false, "", "", "element (i, j) of the Coriolis matrix";
    RegressorElement:           "y",         Parameter, 8, false, "", "", "torque i per parameter of link j";
    LowerFactor:                "low",       Column,    8, true,  "", "", "element (i, j) of L, M = L D Lᵀ";
    ScaledFactor:               "lowd",      Column,    8, false, "", "", "the same times D";
    Pivot:                      "pivot",     Joint,     8, true,  "", "", "element i of D";
    InversePivot:               "inv",       Joint,     8, true,  "", "", "1/D";
    Reduced:                    "rhs",       Joint,     8, true,  "", "", "L⁻¹ (τ - bias)";
    Scaled:                     "sol",       Joint,     8, true,  "", "", "the same divided by D";
    ActuatorTorque:             "act",       Joint,     8, false, "", "", "what the motor adds";

    // Quantities of a link with a first moment but no mass. They are not among the rows above, because the random
    // numbers of sample points depend on the index of a quantity.
    MasslessMoment:             "mc",        Vector,    0, false, "h", "kg m",
        "first moment of a link without mass";
    OmegaCrossMoment:           "wxh",       Vector,    6, false, "(ω×h)", "kg m/s", "ω × h";
    MasslessForce:              "uh",        Vector,    6, false, "(Uh)", "N", "ω̇ × h + ω × (ω × h)";

    // Quantities of the momentum, beyond the seven steps.
    MomentBehind:               "mb",        Vector,    8, false, "", "",
        "first moment of link i and all behind it, about joint i";
    LinearMomentum:             "lin",       Vector,    8, true,  "", "",
        "linear momentum of link i and all behind it";
    AngularMomentumBehind:      "ang",       Vector,    8, true,  "", "",
        "their angular momentum about joint i";
    TurnedMomentBehind:         "mbc",       Vector,    8, false, "", "",
        "first moment behind the next joint, turned into this frame";
    TurnedLinearMomentum:       "linc",      Vector,    8, false, "", "", "linear momentum there";
    TurnedAngularMomentum:      "angc",      Vector,    8, false, "", "", "angular momentum there";
    OriginVelocity:             "v",         Vector,    8, true,  "", "", "velocity of the frame's origin";
    OriginVelocityUnturned:     "vn",        Vector,    8, false, "", "", "the same in frame N";
    Momentum:                   "mom",       Joint,     8, true,  "", "",
        "momentum of joint i, row i of M q̇";
    MomentumRate:               "rate",      Joint,     8, true,  "", "",
        "its rate without external torques, τ + ∂T/∂q - ∂V/∂q";

    // Quantity of step 7, for joints that follow others and for joints that are followed.
    AxisTorque:                 "axis_tau",  Joint,     7, false, "τ'", "N m|N",
        "τ': what this joint needs of a torque; followers are part of the torques that move them";

    // Quantities of the rotors in the list `motors` of a robot file: i is the first joint with which rotor j turns.
    SpinInertia:                "jr",        Column,    0, false, "Jr", "kg m²", "inertia of rotor j about its axis";
    Spin:                       "spin",      Column,    6, false, "s", "rad/s",
        "spin of rotor j relative to the link that carries it";
    SpinDot:                    "dspin",     Column,    6, false, "ṡ", "rad/s²", "its acceleration";

    // Quantities of named tips; i is the number of the tip, from 1.
    TipForce:                   "ft",        Vector,    0, false, "f", "N",
        "force that the robot exerts at tip i, in axes of the tip";
    TipMoment:                  "nt",        Vector,    0, false, "n", "N m",
        "moment that the robot exerts at tip i, about the origin of the tip";

    // Quantities of a floating base; i is 0.
    BaseForce:                  "fb",        Vector,    6, true,  "f", "N",
        "force that must act on the base beside gravity, in axes of frame 0";
    BaseMoment:                 "nb",        Vector,    6, true,  "n", "N m",
        "moment that must act on the base, about the origin of frame 0";
    CentroidalMoment:           "nm",        Vector,    6, true,  "n", "N m",
        "moment about the centre of mass of the robot, in axes of frame 0";
    BaseRotation:               "rb",        Matrix,    0, false, "R", "",
        "rotation of the base: its columns are the axes of frame 0 in the world";
    ContactDamping:             "mu",        Alone,     0, false, "μ", "1/kg",
        "what is added to the diagonal of J M⁻¹ Jᵀ";
    ContactForce:               "fk",        Vector,    8, true,  "", "",
        "force of the contact at tip i on the robot, in world axes";
    ContactMoment:              "nk",        Vector,    8, true,  "", "",
        "its moment about the origin of the tip";

    // Quantities of closed loops; i is a dependent joint.
    LoopMap:                    "map",       Column,    8, true,  "", "", "velocity of joint i per velocity of joint j";
    LoopBias:                   "bias",      Joint,     8, true,  "", "rad/s²|m/s²",
        "acceleration of joint i where the joints that move by themselves do not accelerate";
    ClosedPosition:             "closed",    Joint,     8, true,  "", "rad|m",
        "position of joint i after a Newton step";
    Residual:                   "left",      Joint,     8, true,  "", "", "what is left of equation i of the loops";

    // Quantities of the sum of torques weighted by multipliers.
    Multiplier:                 "lam",       Joint,     0, false, "λ", "", "multiplier of the torque of joint i";
    WeightedTorque:             "lt",        Alone,     8, true,  "", "", "sum of the torques times the multipliers";

    // Quantities of the time derivative of the Jacobian.
    JacobianLinearRate:         "jvd",       Vector,    8, true,  "", "",
        "rate of the velocity of the tip per rate of joint i, world axes";
    JacobianAngularRate:        "jwd",       Vector,    8, true,  "", "",
        "rate of the angular velocity of the tip per rate of joint i, world axes";
    WeightedByPosition:         "lt_q",      Joint,     8, true,  "", "", "its derivative by the position of joint i";
    WeightedByRate:             "lt_qd",     Joint,     8, true,  "", "", "its derivative by the rate of joint i";

    // Quantities of one step of an integrator.
    Duration:                   "h",         Alone,     0, false, "", "s", "duration of the step";
    NextPosition:               "next_q",    Joint,     8, true,  "", "rad|m", "position after the step";
    NextRate:                   "next_qd",   Joint,     8, true,  "", "rad/s|m/s", "velocity after the step";
    NextRotation:               "next_r",    Matrix,    8, true,  "", "",
        "rotation of the base after the step: its columns are the axes of frame 0 in the world";
    NextOrigin:                 "next_p",    Vector,    8, true,  "", "m",
        "origin of frame 0 in the world after the step";
    NextVelocity:               "next_v",    Vector,    8, true,  "", "m/s",
        "its velocity after the step, in axes of frame 0";
    NextOmega:                  "next_w",    Vector,    8, true,  "", "rad/s",
        "angular velocity of the base after the step, in axes of frame 0";
    BaseShift:                  "shift",     Vector,    0, false, "", "m",
        "shift of the base before the step, along the axes of frame 0";
    BaseTurn:                   "turn",      Vector,    0, false, "", "rad",
        "turn of the base before the step, about the axes of frame 0";
    NextTurn:                   "next_turn", Vector,    8, true,  "", "rad",
        "turn of the base after the step, about the axes that frame 0 has then";
}

impl Quantity {
    const fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }

    /// The step that computes it; `None` for arguments and constants.
    #[must_use]
    pub const fn step(self) -> Option<Step> {
        self.row().step
    }

    /// Whether each component gets a statement of its own.
    #[must_use]
    pub const fn is_of_the_lecture(self) -> bool {
        self.row().has_statements
    }

    /// The quantity that results if the recursion has rates in place of accelerations, such as a momentum for a torque;
    /// `None` if the value has no name then.
    pub(crate) const fn of_momentum(self) -> Option<Self> {
        Some(match self {
            Self::Omega | Self::OmegaUnturned | Self::Gradient | Self::GradientUnturned | Self::AxisTorque => {
                return None;
            }
            Self::OmegaDot => Self::Omega,
            Self::OriginAcceleration => Self::OriginVelocity,
            Self::OriginAccelerationUnturned => Self::OriginVelocityUnturned,
            Self::ReducedForce | Self::BaseForce => Self::LinearMomentum,
            Self::ReducedMoment | Self::BaseMoment => Self::AngularMomentumBehind,
            Self::TurnedForce => Self::TurnedLinearMomentum,
            Self::TurnedMoment => Self::TurnedAngularMomentum,
            Self::Torque => Self::Momentum,
            other => other,
        })
    }

    /// Whether it is an angle, or a sum that becomes one.
    #[must_use]
    pub const fn is_of_an_angle(self) -> bool {
        matches!(self, Self::Angle | Self::GroupAngle | Self::GroupPosition | Self::FollowerPosition)
    }

    /// The quantity that replaces an argument of a joint at a joint that follows others.
    pub(crate) const fn of_follower(self) -> Option<Self> {
        Some(match self {
            Self::Position => Self::FollowerPosition,
            Self::Rate => Self::FollowerRate,
            Self::RateDot => Self::FollowerRateDot,
            _ => return None,
        })
    }

    /// How its names begin.
    pub(crate) const fn prefix(self) -> &'static str {
        self.row().prefix
    }

    /// The indices that the names of the quantity have.
    pub(crate) const fn indices(self) -> Indices {
        self.row().indices
    }

    /// The pattern of its names in the legend of a listing, such as `wi_x`.
    #[must_use]
    pub fn pattern(self) -> String {
        [self.prefix(), self.indices().pattern()].concat()
    }

    /// Whether it has components along axes: it is a vector or a matrix.
    #[must_use]
    pub const fn is_vector(self) -> bool {
        matches!(self.indices(), Indices::Vector | Indices::Matrix | Indices::Links)
    }

    /// Its letter in formulas, without indices; that of the lecture if there is one. Empty beyond the seven steps.
    #[must_use]
    pub const fn letter(self) -> &'static str {
        self.row().letter
    }

    /// Its unit at a joint of this kind; empty for plain numbers, and beyond the seven steps.
    #[must_use]
    pub fn unit(self, kind: JointKind) -> &'static str {
        let unit = self.row().unit;
        match (unit.split_once('|'), kind) {
            (Some((unit, _)), JointKind::Revolute) | (Some((_, unit)), JointKind::Prismatic) => unit,
            (None, _) => unit,
        }
    }

    /// The meaning of its name, for the legend of a listing.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        self.row().meaning
    }
}
