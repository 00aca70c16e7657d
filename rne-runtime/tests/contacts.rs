//! A robot on a floating base whose tips are held, by the arm that is given the tips.

#![cfg(feature = "std")]

use rne_model::{ContactKind, FixedFrame, Transform};
use rne_runtime::{
    AccelerationsAndWrenches, Arm, ContactDynamics, DynAccelerationsAndWrenches, DynArm, DynFloatingAccelerations,
    FloatingBase, FloatingKinematics, ForwardDynamics, Wrench,
};

const JOINTS: usize = 3;
const TIPS: usize = 3;

/// A tip on a leg of two joints, and two on a leg of one joint.
fn robot(contacts: &str) -> (Arm<JOINTS>, DynArm) {
    let link = "link: {mass: 2, com: [0.1, -0.05, 0.2], inertia: {xx: 0.03, yy: 0.04, zz: 0.05, xy: 0.01}}";
    let text = format!(
        "{{format: 2, name: biped, source: own, convention: modified, gravity: [0.3, -0.2, -9.81], tool: {{on: knee}}, \
         floating_base: {{name: trunk, {link}}}, joints: [\
         {{name: hip, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.1, alpha: 0.3}}, {link}}}, \
         {{name: knee, type: revolute, dh: {{theta: 0, d: 0, a: 0.4, alpha: 0}}, {link}}}, \
         {{name: other, parent: base, type: prismatic, dh: {{gamma: 0, b: 0, theta: 0.2, d: 0, a: -0.1, alpha: -0.4}}, \
         {link}}}], frames: [\
         {{name: foot, on: knee, xyz: [0.4, 0, 0.1]}}, \
         {{name: heel, on: other, xyz: [0, 0.1, 0]}}, \
         {{name: toe, on: other, xyz: [0, -0.2, 0.1], rpy: [0.4, 0, 0.2]}}], \
         tips: [foot, heel, toe], contacts: [{contacts}]}}"
    );
    (Arm::from_yaml(&text).expect("a robot"), DynArm::from_yaml(&text).expect("a robot"))
}

const Q: [f64; JOINTS] = [0.3, -0.7, 0.2];
const QD: [f64; JOINTS] = [0.5, -0.4, 0.3];
const TAU: [f64; JOINTS] = [1.0, -2.0, 3.0];
const OMEGA: [f64; 3] = [0.2, -0.3, 0.4];
/// A turn by a right angle about the diagonal of the axes.
const TURNED: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn held(arm: &Arm<JOINTS>, of_file: &DynArm) -> AccelerationsAndWrenches<JOINTS, TIPS, f64> {
    let kind = |tip: usize| of_file.contacts().iter().find(|contact| contact.tip == tip).map(|contact| contact.kind);
    let tips = of_file.tips().first_chunk::<TIPS>().expect("three tips");
    let kinds = [0, 1, 2].map(kind);
    arm.with_tips::<9, TIPS>(tips).in_contact(&kinds).forward_dynamics_in_contact(&Q, &QD, &TAU, &OMEGA, &TURNED)
}

/// With its base welded to the world, it is the robot on a fixed base.
#[test]
fn a_welded_base_is_a_fixed_one() {
    let (arm, _) = robot("");
    let level = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let placement = Transform { xyz: [0.1, 0.2, 0.3], ..Transform::IDENTITY };
    let tips = [None, Some(1)].map(|on| FixedFrame { on, placement });
    let kinds = [Some(ContactKind::Weld), None];
    let with_tips = arm.with_tips::<9, 2>(&tips).in_contact(&kinds);
    let found = with_tips.forward_dynamics_in_contact(&Q, &QD, &TAU, &[0.0; 3], &level);
    for (found, expected) in found.accelerations.qdd.iter().zip(arm.forward_dynamics(&Q, &QD, &TAU)) {
        assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
    }
    let upward = [-0.3, 0.2, 9.81];
    for (found, expected) in found.accelerations.base.linear.iter().zip(upward) {
        assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
    }
    assert_eq!(found.wrenches_on_robot[1], Wrench::zero());
}

/// M x + bias = (0, τ) + Jᵀ f, and J x + J̇ v + g = -μ f.
#[test]
fn both_kinds_of_arm_give_the_solution_of_the_equations() {
    for contacts in ["", "{tip: foot, kind: point}", "{tip: foot, kind: weld}, {tip: toe, kind: point}"] {
        let (arm, of_file) = robot(contacts);
        let tips = of_file.tips().first_chunk::<TIPS>().expect("three tips");
        let found = held(&arm, &of_file);
        let DynAccelerationsAndWrenches {
            accelerations: DynFloatingAccelerations { base, qdd },
            wrenches_on_robot: wrenches,
        } = of_file.forward_dynamics_in_contact(&Q, &QD, &TAU, &OMEGA, &TURNED).expect("their lengths");
        assert_eq!(found.accelerations.base, base, "{contacts}");
        assert_eq!(found.accelerations.qdd.as_slice(), qdd, "{contacts}");
        assert_eq!(found.wrenches_on_robot.as_slice(), wrenches, "{contacts}");

        let x = [base.linear.as_slice(), &base.angular, &qdd].concat();
        let dot = |row: &[f64]| row.iter().zip(&x).map(|(a, b)| a * b).sum::<f64>();
        let arm = arm.with_tips::<9, TIPS>(tips);
        let jacobians = arm.tip_jacobians(&Q, &TURNED);
        let forces = wrenches.iter().map(|wrench| [wrench.force, wrench.moment].concat()).collect::<Vec<_>>();
        let mass = arm.floating_mass_matrix(&Q);
        let bias = arm.floating_bias(&Q, &QD, &OMEGA, &[Wrench::zero(); TIPS]);
        for row in 0..9 {
            let of_contacts: f64 = (0..TIPS)
                .flat_map(|tip| (0..6).map(move |k| (tip, k)))
                .map(|(tip, k)| jacobians[tip][k][row] * forces[tip][k])
                .sum();
            let applied = if row < 6 { 0.0 } else { TAU[row - 6] };
            let rest = dot(&mass[row]) + bias[row] - applied - of_contacts;
            assert!(rest.abs() < 1e-9, "{contacts}, row {row}: {rest}");
        }
        let without = arm.tip_accelerations(&Q, &QD, &OMEGA, &TURNED);
        for contact in of_file.contacts() {
            for row in 0..contact.rows() {
                let gravity = if row < 3 { [0.3, -0.2, -9.81][row] } else { 0.0 };
                let acceleration = dot(&jacobians[contact.tip][row]) + without[contact.tip][row] + gravity;
                let given_way = -1e-8 * forces[contact.tip][row];
                assert!((acceleration - given_way).abs() < 1e-9, "{contacts}, row {row}: {acceleration}");
            }
        }
    }
}
