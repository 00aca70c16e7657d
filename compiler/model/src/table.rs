//! The plain types of the table: they own no strings, allocate nothing, and are the same on a workstation and on a
//! microcontroller.

use crate::{Angle, QuarterTurns};

/// The Denavit-Hartenberg convention of a table. A file must name it; it is never guessed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// Distal (Denavit-Hartenberg-Paul): `Rz(theta) Tz(d) Tx(a) Rx(alpha)`, link frame i at the far end of link i.
    Standard,
    /// Proximal (Craig, Khalil): `Rx(alpha) Tx(a) Rz(theta) Tz(d)`, row i carries α_{i-1} and a_{i-1}, link frame i on
    /// joint axis i.
    Modified,
}

impl Convention {
    /// Returns the name of these rows in robot files: `standard` or `modified`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Modified => "modified",
        }
    }
}

/// The kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// A joint that turns: the joint variable (rad) is added to `theta`.
    Revolute,
    /// A joint that slides: the joint variable (m) is added to `d`.
    Prismatic,
}

impl JointKind {
    /// Returns the name of this kind in robot files: `revolute` or `prismatic`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Prismatic => "prismatic",
        }
    }

    /// Returns the unit of the joint position, rad or m; the unit of its velocity is this per second.
    #[must_use]
    pub const fn position_unit(self) -> &'static str {
        match self {
            Self::Revolute => "rad",
            Self::Prismatic => "m",
        }
    }

    /// Returns the unit of the torque or force of the joint: N m or N.
    #[must_use]
    pub const fn effort_unit(self) -> &'static str {
        match self {
            Self::Revolute => "N m",
            Self::Prismatic => "N",
        }
    }
}

/// One row of Denavit-Hartenberg parameters; rad and m. The joint variable is added to `theta` or `d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dh<S = f64> {
    /// Joint angle θ, or its constant part.
    pub theta: Angle<S>,
    /// Joint offset d (b in the lecture), or its constant part.
    pub d: S,
    /// Length of the common normal a.
    pub a: S,
    /// Twist α.
    pub alpha: Angle<S>,
}

/// A symmetric inertia tensor, kg m². `xy` is the (1,2) element of the tensor itself, -∫ x y dm.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Inertia<S = f64> {
    /// Element (1,1).
    pub xx: S,
    /// Element (2,2).
    pub yy: S,
    /// Element (3,3).
    pub zz: S,
    /// Element (1,2), -∫ x y dm.
    pub xy: S,
    /// Element (1,3), -∫ x z dm.
    pub xz: S,
    /// Element (2,3), -∫ y z dm.
    pub yz: S,
}

impl<S: Copy> Inertia<S> {
    /// Returns the tensor as rows of a matrix.
    #[must_use]
    pub const fn rows(&self) -> [[S; 3]; 3] {
        [[self.xx, self.xy, self.xz], [self.xy, self.yy, self.yz], [self.xz, self.yz, self.zz]]
    }
}

/// The names of the inertial parameters of a link, in the order of regressors: mass, first moments, inertia about the
/// origin of the link frame.
pub const INERTIAL_PARAMETERS: [&str; 10] = ["m", "mcx", "mcy", "mcz", "Jxx", "Jxy", "Jxz", "Jyy", "Jyz", "Jzz"];

/// The number of inertial parameters of a link: the mass, three first moments, six numbers of the inertia.
pub const PER_LINK: usize = INERTIAL_PARAMETERS.len();

/// The inertial data of one link, in its link frame.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Link<S = f64> {
    /// Mass, kg.
    pub mass: S,
    /// Centre of mass from the origin of the link frame, in link axes, m.
    pub com: [S; 3],
    /// Inertia about the centre of mass, in link axes.
    pub inertia: Inertia<S>,
    /// First moment about `com`, in link axes, kg m. It is zero for every physical body, because `com` is the centre of
    /// mass. A link without mass may have one, as sets of base parameters do; it has no centre of mass, so `com` is the
    /// origin of the link frame, and `inertia` is about this origin.
    pub first_moment: [S; 3],
}

impl Link {
    /// Returns whether the link has no mass, centre of mass, first moment and inertia.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns whether the link has a first moment without mass: it is then a set of base parameters, and no physical
    /// body.
    #[must_use]
    pub fn has_first_moment(&self) -> bool {
        self.first_moment != [0.0; 3]
    }
}

/// One joint of a table, with the link that the joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<S = f64> {
    /// Revolute or prismatic.
    pub kind: JointKind,
    /// The Denavit-Hartenberg parameters.
    pub dh: Dh<S>,
    /// The link.
    pub link: Link<S>,
}

/// A motor with a gear: it adds `G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇)` to the joint torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor<S = f64> {
    /// Rotor inertia Jm, kg m².
    pub inertia: S,
    /// Gear ratio G: motor turns per joint turn (rad/m for a prismatic joint). Its sign carries no meaning.
    pub gear_ratio: S,
    /// Viscous friction B at the motor shaft, N m s/rad.
    pub viscous: S,
    /// Coulomb friction at the motor shaft for positive and negative speed, [Tc⁺, Tc⁻], Tc⁻ ≤ 0, N m.
    pub coulomb: [S; 2],
}

/// A constant placement: translation, then fixed-axis roll, pitch, yaw as in URDF, R = Rz(yaw) Ry(pitch) Rx(roll).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform<S = f64> {
    /// Translation, m.
    pub xyz: [S; 3],
    /// Roll (about x), pitch (about y), yaw (about z).
    pub rpy: [Angle<S>; 3],
}

impl Transform<f64> {
    /// The placement that neither moves nor turns.
    pub const IDENTITY: Self = Self { xyz: [0.0; 3], rpy: [Angle::ZERO; 3] };

    /// Returns whether the placement neither moves nor turns; whole turns count as none.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        self.xyz == [0.0; 3] && self.rpy.iter().all(|angle| angle.right == Some(QuarterTurns::Zero))
    }
}

/// A frame that is fixed to a link, or to frame 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedFrame<S = f64> {
    /// The joint that moves the link, counted from 0; `None` for frame 0.
    pub on: Option<usize>,
    /// Placement of the frame in the link frame of the table. The link frame is at the far end of the link in a
    /// standard table, at the joint that moves the link in a modified one.
    pub placement: Transform<S>,
}

/// A robot with a number of joints known at compile time, without names: only the numbers that dynamics needs.
///
/// Every field is public and plain, so a `const` can be a model. `S` is the scalar in which the constants are stored:
/// `f32` avoids double precision on a target that has only single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model<const DOF: usize, S = f64> {
    /// Standard or modified rows.
    pub convention: Convention,
    /// Acceleration of gravity in frame 0, m/s² (it points down).
    pub gravity: [S; 3],
    /// World → frame 0. Places the arm; never turns gravity.
    pub base: Transform<S>,
    /// Frame n → tip frame.
    pub tool: Transform<S>,
    /// The joints, base to tip.
    pub rows: [Row<S>; DOF],
}

#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
mod single {
    use super::{Dh, FixedFrame, Inertia, Link, Model, Motor, Row, Transform};

    const fn vector(v: [f64; 3]) -> [f32; 3] {
        [v[0] as f32, v[1] as f32, v[2] as f32]
    }

    impl Transform<f64> {
        /// Converts the placement to single precision.
        #[must_use]
        pub const fn to_f32(self) -> Transform<f32> {
            Transform { xyz: vector(self.xyz), rpy: [self.rpy[0].to_f32(), self.rpy[1].to_f32(), self.rpy[2].to_f32()] }
        }
    }

    impl FixedFrame<f64> {
        /// Converts the frame to single precision; each number is rounded once.
        #[must_use]
        pub const fn to_f32(self) -> FixedFrame<f32> {
            FixedFrame { on: self.on, placement: self.placement.to_f32() }
        }
    }

    impl Row<f64> {
        /// Converts the row to single precision; each number is rounded once.
        #[must_use]
        pub const fn to_f32(self) -> Row<f32> {
            let dh = self.dh;
            Row {
                kind: self.kind,
                dh: Dh { theta: dh.theta.to_f32(), d: dh.d as f32, a: dh.a as f32, alpha: dh.alpha.to_f32() },
                link: self.link.to_f32(),
            }
        }
    }

    impl Link<f64> {
        /// Converts the link to single precision; each number is rounded once.
        #[must_use]
        pub const fn to_f32(self) -> Link<f32> {
            let i = self.inertia;
            Link {
                mass: self.mass as f32,
                com: vector(self.com),
                inertia: Inertia {
                    xx: i.xx as f32,
                    yy: i.yy as f32,
                    zz: i.zz as f32,
                    xy: i.xy as f32,
                    xz: i.xz as f32,
                    yz: i.yz as f32,
                },
                first_moment: vector(self.first_moment),
            }
        }
    }

    impl Motor<f64> {
        /// Converts the motor to single precision; each number is rounded once.
        #[must_use]
        pub const fn to_f32(self) -> Motor<f32> {
            Motor {
                inertia: self.inertia as f32,
                gear_ratio: self.gear_ratio as f32,
                viscous: self.viscous as f32,
                coulomb: [self.coulomb[0] as f32, self.coulomb[1] as f32],
            }
        }
    }

    impl<const DOF: usize> Model<DOF, f64> {
        /// Converts the robot to single precision; each number is rounded once.
        #[must_use]
        pub fn to_f32(self) -> Model<DOF, f32> {
            Model {
                convention: self.convention,
                gravity: vector(self.gravity),
                base: self.base.to_f32(),
                tool: self.tool.to_f32(),
                rows: self.rows.map(Row::to_f32),
            }
        }
    }
}
