//! The formulas of the seven steps and of the reduced form, as text for the comments of generated code.

use rne_codegen::{Argument, Function, Quantity, Step};
use rne_model::JointKind::{self, Prismatic, Revolute};
use rne_model::Robot;

/// A formula of a step, for one quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula {
    /// The quantity on the left side of the formula.
    pub quantity: Quantity,
    /// The formula, with the symbols of the lecture.
    pub text: String,
}

/// Quantities and their formulas. `{i}` is replaced by a joint, `{p}` by its parent, and `{r}` by the subscript of the
/// vector from the parent to the joint. A term with `{n}` is written for each joint and tip that the link carries, with
/// its own `{rn}`.
type Templates = &'static [(Quantity, &'static str)];

/// The numbers in the formulas of a joint: its own, that of its parent, and those of the joints and tips that its link
/// carries.
#[derive(Clone, Debug)]
pub(super) struct Numbers {
    joint: String,
    parent: String,
    /// The subscript of r, the vector from the parent to the joint.
    lever: String,
    /// The joints and tips that the link carries.
    carried: Vec<Carried>,
    /// The joints that follow this one, with their ratios.
    followers: Vec<(f64, JointKind, Numbers)>,
    /// Whether this joint follows others: then its torque is only a term of their torques.
    is_follower: bool,
}

/// A joint or a tip that a link carries.
#[derive(Clone, Debug)]
struct Carried {
    number: String,
    /// The subscript of r, the vector from the link to the joint or tip.
    lever: String,
    /// Names in the code of the force and moment of a tip, in axes of the tip.
    wrench: Option<[String; 2]>,
}

impl Carried {
    /// Fills in a term of a template. If it is for a tip, its force or moment `{n}` is turned from the axes of the tip.
    fn term(&self, term: &str) -> String {
        let term = match &self.wrench {
            Some([force, moment]) => {
                let [force, moment] = [force, moment].map(|part| format!("R{{n}} {part}"));
                let is_turned = term.contains("R{n}");
                let [of_force, of_moment] =
                    if is_turned { ["R{n} f{n}", "R{n} n{n}"] } else { ["f{i},{n}", "n{i},{n}"] };
                term.replace(of_force, &force).replace(of_moment, &moment)
            }
            None => term.to_owned(),
        };
        term.replace("{n}", &self.number).replace("{rn}", &self.lever)
    }
}

impl Numbers {
    /// Returns letters in the place of numbers: i for the joint, h = i - 1 and j = i + 1 for its neighbours.
    pub(super) fn letters() -> Self {
        let [joint, parent, next] = ["i", "h", "j"].map(str::to_owned);
        Self {
            lever: parent.clone(),
            carried: vec![Carried { number: next, lever: joint.clone(), wrench: None }],
            joint,
            parent,
            followers: Vec::new(),
            is_follower: false,
        }
    }

    /// Returns the numbers of a joint of a robot, counted from 1, in the formulas of a function. The numbers from n + 1
    /// on are those of the tips at which the function takes wrenches, or of the payload. For a chain, the formulas have
    /// a tip as in the lecture for every function, also without a load.
    pub(super) fn of(robot: &Robot, joint: usize, function: Function) -> Self {
        let last = robot.joints.len();
        let tips: Vec<_> = if robot.is_chain() || function.takes(Argument::Payload) {
            vec![(robot.tip().on, None)]
        } else if function.takes(Argument::Wrench) {
            vec![(robot.tip().on, Some(["f", "n"].map(|part| format!("{part}{last},{}", last + 1))))]
        } else if function.takes(Argument::Wrenches) {
            let tips = robot.wrench_frames().into_iter().zip(1..);
            tips.map(|(tip, number)| (tip.on, Some(["ft", "nt"].map(|part| format!("{part}{number}"))))).collect()
        } else {
            Vec::new()
        };
        // joints and tips with their numbers, each with the number of the joint whose link carries it; 0 is the base
        let joints = (0..last).map(|index| (robot.parent(index), None));
        let carried: Vec<_> = joints
            .chain(tips)
            .zip(1..)
            .map(|((link, wrench), number): (_, usize)| (link.map_or(0, |link| link + 1), number, wrench))
            .collect();
        // the subscript of the first joint or tip on a link is the number of the link alone
        let lever = |link: usize, number: usize| match carried.iter().find(|(on, ..)| *on == link) {
            Some((_, first, _)) if *first != number => format!("{link}_{number}"),
            _ => link.to_string(),
        };
        let parent = carried.iter().find(|(_, number, _)| *number == joint).map_or(0, |(link, ..)| *link);
        let on_link = carried.iter().filter(|(link, ..)| *link == joint).map(|(link, number, wrench)| Carried {
            number: number.to_string(),
            lever: lever(*link, *number),
            wrench: wrench.clone(),
        });
        let follower = |(index, other): (usize, &rne_model::Joint)| {
            let follows = &other.coupling.as_ref()?.follows;
            let (_, ratio) = follows.iter().find(|(followed, _)| followed + 1 == joint)?;
            Some((*ratio, other.row.kind, Self::of(robot, index + 1, function)))
        };
        Self {
            joint: joint.to_string(),
            parent: parent.to_string(),
            lever: lever(parent, joint),
            carried: on_link.collect(),
            followers: robot.joints.iter().enumerate().filter_map(follower).collect(),
            is_follower: robot.joints.get(joint.wrapping_sub(1)).is_some_and(|joint| joint.coupling.is_some()),
        }
    }
}

/// Returns the formulas of a step for a joint, with the symbols of the lecture. If `has_first_moment`, they include the
/// terms of a first moment that the link has in addition to its mass.
pub(super) fn formulas(step: Step, kind: JointKind, numbers: &Numbers, has_first_moment: bool) -> Vec<Formula> {
    let templates: Templates = match (step, kind) {
        (Step::AngularVelocity, Revolute) => &[(Quantity::Omega, "ω{i} = R{i}ᵀ ω{p} + q̇{i} e")],
        (Step::AngularVelocity, Prismatic) => &[(Quantity::Omega, "ω{i} = R{i}ᵀ ω{p}")],
        (Step::AngularAcceleration, Revolute) => &[(Quantity::OmegaDot, "ω̇{i} = R{i}ᵀ ω̇{p} + q̈{i} e + q̇{i} ω{i} × e")],
        (Step::AngularAcceleration, Prismatic) => &[(Quantity::OmegaDot, "ω̇{i} = R{i}ᵀ ω̇{p}")],
        (Step::Velocity, Revolute) => &[(Quantity::Velocity, "ċ{i} = R{i}ᵀ (ċ{p} + ω{p} × r{r}) + ω{i} × d{i}")],
        (Step::Velocity, Prismatic) => {
            &[(Quantity::Velocity, "ċ{i} = R{i}ᵀ (ċ{p} + ω{p} × r{r}) + ω{i} × d{i} + q̇{i} e")]
        }
        (Step::Acceleration, Revolute) => &[(
            Quantity::Acceleration,
            "c̈{i} = R{i}ᵀ (c̈{p} + ω̇{p} × r{r} + ω{p} × (ω{p} × r{r})) + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})",
        )],
        (Step::Acceleration, Prismatic) => &[(
            Quantity::Acceleration,
            "c̈{i} = R{i}ᵀ (c̈{p} + ω̇{p} × r{r} + ω{p} × (ω{p} × r{r})) + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i}) \
             + q̈{i} e + 2 q̇{i} ω{i} × e",
        )],
        (Step::Gravity, _) => &[(Quantity::Gravity, "g{i} = R{i}ᵀ g{p}")],
        (Step::Wrenches, _) if has_first_moment => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i} + h{i} × c̈{i}"),
            (Quantity::JointForce, "f{p},{i} = m{i} (c̈{i} - g{i}) + ω̇{i} × h{i} + ω{i} × (ω{i} × h{i}) + f{i},{n}"),
            (Quantity::JointMoment, "n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{rn} × f{i},{n} - h{i} × g{i}"),
        ],
        (Step::Wrenches, _) => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}"),
            (Quantity::JointForce, "f{p},{i} = m{i} (c̈{i} - g{i}) + f{i},{n}"),
            (Quantity::JointMoment, "n{p},{i} = n{i} + n{i},{n} + d{i} × f{p},{i} + r{rn} × f{i},{n}"),
        ],
        (Step::Torque, _) => return with_followers(numbers, of_torque, kind),
        (Step::Beyond, _) => &[],
    };
    written(templates, numbers)
}

/// Returns step 7 of one joint.
fn of_torque(kind: JointKind, numbers: &Numbers) -> Vec<Formula> {
    let templates: Templates = match (kind, numbers.is_follower) {
        (Revolute, false) => &[(Quantity::Torque, "τ{i} = e · n{p},{i}")],
        (Revolute, true) => &[(Quantity::AxisTorque, "τ'{i} = e · n{p},{i}")],
        (Prismatic, false) => &[(Quantity::Torque, "τ{i} = e · f{p},{i}")],
        (Prismatic, true) => &[(Quantity::AxisTorque, "τ'{i} = e · f{p},{i}")],
    };
    written(templates, numbers)
}

/// Returns step 7 of one joint, in the reduced form.
fn of_reduced_torque(kind: JointKind, numbers: &Numbers) -> Vec<Formula> {
    let templates: Templates = match (kind, numbers.is_follower) {
        (Revolute, false) => &[(Quantity::Torque, "τ{i} = z · n{i}")],
        (Revolute, true) => &[(Quantity::AxisTorque, "τ'{i} = z · n{i}")],
        (Prismatic, false) => &[(Quantity::Torque, "τ{i} = u · f{i}")],
        (Prismatic, true) => &[(Quantity::AxisTorque, "τ'{i} = u · f{i}")],
    };
    written(templates, numbers)
}

/// Returns the formulas of a step for a payload, which is treated as the link after the last one: `{p}` is the last
/// link, and R is the rotation from tip axes to its axes.
pub(super) fn payload_formulas(step: Step, numbers: &Numbers) -> Vec<Formula> {
    let templates: Templates = match step {
        Step::AngularVelocity => &[(Quantity::Omega, "ω{i} = Rᵀ ω{p}")],
        Step::AngularAcceleration => &[(Quantity::OmegaDot, "ω̇{i} = Rᵀ ω̇{p}")],
        Step::Acceleration => &[(
            Quantity::Acceleration,
            "c̈{i} = Rᵀ (c̈{p} + ω̇{p} × r{r} + ω{p} × (ω{p} × r{r})) + ω̇{i} × com{i} + ω{i} × (ω{i} × com{i})",
        )],
        Step::Gravity => &[(Quantity::Gravity, "g{i} = Rᵀ g{p}")],
        Step::Wrenches => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}"),
            (Quantity::JointForce, "f{p},{i} = m{i} (c̈{i} - g{i})"),
            (Quantity::JointMoment, "n{p},{i} = n{i} + com{i} × f{p},{i}"),
        ],
        Step::Velocity | Step::Torque | Step::Beyond => &[],
    };
    written(templates, numbers)
}

/// Returns the formulas of a step for a floating base; a is the acceleration of the origin of frame 0, F and N are the
/// force and the moment that must act on the base.
pub(super) fn base_formulas(step: Step, numbers: &Numbers) -> Vec<Formula> {
    let templates: Templates = match step {
        Step::Acceleration => &[(Quantity::BaseAcceleration, "c̈{i} = a{i} + ω̇{i} × d{i} + ω{i} × (ω{i} × d{i})")],
        Step::Wrenches => &[
            (Quantity::InertiaMoment, "n{i} = I{i} ω̇{i} + ω{i} × I{i} ω{i}"),
            (Quantity::BaseForce, "F{i} = m{i} (c̈{i} - g{i}) + f{i},{n}"),
            (Quantity::BaseMoment, "N{i} = n{i} + n{i},{n} + d{i} × F{i} + r{rn} × f{i},{n}"),
        ],
        _ => &[],
    };
    written(templates, numbers)
}

/// Returns the formulas of the reduced form that correspond to a step. The order of their terms and the frame in which
/// they are computed are choices of the plan.
pub(super) fn reduced_formulas(step: Step, kind: JointKind, numbers: &Numbers) -> Vec<Formula> {
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
        (Step::Torque, _) => return with_followers(numbers, of_reduced_torque, kind),
        // gravity is included in the acceleration of the base, and the velocity is not needed
        (Step::Velocity | Step::Gravity | Step::Beyond, _) => &[],
    };
    written(templates, numbers)
}

fn written(templates: Templates, numbers: &Numbers) -> Vec<Formula> {
    templates.iter().map(|&(quantity, template)| Formula { quantity, text: text(template, numbers) }).collect()
}

/// Returns the formulas of step 7. Each joint that follows this one adds a term: its ratio times the torque that its
/// own actuator would deliver.
fn with_followers(
    numbers: &Numbers,
    of: impl Fn(JointKind, &Numbers) -> Vec<Formula>,
    kind: JointKind,
) -> Vec<Formula> {
    let mut formulas = of(kind, numbers);
    for formula in &mut formulas {
        for (ratio, kind, numbers) in &numbers.followers {
            for follower in of(*kind, numbers) {
                let term = follower.text.split_once("= ").map_or("", |(_, term)| term);
                let sign = if *ratio < 0.0 { "-" } else { "+" };
                let factor = if ratio.abs() == 1.0 { String::new() } else { format!("{} ", ratio.abs()) };
                formula.text.extend([" ", sign, " ", &factor, term]);
            }
        }
    }
    formulas
}

fn text(template: &str, numbers: &Numbers) -> String {
    let Numbers { joint, parent, lever, carried, .. } = numbers;
    let terms = template.split_inclusive(" + ").flat_map(|part| part.split_inclusive(" - "));
    // each term ends with the operator before the next term
    let mut text = String::new();
    for term in terms {
        let (term, operator) = match term.strip_suffix(" + ").map(|term| (term, " + ")) {
            Some(split) => split,
            None => term.strip_suffix(" - ").map_or((term, ""), |term| (term, " - ")),
        };
        if term.contains("{n}") {
            text += &carried.iter().map(|next| next.term(term)).collect::<Vec<_>>().join(" + ");
            if carried.is_empty() {
                // the term is left out, with the operator before it
                text.truncate(text.trim_end_matches([' ', '+']).len());
            }
        } else {
            text += term;
        }
        text += operator;
    }
    text.replace("{i}", joint).replace("{p}", parent).replace("{r}", lever)
}

#[cfg(test)]
mod tests {
    use rne_codegen::Form;

    use super::*;

    const TREE: &str = include_str!("../../../docs/tree.yaml");
    const TIPS: &str = include_str!("../../../docs/dual_arm.yaml");

    fn of(file: &str, function: Function, joint: usize, form: Form) -> Vec<String> {
        let robot = rne_model::Reader::new("tree.yaml").trees().read(file).unwrap().robot;
        let (kind, numbers) = (robot.joints[joint - 1].row.kind, Numbers::of(&robot, joint, function));
        let formulas = match form {
            Form::SevenSteps => formulas(Step::Wrenches, kind, &numbers, false),
            Form::Reduced => reduced_formulas(Step::Wrenches, kind, &numbers),
        };
        // the names of the wrenches in the formulas must be names in the code
        let program = rne_codegen::Compiler::new(&robot).compile(function, Form::SevenSteps).unwrap();
        let code = crate::rust_file(&robot, &[program]);
        for formula in &formulas {
            let words = formula.text.split_whitespace().filter(|word| word.contains('t') && !word.contains("antisym"));
            words.for_each(|word| assert!(code.contains(&format!("{word}_")), "{word}"));
        }
        formulas.into_iter().map(|formula| formula.text).collect()
    }

    fn texts(joint: usize, step: Step) -> Vec<String> {
        let robot = rne_model::Reader::new("tree.yaml").trees().read(TREE).unwrap().robot;
        let (kind, numbers) = (robot.joints[joint - 1].row.kind, Numbers::of(&robot, joint, Function::InverseDynamics));
        formulas(step, kind, &numbers, false).into_iter().map(|formula| formula.text).collect()
    }

    #[test]
    fn tips_of_a_tree_are_in_the_formulas_of_functions_that_take_wrenches() {
        use Form::{Reduced, SevenSteps};
        // finger 3 carries the tip, and joint 5 is the last joint
        assert_eq!(
            of(TREE, Function::InverseDynamics, 3, SevenSteps)[1..],
            ["f2,3 = m3 (c̈3 - g3)", "n2,3 = n3 + d3 × f2,3"]
        );
        assert_eq!(
            of(TREE, Function::InverseDynamics, 3, Reduced),
            ["f3 = m a3 + U3 h", "n3 = antisym(U3 S) + h × a3"]
        );
        let [_, force, moment] = of(TREE, Function::InverseDynamicsWithWrench, 3, SevenSteps).try_into().unwrap();
        assert_eq!(force, "f2,3 = m3 (c̈3 - g3) + R6 f5,6");
        assert_eq!(moment, "n2,3 = n3 + R6 n5,6 + d3 × f2,3 + r3 × R6 f5,6");
        assert_eq!(of(TREE, Function::InverseDynamicsWithWrench, 5, SevenSteps)[1], "f1,5 = m5 (c̈5 - g5)");
        // the payload has its own number, 6
        assert_eq!(of(TREE, Function::InverseDynamicsWithPayload, 3, SevenSteps)[1], "f2,3 = m3 (c̈3 - g3) + f3,6");
        // the links of joints 3 and 5 each carry one of the tips, in this order
        for function in [Function::InverseDynamicsWithWrenches, Function::InverseDynamicsOfFloatingBase] {
            assert_eq!(of(TIPS, function, 3, SevenSteps)[1], "f2,3 = m3 (c̈3 - g3) + R6 ft1");
            assert_eq!(of(TIPS, function, 5, SevenSteps)[2], "n4,5 = n5 + R7 nt2 + d5 × f4,5 + r5 × R7 ft2");
            let expected = ["f5 = m a5 + U5 h + R7 ft2", "n5 = antisym(U5 S) + h × a5 + R7 nt2 + p7 × R7 ft2"];
            assert_eq!(of(TIPS, function, 5, Reduced), expected);
        }
        assert_eq!(of(TIPS, Function::InverseDynamics, 5, SevenSteps)[1], "f4,5 = m5 (c̈5 - g5)");
        // A chain with a floating base is not a robot file of format 1, whose texts must not change.
        let satellite = include_str!("../../../docs/satellite.yaml");
        assert_eq!(of(satellite, Function::InverseDynamics, 2, SevenSteps)[1], "f1,2 = m2 (c̈2 - g2)");
        assert_eq!(of(satellite, Function::InverseDynamicsWithWrench, 2, Reduced)[0], "f2 = m a2 + U2 h + R3 f2,3");
        // one link carries both a joint and a tip
        let both = TIPS.replace("on: left_elbow", "on: waist");
        let [_, force, moment] = of(&both, Function::InverseDynamicsWithWrenches, 1, SevenSteps).try_into().unwrap();
        assert_eq!(force, "f0,1 = m1 (c̈1 - g1) + f1,2 + f1,4 + R6 ft1");
        assert!(moment.ends_with("r1 × f1,2 + r1_4 × f1,4 + r1_6 × R6 ft1"), "{moment}");
    }

    #[test]
    fn formulas_of_a_tree_name_the_parent_and_all_that_a_link_carries() {
        // the waist carries both arms, 2 and 5; the right arm carries nothing
        assert_eq!(texts(5, Step::AngularVelocity), ["ω5 = R5ᵀ ω1 + q̇5 e"]);
        assert_eq!(texts(5, Step::Velocity), ["ċ5 = R5ᵀ (ċ1 + ω1 × r1_5) + ω5 × d5"]);
        assert_eq!(texts(2, Step::Velocity), ["ċ2 = R2ᵀ (ċ1 + ω1 × r1) + ω2 × d2"]);
        let [moment, force, about] = texts(1, Step::Wrenches).try_into().unwrap();
        assert_eq!(moment, "n1 = I1 ω̇1 + ω1 × I1 ω1");
        assert_eq!(force, "f0,1 = m1 (c̈1 - g1) + f1,2 + f1,5");
        assert_eq!(about, "n0,1 = n1 + n1,2 + n1,5 + d1 × f0,1 + r1 × f1,2 + r1_5 × f1,5");
        let [_, force, about] = texts(5, Step::Wrenches).try_into().unwrap();
        assert_eq!((force, about), ("f1,5 = m5 (c̈5 - g5)".to_owned(), "n1,5 = n5 + d5 × f1,5".to_owned()));
    }
}
