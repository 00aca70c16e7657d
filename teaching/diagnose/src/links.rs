//! Changes inertias and centres of mass of links as slips do.

use nalgebra::{Matrix3, Rotation3, Vector3};
use rne_model::{Convention, Inertia, Joint, JointKind, Link, Robot, Row};

pub(crate) fn each_link(robot: &mut Robot, change: impl Fn(&mut Link)) {
    robot.joints.iter_mut().for_each(|joint| change(&mut joint.row.link));
}

/// Rotates the inertias by -alpha, so that the rotation by alpha that follows gives the inertias of the file.
pub(crate) fn untwist(robot: &mut Robot) {
    for Joint { row: Row { dh, link, .. }, .. } in &mut robot.joints {
        let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), -dh.alpha.radians);
        link.inertia = tensor(turn * Matrix3::from(link.inertia.rows()) * turn.inverse());
    }
}

/// Returns the inertia plus `times` m (c² 1 - c cᵀ).
pub(crate) fn shifted(link: &Link, times: f64) -> Inertia {
    let (c, own) = (Vector3::from(link.com), Matrix3::from(link.inertia.rows()));
    tensor(own + (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * (link.mass * times))
}

fn tensor(j: Matrix3<f64>) -> Inertia {
    Inertia { xx: j[(0, 0)], yy: j[(1, 1)], zz: j[(2, 2)], xy: j[(0, 1)], xz: j[(0, 2)], yz: j[(1, 2)] }
}

/// Moves each centre of mass by `times` the vector to the other end of its link. A link has no other end if the joint
/// there is prismatic, or if there is no joint.
pub(crate) fn move_com(robot: &mut Robot, times: f64) {
    let rows: Vec<_> = robot.rows().map(|row| (row.kind, row.dh)).collect();
    let far = robot.convention == Convention::Modified;
    for (index, joint) in robot.joints.iter_mut().enumerate() {
        let Some((JointKind::Revolute, dh)) = rows.get(index + usize::from(far)) else { continue };
        // the vector between frames i-1 and i, in frame i for a standard table, in frame i-1 for a modified one
        let (s, c) = (dh.alpha.sin, dh.alpha.cos);
        let way = if far { [dh.a, -dh.d * s, dh.d * c] } else { [-dh.a, -dh.d * s, -dh.d * c] };
        let com = &mut joint.row.link.com;
        (0..3).for_each(|axis| com[axis] += times * way[axis]);
    }
}
