//! The quantities that a worksheet has lines for.

use std::fmt;
use std::str::FromStr;

use rne_model::{JointKind, did_you_mean};

/// The components of a number alone, of vectors and of matrices.
const SCALAR: &[&str] = &[""];
const VECTOR: &[&str] = &["x", "y", "z"];
const SYMMETRIC: &[&str] = &["xx", "xy", "xz", "yy", "yz", "zz"];
const MATRIX: &[&str] = &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// A row for each quantity: its documentation, its name in files, its symbol for joint i (p is the one before, n the
/// next), the step that finds it, its components, and its units for a revolute and a prismatic joint.
macro_rules! quantities {
    ($($(#[$doc:meta])* $variant:ident: $name:literal, $symbol:literal, $step:literal, $components:ident,
       $turns:literal | $slides:literal;)*) => {
        /// A quantity of a worksheet: an input of a joint, or a result of the seven steps. The order is that in which a
        /// joint's are computed, outward and then back.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Quantity { $($(#[$doc])* $variant,)* }

        impl Quantity {
            /// All, in the order in which a joint's are computed.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// The name in files: `omega_dot`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// Its symbol for joint `i`, counted from 1: `ω̇2`, `f1,2`.
            #[must_use]
            pub fn symbol(self, i: usize) -> String {
                indexed(self.template(), i)
            }

            /// Its symbol with {i} for the number of the joint, {p} for the one before and {n} for the next.
            pub(super) const fn template(self) -> &'static str {
                match self { $(Self::$variant => $symbol,)* }
            }

            /// The step that finds it; 0 for inputs of the steps.
            #[must_use]
            pub const fn step(self) -> u8 {
                match self { $(Self::$variant => $step,)* }
            }

            /// The names of its components; a number alone has one, without a name.
            #[must_use]
            pub const fn components(self) -> &'static [&'static str] {
                match self { $(Self::$variant => $components,)* }
            }

            /// The unit for a kind of joint; 1 for a number without one.
            #[must_use]
            pub const fn unit(self, kind: JointKind) -> &'static str {
                let [turns, slides] = match self { $(Self::$variant => [$turns, $slides],)* };
                if matches!(kind, JointKind::Revolute) { turns } else { slides }
            }
        }
    };
}

quantities! {
    /// The joint's position as it is given, rad or m.
    Q: "q", "q{i}", 0, SCALAR, "rad" | "m";
    /// Its rate, rad/s or m/s.
    Qd: "qd", "q̇{i}", 0, SCALAR, "rad/s" | "m/s";
    /// Its acceleration, rad/s² or m/s².
    Qdd: "qdd", "q̈{i}", 0, SCALAR, "rad/s²" | "m/s²";
    /// θ_i with its constant part, rad.
    Theta: "theta", "θ{i}", 0, SCALAR, "rad" | "rad";
    /// b_i with its constant part, the `d` of the row, m.
    Offset: "offset", "b{i}", 0, SCALAR, "m" | "m";
    /// m_i, kg.
    Mass: "mass", "m{i}", 0, SCALAR, "kg" | "kg";
    /// R_i: from the axes of this joint's entry to those of the entry before; for the first, of frame 0.
    Rotation: "rotation", "R{i}", 0, MATRIX, "1" | "1";
    /// A_i, in base axes alone: from axes fixed to link i, z along joint i, to those of frame 0.
    Orientation: "orientation", "A{i}", 0, MATRIX, "1" | "1";
    /// e_i, in base axes alone; (0, 0, 1) in all others.
    Axis: "axis", "e{i}", 0, VECTOR, "1" | "1";
    /// d_i, from the joint to the centre of mass, m.
    D: "d", "d{i}", 0, VECTOR, "m" | "m";
    /// r_i, from the centre of mass to the next joint or the tip, m.
    R: "r", "r{i}", 0, VECTOR, "m" | "m";
    /// I_i about the centre of mass, kg m².
    Inertia: "inertia", "I{i}", 0, SYMMETRIC, "kg m²" | "kg m²";
    /// Step 1: ω_i, rad/s.
    Omega: "omega", "ω{i}", 1, VECTOR, "rad/s" | "rad/s";
    /// Step 2: ω̇_i, rad/s².
    OmegaDot: "omega_dot", "ω̇{i}", 2, VECTOR, "rad/s²" | "rad/s²";
    /// Step 3: ċ_i, m/s.
    Velocity: "velocity", "ċ{i}", 3, VECTOR, "m/s" | "m/s";
    /// Step 4: c̈_i, m/s².
    Acceleration: "acceleration", "c̈{i}", 4, VECTOR, "m/s²" | "m/s²";
    /// Step 5: g_i, m/s².
    Gravity: "gravity", "g{i}", 5, VECTOR, "m/s²" | "m/s²";
    /// Step 6: f_i, N.
    InertiaForce: "inertia_force", "f{i}", 6, VECTOR, "N" | "N";
    /// Step 6: n_i, N m.
    InertiaMoment: "inertia_moment", "n{i}", 6, VECTOR, "N m" | "N m";
    /// Step 6: f_{i,i+1} in the axes of joint i's entry, N.
    NextForce: "next_force", "f{i},{n}", 6, VECTOR, "N" | "N";
    /// Step 6: n_{i,i+1} in the axes of joint i's entry, N m.
    NextMoment: "next_moment", "n{i},{n}", 6, VECTOR, "N m" | "N m";
    /// Step 6: f_{i-1,i}, N.
    JointForce: "joint_force", "f{p},{i}", 6, VECTOR, "N" | "N";
    /// Step 6: n_{i-1,i}, N m.
    JointMoment: "joint_moment", "n{p},{i}", 6, VECTOR, "N m" | "N m";
    /// Step 7: τ_i, N m or N.
    Tau: "tau", "τ{i}", 7, SCALAR, "N m" | "N";
}

/// A text with the numbers of a joint, of the one before and of the next in the places of {i}, {p} and {n}.
pub(super) fn indexed(text: &str, i: usize) -> String {
    let (p, n) = (i.saturating_sub(1).to_string(), (i + 1).to_string());
    text.replace("{i}", &i.to_string()).replace("{p}", &p).replace("{n}", &n)
}

impl Quantity {
    /// Whether it is found on the way back, from the tip to the base.
    #[must_use]
    pub const fn is_inward(self) -> bool {
        self.step() >= 6
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
        let named = |name: &str| Self::ALL.into_iter().find(|quantity| quantity.name() == name);
        named(text).ok_or_else(|| UnknownQuantity(did_you_mean(text, Self::ALL.map(Self::name)).and_then(named)))
    }
}
