//! The formulas of the seven steps, for the comments of generated code.

use rne_model::JointKind;

use crate::ir::quantity::Step;

/// The formulas of a step for joint `joint`, in the letters of the lecture.
pub(super) fn formulas(step: Step, kind: JointKind, joint: usize) -> Vec<String> {
    let (i, p, n) = (joint, joint - 1, joint + 1);
    let slides = kind == JointKind::Prismatic;
    let own = |term: &str| if slides { format!(" + {term}") } else { String::new() };
    match step {
        Step::AngularVelocity if slides => vec![format!("ω{i} = R{i}ᵀ ω{p}")],
        Step::AngularVelocity => vec![format!("ω{i} = R{i}ᵀ ω{p} + q̇{i} e")],
        Step::AngularAcceleration if slides => vec![format!("ω̇{i} = R{i}ᵀ ω̇{p}")],
        Step::AngularAcceleration => vec![format!("ω̇{i} = R{i}ᵀ ω̇{p} + q̈{i} e + q̇{i} ω{i} × e")],
        Step::Velocity => {
            vec![format!("ċ{i} = R{i}ᵀ (ċ{p} + ω{p} × r{p}) + ω{i} × d{i}{}", own(&format!("q̇{i} e")))]
        }
        Step::Acceleration => vec![format!(
            "c̈{i} = R{i}ᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})) + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i}){}",
            own(&format!("q̈{i} e + 2 q̇{i} ω{i} × e"))
        )],
        Step::Gravity => vec![format!("g{i} = R{i}ᵀ g{p}")],
        Step::Wrenches => vec![
            format!("n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}"),
            format!("f{p},{i} = m{i} (c̈{i} - g{i}) + f{i},{n}"),
            format!("n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n}"),
        ],
        Step::Torque if slides => vec![format!("τ{i} = e · f{p},{i}")],
        Step::Torque => vec![format!("τ{i} = e · n{p},{i}")],
        Step::Beyond => Vec::new(),
    }
}

/// The formulas of the reduced form that stand in the place of a step. The order of their terms and the frame in which
/// they are evaluated are choices of the plan.
pub(super) fn reduced_formulas(step: Step, kind: JointKind, joint: usize) -> Vec<String> {
    let (i, p, n) = (joint, joint.saturating_sub(1), joint + 1);
    let slides = kind == JointKind::Prismatic;
    match step {
        Step::AngularVelocity if slides => vec![format!("ω{i} = R{i}ᵀ ω{p}")],
        Step::AngularVelocity => vec![format!("ω{i} = R{i}ᵀ ω{p} + q̇{i} z")],
        Step::AngularAcceleration => vec![
            if slides {
                format!("ω̇{i} = R{i}ᵀ ω̇{p}")
            } else {
                format!("ω̇{i} = R{i}ᵀ ω̇{p} + q̇{i} ω{i} × z + q̈{i} z")
            },
            format!("U{i} = [ω̇{i}]× + [ω{i}]×[ω{i}]×"),
        ],
        Step::Acceleration if slides => {
            vec![format!("a{i} = R{i}ᵀ (a{p} + U{p} p{i}) + q{i} U{i} u + 2 q̇{i} ω{i} × u + q̈{i} u")]
        }
        Step::Acceleration => vec![format!("a{i} = R{i}ᵀ (a{p} + U{p} p{i}), a0 = -g")],
        Step::Wrenches => vec![
            format!("f{i} = m a{i} + U{i} h + R{n} f{n}"),
            format!("n{i} = antisym(U{i} S) + h × a{i} + R{n} n{n} + p{n} × R{n} f{n}"),
        ],
        Step::Torque if slides => vec![format!("τ{i} = u · f{i}")],
        Step::Torque => vec![format!("τ{i} = z · n{i}")],
        // gravity is in the acceleration of the base, the velocity is not needed
        Step::Velocity | Step::Gravity | Step::Beyond => Vec::new(),
    }
}
