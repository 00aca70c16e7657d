//! The formulas of the seven steps, for the comments of generated code.

use rne_model::JointKind;

use crate::ir::quantity::{Quantity, Step};

/// A formula of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula {
    /// What it gives.
    pub quantity: Quantity,
    /// The formula, in the letters of the lecture.
    pub text: String,
}

impl Formula {
    const fn of(quantity: Quantity, text: String) -> Self {
        Self { quantity, text }
    }
}

/// The formulas of a step for joint `joint`, in the letters of the lecture.
pub(super) fn formulas(step: Step, kind: JointKind, joint: usize) -> Vec<Formula> {
    let (i, p, n) = (joint, joint - 1, joint + 1);
    let slides = kind == JointKind::Prismatic;
    // what a joint of one kind adds
    let turning = |term: String| if slides { String::new() } else { format!(" + {term}") };
    let sliding = |term: String| if slides { format!(" + {term}") } else { String::new() };
    match step {
        Step::AngularVelocity => {
            vec![Formula::of(Quantity::Omega, format!("ω{i} = R{i}ᵀ ω{p}{}", turning(format!("q̇{i} e"))))]
        }
        Step::AngularAcceleration => {
            let own = turning(format!("q̈{i} e + q̇{i} ω{i} × e"));
            vec![Formula::of(Quantity::OmegaDot, format!("ω̇{i} = R{i}ᵀ ω̇{p}{own}"))]
        }
        Step::Velocity => {
            let own = sliding(format!("q̇{i} e"));
            let carried = format!("R{i}ᵀ (ċ{p} + ω{p} × r{p})");
            vec![Formula::of(Quantity::Velocity, format!("ċ{i} = {carried} + ω{i} × d{i}{own}"))]
        }
        Step::Acceleration => {
            let own = sliding(format!("q̈{i} e + 2 q̇{i} ω{i} × e"));
            let carried = format!("R{i}ᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p}))");
            let about = format!("ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})");
            vec![Formula::of(Quantity::Acceleration, format!("c̈{i} = {carried} + {about}{own}"))]
        }
        Step::Gravity => vec![Formula::of(Quantity::Gravity, format!("g{i} = R{i}ᵀ g{p}"))],
        Step::Wrenches => {
            let moment = format!("n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n}");
            vec![
                Formula::of(Quantity::InertiaMoment, format!("n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}")),
                Formula::of(Quantity::JointForce, format!("f{p},{i} = m{i} (c̈{i} - g{i}) + f{i},{n}")),
                Formula::of(Quantity::JointMoment, moment),
            ]
        }
        Step::Torque => {
            let wrench = if slides { 'f' } else { 'n' };
            vec![Formula::of(Quantity::Torque, format!("τ{i} = e · {wrench}{p},{i}"))]
        }
        Step::Beyond => Vec::new(),
    }
}

/// The formulas of the reduced form that stand in the place of a step. The order of their terms and the frame in which
/// they are evaluated are choices of the plan.
pub(super) fn reduced_formulas(step: Step, kind: JointKind, joint: usize) -> Vec<Formula> {
    let (i, p, n) = (joint, joint.saturating_sub(1), joint + 1);
    let slides = kind == JointKind::Prismatic;
    let turning = |term: String| if slides { String::new() } else { format!(" + {term}") };
    match step {
        Step::AngularVelocity => {
            vec![Formula::of(Quantity::Omega, format!("ω{i} = R{i}ᵀ ω{p}{}", turning(format!("q̇{i} z"))))]
        }
        Step::AngularAcceleration => {
            let own = turning(format!("q̇{i} ω{i} × z + q̈{i} z"));
            vec![
                Formula::of(Quantity::OmegaDot, format!("ω̇{i} = R{i}ᵀ ω̇{p}{own}")),
                Formula::of(Quantity::Gradient, format!("U{i} = [ω̇{i}]× + [ω{i}]×[ω{i}]×")),
            ]
        }
        Step::Acceleration => {
            let carried = format!("a{i} = R{i}ᵀ (a{p} + U{p} p{i})");
            let own = if slides {
                format!(" + q{i} U{i} u + 2 q̇{i} ω{i} × u + q̈{i} u")
            } else {
                ", a0 = -g".to_owned()
            };
            vec![Formula::of(Quantity::OriginAcceleration, carried + &own)]
        }
        Step::Wrenches => {
            let moment = format!("n{i} = antisym(U{i} S) + h × a{i} + R{n} n{n} + p{n} × R{n} f{n}");
            vec![
                Formula::of(Quantity::ReducedForce, format!("f{i} = m a{i} + U{i} h + R{n} f{n}")),
                Formula::of(Quantity::ReducedMoment, moment),
            ]
        }
        Step::Torque => {
            let (axis, wrench) = if slides { ('u', 'f') } else { ('z', 'n') };
            vec![Formula::of(Quantity::Torque, format!("τ{i} = {axis} · {wrench}{i}"))]
        }
        // gravity is in the acceleration of the base, the velocity is not needed
        Step::Velocity | Step::Gravity | Step::Beyond => Vec::new(),
    }
}
