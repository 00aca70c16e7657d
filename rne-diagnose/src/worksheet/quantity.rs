//! What a worksheet has a line for.

use std::fmt;
use std::str::FromStr;

use rne_model::{JointKind, did_you_mean};

/// A quantity of a worksheet: what is given for a joint, and what the seven steps find. The order is that in which a
/// joint's are computed, outward and then back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Quantity {
    /// The joint's position as it is given, rad or m.
    Q,
    /// Its rate, rad/s or m/s.
    Qd,
    /// Its acceleration, rad/s² or m/s².
    Qdd,
    /// θ_i with its constant part, rad.
    Theta,
    /// b_i with its constant part, the `d` of the row, m.
    Offset,
    /// m_i, kg.
    Mass,
    /// R_i: from the axes of this joint's entry to those of the entry before; for the first, of frame 0.
    Rotation,
    /// A_i, in base axes alone: from axes fixed to link i, z along joint i, to those of frame 0.
    Orientation,
    /// e_i, in base axes alone; (0, 0, 1) in all others.
    Axis,
    /// d_i, from the joint to the centre of mass, m.
    D,
    /// r_i, from the centre of mass to the next joint or the tip, m.
    R,
    /// I_i about the centre of mass, kg m².
    Inertia,
    /// Step 1: ω_i, rad/s.
    Omega,
    /// Step 2: ω̇_i, rad/s².
    OmegaDot,
    /// Step 3: ċ_i, m/s.
    Velocity,
    /// Step 4: c̈_i, m/s².
    Acceleration,
    /// Step 5: g_i, m/s².
    Gravity,
    /// Step 6: f_i, N.
    InertiaForce,
    /// Step 6: n_i, N m.
    InertiaMoment,
    /// Step 6: f_{i,i+1} in the axes of joint i's entry, N.
    NextForce,
    /// Step 6: n_{i,i+1} in the axes of joint i's entry, N m.
    NextMoment,
    /// Step 6: f_{i-1,i}, N.
    JointForce,
    /// Step 6: n_{i-1,i}, N m.
    JointMoment,
    /// Step 7: τ_i, N m or N.
    Tau,
}

/// How many components a quantity has, and their names.
const SCALAR: &[&str] = &[""];
const VECTOR: &[&str] = &["x", "y", "z"];
const SYMMETRIC: &[&str] = &["xx", "xy", "xz", "yy", "yz", "zz"];
const MATRIX: &[&str] = &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

impl Quantity {
    /// All, in the order in which a joint's are computed.
    pub const ALL: [Self; 24] = [
        Self::Q,
        Self::Qd,
        Self::Qdd,
        Self::Theta,
        Self::Offset,
        Self::Mass,
        Self::Rotation,
        Self::Orientation,
        Self::Axis,
        Self::D,
        Self::R,
        Self::Inertia,
        Self::Omega,
        Self::OmegaDot,
        Self::Velocity,
        Self::Acceleration,
        Self::Gravity,
        Self::InertiaForce,
        Self::InertiaMoment,
        Self::NextForce,
        Self::NextMoment,
        Self::JointForce,
        Self::JointMoment,
        Self::Tau,
    ];

    /// Its name in files: `omega_dot`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Q => "q",
            Self::Qd => "qd",
            Self::Qdd => "qdd",
            Self::Theta => "theta",
            Self::Offset => "offset",
            Self::Mass => "mass",
            Self::Rotation => "rotation",
            Self::Orientation => "orientation",
            Self::Axis => "axis",
            Self::D => "d",
            Self::R => "r",
            Self::Inertia => "inertia",
            Self::Omega => "omega",
            Self::OmegaDot => "omega_dot",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Gravity => "gravity",
            Self::InertiaForce => "inertia_force",
            Self::InertiaMoment => "inertia_moment",
            Self::NextForce => "next_force",
            Self::NextMoment => "next_moment",
            Self::JointForce => "joint_force",
            Self::JointMoment => "joint_moment",
            Self::Tau => "tau",
        }
    }

    /// Its symbol for joint `i`, counted from 1: `ω̇2`, `f1,2`.
    #[must_use]
    pub fn symbol(self, i: usize) -> String {
        let (p, n) = (i.saturating_sub(1), i + 1);
        match self {
            Self::Q => format!("q{i}"),
            Self::Qd => format!("q̇{i}"),
            Self::Qdd => format!("q̈{i}"),
            Self::Theta => format!("θ{i}"),
            Self::Offset => format!("b{i}"),
            Self::Mass => format!("m{i}"),
            Self::Rotation => format!("R{i}"),
            Self::Orientation => format!("A{i}"),
            Self::Axis => format!("e{i}"),
            Self::D => format!("d{i}"),
            Self::R => format!("r{i}"),
            Self::Inertia => format!("I{i}"),
            Self::Omega => format!("ω{i}"),
            Self::OmegaDot => format!("ω̇{i}"),
            Self::Velocity => format!("ċ{i}"),
            Self::Acceleration => format!("c̈{i}"),
            Self::Gravity => format!("g{i}"),
            Self::InertiaForce => format!("f{i}"),
            Self::InertiaMoment => format!("n{i}"),
            Self::NextForce => format!("f{i},{n}"),
            Self::NextMoment => format!("n{i},{n}"),
            Self::JointForce => format!("f{p},{i}"),
            Self::JointMoment => format!("n{p},{i}"),
            Self::Tau => format!("τ{i}"),
        }
    }

    /// The step that finds it; 0 for what goes into the steps.
    #[must_use]
    pub const fn step(self) -> u8 {
        match self {
            Self::Q
            | Self::Qd
            | Self::Qdd
            | Self::Theta
            | Self::Offset
            | Self::Mass
            | Self::Rotation
            | Self::Orientation
            | Self::Axis
            | Self::D
            | Self::R
            | Self::Inertia => 0,
            Self::Omega => 1,
            Self::OmegaDot => 2,
            Self::Velocity => 3,
            Self::Acceleration => 4,
            Self::Gravity => 5,
            Self::InertiaForce
            | Self::InertiaMoment
            | Self::NextForce
            | Self::NextMoment
            | Self::JointForce
            | Self::JointMoment => 6,
            Self::Tau => 7,
        }
    }

    /// Whether it is found on the way back, from the tip to the base.
    #[must_use]
    pub const fn is_inward(self) -> bool {
        self.step() >= 6
    }

    /// The names of its components; a number alone has one, without a name.
    #[must_use]
    pub const fn components(self) -> &'static [&'static str] {
        match self {
            Self::Q | Self::Qd | Self::Qdd | Self::Theta | Self::Offset | Self::Mass | Self::Tau => SCALAR,
            Self::Inertia => SYMMETRIC,
            Self::Rotation | Self::Orientation => MATRIX,
            _ => VECTOR,
        }
    }

    /// Its unit for a kind of joint; 1 where there is none.
    #[must_use]
    pub const fn unit(self, kind: JointKind) -> &'static str {
        let turns = matches!(kind, JointKind::Revolute);
        match self {
            Self::Q => kind.position_unit(),
            Self::Qd if turns => "rad/s",
            Self::Qdd if turns => "rad/s²",
            Self::Tau => kind.effort_unit(),
            Self::Theta => "rad",
            Self::Mass => "kg",
            Self::Rotation | Self::Orientation | Self::Axis => "1",
            Self::Offset | Self::D | Self::R => "m",
            Self::Inertia => "kg m²",
            Self::Omega => "rad/s",
            Self::OmegaDot => "rad/s²",
            Self::Qd | Self::Velocity => "m/s",
            Self::Qdd | Self::Acceleration | Self::Gravity => "m/s²",
            Self::InertiaForce | Self::NextForce | Self::JointForce => "N",
            Self::InertiaMoment | Self::NextMoment | Self::JointMoment => "N m",
        }
    }

    /// Whether its components depend on the axes.
    #[must_use]
    pub const fn has_axes(self) -> bool {
        self.components().len() > 1
    }

    /// Whether it is an angle or the rate of one, so that somebody may have it in degrees.
    #[must_use]
    pub fn is_angular(self, kind: JointKind) -> bool {
        self.unit(kind).starts_with("rad")
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A word that names no quantity, and the one that was probably meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownQuantity(pub Option<Quantity>);

impl fmt::Display for UnknownQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(near) => write!(f, "there is no such quantity; did you mean `{near}`?"),
            None => f.write_str("there is no such quantity"),
        }
    }
}

impl std::error::Error for UnknownQuantity {}

impl FromStr for Quantity {
    type Err = UnknownQuantity;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let of = |name: &str| Self::ALL.into_iter().find(|quantity| quantity.name() == name);
        of(text).ok_or_else(|| UnknownQuantity(did_you_mean(text, Self::ALL.map(Self::name)).and_then(of)))
    }
}
