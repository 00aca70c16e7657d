//! Every shipped robot with everything derived, and its functions by their names.

use rne::{
    Actuation, BaseMotion, CentreOfMass, CoriolisMatrix, Energy, ForwardDynamics, InverseDynamics,
    InverseDynamicsDerivatives, JointWrenches, Kinematics, MassMatrix, MovingBase, Pose, Regressor, Scalar, Wrench,
};
use rne_codegen::{Form, Function};

use crate::states::Numbers;

/// A derived robot.
pub(crate) trait Derived: Send + Sync {
    /// All numbers that a function returns, in their order.
    fn single(&self, function: Function, given: &Numbers<f32>) -> Vec<f32>;
    fn double(&self, function: Function, given: &Numbers<f64>) -> Vec<f64>;
}

trait Everything<const DOF: usize>:
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
    + MovingBase<DOF>
    + Actuation<DOF>
{
}

fn flat<const ROWS: usize, const COLUMNS: usize, T: Copy>(rows: [[T; COLUMNS]; ROWS]) -> Vec<T> {
    rows.as_flattened().to_vec()
}

fn pose<T: Scalar>(pose: &Pose<T>) -> Vec<T> {
    [flat(pose.rotation), pose.translation.to_vec()].concat()
}

fn numbers<const DOF: usize, T: Scalar>(
    robot: &impl Everything<DOF>,
    function: Function,
    given: &Numbers<T>,
) -> Vec<T> {
    let array = |numbers: &Vec<T>| -> [T; DOF] { numbers.as_slice().try_into().expect("one per joint") };
    let [q, qd, qdd, tau] = given.joints.each_ref().map(array);
    let [ref q, ref qd, ref qdd, ref tau] = [q, qd, qdd, tau];
    let [force, moment, omega, omega_dot, acceleration, gravity] = given.vectors;
    let base = BaseMotion { omega, omega_dot, velocity: [T::zero(); 3], acceleration, gravity };
    match function {
        Function::InverseDynamics => robot.inverse_dynamics(q, qd, qdd).to_vec(),
        Function::InverseDynamicsWithWrench => {
            robot.inverse_dynamics_with_wrench(q, qd, qdd, &Wrench { force, moment }).to_vec()
        }
        Function::InverseDynamicsSc => {
            robot.inverse_dynamics_sc(&array(&given.sine), &array(&given.cosine), q, qd, qdd).to_vec()
        }
        Function::GravityTorques => robot.gravity_torques(q).to_vec(),
        Function::BiasTorques => robot.bias_torques(q, qd).to_vec(),
        Function::MassMatrix => flat(robot.mass_matrix(q)),
        Function::CoriolisMatrix => flat(robot.coriolis_matrix(q, qd)),
        Function::ForwardDynamics => robot.forward_dynamics(q, qd, tau).to_vec(),
        Function::ForwardKinematics => pose(&robot.forward_kinematics(q)),
        Function::LinkPoses => robot.link_poses(q).iter().flat_map(pose).collect(),
        Function::Jacobian => flat(robot.jacobian(q)),
        Function::JacobianRateTimesVelocity => robot.jacobian_rate_times_velocity(q, qd).to_vec(),
        Function::KineticEnergy => vec![robot.kinetic_energy(q, qd)],
        Function::PotentialEnergy => vec![robot.potential_energy(q)],
        Function::CentreOfMass => robot.centre_of_mass(q).to_vec(),
        Function::CentreOfMassJacobian => flat(robot.centre_of_mass_jacobian(q)),
        Function::Regressor => robot.regressor(q, qd, qdd).into_iter().flat_map(flat).collect(),
        Function::InverseDynamicsDerivatives => {
            let derivatives = robot.inverse_dynamics_derivatives(q, qd, qdd);
            [flat(derivatives.dq), flat(derivatives.dqd)].concat()
        }
        Function::JointWrenches => {
            let wrenches = robot.joint_wrenches(q, qd, qdd);
            wrenches.iter().flat_map(|wrench| [wrench.force, wrench.moment].concat()).collect()
        }
        Function::InverseDynamicsOnMovingBase => robot.inverse_dynamics_on_moving_base(q, qd, qdd, &base).to_vec(),
        Function::ActuatorTorques => robot.actuator_torques(qd, qdd).to_vec(),
    }
}

macro_rules! robot {
    ($robot:ident $dof:literal $path:literal $form:literal) => {
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
            rne::MovingBase,
            rne::Actuation,
        )]
        #[robot(path = $path, form = $form)]
        pub(super) struct $robot;

        impl super::Everything<$dof> for $robot {}

        impl super::Derived for $robot {
            fn single(&self, function: super::Function, given: &super::Numbers<f32>) -> Vec<f32> {
                super::numbers(self, function, given)
            }

            fn double(&self, function: super::Function, given: &super::Numbers<f64>) -> Vec<f64> {
                super::numbers(self, function, given)
            }
        }
    };
}

macro_rules! robots {
    ($($robot:ident $dof:literal $path:literal;)*) => {
        mod seven_steps {
            $(robot!($robot $dof $path "seven_steps");)*
        }

        mod reduced {
            $(robot!($robot $dof $path "reduced");)*
        }

        /// Names of robots, with their forms.
        pub(crate) fn all() -> Vec<(&'static str, Vec<(Form, Box<dyn Derived>)>)> {
            vec![$((
                seven_steps::$robot::NAME,
                vec![
                    (Form::SevenSteps, Box::new(seven_steps::$robot) as Box<dyn Derived>),
                    (Form::Reduced, Box::new(reduced::$robot)),
                ],
            )),*]
        }
    };
}

robots! {
    Panda 7 "../../robots/panda.yaml";
    Wam7 7 "../../robots/wam7.yaml";
    Iiwa14 7 "../../robots/iiwa14.yaml";
    Puma560 6 "../../robots/puma560.yaml";
    Puma560Mdh 6 "../../robots/puma560_mdh.yaml";
    Stanford 6 "../../robots/stanford.yaml";
    Ur5 6 "../../robots/ur5.yaml";
    Ur5e 6 "../../robots/ur5e.yaml";
    ScaraCobra600 4 "../../robots/scara_cobra600.yaml";
    CylindricalRpp 3 "../../robots/cylindrical_rpp.yaml";
    GantryPpp 3 "../../robots/gantry_ppp.yaml";
    Planar3 3 "../../robots/planar3.yaml";
    SphericalRrp 3 "../../robots/spherical_rrp.yaml";
    Planar2 2 "../../robots/planar2.yaml";
    Planar1 1 "../../robots/planar1.yaml";
}
