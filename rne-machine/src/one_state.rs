//! The functions by their own names, for one state: arguments and results as those of `DynArm`.

use rne_codegen::Function;
use rne_runtime::{BaseMotion, Payload, Pose, VectorUnit, Wrench};

use crate::{Arguments, Array, CompiledArm, EvaluationError, Number};

/// Per joint, a row per joint.
type Matrix<T> = Vec<Vec<T>>;

/// ∂τ/∂q and ∂τ/∂q̇; row i is torque i.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives<T> {
    /// ∂τ_i/∂q_j.
    pub dq: Matrix<T>,
    /// ∂τ_i/∂q̇_j.
    pub dqd: Matrix<T>,
}

/// The arguments of a motion.
fn motion<'a, T>(q: &'a [T], qd: &'a [T], qdd: &'a [T]) -> Arguments<'a, T> {
    Arguments::new().q(Array::Rows(q)).qd(Array::Rows(qd)).qdd(Array::Rows(qdd))
}

/// So many numbers as an array.
fn array<T: Number, const N: usize>(numbers: &[T]) -> [T; N] {
    let mut array = [T::zero(); N];
    array.copy_from_slice(numbers);
    array
}

fn pose<T: Number>(numbers: &[T]) -> Pose<T> {
    let rotation = [array(&numbers[..3]), array(&numbers[3..6]), array(&numbers[6..9])];
    Pose { rotation, translation: array(&numbers[9..12]) }
}

/// One state. Arrays have one element per joint: rad, rad/s, rad/s², N m for revolute joints; m, m/s, m/s², N for
/// prismatic ones.
impl CompiledArm {
    /// Any function for one state: its numbers, in the order of the function's [layout](Function::layout), into
    /// `results`. Nothing is allocated for more than the arguments.
    ///
    /// # Errors
    /// When an argument is missing or has another size, or `results`, when the payload has a mass below zero, or when
    /// the function cannot be compiled.
    pub fn run_one<T: Number>(
        &self,
        function: Function,
        arguments: &Arguments<'_, T>,
        results: &mut [T],
    ) -> Result<(), EvaluationError> {
        self.function(function)?.run_one(VectorUnit::widest(), arguments, results)
    }

    /// The numbers of a function.
    fn numbers<T: Number>(&self, function: Function, arguments: &Arguments<'_, T>) -> Result<Vec<T>, EvaluationError> {
        let mut numbers = vec![T::zero(); self.function(function)?.outputs()];
        self.run_one(function, arguments, &mut numbers)?;
        Ok(numbers)
    }

    /// The rows of a matrix with a column per joint.
    fn rows<T: Number>(&self, function: Function, arguments: &Arguments<'_, T>) -> Result<Matrix<T>, EvaluationError> {
        let numbers = self.numbers(function, arguments)?;
        Ok(numbers.chunks(self.dof()).map(<[T]>::to_vec).collect())
    }

    /// Torques with a free tip, τ(q, q̇, q̈).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn inverse_dynamics<T: Number>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Result<Vec<T>, EvaluationError> {
        self.numbers(Function::InverseDynamics, &motion(q, qd, qdd))
    }

    /// Torques when the last link exerts `wrench` on its environment: τ = τ_free + Jᵀ w.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn inverse_dynamics_with_wrench<T: Number>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        wrench: &Wrench<T>,
    ) -> Result<Vec<T>, EvaluationError> {
        let arguments = motion(q, qd, qdd).force(Array::Same(&wrench.force)).moment(Array::Same(&wrench.moment));
        self.numbers(Function::InverseDynamicsWithWrench, &arguments)
    }

    /// Torques when `payload` is fixed to the tip.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, the payload has a mass below zero, or the function cannot
    /// be compiled for this robot.
    pub fn inverse_dynamics_with_payload<T: Number>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        payload: &Payload<T>,
    ) -> Result<Vec<T>, EvaluationError> {
        let payload = payload.to_array();
        self.numbers(Function::InverseDynamicsWithPayload, &motion(q, qd, qdd).payload(Array::Same(&payload)))
    }

    /// Torques from the sines and cosines of the joint positions; `q` is used for prismatic joints alone.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn inverse_dynamics_from_sin_cos<T: Number>(
        &self,
        sin: &[T],
        cos: &[T],
        q: &[T],
        qd: &[T],
        qdd: &[T],
    ) -> Result<Vec<T>, EvaluationError> {
        let arguments = motion(q, qd, qdd).sin(Array::Rows(sin)).cos(Array::Rows(cos));
        self.numbers(Function::InverseDynamicsFromSinCos, &arguments)
    }

    /// Torques that hold the arm still against gravity, τ(q, 0, 0).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn gravity_torques<T: Number>(&self, q: &[T]) -> Result<Vec<T>, EvaluationError> {
        self.numbers(Function::GravityTorques, &motion(q, &[], &[]))
    }

    /// Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn bias_torques<T: Number>(&self, q: &[T], qd: &[T]) -> Result<Vec<T>, EvaluationError> {
        self.numbers(Function::BiasTorques, &motion(q, qd, &[]))
    }

    /// The mass matrix M(q), row by row.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn mass_matrix<T: Number>(&self, q: &[T]) -> Result<Matrix<T>, EvaluationError> {
        self.rows(Function::MassMatrix, &motion(q, &[], &[]))
    }

    /// The Coriolis matrix C(q, q̇) of Christoffel, row by row.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn coriolis_matrix<T: Number>(&self, q: &[T], qd: &[T]) -> Result<Matrix<T>, EvaluationError> {
        self.rows(Function::CoriolisMatrix, &motion(q, qd, &[]))
    }

    /// Accelerations from torques, q̈(q, q̇, τ).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn forward_dynamics<T: Number>(&self, q: &[T], qd: &[T], tau: &[T]) -> Result<Vec<T>, EvaluationError> {
        self.numbers(Function::ForwardDynamics, &motion(q, qd, &[]).tau(Array::Rows(tau)))
    }

    /// The tip in the world, base and tool included.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn forward_kinematics<T: Number>(&self, q: &[T]) -> Result<Pose<T>, EvaluationError> {
        self.numbers(Function::ForwardKinematics, &motion(q, &[], &[])).map(|numbers| pose(&numbers))
    }

    /// The frame of every row of the table in the world.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn link_poses<T: Number>(&self, q: &[T]) -> Result<Vec<Pose<T>>, EvaluationError> {
        let numbers = self.numbers(Function::LinkPoses, &motion(q, &[], &[]))?;
        Ok(numbers.chunks_exact(12).map(pose).collect())
    }

    /// The geometric Jacobian of the tip in world axes: three linear rows, then three angular ones.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn jacobian<T: Number>(&self, q: &[T]) -> Result<Matrix<T>, EvaluationError> {
        self.rows(Function::Jacobian, &motion(q, &[], &[]))
    }

    /// J̇ q̇: the acceleration of the tip in world axes when q̈ = 0, linear, then angular.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn jacobian_rate_times_velocity<T: Number>(&self, q: &[T], qd: &[T]) -> Result<[T; 6], EvaluationError> {
        self.numbers(Function::JacobianRateTimesVelocity, &motion(q, qd, &[])).map(|numbers| array(&numbers))
    }

    /// Kinetic energy, J.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn kinetic_energy<T: Number>(&self, q: &[T], qd: &[T]) -> Result<T, EvaluationError> {
        self.numbers(Function::KineticEnergy, &motion(q, qd, &[])).map(|numbers| numbers[0])
    }

    /// Potential energy, J.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn potential_energy<T: Number>(&self, q: &[T]) -> Result<T, EvaluationError> {
        self.numbers(Function::PotentialEnergy, &motion(q, &[], &[])).map(|numbers| numbers[0])
    }

    /// The centre of mass of all links in the world, m.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn centre_of_mass<T: Number>(&self, q: &[T]) -> Result<[T; 3], EvaluationError> {
        self.numbers(Function::CentreOfMass, &motion(q, &[], &[])).map(|numbers| array(&numbers))
    }

    /// The Jacobian of the centre of mass in world axes, three rows.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn centre_of_mass_jacobian<T: Number>(&self, q: &[T]) -> Result<Matrix<T>, EvaluationError> {
        self.rows(Function::CentreOfMassJacobian, &motion(q, &[], &[]))
    }

    /// Torques per inertial parameter: joint, link, (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn regressor<T: Number>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Result<Vec<Vec<[T; 10]>>, EvaluationError> {
        let numbers = self.numbers(Function::Regressor, &motion(q, qd, qdd))?;
        let links = |torque: &[T]| torque.chunks_exact(10).map(array).collect();
        Ok(numbers.chunks_exact(10 * self.dof()).map(links).collect())
    }

    /// ∂τ/∂q and ∂τ/∂q̇ of [`inverse_dynamics`](Self::inverse_dynamics).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn inverse_dynamics_derivatives<T: Number>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
    ) -> Result<Derivatives<T>, EvaluationError> {
        let mut dq = self.rows(Function::InverseDynamicsDerivatives, &motion(q, qd, qdd))?;
        let dqd = dq.split_off(self.dof());
        Ok(Derivatives { dq, dqd })
    }

    /// Force and moment that link i-1 exerts on link i, at joint i, in axes fixed to link i.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn joint_wrenches<T: Number>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Result<Vec<Wrench<T>>, EvaluationError> {
        let numbers = self.numbers(Function::JointWrenches, &motion(q, qd, qdd))?;
        let wrench = |numbers: &[T]| Wrench { force: array(&numbers[..3]), moment: array(&numbers[3..]) };
        Ok(numbers.chunks_exact(6).map(wrench).collect())
    }

    /// The momentum of every joint, M(q) q̇, and the rate it would have without external torques, τ + C(q, q̇)ᵀ q̇ - g(q).
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn momentum_and_rate<T: Number>(&self, q: &[T], qd: &[T], tau: &[T]) -> Result<[Vec<T>; 2], EvaluationError> {
        let arguments = motion(q, qd, &[]).tau(Array::Same(tau));
        let mut momentum: Vec<T> = self.numbers(Function::MomentumAndRate, &arguments)?;
        let rate = momentum.split_off(self.dof());
        Ok([momentum, rate])
    }

    /// Torques on a base that moves as told, under gravity as told, with a free tip.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn inverse_dynamics_on_moving_base<T: Number>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
    ) -> Result<Vec<T>, EvaluationError> {
        let arguments = motion(q, qd, qdd)
            .base_omega(Array::Same(&base.omega))
            .base_omega_dot(Array::Same(&base.omega_dot))
            .base_acceleration(Array::Same(&base.acceleration))
            .base_gravity(Array::Same(&base.gravity));
        self.numbers(Function::InverseDynamicsOnMovingBase, &arguments)
    }

    /// What rotors behind gears and friction add to the torques.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, or the function cannot be compiled for this robot.
    pub fn actuator_torques<T: Number>(&self, qd: &[T], qdd: &[T]) -> Result<Vec<T>, EvaluationError> {
        self.numbers(Function::ActuatorTorques, &motion(&[], qd, qdd))
    }
}
