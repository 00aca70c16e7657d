//! The formulas of the seven steps and of the reduced form, for the comments of generated code.

use rne_codegen::{Quantity, Step};
use rne_model::JointKind::{self, Prismatic, Revolute};

/// A formula of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula {
    /// The quantity that it gives.
    pub quantity: Quantity,
    /// The formula, in the letters of the lecture.
    pub text: String,
}

/// Quantities and their formulas; `{i}`, `{p}` and `{n}` are a joint, the one before and the next.
type Templates = &'static [(Quantity, &'static str)];

/// The formulas of a step for joint `joint`, in the letters of the lecture; of a link without mass that has a first
/// moment, `has_first_moment`, with its terms.
pub(super) fn formulas(step: Step, kind: JointKind, joint: usize, has_first_moment: bool) -> Vec<Formula> {
    let templates: Templates = match (step, kind) {
        (Step::AngularVelocity, Revolute) => &[(Quantity::Omega, "ω{i} = R{i}ᵀ ω{p} + q̇{i} e")],
        (Step::AngularVelocity, Prismatic) => &[(Quantity::Omega, "ω{i} = R{i}ᵀ ω{p}")],
        (Step::AngularAcceleration, Revolute) => &[(Quantity::OmegaDot, "ω̇{i} = R{i}ᵀ ω̇{p} + q̈{i} e + q̇{i} ω{i} × e")],
        (Step::AngularAcceleration, Prismatic) => &[(Quantity::OmegaDot, "ω̇{i} = R{i}ᵀ ω̇{p}")],
        (Step::Velocity, Revolute) => &[(Quantity::Velocity, "ċ{i} = R{i}ᵀ (ċ{p} + ω{p} × r{p}) + ω{i} × d{i}")],
        (Step::Velocity, Prismatic) => {
            &[(Quantity::Velocity, "ċ{i} = R{i}ᵀ (ċ{p} + ω{p} × r{p}) + ω{i} × d{i} + q̇{i} e")]
        }
        (Step::Acceleration, Revolute) => &[(
            Quantity::Acceleration,
            "c̈{i} = R{i}ᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})) + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})",
        )],
        (Step::Acceleration, Prismatic) => &[(
            Quantity::Acceleration,
            "c̈{i} = R{i}ᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})) + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i}) \
             + q̈{i} e + 2 q̇{i} ω{i} × e",
        )],
        (Step::Gravity, _) => &[(Quantity::Gravity, "g{i} = R{i}ᵀ g{p}")],
        (Step::Wrenches, _) if has_first_moment => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i} + h{i} × c̈{i}"),
            (Quantity::JointForce, "f{p},{i} = m{i} (c̈{i} - g{i}) + ω̇{i} × h{i} + ω{i} × (ω{i} × h{i}) + f{i},{n}"),
            (Quantity::JointMoment, "n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n} - h{i} × g{i}"),
        ],
        (Step::Wrenches, _) => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}"),
            (Quantity::JointForce, "f{p},{i} = m{i} (c̈{i} - g{i}) + f{i},{n}"),
            (Quantity::JointMoment, "n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{i} × f{i},{n}"),
        ],
        (Step::Torque, Revolute) => &[(Quantity::Torque, "τ{i} = e · n{p},{i}")],
        (Step::Torque, Prismatic) => &[(Quantity::Torque, "τ{i} = e · f{p},{i}")],
        (Step::Beyond, _) => &[],
    };
    of_joint(templates, joint)
}

/// The formulas of a step for a payload, as the link after the last; `{p}` is the last one, R turns tip axes into its
/// own.
pub(super) fn payload_formulas(step: Step, joint: usize) -> Vec<Formula> {
    let templates: Templates = match step {
        Step::AngularVelocity => &[(Quantity::Omega, "ω{i} = Rᵀ ω{p}")],
        Step::AngularAcceleration => &[(Quantity::OmegaDot, "ω̇{i} = Rᵀ ω̇{p}")],
        Step::Acceleration => &[(
            Quantity::Acceleration,
            "c̈{i} = Rᵀ (c̈{p} + ω̇{p} × r{p} + ω{p} × (ω{p} × r{p})) + ω̇{i} × com{i} + ω{i} × (ω{i} × com{i})",
        )],
        Step::Gravity => &[(Quantity::Gravity, "g{i} = Rᵀ g{p}")],
        Step::Wrenches => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}"),
            (Quantity::JointForce, "f{p},{i} = m{i} (c̈{i} - g{i})"),
            (Quantity::JointMoment, "n{p},{i} = n{i} + com{i} × f{p},{i}"),
        ],
        Step::Velocity | Step::Torque | Step::Beyond => &[],
    };
    of_joint(templates, joint)
}

/// The formulas of the reduced form that stand in the place of a step. The order of their terms and the frame in which
/// they are evaluated are choices of the plan.
pub(super) fn reduced_formulas(step: Step, kind: JointKind, joint: usize) -> Vec<Formula> {
    const GRADIENT: (Quantity, &str) = (Quantity::Gradient, "U{i} = [ω̇{i}]× + [ω{i}]×[ω{i}]×");
    let templates: Templates = match (step, kind) {
        (Step::AngularVelocity, Revolute) => &[(Quantity::Omega, "ω{i} = R{i}ᵀ ω{p} + q̇{i} z")],
        (Step::AngularVelocity, Prismatic) => &[(Quantity::Omega, "ω{i} = R{i}ᵀ ω{p}")],
        (Step::AngularAcceleration, Revolute) => {
            &[(Quantity::OmegaDot, "ω̇{i} = R{i}ᵀ ω̇{p} + q̇{i} ω{i} × z + q̈{i} z"), GRADIENT]
        }
        (Step::AngularAcceleration, Prismatic) => &[(Quantity::OmegaDot, "ω̇{i} = R{i}ᵀ ω̇{p}"), GRADIENT],
        (Step::Acceleration, Revolute) => &[(Quantity::OriginAcceleration, "a{i} = R{i}ᵀ (a{p} + U{p} p{i}), a0 = -g")],
        (Step::Acceleration, Prismatic) => &[(
            Quantity::OriginAcceleration,
            "a{i} = R{i}ᵀ (a{p} + U{p} p{i}) + q{i} U{i} u + 2 q̇{i} ω{i} × u + q̈{i} u",
        )],
        (Step::Wrenches, _) => &[
            (Quantity::ReducedForce, "f{i} = m a{i} + U{i} h + R{n} f{n}"),
            (Quantity::ReducedMoment, "n{i} = antisym(U{i} S) + h × a{i} + R{n} n{n} + p{n} × R{n} f{n}"),
        ],
        (Step::Torque, Revolute) => &[(Quantity::Torque, "τ{i} = z · n{i}")],
        (Step::Torque, Prismatic) => &[(Quantity::Torque, "τ{i} = u · f{i}")],
        // gravity is in the acceleration of the base, the velocity is not needed
        (Step::Velocity | Step::Gravity | Step::Beyond, _) => &[],
    };
    of_joint(templates, joint)
}

fn of_joint(templates: Templates, joint: usize) -> Vec<Formula> {
    let formula = |(quantity, text)| Formula { quantity, text };
    if joint == ANY {
        return written(templates, ["i", "h", "j"].map(str::to_owned)).map(formula).collect();
    }
    written(templates, [joint, joint.saturating_sub(1), joint + 1].map(|number| number.to_string()))
        .map(formula)
        .collect()
}

/// The letters in the place of a joint's number: i for the joint, h = i - 1 and j = i + 1 for its neighbours.
pub(super) const ANY: usize = usize::MAX;

fn written(templates: Templates, [i, p, n]: [String; 3]) -> impl Iterator<Item = (Quantity, String)> {
    let text = move |template: &str| template.replace("{i}", &i).replace("{p}", &p).replace("{n}", &n);
    templates.iter().map(move |&(quantity, template)| (quantity, text(template)))
}
