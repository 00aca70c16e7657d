//! The quantities of the lines of a worksheet.

use std::fmt;
use std::str::FromStr;

use rne_model::{JointKind, did_you_mean};

/// The names of the components of single numbers, vectors and matrices.
const SCALAR: &[&str] = &[""];
const VECTOR: &[&str] = &["x", "y", "z"];
const SYMMETRIC: &[&str] = &["xx", "xy", "xz", "yy", "yz", "zz"];
const MATRIX: &[&str] = &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// A row for each quantity: its documentation, its name in files, its symbol for joint i (p is the previous joint, n
/// the next), the step that computes it, its components, and its units for a revolute and a prismatic joint.
macro_rules! quantities {
    ($($(#[$doc:meta])* $variant:ident: $name:literal, $symbol:literal, $step:literal, $components:ident,
       $turns:literal | $slides:literal;)*) => {
        /// A quantity of a worksheet: an input of a joint, or a result of the seven steps. The order is that of the
        /// computation for one joint, from base to tip and then back.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Quantity { $($(#[$doc])* $variant,)* }

        impl Quantity {
            /// All quantities in the order of computation for one joint.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// Returns the name in files, such as `omega_dot`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// Returns the symbol for joint `i`, counted from 1, such as `ω̇2` or `f1,2`.
            #[must_use]
            pub fn symbol(self, i: usize) -> String {
                indexed(self.template(), i)
            }

            /// Returns the symbol with {i} for the number of the joint, {p} for the previous one and {n} for the next.
            pub(super) const fn template(self) -> &'static str {
                match self { $(Self::$variant => $symbol,)* }
            }

            /// Returns the step that computes the quantity; 0 for inputs of the steps.
            #[must_use]
            pub const fn step(self) -> u8 {
                match self { $(Self::$variant => $step,)* }
            }

            /// Returns the names of the components; a single number has one component without a name.
            #[must_use]
            pub const fn components(self) -> &'static [&'static str] {
                match self { $(Self::$variant => $components,)* }
            }

            /// Returns the unit for a kind of joint; 1 for a number without a unit.
            #[must_use]
            pub const fn unit(self, kind: JointKind) -> &'static str {
                let [turns, slides] = match self { $(Self::$variant => [$turns, $slides],)* };
                if matches!(kind, JointKind::Revolute) { turns } else { slides }
            }
        }
    };
}

quantities! {
    /// The given joint position, rad or m.
    Q: "q", "q{i}", 0, SCALAR, "rad" | "m";
    /// The joint velocity, rad/s or m/s.
    Qd: "qd", "q̇{i}", 0, SCALAR, "rad/s" | "m/s";
    /// The joint acceleration, rad/s² or m/s².
    Qdd: "qdd", "q̈{i}", 0, SCALAR, "rad/s²" | "m/s²";
    /// The joint angle θ_i with its constant part, rad.
    Theta: "theta", "θ{i}", 0, SCALAR, "rad" | "rad";
    /// The offset b_i with its constant part, the `d` of the row, m.
    Offset: "offset", "b{i}", 0, SCALAR, "m" | "m";
    /// Mass m_i, kg.
    Mass: "mass", "m{i}", 0, SCALAR, "kg" | "kg";
    /// Rotation R_i from the axes of this joint's lines to those of the previous joint; for the first joint, to
    /// frame 0.
    Rotation: "rotation", "R{i}", 0, MATRIX, "1" | "1";
    /// Rotation A_i from axes fixed to link i, with z along joint i, to frame 0. Only for worksheets in base axes.
    Orientation: "orientation", "A{i}", 0, MATRIX, "1" | "1";
    /// Axis e_i of the joint. Only for worksheets in base axes; it is (0, 0, 1) in all others.
    Axis: "axis", "e{i}", 0, VECTOR, "1" | "1";
    /// Vector d_i from the joint to the centre of mass, m.
    D: "d", "d{i}", 0, VECTOR, "m" | "m";
    /// Vector r_i from the centre of mass to the next joint or the tip, m.
    R: "r", "r{i}", 0, VECTOR, "m" | "m";
    /// Inertia I_i about the centre of mass, kg m².
    Inertia: "inertia", "I{i}", 0, SYMMETRIC, "kg m²" | "kg m²";
    /// Step 1: angular velocity ω_i, rad/s.
    Omega: "omega", "ω{i}", 1, VECTOR, "rad/s" | "rad/s";
    /// Step 2: angular acceleration ω̇_i, rad/s².
    OmegaDot: "omega_dot", "ω̇{i}", 2, VECTOR, "rad/s²" | "rad/s²";
    /// Step 3: velocity ċ_i of the centre of mass, m/s.
    Velocity: "velocity", "ċ{i}", 3, VECTOR, "m/s" | "m/s";
    /// Step 4: acceleration c̈_i of the centre of mass, m/s².
    Acceleration: "acceleration", "c̈{i}", 4, VECTOR, "m/s²" | "m/s²";
    /// Step 5: acceleration of gravity g_i, m/s².
    Gravity: "gravity", "g{i}", 5, VECTOR, "m/s²" | "m/s²";
    /// Step 6: force f_i that accelerates the link, N.
    InertiaForce: "inertia_force", "f{i}", 6, VECTOR, "N" | "N";
    /// Step 6: moment n_i that accelerates the link, N m.
    InertiaMoment: "inertia_moment", "n{i}", 6, VECTOR, "N m" | "N m";
    /// Step 6: force f_{i,i+1} on the next link, in the axes of joint i's lines, N.
    NextForce: "next_force", "f{i},{n}", 6, VECTOR, "N" | "N";
    /// Step 6: moment n_{i,i+1} on the next link, in the axes of joint i's lines, N m.
    NextMoment: "next_moment", "n{i},{n}", 6, VECTOR, "N m" | "N m";
    /// Step 6: force f_{i-1,i} of the previous link on this one, N.
    JointForce: "joint_force", "f{p},{i}", 6, VECTOR, "N" | "N";
    /// Step 6: moment n_{i-1,i} of the previous link on this one, N m.
    JointMoment: "joint_moment", "n{p},{i}", 6, VECTOR, "N m" | "N m";
    /// Step 7: torque or force τ_i of the actuator, N m or N.
    Tau: "tau", "τ{i}", 7, SCALAR, "N m" | "N";
}

/// Replaces {i}, {p} and {n} in a text by the numbers of a joint, of the previous one and of the next.
pub(super) fn indexed(text: &str, i: usize) -> String {
    let (p, n) = (i.saturating_sub(1).to_string(), (i + 1).to_string());
    text.replace("{i}", &i.to_string()).replace("{p}", &p).replace("{n}", &n)
}

impl Quantity {
    /// Whether the quantity is computed in the recursion from the tip to the base.
    #[must_use]
    pub const fn is_inward(self) -> bool {
        self.step() >= 6
    }

    /// Whether the components depend on the axes.
    #[must_use]
    pub const fn has_axes(self) -> bool {
        self.components().len() > 1
    }

    /// Whether the quantity is an angle or its derivative, so that it may be given in degrees by mistake.
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

/// The error for an unknown name of a quantity, with the quantity that was probably meant.
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
