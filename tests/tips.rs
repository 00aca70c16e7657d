//! Derived functions of a robot with two tips and a body, against the runtime, the laws of virtual work, and lumping.

use rne::{DynArm, ForwardDynamics, FrameKinematics, InverseDynamics, TipWrenches, Wrench};

const YAML: &str = include_str!("../docs/dual_arm.yaml");

#[derive(InverseDynamics, ForwardDynamics, FrameKinematics, TipWrenches)]
#[robot(path = "../docs/dual_arm.yaml")]
struct Torso;

#[derive(InverseDynamics, ForwardDynamics, TipWrenches)]
#[robot(path = "../docs/dual_arm.yaml", form = "reduced")]
struct Reduced;

/// A chain without the list has one tip.
#[derive(InverseDynamics, TipWrenches)]
#[robot(builtin = "puma560")]
struct Puma560;

const Q: [f64; 5] = [0.4, 0.7, -0.9, 0.3, -1.1];
const QD: [f64; 5] = [0.9, -0.5, 0.3, -0.2, 1.3];
const QDD: [f64; 5] = [-1.2, 2.0, 0.7, 0.4, -0.6];
const LEFT: Wrench<f64> = Wrench { force: [3.0, -7.0, 12.0], moment: [0.5, 0.2, -0.8] };
const RIGHT: Wrench<f64> = Wrench { force: [-4.0, 1.0, 6.0], moment: [-0.1, 0.9, 0.3] };

fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-13 * scale, "{found} {expected}");
    }
}

#[test]
fn tips_have_names_in_the_order_of_the_file() {
    assert_eq!(Torso::TIPS, ["left_hand", "right_hand"]);
    assert_eq!([TorsoTip::LeftHand as usize, TorsoTip::RightHand as usize], [0, 1]);
    assert_eq!((Puma560::TIPS, Puma560Tip::Tip as usize), (["tip"], 0));
    assert_eq!(ReducedTip::RightHand as usize, 1);
}

#[test]
fn both_forms_are_the_runtime() {
    let arm = DynArm::from_yaml(YAML).unwrap_or_else(|report| panic!("{report}"));
    let wrenches = [LEFT, RIGHT];
    let tau = arm.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, &wrenches).expect("lengths");
    assert_eq!(Torso.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, &wrenches).as_slice(), tau);
    near(&Reduced.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, &wrenches), &tau);
    let tau: [f64; 5] = tau.try_into().expect("five joints");
    near(&Torso.forward_dynamics_with_wrenches(&Q, &QD, &tau, &wrenches), &QDD);
    near(&Reduced.forward_dynamics_with_wrenches(&Q, &QD, &tau, &wrenches), &QDD);
    near(&arm.forward_dynamics_with_wrenches(&Q, &QD, &tau, &wrenches).expect("lengths"), &QDD);
    let error = arm.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, &[LEFT]).unwrap_err();
    assert_eq!(error.to_string(), "`wrenches` has 1 element, but the robot has 2 tips");
    // `Arm` does not read the tips of a file: they are an argument
    let arm = rne::Arm::<5>::from_yaml(YAML).unwrap_or_else(|report| panic!("{report}"));
    let tips: [_; 2] = DynArm::from_yaml(YAML).expect("valid").tips().try_into().expect("two");
    let arm = arm.with_tips::<11, 2>(&tips);
    assert_eq!(arm.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, &wrenches), tau);
    near(&arm.forward_dynamics_with_wrenches(&Q, &QD, &tau, &wrenches), &QDD);
}

/// What the wrenches add to the torques does the work that the wrenches do: Σ w · (velocity of the tip), in world axes
/// by poses of the tips at two times.
#[test]
fn wrenches_do_the_work_of_the_torques() {
    let added = |wrenches: &[Wrench<f64>; 2]| -> f64 {
        let (with, without) =
            (Reduced.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, wrenches), Reduced.inverse_dynamics(&Q, &QD, &QDD));
        (0..5).map(|joint| (with[joint] - without[joint]) * QD[joint]).sum()
    };
    let step = 1e-6;
    let poses = [-step, 0.0, step].map(|time| {
        let q = std::array::from_fn(|joint| Q[joint] + time * QD[joint]);
        [Torso.pose_of::<{ Torso::frame("left_hand") }, _>(&q), Torso.pose_of::<{ Torso::frame("right_hand") }, _>(&q)]
    });
    for (tip, wrench) in [LEFT, RIGHT].into_iter().enumerate() {
        let [before, now, after] = [0, 1, 2].map(|time| poses[time][tip]);
        let mut work = 0.0;
        for i in 0..3 {
            let velocity = (after.translation[i] - before.translation[i]) / (2.0 * step);
            let force: f64 = (0..3).map(|k| now.rotation[i][k] * wrench.force[k]).sum();
            work += velocity * force;
        }
        // Rᵀ Ṙ is the cross product with ω in axes of the tip
        let spin = |i: usize, j: usize| -> f64 {
            let rate = |k: usize| (after.rotation[k][j] - before.rotation[k][j]) / (2.0 * step);
            (0..3).map(|k| now.rotation[k][i] * rate(k)).sum()
        };
        let omega = [spin(2, 1), spin(0, 2), spin(1, 0)];
        work += (0..3).map(|k| omega[k] * wrench.moment[k]).sum::<f64>();
        let mut wrenches = [Wrench::default(); 2];
        wrenches[tip] = wrench;
        assert!((added(&wrenches) - work).abs() < 1e-7, "tip {tip}: {} is not {work}", added(&wrenches));
    }
    let both = added(&[LEFT, RIGHT]);
    let sum = added(&[LEFT, Wrench::zero()]) + added(&[Wrench::zero(), RIGHT]);
    assert!((both - sum).abs() < 1e-12, "{both} is not {sum}");
}

/// The hands move the waist and their own arm alone.
#[test]
fn a_wrench_at_one_hand_does_not_reach_the_other_arm() {
    let free = Torso.inverse_dynamics(&Q, &QD, &QDD);
    let left = Torso.inverse_dynamics_with_wrenches(&Q, &QD, &QDD, &[LEFT, Wrench::zero()]);
    assert_eq!(left[3..], free[3..]);
    assert!((0..3).all(|joint| (left[joint] - free[joint]).abs() > 0.1));
}

#[test]
fn one_tip_is_the_tip_of_before() {
    let (q, qd, qdd) = ([0.3, -0.8, 0.5, 1.1, -0.4, 0.9], [0.2; 6], [-0.7; 6]);
    near(
        &Puma560.inverse_dynamics_with_wrenches(&q, &qd, &qdd, &[LEFT]),
        &Puma560.inverse_dynamics_with_wrench(&q, &qd, &qdd, &LEFT),
    );
}
