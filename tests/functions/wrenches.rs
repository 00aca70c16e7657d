//! Joint wrenches of random arms, by Newton and Euler in the world, without the seven steps.

use nalgebra::{Matrix3, Rotation3, Vector3};
use rne::Dual;
use rne_codegen::Form;
use rne_model::Convention::{Modified, Standard};
use rne_model::JointKind::{Prismatic, Revolute};

use crate::arm::Maker;
use crate::case::{along, cases, holds};
use crate::check::error_on_scale;

#[test]
fn joint_wrenches_contain_the_torques() {
    for (maker, case) in Maker::ALL.into_iter().flat_map(|maker| cases(maker).iter().map(move |case| (maker, case))) {
        let wrenches = case.arm.joint_wrenches(&case.q, &case.qd, &case.qdd);
        let along = case.robot.rows().zip(&wrenches).map(|(row, wrench)| match row.kind {
            Revolute => wrench.moment[2],
            Prismatic => wrench.force[2],
        });
        let (along, tau) = (along.collect::<Vec<f64>>(), case.tau());
        match maker {
            // there the torques are not those of the wrenches
            Maker::Code(Form::Reduced) => assert!(error_on_scale(&along, &tau, 1e-3) < 1e-12),
            _ => assert_eq!(along, tau),
        }
    }
}

#[test]
fn joint_wrenches_are_the_change_of_momentum_of_all_that_follows() {
    holds("joint wrenches", |case, worst| {
        // Positions with their first and second derivatives with respect to time.
        let q: Vec<Dual<Dual<f64>>> = std::iter::zip(case.moving(), along(&case.qd, &case.qdd))
            .map(|(value, derivative)| Dual { value, derivative })
            .collect();
        let poses = case.arm.link_poses(&q);
        let wrenches = case.arm.joint_wrenches(&case.q, &case.qd, &case.qdd);
        let gravity = case.gravity();
        let constant = |x: f64| Dual::constant(Dual::constant(x));
        let now = |x: Dual<Dual<f64>>| x.value.value;

        // In world axes: force, and moment about the origin of the world.
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        // What rounding is relative to: the largest on the way, and no less than a thousandth.
        let (mut forces, mut moments) = (1e-3_f64, 1e-3_f64);
        for (index, row) in case.robot.rows().enumerate().rev() {
            let (pose, link) = (&poses[index], &row.link);
            let rotation = pose.rotation_matrix();
            let com = rotation * Vector3::from(link.com).map(constant) + pose.translation_vector();
            let change = (com.map(|x| x.derivative.derivative) - gravity) * link.mass;
            let (turn, turning) = (rotation.map(|x| x.value), rotation.map(|x| x.derivative));
            let spin = turning * turn.transpose();
            let omega = Vector3::new(spin.m32, spin.m13, spin.m21);
            let inertia = Matrix3::from(link.inertia.rows()).map(Dual::constant);
            let spin = (turn * (inertia * (turn.transpose() * omega))).map(|x| x.derivative);
            force += change;
            moment += spin + com.map(now).cross(&change);
            forces = forces.max(force.norm());
            moments = moments.max(moment.norm()).max(com.map(now).norm() * change.norm());
            // a first moment h about the point c beside the mass: the momentum ḣ, about the origin c × ḣ + h × ċ
            let h = rotation * Vector3::from(link.first_moment).map(constant);
            let turned = h.map(|x| x.derivative.derivative);
            let fall = com.map(|x| x.derivative.derivative) - gravity;
            force += turned;
            let of_first_moment = com.map(now).cross(&turned) + h.map(now).cross(&fall);
            moment += of_first_moment;
            forces = forces.max(force.norm());
            moments = moments.max(moment.norm()).max(of_first_moment.norm());

            // J_i, and the axes of form P
            let before = index.checked_sub(1).map(|before| poses[before].to_homogeneous().map(now));
            let base = case.base_rotation().to_homogeneous().append_translation(&case.robot.base.xyz.into());
            let before = before.unwrap_or(base);
            let (foot, turn) = match case.robot.convention {
                Standard => (0.0, Rotation3::from_axis_angle(&Vector3::x_axis(), -row.dh.alpha.radians)),
                Modified => (row.dh.a, Rotation3::identity()),
            };
            let joint = before.transform_point(&[foot, 0.0, 0.0].into()).coords;
            let axes = rotation.map(now) * turn.matrix();
            let expected = [axes.tr_mul(&force), axes.tr_mul(&(moment - joint.cross(&force)))];
            worst.see("f", error_on_scale(&wrenches[index].force, expected[0].as_slice(), forces));
            worst.see("n", error_on_scale(&wrenches[index].moment, expected[1].as_slice(), moments));
        }
    });
}
