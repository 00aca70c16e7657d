//! The misprints of the lecture's transcript, their words, and the right formulas.

/// A row for each misprint: the formula as it was printed or is often written, and the correct formula.
macro_rules! misprints {
    ($($variant:ident: $says:literal, $right:literal;)*) => {
        /// A formula as it was printed or spoken; its number in the list of errata comes first. Two are mistakes.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Misprint { $(#[doc = $says] $variant,)* }

        impl Misprint {
            /// Returns the formula as it was printed or is often written.
            #[must_use]
            pub fn says(self) -> &'static str {
                match self { $(Self::$variant => $says,)* }
            }

            /// Returns the correct formula.
            #[must_use]
            pub fn right(self) -> &'static str {
                match self { $(Self::$variant => $right,)* }
            }
        }
    };
}

misprints! {
    E1ThirdColumn: "step 1: the third column of Qᵀ is (0, -1, -1), as printed (E1)",
        "Qᵀ has the third column (0, sin α, cos α)";
    E2WrongQ: "step 1: Q of the link itself is used in place of Q of the previous link (E2)",
        "ω_i = Q_{i-1}ᵀ ω_{i-1} + …: Q_{i-1} leads from frame i to frame i-1";
    E3LeftSide: "step 2: the left side is ω instead of ω̇, as printed (E3)",
        "ω̇_i = Q_{i-1}ᵀ ω̇_{i-1} + …";
    E4TurnedTwice: "step 2, sliding joint: ω̇ is turned twice (E4)",
        "ω̇_i = Q_{i-1}ᵀ [ω̇_{i-1}]_{i-1}";
    E5NoDot: "step 3, sliding joint: b e instead of ḃ e, as printed (E5)",
        "ċ_i = … + ḃ_i e_i";
    E6FactorsSwapped: "step 3: r × ω instead of ω × r, as printed (E6)",
        "ċ_i = Q_{i-1}ᵀ (ċ_{i-1} + ω_{i-1} × r_{i-1}) + …";
    E7ConstantR: "step 3: r is constant in frame i, as printed (E7)",
        "[r_i]_i = Q_i [r_i]_{i+1}";
    E8OffsetForD: "step 3: d is the joint offset (E8)",
        "d_i = a_i - r_i, from O_i to the centre of mass";
    E9FramesBefore: "step 3: a is taken from the previous row (E9)",
        "a_i leads from O_i to O_{i+1}";
    E10ForceNotTurned: "step 6: the force of the next link is not turned into this frame (E10)",
        "[f_{i,i+1}]_i = Q_i [f_{i,i+1}]_{i+1}";
    E10MomentNotTurned: "step 6: the moment of the next link is not turned into this frame (E10)",
        "[n_{i,i+1}]_i = Q_i [n_{i,i+1}]_{i+1}";
    E11InertiaNotTurned: "step 6: the inertia is not turned into this frame (E11)",
        "[I_i]_i = Q_i [I_i]_{i+1} Q_iᵀ";
    E13GroundFrame: "step 5: gravity is turned by the first joint (E13)",
        "Q_0 = 1: gravity is given in the frame of joint 1";
    E17AxisX: "step 7: the joint's axis is x (E17)",
        "e = (0, 0, 1)";
    E22NoJointRate: "step 1: ω is that of the previous link, without the joint's own rate (E22)",
        "revolute: ω_i = Q_{i-1}ᵀ ω_{i-1} + θ̇_i e_i";
    CoriolisOnce: "step 4, sliding joint: ḃ ω × e without its factor 2",
        "c̈_i = … + 2 ḃ_i ω_i × e_i";
    NoGyroscopicMoment: "step 6: n = I ω̇, without ω × I ω",
        "n_i = I_i ω̇_i + ω_i × I_i ω_i";
}

impl Misprint {
    /// The misprints that change torques. Misprints in step 3, the velocity, do not.
    pub const IN_TORQUES: [Self; 15] = [
        Self::NoGyroscopicMoment,
        Self::CoriolisOnce,
        Self::E1ThirdColumn,
        Self::E2WrongQ,
        Self::E3LeftSide,
        Self::E4TurnedTwice,
        Self::E7ConstantR,
        Self::E8OffsetForD,
        Self::E9FramesBefore,
        Self::E10ForceNotTurned,
        Self::E10MomentNotTurned,
        Self::E11InertiaNotTurned,
        Self::E13GroundFrame,
        Self::E17AxisX,
        Self::E22NoJointRate,
    ];
}
