//! What the lecture's transcript prints, and what is right.

use crate::lecture::Misprint;

impl Misprint {
    /// The formula as it was printed or is often written.
    #[must_use]
    pub fn says(self) -> &'static str {
        match self {
            Self::E1ThirdColumn => "step 1: the third column of Qᵀ is (0, -1, -1), as printed (E1)",
            Self::E2WrongQ => "step 1: Q of the link itself stands where that of the link before belongs (E2)",
            Self::E3LeftSide => "step 2: ω stands on the left side instead of ω̇, as printed (E3)",
            Self::E4TurnedTwice => "step 2, sliding joint: ω̇ is turned twice (E4)",
            Self::E5NoDot => "step 3, sliding joint: b e instead of ḃ e, as printed (E5)",
            Self::E6FactorsSwapped => "step 3: r × ω instead of ω × r, as printed (E6)",
            Self::E7ConstantR => "step 3: r is constant in frame i, as printed (E7)",
            Self::E8OffsetForD => "step 3: d is the joint offset (E8)",
            Self::E9FramesBefore => "step 3: a is that of the frames before (E9)",
            Self::E10ForceNotTurned => "step 6: the force of the next link is not turned into this frame (E10)",
            Self::E10MomentNotTurned => "step 6: the moment of the next link is not turned into this frame (E10)",
            Self::E11InertiaNotTurned => "step 6: the inertia is not turned into this frame (E11)",
            Self::E13GroundFrame => "step 5: gravity is turned by the first joint (E13)",
            Self::E17AxisX => "step 7: the joint's axis is x (E17)",
            Self::E22NoJointRate => "step 1: ω of the link before, without the joint's own rate (E22)",
            Self::CoriolisOnce => "step 4, sliding joint: ḃ ω × e without its factor 2",
            Self::NoGyroscopicMoment => "step 6: n = I ω̇, without ω × I ω",
        }
    }

    /// The formula as it is right.
    #[must_use]
    pub fn right(self) -> &'static str {
        match self {
            Self::E1ThirdColumn => "Qᵀ has the third column (0, sin α, cos α)",
            Self::E2WrongQ => "ω_i = Q_{i-1}ᵀ ω_{i-1} + …: Q_{i-1} leads from frame i to frame i-1",
            Self::E3LeftSide => "ω̇_i = Q_{i-1}ᵀ ω̇_{i-1} + …",
            Self::E4TurnedTwice => "ω̇_i = Q_{i-1}ᵀ [ω̇_{i-1}]_{i-1}",
            Self::E5NoDot => "ċ_i = … + ḃ_i e_i",
            Self::E6FactorsSwapped => "ċ_i = Q_{i-1}ᵀ (ċ_{i-1} + ω_{i-1} × r_{i-1}) + …",
            Self::E7ConstantR => "[r_i]_i = Q_i [r_i]_{i+1}",
            Self::E8OffsetForD => "d_i = a_i - r_i, from O_i to the centre of mass",
            Self::E9FramesBefore => "a_i leads from O_i to O_{i+1}",
            Self::E10ForceNotTurned => "[f_{i,i+1}]_i = Q_i [f_{i,i+1}]_{i+1}",
            Self::E10MomentNotTurned => "[n_{i,i+1}]_i = Q_i [n_{i,i+1}]_{i+1}",
            Self::E11InertiaNotTurned => "[I_i]_i = Q_i [I_i]_{i+1} Q_iᵀ",
            Self::E13GroundFrame => "Q_0 = 1: gravity stands in the frame of joint 1",
            Self::E17AxisX => "e = (0, 0, 1)",
            Self::E22NoJointRate => "revolute: ω_i = Q_{i-1}ᵀ ω_{i-1} + θ̇_i e_i",
            Self::CoriolisOnce => "c̈_i = … + 2 ḃ_i ω_i × e_i",
            Self::NoGyroscopicMoment => "n_i = I_i ω̇_i + ω_i × I_i ω_i",
        }
    }
}
