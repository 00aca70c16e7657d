//! The formulas of the seven steps, for the comments of generated code.

use rne_model::JointKind;

use crate::quantity::Step;

/// The formula of a step for joint `joint`, in the letters of the lecture.
pub(super) fn formula(step: Step, kind: JointKind, joint: usize) -> String {
    let (i, p, n) = (joint, joint - 1, joint + 1);
    let slides = kind == JointKind::Prismatic;
    match step {
        Step::AngularVelocity if slides => format!("ω{i} = R{i}ᵀ ω{p}"),
        Step::AngularVelocity => format!("ω{i} = R{i}ᵀ ω{p} + q̇{i} e"),
        Step::AngularAcceleration if slides => format!("ω̇{i} = R{i}ᵀ ω̇{p}"),
        Step::AngularAcceleration => format!("ω̇{i} = R{i}ᵀ ω̇{p} + q̈{i} e + q̇{i} ω{i} × e"),
        Step::Velocity => {
            let own = if slides { format!(" + q̇{i} e") } else { String::new() };
            format!("ċ{i} = R{i}ᵀ (ċ{p} + ω{p} × r{p}) + ω{i} × d{i}{own}")
        }
        Step::Acceleration => {
            let own = if slides { format!(" + q̈{i} e + 2 q̇{i} ω{i} × e") } else { String::new() };
            format!(
                "c̈{i} = R{i}ᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})) + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i}){own}"
            )
        }
        Step::Gravity => format!("g{i} = R{i}ᵀ g{p}"),
        Step::Wrenches => format!(
            "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i},  f{p},{i} = m{i} (c̈{i} - g{i}) + f{i},{n},  \
             n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n}"
        ),
        Step::Torque if slides => format!("τ{i} = e · f{p},{i}"),
        Step::Torque => format!("τ{i} = e · n{p},{i}"),
    }
}
