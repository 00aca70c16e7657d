//! Two robots with all their functions, one in each form.

use rne::model::Inertia;
use rne::{BaseMotion, Payload, Pose, Scalar, Wrench};
use rne::{
    CentreOfMass, CoriolisMatrix, Energy, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, JointWrenches,
    Kinematics, MassMatrix, MomentumObserver, MovingBase, Regressor,
};

/// Every function but for the motors', by the sum of their traits.
pub(crate) trait Robot<const DOF: usize>:
    InverseDynamics<DOF>
    + MassMatrix<DOF>
    + CoriolisMatrix<DOF>
    + ForwardDynamics<DOF>
    + Kinematics<DOF>
    + Energy<DOF>
    + CentreOfMass<DOF>
    + Regressor<DOF>
    + InverseDynamicsDerivatives<DOF>
    + JointWrenches<DOF>
    + MomentumObserver<DOF>
    + MovingBase<DOF>
{
    /// What the motors add, if there are some.
    fn motors<T: Scalar>(&self, qd: &[T; DOF], qdd: &[T; DOF]) -> Vec<T>;
}

#[derive(
    rne::InverseDynamics,
    rne::MassMatrix,
    rne::CoriolisMatrix,
    rne::ForwardDynamics,
    rne::Kinematics,
    rne::Energy,
    rne::CentreOfMass,
    rne::Regressor,
    rne::InverseDynamicsDerivatives,
    rne::JointWrenches,
    rne::MomentumObserver,
    rne::MovingBase,
    rne::Actuation,
)]
#[robot(path = "../../robots/puma560.yaml", form = "reduced")]
pub(crate) struct Puma560;

impl Robot<6> for Puma560 {
    fn motors<T: Scalar>(&self, qd: &[T; 6], qdd: &[T; 6]) -> Vec<T> {
        rne::Actuation::actuator_torques(self, qd, qdd).to_vec()
    }
}

#[derive(
    rne::InverseDynamics,
    rne::MassMatrix,
    rne::CoriolisMatrix,
    rne::ForwardDynamics,
    rne::Kinematics,
    rne::Energy,
    rne::CentreOfMass,
    rne::Regressor,
    rne::InverseDynamicsDerivatives,
    rne::JointWrenches,
    rne::MomentumObserver,
    rne::MovingBase,
)]
#[robot(path = "../../robots/planar2.yaml")]
pub(crate) struct Planar2;

impl Robot<2> for Planar2 {
    fn motors<T: Scalar>(&self, _: &[T; 2], _: &[T; 2]) -> Vec<T> {
        Vec::new()
    }
}

/// Positions, rates, accelerations.
pub(crate) type State<const DOF: usize, T> = [[T; DOF]; 3];

pub(crate) const PUMA_STATE: State<6, f64> =
    [[0.3, -0.5, 0.7, 1.1, 0.4, -0.9], [0.5, 0.2, -0.3, 0.9, -1.1, 0.6], [1.5, 0.4, -0.5, 0.3, -2.1, 0.2]];
pub(crate) const PLANAR_STATE: State<2, f64> = [[0.3, -0.5], [0.5, 0.2], [1.5, 0.4]];

/// The names of functions, with all their numbers. A base and a wrench are made of positions, rates and accelerations.
pub(crate) fn all<const DOF: usize, T: Scalar>(
    robot: &impl Robot<DOF>,
    [q, qd, qdd]: &State<DOF, T>,
) -> Vec<(&'static str, Vec<T>)> {
    let triple = |x: &[T; DOF]| [x[0], x[1], x[0] + x[1]];
    let wrench = Wrench { force: triple(qd), moment: triple(qdd) };
    let ([xx, yy, zz], [xy, xz, yz]) = (triple(q), triple(qdd));
    let payload = Payload { mass: q[0], com: triple(qd), inertia: Inertia { xx, yy, zz, xy, xz, yz } };
    let base = BaseMotion {
        omega: triple(qd),
        omega_dot: triple(qdd),
        velocity: triple(q),
        acceleration: triple(qdd),
        gravity: triple(q),
    };
    let of_pose = |pose: &Pose<T>| [pose.rotation.concat(), pose.translation.to_vec()].concat();
    let turns = q.map(Scalar::sin_cos);
    let (sin, cos) = (turns.map(|turn| turn.0), turns.map(|turn| turn.1));
    let momentum = robot.momentum_and_rate(q, qd, qdd);
    let derivatives = robot.inverse_dynamics_derivatives(q, qd, qdd);
    vec![
        ("inverse_dynamics", robot.inverse_dynamics(q, qd, qdd).to_vec()),
        ("inverse_dynamics_with_wrench", robot.inverse_dynamics_with_wrench(q, qd, qdd, &wrench).to_vec()),
        ("inverse_dynamics_with_payload", robot.inverse_dynamics_with_payload(q, qd, qdd, &payload).to_vec()),
        ("inverse_dynamics_from_sin_cos", robot.inverse_dynamics_from_sin_cos(&sin, &cos, q, qd, qdd).to_vec()),
        ("gravity_torques", robot.gravity_torques(q).to_vec()),
        ("bias_torques", robot.bias_torques(q, qd).to_vec()),
        ("mass_matrix", robot.mass_matrix(q).concat()),
        ("inverse_mass_matrix", robot.inverse_mass_matrix(q).concat()),
        ("inverse_mass_matrix_times_torques", robot.inverse_mass_matrix_times_torques(q, qdd).to_vec()),
        ("coriolis_matrix", robot.coriolis_matrix(q, qd).concat()),
        ("forward_dynamics", robot.forward_dynamics(q, qd, qdd).to_vec()),
        ("forward_kinematics", of_pose(&robot.forward_kinematics(q))),
        ("link_poses", robot.link_poses(q).iter().flat_map(of_pose).collect()),
        ("jacobian", robot.jacobian(q).concat()),
        ("jacobian_rate_times_velocity", robot.jacobian_rate_times_velocity(q, qd).to_vec()),
        ("wrench_torques", robot.wrench_torques(q, &wrench).to_vec()),
        ("kinetic_energy", vec![robot.kinetic_energy(q, qd)]),
        ("potential_energy", vec![robot.potential_energy(q)]),
        ("centre_of_mass", robot.centre_of_mass(q).to_vec()),
        ("centre_of_mass_jacobian", robot.centre_of_mass_jacobian(q).concat()),
        ("regressor", robot.regressor(q, qd, qdd).concat().concat()),
        ("inverse_dynamics_derivatives", [derivatives.dq.concat(), derivatives.dqd.concat()].concat()),
        (
            "joint_wrenches",
            robot.joint_wrenches(q, qd, qdd).iter().flat_map(|w| [w.force, w.moment].concat()).collect(),
        ),
        ("momentum_and_rate", [momentum.momentum, momentum.rate].concat()),
        ("inverse_dynamics_on_moving_base", robot.inverse_dynamics_on_moving_base(q, qd, qdd, &base).to_vec()),
        ("actuator_torques", robot.motors(qd, qdd)),
    ]
}
