//! Random robots in the reduced form, by no plans at all, by random ones and by those of a build: the proof passes,
//! and the torques are the runtime's but for rounding.

use fastrand::Rng;
use rne::{Arm, DynArm, InverseDynamics, Wrench};
use rne_codegen::plan::{JointPlan, Moment, OriginShift, Plan, PlanSet, RegroupingTarget, Scale, Side};
use rne_codegen::{CompileError, Compiler, Form, Function, Program};
use rne_model::Robot;

use super::interpreted::{State, interpreted, runtime};
use super::robots;

/// Relative to the largest torque of the state.
const TOLERANCE: f64 = 1e-11;

fn largest(torques: &[f64]) -> f64 {
    torques.iter().fold(0.0_f64, |largest, torque| largest.max(torque.abs()))
}

/// The largest difference; torques that vanish but for rounding are measured by those of motion.
pub(crate) fn error(found: &[f64], expected: &[f64], of_motion: &[f64]) -> f64 {
    let differences: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
    let scale = largest(expected).max(1e-2 * largest(of_motion));
    if scale == 0.0 { largest(&differences) } else { largest(&differences) / scale }
}

fn one<T: Copy>(rng: &mut Rng, of: &[T]) -> T {
    of[rng.usize(..of.len())]
}

/// Random choices, about one in `rarity` of them made.
fn random_plan(rng: &mut Rng, dof: usize, rarity: usize) -> Plan {
    let mut plan = Plan::new(dof);
    plan.turned_last_frame = rng.usize(..rarity) == 0;
    plan.carried_prismatics = rng.usize(..rarity) == 0;
    plan.gyrostat = rng.usize(..rarity * 4) == 0;
    if rng.usize(..rarity) == 0 {
        let joint = rng.usize(..dof) + 1;
        plan.length_scale = one(rng, &[Scale::A(joint), Scale::D(joint), Scale::FirstMoment(joint, 0)]);
        plan.force_scale = one(rng, &[Scale::Default, Scale::One, Scale::Mass(joint)]);
    }
    for joint in &mut plan.joints {
        let mut is_made = || rng.usize(..rarity) == 0;
        let [targets, origin_shift, outward, inward, moment] = [(); 5].map(|()| is_made());
        let on = &mut joint.switches;
        for switch in [
            &mut on.axis_column,
            &mut on.scaled_twist_outward,
            &mut on.scaled_twist_inward,
            &mut on.origin_unturned,
            &mut on.omega_dot_unturned,
            &mut on.first_moment_unturned,
            &mut on.second_moment_unturned,
            &mut on.wrench_unturned,
            &mut on.group_omega,
            &mut on.group_omega_dot,
            &mut on.group_acceleration,
            &mut on.group_wrench,
        ] {
            *switch = is_made();
        }
        let plain = JointPlan::default();
        if targets {
            joint.targets = [0, 1, 2].map(|target| one(rng, RegroupingTarget::CHOICES[target]));
        }
        joint.origin_shift = if origin_shift { one(rng, &OriginShift::ALL) } else { plain.origin_shift };
        joint.outward_offset = if outward { one(rng, &Side::ALL) } else { plain.outward_offset };
        joint.inward_offset = if inward { Side::Parent } else { plain.inward_offset };
        joint.moment = if moment { one(rng, &Moment::ALL) } else { plain.moment };
    }
    plan
}

/// Compares a function under some choices at a few states; nothing when the choices do not fit the robot.
fn agrees(robot: &Robot, arm: &DynArm, plans: &PlanSet, function: Function, rng: &mut Rng) -> Option<Program> {
    let program = match Compiler::new(robot).with_plans(plans).compile(function, Form::Reduced) {
        Ok(program) => program,
        Err(CompileError::PlanDoesNotFit { .. }) => return None,
        Err(error) => panic!("{}: {error}\n{:#?}", robot.name, plans.plan.choices()),
    };
    let proof = program.proof.expect("a proof");
    assert!(proof.rounding <= TOLERANCE, "{}: {proof:?}", robot.name);
    for _ in 0..3 {
        let state = State::random(rng, robot.dof());
        let of_motion = runtime(arm, Function::InverseDynamics, &state);
        let error = error(&interpreted(&program, &state), &runtime(arm, function, &state), &of_motion);
        assert!(error <= TOLERANCE, "{}, {function}: {error}", robot.name);
    }
    Some(program)
}

fn read(seed: u64, dof: usize) -> (Robot, DynArm) {
    let robot = Robot::from_yaml(&robots::yaml(seed, dof)).unwrap_or_else(|report| panic!("{report}"));
    let arm = DynArm::from_robot(&robot);
    (robot, arm)
}

#[test]
fn reduced_forms_of_random_robots_are_the_runtime() {
    let mut rng = Rng::with_seed(60);
    let mut planned = 0_u64;
    let robots = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 60 } else { 12 };
    for seed in 1000..1000 + robots {
        let dof = rng.usize(1..=8);
        let (robot, arm) = read(seed, dof);
        for function in Function::TORQUES {
            let plain = agrees(&robot, &arm, &PlanSet::from(Plan::new(dof)), function, &mut rng);
            assert!(plain.is_some(), "{}: no choice fits every robot", robot.name);
            for rarity in [3, 8] {
                let plans = PlanSet::from(random_plan(&mut rng, dof, rarity));
                planned += u64::from(agrees(&robot, &arm, &plans, function, &mut rng).is_some());
            }
        }
    }
    assert!(planned > 100 * robots / 60, "{planned} random plans fitted");
}

#[test]
fn the_choice_of_a_build_fits_random_robots() {
    let mut rng = Rng::with_seed(5);
    for seed in 2000..2012 {
        let (robot, arm) = read(seed, rng.usize(1..=4));
        let plans = PlanSet::default_of(&robot);
        for function in Function::TORQUES {
            assert!(agrees(&robot, &arm, &plans, function, &mut rng).is_some(), "{}", robot.name);
        }
    }
}

macro_rules! compiled {
    ($($robot:ident $dof:literal $path:literal)*) => {
        $(
            #[derive(rne::InverseDynamics)]
            #[robot(path = $path, form = "reduced", allow_lints)]
            struct $robot;
        )*

        #[test]
        fn compiled_reduced_forms_of_random_robots_are_the_runtime() {
            $(compiled_agrees::<$dof>(&$robot, $path);)*
        }
    };
}

fn compiled_agrees<const DOF: usize>(robot: &impl InverseDynamics<DOF>, path: &str) {
    let path = format!("{}/tests/random/{path}", env!("CARGO_MANIFEST_DIR"));
    let arm: Arm<DOF> = Arm::from_file(&path).unwrap_or_else(|error| panic!("{error}"));
    let mut rng = Rng::with_seed(5);
    for _ in 0..100 {
        let mut array = |scale: f64| [(); DOF].map(|()| (2.0 * rng.f64() - 1.0) * scale);
        let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        let of_motion = arm.inverse_dynamics(&q, &qd, &qdd);
        for (found, expected) in [
            (robot.inverse_dynamics(&q, &qd, &qdd), of_motion),
            (
                robot.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench),
                arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &wrench),
            ),
            (robot.gravity_torques(&q), arm.gravity_torques(&q)),
            (robot.bias_torques(&q, &qd), arm.bias_torques(&q, &qd)),
        ] {
            let error = error(&found, &expected, &of_motion);
            assert!(error <= TOLERANCE, "{path}: {error}");
        }
    }
}

compiled! {
    Reduced02 3 "files/2.yaml"
    Reduced07 2 "files/7.yaml"
    Reduced12 3 "files/12.yaml"
    Reduced22 3 "files/22.yaml"
    Reduced33 4 "files/33.yaml"
    Spindle 5 "files/spindle.yaml"
}
