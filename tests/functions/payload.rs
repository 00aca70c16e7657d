//! A payload against the table that has it: mass, centre of mass and inertia of the last link with the payload lumped
//! in, by nalgebra.

use fastrand::Rng;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rne::{DynArm, Payload, Wrench};
use rne_codegen::{Argument, Axes, Function, Load};
use rne_model::{Inertia, Link, Robot};

use crate::arm::{Arm, Given, Maker, of_runtime};
use crate::case::{self, Case, largest};
use crate::check::{Conditioning, Worst, conditioning, error_on_scale, relative_error};
use crate::equality::error_of_accelerations;
use crate::golden::ROBOTS;

const TOLERANCE: f64 = 1e-13;

/// I about a point from which the centre of mass is at `c`: I + m (c·c 1 - c cᵀ).
fn about(inertia: Matrix3<f64>, mass: f64, c: Vector3<f64>) -> Matrix3<f64> {
    inertia + (Matrix3::identity() * c.dot(&c) - c * c.transpose()) * mass
}

/// The last link as one body with the payload, in its link frame.
fn lumped(link: &Link, tool: (Rotation3<f64>, Vector3<f64>), payload: &Payload<f64>) -> Link {
    let (rotation, translation) = tool;
    let com = rotation * Vector3::from(payload.com) + translation;
    let inertia = rotation * Matrix3::from(payload.inertia.rows()) * rotation.transpose();
    let (own, mass) = (Vector3::from(link.com), link.mass + payload.mass);
    // without mass a link is about the origin of its frame
    let moment = Vector3::from(link.first_moment);
    let centre = (own * link.mass + com * payload.mass + moment) / mass;
    let mut j =
        about(Matrix3::from(link.inertia.rows()), link.mass, own - centre) + about(inertia, payload.mass, com - centre);
    // + 2 h·t 1 - h tᵀ - t hᵀ, t = -centre
    j += moment * centre.transpose() + centre * moment.transpose() - Matrix3::identity() * (2.0 * moment.dot(&centre));
    let inertia = Inertia { xx: j.m11, yy: j.m22, zz: j.m33, xy: j.m12, xz: j.m13, yz: j.m23 };
    Link { mass, com: centre.into(), inertia, ..Link::default() }
}

/// The runtime's arm whose link with the tip has the payload.
pub(crate) fn carrying(robot: &Robot, payload: &Payload<f64>) -> DynArm {
    let [roll, pitch, yaw] = robot.tool.rpy.map(|angle| angle.radians);
    let tool = (Rotation3::from_euler_angles(roll, pitch, yaw), Vector3::from(robot.tool.xyz));
    let mut robot = robot.clone();
    let on = robot.tip_on.unwrap_or(robot.joints.len() - 1);
    let link = &mut robot.joints[on].row.link;
    *link = lumped(link, tool, payload);
    DynArm::from_robot(&robot)
}

/// The largest error at a state, of the torques or, where these vanish, of a hundredth of what the joints carry.
fn error(arm: &Arm, payload: &Payload<f64>, [q, qd, qdd]: [&[f64]; 3]) -> f64 {
    let lumped = carrying(&arm.robot, payload);
    let expected = lumped.inverse_dynamics(q, qd, qdd).expect("one per joint");
    let wrenches = lumped.joint_wrenches(q, qd, qdd).expect("one per joint");
    let parts = wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment]).flatten();
    let scale = parts.fold(0.0, |scale: f64, part| scale.max(part.abs()));
    error_on_scale(&arm.inverse_dynamics_with_payload(q, qd, qdd, payload), &expected, 1e-2 * scale)
}

#[test]
fn random_arms_carry_it_as_their_own_link() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for Case { arm, q, qd, qdd, payload, .. } in case::cases(maker) {
            worst.see("τ", error(arm, payload, [q, qd, qdd]));
        }
        worst.at_most(TOLERANCE, &format!("payload of random arms, {maker}"));
    }
}

#[test]
fn shipped_arms_carry_it_as_their_own_link() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for name in ROBOTS.iter() {
            let arm = Arm::from_file(&format!("robots/{name}.yaml"), maker);
            let mut rng = Rng::with_seed(7);
            for _ in 0..8 {
                let mut array = |range: f64| -> Vec<f64> {
                    (0..arm.robot.dof()).map(|_| (2.0 * rng.f64() - 1.0) * range).collect()
                };
                let (q, qd, qdd) = (array(3.0), array(2.0), array(5.0));
                worst.see("τ", error(arm, &case::payload(&mut rng), [&q, &qd, &qdd]));
            }
        }
        worst.at_most(TOLERANCE, &format!("payload of shipped arms, {maker}"));
    }
}

/// The arm that `--payload` makes for functions without a payload is the lumped one.
#[test]
fn a_link_that_carries_it_is_the_lumped_one() {
    let mut worst = Worst::default();
    for case in case::cases(Maker::Runtime) {
        let Case { arm, payload, .. } = case;
        let carried = rne_convert::carrying(&arm.robot, payload.mass, payload.com, payload.inertia);
        let (carried, lumped) = (DynArm::from_robot(&carried), carrying(&arm.robot, payload));
        for function in [Function::InverseDynamics, Function::KineticEnergy, Function::CentreOfMass] {
            let [found, expected] = [&carried, &lumped].map(|arm| of_runtime(arm, function, &case.given()));
            worst.see(function.name(), error_on_scale(&found, &expected, 1.0));
        }
    }
    worst.at_most(TOLERANCE, "a link that carries a payload");
}

/// The largest derivative of the torques at the accelerations of an arm.
fn of_torques(arm: &DynArm, given: &Given<'_, f64>) -> f64 {
    let qdd = &of_runtime(arm, Function::ForwardDynamics, given);
    let of = |function| largest(&of_runtime(arm, function, &Given { qdd, ..*given }));
    of(Function::InverseDynamicsDerivatives).max(1e-2 * of(Function::JointWrenches))
}

/// The functions that have one with a payload, and those with it: with free tips, or with wrenches of zero.
fn pairs() -> impl Iterator<Item = (Function, Function)> {
    let with = Function::OF_TREES.into_iter().filter(|function| function.takes(Argument::Payload));
    with.map(|with| {
        let of_load = |load| Function::find(Axes { load, ..with.axes() });
        (of_load(Load::Free).or_else(|| of_load(Load::Wrenches)).expect("a function without a payload"), with)
    })
}

/// Whether a function solves by the mass matrix.
const fn is_solved(function: Function) -> bool {
    matches!(function, Function::ForwardDynamics | Function::FloatingForwardDynamics)
}

/// The condition of the matrix that a function solves by.
fn condition_of(arm: &DynArm, function: Function, q: &[f64]) -> Option<Conditioning> {
    let matrix = if function.is_of_floating_base() { arm.floating_mass_matrix(q) } else { arm.mass_matrix(q) };
    conditioning(&matrix.expect("one per joint")).filter(|condition| condition.number < 1e8)
}

/// Every function with a payload is the function without one of the arm whose last link has the payload.
#[test]
fn every_function_is_that_of_the_lumped_arm() {
    assert_eq!(pairs().count(), 12);
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for case in case::cases(maker) {
            let lumped = carrying(&case.arm.robot, &case.payload);
            let given = Given { wrench: Wrench::zero(), ..case.given() };
            let of = |function| largest(&of_runtime(&lumped, function, &given));
            for (without, with) in pairs() {
                let found = case.arm.numbers(with, &given);
                let expected = of_runtime(&lumped, without, &given);
                let condition = condition_of(&lumped, without, &case.q);
                let scale = match without {
                    _ if is_solved(without) => {
                        // as in the comparison with the runtime
                        let Some(Conditioning { number, largest: of_matrix }) = condition else { continue };
                        let bias = match without {
                            Function::ForwardDynamics => Function::BiasTorques,
                            _ => Function::FloatingBias,
                        };
                        let scale = largest(given.tau).max(of(bias)) / of_matrix;
                        worst.see(with.name(), error_on_scale(&found, &expected, scale) / number.max(1.0));
                        continue;
                    }
                    Function::ForwardDynamicsDerivatives => {
                        let Some(of_mass) = condition else { continue };
                        let error = error_of_accelerations(&found, &expected, of_torques(&lumped, &given), &of_mass);
                        worst.see(with.name(), error);
                        continue;
                    }
                    Function::MassMatrix | Function::FloatingMassMatrix => of(Function::MassMatrix),
                    Function::MomentumAndRate => 0.0,
                    _ => 1e-2 * of(Function::JointWrenches),
                };
                worst.see(with.name(), error_on_scale(&found, &expected, scale));
            }
        }
        worst.at_most(TOLERANCE, &format!("functions with a payload, {maker}"));
    }
}

/// A payload of zero gives the numbers of the function without one; the seven steps and the runtime give its bits.
#[test]
fn without_mass_and_inertia_every_function_is_that_of_the_arm_alone() {
    for maker in Maker::ALL {
        let mut worst = Worst::default();
        for case in case::cases(maker) {
            let given = Given { payload: Payload::none(), wrench: Wrench::zero(), ..case.given() };
            for (without, with) in pairs() {
                let (found, expected) = (case.arm.numbers(with, &given), case.arm.numbers(without, &given));
                if maker != Maker::Code(rne_codegen::Form::Reduced) {
                    // accelerations of a singular mass matrix are not numbers
                    if expected.iter().all(|x| x.is_finite()) {
                        assert_eq!(found, expected, "{with}");
                    }
                    continue;
                }
                let condition = condition_of(&case.arm.runtime, without, &case.q);
                if without == Function::ForwardDynamicsDerivatives {
                    let Some(of_mass) = condition else { continue };
                    let of_torques = of_torques(&case.arm.runtime, &given);
                    worst.see(with.name(), error_of_accelerations(&found, &expected, of_torques, &of_mass));
                    continue;
                }
                let number = match (is_solved(without), condition) {
                    (true, Some(condition)) => condition.number,
                    (true, None) => continue,
                    (false, _) => 1.0,
                };
                let scale = largest(&of_runtime(&case.arm.runtime, Function::JointWrenches, &given));
                worst.see(with.name(), error_on_scale(&found, &expected, 1e-2 * scale) / number);
            }
        }
        worst.at_most(TOLERANCE, &format!("functions with a payload of zero, {maker}"));
    }
}

#[test]
fn without_mass_and_inertia_it_is_the_arm_alone() {
    case::holds("no payload", |case, worst| {
        let nothing = Payload { com: [0.3, -0.2, 0.1], ..Payload::default() };
        let found = case.arm.inverse_dynamics_with_payload(&case.q, &case.qd, &case.qdd, &nothing);
        worst.see("τ", relative_error(&found, &case.tau()));
    });
}

/// What a payload of one kilogram adds to an arm at rest is a weight at its point.
#[test]
fn a_kilogram_at_rest_weighs_as_its_wrench() {
    case::holds("weight of a payload", |case, worst| {
        let (q, rest) = (&case.q, vec![0.0; case.q.len()]);
        let bob = Payload { mass: 1.0, com: case.payload.com, ..Payload::none() };
        // the arm bears the weight: it exerts -m g on the payload, in tip axes
        let axes = case.arm.forward_kinematics(q).rotation_matrix();
        let up = axes.transpose() * -case.gravity();
        let moment = Vector3::from(bob.com).cross(&up);
        let wrench = Wrench { force: up.into(), moment: moment.into() };
        let expected = case.arm.inverse_dynamics_with_wrench(q, &rest, &rest, &wrench);
        let found = case.arm.inverse_dynamics_with_payload(q, &rest, &rest, &bob);
        // a joint that bears none of it has the rounding of its sine
        worst.see("τ", error_on_scale(&found, &expected, case.gravity().norm()));
    });
}
