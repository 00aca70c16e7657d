//! The arm with a number of joints known at run time has the bits of the one with it known at compile time.
#![cfg(feature = "std")]

use crate::common::{Numbers, SIX_BASE, SIX_Q, SIX_WRENCH, model, one_link, six_joints, tool};
use rne_model::Convention::{Modified, Standard};
use rne_model::Model;
use rne_runtime::{Arm, DynArm, InverseDynamics, WrongLength};

#[test]
fn the_same_bits_as_arm() {
    let mut numbers = Numbers::new(3);
    for convention in [Standard, Modified] {
        let model = Model { tool: tool(), ..six_joints(convention) };
        let (arm, dyn_arm) = (Arm::new(model), DynArm::new(&model));
        for _ in 0..200 {
            let (q, qd, qdd) = (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
            assert_eq!(dyn_arm.inverse_dynamics(&q, &qd, &qdd), Ok(arm.inverse_dynamics(&q, &qd, &qdd).to_vec()));
            assert_eq!(
                dyn_arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &SIX_WRENCH),
                Ok(arm.inverse_dynamics_with_wrench(&q, &qd, &qdd, &SIX_WRENCH).to_vec())
            );
            assert_eq!(dyn_arm.gravity_torques(&q), Ok(arm.gravity_torques(&q).to_vec()));
            assert_eq!(dyn_arm.bias_torques(&q, &qd), Ok(arm.bias_torques(&q, &qd).to_vec()));
            assert_eq!(
                dyn_arm.inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &SIX_BASE, Some(&SIX_WRENCH)),
                Ok(arm
                    .inverse_dynamics_on_moving_base_with_wrench(&q, &qd, &qdd, &SIX_BASE, Some(&SIX_WRENCH))
                    .to_vec())
            );
            let trace = arm.trace(&q, &qd, &qdd, &SIX_BASE, Some(&SIX_WRENCH));
            let dyn_trace = dyn_arm.trace(&q, &qd, &qdd, &SIX_BASE, Some(&SIX_WRENCH)).expect("six joints");
            assert_eq!(dyn_trace.links, trace.links);
            assert_eq!(dyn_trace.tau(), trace.tau());
            assert_eq!(dyn_trace.to_lecture(), trace.to_lecture());
            assert_eq!(dyn_trace.to_base(), trace.to_base());
        }
    }
}

#[test]
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn the_same_bits_in_single_precision() {
    let model = Model { tool: tool(), ..six_joints(Standard) };
    let q = SIX_Q.map(|x| x as f32);
    let found = DynArm::new(&model).to_f32().gravity_torques(&q);
    assert_eq!(found, Ok(Arm::new(model.to_f32()).gravity_torques(&q).to_vec()));
}

#[test]
fn what_it_says_of_itself() {
    let model = Model { tool: tool(), ..six_joints(Modified) };
    let arm = DynArm::new(&model);
    assert_eq!(arm.dof(), 6);
    assert_eq!(arm.convention(), Modified);
    assert_eq!(arm.rows(), model.rows);
    assert_eq!((arm.base(), arm.tool()), (&model.base, &model.tool));
    assert_eq!(arm.fixed_base::<f64>().gravity, model.gravity);
    assert_eq!(Arm::new(model).model(), &model);
}

#[test]
fn a_wrong_length_names_the_argument() {
    let arm = DynArm::new(&one_link());
    let expected = 1;
    let error = arm.inverse_dynamics(&[0.0, 0.0], &[0.0], &[0.0]);
    assert_eq!(error, Err(WrongLength { argument: "q", expected, found: 2 }));
    let error = arm.inverse_dynamics::<f64>(&[0.0], &[], &[0.0]);
    assert_eq!(error, Err(WrongLength { argument: "qd", expected, found: 0 }));
    let error = arm.trace(&[0.0], &[0.0], &[0.0; 3], &arm.fixed_base(), None).unwrap_err();
    assert_eq!(error, WrongLength { argument: "qdd", expected, found: 3 });
    assert_eq!(error.to_string(), "`qdd` has 3 elements, but the robot has 1 joint");
}

#[test]
fn no_joints_no_torques() {
    let nothing = model(Standard, [0.0; 3], []);
    assert_eq!(Arm::new(nothing).gravity_torques::<f64>(&[]), []);
    assert_eq!(DynArm::new(&nothing).gravity_torques::<f64>(&[]), Ok(vec![]));
}
