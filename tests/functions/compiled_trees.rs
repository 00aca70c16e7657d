//! Trees that are read when the program runs, beside the runtime: `CompiledArm` shares no formula with `DynArm`.

use rne::compiled::{Arguments, Array, CompiledArm, Destination, Form, Function};
use rne_model::Robot;

use crate::arm::{Arm, Maker, STEP, at_tips, base_rotation};
use crate::check::Worst;
use crate::equality::{error, is_compared};
use crate::tree_functions::State;
use crate::trees::robot;
use crate::{couplings, motors, random_trees};
use rne_codegen::CheckFor as _;

/// States in a run of many.
const STATES: u64 = 5;

const TOLERANCE: f64 = 1e-12;

/// The numbers of a state by the names of the arguments.
fn of_state(robot: &Robot, state: &State) -> Vec<(&'static str, Vec<f64>)> {
    let State { q, qd, qdd, tau, wrench, payload, base } = state;
    let (sin, cos) = q.iter().map(|&q| rne::Scalar::sin_cos(q)).unzip();
    vec![
        ("q", q.clone()),
        ("qd", qd.clone()),
        ("qdd", qdd.clone()),
        ("tau", tau.clone()),
        ("step", vec![STEP]),
        // as the other tests have them
        ("multipliers", tau.clone()),
        ("sin", sin),
        ("cos", cos),
        ("force", wrench.force.to_vec()),
        ("moment", wrench.moment.to_vec()),
        (
            "wrenches",
            at_tips(robot.tip_count(), wrench).iter().flat_map(|it| [it.force, it.moment]).flatten().collect(),
        ),
        ("payload", payload.to_array().to_vec()),
        ("base_omega", base.omega.to_vec()),
        ("omega", base.omega.to_vec()),
        ("base_omega_dot", base.omega_dot.to_vec()),
        ("base_acceleration", base.acceleration.to_vec()),
        ("base_gravity", base.gravity.to_vec()),
        ("twist", [base.velocity, base.omega].concat()),
        ("pose", [&base_rotation().concat()[..], &base.gravity].concat()),
        ("base_rotation", base_rotation().concat()),
    ]
}

fn compare(arm: &CompiledArm, robot: &Robot, seed: u64, worst: &mut Worst) {
    let states: Vec<State> = (0..STATES).map(|state| State::random(31 * seed + state, robot.dof())).collect();
    let mut rows = of_state(robot, &states[0]);
    for state in &states[1..] {
        for ((_, row), (_, more)) in rows.iter_mut().zip(of_state(robot, state)) {
            row.extend(more);
        }
    }
    let arguments = rows.iter().fold(Arguments::new(), |given, (name, row)| {
        given.with(name, Array::Rows(row)).expect("an argument of this name")
    });
    let runtime = Arm::new(robot, Maker::Runtime);
    let is_there = |function: &Function| is_compared(robot, *function) && function.check_base(robot).is_ok();
    for function in Function::OF_TREES.into_iter().filter(is_there) {
        let width = arm.layout(function).len();
        let mut found = vec![f64::NAN; width * states.len()];
        arm.run(function, states.len(), &arguments, Destination::Rows(&mut found)).expect("a function that compiles");
        for (state, found) in states.iter().zip(found.chunks(width)) {
            // the machine fuses products, so that the seven steps have other bits
            let maker = Maker::Code(Form::Reduced);
            worst.see(function.name(), error(&runtime, maker, function, &state.given(), found, TOLERANCE));
        }
    }
}

#[test]
fn a_tree_read_at_run_time_is_the_runtime() {
    let mut worst = Worst::default();
    for seed in 0..if shipped::is_exhaustive() { 100 } else { 4 } {
        let dof = 2 + usize::try_from(seed).expect("small") % 5;
        let text = random_trees::yaml(seed, dof);
        for form in Form::ALL {
            let arm = CompiledArm::from_yaml(&text).expect("a tree").in_form(form);
            compare(&arm, &robot(&text), seed, &mut worst);
        }
    }
    worst.at_most(TOLERANCE, "trees by the machine");
}

/// Followers and motors are not those of the machine: coordinates alone go in and out.
#[test]
fn followers_and_motors_read_at_run_time_are_the_runtime() {
    let mut worst = Worst::default();
    // at seed 34, a constant is a part of one instruction and a value of the next
    for seed in (0..if shipped::is_exhaustive() { 60 } else { 3 }).chain([34]) {
        let dof = 3 + usize::try_from(seed).expect("small") % 3;
        for robot in [couplings::robots(seed, dof).1, motors::robot(seed, dof, motors::Shape::Any, true)] {
            for form in Form::ALL {
                compare(&CompiledArm::from_robot(&robot).in_form(form), &robot, seed, &mut worst);
            }
        }
    }
    worst.at_most(TOLERANCE, "followers and motors by the machine");
}

/// The tip of a tree is on any link; a frame stands in its place.
#[test]
fn a_frame_of_a_tree_is_the_runtime() {
    let text = include_str!("../../docs/tree.yaml");
    let arm = CompiledArm::from_yaml(text).expect("a tree");
    let mut worst = Worst::default();
    compare(&arm, arm.robot(), 7, &mut worst);
    for joint in ["waist", "finger_b", "right"] {
        let at = arm.at_frame(joint).expect("a joint");
        compare(&at, at.robot(), 7, &mut worst);
    }
    worst.at_most(TOLERANCE, "frames of a tree");
}
