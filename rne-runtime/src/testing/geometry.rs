//! Places and directions.

use core::iter;

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest};
use super::state::{State, states};
use crate::{Arm, CentreOfMass, JacobianDerivatives, Kinematics, Pose};

/// How far the arm reaches at most from the origin of the world, m.
fn reach<const DOF: usize>(arm: &Arm<DOF>, state: &State<DOF>) -> f64 {
    let of_rows: f64 = arm.model().rows.iter().map(|row| row.dh.a.abs() + row.dh.d.abs()).sum();
    of_rows + largest(&state.q) + largest(&arm.forward_kinematics(&state.q).translation)
}

/// Tip, links, Jacobian and its rate.
pub fn kinematics_are_those_of_the_runtime<const DOF: usize, R: Kinematics<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, .. } = &state;
        let rounding = Allowed::Rounding { scale: reach(&arm, &state) };
        let compare_poses = |what, found: Pose<f64>, expected: Pose<f64>| {
            let (turned, wanted) = (found.rotation.as_flattened(), expected.rotation.as_flattened());
            compare(what, &state, Allowed::Rounding { scale: 1.0 }, turned, wanted);
            compare(what, &state, rounding, &found.translation, &expected.translation);
        };
        compare_poses("forward_kinematics", robot.forward_kinematics(q), arm.forward_kinematics(q));
        for (found, expected) in iter::zip(robot.link_poses(q), arm.link_poses(q)) {
            compare_poses("link_poses", found, expected);
        }
        let (found, expected) = (robot.jacobian(q), arm.jacobian(q));
        compare("jacobian", &state, rounding, found.as_flattened(), expected.as_flattened());
        let (found, expected) = (robot.jacobian_rate_times_velocity(q, qd), arm.jacobian_rate_times_velocity(q, qd));
        let allowed = file.same_operations(reach(&arm, &state) * largest(qd) * largest(qd));
        compare("jacobian_rate_times_velocity", &state, allowed, &found, &expected);
    }
}

/// R Rᵀ = 1 for tip and links.
pub fn rotations_are_orthonormal<const DOF: usize, R: Kinematics<DOF>>(robot: &R, _: &RobotFile) {
    let identity = Pose::<f64>::identity().rotation;
    for state in states() {
        let poses = iter::once(robot.forward_kinematics(&state.q)).chain(robot.link_poses(&state.q));
        for Pose { rotation: rows, .. } in poses {
            let products = rows.map(|a| rows.map(|b| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
            let allowed = Allowed::Rounding { scale: 1.0 };
            let what = "products of the rows of a rotation";
            compare(what, &state, allowed, products.as_flattened(), identity.as_flattened());
        }
    }
}

/// The centre of mass and its Jacobian, of an arm that has mass.
pub fn centre_of_mass_is_that_of_the_runtime<const DOF: usize, R: CentreOfMass<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let allowed = Allowed::Rounding { scale: reach(&arm, &state) };
        let (found, expected) = (robot.centre_of_mass(&state.q), arm.centre_of_mass(&state.q));
        if !are_finite(&expected) {
            continue;
        }
        compare("centre_of_mass", &state, allowed, &found, &expected);
        let (found, expected) = (robot.centre_of_mass_jacobian(&state.q), arm.centre_of_mass_jacobian(&state.q));
        compare("centre_of_mass_jacobian", &state, allowed, found.as_flattened(), expected.as_flattened());
    }
}

/// J̇, and ∂J/∂q.
pub fn derivatives_of_the_jacobian_are_those_of_the_runtime<const DOF: usize, R: JacobianDerivatives<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, .. } = &state;
        let size = largest(arm.jacobian(q).as_flattened());
        let (found, expected) = (robot.jacobian_rate(q, qd), arm.jacobian_rate(q, qd));
        let allowed = Allowed::Rounding { scale: size * largest(qd) };
        compare("jacobian_rate", &state, allowed, found.as_flattened(), expected.as_flattened());
        let (found, expected) = (robot.jacobian_derivatives(q), arm.jacobian_derivatives(q));
        let (found, expected) = (found.as_flattened().as_flattened(), expected.as_flattened().as_flattened());
        compare("jacobian_derivatives", &state, Allowed::Rounding { scale: size }, found, expected);
    }
}
