//! The steps of a program with the lecture's equations, as a few lines for the documentation of a method.

use rne_codegen::{Form, Program, Statement, Step};
use rne_model::{JointKind, Robot};

use super::formula::{Numbers, formulas, reduced_formulas};
use super::listing::recursion;

/// Returns the formulas of the steps in which a program computes something, for joint i between h = i - 1 and j = i +
/// 1: one line each, with the number of its step. None for a program of another algorithm.
#[must_use]
pub fn steps(robot: &Robot, program: &Program) -> Vec<String> {
    let recursion = recursion(program);
    if recursion == Form::Reduced && program.is_of_bodies() {
        return Vec::new();
    }
    let has = |step: Step| {
        let is_here = |statement: &Statement| statement.place.step == step && statement.place.joint <= program.joints;
        program.statements.iter().any(is_here) || (step == Step::Torque && program.function.returns_torques())
    };
    let has_kind = |kind| robot.rows().any(|row| row.kind == kind);
    let has_first_moment = robot.rows().any(|row| row.link.has_first_moment());
    let written = |step, kind| match recursion {
        Form::SevenSteps => formulas(step, kind, &Numbers::letters(), has_first_moment),
        Form::Reduced => reduced_formulas(step, kind, &Numbers::letters()),
    };
    let mut lines = Vec::new();
    for step in Step::ALL.into_iter().filter(|&step| has(step)) {
        for kind in [JointKind::Revolute, JointKind::Prismatic].into_iter().filter(|&kind| has_kind(kind)) {
            for formula in written(step, kind) {
                let line = format!("{} {}", step.number(), formula.text);
                if lines.contains(&line) {
                    continue;
                }
                // if the robot has both kinds of joints, a formula of prismatic joints is marked
                let is_other = kind == JointKind::Prismatic && has_kind(JointKind::Revolute);
                lines.push(if is_other { format!("{line}   (prismatic)") } else { line });
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use rne_codegen::{Compiler, Function};

    use super::*;

    const PUMA_560: &str = include_str!("../../../robots/puma560.yaml");
    const STANFORD: &str = include_str!("../../../robots/stanford.yaml");

    fn steps_of(file: &str, function: Function, form: Form) -> Vec<String> {
        let robot = Robot::from_yaml(file).expect("it is valid");
        steps(&robot, &Compiler::new(&robot).compile(function, form).expect("it compiles"))
    }

    #[test]
    fn steps_are_those_in_which_something_is_computed() {
        let torques = steps_of(PUMA_560, Function::InverseDynamics, Form::SevenSteps);
        let numbers: String = torques.iter().map(|line| &line[..1]).collect();
        // step 3, the velocity, is not needed; step 6 has three formulas
        assert_eq!(numbers, "12456667", "{torques:#?}");
        assert!(torques.contains(&"1 ωi = Riᵀ ωh + q̇i e".to_owned()), "{torques:#?}");
        assert!(torques.contains(&"6 nh,i = ni + ni,j + di × fh,i + ri × fi,j".to_owned()), "{torques:#?}");
        let gravity = steps_of(PUMA_560, Function::GravityTorques, Form::SevenSteps);
        assert!(gravity.iter().all(|line| !line.starts_with(['1', '2', '4'])), "{gravity:#?}");
        assert!(gravity.last().is_some_and(|line| line == "7 τi = e · nh,i"), "{gravity:#?}");
    }

    #[test]
    fn both_kinds_of_joint_are_told_apart() {
        let torques = steps_of(STANFORD, Function::InverseDynamics, Form::SevenSteps);
        let of_torque: Vec<_> = torques.iter().filter(|line| line.starts_with('7')).collect();
        assert_eq!(of_torque, ["7 τi = e · nh,i", "7 τi = e · fh,i   (prismatic)"]);
    }

    #[test]
    fn other_algorithms_have_no_steps() {
        assert_eq!(steps_of(PUMA_560, Function::MassMatrix, Form::Reduced), [""; 0]);
    }
}
