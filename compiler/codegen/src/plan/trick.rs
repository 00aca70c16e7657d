//! The ideas that make the reduced form small, each with a name, so that a reader can leave one out.

use crate::named::named;
use crate::plan::{Moment, OriginShift, Plan, RegroupingTarget, Side};

named! {
    /// A simplification of the reduced form. The section numbers refer to `docs/teaching/reduced-form.md`.
    Trick, "trick of the reduced form" {
        /// Mass on a joint axis is moved to the link before, so that parameters of the link become zero.
        Regrouping = "regrouping",
        /// Regrouping makes other parameters zero than those of the link itself.
        RegroupingTargets = "regrouping-targets",
        /// An axisymmetric last link is replaced by a spinning sphere without mass.
        Gyrostat = "gyrostat",
        /// The last frame is rotated so that a component of a first moment becomes zero.
        LastFrame = "last-frame",
        /// Prismatic links keep the axes of the revolute link before.
        CarriedPrismatics = "carried-prismatics",
        /// The two links of a joint axis share the column U z.
        AxisColumns = "axis-columns",
        /// Parallel axes share a frame.
        ParallelGroups = "parallel-groups",
        /// Offsets along joint axes are added in the frame in which this takes the fewest operations.
        Offsets = "offsets",
        /// Origins of frames are moved along their joint axes.
        OriginShifts = "origin-shifts",
        /// Lengths and forces are measured in units of the arm.
        Scales = "scales",
        /// The moment of a link is computed in the form that suits its tensor.
        MomentForms = "moment-forms",
        /// Rotations by twists that are no right angles take seven products instead of eight.
        ScaledTwists = "scaled-twists",
        /// Some quantities of a link are evaluated in frame N, which is on its axis but does not turn with the joint.
        UnturnedFrames = "unturned-frames",
        /// The finished graph is made smaller by exact algebra: no choice of a plan, but what comes after it.
        Rewriting = "rewriting",
    }
}

impl Trick {
    /// Its effect in one line, with a formula and the number of the section.
    #[must_use]
    pub const fn formula(self) -> &'static str {
        match self {
            Self::Regrouping => {
                "m, h_z, S33 of a link move to the previous link: h += δm p + δh u, S += δm ppᵀ + δh (puᵀ + upᵀ) + δk \
                uuᵀ (4.4)"
            }
            Self::RegroupingTargets => "the three numbers of a rod make other entries of h or S zero (4.5)",
            Self::Gyrostat => "S11 = S22, h = 0: τ_n = c (ω̇'_z + q̈); the previous link gets c·1 and the spin (5.6)",
            Self::LastFrame => "φ = atan2(h_y, h_x) rotates the last frame, so that h_y = 0 (5.8)",
            Self::CarriedPrismatics => {
                "a prismatic joint does not rotate: a = a' + U (p + q u) + 2 q̇ ω × u + q̈ u in previous axes (5.9)"
            }
            Self::AxisColumns => "U_i z = U_{i-1} z gives ω̇_x = ω_y ω_z - U23, ω̇_y = U13 - ω_x ω_z (5.3)",
            Self::ParallelGroups => "parallel axes share a frame N: Q = Σ q̇, Θ = Σ θ (5.5)",
            Self::Offsets => "d is added in the previous frame, on the axis, or in the frame of the link (5.2)",
            Self::OriginShifts => "the origin of a frame may be any point of its axis (5.4)",
            Self::Scales => "a' = λ a, f' = μ f: a length or a moment becomes 1 (3.5)",
            Self::MomentForms => "antisym(U S) = J ω̇ + ω × J ω, or with the diagonal split (3.3)",
            Self::ScaledTwists => "u = v_y + tan α v_z rotates a vector with seven products (5.1)",
            Self::UnturnedFrames => "p, ω̇, h, S or the wrench of the next link are evaluated in frame N (5.7)",
            Self::Rewriting => "u w + v w = (u + v) w, c₁ x + c₂ y = c₁ (x + (c₂/c₁) y), 1 - s² = c², and so on (10)",
        }
    }

    /// The plan without this idea.
    #[must_use]
    pub fn left_out_of(self, plan: &Plan) -> Plan {
        let mut plan = plan.clone();
        match self {
            Self::Regrouping => {
                plan.regrouped = false;
                return Self::RegroupingTargets.left_out_of(&plan);
            }
            Self::Gyrostat => plan.gyrostat = false,
            Self::LastFrame => plan.turned_last_frame = false,
            Self::CarriedPrismatics => plan.carried_prismatics = false,
            Self::Scales => plan = plan.unscaled(),
            _ => {}
        }
        for joint in &mut plan.joints {
            let on = &mut joint.switches;
            match self {
                Self::RegroupingTargets => joint.targets = [RegroupingTarget::Own; 3],
                Self::AxisColumns => on.axis_column = false,
                Self::ParallelGroups => {
                    on.group_omega = false;
                    on.group_omega_dot = false;
                    on.group_acceleration = false;
                    on.group_wrench = false;
                }
                Self::Offsets => (joint.outward_offset, joint.inward_offset) = (Side::Link, Side::Link),
                Self::OriginShifts => joint.origin_shift = OriginShift::None,
                Self::MomentForms => joint.moment = Moment::Second,
                Self::ScaledTwists => {
                    on.scaled_twist_outward = false;
                    on.scaled_twist_inward = false;
                }
                Self::UnturnedFrames => {
                    on.origin_unturned = false;
                    on.omega_dot_unturned = false;
                    on.first_moment_unturned = false;
                    on.second_moment_unturned = false;
                    on.wrench_unturned = false;
                }
                _ => {}
            }
        }
        plan
    }

    /// Whether a plan makes use of it.
    #[must_use]
    pub fn is_in(self, plan: &Plan) -> bool {
        self.left_out_of(plan) != *plan
    }
}
