//! Every number of section 5 of the specification: the acceptance tests.

#![allow(clippy::unreadable_literal, clippy::excessive_precision)] // the digits as the specification prints them
mod common;

use common::{
    SIX_BASE, SIX_Q, SIX_QD, SIX_QDD, SIX_WRENCH, assert_close, one_link, prismatic_revolute, revolute_prismatic,
    six_joints, two_links,
};
use rne_model::Convention::{self, Modified, Standard};
use rne_runtime::{Arm, InverseDynamics, Wrench};

#[test]
fn one_link_torque() {
    let tau = Arm::new(one_link()).inverse_dynamics(&[0.6], &[1.3], &[-0.7]);
    assert_close("τ", &tau, &[5.1658093306719635]);
}

const TWO_Q: [f64; 2] = [0.6, -1.1];
const TWO_QD: [f64; 2] = [1.3, -0.4];
const TWO_QDD: [f64; 2] = [-0.7, 2.1];

/// The wrench of case c, at the tip frame of either table: joint 2 in the modified one, a2 = 0.6 m away.
fn case_c_wrench(convention: Convention) -> Wrench<f64> {
    let (force, moment) = ([3.0, -2.0, 0.0], 0.5);
    match convention {
        Standard => Wrench { force, moment: [0.0, 0.0, moment] },
        Modified => Wrench { force, moment: [0.0, 0.0, moment + 0.6 * force[1]] },
    }
}

#[test]
fn two_links_torques() {
    let zero = [0.0; 2];
    for convention in [Standard, Modified] {
        let arm = |gravity| Arm::new(two_links(convention, gravity));
        let x_down = arm([9.81, 0.0, 0.0]);
        let y_up = arm([0.0, -9.81, 0.0]);
        let no_gravity = arm([0.0; 3]);

        let a = x_down.inverse_dynamics(&TWO_Q, &TWO_QD, &TWO_QDD);
        assert_close("a", &a, &[9.1083282182418484, -2.5209408206288769]);
        let b = y_up.inverse_dynamics(&TWO_Q, &TWO_QD, &TWO_QDD);
        assert_close("b", &b, &[20.725119858044177, 3.4695714390044276]);
        let c = y_up.inverse_dynamics_with_wrench(&TWO_Q, &TWO_QD, &TWO_QDD, &case_c_wrench(convention));
        assert_close("c", &c, &[17.160468399615808, 2.7695714390044276]);
        let d = y_up.gravity_torques(&TWO_Q);
        assert_close("d", &d, &[21.686481460445727, 3.8740882194650504]);
        let e = no_gravity.bias_torques(&TWO_Q, &TWO_QD);
        assert_close("e", &e, &[-0.28233449166746272, -0.54221055786137726]);
        let f = no_gravity.inverse_dynamics(&TWO_Q, &zero, &TWO_QDD);
        assert_close("f", &f, &[-0.67902711073408783, 0.13769377740075450]);
    }
}

#[test]
fn a_slide_on_a_turning_joint() {
    let tau = Arm::new(revolute_prismatic()).inverse_dynamics(&[0.6, 0.9], &[1.3, -0.4], &[-0.7, 2.1]);
    assert_close("τ", &tau, &[9.1011995944111234, -11.276313573395916]);
}

#[test]
fn a_turning_joint_on_a_slide() {
    let tau = Arm::new(prismatic_revolute()).inverse_dynamics(&[0.9, 0.6], &[1.3, -0.4], &[-0.7, 2.1]);
    assert_close("τ", &tau, &[37.179287898005203, 3.7719633533222262]);
}

#[test]
#[rustfmt::skip]
fn six_joints_torques() {
    let expected = [
        (Standard, [
            [-4.5171596652740629, 21.304962061879786, 42.266789539743842,
              0.74657431084269629, -8.3998679666422226, 0.58697182315756963],
            [-6.7854247044385871, 18.802844548526256, 41.232002870594765,
              0.26907309091123066, -3.9459563659845217, 0.35896406813215266],
            [-9.2869612252104653, 17.313031219440718, 42.420144323264291,
              0.16502627941999622, -3.2186127872888380, 0.34961262330096721],
        ]),
        (Modified, [
            [12.887252187731947, -4.9660542553921901, 19.571422125554476,
             -0.48405351189223692, 5.4676777831393158, 0.054553187548074713],
            [12.391641613175600, -4.5119423180606127, 22.975024804561858,
             -1.5057927312101811, 7.7798906388383052, -0.14544681245192529],
            [10.394979706455476, -3.3951656142418360, 25.369531526782670,
             -1.7352439535406506, 7.4155625012436405, -0.14184904031991949],
        ]),
    ];
    for (convention, [free, wrench, moving]) in expected {
        let arm = Arm::new(six_joints(convention));
        let (q, qd, qdd) = (&SIX_Q, &SIX_QD, &SIX_QDD);
        assert_close("no wrench", &arm.inverse_dynamics(q, qd, qdd), &free);
        assert_close("tip wrench", &arm.inverse_dynamics_with_wrench(q, qd, qdd, &SIX_WRENCH), &wrench);
        let tau = arm.inverse_dynamics_on_moving_base(q, qd, qdd, &SIX_BASE, Some(&SIX_WRENCH));
        assert_close("tip wrench, moving base", &tau, &moving);
    }
}
