//! Every algorithm that writes a function is that function, under any plan.

use std::fmt::Write;

use super::*;

const FUNCTIONS: [Function; 5] = [
    Function::GravityTorques,
    Function::MassMatrix,
    Function::ForwardDynamics,
    Function::CoriolisMatrix,
    Function::InverseDynamicsDerivatives,
];

/// The program of a function by one of its algorithms; `None` where the plan does not apply.
fn written(robot: &Robot, plan: &Plan, function: Function, algorithm: Algorithm) -> Option<Unproved> {
    Some(lowered(robot, function, frame(robot, plan, function)?.written(plan, function, algorithm)?))
}

#[test]
fn all_algorithms_are_the_seven_steps() {
    for name in SEVERAL.into_iter().chain(["spherical_rrp", "gantry_ppp", "puma560_mdh", "ur5e"]) {
        let robot = robot(name);
        let plan = default_plan(&robot, &[]);
        for function in FUNCTIONS {
            for &algorithm in Algorithm::of(function) {
                let program =
                    written(&robot, &plan, function, algorithm).unwrap_or_else(|| panic!("{name}: {algorithm:?}"));
                if let Err(error) = proof::identical(&robot, &program.0, &program.1, program.2) {
                    panic!("the proof refuses {name}, {algorithm:?}: {error}");
                }
            }
        }
    }
}

/// Articulated bodies take as many operations per joint however many there are; a mass matrix takes more and more.
#[test]
fn long_arms_are_articulated() {
    let chain = |joints: usize| {
        let mut text =
            "format: 1\nname: chain\nsource: no arm\nconvention: modified\ngravity: [1, 2, -9]\njoints:\n".to_owned();
        for joint in 1..=joints {
            let _ = write!(
                text,
                "  - type: revolute\n    dh: {{theta: 0, d: 0.2, a: 0.{joint}, alpha: pi/2}}\n    link: {{mass: \
                1.{joint}, \
                 com: [0.01, 0.02, 0.03], inertia: {{xx: 0.2, yy: 0.3, zz: 0.4, xy: 0.01, xz: 0.02, yz: 0.03}}}}\n"
            );
        }
        Robot::from_yaml(&text).unwrap()
    };
    let mut first = None;
    for joints in [4, 6, 8, 10, 12, 14, 16, 20] {
        let robot = chain(joints);
        let plan = Plan::new(joints);
        let mut evaluator = Evaluator::new(&robot, Function::ForwardDynamics);
        let costs: Vec<(usize, Algorithm)> = Algorithm::of(Function::ForwardDynamics)
            .iter()
            .map(|&algorithm| (evaluator.cost_of(&plan, algorithm).unwrap().total(), algorithm))
            .collect();
        let best = costs.iter().min_by_key(|(total, _)| *total).unwrap();
        println!("{joints:2} joints: {:?}", costs.iter().map(|(total, _)| *total).collect::<Vec<_>>());
        if matches!(best.1, Algorithm::Aba(_)) && first.is_none() {
            first = Some(joints);
        }
    }
    assert!(first.is_some_and(|joints| joints > 6), "{first:?}");
}
