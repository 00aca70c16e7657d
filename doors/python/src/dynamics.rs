//! The functions of the class `Arm`: arrays in, arrays out.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rne::compiled::Function;

use crate::arm::Arm;

#[pymethods]
impl Arm {
    /// Joint torques τ(q, q̇, q̈) with a free tip: shape (n,) or (N, n), N m or N.
    ///
    /// What the actuators must deliver, M(q) q̈ + C(q, q̇) q̇ + g(q), without friction.
    #[pyo3(signature = (q, qd, qdd, *, parameters=None, out=None))]
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::InverseDynamics, vec![("q", q), ("qd", qd), ("qdd", qdd)], parameters, out)
    }

    /// Torques when the last link exerts a wrench on its environment: τ = τ_free + Jᵀ w.
    ///
    /// `wrench`: force (N), then moment (N m) about the origin of the tip frame, in tip axes; shape (6,) or (N, 6).
    #[pyo3(signature = (q, qd, qdd, wrench, *, parameters=None, out=None))]
    fn inverse_dynamics_with_wrench<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        wrench: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = vec![("q", q), ("qd", qd), ("qdd", qdd), ("wrench", wrench)];
        self.compute(py, Function::InverseDynamicsWithWrench, given, parameters, out)
    }

    /// Torques when a payload is fixed to the tip.
    ///
    /// `payload`: mass (kg); centre of mass x, y, z (m) from the origin of the tip frame; inertia about it xx, yy, zz,
    /// xy, xz, yz (kg m², elements of the tensor), in tip axes; shape (10,) or (N, 10). `rne.payload` makes one.
    /// A point mass has the first four numbers alone: shape (4,) or (N, 4).
    #[pyo3(signature = (q, qd, qdd, payload, *, parameters=None, out=None))]
    fn inverse_dynamics_with_payload<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        payload: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = vec![("q", q), ("qd", qd), ("qdd", qdd), ("payload", payload)];
        self.compute(py, Function::InverseDynamicsWithPayload, given, parameters, out)
    }

    /// Torques from the sines and cosines of the positions; `q` is used for prismatic joints alone.
    #[pyo3(signature = (sin, cos, q, qd, qdd, *, parameters=None, out=None))]
    fn inverse_dynamics_from_sin_cos<'py>(
        &self,
        py: Python<'py>,
        sin: &Bound<'py, PyAny>,
        cos: &Bound<'py, PyAny>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = vec![("sin", sin), ("cos", cos), ("q", q), ("qd", qd), ("qdd", qdd)];
        self.compute(py, Function::InverseDynamicsFromSinCos, given, parameters, out)
    }

    /// Torques on a base that moves, in the axes of frame 0: each of shape (3,) or (N, 3).
    ///
    /// `base_omega` (rad/s) and `base_omega_dot` (rad/s²) of frame 0, `base_acceleration` (m/s²) of its origin without
    /// gravity; `base_gravity` (m/s²) points down and is the robot's own unless given. What is left out is zero.
    #[pyo3(signature = (q, qd, qdd, *, base_omega=None, base_omega_dot=None, base_acceleration=None,
        base_gravity=None, parameters=None, out=None))]
    fn inverse_dynamics_on_moving_base<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        base_omega: Option<&Bound<'py, PyAny>>,
        base_omega_dot: Option<&Bound<'py, PyAny>>,
        base_acceleration: Option<&Bound<'py, PyAny>>,
        base_gravity: Option<&Bound<'py, PyAny>>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let zero = PyTuple::new(py, [0.0; 3])?.into_any();
        let gravity = PyTuple::new(py, self.robot().gravity)?.into_any();
        let given = vec![
            ("q", q),
            ("qd", qd),
            ("qdd", qdd),
            ("base_omega", base_omega.unwrap_or(&zero)),
            ("base_omega_dot", base_omega_dot.unwrap_or(&zero)),
            ("base_acceleration", base_acceleration.unwrap_or(&zero)),
            ("base_gravity", base_gravity.unwrap_or(&gravity)),
        ];
        self.compute(py, Function::InverseDynamicsOnMovingBase, given, parameters, out)
    }

    /// Torques that hold the arm still against gravity, τ(q, 0, 0): shape (n,) or (N, n).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn gravity_torques<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::GravityTorques, vec![("q", q)], parameters, out)
    }

    /// Coriolis, centrifugal and gravity torques, τ(q, q̇, 0): shape (n,) or (N, n).
    #[pyo3(signature = (q, qd, *, parameters=None, out=None))]
    fn bias_torques<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::BiasTorques, vec![("q", q), ("qd", qd)], parameters, out)
    }

    /// The mass matrix M(q), symmetric: shape (n, n) or (N, n, n); kg m², kg m or kg.
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn mass_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::MassMatrix, vec![("q", q)], parameters, out)
    }

    /// The Coriolis matrix C(q, q̇) of Christoffel, Ṁ - 2C skew: shape (n, n) or (N, n, n).
    #[pyo3(signature = (q, qd, *, parameters=None, out=None))]
    fn coriolis_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::CoriolisMatrix, vec![("q", q), ("qd", qd)], parameters, out)
    }

    /// Joint accelerations from torques, q̈(q, q̇, τ), with a free tip: shape (n,) or (N, n).
    ///
    /// Not finite where the mass matrix is singular: a joint that moves nothing.
    #[pyo3(signature = (q, qd, tau, *, parameters=None, out=None))]
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::ForwardDynamics, vec![("q", q), ("qd", qd), ("tau", tau)], parameters, out)
    }

    /// The pose of the tip in the world, base and tool included: homogeneous matrices, shape (4, 4) or (N, 4, 4).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn forward_kinematics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::ForwardKinematics, vec![("q", q)], parameters, out)
    }

    /// The frame of every row of the table in the world: shape (n, 4, 4) or (N, n, 4, 4).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn link_poses<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::LinkPoses, vec![("q", q)], parameters, out)
    }

    /// The geometric Jacobian of the tip in world axes, linear rows above angular ones: shape (6, n) or (N, 6, n).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::Jacobian, vec![("q", q)], parameters, out)
    }

    /// J̇ q̇, the acceleration of the tip in world axes when q̈ = 0, linear, then angular: shape (6,) or (N, 6).
    #[pyo3(signature = (q, qd, *, parameters=None, out=None))]
    fn jacobian_rate_times_velocity<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::JacobianRateTimesVelocity, vec![("q", q), ("qd", qd)], parameters, out)
    }

    /// Kinetic energy, J: a number or shape (N,).
    #[pyo3(signature = (q, qd, *, parameters=None, out=None))]
    fn kinetic_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::KineticEnergy, vec![("q", q), ("qd", qd)], parameters, out)
    }

    /// Potential energy in gravity, J, zero where a mass is at the origin of frame 0: a number or shape (N,).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn potential_energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::PotentialEnergy, vec![("q", q)], parameters, out)
    }

    /// The centre of mass of all links in the world, m: shape (3,) or (N, 3).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn centre_of_mass<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::CentreOfMass, vec![("q", q)], parameters, out)
    }

    /// The Jacobian of the centre of mass in world axes: shape (3, n) or (N, 3, n).
    #[pyo3(signature = (q, *, parameters=None, out=None))]
    fn centre_of_mass_jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::CentreOfMassJacobian, vec![("q", q)], parameters, out)
    }

    /// Y(q, q̇, q̈) with τ = Y p: shape (n, 10 n) or (N, n, 10 n).
    ///
    /// p holds, link by link, m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz about the origin of the link's frame
    /// of the table and in its axes (`inertial_parameters`); Jxy is the tensor's element, -∫ x y dm.
    #[pyo3(signature = (q, qd, qdd, *, parameters=None, out=None))]
    fn regressor<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::Regressor, vec![("q", q), ("qd", qd), ("qdd", qdd)], parameters, out)
    }

    /// (∂τ/∂q, ∂τ/∂q̇) of `inverse_dynamics`, row i of torque i: two of shape (n, n) or (N, n, n).
    ///
    /// `out` is one array of shape (2, n, n) or (N, 2, n, n). The derivative by q̈ is the mass matrix.
    #[pyo3(signature = (q, qd, qdd, *, parameters=None, out=None))]
    fn inverse_dynamics_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let given = vec![("q", q), ("qd", qd), ("qdd", qdd)];
        let both = self.compute(py, Function::InverseDynamicsDerivatives, given, parameters, out)?;
        let all = pyo3::types::PySlice::full(py);
        let of = |index: usize| both.get_item((pyo3::types::PyEllipsis::get(py), index, &all, &all));
        Ok((of(0)?, of(1)?))
    }

    /// Force (N) and moment (N m) that the link before exerts on each link, at its joint, in axes fixed to the link, z
    /// along the joint: shape (n, 6) or (N, n, 6).
    #[pyo3(signature = (q, qd, qdd, *, parameters=None, out=None))]
    fn joint_wrenches<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::JointWrenches, vec![("q", q), ("qd", qd), ("qdd", qdd)], parameters, out)
    }

    /// Momentum of every joint, M(q) q̇, and the rate it would have without external torques, τ + C(q, q̇)ᵀ q̇ - g(q): two
    /// arrays of shape (n,) or (N, n). What the momentum changes faster is the external torque.
    #[pyo3(signature = (q, qd, tau, *, parameters=None, out=None))]
    #[allow(clippy::too_many_arguments)]
    fn momentum_and_rate<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let both =
            self.compute(py, Function::MomentumAndRate, vec![("q", q), ("qd", qd), ("tau", tau)], parameters, out)?;
        let all = pyo3::types::PySlice::full(py);
        let of = |index: usize| both.get_item((pyo3::types::PyEllipsis::get(py), index, &all));
        Ok((of(0)?, of(1)?))
    }

    /// What rotors behind gears and friction add to the torques, G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇): shape (n,) or
    /// (N, n).
    #[pyo3(signature = (qd, qdd, *, parameters=None, out=None))]
    fn actuator_torques<'py>(
        &self,
        py: Python<'py>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.compute(py, Function::ActuatorTorques, vec![("qd", qd), ("qdd", qdd)], parameters, out)
    }
}
