//! Every number of section 5 of the specification: the acceptance tests.
#![allow(clippy::unreadable_literal, clippy::excessive_precision)] // the digits as the specification prints them

use crate::common;
use crate::common::{
    Numbers, SIX_BASE, SIX_Q, SIX_QD, SIX_QDD, SIX_WRENCH, assert_close, one_link, prismatic_revolute,
    revolute_prismatic, six_joints, two_links,
};
use rne_model::Convention::{self, Modified, Standard};
use rne_model::Model;
use rne_runtime::{Arm, InverseDynamics, Trace, Wrench};

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
        let tau = arm.inverse_dynamics_on_moving_base_with_wrench(q, qd, qdd, &SIX_BASE, Some(&SIX_WRENCH));
        assert_close("tip wrench, moving base", &tau, &moving);
    }
}

fn trace<const DOF: usize>(model: Model<DOF>, q: [f64; DOF], qd: [f64; DOF], qdd: [f64; DOF]) -> Trace<DOF, f64> {
    let arm = Arm::new(model);
    arm.trace(&q, &qd, &qdd, &arm.fixed_base(), None)
}

#[test]
fn one_link_in_the_lecture_s_frame() {
    let link = trace(one_link(), [0.6], [1.3], [-0.7]).to_lecture()[0];
    assert_close("ω", &link.omega, &[0.0, 0.0, 1.3]);
    assert_close("ω̇", &link.omega_dot, &[0.0, 0.0, -0.7]);
    assert_close("ċ", &link.velocity, &[-0.29361408616541839, 0.42917451975303271, 0.0]);
    assert_close("c̈", &link.acceleration, &[-0.39982698312833263, -0.61279228418975382, 0.0]);
    assert_close("g", &link.gravity, &[9.81, 0.0, 0.0]);
    assert_close("f", &link.inertia_force, &[-0.99956745782083157, -1.5319807104743846, 0.0]);
    assert_close("n", &link.inertia_moment, &[0.0, 0.0, -0.093333333333333333]);
    assert_close("f_01", &link.joint_force, &[-25.524567457820832, -1.5319807104743846, 0.0]);
    assert_close("n_01", &link.joint_moment, &[0.0, 0.0, 5.1658093306719635]);
    assert_close("τ", &[link.tau], &[5.1658093306719635]);
}

#[test]
fn one_link_in_form_p() {
    let link = trace(one_link(), [0.6], [1.3], [-0.7]).links[0];
    assert_close("ċ", &link.velocity, &[0.0, 0.52, 0.0]);
    assert_close("c̈", &link.acceleration, &[-0.676, -0.28, 0.0]);
    assert_close("g", &link.gravity, &[8.0965423822639441, -5.5391426640052969, 0.0]);
    assert_close("f_01", &link.joint_force, &[-21.931355955659860, 13.147856660013242, 0.0]);
    assert_close("n_01", &link.joint_moment, &[0.0, 0.0, 5.1658093306719635]);
    assert_close("τ", &[link.tau], &[5.1658093306719635]);
    assert_close("d", &link.d, &[0.4, 0.0, 0.0]);
    assert_close("r", &link.r, &[0.4, 0.0, 0.0]);
}

#[test]
fn two_links_in_the_lecture_s_frames() {
    let [link_1, link_2] = trace(two_links(Standard, [9.81, 0.0, 0.0]), TWO_Q, TWO_QD, TWO_QDD).to_lecture();
    assert_close("ω_1", &link_1.omega, &[0.0, 0.0, 1.3]);
    assert_close("ω̇_1", &link_1.omega_dot, &[0.0, 0.0, -0.7]);
    assert_close("ċ_1", &link_1.velocity, &[-0.29361408616541839, 0.42917451975303271, 0.0]);
    assert_close("c̈_1", &link_1.acceleration, &[-0.39982698312833263, -0.61279228418975382, 0.0]);
    assert_close("f_01", &link_1.joint_force, &[-41.456889161694222, -2.6427299402314792, 0.0]);
    assert_close("ω_2", &link_2.omega, &[0.0, 0.0, 0.9]);
    assert_close("ω̇_2", &link_2.omega_dot, &[0.0, 0.0, 1.4]);
    assert_close("ċ_2", &link_2.velocity, &[0.24062598721658754, 1.1624709527849059, 0.0]);
    assert_close("c̈_2", &link_2.acceleration, &[-1.0879167662806125, -0.15292624050632871, 0.0]);
    assert_close("g", &link_2.gravity, &[8.0965423822639441, -5.5391426640052969, 0.0]);
    assert_close("f_2", &link_2.inertia_force, &[-1.6318751494209187, -0.22938936075949306, 0.0]);
    assert_close("n_2", &link_2.inertia_moment, &[0.0, 0.0, 0.063]);
    assert_close("f_12", &link_2.joint_force, &[-13.776688722816835, 8.0793246352484522, 0.0]);
    assert_close("n_12", &link_2.joint_moment, &[0.0, 0.0, -2.5209408206288769]);
}

#[test]
#[rustfmt::skip]
fn the_sixth_link_in_base_axes() {
    let omega = [-0.62621304066281536, -1.2950563141580973, 1.1161043174634882];
    let expected = [
        (Standard,
         [[0.86729436194419475, 0.65149077576738104, 0.63851192500511481], [-1.1124662626433227, -1.0138254838779870, -0.17953803482286420]],
         [[1.1814625444090198, 1.0604293325852243, 0.26537932230117920], [-1.3375899879410466, -1.6351538609764849, -0.38502859559691812]]),
        (Modified,
         [[-0.067321726824014824, 0.10855264321871562, 0.24166640036162960], [-1.3661741747475985, -1.8138271321319567, 0.056484445931692176]],
         [[0.27711732509401102, 0.28788755617232851, -0.22818132993251667], [-1.1612416398854194, -2.3806657176570549, -0.35529053687461271]]),
    ];
    for (convention, fixed, moving) in expected {
        let arm = Arm::new(six_joints(convention));
        for (base, [velocity, acceleration]) in [(arm.fixed_base(), fixed), (SIX_BASE, moving)] {
            let link = arm.trace(&SIX_Q, &SIX_QD, &SIX_QDD, &base, Some(&SIX_WRENCH)).to_base()[5];
            assert_close("ċ_6", &link.velocity, &velocity);
            assert_close("c̈_6", &link.acceleration, &acceleration);
            assert_close("g_6", &link.gravity, &base.gravity);
        }
    }
    let arm = Arm::new(six_joints(Standard));
    let link = arm.trace(&SIX_Q, &SIX_QD, &SIX_QDD, &arm.fixed_base(), None).to_base()[5];
    assert_close("ω_6", &link.omega, &omega);
}

/// The formulas that section 5 prints beside the numbers, at other states.
#[test]
fn closed_forms() {
    let mut numbers = Numbers::new(5);
    for _ in 0..100 {
        let ([q1, q2], [qd1, qd2], [qdd1, qdd2]) = (numbers.array(3.0), numbers.array(2.0), numbers.array(2.0));
        let ([gx, gy], [fx, fy], [nz]) = (numbers.array(9.81), numbers.array(5.0), numbers.array(2.0));

        let ([a1, a2], [m1, m2]) = (common::TWO_LINK_LENGTHS, common::TWO_LINK_MASSES);
        let (s1, c1, s2, c2, s12, c12) = (q1.sin(), q1.cos(), q2.sin(), q2.cos(), (q1 + q2).sin(), (q1 + q2).cos());
        let h = m2 * a1 * a2 * s2;
        let coupling = m2 * (a2 * a2 / 3.0 + a1 * a2 * c2 / 2.0);
        let outer_weight = m2 * a2 / 2.0 * (gx * s12 - gy * c12);
        let tau = [
            (m1 * a1 * a1 / 3.0 + m2 * (a1 * a1 + a2 * a2 / 3.0 + a1 * a2 * c2)) * qdd1 + coupling * qdd2
                - h * (qd1 * qd2 + qd2 * qd2 / 2.0)
                + (m1 * a1 / 2.0 + m2 * a1) * (gx * s1 - gy * c1)
                + outer_weight
                + a1 * s2 * fx
                + (a2 + a1 * c2) * fy
                + nz,
            coupling * qdd1 + m2 * a2 * a2 / 3.0 * qdd2 + h * qd1 * qd1 / 2.0 + outer_weight + a2 * fy + nz,
        ];
        let wrench = Wrench { force: [fx, fy, 0.0], moment: [0.0, 0.0, nz] };
        let arm = Arm::new(two_links(Standard, [gx, gy, 0.0]));
        let found = arm.inverse_dynamics_with_wrench(&[q1, q2], &[qd1, qd2], &[qdd1, qdd2], &wrench);
        assert_close("two links", &found, &tau);

        let (l, i1, i2) = (0.3, 0.12, 0.05);
        let (gx, gy) = (0.0, -9.81);
        let tau = [
            (m1 * l * l + i1 + i2 + m2 * q2 * q2) * qdd1 + 2.0 * m2 * q2 * qd1 * qd2
                - (m1 * l + m2 * q2) * (gx * c1 + gy * s1),
            m2 * qdd2 - m2 * q2 * qd1 * qd1 - m2 * (gx * s1 - gy * c1),
        ];
        let found = Arm::new(revolute_prismatic()).inverse_dynamics(&[q1, q2], &[qd1, qd2], &[qdd1, qdd2]);
        assert_close("RP", &found, &tau);

        let g = 9.81;
        let tau = [
            (m1 + m2) * (qdd1 + g) + m2 * l * (c2 * qdd2 - s2 * qd2 * qd2),
            (m2 * l * l + i2) * qdd2 + m2 * l * c2 * (qdd1 + g),
        ];
        let found = Arm::new(prismatic_revolute()).inverse_dynamics(&[q1, q2], &[qd1, qd2], &[qdd1, qdd2]);
        assert_close("PR", &found, &tau);
    }
}
