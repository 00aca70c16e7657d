//! The algorithms by which a function can be written under a plan, and which of them takes the fewest operations.

use rne_functions::Recursion;
use rne_model::Robot;

use crate::function::{Axes, Base, Function, Load};
use crate::reduced::crba::ExpressedIn;

/// The algorithm by which a function is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Algorithm {
    /// The recursive Newton-Euler algorithm, outward and inward; other results are computed from its torques.
    #[default]
    Rnea,
    /// Composite bodies (CRBA): all links after a joint as one rigid body.
    Crba(ExpressedIn),
    /// The Newton-Euler recursion, run once for each joint with a unit acceleration: a column of M each.
    UnitColumns,
    /// Articulated bodies (ABA).
    Aba(ExpressedIn),
    /// The Newton-Euler recursion, with the payload in frame N of the last joint instead of the last link's frame.
    UnturnedPayload,
}

impl Algorithm {
    /// All algorithms, with their names in plan files.
    pub const NAMES: [(Self, &'static str); 7] = [
        (Self::Rnea, "rnea"),
        (Self::Crba(ExpressedIn::GroupFrame), "crba_by_groups"),
        (Self::Crba(ExpressedIn::JointFrame), "crba_by_joints"),
        (Self::UnitColumns, "unit_columns"),
        (Self::Aba(ExpressedIn::GroupFrame), "aba_by_groups"),
        (Self::Aba(ExpressedIn::JointFrame), "aba_by_joints"),
        (Self::UnturnedPayload, "unturned_payload"),
    ];

    /// Returns the name of the algorithm in plan files.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.into_iter().find(|(other, _)| *other == self).map_or("", |(_, name)| name)
    }

    /// Whether the choices of a plan change the code of a function.
    #[must_use]
    pub const fn is_planned(function: Function) -> bool {
        !Self::of(function).is_empty()
    }

    /// Returns the algorithms of a function; none if the function has no reduced form.
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

    /// Returns the algorithms of a function whose operations are worth counting for a robot. Algorithms that repeat the
    /// recursion for every joint grow faster than composite bodies: from `MANY` joints on, for second derivatives from
    /// `FEW`, they never win. Articulated bodies are tried only for a robot without rotors, couplings and closed loops.
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

    /// Returns the frames in which the algorithm's composite or articulated bodies are expressed.
    pub(crate) const fn expressed_in(self) -> ExpressedIn {
        match self {
            Self::Crba(expressed_in) | Self::Aba(expressed_in) => expressed_in,
            Self::Rnea | Self::UnitColumns | Self::UnturnedPayload => ExpressedIn::GroupFrame,
        }
    }

    /// Returns the words for the algorithm in the list of choices of a program; none for the Newton-Euler recursion.
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
